// What Box2D keeps to itself and this room must know or set: the order in which it solves, and what of its state an
// image holds.
#pragma once

#include <box2d/box2d.h>

#include <memory_resource>
#include <span>
#include <vector>

namespace breve {

/// s, for how long a body has been slow.
float& sleep_time(b2Body& body);

/// Whether a body takes part in steps, without what SetAwake() does besides: its velocity and the time for which it has
/// been slow stay.
void set_awake_flag(b2Body& body, bool awake);

/// Where its centre of mass is, from which Box2D computes its origin, but not to the last bit the other way round; and
/// where it was before its last step.
const b2Sweep& sweep_of(const b2Body& body);
void set_sweep(b2Body& body, const b2Vec2& center, const b2Vec2& center_before, float angle_before);

/// s, the length of the step that the impulses of contacts and joints are of: Box2D scales them to the next one's.
void set_length_of_last_step(b2World& world, float length);

/// The rest of a step of a world whose SetContinuousPhysics() is false: what would pass through another shape is moved
/// back to their impact. Where SetSubStepping() is true it solves one impact; call it until none is left.
/// @param length      s, of the step
/// @param iterations  of velocities
/// Returns whether no impact is left.
bool solve_impacts(b2World& world, float length, int iterations);

/// The roomy box in which Box2D looks for what is near a shape: the fixture's, or that of one edge of a profile.
const b2AABB& roomy_box(const b2World& world, const b2Fixture& fixture, int child);
void set_roomy_box(b2World& world, b2Fixture& fixture, int child, const b2AABB& box);

/// Two shapes, or edges of profiles, whose roomy boxes meet.
struct NearShapes {
  b2FixtureProxy *a, *b;
};

/// Shapes that have come near each other since this was asked last, of which at least one is moved by forces. In no
/// order, and some pairs twice; a pair may have a contact already.
void find_near(b2World& world, std::pmr::vector<NearShapes>& found);

/// Makes a contact of two shapes, or of one edge of one that is a profile. Returns it; null if there may be none.
b2Contact* add_contact(b2World& world, b2Fixture& a, int child_a, b2Fixture& b, int child_b);

/// The same of two shapes that have none yet. Box2D would look for it among all contacts of b's body.
b2Contact* add_new_contact(b2World& world, b2Fixture& a, int child_a, b2Fixture& b, int child_b);

/// Ends a contact, as a step does with one that is filtered.
void end_contact(b2World& world, b2Contact& contact);

/// Makes a new contact one that touches, as if a step had found it so.
void set_touching(b2Contact& contact, const b2Manifold& manifold);

/// Takes the first contacts of a world off its list.
void take_first_contacts(b2World& world, std::size_t count);

/// Puts one in after another, or first.
void insert_contact(b2World& world, b2Contact* before, b2Contact& contact);

/// @param edges, all  what the body or the world has, in another order
void set_contact_list(b2Body& body, std::span<b2ContactEdge* const> edges);
void set_joint_list(b2Body& body, std::span<b2JointEdge* const> edges);
void set_body_list(b2World& world, std::span<b2Body* const> all);

}  // namespace breve
