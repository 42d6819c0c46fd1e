/* What objects hold in Lua, as a part of the world's snapshots and of its hash. Numbers, texts, booleans, vectors,
   matrices, objects and tables of these are saved; a table that is held twice stays one table. Each value is a letter
   and its bytes. */
#include <stdlib.h>
#include <string.h>

#include "binding.h"

enum { DEEPEST = 100 };

/* ---- the objects of a world by number, in order of creation ---- */

typedef struct census {
  breve_world* world;
  breve_object* objects;
  size_t count, room;
} census;

static bool take_census(census* c, breve_world* world) {
  memset(c, 0, sizeof *c);
  c->world = world;
  if (breve_world_objects(world, NULL, NULL, 0, &c->room) != BREVE_OK) return false;
  c->objects = (breve_object*)breve_world_allocate(world, (c->room + 1) * sizeof *c->objects);
  return c->objects && breve_world_objects(world, NULL, c->objects, c->room, &c->count) == BREVE_OK;
}

static void end_census(census* c) { breve_world_release(c->world, c->objects, (c->room + 1) * sizeof *c->objects); }

/* ---- saving ---------------------------------------------------------------------------------------------------------- */

typedef struct saver {
  bl_world* w;
  census all;
  breve_write_fn write;
  void* sink;
  int numbers; /* stack index of a table: id of an object -> its number */
  int seen;    /* ... table -> its number */
  lua_Integer tables;
} saver;

static void put(saver* s, char letter, const void* bytes, size_t size) {
  s->write(s->sink, &letter, 1);
  if (size != 0) s->write(s->sink, (const char*)bytes, size);
}

static void put_text(saver* s, const char* text, size_t size) {
  const uint64_t wide = size;
  put(s, 'S', &wide, sizeof wide);
  s->write(s->sink, text, size);
}

static void put_object(lua_State* L, saver* s, int index) {
  lua_rawgeti(L, index, 0);
  lua_rawget(L, s->numbers);
  const uint32_t number = lua_isinteger(L, -1) ? (uint32_t)lua_tointeger(L, -1) : UINT32_MAX; /* one that is gone */
  lua_pop(L, 1);
  put(s, 'O', &number, sizeof number);
}

static void put_value(lua_State* L, saver* s, int depth);

/* The pairs of the table on top, in order, and the mark of their end. */
static void put_pairs(lua_State* L, saver* s, int depth) {
  const int table = lua_gettop(L);
  lua_rawgeti(L, LUA_REGISTRYINDEX, s->w->lib->sorted_keys);
  lua_pushvalue(L, table);
  lua_call(L, 1, 1);
  const lua_Integer count = (lua_Integer)lua_rawlen(L, -1);
  for (lua_Integer i = 1; i <= count; ++i) {
    lua_rawgeti(L, table + 1, i);
    put_value(L, s, depth);
    lua_rawget(L, table);
    put_value(L, s, depth);
    lua_pop(L, 1);
  }
  put(s, '}', NULL, 0);
  lua_settop(L, table);
}

static void put_table(lua_State* L, saver* s, int depth) {
  if (depth > DEEPEST) luaL_error(L, "tables are nested too deeply");
  luaL_checkstack(L, 8, NULL);
  lua_pushvalue(L, -1);
  if (lua_rawget(L, s->seen) != LUA_TNIL) {
    const uint64_t number = (uint64_t)lua_tointeger(L, -1);
    lua_pop(L, 1);
    put(s, 'R', &number, sizeof number);
    return;
  }
  lua_pop(L, 1);
  if (lua_getmetatable(L, -1)) luaL_error(L, "a table with a metatable cannot be saved: see breve.on_save");
  lua_pushvalue(L, -1);
  lua_pushinteger(L, s->tables++);
  lua_rawset(L, s->seen);
  put(s, '{', NULL, 0);
  put_pairs(L, s, depth + 1);
}

/* The value on top, which stays there. */
static void put_value(lua_State* L, saver* s, int depth) {
  switch (lua_type(L, -1)) {
    case LUA_TNIL: put(s, 'N', NULL, 0); return;
    case LUA_TBOOLEAN: put(s, lua_toboolean(L, -1) ? 'T' : 'F', NULL, 0); return;
    case LUA_TNUMBER: {
      const lua_Integer integer = lua_isinteger(L, -1) ? lua_tointeger(L, -1) : 0;
      const lua_Number number = lua_tonumber(L, -1);
      if (lua_isinteger(L, -1))
        put(s, 'I', &integer, sizeof integer);
      else
        put(s, 'D', &number, sizeof number);
      return;
    }
    case LUA_TSTRING: {
      size_t size = 0;
      const char* text = lua_tolstring(L, -1, &size);
      put_text(s, text, size);
      return;
    }
    case LUA_TTABLE:
      if (bl_is_object(L, -1))
        put_object(L, s, lua_gettop(L));
      else
        put_table(L, s, depth);
      return;
    default: break;
  }
  const bl_vector* v = bl_to_vector(L, -1);
  const bl_matrix* m = v ? NULL : bl_to_matrix(L, -1);
  if (v)
    put(s, 'V', v->v, sizeof v->v);
  else if (m)
    put(s, 'M', m->m, sizeof m->m);
  else
    luaL_error(L, "a %s cannot be saved: see breve.on_save", luaL_typename(L, -1));
}

static bool has_fields(lua_State* L, int object) {
  int count = 0;
  for (lua_pushnil(L); count < 2 && lua_next(L, object); lua_pop(L, 1)) ++count;
  if (count == 2) lua_pop(L, 1);
  return count > 1; /* one is the id */
}

static void put_fields(lua_State* L, saver* s, uint32_t number) {
  put(s, 'o', &number, sizeof number);
  put_pairs(L, s, 0);
}

/* A function of Lua. */
static int save_all(lua_State* L) {
  saver* s = (saver*)lua_touserdata(L, 1);
  bl_world* w = s->w;
  lua_settop(L, 1);
  lua_rawgeti(L, LUA_REGISTRYINDEX, w->objects);
  lua_newtable(L);
  s->numbers = 3;
  lua_newtable(L);
  s->seen = 4;
  for (size_t i = 0; i < s->all.count; ++i) {
    const breve_object object = s->all.objects[i];
    lua_pushinteger(L, (lua_Integer)((lua_Unsigned)object.generation << 32 | object.index));
    lua_pushinteger(L, (lua_Integer)i);
    lua_rawset(L, s->numbers);
  }
  for (size_t i = 0; i < s->all.count; ++i) {
    if (lua_rawgeti(L, 2, s->all.objects[i].index) == LUA_TTABLE && has_fields(L, lua_gettop(L)))
      put_fields(L, s, (uint32_t)i);
    lua_pop(L, 1);
  }
  put(s, '.', NULL, 0);
  if (w->lib->save_hook == LUA_NOREF) {
    lua_pushnil(L);
  } else {
    lua_rawgeti(L, LUA_REGISTRYINDEX, w->lib->save_hook);
    lua_call(L, 0, 1);
  }
  put_value(L, s, 0);
  return 0;
}

bool bl_save(void* user, breve_world* world, breve_write_fn write, void* sink, breve_write_fn reason,
             void* reason_sink) {
  bl_world* w = (bl_world*)user;
  saver s = {w, {NULL, NULL, 0, 0}, write, sink, 0, 0, 0};
  bool good = take_census(&s.all, world);
  if (good) {
    lua_State* L = w->running;
    lua_pushcfunction(L, save_all);
    lua_pushlightuserdata(L, &s);
    good = lua_pcall(L, 1, 0, 0) == LUA_OK;
    if (!good) {
      const char* why = lua_type(L, -1) == LUA_TSTRING ? lua_tostring(L, -1) : "an object holds what cannot be saved";
      reason(reason_sink, why, strlen(why));
      lua_pop(L, 1);
    }
  }
  end_census(&s.all);
  return good;
}

/* ---- loading --------------------------------------------------------------------------------------------------------- */

typedef struct loader {
  bl_world* w;
  census all;
  const char *at, *end;
  bool commit; /* else the bytes are only looked through */
  int seen;    /* stack index of a table: number -> table */
  lua_Integer tables;
} loader;

static void get(lua_State* L, loader* l, void* to, size_t size) {
  if ((size_t)(l->end - l->at) < size) luaL_error(L, "cut off");
  if (to) memcpy(to, l->at, size);
  l->at += size;
}

static char get_letter(lua_State* L, loader* l) {
  char letter;
  get(L, l, &letter, 1);
  return letter;
}

static void get_value(lua_State* L, loader* l, char letter, int depth);

/* Into the table on top, up to the mark of the end. */
static void get_pairs(lua_State* L, loader* l, int depth) {
  if (depth > DEEPEST + 1) luaL_error(L, "too deep");
  luaL_checkstack(L, 8, NULL);
  for (char letter = get_letter(L, l); letter != '}'; letter = get_letter(L, l)) {
    get_value(L, l, letter, depth);
    get_value(L, l, get_letter(L, l), depth);
    if (lua_isnil(L, -2))
      lua_pop(L, 2); /* an object that was gone when it was saved, or one that is only looked at */
    else
      lua_rawset(L, -3);
  }
}

static void get_number_of_object(lua_State* L, loader* l) {
  uint32_t number;
  get(L, l, &number, sizeof number);
  if (l->commit && number < l->all.count)
    bl_push_object(L, l->w, l->all.objects[number]);
  else
    lua_pushnil(L);
}

static void get_value(lua_State* L, loader* l, char letter, int depth) {
  switch (letter) {
    case 'N': lua_pushnil(L); return;
    case 'T':
    case 'F': lua_pushboolean(L, letter == 'T'); return;
    case 'I': {
      lua_Integer integer;
      get(L, l, &integer, sizeof integer);
      lua_pushinteger(L, integer);
      return;
    }
    case 'D': {
      lua_Number number;
      get(L, l, &number, sizeof number);
      lua_pushnumber(L, number);
      return;
    }
    case 'S': {
      uint64_t size;
      get(L, l, &size, sizeof size);
      const char* text = l->at;
      if (size > (uint64_t)(l->end - l->at)) luaL_error(L, "cut off");
      get(L, l, NULL, (size_t)size);
      lua_pushlstring(L, text, (size_t)size);
      return;
    }
    case 'V': get(L, l, bl_push_vector(L, l->w->lib), sizeof(double[3])); return;
    case 'M': get(L, l, bl_push_matrix(L, l->w->lib), sizeof(double[9])); return;
    case 'O': get_number_of_object(L, l); return;
    case 'R': {
      uint64_t number;
      get(L, l, &number, sizeof number);
      if (number >= (uint64_t)l->tables) luaL_error(L, "a table that is not there");
      lua_rawgeti(L, l->seen, (lua_Integer)number);
      return;
    }
    case '{':
      lua_newtable(L);
      lua_pushvalue(L, -1);
      lua_rawseti(L, l->seen, l->tables++);
      get_pairs(L, l, depth + 1);
      return;
    default: luaL_error(L, "not a value");
  }
}

/* What objects hold now is dropped: the image has all that they held then. */
static void clear_objects(lua_State* L, bl_world* w) {
  lua_newtable(L);
  lua_rawgeti(L, LUA_REGISTRYINDEX, w->objects);
  const int objects = lua_gettop(L), kept = objects - 1;
  for (lua_pushnil(L); lua_next(L, objects); lua_pop(L, 1)) {
    if (!breve_object_alive(w->world, bl_to_object(L, -1))) continue;
    lua_pushvalue(L, -2);
    lua_pushvalue(L, -2);
    lua_rawset(L, kept);
    lua_rawgeti(L, -1, 0);
    for (lua_pushnil(L); lua_next(L, -3);) {
      lua_pop(L, 1);
      lua_pushvalue(L, -1);
      lua_pushnil(L);
      lua_rawset(L, -5);
    }
    lua_rawseti(L, -2, 0);
  }
  lua_pop(L, 1);
  lua_rawseti(L, LUA_REGISTRYINDEX, w->objects);
}

static void get_fields(lua_State* L, loader* l) {
  uint32_t number;
  get(L, l, &number, sizeof number);
  if (l->commit && number < l->all.count)
    bl_push_object(L, l->w, l->all.objects[number]);
  else
    lua_newtable(L);
  if (!lua_istable(L, -1)) luaL_error(L, "fields of no object");
  get_pairs(L, l, 0);
  lua_pop(L, 1);
}

/* A function of Lua. */
static int load_all(lua_State* L) {
  loader* l = (loader*)lua_touserdata(L, 1);
  lua_settop(L, 1);
  lua_newtable(L);
  l->seen = 2;
  if (l->commit) clear_objects(L, l->w);
  char letter = get_letter(L, l);
  for (; letter == 'o'; letter = get_letter(L, l)) get_fields(L, l);
  if (letter != '.') luaL_error(L, "not an object");
  get_value(L, l, get_letter(L, l), 0);
  if (l->at != l->end) luaL_error(L, "too long");
  if (!l->commit || l->w->lib->load_hook == LUA_NOREF) return 0;
  lua_rawgeti(L, LUA_REGISTRYINDEX, l->w->lib->load_hook);
  lua_insert(L, -2);
  lua_call(L, 1, 0);
  return 0;
}

bool bl_load(void* user, breve_world* world, const char* bytes, size_t size, bool commit) {
  bl_world* w = (bl_world*)user;
  loader l = {w, {NULL, NULL, 0, 0}, bytes, bytes + size, commit, 0, 0};
  bool good = take_census(&l.all, world);
  if (good) {
    lua_State* L = w->running;
    lua_pushcfunction(L, load_all);
    lua_pushlightuserdata(L, &l);
    good = lua_pcall(L, 1, 0, 0) == LUA_OK;
    if (!good) lua_pop(L, 1);
  }
  end_census(&l.all);
  return good;
}
