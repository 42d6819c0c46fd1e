/* space.h: where bodies are and whom they meet: rays, overlaps, swept shapes, nearest bodies; who collides with whom. A part of
 * breve.h, whose rules hold here.
 */
#ifndef BREVE_SPACE_H
#define BREVE_SPACE_H

#include "breve/breve.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- queries ----------------------------------------------------------------------------------------------------- */

/* Queries about the bodies of a world as they are at this moment, also from inside handlers. Results are exact up to
   round-off for the shapes that bodies collide with, and sorted by distance; objects at equal distances are in the order
   of creation. The first query builds a tree over all bodies, and later ones keep it up to date: a world without queries
   pays nothing, and the effect "queries" reports what they cost. Queries do not run script and do not change the world,
   its hash or its images. In a flat world, positions and directions must lie in its plane, where z is 0; a solid whose
   halves above and below the plane differ is tested as the solid that it is. A height field is found within its bounds,
   but not in the ground far below them. */

/* Restricts a query to some bodies. Where a function takes a pointer to one, NULL means all bodies. */
typedef struct breve_query {
  size_t struct_size;     /* set by breve_query_default */
  const char* class_name; /* only objects of this class and its descendants; a name or an alias. NULL: all. Default NULL */
  breve_object except;    /* this object is not found; null: none is left out. Default null */
  uint32_t mask;          /* bodies whose category (breve_collision_filter) has one of these bits. Default all bits */
  bool solid_only;        /* sensors are not found. Default false */
  bool reserved[3];       /* must be false */
} breve_query;

/* The defaults named above. */
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
  double normal[3]; /* unit, away from the object */
  double distance;  /* length units; its meaning is described at each function */
} breve_hit;

/* Finds the first body that a ray hits. A ray that starts inside a body hits it at its start, with a normal that points
   against the ray. Rays do not continue across edges of space that wrap.
   @param start  world frame
   @param way    from the start to the end of the ray
   @param query  may be NULL
   @param found  set to whether the ray hits anything
   @param hit    may be NULL; written only if something is found; `distance` is measured from the start
   BREVE_OK, also if the ray hits nothing; BREVE_ERROR_ARGUMENT: not finite, or out of the plane of a flat world;
   BREVE_ERROR_NOT_FOUND: the program does not have the class; BREVE_ERROR_STALE: query->except no longer exists. */
BREVE_API breve_status breve_world_ray_first(const breve_world* world, const double start[3], const double way[3],
                                             const breve_query* query, bool* found, breve_hit* hit);

/* Finds all bodies that a ray hits, each at the point where the ray enters it.
   @param hits   room for `capacity` hits; NULL only if capacity is 0
   @param count  the total number, even if it exceeds capacity; at most capacity hits are written
   As breve_world_ray_first. */
BREVE_API breve_status breve_world_ray_all(const breve_world* world, const double start[3], const double way[3],
                                           const breve_query* query, breve_hit* hits, size_t capacity, size_t* count);

/* Finds all bodies that a solid touches or overlaps. Where space wraps, each body is tested at the position nearest to
   the solid.
   @param geometry  the solid: any geometry that breve_shape_create accepts; its density is ignored
   @param pose      of the solid
   @param hits      as for breve_world_ray_all. `distance` is the negative depth of the overlap, at most 0, so the deepest
                    overlap comes first; `normal` is the direction in which the solid would leave the body
   As breve_world_ray_first; BREVE_ERROR_ARGUMENT also as breve_shape_create. */
BREVE_API breve_status breve_world_overlap(const breve_world* world, const breve_geometry* geometry,
                                           const breve_pose* pose, const breve_query* query, breve_hit* hits,
                                           size_t capacity, size_t* count);

/* Finds the first body that a solid hits when it moves without rotation. A body that it overlaps at the start is hit at
   distance 0. The motion does not continue across edges of space that wrap.
   @param way    from pose->location to the end of the motion
   @param found, hit  as for breve_world_ray_first; `distance` is how far the solid moves, `point` is where the two touch
   As breve_world_overlap. */
BREVE_API breve_status breve_world_cast(const breve_world* world, const breve_geometry* geometry, const breve_pose* pose,
                                        const double way[3], const breve_query* query, bool* found, breve_hit* hit);

/* Finds the body whose surface is nearest to a point, also across edges of space that wrap. The distance is negative if
   the point is inside the body; the body in which it is deepest is the nearest.
   @param limit  the greatest distance to search, >= 0; INFINITY: no limit
   @param found, hit  as for breve_world_ray_first; `distance` is from the point to the surface, `normal` points to the
                 point
   As breve_world_ray_first; BREVE_ERROR_ARGUMENT also for a limit that is negative or NaN. */
BREVE_API breve_status breve_world_closest(const breve_world* world, const double point[3], double limit,
                                           const breve_query* query, bool* found, breve_hit* hit);

/* Finds all bodies whose centres are closer to a point than a radius, also across edges of space that wrap. It uses the
   current positions, whenever the script last updated its neighbours.
   @param radius  >= 0
   @param hits    as for breve_world_ray_all; `point` is the centre of the body, `distance` is from there to the point
   As breve_world_closest. */
BREVE_API breve_status breve_world_near(const breve_world* world, const double point[3], double radius,
                                        const breve_query* query, breve_hit* hits, size_t capacity, size_t* count);

/* ---- collision filters ------------------------------------------------------------------------------------------- */

/* Which bodies a body collides with, and what a collision does. Scripts can set the same. Part of images. */
typedef struct breve_collision_filter {
  size_t struct_size; /* set by breve_collision_filter_default */
  uint32_t category;  /* the categories of this body, as bits. Default 1 */
  uint32_t mask;      /* the categories that it collides with. Two bodies collide if the mask of each has a bit of the
                         other's category; otherwise they pass through each other, and no handler is called. Default all
                         bits */
  double one_way[3];  /* in its own frame: bodies with physics are stopped only on the side that this points to; bodies
                         that come from elsewhere pass through, until they have left on that side. 0, 0, 0: all sides
                         stop them. Default 0 */
  bool sensor;        /* does not push and is not pushed; handlers are called and contact events reported. Default false */
  bool asks;          /* for each body that comes near, breve_may_collide_fn and then the method `may-collide` of the object
                         decide whether the two collide. Default false */
  bool reserved[6];   /* must be false */
} breve_collision_filter;

/* The defaults named above. */
static inline breve_collision_filter breve_collision_filter_default(void) {
  breve_collision_filter filter;
  breve_clear(&filter, sizeof filter);
  filter.struct_size = sizeof filter;
  filter.category = 1;
  filter.mask = 0xffffffffU;
  return filter;
}

/* BREVE_OK; BREVE_ERROR_NO_BODY; BREVE_ERROR_ARGUMENT: a wrong struct_size. */
BREVE_API breve_status breve_object_collision_filter(const breve_world* world, breve_object object,
                                                     breve_collision_filter* filter);

/* Takes effect in the next sub-step; bodies that sleep on this body wake up.
   BREVE_OK; BREVE_ERROR_NO_BODY; BREVE_ERROR_ARGUMENT: not finite, one_way out of the plane of a flat world, or a reserved
   field is set; nothing is changed then. */
BREVE_API breve_status breve_object_set_collision_filter(breve_world* world, breve_object object,
                                                         const breve_collision_filter* filter);

/* Whether two objects collide as far as breve_object_set_collides is concerned; initially true. BREVE_OK. */
BREVE_API breve_status breve_object_collides(const breve_world* world, breve_object object, breve_object other,
                                             bool* collides);

/* Lets two objects pass through each other without calling handlers, or makes them collide again. Part of images; it ends
   when one of them is freed. BREVE_OK; BREVE_ERROR_ARGUMENT: both are the same object. */
BREVE_API breve_status breve_object_set_collides(breve_world* world, breve_object object, breve_object other,
                                                 bool collides);

/* Returns whether two bodies that came near each other may collide; if false, they pass through each other. Called before a
   sub-step, for bodies whose filter has `asks` set, once for each other body as long as that stays near. Until then the
   answer is kept; it is part of images. The function may call any function of this header; those that cannot work inside
   a step return BREVE_ERROR_BUSY. */
typedef bool (*breve_may_collide_fn)(void* user, breve_world* world, breve_object object, breve_object other);

/* @param function  NULL: only the objects themselves are asked. It is not part of images
   BREVE_OK; BREVE_ERROR_BUSY while a script of this world runs. */
BREVE_API breve_status breve_world_set_may_collide(breve_world* world, breve_may_collide_fn function, void* user);

/* Queues a click on the first body that a ray meets, or on nothing: breve_world_ray_first, then breve_world_queue_click.
   @param start, way  as in breve_world_ray_first: from the camera's location through the pixel
   Returns the same statuses as breve_world_ray_first. */
BREVE_API breve_status breve_world_queue_click_ray(breve_world* world, const double start[3], const double way[3]);

/* ---- forces ------------------------------------------------------------------------------------------------------ */

/* Forces and impulses on bodies with physics, in addition to the lasting force of breve_object_set_force. Those that have
   not acted yet are part of images. For a platform that moves and pushes other bodies, use breve_object_set_target. */

/* Adds a force and a torque that act only during the next iteration. Several calls add up.
   @param force, torque  world frame; NULL: none
   @param point          where the force acts, world frame; NULL: the centre of mass
   BREVE_OK; BREVE_ERROR_NO_BODY; BREVE_ERROR_ARGUMENT: not finite, out of the plane of a flat world, or the body does not
   have physics. */
BREVE_API breve_status breve_object_add_force(breve_world* world, breve_object object, const double force[3],
                                              const double torque[3], const double point[3]);

/* Applies an impulse, N*s: the velocity changes at once. A body with joints receives it as a constant force during the
   next iteration.
   @param impulse  world frame
   @param point    where it acts, world frame; NULL: the centre of mass
   As breve_object_add_force. */
BREVE_API breve_status breve_object_add_impulse(breve_world* world, breve_object object, const double impulse[3],
                                                const double point[3]);

/* Wakes a body that sleeps (breve_world_set_sleeping). Does nothing if it is awake. BREVE_OK; BREVE_ERROR_NO_BODY. */
BREVE_API breve_status breve_object_wake(breve_world* world, breve_object object);

#ifdef __cplusplus
}
#endif

#endif
