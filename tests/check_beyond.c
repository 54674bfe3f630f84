/* check_beyond.c - what goes beyond the paper: bonds that do not give (multipliers), quadrilaterals
 * that bend. */
#include <string.h>

#include "check.h"
#include "models.h"

static const double E = 30e6, NU = 0.3;

/* A mesh of nx x ny cells of w x h on the x axis, quadrilaterals or two triangles each, inner nodes
 * moved by `shake` of a cell. Node (i, j) is j (nx + 1) + i. */
typedef struct { int nx, ny, triangles; double w, h, shake; } mesh;

static bbm_model *make(const mesh *g, double alpha, int augment, bbm_bonding bonding)
{
    grid cells = { .y = -g->h * g->ny / 2, .lx = g->w * g->nx, .ly = g->h * g->ny, .nx = g->nx,
                   .ny = g->ny, .triangles = g->triangles, .jitter = g->shake };
    bbm_model *m = beyond_model();

    m->par.alpha = alpha;
    m->beyond->multiplier_rounds = augment;
    m->beyond->bonding = bonding;
    m->par.pcg.tolerance = 1e-13;
    m->par.pcg.iterations = 1000;  /* several times what is needed: an error ends at once */
    bbm_add_material(m, &(bbm_material){ E, NU, 1000, 1 }, NULL);
    add_grid(m, &cells, 0);
    return m;
}

enum { MOMENTS, MIDDLES, VERTICES };    /* what holds two sides together */

static bbm_model *make_bonded(const mesh *g, double alpha, int augment, int way)
{
    bbm_model *m = make(g, alpha, augment, way < VERTICES ? BBM_MOMENT : BBM_VERTICES);

    if (way == MIDDLES)
        m->hook->list_gaps = list_middles;
    return m;
}

static int right(const mesh *g, int j)
{
    return j * (g->nx + 1) + g->nx;
}

/* ---------------------------------------------------------------------------------- multipliers */

static double distance_after(double alpha, int augment)
{
    const mesh g = { 16, 4, 1, 1, 1, 0.2 };
    bbm_model *m = make(&g, alpha, augment, BBM_MOMENT);

    for (int j = 0; j <= g.ny; j++)
        bbm_fix_node(m, j * (g.nx + 1), BBM_XY, 0, 0);
    bbm_add_load(m, right(&g, 2), 100, -1000);
    ck_ok(bbm_prepare(m), m);
    return distance_from_finite_element(m);
}

START_TEST(with_two_more_solutions_bonded_triangles_are_the_finite_element)
{
    /* Each round leaves at most about 3/alpha of the gaps before it: 1e-6 is the promise at
     * alpha = 100. */
    ck_assert_double_lt(distance_after(100, 2), 1e-6);
    ck_assert_double_lt(distance_after(1000, 2), 1e-8);
    ck_assert_double_lt(distance_after(10, 8), 1e-6);
    ck_assert_double_gt(distance_after(100, 0), 5e-3);  /* the paper's springs give */
    ck_assert_double_lt(distance_after(100, 1),
                        distance_after(100, 0) / 20);
}
END_TEST

START_TEST(the_multiplier_of_a_bond_is_the_force_that_it_carries)
{
    const mesh g = { 5, 1, 0, 1, 1, 0 };
    bbm_model *m = make(&g, 10, 20, BBM_VERTICES);

    bbm_fix_node(m, 0, BBM_XY, 0, 0);
    bbm_fix_node(m, 6, BBM_X, 0, 0);
    bbm_add_load(m, right(&g, 0), 500, 0);
    bbm_add_load(m, right(&g, 1), 500, 0);
    run(m);
    for (int b = 0; b < 2 * m->bonds; b++) {
        /* i pulls j with what pulls the bar; which of the two is i says the sign. 1e-9: twenty
         * solutions. */
        ck_near(fabs(m->gap[b].own.f[0]), 500, 500, 1e-9);
        ck_near(m->gap[b].own.f[1], 0, 500, 1e-9);
    }
    ck_relative(result_at(m, right(&g, 0)).u, 1000 * 5 / E, 1e-9); /* F L/(E A), no springs in it */
}
END_TEST

/* A block of one element hangs on the springs of its two upper corners, k in all, and falls to rest
 * quasi-statically. At rest they carry the weight W: gap W/k. Its inertia in a step is
 * c = 2 m/dt^2. The element is 30 MPa/230 N/m = 1e5 times stiffer. */
START_TEST(in_dynamics_multipliers_have_no_part)
{
    const double dt = 3, g = 1e-3, weight = 1000 * g, alpha = 1e-5;
    const double k = 2 * alpha * E / (2 * (1 + NU)), c = 2 * 1000 / (dt * dt);
    bbm_model *m = make(&(mesh){ 1, 1, 0, 1, 1, 0 }, alpha, 2 * _i, BBM_VERTICES);

    for (int i = 0; i < 2; i++)
        bbm_fix_node(m, 2 + i, BBM_XY, 0, 0);
    m->par.gravity[1] = -g;
    m->par.dt = dt;
    m->par.velocity_factor = 0;
    m->par.steps = (int)(30 * (c + k) / k);     /* each leaves the share c/(c + k): e^-30 in all */
    run(m);
    ck_relative(m->vertex[2].v, -weight / k, 1e-4);
}
END_TEST

/* --------------------------------------------------------------------- quadrilaterals that bend */

static void end_shear(double x, double y, const void *unused, double f[2])
{
    (void)x, (void)unused;
    f[0] = 0;
    f[1] = -1000 / 288.0 * (36 - y * y);
}

/* Experiment I, load b: the tip of the beam over the converged finite element's -8.906623439e-3 m,
 * less 1. */
static double tip_error(int n, double shake, int way)
{
    const mesh g = { 24 * n, 6 * n, 0, 2.0 / n, 2.0 / n, shake };
    bbm_model *m = make_bonded(&g, 100, 2, way);

    m->par.pcg.tolerance = 1e-9;
    for (int j = 0; j <= g.ny; j++)
        bbm_fix_node(m, j * (g.nx + 1), BBM_XY, 0, 0);
    for (int j = 0; j < g.ny; j++)
        bbm_add_varying_line_load(m, right(&g, j), right(&g, j + 1), end_shear, NULL);
    run(m);
    const double v = result_at(m, right(&g, g.ny / 2)).v;
    release(m);
    return v / -8.906623439e-3 - 1;
}

START_TEST(a_beam_of_few_quadrilaterals_bends_as_it_should_also_when_they_are_distorted)
{
    ck_assert_double_lt(fabs(tip_error(1, 0, MOMENTS)), 3.5e-3);       /* the promise */
    ck_assert_double_lt(fabs(tip_error(1, 0.2, MOMENTS)), 3.5e-3);
    ck_assert_double_lt(fabs(tip_error(2, 0.2, MOMENTS)), 1.5e-3);     /* finer is better */
}
END_TEST

/* Without moments n rows lack the 1/n^2 of the beam's bending stiffness that is inside each of
 * them: the beam of 6 and of 12 rows bends too much by nearly that, for it shears, too. */
START_TEST(a_beam_without_the_moments_of_its_bonds_is_too_soft_by_what_its_rows_lack)
{
    const double rows = _i ? 12 : 6, lacks = 1 / (rows * rows);

    ck_near(tip_error(_i ? 2 : 1, 0, MIDDLES), lacks / (1 - lacks), lacks, 0.1);
}
END_TEST

/* Rectangles w_i x h_j that turn by t_ij = (-1)^(i+j) c/(w_i h_j) about their centres stay together
 * in the middles of all their sides: no bond there feels it. The opening of the sides does. */
START_TEST(a_chequerboard_of_turns_costs_bonds_at_midpoints_nothing)
{
    const mesh g = { 4, 3, 0, 1, 1, 0 };
    bbm_model *m = make_bonded(&g, 100, 0, MIDDLES);
    const double x[5] = { 0, 1, 1.5, 3, 4.25 }, y[4] = { 0, 2, 2.25, 3 };

    for (int v = 0; v < m->vertices; v++) {
        m->vertex[v].x = x[m->vertex[v].node % 5];
        m->vertex[v].y = y[m->vertex[v].node / 5];
    }
    for (int e = 0; e < m->elements; e++)
        bbm_element_geometry(&m->element[e], &m->vertex[m->element[e].first]);
    ck_ok(bbm_prepare(m), m);
    for (int e = 0; e < m->elements; e++)
        m->D[6 * e + 2] = ((e % 4 + e / 4) % 2 ? -1 : 1) / m->element[e].A;
    ck_assert_int_eq(m->gaps, 2 * m->bonds);
    for (int k = 0; k < m->gaps; k++) {
        double d[2];
        bbm_gap_length(m, &m->gap[k], d);
        if (!m->gap[k].elastic)
            ck_assert_double_lt(hypot(d[0], d[1]), 1e-14);      /* rounding of numbers near 1 */
        else
            ck_assert_double_gt(hypot(d[0], d[1]), 0.1);
    }
}
END_TEST

START_TEST(distorted_quadrilaterals_pass_the_patch_test_however_they_are_bonded)
{
    const mesh g = { 5, 4, 0, 1, 1, 0.25 };
    /* the openings of finite springs do not fit */
    bbm_model *m = make_bonded(&g, 1000, 5, _i);

    bbm_fix_node(m, 0, BBM_XY, 0, 0);
    bbm_fix_node(m, 12, BBM_X, 0, 0);        /* the side from 0 to 6 is held in its middle alone */
    for (int j = 0; j < 4; j++) {
        bbm_add_line_load(m, right(&g, j), right(&g, j + 1), 2e3, 1e3);
        bbm_add_line_load(m, j * 6, (j + 1) * 6, -2e3, -1e3);
    }
    for (int i = 0; i < 5; i++) {
        bbm_add_line_load(m, i, i + 1, -1e3, 0);
        bbm_add_line_load(m, 24 + i, 25 + i, 1e3, 0);
    }
    run(m);
    for (int e = 0; e < m->elements; e++) {  /* 1e-8: what the solver leaves */
        ck_near(m->element[e].stress[0], 2e3, 2e3, 1e-8);
        ck_near(m->element[e].stress[1], 0, 2e3, 1e-8);
        ck_near(m->element[e].stress[2], 1e3, 2e3, 1e-8);
    }
}
END_TEST

/* The energy of an edge bond from the moved points alone. */
static double edge_energy(const bbm_model *m, double W[2][2][2], const double D[12])
{
    double gap[2][2], energy = 0;

    for (int end = 0; end < 2; end++) {
        const bbm_vertex *P = &m->vertex[m->bond[0].p[end]], *Q = &m->vertex[m->bond[0].q[end]];
        const bbm_element *i = &m->element[m->bond[0].i], *j = &m->element[m->bond[0].j];
        const double X = P->x - i->x, Y = P->y - i->y, S = Q->x - j->x, T = Q->y - j->y, *d = D + 6;
        gap[end][0] = P->u + D[0] - D[2] * Y + D[3] * X + D[5] * Y / 2 -
                      (Q->u + d[0] - d[2] * T + d[3] * S + d[5] * T / 2);
        gap[end][1] = P->v + D[1] + D[2] * X + D[4] * Y + D[5] * X / 2 -
                      (Q->v + d[1] + d[2] * S + d[4] * T + d[5] * S / 2);
    }
    for (int a = 0; a < 2; a++)
        for (int b = 0; b < 2; b++)
            energy += W[0][a][b] * (gap[0][a] + gap[1][a]) * (gap[0][b] + gap[1][b]) / 8
                    + W[1][a][b] * (gap[0][a] - gap[1][a]) * (gap[0][b] - gap[1][b]) / 8;
    return energy;
}

START_TEST(the_edge_submatrices_are_derivatives_of_the_edge_energy)
{
    const mesh g = { 2, 1, 0, 1.5, 1, 0 };
    double W[2][2][2] = { { { 3, 0.5 }, { 0.5, 2 } }, { { 1, -0.3 }, { -0.3, 4 } } };
    bbm_model *m = make(&g, 100, 0, BBM_MOMENT);
    unsigned seed = 14;
    bbm_submatrices s;
    bbm_gap end[2];
    double D[12] = { 0 }, K[12][12];

    ck_ok(bbm_prepare(m), m);
    for (int v = 0; v < m->vertices; v++) {
        m->vertex[v].u = random_number(&seed) / 2;
        m->vertex[v].v = random_number(&seed) / 2;
    }
    memset(&s, 0, sizeof s);
    const bbm_bond *b = &m->bond[0];
    for (int n = 0; n < 2; n++)
        bbm_bonding_gap(&m->element[b->i], &m->vertex[b->p[n]], &m->element[b->j],
                        &m->vertex[b->q[n]], 1, &end[n]);
    for (int k = 0; k < 2; k++) {
        bbm_gap gap = { .i = b->i, .j = b->j };
        bbm_edge_gap(end, k == 0 ? 1 : -1, W[k], &gap);
        bbm_bonding_submatrices(&gap, &s);
    }
    for (int a = 0; a < 6; a++)
        for (int c = 0; c < 6; c++) {
            K[a][c] = s.Kii[a][c];
            K[a][c + 6] = s.Kij[a][c];
            K[a + 6][c] = s.Kij[c][a];
            K[a + 6][c + 6] = s.Kjj[a][c];
        }
    /* The energy is quadratic: differences over a step of 1 are exact but for rounding. */
    for (int a = 0; a < 12; a++) {
        D[a] = 1;
        const double up = edge_energy(m, W, D);
        D[a] = -1;
        const double down = edge_energy(m, W, D);
        D[a] = 0;
        ck_near(-(a < 6 ? s.Fi[a] : s.Fj[a - 6]), (up - down) / 2, 1, 1e-12);
        for (int c = 0; c < 12; c++) {
            double mixed = 0;
            for (int q = 0; q < 4; q++) {
                const double x = q % 2 ? 1 : -1, y = q / 2 ? 1 : -1;
                D[a] += x, D[c] += y;
                mixed += x * y * edge_energy(m, W, D) / 4;
                D[a] = D[c] = 0;
            }
            ck_near(K[a][c], mixed, 1, 1e-12);
        }
    }
}
END_TEST

START_TEST(the_moment_of_a_rectangle_is_that_of_a_beam)
{
    /* nu = 0: an edge of length l between centres w apart resists like a beam, M = E t l/(3 w)
     * along its normal: the energy 1/2 M dd^2 with dd = l/2 times the angle is 1/2 (E t
     * l^3/12/w) angle^2. */
    const double w = 2, l = 3;
    bbm_element e = { .n = 4, .material = { 1e7, 0, 1, 0.5 } };
    const bbm_vertex v[4] = { { .x = 0, .y = 0 }, { .x = w, .y = 0 }, { .x = w, .y = l },
                              { .x = 0, .y = l } };
    double M[2][2][2];

    bbm_element_geometry(&e, v);
    bbm_bending_moments(&e, v, M);
    ck_relative(M[1][0][0], 1e7 * 0.5 * l / (3 * w), 1e-12);
    ck_relative(M[0][1][1], 1e7 * 0.5 * w / (3 * l), 1e-12);
    ck_near(M[1][1][1], 0, 1e7, 1e-12);
    ck_near(M[0][0][0], 0, 1e7, 1e-12);
    ck_near(M[1][0][1], 0, 1e7, 1e-12);
}
END_TEST

START_TEST(a_turning_body_feels_no_moment_in_its_bonds)
{
    const mesh g = { 4, 2, 0, 1, 1, 0.2 };
    bbm_model *m = make(&g, 100, _i, BBM_MOMENT);

    m->par.dt = 0.01;
    m->par.velocity_factor = 1;
    m->par.steps = 100;
    ck_ok(bbm_prepare(m), m);
    for (int e = 0; e < m->elements; e++) {  /* turning about (2, 0) at 1 rad/s */
        m->element[e].V[0] = -m->element[e].y;
        m->element[e].V[1] = m->element[e].x - 2;
        m->element[e].V[2] = 1;
    }
    ck_ok(bbm_run(m), m);
    double spin = 0;
    for (int e = 0; e < m->elements; e++) {
        spin += m->element[e].V[2] / m->elements;
        /* The scheme holds the acceleration over the step: the centripetal force lags, and
         * stretches by rho w^2 r^2. */
        ck_near(m->element[e].stress[0], 0, 1000 * 4, 1.5);
        ck_near(m->element[e].stress[2], 0, 1000 * 4, 1.5);
    }
    ck_near(spin, 1, 1, 0.02);  /* it loses w dt of its energy a turn: 1 % */
}
END_TEST

/* ------------------------------------------------------------------------------------- energies */

START_TEST(the_work_of_the_loads_is_twice_the_energy_of_elements_and_springs)
{
    const mesh g = { 4, 2, _i % 4 == 3, 1.5, 1, 0.2 };
    bbm_model *m = make_bonded(&g, 20, 0, _i % 4);
    bbm_energy energy;

    for (int n = 6; n < 8 && _i >= 4; n++)  /* an edge that is not along x or y */
        bbm_fix_node(m, n, BBM_XY, 0, 0);
    bbm_fix_node(m, 0, BBM_XY, 0, 0);
    bbm_fix_node(m, 5, BBM_X, 0, 0);
    bbm_fix_node(m, 10, BBM_X, 0, 0);
    bbm_fix_node(m, 14, BBM_Y, 0, 0);
    bbm_fix_node(m, 13, BBM_Y, 0, 0);
    bbm_add_load(m, 4, 0.3, -0.7);
    bbm_add_load(m, 12, -0.2, 0.5);
    run(m);
    bbm_energies(m, &energy);
    ck_assert_double_gt(energy.elastic, 0);
    ck_assert_double_gt(energy.springs, 0);
    ck_near(energy.kinetic, 0, energy.elastic, 1e-12);
    /* Clapeyron; one step of statics is linear, but the moments are those of the moved shape:
     * strains of 1e-8. */
    ck_relative(energy.elastic + energy.springs, m->beyond->work / 2, 1e-7);
}
END_TEST

START_TEST(fixed_points_away_from_their_walls_hold_the_energy_of_their_springs)
{
    const mesh g = { 1, 1, 0, 1, 1, 0 };
    bbm_model *m = make(&g, 20, 0, BBM_VERTICES);
    bbm_energy energy;

    bbm_fix_node(m, 0, BBM_XY, 0.1, -0.2);
    bbm_fix_node(m, 1, BBM_X, 0.3, 9);
    bbm_fix_node(m, 3, BBM_Y, 9, 0.4);
    ck_ok(bbm_prepare(m), m);
    bbm_energies(m, &energy);
    const double k = 20 * E / (2 * (1 + NU));
    ck_relative(energy.springs, k / 2 * (0.01 + 0.04 + 0.09 + 0.16), 1e-12);
}
END_TEST

/* Walls that turn by a small angle about the origin take the body along: it has no strain, no bond
 * is open. */
START_TEST(a_body_that_follows_its_walls_holds_no_energy)
{
    const mesh g = { 3, 2, _i == 3, 1.5, 1, 0.2 };
    const double turn = 0.01;
    bbm_model *m = make_bonded(&g, 20, 0, _i);
    bbm_energy energy;

    for (int n = 0; n < m->nodes; n++)
        if (n % 4 == 0 || n / 4 == 2)  /* all of the left side and of the upper one */
            bbm_fix_node(m, n, BBM_XY, -turn * m->node[n].y, turn * m->node[n].x);
    run(m);
    bbm_energies(m, &energy);
    /* a spring that is open by its turning */
    const double opened = 20 * E / (2 * (1 + NU)) * turn * turn;
    ck_near(energy.springs, 0, opened, 1e-9);  /* gaps of 1e-13, squared, and rounding */
    ck_near(energy.elastic, 0, opened, 1e-9);
}
END_TEST

START_TEST(the_kinetic_energy_is_that_of_the_motion)
{
    const mesh g = { 1, 1, 0, 2, 1, 0 };
    bbm_model *m = make(&g, 20, 0, BBM_VERTICES);
    const double mass = 1000 * 2, inertia = mass * (4 + 1) / 12.0;
    bbm_energy energy;

    m->par.dt = 0.01;
    m->par.velocity_factor = 0.5;
    ck_ok(bbm_prepare(m), m);
    m->element[0].V[0] = 3;
    m->element[0].V[1] = -4;
    m->element[0].V[2] = 0.5;
    bbm_energies(m, &energy);
    ck_relative(energy.kinetic, mass * 25 / 2 + inertia * 0.25 / 2, 1e-12);
    ck_ok(bbm_step(m), m);  /* free flight; the energy is that before half of V is taken away */
    bbm_energies(m, &energy);
    ck_relative(energy.kinetic, mass * 25 / 2 + inertia * 0.25 / 2, 1e-9);
    m->par.velocity_factor = 0;  /* quasi-static: from rest, g dt at the end of the step */
    m->par.gravity[1] = -10;
    ck_ok(bbm_step(m), m);
    ck_ok(bbm_step(m), m);
    bbm_energies(m, &energy);
    ck_relative(energy.kinetic, mass * 0.1 * 0.1 / 2, 1e-9);
}
END_TEST

START_TEST(closed_contacts_hold_the_energy_of_their_springs)
{
    const double W = DENSITY * GRAVITY;
    bbm_model *m = new_blocks();
    bbm_energy energy;

    m->par.dt = INFINITY;
    m->par.alpha = 1e4;
    m->par.p_n = 1e8;
    m->par.friction = 30;
    m->material[ROCK].E = 1e12;
    add_table(m, 0);
    add_rectangle(m, 1, ROCK, (rectangle){ .w = 1, .h = 1 });
    run(m);
    bbm_energies(m, &energy);
    /* The weight on two springs: 2 (W/2)^2/(2 p_n); the base and the block, E = 1e12, have less than
     * 1e-4 of it. */
    ck_relative(energy.springs + energy.elastic, W * W / (4 * 1e8), 2e-3);
    ck_relative(energy.springs + energy.elastic, m->beyond->work / 2, 1e-6);
}
END_TEST

/* A block of two quadrilaterals lies on a table with its two corners and the node between them. Both
 * carry half of what they weigh, whichever of them that corner belongs to. */
START_TEST(a_contact_between_two_quadrilaterals_presses_both_alike)
{
    bbm_model *m = new_blocks();

    m->par.faces = 1;
    m->par.dt = _i ? INFINITY : m->par.dt;
    add_table(m, 0);
    const int e = add_rectangle(m, 1, ROCK, (rectangle){ .x = -1, .w = 2, .h = 1, .nx = 2 });
    settle(m, _i ? 5 : 100);
    ck_assert_int_eq(m->info.contacts, 3);
    for (int k = 0; k < 2; k++) {
        ck_relative(m->element[e + k].stress[1], -DENSITY * GRAVITY / 2, 1e-4);
        ck_relative(vertex_of(m, e, 0)->v, vertex_of(m, e + 1, 1)->v, 1e-6);
    }
}
END_TEST

/* Two blocks of 2 m x 1 m lie on each other, two quadrilaterals below a quadrilateral and two triangles, or mirrored. Where
 * these meet at the joint, the element between the two whose sides lie on it has no side there. Under an even pressure the
 * stress is even, but for the gaps of the contacts. */
START_TEST(a_contact_below_both_kinds_presses_all_their_elements_alike)
{
    static const int corners[5][4] = { { 0, 1, 4, 3 }, { 1, 2, 5, 4 }, { 6, 7, 10, 9 }, { 7, 8, 11, 0 }, { 7, 11, 10, 0 } };
    const double side = _i ? -1 : 1;
    bbm_model *m = new_model(&(bbm_material){ 1e9, 0, 2500, 1 });

    m->beyond->bonding = BBM_MOMENT;
    m->beyond->multiplier_rounds = 2;
    m->par.faces = 1;
    m->par.dt = INFINITY;
    m->par.friction = 30;
    set_springs(m, 5e10, 2e10);
    for (int n = 0; n < 12; n++)
        bbm_add_node(m, side * (n % 3), (n + 3) / 6, NULL);
    for (int e = 0; e < 5; e++)
        bbm_add_element(m, e / 2 > 0, 0, e < 3 ? 4 : 3, corners[e], NULL);
    for (int n = 0; n < 3; n++)
        bbm_fix_node(m, n, n == 0 ? BBM_XY : BBM_Y, 0, 0);
    prepare(m);
    for (int e = 0; e < m->edges; e++)
        if (m->vertex[m->edge[e].a].node > 8 && m->vertex[m->edge[e].b].node > 8)
            ck_ok(bbm_load_edge(m, e, 0, 0, 1e4), m);
    run_steps(m, 10);
    ck_assert_int_eq(m->info.contacts, 3);
    for (int e = 0; e < 5; e++)
        ck_relative(m->element[e].stress[1], -1e4, 2e-3);
    release(m);
}
END_TEST

/* A rectangle hits the side of two triangles, and they its corner. In the mirror image the edges run the other way, but
 * the hit is the same, to the rounding of positions. */
START_TEST(what_hits_a_corner_of_two_triangles_does_so_in_a_mirror_too)
{
    static const double x[8][2] = { { 0, 0 }, { 1, 0 }, { 1, 0.6 }, { 0, 0.6 }, { 1.00001, 0.154 }, { 2.00001, 0.154 },
                                    { 2.00001, 0.854 }, { 1.00001, 0.854 } };
    bbm_model *m[2];

    for (int k = 0; k < 2; k++) {
        m[k] = new_model(&(bbm_material){ 1e9, 0.2, 2500, 1 });
        m[k]->beyond->bonding = BBM_MOMENT;
        m[k]->par.dt = 1e-4;
        m[k]->par.velocity_factor = 1;
        set_springs(m[k], 5e10, 2e10);
        for (int n = 0; n < 8; n++)
            bbm_add_node(m[k], (k ? -1 : 1) * x[n][0], x[n][1], NULL);
        bbm_add_element(m[k], 0, 0, 4, (int[]){ 0, 1, 2, 3 }, NULL);
        bbm_add_element(m[k], 1, 0, 3, (int[]){ 4, 5, 6 }, NULL);
        bbm_add_element(m[k], 1, 0, 3, (int[]){ 4, 6, 7 }, NULL);
        prepare(m[k]);
        m[k]->element[0].V[0] = k ? -0.15 : 0.15;
        run_steps(m[k], 5);
    }
    ck_assert_double_lt(m[0]->element[0].V[0], 0.149);
    for (int e = 0; e < 3; e++) {
        ck_near(m[0]->element[e].V[0], -m[1]->element[e].V[0], 0.15, 1e-9);
        ck_near(m[0]->element[e].V[1], m[1]->element[e].V[1], 0.15, 1e-9);
        ck_near(m[0]->element[e].V[2], -m[1]->element[e].V[2], 0.15, 1e-9);
    }
    release(m[0]);
    release(m[1]);
}
END_TEST

/* A cap that a support drags over a wall of two quadrilaterals: the side on which it slides ends in a node of both, and where
 * their bond has opened the shear of the jump counts from the middle. In the mirror image that side runs the other way. */
START_TEST(what_a_support_drags_over_two_elements_goes_the_same_way_in_a_mirror)
{
    bbm_model *m[2];
    int e[2];

    for (int k = 0; k < 2; k++) {
        m[k] = new_blocks();
        m[k]->beyond->bonding = BBM_MOMENT;
        m[k]->par.friction = 35;
        m[k]->par.dt = 1e-3;
        add_table(m[k], 0);
        add_rectangle(m[k], 1, ROCK, (rectangle){ .x = k ? -1 : 0, .y = 0, .w = 1, .h = 3, .nx = 2 });
        e[k] = add_rectangle(m[k], 2, ROCK, (rectangle){ .x = k ? -0.85 : 0.05, .y = 3, .w = 0.8, .h = 0.4 });
        for (int v = 2; v < 4; v++)
            bbm_fix_node(m[k], vertex_of(m[k], e[k], v)->node, BBM_X, 0, 0);
        prepare(m[k]);
        for (int v = 2; v < 4; v++)
            bbm_move_support(m[k], vertex_of(m[k], e[k], v)->node, k ? -6e-5 : 6e-5, 0);
        run_steps(m[k], 1);
    }
    for (int a = 0; a < 3; a++)
        ck_near(m[0]->element[e[0]].V[a], (a == 1 ? 1 : -1) * m[1]->element[e[1]].V[a], 0.06, 1e-8);
    release(m[0]);
    release(m[1]);
}
END_TEST

/* Triangles lie on triangles, whose sides end elsewhere: each contact presses up to five elements. Were the bonds of these
 * left out of Kc there, so would be what the contact has between them, and it would take 32 iterations for 12. */
START_TEST(triangles_in_contact_take_few_iterations)
{
    grid g[2] = { { .x = -2, .y = -2, .lx = 4, .ly = 2, .nx = 7, .ny = 4, .triangles = 1 },
                  { .x = -1.5, .lx = 3, .ly = 2, .nx = 8, .ny = 4, .triangles = 1 } };
    bbm_model *m = new_blocks();

    m->beyond->bonding = BBM_MOMENT;
    m->par.faces = 1;
    m->par.alpha = 1000;
    m->par.pcg.tolerance = 1e-10;
    for (int k = 0; k < 2; k++)
        add_grid(m, &g[k], k);
    for (int n = 0; n <= 7; n++)
        bbm_fix_node(m, node_at(&g[0], n, 0), BBM_XY, 0, 0);
    set_springs(m, 5e15, 2e15);
    prepare(m);
    run_steps(m, 3);
    ck_assert_int_ge(m->info.contacts, 5);
    ck_assert_int_le(m->info.pcg.iterations, 18);
    release(m);
}
END_TEST

/* An equal block of nx x ny quadrilaterals lies on one that is held below, nodes on nodes: what is
 * symmetric is so in the lower block, too, and of two columns each carries its own. */
static const struct { int nx, ny, is_static; double friction; } PILES[] = {
    { 2, 1, 1, 30 }, { 2, 1, 0, 30 }, { 2, 1, 0, 0 }, { 3, 2, 1, 30 }, { 3, 2, 0, 0 },
};

START_TEST(a_block_of_quadrilaterals_presses_an_equal_one_below_it_alike_on_both_sides)
{
    const int nx = PILES[_i].nx, ny = PILES[_i].ny;
    bbm_model *m = new_blocks();

    m->par.faces = 1;
    m->par.friction = PILES[_i].friction;
    m->par.dt = PILES[_i].is_static ? INFINITY : m->par.dt;
    const int e = add_rectangle(m, 0, ROCK, (rectangle){ .w = nx, .h = ny, .nx = nx, .ny = ny });
    add_rectangle(m, 1, ROCK, (rectangle){ .y = ny, .w = nx, .h = ny, .nx = nx, .ny = ny });
    for (int n = 0; n <= nx; n++)
        ck_ok(bbm_fix_node(m, n, BBM_XY, 0, 0), m);
    settle(m, PILES[_i].is_static ? 5 : 200);
    ck_assert_int_eq(m->info.contacts, nx + 1);
    for (int k = 0; k < nx * ny; k++) {
        const double *s = m->element[e + k].stress;
        const double *mirrored = m->element[e + k / nx * nx + nx - 1 - k % nx].stress;
        const double weight = DENSITY * GRAVITY * (2 * ny - k / nx - 0.5);
        ck_near(s[1], mirrored[1], weight, 1e-4);
        ck_near(s[1], -weight, weight, nx == 2 ? 1e-3 : 0.2);   /* of three the middle one has more */
    }
}
END_TEST

/* Where D moves the vertices at a node of a vertex to, in the mean; `way` times. */
static void moved_node(const bbm_model *m, const double *D, double way, const bbm_vertex *of, double p[2])
{
    const int first = m->adjacent_first[of->node], n = m->adjacent_first[of->node + 1] - first;

    p[0] = p[1] = 0;
    for (int k = first; k < first + n; k++) {
        const bbm_vertex *v = &m->vertex[m->adjacent[k]];
        const bbm_element *e = &m->element[v->element];
        const double X = v->x - e->x, Y = v->y - e->y, *d = D + 6 * v->element;
        p[0] += (v->x + way * (d[0] - d[2] * Y + d[3] * X + d[5] * Y / 2)) / n;
        p[1] += (v->y + way * (d[1] + d[2] * X + d[4] * Y + d[5] * X / 2)) / n;
    }
}

/* The energy of a locked contact's springs 3 and 2 with the linear distances of (57), (61). */
static double touch_energy(const bbm_model *m, const bbm_contact *c, const double *D)
{
    double p[3][3][2], S[3];

    for (int w = 0; w < 3; w++) {
        moved_node(m, D, w - 1, corner_vertex(m, c), p[w][0]);
        moved_node(m, D, w - 1, end_of(m, c->edge), p[w][1]);
        moved_node(m, D, w - 1, start_of(m, c->edge), p[w][2]);
        S[w] = (p[w][1][0] - p[w][0][0]) * (p[w][2][1] - p[w][0][1])
             - (p[w][2][0] - p[w][0][0]) * (p[w][1][1] - p[w][0][1]);
    }
    const double x = p[1][2][0] - p[1][1][0], y = p[1][2][1] - p[1][1][1], l = hypot(x, y), r = c->anchor;
    const double d_n = (S[1] + (S[2] - S[0]) / 2) / l - c->rest;
    const double u = p[2][0][0] - (1 - r) * p[2][2][0] - r * p[2][1][0];
    const double v = p[2][0][1] - (1 - r) * p[2][2][1] - r * p[2][1][1];
    return 3 * d_n * d_n / 2 + 2 * pow((u * x + v * y) / l, 2) / 2;
}

static double touches_energy(const bbm_model *m, const double *D)
{
    double sum = 0;

    for (int k = 0; k < m->scratch->contacts; k++)
        sum += touch_energy(m, &m->scratch->contact[k], D);
    return sum;
}

/* The same block on a table, or on three quadrilaterals; all bonds are torn apart. P1 of the contact
 * in the middle is halfway between, and on quadrilaterals the ends of its edge are, too. */
START_TEST(the_submatrices_of_a_contact_between_two_quadrilaterals_are_derivatives_of_its_energy)
{
    enum { MOST = 5 * 6 };
    bbm_model *m = weightless_blocks();
    double D[MOST] = { 0 }, column[MOST] = { 0 }, unit[MOST] = { 0 };
    unsigned seed = 3;
    int n;

    m->par.faces = 1;
    set_springs(m, 3, 2);
    if (_i == 0)
        add_table(m, 0);
    else
        add_rectangle(m, 0, ROCK, (rectangle){ .x = -1.6, .y = -1, .w = 3, .h = 1, .nx = 3 });
    add_rectangle(m, 1, ROCK, (rectangle){ .x = -1, .w = 2, .h = 1, .nx = 2 });
    start_step(m, &n);
    ck_assert_int_eq(n, 3);
    ck_assert_int_eq(m->scratch->contact[1].parts, _i == 0 ? 3 : BBM_PARTS);
    ck_ok(bbm_lay_out_matrix(m), m);
    for (bbm_vertex *v = m->vertex; v < m->vertex + m->vertices; v++) {
        v->x += random_number(&seed) / 10;
        v->y += random_number(&seed) / 10;
    }
    for (int i = 0; i < m->elements; i++)
        bbm_element_geometry(&m->element[i], &m->vertex[m->element[i].first]);
    for (bbm_contact *c = m->scratch->contact; c < m->scratch->contact + 3; c++) {
        c->state = BBM_LOCK;
        c->rest = -0.1;
    }
    bbm_matrix_clear(m->K);
    memset(m->F, 0, 6 * (size_t)m->elements * sizeof *m->F);
    bbm_assemble_contacts(m);
    m->K->from = 0, m->K->to = m->elements;
    for (int b = 0; b < 6 * m->elements; b++) {
        const double F = m->F[b];
        unit[6 * m->K->place[b / 6] + b % 6] = 1;
        bbm_multiply(m->K, unit, column);
        unit[6 * m->K->place[b / 6] + b % 6] = 0;
        for (int a = 0; a < 6 * m->elements; a++) {
            double sum = 0;
            for (int k = 0; k < 4; k++) {
                D[a] += k / 2 ? -1 : 1;
                D[b] += k % 2 ? -1 : 1;
                sum += (k == 0 || k == 3 ? 1 : -1) * touches_energy(m, D) / 4;
                D[a] = D[b] = 0;
            }
            ck_near(column[6 * m->K->place[a / 6] + a % 6], sum, 100, 1e-12);
        }
        D[b] = 1;
        const double up = touches_energy(m, D);
        D[b] = -1;
        ck_near(F, (touches_energy(m, D) - up) / 2, 100, 1e-12);
        D[b] = 0;
    }
}
END_TEST

/* ---------------------------------------------------------------------------------------- water */

/* A square, turned, with its centre in any depth: the level crosses none, two or four of its sides.
 * In dynamics it is pressed where it is in the middle of the step. Each strip of a side is pressed by
 * what the water weighs above its middle; where the level crosses a strip that is wrong by some 1e-8
 * of the force. */
START_TEST(water_presses_each_strip_of_a_side_by_its_depth)
{
    enum { STRIPS = 10000 };
    const double angle = 0.1 + 0.3 * (_i % 5), start = -0.6 + 0.3 * (_i / 5), g = 9.81;
    const double fall = 0.5, h = 0.1, depth = start + fall * h / 2;
    double p[4][2], force[3] = { 0 };
    bbm_model *m = new_model(&SOLID);

    for (int k = 0; k < 4; k++) {
        p[k][0] = 3 + cos(angle + k * PI / 2);
        p[k][1] = 7 + sin(angle + k * PI / 2);
    }
    add_polygon(m, 0, 4, (const double (*)[2])p);
    m->par.gravity[1] = -g;
    ck_ok(bbm_prepare(m), m);
    for (int k = 0; k < 4; k++)
        ck_ok(bbm_add_water(m, k, 7 + start, 1000), m);
    m->par.dt = m->h = h;
    m->D[1] = -fall * h;
    bbm_set_middle(m);
    memset(m->load, 0, 6 * sizeof *m->load);
    bbm_gather_edge_loads(m);
    ck_near(bbm_settle_loads(m), 0, 1000 * g, 1e-14);
    for (int k = 0; k < 4 * STRIPS; k++) {
        const double *a = p[k / STRIPS], *b = p[(k / STRIPS + 1) % 4], s = (k % STRIPS + 0.5) / STRIPS;
        const double x = a[0] + s * (b[0] - a[0]) - 3, y = a[1] + s * (b[1] - a[1]) - 7;
        const double q = 1000 * g * fmax(0, depth - y) / STRIPS;
        const double fx = -q * (b[1] - a[1]), fy = q * (b[0] - a[0]);
        force[0] += fx;
        force[1] += fy;
        force[2] += x * fy - y * fx;
    }
    for (int a = 0; a < 3; a++)
        ck_near(m->load[a], force[a], 1000 * g, 1e-7);
}
END_TEST

/* What presses all round a quadrilateral whose corners x move by T D has the energy int p dA, with p + w (Y - y)
 * the pressure at a point. */
static double pressed_energy(const bbm_model *m, const double D[6], double p, double w, double Y)
{
    double area = 0, moment = 0, x[5][2];

    for (int k = 0; k < 5; k++) {
        const bbm_vertex *v = &m->vertex[k % 4];
        bbm_displacement(m->element, D, v->x, v->y, x[k]);
        x[k][0] += v->x;
        x[k][1] += v->y;
    }
    for (int k = 0; k < 4; k++) {
        const double twice = x[k][0] * x[k + 1][1] - x[k + 1][0] * x[k][1];
        area += twice / 2;
        moment += twice * (x[k][1] + x[k + 1][1]) / 6;
    }
    return (p + w * Y) * area - w * moment;
}

/* Its second derivatives, by differences, are the sum of what the edges have. Without weight it is pressure
 * alone. */
START_TEST(the_stiffness_of_what_presses_all_round_is_that_of_its_energy)
{
    static const double quad[4][2] = { { 0, 0 }, { 2, 0.3 }, { 1.8, 1.5 }, { -0.2, 1.1 } };
    const double d = 1e-3, p = _i ? 0 : 5, w = _i ? 3 : 0, Y = 4;
    bbm_model *m = new_model(&SOLID);

    add_polygon(m, 0, 4, quad);
    m->par.gravity[1] = -1;
    ck_ok(bbm_prepare(m), m);
    for (int e = 0; e < 4; e++)
        ck_ok(_i ? bbm_add_water(m, e, Y, w) : bbm_load_edge(m, e, 0, 0, p), m);
    m->h = INFINITY;
    bbm_gather_edge_loads(m);
    for (int k = 0; k < 36; k++) {
        const int a = k / 6, b = k % 6;
        double K = 0, energy = 0;
        for (int e = 0; e < 4; e++)
            K += m->beyond->edge_load[e].sinks[a][b] + m->beyond->edge_load[e].turns[a][b];
        for (int s = 0; s < 4; s++) {
            double D[6] = { 0 };
            D[a] += s % 2 ? d : -d;
            D[b] += s / 2 ? d : -d;
            energy += (s % 2 == s / 2 ? 1 : -1) * pressed_energy(m, D, p, w, Y - m->origin[1]);
        }
        ck_near(K, energy / (4 * d * d), 10, 1e-5);
    }
}
END_TEST

Suite *beyond_suite(void)
{
    Suite *s = suite_create("beyond");

    add_case(s, "multipliers",
        { with_two_more_solutions_bonded_triangles_are_the_finite_element, 1 },
        { the_multiplier_of_a_bond_is_the_force_that_it_carries, 1 },
        { in_dynamics_multipliers_have_no_part, 2 });
    add_case(s, "quadrilaterals",
        { a_beam_of_few_quadrilaterals_bends_as_it_should_also_when_they_are_distorted, 1 },
        { a_beam_without_the_moments_of_its_bonds_is_too_soft_by_what_its_rows_lack, 2 },
        { a_chequerboard_of_turns_costs_bonds_at_midpoints_nothing, 1 },
        { distorted_quadrilaterals_pass_the_patch_test_however_they_are_bonded, 3 },
        { the_edge_submatrices_are_derivatives_of_the_edge_energy, 1 },
        { the_moment_of_a_rectangle_is_that_of_a_beam, 1 },
        { a_turning_body_feels_no_moment_in_its_bonds, 2 },
        { a_contact_between_two_quadrilaterals_presses_both_alike, 2 },
        { a_contact_below_both_kinds_presses_all_their_elements_alike, 2 },
        { what_hits_a_corner_of_two_triangles_does_so_in_a_mirror_too, 1 },
        { what_a_support_drags_over_two_elements_goes_the_same_way_in_a_mirror, 1 },
        { triangles_in_contact_take_few_iterations, 1 },
        { a_block_of_quadrilaterals_presses_an_equal_one_below_it_alike_on_both_sides, COUNT(PILES) },
        { the_submatrices_of_a_contact_between_two_quadrilaterals_are_derivatives_of_its_energy, 2 });
    add_case(s, "water",
        { water_presses_each_strip_of_a_side_by_its_depth, 25 },
        { the_stiffness_of_what_presses_all_round_is_that_of_its_energy, 2 });
    add_case(s, "energies",
        { the_work_of_the_loads_is_twice_the_energy_of_elements_and_springs, 8 },
        { fixed_points_away_from_their_walls_hold_the_energy_of_their_springs, 1 },
        { a_body_that_follows_its_walls_holds_no_energy, 4 },
        { the_kinetic_energy_is_that_of_the_motion, 1 },
        { closed_contacts_hold_the_energy_of_their_springs, 1 });
    return s;
}
