/* Functions of the host: what scripts give them and get from them, errors in them, what they may call. */
#include <stdlib.h>

#include "breve/analysis.h"
#include "scene.h"

/* A runtime with functions, and a world of a program that calls them. */
typedef struct guest {
  transcript said;
  breve_runtime* runtime;
  breve_program* program;
  breve_world* world;
} guest;

static void guest_begin(guest* g) {
  breve_runtime_config config = breve_runtime_config_default();
  memset(g, 0, sizeof *g);
  config.user = &g->said;
  config.print = remember;
  CHECK_STATUS(BREVE_OK, breve_runtime_create(&config, &g->runtime));
}

static breve_status add(guest* g, const char* name, const uint32_t* types, size_t count, uint32_t result,
                        breve_function_fn call, void* user) {
  breve_function f = breve_function_default();
  f.name = name;
  f.parameters = types;
  f.parameter_count = count;
  f.result = result;
  f.call = call;
  f.user = user;
  return breve_runtime_add_function(g->runtime, &f);
}

static char* page_of(const char* members) {
  static const char* const head = "@use Control.\nController Page.\nControl : Page {\n";
  char* text = malloc(strlen(head) + strlen(members) + 3);
  if (text) sprintf(text, "%s%s\n}", head, members);
  return text;
}

static breve_status compile_page(guest* g, const char* members) {
  char* text = page_of(members);
  if (!CHECK(text != NULL)) return BREVE_ERROR_MEMORY;
  const breve_status status = breve_program_compile(g->runtime, "page.tz", text, strlen(text), &g->program);
  free(text);
  return status;
}

static bool guest_open(guest* g, const char* members, const breve_world_config* config) {
  return CHECK_STATUS(BREVE_OK, compile_page(g, members)) &&
         CHECK_STATUS(BREVE_OK, breve_world_create(g->runtime, g->program, config, &g->world));
}

static void guest_close(guest* g) {
  CHECK_STATUS(BREVE_OK, breve_world_destroy(g->world));
  breve_program_destroy(g->program);
  CHECK_STATUS(BREVE_OK, breve_runtime_destroy(g->runtime));
}

static breve_status call(guest* g, const char* method, breve_value* result) {
  return breve_object_call(g->world, breve_world_controller(g->world), method, NULL, 0, result);
}

static const uint32_t three_doubles[] = {BREVE_TYPE_DOUBLE, BREVE_TYPE_DOUBLE, BREVE_TYPE_DOUBLE};
static const uint32_t anything[] = {BREVE_TYPE_NULL};

/* --- the functions ------------------------------------------------------------------------------------------------ */

static breve_status volume(void* user, const breve_call* c, breve_value* result) {
  CHECK(user == NULL && c->count == 3 && c->struct_size == sizeof *c);
  for (int i = 0; i < 3; ++i) CHECK(c->arguments[i].type == BREVE_TYPE_DOUBLE);
  *result = breve_value_double(c->arguments[0].as.number * c->arguments[1].as.number * c->arguments[2].as.number);
  return BREVE_OK;
}

static breve_status echo(void* user, const breve_call* c, breve_value* result) {
  (void)user;
  *result = c->arguments[0];
  return BREVE_OK;
}

static breve_status give(void* user, const breve_call* c, breve_value* result) {
  (void)c;
  *result = *(const breve_value*)user;
  return BREVE_OK;
}

static breve_status fail_with_reason(void* user, const breve_call* c, breve_value* result) {
  (void)user, (void)result;
  c->reason(c->sink, "the well ", 9);
  c->reason(c->sink, "is dry", 6);
  return BREVE_ERROR_NOT_FOUND;
}

static breve_status fail_in_silence(void* user, const breve_call* c, breve_value* result) {
  (void)user, (void)c, (void)result;
  return BREVE_ERROR_FILE;
}

/* Calls the method of the caller that `user` names, and hands on what comes of it. */
static breve_status call_back(void* user, const breve_call* c, breve_value* result) {
  return breve_object_call(c->world, c->self, (const char*)user, NULL, 0, result);
}

static breve_status free_caller(void* user, const breve_call* c, breve_value* result) {
  (void)user, (void)result;
  return breve_object_free(c->world, c->self);
}

static breve_status make_objects(void* user, const breve_call* c, breve_value* result) {
  breve_object made = {0, 0};
  (void)user;
  for (int i = 0; i < 100; ++i) {
    const breve_status status = breve_object_create(c->world, "Thing", &made);
    if (status != BREVE_OK) return status;
    if (i < 99) CHECK_STATUS(BREVE_OK, breve_object_free(c->world, made));
  }
  *result = breve_value_object(made);
  return BREVE_OK;
}

static breve_status make_list(void* user, const breve_call* c, breve_value* result) {
  (void)user;
  const breve_status status = breve_list_create(c->world, result);
  for (int i = 0; status == BREVE_OK && i < 1000; ++i) {
    const breve_value element = breve_value_int(i);
    CHECK_STATUS(BREVE_OK, breve_list_push(c->world, result, &element));
  }
  return status;
}

static breve_status work(void* user, const breve_call* c, breve_value* result) {
  (void)result;
  const breve_status status = breve_world_charge(c->world, (uint64_t)c->arguments[0].as.integer);
  return user ? BREVE_OK : status; /* with `user`, a function that does not listen */
}

static breve_status whose(void* user, const breve_call* c, breve_value* result) {
  (void)user;
  *result = breve_value_string(breve_world_user(c->world));
  return BREVE_OK;
}

static breve_status try_busy(void* user, const breve_call* c, breve_value* result) {
  size_t size;
  (void)user, (void)result;
  CHECK_STATUS(BREVE_ERROR_BUSY, breve_world_destroy(c->world));
  CHECK_STATUS(BREVE_ERROR_BUSY, breve_world_step(c->world));
  CHECK_STATUS(BREVE_ERROR_BUSY, breve_world_snapshot(c->world, NULL, 0, &size));
  return BREVE_OK;
}

static void count_one(void* user) { ++*(int*)user; }

/* --- the tests ---------------------------------------------------------------------------------------------------- */

static void arguments_are_converted_to_the_declared_types(void) {
  guest g;
  breve_value result;
  guest_begin(&g);
  CHECK_STATUS(BREVE_OK, add(&g, "volume", three_doubles, 3, BREVE_TYPE_DOUBLE, volume, NULL));
  if (!guest_open(&g,
                  "+ to go: return volume(2, 3.5, \"4\").\n"
                  "+ to fail: return volume(1, (1, 2, 3), 2).\n"
                  "+ to evaluate: return 1.",
                  NULL))
    return;
  CHECK_STATUS(BREVE_OK, call(&g, "go", &result));
  CHECK(result.type == BREVE_TYPE_DOUBLE && result.as.number == 28);
  CHECK_STATUS(BREVE_ERROR_SCRIPT, call(&g, "fail", &result));
  CHECK(strstr(breve_world_last_error(g.world)->message, "argument 2 of volume must be a double") != NULL);
  const char* const typed = "volume(1, 2, 3).";
  CHECK_STATUS(BREVE_OK, breve_world_evaluate(g.world, (breve_object){0, 0}, typed, strlen(typed), &result));
  CHECK(result.as.number == 6);
  guest_close(&g);
}

static void values_of_each_type_go_in_and_out(void) {
  static const uint32_t types[] = {BREVE_TYPE_INT,    BREVE_TYPE_DOUBLE, BREVE_TYPE_VECTOR,
                                   BREVE_TYPE_MATRIX, BREVE_TYPE_STRING, BREVE_TYPE_OBJECT,
                                   BREVE_TYPE_LIST,   BREVE_TYPE_HASH,   BREVE_TYPE_DATA};
  static const char* const names[] = {"echoI", "echoD", "echoV", "echoM", "echoS", "echoO", "echoL", "echoH", "echoB"};
  guest g;
  guest_begin(&g);
  for (size_t i = 0; i < sizeof types / sizeof *types; ++i)
    CHECK_STATUS(BREVE_OK, add(&g, names[i], &types[i], 1, types[i], echo, NULL));
  CHECK_STATUS(BREVE_OK, add(&g, "echoA", anything, 1, BREVE_TYPE_NULL, echo, NULL));
  breve_value bytes = breve_value_string("a\0b"), result;
  bytes.type = BREVE_TYPE_DATA;
  bytes.as.string.size = 3;
  CHECK_STATUS(BREVE_OK, add(&g, "bytes", NULL, 0, BREVE_TYPE_DATA, give, &bytes));
  if (!guest_open(
          &g,
          "+ to get-bytes: return echoB(bytes()).\n"
          "+ to go:\n"
          "\tm (matrix).\n\tl (list).\n\th (hash).\n"
          "\tm = [ (1, 2, 3), (4, 5, 6), (7, 8, 9) ].\n\tl = { 1, \"two\" }.\n\th{\"key\"} = 5.\n"
          "\tprint echoI(7), echoD(1.5), echoV((1, 2, 3)), echoS(\"text\").\n"
          "\tprint echoM(m) == m, echoO(self) == self, echoL(l), echoH(h){\"key\"}, echoA(\"any\"), echoA(2).\n",
          NULL))
    return;
  CHECK_STATUS(BREVE_OK, call(&g, "go", NULL));
  CHECK_TEXT("7 1.500000 (1.00000, 2.00000, 3.00000) text\n1 1 { 1, two } 5 any 2\n", g.said.print);
  CHECK_STATUS(BREVE_OK, call(&g, "get-bytes", &result));
  CHECK(result.type == BREVE_TYPE_DATA && result.as.string.size == 3);
  CHECK(memcmp(result.as.string.bytes, "a\0b", 3) == 0);
  guest_close(&g);
}

static void results_that_do_not_convert_are_errors_of_the_script(void) {
  guest g;
  breve_value given = breve_value_vector(1, 2, 3);
  guest_begin(&g);
  CHECK_STATUS(BREVE_OK, add(&g, "give", NULL, 0, BREVE_TYPE_INT, give, &given));
  if (!guest_open(&g, "+ to go: return give().", NULL)) return;
  CHECK_STATUS(BREVE_ERROR_SCRIPT, call(&g, "go", NULL));
  CHECK(strstr(breve_world_last_error(g.world)->message, "the result of give must be an int") != NULL);
  given = breve_value_object((breve_object){77, 77});
  CHECK_STATUS(BREVE_ERROR_SCRIPT, call(&g, "go", NULL));
  given.type = 99;
  CHECK_STATUS(BREVE_ERROR_SCRIPT, call(&g, "go", NULL));
  CHECK(strstr(breve_world_last_error(g.world)->message, "the result of give: value.type is 99") != NULL);
  given = breve_value_null();
  CHECK_STATUS(BREVE_ERROR_SCRIPT, call(&g, "go", NULL));
  given = breve_value_double(3.75);
  breve_value result;
  CHECK_STATUS(BREVE_OK, call(&g, "go", &result));
  CHECK(result.type == BREVE_TYPE_INT && result.as.integer == 3);
  guest_close(&g);
}

static void what_cannot_be_called_is_refused(void) {
  static const uint32_t pointer[] = {BREVE_TYPE_POINTER}, none[] = {42};
  static const uint32_t nine[9] = {0};
  guest g;
  guest_begin(&g);
  CHECK_STATUS(BREVE_OK, add(&g, "once", NULL, 0, BREVE_TYPE_NULL, echo, NULL));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, add(&g, "once", NULL, 0, BREVE_TYPE_NULL, echo, NULL));
  CHECK(strstr(breve_runtime_last_error(g.runtime)->message, "'once' already") != NULL);
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, add(&g, "sqrt", NULL, 0, BREVE_TYPE_NULL, echo, NULL));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, add(&g, "while", NULL, 0, BREVE_TYPE_NULL, echo, NULL));
  for (const char* const* name = (const char* const[]){"", "1st", "two words", "a-b", "h\xc3\xb6he", NULL}; *name;
       ++name)
    CHECK_STATUS(BREVE_ERROR_ARGUMENT, add(&g, *name, NULL, 0, BREVE_TYPE_NULL, echo, NULL));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, add(&g, NULL, NULL, 0, BREVE_TYPE_NULL, echo, NULL));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, add(&g, "idle", NULL, 0, BREVE_TYPE_NULL, NULL, NULL));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, add(&g, "list", NULL, 1, BREVE_TYPE_NULL, echo, NULL));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, add(&g, "pointer", pointer, 1, BREVE_TYPE_NULL, echo, NULL));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, add(&g, "typeless", none, 1, BREVE_TYPE_NULL, echo, NULL));
  CHECK(strstr(breve_runtime_last_error(g.runtime)->message, "parameter 1 of function 'typeless' is 42") != NULL);
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, add(&g, "result", NULL, 0, BREVE_TYPE_POINTER, echo, NULL));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, add(&g, "many", nine, 9, BREVE_TYPE_NULL, echo, NULL));
  breve_function f = breve_function_default();
  f.struct_size = 3;
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_runtime_add_function(g.runtime, &f));
  guest_close(&g);
}

static void the_compiler_knows_names_and_numbers_of_arguments(void) {
  guest g;
  breve_diagnostic d;
  guest_begin(&g);
  CHECK_STATUS(BREVE_OK, add(&g, "volume", three_doubles, 3, BREVE_TYPE_DOUBLE, volume, NULL));
  CHECK_STATUS(BREVE_ERROR_COMPILE, compile_page(&g, "+ to go: return volume(1, 2)."));
  CHECK_STATUS(BREVE_OK, breve_runtime_diagnostic(g.runtime, 0, &d));
  CHECK_TEXT("function 'volume' takes 3 arguments, not 2", d.message);
  CHECK_STATUS(BREVE_ERROR_COMPILE, compile_page(&g, "+ to go: return volum(1, 2, 3)."));
  CHECK_STATUS(BREVE_OK, breve_runtime_diagnostic(g.runtime, 0, &d));
  CHECK_TEXT("did you mean 'volume'?", d.help);
  guest_close(&g);
}

static void a_failing_function_is_an_error_at_its_call(void) {
  guest g;
  guest_begin(&g);
  CHECK_STATUS(BREVE_OK, add(&g, "draw", NULL, 0, BREVE_TYPE_NULL, fail_with_reason, NULL));
  CHECK_STATUS(BREVE_OK, add(&g, "silent", NULL, 0, BREVE_TYPE_NULL, fail_in_silence, NULL));
  if (!guest_open(&g, "+ to go:\n\t(self water).\n+ to water:\n\tdraw().\n+ to hush: silent().", NULL)) return;
  CHECK_STATUS(BREVE_ERROR_SCRIPT, call(&g, "go", NULL));
  const breve_error* e = breve_world_last_error(g.world);
  CHECK_TEXT("draw: the well is dry", e->message);
  CHECK(e->line == 7 && e->column == 2 && e->frame_count == 2);
  CHECK_TEXT("water", e->frames[0].method);
  CHECK_STATUS(BREVE_ERROR_SCRIPT, call(&g, "hush", NULL));
  CHECK_TEXT("silent: BREVE_ERROR_FILE", breve_world_last_error(g.world)->message);
  guest_close(&g);
}

static void functions_call_methods_and_hand_on_their_errors(void) {
  guest g;
  breve_value result;
  guest_begin(&g);
  CHECK_STATUS(BREVE_OK, add(&g, "answer", NULL, 0, BREVE_TYPE_INT, call_back, (void*)(size_t) "say-it"));
  CHECK_STATUS(BREVE_OK, add(&g, "trouble", NULL, 0, BREVE_TYPE_NULL, call_back, (void*)(size_t) "divide"));
  CHECK_STATUS(BREVE_OK, add(&g, "deeper", NULL, 0, BREVE_TYPE_NULL, call_back, (void*)(size_t) "sink"));
  if (!guest_open(&g,
                  "+ variables:\n\tn (int).\n"
                  "+ to say-it: return 42.\n+ to divide: return 1 / n.\n+ to sink: return deeper().\n"
                  "+ to ask: return answer().\n+ to break: return trouble().",
                  NULL))
    return;
  CHECK_STATUS(BREVE_OK, call(&g, "ask", &result));
  CHECK(result.type == BREVE_TYPE_INT && result.as.integer == 42);
  CHECK_STATUS(BREVE_ERROR_SCRIPT, call(&g, "break", NULL));
  CHECK(strstr(breve_world_last_error(g.world)->message, "trouble: ") != NULL);
  CHECK(strstr(breve_world_last_error(g.world)->message, "(page.tz:7)") != NULL);
  CHECK_STATUS(BREVE_ERROR_DEPTH, call(&g, "sink", NULL));
  CHECK_STATUS(BREVE_OK, call(&g, "ask", &result)); /* the world is as good as before */
  guest_close(&g);
}

static void a_function_may_free_its_caller_and_make_objects(void) {
  guest g;
  breve_value result;
  size_t count;
  guest_begin(&g);
  CHECK_STATUS(BREVE_OK, add(&g, "vanish", NULL, 0, BREVE_TYPE_NULL, free_caller, NULL));
  CHECK_STATUS(BREVE_OK, add(&g, "makeThing", NULL, 0, BREVE_TYPE_OBJECT, make_objects, NULL));
  CHECK_STATUS(BREVE_OK, add(&g, "thousand", NULL, 0, BREVE_TYPE_LIST, make_list, NULL));
  if (!guest_open(&g,
                  "+ to go: (new Thing go).\n+ to make: return makeThing().\n+ to count: return |thousand()|.\n"
                  "}\nAbstract : Thing {\n+ to go:\n\tvanish().\n\tprint \"still here\".",
                  NULL))
    return;
  CHECK_STATUS(BREVE_OK, call(&g, "go", NULL));
  CHECK_TEXT("", g.said.print); /* a method of an object that is gone ends */
  CHECK_STATUS(BREVE_OK, call(&g, "make", &result));
  CHECK(breve_object_alive(g.world, result.as.object));
  CHECK_STATUS(BREVE_OK, breve_world_objects(g.world, "Thing", NULL, 0, &count));
  CHECK(count == 1);
  CHECK_STATUS(BREVE_OK, call(&g, "count", &result));
  CHECK(result.as.integer == 1000);
  guest_close(&g);
}

static void work_is_counted_against_the_budget(void) {
  static const uint32_t turns[] = {BREVE_TYPE_INT};
  guest g;
  breve_world_config config = breve_world_config_default();
  config.budget = 1000;
  guest_begin(&g);
  CHECK_STATUS(BREVE_OK, add(&g, "work", turns, 1, BREVE_TYPE_NULL, work, NULL));
  CHECK_STATUS(BREVE_OK, add(&g, "workOn", turns, 1, BREVE_TYPE_NULL, work, &g));
  if (!guest_open(&g,
                  "+ to little: work(900).\n+ to much: work(1001).\n+ to stubborn: { workOn(1001). print \"on\". }\n"
                  "+ to loop: while 1: work(0).",
                  &config))
    return;
  CHECK_STATUS(BREVE_OK, call(&g, "little", NULL));
  CHECK_STATUS(BREVE_OK, call(&g, "little", NULL)); /* each call of the host has a budget of its own */
  CHECK_STATUS(BREVE_ERROR_BUDGET, call(&g, "much", NULL));
  CHECK_STATUS(BREVE_ERROR_BUDGET, call(&g, "stubborn", NULL));
  CHECK_TEXT("", g.said.print);
  CHECK_STATUS(BREVE_ERROR_BUDGET, call(&g, "loop", NULL));
  CHECK_STATUS(BREVE_OK, breve_world_charge(g.world, 5000)); /* nothing runs */
  guest_close(&g);
}

static void worlds_of_one_program_differ_by_their_user(void) {
  guest g;
  breve_value result;
  breve_world* other = NULL;
  breve_world_config config = breve_world_config_default();
  guest_begin(&g);
  CHECK_STATUS(BREVE_OK, add(&g, "whose", NULL, 0, BREVE_TYPE_STRING, whose, NULL));
  config.user = (void*)(size_t) "first";
  if (!guest_open(&g, "+ to go: return whose().", &config)) return;
  config.user = (void*)(size_t) "second";
  CHECK_STATUS(BREVE_OK, breve_world_create(g.runtime, g.program, &config, &other));
  CHECK_STATUS(BREVE_OK, call(&g, "go", &result));
  CHECK_TEXT("first", result.as.string.bytes);
  CHECK_STATUS(BREVE_OK, breve_object_call(other, breve_world_controller(other), "go", NULL, 0, &result));
  CHECK_TEXT("second", result.as.string.bytes);
  CHECK_STATUS(BREVE_OK, breve_world_destroy(other));
  guest_close(&g);
}

static void what_cannot_work_in_a_running_script_is_busy(void) {
  guest g;
  guest_begin(&g);
  CHECK_STATUS(BREVE_OK, add(&g, "tryBusy", NULL, 0, BREVE_TYPE_NULL, try_busy, NULL));
  if (!guest_open(&g, "+ to go: tryBusy().", NULL)) return;
  CHECK_STATUS(BREVE_OK, call(&g, "go", NULL));
  CHECK_STATUS(BREVE_OK, breve_world_step(g.world));
  guest_close(&g);
}

static void data_of_a_function_is_destroyed_once_when_nobody_can_call_it(void) {
  guest g;
  int destroyed = 0;
  breve_value given = breve_value_int(9), result;
  breve_function f = breve_function_default();
  guest_begin(&g);
  f.name = "give";
  f.result = BREVE_TYPE_INT;
  f.call = give;
  f.user = &given;
  CHECK_STATUS(BREVE_OK, breve_runtime_add_function(g.runtime, &f));
  f.name = "owned";
  f.user = &destroyed;
  f.destroy = count_one;
  CHECK_STATUS(BREVE_OK, breve_runtime_add_function(g.runtime, &f));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_runtime_add_function(g.runtime, &f));
  CHECK(destroyed == 0);
  if (!guest_open(&g, "+ to go: return give().", NULL)) return;
  CHECK_STATUS(BREVE_OK, breve_runtime_destroy(g.runtime));
  breve_program_destroy(g.program);
  CHECK(destroyed == 0);
  CHECK_STATUS(BREVE_OK, call(&g, "go", &result));
  CHECK(result.as.integer == 9);
  CHECK_STATUS(BREVE_OK, breve_world_destroy(g.world));
  CHECK(destroyed == 1);
}

static void analyses_know_functions_of_the_host(void) {
  static const char* const text =
      "@use Control.\nController Page.\nControl : Page { + to go: return volume(1, 2, 3). }\n";
  guest g;
  breve_analysis* analysis = NULL;
  size_t found = 0;
  breve_function f = breve_function_default();
  guest_begin(&g);
  f.name = "volume";
  f.doc = "Product of three lengths.";
  f.parameters = three_doubles;
  f.parameter_count = 3;
  f.result = BREVE_TYPE_DOUBLE;
  f.call = volume;
  CHECK_STATUS(BREVE_OK, breve_runtime_add_function(g.runtime, &f));
  CHECK_STATUS(BREVE_OK, breve_analysis_create(g.runtime, "page.tz", text, strlen(text), &analysis));
  CHECK(breve_analysis_diagnostic_count(analysis) == 0);
  for (size_t i = 0; i < breve_analysis_symbol_count(analysis); ++i) {
    breve_symbol symbol;
    CHECK_STATUS(BREVE_OK, breve_analysis_symbol(analysis, i, &symbol));
    if (strcmp(symbol.name, "volume") != 0) continue;
    ++found;
    CHECK_TEXT("volume((float), (float), (float))", symbol.signature);
    CHECK_TEXT("float", symbol.type);
    CHECK_TEXT("Product of three lengths.", symbol.documentation);
  }
  CHECK(found == 1);
  breve_analysis_destroy(analysis);
  guest_close(&g);
}

static void profiles_name_functions_of_the_host(void) {
  guest g;
  size_t count = 0;
  bool found = false;
  breve_world_config config = breve_world_config_default();
  guest_begin(&g);
  config.profile = true;
  CHECK_STATUS(BREVE_OK, add(&g, "echoA", anything, 1, BREVE_TYPE_NULL, echo, NULL));
  if (!guest_open(&g, "+ to go: return echoA(1).", &config)) return;
  CHECK_STATUS(BREVE_OK, call(&g, "go", NULL));
  CHECK_STATUS(BREVE_OK, breve_world_profile_node_count(g.world, &count));
  for (size_t i = 0; i < count; ++i) {
    breve_profile_node node;
    CHECK_STATUS(BREVE_OK, breve_world_profile_node(g.world, i, &node));
    found = found || (node.kind == BREVE_PROFILE_FUNCTION && strcmp(node.name, "echoA") == 0 && node.calls == 1);
  }
  CHECK(found);
  guest_close(&g);
}

void functions_suite(void) {
  RUN(arguments_are_converted_to_the_declared_types);
  RUN(values_of_each_type_go_in_and_out);
  RUN(results_that_do_not_convert_are_errors_of_the_script);
  RUN(what_cannot_be_called_is_refused);
  RUN(the_compiler_knows_names_and_numbers_of_arguments);
  RUN(a_failing_function_is_an_error_at_its_call);
  RUN(functions_call_methods_and_hand_on_their_errors);
  RUN(a_function_may_free_its_caller_and_make_objects);
  RUN(work_is_counted_against_the_budget);
  RUN(worlds_of_one_program_differ_by_their_user);
  RUN(what_cannot_work_in_a_running_script_is_busy);
  RUN(data_of_a_function_is_destroyed_once_when_nobody_can_call_it);
  RUN(analyses_know_functions_of_the_host);
  RUN(profiles_name_functions_of_the_host);
}
