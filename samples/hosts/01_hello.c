/* The smallest host: a world in ten lines. Errors are left out; 03_host_function.c shows them. */
#include <breve/breve.h>
#include <stdio.h>
#include <string.h>

static const char* const text =
    "@use Control.\nController Hello.\nControl : Hello { + to iterate: print \"hello at \", (self get-time). super "
    "iterate. }\n";

static void say(void* user, breve_world* world, breve_channel channel, const char* line, size_t size) {
  (void)user, (void)world, (void)channel;
  fwrite(line, 1, size, stdout);
}

int main(void) {
  breve_runtime_config config = breve_runtime_config_default();
  breve_runtime* runtime = NULL;
  breve_program* program = NULL;
  breve_world* world = NULL;
  config.print = say;
  breve_runtime_create(&config, &runtime);
  breve_program_compile(runtime, "hello.tz", text, strlen(text), &program);
  breve_world_create(runtime, program, NULL, &world);
  for (int i = 0; i < 3; ++i) breve_world_step(world);
  breve_world_destroy(world);
  breve_program_destroy(program);
  return breve_runtime_destroy(runtime) != BREVE_OK;
}
