// Pieces of Push code: immutable trees that stacks, programs and populations share.
//
// A tree is an array of its points in preorder, where each list knows how many points it spans (an S-expression without
// pointers). So copying, comparing, searching and replacing are loops over an array: no depth of nesting costs stack.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory_resource>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "runtime/base/bytes.hpp"
#include "runtime/base/hasher.hpp"

namespace breve::push {

inline constexpr std::uint32_t kMaxPoints = 1'000'000;  // of one piece of code
inline constexpr std::size_t kMaxName = 255;            // characters of a name

/// The text of a name. Immutable; counted by the points that show it.
class Symbol {
 public:
  static Symbol* make(std::string_view text, std::pmr::memory_resource* memory);
  std::string_view text() const { return {reinterpret_cast<const char*>(this + 1), size_}; }
  void hold() { ++users_; }
  void release() {
    if (--users_ == 0) destroy();
  }

 private:
  Symbol(std::uint32_t size, std::pmr::memory_resource* memory) : size_(size), memory_(memory) {}
  void destroy();
  std::uint32_t users_ = 1;
  std::uint32_t size_;
  std::pmr::memory_resource* memory_;
};

enum class Kind : std::uint8_t { List, Integer, Float, Boolean, Vector, Instruction, Name };

/// One point: an atom, or a list with all that is in it. Floats and vectors are finite.
struct Node {
  Kind kind = Kind::List;
  bool boolean = false;
  std::uint16_t instruction = 0;  // number in the table of instructions
  std::uint32_t points = 1;       // of the whole subtree
  union {
    std::int32_t integer;
    double real;
    std::array<double, 3> vector{};
    Symbol* name;
  };

  static Node of_integer(std::int32_t value);
  static Node of_float(double value);
  static Node of_boolean(bool value);
  static Node of_vector(const Vector3& value);
  static Node of_instruction(std::uint16_t number);
  static Node of_name(Symbol* symbol);
  bool is_list() const { return kind == Kind::List; }
  Vector3 as_vector() const { return {vector[0], vector[1], vector[2]}; }
};

/// Are two points alike? Lists: of equal length.
bool same_point(const Node& a, const Node& b);
/// A hash of the point alone; equal for points that are alike.
std::uint64_t point_hash(const Node& node);

/// The points of a tree, owned by the pieces of code that refer to it.
class Block {
 public:
  static Block* make(std::uint32_t points, std::pmr::memory_resource* memory);
  Node* nodes() { return reinterpret_cast<Node*>(this + 1); }
  const Node* nodes() const { return reinterpret_cast<const Node*>(this + 1); }
  std::uint32_t points() const { return points_; }
  std::pmr::memory_resource* memory() const { return memory_; }
  void hold() { ++users_; }
  void release() {
    if (--users_ == 0) destroy();
  }
  bool shared() const { return users_ > 1; }

 private:
  Block(std::uint32_t points, std::pmr::memory_resource* memory) : points_(points), memory_(memory) {}
  void destroy();
  std::uint32_t users_ = 1;
  std::uint32_t points_;
  std::pmr::memory_resource* memory_;
};

/// A piece of code: a whole tree or a part of one. Sixteen bytes; copying counts and copies nothing.
class Code {
 public:
  Code(Block* adopted, std::uint32_t at) : block_(adopted), at_(at) {}
  Code(const Code& other) : block_(other.block_), at_(other.at_) {
    if (block_) block_->hold();
  }
  Code(Code&& other) noexcept : block_(std::exchange(other.block_, nullptr)), at_(other.at_) {}
  Code& operator=(const Code& other) { return *this = Code(other); }
  Code& operator=(Code&& other) noexcept {
    std::swap(block_, other.block_);
    std::swap(at_, other.at_);
    return *this;
  }
  ~Code() {
    if (block_) block_->release();
  }

  const Node* nodes() const { return block_->nodes() + at_; }  // points() of them
  const Node& root() const { return *nodes(); }
  std::uint32_t points() const { return root().points; }
  bool is_list() const { return root().is_list(); }
  bool is_empty() const { return is_list() && points() == 1; }
  /// The subtree at point `i`, in preorder; 0 is all of it.
  Code part(std::uint32_t i) const {
    block_->hold();
    return {block_, at_ + i};
  }
  /// How many items a list has; 1 for an atom.
  std::uint32_t length() const;
  /// The first item of a list is at point 1; the one behind that at `i` is at next(i). Ends at points().
  std::uint32_t next(std::uint32_t i) const { return i + nodes()[i].points; }
  Block* block() const { return block_; }
  std::uint32_t at() const { return at_; }

  friend bool operator==(const Code& a, const Code& b);

 private:
  Block* block_;  // null only after it was moved from
  std::uint32_t at_;
};

/// Makes a tree point by point.
class Builder {
 public:
  explicit Builder(std::pmr::memory_resource* memory) : nodes_(memory) {}
  Builder(const Builder&) = delete;
  Builder& operator=(const Builder&) = delete;
  ~Builder() { drop(); }

  void atom(const Node& node) { add(&node, 1); }
  void name(std::string_view text);
  void copy(const Code& code) { add(code.nodes(), code.points()); }
  /// The items of a list, or the atom.
  void items(const Code& code);
  /// Points as they stand in another tree.
  void add(const Node* nodes, std::size_t count);
  /// Begin a list; what follows is in it until it is ended.
  std::uint32_t begin_list();
  void end_list(std::uint32_t list);
  std::uint32_t size() const { return static_cast<std::uint32_t>(nodes_.size()); }
  std::pmr::memory_resource* memory() const { return nodes_.get_allocator().resource(); }
  std::span<Node> nodes() { return nodes_; }
  /// The result, one expression. The builder is empty afterwards.
  Code finish();

 private:
  void drop();
  std::pmr::vector<Node> nodes_;
};

Code atom(const Node& node, std::pmr::memory_resource* memory);
Code name(std::string_view text, std::pmr::memory_resource* memory);
Code empty_list(std::pmr::memory_resource* memory);
/// A copy that holds on to nothing but itself, in `memory`; `code` itself if it is one.
Code compact(const Code& code, std::pmr::memory_resource* memory);

void hash(const Code& code, Hasher& hasher);

/// Writes pieces of code to an image; a tree that several pieces share is written once.
class CodeWriter {
 public:
  explicit CodeWriter(ByteWriter& out) : out_(out), known_(out.bytes().get_allocator().resource()) {}
  void put(const Code& code);

 private:
  ByteWriter& out_;
  std::pmr::map<const Block*, std::uint32_t> known_;  // looked up, never walked: addresses do not reach the image
};

/// Reads what CodeWriter wrote. Error{Image} for anything that is not a tree.
class CodeReader {
 public:
  explicit CodeReader(ByteReader& in) : in_(in), known_(in.memory()) {}
  Code get();

 private:
  Code read_tree();
  ByteReader& in_;
  std::pmr::vector<Code> known_;
};

}  // namespace breve::push
