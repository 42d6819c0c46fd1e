/* What a host does at least: it makes a runtime, compiles a program and steps its world. */
#include <breve/breve.h>
#include <stdio.h>
#include <string.h>

int main(void) {
  const char* agents = "@use Control.\nController Game.\nControl : Game { + to iterate: super iterate. }\n";
  breve_runtime* runtime = NULL;
  breve_program* program = NULL;
  breve_world* world = NULL;
  if (breve_runtime_create(NULL, &runtime) != BREVE_OK) return 1;
  if (breve_program_compile(runtime, "game.tz", agents, strlen(agents), &program) != BREVE_OK) return 1;
  if (breve_world_create(runtime, program, NULL, &world) != BREVE_OK) return 1;
  if (breve_world_step(world) != BREVE_OK) return 1;
  breve_world_destroy(world);
  breve_program_destroy(program);
  breve_runtime_destroy(runtime);
  puts("stepped");
  return 0;
}
