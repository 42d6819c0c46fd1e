/* Worlds of agents in Lua, for the tests of this folder. */
#ifndef BREVE_TESTS_LUA_SCENE_H
#define BREVE_TESTS_LUA_SCENE_H

#include "../capi/check.h"
#include "breve/breve_lua.h"

/* A runtime, and a world of one program. */
typedef struct stage {
  char said[8192], told[8192]; /* what scripts printed; warnings and errors */
  char why[2048];              /* why a file was refused */
  const char* steve;           /* the text of the module "Steve.tz"; NULL: there is none */
  const char* module;          /* ... "extra.lua" */
  uint32_t rights;             /* of breve_lua_right */
  breve_runtime* runtime;
  breve_program* program;
  breve_world* world;
} stage;

void stage_begin(stage* s);
/* The status of compiling a text in Lua; the program is kept. */
breve_status stage_compile(stage* s, const char* text);
/* A world of a text. False, and a failed check, if there is none. */
bool stage_open(stage* s, const char* text, const breve_world_config* config);
void stage_end(stage* s);
/* Call a method of the controller that takes nothing. */
breve_status stage_call(stage* s, const char* method, breve_value* result);
/* The number that one gives; a failed check if it fails or gives none. */
double stage_number(stage* s, const char* method);

#endif
