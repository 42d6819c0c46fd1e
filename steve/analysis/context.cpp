// Where in a file a place is: in a string, a comment, a header, among declarations or in a statement.
#include "steve/analysis/context.hpp"

#include <algorithm>

#include "steve/analysis/statement_reader.hpp"
#include "steve/syntax/words.hpp"

namespace breve::steve {

namespace {

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool is_name_char(char c) { return is_letter(c) || (c >= '0' && c <= '9') || c == '-'; }

bool is_number_type(const Token& token) { return token.kind == TokenKind::Int; }

/// What the name before a place begins with: a run of name characters from its first letter on.
std::size_t word_start(std::string_view text, std::size_t offset) {
  std::size_t start = offset;
  while (start > 0 && is_name_char(text[start - 1])) --start;
  while (start < offset && !is_letter(text[start])) ++start;
  return start;
}

class ContextFinder {
 public:
  ContextFinder(std::string_view text, const std::vector<Token>& tokens, std::uint32_t offset, bool body)
      : text_(text), tokens_(tokens), offset_(std::min<std::size_t>(offset, text.size())), body_(body) {}

  Context find() {
    const std::size_t word = word_start(text_, offset_);
    context_.typed = static_cast<std::uint32_t>(offset_ - word);
    const auto after = std::partition_point(tokens_.begin(), tokens_.end(), [&](const Token& token) {
      return token.kind != TokenKind::End && token.span.offset + token.span.length <= word;
    });
    n_ = static_cast<std::size_t>(after - tokens_.begin());
    context_.count = n_;
    if (in_string(word)) return context_;
    if (!in_comment(word)) context_.expected = Expected::TopLevel, classify();
    return context_;
  }

 private:
  const Token& before(std::size_t back = 1) const { return tokens_[n_ - back]; }
  bool sign_before(std::string_view text, std::size_t back = 1) const {
    return n_ >= back && is_sign(before(back), text);
  }
  bool name_before(std::string_view text, std::size_t back = 1) const {
    return n_ >= back && is_name(before(back), text);
  }

  // A string reaches over the place: it ends behind it, or has no closing quote and the line ends there.
  bool in_string(std::size_t word) {
    const Token* string = nullptr;
    if (n_ < tokens_.size() && tokens_[n_].kind == TokenKind::String && tokens_[n_].span.offset < word)
      string = &tokens_[n_];
    if (n_ > 0 && before().kind == TokenKind::String && before().span.offset + before().span.length == word &&
        before().span.offset + 1 + before().text.size() == word)
      string = &before();
    if (string == nullptr) return false;
    const std::string_view inside = text_.substr(string->span.offset, word - string->span.offset);
    const bool open_brace =
        inside.rfind("${") != std::string_view::npos && inside.find('}', inside.rfind("${")) == std::string_view::npos;
    if (inside.ends_with('$') || open_brace) context_.expected = Expected::StringVariable;
    return true;
  }

  bool in_comment(std::size_t word) const {
    std::size_t from = n_ == 0 ? 0 : before().span.offset + before().span.length;
    while (from < word) {
      const std::size_t hash = text_.find_first_of("#%", from);
      if (hash >= word) return false;
      const bool block = text_.substr(hash, 2) == "#!";
      const std::size_t end = block ? text_.find("!#", hash + 2) : text_.find_first_of("\r\n", hash);
      if (end == std::string_view::npos || end >= word) return true;
      from = end + 2;
    }
    return false;
  }

  void classify() {
    if (sign_before("@")) return expect(Expected::Directive);
    if (sign_before("@", 2) && n_ > 0 && before().kind == TokenKind::Name)
      return expect(name_before("use") ? Expected::Module : Expected::Nothing);
    if (name_before("Controller") || name_before("new") || name_before("all")) return expect(Expected::Class);
    if (body_) return statement(0);
    if (!find_class()) return top_level();
    find_member();
    if (at_member_sign()) return expect(Expected::MemberWord);
    if (member_ == Member::None) return expect(Expected::Nothing);
    const std::size_t colon = header_colon();
    if (member_ == Member::Method && colon < n_) return statement(colon + 1);
    if (member_ == Member::Method && n_ == member_at_ + 2) return expect(Expected::MethodName);
    if (!type_position(Expected::Type)) expect(Expected::Nothing);
  }

  void expect(Expected expected) { context_.expected = expected; }

  void top_level() {
    if (sign_before("(")) return expect(Expected::AkaWord);
    if (name_before("aka") || sign_before("[")) return expect(Expected::Nothing);
    if (sign_before(":")) return expect(Expected::Nothing);
    const bool fresh = n_ == 0 || sign_before(".") || sign_before("}") || before().kind == TokenKind::String ||
                       tokens_[n_].starts_line;
    expect(fresh ? Expected::TopLevel : Expected::Nothing);
  }

  // The last class header before the place whose '{' is still open there.
  bool find_class() {
    for (std::size_t i = n_; i-- > 1;) {
      if (!is_sign(tokens_[i], ":") || tokens_[i - 1].kind != TokenKind::Name) continue;
      std::size_t open = i + 2;
      if (open < n_ && is_sign(tokens_[open], "(")) open += 4;
      if (open < n_ && is_sign(tokens_[open], "[")) open += 4;
      const bool header = open < n_ && is_sign(tokens_[open], "{") && tokens_[i + 1].kind == TokenKind::Name &&
                          word_of(tokens_[i + 1].text) == Word::None && tokens_[i - 1].starts_line;
      if (!header) continue;
      class_open_ = open;
      int depth = 0;
      for (std::size_t k = open; k < n_; ++k) depth += is_sign(tokens_[k], "{") ? 1 : is_sign(tokens_[k], "}") ? -1 : 0;
      return depth > 0;
    }
    return false;
  }

  static bool is_member_sign(const Token& token) {
    return is_sign(token, "+") || is_sign(token, "-") || is_sign(token, "=");
  }

  bool at_member_sign() const {
    if (n_ == 0 || !is_member_sign(before()) || !before().starts_line) return false;
    return sign_before(".", 2) || sign_before("}", 2) || sign_before("{", 2) || sign_before(":", 2);
  }

  void find_member() {
    for (std::size_t i = n_; i-- > class_open_ + 1;) {
      if (i + 1 >= n_ || !is_member_sign(tokens_[i]) || !tokens_[i].starts_line) continue;
      const bool variables = is_name(tokens_[i + 1], "variables");
      if (!variables && !is_name(tokens_[i + 1], "to")) continue;
      member_ = variables ? Member::Variables : Member::Method;
      member_at_ = i;
      return;
    }
  }

  std::size_t header_colon() const {
    for (std::size_t i = member_at_ + 2; i < n_; ++i)
      if (is_sign(tokens_[i], ":")) return i;
    return n_;
  }

  // Behind a '(' of a declaration, or behind the first word of a type.
  bool type_position(Expected at_parenthesis) {
    if (sign_before("(")) {
      expect(at_parenthesis);
    } else if (sign_before("(", 2) && is_number_type(before())) {
      expect(Expected::ArrayType);
    } else if (sign_before("(", 2) && before().kind == TokenKind::Name && word_of(before().text) == Word::None) {
      expect(Expected::ObjectWord);
    } else {
      return false;
    }
    return true;
  }

  void statement(std::size_t first) {
    const std::size_t start = statement_start(first);
    if (in_declaration(start)) {
      const bool alone = sign_before("(") && n_ - start == 2;
      if (type_position(alone ? Expected::TypeOrOperand : Expected::Type)) return;
    }
    read_statement(tokens_, start, context_);
  }

  // name {, name} (
  bool in_declaration(std::size_t i) const {
    while (i + 1 < n_ && tokens_[i].kind == TokenKind::Name && is_sign(tokens_[i + 1], ",")) i += 2;
    return i + 1 < n_ && tokens_[i].kind == TokenKind::Name && word_of(tokens_[i].text) == Word::None &&
           is_sign(tokens_[i + 1], "(") && i + 3 >= n_;
  }

  // Back to a period, a colon, or the brace of a block.
  std::size_t statement_start(std::size_t first) const {
    for (std::size_t i = n_; i > first; --i) {
      const Token& token = tokens_[i - 1];
      if (is_sign(token, ".") || is_sign(token, ":")) return i;
      if (is_sign(token, "{") &&
          (i < 2 || is_sign(tokens_[i - 2], ":") || is_sign(tokens_[i - 2], ".") || is_name(tokens_[i - 2], "else")))
        return i;
      if (!is_sign(token, "}")) continue;
      const std::size_t open = matching_brace(first, i - 1);
      if (is_block(open, i - 1)) return i;
      i = open + 1;
    }
    return first;
  }

  std::size_t matching_brace(std::size_t first, std::size_t close) const {
    int depth = 0;
    for (std::size_t i = close + 1; i-- > first;) {
      depth += is_sign(tokens_[i], "}") ? 1 : is_sign(tokens_[i], "{") ? -1 : 0;
      if (depth == 0) return i;
    }
    return first;
  }

  bool is_block(std::size_t open, std::size_t close) const {
    if (open > 0 && (is_sign(tokens_[open - 1], ":") || is_name(tokens_[open - 1], "else"))) return true;
    for (std::size_t i = open + 1; i < close; ++i)
      if (is_sign(tokens_[i], ".") || is_sign(tokens_[i], ":")) return true;
    return false;
  }

  enum class Member : std::uint8_t { None, Variables, Method };

  std::string_view text_;
  const std::vector<Token>& tokens_;
  std::size_t offset_, n_ = 0;
  bool body_;
  Context context_;
  std::size_t class_open_ = 0, member_at_ = 0;
  Member member_ = Member::None;
};

}  // namespace

Context context_at(std::string_view text, const std::vector<Token>& tokens, std::uint32_t offset, bool body) {
  return ContextFinder(text, tokens, offset, body).find();
}

}  // namespace breve::steve
