/* Plugins: programs name shared libraries that bring functions and classes of their own. This host lets programs load
   the libraries that lie in one directory, given on the command line, and refuses all others. */
#include <stdio.h>
#include <string.h>

#include "breve/breve.h"

static const char* const text =
    "@use Control.\n"
    "@plugin \"noise.so\"(noise).\n"           /* smoothNoise(x, y), in C */
    "@plugin \"statistics.so\"(statistics).\n" /* class Statistics, in C++ */
    "Controller Survey.\n"
    "Control : Survey {\n"
    "  + variables: heights (object).\n"
    "  + to init: heights = new Statistics.\n"
    "  + to iterate:\n"
    "    heights add value smoothNoise((self get-time) * 3, 0.5).\n"
    "    super iterate.\n"
    "  + to report:\n"
    "    mean (float).\n"
    "    mean = heights get-mean.\n"
    "    print \"the mean height is $mean\".\n"
    "}\n";

static void say(void* user, breve_world* world, breve_channel channel, const char* line, size_t size) {
  (void)user, (void)world, (void)channel;
  fwrite(line, 1, size, stdout);
}

/* A program names a library by its file name alone; nothing outside the directory can be loaded. */
static bool open_plugin(void* user, const char* file, const char* entry, const char* from, breve_plugin* plugin,
                        breve_write_fn reason, void* sink) {
  char path[1024];
  (void)from;
  if (strchr(file, '/')) {
    reason(sink, "it is not in the plugin directory", strlen("it is not in the plugin directory"));
    return false;
  }
  snprintf(path, sizeof path, "%s/%s", (const char*)user, file);
  return breve_plugin_open(path, entry, plugin, reason, sink) == BREVE_OK;
}

static int survey(breve_world* world) {
  breve_value ignored;
  for (int i = 0; i < 100; ++i)
    if (breve_world_step(world) != BREVE_OK) return 1;
  return breve_object_call(world, breve_world_controller(world), "report", NULL, 0, &ignored) != BREVE_OK;
}

int main(int argc, char** argv) {
  breve_runtime_config config = breve_runtime_config_default();
  breve_runtime* runtime = NULL;
  breve_program* program = NULL;
  breve_world* world = NULL;
  int failed = 1;
  if (argc != 2) {
    fprintf(stderr, "usage: %s DIRECTORY-OF-PLUGINS\n", argv[0]);
    return 2;
  }
  config.user = argv[1];
  config.print = say;
  config.open_plugin = open_plugin;
  if (breve_runtime_create(&config, &runtime) == BREVE_OK &&
      breve_program_compile(runtime, "survey.tz", text, strlen(text), &program) == BREVE_OK &&
      breve_world_create(runtime, program, NULL, &world) == BREVE_OK)
    failed = survey(world);
  const breve_error* error = world ? breve_world_last_error(world) : breve_runtime_last_error(runtime);
  if (error) fprintf(stderr, "%s", error->text);
  breve_world_destroy(world);
  breve_program_destroy(program);
  breve_runtime_destroy(runtime);
  return failed;
}
