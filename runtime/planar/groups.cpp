// Bodies that cannot meet within a sub-step are stepped apart where some of them need more than one step of Box2D:
// what bounces far away, or moves fast there, changes nothing of the rest, bit for bit. Impacts that call a handler are
// the exception: all bodies are stepped to that moment, since the handler sees them all.
#include <algorithm>
#include <utility>

#include "runtime/planar/core.hpp"
#include "runtime/planar/doors.hpp"

namespace breve {

/// For as long as it lives, nothing steps but what is chosen, of what stepped before.
class Planar::Core::Apart {
 public:
  template <class Chosen>
  Apart(Core& core, const Chosen& chosen) : core_(core), aside_(core.memory), awake_(core.awake) {
    aside_.reserve(core.slots.size());  // a body that is set apart must come back
    for (std::uint32_t slot = 0; slot < core.slots.size(); ++slot) {
      FlatBody& flat = core.slots[slot];
      if (flat.body == kNoBody || flat.set_apart || flat.b2->GetType() == b2_staticBody) continue;
      if (chosen(flat)) {
        any_ = true;
        continue;
      }
      aside_.push_back(slot);
      flat.set_apart = true;
      flat.steps_later = flat.b2->IsAwake();
      set_awake_flag(*flat.b2, false);
    }
    core.awake = core.count_awake();
  }
  ~Apart() {
    for (const std::uint32_t slot : aside_) {
      FlatBody& flat = core_.slots[slot];
      if (!flat.set_apart) continue;  // freed meanwhile
      flat.set_apart = false;
      if (flat.steps_later) set_awake_flag(*flat.b2, true);
    }
    core_.awake = awake_;
  }
  Apart(const Apart&) = delete;
  Apart& operator=(const Apart&) = delete;
  /// Whether anything steps.
  bool any() const { return any_; }

 private:
  Core& core_;
  std::pmr::vector<std::uint32_t> aside_;
  int awake_;
  bool any_ = false;
};

bool Planar::Core::steps(const b2Contact& contact) const {
  const auto set_apart = [this](const b2Fixture* fixture) { return of(fixture->GetBody()).set_apart; };
  return !set_apart(contact.GetFixtureA()) && !set_apart(contact.GetFixtureB());
}

bool Planar::Core::steps(BodyIndex a, BodyIndex b) const {
  const FlatBody *first = find(a), *second = find(b);
  return !(first && first->set_apart) && !(second && second->set_apart);
}

namespace {

/// Calls f for each shape whose box meets a box.
template <class F>
struct Finder : b2QueryCallback {
  const F& f;
  explicit Finder(const F& tell) : f(tell) {}
  bool ReportFixture(b2Fixture* fixture) override {
    f(fixture);
    return true;
  }
};

/// What a body may reach in dt, in whatever direction it rebounds, with room for slow bodies that come toward it.
b2AABB reach_of(const b2World& world, const b2Body& body, double dt) {
  const float way = body.GetLinearVelocity().Length() * static_cast<float>(dt) + b2_maxTranslation;
  b2AABB box;
  box.lowerBound = box.upperBound = body.GetWorldCenter();
  for (const b2Fixture* fixture = body.GetFixtureList(); fixture; fixture = fixture->GetNext())
    box.Combine(roomy_box(world, *fixture, 0));
  box.lowerBound -= b2Vec2(way, way);
  box.upperBound += b2Vec2(way, way);
  return box;
}

}  // namespace

/// Which bodies may meet in the coming dt, or act on each other: those that Box2D has a contact of, be it that they are
/// near, those that joints and springs connect, and what is so fast that Box2D has no contact of it yet.
void Planar::Core::number_groups(double dt) {
  for (std::uint32_t slot = 0; slot < slots.size(); ++slot) slots[slot].group = slot;
  const auto root = [this](std::uint32_t slot) {
    while (slots[slot].group != slot) slot = slots[slot].group = slots[slots[slot].group].group;
    return slot;
  };
  const auto unite = [&](const FlatBody* a, const FlatBody* b) {
    if (!a || !b || a->b2->GetType() == b2_staticBody || b->b2->GetType() == b2_staticBody) return;
    std::uint32_t first = root(slot_of[a->body]), second = root(slot_of[b->body]);
    if (slots[first].body > slots[second].body) std::swap(first, second);
    slots[second].group = first;
  };
  for (const b2Contact* contact = b2->GetContactList(); contact; contact = contact->GetNext())
    unite(&of(contact->GetFixtureA()->GetBody()), &of(contact->GetFixtureB()->GetBody()));
  for (const FlatJoint& joint : joints)
    if (joint.used) unite(find(joint.is.parent), find(joint.is.child));
  for (const FlatSpring& spring : springs)
    if (spring.used) unite(find(spring.is.a), find(spring.is.b));
  // Force methods may look at one another's bodies.
  for (const BodyIndex body : force_methods) unite(find(force_methods.front()), find(body));
  std::pmr::vector<std::pair<b2AABB, const FlatBody*>> fast(memory);
  for (const FlatBody& flat : slots) {
    if (flat.body == kNoBody || flat.fixed || !flat.b2->IsBullet() || !flat.b2->IsAwake()) continue;
    fast.emplace_back(reach_of(*b2, *flat.b2, dt), &flat);
    const auto tell = [&](b2Fixture* fixture) { unite(&flat, &of(fixture->GetBody())); };
    Finder finder(tell);
    b2->QueryAABB(&finder, fast.back().first);
  }
  constexpr std::size_t kMostPairs = 64;  // of more, not all pairs are looked at: they step together
  for (std::size_t i = 1; i < fast.size(); ++i)
    for (std::size_t k = 0; k < (fast.size() > kMostPairs ? 1 : i); ++k)
      if (fast.size() > kMostPairs || b2TestOverlap(fast[k].first, fast[i].first))
        unite(fast[k].second, fast[i].second);
  for (std::uint32_t slot = 0; slot < slots.size(); ++slot) slots[slot].group = root(slot);
}

/// A sub-step in which some bodies need shorter steps than others: all groups that need as many are stepped together.
void Planar::Core::step_pieces(double dt) {
  number_groups(dt);
  std::pmr::vector<int> needed(memory);  // by slot of a group
  needed.resize(slots.size(), 0);
  for (const FlatBody& flat : slots)
    if (flat.body != kNoBody) needed[flat.group] = std::max(needed[flat.group], flat.pieces);
  std::pmr::vector<int> own(memory), lengths(memory);  // by slot: groups are numbered anew while they step
  for (const FlatBody& flat : slots) {
    own.push_back(flat.body == kNoBody ? 0 : needed[flat.group]);
    if (flat.body != kNoBody) lengths.push_back(own.back());
  }
  std::sort(lengths.begin(), lengths.end());
  lengths.erase(std::unique(lengths.begin(), lengths.end()), lengths.end());
  const float before = last_step;
  const double start = now;
  for (const int pieces : lengths) {
    const Apart apart(*this, [&](const FlatBody& flat) {
      const auto slot = static_cast<std::size_t>(&flat - slots.data());
      return slot < own.size() && own[slot] == pieces;
    });
    if (!apart.any()) continue;
    last_step = before;
    for (int k = 0; k < pieces && !spoiled; ++k) {
      now = start + k * (dt / pieces);
      if (k > 0 && worn()) {
        rush((pieces - k) * (dt / pieces));
        break;
      }
      step_meeting(dt / pieces);
    }
    end_cuts(dt);
  }
  last_step = static_cast<float>(dt);
  now = start + dt;
}

/// A sub-step of what steps: what rebounds in flight takes it apart from all else.
void Planar::Core::step_meeting(double dt) {
  step_length = dt;
  const std::pmr::vector<Unfinished> unfinished = take_flights(dt);
  if (std::none_of(slots.begin(), slots.end(), [](const FlatBody& flat) { return flat.flown; })) return step_groups(dt);
  const float before = last_step;
  const double start = now;
  for (const auto& [left, bodies_left] : unfinished) {
    const Apart apart(*this, [&all = bodies_left](const FlatBody& flat) {
      return std::find(all.begin(), all.end(), flat.body) != all.end();
    });
    last_step = before;
    now = start + dt - left;
    step(left);
    end_cuts(dt);
  }
  last_step = before;
  now = start;
  const Apart rest(*this, [](const FlatBody& flat) { return !flat.flown; });
  step_groups(dt);
}

/// A sub-step of what steps: each group in which something bounces is cut there by itself, all others take it at once.
void Planar::Core::step_groups(double dt) {
  step_length = dt;
  located = 0;
  const std::pmr::vector<BodyIndex> meets = meeting(dt);
  if (meets.empty()) {
    step(dt);
    now += dt;
    return;
  }
  number_groups(dt);
  const float before = last_step;
  const double start = now;
  std::pmr::vector<std::uint32_t> done(memory);
  const auto is_done = [&done](const FlatBody& flat) {
    return std::find(done.begin(), done.end(), flat.group) != done.end();
  };
  // A step of Box2D looks at each body, though it moves some. Where very many bounce at once, the last are met late.
  constexpr std::uint64_t kMostLooks = 512, kLooksAGlance = 16;
  for (const BodyIndex body : meets) {
    const FlatBody& first = *find(body);
    if (is_done(first)) continue;
    if (looks > kMostLooks) break;
    const std::uint32_t group = first.group;
    const Apart apart(*this, [group](const FlatBody& flat) { return flat.group == group; });
    const std::uint64_t steps_before = counters.sub_steps;
    last_step = before;
    now = start;
    run(dt, false);
    looks += (counters.sub_steps - steps_before) * (static_cast<std::uint64_t>(awake) + slots.size() / kLooksAGlance);
    done.push_back(group);
  }
  last_step = before;
  now = start;
  if (const Apart rest(*this, [&](const FlatBody& flat) { return !is_done(flat); }); rest.any()) step(dt);
  last_step = static_cast<float>(dt);
  now = start + dt;
}

/// What came near while it did not step: Box2D does not look for it again by itself.
void Planar::Core::make_missed_contacts() {
  if (!std::exchange(any_missed, false)) return;
  for (FlatBody& flat : slots) {
    if (!std::exchange(flat.missed, false) || flat.body == kNoBody) continue;
    for (b2Fixture* fixture = flat.b2->GetFixtureList(); fixture; fixture = fixture->GetNext()) fixture->Refilter();
  }
  make_contacts();
}

}  // namespace breve
