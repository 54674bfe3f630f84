/* check_main.c - runs the suites; the exit status says whether all tests passed.
 *
 * libcheck reads its settings from the environment: CK_FORK=no runs everything in one process, for a debugger or
 * valgrind; CK_VERBOSITY=verbose lists every test; CK_RUN_CASE=name runs one group. With CASES defined the numbers of
 * the experiments are tested, too.
 */
#include <stdlib.h>

#include "check.h"

int main(void)
{
    SRunner *runner = srunner_create(solver_suite());

    srunner_add_suite(runner, bbm_suite());
    srunner_add_suite(runner, contact_suite());
    srunner_add_suite(runner, beyond_suite());
    srunner_add_suite(runner, bars_suite());
    srunner_add_suite(runner, theory_suite());
    srunner_add_suite(runner, equations_suite());
#ifdef CASES
    srunner_add_suite(runner, cases_suite());
    srunner_add_suite(runner, model_suite());
#endif
    srunner_run_all(runner, CK_ENV);
    const int failed = srunner_ntests_failed(runner), run = srunner_ntests_run(runner);
    srunner_free(runner);
    return failed == 0 && run > 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
