/* Versions, statuses, configurations with struct_size, the host's allocator, the life of a runtime. */
#include <stdlib.h>

#include "scene.h"

static void version_and_abi_are_those_of_the_header(void) {
  CHECK(breve_version() != NULL && strchr(breve_version(), '.') != NULL);
  CHECK(breve_abi() == BREVE_ABI);
}

static void every_status_has_its_name(void) {
  CHECK_TEXT("BREVE_OK", breve_status_name(BREVE_OK));
  CHECK_TEXT("BREVE_ERROR_STALE", breve_status_name(BREVE_ERROR_STALE));
  CHECK_TEXT("BREVE_ERROR_NO_BODY", breve_status_name(BREVE_ERROR_NO_BODY));
  for (int i = 1; i < BREVE_ERROR_INTERNAL; ++i)
    CHECK(strcmp("BREVE_ERROR_INTERNAL", breve_status_name((breve_status)i)) != 0);
  CHECK_TEXT("BREVE_ERROR_INTERNAL", breve_status_name((breve_status)12345));
}

static void wrong_struct_sizes_are_refused(void) {
  const size_t wrong[] = {
      0, 3, sizeof(size_t), sizeof(breve_runtime_config) - 1, sizeof(breve_runtime_config) + 8, (size_t)-8};
  for (size_t i = 0; i < sizeof wrong / sizeof *wrong; ++i) {
    breve_runtime_config config = breve_runtime_config_default();
    breve_runtime* runtime = NULL;
    config.struct_size = wrong[i];
    CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_runtime_create(&config, &runtime));
    CHECK(runtime == NULL);
  }
  scene s;
  if (!scene_open(&s)) return;
  breve_world_config config = breve_world_config_default();
  breve_world* world = NULL;
  config.struct_size = sizeof config + 8;
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_world_create(s.runtime, s.program, &config, &world));
  CHECK(strstr(breve_runtime_last_error(s.runtime)->message, "struct_size") != NULL);
  config.struct_size = 1;
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_world_create(s.runtime, s.program, &config, &world));
  breve_stats stats = {0};
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_world_stats(s.world, &stats));
  stats.struct_size = sizeof stats + 8;
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_world_stats(s.world, &stats));
  scene_close(&s);
}

static void a_smaller_struct_of_an_older_header_is_accepted(void) {
  scene s;
  if (!scene_open(&s)) return;
  breve_world_config config = breve_world_config_default();
  breve_world* world = NULL;
  config.struct_size = offsetof(breve_world_config, arguments);
  config.seed = 99;
  config.iteration_step = -1; /* beyond the end of the older struct: not looked at */
  CHECK_STATUS(BREVE_OK, breve_world_create(s.runtime, s.program, &config, &world));
  CHECK(breve_world_seed(world) == 99);
  CHECK_STATUS(BREVE_OK, breve_world_destroy(world));
  breve_stats stats;
  memset(&stats, 0x5a, sizeof stats);
  stats.struct_size = offsetof(breve_stats, objects);
  CHECK_STATUS(BREVE_OK, breve_world_stats(s.world, &stats));
  CHECK(stats.struct_size == offsetof(breve_stats, objects));
  CHECK(stats.iterations == 0);
  CHECK(stats.objects == 0x5a5a5a5a5a5a5a5aULL);
  scene_close(&s);
}

typedef struct ledger {
  size_t live, most, calls;
  bool empty_hands; /* give no more memory */
} ledger;

static void* count_allocation(void* user, size_t size, size_t alignment) {
  ledger* l = user;
  if (l->empty_hands) return NULL;
  ++l->calls;
  l->live += size;
  if (l->live > l->most) l->most = l->live;
  return aligned_alloc(alignment < 16 ? 16 : alignment, (size + 63) / 64 * 64);
}

static void count_release(void* user, void* memory, size_t size, size_t alignment) {
  ledger* l = user;
  (void)alignment;
  l->live -= size;
  free(memory);
}

static void reserved_fields_and_half_an_allocator_are_refused(void) {
  breve_runtime* runtime = NULL;
  breve_runtime_config config = breve_runtime_config_default();
  config.worker_threads = 2;
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_runtime_create(&config, &runtime));
  config = breve_runtime_config_default();
  config.rights = 1u << 20;
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_runtime_create(&config, &runtime));
  config = breve_runtime_config_default();
  config.release = count_release;
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_runtime_create(&config, &runtime));
  scene s;
  if (!scene_open(&s)) return;
  breve_world* world = NULL;
  breve_world_config c = breve_world_config_default();
  c.reserved[3] = true;
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_world_create(s.runtime, s.program, &c, &world));
  c = breve_world_config_default();
  c.integration_step = -0.1;
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_world_create(s.runtime, s.program, &c, &world));
  c = breve_world_config_default();
  c.argument_count = 1;
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_world_create(s.runtime, s.program, &c, &world));
  CHECK(world == NULL);
  scene_close(&s);
}

static void the_hosts_allocator_gives_and_gets_back_all_memory_of_worlds(void) {
  ledger l = {0};
  breve_runtime_config config = breve_runtime_config_default();
  breve_runtime* runtime = NULL;
  breve_program* program = NULL;
  breve_world* world = NULL;
  config.user = &l;
  config.allocate = count_allocation;
  config.release = count_release;
  CHECK_STATUS(BREVE_OK, breve_runtime_create(&config, &runtime));
  CHECK_STATUS(BREVE_OK, breve_program_compile(runtime, "scene.tz", scene_text, strlen(scene_text), &program));
  CHECK_STATUS(BREVE_OK, breve_world_create(runtime, program, NULL, &world));
  for (int i = 0; i < 10; ++i) CHECK_STATUS(BREVE_OK, breve_world_step(world));
  breve_stats stats = breve_stats_default();
  CHECK_STATUS(BREVE_OK, breve_world_stats(world, &stats));
  CHECK(l.calls > 0);
  CHECK(stats.memory_used > 0);
  CHECK(stats.memory_used == l.live);
  CHECK(stats.memory_peak == l.most);
  CHECK_STATUS(BREVE_OK, breve_world_destroy(world));
  CHECK(l.live == 0);
  l.empty_hands = true;
  world = NULL;
  CHECK_STATUS(BREVE_ERROR_MEMORY, breve_world_create(runtime, program, NULL, &world));
  CHECK(world == NULL);
  CHECK(l.live == 0);
  breve_program_destroy(program);
  CHECK_STATUS(BREVE_OK, breve_runtime_destroy(runtime));
}

static void beyond_the_memory_limit_no_world_is_made(void) {
  scene s;
  if (!scene_open(&s)) return;
  breve_world_config config = breve_world_config_default();
  breve_world* world = NULL;
  config.memory_limit = 64;
  CHECK_STATUS(BREVE_ERROR_MEMORY, breve_world_create(s.runtime, s.program, &config, &world));
  CHECK(breve_runtime_last_error(s.runtime)->status == BREVE_ERROR_MEMORY);
  scene_close(&s);
}

static void programs_and_worlds_outlive_the_runtime_handle(void) {
  scene s;
  if (!scene_open(&s)) return;
  CHECK_STATUS(BREVE_OK, breve_runtime_destroy(s.runtime));
  breve_program_destroy(s.program);
  s.runtime = NULL;
  s.program = NULL;
  breve_keyword text = {"text", breve_value_string("still here")};
  CHECK_STATUS(BREVE_OK, breve_object_call(s.world, breve_world_controller(s.world), "say", &text, 1, NULL));
  CHECK_TEXT("still here\n", s.said.print);
  scene_close(&s);
}

static const char* const settings_text =
    "@use Control. Controller Set. Control : Set {\n"
    "  + variables: n, seen (int). x (float). v (vector). s (string). k (list).\n"
    "  + to init: seen = n.\n"
    "}\n";

static void variables_of_the_controller_are_set_before_its_init(void) {
  breve_setting settings[] = {{"n", "-7"}, {"x", "2.5e3"}, {"v", "(1, 2.5, -3)"}, {"s", "7 = seven"}};
  breve_world_config config = breve_world_config_default();
  config.settings = settings;
  config.setting_count = 4;
  scene s;
  if (!scene_open_text(&s, settings_text, &config)) return;
  CHECK(int_of(&s, "n") == -7 && int_of(&s, "seen") == -7);
  CHECK(value_of(&s, "x").as.number == 2500);
  CHECK(value_of(&s, "v").as.vector[1] == 2.5);
  CHECK(strncmp(value_of(&s, "s").as.string.bytes, "7 = seven", 9) == 0);
  const breve_setting wrong[] = {{"nn", "1"}, {"n", "1.5"}, {"n", ""}, {"x", "fast"}, {"v", "1, 2"}, {"k", "{}"}};
  for (size_t i = 0; i < sizeof wrong / sizeof *wrong; ++i) {
    breve_world* world = NULL;
    config.settings = &wrong[i];
    config.setting_count = 1;
    CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_world_create(s.runtime, s.program, &config, &world));
    CHECK(strstr(breve_runtime_last_error(s.runtime)->message, wrong[i].name) != NULL);
    CHECK(world == NULL);
  }
  scene_close(&s);
}

static void what_takes_longer_than_patience_is_told_once_with_its_place(void) {
  breve_world_config config = breve_world_config_default();
  config.patience = 0.01;
  config.budget = 200000000;
  scene s;
  if (!scene_open_text(&s,
                       "@use Control. Controller Long. Control : Long {\n"
                       "  + to go:\n"
                       "    n (int).\n"
                       "    while n < 20000000: n += 1.\n"
                       "}\n",
                       &config))
    return;
  CHECK(s.said.warnings == 0);
  for (int i = 0; i < 2; ++i)
    CHECK_STATUS(BREVE_OK, breve_object_call(s.world, breve_world_controller(s.world), "go", NULL, 0, NULL));
  CHECK(s.said.warnings == 1);
  CHECK(strstr(s.said.warning, ":4:") != NULL);
  config.patience = -1;
  breve_world* world = NULL;
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_world_create(s.runtime, s.program, &config, &world));
  scene_close(&s);
}

static void two_runtimes_share_nothing(void) {
  scene a, b;
  if (!scene_open(&a) || !scene_open(&b)) return;
  breve_keyword text = {"text", breve_value_string("to a")};
  CHECK_STATUS(BREVE_OK, breve_object_call(a.world, breve_world_controller(a.world), "say", &text, 1, NULL));
  CHECK_TEXT("to a\n", a.said.print);
  CHECK_TEXT("", b.said.print);
  CHECK_STATUS(BREVE_OK, breve_world_step(a.world));
  CHECK(breve_world_iteration(a.world) == 1);
  CHECK(breve_world_iteration(b.world) == 0);
  CHECK_STATUS(BREVE_ERROR_NOT_FOUND,
               breve_object_call(a.world, breve_world_controller(a.world), "fly", NULL, 0, NULL));
  CHECK(breve_world_last_error(b.world) == NULL);
  scene_close(&a);
  CHECK_STATUS(BREVE_OK, breve_world_step(b.world));
  scene_close(&b);
}

void config_suite(void) {
  RUN(version_and_abi_are_those_of_the_header);
  RUN(every_status_has_its_name);
  RUN(wrong_struct_sizes_are_refused);
  RUN(a_smaller_struct_of_an_older_header_is_accepted);
  RUN(reserved_fields_and_half_an_allocator_are_refused);
  RUN(the_hosts_allocator_gives_and_gets_back_all_memory_of_worlds);
  RUN(beyond_the_memory_limit_no_world_is_made);
  RUN(programs_and_worlds_outlive_the_runtime_handle);
  RUN(two_runtimes_share_nothing);
  RUN(variables_of_the_controller_are_set_before_its_init);
  RUN(what_takes_longer_than_patience_is_told_once_with_its_place);
}
