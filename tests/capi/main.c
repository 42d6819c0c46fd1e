/* Runs the suite that is named on the command line. */
#include <math.h>

#include "check.h"

int failures = 0;

bool check_that(bool condition, const char* what, const char* file, int line) {
  if (!condition) {
    ++failures;
    printf("%s:%d: not so: %s\n", file, line, what);
  }
  return condition;
}

bool check_status(breve_status wanted, breve_status status, const char* what, const char* file, int line) {
  if (wanted != status) {
    ++failures;
    printf("%s:%d: %s and not %s: %s\n", file, line, breve_status_name(status), breve_status_name(wanted), what);
  }
  return wanted == status;
}

bool check_text(const char* wanted, const char* text, const char* what, const char* file, int line) {
  const bool same = text && strcmp(wanted, text) == 0;
  if (!same) {
    ++failures;
    printf("%s:%d: \"%s\" and not \"%s\": %s\n", file, line, text ? text : "(NULL)", wanted, what);
  }
  return same;
}

bool check_near(double wanted, double number, double tolerance, const char* what, const char* file, int line) {
  const bool near = fabs(wanted - number) <= tolerance;
  if (!near) {
    ++failures;
    printf("%s:%d: %.17g and not %.17g: %s\n", file, line, number, wanted, what);
  }
  return near;
}

void analysis_suite(void);
void budget_suite(void);
void calls_suite(void);
void config_suite(void);
void errors_suite(void);
void evaluate_suite(void);
void physics_budget_suite(void);
void files_suite(void);
void images_suite(void);
void input_suite(void);
void moments_suite(void);
void nulls_suite(void);
void objects_suite(void);
void profile_suite(void);
void program_suite(void);
void reentry_suite(void);
void reentry_all_suite(void);
void reload_suite(void);
void snapshot_suite(void);
void flat_suite(void);
void grids_suite(void);
void solid_suite(void);
void stepping_suite(void);
void threads_suite(void);
void values_suite(void);

static const struct {
  const char* name;
  void (*run)(void);
} suites[] = {
    /* clang-format off */
    {"analysis", analysis_suite},
    {"budget", budget_suite},
    {"calls", calls_suite},
    {"config", config_suite},
    {"errors", errors_suite},
    {"evaluate", evaluate_suite},
    {"physics_budget", physics_budget_suite},
    {"files", files_suite},
    {"images", images_suite},
    {"input", input_suite},
    {"moments", moments_suite},
    {"nulls", nulls_suite},
    {"objects", objects_suite},
    {"profile", profile_suite},
    {"program", program_suite},
    {"reentry", reentry_suite},
    {"reentry_all", reentry_all_suite},
    {"reload", reload_suite},
    {"snapshot", snapshot_suite},
    {"flat", flat_suite},
    {"grids", grids_suite},
    {"solid", solid_suite},
    {"stepping", stepping_suite},
    {"threads", threads_suite},
    {"values", values_suite},
    /* clang-format on */
};

int main(int argc, char** argv) {
  int ran = 0;
  for (size_t i = 0; i < sizeof suites / sizeof *suites; ++i) {
    if (argc > 1 && strcmp(argv[1], suites[i].name) != 0) continue;
    suites[i].run();
    ++ran;
  }
  if (ran == 0) printf("there is no such suite\n");
  if (failures != 0) printf("%d checks failed\n", failures);
  return ran == 0 || failures != 0;
}
