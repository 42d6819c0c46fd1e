// Pieces of code in snapshot images.
#include <cmath>

#include "runtime/learn/push/code.hpp"
#include "runtime/learn/push/instructions.hpp"

namespace breve::push {

void CodeWriter::put(const Code& code) {
  const auto [known, fresh] = known_.try_emplace(code.block(), static_cast<std::uint32_t>(known_.size()));
  out_.put(known->second);
  if (fresh) {
    out_.put(std::uint64_t{code.block()->points()});
    for (std::uint32_t i = 0; i < code.block()->points(); ++i) {
      const Node& node = code.block()->nodes()[i];
      out_.put(node.kind);
      switch (node.kind) {
        case Kind::List: out_.put(node.points); break;
        case Kind::Integer: out_.put(node.integer); break;
        case Kind::Float: out_.put(node.real); break;
        case Kind::Boolean: out_.put(node.boolean); break;
        case Kind::Vector: out_.put(node.as_vector()); break;
        case Kind::Instruction: out_.put(node.instruction); break;
        case Kind::Name: out_.put(node.name->text()); break;
      }
    }
  }
  out_.put(code.at());
}

namespace {

/// The next point; a list's own length is not looked at yet.
void read_point(ByteReader& in, Builder& builder) {
  const auto kind = in.get<std::uint8_t>();
  if (kind > static_cast<std::uint8_t>(Kind::Name)) ByteReader::fail();
  switch (static_cast<Kind>(kind)) {
    case Kind::List: {
      Node list;
      list.points = in.get<std::uint32_t>();
      builder.atom(list);
      break;
    }
    case Kind::Integer: builder.atom(Node::of_integer(in.get<std::int32_t>())); break;
    case Kind::Float: {
      const auto value = in.get<double>();
      if (!std::isfinite(value)) ByteReader::fail();
      builder.atom(Node::of_float(value));
      break;
    }
    case Kind::Boolean: builder.atom(Node::of_boolean(in.get_bool())); break;
    case Kind::Vector: {
      const Vector3 value = in.get_vector();
      if (!value.allFinite()) ByteReader::fail();
      builder.atom(Node::of_vector(value));
      break;
    }
    case Kind::Instruction: {
      const auto number = in.get<std::uint16_t>();
      if (number >= instructions().size()) ByteReader::fail();
      builder.atom(Node::of_instruction(number));
      break;
    }
    case Kind::Name: {
      const std::string_view text = in.get_text();
      if (text.empty() || text.size() > kMaxName) ByteReader::fail();
      builder.name(text);
      break;
    }
  }
}

/// Does each list end within the one that it is in, and the first with the last point?
bool is_tree(std::span<const Node> nodes, std::pmr::memory_resource* memory) {
  std::pmr::vector<std::size_t> ends(memory);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    while (!ends.empty() && ends.back() == i) ends.pop_back();
    const std::size_t end = i + nodes[i].points;
    if (nodes[i].points == 0 || (i == 0 ? end != nodes.size() : ends.empty() || end > ends.back())) return false;
    ends.push_back(end);
  }
  return true;
}

}  // namespace

Code CodeReader::read_tree() {
  const std::size_t points = in_.get_count(2);
  if (points == 0 || points > kMaxPoints) ByteReader::fail();
  Builder builder(in_.memory());
  for (std::size_t i = 0; i < points; ++i) read_point(in_, builder);
  if (!is_tree(builder.nodes(), in_.memory())) ByteReader::fail();
  return builder.finish();
}

Code CodeReader::get() {
  const auto number = in_.get<std::uint32_t>();
  if (number > known_.size()) ByteReader::fail();
  if (number == known_.size()) known_.push_back(read_tree());
  const auto at = in_.get<std::uint32_t>();
  if (at >= known_[number].points()) ByteReader::fail();
  return known_[number].part(at);
}

}  // namespace breve::push
