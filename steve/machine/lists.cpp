// Lists: one store without gaps and with room at both ends, doubled when it is full. Elements of one type stand in it
// without their tags (as V8's arrays and PyPy's list strategies have it); the first other one makes the list wide.
//
// Source: Bolz, Diekmann and Tratt 2013, "Storage strategies for collections in dynamically typed languages".
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

/// Move `count` elements of `list` from one position of the store to another.
void shift(ListCell& list, std::uint32_t to, std::uint32_t from, std::uint32_t count) {
  const std::size_t bytes = list.element_bytes();
  auto* store = reinterpret_cast<char*>(list.store);
  if (count != 0) std::memmove(store + to * bytes, store + from * bytes, count * bytes);
}

}  // namespace

void Heap::free_store(ListCell& list) {
  if (list.store != nullptr) memory_->deallocate(list.store, list.capacity * list.element_bytes(), alignof(Slot));
  list.store = nullptr;
  list.capacity = list.first = 0;
}

void Heap::move_store(ListCell& list, std::uint32_t capacity, std::uint32_t first) {
  settle(list);
  if (capacity == list.capacity) {
    shift(list, first, list.first, list.size);
  } else {
    const std::size_t bytes = list.element_bytes();
    auto* store = static_cast<Slot*>(memory_->allocate(capacity * bytes, alignof(Slot)));
    if (list.size != 0)
      std::memcpy(reinterpret_cast<char*>(store) + first * bytes,
                  reinterpret_cast<const char*>(list.store) + list.first * bytes, list.size * bytes);
    free_store(list);
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
  move_store(list, std::max(doubled(list.capacity), list.wish), list.first);
}

void Heap::make_room_before(ListCell& list) {
  check_size(list.size);
  const std::uint32_t behind = list.capacity - list.size;
  if (list.capacity != 0 && behind > list.capacity / 2) return move_store(list, list.capacity, behind - behind / 4);
  const std::uint32_t capacity = std::max(doubled(list.capacity), list.wish);
  move_store(list, capacity, capacity - list.capacity);
}

void Heap::reserve(ListCell& list, std::uint32_t capacity) {
  if (capacity > kMostElements) check_size(kMostElements);
  if (list.store == nullptr) {
    list.wish = std::max(list.wish, capacity);
  } else if (capacity > list.capacity - list.first) {
    move_store(list, std::max(capacity, list.capacity) + list.first, list.first);
  }
}

// --- narrow and wide -------------------------------------------------------------------------------------------------

/// Make `list` one that can hold an element of type `tag`. An empty list takes the kind of its first element.
void Heap::fit(ListCell& list, Tag tag) {
  if (list.size == 0) {
    const Tag kind = ListCell::fits_slot(tag) ? tag : Tag::Null;
    settle(list);
    if (list.narrow() != (kind != Tag::Null)) free_store(list);
    list.kind = kind;
  } else if (list.narrow() && list.kind != tag) {
    widen(list);
  }
}

void Heap::widen(ListCell& list) {
  settle(list);
  auto* store = static_cast<Slot*>(memory_->allocate(list.capacity * sizeof(Value), alignof(Slot)));
  auto* to = reinterpret_cast<Value*>(store) + list.first;
  for (std::uint32_t i = 0; i < list.size; ++i) new (to + i) Value(list[i]);
  const std::uint32_t first = list.first, capacity = list.capacity;
  free_store(list);
  list.kind = Tag::Null;
  list.store = store;
  list.first = first;
  list.capacity = capacity;
}

void Heap::put(ListCell& list, std::uint32_t position, const Value& value) {
  if (list.narrow())
    list.store[list.first + position].bits = value.bits[0];
  else
    new (list.values() + list.first + position) Value(value);
}

void Heap::push_slowly(ListCell& list, const Value& value) {
  fit(list, value.tag);
  if (list.first + list.size == list.capacity) make_room_behind(list);
  retain(value);
  put(list, list.size, value);
  ++list.size;
}

void Heap::prepend(ListCell& list, const Value& value) {
  fit(list, value.tag);
  if (list.first == 0) make_room_before(list);
  retain(value);
  --list.first;
  ++list.size;
  put(list, 0, value);
}

void Heap::set(ListCell& list, std::uint32_t position, const Value& value) {
  if (list.narrow() && list.kind != value.tag) widen(list);
  const Value old = list[position];
  retain(value);
  put(list, position, value);
  release(old);
}

void Heap::insert(ListCell& list, std::uint32_t position, const Value& value) {
  if (position == list.size) return push(list, value);
  if (position == 0) return prepend(list, value);
  fit(list, value.tag);
  settle(list);
  if (position <= list.size / 2) {
    if (list.first == 0) make_room_before(list);  // what is counted must not depend on the room that the past left
    --list.first;
    move_bytes(position * sizeof(Value));
    shift(list, list.first, list.first + 1, position);
  } else {
    if (list.first + list.size == list.capacity) make_room_behind(list);
    move_bytes((list.size - position) * sizeof(Value));
    shift(list, list.first + position + 1, list.first + position, list.size - position);
  }
  retain(value);
  put(list, position, value);
  ++list.size;
}

Value Heap::remove(ListCell& list, std::uint32_t position) {
  if (position + 1 == list.size) return pop(list);
  if (position == 0) return unprepend(list);
  settle(list);
  const Value removed = list[position];
  if (position < list.size / 2) {
    move_bytes(position * sizeof(Value));
    shift(list, list.first + 1, list.first, position);
    ++list.first;
  } else {
    move_bytes((list.size - position - 1) * sizeof(Value));
    shift(list, list.first + position, list.first + position + 1, list.size - position - 1);
  }
  --list.size;
  release(removed);
  return removed;
}

void Heap::resize(ListCell& list, std::uint32_t size) {
  if (size > list.size) reserve(list, size);
  while (list.size < size) push(list, Value());
  while (list.size > size) pop(list);
}

// A flat list costs one pass; the table of twins is touched for nested lists only.
ListCell* Heap::copy(const ListCell& original) {
  std::pmr::unordered_map<const ListCell*, ListCell*> twins(memory_);
  std::pmr::vector<const ListCell*> pending(memory_);  // originals whose twins are still empty, in order of discovery
  std::pmr::vector<ListCell*> made(memory_);
  const auto twin = [&](const ListCell* from) {
    const auto [entry, fresh] = twins.try_emplace(from, nullptr);
    if (fresh) {
      pending.push_back(from);
      made.push_back(nullptr);
      made.back() = entry->second = list(from->size);
    }
    return entry->second;
  };
  try {
    ListCell* copied = twin(&original);
    for (std::size_t next = 0; next < pending.size(); ++next) {
      const ListCell& from = *pending[next];
      ListCell& to = *made[next];
      constexpr std::size_t kOfCell = 3072;  // as long as making a cell and looking for its twin takes
      work_on(kOfCell);
      for (const Value& v : from) {
        work_on(sizeof v);
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

// --- sorting ---------------------------------------------------------------------------------------------------------

void merge_sort(Heap& heap, ListCell& list, const Before& before) {
  const Tag kind = list.kind;
  std::pmr::vector<Value> items(heap.memory());
  items.reserve(list.size);
  for (const Value& element : list) items.push_back(element);
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
  if (list.size == n && list.kind == kind) {
    for (std::size_t i = 0; i < n; ++i) heap.set(list, static_cast<std::uint32_t>(i), items[i]);
  } else {  // `before` has changed it
    heap.resize(list, 0);
    for (const Value& item : items) heap.push(list, item);
  }
}

}  // namespace breve::steve
