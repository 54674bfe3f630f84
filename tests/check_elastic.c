/* check_elastic.c - bodies in statics: K, patch tests, bonded bars, loads, the finite element. */
#include <string.h>

#include "check.h"
#include "models.h"

/* ---------------------------------------------------------------- K, dense, in the test's hands */

/* All of K, column by column. */
static double *dense_matrix(const bbm_model *m)
{
    const int n = 6 * m->elements;
    double *A = calloc((size_t)(n * n), sizeof *A), *x = calloc((size_t)n, sizeof *x);

    for (int c = 0; c < n; c++) {
        x[c] = 1;
        matrix_multiply(m->K, x, &A[c * n]);
        x[c] = 0;
    }
    free(x);
    return A;
}

/* Cholesky's elimination, always with the largest pivot left, which stops at one that is rounding:
 * the number of positive pivots. *least: the smallest diagonal entry that was left then, or 0.
 * Destroys A. */
static int rank(int n, double *A, double *least)
{
    double size = 0;
    int *left = calloc((size_t)n, sizeof *left), r;

    for (int a = 0; a < n; a++) {
        left[a] = a;
        size = fmax(size, A[a * n + a]);
    }
    for (r = 0; r < n; r++) {
        for (int a = r + 1; a < n; a++)
            if (A[left[a] * (n + 1)] > A[left[r] * (n + 1)]) {
                const int other = left[r];
                left[r] = left[a];
                left[a] = other;
            }
        const int p = left[r];
        /* rounding: 1e-16 n; the smallest true ones here: 1e-5 */
        if (A[p * (n + 1)] <= 1e-10 * size)
            break;
        for (int a = r + 1; a < n; a++)
            for (int b = r + 1; b < n; b++)
                A[left[a] * n + left[b]] -= A[left[a] * n + p] * A[p * n + left[b]] /
                                            A[p * (n + 1)];
    }
    *least = 0;
    for (int a = r; a < n; a++)
        *least = fmin(*least, A[left[a] * (n + 1)] / size);
    free(left);
    return r;
}

START_TEST(K_is_symmetric_and_positive_definite_when_the_body_is_held)
{
    grid g = { .lx = 3, .ly = 2, .nx = 3, .ny = 2, .triangles = _i, .jitter = 0.2 };
    bbm_model *m = cantilever(&SOLID, &g, 1, -1);

    ck_ok(bbm_step(m), m);
    const int n = 6 * m->elements;
    double *A = dense_matrix(m), least, size = 0;
    for (int a = 0; a < n; a++)
        size = fmax(size, A[a * n + a]);
    for (int a = 0; a < n; a++)
        for (int b = 0; b < a; b++)
            ck_near(A[a * n + b], A[b * n + a], size, 1e-15);
    ck_assert_int_eq(rank(n, A, &least), n);
    free(A);
}
END_TEST

START_TEST(F_holds_what_both_elements_feel_and_the_wall_nothing)
{
    grid g = { .lx = 3, .ly = 2, .nx = 3, .ny = 2 };
    bbm_model *m = cantilever(&SOLID, &g, 1, -1);
    bbm_submatrices s = { 0 };

    ck_ok(bbm_step(m), m);
    for (int a = 0; a < 6; a++) {
        s.Fi[a] = 1 + a;
        s.Fj[a] = 10 * a;
    }
    memset(m->F, 0, 6 * (size_t)m->elements * sizeof *m->F);
    bbm_add_submatrices(m, 1, 0, &s);
    bbm_add_submatrices(m, 0, -1, &s);
    for (int a = 0; a < 6 * m->elements; a++)
        ck_assert_msg(m->F[a] == (a < 6 ? 10 * a + 1 + a : a < 12 ? a - 5 : 0), "F[%d] is %g", a, m->F[a]);
}
END_TEST

/* A step of 1e12 s: the inertia left is 1e-24 of the stiffness. A rigid motion costs nothing. */
START_TEST(K_has_three_zero_pivots_when_nothing_holds_the_body)
{
    grid g = { .lx = 3, .ly = 2, .nx = 3, .ny = 2, .triangles = _i, .jitter = 0.2 };
    const double motion[3] = { 0.5, -2, 1.5 };  /* u, v at the origin, rotation */
    bbm_model *m = new_model(&SOLID);

    add_grid(m, &g, 0);
    ck_ok(bbm_prepare(m), m);
    m->par.dt = 1e12;
    bbm_step(m);
    const int n = 6 * m->elements;
    double *A = dense_matrix(m), least;
    const int r = rank(n, A, &least);
    ck_assert_msg(r == n - 3, "K has the rank %d, expected %d", r, n - 3);
    ck_assert(least > -1e-12);
    double *D = calloc(2 * (size_t)n, sizeof *D), *KD = D + n;
    for (int e = 0; e < m->elements; e++) {
        D[6 * e] = motion[0] - motion[2] * m->element[e].y;
        D[6 * e + 1] = motion[1] + motion[2] * m->element[e].x;
        D[6 * e + 2] = motion[2];
    }
    matrix_multiply(m->K, D, KD);
    for (int a = 0; a < n; a++)
        ck_assert_msg(fabs(KD[a]) <= 1e5 * ROUNDING,
                      "a rigid motion has the force %g in row %d, expected 0",
                      KD[a], a);                            /* of K: alpha G t = 2e4 times D */
    free(D);
    free(A);
}
END_TEST

/* ---------------------------------------------------------------------------------- patch tests */

typedef struct {
    double x[16][2];
    int nodes, roller, elements, n[9], node[9][5];    /* roller: node of one element alone */
} patch;

static const patch PATCHES[] = {
    /* a strip: quadrilateral, triangle, pentagon, two triangles; no node is inside */
    { { { 0, 0 }, { 1.25, 0.25 }, { 3, -0.25 }, { 4.5, 0 }, { 6, 0 },
        { 0.25, 1 }, { 1.5, 1.25 }, { 2.75, 1 }, { 5, 1.5 }, { 6.25, 1.25 } },
      10, 9, 5, { 4, 3, 5, 3, 3 }, { { 0, 1, 6, 5 }, { 1, 2, 6 }, { 2, 3, 8, 7, 6 }, { 3, 4, 8 },
                                     { 4, 9, 8 } } },
    /* one node inside; quadrilaterals and triangles round it */
    { { { 0, 0 }, { 2, 0 }, { 4, 0 }, { 4, 1.5 }, { 4, 4 }, { 2.5, 4 }, { 0, 4 }, { 0, 2 },
        { 1.75, 2.25 } },
      9, 4, 6, { 4, 3, 3, 4, 3, 3 },
      { { 0, 1, 8, 7 }, { 1, 2, 8 }, { 2, 3, 8 }, { 3, 4, 5, 8 }, { 5, 6, 8 }, { 6, 7, 8 } } },
    /* three nodes inside, triangles, quadrilaterals and a pentagon */
    { { { 0, 0 }, { 3, 0 }, { 6, 0 }, { 6, 2.5 }, { 6, 5 }, { 2.5, 5 }, { 0, 5 }, { 0, 2 },
        { 1.5, 1.75 }, { 4, 1.5 }, { 3.5, 3.5 } },
      11, 2, 7, { 4, 4, 4, 3, 5, 3, 3 },
      { { 0, 1, 8, 7 }, { 1, 2, 3, 9 }, { 3, 4, 5, 10 }, { 3, 10, 9 }, { 5, 6, 7, 8, 10 },
        { 1, 9, 8 },
        { 8, 9, 10 } } },
};

static const double STRESSES[][3] = { { 3, 0, 0 }, { 0, 2, 0 }, { 0, 0, 1 }, { 3, -1, 2 } };

/* Pulls at every boundary edge with the traction of a uniform stress, holds what is needed against
 * rigid motion (without reactions, for the tractions are in balance), and writes the stresses that
 * come out. */
static void stretch_patch(const patch *p, const double s[3], double alpha, double stress[][3])
{
    bbm_model *m = new_model(&SOLID);

    m->par.alpha = alpha;
    for (int n = 0; n < p->nodes; n++)
        ck_ok(bbm_add_node(m, p->x[n][0], p->x[n][1], NULL), m);
    for (int e = 0; e < p->elements; e++)
        ck_ok(bbm_add_element(m, 0, 0, p->n[e], p->node[e], NULL), m);
    ck_ok(bbm_fix_node(m, 0, BBM_XY, 0, 0), m);
    ck_ok(bbm_fix_node(m, p->roller, BBM_Y, 0, 0), m);
    ck_ok(bbm_prepare(m), m);
    for (int i = 0; i < m->edges; i++) {
        const bbm_vertex *a = &m->vertex[m->edge[i].a], *b = &m->vertex[m->edge[i].b];
        const double dx = b->x - a->x, dy = b->y - a->y, l = hypot(dx, dy), t = SOLID.thickness;
        const double fx = t * (s[0] * dy - s[2] * dx) / l, fy = t * (s[2] * dy - s[1] * dx) / l;
        ck_ok(bbm_add_line_load(m, a->node, b->node, fx, fy), m);
    }
    run_steps(m, 1);
    for (int e = 0; e < m->elements; e++)
        memcpy(stress[e], m->element[e].stress, sizeof m->element[e].stress);
    release(m);
}

/* Where no node is inside, elements can part by s.n l/2k along every edge without straining: exact
 * whatever alpha. */
START_TEST(a_strip_under_uniform_traction_has_that_stress_in_every_element)
{
    double stress[9][3];

    stretch_patch(&PATCHES[0], STRESSES[_i], 100, stress);
    for (int e = 0; e < PATCHES[0].elements; e++)
        for (int a = 0; a < 3; a++)
            ck_near(stress[e][a], STRESSES[_i][a], 3, SOLVED);
}
END_TEST

/* Round an inner node the gaps need not close, and the stress is uniform only in the limit of rigid
 * springs: s(alpha) = s + c1/alpha + c2/alpha^2 + ... Three values of alpha remove c1 and c2;
 * c3/alpha^3 is near 1e-12. */
START_TEST(an_irregular_patch_under_uniform_traction_has_that_stress_in_every_element)
{
    for (int p = 1; p < COUNT(PATCHES); p++) {
        double stress[3][9][3];
        for (int a = 0; a < 3; a++)
            stretch_patch(&PATCHES[p], STRESSES[_i], 1e4 * (1 << a), stress[a]);
        for (int e = 0; e < PATCHES[p].elements; e++)
            for (int a = 0; a < 3; a++) {
                const double first = 2 * stress[1][e][a] - stress[0][e][a];
                const double second = 2 * stress[2][e][a] - stress[1][e][a];
                ck_near((4 * second - first) / 3, STRESSES[_i][a], 3, SOLVED);
            }
    }
}
END_TEST

/* A pressure p [N/m] on all sides of any polygon is in balance, and -p/t is the stress in x and in
 * y. */
START_TEST(a_body_under_pressure_all_round_has_that_stress)
{
    const shape *s = &SHAPES[_i];
    bbm_model *m = new_model(&SOLID);

    add_polygon(m, 0, s->n, s->x);
    ck_ok(bbm_fix_node(m, 0, BBM_XY, 0, 0), m);
    ck_ok(bbm_fix_node(m, 2, BBM_Y, 0, 0), m);
    ck_ok(bbm_prepare(m), m);
    for (int e = 0; e < m->edges; e++)
        ck_ok(bbm_load_edge(m, e, 0, 0, 5), m);
    ck_ok(bbm_step(m), m);
    for (int a = 0; a < 3; a++)
        ck_near(m->element[0].stress[a], a < 2 ? -5 / SOLID.thickness : 0, 5, SOLVED);
}
END_TEST

/* One polygon as the whole block, plain DDA: in balance the mean stress is sum of f x^T / (t A),
 * made symmetric. */
START_TEST(a_block_that_is_one_polygon_has_the_mean_stress_of_its_loads)
{
    const shape *s = &SHAPES[2];
    const double A = 5.5, f[CORNERS][2] = { { 2, 1 }, { -1, 0.5 }, { 0, -2 }, { -3, 1 },
                                            { 2, -0.5 }, { 0, 0 } };
    bbm_model *m = new_model(&SOLID);
    double T[2][2] = { { 0 } };

    add_polygon(m, 3, s->n, s->x);
    ck_ok(bbm_fix_node(m, 4, BBM_XY, 0, 0), m);                            /* (0, 0) */
    ck_ok(bbm_fix_node(m, 5, BBM_Y, 0, 0), m);                             /* (3, 0) */
    double moment = 0;
    for (int c = 0; c < s->n; c++) {
        ck_ok(bbm_add_load(m, c, f[c][0], f[c][1]), m);
        moment += s->x[c][0] * f[c][1] - s->x[c][1] * f[c][0];
        for (int r = 0; r < 4; r++)
            T[r / 2][r % 2] += s->x[c][r / 2] * f[c][r % 2];
    }
    T[0][1] -= moment;  /* the support at (3, 0) pulls -moment/3 */
    run_steps(m, 1);
    const double *stress = m->element[0].stress, tA = SOLID.thickness * A;
    ck_near(stress[0], T[0][0] / tA, 1, SOLVED);
    ck_near(stress[1], T[1][1] / tA, 1, SOLVED);
    ck_near(stress[2], (T[0][1] + T[1][0]) / 2 / tA, 1, SOLVED);
}
END_TEST

/* ---------------------------------------------------------------------------------- bonded bars */

/* Every joint is two springs side by side, the wall too: F L/(E A) + (N - 1) F/2k + F/2k with
 * k = alpha G t = alpha E t/2. */
START_TEST(a_bonded_bar_stretches_by_its_strain_and_its_springs)
{
    bbm_model *m = new_bar(&CORK, 1);
    const double F = 3, k = 100 * CORK.E / 2 * CORK.thickness, EA = CORK.E * CORK.thickness * 1;

    ck_ok(bbm_step(m), m);
    for (int j = 0; j < 2; j++) {
        const double strain = F / EA, length = 0.5 * LINKS;
        const bbm_result end = result_at(m, 2 * LINKS + j);
        ck_relative(end.u, strain * length + LINKS * F / (2 * k), SOLVED);
        ck_near(end.v, 0, end.u, SOLVED);
        ck_relative(end.stress[0], F / CORK.thickness, SOLVED);
        ck_relative(end.mises, F / CORK.thickness, SOLVED);
    }
}
END_TEST

/* Springs between unlike elements: the means of G and t. */
START_TEST(a_bar_of_two_materials_and_thicknesses_stretches_by_the_sum_of_its_parts)
{
    const bbm_material two[2] = { { .E = 1000, .density = 1, .thickness = 0.5 },
                                  { .E = 3000, .density = 1, .thickness = 0.25 } };
    const double F = 3, alpha = 100, kw = alpha * 500 * 0.5;
    const double k = alpha * (500 + 1500) / 2 * (0.5 + 0.25) / 2;
    bbm_model *m = new_bar(two, 2);

    ck_ok(bbm_step(m), m);
    double expected = F / (2 * kw) + (LINKS - 1) * F / (2 * k);
    for (int e = 0; e < LINKS; e++)
        expected += 0.5 * F / (two[e % 2].E * two[e % 2].thickness);
    ck_relative(result_at(m, 2 * LINKS).u, expected, SOLVED);
    for (int e = 0; e < LINKS; e++)
        ck_relative(m->element[e].stress[0], F / two[e % 2].thickness, SOLVED);
}
END_TEST

START_TEST(a_displaced_wall_takes_the_body_along)
{
    bbm_model *m = unit_square(&SOLID);

    ck_ok(bbm_fix_node(m, 0, BBM_XY, 0.25, -0.5), m);
    ck_ok(bbm_fix_node(m, 1, BBM_Y, 9, -0.5), m);  /* 9: not held in x, so of no account */
    run_steps(m, 1);
    for (int n = 0; n < 4; n++) {
        ck_near(result_at(m, n).u, 0.25, 1, SOLVED);
        ck_near(result_at(m, n).v, -0.5, 1, SOLVED);
        ck_near(m->vertex[n].x, m->node[n].x + 0.25, 1, SOLVED);
        ck_near(m->vertex[n].y, m->node[n].y - 0.5, 1, SOLVED);
    }
}
END_TEST

/* A later call adds a direction and leaves the wall point of the other alone. */
START_TEST(a_node_may_be_held_in_x_and_y_by_separate_calls)
{
    bbm_model *m = unit_square(&SOLID);

    ck_ok(bbm_fix_node(m, 2, BBM_Y, 7, 0.5), m);
    ck_ok(bbm_fix_node(m, 2, BBM_X, -0.25, 7), m);
    ck_assert_int_eq(m->node[2].held, BBM_XY);
    ck_assert(m->node[2].wall[0] == -0.25 && m->node[2].wall[1] == 0.5);
}
END_TEST

/* ----------------------------------------------------------------------------- loads in a model */

typedef struct { double x[BBM_GAUSS][2]; int calls; } places;

static void note_place(double x, double y, const void *context, double f[2])
{
    places *p = *(places *const *)context;

    ck_assert_int_lt(p->calls, BBM_GAUSS);
    p->x[p->calls][0] = x;
    p->x[p->calls++][1] = y;
    f[0] = f[1] = 0;
}

START_TEST(a_load_that_varies_is_asked_for_at_the_gauss_points_alone)
{
    bbm_model *m = points(1);
    places asked = { .calls = 0 }, *context = &asked;

    ck_ok(bbm_add_varying_line_load(m, 14, 2, note_place, &context), m); /* from (4, 2) to (2, 0) */
    ck_assert_int_eq(asked.calls, BBM_GAUSS);
    for (int g = 0; g < BBM_GAUSS; g++) {
        double s, weight;
        bbm_gauss_point(g, &s, &weight);
        ck_near(asked.x[g][0], 4 - 2 * s, 1, ROUNDING);
        ck_near(asked.x[g][1], 2 - 2 * s, 1, ROUNDING);
    }
}
END_TEST

/* Force and moment are integrals of cubic polynomials along the side, for which Simpson's rule is
 * exact. */
START_TEST(a_load_that_varies_reaches_the_element_whichever_end_is_named_first)
{
    const double scale[2] = { 6, -5 }, a[2] = { 1.5, -1 }, b[2] = { 2, 1.25 };
    const double weight[3] = { 1 / 6.0, 4 / 6.0, 1 / 6.0 };
    const int ends[2] = { _i ? 2 : 1, _i ? 1 : 2 };
    bbm_model *m = new_model(&SOLID);
    double total[3] = { 0 }, expected[3] = { 0 };

    add_polygon(m, 0, 4, SHAPES[1].x);
    ck_ok(bbm_fix_node(m, 0, BBM_XY, 0, 0), m);
    ck_ok(bbm_fix_node(m, 3, BBM_X, 0, 0), m);
    ck_ok(bbm_add_varying_line_load(m, ends[0], ends[1], rising_load, scale), m);
    run_steps(m, 1);
    total_load(m, 0, total);
    for (int g = 0; g < 3; g++) {
        const double x = a[0] + (b[0] - a[0]) * g / 2, y = a[1] + (b[1] - a[1]) * g / 2;
        double f[2];
        rising_load(x, y, scale, f);
        const double wl = weight[g] * hypot(b[0] - a[0], b[1] - a[1]);
        expected[0] += wl * f[0];
        expected[1] += wl * f[1];
        expected[2] += wl * (x * f[1] - y * f[0]);
    }
    for (int r = 0; r < 3; r++)
        ck_near(total[r], expected[r], 50, ROUNDING);
}
END_TEST

START_TEST(loads_of_one_node_and_of_one_edge_add_up)
{
    grid g = { .lx = 3, .ly = 2, .nx = 3, .ny = 2, .triangles = 1 };
    bbm_model *m = cantilever(&SOLID, &g, 0, 0);
    double total[3] = { 0 };

    ck_ok(bbm_add_load(m, node_at(&g, 1, 1), 2, -1), m);  /* at (1, 1), where triangles meet */
    ck_ok(bbm_add_load(m, node_at(&g, 1, 1), 3, 5), m);
    /* middle (3, 1.5), length 1 */
    ck_ok(bbm_add_line_load(m, node_at(&g, 3, 1), node_at(&g, 3, 2), 1, 0.5), m);
    ck_ok(bbm_add_line_load(m, node_at(&g, 3, 2), node_at(&g, 3, 1), 2, 0.25), m);
    run_steps(m, 1);
    for (int e = 0; e < m->elements; e++)
        total_load(m, e, total);
    ck_relative(total[0], 5 + 3, ROUNDING);
    ck_relative(total[1], 4 + 0.75, ROUNDING);
    ck_relative(total[2], (4 - 5) + (3 * 0.75 - 1.5 * 3), ROUNDING);
    const int n = node_at(&g, 1, 1), meeting = m->adjacent_first[n + 1] - m->adjacent_first[n];
    for (int v = 0; v < m->vertices; v++)
        if (m->vertex[v].node == n)
            ck_relative(m->F[6 * m->vertex[v].element], 5.0 / meeting, ROUNDING);
}
END_TEST

START_TEST(gravity_pulls_at_the_mass_of_each_element)
{
    grid g = { .lx = 2, .ly = 1.5, .nx = 2, .ny = 2, .jitter = 0.2 };
    bbm_model *m = cantilever(&SOLID, &g, 0, 0);

    m->par.gravity[0] = 3;
    m->par.gravity[1] = -9;
    ck_ok(bbm_step(m), m);
    for (int e = 0; e < m->elements; e++) {
        const double mass = SOLID.density * SOLID.thickness * m->element[e].A0;
        ck_relative(m->F[6 * e], mass * m->par.gravity[0], ROUNDING);
        ck_relative(m->F[6 * e + 1], mass * m->par.gravity[1], ROUNDING);
    }
}
END_TEST

/* A bar of squares, held at the left; each is pulled along x by a force of its own. With nu = 0 the
 * row ex of K D = F has the mean of the forces on its two sides: what pulls beyond it, and half of
 * its own. */
START_TEST(a_volume_force_pulls_at_what_lies_before_it)
{
    grid g = { .lx = 5, .ly = 1, .nx = 5, .ny = 1 };
    const bbm_material stiff = { .E = 1e6, .density = 1, .thickness = 0.5 };
    bbm_model *m = cantilever(&stiff, &g, 0, 0);

    for (int e = 0; e < 5; e++)
        m->element[e].f[0] = 1 + e * e;
    run_steps(m, 1);
    double beyond = 0;
    for (int e = 4; e >= 0; beyond += m->element[e--].f[0])
        ck_relative(m->element[e].stress[0] * 0.5, beyond + m->element[e].f[0] / 2, SOLVED);
}
END_TEST

static void constant_force(double x, double y, const void *element, double f[2])
{
    const bbm_element *e = element;

    (void)x, (void)y;
    f[0] = e->f[0];
    f[1] = e->f[1];
}

/* What a model's elements have of their f in F is the integral (46), on distorted quadrilaterals
 * and triangles, each with a force of its own. */
START_TEST(the_volume_force_of_a_model_is_the_integral_over_each_element)
{
    grid g = { .lx = 3, .ly = 2, .nx = 3, .ny = 2, .triangles = _i, .jitter = 0.2 };
    bbm_model *m = cantilever(&SOLID, &g, 0, 0);

    for (int e = 0; e < m->elements; e++) {
        m->element[e].f[0] = 1 + e;
        m->element[e].f[1] = -2 * e;
    }
    ck_ok(bbm_begin_step(m), m);
    ck_ok(bbm_lay_out_matrix(m), m);
    bbm_assemble(m);
    for (int e = 0; e < m->elements; e++) {
        double F[6] = { 0 };
        bbm_varying_volume_submatrix(&m->element[e], &m->vertex[m->element[e].first],
                                     constant_force, &m->element[e], F);
        for (int a = 0; a < 6; a++)
            ck_assert_msg(fabs(m->load[6 * e + a] - F[a]) <= ROUNDING * 30,
                          "element %d: load[%d] is %g, expected %g", e, a,
                          m->load[6 * e + a], F[a]);
    }
}
END_TEST

/* ----------------------------------------------------------- the constant-strain finite element */

static double distance_at(double alpha)
{
    grid g = { .lx = 4, .ly = 2, .nx = 6, .ny = 3, .triangles = 1, .jitter = 0.25 };
    bbm_model *m = cantilever(&SOLID, &g, 1, -1);

    m->par.alpha = alpha;
    return distance_from_finite_element(m);
}

/* The springs' compliance is a little over 2/alpha; the next term, of 1/alpha^2, is 0.2 % of it at
 * 1e3. At 1e7 the rounding of K D, 2e-16 alpha times the condition of the finite element (some 50),
 * is half of what is left. */
START_TEST(bonded_triangles_tend_to_the_constant_strain_finite_element_as_one_over_alpha)
{
    const double e3 = distance_at(1e3), e5 = distance_at(1e5);

    ck_assert(e3 < 0.003);
    ck_relative(e3 / e5, 100, 0.005);
    ck_assert(distance_at(1e7) < 5e-7);
}
END_TEST

/* Strained alike along both axes, ex = ey = e, a body in plane strain has s = E e/((1 + nu)(1 - 2 nu)),
 * whatever nu, but for the share of the springs, some 3/alpha and more in flat cells. */
START_TEST(what_can_hardly_be_compressed_is_stiff_in_plane_strain)
{
    static const double nus[] = { -0.5, 0, 0.3, 0.49, 0.4999 };
    const double nu = nus[_i % 5], E = 1e9, e = 1e-6, h = _i < 5 ? 1 : 0.25;
    bbm_model *m = new_model(&(bbm_material){ E, nu, 1, 1 });

    for (int n = 0; n < 9; n++) {
        bbm_add_node(m, n % 3, h * (n / 3), NULL);
        if (n != 4)
            bbm_fix_node(m, n, BBM_XY, e * (n % 3), e * h * (n / 3));
    }
    for (int k = 0; k < 4; k++) {
        const int a = k % 2 + 3 * (k / 2), cell[6] = { a, a + 1, a + 4, a, a + 4, a + 3 };
        bbm_add_element(m, 0, 0, 3, cell, NULL);
        bbm_add_element(m, 0, 0, 3, cell + 3, NULL);
    }
    m->par.alpha = 1000;
    ck_ok(bbm_prepare(m), m);
    bbm_set_plane_strain(m);
    ck_ok(bbm_run(m), m);
    for (int i = 0; i < m->elements; i++)
        for (int a = 0; a < 2; a++)
            ck_relative(m->element[i].stress[a], E * e / (1 + nu) / (1 - 2 * nu), 0.01);
}
END_TEST

/* Heat strains alpha dT = 1e-3 in all directions, as an initial strain: the stress that would hold
 * all three, -E alpha dT/(1 - 2 nu). Free in the plane, held out of it, there is szz = -E alpha dT
 * alone; ex = ey = (1 + nu) alpha dT. A stress q along x that goes leaves szz = -nu q, and ex = -
 * q (1 - nu^2)/E. Plane strain that is set twice is the same. */
START_TEST(heat_in_plane_strain_leaves_its_stress_out_of_the_plane)
{
    const double E = 1e9, nu = 0.3, heat = 1e-3, all = -E * heat / (1 - 2 * nu), q = -E * heat / 2;
    bbm_model *m = new_model(&(bbm_material){ E, nu, 1, 1 });
    bbm_result r;

    add_rectangle(m, 0, 0, (rectangle){ .w = 2, .h = 1, .nx = 2 });
    bbm_fix_node(m, 0, BBM_XY, 0, 0);
    bbm_fix_node(m, 1, BBM_Y, 0, 0);
    ck_ok(bbm_prepare(m), m);
    for (int times = 0; times <= _i; times++)
        bbm_set_plane_strain(m);
    for (bbm_element *e = m->element; e < m->element + m->elements; e++)
        e->stress[0] = (e->stress[1] = e->szz = all) + q;
    ck_ok(bbm_run(m), m);
    ck_ok(bbm_nodal_result(m, 1, -1, &r), m);
    ck_near(r.stress[0], 0, E * heat, SOLVED);
    ck_relative(r.szz, -E * heat - nu * q, SOLVED);
    ck_relative(r.mises, E * heat + nu * q, SOLVED);
    ck_relative(m->element[0].D[3], (1 + nu) * heat - q * (1 - nu * nu) / E, SOLVED);
    ck_relative(m->element[0].D[4], (1 + nu) * heat + q * nu * (1 + nu) / E, SOLVED);
}
END_TEST

/* A cantilever of 1 x 20 stands on its end, drawn upright or turned by 35 degrees, and carries a
 * share of Euler's load E I (pi/2L)^2 there. Bonds give way by 1 %, and forty quadrilaterals bend as
 * a beam, so that 0.97 is stable and 1.02 is not. */
START_TEST(a_column_is_stable_up_to_eulers_load)
{
    const double L = 20, E = 2e9, turn = _i % 2 * 35 * acos(-1) / 180, share = _i < 2 ? 0.97 : 1.02;
    const double c = cos(turn), s = sin(turn), P = share * E / 12 * pow(acos(-1) / (2 * L), 2);
    bbm_model *m = new_model(&(bbm_material){ E, 0, 1, 1 });
    int stable = -1;

    m->beyond->bonding = BBM_MOMENT;
    for (int k = 0; k <= 40; k++) {
        const double y = k * L / 40;
        bbm_add_node(m, -s * y, c * y, NULL);
        bbm_add_node(m, c - s * y, s + c * y, NULL);
        if (k > 0)
            bbm_add_element(m, 0, 0, 4, (int[]){ 2 * k - 2, 2 * k - 1, 2 * k + 1, 2 * k }, NULL);
    }
    bbm_fix_node(m, 0, BBM_XY, 0, 0);
    bbm_fix_node(m, 1, BBM_XY, 0, 0);
    bbm_add_line_load(m, 80, 81, s * P, -c * P);
    ck_ok(bbm_prepare(m), m);
    ck_ok(bbm_run(m), m);
    ck_ok(bbm_find_stability(m, &stable), m);
    ck_assert_int_eq(stable, _i < 2);
}
END_TEST

/* A block of the weight W, 2 a wide and h high, stands on a table. Two contacts p_n with an arm of a
 * resist a turn, the weight at h/2 drives it: 2 p_n a^2 = W h/2 is the limit. The block is so stiff
 * that 1 % on either side decides. On a corner it is in equilibrium, and not stable. Without friction
 * it stands, though it slides freely: no push moves it on by itself. */
START_TEST(a_block_is_stable_by_the_springs_of_its_base)
{
    const double a = 0.05, h = 8, W = 2 * a * h * 2000 * 10, limit = W * h / (4 * a * a);
    const double p_n[4] = { 1.01 * limit, 0.99 * limit, 1e3 * limit, 1e3 * limit };
    const double on_side[4][2] = { { -a, 0 }, { a, 0 }, { a, h }, { -a, h } };
    const double on_corner[4][2] = { { 0, 0 }, { a, h / 2 }, { 0, h }, { -a, h / 2 } };
    bbm_model *m = new_model(&(bbm_material){ 1e13, 0.2, 2000, 1 });
    int stable = -1;

    add_rectangle(m, 0, 0, (rectangle){ .x = -3, .y = -1, .w = 6, .h = 1 });
    for (int k = 0; k < 4; k++) {
        const double *at = _i == 2 ? on_corner[k] : on_side[k];
        bbm_fix_node(m, k, BBM_XY, 0, 0);
        bbm_add_node(m, at[0], at[1], NULL);
    }
    bbm_add_element(m, 1, 0, 4, (int[]){ 4, 5, 6, 7 }, NULL);
    m->par.gravity[1] = -10;
    m->par.friction = _i == 3 ? 0 : 30;
    m->par.p_n = m->par.p_s = p_n[_i];
    ck_ok(bbm_prepare(m), m);
    ck_ok(bbm_run(m), m);
    ck_ok(bbm_find_stability(m, &stable), m);
    ck_assert_int_eq(stable, _i == 0 || _i == 3);
}
END_TEST

Suite *elastic_suite(void)
{
    Suite *s = suite_create("elastic");

    add_case(s, "K",
        { K_is_symmetric_and_positive_definite_when_the_body_is_held, 2 },
        { K_has_three_zero_pivots_when_nothing_holds_the_body, 2 },
        { F_holds_what_both_elements_feel_and_the_wall_nothing, 1 });
    add_case(s, "patches",
        { a_strip_under_uniform_traction_has_that_stress_in_every_element, COUNT(STRESSES) },
        { an_irregular_patch_under_uniform_traction_has_that_stress_in_every_element,
          COUNT(STRESSES) },
        { a_body_under_pressure_all_round_has_that_stress, COUNT(SHAPES) },
        { a_block_that_is_one_polygon_has_the_mean_stress_of_its_loads, 1 },
        { what_can_hardly_be_compressed_is_stiff_in_plane_strain, 10 },
        { heat_in_plane_strain_leaves_its_stress_out_of_the_plane, 2 });
    add_case(s, "bars",
        { a_bonded_bar_stretches_by_its_strain_and_its_springs, 1 },
        { a_bar_of_two_materials_and_thicknesses_stretches_by_the_sum_of_its_parts, 1 },
        { a_displaced_wall_takes_the_body_along, 1 },
        { a_node_may_be_held_in_x_and_y_by_separate_calls, 1 },
        { a_column_is_stable_up_to_eulers_load, 4 },
        { a_block_is_stable_by_the_springs_of_its_base, 4 });
    add_case(s, "loads",
        { a_load_that_varies_is_asked_for_at_the_gauss_points_alone, 1 },
        { a_load_that_varies_reaches_the_element_whichever_end_is_named_first, 2 },
        { loads_of_one_node_and_of_one_edge_add_up, 1 },
        { gravity_pulls_at_the_mass_of_each_element, 1 },
        { a_volume_force_pulls_at_what_lies_before_it, 1 },
        { the_volume_force_of_a_model_is_the_integral_over_each_element, 2 });
    add_case(s, "finite element",
        { bonded_triangles_tend_to_the_constant_strain_finite_element_as_one_over_alpha, 1 });
    return s;
}
