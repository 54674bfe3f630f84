/* check_blocks.c - blocks at rest and in motion against closed forms and invariants. */
#include <string.h>

#include "check.h"
#include "models.h"

/* -------------------------------------------------------------------------------------- at rest */

/* In 10,000 steps: rounding, 1e-16 of 4 m in each, if all were of one sign. */
START_TEST(blocks_of_a_column_carry_the_weight_above_and_do_not_drift)
{
    enum { N = 4 };
    const double W = DENSITY * GRAVITY;
    double at[N][3];
    bbm_model *m = new_blocks();

    add_table(m, 0);
    for (int b = 1; b <= N; b++)
        add_rectangle(m, b, ROCK, (rectangle){ .x = 0, .y = b - 1, .w = 1, .h = 1 });
    m->par.friction = 30;
    settle(m, 100);
    for (int b = 1; b <= N; b++)
        memcpy(at[b - 1], m->element[b].sum, sizeof at[b - 1]);
    run_steps(m, 10000);
    ck_assert_int_eq(m->info.contacts, 2 * N);
    ck_relative(m->info.penetration, N * W / 2 / m->par.p_n, 1e-8);
    ck_assert_int_eq(m->info.passes, 1);
    for (int k = 0; k < m->contacts; k++) {
        const bbm_contact *c = &m->contact[k];
        const int p = corner_block(m, c), q = edge_block(m, c), upper = p > q ? p : q;
        if (c->state == BBM_OPEN)
            continue;
        ck_relative(c->N, (N - upper + 1) * W / 2, 1e-8);
        ck_relative(-c->d_n, (N - upper + 1) * W / 2 / m->par.p_n, 1e-8);
    }
    for (int b = 1; b <= N; b++) {
        for (int a = 0; a < 3; a++)
            ck_near(m->element[b].sum[a], at[b - 1][a], 1, 4e-12);
        for (int a = 0; a < 6; a++)
            ck_near(m->element[b].V[a], 0, 1, a < 3 ? 1e-11 : 1e-9);
    }
}
END_TEST

/* Statics, dt = INFINITY, in a few iterations: a block with a horizontal push, on shear springs;
 * and without friction, where a roller has to hold it. The block's own shortening is some W/E =
 * 1e-6 of its size, the springs' is W/p_n. */
START_TEST(statics_balances_a_block_on_its_contacts)
{
    const double W = DENSITY * GRAVITY, push = _i ? 0 : 5000;
    bbm_model *m = new_blocks();

    m->par.dt = INFINITY;
    m->par.friction = _i ? 0 : 40;
    add_table(m, 0);
    const int e = add_rectangle(m, 1, ROCK, (rectangle){ .x = 0, .y = 0, .w = 1, .h = 1 });
    ck_ok(bbm_add_load(m, vertex_of(m, e, 0)->node, push, 0), m);
    if (_i)
        ck_ok(bbm_fix_node(m, vertex_of(m, e, 0)->node, BBM_X, 0, 0), m);
    run_steps(m, 5);
    ck_relative(normal_force(m, 0, 1), W, 1e-8);
    /* shortened by W h/(2 E) = 1e-6 */
    ck_near(m->element[e].sum[1], -W / 2 / m->par.p_n, 1e-4, 0.03);
    const bbm_contact *a = contact_of(m, e, 0), *b = contact_of(m, e, 1);
    ck_assert(a && b);
    ck_near(fabs(a->T + b->T), push, W, 1e-8);
    ck_assert_int_eq(a->state, _i ? BBM_SLIDE : BBM_LOCK);
    ck_near(m->info.t, 0, 1, 0);
}
END_TEST

/* The notch of an L holds a block without friction that is pushed towards the wall at its centre of
 * gravity; so does the notch beside the one node in which two squares of a block meet: there the
 * boundary goes on along the same square. */
START_TEST(a_block_in_a_notch_leans_on_its_floor_and_its_wall)
{
    static const double x[7][2] = { { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 }, { 2, 1 }, { 2, 2 },
                                    { 1, 2 } };
    static const int square[2][4] = { { 0, 1, 2, 3 }, { 2, 4, 5, 6 } };
    const double size = _i ? 0.8 : 0.25, W = size * size * DENSITY * GRAVITY;
    bbm_model *m = new_blocks();

    if (_i == 0)
        add_outline(m, 0, &NOTCHED, 0);
    for (int k = 0; k < 7 && _i; k++)
        ck_ok(bbm_add_node(m, x[k][0], x[k][1], NULL), m);
    for (int k = 0; k < 2 && _i; k++)
        ck_ok(bbm_add_element(m, 0, BASE, 4, square[k], NULL), m);
    for (int n = 0; n < m->nodes; n++)
        ck_ok(bbm_fix_node(m, n, BBM_XY, 0, 0), m);
    const rectangle stone = { .x = _i ? 0.2 : 0, .y = _i, .w = size, .h = size };
    const int e = add_rectangle(m, 1, ROCK, stone);
    for (int k = 0; k < 4; k++)
        ck_ok(bbm_add_load(m, vertex_of(m, e, k)->node, (_i ? W : -W) / 8, 0), m);
    settle(m, 100);
    double floor = 0, side = 0;
    for (int k = 0; k < m->contacts; k++) {
        const bbm_vertex *A = start_of(m, m->contact[k].edge), *B = end_of(m, m->contact[k].edge);
        ck_assert(_i || edge_block(m, &m->contact[k]) == 0);
        *(fabs(B->x - A->x) > fabs(B->y - A->y) ? &floor : &side) += m->contact[k].N;
    }
    ck_relative(floor, W, 1e-5);  /* the fixed points of the L give way, its sides turn */
    ck_relative(side, W / 2, 1e-5);
}
END_TEST

/* A block of 4 x 4 elements, soft and without Poisson's effect: the mean stress of each row is the
 * weight above its middle, when the grid points inside its lower side bear on the table, too. Else
 * it stands on its two lower corners. */
START_TEST(a_bonded_block_at_rest_has_the_stress_of_its_own_weight)
{
    const bbm_material soft = { 1e8, 0, 2500, 1 };
    bbm_model *m = new_blocks();
    int material;

    ck_ok(bbm_add_material(m, &soft, &material), m);
    m->par.faces = _i;
    m->par.friction = 30;
    set_springs(m, 1e10, 4e9);
    add_table(m, 0);
    const int e = add_rectangle(m, 1, material, (rectangle){ .x = 0, .y = 0, .w = 2, .h = 2,
                                                             .nx = 4, .ny = 4 });
    settle(m, 150);
    ck_assert_int_eq(m->info.contacts, _i ? 5 : 2);
    ck_relative(normal_force(m, 0, 1), 4 * DENSITY * GRAVITY, 1e-6);
    for (int row = 0; row < 4 && _i; row++) {
        double mean = 0;
        for (int k = 0; k < 4; k++)
            mean += m->element[e + 4 * row + k].stress[1] / 4;
        ck_relative(mean, -DENSITY * GRAVITY * (2 - (row + 0.5) / 2), 1e-5);
    }
}
END_TEST

/* Two blocks turn the same way, so that neither turns against the other; but one may be stopped,
 * and so a corner whose side points into the other's edge by less than twice the turn of both may
 * come to touch. */
START_TEST(blocks_that_turn_alike_may_come_to_turn_against_each_other)
{
    const double tilt = 0.15, c = cos(tilt), s = sin(tilt);
    const double square[4][2] = { { 0, 0.01 }, { c, 0.01 - s }, { c + s, 0.01 + c - s },
                                  { s, 0.01 + c } };
    bbm_model *m = new_blocks();
    int found = 0;

    add_rectangle(m, 0, ROCK, (rectangle){ .x = -2, .y = -1, .w = 2.01, .h = 1 });
    const int e = add_polygon(m, 1, 4, square);
    ck_ok(bbm_prepare(m), m);
    m->element[0].V[2] = m->element[e].V[2] = (_i ? 0.1 : 0.02) / m->par.dt;
    detect(m);
    for (int k = 0; k < m->contacts; k++)
        found += corner_vertex(m, &m->contact[k]) == vertex_of(m, e, 0) &&
                 end_of(m, m->contact[k].edge)->x == -2;
    ck_assert_int_eq(found, _i);
}
END_TEST

/* ------------------------------------------------------------------------------------ in motion */

static const double DROP_STEPS[] = { 2e-2, 1e-2, 5e-3, 2e-3, 1e-3, 5e-4 };

/* Flat, and tilted so that it falls on a corner: whatever the step, nothing comes back faster than
 * it went, and the energy never rises above that of the start (by more than 1e-3, as a tilted block
 * turns). */
START_TEST(a_dropped_block_never_rebounds_faster_than_it_came)
{
    const double tilt = _i % 2 ? 10 : 0, h = 0.05;
    double impact = 0, rebound = 0;
    int hits = 0;
    bbm_model *m = new_blocks();

    m->par.dt = DROP_STEPS[_i / 2];
    m->par.friction = 30;
    add_table(m, 0);
    add_rectangle(m, 1, ROCK, (rectangle){ tilt > 0 ? 0 : -0.5, h, 1, 1, tilt, .fixed = 0 });
    ck_ok(bbm_prepare(m), m);
    const bbm_element *e = &m->element[1];
    while (m->info.t < 0.16) {
        run_steps(m, 1);
        hits += m->info.contacts;
        if (hits == 0)
            impact = fmax(impact, -e->V[1]);
        else
            rebound = fmax(rebound, e->V[1]);
        const double I = DENSITY / 6, sum = DENSITY * (e->V[0] * e->V[0] + e->V[1] * e->V[1]) / 2 +
                                            I * e->V[2] * e->V[2] / 2 +
                                            DENSITY * GRAVITY * e->sum[1];
        ck_assert(sum < 1e-3 * DENSITY * GRAVITY * h);
    }
    ck_assert(hits > 0);
    ck_assert(rebound <= impact);
}
END_TEST

/* Momentum of both blocks and of each, and angular momentum about the origin, of the masses at the
 * start. */
static void momenta(bbm_model *m, double P[2][2], double *L)
{
    memset(P, 0, 4 * sizeof(double));
    *L = 0;
    for (int k = 0; k < m->elements; k++) {
        bbm_element *e = &m->element[k];
        bbm_element_geometry(e, &m->vertex[e->first]);
        const double M = DENSITY * e->A0, q = M / e->A;
        P[e->block][0] += M * e->V[0];
        P[e->block][1] += M * e->V[1];
        *L += M * (e->x * e->V[1] - e->y * e->V[0]) +
              q * ((e->Sxx + e->Syy) * e->V[2] + e->Sxy * (e->V[4] - e->V[3]) +
                   (e->Sxx - e->Syy) / 2 * e->V[5]);
    }
}

/* Off-centre by 0.3 m, with friction and without, for springs and steps of several lengths. Forces
 * act at the middle of the step, where their points meet on the way: nothing is left of the
 * moments of the step's start. What is left of the angular momentum, as a share of what the first
 * block brings along, falls as 1/E and grows as the force of the impact does, as p_n^(1/2): 1.6e-6
 * for the stiffest springs. */
START_TEST(stiff_blocks_that_hit_keep_both_momenta)
{
    const double p_n = pow(10, 9 + _i % 4 % 3), share = DENSITY * 0.3;
    double P[2][2], L0, L;
    int stiff;
    bbm_model *m = weightless_blocks();

    ck_ok(bbm_add_material(m, &(bbm_material){ 1e12, 0.25, DENSITY, 1 }, &stiff), m);
    m->par.dt = _i % 4 == 3 ? 1e-4 : 2e-5;
    m->par.friction = _i / 4 * 30;
    set_springs(m, p_n, 0.4 * p_n);
    for (int k = 0; k < 2; k++)
        add_rectangle(m, k, stiff, (rectangle){ .x = 1.05 * k - 0.5, .y = 0.3 * k - 0.5, .w = 1,
                                                .h = 1 });
    set_velocity(m, 0, 1, 0);
    momenta(m, P, &L0);
    run_steps(m, (int)(0.2 / m->par.dt + 0.5));
    momenta(m, P, &L);
    ck_assert(P[1][0] > 0.5 * DENSITY);
    ck_near(P[0][0] + P[1][0], DENSITY, DENSITY, SOLVED);
    ck_near(P[0][1] + P[1][1], 0, DENSITY, SOLVED);
    ck_near(L, L0, share, 2e-6);
}
END_TEST

enum { PIECES = 40 };

typedef struct { double duration, force, share[2]; } meeting;

/* Two bars of PIECES squares, L = 10 m, c = 2000 m/s; the first comes with 1 m/s. Times in 2 L/c,
 * the force halfway through the contact in that of the wave, rho c v/2 times the section; the shares
 * of the momentum in the end. */
static meeting let_bars_meet(int steps)
{
    const double L = 10, c = sqrt(1e10 / DENSITY), h = L / PIECES;
    bbm_model *m = weightless_blocks();
    meeting a = { 0 };
    double P[2][2], unused;

    m->material[ROCK].nu = 0;
    m->par.dt = 2 * L / c / steps;
    m->par.p_n = 1e10;
    m->par.alpha = 1e4;
    for (int k = 0; k < 2; k++)
        add_rectangle(m, k, ROCK, (rectangle){ .x = (k - 1) * L, .w = L, .h = h, .nx = PIECES });
    for (int i = 0; i < PIECES; i++)
        set_velocity(m, i, 1, 0);
    for (int i = 0; i < steps * 3 / 2; i++) {
        run_steps(m, 1);
        const double N = normal_force(m, 0, 1);
        a.duration += N > 0 ? 1.0 / steps : 0;
        if (i == steps / 2)
            a.force = N / (DENSITY * c / 2 * h);
    }
    momenta(m, P, &unused);
    for (int k = 0; k < 2; k++)
        a.share[k] = P[k][0] / (DENSITY * L * h);
    release(m);
    return a;
}

START_TEST(two_elastic_bars_exchange_velocities_and_part_when_the_wave_comes_back)
{
    const meeting coarse = let_bars_meet(500), fine = let_bars_meet(1000);

    /* The wave takes 1/80 through an element, and its front and end are as long: less than half. */
    ck_relative(coarse.duration, 1, 0.005);
    ck_relative(fine.duration, 1, 0.005);
    /* Behind the front the force is that of the bar; bonds and contact give way by 1e-4. */
    ck_relative(coarse.force, 1, 1e-3);
    ck_relative(fine.force, 1, 1e-3);
    ck_relative(coarse.share[0] + coarse.share[1], 1, 1e-9);
    /* What the time step damps away stays with the first bar: the less, the smaller the step. */
    ck_relative(coarse.share[1], 1, 0.03);
    ck_relative(fine.share[1], 1, 0.02);
    ck_assert(fine.share[0] > 0 && fine.share[0] < 0.8 * coarse.share[0]);
}
END_TEST

/* 3 x 3 elements of 1 GPa, for 2 s, in steps of 10 to 1.25 ms: up to their strain, of the order of
 * rho w^2/E = 2.5e-6, of which the share of what swings is left. With the paper's bonds, which pull
 * along the directions of a step's start, it would be (1 - 1/9) (w^2 dt) t/2, up to 0.9 %. */
START_TEST(a_bonded_block_that_turns_keeps_its_angular_momentum)
{
    double P[2][2], L0, L;
    int soft;
    bbm_model *m = weightless_blocks();

    ck_ok(bbm_add_material(m, &(bbm_material){ 1e9, 0.25, DENSITY, 1 }, &soft), m);
    m->par.dt = 0.01 / (1 << _i);
    add_rectangle(m, 0, soft, (rectangle){ .x = -0.5, .y = -0.5, .w = 1, .h = 1, .nx = 3, .ny = 3 });
    for (int e = 0; e < m->elements; e++) {
        set_velocity(m, e, -m->element[e].y, m->element[e].x);
        m->element[e].V[2] = 1;
    }
    momenta(m, P, &L0);
    run_steps(m, 200 << _i);
    momenta(m, P, &L);
    ck_near(m->info.t, 2, 2, ROUNDING);
    ck_relative(L, L0, 2e-8);
}
END_TEST

/* The spring begins with the force of a gap of v dt, 10^11 times the one that gives the wall, 1,300
 * times as heavy, its momentum: p_n dt^2/2m = 1.7e11, of which rounding leaves 2e-5. */
START_TEST(a_stone_gives_a_heavy_wall_its_momentum_through_a_very_stiff_spring)
{
    double P[2][2], L;
    int stiff;
    bbm_model *m = weightless_blocks();

    ck_ok(bbm_add_material(m, &(bbm_material){ 1e12, 0.25, DENSITY, 1 }, &stiff), m);
    m->par.dt = 0.1;
    m->par.pcg.tolerance = 1e-10;
    m->par.p_n = 5e13;
    add_rectangle(m, 0, stiff, (rectangle){ .x = -0.03, .y = -0.01, .w = 0.03, .h = 0.02 });
    add_rectangle(m, 1, stiff, (rectangle){ .x = 0.025, .y = -8, .w = 0.05, .h = 16 });
    set_velocity(m, 0, 0.1, 0);
    momenta(m, P, &L);
    const double all = P[0][0];
    run_steps(m, 8);
    momenta(m, P, &L);
    ck_assert(P[0][0] < 0.5 * all);
    ck_near(P[0][0] + P[1][0], all, all, 2e-5);
}
END_TEST

/* Courses of single elements on a mesh at rest: iterations of a solution, in the mean of a step. */
static int wall_on_mesh_iterations(double stiffness)
{
    bbm_model *m = new_blocks();

    m->par.p_n = m->par.p_s = stiffness;
    add_table(m, 0);
    add_rectangle(m, 1, ROCK, (rectangle){ .w = 4, .h = 2, .nx = 8, .ny = 4 });
    for (int k = 0; k < 16; k++)
        add_rectangle(m, 2 + k, ROCK, (rectangle){ .x = k % 4, .y = 2 + k / 4, .w = 1, .h = 1 });
    settle(m, 3);
    const int iterations = m->info.iterations / m->info.passes;
    release(m);
    return iterations;
}

START_TEST(iterations_do_not_grow_with_the_stiffness_of_contacts)
{
    const int soft = wall_on_mesh_iterations(5e9), stiff = wall_on_mesh_iterations(5e12);

    ck_assert_int_le(2 * stiff, 3 * soft);      /* 17 and 15; left to SSOR, 192 and 48 */
}
END_TEST

Suite *blocks_suite(void)
{
    Suite *s = suite_create("blocks");

    add_case(s, "at rest",
        { blocks_of_a_column_carry_the_weight_above_and_do_not_drift, 1 },
        { statics_balances_a_block_on_its_contacts, 2 },
        { a_block_in_a_notch_leans_on_its_floor_and_its_wall, 2 },
        { a_bonded_block_at_rest_has_the_stress_of_its_own_weight, 2 },
        { iterations_do_not_grow_with_the_stiffness_of_contacts, 1 },
        { blocks_that_turn_alike_may_come_to_turn_against_each_other, 2 });
    add_case(s, "in motion",
        { a_dropped_block_never_rebounds_faster_than_it_came, 2 * COUNT(DROP_STEPS) },
        { stiff_blocks_that_hit_keep_both_momenta, 8 },
        { a_stone_gives_a_heavy_wall_its_momentum_through_a_very_stiff_spring, 1 },
        { two_elastic_bars_exchange_velocities_and_part_when_the_wave_comes_back, 1 },
        { a_bonded_block_that_turns_keeps_its_angular_momentum, 4 });
    return s;
}
