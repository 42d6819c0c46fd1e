/* A host whose agents are written in Lua. */
#include <breve/breve_lua.h>
#include <stdio.h>
#include <string.h>

int main(void) {
  const char* agents =
      "local Game = breve.class('Game', 'Control')\nbreve.main(Game)\nfunction Game:init() self.x = 1 end\n";
  breve_runtime* runtime = NULL;
  breve_program* program = NULL;
  breve_world* world = NULL;
  if (breve_runtime_create(NULL, &runtime) != BREVE_OK) return 1;
  if (breve_lua_compile(runtime, NULL, "game.lua", agents, strlen(agents), NULL, NULL, &program) != BREVE_OK) return 1;
  if (breve_world_create(runtime, program, NULL, &world) != BREVE_OK) return 1;
  if (breve_world_step(world) != BREVE_OK) return 1;
  breve_world_destroy(world);
  breve_program_destroy(program);
  breve_runtime_destroy(runtime);
  puts("stepped");
  return 0;
}
