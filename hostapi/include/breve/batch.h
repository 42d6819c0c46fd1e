/* batch.h: many worlds of one program, on all cores. A part of breve.h, whose rules hold here.
 */
#ifndef BREVE_BATCH_H
#define BREVE_BATCH_H

#include "breve/breve.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- many worlds ------------------------------------------------------------------------------------------------- */

/* Threads of the host, for breve_batch. Frozen. */
typedef struct breve_jobs {
  void* user;
  /* Makes a thread, possibly the current one, call run(job) once, now or later. */
  void (*enqueue)(void* user, void (*run)(void* job), void* job);
  /* Returns when all enqueued jobs have run. */
  void (*wait)(void* user);
} breve_jobs;

/* The outcome of one world. Frozen. */
typedef struct breve_outcome {
  uint32_t status;     /* breve_status: BREVE_OK, or the reason why it was not created or its last step failed;
                          BREVE_ERROR_INTERRUPTED: it was not started, because a callback ended the batch */
  uint32_t reserved;
  uint64_t iterations; /* that were run */
  double time;         /* simulated, s */
  uint64_t hash;       /* breve_world_hash at its end; 0 unless breve_batch.hashes is set */
} breve_outcome;

/* The worlds of a batch, and how they are run. */
typedef struct breve_batch {
  size_t struct_size;  /* set by breve_batch_default */
  size_t count;        /* number of worlds. Default 0 */
  uint64_t iterations; /* of each world, unless its program ends the simulation earlier; 0: until it does. Default 0 */
  uint64_t first_seed; /* world i gets this seed plus i, unless `prepare` sets another one. Default 1 */
  uint32_t workers;    /* maximum number of threads, 1 to 256; 0: the number of cores. Default 0 */
  bool hashes;         /* compute the hash of each world at its end. Default false */
  bool reserved[3];    /* must be false */
  const breve_world_config* config; /* of all worlds; `seed` is ignored. NULL: the defaults. Default NULL */
  void* user;          /* passed to the callbacks. Default NULL */
  /* Called before world `index` is created. It may change the configuration, which is a copy of the one above with the seed
     of this world. Memory that the fields point to must stay valid until `begin` is called, or `end` if `begin` is not.
     NULL: not called. Default NULL */
  void (*prepare)(void* user, size_t index, breve_world_config* config);
  /* Called after the world was created and its controller's `init` has run, for example to set variables. If it returns
     false, the world ends without a step. NULL: not called. Default NULL */
  bool (*begin)(void* user, size_t index, breve_world* world);
  /* Called after the world has ended; it is destroyed when this returns. `world` is NULL if it could not be created. If it
     returns false, no further world is started. NULL: not called. Default NULL */
  bool (*end)(void* user, size_t index, breve_world* world, const breve_outcome* outcome);
  breve_jobs jobs; /* threads of the host; `workers` is then their number. All NULL: threads of the runtime. Default NULL */
  /* Called before `end` if world `index` could not be created or its last step failed. `error` is valid until it returns.
     NULL: not called. Default NULL */
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

/* Creates, runs and destroys `count` worlds of a program, as many at a time as there are threads, and returns when all have
   ended. The run of each world depends only on its seed, arguments and settings, not on the number of threads. The
   callbacks of a world, and those of the runtime for it, are called by the thread that runs it, several at the same time;
   they may use that world, but not destroy it (BREVE_ERROR_BUSY), and not the runtime. Runs script.
   @param batch     copied
   @param outcomes  room for `count`, by index; may be NULL
   BREVE_OK, also if worlds failed: see `outcomes`; BREVE_ERROR_ARGUMENT: a wrong struct_size, only one of enqueue and wait, a
   reserved field is set, or breve_world_create would refuse `config`. */
BREVE_API breve_status breve_batch_run(breve_runtime* runtime, const breve_program* program, const breve_batch* batch,
                                       breve_outcome* outcomes);

#ifdef __cplusplus
}
#endif

#endif
