// Which effects a scene calls for, why, who asked, and what each cost: the ledger behind "only what the scene needs".
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/base/bytes.hpp"
#include "runtime/base/ids.hpp"

namespace breve {

enum class EffectId : std::uint8_t {
  Motion,
  Rotation,
  Gravity,
  Rigid,
  Collision,
  TimeOfImpact,
  Neighbors,
  Schedule,
  Notifications,
  Script,
  Input,
  Articulation,
  JointLimits,
  Motors,
  Springs,
  Contact,
  Friction,
  Restitution,
  Sleeping,
  Bounds,
  EnergyLedger,
  Patches,
  Diffusion,
  Queries,
  Filters,
  Events,
  kCount
};

struct Effect {
  EffectId id{};
  std::string_view name;
  bool active = false;
  std::uint64_t since = 0;  // iteration at which it became active
  ObjectId asked_by;        // the first object that called for it; null: the world itself
  std::string_view reason;  // in words: "a body has a velocity"
  std::uint64_t items = 0;  // in the last step
  std::uint64_t calls = 0;  // in the last step
  std::uint64_t bytes = 0;  // owned now
  std::uint64_t held = 0;   // in the last step: bodies that met more impacts than a sub-step handles and were held
  double seconds = 0;       // in the last step
};

class Effects {
 public:
  Effects();
  const std::array<Effect, static_cast<std::size_t>(EffectId::kCount)>& all() const { return effects_; }
  Effect& operator[](EffectId id) { return effects_[static_cast<std::size_t>(id)]; }
  const Effect& operator[](EffectId id) const { return effects_[static_cast<std::size_t>(id)]; }

  /// From now on the scene calls for it; the first to ask is remembered. Does nothing if it is already on.
  void turn_on(EffectId id, std::uint64_t iteration, ObjectId asked_by);
  void turn_off(EffectId id);
  void begin_step();  // the counters of the last step start again

  // What a snapshot keeps: who asked for what, and when. Counters are of one step only.
  void save(ByteWriter& out) const;
  void load(ByteReader& in);

 private:
  std::array<Effect, static_cast<std::size_t>(EffectId::kCount)> effects_;
};

}  // namespace breve
