// A tree of bodies that joints connect: its articulated model, its state, and which body and joint each link is.
#pragma once

#include <algorithm>
#include <limits>
#include <memory_resource>
#include <vector>

#include "runtime/articulated/data.hpp"
#include "runtime/articulated/loads.hpp"
#include "runtime/articulated/system.hpp"
#include "runtime/articulated/whole.hpp"
#include "runtime/base/memory.hpp"
#include "runtime/kinematics/bodies.hpp"
#include "runtime/mechanics/joint.hpp"
#include "runtime/mechanics/ledger.hpp"
#include "runtime/solid/contact.hpp"

namespace breve {

/// Where a link's own frame (on its inboard joint) lies in its body's frame. The axes are the body's.
struct TreeLink {
  BodyIndex body = kNoBody;
  JointIndex joint = kNoJoint;                                // kNoJoint: the free joint of a root
  Vector3 origin = Vector3::Zero();                           // of the link's frame, in the body's frame
  MassProperties solid;                                       // that the model was made of
  std::uint32_t switches = 0;                                 // of its body's physics, as the model was made
  Vector3 force = Vector3::Zero(), torque = Vector3::Zero();  // set by scripts, as the step began
  Vector3 asked = Vector3::Zero();                            // by its force method, at the last stage
  Vector3 pushed_center = Vector3::Zero();                    // its centre of mass and its orientation, from which
  Quaternion pushed_orientation = Quaternion::Identity();     // on scripts' forces work along what rows move
  articulated::Wrench contact;                                // of contacts in the last sub-step, about its centre
  articulated::Wrench predicted;                              // likewise, of contacts that are taken to go on
  articulated::Wrench pressed;                                // likewise, of contact springs at this stage
  bool slow_spring = false;                                   // its joint's spring is slower than the step
  double slow_damping = 0;                                    // of that, if it is
  bool motor = false;                                         // its joint has one
  bool behind_light = false;  // on its way from the root, one link is far heavier than one before it
  double gain_unit = 0;       // effective inertia of the joint's motor as the tree was built, kg or kg*m^2
};

/// A body that does not move by itself and holds the tree, and where it stood when the tree was built.
struct TreeAnchor {
  BodyIndex body = kNoBody;
  Pose pose;
};

/// Bytes that Eigen and the articulated algorithms take from C++'s allocator, held as a block of the world's memory of
/// the same size: so that a limit on that memory bounds them.
class Reservation {
 public:
  Reservation(std::pmr::memory_resource* memory, std::size_t bytes)
      : memory_(memory), bytes_(bytes), block_(memory->allocate(bytes)) {}
  ~Reservation() { memory_->deallocate(block_, bytes_); }
  Reservation(const Reservation&) = delete;
  Reservation& operator=(const Reservation&) = delete;
  std::size_t bytes() const { return bytes_; }

 private:
  std::pmr::memory_resource* memory_;
  std::size_t bytes_;
  void* block_;
};

inline constexpr int kMostLoopRows = 6;  // of one joint
inline constexpr int kMostUnheld = 50;   // sub-steps, see Tree::unheld

/// A limit that its joint is near, as it acts inside the stages of a sub-step.
struct HeldLimit {
  JointIndex joint;
  int axis;
  double sign;        // the joint may move along sign * position
  double limit;       // the position, rad or m
  bool holds = true;  // it pushed at the last stage
};

struct Tree : InMemory {
  Tree(std::pmr::memory_resource* memory, const std::vector<articulated::Link>& description);

  /// Units of work to hold loops and limits once, as Core::hold does.
  std::uint64_t hold_units() const;

  Reservation reserved;
  articulated::Model model;
  articulated::Data data;
  articulated::State state;
  articulated::Loads loads;
  articulated::Loads springs;  // stiffness and damping of the drives in `loads`, and nothing else
  std::pmr::vector<TreeLink> links;
  std::pmr::vector<JointIndex> loops;  // joints within the tree (or to the world) that are constraints
  std::pmr::vector<HeldLimit> held;    // limits that act inside the stages of this sub-step
  double hold_time = 0;                // s, in which they bring joints to rest
  // The rows of loops, then of limits that are held: workspace; forces along them, at the last stage.
  std::pmr::vector<double> row_numbers, row_forces;
  std::pmr::vector<int> row_order;
  bool anchored = false;  // held by the world
  bool loose = false;     // it has a free root, and no joint connects it with what does not move by itself
  std::pmr::vector<TreeAnchor> anchors;
  std::pmr::vector<BodyIndex> loop_holders;  // bodies that do not move by themselves, at which loops end
  double step = 0;                           // s, that step control would try next
  int unheld = 0;  // sub-steps for which the loops are still left to the rows: the stages took too long for them
  articulated::Vector mean;     // (nv) acceleration in the last smooth motion: there the next one's search begins
  int slot = -1;                // in its island
  bool driven = false;          // some joint has a motor, a damper or a force
  bool aimed = false;           // some of that depends on where joints are
  bool pushed = false;          // some link has a force or torque set
  articulated::Vector set_tau;  // (nv) of loads.tau, what scripts set
  articulated::Vector work_q, work_v, work_u, work_w;
  Energy ledger;  // works and losses since it was made
  // An island's, kept here so that a step allocates nothing.
  articulated::State step_state, sub_state;  // as the step, the sub-step began
  articulated::State part_state;             // likewise, at the start of smooth motion
  articulated::Vector reacted;               // (nv) what Loads::reaction gives in a second
  bool braced = false;                       // contacts act on its links inside the stages, as wrenches
  articulated::Vector free_v, way, kick;     // v without the rows' impulses; the way they make
  double row_share = 1;                      // of that way: the part that is gone
  bool carried = false;                      // links keep their momenta along it
  articulated::Vector push;                  // v by which overlap is moved apart, for a sub-step
  articulated::Vector smooth_v;              // v after smooth motion, to which reactions belong
  Vector3 outer_force = Vector3::Zero();     // N, of these reactions from outside
  Vector3 outer_couple = Vector3::Zero();    // N*m, likewise, about row_center
  articulated::Vector limit_force;           // (nv) of the joints' limits in the last sub-step
  articulated::Vector held_force;            // (nv) of those that are held, at the last stage
  articulated::Vector part_impulse;          // (nv) of motors, in the last part of smooth motion, N*s or N*m*s
  articulated::Vector motor_impulse;         // likewise, in all of it
  articulated::Whole whole;                  // without the impulses of the rows
  Vector3 row_center = Vector3::Zero();      // centre of mass where the rows were made
  Energy step_ledger, sub_ledger;            // as the step, the sub-step began
  double step_stored = 0;                    // J, likewise
  double step_kinetic = 0;                   // J, likewise
  double booked = std::numeric_limits<double>::quiet_NaN();  // J, that it has by the books
  bool changed = true;                                       // by scripts since
  double owed = 0;        // J, that contacts and limits of its island gave and no motion of links has repaid yet
  double fastest = 0;     // J, the largest energy of motion with which a step began
  double credit = 0;      // J, that contacts took and may give back by lifting links out of overlaps
  bool set_apart = true;  // scripts have placed links since nothing overlapped: the overlaps are theirs
  // How far its loops stood open, rad or length units, as the last step began, where scripts left them open; 0: the
  // gaps are the solver's.
  double set_open = JointDrive::kNoLimit;

  BodyIndex first_body() const {  // of the lowest index
    BodyIndex first = kNoBody;
    for (const TreeLink& link : links) first = std::min(first, link.body);
    return first;
  }
  /// Mass, centre and momenta; and the energy of motion, J. Links are placed for them.
  const articulated::Whole& measured();
  double kinetic();
  bool has_light() const {
    return std::any_of(links.begin(), links.end(), [](const TreeLink& link) { return link.behind_light; });
  }
  void reserve_rows();  // once `loops` and `held` are known
  /// The pose of the body of a link, after forward_kinematics.
  Pose pose(int link) const;
  Vector3 velocity(int link) const;  // of the body's origin, m/s, world

 private:
  // Sums over the links, and Data::standing() as they were made.
  articulated::Whole measured_;
  double kinetic_ = 0;
  std::uint64_t measured_at_ = 0, kinetic_at_ = 0;
};

}  // namespace breve
