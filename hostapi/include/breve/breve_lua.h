/* breve_lua.h: agents written in Lua 5.4. It uses only breve.h.
 *
 *     breve_program* program;  breve_world* world;
 *     breve_lua_compile(runtime, NULL, "flock.lua", text, size, &program);
 *     breve_world_create(runtime, program, NULL, &world);
 *
 * A Lua file defines classes, which become classes of the host (breve_runtime_add_class): steve files and Lua files derive
 * from each other's classes and call each other's methods. Each world of a program with such classes has its own Lua
 * state, whose memory counts against the world's limit and whose loops count against its budget. When a world is created,
 * the state is created and the file is run in it. docs/lua.md explains how to write agents.
 *
 * The rules of breve.h about errors, threads and texts also hold here, except that breve_lua_add and breve_lua_compile
 * describe their errors to `reason` alone. After one of them has failed, breve_runtime_last_error may still return the
 * error of an earlier call, or one with positions in texts that the file does not contain.
 *
 * Link C++ programs with Lua's C++ build (lua5.4-c++), and C programs with either build; this library does not raise C++
 * exceptions and does not hold anything that an exception would have to clean up.
 */
#ifndef BREVE_BREVE_LUA_H
#define BREVE_BREVE_LUA_H

#include "breve/breve.h"

#ifdef __cplusplus
extern "C" {
#endif

struct lua_State;

/* Libraries of Lua that agents may use in addition, for breve_lua_config.allow. Always available are base, coroutine, math,
   string, table and utf8, except for functions whose results depend on the machine or the time. */
typedef enum breve_lua_right {
  BREVE_LUA_IO = 1,     /* io, and dofile and loadfile */
  BREVE_LUA_OS = 2,     /* os */
  BREVE_LUA_PACKAGE = 4, /* package, and a `require` that also finds files and shared libraries */
  BREVE_LUA_DEBUG = 8   /* debug */
} breve_lua_right;

typedef struct breve_lua_config {
  size_t struct_size; /* set by breve_lua_config_default */
  uint32_t allow;     /* a sum of breve_lua_right. Default 0 */
  uint32_t reserved;  /* must be 0 */
  /* Finds the text of a module for `require "name"`; it is asked for "name.lua". Called only by breve_lua_add; worlds run
     the text that was found then. NULL: there are no modules. Default NULL */
  breve_resolve_module_fn resolve_module;
  breve_release_module_fn release_module; /* NULL: modules need no release. Default NULL */
  void* user;                             /* passed to both. Default NULL */
  /* A Lua state of the host, in which the file is run once and all worlds of the program run their agents; it must outlive
     them and the program. The host is responsible for its libraries, memory and random numbers, and the budget does not
     apply to it. NULL: each world has its own state. Default NULL */
  struct lua_State* state;
} breve_lua_config;

/* The defaults named above. */
static inline breve_lua_config breve_lua_config_default(void) {
  breve_lua_config config;
  breve_clear(&config, sizeof config);
  config.struct_size = sizeof config;
  return config;
}

/* Runs a Lua file once, without a world, and adds the classes that it defines to the runtime: programs that are compiled
   from now on can use them. A class replaces one of the same name from an earlier file. A program can use the classes of
   one file and of the modules that it requires; with those of two files breve_world_create returns
   BREVE_ERROR_UNSUPPORTED.
   @param config  copied; NULL: the defaults
   @param name    of the file, for messages
   @param text    `size` bytes, copied; NULL only if size is 0
   @param reason  called once with `sink` and a description of the error. It is not called for a wrong argument of this
                  function, and may not be called if memory runs out. May be NULL
   BREVE_OK; BREVE_ERROR_ARGUMENT: a wrong struct_size or right; BREVE_ERROR_COMPILE: the file is not Lua, is bytecode,
   or its run failed; otherwise as breve_runtime_add_class. */
BREVE_API breve_status breve_lua_add(breve_runtime* runtime, const breve_lua_config* config, const char* name,
                                     const char* text, size_t size, breve_write_fn reason, void* sink);

/* Calls breve_lua_add and compiles a program of all classes of the file, with the controller that it sets by `breve.main`.
   @param program  destroy it with breve_program_destroy
   As breve_lua_add and breve_program_compile; BREVE_ERROR_COMPILE also if the file does not set a controller. */
BREVE_API breve_status breve_lua_compile(breve_runtime* runtime, const breve_lua_config* config, const char* name,
                                         const char* text, size_t size, breve_write_fn reason, void* sink,
                                         breve_program** program);

/* The Lua state that runs the agents of a world, for functions of the host; NULL if the world does not have a class written
   in Lua. It belongs to the world. */
BREVE_API struct lua_State* breve_lua_state(const breve_world* world);

/* Reads a field of each agent, as breve_objects_get reads a variable of each object. A number takes 1 number per row, and a
   vector 3. Use breve_objects_get for variables that agents in Lua inherit from steve classes.
   @param objects NULL only if count is 0; nothing is checked then
   @param field   its name in Lua: "energy" for self.energy
   @param array   if its width is 1, all the fields must be numbers; if it is 3, vectors
   @param reason  called once with `sink` and a description of the error, unless an argument is NULL. May be NULL
   BREVE_OK; BREVE_ERROR_STALE: an object has been freed; BREVE_ERROR_NOT_FOUND: the world has no class written in Lua, or a
   field is nil; BREVE_ERROR_TYPE: a field is of another type; BREVE_ERROR_ARGUMENT: a NULL pointer or an invalid array;
   BREVE_ERROR_MEMORY. An error leaves the array as it was. */
BREVE_API breve_status breve_lua_objects_get(const breve_world* world, const breve_object* objects, size_t count,
                                             const char* field, const breve_array* array, breve_write_fn reason,
                                             void* sink);

/* Sets a field that each agent already has. A whole number stays an integer of Lua if the field was one.
   As breve_lua_objects_get; if memory runs out during the call, the first fields are set. */
BREVE_API breve_status breve_lua_objects_set(breve_world* world, const breve_object* objects, size_t count,
                                             const char* field, const breve_array* array, breve_write_fn reason,
                                             void* sink);

/* Opens the library; `require "breve"` calls it in a Lua interpreter. Pushes the table of the library on the stack. */
BREVE_API int luaopen_breve(struct lua_State* L);

#ifdef __cplusplus
}
#endif

#endif
