/* Checks of the tests in C: each that fails is printed with its line, and counted. */
#pragma once

#include <lockstone.h>
#include <stdio.h>

static int failures = 0;

static void check(int holds, const char* what, int line) {
  if (holds) return;
  ++failures;
  fprintf(stderr, "line %d: %s\n  last error: %s\n", line, what, lks_last_error());
}

#define CHECK(condition) check((condition) != 0, #condition, __LINE__)
#define OK(call) check((call) == LKS_OK, #call, __LINE__)
#define REFUSED(status, call) check((call) == (status), #call " must be " #status, __LINE__)
