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

/// @param swapped  the second body is the one with the lower index
ContactKey Planar::Core::key_of(const b2Fixture& a, int child_a, const b2Fixture& b, int child_b, bool& swapped) const {
  ContactKey key{of(const_cast<b2Fixture&>(a).GetBody()).body,
                 of(const_cast<b2Fixture&>(b).GetBody()).body,
                 number_of(&a),
                 number_of(&b),
                 static_cast<std::uint32_t>(child_a),
                 static_cast<std::uint32_t>(child_b)};
  swapped = key.b < key.a;
  if (swapped) {
    std::swap(key.a, key.b);
    std::swap(key.fixture_a, key.fixture_b);
    std::swap(key.child_a, key.child_b);
  }
  return key;
}

ContactKey Planar::Core::key_of(const b2Contact& contact, bool& swapped) const {
  return key_of(*contact.GetFixtureA(), contact.GetChildIndexA(), *contact.GetFixtureB(), contact.GetChildIndexB(),
                swapped);
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

/// Makes the contacts of what has come near. Of many the last first: so they are in their order in Box2D's list, which
/// begins with the newest, and in its memory.
void Planar::Core::make_contacts() {
  struct Near {
    Place place;
    NearShapes shapes;
  };
  std::pmr::vector<NearShapes> found(memory);
  std::pmr::vector<Near> all(memory);
  find_near(*b2, found);
  for (NearShapes& shapes : found) {
    if (!is_body(shapes.a->fixture->GetBody()) || !is_body(shapes.b->fixture->GetBody())) continue;
    bool swapped = false;
    const ContactKey key =
        key_of(*shapes.a->fixture, shapes.a->childIndex, *shapes.b->fixture, shapes.b->childIndex, swapped);
    if (swapped) std::swap(shapes.a, shapes.b);
    all.push_back({place_of(key), shapes});
  }
  std::sort(all.begin(), all.end(), [](const Near& p, const Near& q) { return p.place > q.place; });
  std::pmr::vector<Place> known(memory);  // contacts of the first body
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto& [place, shapes] = all[i];
    if (i > 0 && place == all[i - 1].place) continue;
    if (i == 0 || place.first != all[i - 1].place.first) list_places(place.first, known);
    if (!std::binary_search(known.begin(), known.end(), place))
      add_new_contact(*b2, *shapes.a->fixture, shapes.a->childIndex, *shapes.b->fixture, shapes.b->childIndex);
  }
  rethrow();
  if (fresh_contacts > 0) order_contacts();
}

/// Places of the contacts that a body has.
void Planar::Core::list_places(BodyIndex body, std::pmr::vector<Place>& places) const {
  places.clear();
  for (const b2ContactEdge* edge = find(body)->b2->GetContactList(); edge; edge = edge->next)
    places.push_back(place_of(*edge->contact));
  std::sort(places.begin(), places.end());
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
  fresh_contacts = 0;
  order_edges();
  take_first_contacts(*b2, fresh.size());
  for (Fresh& one : fresh) one.place = place_of(*one.contact);
  std::sort(fresh.begin(), fresh.end(), [](const Fresh& p, const Fresh& q) { return p.place < q.place; });
  b2Contact* last = nullptr;
  for (std::size_t i = 0; i < fresh.size(); ++i) {
    // Of one body many may be new: the next is a little after the last.
    const bool goes_on = last && fresh[i - 1].place.first == fresh[i].place.first;
    b2Contact* before = goes_on ? last_before(last, fresh[i].place) : contact_before(fresh[i].place);
    insert_contact(*b2, before, *fresh[i].contact);
    last = fresh[i].contact;
  }
}

/// Where a contact stands in the list: that of its body that moves, or of the first of both, then by the other.
Planar::Core::Place Planar::Core::place_of(const ContactKey& key) const {
  const bool second = find(key.a)->b2->GetType() == b2_staticBody;
  return {second ? key.b : key.a, key};
}

Planar::Core::Place Planar::Core::place_of(const b2Contact& contact) const { return place_of(key_of(contact)); }

/// The last contact before a place, of which `from` is one.
b2Contact* Planar::Core::last_before(b2Contact* from, const Place& place) const {
  while (from->GetNext() && place_of(*from->GetNext()) < place) from = from->GetNext();
  return from;
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
  b2Contact* const head = b2->GetContactList();
  return head && place_of(*head) < place ? last_before(head, place) : nullptr;
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
