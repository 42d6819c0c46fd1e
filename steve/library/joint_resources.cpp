// Native data of Joint and Spring objects in snapshots, archives and hashes.
#include "steve/library/joints.hpp"

namespace breve::steve {

namespace {

/// A number that must be below `end`, else the image is damaged.
template <class Enum>
Enum get_enum(ByteReader& in, int end) {
  const auto number = in.get<std::uint8_t>();
  if (number >= end) ByteReader::fail();
  return static_cast<Enum>(number);
}

/// What no program can give a joint comes from a damaged archive or image. A point may be anywhere: that of a joint to
/// the world goes where its child is moved, and only linking again asks how far that is.
void need_linkable(const JointResource& joint) {
  const JointDescription& is = joint.is;
  bool good = is.relative_rotation.coeffs().allFinite() && is.relative_rotation.norm() > 0;
  for (const Vector3* vector : {&is.parent_point, &is.child_point, &is.normal, &joint.position, &joint.velocity})
    good = good && vector->allFinite();
  if (!good || (is.kind != JointKind::Fixed && !(is.normal.stableNorm() > 0))) ByteReader::fail();
  try {
    check(joint.drive, is.kind);
  } catch (const Error& error) {
    if (error.code() == ErrorCode::Argument) ByteReader::fail();
    throw;
  }
}

}  // namespace

void JointResource::save(ByteWriter& out) const {
  out.put(index);
  out.put(static_cast<std::uint8_t>(is.kind));
  for (const Vector3* v : {&is.parent_point, &is.child_point, &is.normal}) out.put(*v);
  out.put(is.relative_rotation);
  out.put(is.keep_rotation);
  out.put(scales);
  out.put(was_linked);
  if (!was_linked) return;
  for (const Vector3* v :
       {&drive.motor_speed, &drive.rest, &drive.force, &drive.low, &drive.high, &position, &velocity})
    out.put(*v);
  for (const double number : {drive.strength_limit, drive.double_strength, drive.double_max, drive.double_min,
                              drive.damping, drive.stiffness, drive.limit_restitution})
    out.put(number);
}

void JointResource::hash(Hasher& hasher) const {
  hasher.add(std::uint64_t{index});
  for (const Vector3* v : {&is.parent_point, &is.child_point, &is.normal}) hasher.add(*v);
  hasher.add(is.relative_rotation);
  hasher.add(std::uint64_t{scales});
}

std::unique_ptr<Resource> JointResource::load(ByteReader& in) {
  auto resource = make_in<JointResource>(in.memory());
  JointResource& r = *resource;
  constexpr int kKinds = 5;
  r.index = in.get<JointIndex>();
  r.is.kind = get_enum<JointKind>(in, kKinds);
  for (Vector3* v : {&r.is.parent_point, &r.is.child_point, &r.is.normal}) *v = in.get_vector();
  r.is.relative_rotation = in.get_quaternion();
  r.is.keep_rotation = in.get_bool();
  r.scales = in.get_bool();
  r.was_linked = in.get_bool();
  if (!r.was_linked) return resource;
  for (Vector3* v :
       {&r.drive.motor_speed, &r.drive.rest, &r.drive.force, &r.drive.low, &r.drive.high, &r.position, &r.velocity})
    *v = in.get_vector();
  for (double* number : {&r.drive.strength_limit, &r.drive.double_strength, &r.drive.double_max, &r.drive.double_min,
                         &r.drive.damping, &r.drive.stiffness, &r.drive.limit_restitution})
    *number = in.get<double>();
  need_linkable(r);
  return resource;
}

void SpringResource::save(ByteWriter& out) const {
  out.put(index);
  out.put(is.point_a);
  out.put(is.point_b);
  for (const double number : {is.length, is.strength, is.damping, is.maximum_force}) out.put(number);
  out.put(static_cast<std::uint8_t>(is.mode));
}

void SpringResource::hash(Hasher& hasher) const {
  hasher.add(std::uint64_t{index});
  hasher.add(is.point_a);
  hasher.add(is.point_b);
  for (const double number : {is.length, is.strength, is.damping, is.maximum_force}) hasher.add(number);
  hasher.add(static_cast<std::uint64_t>(is.mode));
}

std::unique_ptr<Resource> SpringResource::load(ByteReader& in) {
  auto resource = make_in<SpringResource>(in.memory());
  SpringDescription& is = resource->is;
  constexpr int kModes = 3;
  resource->index = in.get<SpringIndex>();
  is.point_a = in.get_vector();
  is.point_b = in.get_vector();
  for (double* number : {&is.length, &is.strength, &is.damping, &is.maximum_force}) *number = in.get<double>();
  is.mode = get_enum<SpringMode>(in, kModes);
  return resource;
}

}  // namespace breve::steve
