// Tokens first, then a walk over them that knows what each pair of braces is: a namespace, a class, a function, a
// value.
#include "source.hpp"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <set>
#include <sstream>
#include <string_view>

namespace breve::house {

namespace {

bool is_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; }

/// Text to tokens. Lines of the preprocessor give no tokens, but their names are used: a macro's body may call.
class Lexer {
 public:
  Lexer(std::string text, Source& out) : text_(std::move(text)), out_(out), comments_(out.comments) {}

  std::vector<Token> read() {
    while (at_ < text_.size()) step();
    return std::move(tokens_);
  }

 private:
  char peek(std::size_t ahead = 0) const { return at_ + ahead < text_.size() ? text_[at_ + ahead] : '\0'; }

  void step() {
    const char c = peek();
    if (c == '\n') {
      ++line_;
      ++at_;
      fresh_ = true;
      return;
    }
    if (std::isspace(static_cast<unsigned char>(c))) {
      ++at_;
      return;
    }
    if (c == '/' && (peek(1) == '/' || peek(1) == '*')) return comment(peek(1) == '*');
    if (c == '#' && fresh_) return directive();
    fresh_ = false;
    if (c == '"' || c == '\'') return quoted(c);
    if (is_word(c)) return word();
    sign();
  }

  void comment(bool block) {
    const std::size_t end = block ? text_.find("*/", at_ + 2) : text_.find('\n', at_);
    const std::size_t stop = end == std::string::npos ? text_.size() : end + (block ? 2 : 0);
    comments_.push_back({line_, text_.substr(at_, stop - at_), fresh_});
    line_ += static_cast<std::size_t>(std::count(text_.begin() + static_cast<std::ptrdiff_t>(at_),
                                                 text_.begin() + static_cast<std::ptrdiff_t>(stop), '\n'));
    at_ = stop;
  }

  void directive() {
    while (at_ < text_.size() && peek() != '\n') {
      if (peek() == '/' && peek(1) == '/') return;
      if (peek() == '/' && peek(1) == '*') return comment(true);
      if (peek() == '\\' && peek(1) == '\n') {
        ++line_;
        ++at_;
      }
      if (!is_word(peek())) {
        ++at_;
        continue;
      }
      const std::size_t begin = at_;
      while (is_word(peek())) ++at_;
      out_.uses.push_back({text_.substr(begin, at_ - begin), ""});
    }
  }

  void add(Token::Kind kind, std::string text) { tokens_.push_back({kind, std::move(text), line_}); }

  void quoted(char quote) {
    ++at_;
    while (at_ < text_.size() && peek() != quote) at_ += peek() == '\\' ? 2 : 1;
    ++at_;
    add(Token::Kind::Text, "\"");
  }

  void raw() {
    const std::size_t open = text_.find('(', at_);
    const std::string close = ")" + text_.substr(at_ + 1, open - at_ - 1) + "\"";
    const std::size_t end = std::min(text_.find(close, open), text_.size());
    add(Token::Kind::Text, "\"");
    line_ += static_cast<std::size_t>(std::count(text_.begin() + static_cast<std::ptrdiff_t>(at_),
                                                 text_.begin() + static_cast<std::ptrdiff_t>(end), '\n'));
    at_ = end + close.size();
  }

  void word() {
    const std::size_t begin = at_;
    const bool number = std::isdigit(static_cast<unsigned char>(peek()));
    while (is_word(peek()) || (number && (peek() == '.' || (peek() == '\'' && is_word(peek(1)))))) ++at_;
    const std::string text = text_.substr(begin, at_ - begin);
    if (peek() == '"' && text == "R") return raw();
    add(number ? Token::Kind::Number : Token::Kind::Word, text);
  }

  void sign() {
    static constexpr std::string_view kPairs[] = {"::", "->", "==", "!=", "<=", ">=", "&&",
                                                  "||", "+=", "-=", "|=", "++", "--"};
    for (const std::string_view pair : kPairs)
      if (text_.compare(at_, 2, pair) == 0) {
        at_ += 2;
        return add(Token::Kind::Sign, std::string(pair));
      }
    add(Token::Kind::Sign, std::string(1, text_[at_++]));
  }

  const std::string text_;
  Source& out_;
  std::vector<Comment>& comments_;
  std::vector<Token> tokens_;
  std::size_t at_ = 0, line_ = 1;
  bool fresh_ = true;  // nothing but blanks so far in this line
};

/// The walk. The tokens between one ';' or brace and the next form a head: it says what the brace behind it opens.
class Walk {
 public:
  Walk(const std::vector<Token>& tokens, Source& out) : tokens_(tokens), out_(out) {}

  void run() {
    while (at_ < tokens_.size()) declarations();
  }

 private:
  struct Scope {
    bool is_class;
    std::string name;
  };

  bool is(std::size_t at, std::string_view text) const { return at < tokens_.size() && tokens_[at].text == text; }

  /// Behind the bracket that closes the one at `at`.
  std::size_t behind(std::size_t at) const {
    int depth = 0;
    for (; at < tokens_.size(); ++at) {
      const std::string& t = tokens_[at].text;
      if (tokens_[at].kind == Token::Kind::Text) continue;
      if (t == "(" || t == "[" || t == "{") ++depth;
      if ((t == ")" || t == "]" || t == "}") && --depth == 0) return at + 1;
    }
    return at;
  }

  /// The same for angle brackets, which may also compare: those of a template's head and of a type do not.
  std::size_t behind_angles(std::size_t at) const {
    int depth = 0;
    for (; at < tokens_.size(); ++at) {
      const std::string& t = tokens_[at].text;
      if (t == "(") at = behind(at) - 1;
      if (t == "<") ++depth;
      if (t == ">" && --depth == 0) return at + 1;
      if (t == ";" || t == "{") return at;
    }
    return at;
  }

  bool in_class() const { return !scopes_.empty() && scopes_.back().is_class; }

  /// One declaration, or the end of a scope.
  void declarations() {
    if (is(at_, "}")) {
      out_.breaks.push_back(tokens_[at_].line);
      if (!scopes_.empty()) scopes_.pop_back();
      ++at_;
      return;
    }
    if (is(at_, ";")) {
      ++at_;
      return;
    }
    if ((is(at_, "public") || is(at_, "private") || is(at_, "protected")) && is(at_ + 1, ":")) {
      out_.breaks.push_back(tokens_[at_].line);
      at_ += 2;
      return;
    }
    if (is(at_, "namespace")) return space();
    if (is(at_, "extern") && at_ + 1 < tokens_.size() && tokens_[at_ + 1].kind == Token::Kind::Text &&
        is(at_ + 2, "{")) {
      scopes_.push_back({in_class(), ""});
      at_ += 3;
      return;
    }
    declaration();
  }

  void space() {
    std::string name;
    for (++at_; at_ < tokens_.size() && !is(at_, "{") && !is(at_, ";"); ++at_)
      if (!is(at_, "inline")) name += tokens_[at_].text;
    if (is(at_, "{")) scopes_.push_back({false, name.empty() ? "{}" : name});
    ++at_;
  }

  void declaration() {
    const std::size_t begin = at_;
    Name found;
    found.first_line = tokens_[begin].line;
    std::size_t at = begin;
    while (is(at, "template") || is(at, "requires")) {
      found.is_template = true;
      at = is(at + 1, "<") ? behind_angles(at + 1) : behind(at + 1);
    }
    while (is(at, "[") && is(at + 1, "[")) at = behind(at);
    if (is(at, "using") || is(at, "typedef") || is(at, "static_assert") || is(at, "friend") || is(at, "concept"))
      return plain(begin, at);
    if (opens_class(at)) return;
    std::size_t name_at = 0;
    const std::size_t parameters = find_parameters(at, name_at);
    if (parameters == 0) return value(at);
    function(found, begin, at, name_at, parameters);
  }

  /// To the ';' at the end; what stands in between is used, not declared.
  void plain(std::size_t begin, std::size_t at) {
    const bool befriends = is(at, "friend");
    for (; at < tokens_.size() && !is(at, ";"); ++at) {
      if (is(at, "{")) {
        const std::size_t end = behind(at);
        use(at, end, "");
        at = end;
        if (befriends) break;  // a friend's body ends it
      }
    }
    at_ = std::min(at + (is(at, ";") ? 1 : 0), tokens_.size());
    if (at_ <= begin) at_ = begin + 1;
  }

  /// A class with a body becomes a scope; so does an enumeration, whose names are only skipped.
  bool opens_class(std::size_t at) {
    const bool counts = is(at, "enum");
    if (!counts && !is(at, "class") && !is(at, "struct") && !is(at, "union")) return false;
    std::size_t name_at = at + 1;
    if (counts && (is(name_at, "class") || is(name_at, "struct"))) ++name_at;
    while (is(name_at, "alignas") || is(name_at, "[")) name_at = behind(name_at + (is(name_at, "alignas") ? 1 : 0));
    const bool named = name_at < tokens_.size() && tokens_[name_at].kind == Token::Kind::Word;
    std::string name = named ? tokens_[name_at].text : "";
    std::size_t end = named ? name_at + 1 : name_at;
    while (is(end, "::")) {  // a nested class that is defined outside
      name += "::" + tokens_[end + 1].text;
      end += 2;
    }
    if (is(end, "<")) end = behind_angles(end);
    if (is(end, ";")) {
      at_ = end + 1;
      return true;
    }
    if (is(end, "final")) ++end;
    if (is(end, ":"))
      while (end < tokens_.size() && !is(end, "{") && !is(end, ";")) ++end;
    if (!is(end, "{")) return false;  // a function or a variable of that type
    note(name, tokens_[at].line);
    if (counts) {
      at_ = behind(end);
      return true;
    }
    scopes_.push_back({true, name});
    at_ = end + 1;
    return true;
  }

  void note(const std::string& name, std::size_t line) {
    if (name.empty()) return;
    Name entry;
    entry.name = name;
    entry.first_line = entry.last_line = line;
    entry.defined = true;
    place(entry);
    out_.names.push_back(entry);
  }

  void place(Name& name) const {
    for (const Scope& scope : scopes_) {
      std::string& to = scope.is_class ? name.owner : name.space;
      if (scope.name.empty()) continue;
      to += (to.empty() ? "" : "::") + scope.name;
    }
    name.in_class = in_class();
  }

  /// The '(' of a function's parameters, or 0 if a value comes first; the name stands before it.
  std::size_t find_parameters(std::size_t at, std::size_t& name_at) const {
    for (; at < tokens_.size(); ++at) {
      const std::string& t = tokens_[at].text;
      if (tokens_[at].kind == Token::Kind::Text) continue;
      if (t == ";" || t == "{" || t == "=" || t == "}") return 0;
      if (t == "operator") {
        name_at = at;
        ++at;
        if (is(at, "(")) ++at;
        while (at < tokens_.size() && !is(at, "(")) ++at;
        return at;
      }
      if (t == "[") at = behind(at) - 1;
      if (t == "<") at = behind_angles(at) - 1;
      if (t != "(") continue;
      if (is(at - 1, "alignas") || is(at - 1, "decltype") || is(at - 1, "__attribute__") || is(at - 1, "noexcept") ||
          is(at - 1, "explicit")) {
        at = behind(at) - 1;
        continue;
      }
      // `double (*read)(…)` is a value; a macro such as BREVE_API(…) does not occur.
      if (tokens_[at - 1].kind != Token::Kind::Word && !is(at - 1, ">")) return 0;
      if (is(at + 1, "*")) return 0;
      name_at = at - 1;
      if (is(name_at, ">"))  // a specialisation
        while (name_at > 0 && !is(name_at, "<")) --name_at;
      if (is(at - 1, ">")) --name_at;
      return at;
    }
    return 0;
  }

  void value(std::size_t at) {
    const std::size_t begin = at;
    std::string name;
    for (; at < tokens_.size() && !is(at, ";") && !is(at, "=") && !is(at, "{") && !is(at, "}"); ++at) {
      if (is(at, "[")) {
        at = behind(at) - 1;
        continue;
      }
      if (tokens_[at].kind == Token::Kind::Word && !is(at + 1, "::") && !is(at + 1, "<")) name = tokens_[at].text;
    }
    if (!in_class()) note(name, tokens_[begin].line);
    const std::size_t from = at;
    while (at < tokens_.size() && !is(at, ";") && !is(at, "}")) at = is(at, "{") || is(at, "(") ? behind(at) : at + 1;
    use(from, at, "");
    at_ = is(at, ";") ? at + 1 : std::max(at, begin + 1);
  }

  void function(Name& found, std::size_t begin, std::size_t at, std::size_t name_at, std::size_t parameters) {
    found.function = true;
    found.name = is(name_at, "operator") ? "operator" : tokens_[name_at].text;
    if (is(name_at - 1, "~") && name_at > 0) found.name = "~" + found.name;
    place(found);
    std::size_t owner_at = found.name[0] == '~' ? name_at - 1 : name_at;
    std::string owner;
    while (owner_at > at + 1 && is(owner_at - 1, "::") && tokens_[owner_at - 2].kind == Token::Kind::Word) {
      owner = tokens_[owner_at - 2].text + (owner.empty() ? "" : "::" + owner);
      owner_at -= 2;
    }
    if (!owner.empty()) found.owner = found.owner.empty() ? owner : found.owner + "::" + owner;
    for (std::size_t i = at; i < name_at; ++i) {
      if (is(i, "static")) found.is_static = true;
      if (is(i, "virtual")) found.overrides = true;
    }
    std::size_t end = behind(parameters);
    use_calls(parameters, end);
    end = to_body(end, found);
    found.defined = is(end, "{");
    const std::size_t last = found.defined ? behind(end) : end + 1;
    if (found.defined) use(end, last, found.name);
    found.last_line = last > 0 && last <= tokens_.size() ? tokens_[last - 1].line : found.first_line;
    out_.names.push_back(found);
    at_ = std::max(last, begin + 1);
  }

  /// From behind the parameters to the '{' of the body or the ';': over const, noexcept, a result, initialisers.
  std::size_t to_body(std::size_t end, Name& found) {
    bool initialises = false;
    while (end < tokens_.size() && !is(end, ";")) {
      if (is(end, "override") || is(end, "final")) found.overrides = true;
      if (is(end, ":")) initialises = true;
      if (is(end, "=")) {  // = default, = delete, = 0
        while (end < tokens_.size() && !is(end, ";")) ++end;
        found.overrides = true;
        return end;
      }
      if (is(end, "{")) {
        const bool member = initialises && (tokens_[end - 1].kind == Token::Kind::Word || is(end - 1, ">"));
        if (!member) return end;
      }
      if (is(end, "(") || is(end, "{") || is(end, "[")) {
        const std::size_t from = end;
        end = behind(end);
        use(from, end, found.name);
        continue;
      }
      if (is(end, "<") && !initialises) {
        end = behind_angles(end);
        continue;
      }
      ++end;
    }
    return end;
  }

  void use(std::size_t from, std::size_t to, const std::string& inside) {
    for (std::size_t i = from; i < to && i < tokens_.size(); ++i)
      if (tokens_[i].kind == Token::Kind::Word) out_.uses.push_back({tokens_[i].text, inside});
  }

  /// Default arguments may call something.
  void use_calls(std::size_t from, std::size_t to) {
    for (std::size_t i = from + 1; i + 1 < to; ++i)
      if (tokens_[i].kind == Token::Kind::Word && is(i + 1, "(")) out_.uses.push_back({tokens_[i].text, ""});
  }

  const std::vector<Token>& tokens_;
  Source& out_;
  std::vector<Scope> scopes_;
  std::size_t at_ = 0;
};

}  // namespace

Source read_source(const std::filesystem::path& path) {
  std::ifstream in(path);
  std::ostringstream text;
  text << in.rdbuf();
  Source out;
  const std::vector<Token> tokens = Lexer(text.str(), out).read();
  Walk(tokens, out).run();
  return out;
}

}  // namespace breve::house
