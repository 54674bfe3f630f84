/* check_limits.c - what a contact must still do right after a long time, over many edges, and
 * between elastic bodies.
 *
 * The oracles are closed forms: waves in a bar, the weight above an interface, the same slide over
 * a base in one piece. Limit loads - arches, a slope, a wall that is tilted - and the rocking block
 * are cases of the gallery, each with an oracle of its own; check_statements.c holds them to it. */
#include <string.h>

#include "../beyond/beyond.h"
#include "check.h"

static const double GRAVITY = 9.81, DENSITY = 2500;

typedef struct { int block, material, nx; double x, y, w, h, turn; } box;

/* Adds nx elements in a row, the lower left corner at (x, y), all turned about the origin. */
static void add_box(bbm_model *m, const box *b, int fixed)
{
    const double c = cos(b->turn), s = sin(b->turn);
    const int first = m->nodes;

    for (int i = 0; i <= b->nx; i++)
        for (int j = 0; j < 2; j++) {
            const double x = b->x + b->w * i / b->nx, y = b->y + b->h * j;
            ck_ok(bbm_add_node(m, c * x - s * y, s * x + c * y, NULL), m);
            if (fixed)
                ck_ok(bbm_fix_node(m, m->nodes - 1, BBM_XY, 0, 0), m);
        }
    for (int i = 0; i < b->nx; i++) {
        const int a = first + 2 * i;
        const int node[4] = { a, a + 2, a + 3, a + 1 };
        ck_ok(bbm_add_element(m, b->block, b->material, 4, node, NULL), m);
    }
}

/* Material 0 gives way a thousand times less than material 1. */
static bbm_model *new_model(double E, double nu, double dt, double p_n, double friction)
{
    bbm_model *m;

    ck_assert_int_eq(bbm_beyond_new(&m), BBM_OK);
    ck_ok(bbm_add_material(m, &(bbm_material){ 1000 * E, nu, DENSITY, 1 }, NULL), m);
    ck_ok(bbm_add_material(m, &(bbm_material){ E, nu, DENSITY, 1 }, NULL), m);
    m->par.dt = dt;
    m->par.velocity_factor = 1;
    m->par.p_n = p_n;
    m->par.p_s = 0.4 * p_n;
    m->par.friction = friction;
    m->par.pcg.tolerance = 1e-14;
    return m;
}

static void run(bbm_model *m, double keep, int steps)
{
    m->par.velocity_factor = keep;
    for (int i = 0; i < steps; i++)
        ck_ok(bbm_step(m), m);
}

/* ----------------------------------------------------------------------------- two elastic bars */

enum { PIECES = 40 };

typedef struct { double duration, force, first, second; } meeting;

static double force_between(const bbm_model *m)
{
    double N = 0;

    for (int k = 0; k < m->contacts; k++)
        N += m->contact[k].state == BBM_OPEN ? 0 : m->contact[k].N;
    return N;
}

/* The share of the momentum at the start that the pieces from `first` on have. */
static double momentum(const bbm_model *m, int first)
{
    double P = 0;

    for (int i = first; i < first + PIECES; i++)
        P += m->element[i].V[0] / PIECES;
    return P;
}

/* Two bars of PIECES squares, L = 10 m, c = 2000 m/s; the first comes with 1 m/s. Times in 2 L/c,
 * the force halfway through the contact in that of the wave, rho c v/2 times the section. */
static meeting let_bars_meet(int steps)
{
    const double L = 10, E = 1e10, c = sqrt(E / DENSITY), h = L / PIECES, T = 2 * L / c;
    bbm_model *m = new_model(E, 0, T / steps, E, 0);
    int begins = 0, ends = 0;
    meeting a = { 0 };

    m->par.alpha = 1e4;
    add_box(m, &(box){ .material = 1, .nx = PIECES, .x = -L, .w = L, .h = h }, 0);
    add_box(m, &(box){ .block = 1, .material = 1, .nx = PIECES, .w = L, .h = h }, 0);
    ck_ok(bbm_prepare(m), m);
    for (int i = 0; i < PIECES; i++)
        m->element[i].V[0] = 1;
    for (int i = 0; i < steps * 3 / 2; i++) {
        run(m, 1, 1);
        const double N = force_between(m);
        if (N > 0 && begins == 0)
            begins = i;
        if (N > 0)
            ends = i + 1;
        if (i == steps / 2)
            a.force = N / (DENSITY * c / 2 * h);
    }
    a.duration = (double)(ends - begins) / steps;
    a.first = momentum(m, 0);
    a.second = momentum(m, PIECES);
    bbm_model_free(m);
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
    ck_relative(coarse.first + coarse.second, 1, 1e-9);
    /* What the time step damps away stays with the first bar: the less, the smaller the step. */
    ck_relative(coarse.second, 1, 0.03);
    ck_relative(fine.second, 1, 0.02);
    ck_assert_double_lt(fine.first, 0.8 * coarse.first);
    ck_assert_double_gt(fine.first, 0);
}
END_TEST

/* ----------------------------------------------------------------------------------- many edges */

/* How far a block slides in two seconds down 30 degrees, over a base of so many pieces. */
static double slide(int pieces, double phi)
{
    const double turn = acos(-1) / 6;
    bbm_model *m = new_model(1e10, 0.25, 0.01, 1e9, phi);

    m->par.gravity[1] = -GRAVITY;
    add_box(m, &(box){ .nx = pieces, .x = -12, .y = -1, .w = 18, .h = 1, .turn = turn }, 1);
    add_box(m, &(box){ .block = 1, .material = 1, .nx = 1, .w = 1, .h = 0.5, .turn = turn }, 0);
    ck_ok(bbm_prepare(m), m);
    run(m, 1, 200);
    const double *sum = m->element[pieces].sum, way = -cos(turn) * sum[0] - sin(turn) * sum[1];
    bbm_model_free(m);
    return way;
}

START_TEST(a_slide_over_a_hundred_edges_is_a_slide_over_one)
{
    static const double phi[] = { 0, 10, 20 };
    const double one = slide(1, phi[_i]), hundred = slide(100, phi[_i]);

    ck_assert_double_gt(one, 3);                /* m: two corners pass an edge every 18 cm */
    /* All of the base is fixed: what differs is the solver, 1e-14 times its condition number. */
    ck_relative(hundred, one, 1e-9);
}
END_TEST

/* ---------------------------------------------------------------------------------- a long time */

enum { BLOCKS = 5 };

/* The normal forces between blocks k-1 and k. */
static double force_under(const bbm_model *m, int k)
{
    double N = 0;

    for (int i = 0; i < m->contacts; i++) {
        const bbm_contact *c = &m->contact[i];
        const int a = m->element[m->edge[c->corner].element].block;
        const int b = m->element[m->edge[c->edge].element].block;
        if (c->state != BBM_OPEN && (a > b ? a : b) == k)
            N += c->N;
    }
    return N;
}

START_TEST(a_column_stands_ten_thousand_steps_where_it_stood)
{
    const double W = DENSITY * GRAVITY;
    bbm_model *m = new_model(1e10, 0.25, 0.01, 1e9, 30);
    double place[BLOCKS + 1][3];

    m->par.gravity[1] = -GRAVITY;
    add_box(m, &(box){ .nx = 1, .x = -2, .y = -1, .w = 5, .h = 1 }, 1);
    for (int k = 1; k <= BLOCKS; k++)
        add_box(m, &(box){ .block = k, .material = 1, .nx = 1, .y = k - 1, .w = 1, .h = 1 }, 0);
    ck_ok(bbm_prepare(m), m);
    run(m, 0, 100);
    for (int k = 1; k <= BLOCKS; k++)
        memcpy(place[k], m->element[k].sum, sizeof place[k]);
    run(m, 1, 10000);
    for (int k = 1; k <= BLOCKS; k++) {
        const bbm_element *e = &m->element[k];
        /* The solver's tolerance times its condition number. */
        ck_relative(force_under(m, k), (BLOCKS + 1 - k) * W, 1e-9);
        /* Rounding, 1e-16 of 5 m a step, for 10,000 steps if all were of one sign. */
        for (int q = 0; q < 3; q++)
            ck_near(e->sum[q], place[k][q], 1, 5e-12);
        ck_near(hypot(e->V[0], e->V[1]), 0, 1, 1e-11);
    }
    bbm_model_free(m);
}
END_TEST

Suite *limits_suite(void)
{
    Suite *s = suite_create("limits");
    TCase *t = tcase_create("limits");

    tcase_set_timeout(t, 60);
    tcase_add_test(t, two_elastic_bars_exchange_velocities_and_part_when_the_wave_comes_back);
    tcase_add_loop_test(t, a_slide_over_a_hundred_edges_is_a_slide_over_one, 0, 3);
    tcase_add_test(t, a_column_stands_ten_thousand_steps_where_it_stood);
    suite_add_tcase(s, t);
    return s;
}
