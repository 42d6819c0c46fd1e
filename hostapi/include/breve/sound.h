/* sound.h: what a world plays. A part of breve.h, whose rules hold here.
 *
 * Sounds and tones of scripts are state of the world, as positions are. The host asks for as many frames as it needs
 * and hands them to its audio device; a world that nobody listens to computes no sound.
 */
#ifndef BREVE_SOUND_H
#define BREVE_SOUND_H

#include "breve/breve.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- sound ------------------------------------------------------------------------------------------------------- */

/* Computes what the Sound and Tone objects of a world play, as they are now. After each iteration a host asks for the
   frames from breve_world_time to the end of the next iteration. The call changes nothing and can be repeated. Runs no
   script.
   @param time    of the first frame, simulated s. A sound that began later is silent until it begins
   @param rate    frames per second, from 1000 to 1e6
   @param samples left and right of each frame, 2 * frame_count numbers, which are overwritten: the sum of all sounds,
                  from -1 to 1. NULL only if frame_count is 0
   BREVE_OK; BREVE_ERROR_ARGUMENT: a time or rate that is not finite or out of range. */
BREVE_API breve_status breve_world_sound(const breve_world* world, double time, double rate, float* samples,
                                         size_t frame_count);

#ifdef __cplusplus
}
#endif

#endif
