/* Functions of Lua's libraries that go through much at one stretch, and make nothing that memory would be counted for:
   what they go through counts in the budget before they begin. Those of tables that move elements stand here whole. */
#include <stdlib.h>
#include <string.h>

#include "binding.h"

static bl_lib* lib_of(lua_State* L, int upvalue) { return (bl_lib*)lua_touserdata(L, lua_upvalueindex(upvalue)); }

/* How many elements count as one loop iteration in steve. */
enum { MOVED = 4, READ = 8, BYTES = 64 };

static uint64_t turns(lua_Integer from, lua_Integer to, unsigned share) {
  return from > to ? 0 : ((uint64_t)to - (uint64_t)from) / share;
}

/* ---- what a call goes through ------------------------------------------------------------------------------------- */

static uint64_t of_arguments(lua_State* L) { return (uint64_t)lua_gettop(L) / READ; }

/* An argument as a whole number, as Lua converts it; `otherwise` if it is something else. */
static lua_Integer whole(lua_State* L, int index, lua_Integer otherwise) {
  int is = 0;
  const lua_Integer number = lua_tointegerx(L, index, &is);
  return is ? number : otherwise;
}

/* From the argument `first` on, which is 1 if it is left out, to the next one, which is then the size. */
static uint64_t of_range(lua_State* L, int first, unsigned share) {
  if (!lua_istable(L, 1)) return 0;
  return turns(whole(L, first, 1), whole(L, first + 1, (lua_Integer)lua_rawlen(L, 1)), share);
}
static uint64_t of_concat(lua_State* L) { return of_range(L, 3, MOVED); }
static uint64_t of_unpack(lua_State* L) { return of_range(L, 2, READ); }
static uint64_t of_move(lua_State* L) { return turns(whole(L, 2, 1), whole(L, 3, 0), MOVED); }
static uint64_t of_repetitions(lua_State* L) { return turns(0, whole(L, 2, 0), READ); }

/* The bytes of a text from a place to another, both counted from the end if they are negative. */
static uint64_t of_bytes(lua_State* L, lua_Integer otherwise) {
  const lua_Integer size = lua_type(L, 1) == LUA_TSTRING ? (lua_Integer)lua_rawlen(L, 1) : 0;
  lua_Integer from = whole(L, 2, 1), to = whole(L, 3, otherwise == 0 ? from : otherwise);
  if (from < 0) from = from < -size ? 1 : size + from + 1;
  if (to < 0) to = to < -size ? 0 : size + to + 1;
  return turns(from, to < size ? to : size, READ);
}
static uint64_t of_byte(lua_State* L) { return of_bytes(L, 0); }
static uint64_t of_length(lua_State* L) { return of_bytes(L, -1); }
static uint64_t of_text(lua_State* L) { return lua_type(L, 1) == LUA_TSTRING ? lua_rawlen(L, 1) / BYTES : 0; }
static uint64_t of_offset(lua_State* L) {
  const lua_Integer n = whole(L, 2, 0), size = (lua_Integer)lua_rawlen(L, 1);
  return turns(0, n < 0 ? (n < -size ? size : -n) : n < size ? n : size, READ);
}

typedef struct counted_function {
  const char *table, *name; /* NULL: of the globals */
  uint64_t (*work)(lua_State* L);
} counted_function;

static const counted_function all[] = {
    {NULL, "select", of_arguments},    {NULL, "tonumber", of_text},    {"math", "max", of_arguments},
    {"math", "min", of_arguments},     {"string", "byte", of_byte},    {"string", "char", of_arguments},
    {"string", "rep", of_repetitions}, {"string", "pack", of_text},    {"string", "packsize", of_text},
    {"string", "unpack", of_text},     {"table", "concat", of_concat}, {"table", "move", of_move},
    {"table", "unpack", of_unpack},    {"utf8", "char", of_arguments}, {"utf8", "codepoint", of_byte},
    {"utf8", "len", of_length},        {"utf8", "offset", of_offset},
};

/* An error of the function has the place of its caller and names it, as if it had been called without us: it cannot
   know either. The object of a method call is not an argument. */
static int fail_as(lua_State* L, const counted_function* f) {
  static const char unnamed[] = "bad argument #";
  const char* text = lua_type(L, -1) == LUA_TSTRING ? lua_tostring(L, -1) : NULL;
  const char* name = text && strncmp(text, unnamed, sizeof unnamed - 1) == 0 ? strstr(text, " to '?'") : NULL;
  if (!text) return lua_error(L);
  luaL_where(L, 1);
  if (name) {
    lua_Debug call;
    lua_getstack(L, 0, &call);
    lua_getinfo(L, "n", &call);
    const int number = atoi(text + sizeof unnamed - 1) - (strcmp(call.namewhat, "method") == 0 ? 1 : 0);
    lua_pushfstring(L, "%s%d to '%s'%s", unnamed, number, f->name, name + 7);
  } else {
    lua_pushvalue(L, -2);
  }
  lua_concat(L, 2);
  return lua_error(L);
}

/* Upvalues: Lua's function, which of them it is, the library. */
static int call_counted(lua_State* L) {
  const counted_function* f = &all[lua_tointeger(L, lua_upvalueindex(2))];
  const uint64_t work = f->work(L);
  if (work != 0) bl_charge(L, lib_of(L, 3), work);
  lua_pushvalue(L, lua_upvalueindex(1));
  lua_insert(L, 1);
  const int code = lua_pcall(L, lua_gettop(L) - 1, LUA_MULTRET, 0);
  if (code == LUA_OK) return lua_gettop(L);
  if (code == LUA_ERRMEM) lua_newuserdatauv(L, (size_t)1 << 60, 0); /* nothing else raises the same error again */
  return fail_as(L, f);
}

/* ---- tables --------------------------------------------------------------------------------------------------------- */

static lua_Integer size_of(lua_State* L) {
  if (luaL_getmetafield(L, 1, "__index") == LUA_TNIL)
    luaL_checktype(L, 1, LUA_TTABLE);
  else
    lua_pop(L, 1);
  return luaL_len(L, 1);
}

static int insert(lua_State* L) {
  const lua_Integer end = (lua_Integer)((lua_Unsigned)size_of(L) + 1);
  lua_Integer at = end;
  if (lua_gettop(L) == 3) {
    at = luaL_checkinteger(L, 2);
    luaL_argcheck(L, (lua_Unsigned)at - 1 < (lua_Unsigned)end, 2, "position out of bounds");
    if (end - at >= MOVED) bl_charge(L, lib_of(L, 1), turns(at, end, MOVED));
    for (lua_Integer i = end; i > at; --i) {
      lua_geti(L, 1, i - 1);
      lua_seti(L, 1, i);
    }
  } else if (lua_gettop(L) != 2) {
    return luaL_error(L, "wrong number of arguments to 'insert'");
  }
  lua_seti(L, 1, at);
  return 0;
}

static int remove_element(lua_State* L) {
  const lua_Integer size = size_of(L);
  lua_Integer at = luaL_optinteger(L, 2, size);
  if (at != size) luaL_argcheck(L, (lua_Unsigned)at - 1 <= (lua_Unsigned)size, 2, "position out of bounds");
  if (size - at >= MOVED) bl_charge(L, lib_of(L, 1), turns(at, size, MOVED));
  lua_geti(L, 1, at);
  for (; at < size; ++at) {
    lua_geti(L, 1, at + 1);
    lua_seti(L, 1, at);
  }
  lua_pushnil(L);
  lua_seti(L, 1, at);
  return 1;
}

/* Is the value on top before the one below it? The comparison function, or nil, is the second argument. */
static bool is_before(lua_State* L) {
  if (lua_isnil(L, 2)) return lua_compare(L, -1, -2, LUA_OPLT);
  lua_pushvalue(L, 2);
  lua_pushvalue(L, -2);
  lua_pushvalue(L, -4);
  lua_call(L, 2, 1);
  const bool before = lua_toboolean(L, -1);
  lua_pop(L, 1);
  return before;
}

/* Two sorted parts of the table `from` become one of the table `to`. */
static void merge(lua_State* L, int from, int to, lua_Integer low, lua_Integer middle, lua_Integer high) {
  lua_Integer left = low, right = middle;
  for (lua_Integer at = low; at < high; ++at) {
    bool takes_right = left == middle;
    if (!takes_right && right < high) {
      lua_rawgeti(L, from, left);
      lua_rawgeti(L, from, right);
      takes_right = is_before(L);
      lua_pop(L, 2);
    }
    lua_rawgeti(L, from, takes_right ? right++ : left++);
    lua_rawseti(L, to, at);
  }
}

/* By merging, and stable. Lua's own sort divides at places that it draws from the clock where its first choices are
   bad, so that equal elements would be in another order in the next run. */
static int sort(lua_State* L) {
  const lua_Integer size = size_of(L);
  if (size < 2) return 0;
  luaL_argcheck(L, size < 1 << 30, 1, "array too big");
  if (!lua_isnoneornil(L, 2)) luaL_checktype(L, 2, LUA_TFUNCTION);
  lua_settop(L, 2);
  unsigned levels = 1;
  while (((lua_Integer)1 << levels) < size) ++levels;
  bl_charge(L, lib_of(L, 1), turns(0, size * (lua_Integer)levels, 2));
  int from = 3, to = 4;
  lua_createtable(L, (int)size, 0);
  lua_createtable(L, (int)size, 0);
  for (lua_Integer i = 1; i <= size; ++i) {
    lua_geti(L, 1, i);
    lua_rawseti(L, from, i);
  }
  for (lua_Integer width = 1; width < size; width *= 2) {
    for (lua_Integer low = 1; low <= size; low += 2 * width) {
      const lua_Integer middle = low + width <= size ? low + width : size + 1;
      merge(L, from, to, low, middle, middle + width <= size ? middle + width : size + 1);
    }
    const int other = from;
    from = to;
    to = other;
  }
  for (lua_Integer i = 1; i <= size; ++i) {
    lua_rawgeti(L, from, i);
    lua_seti(L, 1, i);
  }
  return 0;
}

void bl_open_metered(lua_State* L, bl_lib* lib) {
  static const luaL_Reg tables[] = {{"insert", insert}, {"remove", remove_element}, {"sort", sort}, {NULL, NULL}};
  for (size_t i = 0; i < sizeof all / sizeof *all; ++i) {
    if (all[i].table)
      lua_getglobal(L, all[i].table);
    else
      lua_pushglobaltable(L);
    lua_getfield(L, -1, all[i].name);
    lua_pushinteger(L, (lua_Integer)i);
    lua_pushlightuserdata(L, lib);
    lua_pushcclosure(L, call_counted, 3);
    lua_setfield(L, -2, all[i].name);
    lua_pop(L, 1);
  }
  lua_getglobal(L, "table");
  lua_pushlightuserdata(L, lib);
  luaL_setfuncs(L, tables, 1);
  lua_pop(L, 1);
}
