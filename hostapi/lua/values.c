/* Values on their way between Lua and breve. Lists and hashes are copied: a table of Lua and a list of steve are never
   the same thing. */
#include <string.h>

#include "binding.h"

#define DEEPEST 100 /* tables in tables, which may hold themselves */
#define AT_ONCE 64  /* elements of a list that are read in one call */

static const char* convert(lua_State* L, bl_world* w, int index, breve_value* value, int depth);

static const char* status_text(const bl_world* w, breve_status status) {
  const breve_error* error = breve_world_last_error(w->world);
  return error && error->status == (uint32_t)status ? error->message : breve_status_name(status);
}

static const char* convert_sequence(lua_State* L, bl_world* w, int table, size_t size, breve_value* value, int depth) {
  breve_status status = breve_list_create(w->world, value);
  for (size_t i = 1; i <= size && status == BREVE_OK; ++i) {
    breve_value element;
    lua_rawgeti(L, table, (lua_Integer)i);
    const char* fault = convert(L, w, lua_gettop(L), &element, depth + 1);
    if (fault) return fault;
    status = breve_list_push(w->world, value, &element);
    lua_pop(L, 1);
  }
  return status == BREVE_OK ? NULL : status_text(w, status);
}

/* The order of `next` is that of addresses: the keys of a hash would have another one in each run. So keys are added in
   the order of `pairs`, which sorts them. */
static const char* convert_record(lua_State* L, bl_world* w, int table, breve_value* value, int depth) {
  breve_status status = breve_hash_create(w->world, value);
  size_t keys = 0;
  if (status != BREVE_OK) return status_text(w, status);
  for (lua_pushnil(L); lua_next(L, table); lua_pop(L, 1)) ++keys;
  if (keys == 0) return NULL;
  lua_rawgeti(L, LUA_REGISTRYINDEX, w->lib->sorted_keys);
  lua_pushvalue(L, table);
  if (lua_pcall(L, 1, 1, 0) != LUA_OK) return "a table with such keys cannot be passed: its keys have no order";
  const int sorted = lua_gettop(L);
  for (size_t i = 1; i <= keys; ++i) {
    breve_value key, element;
    lua_rawgeti(L, sorted, (lua_Integer)i);
    lua_pushvalue(L, -1);
    lua_rawget(L, table);
    const char* fault = convert(L, w, sorted + 1, &key, depth + 1);
    if (!fault) fault = convert(L, w, sorted + 2, &element, depth + 1);
    if (fault) return fault;
    status = breve_hash_set(w->world, value, &key, &element);
    if (status != BREVE_OK) return status_text(w, status);
    lua_settop(L, sorted);
  }
  return NULL;
}

/* A table with a first element, or an empty one, is a list. */
static const char* convert_table(lua_State* L, bl_world* w, int table, breve_value* value, int depth) {
  if (depth > DEEPEST) return "tables are nested too deeply, or hold themselves";
  if (!lua_checkstack(L, 10)) return "tables are nested too deeply";
  const int top = lua_gettop(L);
  const size_t size = lua_rawlen(L, table);
  lua_pushnil(L);
  const bool empty = !lua_next(L, table);
  lua_settop(L, top);
  const char* fault =
      size > 0 || empty ? convert_sequence(L, w, table, size, value, depth) : convert_record(L, w, table, value, depth);
  lua_settop(L, top);
  return fault;
}

static const char* convert(lua_State* L, bl_world* w, int index, breve_value* value, int depth) {
  value->reserved = 0;
  switch (lua_type(L, index)) {
    case LUA_TNIL:
    case LUA_TNONE: value->type = BREVE_TYPE_NULL; return NULL;
    case LUA_TBOOLEAN:
      value->type = BREVE_TYPE_INT;
      value->as.integer = lua_toboolean(L, index);
      return NULL;
    case LUA_TNUMBER: {
      const lua_Integer i = lua_isinteger(L, index) ? lua_tointeger(L, index) : INT64_MAX;
      if (i >= INT32_MIN && i <= INT32_MAX) {
        value->type = BREVE_TYPE_INT;
        value->as.integer = (int32_t)i;
      } else {
        value->type = BREVE_TYPE_DOUBLE;
        value->as.number = lua_tonumber(L, index);
      }
      return NULL;
    }
    case LUA_TSTRING:
      value->type = BREVE_TYPE_STRING;
      value->as.string.bytes = lua_tolstring(L, index, &value->as.string.size);
      return NULL;
    case LUA_TUSERDATA: {
      const bl_vector* v = bl_to_vector(L, index);
      const bl_matrix* m = v ? NULL : bl_to_matrix(L, index);
      if (!v && !m) return "a value of this type cannot be passed to an agent";
      value->type = v ? BREVE_TYPE_VECTOR : BREVE_TYPE_MATRIX;
      if (v) memcpy(value->as.vector, v->v, sizeof v->v);
      if (m) memcpy(value->as.matrix, m->m, sizeof m->m);
      return NULL;
    }
    case LUA_TTABLE:
      if (bl_is_object(L, index)) {
        value->type = BREVE_TYPE_OBJECT;
        value->as.object = bl_to_object(L, index);
        return NULL;
      }
      return convert_table(L, w, lua_absindex(L, index), value, depth);
    default: return "a value of this type cannot be passed to an agent";
  }
}

const char* bl_to_value(lua_State* L, bl_world* w, int index, breve_value* value) {
  return convert(L, w, index, value, 0);
}

static void push(lua_State* L, bl_world* w, const breve_value* value, int depth);

static void push_list(lua_State* L, bl_world* w, const breve_value* list, int depth) {
  size_t size = 0;
  breve_value elements[AT_ONCE];
  breve_status status = breve_list_size(w->world, list, &size);
  if (status != BREVE_OK) bl_fail(L, w, status);
  luaL_checkstack(L, 4, "lists are nested too deeply");
  lua_createtable(L, size < INT32_MAX ? (int)size : 0, 0);
  for (size_t first = 0; first < size; first += AT_ONCE) {
    const size_t count = size - first < AT_ONCE ? size - first : AT_ONCE;
    status = breve_list_read(w->world, list, first, elements, count);
    if (status != BREVE_OK) bl_fail(L, w, status);
    for (size_t i = 0; i < count; ++i) {
      push(L, w, &elements[i], depth + 1);
      lua_rawseti(L, -2, (lua_Integer)(first + i + 1));
    }
  }
}

static void push_hash(lua_State* L, bl_world* w, const breve_value* hash, int depth) {
  breve_value keys, key, element;
  size_t size = 0;
  breve_status status = breve_hash_keys(w->world, hash, &keys);
  if (status == BREVE_OK) status = breve_list_size(w->world, &keys, &size);
  if (status != BREVE_OK) bl_fail(L, w, status);
  luaL_checkstack(L, 4, "hashes are nested too deeply");
  lua_newtable(L);
  for (size_t i = 0; i < size; ++i) {
    status = breve_list_get(w->world, &keys, i, &key);
    if (status == BREVE_OK) status = breve_hash_get(w->world, hash, &key, &element);
    if (status != BREVE_OK) bl_fail(L, w, status);
    push(L, w, &key, depth + 1);
    push(L, w, &element, depth + 1);
    if (lua_isnil(L, -2))
      lua_pop(L, 2); /* no key of a table */
    else
      lua_rawset(L, -3);
  }
}

static void push(lua_State* L, bl_world* w, const breve_value* value, int depth) {
  if (depth > DEEPEST) luaL_error(L, "lists are nested too deeply, or hold themselves");
  switch (value->type) {
    case BREVE_TYPE_INT: lua_pushinteger(L, value->as.integer); break;
    case BREVE_TYPE_DOUBLE: lua_pushnumber(L, value->as.number); break;
    case BREVE_TYPE_VECTOR: memcpy(bl_push_vector(L, w->lib), value->as.vector, sizeof value->as.vector); break;
    case BREVE_TYPE_MATRIX: memcpy(bl_push_matrix(L, w->lib), value->as.matrix, sizeof value->as.matrix); break;
    case BREVE_TYPE_STRING:
    case BREVE_TYPE_DATA: lua_pushlstring(L, value->as.string.bytes, value->as.string.size); break;
    case BREVE_TYPE_OBJECT: bl_push_object(L, w, value->as.object); break;
    case BREVE_TYPE_LIST: push_list(L, w, value, depth); break;
    case BREVE_TYPE_HASH: push_hash(L, w, value, depth); break;
    default: lua_pushnil(L); break;
  }
}

void bl_push_value(lua_State* L, bl_world* w, const breve_value* value) { push(L, w, value, 0); }
