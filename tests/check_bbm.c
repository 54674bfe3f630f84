/* check_bbm.c - tests of bbm.c; the name of each test is what it shows.
 *
 * Nothing here is compared with what the program once printed. The oracles are
 *   - the potential energies of section 3, written from the physics and integrated by another route. All are quadratic
 *     in D, so that their central differences are exact for any step and are the submatrices but for rounding;
 *   - closed forms: moments of area, bars in tension, free fall, the recurrence of a vibrating element;
 *   - the constant-strain finite element, assembled and solved here;
 *   - invariants: symmetry, momentum, balance of forces, rigid motion without strain.
 *
 * Tolerances. 1e-12 to 1e-14: a few operations on numbers near 1, rounding only (eps = 2e-16). 1e-9 to 1e-11: after a
 * solve, rounding times the condition number, about 10 alpha on these small meshes. Where a tolerance is larger, what
 * it has to let pass is said beside it.
 */
#include <stddef.h>
#include <stdio.h>
#include <string.h>

#include "check.h"

#define ROUNDING 1e-12
#define SOLVED   1e-9

#define COUNT(array) ((int)(sizeof (array) / sizeof (array)[0]))

enum { CORNERS = 6, UNKNOWNS = 12 };

/* A number in [-1, 1], in the same order in every run (Numerical Recipes' linear congruence). */
static double random_number(unsigned *seed)
{
    *seed = (1664525u * *seed + 1013904223u) & 0xffffffffu;
    return (double)(*seed >> 8) / 8388608.0 - 1;
}

/* ------------------------------------------------------------------ polygons, integrated by triangles made by hand */

typedef struct {
    int n, triangles;
    double x[CORNERS][2];
    int triangle[CORNERS][3];
} shape;

/* The last is not convex, and its corner 0 does not see all of it. */
static const shape SHAPES[] = {
    { 3, 1, { { 0.25, 0.5 }, { 2, 0.75 }, { 1, 2.25 } }, { { 0, 1, 2 } } },
    { 4, 2, { { -1, -0.5 }, { 1.5, -1 }, { 2, 1.25 }, { -0.5, 1 } }, { { 0, 1, 2 }, { 0, 2, 3 } } },
    { 6, 4, { { 3, 1 }, { 1, 1.5 }, { 1.5, 3 }, { 0, 2.5 }, { 0, 0 }, { 3, 0 } },
      { { 1, 2, 3 }, { 1, 3, 4 }, { 1, 4, 5 }, { 1, 5, 0 } } },
};

typedef struct {                /* one element of such a shape, with what the oracle knows of it by itself */
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
    const double r = sqrt(15.0), p = (6 - r) / 21, q = (6 + r) / 21, wp = (155 - r) / 1200, wq = (155 + r) / 1200;
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
        const double twice = (v[1]->x - v[0]->x) * (v[2]->y - v[0]->y) - (v[2]->x - v[0]->x) * (v[1]->y - v[0]->y);
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

static double one(double x, double y, const void *context) { (void)x; (void)y; (void)context; return 1; }
static double just_x(double x, double y, const void *context) { (void)y; (void)context; return x; }
static double just_y(double x, double y, const void *context) { (void)x; (void)context; return y; }

/* An element of the shape at (dx, dy) with random displacements behind it, of another area at the start. */
static void make_body(body *b, const shape *s, double dx, double dy, unsigned *seed)
{
    memset(b, 0, sizeof *b);
    b->s = s;
    for (int c = 0; c < s->n; c++) {
        const double u = random_number(seed) / 8, v = random_number(seed) / 8, x = s->x[c][0] + dx, y = s->x[c][1] + dy;
        b->node[c] = (bbm_node){ .x = x - u, .y = y - v };
        b->v[c] = (bbm_vertex){ .node = c, .x = x, .y = y, .u = u, .v = v };
    }
    b->A = integral(b, one, NULL);
    b->x = integral(b, just_x, NULL) / b->A;
    b->y = integral(b, just_y, NULL) / b->A;
    b->e = (bbm_element){ .n = s->n, .material = { .E = 7, .nu = 0.3, .density = 3, .thickness = 0.75 } };
    bbm_element_geometry(&b->e, b->v);
    b->e.A0 = 1.25 * b->A;
    for (int a = 0; a < 6; a++)
        b->e.V[a] = random_number(seed);
    for (int a = 0; a < 3; a++)
        b->e.stress[a] = random_number(seed);
}

/* The displacement of the body's point (x, y): translation, small rotation and strain about the barycentre. */
static void displace(const body *b, const double D[6], double x, double y, double u[2])
{
    const double X = x - b->x, Y = y - b->y;

    u[0] = D[0] - D[2] * Y + D[3] * X + D[5] / 2 * Y;
    u[1] = D[1] + D[2] * X + D[4] * Y + D[5] / 2 * X;
}

/* ------------------------------------------------------- submatrices are derivatives of potential energies */

typedef struct {                /* what the energies depend on */
    const body *i, *j;
    int P, Q;                   /* corners of i and of j */
    double k, dt;
    bbm_node wall;
    double f[7][2];             /* coefficients of a load */
} source;

typedef double energy(const double D[UNKNOWNS], const source *s);

/* Fails unless K is the second derivative of the energy and K D - F its first, at random D. */
static void check_derivatives(energy *Pi, const source *s, int n, double K[UNKNOWNS][UNKNOWNS], const double F[])
{
    unsigned seed = 7;
    double D[UNKNOWNS] = { 0 }, at[2][2], size = 1;

    for (int a = 0; a < n * n; a++)
        size = fmax(size, fabs(K[a / n][a % n]));
    for (int a = 0; a < n; a++)
        D[a] = random_number(&seed);
    for (int a = 0; a < n; a++) {
        double KD = 0;
        for (int b = 0; b < n; b++) {
            for (int g = 0; g < 4; g++) {
                D[a] += g / 2 ? 1 : -1;
                D[b] += g % 2 ? 1 : -1;
                at[g / 2][g % 2] = Pi(D, s);
                D[a] -= g / 2 ? 1 : -1;
                D[b] -= g % 2 ? 1 : -1;
            }
            ck_near(K[a][b], (at[1][1] - at[1][0] - at[0][1] + at[0][0]) / 4, size, 1e-11);     /* energies: 50 size */
            KD += K[a][b] * D[b];
        }
        D[a] += 1;
        const double above = Pi(D, s);
        D[a] -= 2;
        const double below = Pi(D, s);
        D[a] += 1;
        ck_near(KD - F[a], (above - below) / 2, size, 1e-11);
    }
}

/* Places a 6x6 block at rows 6 i, columns 6 j and takes off the ones to which the function under test added. */
static void place(double K[UNKNOWNS][UNKNOWNS], int i, int j, double B[6][6], int transposed)
{
    for (int a = 0; a < 6; a++)
        for (int b = 0; b < 6; b++)
            K[6 * i + a][6 * j + b] = (transposed ? B[b][a] : B[a][b]) - 1;
}

static void fill_with_ones(double *x, size_t bytes)
{
    for (size_t a = 0; a < bytes / sizeof *x; a++)
        x[a] = 1;
}

static bbm_submatrix ones(void)
{
    bbm_submatrix s;

    fill_with_ones(&s.K[0][0], sizeof s.K);
    fill_with_ones(s.F, sizeof s.F);
    return s;
}

static void check_submatrix(energy *Pi, const source *s, bbm_submatrix *sub)
{
    double K[UNKNOWNS][UNKNOWNS] = { { 0 } }, F[UNKNOWNS] = { 0 };

    place(K, 0, 0, sub->K, 0);
    for (int a = 0; a < 6; a++)
        F[a] = sub->F[a] - 1;
    check_derivatives(Pi, s, 6, K, F);
}

/* Strain energy of plane stress and the work of the stress that is already there, (6)-(9). */
static double elastic_energy(const double D[], const source *s)
{
    const bbm_material *m = &s->i->e.material;
    const double *s0 = s->i->e.stress, G = m->E / 2 / (1 + m->nu), dilation = D[3] + D[4];
    const double sx = m->E / (1 - m->nu) * dilation / 2 + G * (D[3] - D[4]);
    const double sy = m->E / (1 - m->nu) * dilation / 2 - G * (D[3] - D[4]);

    return m->thickness * s->i->A *
           ((sx * D[3] + sy * D[4] + G * D[5] * D[5]) / 2 + s0[0] * D[3] + s0[1] * D[4] + s0[2] * D[5]);
}

typedef struct { const source *s; const double *D; } moved;

/* |u - dt v|^2 at a point. */
static double lag(double x, double y, const void *context)
{
    const moved *m = context;
    double u[2], v[2];

    displace(m->s->i, m->D, x, y, u);
    displace(m->s->i, m->s->i->e.V, x, y, v);
    return (u[0] - m->s->dt * v[0]) * (u[0] - m->s->dt * v[0]) + (u[1] - m->s->dt * v[1]) * (u[1] - m->s->dt * v[1]);
}

/* The force -M u'' = -2M/dt^2 (u - dt v) is that of a spring to where the velocity alone would carry a point; the mass
 * is that of the starting area, (11)-(13). */
static double inertia_energy(const double D[], const source *s)
{
    const bbm_element *e = &s->i->e;
    const moved m = { s, D };
    const double mass = e->material.density * e->material.thickness * e->A0;

    return mass / s->i->A / (s->dt * s->dt) * integral(s->i, lag, &m);
}

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

/* The same to the wall point, in the held directions, (36). */
static double fixed_energy(const double D[], const source *s)
{
    const bbm_vertex *P = &s->i->v[s->P];
    const bbm_node *W = &s->wall;
    double p[2], Pi = 0;

    displace(s->i, D, P->x, P->y, p);
    const double dx = P->x + p[0] - (W->x + W->wall[0]), dy = P->y + p[1] - (W->y + W->wall[1]);
    if (W->held != BBM_Y)
        Pi += s->k / 2 * dx * dx;
    if (W->held != BBM_X)
        Pi += s->k / 2 * dy * dy;
    return Pi;
}

/* Minus the work of the force f[0] at a corner. */
static double point_load_energy(const double D[], const source *s)
{
    double u[2];

    displace(s->i, D, s->i->v[s->P].x, s->i->v[s->P].y, u);
    return -(s->f[0][0] * u[0] + s->f[0][1] * u[1]);
}

/* Minus the work of f(s) = sum f[n] s^n along the line from corner P to corner Q: u = ua + (ub - ua) s is linear, so
 * that the integral is one of powers, (39)-(41). */
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

START_TEST(the_elastic_submatrix_is_the_derivative_of_the_strain_energy)
{
    unsigned seed = 1;
    body b;

    make_body(&b, &SHAPES[_i], 3, -2, &seed);
    source s = { .i = &b };
    bbm_submatrix sub = ones();
    bbm_elastic_submatrix(&b.e, &sub);
    check_submatrix(elastic_energy, &s, &sub);
}
END_TEST

START_TEST(the_inertia_submatrix_is_the_derivative_of_its_energy)
{
    unsigned seed = 2;
    body b;

    make_body(&b, &SHAPES[_i], 3, -2, &seed);
    source s = { .i = &b, .dt = 0.7 };
    bbm_submatrix sub = ones();
    bbm_inertia_submatrix(&b.e, s.dt, &sub);
    check_submatrix(inertia_energy, &s, &sub);
}
END_TEST

START_TEST(the_bonding_submatrices_are_derivatives_of_the_springs_energy)
{
    unsigned seed = 3;
    body i, j;

    make_body(&i, &SHAPES[_i], 3, -2, &seed);
    make_body(&j, &SHAPES[(_i + 1) % COUNT(SHAPES)], 5, -1, &seed);
    source s = { .i = &i, .j = &j, .P = 1, .Q = 2, .k = 11 };
    bbm_vertex *P = &i.v[s.P], *Q = &j.v[s.Q];          /* one point at the start: Q displaced by what P - Q asks */
    Q->u = P->u + Q->x - P->x;
    Q->v = P->v + Q->y - P->y;
    bbm_submatrices sub;
    fill_with_ones(&sub.Kii[0][0], sizeof sub.Kii);
    fill_with_ones(&sub.Kij[0][0], sizeof sub.Kij);
    fill_with_ones(&sub.Kjj[0][0], sizeof sub.Kjj);
    fill_with_ones(sub.Fi, sizeof sub.Fi);
    fill_with_ones(sub.Fj, sizeof sub.Fj);
    bbm_bonding_submatrices(&i.e, P, &j.e, Q, s.k, &sub);
    double K[UNKNOWNS][UNKNOWNS], F[UNKNOWNS];
    place(K, 0, 0, sub.Kii, 0);
    place(K, 0, 1, sub.Kij, 0);
    place(K, 1, 0, sub.Kij, 1);
    place(K, 1, 1, sub.Kjj, 0);
    for (int a = 0; a < 6; a++) {
        F[a] = sub.Fi[a] - 1;
        F[6 + a] = sub.Fj[a] - 1;
    }
    check_derivatives(bonding_energy, &s, UNKNOWNS, K, F);
}
END_TEST

START_TEST(the_fixed_submatrix_is_the_derivative_of_the_energy_of_the_held_directions)
{
    for (int held = BBM_X; held <= BBM_XY; held++) {
        unsigned seed = 4;
        body b;
        make_body(&b, &SHAPES[_i], 3, -2, &seed);
        source s = { .i = &b, .P = 2, .k = 11, .wall = b.node[2] };
        s.wall.held = held;
        s.wall.wall[0] = 0.25;
        s.wall.wall[1] = -0.375;
        bbm_submatrix sub = ones();
        bbm_fixed_submatrix(&b.e, &b.v[2], &s.wall, s.k, &sub);
        check_submatrix(fixed_energy, &s, &sub);
    }
}
END_TEST

START_TEST(a_point_that_is_not_held_adds_nothing)
{
    unsigned seed = 4;
    body b;

    make_body(&b, &SHAPES[0], 3, -2, &seed);
    bbm_submatrix sub = ones();
    bbm_fixed_submatrix(&b.e, &b.v[2], &b.node[2], 11, &sub);
    for (int a = 0; a < 36; a++)
        ck_assert(sub.K[a / 6][a % 6] == 1 && sub.F[a % 6] == 1);
}
END_TEST

/* Checks a submatrix that has F alone. */
static void check_load(energy *Pi, const source *s, const double F[6])
{
    bbm_submatrix sub = ones();

    memcpy(sub.F, F, sizeof sub.F);
    check_submatrix(Pi, s, &sub);
}

START_TEST(a_concentrated_load_is_the_derivative_of_its_potential)
{
    unsigned seed = 5;
    body b;

    make_body(&b, &SHAPES[_i], 3, -2, &seed);
    source s = { .i = &b, .P = 1, .f = { { 2, -3 } } };
    bbm_submatrix sub = ones();
    bbm_point_load(&b.e, &b.v[s.P], s.f[0], sub.F);
    check_load(point_load_energy, &s, sub.F);
}
END_TEST

START_TEST(a_load_constant_along_a_line_is_the_derivative_of_its_potential)
{
    unsigned seed = 6;
    body b;

    make_body(&b, &SHAPES[_i], 3, -2, &seed);
    source s = { .i = &b, .P = 1, .Q = 2, .f = { { 2, -3 } } };
    bbm_submatrix sub = ones();
    bbm_constant_load_submatrix(&b.e, &b.v[s.P], &b.v[s.Q], s.f[0], sub.F);
    check_load(line_load_energy, &s, sub.F);
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
        double f[BBM_GAUSS + 1][2] = { [BBM_GAUSS] = { INFINITY, INFINITY } };      /* which nobody may read */
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

START_TEST(a_volume_force_linear_in_x_and_y_is_the_derivative_of_its_potential)
{
    unsigned seed = 8;
    body b;

    make_body(&b, &SHAPES[_i], 3, -2, &seed);
    source s = { .i = &b, .f = { { 2, -3 }, { 0.5, 1 }, { -1.5, 0.25 } } };
    bbm_submatrix sub = ones();
    bbm_varying_volume_submatrix(&b.e, b.v, linear_force, &s, sub.F);
    check_load(volume_energy, &s, sub.F);
}
END_TEST

START_TEST(a_constant_volume_force_is_the_derivative_of_its_potential)
{
    unsigned seed = 9;
    body b;

    make_body(&b, &SHAPES[_i], 3, -2, &seed);
    source s = { .i = &b, .f = { { 2, -3 } } };
    bbm_submatrix sub = ones();
    bbm_volume_submatrix(&b.e, s.f[0], sub.F);
    check_load(volume_energy, &s, sub.F);
}
END_TEST

/* --------------------------------------------------------------------------------------- single formulas */

/* Closed forms of area, barycentre and second moments. */
static const struct { int n; double x[CORNERS][2], A, at[2], Sxx, Syy, Sxy; } AREAS[] = {
    { 4, { { 1, 2 }, { 4, 2 }, { 4, 4 }, { 1, 4 } }, 6, { 2.5, 3 }, 4.5, 2, 0 },                /* b^3 h / 12    */
    { 3, { { 0, 0 }, { 3, 0 }, { 0, 2 } }, 3, { 1, 2.0 / 3 }, 1.5, 2.0 / 3, -0.5 },             /* b^3 h / 36    */
    { 6, { { 0, 0 }, { 2, 0 }, { 2, 1 }, { 1, 1 }, { 1, 2 }, { 0, 2 } },                        /* two squares   */
      3, { 5.0 / 6, 5.0 / 6 }, 11.0 / 12, 11.0 / 12, -1.0 / 3 },
    { 6, { { 1, 1 }, { 1, 2 }, { 0, 2 }, { 0, 0 }, { 2, 0 }, { 2, 1 } },                        /* from elsewhere */
      3, { 5.0 / 6, 5.0 / 6 }, 11.0 / 12, 11.0 / 12, -1.0 / 3 },
};

/* Far away the corners are still exact, and the barycentre is as exact as a number of that size can be: half a unit in
 * the last place of 2^21 is 2.3e-10 m. The moments about it must not suffer. */
START_TEST(moments_of_polygons_have_their_closed_forms_also_far_from_the_origin)
{
    const double far[3][2] = { { 0, 0 }, { 2097152, -1048576 }, { -1048576, 2097152 } };

    for (int o = 0; o < 3; o++) {
        const double reach = o == 0 ? ROUNDING : 5e-10;
        bbm_element e = { .n = AREAS[_i].n };
        bbm_vertex v[CORNERS];
        for (int c = 0; c < e.n; c++)
            v[c] = (bbm_vertex){ .x = AREAS[_i].x[c][0] + far[o][0], .y = AREAS[_i].x[c][1] + far[o][1] };
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

START_TEST(the_mode_matrix_moves_points_by_translation_rotation_and_strain)
{
    unsigned seed = 11;
    body b;

    make_body(&b, &SHAPES[_i], 3, -2, &seed);
    for (int trial = 0; trial < 5; trial++) {
        const double x = 4 * random_number(&seed), y = 4 * random_number(&seed);
        double T[2][6], u[3] = { 0, 0, 7 }, expected[2];
        for (int a = 0; a < 6; a++)
            b.e.D[a] = random_number(&seed);
        displace(&b, b.e.D, x, y, expected);
        bbm_displacement(&b.e, x, y, u);
        bbm_mode_matrix(&b.e, x, y, T);
        for (int r = 0; r < 2; r++) {
            double TD = 0;
            for (int a = 0; a < 6; a++)
                TD += T[r][a] * b.e.D[a];
            ck_near(u[r], expected[r], 1, ROUNDING);
            ck_near(TD, expected[r], 1, ROUNDING);
        }
        ck_assert(u[2] == 7);
    }
}
END_TEST

/* u = t + R (1 + e) X - X with R the rotation by r0, here by up to a radian. */
START_TEST(positions_follow_the_exact_rotation_in_dynamics_and_the_modes_otherwise)
{
    unsigned seed = 13;
    bbm_model *m;
    body b;

    ck_assert_int_eq(bbm_model_new(&m), BBM_OK);
    make_body(&b, &SHAPES[_i], 3, -2, &seed);
    for (int trial = 0; trial < 12; trial++) {
        const double x = 4 * random_number(&seed), y = 4 * random_number(&seed), X = x - b.x, Y = y - b.y;
        double D[6], u[2], expected[2];
        for (int a = 0; a < 6; a++)
            D[a] = random_number(&seed);
        m->par.rotation = trial % 3 == 1 ? BBM_LINEAR : BBM_EXACT;
        m->h = trial % 3 == 2 ? INFINITY : 0.1;
        displace(&b, D, x, y, expected);
        if (trial % 3 == 0) {
            const double p = (1 + D[3]) * X + D[5] / 2 * Y, q = D[5] / 2 * X + (1 + D[4]) * Y;
            expected[0] = D[0] + cos(D[2]) * p - sin(D[2]) * q - X;
            expected[1] = D[1] + sin(D[2]) * p + cos(D[2]) * q - Y;
        }
        bbm_move(m, &b.e, D, x, y, u);
        ck_near(u[0], expected[0], 10, ROUNDING);
        ck_near(u[1], expected[1], 10, ROUNDING);
    }
    bbm_model_free(m);
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
    unsigned seed = 12;
    body b;
    double M[6][6];

    make_body(&b, &SHAPES[_i], 3, -2, &seed);
    bbm_mode_integral(&b.e, M);
    for (int r = 0; r < 6; r++)
        for (int c = 0; c < 6; c++) {
            double D[12] = { 0 };
            D[r] = D[6 + c] = 1;
            const source s = { .i = &b };
            const moved m = { &s, D };
            ck_near(M[r][c], integral(&b, product, &m), 1, ROUNDING);
        }
}
END_TEST

START_TEST(hookes_law_gives_uniaxial_tension_and_pure_shear_their_strains)
{
    const bbm_material m = { .E = 7, .nu = 0.3 };
    const double strain[3][3] = { { 1 / 7.0, -0.3 / 7, 0 }, { -0.3 / 7, 1 / 7.0, 0 }, { 0, 0, 2 * 1.3 / 7 } };
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

/* G = 10/2.5 = 4 and 12/2 = 6, means of G 5 and of t 0.5. */
START_TEST(the_bonding_stiffness_is_alpha_G_t_times_the_ratio_of_the_areas_either_way_round)
{
    const bbm_element i = { .A0 = 2, .A = 9, .material = { .E = 10, .nu = 0.25, .thickness = 0.375 } };
    const bbm_element j = { .A0 = 3, .A = 9, .material = { .E = 12, .nu = 0, .thickness = 0.625 } };

    ck_relative(bbm_bonding_stiffness(8, &i, &j), 8 * 5 * 0.5 * 1.5, ROUNDING);
    ck_relative(bbm_bonding_stiffness(8, &j, &i), 8 * 5 * 0.5 * 1.5, ROUNDING);
    ck_relative(bbm_fixed_stiffness(8, &i), 8 * 4 * 0.375, ROUNDING);
}
END_TEST

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
            ck_assert(fabs(sum - 1.0 / 9) > 1e-6);                          /* the error term is 2e-5 */
    }
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
            ck_near(e.V[c], c == r ? V + a * dt : 0, 1, ROUNDING);
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

START_TEST(von_mises_stress_is_that_of_its_principal_stresses)
{
    const double tension[3] = { -3, 0, 0 }, shear[3] = { 0, 0, 2 }, any[3] = { 5, -1, 4 };
    const double middle = 2, radius = 5, s1 = middle + radius, s2 = middle - radius;     /* of Mohr's circle */

    ck_relative(bbm_mises(tension), 3, ROUNDING);
    ck_relative(bbm_mises(shear), 2 * sqrt(3.0), ROUNDING);
    ck_relative(bbm_mises(any), sqrt(((s1 - s2) * (s1 - s2) + s1 * s1 + s2 * s2) / 2), ROUNDING);
}
END_TEST

/* ---------------------------------------------------------------------------------------------- models */

static const bbm_material SOLID = { .E = 1000, .nu = 0.3, .density = 2, .thickness = 0.5 };
static const bbm_material CORK = { .E = 1000, .nu = 0, .density = 2, .thickness = 0.5 };

/* Statics in one step, which is linear elasticity on the starting geometry; solved as far as rounding allows. */
static bbm_model *new_model(const bbm_material *material)
{
    bbm_model *m;

    ck_assert_int_eq(bbm_model_new(&m), BBM_OK);
    m->par.bonding = BBM_VERTICES;         /* the paper's bonds; check_beyond.c has the others */
    ck_ok(bbm_add_material(m, material, NULL), m);
    m->par.pcg.tolerance = 1e-15;
    m->par.pcg.iterations = 1000;               /* several times what is needed: an error ends at once */
    return m;
}

typedef struct {                /* nx x ny cells on a rectangle, each one quadrilateral or two triangles */
    double x, y, lx, ly;
    int nx, ny, triangles;
    double jitter;              /* displacement of the inner nodes against the cell */
    int first, element;         /* its first node and element: set by add_grid */
} grid;

static int at(const grid *g, int i, int j)
{
    return g->first + j * (g->nx + 1) + i;
}

static void add_cell(bbm_model *m, const grid *g, int i, int j, int block)
{
    const int c[4] = { at(g, i, j), at(g, i + 1, j), at(g, i + 1, j + 1), at(g, i, j + 1) };
    const int rising[2][3] = { { c[0], c[1], c[2] }, { c[0], c[2], c[3] } };
    const int falling[2][3] = { { c[0], c[1], c[3] }, { c[1], c[2], c[3] } };
    const int material = m->materials - 1;

    if (!g->triangles)
        ck_ok(bbm_add_element(m, block, material, 4, c, NULL), m);
    for (int t = 0; t < 2 && g->triangles; t++)
        ck_ok(bbm_add_element(m, block, material, 3, (i + j) % 2 ? falling[t] : rising[t], NULL), m);
}

static void add_grid(bbm_model *m, grid *g, int block)
{
    unsigned seed = 5;

    g->first = m->nodes;
    g->element = m->elements;
    for (int j = 0; j <= g->ny; j++)
        for (int i = 0; i <= g->nx; i++) {
            const int inner = i > 0 && i < g->nx && j > 0 && j < g->ny;
            const double a = inner * g->jitter * random_number(&seed), b = inner * g->jitter * random_number(&seed);
            ck_ok(bbm_add_node(m, g->x + (i + a) * g->lx / g->nx, g->y + (j + b) * g->ly / g->ny, NULL), m);
        }
    for (int j = 0; j < g->ny; j++)
        for (int i = 0; i < g->nx; i++)
            add_cell(m, g, i, j, block);
}

/* Holds the left side of a grid and loads its right top corner: a cantilever, ready to run. */
static bbm_model *cantilever(const bbm_material *material, grid *g, double fx, double fy)
{
    bbm_model *m = new_model(material);

    add_grid(m, g, 0);
    for (int j = 0; j <= g->ny; j++)
        ck_ok(bbm_fix_node(m, at(g, 0, j), BBM_XY, 0, 0), m);
    ck_ok(bbm_add_load(m, at(g, g->nx, g->ny), fx, fy), m);
    ck_ok(bbm_prepare(m), m);
    return m;
}

/* One unit square of the given material: nodes 0 to 3, counter-clockwise from the origin. */
static bbm_model *unit_square(const bbm_material *material)
{
    const double x[4][2] = { { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 } };
    bbm_model *m = new_model(material);

    for (int n = 0; n < 4; n++)
        ck_ok(bbm_add_node(m, x[n][0], x[n][1], NULL), m);
    ck_ok(bbm_add_element(m, 0, 0, 4, (int[]){ 0, 1, 2, 3 }, NULL), m);
    return m;
}

/*   Points for polygons, a grid of 5 x 5:  20 21 22 23 24
 *                                          15 16 17 18 19
 *                                          10 11 12 13 14
 *                                           5  6  7  8  9
 *                                           0  1  2  3  4    and 25 at (1, 1e-13), 26 at (1, 1e-6), 27 at (1e-13, 1);
 *   all times a size.                                                                                             */
static bbm_model *points(double size)
{
    bbm_model *m = new_model(&SOLID);

    for (int n = 0; n < 25; n++)
        ck_ok(bbm_add_node(m, n % 5 * size, n / 5 * size, NULL), m);
    ck_ok(bbm_add_node(m, size, 1e-13 * size, NULL), m);
    ck_ok(bbm_add_node(m, size, 1e-6 * size, NULL), m);
    ck_ok(bbm_add_node(m, 1e-13 * size, size, NULL), m);
    return m;
}

static bbm_result result_at(const bbm_model *m, int node)
{
    bbm_result r;

    ck_assert_int_eq(bbm_nodal_result(m, node, -1, &r), BBM_OK);
    return r;
}

/* ------------------------------------------------------------------------------- K, dense, in the test's hands */

/* All of K, column by column. */
static double *dense_matrix(const bbm_model *m)
{
    const int n = 6 * m->elements;
    double *A = calloc((size_t)(n * n), sizeof *A), *x = calloc((size_t)n, sizeof *x);

    for (int c = 0; c < n; c++) {
        x[c] = 1;
        bbm_matrix_multiply(m->K, x, &A[c * n]);
        x[c] = 0;
    }
    free(x);
    return A;
}

/* Cholesky's elimination, always with the largest pivot left, which stops at one that is rounding: the number of
 * positive pivots. *least: the smallest diagonal entry that was left then, or 0. Destroys A. */
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
        if (A[p * (n + 1)] <= 1e-10 * size)             /* rounding: 1e-16 n; the smallest true ones here: 1e-5 */
            break;
        for (int a = r + 1; a < n; a++)
            for (int b = r + 1; b < n; b++)
                A[left[a] * n + left[b]] -= A[left[a] * n + p] * A[p * n + left[b]] / A[p * (n + 1)];
    }
    *least = 0;
    for (int a = r; a < n; a++)
        *least = fmin(*least, A[left[a] * (n + 1)] / size);
    free(left);
    return r;
}

/* Solves A x = b by elimination without pivots; A is positive definite. */
static void dense_solve(int n, double *A, double *b)
{
    for (int p = 0; p < n; p++)
        for (int r = p + 1; r < n; r++) {
            const double factor = A[r * n + p] / A[p * n + p];
            for (int c = p; c < n; c++)
                A[r * n + c] -= factor * A[p * n + c];
            b[r] -= factor * b[p];
        }
    for (int r = n - 1; r >= 0; r--) {
        for (int c = r + 1; c < n; c++)
            b[r] -= A[r * n + c] * b[c];
        b[r] /= A[r * n + r];
    }
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
    bbm_model_free(m);
}
END_TEST

/* A step of 1e12 s: the inertia left is 1e-24 of the stiffness. */
START_TEST(K_has_three_zero_pivots_when_nothing_holds_the_body)
{
    grid g = { .lx = 3, .ly = 2, .nx = 3, .ny = 2, .triangles = _i, .jitter = 0.2 };
    bbm_model *m = new_model(&SOLID);

    add_grid(m, &g, 0);
    ck_ok(bbm_prepare(m), m);
    m->par.dt = 1e12;
    bbm_step(m);
    const int n = 6 * m->elements;
    double *A = dense_matrix(m), least;
    ck_assert_int_eq(rank(n, A, &least), n - 3);
    ck_assert(least > -1e-12);
    free(A);
    bbm_model_free(m);
}
END_TEST

START_TEST(a_rigid_motion_of_bonded_elements_costs_nothing)
{
    grid g = { .lx = 3, .ly = 2, .nx = 3, .ny = 2, .triangles = _i, .jitter = 0.2 };
    const double motion[3] = { 0.5, -2, 1.5 };                             /* u, v at the origin, rotation */
    bbm_model *m = new_model(&SOLID);

    add_grid(m, &g, 0);
    ck_ok(bbm_prepare(m), m);
    m->par.dt = 1e12;
    bbm_step(m);
    double *D = calloc(12 * (size_t)m->elements, sizeof *D), *KD = D + 6 * m->elements, energy_of = 0;
    for (int e = 0; e < m->elements; e++) {
        D[6 * e] = motion[0] - motion[2] * m->element[e].y;
        D[6 * e + 1] = motion[1] + motion[2] * m->element[e].x;
        D[6 * e + 2] = motion[2];
    }
    bbm_matrix_multiply(m->K, D, KD);
    for (int a = 0; a < 6 * m->elements; a++) {
        ck_near(KD[a], 0, 1e5, ROUNDING);                                  /* of K: alpha G t = 2e4 times D */
        energy_of += KD[a] * D[a] / 2;
    }
    ck_near(energy_of, 0, 1e5, ROUNDING);
    free(D);
    bbm_model_free(m);
}
END_TEST

/* --------------------------------------------------------------------------------------------- patch tests */

typedef struct {
    double x[16][2];
    int nodes, roller, elements, n[9], node[9][5];    /* roller: node of one element alone */
} patch;

static const patch PATCHES[] = {
    /* a strip: quadrilateral, triangle, pentagon, two triangles; no node is inside */
    { { { 0, 0 }, { 1.25, 0.25 }, { 3, -0.25 }, { 4.5, 0 }, { 6, 0 },
        { 0.25, 1 }, { 1.5, 1.25 }, { 2.75, 1 }, { 5, 1.5 }, { 6.25, 1.25 } },
      10, 9, 5, { 4, 3, 5, 3, 3 }, { { 0, 1, 6, 5 }, { 1, 2, 6 }, { 2, 3, 8, 7, 6 }, { 3, 4, 8 }, { 4, 9, 8 } } },
    /* one node inside; quadrilaterals and triangles round it */
    { { { 0, 0 }, { 2, 0 }, { 4, 0 }, { 4, 1.5 }, { 4, 4 }, { 2.5, 4 }, { 0, 4 }, { 0, 2 }, { 1.75, 2.25 } },
      9, 4, 6, { 4, 3, 3, 4, 3, 3 },
      { { 0, 1, 8, 7 }, { 1, 2, 8 }, { 2, 3, 8 }, { 3, 4, 5, 8 }, { 5, 6, 8 }, { 6, 7, 8 } } },
    /* three nodes inside, triangles, quadrilaterals and a pentagon */
    { { { 0, 0 }, { 3, 0 }, { 6, 0 }, { 6, 2.5 }, { 6, 5 }, { 2.5, 5 }, { 0, 5 }, { 0, 2 },
        { 1.5, 1.75 }, { 4, 1.5 }, { 3.5, 3.5 } },
      11, 2, 7, { 4, 4, 4, 3, 5, 3, 3 },
      { { 0, 1, 8, 7 }, { 1, 2, 3, 9 }, { 3, 4, 5, 10 }, { 3, 10, 9 }, { 5, 6, 7, 8, 10 }, { 1, 9, 8 },
        { 8, 9, 10 } } },
};

static const double STRESSES[][3] = { { 3, 0, 0 }, { 0, 2, 0 }, { 0, 0, 1 }, { 3, -1, 2 } };

/* Pulls at every boundary edge with the traction of a uniform stress, holds what is needed against rigid motion
 * (without reactions, for the tractions are in balance), and writes the stresses that come out. */
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
    ck_ok(bbm_prepare(m), m);
    ck_ok(bbm_step(m), m);
    for (int e = 0; e < m->elements; e++)
        memcpy(stress[e], m->element[e].stress, sizeof m->element[e].stress);
    bbm_model_free(m);
}

/* Where no node is inside, elements can part by s.n l/2k along every edge without straining: exact whatever alpha. */
START_TEST(a_strip_under_uniform_traction_has_that_stress_in_every_element)
{
    double stress[9][3];

    stretch_patch(&PATCHES[0], STRESSES[_i], 100, stress);
    for (int e = 0; e < PATCHES[0].elements; e++)
        for (int a = 0; a < 3; a++)
            ck_near(stress[e][a], STRESSES[_i][a], 3, SOLVED);
}
END_TEST

/* Round an inner node the gaps need not close, and the stress is uniform only in the limit of rigid springs:
 * s(alpha) = s + c1/alpha + c2/alpha^2 + ... Three values of alpha remove c1 and c2; c3/alpha^3 is near 1e-12. */
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

/* ------------------------------------------------------------------------------------------------ bonded bars */

enum { LINKS = 6 };

/* LINKS elements of 0.5 x 1 m in a row, held at the left, pulled by 3 N at the right; material e % materials. */
static bbm_model *bar(const bbm_material *material, int materials)
{
    bbm_model *m = new_model(material);
    const double f = 3 / 2.0;

    for (int a = 1; a < materials; a++)
        ck_ok(bbm_add_material(m, &material[a], NULL), m);
    for (int i = 0; i <= LINKS; i++)
        for (int j = 0; j < 2; j++)
            ck_ok(bbm_add_node(m, 0.5 * i, j, NULL), m);
    for (int e = 0; e < LINKS; e++)
        ck_ok(bbm_add_element(m, 0, e % materials, 4, (int[]){ 2 * e, 2 * e + 2, 2 * e + 3, 2 * e + 1 }, NULL), m);
    for (int j = 0; j < 2; j++) {
        ck_ok(bbm_fix_node(m, j, BBM_XY, 0, 0), m);
        ck_ok(bbm_add_load(m, 2 * LINKS + j, f, 0), m);
    }
    ck_ok(bbm_prepare(m), m);
    return m;
}

/* Every joint is two springs side by side, the wall too: F L/(E A) + (N - 1) F/2k + F/2k with
 * k = alpha G t = alpha E t/2. */
START_TEST(a_bonded_bar_stretches_by_its_strain_and_its_springs)
{
    bbm_model *m = bar(&CORK, 1);
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
    bbm_model_free(m);
}
END_TEST

/* Springs between unlike elements: the means of G and t. */
START_TEST(a_bar_of_two_materials_and_thicknesses_stretches_by_the_sum_of_its_parts)
{
    const bbm_material two[2] = { { .E = 1000, .density = 1, .thickness = 0.5 },
                                  { .E = 3000, .density = 1, .thickness = 0.25 } };
    const double F = 3, alpha = 100, kw = alpha * 500 * 0.5, k = alpha * (500 + 1500) / 2 * (0.5 + 0.25) / 2;
    bbm_model *m = bar(two, 2);

    ck_ok(bbm_step(m), m);
    double expected = F / (2 * kw) + (LINKS - 1) * F / (2 * k);
    for (int e = 0; e < LINKS; e++)
        expected += 0.5 * F / (two[e % 2].E * two[e % 2].thickness);
    ck_relative(result_at(m, 2 * LINKS).u, expected, SOLVED);
    for (int e = 0; e < LINKS; e++)
        ck_relative(m->element[e].stress[0], F / two[e % 2].thickness, SOLVED);
    bbm_model_free(m);
}
END_TEST

START_TEST(displacements_fall_as_one_over_the_thickness)
{
    bbm_material thick = SOLID;
    grid g = { .lx = 3, .ly = 1, .nx = 3, .ny = 1, .triangles = 1 };

    thick.thickness *= 4;
    bbm_model *m = cantilever(&SOLID, &g, 1, -1), *n = cantilever(&thick, &g, 1, -1);
    ck_ok(bbm_step(m), m);
    ck_ok(bbm_step(n), n);
    for (int i = 0; i < m->nodes; i++) {
        ck_near(4 * result_at(n, i).v, result_at(m, i).v, result_at(m, at(&g, 3, 0)).v, SOLVED);
        ck_near(4 * result_at(n, i).stress[0], result_at(m, i).stress[0], result_at(m, 0).stress[0], SOLVED);
    }
    bbm_model_free(m);
    bbm_model_free(n);
}
END_TEST

START_TEST(a_displaced_wall_takes_the_body_along)
{
    bbm_model *m = unit_square(&SOLID);

    ck_ok(bbm_fix_node(m, 0, BBM_XY, 0.25, -0.5), m);
    ck_ok(bbm_fix_node(m, 1, BBM_Y, 9, -0.5), m);                          /* 9: not held in x, so of no account */
    ck_ok(bbm_prepare(m), m);
    ck_ok(bbm_step(m), m);
    for (int n = 0; n < 4; n++) {
        ck_near(result_at(m, n).u, 0.25, 1, SOLVED);
        ck_near(result_at(m, n).v, -0.5, 1, SOLVED);
        ck_near(m->vertex[n].x, m->node[n].x + 0.25, 1, SOLVED);
        ck_near(m->vertex[n].y, m->node[n].y - 0.5, 1, SOLVED);
    }
    bbm_model_free(m);
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
    bbm_model_free(m);
}
END_TEST

/* ------------------------------------------------------------------------------------------------ loads in a model */

/* Total force and moment about the origin of what is loaded on element e of an unsolved model: the first three of F are
 * the work of the load in a translation and in a rotation about the barycentre. */
static void total_load(const bbm_model *m, int e, double total[3])
{
    const double *F = &m->F[6 * e];
    const bbm_element *b = &m->element[e];

    total[0] += F[0];
    total[1] += F[1];
    total[2] += F[2] + b->x * F[1] - b->y * F[0];
}

static void rising(double x, double y, const void *context, double f[2])
{
    const double *scale = context;

    f[0] = scale[0] * x * y;
    f[1] = scale[1] * x * x;
}

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

    ck_ok(bbm_add_varying_line_load(m, 14, 2, note_place, &context), m);   /* from (4, 2) to (2, 0) */
    ck_assert_int_eq(asked.calls, BBM_GAUSS);
    for (int g = 0; g < BBM_GAUSS; g++) {
        double s, weight;
        bbm_gauss_point(g, &s, &weight);
        ck_near(asked.x[g][0], 4 - 2 * s, 1, ROUNDING);
        ck_near(asked.x[g][1], 2 - 2 * s, 1, ROUNDING);
    }
    bbm_model_free(m);
}
END_TEST

/* Force and moment are integrals of cubic polynomials along the side, for which Simpson's rule is exact. */
START_TEST(a_load_that_varies_reaches_the_element_whichever_end_is_named_first)
{
    const double scale[2] = { 6, -5 }, a[2] = { 1.5, -1 }, b[2] = { 2, 1.25 };
    const double weight[3] = { 1 / 6.0, 4 / 6.0, 1 / 6.0 };
    const int ends[2] = { _i ? 2 : 1, _i ? 1 : 2 };
    bbm_model *m = new_model(&SOLID);
    double total[3] = { 0 }, expected[3] = { 0 };

    for (int n = 0; n < 4; n++)
        ck_ok(bbm_add_node(m, SHAPES[1].x[n][0], SHAPES[1].x[n][1], NULL), m);
    ck_ok(bbm_add_element(m, 0, 0, 4, (int[]){ 0, 1, 2, 3 }, NULL), m);
    ck_ok(bbm_fix_node(m, 0, BBM_XY, 0, 0), m);
    ck_ok(bbm_fix_node(m, 3, BBM_X, 0, 0), m);
    ck_ok(bbm_add_varying_line_load(m, ends[0], ends[1], rising, scale), m);
    ck_ok(bbm_prepare(m), m);
    ck_ok(bbm_step(m), m);
    total_load(m, 0, total);
    for (int g = 0; g < 3; g++) {
        const double x = a[0] + (b[0] - a[0]) * g / 2, y = a[1] + (b[1] - a[1]) * g / 2;
        double f[2];
        rising(x, y, scale, f);
        const double wl = weight[g] * hypot(b[0] - a[0], b[1] - a[1]);
        expected[0] += wl * f[0];
        expected[1] += wl * f[1];
        expected[2] += wl * (x * f[1] - y * f[0]);
    }
    for (int r = 0; r < 3; r++)
        ck_near(total[r], expected[r], 50, ROUNDING);
    bbm_model_free(m);
}
END_TEST

START_TEST(loads_of_one_node_and_of_one_edge_add_up)
{
    grid g = { .lx = 3, .ly = 2, .nx = 3, .ny = 2, .triangles = 1 };
    bbm_model *m = cantilever(&SOLID, &g, 0, 0);
    double total[3] = { 0 };

    ck_ok(bbm_add_load(m, at(&g, 1, 1), 2, -1), m);                        /* at (1, 1), where triangles meet */
    ck_ok(bbm_add_load(m, at(&g, 1, 1), 3, 5), m);
    ck_ok(bbm_add_line_load(m, at(&g, 3, 1), at(&g, 3, 2), 1, 0.5), m);    /* middle (3, 1.5), length 1 */
    ck_ok(bbm_add_line_load(m, at(&g, 3, 2), at(&g, 3, 1), 2, 0.25), m);
    ck_ok(bbm_prepare(m), m);
    ck_ok(bbm_step(m), m);
    for (int e = 0; e < m->elements; e++)
        total_load(m, e, total);
    ck_relative(total[0], 5 + 3, ROUNDING);
    ck_relative(total[1], 4 + 0.75, ROUNDING);
    ck_relative(total[2], (4 - 5) + (3 * 0.75 - 1.5 * 3), ROUNDING);
    const int n = at(&g, 1, 1), meeting = m->meet_first[n + 1] - m->meet_first[n];
    for (int v = 0; v < m->vertices; v++)
        if (m->vertex[v].node == n)
            ck_relative(m->F[6 * m->vertex[v].element], 5.0 / meeting, ROUNDING);
    bbm_model_free(m);
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
    bbm_model_free(m);
}
END_TEST

/* ------------------------------------------------------------------------ the constant-strain finite element */

/* K += t A B^T E B of one triangle; the unknowns of node n are 2 n and 2 n + 1. */
static void add_triangle(const bbm_model *m, const bbm_element *e, int n, double *K)
{
    const bbm_material *s = &e->material;
    const double c = s->E / (1 - s->nu * s->nu), E[3][3] = { { c, c * s->nu, 0 }, { c * s->nu, c, 0 },
                                                             { 0, 0, c * (1 - s->nu) / 2 } };
    double B[3][6] = { { 0 } };
    int row[6];

    const bbm_vertex *v = &m->vertex[e->first];
    const double A = ((v[1].x - v[0].x) * (v[2].y - v[0].y) - (v[2].x - v[0].x) * (v[1].y - v[0].y)) / 2;
    for (int a = 0; a < 3; a++) {
        const bbm_vertex *q = &v[(a + 1) % 3], *r = &v[(a + 2) % 3];
        B[0][2 * a] = B[2][2 * a + 1] = (q->y - r->y) / (2 * A);
        B[1][2 * a + 1] = B[2][2 * a] = (r->x - q->x) / (2 * A);
        row[2 * a] = 2 * v[a].node;
        row[2 * a + 1] = 2 * v[a].node + 1;
    }
    for (int a = 0; a < 6; a++)
        for (int b = 0; b < 6; b++)
            for (int p = 0; p < 3; p++)
                for (int q = 0; q < 3; q++)
                    K[row[a] * n + row[b]] += s->thickness * A * B[p][a] * E[p][q] * B[q][b];
}

/* Nodal displacements of the finite element on the model's mesh, of triangles, with its fixed points and loads. */
static double *finite_element(const bbm_model *m)
{
    const int n = 2 * m->nodes;
    double *K = calloc((size_t)(n * n), sizeof *K), *u = calloc((size_t)n, sizeof *u);

    for (int e = 0; e < m->elements; e++)
        add_triangle(m, &m->element[e], n, K);
    for (int a = 0; a < n; a++) {
        u[a] = m->node[a / 2].load[a % 2];
        if (!(m->node[a / 2].held & (a % 2 ? BBM_Y : BBM_X)))
            continue;
        for (int b = 0; b < n; b++)
            K[a * n + b] = K[b * n + a] = 0;
        K[a * n + a] = 1;
        u[a] = 0;
    }
    dense_solve(n, K, u);
    free(K);
    return u;
}

/* Largest difference of the bonded triangles' displacements from the finite element's, against its largest. */
static double distance_from_finite_element(double alpha)
{
    grid g = { .lx = 4, .ly = 2, .nx = 6, .ny = 3, .triangles = 1, .jitter = 0.25 };
    bbm_model *m = cantilever(&SOLID, &g, 1, -1);
    double *u = finite_element(m), size = 0, error = 0;

    m->par.alpha = alpha;
    ck_ok(bbm_step(m), m);
    for (int n = 0; n < m->nodes; n++) {
        const bbm_result r = result_at(m, n);
        size = fmax(size, hypot(u[2 * n], u[2 * n + 1]));
        error = fmax(error, hypot(r.u - u[2 * n], r.v - u[2 * n + 1]));
    }
    free(u);
    bbm_model_free(m);
    return error / size;
}

/* The springs' compliance is a little over 2/alpha; the next term, of 1/alpha^2, is 0.2 % of it at 1e3. At 1e7 the
 * rounding of K D, 2e-16 alpha times the condition of the finite element (some 50), is half of what is left. */
START_TEST(bonded_triangles_tend_to_the_constant_strain_finite_element_as_one_over_alpha)
{
    const double e3 = distance_from_finite_element(1e3), e5 = distance_from_finite_element(1e5);

    ck_assert(e3 < 0.003);
    ck_relative(e3 / e5, 100, 0.005);
    ck_assert(distance_from_finite_element(1e7) < 5e-7);
}
END_TEST

/* ----------------------------------------------------------------------------------------------------- dynamics */

/* Two bonded elements (triangles or quadrilaterals) off the origin, free, with time steps of 0.01 s. */
static bbm_model *flyer(int triangles)
{
    grid g = { .x = 3, .y = -2, .lx = 2, .ly = 1.5, .nx = triangles ? 1 : 2, .ny = 1, .triangles = triangles };
    bbm_model *m = new_model(&SOLID);

    add_grid(m, &g, 0);
    ck_ok(bbm_prepare(m), m);
    m->par.dt = 0.01;
    m->par.steps = 100;
    m->par.keep = 1;
    return m;
}

/* Newmark with the acceleration of the step's end is exact when that is constant. */
START_TEST(a_thrown_body_follows_the_parabola)
{
    bbm_model *m = flyer(_i);
    const double v[2] = { 2, 3 }, g[2] = { 0.5, -9.81 };

    for (int e = 0; e < m->elements; e++)
        memcpy(m->element[e].V, v, sizeof v);
    memcpy(m->par.gravity, g, sizeof g);
    ck_ok(bbm_run(m), m);
    ck_assert_int_eq(m->info.step, 100);
    ck_relative(m->info.t, 1, ROUNDING);
    for (int n = 0; n < m->nodes; n++) {
        ck_near(result_at(m, n).u, v[0] + g[0] / 2, 1, ROUNDING);
        ck_near(result_at(m, n).v, v[1] + g[1] / 2, 1, ROUNDING);
    }
    for (int e = 0; e < m->elements; e++) {
        const bbm_element *b = &m->element[e];
        ck_near(b->V[0], v[0] + g[0], 10, ROUNDING);
        ck_near(b->V[1], v[1] + g[1], 10, ROUNDING);
        ck_near(b->sum[0], v[0] + g[0] / 2, 10, ROUNDING);
        ck_near(b->sum[1], v[1] + g[1] / 2, 10, ROUNDING);
        for (int a = 0; a < 3; a++)
            ck_near(b->stress[a], 0, SOLID.E, ROUNDING);
    }
    bbm_model_free(m);
}
END_TEST

/* In a frame that moves with its base a body feels the base's acceleration the other way round; taken at the step's end,
 * t = 0.01 and 0.02 s, where sin(omega t) is 1 and 0. */
START_TEST(the_acceleration_of_the_base_acts_like_gravity_the_other_way)
{
    bbm_model *m = flyer(_i);
    const double a[2] = { 3, -2 }, g[2] = { 0.5, -9.81 };

    memcpy(m->par.gravity, g, sizeof g);
    memcpy(m->par.shake, a, sizeof a);
    m->par.omega = acos(-1) / 2 / 0.01;
    for (int step = 1; step <= 2; step++) {
        ck_ok(bbm_step(m), m);
        for (int e = 0; e < m->elements; e++)
            for (int r = 0; r < 2; r++)
                ck_near(m->element[e].V[r], (step * g[r] - a[r]) * 0.01, 0.1, ROUNDING);
    }
    bbm_model_free(m);
}
END_TEST

START_TEST(a_spinning_element_keeps_its_angular_velocity_and_its_mass)
{
    bbm_model *m = unit_square(&SOLID);

    m->par.rotation = _i == 0 ? BBM_LINEAR : BBM_EXACT;
    ck_ok(bbm_prepare(m), m);
    m->par.dt = 0.01;
    m->par.steps = 50;
    m->par.keep = 1;
    m->element[0].V[2] = 3;
    ck_ok(bbm_run(m), m);
    for (int a = 0; a < 6; a++)
        ck_near(m->element[0].V[a], a == 2 ? 3 : 0, 3, ROUNDING);
    /* as I + r dt J turns, it grows; the exact rotation keeps the area */
    ck_relative(m->element[0].A, _i == 0 ? pow(1 + 0.03 * 0.03, 49) : 1, ROUNDING);
    ck_relative(m->element[0].A0, 1, ROUNDING);
    bbm_model_free(m);
}
END_TEST

/* Too heavy to be strained in the step, it turns by 0.7 rad and takes its stress along: R s R^T. */
START_TEST(stress_turns_with_the_element)
{
    const bbm_material heavy = { .E = 1, .nu = 0.3, .density = 1e15, .thickness = 1 };
    const double s[3] = { 3, -1, 2 }, c = cos(0.7), n = sin(0.7), R[2][2] = { { c, -n }, { n, c } };
    const double before[2][2] = { { s[0], s[2] }, { s[2], s[1] } };
    bbm_model *m = unit_square(&heavy);
    double after[2][2] = { { 0 } };

    ck_ok(bbm_prepare(m), m);
    m->par.rotation = _i == 0 ? BBM_LINEAR : BBM_EXACT;
    m->par.dt = 0.5;
    m->element[0].V[2] = 0.7 / 0.5;
    memcpy(m->element[0].stress, s, sizeof s);
    ck_ok(bbm_step(m), m);
    for (int a = 0; a < 16; a++)
        after[a / 8][a / 4 % 2] += R[a / 8][a / 2 % 2] * before[a / 2 % 2][a % 2] * R[a / 4 % 2][a % 2];
    ck_near(m->element[0].stress[0], _i == 0 ? s[0] : after[0][0], 1, ROUNDING);
    ck_near(m->element[0].stress[1], _i == 0 ? s[1] : after[1][1], 1, ROUNDING);
    ck_near(m->element[0].stress[2], _i == 0 ? s[2] : after[0][1], 1, ROUNDING);
    bbm_model_free(m);
}
END_TEST

/* Bonds pull at both sides alike, and the mass does not follow the area. */
START_TEST(bonded_elements_keep_their_momentum_while_they_shake_each_other)
{
    bbm_model *m = flyer(_i);
    unsigned seed = 21;
    double before[2] = { 0 }, after[2] = { 0 };

    for (int e = 0; e < m->elements; e++)
        for (int a = 0; a < 6; a++)
            m->element[e].V[a] = random_number(&seed);
    for (int e = 0; e < m->elements; e++)
        for (int r = 0; r < 2; r++)
            before[r] += m->element[e].A0 * m->element[e].V[r];
    ck_ok(bbm_run(m), m);
    for (int e = 0; e < m->elements; e++)
        for (int r = 0; r < 2; r++)
            after[r] += m->element[e].A0 * m->element[e].V[r];
    for (int r = 0; r < 2; r++)
        ck_near(after[r], before[r], 1, SOLVED);                           /* 100 solves */
    ck_assert(fabs(m->element[0].V[0] - m->element[1].V[0]) > 1e-6);
    bbm_model_free(m);
}
END_TEST

/* A square of nu = 0 that breathes in x alone: mass M Sxx = density t/12, stiffness t E, so W^2 = 12 E dt^2/density.
 * One step takes (q, dt V), q the strain so far, to (2 q + 2 dt V, (2 - W^2) dt V - 2 W^2 q)/(2 + W^2): the amplitude
 * falls by the root of the determinant, (1 + W^2/2)^(-1/2), the phase advances by the angle whose cosine is half the
 * trace over that. The shape changes by 1e-8: tolerance 1e-6. */
START_TEST(a_vibrating_element_is_damped_as_newmarks_recurrence_says)
{
    const double W2 = 0.5, q0 = 1e-8, p0 = 0.5e-8;
    const double decay = 1 / sqrt(1 + W2 / 2), angle = acos((4 - W2) / (2 + W2) / 2 / decay);
    const double q1 = (2 * q0 + 2 * p0) / (2 + W2), sine = (q1 / decay - q0 * cos(angle)) / sin(angle);
    bbm_model *m = unit_square(&CORK);

    ck_ok(bbm_prepare(m), m);
    m->par.dt = sqrt(W2 * CORK.density / (12 * CORK.E));
    m->par.keep = 1;
    m->element[0].stress[0] = CORK.E * q0;
    m->element[0].V[3] = p0 / m->par.dt;
    for (int n = 1; n <= 40; n++) {
        ck_ok(bbm_step(m), m);
        const double q = pow(decay, n) * (q0 * cos(n * angle) + sine * sin(n * angle));
        ck_near(m->element[0].stress[0] / CORK.E, q, q0, 1e-6);
    }
    bbm_model_free(m);
}
END_TEST

/* Velocities set to zero after each step, the inertia of 2/dt^2 only slows the way to the same end. The share of the
 * error that a step leaves is below 1/(1 + (w dt)^2/2), w the lowest frequency; the load moves the shape by 1e-9. */
START_TEST(steps_without_memory_of_velocity_end_in_the_static_answer)
{
    grid g = { .lx = 3, .ly = 1, .nx = 3, .ny = 1, .triangles = 1 };
    bbm_model *m = cantilever(&SOLID, &g, 1e-8, -1e-8), *n = cantilever(&SOLID, &g, 1e-8, -1e-8);

    n->par.dt = 2;
    n->par.steps = 60;
    ck_ok(bbm_step(m), m);
    ck_ok(bbm_run(n), n);
    const double size = result_at(m, at(&g, 3, 1)).v, stress = result_at(m, 0).mises;
    for (int i = 0; i < m->nodes; i++) {
        ck_near(result_at(n, i).u, result_at(m, i).u, size, 1e-7);
        ck_near(result_at(n, i).v, result_at(m, i).v, size, 1e-7);
        ck_near(result_at(n, i).mises, result_at(m, i).mises, stress, 1e-7);
    }
    bbm_model_free(m);
    bbm_model_free(n);
}
END_TEST

/* ------------------------------------------------------------------------------------------------------ statics */

/* Resultant of all that pulls at the body where it is now: loads, weight, and the springs of the fixed points. The
 * moment is about the origin. Bonds and stresses are in balance by themselves. */
static void out_of_balance(const bbm_model *m, double f[3])
{
    for (int v = 0; v < m->vertices; v++) {
        const bbm_vertex *p = &m->vertex[v];
        const bbm_node *n = &m->node[p->node];
        const bbm_material *s = &m->element[p->element].material;
        const double k = m->par.alpha * s->E / 2 / (1 + s->nu) * s->thickness;
        const int meeting = m->meet_first[p->node + 1] - m->meet_first[p->node];
        const double fx = n->load[0] / meeting + (n->held & BBM_X ? k * (n->wall[0] - p->u) : 0);
        const double fy = n->load[1] / meeting + (n->held & BBM_Y ? k * (n->wall[1] - p->v) : 0);
        f[0] += fx;
        f[1] += fy;
        f[2] += p->x * fy - p->y * fx;
    }
    for (int i = 0; i < m->elements; i++) {
        const bbm_element *e = &m->element[i];
        const double weight = e->material.density * e->material.thickness * e->A0;
        f[0] += weight * m->par.gravity[0];
        f[1] += weight * m->par.gravity[1];
        f[2] += weight * (e->x * m->par.gravity[1] - e->y * m->par.gravity[0]);
    }
}

/* A cantilever that bends by a quarter of its length: forces and moments balance on the bent shape. */
START_TEST(statics_ends_in_balance_on_the_moved_geometry)
{
    grid g = { .lx = 3, .ly = 1, .nx = 6, .ny = 2, .triangles = _i };
    bbm_model *m = cantilever(&SOLID, &g, 5, -4);
    double f[3] = { 0 };

    m->par.steps = 60;
    m->par.tolerance = 1e-11;
    m->par.gravity[1] = -1;
    ck_ok(bbm_run(m), m);
    ck_assert(m->info.step > 3 && m->info.step < 60);
    ck_assert(result_at(m, at(&g, 6, 2)).v < -0.02);
    out_of_balance(m, f);
    for (int a = 0; a < 3; a++)
        ck_near(f[a], 0, 10, 1e-8);                                        /* residual forces, of K D: 1e-11 of it */
    bbm_model_free(m);
}
END_TEST

/* One element under large tension: the stress is the load over the section as it is then, t h (1 - nu e ...). */
START_TEST(stress_is_that_of_the_present_section)
{
    bbm_model *m = unit_square(&SOLID);

    ck_ok(bbm_fix_node(m, 0, BBM_XY, 0, 0), m);
    ck_ok(bbm_fix_node(m, 3, BBM_X, 0, 0), m);
    ck_ok(bbm_add_load(m, 1, 25, 0), m);
    ck_ok(bbm_add_load(m, 2, 25, 0), m);
    ck_ok(bbm_prepare(m), m);
    m->par.steps = 50;
    m->par.tolerance = 1e-13;
    ck_ok(bbm_run(m), m);
    const double h = m->vertex[2].y - m->vertex[1].y;
    ck_assert(h < 0.98);
    ck_relative(m->element[0].stress[0], 50 / (SOLID.thickness * h), SOLVED);
    ck_near(m->element[0].stress[1], 0, 100, SOLVED);
    bbm_model_free(m);
}
END_TEST

/* (71) by hand: the barycentres of two elements that move by D in a step, and by the sum in all. */
START_TEST(the_stop_criterion_compares_the_step_with_the_sum_of_all_steps)
{
    bbm_model *m = bar(&SOLID, 1);
    double total[LINKS][2] = { { 0 } };

    for (int step = 1; step <= 3; step++) {
        double step2 = 0, sum2 = 0;
        ck_ok(bbm_step(m), m);
        for (int e = 0; e < LINKS; e++)
            for (int r = 0; r < 2; r++) {
                total[e][r] += m->element[e].D[r];
                step2 += m->element[e].D[r] * m->element[e].D[r];
                sum2 += total[e][r] * total[e][r];
                ck_near(m->element[e].sum[r], total[e][r], 1, 1e-15);
            }
        ck_assert_int_eq(m->info.step, step);
        ck_relative(m->info.change, sqrt(step2 / sum2), ROUNDING);
    }
    bbm_model_free(m);
}
END_TEST

START_TEST(a_run_stops_at_the_first_step_that_is_small_enough)
{
    bbm_model *m = bar(&SOLID, 1), *n = bar(&SOLID, 1);
    double change[3];

    for (int step = 0; step < 3; step++) {
        ck_ok(bbm_step(m), m);
        change[step] = m->info.change;
    }
    ck_assert(change[0] == 1 && change[1] < 0.1 && change[2] < change[1]);
    n->par.steps = 3;
    n->par.tolerance = change[1];                                          /* small enough: as small, too */
    ck_ok(bbm_run(n), n);
    ck_assert_int_eq(n->info.step, 2);
    bbm_model_free(m);
    bbm_model_free(n);
}
END_TEST

START_TEST(a_run_that_stops_short_says_so_and_keeps_what_it_has)
{
    bbm_model *m = bar(&SOLID, 1);

    m->par.steps = 2;
    m->par.tolerance = 1e-13;
    ck_assert_int_eq(bbm_run(m), BBM_STEPS_EXHAUSTED);
    ck_assert_int_eq(m->info.step, 2);
    ck_assert_ptr_nonnull(strstr(bbm_message(m), "after step 2"));
    ck_assert(result_at(m, 2 * LINKS).u > 0);
    ck_assert_int_eq(bbm_run(m), BBM_STEPS_EXHAUSTED);                     /* goes on where it stopped */
    ck_assert_int_eq(m->info.step, 4);
    m->par.steps = 20;
    ck_ok(bbm_run(m), m);
    ck_assert(m->info.step < 24 && m->info.change <= 1e-13);
    bbm_model_free(m);
}
END_TEST

START_TEST(without_a_tolerance_a_run_does_all_its_steps)
{
    bbm_model *m = bar(&CORK, 1);

    m->par.steps = 4;
    ck_ok(bbm_run(m), m);
    ck_assert_int_eq(m->info.step, 4);
    ck_ok(bbm_run(m), m);
    ck_assert_int_eq(m->info.step, 8);
    bbm_model_free(m);
}
END_TEST

START_TEST(without_a_tolerance_a_run_does_all_its_steps_even_at_rest)
{
    bbm_model *m = unit_square(&SOLID);

    ck_ok(bbm_fix_node(m, 0, BBM_XY, 0, 0), m);
    ck_ok(bbm_fix_node(m, 1, BBM_Y, 0, 0), m);
    ck_ok(bbm_prepare(m), m);
    m->par.steps = 3;
    ck_ok(bbm_run(m), m);
    ck_assert(m->info.step == 3 && m->info.t == 0);
    bbm_model_free(m);
}
END_TEST

START_TEST(a_body_without_load_stays_where_it_is)
{
    bbm_model *m = unit_square(&SOLID);

    ck_ok(bbm_fix_node(m, 0, BBM_XY, 0, 0), m);
    ck_ok(bbm_fix_node(m, 1, BBM_Y, 0, 0), m);
    ck_ok(bbm_prepare(m), m);
    m->par.tolerance = 1e-6;
    ck_ok(bbm_run(m), m);
    ck_assert(m->info.step == 1 && m->info.change == 0 && result_at(m, 2).u == 0 && result_at(m, 2).mises == 0);
    bbm_model_free(m);
}
END_TEST

/* One polygon as the whole block, plain DDA: in balance the mean stress is sum of f x^T / (t A), made symmetric. */
/* A pressure p [N/m] on all sides of any polygon is in balance, and -p/t is the stress in x and in y. */
START_TEST(a_body_under_pressure_all_round_has_that_stress)
{
    const shape *s = &SHAPES[_i];
    bbm_model *m = new_model(&SOLID);
    int nodes[CORNERS];

    for (int c = 0; c < s->n; c++)
        ck_ok(bbm_add_node(m, s->x[c][0], s->x[c][1], &nodes[c]), m);
    ck_ok(bbm_add_element(m, 0, 0, s->n, nodes, NULL), m);
    ck_ok(bbm_fix_node(m, 0, BBM_XY, 0, 0), m);
    ck_ok(bbm_fix_node(m, 2, BBM_Y, 0, 0), m);
    ck_ok(bbm_prepare(m), m);
    for (int e = 0; e < m->edges; e++)
        ck_ok(bbm_load_edge(m, e, 0, 0, 5), m);
    ck_ok(bbm_step(m), m);
    for (int a = 0; a < 3; a++)
        ck_near(m->element[0].stress[a], a < 2 ? -5 / SOLID.thickness : 0, 5, SOLVED);
    bbm_model_free(m);
}
END_TEST

START_TEST(a_block_that_is_one_polygon_has_the_mean_stress_of_its_loads)
{
    const shape *s = &SHAPES[2];
    const double A = 5.5, f[CORNERS][2] = { { 2, 1 }, { -1, 0.5 }, { 0, -2 }, { -3, 1 }, { 2, -0.5 }, { 0, 0 } };
    bbm_model *m = new_model(&SOLID);
    double T[2][2] = { { 0 } };
    int nodes[CORNERS];

    for (int c = 0; c < s->n; c++)
        ck_ok(bbm_add_node(m, s->x[c][0], s->x[c][1], &nodes[c]), m);
    ck_ok(bbm_add_element(m, 3, 0, s->n, nodes, NULL), m);
    ck_ok(bbm_fix_node(m, 4, BBM_XY, 0, 0), m);                            /* (0, 0) */
    ck_ok(bbm_fix_node(m, 5, BBM_Y, 0, 0), m);                             /* (3, 0) */
    double moment = 0;
    for (int c = 0; c < s->n; c++) {
        ck_ok(bbm_add_load(m, c, f[c][0], f[c][1]), m);
        moment += s->x[c][0] * f[c][1] - s->x[c][1] * f[c][0];
        for (int r = 0; r < 4; r++)
            T[r / 2][r % 2] += s->x[c][r / 2] * f[c][r % 2];
    }
    T[0][1] -= moment;                                                     /* the support at (3, 0) pulls -moment/3 */
    ck_ok(bbm_prepare(m), m);
    ck_ok(bbm_step(m), m);
    const double *stress = m->element[0].stress, tA = SOLID.thickness * A;
    ck_near(stress[0], T[0][0] / tA, 1, SOLVED);
    ck_near(stress[1], T[1][1] / tA, 1, SOLVED);
    ck_near(stress[2], (T[0][1] + T[1][0]) / 2 / tA, 1, SOLVED);
    bbm_model_free(m);
}
END_TEST

/* ------------------------------------------------------------------------------------------------- 2.2, the mesh */

/* Euler: nodes - sides + elements = 1 for a body without holes. */
START_TEST(every_side_is_a_boundary_edge_or_a_bond)
{
    grid g = { .lx = 4, .ly = 3, .nx = 4, .ny = 3, .triangles = _i, .jitter = 0.2 };
    bbm_model *m = cantilever(&SOLID, &g, 1, 0);

    ck_assert_int_eq(m->edges, 2 * (4 + 3));
    ck_assert_int_eq(m->bonds, _i ? 4 * 4 + 5 * 3 - 14 + 12 : 4 * 4 + 5 * 3 - 14);
    ck_assert_int_eq(m->nodes - (m->edges + m->bonds) + m->elements, 1);
    ck_assert_int_eq(2 * m->bonds + m->edges, m->vertices);
    for (int b = 0; b < m->bonds; b++) {
        const bbm_bond *bond = &m->bond[b];
        ck_assert_int_lt(bond->i, bond->j);
        for (int end = 0; end < 2; end++) {
            ck_assert_int_eq(m->vertex[bond->p[end]].node, m->vertex[bond->q[end]].node);
            ck_assert_int_eq(m->vertex[bond->p[end]].element, bond->i);
            ck_assert_int_eq(m->vertex[bond->q[end]].element, bond->j);
        }
        ck_assert_int_ne(bond->p[0], bond->p[1]);
    }
    bbm_model_free(m);
}
END_TEST

/* The area of the body by Green's theorem: edges run counter-clockwise round it. */
START_TEST(boundary_edges_have_their_element_on_the_left)
{
    grid g = { .lx = 4, .ly = 3, .nx = 4, .ny = 3, .triangles = _i };
    bbm_model *m = cantilever(&SOLID, &g, 1, 0);
    double twice = 0;

    for (int i = 0; i < m->edges; i++) {
        const bbm_vertex *a = &m->vertex[m->edge[i].a], *b = &m->vertex[m->edge[i].b];
        ck_assert(a->element == m->edge[i].element && b->element == m->edge[i].element);
        twice += a->x * b->y - b->x * a->y;
    }
    ck_relative(twice, 24, ROUNDING);
    bbm_model_free(m);
}
END_TEST

/* 3--4--5    two squares between the same six nodes */
/* 0--1--2 */
static bbm_model *two_squares(int block0, int block1)
{
    bbm_model *m = new_model(&SOLID);

    for (int n = 0; n < 6; n++)
        ck_ok(bbm_add_node(m, n % 3, n / 3, NULL), m);
    ck_ok(bbm_add_element(m, block0, 0, 4, (int[]){ 0, 1, 4, 3 }, NULL), m);
    ck_ok(bbm_add_element(m, block1, 0, 4, (int[]){ 1, 2, 5, 4 }, NULL), m);
    return m;
}

START_TEST(elements_of_different_blocks_are_not_bonded)
{
    bbm_model *m = two_squares(0, 1), *n = two_squares(4, 4), *t = new_model(&SOLID);

    ck_ok(bbm_prepare(m), m);
    ck_ok(bbm_prepare(n), n);
    ck_assert(m->bonds == 0 && m->edges == 8);
    ck_assert(n->bonds == 1 && n->edges == 6);
    /* Sorted, the last side of the first triangle and the first side of the second are neighbours. */
    for (int k = 0; k < 4; k++)
        ck_ok(bbm_add_node(t, k % 2, k / 2, NULL), t);
    for (int k = 0; k < 2; k++)
        ck_ok(bbm_add_element(t, k, 0, 3, (int[]){ k, k + 1, k + 2 }, NULL), t);
    ck_ok(bbm_prepare(t), t);
    ck_assert(t->bonds == 0 && t->edges == 6);
    bbm_model_free(m);
    bbm_model_free(n);
    bbm_model_free(t);
}
END_TEST

/* A fan of triangles on nodes 0, 1 and one of 2, 3, ... each: (0, 1, 2), (0, 1, 3), ... with the given blocks. */
static bbm_model *fan(int triangles, const double top[][2], const int block[])
{
    bbm_model *m = new_model(&SOLID);

    ck_ok(bbm_add_node(m, 0, 0, NULL), m);
    ck_ok(bbm_add_node(m, 1, 0, NULL), m);
    for (int e = 0; e < triangles; e++) {
        ck_ok(bbm_add_node(m, top[e][0], top[e][1], NULL), m);
        ck_ok(bbm_add_element(m, block[e], 0, 3, (int[]){ 0, 1, 2 + e }, NULL), m);
    }
    return m;
}

/* Two blocks on the same ground: an edge 0, 1 with an element of each above and one of each below. Their edges are
 * sorted before the model is refused. */
START_TEST(blocks_that_lie_on_one_another_are_sorted_apart)
{
    const double top[4][2] = { { 0, 1 }, { 1, 1 }, { 0, -1 }, { 1, -1 } };
    bbm_model *m = fan(4, top, (int[]){ 0, 1, 0, 1 }), *n = fan(4, top, (int[]){ 3, -1, -1, 3 });

    ck_assert_int_eq(bbm_prepare(m), BBM_BLOCKS_OVERLAP);
    ck_assert_int_eq(bbm_prepare(n), BBM_BLOCKS_OVERLAP);
    ck_assert(m->bonds == 2 && m->edges == 8 && n->bonds == 2 && n->edges == 8);
    bbm_model_free(m);
    bbm_model_free(n);
}
END_TEST

START_TEST(nodal_results_are_the_mean_over_the_elements_of_a_block_that_meet)
{
    bbm_model *m = two_squares(2, 3);
    bbm_result r;

    ck_assert_int_eq(bbm_nodal_result(m, 1, -1, &r), BBM_BAD_INDEX);       /* nothing prepared yet */
    ck_ok(bbm_prepare(m), m);
    for (int v = 0; v < m->vertices; v++) {
        m->vertex[v].u = 1 + v;
        m->vertex[v].v = 10 * v;
    }
    for (int a = 0; a < 3; a++) {
        m->element[0].stress[a] = 1 + a;
        m->element[1].stress[a] = 5 - 3 * a;
    }
    ck_assert_int_eq(bbm_nodal_result(m, 4, -1, &r), BBM_OK);              /* vertices 2 and 7 */
    ck_assert(r.u == 5.5 && r.v == 45 && r.stress[0] == 3 && r.stress[1] == 2 && r.stress[2] == 1);
    ck_relative(r.mises, sqrt(9 - 6 + 4 + 3.0), ROUNDING);
    ck_assert_int_eq(bbm_nodal_result(m, 4, 2, &r), BBM_OK);
    ck_assert(r.u == 3 && r.v == 20 && r.stress[0] == 1 && r.stress[1] == 2 && r.stress[2] == 3);
    ck_assert_int_eq(bbm_nodal_result(m, 4, 3, &r), BBM_OK);
    ck_assert(r.u == 8 && r.v == 70 && r.stress[0] == 5 && r.stress[1] == 2 && r.stress[2] == -1);
    ck_assert_int_eq(bbm_nodal_result(m, 0, 2, &r), BBM_OK);
    ck_assert_int_eq(bbm_nodal_result(m, 0, 3, &r), BBM_BAD_INDEX);        /* block 3 is not there */
    ck_assert_int_eq(bbm_nodal_result(m, 6, -1, &r), BBM_BAD_INDEX);
    ck_assert_int_eq(bbm_nodal_result(m, -1, -1, &r), BBM_BAD_INDEX);
    for (int v = 0; v < m->vertices; v++)
        m->element[m->vertex[v].element].block = 0;                        /* block 0 is a block, not all of them */
    m->element[1].block = 1;
    ck_assert_int_eq(bbm_nodal_result(m, 4, 0, &r), BBM_OK);
    ck_assert(r.u == 3);
    bbm_model_free(m);
}
END_TEST

START_TEST(clockwise_elements_are_turned_round)
{
    const int corners[2][4] = { { 0, 1, 2, 3 }, { 3, 2, 1, 0 } };
    bbm_model *m[2];

    for (int way = 0; way < 2; way++) {
        m[way] = new_model(&SOLID);
        for (int n = 0; n < 4; n++)
            ck_ok(bbm_add_node(m[way], SHAPES[1].x[n][0], SHAPES[1].x[n][1], NULL), m[way]);
        ck_ok(bbm_add_element(m[way], 0, 0, 4, corners[way], NULL), m[way]);
        ck_ok(bbm_fix_node(m[way], 0, BBM_XY, 0, 0), m[way]);
        ck_ok(bbm_fix_node(m[way], 1, BBM_Y, 0, 0), m[way]);
        ck_ok(bbm_add_load(m[way], 2, 1, 3), m[way]);
        ck_ok(bbm_prepare(m[way]), m[way]);
        ck_ok(bbm_step(m[way]), m[way]);
    }
    ck_assert(m[1]->element[0].A > 0);
    ck_relative(m[1]->element[0].A0, m[0]->element[0].A0, ROUNDING);
    for (int n = 0; n < 4; n++) {
        ck_near(result_at(m[1], n).u, result_at(m[0], n).u, 0.01, SOLVED);
        ck_near(result_at(m[1], n).v, result_at(m[0], n).v, 0.01, SOLVED);
        ck_near(result_at(m[1], n).mises, result_at(m[0], n).mises, 1, SOLVED);
    }
    bbm_model_free(m[0]);
    bbm_model_free(m[1]);
}
END_TEST

START_TEST(a_load_on_an_edge_of_clockwise_elements_finds_it)
{
    bbm_model *m = new_model(&SOLID);
    double total[3] = { 0 };

    for (int n = 0; n < 4; n++)
        ck_ok(bbm_add_node(m, n == 1 || n == 2, n / 2, NULL), m);
    ck_ok(bbm_add_element(m, 0, 0, 4, (int[]){ 3, 2, 1, 0 }, NULL), m);
    ck_ok(bbm_fix_node(m, 0, BBM_XY, 0, 0), m);
    ck_ok(bbm_fix_node(m, 3, BBM_X, 0, 0), m);
    ck_ok(bbm_add_line_load(m, 1, 2, 4, 2), m);
    ck_ok(bbm_prepare(m), m);
    ck_ok(bbm_step(m), m);
    total_load(m, 0, total);
    ck_near(total[0], 4, 1, ROUNDING);
    ck_near(total[1], 2, 1, ROUNDING);
    ck_near(total[2], 2 - 4 * 0.5, 1, ROUNDING);
    bbm_model_free(m);
}
END_TEST

START_TEST(indices_count_from_zero)
{
    bbm_model *m = new_model(&SOLID);
    int index = -1;

    ck_ok(bbm_add_material(m, &CORK, &index), m);
    ck_assert_int_eq(index, 1);
    for (int n = 0; n < 40; n++) {
        ck_ok(bbm_add_node(m, n, n % 2, &index), m);
        ck_assert_int_eq(index, n);
    }
    for (int e = 0; e < 38; e++) {
        ck_ok(bbm_add_element(m, 0, 1, 3, (int[]){ e, e + 1, e + 2 }, &index), m);
        ck_assert_int_eq(index, e);
    }
    ck_ok(bbm_prepare(m), m);
    ck_assert(m->bonds == 37 && m->edges == 40 && m->element[3].material.nu == 0);
    bbm_model_free(m);
}
END_TEST

/* --------------------------------------------------------------------------------------------------- bad input */

/* Fails unless the status is the expected one and the message opens with its text and names what it was about. */
static void check_error(const bbm_model *m, bbm_status got, bbm_status expected, const char *named)
{
    const char *text = bbm_status_text(expected), *message = bbm_message(m);

    ck_assert_msg(got == expected, "%s (%s), expected %s", bbm_status_text(got), message, text);
    ck_assert_msg(strncmp(message, text, strlen(text)) == 0 && strstr(message, named),
                  "\"%s\", expected \"%s: ...%s...\"", message, text, named);
}

static const struct { bbm_material material; bbm_status status; const char *named; } BAD_MATERIALS[] = {
    { { NAN, 0.3, 1, 1 }, BBM_NOT_FINITE, "material 1" },
    { { 1, INFINITY, 1, 1 }, BBM_NOT_FINITE, "material 1" },
    { { 1, 0.3, NAN, 1 }, BBM_NOT_FINITE, "material 1" },
    { { 1, 0.3, 1, -INFINITY }, BBM_NOT_FINITE, "material 1" },
    { { 0, 0.3, 1, 1 }, BBM_BAD_MODULUS, "material 1 has E = 0" },
    { { -5, 0.3, 1, 1 }, BBM_BAD_MODULUS, "material 1 has E = -5" },
    { { 1, -1, 1, 1 }, BBM_BAD_POISSON, "material 1 has nu = -1" },
    { { 1, 0.5, 1, 1 }, BBM_BAD_POISSON, "material 1 has nu = 0.5" },
    { { 1, 0.6, 1, 1 }, BBM_BAD_POISSON, "material 1 has nu = 0.6" },
    { { 1, 0.3, 0, 1 }, BBM_BAD_DENSITY, "material 1 has 0" },
    { { 1, 0.3, -2, 1 }, BBM_BAD_DENSITY, "material 1 has -2" },
    { { 1, 0.3, 1, 0 }, BBM_BAD_THICKNESS, "material 1 has 0" },
    { { 1, 0.3, 1, -3 }, BBM_BAD_THICKNESS, "material 1 has -3" },
};

START_TEST(bad_materials_are_refused)
{
    bbm_model *m = new_model(&SOLID);

    check_error(m, bbm_add_material(m, &BAD_MATERIALS[_i].material, NULL), BAD_MATERIALS[_i].status,
                BAD_MATERIALS[_i].named);
    ck_assert_int_eq(bbm_prepare(m), BAD_MATERIALS[_i].status);
    bbm_model_free(m);
}
END_TEST

START_TEST(materials_up_to_the_limits_are_taken)
{
    const bbm_material limit[] = { { 1e-300, 0.499, 1e-300, 1e-300 }, { 1, -0.999, 1, 1 }, { 1e12, 0, 1e5, 1e5 } };
    bbm_model *m = new_model(&SOLID);

    for (int i = 0; i < COUNT(limit); i++)
        ck_ok(bbm_add_material(m, &limit[i], NULL), m);
    bbm_model_free(m);
}
END_TEST

enum { MOST = 12 };

static const struct { bbm_status status; int n, node[MOST]; } POLYGONS[] = {
    { BBM_FEW_VERTICES, 0, { 0 } },
    { BBM_FEW_VERTICES, 2, { 0, 1 } },
    { BBM_ZERO_AREA, 3, { 0, 1, 2 } },                      /* a line */
    { BBM_ZERO_AREA, 3, { 6, 6, 6 } },                      /* a point */
    { BBM_ZERO_AREA, 3, { 0, 6, 0 } },
    { BBM_ZERO_AREA, 4, { 0, 6, 18, 12 } },
    { BBM_ZERO_AREA, 3, { 0, 2, 25 } },                     /* as flat as rounding */
    { BBM_ZERO_AREA, 3, { 0, 10, 27 } },
    { BBM_ZERO_AREA, 3, { 0, 5, 27 } },                     /* long, with one short side */
    { BBM_OK, 3, { 0, 2, 26 } },                            /* flat, but not a line */
    { BBM_SELF_CROSSING, 4, { 0, 2, 10, 12 } },             /* bow ties, of no signed area and of some */
    { BBM_SELF_CROSSING, 4, { 0, 3, 10, 12 } },
    { BBM_SELF_CROSSING, 4, { 0, 1, 15, 18 } },
    { BBM_SELF_CROSSING, 5, { 0, 4, 11, 22, 13 } },         /* the pentagram's way */
    { BBM_SELF_CROSSING, 4, { 0, 2, 2, 12 } },              /* a node twice running */
    { BBM_SELF_CROSSING, 6, { 0, 2, 6, 12, 10, 6 } },       /* ... and at a pinch */
    { BBM_SELF_CROSSING, 4, { 0, 4, 2, 12 } },              /* spikes: along the side, and from a corner */
    { BBM_SELF_CROSSING, 5, { 0, 2, 12, 18, 6 } },
    { BBM_SELF_CROSSING, 5, { 0, 2, 12, 1, 10 } },          /* a corner on a side */
    { BBM_SELF_CROSSING, 5, { 0, 2, 5, 12, 10 } },
    { BBM_SELF_CROSSING, 6, { 0, 4, 14, 11, 3, 10 } },
    { BBM_SELF_CROSSING, 8, { 0, 4, 9, 2, 1, 5, 15, 10 } }, /* sides that lie on one another */
    { BBM_SELF_CROSSING, 7, { 0, 4, 24, 23, 3, 1, 20 } },
    { BBM_OK, 4, { 0, 2, 12, 10 } },
    { BBM_OK, 5, { 0, 1, 2, 12, 10 } },                     /* a straight corner */
    { BBM_OK, 4, { 0, 4, 6, 20 } },                         /* an arrow */
    { BBM_OK, 6, { 0, 4, 9, 6, 21, 20 } },                  /* an L */
    { BBM_OK, 8, { 0, 4, 24, 23, 8, 6, 21, 20 } },          /* a U: sides in line with one another, apart */
    { BBM_OK, 12, { 1, 3, 8, 9, 19, 18, 23, 21, 16, 15, 5, 6 } },   /* a cross */
    { BBM_OK, 8, { 0, 6, 2, 8, 4, 24, 22, 20 } },           /* teeth: tips in line with the side behind */
    { BBM_OK, 8, { 0, 4, 14, 13, 7, 11, 15, 5 } },
};

/* From each corner, either way round, and whether it is measured in micrometres or kilometres: the answer belongs to
 * the polygon, not to how it is written. */
START_TEST(polygons_are_judged_by_their_shape)
{
    const int n = POLYGONS[_i].n, starts = n < 1 ? 1 : n;

    for (int way = 0; way < 6 * starts; way++) {
        const int start = way / 6;
        bbm_model *m = points(ldexp(1, 27 * (way % 3 - 1)));
        int node[MOST];
        for (int c = 0; c < n; c++)
            node[c] = POLYGONS[_i].node[(way % 2 ? start + n - c : start + c) % n];
        ck_ok(bbm_add_element(m, 0, 0, 3, (int[]){ 0, 1, 5 }, NULL), m);
        const bbm_status status = bbm_add_element(m, 1, 0, n, node, NULL);
        if (POLYGONS[_i].status != BBM_OK)
            check_error(m, status, POLYGONS[_i].status, "element 1");
        else
            ck_ok(status, m);
        bbm_model_free(m);
    }
}
END_TEST

START_TEST(messages_on_elements_give_numbers)
{
    bbm_model *m = points(1), *n = points(1);

    check_error(m, bbm_add_element(m, 0, 0, 2, (int[]){ 0, 1 }, NULL), BBM_FEW_VERTICES, "element 0 has 2");
    check_error(n, bbm_add_element(n, 0, 0, 3, (int[]){ 0, 2, 25 }, NULL), BBM_ZERO_AREA, "element 0, 1e-13 m^2");
    bbm_model_free(m);
    bbm_model_free(n);
}
END_TEST

static void not_a_number(double x, double y, const void *context, double f[2])
{
    const int *component = context;

    f[0] = f[1] = x + y;
    f[*component] = x + y > 1.5 ? NAN : 0;                                 /* at some of the points only */
}

static const int COMPONENT[2] = { 0, 1 };

/* One wrong call each on the unit square. */
static bbm_status call_wrongly(bbm_model *m, int which)
{
    const int corners[4] = { 0, 1, 2, 3 }, high[3] = { 0, 1, 4 }, low[3] = { -1, 1, 2 };

    switch (which) {
    case 0:  return bbm_add_node(m, NAN, 2, NULL);
    case 1:  return bbm_add_node(m, 2, INFINITY, NULL);
    case 2:  return bbm_add_element(m, 0, 1, 4, corners, NULL);
    case 3:  return bbm_add_element(m, 0, -1, 4, corners, NULL);
    case 4:  return bbm_add_element(m, 0, 0, 3, high, NULL);
    case 5:  return bbm_add_element(m, 0, 0, 3, low, NULL);
    case 6:  return bbm_fix_node(m, 4, BBM_XY, 0, 0);
    case 7:  return bbm_fix_node(m, -1, BBM_XY, 0, 0);
    case 8:  return bbm_fix_node(m, 2, 0, 0, 0);
    case 9:  return bbm_fix_node(m, 2, 4, 0, 0);
    case 10: return bbm_fix_node(m, 2, BBM_X, NAN, 0);
    case 11: return bbm_fix_node(m, 2, BBM_X, 0, INFINITY);
    case 12: return bbm_add_load(m, 4, 1, 1);
    case 13: return bbm_add_load(m, 3, NAN, 1);
    case 14: return bbm_add_load(m, 3, 1, -INFINITY);
    case 15: return bbm_add_line_load(m, 0, 4, 1, 1);
    case 16: return bbm_add_line_load(m, -1, 3, 1, 1);
    case 17: return bbm_add_line_load(m, 0, 1, NAN, 1);
    case 18: return bbm_add_line_load(m, 0, 1, 1, NAN);
    case 19: return bbm_add_varying_line_load(m, 0, 4, not_a_number, &COMPONENT[0]);
    case 20: return bbm_add_varying_line_load(m, -2, 1, not_a_number, &COMPONENT[0]);
    case 21: return bbm_add_varying_line_load(m, 2, 1, not_a_number, &COMPONENT[0]);
    default: return bbm_add_varying_line_load(m, 1, 2, not_a_number, &COMPONENT[1]);
    }
}

static const struct { bbm_status status; const char *named; } WRONG_CALLS[] = {
    { BBM_NOT_FINITE, "node 4 at (nan, 2)" },
    { BBM_NOT_FINITE, "node 4 at (2, inf)" },
    { BBM_BAD_INDEX, "element 1 has material 1 of 1" },
    { BBM_BAD_INDEX, "element 1 has material -1 of 1" },
    { BBM_BAD_INDEX, "element 1 has node 4 of 4" },
    { BBM_BAD_INDEX, "element 1 has node -1 of 4" },
    { BBM_BAD_INDEX, "fixed node 4 of 4" },
    { BBM_BAD_INDEX, "fixed node -1 of 4" },
    { BBM_BAD_PARAMETER, "directions 0 of fixed node 2" },
    { BBM_BAD_PARAMETER, "directions 4 of fixed node 2" },
    { BBM_NOT_FINITE, "fixed node 2" },
    { BBM_NOT_FINITE, "fixed node 2" },
    { BBM_BAD_INDEX, "loaded node 4 of 4" },
    { BBM_NOT_FINITE, "node 3" },
    { BBM_NOT_FINITE, "node 3" },
    { BBM_BAD_INDEX, "nodes 0, 4 of 4" },
    { BBM_BAD_INDEX, "nodes -1, 3 of 4" },
    { BBM_NOT_FINITE, "nodes 0, 1" },
    { BBM_NOT_FINITE, "nodes 0, 1" },
    { BBM_BAD_INDEX, "nodes 0, 4 of 4" },
    { BBM_BAD_INDEX, "nodes -2, 1 of 4" },
    { BBM_NOT_FINITE, "nodes 2, 1" },
    { BBM_NOT_FINITE, "nodes 1, 2" },
};

/* After it, correct calls of every kind return the same status and change nothing. */
START_TEST(the_first_error_of_building_stays)
{
    const bbm_status first = WRONG_CALLS[_i].status;
    const double scale[2] = { 1, 1 };
    bbm_model *m = unit_square(&SOLID);
    char message[sizeof m->message];

    check_error(m, call_wrongly(m, _i), first, WRONG_CALLS[_i].named);
    strcpy(message, bbm_message(m));
    ck_assert_int_eq(bbm_add_material(m, &BAD_MATERIALS[0].material, NULL), first);
    ck_assert_int_eq(bbm_add_material(m, &CORK, NULL), first);
    ck_assert_int_eq(bbm_add_node(m, 2, 3, NULL), first);
    ck_assert_int_eq(bbm_add_element(m, 0, 0, 4, (int[]){ 0, 1, 2, 3 }, NULL), first);
    ck_assert_int_eq(bbm_fix_node(m, 0, BBM_XY, 0, 0), first);
    ck_assert_int_eq(bbm_add_load(m, 0, 1, 1), first);
    ck_assert_int_eq(bbm_add_line_load(m, 0, 1, 1, 1), first);
    ck_assert_int_eq(bbm_add_varying_line_load(m, 0, 1, rising, scale), first);
    ck_assert_int_eq(bbm_prepare(m), first);
    ck_assert_int_eq(bbm_run(m), first);
    ck_assert_str_eq(bbm_message(m), message);
    ck_assert(m->materials == 1 && m->nodes == 4 && m->elements == 1 && m->line_loads == 0);
    ck_assert(m->node[0].held == 0 && m->node[0].load[0] == 0);
    bbm_model_free(m);
}
END_TEST

START_TEST(a_model_without_elements_is_refused)
{
    bbm_model *m = points(1);

    check_error(m, bbm_prepare(m), BBM_NO_ELEMENT, "28 nodes");
    bbm_model_free(m);
}
END_TEST

START_TEST(a_node_that_no_element_has_is_named)
{
    bbm_model *m = unit_square(&SOLID);

    ck_ok(bbm_add_node(m, 2.5, -3, NULL), m);
    ck_ok(bbm_add_node(m, 0.5, 7, NULL), m);
    check_error(m, bbm_prepare(m), BBM_UNUSED_NODE, "node 4 at (2.5, -3)");
    ck_ok(bbm_add_element(m, 0, 0, 3, (int[]){ 1, 4, 2 }, NULL), m);       /* a model may be mended */
    check_error(m, bbm_prepare(m), BBM_UNUSED_NODE, "node 5 at (0.5, 7)");
    ck_ok(bbm_add_element(m, 0, 0, 3, (int[]){ 2, 5, 3 }, NULL), m);
    ck_ok(bbm_prepare(m), m);
    bbm_model_free(m);
}
END_TEST

START_TEST(elements_of_one_block_on_the_same_side_of_an_edge_are_named)
{
    const double top[3][2] = { { 0, 1 }, { 1, 1 }, { 0.5, -1 } };
    bbm_model *m = fan(2, top, (int[]){ 0, 0 }), *n = fan(3, top, (int[]){ 6, 6, 6 });
    bbm_model *o = fan(2, top, (int[]){ 0, 1 }), *p = fan(2, top + 1, (int[]){ 0, 0 });

    check_error(m, bbm_prepare(m), BBM_OVERLAP, "elements 0 and 1 on the same side of nodes 0, 1");
    check_error(n, bbm_prepare(n), BBM_OVERLAP, "elements 0 and 2 on the same side of nodes 0, 1");
    check_error(o, bbm_prepare(o), BBM_BLOCKS_OVERLAP, "0.707107 m deep at (0.5, 0.1): block 0 with element 0, "
                "block 1 with element 1");
    ck_ok(bbm_prepare(p), p);                                              /* above and below */
    ck_assert(o->bonds == 0 && p->bonds == 1);
    bbm_model_free(m);
    bbm_model_free(n);
    bbm_model_free(o);
    bbm_model_free(p);
}
END_TEST

START_TEST(a_load_on_an_edge_that_does_not_exist_is_refused)
{
    bbm_model *m = unit_square(&SOLID);

    if (_i > 0)
        ck_ok(bbm_prepare(m), m);
    if (_i == 3)
        ck_ok(bbm_load_edge(m, 3, 1, 2, 3), m);
    else
        check_error(m, bbm_load_edge(m, (int[]){ 0, -1, 4 }[_i], 1, 2, 3), BBM_BAD_INDEX, "loaded edge");
    bbm_model_free(m);
}
END_TEST

START_TEST(a_line_load_on_what_is_no_boundary_edge_is_refused)
{
    const int nodes[4][2] = { { 1, 4 }, { 0, 4 }, { 2, 2 }, { 0, 0 } };    /* inside, a diagonal, points */
    const char *const named[4] = { "nodes 1 and 4", "nodes 0 and 4", "nodes 2 and 2", "nodes 0 and 0" };
    bbm_model *m = two_squares(0, 0);

    ck_ok(bbm_add_line_load(m, 0, 1, 1, 1), m);
    ck_ok(bbm_add_line_load(m, nodes[_i][0], nodes[_i][1], 1, 1), m);
    check_error(m, bbm_prepare(m), BBM_NOT_BOUNDARY, named[_i]);
    bbm_model_free(m);
}
END_TEST

START_TEST(a_load_on_an_edge_that_two_blocks_have_goes_to_the_first)
{
    const double top[2][2] = { { 0, 1 }, { 1, -1 } };
    bbm_model *m = fan(2, top, (int[]){ 0, 1 });

    ck_ok(bbm_add_line_load(m, 0, 1, 1, 1), m);
    ck_ok(bbm_prepare(m), m);
    ck_assert(m->line_load[0].a == 0 && m->line_load[0].b == 1);
    bbm_model_free(m);
}
END_TEST

/* Two squares of 1 m, block 5 with nodes 0-3 and block 7 with nodes 4-7, and a second element of block 7 with 8, 9;
 * each numbered counter-clockwise from its left bottom; all times a size, and maybe far from the origin. */
static bbm_model *two_bodies(double size, double far)
{
    const double x[10][2] = { { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 }, { 3, 0 }, { 4, 0 }, { 4, 1 }, { 3, 1 }, { 5, 0 },
                              { 5, 1 } };
    bbm_model *m = new_model(&SOLID);

    for (int n = 0; n < 10; n++)
        ck_ok(bbm_add_node(m, size * x[n][0] + far, size * x[n][1] - far, NULL), m);
    ck_ok(bbm_add_element(m, 5, 0, 4, (int[]){ 0, 1, 2, 3 }, NULL), m);
    ck_ok(bbm_add_element(m, 7, 0, 4, (int[]){ 4, 5, 6, 7 }, NULL), m);
    ck_ok(bbm_add_element(m, 7, 0, 4, (int[]){ 5, 8, 9, 6 }, NULL), m);
    return m;
}

static const struct { int points, held[4][2], free_block; } HOLDS[] = {
    /* block 7 is held at node 9 (its second element) and 4 in all but the last */
    { 0, { { 0 } }, 5 },
    { 1, { { 0, BBM_XY } }, 5 },
    { 2, { { 0, BBM_X }, { 3, BBM_X } }, 5 },                              /* rollers that let it slide */
    { 4, { { 0, BBM_Y }, { 1, BBM_Y }, { 2, BBM_Y }, { 3, BBM_Y } }, 5 },
    { 2, { { 0, BBM_XY }, { 1, BBM_X } }, 5 },                             /* the lines of action meet in a point */
    { 2, { { 0, BBM_XY }, { 3, BBM_Y } }, 5 },
    { 3, { { 3, BBM_X }, { 1, BBM_Y }, { 2, BBM_X } }, 5 },
    { 2, { { 0, BBM_XY }, { 2, BBM_X } }, -1 },
    { 2, { { 0, BBM_XY }, { 1, BBM_Y } }, -1 },
    { 3, { { 0, BBM_X }, { 3, BBM_X }, { 1, BBM_Y } }, -1 },
    { 2, { { 1, BBM_XY }, { 3, BBM_XY } }, -1 },
    { 2, { { 0, BBM_XY }, { 1, BBM_Y } }, 7 },
};

START_TEST(statics_refuses_a_body_that_is_free_to_move_and_names_it)
{
    const double ways[3][2] = { { 1, 0 }, { 1, 1e6 / 3 }, { 1e-6, 0 } };
    const int free_block = HOLDS[_i].free_block;

    for (int way = 0; way < 3; way++) {
        bbm_model *m = two_bodies(ways[way][0], ways[way][1]);
        for (int p = 0; p < HOLDS[_i].points; p++)
            ck_ok(bbm_fix_node(m, HOLDS[_i].held[p][0], HOLDS[_i].held[p][1], 0, 0), m);
        ck_ok(bbm_fix_node(m, 9, BBM_XY, 0, 0), m);
        if (free_block != 7)
            ck_ok(bbm_fix_node(m, 4, BBM_Y, 0, 0), m);
        ck_ok(bbm_prepare(m), m);
        const bbm_status status = bbm_run(m);
        if (free_block < 0) {
            ck_ok(status, m);
        } else {
            check_error(m, status, BBM_FREE_TO_MOVE, free_block == 5 ? "block 5" : "block 7");
            if (free_block == 5 && way == 0)
                check_error(m, status, BBM_FREE_TO_MOVE, "element 0 at (0.5, 0.5)");
            m->par.dt = 0.1;                                               /* with inertia it may move */
            ck_ok(bbm_run(m), m);
        }
        bbm_model_free(m);
    }
}
END_TEST

/* Two points a millionth of the body apart hold it; at a hundred millionth it counts as free. */
START_TEST(fixed_points_close_together_hold_a_body_within_reason)
{
    for (int way = 0; way < 2; way++) {
        bbm_model *m = new_model(&SOLID);
        const double x[4][2] = { { 0, 0 }, { way ? 1e-3 : 1e-7, 0 }, { 1, 0 }, { 0, 1 } };
        for (int n = 0; n < 4; n++)
            ck_ok(bbm_add_node(m, x[n][0], x[n][1], NULL), m);
        ck_ok(bbm_add_element(m, 0, 0, 4, (int[]){ 0, 1, 2, 3 }, NULL), m);
        ck_ok(bbm_fix_node(m, 0, BBM_XY, 0, 0), m);
        ck_ok(bbm_fix_node(m, 1, BBM_XY, 0, 0), m);
        ck_ok(bbm_prepare(m), m);
        ck_assert_int_eq(bbm_step(m), way ? BBM_OK : BBM_FREE_TO_MOVE);
        bbm_model_free(m);
    }
}
END_TEST

#define PARAMETER(name, value) { offsetof(bbm_parameters, name), value, #name }

static const struct { size_t offset; double value; const char *name; } PARAMETERS[] = {
    PARAMETER(dt, 0),
    PARAMETER(dt, -1),
    PARAMETER(dt, NAN),
    PARAMETER(tolerance, -1e-9),
    PARAMETER(tolerance, NAN),
    PARAMETER(tolerance, INFINITY),
    PARAMETER(keep, -0.01),
    PARAMETER(keep, 1.01),
    PARAMETER(keep, NAN),
    PARAMETER(alpha, 0),
    PARAMETER(alpha, -100),
    PARAMETER(alpha, NAN),
    PARAMETER(alpha, INFINITY),
    PARAMETER(gravity[0], NAN),
    PARAMETER(gravity[1], INFINITY),
    PARAMETER(p_n, 0),
    PARAMETER(p_n, INFINITY),
    PARAMETER(p_s, 0),
    PARAMETER(p_s, INFINITY),
    PARAMETER(friction, -1),
    PARAMETER(friction, 90),
    PARAMETER(cohesion, -1),
    PARAMETER(cohesion, INFINITY),
    PARAMETER(tension, -1),
    PARAMETER(tension, INFINITY),
    PARAMETER(pcg.omega, 0),
    PARAMETER(pcg.omega, 2),
    PARAMETER(pcg.omega, NAN),
    PARAMETER(pcg.tolerance, 0),
    PARAMETER(pcg.tolerance, 1),
    PARAMETER(pcg.tolerance, NAN),
};

/* The unit square, held, loaded and prepared. */
static bbm_model *held_square(void)
{
    bbm_model *m = unit_square(&SOLID);

    ck_ok(bbm_fix_node(m, 0, BBM_XY, 0, 0), m);
    ck_ok(bbm_fix_node(m, 1, BBM_Y, 0, 0), m);
    ck_ok(bbm_add_load(m, 2, 1, -3), m);
    ck_ok(bbm_prepare(m), m);
    return m;
}

START_TEST(parameters_outside_their_range_are_refused_by_name)
{
    bbm_model *m = held_square();
    char named[60];

    snprintf(named, sizeof named, "%s = %g", PARAMETERS[_i].name, PARAMETERS[_i].value);
    memcpy((char *)&m->par + PARAMETERS[_i].offset, &PARAMETERS[_i].value, sizeof(double));
    check_error(m, bbm_step(m), BBM_BAD_PARAMETER, named);
    ck_assert_int_eq(m->info.step, 0);
    bbm_model_free(m);
}
END_TEST

START_TEST(counts_below_one_are_refused_by_name)
{
    bbm_model *m = held_square();

    m->par.steps = 0;
    check_error(m, bbm_run(m), BBM_BAD_PARAMETER, "steps = 0");
    m->par.steps = 1;
    m->par.pcg.iterations = 0;
    check_error(m, bbm_run(m), BBM_BAD_PARAMETER, "iterations = 0");
    bbm_model_free(m);
}
END_TEST

START_TEST(parameters_at_the_ends_of_their_range_are_taken)
{
    bbm_model *m = held_square();

    m->par.keep = 1;
    m->par.dt = 1e-3;
    m->par.tolerance = 0;
    m->par.steps = 1;
    ck_ok(bbm_run(m), m);
    m->par.pcg.omega = 1.99;
    m->par.pcg.tolerance = 0.5;
    ck_ok(bbm_run(m), m);
    bbm_model_free(m);
}
END_TEST

START_TEST(a_step_before_bbm_prepare_is_refused)
{
    bbm_model *m = unit_square(&SOLID);

    check_error(m, bbm_step(m), BBM_BAD_PARAMETER, "bbm_prepare");
    bbm_model_free(m);
}
END_TEST

START_TEST(a_negative_stiffness_is_found)
{
    bbm_model *m = two_squares(0, 0);

    ck_ok(bbm_fix_node(m, 0, BBM_XY, 0, 0), m);
    ck_ok(bbm_fix_node(m, 3, BBM_XY, 0, 0), m);
    ck_ok(bbm_add_load(m, 5, 1, 1), m);
    ck_ok(bbm_prepare(m), m);
    m->element[1].material.E = -1e9;
    check_error(m, bbm_step(m), BBM_NOT_POSITIVE_DEFINITE, "step 1, ");
    bbm_model_free(m);
}
END_TEST

/* Everything that a step moves, in one piece of memory. */
static size_t state_of(const bbm_model *m, double *state)
{
    size_t n = 0;

    for (int v = 0; v < m->vertices; v++) {
        const bbm_vertex *p = &m->vertex[v];
        const double here[4] = { p->x, p->y, p->u, p->v };
        memcpy(&state[n], here, sizeof here);
        n += 4;
    }
    for (int i = 0; i < m->elements; i++) {
        const bbm_element *e = &m->element[i];
        const double here[3] = { e->A0, e->sum[0], e->sum[1] };
        memcpy(&state[n], here, sizeof here);
        memcpy(&state[n + 3], e->V, sizeof e->V);
        memcpy(&state[n + 9], e->stress, sizeof e->stress);
        memcpy(&state[n + 12], e->D, sizeof e->D);
        n += 18;
    }
    state[n] = m->info.step;
    state[n + 1] = m->info.t;
    return n + 2;
}

enum { STATE = 2000 };

START_TEST(a_step_that_fails_leaves_the_model_as_it_was)
{
    grid g = { .lx = 3, .ly = 2, .nx = 3, .ny = 2, .triangles = 1 };
    bbm_model *m = cantilever(&SOLID, &g, 5, -4);
    double before[STATE] = { 0 }, after[STATE] = { 0 };

    m->par.dt = 0.1;
    m->par.keep = 1;
    ck_ok(bbm_step(m), m);
    const size_t n = state_of(m, before);
    m->par.pcg.iterations = 1;
    check_error(m, bbm_step(m), BBM_NOT_CONVERGED, "step 2, 1 iterations");
    check_error(m, bbm_run(m), BBM_NOT_CONVERGED, "step 2, 1 iterations");
    state_of(m, after);
    ck_assert(memcmp(before, after, n * sizeof *before) == 0);
    m->par.pcg.iterations = 1000;
    ck_ok(bbm_step(m), m);
    ck_assert_int_eq(m->info.step, 2);
    bbm_model_free(m);
}
END_TEST

START_TEST(every_status_has_a_text_of_its_own)
{
    for (int s = 0; s < BBM_STATUS_COUNT; s++) {
        const char *text = bbm_status_text((bbm_status)s);
        ck_assert(text && strlen(text) > 5 && strcmp(text, bbm_status_text(BBM_STATUS_COUNT)) != 0);
        for (int t = 0; t < s; t++)
            ck_assert_str_ne(text, bbm_status_text((bbm_status)t));
    }
    ck_assert_str_eq(bbm_status_text((bbm_status)-1), bbm_status_text(BBM_STATUS_COUNT));
}
END_TEST

START_TEST(nothing_may_be_freed)
{
    bbm_model_free(NULL);
}
END_TEST

/* --------------------------------------------------------------------------------------- memory and repetition */

/* Builds and runs a model that uses every function which allocates; *m is NULL if there was not even room for that. */
static bbm_status build_and_run(bbm_model **m)
{
    const double scale[2] = { 1e-3, -1e-3 };
    const bbm_status status = bbm_model_new(m);

    if (status)
        return status;
    (*m)->par.bonding = BBM_VERTICES;
    (*m)->par.gravity[1] = -1e-3;
    (*m)->par.steps = 3;
    bbm_add_material(*m, &SOLID, NULL);
    for (int n = 0; n < 40; n++)
        bbm_add_node(*m, n / 2, n % 2, NULL);
    for (int e = 0; e < 19; e++)
        bbm_add_element(*m, 0, 0, 4, (int[]){ 2 * e, 2 * e + 2, 2 * e + 3, 2 * e + 1 }, NULL);
    for (int e = 0; e < 18; e++)
        bbm_add_line_load(*m, 2 * e + 1, 2 * e + 3, 0, -1e-6);
    bbm_add_varying_line_load(*m, 38, 39, rising, scale);
    bbm_fix_node(*m, 0, BBM_XY, 0, 0);
    bbm_fix_node(*m, 1, BBM_X, 0, 0);
    const bbm_status prepared = bbm_prepare(*m);
    return prepared ? prepared : bbm_run(*m);
}

static void check_same_state(const bbm_model *m, const bbm_model *n)
{
    double *a = calloc(2 * STATE, sizeof *a), *b = a + STATE;
    const size_t size = state_of(m, a);

    ck_assert(size <= STATE);
    ck_assert(state_of(n, b) == size && memcmp(a, b, size * sizeof *a) == 0);
    free(a);
}

/* Call k alone fails, or all from call k on. */
START_TEST(whichever_allocation_fails_the_status_is_no_memory_and_nothing_leaks)
{
    bbm_model *reference, *m;
    int k = 1;

    ck_assert_int_eq(build_and_run(&reference), BBM_OK);
    for (bbm_status status = BBM_NO_MEMORY; status != BBM_OK; k++) {
        test_allocations_left = _i ? k - 1 : -k;
        status = build_and_run(&m);
        test_allocations_left = TEST_ALLOCATIONS_UNLIMITED;
        ck_assert(status == BBM_NO_MEMORY || status == BBM_OK);
        if (status && m)
            check_error(m, status, BBM_NO_MEMORY, " nodes");
        if (status && m && m->status == BBM_OK) {       /* bbm_prepare or a step failed: both can be repeated */
            m->par.steps = 3 - m->info.step;
            ck_ok(bbm_prepare(m), m);
            ck_ok(bbm_run(m), m);
            check_same_state(m, reference);
        }
        bbm_model_free(m);
    }
    ck_assert(k > 20);
    bbm_model_free(reference);
}
END_TEST

/* Doubling: 16, 32, 64, ... and each at the entry that needs it. */
START_TEST(an_array_grows_by_doubling_when_it_is_full)
{
    const int next[] = { 0, 16, 32, 64, 128, 256, INT_MAX };
    bbm_model *m = new_model(&SOLID);

    for (int n = 0, grown = 0; n < 300; n++) {
        test_allocations_left = 1000;
        ck_ok(bbm_add_node(m, n, 0, NULL), m);
        ck_assert_int_eq(test_allocations_left, n == next[grown] ? 999 : 1000);
        grown += n == next[grown];
    }
    test_allocations_left = TEST_ALLOCATIONS_UNLIMITED;
    for (int n = 0; n < 300; n++)
        ck_assert(m->node[n].x == n);
    bbm_model_free(m);
}
END_TEST

START_TEST(two_runs_agree_bit_for_bit)
{
    bbm_model *m, *n;

    ck_assert_int_eq(build_and_run(&m), BBM_OK);
    ck_assert_int_eq(build_and_run(&n), BBM_OK);
    check_same_state(m, n);
    bbm_model_free(m);
    bbm_model_free(n);
}
END_TEST

/* ------------------------------------------------------------------------------------------------- the table */

typedef struct { const TTest *test; int times; } entry;

static void add_case(Suite *s, const char *name, const entry e[], int count)
{
    TCase *c = tcase_create(name);

    for (int i = 0; i < count; i++)
        tcase_add_loop_test(c, e[i].test, 0, e[i].times);
    suite_add_tcase(s, c);
}

static void add_formulas(Suite *s)
{
    const int shapes = COUNT(SHAPES);
    const entry energies[] = {
        { the_elastic_submatrix_is_the_derivative_of_the_strain_energy, shapes },
        { the_inertia_submatrix_is_the_derivative_of_its_energy, shapes },
        { the_bonding_submatrices_are_derivatives_of_the_springs_energy, shapes },
        { the_fixed_submatrix_is_the_derivative_of_the_energy_of_the_held_directions, shapes },
        { a_point_that_is_not_held_adds_nothing, 1 },
        { a_concentrated_load_is_the_derivative_of_its_potential, shapes },
        { a_load_constant_along_a_line_is_the_derivative_of_its_potential, shapes },
        { a_load_that_varies_along_a_line_is_the_derivative_of_its_potential, shapes },
        { a_volume_force_linear_in_x_and_y_is_the_derivative_of_its_potential, shapes },
        { a_constant_volume_force_is_the_derivative_of_its_potential, shapes },
    };
    const entry formulas[] = {
        { moments_of_polygons_have_their_closed_forms_also_far_from_the_origin, COUNT(AREAS) },
        { the_mode_matrix_moves_points_by_translation_rotation_and_strain, shapes },
        { positions_follow_the_exact_rotation_in_dynamics_and_the_modes_otherwise, shapes },
        { the_mode_integral_is_the_brute_force_integral, shapes },
        { hookes_law_gives_uniaxial_tension_and_pure_shear_their_strains, 1 },
        { the_bonding_stiffness_is_alpha_G_t_times_the_ratio_of_the_areas_either_way_round, 1 },
        { gauss_points_integrate_polynomials_to_degree_seven, 1 },
        { newmark_carries_a_constant_acceleration_without_error, 1 },
        { a_step_hands_on_the_share_of_the_velocity_that_is_kept, 1 },
        { von_mises_stress_is_that_of_its_principal_stresses, 1 },
    };

    add_case(s, "energies", energies, COUNT(energies));
    add_case(s, "formulas", formulas, COUNT(formulas));
}

static void add_models(Suite *s)
{
    const entry statics[] = {
        { K_is_symmetric_and_positive_definite_when_the_body_is_held, 2 },
        { K_has_three_zero_pivots_when_nothing_holds_the_body, 2 },
        { a_rigid_motion_of_bonded_elements_costs_nothing, 2 },
        { a_strip_under_uniform_traction_has_that_stress_in_every_element, COUNT(STRESSES) },
        { an_irregular_patch_under_uniform_traction_has_that_stress_in_every_element, COUNT(STRESSES) },
        { a_bonded_bar_stretches_by_its_strain_and_its_springs, 1 },
        { a_bar_of_two_materials_and_thicknesses_stretches_by_the_sum_of_its_parts, 1 },
        { displacements_fall_as_one_over_the_thickness, 1 },
        { a_displaced_wall_takes_the_body_along, 1 },
        { a_node_may_be_held_in_x_and_y_by_separate_calls, 1 },
        { a_load_that_varies_reaches_the_element_whichever_end_is_named_first, 2 },
        { a_load_that_varies_is_asked_for_at_the_gauss_points_alone, 1 },
        { loads_of_one_node_and_of_one_edge_add_up, 1 },
        { gravity_pulls_at_the_mass_of_each_element, 1 },
        { bonded_triangles_tend_to_the_constant_strain_finite_element_as_one_over_alpha, 1 },
        { a_body_under_pressure_all_round_has_that_stress, COUNT(SHAPES) },
        { a_block_that_is_one_polygon_has_the_mean_stress_of_its_loads, 1 },
    };
    const entry steps[] = {
        { a_thrown_body_follows_the_parabola, 2 },
        { the_acceleration_of_the_base_acts_like_gravity_the_other_way, 2 },
        { a_spinning_element_keeps_its_angular_velocity_and_its_mass, 2 },
        { stress_turns_with_the_element, 2 },
        { bonded_elements_keep_their_momentum_while_they_shake_each_other, 2 },
        { a_vibrating_element_is_damped_as_newmarks_recurrence_says, 1 },
        { steps_without_memory_of_velocity_end_in_the_static_answer, 1 },
        { statics_ends_in_balance_on_the_moved_geometry, 2 },
        { stress_is_that_of_the_present_section, 1 },
        { the_stop_criterion_compares_the_step_with_the_sum_of_all_steps, 1 },
        { a_run_stops_at_the_first_step_that_is_small_enough, 1 },
        { a_run_that_stops_short_says_so_and_keeps_what_it_has, 1 },
        { without_a_tolerance_a_run_does_all_its_steps, 1 },
        { without_a_tolerance_a_run_does_all_its_steps_even_at_rest, 1 },
        { a_body_without_load_stays_where_it_is, 1 },
    };

    add_case(s, "statics", statics, COUNT(statics));
    add_case(s, "steps", steps, COUNT(steps));
}

static void add_mesh_and_errors(Suite *s)
{
    const entry mesh[] = {
        { every_side_is_a_boundary_edge_or_a_bond, 2 },
        { boundary_edges_have_their_element_on_the_left, 2 },
        { elements_of_different_blocks_are_not_bonded, 1 },
        { blocks_that_lie_on_one_another_are_sorted_apart, 1 },
        { nodal_results_are_the_mean_over_the_elements_of_a_block_that_meet, 1 },
        { clockwise_elements_are_turned_round, 1 },
        { a_load_on_an_edge_of_clockwise_elements_finds_it, 1 },
        { indices_count_from_zero, 1 },
    };
    const entry errors[] = {
        { bad_materials_are_refused, COUNT(BAD_MATERIALS) },
        { materials_up_to_the_limits_are_taken, 1 },
        { polygons_are_judged_by_their_shape, COUNT(POLYGONS) },
        { messages_on_elements_give_numbers, 1 },
        { the_first_error_of_building_stays, COUNT(WRONG_CALLS) },
        { a_model_without_elements_is_refused, 1 },
        { a_node_that_no_element_has_is_named, 1 },
        { elements_of_one_block_on_the_same_side_of_an_edge_are_named, 1 },
        { a_line_load_on_what_is_no_boundary_edge_is_refused, 4 },
        { a_load_on_an_edge_that_does_not_exist_is_refused, 4 },
        { a_load_on_an_edge_that_two_blocks_have_goes_to_the_first, 1 },
        { statics_refuses_a_body_that_is_free_to_move_and_names_it, COUNT(HOLDS) },
        { fixed_points_close_together_hold_a_body_within_reason, 1 },
        { parameters_outside_their_range_are_refused_by_name, COUNT(PARAMETERS) },
        { counts_below_one_are_refused_by_name, 1 },
        { parameters_at_the_ends_of_their_range_are_taken, 1 },
        { a_step_before_bbm_prepare_is_refused, 1 },
        { a_negative_stiffness_is_found, 1 },
        { a_step_that_fails_leaves_the_model_as_it_was, 1 },
        { every_status_has_a_text_of_its_own, 1 },
        { nothing_may_be_freed, 1 },
        { whichever_allocation_fails_the_status_is_no_memory_and_nothing_leaks, 2 },
        { an_array_grows_by_doubling_when_it_is_full, 1 },
        { two_runs_agree_bit_for_bit, 1 },
    };

    add_case(s, "mesh", mesh, COUNT(mesh));
    add_case(s, "errors", errors, COUNT(errors));
}

Suite *bbm_suite(void)
{
    Suite *s = suite_create("bbm");

    add_formulas(s);
    add_models(s);
    add_mesh_and_errors(s);
    return s;
}
