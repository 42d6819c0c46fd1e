// Cells: where their bytes come from, how they are made, and how they go when nothing refers to them.
#include "steve/machine/heap.hpp"

#include <algorithm>
#include <cstddef>

#include "steve/code/program.hpp"
#include "steve/machine/poison.hpp"

namespace breve::steve {

namespace {

constexpr std::size_t kFirstChunk = 2048;
constexpr std::size_t kLargestChunk = 65536;
constexpr std::size_t kBetweenLooks = 4096;  // cells of garbage: less than a millisecond

/// Where the bytes of a shared text are, as far as they go.
char* body(SharedText* text) { return reinterpret_cast<char*>(text) + offsetof(SharedText, bytes); }

}  // namespace

Heap::Heap(std::pmr::memory_resource* memory, RootSource& roots)
    : memory_(memory),
      roots_(roots),
      zero_(memory),
      containers_(memory),
      marks_(memory),
      grey_(memory),
      doomed_(memory),
      condemned_(memory),
      suspects_(memory),
      dying_(memory) {}

Heap::~Heap() {
  for (Container* cell : containers_) free_arrays(*cell);
  while (singles_ != nullptr) {
    Single* single = singles_;
    auto* cell = reinterpret_cast<Cell*>(single + 1);
    if (cell->tag == Tag::Pointer) static_cast<PointerCell*>(cell)->~PointerCell();
    if (cell->tag == Tag::Data) static_cast<DataCell*>(cell)->~DataCell();
    singles_ = single->next;
    memory_->deallocate(single, single->bytes, alignof(Single));
  }
  while (texts_ != nullptr) {
    SharedText* text = texts_;
    texts_ = text->next;
    memory_->deallocate(text, sizeof(SharedText) + text->capacity, alignof(SharedText));
  }
  while (chunks_ != nullptr) {
    Chunk* chunk = chunks_;
    chunks_ = chunk->next;
    unpoison(chunk, chunk->bytes);
    memory_->deallocate(chunk, chunk->bytes, alignof(Chunk));
  }
}

// --- bytes -----------------------------------------------------------------------------------------------------------

void* Heap::carve(std::size_t units) {
  const std::size_t size = units * kUnit;
  std::size_t& next = chunk_bytes_[units];
  const std::size_t bytes = std::max(next, kFirstChunk);
  auto* chunk = static_cast<Chunk*>(memory_->allocate(bytes, alignof(Chunk)));
  next = std::min(bytes * 2, kLargestChunk);
  chunk->next = chunks_;
  chunk->bytes = bytes;
  chunks_ = chunk;
  // Thread the slots so that they are handed out in rising order of address.
  char* base = reinterpret_cast<char*>(chunk + 1);
  const std::size_t slots = (bytes - sizeof(Chunk)) / size;
  FreeSlot* head = free_[units];
  for (std::size_t i = slots; i-- > 0;) {
    auto* slot = reinterpret_cast<FreeSlot*>(base + i * size);
    slot->next = head;
    head = slot;
    poison(slot, size);
  }
  unpoison(head, size);
  free_[units] = head->next;
  return head;
}

void* Heap::take(std::size_t bytes) {
  const std::size_t units = (bytes + kUnit - 1) / kUnit;
  if (units > kClasses) return take_single(bytes);
  FreeSlot* slot = free_[units];
  if (slot == nullptr) return carve(units);
  unpoison(slot, units * kUnit);
  free_[units] = slot->next;
  return slot;
}

// A freed slot of a size class stays ours: it is poisoned, so that the address sanitizer sees uses of dead cells.
void Heap::give(void* memory, std::size_t bytes) {
  const std::size_t units = (bytes + kUnit - 1) / kUnit;
  if (units > kClasses) return give_single(memory);
  auto* slot = static_cast<FreeSlot*>(memory);
  slot->next = free_[units];
  free_[units] = slot;
  poison(slot, units * kUnit);
}

void* Heap::take_single(std::size_t bytes) {
  bytes += sizeof(Single);
  auto* single = static_cast<Single*>(memory_->allocate(bytes, alignof(Single)));
  *single = {nullptr, singles_, bytes};
  if (singles_ != nullptr) singles_->previous = single;
  singles_ = single;
  return single + 1;
}

void Heap::give_single(void* memory) {
  Single* single = static_cast<Single*>(memory) - 1;
  (single->previous != nullptr ? single->previous->next : singles_) = single->next;
  if (single->next != nullptr) single->next->previous = single->previous;
  memory_->deallocate(single, single->bytes, alignof(Single));
}

// --- making cells ----------------------------------------------------------------------------------------------------

void Heap::reserve_tables(bool container) {
  constexpr std::size_t kLeast = 64;
  if (cells_ >= zero_.capacity()) zero_.reserve(std::max(kLeast, zero_.capacity() * 2));
  if (!container || containers_.size() < containers_.capacity()) return;
  // The containers come last: what fails before is asked for again.
  const std::size_t room = std::max(kLeast, containers_.capacity() * 2);
  marks_.reserve(room);
  grey_.reserve(room);
  suspects_.reserve(std::min(room, kMostSuspects));  // so that to suspect never fails
  containers_.reserve(room);
}

template <class T>
T* Heap::enter(T* cell) {
  ++cells_;
  if constexpr (std::is_base_of_v<Container, T>) enrol(*cell);
  enlist(cell);
  return cell;
}

namespace {
constexpr std::size_t kLongestString = 0x7fffffff;
void check_length(std::size_t size) {
  if (size > kLongestString) throw RunError(RunErrorKind::Bounds, "a string cannot be longer than 2147483647 bytes");
}
}  // namespace

void Heap::check_room(std::size_t bytes) const {
  check_length(bytes);
  memory_->deallocate(memory_->allocate(bytes, 1), bytes, 1);
}

StringCell* Heap::raw_string(std::size_t size) {
  check_length(size);
  reserve_tables(false);
  note_fresh(size);
  move_bytes(size);
  auto* cell = new (take(string_cell_bytes(size))) StringCell(static_cast<std::uint32_t>(size));
  char* bytes = cell->bytes;
  bytes[size] = 0;
  return enter(cell);
}

StringCell* Heap::string(std::string_view bytes) {
  if (bytes.empty()) return nullptr;
  StringCell* cell = raw_string(bytes.size());
  char* to = cell->bytes;
  std::memcpy(to, bytes.data(), bytes.size());
  return cell;
}

StringCell* Heap::concat(std::string_view a, std::string_view b) {
  if (a.empty()) return string(b);
  if (b.empty()) return string(a);
  StringCell* cell = raw_string(a.size() + b.size());
  char* to = cell->bytes;
  std::memcpy(to, a.data(), a.size());
  std::memcpy(to + a.size(), b.data(), b.size());
  return cell;
}

SharedText* Heap::make_text(std::string_view begin, std::size_t capacity) {
  auto* text = static_cast<SharedText*>(memory_->allocate(sizeof(SharedText) + capacity, alignof(SharedText)));
  const auto size = static_cast<std::uint32_t>(begin.size());
  move_bytes(size);
  *text = {nullptr, texts_, 0, size, static_cast<std::uint32_t>(capacity), {}};
  char* to = body(text);
  std::memcpy(to, begin.data(), begin.size());
  to[size] = 0;
  if (texts_ != nullptr) texts_->previous = text;
  texts_ = text;
  return text;
}

void Heap::leave_text(SharedText* text) {
  if (text->cells > 1) {
    --text->cells;
    return;
  }
  (text->previous != nullptr ? text->previous->next : texts_) = text->next;
  if (text->next != nullptr) text->next->previous = text->previous;
  memory_->deallocate(text, sizeof(SharedText) + text->capacity, alignof(SharedText));
}

// Only what is long and grows by little is worth a text of its own: it takes up to twice the memory.
StringCell* Heap::append(StringCell* a, std::string_view b) {
  constexpr std::size_t kLeastShared = 256;
  const std::size_t old = view(a).size(), size = old + b.size();
  if (old < kLeastShared || b.empty() || b.size() > old / 4 || size > kLongestString) return concat(view(a), b);
  reserve_tables(false);
  SharedText* text = a->shared != 0 ? a->text() : nullptr;
  const bool fits = text != nullptr && text->used == old && text->capacity - old >= b.size();
  if (!fits) text = make_text(a->view(), std::min(size * 2, kLongestString));
  return share(text, b);
}

StringCell* Heap::roomy_string(std::string_view bytes, std::size_t capacity) {
  reserve_tables(false);
  return share(make_text(bytes, capacity), {});
}

/// The text with `more` behind it, for which there is room, as a string. Nobody else's text is gone if memory ends.
StringCell* Heap::share(SharedText* text, std::string_view more) {
  void* memory = nullptr;
  try {
    memory = take(sizeof(StringCell));
  } catch (...) {
    if (text->cells == 0) leave_text(text);
    throw;
  }
  char* to = body(text) + text->used;
  std::copy(more.begin(), more.end(), to);
  to[more.size()] = 0;
  text->used += static_cast<std::uint32_t>(more.size());
  ++text->cells;
  auto* cell = new (memory) StringCell(text->used);
  cell->shared = 1;
  std::memcpy(cell->bytes, &text, sizeof text);
  note_fresh(text->used);  // as much as an unshared one: where reclaiming happens must not depend on what is shared
  return enter(cell);
}

const char* Heap::terminated(StringCell* string) {
  if (string == nullptr) return "";
  if (string->shared != 0 && string->text()->used != string->size) {
    SharedText* own = make_text(string->view(), string->size);
    own->cells = 1;
    leave_text(string->text());
    std::memcpy(string->bytes, &own, sizeof own);
  }
  return string->view().data();
}

MatrixCell* Heap::matrix(const Matrix3& m) {
  reserve_tables(false);
  return enter(new (take(sizeof(MatrixCell))) MatrixCell(m));
}

ListCell* Heap::list(std::uint32_t capacity) {
  reserve_tables(true);
  auto* cell = new (take(sizeof(ListCell))) ListCell(next_serial());
  cell->wish = capacity;
  return enter(cell);
}

HashCell* Heap::hash() {
  reserve_tables(true);
  void* memory = take(sizeof(HashCell));
  return enter(new (memory) HashCell(next_serial()));
}

PointerCell* Heap::pointer(std::unique_ptr<NativePointer> native) {
  reserve_tables(false);
  void* memory = take_single(sizeof(PointerCell));
  auto* cell = new (memory) PointerCell(next_serial());
  cell->native = std::move(native);
  return enter(cell);
}

DataCell* Heap::data(std::string_view bytes) {
  reserve_tables(false);
  std::pmr::vector<std::uint8_t> copy(bytes.begin(), bytes.end(), memory_);
  void* memory = take_single(sizeof(DataCell));
  auto* cell = new (memory) DataCell(next_serial(), memory_);
  cell->bytes = std::move(copy);
  return enter(cell);
}

Instance* Heap::instance(const ClassInfo& cls) {
  reserve_tables(true);
  const std::size_t bytes = sizeof(Instance) + cls.slot_count * sizeof(Slot);
  auto* cell = new (take(bytes)) Instance(&cls);
  const std::size_t units = (bytes + kUnit - 1) / kUnit;
  cell->units = units > kClasses ? std::uint16_t{0} : static_cast<std::uint16_t>(units);
  cell->serial = next_serial();
  cell->slots = reinterpret_cast<Slot*>(cell + 1);
  std::memset(static_cast<void*>(cell->slots), 0, cls.slot_count * sizeof(Slot));
  return enter(cell);
}

// --- the end of cells ------------------------------------------------------------------------------------------------

void Heap::clear_slots(Instance& instance) {
  for (const std::uint16_t slot : instance.cls->reference_slots) {
    Cell* ref = instance.slots[slot].ref;
    instance.slots[slot].ref = nullptr;
    release(ref);
  }
  std::memset(static_cast<void*>(instance.slots), 0, instance.cls->slot_count * sizeof(Slot));
}

void Heap::release_children(Container& cell) {
  if (cell.tag == Tag::Object) return clear_slots(static_cast<Instance&>(cell));
  if (cell.tag == Tag::List) {
    auto& list = static_cast<ListCell&>(cell);
    if (list.narrow() && list.holds_references()) {
      for (std::uint32_t i = 0; i < list.size; ++i) release_of_garbage(list.store[list.first + i].ref);
    } else if (!list.narrow()) {
      for (std::uint32_t i = 0; i < list.size; ++i) release_of_garbage(list.values()[list.first + i]);
    }
    list.size = 0;
    return;
  }
  auto& hash = static_cast<HashCell&>(cell);
  for (std::uint32_t i = 0; i < hash.used; ++i) {
    release_of_garbage(hash.entries[i].key);
    release_of_garbage(hash.entries[i].value);
  }
  hash.used = hash.count_live = 0;
  if (hash.index != nullptr) std::memset(hash.index, 0, hash.index_capacity * sizeof(std::uint32_t));
}

void Heap::free_arrays(Container& cell) {
  if (cell.tag == Tag::List) {
    free_store(static_cast<ListCell&>(cell));
  } else if (cell.tag == Tag::Hash) {
    auto& hash = static_cast<HashCell&>(cell);
    if (hash.entries != nullptr) {
      memory_->deallocate(hash.entries, hash.entry_capacity * sizeof(HashCell::Entry), alignof(HashCell::Entry));
      memory_->deallocate(hash.index, hash.index_capacity * sizeof(std::uint32_t), alignof(std::uint32_t));
    }
  }
}

void Heap::destroy(Cell* cell) {
  --cells_;
  switch (cell->tag) {
    case Tag::String: {
      const auto* string = static_cast<StringCell*>(cell);
      if (string->shared == 0) return give(cell, string_cell_bytes(string->size));
      leave_text(string->text());
      return give(cell, sizeof(StringCell));
    }
    case Tag::Matrix: return give(cell, sizeof(MatrixCell));
    case Tag::Pointer: static_cast<PointerCell*>(cell)->~PointerCell(); return give_single(cell);
    case Tag::Data: static_cast<DataCell*>(cell)->~DataCell(); return give_single(cell);
    default: break;
  }
  auto& container = static_cast<Container&>(*cell);
  release_children(container);
  free_arrays(container);
  strike(container);
  if (cell->tag == Tag::List) return give(cell, sizeof(ListCell));
  if (cell->tag == Tag::Hash) return give(cell, sizeof(HashCell));
  const std::size_t units = static_cast<Instance*>(cell)->units;
  return units != 0 ? give(cell, units * kUnit) : give_single(cell);
}

// --- safe points -----------------------------------------------------------------------------------------------------

// A live instance is never freed silently: with auto-free it is doomed (destroy runs first), without it waits.
static bool waits(const Cell& cell) {
  return cell.mark != 0 || (cell.tag == Tag::Object && static_cast<const Instance&>(cell).live());
}

void Heap::reclaim() {
  // Each look at the suspects counts like so much text: a program that appends to a long text has one for each piece.
  constexpr std::uint64_t kBytesOfSuspect = 32;
  move_bytes(kBytesOfSuspect * suspects_.size());
  short_of_memory_ = false;
  reclaim_round();
  if (short_of_memory_) throw std::bad_alloc();
}

bool Heap::reclaim_round() {
  std::size_t visited = 0;
  fresh_bytes_ = 0;
  if (drop_lonely_suspects() || !zero_.empty()) {
    roots_.visit_frames([&visited](Cell* cell) {
      if (cell == nullptr || cell->immortal) return;
      cell->mark = 1;
      ++visited;
    });
    // Last in, first out: freeing a cell puts its children at the end, so the table never outgrows the heap, and a
    // structure however deep goes without recursion. Cells that must stay are gathered at the front.
    std::size_t kept = 0, seen = 0;
    bool cut = false;  // a host that interrupts does not wait for millions of cells
    do {
      while (zero_.size() > kept) {
        if (++seen % kBetweenLooks == 0 && ended()) {
          cut = true;
          break;
        }
        Cell* cell = zero_.back();
        if (cell->count == 0 && (waits(*cell) || is_swept_later(*cell))) {
          std::swap(zero_.back(), zero_[kept++]);
          continue;
        }
        zero_.pop_back();
        cell->listed = false;
        if (cell->count == 0) {
          destroy(cell);
        } else if (is_lonely(*cell)) {
          release_children(*static_cast<Container*>(cell));  // it goes with the others of its kind, below
        } else if (is_container(cell->tag) && !cell->suspected && may_close_cycle(*static_cast<Container*>(cell))) {
          suspect(*static_cast<Container*>(cell));
        }
      }
    } while (!cut && drop_lonely_suspects());
    doom_waiting(kept);
    roots_.visit_frames([](Cell* cell) {
      if (cell != nullptr && !cell->immortal) cell->mark = 0;
    });
  }
  // Cells that stay because frames hold them are looked at again only when as many new ones have come.
  reclaim_at_ = std::max(kReclaimAt, zero_.size() * 2 + visited);
  wants_reclaim_ = zero_.size() >= reclaim_at_;
  return free_doomed();
}

// A destroy method may leave new garbage, and so may auto-free instances. The limit is for one that makes its
// successor.
void Heap::reclaim_all() {
  constexpr int kRounds = 1000;
  for (int round = 0; round < kRounds && reclaim_round() && !ended(); ++round) {
  }
}

// Move the unreachable auto-free instances out of the waiting table. Those for which there is no memory wait.
void Heap::doom_waiting(std::size_t kept) {
  const auto doomed = [](const Cell* cell) {
    if (cell->tag != Tag::Object || cell->mark != 0) return false;
    const auto* instance = static_cast<const Instance*>(cell);
    return instance->auto_free && instance->state == Instance::State::Live;
  };
  const auto end = zero_.begin() + static_cast<std::ptrdiff_t>(kept);
  const auto count = static_cast<std::size_t>(std::count_if(zero_.begin(), end, doomed));
  if (count == 0) return;
  try {
    doomed_.reserve(doomed_.size() + count);
  } catch (const std::bad_alloc&) {
    short_of_memory_ = true;
  }
  const std::size_t old = doomed_.size();
  for (Cell* cell : zero_) {
    if (!doomed(cell) || doomed_.size() == doomed_.capacity()) continue;
    doomed_.push_back(static_cast<Instance*>(cell));
    cell->listed = false;
  }
  std::erase_if(zero_, [](const Cell* cell) { return !cell->listed; });
  for (std::size_t i = old; i < doomed_.size(); ++i) retain(doomed_[i]);
  // Those that wait stand in the table newest first, as a rule.
  const auto first = doomed_.begin() + static_cast<std::ptrdiff_t>(old);
  const auto older = [](const Instance* a, const Instance* b) { return a->serial < b->serial; };
  std::reverse(first, doomed_.end());
  if (!std::is_sorted(first, doomed_.end(), older)) std::sort(first, doomed_.end(), older);
}

// Run the destroy methods of what is doomed. They may run anything, even this function: then the outer call goes on
// with what the inner one added. An instance that an earlier destroy has stored somewhere again lives on.
namespace {
struct Unpin {
  Heap& heap;
  Instance* instance;
  ~Unpin() { heap.release(instance); }
};
}  // namespace

bool Heap::free_doomed() {
  if (freeing_doomed_ || doomed_.empty()) return false;
  struct Guard {
    Heap& heap;
    std::size_t next = 0;
    explicit Guard(Heap& h) : heap(h) { heap.freeing_doomed_ = true; }
    ~Guard() {
      heap.freeing_doomed_ = false;
      heap.doomed_.erase(heap.doomed_.begin(), heap.doomed_.begin() + static_cast<std::ptrdiff_t>(next));
    }
  } guard(*this);
  while (guard.next < doomed_.size()) {
    Instance* doomed = doomed_[guard.next++];
    const Unpin unpin{*this, doomed};
    const bool lives_on = doomed->count > 1;
    if (!lives_on && doomed->state == Instance::State::Live && doomed->auto_free) roots_.free_unreachable(*doomed);
  }
  return true;
}

}  // namespace breve::steve
