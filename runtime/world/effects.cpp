// The names of the effects and the words in which each says why it is on.
#include "runtime/world/effects.hpp"

namespace breve {

namespace {

struct Words {
  std::string_view name, reason;
};

// KEEP IN STEP: order of EffectId.
constexpr std::array<Words, static_cast<std::size_t>(EffectId::kCount)> kWords{{
    {"motion", "a body has a velocity or an acceleration"},
    {"rotation", "a body has a rotational velocity or acceleration"},
    {"gravity", "a body is physics-enabled and gravity is not zero"},
    {"rigid", "a body is physics-enabled"},
    {"collision", "a collision handler names the classes of bodies"},
    {"time of impact", "a collision handler is called at the time of impact"},
    {"neighbors", "neighbors were updated"},
    {"schedule", "a call is scheduled"},
    {"notifications", "an object observes another"},
    {"script", "an instance iterates"},
    {"input", "the host queued input"},
    {"articulation", "a joint connects bodies"},
    {"joint limits", "a joint has a limit"},
    {"motors", "a joint has a motor with a strength"},
    {"springs", "a spring connects bodies or acts in a joint"},
    {"contact", "bodies moved by forces are near others"},
    {"friction", "touching bodies have friction"},
    {"restitution", "touching bodies rebound"},
    {"sleeping", "bodies at rest may sleep"},
    {"bounds", "space wraps or has walls along an axis"},
    {"energy ledger", "a body is physics-enabled: its energy is recorded"},
    {"patches", "a grid of cells was created"},
    {"diffusion", "quantities on a grid diffuse or react"},
    {"queries", "a host or a script asked where bodies are"},
    {"collision filters", "a body asks about each body near it, or lets bodies pass from some sides"},
    {"events", "contacts of some objects, or events such as births and deaths, are listed"},
}};

}  // namespace

Effects::Effects() {
  for (std::size_t i = 0; i < effects_.size(); ++i) {
    effects_[i].id = static_cast<EffectId>(i);
    effects_[i].name = kWords[i].name;
  }
}

void Effects::turn_on(EffectId id, std::uint64_t iteration, ObjectId asked_by) {
  Effect& effect = (*this)[id];
  if (effect.active) return;
  effect.active = true;
  effect.since = iteration;
  effect.asked_by = asked_by;
  effect.reason = kWords[static_cast<std::size_t>(id)].reason;
}

void Effects::turn_off(EffectId id) {
  Effect& effect = (*this)[id];
  effect.active = false;
  effect.since = 0;
  effect.asked_by = {};
  effect.reason = {};
}

void Effects::begin_step() {
  for (Effect& effect : effects_) {
    effect.items = 0;
    effect.calls = 0;
    effect.seconds = 0;
    effect.held = 0;
  }
}

namespace {

/// Who only looks at a world leaves no trace in its image.
bool only_looks(EffectId id) { return id == EffectId::Queries || id == EffectId::Events; }

}  // namespace

void Effects::save(ByteWriter& out) const {
  for (const Effect& effect : effects_) {
    if (only_looks(effect.id)) continue;
    out.put(effect.active);
    out.put(effect.since);
    out.put(effect.asked_by);
  }
}

void Effects::load(ByteReader& in) {
  for (Effect& effect : effects_) {
    if (only_looks(effect.id)) continue;
    const bool active = in.get_bool();
    const auto since = in.get<std::uint64_t>();
    const ObjectId asked_by = in.get_object();
    turn_off(effect.id);
    if (active) turn_on(effect.id, since, asked_by);
  }
}

}  // namespace breve
