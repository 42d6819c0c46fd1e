/* Plugins: who may load them, what they add and to whom, what is said of those that fail, and when they are closed. */
#include "scene.h"

/* What the host was asked for, and what it answers. */
typedef struct opener {
  int asked, closed, calls;
  bool refuses, gives_reason, gives_no_entry;
  char file[64], entry[64], from[64];
  breve_plugin_fn entry_function;
} opener;

static void close_plugin(void* library) { ++((opener*)library)->closed; }

static bool open_plugin(void* user, const char* file, const char* entry, const char* from, breve_plugin* plugin,
                        breve_write_fn reason, void* sink) {
  opener* o = user;
  ++o->asked;
  snprintf(o->file, sizeof o->file, "%s", file);
  snprintf(o->entry, sizeof o->entry, "%s", entry);
  snprintf(o->from, sizeof o->from, "%s", from);
  if (o->gives_reason) reason(sink, "it is Sunday", 12);
  if (o->refuses) return false;
  plugin->entry = o->gives_no_entry ? NULL : o->entry_function;
  plugin->library = o;
  plugin->close = close_plugin;
  return true;
}

static breve_status twice(void* user, const breve_call* call, breve_value* result) {
  (void)user;
  *result = breve_value_int(2 * call->arguments[0].as.integer);
  return BREVE_OK;
}

static breve_status add_twice(breve_runtime* runtime) {
  static const uint32_t one_int[] = {BREVE_TYPE_INT};
  breve_function f = breve_function_default();
  f.name = "twice";
  f.parameters = one_int;
  f.parameter_count = 1;
  f.result = BREVE_TYPE_INT;
  f.call = twice;
  return breve_runtime_add_function(runtime, &f);
}

static breve_status legs_of(void* user, const breve_call* call, breve_value* result) {
  (void)user;
  return breve_object_get(call->world, call->self, "legs", result);
}

static breve_status add_tripod(breve_runtime* runtime) {
  static const breve_method methods[] = {{"has-legs", NULL, NULL, 0, BREVE_TYPE_INT, false, {false}, legs_of, NULL}};
  static const breve_variable variables[] = {{"legs", BREVE_TYPE_INT, 0}};
  breve_class c = breve_class_default();
  c.name = "Tripod";
  c.variables = variables;
  c.variable_count = 1;
  c.methods = methods;
  c.method_count = 1;
  return breve_runtime_add_class(runtime, &c);
}

BREVE_PLUGIN(good_entry, runtime) {
  const breve_status status = add_twice(runtime);
  return status == BREVE_OK ? add_tripod(runtime) : status;
}
BREVE_PLUGIN(entry_that_repeats, runtime) {
  const breve_status status = add_twice(runtime);
  return status == BREVE_OK ? add_twice(runtime) : status;
}
BREVE_PLUGIN(entry_that_compiles, runtime) {
  breve_program* program;
  return breve_program_compile(runtime, "x", "", 0, &program);
}
static breve_status entry_for_another_abi(breve_runtime* runtime, uint32_t abi) { return good_entry(runtime, abi + 1); }

static const char* const text =
    "@use Control.\n@plugin \"tools\"(start).\nController Shop.\n"
    "Control : Shop { + to try: return twice(6) * ((new Stool) has-legs) + twice(3). }\n"
    "Tripod : Stool { + to init: legs = 3. }\n";
static const char* const simple =
    "@use Control.\n@plugin \"tools\"(start).\nController Shop.\nControl : Shop { + to try: return twice(21). }\n";

static breve_runtime* runtime_with(opener* o) {
  breve_runtime_config config = breve_runtime_config_default();
  breve_runtime* runtime = NULL;
  config.user = o;
  config.open_plugin = open_plugin;
  CHECK_STATUS(BREVE_OK, breve_runtime_create(&config, &runtime));
  return runtime;
}

static breve_status compile(breve_runtime* runtime, const char* program_text, breve_program** program) {
  return breve_program_compile(runtime, "shop.tz", program_text, strlen(program_text), program);
}

/* The message of the one error that the compilation gave. */
static void check_refused(breve_runtime* runtime, const char* program_text, const char* message) {
  breve_program* program = NULL;
  breve_diagnostic d;
  CHECK_STATUS(BREVE_ERROR_COMPILE, compile(runtime, program_text, &program));
  CHECK(breve_runtime_diagnostic_count(runtime) >= 1);
  CHECK_STATUS(BREVE_OK, breve_runtime_diagnostic(runtime, 0, &d));
  CHECK_TEXT("plugin", d.code);
  CHECK_TEXT(message, d.message);
  CHECK(d.line == 2);
}

static int try_program(breve_runtime* runtime, breve_program* program) {
  breve_world* world = NULL;
  breve_value value = breve_value_int(0);
  CHECK_STATUS(BREVE_OK, breve_world_create(runtime, program, NULL, &world));
  CHECK_STATUS(BREVE_OK, breve_object_call(world, breve_world_controller(world), "try", NULL, 0, &value));
  CHECK_STATUS(BREVE_OK, breve_world_destroy(world));
  return value.as.integer;
}

static void without_a_callback_a_plugin_is_an_error_of_the_program(void) {
  breve_runtime* runtime = NULL;
  CHECK_STATUS(BREVE_OK, breve_runtime_create(NULL, &runtime));
  check_refused(runtime, simple, "cannot load plugin 'tools': the host does not allow plugins");
  breve_runtime_destroy(runtime);
}

static void a_plugin_adds_functions_and_classes_to_the_programs_that_name_it(void) {
  opener o = {.entry_function = good_entry};
  breve_runtime* runtime = runtime_with(&o);
  breve_program *program = NULL, *second = NULL, *other = NULL;
  const char* stranger = "@use Control.\nController Shop.\nControl : Shop { + to try: return twice(21). }\n";
  if (!CHECK_STATUS(BREVE_OK, compile(runtime, text, &program))) printf("%s", breve_runtime_last_error(runtime)->text);
  CHECK_TEXT("tools", o.file);
  CHECK_TEXT("start", o.entry);
  CHECK_TEXT("shop.tz", o.from);
  CHECK(try_program(runtime, program) == 42);
  CHECK_STATUS(BREVE_OK, compile(runtime, simple, &second));
  CHECK(o.asked == 1); /* both programs share it */
  CHECK(try_program(runtime, second) == 42);
  CHECK_STATUS(BREVE_ERROR_COMPILE, compile(runtime, stranger, &other)); /* one that does not name it knows nothing */
  breve_program_destroy(second);
  breve_runtime_destroy(runtime);
  CHECK(o.closed == 0); /* a program still has its code */
  breve_program_destroy(program);
  CHECK(o.closed == 1);
}

static void destroy_data(void* user) {
  opener* o = user;
  CHECK(o->closed == 0);
  ++o->calls;
}

static void a_world_keeps_plugins_open_even_if_its_program_no_longer_names_them(void) {
  opener o = {.entry_function = good_entry};
  breve_runtime* runtime = runtime_with(&o);
  breve_program *program = NULL, *without = NULL;
  breve_world* world = NULL;
  const char* plain = "@use Control.\nController Shop.\nControl : Shop { + to try: return 1. }\n";
  CHECK_STATUS(BREVE_OK, compile(runtime, simple, &program));
  CHECK_STATUS(BREVE_OK, compile(runtime, plain, &without));
  CHECK_STATUS(BREVE_OK, breve_world_create(runtime, program, NULL, &world));
  CHECK_STATUS(BREVE_OK, breve_object_set_user(world, breve_world_controller(world), &o, destroy_data));
  CHECK_STATUS(BREVE_OK, breve_world_reload(world, without));
  breve_program_destroy(program);
  breve_program_destroy(without);
  breve_runtime_destroy(runtime);
  CHECK(o.closed == 0 && o.calls == 0);
  CHECK_STATUS(BREVE_OK, breve_world_destroy(world));
  CHECK(o.calls == 1 && o.closed == 1);
}

static void what_is_wrong_with_a_plugin_is_said_at_its_directive(void) {
  opener o = {.entry_function = good_entry, .refuses = true, .gives_reason = true};
  breve_runtime* runtime = runtime_with(&o);
  check_refused(runtime, simple, "cannot load plugin 'tools': it is Sunday");
  o.gives_reason = false;
  check_refused(runtime, simple, "cannot load plugin 'tools': the host does not open it");
  o.refuses = false;
  o.gives_no_entry = true;
  check_refused(runtime, simple, "cannot load plugin 'tools': the host gave no entry");
  CHECK(o.closed == 1);
  o.gives_no_entry = false;
  o.entry_function = entry_for_another_abi;
  check_refused(
      runtime, simple,
      "cannot load plugin 'tools': its entry 'start' was compiled for another version of breve.h (this one has "
      "BREVE_ABI 4)");
  o.entry_function = entry_that_repeats;
  check_refused(runtime, simple,
                "cannot load plugin 'tools': its entry 'start' failed: the plugin adds the function 'twice' twice");
  o.entry_function = entry_that_compiles;
  check_refused(
      runtime, simple,
      "cannot load plugin 'tools': its entry 'start' failed: the runtime is compiling or making a world already");
  CHECK(o.closed == 4);
  CHECK_STATUS(BREVE_OK, add_twice(runtime));
  o.entry_function = good_entry;
  check_refused(
      runtime, simple,
      "cannot load plugin 'tools': its entry 'start' failed: the runtime has a function 'twice' already: choose "
      "another name");
  breve_runtime_destroy(runtime);
  CHECK(o.closed == o.asked - 2);
}

static void two_plugins_cannot_define_one_name_for_a_program(void) {
  opener o = {.entry_function = good_entry};
  breve_runtime* runtime = runtime_with(&o);
  breve_program* program = NULL;
  breve_diagnostic d;
  const char* both =
      "@use Control.\n@plugin \"a\"(start).\n@plugin \"b\"(start).\nController Shop.\nControl : Shop { }\n";
  CHECK_STATUS(BREVE_ERROR_COMPILE, compile(runtime, both, &program));
  CHECK_STATUS(BREVE_OK, breve_runtime_diagnostic(runtime, 0, &d));
  CHECK_TEXT("cannot load plugin 'b': the program has another function 'twice'", d.message);
  CHECK(d.line == 3);
  breve_runtime_destroy(runtime);
  CHECK(o.closed == 2);
}

static void note(void* sink, const char* bytes, size_t size) { snprintf(sink, 200, "%.*s", (int)size, bytes); }

static void a_shared_library_is_opened_by_its_path(void) {
  breve_plugin plugin = {0};
  char why[200] = "";
  CHECK_STATUS(BREVE_ERROR_FILE, breve_plugin_open("/nowhere/none.so", "noise", &plugin, note, why));
  CHECK(strstr(why, "/nowhere/none.so") != NULL && plugin.entry == NULL);
  CHECK_STATUS(BREVE_ERROR_NOT_FOUND, breve_plugin_open(BREVE_TEST_PLUGIN, "missing", &plugin, note, why));
  CHECK(strstr(why, "has no entry 'missing'") != NULL);
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_plugin_open(NULL, "noise", &plugin, NULL, NULL));
  if (!CHECK_STATUS(BREVE_OK, breve_plugin_open(BREVE_TEST_PLUGIN, "noise", &plugin, note, why))) return;
  CHECK(plugin.entry != NULL && plugin.close != NULL);
  plugin.close(plugin.library);
}

void plugins_suite(void) {
  RUN(without_a_callback_a_plugin_is_an_error_of_the_program);
  RUN(a_plugin_adds_functions_and_classes_to_the_programs_that_name_it);
  RUN(a_world_keeps_plugins_open_even_if_its_program_no_longer_names_them);
  RUN(what_is_wrong_with_a_plugin_is_said_at_its_directive);
  RUN(two_plugins_cannot_define_one_name_for_a_program);
  RUN(a_shared_library_is_opened_by_its_path);
}
