/* The chain of calls of an error in Lua names methods by class and selector, however they were called. */
#include "scene.h"

static void check_frame(const breve_error* error, size_t index, const char* method, uint32_t line) {
  if (!CHECK(index < error->frame_count)) return;
  CHECK_TEXT(method, error->frames[index].method);
  CHECK_TEXT("agents.lua", error->frames[index].file);
  CHECK(error->frames[index].line == line);
}

static void methods_have_their_class(void) {
  stage s;
  stage_begin(&s);
  if (!stage_open(&s,
                  "local Main = breve.class('Main', 'Control')\nbreve.main(Main)\n"
                  "local A = breve.class('A', 'Mobile')\n"
                  "local B = breve.class('B', A)\n"
                  "function A:go_to(place, speed)\n"
                  "  error('no way')\n" /* line 6 */
                  "end\n"
                  "function B:go_to(place, speed)\n"
                  "  B.super.go_to(self, {place = place, speed = speed})\n" /* line 9 */
                  "end\n"
                  "function B:_try() self:go_to{place = 1, speed = 2} end\n" /* line 11 */
                  "function Main:deeper(b)\n"
                  "  b:_try()\n" /* line 13 */
                  "end\n"
                  "function Main:start()\n"
                  "  local good, why = pcall(function() self:deeper(B()) end)\n" /* line 16 */
                  "  self:deeper(B())\n"                                         /* line 17 */
                  "end\n",
                  NULL))
    return;
  CHECK_STATUS(BREVE_ERROR_SCRIPT, stage_call(&s, "start", NULL));
  const breve_error* error = breve_world_last_error(s.world);
  CHECK_TEXT("no way", error->message);
  CHECK(error->frame_count == 5);
  check_frame(error, 0, "A.go-to", 6);
  check_frame(error, 1, "B.go-to", 9);
  check_frame(error, 2, "_try", 11);
  check_frame(error, 3, "Main.deeper", 13);
  check_frame(error, 4, "start", 17); /* which breve has called: its class is that of the frame */
  if (error->frame_count == 5) CHECK_TEXT("Main", error->frames[4].class_name);
  if (!CHECK(strstr(error->text, "in B.go-to, called at agents.lua:11") != NULL)) printf("%s\n", error->text);
  stage_end(&s);
}

int main(void) {
  RUN(methods_have_their_class);
  if (failures != 0) printf("%d checks failed\n", failures);
  return failures != 0;
}
