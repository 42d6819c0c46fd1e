/* Calls by keyword of methods in Lua: overrides, misspelt keys, and tables that are not such a call. */
#include "scene.h"

#define MAIN "local Main = breve.class('Main', 'Control')\nbreve.main(Main)\n"

/* A method that overrides another one is called by that one's keywords, or by the names of its own parameters. */
static void an_override_keeps_the_keywords(void) {
  stage s;
  stage_begin(&s);
  s.steve =
      "@use Mobile.\n"
      "Mobile : Animal { + to scare by n (int) with-shout t (string): return 0. }\n"
      "Hare : Leveret { + to legs: return 4. }\n";
  if (!stage_open(&s,
                  "breve.use 'Steve.tz'\n" MAIN "local Hare = breve.class('Hare', 'Animal')\n"
                  "function Hare:scare(by, shout) return by == 7 and shout == 'boo' end\n"
                  "local A = breve.class('A', 'Mobile')\n"
                  "function A:set_goal(to, weight) return to * 10 + weight end\n"
                  "local B = breve.class('B', A)\n"
                  "function B:set_goal(target, w) return 1000 + B.super.set_goal(self, {weight = w, to = target}) end\n"
                  "local C = breve.class('C', A)\n"
                  "function C:set_goal(weight, goal) return weight * 10 + goal end\n"
                  "function Main:scare() return Hare():scare{by = 7, with_shout = 'boo'} end\n"
                  "function Main:own() return Hare():scare{by = 7, shout = 'boo'} end\n"
                  "function Main:child() return breve.new('Leveret'):scare{by = 7, with_shout = 'boo'} end\n"
                  "function Main:goal() return B():set_goal{weight = 2, to = 4} end\n"
                  "function Main:own_goal() return B():set_goal{target = 4, w = 2} end\n"
                  /* `weight` is the keyword of the second argument, though the first parameter has that name */
                  "function Main:both() return C():set_goal{to = 4, weight = 2} end\n",
                  NULL))
    return;
  CHECK_NEAR(1, stage_number(&s, "scare"), 0);
  CHECK_NEAR(1, stage_number(&s, "own"), 0);
  CHECK_NEAR(1, stage_number(&s, "child"), 0);
  CHECK_NEAR(1042, stage_number(&s, "goal"), 0);
  CHECK_NEAR(1042, stage_number(&s, "own-goal"), 0);
  CHECK_NEAR(42, stage_number(&s, "both"), 0);
  CHECK_TEXT("", s.told);
  stage_end(&s);
}

static void refused_with(stage* s, const char* method, const char* part) {
  CHECK_STATUS(BREVE_ERROR_SCRIPT, stage_call(s, method, NULL));
  const breve_error* error = breve_world_last_error(s->world);
  if (error && !CHECK(strstr(error->message, part) != NULL)) printf("  %s: %s\n", method, error->message);
}

/* A key that is not a keyword is an error; a table that is not a call by keyword is an argument. */
static void no_keyword_is_lost_in_silence(void) {
  stage s;
  stage_begin(&s);
  s.steve =
      "@use Control.\n"
      "Control : Base { + to shout text t (hash) with-volume v = 1 (int): return 1. }\n";
  if (!stage_open(
          &s,
          "breve.use 'Steve.tz'\n"
          "local Main = breve.class('Main', 'Base')\nbreve.main(Main)\n"
          "function Main:set_goal(to, weight) return weight and to + weight or #to end\n"
          "function Main:choose(options) return options.weight end\n"
          "function Main:plan(options, extra) return options.color * 10 + (extra or 2) end\n"
          "function Main:misspelt() return self:set_goal{to = 1, wieght = 2} end\n"
          "function Main:alone() return self:set_goal{wieght = 2} end\n"
          "function Main:strange() return self:set_goal{to = 1, weight = 2, zeal = 1, angle = 2} end\n"
          "function Main:long(a1, b1, c1, d1, e1, f1, g1, h1) return h1 end\n"
          "function Main:whole() return self:long{a1 = 1, b1 = 2, c1 = 3, d1 = 4, e1 = 5, f1 = 6, g1 = 7, h1 = 8} end\n"
          "function Main:one_more() return self:long{a1 = 1, h1 = 8, other = 9} end\n"
          "function Main:numbered() return self:set_goal{1, weight = 2} end\n"
          "function Main:steve() return self:shout{text = 'boo', volume = 2} end\n"
          "function Main:row() return self:set_goal{5, 6, 7} end\n"
          "function Main:empty() return self:set_goal{} end\n"
          "function Main:single() return self:choose{weight = 4} end\n"
          "function Main:table_first() return self:plan{color = 4} end\n"
          "function Main:table_and_nil() return self:plan({color = 4, extra = 9}, nil) end\n",
          NULL))
    return;
  refused_with(&s, "misspelt", "method 'set_goal' has no keyword 'wieght'; did you mean 'weight'? (set_goal{to = ...");
  refused_with(&s, "alone", "no keyword 'wieght'");
  refused_with(&s, "strange", "no keyword 'angle' (set_goal{to = ..., weight = ...}");
  /* As many parameters as a method may have. */
  CHECK_NEAR(8, stage_number(&s, "whole"), 0);
  refused_with(
      &s, "one-more",
      "no keyword 'other' (long{a1 = ..., b1 = ..., c1 = ..., d1 = ..., e1 = ..., f1 = ..., g1 = ..., h1 = ...}");
  refused_with(&s, "numbered", "a key that is not a text");
  refused_with(&s, "steve", "shout{text = ..., with_volume = ...}");
  CHECK_NEAR(3, stage_number(&s, "row"), 0);
  CHECK_NEAR(0, stage_number(&s, "empty"), 0);
  CHECK_NEAR(4, stage_number(&s, "single"), 0);
  CHECK_NEAR(42, stage_number(&s, "table-first"), 0);
  CHECK_NEAR(42, stage_number(&s, "table-and-nil"), 0);
  stage_end(&s);
}

int main(void) {
  RUN(an_override_keeps_the_keywords);
  RUN(no_keyword_is_lost_in_silence);
  if (failures != 0) printf("%d checks failed\n", failures);
  return failures != 0;
}
