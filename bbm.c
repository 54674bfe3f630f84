/* bbm.c - the bonding block model: sections 2 and 3.1 to 3.6 of the paper in their order, then the
 * time step, results, and how a model is built.
 *
 * Sun, Chen, Feng, Wang 2015, doi:10.1155/2015/723263. Read it with the paper open: each formula is
 * a function of its own, with the number of its equation above it.
 *
 *     2.1  displacement of an element  (1)-(3)     3.3  bonding            (18)-(28)
 *     2.2  element connections         (4)         3.4  fixed points       (29)-(37)
 *     3.1  elastic submatrices         (6)-(10)    3.5  loads along a line (38)-(43)
 *     3.2  inertia submatrices         (11)-(17)   3.6  volume force       (44)-(47)
 *
 * Every submatrix comes from one recipe. A source of potential energy Pi(D) is at most quadratic in
 * the unknowns; its second derivative goes to the left of K D = F, Eq. (5), and minus its first
 * derivative at D = 0 to the right. With a gap d = d0 + T D and an energy k/2 d.d that is
 * K += k T^T T and F -= k T^T d0: bonding springs, fixed points and contacts are this one line with
 * different d.
 *
 * Statics has no inertia, Eq. (16), (17): one step is one iteration of Newton-Raphson on the moved
 * geometry.
 *
 * What the paper does not have comes in through m->hook, see bbm_hooks in bbm.h.
 */
#include <math.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "base/base.h"

/* An element whose area is below FLAT times the square of its longest reach is a line: round-off
 * has its sign. */
#define FLAT 1e-12

/* The work of one step, cut or not, after which it has not settled: solutions, some times what the
 * worst walls needed; iterations in all of them, against those of one; detections of contacts in
 * one trial. And the smallest part of a step, dt/1024. */
enum { SOLUTIONS = 5000, ITERATIONS = 10, DETECTIONS = 8, PARTS = 1024 };

static bbm_status out_of_memory(bbm_model *m);

/* --------------------------------------------------------- 2.1 Displacement of an element */

/* Area, barycentre and second moments of a polygon by simplex integration, for Eq. (12): the sum
 * over its edges of the signed triangles (origin, a, b) with twice the area c = xa yb - xb ya,
 *     A = sum c/2,   int x dA = sum c/6 (xa + xb),   int x^2 dA = sum c/12 (xa^2 + xa xb + xb^2),
 *     int x y dA = sum c/24 (xa yb + 2 xa ya + 2 xb yb + xb ya).
 * Convex or not, the signs take care of it. The origin is first vertex 0, then the barycentre, so
 * that nothing cancels far from (0, 0). */
void bbm_element_geometry(bbm_element *e, const bbm_vertex v[])
{
    double A = 0, mx = 0, my = 0, sxx = 0, syy = 0, sxy = 0;

    for (int a = 0; a < e->n; a++) {
        const int b = (a + 1) % e->n;
        const double xa = v[a].x - v[0].x, ya = v[a].y - v[0].y;
        const double xb = v[b].x - v[0].x, yb = v[b].y - v[0].y;
        const double c = xa * yb - xb * ya;
        A += c / 2;
        mx += c / 6 * (xa + xb);
        my += c / 6 * (ya + yb);
    }
    e->A = A;
    e->x = v[0].x + mx / A;
    e->y = v[0].y + my / A;
    for (int a = 0; a < e->n; a++) {
        const int b = (a + 1) % e->n;
        const double xa = v[a].x - e->x, ya = v[a].y - e->y, xb = v[b].x - e->x, yb = v[b].y - e->y;
        const double c = xa * yb - xb * ya;
        sxx += c / 12 * (xa * xa + xa * xb + xb * xb);
        syy += c / 12 * (ya * ya + ya * yb + yb * yb);
        sxy += c / 24 * (xa * yb + 2 * xa * ya + 2 * xb * yb + xb * ya);
    }
    e->Sxx = sxx;
    e->Syy = syy;
    e->Sxy = sxy;
}

/* Displacement mode matrix: u(x, y) = T D, Eq. (1)-(3). */
void bbm_mode_matrix(const bbm_element *e, double x, double y, double T[2][6])
{
    const double X = x - e->x, Y = y - e->y;
    const double t[2][6] = {
        /* u0  v0  r0  ex  ey  gxy   */
        {  1,  0,  -Y,  X,  0,  Y / 2 },
        {  0,  1,   X,  0,  Y,  X / 2 },
    };

    memcpy(T, t, sizeof t);
}

/* u = T D */
static void multiply_mode(double T[2][6], const double D[6], double u[2])
{
    for (int r = 0; r < 2; r++) {
        u[r] = 0;
        for (int a = 0; a < 6; a++)
            u[r] += T[r][a] * D[a];
    }
}

/* Displacement u = T D at (x, y), a point given before the step, Eq. (1). */
void bbm_displacement(const bbm_element *e, const double D[6], double x, double y, double u[2])
{
    double T[2][6];

    bbm_mode_matrix(e, x, y, T);
    multiply_mode(T, D, u);
}

/* ------------------------------------------------------------- 2.2 Element connections */

static double shear_modulus(const bbm_material *m) { return m->E / (2 * (1 + m->nu)); }

/* Stiffness [N/m] of the bonding springs between two elements, Eq. (4),
 *     k = alpha G t max(A)/min(A),
 * with G and t the means of the two. Starting areas, so that a spring keeps its stiffness and its
 * energy. The paper's text names alpha, G and the areas; that they enter as this ratio is our
 * choice: k then has the dimension of G t, is symmetric, and alpha G t on a uniform mesh. */
double bbm_bonding_stiffness(double alpha, const bbm_element *i, const bbm_element *j)
{
    const double G = (shear_modulus(&i->material) + shear_modulus(&j->material)) / 2;
    const double t = (i->material.thickness + j->material.thickness) / 2;

    return alpha * G * t * fmax(i->A0, j->A0) / fmin(i->A0, j->A0);
}

/* -------------------------------------------------------------- 3.1 Elastic submatrices */

/* Hooke's law in plane stress, Eq. (7): stress = E e + stress0, e = (ex, ey, gxy) the last three
 * of D, Eq. (8). */
void bbm_elastic_matrix(const bbm_material *m, double E[3][3])
{
    const double c = m->E / (1 - m->nu * m->nu), G = shear_modulus(m);
    const double matrix[3][3] = {
        { c,         c * m->nu, 0 },
        { c * m->nu, c,         0 },
        { 0,         0,         G },
    };

    memcpy(E, matrix, sizeof matrix);
}

/* Pi_e = t A (1/2 e.E e + e.stress0), Eq. (6)-(9)
 *     ->   K_ii += t A E, F_i -= t A stress0, Eq. (10). */
void bbm_elastic_submatrix(const bbm_element *e, bbm_submatrix *s)
{
    const double tA = e->material.thickness * e->A;
    double E[3][3];

    bbm_elastic_matrix(&e->material, E);
    for (int a = 0; a < 3; a++) {
        for (int b = 0; b < 3; b++)
            s->K[3 + a][3 + b] += tA * E[a][b];
        s->F[3 + a] -= tA * e->stress[a];
    }
}

/* -------------------------------------------------------------- 3.2 Inertia submatrices */

/* Mass per present area, M of Eq. (11). The mass of an element stays density x thickness x starting
 * area, so that a strained element neither gains nor loses momentum. */
double bbm_mass_per_area(const bbm_element *e)
{
    return e->material.density * e->material.thickness * e->A0 / e->A;
}

/* int T^T T dA, Eq. (12), (16), (17); about the barycentre the first moments vanish. */
void bbm_mode_integral(const bbm_element *e, double M[6][6])
{
    const double A = e->A, xx = e->Sxx, yy = e->Syy, xy = e->Sxy;
    const double matrix[6][6] = {
        /* u0  v0  r0             ex      ey      gxy             */
        {  A,  0,  0,             0,      0,      0               },
        {  0,  A,  0,             0,      0,      0               },
        {  0,  0,  xx + yy,       -xy,    xy,     (xx - yy) / 2   },
        {  0,  0,  -xy,           xx,     0,      xy / 2          },
        {  0,  0,  xy,            0,      yy,     xy / 2          },
        {  0,  0,  (xx - yy) / 2, xy / 2, xy / 2, (xx + yy) / 4   },
    };

    memcpy(M, matrix, sizeof matrix);
}

/* Pi_i = int u.M u'' dA with the acceleration at the end of the step, u'' = 2/dt^2 D - 2/dt V,
 * Eq. (11)-(13) (Newmark, beta = 1/2, gamma = 1)
 *     ->   K_ii += 2 M/dt^2 int T^T T dA, Eq. (16),  F_i += 2 M/dt (int T^T T dA) V, Eq. (17).
 * The force of inertia is a load: Eq. (15) is varied by the D of u alone, not by the D of u''. */
void bbm_inertia_submatrix(const bbm_element *e, double dt, bbm_submatrix *s)
{
    const double M = bbm_mass_per_area(e);
    double TT[6][6];

    bbm_mode_integral(e, TT);
    for (int a = 0; a < 6; a++)
        for (int b = 0; b < 6; b++) {
            s->K[a][b] += 2 * M / (dt * dt) * TT[a][b];
            s->F[a] += 2 * M / dt * TT[a][b] * e->V[b];
        }
}

/* Velocity at the end of the step, V = 2/dt D - V, Eq. (14), times the share of it that goes on. */
void bbm_newmark_velocity(bbm_element *e, double dt, double factor)
{
    for (int a = 0; a < 6; a++)
        e->V[a] = factor * (2 / dt * e->D[a] - e->V[a]);
}

/* -------------------------------------------------------------- 3.3 Bonding submatrices */

/* T for the gaps and forces of a step, and the point it belongs to: Eq. (2) and the point where the
 * step starts. A hook may take both elsewhere on the point's way through the step. */
void bbm_step_matrix(const bbm_element *e, double x, double y, double T[2][6], double at[2])
{
    if (e->mode) {
        e->mode(e, x, y, T, at);
        return;
    }
    bbm_mode_matrix(e, x, y, T);
    at[0] = x;
    at[1] = y;
}

/* A spring k between the vertices P of element i and Q of element j, one point at the start. Its
 * elongation at the end of the step is |d|,
 *     d = d0 + Ti(P) Di - Tj(Q) Dj,  d0 = P - Q,  Eq. (18)-(23);   Pi_b = k/2 d.d,  Eq. (24)-(26).
 * d0 is the difference of the displacements: coordinates would add their round-off. */
void bbm_bonding_gap(const bbm_element *i, const bbm_vertex *P, const bbm_element *j,
                     const bbm_vertex *Q, double k, bbm_gap *g)
{
    double at[2];

    g->d0[0] = P->u - Q->u;
    g->d0[1] = P->v - Q->v;
    bbm_step_matrix(i, P->x, P->y, g->Ti, at);
    bbm_step_matrix(j, Q->x, Q->y, g->Tj, at);
    g->W[0][0] = g->W[1][1] = k;
    g->penalty = 1;
}

/* K += sign Ti^T W Tj. */
static void add_product(double sign, double Ti[2][6], double W[][2], double Tj[2][6],
                        double K[6][6])
{
    for (int b = 0; b < 6; b++) {
        const double x = sign * (W[0][0] * Tj[0][b] + W[0][1] * Tj[1][b]);
        const double y = sign * (W[1][0] * Tj[0][b] + W[1][1] * Tj[1][b]);
        for (int a = 0; a < 6; a++)
            K[a][b] += Ti[0][a] * x + Ti[1][a] * y;
    }
}

/* F += T^T f: what a force f at a point does to the unknowns. */
static void add_force(double T[2][6], const double f[2], double F[6])
{
    for (int a = 0; a < 6; a++)
        F[a] += T[0][a] * f[0] + T[1][a] * f[1];
}

/* A gap d = d0 + Ti Di - Tj Dj with the energy 1/2 d.W d + f.d
 *     ->   K_ii += Ti^T W Ti,  K_ij -= Ti^T W Tj,  K_jj += Tj^T W Tj,   Eq. (27),
 *          F_i -= Ti^T (W d0 + f),  F_j += Tj^T (W d0 + f),             Eq. (28).
 * A bonding spring has W = k I; there and at fixed points f is 0 in the paper. */
void bbm_bonding_submatrices(bbm_gap *g, bbm_submatrices *s)
{
    const double pull[2] = { g->W[0][0] * g->d0[0] + g->W[0][1] * g->d0[1] + g->f[0],
                             g->W[1][0] * g->d0[0] + g->W[1][1] * g->d0[1] + g->f[1] };
    const double push[2] = { -pull[0], -pull[1] };

    add_product(1, g->Ti, g->W, g->Ti, s->Kii);
    add_product(-1, g->Ti, g->W, g->Tj, s->Kij);
    add_product(1, g->Tj, g->W, g->Tj, s->Kjj);
    add_force(g->Ti, push, s->Fi);
    add_force(g->Tj, pull, s->Fj);
}

/* ---------------------------------------------- 3.4 Bonding submatrices at fixed points */

/* Stiffness [N/m] of the spring at a fixed point, Eq. (29): k = alpha G t, (4) with the wall like
 * the element. */
double bbm_fixed_stiffness(double alpha, const bbm_element *e)
{
    return alpha * shear_modulus(&e->material) * e->material.thickness;
}

/* A spring k between the vertex P and the wall point W, d = d0 + T(P) D, d0 = P - W, Eq. (30)-(36)
 *     ->   K_ii += k T^T T,  F_i -= k T^T d0,  Eq. (37): (27), (28) with T_j = 0.
 * A point held in one direction alone, as on a line of symmetry, has that row of T only. */
void bbm_fixed_gap(const bbm_element *e, const bbm_vertex *P, const bbm_node *W, double k,
                   bbm_gap *g)
{
    double at[2];

    g->node[0] = g->node[1] = P->node;
    g->d0[0] = P->u - W->wall[0];
    g->d0[1] = P->v - W->wall[1];
    bbm_step_matrix(e, P->x, P->y, g->Ti, at);
    memset(g->Tj, 0, sizeof g->Tj);
    g->W[0][0] = W->held & BBM_X ? k : 0;
    g->W[1][1] = W->held & BBM_Y ? k : 0;
    g->penalty = 1;
}

/* --------------------------------------------------------- 3.5 Line loading submatrices */

/* A concentrated load f [N] at the vertex P: F_i += T^T(P) f. */
void bbm_point_load(const bbm_element *e, const bbm_vertex *P, const double f[2], double F[6])
{
    double T[2][6], at[2];

    bbm_step_matrix(e, P->x, P->y, T, at);
    add_force(T, f, F);
}

/* Point and weight g of Gauss and Legendre on 0 <= s <= 1, for Eq. (38) and (42). */
void bbm_gauss_point(int g, double *s, double *weight)
{
    const double inner = 3.0 / 7 - 2.0 / 7 * sqrt(6.0 / 5);
    const double outer = 3.0 / 7 + 2.0 / 7 * sqrt(6.0 / 5);
    const double x[BBM_GAUSS] = { -sqrt(outer), -sqrt(inner), sqrt(inner), sqrt(outer) };

    *s = (1 + x[g]) / 2;
    *weight = (18 + (g == 0 || g == 3 ? -1 : 1) * sqrt(30)) / 72;
}

/* A load f(s) [N/m] that varies from a to b, x(s) = xa + (xb - xa) s, Eq. (38)-(41), given at the
 * Gauss points: F_i += int_0^1 T^T(x(s), y(s)) f(s) l ds, Eq. (42). */
void bbm_varying_load_submatrix(const bbm_element *e, const bbm_vertex *a, const bbm_vertex *b,
                                const double f[BBM_GAUSS][2], double F[6])
{
    const double l = hypot(b->x - a->x, b->y - a->y);

    for (int g = 0; g < BBM_GAUSS; g++) {
        double s, w, T[2][6], at[2];
        bbm_gauss_point(g, &s, &w);
        const double wlf[2] = { w * l * f[g][0], w * l * f[g][1] };
        bbm_step_matrix(e, a->x + (b->x - a->x) * s, a->y + (b->y - a->y) * s, T, at);
        add_force(T, wlf, F);
    }
}

/* A constant load f [N/m] from a to b: F_i += l T^T f
 *     = l (fx, fy, -Y fx + X fy, X fx, Y fy, (Y fx + X fy)/2),  Eq. (39), (43),
 * with T at (X, Y), the middle of the line seen from the barycentre. */
void bbm_constant_load_submatrix(const bbm_element *e, const bbm_vertex *a, const bbm_vertex *b,
                                 const double f[2], double F[6])
{
    const double l = hypot(b->x - a->x, b->y - a->y), lf[2] = { l * f[0], l * f[1] };
    double T[2][6], at[2];

    bbm_step_matrix(e, (a->x + b->x) / 2, (a->y + b->y) / 2, T, at);
    add_force(T, lf, F);
}

/* ------------------------------------------------------------ 3.6 Volume force submatrix */

/* A volume force f(x, y) [N/m^2] that varies: F_i += int T^T f dA, Eq. (44)-(46). Each edge and the
 * barycentre make a signed triangle of area c/2, integrated by the midpoints of its sides: exact
 * for f linear in x and y. */
void bbm_varying_volume_submatrix(const bbm_element *e, const bbm_vertex v[], bbm_field *f,
                                  const void *context, double F[6])
{
    for (int a = 0; a < e->n; a++) {
        const bbm_vertex *p = &v[a], *q = &v[(a + 1) % e->n];
        const double c = (p->x - e->x) * (q->y - e->y) - (q->x - e->x) * (p->y - e->y);
        const double x[3] = { (p->x + q->x) / 2, (p->x + e->x) / 2, (q->x + e->x) / 2 };
        const double y[3] = { (p->y + q->y) / 2, (p->y + e->y) / 2, (q->y + e->y) / 2 };
        for (int g = 0; g < 3; g++) {
            double T[2][6], here[2];
            f(x[g], y[g], context, here);
            const double wf[2] = { c / 6 * here[0], c / 6 * here[1] };
            bbm_mode_matrix(e, x[g], y[g], T);
            add_force(T, wf, F);
        }
    }
}

/* A constant volume force f [N/m^2]: F_i += A (fx, fy, 0, 0, 0, 0), Eq. (47). */
void bbm_volume_submatrix(const bbm_element *e, const double f[2], double F[6])
{
    F[0] += e->A * f[0];
    F[1] += e->A * f[1];
}

/* The weight of an element, Eq. (47) with f = M g, g the acceleration of gravity [m/s^2]. */
void bbm_gravity_submatrix(const bbm_element *e, const double g[2], double F[6])
{
    const double M = bbm_mass_per_area(e), f[2] = { M * g[0], M * g[1] };

    bbm_volume_submatrix(e, f, F);
}

/* ------------------------------------------------------------------- assembly, Eq. (5) */

int bbm_is_static(const bbm_model *m) { return isinf(m->h); }

/* Whether a hook takes T at the middle of the step, where no order is dropped. */
int bbm_is_exact(const bbm_model *m) { return m->hook.is_exact && m->hook.is_exact(m); }

/* The next gap of the list, between the elements i and j; it keeps its multiplier from the last
 * list. There is room for two of each bond and three of each vertex (allocate). */
bbm_gap *bbm_add_gap(bbm_model *m, int i, int j)
{
    bbm_gap *g = &m->gap[m->gaps++];
    *g = (bbm_gap){ .i = i, .j = j, .f = { g->f[0], g->f[1] },
                    .f_before = { g->f_before[0], g->f_before[1] } };
    return g;
}

/* Lists the springs of a bond, one at each vertex. */
void bbm_list_bond(bbm_model *m, const bbm_bond *b)
{
    const bbm_element *i = &m->element[b->i], *j = &m->element[b->j];

    for (int end = 0; end < 2; end++)
        bbm_bonding_gap(i, &m->vertex[b->p[end]], j, &m->vertex[b->q[end]],
                        bbm_bonding_stiffness(m->par.alpha, i, j), bbm_add_gap(m, b->i, b->j));
}

/* Lists the spring of a vertex that is held in the given directions, none: 0. */
void bbm_list_fixed_point(bbm_model *m, int v, int directions)
{
    const bbm_vertex *P = &m->vertex[v];
    const bbm_element *e = &m->element[P->element];
    bbm_node W = m->node[P->node];

    W.held = directions;
    if (directions)
        bbm_fixed_gap(e, P, &W, bbm_fixed_stiffness(m->par.alpha, e),
                      bbm_add_gap(m, P->element, -1));
}

/* Lists what glues, with T of the step: in the paper bonds and fixed points. */
void bbm_list_gaps(bbm_model *m)
{
    m->gaps = 0;
    if (m->hook.list_gaps) {
        m->hook.list_gaps(m);
        return;
    }
    for (int b = 0; b < m->bonds; b++)
        bbm_list_bond(m, &m->bond[b]);
    for (int v = 0; v < m->vertices; v++)
        bbm_list_fixed_point(m, v, m->node[m->vertex[v].node].held);
}

/* d = d0 + Ti Di - Tj Dj of the solution, Eq. (18), (30). */
void bbm_gap_length(const bbm_model *m, bbm_gap *g, double d[2])
{
    double ui[2], uj[2] = { 0, 0 };

    multiply_mode(g->Ti, &m->D[6 * g->i], ui);
    if (g->j >= 0)
        multiply_mode(g->Tj, &m->D[6 * g->j], uj);
    d[0] = g->d0[0] + ui[0] - uj[0];
    d[1] = g->d0[1] + ui[1] - uj[1];
}

/* The part of F that comes from outside: gravity, 3.5, 3.6. A load at a node is shared by the
 * elements that meet there. */
static void gather_loads(bbm_model *m)
{
    memset(m->load, 0, 6 * (size_t)m->elements * sizeof *m->load);
    for (int i = 0; i < m->elements; i++)
        bbm_gravity_submatrix(&m->element[i], m->acceleration, &m->load[6 * i]);
    for (int v = 0; v < m->vertices; v++) {
        const int i = m->vertex[v].element, n = m->vertex[v].node;
        const int adjacent = m->adjacent_first[n + 1] - m->adjacent_first[n];
        const double share[2] = { m->node[n].load[0] / adjacent, m->node[n].load[1] / adjacent };
        bbm_point_load(&m->element[i], &m->vertex[v], share, &m->load[6 * i]);
    }
    for (int l = 0; l < m->line_loads; l++) {
        const bbm_line_load *line = &m->line_load[l];
        const bbm_vertex *a = &m->vertex[line->a], *b = &m->vertex[line->b];
        const bbm_element *e = &m->element[a->element];
        if (line->constant)
            bbm_constant_load_submatrix(e, a, b, line->f[0], &m->load[6 * a->element]);
        else
            bbm_varying_load_submatrix(e, a, b, line->f, &m->load[6 * a->element]);
    }
    if (m->hook.load)
        m->hook.load(m);
}

/* Adds the submatrices of two elements, or of i and the wall (j < 0), to F, and to K unless it is
 * kept. */
void bbm_add_submatrices(bbm_model *m, int i, int j, bbm_submatrices *s)
{
    for (int a = 0; a < 6; a++) {
        m->F[6 * i + a] += s->Fi[a];
        if (j >= 0)
            m->F[6 * j + a] += s->Fj[a];
    }
    if (m->K_is_kept)
        return;
    bbm_matrix_add(m->K, i, i, s->Kii);
    if (j >= 0) {
        bbm_matrix_add(m->K, i, j, s->Kij);
        bbm_matrix_add(m->K, j, j, s->Kjj);
    }
}

static void assemble_element(bbm_model *m, int i)
{
    bbm_submatrix s = { { { 0 } }, { 0 } };

    bbm_elastic_submatrix(&m->element[i], &s);
    if (!bbm_is_static(m))
        bbm_inertia_submatrix(&m->element[i], m->h, &s);
    for (int a = 0; a < 6; a++)
        m->F[6 * i + a] += s.F[a];
    if (!m->K_is_kept)
        bbm_matrix_add(m->K, i, i, s.K);
}

static void assemble_gap(bbm_model *m, bbm_gap *g)
{
    bbm_submatrices s = { { { 0 } }, { { 0 } }, { { 0 } }, { 0 }, { 0 } };

    bbm_bonding_submatrices(g, &s);
    bbm_add_submatrices(m, g->i, g->j, &s);
}

/* Counts the CPU time since `since` for a phase. */
static void count_time(bbm_model *m, int phase, clock_t since)
{
    m->info.seconds[phase] += (double)(clock() - since) / CLOCKS_PER_SEC;
}

/* K, unless it is kept, and F of the present geometry, Eq. (5). */
void bbm_assemble(bbm_model *m)
{
    const clock_t start = clock();

    if (!m->K_is_kept) {
        gather_loads(m);
        bbm_matrix_clear(m->K);
    }
    memcpy(m->F, m->load, 6 * (size_t)m->elements * sizeof *m->F);
    for (int i = 0; i < m->elements; i++)
        assemble_element(m, i);
    for (int g = 0; g < m->gaps; g++)
        assemble_gap(m, &m->gap[g]);
    bbm_assemble_contacts(m);
    count_time(m, BBM_ASSEMBLE, start);
}

/* ------------------------------------------------------------- the parts of a time step */

/* Lays out K: a submatrix for each element, each gap between two of them and each contact, Eq. (5).
 * Without memory the old one stays. */
static bbm_status lay_out_matrix(bbm_model *m)
{
    int contacts = 0;
    const bbm_contact *c = m->scratch ? bbm_list_contacts(m, &contacts) : NULL;
    int (*pair)[2] = calloc((size_t)(contacts + m->gaps) + 1, sizeof *pair), n = 0;
    bbm_matrix *K;

    if (!pair)
        return BBM_NO_MEMORY;
    for (; n < contacts; n++) {
        pair[n][0] = m->edge[c[n].corner].element;
        pair[n][1] = m->edge[c[n].edge].element;
    }
    for (int g = 0; g < m->gaps; g++) {
        const int repeated = g > 0 && m->gap[g].i == m->gap[g - 1].i
                          && m->gap[g].j == m->gap[g - 1].j;
        if (m->gap[g].j < 0 || repeated)
            continue;
        pair[n][0] = m->gap[g].i;
        pair[n++][1] = m->gap[g].j;
    }
    if (m->K && n == m->pairs && memcmp(pair, m->pair, (size_t)n * sizeof *pair) == 0) {
        free(pair);
        return BBM_OK;
    }
    if (bbm_matrix_new(m->elements, n, pair, &K)) {
        free(pair);
        return BBM_NO_MEMORY;
    }
    bbm_matrix_free(m->K);
    free(m->pair);
    m->K = K;
    m->pair = pair;
    m->pairs = n;
    const bbm_status status = m->hook.lay_out ? m->hook.lay_out(m) : BBM_OK;
    m->pairs = status ? 0 : n;                      /* what fails is laid out anew the next time */
    return status;
}

/* Whether the step has had all the work that it may take. */
static int is_spent(const bbm_model *m)
{
    return m->info.passes >= SOLUTIONS || m->info.iterations / ITERATIONS >= m->par.pcg.iterations;
}

/* The contacts have not settled. */
static bbm_status unsettled(bbm_model *m)
{
    int contacts;

    (void)bbm_list_contacts(m, &contacts);
    return bbm_fail(m, BBM_OPEN_CLOSE, "step %d at t = %g, dt cut to %g, %d passes, %d contacts",
                    m->info.step + 1, m->info.t, m->h, m->info.passes, contacts);
}

/* What went wrong in a solution becomes a sentence with the numbers. */
static bbm_status describe_failure(bbm_model *m, bbm_status status)
{
    const bbm_pcg_info *i = &m->info.pcg;
    const int step = m->info.step + 1;

    if (status == BBM_NOT_FINITE)
        return bbm_fail(m, status, "step %d, a load, velocity, stress or stiffness is too large",
                        step);
    if (i->element >= 0)
        return bbm_fail(m, status, "step %d, element %d of block %d: it has turned over, or the "
                        "stiffnesses that meet there are too far apart", step, i->element,
                        m->element[i->element].block);
    return bbm_fail(m, status, "step %d, %d iterations, residual %.2g%s", step, i->iterations,
                    i->residual, status == BBM_NOT_CONVERGED
                                     ? "; more iterations or a smaller alpha help" : "");
}

/* Lists the contacts that may close in the step: first by what its velocities foretell, then again
 * if the solution moves further than that. `other`: they are other ones, the solution is void. */
bbm_status bbm_detect(bbm_model *m, int *other)
{
    const clock_t start = clock();
    int same = 1;
    bbm_status status = BBM_OK;

    *other = 0;
    if (m->detections > 0 && !bbm_moved_too_far(m))
        return BBM_OK;
    if (m->detections++ == DETECTIONS)
        return unsettled(m);
    status = bbm_detect_contacts(m, &same);
    count_time(m, BBM_DETECT, start);
    if (status || same)
        return status;
    *other = 1;
    if (m->hook.begin)
        m->hook.begin(m);
    bbm_list_gaps(m);
    status = lay_out_matrix(m);
    return status || !m->hook.check_listed ? status : m->hook.check_listed(m);
}

/* Solves K D = F, Eq. (5), section 4. */
static bbm_status solve(bbm_model *m)
{
    const bbm_pcg_info *i = &m->info.pcg;

    if (m->monitor && m->monitor(m, m->monitor_context))
        return bbm_fail(m, BBM_STOPPED, "step %d", m->info.step + 1);
    if (m->hook.before_solution)
        m->hook.before_solution(m);
    const bbm_status status = bbm_solve(m->K, m->F, m->D, &m->par.pcg, &m->info.pcg);
    m->info.iterations += i->iterations;
    m->info.seconds[BBM_PRECONDITION] += i->seconds[0];
    m->info.seconds[BBM_ITERATE] += i->seconds[1];
    return status ? describe_failure(m, status) : BBM_OK;
}

/* One pass of the open-close iteration, 3.8. `changed`: a state or F is new, so solve again. */
static bbm_status open_close(bbm_model *m, int *changed)
{
    const bbm_pass pass = bbm_open_close(m);

    m->K_is_kept = 0;
    *changed = pass == BBM_PASS_AGAIN && !is_spent(m);
    if (pass == BBM_PASS_DONE && m->hook.settled && m->hook.settled(m))
        *changed = m->K_is_kept = 1;
    return pass == BBM_PASS_DONE || *changed ? BBM_OK : unsettled(m);
}

/* Displacement of the point (x, y) by D: u = T D, or a hook's. */
void bbm_move(const bbm_model *m, const bbm_element *e, const double D[6], double x, double y,
              double u[2])
{
    if (m->hook.move)
        m->hook.move(m, D, x - e->x, y - e->y, u);
    else
        bbm_displacement(e, D, x, y, u);
}

/* Moves one element by its D: vertices by Eq. (1), stress by Eq. (7), (8), velocity by Eq. (14). */
static void update_element(const bbm_model *m, bbm_element *e, bbm_vertex vertex[])
{
    const bbm_element start = *e;
    double E[3][3], u[2];

    for (int k = 0; k < e->n; k++) {
        bbm_vertex *p = &vertex[k];
        bbm_move(m, e, e->D, p->x, p->y, u);
        p->u += u[0];
        p->v += u[1];
        p->x = m->node[p->node].x + p->u;
        p->y = m->node[p->node].y + p->v;
    }
    bbm_elastic_matrix(&e->material, E);
    for (int a = 0; a < 3; a++) {
        for (int b = 0; b < 3; b++)
            e->stress[a] += E[a][b] * e->D[3 + b];
        e->sum[a] += e->D[a];
    }
    if (bbm_is_static(m))
        memset(e->V, 0, sizeof e->V);
    else
        bbm_newmark_velocity(e, m->h, m->par.velocity_factor);
    if (bbm_is_exact(m))
        m->hook.turn(&start, e, vertex);
}

/* The model at the end of the step, each element moved by its place in D, Eq. (3): a second one
 * that shares all but what moves; the first stays as it is. How small the step was against all so
 * far, Eq. (71), goes to info.change. */
static bbm_model move_model(const bbm_model *m)
{
    bbm_model end = *m;
    double step2 = 0, sum2 = 0;

    end.element = m->end_element;
    end.vertex = m->end_vertex;
    memcpy(end.element, m->element, (size_t)m->elements * sizeof *m->element);
    memcpy(end.vertex, m->vertex, (size_t)m->vertices * sizeof *m->vertex);
    for (int i = 0; i < m->elements; i++) {
        bbm_element *e = &end.element[i];
        memcpy(e->D, &m->D[6 * i], sizeof e->D);
        update_element(m, e, &end.vertex[e->first]);
        step2 += e->D[0] * e->D[0] + e->D[1] * e->D[1];
        sum2 += e->sum[0] * e->sum[0] + e->sum[1] * e->sum[1];
    }
    end.info.change = sum2 > 0 ? sqrt(step2 / sum2) : 0;
    end.info.t += bbm_is_static(m) ? 0 : m->h;
    return end;
}

/* Makes the end of the step the present, unless a hook finds it wrong. */
static bbm_status update(bbm_model *m)
{
    const bbm_model end = move_model(m);
    const bbm_status status = m->hook.accept ? m->hook.accept(m, &end) : BBM_OK;

    if (status)
        return status;
    memcpy(m->element, end.element, (size_t)m->elements * sizeof *m->element);
    memcpy(m->vertex, end.vertex, (size_t)m->vertices * sizeof *m->vertex);
    m->info = end.info;
    return bbm_store_contacts(m);
}

void bbm_begin_step(bbm_model *m)
{
    m->detections = m->K_is_kept = 0;
    for (int i = 0; i < m->elements; i++)
        bbm_element_geometry(&m->element[i], &m->vertex[m->element[i].first]);
    memcpy(m->acceleration, m->par.gravity, sizeof m->acceleration);
    if (m->hook.accelerate)
        m->hook.accelerate(m);
    bbm_guess_step(m);
}

/* What must hold before a step: a prepared model, and parameters in their ranges; a comparison with
 * NaN is false. A hook may say which one is not. */
bbm_status bbm_check_step(bbm_model *m)
{
    const bbm_parameters *p = &m->par;

    if (!m->K)
        return m->status ? m->status
                         : bbm_fail(m, BBM_BAD_PARAMETER, "bbm_prepare comes before the steps");
    const bbm_status status = m->hook.check_step ? m->hook.check_step(m) : BBM_OK;
    if (status)
        return status;
    if (!(p->dt > 0 && p->alpha > 0 && p->p_n > 0 && p->p_s > 0 && p->friction >= 0
          && p->friction < 90 && p->velocity_factor >= 0 && p->velocity_factor <= 1
          && p->tolerance >= 0))
        return bbm_fail(m, BBM_BAD_PARAMETER, "expected dt, alpha, p_n, p_s above 0, tolerance 0 "
                        "or more, friction 0 to less than 90 degrees, velocity_factor 0 to 1");
    if ((p->cohesion != 0 || p->tension != 0) && !m->hook.joint_area)
        return bbm_fail(m, BBM_BAD_PARAMETER, "cohesion = %g, tension = %g, expected 0 where no "
                        "hook knows the area of a joint", p->cohesion, p->tension);
    return BBM_OK;
}

/* --------------------------------------------------------------- the time step, Fig. 8 */

/* Fig. 8 once, with the step m->h. Nothing moves before all has gone well. */
static bbm_status try_step(bbm_model *m)
{
    bbm_status status;
    int other, changed;

    bbm_begin_step(m);
    status = bbm_detect(m, &other);                 /* 3.7: which contacts may close            */
    do {
        do {
            if (!status)
                bbm_assemble(m);                    /* K, F: 3.1 to 3.8                         */
            if (!status)
                status = solve(m);                  /* K D = F: section 4                       */
            if (!status)
                status = open_close(m, &changed);   /* 3.8: do the contacts fit the solution?   */
        } while (!status && changed);
        if (!status)
            status = bbm_detect(m, &other);         /* has it moved too far for them?           */
    } while (!status && other);
    return status ? status : update(m);             /* positions, stresses, velocities          */
}

/* Whether the equations, or the states of the contacts, had no end. */
static int is_lost(bbm_status s)
{
    return s == BBM_NOT_POSITIVE_DEFINITE || s == BBM_NOT_CONVERGED || s == BBM_NOT_FINITE
        || s == BBM_OPEN_CLOSE;
}

/* One time step. If it fails, dt is halved and the step done again, down to dt/1024, as long as
 * that takes no more than some solutions; the nominal step is completed in parts, which grow again.
 * A static step has three trials. In the second one friction is a load in any case: K stays
 * symmetric. All contacts of a block may begin to slide in one pass, and nothing holds it then,
 * though not all would have to: the third lets one contact change in each pass, so that the others
 * can take over. A step that fails leaves the model as the last part left it. */
bbm_status bbm_step(bbm_model *m)
{
    int left = PARTS, part = PARTS;
    bbm_status status = bbm_check_step(m);

    m->info.passes = m->info.cuts = m->info.iterations = m->trial = 0;
    while (!status && left > 0) {
        m->h = isinf(m->par.dt) ? INFINITY : m->par.dt * part / PARTS;
        status = try_step(m);
        const int again = is_lost(status) || status == BBM_ENERGY || status == BBM_STEP_TOO_LONG;
        if (bbm_is_static(m) && is_lost(status) && m->trial < BBM_ONE_BY_ONE) {
            m->trial++;
            status = BBM_OK;
        } else if (bbm_is_static(m) || !again || part == 1 || is_spent(m)) {
            left -= part;
            if (left > 0 && (left / part) % 2 == 0 && part < PARTS)
                part *= 2;
        } else {
            part /= 2;
            m->info.cuts++;
            m->message[0] = '\0';
            status = BBM_OK;
        }
    }
    if (status && m->K && m->hook.explain)
        status = m->hook.explain(m, status);
    m->info.step += !status;
    return status == BBM_NO_MEMORY ? out_of_memory(m) : status;
}

/* All time steps. With a tolerance they end when the step has become small against the sum of all,
 * Eq. (71): sqrt(sum |step_i|^2) <= tolerance sqrt(sum |total_i|^2) over the barycentres i. */
bbm_status bbm_run(bbm_model *m)
{
    const int last = m->info.step + m->par.steps;

    do {
        const bbm_status status = bbm_step(m);
        if (status)
            return status;
        if (m->par.tolerance > 0 && m->info.change <= m->par.tolerance)
            return BBM_OK;
    } while (m->info.step < last);
    if (m->par.tolerance > 0)
        return bbm_fail(m, BBM_STEPS_EXHAUSTED, "change %.2g after step %d, expected %.2g",
                        m->info.change, m->info.step, m->par.tolerance);
    return BBM_OK;
}

/* ------------------------------------------------------------------ results, section 4 */

/* szz: none in plane stress. */
double bbm_stress_out_of_plane(const bbm_model *m, const bbm_element *e)
{
    return m->hook.out_of_plane ? m->hook.out_of_plane(e) : 0;
}

/* von Mises stress. */
double bbm_mises(const double s[3], double szz)
{
    return sqrt(s[0] * s[0] - s[0] * s[1] + s[1] * s[1] + 3 * s[2] * s[2]
                + szz * (szz - s[0] - s[1]));
}

/* Displacement and stress at a grid point: the mean over the elements of a block (-1: of all) that
 * meet there. */
bbm_status bbm_nodal_result(const bbm_model *m, int node, int block, bbm_result *r)
{
    int count = 0;

    *r = (bbm_result){ 0 };
    if (!m->K || node < 0 || node >= m->nodes)
        return BBM_BAD_INDEX;
    for (int a = m->adjacent_first[node]; a < m->adjacent_first[node + 1]; a++) {
        const bbm_vertex *v = &m->vertex[m->adjacent[a]];
        const bbm_element *e = &m->element[v->element];
        if (block >= 0 && e->block != block)
            continue;
        r->u += v->u;
        r->v += v->v;
        for (int k = 0; k < 3; k++)
            r->stress[k] += e->stress[k];
        r->szz += bbm_stress_out_of_plane(m, e);
        count++;
    }
    if (count == 0)
        return BBM_BAD_INDEX;
    r->u /= count;
    r->v /= count;
    for (int k = 0; k < 3; k++)
        r->stress[k] /= count;
    r->szz /= count;
    r->mises = bbm_mises(r->stress, r->szz);
    return BBM_OK;
}

/* ------------------------------------------------------------------- building a model */

#define BBM_TEXT_OF(name, text) [name] = text,

const char *bbm_status_text(bbm_status s)
{
    static const char *const text[BBM_STATUS_COUNT] = { BBM_STATUSES(BBM_TEXT_OF) };

    return s >= 0 && s < BBM_STATUS_COUNT ? text[s] : "unknown status";
}

const char *bbm_message(const bbm_model *m) { return m->message; }

/* Puts the sentence "TEXT OF THE STATUS: details" into the model and returns the status. */
bbm_status bbm_fail(bbm_model *m, bbm_status s, const char *format, ...)
{
    const int n = snprintf(m->message, sizeof m->message, "%s: ", bbm_status_text(s));
    va_list args;

    va_start(args, format);
    vsnprintf(m->message + n, sizeof m->message - (size_t)n, format, args);
    va_end(args);
    return s;
}

static bbm_status out_of_memory(bbm_model *m)
{
    return bbm_fail(m, BBM_NO_MEMORY, "%d elements, %d nodes", m->elements, m->nodes);
}

/* Makes room for one more entry in an array of `count`: its room is the next power of two. */
static int make_room(void **array, int count, size_t size)
{
    if (count != 0 && (count < 16 || (count & (count - 1)) != 0))
        return 1;
    void *room = realloc(*array, (count == 0 ? 16 : 2 * (size_t)count) * size);
    if (room)
        *array = room;
    return room != NULL;
}

/* A model with the defaults of statics in one step. */
bbm_status bbm_model_new(bbm_model **out)
{
    bbm_model *m = calloc(1, sizeof *m);

    *out = m;
    if (!m)
        return BBM_NO_MEMORY;
    m->par = (bbm_parameters){
        .dt = INFINITY, .steps = 1, .alpha = 100, .p_n = 1e9, .p_s = 4e8, .faces = 1,
        .pcg = { .omega = 1, .tolerance = 1e-10, .iterations = 100000 },
    };
    return BBM_OK;
}

/* What bbm_prepare made, the members from `bonds` up to `h`. */
static void free_prepared(bbm_model *m)
{
    free(m->bond);
    free(m->edge);
    free(m->adjacent_first);
    free(m->F);
    free(m->end_element);
    free(m->end_vertex);
    free(m->gap);
    free(m->pair);
    free(m->contact);
    bbm_matrix_free(m->K);
    bbm_contact_free(m->scratch);
    memset((char *)m + offsetof(bbm_model, bonds), 0,
           offsetof(bbm_model, h) - offsetof(bbm_model, bonds));
}

void bbm_model_free(bbm_model *m)
{
    if (!m)
        return;
    free_prepared(m);
    if (m->hook.release)
        m->hook.release(m);
    free(m->node);
    free(m->element);
    free(m->vertex);
    free(m->line_load);
    free(m->material);
    free(m);
}

/* Remembers the first error of building, and says what it is. */
#define REFUSE(m, ...) ((m)->status = bbm_fail(m, __VA_ARGS__))

bbm_status bbm_add_material(bbm_model *m, const bbm_material *a, int *index)
{
    const struct { const char *name; double value; } positive[3] = {
        { "E", a->E }, { "density", a->density }, { "thickness", a->thickness } };
    const int n = m->materials;

    if (m->status)
        return m->status;
    if (!isfinite(a->E) || !isfinite(a->nu) || !isfinite(a->density) || !isfinite(a->thickness))
        return REFUSE(m, BBM_NOT_FINITE, "material %d", n);
    for (int k = 0; k < 3; k++)
        if (positive[k].value <= 0)
            return REFUSE(m, BBM_BAD_MATERIAL, "material %d has %s = %g, expected more than 0", n,
                          positive[k].name, positive[k].value);
    if (a->nu <= -1 || a->nu >= 0.5)
        return REFUSE(m, BBM_BAD_MATERIAL, "material %d has nu = %g, expected -1 to 0.5", n, a->nu);
    if (!make_room((void **)&m->material, n, sizeof *a))
        return m->status = out_of_memory(m);
    m->material[m->materials++] = *a;
    if (index)
        *index = n;
    return BBM_OK;
}

bbm_status bbm_add_node(bbm_model *m, double x, double y, int *index)
{
    if (m->status)
        return m->status;
    if (!isfinite(x) || !isfinite(y))
        return REFUSE(m, BBM_NOT_FINITE, "node %d at (%g, %g)", m->nodes, x, y);
    if (!make_room((void **)&m->node, m->nodes, sizeof *m->node))
        return m->status = out_of_memory(m);
    m->node[m->nodes] = (bbm_node){ .x = x, .y = y };
    if (index)
        *index = m->nodes;
    m->nodes++;
    return BBM_OK;
}

static int is_node(const bbm_model *m, int node) { return node >= 0 && node < m->nodes; }

/* The signed area of a polygon, and whether it is that of a line: by its unsigned sum over the fan
 * of vertex 0 against the square of its longest reach. */
static double polygon_area(const bbm_model *m, int n, const int node[], int *flat)
{
    const bbm_node *o = &m->node[node[0]];
    double area = 0, fan = 0, reach2 = 0;

    for (int i = 1; i < n; i++) {
        const bbm_node *a = &m->node[node[i]], *b = &m->node[node[(i + 1) % n]];
        const double ax = a->x - o->x, ay = a->y - o->y;
        const double c = (ax * (b->y - o->y) - (b->x - o->x) * ay) / 2;
        area += c;
        fan += fabs(c);
        reach2 = fmax(reach2, ax * ax + ay * ay);
    }
    *flat = fan <= FLAT * reach2;
    return area;
}

/* Adds the polygon through the nodes, either way round, as an element of a block. */
bbm_status bbm_add_element(bbm_model *m, int block, int material, int n, const int node[],
                           int *index)
{
    const int e = m->elements, first = m->vertices;
    int flat;

    if (m->status)
        return m->status;
    if (material < 0 || material >= m->materials)
        return REFUSE(m, BBM_BAD_INDEX, "element %d has material %d of %d", e, material,
                      m->materials);
    if (n < 3)
        return REFUSE(m, BBM_BAD_ELEMENT, "element %d has %d vertices, expected 3 or more", e, n);
    for (int i = 0; i < n; i++)
        if (!is_node(m, node[i]))
            return REFUSE(m, BBM_BAD_INDEX, "element %d has node %d of %d", e, node[i], m->nodes);
    const double area = polygon_area(m, n, node, &flat);
    if (flat)
        return REFUSE(m, BBM_BAD_ELEMENT, "element %d has no area, %g m^2", e, area);
    if (m->hook.check_polygon && m->hook.check_polygon(m, n, node))
        return m->status = BBM_SELF_CROSSING;
    if (!make_room((void **)&m->element, e, sizeof *m->element))
        return m->status = out_of_memory(m);
    for (int i = 0; i < n; i++) {
        const int at = node[area > 0 ? i : n - 1 - i];
        if (!make_room((void **)&m->vertex, m->vertices, sizeof *m->vertex))
            return m->status = out_of_memory(m);
        m->vertex[m->vertices++] = (bbm_vertex){ .node = at, .element = e, .x = m->node[at].x,
                                                 .y = m->node[at].y };
    }
    m->element[e] = (bbm_element){ .block = block, .material = m->material[material],
                                   .first = first, .n = n };
    bbm_element_geometry(&m->element[e], &m->vertex[first]);
    m->element[e].A0 = m->element[e].A;
    m->elements++;
    if (index)
        *index = e;
    return BBM_OK;
}

/* Holds a node in the given directions to a wall point displaced by (u, v). */
bbm_status bbm_fix_node(bbm_model *m, int node, int directions, double u, double v)
{
    if (m->status)
        return m->status;
    if (!is_node(m, node))
        return REFUSE(m, BBM_BAD_INDEX, "fixed node %d of %d", node, m->nodes);
    if (directions < BBM_X || directions > BBM_XY)
        return REFUSE(m, BBM_BAD_PARAMETER, "directions %d of fixed node %d", directions, node);
    if (!isfinite(u) || !isfinite(v))
        return REFUSE(m, BBM_NOT_FINITE, "the wall point of fixed node %d", node);
    m->node[node].held |= directions;
    if (directions & BBM_X)
        m->node[node].wall[0] = u;
    if (directions & BBM_Y)
        m->node[node].wall[1] = v;
    return BBM_OK;
}

bbm_status bbm_add_load(bbm_model *m, int node, double fx, double fy)
{
    if (m->status)
        return m->status;
    if (!is_node(m, node))
        return REFUSE(m, BBM_BAD_INDEX, "loaded node %d of %d", node, m->nodes);
    if (!isfinite(fx) || !isfinite(fy))
        return REFUSE(m, BBM_NOT_FINITE, "the load of node %d", node);
    m->node[node].load[0] += fx;
    m->node[node].load[1] += fy;
    return BBM_OK;
}

/* Adds a line load with everything but its vertices, which bbm_prepare finds. */
static bbm_status add_line_load(bbm_model *m, const bbm_line_load *load)
{
    for (int g = 0; g < BBM_GAUSS; g++)
        if (!isfinite(load->f[g][0]) || !isfinite(load->f[g][1]))
            return REFUSE(m, BBM_NOT_FINITE, "the line load on nodes %d, %d", load->node[0],
                          load->node[1]);
    if (!make_room((void **)&m->line_load, m->line_loads, sizeof *load))
        return m->status = out_of_memory(m);
    m->line_load[m->line_loads++] = *load;
    return BBM_OK;
}

static bbm_status check_line(bbm_model *m, int node1, int node2)
{
    if (!m->status && (!is_node(m, node1) || !is_node(m, node2)))
        return REFUSE(m, BBM_BAD_INDEX, "line load on nodes %d, %d of %d", node1, node2, m->nodes);
    return m->status;
}

bbm_status bbm_add_line_load(bbm_model *m, int node1, int node2, double fx, double fy)
{
    bbm_line_load load = { .node = { node1, node2 }, .constant = 1, .f = { { fx, fy } } };

    return check_line(m, node1, node2) ? m->status : add_line_load(m, &load);
}

/* The load f(x, y) [N/m] on the edge between two nodes, taken at the Gauss points of the starting
 * geometry. */
bbm_status bbm_add_varying_line_load(bbm_model *m, int node1, int node2, bbm_field *f,
                                     const void *context)
{
    bbm_line_load load = { .node = { node1, node2 } };

    if (check_line(m, node1, node2))
        return m->status;
    const bbm_node *a = &m->node[node1], *b = &m->node[node2];
    for (int g = 0; g < BBM_GAUSS; g++) {
        double s, weight;
        bbm_gauss_point(g, &s, &weight);
        f(a->x + (b->x - a->x) * s, a->y + (b->y - a->y) * s, context, load.f[g]);
    }
    return add_line_load(m, &load);
}

/* ------------------------------------------------------ preparing: 2.2, the edges, and K */

int bbm_next_vertex(const bbm_element *e, int v)
{
    return v + 1 < e->first + e->n ? v + 1 : e->first;
}

/* Lists the vertices at each node: adjacent[adjacent_first[n]] and on are those of node n. */
static bbm_status list_adjacent_vertices(bbm_model *m)
{
    int *first = calloc((size_t)m->nodes + 1 + (size_t)m->vertices, sizeof *first);

    if (!first)
        return BBM_NO_MEMORY;
    m->adjacent_first = first;
    m->adjacent = first + m->nodes + 1;
    for (int v = 0; v < m->vertices; v++)
        first[m->vertex[v].node]++;
    for (int n = 0, sum = 0; n <= m->nodes; n++) {
        if (n < m->nodes && first[n] == 0)
            return bbm_fail(m, BBM_UNUSED_NODE, "node %d at (%g, %g)", n, m->node[n].x,
                            m->node[n].y);
        sum += first[n];
        first[n] = sum;
    }
    for (int v = m->vertices - 1; v >= 0; v--)
        m->adjacent[--first[m->vertex[v].node]] = v;
    return BBM_OK;
}

/* Finds the sides from node p to node q of a block, all but v: the number of them, and the vertex
 * where the first one starts. */
static int find_sides(const bbm_model *m, int block, int p, int q, int v, int *start)
{
    int sides = 0;

    for (int a = m->adjacent_first[p]; a < m->adjacent_first[p + 1]; a++) {
        const int w = m->adjacent[a];
        const bbm_element *e = &m->element[m->vertex[w].element];
        if (w == v || e->block != block || m->vertex[bbm_next_vertex(e, w)].node != q)
            continue;
        *start = sides++ == 0 ? w : *start;
    }
    return sides;
}

/* Section 2.2: a side that two elements of a block share is an internal edge and gets a bond, one
 * that has no partner is a boundary edge. Elements run counter-clockwise, so partners run opposite
 * ways; who runs the same way lies on the same side. */
static bbm_status connect_elements(bbm_model *m)
{
    m->edge = calloc((size_t)m->vertices, sizeof *m->edge);
    m->bond = calloc((size_t)m->vertices / 2, sizeof *m->bond);
    if (!m->edge || !m->bond)
        return BBM_NO_MEMORY;
    for (int v = 0; v < m->vertices; v++) {
        const int i = m->vertex[v].element, next = bbm_next_vertex(&m->element[i], v);
        const int p = m->vertex[v].node, q = m->vertex[next].node, block = m->element[i].block;
        int w = -1;
        const int same = find_sides(m, block, p, q, v, &w);
        const int partners = same ? 0 : find_sides(m, block, q, p, -1, &w);
        if (same || partners > 1) {
            m->blamed[0] = i > m->vertex[w].element ? i : m->vertex[w].element;
            m->blamed[1] = i + m->vertex[w].element - m->blamed[0];
            return bbm_fail(m, BBM_OVERLAP, "elements %d and %d on the same side of nodes %d, %d",
                            m->blamed[1], m->blamed[0], p, q);
        }
        const int across = partners == 0 ? 0
                         : bbm_next_vertex(&m->element[m->vertex[w].element], w);
        m->vertex[v].edge = partners == 0 ? m->edges : -1 - across;
        if (partners == 0)
            m->edge[m->edges++] = (bbm_edge){ .element = i, .a = v, .b = next,
                                              .block = block };
        else if (v < w)
            m->bond[m->bonds++] = (bbm_bond){ i, m->vertex[w].element, { v, next },
                                              { across, w } };
    }
    return BBM_OK;
}

/* Finds the vertices of each line load: those of the first boundary edge between its nodes. */
static bbm_status place_line_loads(bbm_model *m)
{
    for (int l = 0; l < m->line_loads; l++) {
        bbm_line_load *load = &m->line_load[l];
        int found = 0;
        for (int e = 0; e < m->edges && !found; e++) {
            const int a = m->edge[e].a, b = m->edge[e].b;
            const int back = m->vertex[b].node == load->node[0];
            load->a = back ? b : a;
            load->b = back ? a : b;
            found = m->vertex[load->a].node == load->node[0]
                 && m->vertex[load->b].node == load->node[1];
        }
        if (!found)
            return bbm_fail(m, BBM_NOT_BOUNDARY, "nodes %d and %d", load->node[0], load->node[1]);
    }
    return BBM_OK;
}

/* The arrays that the steps need. A bond has two gaps; a vertex that is held has one, and may have
 * two of the edge from it on. */
static bbm_status allocate(bbm_model *m)
{
    m->F = calloc(18 * (size_t)m->elements, sizeof *m->F);
    m->end_element = calloc((size_t)m->elements, sizeof *m->element);
    m->end_vertex = calloc((size_t)m->vertices, sizeof *m->vertex);
    m->gap = calloc(2 * (size_t)m->bonds + 3 * (size_t)m->vertices, sizeof *m->gap);
    if (!m->F || !m->end_element || !m->end_vertex || !m->gap)
        return BBM_NO_MEMORY;
    m->D = m->F + 6 * (size_t)m->elements;
    m->load = m->D + 6 * (size_t)m->elements;
    bbm_list_gaps(m);
    return lay_out_matrix(m) || bbm_contact_new(m) ? BBM_NO_MEMORY : BBM_OK;
}

/* Checks the model and makes all that the steps need. */
bbm_status bbm_prepare(bbm_model *m)
{
    bbm_status (*const part[])(bbm_model *) = { list_adjacent_vertices, connect_elements,
                                                place_line_loads, allocate, m->hook.check };
    bbm_status status = m->status;

    if (status)
        return status;
    free_prepared(m);
    if (m->elements == 0)
        return bbm_fail(m, BBM_NO_ELEMENT, "%d nodes", m->nodes);
    for (size_t k = 0; k < sizeof part / sizeof *part && !status; k++)
        status = part[k] ? part[k](m) : BBM_OK;
    return status == BBM_NO_MEMORY ? out_of_memory(m) : status;
}
