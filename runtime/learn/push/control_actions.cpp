// The instructions of the types CODE and EXEC that say what is done next: choices, loops, combinators.
//
// A loop is code on the EXEC stack that counts and puts itself back: ( next last EXEC.DO*RANGE body ). So programs can
// look at the rest of a loop and change it, as Spector, Klein and Keijzer (2005) describe.
#include "runtime/learn/push/edit.hpp"
#include "runtime/learn/push/stack_actions.hpp"

namespace breve::push {

namespace {

Code instruction_code(Interpreter& m, std::uint16_t number) { return atom(Node::of_instruction(number), m.memory()); }

// --- loops -----------------------------------------------------------------------------------------------------------

/// Where a loop's code has its parts: list, next, last, then one point, then the body.
constexpr std::uint32_t kNextAt = 1, kLastAt = 2, kBodyAt = 4;

/// The code of a loop over a body from the CODE or from the EXEC stack.
template <class S>
Code loop(Interpreter& m, std::int32_t next, std::int32_t last, const Code& body) {
  constexpr bool kQuotes = std::is_same_v<S, Codes>;
  Builder builder(m.memory());
  const std::uint32_t list = builder.begin_list();
  builder.atom(Node::of_integer(next));
  builder.atom(Node::of_integer(last));
  builder.atom(Node::of_instruction(kQuotes ? special().code_quote : special().exec_range));
  builder.copy(body);
  if (kQuotes) builder.atom(Node::of_instruction(special().code_range));
  builder.end_list(list);
  return builder.finish();
}

/// Is the body the last that is left of the code of the same loop, one iteration before? Then nobody sees it change.
template <class S>
bool is_rest_of_loop(const Code& body, std::int32_t last) {
  constexpr bool kQuotes = std::is_same_v<S, Codes>;
  const Block* block = body.block();
  if (body.at() != kBodyAt || block->shared() || block->points() != kBodyAt + body.points() + (kQuotes ? 1 : 0))
    return false;
  const Node* nodes = block->nodes();
  return nodes[0].is_list() && nodes[kNextAt].kind == Kind::Integer && nodes[kLastAt].kind == Kind::Integer &&
         nodes[kLastAt].integer == last && nodes[kBodyAt - 1].kind == Kind::Instruction &&
         nodes[kBodyAt - 1].instruction == (kQuotes ? special().code_quote : special().exec_range) &&
         (!kQuotes || (nodes[block->points() - 1].kind == Kind::Instruction &&
                       nodes[block->points() - 1].instruction == special().code_range)) &&
         nodes[0].points == block->points();
}

bool loop_fits(Interpreter& m, const Code& body) {
  return m.fits(body.points() > Interpreter::kLoopRoom ? body.points() - Interpreter::kLoopRoom : 1);
}

template <class S>
void do_range(Interpreter& m) {
  if (m.integers.size() < 2 || S::of(m).empty() || !loop_fits(m, S::of(m).back())) return;
  const Code body = take(S::of(m));
  const std::int32_t last = take(m.integers), current = take(m.integers);
  m.push(m.integers, current);
  if (current != last) {
    const std::int32_t next = current < last ? current + 1 : current - 1;
    if (is_rest_of_loop<S>(body, last)) {
      body.block()->nodes()[kNextAt].integer = next;
      body.block()->hold();
      m.push(m.execs, Code(body.block(), 0));
    } else {
      m.spend(body.points());
      m.push(m.execs, loop<S>(m, next, last, body));
    }
  }
  m.push(m.execs, body);
}

/// `kCounts`: the body finds the index on the INTEGER stack.
template <class S, bool kCounts>
void do_count(Interpreter& m) {
  if (m.integers.empty() || m.integers.back() <= 0 || S::of(m).empty() || !loop_fits(m, S::of(m).back())) return;
  Code body = take(S::of(m));
  const std::int32_t last = take(m.integers) - 1;
  m.spend(body.points());
  if (!kCounts) body = pair(instruction_code(m, special().integer_pop), body, m.memory());
  m.push(m.execs, loop<S>(m, 0, last, body));
}

// --- CODE ------------------------------------------------------------------------------------------------------------

/// Does the code, and only then takes it off the stack.
void do_code(Interpreter& m) {
  if (m.codes.empty()) return;
  m.push(m.execs, instruction_code(m, special().code_pop));
  m.push(m.execs, m.codes.back());
}

void take_and_do_code(Interpreter& m) {
  if (!m.codes.empty()) m.push(m.execs, take(m.codes));
}

void quote_code(Interpreter& m) {
  if (!m.execs.empty()) m.push(m.codes, take(m.execs));
}

/// TRUE does the second, FALSE the first.
void choose_code(Interpreter& m) {
  if (m.booleans.empty() || m.codes.size() < 2) return;
  Code top = take(m.codes), second = take(m.codes);
  m.push(m.execs, take(m.booleans) != 0 ? std::move(second) : std::move(top));
}

constexpr Instruction kLoopInstructions[] = {
    {"CODE.DO", do_code},
    {"CODE.DO*", take_and_do_code},
    {"CODE.DO*COUNT", do_count<Codes, true>},
    {"CODE.DO*RANGE", do_range<Codes>},
    {"CODE.DO*TIMES", do_count<Codes, false>},
    {"CODE.IF", choose_code},
    {"CODE.QUOTE", quote_code},
    {"EXEC.DO*COUNT", do_count<Execs, true>},
    {"EXEC.DO*RANGE", do_range<Execs>},
    {"EXEC.DO*TIMES", do_count<Execs, false>},
};

// --- EXEC ------------------------------------------------------------------------------------------------------------

/// TRUE leaves the first, FALSE the second.
void choose_next(Interpreter& m) {
  if (m.booleans.empty() || m.execs.size() < 2) return;
  const bool keeps_first = take(m.booleans) != 0;
  Code top = take(m.execs);
  if (keeps_first) m.execs.back() = std::move(top);
}

/// K x y = x
void combinator_k(Interpreter& m) {
  if (m.execs.size() < 2) return;
  Code top = take(m.execs);
  m.execs.back() = std::move(top);
}

/// S x y z = x z ( y z )
void combinator_s(Interpreter& m) {
  const std::size_t depth = m.execs.size();
  if (depth < 3) return;
  const std::uint64_t points = std::uint64_t{1} + m.execs[depth - 2].points() + m.execs[depth - 3].points();
  if (!m.fits(points)) return;
  m.spend(points);
  const Code x = take(m.execs), y = take(m.execs), z = take(m.execs);
  m.push(m.execs, pair(y, z, m.memory()));
  m.push(m.execs, z);
  m.push(m.execs, x);
}

/// Y x = x ( Y x )
void combinator_y(Interpreter& m) {
  if (m.execs.empty() || !m.fits(std::uint64_t{2} + m.execs.back().points())) return;
  const Code x = take(m.execs);
  m.spend(x.points());
  m.push(m.execs, pair(instruction_code(m, special().exec_y), x, m.memory()));
  m.push(m.execs, x);
}

constexpr Instruction kExecInstructions[] = {
    BREVE_PUSH_STACK_INSTRUCTIONS("EXEC", Execs),
    {"EXEC.DEFINE", define<Execs>},
    {"EXEC.IF", choose_next},
    {"EXEC.K", combinator_k},
    {"EXEC.S", combinator_s},
    {"EXEC.Y", combinator_y},
};

}  // namespace

std::span<const Instruction> loop_instructions() { return kLoopInstructions; }
std::span<const Instruction> exec_instructions() { return kExecInstructions; }

}  // namespace breve::push
