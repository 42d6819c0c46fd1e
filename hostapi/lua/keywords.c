/* Calls by keyword of methods that are written in Lua: `bird:set_goal{to = p, weight = 2}`. The keywords are those that
   breve knows the method by: those of the method that it overrides, if there is one. The names of its parameters are
   also accepted. A key that is neither is an error, as an argument that is left out in silence is hard to find. */
#include <string.h>

#include "binding.h"

/* Upvalues: the function, the method's name, the number of its parameters, the keywords, the parameters' names. */
enum { FUNCTION = 1, NAME, COUNT, NAMES };

/* The position of the argument that a key names, or -1. A keyword takes precedence over a parameter of that name. */
static int position_of(lua_State* L, int key, int count) {
  for (int i = 0; i < 2 * count; ++i)
    if (lua_rawequal(L, key, lua_upvalueindex(NAMES + i))) return i % count;
  return -1;
}

/* One letter too many, one too few, another one, or two that have changed places. */
bool bl_is_one_slip_apart(const char* a, const char* b) {
  while (*a && *a == *b) ++a, ++b;
  if (*a == 0 && *b == 0) return false;
  if (*a && *b && a[0] == b[1] && a[1] == b[0] && strcmp(a + 2, b + 2) == 0) return true;
  return (*a && strcmp(a + 1, b) == 0) || (*b && strcmp(a, b + 1) == 0) || (*a && *b && strcmp(a + 1, b + 1) == 0);
}

/* The name that a key was meant to be, or NULL. Names of one or two letters are too much alike. */
static const char* meant_by(lua_State* L, const char* key, int count) {
  for (int i = 0; i < 2 * count; ++i) {
    const char* name = lua_tostring(L, lua_upvalueindex(NAMES + i));
    if (strlen(name) > 2 && bl_is_one_slip_apart(key, name)) return name;
  }
  return NULL;
}

/* Is the only argument meant as a table of arguments? One of its keys names an argument then, or was meant to. */
static bool is_by_keyword(lua_State* L, int count) {
  if (lua_gettop(L) != 2 || !lua_istable(L, 2) || bl_is_object(L, 2)) return false;
  luaL_checkstack(L, 2 * count + 10, NULL); /* the arguments, and the parts of an error */
  for (lua_pushnil(L); lua_next(L, 2); lua_pop(L, 1)) {
    if (lua_type(L, -2) != LUA_TSTRING) continue;
    if (position_of(L, -2, count) < 0 && !meant_by(L, lua_tostring(L, -2), count)) continue;
    lua_settop(L, 2);
    return true;
  }
  return false;
}

/* @param key  NULL: it is not a text */
static int fail_unknown(lua_State* L, const char* key, int count) {
  const char* method = lua_tostring(L, lua_upvalueindex(NAME));
  luaL_where(L, 1);
  if (key)
    lua_pushfstring(L, "method '%s' has no keyword '%s'", method, key);
  else
    lua_pushfstring(L, "method '%s' is called by keyword, with a key that is not a text", method);
  const char* meant = key ? meant_by(L, key, count) : NULL;
  if (meant)
    lua_pushfstring(L, "; did you mean '%s'?", meant);
  else
    lua_pushliteral(L, "");
  lua_pushfstring(L, " (%s{", method);
  for (int i = 0; i < count; ++i)
    lua_pushfstring(L, i == 0 ? "%s = ..." : ", %s = ...", lua_tostring(L, lua_upvalueindex(NAMES + i)));
  lua_pushfstring(L, "}; a table that is itself the first argument needs the others behind it: %s(t, nil))", method);
  lua_concat(L, count + 5);
  return lua_error(L);
}

/* From the table to the arguments, in their order. The error does not depend on the order of the keys. */
static void spread(lua_State* L, int count) {
  const char* unknown = NULL;
  bool other = false;
  int twice = count;
  lua_settop(L, 2 + count);
  for (lua_pushnil(L); lua_next(L, 2); lua_pop(L, 1)) {
    const int position = position_of(L, -2, count);
    if (position >= 0) {
      if (!lua_isnil(L, 3 + position) && position < twice) twice = position;
      lua_pushvalue(L, -1);
      lua_replace(L, 3 + position);
    } else if (lua_type(L, -2) != LUA_TSTRING) {
      other = true;
    } else if (!unknown || strcmp(lua_tostring(L, -2), unknown) < 0) {
      unknown = lua_tostring(L, -2);
    }
  }
  if (unknown || other) fail_unknown(L, unknown, count);
  if (twice < count)
    luaL_error(L, "method '%s' is given one argument twice, as '%s' and as '%s'",
               lua_tostring(L, lua_upvalueindex(NAME)), lua_tostring(L, lua_upvalueindex(NAMES + twice)),
               lua_tostring(L, lua_upvalueindex(NAMES + count + twice)));
  lua_remove(L, 2);
}

static int call_by_name(lua_State* L) {
  const int count = (int)lua_tointeger(L, lua_upvalueindex(COUNT));
  if (is_by_keyword(L, count)) spread(L, count);
  lua_pushvalue(L, lua_upvalueindex(FUNCTION));
  lua_insert(L, 1);
  lua_call(L, lua_gettop(L) - 1, LUA_MULTRET);
  return lua_gettop(L);
}

void bl_push_lua_method(lua_State* L, bl_world* w, const bl_method* method, const breve_method_info* known) {
  bl_push_own(L, w->lib, method->owner->name, method->name);
  if (method->count < 2 || lua_isnil(L, -1)) return;
  luaL_checkstack(L, 2 * BL_PARAMETERS + 3, NULL);
  lua_pushstring(L, method->name);
  lua_pushinteger(L, (lua_Integer)method->count);
  for (size_t i = 0; i < method->count; ++i) {
    const bool adopted = known->keyword_count == method->count;
    luaL_gsub(L, adopted ? known->keywords[i] : method->keywords[i], "-", "_");
  }
  for (size_t i = 0; i < method->count; ++i) lua_pushstring(L, method->parameters[i]);
  lua_pushcclosure(L, call_by_name, 2 * (int)method->count + 3);
}
