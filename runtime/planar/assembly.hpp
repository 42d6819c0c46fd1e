// A sub-step of bodies that joints connect and that nothing pushes, solved as a whole and in double precision.
#pragma once

#include "runtime/planar/island.hpp"
#include "runtime/planar/joint_system.hpp"

namespace breve {

/// A body's pose: its center of mass, length units, and its rotation.
struct FlatPose {
  Vector2 center = Vector2::Zero();
  double angle = 0;                  // rad
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
  /// Replaces what Box2D has made of a sub-step. Does nothing where something pushes it, or no solution is found.
  void move(double dt);
  /// Closes joints that are open, where Box2D has moved the links.
  /// @param touching  what touches the links is added to it, as it was before they were moved
  /// @return          one of the links, if some of them are pressed into something by this
  FlatBody* close(double dt, std::pmr::vector<Island::Apart>& touching);
  /// Energy that contacts and joints have given it is taken from its motion, where Box2D has moved it.
  void take_back(double dt);

 private:
  struct Link {
    BodyIndex body = kNoBody;
    FlatBody* flat = nullptr;
    bool eccentric = false;  // a joint holds it away from its center of mass
  };
  struct Member {
    JointIndex joint = kNoJoint;
    std::uint64_t serial = 0;
    JointKind kind = JointKind::Fixed;
    Vector2 parent_point = Vector2::Zero(), child_point = Vector2::Zero();  // from the centers of mass, in the bodies
    Vector2 axis = Vector2::UnitX();                                        // of a prismatic one, in the parent
    double reference = 0;                                                   // rad
    FlatPose parent, child;                                                 // of bodies that do not move by themselves
    bool locked = false;                                                    // its motor or a limit decides how it moves
    double least = 0, most = 0;                                             // its limits, rad or length units
    double low = 0, high = 0;                                               // those that hold it, the same
    bool caught = false;                                                    // came to one unseen by Box2D
    double travel = 0;                                                      // where it was along its own axis
    double speed = 0, target = 0;            // the rates that its motor, and what holds it, are to give it
    double rate = 0;                         // that it had, of one that is held
    double work = 0;                         // of its motor, in Box2D's units
    double spring = 0;                       // the force of its spring and damper, if it is prismatic, the same
    double rate_then = 0, impulse_then = 0;  // before what is being solved
    double load = 0;                         // the impulse of a motor that is at its strength
    double strength = 0;                     // the most that its impulse may be
    Vector gap = Vector::Zero(), impulse = Vector::Zero();
    /// A limit holds it where it already stood still.
    /// @param still  length units or rad, that it moves at most in a sub-step of dt seconds while it stands
    bool rests(double dt, double still) const {
      return limited() && std::max(std::abs(target), std::abs(rate)) * dt < still;
    }
    bool limited() const { return std::isfinite(low) || std::isfinite(high); }
    Eigen::Index free_row() const { return kind == JointKind::Prismatic ? 1 : 2; }
  };
  using Numbers = std::pmr::vector<std::pair<BodyIndex, int>>;  // of bodies in the assembly, sorted
  static int number_of(const Numbers& numbers, BodyIndex body);
  void collect_joints(const Numbers& numbers);
  static bool is_pushed(const FlatBody& flat);
  bool may_move();
  bool connects_script(const JointDescription& is) const;
  void load(double dt);
  void load_joint(std::size_t index, double dt);
  void note_drive(Member& member, double dt);
  static void aim(Member& member, double dt);
  static FlatPose pose_before(const FlatBody& flat);
  Vector gap_of(std::size_t index, std::span<const FlatPose> poses) const;
  double travel_of(std::size_t index, std::span<const FlatPose> poses) const;
  std::pair<FlatPose, FlatPose> ends_of(std::size_t index, std::span<const FlatPose> poses) const;
  std::pair<Vector, Vector> axis_rows(std::size_t index, std::span<const FlatPose> poses) const;
  void linearize(std::span<const FlatPose> poses, double softness = JointSystem::kRegular);
  static double early(const Link& link);
  double early(std::size_t index) const;
  void push(std::size_t index, double impulse, std::span<const FlatPose> poses);
  void take_spring(std::size_t index);
  void add_loads(double h, double part);
  void advance_poses(double h);
  bool find_path(double h);
  void give_rates();
  void allow(double h, bool ends);
  bool take(double h, double part, bool last);
  bool take_all(double dt, int parts);
  static double motor_share(const Member& member);
  bool release();
  bool catch_up(double dt);

  // assembly_gaps.cpp
  double find_gaps();
  double close_gaps(double most);
  double work_of_moves() const;
  bool is_open(const FlatJoint& joint) const;
  void take_velocities();
  void pay(double energy);
  void list_touching(std::pmr::vector<Island::Apart>& all) const;

  // assembly_energy.cpp
  struct Common {
    Vector2 center = Vector2::Zero();
    Vector velocity = Vector::Zero();
    double inertia = 0;  // about the center; 0 where the world holds the assembly
  };
  double motion_among();
  bool touches_only_fixed() const;
  bool pulled() const;
  double least_move() const;
  bool stops(double dt) const;
  bool driven() const;
  double own_rate(std::size_t index, std::span<const FlatPose> poses) const;
  void begin_works(std::span<const FlatPose> poses);
  void end_works(std::span<const FlatPose> poses, double part);
  double drive_work(double dt);
  double spring_work() const;
  void settle_energy(double began, double dt);
  double kinetic() const;
  double work_along_path(double h) const;
  bool held_by_world() const;
  Common common_motion() const;
  void keep_rotation(const Common& had);
  Vector carried(const Common& common, std::size_t link) const;
  double restore_energy(double energy);

  // assembly.cpp
  void put(std::size_t link);
  void keep(double dt);
  void keep_impulses(const Member& member);

  Core& core_;
  bool planned_ = false;
  std::pmr::vector<Link> links_;
  std::pmr::vector<Member> joints_;  // in the order of elimination
  JointSystem system_;
  std::pmr::vector<FlatPose> before_, after_;
  double work_ = 0;     // of gravity and forces in the sub-step, in Box2D's units
  double lost_ = 0;     // at limits, the same
  double torn_ = 0;     // in what contacts left and joints do not allow, the same
  double missing_ = 0;  // that could not be restored, the same
  std::pmr::vector<Vector> mobility_, velocities_, moves_, forces_, rates_;
};

}  // namespace breve
