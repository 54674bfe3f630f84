/* bbm.c - the bonding block model: sections 2 and 3.1 to 3.6 of the paper in their order, then
 * assembly (5), the time step (Fig. 8) and results. Sections 3.7 and 3.8, contacts, are in
 * contact.c. Section 4, the solution of K D = F, is in solver.c. base/build.c builds a model.
 *
 * Sun, Chen, Feng, Wang 2015, doi:10.1155/2015/723263. Read it with the paper open: each formula is
 * a function of its own, with the number of its equation above it.
 *
 *     2.1  displacement of an element  (1)-(3)     3.3  bonding            (18)-(28)
 *     2.2  element connections         (4)         3.4  fixed points       (29)-(37)
 *     3.1  elastic submatrices         (6)-(10)    3.5  loads along a line (38)-(43)
 *     3.2  inertia submatrices         (11)-(17)   3.6  volume force       (44)-(47)
 *
 * Every submatrix comes from one recipe. A potential energy Pi(D) is at most quadratic in the
 * unknowns. Its second derivative is added to K of K D = F, Eq. (5), and minus its first derivative
 * at D = 0 is added to F. A spring k over a gap d = d0 + T D has the energy k/2 d.d, so that
 * K += k T^T T and F -= k T^T d0. Bonding springs, fixed points and contacts differ in d alone.
 *
 * Statics is without inertia, Eq. (16), (17): each step is one iteration of Newton-Raphson on the
 * geometry that the last step left.
 *
 * What the paper does not have is called through m->hook. A reader of the paper may pass over it:
 * each hook is NULL then, and so are `middle` and bbm_motion_of.
 */
#include <string.h>

#include "base/base.h"

/* --------------------------------------------------------- 2.1 Displacement of an element */

/* Area, barycentre and second moments of a polygon by simplex integration, for Eq. (12): the sum
 * over its edges of the signed triangles (origin, a, b) with twice the area c = xa yb - xb ya,
 *     A = sum c/2,   int x dA = sum c/6 (xa + xb),   int x^2 dA = sum c/12 (xa^2 + xa xb + xb^2),
 *     int x y dA = sum c/24 (xa yb + 2 xa ya + 2 xb yb + xb ya).
 * The signs make it right for polygons that are not convex, too. The origin is vertex 0 for the
 * barycentre, and the barycentre for the second moments: far from (0, 0) nothing cancels then. */
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

/* Displacement u = T D of the point that lies at (x, y) before the step, Eq. (1). */
void bbm_displacement(const bbm_element *e, const double D[6], double x, double y, double u[2])
{
    double T[2][6];

    bbm_mode_matrix(e, x, y, T);
    for (int r = 0; r < 2; r++) {
        u[r] = 0;
        for (int a = 0; a < 6; a++)
            u[r] += T[r][a] * D[a];
    }
}

/* ------------------------------------------------------------- 2.2 Element connections */

static double shear_modulus(const bbm_material *m) { return m->E / (2 * (1 + m->nu)); }

/* Stiffness [N/m] of the bonding springs between two elements, Eq. (4),
 *     k = alpha G t max(A)/min(A),
 * with G and t the means of the two. The areas are those at the start: k stays constant. The
 * paper's text names alpha, G and the areas. That they enter as this ratio is our choice: k then
 * has the dimension of G t, is symmetric, and is alpha G t on a uniform mesh. */
double bbm_bonding_stiffness(double alpha, const bbm_element *i, const bbm_element *j)
{
    const double G = (shear_modulus(&i->material) + shear_modulus(&j->material)) / 2;
    const double t = (i->material.thickness + j->material.thickness) / 2;

    return alpha * G * t * fmax(i->A0, j->A0) / fmin(i->A0, j->A0);
}

/* -------------------------------------------------------------- 3.1 Elastic submatrices */

/* Hooke's law in plane stress, Eq. (7): stress = E e + stress0. The strain e = (ex, ey, gxy) is the
 * last three of D, Eq. (8). */
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
 *     ->   K_ii += t A E, F_i -= t A stress0, Eq. (10).
 * Deviation: with bbm_motion the A of K_ii is the starting area. The forces of Hooke's law have a
 * potential then: a body that is strained and comes back makes no energy. */
void bbm_elastic_submatrix(const bbm_element *e, bbm_submatrix *s)
{
    const double t = e->material.thickness, tA = t * (e->middle ? e->A0 : e->A);
    double E[3][3];

    bbm_elastic_matrix(&e->material, E);
    for (int a = 0; a < 3; a++) {
        for (int b = 0; b < 3; b++)
            s->K[3 + a][3 + b] += tA * E[a][b];
        s->F[3 + a] -= t * e->A * e->stress[a];
    }
}

/* -------------------------------------------------------------- 3.2 Inertia submatrices */

/* Mass per present area, M of Eq. (11). The mass of an element is density x thickness x starting
 * area at all times, so that its momentum does not change by its strain. */
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
 * The inertia force M u'' counts as a given load: Eq. (15) is differentiated by the D of u alone,
 * not by the D of u''. */
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

/* Velocity for the next step: V = 2/dt D - V, Eq. (14), times the velocity factor. */
void bbm_newmark_velocity(bbm_element *e, double dt, double factor)
{
    for (int a = 0; a < 6; a++)
        e->V[a] = factor * (2 / dt * e->D[a] - e->V[a]);
}

/* -------------------------------------------------------------- 3.3 Bonding submatrices */

/* T in gaps, loads and contacts, and where the point is: that of Eq. (2), and (x, y); or a hook's,
 * taken at another moment of the step. */
void bbm_step_point(const bbm_element *e, double x, double y, double T[2][6], double at[2])
{
    if (e->middle) {
        e->middle->motion->point(e, x, y, T, at);
        return;
    }
    bbm_mode_matrix(e, x, y, T);
    at[0] = x;
    at[1] = y;
}

/* T alone. */
void bbm_step_matrix(const bbm_element *e, double x, double y, double T[2][6])
{
    double at[2];

    bbm_step_point(e, x, y, T, at);
}

/* A spring k between the vertices P of element i and Q of element j, which were one point at the
 * start of the run. Its elongation at the end of the step is |d|,
 *     d = d0 + Ti(P) Di - Tj(Q) Dj,  d0 = P - Q,  Eq. (18)-(23);   Pi_b = k/2 d.d,  Eq. (24)-(26).
 * d0 is computed from displacements: the difference of coordinates has more round-off. */
void bbm_bonding_gap(const bbm_element *i, const bbm_vertex *P, const bbm_element *j,
                     const bbm_vertex *Q, double k, bbm_gap *g)
{
    g->d0[0] = P->u - Q->u;
    g->d0[1] = P->v - Q->v;
    bbm_step_matrix(i, P->x, P->y, g->Ti);
    bbm_step_matrix(j, Q->x, Q->y, g->Tj);
    g->W[0][0] = g->W[1][1] = k;
}

/* Pi_b = k/2 d.d, or 1/2 d.W d with W = k [1 0; 0 1]
 *     ->   K_ii += Ti^T W Ti,  K_ij -= Ti^T W Tj,  K_jj += Tj^T W Tj,   Eq. (27),
 *          F_i -= Ti^T W d0,  F_j += Tj^T W d0,                         Eq. (28).
 * With a hook W is any symmetric matrix, and the energy has f.d besides: W d0 + f for W d0. */
void bbm_bonding_submatrices(const bbm_gap *g, bbm_submatrices *s)
{
    for (int r = 0; r < 2; r++) {
        const double *W = g->W[r], pull = W[0] * g->d0[0] + W[1] * g->d0[1] + g->own.f[r];
        for (int b = 0; b < 6; b++) {
            const double WTi = W[0] * g->Ti[0][b] + W[1] * g->Ti[1][b];
            const double WTj = W[0] * g->Tj[0][b] + W[1] * g->Tj[1][b];
            for (int a = 0; a < 6; a++) {
                s->Kii[a][b] += g->Ti[r][a] * WTi;
                s->Kij[a][b] -= g->Ti[r][a] * WTj;
                s->Kjj[a][b] += g->Tj[r][a] * WTj;
            }
            s->Fi[b] -= g->Ti[r][b] * pull;
            s->Fj[b] += g->Tj[r][b] * pull;
        }
    }
}

/* ---------------------------------------------- 3.4 Bonding submatrices at fixed points */

/* Stiffness [N/m] of the spring at a fixed point, Eq. (29): k = alpha G t. That is (4) with a wall
 * element of the same material and area, which is our choice. */
double bbm_fixed_stiffness(double alpha, const bbm_element *e)
{
    return alpha * shear_modulus(&e->material) * e->material.thickness;
}

/* A spring k between the vertex P and the wall point W, d = d0 + T(P) D, d0 = P - W, Eq. (30)-(36)
 *     ->   K_ii += k T^T T,  F_i -= k T^T d0,  Eq. (37): (27), (28) with T_j = 0.
 * A point held in one direction alone, as on a line of symmetry, has k = 0 in the other. */
void bbm_fixed_gap(const bbm_element *e, const bbm_vertex *P, const bbm_node *W, double k,
                   bbm_gap *g)
{
    g->node[0] = g->node[1] = P->node;
    g->d0[0] = P->u - W->wall[0];
    g->d0[1] = P->v - W->wall[1];
    bbm_step_matrix(e, P->x, P->y, g->Ti);
    memset(g->Tj, 0, sizeof g->Tj);
    g->W[0][0] = W->held & BBM_X ? k : 0;
    g->W[1][1] = W->held & BBM_Y ? k : 0;
}

/* --------------------------------------------------------- 3.5 Line loading submatrices */

/* A concentrated load f [N] at the point (x, y): F_i += T^T(x, y) f. */
void bbm_point_load(const bbm_element *e, double x, double y, const double f[2], double F[6])
{
    double T[2][6];

    bbm_step_matrix(e, x, y, T);
    for (int a = 0; a < 6; a++)
        F[a] += T[0][a] * f[0] + T[1][a] * f[1];
}

/* Gauss point g and its weight on 0 <= s <= 1, for Eq. (38) and (42). */
void bbm_gauss_point(int g, double *s, double *weight)
{
    const double inner = 3.0 / 7 - 2.0 / 7 * sqrt(6.0 / 5);
    const double outer = 3.0 / 7 + 2.0 / 7 * sqrt(6.0 / 5);
    const double x[BBM_GAUSS] = { -sqrt(outer), -sqrt(inner), sqrt(inner), sqrt(outer) };

    *s = (1 + x[g]) / 2;
    *weight = (18 + (g == 0 || g == 3 ? -1 : 1) * sqrt(30)) / 72;
}

/* A load f(s) [N/m] that varies along x(s) = xa + (xb - xa) s, y(s) likewise, Eq. (38)-(41):
 * F_i += int_0^1 T^T(x(s), y(s)) f(s) l ds, Eq. (42). `f` has its values at the Gauss points. */
void bbm_varying_load_submatrix(const bbm_element *e, const bbm_vertex *a, const bbm_vertex *b,
                                const double f[BBM_GAUSS][2], double F[6])
{
    const double l = hypot(b->x - a->x, b->y - a->y);

    for (int g = 0; g < BBM_GAUSS; g++) {
        double s, w;
        bbm_gauss_point(g, &s, &w);
        const double wlf[2] = { w * l * f[g][0], w * l * f[g][1] };
        bbm_point_load(e, a->x + (b->x - a->x) * s, a->y + (b->y - a->y) * s, wlf, F);
    }
}

/* A constant load f [N/m] from a to b: F_i += l T^T f
 *     = l (fx, fy, -Y fx + X fy, X fx, Y fy, (Y fx + X fy)/2),  Eq. (39), (43),
 * with T and (X, Y) at the middle of the line; X and Y count from the barycentre. */
void bbm_constant_load_submatrix(const bbm_element *e, const bbm_vertex *a, const bbm_vertex *b,
                                 const double f[2], double F[6])
{
    const double l = hypot(b->x - a->x, b->y - a->y), lf[2] = { l * f[0], l * f[1] };

    bbm_point_load(e, (a->x + b->x) / 2, (a->y + b->y) / 2, lf, F);
}

/* ------------------------------------------------------------ 3.6 Volume force submatrix */

/* A volume force f(x, y) [N/m^2] that varies: F_i += int T^T f dA, Eq. (44)-(46). Each edge and the
 * barycentre make a signed triangle of area c/2. The midpoints of its sides integrate it exactly if
 * f is linear in x and y. */
void bbm_varying_volume_submatrix(const bbm_element *e, const bbm_vertex v[], bbm_field *f,
                                  const void *context, double F[6])
{
    for (int a = 0; a < e->n; a++) {
        const bbm_vertex *p = &v[a], *q = &v[(a + 1) % e->n];
        const double c = (p->x - e->x) * (q->y - e->y) - (q->x - e->x) * (p->y - e->y);
        const double x[3] = { (p->x + q->x) / 2, (p->x + e->x) / 2, (q->x + e->x) / 2 };
        const double y[3] = { (p->y + q->y) / 2, (p->y + e->y) / 2, (q->y + e->y) / 2 };
        for (int g = 0; g < 3; g++) {
            double here[2];
            f(x[g], y[g], context, here);
            const double wf[2] = { c / 6 * here[0], c / 6 * here[1] };
            bbm_point_load(e, x[g], y[g], wf, F);
        }
    }
}

/* A constant volume force f [N/m^2]: F_i += A (fx, fy, 0, 0, 0, 0), Eq. (47). */
void bbm_volume_submatrix(const bbm_element *e, const double f[2], double F[6])
{
    F[0] += e->A * f[0];
    F[1] += e->A * f[1];
}

/* The weight of an element: Eq. (47) with f = M g, g the acceleration of gravity [m/s^2]. */
void bbm_gravity_submatrix(const bbm_element *e, const double g[2], double F[6])
{
    const double M = bbm_mass_per_area(e), f[2] = { M * g[0], M * g[1] };

    bbm_volume_submatrix(e, f, F);
}

/* ------------------------------------------------------------------- assembly, Eq. (5) */

/* The next gap of the list, between the elements i and j. A hook's `own` stays from list to list.
 * bbm_prepare has made room for two gaps at each bond and three at each vertex. */
bbm_gap *bbm_add_gap(bbm_model *m, int i, int j)
{
    bbm_gap *g = &m->gap[m->gaps++];
    *g = (bbm_gap){ .i = i, .j = j, .own = g->own };
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

/* Lists the spring of a vertex at a fixed point. */
void bbm_list_fixed_point(bbm_model *m, int v, const bbm_node *W)
{
    const bbm_vertex *P = &m->vertex[v];
    const bbm_element *e = &m->element[P->element];

    if (W->held)
        bbm_fixed_gap(e, P, W, bbm_fixed_stiffness(m->par.alpha, e),
                      bbm_add_gap(m, P->element, -1));
}

/* Lists the gaps of bonds and fixed points, or those of a hook. */
void bbm_list_gaps(bbm_model *m)
{
    m->gaps = 0;
    if (m->hook->list_gaps) {
        m->hook->list_gaps(m);
        return;
    }
    for (int b = 0; b < m->bonds; b++)
        bbm_list_bond(m, &m->bond[b]);
    for (int v = 0; v < m->vertices; v++)
        bbm_list_fixed_point(m, v, &m->node[m->vertex[v].node]);
}

/* The part of F that comes from outside: gravity (3.6), loads at nodes and along lines (3.5). The
 * elements that meet at a node share its load equally. */
static void gather_loads(bbm_model *m)
{
    memset(m->load, 0, 6 * (size_t)m->elements * sizeof *m->load);
    for (int i = 0; i < m->elements; i++)
        bbm_gravity_submatrix(&m->element[i], m->acceleration, &m->load[6 * i]);
    for (int v = 0; v < m->vertices; v++) {
        const int i = m->vertex[v].element, n = m->vertex[v].node;
        const int adjacent = m->adjacent_first[n + 1] - m->adjacent_first[n];
        const double share[2] = { m->node[n].load[0] / adjacent, m->node[n].load[1] / adjacent };
        bbm_point_load(&m->element[i], m->vertex[v].x, m->vertex[v].y, share, &m->load[6 * i]);
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
    if (m->hook->load)
        m->hook->load(m);
}

/* Adds the submatrices of two elements, or of i and the wall (j < 0), to K and F. */
void bbm_add_submatrices(bbm_model *m, int i, int j, bbm_submatrices *s)
{
    bbm_matrix_add(m->K, i, i, s->Kii);
    for (int a = 0; a < 6; a++)
        m->F[6 * i + a] += s->Fi[a];
    if (j < 0)
        return;
    bbm_matrix_add(m->K, i, j, s->Kij);
    bbm_matrix_add(m->K, j, j, s->Kjj);
    for (int a = 0; a < 6; a++)
        m->F[6 * j + a] += s->Fj[a];
}

static void assemble_element(bbm_model *m, int i)
{
    bbm_submatrix s = { { { 0 } }, { 0 } };

    bbm_elastic_submatrix(&m->element[i], &s);
    if (!bbm_is_static(m))
        bbm_inertia_submatrix(&m->element[i], m->h, &s);
    bbm_matrix_add(m->K, i, i, s.K);
    for (int a = 0; a < 6; a++)
        m->F[6 * i + a] += s.F[a];
}

static void assemble_gap(bbm_model *m, const bbm_gap *g)
{
    bbm_submatrices s = { .Fi = { 0 } };

    bbm_bonding_submatrices(g, &s);
    bbm_add_submatrices(m, g->i, g->j, &s);
}

/* K and F, Eq. (5), for the positions at the start of the step and the present contact states. */
void bbm_assemble(bbm_model *m)
{
    const clock_t start = clock();
    int g = 0;

    gather_loads(m);
    bbm_matrix_clear(m->K);
    memcpy(m->F, m->load, 6 * (size_t)m->elements * sizeof *m->F);
    for (int i = 0; i < m->elements; i++)
        assemble_element(m, i);
    for (; g < m->gaps && m->gap[g].j >= 0; g++)    /* bonds: their rounding is in the forces */
        assemble_gap(m, &m->gap[g]);
    bbm_matrix_measure(m->K, m->F);
    for (; g < m->gaps; g++)                        /* fixed points */
        assemble_gap(m, &m->gap[g]);
    bbm_assemble_contacts(m);
    bbm_count_time(m, BBM_ASSEMBLE, start);
}

/* ------------------------------------------------------------- the parts of a time step */

/* Geometry of the elements, and a first guess at D for the detection: by velocity and gravity, or
 * in statics the D of the last step. */
bbm_status bbm_begin_step(bbm_model *m)
{
    m->detections = 0;
    for (int i = 0; i < m->elements; i++)
        bbm_element_geometry(&m->element[i], &m->vertex[m->element[i].first]);
    memcpy(m->acceleration, m->par.gravity, sizeof m->acceleration);
    const bbm_status status = m->hook->begin ? m->hook->begin(m) : BBM_OK;
    bbm_foresee_step(m);
    return status;
}

/* Lists the contacts that may close in the step, and lays out K for them: at first for the guess at
 * D, later for a solution that moves further than the list allows. `same`: the list has not
 * changed, so the solution counts. */
bbm_status bbm_detect(bbm_model *m, int *same)
{
    const clock_t start = clock();

    *same = 1;
    if (m->detections > 0 && !bbm_moved_too_far(m))
        return BBM_OK;
    if (m->detections++ == BBM_MAX_DETECTIONS)
        return bbm_say_what_failed(m, BBM_OPEN_CLOSE);
    bbm_status status = bbm_detect_contacts(m, same);
    bbm_count_time(m, BBM_DETECT, start);
    if (status || *same)
        return status;
    bbm_list_gaps(m);
    status = bbm_lay_out_matrix(m);
    return status || !m->hook->listed ? status : m->hook->listed(m);
}

/* Solves K D = F, Eq. (5), section 4. */
static bbm_status solve(bbm_model *m)
{
    if (m->hook->before_solution)
        m->hook->before_solution(m);
    if (m->monitor && m->monitor(m, m->monitor_context))
        return bbm_fail(m, BBM_STOPPED, "step %d", m->info.step + 1);
    return bbm_note_solution(m, bbm_solve(m->K, m->F, m->D, &m->par.pcg, &m->info.pcg));
}

/* One pass of the open-close iteration. A step that has taken too much work ends as one that does
 * not settle. */
static bbm_status open_close(bbm_model *m, bbm_pass *pass)
{
    *pass = bbm_open_close(m);
    return *pass == BBM_PASS_GIVE_UP || (*pass == BBM_PASS_AGAIN && bbm_is_spent(m))
         ? bbm_say_what_failed(m, BBM_OPEN_CLOSE) : BBM_OK;
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
        p->x = m->node[p->node].x - m->origin[0] + p->u;
        p->y = m->node[p->node].y - m->origin[1] + p->v;
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
    if (bbm_motion_of(m))
        bbm_motion_of(m)->turn(&start, e, vertex);
}

/* Moves the elements and vertices of the model, or of a copy, by the D of the model, Eq. (3). */
void bbm_move_elements(const bbm_model *m, bbm_element element[], bbm_vertex vertex[])
{
    for (int i = 0; i < m->elements; i++) {
        memcpy(element[i].D, &m->D[6 * i], sizeof element[i].D);
        update_element(m, &element[i], &vertex[element[i].first]);
    }
}

/* Moves the model by its D, Eq. (3), unless a hook refuses the solution. info.change becomes the
 * left side of Eq. (71) over the right side without its tolerance. */
static bbm_status update(bbm_model *m)
{
    const bbm_status status = m->hook->move ? m->hook->move(m) : BBM_OK;
    double step2 = 0, sum2 = 0;

    if (status)
        return status;
    if (!m->hook->move)
        bbm_move_elements(m, m->element, m->vertex);
    for (const bbm_element *e = m->element; e < m->element + m->elements; e++) {
        step2 += e->D[0] * e->D[0] + e->D[1] * e->D[1];
        sum2 += e->sum[0] * e->sum[0] + e->sum[1] * e->sum[1];
    }
    m->info.change = sum2 > 0 ? sqrt(step2 / sum2) : 0;
    m->info.t += bbm_is_static(m) ? 0 : m->h;
    bbm_store_contacts(m);
    return BBM_OK;
}

/* --------------------------------------------------------------- the time step, Fig. 8 */

/* Fig. 8 once, with the step m->h. The model moves in `update` alone, when all has settled. */
bbm_status bbm_try_step(bbm_model *m)
{
    bbm_status status = bbm_begin_step(m);
    bbm_pass pass = BBM_PASS_DONE;
    int same = 1;

    if (!status)
        status = bbm_detect(m, &same);              /* 3.7: which contacts may close            */
    do {
        do {
            if (!status && pass != BBM_PASS_SAME_K)
                bbm_assemble(m);                    /* K, F: 3.1 to 3.8                         */
            if (!status)
                status = solve(m);                  /* K D = F: section 4                       */
            if (!status)
                status = open_close(m, &pass);      /* 3.8: do the contacts fit the solution?   */
        } while (!status && pass != BBM_PASS_DONE);
        if (!status)
            status = bbm_detect(m, &same);          /* too far for the list of contacts?        */
    } while (!status && !same);
    return status ? status : update(m);             /* positions, stresses, velocities          */
}

/* One part of a step, of length h. If it fails it is done again as two halves, down to dt/4096. A
 * static step has no halves. */
static bbm_status take_part(bbm_model *m, double h, int tries)
{
    m->h = h;
    bbm_status status = bbm_try_step(m);
    const int parts = bbm_parts_to_try(m, status, tries);

    for (int k = 0; k < parts && (k == 0 || !status); k++)
        status = take_part(m, h / parts, tries + 1);
    return status;
}

/* One time step, Fig. 8. If it fails, the model stays as the last part that went well left it. */
bbm_status bbm_step(bbm_model *m)
{
    const bbm_status status = bbm_check_step(m);

    return bbm_end_step(m, status ? status : take_part(m, m->par.dt, 0));
}

/* All time steps. With a tolerance they end when the last step is small against the sum of all
 * steps, Eq. (71): sqrt(sum |step_i|^2) <= tolerance sqrt(sum |total_i|^2), over the barycentres i.
 * `update` computes the two sides. */
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

/* Stress out of the plane, 0 in plane stress. */
double bbm_stress_out_of_plane(const bbm_element *e)
{
    return e->out_of_plane * (e->stress[0] + e->stress[1]);
}

/* von Mises stress. */
double bbm_mises(const double s[3], double szz)
{
    return sqrt(s[0] * s[0] - s[0] * s[1] + s[1] * s[1] + 3 * s[2] * s[2]
                + szz * (szz - s[0] - s[1]));
}

/* Displacement and nodal stress: the mean over the elements that meet at a node, those of one block
 * or of all (-1). */
bbm_status bbm_nodal_result(const bbm_model *m, int node, int block, bbm_result *r)
{
    int count = 0;

    *r = (bbm_result){ 0 };
    if (!m->is_prepared || node < 0 || node >= m->nodes)
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
        r->szz += bbm_stress_out_of_plane(e);
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
