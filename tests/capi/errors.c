/* What a host learns of a run-time error: text, help, place, and the chain of calls with its values. And lints. */
#include "scene.h"

static const char* const deep =
    "@use Control.\n"
    "Controller Deep.\n"
    "Control : Deep {\n"
    "  + variables:\n"
    "    leader (object).\n"
    "  + to look at target (vector) named text = \"a\\\"b\" (string) over k (list):\n"
    "    print |k|, (leader get-time).\n"
    "  + to start:\n"
    "    self look at (3, 0, 1.5) over { 1, 2 }.\n"
    "  + to dig deeper n (int):\n"
    "    self dig deeper n + 1.\n"
    "  + to turn around place (vector) end stop (vector):\n"
    "    if place::x > 2: self turn around stop end stop::x.\n"
    "    else self turn around place + (1, 0, 0) end stop.\n"
    "  + to long text s (string):\n"
    "    print s{-1}.\n"
    "}\n";

static void each_call_has_its_receiver_and_arguments(void) {
  scene s;
  if (!scene_open_text(&s, deep, NULL)) return;
  const breve_object controller = breve_world_controller(s.world);
  CHECK_STATUS(BREVE_ERROR_SCRIPT, breve_object_call(s.world, controller, "start", NULL, 0, NULL));
  const breve_error* e = breve_world_last_error(s.world);
  CHECK(e->line == 7 && e->column == 17 && e->length == 6);
  CHECK(strstr(e->message, "'leader' is null") != NULL);
  CHECK(e->help[0] != '\0');
  CHECK(e->frame_count == 2);
  CHECK_TEXT("look", e->frames[0].method);
  CHECK_TEXT("at (3, 0, 1.5) named \"a\\\\\\\"b\" over a list of 2", e->frames[0].arguments);
  CHECK(strncmp(e->frames[0].receiver, "Deep 0x", 7) == 0);
  CHECK(e->frames[1].line == 9 && e->frames[1].column == 10);
  CHECK_TEXT("", e->frames[1].arguments);
  CHECK(strstr(e->text, "help: ") != NULL);
  CHECK(strstr(e->text, "in Deep.look at (3, 0, 1.5)") != NULL);
  CHECK(strstr(e->text, ":9:10\n") != NULL);
  scene_close(&s);
}

static void the_middle_of_a_deep_recursion_is_folded_and_has_no_values(void) {
  scene s;
  if (!scene_open_text(&s, deep, NULL)) return;
  const breve_keyword deeper = {"deeper", breve_value_int(0)};
  CHECK_STATUS(BREVE_ERROR_DEPTH, breve_object_call(s.world, breve_world_controller(s.world), "dig", &deeper, 1, NULL));
  const breve_error* e = breve_world_last_error(s.world);
  CHECK(e->frame_count == 5000);
  CHECK_TEXT("deeper 0", e->frames[4999].arguments);
  CHECK_TEXT("deeper 4999", e->frames[0].arguments);
  CHECK_TEXT("", e->frames[2500].arguments);
  CHECK(strstr(e->text, "… 4,996 more of the same") != NULL);
  CHECK(strlen(e->text) < 2000);
  scene_close(&s);
}

static void a_call_whose_arguments_do_not_convert_is_not_in_the_chain(void) {
  scene s;
  if (!scene_open_text(&s, deep, NULL)) return;
  breve_keyword keywords[2] = {{"around", breve_value_vector(0, 0, 0)}, {"end", breve_value_vector(9, 0, 0)}};
  CHECK_STATUS(BREVE_ERROR_SCRIPT,
               breve_object_call(s.world, breve_world_controller(s.world), "turn", keywords, 2, NULL));
  const breve_error* e = breve_world_last_error(s.world);
  CHECK(strstr(e->message, "keyword 'end' must be a vector") != NULL);
  CHECK(e->line == 13);
  CHECK(e->frame_count == 4);
  CHECK_TEXT("around (3, 0, 0) end (9, 0, 0)", e->frames[0].arguments);
  scene_close(&s);
}

static void long_values_are_cut(void) {
  scene s;
  if (!scene_open_text(&s, deep, NULL)) return;
  char text[1001];
  memset(text, 'x', 1000);
  text[1000] = '\0';
  const breve_keyword keyword = {"text", breve_value_string(text)};
  CHECK_STATUS(BREVE_ERROR_SCRIPT,
               breve_object_call(s.world, breve_world_controller(s.world), "long", &keyword, 1, NULL));
  const breve_error* e = breve_world_last_error(s.world);
  CHECK(strlen(e->frames[0].arguments) < 80);
  CHECK(strstr(e->frames[0].arguments, "…\"") != NULL);
  scene_close(&s);
}

static void lints_are_listed_in_order_and_can_be_allowed(void) {
  breve_lint_info before = {"", BREVE_SEVERITY_NOTE, ""};
  size_t notes = 0;
  for (size_t i = 0; i < breve_lint_count(); ++i) {
    breve_lint_info lint;
    CHECK_STATUS(BREVE_OK, breve_lint(i, &lint));
    CHECK(strcmp(before.code, lint.code) < 0);
    CHECK(strncmp(lint.code, "lint-", 5) == 0 && lint.summary[0] != '\0');
    CHECK(lint.severity == BREVE_SEVERITY_WARNING || lint.severity == BREVE_SEVERITY_NOTE);
    if (lint.severity == BREVE_SEVERITY_NOTE) ++notes;
    before = lint;
  }
  CHECK(breve_lint_count() > 20 && notes > 0);
  CHECK_STATUS(BREVE_ERROR_NOT_FOUND, breve_lint(breve_lint_count(), &before));

  const char* text =
      "@use Control.\nController Doubt.\nControl : Doubt {\n  + to init:\n    print 2 * 3 ^ 2.\n"
      "    print 2 * 4 ^ 2.  # allow: lint-precedence\n}\n";
  breve_runtime* runtime = NULL;
  breve_program* program = NULL;
  CHECK_STATUS(BREVE_OK, breve_runtime_create(NULL, &runtime));
  CHECK_STATUS(BREVE_OK, breve_program_compile(runtime, "doubt.tz", text, strlen(text), &program));
  breve_program_destroy(program);
  CHECK(breve_runtime_diagnostic_count(runtime) == 1);
  breve_diagnostic d;
  CHECK_STATUS(BREVE_OK, breve_runtime_diagnostic(runtime, 0, &d));
  CHECK_TEXT("lint-precedence", d.code);
  CHECK(d.line == 5 && d.severity == BREVE_SEVERITY_WARNING);
  CHECK_STATUS(BREVE_ERROR_NOT_FOUND, breve_runtime_allow_lint(runtime, "lint-precedense"));
  CHECK(strstr(breve_runtime_last_error(runtime)->message, "'lint-precedence'") != NULL);
  CHECK_STATUS(BREVE_OK, breve_runtime_allow_lint(runtime, "lint-precedence"));
  CHECK_STATUS(BREVE_OK, breve_runtime_allow_lint(runtime, "lint-precedence"));
  CHECK_STATUS(BREVE_OK, breve_program_compile(runtime, "doubt.tz", text, strlen(text), &program));
  breve_program_destroy(program);
  CHECK(breve_runtime_diagnostic_count(runtime) == 0);
  CHECK_STATUS(BREVE_OK, breve_runtime_destroy(runtime));
}

void errors_suite(void);
void errors_suite(void) {
  RUN(each_call_has_its_receiver_and_arguments);
  RUN(the_middle_of_a_deep_recursion_is_folded_and_has_no_values);
  RUN(a_call_whose_arguments_do_not_convert_is_not_in_the_chain);
  RUN(long_values_are_cut);
  RUN(lints_are_listed_in_order_and_can_be_allowed);
}
