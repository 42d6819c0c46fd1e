/* record.h: a log of everything that a world gets from outside, and replays of it. A part of breve.h, whose rules hold
 * here.
 *
 * A log begins with a snapshot. It then holds, for each iteration: what the host changed since the last one, by
 * whatever function of this header (writes, calls, keys, clicks, a restored snapshot); what scripts received from
 * outside during the iteration (bytes of files, the real-time clock, entropy, output of commands); and the hash of the
 * world at its end. A replay runs the same iterations, gives scripts what the log holds, and compares the hashes.
 */
#ifndef BREVE_RECORD_H
#define BREVE_RECORD_H

#include "breve/breve.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- record and replay ------------------------------------------------------------------------------------------- */

/* Records the world from now on. Takes a snapshot at once, two hashes for each iteration, and another snapshot in each
   iteration that the host has changed the world before; only the difference to the one before it is written. With a
   Box2D world the first snapshot changes the rest of the run slightly, as breve_world_snapshot does.
   @param write  called with `sink` and the next bytes of the log, after each iteration; it may not call the library. A
                 log that ends early, because the process did, can be replayed up to its last whole iteration
   BREVE_OK; BREVE_ERROR_BUSY while a script of it runs, or during a replay; BREVE_ERROR_ARGUMENT: `write` is NULL, or
   the world is being recorded; BREVE_ERROR_UNSUPPORTED: a state of the host cannot be saved. */
BREVE_API breve_status breve_world_record_start(breve_world* world, breve_write_fn write, void* sink);

/* Ends the log. Does nothing if the world is not being recorded. What the host changed since the last iteration is not
   in it. BREVE_OK; BREVE_ERROR_BUSY while a script of it runs. */
BREVE_API breve_status breve_world_record_stop(breve_world* world);

/* Is the world being recorded? False for NULL. */
BREVE_API bool breve_world_recording(const breve_world* world);

/* For functions and classes of the host that read something outside the world, such as a sensor, during an iteration:
   while the world is recorded, the bytes go to the log; in a replay they are replaced by the bytes of the log.
   Otherwise nothing happens. Between iterations it is not needed, and does nothing.
   @param bytes  `size` bytes; NULL only if size is 0
   BREVE_OK; BREVE_ERROR_IMAGE in a replay: the log has no such bytes here, or another number of them: the run has taken
   another course. */
BREVE_API breve_status breve_world_record_input(breve_world* world, void* bytes, size_t size);

/* The result of a replay. Frozen. */
typedef struct breve_replay {
  uint64_t iterations;    /* of the log that were run; the one that differs is the last of them */
  uint64_t iteration;     /* breve_world_iteration at the end of the last one */
  uint64_t hash;          /* of the world at its end */
  uint64_t recorded_hash; /* that the log has for it */
  bool differs;           /* the last iteration does not have the hash that was recorded, or did not end as recorded */
  bool complete;          /* the log was recorded to its end, by breve_world_record_stop, and replayed to its end */
  bool reserved[6];
} breve_replay;

/* Restores the snapshot at the beginning of a log and runs its iterations, up to the first one that differs from the
   recorded run. Runs script. Files are neither read nor written, `sleep` does not wait, and the system's clock, entropy
   and commands are not asked: scripts get what the log holds. What the world prints is printed again. Functions and
   classes of the host run again; breve_world_record_input covers what they read from outside.
   @param world   of the same program, made with the same configuration, with the same states of the host
   @param log     `size` bytes
   @param after   called after each iteration; it may look at the world but not change it. Returns false to end the
                  replay. May be NULL
   @param replay  the result
   BREVE_OK, whether the runs agree or not: see `replay`; BREVE_ERROR_IMAGE: not a log, a damaged one, or one of another
   program or version; BREVE_ERROR_BUSY while a script of the world runs; BREVE_ERROR_ARGUMENT: the world is being
   recorded. */
BREVE_API breve_status breve_world_replay(breve_world* world, const void* log, size_t size,
                                          bool (*after)(void* user, breve_world* world), void* user,
                                          breve_replay* replay);

#ifdef __cplusplus
}
#endif

#endif
