/* The functions of the table `breve`, and what all objects can do besides their methods. */
#include <string.h>

#include "binding.h"

static bl_world* world_of(lua_State* L) { return bl_current(L, (bl_lib*)lua_touserdata(L, lua_upvalueindex(1))); }

bl_world* bl_current(lua_State* L, bl_lib* lib) {
  if (lib->loading || !lib->current)
    luaL_error(L, "there is no world yet: write code that needs one into a method, such as 'init'");
  return lib->current;
}

/* The name of a class: a text, or a class table. */
static const char* class_name(lua_State* L, int index) {
  if (lua_type(L, index) == LUA_TSTRING) return lua_tostring(L, index);
  if (luaL_getmetafield(L, index, "class") != LUA_TSTRING) luaL_typeerror(L, index, "class");
  lua_replace(L, index);
  return lua_tostring(L, index);
}

static int checked(lua_State* L, bl_world* w, breve_status status) {
  return status == BREVE_OK ? 0 : bl_fail(L, w, status);
}

/* breve.new(class): an object. breve.new(class, count): a table of them. */
static int make_object(lua_State* L) {
  bl_world* w = world_of(L);
  const char* name = class_name(L, 1);
  breve_object object;
  if (lua_isnoneornil(L, 2)) {
    bl_profile_line(L, w);
    checked(L, w, breve_object_create(w->world, name, &object));
    bl_push_object(L, w, object);
    return 1;
  }
  const lua_Integer count = luaL_checkinteger(L, 2);
  luaL_argcheck(L, count >= 0, 2, "a count is not negative");
  lua_newtable(L);
  for (lua_Integer i = 1; i <= count; ++i) {
    bl_profile_line(L, w);
    checked(L, w, breve_object_create(w->world, name, &object));
    bl_push_object(L, w, object);
    lua_rawseti(L, -2, i);
  }
  return 1;
}

static int free_object(lua_State* L) {
  bl_world* w = world_of(L);
  bl_profile_line(L, w);
  checked(L, w, breve_object_free(w->world, bl_need_object(L, 1)));
  return 0;
}

static int is_alive(lua_State* L) {
  bl_world* w = world_of(L);
  lua_pushboolean(L, breve_object_alive(w->world, bl_to_object(L, 1)));
  return 1;
}

static int is_a(lua_State* L) {
  bl_world* w = world_of(L);
  bool result = false;
  const char* name = class_name(L, 2);
  const breve_status status = breve_object_is_a(w->world, bl_need_object(L, 1), name, &result);
  if (status != BREVE_ERROR_NOT_FOUND) checked(L, w, status); /* of a class that there is none of, nothing is one */
  lua_pushboolean(L, result);
  return 1;
}

static int get_class(lua_State* L) {
  bl_world* w = world_of(L);
  const char* name = breve_object_class(w->world, bl_need_object(L, 1));
  if (!name) return checked(L, w, BREVE_ERROR_STALE);
  lua_pushstring(L, name);
  return 1;
}

/* An instance variable that a class in steve declares. */
static int get_variable(lua_State* L) {
  bl_world* w = world_of(L);
  breve_value value;
  checked(L, w, breve_object_get(w->world, bl_need_object(L, 1), luaL_checkstring(L, 2), &value));
  bl_push_value(L, w, &value);
  return 1;
}

static int set_variable(lua_State* L) {
  bl_world* w = world_of(L);
  breve_value value;
  const char* fault = bl_to_value(L, w, 3, &value);
  if (fault) return luaL_error(L, "%s", fault);
  checked(L, w, breve_object_set(w->world, bl_need_object(L, 1), luaL_checkstring(L, 2), &value));
  return 0;
}

static int get_controller(lua_State* L) {
  bl_world* w = world_of(L);
  bl_push_object(L, w, breve_world_controller(w->world));
  return 1;
}

/* breve.objects(class): a table of the live ones, in order of creation. */
static int all_objects(lua_State* L) {
  bl_world* w = world_of(L);
  const char* name = lua_isnoneornil(L, 1) ? NULL : class_name(L, 1);
  size_t count = 0, room = 0;
  checked(L, w, breve_world_objects(w->world, name, NULL, 0, &room));
  breve_object* objects = (breve_object*)lua_newuserdatauv(L, (room + 1) * sizeof *objects, 0);
  checked(L, w, breve_world_objects(w->world, name, objects, room, &count));
  lua_createtable(L, (int)room, 0);
  for (size_t i = 0; i < room && i < count; ++i) {
    bl_push_object(L, w, objects[i]);
    lua_rawseti(L, -2, (lua_Integer)i + 1);
  }
  return 1;
}

static int get_time(lua_State* L) {
  lua_pushnumber(L, breve_world_time(world_of(L)->world));
  return 1;
}

static int get_iteration(lua_State* L) {
  lua_pushinteger(L, (lua_Integer)breve_world_iteration(world_of(L)->world));
  return 1;
}

/* breve.random(bound): what random[bound] is in steve. */
static int draw(lua_State* L) {
  bl_world* w = world_of(L);
  breve_value bound, result;
  const char* fault = bl_to_value(L, w, 1, &bound);
  if (fault) return luaL_error(L, "%s", fault);
  checked(L, w, breve_world_random(w->world, &bound, &result));
  bl_push_value(L, w, &result);
  return 1;
}

/* ---- neighbours --------------------------------------------------------------------------------------------------- */

/* Where and how fast each neighbour is, read at once: x, y, z, then the velocity. */
typedef struct neighbors {
  bl_world* w;
  size_t count, next;
  bool moving; /* the numbers are known */
  breve_object* objects;
  double (*numbers)[6];
} neighbors;

static int next_neighbor(lua_State* L) {
  neighbors* n = (neighbors*)lua_touserdata(L, lua_upvalueindex(1));
  if (n->next == n->count) return 0;
  const size_t i = n->next++;
  if (lua_rawgeti(L, lua_upvalueindex(2), n->objects[i].index) == LUA_TNIL ||
      bl_to_object(L, -1).generation != n->objects[i].generation) {
    lua_pop(L, 1);
    if (!breve_object_alive(n->w->world, n->objects[i])) {
      lua_settop(L, 0);
      return next_neighbor(L); /* freed by the loop */
    }
    bl_push_object(L, n->w, n->objects[i]);
  }
  if (!n->moving) return 1;
  for (int k = 0; k < 6; ++k) lua_pushnumber(L, n->numbers[i][k]);
  return 7;
}

static neighbors* new_neighbors(lua_State* L, bl_world* w, size_t count) {
  neighbors* n = (neighbors*)lua_newuserdatauv(L, sizeof *n + count * (sizeof(breve_object) + sizeof(double[6])), 0);
  n->w = w;
  n->count = count;
  n->next = 0;
  n->moving = false;
  n->numbers = (double(*)[6])(void*)(n + 1);
  n->objects = (breve_object*)(void*)(n->numbers + count);
  return n;
}

static void read_motion(neighbors* n) {
  breve_array array = {n->numbers, sizeof(double[6]), BREVE_NUMBER_DOUBLE, 3};
  const breve_status placed =
      breve_objects_property(n->w->world, n->objects, n->count, BREVE_PROPERTY_LOCATION, &array);
  array.numbers = &n->numbers[0][3];
  n->moving = placed == BREVE_OK &&
              breve_objects_property(n->w->world, n->objects, n->count, BREVE_PROPERTY_VELOCITY, &array) == BREVE_OK;
}

/* for bird, x, y, z, vx, vy, vz in self:neighbors() do */
static int get_neighbors(lua_State* L) {
  enum { AT_ONCE = 64 };
  bl_world* w = world_of(L);
  breve_selector* selector = (breve_selector*)lua_touserdata(L, lua_upvalueindex(2));
  breve_value list, elements[AT_ONCE];
  size_t count = 0;
  lua_State* const outer = w->running;
  bl_profile_line(L, w);
  w->running = L;
  breve_status status = breve_object_call_prepared(w->world, bl_need_object(L, 1), *selector, NULL, 0, &list);
  w->running = outer;
  checked(L, w, status);
  checked(L, w, breve_list_size(w->world, &list, &count));
  neighbors* n = new_neighbors(L, w, count);
  for (size_t first = 0; first < count; first += AT_ONCE) {
    const size_t some = count - first < AT_ONCE ? count - first : AT_ONCE;
    checked(L, w, breve_list_read(w->world, &list, first, elements, some));
    for (size_t i = 0; i < some; ++i) n->objects[first + i] = elements[i].as.object;
  }
  if (count > 0) read_motion(n);
  lua_rawgeti(L, LUA_REGISTRYINDEX, w->objects);
  lua_pushcclosure(L, next_neighbor, 2);
  return 1;
}

/* What a class has in Lua stays; a method of breve makes room: its answer to "is-a" is 0, which is true in Lua. */
static void set_missing(lua_State* L, const char* name) {
  const bool there = lua_getfield(L, -2, name) == LUA_TFUNCTION && !lua_iscfunction(L, -1);
  lua_pop(L, 1);
  if (there)
    lua_pop(L, 1);
  else
    lua_setfield(L, -2, name);
}

/* The class has all methods by now: what it has itself stays. */
void bl_add_object_methods(lua_State* L, bl_world* w) {
  static const luaL_Reg functions[] = {{"free", free_object}, {"is_a", is_a}, {"class_name", get_class}, {NULL, NULL}};
  for (const luaL_Reg* f = functions; f->name; ++f) {
    lua_pushlightuserdata(L, w->lib);
    lua_pushcclosure(L, f->func, 1);
    set_missing(L, f->name);
  }
  const bool sees = lua_getfield(L, -1, "get_neighbors") != LUA_TNIL;
  lua_pop(L, 1);
  if (!sees) return;
  lua_pushlightuserdata(L, w->lib);
  breve_selector* selector = (breve_selector*)lua_newuserdatauv(L, sizeof *selector, 0);
  checked(L, w, breve_world_prepare(w->world, "get-neighbors", NULL, 0, selector));
  lua_pushcclosure(L, get_neighbors, 2);
  set_missing(L, "neighbors");
}

/* ---- what a snapshot is to hold ----------------------------------------------------------------------------------- */

static int set_hook(lua_State* L, int* hook) {
  luaL_checktype(L, 1, LUA_TFUNCTION);
  lua_settop(L, 1);
  if (*hook == LUA_NOREF)
    *hook = luaL_ref(L, LUA_REGISTRYINDEX);
  else
    lua_rawseti(L, LUA_REGISTRYINDEX, *hook);
  return 0;
}

static int on_save(lua_State* L) { return set_hook(L, &((bl_lib*)lua_touserdata(L, lua_upvalueindex(1)))->save_hook); }

static int on_load(lua_State* L) { return set_hook(L, &((bl_lib*)lua_touserdata(L, lua_upvalueindex(1)))->load_hook); }

void bl_open_functions(lua_State* L, bl_lib* lib) {
  static const luaL_Reg functions[] = {{"new", make_object},  {"free", free_object},          {"alive", is_alive},
                                       {"is_a", is_a},        {"class_name", get_class},      {"get", get_variable},
                                       {"set", set_variable}, {"controller", get_controller}, {"objects", all_objects},
                                       {"time", get_time},    {"iteration", get_iteration},   {"random", draw},
                                       {"on_save", on_save},  {"on_load", on_load},           {NULL, NULL}};
  lua_pushlightuserdata(L, lib);
  luaL_setfuncs(L, functions, 1);
}
