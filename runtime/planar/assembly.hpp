// A sub-step of bodies that joints connect and that touch nothing, solved as a whole and in double precision.
#pragma once

#include "runtime/planar/core.hpp"
#include "runtime/planar/joint_system.hpp"

namespace breve {

/// A body's pose: its center of mass, length units, and its rotation.
struct FlatPose {
  Vector2 center = Vector2::Zero();
  double angle = 0;                 // rad
  Vector2 along = Vector2::UnitX();  // the body's x axis
  FlatPose() = default;
  FlatPose(const Vector2& at, double rotation)
      : center(at), angle(rotation), along(std::cos(rotation), std::sin(rotation)) {}
  Vector2 rotated(const Vector2& own) const { return own.x() * along + own.y() * left_of(along); }
  Vector2 point(const Vector2& own) const { return center + rotated(own); }
};

/// The bodies and joints of one assembly. Its structure lasts until bodies or joints change; all else is of a sub-step.
class Planar::Core::Assembly {
 public:
  using Vector = JointSystem::Vector;
  /// All that joints connect with a body.
  Assembly(Core& core, BodyIndex first);
  /// Replaces what Box2D has made of a sub-step. Does nothing where something touches, or no solution is found.
  void move(double dt);

 private:
  struct Link {
    BodyIndex body = kNoBody;
    FlatBody* flat = nullptr;
  };
  struct Member {
    JointIndex joint = kNoJoint;
    std::uint64_t serial = 0;
    JointKind kind = JointKind::Fixed;
    Vector2 parent_point = Vector2::Zero(), child_point = Vector2::Zero();  // from the centers of mass, in the bodies
    Vector2 axis = Vector2::UnitX();                                       // of a prismatic one, in the parent
    double reference = 0;                                                  // rad
    FlatPose parent, child;                                                // of bodies that do not move by themselves
    bool locked = false;    // its motor or a limit decides how it moves
    double low = 0, high = 0;  // limits that it is at, rad or length units
    double target = 0;      // the rate that motor or limit give it
    Vector gap = Vector::Zero(), impulse = Vector::Zero();
    Eigen::Index free_row() const { return kind == JointKind::Prismatic ? 1 : 2; }
  };
  using Numbers = std::pmr::vector<std::pair<BodyIndex, int>>;  // of bodies in the assembly, sorted
  static int number_of(const Numbers& numbers, BodyIndex body);
  void collect_joints(const Numbers& numbers);
  bool may_move();
  bool connects_script(const JointDescription& is) const;
  void load();
  void load_joint(std::size_t index, double dt);
  void note_drive(Member& member, double dt);
  FlatPose pose_of(const FlatBody* flat) const;
  Vector gap_of(std::size_t index, std::span<const FlatPose> poses) const;
  double travel_of(std::size_t index, std::span<const FlatPose> poses) const;
  std::pair<FlatPose, FlatPose> ends_of(std::size_t index, std::span<const FlatPose> poses) const;
  void linearize(std::span<const FlatPose> poses);
  void add_gravity(double dt);
  void advance_poses(double dt);
  bool find_path(double dt);
  void give_rates();
  void close_gaps();
  void allow(double dt);
  void keep(double dt);
  void keep_impulses(const Member& member, double dt);

  Core& core_;
  bool planned_ = false;
  std::pmr::vector<Link> links_;
  std::pmr::vector<Member> joints_;  // in the order of elimination
  JointSystem system_;
  std::pmr::vector<FlatPose> before_, after_;
  std::pmr::vector<Vector> mobility_, velocities_, moves_, rates_;
};

}  // namespace breve
