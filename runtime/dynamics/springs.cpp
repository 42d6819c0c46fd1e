// The table of springs between bodies.
#include "runtime/dynamics/core.hpp"

namespace breve {

SpringEntry& Dynamics::Core::spring_at(SpringIndex spring) {
  if (spring >= springs.size() || !springs[spring].used) fail_no_spring();
  return springs[spring];
}

SpringIndex Dynamics::add_spring(const SpringDescription& description, ObjectId owner) {
  check(description);
  check_ends(description, *bodies_);
  if (description.a == description.b) return kNoSpring;
  Core& c = core();
  c.sync_changes();
  reserve_free(c.springs, c.free_springs);
  c.entry(description.a);
  c.entry(description.b);
  const SpringIndex index = take_slot(c.springs, c.free_springs);
  c.springs[index].used = true;
  c.springs[index].owner = owner;
  c.springs[index].is = description;
  // Connecting bodies that move stretches the spring.
  c.springs[index].booked = c.known_to_books(description.a) || c.known_to_books(description.b) ? 0 : kNoBook;
  for (const BodyIndex end : {description.a, description.b}) {
    ++c.entry(end).springs;
    c.near.wake(end);
    if (c.entry(end).tree == kNone) c.graph_changed = true;
  }
  c.clusters_changed = true;
  return index;
}

void Dynamics::remove_spring(SpringIndex spring) {
  Core& c = core();
  const SpringDescription& is = c.spring_at(spring).is;
  for (const BodyIndex end : {is.a, is.b}) {
    --c.entry(end).springs;
    c.near.wake(end);
    // A free body needs no tree any more.
    if (!c.needs_tree(end) && c.entry(end).tree != kNone) c.drop_tree(c.entry(end).tree);
  }
  if (in_books(c.springs[spring].booked)) c.ledger.script_work -= c.springs[spring].booked;
  c.springs[spring] = SpringEntry();
  c.free_springs.push_back(spring);
  c.clusters_changed = true;
}

const SpringRecord* Dynamics::spring_record(SpringIndex spring) const {
  return core_ && spring < core_->springs.size() && core_->springs[spring].used ? &core_->springs[spring] : nullptr;
}

void Dynamics::set_spring(SpringIndex spring, const SpringDescription& description) {
  check(description);
  SpringEntry& entry = core().spring_at(spring);
  const BodyIndex a = entry.is.a, b = entry.is.b;
  entry.is = description;
  entry.is.a = a;
  entry.is.b = b;
  entry.set = true;
  ++core_->springs_version;
  for (const BodyIndex end : {a, b}) core_->near.wake(end);
}

}  // namespace breve
