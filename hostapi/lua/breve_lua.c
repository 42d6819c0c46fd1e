/* The functions of breve_lua.h. */
#include <stdlib.h>
#include <string.h>

#include "binding.h"

/* ---- describing a file ------------------------------------------------------------------------------------------------ */

static int run_program(lua_State* L) {
  bl_lib* lib = (bl_lib*)lua_touserdata(L, 1);
  bl_run_program(L, lib, lib->loading);
  lua_pushlightuserdata(L, lib);
  lua_pushcclosure(L, bl_describe_methods, 1);
  lua_call(L, 0, 0);
  return 0;
}

static int describe_methods(lua_State* L) {
  lua_pushlightuserdata(L, lua_touserdata(L, 1));
  lua_pushcclosure(L, bl_describe_methods, 1);
  lua_call(L, 0, 0);
  return 0;
}

/* Run `function` with the library while the program is being described. */
static breve_status describe_with(lua_State* L, bl_lib* lib, bl_program* program, lua_CFunction function,
                                  breve_write_fn reason, void* sink) {
  bl_program* const outer = lib->loading;
  lib->loading = program;
  lua_pushcfunction(L, function);
  lua_pushlightuserdata(L, lib);
  const int code = lua_pcall(L, 1, 0, 0);
  lib->loading = outer;
  if (code == LUA_OK) return BREVE_OK;
  bl_tell(reason, sink, lua_type(L, -1) == LUA_TSTRING ? lua_tostring(L, -1) : "the file failed without a text");
  lua_pop(L, 1);
  return code == LUA_ERRMEM ? BREVE_ERROR_MEMORY : BREVE_ERROR_COMPILE;
}

breve_status bl_describe(lua_State* L, bl_lib* lib, bl_program* program, breve_write_fn reason, void* sink) {
  return describe_with(L, lib, program, program->texts ? run_program : describe_methods, reason, sink);
}

static int open_description(lua_State* L) {
  const bl_program* program = (const bl_program*)lua_touserdata(L, 1);
  bl_lib* lib = bl_open(L);
  if (!program->config.state) {
    lib->description = (bl_description*)lua_touserdata(L, 2);
    lua_setglobal(L, "breve");
    bl_open_safe_libraries(L, lib, program->config.allow);
  }
  return 0;
}

static breve_status describe(bl_program* program, breve_write_fn reason, void* sink) {
  bl_description bounds;
  lua_State* L = program->config.state;
  if (!L) L = bl_description_open(&bounds);
  if (!L) return BREVE_ERROR_MEMORY;
  lua_pushcfunction(L, open_description);
  lua_pushlightuserdata(L, program);
  lua_pushlightuserdata(L, program->config.state ? NULL : &bounds);
  breve_status status = BREVE_OK;
  if (lua_pcall(L, 2, 0, 0) != LUA_OK) {
    lua_pop(L, 1);
    status = BREVE_ERROR_MEMORY;
  } else {
    status = bl_describe(L, bl_lib_of(L), program, reason, sink);
  }
  if (!program->config.state) lua_close(L);
  return status;
}

/* ---- classes of the host ---------------------------------------------------------------------------------------------- */

static breve_status add_class(breve_runtime* runtime, bl_program* program, bl_class* c) {
  breve_class description = breve_class_default();
  breve_method* methods = (breve_method*)calloc(c->method_count + 1, sizeof *methods);
  breve_parameter* parameters = (breve_parameter*)calloc((c->method_count + 1) * BL_PARAMETERS, sizeof *parameters);
  breve_place* places = (breve_place*)calloc(c->method_count + 1, sizeof *places);
  breve_status status = BREVE_ERROR_MEMORY;
  if (methods && parameters && places) {
    for (size_t i = 0; i < c->method_count; ++i) {
      bl_method* m = c->methods[i];
      methods[i].name = m->selector;
      methods[i].parameters = &parameters[i * BL_PARAMETERS];
      methods[i].parameter_count = m->count;
      methods[i].result = BREVE_TYPE_NULL;
      methods[i].adopts_keywords = true;
      methods[i].call = bl_call_method;
      methods[i].user = m;
      places[i].file = m->file;
      places[i].line = m->line;
      for (size_t k = 0; k < m->count; ++k) parameters[i * BL_PARAMETERS + k].keyword = m->keywords[k];
    }
    description.name = c->name;
    description.parent = c->parent;
    description.modules = (const char* const*)program->uses;
    description.module_count = program->use_count;
    description.methods = methods;
    description.method_count = c->method_count;
    description.bind = bl_bind;
    description.places = bl_places;
    description.user = program;
    description.destroy = bl_program_drop;
    description.method_places = places;
    status = breve_runtime_add_class(runtime, &description);
    if (status == BREVE_OK) bl_program_hold(program);
  }
  free(methods), free(parameters), free(places);
  return status;
}

breve_status bl_register(breve_runtime* runtime, bl_program* program, breve_write_fn reason, void* sink) {
  for (size_t i = 0; i < program->class_count; ++i) {
    const breve_status status = add_class(runtime, program, program->classes[i]);
    if (status == BREVE_OK) continue;
    bl_tell_last(runtime, status, reason, sink);
    return status;
  }
  return BREVE_OK;
}

/* The program in steve that has all classes of the file. */
static char* main_text(const bl_program* program) {
  size_t size = strlen(program->controller) + 20;
  for (size_t i = 0; i < program->class_count; ++i) size += strlen(program->classes[i]->name) + 10;
  char* text = (char*)malloc(size);
  if (!text) return NULL;
  text[0] = 0;
  for (size_t i = 0; i < program->class_count; ++i)
    strcat(strcat(strcat(text, "@use "), program->classes[i]->name), ".\n");
  strcat(strcat(strcat(text, "Controller "), program->controller), ".\n");
  return text;
}

breve_status bl_compile(breve_runtime* runtime, bl_program* program, breve_write_fn reason, void* sink,
                        breve_program** compiled) {
  if (!program->controller) {
    bl_tell(reason, sink,
            "the file names no controller: end it with breve.main(Class), for a class that derives from Control");
    return BREVE_ERROR_COMPILE;
  }
  char* text = main_text(program);
  if (!text) return BREVE_ERROR_MEMORY;
  const breve_status status =
      breve_program_compile(runtime, program->texts ? program->texts[0].name : "lua", text, strlen(text), compiled);
  free(text);
  if (status == BREVE_ERROR_COMPILE)
    bl_tell_errors(runtime, program, reason, sink);
  else if (status != BREVE_OK)
    bl_tell_last(runtime, status, reason, sink);
  return status;
}

/* ---- breve_lua.h ------------------------------------------------------------------------------------------------------ */

static bool read_config(const breve_lua_config* given, breve_lua_config* config) {
  *config = breve_lua_config_default();
  if (!given) return true;
  if (given->struct_size < 2 * sizeof(size_t) || given->struct_size > sizeof *config) return false;
  memcpy(config, given, given->struct_size);
  config->struct_size = sizeof *config;
  const uint32_t rights = BREVE_LUA_IO | BREVE_LUA_OS | BREVE_LUA_PACKAGE | BREVE_LUA_DEBUG;
  return config->reserved == 0 && (config->allow & ~rights) == 0;
}

/* @param compiled  NULL: no program is asked for */
static breve_status load(breve_runtime* runtime, const breve_lua_config* given, const char* name, const char* text,
                         size_t size, breve_write_fn reason, void* sink, breve_program** compiled) {
  breve_lua_config config;
  if (!runtime || !name || (!text && size != 0) || !read_config(given, &config)) return BREVE_ERROR_ARGUMENT;
  bl_program* program = bl_program_new(&config, name, text, size);
  if (!program) return BREVE_ERROR_MEMORY;
  breve_status status = describe(program, reason, sink);
  if (status == BREVE_OK) status = bl_register(runtime, program, reason, sink);
  if (status == BREVE_OK && compiled) status = bl_compile(runtime, program, reason, sink, compiled);
  bl_program_drop(program);
  return status;
}

breve_status breve_lua_add(breve_runtime* runtime, const breve_lua_config* config, const char* name, const char* text,
                           size_t size, breve_write_fn reason, void* sink) {
  return load(runtime, config, name, text, size, reason, sink, NULL);
}

breve_status breve_lua_compile(breve_runtime* runtime, const breve_lua_config* config, const char* name,
                               const char* text, size_t size, breve_write_fn reason, void* sink,
                               breve_program** program) {
  if (!program) return BREVE_ERROR_ARGUMENT;
  return load(runtime, config, name, text, size, reason, sink, program);
}

lua_State* breve_lua_state(const breve_world* world) {
  bl_world* w = (bl_world*)breve_world_state(world, BL_STATE);
  return w ? w->L : NULL;
}
