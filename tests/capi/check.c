/* The checks of tests in plain C. */
#include "check.h"

#include <math.h>

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
