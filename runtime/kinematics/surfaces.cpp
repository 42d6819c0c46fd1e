// Materials, collision filters and looks of bodies. Only bodies that differ from the default have a row of each.
#include <utility>

#include "runtime/kinematics/arrays.hpp"
#include "runtime/kinematics/bodies.hpp"

namespace breve {

namespace {

const Material kPlainMaterial{};
const CollisionFilter kPlainFilter{};
const Appearance kPlainAppearance{};
const std::pmr::vector<BodyIndex> kNobody;

}  // namespace

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
