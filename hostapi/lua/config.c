/* The table that breve.world takes, read into a breve_world_config. A field that does not exist is an error: a misspelt
   seed would otherwise give another world in silence. */
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include "binding.h"

typedef enum kind { ANY_COUNT, COUNT, SIZE, SMALL_COUNT, NUMBER, FLAG, TEXT, TEXTS, ELSEWHERE } kind;

typedef struct field {
  const char* name;
  kind kind;
  size_t offset;
} field;

#define FIELD(name, kind) \
  { #name, kind, offsetof(breve_world_config, name) }
static const field fields[] = {
    {"controller", ELSEWHERE, 0}, /* it is part of the program */
    FIELD(seed, ANY_COUNT),
    FIELD(arguments, TEXTS),
    FIELD(budget, COUNT),
    FIELD(call_budget, COUNT),
    FIELD(physics_budget, COUNT),
    FIELD(memory_limit, SIZE),
    FIELD(depth_limit, SMALL_COUNT),
    FIELD(nesting_limit, SMALL_COUNT),
    FIELD(advance_limit, SMALL_COUNT),
    FIELD(dimension, SMALL_COUNT),
    FIELD(iteration_step, NUMBER),
    FIELD(integration_step, NUMBER),
    FIELD(length_unit, NUMBER),
    FIELD(patience, NUMBER),
    FIELD(accuracy, TEXT),
    FIELD(strict, FLAG),
    FIELD(verbose, FLAG),
    FIELD(coarse_random, FLAG),
};
enum { FIELDS = sizeof fields / sizeof *fields };

/* ---- names that are wrong ---------------------------------------------------------------------------------------------- */

static const field* field_named(const char* name) {
  for (size_t i = 0; i < FIELDS; ++i)
    if (strcmp(fields[i].name, name) == 0) return &fields[i];
  return NULL;
}

static void fail_unknown(lua_State* L, const char* key) {
  const char* meant = NULL;
  for (size_t i = 0; i < FIELDS && !meant; ++i)
    if (bl_is_one_slip_apart(key, fields[i].name)) meant = fields[i].name;
  if (meant) luaL_error(L, "breve.world has no field '%s'; did you mean '%s'?", key, meant);
  luaL_Buffer text;
  luaL_buffinit(L, &text);
  for (size_t i = 0; i < FIELDS; ++i) {
    if (i != 0) luaL_addstring(&text, ", ");
    luaL_addstring(&text, fields[i].name);
  }
  luaL_pushresult(&text);
  luaL_error(L, "breve.world has no field '%s'; its fields are %s", key, lua_tostring(L, -1));
}

/* The first one in the alphabet is reported, as a table has no order of its own. */
static void check_names(lua_State* L) {
  const char* unknown = NULL;
  for (lua_pushnil(L); lua_next(L, 1); lua_pop(L, 1)) {
    if (lua_type(L, -2) != LUA_TSTRING)
      luaL_error(L, "breve.world takes fields by name, as in breve.world{controller = Class, seed = 1}");
    const char* key = lua_tostring(L, -2);
    if (!field_named(key) && (!unknown || strcmp(key, unknown) < 0)) unknown = key;
  }
  if (unknown) fail_unknown(L, unknown);
}

/* ---- values, on top of the stack ---------------------------------------------------------------------------------------- */

static void need_type(lua_State* L, const field* f, int type) {
  if (lua_type(L, -1) != type)
    luaL_error(L, "%s of breve.world: %s expected, got %s", f->name, lua_typename(L, type), luaL_typename(L, -1));
}

static uint64_t whole(lua_State* L, const field* f, uint64_t most) {
  int exact = 0;
  need_type(L, f, LUA_TNUMBER);
  const lua_Integer number = lua_tointegerx(L, -1, &exact);
  if (!exact) luaL_error(L, "%s of breve.world must be a whole number", f->name);
  if (f->kind != ANY_COUNT && (number < 0 || (uint64_t)number > most))
    luaL_error(L, "%s of breve.world is %I, and must be from 0 to %I", f->name, (LUAI_UACINT)number, (LUAI_UACINT)most);
  return (uint64_t)number;
}

static double finite_number(lua_State* L, const field* f) {
  need_type(L, f, LUA_TNUMBER);
  const double number = lua_tonumber(L, -1);
  if (!isfinite(number)) luaL_error(L, "%s of breve.world must be a finite number", f->name);
  return number;
}

/* The list stands at index 2 from then on, and its texts in the table of the caller. */
static void read_texts(lua_State* L, const field* f, breve_world_config* config) {
  need_type(L, f, LUA_TTABLE);
  const size_t count = (size_t)lua_rawlen(L, -1);
  const char** texts = (const char**)lua_newuserdatauv(L, (count + 1) * sizeof *texts, 0);
  for (size_t i = 0; i < count; ++i) {
    if (lua_rawgeti(L, -2, (lua_Integer)i + 1) != LUA_TSTRING)
      luaL_error(L, "arguments of breve.world: number %I is not a text", (LUAI_UACINT)i + 1);
    texts[i] = lua_tostring(L, -1);
    lua_pop(L, 1);
  }
  lua_replace(L, 2);
  config->arguments = texts;
  config->argument_count = count;
}

static void read_field(lua_State* L, const field* f, breve_world_config* config) {
  char* const at = (char*)config + f->offset;
  const uint64_t large = INT64_MAX, largest_size = SIZE_MAX < large ? SIZE_MAX : large;
  switch (f->kind) {
    case ANY_COUNT:
    case COUNT: *(uint64_t*)at = whole(L, f, large); break;
    case SIZE: *(size_t*)at = (size_t)whole(L, f, largest_size); break;
    case SMALL_COUNT: *(uint32_t*)at = (uint32_t)whole(L, f, UINT32_MAX); break;
    case NUMBER: *(double*)at = finite_number(L, f); break;
    case FLAG:
      need_type(L, f, LUA_TBOOLEAN);
      *(bool*)at = lua_toboolean(L, -1);
      break;
    case TEXT:
      need_type(L, f, LUA_TSTRING);
      *(const char**)at = lua_tostring(L, -1);
      break;
    case TEXTS: read_texts(L, f, config); break;
    case ELSEWHERE: break;
  }
}

breve_world_config bl_read_config(lua_State* L) {
  breve_world_config config = breve_world_config_default();
  luaL_checktype(L, 1, LUA_TTABLE);
  lua_settop(L, 1);
  check_names(L);
  lua_pushnil(L); /* the place of the arguments */
  for (size_t i = 0; i < FIELDS; ++i) {
    lua_pushstring(L, fields[i].name);
    if (lua_rawget(L, 1) != LUA_TNIL) read_field(L, &fields[i], &config);
    lua_settop(L, 2);
  }
  return config;
}
