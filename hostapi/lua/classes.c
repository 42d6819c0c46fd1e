/* breve.class: classes that are written in Lua. A class is a table whose functions are its methods; what it has of its
   own stands in a hidden table, so that a method that is set anew is seen. */
#include <stdlib.h>
#include <string.h>

#include "binding.h"

static bl_lib* lib_of(lua_State* L) { return (bl_lib*)lua_touserdata(L, lua_upvalueindex(1)); }

/* The program that gets the classes that are defined now. */
static bl_program* being_defined(const bl_lib* lib) { return lib->loading ? lib->loading : lib->draft; }

void bl_draft_changed(bl_lib* lib) {
  breve_program_destroy(lib->compiled);
  lib->compiled = NULL;
  ++lib->changes;
}

void bl_push_class(lua_State* L, bl_lib* lib, const char* name) {
  lua_rawgeti(L, LUA_REGISTRYINDEX, lib->classes);
  lua_getfield(L, -1, name);
  lua_remove(L, -2);
}

/* Its table of own functions for name NULL. */
void bl_push_own(lua_State* L, bl_lib* lib, const char* class_name, const char* name) {
  bl_push_class(L, lib, class_name);
  if (!lua_istable(L, -1)) return;
  lua_getmetatable(L, -1);
  lua_getfield(L, -1, "own");
  lua_replace(L, -3);
  lua_pop(L, 1);
  if (!name) return;
  lua_getfield(L, -1, name);
  lua_remove(L, -2);
}

/* The name of a class: a text, or a class table. */
static const char* class_name(lua_State* L, int index) {
  if (lua_type(L, index) == LUA_TSTRING) return lua_tostring(L, index);
  if (luaL_getmetafield(L, index, "class") != LUA_TSTRING) luaL_typeerror(L, index, "class");
  const char* name = lua_tostring(L, -1);
  lua_replace(L, index);
  return name;
}

/* ---- super -------------------------------------------------------------------------------------------------------- */

/* The methods of a class that have a name, as breve knows them. They stand on top of the stack. */
static breve_method_info* push_methods(lua_State* L, bl_world* w, const char* of_class, const char* name,
                                       size_t* found) {
  size_t count = 0;
  breve_status status = breve_world_methods(w->world, of_class, NULL, 0, &count);
  if (status != BREVE_OK) bl_fail(L, w, status);
  breve_method_info* all = (breve_method_info*)lua_newuserdatauv(L, (count + 1) * sizeof *all, 0);
  status = breve_world_methods(w->world, of_class, all, count, &count);
  if (status != BREVE_OK) bl_fail(L, w, status);
  *found = 0;
  for (size_t i = 0; i < count; ++i) {
    const char *a = all[i].name, *b = name;
    for (; *a && *b && (*a == *b || (*a == '-' && *b == '_')); ++a, ++b) {
    }
    if (*a == *b) all[(*found)++] = all[i];
  }
  return all;
}

/* Those methods that `super` of a class calls by a name. Pushes a function, or nil.
   @param method  the one in Lua of its parent; NULL: it has none */
static void push_super_method(lua_State* L, bl_world* w, const bl_class* cls, const char* name,
                              const bl_method* method) {
  size_t found = 0;
  const breve_method_info* all = push_methods(L, w, cls->parent, name, &found);
  if (found == 0)
    lua_pushnil(L);
  else if (method)
    bl_push_lua_method(L, w, method, &all[0]);
  else
    bl_push_selector(L, w, all[0].name, cls->name, all, found);
  lua_remove(L, -2);
}

/* Flock.super.iterate: the function of the nearest ancestor in Lua that has one, else the method of the ancestor. */
static int super_index(lua_State* L) {
  bl_lib* lib = lib_of(L);
  bl_world* w = bl_current(L, lib);
  const char* name = luaL_checkstring(L, 2);
  const bl_class* cls = bl_program_class(w->program, lua_tostring(L, lua_upvalueindex(2)));
  const bl_method* method = NULL;
  if (!cls) return luaL_error(L, "the class of this 'super' is not part of the world");
  for (const bl_class* parent; !method && (parent = bl_program_class(w->program, cls->parent));) {
    bl_push_own(L, lib, parent->name, name);
    method = lua_isnil(L, -1) ? NULL : bl_class_method(parent, name);
    if (!lua_isnil(L, -1) && (!method || method->count < 2)) return 1;
    lua_pop(L, 1);
    if (!method) cls = parent;
  }
  lua_rawgeti(L, LUA_REGISTRYINDEX, w->metas);
  lua_pushfstring(L, "super %s %s", cls->name, name);
  lua_pushvalue(L, -1);
  if (lua_rawget(L, -3) != LUA_TNIL) return 1;
  lua_pop(L, 1);
  push_super_method(L, w, cls, name, method);
  lua_pushvalue(L, -2);
  lua_pushvalue(L, -2);
  lua_rawset(L, -5);
  return 1;
}

/* ---- class tables ------------------------------------------------------------------------------------------------- */

/* Upvalues: the library, the name, the own functions, super. */
static int class_index(lua_State* L) {
  lua_settop(L, 2);
  lua_pushvalue(L, 2);
  if (lua_rawget(L, lua_upvalueindex(3)) != LUA_TNIL) return 1;
  const char* key = lua_type(L, 2) == LUA_TSTRING ? lua_tostring(L, 2) : "";
  if (strcmp(key, "super") == 0) {
    lua_pushvalue(L, lua_upvalueindex(4));
    return 1;
  }
  if (strcmp(key, "name") == 0) {
    lua_pushvalue(L, lua_upvalueindex(2));
    return 1;
  }
  bl_lib* lib = lib_of(L);
  bl_program* program = being_defined(lib);
  if (!program && lib->current) program = lib->current->program;
  const bl_class* cls = bl_program_class(program, lua_tostring(L, lua_upvalueindex(2)));
  if (!cls || !bl_program_class(program, cls->parent)) return 0;
  bl_push_class(L, lib, cls->parent);
  if (lua_isnil(L, -1)) return 0;
  lua_pushvalue(L, 2);
  lua_gettable(L, -2);
  return 1;
}

/* A method that is set while a world runs takes the place of the one it had. */
static int class_assign(lua_State* L) {
  bl_lib* lib = lib_of(L);
  bl_world* w = lib->loading || lib->running_file ? NULL : lib->current;
  lua_settop(L, 3);
  lua_pushvalue(L, 2);
  if (lua_rawget(L, lua_upvalueindex(3)) == LUA_TFUNCTION || lua_isfunction(L, 3)) bl_draft_changed(lib);
  lua_settop(L, 3);
  lua_pushvalue(L, 2);
  lua_pushvalue(L, 3);
  lua_rawset(L, lua_upvalueindex(3));
  if (!w || lua_type(L, 2) != LUA_TSTRING) return 0;
  const bl_class* cls = bl_program_class(w->program, lua_tostring(L, lua_upvalueindex(2)));
  const bl_method* method = cls ? bl_class_method(cls, lua_tostring(L, 2)) : NULL;
  if (!cls) return 0;
  if (method) {
    if (!lua_isfunction(L, 3)) return luaL_error(L, "method '%s' cannot become something else", method->name);
    lua_rawgeti(L, LUA_REGISTRYINDEX, w->functions);
    lua_pushvalue(L, 3);
    lua_rawseti(L, -2, method->index);
  }
  bl_forget_classes(L, w);
  return 0;
}

/* Bird{...} and Bird() make an object; what the table holds becomes what the object holds. */
static int class_call(lua_State* L) {
  bl_world* w = bl_current(L, lib_of(L));
  breve_object object;
  bl_profile_line(L, w);
  const breve_status status = breve_object_create(w->world, lua_tostring(L, lua_upvalueindex(2)), &object);
  if (status != BREVE_OK) return bl_fail(L, w, status);
  bl_push_object(L, w, object);
  if (!lua_istable(L, 2)) return 1;
  for (lua_pushnil(L); lua_next(L, 2);) {
    lua_pushvalue(L, -2);
    lua_insert(L, -2);
    lua_settable(L, -4);
  }
  return 1;
}

static void push_class_table(lua_State* L, bl_lib* lib, const char* name) {
  static const luaL_Reg functions[] = {
      {"__index", class_index}, {"__newindex", class_assign}, {"__call", class_call}, {NULL, NULL}};
  lua_newtable(L); /* the class */
  lua_newtable(L); /* its metatable */
  lua_pushstring(L, name);
  lua_setfield(L, -2, "class");
  lua_pushfstring(L, "class %s", name);
  lua_pushvalue(L, -1);
  lua_setfield(L, -3, "__metatable");
  lua_setfield(L, -2, "__name");
  lua_pushlightuserdata(L, lib);
  lua_pushstring(L, name);
  lua_newtable(L);
  lua_pushvalue(L, -1);
  lua_setfield(L, -5, "own");
  lua_newtable(L); /* super */
  lua_newtable(L);
  lua_pushlightuserdata(L, lib);
  lua_pushstring(L, name);
  lua_pushcclosure(L, super_index, 2);
  lua_setfield(L, -2, "__index");
  lua_setmetatable(L, -2);
  luaL_setfuncs(L, functions, 4);
  lua_setmetatable(L, -2);
}

/* breve.class(name [, parent]) */
static int define_class(lua_State* L) {
  bl_lib* lib = lib_of(L);
  const char* name = luaL_checkstring(L, 1);
  const char* parent = lua_isnoneornil(L, 2) ? "Object" : class_name(L, 2);
  bl_program* program = being_defined(lib);
  if (program) {
    const bl_class* known = bl_program_class(program, name);
    if (known && !known->settled) return luaL_error(L, "class %s is defined twice", name);
    bl_draft_changed(lib);
    lua_Debug caller;
    bl_class* made = bl_program_add_class(program, name, parent);
    const bool known_place = lua_getstack(L, 1, &caller) && lua_getinfo(L, "Sl", &caller);
    const bool has_line = known_place && caller.currentline > 0;
    const char* file = !has_line ? "" : caller.source[0] == '@' ? caller.source + 1 : caller.short_src;
    if (!made || !bl_class_place(made, file, has_line ? (uint32_t)caller.currentline : 0))
      return luaL_error(L, "there is no memory for a class");
  } else {
    bl_world* w = bl_current(L, lib);
    if (!bl_program_class(w->staged ? w->staged : w->program, name))
      return luaL_error(L, "class %s is not part of the program: classes are defined when the file is loaded", name);
  }
  lua_settop(L, 1);
  push_class_table(L, lib, name);
  lua_rawgeti(L, LUA_REGISTRYINDEX, lib->classes);
  lua_pushvalue(L, -2);
  lua_setfield(L, -2, name);
  lua_pop(L, 1);
  return 1;
}

/* breve.main(class) */
static int choose_controller(lua_State* L) {
  bl_lib* lib = lib_of(L);
  const char* name = class_name(L, 1);
  bl_program* program = being_defined(lib);
  if (!program) return 0;
  char* copy = bl_copy(name, 0, 0);
  if (!copy) return luaL_error(L, "there is no memory for a name");
  char* old = program->controller;
  if (!old || strcmp(old, copy) != 0) bl_draft_changed(lib);
  program->controller = copy;
  free(old);
  return 0;
}

/* breve.use("Prey.tz", "Floor"): modules in steve, and classes of the library, that the program is to have. */
static int use_modules(lua_State* L) {
  bl_lib* lib = lib_of(L);
  bl_program* program = being_defined(lib);
  const int count = lua_gettop(L);
  bl_draft_changed(lib);
  for (int i = 1; i <= count; ++i) {
    const char* name = luaL_checkstring(L, i);
    if (program && !bl_program_add_use(program, name)) return luaL_error(L, "there is no memory for a name");
  }
  return 0;
}

void bl_open_classes(lua_State* L, bl_lib* lib) {
  static const luaL_Reg functions[] = {
      {"class", define_class}, {"main", choose_controller}, {"use", use_modules}, {NULL, NULL}};
  lua_newtable(L);
  lib->classes = luaL_ref(L, LUA_REGISTRYINDEX);
  lua_pushlightuserdata(L, lib);
  luaL_setfuncs(L, functions, 1);
}

/* ---- what a file has defined -------------------------------------------------------------------------------------- */

static void describe_method(lua_State* L, bl_program* program, bl_class* owner, const char* name) {
  lua_Debug function;
  lua_pushvalue(L, -1);
  lua_getinfo(L, ">uS", &function);
  if (function.nparams > BL_PARAMETERS + 1)
    luaL_error(L, "method '%s' of class %s has more than %d parameters", name, owner->name, BL_PARAMETERS);
  bl_method* m = bl_class_add_method(program, owner, name);
  if (m) m->file = bl_copy(function.source[0] == '@' ? function.source + 1 : function.short_src, 0, 0);
  if (!m || !m->file) luaL_error(L, "there is no memory for a method");
  m->line = function.linedefined > 0 ? (uint32_t)function.linedefined : 0; /* 0: it is in C */
  for (int i = 2; i <= function.nparams; ++i) {                            /* the first one is self */
    lua_pushvalue(L, -1);
    const char* parameter = lua_getlocal(L, NULL, i);
    m->keywords[m->count] = bl_copy(parameter, '_', '-');
    m->parameters[m->count++] = bl_copy(parameter, 0, 0);
    lua_pop(L, 1);
  }
}

/* A function of Lua: the methods of all classes that a file has defined. What begins with '_' is Lua's alone. */
int bl_describe_methods(lua_State* L) {
  bl_lib* lib = lib_of(L);
  bl_program* program = lib->loading;
  for (size_t i = 0; i < program->class_count; ++i) {
    bl_class* owner = program->classes[i];
    lua_settop(L, 0);
    bl_push_own(L, lib, owner->name, NULL);
    lua_rawgeti(L, LUA_REGISTRYINDEX, lib->sorted_keys);
    lua_pushvalue(L, 1);
    lua_call(L, 1, 1);
    const lua_Integer count = (lua_Integer)lua_rawlen(L, 2);
    for (lua_Integer k = 1; k <= count; ++k, lua_settop(L, 2)) {
      if (lua_rawgeti(L, 2, k) != LUA_TSTRING) continue;
      const char* name = lua_tostring(L, 3);
      lua_pushvalue(L, 3);
      if (lua_rawget(L, 1) == LUA_TFUNCTION && name[0] != '_') describe_method(L, program, owner, name);
    }
  }
  return 0;
}
