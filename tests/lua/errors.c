/* Every function of the binding raises an error, in each way in which one can leave it: out to breve, into a pcall, out
   of a coroutine, through a method in steve. Run with both builds of Lua: with one an error is a long jump, with the
   other an exception. */
#include <lauxlib.h>
#include <lualib.h>
#include <stdlib.h>

#include "scene.h"

static char text[32768];

static const char* read_file(const char* name) {
  char path[1024];
  snprintf(path, sizeof path, "%s/%s", BREVE_TEST_FOLDER, name);
  FILE* file = fopen(path, "rb");
  const size_t size = file ? fread(text, 1, sizeof text - 1, file) : 0;
  if (file) fclose(file);
  text[size] = 0;
  CHECK(size > 0 && size < sizeof text - 1);
  return text;
}

static const char* const in_steve =
    "@use Control.\n@use Mobile.\nControl : Base {\n"
    "  + to divide: return 1 / 0.\n"
    "  + to back: return (self fail number 1).\n"
    "  + to through-steve number n (int): return (self fail number n).\n"
    "}\n";

static void begin(stage* s, uint32_t rights) {
  stage_begin(s);
  s->steve = in_steve;
  s->rights = rights;
}

static bool open(stage* s, const breve_world_config* config) {
  static char whole[40000];
  begin(s, BREVE_LUA_DEBUG);
  snprintf(whole, sizeof whole, "breve.use 'Steve.tz'\n%s", read_file("errors.lua"));
  return stage_open(s, whole, config);
}

static breve_status call_with(stage* s, const char* method, const char* keyword, breve_value argument,
                              breve_value* result) {
  breve_keyword given;
  given.name = keyword;
  given.value = argument;
  return breve_object_call(s->world, breve_world_controller(s->world), method, &given, 1, result);
}

static void no_function_is_without_a_case(void) {
  stage s;
  breve_value result = breve_value_null();
  if (!open(&s, NULL)) return;
  if (CHECK_STATUS(BREVE_OK, stage_call(&s, "unlisted", &result)))
    CHECK_TEXT("", result.as.string.bytes);
  else
    printf("  %s\n", breve_world_last_error(s.world)->text);
  CHECK_NEAR(1, stage_number(&s, "quiet-ones"), 0);
  stage_end(&s);
}

/* Functions that stock Lua does not have under the same name are the binding's. */
static void no_global_is_without_a_case(void) {
  static const char* const libraries[] = {"_G", "string", "math", "table", "utf8", "coroutine"};
  stage s;
  int replaced = 0;
  if (!open(&s, NULL)) return;
  lua_State* stock = luaL_newstate();
  luaL_openlibs(stock);
  lua_State* L = breve_lua_state(s.world);
  for (size_t i = 0; i < sizeof libraries / sizeof *libraries; ++i) {
    lua_getglobal(stock, libraries[i]);
    lua_getglobal(L, libraries[i]);
    for (lua_pushnil(L); lua_next(L, -2); lua_pop(L, 1)) {
      if (!lua_iscfunction(L, -1)) continue;
      const char* key = lua_tostring(L, -2);
      lua_getfield(stock, -1, key);
      if (lua_tocfunction(L, -1) != lua_tocfunction(stock, -1)) {
        char name[80];
        breve_value known = breve_value_null();
        snprintf(name, sizeof name, "%s%s%s", i == 0 ? "" : libraries[i], i == 0 ? "" : ".", key);
        ++replaced;
        CHECK_STATUS(BREVE_OK, call_with(&s, "has-case", "name", breve_value_string(name), &known));
        if (!CHECK(known.as.integer == 1)) printf("  %s has no case\n", name);
      }
      lua_pop(stock, 1);
    }
    lua_settop(stock, 0);
    lua_pop(L, 1);
  }
  CHECK(replaced >= 8);
  lua_close(stock);
  stage_end(&s);
}

static void every_case_raises_an_error(void) {
  stage s;
  if (!open(&s, NULL)) return;
  const int count = (int)stage_number(&s, "count");
  CHECK(count > 50);
  for (int i = 1; i <= count; ++i) {
    breve_value name = breve_value_null(), why = breve_value_null();
    CHECK_STATUS(BREVE_OK, call_with(&s, "catch", "number", breve_value_int(i), &why));
    const bool caught = CHECK(why.type == BREVE_TYPE_STRING && why.as.string.size == 0);
    if (!caught && why.type == BREVE_TYPE_STRING) printf("  %s\n", why.as.string.bytes);
    const bool failed = CHECK_STATUS(BREVE_ERROR_SCRIPT, call_with(&s, "fail", "number", breve_value_int(i), NULL));
    const breve_error* error = breve_world_last_error(s.world);
    const bool told = !failed || CHECK(error->message[0] != 0 && error->frame_count > 0);
    if (caught && failed && told) continue;
    CHECK_STATUS(BREVE_OK, call_with(&s, "name-of", "number", breve_value_int(i), &name));
    printf("  in case '%s': %s\n", name.as.string.bytes, error->text);
  }
  CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  CHECK_STATUS(BREVE_OK, breve_world_hash(s.world, &(uint64_t){0}));
  stage_end(&s);
}

/* What needs a world raises an error while a file is described: no world exists then. */
static void what_needs_a_world_says_so(void) {
  static const char* const calls[] = {"breve.alive()",      "breve.controller()",        "breve.time()",
                                      "breve.iteration()",  "breve.new('Mobile')",       "breve.free(1)",
                                      "breve.objects()",    "breve.random(1)",           "breve.get(1, 'x')",
                                      "breve.is_a(1, 1)",   "breve.set(1, 'x', 1)",      "breve.class_name(1)",
                                      "breve.class('A')()", "breve.class('A').super.f()"};
  for (size_t i = 0; i < sizeof calls / sizeof *calls; ++i) {
    stage s;
    begin(&s, 0);
    CHECK_STATUS(BREVE_ERROR_COMPILE, stage_compile(&s, calls[i]));
    if (!CHECK(strstr(s.why, "there is no world yet") != NULL)) printf("  %s: %s\n", calls[i], s.why);
    stage_end(&s);
  }
}

/* Memory ends at any moment of any case: an error like others, and the world can be used up to its end. */
static void every_case_survives_the_end_of_memory(void) {
  stage s;
  breve_stats stats = breve_stats_default();
  size_t ended = 0;
  if (!open(&s, NULL)) return;
  const int count = (int)stage_number(&s, "count");
  CHECK_STATUS(BREVE_OK, breve_world_stats(s.world, &stats));
  stage_end(&s);
  for (size_t room = 1000; room <= 100000; room += 11000) {
    breve_world_config config = breve_world_config_default();
    config.memory_limit = stats.memory_peak + room;
    if (!open(&s, &config)) return;
    for (int i = 1; i <= count; ++i) {
      const breve_status status = call_with(&s, "fail", "number", breve_value_int(i), NULL);
      CHECK(status == BREVE_ERROR_SCRIPT || status == BREVE_ERROR_MEMORY);
      if (status == BREVE_ERROR_MEMORY) ++ended;
    }
    stage_end(&s);
  }
  CHECK(ended > 10);
}

/* The library of an interpreter, in this process and with this build of Lua. */
static void the_module_raises_errors(void) {
  lua_State* L = luaL_newstate();
  luaL_openlibs(L);
  luaL_requiref(L, "breve", luaopen_breve, 1);
  lua_settop(L, 0);
  const char* code = read_file("errors_module.lua");
  const bool good =
      luaL_loadbuffer(L, code, strlen(code), "@errors_module.lua") == LUA_OK && lua_pcall(L, 0, 0, 0) == LUA_OK;
  if (!CHECK(good)) printf("  %s\n", lua_tostring(L, -1));
  lua_close(L);
}

int main(void) {
  RUN(no_function_is_without_a_case);
  RUN(no_global_is_without_a_case);
  RUN(every_case_raises_an_error);
  RUN(what_needs_a_world_says_so);
  RUN(every_case_survives_the_end_of_memory);
  RUN(the_module_raises_errors);
  if (failures != 0) printf("%d checks failed\n", failures);
  return failures != 0;
}
