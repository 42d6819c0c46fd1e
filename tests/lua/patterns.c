/* The functions of patterns are the binding's, with their work counted: they give what Lua's own give, errors included.
 */
#include <lauxlib.h>
#include <lua.h>
#include <lualib.h>

#include "scene.h"

static uint64_t state = 1;

static unsigned below(unsigned n) {
  state = state * 6364136223846793005u + 1442695040888963407u;
  return (unsigned)(state >> 33) % n;
}

static void make(char* text, unsigned most, const char* const* pieces, unsigned count) {
  *text = 0;
  for (unsigned i = below(most); i > 0; --i) strcat(text, pieces[below(count)]);
}

/* Everything that the functions give for these texts, as one text. */
static const char code[] =
    "local text, pattern, replacement, init = ...\n"
    "local all = {}\n"
    "local function add(...) for i = 1, select('#', ...) do all[#all + 1] = tostring((select(i, ...))) end all[#all + "
    "1] = "
    "';' end\n"
    "add(pcall(string.find, text, pattern, init))\n"
    "add(pcall(string.find, text, pattern, init, true))\n"
    "add(pcall(string.match, text, pattern, init))\n"
    "add(pcall(string.gsub, text, pattern, replacement))\n"
    "add(pcall(string.gsub, text, pattern, replacement, 2))\n"
    "add(pcall(string.gsub, text, pattern, {a = 'A', b = false, [2] = 'two'}))\n"
    "add(pcall(string.gsub, text, pattern, function(a, b) if a == 'a' then return b end return 7 end))\n"
    "add(pcall(function() local n = 0 for a, b in string.gmatch(text, pattern) do add(a, b) n = n + 1 if n > 50 then "
    "break "
    "end end end))\n"
    "return table.concat(all, ',')\n";

static const char* answer(lua_State* L, const char* text, const char* pattern, const char* replacement, int init) {
  if (luaL_loadstring(L, code) != LUA_OK) return lua_tostring(L, -1);
  lua_pushstring(L, text);
  lua_pushstring(L, pattern);
  lua_pushstring(L, replacement);
  lua_pushinteger(L, init);
  lua_pcall(L, 4, 1, 0);
  return lua_tostring(L, -1);
}

static void patterns_give_what_lua_gives(void) {
  static const char* const letters[] = {"a", "b", "ab", " ", "(", ")", "1", "x1", "[", "]", "^", "-", "%", "\xe4"};
  static const char* const pieces[] = {
      "a",  "b",  ".",    "%a",     "%d", "%s", "%w",  "%A", "[ab]", "[^a]", "[a-b]", "[%a1]",
      "*",  "+",  "-",    "?",      "*",  "-",  "(",   ")",  "()",   "(a)",  "(.-)",  "%1",
      "^",  "$",  "%b()", "%f[%w]", "%%", "%f", "[",   "]",  "%",    "[]a]", "[^]]",  "%p",
      "%2", "%u", "%x",   "%g",     "%c", "[%", "[a-", "%b", "[%]]", "(()",  "%.",    "%l"};
  static const char* const replacements[] = {"", "x", "%0", "<%1>", "%2", "%%", "%", "%a"};
  stage s;
  stage_begin(&s);
  if (!stage_open(&s, "local Main = breve.class('Main', 'Control')\nbreve.main(Main)\n", NULL)) return;
  lua_State *ours = breve_lua_state(s.world), *lua = luaL_newstate();
  luaL_openlibs(lua);
  unsigned matched = 0;
  for (int i = 0; i < 20000; ++i) {
    char text[64], pattern[64];
    make(text, 12, letters, sizeof letters / sizeof *letters);
    make(pattern, 7, pieces, sizeof pieces / sizeof *pieces);
    const char* replacement = replacements[below(sizeof replacements / sizeof *replacements)];
    const int init = (int)below(8) - 3;
    const char* expected = answer(lua, text, pattern, replacement, init);
    const char* got = answer(ours, text, pattern, replacement, init);
    if (!CHECK(expected && got && strcmp(expected, got) == 0)) {
      printf("  '%s' '%s' '%s' %d\n  %s\n  %s\n", text, pattern, replacement, init, expected, got);
      break;
    }
    if (strncmp(got, "true,nil", 8) != 0 && strncmp(got, "false", 5) != 0) ++matched;
    lua_settop(lua, 0);
    lua_settop(ours, 0);
  }
  CHECK(matched > 2000);
  lua_close(lua);
  stage_end(&s);
}

int main(void) {
  RUN(patterns_give_what_lua_gives);
  if (failures != 0) printf("%d checks failed\n", failures);
  return failures != 0;
}
