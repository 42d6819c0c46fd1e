// What the world asks of whatever scripts its agents. The runtime knows no language: this is its whole view of one.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "runtime/base/bytes.hpp"
#include "runtime/base/hasher.hpp"
#include "runtime/base/ids.hpp"
#include "runtime/base/math.hpp"

namespace breve {

/// Input that the host queued; delivered at the start of the next step, in the order of arrival.
struct InputEvent {
  enum class Kind : std::uint8_t { KeyDown, KeyUp, Click, Menu } kind = Kind::KeyDown;
  std::string key;  // one character, or "up", "down", "left", "right"
  ObjectId object;  // Click: the object hit or null. Menu: the menu item
};

/// What becomes of a class when the script side replaces its program.
struct ClassChange {
  ClassId to = kNoClass;  // kNoClass: it is gone
  bool iterates = false, post_iterates = false;
};

/// Every call may run script code and may throw breve::Error{Script, Budget, Depth, Memory}.
class Behaviour {
 public:
  virtual ~Behaviour() = default;

  virtual void iterate(ObjectId agent) = 0;
  virtual void post_iterate(ObjectId agent) = 0;
  /// A scheduled call is due. The clock reads the scheduled time.
  virtual void scheduled(ObjectId agent, std::string_view method) = 0;
  /// `agent` has a handler `method` for this contact. `normal` is a unit vector from `other` toward `agent`.
  /// Returns true if the remaining handlers of this contact are to be skipped.
  virtual bool collided(ObjectId agent, ObjectId other, std::string_view method, const Vector3& point,
                        const Vector3& normal) = 0;
  virtual void notified(ObjectId observer, std::string_view method, ObjectId announcer, std::string_view message) = 0;
  virtual void input(const InputEvent& event) = 0;
  /// The force method of `agent` is asked for a force, N, world axes. Poses and velocities are those of a stage of the
  /// integrator, which may be tried again: making, freeing and joining objects and printing are errors there, and
  /// numbers drawn at random are to follow from `draw` alone.
  virtual Vector3 stage_force(ObjectId agent, double time, std::uint64_t draw) {
    static_cast<void>(agent);
    static_cast<void>(time);
    static_cast<void>(draw);
    return Vector3::Zero();
  }
  /// May `agent`, which asked for this question, collide with `other`? Asked once while the two are near each other.
  virtual bool may_collide(ObjectId agent, ObjectId other) {
    static_cast<void>(agent);
    static_cast<void>(other);
    return true;
  }
  /// The world begins so much work of its own for the agents (units of about a loop iteration, see Meter): it counts as
  /// theirs. Throws if they may not use so much, or if the host wants the end.
  virtual void charge(std::uint64_t units) = 0;
  /// The same, and nothing is counted.
  virtual void expect(std::uint64_t units) = 0;
  /// The last act of an iteration: a slice of garbage collection.
  virtual void end_of_iteration() = 0;

  /// Snapshot of the whole script side: heap, variables, serial numbers. Called between iterations only.
  virtual void save(ByteWriter& out) const = 0;
  /// The world's objects are those of the image by now. What `save` wrote is the last in it. Nothing of the script side
  /// changes before the whole rest was read and found good; nothing fails afterwards.
  /// @throws Error{Image} if the rest is not what `save` writes of such objects, to its last byte
  virtual void load(ByteReader& in) = 0;
  virtual void hash(Hasher& hasher) const = 0;
};

}  // namespace breve
