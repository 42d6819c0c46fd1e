/* The Lua side of a world: its state, whose loops count in its budget, and the file of its program, run in it. */
#include <stdio.h>
#include <string.h>

#include "binding.h"

/* ---- the budget ---------------------------------------------------------------------------------------------------- */

enum {
  INSTRUCTIONS = 200,    /* from one count to the next */
  FEWEST = 4,            /* ... where each may take long */
  BYTES = 128,           /* so many of large blocks that are taken count as one loop iteration in steve */
  WEIGHT = 4096,         /* with so many that one instruction may go through, an instruction counts as two, and so on */
  MOST_TURNS = 25000000, /* of a file that is described: a second or two */
};

static void hook(lua_State* L, lua_Debug* event);

/* Four instructions take about as long as an iteration of a loop in steve. */
static uint64_t turns_of(int instructions, size_t weight) { return (uint64_t)instructions / 4 * (1 + weight / WEIGHT); }

/* The instructions up to the next count, which an interrupt waits for. */
static int piece_of(size_t weight) {
  const size_t share = INSTRUCTIONS / (1 + weight / BL_MUCH);
  return share < FEWEST ? FEWEST : (int)share;
}

/* Once the budget is used up every instruction is an error, so that no pcall in a loop can go on. */
static void fail_at_once(lua_State* L, bl_world* w, breve_status status) {
  w->exhausted = true;
  lua_sethook(L, hook, LUA_MASKCOUNT, 1);
  lua_sethook(w->L, hook, LUA_MASKCOUNT, 1);
  bl_fail(L, w, status);
}

static void charge_world(lua_State* L, bl_world* w, uint64_t turns) {
  const breve_status status = breve_world_charge(w->world, turns);
  if (status != BREVE_OK) fail_at_once(L, w, status);
}

void bl_look_soon(bl_world* w) {
  lua_State* const threads[] = {w->L, w->running};
  for (size_t i = 0; i < 2; ++i)
    if (threads[i] && lua_gethook(threads[i]) == hook && (lua_gethookmask(threads[i]) & LUA_MASKCOUNT) != 0)
      lua_sethook(threads[i], hook, lua_gethookmask(threads[i]), 1);
}

static void count_instructions(lua_State* L) {
  bl_world* w = *(bl_world**)lua_getextraspace(L);
  const size_t weight = bl_pool_weight(w->pool);
  const int counted = lua_gethookcount(L) >= FEWEST ? lua_gethookcount(L) : INSTRUCTIONS; /* 1: it looks soon */
  const uint64_t turns = w->exhausted ? 1 : turns_of(counted, weight);
  if (!w->exhausted && lua_gethookcount(L) != piece_of(weight))
    lua_sethook(L, hook, lua_gethookmask(L), piece_of(weight));
  charge_world(L, w, turns + bl_pool_owed(w->pool) / BYTES);
}

static void hook(lua_State* L, lua_Debug* event) {
  if (event->event == LUA_HOOKCOUNT)
    count_instructions(L);
  else
    bl_profile_event(L, event);
}

void bl_count_anew(bl_world* w) {
  w->exhausted = false;
  lua_sethook(w->L, hook, LUA_MASKCOUNT, INSTRUCTIONS);
}

/* ---- a file without a world ------------------------------------------------------------------------------------------ */

static void count_described(lua_State* L, lua_Debug* event);

static void charge_description(lua_State* L, bl_description* d, uint64_t turns) {
  d->turns = d->turns + turns < turns ? UINT64_MAX : d->turns + turns;
  if (!d->exhausted && d->turns <= MOST_TURNS) return;
  d->exhausted = true; /* no pcall can go on */
  lua_sethook(L, count_described, LUA_MASKCOUNT, 1);
  lua_sethook(d->L, count_described, LUA_MASKCOUNT, 1);
  luaL_error(L, "the file runs too long outside of its methods");
}

static void count_described(lua_State* L, lua_Debug* event) {
  bl_description* d = *(bl_description**)lua_getextraspace(L);
  (void)event;
  charge_description(L, d, turns_of(INSTRUCTIONS, d->weights.most));
}

lua_State* bl_description_open(bl_description* d) {
  memset(d, 0, sizeof *d);
  d->L = lua_newstate(bl_allocate_described, d);
  if (!d->L) return NULL;
  *(bl_description**)lua_getextraspace(d->L) = d;
  lua_sethook(d->L, count_described, LUA_MASKCOUNT, INSTRUCTIONS);
  return d->L;
}

void bl_charge(lua_State* L, bl_lib* lib, uint64_t turns) {
  if (lib->description)
    charge_description(L, lib->description, turns);
  else if (lib->current && lib->current->pool)
    charge_world(L, lib->current, turns);
}

/* Only a change sets it, since that begins the count of instructions anew. A hook of the host stays. */
void bl_set_hook(lua_State* L, bl_world* w, bool profiled) {
  const bool counts = w->pool && breve_world_has_budget(w->world);
  const int mask = (counts ? LUA_MASKCOUNT : 0) | (profiled ? LUA_MASKCALL | LUA_MASKRET : 0);
  const lua_Hook before = lua_gethook(L);
  if (w->exhausted || lua_gethookmask(L) == mask || (before && before != hook)) return;
  lua_sethook(L, mask == 0 ? NULL : hook, mask, INSTRUCTIONS);
}

/* ---- the library in a state ------------------------------------------------------------------------------------------ */

bl_lib* bl_lib_of(lua_State* L) {
  lua_getfield(L, LUA_REGISTRYINDEX, "breve.lib");
  bl_lib* lib = (bl_lib*)lua_touserdata(L, -1);
  lua_pop(L, 1);
  return lib;
}

/* Frees the draft and its program when the interpreter is closed. */
static int drop_draft(lua_State* L) {
  bl_lib* lib = (bl_lib*)lua_touserdata(L, 1);
  bl_draft_changed(lib);
  bl_program_drop(lib->draft);
  lib->draft = NULL;
  return 0;
}

bl_lib* bl_open(lua_State* L) {
  bl_lib* lib = bl_lib_of(L);
  if (lib) {
    lua_getfield(L, LUA_REGISTRYINDEX, "breve.library");
    return lib;
  }
  lib = (bl_lib*)lua_newuserdatauv(L, sizeof *lib, 0);
  memset(lib, 0, sizeof *lib);
  lua_createtable(L, 0, 1);
  lua_pushcfunction(L, drop_draft);
  lua_setfield(L, -2, "__gc");
  lua_setmetatable(L, -2);
  lua_rawgeti(L, LUA_REGISTRYINDEX, LUA_RIDX_MAINTHREAD);
  lib->main = lua_tothread(L, -1);
  lua_pop(L, 1);
  lib->save_hook = lib->load_hook = LUA_NOREF;
  lua_setfield(L, LUA_REGISTRYINDEX, "breve.lib");
  lua_pushcfunction(L, bl_sorted_keys);
  lib->sorted_keys = luaL_ref(L, LUA_REGISTRYINDEX);
  lua_newtable(L);
  bl_open_vectors(L, lib);
  bl_open_classes(L, lib);
  bl_open_functions(L, lib);
  lua_pushvalue(L, -1);
  lua_setfield(L, LUA_REGISTRYINDEX, "breve.library");
  return lib;
}

/* ---- a world's side -------------------------------------------------------------------------------------------------- */

typedef struct request {
  bl_world* w;
  bl_program* program;
} request;

/* A function of Lua: tables for a world. */
static int open_world(lua_State* L) {
  bl_world* w = ((request*)lua_touserdata(L, 1))->w;
  const uint32_t allow = ((request*)lua_touserdata(L, 1))->program->config.allow;
  if (w->pool) {
    w->lib = bl_open(L);
    w->lib->current = w;
    bl_open_safe_libraries(L, w->lib, allow);
    lua_getfield(L, LUA_REGISTRYINDEX, "breve.library");
    lua_setglobal(L, "breve");
  } else {
    w->lib = bl_lib_of(L);
  }
  int* const tables[] = {&w->objects, &w->metas, &w->functions};
  for (size_t i = 0; i < sizeof tables / sizeof *tables; ++i) {
    lua_newtable(L);
    *tables[i] = luaL_ref(L, LUA_REGISTRYINDEX);
  }
  lua_pushboolean(L, 1); /* any value but nil, which would have no place of its own */
  w->raised = luaL_ref(L, LUA_REGISTRYINDEX);
  lua_pushlightuserdata(L, w);
  lua_pushcclosure(L, bl_handle_error, 1);
  w->handler = luaL_ref(L, LUA_REGISTRYINDEX);
  return 0;
}

static void fill_functions(lua_State* L, bl_lib* lib, const bl_program* program) {
  for (size_t i = 0; i < program->class_count; ++i) {
    const bl_class* owner = program->classes[i];
    for (size_t k = 0; k < owner->method_count; ++k) {
      bl_push_own(L, lib, owner->name, owner->methods[k]->name);
      if (!lua_isfunction(L, -1))
        luaL_error(L, "class %s has no method '%s' when the file is run again", owner->name, owner->methods[k]->name);
      lua_rawseti(L, -2, owner->methods[k]->index);
    }
  }
}

/* A function of Lua: run the file for the world; its classes are staged. */
static int stage(lua_State* L) {
  const request* r = (const request*)lua_touserdata(L, 1);
  bl_world* w = r->w;
  bl_lib* lib = w->lib;
  const int classes = lib->classes;
  if (w->pool) {
    lua_newtable(L);
    lib->classes = luaL_ref(L, LUA_REGISTRYINDEX);
    bl_run_program(L, lib, r->program);
  }
  lua_newtable(L);
  fill_functions(L, lib, r->program);
  w->staged_functions = luaL_ref(L, LUA_REGISTRYINDEX);
  w->staged_classes = lib->classes;
  lib->classes = classes;
  return 0;
}

void bl_two_files(char* text, size_t room, const bl_program* one, const bl_program* other) {
  snprintf(text, room,
           "a world runs the classes of one Lua file, and this program has some of %.200s and of %.200s: let one "
           "file require the other",
           one->texts ? one->texts[0].name : "an interpreter", other->texts ? other->texts[0].name : "an interpreter");
}

void bl_switch_program(lua_State* L, bl_world* w) {
  bl_program* old = w->program;
  if (w->pool && w->lib->classes != w->staged_classes) luaL_unref(L, LUA_REGISTRYINDEX, w->lib->classes);
  luaL_unref(L, LUA_REGISTRYINDEX, w->functions);
  w->lib->classes = w->staged_classes;
  w->functions = w->staged_functions;
  w->program = w->staged;
  w->staged = NULL;
  bl_program_drop(old);
  bl_forget_classes(L, w);
}

static void destroy_world(void* user) {
  bl_world* w = (bl_world*)user;
  breve_world* world = w->world;
  if (w->pool) {
    lua_close(w->L);
    bl_pool_destroy(w->pool);
  } else {
    const int references[] = {w->objects, w->metas, w->functions, w->raised, w->handler};
    for (size_t i = 0; i < sizeof references / sizeof *references; ++i)
      luaL_unref(w->L, LUA_REGISTRYINDEX, references[i]);
    if (w->lib && w->lib->current == w) w->lib->current = NULL;
  }
  bl_profile_destroy(w);
  bl_program_drop(w->program);
  bl_program_drop(w->staged);
  breve_world_release(world, w, sizeof *w);
}

static breve_status fail_lua(const bl_world* w, int code, breve_write_fn reason, void* sink) {
  lua_State* L = w->L;
  const char* message = lua_type(L, -1) == LUA_TSTRING ? lua_tostring(L, -1) : "an error that is not a text";
  if (code != LUA_ERRMEM) reason(sink, message, strlen(message));
  lua_pop(L, 1);
  if (w->exhausted) return w->raised_status;
  return code == LUA_ERRMEM ? BREVE_ERROR_MEMORY : BREVE_ERROR_SCRIPT;
}

static int call_protected(lua_State* L, lua_CFunction function, request* r) {
  lua_pushcfunction(L, function);
  lua_pushlightuserdata(L, r);
  return lua_pcall(L, 1, 0, 0);
}

static breve_status make_world(breve_world* world, bl_program* program, breve_write_fn reason, void* sink,
                               bl_world** made) {
  bl_world* w = (bl_world*)breve_world_allocate(world, sizeof *w);
  if (!w) return BREVE_ERROR_MEMORY;
  memset(w, 0, sizeof *w);
  w->world = world;
  if (program->config.state) {
    w->L = program->config.state;
  } else {
    w->pool = bl_pool_new(world);
    w->L = w->pool ? lua_newstate(bl_allocate, w->pool) : NULL;
    if (!w->L) {
      if (w->pool) bl_pool_destroy(w->pool);
      breve_world_release(world, w, sizeof *w);
      return BREVE_ERROR_MEMORY;
    }
    *(bl_world**)lua_getextraspace(w->L) = w;
    bl_pool_serve(w->pool, w);
    if (breve_world_has_budget(world)) bl_count_anew(w);
  }
  w->running = w->L;
  request r = {w, program};
  const int code = call_protected(w->L, open_world, &r);
  breve_status status = code == LUA_OK ? BREVE_OK : fail_lua(w, code, reason, sink);
  if (status == BREVE_OK) {
    breve_state state = breve_state_default();
    state.user = w;
    state.save = bl_save;
    state.load = bl_load;
    state.gone = bl_object_gone;
    state.destroy = destroy_world;
    status = breve_world_set_state(world, BL_STATE, &state);
  }
  if (status != BREVE_OK)
    destroy_world(w);
  else
    *made = w;
  return status;
}

breve_status bl_bind(void* user, breve_world* world, void** binding, breve_write_fn reason, void* sink) {
  bl_program* program = (bl_program*)user;
  bl_world* w = (bl_world*)breve_world_state(world, BL_STATE);
  breve_status status = w ? BREVE_OK : make_world(world, program, reason, sink, &w);
  if (status != BREVE_OK) return status;
  *binding = w;
  if (w->program == program || w->staged == program) return BREVE_OK;
  /* While a world is made it has no controller yet; a program that is staged later takes the place of another. */
  if (w->staged && breve_world_controller(world).generation == 0) {
    char why[600];
    bl_two_files(why, sizeof why, w->staged, program);
    reason(sink, why, strlen(why));
    return BREVE_ERROR_UNSUPPORTED;
  }
  if (w->pool == NULL && w->L != program->config.state) {
    const char* why = "a world runs its agents in one state of Lua, and this program has another one";
    reason(sink, why, strlen(why));
    return BREVE_ERROR_UNSUPPORTED;
  }
  bl_program* const before = w->staged;
  bl_world* const current = w->lib->current;
  request r = {w, program};
  w->staged = program;
  w->lib->current = w;
  w->lib->running_file = true;
  const int code = call_protected(w->L, stage, &r);
  w->lib->running_file = false;
  w->lib->current = current ? current : w;
  if (code != LUA_OK) {
    w->staged = NULL;
    bl_program_drop(before);
    return fail_lua(w, code, reason, sink);
  }
  bl_program_drop(before);
  bl_program_hold(program);
  return BREVE_OK;
}
