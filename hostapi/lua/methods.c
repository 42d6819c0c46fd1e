/* Calls into Lua: breve calls a method that a class has in Lua. Code that may raise an error runs in a protected call,
   so that no error of Lua ever passes through breve. Also finds where such a method stands, for error traces. */
#include <stdio.h>
#include <string.h>

#include "binding.h"

typedef struct arguments {
  bl_world* w;
  const bl_method* method;
  const breve_call* call;
} arguments;

/* ---- errors ------------------------------------------------------------------------------------------------------- */

static void keep_text(char* to, size_t room, const char* text) { snprintf(to, room, "%s", text ? text : ""); }

/* A method as steve knows it, however Lua has called it. */
static void name_function(char* to, size_t room, const bl_method* method, const char* name) {
  if (method)
    snprintf(to, room, "%s.%s", method->owner->name, method->selector);
  else
    keep_text(to, room, name ? name : "a function");
}

/* The functions of Lua that are active in a call, innermost first. */
static size_t walk(const bl_world* w, const bl_entry* entry, bl_place* places, size_t capacity) {
  lua_State* L = entry->thread;
  const bl_entry* inner = NULL;
  for (const bl_entry* e = w->entry; e != entry; e = e->outer)
    if (e->thread == L) inner = e;
  lua_Debug call;
  size_t count = 0;
  bool begun = inner == NULL;
  for (int level = 0; lua_getstack(L, level, &call) && (const void*)call.i_ci != entry->below; ++level) {
    if (!begun) begun = (const void*)call.i_ci == inner->below;
    if (!begun || !lua_getinfo(L, "Slnu", &call) || call.currentline < 0) continue;
    if (count == capacity) break;
    name_function(places[count].function, sizeof places[count].function, bl_method_at(w->program, &call), call.name);
    keep_text(places[count].file, sizeof places[count].file, call.source[0] == '@' ? call.source + 1 : call.short_src);
    places[count++].line = (uint32_t)call.currentline;
  }
  return count;
}

int bl_handle_error(lua_State* L) {
  bl_world* w = (bl_world*)lua_touserdata(L, lua_upvalueindex(1));
  if (w->entry && w->entry->thread == L) {
    w->place_count = walk(w, w->entry, w->places, BL_PLACES);
    w->failed = w->entry->call;
  }
  return 1;
}

size_t bl_places(void* user, const breve_call* call, breve_place* places, size_t capacity) {
  bl_world* w = (bl_world*)call->binding;
  (void)user;
  if (!w) return 0;
  if (w->failed != call) {
    const bl_entry* entry = w->entry;
    while (entry && entry->call != call) entry = entry->outer;
    w->place_count = entry ? walk(w, entry, w->places, BL_PLACES) : 0;
  }
  const size_t count = w->place_count < capacity ? w->place_count : capacity;
  for (size_t i = 0; i < count; ++i) {
    places[i].function = w->places[i].function;
    places[i].file = w->places[i].file;
    places[i].line = w->places[i].line;
  }
  return count;
}

/* "flock.lua:12: too low" without its place, which the chain of calls has. */
static const char* without_place(const bl_world* w, const char* message) {
  char place[160];
  if (w->place_count == 0) return message;
  const int size = snprintf(place, sizeof place, "%s:%u: ", w->places[0].file, (unsigned)w->places[0].line);
  return size > 0 && strncmp(message, place, (size_t)size) == 0 ? message + size : message;
}

/* The error on top of the stack as a status, with its text where breve does not know it. */
static breve_status fail(lua_State* L, bl_world* w, const breve_call* call, int code) {
  if (code == LUA_ERRMEM) return BREVE_ERROR_MEMORY;
  lua_rawgeti(L, LUA_REGISTRYINDEX, w->raised);
  const bool known = !lua_isnil(L, -1) && lua_rawequal(L, -1, -2);
  lua_pop(L, 1);
  const breve_error* last = breve_world_last_error(w->world);
  if (known && last && last->status == (uint32_t)w->raised_status) return w->raised_status;
  const char* message = lua_type(L, -1) == LUA_TSTRING ? lua_tostring(L, -1) : "an error that is not a text";
  message = without_place(w, message);
  call->reason(call->sink, message, strlen(message));
  return BREVE_ERROR_SCRIPT;
}

/* ---- the call ----------------------------------------------------------------------------------------------------- */

static int enter(lua_State* L) {
  const arguments* a = (const arguments*)lua_touserdata(L, 1);
  const bl_program* program = a->method->owner->program;
  if (a->w->staged == program) bl_switch_program(L, a->w);
  if (a->w->program != program) { /* after a reload */
    char why[600];
    bl_two_files(why, sizeof why, a->w->program, program);
    return luaL_error(L, "%s", why);
  }
  lua_settop(L, 0);
  luaL_checkstack(L, BL_PARAMETERS + 8, NULL);
  lua_rawgeti(L, LUA_REGISTRYINDEX, a->w->functions);
  lua_rawgeti(L, -1, a->method->index);
  bl_push_object(L, a->w, a->call->self);
  for (size_t i = 0; i < a->call->count; ++i) bl_push_value(L, a->w, &a->call->arguments[i]);
  lua_call(L, (int)a->call->count + 1, 1);
  return 1;
}

/* The function and its receiver, where both are there already: nothing can fail. */
static bool push_known(lua_State* L, bl_world* w, const bl_method* m, const breve_call* call) {
  if (call->count != 0 || w->program != m->owner->program) return false;
  lua_rawgeti(L, LUA_REGISTRYINDEX, w->functions);
  lua_rawgeti(L, -1, m->index);
  lua_rawgeti(L, LUA_REGISTRYINDEX, w->objects);
  const bool known =
      lua_rawgeti(L, -1, call->self.index) == LUA_TTABLE && bl_to_object(L, -1).generation == call->self.generation;
  lua_remove(L, -2);
  lua_remove(L, -3);
  if (!known) lua_pop(L, 2);
  return known;
}

static breve_status call_in_lua(lua_State* L, bl_world* w, const bl_method* m, const breve_call* call,
                                breve_value* result) {
  arguments a = {w, m, call};
  const int base = lua_gettop(L);
  if (!lua_checkstack(L, 16)) return BREVE_ERROR_MEMORY;
  lua_rawgeti(L, LUA_REGISTRYINDEX, w->handler);
  int given = 1;
  if (!push_known(L, w, m, call)) {
    lua_pushcfunction(L, enter);
    lua_pushlightuserdata(L, &a);
  }
  const int code = lua_pcall(L, given, 1, base + 1);
  breve_status status = BREVE_OK;
  if (code != LUA_OK) {
    status = fail(L, w, call, code);
  } else {
    const char* fault = bl_to_value(L, w, -1, result);
    if (fault) {
      call->reason(call->sink, fault, strlen(fault));
      status = BREVE_ERROR_TYPE;
    }
  }
  lua_settop(L, base);
  return status;
}

breve_status bl_call_method(void* user, const breve_call* call, breve_value* result) {
  const bl_method* m = (const bl_method*)user;
  bl_world* w = (bl_world*)call->binding;
  lua_State* const L = w->running;
  bl_world* const before = w->lib->current;
  lua_Debug top;
  bl_entry entry = {w->entry, call, L, lua_getstack(L, 0, &top) ? (const void*)top.i_ci : NULL, 0, false};
  if (!w->entry && w->exhausted) bl_count_anew(w);
  w->entry = &entry;
  w->lib->current = w;
  w->failed = NULL;
  if (breve_world_is_profiled(w->world)) bl_profile_call(L, w, &entry);
  const breve_status status = call_in_lua(L, w, m, call, result);
  bl_profile_return(w, &entry);
  w->entry = entry.outer;
  w->lib->current = before ? before : w;
  w->running = L;
  return status;
}
