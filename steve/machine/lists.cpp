// Lists: one store without gaps and with room at both ends, doubled when it is full.
#include <algorithm>
#include <unordered_map>

#include "steve/machine/heap.hpp"

namespace breve::steve {

namespace {

constexpr std::uint32_t kLeastCapacity = 4;
constexpr std::uint32_t kMostElements = 0x7fffffffU;

std::uint32_t doubled(std::uint32_t capacity) {
  return capacity > kMostElements / 2 ? kMostElements + 1 : std::max(kLeastCapacity, capacity * 2);
}

void check_size(std::uint32_t size) {
  if (size >= kMostElements) throw RunError(RunErrorKind::Bounds, "a list cannot have more than 2147483647 elements");
}

void move_values(Value* to, const Value* from, std::size_t count) {
  if (count != 0) std::memmove(static_cast<void*>(to), from, count * sizeof(Value));
}

}  // namespace

Value* Heap::new_store(std::uint32_t capacity) {
  return static_cast<Value*>(memory_->allocate(capacity * sizeof(Value), alignof(Value)));
}

void Heap::move_store(ListCell& list, std::uint32_t capacity, std::uint32_t first) {
  settle(list);
  if (capacity == list.capacity) {
    move_values(list.store + first, list.begin(), list.size);
  } else {
    Value* store = new_store(capacity);
    if (list.store != nullptr) {
      move_values(store + first, list.begin(), list.size);
      memory_->deallocate(list.store, list.capacity * sizeof(Value), alignof(Value));
    }
    list.store = store;
    list.capacity = capacity;
  }
  list.first = first;
}

// A queue that is pushed at one end and popped at the other slides within its store; each slide is paid for by at least
// a quarter of the capacity in cheap operations.
void Heap::make_room_behind(ListCell& list) {
  check_size(list.size);
  if (list.first > list.capacity / 2) return move_store(list, list.capacity, list.first / 4);
  move_store(list, doubled(list.capacity), list.first);
}

void Heap::make_room_before(ListCell& list) {
  check_size(list.size);
  const std::uint32_t behind = list.capacity - list.size;
  if (list.capacity != 0 && behind > list.capacity / 2) return move_store(list, list.capacity, behind - behind / 4);
  const std::uint32_t capacity = doubled(list.capacity);
  move_store(list, capacity, capacity - list.capacity);
}

void Heap::reserve(ListCell& list, std::uint32_t capacity) {
  if (capacity > kMostElements) check_size(kMostElements);
  if (capacity > list.capacity - list.first)
    move_store(list, std::max(capacity, list.capacity) + list.first, list.first);
}

void Heap::insert(ListCell& list, std::uint32_t position, const Value& value) {
  if (position == list.size) return push(list, value);
  if (position == 0) return prepend(list, value);
  const Value copy = value;
  settle(list);
  if (list.first > 0 && position <= list.size / 2) {
    --list.first;
    move_values(list.begin(), list.begin() + 1, position);
  } else {
    if (list.first + list.size == list.capacity) make_room_behind(list);
    move_values(list.begin() + position + 1, list.begin() + position, list.size - position);
  }
  retain(copy);
  list[position] = copy;
  ++list.size;
}

Value Heap::remove(ListCell& list, std::uint32_t position) {
  if (position + 1 == list.size) return pop(list);
  if (position == 0) return unprepend(list);
  settle(list);
  const Value removed = list[position];
  if (position < list.size / 2) {
    move_values(list.begin() + 1, list.begin(), position);
    ++list.first;
  } else {
    move_values(list.begin() + position, list.begin() + position + 1, list.size - position - 1);
  }
  --list.size;
  release(removed);
  return removed;
}

void Heap::resize(ListCell& list, std::uint32_t size) {
  if (size > list.size) {
    reserve(list, size);
    std::fill(list.end(), list.begin() + size, Value());
    list.size = size;
  }
  while (list.size > size) pop(list);
}

// A flat list costs one pass; the table of twins is touched for nested lists only.
ListCell* Heap::copy(const ListCell& original) {
  std::pmr::unordered_map<const ListCell*, ListCell*> twins(memory_);
  std::pmr::vector<const ListCell*> pending(memory_);  // originals whose twins are still empty, in order of discovery
  std::pmr::vector<ListCell*> made(memory_);
  const auto twin = [&](const ListCell* from) {
    const auto [place, fresh] = twins.try_emplace(from, nullptr);
    if (fresh) {
      pending.push_back(from);
      made.push_back(nullptr);
      made.back() = place->second = list(from->size);
    }
    return place->second;
  };
  try {
    ListCell* copied = twin(&original);
    for (std::size_t next = 0; next < pending.size(); ++next) {
      const ListCell& from = *pending[next];
      ListCell& to = *made[next];
      for (const Value& v : from) {
        const bool nested = v.tag == Tag::List && v.ref != nullptr;
        push(to, nested ? Value::of(Tag::List, twin(v.list())) : v);
      }
    }
    return copied;
  } catch (...) {
    for (ListCell* half : made)
      if (half != nullptr) resize(*half, 0);  // unties cycles among them: they go at the next reclaim
    throw;
  }
}

void merge_sort(Heap& heap, ListCell& list, const std::function<bool(const Value&, const Value&)>& before) {
  std::pmr::vector<Value> items(list.begin(), list.end(), heap.memory());
  std::pmr::vector<Value> other(items.size(), heap.memory());
  struct Pin {
    Heap& heap;
    const std::pmr::vector<Value> values;
    Pin(Heap& h, const std::pmr::vector<Value>& v) : heap(h), values(v, h.memory()) {
      for (const Value& value : values) heap.retain(value);
    }
    ~Pin() {
      for (const Value& value : values) heap.release(value);
    }
  } pin(heap, items);

  const std::size_t n = items.size();
  for (std::size_t width = 1; width < n; width *= 2) {
    for (std::size_t left = 0; left < n; left += 2 * width) {
      const std::size_t middle = std::min(left + width, n), end = std::min(left + 2 * width, n);
      std::size_t a = left, b = middle;
      for (std::size_t to = left; to < end; ++to) {
        const bool from_right = a == middle || (b < end && before(items[b], items[a]));
        other[to] = from_right ? items[b++] : items[a++];
      }
    }
    items.swap(other);
  }
  heap.resize(list, static_cast<std::uint32_t>(n));
  for (std::size_t i = 0; i < n; ++i) heap.store(list[static_cast<std::uint32_t>(i)], items[i]);
}

}  // namespace breve::steve
