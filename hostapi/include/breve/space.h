/* space.h: finds bodies in space with rays, overlaps, swept shapes and distances; sets which bodies collide; and applies
 * forces to them. It is a part of breve.h, and the rules at the top of breve.h hold here.
 */
#ifndef BREVE_SPACE_H
#define BREVE_SPACE_H

#include "breve/breve.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- queries ----------------------------------------------------------------------------------------------------- */

/* A query finds bodies where they are at this moment; handlers may use queries. Results are exact up to round-off for the
   shapes that bodies collide with. They are sorted by distance; objects at equal distances are in the order of creation.
   The first query builds a tree over all bodies, and later queries keep it up to date. A world without queries does not
   pay for them; the effect "queries" reports what they cost. Queries do not run script and do not change the world, its
   hash or its images. In a flat world, positions and directions must lie in its plane, where z is 0. A solid whose halves
   above and below the plane differ is tested as the whole solid. A height field is found within its bounds, but not in
   the ground far below them. */

/* Restricts a query to some bodies. A function that takes a pointer to a breve_query searches all bodies if it is NULL. */
typedef struct breve_query {
  size_t struct_size;     /* set by breve_query_default */
  const char* class_name; /* only objects of this class and its descendants; a name or an alias. NULL: all. Default NULL */
  breve_object except;    /* an object that is not found; null: none. Default null */
  uint32_t mask;          /* only bodies whose category (breve_collision_filter) has one of these bits. Default all bits */
  bool solid_only;        /* true: sensors are not found. Default false */
  bool reserved[3];       /* must be false */
} breve_query;

/* Returns a query with the defaults named above. */
static inline breve_query breve_query_default(void) {
  breve_query query;
  breve_clear(&query, sizeof query);
  query.struct_size = sizeof query;
  query.mask = 0xffffffffU;
  return query;
}

/* A body that was found. Frozen. */
typedef struct breve_hit {
  breve_object object;
  double point[3];  /* on its surface, world frame */
  double normal[3]; /* unit length, points away from the object */
  double distance;  /* length units; the comment of each function describes its meaning */
} breve_hit;

/* Finds the first body that a ray hits. A ray that starts inside a body hits it at its start, with a normal that points
   against the ray. Rays do not continue across edges of space that wrap.
   @param start  world frame
   @param way    from the start to the end of the ray
   @param query  may be NULL
   @param found  receives whether the ray hits a body
   @param hit    may be NULL; written only if a body is found. `distance` is measured from the start of the ray
   BREVE_OK, even if the ray does not hit a body; BREVE_ERROR_ARGUMENT: a number is not finite, or start or way is out of the
   plane of a flat world; BREVE_ERROR_NOT_FOUND: the program does not have the class; BREVE_ERROR_STALE: query->except no
   longer exists. */
BREVE_API breve_status breve_world_ray_first(const breve_world* world, const double start[3], const double way[3],
                                             const breve_query* query, bool* found, breve_hit* hit);

/* Finds all bodies that a ray hits, each at the point where the ray enters it.
   @param hits   room for `capacity` hits; NULL only if capacity is 0
   @param count  receives the total number, even if it exceeds capacity; at most capacity hits are written
   Returns the same statuses as breve_world_ray_first. */
BREVE_API breve_status breve_world_ray_all(const breve_world* world, const double start[3], const double way[3],
                                           const breve_query* query, breve_hit* hits, size_t capacity, size_t* count);

/* Finds all bodies that a solid touches or overlaps. Where space wraps, each body is tested at the position nearest to
   the solid.
   @param geometry  the solid: any geometry that breve_shape_create accepts; its density is ignored
   @param pose      the pose of the solid
   @param hits      as for breve_world_ray_all. `distance` is the negative depth of the overlap, at most 0, so the deepest
                    overlap comes first. `normal` is the direction in which the solid would leave the body
   Returns the same statuses as breve_world_ray_first; BREVE_ERROR_ARGUMENT also if breve_shape_create would return it. */
BREVE_API breve_status breve_world_overlap(const breve_world* world, const breve_geometry* geometry,
                                           const breve_pose* pose, const breve_query* query, breve_hit* hits,
                                           size_t capacity, size_t* count);

/* Finds the first body that a solid hits when it moves in a straight line without rotation. A body that the solid overlaps
   at the start is hit at distance 0. The motion does not continue across edges of space that wrap.
   @param way    from pose->location to the end of the motion
   @param found, hit  as for breve_world_ray_first. `distance` is how far the solid moves, and `point` is where it touches
                 the body
   Returns the same statuses as breve_world_overlap. */
BREVE_API breve_status breve_world_cast(const breve_world* world, const breve_geometry* geometry, const breve_pose* pose,
                                        const double way[3], const breve_query* query, bool* found, breve_hit* hit);

/* Finds the body whose surface is nearest to a point, also across edges of space that wrap. If the point is inside a body,
   the distance is negative, so the body in which the point lies deepest is the nearest.
   @param limit  the greatest distance to search, >= 0; INFINITY: no limit
   @param found, hit  as for breve_world_ray_first. `distance` is measured from the point to the surface, and `normal`
                 points to the point
   Returns the same statuses as breve_world_ray_first; BREVE_ERROR_ARGUMENT also if the limit is negative or NaN. */
BREVE_API breve_status breve_world_closest(const breve_world* world, const double point[3], double limit,
                                           const breve_query* query, bool* found, breve_hit* hit);

/* Finds all bodies whose centres are closer to a point than a radius, also across edges of space that wrap. It uses the
   current positions, no matter when the script last updated its neighbours.
   @param radius  >= 0
   @param hits    as for breve_world_ray_all. `point` is the centre of the body, and `distance` is measured from there to
                  the given point
   Returns the same statuses as breve_world_closest. */
BREVE_API breve_status breve_world_near(const breve_world* world, const double point[3], double radius,
                                        const breve_query* query, breve_hit* hits, size_t capacity, size_t* count);

/* ---- collision filters ------------------------------------------------------------------------------------------- */

/* Determines which bodies a body collides with, and what a collision does. Scripts can set the same properties. Images
   contain them. */
typedef struct breve_collision_filter {
  size_t struct_size; /* set by breve_collision_filter_default */
  uint32_t category;  /* the categories of this body, as bits. Default 1 */
  uint32_t mask;      /* the categories that it collides with. Two bodies collide if the mask of each has a bit of the
                         other's category; otherwise they pass through each other, and no handler is called. Default all
                         bits */
  double one_way[3];  /* a direction in the body's own frame. The body stops bodies with physics only on the side that the
                         direction points to; a body that comes from elsewhere passes through, until it has left on that
                         side. 0, 0, 0: all sides stop them. Default 0 */
  bool sensor;        /* true: the body does not push other bodies and is not pushed, but handlers are called and contact
                         events are reported. Default false */
  bool asks;          /* true: for each body that comes near, breve_may_collide_fn and then the method `may-collide` of the
                         object decide whether the two collide. Default false */
  bool reserved[6];   /* must be false */
} breve_collision_filter;

/* Returns a filter with the defaults named above. */
static inline breve_collision_filter breve_collision_filter_default(void) {
  breve_collision_filter filter;
  breve_clear(&filter, sizeof filter);
  filter.struct_size = sizeof filter;
  filter.category = 1;
  filter.mask = 0xffffffffU;
  return filter;
}

/* Reads the filter of a body. BREVE_OK; BREVE_ERROR_NO_BODY; BREVE_ERROR_ARGUMENT: a wrong struct_size. */
BREVE_API breve_status breve_object_collision_filter(const breve_world* world, breve_object object,
                                                     breve_collision_filter* filter);

/* Sets the filter of a body. It takes effect in the next sub-step. Bodies that sleep on this body wake up.
   BREVE_OK; BREVE_ERROR_NO_BODY; BREVE_ERROR_ARGUMENT: a number is not finite, one_way is out of the plane of a flat world,
   or a reserved field is set; nothing is changed then. */
BREVE_API breve_status breve_object_set_collision_filter(breve_world* world, breve_object object,
                                                         const breve_collision_filter* filter);

/* Reads what breve_object_set_collides has set for two objects; initially true. BREVE_OK. */
BREVE_API breve_status breve_object_collides(const breve_world* world, breve_object object, breve_object other,
                                             bool* collides);

/* Lets two objects pass through each other without calling handlers, or makes them collide again. Images contain the
   setting; it ends when one of the objects is freed. BREVE_OK; BREVE_ERROR_ARGUMENT: both are the same object. */
BREVE_API breve_status breve_object_set_collides(breve_world* world, breve_object object, breve_object other,
                                                 bool collides);

/* Returns whether two bodies that came near each other may collide; if false, they pass through each other. The world calls
   the function before a sub-step, for each body whose filter has `asks` set: once for each other body that comes near. It
   keeps the answer as long as the other body stays near; images contain the answers. The function may call any function
   of this header; functions that cannot work inside a step return BREVE_ERROR_BUSY. */
typedef bool (*breve_may_collide_fn)(void* user, breve_world* world, breve_object object, breve_object other);

/* Sets the function that decides for bodies whose filter has `asks` set. Images do not contain it.
   @param function  NULL: only the objects themselves decide
   BREVE_OK; BREVE_ERROR_BUSY while a script of this world runs. */
BREVE_API breve_status breve_world_set_may_collide(breve_world* world, breve_may_collide_fn function, void* user);

/* Queues a click on the first body that a ray hits, or on empty space if it does not hit one. Does the work of
   breve_world_ray_first and breve_world_queue_click in one call.
   @param start, way  the ray, as in breve_world_ray_first: from the camera's location through the pixel
   Returns the same statuses as breve_world_ray_first. */
BREVE_API breve_status breve_world_queue_click_ray(breve_world* world, const double start[3], const double way[3]);

/* ---- forces ------------------------------------------------------------------------------------------------------ */

/* These functions apply forces and impulses to bodies with physics, in addition to the lasting force of
   breve_object_set_force. Images contain the forces and impulses that have not acted yet. To move a platform that pushes
   other bodies, use breve_object_set_target. */

/* Adds a force and a torque that act only during the next iteration. Several calls add up.
   @param force, torque  world frame; NULL: none
   @param point          where the force acts, world frame; NULL: the centre of mass
   BREVE_OK; BREVE_ERROR_NO_BODY; BREVE_ERROR_ARGUMENT: a number is not finite, a vector is out of the plane of a flat world,
   or the body does not have physics. */
BREVE_API breve_status breve_object_add_force(breve_world* world, breve_object object, const double force[3],
                                              const double torque[3], const double point[3]);

/* Applies an impulse, N*s, which changes the velocity at once. A body with joints receives it as a constant force during
   the next iteration.
   @param impulse  world frame
   @param point    where the impulse acts, world frame; NULL: the centre of mass
   Returns the same statuses as breve_object_add_force. */
BREVE_API breve_status breve_object_add_impulse(breve_world* world, breve_object object, const double impulse[3],
                                                const double point[3]);

/* Wakes a body that sleeps (breve_world_set_sleeping). Does nothing if the body is awake. BREVE_OK; BREVE_ERROR_NO_BODY. */
BREVE_API breve_status breve_object_wake(breve_world* world, breve_object object);

#ifdef __cplusplus
}
#endif

#endif
