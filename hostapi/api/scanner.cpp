// The headers are C, but not any C: each declaration begins at the start of a line, with its comment above it; each
// field and enumerator has its comment behind it. Whatever does not fit is an error, so that nothing is lost in
// silence.
#include "scanner.hpp"

#include <cctype>
#include <regex>
#include <stdexcept>

namespace breve::api {

namespace {

std::string trimmed(const std::string& text) {
  const auto begin = text.find_first_not_of(" \n\t");
  if (begin == std::string::npos) return {};
  return text.substr(begin, text.find_last_not_of(" \n\t") - begin + 1);
}

/// Runs of blanks and line ends as one blank each.
std::string in_one_line(const std::string& text) {
  std::string out;
  for (const char c : text)
    if (!std::isspace(static_cast<unsigned char>(c)))
      out += c;
    else if (!out.empty() && out.back() != ' ')
      out += ' ';
  return trimmed(out);
}

/// The text of a comment without its marks, its lines joined.
std::string prose(std::string comment) {
  if (comment.starts_with("/*")) comment = comment.substr(2);
  if (comment.ends_with("*/")) comment.resize(comment.size() - 2);
  return in_one_line(std::regex_replace(comment, std::regex("\n \\* ?"), "\n"));
}

[[noreturn]] void fail(const std::string& header, const std::string& at) {
  throw std::runtime_error(header + ": cannot read this declaration: " + at.substr(0, 120));
}

/// A declaration and the comments in it taken apart.
struct Piece {
  std::string code, doc;
};

/// Splits at a separator outside of parentheses and comments. A comment belongs to the piece it follows.
std::vector<Piece> pieces_of(const std::string& text, char separator) {
  std::vector<Piece> pieces(1);
  std::size_t waiting = 0;  // the piece that a comment is about
  int depth = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text.compare(i, 2, "/*") == 0) {
      const std::size_t end = text.find("*/", i) + 2;
      if (end < i) throw std::runtime_error("a comment has no end: " + text.substr(i, 80));
      const bool begins = trimmed(pieces.back().code).empty();
      Piece& about =
          begins && pieces.size() > 1 && text.find('\n', waiting) > i ? pieces[pieces.size() - 2] : pieces.back();
      about.doc += (about.doc.empty() ? "" : " ") + prose(text.substr(i, end - i));
      i = end - 1;
      continue;
    }
    if (text[i] == '(') ++depth;
    if (text[i] == ')') --depth;
    if (text[i] == separator && depth == 0) {
      pieces.emplace_back();
      waiting = i;
    } else {
      pieces.back().code += text[i];
    }
  }
  for (Piece& piece : pieces) piece.code = in_one_line(piece.code);
  if (pieces.back().code.empty()) pieces.pop_back();
  return pieces;
}

/// "const double from[3]" as a name and a type; "void (*close)(void* library)" likewise.
Parameter declaration_of(const std::string& header, const std::string& code) {
  static const std::regex function(R"((.+?)\(\*(\w+)\)\((.*)\))"), plain(R"((.*[ *])(\w+)((\[\w+\])*))");
  std::smatch match;
  if (std::regex_match(code, match, function))
    return {match[2], trimmed(match[1]) + " (*)(" + std::string(match[3]) + ")", {}, {}};
  if (!std::regex_match(code, match, plain)) fail(header, code);
  return {match[2], trimmed(match[1]) + std::string(match[3]), {}, {}};
}

std::vector<Parameter> parameters_of(const std::string& header, const std::string& text) {
  std::vector<Parameter> all;
  if (in_one_line(text) == "void") return all;
  for (const Piece& piece : pieces_of(text, ',')) all.push_back(declaration_of(header, piece.code));
  return all;
}

/// "double low[3], high[3]" declares two fields.
void add_fields(const std::string& header, const Piece& piece, std::vector<Parameter>& to) {
  std::string base;
  for (const Piece& part : pieces_of(piece.code, ',')) {
    Parameter field = declaration_of(header, base.empty() ? part.code : base + " " + part.code);
    if (base.empty()) base = field.type.substr(0, field.type.find_first_of("[*"));
    field.doc = piece.doc;
    to.push_back(field);
  }
}

/// The place of the brace that closes the one at `open`.
std::size_t closing(const std::string& text, std::size_t open) {
  int depth = 0;
  for (std::size_t i = open; i < text.size(); ++i) {
    if (text[i] == '{') ++depth;
    if (text[i] == '}' && --depth == 0) return i;
  }
  throw std::runtime_error("a brace is not closed: " + text.substr(open, 80));
}

/// The fields of a struct, with those of the structs and unions within it.
std::vector<Parameter> fields_of(const std::string& header, const std::string& body) {
  std::vector<Parameter> fields;
  const auto add = [&](const std::string& part) {
    for (const Piece& piece : pieces_of(part, ';')) add_fields(header, piece, fields);
  };
  static const std::regex nested(R"((union|struct) \{)");
  std::smatch match;
  if (!std::regex_search(body, match, nested)) {
    add(body);
    return fields;
  }
  const auto at = static_cast<std::size_t>(match.position());
  add(body.substr(0, at));
  const std::size_t open = body.find('{', at), close = closing(body, open), end = body.find(';', close);
  Parameter made{trimmed(body.substr(close + 1, end - close - 1)), match[1], {}, {}};
  made.members = fields_of(header, body.substr(open + 1, close - open - 1));
  const std::size_t line = std::min(body.find('\n', end), body.size());
  made.doc = prose(trimmed(body.substr(end + 1, line - end - 1)));  // its comment stands in its last line
  fields.push_back(made);
  for (const Parameter& later : fields_of(header, body.substr(line))) fields.push_back(later);
  return fields;
}

class Scanner {
 public:
  Scanner(const std::string& name, const std::string& text, Interface& to) : header_(name), text_(text), to_(to) {}
  void scan() {
    while (at_ < text_.size()) {
      if (starts("/*")) {
        doc_ = prose(take(text_.find("*/", at_) + 2));
        if (doc_.starts_with("----")) doc_.clear();  // the title of a section
      } else if (text_[at_] == '\n') {
        if (at_ > 0 && text_[at_ - 1] == '\n') doc_.clear();  // a comment with a blank line behind it is about no item
        ++at_;
      } else if (text_[at_] == '#') {
        preprocessor();
      } else if (starts("typedef enum")) {
        enumeration();
      } else if (starts("typedef struct") && text_.find('{', at_) < text_.find(';', at_)) {
        structure();
      } else if (starts("typedef")) {
        type();
      } else if (starts("BREVE_API")) {
        function(take(text_.find(';', at_) + 1).substr(10), false);
      } else if (starts("static inline")) {
        inline_function();
      } else {
        take(text_.find('\n', at_));  // extern "C" { and its end
      }
    }
  }

 private:
  bool starts(const char* word) const { return text_.compare(at_, std::string(word).size(), word) == 0; }
  std::string take(std::size_t end) {
    if (end < at_ || end > text_.size()) end = text_.size();
    std::string taken = text_.substr(at_, end - at_);
    at_ = end;
    return taken;
  }

  void preprocessor() {
    std::string line = take(text_.find('\n', at_));
    while (line.ends_with('\\')) line = take(text_.find('\n', at_ + 1));
    static const std::regex constant(R"(#define (BREVE_[A-Z_]+) (\w+))");
    std::smatch match;
    if (std::regex_match(line, match, constant)) to_.constants.push_back({match[1], match[2], doc_});
  }

  void enumeration() {
    static const std::regex value(R"((BREVE_\w+)( = (\w+))?)");
    const std::string text = take(text_.find(';', text_.find("\n}", at_)) + 1);
    Enumeration made{in_one_line(text.substr(text.rfind('}') + 1)), doc_, header_, {}};
    made.name.pop_back();
    const std::size_t begin = text.find('{') + 1;
    for (const Piece& piece : pieces_of(text.substr(begin, text.rfind('}') - begin), ',')) {
      std::smatch match;
      if (!std::regex_match(piece.code, match, value)) fail(header_, piece.code);
      made.values.push_back(
          {match[1], match[3].matched ? std::string(match[3]) : std::to_string(made.values.size()), piece.doc});
    }
    to_.enumerations.push_back(made);
  }

  void structure() {
    const std::size_t end = text_.find("\n}", at_);
    const std::string text = take(text_.find(';', end) + 1);
    Struct made{in_one_line(text.substr(text.rfind('}') + 1)), doc_, header_, false, {}};
    made.name.pop_back();
    made.fields = fields_of(header_, text.substr(text.find('{') + 1, text.rfind('}') - text.find('{') - 1));
    made.grows = !made.fields.empty() && made.fields[0].name == "struct_size";
    to_.structs.push_back(made);
  }

  void type() {
    static const std::regex opaque(R"(typedef struct (\w+) \1;)");
    static const std::regex callback(R"(typedef (.+?[ *])\(\*(\w+)\)\(([^]*)\);)");
    const std::string text = in_one_line(take(text_.find(';', at_) + 1));
    std::smatch match;
    if (std::regex_match(text, match, opaque))
      to_.handles.push_back(match[1]);
    else if (std::regex_match(text, match, callback))
      to_.callbacks.push_back({match[2], trimmed(match[1]), doc_, header_, parameters_of(header_, match[3]), false});
    else
      fail(header_, text);
  }

  void function(const std::string& text, bool in_header) {
    static const std::regex shape(R"(([^(]+[ *])(breve_\w+|luaopen_breve)\(([^]*)\);)");
    const std::string line = in_one_line(text);
    std::smatch match;
    if (!std::regex_match(line, match, shape)) fail(header_, line);
    to_.functions.push_back({match[2], trimmed(match[1]), doc_, header_, parameters_of(header_, match[3]), in_header});
  }

  void inline_function() {
    const std::string text = take(text_.find("\n}", at_) + 2);
    function(text.substr(14, text.find('{') - 15) + ";", true);
  }

  const std::string header_, &text_;
  Interface& to_;
  std::size_t at_ = 0;
  std::string doc_;
};

}  // namespace

void scan_header(const std::string& name, const std::string& text, Interface& to) { Scanner(name, text, to).scan(); }

}  // namespace breve::api
