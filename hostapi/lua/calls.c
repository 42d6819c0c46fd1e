/* Calls from Lua: `bird:set_velocity(v)` and `camera:point{at = a, from = b}`. All methods of one name are one function
   of Lua, which prepares what it is called with at the first call. */
#include <string.h>

#include "binding.h"

typedef struct overload {
  size_t count, required;
  const char *keywords[BL_KEYWORDS], *in_lua[BL_KEYWORDS];
  bool optional[BL_KEYWORDS];
  bool takes_method[BL_KEYWORDS]; /* the argument is the name of a method, which may be spelled as in Lua */
  bool prepared;
  breve_selector selector;
} overload;

/* Texts stand behind the overloads, in the same block. */
typedef struct selector {
  bl_world* w;
  const char* name;     /* in steve */
  const char* super_of; /* NULL: a usual call */
  size_t count;
  overload overloads[];
} selector;

int bl_fail(lua_State* L, bl_world* w, breve_status status) {
  const breve_error* error = breve_world_last_error(w->world);
  const bool same = error && error->status == (uint32_t)status;
  luaL_where(L, 1);
  lua_pushstring(L, same ? error->message : breve_status_name(status));
  if (same && error->help[0]) {
    lua_pushliteral(L, " (");
    lua_pushstring(L, error->help);
    lua_pushliteral(L, ")");
    lua_concat(L, 5);
  } else {
    lua_concat(L, 2);
  }
  lua_pushvalue(L, -1);
  lua_rawseti(L, LUA_REGISTRYINDEX, w->raised);
  w->raised_status = status;
  return lua_error(L);
}

/* ---- which method is meant ---------------------------------------------------------------------------------------- */

static bool has_keyword(const overload* o, const char* in_lua) {
  for (size_t i = 0; i < o->count; ++i)
    if (strcmp(o->in_lua[i], in_lua) == 0) return true;
  return false;
}

/* Is the only argument a table of arguments by keyword? All its keys are keywords of one overload then, and what that
   needs is there. */
static overload* named_overload(lua_State* L, selector* s) {
  if (!lua_istable(L, 2) || bl_is_object(L, 2)) return NULL;
  for (size_t i = 0; i < s->count; ++i) {
    overload* o = &s->overloads[i];
    size_t given = 0;
    bool fits = o->count > 0;
    for (lua_pushnil(L); lua_next(L, 2); lua_pop(L, 1)) {
      fits = fits && lua_type(L, -2) == LUA_TSTRING && has_keyword(o, lua_tostring(L, -2));
      ++given;
    }
    if (fits && given > 0 && given >= o->required) return o;
  }
  return NULL;
}

/* A table of which only some keys are keywords is a call by keyword with a slip, and not a value. */
static bool has_a_keyword(lua_State* L, const overload* o) {
  if (!lua_istable(L, 2) || bl_is_object(L, 2)) return false;
  for (lua_pushnil(L); lua_next(L, 2); lua_pop(L, 1)) {
    if (lua_type(L, -2) != LUA_TSTRING || !has_keyword(o, lua_tostring(L, -2))) continue;
    lua_pop(L, 2);
    return true;
  }
  return false;
}

/* "point{at = ..., from = ...}" of each overload, for a message. */
static const char* push_forms(lua_State* L, const selector* s) {
  luaL_Buffer text;
  luaL_buffinit(L, &text);
  for (size_t i = 0; i < s->count; ++i) {
    const overload* o = &s->overloads[i];
    if (i != 0) luaL_addstring(&text, " or ");
    for (const char* c = s->name; *c; ++c) luaL_addchar(&text, *c == '-' ? '_' : *c);
    luaL_addchar(&text, o->count > 1 ? '{' : '(');
    for (size_t k = 0; k < o->count; ++k) {
      if (k != 0) luaL_addstring(&text, ", ");
      for (const char* c = o->keywords[k]; *c; ++c) luaL_addchar(&text, *c == '-' ? '_' : *c);
      if (o->count > 1) luaL_addstring(&text, " = ...");
    }
    luaL_addchar(&text, o->count > 1 ? '}' : ')');
  }
  luaL_pushresult(&text);
  return lua_tostring(L, -1);
}

/* ---- arguments ---------------------------------------------------------------------------------------------------- */

/* A text that stays on the stack, with the name as steve spells it. */
static void spell_method(lua_State* L, breve_value* value) {
  if (value->type != BREVE_TYPE_STRING) return;
  luaL_Buffer text;
  luaL_buffinitsize(L, &text, value->as.string.size);
  for (size_t i = 0; i < value->as.string.size; ++i)
    luaL_addchar(&text, value->as.string.bytes[i] == '_' ? '-' : value->as.string.bytes[i]);
  luaL_pushresult(&text);
  value->as.string.bytes = lua_tostring(L, -1);
}

static void convert(lua_State* L, selector* s, const overload* o, size_t keyword, int index, breve_value* value) {
  const char* fault = bl_to_value(L, s->w, index, value);
  if (fault) luaL_error(L, "%s of '%s': %s", o->keywords[keyword], s->name, fault);
  if (o->takes_method[keyword]) spell_method(L, value);
}

static void prepare(lua_State* L, selector* s, overload* o) {
  const breve_status status =
      s->super_of ? breve_world_prepare_super(s->w->world, s->super_of, s->name, o->keywords, o->count, &o->selector)
                  : breve_world_prepare(s->w->world, s->name, o->keywords, o->count, &o->selector);
  if (status != BREVE_OK) bl_fail(L, s->w, status);
  o->prepared = true;
}

static breve_status call_prepared(lua_State* L, selector* s, overload* o, const breve_value* arguments,
                                  breve_value* result) {
  bl_world* w = s->w;
  lua_State* const outer = w->running;
  const breve_object self = bl_need_object(L, 1);
  if (!o->prepared) prepare(L, s, o);
  bl_profile_line(L, w);
  w->running = L;
  const breve_status status = breve_object_call_prepared(w->world, self, o->selector, arguments, o->count, result);
  w->running = outer;
  return status;
}

static int finish_call(lua_State* L, selector* s, overload* o, const breve_value* arguments) {
  breve_value result;
  const breve_status status = call_prepared(L, s, o, arguments, &result);
  if (status != BREVE_OK) return bl_fail(L, s->w, status);
  bl_push_value(L, s->w, &result);
  return 1;
}

/* Keywords that are left out have defaults; breve finds the method then, or says what is missing. */
static int call_named(lua_State* L, selector* s, overload* o) {
  bl_world* w = s->w;
  breve_value arguments[BL_KEYWORDS], result;
  breve_keyword given[BL_KEYWORDS];
  size_t count = 0;
  luaL_checkstack(L, 2 * BL_KEYWORDS + 8, NULL);
  for (size_t i = 0; i < o->count; ++i) {
    if (lua_getfield(L, 2, o->in_lua[i]) == LUA_TNIL) continue;
    convert(L, s, o, i, lua_gettop(L), &arguments[count]);
    given[count].name = o->keywords[i];
    given[count].value = arguments[count];
    ++count;
  }
  if (count == o->count) return finish_call(L, s, o, arguments);
  if (s->super_of) return luaL_error(L, "'%s' of super needs all its keywords: %s", s->name, push_forms(L, s));
  lua_State* const outer = w->running;
  const breve_object self = bl_need_object(L, 1);
  bl_profile_line(L, w);
  w->running = L;
  const breve_status status = breve_object_call(w->world, self, s->name, given, count, &result);
  w->running = outer;
  if (status != BREVE_OK) return bl_fail(L, w, status);
  bl_push_value(L, w, &result);
  return 1;
}

/* ---- the call ----------------------------------------------------------------------------------------------------- */

static overload* overload_of(selector* s, size_t count) {
  for (size_t i = 0; i < s->count; ++i)
    if (s->overloads[i].count == count) return &s->overloads[i];
  return NULL;
}

/* An argument by itself is that of the method with one keyword, or of the only one that another method needs. */
static int call_single(lua_State* L, selector* s) {
  breve_value argument, result;
  breve_keyword given;
  overload* o = overload_of(s, 1);
  if (o) {
    convert(L, s, o, 0, 2, &argument);
    return finish_call(L, s, o, &argument);
  }
  for (size_t i = 0; i < s->count && !o; ++i)
    if (s->overloads[i].required <= 1 && s->overloads[i].count > 0) o = &s->overloads[i];
  if (!o || s->super_of || has_a_keyword(L, o))
    return luaL_error(L, "'%s' takes other arguments: %s", s->name, push_forms(L, s));
  size_t keyword = 0;
  for (size_t i = o->count; i-- > 0;)
    if (!o->optional[i]) keyword = i;
  convert(L, s, o, keyword, 2, &given.value);
  given.name = o->keywords[keyword];
  lua_State* const outer = s->w->running;
  const breve_object self = bl_need_object(L, 1);
  bl_profile_line(L, s->w);
  s->w->running = L;
  const breve_status status = breve_object_call(s->w->world, self, s->name, &given, 1, &result);
  s->w->running = outer;
  if (status != BREVE_OK) return bl_fail(L, s->w, status);
  bl_push_value(L, s->w, &result);
  return 1;
}

static int call_selector(lua_State* L) {
  selector* s = (selector*)lua_touserdata(L, lua_upvalueindex(1));
  const int given = lua_gettop(L);
  if (given <= 1) {
    overload* o = overload_of(s, 0);
    if (o) return finish_call(L, s, o, NULL);
    lua_settop(L, 1);
    lua_newtable(L); /* all keywords are left out */
    for (size_t i = 0; i < s->count; ++i)
      if (s->overloads[i].required == 0) return call_named(L, s, &s->overloads[i]);
    return luaL_error(L, "'%s' needs arguments: %s", s->name, push_forms(L, s));
  }
  if (given > 2)
    return luaL_error(L, "'%s' takes one argument, or a table of arguments by keyword: %s", s->name, push_forms(L, s));
  overload* o = named_overload(L, s);
  return o ? call_named(L, s, o) : call_single(L, s);
}

/* ---- making one --------------------------------------------------------------------------------------------------- */

static char* keep(char** room, const char* text, char from, char to) {
  char* const kept = *room;
  do *(*room)++ = *text == from ? to : *text;
  while (*text++);
  return kept;
}

void bl_push_selector(lua_State* L, bl_world* w, const char* name, const char* super_of,
                      const breve_method_info* methods, size_t count) {
  size_t texts = strlen(name) + 1 + (super_of ? strlen(super_of) + 1 : 0);
  for (size_t i = 0; i < count; ++i)
    for (size_t k = 0; k < methods[i].keyword_count && k < BL_KEYWORDS; ++k)
      texts += 2 * (strlen(methods[i].keywords[k]) + 1);
  selector* s = (selector*)lua_newuserdatauv(L, sizeof *s + count * sizeof(overload) + texts, 0);
  char* room = (char*)&s->overloads[count];
  s->w = w;
  s->name = keep(&room, name, 0, 0);
  s->super_of = super_of ? keep(&room, super_of, 0, 0) : NULL;
  s->count = 0;
  for (size_t i = 0; i < count; ++i) {
    if (methods[i].keyword_count > BL_KEYWORDS) continue;
    overload* o = &s->overloads[s->count++];
    o->count = methods[i].keyword_count;
    o->required = 0;
    o->prepared = false;
    for (size_t k = 0; k < o->count; ++k) {
      o->keywords[k] = keep(&room, methods[i].keywords[k], 0, 0);
      o->in_lua[k] = keep(&room, methods[i].keywords[k], '-', '_');
      o->optional[k] = methods[i].defaults[k];
      o->takes_method[k] = strstr(o->keywords[k], "method") != NULL;
      if (!o->optional[k]) ++o->required;
    }
  }
  lua_pushcclosure(L, call_selector, 1);
}
