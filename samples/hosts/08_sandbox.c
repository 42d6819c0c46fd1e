/* A sandbox: programs of strangers, with bounds on memory, work and depth, and no way out. */
#include <breve/breve.h>
#include <stdio.h>
#include <string.h>

/* Each tries something else; none harms the host. */
static const char* const strangers[][2] = {
    {"runs for ever", "Control : Main { + to iterate: while 1: 1. }\n"},
    {"calls itself", "Control : Main { + to fall: self fall. + to iterate: self fall. }\n"},
    {"takes all memory",
     "Control : Main { + variables: hoard (list). + to iterate: while 1: push { 1, 2, 3, 4, 5, 6, 7 } onto hoard. }\n"},
    {"reads a file",
     "@use File.\nControl : Main { + to iterate: print ((new File) open-for-reading with-file \"/etc/passwd\"). }\n"},
    {"runs a command", "Control : Main { + to iterate: print (self execute command \"ls\"). }\n"},
};

/* What a stranger prints. */
static void say(void* user, breve_world* world, breve_channel channel, const char* line, size_t size) {
  (void)user, (void)world;
  if (channel == BREVE_CHANNEL_PRINT) printf("  it prints %.*s", (int)size, line);
}

static void try_one(breve_runtime* runtime, const char* what, const char* body) {
  char text[512];
  breve_program* program = NULL;
  breve_world* world = NULL;
  breve_world_config config = breve_world_config_default();
  config.budget = 100000;         /* loop iterations and calls in one iteration */
  config.memory_limit = 8u << 20; /* bytes */
  config.depth_limit = 200;       /* nested calls */
  snprintf(text, sizeof text, "@use Control.\nController Main.\n%s", body);
  breve_status status = breve_program_compile(runtime, "stranger.tz", text, strlen(text), &program);
  if (status == BREVE_OK) status = breve_world_create(runtime, program, &config, &world);
  if (status == BREVE_OK) status = breve_world_step(world);
  printf("%s: %s\n", what, breve_status_name(status));
  /* The world is whole, whatever happened: it could be stepped, saved or asked now. */
  breve_world_destroy(world);
  breve_program_destroy(program);
}

int main(void) {
  breve_runtime* runtime = NULL;
  /* The defaults give nothing: no files, no commands, no clock. docs/sandbox.md says how to give some. */
  breve_runtime_config config = breve_runtime_config_default();
  config.print = say;
  if (breve_runtime_create(&config, &runtime) != BREVE_OK) return 1;
  for (size_t i = 0; i < sizeof strangers / sizeof *strangers; ++i) try_one(runtime, strangers[i][0], strangers[i][1]);
  return breve_runtime_destroy(runtime) != BREVE_OK;
}
