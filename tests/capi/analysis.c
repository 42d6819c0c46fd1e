/* What a program is made of: symbols, names at places, completions; and every invalid argument. */
#include "breve/analysis.h"

#include "scene.h"

static const char world_text[] =
    "@use Control.\n"
    "Controller Field.\n"
    "Mobile : Bird (aka Birds) {\n"
    "  % A bird.\n"
    "  + to fly to place (vector) with-speed speed = 1.5 (float):\n"
    "    % Fly somewhere.\n"
    "    print place, speed.\n"
    "}\n"
    "Control : Field {\n"
    "  + to init:\n"
    "    bird (object).\n"
    "    bird = new Bird.\n"
    "    bird fly to (1, 2, 3).\n"
    "}\n";

static breve_analysis* analyse(breve_runtime* runtime, const char* text) {
  breve_analysis* analysis = NULL;
  CHECK_STATUS(BREVE_OK, breve_analysis_create(runtime, "made.tz", text, strlen(text), &analysis));
  return analysis;
}

static breve_runtime* plain_runtime(void) {
  breve_runtime* runtime = NULL;
  CHECK_STATUS(BREVE_OK, breve_runtime_create(NULL, &runtime));
  return runtime;
}

/* The symbol of that kind and name; all zero if there is none. */
static breve_symbol symbol_named(const breve_analysis* analysis, breve_name_kind kind, const char* name) {
  for (size_t i = 0; i < breve_analysis_symbol_count(analysis); ++i) {
    breve_symbol symbol;
    CHECK_STATUS(BREVE_OK, breve_analysis_symbol(analysis, i, &symbol));
    if (symbol.kind == kind && strcmp(symbol.name, name) == 0) return symbol;
  }
  breve_symbol none;
  memset(&none, 0, sizeof none);
  return none;
}

static void symbols_have_signatures_documentation_and_places(void) {
  breve_runtime* runtime = plain_runtime();
  breve_analysis* a = analyse(runtime, world_text);
  const breve_symbol bird = symbol_named(a, BREVE_NAME_CLASS, "Bird");
  CHECK_TEXT("Mobile : Bird (aka Birds)", bird.signature);
  CHECK_TEXT("A bird.", bird.documentation);
  CHECK_TEXT("Mobile", bird.parent_class);
  CHECK_TEXT("Birds", bird.alias);
  CHECK_TEXT("made.tz", bird.name_span.file);
  CHECK(bird.name_span.line == 3 && bird.name_span.column == 10 && bird.name_span.end_column == 14);
  CHECK(bird.span.line == 3 && bird.span.end_line == 8 && bird.span.end_column == 2);
  CHECK(!bird.library && bird.loaded);
  const breve_symbol fly = symbol_named(a, BREVE_NAME_METHOD, "fly");
  CHECK_TEXT("fly to place (vector) with-speed speed = 1.5 (float)", fly.signature);
  CHECK_TEXT("Fly somewhere.", fly.documentation);
  CHECK_TEXT("Bird", fly.owner);
  const breve_symbol keyword = symbol_named(a, BREVE_NAME_KEYWORD, "with-speed");
  CHECK_TEXT("float", keyword.type);
  CHECK_TEXT("1.5", keyword.value);
  CHECK(symbol_named(a, BREVE_NAME_CLASS, "Mobile").library);
  CHECK(!symbol_named(a, BREVE_NAME_CLASS, "Stationary").loaded);
  const breve_symbol function = symbol_named(a, BREVE_NAME_FUNCTION, "sqrt");
  CHECK_TEXT("sqrt(x (float))", function.signature);
  CHECK_TEXT("", function.span.file);
  CHECK(function.span.line == 0 && function.parent == BREVE_NO_SYMBOL);
  breve_symbol none;
  CHECK_STATUS(BREVE_ERROR_NOT_FOUND, breve_analysis_symbol(a, breve_analysis_symbol_count(a), &none));
  breve_analysis_destroy(a);
  breve_runtime_destroy(runtime);
}

static void an_analysis_outlives_its_runtime_and_leaves_its_diagnostics_alone(void) {
  breve_runtime* runtime = plain_runtime();
  breve_program* program = NULL;
  CHECK_STATUS(BREVE_ERROR_COMPILE, breve_program_compile(runtime, "bad.tz", "!", 1, &program));
  const size_t before = breve_runtime_diagnostic_count(runtime);
  breve_analysis* a = analyse(runtime, "Object : A {\n  + to x: y = 1.\n}\nController A.\n");
  CHECK(breve_runtime_diagnostic_count(runtime) == before);
  CHECK_STATUS(BREVE_OK, breve_runtime_destroy(runtime));
  CHECK(breve_analysis_diagnostic_count(a) == 1);
  breve_diagnostic d;
  CHECK_STATUS(BREVE_OK, breve_analysis_diagnostic(a, 0, &d));
  CHECK_TEXT("unknown-variable", d.code);
  CHECK(d.line == 2);
  CHECK_STATUS(BREVE_ERROR_NOT_FOUND, breve_analysis_diagnostic(a, 1, &d));
  CHECK_TEXT("x", symbol_named(a, BREVE_NAME_METHOD, "x").signature);
  breve_analysis_destroy(a);
}

static void names_at_places_lead_to_their_definitions_and_back(void) {
  breve_runtime* runtime = plain_runtime();
  breve_analysis* a = analyse(runtime, world_text);
  breve_reference reference;
  CHECK_STATUS(BREVE_OK, breve_analysis_name_at(a, "made.tz", 13, 11, &reference));
  CHECK(reference.kind == BREVE_NAME_METHOD && !reference.declaration);
  CHECK_TEXT("fly", reference.name);
  CHECK_TEXT("Bird object", reference.type);
  CHECK_TEXT("Fly somewhere.", reference.documentation);
  CHECK(reference.span.column == 10 && reference.span.length == 3);
  size_t symbols[4], count = 0;
  CHECK_STATUS(BREVE_OK, breve_analysis_definitions(a, "made.tz", 13, 11, symbols, 4, &count));
  CHECK(count == 1 && symbols[0] == reference.symbol);
  breve_span spans[4];
  CHECK_STATUS(BREVE_OK, breve_analysis_references(a, symbols[0], spans, 4, &count));
  CHECK(count == 2 && spans[0].line == 5 && spans[1].line == 13);
  CHECK_STATUS(BREVE_OK, breve_analysis_references(a, symbols[0], NULL, 0, &count));
  CHECK(count == 2);
  CHECK_STATUS(BREVE_ERROR_NOT_FOUND, breve_analysis_name_at(a, "made.tz", 13, 1, &reference));
  CHECK_STATUS(BREVE_ERROR_NOT_FOUND, breve_analysis_name_at(a, "made.tz", 99, 1, &reference));
  CHECK_STATUS(BREVE_ERROR_NOT_FOUND, breve_analysis_name_at(a, "made.tz", 13, 99, &reference));
  CHECK_STATUS(BREVE_ERROR_NOT_FOUND, breve_analysis_name_at(a, "made.tz", 0, 0, &reference));
  CHECK_STATUS(BREVE_ERROR_NOT_FOUND, breve_analysis_name_at(a, "other.tz", 1, 1, &reference));
  CHECK_STATUS(BREVE_ERROR_NOT_FOUND, breve_analysis_references(a, BREVE_NO_SYMBOL, NULL, 0, &count));
  breve_analysis_destroy(a);
  breve_runtime_destroy(runtime);
}

static void completions_fit_their_place(void) {
  breve_runtime* runtime = plain_runtime();
  breve_analysis* a = analyse(runtime, world_text);
  breve_completion items[8];
  size_t count = 0;
  uint32_t typed = 99;
  CHECK_STATUS(BREVE_OK, breve_analysis_completions(a, "made.tz", 13, 12, &typed, items, 8, &count));
  CHECK(count == 1 && typed == 2);
  CHECK_TEXT("fly", items[0].name);
  CHECK_TEXT("Bird", items[0].owner);
  CHECK(items[0].kind == BREVE_NAME_METHOD && items[0].symbol != BREVE_NO_SYMBOL);
  CHECK_STATUS(BREVE_OK, breve_analysis_completions(a, "made.tz", 13, 1, NULL, items, 2, &count));
  CHECK(count > 20);
  const char* text = "(new Bird) fly to (1, 2, 3) wi";
  CHECK_STATUS(BREVE_OK, breve_analysis_statement_completions(a, "Field", text, strlen(text), strlen(text), &typed,
                                                              items, 8, &count));
  CHECK(count == 1 && typed == 2);
  CHECK_TEXT("with-speed", items[0].name);
  CHECK_STATUS(BREVE_OK, breve_analysis_statement_completions(a, NULL, NULL, 0, 0, &typed, NULL, 0, &count));
  CHECK(count > 20 && typed == 0);
  CHECK_STATUS(BREVE_ERROR_NOT_FOUND,
               breve_analysis_statement_completions(a, "Fish", text, 3, 3, &typed, items, 8, &count));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT,
               breve_analysis_statement_completions(a, "Field", text, 3, 4, &typed, items, 8, &count));
  size_t methods[4];
  const char* keyword = NULL;
  CHECK_STATUS(BREVE_OK, breve_analysis_callees(a, "made.tz", 13, 18, methods, 4, &count, &keyword));
  CHECK(count == 1);
  CHECK_TEXT("to", keyword);
  CHECK_STATUS(BREVE_ERROR_NOT_FOUND, breve_analysis_callees(a, "made.tz", 12, 5, methods, 4, &count, &keyword));
  breve_analysis_destroy(a);
  breve_runtime_destroy(runtime);
}

static void the_class_librarys_texts_can_be_read(void) {
  const size_t count = breve_library_module_count();
  bool real = false;
  for (size_t i = 0; i < count; ++i) {
    breve_source module;
    CHECK_STATUS(BREVE_OK, breve_library_module(i, &module));
    CHECK(module.size > 0 && strlen(module.text) == module.size && module.library && !module.loaded);
    if (strcmp(module.name, "Real.tz") == 0) real = strstr(module.text, "Object : Real") != NULL;
  }
  CHECK(real);
  breve_source none;
  CHECK_STATUS(BREVE_ERROR_NOT_FOUND, breve_library_module(count, &none));
}

static bool give_module(void* user, const char* name, const char* from, breve_module* module) {
  breve_runtime* runtime = *(breve_runtime**)user;
  breve_analysis* inner = NULL;
  (void)from;
  CHECK_STATUS(BREVE_ERROR_BUSY, breve_analysis_create(runtime, "inner.tz", "", 0, &inner));
  if (strcmp(name, "made.tz") != 0) return false;
  module->text = world_text;
  module->size = strlen(world_text);
  return true;
}

static void a_module_is_asked_of_the_host_and_one_analysis_is_made_at_a_time(void) {
  breve_runtime* runtime = NULL;
  breve_runtime_config config = breve_runtime_config_default();
  config.user = &runtime;
  config.resolve_module = give_module;
  CHECK_STATUS(BREVE_OK, breve_runtime_create(&config, &runtime));
  breve_analysis* a = NULL;
  CHECK_STATUS(BREVE_ERROR_FILE, breve_analysis_create(runtime, "none.tz", NULL, 0, &a));
  CHECK(a == NULL);
  CHECK_STATUS(BREVE_OK, breve_analysis_create(runtime, "made.tz", NULL, 0, &a));
  breve_source file;
  CHECK_STATUS(BREVE_OK, breve_analysis_file(a, 0, &file));
  CHECK_TEXT("made.tz", file.name);
  CHECK(file.size == strlen(world_text) && !file.library && file.loaded);
  CHECK_STATUS(BREVE_ERROR_NOT_FOUND, breve_analysis_file(a, breve_analysis_file_count(a), &file));
  breve_analysis_destroy(a);
  breve_runtime_destroy(runtime);
}

static void null_arguments_give_an_argument_error_or_nothing(void) {
  breve_runtime* runtime = plain_runtime();
  breve_analysis* a = analyse(runtime, world_text);
  breve_analysis* made = NULL;
  breve_diagnostic diagnostic;
  breve_source source;
  breve_symbol symbol;
  breve_reference reference;
  size_t count;
  uint32_t typed;
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_library_module(0, NULL));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_analysis_create(NULL, "x", "", 0, &made));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_analysis_create(runtime, NULL, "", 0, &made));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_analysis_create(runtime, "x", NULL, 1, &made));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_analysis_create(runtime, "x", "", 0, NULL));
  CHECK_STATUS(BREVE_ERROR_FILE, breve_analysis_create(runtime, "x", NULL, 0, &made));
  breve_analysis_destroy(NULL);
  CHECK(breve_analysis_diagnostic_count(NULL) == 0);
  CHECK(breve_analysis_file_count(NULL) == 0 && breve_analysis_symbol_count(NULL) == 0);
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_analysis_diagnostic(NULL, 0, &diagnostic));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_analysis_diagnostic(a, 0, NULL));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_analysis_file(NULL, 0, &source));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_analysis_file(a, 0, NULL));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_analysis_symbol(NULL, 0, &symbol));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_analysis_symbol(a, 0, NULL));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_analysis_name_at(NULL, "made.tz", 1, 1, &reference));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_analysis_name_at(a, NULL, 1, 1, &reference));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_analysis_name_at(a, "made.tz", 1, 1, NULL));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_analysis_definitions(NULL, "made.tz", 1, 1, NULL, 0, &count));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_analysis_definitions(a, NULL, 1, 1, NULL, 0, &count));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_analysis_definitions(a, "made.tz", 1, 1, NULL, 1, &count));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_analysis_definitions(a, "made.tz", 1, 1, NULL, 0, NULL));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_analysis_references(NULL, 0, NULL, 0, &count));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_analysis_references(a, 0, NULL, 1, &count));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_analysis_references(a, 0, NULL, 0, NULL));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_analysis_callees(NULL, "made.tz", 1, 1, NULL, 0, &count, NULL));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_analysis_callees(a, NULL, 1, 1, NULL, 0, &count, NULL));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_analysis_callees(a, "made.tz", 1, 1, NULL, 1, &count, NULL));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_analysis_callees(a, "made.tz", 1, 1, NULL, 0, NULL, NULL));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_analysis_completions(NULL, "made.tz", 1, 1, &typed, NULL, 0, &count));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_analysis_completions(a, NULL, 1, 1, &typed, NULL, 0, &count));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_analysis_completions(a, "made.tz", 1, 1, &typed, NULL, 1, &count));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_analysis_completions(a, "made.tz", 1, 1, &typed, NULL, 0, NULL));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT,
               breve_analysis_statement_completions(NULL, NULL, "", 0, 0, &typed, NULL, 0, &count));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT,
               breve_analysis_statement_completions(a, NULL, NULL, 1, 0, &typed, NULL, 0, &count));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_analysis_statement_completions(a, NULL, "", 0, 0, &typed, NULL, 0, NULL));
  breve_analysis_destroy(a);
  breve_runtime_destroy(runtime);
}

void analysis_suite(void) {
  RUN(symbols_have_signatures_documentation_and_places);
  RUN(an_analysis_outlives_its_runtime_and_leaves_its_diagnostics_alone);
  RUN(names_at_places_lead_to_their_definitions_and_back);
  RUN(completions_fit_their_place);
  RUN(the_class_librarys_texts_can_be_read);
  RUN(a_module_is_asked_of_the_host_and_one_analysis_is_made_at_a_time);
  RUN(null_arguments_give_an_argument_error_or_nothing);
}
