/* check_open_close.c - section 3.7: the open-close iteration, what a step foresees, the vectors of
 * the step. */
#include <string.h>

#include "check.h"
#include "models.h"
#include "rock.h"

/* --------------------------------------------------------------------- the open-close iteration */

/* A block on a table, at the start of a step. */
static bbm_model *block_on_table(double friction)
{
    bbm_model *m = new_blocks();

    m->par.friction = friction;
    add_table(m, 0);
    add_rectangle(m, 1, ROCK, (rectangle){ .x = 0, .y = 0, .w = 1, .h = 1 });
    start_step(m, &(int){ 0 });
    return m;
}

/* Solutions of the test's making: the block moves by (u, v), and by (u, w) in every second pass.
 * The passes that the open-close iteration makes of it. */
static int feed(bbm_model *m, double u, double v, double w, bbm_pass *pass)
{
    int n = 0;

    memset(m->D, 0, 6 * (size_t)m->elements * sizeof *m->D);
    for (*pass = BBM_PASS_AGAIN; *pass == BBM_PASS_AGAIN && n < 100000; n++) {
        m->D[6] = u;
        m->D[7] = n % 2 ? w : v;
        *pass = bbm_open_close(m);
    }
    ck_assert_msg(m->info.passes == n, "info.passes is %d after %d calls", m->info.passes, n);
    return n;
}

static void expect_end(int n, int expected, bbm_pass pass, bbm_pass end)
{
    ck_assert_msg(n == expected && pass == end,
                  "%d passes, the last says %d; expected %d, %d (0 done, 1 again, 3 give up)", n, pass, expected, end);
}

/* In and out of the table, without friction: 30 passes may change states. With friction: the
 * contacts close, slide at once, and find a normal force that is never the one before: 100 passes
 * may look for it. */
START_TEST(solutions_that_never_agree_make_the_iteration_give_up)
{
    bbm_model *m = block_on_table(_i ? 30 : 0);
    bbm_pass pass;

    const int n = _i ? feed(m, 1e-3, -1e-4, -2e-4, &pass) : feed(m, 0, -1e-4, 1e-4, &pass);
    expect_end(n, _i ? 1 + 101 : 31, pass, BBM_PASS_GIVE_UP);
}
END_TEST

/* 1e-4 m into the table: closes, stays closed. With a slip of 1 mm: closes, slides, with the N that
 * it has. */
START_TEST(a_solution_that_agrees_ends_the_iteration)
{
    bbm_model *m = block_on_table(30);
    bbm_pass pass;
    const double u = _i == 0 ? 0 : _i == 1 ? 1e-3 : -1e-3;

    const int n = feed(m, u, -1e-4, -1e-4, &pass);
    expect_end(n, _i ? 3 : 2, pass, BBM_PASS_DONE);
    ck_assert_msg(m->scratch->friction_passes == 0,
                  "friction_passes is %d after states were judged",
                  m->scratch->friction_passes);
    for (int k = 0; k < m->scratch->contacts; k++) {
        const bbm_contact *c = &m->scratch->contact[k];     /* AGREE is 1e-9 of N */
        ck_assert_msg(c->trial.force_tolerance >= 0.9e-9 * c->N,
                      "contact %d has the force tolerance %g", k, c->trial.force_tolerance);
    }
    bbm_store_contacts(m);
    ck_assert_int_eq(m->info.contacts, 2);
    ck_near(m->info.penetration, 1e-4, 1e-4, ROUNDING);
    for (int k = 0; k < m->contacts; k++)
        if (m->contact[k].state != BBM_OPEN) {
            ck_assert_int_eq(m->contact[k].state, _i ? BBM_SLIDE : BBM_LOCK);
            ck_relative(m->contact[k].N, 1e-4 * m->par.p_n, ROUNDING);
            ck_near(m->contact[k].T, _i == 0 ? 0 : copysign(1e-4 * m->par.p_n * tan(PI / 6), u),
                    1e5, ROUNDING);
        }
}
END_TEST

/* Open, then sliding one way or the other: sets of states that differ have numbers that differ. */
START_TEST(other_states_are_another_number)
{
    bbm_model *m[2];
    bbm_pass pass;

    for (int k = 0; k < 2; k++) {
        m[k] = block_on_table(30);
        feed(m[k], k ? -1e-3 : 1e-3, -1e-4, -1e-4, &pass);
        const double sign = m[k]->scratch->contact[0].sign;
        ck_assert_msg(sign == (k ? -1 : 1), "slides with the sign %g", sign);
        ck_assert_msg(m[k]->scratch->seen[0] != m[k]->scratch->seen[1],
                      "OPEN and SLIDE are noted as the same states");
    }
    ck_assert_msg(m[0]->scratch->seen[1] != m[1]->scratch->seen[1],
                  "both ways to slide are noted as the same states");
}
END_TEST

/* Which way a contact has slid before does not count while it is open or locked. */
START_TEST(states_are_the_same_number_whatever_was_before)
{
    bbm_model *m[2];
    bbm_pass pass;

    for (int k = 0; k < 2; k++) {
        m[k] = block_on_table(30);
        m[k]->scratch->contact[0].sign = k ? -1 : 1;
        feed(m[k], 0, -1e-4, -1e-4, &pass);
        ck_assert(m[k]->scratch->seen[_i] == m[0]->scratch->seen[_i]);
    }
}
END_TEST

/* The table and the block on it stretch alike. Wherever a corner closes, it has not slipped. */
START_TEST(what_closes_on_an_edge_that_stretches_has_not_slipped)
{
    bbm_model *m = block_on_table(1);

    m->D[3] = m->D[9] = _i ? 1e-3 : -1e-3;
    m->D[6] = m->D[3] * (m->element[1].x - m->element[0].x);
    m->D[7] = -1e-4;
    ck_assert_int_eq(bbm_open_close(m), BBM_PASS_AGAIN);
    for (int k = 0; k < m->scratch->contacts; k++)
        ck_assert_int_eq(m->scratch->contact[k].state, BBM_LOCK);
    ck_assert_int_eq(m->scratch->contacts, 2);
}
END_TEST

/* Three looks at a block: it comes down on the table; turns there by 0.01 rad, so that the vectors
 * of the step are renewed and no state changes; and is lifted off. That is no cycle, so both
 * contacts open at once. */
START_TEST(a_pass_that_renews_the_vectors_is_no_cycle)
{
    bbm_model *m = block_on_table(30);
    bbm_pass pass;

    for (int k = 0; k < 3; k++) {
        m->D[7] = k < 2 ? -0.01 : 0.01;
        m->D[8] = k == 1 ? 0.01 : 0;
        pass = bbm_open_close(m);
        ck_assert_msg(pass == BBM_PASS_AGAIN, "look %d ends with %d, expected 1, again", k, pass);
    }
    bbm_store_contacts(m);
    ck_assert_msg(m->info.contacts == 0, "%d contacts are left", m->info.contacts);
}
END_TEST

/* In and out of the table and in again: when both are open for a second time, at the pass with number
 * 2, the iteration cycles, and one contact changes its state in each pass before number 4: one
 * closes, and slides, also with friction. Without it then the other one closes, and both open, as both
 * want to. */
START_TEST(a_cycle_is_broken_one_by_one_for_as_many_passes_again)
{
    const double v[] = { -0.01, 0.01, -0.01, -0.01, 0.01 };
    const int closed[] = { 2, 0, 1, 2, 0 };
    bbm_model *m = block_on_table(_i ? 30 : 0);

    for (int k = 0; k < (_i ? 3 : COUNT(v)); k++) {
        int n, count = 0, slides = 0;
        m->D[7] = v[k];
        (void)bbm_open_close(m);
        const bbm_contact *c = list_contacts(m, &n);
        for (int q = 0; q < n; q++) {
            count += c[q].state != BBM_OPEN;
            slides += c[q].state == BBM_SLIDE;
        }
        ck_assert_int_eq(count, closed[k]);
        ck_assert(k != 2 || slides == 1);
    }
}
END_TEST

/* Where one contact changes in a pass it is the deeper one, whichever comes first in the list: the
 * block comes down turned to one side or the other. */
START_TEST(the_contact_that_fits_worst_changes_first)
{
    bbm_model *m = block_on_table(30);
    int n, closed = 0;

    m->scratch->one_until = 1;
    m->D[7] = -1e-2;
    m->D[8] = _i ? 1e-3 : -1e-3;
    (void)bbm_open_close(m);
    const bbm_contact *c = list_contacts(m, &n);
    for (int k = 0; k < n; k++) {
        closed += c[k].state != BBM_OPEN;
        for (int q = 0; q < n && c[k].state != BBM_OPEN; q++)
            ck_assert(c[k].d_n <= c[q].d_n);
    }
    ck_assert_int_eq(closed, 1);
}
END_TEST

/* The block comes 0.1 mm into the table and along it. Its springs would be on the cone of friction
 * at p_s u = tan(30) p_n v: below that the contacts start as locked, above as sliding. */
START_TEST(a_contact_that_closes_outside_the_cone_of_friction_slides)
{
    bbm_model *m = block_on_table(30);
    int n;

    m->D[7] = -1e-4;
    m->D[6] = (_i % 2 ? 1 : -1) * (_i < 2 ? 0.99 : 1.01)
            * 1e-4 * tan(PI / 6) * m->par.p_n / m->par.p_s;
    (void)bbm_open_close(m);
    const bbm_contact *c = list_contacts(m, &n);
    for (int k = 0; k < n; k++) {
        ck_assert_int_eq(c[k].state, _i < 2 ? BBM_LOCK : BBM_SLIDE);
        ck_assert(_i < 2 || c[k].sign * m->D[6] > 0);
    }
}
END_TEST

/* A locked block is lifted by 0.1 mm and moved along. With less shear than pressure of that size
 * could hold it comes off; with more it first slides, and comes off in the next pass. */
START_TEST(a_contact_that_its_shear_spring_pulls_open_slides_first)
{
    bbm_model *m = block_on_table(30);
    int n;

    const double u = (_i ? 1.01 : 0.99) * 1e-4 * tan(PI / 6) * m->par.p_n / m->par.p_s;
    for (int k = 0; k < 3; k++) {
        m->D[6] = k ? u : 0;
        m->D[7] = k ? 1e-4 : -1e-4;
        (void)bbm_open_close(m);
        const bbm_contact *c = list_contacts(m, &n);
        for (int q = 0; q < n; q++)
            ck_assert_int_eq(c[q].state, k == 0 ? BBM_LOCK : k == 1 && _i ? BBM_SLIDE : BBM_OPEN);
    }
}
END_TEST

/* Twenty piles of polygons that fall or are thrown about, 60 steps each: none fails, hardly any is
 * cut, and most settle in few passes, 3.6 in the mean. */
START_TEST(piles_settle_in_few_passes)
{
    int passes = 0, cuts = 0;

    for (unsigned seed = 1; seed <= 20; seed++) {
        bbm_model *m = pile(seed, 0);
        for (int b = 0; b < PILE; b++) {
            set_velocity(m, b + 1, seed % 2 ? 3.0 * (b % 3 - 1) : 0, seed % 2 ? -4 : 0);
            m->element[b + 1].V[2] = seed % 2 ? 6 - 12 * (b % 2) : 0;
        }
        for (int i = 0; i < 60; i++) {
            run_steps(m, 1);
            passes += m->info.passes;
            cuts += m->info.cuts;
        }
        release(m);
    }
    ck_assert_msg(passes < 5 * 20 * 60 && cuts < 6, "%d passes, %d cuts", passes, cuts);
}
END_TEST

/* A block twice as high as broad on 45 degrees slides without turning when tan(phi) < 1/2. Just
 * below, an error of 1 in N changes the next N by tan(phi) h/(2 b) = 0.45; under a block in six
 * pieces seven forces depend on each other. In the matrix the right ones are those of the first
 * solution, and one more puts the vectors of the step right. Not in the first steps, while the block
 * bounces on its springs and states change. As loads they are found in the end, too. */
START_TEST(friction_in_the_matrix_takes_no_passes)
{
    const int pieces = _i % 2, loads = _i / 2;
    const double slope = pieces ? 30 : 45;
    bbm_model *m = new_blocks();
    double turned = 0;
    int most = 0;

    m->par.friction = pieces ? 20 : 24;
    add_rectangle(m, 0, BASE, (rectangle){ -12, -1, 16, 1, slope, .fixed = 1 });
    const int e = add_rectangle(m, 1, ROCK, (rectangle){ 0, 0, pieces ? 3 : 1, pieces ? 1 : 2, slope,
                                                         .nx = pieces ? 6 : 1 });
    if (loads)
        m->hook->friction = NULL;
    for (int i = 0; i < 30; i++) {
        run_steps(m, 1);
        turned += m->element[e].D[2];
        ck_assert_int_eq(m->info.contacts, pieces ? 7 : 2);
        most = i >= 5 && m->info.passes > most ? m->info.passes : most;
    }
    ck_near(turned, 0, 1, 1e-4);
    ck_assert_msg(loads ? most > 2 : most <= 2, "%d passes", most);
}
END_TEST

/* A block that has settled on a base takes one solution a step, in statics two more for multipliers. */
START_TEST(multipliers_take_solutions_in_statics_alone)
{
    bbm_model *m = new_blocks();

    m->par.friction = 30;
    add_rectangle(m, 0, BASE, (rectangle){ -2, -1, 5, 1, 0, .fixed = 1 });
    add_rectangle(m, 1, ROCK, (rectangle){ 0, 0, 1, 1, 0, .fixed = 0 });
    m->par.dt = _i ? INFINITY : m->par.dt;
    m->beyond->multiplier_rounds = 2;
    run_steps(m, 30);
    ck_assert_int_eq(m->info.passes, _i ? 3 : 1);
}
END_TEST

/* A slope whose columns lean on each other while they slide: 10 solutions a step are the promise,
 * friction as the paper's load takes 210. Two blocks on an incline: one, but in the first steps. */
static const struct { int scene; double most; } FEW[] = {
    { ROCK_SLOPE, 10 }, { ROCK_INCLINE, 1.1 },
};

START_TEST(blocks_that_slide_take_few_solutions_a_step)
{
    const rock_scene *s = &rock[FEW[_i].scene];
    bbm_model *m = s->make();
    int solutions = 0;

    for (int i = 0; i < s->steps; i++) {
        run_steps(m, 1);
        solutions += m->info.passes;
    }
    ck_assert_msg(solutions <= FEW[_i].most * s->steps, "%s: %d solutions in %d steps", s->name,
                  solutions, s->steps);
    release(m);
}
END_TEST

/* A glued pair of blocks that nothing loads has settled at the first look, though all forces are
 * zero. */
START_TEST(blocks_without_any_force_settle_at_once)
{
    bbm_model *m = weightless_blocks();

    m->beyond->cohesion = m->beyond->tension = 1e5;
    for (int k = 0; k < 2; k++)
        add_rectangle(m, k, ROCK, (rectangle){ .x = 0, .y = k, .w = 1, .h = 1 });
    run_steps(m, 1);
    ck_assert_int_eq(m->info.contacts, 2);
    ck_assert_int_eq(m->info.passes, 1);
}
END_TEST

/* Four blocks in a row, turned, or two with strength. Nothing loads them, and what moves them is rounding: states that
 * fit and an energy that is kept to 1e-5 would ask for more digits than there are. */
START_TEST(blocks_at_rest_without_any_force_run_turned_by_any_angle)
{
    bbm_model *m = weightless_blocks();

    m->material[ROCK].E = 1e10;
    m->par.dt = 0.005;
    m->par.friction = 30;
    set_springs(m, 1e10, 4e9);
    m->beyond->cohesion = m->beyond->tension = _i % 2 * 1e5;
    for (int k = 0; k < (_i % 2 ? 2 : 4); k++)
        add_rectangle(m, k, ROCK, (rectangle){ 0.1 * k, 0, 0.1, 0.1, .angle = 7 * (_i / 2) });
    run_steps(m, 100);
    ck_near(m->vertex[0].u, 0, 0.1, ROUNDING);
    ck_near(m->beyond->breach, 0, 1, BBM_BALANCED);                     /* a warning tells of more */
}
END_TEST

/* Springs so stiff that the last bit of a coordinate is worth more than the weight, so that
 * friction and normal force cannot agree in a step of any size: it is halved twelve times, to dt/4096,
 * and that is all. The solver is let off early, at 1e-6; its exactness would make no difference.
 * The model stays as one that has not been touched. */
START_TEST(contacts_that_never_settle_end_with_a_status_and_the_numbers)
{
    bbm_model *m = incline(20, 1e19, 1), *n = incline(20, 1e19, 1);

    m->par.pcg.tolerance = 1e-6;
    ck_assert_int_eq(bbm_step(m), BBM_OPEN_CLOSE);
    ck_assert_int_eq(m->info.cuts, 12);
    ck_near(m->h, m->par.dt / 4096, m->par.dt, ROUNDING);
    ck_assert_msg(strstr(bbm_message(m), "step 1 at t = 0, dt cut to 2.44") &&
                  strstr(bbm_message(m), " passes") &&
                  strstr(bbm_message(m), " contacts"), "%s", bbm_message(m));
    ck_assert(same_state(m, n));
}
END_TEST

/* ------------------------------------------------------------------------- what a step foresees */

/* The block moves at 1 m/s or turns at 1 rad/s, in steps of 10 ms: foreseen are 1.1 times the way,
 * 2.2 for two vertices that approach each other, and twice the turn with half a tolerance of 0.01
 * rad more. */
START_TEST(a_solution_that_moves_further_than_foreseen_is_noticed)
{
    const double way = 0.01, turn = 0.01;
    const double by[4][2] = { { 1.05, 0 }, { 1.15, 0 }, { 0, 2.45 }, { 0, 2.55 } };
    bbm_model *m = block_on_table(30);
    int n;

    set_velocity(m, 1, _i < 2 ? 1 : 10, 0);
    m->element[1].V[2] = _i < 2 ? 0 : 1;
    m->acceleration[1] = 0;
    start_step(m, &n);
    ck_assert(!bbm_moved_too_far(m));
    m->D[6] = way * by[_i][0];
    m->D[6 + 2] = turn * by[_i][1];
    ck_assert_int_eq(bbm_moved_too_far(m), _i % 2);
    if (_i % 2) {
        ck_ok(bbm_detect_contacts(m, &(int){ 0 }), m);
        ck_assert(!bbm_moved_too_far(m));           /* it has become the guess */
    }
}
END_TEST

/* Half a millionth of an edge, to the last bit, is what a step that foretells nothing may move;
 * and half of a hundredth what one that foretells no turn, but a way that is long enough, may
 * turn. */
START_TEST(a_solution_may_move_as_far_as_foreseen_to_the_last_bit)
{
    bbm_model *m = weightless_blocks();
    int n;

    add_rectangle(m, 0, ROCK, (rectangle){ .x = 0, .y = 0, .w = 1, .h = 1 });
    start_step(m, &n);
    m->D[0] = 1e-6 / 2;
    ck_assert(!bbm_moved_too_far(m));
    m->D[0] = nextafter(1e-6 / 2, 1);
    ck_assert(bbm_moved_too_far(m));
    set_velocity(m, 0, 10, 0);
    start_step(m, &n);
    m->D[2] = 0.01 / 2;
    ck_assert(!bbm_moved_too_far(m));
    m->D[2] = nextafter(0.01 / 2, 1);
    ck_assert(bbm_moved_too_far(m));
}
END_TEST

/* One block moves on and another one less far than it seemed: in the detection that follows the
 * first solution all are looked for as far as before. */
START_TEST(a_step_foresees_no_less_than_it_did_before)
{
    bbm_model *m = weightless_blocks();
    int n;

    for (int k = 0; k < 2; k++)
        add_rectangle(m, k, ROCK, (rectangle){ .x = 5 * k, .y = 0, .w = 1, .h = 1 });
    set_velocity(m, 0, 1, 0);
    start_step(m, &n);
    m->D[6] = 0.01;
    ck_assert(bbm_moved_too_far(m));                    /* block 1; and block 0 rests */
    ck_ok(bbm_detect_contacts(m, &(int){ 0 }), m);
    m->D[0] = m->D[6] = 0.0109;
    ck_assert(!bbm_moved_too_far(m));
}
END_TEST

/* -------------------------------------------------------------------------- vectors of the step */

/* The block comes down, and then turns by 5e-5 about the middle of its lower side: its corners end
 * the step r^2/4 = 6e-10 m beside where the vectors of its start see them, which is much for the
 * shear springs of 1e12 N/m, and nothing for the normal springs of 1e6. Locked contacts have to be
 * solved again; sliding ones have no shear spring. At 3e-4 the turn itself is too much for the work
 * of a load, (3e-4)^2 2 > 1e-8. */
START_TEST(vectors_of_the_step_are_off_by_the_force_that_they_make)
{
    bbm_model *m = block_on_table(_i ? 0 : 30);
    const double turn = _i < 2 ? 5e-5 : 3e-4;
    bbm_pass pass;

    set_springs(m, 1e6, 1e12);
    m->node[0].held = 0;
    if (_i >= 2)
        ck_ok(bbm_add_load(m, m->vertex[m->element[1].first].node, 1, 0), m);
    for (int k = 0; k < 3; k++) {
        m->D[6] = k < 2 ? 0 : -turn / 2;
        m->D[7] = -0.01;
        m->D[8] = k < 2 ? 0 : turn;
        pass = bbm_open_close(m);
    }
    ck_assert_int_eq(pass, _i == 1 ? BBM_PASS_DONE : BBM_PASS_AGAIN);
    pass = bbm_open_close(m);
    ck_assert_int_eq(pass, BBM_PASS_DONE);
    ck_assert(!bbm_middle_is_off(m));
}
END_TEST

/* A tip over a table, and what a solution says of their contact, in N of its springs: how far
 * it is off the table, how far the vectors have it, and how wrong they have its slip. With the
 * forces on the tip's element, the table and what else touches that, and N. A quarter of the
 * largest of the first three, or a billionth of all, may be wrong; a shear spring only counts
 * where it is, an open contact never. All to the last bit: the numbers are
 * short ones in base 2. */
static const struct {
    bbm_contact_state state;
    double tip[2], table[2], N, third, at, told, slip;
    int off;
} WRONG[] = {
    { BBM_LOCK,  { 100, 0 }, { 0, 0 }, 0, 0, 64, 64 + 25, 0, 0 },
    { BBM_LOCK,  { 100, 0 }, { 0, 0 }, 0, 0, 64, 64 + 25.125, 0, 1 },
    { BBM_LOCK,  { 0, 100 }, { 0, 0 }, 0, 0, 64, 64 - 25, 0, 0 },
    { BBM_LOCK,  { 0, 100 }, { 0, 0 }, 0, 0, 64, 64 - 25.125, 0, 1 },
    { BBM_LOCK,  { 0, 0 }, { 100, 0 }, 0, 0, 64, 64 + 25, 25, 0 },
    { BBM_LOCK,  { 0, 0 }, { 100, 0 }, 0, 0, 64, 64, 25.125, 1 },
    { BBM_LOCK,  { 0, 0 }, { 0, -100 }, 0, 0, 64, 64, -25, 0 },
    { BBM_LOCK,  { 0, 0 }, { 0, -100 }, 0, 0, 64, 64, -25.125, 1 },
    { BBM_LOCK,  { 1, 0 }, { 0, 1 }, -100, 0, 64, 64 + 25, -25, 0 },
    { BBM_LOCK,  { 1, 0 }, { 0, 1 }, 100, 1e6, 64, 64 + 25.125, 0, 1 },
    { BBM_LOCK,  { 100, 0 }, { 0, 0 }, 0, 64e9, 64, 64 + 63, 63, 0 },
    { BBM_LOCK,  { 100, 0 }, { 0, 0 }, 0, 64e9, 64, 64 + 65, 0, 1 },
    { BBM_SLIDE, { 100, 0 }, { 0, 0 }, 0, 0, 64, 64 + 25, 99, 0 },
    { BBM_SLIDE, { 100, 0 }, { 0, 0 }, 0, 0, 64, 64 + 25.125, 99, 1 },
    { BBM_OPEN,  { 100, 0 }, { 0, 0 }, 0, 0, 64, 256, 99, 0 },
    { BBM_LOCK,  { 0, 0 }, { 0, 0 }, 0, 0, 0, 0, 0, 0 },
};

START_TEST(vectors_may_be_wrong_by_a_share_of_the_forces_on_their_blocks)
{
    const double p = ldexp(1, 30), tip[2] = { 1, 64 / p }, beside[2] = { -1, 64 / p };
    bbm_model *m = weightless_blocks();
    int n, same;

    m->par.p_n = m->par.p_s = p;
    add_table(m, 0);
    add_wedge(m, 1, tip, radians(60), radians(120));
    add_wedge(m, 2, beside, radians(60), radians(120));
    add_rectangle(m, 3, ROCK, (rectangle){ .x = 50, .y = 0, .w = 1, .h = 1 });
    set_velocity(m, 1, 0, -1);
    set_velocity(m, 2, 0, -1);
    m->h = m->par.dt;
    bbm_begin_step(m);
    ck_ok(bbm_detect(m, &same), m);                     /* lays out K for the contacts */
    memset(m->D, 0, 24 * sizeof *m->D);
    bbm_set_middle(m);
    (void)list_contacts(m, &n);
    ck_assert_int_eq(n, 2);
    memset(m->F, 0, 24 * sizeof *m->F);
    for (int a = 0; a < 2; a++) {
        m->F[a] = WRONG[_i].table[a];
        m->F[6 + a] = WRONG[_i].tip[a];
    }
    m->F[12 + _i % 2] = WRONG[_i].third;
    m->F[18] = 1e30;                                    /* K does not connect it */
    bbm_matrix_measure(m->K, m->F);
    (void)bbm_open_close(m);
    ck_assert_int_eq(bbm_contacts_are_off(m, 0.25), 0);
    m->vertex[m->element[1].first].y = WRONG[_i].at / p;
    bbm_contact *c = find_listed(m, 1, 0, 0, 2);
    c->state = WRONG[_i].state;
    c->N = WRONG[_i].N;
    c->d_n = WRONG[_i].told / p;
    c->anchor = 0.25;                                   /* 2.5 m from the table's end at x = 5 */
    c->trial.time_left = 0.5;
    c->d_s = 0.5 * (1 - 2.5) + WRONG[_i].slip / p;
    ck_assert_int_eq(bbm_contacts_are_off(m, 0.25), WRONG[_i].off);
}
END_TEST

/* Under forces beside which nothing else counts: the tip, or the table, turns by 1e-4 more than
 * the vectors of the step have it, or by a bit more than that. The force of a closed contact is
 * off, that of an open one there is not; with the paper's update the vectors do not turn. */
START_TEST(the_direction_of_a_contacts_force_may_be_wrong_by_1e_4)
{
    const double tip[2] = { 1, 1e-3 };
    bbm_model *m = weightless_blocks();
    int n;

    add_table(m, 0);
    add_wedge(m, 1, tip, radians(60), radians(120));
    set_velocity(m, 1, 0, -1);
    bbm_contact *c = start_step(m, &n);
    m->F[0] = m->F[6] = 1e30;
    for (int k = 0; k < 2; k++)
        for (c->state = BBM_OPEN; c->state <= BBM_SLIDE; c->state++) {
            m->D[6 * k + 2] = _i ? -1e-4 : 1e-4;
            ck_assert(!bbm_contacts_are_off(m, 1));
            m->D[6 * k + 2] = nextafter(m->D[6 * k + 2], _i ? -1 : 1);
            ck_assert_int_eq(bbm_contacts_are_off(m, 1), c->state != BBM_OPEN);
            m->beyond->rotation = BBM_LINEAR;
            ck_assert(!bbm_contacts_are_off(m, 1));
            m->beyond->rotation = BBM_EXACT;
            m->D[6 * k + 2] = 0;
        }
}
END_TEST

Suite *open_close_suite(void)
{
    Suite *s = suite_create("open-close");

    add_case(s, "loop",
        { solutions_that_never_agree_make_the_iteration_give_up, 2 },
        { a_solution_that_agrees_ends_the_iteration, 3 },
        { other_states_are_another_number, 1 },
        { a_pass_that_renews_the_vectors_is_no_cycle, 1 });
    add_case(s, "passes",
        { states_are_the_same_number_whatever_was_before, 2 },
        { what_closes_on_an_edge_that_stretches_has_not_slipped, 2 },
        { multipliers_take_solutions_in_statics_alone, 2 },
        { a_cycle_is_broken_one_by_one_for_as_many_passes_again, 2 },
        { the_contact_that_fits_worst_changes_first, 2 },
        { a_contact_that_closes_outside_the_cone_of_friction_slides, 4 },
        { a_contact_that_its_shear_spring_pulls_open_slides_first, 2 },
        { piles_settle_in_few_passes, 1 },
        { friction_in_the_matrix_takes_no_passes, 4 },
        { blocks_that_slide_take_few_solutions_a_step, COUNT(FEW) },
        { blocks_without_any_force_settle_at_once, 1 },
        { blocks_at_rest_without_any_force_run_turned_by_any_angle, 24 },
        { contacts_that_never_settle_end_with_a_status_and_the_numbers, 1 });
    add_case(s, "foreseen",
        { a_solution_that_moves_further_than_foreseen_is_noticed, 4 },
        { a_solution_may_move_as_far_as_foreseen_to_the_last_bit, 1 },
        { a_step_foresees_no_less_than_it_did_before, 1 });
    add_case(s, "vectors",
        { vectors_of_the_step_are_off_by_the_force_that_they_make, 3 },
        { vectors_may_be_wrong_by_a_share_of_the_forces_on_their_blocks, COUNT(WRONG) },
        { the_direction_of_a_contacts_force_may_be_wrong_by_1e_4, 2 });
    return s;
}
