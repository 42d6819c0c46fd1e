// What Box2D takes is held before. Where many bodies were put into one place, it pairs what overlaps them at its next
// step, all at once.
#include <fmt/format.h>

#include "runtime/base/error.hpp"
#include "runtime/planar/core.hpp"
#include "runtime/planar/doors.hpp"

namespace breve {

namespace {

/// Counts fixtures whose roomy boxes meet a box.
class Overlaps : public b2QueryCallback {
 public:
  /// @param self  has none with itself, nor with those that were put somewhere and stand before it: they have counted
  Overlaps(Planar::Core& core, FlatBody& self) : core_(core), self_(self) {
    for (b2Fixture* fixture = self.b2->GetFixtureList(); fixture; fixture = fixture->GetNext())
      for (int32 child = 0; child < fixture->GetShape()->GetChildCount(); ++child)
        core.b2->QueryAABB(this, roomy_box(*core.b2, *fixture, child));
  }
  bool ReportFixture(b2Fixture* fixture) override {
    FlatBody* other = core_.find(core_.of(fixture->GetBody()).body);
    if (!other || other == &self_ || (other->placed && other < &self_)) return true;
    ++pairs;
    contacts += !(self_.fixed && other->fixed);
    return pairs < kMostPairs;
  }

  static constexpr std::size_t kMostPairs = std::size_t{1} << 26;  // in one step: its counts are 32 bits wide
  std::size_t pairs = 0, contacts = 0;

 private:
  Planar::Core& core_;
  FlatBody& self_;
};

}  // namespace

/// Bytes for Box2D with the bodies, joints and contacts that there are.
std::size_t Planar::Core::expected_bytes() const {
  const auto contacts = static_cast<std::size_t>(b2->GetContactCount());
  const auto count = static_cast<std::size_t>(b2->GetBodyCount());
  const auto joined = static_cast<std::size_t>(b2->GetJointCount());
  // Contacts are made inside of a step: there is room for twice as many, and for some on each body.
  return kPerWorld + count * (kPerBody + 4 * kPerContact) + 2 * contacts * kPerContact + joined * kPerJoint;
}

void Planar::Core::note_placed(FlatBody& flat) {
  placed += flat.placed ? 0 : 1;
  flat.placed = true;
}

/// Holds the memory that the next step of Box2D takes for new pairs, and counts their work before it is done.
/// Error{Memory}: more pairs than Box2D can count. Error{Budget}: more work than the step may take, if it is bounded.
void Planar::Core::expect_pairs(const WorkBound& most) {
  constexpr std::size_t kFew = 64;  // placed bodies: what they take is held for each body anyway
  if (placed <= kFew) return all_paired();
  std::size_t pairs = 0, contacts = 0;
  double looks = 0;  // at contacts that a body has already, one by one for each new one
  for (FlatBody& flat : slots) {
    if (flat.body == kNoBody || !flat.placed) continue;
    most.poll();
    const Overlaps one(*this, flat);
    pairs += one.pairs;
    contacts += one.contacts;
    looks += static_cast<double>(one.contacts) * static_cast<double>(one.contacts) / 2;
    if (pairs >= Overlaps::kMostPairs)
      throw Error(ErrorCode::Memory, fmt::format("more than {} pairs of flat shapes overlap at their positions; move "
                                                 "the bodies apart",
                                                 Overlaps::kMostPairs));
    held.hold(expected_bytes() + pairs * kPerPair + contacts * kPerContact);
  }
  constexpr double kUnitsAPair = 20, kLooksAUnit = 100;
  constexpr std::uint64_t kUsual = 1'000'000;  // a budget that is less makes steps coarse and does not refuse them
  const std::uint64_t may = std::max(most.most, kUsual);
  const double work = static_cast<double>(pairs) * kUnitsAPair + looks / kLooksAUnit;
  const double left = may > counters.work ? static_cast<double>(may - counters.work) : 0;
  if (most.most > 0 && work > left)
    throw Error(
        ErrorCode::Budget,
        fmt::format("{} pairs of flat shapes overlap at their positions: processing them exceeds the rest of the "
                    "physics budget of {} (breve_world_config.physics_budget, --physics-budget); move "
                    "the bodies apart",
                    pairs, may));
  counters.work += static_cast<std::uint64_t>(work);
  all_paired();
}

void Planar::Core::all_paired() {
  if (placed == 0) return;
  placed = 0;
  for (FlatBody& flat : slots) flat.placed = false;
}

}  // namespace breve
