/* Grids of cells: the array of a chemical, read and written as a whole by a host. */
#include <math.h>

#include "scene.h"

static const char* const text =
    "@use Control.\n@use PatchGrid.\nController Broth.\n"
    "Control : Broth {\n"
    "\t+ variables: grid, sugar, salt (object).\n"
    "\t+ to init:\n"
    "\t\tgrid = ((new PatchGrid) init-with x-count 3 y-count 2 z-count 2).\n"
    "\t\tsugar = ((new PatchChemical) init-with diffusion-rate 0.1 decay-rate 0.0).\n"
    "\t\tsalt = (new PatchChemical).\n"
    "\t\tgrid track patch-chemical sugar.\n"
    "\t\tgrid set-concentration of sugar at-x 2 at-y 1 at-z 0 to 5.\n"
    "\t+ to stir:\n"
    "\t\tgrid diffuse-chemicals.\n"
    "\t\tgrid apply-rule times 2.\n"
    "\t+ to get-middle:\n"
    "\t\treturn (grid get-concentration of sugar at-x 1 at-y 0 at-z 1).\n"
    "}\n";

static breve_object variable(scene* s, const char* name) {
  breve_value value = breve_value_null();
  CHECK_STATUS(BREVE_OK, breve_object_get(s->world, breve_world_controller(s->world), name, &value));
  return value.as.object;
}

static bool open_broth(scene* s) {
  memset(s, 0, sizeof *s);
  breve_runtime_config runtime = breve_runtime_config_default();
  runtime.user = &s->said;
  runtime.print = remember;
  return CHECK_STATUS(BREVE_OK, breve_runtime_create(&runtime, &s->runtime)) &&
         CHECK_STATUS(BREVE_OK, breve_program_compile(s->runtime, "broth.tz", text, strlen(text), &s->program)) &&
         CHECK_STATUS(BREVE_OK, breve_world_create(s->runtime, s->program, NULL, &s->world));
}

static void a_chemical_is_read_and_written_as_a_whole(void) {
  scene s;
  if (!open_broth(&s)) return;
  const breve_object grid = variable(&s, "grid"), sugar = variable(&s, "sugar");
  uint32_t counts[3] = {0, 0, 0};
  CHECK_STATUS(BREVE_OK, breve_grid_size(s.world, grid, counts));
  CHECK(counts[0] == 3 && counts[1] == 2 && counts[2] == 2);
  double values[12];
  size_t count = 0;
  CHECK_STATUS(BREVE_OK, breve_grid_concentrations(s.world, grid, sugar, NULL, 0, &count));
  CHECK(count == 12);
  CHECK_STATUS(BREVE_OK, breve_grid_concentrations(s.world, grid, sugar, values, 12, &count));
  for (size_t i = 0; i < 12; ++i) CHECK(values[i] == (i == (2 * 2 + 1) * 2 ? 5 : 0));
  for (size_t i = 0; i < 12; ++i) values[i] = 0.5 * (double)i;
  CHECK_STATUS(BREVE_OK, breve_grid_set_concentrations(s.world, grid, sugar, values, 12));
  breve_value middle;
  CHECK_STATUS(BREVE_OK, breve_object_call(s.world, breve_world_controller(s.world), "get-middle", NULL, 0, &middle));
  CHECK_NEAR(0.5 * ((1 * 2 + 0) * 2 + 1), middle.as.number, 0);
  double few[3] = {-1, -1, -1};
  CHECK_STATUS(BREVE_OK, breve_grid_concentrations(s.world, grid, sugar, few, 2, &count));
  CHECK(count == 12 && few[0] == 0 && few[1] == 0.5 && few[2] == -1);
  scene_close(&s);
}

static void what_cannot_be_is_an_error_and_changes_nothing(void) {
  scene s;
  if (!open_broth(&s)) return;
  const breve_object grid = variable(&s, "grid"), sugar = variable(&s, "sugar"), salt = variable(&s, "salt");
  const breve_object nobody = {0, 0};
  uint32_t counts[3];
  double values[12] = {1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, NAN};
  size_t count = 0;
  uint64_t before = 0, after = 0;
  CHECK_STATUS(BREVE_OK, breve_world_hash(s.world, &before));
  CHECK_STATUS(BREVE_ERROR_NOT_FOUND, breve_grid_size(s.world, sugar, counts));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_grid_size(s.world, nobody, counts));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_grid_size(s.world, grid, NULL));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_grid_size(NULL, grid, counts));
  CHECK_STATUS(BREVE_ERROR_NOT_FOUND, breve_grid_concentrations(s.world, grid, salt, values, 12, &count));
  CHECK(strstr(breve_world_last_error(s.world)->message, "track") != NULL);
  CHECK_STATUS(BREVE_ERROR_NOT_FOUND, breve_grid_concentrations(s.world, salt, sugar, values, 12, &count));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_grid_concentrations(s.world, grid, sugar, NULL, 1, &count));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_grid_concentrations(s.world, grid, sugar, values, 12, NULL));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_grid_set_concentrations(s.world, grid, sugar, values, 12));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_grid_set_concentrations(s.world, grid, sugar, values, 11));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_grid_set_concentrations(s.world, grid, sugar, NULL, 12));
  CHECK_STATUS(BREVE_ERROR_NOT_FOUND, breve_grid_set_concentrations(s.world, grid, salt, values, 12));
  CHECK_STATUS(BREVE_OK, breve_world_hash(s.world, &after));
  CHECK(before == after);
  CHECK_STATUS(BREVE_OK, breve_object_free(s.world, grid));
  CHECK_STATUS(BREVE_ERROR_STALE, breve_grid_concentrations(s.world, grid, sugar, values, 12, &count));
  scene_close(&s);
}

static breve_effect effect_named(scene* s, const char* name) {
  breve_effect effects[64];
  size_t count = 0;
  CHECK_STATUS(BREVE_OK, breve_world_effects(s->world, effects, 64, &count));
  for (size_t i = 0; i < count && i < 64; ++i)
    if (strcmp(effects[i].name, name) == 0) return effects[i];
  CHECK(!"there is such an effect");
  return effects[0];
}

static void patches_and_diffusion_are_effects(void) {
  scene s;
  if (!open_broth(&s)) return;
  const breve_object grid = variable(&s, "grid");
  CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  breve_effect patches = effect_named(&s, "patches"), diffusion = effect_named(&s, "diffusion");
  CHECK(patches.active && patches.asked_by.index == grid.index && patches.asked_by.generation == grid.generation);
  CHECK(patches.items == 0 && patches.calls == 0 && !diffusion.active);
  CHECK_STATUS(BREVE_OK, breve_object_call(s.world, breve_world_controller(s.world), "stir", NULL, 0, NULL));
  patches = effect_named(&s, "patches");
  diffusion = effect_named(&s, "diffusion");
  CHECK(patches.items == 24 && patches.calls == 2 && patches.seconds > 0);
  CHECK(diffusion.active && diffusion.items == 12 && diffusion.calls == 1 && diffusion.seconds > 0);
  CHECK_TEXT("Matrix3D", breve_object_class(s.world, diffusion.asked_by));
  CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  CHECK(effect_named(&s, "diffusion").items == 0);
  scene_close(&s);
}

void grids_suite(void) {
  RUN(a_chemical_is_read_and_written_as_a_whole);
  RUN(patches_and_diffusion_are_effects);
  RUN(what_cannot_be_is_an_error_and_changes_nothing);
}
