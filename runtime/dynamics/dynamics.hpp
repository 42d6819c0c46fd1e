// Bodies that have forces, in space: joints, trees, contacts, the step of every rung, energy and guard. Start here, go
// on with README.md; what each function promises is in runtime/mechanics/mechanics.hpp. Positions and velocities of
// joints are the truth and never drift.
#pragma once

#include <memory>

#include "runtime/mechanics/mechanics.hpp"

namespace breve {

class Dynamics final : public Mechanics {
 public:
  Dynamics(std::pmr::memory_resource* memory, Bodies& bodies);
  ~Dynamics() override;
  void rebind(Bodies& bodies) override;

  // --- joints -----------------------------------------------------------------------------------------------------
  JointIndex link(const JointDescription& description, ObjectId owner) override;
  void unlink(JointIndex joint) override;
  std::size_t joint_count() const override;
  void relink(JointIndex joint, const JointDescription& description) override;

  void set_drive(JointIndex joint, const JointDrive& drive) override;

  JointVector position(JointIndex joint) const override;
  JointVector velocity(JointIndex joint) const override;
  void set_position(JointIndex joint, const JointVector& position) override;
  void set_velocity(JointIndex joint, const JointVector& velocity) override;
  void set_ball(JointIndex joint, const Quaternion& rotation, const Vector3& spin) override;
  JointReaction reaction(JointIndex joint) const override;

  // --- assemblies: bodies that joints connect ---------------------------------------------------------------------
  bool jointed(BodyIndex a, BodyIndex b) const override;
  bool same_assembly(BodyIndex a, BodyIndex b) const override;
  std::pmr::vector<BodyIndex> links_of(BodyIndex body) const override;
  std::pmr::vector<JointIndex> joints_of(BodyIndex body) const override;
  void move_assembly(BodyIndex body, const Vector3& location, const Quaternion& orientation) override;
  void set_assembly_velocity(BodyIndex body, const Vector3& velocity, const Vector3& spin) override;
  void set_self_collision_parameters(BodyIndex body, double erp, double cfm) override;
  Energy energy(BodyIndex body) const override;
  void moved(BodyIndex body) override;
  std::size_t self_penetrations(BodyIndex body) const override;

  // --- springs between bodies ---------------------------------------------------------------------------------------
  SpringIndex add_spring(const SpringDescription& description, ObjectId owner) override;
  void remove_spring(SpringIndex spring) override;
  void set_spring(SpringIndex spring, const SpringDescription& description) override;

  // --- settings of the world ----------------------------------------------------------------------------------------
  int dimension() const override { return 3; }
  void set_gravity(const Vector3& gravity) override;
  std::string describe_accuracy() const override { return describe(accuracy()); }
  void set_force_method(BodyIndex body, bool on) override;
  bool force_method(BodyIndex body) const override;

  // --- what there is to know ----------------------------------------------------------------------------------------
  bool asleep(BodyIndex body) const override;
  Vector3 contact_force(BodyIndex body, BodyIndex other) const override;
  Energy energy() const override;
  std::size_t bytes() const override;
  Census census() const override;

  // --- the world's side ---------------------------------------------------------------------------------------------
  void advance(MechanicsClient& client, double start, double h, double share) override;
  void abandon() override {}  // a step keeps nothing that the next one would find
  void take_changes() override;
  bool pushes(BodyIndex a, BodyIndex b, const MechanicsClient& client) const override;
  void forget(BodyIndex body) override;
  void save(ByteWriter& out) const override;
  void load(ByteReader& in) override;
  void hash(Hasher& hasher) const override;

  struct Core;  // the inside

 private:
  void wake_disturbed() const;
  // Made with the first joint, spring or physics-enabled body.
  Core& core();
  MechanicsCore& inside() override;
  const JointRecord* joint_record(JointIndex joint) const override;
  const SpringRecord* spring_record(SpringIndex spring) const override;
  const AssemblySettings* settings_of(BodyIndex body, bool (*wanted)(const AssemblySettings&)) const override;
  void settings_begin(BodyIndex body) override;
  void accuracy_changed() override;
  void sleeping_ended() override;
  void length_unit_changed() override;
  std::pmr::memory_resource* memory_;
  Bodies* bodies_;
  std::unique_ptr<Core> core_;
};

}  // namespace breve
