// Pieces of code made from others, and questions about them. No depth of nesting costs stack; each costs time in
// proportion to the points that it looks at. Results are made in `memory`.
//
// Source of what the questions mean: Spector, Perry, Klein and Keijzer, Push 3.0 Programming Language Description,
// 2004.
#pragma once

#include <optional>

#include "runtime/learn/push/code.hpp"

namespace breve::push {

using Memory = std::pmr::memory_resource;

/// The items of `first`, then those of `second`; an atom counts as a list of itself.
Code append(const Code& first, const Code& second, Memory* memory);
/// A list that begins with `item` and goes on with the items of `rest`.
Code cons(const Code& item, const Code& rest, Memory* memory);
/// ( first second )
Code pair(const Code& first, const Code& second, Memory* memory);
/// The list without its first `count` items; an atom counts as a list of itself.
Code rest(const Code& code, std::uint32_t count, Memory* memory);
/// The item at `place` of a list that has it; an atom counts as a list of itself.
Code item(const Code& code, std::uint32_t index);

/// With the subtree at `point` replaced.
Code replace(const Code& code, std::uint32_t point, const Code& with, Memory* memory);
/// Without the subtree at `point`; the empty list without point 0.
Code remove(const Code& code, std::uint32_t point, Memory* memory);
/// With the items of the list at `point` in its place. Point 0: unchanged.
Code flatten(const Code& code, std::uint32_t point, Memory* memory);
/// With two items of the list exchanged. @pre a < b, both below length()
Code swap_items(const Code& code, std::uint32_t a, std::uint32_t b, Memory* memory);
/// Each subtree equal to `what` replaced by `with`; what is put in is not searched.
Code substitute(const Code& code, const Code& what, const Code& with, Memory* memory);
/// The points that substitute() would give.
std::uint64_t points_substituted(const Code& code, const Code& what, const Code& with);

/// The first point whose subtree is equal to `what`; none: nothing.
std::optional<std::uint32_t> find(const Code& code, const Code& what);
/// The place among the items of the first that is equal to `what`; an atom counts as a list of itself.
std::optional<std::uint32_t> position(const Code& code, const Code& what);
/// The list that the first point equal to `what` is an item of; nothing if there is none.
std::optional<Code> container(const Code& code, const Code& what);

/// Sum over all different items, at any depth, of by how much the numbers of their occurrences differ.
std::uint32_t discrepancy(const Code& a, const Code& b, Memory* memory);
/// By how much the lengths differ, plus the number of places with different items.
std::uint32_t top_level_difference(const Code& a, const Code& b);

}  // namespace breve::push
