// The forces of one sub-step: what scripts set, what their force methods answer, springs, and what joints do by
// themselves.
#include "runtime/planar/spring_rows.hpp"

namespace breve {

/// Springs and dampers, of joints and between bodies.
void Planar::Core::apply_springs(double dt) {
  if (!spring_rows) spring_rows = std::make_unique<SpringRows>(*this);
  SpringRows& rows = *spring_rows;
  rows.begin(dt);
  bool any = false;
  for (FlatJoint& joint : joints) {
    if (!joint.used || !steps(joint)) continue;
    const JointDrive& drive = joint.drive;
    joint.pull = 0;
    if (joint.is.kind == JointKind::Fixed || !joint.b2) continue;
    if (drive.double_strength != 0) put_drive(joint);
    if (drive.stiffness == 0 && drive.damping == 0 && drive.force[0] == 0) continue;
    rows.add(joint);
    any = true;
  }
  for (FlatSpring& spring : springs) {
    if (!spring.used || !steps(spring)) continue;
    rows.add(spring);
    any = true;
  }
  if (any) rows.solve();
}

/// Force methods see where all bodies stand now, and are asked before anything moves.
void Planar::Core::ask_forces() {
  for (FlatBody& flat : slots)
    if (flat.body != kNoBody && !flat.fixed && !flat.set_apart && is_finite(*flat.b2)) write_back(flat);
  for (std::size_t i = 0; i < force_methods.size(); ++i) {
    FlatBody* flat = find(force_methods[i]);
    if (!flat || flat->fixed || flat->set_apart) continue;
    flat->asked = client->stage_force(flat->body, now, sub_step).head<2>();
    flat->pulled = true;
  }
}

void Planar::Core::apply_forces(double dt) {
  const double u = settings.unit;
  // Where nothing ever pulled, nothing is to be cleared.
  const bool pulls = !joints.empty() || !springs.empty() || !force_methods.empty();
  if (pulls)
    for (FlatBody& flat : slots) {
      if (flat.set_apart) continue;
      flat.pulled = flat.flies = false;
      flat.asked = flat.pull = Vector2::Zero();
      flat.twist = 0;
    }
  if (!force_methods.empty()) ask_forces();
  if (!joints.empty() || !springs.empty()) apply_springs(dt);
  for (FlatBody& flat : slots) {
    if ((!pulls && !flat.has_force) || flat.body == kNoBody || flat.fixed || flat.set_apart) continue;
    const Vector2 force = flat.force + flat.asked + flat.pull;
    const double torque = flat.torque + flat.twist;
    if (force == Vector2::Zero() && torque == 0) continue;
    // What sleeps goes on sleeping under a force that did not change.
    const bool wake = flat.pulled || flat.asked != Vector2::Zero();
    flat.b2->ApplyForceToCenter(b2Vec2(static_cast<float>(force.x() / u), static_cast<float>(force.y() / u)), wake);
    flat.b2->ApplyTorque(static_cast<float>(torque / (u * u)), wake);
  }
}

}  // namespace breve
