// Shapes, materials, collision filters and looks of bodies. Only bodies that differ from the default have a row of each
// of the last three.
#include <stdexcept>
#include <utility>

#include "runtime/base/error.hpp"
#include "runtime/kinematics/arrays.hpp"
#include "runtime/kinematics/bodies.hpp"

namespace breve {

namespace {

const Material kPlainMaterial{};
const CollisionFilter kPlainFilter{};
const Appearance kPlainAppearance{};
const std::pmr::vector<BodyIndex> kNobody;

}  // namespace

const std::shared_ptr<Shape>& Bodies::collision_shape(BodyIndex body) const { return arrays_->collision_shape[body]; }
const std::shared_ptr<Shape>& Bodies::display_shape(BodyIndex body) const { return arrays_->display_shape[body]; }

void Bodies::set_collision_shape(BodyIndex body, std::shared_ptr<Shape> shape) {
  if (!shape) throw Error(ErrorCode::Argument, "a body needs a shape: the one given is null");
  shape->report_changes_to(arrays_->shape_changes);
  arrays_->collision_shape[body] = std::move(shape);
  arrays_->note_put(body);
  if (arrays_->rigid_row[body] != kNoRow) arrays_->copy_mass(body);
  arrays_->note(body);
}

void Bodies::set_display_shape(BodyIndex body, std::shared_ptr<Shape> shape) {
  if (!shape) throw Error(ErrorCode::Argument, "a body needs a shape: the one given is null");
  arrays_->display_shape[body] = std::move(shape);
}

Eigen::AlignedBox3d Bodies::bounds(BodyIndex body) const {
  Eigen::AlignedBox3d box = arrays_->collision_shape[body]->bounds(rotation(body));
  return box.translate(arrays_->location[body]);
}

double Bodies::mass(BodyIndex body) const { return arrays_->collision_shape[body]->mass(); }

const MassProperties& Bodies::mass_properties(BodyIndex body) const {
  if (arrays_->rigid_row[body] == kNoRow) throw std::logic_error("mass of a body that never had physics");
  return arrays_->rigid_rows[arrays_->rigid_row[body]].solid;
}

Material& Bodies::material(BodyIndex body) {
  RowIndex& row = arrays_->material_row[body];
  if (row == kNoRow) row = arrays_->materials.make();
  return arrays_->materials[row];
}

const Material& Bodies::material(BodyIndex body) const {
  const RowIndex row = arrays_->material_row[body];
  return row == kNoRow ? kPlainMaterial : std::as_const(arrays_->materials)[row];
}

const CollisionFilter& Bodies::filter(BodyIndex body) const {
  const RowIndex row = arrays_->filter_row[body];
  return row == kNoRow ? kPlainFilter : std::as_const(arrays_->filters)[row];
}

bool Bodies::filtered() const { return arrays_ && arrays_->filters.bytes() != 0; }

const std::pmr::vector<BodyIndex>& Bodies::picky() const { return arrays_ ? arrays_->picky : kNobody; }

Appearance& Bodies::appearance(BodyIndex body) {
  RowIndex& row = arrays_->appearance_row[body];
  if (row == kNoRow) row = arrays_->appearances.make();
  return arrays_->appearances[row];
}

const Appearance& Bodies::appearance(BodyIndex body) const {
  const RowIndex row = arrays_->appearance_row[body];
  return row == kNoRow ? kPlainAppearance : std::as_const(arrays_->appearances)[row];
}

}  // namespace breve
