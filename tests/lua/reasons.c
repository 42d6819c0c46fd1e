/* Why a file in Lua is refused: `reason` gets one text, with places in Lua, and nothing of an earlier error. */
#include "scene.h"

typedef struct heard {
  char text[2048];
  int times;
} heard;

static void hear(void* sink, const char* text, size_t size) {
  heard* h = sink;
  ++h->times;
  snprintf(h->text, sizeof h->text, "%.*s", (int)size, text);
}

static void refused(stage* s, breve_status status, const char* text, const char* expected) {
  heard h = {"", 0};
  breve_program* program = NULL;
  CHECK_STATUS(status, breve_lua_compile(s->runtime, NULL, "agents.lua", text, strlen(text), hear, &h, &program));
  CHECK(h.times == 1);
  CHECK_TEXT(expected, h.text);
}

static void a_reason_has_its_place_in_lua(void) {
  stage s;
  stage_begin(&s);
  s.steve = "@use Mobile.\nMobile : Animal {\n+ to legs: return paws.\n}\n";
  refused(&s, BREVE_ERROR_COMPILE, "\n\nlocal M = breve.class('M',\n'Nowhere')\nbreve.main(M)",
          "the program does not compile\nagents.lua:3: error: unknown parent class 'Nowhere'\n"
          "help: name the file that defines it in breve.use, or define it by breve.class");
  refused(&s, BREVE_ERROR_COMPILE, "local M = breve.class('M', 'Contrl') breve.main(M)",
          "the program does not compile\nagents.lua:1: error: unknown parent class 'Contrl'\n"
          "help: did you mean 'Control'?");
  refused(&s, BREVE_ERROR_COMPILE, "breve.main('Nobody')",
          "the program does not compile\nagents.lua: error: the controller class 'Nobody' is not defined\n"
          "help: define it, or name another class");
  refused(
      &s, BREVE_ERROR_COMPILE, "local M = breve.class('M', 'Control')\nbreve.main(M)\nbreve.use('Steve.tz')",
      "the program does not compile\n"
      "Steve.tz:3:19: error: unknown variable 'paws'\n    3 | + to legs: return paws.\n"
      "      |                   ^^^^\n"
      "help: declare it under '+ variables:' of the class, or at the beginning of the method, as in   paws (float).");
  refused(&s, BREVE_ERROR_COMPILE, "local = 1", "agents.lua:1: <name> expected near '='");
  refused(&s, BREVE_ERROR_ARGUMENT, "local M = breve.class('M', 'Control') function M:list() end",
          "class 'M': 'list' is a reserved word and cannot name a method");
  stage_end(&s);
}

/* An error of an earlier call is not taken for that of this one, though both have one status. */
static void a_reason_is_not_that_of_an_earlier_error(void) {
  stage s;
  stage_begin(&s);
  CHECK_STATUS(BREVE_ERROR_COMPILE, breve_program_compile(s.runtime, "old.tz", "old", 3, &s.program));
  refused(&s, BREVE_ERROR_COMPILE, "breve.class('M', 'Control')",
          "the file names no controller: end it with breve.main(Class), for a class that derives from Control");
  refused(&s, BREVE_ERROR_COMPILE, "error('stop')", "agents.lua:1: stop");
  stage_end(&s);
}

int main(void) {
  RUN(a_reason_has_its_place_in_lua);
  RUN(a_reason_is_not_that_of_an_earlier_error);
  if (failures != 0) printf("%d checks failed\n", failures);
  return failures != 0;
}
