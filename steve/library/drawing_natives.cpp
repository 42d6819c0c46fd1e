// Natives of Drawing and Line.
#include "runtime/world/drawing.hpp"
#include "steve/library/support.hpp"
#include "steve/library/tables.hpp"

namespace breve::steve {

namespace {

using Text = StringCell*;
using Kind = DrawCommand::Kind;

DrawingResource& drawing(Machine& machine, Instance& self) { return resource_made<DrawingResource>(machine, self); }

// --- Drawing ---------------------------------------------------------------------------------------------------------

void drawing_init(Machine& machine, Instance& self) { drawing(machine, self).clear(); }

std::int32_t drawing_get_size(Machine& machine, Instance& self) {
  return static_cast<std::int32_t>(drawing(machine, self).commands.size());
}

void drawing_clear(Machine& machine, Instance& self) { drawing(machine, self).clear(); }

void drawing_set_limit(Machine& machine, Instance& self, std::int32_t limit) {
  drawing(machine, self).set_limit(limit > 0 ? static_cast<std::uint64_t>(limit) : 0);
}

void drawing_move(Machine&, Instance&, Vector3) {}

void drawing_add_polygon_point(Machine& machine, Instance& self, Vector3 point) {
  DrawCommand command{Kind::PolygonPoint};
  command.vector = finite(point, "a polygon's point");
  drawing(machine, self).add(command);
}

void drawing_end_polygon(Machine& machine, Instance& self) {
  drawing(machine, self).add(DrawCommand{Kind::EndPolygon});
}

void drawing_draw_line(Machine& machine, Instance& self, Vector3 from, Vector3 to) {
  DrawCommand command{Kind::Line};
  command.from = finite(from, "a line's end");
  command.vector = finite(to, "a line's end");
  drawing(machine, self).add(command);
}

void drawing_add_line_point(Machine& machine, Instance& self, Vector3 point) {
  drawing(machine, self).add_line_point(finite(point, "a line's point"));
}

void drawing_begin_line(Machine& machine, Instance& self) { drawing(machine, self).has_last_point = false; }

void drawing_set_line_style(Machine& machine, Instance& self, Text pattern) {
  DrawCommand command{Kind::LineStyle};
  command.style = line_style(view(pattern));
  drawing(machine, self).add(command);
}

void drawing_set_line_width(Machine& machine, Instance& self, double pixels) {
  DrawCommand command{Kind::LineWidth};
  command.value = finite(pixels, "a line's width");
  drawing(machine, self).add(command);
}

void drawing_set_color(Machine& machine, Instance& self, Vector3 color, double alpha) {
  DrawCommand command{Kind::Color};
  command.vector = finite(color, "a colour");
  command.value = finite(alpha, "a transparency");
  drawing(machine, self).add(command);
}

// --- Line ------------------------------------------------------------------------------------------------------------

LineResource& line(Machine& machine, Instance& self) { return resource_made<LineResource>(machine, self); }

Instance* line_connect(Machine& machine, Instance& self, Instance* from, Instance* to, Vector3 color, Text style) {
  const ObjectId from_id = must_live(from, "connect: the first object").id;
  const ObjectId to_id = must_live(to, "connect: the second object").id;
  LineResource& ends = line(machine, self);
  ends.from = from_id;
  ends.to = to_id;
  ends.color = finite(color, "a line's colour");
  ends.style = line_style(view(style));
  return &self;
}

std::int32_t line_is_linked(Machine& machine, Instance& self, Instance* other) {
  const ObjectId id = machine.id_of(other);
  const LineResource& ends = line(machine, self);
  return id && (ends.from == id || ends.to == id);
}

void line_set_color(Machine& machine, Instance& self, Vector3 color) {
  line(machine, self).color = finite(color, "a line's colour");
}

void line_set_transparency(Machine& machine, Instance& self, double alpha) {
  line(machine, self).alpha = finite(alpha, "a line's transparency");
}

constexpr Native kDrawingNatives[] = {
    native<drawing_init>("drawing.init"),
    native<drawing_get_size>("drawing.get-size"),
    native<drawing_clear>("drawing.clear"),
    native<drawing_set_limit>("drawing.set-instruction-limit"),
    native<drawing_move>("drawing.move"),
    native<drawing_add_polygon_point>("drawing.add-polygon-point"),
    native<drawing_end_polygon>("drawing.end-polygon"),
    native<drawing_draw_line>("drawing.draw-line"),
    native<drawing_add_line_point>("drawing.add-line-point"),
    native<drawing_begin_line>("drawing.begin-line"),
    native<drawing_set_line_style>("drawing.set-line-style"),
    native<drawing_set_line_width>("drawing.set-line-width"),
    native<drawing_set_color>("drawing.set-color"),
    native<line_connect>("line.connect"),
    native<line_is_linked>("line.is-linked"),
    native<line_set_color>("line.set-color"),
    native<line_set_transparency>("line.set-transparency"),
};

}  // namespace

std::span<const Native> drawing_natives() { return kDrawingNatives; }

}  // namespace breve::steve
