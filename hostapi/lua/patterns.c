/* string.find, match, gmatch and gsub with their work counted: a pattern can try ways without end, and Lua's own
   functions do so at one stretch. What matches is what Lua 5.4 says, whose algorithm this is (lstrlib.c, Copyright (C)
   1994-2022 Lua.org, PUC-Rio; MIT licence, as the rest of Lua); the tests compare both. */
#include <ctype.h>
#include <string.h>

#include "binding.h"

enum {
  UNFINISHED = -1,
  PLACE = -2,
  CAPTURES = 32,
  DEEPEST = 200, /* matches within matches */
  PIECE = 4096,  /* steps between two looks at the budget */
  STEPS = 8      /* so many take as long as one loop iteration in steve */
};

typedef struct capture {
  const char* begin;
  ptrdiff_t size; /* or UNFINISHED, or PLACE */
} capture;

typedef struct matcher {
  lua_State* L;
  bl_lib* lib;
  const char *text, *text_end, *pattern_end;
  int depth, level;
  capture captures[CAPTURES];
} matcher;

static bl_lib* lib_of(lua_State* L) { return (bl_lib*)lua_touserdata(L, lua_upvalueindex(1)); }

static void count(matcher* m, size_t steps) {
  m->lib->steps += steps;
  if (m->lib->steps < PIECE) return;
  const size_t all = m->lib->steps;
  m->lib->steps = 0;
  bl_charge(m->L, m->lib, all / STEPS);
}

static void begin(matcher* m) {
  m->level = 0;
  m->depth = DEEPEST;
}

static void prepare(matcher* m, lua_State* L, bl_lib* lib, const char* text, size_t size, const char* pattern,
                    size_t pattern_size) {
  m->L = L;
  m->lib = lib;
  m->text = text;
  m->text_end = text + size;
  m->pattern_end = pattern + pattern_size;
  begin(m);
}

/* ---- one character ------------------------------------------------------------------------------------------------ */

static unsigned char byte_at(const char* c) { return (unsigned char)*c; }

/* The end of the class that begins at `p`. */
static const char* class_end(matcher* m, const char* p) {
  if (p == m->pattern_end) luaL_error(m->L, "malformed pattern (ends with '%%')");
  const char first = *p++;
  if (first == '%') {
    if (p == m->pattern_end) luaL_error(m->L, "malformed pattern (ends with '%%')");
    return p + 1;
  }
  if (first != '[') return p;
  if (*p == '^') ++p;
  do { /* a ']' at the beginning is a member */
    if (p == m->pattern_end) luaL_error(m->L, "malformed pattern (missing ']')");
    count(m, 1);
    if (*p++ == '%' && p < m->pattern_end) ++p;
  } while (*p != ']');
  return p + 1;
}

static bool in_class(int c, int name) {
  bool is;
  switch (tolower(name)) {
    case 'a': is = isalpha(c) != 0; break;
    case 'c': is = iscntrl(c) != 0; break;
    case 'd': is = isdigit(c) != 0; break;
    case 'g': is = isgraph(c) != 0; break;
    case 'l': is = islower(c) != 0; break;
    case 'p': is = ispunct(c) != 0; break;
    case 's': is = isspace(c) != 0; break;
    case 'u': is = isupper(c) != 0; break;
    case 'w': is = isalnum(c) != 0; break;
    case 'x': is = isxdigit(c) != 0; break;
    default: return name == c;
  }
  return isupper(name) ? !is : is;
}

/* Is `c` in the set from the '[' at `p` to the ']' at `last`? */
static bool in_set(matcher* m, int c, const char* p, const char* last) {
  const bool inside = p[1] != '^';
  if (!inside) ++p;
  count(m, (size_t)(last - p));
  while (++p < last) {
    if (*p == '%') {
      if (in_class(c, byte_at(++p))) return inside;
    } else if (p[1] == '-' && p + 2 < last) {
      p += 2;
      if (byte_at(p - 2) <= c && c <= byte_at(p)) return inside;
    } else if (byte_at(p) == c) {
      return inside;
    }
  }
  return !inside;
}

/* Does the class from `p` to `end` match the character at `s`? */
static bool is_single(matcher* m, const char* s, const char* p, const char* end) {
  if (s >= m->text_end) return false;
  const int c = byte_at(s);
  switch (*p) {
    case '.': return true;
    case '%': return in_class(c, byte_at(p + 1));
    case '[': return in_set(m, c, p, end - 1);
    default: return byte_at(p) == c;
  }
}

/* ---- sequences ---------------------------------------------------------------------------------------------------- */

static const char* match(matcher* m, const char* s, const char* p);

/* %bxy */
static const char* match_balance(matcher* m, const char* s, const char* p) {
  if (p >= m->pattern_end - 1) luaL_error(m->L, "malformed pattern (missing arguments to '%%b')");
  if (*s != *p || s >= m->text_end) return NULL;
  const char open = p[0], close = p[1];
  for (int depth = 1; ++s < m->text_end; count(m, 1)) {
    if (*s == close) {
      if (--depth == 0) return s + 1;
    } else if (*s == open) {
      ++depth;
    }
  }
  return NULL;
}

static const char* match_most(matcher* m, const char* s, const char* p, const char* end) {
  ptrdiff_t i = 0;
  while (is_single(m, s + i, p, end)) {
    ++i;
    count(m, 1);
  }
  for (; i >= 0; --i) {
    const char* rest = match(m, s + i, end + 1);
    if (rest) return rest;
  }
  return NULL;
}

static const char* match_least(matcher* m, const char* s, const char* p, const char* end) {
  for (;;) {
    const char* rest = match(m, s, end + 1);
    if (rest) return rest;
    if (!is_single(m, s, p, end)) return NULL;
    ++s;
  }
}

static const char* open_capture(matcher* m, const char* s, const char* p, ptrdiff_t size) {
  if (m->level >= CAPTURES) luaL_error(m->L, "too many captures");
  m->captures[m->level].begin = s;
  m->captures[m->level].size = size;
  ++m->level;
  const char* rest = match(m, s, p);
  if (!rest) --m->level;
  return rest;
}

static const char* close_capture(matcher* m, const char* s, const char* p) {
  int at = m->level - 1;
  while (at >= 0 && m->captures[at].size != UNFINISHED) --at;
  if (at < 0) luaL_error(m->L, "invalid pattern capture");
  m->captures[at].size = s - m->captures[at].begin;
  const char* rest = match(m, s, p);
  if (!rest) m->captures[at].size = UNFINISHED;
  return rest;
}

/* What an earlier capture matched, again: %1 */
static const char* match_again(matcher* m, const char* s, int digit) {
  const int at = digit - '1';
  if (at < 0 || at >= m->level || m->captures[at].size == UNFINISHED)
    luaL_error(m->L, "invalid capture index %%%d", at + 1);
  const size_t size = (size_t)m->captures[at].size;
  if ((size_t)(m->text_end - s) < size) return NULL;
  count(m, size / STEPS);
  return memcmp(m->captures[at].begin, s, size) == 0 ? s + size : NULL;
}

/* Between a character that is not in the set, and one that is: %f[set] */
static bool is_frontier(matcher* m, const char* s, const char* p, const char* end) {
  const int before = s == m->text ? 0 : byte_at(s - 1);
  return !in_set(m, before, p, end - 1) && in_set(m, byte_at(s), p, end - 1);
}

/* What a '%' begins besides classes. Moves `s`, to NULL if it does not match, and `p`. False: it is a class. */
static bool match_escape(matcher* m, const char** s, const char** p) {
  const char* set = *p + 2;
  switch ((*p)[1]) {
    case 'b':
      *s = match_balance(m, *s, set);
      *p += 4;
      return true;
    case 'f': {
      if (*set != '[') luaL_error(m->L, "missing '[' after '%%f' in pattern");
      const char* end = class_end(m, set);
      if (!is_frontier(m, *s, set, end)) *s = NULL;
      *p = end;
      return true;
    }
    default: break;
  }
  if (!isdigit(byte_at(*p + 1))) return false;
  *s = match_again(m, *s, byte_at(*p + 1));
  *p += 2;
  return true;
}

static const char* match_rest(matcher* m, const char* s, const char* p) {
  while (p != m->pattern_end) {
    count(m, 1);
    if (*p == '(') return p[1] == ')' ? open_capture(m, s, p + 2, PLACE) : open_capture(m, s, p + 1, UNFINISHED);
    if (*p == ')') return close_capture(m, s, p + 1);
    if (*p == '$' && p + 1 == m->pattern_end) return s == m->text_end ? s : NULL;
    if (*p == '%' && match_escape(m, &s, &p)) {
      if (!s) return NULL;
      continue;
    }
    const char* end = class_end(m, p);
    const bool single = is_single(m, s, p, end);
    const char suffix = *end;
    if (suffix == '*' || (suffix == '+' && single)) return match_most(m, suffix == '+' ? s + 1 : s, p, end);
    if (suffix == '-') return match_least(m, s, p, end);
    if (suffix == '?') {
      const char* rest = single ? match(m, s + 1, end + 1) : NULL;
      if (rest) return rest;
      p = end + 1;
      continue;
    }
    if (!single) return NULL;
    ++s;
    p = end;
  }
  return s;
}

/* The end of what matches the pattern `p` at `s`; NULL: nothing does. */
static const char* match(matcher* m, const char* s, const char* p) {
  if (m->depth-- == 0) luaL_error(m->L, "pattern too complex");
  const char* rest = match_rest(m, s, p);
  ++m->depth;
  return rest;
}

/* ---- results ------------------------------------------------------------------------------------------------------ */

/* @return  the size of a capture, or PLACE: then its place is pushed */
static ptrdiff_t get_capture(matcher* m, int at, const char* s, const char* end, const char** begin) {
  if (at >= m->level) {
    if (at != 0) luaL_error(m->L, "invalid capture index %%%d", at + 1);
    *begin = s;
    return end - s;
  }
  const capture* c = &m->captures[at];
  *begin = c->begin;
  if (c->size == UNFINISHED) luaL_error(m->L, "unfinished capture");
  if (c->size == PLACE) lua_pushinteger(m->L, c->begin - m->text + 1);
  return c->size;
}

static void push_capture(matcher* m, int at, const char* s, const char* end) {
  const char* begin;
  const ptrdiff_t size = get_capture(m, at, s, end, &begin);
  if (size != PLACE) lua_pushlstring(m->L, begin, (size_t)size);
}

/* @param s  NULL: of a pattern without captures nothing is pushed, else the whole match */
static int push_captures(matcher* m, const char* s, const char* end) {
  const int all = m->level == 0 && s ? 1 : m->level;
  luaL_checkstack(m->L, all, "too many captures");
  for (int i = 0; i < all; ++i) push_capture(m, i, s, end);
  return all;
}

/* Where the third argument lets the search begin; more than the size: nowhere. */
static size_t beginning(lua_State* L, size_t size) {
  const lua_Integer at = luaL_optinteger(L, 3, 1);
  if (at > 0) return (size_t)at - 1;
  return at == 0 || at < -(lua_Integer)size ? 0 : size - (size_t)-at;
}

/* ---- find and match ----------------------------------------------------------------------------------------------- */

static bool is_plain(const char* pattern, size_t size) {
  for (size_t i = 0; i < size; ++i)
    if (pattern[i] != 0 && strchr("^$*+?.([%-", pattern[i])) return false;
  return true;
}

static const char* find_plain(matcher* m, const char* s, const char* word, size_t size) {
  if (size == 0) return s;
  while ((size_t)(m->text_end - s) >= size) {
    const char* next = (const char*)memchr(s, *word, (size_t)(m->text_end - s) - size + 1);
    count(m, ((size_t)((next ? next : m->text_end) - s) + size) / STEPS);
    if (!next) return NULL;
    if (memcmp(next, word, size) == 0) return next;
    s = next + 1;
  }
  return NULL;
}

static int search(lua_State* L, bool find) {
  size_t size, pattern_size;
  const char *text = luaL_checklstring(L, 1, &size), *pattern = luaL_checklstring(L, 2, &pattern_size);
  const size_t from = beginning(L, size);
  matcher m;
  if (from > size) {
    lua_pushnil(L);
    return 1;
  }
  prepare(&m, L, lib_of(L), text, size, pattern, pattern_size);
  count(&m, pattern_size);
  if (find && (lua_toboolean(L, 4) || is_plain(pattern, pattern_size))) {
    const char* found = find_plain(&m, text + from, pattern, pattern_size);
    if (!found) {
      lua_pushnil(L);
      return 1;
    }
    lua_pushinteger(L, found - text + 1);
    lua_pushinteger(L, found - text + (lua_Integer)pattern_size);
    return 2;
  }
  const bool anchored = *pattern == '^' && pattern_size != 0;
  for (const char* s = text + from; s <= m.text_end; ++s) {
    begin(&m);
    const char* end = match(&m, s, pattern + (anchored ? 1 : 0));
    if (end && find) {
      lua_pushinteger(L, s - text + 1);
      lua_pushinteger(L, end - text);
      return push_captures(&m, NULL, NULL) + 2;
    }
    if (end) return push_captures(&m, s, end);
    if (anchored) break;
  }
  lua_pushnil(L);
  return 1;
}

static int find(lua_State* L) { return search(L, true); }
static int first_match(lua_State* L) { return search(L, false); }

/* ---- gmatch ------------------------------------------------------------------------------------------------------- */

typedef struct walk {
  matcher m;
  const char *at, *pattern, *last;
} walk;

/* Upvalues: text and pattern, so that they stay, and the walk. */
static int next_match(lua_State* L) {
  walk* w = (walk*)lua_touserdata(L, lua_upvalueindex(3));
  w->m.L = L;
  for (const char* s = w->at; s <= w->m.text_end; ++s) {
    begin(&w->m);
    const char* end = match(&w->m, s, w->pattern);
    if (end && end != w->last) {
      w->at = w->last = end;
      return push_captures(&w->m, s, end);
    }
  }
  return 0;
}

static int all_matches(lua_State* L) {
  size_t size, pattern_size;
  const char *text = luaL_checklstring(L, 1, &size), *pattern = luaL_checklstring(L, 2, &pattern_size);
  const size_t from = beginning(L, size);
  lua_settop(L, 2);
  walk* w = (walk*)lua_newuserdatauv(L, sizeof *w, 0);
  prepare(&w->m, L, lib_of(L), text, size, pattern, pattern_size);
  w->at = text + (from > size ? size + 1 : from);
  w->pattern = pattern;
  w->last = NULL;
  lua_pushcclosure(L, next_match, 3);
  return 1;
}

/* ---- gsub --------------------------------------------------------------------------------------------------------- */

/* The third argument, a text, with %0 to %9 in it replaced. */
static void add_text(matcher* m, luaL_Buffer* out, const char* s, const char* end) {
  lua_State* L = m->L;
  size_t size;
  const char* text = lua_tolstring(L, 3, &size);
  const char* const last = text + size;
  for (const char* p; (p = (const char*)memchr(text, '%', (size_t)(last - text))) != NULL; text = p + 1) {
    luaL_addlstring(out, text, (size_t)(p - text));
    ++p;
    if (*p == '%') {
      luaL_addchar(out, '%');
    } else if (*p == '0') {
      luaL_addlstring(out, s, (size_t)(end - s));
    } else if (isdigit(byte_at(p))) {
      const char* begin;
      const ptrdiff_t got = get_capture(m, *p - '1', s, end, &begin);
      if (got == PLACE)
        luaL_addvalue(out);
      else
        luaL_addlstring(out, begin, (size_t)got);
    } else {
      luaL_error(L, "invalid use of '%c' in replacement string", '%');
    }
  }
  luaL_addlstring(out, text, (size_t)(last - text));
}

/* Adds what replaces the match from `s` to `end`. False: it stays as it is. */
static bool add_replacement(matcher* m, luaL_Buffer* out, const char* s, const char* end) {
  lua_State* L = m->L;
  switch (lua_type(L, 3)) {
    case LUA_TFUNCTION:
      lua_pushvalue(L, 3);
      lua_call(L, push_captures(m, s, end), 1);
      break;
    case LUA_TTABLE:
      push_capture(m, 0, s, end);
      lua_gettable(L, 3);
      break;
    default: add_text(m, out, s, end); return true;
  }
  if (!lua_toboolean(L, -1)) {
    lua_pop(L, 1);
    luaL_addlstring(out, s, (size_t)(end - s));
    return false;
  }
  if (!lua_isstring(L, -1)) luaL_error(L, "invalid replacement value (a %s)", luaL_typename(L, -1));
  luaL_addvalue(out);
  return true;
}

static int replace(lua_State* L) {
  size_t size, pattern_size;
  const char *s = luaL_checklstring(L, 1, &size), *pattern = luaL_checklstring(L, 2, &pattern_size);
  const int type = lua_type(L, 3);
  const lua_Integer most = luaL_optinteger(L, 4, (lua_Integer)size + 1);
  const bool anchored = *pattern == '^' && pattern_size != 0;
  const char* last = NULL;
  lua_Integer replaced = 0;
  bool changed = false;
  luaL_Buffer out;
  matcher m;
  luaL_argexpected(L, type == LUA_TNUMBER || type == LUA_TSTRING || type == LUA_TFUNCTION || type == LUA_TTABLE, 3,
                   "string/function/table");
  luaL_buffinit(L, &out);
  prepare(&m, L, lib_of(L), s, size, pattern, pattern_size);
  while (replaced < most) {
    begin(&m);
    const char* end = match(&m, s, pattern + (anchored ? 1 : 0));
    if (end && end != last) {
      ++replaced;
      changed = add_replacement(&m, &out, s, end) || changed;
      s = last = end;
    } else if (s < m.text_end) {
      luaL_addchar(&out, *s++);
    } else {
      break;
    }
    if (anchored) break;
  }
  if (changed) {
    luaL_addlstring(&out, s, (size_t)(m.text_end - s));
    luaL_pushresult(&out);
  } else {
    lua_pushvalue(L, 1);
  }
  lua_pushinteger(L, replaced);
  return 2;
}

void bl_open_patterns(lua_State* L, bl_lib* lib) {
  static const luaL_Reg functions[] = {
      {"find", find}, {"match", first_match}, {"gmatch", all_matches}, {"gsub", replace}, {NULL, NULL}};
  lua_getglobal(L, "string");
  lua_pushlightuserdata(L, lib);
  luaL_setfuncs(L, functions, 1);
  lua_pop(L, 1);
}
