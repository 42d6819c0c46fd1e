// What instructions of every type do with their stack: DUP, POP, SWAP, ROT, FLUSH, STACKDEPTH, SHOVE, YANK, YANKDUP, =,
// DEFINE. A stack is named by a type with `of`, and `atom` for what a name can be defined as.
#pragma once

#include <algorithm>
#include <utility>

#include "runtime/learn/push/instructions.hpp"
#include "runtime/learn/push/interpreter.hpp"

namespace breve::push {

struct Integers {
  static auto& of(Interpreter& m) { return m.integers; }
  static Code code(Interpreter& m, std::int32_t x) { return atom(Node::of_integer(x), m.memory()); }
};
struct Floats {
  static auto& of(Interpreter& m) { return m.floats; }
  static Code code(Interpreter& m, double x) { return atom(Node::of_float(x), m.memory()); }
};
struct Booleans {
  static auto& of(Interpreter& m) { return m.booleans; }
  static Code code(Interpreter& m, std::uint8_t x) { return atom(Node::of_boolean(x != 0), m.memory()); }
};
struct Vectors {
  static auto& of(Interpreter& m) { return m.vectors; }
  static Code code(Interpreter& m, const Vector3& x) { return atom(Node::of_vector(x), m.memory()); }
};
struct Names {
  static auto& of(Interpreter& m) { return m.names; }
};
struct Codes {
  static auto& of(Interpreter& m) { return m.codes; }
  static Code code(Interpreter&, Code x) { return x; }
};
struct Execs {
  static auto& of(Interpreter& m) { return m.execs; }
  static Code code(Interpreter&, Code x) { return x; }
};

/// The top of a stack that is not empty, taken off.
template <class T>
T take(Stack<T>& stack) {
  T top = std::move(stack.back());
  stack.pop_back();
  return top;
}

template <class S>
void duplicate(Interpreter& m) {
  if (S::of(m).empty()) return;
  auto top = S::of(m).back();
  m.push(S::of(m), std::move(top));
}

template <class S>
void pop(Interpreter& m) {
  if (!S::of(m).empty()) S::of(m).pop_back();
}

template <class S>
void swap(Interpreter& m) {
  auto& stack = S::of(m);
  if (stack.size() >= 2) std::swap(stack[stack.size() - 1], stack[stack.size() - 2]);
}

/// The third comes to the top.
template <class S>
void rotate(Interpreter& m) {
  auto& stack = S::of(m);
  if (stack.size() >= 3) std::rotate(stack.end() - 3, stack.end() - 2, stack.end());
}

template <class S>
void flush(Interpreter& m) {
  m.spend(S::of(m).size());
  S::of(m).clear();
}

template <class S>
void depth(Interpreter& m) {
  m.push(m.integers, static_cast<std::int32_t>(S::of(m).size()));
}

/// An index from the INTEGER stack into S, which is not empty without it: how deep, 0 is the top. Beyond either end it
/// is that end. Counts the items above, which move. Does nothing if there is no such index.
template <class S>
std::optional<std::ptrdiff_t> take_index(Interpreter& m) {
  constexpr bool kOwn = std::is_same_v<S, Integers>;
  if (m.integers.empty() || S::of(m).size() < (kOwn ? 2U : 1U)) return {};
  const std::int32_t wanted = take(m.integers);
  const auto most = static_cast<std::int64_t>(S::of(m).size()) - 1;
  const std::int64_t index = std::clamp<std::int64_t>(wanted, 0, most);
  m.spend(static_cast<std::uint64_t>(index));
  return index;
}

template <class S>
void yank(Interpreter& m) {
  if (const auto index = take_index<S>(m)) {
    auto& stack = S::of(m);
    std::rotate(stack.end() - 1 - *index, stack.end() - *index, stack.end());
  }
}

template <class S>
void yank_duplicate(Interpreter& m) {
  if (const auto index = take_index<S>(m)) {
    auto item = *(S::of(m).end() - 1 - *index);
    m.push(S::of(m), std::move(item));
  }
}

template <class S>
void shove(Interpreter& m) {
  if (const auto index = take_index<S>(m)) {
    auto& stack = S::of(m);
    std::rotate(stack.end() - 1 - *index, stack.end() - 1, stack.end());
  }
}

template <class S>
void equal(Interpreter& m) {
  auto& stack = S::of(m);
  if (stack.size() < 2) return;
  const auto top = take(stack);
  const auto second = take(stack);
  if constexpr (std::is_same_v<std::remove_const_t<decltype(top)>, Code>) m.spend(top.points());
  m.push(m.booleans, static_cast<std::uint8_t>(second == top));
}

template <class S>
void define(Interpreter& m) {
  if (m.names.empty() || S::of(m).empty()) return;
  const Code name = take(m.names);
  m.define(name, S::code(m, take(S::of(m))));
}

}  // namespace breve::push

// The rows of the table that every type has.
#define BREVE_PUSH_STACK_INSTRUCTIONS(TYPE, S)                                                                      \
  {TYPE ".=", equal<S>}, {TYPE ".DUP", duplicate<S>}, {TYPE ".FLUSH", flush<S>}, {TYPE ".POP", pop<S>},             \
      {TYPE ".ROT", rotate<S>}, {TYPE ".SHOVE", shove<S>}, {TYPE ".STACKDEPTH", depth<S>}, {TYPE ".SWAP", swap<S>}, \
      {TYPE ".YANK", yank<S>}, {                                                                                    \
    TYPE ".YANKDUP", yank_duplicate<S>                                                                              \
  }
