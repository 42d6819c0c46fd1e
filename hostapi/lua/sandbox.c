/* What of Lua's libraries agents get: nothing that reaches the machine, and nothing whose result depends on an address,
   on the moment, or on when memory is collected. */
#include <math.h>
#include <string.h>

#include "binding.h"

static bl_lib* lib_of(lua_State* L) { return (bl_lib*)lua_touserdata(L, lua_upvalueindex(1)); }

/* ---- texts -------------------------------------------------------------------------------------------------------- */

/* As tostring, but without the address that it gives for what has no text of its own. */
static void push_text(lua_State* L, int index) {
  const int type = lua_type(L, index);
  const bool plain = type == LUA_TTABLE || type == LUA_TFUNCTION || type == LUA_TTHREAD || type == LUA_TUSERDATA ||
                     type == LUA_TLIGHTUSERDATA;
  if (plain && luaL_getmetafield(L, index, "__tostring") == LUA_TNIL) {
    if (luaL_getmetafield(L, index, "__name") != LUA_TSTRING) lua_pushstring(L, lua_typename(L, type));
    return;
  }
  if (plain) lua_pop(L, 1);
  luaL_tolstring(L, index, NULL);
}

static int to_text(lua_State* L) {
  luaL_checkany(L, 1);
  push_text(L, 1);
  return 1;
}

static int print(lua_State* L) {
  bl_lib* lib = lib_of(L);
  const int count = lua_gettop(L);
  size_t size = 0;
  luaL_Buffer text;
  if (lib->loading || !lib->current) return 0;
  luaL_buffinit(L, &text);
  for (int i = 1; i <= count; ++i) {
    if (i > 1) luaL_addchar(&text, '\t');
    push_text(L, i);
    luaL_addvalue(&text);
  }
  luaL_addchar(&text, '\n');
  luaL_pushresult(&text);
  const char* bytes = lua_tolstring(L, -1, &size);
  const breve_status status = breve_world_print(lib->current->world, bytes, size);
  return status == BREVE_OK ? 0 : bl_fail(L, lib->current, status);
}

/* string.format, which gives addresses for %p, and for %s of what has no text of its own. */
static int format(lua_State* L) {
  const char* text = luaL_checkstring(L, 1);
  for (const char* c = strchr(text, '%'); c; c = strchr(c, '%')) {
    if (*++c == '%') {
      ++c;
      continue;
    }
    c += strspn(c, "-+ #0123456789.");
    if (*c == 'p') return luaL_error(L, "'%%p' gives an address, which differs from run to run");
  }
  const int count = lua_gettop(L);
  for (int i = 2; i <= count; ++i) {
    const int type = lua_type(L, i);
    if (type != LUA_TTABLE && type != LUA_TFUNCTION && type != LUA_TTHREAD && type != LUA_TUSERDATA) continue;
    push_text(L, i);
    lua_replace(L, i);
  }
  lua_pushvalue(L, lua_upvalueindex(1));
  lua_insert(L, 1);
  lua_call(L, count, 1);
  return 1;
}

/* ---- random numbers ----------------------------------------------------------------------------------------------- */

static double uniform(lua_State* L, bl_lib* lib) {
  double number = 0.5; /* while the file is described there is no generator, and no run that could see it */
  if (!lib->loading && lib->current) {
    const breve_status status = breve_world_draw_random(lib->current->world, &number);
    if (status != BREVE_OK) bl_fail(L, lib->current, status);
  }
  return number;
}

/* math.random(), math.random(m), math.random(m, n), from the world's generator. */
static int draw(lua_State* L) {
  bl_lib* lib = lib_of(L);
  const int count = lua_gettop(L);
  if (count == 0) {
    double number = uniform(L, lib);
    lua_pushnumber(L, number < 1 ? number : nextafter(1, 0));
    return 1;
  }
  const lua_Integer low = count == 1 ? 1 : luaL_checkinteger(L, 1), high = luaL_checkinteger(L, count == 1 ? 1 : 2);
  luaL_argcheck(L, low <= high, count, "interval is empty");
  const double range = (double)high - (double)low + 1, number = floor(uniform(L, lib) * range);
  const double offset = number < range ? number : range - 1;
  lua_pushinteger(L, (lua_Integer)((lua_Unsigned)low + (lua_Unsigned)offset));
  return 1;
}

static int refuse_seed(lua_State* L) {
  return luaL_error(L, "the numbers come from the world's generator, which has the world's seed");
}

/* ---- code --------------------------------------------------------------------------------------------------------- */

/* load(text [, name [, mode [, env]]]): of texts only. */
static int load_text(lua_State* L) {
  size_t size = 0;
  if (lua_type(L, 1) != LUA_TSTRING) return luaL_error(L, "'load' takes a text here");
  const char* text = lua_tolstring(L, 1, &size);
  const char* name = luaL_optstring(L, 2, text);
  const bool has_env = !lua_isnone(L, 4);
  bl_charge(L, lib_of(L), size); /* reading a byte of a program takes about as long as a loop iteration */
  if (luaL_loadbufferx(L, text, size, name, "t") != LUA_OK) {
    lua_pushnil(L);
    lua_insert(L, -2);
    return 2;
  }
  lua_pushvalue(L, has_env ? 4 : lua_upvalueindex(2)); /* the globals of the file */
  if (!lua_setupvalue(L, -2, 1)) lua_pop(L, 1);
  return 1;
}

/* When memory is collected is not for agents to see. */
static int set_metatable(lua_State* L) {
  if (lua_istable(L, 2)) {
    for (int i = 0; i < 2; ++i)
      if (lua_getfield(L, 2, i == 0 ? "__gc" : "__mode") != LUA_TNIL)
        return luaL_error(L, "'%s' makes a run depend on when memory is collected", i == 0 ? "__gc" : "__mode");
    lua_settop(L, 2);
  }
  lua_pushvalue(L, lua_upvalueindex(1));
  lua_insert(L, 1);
  lua_call(L, lua_gettop(L) - 1, 1);
  return 1;
}

/* Push the function that a file is, with its chunk's name below it. Lua names no file where it refuses bytecode. */
static void push_chunk(lua_State* L, const bl_text* text) {
  if (text->size != 0 && text->bytes[0] == LUA_SIGNATURE[0])
    luaL_error(L, "%s: this is bytecode of Lua, which is refused: give the source", text->name);
  lua_pushfstring(L, "@%s", text->name);
  if (luaL_loadbufferx(L, text->bytes, text->size, lua_tostring(L, -1), "t") != LUA_OK) lua_error(L);
}

static int require_module(lua_State* L) {
  bl_lib* lib = lib_of(L);
  const char* name = luaL_checkstring(L, 1);
  if (strcmp(name, "breve") == 0) {
    lua_getfield(L, LUA_REGISTRYINDEX, "breve.library");
    return 1;
  }
  lua_settop(L, 1);
  lua_pushvalue(L, 1);
  if (lua_rawget(L, lua_upvalueindex(2)) != LUA_TNIL) return 1;
  lua_pop(L, 1);
  bl_program* program = lib->loading           ? lib->loading
                        : lib->current->staged ? lib->current->staged
                                               : lib->current->program;
  lua_pushfstring(L, "%s.lua", name);
  const char* file = lua_tostring(L, -1);
  const bl_text* text = bl_program_text(program, file);
  breve_module module = {NULL, NULL, 0, NULL};
  const breve_lua_config* config = &program->config;
  if (!text && lib->loading && config->resolve_module &&
      config->resolve_module(config->user, file, program->texts[0].name, &module)) {
    text = bl_program_add_text(program, file, module.text, module.size);
    if (config->release_module) config->release_module(config->user, &module);
  }
  if (!text) return luaL_error(L, "there is no module '%s'", name);
  push_chunk(L, text);
  lua_pushvalue(L, lua_upvalueindex(3)); /* the globals of the file that asks */
  if (!lua_setupvalue(L, -2, 1)) lua_pop(L, 1);
  lua_call(L, 0, 1);
  if (lua_isnil(L, -1)) {
    lua_pop(L, 1);
    lua_pushboolean(L, 1);
  }
  lua_pushvalue(L, 1);
  lua_pushvalue(L, -2);
  lua_rawset(L, lua_upvalueindex(2));
  return 1;
}

/* ---- a file with globals of its own ------------------------------------------------------------------------------- */

void bl_run_program(lua_State* L, bl_lib* lib, bl_program* program) {
  const bl_text* text = &program->texts[0];
  luaL_checkstack(L, 12, NULL);
  push_chunk(L, text);
  lua_newtable(L);
  lua_pushglobaltable(L);
  for (lua_pushnil(L); lua_next(L, -2);) {
    lua_pushvalue(L, -2);
    lua_insert(L, -2);
    lua_rawset(L, -5);
  }
  lua_pop(L, 1);
  lua_pushvalue(L, -1);
  lua_setfield(L, -2, "_G");
  lua_getfield(L, LUA_REGISTRYINDEX, "breve.library");
  lua_setfield(L, -2, "breve");
  if ((program->config.allow & BREVE_LUA_PACKAGE) == 0) {
    lua_pushlightuserdata(L, lib);
    lua_newtable(L);
    lua_pushvalue(L, -3);
    lua_pushcclosure(L, require_module, 3);
    lua_setfield(L, -2, "require");
  }
  lua_pushlightuserdata(L, lib);
  lua_pushvalue(L, -2);
  lua_pushcclosure(L, load_text, 2);
  lua_setfield(L, -2, "load");
  if (!lua_setupvalue(L, -2, 1)) lua_pop(L, 1);
  lua_call(L, 0, 0);
  lua_pop(L, 1);
}

/* ---- the libraries ------------------------------------------------------------------------------------------------ */

static void open_library(lua_State* L, const char* name, lua_CFunction open) {
  luaL_requiref(L, name, open, 1);
  lua_pop(L, 1);
}

/* Put a function of ours around one of a library's table, or of the globals for NULL. */
static void wrap(lua_State* L, const char* table, const char* name, lua_CFunction function) {
  if (table)
    lua_getglobal(L, table);
  else
    lua_pushglobaltable(L);
  lua_getfield(L, -1, name);
  lua_pushcclosure(L, function, 1);
  lua_setfield(L, -2, name);
  lua_pop(L, 1);
}

static void remove_field(lua_State* L, const char* table, const char* name) {
  if (table)
    lua_getglobal(L, table);
  else
    lua_pushglobaltable(L);
  lua_pushnil(L);
  lua_setfield(L, -2, name);
  lua_pop(L, 1);
}

void bl_open_safe_libraries(lua_State* L, bl_lib* lib, uint32_t allow) {
  static const luaL_Reg ours[] = {{"print", print}, {NULL, NULL}};
  static const luaL_Reg math_functions[] = {{"random", draw}, {"randomseed", refuse_seed}, {NULL, NULL}};
  open_library(L, LUA_GNAME, luaopen_base);
  open_library(L, LUA_COLIBNAME, luaopen_coroutine);
  open_library(L, LUA_MATHLIBNAME, luaopen_math);
  open_library(L, LUA_STRLIBNAME, luaopen_string);
  open_library(L, LUA_TABLIBNAME, luaopen_table);
  open_library(L, LUA_UTF8LIBNAME, luaopen_utf8);
  if (allow & BREVE_LUA_IO) open_library(L, LUA_IOLIBNAME, luaopen_io);
  if (allow & BREVE_LUA_OS) open_library(L, LUA_OSLIBNAME, luaopen_os);
  if (allow & BREVE_LUA_PACKAGE) open_library(L, LUA_LOADLIBNAME, luaopen_package);
  if (allow & BREVE_LUA_DEBUG) open_library(L, LUA_DBLIBNAME, luaopen_debug);
  if ((allow & BREVE_LUA_IO) == 0) remove_field(L, NULL, "dofile"), remove_field(L, NULL, "loadfile");
  remove_field(L, NULL, "collectgarbage");
  remove_field(L, "string", "dump");
  wrap(L, "string", "format", format);
  wrap(L, NULL, "setmetatable", set_metatable);
  remove_field(L, NULL, "load");
  lua_pushcfunction(L, to_text);
  lua_setglobal(L, "tostring");
  lua_pushglobaltable(L);
  lua_pushlightuserdata(L, lib);
  luaL_setfuncs(L, ours, 1);
  lua_pop(L, 1);
  lua_getglobal(L, "math");
  lua_pushlightuserdata(L, lib);
  luaL_setfuncs(L, math_functions, 1);
  lua_pop(L, 1);
  bl_open_order(L);
  bl_open_patterns(L, lib);
  bl_open_metered(L, lib);
}
