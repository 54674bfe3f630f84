/* check_formulas.c - the formulas, one test an equation, in the paper's order: the file to read
 * beside bbm.c and contact.c. The name of each test is what it shows.
 *
 * Nothing here is compared with what the program once printed. The oracles are
 *   - the potential energies of section 3, written from the physics and integrated by another
 *     route. All are quadratic in D, so that their central differences are exact for any step and
 *     are the submatrices but for rounding;
 *   - closed forms: moments of area, Hooke's law, Mohr's circle, motion under a constant force;
 *   - the table of contact states, written out cell by cell.
 *
 * Tolerances. ROUNDING, see shapes.h. Where a tolerance is larger, what it has to let pass is said
 * beside it.
 */
#include <stdio.h>
#include <string.h>

#include "check.h"
#include "shapes.h"

enum { UNKNOWNS = 12 };

/* ----------------------------------------------------------------- polygons, integrated by hand */

typedef struct {  /* one element of such a shape, with what the oracle knows of it by itself */
    const shape *s;
    bbm_element e;
    bbm_node node[CORNERS];
    bbm_vertex v[CORNERS];
    double A, x, y;
} body;

typedef double function(double x, double y, const void *context);

/* int f dA by Radon's rule of degree 5 on each triangle. */
static double integral(const body *b, function *f, const void *context)
{
    const double r = sqrt(15.0), p = (6 - r) / 21, q = (6 + r) / 21, wp = (155 - r) / 1200;
    const double wq = (155 + r) / 1200;
    const double rule[7][4] = {
        { 9.0 / 40, 1.0 / 3, 1.0 / 3, 1.0 / 3 },
        { wp, p, p, 1 - 2 * p }, { wp, p, 1 - 2 * p, p }, { wp, 1 - 2 * p, p, p },
        { wq, q, q, 1 - 2 * q }, { wq, q, 1 - 2 * q, q }, { wq, 1 - 2 * q, q, q },
    };
    double sum = 0;

    for (int t = 0; t < b->s->triangles; t++) {
        const bbm_vertex *v[3];
        for (int c = 0; c < 3; c++)
            v[c] = &b->v[b->s->triangle[t][c]];
        const double twice = (v[1]->x - v[0]->x) * (v[2]->y - v[0]->y) -
                             (v[2]->x - v[0]->x) * (v[1]->y - v[0]->y);
        for (int g = 0; g < 7; g++) {
            double x = 0, y = 0;
            for (int c = 0; c < 3; c++) {
                x += rule[g][1 + c] * v[c]->x;
                y += rule[g][1 + c] * v[c]->y;
            }
            sum += rule[g][0] * twice / 2 * f(x, y, context);
        }
    }
    return sum;
}

static double one(double x, double y, const void *none) { (void)x, (void)y, (void)none; return 1; }
static double just_x(double x, double y, const void *none) { (void)y, (void)none; return x; }
static double just_y(double x, double y, const void *none) { (void)x, (void)none; return y; }

/* An element of the shape at (dx, dy) with random displacements behind it, of another area at the
 * start. */
static void make_body(body *b, const shape *s, double dx, double dy, unsigned *seed)
{
    memset(b, 0, sizeof *b);
    b->s = s;
    for (int c = 0; c < s->n; c++) {
        const double u = random_number(seed) / 8, v = random_number(seed) / 8;
        const double x = s->x[c][0] + dx, y = s->x[c][1] + dy;
        b->node[c] = (bbm_node){ .x = x - u, .y = y - v };
        b->v[c] = (bbm_vertex){ .node = c, .x = x, .y = y, .u = u, .v = v };
    }
    b->A = integral(b, one, NULL);
    b->x = integral(b, just_x, NULL) / b->A;
    b->y = integral(b, just_y, NULL) / b->A;
    b->e = (bbm_element){ .n = s->n,
                          .material = { .E = 7, .nu = 0.3, .density = 3, .thickness = 0.75 } };
    bbm_element_geometry(&b->e, b->v);
    b->e.A0 = 1.25 * b->A;
    for (int a = 0; a < 6; a++)
        b->e.V[a] = random_number(seed);
    for (int a = 0; a < 3; a++)
        b->e.stress[a] = random_number(seed);
}

static body body_of(const shape *s, unsigned seed)
{
    body b;

    make_body(&b, s, 3, -2, &seed);
    return b;
}

/* The displacement of the body's point (x, y): translation, small rotation and strain about the
 * barycentre. */
static void displace(const body *b, const double D[6], double x, double y, double u[2])
{
    const double X = x - b->x, Y = y - b->y;

    u[0] = D[0] - D[2] * Y + D[3] * X + D[5] / 2 * Y;
    u[1] = D[1] + D[2] * X + D[4] * Y + D[5] / 2 * X;
}

/* -------------------------------------------- submatrices are derivatives of potential energies */

typedef struct {                /* what the energies depend on */
    const body *i, *j;
    int P, Q;                   /* corners of i and of j */
    double k, dt;
    bbm_node wall;
    double f[7][2];             /* coefficients of a load */
    bbm_touch touch;            /* P1 of i, P2 and P3 of j */
    double anchor, rest;
} source;

typedef struct { const source *s; const double *D; } moved;

typedef double energy(const double D[UNKNOWNS], const source *s);

static const char *const UNKNOWN[6] = { "u0", "v0", "r0", "ex", "ey", "gxy" };

/* The energy at D = x in unknown a, and y more in unknown b. */
static double energy_at(energy *Pi, const source *s, int a, double x, int b, double y)
{
    double D[UNKNOWNS] = { 0 };

    D[a] += x;
    D[b] += y;
    return Pi(D, s);
}

/* With all digits if the first ones agree. */
static void check_entry(const char *place, double got, double expected, double bound)
{
    const int digits = fabs(got - expected) > 1e-4 * fabs(expected) ? 6 : 17;

    ck_assert_msg(!isnan(got), "%s: never set (NaN), expected %.6g", place, expected);
    ck_assert_msg(fabs(got - expected) <= bound, "%s: %.*g, expected %.*g", place, digits, got,
                  digits, expected);
}

/* Fails unless K is the second derivative of the energy and -F its first at D = 0: entry by entry,
 * each named as the code has it. */
static void check_derivatives(energy *Pi, const source *s, int n, double K[UNKNOWNS][UNKNOWNS],
                              const double F[])
{
    const char *const name[2] = { n > 6 ? "i" : "", n > 6 ? "j" : "" }, *of = n > 6 ? " of " : "";
    double size = 1;
    char place[60];

    for (int a = 0; a < n * n; a++)
        size = fmax(size, fabs(K[a / n][a % n]));
    const double bound = 1e-11 * size;              /* energies: 50 size */
    for (int a = 0; a < n; a++) {
        const char *i = name[a / 6], *row = UNKNOWN[a % 6];
        for (int b = 0; b < n; b++) {
            const char *j = name[b / 6];
            snprintf(place, sizeof place, "K%s%s[%d][%d] (row %s%s%s, column %s%s%s)", i, j, a % 6,
                     b % 6, row, of, i, UNKNOWN[b % 6], of, j);
            const double up = energy_at(Pi, s, a, 1, b, 1) - energy_at(Pi, s, a, 1, b, -1);
            const double down = energy_at(Pi, s, a, -1, b, 1) - energy_at(Pi, s, a, -1, b, -1);
            check_entry(place, K[a][b], (up - down) / 4, bound);
        }
        snprintf(place, sizeof place, "F%s[%d] (row %s%s%s)", i, a % 6, row, of, i);
        const double up = energy_at(Pi, s, a, 1, a, 0), down = energy_at(Pi, s, a, -1, a, 0);
        check_entry(place, F[a], (down - up) / 2, bound);
    }
}

static void fill_with_ones(double *x, size_t bytes)
{
    for (size_t a = 0; a < bytes / sizeof *x; a++)
        x[a] = 1;
}

/* The functions under test add: what they are given is 1 everywhere, and taken off again. */
static bbm_submatrix ones(void)
{
    bbm_submatrix s;

    fill_with_ones(&s.K[0][0], sizeof s.K);
    fill_with_ones(s.F, sizeof s.F);
    return s;
}

static bbm_submatrices pair_of_ones(void)
{
    bbm_submatrices s;

    fill_with_ones(&s.Kii[0][0], sizeof s.Kii);
    fill_with_ones(&s.Kij[0][0], sizeof s.Kij);
    fill_with_ones(&s.Kjj[0][0], sizeof s.Kjj);
    fill_with_ones(s.Fi, sizeof s.Fi);
    fill_with_ones(s.Fj, sizeof s.Fj);
    return s;
}

static void check_submatrix(energy *Pi, const source *s, const bbm_submatrix *sub)
{
    double K[UNKNOWNS][UNKNOWNS] = { { 0 } }, F[UNKNOWNS] = { 0 };

    for (int a = 0; a < 6; a++) {
        for (int b = 0; b < 6; b++)
            K[a][b] = sub->K[a][b] - 1;
        F[a] = sub->F[a] - 1;
    }
    check_derivatives(Pi, s, 6, K, F);
}

/* The same for the submatrices of a pair, as one matrix. */
static void check_submatrices(energy *Pi, const source *s, const bbm_submatrices *sub)
{
    double K[UNKNOWNS][UNKNOWNS], F[UNKNOWNS];

    for (int a = 0; a < 6; a++) {
        for (int b = 0; b < 6; b++) {
            K[a][b] = sub->Kii[a][b] - 1;
            K[a][6 + b] = sub->Kij[a][b] - 1;
            K[6 + a][b] = sub->Kij[b][a] - 1;
            K[6 + a][6 + b] = sub->Kjj[a][b] - 1;
        }
        F[a] = sub->Fi[a] - 1;
        F[6 + a] = sub->Fj[a] - 1;
    }
    check_derivatives(Pi, s, UNKNOWNS, K, F);
}

/* ------------------------------------------------------------------ 2.1, displacements, (1)-(3) */

START_TEST(the_mode_matrix_moves_points_by_translation_rotation_and_strain)
{
    unsigned seed = 11;
    body b;

    make_body(&b, &SHAPES[_i], 3, -2, &seed);
    for (int a = 0; a < 6; a++) {
        const double x = 4 * random_number(&seed), y = 4 * random_number(&seed);
        double T[2][6], D[6] = { 0 }, u[3] = { 0, 0, 7 }, expected[2];
        char place[60];
        D[a] = 1;
        displace(&b, D, x, y, expected);
        bbm_mode_matrix(&b.e, x, y, T);
        for (int r = 0; r < 2; r++) {
            snprintf(place, sizeof place, "T[%d][%d] (row %c, column %s)", r, a, "uv"[r],
                     UNKNOWN[a]);
            check_entry(place, T[r][a], expected[r], ROUNDING);
        }
        for (int c = 0; c < 6; c++)
            D[c] = random_number(&seed);
        displace(&b, D, x, y, expected);
        bbm_displacement(&b.e, D, x, y, u);
        ck_near(u[0], expected[0], 1, ROUNDING);
        ck_near(u[1], expected[1], 1, ROUNDING);
        ck_assert(u[2] == 7);
    }
}
END_TEST

/* ---------------------------------- 2.2, the stiffness of bonds, (4), and of fixed points, (29) */

/* G = 10/2.5 = 4 and 12/2 = 6, means of G 5 and of t 0.5. */
START_TEST(the_bonding_stiffness_has_its_value_in_either_order_of_elements_and_at_any_strain)
{
    const bbm_element i = { .A0 = 2, .A = 9,
                            .material = { .E = 10, .nu = 0.25, .thickness = 0.375 } };
    const bbm_element j = { .A0 = 3, .A = 9, .material = { .E = 12, .nu = 0, .thickness = 0.625 } };

    ck_relative(bbm_bonding_stiffness(8, &i, &j), 8 * 5 * 0.5 * 1.5, ROUNDING);
    ck_relative(bbm_bonding_stiffness(8, &j, &i), 8 * 5 * 0.5 * 1.5, ROUNDING);
    ck_relative(bbm_fixed_stiffness(8, &i), 8 * 4 * 0.375, ROUNDING);
}
END_TEST

/* ----------------------------------------------------------------- 3.1, strain energy, (6)-(10) */

START_TEST(hookes_law_gives_uniaxial_tension_and_pure_shear_their_strains)
{
    const bbm_material m = { .E = 7, .nu = 0.3 };
    const double strain[3][3] = { { 1 / 7.0, -0.3 / 7, 0 }, { -0.3 / 7, 1 / 7.0, 0 },
                                  { 0, 0, 2 * 1.3 / 7 } };
    double E[3][3];

    bbm_elastic_matrix(&m, E);
    for (int load = 0; load < 3; load++)
        for (int a = 0; a < 3; a++) {
            double stress = 0;
            for (int b = 0; b < 3; b++)
                stress += E[a][b] * strain[load][b];
            ck_near(stress, a == load, 1, ROUNDING);
        }
}
END_TEST

/* Strain energy of plane stress and the work of the stress that is already there, (6)-(9). */
static double elastic_energy(const double D[], const source *s)
{
    const bbm_material *m = &s->i->e.material;
    const double *s0 = s->i->e.stress, G = m->E / 2 / (1 + m->nu), dilation = D[3] + D[4];
    const double sx = m->E / (1 - m->nu) * dilation / 2 + G * (D[3] - D[4]);
    const double sy = m->E / (1 - m->nu) * dilation / 2 - G * (D[3] - D[4]);

    return m->thickness * s->i->A *
           ((sx * D[3] + sy * D[4] + G * D[5] * D[5]) / 2 + s0[0] * D[3] + s0[1] * D[4] +
            s0[2] * D[5]);
}

START_TEST(the_elastic_submatrix_is_the_derivative_of_the_strain_energy)
{
    const body b = body_of(&SHAPES[_i], 1);
    source s = { .i = &b };
    bbm_submatrix sub = ones();
    bbm_elastic_submatrix(&b.e, &sub);
    check_submatrix(elastic_energy, &s, &sub);
}
END_TEST

/* ---------------------------------------------------------------------- 3.2, inertia, (11)-(17) */

/* Closed forms of area, barycentre and second moments. */
static const struct { int n; double x[CORNERS][2], A, at[2], Sxx, Syy, Sxy; } AREAS[] = {
    { 4, { { 1, 2 }, { 4, 2 }, { 4, 4 }, { 1, 4 } }, 6, { 2.5, 3 }, 4.5, 2, 0 }, /* b^3 h / 12 */
    { 3, { { 0, 0 }, { 3, 0 }, { 0, 2 } }, 3, { 1, 2.0 / 3 }, 1.5, 2.0 / 3, -0.5 }, /* b^3 h / 36 */
    { 6, { { 0, 0 }, { 2, 0 }, { 2, 1 }, { 1, 1 }, { 1, 2 }, { 0, 2 } },  /* two squares */
      3, { 5.0 / 6, 5.0 / 6 }, 11.0 / 12, 11.0 / 12, -1.0 / 3 },
    { 6, { { 1, 1 }, { 1, 2 }, { 0, 2 }, { 0, 0 }, { 2, 0 }, { 2, 1 } },  /* from elsewhere */
      3, { 5.0 / 6, 5.0 / 6 }, 11.0 / 12, 11.0 / 12, -1.0 / 3 },
};

/* Far away the corners are still exact, and the barycentre is as exact as a number of that size can
 * be: half a unit in the last place of 2^21 is 2.3e-10 m. The moments about it must not suffer. */
START_TEST(moments_of_polygons_have_their_closed_forms_also_far_from_the_origin)
{
    const double far[3][2] = { { 0, 0 }, { 2097152, -1048576 }, { -1048576, 2097152 } };

    for (int o = 0; o < 3; o++) {
        const double reach = o == 0 ? ROUNDING : 5e-10;
        bbm_element e = { .n = AREAS[_i].n };
        bbm_vertex v[CORNERS];
        for (int c = 0; c < e.n; c++)
            v[c] = (bbm_vertex){ .x = AREAS[_i].x[c][0] + far[o][0],
                                 .y = AREAS[_i].x[c][1] + far[o][1] };
        bbm_element_geometry(&e, v);
        ck_near(e.A, AREAS[_i].A, 1, ROUNDING);
        ck_near(e.x - far[o][0], AREAS[_i].at[0], 1, reach);
        ck_near(e.y - far[o][1], AREAS[_i].at[1], 1, reach);
        ck_near(e.Sxx, AREAS[_i].Sxx, 1, 10 * reach);
        ck_near(e.Syy, AREAS[_i].Syy, 1, 10 * reach);
        ck_near(e.Sxy, AREAS[_i].Sxy, 1, 10 * reach);
    }
}
END_TEST

/* u.v of two motions. */
static double product(double x, double y, const void *context)
{
    const moved *m = context;
    double u[2], v[2];

    displace(m->s->i, m->D, x, y, u);
    displace(m->s->i, m->D + 6, x, y, v);
    return u[0] * v[0] + u[1] * v[1];
}

START_TEST(the_mode_integral_is_the_brute_force_integral)
{
    const body b = body_of(&SHAPES[_i], 12);
    double M[6][6];
    char place[60];
    bbm_mode_integral(&b.e, M);
    for (int r = 0; r < 6; r++)
        for (int c = 0; c < 6; c++) {
            double D[12] = { 0 };
            D[r] = D[6 + c] = 1;
            const source s = { .i = &b };
            const moved m = { &s, D };
            snprintf(place, sizeof place, "M[%d][%d] (row %s, column %s)", r, c, UNKNOWN[r],
                     UNKNOWN[c]);
            check_entry(place, M[r][c], integral(&b, product, &m), ROUNDING);
        }
}
END_TEST

/* |u - dt v|^2 at a point. */
static double lag(double x, double y, const void *context)
{
    const moved *m = context;
    double u[2], v[2];

    displace(m->s->i, m->D, x, y, u);
    displace(m->s->i, m->s->i->e.V, x, y, v);
    return (u[0] - m->s->dt * v[0]) * (u[0] - m->s->dt * v[0]) +
           (u[1] - m->s->dt * v[1]) * (u[1] - m->s->dt * v[1]);
}

/* The force -M u'' = -2M/dt^2 (u - dt v) is that of a spring to where the velocity alone would
 * carry a point; the mass is that of the starting area, (11)-(13). */
static double inertia_energy(const double D[], const source *s)
{
    const bbm_element *e = &s->i->e;
    const moved m = { s, D };
    const double mass = e->material.density * e->material.thickness * e->A0;

    return mass / s->i->A / (s->dt * s->dt) * integral(s->i, lag, &m);
}

START_TEST(the_inertia_submatrix_is_the_derivative_of_its_energy)
{
    const body b = body_of(&SHAPES[_i], 2);
    source s = { .i = &b, .dt = 0.7 };
    bbm_submatrix sub = ones();
    bbm_inertia_submatrix(&b.e, s.dt, &sub);
    check_submatrix(inertia_energy, &s, &sub);
}
END_TEST

START_TEST(newmark_carries_a_constant_acceleration_without_error)
{
    const double dt = 0.3, V = 1.5, a = -2;

    for (int r = 0; r < 6; r++) {
        bbm_element e = { .V = { 0 } };
        e.V[r] = V;
        e.D[r] = V * dt + a * dt * dt / 2;
        bbm_newmark_velocity(&e, dt, 1);
        for (int c = 0; c < 6; c++)
            ck_assert_msg(fabs(e.V[c] - (c == r ? V + a * dt : 0)) <= ROUNDING,
                          "V[%d] is %g, expected %g", c, e.V[c], c == r ? V + a * dt : 0);
    }
}
END_TEST

START_TEST(a_step_hands_on_the_share_of_the_velocity_that_is_kept)
{
    bbm_element half = { .V = { 1, 2 }, .D = { 3, 4 } }, none = half;

    bbm_newmark_velocity(&half, 2, 0.5);
    bbm_newmark_velocity(&none, INFINITY, 0);
    ck_near(half.V[0], 1, 1, ROUNDING);                                    /* (2/2 3 - 1)/2 */
    ck_near(half.V[1], 1, 1, ROUNDING);
    ck_assert(none.V[0] == 0 && none.V[1] == 0);
}
END_TEST

/* -------------------------------------------------------------- 3.3, bonding springs, (18)-(28) */

/* k/2 |P - Q|^2 at the end of the step, (24)-(26). */
static double bonding_energy(const double D[], const source *s)
{
    const bbm_vertex *P = &s->i->v[s->P], *Q = &s->j->v[s->Q];
    double p[2], q[2];

    displace(s->i, D, P->x, P->y, p);
    displace(s->j, D + 6, Q->x, Q->y, q);
    const double dx = P->x + p[0] - Q->x - q[0], dy = P->y + p[1] - Q->y - q[1];
    return s->k / 2 * (dx * dx + dy * dy);
}

START_TEST(the_bonding_submatrices_are_derivatives_of_the_springs_energy)
{
    unsigned seed = 3;
    body i, j;

    make_body(&i, &SHAPES[_i], 3, -2, &seed);
    make_body(&j, &SHAPES[(_i + 1) % COUNT(SHAPES)], 5, -1, &seed);
    source s = { .i = &i, .j = &j, .P = 1, .Q = 2, .k = 11 };
    /* one point at the start: Q displaced by what P - Q asks */
    bbm_vertex *P = &i.v[s.P], *Q = &j.v[s.Q];
    Q->u = P->u + Q->x - P->x;
    Q->v = P->v + Q->y - P->y;
    bbm_submatrices sub = pair_of_ones();
    bbm_gap gap = { .i = 0, .j = 1 };
    bbm_bonding_gap(&i.e, P, &j.e, Q, s.k, &gap);
    bbm_bonding_submatrices(&gap, &sub);
    check_submatrices(bonding_energy, &s, &sub);
}
END_TEST

/* ----------------------------------------------------------------- 3.4, fixed points, (30)-(37) */

/* The same to the wall point, in the held directions, (36). */
static double fixed_energy(const double D[], const source *s)
{
    const bbm_vertex *P = &s->i->v[s->P];
    const bbm_node *W = &s->wall;
    double p[2], Pi = 0;

    displace(s->i, D, P->x, P->y, p);
    const double dx = P->x + p[0] - (W->x + W->wall[0]), dy = P->y + p[1] - (W->y + W->wall[1]);
    if (W->held == BBM_X || W->held == BBM_XY)
        Pi += s->k / 2 * dx * dx;
    if (W->held == BBM_Y || W->held == BBM_XY)
        Pi += s->k / 2 * dy * dy;
    return Pi;
}

/* (37) is (27), (28) without a second element. */
static void add_fixed_point(const body *b, int P, const bbm_node *W, double k, bbm_submatrix *s)
{
    bbm_submatrices both = { .Fi = { 0 } };
    bbm_gap gap = { .i = 0, .j = -1 };
    bbm_vertex at = b->v[P];

    at.node = 7;
    bbm_fixed_gap(&b->e, &at, W, k, &gap);
    ck_assert_msg(gap.node[0] == 7 && gap.node[1] == 7,
                  "nodes of the gap: %d, %d, expected that of P, 7", gap.node[0], gap.node[1]);
    bbm_bonding_submatrices(&gap, &both);
    for (int a = 0; a < 6; a++) {
        s->F[a] += both.Fi[a];
        ck_assert(both.Fj[a] == 0);
        for (int c = 0; c < 6; c++) {
            s->K[a][c] += both.Kii[a][c];
            ck_assert(both.Kij[a][c] == 0 && both.Kjj[a][c] == 0);
        }
    }
}

START_TEST(the_fixed_submatrix_is_the_derivative_of_the_energy_of_the_held_directions)
{
    for (int held = 0; held <= BBM_XY; held++) {
        const body b = body_of(&SHAPES[_i], 4);
        source s = { .i = &b, .P = 2, .k = 11, .wall = b.node[2] };
        s.wall.held = held;
        s.wall.wall[0] = 0.25;
        s.wall.wall[1] = -0.375;
        bbm_submatrix sub = ones();
        add_fixed_point(&b, 2, &s.wall, s.k, &sub);
        check_submatrix(fixed_energy, &s, &sub);
    }
}
END_TEST

/* ------------------------------------------------------------------------ 3.5, loads, (38)-(43) */

/* Checks a submatrix that has F alone. */
static void check_load(energy *Pi, const source *s, const double F[6])
{
    bbm_submatrix sub = ones();

    memcpy(sub.F, F, sizeof sub.F);
    check_submatrix(Pi, s, &sub);
}

/* Minus the work of the force f[0] at a corner. */
static double point_load_energy(const double D[], const source *s)
{
    double u[2];

    displace(s->i, D, s->i->v[s->P].x, s->i->v[s->P].y, u);
    return -(s->f[0][0] * u[0] + s->f[0][1] * u[1]);
}

START_TEST(a_concentrated_load_is_the_derivative_of_its_potential)
{
    const body b = body_of(&SHAPES[_i], 5);
    source s = { .i = &b, .P = 1, .f = { { 2, -3 } } };
    bbm_submatrix sub = ones();
    bbm_point_load(&b.e, b.v[s.P].x, b.v[s.P].y, s.f[0], sub.F);
    check_load(point_load_energy, &s, sub.F);
}
END_TEST

/* Minus the work of f(s) = sum f[n] s^n along the line from corner P to corner Q: u = ua + (ub -
 * ua) s is linear, so that the integral is one of powers, (39)-(41). */
static double line_load_energy(const double D[], const source *s)
{
    const bbm_vertex *a = &s->i->v[s->P], *b = &s->i->v[s->Q];
    const double length = sqrt((b->x - a->x) * (b->x - a->x) + (b->y - a->y) * (b->y - a->y));
    double ua[2], ub[2], work = 0;

    displace(s->i, D, a->x, a->y, ua);
    displace(s->i, D, b->x, b->y, ub);
    for (int n = 0; n < 7; n++)
        for (int r = 0; r < 2; r++)
            work += s->f[n][r] * (ua[r] / (n + 1) + (ub[r] - ua[r]) / (n + 2));
    return -length * work;
}

START_TEST(gauss_points_integrate_polynomials_to_degree_seven)
{
    for (int degree = 0; degree <= 8; degree++) {
        double sum = 0, s, weight, last = 0;
        for (int g = 0; g < BBM_GAUSS; g++) {
            bbm_gauss_point(g, &s, &weight);
            ck_assert(s > last && s < 1 && weight > 0);
            last = s;
            sum += weight * pow(s, degree);
        }
        if (degree < 8)
            ck_near(sum, 1.0 / (degree + 1), 1, ROUNDING);
        else
            ck_assert(fabs(sum - 1.0 / 9) > 1e-6);  /* the error term is 2e-5 */
    }
}
END_TEST

/* Four Gauss points integrate degree 7: a load of degree 6 times the linear T. */
START_TEST(a_load_that_varies_along_a_line_is_the_derivative_of_its_potential)
{
    unsigned seed = 7;
    body b;

    make_body(&b, &SHAPES[_i], 3, -2, &seed);
    for (int degree = 0; degree < 7; degree++) {
        source s = { .i = &b, .P = 1, .Q = 2 };
        /* which nobody may read */
        double f[BBM_GAUSS + 1][2] = { [BBM_GAUSS] = { INFINITY, INFINITY } };
        for (int n = 0; n <= degree; n++)
            for (int r = 0; r < 2; r++)
                s.f[n][r] = random_number(&seed);
        for (int g = 0; g < BBM_GAUSS; g++) {
            double at, weight;
            bbm_gauss_point(g, &at, &weight);
            for (int n = 0; n <= degree; n++)
                for (int r = 0; r < 2; r++)
                    f[g][r] += s.f[n][r] * pow(at, n);
        }
        bbm_submatrix sub = ones();
        bbm_varying_load_submatrix(&b.e, &b.v[s.P], &b.v[s.Q], (const double (*)[2])f, sub.F);
        check_load(line_load_energy, &s, sub.F);
    }
}
END_TEST

START_TEST(a_load_constant_along_a_line_is_the_derivative_of_its_potential)
{
    const body b = body_of(&SHAPES[_i], 6);
    source s = { .i = &b, .P = 1, .Q = 2, .f = { { 2, -3 } } };
    bbm_submatrix sub = ones();
    bbm_constant_load_submatrix(&b.e, &b.v[s.P], &b.v[s.Q], s.f[0], sub.F);
    check_load(line_load_energy, &s, sub.F);
}
END_TEST

/* ---------------------------------------------------------------- 3.6, volume forces, (44)-(47) */

/* The volume force f[0] + f[1] x + f[2] y. */
static void linear_force(double x, double y, const void *context, double f[2])
{
    const source *s = context;

    for (int r = 0; r < 2; r++)
        f[r] = s->f[0][r] + s->f[1][r] * x + s->f[2][r] * y;
}

static double power_density(double x, double y, const void *context)
{
    const moved *m = context;
    double u[2], f[2];

    displace(m->s->i, m->D, x, y, u);
    linear_force(x, y, m->s, f);
    return f[0] * u[0] + f[1] * u[1];
}

static double volume_energy(const double D[], const source *s)
{
    const moved m = { s, D };

    return -integral(s->i, power_density, &m);
}

START_TEST(a_volume_force_linear_in_x_and_y_is_the_derivative_of_its_potential)
{
    const body b = body_of(&SHAPES[_i], 8);
    source s = { .i = &b, .f = { { 2, -3 }, { 0.5, 1 }, { -1.5, 0.25 } } };
    bbm_submatrix sub = ones();
    bbm_varying_volume_submatrix(&b.e, b.v, linear_force, &s, sub.F);
    check_load(volume_energy, &s, sub.F);
}
END_TEST

START_TEST(a_constant_volume_force_is_the_derivative_of_its_potential)
{
    const body b = body_of(&SHAPES[_i], 9);
    source s = { .i = &b, .f = { { 2, -3 } } };
    bbm_submatrix sub = ones();
    bbm_volume_submatrix(&b.e, s.f[0], sub.F);
    check_load(volume_energy, &s, sub.F);
}
END_TEST

/* --------------------------------------------------------------------- 3.7, contacts, (48)-(64) */

/* Four encounters: each shape against each, not at a small distance, so that nothing is small by
 * chance. */
static source make_encounter(body *i, body *j, int which)
{
    unsigned seed = 10;

    make_body(i, &SHAPES[which / 2], 0.5, 0.75, &seed);
    make_body(j, &SHAPES[which % 2], -1.5, 0.25, &seed);
    return (source){            /* P3 comes before P2 */
        .i = i, .j = j, .k = 3, .anchor = 0.375,
        .touch = { &i->e, &j->e, &i->v[which % 3], &j->v[1], &j->v[0] }, .rest = 0.125,
    };
}

static void move_vertex(const body *b, const double D[6], const bbm_vertex *v, double x[2])
{
    displace(b, D, v->x, v->y, x);
    x[0] += v->x;
    x[1] += v->y;
}

/* S of the points moved by `way` times D, the determinant of (52) by its columns. */
static double moved_determinant(const source *s, const double D[UNKNOWNS], double way)
{
    double d[UNKNOWNS], p[3][2];

    for (int a = 0; a < UNKNOWNS; a++)
        d[a] = way * D[a];
    move_vertex(s->i, d, s->touch.P1, p[0]);
    move_vertex(s->j, d + 6, s->touch.P2, p[1]);
    move_vertex(s->j, d + 6, s->touch.P3, p[2]);
    return p[0][0] * (p[1][1] - p[2][1]) + p[1][0] * (p[2][1] - p[0][1]) +
           p[2][0] * (p[0][1] - p[1][1]);
}

static double edge_length(const source *s)
{
    return sqrt(pow(s->touch.P3->x - s->touch.P2->x, 2) + pow(s->touch.P3->y - s->touch.P2->y, 2));
}

/* d_n of (57): S is of second order in D, so that half the difference of S(D) and S(-D) is its
 * first-order part. */
static double normal_distance(const source *s, const double D[UNKNOWNS])
{
    const double first = (moved_determinant(s, D, 1) - moved_determinant(s, D, -1)) / 2;

    return (moved_determinant(s, D, 0) + first) / edge_length(s);
}

/* d_s of (61): the way of P1 from P0 along the edge as it was. */
static double slip(const source *s, const double D[UNKNOWNS])
{
    const bbm_vertex *P1 = s->touch.P1, *P2 = s->touch.P2, *P3 = s->touch.P3;
    const double r = s->anchor;
    const bbm_vertex P0 = { .x = (1 - r) * P3->x + r * P2->x, .y = (1 - r) * P3->y + r * P2->y };
    double p1[2], p0[2];

    move_vertex(s->i, D, P1, p1);
    move_vertex(s->j, D + 6, &P0, p0);
    return ((p1[0] - p0[0]) * (P3->x - P2->x) + (p1[1] - p0[1]) * (P3->y - P2->y)) / edge_length(s);
}

static double normal_energy(const double D[], const source *s)
{
    return s->k / 2 * pow(normal_distance(s, D) - s->rest, 2);
}

static double shear_energy(const double D[], const source *s)
{
    return s->k / 2 * pow(slip(s, D), 2);
}

/* Eq. (58), (63) and (59), (64): the submatrices of both elements. */
static void add_spring(double p, const bbm_spring *v, bbm_submatrices *s)
{
    bbm_spring_submatrix(p, v->v[0], v->v[0], s->Kii);
    bbm_spring_submatrix(p, v->v[0], v->v[1], s->Kij);
    bbm_spring_submatrix(p, v->v[1], v->v[1], s->Kjj);
    bbm_force_submatrix(p * v->d, v->v[0], s->Fi);
    bbm_force_submatrix(p * v->d, v->v[1], s->Fj);
}

START_TEST(the_normal_submatrices_are_derivatives_of_the_normal_springs_energy)
{
    bbm_spring n;
    body i, j;
    const source s = make_encounter(&i, &j, _i);
    bbm_submatrices sub = pair_of_ones();

    bbm_normal_vectors(&s.touch, &n);
    n.d -= s.rest;
    add_spring(s.k, &n, &sub);
    check_submatrices(normal_energy, &s, &sub);
}
END_TEST

START_TEST(the_shear_submatrices_are_derivatives_of_the_shear_springs_energy)
{
    bbm_spring v;
    body i, j;
    const source s = make_encounter(&i, &j, _i);
    bbm_submatrices sub = pair_of_ones();

    bbm_shear_vectors(&s.touch, s.anchor, &v);
    add_spring(s.k, &v, &sub);
    check_submatrices(shear_energy, &s, &sub);
}
END_TEST

static void make_polygon(body *b, int n, const double p[][2])
{
    b->e = (bbm_element){ .n = n };
    for (int k = 0; k < n; k++)
        b->v[k] = (bbm_vertex){ .x = p[k][0], .y = p[k][1] };
    bbm_element_geometry(&b->e, b->v);
}

/* The plate below the x axis with P3 before P2 on its boundary, and a triangle above, its lowest
 * corner at (x, y). */
static bbm_touch place_on_plate(body *i, body *j, double x, double y)
{
    const double plate[4][2] = { { 1, 0 }, { 0, 0 }, { 0, -1 }, { 1, -1 } };
    const double wedge[3][2] = { { x, y }, { x + 1, y + 1 }, { x - 1, y + 1 } };

    make_polygon(i, 3, wedge);
    make_polygon(j, 4, plate);
    return (bbm_touch){ &i->e, &j->e, &i->v[0], &j->v[1], &j->v[0] };
}

START_TEST(the_normal_distance_is_negative_inside_and_the_slip_positive_towards_P3)
{
    bbm_spring n, s;
    body i, j;
    const bbm_touch touch = place_on_plate(&i, &j, 0.5, _i ? -0.1 : 0.1);

    bbm_normal_vectors(&touch, &n);
    ck_near(n.d, _i ? -0.1 : 0.1, 1, ROUNDING);
    bbm_shear_vectors(&touch, 0.75, &s);  /* the anchor is at x = 0.25, P3 at x = 1 */
    ck_near(s.d, 0.25, 1, ROUNDING);
    ck_near(s.v[0][0], 1, 1, ROUNDING);                        /* to move i towards P3 is slip */
    ck_near(s.v[1][0], -1, 1, ROUNDING);
    ck_near(n.v[0][1], 1, 1, ROUNDING);                        /* to lift i opens */
    ck_near(n.v[1][1], -1, 1, ROUNDING);
}
END_TEST

/* Force and moment about (x, y) of generalised forces on both elements. */
static void resultant(const source *s, const bbm_spring *f, const double x[2], double R[3])
{
    const bbm_element *i = &s->i->e, *j = &s->j->e;

    R[0] = f->v[0][0] + f->v[1][0];
    R[1] = f->v[0][1] + f->v[1][1];
    R[2] = f->v[0][2] + (i->x - x[0]) * f->v[0][1] - (i->y - x[1]) * f->v[0][0] +
           f->v[1][2] + (j->x - x[0]) * f->v[1][1] - (j->y - x[1]) * f->v[1][0];
}

/* The normal force acts along one line on both sides. Shear and friction act at P1 and at P0, along
 * the edge: their moment is the force times the distance of P1 from the edge, about any point; at a
 * closed contact, next to nothing. */
START_TEST(contact_forces_are_equal_and_opposite_and_their_moment_is_that_of_the_gap)
{
    const double about[2][2] = { { 0, 0 }, { -7, 11 } };
    body i, j;
    const source c = make_encounter(&i, &j, _i);
    bbm_spring n, s;
    double R[3];

    bbm_normal_vectors(&c.touch, &n);
    bbm_shear_vectors(&c.touch, c.anchor, &s);
    for (int k = 0; k < 2; k++) {
        resultant(&c, &n, about[k], R);
        ck_near(R[0], 0, 10, ROUNDING);
        ck_near(R[1], 0, 10, ROUNDING);
        ck_near(R[2], 0, 10, ROUNDING);
        resultant(&c, &s, about[k], R);
        ck_near(R[0], 0, 1, ROUNDING);
        ck_near(R[1], 0, 1, ROUNDING);
        ck_near(R[2], -normal_distance(&c, (double[UNKNOWNS]){ 0 }), 10, ROUNDING);
    }
}
END_TEST

enum { ROUGH, SMOOTH, GLUED, COHESIVE };  /* (friction angle, cohesion, tension): see strength_of */

/* N tan(phi) = N; where the joint is whole cohesion gives 1 N, tensile strength 1.5 N. */
static bbm_strength strength_of(int kind, int whole)
{
    return (bbm_strength){ .tan_phi = kind == ROUGH || kind == GLUED,
                           .shear = whole && (kind == GLUED || kind == COHESIVE) ? 1 : 0,
                           .tension = whole && kind == GLUED ? 1.5 : 0 };
}

static const struct {
    int kind;
    bbm_contact_state was;
    int whole;
    double d_n, T, sign, slack;
    bbm_contact_state now;
} CELLS[] = {
    /* open: closes when crossed, whatever the strength; a force below the slack is none */
    { ROUGH,    BBM_OPEN,  0,  0.1,      0,     0, 0,    BBM_OPEN  },
    { ROUGH,    BBM_OPEN,  0,  0,        0,     0, 0,    BBM_OPEN  },
    { ROUGH,    BBM_OPEN,  0, -1e-9,     0,     0, 0,    BBM_LOCK  },
    { ROUGH,    BBM_OPEN,  0, -0.01,     0,     0, 1.5,  BBM_OPEN  },
    { ROUGH,    BBM_OPEN,  0, -0.02,     0,     0, 1.5,  BBM_LOCK  },
    { SMOOTH,   BBM_OPEN,  0, -0.02,     0,     0, 0,    BBM_LOCK  },
    { GLUED,    BBM_OPEN,  1,  0.01,     0,     0, 0,    BBM_OPEN  },
    { GLUED,    BBM_OPEN,  1, -0.01,     0,     0, 0,    BBM_LOCK  },
    { ROUGH,    BBM_OPEN,  0, -0.01,     0,     0, 1,    BBM_OPEN  },
    /* locked: opens under any tension, slack or not */
    { ROUGH,    BBM_LOCK,  0,  1e-12,    0,     0, 1,    BBM_OPEN  },
    { ROUGH,    BBM_LOCK,  0,  0,        0,     0, 0,    BBM_LOCK  },
    { ROUGH,    BBM_LOCK,  0, -0.02,     0,     0, 0,    BBM_LOCK  },
    { ROUGH,    BBM_LOCK,  1,  1e-12,    0,     0, 1,    BBM_OPEN  },
    /* locked: slips either way when the shear force passes N tan(phi) */
    { ROUGH,    BBM_LOCK,  0, -0.02,     1.9,   0, 0,    BBM_LOCK  },
    { ROUGH,    BBM_LOCK,  0, -0.02,    -1.9,   0, 0,    BBM_LOCK  },
    { ROUGH,    BBM_LOCK,  0, -0.02,     2.1,   0, 0,    BBM_SLIDE },
    { ROUGH,    BBM_LOCK,  0, -0.02,    -2.1,   0, 0,    BBM_SLIDE },
    { ROUGH,    BBM_LOCK,  0, -0.02,     2.1,   0, 0.2,  BBM_LOCK  },
    { ROUGH,    BBM_LOCK,  0, -0.02,    -2.3,   0, 0.2,  BBM_SLIDE },
    /* sliding: opens; goes on; locks when the friction is more than what the spring would carry,
     * or turns round */
    { ROUGH,    BBM_SLIDE, 0,  1e-12,    9,     1, 1,    BBM_OPEN  },
    { ROUGH,    BBM_SLIDE, 0, -0.02,     2.1,   1, 0,    BBM_SLIDE },
    { ROUGH,    BBM_SLIDE, 0, -0.02,     1.9,   1, 0,    BBM_LOCK  },
    { ROUGH,    BBM_SLIDE, 0, -0.02,    -2.1,   1, 0,    BBM_LOCK  },
    { ROUGH,    BBM_SLIDE, 0, -0.02,    -2.1,  -1, 0,    BBM_SLIDE },
    { ROUGH,    BBM_SLIDE, 0, -0.02,    -1.9,  -1, 0,    BBM_LOCK  },
    { ROUGH,    BBM_SLIDE, 0, -0.02,     2.1,  -1, 0,    BBM_LOCK  },
    { ROUGH,    BBM_SLIDE, 0, -0.02,     1.9,   1, 0.2,  BBM_SLIDE },
    { ROUGH,    BBM_SLIDE, 0, -0.02,     1.7,   1, 0.2,  BBM_LOCK  },
    /* without friction and cohesion there is no shear spring at all */
    { SMOOTH,   BBM_LOCK,  0, -0.02,     0,     0, 0,    BBM_SLIDE },
    { SMOOTH,   BBM_SLIDE, 0, -0.02,     0,     1, 0,    BBM_SLIDE },
    { SMOOTH,   BBM_SLIDE, 0, -0.02,    -5,     1, 0,    BBM_SLIDE },
    { SMOOTH,   BBM_LOCK,  0,  1e-12,    0,     0, 0,    BBM_OPEN  },
    { SMOOTH,   BBM_SLIDE, 0,  1e-12,    0,     1, 0,    BBM_OPEN  },
    /* cohesion alone, and with friction: the bound is N + 1 */
    { COHESIVE, BBM_LOCK,  1, -0.02,     0.9,   0, 0,    BBM_LOCK  },
    { COHESIVE, BBM_LOCK,  1, -0.02,    -1.1,   0, 0,    BBM_SLIDE },
    { COHESIVE, BBM_LOCK,  1,  0,        1,     0, 0,    BBM_LOCK  },          /* 1 is the bound */
    { COHESIVE, BBM_SLIDE, 1,  0,        1,     1, 0,    BBM_SLIDE },
    { COHESIVE, BBM_LOCK,  1,  1e-12,    0,     0, 0,    BBM_OPEN  },
    { GLUED,    BBM_LOCK,  1, -0.02,     2.9,   0, 0,    BBM_LOCK  },
    { GLUED,    BBM_LOCK,  1, -0.02,     3.1,   0, 0,    BBM_SLIDE },
    /* an unbroken joint stands tension up to 1.5, and shear up to what is left of the bound */
    { GLUED,    BBM_LOCK,  1,  0.0149,   0,     0, 0,    BBM_LOCK  },
    { GLUED,    BBM_LOCK,  1,  0.015,    0,     0, 0,    BBM_LOCK  },
    { GLUED,    BBM_LOCK,  1,  0.0151,   0,     0, 1,    BBM_OPEN  },
    { GLUED,    BBM_LOCK,  1,  0.005,    0.4,   0, 0,    BBM_LOCK  },
    { GLUED,    BBM_LOCK,  1,  0.005,   -0.6,   0, 0,    BBM_SLIDE },
    { GLUED,    BBM_LOCK,  1,  0.0125,   0.1,   0, 0,    BBM_SLIDE },
    { GLUED,    BBM_LOCK,  1,  0.0125,   0.1,   0, 0.2,  BBM_LOCK  },
    /* a broken one does not, nor one that slides */
    { GLUED,    BBM_LOCK,  0,  1e-12,    0,     0, 0,    BBM_OPEN  },
    { GLUED,    BBM_SLIDE, 0,  1e-12,    9,     1, 0,    BBM_OPEN  },
};

static const char *const STATE[] = { "OPEN", "LOCK", "SLIDE" };

START_TEST(each_cell_of_the_table_of_states_is_as_written)
{
    const double p_n = 100, p_s = 40;
    const bbm_contact c = { .state = CELLS[_i].was, .sign = CELLS[_i].sign, .d_n = CELLS[_i].d_n,
                            .d_s = CELLS[_i].T / p_s, .T = CELLS[_i].T,
                            .N = -p_n * CELLS[_i].d_n, .strength
                                = strength_of(CELLS[_i].kind, CELLS[_i].whole) };

    const bbm_contact_state now = bbm_next_state(&c, c.N, CELLS[_i].slack);
    ck_assert_msg(now == CELLS[_i].now, "row %d: %s becomes %s, expected %s", _i,
                  STATE[c.state], STATE[now], STATE[CELLS[_i].now]);
}
END_TEST

/* --------------------------------------------------------------------- 3.8, friction, (65)-(69) */

START_TEST(the_shear_strength_is_that_of_mohr_and_coulomb)
{
    const double phi[4] = { 0, 30, 45, 60 }, tangent[4] = { 0, 1 / sqrt(3), 1, sqrt(3) };
    bbm_strength s = { .tan_phi = bbm_tangent(phi[_i]) };

    ck_near(bbm_shear_strength(&s, 7), 7 * tangent[_i], 7, ROUNDING);
    s.shear = 1.5;
    ck_near(bbm_shear_strength(&s, 7), 7 * tangent[_i] + 1.5, 7, ROUNDING);
    ck_near(bbm_shear_strength(&s, -1), fmax(0, 1.5 - tangent[_i]), 1, ROUNDING);
    /* it never drives a slip */
    ck_near(bbm_shear_strength(&s, -100), _i ? 0 : 1.5, 1, ROUNDING);
}
END_TEST

/* The work against the friction force, which does not change in a solution. */
static double friction_energy(const double D[], const source *s)
{
    return s->k * slip(s, D);
}

START_TEST(the_friction_submatrices_are_derivatives_of_the_work_against_friction)
{
    bbm_spring v;
    body i, j;
    const source s = make_encounter(&i, &j, _i);
    bbm_submatrices sub = pair_of_ones();

    bbm_shear_vectors(&s.touch, s.anchor, &v);
    bbm_force_submatrix(s.k, v.v[0], sub.Fi);
    bbm_force_submatrix(s.k, v.v[1], sub.Fj);
    check_submatrices(friction_energy, &s, &sub);
}
END_TEST

/* P1 slips to the right, towards P3: friction pulls its element to the left and the plate to the
 * right. */
START_TEST(friction_opposes_the_slip_on_both_sides)
{
    bbm_submatrices s = { .Fi = { 0 } };
    bbm_spring v;
    body i, j;
    const bbm_touch touch = place_on_plate(&i, &j, 0.5, 0);

    bbm_shear_vectors(&touch, 0.5, &v);
    bbm_force_submatrix(2, v.v[0], s.Fi);
    bbm_force_submatrix(2, v.v[1], s.Fj);
    ck_near(s.Fi[0], -2, 1, ROUNDING);
    ck_near(s.Fj[0], 2, 1, ROUNDING);
    ck_near(s.Fi[1], 0, 1, ROUNDING);
    ck_near(s.Fj[1], 0, 1, ROUNDING);
    /* the wedge's barycentre is 2/3 above its corner */
    ck_near(s.Fi[2], -2 * (2.0 / 3), 1, ROUNDING);
}
END_TEST

/* ------------------------------------------------------- Fig. 8, the update; section 4, results */

START_TEST(von_mises_stress_is_that_of_its_principal_stresses)
{
    const double tension[3] = { -3, 0, 0 }, shear[3] = { 0, 0, 2 }, any[3] = { 5, -1, 4 };
    /* of Mohr's circle */
    const double middle = 2, radius = 5, s1 = middle + radius, s2 = middle - radius;

    ck_relative(bbm_mises(tension, 0), 3, ROUNDING);
    ck_relative(bbm_mises(shear, 0), 2 * sqrt(3.0), ROUNDING);
    ck_relative(bbm_mises(any, 0), sqrt(((s1 - s2) * (s1 - s2) + s1 * s1 + s2 * s2) / 2), ROUNDING);
}
END_TEST

Suite *formulas_suite(void)
{
    Suite *s = suite_create("formulas");
    const int shapes = COUNT(SHAPES);

    add_case(s, "2.1 displacements",
        { the_mode_matrix_moves_points_by_translation_rotation_and_strain, shapes });
    add_case(s, "2.2 stiffness",
        { the_bonding_stiffness_has_its_value_in_either_order_of_elements_and_at_any_strain, 1 });
    add_case(s, "3.1 elastic",
        { hookes_law_gives_uniaxial_tension_and_pure_shear_their_strains, 1 },
        { the_elastic_submatrix_is_the_derivative_of_the_strain_energy, shapes });
    add_case(s, "3.2 inertia",
        { moments_of_polygons_have_their_closed_forms_also_far_from_the_origin, COUNT(AREAS) },
        { the_mode_integral_is_the_brute_force_integral, shapes },
        { the_inertia_submatrix_is_the_derivative_of_its_energy, shapes },
        { newmark_carries_a_constant_acceleration_without_error, 1 },
        { a_step_hands_on_the_share_of_the_velocity_that_is_kept, 1 });
    add_case(s, "3.3 bonding",
        { the_bonding_submatrices_are_derivatives_of_the_springs_energy, shapes });
    add_case(s, "3.4 fixed",
        { the_fixed_submatrix_is_the_derivative_of_the_energy_of_the_held_directions, shapes });
    add_case(s, "3.5 loads",
        { a_concentrated_load_is_the_derivative_of_its_potential, shapes },
        { gauss_points_integrate_polynomials_to_degree_seven, 1 },
        { a_load_that_varies_along_a_line_is_the_derivative_of_its_potential, shapes },
        { a_load_constant_along_a_line_is_the_derivative_of_its_potential, shapes });
    add_case(s, "3.6 volume",
        { a_volume_force_linear_in_x_and_y_is_the_derivative_of_its_potential, shapes },
        { a_constant_volume_force_is_the_derivative_of_its_potential, shapes });
    add_case(s, "3.7 contact",
        { the_normal_submatrices_are_derivatives_of_the_normal_springs_energy, 4 },
        { the_shear_submatrices_are_derivatives_of_the_shear_springs_energy, 4 },
        { the_normal_distance_is_negative_inside_and_the_slip_positive_towards_P3, 2 },
        { contact_forces_are_equal_and_opposite_and_their_moment_is_that_of_the_gap, 4 },
        { each_cell_of_the_table_of_states_is_as_written, COUNT(CELLS) });
    add_case(s, "3.8 friction",
        { the_shear_strength_is_that_of_mohr_and_coulomb, 4 },
        { the_friction_submatrices_are_derivatives_of_the_work_against_friction, 4 },
        { friction_opposes_the_slip_on_both_sides, 1 });
    add_case(s, "results",
        { von_mises_stress_is_that_of_its_principal_stresses, 1 });
    return s;
}
