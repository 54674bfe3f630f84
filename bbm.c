/* bbm.c - the formulas of the bonding block model: sections 2 and 3.1 to 3.6 of the paper, in their
 * order. Sections 3.7 and 3.8, contacts, are in contact.c, section 4, the solution of K D = F, in
 * solver.c. base/step.c calls all of them in a time step (Fig. 8). base/build.c builds a model.
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
 * Statics is without inertia, Eq. (16), (17). `middle` is NULL in the paper. With it a hook takes T
 * at another moment of the step, and a reader of the paper may pass over it.
 */
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
    double mx = 0, my = 0;

    e->A = e->Sxx = e->Syy = e->Sxy = 0;
    for (int a = 0; a < e->n; a++) {
        const int b = (a + 1) % e->n;
        const double xa = v[a].x - v[0].x, ya = v[a].y - v[0].y;
        const double xb = v[b].x - v[0].x, yb = v[b].y - v[0].y;
        const double c = xa * yb - xb * ya;
        e->A += c / 2;
        mx += c / 6 * (xa + xb);
        my += c / 6 * (ya + yb);
    }
    e->x = v[0].x + mx / e->A;
    e->y = v[0].y + my / e->A;
    for (int a = 0; a < e->n; a++) {
        const int b = (a + 1) % e->n;
        const double xa = v[a].x - e->x, ya = v[a].y - e->y, xb = v[b].x - e->x, yb = v[b].y - e->y;
        const double c = xa * yb - xb * ya;
        e->Sxx += c / 12 * (xa * xa + xa * xb + xb * xb);
        e->Syy += c / 12 * (ya * ya + ya * yb + yb * yb);
        e->Sxy += c / 24 * (xa * yb + 2 * xa * ya + 2 * xb * yb + xb * ya);
    }
}

/* Displacement mode matrix: u(x, y) = T D, Eq. (1), (2), (3). */
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

/* G of (4) and (29); in plane strain, which the paper does not have, G/(1 - 2 nu). The stiffness of
 * what is strained along both axes alike is in proportion to that, and springs have to be stiff
 * beside it. */
static double bond_modulus(const bbm_element *e)
{
    return shear_modulus(&e->material) / (1 - 2 * fmax(0, e->out_of_plane));
}

/* Stiffness [N/m] of the bonding springs between two elements, Eq. (4),
 *     k = alpha G t max(A)/min(A),
 * with G and t the means of the two. The areas are those at the start: k stays constant. The
 * paper's text names alpha, G and the areas. That they enter as this ratio is our choice: k then
 * has the dimension of G t, is symmetric, and is alpha G t on a uniform mesh. */
double bbm_bonding_stiffness(double alpha, const bbm_element *i, const bbm_element *j)
{
    const double G = (bond_modulus(i) + bond_modulus(j)) / 2;
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

/* Pi_e = t A (1/2 e.E e + e.stress0), Eq. (6), (7), (8), (9)
 *     ->   K_ii += t A E, F_i -= t A stress0, Eq. (10).
 * In the paper A is the present area. Deviation: with bbm_motion the A of K_ii is A0. The forces of
 * Hooke's law have a potential then: a body that is strained and comes back makes no energy. */
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
 * Eq. (11), (12), (13) (Newmark, beta = 1/2, gamma = 1)
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

/* T of Eq. (2) for gaps, loads and contacts, and the point itself; a hook may take both at another
 * moment of the step. */
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
 *     d = d0 + Ti(P) Di - Tj(Q) Dj,  d0 = P - Q,   Eq. (18), (19), (20), (21), (22), (23),
 *     Pi_b = k/2 d.d,                              Eq. (24), (25), (26).
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
 * With a hook W is any symmetric matrix, and a force f is added: W d0 + f in place of W d0. */
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
    return alpha * bond_modulus(e) * e->material.thickness;
}

/* A spring k between the vertex P and the wall point W,
 *     d = d0 + T(P) D,  d0 = P - W,            Eq. (30), (31), (32), (33), (34), (35), (36)
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
    *weight = (18 + (g == 0 || g == 3 ? -1 : 1) * sqrt(30.0)) / 72;
}

/* A load f(s) [N/m] that varies along a line from a to b,
 *     x(s) = xa + (xb - xa) s,  y(s) likewise,             Eq. (38), (39), (40), (41)
 *     ->   F_i += int_0^1 T^T(x(s), y(s)) f(s) l ds,       Eq. (42).
 * `f` has its values at the Gauss points. */
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

/* A volume force f(x, y) [N/m^2] that varies: F_i += int T^T f dA, Eq. (44), (45), (46). Each
 * edge and the barycentre make a signed triangle of area c/2. The midpoints of its sides integrate
 * it exactly if f is linear in x and y. */
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
