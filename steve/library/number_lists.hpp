// Lists of numbers between scripts and arrays.
#pragma once

#include <string>
#include <string_view>

#include "runtime/learn/network/numbers.hpp"
#include "steve/library/support.hpp"
#include "steve/machine/operators.hpp"

namespace breve::steve {

[[noreturn]] inline void refuse_argument(const std::string& why) { throw Error(ErrorCode::Argument, why); }

inline std::string decimal(std::int64_t number) { return std::to_string(number); }

/// The list of an argument. @throws RunError{Type} if it is not a list
inline const ListCell& list_of(const Value& value, std::string_view what) {
  if (value.tag != Tag::List || !value.list()) Machine::fail(RunErrorKind::Type, std::string(what) + " must be a list");
  return *value.list();
}

/// Copies the numbers of a list of `count` elements.
/// @throws Error{Argument} for another count, or a number that is not finite
inline void read_numbers(const ListCell& list, std::size_t count, double* numbers, std::string_view what) {
  if (list.size != count)
    throw Error(ErrorCode::Argument, std::string(what) + " has " + std::to_string(list.size) + " numbers (must be " +
                                         std::to_string(count) + ")");
  for (std::uint32_t i = 0; i < list.size; ++i) numbers[i] = finite(to_double(list[i], what), what);
}

/// A new list of these numbers.
inline ListCell* make_list(Machine& machine, const double* numbers, std::size_t count) {
  machine.charge_for(count);
  ListCell* list = machine.heap().list(static_cast<std::uint32_t>(count));
  for (std::size_t i = 0; i < count; ++i) machine.heap().push(*list, Value::of(numbers[i]));
  return list;
}

}  // namespace breve::steve
