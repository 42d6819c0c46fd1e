// Trees of code: making, comparing, counting.
#include "runtime/learn/push/code.hpp"

#include <cstring>
#include <new>

#include "runtime/base/error.hpp"
#include "runtime/base/invariant.hpp"

namespace breve::push {

Symbol* Symbol::make(std::string_view text, std::pmr::memory_resource* memory) {
  void* bytes = memory->allocate(sizeof(Symbol) + text.size(), alignof(Symbol));
  auto* symbol = new (bytes) Symbol(static_cast<std::uint32_t>(text.size()), memory);
  std::memcpy(symbol + 1, text.data(), text.size());
  return symbol;
}

void Symbol::destroy() { memory_->deallocate(this, sizeof(Symbol) + size_, alignof(Symbol)); }

Node Node::of_integer(std::int32_t value) {
  Node node;
  node.kind = Kind::Integer;
  node.integer = value;
  return node;
}

Node Node::of_float(double value) {
  Node node;
  node.kind = Kind::Float;
  node.real = value;
  return node;
}

Node Node::of_boolean(bool value) {
  Node node;
  node.kind = Kind::Boolean;
  node.boolean = value;
  return node;
}

Node Node::of_vector(const Vector3& value) {
  Node node;
  node.kind = Kind::Vector;
  node.vector = {value[0], value[1], value[2]};
  return node;
}

Node Node::of_instruction(std::uint16_t number) {
  Node node;
  node.kind = Kind::Instruction;
  node.instruction = number;
  return node;
}

Node Node::of_name(Symbol* symbol) {
  Node node;
  node.kind = Kind::Name;
  node.name = symbol;
  return node;
}

bool same_point(const Node& a, const Node& b) {
  if (a.kind != b.kind || a.points != b.points) return false;
  switch (a.kind) {
    case Kind::List: return true;
    case Kind::Integer: return a.integer == b.integer;
    case Kind::Float: return a.real == b.real;
    case Kind::Boolean: return a.boolean == b.boolean;
    case Kind::Vector: return a.vector == b.vector;
    case Kind::Instruction: return a.instruction == b.instruction;
    case Kind::Name: return a.name == b.name || a.name->text() == b.name->text();
  }
  return false;
}

std::uint64_t point_hash(const Node& node) {
  Hasher hasher;
  hasher.add(static_cast<std::uint64_t>(node.kind));
  hasher.add(static_cast<std::uint64_t>(node.points));
  switch (node.kind) {
    case Kind::List: break;
    case Kind::Integer: hasher.add(static_cast<std::uint64_t>(static_cast<std::uint32_t>(node.integer))); break;
    case Kind::Float: hasher.add(node.real + 0.0); break;  // -0 is equal to 0
    case Kind::Boolean: hasher.add(static_cast<std::uint64_t>(node.boolean)); break;
    case Kind::Vector:
      for (const double x : node.vector) hasher.add(x + 0.0);
      break;
    case Kind::Instruction: hasher.add(static_cast<std::uint64_t>(node.instruction)); break;
    case Kind::Name: hasher.add(node.name->text()); break;
  }
  return hasher.value();
}

Block* Block::make(std::uint32_t points, std::pmr::memory_resource* memory) {
  static_assert(alignof(Node) <= alignof(Block) && sizeof(Block) % alignof(Node) == 0);
  void* bytes = memory->allocate(sizeof(Block) + points * sizeof(Node), alignof(Block));
  return new (bytes) Block(points, memory);
}

void Block::destroy() {
  for (std::uint32_t i = 0; i < points_; ++i)
    if (nodes()[i].kind == Kind::Name) nodes()[i].name->release();
  memory_->deallocate(this, sizeof(Block) + points_ * sizeof(Node), alignof(Block));
}

std::uint32_t Code::length() const {
  if (!is_list()) return 1;
  std::uint32_t items = 0;
  for (std::uint32_t i = 1; i < points(); i = next(i)) ++items;
  return items;
}

bool operator==(const Code& a, const Code& b) {
  const Node *x = a.nodes(), *y = b.nodes();
  if (x == y) return true;
  if (x->points != y->points) return false;
  for (std::uint32_t i = 0; i < a.points(); ++i)
    if (!same_point(x[i], y[i])) return false;
  return true;
}

void Builder::name(std::string_view text) {
  const Node list{};
  add(&list, 1);
  nodes_.back() = Node::of_name(Symbol::make(text, nodes_.get_allocator().resource()));
}

void Builder::items(const Code& code) {
  if (code.is_list())
    add(code.nodes() + 1, code.points() - 1);
  else
    copy(code);
}

void Builder::add(const Node* nodes, std::size_t count) {
  if (nodes_.size() + count > kMaxPoints)
    throw Error(ErrorCode::Argument, "Push code of more than " + std::to_string(kMaxPoints) + " points");
  nodes_.insert(nodes_.end(), nodes, nodes + count);
  for (std::size_t i = 0; i < count; ++i)
    if (nodes[i].kind == Kind::Name) nodes[i].name->hold();
}

std::uint32_t Builder::begin_list() {
  const Node list{};
  add(&list, 1);
  return size() - 1;
}

void Builder::end_list(std::uint32_t list) { nodes_[list].points = size() - list; }

Code Builder::finish() {
  invariant(!nodes_.empty() && nodes_[0].points == nodes_.size(), "a builder holds one whole expression");
  Block* block = Block::make(size(), nodes_.get_allocator().resource());
  std::memcpy(static_cast<void*>(block->nodes()), nodes_.data(), nodes_.size() * sizeof(Node));
  nodes_.clear();
  return {block, 0};
}

void Builder::drop() {
  for (const Node& node : nodes_)
    if (node.kind == Kind::Name) node.name->release();
  nodes_.clear();
}

Code atom(const Node& node, std::pmr::memory_resource* memory) {
  Block* block = Block::make(1, memory);
  block->nodes()[0] = node;
  if (node.kind == Kind::Name) node.name->hold();
  return {block, 0};
}

Code name(std::string_view text, std::pmr::memory_resource* memory) {
  Builder builder(memory);
  builder.name(text);
  return builder.finish();
}

Code empty_list(std::pmr::memory_resource* memory) { return atom(Node{}, memory); }

Code compact(const Code& code, std::pmr::memory_resource* memory) {
  if (code.points() == code.block()->points() && code.block()->memory() == memory) return code;
  Builder builder(memory);
  builder.copy(code);
  return builder.finish();
}

void hash(const Code& code, Hasher& hasher) {
  for (std::uint32_t i = 0; i < code.points(); ++i) hasher.add(point_hash(code.nodes()[i]));
}

}  // namespace breve::push
