// Drawing commands and lines: limits, snapshots, hashes.
#include "runtime/world/drawing.hpp"

#include <algorithm>

namespace breve {

namespace {

std::uint64_t packed(ObjectId id) { return static_cast<std::uint64_t>(id.index) << 32 | id.generation; }

// Bytes of one command in an image: kind, two vectors, a value, a style.
constexpr std::size_t kCommandBytes = 1 + 6 * sizeof(double) + sizeof(double) + sizeof(std::uint16_t);

}  // namespace

std::uint16_t line_style(std::string_view pattern) {
  std::uint16_t bits = 0;
  for (std::size_t i = 0; i < std::min<std::size_t>(16, pattern.size()); ++i)
    if (pattern[i] == '-') bits = static_cast<std::uint16_t>(bits | (1U << i));
  return bits;
}

void DrawingResource::add(const DrawCommand& command) {
  commands.push_back(command);
  if (limit != 0 && commands.size() > limit) commands.pop_front();
}

void DrawingResource::set_limit(std::uint64_t commands_kept) {
  limit = commands_kept;
  if (limit != 0)
    while (commands.size() > limit) commands.pop_front();
}

void DrawingResource::add_line_point(const Vector3& point) {
  if (has_last_point) {
    DrawCommand line;
    line.kind = DrawCommand::Kind::Line;
    line.from = last_point;
    line.vector = point;
    add(line);
  }
  last_point = point;
  has_last_point = true;
}

void DrawingResource::clear() {
  commands.clear();
  has_last_point = false;
}

void DrawingResource::save(ByteWriter& out) const {
  out.put(limit);
  out.put(last_point);
  out.put(has_last_point);
  out.put(static_cast<std::uint64_t>(commands.size()));
  for (const DrawCommand& command : commands) {
    out.put(command.kind);
    out.put(command.vector);
    out.put(command.from);
    out.put(command.value);
    out.put(command.style);
  }
}

void DrawingResource::hash(Hasher& hasher) const {
  hasher.add(limit);
  hasher.add(last_point);
  hasher.add(static_cast<std::uint64_t>(has_last_point));
  hasher.add(static_cast<std::uint64_t>(commands.size()));
  for (const DrawCommand& command : commands) {
    hasher.add(static_cast<std::uint64_t>(command.kind) << 16 | command.style);
    hasher.add(command.vector);
    hasher.add(command.from);
    hasher.add(command.value);
  }
}

std::unique_ptr<Resource> DrawingResource::load(ByteReader& in) {
  auto drawing = make_in<DrawingResource>(in.memory(), in.memory());
  drawing->limit = in.get<std::uint64_t>();
  drawing->last_point = in.get_vector();
  drawing->has_last_point = in.get_bool();
  for (std::size_t left = in.get_count(kCommandBytes); left > 0; --left) {
    DrawCommand command;
    const auto kind = in.get<std::uint8_t>();
    if (kind > static_cast<std::uint8_t>(DrawCommand::Kind::EndPolygon)) ByteReader::fail();
    command.kind = static_cast<DrawCommand::Kind>(kind);
    command.vector = in.get_vector();
    command.from = in.get_vector();
    command.value = in.get<double>();
    command.style = in.get<std::uint16_t>();
    drawing->commands.push_back(command);
  }
  return drawing;
}

void LineResource::save(ByteWriter& out) const {
  out.put(from);
  out.put(to);
  out.put(color);
  out.put(alpha);
  out.put(style);
}

void LineResource::hash(Hasher& hasher) const {
  hasher.add(packed(from));
  hasher.add(packed(to));
  hasher.add(color);
  hasher.add(alpha);
  hasher.add(static_cast<std::uint64_t>(style));
}

std::unique_ptr<Resource> LineResource::load(ByteReader& in) {
  auto line = make_in<LineResource>(in.memory());
  line->from = in.get_object();
  line->to = in.get_object();
  line->color = in.get_vector();
  line->alpha = in.get<double>();
  line->style = in.get<std::uint16_t>();
  return line;
}

}  // namespace breve
