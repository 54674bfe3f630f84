/* check_repeat.c - steps with contacts that are done again, that fail, that repeat to the last
 * bit. */
#include <string.h>

#include "check.h"
#include "models.h"

/* --------------------------------------------------------- steps that are done again, that fail */

/* Steps far too long make the iteration fail now and then. Then the step is done in parts; when
 * those are two halves, the result must be that of a model that takes two half steps and has never
 * tried the long one. */
START_TEST(a_step_done_again_in_halves_is_the_two_half_steps_to_the_last_bit)
{
    int halves = 0;

    for (unsigned seed = 1; seed < 20 && halves < 2; seed++) {
        bbm_model *m = pile(seed, 0), *n = pile(seed, 0);
        m->info.cuts = 0;
        for (int i = 0; i < 20 && m->info.cuts < 2; i++) {
            m->par.dt = n->par.dt = 0.1;
            ck_ok(bbm_step(m), m);
            n->par.dt /= 1 + m->info.cuts;
            for (int k = 0; k <= m->info.cuts && m->info.cuts < 2; k++) {
                ck_ok(bbm_step(n), n);
                ck_assert_int_eq(n->info.cuts, 0);
            }
            ck_assert(m->info.cuts > 1 || same_state(m, n));
            ck_near(m->info.t, 0.1 * m->info.step, 1, ROUNDING);
            halves += m->info.cuts == 1;
        }
        release(m);
        release(n);
    }
    ck_assert(halves >= 2);
}
END_TEST

/* The solver is given too few iterations at each step of a pile that has come to rest; then the run
 * goes on as if nothing had been. */
START_TEST(a_step_that_fails_leaves_the_contacts_and_all_else_as_they_were)
{
    bbm_model *m = pile(4, 0), *n = pile(4, 0);
    const int iterations = m->par.pcg.iterations;

    settle(m, 200);
    settle(n, 200);
    ck_assert_int_gt(m->info.contacts, 4);
    for (int i = 0; i < 10; i++) {
        m->par.pcg.iterations = 1;
        ck_assert_int_eq(bbm_step(m), BBM_NOT_CONVERGED);
        ck_assert_msg(strstr(bbm_message(m), ", iteration 1,"), "%s", bbm_message(m));
        ck_assert_int_eq(m->info.step, n->info.step);
        ck_assert(same_state(m, n));
        m->par.pcg.iterations = iterations;
        ck_ok(bbm_step(m), m);
        ck_ok(bbm_step(n), n);
        ck_assert(same_state(m, n));
    }
}
END_TEST

/* ---------------------------------------------------------------------------- steps that repeat */

/* In reversed order: the same but for rounding and the solver's tolerance, which hits enlarge. */
START_TEST(a_pile_falls_the_same_way_whichever_block_comes_first)
{
    bbm_model *m = pile(2, 0), *n = pile(2, 1);
    int hits = 0;

    for (int i = 0; i < 45; i++) {
        run_steps(m, 1);
        run_steps(n, 1);
        for (int b = 0; b < PILE; b++)
            for (int a = 0; a < 2; a++)
                ck_near(m->element[b + 1].sum[a], n->element[PILE - 1 - b].sum[a], 1, 1e-6);
        ck_assert_int_eq(m->info.contacts, n->info.contacts);
        hits += m->info.contacts;
    }
    ck_assert_int_gt(hits, 40);
}
END_TEST

/* Puts a model back to where another one stands; its scratch memory stays as it is. */
static void put_back(bbm_model *m, const bbm_model *start)
{
    memcpy(m->vertex, start->vertex, (size_t)m->vertices * sizeof *m->vertex);
    memcpy(m->element, start->element, (size_t)m->elements * sizeof *m->element);
    m->info = start->info;
}

/* One model has fallen before, and its pile is lifted again; a step in the air ends its contacts.
 * From there both fall. */
START_TEST(a_step_depends_on_the_state_and_not_on_what_is_left_in_memory)
{
    bbm_model *used = pile(2, 0), *fresh = pile(2, 0), *start = pile(2, 0);
    int hits = 0;

    for (int b = 0; b < PILE; b++) {
        const int e = b + 1;
        for (int v = start->element[e].first;
             v < start->element[e].first + start->element[e].n; v++) {
            start->vertex[v].x += 0.5 * start->element[e].x;
            start->vertex[v].u += 0.5 * start->element[e].x;
            start->vertex[v].y += 0.5 * start->element[e].y + 0.1;
            start->vertex[v].v += 0.5 * start->element[e].y + 0.1;
        }
        set_velocity(start, e, -2 * start->element[e].x, -3 * start->element[e].y);
    }
    run_steps(used, 60);
    put_back(used, start);
    put_back(fresh, start);
    run_steps(used, 2);
    run_steps(fresh, 2);
    ck_assert_int_eq(used->contacts, 0);
    for (int i = 0; i < 60; i++) {
        run_steps(used, 1);
        run_steps(fresh, 1);
        ck_assert(same_state(used, fresh));
        hits += used->info.contacts;
    }
    ck_assert_int_gt(hits, 60);
}
END_TEST

/* Each call that fails leaves a model that is good for another try: only the step is lost. All
 * calls from the k-th on fail, or that one alone; then also those of the jump after a hit. */
START_TEST(whichever_allocation_fails_contacts_leave_the_model_fit_to_go_on)
{
    bbm_model *reference = pile(5, 0);
    bbm_status status = BBM_NO_MEMORY;
    int k = 0;

    reference->beyond->restitution = _i ? 0.3 : -1;
    ck_ok(fall(reference), reference);
    for (; status != BBM_OK; k += k < 60 ? 1 : 7) {
        bbm_model *m = pile(5, 0);
        m->beyond->restitution = reference->beyond->restitution;
        test_allocations_left = _i ? -k - 1 : k;
        status = fall(m);
        test_allocations_left = TEST_ALLOCATIONS_UNLIMITED;
        ck_assert(status == BBM_NO_MEMORY || status == BBM_OK);
        run_steps(m, 40 - m->info.step);
        ck_assert(same_state(m, reference));
        release(m);
    }
    ck_assert(k > 60);
}
END_TEST

/* Contacts and broken bonds of a run would be forgotten. */
START_TEST(a_model_that_has_made_a_step_is_not_prepared_again)
{
    bbm_model *m = pile(2, 0);

    run_steps(m, 1);
    ck_assert_int_eq(bbm_prepare(m), BBM_BAD_PARAMETER);
    run_steps(m, 1);                            /* it goes on */
    /* nor does it take more, and goes on for all that */
    ck_assert_int_eq(bbm_add_node(m, 9, 9, NULL), BBM_BAD_PARAMETER);
    ck_assert_int_eq(bbm_add_element(m, 9, 0, 3, (int[]){ 0, 1, 2 }, NULL), BBM_BAD_PARAMETER);
    ck_assert_int_eq(bbm_add_material(m, &m->material[0], NULL), BBM_BAD_PARAMETER);
    ck_assert_int_eq(bbm_add_line_load(m, 0, 1, 0, 1), BBM_BAD_PARAMETER);
    run_steps(m, 1);
    release(m);
}
END_TEST

/* A first step that fails is none: the body gets one more element, and falls. */
START_TEST(a_model_whose_first_step_has_failed_is_prepared_again)
{
    bbm_model *m = new_blocks();
    const int iterations = m->par.pcg.iterations;

    add_rectangle(m, 0, ROCK, (rectangle){ .w = 2, .h = 1, .nx = 2 });
    ck_ok(bbm_prepare(m), m);
    m->par.gravity[0] = 1;
    m->element[0].V[0] = m->par.pcg.iterations = 1;
    ck_assert_int_eq(bbm_step(m), BBM_NOT_CONVERGED);
    m->element[0].V[0] = 0;
    m->par.pcg.iterations = iterations;
    ck_ok(bbm_add_node(m, 3, 0, NULL), m);
    ck_ok(bbm_add_node(m, 3, 1, NULL), m);
    ck_ok(bbm_add_element(m, 0, ROCK, 4, (int[]){ 2, 6, 7, 5 }, NULL), m);
    ck_ok(bbm_prepare(m), m);
    ck_ok(bbm_step(m), m);
    for (int e = 0; e < 3; e++)
        ck_relative(m->element[e].V[1], m->par.gravity[1] * m->par.dt, 1e-9);   /* of the solver */
    release(m);
}
END_TEST

enum { CELLS = 32 * 8 };

/* Solves a cantilever of 32 x 8 quadrilaterals on two levels; with a stone that is held 10 km away,
 * if there is one. Its D, and the iterations that it took. */
static int solve_beside(int stone, double D[6 * CELLS])
{
    grid g = { .lx = 4, .ly = 1, .nx = 32, .ny = 8 };
    bbm_model *m = new_model(&SOLID);

    add_grid(m, &g, 0);
    for (int j = 0; j <= g.ny; j++)
        ck_ok(bbm_fix_node(m, node_at(&g, 0, j), BBM_XY, 0, 0), m);
    ck_ok(bbm_add_load(m, node_at(&g, g.nx, g.ny), 0, -1), m);
    if (stone)
        add_rectangle(m, 1, 0, (rectangle){ 8e3, 6e3, 1, 1, .fixed = 1 });
    run_steps(m, 1);
    ck_assert_int_eq(m->elements, CELLS + stone);
    memcpy(D, m->D, 6 * CELLS * sizeof *D);
    return m->info.pcg.iterations;
}

/* Two levels take 13 iterations, one alone 900. */
START_TEST(a_stone_far_away_changes_no_digit)
{
    double alone[6 * CELLS], beside[6 * CELLS];
    const int iterations = solve_beside(0, alone);

    ck_assert_int_lt(iterations, 100);
    ck_assert_int_eq(solve_beside(1, beside), iterations);
    ck_assert(memcmp(alone, beside, sizeof alone) == 0);
}
END_TEST

Suite *repeat_suite(void)
{
    Suite *s = suite_create("repeat");

    add_case(s, "again",
        { a_step_done_again_in_halves_is_the_two_half_steps_to_the_last_bit, 1 },
        { a_step_that_fails_leaves_the_contacts_and_all_else_as_they_were, 1 });
    add_case(s, "repeat",
        { a_pile_falls_the_same_way_whichever_block_comes_first, 1 },
        { a_step_depends_on_the_state_and_not_on_what_is_left_in_memory, 1 },
        { a_stone_far_away_changes_no_digit, 1 },
        { whichever_allocation_fails_contacts_leave_the_model_fit_to_go_on, 2 },
        { a_model_that_has_made_a_step_is_not_prepared_again, 1 },
        { a_model_whose_first_step_has_failed_is_prepared_again, 1 });
    return s;
}
