// The systems of the mb_ files as worlds: see trees.hpp.
#include "trees.hpp"

namespace breve::reference {

namespace {

Matrix3 inertia_of(const Row& row) {
  const double xy = row.number("Ixy"), xz = row.number("Ixz"), yz = row.number("Iyz");
  Matrix3 inertia;
  inertia << row.number("Ixx"), xy, xz, xy, row.number("Iyy"), yz, xz, yz, row.number("Izz");
  return inertia;
}

}  // namespace

bool Tree::can_be_built(const std::string& name) {
  for (const Row& row : rows_of("mb_models", name))
    if (row.text("type") == "U" || row.text("type") == "B") return false;
  return true;
}

Tree::Tree(const std::string& name, double step, breve_rung rung, bool with_tau) : world(step, rung) {
  world.set_guard(BREVE_GUARD_REPORT);
  world.set_gravity(vector(rows_of("mb_cases", name).front(), "g"));
  for (const Row& row : rows_of("mb_springs", name)) springs_.emplace(row.integer("body"), row);
  const std::vector<Row> models = rows_of("mb_models", name), states = rows_of("mb_state", name);
  for (std::size_t i = 0; i < models.size(); ++i) add(models[i], with_tau, states[i]);
  // Joints are closed as by an impact without rebound: so all are made before anything moves.
  for (std::size_t i = 0; i < models.size(); ++i) start(states[i], i);
}

void Tree::add(const Row& row, bool with_tau, const Row& state) {
  const Quaternion orientation =
      Quaternion(row.number("rw"), row.number("rx"), row.number("ry"), row.number("rz")).normalized();
  const int parent = row.integer("parent");
  centres_.push_back(vector(row, "c"));
  positions_.push_back(vector(row, "p"));
  orientations_.push_back(orientation);
  bodies.push_back(world.body(lump(row.number("mass"), inertia_of(row)), Vector3::Zero()));
  joints.push_back(breve_object{});
  const std::string& type = row.text("type");
  if (type == "F") return;
  Hinge hinge;
  hinge.kind = type == "R" ? BREVE_JOINT_REVOLUTE : type == "P" ? BREVE_JOINT_PRISMATIC : BREVE_JOINT_FIXED;
  hinge.child = bodies.back();
  hinge.child_point = -centres_.back();
  hinge.rotation = orientation;
  hinge.parent_point = positions_.back();
  if (parent >= 0) {
    hinge.parent = bodies[static_cast<std::size_t>(parent)];
    hinge.parent_point -= centres_[static_cast<std::size_t>(parent)];
  }
  // The file's numbers turn the child along +axis, ours the parent.
  if (type != "X") hinge.normal = orientation * -vector(row, "a").normalized();
  joints.back() = world.join(hinge);
  breve_drive drive = world.drive(joints.back());
  drive.low[0] = -INFINITY, drive.high[0] = INFINITY;
  if (with_tau && !state.empty("tau0")) drive.force[0] = state.number("tau0");
  const auto spring = springs_.find(static_cast<int>(joints.size()) - 1);
  if (spring != springs_.end()) {
    drive.stiffness = spring->second.number("stiffness");
    drive.damping = spring->second.number("damping");
  }
  if (type != "X") world.set_drive(joints.back(), drive);
}

void Tree::start(const Row& row, std::size_t i) {
  if (joints[i].generation != 0) {
    if (!row.empty("q0")) world.set_joint(joints[i], row.number("q0"), row.number("u0"));
    return;
  }
  const Quaternion orientation =
      orientations_[i] * Quaternion(row.number("q3"), row.number("q4"), row.number("q5"), row.number("q6"));
  const Vector3 spin = orientation * Vector3(row.number("u3"), row.number("u4"), row.number("u5"));
  const Vector3 arm = orientation * centres_[i];
  const Vector3 at =
      positions_[i] + orientations_[i] * Vector3(row.number("q0"), row.number("q1"), row.number("q2")) + arm;
  const breve_pose pose{{at.x(), at.y(), at.z()}, {orientation.w(), orientation.x(), orientation.y(), orientation.z()}};
  world.must(breve_object_set_assembly_pose(world.get(), bodies[i], &pose));
  world.set_spin(bodies[i], spin);
  world.set_velocity(
      bodies[i], orientations_[i] * Vector3(row.number("u0"), row.number("u1"), row.number("u2")) + spin.cross(arm));
}

double Tree::error(const Row& row) const {
  const auto i = static_cast<std::size_t>(row.integer("body"));
  if (joints[i].generation != 0) {
    if (row.empty("q0")) return 0;
    const breve_joint_info info = world.read(joints[i]);
    return std::max(std::abs(info.position[0] - row.number("q0")), std::abs(info.velocity[0] - row.number("u0")));
  }
  const Quaternion orientation =
      orientations_[i] * Quaternion(row.number("q3"), row.number("q4"), row.number("q5"), row.number("q6"));
  const Vector3 at = world.at(bodies[i]) - world.orientation(bodies[i]) * centres_[i];
  const Vector3 position =
      positions_[i] + orientations_[i] * Vector3(row.number("q0"), row.number("q1"), row.number("q2"));
  const Vector3 spin = orientation * Vector3(row.number("u3"), row.number("u4"), row.number("u5"));
  return std::max({(at - position).cwiseAbs().maxCoeff(), world.orientation(bodies[i]).angularDistance(orientation),
                   (world.spin(bodies[i]) - spin).cwiseAbs().maxCoeff()});
}

}  // namespace breve::reference
