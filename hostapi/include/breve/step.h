/* step.h: stepping in a game loop: the length of an iteration, the speed of time, poses between two iterations. A part of
 * breve.h, whose rules hold here.
 */
#ifndef BREVE_STEP_H
#define BREVE_STEP_H

#include "breve/breve.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- stepping in a game loop ------------------------------------------------------------------------------------- */

/* breve_world_advance runs whole iterations; breve_world_set_paused stops it. These functions control the time between
   iterations. None of them runs script. Only the length of an iteration is part of images. */

/* Sets the length of an iteration, beginning with the next one; scripts can also set it. The time that
   breve_world_advance carries over does not change.
   @param seconds  finite, > 0
   BREVE_OK; BREVE_ERROR_ARGUMENT. */
BREVE_API breve_status breve_world_set_iteration_step(breve_world* world, double seconds);

/* The longest sub-step, s (see breve_world_config.integration_step). 0 for NULL. */
BREVE_API double breve_world_integration_step(const breve_world* world);

/* Sets the longest sub-step, beginning with the next iteration; scripts can also set it.
   @param seconds  finite, > 0
   BREVE_OK; BREVE_ERROR_ARGUMENT. */
BREVE_API breve_status breve_world_set_integration_step(breve_world* world, double seconds);

/* The simulated time for each second that is passed to breve_world_advance; initially 1. 0 for NULL. */
BREVE_API double breve_world_time_scale(const breve_world* world);

/* @param scale  finite, >= 0; 0.5: slow motion; 0: time stands still
   BREVE_OK; BREVE_ERROR_ARGUMENT. */
BREVE_API breve_status breve_world_set_time_scale(breve_world* world, double scale);

/* Whether the world keeps the poses of all bodies before the last iteration, for breve_objects_interpolated. Initially
   false; it costs a copy of all poses in each iteration. BREVE_OK. */
BREVE_API breve_status breve_world_set_interpolated(breve_world* world, bool on);

/* Whether they are kept. False for NULL. */
BREVE_API bool breve_world_interpolated(const breve_world* world);

/* The poses of bodies between the last two iterations: locations on a straight line, the shortest one where space wraps;
   rotations at constant speed. The current pose is returned for a body that was created since, for one that the host has
   moved since (breve_object_set_pose, breve_objects_set_property), and before the first iteration.
   @param objects   NULL only if count is 0
   @param fraction  from 0 (before the last iteration) to 1 (now), as breve_world_advance returns it
   @param property  BREVE_PROPERTY_LOCATION, _ROTATION or _POSE
   @param array     one row for each object, as for breve_objects_property
   BREVE_OK; BREVE_ERROR_NO_BODY; BREVE_ERROR_ARGUMENT: out of these ranges, or the poses are not kept
   (breve_world_set_interpolated). */
BREVE_API breve_status breve_objects_interpolated(const breve_world* world, const breve_object* objects, size_t count,
                                                  double fraction, uint32_t property, const breve_array* array);

#ifdef __cplusplus
}
#endif

#endif
