/* Agents in Lua: compile a file, make a world, step it, and read what the agents do, as with any other program. */
#include <stdio.h>
#include <string.h>

#include "breve/breve_lua.h"

static const char* const text =
    "local Walker = breve.class('Walker', 'Mobile')\n"
    "function Walker:init() self.steps = 0 end\n"
    "function Walker:iterate()\n"
    "  self.steps = self.steps + 1\n"
    "  self:set_velocity(breve.vector(self.steps, 0, 0))\n"
    "end\n"
    "function Walker:step_count() return self.steps end\n"
    "local Field = breve.class('Field', 'Control')\n"
    "function Field:init() breve.new(Walker, 3) end\n"
    "breve.main(Field)\n";

static void say(void* user, breve_world* world, breve_channel channel, const char* line, size_t size) {
  (void)user, (void)world, (void)channel;
  fwrite(line, 1, size, stdout);
}

/* Prints why the file was refused. */
static void complain(void* sink, const char* why, size_t size) {
  (void)sink;
  printf("%.*s\n", (int)size, why);
}

static int walk(breve_world* world) {
  breve_object walker;
  breve_value steps;
  breve_pose pose;
  size_t count;
  for (int i = 0; i < 10; ++i)
    if (breve_world_step(world) != BREVE_OK) return 1;
  /* The classes of the file are classes like any other, and so are their methods: step_count is `step-count`. */
  if (breve_world_objects(world, "Walker", &walker, 1, &count) != BREVE_OK ||
      breve_object_call(world, walker, "step-count", NULL, 0, &steps) != BREVE_OK ||
      breve_object_pose(world, walker, &pose) != BREVE_OK)
    return 1;
  printf("%d walkers, %d steps, at %.2f\n", (int)count, (int)steps.as.integer, pose.location[0]);
  return 0;
}

int main(void) {
  breve_runtime_config config = breve_runtime_config_default();
  breve_runtime* runtime = NULL;
  breve_program* program = NULL;
  breve_world* world = NULL;
  int failed = 1;
  config.print = say;
  if (breve_runtime_create(&config, &runtime) == BREVE_OK &&
      breve_lua_compile(runtime, NULL, "field.lua", text, strlen(text), complain, NULL, &program) == BREVE_OK &&
      breve_world_create(runtime, program, NULL, &world) == BREVE_OK)
    failed = walk(world);
  const breve_error* error = world ? breve_world_last_error(world) : breve_runtime_last_error(runtime);
  if (error) printf("%s", error->text);
  breve_world_destroy(world);
  breve_program_destroy(program);
  breve_runtime_destroy(runtime);
  return failed;
}
