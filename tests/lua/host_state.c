/* Agents that run in a Lua state of the host: what it has there, they have; what they leave there, it finds. */
#include <lauxlib.h>
#include <lualib.h>

#include "scene.h"

static const char* const agents =
    "local Main = breve.class('Main', 'Control')\nbreve.main(Main)\n"
    "loads[1] = loads[1] + 1\n"
    "local Bird = breve.class('Bird', 'Mobile')\n"
    "function Bird:legs() return legs(self) end\n"
    "function Main:init() self.bird = Bird() log[#log + 1] = 'begun' end\n"
    "function Main:legs() return self.bird:legs() end\n"
    "function Main:iterate() log[#log + 1] = 'stepped' end\n"
    "function Main:has_libraries() return io ~= nil and os ~= nil and debug ~= nil end\n"
    "function Main:fail() fail() end\n";

/* A function of the host, for agents. */
static int count_legs(lua_State* L) {
  luaL_checktype(L, 1, LUA_TTABLE);
  lua_pushinteger(L, 2);
  return 1;
}

static lua_State* host_state(void) {
  lua_State* L = luaL_newstate();
  luaL_openlibs(L);
  lua_register(L, "legs", count_legs);
  if (luaL_dostring(L, "log, loads = {}, {0} function fail() error('of the host') end")) lua_pop(L, 1);
  return L;
}

static bool compile(stage* s, lua_State* L, const char* text) {
  breve_lua_config config = breve_lua_config_default();
  config.state = L;
  const bool good = CHECK_STATUS(
      BREVE_OK, breve_lua_compile(s->runtime, &config, "agents.lua", text, strlen(text), NULL, NULL, &s->program));
  return good && CHECK_STATUS(BREVE_OK, breve_world_create(s->runtime, s->program, NULL, &s->world));
}

static double number_of(lua_State* L, const char* expression) {
  char text[200];
  snprintf(text, sizeof text, "return %s", expression);
  CHECK(luaL_dostring(L, text) == LUA_OK);
  const double number = lua_tonumber(L, -1);
  lua_pop(L, 1);
  return number;
}

static void agents_run_in_the_state_of_the_host(void) {
  stage s;
  lua_State* L = host_state();
  stage_begin(&s);
  if (compile(&s, L, agents)) {
    CHECK(breve_lua_state(s.world) == L);
    CHECK_NEAR(2, stage_number(&s, "legs"), 0);
    CHECK_NEAR(1, stage_number(&s, "has-libraries"), 0);
    CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
    CHECK_NEAR(2, number_of(L, "#log"), 0);
    CHECK_NEAR(1, number_of(L, "breve == nil and 1 or 0"), 0); /* a file has `breve`; the host's globals do not */
    CHECK_STATUS(BREVE_ERROR_SCRIPT, stage_call(&s, "fail", NULL));
    CHECK_TEXT("of the host", breve_world_last_error(s.world)->message);
    CHECK(lua_gettop(L) == 0);
  }
  stage_end(&s);
  CHECK(lua_gettop(L) == 0);
  lua_close(L);
}

/* The file is run once, and each world has objects of its own. */
static void worlds_share_the_state(void) {
  stage s;
  breve_world* other = NULL;
  lua_State* L = host_state();
  stage_begin(&s);
  if (compile(&s, L, agents) && CHECK_STATUS(BREVE_OK, breve_world_create(s.runtime, s.program, NULL, &other))) {
    CHECK_NEAR(1, number_of(L, "loads[1]"), 0);
    CHECK(breve_lua_state(other) == L);
    CHECK_STATUS(BREVE_OK, breve_world_step(other));
    CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
    CHECK_NEAR(4, number_of(L, "#log"), 0);
    CHECK_STATUS(BREVE_OK, breve_world_destroy(other));
    CHECK_NEAR(2, stage_number(&s, "legs"), 0);
  } else {
    CHECK_STATUS(BREVE_OK, breve_world_destroy(other));
  }
  stage_end(&s);
  CHECK_NEAR(4, number_of(L, "#log"), 0); /* the state outlives worlds, program and runtime */
  lua_close(L);
}

/* A reason for which a file is refused leaves the state as it was. */
static void a_wrong_file_leaves_the_state(void) {
  static const char* const wrong[] = {"local = 1", "error('stop')", "breve.class('A', 'Mobile')", "\033Lua"};
  stage s;
  lua_State* L = host_state();
  breve_lua_config config = breve_lua_config_default();
  config.state = L;
  stage_begin(&s);
  for (size_t i = 0; i < sizeof wrong / sizeof *wrong; ++i) {
    CHECK_STATUS(BREVE_ERROR_COMPILE, breve_lua_compile(s.runtime, &config, "agents.lua", wrong[i], strlen(wrong[i]),
                                                        NULL, NULL, &s.program));
    CHECK(lua_gettop(L) == 0);
  }
  if (compile(&s, L, agents)) CHECK_NEAR(2, stage_number(&s, "legs"), 0);
  stage_end(&s);
  lua_close(L);
}

int main(void) {
  RUN(agents_run_in_the_state_of_the_host);
  RUN(worlds_share_the_state);
  RUN(a_wrong_file_leaves_the_state);
  if (failures != 0) printf("%d checks failed\n", failures);
  return failures != 0;
}
