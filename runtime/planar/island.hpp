// Bodies of a flat world that touch or are joined, solved together for one sub-step as runtime/contact solves them.
#pragma once

#include <functional>
#include <memory>

#include "runtime/contact/solver.hpp"
#include "runtime/planar/response.hpp"

namespace breve {

/// Velocities of bodies that are moved by hand, where joints close loops. Bodies that go back all together do not go on
/// where they came from: links in one line may all move across it, as far as velocities tell, and are brought back in
/// each sub-step since they do not reach so far. Their speed would grow meanwhile.
class MovedBack {
 public:
  /// @param move  of its centre, length units, and its rotation
  void add(const FlatBody& flat, const Vector3& move) {
    const Vector3 momentum = weight_of(flat).cwiseProduct(move);
    along_ += momentum.dot(velocity_of(flat));
    square_ += momentum.dot(move);
    looped_ = looped_ || flat.looped;
  }
  /// After all were added: takes from a body's velocity what goes the other way.
  void stop(const FlatBody& flat, const Vector3& move) const {
    if (!looped_ || !(along_ < 0 && square_ > 0)) return;
    const Vector3 v = velocity_of(flat) - along_ / square_ * move;
    flat.b2->SetLinearVelocity(b2Vec2(static_cast<float>(v[0]), static_cast<float>(v[1])));
    flat.b2->SetAngularVelocity(static_cast<float>(v[2]));
  }

 private:
  static Vector3 weight_of(const FlatBody& flat) {
    return {double{flat.b2->GetMass()}, double{flat.b2->GetMass()}, Response::inertia(flat)};
  }
  static Vector3 velocity_of(const FlatBody& flat) {
    const b2Vec2 v = flat.b2->GetLinearVelocity();
    return {double{v.x}, double{v.y}, double{flat.b2->GetAngularVelocity()}};
  }

  double along_ = 0, square_ = 0;
  bool looped_ = false;
};

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
