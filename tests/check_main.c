/* check_main.c - runs the suites; the exit status says whether all tests passed.
 *
 * libcheck reads its settings from the environment: CK_FORK=no runs everything in one process, for
 * a debugger or valgrind; CK_VERBOSITY=verbose lists every test; CK_RUN_CASE=name runs one group.
 * With CASES defined the programs are tested, too, and the argument `library` or `programs` runs that
 * part alone; with PAPER the formulas alone are tested.
 */
#define _POSIX_C_SOURCE 200809L
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

#include "check.h"

/* s of the processor, which other work on the machine does not change: for a test, or a program that
 * it runs, and for all of them; the quick ones take 60. Tests that hang end after their SHARE, and
 * when hundreds hang, one after the other, all end after LIMIT. */
#ifdef CASES
enum { SHARE = 60, LIMIT = 1200 };
#else
enum { SHARE = 4, LIMIT = 240 };
#endif

/* Before each group, in the process that runs them all. */
static void check_limit(void)
{
    struct rusage tests;

    getrusage(RUSAGE_CHILDREN, &tests);
    if (tests.ru_utime.tv_sec > LIMIT) {
        fprintf(stderr, "The tests took over %d s of the processor and were ended; CK_FORK=no has no "
                "limit.\n", LIMIT);
        exit(EXIT_FAILURE);
    }
}

TCase *new_case(Suite *s, const char *name)
{
    TCase *c = tcase_create(name);

    tcase_add_unchecked_fixture(c, check_limit, NULL);
#ifndef PAPER
    tcase_add_checked_fixture(c, NULL, release_models);
#endif
    suite_add_tcase(s, c);
    return c;
}

void add_tests(TCase *c, const loop_test e[], int count)
{
    for (int i = 0; i < count; i++)
        tcase_add_loop_test(c, e[i].test, 0, e[i].times);
}

/* Of suites.h those that this program has: with PAPER the formulas alone, with CASES all. */
#ifdef PAPER
#define QUICK(name)
#else
#define QUICK FORMULAS
#endif
#ifdef CASES
#define LIBRARY FORMULAS
#define PROGRAM(name) { name##_suite, 1 },
#else
#define LIBRARY(name)
#define PROGRAM(name)
#endif
#define FORMULAS(name) { name##_suite, 0 },

static const struct { make_suite *make; int runs_programs; } SUITES[] = {
#include "suites.h"
};

/* Whether a suite belongs to the part `library`, `programs` or `all`. */
static int belongs(int suite, const char *part)
{
    return strcmp(part, "all") == 0 || SUITES[suite].runs_programs == (strcmp(part, "library") != 0);
}

/* libcheck's limits are by the clock, on a machine that may have other work to do: they are for what
 * waits for ever. */
int main(int count, char **argument)
{
    const char *part = count > 1 ? argument[1] : "all";
    const char *forks = getenv("CK_FORK");

    setenv("CK_DEFAULT_TIMEOUT", "60", 0);
    setenv("CK_TIMEOUT_MULTIPLIER", "10", 0);
    SRunner *runner = srunner_create(NULL);

    for (int k = 0; k < COUNT(SUITES); k++)
        if (belongs(k, part))
            srunner_add_suite(runner, SUITES[k].make());
    if (!forks || strcmp(forks, "no") != 0)
        setrlimit(RLIMIT_CPU, &(struct rlimit){ SHARE, SHARE });
    srunner_run_all(runner, CK_ENV);
    const int failed = srunner_ntests_failed(runner), run = srunner_ntests_run(runner);
    srunner_free(runner);
    return failed == 0 && run > 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
