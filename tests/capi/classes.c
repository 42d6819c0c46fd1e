/* Classes of the host: scripts derive from them and they from scripts; what is bound to worlds. */
#include <stdlib.h>

#include "scene.h"

/* What a world of the class knows. */
typedef struct herd {
  int born, moved, told, gone;
  breve_object last;
} herd;

typedef struct guest {
  transcript said;
  breve_runtime* runtime;
  breve_program* program;
  breve_world* world;
  herd* herd; /* of the world that was bound last */
  int bound, unbound, destroyed;
} guest;

static void guest_begin(guest* g) {
  breve_runtime_config config = breve_runtime_config_default();
  memset(g, 0, sizeof *g);
  config.user = &g->said;
  config.print = remember;
  CHECK_STATUS(BREVE_OK, breve_runtime_create(&config, &g->runtime));
}

static void guest_close(guest* g) {
  CHECK_STATUS(BREVE_OK, breve_world_destroy(g->world));
  breve_program_destroy(g->program);
  CHECK_STATUS(BREVE_OK, breve_runtime_destroy(g->runtime));
}

static bool guest_open(guest* g, const char* text, const breve_world_config* config) {
  const breve_status status = breve_program_compile(g->runtime, "herd.tz", text, strlen(text), &g->program);
  if (status != BREVE_OK) printf("%s\n", breve_runtime_last_error(g->runtime)->text);
  return CHECK_STATUS(BREVE_OK, status) &&
         CHECK_STATUS(BREVE_OK, breve_world_create(g->runtime, g->program, config, &g->world));
}

/* --- the class Beast ------------------------------------------------------------------------------------------------ */

static breve_status beast_init(void* user, const breve_call* call, breve_value* result) {
  herd* h = call->binding;
  const breve_value age = breve_value_int(1);
  (void)user, (void)result;
  ++h->born;
  h->last = call->self;
  return breve_object_set(call->world, call->self, "age", &age);
}
static breve_status beast_iterate(void* user, const breve_call* call, breve_value* result) {
  (void)user, (void)result;
  ++((herd*)call->binding)->moved;
  return BREVE_OK;
}
static breve_status beast_destroy(void* user, const breve_call* call, breve_value* result) {
  (void)user, (void)result;
  ++((herd*)call->binding)->gone;
  return BREVE_OK;
}
/* Grow by a number; a negative one is refused. */
static breve_status beast_grow(void* user, const breve_call* call, breve_value* result) {
  static const char reason[] = "beasts do not shrink";
  breve_value age;
  (void)user;
  if (call->arguments[0].as.number < 0) {
    call->reason(call->sink, reason, sizeof reason - 1);
    return BREVE_ERROR_SCRIPT;
  }
  breve_status status = breve_object_get(call->world, call->self, "age", &age);
  if (status != BREVE_OK) return status;
  age = breve_value_int(age.as.integer + (int)call->arguments[0].as.number);
  *result = age;
  return breve_object_set(call->world, call->self, "age", &age);
}
/* Any value comes back; a text is said. */
static breve_status beast_echo(void* user, const breve_call* call, breve_value* result) {
  (void)user;
  ++((herd*)call->binding)->told;
  *result = call->arguments[0];
  return BREVE_OK;
}
/* Ask the object's own `answer`, which a script has, and hand on what comes of it. */
static breve_status beast_ask(void* user, const breve_call* call, breve_value* result) {
  (void)user;
  return breve_object_call(call->world, call->self, "answer", NULL, 0, result);
}

static breve_status bind(void* user, breve_world* world, void** binding, breve_write_fn reason, void* sink) {
  guest* g = user;
  (void)world, (void)reason, (void)sink;
  g->herd = calloc(1, sizeof *g->herd);
  *binding = g->herd;
  ++g->bound;
  return BREVE_OK;
}
static guest* unbinding; /* unbind gets the binding alone */
static void unbind(void* binding) {
  ++unbinding->unbound;
  free(binding);
}
static void destroyed(void* user) { ++((guest*)user)->destroyed; }

static size_t places(void* user, const breve_call* call, breve_place* to, size_t capacity) {
  (void)user, (void)call;
  if (capacity < 2) return 0;
  to[0] = (breve_place){"helper", "beast.c", 7};
  to[1] = (breve_place){"method", "beast.c", 70};
  return 2;
}

static const breve_parameter by[] = {{"by", BREVE_TYPE_DOUBLE, 0}}, of[] = {{"of", BREVE_TYPE_NULL, 0}};
static const breve_variable variables[] = {{"age", BREVE_TYPE_INT, 0}, {"lair", BREVE_TYPE_VECTOR, 0}};

static breve_class beast(guest* g, breve_method* methods) {
  const breve_method all[] = {
      {"init", NULL, NULL, 0, BREVE_TYPE_NULL, false, {false}, beast_init, NULL},
      {"iterate", NULL, NULL, 0, BREVE_TYPE_NULL, false, {false}, beast_iterate, NULL},
      {"destroy", NULL, NULL, 0, BREVE_TYPE_NULL, false, {false}, beast_destroy, NULL},
      {"grow", "Grows older.", by, 1, BREVE_TYPE_INT, false, {false}, beast_grow, NULL},
      {"echo", NULL, of, 1, BREVE_TYPE_NULL, false, {false}, beast_echo, NULL},
      {"ask", NULL, NULL, 0, BREVE_TYPE_NULL, false, {false}, beast_ask, NULL},
  };
  breve_class c = breve_class_default();
  memcpy(methods, all, sizeof all);
  c.name = "Beast";
  c.alias = "Beasts";
  c.parent = "Mobile";
  c.doc = "What roams.";
  c.variables = variables;
  c.variable_count = 2;
  c.methods = methods;
  c.method_count = sizeof all / sizeof *all;
  c.bind = bind;
  c.unbind = unbind;
  c.user = g;
  c.destroy = destroyed;
  unbinding = g;
  return c;
}

static void add_beast(guest* g) {
  breve_method methods[6];
  const breve_class c = beast(g, methods);
  CHECK_STATUS(BREVE_OK, breve_runtime_add_class(g->runtime, &c));
}

static const char* const herd_text =
    "@use Control.\n"
    "Controller Herd.\n"
    "Control : Herd {\n"
    "  + variables: wolf (object).\n"
    "  + to init: wolf = new Wolf. 2 new Beasts.\n"
    "  + to wolf-age: return (wolf grow by 0).\n"
    "  + to grow-wolf by n (float): return (wolf grow by n).\n"
    "  + to echo what v (object): return (wolf echo of v).\n"
    "  + to echo-text: return (wolf echo of \"howl\").\n"
    "  + to echo-vector: return (wolf echo of (1, 2, 3)).\n"
    "  + to echo-list: return (wolf echo of {1, 2}).\n"
    "  + to ask-wolf: return (wolf ask).\n"
    "  + to free-wolf: free wolf.\n"
    "}\n"
    "Beast : Wolf {\n"
    "  + to grow by n (float): return (super grow by n * 2).\n"
    "  + to answer: return 5.\n"
    "}\n";

static breve_status call_controller(guest* g, const char* method, breve_value* result) {
  return breve_object_call(g->world, breve_world_controller(g->world), method, NULL, 0, result);
}

static int age_of(guest* g, breve_object object) {
  breve_value age = breve_value_null();
  CHECK_STATUS(BREVE_OK, breve_object_get(g->world, object, "age", &age));
  return age.as.integer;
}

/* --- the tests ------------------------------------------------------------------------------------------------------ */

static void scripts_derive_from_classes_of_the_host_and_call_them(void) {
  guest g;
  breve_value result;
  const breve_keyword three = {"by", breve_value_double(3)};
  breve_object wolf;
  size_t count;
  guest_begin(&g);
  add_beast(&g);
  if (!guest_open(&g, herd_text, NULL)) return;
  CHECK(g.bound == 1 && g.herd->born == 3);
  CHECK_STATUS(BREVE_OK, breve_world_step(g.world));
  CHECK(g.herd->moved == 3);
  CHECK_STATUS(BREVE_OK, breve_world_objects(g.world, "Beasts", NULL, 0, &count));
  CHECK(count == 3);
  CHECK_STATUS(BREVE_OK, breve_world_objects(g.world, "Wolf", &wolf, 1, &count));
  CHECK(age_of(&g, wolf) == 1);
  CHECK_STATUS(BREVE_OK, breve_object_call(g.world, wolf, "grow", &three, 1, &result));
  CHECK(result.type == BREVE_TYPE_INT && result.as.integer == 7); /* the wolf's own doubles it */
  CHECK_STATUS(BREVE_OK, call_controller(&g, "free-wolf", NULL));
  CHECK(g.herd->gone == 1 && !breve_object_alive(g.world, wolf));
  guest_close(&g);
  CHECK(g.unbound == 1 && g.destroyed == 1);
}

static void values_of_any_type_pass_through_untyped_parameters(void) {
  guest g;
  breve_value result;
  guest_begin(&g);
  add_beast(&g);
  if (!guest_open(&g, herd_text, NULL)) return;
  CHECK_STATUS(BREVE_OK, call_controller(&g, "echo-text", &result));
  CHECK(result.type == BREVE_TYPE_STRING && strcmp(result.as.string.bytes, "howl") == 0);
  CHECK_STATUS(BREVE_OK, call_controller(&g, "echo-vector", &result));
  CHECK(result.type == BREVE_TYPE_VECTOR && result.as.vector[2] == 3);
  CHECK_STATUS(BREVE_OK, call_controller(&g, "echo-list", &result));
  breve_value elements[2];
  CHECK(result.type == BREVE_TYPE_LIST);
  CHECK_STATUS(BREVE_ERROR_NOT_FOUND, breve_list_read(g.world, &result, 1, elements, 2));
  CHECK_STATUS(BREVE_OK, breve_list_read(g.world, &result, 0, elements, 2));
  CHECK(elements[0].as.integer == 1 && elements[1].as.integer == 2);
  CHECK(g.herd->told == 3);
  guest_close(&g);
}

static void a_failing_method_gives_its_reason_and_the_chain_of_calls(void) {
  guest g;
  breve_method methods[6];
  guest_begin(&g);
  breve_class c = beast(&g, methods);
  c.places = places;
  CHECK_STATUS(BREVE_OK, breve_runtime_add_class(g.runtime, &c));
  if (!guest_open(&g, herd_text, NULL)) return;
  const breve_keyword by_one = {"by", breve_value_double(-1)};
  CHECK_STATUS(BREVE_ERROR_SCRIPT,
               breve_object_call(g.world, breve_world_controller(g.world), "grow-wolf", &by_one, 1, NULL));
  const breve_error* error = breve_world_last_error(g.world);
  CHECK_TEXT("beasts do not shrink", error->message);
  CHECK_TEXT("beast.c", error->file);
  CHECK(error->line == 7 && error->frame_count == 4);
  if (error->frame_count == 4) {
    CHECK_TEXT("helper", error->frames[0].method);
    CHECK_TEXT("grow", error->frames[1].method);
    CHECK(error->frames[1].line == 70 && error->frames[0].line == 7);
    CHECK_TEXT("Wolf", error->frames[1].class_name);
    CHECK_TEXT("grow", error->frames[2].method);
    CHECK_TEXT("herd.tz", error->frames[2].file);
    CHECK_TEXT("grow-wolf", error->frames[3].method);
  }
  guest_close(&g);
}

/* A method of the host calls a script, which fails: the error is the script's, with the whole chain. */
static void errors_pass_through_methods_of_the_host(void) {
  static const char* const text =
      "@use Control.\nController Herd.\n"
      "Control : Herd { + variables: w (object). + to init: w = new Wolf. + to go: return (w ask). }\n"
      "Beast : Wolf { + to answer: return 1 / 0. }\n";
  guest g;
  guest_begin(&g);
  add_beast(&g);
  if (!guest_open(&g, text, NULL)) return;
  CHECK_STATUS(BREVE_ERROR_SCRIPT, call_controller(&g, "go", NULL));
  const breve_error* error = breve_world_last_error(g.world);
  CHECK_TEXT("herd.tz", error->file);
  CHECK(error->line == 4 && error->frame_count == 3);
  if (error->frame_count == 3) {
    CHECK_TEXT("answer", error->frames[0].method);
    CHECK_TEXT("ask", error->frames[1].method);
    CHECK_TEXT("go", error->frames[2].method);
  }
  guest_close(&g);
}

static bool resolve_den(void* user, const char* name, const char* from, breve_module* module) {
  static const char text[] = "@use Mobile.\nMobile : Den { + to size: return 4. }\n";
  (void)user, (void)from;
  if (strcmp(name, "Den.tz") != 0) return false;
  module->text = text;
  module->size = sizeof text - 1;
  return true;
}

static void a_class_of_the_host_derives_from_one_of_a_script(void) {
  static const char* const modules[] = {"Den.tz"};
  static const char* const text =
      "@use Control.\nController Herd.\nControl : Herd { + to go: return ((new Cave) size) + ((new Cave) width). }\n";
  const breve_method width[] = {{"width", NULL, NULL, 0, BREVE_TYPE_NULL, false, {false}, beast_ask, NULL}};
  breve_runtime_config config = breve_runtime_config_default();
  breve_class c = breve_class_default();
  breve_value result;
  guest g;
  memset(&g, 0, sizeof g);
  config.resolve_module = resolve_den;
  CHECK_STATUS(BREVE_OK, breve_runtime_create(&config, &g.runtime));
  c.name = "Cave";
  c.parent = "Den";
  c.modules = modules;
  c.module_count = 1;
  c.methods = width;
  c.method_count = 1;
  CHECK_STATUS(BREVE_OK, breve_runtime_add_class(g.runtime, &c));
  if (!guest_open(&g, text, NULL)) return;
  CHECK_STATUS(BREVE_ERROR_SCRIPT, call_controller(&g, "go", &result)); /* it has no `answer` */
  breve_object cave;
  breve_selector size;
  CHECK_STATUS(BREVE_OK, breve_object_create(g.world, "Cave", &cave));
  CHECK_STATUS(BREVE_OK, breve_object_call(g.world, cave, "size", NULL, 0, &result));
  CHECK(result.as.integer == 4);
  CHECK_STATUS(BREVE_OK, breve_world_prepare_super(g.world, "Cave", "size", NULL, 0, &size));
  CHECK_STATUS(BREVE_OK, breve_object_call_prepared(g.world, cave, size, NULL, 0, &result));
  CHECK(result.as.integer == 4);
  CHECK_STATUS(BREVE_ERROR_TYPE,
               breve_object_call_prepared(g.world, breve_world_controller(g.world), size, NULL, 0, &result));
  CHECK_STATUS(BREVE_ERROR_NOT_FOUND, breve_world_prepare_super(g.world, "Nobody", "size", NULL, 0, &size));
  guest_close(&g);
}

static void methods_of_a_class_are_listed_without_those_that_are_overridden(void) {
  guest g;
  breve_method_info all[200];
  size_t count = 0, grow = 0;
  guest_begin(&g);
  add_beast(&g);
  if (!guest_open(&g, herd_text, NULL)) return;
  CHECK_STATUS(BREVE_OK, breve_world_methods(g.world, "Wolf", all, 200, &count));
  for (size_t i = 0; i < count && i < 200; ++i) {
    if (strcmp(all[i].name, "grow") != 0) continue;
    ++grow;
    CHECK_TEXT("Wolf", all[i].class_name);
    CHECK(all[i].keyword_count == 1 && strcmp(all[i].keywords[0], "by") == 0 && all[i].types[0] == BREVE_TYPE_DOUBLE);
  }
  CHECK(grow == 1 && count > 50);
  CHECK_STATUS(BREVE_ERROR_NOT_FOUND, breve_world_methods(g.world, "Nobody", all, 200, &count));
  guest_close(&g);
}

static breve_status refuse(void* user, breve_world* world, void** binding, breve_write_fn reason, void* sink) {
  (void)user, (void)world, (void)binding;
  reason(sink, "no beasts today", 15);
  return BREVE_ERROR_UNSUPPORTED;
}

static void each_world_is_bound_and_may_be_refused(void) {
  guest g;
  breve_world* second = NULL;
  breve_method methods[6];
  guest_begin(&g);
  add_beast(&g);
  if (!guest_open(&g, herd_text, NULL)) return;
  herd* first = g.herd;
  CHECK_STATUS(BREVE_OK, breve_world_create(g.runtime, g.program, NULL, &second));
  CHECK(g.herd != first && first->born == 3 && g.herd->born == 3 && g.bound == 2);
  CHECK_STATUS(BREVE_OK, breve_world_destroy(second));
  CHECK(g.unbound == 1);
  breve_class c = beast(&g, methods);
  c.bind = refuse;
  CHECK_STATUS(BREVE_OK, breve_runtime_add_class(g.runtime, &c)); /* in the place of the other */
  breve_program_destroy(g.program);
  CHECK_STATUS(BREVE_OK, breve_program_compile(g.runtime, "herd.tz", herd_text, strlen(herd_text), &g.program));
  CHECK_STATUS(BREVE_ERROR_UNSUPPORTED, breve_world_create(g.runtime, g.program, NULL, &second));
  CHECK_TEXT("no beasts today", breve_runtime_last_error(g.runtime)->message);
  CHECK_STATUS(BREVE_ERROR_UNSUPPORTED, breve_world_reload(g.world, g.program));
  CHECK_STATUS(BREVE_OK, breve_world_step(g.world));
  guest_close(&g);
  CHECK(g.destroyed == 2 && g.unbound == 2);
}

static void descriptions_that_no_program_could_use_are_refused(void) {
  guest g;
  breve_method methods[6];
  guest_begin(&g);
  const breve_class good = beast(&g, methods);
  breve_class c = good;
  c.name = "Two Words";
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_runtime_add_class(g.runtime, &c));
  c = good;
  c.name = "Beast\n}\nMobile : Evil {";
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_runtime_add_class(g.runtime, &c));
  c = good;
  c.struct_size = 3;
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_runtime_add_class(g.runtime, &c));
  c = good;
  methods[4].name = "grow";
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_runtime_add_class(g.runtime, &c)); /* twice, with one parameter each */
  methods[4].name = "while";
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_runtime_add_class(g.runtime, &c));
  methods[4].name = "echo";
  methods[4].call = NULL;
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_runtime_add_class(g.runtime, &c));
  methods[4].call = beast_echo;
  methods[4].result = BREVE_TYPE_POINTER;
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_runtime_add_class(g.runtime, &c));
  methods[4].result = BREVE_TYPE_NULL;
  methods[4].parameter_count = 9;
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_runtime_add_class(g.runtime, &c));
  CHECK(g.destroyed == 0);
  guest_close(&g);
}

static void an_unknown_parent_is_an_error_of_the_program(void) {
  guest g;
  breve_method methods[6];
  guest_begin(&g);
  breve_class c = beast(&g, methods);
  c.parent = "Mobil";
  CHECK_STATUS(BREVE_OK, breve_runtime_add_class(g.runtime, &c));
  CHECK_STATUS(BREVE_ERROR_COMPILE,
               breve_program_compile(g.runtime, "herd.tz", herd_text, strlen(herd_text), &g.program));
  guest_close(&g);
}

/* A class of the host without its parent also makes errors of all its uses: the cause comes before them. */
static void a_missing_parent_comes_before_the_errors_that_it_causes(void) {
  static const char* const text =
      "@use Control.\nController Town.\n"
      "Shed : Barn { + to grow: hp = hp + 1. }\n"
      "Control : Town { + to init: new Barn. }\n";
  guest g;
  breve_diagnostic d;
  guest_begin(&g);
  breve_class shed = breve_class_default();
  shed.name = "Shed";
  shed.parent = "Building";
  CHECK_STATUS(BREVE_OK, breve_runtime_add_class(g.runtime, &shed));
  CHECK_STATUS(BREVE_ERROR_COMPILE, breve_program_compile(g.runtime, "town.tz", text, strlen(text), &g.program));
  CHECK_STATUS(BREVE_OK, breve_runtime_diagnostic(g.runtime, 0, &d));
  CHECK_TEXT("town.tz", d.file); /* diagnostics are in order of the files */
  const char* said = breve_runtime_last_error(g.runtime)->text;
  const char* cause = strstr(said, "unknown parent class 'Building'");
  const char* result = strstr(said, "unknown variable 'hp'");
  if (!CHECK(cause && result && cause < result && strstr(cause, "breve_class.modules"))) printf("%s\n", said);
  CHECK(strstr(said, "2 errors") != NULL);
  guest_close(&g);
}

void classes_suite(void) {
  RUN(scripts_derive_from_classes_of_the_host_and_call_them);
  RUN(values_of_any_type_pass_through_untyped_parameters);
  RUN(a_failing_method_gives_its_reason_and_the_chain_of_calls);
  RUN(errors_pass_through_methods_of_the_host);
  RUN(a_class_of_the_host_derives_from_one_of_a_script);
  RUN(methods_of_a_class_are_listed_without_those_that_are_overridden);
  RUN(each_world_is_bound_and_may_be_refused);
  RUN(descriptions_that_no_program_could_use_are_refused);
  RUN(an_unknown_parent_is_an_error_of_the_program);
  RUN(a_missing_parent_comes_before_the_errors_that_it_causes);
}
