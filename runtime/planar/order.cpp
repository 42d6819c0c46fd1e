// The order in which Box2D solves. Left alone, it solves bodies and joints in the order in which they were made, and
// contacts in that in which its tree, which all bodies share, has found them. Here the order is that of the indices of
// bodies and of the serial numbers of joints, whatever happened before or elsewhere: so a world that was restored, or
// that has something far away, goes on as it would without.
#include <algorithm>
#include <cmath>
#include <utility>

#include "runtime/planar/core.hpp"
#include "runtime/planar/doors.hpp"

namespace breve {

ContactKey Planar::Core::key_of(const b2Contact& contact, bool& swapped) const {
  const b2Fixture *a = contact.GetFixtureA(), *b = contact.GetFixtureB();
  ContactKey key{of(a->GetBody()).body,
                 of(b->GetBody()).body,
                 number_of(a),
                 number_of(b),
                 static_cast<std::uint32_t>(contact.GetChildIndexA()),
                 static_cast<std::uint32_t>(contact.GetChildIndexB())};
  swapped = key.b < key.a;
  if (swapped) {
    std::swap(key.a, key.b);
    std::swap(key.fixture_a, key.fixture_b);
    std::swap(key.child_a, key.child_b);
  }
  return key;
}

ContactKey Planar::Core::key_of(const b2Contact& contact) const {
  bool swapped = false;
  return key_of(contact, swapped);
}

/// Bodies in the order of their indices in the slots, and the other way round in Box2D's list, where the last comes
/// first.
void Planar::Core::order_bodies() {
  BodyIndex last = 0;
  bool ordered = true;
  for (const FlatBody& flat : slots) {
    if (flat.body == kNoBody) continue;
    ordered = ordered && last <= flat.body;
    last = flat.body;
  }
  if (!ordered) order_slots();
  BodyIndex next = kNoBody;
  for (const b2Body* body = b2->GetBodyList(); body && ordered; body = body->GetNext()) {
    if (!is_body(body)) continue;
    ordered = of(body).body < next;
    next = of(body).body;
  }
  if (ordered) return;
  std::pmr::vector<b2Body*> all(memory);
  for (auto flat = slots.rbegin(); flat != slots.rend(); ++flat)
    if (flat->body != kNoBody) all.push_back(flat->b2);
  all.push_back(ground);
  set_body_list(*b2, all);
}

void Planar::Core::order_slots() {
  slots.erase(std::remove_if(slots.begin(), slots.end(), [](const FlatBody& flat) { return flat.body == kNoBody; }),
              slots.end());
  std::sort(slots.begin(), slots.end(), [](const FlatBody& p, const FlatBody& q) { return p.body < q.body; });
  free_slots.clear();
  for (std::uint32_t slot = 0; slot < slots.size(); ++slot) {
    slot_of[slots[slot].body] = slot;
    slots[slot].b2->GetUserData().pointer = slot + 1;
  }
}

/// Joints of each body, the last that was made first.
void Planar::Core::order_joints() {
  if (!std::exchange(joints_made, false)) return;
  std::pmr::vector<std::pair<std::uint64_t, b2JointEdge*>> edges(memory);
  std::pmr::vector<b2JointEdge*> list(memory);
  const auto serial_of = [this](const b2JointEdge* edge) {
    return joints[const_cast<b2Joint*>(edge->joint)->GetUserData().pointer].serial;
  };
  for (FlatBody& flat : slots) {
    if (flat.body == kNoBody || !flat.b2->GetJointList()) continue;
    edges.clear();
    for (b2JointEdge* edge = flat.b2->GetJointList(); edge; edge = edge->next)
      edges.emplace_back(serial_of(edge), edge);
    std::sort(edges.begin(), edges.end(), [](const auto& p, const auto& q) { return p.first > q.first; });
    list.clear();
    for (const auto& [serial, edge] : edges) list.push_back(edge);
    set_joint_list(*flat.b2, list);
  }
}

/// Makes room for the coming dt where a fast body leaves its roomy box: Box2D does so at the end of a step, and what it
/// finds then it solves at once if it would pass through, in the order in which its tree gave it.
void Planar::Core::make_room(double dt) {
  constexpr float kSlow = 0.5F * b2_aabbExtension;  // has a contact before it touches
  const auto h = static_cast<float>(dt);
  for (const FlatBody& flat : slots) {
    if (flat.body == kNoBody || flat.fixed || flat.set_apart || !flat.b2->IsAwake()) continue;
    const b2Vec2 way = h * (flat.b2->GetLinearVelocity() + h * b2->GetGravity());
    const float rotation = std::min(std::abs(h * flat.b2->GetAngularVelocity()), 2.0F);
    if (way.LengthSquared() < kSlow * kSlow && rotation < kSlow) continue;
    for (b2Fixture* fixture = flat.b2->GetFixtureList(); fixture; fixture = fixture->GetNext()) {
      b2AABB box;
      fixture->GetShape()->ComputeAABB(&box, flat.b2->GetTransform(), 0);
      const float reach = rotation * b2Max(b2Distance(box.lowerBound, flat.b2->GetWorldCenter()),
                                           b2Distance(box.upperBound, flat.b2->GetWorldCenter()));
      box.lowerBound += b2Min(way, b2Vec2(0, 0)) - b2Vec2(reach, reach);
      box.upperBound += b2Max(way, b2Vec2(0, 0)) + b2Vec2(reach, reach);
      // The guard takes care of a body whose numbers are not finite.
      if (box.IsValid() && !roomy_box(*b2, *fixture, 0).Contains(box)) move_roomy_box(*b2, *fixture, box, way);
    }
  }
}

/// Makes the contacts of what has come near.
void Planar::Core::make_contacts() {
  find_contacts(*b2);
  rethrow();
  if (fresh_contacts > 0) order_contacts();
}

/// Puts contacts that are new where they belong.
void Planar::Core::order_contacts() {
  // New ones are first in the list. There may be fewer than its filter was asked about.
  struct Fresh {
    Place place;
    b2Contact* contact;
  };
  std::pmr::vector<Fresh> fresh(memory);
  const std::size_t count = std::min(fresh_contacts, static_cast<std::size_t>(b2->GetContactCount()));
  for (b2Contact* contact = b2->GetContactList(); fresh.size() < count; contact = contact->GetNext())
    fresh.push_back({{}, contact});
  for (Fresh& one : fresh) {
    bool swapped = false;
    key_of(*one.contact, swapped);
    const auto type = [](const b2Fixture* fixture) { return fixture->GetType(); };
    if (swapped && type(one.contact->GetFixtureA()) == type(one.contact->GetFixtureB()))
      one.contact = swap_shapes(*b2, one.contact);
  }
  fresh.erase(std::remove_if(fresh.begin(), fresh.end(), [](const Fresh& one) { return !one.contact; }), fresh.end());
  rethrow();
  fresh_contacts = 0;
  order_edges();
  take_first_contacts(*b2, fresh.size());
  for (Fresh& one : fresh) one.place = place_of(*one.contact);
  std::sort(fresh.begin(), fresh.end(), [](const Fresh& p, const Fresh& q) { return p.place < q.place; });
  for (const Fresh& one : fresh) insert_contact(*b2, contact_before(one.place), *one.contact);
}

/// Where a contact stands in the list: that of its body that moves, or of the first of both, then by the other.
Planar::Core::Place Planar::Core::place_of(const b2Contact& contact) const {
  const ContactKey key = key_of(contact);
  const bool second = find(key.a)->b2->GetType() == b2_staticBody;
  return {second ? key.b : key.a, key};
}

/// The contact after which a place is, of which all before it are in the list; null if it is the first.
b2Contact* Planar::Core::contact_before(const Place& place) const {
  // Edges of a body are also in this order, so the contact is near; it is looked for from the start only if the bodies
  // before have none.
  constexpr std::uint32_t kFew = 16;
  const std::uint32_t first = slot_of[place.first];
  for (std::uint32_t slot = first; slot + kFew > first; --slot) {
    const FlatBody& flat = slots[slot];
    b2Contact* last = nullptr;
    if (flat.body != kNoBody && flat.b2->GetType() != b2_staticBody)
      for (b2ContactEdge* edge = flat.b2->GetContactList(); edge; edge = edge->next)
        if (const Place at = place_of(*edge->contact); at.first == flat.body && at < place) last = edge->contact;
    if (last || slot == 0) return last;
  }
  b2Contact* before = nullptr;
  for (b2Contact* next = b2->GetContactList(); next && place_of(*next) < place; next = next->GetNext()) before = next;
  return before;
}

/// Contacts of each body that has new ones.
void Planar::Core::order_edges() {
  std::pmr::vector<std::pair<Place, b2ContactEdge*>> edges(memory);
  std::pmr::vector<b2ContactEdge*> list(memory);
  for (FlatBody& flat : slots) {
    if (!std::exchange(flat.fresh, false) || flat.body == kNoBody || flat.b2->GetType() == b2_staticBody) continue;
    edges.clear();
    for (b2ContactEdge* edge = flat.b2->GetContactList(); edge; edge = edge->next)
      edges.emplace_back(place_of(*edge->contact), edge);
    std::sort(edges.begin(), edges.end(), [](const auto& p, const auto& q) { return p.first < q.first; });
    list.clear();
    for (const auto& [key, edge] : edges) list.push_back(edge);
    set_contact_list(*flat.b2, list);
  }
}

}  // namespace breve
