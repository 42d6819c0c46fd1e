/* Objects of the world as values of Lua. An object is one table of Lua as long as it lives: what a script keeps in it
   stays there. Its id stands under the key 0, its methods in the metatable of its class. */
#include <string.h>

#include "binding.h"

#define AT_ONCE 256 /* methods that are read without asking for memory twice */

static const char object_mark = 'o';

static breve_object unpacked(lua_Integer id) {
  const breve_object object = {(uint32_t)((lua_Unsigned)id & 0xffffffffu), (uint32_t)((lua_Unsigned)id >> 32)};
  return object;
}

static lua_Integer packed(breve_object object) {
  return (lua_Integer)((lua_Unsigned)object.generation << 32 | object.index);
}

bool bl_is_object(lua_State* L, int index) {
  if (!lua_istable(L, index) || !lua_getmetatable(L, index)) return false;
  const bool is = lua_rawgetp(L, -1, &object_mark) != LUA_TNIL;
  lua_pop(L, 2);
  return is;
}

/* If a table is not an object, its value under 0 is an id that breve refuses, or that of an object all the same. */
breve_object bl_to_object(lua_State* L, int index) {
  const breve_object none = {0, 0};
  if (!lua_istable(L, index)) return none;
  const bool number = lua_rawgeti(L, index, 0) == LUA_TNUMBER;
  const lua_Integer id = number ? lua_tointeger(L, -1) : 0;
  lua_pop(L, 1);
  return unpacked(id);
}

breve_object bl_need_object(lua_State* L, int index) {
  const breve_object object = bl_to_object(L, index);
  if (object.generation == 0) luaL_typeerror(L, index, "object");
  return object;
}

/* ---- metatables --------------------------------------------------------------------------------------------------- */

/* The name of a method in Lua, on the stack. */
static const char* push_name(lua_State* L, const char* selector) {
  luaL_Buffer name;
  luaL_buffinit(L, &name);
  for (const char* c = selector; *c; ++c) luaL_addchar(&name, *c == '-' ? '_' : *c);
  luaL_pushresult(&name);
  return lua_tostring(L, -1);
}

static bool is_same_name(const char* a, const char* b) {
  for (; *a && *b; ++a, ++b)
    if (*a != *b && !((*a == '-' && *b == '_') || (*a == '_' && *b == '-'))) return false;
  return *a == *b;
}

/* Those of one name side by side, in the order in which the names appear. */
static size_t gather(breve_method_info* all, size_t first, size_t count) {
  size_t end = first + 1;
  for (size_t i = end; i < count; ++i) {
    if (!is_same_name(all[i].name, all[first].name)) continue;
    const breve_method_info found = all[i];
    memmove(&all[end + 1], &all[end], (i - end) * sizeof *all);
    all[end++] = found;
  }
  return end;
}

/* Into the table of methods, which is on top. */
static void add_methods(lua_State* L, bl_world* w, const char* class_name) {
  size_t count = 0, told = AT_ONCE;
  breve_method_info* all = NULL;
  do {
    told = count > told ? count : told;
    lua_pop(L, all ? 1 : 0);
    all = (breve_method_info*)lua_newuserdatauv(L, told * sizeof *all, 0);
    const breve_status status = breve_world_methods(w->world, class_name, all, told, &count);
    if (status != BREVE_OK) bl_fail(L, w, status);
  } while (count > told);
  for (size_t i = 0; i < count;) {
    const size_t end = gather(all, i, count);
    const bl_class* owner = bl_program_class(w->program, all[i].class_name);
    push_name(L, all[i].name);
    const bl_method* method = owner ? bl_class_method(owner, lua_tostring(L, -1)) : NULL;
    if (method)
      bl_push_lua_method(L, w, method, &all[i]);
    else
      bl_push_selector(L, w, all[i].name, NULL, &all[i], end - i);
    lua_rawset(L, -4);
    i = end;
  }
  lua_pop(L, 1);
}

/* What a Lua class keeps besides methods that steve knows, as helpers with a '_' in front: from the root down. */
static void add_own(lua_State* L, bl_world* w, const char* class_name) {
  const bl_class* owner = bl_program_class(w->program, class_name);
  if (!owner) return;
  luaL_checkstack(L, 8, "too many ancestors");
  add_own(L, w, owner->parent);
  bl_push_own(L, w->lib, owner->name, NULL);
  if (lua_istable(L, -1)) {
    for (lua_pushnil(L); lua_next(L, -2); lua_pop(L, 1)) {
      lua_pushvalue(L, -2);
      if (lua_rawget(L, -5) == LUA_TNIL) {
        lua_pushvalue(L, -3);
        lua_pushvalue(L, -3);
        lua_rawset(L, -7);
      }
      lua_pop(L, 1);
    }
  }
  lua_pop(L, 1);
}

static int object_text(lua_State* L) {
  bl_world* w = (bl_world*)lua_touserdata(L, lua_upvalueindex(1));
  const breve_value value = breve_value_object(bl_to_object(L, 1));
  const char* text = NULL;
  if (!breve_object_alive(w->world, value.as.object)) {
    lua_pushliteral(L, "an object that is gone");
    return 1;
  }
  const breve_status status = breve_value_text(w->world, &value, &text);
  if (status != BREVE_OK) return bl_fail(L, w, status);
  lua_pushstring(L, text);
  return 1;
}

/* Push the metatable of a class's objects. */
static void push_metatable(lua_State* L, bl_world* w, const char* class_name) {
  lua_rawgeti(L, LUA_REGISTRYINDEX, w->metas);
  if (lua_getfield(L, -1, class_name) != LUA_TNIL) {
    lua_remove(L, -2);
    return;
  }
  lua_pop(L, 1);
  lua_createtable(L, 0, 6);
  lua_pushboolean(L, 1);
  lua_rawsetp(L, -2, &object_mark);
  lua_pushstring(L, class_name);
  lua_pushvalue(L, -1);
  lua_setfield(L, -3, "__name");
  lua_setfield(L, -2, "__metatable");
  lua_pushlightuserdata(L, w);
  lua_pushcclosure(L, object_text, 1);
  lua_setfield(L, -2, "__tostring");
  lua_newtable(L);
  add_methods(L, w, class_name);
  add_own(L, w, class_name);
  bl_add_object_methods(L, w);
  lua_setfield(L, -2, "__index");
  lua_pushvalue(L, -1);
  lua_setfield(L, -3, class_name);
  lua_remove(L, -2);
}

void bl_forget_classes(lua_State* L, bl_world* w) {
  lua_newtable(L);
  lua_rawseti(L, LUA_REGISTRYINDEX, w->metas);
  lua_rawgeti(L, LUA_REGISTRYINDEX, w->objects);
  for (lua_pushnil(L); lua_next(L, -2); lua_pop(L, 1)) {
    const char* name = breve_object_class(w->world, bl_to_object(L, -1));
    if (!name) continue;
    push_metatable(L, w, name);
    lua_setmetatable(L, -2);
  }
  lua_pop(L, 1);
}

/* ---- objects ------------------------------------------------------------------------------------------------------ */

static void make_object(lua_State* L, bl_world* w, breve_object object) {
  const char* name = breve_object_class(w->world, object);
  if (!name) {
    lua_pushnil(L);
    return;
  }
  luaL_checkstack(L, 12, NULL);
  lua_createtable(L, 0, 4);
  lua_pushinteger(L, packed(object));
  lua_rawseti(L, -2, 0);
  push_metatable(L, w, name);
  lua_setmetatable(L, -2);
  lua_rawgeti(L, LUA_REGISTRYINDEX, w->objects);
  lua_pushvalue(L, -2);
  lua_rawseti(L, -2, object.index);
  lua_pop(L, 1);
}

void bl_push_object(lua_State* L, bl_world* w, breve_object object) {
  if (object.generation == 0) {
    lua_pushnil(L);
    return;
  }
  lua_rawgeti(L, LUA_REGISTRYINDEX, w->objects);
  const bool known = lua_rawgeti(L, -1, object.index) == LUA_TTABLE;
  lua_remove(L, -2);
  if (known) {
    const breve_object kept = bl_to_object(L, -1);
    if (kept.generation == object.generation) return;
  }
  lua_pop(L, 1);
  make_object(L, w, object);
}

/* In the middle of anything: nothing is made here, so nothing fails. */
void bl_object_gone(void* user, breve_object object) {
  bl_world* w = (bl_world*)user;
  lua_State* L = w->running;
  if (!lua_checkstack(L, 2)) return; /* the table stays until the world ends: its id is that of no object */
  lua_rawgeti(L, LUA_REGISTRYINDEX, w->objects);
  if (lua_rawgeti(L, -1, object.index) == LUA_TTABLE && bl_to_object(L, -1).generation == object.generation) {
    lua_pushnil(L);
    lua_rawseti(L, -3, object.index);
  }
  lua_pop(L, 2);
}
