// The instructions of the type CODE that take code apart and put it together. "First" is the top of the stack.
#include "runtime/learn/push/edit.hpp"
#include "runtime/learn/push/random_code.hpp"
#include "runtime/learn/push/stack_actions.hpp"

namespace breve::push {

namespace {

const Code& first(Interpreter& m) { return m.codes.back(); }
const Code& second(Interpreter& m) { return m.codes[m.codes.size() - 2]; }
bool has_two(Interpreter& m) {
  if (m.codes.size() < 2) return false;
  m.spend(std::uint64_t{first(m).points()} + second(m).points());
  return true;
}
bool has_one(Interpreter& m) {
  if (m.codes.empty()) return false;
  m.spend(first(m).points());
  return true;
}

void push_truth(Interpreter& m, bool value) { m.push(m.booleans, static_cast<std::uint8_t>(value)); }

/// `made` in place of the `count` topmost.
void give(Interpreter& m, std::size_t count, Code made) {
  for (; count > 0; --count) m.codes.pop_back();
  m.push(m.codes, std::move(made));
}

// --- two pieces become one -------------------------------------------------------------------------------------------

void append_code(Interpreter& m) {
  if (!has_two(m) || !m.fits(std::uint64_t{1} + first(m).points() + second(m).points())) return;
  give(m, 2, append(second(m), first(m), m.memory()));
}

void cons_code(Interpreter& m) {
  if (!has_two(m) || !m.fits(std::uint64_t{1} + first(m).points() + second(m).points())) return;
  give(m, 2, cons(second(m), first(m), m.memory()));
}

void list_code(Interpreter& m) {
  if (!has_two(m) || !m.fits(std::uint64_t{1} + first(m).points() + second(m).points())) return;
  give(m, 2, pair(second(m), first(m), m.memory()));
}

void container_of_code(Interpreter& m) {
  if (!has_two(m)) return;
  std::optional<Code> found = container(first(m), second(m));
  give(m, 2, found ? std::move(*found) : empty_list(m.memory()));
}

/// A subtree's number: the absolute value of an integer, modulo their count.
std::uint32_t indexed(std::int32_t integer, std::uint32_t count) {
  return static_cast<std::uint32_t>(std::abs(std::int64_t{integer}) % count);
}

void insert_code(Interpreter& m) {
  if (m.integers.empty() || !has_two(m)) return;
  const std::uint32_t point = indexed(m.integers.back(), first(m).points());
  const std::uint64_t kept = first(m).points() - first(m).nodes()[point].points;
  if (!m.fits(kept + second(m).points())) return;
  m.integers.pop_back();
  give(m, 2, replace(first(m), point, second(m), m.memory()));
}

/// The third for each second in the first.
void substitute_code(Interpreter& m) {
  if (m.codes.size() < 3 || !has_two(m)) return;
  const Code& third = m.codes[m.codes.size() - 3];
  const std::uint64_t points = points_substituted(first(m), second(m), third);
  if (!m.fits(points)) return;
  m.spend(points);
  give(m, 3, substitute(first(m), second(m), third, m.memory()));
}

// --- parts -----------------------------------------------------------------------------------------------------------

void first_item(Interpreter& m) {
  if (!has_one(m) || !first(m).is_list() || first(m).is_empty()) return;
  give(m, 1, item(first(m), 0));
}

void rest_of_code(Interpreter& m) {
  if (has_one(m)) give(m, 1, rest(first(m), 1, m.memory()));
}

void extract_code(Interpreter& m) {
  if (m.integers.empty() || !has_one(m)) return;
  const std::uint32_t point = indexed(take(m.integers), first(m).points());
  give(m, 1, first(m).part(point));
}

void nth_item(Interpreter& m) {
  if (m.integers.empty() || !has_one(m)) return;
  const std::int32_t index = take(m.integers);
  if (!first(m).is_empty()) give(m, 1, item(first(m), indexed(index, first(m).length())));
}

void nth_rest(Interpreter& m) {
  if (m.integers.empty() || !has_one(m)) return;
  const std::int32_t index = take(m.integers);
  if (!first(m).is_empty()) give(m, 1, rest(first(m), indexed(index, first(m).length()), m.memory()));
}

// --- questions -------------------------------------------------------------------------------------------------------

void is_atom(Interpreter& m) {
  if (has_one(m)) push_truth(m, !take(m.codes).is_list());
}

void is_null(Interpreter& m) {
  if (has_one(m)) push_truth(m, take(m.codes).is_empty());
}

void length_of_code(Interpreter& m) {
  if (has_one(m)) m.push(m.integers, static_cast<std::int32_t>(take(m.codes).length()));
}

void size_of_code(Interpreter& m) {
  if (has_one(m)) m.push(m.integers, static_cast<std::int32_t>(take(m.codes).points()));
}

void contains_code(Interpreter& m) {
  if (!has_two(m)) return;
  const Code what = take(m.codes), in = take(m.codes);
  push_truth(m, find(in, what).has_value());
}

void is_member(Interpreter& m) {
  if (!has_two(m)) return;
  const Code in = take(m.codes), what = take(m.codes);
  push_truth(m, position(in, what).has_value());
}

void position_of_code(Interpreter& m) {
  if (!has_two(m)) return;
  const Code in = take(m.codes), what = take(m.codes);
  const std::optional<std::uint32_t> index = position(in, what);
  m.push(m.integers, index ? static_cast<std::int32_t>(*index) : -1);
}

void discrepancy_of_codes(Interpreter& m) {
  if (!has_two(m)) return;
  const Code a = take(m.codes), b = take(m.codes);
  m.push(m.integers, static_cast<std::int32_t>(discrepancy(a, b, m.memory())));
}

// --- code from elsewhere ---------------------------------------------------------------------------------------------

template <class S>
void code_of(Interpreter& m) {
  if (!S::of(m).empty()) m.push(m.codes, S::code(m, take(S::of(m))));
}

void code_of_name(Interpreter& m) {
  if (!m.names.empty()) m.push(m.codes, take(m.names));
}

void definition_of_name(Interpreter& m) {
  if (m.names.empty()) return;
  const Word* word = m.find_word(m.names.back().root().name->text());
  if (!word || !word->code) return;
  m.names.pop_back();
  m.push(m.codes, *word->code);
}

void active_instructions(Interpreter& m) {
  Builder builder(m.memory());
  const std::uint32_t list = builder.begin_list();
  for (const std::uint16_t number : m.settings.active) builder.atom(Node::of_instruction(number));
  for (const auto& [text, word] : m.words())
    if (word.kind != Word::Kind::Defined) builder.name(text);
  builder.end_list(list);
  m.spend(builder.size());
  if (m.fits(builder.size())) m.push(m.codes, builder.finish());
}

/// Of at most as many points as the integer says, modulo the greatest size of random code.
void random_code(Interpreter& m) {
  if (m.integers.empty()) return;
  const std::uint32_t most = indexed(take(m.integers), static_cast<std::uint32_t>(m.settings.random_points));
  Code made = CodeSource(m, m.random()).random_code(most);
  m.spend(made.points());
  m.push(m.codes, std::move(made));
}

void nothing(Interpreter&) {}

constexpr Instruction kCodeInstructions[] = {
    BREVE_PUSH_STACK_INSTRUCTIONS("CODE", Codes),
    {"CODE.DEFINE", define<Codes>},
    {"CODE.APPEND", append_code},
    {"CODE.ATOM", is_atom},
    {"CODE.CAR", first_item},
    {"CODE.CDR", rest_of_code},
    {"CODE.CONS", cons_code},
    {"CODE.CONTAINER", container_of_code},
    {"CODE.CONTAINS", contains_code},
    {"CODE.DEFINITION", definition_of_name},
    {"CODE.DISCREPANCY", discrepancy_of_codes},
    {"CODE.EXTRACT", extract_code},
    {"CODE.FROMBOOLEAN", code_of<Booleans>},
    {"CODE.FROMFLOAT", code_of<Floats>},
    {"CODE.FROMINTEGER", code_of<Integers>},
    {"CODE.FROMNAME", code_of_name},
    {"CODE.FROMVECTOR", code_of<Vectors>},
    {"CODE.INSERT", insert_code},
    {"CODE.INSTRUCTIONS", active_instructions},
    {"CODE.LENGTH", length_of_code},
    {"CODE.LIST", list_code},
    {"CODE.MEMBER", is_member},
    {"CODE.NOOP", nothing},
    {"CODE.NTH", nth_item},
    {"CODE.NTHCDR", nth_rest},
    {"CODE.NULL", is_null},
    {"CODE.POSITION", position_of_code},
    {"CODE.RAND", random_code},
    {"CODE.SIZE", size_of_code},
    {"CODE.SUBST", substitute_code},
};

}  // namespace

std::span<const Instruction> code_instructions() { return kCodeInstructions; }

}  // namespace breve::push
