// The cells of the heap: strings, matrices, lists, hashes, instances, pointers, data.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <memory>
#include <memory_resource>
#include <string_view>
#include <vector>

#include "runtime/base/math.hpp"
#include "steve/machine/value.hpp"

namespace breve::steve {

class Heap;
struct ClassInfo;

/// A cell that refers to other cells, so that it can be part of a cycle: list, hash, instance.
struct Container : Cell {
  std::uint32_t slot = 0;  // index in the heap's table of containers
  explicit Container(Tag t) : Cell(t) {}
};
inline bool is_container(Tag tag) { return tag >= Tag::Object && tag <= Tag::Hash; }

/// Bytes that several strings begin with: each is as long as it says, and the longest may grow in place. So a text that
/// is built up piece by piece costs its length, not the square of it.
struct SharedText {
  SharedText* previous;
  SharedText* next;
  std::uint32_t cells;  // that share it
  std::uint32_t used, capacity;
  char bytes[4];  // really `capacity` and a zero byte
};

/// Immutable bytes; never empty (the empty string is the null reference).
struct StringCell : Cell {
  std::uint32_t size : 31;
  std::uint32_t shared : 1;  // in place of bytes stands a SharedText*
  mutable std::uint32_t hash_cache =
      0;          // 0: not computed yet. Computed beforehand in immortal strings (shared by threads)
  char bytes[8];  // really `size`, with a zero byte behind

  explicit StringCell(std::uint32_t n) : Cell(Tag::String), size(n & 0x7fffffffU), shared(0) {}
  SharedText* text() const {
    SharedText* text = nullptr;
    std::memcpy(&text, bytes, sizeof text);
    return text;
  }
  std::string_view view() const { return {shared != 0 ? text()->bytes : bytes, size}; }
  /// Bytes that it may become by appending in place; 0: not any. What appending costs is counted, so images keep it.
  std::uint32_t room() const { return shared != 0 && text()->used == size ? text()->capacity : 0; }
};
inline std::string_view view(const StringCell* s) { return s ? s->view() : std::string_view{}; }

/// The bytes that a string of `size` bytes takes with its head, a multiple of 8.
constexpr std::size_t string_cell_bytes(std::size_t size) {
  return (sizeof(Cell) + 8 + size + 1 + 7) & ~std::size_t{7};
}
static_assert(sizeof(StringCell) == sizeof(Cell) + 16);
std::uint32_t string_hash(std::string_view text);  // never 0 nor 0xffffffff

struct MatrixCell : Cell {
  Matrix3 m;
  explicit MatrixCell(const Matrix3& value) : Cell(Tag::Matrix), m(value) {}
};

/// A growable array with room at both ends: push, pop, prepend and unprepend are O(1) amortised. Elements that are all
/// of one type which fits a slot stand there without tags (a list of numbers or objects takes a quarter of the memory);
/// others, vectors and NULL stand as Values. A list becomes wide with the first element that asks for it, and may
/// become narrow again when it is empty.
struct ListCell : Container {
  Tag kind = Tag::Null;                             // the type of all elements; Null: they are Values
  std::uint32_t first = 0, size = 0, capacity = 0;  // in elements
  std::uint32_t wish = 0;                           // least capacity of the first store
  std::uint64_t serial;
  Slot* store = nullptr;

  explicit ListCell(std::uint64_t s) : Container(Tag::List), serial(s) {}
  bool narrow() const { return kind != Tag::Null; }
  static constexpr bool fits_slot(Tag tag) { return tag != Tag::Null && tag != Tag::Vector; }
  bool holds_references() const { return kind >= Tag::Matrix || kind == Tag::Null; }
  std::size_t element_bytes() const { return narrow() ? sizeof(Slot) : sizeof(Value); }
  Value* values() { return reinterpret_cast<Value*>(store); }
  const Value* values() const { return reinterpret_cast<const Value*>(store); }
  /// By value: there may be no Value to refer to.
  Value operator[](std::uint32_t i) const {
    return narrow() ? Value::of(kind, store[first + i].bits) : values()[first + i];
  }

  /// Reads one element after the other, with the list as it is then.
  class Iterator {
   public:
    using iterator_category = std::input_iterator_tag;
    using value_type = Value;
    using difference_type = std::ptrdiff_t;
    using pointer = void;
    using reference = Value;
    Iterator(const ListCell& list, std::uint32_t i) : list_(&list), i_(i) {}
    Value operator*() const { return (*list_)[i_]; }
    Iterator& operator++() {
      ++i_;
      return *this;
    }
    void operator++(int) { ++i_; }
    friend bool operator==(const Iterator&, const Iterator&) = default;

   private:
    const ListCell* list_;
    std::uint32_t i_;
  };
  Iterator begin() const { return {*this, 0}; }
  Iterator end() const { return {*this, size}; }
};

/// Open addressing over entries kept in order of insertion. Keys compare with type.
struct HashCell : Container {
  struct Entry {
    Value key;  // Tag::Null with hash kRemoved: a removed entry
    Value value;
    std::uint32_t hash;
    bool live() const { return hash != kRemoved; }
  };
  static constexpr std::uint32_t kRemoved = 0xffffffffU;
  std::uint64_t serial;
  std::uint32_t count_live = 0, used = 0, entry_capacity = 0, index_capacity = 0;
  Entry* entries = nullptr;
  std::uint32_t* index = nullptr;  // entry number + 1; 0 = free

  explicit HashCell(std::uint64_t s) : Container(Tag::Hash), serial(s) {}
};

/// What a pointer value refers to: for example an open file. Closed by its destructor.
class NativePointer {
 public:
  virtual ~NativePointer() = default;
};
struct PointerCell : Cell {
  std::uint64_t serial;
  std::unique_ptr<NativePointer> native;
  explicit PointerCell(std::uint64_t s) : Cell(Tag::Pointer), serial(s) {}
};

struct DataCell : Cell {
  std::uint64_t serial;
  std::pmr::vector<std::uint8_t> bytes;
  DataCell(std::uint64_t s, std::pmr::memory_resource* memory) : Cell(Tag::Data), serial(s), bytes(memory) {}
};

/// An object of a steve class. Its slots are laid out by its class; a freed one stays as a husk while it is referred
/// to.
struct Instance : Container {
  enum class State : std::uint8_t { Live, BeingFreed, Freed };
  State state = State::Live;
  bool auto_free = false;
  std::uint16_t units = 0;  // size class of this cell in the heap; 0: taken singly
  const ClassInfo* cls;
  ObjectId id;
  std::uint64_t serial;  // what `print` shows as the address
  Slot* slots;           // cls->slot_count of them, right behind this head

  explicit Instance(const ClassInfo* c) : Container(Tag::Object), cls(c), serial(0), slots(nullptr) {}
  bool live() const { return state != State::Freed; }
};

}  // namespace breve::steve
