// Natives of Real that say how a body is drawn. State only: kept and readable whether or not anything draws.
#include <cmath>

#include "steve/library/support.hpp"
#include "steve/library/tables.hpp"

namespace breve::steve {

namespace {

using Text = StringCell*;

Appearance& look(Machine& machine, const Instance& self) {
  return machine.world().bodies().appearance(body_of(machine, self));
}

void set_color(Machine& machine, Instance& self, Vector3 color) {
  look(machine, self).color = finite(color, "set-color: the colour");
}

Vector3 get_color(Machine& machine, Instance& self) {
  const Bodies& bodies = machine.world().bodies();
  return bodies.appearance(body_of(machine, self)).color;
}

void set_transparency(Machine& machine, Instance& self, double alpha) {
  look(machine, self).alpha = finite(alpha, "set-transparency: the transparency");
}

template <bool Appearance::*Flag, bool On>
void set_flag(Machine& machine, Instance& self) {
  look(machine, self).*Flag = On;
}

// --- pictures --------------------------------------------------------------------------------------------------------

/// The picture is kept alive by a variable of Real, and known to the renderer by its id.
void set_picture(Machine& machine, Instance& self, Instance* image, ObjectId Appearance::*id,
                 std::string_view variable) {
  look(machine, self).*id = machine.id_of(image);
  set_library_object(machine, self, "Real", variable, image && image->live() ? image : nullptr);
}

void set_texture_image(Machine& machine, Instance& self, Instance* image) {
  set_picture(machine, self, image, &Appearance::texture, "textureImage");
}

void set_bitmap_image(Machine& machine, Instance& self, Instance* image) {
  set_picture(machine, self, image, &Appearance::bitmap, "bitmapImage");
}

void set_lightmap_image(Machine& machine, Instance& self, Instance* image) {
  set_picture(machine, self, image, &Appearance::lightmap, "lightmapImage");
}

void set_lightmap(Machine& machine, Instance& self, std::int32_t number) {
  set_lightmap_image(machine, self, machine.instance(object_with_index(machine, number)));
}

double tile_size(double size) {
  constexpr double kSmallest = 0.001;
  return finite(size, "a texture's scale") < 0 ? kSmallest : size;
}

void set_texture_scale_x(Machine& machine, Instance& self, double size) {
  look(machine, self).texture_scale_x = tile_size(size);
}

void set_texture_scale_y(Machine& machine, Instance& self, double size) {
  look(machine, self).texture_scale_y = tile_size(size);
}

void set_texture_scale(Machine& machine, Instance& self, double size) {
  set_texture_scale_x(machine, self, size);
  set_texture_scale_y(machine, self, size);
}

void set_bitmap_heading(Machine& machine, Instance& self, double radians) {
  look(machine, self).bitmap_heading = finite(radians, "a bitmap's heading");
}

/// The heading whose "up" is the direction as the main camera sees it; 0 points up the screen, counter-clockwise is
/// positive. A direction along the line of sight has none: nothing changes.
void set_bitmap_heading_point(Machine& machine, Instance& self, Vector3 direction) {
  finite(direction, "a bitmap's heading");
  const CameraState& camera = machine.world().view().camera;
  // Camera axes in the world: it stands at +z of its target, pitched about x, then rotated about y.
  const Eigen::Quaterniond rotation =
      Eigen::AngleAxisd(camera.yaw, Vector3::UnitY()) * Eigen::AngleAxisd(camera.pitch, Vector3::UnitX());
  const Vector3 seen = rotation.conjugate() * direction;
  if (seen.x() == 0 && seen.y() == 0) return;
  look(machine, self).bitmap_heading = std::atan2(-seen.x(), seen.y());
}

void set_label(Machine& machine, Instance& self, Text text) { look(machine, self).label = view(text); }
void remove_label(Machine& machine, Instance& self) { look(machine, self).label.clear(); }

constexpr Native kLookNatives[] = {
    native<get_color>("real.get-color"),
    native<set_color>("real.set-color"),
    native<set_transparency>("real.set-transparency"),
    native<set_flag<&Appearance::visible, false>>("real.make-invisible"),
    native<set_flag<&Appearance::visible, true>>("real.make-visible"),
    native<set_flag<&Appearance::shadows, true>>("real.enable-shadows"),
    native<set_flag<&Appearance::shadows, false>>("real.disable-shadows"),
    native<set_flag<&Appearance::as_point, true>>("real.draw-as-point"),
    native<set_flag<&Appearance::bounding_box, true>>("real.show-bounding-box"),
    native<set_flag<&Appearance::bounding_box, false>>("real.hide-bounding-box"),
    native<set_flag<&Appearance::axis, true>>("real.show-axis"),
    native<set_flag<&Appearance::axis, false>>("real.hide-axis"),
    native<set_flag<&Appearance::neighbor_lines, true>>("real.show-neighbor-lines"),
    native<set_flag<&Appearance::neighbor_lines, false>>("real.hide-neighbor-lines"),
    native<set_texture_image>("real.set-texture-image"),
    native<set_bitmap_image>("real.set-bitmap-image"),
    native<set_lightmap_image>("real.set-lightmap-image"),
    native<set_lightmap>("real.set-lightmap"),
    native<set_texture_scale>("real.set-texture-scale"),
    native<set_texture_scale_x>("real.set-texture-scale-x"),
    native<set_texture_scale_y>("real.set-texture-scale-y"),
    native<set_bitmap_heading>("real.set-bitmap-heading"),
    native<set_bitmap_heading_point>("real.set-bitmap-heading-point"),
    native<set_label>("mobile.set-label"),
    native<remove_label>("mobile.remove-label"),
};

}  // namespace

std::span<const Native> look_natives() { return kLookNatives; }

}  // namespace breve::steve
