// Pieces of code made from others.
#include "runtime/learn/push/edit.hpp"

#include <algorithm>

namespace breve::push {

namespace {

/// The lists that `point` is in, outermost first.
std::pmr::vector<std::uint32_t> ancestors(const Code& code, std::uint32_t point, Memory* memory) {
  std::pmr::vector<std::uint32_t> lists(memory);
  for (std::uint32_t at = 0; at != point;) {
    lists.push_back(at);
    ++at;
    while (code.next(at) <= point) at = code.next(at);
  }
  return lists;
}

/// With `count` points at `nodes` in the place of the subtree at `point`, which is not 0.
Code spliced(const Code& code, std::uint32_t point, const Node* nodes, std::uint32_t count, Memory* memory) {
  Builder builder(memory);
  const std::uint32_t after = code.next(point), removed = after - point;
  builder.add(code.nodes(), point);
  builder.add(nodes, count);
  builder.add(code.nodes() + after, code.points() - after);
  for (const std::uint32_t list : ancestors(code, point, memory)) builder.nodes()[list].points += count - removed;
  return builder.finish();
}

}  // namespace

Code append(const Code& first, const Code& second, Memory* memory) {
  Builder builder(memory);
  const std::uint32_t list = builder.begin_list();
  builder.items(first);
  builder.items(second);
  builder.end_list(list);
  return builder.finish();
}

Code cons(const Code& item, const Code& rest, Memory* memory) {
  Builder builder(memory);
  const std::uint32_t list = builder.begin_list();
  builder.copy(item);
  builder.items(rest);
  builder.end_list(list);
  return builder.finish();
}

Code pair(const Code& first, const Code& second, Memory* memory) {
  Builder builder(memory);
  const std::uint32_t list = builder.begin_list();
  builder.copy(first);
  builder.copy(second);
  builder.end_list(list);
  return builder.finish();
}

Code rest(const Code& code, std::uint32_t count, Memory* memory) {
  Builder builder(memory);
  const std::uint32_t list = builder.begin_list();
  if (code.is_list()) {
    std::uint32_t at = 1;
    for (; count > 0 && at < code.points(); --count) at = code.next(at);
    builder.add(code.nodes() + at, code.points() - at);
  } else if (count == 0) {
    builder.copy(code);
  }
  builder.end_list(list);
  return builder.finish();
}

Code item(const Code& code, std::uint32_t index) {
  if (!code.is_list()) return code;
  std::uint32_t at = 1;
  for (; index > 0; --index) at = code.next(at);
  return code.part(at);
}

Code replace(const Code& code, std::uint32_t point, const Code& with, Memory* memory) {
  if (point == 0) return with;
  return spliced(code, point, with.nodes(), with.points(), memory);
}

Code remove(const Code& code, std::uint32_t point, Memory* memory) {
  if (point == 0) return empty_list(memory);
  return spliced(code, point, nullptr, 0, memory);
}

Code flatten(const Code& code, std::uint32_t point, Memory* memory) {
  const Node& list = code.nodes()[point];
  if (point == 0 || !list.is_list()) return code;
  return spliced(code, point, &list + 1, list.points - 1, memory);
}

Code swap_items(const Code& code, std::uint32_t a, std::uint32_t b, Memory* memory) {
  Builder builder(memory);
  const Code first = item(code, a), second = item(code, b);
  const std::uint32_t at_first = first.at() - code.at(), at_second = second.at() - code.at();
  const std::uint32_t after_first = at_first + first.points(), after_second = at_second + second.points();
  builder.add(code.nodes(), at_first);
  builder.copy(second);
  builder.add(code.nodes() + after_first, at_second - after_first);
  builder.copy(first);
  builder.add(code.nodes() + after_second, code.points() - after_second);
  return builder.finish();
}

Code substitute(const Code& code, const Code& what, const Code& with, Memory* memory) {
  Builder builder(memory);
  struct Open {
    std::uint32_t end, list;  // of the source; in the builder
  };
  std::pmr::vector<Open> open(memory);
  for (std::uint32_t i = 0; i < code.points();) {
    const Node& node = code.nodes()[i];
    if (node.points == what.points() && code.part(i) == what) {
      builder.copy(with);
      i += node.points;
    } else if (node.is_list()) {
      open.push_back({i + node.points, builder.begin_list()});
      ++i;
    } else {
      builder.atom(node);
      ++i;
    }
    for (; !open.empty() && open.back().end == i; open.pop_back()) builder.end_list(open.back().list);
  }
  return builder.finish();
}

std::uint64_t points_substituted(const Code& code, const Code& what, const Code& with) {
  std::uint64_t points = code.points();
  for (std::uint32_t i = 0; i < code.points();) {
    const bool equal = code.nodes()[i].points == what.points() && code.part(i) == what;
    if (equal) points += with.points() - std::uint64_t{what.points()};
    i += equal ? what.points() : 1;
  }
  return points;
}

std::optional<std::uint32_t> find(const Code& code, const Code& what) {
  for (std::uint32_t i = 0; i < code.points(); ++i)
    if (code.nodes()[i].points == what.points() && code.part(i) == what) return i;
  return {};
}

std::optional<std::uint32_t> position(const Code& code, const Code& what) {
  if (!code.is_list()) return code == what ? std::optional<std::uint32_t>(0) : std::nullopt;
  std::uint32_t index = 0;
  for (std::uint32_t i = 1; i < code.points(); i = code.next(i), ++index)
    if (code.part(i) == what) return index;
  return {};
}

std::optional<Code> container(const Code& code, const Code& what) {
  const std::optional<std::uint32_t> point = find(code, what);
  if (!point || *point == 0) return {};
  return code.part(ancestors(code, *point, code.block()->memory()).back());
}

// --- difference ------------------------------------------------------------------------------------------------------

namespace {

/// A subtree by its hash of 64 bits, and which of the two pieces it is in.
struct Item {
  std::uint64_t hash;
  bool second;
};

/// Every subtree but the whole, which is the list that the items are in. The hash of a list is that of its items in
/// order, so points are visited from the last to the first.
void collect(const Code& code, bool second, std::pmr::vector<Item>& items) {
  std::pmr::vector<std::uint64_t> hashes(code.points(), items.get_allocator());
  for (std::uint32_t i = code.points(); i-- > 0;) {
    Hasher hasher;
    hasher.add(point_hash(code.nodes()[i]));
    for (std::uint32_t at = i + 1; at < code.next(i); at = code.next(at)) hasher.add(hashes[at]);
    hashes[i] = hasher.value();
    if (i > 0 || !code.is_list()) items.push_back({hashes[i], second});
  }
}

}  // namespace

std::uint32_t discrepancy(const Code& a, const Code& b, Memory* memory) {
  std::pmr::vector<Item> items(memory);
  items.reserve(std::size_t{a.points()} + b.points());
  collect(a, false, items);
  collect(b, true, items);
  std::sort(items.begin(), items.end(), [](const Item& x, const Item& y) { return x.hash < y.hash; });
  std::uint32_t sum = 0;
  for (std::size_t begin = 0, end = 0; begin < items.size(); begin = end) {
    std::int64_t difference = 0;
    for (; end < items.size() && items[end].hash == items[begin].hash; ++end) difference += items[end].second ? 1 : -1;
    sum += static_cast<std::uint32_t>(difference < 0 ? -difference : difference);
  }
  return sum;
}

std::uint32_t top_level_difference(const Code& a, const Code& b) {
  const std::uint32_t first = a.is_list() ? 1 : 0, second = b.is_list() ? 1 : 0;
  std::uint32_t i = first, j = second, difference = 0;
  while (i < a.points() && j < b.points()) {
    if (!(a.part(i) == b.part(j))) ++difference;
    i = a.next(i);
    j = b.next(j);
  }
  for (; i < a.points(); i = a.next(i)) ++difference;
  for (; j < b.points(); j = b.next(j)) ++difference;
  return difference;
}

}  // namespace breve::push
