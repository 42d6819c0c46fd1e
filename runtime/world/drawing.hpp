// What scripts draw into the view: lists of commands (Drawing) and lines between two bodies (Line). State only; a
// renderer reads it each frame.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <memory_resource>
#include <string_view>

#include "runtime/base/ids.hpp"
#include "runtime/base/math.hpp"
#include "runtime/world/resource.hpp"

namespace breve {

/// A dash pattern: bit i is set where the pattern draws. A character '-' draws, any other does not; at most 16.
/// The empty pattern, and what is left of a short one, is blank.
std::uint16_t line_style(std::string_view pattern);

struct DrawCommand {
  enum class Kind : std::uint8_t {
    Color,         // vector, value = alpha
    LineWidth,     // value, pixels
    LineStyle,     // style
    Line,          // from `from` to `vector`
    PolygonPoint,  // the next corner of the open polygon
    EndPolygon,    // closes it
  } kind = Kind::Color;
  Vector3 vector{0, 0, 0}, from{0, 0, 0};
  double value = 0;
  std::uint16_t style = 0xffff;
};

/// The native data of a Drawing object.
class DrawingResource final : public Resource {
 public:
  static constexpr std::string_view kKind = "drawing";
  explicit DrawingResource(std::pmr::memory_resource* memory = std::pmr::get_default_resource()) : commands(memory) {}

  std::pmr::deque<DrawCommand> commands;
  std::uint64_t limit = 0;      // commands kept, the oldest dropped; 0: all
  Vector3 last_point{0, 0, 0};  // where add-line-point goes on from
  bool has_last_point = false;

  void add(const DrawCommand& command);
  void set_limit(std::uint64_t commands_kept);
  /// A line from the last point added here to `point`; the first call only marks the point.
  void add_line_point(const Vector3& point);
  void clear();

  std::string_view kind() const override { return kKind; }
  void save(ByteWriter& out) const override;
  void hash(Hasher& hasher) const override;
  static std::unique_ptr<Resource> load(ByteReader& in);
};

/// The native data of a Line object: drawn between the centres of two bodies while both live.
class LineResource final : public Resource {
 public:
  static constexpr std::string_view kKind = "line";
  ObjectId from, to;
  Vector3 color{0, 0, 0};
  double alpha = 1;
  std::uint16_t style = 0xffff;

  std::string_view kind() const override { return kKind; }
  void save(ByteWriter& out) const override;
  void hash(Hasher& hasher) const override;
  static std::unique_ptr<Resource> load(ByteReader& in);
};

}  // namespace breve
