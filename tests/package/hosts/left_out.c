/* A library without flat worlds, mesh files and movies with a codec: calls that need one say so, and the rest works. */
#include <breve/breve.h>
#include <breve/view.h>
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

static bool forget(void* user, const void* bytes, size_t size) {
  (void)user, (void)bytes;
  return size > 0;
}

/* A codec is refused with a reason; animated GIF needs none. */
static int makes_gifs_only(void) {
  const uint8_t rgba[4 * 16 * 16] = {0};
  breve_movie_config config = breve_movie_config_default();
  breve_movie* movie = NULL;
  config.width = config.height = 16;
  config.write = forget;
  config.format = "mp4";
  if (breve_movie_create(runtime, &config, &movie) != BREVE_ERROR_UNSUPPORTED) return 0;
  if (!strstr(breve_runtime_last_error(runtime)->message, "BREVE_WITH_MOVIES")) return 0;
  config.format = "gif";
  if (breve_movie_create(runtime, &config, &movie) != BREVE_OK) return 0;
  const int made = breve_movie_add(movie, rgba, 0) == BREVE_OK && breve_movie_finish(movie) == BREVE_OK;
  breve_movie_destroy(movie);
  return made;
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
  const int gif = makes_gifs_only();
  if (!gif) printf("movies\n");
  breve_runtime_destroy(runtime);
  remove("left_out.obj");
  return flat && mesh && gif ? 0 : 1;
}
