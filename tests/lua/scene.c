/* What the tests of this folder share. */
#include "scene.h"

static void add(char* to, size_t room, const char* text, size_t size) {
  const size_t length = strlen(to), left = room - length - 1;
  strncat(to, text, size < left ? size : left);
}

static void print(void* user, breve_world* world, breve_channel channel, const char* text, size_t size) {
  stage* s = user;
  (void)world;
  if (channel == BREVE_CHANNEL_PRINT)
    add(s->said, sizeof s->said, text, size);
  else
    add(s->told, sizeof s->told, text, size);
}

static bool resolve(void* user, const char* name, const char* from, breve_module* module) {
  const stage* s = user;
  (void)from;
  module->text = strcmp(name, "Steve.tz") == 0 ? s->steve : strcmp(name, "extra.lua") == 0 ? s->module : NULL;
  module->size = module->text ? strlen(module->text) : 0;
  return module->text != NULL;
}

static void note(void* sink, const char* text, size_t size) {
  stage* s = sink;
  add(s->why, sizeof s->why, text, size);
}

void stage_begin(stage* s) {
  breve_runtime_config config = breve_runtime_config_default();
  memset(s, 0, sizeof *s);
  config.user = s;
  config.print = print;
  config.resolve_module = resolve;
  CHECK_STATUS(BREVE_OK, breve_runtime_create(&config, &s->runtime));
}

breve_status stage_compile(stage* s, const char* text) {
  breve_lua_config config = breve_lua_config_default();
  config.resolve_module = resolve;
  config.user = s;
  config.allow = s->rights;
  breve_program_destroy(s->program);
  s->program = NULL;
  s->why[0] = 0;
  return breve_lua_compile(s->runtime, &config, "agents.lua", text, strlen(text), note, s, &s->program);
}

bool stage_open(stage* s, const char* text, const breve_world_config* config) {
  if (!CHECK_STATUS(BREVE_OK, stage_compile(s, text))) {
    printf("%s\n", s->why);
    return false;
  }
  if (CHECK_STATUS(BREVE_OK, breve_world_create(s->runtime, s->program, config, &s->world))) return true;
  printf("%s\n", breve_runtime_last_error(s->runtime)->text);
  return false;
}

void stage_end(stage* s) {
  CHECK_STATUS(BREVE_OK, breve_world_destroy(s->world));
  breve_program_destroy(s->program);
  CHECK_STATUS(BREVE_OK, breve_runtime_destroy(s->runtime));
}

breve_status stage_call(stage* s, const char* method, breve_value* result) {
  return breve_object_call(s->world, breve_world_controller(s->world), method, NULL, 0, result);
}

double stage_number(stage* s, const char* method) {
  breve_value result = breve_value_null();
  if (!CHECK_STATUS(BREVE_OK, stage_call(s, method, &result))) {
    printf("%s: %s\n", method, breve_world_last_error(s->world)->text);
    return -1e300;
  }
  CHECK(result.type == BREVE_TYPE_INT || result.type == BREVE_TYPE_DOUBLE);
  return result.type == BREVE_TYPE_INT ? result.as.integer : result.as.number;
}
