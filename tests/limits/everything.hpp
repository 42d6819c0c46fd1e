// One run that uses everything: what a host calls from runtime to destroy, over a program that touches every part.
#pragma once

#include "breve/breve.h"

namespace limits {

/// What is alive, and where the first call that failed stood.
struct Run {
  breve_runtime* runtime = nullptr;
  breve_program* program = nullptr;
  breve_world* world = nullptr;
  breve_world* second = nullptr;  // restored from the first one's image
  breve_status status = BREVE_OK;
  const char* call = "";
  int line = 0;
};

/// All of it, up to the first call that fails; false if one did. What was made stays in `run`. Makes the runtime if
/// there is none. The host's side allocates nothing.
bool run_everything(Run& run);
/// A short one: compile, create, step twice.
bool run_a_little(Run& run);
/// Destroy worlds and program, not the runtime.
void end_run(Run& run);

}  // namespace limits
