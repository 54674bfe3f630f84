/* check_sliding.c - section 3.8: friction against closed forms, and how contacts go along where
 * blocks slide. */
#include <string.h>

#include "check.h"
#include "models.h"
#include "rock.h"

/* ---------------------------------------------------------------------- what contacts add to (5) */

/* One contact of two free blocks: its anchor, the share of the step that its shear spring has had,
 * and the N for which its friction is taken are of the test's making. */
static bbm_contact *one_contact(bbm_model *m)
{
    int n;

    m->par.friction = 30;
    add_rectangle(m, 0, ROCK, (rectangle){ -2, -1, 4, 1, 20, .fixed = 0 });
    const int e = add_rectangle(m, 1, ROCK, (rectangle){ 0, 0, 1, 1, 20, .fixed = 0 });
    m->hook->friction = NULL;               /* of beyond/: friction in K */
    start_step(m, &n);
    bbm_contact *c = find_listed(m, e, 0, 0, 2);
    ck_assert_ptr_nonnull(c);
    c->anchor = 0.3;
    c->rest = -1e-4;
    c->trial.time_left = 0.75;
    c->trial.N_of_friction = 1e5;
    c->sign = -1;
    return c;
}

/* p_n n n^T + p s s^T for e and g of both elements in one vector of 12, entry by entry. OPEN adds
 * nothing; LOCK has the share of p_s; SLIDE has no shear spring, but the friction N tan 30 against
 * the slip, Eq. (69). Sums of two terms: ROUNDING. */
START_TEST(a_closed_contact_adds_its_springs_or_its_friction_to_K_and_F)
{
    static const char *const state[] = { "OPEN", "LOCK", "SLIDE" };
    bbm_model *m = weightless_blocks();
    bbm_contact *c = one_contact(m);
    bbm_spring v[2];
    double x[12] = { 0 }, Kx[12];

    c->state = _i == 0 ? BBM_OPEN : _i == 1 ? BBM_LOCK : BBM_SLIDE;
    bbm_contact_vectors(m, c, c->anchor, v);
    ck_ok(bbm_lay_out_matrix(m), m);
    bbm_matrix_clear(m->K);
    memset(m->F, 0, 12 * sizeof *m->F);
    bbm_assemble_contacts(m);
    const double p_n = _i ? m->par.p_n : 0, p_s = _i == 1 ? 0.75 * m->par.p_s : 0;
    const double T = _i == 2 ? -1e5 * tan(radians(30)) : p_s * v[1].d;
    for (int a = 0; a < 12; a++) {
        const int i = a / 6, row = 6 * c->element[i] + a % 6;
        const double F = -p_n * (v[0].d - c->rest) * v[0].v[i][a % 6] - T * v[1].v[i][a % 6];
        ck_assert_msg(fabs(m->F[row] - F) <= ROUNDING * (fabs(F) + 1e5),
                      "%s: F[%d] is %g, expected %g", state[_i], row, m->F[row], F);
        x[row] = 1;
        matrix_multiply(m->K, x, Kx);
        x[row] = 0;
        for (int b = 0; b < 12; b++) {
            const int j = b / 6, column = 6 * c->element[j] + b % 6;
            const double K = p_n * v[0].v[i][a % 6] * v[0].v[j][b % 6]
                           + p_s * v[1].v[i][a % 6] * v[1].v[j][b % 6];
            ck_assert_msg(fabs(Kx[column] - K) <= ROUNDING * m->par.p_n,
                          "%s: K[%d][%d] is %g, expected %g", state[_i], column, row, Kx[column], K);
        }
    }
}
END_TEST

/* ------------------------------------------------------------------------------------- friction */

static const struct { double phi, tolerance; } SLIDING[] = {
    { 0, 1e-9 }, { 10, 1e-5 }, { 20, 1e-5 }, { 25, 1e-5 }, { 29, 1e-4 },
};

/* Steps, springs, and the elements of an incline in pieces. */
static const struct { double dt, p_n; int pieces; } HOW[] = {
    { 0.01, 1e9, 100 }, { 0.01, 1e10, 13 }, { 0.01, 1e11, 13 }, { 0.002, 1e11, 13 },
};

/* How far a block on an incline of one element or in pieces gets in 1 s. */
static double slid_in_a_second(double phi, int how, int in_pieces)
{
    const int pieces = in_pieces ? HOW[how].pieces : 1;
    bbm_model *m = incline(phi, HOW[how].p_n, pieces);

    m->par.dt = HOW[how].dt;
    run_steps(m, (int)(1 / m->par.dt + 0.5));
    const double way = slid(m, pieces);
    release(m);
    return way;
}

/* s = g (sin a - cos a tan phi) t^2/2. Gravity comes suddenly: while the block sinks into its
 * springs it feels less friction, and is ahead by tan(phi) times the penetration, 5.3e-6 m:
 * 5e-6 of the way at 25 degrees. At 29 degrees the way is a tenth of that, and the block sticks
 * at first. */
START_TEST(a_block_slides_down_an_incline_as_the_closed_form_says)
{
    const double phi = SLIDING[_i / 2].phi;
    const double g = GRAVITY * (sin(PI / 6) - cos(PI / 6) * tan(radians(phi)));

    for (int how = 0; how < COUNT(HOW); how++)
        ck_relative(slid_in_a_second(phi, how, _i % 2), g / 2, SLIDING[_i / 2].tolerance);
}
END_TEST

/* The plain way, friction with the N of the last solution, finds the same forces where it settles,
 * as it does for a block that is as wide as high. */
START_TEST(the_plain_way_to_agree_finds_the_same_friction)
{
    bbm_model *m = incline(20, 1e9, 1), *n = incline(20, 1e9, 1);

    n->hook->friction = NULL;
    run_steps(m, 100);
    run_steps(n, 100);
    ck_relative(slid(n, 1), slid(m, 1), 1e-7);
}
END_TEST

/* Uphill it stops after v0^2/(2 g (cos a tan phi + sin a)), and stays: the shear force turns from
 * friction down the slope to the weight's share up the slope. Stopping falls between two steps,
 * which shifts the end by up to (dt g)^2/(2 g). */
START_TEST(a_block_thrown_uphill_stops_where_it_should_and_stays_there)
{
    const double v0 = 2, phi = 40, g = GRAVITY * (cos(PI / 6) * tan(radians(phi)) + sin(PI / 6));
    const double W = 0.5 * DENSITY * GRAVITY, way = v0 * v0 / (2 * g);
    bbm_model *m = incline(phi, 1e9, 13);

    set_velocity(m, 13, v0 * cos(PI / 6), v0 * sin(PI / 6));
    run_steps(m, 40);
    const double stop = slid(m, 13);
    ck_near(-stop, way, 1, g * m->par.dt * m->par.dt / 2 + W / m->par.p_s);
    run_steps(m, 40);
    ck_near(slid(m, 13), stop, 1, 1e-5);
    double T = 0;
    for (int c = 0; c < 2; c++) {
        const bbm_contact *k = contact_of(m, 13, c);
        ck_assert(k && k->state == BBM_LOCK);
        T += k->T;
    }
    ck_near(fabs(T), W * sin(PI / 6), W, 1e-3);                 /* the last of the swing dies out */
}
END_TEST

/* Steeper than the incline, friction holds: the shear springs give way by W sin a/(2 p_s), and the
 * block, 1 m x 0.5 m, tilts by what the normal springs give, which moves its middle by W sin a
 * h^2/(2 b^2 p_n) more; its own shear strain, under a millionth of a metre, is left. With 31
 * degrees on 30 it first slides by some of that, as gravity comes suddenly. */
START_TEST(a_block_whose_friction_angle_is_above_the_slope_stays)
{
    const double W = 0.5 * DENSITY * GRAVITY;

    for (int how = 0; how < COUNT(HOW); how++) {
        const double give = W * sin(PI / 6) * (1 / 0.4 + 0.25) / (2 * HOW[how].p_n);
        ck_near(slid_in_a_second(_i / 2 ? 40 : 31, how, _i % 2), give, 1, _i / 2 ? 1e-6 : 1e-5);
    }
}
END_TEST

/* Friction that drops from its peak to what is left while a contact slides by a length. */
enum { PEAK = 6, RESIDUAL = 2 };                                /* tenths */

static const double LENGTH_OF_DROP = 0.05;

static void drop_with_slip(const bbm_model *m, bbm_contact *c)
{
    (void)m;
    c->strength.tan_phi = (PEAK - (PEAK - RESIDUAL) * fmin(1, c->slip / LENGTH_OF_DROP)) / 10;
}

/* A block thrown along a floor stops after x with v0^2/(2 g) = int tan(phi) dx; what its corners
 * have slid is that way. A step takes the friction of the slip at its start, and so the end is off
 * by half the slip of a step, v0 dt/2, times the drop: by 0.4 v0 dt/2 over tan(phi) = 0.2. */
START_TEST(friction_may_drop_with_the_slip)
{
    const double v0 = 1, peak = PEAK / 10.0, residual = RESIDUAL / 10.0;
    const double drop = LENGTH_OF_DROP * (peak - residual) / 2;
    const double way = (v0 * v0 / (2 * GRAVITY) - drop) / residual;
    bbm_model *m = new_blocks();

    m->hook->strength = drop_with_slip;
    m->par.dt = _i ? 5e-4 : 1e-3;
    add_table(m, 0);
    add_rectangle(m, 1, ROCK, (rectangle){ .x = -1, .y = 0, .w = 1, .h = 0.5 });
    settle(m, 5);
    set_velocity(m, 1, v0, 0);
    const double start = m->element[1].sum[0];
    run_steps(m, (int)(0.5 / m->par.dt));
    const double slid_by = m->element[1].sum[0] - start;
    ck_near(slid_by, way, 1, (peak - residual) / residual * v0 * m->par.dt / 2);
    for (int c = 0; c < 2; c++) {
        const bbm_contact *k = contact_of(m, 1, c);
        ck_assert(k && k->state == BBM_LOCK);
        ck_near(k->slip, slid_by, 1, 2e-5);
        ck_relative(k->strength.tan_phi, residual, ROUNDING);
    }
}
END_TEST

/* Each on its floor, in a component of K of its own. Their places differ by a power of two: only
 * rounding tells them apart. */
START_TEST(blocks_that_slide_on_floors_apart_slide_alike)
{
    bbm_model *m = new_blocks();

    m->par.friction = 20;
    for (int k = 0; k < 3; k++) {
        add_rectangle(m, 2 * k, BASE, (rectangle){ .x = 32 * k, .y = -1, .w = 8, .h = 1, .fixed = 1 });
        add_rectangle(m, 2 * k + 1, ROCK, (rectangle){ .x = 32 * k + 1, .w = 1, .h = 0.5 });
    }
    for (int k = 0; k < 3; k++)
        set_velocity(m, 2 * k + 1, 2, 0);
    run_steps(m, 20);
    ck_assert_double_gt(m->element[1].sum[0], 0.3);
    for (int k = 1; k < 3; k++)
        ck_relative(m->element[2 * k + 1].sum[0], m->element[1].sum[0], SOLVED);
}
END_TEST

/* Blocks of width 1 and height h on a slope: tan(delta) = 1/h; phi_c as in the literature on
 * toppling [degree], 2 degrees to both sides of each border. */
static const struct { double h, slope, phi; int slides, topples; } CHART[] = {
    { 0.5, 33, 31, 1, 0 }, { 0.5, 33, 35, 0, 0 },                               /* delta = 63.4 */
    { 2, 24.5, 22.5, 1, 0 }, { 2, 24.5, 26.5, 0, 0 }, { 2, 24.5, 45, 0, 0 },    /* delta = 26.6 */
    { 2, 28.6, 24.5, 1, 0 }, { 2, 28.6, 60, 0, 1 },
    /* phi_c = 31.3 */
    { 2, 45, 24.5, 1, 0 }, { 2, 45, 28.6, 1, 1 }, { 2, 45, 29.3, 1, 1 }, { 2, 45, 33.3, 0, 1 },
    { 3, 33, 16.4, 1, 0 }, { 3, 33, 20.4, 1, 1 },                               /* delta = 18.4 */
};

/* A block slides when its lower corner has moved by 1 mm in 0.5 s, and topples when it has turned
 * by 1/1000. */
START_TEST(a_block_on_a_slope_slides_or_topples_as_the_chart_says)
{
    const double slope = CHART[_i].slope;
    double turned = 0;
    bbm_model *m = new_blocks();

    m->par.friction = CHART[_i].phi;
    add_rectangle(m, 0, BASE, (rectangle){ -12, -1, 16, 1, slope, .fixed = 1 });
    add_rectangle(m, 1, ROCK, (rectangle){ 0, 0, 1, CHART[_i].h, slope, .fixed = 0 });
    for (int i = 0; i < 50; i++) {
        run_steps(m, 1);
        turned += m->element[1].D[2];
    }
    const bbm_vertex *foot = vertex_of(m, 1, 0);
    ck_assert_int_eq(-cos(radians(slope)) * foot->u - sin(radians(slope)) * foot->v > 1e-3,
                     CHART[_i].slides);
    ck_assert_int_eq(turned > 1e-3, CHART[_i].topples);
}
END_TEST

/* A block slides down an incline of 30 degrees onto a stop, in one step of statics; its friction all
 * but holds it. Until it has found the stop nothing else does. */
START_TEST(a_block_comes_to_rest_against_a_stop_in_statics)
{
    bbm_model *m = new_blocks();

    m->par.dt = INFINITY;
    m->par.velocity_factor = 0;
    m->par.friction = 29;
    set_springs(m, 5e11, 2e11);
    add_rectangle(m, 0, BASE, (rectangle){ -8, -1, 16, 1, 30, .fixed = 1 });
    add_rectangle(m, 1, ROCK, (rectangle){ -2, 0, 1, 0.5, 30, .fixed = 1 });
    add_rectangle(m, 2, ROCK, (rectangle){ -1, 0, 1, 1 + _i, 30, .nx = 1 });
    run_steps(m, 1);
}
END_TEST

/* A free block whose K a term u v^T changes: at 0 the first unknown's column is half as long again;
 * then it vanishes, but no load asks for that unknown; then it is no number, or infinite. The dense
 * oracle: K D = F row by row. */
START_TEST(a_matrix_that_is_not_symmetric_is_solved_or_refused)
{
    bbm_model *m = new_blocks();
    bbm_pcg_info info;
    double B[6][6], D[6], KD[6];

    add_rectangle(m, 0, ROCK, (rectangle){ .x = 0, .y = 0, .w = 1, .h = 2 });
    run_steps(m, 1);
    get_block(m->K, 0, 0, B);
    bbm_term *t = &m->K->term[0];
    *t = (bbm_term){ .parts = 1, .p = 1, .n = { .v = { { 1 } } } };
    for (int a = 0; a < 6; a++) {
        const double change[] = { 0.5, -1, NAN, INFINITY };
        t->s.v[0][a] = change[_i] * (_i < 2 || a == 0 ? B[a][0] : 0);
    }
    m->K->terms = 1;
    const bbm_status status = bbm_solve(m->K, m->F, D, &m->par.pcg, &info);
    ck_assert_int_eq(status, _i < 2 ? BBM_OK : BBM_NOT_POSITIVE_DEFINITE);
    for (int a = 0; a < 6 && _i < 2; a++) {
        KD[a] = (_i == 0 ? 0.5 : -1) * B[a][0] * D[0];
        for (int b = 0; b < 6; b++)
            KD[a] += B[a][b] * D[b];
        ck_near(KD[a], m->F[a], DENSITY * GRAVITY, SOLVED);
    }
    ck_assert(_i > 1 || info.residual < SOLVED);
}
END_TEST

/* eps |K| |D|/|F| is some 1e-9 for bonded elements, and 600 iterations leave ten times that. */
#define RESIDUAL 1e-7

/* A long block of bonded quadrilaterals slides: each method with its own corrections and omega is the
 * preconditioner of the same equations, whose residual is small when computed afresh. Five iterations
 * are too few, and that is said. */
START_TEST(friction_in_the_matrix_is_solved_with_every_method)
{
    static const bbm_method *const method[] = { &bbm_two_level, NULL };
    bbm_pcg_info info;
    bbm_model *m[2];

    for (int k = 0; k < 2; k++) {
        m[k] = new_blocks();
        m[k]->par.friction = 20;
        m[k]->par.pcg.method = k ? method[_i / 2] : &bbm_two_level;
        m[k]->par.pcg.omega = k && _i % 2 ? 1.3 : 1;
        add_rectangle(m[k], 0, BASE, (rectangle){ -8, -1, 16, 1, 30, .fixed = 1 });
        add_rectangle(m[k], 1, ROCK, (rectangle){ -2, 0, 4, 0.5, 30, .nx = 40, .ny = 3 });
        ck_ok(bbm_prepare(m[k]), m[k]);
        for (int i = 0; i < 5; i++) {
            run_steps(m[k], 1);
            ck_assert(m[k]->info.pcg.residual < RESIDUAL);
        }
        ck_assert_int_eq(m[k]->contact[0].state, BBM_SLIDE);
    }
    for (int i = 0; i < m[0]->elements; i++)
        ck_near(m[1]->element[i].sum[0], m[0]->element[i].sum[0], 0.1, RESIDUAL);
    ck_assert_int_gt(m[1]->info.pcg.iterations, 5);
    m[1]->par.pcg.iterations = 5;
    ck_assert_int_eq(bbm_solve(m[1]->K, m[1]->F, m[0]->D, &m[1]->par.pcg, &info),
                     BBM_NOT_CONVERGED);
}
END_TEST

/* ---------------------------------------------------------------------- where contacts go along */

/* On an incline of 20 pieces, after it has come to rest: the anchors stay in their places to the
 * last bit, so that nothing creeps, and the block is in the same place after 200 more steps. */
START_TEST(a_locked_contact_keeps_its_anchor)
{
    bbm_model *m = incline(40, 1e9, 20);
    double anchor[2], here;

    settle(m, 50);
    here = slid(m, 20);
    for (int c = 0; c < 2; c++)
        anchor[c] = contact_of(m, 20, c)->anchor;
    for (int i = 0; i < 200; i++) {
        run_steps(m, 1);
        for (int c = 0; c < 2; c++) {
            ck_assert_int_eq(contact_of(m, 20, c)->state, BBM_LOCK);
            ck_assert(contact_of(m, 20, c)->anchor == anchor[c]);
        }
    }
    ck_near(slid(m, 20), here, 1, 1e-12);
}
END_TEST

/* While it slides: the friction force of every contact is N tan(phi), and the anchor lies where its
 * spring would carry that force, T = p_s (P1 - P0).m. */
START_TEST(a_sliding_contact_takes_its_anchor_along)
{
    bbm_model *m = incline(20, 1e8, 1);
    int seen = 0;

    for (int i = 0; i < 30; i++) {
        run_steps(m, 1);
        for (int k = 0; k < m->contacts; k++) {
            const bbm_contact *c = &m->contact[k];
            const bbm_vertex *P1 = corner_vertex(m, c), *P2 = end_of(m, c->edge);
            const bbm_vertex *P3 = start_of(m, c->edge);
            const double x = P2->x - P3->x, y = P2->y - P3->y, l = hypot(x, y);
            const double stretch = ((P3->x + c->anchor * x - P1->x) * x +
                                    (P3->y + c->anchor * y - P1->y) * y) / l;
            if (c->state != BBM_SLIDE)
                continue;
            seen++;
            ck_near(c->T, c->sign * c->N * tan(radians(20)), DENSITY * GRAVITY, SOLVED);
            ck_near(stretch * m->par.p_s, c->T, DENSITY * GRAVITY, 1e-6);
        }
    }
    ck_assert(seen > 30);
}
END_TEST

/* A block that comes slanting, without gravity: its corner crosses the table's top at (x, 0) of its
 * straight way, in the course of a step. With rough and soft springs it locks there. */
START_TEST(a_contact_is_anchored_where_it_hit)
{
    const double vx = _i ? 2 : -1, gap = 0.013;
    int locked = 0;
    bbm_model *m = weightless_blocks();

    m->par.friction = 89;
    m->par.p_s = 1e3;
    add_table(m, 0);
    add_rectangle(m, 1, ROCK, (rectangle){ .x = -0.5, .y = gap, .w = 1, .h = 1 });
    set_velocity(m, 1, vx, -1);
    run_steps(m, 2);
    for (int k = 0; k < m->contacts; k++) {
        const bbm_contact *c = &m->contact[k];
        const bbm_vertex *P2 = end_of(m, c->edge), *P3 = start_of(m, c->edge);
        const double start = corner_vertex(m, c) == vertex_of(m, 1, 0) ? -0.5 : 0.5;
        ck_assert_int_eq(c->state, BBM_LOCK);
        ck_near(P3->x + c->anchor * (P2->x - P3->x), start + vx * gap, 1, 1e-6);
        locked++;
    }
    ck_assert_int_eq(locked, 2);
}
END_TEST

/* A locked block is pulled along a table of four pieces by a force that grows, so that its soft
 * shear springs carry its corners over the ends of the pieces. At rest the springs carry the load,
 * on whichever edge. */
START_TEST(a_locked_contact_passes_from_edge_to_edge_with_its_shear_force)
{
    const double sign = _i ? -1 : 1;
    bbm_model *m = new_blocks();
    int edges[2] = { -1, -1 }, passed = 0;

    m->par.friction = 60;
    m->par.p_s = 1e6;
    add_rectangle(m, 0, BASE, (rectangle){ -2, -1, 4, 1, .nx = 4, .fixed = 1 });
    const int e = add_rectangle(m, 1, ROCK, (rectangle){ .x = -0.5 - sign * 0.5007, .w = 1,
                                                         .h = 0.1 });
    settle(m, 5);
    for (int i = 1; i <= 10; i++) {
        ck_ok(bbm_add_load(m, vertex_of(m, e, 0)->node, sign * 300, 0), m);
        settle(m, 40);
        double T = 0;
        for (int c = 0; c < 2; c++) {
            const bbm_contact *k = contact_of(m, e, c);
            ck_assert(k && k->state == BBM_LOCK);
            T += k->T;
            passed += edges[c] >= 0 && edges[c] != k->edge;
            edges[c] = k->edge;
        }
        ck_near(fabs(T), 300 * i, 3000, 1e-6);
        ck_near(normal_force(m, 0, 1), 0.1 * DENSITY * GRAVITY, DENSITY, 1e-6);
        /* it stretches, too */
        ck_near(m->element[e].sum[0], sign * 300 * i / (2 * m->par.p_s), 1e-3, 1e-2);
    }
    ck_assert_int_eq(passed, 2);
}
END_TEST

/* A block slides over the end of a table until friction stops it; then its corner is not on the
 * table any more, and the table's corner bears in its place. Weight, friction and motion go on as
 * before: s = v0 t - g tan(phi) t^2/2. The load moves from contact to contact, by W v0 dt/2 in a
 * step, so that the springs swing by a thousandth of the weight. */
START_TEST(a_block_that_slides_over_an_end_keeps_its_forces)
{
    const double W = 0.1 * DENSITY * GRAVITY, v0 = 1, mu = tan(radians(20)), sign = _i ? -1 : 1;
    bbm_model *m = new_blocks();

    m->par.friction = 20;
    add_rectangle(m, 0, BASE, (rectangle){ .x = -1, .y = -1, .w = 2, .h = 1, .fixed = 1 });
    const int e = add_rectangle(m, 1, ROCK, (rectangle){ .x = -0.5 + sign * 0.45, .y = 0, .w = 1,
                                                         .h = 0.1 });
    settle(m, 20);
    const double start = m->element[e].sum[0];
    set_velocity(m, e, sign * v0, 0);
    for (int i = 1; i <= 25; i++) {
        const double t = 0.01 * i;
        double T = 0;
        run_steps(m, 1);
        ck_assert_int_eq(m->info.contacts, 2);
        ck_near(normal_force(m, 0, 1), W, W, 5e-3);
        for (int k = 0; k < m->contacts; k++)
            T += m->contact[k].state == BBM_SLIDE ? fabs(m->contact[k].T) : INFINITY;
        ck_near(T, normal_force(m, 0, 1) * mu, W, 1e-9);
        ck_near(sign * (m->element[e].sum[0] - start), v0 * t - mu * GRAVITY * t * t / 2, 1, 1e-4);
    }
    ck_assert(contact_of(m, e, _i ? 0 : 1) == NULL);
    run_steps(m, 30);
    ck_near(sign * (m->element[e].sum[0] - start), v0 * v0 / (2 * mu * GRAVITY), 1, 5e-4);
}
END_TEST

/* A tip that slides on from one half of a table's top to the other one, which has come to lie
 * higher: if its contact was closed it stays closed there, though deeper than others were; if it
 * was open there is none. */
START_TEST(a_corner_that_slides_on_along_a_bent_side_keeps_its_contact)
{
    const double at[2][2] = { { -1, 0 }, { -3, 0 } };
    const int was_closed_here = _i == 0;
    bbm_model *m = weightless_blocks();
    int n;

    add_rectangle(m, 0, BASE, (rectangle){ .x = -5, .y = -1, .w = 10, .h = 1, .nx = 2 });
    for (int k = 0; k < 2; k++)
        add_wedge(m, 1, at[k], radians(60), radians(120));
    set_velocity(m, 2, 1, 0);
    start_step(m, &n);
    bbm_contact *c = find_listed(m, 2 + !was_closed_here, 0, 0, 2);
    c->state = BBM_LOCK;
    c->d_n = -1e-4;
    c->N = 1e-4 * m->par.p_n;
    bbm_store_contacts(m);
    shift_element(m, 2, 1.5, -5e-4);
    start_step(m, &n);
    c = find_listed(m, 2, 0, 1, 2);
    ck_assert_int_eq(c != NULL, was_closed_here);
    ck_assert(!c || (c->state == BBM_LOCK && c->trial.was_closed));
    if (c)
        ck_near(c->rest, -5e-4 + 1e-4, 1e-4, ROUNDING);         /* so that it has its N */
}
END_TEST

/* A contact that pushes although its vertex, at the start of the step, was neither above the edge
 * nor outside it: past an end, and behind its line. x holds the vertices as they were. */
static int pushes_beside_the_edge(const bbm_model *m, const bbm_contact *c, double x[][2])
{
    const double *P = x[m->edge[c->corner].a], *A = x[m->edge[c->edge].a];
    const double *B = x[m->edge[c->edge].b];
    const double t[2] = { B[0] - A[0], B[1] - A[1] }, l = hypot(t[0], t[1]);
    const double s = ((P[0] - A[0]) * t[0] + (P[1] - A[1]) * t[1]) / l;
    const double d = ((P[0] - A[0]) * t[1] - (P[1] - A[1]) * t[0]) / l;

    return c->state != BBM_OPEN && (s < -1e-5 || s > l + 1e-5) && d < 1e-7;
}

/* Without friction, at 2 or 4 m/s, to the right or to the left. It tips over the corner; nothing
 * holds it beyond. */
START_TEST(a_block_that_slides_off_a_table_is_let_go)
{
    const double sign = _i % 2 ? -1 : 1, v0 = _i / 2 ? 4 : 2;
    double x[8][2];
    bbm_model *m = new_blocks();

    add_rectangle(m, 0, BASE, (rectangle){ .x = -1, .y = -1, .w = 2, .h = 1, .fixed = 1 });
    const int e = add_rectangle(m, 1, ROCK, (rectangle){ .x = -0.4 + 0.5 * sign, .y = 0, .w = 0.8,
                                                         .h = 0.4 });
    set_velocity(m, e, sign * v0, 0);
    for (int i = 0; i < 60; i++) {
        for (int v = 0; v < 8; v++) {
            x[v][0] = m->vertex[v].x;
            x[v][1] = m->vertex[v].y;
        }
        run_steps(m, 1);
        for (int k = 0; k < m->contacts; k++)
            ck_assert(!pushes_beside_the_edge(m, &m->contact[k], x));
    }
    ck_assert(m->element[e].sum[1] < -0.2);
    ck_assert_int_eq(m->contacts, 0);
}
END_TEST

/* The springs that take a base along begin with far more than 10^9 times the weight of the block on
 * it. No share of that may be taken for friction. */
START_TEST(the_springs_of_a_support_that_moves_let_no_contact_leave_its_cone)
{
    bbm_model *m = incline(40, 1e10, 1);

    for (int v = 0; v < 4; v++)
        bbm_move_support(m, m->vertex[v].node, 0.01, 0);
    run_steps(m, 1);
    ck_assert_int_gt(m->contacts, 0);
    for (const bbm_contact *c = m->contact; c < m->contact + m->contacts; c++)
        ck_assert(c->trial.force_tolerance < 1e-2);           /* N; the block weighs 10^4 N */
}
END_TEST

/* The springs make 5e-3 N of the last digit of a metre, where N is 10^4 N. */
START_TEST(a_block_on_very_stiff_springs_rests_on_a_slope)
{
    bbm_model *m = incline(40, 2.5e13, 1);

    run_steps(m, 40);
    ck_assert(slid(m, 1) < 1e-6);               /* of its weight on the springs */
}
END_TEST

/* ------------------------------------------------------------------------------ joints of slabs */

typedef struct {                /* slabs side by side, in a frame turned by `turn` [degree]       */
    int slabs, mesh;            /* how many; elements along each, and twice as many in the slider */
    double length, gap, lip;    /* m        of a slab; between them; of each second one           */
    double turn, slope, friction, start, v, dt, time;
} pavement;

/* How far a slider of 0.35 x 0.2 m goes on it, or on one long slab. */
static double slide_over(const pavement *p, int one)
{
    const double a = radians(p->turn), down = radians(p->turn + p->slope), l = p->length + p->gap;
    const int slabs = one ? 1 : p->slabs, mesh = p->mesh ? p->mesh : 1;
    bbm_model *m = new_blocks();

    m->par.dt = p->dt;
    m->par.friction = p->friction;
    m->par.gravity[0] = GRAVITY * sin(down);
    m->par.gravity[1] = -GRAVITY * cos(down);
    for (int k = 0; k < slabs; k++)
        add_rectangle(m, k, BASE, (rectangle){ k * l, -0.2 + k % 2 * p->lip, one ? p->slabs * l
                      : p->length, 0.2, p->turn, mesh * (one ? p->slabs : 1), 1, 1 });
    const int e = add_rectangle(m, slabs, ROCK, (rectangle){ p->start, 0, 0.35, 0.2, p->turn,
                                                             p->mesh ? 2 * mesh : 1, 1, 0 });
    for (int k = e; k < m->elements; k++)
        set_velocity(m, k, p->v * cos(a), p->v * sin(a));
    run_steps(m, (int)(p->time / p->dt + 0.5));
    const double way = m->element[e].sum[0] * cos(a) + m->element[e].sum[1] * sin(a);
    release(m);
    return way;
}

/* Two slabs; rows of short ones, shorter than a step; gaps and lips; in the first step; on slopes,
 * in turned frames; meshes. */
static const pavement PAVEMENTS[] = {
    { 2, 0, 1.0, 0, 0, 0, 0, 0, 0.033, 1, 0.001, 1.2 },
    { 2, 0, 1.0, 0, 0, 0, 0, 0, 0.6, 5, 0.01, 0.15 },
    { 2, 0, 1.0, 0, 0, 90, 0, 0, 0.65, 1e-3, 0.001, 0.2 },
    { 2, 0, 1.0, 0, 0, 301, 25, 20, 0.65, 1e-3, 0.001, 0.4 },
    { 2, 0, 1.0, 0, 1e-6, 45, 10, 0, 0.4, 0.5, 0.003, 0.6 },
    { 2, 0, 1.0, 1e-2, 0, 0, 0, 20, 0.4, 3, 0.001, 0.4 },
    { 40, 0, 0.0137, 0, 0, 133, 0, 30, 0.05, 2, 0.001, 0.05 },
    { 110, 0, 0.004, 0, 0, 0, 0, 0, 0.005, 1, 0.01, 0.07 },
    { 10, 0, 0.1, 1e-2, 0, 17, 5, 0, 0.05, 2, 0.001, 0.3 },
    { 3, 4, 0.4, 0, 0, 0, 0, 10, 0.01, 2, 0.001, 0.35 },
};

START_TEST(a_block_slides_over_the_joints_of_slabs_as_over_one_slab)
{
    const pavement *p = &PAVEMENTS[_i];
    const double one = slide_over(p, 1);

    /* A micrometre: the slider tilts by as much, where a lip lifts it. */
    ck_near(slide_over(p, 0), one, 1, 1e-6);
}
END_TEST

/* A step of 1 mm: the slider goes 0.2 m to it, and no further. */
START_TEST(a_step_between_two_slabs_stops_a_block)
{
    const pavement p = { 2, 0, 1, 0, 1e-3, _i * 77, 0, 0, 0.45, 1, _i % 2 ? 0.01 : 0.001, 0.4 };

    ck_assert_double_le(slide_over(&p, 0), 0.2 + 1e-3);     /* m: the contact gives way */
}
END_TEST

Suite *sliding_suite(void)
{
    Suite *s = suite_create("sliding");

    add_case(s, "contacts in K",
        { a_closed_contact_adds_its_springs_or_its_friction_to_K_and_F, 3 });
    add_case(s, "friction",
        { a_block_slides_down_an_incline_as_the_closed_form_says, 2 * COUNT(SLIDING) },
        { the_plain_way_to_agree_finds_the_same_friction, 1 },
        { a_block_comes_to_rest_against_a_stop_in_statics, 3 },
        { a_matrix_that_is_not_symmetric_is_solved_or_refused, 4 },
        { friction_in_the_matrix_is_solved_with_every_method, 4 },
        { a_block_thrown_uphill_stops_where_it_should_and_stays_there, 1 },
        { a_block_whose_friction_angle_is_above_the_slope_stays, 4 },
        { a_block_on_a_slope_slides_or_topples_as_the_chart_says, COUNT(CHART) },
        { friction_may_drop_with_the_slip, 2 },
        { blocks_that_slide_on_floors_apart_slide_alike, 1 },
        { the_springs_of_a_support_that_moves_let_no_contact_leave_its_cone, 1 },
        { a_block_on_very_stiff_springs_rests_on_a_slope, 1 });
    add_case(s, "anchors",
        { a_locked_contact_keeps_its_anchor, 1 },
        { a_sliding_contact_takes_its_anchor_along, 1 },
        { a_contact_is_anchored_where_it_hit, 2 },
        { a_locked_contact_passes_from_edge_to_edge_with_its_shear_force, 2 },
        { a_block_that_slides_over_an_end_keeps_its_forces, 2 },
        { a_corner_that_slides_on_along_a_bent_side_keeps_its_contact, 2 },
        { a_block_that_slides_off_a_table_is_let_go, 4 });
    add_case(s, "joints of slabs",
        { a_block_slides_over_the_joints_of_slabs_as_over_one_slab, COUNT(PAVEMENTS) },
        { a_step_between_two_slabs_stops_a_block, 4 });
    return s;
}
