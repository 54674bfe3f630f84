/* check_main.c - runs the suites; the exit status says whether all tests passed.
 *
 * libcheck reads its settings from the environment: CK_FORK=no runs everything in one process, for
 * a debugger or valgrind; CK_VERBOSITY=verbose lists every test; CK_RUN_CASE=name runs one group.
 * With CASES defined the numbers of the experiments are tested, too; with PAPER the formulas alone.
 */
#define _POSIX_C_SOURCE 200809L
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "check.h"

#ifndef CASES

enum { LIMIT = 80, SHARE = 10 };    /* s  for all of the quick tests, which take 2 to 5; for one */

/* libcheck ends a test that hangs after 4 s. If an error lets hundreds hang, one after the other,
 * that is long: a second process ends the tests after LIMIT. The one in hand, which is then alone,
 * ends after its SHARE. */
static pid_t set_limit(void)
{
    const struct rlimit share = { SHARE, SHARE };
    const pid_t tests = getpid(), watch = fork();

    for (int s = 0; watch == 0 && s < LIMIT; s++) {
        sleep(1);
        if (getppid() != tests)
            _exit(EXIT_SUCCESS);
    }
    if (watch == 0) {
        fprintf(stderr, "The tests took over %d s and were ended; CK_FORK=no has no limit.\n",
                LIMIT);
        kill(tests, SIGKILL);
        _exit(EXIT_SUCCESS);
    }
    setrlimit(RLIMIT_CPU, &share);
    return watch;
}

static void run_tests(SRunner *runner)
{
    const char *forks = getenv("CK_FORK");
    const pid_t watch = forks && strcmp(forks, "no") == 0 ? -1 : set_limit();

    srunner_run_all(runner, CK_ENV);
    if (watch > 0) {
        kill(watch, SIGKILL);
        waitpid(watch, NULL, 0);
    }
}

#else

static void run_tests(SRunner *runner) { srunner_run_all(runner, CK_ENV); }

#endif

void add_case(Suite *s, const char *name, const loop_test e[], int count)
{
    TCase *c = tcase_create(name);

    for (int i = 0; i < count; i++)
        tcase_add_loop_test(c, e[i].test, 0, e[i].times);
    suite_add_tcase(s, c);
}

static Suite *(*const SUITES[])(void) = {
    formulas_suite,
#ifndef PAPER
    elastic_suite, steps_suite, mesh_suite, input_suite,
    detection_suite, corners_suite, entrance_suite, open_close_suite, sliding_suite, joints_suite,
    blocks_suite, repeat_suite,
    solver_suite, coarse_suite,
    beyond_suite, motion_suite, bars_suite, limits_suite, refused_suite,
    theory_suite, equations_suite, run_suite, impact_suite,
#endif
#ifdef CASES
    cases_suite, model_suite, statements_suite, moving_suite, scenes_suite, files_suite,
    pictures_suite,
#endif
};

int main(void)
{
    SRunner *runner = srunner_create(SUITES[0]());

    for (int k = 1; k < COUNT(SUITES); k++)
        srunner_add_suite(runner, SUITES[k]());
    run_tests(runner);
    const int failed = srunner_ntests_failed(runner), run = srunner_ntests_run(runner);
    srunner_free(runner);
    return failed == 0 && run > 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
