/* check.h - what the test suites share: comparing numbers, the suites, an allocator that fails on
 * demand. */
#ifndef BBM_TESTS_CHECK_H
#define BBM_TESTS_CHECK_H

#include <check.h>
#include <limits.h>
#include <math.h>
#include <stdlib.h>

#include "../base/base.h"

#define COUNT(array) ((int)(sizeof (array) / sizeof (array)[0]))

/* `got` differs from `expected` by at most `tolerance` times |size|: the size says what the
 * difference is small against, because zero has no relative error. NaN is near nothing. */
#define ck_near(got, expected, size, tolerance)                                                    \
    do {                                                                                           \
        const double ck_got = (got), ck_expected = (expected), ck_size = (size);                   \
        const double ck_bound = (tolerance) * fabs(ck_size);                                       \
        ck_assert_msg(fabs(ck_got - ck_expected) <= ck_bound,                                      \
                      "%s = %.17g, expected %.17g within %.2g", #got, ck_got, ck_expected,         \
                      ck_bound);                                                                   \
    } while (0)

/* The same against the expected number's own size. */
#define ck_relative(got, expected, tolerance) ck_near(got, expected, expected, tolerance)

/* A call that returns BBM_OK; if not, the model's message is shown. */
#define ck_ok(call, model)                                                                         \
    do {                                                                                           \
        const bbm_status ck_status = (call);                                                       \
        ck_assert_msg(ck_status == BBM_OK, "%s: %s", #call, bbm_message(model));                   \
    } while (0)

/* check_main.c: a group of tests in a suite; a test and how often it is run, with _i = 0, 1, ...; a
 * group of these, as add_case(s, "name", { test, 1 }, { other, 3 }). */
typedef struct { const TTest *test; int times; } loop_test;

TCase *new_case(Suite *s, const char *name);
void add_tests(TCase *c, const loop_test e[], int count);

#define add_case(s, name, ...)                                                                     \
    add_tests(new_case(s, name), (const loop_test[]){ __VA_ARGS__ },                               \
              COUNT(((const loop_test[]){ __VA_ARGS__ })))

/* models.c: a model with all of beyond/. Its test case releases it after the test, with all that
 * are left, if the test has not. */
bbm_model *beyond_model(void);
void release(bbm_model *m);
void release_models(void);

/* systems.c: y = K x in the caller's order. */
void matrix_multiply(bbm_matrix *K, const double *x, double *y);

/* systems.c: solves A x = b by elimination without pivots; A is positive definite, and is lost; x
 * takes the place of b. */
void eliminate(int n, double *A, double *b);

typedef Suite *make_suite(void);

/* Each suite of suites.h. */
#define FORMULAS(name) Suite *name##_suite(void);
#define QUICK FORMULAS
#define LIBRARY FORMULAS
#define PROGRAM FORMULAS
#include "suites.h"
#undef FORMULAS
#undef QUICK
#undef LIBRARY
#undef PROGRAM

/* test_alloc.c: malloc and its kin as the library sees them in the tests. */
#define TEST_ALLOCATIONS_UNLIMITED INT_MAX
extern int test_allocations_left;   /* k >= 0: k calls succeed, then none; -k < 0: call k fails */
extern size_t test_bytes;           /* asked for so far */
void *test_malloc(size_t size);
void *test_calloc(size_t count, size_t size);
void *test_realloc(void *old, size_t size);
void test_free(void *piece);

#endif
