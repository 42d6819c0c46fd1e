/* A library without flat worlds and mesh files: calls that need one say so, and the rest works. */
#include <breve/breve.h>
#include <stdio.h>
#include <string.h>

static breve_runtime* runtime;

/* The program is refused with this text; all else is reported. */
static int refuses(const char* text, const char* why) {
  breve_program* program = NULL;
  breve_world* world = NULL;
  if (breve_program_compile(runtime, "left_out.tz", text, strlen(text), &program) != BREVE_OK) return 0;
  const breve_status status = breve_world_create(runtime, program, NULL, &world);
  const breve_error* error = breve_runtime_last_error(runtime);
  const int said = status != BREVE_OK && error && strstr(error->message, why);
  if (!said) printf("status %d: %s\n", (int)status, error ? error->message : "no error");
  breve_world_destroy(world);
  breve_program_destroy(program);
  return said;
}

int main(void) {
  breve_runtime_config config = breve_runtime_config_default();
  if (breve_files_add_directory(".", true, 0, &config.files) != BREVE_OK) return 1; /* for the mesh file */
  const breve_status made = breve_runtime_create(&config, &runtime);
  breve_files_release(&config.files);
  if (made != BREVE_OK) return 1;
  const int flat = refuses("@use PlanarControl.\nController G.\nPlanarControl : G { + to init: new Object. }\n",
                           "BREVE_WITH_PLANAR=OFF");
  const int mesh = refuses(
      "@use Control.\n@use MeshShape.\n@use File.\nController G.\nControl : G {\n + to init:\n f (object).\n"
      " f = new File.\n f open-for-writing with-file \"left_out.obj\".\n f write text \"v 0 0 0\\n\".\n"
      " f close.\n (new MeshShape) load-from-obj file \"left_out.obj\".\n}\n",
      "BREVE_WITH_MESHES=OFF");
  breve_runtime_destroy(runtime);
  remove("left_out.obj");
  return flat && mesh ? 0 : 1;
}
