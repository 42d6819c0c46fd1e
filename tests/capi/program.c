/* Compilation: from memory, through the host's modules, and what the compiler has to say. */
#include "scene.h"

static breve_status compile(breve_runtime* runtime, const char* text, breve_program** program) {
  return breve_program_compile(runtime, "made.tz", text, strlen(text), program);
}

static breve_runtime* plain_runtime(void) {
  breve_runtime* runtime = NULL;
  CHECK_STATUS(BREVE_OK, breve_runtime_create(NULL, &runtime));
  return runtime;
}

static void a_program_knows_its_classes_parents_first(void) {
  scene s;
  if (!scene_open(&s)) return;
  const size_t count = breve_program_class_count(s.program);
  bool ball = false, mobile = false, root = false;
  for (size_t i = 0; i < count; ++i) {
    breve_class_info info;
    CHECK_STATUS(BREVE_OK, breve_program_class(s.program, i, &info));
    if (strcmp(info.name, "Mobile") == 0) mobile = true;
    if (strcmp(info.name, "Object") == 0) root = info.parent[0] == '\0';
    if (strcmp(info.name, "Ball") == 0) {
      ball = true;
      CHECK(mobile);
      CHECK_TEXT("Mobile", info.parent);
      CHECK_TEXT("Balls", info.alias);
    }
  }
  CHECK(ball && root);
  breve_class_info info;
  CHECK_STATUS(BREVE_ERROR_NOT_FOUND, breve_program_class(s.program, count, &info));
  scene_close(&s);
}

static void every_error_of_a_program_is_a_diagnostic_with_its_place(void) {
  breve_runtime* runtime = plain_runtime();
  breve_program* program = NULL;
  const char* text =
      "@use Control.\n"
      "Controller Bad.\n"
      "Control : Bad {\n"
      "  + to init:\n"
      "    nowhere = 3.\n"
      "    print nothing.\n"
      "}\n";
  CHECK_STATUS(BREVE_ERROR_COMPILE, compile(runtime, text, &program));
  CHECK(program == NULL);
  CHECK(breve_runtime_last_error(runtime)->status == BREVE_ERROR_COMPILE);
  size_t errors = 0;
  for (size_t i = 0; i < breve_runtime_diagnostic_count(runtime); ++i) {
    breve_diagnostic d;
    CHECK_STATUS(BREVE_OK, breve_runtime_diagnostic(runtime, i, &d));
    if (d.severity != BREVE_SEVERITY_ERROR) continue;
    ++errors;
    CHECK_TEXT("made.tz", d.file);
    CHECK(d.line == 4 + errors);
    CHECK(d.column > 0 && d.length > 0);
    CHECK(d.code[0] != '\0' && d.message[0] != '\0');
    CHECK(strstr(d.text, "made.tz:") != NULL && strchr(d.text, '^') != NULL);
    CHECK(d.text[strlen(d.text) - 1] == '\n');
  }
  CHECK(errors == 2);
  breve_diagnostic d;
  CHECK_STATUS(BREVE_ERROR_NOT_FOUND, breve_runtime_diagnostic(runtime, breve_runtime_diagnostic_count(runtime), &d));
  CHECK_STATUS(BREVE_OK, compile(runtime, scene_text, &program)); /* the runtime is as good as new */
  breve_program_destroy(program);
  CHECK_STATUS(BREVE_OK, breve_runtime_destroy(runtime));
}

static void rubbish_is_an_error_and_never_a_crash(void) {
  breve_runtime* runtime = plain_runtime();
  breve_program* program = NULL;
  char bytes[4096];
  unsigned state = 12345;
  for (size_t i = 0; i < sizeof bytes; ++i) bytes[i] = (char)((state = state * 1103515245U + 12345U) >> 16);
  CHECK_STATUS(BREVE_ERROR_COMPILE, breve_program_compile(runtime, "noise", bytes, sizeof bytes, &program));
  CHECK_STATUS(BREVE_ERROR_COMPILE, breve_program_compile(runtime, "nothing", NULL, 0, &program));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_program_compile(runtime, "nothing", NULL, 5, &program));
  CHECK(program == NULL);
  CHECK_STATUS(BREVE_OK, breve_runtime_destroy(runtime));
}

/* A host that keeps its modules in memory. */
typedef struct shelf {
  int asked, released, paths;
  char last_from[64], last_path[64];
} shelf;

static const char main_module[] =
    "@path \"some/where\".\n@include \"part.tz\".\nController Main.\nControl : Main { + to init: print ((new Part) "
    "get). "
    "}\n";
static const char part_module[] = "@use Control.\nObject : Part { + to get: return 42. }\n";

static bool find_module(void* user, const char* name, const char* from, breve_module* module) {
  shelf* s = user;
  CHECK(module->text == NULL && module->size == 0 && module->cookie == NULL);
  ++s->asked;
  if (strcmp(name, "main.tz") == 0) {
    module->name = "shelf/main.tz";
    module->text = main_module;
    module->size = sizeof main_module - 1;
  } else if (strcmp(name, "part.tz") == 0) {
    snprintf(s->last_from, sizeof s->last_from, "%s", from);
    module->text = part_module;
    module->size = sizeof part_module - 1;
  } else {
    return false;
  }
  module->cookie = s;
  return true;
}

static void release_module(void* user, const breve_module* module) {
  shelf* s = user;
  CHECK(module->cookie == user);
  ++s->released;
}

static void add_path(void* user, const char* directory) {
  shelf* s = user;
  ++s->paths;
  snprintf(s->last_path, sizeof s->last_path, "%s", directory);
}

static void modules_come_from_the_host(void) {
  shelf s = {0};
  breve_runtime_config config = breve_runtime_config_default();
  config.user = &s;
  config.resolve_module = find_module;
  config.release_module = release_module;
  config.add_path = add_path;
  breve_runtime* runtime = NULL;
  breve_program* program = NULL;
  breve_world* world = NULL;
  CHECK_STATUS(BREVE_OK, breve_runtime_create(&config, &runtime));
  CHECK_STATUS(BREVE_OK, breve_program_load(runtime, "main.tz", &program));
  CHECK_TEXT("shelf/main.tz", s.last_from);
  CHECK_TEXT("some/where", s.last_path);
  CHECK(s.paths == 1);
  CHECK(s.released == 2);
  CHECK_STATUS(BREVE_OK, breve_world_create(runtime, program, NULL, &world));
  CHECK_STATUS(BREVE_OK, breve_world_destroy(world));
  breve_program_destroy(program);
  program = NULL;
  CHECK_STATUS(BREVE_ERROR_FILE, breve_program_load(runtime, "absent.tz", &program));
  CHECK(strstr(breve_runtime_last_error(runtime)->message, "absent.tz") != NULL);
  CHECK(program == NULL);
  CHECK_STATUS(BREVE_OK, breve_runtime_destroy(runtime));
}

static void without_a_resolver_only_the_class_library_can_be_used(void) {
  breve_runtime* runtime = plain_runtime();
  breve_program* program = NULL;
  CHECK_STATUS(BREVE_ERROR_FILE, breve_program_load(runtime, "main.tz", &program));
  CHECK_STATUS(BREVE_ERROR_COMPILE,
               compile(runtime, "@use Control.\n@include \"x.tz\".\nController Control.\n", &program));
  CHECK_STATUS(BREVE_OK, breve_runtime_destroy(runtime));
}

static void compile_again(void* user) {
  breve_runtime* runtime = *(breve_runtime**)user;
  breve_program* program = NULL;
  CHECK_STATUS(BREVE_ERROR_BUSY, compile(runtime, scene_text, &program));
  CHECK_STATUS(BREVE_ERROR_BUSY, breve_runtime_destroy(runtime));
}

static bool resolve_by_compiling(void* user, const char* name, const char* from, breve_module* module) {
  (void)name, (void)from, (void)module;
  compile_again(user);
  return false;
}

static void a_module_callback_may_not_compile_nor_destroy(void) {
  breve_runtime* runtime = NULL;
  breve_program* program = NULL;
  breve_runtime_config config = breve_runtime_config_default();
  config.user = &runtime;
  config.resolve_module = resolve_by_compiling;
  CHECK_STATUS(BREVE_OK, breve_runtime_create(&config, &runtime));
  CHECK_STATUS(BREVE_OK, compile(runtime, scene_text, &program));
  breve_program_destroy(program);
  CHECK_STATUS(BREVE_OK, breve_runtime_destroy(runtime));
}

void program_suite(void) {
  RUN(a_program_knows_its_classes_parents_first);
  RUN(every_error_of_a_program_is_a_diagnostic_with_its_place);
  RUN(rubbish_is_an_error_and_never_a_crash);
  RUN(modules_come_from_the_host);
  RUN(without_a_resolver_only_the_class_library_can_be_used);
  RUN(a_module_callback_may_not_compile_nor_destroy);
}
