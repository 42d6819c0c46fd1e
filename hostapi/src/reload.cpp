// A changed program in the place of the running one.
#include "internal.hpp"

using namespace breve::host;

namespace {

/// Also unbinds the functions that were bound for a program that the world does not get.
struct UnbindOthers {
  breve_world& world;
  ~UnbindOthers() { unbind_others(world); }
};

}  // namespace

breve_status breve_world_reload(breve_world* world, const breve_program* program) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    need(program, "program");
    need_idle(*world, "breve_world_reload");
    world->recorder.reset();  // its log is of the program of before
    world->references.forget_all();
    const UnbindOthers at_the_end{*world};
    bind_classes(*world, *program->program);
    const auto warnings = world->machine->reload(program->program);
    world->program = program->program;
    for (auto& selector : world->selectors) selector.cls = nullptr;  // what it meant is to be asked anew
    for (const auto& warning : warnings)
      if (const auto& warn = world->machine->host().warn) warn(warning);
  });
}
