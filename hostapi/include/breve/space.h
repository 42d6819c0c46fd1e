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

/* Questions about the bodies of a world as they are at this moment, in handlers too. Answers are exact for the shapes that
   bodies collide with, to round-off, and sorted by distance; of equal ones, the object that was created first comes
   first. The first question builds a tree over all bodies, which later ones keep up to date: a world that is not asked
   pays nothing, and the effect "queries" says what the questions cost. They change nothing in the world, its hash and
   its images included. None of them runs script. In a flat world places and ways are in its plane, where z is 0; a solid
   that is not the same above and below the plane is met as the solid that it is. A height field is found within its
   bounds, not in the ground far below them. */

/* Which bodies a question is about. NULL, where it is asked for: all. */
typedef struct breve_query {
  size_t struct_size;     /* as breve_query_default gives it */
  const char* class_name; /* of objects of this class and its descendants: name or alias; NULL: of all. Default NULL */
  breve_object except;    /* the body of this object is not found; null: nobody is left out. Default null */
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
  double point[3];  /* where, on its surface, world frame */
  double normal[3]; /* unit, away from the object */
  double distance;  /* length units; each function says of what */
} breve_hit;

/* The first body that a ray meets. A ray that starts inside a body hits it there, with a normal against its way. It goes
   straight on, not across edges of space that wrap.
   @param start  where it starts
   @param way    from there to its end, of any length
   @param query  may be NULL
   @param found  whether it meets anything
   @param hit    may be NULL; written only if something is found; `distance` from the start
   BREVE_OK, also if it meets nothing; BREVE_ERROR_ARGUMENT: not finite, or out of the plane of a flat world;
   BREVE_ERROR_NOT_FOUND: the program has no such class; BREVE_ERROR_STALE: query->except is gone. */
BREVE_API breve_status breve_world_ray_first(const breve_world* world, const double start[3], const double way[3],
                                             const breve_query* query, bool* found, breve_hit* hit);

/* All bodies that a ray meets, each where it enters.
   @param hits   room for `capacity`; NULL only if capacity is 0
   @param count  how many there are, also where that is more than capacity: at most capacity are written
   As breve_world_ray_first. */
BREVE_API breve_status breve_world_ray_all(const breve_world* world, const double start[3], const double way[3],
                                           const breve_query* query, breve_hit* hits, size_t capacity, size_t* count);

/* All bodies that a solid meets; to touch is enough. Where space wraps each body counts where it is nearest to the solid.
   @param geometry  the solid: any that breve_shape_create takes; its density is not looked at
   @param pose      where it is
   @param hits      as of breve_world_ray_all. `distance` is minus the depth of the overlap, at most 0, so that the
                    deepest comes first; `normal` is the way along which the solid would leave the body
   As breve_world_ray_first; BREVE_ERROR_ARGUMENT also as breve_shape_create. */
BREVE_API breve_status breve_world_overlap(const breve_world* world, const breve_geometry* geometry,
                                           const breve_pose* pose, const breve_query* query, breve_hit* hits,
                                           size_t capacity, size_t* count);

/* The first body that a solid meets when it is moved and does not turn. One that it meets to begin with is hit at distance
   0. Not across edges of space that wrap.
   @param way    from pose->location to where its motion ends
   @param found, hit  as of breve_world_ray_first; `distance` is how far the solid comes, `point` where the two touch
   As breve_world_overlap. */
BREVE_API breve_status breve_world_cast(const breve_world* world, const breve_geometry* geometry, const breve_pose* pose,
                                        const double way[3], const breve_query* query, bool* found, breve_hit* hit);

/* The body whose surface is nearest to a point, across edges of space that wrap. Bodies that the point is inside of are
   nearest, the one that it is deepest in first: their distance is negative.
   @param limit  look no farther than this, >= 0; INFINITY: anywhere
   @param found, hit  as of breve_world_ray_first; `distance` from the point to the surface, `normal` toward the point
   As breve_world_ray_first; BREVE_ERROR_ARGUMENT also for a limit that is negative or NaN. */
BREVE_API breve_status breve_world_closest(const breve_world* world, const double point[3], double limit,
                                           const breve_query* query, bool* found, breve_hit* hit);

/* All bodies whose centres are nearer to a point than a radius, across edges of space that wrap: the neighbours of a
   place. They are those of this moment, whenever the script updated its neighbours.
   @param radius  >= 0
   @param hits    as of breve_world_ray_all; `point` is the centre, `distance` from there to the point
   As breve_world_closest. */
BREVE_API breve_status breve_world_near(const breve_world* world, const double point[3], double radius,
                                        const breve_query* query, breve_hit* hits, size_t capacity, size_t* count);

/* ---- who collides with whom -------------------------------------------------------------------------------------- */

/* What a body meets and what a meeting does; in images, and the same that scripts set. */
typedef struct breve_collision_filter {
  size_t struct_size; /* as breve_collision_filter_default gives it */
  uint32_t category;  /* what kinds of body it is, as bits. Default 1 */
  uint32_t mask;      /* what kinds it meets. Two bodies meet if the mask of each has a bit of the other's category; others
                         pass through each other, and no handler is called. Default all bits */
  double one_way[3];  /* in its own frame: bodies with physics are stopped only on the side that this points to; what comes
                         from elsewhere passes until it has left there. 0, 0, 0: all sides stop. Default 0 */
  bool sensor;        /* pushes nobody and is not pushed; handlers are called, contact events told. Default false */
  bool asks;          /* breve_may_collide_fn, then the method `may-collide` of its object, are asked about each body that
                         comes near. Default false */
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

/* It holds from the next sub-step on; what sleeps on the body wakes.
   BREVE_OK; BREVE_ERROR_NO_BODY; BREVE_ERROR_ARGUMENT: not finite, one_way out of the plane of a flat world, a reserved
   field; nothing is changed. */
BREVE_API breve_status breve_object_set_collision_filter(breve_world* world, breve_object object,
                                                         const breve_collision_filter* filter);

/* Do two objects collide, as far as breve_object_set_collides says? True at first. BREVE_OK. */
BREVE_API breve_status breve_object_collides(const breve_world* world, breve_object object, breve_object other,
                                             bool* collides);

/* Let two objects pass through each other without calling handlers, or end that. In images; forgotten when one of them is
   freed. BREVE_OK; BREVE_ERROR_ARGUMENT: both are one object. */
BREVE_API breve_status breve_object_set_collides(breve_world* world, breve_object object, breve_object other,
                                                 bool collides);

/* May two bodies collide that came near? Called for bodies that ask (breve_collision_filter.asks) before a sub-step, once for
   each other body as long as that stays near; the answer is kept until then, in images too. It may call any function of
   this header; those that cannot work inside a step give BREVE_ERROR_BUSY. False: they pass through each other. */
typedef bool (*breve_may_collide_fn)(void* user, breve_world* world, breve_object object, breve_object other);

/* @param function  NULL: nobody beside the objects themselves is asked. It is not part of images
   BREVE_OK; BREVE_ERROR_BUSY while a script of this world runs. */
BREVE_API breve_status breve_world_set_may_collide(breve_world* world, breve_may_collide_fn function, void* user);

/* Queues a click on the first body that a ray meets, or on nothing: breve_world_ray_first, then breve_world_queue_click.
   @param start, way  as in breve_world_ray_first: from the camera's location through the pixel
   Returns the same statuses as breve_world_ray_first. */
BREVE_API breve_status breve_world_queue_click_ray(breve_world* world, const double start[3], const double way[3]);

/* ---- forces ------------------------------------------------------------------------------------------------------ */

/* Push bodies with physics. breve_object_set_force sets a force that stays; these come on top of it. Pushes that have
   not acted yet are part of images. A platform that moves, and pushes what it meets, has breve_object_set_target. */

/* A force and a torque that act in the next iteration only. Several calls add up.
   @param force, torque  world frame; NULL: none
   @param point          of the world, where the force acts; NULL: the centre of mass
   BREVE_OK; BREVE_ERROR_NO_BODY; BREVE_ERROR_ARGUMENT: not finite, out of the plane of a flat world, or the body has no
   physics. */
BREVE_API breve_status breve_object_add_force(breve_world* world, breve_object object, const double force[3],
                                              const double torque[3], const double point[3]);

/* An impulse, N*s: the velocity changes at once. A body that joints hold gets it as an even force in the next iteration.
   @param impulse  world frame
   @param point    of the world, where it acts; NULL: the centre of mass
   As breve_object_add_force. */
BREVE_API breve_status breve_object_add_impulse(breve_world* world, breve_object object, const double impulse[3],
                                                const double point[3]);

/* Wake a body that sleeps (breve_world_set_sleeping). Does nothing if it is awake. BREVE_OK; BREVE_ERROR_NO_BODY. */
BREVE_API breve_status breve_object_wake(breve_world* world, breve_object object);

#ifdef __cplusplus
}
#endif

#endif
