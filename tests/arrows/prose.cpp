#include "prose.hpp"

#include <cctype>
#include <fstream>
#include <sstream>

namespace breve::house {

namespace {

std::string trimmed(const std::string& line) {
  const std::size_t first = line.find_first_not_of(" \t");
  if (first == std::string::npos) return "";
  return line.substr(first, line.find_last_not_of(" \t\r") - first + 1);
}

/// Gathers paragraphs: an empty one is dropped.
class Writer {
 public:
  void add(std::size_t line, const std::string& words) { open_.add(line, words); }
  void end() {
    if (!open_.text.empty()) done_.push_back(std::move(open_));
    open_ = {};
  }
  std::vector<Paragraph> take() {
    end();
    return std::move(done_);
  }

 private:
  Paragraph open_;
  std::vector<Paragraph> done_;
};

/// Pages: blank lines, headings and list items end a paragraph; each cell of a table is one; code is left out.
std::vector<Paragraph> of_page(std::istream& in) {
  Writer out;
  bool code = false;
  std::size_t number = 0;
  for (std::string raw; std::getline(in, raw);) {
    ++number;
    std::string line = trimmed(raw);
    const bool fence = line.rfind("```", 0) == 0;
    if (fence) code = !code;
    if (fence || code || line.empty()) {
      out.end();
      continue;
    }
    if (line[0] == '|') {
      std::istringstream cells(line);
      for (std::string cell; std::getline(cells, cell, '|'); out.end()) out.add(number, trimmed(cell));
      continue;
    }
    if (line[0] == '#' || line.rfind("- ", 0) == 0) {
      out.end();
      line = trimmed(line.substr(line.find(' ') == std::string::npos ? 1 : line.find(' ')));
    }
    out.add(number, line);
    if (raw[0] == '#') out.end();
  }
  return out.take();
}

/// Programs and scripts: runs of lines that begin with a comment sign, and comments behind code.
std::vector<Paragraph> of_script(std::istream& in, const std::string& signs) {
  Writer out;
  std::size_t number = 0;
  for (std::string raw; std::getline(in, raw);) {
    ++number;
    const std::string line = trimmed(raw);
    if (!line.empty() && signs.find(line[0]) != std::string::npos) {
      out.add(number, trimmed(line.substr(1)));
      continue;
    }
    out.end();
    const std::size_t behind = line.find(" # ");
    if (behind == std::string::npos) continue;
    out.add(number, line.substr(behind + 3));
    out.end();
  }
  return out.take();
}

/// C and C++: comments, where those on lines that follow one another are one paragraph, and strings.
class CSource {
 public:
  explicit CSource(std::string text) : text_(std::move(text)) {}

  std::vector<Paragraph> read() {
    while (at_ < text_.size()) {
      if (ahead("//")) {
        line_comment();
      } else if (ahead("/*")) {
        block_comment();
      } else if (text_[at_] == '"' || text_[at_] == '\'') {
        quoted(text_[at_]);
      } else {
        step();
      }
    }
    return out_.take();
  }

 private:
  bool ahead(const char* sign) const { return text_.compare(at_, 2, sign) == 0; }

  void step() {
    if (text_[at_] == '\n') ++line_;
    if (!std::isspace(static_cast<unsigned char>(text_[at_]))) last_code_ = line_;
    ++at_;
  }

  void line_comment() {
    const bool follows = last_comment_ + 1 == line_ && last_code_ != line_;
    if (!follows) out_.end();
    while (at_ < text_.size() && text_[at_] == '/') ++at_;
    const std::size_t end = std::min(text_.find('\n', at_), text_.size());
    out_.add(line_, trimmed(text_.substr(at_, end - at_)));
    at_ = end;
    last_comment_ = last_code_ == line_ ? 0 : line_;
  }

  void block_comment() {
    out_.end();
    const std::size_t end = std::min(text_.find("*/", at_), text_.size());
    std::istringstream lines(text_.substr(at_ + 2, end - at_ - 2));
    for (std::string line; std::getline(lines, line); ++line_) {
      line = trimmed(line);
      if (line.rfind("* ", 0) == 0) line = trimmed(line.substr(1));
      out_.add(line_, line);
    }
    if (line_ > 1) --line_;
    out_.end();
    at_ = std::min(end + 2, text_.size());
  }

  void quoted(char quote) {
    const bool comment_before = last_comment_ != 0;
    if (quote == '"' || comment_before) out_.end();
    const std::size_t first = ++at_;
    while (at_ < text_.size() && text_[at_] != quote && text_[at_] != '\n') at_ += text_[at_] == '\\' ? 2 : 1;
    at_ = std::min(at_, text_.size());
    const std::string words = text_.substr(first, at_ - first);
    if (quote == '"' && words.find(' ') != std::string::npos) out_.add(line_, words);
    out_.end();
    last_comment_ = 0;
    last_code_ = line_;
    if (at_ < text_.size() && text_[at_] == quote) ++at_;
  }

  std::string text_;
  std::size_t at_ = 0, line_ = 1;
  std::size_t last_comment_ = 0, last_code_ = 0;  // lines; 0: none that counts
  Writer out_;
};

}  // namespace

void Paragraph::add(std::size_t line, const std::string& words) {
  if (words.empty()) return;
  if (!text.empty()) text += ' ';
  starts.emplace_back(text.size(), line);
  text += words;
}

std::size_t Paragraph::line_of(std::size_t offset) const {
  std::size_t line = 0;
  for (const auto& [start, number] : starts)
    if (start <= offset) line = number;
  return line;
}

std::vector<Paragraph> prose_of(const std::filesystem::path& file) {
  const std::string kind = file.extension().string();
  std::ifstream in(file);
  if (kind == ".md") return of_page(in);
  if (kind == ".tz") return of_script(in, "%#");
  if (kind == ".sh" || kind == ".cmake" || file.filename() == "CMakeLists.txt" || file.filename() == "run")
    return of_script(in, "#");
  if (kind != ".h" && kind != ".hpp" && kind != ".c" && kind != ".cpp") return {};
  std::ostringstream all;
  all << in.rdbuf();
  return CSource(all.str()).read();
}

}  // namespace breve::house
