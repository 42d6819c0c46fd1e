// Pieces of code as text.
#include "runtime/learn/push/text.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <iterator>

#include "runtime/base/error.hpp"
#include "runtime/learn/push/instructions.hpp"

namespace breve::push {

namespace {

bool is_space(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }
bool is_mark(char c) { return c == '(' || c == ')' || c == '[' || c == ']'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

[[noreturn]] void fail_at(std::size_t at, const std::string& what) {
  throw Error(ErrorCode::Argument, fmt::format("Push code, character {}: {}", at + 1, what));
}

std::string shortened(std::string_view word) {
  constexpr std::size_t kShown = 40;
  return word.size() > kShown ? std::string(word.substr(0, kShown)) + "..." : std::string(word);
}

/// Does a word begin as a number does? Such a word is a number or an error.
bool begins_number(std::string_view word) {
  if (!word.empty() && (word[0] == '+' || word[0] == '-')) word.remove_prefix(1);
  if (!word.empty() && word[0] == '.') word.remove_prefix(1);
  return !word.empty() && is_digit(word[0]);
}

/// @return false if the word is no such number at all
template <class T>
bool read_number(std::string_view word, std::size_t at, T& value) {
  if (word[0] == '+') word.remove_prefix(1);
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (end != word.data() + word.size()) return false;
  if (error == std::errc::result_out_of_range)
    fail_at(at, fmt::format("the number '{}' is out of range", shortened(word)));
  return error == std::errc();
}

bool equals_in_capitals(std::string_view word, std::string_view capitals) {
  if (word.size() != capitals.size()) return false;
  for (std::size_t i = 0; i < word.size(); ++i)
    if (word[i] != capitals[i] && word[i] != capitals[i] - 'A' + 'a') return false;
  return true;
}

/// Words and marks of a text.
class Words {
 public:
  explicit Words(std::string_view text) : text_(text) {}
  std::size_t at() const { return begin_; }
  /// The next; empty at the end.
  std::string_view next() {
    while (end_ < text_.size() && is_space(text_[end_])) ++end_;
    begin_ = end_;
    if (end_ < text_.size() && is_mark(text_[end_])) return text_.substr(begin_, ++end_ - begin_);
    while (end_ < text_.size() && !is_space(text_[end_]) && !is_mark(text_[end_])) ++end_;
    return text_.substr(begin_, end_ - begin_);
  }

 private:
  std::string_view text_;
  std::size_t begin_ = 0, end_ = 0;
};

/// The rest of "[x y z]".
Vector3 read_vector(Words& words, std::size_t from) {
  Vector3 value;
  for (int i = 0; i < 3; ++i) {
    const std::string_view word = words.next();
    if (!begins_number(word) || !read_number(word, words.at(), value[i]))
      fail_at(from, "a vector is written [x y z], with three numbers");
  }
  if (words.next() != "]") fail_at(from, "a vector is written [x y z], with three numbers");
  return value;
}

void read_atom(std::string_view word, std::size_t at, Builder& builder) {
  if (begins_number(word)) {
    const bool whole = word.find_first_of(".eE") == std::string_view::npos;
    std::int32_t integer = 0;
    double real = 0;
    if (whole && read_number(word, at, integer)) return builder.atom(Node::of_integer(integer));
    if (!whole && read_number(word, at, real)) return builder.atom(Node::of_float(real));
    fail_at(at, fmt::format("'{}' is not a number, and a name does not begin like one", shortened(word)));
  }
  if (equals_in_capitals(word, "TRUE")) return builder.atom(Node::of_boolean(true));
  if (equals_in_capitals(word, "FALSE")) return builder.atom(Node::of_boolean(false));
  if (const auto number = find_instruction(word)) return builder.atom(Node::of_instruction(*number));
  if (word.size() > kMaxName)
    fail_at(at, fmt::format("the name '{}' is longer than {} characters", shortened(word), kMaxName));
  builder.name(word);
}

}  // namespace

void parse_into(std::string_view text, Builder& builder, const Poll& poll) {
  struct Open {
    std::uint32_t list;
    std::size_t at;
  };
  constexpr std::uint32_t kPointsPerPoll = 4096;
  std::pmr::vector<Open> open(builder.memory());
  Words words(text);
  for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
    const std::size_t at = words.at();
    if (poll && builder.size() % kPointsPerPoll == 0) poll();
    if (word == "(") {
      open.push_back({builder.begin_list(), at});
    } else if (word == ")") {
      if (open.empty()) fail_at(at, "unmatched ')'");
      builder.end_list(open.back().list);
      open.pop_back();
    } else if (word == "[") {
      builder.atom(Node::of_vector(read_vector(words, at)));
    } else if (word == "]") {
      fail_at(at, "unmatched ']'");
    } else {
      read_atom(word, at, builder);
    }
  }
  if (!open.empty()) fail_at(open.back().at, "this '(' is not closed");
}

Code parse(std::string_view text, std::pmr::memory_resource* memory, const Poll& poll) {
  Builder builder(memory);
  const std::uint32_t list = builder.begin_list();
  parse_into(text, builder, poll);
  builder.end_list(list);
  Code all = builder.finish();
  const bool one = all.points() > 1 && all.next(1) == all.points();
  return one ? compact(all.part(1), memory) : all;
}

bool is_name(std::string_view text) {
  if (text.empty() || text.size() > kMaxName || begins_number(text)) return false;
  for (const char c : text)
    if (is_space(c) || is_mark(c)) return false;
  return !equals_in_capitals(text, "TRUE") && !equals_in_capitals(text, "FALSE") && !find_instruction(text);
}

// --- printing --------------------------------------------------------------------------------------------------------

void print(const Node& atom, std::pmr::string& out) {
  const auto to = std::back_inserter(out);
  switch (atom.kind) {
    case Kind::List: out += "()"; break;
    case Kind::Integer: fmt::format_to(to, "{}", atom.integer); break;
    case Kind::Float: {
      const std::size_t from = out.size();
      fmt::format_to(to, "{}", atom.real);
      if (out.find_first_of(".e", from) == std::pmr::string::npos) out += ".0";
      break;
    }
    case Kind::Boolean: out += atom.boolean ? "TRUE" : "FALSE"; break;
    case Kind::Vector: fmt::format_to(to, "[{} {} {}]", atom.vector[0], atom.vector[1], atom.vector[2]); break;
    case Kind::Instruction: out += instructions()[atom.instruction].name; break;
    case Kind::Name: out += atom.name->text(); break;
  }
}

void print(const Code& code, std::pmr::string& out) {
  std::pmr::vector<std::uint32_t> ends(out.get_allocator().resource());  // of the open lists
  for (std::uint32_t i = 0; i < code.points(); ++i) {
    for (; !ends.empty() && ends.back() == i; ends.pop_back()) out += ')';
    if (i > 0 && out.back() != '(') out += ' ';
    const Node& node = code.nodes()[i];
    if (node.is_list()) {
      out += '(';
      ends.push_back(i + node.points);
    } else {
      print(node, out);
    }
  }
  out.append(ends.size(), ')');
}

}  // namespace breve::push
