/* A tiny frame for tests in plain C: CHECK counts failures, RUN names what ran. A test's name is its claim. */
#ifndef BREVE_TESTS_CAPI_CHECK_H
#define BREVE_TESTS_CAPI_CHECK_H

#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include "breve/breve.h"

extern int failures;

#define CHECK(condition) check_that((condition), #condition, __FILE__, __LINE__)
#define CHECK_STATUS(wanted, call) check_status((wanted), (call), #call, __FILE__, __LINE__)
#define CHECK_TEXT(wanted, text) check_text((wanted), (text), #text, __FILE__, __LINE__)
#define CHECK_NEAR(wanted, number, tolerance) check_near((wanted), (number), (tolerance), #number, __FILE__, __LINE__)
#define RUN(test)          \
  do {                     \
    printf("%s\n", #test); \
    fflush(stdout);        \
    test();                \
  } while (0)

bool check_that(bool condition, const char* what, const char* file, int line);
bool check_status(breve_status wanted, breve_status status, const char* what, const char* file, int line);
bool check_text(const char* wanted, const char* text, const char* what, const char* file, int line);
bool check_near(double wanted, double number, double tolerance, const char* what, const char* file, int line);

#endif
