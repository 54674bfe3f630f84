/* check_main.c - runs the suites; the exit status says whether all tests passed.
 *
 * libcheck reads its settings from the environment: CK_FORK=no runs everything in one process, for
 * a debugger or valgrind; CK_VERBOSITY=verbose lists every test; CK_RUN_CASE=name runs one group.
 * With CASES defined the numbers of the experiments are tested, too.
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

int main(void)
{
    SRunner *runner = srunner_create(solver_suite());

    srunner_add_suite(runner, bbm_suite());
    srunner_add_suite(runner, contact_suite());
    srunner_add_suite(runner, beyond_suite());
    srunner_add_suite(runner, motion_suite());
    srunner_add_suite(runner, bars_suite());
    srunner_add_suite(runner, theory_suite());
    srunner_add_suite(runner, equations_suite());
    srunner_add_suite(runner, limits_suite());
    srunner_add_suite(runner, refused_suite());
#ifdef CASES
    srunner_add_suite(runner, cases_suite());
    srunner_add_suite(runner, model_suite());
    srunner_add_suite(runner, scenes_suite());
    srunner_add_suite(runner, files_suite());
#endif
    run_tests(runner);
    const int failed = srunner_ntests_failed(runner), run = srunner_ntests_run(runner);
    srunner_free(runner);
    return failed == 0 && run > 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
