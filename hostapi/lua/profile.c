/* Profiles: while breve takes one, a hook of Lua reports which functions of Lua run. Functions in C are not told:
   their time counts in their caller, and breve itself enters what they call of it. An error leaves frames without a
   return: they end with a frame further out, or at the next call at their depth, for which Lua uses their CallInfo
   again. */
#include <stdio.h>
#include <string.h>

#include "binding.h"

enum { MOST_FRAMES = 1024, SLOTS = 2048, MOST_FUNCTIONS = SLOTS / 2 };

/* A function of Lua, as breve knows it. */
typedef struct code {
  const char* source; /* its text's address, its line and its counts are its key: some share a line */
  int line;
  unsigned char parameters, upvalues;
  char class_name[60], name[60], file[120]; /* no class: it is not a method */
  breve_place place;
} code;

/* A function that runs, in Lua or in C. */
typedef struct frame {
  const lua_State* thread;
  const void* call;
  bool reported;
} frame;

struct bl_profile {
  size_t depth, count;
  frame frames[MOST_FRAMES];
  code* functions[SLOTS];
};

static bl_world* world_of(lua_State* L) {
  bl_lib* lib = bl_lib_of(L);
  return lib ? lib->current : NULL;
}

static void keep(char* to, size_t room, const char* text) { snprintf(to, room, "%s", text); }

static const char* file_of(const lua_Debug* function) {
  return function->source[0] == '@' ? function->source + 1 : function->short_src;
}

/* A method keeps the name that steve knows. */
const bl_method* bl_method_at(const bl_program* program, const lua_Debug* function) {
  const char* file = file_of(function);
  for (size_t i = 0; program && i < program->class_count; ++i)
    for (size_t k = 0; k < program->classes[i]->method_count; ++k) {
      const bl_method* m = program->classes[i]->methods[k];
      if (m->line == (uint32_t)function->linedefined && m->count + 1 == function->nparams && strcmp(m->file, file) == 0)
        return m;
    }
  return NULL;
}

static code* make_code(lua_State* L, bl_world* w, lua_Debug* function) {
  code* c = (code*)breve_world_allocate(w->world, sizeof *c);
  if (!c) return NULL;
  lua_getinfo(L, "n", function);
  const bl_method* m = bl_method_at(w->program, function);
  c->source = function->source;
  c->line = function->linedefined;
  c->parameters = function->nparams;
  c->upvalues = function->nups;
  keep(c->class_name, sizeof c->class_name, m ? m->owner->name : "");
  keep(c->name, sizeof c->name, m ? m->selector : function->name ? function->name : "function");
  keep(c->file, sizeof c->file, file_of(function));
  c->place.function = c->name;
  c->place.file = c->file;
  c->place.line = (uint32_t)c->line;
  return c;
}

/* NULL: there is no room for another one. */
static code* code_of(lua_State* L, bl_world* w, lua_Debug* function) {
  bl_profile* p = w->profile;
  size_t slot = ((size_t)function->source / 8 + (size_t)function->linedefined * 7) % SLOTS;
  for (code* c; (c = p->functions[slot]); slot = (slot + 1) % SLOTS)
    if (c->source == function->source && c->line == function->linedefined && c->parameters == function->nparams &&
        c->upvalues == function->nups && strncmp(c->file, file_of(function), sizeof c->file - 1) == 0)
      return c;
  if (p->count == MOST_FUNCTIONS) return NULL;
  code* made = make_code(L, w, function);
  if (made) {
    p->functions[slot] = made;
    ++p->count;
  }
  return made;
}

/* ---- frames ------------------------------------------------------------------------------------------------------- */

/* Leave a frame and those inside it, if it began in this call of breve. */
static void leave(bl_world* w, const lua_State* L, const void* call) {
  bl_profile* p = w->profile;
  size_t at = p->depth;
  while (at > w->entry->frames && (p->frames[at - 1].thread != L || p->frames[at - 1].call != call)) --at;
  if (at == w->entry->frames) return;
  while (p->depth >= at)
    if (p->frames[--p->depth].reported) breve_world_profile_leave(w->world);
}

/* True if it was reported. */
static bool report(lua_State* L, bl_world* w, lua_Debug* call) {
  lua_getinfo(L, "Su", call);
  if (call->what[0] == 'C') return false;
  if (w->entry->starts) { /* the method itself, which breve has entered */
    w->entry->starts = false;
    return false;
  }
  code* c = code_of(L, w, call);
  if (!c) return false;
  if (call->event == LUA_HOOKCALL) bl_profile_line(L, w); /* the caller of a tail call is gone */
  return breve_world_profile_enter(w->world, c->class_name, &c->place) == BREVE_OK;
}

static void enter(lua_State* L, bl_world* w, lua_Debug* call) {
  bl_profile* p = w->profile;
  if (p->depth == MOST_FRAMES) return;
  frame* f = &p->frames[p->depth++];
  f->thread = L;
  f->call = (const void*)call->i_ci;
  f->reported = false; /* an error in between, for example of memory, leaves it so */
  f->reported = report(L, w, call);
}

void bl_profile_event(lua_State* L, lua_Debug* call) {
  bl_world* w = world_of(L);
  if (!w || !w->entry || !w->profile) return;
  if (!breve_world_is_profiled(w->world)) {
    bl_set_hook(L, w, false);
    return;
  }
  leave(w, L, (const void*)call->i_ci);
  if (call->event != LUA_HOOKRET) enter(L, w, call);
}

void bl_profile_line(lua_State* L, bl_world* w) {
  lua_Debug caller;
  if (!w->profile || !breve_world_is_profiled(w->world)) return;
  if (lua_getstack(L, 1, &caller) && lua_getinfo(L, "l", &caller) && caller.currentline > 0)
    breve_world_profile_line(w->world, (uint32_t)caller.currentline);
}

/* ---- begin and end ------------------------------------------------------------------------------------------------ */

/* Without memory there is none: the run goes on, and the tree has methods that breve calls. */
static bl_profile* begin(bl_world* w) {
  bl_profile* p = (bl_profile*)breve_world_allocate(w->world, sizeof *p);
  if (p) memset(p, 0, sizeof *p);
  return p;
}

void bl_profile_call(lua_State* L, bl_world* w, bl_entry* entry) {
  if (!w->profile) w->profile = begin(w);
  if (!w->profile) return;
  if (!entry->outer) w->profile->depth = 0;
  entry->frames = w->profile->depth;
  entry->starts = true;
  bl_set_hook(L, w, true);
}

void bl_profile_return(bl_world* w, const bl_entry* entry) {
  if (w->profile) w->profile->depth = entry->frames;
}

void bl_profile_destroy(bl_world* w) {
  bl_profile* p = w->profile;
  if (!p) return;
  for (size_t i = 0; i < SLOTS; ++i)
    if (p->functions[i]) breve_world_release(w->world, p->functions[i], sizeof *p->functions[i]);
  breve_world_release(w->world, p, sizeof *p);
}
