/* Every selector of the class library, called from Lua. The list is what the classes say of themselves. A call in Lua's
   spelling is made for each, with arguments of the types of its keywords, and the trace of the world must show that the
   method that was meant has begun; what it then says of such arguments is its own affair. */
#include <stdlib.h>

#include "breve/analysis.h"
#include "scene.h"

enum { MOST_CLASSES = 200, MOST_METHODS = 3000 };

typedef struct call {
  char class_name[60], name[60];
} call;

static char program[2000000];
static size_t length;
static call calls[MOST_METHODS];
static size_t call_count;

static void add(const char* text, char from, char to) {
  for (; *text && length + 1 < sizeof program; ++text) program[length++] = *text == from ? to : *text;
  program[length] = 0;
}

static const char* argument_of(uint32_t type) {
  switch (type) {
    case BREVE_TYPE_DOUBLE: return "0.5";
    case BREVE_TYPE_VECTOR: return "breve.vector(1, 2, 3)";
    case BREVE_TYPE_MATRIX: return "breve.matrix(1, 0, 0, 0, 1, 0, 0, 0, 1)";
    case BREVE_TYPE_STRING:
    case BREVE_TYPE_DATA: return "'text'";
    case BREVE_TYPE_OBJECT: return "object";
    case BREVE_TYPE_LIST: return "{1, 2}";
    case BREVE_TYPE_HASH: return "{a = 1}";
    default: return "1";
  }
}

static bool is_word_of_lua(const char* name) {
  static const char* const words[] = {"and",      "break",  "do",   "else", "elseif", "end",  "false", "for",
                                      "function", "goto",   "if",   "in",   "local",  "nil",  "not",   "or",
                                      "repeat",   "return", "then", "true", "until",  "while"};
  for (size_t i = 0; i < sizeof words / sizeof *words; ++i)
    if (strcmp(words[i], name) == 0) return true;
  return false;
}

/* function Main:call_7() local object = breve.new('Camera') object:point{['vertex'] = ..., ['at'] = ...} return 1 end
 */
static void add_call(const breve_method_info* m, bool controls) {
  char head[160];
  call* c = &calls[call_count];
  snprintf(c->class_name, sizeof c->class_name, "%s", m->class_name);
  snprintf(c->name, sizeof c->name, "%s", m->name);
  snprintf(head, sizeof head, "function Main:call_%zu() local object = ", call_count++);
  add(head, 0, 0);
  snprintf(head, sizeof head, controls ? "self" : "breve.new('%s')", m->class_name);
  add(head, 0, 0);
  const bool named = m->keyword_count > 1, word = is_word_of_lua(m->name);
  add(word ? " object['" : " object:", 0, 0);
  add(m->name, '-', '_');
  if (word) add(m->keyword_count > 0 ? "'](object, " : "'](object", 0, 0);
  add(named ? "{" : word ? "" : "(", 0, 0);
  for (size_t k = 0; k < m->keyword_count; ++k) {
    if (k != 0) add(", ", 0, 0);
    if (named) add("['", 0, 0);
    if (named) add(m->keywords[k], '-', '_');
    if (named) add("'] = ", 0, 0);
    add(argument_of(m->types[k]), 0, 0);
  }
  add(named && word ? "})" : named ? "}" : ")", 0, 0);
  add(" return 1 end\n", 0, 0);
}

static void begin_program(const char* controller) {
  length = 0;
  call_count = 0;
  for (size_t i = 0; i < breve_library_module_count(); ++i) {
    breve_source module;
    CHECK_STATUS(BREVE_OK, breve_library_module(i, &module));
    add("breve.use '", 0, 0);
    for (const char* c = module.name; *c && *c != '.'; ++c) add((const char[]){*c, 0}, 0, 0);
    add("'\n", 0, 0);
  }
  add("local Main = breve.class('Main', '", 0, 0);
  add(controller, 0, 0);
  add("')\nbreve.main(Main)\n", 0, 0);
}

typedef struct watch {
  const call* wanted;
  bool begun;
} watch;

static void trace(void* user, const breve_trace_event* event) {
  watch* w = user;
  if (event->begins && w->wanted && strcmp(event->name, w->wanted->name) == 0 &&
      strcmp(event->class_name, w->wanted->class_name) == 0)
    w->begun = true;
}

static bool open(stage* s, watch* w) {
  breve_world_config config = breve_world_config_default();
  stage_begin(s);
  config.budget = 200000;
  config.memory_limit = 64 << 20;
  return stage_open(s, program, &config) && CHECK_STATUS(BREVE_OK, breve_world_profile_start(s->world, trace, w));
}

/* Calls all that the program has; some end the world, or use it up. */
static size_t run_calls(void) {
  stage s;
  watch w = {NULL, false};
  size_t answered = 0;
  if (!open(&s, &w)) return 0;
  for (size_t i = 0; i < call_count; ++i) {
    char method[40];
    breve_stats stats = breve_stats_default();
    breve_world_stats(s.world, &stats);
    if (!breve_object_alive(s.world, breve_world_controller(s.world)) || stats.memory_used > 40 << 20) {
      stage_end(&s);
      if (!open(&s, &w)) return answered;
    }
    w.wanted = &calls[i];
    w.begun = false;
    snprintf(method, sizeof method, "call-%zu", i);
    const breve_status status = stage_call(&s, method, NULL);
    CHECK(status == BREVE_OK || status == BREVE_ERROR_SCRIPT || status == BREVE_ERROR_BUDGET ||
          status == BREVE_ERROR_MEMORY);
    if (status == BREVE_OK) ++answered;
    /* The binding answers is_a itself: the 0 of the library's method would be true in Lua. */
    if (!CHECK(w.begun || strcmp(calls[i].name, "is-a") == 0))
      printf("  %s %s: %s\n", calls[i].class_name, calls[i].name,
             status == BREVE_OK ? "no error" : breve_world_last_error(s.world)->text);
    w.wanted = NULL;
  }
  stage_end(&s);
  return answered;
}

typedef struct kind {
  char name[60], parent[60];
  bool controls;
} kind;

static kind kinds[MOST_CLASSES];
static size_t kind_count;

/* The classes of the library, parents before their descendants. */
static void list_classes(void) {
  stage s;
  begin_program("Control");
  stage_begin(&s);
  if (!CHECK_STATUS(BREVE_OK, stage_compile(&s, program))) printf("%s\n", s.why);
  for (size_t i = 0; i < breve_program_class_count(s.program) && kind_count < MOST_CLASSES; ++i) {
    breve_class_info info;
    CHECK_STATUS(BREVE_OK, breve_program_class(s.program, i, &info));
    if (strcmp(info.name, "Main") == 0) continue;
    kind* k = &kinds[kind_count++];
    snprintf(k->name, sizeof k->name, "%s", info.name);
    snprintf(k->parent, sizeof k->parent, "%s", info.parent);
    k->controls = strcmp(info.name, "Control") == 0;
    for (size_t p = 0; p + 1 < kind_count; ++p)
      if (kinds[p].controls && strcmp(kinds[p].name, info.parent) == 0) k->controls = true;
  }
  stage_end(&s);
  CHECK(kind_count > 50 && kind_count < MOST_CLASSES);
}

/* The methods that a class defines itself. */
static void add_class(breve_world* world, const kind* k) {
  static breve_method_info methods[MOST_METHODS];
  size_t count = 0;
  CHECK_STATUS(BREVE_OK, breve_world_methods(world, k->name, methods, MOST_METHODS, &count));
  for (size_t i = 0; i < count && i < MOST_METHODS && call_count < MOST_METHODS; ++i)
    if (strcmp(methods[i].class_name, k->name) == 0) add_call(&methods[i], k->controls);
}

static void every_selector_of_the_library_is_reached(void) {
  stage s;
  size_t called = 0, answered = 0;
  list_classes();
  for (size_t i = 0; i <= kind_count; ++i) { /* at the end, all other classes in one world */
    if (i < kind_count && !kinds[i].controls) continue;
    begin_program(i < kind_count ? kinds[i].name : "Control");
    stage_begin(&s);
    if (!CHECK_STATUS(BREVE_OK, stage_compile(&s, program))) printf("%s\n", s.why);
    CHECK_STATUS(BREVE_OK, breve_world_create(s.runtime, s.program, NULL, &s.world));
    if (i < kind_count) add_class(s.world, &kinds[i]);
    for (size_t k = 0; i == kind_count && k < kind_count; ++k)
      if (!kinds[k].controls) add_class(s.world, &kinds[k]);
    stage_end(&s);
    called += call_count;
    answered += run_calls();
  }
  printf("%zu selectors of %zu classes, %zu without an error of the method\n", called, kind_count, answered);
  CHECK(called > 800 && called < MOST_METHODS);
  CHECK(answered * 2 > called);
}

int main(void) {
  RUN(every_selector_of_the_library_is_reached);
  if (failures != 0) printf("%d checks failed\n", failures);
  return failures != 0;
}
