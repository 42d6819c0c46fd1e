// What a steve value is: untagged slots where the type is known, a tagged Value where it is not, cells for the rest.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <utility>

#include "runtime/base/error.hpp"
#include "runtime/base/ids.hpp"
#include "runtime/base/math.hpp"
#include "steve/code/types.hpp"
#include "steve/syntax/source.hpp"

namespace breve::steve {

/// The name of a type as `typeof` gives it: "NULL", "int", "double", ...
std::string_view type_name(Tag tag);

/// The head of everything on the heap. `count` counts references from heap cells and from the table of objects, not
/// those from frames: a cell with count 0 is freed at the next safe point unless a frame still refers to it.
struct Cell {
  std::uint32_t count = 0;
  Tag tag;
  std::uint8_t mark = 0;       // while frames are looked at or suspects are judged; else 0
  bool listed : 1 = false;     // in the table of zero counts
  bool suspected : 1 = false;  // of being in a cycle that nothing refers to: held by the table of suspects
  bool immortal = false;       // a literal of the program: never freed, never counted
  explicit Cell(Tag t) : tag(t) {}
};

/// Eight untagged bytes of a frame or of an instance. int, double and references take one, a vector three, a matrix
/// nine, a dynamic value four (laid out as Value). All zero bits are the default value of every type.
union Slot {
  std::uint64_t bits;
  std::int32_t i;
  double d;
  Cell* ref;
};
static_assert(sizeof(Slot) == 8);

struct StringCell;
struct MatrixCell;
struct ListCell;
struct HashCell;
struct PointerCell;
struct DataCell;
struct Instance;

/// A dynamic value: a tag and what it tags. Vectors stand in place; matrices and strings are immutable cells. The null
/// reference is the empty string, the null object, a list or hash not made yet, the null pointer, empty data.
struct Value {
  // The tag is written as a whole word: a copy reads words, and a read wider than the last write waits for it.
  union {
    Tag tag;
    std::uint64_t head;
  };
  union {
    std::int32_t i;
    double d;
    double v[3];
    Cell* ref;
    std::uint64_t bits[3];
  };

  Value() : head(0), bits{0, 0, 0} {}
  static Value of(std::int32_t i) {
    Value r(Tag::Int);
    r.i = i;
    return r;
  }
  static Value of(double d) {
    Value r(Tag::Double);
    r.d = d;
    return r;
  }
  static Value of(const Vector3& v) {
    Value r(Tag::Vector);
    std::memcpy(r.v, v.data(), sizeof r.v);
    return r;
  }
  static Value of(Tag tag, Cell* ref) {
    Value r(tag);
    r.ref = ref;
    return r;
  }

  /// A value of a type that takes one slot, from the bits of that slot.
  static Value of(Tag tag, std::uint64_t bits) {
    Value r(tag);
    r.bits[0] = bits;
    return r;
  }
  static constexpr std::uint64_t head_of(Tag t) {
    const auto number = static_cast<std::uint64_t>(t);
    return std::endian::native == std::endian::little ? number : number << 56;
  }

  bool is_reference() const { return tag >= Tag::Matrix; }
  Vector3 vector() const { return {v[0], v[1], v[2]}; }
  // Unchecked: the caller has looked at the tag. Null where the reference is null.
  StringCell* string() const { return reinterpret_cast<StringCell*>(ref); }
  MatrixCell* matrix() const { return reinterpret_cast<MatrixCell*>(ref); }
  ListCell* list() const { return reinterpret_cast<ListCell*>(ref); }
  HashCell* hash() const { return reinterpret_cast<HashCell*>(ref); }
  Instance* object() const { return reinterpret_cast<Instance*>(ref); }
  PointerCell* pointer() const { return reinterpret_cast<PointerCell*>(ref); }
  DataCell* data() const { return reinterpret_cast<DataCell*>(ref); }

 private:
  explicit Value(Tag t) : head(head_of(t)), bits{0, 0, 0} {}
};
static_assert(sizeof(Value) == 32);

/// Thrown by everything under the interpreter; the interpreter adds the place and the chain of calls.
class RunError : public Error {
 public:
  /// @param help   what to do, for the author of the program; "" if the message is sufficient
  /// @param place  what is meant, where that is less than the running expression
  RunError(RunErrorKind kind, const std::string& message, std::string help = {}, const Span& location = {})
      : Error(ErrorCode::Script, message), kind_(kind), help_(std::move(help)), location_(location) {}
  RunErrorKind kind() const { return kind_; }
  const std::string& help() const { return help_; }
  const Span& location() const { return location_; }

 private:
  RunErrorKind kind_;
  std::string help_;
  Span location_;
};

}  // namespace breve::steve
