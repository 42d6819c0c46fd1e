/* breve_lua.h: agents written in Lua 5.4, on breve.h alone.
 *
 *     breve_program* program;  breve_world* world;
 *     breve_lua_compile(runtime, NULL, "flock.lua", text, size, &program);
 *     breve_world_create(runtime, program, NULL, &world);
 *
 * A Lua file defines classes; what it says of them becomes classes of the host (breve_runtime_add_class), so that steve
 * files and Lua files derive from each other's classes and call each other's methods. Each world of a program with such
 * classes has a Lua state of its own, whose memory counts against the world's limit and whose loops count against its
 * budget; it is made, and the file is run in it, when the world is made. docs/lua.md is the page for those who write agents.
 *
 * What breve.h says about errors, threads and texts holds here too. With a C++ program link Lua's C++ build (lua5.4-c++),
 * with a C program either; this library itself raises no C++ exception and keeps nothing that one would have to clean up.
 */
#ifndef BREVE_BREVE_LUA_H
#define BREVE_BREVE_LUA_H

#include "breve/breve.h"

#ifdef __cplusplus
extern "C" {
#endif

struct lua_State;

/* What of Lua's own libraries agents may use, in breve_lua_config.allow. Without: base, coroutine, math, string, table and
   utf8, without what depends on the machine or the moment. */
typedef enum breve_lua_right {
  BREVE_LUA_IO = 1,     /* io, and dofile and loadfile */
  BREVE_LUA_OS = 2,     /* os */
  BREVE_LUA_PACKAGE = 4, /* package, and a `require` that also finds files and shared libraries */
  BREVE_LUA_DEBUG = 8   /* debug */
} breve_lua_right;

typedef struct breve_lua_config {
  size_t struct_size; /* as breve_lua_config_default gives it */
  uint32_t allow;     /* of breve_lua_right, added. Default 0 */
  uint32_t reserved;  /* must be 0 */
  /* The text of a module that a file names in `require "name"`: it is asked for "name.lua". NULL: there are none. Called
     while the file is described only; worlds run the text that was found then. Default NULL */
  breve_resolve_module_fn resolve_module;
  breve_release_module_fn release_module; /* NULL: modules need no release. Default NULL */
  void* user;                             /* handed to both. Default NULL */
  /* A state of the host's own, in which the file is run once and all worlds of the program run their agents; it must
     outlive them, and the program. Its libraries, memory and random numbers are the host's affair, and the budget does not
     count in it. NULL: each world has a state of its own. Default NULL */
  struct lua_State* state;
} breve_lua_config;

/* The defaults named above. */
static inline breve_lua_config breve_lua_config_default(void) {
  breve_lua_config config;
  breve_clear(&config, sizeof config);
  config.struct_size = sizeof config;
  return config;
}

/* Run a Lua file once, without a world, and give the classes that it defines to the runtime: programs that are compiled
   from now on may name them. A class that an earlier file gave under the same name is replaced.
   @param config  copied; NULL: the defaults
   @param name    of the file, as messages show it
   @param text    `size` bytes, copied; NULL only if size is 0
   @param reason  to be called with `sink` and what is wrong, for people; NULL: not called
   BREVE_OK; BREVE_ERROR_ARGUMENT: a wrong struct_size or right; BREVE_ERROR_COMPILE: the file is not Lua, is bytecode,
   or failed when it was run; otherwise as breve_runtime_add_class. */
BREVE_API breve_status breve_lua_add(breve_runtime* runtime, const breve_lua_config* config, const char* name,
                                     const char* text, size_t size, breve_write_fn reason, void* sink);

/* breve_lua_add, and a program of all that the file defines, with the controller that it names by `breve.main`.
   @param program  to be given back to breve_program_destroy
   As breve_lua_add and breve_program_compile; BREVE_ERROR_COMPILE also if the file names no controller. */
BREVE_API breve_status breve_lua_compile(breve_runtime* runtime, const breve_lua_config* config, const char* name,
                                         const char* text, size_t size, breve_write_fn reason, void* sink,
                                         breve_program** program);

/* The Lua state that runs the agents of a world, for functions of the host's own; NULL if the world has no class written in
   Lua. It belongs to the world. */
BREVE_API struct lua_State* breve_lua_state(const breve_world* world);

/* Open the library: what `require "breve"` calls in a Lua interpreter. Leaves the table on the stack. */
BREVE_API int luaopen_breve(struct lua_State* L);

#ifdef __cplusplus
}
#endif

#endif
