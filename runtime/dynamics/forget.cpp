// What becomes of a body's joints, springs and entries when it goes.
#include <algorithm>

#include "runtime/dynamics/island.hpp"

namespace breve {

void Dynamics::Core::forget(BodyIndex body) {
  BodyEntry& known = *find(body);
  if (known.tree != kNone) drop_tree(known.tree);
  while (!known.joints.empty()) {
    const JointIndex joint = known.joints.back();
    detach(joint);
    joints[joint] = JointEntry();
    free_joints.push_back(joint);
  }
  for (SpringIndex i = 0; known.springs > 0 && i < springs.size(); ++i) {
    if (!springs[i].used || (springs[i].is.a != body && springs[i].is.b != body)) continue;
    for (const BodyIndex end : {springs[i].is.a, springs[i].is.b}) {
      BodyEntry& one = *find(end);
      --one.springs;
      near.wake(end);
      if (!needs_tree(end) && one.tree != kNone) drop_tree(one.tree);
    }
    if (in_books(springs[i].booked)) ledger.script_work -= springs[i].booked;
    springs[i] = SpringEntry();
    free_springs.push_back(i);
    clusters_changed = true;
  }
  near.forget(body);
  if (body < booked.size()) booked[body] = kNoBook;
  own.erase(body);
  const std::uint32_t index = entry_of[body];
  entry_of[body] = kNone;
  entries[index] = BodyEntry(memory);
  free_entries.push_back(index);
}

}  // namespace breve
