// A body is going: what a flat world knows of it goes with it.
#include <algorithm>

#include "runtime/planar/core.hpp"

namespace breve {

void Planar::Core::forget(BodyIndex body) {
  if (const auto found = joints_at.find(body); found != joints_at.end()) {
    const std::pmr::vector<JointIndex> held_by(found->second, memory);
    for (const JointIndex index : held_by) {
      detach(index);
      joints[index] = FlatJoint();
      free_joints.push_back(index);
    }
  }
  for (SpringIndex i = 0; i < springs.size(); ++i)
    if (springs[i].used && (springs[i].is.a == body || springs[i].is.b == body)) {
      wake_ends(springs[i]);
      springs[i] = FlatSpring();
      free_springs.push_back(i);
    }
  const bool known = body < slot_of.size() && slot_of[body] != kNoSlot;
  if (known) remove_member(slot_of[body]);
  own.erase(body);
  std::erase(force_methods, body);
  std::erase_if(met, [body](const auto& one) { return one.first.first == body || one.first.second == body; });
  if (!frozen) return;
  const auto gone = [body](const FrozenBody& one) { return one.body == body; };
  if (!known && std::any_of(frozen->bodies.begin(), frozen->bodies.end(), gone)) base -= energy_of(body);
  for (const FrozenContact& one : frozen->contacts)
    if (one.touching && (one.key.a == body || one.key.b == body)) wake(one.key.a == body ? one.key.b : one.key.a);
  std::erase_if(frozen->bodies, gone);
  std::erase_if(frozen->boxes, [body](const FrozenBox& one) { return one.body == body; });
  std::erase_if(frozen->contacts, [body](const FrozenContact& one) { return one.key.a == body || one.key.b == body; });
}

}  // namespace breve
