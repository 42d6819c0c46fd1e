// Binding C++ functions to scripts: the type of the function is its script signature. Arguments arrive in untagged
// slots, converted by the call site, so a native is one call away from the bytecode.
#pragma once

#include <array>
#include <span>
#include <string>
#include <type_traits>
#include <utility>

#include "steve/code/native.hpp"
#include "steve/machine/cells.hpp"
#include "steve/machine/value.hpp"

namespace breve::steve {

/// How a C++ type stands in slots. Letters: i d v m s o l h p b(data) a(any) n(nothing).
template <class T>
struct SlotType;

#define BREVE_SLOT_TYPE(TYPE, LETTER, SLOTS, FROM, TO)                \
  template <>                                                         \
  struct SlotType<TYPE> {                                             \
    static constexpr char letter = LETTER;                            \
    static constexpr int slots = SLOTS;                               \
    static TYPE from([[maybe_unused]] const Slot* s) { return FROM; } \
    static Value to([[maybe_unused]] TYPE x) { return TO; }           \
  }
BREVE_SLOT_TYPE(std::int32_t, 'i', 1, s->i, Value::of(x));
BREVE_SLOT_TYPE(double, 'd', 1, s->d, Value::of(x));
BREVE_SLOT_TYPE(Vector3, 'v', 3, Vector3(s[0].d, s[1].d, s[2].d), Value::of(x));
BREVE_SLOT_TYPE(StringCell*, 's', 1, static_cast<StringCell*>(s->ref), Value::of(Tag::String, x));
BREVE_SLOT_TYPE(Instance*, 'o', 1, static_cast<Instance*>(s->ref), Value::of(Tag::Object, x));
BREVE_SLOT_TYPE(ListCell*, 'l', 1, static_cast<ListCell*>(s->ref), Value::of(Tag::List, x));
BREVE_SLOT_TYPE(HashCell*, 'h', 1, static_cast<HashCell*>(s->ref), Value::of(Tag::Hash, x));
BREVE_SLOT_TYPE(PointerCell*, 'p', 1, static_cast<PointerCell*>(s->ref), Value::of(Tag::Pointer, x));
BREVE_SLOT_TYPE(DataCell*, 'b', 1, static_cast<DataCell*>(s->ref), Value::of(Tag::Data, x));
BREVE_SLOT_TYPE(MatrixCell*, 'm', 9, nullptr, Value::of(Tag::Matrix, x));  // as a result; parameters take Matrix3
#undef BREVE_SLOT_TYPE
template <>
struct SlotType<Matrix3> {
  static constexpr char letter = 'm';
  static constexpr int slots = 9;
  static Matrix3 from(const Slot* s) {
    Matrix3 m;
    for (int i = 0; i < 9; ++i) m.data()[i] = s[i].d;
    return m;
  }
};
template <>
struct SlotType<Value> {
  static constexpr char letter = 'a';
  static constexpr int slots = 4;
  static Value from(const Slot* s) {
    Value v;
    std::memcpy(static_cast<void*>(&v), s, sizeof v);
    return v;
  }
  static Value to(const Value& x) { return x; }
};

/// Count the work of looking through so many bytes of an argument.
void charge_for_argument(Machine& machine, std::size_t bytes);

namespace detail {

/// A large argument is work, whatever the native does with it.
template <class T>
void meter(Machine& machine, const T& argument) {
  constexpr std::size_t kLarge = 4096;  // bytes
  std::size_t bytes = 0;
  if constexpr (std::is_same_v<T, StringCell*>)
    bytes = argument ? argument->size : 0;
  else if constexpr (std::is_same_v<T, ListCell*>)
    bytes = argument ? argument->size * sizeof(Value) : 0;
  if (bytes > kLarge) [[unlikely]]
    charge_for_argument(machine, bytes);
}

template <class T>
using Plain = std::remove_cv_t<std::remove_reference_t<T>>;

template <class R>
constexpr char result_letter() {
  if constexpr (std::is_void_v<R>)
    return 'n';
  else
    return SlotType<Plain<R>>::letter;
}

template <auto F, class R, class... A>
struct Binder {
  static constexpr std::array<char, sizeof...(A) + 3> kSignature = {SlotType<Plain<A>>::letter..., ':',
                                                                    result_letter<R>(), '\0'};
  template <std::size_t... I>
  static R apply(Machine& machine, Instance& self, const Slot* args, std::index_sequence<I...>) {
    [[maybe_unused]] constexpr std::array<int, sizeof...(A) + 1> sizes = {SlotType<Plain<A>>::slots..., 0};
    [[maybe_unused]] constexpr auto offset = [](std::size_t n, const auto& s) {
      int sum = 0;
      for (std::size_t i = 0; i < n; ++i) sum += s[i];
      return sum;
    };
    (void)args;
    (meter<Plain<A>>(machine, SlotType<Plain<A>>::from(args + offset(I, sizes))), ...);
    return F(machine, self, SlotType<Plain<A>>::from(args + offset(I, sizes))...);
  }
  static void call(Machine& machine, Instance& self, const Slot* args, Value& result) {
    if constexpr (std::is_void_v<R>) {
      apply(machine, self, args, std::index_sequence_for<A...>());
      result = Value();
    } else {
      result = SlotType<Plain<R>>::to(apply(machine, self, args, std::index_sequence_for<A...>()));
    }
  }
};

template <auto F, class R, class... A>
constexpr Native bind(std::string_view name, Reach reach, R (*)(Machine&, Instance&, A...)) {
  using B = Binder<F, R, A...>;
  return {name, &B::call, std::string_view(B::kSignature.data(), sizeof...(A) + 2), reach};
}

}  // namespace detail

/// native<f>("real.move"), with `R f(Machine&, Instance& self, parameters...)`. A function that yields a matrix
/// returns machine.heap().matrix(m); one that yields a string, machine.heap().string(text).
template <auto F>
constexpr Native native(std::string_view name, Reach reach = Reach::World) {
  return detail::bind<F>(name, reach, F);
}

/// Every function that scripts may call. Tables of the files that define them, concatenated.
std::span<const Native> functions();

}  // namespace breve::steve
