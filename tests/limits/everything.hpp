// A run that uses everything, in parts: what a host calls from runtime to destroy.
#pragma once

#include "breve/breve.h"

namespace limits {

/// The live handles, and the position of the first call that failed.
struct Run {
  breve_runtime* runtime = nullptr;
  breve_program* loaded = nullptr;         // by this run
  const breve_program* program = nullptr;  // what its worlds run: `loaded`, or another run's
  breve_world* world = nullptr;
  breve_world* second = nullptr;  // restored from the first one's image
  breve_status status = BREVE_OK;
  const char* call = "";
  const char* file = "";
  int line = 0;
};

// Each goes up to the first call that fails, and is false if one did; what was made stays in `run`. The host's side
// allocates nothing.

bool make_runtime(Run& run);
/// Compile: the program that touches every part of the library, and the one that has all that the compiler knows.
bool load_everything(Run& run);
bool load_grammar(Run& run);
/// Create, step, values, calls, objects with bodies, input, advance.
bool use_world(Run& run);
/// One that is worth an image, and a new one.
bool make_two_worlds(Run& run);
/// Snapshot, hash, restore into the world and into the second one, effects.
bool use_images(Run& run);
/// Shapes, bodies with physics, joints, springs, contacts, and all that reports on them, in a world of the class
/// library.
bool load_library(Run& run);
bool make_library_world(Run& run);
bool use_physics(Run& run);
/// All of it, on a runtime that there is.
bool run_everything(Run& run);
/// Compile, and then create and step: little of each, on a runtime that there is.
bool load_a_little(Run& run);
bool run_a_little(Run& run);

/// Remove the files that the program writes, so that a run finds none of an earlier one's.
void remove_files();
/// Destroy worlds and what was loaded, not the runtime.
void end_run(Run& run);

}  // namespace limits
