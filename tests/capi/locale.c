/* locale NAME: a world in a process whose locale writes 1,5 prints and computes what it does in the C locale.
 * 77: there is no such locale here. */
#include <locale.h>
#include <stdlib.h>

#include "scene.h"

/* Numbers that are written and read: by the compiler, by conversions, in archives. */
static const char* const text =
    "@use Control.\n@use Matrix.\n@use Push.\n@use Mobile.\n@use Data.\n"
    "Controller Teller.\n"
    "Data : Note { + variables: x (float). v (vector). }\n"
    "Control : Teller {\n"
    "  + variables:\n    m, note, back, program (object).\n    x (float).\n    v (vector).\n    s (string).\n"
    "  + to init:\n"
    "    x = \"2.75\".\n    v = (1.5, -2.5, 1234567.5).\n    s = x.\n"
    "    print x, s, 1.0e-3, v, \"$x $v\".\n"
    "    m = (new Matrix2D init-with x-size 2 y-size 2).\n    m set-value to 0.5 at-x 1 at-y 0.\n"
    "    print m.\n    m print-matlab-style.\n"
    "    note = new Note.\n    note::x = 0.125.\n    note::v = (0.5, 1.5, 2.5).\n"
    "    s = (note archive-as-xml-string).\n    print s.\n"
    "    back = (self parse-xml-network-request from-string s).\n    print back::x, back::v.\n"
    "    program = new PushProgram.\n    program parse program \"( 1.5 2.25 FLOAT.+ )\".\n    print (program "
    "get-string).\n"
    "  + to iterate:\n    super iterate.\n    x += random[1.0].\n    print x.\n"
    "}\n";

typedef struct run {
  char print[8192];
  uint64_t hash;
} run;

static run run_once(void) {
  run r = {"", 0};
  scene s;
  if (!scene_open_text(&s, text, NULL)) return r;
  for (int i = 0; i < 20; ++i) CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  breve_value value;
  CHECK_STATUS(BREVE_OK,
               breve_world_evaluate(s.world, breve_world_controller(s.world), "print 10000.5, x / 3.", 21, &value));
  CHECK_STATUS(BREVE_OK, breve_world_hash(s.world, &r.hash));
  CHECK(s.said.warnings == 0 && s.said.errors == 0);
  memcpy(r.print, s.said.print, sizeof r.print);
  scene_close(&s);
  return r;
}

int main(int count, char** arguments) {
  if (count != 2) return 2;
  const run plain = run_once();
  if (!setlocale(LC_ALL, arguments[1])) return 77;
  char number[8];
  snprintf(number, sizeof number, "%.1f", 1.5);
  if (!CHECK_TEXT("1,5", number)) return 1;
  const run with_comma = run_once();
  CHECK(strstr(plain.print, "10000.5") != NULL);
  CHECK_TEXT(plain.print, with_comma.print);
  CHECK(plain.hash == with_comma.hash);
  return failures != 0;
}
