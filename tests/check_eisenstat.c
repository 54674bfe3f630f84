/* check_eisenstat.c - Eisenstat's form of SSOR-PCG against the textbook's. */
#include "check.h"
#include "systems.h"

/* By one iteration they may differ, when rounding decides whether the tolerance is met. */
START_TEST(eisenstat_takes_the_textbook_iterations_to_the_same_solution)
{
    dense_system *s = new_system(_i, 13);
    double D[MOST_6], E[MOST_6];
    bbm_pcg_info textbook, eisenstat;

    for (int k = 0; k < COUNT(OMEGA); k++) {
        bbm_pcg pcg = accurate(OMEGA[k], NULL);
        pcg.tolerance = 1e-10;
        ck_assert_int_eq(bbm_solve(s->K, s->F, D, &pcg, &textbook), BBM_OK);
        pcg.method = &bbm_eisenstat;
        ck_assert_int_eq(bbm_solve(s->K, s->F, E, &pcg, &eisenstat), BBM_OK);
        ck_assert_int_le(abs(eisenstat.iterations - textbook.iterations), 1);
        assert_same(6 * s->n, E, D, 1e-8);
    }
    free_system(s);
}
END_TEST

Suite *eisenstat_suite(void)
{
    Suite *s = suite_create("eisenstat");
    const loop_test e[] = {
        { eisenstat_takes_the_textbook_iterations_to_the_same_solution, PATTERNS },
    };

    add_case(s, "eisenstat", e, COUNT(e));
    return s;
}
