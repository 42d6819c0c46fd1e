// Bodies of a flat world that touch or are joined, solved together for one sub-step as runtime/contact solves them.
#pragma once

#include <functional>
#include <memory>

#include "runtime/contact/solver.hpp"
#include "runtime/planar/response.hpp"

namespace breve {

/// All that touches and all that joints connect with it, from one body on; in Box2D's units. What joints connect moves
/// as a whole, so that the solver has rows for contacts, limits and motors alone.
class Planar::Core::Island {
 public:
  Island(Core& core, double dt) : core_(core), dt_(dt), arena_(core.memory), workspace_(core.memory) {}

  /// All that can be reached from a body; it is marked as gathered.
  void gather(FlatBody& first);
  /// Velocities and impulses become those of an impact, and of the forces of the sub-step after it. Nothing where
  /// joints connect more than can answer as a whole.
  void solve();
  /// A contact, and how far apart its points were before its bodies were moved, length units.
  struct Apart {
    b2Contact* contact;
    float separations[b2_maxManifoldPoints];
    /// By addresses, so that a contact is found: nothing depends on this order.
    static bool sooner(const Apart& a, const Apart& b) { return std::less<>()(a.contact, b.contact); }
  };
  /// Moves bodies so that none of their contacts overlaps deeper than it did; joints stay as open as they are.
  /// @param before  sorted by `sooner`; of several with one contact the first counts
  void keep_apart(std::span<const Apart> before);

 private:
  template <class T>
  using List = std::pmr::vector<T>;
  /// A body, or what joints connect.
  struct Part {
    FlatBody* first;                     // of all that it is
    std::unique_ptr<Response> response;  // null: a body without joints
    std::span<double> v;                 // as its mover has it
  };
  /// A motor, or a limit that the joint may reach in this sub-step.
  struct Drive {
    FlatJoint* joint;
    float WarmJoint::*warm;  // which of the joint's impulses it is
    double sign;             // of that impulse
    bool motor;              // acts over time, and not in an impact
    double bias, lo, hi;
  };
  void add_body(FlatBody& flat);
  void add_joints(const FlatBody& flat);
  std::span<double> numbers(std::size_t count);
  bool make_parts();
  void take_velocities();
  Part& part_of(const FlatBody& flat) { return parts_[flat.part]; }
  int driver(const FlatBody& flat);
  Response::Vector load_of(const FlatBody& flat, const Vector2& arm, const Vector2& along, double rotation);
  void add_side(contact::Row& row, bool first, const FlatBody& flat, const b2Vec2& point);
  void add_matrices(contact::Row& row, const FlatBody* a, const FlatBody* b, const b2Vec2& point);
  void make_contact_rows();
  void add_drives(FlatJoint& joint);
  template <class Joint>
  void add_drives(FlatJoint& joint, const Joint& b);
  void add_drive_row(const Drive& drive);
  void add_forces();
  void solve_rows(bool impact);
  void solve(double tolerance);
  Response::Vector forces_on(const Part& part) const;
  void book_drivers(double sign);
  void write_bodies();
  void write_contacts();
  void write_joints();
  void aim_apart(std::span<const Apart> before);
  Vector3 move_of(const FlatBody& flat);

  Core& core_;
  double dt_;
  std::pmr::monotonic_buffer_resource arena_;  // numbers of velocities and rows
  List<FlatBody*> bodies_{&arena_};            // that move by themselves, by index
  List<b2Contact*> contacts_{&arena_};         // by what touches
  List<FlatJoint*> joints_{&arena_};           // in the order of creation
  List<Part> parts_{&arena_};
  List<contact::Mover> movers_{&arena_};  // of parts_, then what scripts move: one for each contact with such
  List<contact::Row> rows_{&arena_};      // of contacts_, as many as each has points
  List<Drive> drives_{&arena_};
  List<contact::ScalarRow> scalars_{&arena_};  // of drives_
  contact::Workspace workspace_;
};

}  // namespace breve
