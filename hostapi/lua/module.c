/* `require "breve"` in a Lua interpreter: the library, and worlds as values of Lua. Classes that a script defines make
   the program of the worlds that are made from then on; agents run in the interpreter's own state. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "binding.h"

#define WORLD "breve.world"
#define RUNTIME "breve.runtime"

typedef struct handle {
  breve_world* world; /* NULL: it was closed */
} handle;

/* ---- the runtime of the interpreter ---------------------------------------------------------------------------------- */

static void print(void* user, breve_world* world, breve_channel channel, const char* text, size_t size) {
  (void)user, (void)world;
  fwrite(text, 1, size, channel == BREVE_CHANNEL_PRINT ? stdout : stderr);
}

/* Modules in steve stand where the interpreter runs; it may read every file anyway. */
static bool resolve(void* user, const char* name, const char* from, breve_module* module) {
  FILE* file = fopen(name, "rb");
  char* text = NULL;
  long size = -1;
  (void)user, (void)from;
  if (!file) return false;
  if (fseek(file, 0, SEEK_END) == 0 && (size = ftell(file)) >= 0 && fseek(file, 0, SEEK_SET) == 0)
    text = (char*)malloc((size_t)size + 1);
  const bool good = text && fread(text, 1, (size_t)size, file) == (size_t)size;
  fclose(file);
  if (!good) {
    free(text);
    return false;
  }
  module->text = text;
  module->size = (size_t)size;
  module->cookie = text;
  return true;
}

static void release(void* user, const breve_module* module) {
  (void)user;
  free(module->cookie);
}

static int destroy_runtime(lua_State* L) {
  breve_runtime** runtime = (breve_runtime**)lua_touserdata(L, 1);
  breve_runtime_destroy(*runtime);
  *runtime = NULL;
  return 0;
}

static breve_runtime* runtime_of(lua_State* L) {
  if (lua_getfield(L, LUA_REGISTRYINDEX, RUNTIME) != LUA_TNIL) {
    breve_runtime* known = *(breve_runtime**)lua_touserdata(L, -1);
    lua_pop(L, 1);
    return known;
  }
  lua_pop(L, 1);
  breve_runtime** runtime = (breve_runtime**)lua_newuserdatauv(L, sizeof *runtime, 0);
  *runtime = NULL;
  lua_createtable(L, 0, 1);
  lua_pushcfunction(L, destroy_runtime);
  lua_setfield(L, -2, "__gc");
  lua_setmetatable(L, -2);
  breve_runtime_config config = breve_runtime_config_default();
  config.print = print;
  config.resolve_module = resolve;
  config.release_module = release;
  if (breve_runtime_create(&config, runtime) != BREVE_OK) luaL_error(L, "breve cannot be started");
  lua_setfield(L, LUA_REGISTRYINDEX, RUNTIME);
  return *runtime;
}

/* ---- making a world ---------------------------------------------------------------------------------------------------- */

static void note(void* sink, const char* text, size_t size) {
  lua_State* L = (lua_State*)sink; /* one text, on the stack of a protected call */
  lua_pushlstring(L, text, size);
}

static int fail_runtime(lua_State* L, breve_runtime* runtime, breve_status status) {
  const breve_error* error = breve_runtime_last_error(runtime);
  return luaL_error(L, "%s", error && error->status == (uint32_t)status ? error->text : breve_status_name(status));
}

/* The program of all classes that are defined now. It is kept for further worlds until a class or method is new. */
static breve_program* compile(lua_State* L, bl_lib* lib, breve_runtime* runtime) {
  if (lib->compiled) return lib->compiled;
  bl_program* program = bl_program_of_draft(lib->draft);
  if (!program) luaL_error(L, "there is no memory for a program");
  const int top = lua_gettop(L);
  breve_status status = bl_describe(L, lib, program, note, L);
  if (status == BREVE_OK) status = bl_register(runtime, program, note, L);
  if (status == BREVE_OK) status = bl_compile(runtime, program, note, L, &lib->compiled);
  bl_program_drop(program); /* its classes hold it */
  if (status == BREVE_OK) return lib->compiled;
  if (lua_gettop(L) > top) luaL_error(L, "%s", lua_tostring(L, -1));
  fail_runtime(L, runtime, status);
  return NULL;
}

static int make_world(lua_State* L) {
  bl_lib* lib = (bl_lib*)lua_touserdata(L, lua_upvalueindex(1));
  const breve_world_config config = bl_read_config(L);
  breve_runtime* runtime = runtime_of(L);
  lua_getfield(L, LUA_REGISTRYINDEX, "breve.library");
  if (!lib->draft) return luaL_error(L, "there is no memory for a program");
  if (lua_getfield(L, 1, "controller") != LUA_TNIL) {
    lua_getfield(L, -2, "main");
    lua_insert(L, -2);
    lua_call(L, 1, 0);
  }
  lua_settop(L, 2);
  handle* h = (handle*)lua_newuserdatauv(L, sizeof *h, 0);
  h->world = NULL;
  luaL_setmetatable(L, WORLD);
  /* The controller's init may define classes: the program stays until it is done. */
  breve_program* program = compile(L, lib, runtime);
  const uint64_t changes = lib->changes;
  lib->compiled = NULL;
  const breve_status status = breve_world_create(runtime, program, &config, &h->world);
  if (lib->changes == changes && !lib->compiled)
    lib->compiled = program;
  else
    breve_program_destroy(program);
  if (status != BREVE_OK) return fail_runtime(L, runtime, status);
  return 1;
}

/* ---- a world ----------------------------------------------------------------------------------------------------------- */

static breve_world* need_world(lua_State* L) {
  handle* h = (handle*)luaL_checkudata(L, 1, WORLD);
  if (!h->world) luaL_error(L, "the world is closed");
  return h->world;
}

static void check(lua_State* L, breve_world* world, breve_status status) {
  if (status == BREVE_OK) return;
  const breve_error* error = breve_world_last_error(world);
  luaL_error(L, "%s", error && error->status == (uint32_t)status ? error->text : breve_status_name(status));
}

static int step(lua_State* L) {
  breve_world* world = need_world(L);
  const lua_Integer count = luaL_optinteger(L, 2, 1);
  for (lua_Integer i = 0; i < count && !breve_world_ended(world); ++i) check(L, world, breve_world_step(world));
  lua_pushboolean(L, !breve_world_ended(world));
  return 1;
}

static int advance(lua_State* L) {
  breve_world* world = need_world(L);
  double fraction = 0;
  check(L, world, breve_world_advance(world, luaL_checknumber(L, 2), &fraction));
  lua_pushnumber(L, fraction);
  return 1;
}

static int ended(lua_State* L) {
  lua_pushboolean(L, breve_world_ended(need_world(L)));
  return 1;
}

static int hash(lua_State* L) {
  uint64_t number = 0;
  check(L, need_world(L), breve_world_hash(need_world(L), &number));
  lua_pushinteger(L, (lua_Integer)number);
  return 1;
}

static int snapshot(lua_State* L) {
  breve_world* world = need_world(L);
  size_t size = 0, room = 0;
  check(L, world, breve_world_snapshot(world, NULL, 0, &room));
  void* image = lua_newuserdatauv(L, room + 1, 0);
  check(L, world, breve_world_snapshot(world, image, room, &size));
  lua_pushlstring(L, (const char*)image, size);
  return 1;
}

static int restore(lua_State* L) {
  size_t size = 0;
  const char* image = luaL_checklstring(L, 2, &size);
  check(L, need_world(L), breve_world_restore(need_world(L), image, size));
  return 0;
}

/* world:use(): from now on breve.new, breve.time and the other functions of `breve` mean this world, outside of
   methods. */
static int use(lua_State* L) {
  bl_world* w = (bl_world*)breve_world_state(need_world(L), BL_STATE);
  if (!w) return luaL_error(L, "the world has no class that is written in Lua");
  w->lib->current = w;
  lua_settop(L, 1);
  return 1;
}

static int get_controller(lua_State* L) {
  use(L);
  bl_world* w = (bl_world*)breve_world_state(need_world(L), BL_STATE);
  bl_push_object(L, w, breve_world_controller(w->world));
  return 1;
}

static int close_world(lua_State* L) {
  handle* h = (handle*)luaL_checkudata(L, 1, WORLD);
  if (h->world && breve_world_destroy(h->world) != BREVE_OK) return luaL_error(L, "the world is running");
  h->world = NULL;
  return 0;
}

static const luaL_Reg methods[] = {{"step", step},        {"advance", advance},           {"ended", ended},
                                   {"hash", hash},        {"snapshot", snapshot},         {"restore", restore},
                                   {"use", use},          {"controller", get_controller}, {"close", close_world},
                                   {"__gc", close_world}, {"__close", close_world},       {NULL, NULL}};

int luaopen_breve(lua_State* L) {
  bl_lib* lib = bl_open(L);
  if (!lib->draft && !lib->current) {
    breve_lua_config config = breve_lua_config_default();
    config.state = lib->main;
    lib->draft = bl_program_new(&config, NULL, NULL, 0);
  }
  if (luaL_newmetatable(L, WORLD)) {
    luaL_setfuncs(L, methods, 0);
    lua_pushvalue(L, -1);
    lua_setfield(L, -2, "__index");
  }
  lua_pop(L, 1);
  lua_pushlightuserdata(L, lib);
  lua_pushcclosure(L, make_world, 1);
  lua_setfield(L, -2, "world");
  lua_pushcfunction(L, bl_ordered_pairs);
  lua_setfield(L, -2, "pairs");
  return 1;
}
