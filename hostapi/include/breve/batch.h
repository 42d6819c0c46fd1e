/* batch.h: many worlds of one program, on all cores. A part of breve.h, whose rules hold here.
 */
#ifndef BREVE_BATCH_H
#define BREVE_BATCH_H

#include "breve/breve.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- many worlds ------------------------------------------------------------------------------------------------- */

/* A host's own threads, for breve_batch. Frozen. */
typedef struct breve_jobs {
  void* user;
  /* Let some thread, maybe this one, call run(job) once, now or later. */
  void (*enqueue)(void* user, void (*run)(void* job), void* job);
  /* Return when all that was enqueued has run. */
  void (*wait)(void* user);
} breve_jobs;

/* What became of one world. Frozen. */
typedef struct breve_outcome {
  uint32_t status;     /* breve_status: BREVE_OK, or why it was not made or why its last step failed;
                          BREVE_ERROR_INTERRUPTED: it was not begun, since a callback ended the batch */
  uint32_t reserved;
  uint64_t iterations; /* that it ran */
  double time;         /* simulated, s */
  uint64_t hash;       /* breve_world_hash at its end; 0 unless breve_batch.hashes */
} breve_outcome;

/* Worlds to be run, and how. */
typedef struct breve_batch {
  size_t struct_size;  /* as breve_batch_default gives it */
  size_t count;        /* of worlds. Default 0 */
  uint64_t iterations; /* that each runs, unless its program ends the simulation before; 0: until it does. Default 0 */
  uint64_t first_seed; /* world i has this seed plus i, unless `prepare` gives it another. Default 1 */
  uint32_t workers;    /* threads at most, 1 to 256; 0: as many as there are cores. Default 0 */
  bool hashes;         /* give the hash of each world. Default false */
  bool reserved[3];    /* must be false */
  const breve_world_config* config; /* of all worlds; `seed` is not read. NULL: the defaults. Default NULL */
  void* user;          /* handed to the callbacks. Default NULL */
  /* Before world `index` is made: change its configuration, which is the one above with its seed: arguments, settings.
     What the fields point to must last until `begin` is called, or `end` if that is not. NULL: nothing. Default NULL */
  void (*prepare)(void* user, size_t index, breve_world_config* config);
  /* It is made, and its controller's `init` has run: set variables, say. False: it is ended without a step. NULL: nothing.
     Default NULL */
  bool (*begin)(void* user, size_t index, breve_world* world);
  /* It has ended, and is destroyed when this returns; NULL where it could not be made. False: no further world is begun.
     NULL: nothing. Default NULL */
  bool (*end)(void* user, size_t index, breve_world* world, const breve_outcome* outcome);
  breve_jobs jobs; /* the host's threads, which then count as `workers`; all NULL: threads of the runtime's. Default NULL */
  /* World `index` could not be made, or its last step failed: the reason, before `end` is called. `error` is valid until
     it returns. NULL: nothing. Default NULL */
  void (*failed)(void* user, size_t index, const breve_error* error);
} breve_batch;

/* The defaults named above. */
static inline breve_batch breve_batch_default(void) {
  breve_batch batch;
  breve_clear(&batch, sizeof batch);
  batch.struct_size = sizeof batch;
  batch.first_seed = 1;
  return batch;
}

/* Make, run and destroy `count` worlds of a program, as many at a time as there are threads, and return when all have ended.
   What each world does depends on its seed, arguments and settings alone, not on the number of threads. The callbacks of
   a world, and those of the runtime for it, are called by the thread that runs it, so that several are called at once;
   they may use that world, but not destroy it (BREVE_ERROR_BUSY), and not the runtime. Runs script.
   @param batch     copied
   @param outcomes  room for `count`, by index; may be NULL
   BREVE_OK, also where worlds failed: see `outcomes`; BREVE_ERROR_ARGUMENT: a wrong struct_size, enqueue without wait or wait
   without enqueue, a reserved field, what breve_world_create refuses of `config`. */
BREVE_API breve_status breve_batch_run(breve_runtime* runtime, const breve_program* program, const breve_batch* batch,
                                       breve_outcome* outcomes);

#ifdef __cplusplus
}
#endif

#endif
