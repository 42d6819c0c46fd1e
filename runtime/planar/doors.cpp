// Where a template is instantiated by name, private members may be named: each door below opens on one of them.
#include "runtime/planar/doors.hpp"

#include <cstdint>
#include <utility>

namespace breve {

namespace {

// KEEP IN STEP: Box2D 2.4's classes, of which these are members.
float& slow_for(b2Body& body);
std::uint16_t& flags(b2Body& body);
std::uint16_t awake_flag();
b2Sweep& sweep(b2Body& body);
b2ContactEdge*& first_contact_of(b2Body& body);
b2JointEdge*& first_joint_of(b2Body& body);
b2Body*& before(b2Body& body);
b2Body*& after(b2Body& body);
b2FixtureProxy* proxies(b2Fixture& fixture);
b2Contact*& before(b2Contact& contact);
b2Contact*& after(b2Contact& contact);
std::uint32_t& flags(b2Contact& contact);
std::uint32_t touching_flag();
b2Body*& first_body(b2World& world);
float& inverse_of_last_step(b2World& world);
bool step_is_complete(const b2World& world);
void solve_times_of_impact(b2World& world, const b2TimeStep& step);
b2DynamicTree& tree(b2BroadPhase& phase);
b2TreeNode* nodes(b2DynamicTree& tree);
void take_leaf(b2DynamicTree& tree, int leaf);
void insert_leaf(b2DynamicTree& tree, int leaf);

template <auto Sleep, auto Flags, auto Awake, auto Sweep, auto Contacts, auto Joints, auto Before, auto After>
struct BodyDoor {
  friend float& slow_for(b2Body& body) { return body.*Sleep; }
  friend std::uint16_t& flags(b2Body& body) { return body.*Flags; }
  friend std::uint16_t awake_flag() { return Awake; }
  friend b2Sweep& sweep(b2Body& body) { return body.*Sweep; }
  friend b2ContactEdge*& first_contact_of(b2Body& body) { return body.*Contacts; }
  friend b2JointEdge*& first_joint_of(b2Body& body) { return body.*Joints; }
  friend b2Body*& before(b2Body& body) { return body.*Before; }
  friend b2Body*& after(b2Body& body) { return body.*After; }
};
template struct BodyDoor<&b2Body::m_sleepTime, &b2Body::m_flags, b2Body::e_awakeFlag, &b2Body::m_sweep,
                         &b2Body::m_contactList, &b2Body::m_jointList, &b2Body::m_prev, &b2Body::m_next>;

template <auto Proxies>
struct FixtureDoor {
  friend b2FixtureProxy* proxies(b2Fixture& fixture) { return fixture.*Proxies; }
};
template struct FixtureDoor<&b2Fixture::m_proxies>;

template <auto Before, auto After, auto Flags, auto Touching>
struct ContactDoor {
  friend b2Contact*& before(b2Contact& contact) { return contact.*Before; }
  friend b2Contact*& after(b2Contact& contact) { return contact.*After; }
  friend std::uint32_t& flags(b2Contact& contact) { return contact.*Flags; }
  friend std::uint32_t touching_flag() { return Touching; }
};
template struct ContactDoor<&b2Contact::m_prev, &b2Contact::m_next, &b2Contact::m_flags, b2Contact::e_touchingFlag>;

template <auto Bodies, auto Step, auto Complete, auto Impacts>
struct WorldDoor {
  friend b2Body*& first_body(b2World& world) { return world.*Bodies; }
  friend float& inverse_of_last_step(b2World& world) { return world.*Step; }
  friend bool step_is_complete(const b2World& world) { return world.*Complete; }
  friend void solve_times_of_impact(b2World& world, const b2TimeStep& step) { (world.*Impacts)(step); }
};
template struct WorldDoor<&b2World::m_bodyList, &b2World::m_inv_dt0, &b2World::m_stepComplete, &b2World::SolveTOI>;

template <auto Tree>
struct PhaseDoor {
  friend b2DynamicTree& tree(b2BroadPhase& phase) { return phase.*Tree; }
};
template struct PhaseDoor<&b2BroadPhase::m_tree>;

template <auto Nodes, auto Take, auto Insert>
struct TreeDoor {
  friend b2TreeNode* nodes(b2DynamicTree& tree) { return tree.*Nodes; }
  friend void take_leaf(b2DynamicTree& tree, int leaf) { (tree.*Take)(leaf); }
  friend void insert_leaf(b2DynamicTree& tree, int leaf) { (tree.*Insert)(leaf); }
};
template struct TreeDoor<&b2DynamicTree::m_nodes, &b2DynamicTree::RemoveLeaf, &b2DynamicTree::InsertLeaf>;

/// It is only given out to be read.
b2ContactManager& manager_of(b2World& world) { return const_cast<b2ContactManager&>(world.GetContactManager()); }

template <class Edge>
void link(Edge*& first, std::span<Edge* const> edges) {
  Edge* last = nullptr;
  Edge** next = &first;
  for (Edge* edge : edges) {
    *next = edge;
    edge->prev = last;
    last = edge;
    next = &edge->next;
  }
  *next = nullptr;
}

}  // namespace

float& sleep_time(b2Body& body) { return slow_for(body); }

void set_awake_flag(b2Body& body, bool awake) {
  std::uint16_t& all = flags(body);
  all = static_cast<std::uint16_t>(awake ? all | awake_flag() : all & ~awake_flag());
}

const b2Sweep& sweep_of(const b2Body& body) { return sweep(const_cast<b2Body&>(body)); }

void set_sweep(b2Body& body, const b2Vec2& center, const b2Vec2& center_before, float angle_before) {
  sweep(body).c = center;
  sweep(body).c0 = center_before;
  sweep(body).a0 = angle_before;
}

void set_length_of_last_step(b2World& world, float length) {
  inverse_of_last_step(world) = length > 0 ? 1.0F / length : 0.0F;
}

bool solve_impacts(b2World& world, float length, int iterations) {
  b2TimeStep step{};
  step.dt = length;
  step.velocityIterations = iterations;
  solve_times_of_impact(world, step);
  return step_is_complete(world);
}

const b2AABB& roomy_box(const b2World& world, const b2Fixture& fixture, int child) {
  return world.GetContactManager().m_broadPhase.GetFatAABB(proxies(const_cast<b2Fixture&>(fixture))[child].proxyId);
}

void set_roomy_box(b2World& world, b2Fixture& fixture, int child, const b2AABB& box) {
  b2DynamicTree& all = tree(manager_of(world).m_broadPhase);
  const int leaf = proxies(fixture)[child].proxyId;
  take_leaf(all, leaf);
  nodes(all)[leaf].aabb = box;
  insert_leaf(all, leaf);
}

void find_near(b2World& world, std::pmr::vector<NearShapes>& found) {
  struct Collector {
    std::pmr::vector<NearShapes>& found;
    void AddPair(void* a, void* b) {
      const NearShapes near{static_cast<b2FixtureProxy*>(a), static_cast<b2FixtureProxy*>(b)};
      const b2Body &of_a = *near.a->fixture->GetBody(), &of_b = *near.b->fixture->GetBody();
      if (&of_a == &of_b || (of_a.GetType() != b2_dynamicBody && of_b.GetType() != b2_dynamicBody)) return;
      found.push_back(near);
    }
  } collector{found};
  manager_of(world).m_broadPhase.UpdatePairs(&collector);
}

b2Contact* add_contact(b2World& world, b2Fixture& a, int child_a, b2Fixture& b, int child_b) {
  b2ContactManager& manager = manager_of(world);
  const int count = manager.m_contactCount;
  manager.AddPair(proxies(a) + child_a, proxies(b) + child_b);
  return manager.m_contactCount > count ? manager.m_contactList : nullptr;
}

b2Contact* add_new_contact(b2World& world, b2Fixture& a, int child_a, b2Fixture& b, int child_b) {
  b2ContactEdge*& first = first_contact_of(*b.GetBody());
  b2ContactEdge* const rest = std::exchange(first, nullptr);
  b2Contact* const contact = add_contact(world, a, child_a, b, child_b);
  if (!rest) return contact;
  if (first) {
    first->next = rest;
    rest->prev = first;
  } else {
    first = rest;
  }
  return contact;
}

void end_contact(b2World& world, b2Contact& contact) { manager_of(world).Destroy(&contact); }

void set_touching(b2Contact& contact, const b2Manifold& manifold) {
  *contact.GetManifold() = manifold;
  flags(contact) |= touching_flag();
}

void take_first_contacts(b2World& world, std::size_t count) {
  b2Contact*& first = manager_of(world).m_contactList;
  while (count-- > 0) first = after(*first);
  if (first) before(*first) = nullptr;
}

void insert_contact(b2World& world, b2Contact* previous, b2Contact& contact) {
  b2Contact*& place = previous ? after(*previous) : manager_of(world).m_contactList;
  after(contact) = place;
  before(contact) = previous;
  if (place) before(*place) = &contact;
  place = &contact;
}

void set_contact_list(b2Body& body, std::span<b2ContactEdge* const> edges) { link(first_contact_of(body), edges); }
void set_joint_list(b2Body& body, std::span<b2JointEdge* const> edges) { link(first_joint_of(body), edges); }

void set_body_list(b2World& world, std::span<b2Body* const> all) {
  b2Body* last = nullptr;
  b2Body** next = &first_body(world);
  for (b2Body* body : all) {
    *next = body;
    before(*body) = last;
    last = body;
    next = &after(*body);
  }
  *next = nullptr;
}

}  // namespace breve
