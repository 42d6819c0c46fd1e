/* Tables in a defined order. Lua's own order of keys is that of addresses and of a seed that differs in each run, so a
   loop over a table would make two runs of one world differ. Here keys come sorted: false, true, numbers, texts,
   vectors, objects; other keys have no order, and are an error. */
#include <stdlib.h>
#include <string.h>

#include "binding.h"

typedef struct key {
  int rank;
  double number[3];
  lua_Integer integer; /* of an int, or of an object */
  const char* text;
  size_t size;
  lua_Integer at; /* place in the table of keys */
} key;

static int compare_integers(lua_Integer a, lua_Integer b) { return a < b ? -1 : a > b; }

static int compare(const void* left, const void* right) {
  const key *a = (const key*)left, *b = (const key*)right;
  if (a->rank != b->rank) return a->rank < b->rank ? -1 : 1;
  for (int i = 0; i < 3; ++i)
    if (a->number[i] != b->number[i]) return a->number[i] < b->number[i] ? -1 : 1;
  if (a->integer != b->integer) return compare_integers(a->integer, b->integer);
  const size_t shorter = a->size < b->size ? a->size : b->size;
  const int order = shorter == 0 ? 0 : memcmp(a->text, b->text, shorter);
  return order != 0 ? order : a->size < b->size ? -1 : a->size > b->size;
}

/* The key on top of the stack. */
static void describe(lua_State* L, key* k) {
  memset(k, 0, sizeof *k);
  switch (lua_type(L, -1)) {
    case LUA_TBOOLEAN: k->rank = 1 + lua_toboolean(L, -1); return;
    case LUA_TNUMBER:
      k->rank = 3;
      k->number[0] = lua_tonumber(L, -1);
      k->integer = lua_isinteger(L, -1) ? lua_tointeger(L, -1) : 0;
      return;
    case LUA_TSTRING:
      k->rank = 4;
      k->text = lua_tolstring(L, -1, &k->size);
      return;
    default: break;
  }
  const bl_vector* v = bl_to_vector(L, -1);
  if (v) {
    k->rank = 5;
    memcpy(k->number, v->v, sizeof k->number);
  } else if (bl_is_object(L, -1)) {
    const breve_object object = bl_to_object(L, -1);
    k->rank = 6;
    k->number[0] = object.index;
    k->integer = object.generation;
  } else {
    luaL_error(L, "a key of the table is a %s: such keys have no order, and the next run would have another one",
               luaL_typename(L, -1));
  }
}

enum { PIECE = 1024, SHARE = 2 }; /* keys between two looks at the budget, and how many of them are one turn */

static void count_key(lua_State* L, lua_Integer number) {
  if (number % PIECE == 0) bl_charge(L, bl_lib_of(L), PIECE / SHARE);
}

/* A function of Lua: table -> table of its keys. In an object, 0 is not a key: its id stands there. */
int bl_sorted_keys(lua_State* L) {
  luaL_checktype(L, 1, LUA_TTABLE);
  const bool object = bl_is_object(L, 1);
  lua_settop(L, 1);
  lua_newtable(L);
  lua_Integer count = 0;
  for (lua_pushnil(L); lua_next(L, 1); lua_pop(L, 1)) {
    if (object && lua_isinteger(L, -2) && lua_tointeger(L, -2) == 0) continue;
    lua_pushvalue(L, -2);
    lua_rawseti(L, 2, ++count);
    count_key(L, count);
  }
  bl_charge(L, bl_lib_of(L), (uint64_t)count);
  key* keys = (key*)lua_newuserdatauv(L, ((size_t)count + 1) * sizeof *keys, 0);
  for (lua_Integer i = 0; i < count; ++i) {
    lua_rawgeti(L, 2, i + 1);
    describe(L, &keys[i]);
    keys[i].at = i + 1;
    lua_pop(L, 1);
  }
  qsort(keys, (size_t)count, sizeof *keys, compare);
  lua_createtable(L, (int)count, 0);
  for (lua_Integer i = 0; i < count; ++i) {
    lua_rawgeti(L, 2, keys[i].at);
    lua_rawseti(L, -2, i + 1);
  }
  return 1;
}

/* ---- pairs and next ----------------------------------------------------------------------------------------------- */

static int next_in_sequence(lua_State* L) {
  const lua_Integer i = lua_isnil(L, 2) ? 1 : luaL_checkinteger(L, 2) + 1;
  lua_pushinteger(L, i);
  if (lua_rawgeti(L, 1, i) != LUA_TNIL) return 2;
  return 0;
}

/* Upvalues: the table, its keys, the place of the last one. Skips keys that were removed meanwhile. */
static int next_of_keys(lua_State* L) {
  lua_Integer i = lua_tointeger(L, lua_upvalueindex(3));
  for (;;) {
    if (lua_rawgeti(L, lua_upvalueindex(2), ++i) == LUA_TNIL) return 0;
    lua_pushvalue(L, -1);
    if (lua_rawget(L, lua_upvalueindex(1)) != LUA_TNIL) break;
    lua_pop(L, 2);
  }
  lua_pushinteger(L, i);
  lua_replace(L, lua_upvalueindex(3));
  return 2;
}

static bool is_sequence(lua_State* L, int table) {
  const size_t size = lua_rawlen(L, table);
  size_t count = 0;
  for (lua_pushnil(L); lua_next(L, table); lua_pop(L, 1)) {
    if (++count > size || !lua_isinteger(L, -2)) {
      lua_pop(L, 2);
      return false;
    }
    count_key(L, (lua_Integer)count);
  }
  return count == size;
}

int bl_ordered_pairs(lua_State* L) {
  luaL_checkany(L, 1);
  if (luaL_getmetafield(L, 1, "__pairs") != LUA_TNIL) {
    lua_pushvalue(L, 1);
    lua_call(L, 1, 3);
    return 3;
  }
  luaL_checktype(L, 1, LUA_TTABLE);
  lua_settop(L, 1);
  if (is_sequence(L, 1)) {
    lua_pushcfunction(L, next_in_sequence);
    lua_pushvalue(L, 1);
    lua_pushnil(L);
    return 3;
  }
  lua_pushvalue(L, 1);
  lua_pushcfunction(L, bl_sorted_keys);
  lua_pushvalue(L, 1);
  lua_call(L, 1, 1);
  lua_pushinteger(L, 0);
  lua_pushcclosure(L, next_of_keys, 3);
  return 1;
}

/* One key after another costs a sorting each: pairs is for loops, next for the question whether there is one. */
static int ordered_next(lua_State* L) {
  luaL_checktype(L, 1, LUA_TTABLE);
  lua_settop(L, 2);
  lua_pushcfunction(L, bl_sorted_keys);
  lua_pushvalue(L, 1);
  lua_call(L, 1, 1);
  const lua_Integer count = (lua_Integer)lua_rawlen(L, 3);
  lua_Integer i = 1;
  if (!lua_isnil(L, 2)) {
    for (; i <= count; ++i, lua_pop(L, 1)) {
      lua_rawgeti(L, 3, i);
      if (lua_compare(L, 2, -1, LUA_OPEQ)) break;
    }
    if (i > count) return luaL_error(L, "the table does not have the key that was given to 'next'");
    ++i;
  }
  if (i > count) {
    lua_pushnil(L);
    return 1;
  }
  lua_rawgeti(L, 3, i);
  lua_pushvalue(L, -1);
  lua_rawget(L, 1);
  return 2;
}

void bl_open_order(lua_State* L) {
  lua_pushcfunction(L, bl_ordered_pairs);
  lua_setglobal(L, "pairs");
  lua_pushcfunction(L, ordered_next);
  lua_setglobal(L, "next");
}
