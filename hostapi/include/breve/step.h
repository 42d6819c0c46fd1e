/* step.h: stepping for a game loop: how long an iteration lasts, how fast time passes, poses between two iterations. A part of
 * breve.h, whose rules hold here.
 */
#ifndef BREVE_STEP_H
#define BREVE_STEP_H

#include "breve/breve.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- stepping for a game loop ------------------------------------------------------------------------------------ */

/* breve_world_advance runs whole iterations; breve_world_set_paused stops it. The functions here are about what is between:
   none of them is part of images but the length of an iteration, and none runs script. */

/* Set the length of an iteration, from the next one on; a script can also set it. The time that breve_world_advance
   keeps stays as it is.
   @param seconds  finite, > 0
   BREVE_OK; BREVE_ERROR_ARGUMENT. */
BREVE_API breve_status breve_world_set_iteration_step(breve_world* world, double seconds);

/* The longest sub-step, s, see breve_world_config.integration_step. 0 for NULL. */
BREVE_API double breve_world_integration_step(const breve_world* world);

/* Sets it, from the next iteration on; a script can also set it.
   @param seconds  finite, > 0
   BREVE_OK; BREVE_ERROR_ARGUMENT. */
BREVE_API breve_status breve_world_set_integration_step(breve_world* world, double seconds);

/* How much simulated time breve_world_advance takes a second of its argument for. 1 at first; 0 for NULL. */
BREVE_API double breve_world_time_scale(const breve_world* world);

/* @param scale  finite, >= 0: 0.5 is slow motion, 0 stands still
   BREVE_OK; BREVE_ERROR_ARGUMENT. */
BREVE_API breve_status breve_world_set_time_scale(breve_world* world, double scale);

/* Keep where all bodies were before the last iteration, for breve_objects_interpolated, or end that. Off at first; it
   costs a copy of all poses in each iteration. BREVE_OK. */
BREVE_API breve_status breve_world_set_interpolated(breve_world* world, bool on);

/* Is that on? False for NULL. */
BREVE_API bool breve_world_interpolated(const breve_world* world);

/* Where bodies are between the last two iterations: on a straight line, the shortest where space wraps, and turned evenly.
   One that was made since, or that the host has put elsewhere since (breve_object_set_pose, breve_objects_set_property),
   or that is asked about before an iteration was run, is where it is now.
   @param objects   NULL only if count is 0
   @param fraction  from 0, before the last iteration, to 1, now: what breve_world_advance gives
   @param property  BREVE_PROPERTY_LOCATION, _ROTATION or _POSE
   @param array     one row for each object, as of breve_objects_property
   BREVE_OK; BREVE_ERROR_NO_BODY; BREVE_ERROR_ARGUMENT: out of these ranges, or breve_world_set_interpolated is off. */
BREVE_API breve_status breve_objects_interpolated(const breve_world* world, const breve_object* objects, size_t count,
                                                  double fraction, uint32_t property, const breve_array* array);

#ifdef __cplusplus
}
#endif

#endif
