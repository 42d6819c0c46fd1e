// The table of springs between bodies of a flat world.
#include "runtime/base/error.hpp"
#include "runtime/planar/core.hpp"

namespace breve {

namespace {
FlatSpring& at(Planar::Core& core, SpringIndex spring) {
  if (spring >= core.springs.size() || !core.springs[spring].used) fail_no_spring();
  return core.springs[spring];
}
void need_ends_in_plane(const SpringDescription& is) {
  if (is.point_a.z() != 0 || is.point_b.z() != 0)
    throw Error(ErrorCode::Argument,
                "spring: a point of attachment is outside the plane, but this world is flat: z must be 0");
}
}  // namespace

SpringIndex Planar::add_spring(const SpringDescription& description, ObjectId owner) {
  check(description);
  need_ends_in_plane(description);
  Core& c = *core_;
  check_ends(description, *c.bodies);
  if (description.a == description.b) return kNoSpring;
  reserve_free(c.springs, c.free_springs);
  const SpringIndex index = take_slot(c.springs, c.free_springs);
  c.springs[index] = {true, owner, description, 0};
  c.wake_ends(c.springs[index]);
  return index;
}

void Planar::remove_spring(SpringIndex spring) {
  core_->wake_ends(at(*core_, spring));
  at(*core_, spring) = FlatSpring();
  core_->free_springs.push_back(spring);
}

const SpringRecord* Planar::spring_record(SpringIndex spring) const {
  return spring < core_->springs.size() && core_->springs[spring].used ? &core_->springs[spring] : nullptr;
}

void Planar::set_spring(SpringIndex spring, const SpringDescription& description) {
  check(description);
  need_ends_in_plane(description);
  FlatSpring& entry = at(*core_, spring);
  const BodyIndex a = entry.is.a, b = entry.is.b;
  entry.is = description;
  entry.is.a = a;
  entry.is.b = b;
  core_->wake_ends(entry);
}

}  // namespace breve
