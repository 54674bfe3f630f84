/* bbm.c - the bonding block model: sections 2 and 3.1 to 3.6 of the paper in their order, then the time step.
 *
 * Sun, Chen, Feng, Wang 2015, doi:10.1155/2015/723263. Read it with the paper open: each formula is a function of its
 * own, with the number of its equation above it.
 *
 *     2.1  displacement of an element      (1)-(3)     3.3  bonding                (18)-(28)
 *     2.2  element connections             (4)         3.4  fixed points           (29)-(37)
 *     3.1  elastic submatrices             (6)-(10)    3.5  loads along a line     (38)-(43)
 *     3.2  inertia submatrices             (11)-(17)   3.6  volume force           (44)-(47)
 *
 * Every submatrix comes from one recipe. A source of potential energy Pi(D) is at most quadratic in the unknowns;
 * its second derivative goes to the left of K D = F, Eq. (5), and minus its first derivative at D = 0 to the right. With
 * a displacement d = d0 + T D and an energy k/2 d.d that is K += k T^T T and F -= k T^T d0: bonding springs,
 * fixed points and contacts are this one line with different d.
 *
 * Statics is dynamics without mass: with dt = INFINITY every term of 3.2 vanishes, and one step is one iteration of
 * Newton-Raphson on the moved geometry.
 *
 * What goes beyond the paper stands under headings that say so; doc/limits.md tells why.
 */
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "bbm.h"

/* An element whose area is below FLAT times the square of its longest reach is a line: round-off has its sign. */
#define FLAT 1e-12
/* Pivots of the (dimensionless) matrix of a body's fixings below this are zero: about 1e-5 rad of free turning. */
#define LOOSE 1e-10
/* Elements that a wave crosses in a step, from which on two levels solve faster than one: measured, with blocks of 2 to
 * 300 elements they break even at 1 to 4. */
#define CROSSED 3.0
/* The work of one step, cut or not, after which it has not settled: solutions, some times what the worst walls needed, and
 * iterations of SSOR-PCG in all of them, against those that one may take. */
enum { SOLUTIONS = 5000, ITERATIONS = 10 };
/* A residual |F - K D|/|F| above this is no solution, though the iteration ended: stiffnesses too far apart for doubles. */
#define UNSOLVED 1e-3
/* What an element may strain in a step of dynamics, and turn [rad] if it is bonded: the vectors of the middle grow without
 * bound towards half a turn. One static step is linear elasticity for loads of any size; but strained by 1 an element has
 * turned over. */
#define FAR_STRAIN 0.5
#define FAR_TURN 1.0
/* Depth of a contact against the size of its smaller block at which its springs do not keep the blocks apart any more. */
#define DEEP 0.1

/* ------------------------------------------------------------------------ 2.1 Displacement of an element */

/* Area, barycentre and second moments of a polygon by simplex integration, for Eq. (12): the sum over its edges of the
 * signed triangles (origin, a, b) with twice the area c = xa yb - xb ya,
 *     A = sum c/2,   int x dA = sum c/6 (xa + xb),   int x^2 dA = sum c/12 (xa^2 + xa xb + xb^2),
 *     int x y dA = sum c/24 (xa yb + 2 xa ya + 2 xb yb + xb ya).
 * Convex or not, the signs take care of it. The origin is first vertex 0, then the barycentre, so that nothing
 * cancels far from (0, 0). */
void bbm_element_geometry(bbm_element *e, const bbm_vertex v[])
{
    double A = 0, mx = 0, my = 0, sxx = 0, syy = 0, sxy = 0;

    for (int a = 0; a < e->n; a++) {
        const int b = (a + 1) % e->n;
        const double xa = v[a].x - v[0].x, ya = v[a].y - v[0].y, xb = v[b].x - v[0].x, yb = v[b].y - v[0].y;
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

/* Displacement u = T D of the last step at (x, y), a point given before the step, Eq. (1). */
void bbm_displacement(const bbm_element *e, double x, double y, double u[2])
{
    double T[2][6];

    bbm_mode_matrix(e, x, y, T);
    for (int r = 0; r < 2; r++) {
        u[r] = 0;
        for (int a = 0; a < 6; a++)
            u[r] += T[r][a] * e->D[a];
    }
}

/* -------------------------------------------------------------------------------- 2.2 Element connections */

static double shear_modulus(const bbm_material *m)
{
    return m->E / (2 * (1 + m->nu));
}

/* Stiffness [N/m] of the bonding springs between two elements, Eq. (4): k = alpha G t max(A)/min(A), with G and t the
 * means of the two. Starting areas, so that a spring keeps its stiffness and its energy. The paper's text names
 * alpha, G and the areas; that they enter as this ratio is our choice: k then has the dimension of G t, is
 * symmetric, and alpha G t on a uniform mesh. */
double bbm_bonding_stiffness(double alpha, const bbm_element *i, const bbm_element *j)
{
    const double G = (shear_modulus(&i->material) + shear_modulus(&j->material)) / 2;
    const double t = (i->material.thickness + j->material.thickness) / 2;

    return alpha * G * t * fmax(i->A0, j->A0) / fmin(i->A0, j->A0);
}

/* ----------------------------------------------------------------------------- 3.1 Elastic submatrices */

/* Hooke's law in plane stress, Eq. (7): stress = E e + stress0, e = (ex, ey, gxy) the last three of D, Eq. (8). */
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

/* Pi_e = t A (1/2 e.E e + e.stress0), Eq. (6)-(9)   ->   K_ii += t A E, F_i -= t A stress0, Eq. (10). */
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

/* ----------------------------------------------------------------------------- 3.2 Inertia submatrices */

/* Mass per present area, M of Eq. (11). The mass of an element stays density x thickness x starting area, so that
 * a strained element neither gains nor loses momentum. */
static double mass_per_area(const bbm_element *e)
{
    return e->material.density * e->material.thickness * e->A0 / e->A;
}

/* int T^T T dA, Eq. (12), (16), (17): with the origin in the barycentre the first moments vanish. */
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

/* Pi_i = int u.M u'' dA with the acceleration at the end of the step, u'' = 2/dt^2 D - 2/dt V, Eq. (11)-(13) (Newmark,
 * beta = 1/2, gamma = 1)   ->   K_ii += 2 M/dt^2 int T^T T dA, Eq. (16), F_i += 2 M/dt (int T^T T dA) V, Eq. (17).
 * The force of inertia is a load: Eq. (15) is varied by the D of u alone, not by the D of u''. */
void bbm_inertia_submatrix(const bbm_element *e, double dt, bbm_submatrix *s)
{
    const double M = mass_per_area(e);
    double TT[6][6];

    bbm_mode_integral(e, TT);
    for (int a = 0; a < 6; a++)
        for (int b = 0; b < 6; b++) {
            s->K[a][b] += 2 * M / (dt * dt) * TT[a][b];
            s->F[a] += 2 * M / dt * TT[a][b] * e->V[b];
        }
}

/* Velocity at the end of the step, V = 2/dt D - V, Eq. (14), times the share that is kept: 0 in statics. */
void bbm_newmark_velocity(bbm_element *e, double dt, double keep)
{
    for (int a = 0; a < 6; a++)
        e->V[a] = keep * (2 / dt * e->D[a] - e->V[a]);
}

/* ----------------------------------------------------------------------------- 3.3 Bonding submatrices */

/* K += k Ti^T Tj. */
static void add_product(double k, double Ti[2][6], double Tj[2][6], double K[6][6])
{
    for (int a = 0; a < 6; a++)
        for (int b = 0; b < 6; b++)
            K[a][b] += k * (Ti[0][a] * Tj[0][b] + Ti[1][a] * Tj[1][b]);
}

/* F += T^T f: what a force f at a point does to the unknowns. */
static void add_force(double T[2][6], const double f[2], double F[6])
{
    for (int a = 0; a < 6; a++)
        F[a] += T[0][a] * f[0] + T[1][a] * f[1];
}

/* A spring k between the vertices P of element i and Q of element j, one point at the start. Its elongation at the
 * end of the step is |d|, d = d0 + Ti(P) Di - Tj(Q) Dj, d0 = P - Q, Eq. (18)-(23); Pi_b = k/2 d.d, Eq. (24)-(26)
 *     ->   K_ii += k Ti^T Ti,  K_ij -= k Ti^T Tj,  K_jj += k Tj^T Tj,  Eq. (27),
 *          F_i -= k Ti^T d0,  F_j += k Tj^T d0,                        Eq. (28).
 * d0 is the difference of the displacements: coordinates would add their round-off. Deviation, here and for fixed points
 * and loads: T at the middle of the step, with which d is exact (beyond/middle.c). */
void bbm_bonding_submatrices(const bbm_element *i, const bbm_vertex *P, const bbm_element *j, const bbm_vertex *Q,
                             double k, bbm_submatrices *s)
{
    const double pull[2] = { k * (P->u - Q->u), k * (P->v - Q->v) }, push[2] = { -pull[0], -pull[1] };
    double Ti[2][6], Tj[2][6], at[2];

    bbm_middle_matrix(i, P->x, P->y, Ti, at);
    bbm_middle_matrix(j, Q->x, Q->y, Tj, at);
    add_product(k, Ti, Ti, s->Kii);
    add_product(-k, Ti, Tj, s->Kij);
    add_product(k, Tj, Tj, s->Kjj);
    add_force(Ti, push, s->Fi);
    add_force(Tj, pull, s->Fj);
}

/* ---------------------------------------------------------------- beyond the paper: bonds for bending
 * Two quadrilaterals that bend open, at the ends of their edge, the gaps d1 and d2 = -d1, for no D bends. Springs
 * at the ends forbid that: the mesh locks. Seen as one bond the two springs are k |(d1 + d2)/2|^2 + 1/2 dd.M dd with
 * dd = (d1 - d2)/2 and M = 2 k I. Deviation: M is only as large as the bending stiffness that the elements lack. */

/* Condenses the symmetric 6x6 W, rows (h, a, b), to its first two rows: minimises the energy over a and b. */
static void condense(double W[6][6], double S[2][2])
{
    for (int p = 5; p > 1; p--)
        for (int a = 0; a < p; a++)
            for (int b = 0; b < p; b++)
                W[a][b] -= W[a][p] * W[p][b] / W[p][p];
    memcpy(S[0], W[0], sizeof S[0]);
    memcpy(S[1], W[1], sizeof S[1]);
}

/* The stiffness of a quadrilateral x = c + xi p + eta q, -1/2 <= xi, eta <= 1/2, against the bending that D lacks,
 * u = h xi eta + a xi^2/2 + b eta^2/2 with h, a, b vectors (Wilson's incompatible modes: Taylor, Beresford, Wilson, Int. J.
 * Num. Meth. Eng. 10, 1976). Its gradient is xi (a gx + h gy) + eta (h gx + b gy) with gx, gy the gradients of xi and
 * eta, its strain xi Ex + eta Ey; W = t A/12 (Ex^T E Ex + Ey^T E Ey). What the two bonds that p crosses and the two that
 * q crosses feel is dd = h/2, therefore S = 4 (W condensed to h). */
static void bending_stiffness(const bbm_element *e, const double p[2], const double q[2], double S[2][2])
{
    const double det = p[0] * q[1] - p[1] * q[0], tA = e->material.thickness * e->A;
    const double gx[2] = { q[1] / det, -q[0] / det }, gy[2] = { -p[1] / det, p[0] / det };
    const double strain[2][3][6] = {
        /*  hx     hy       ax     ay       bx     by */
        { { gy[0], 0,       gx[0], 0,       0,     0     },             /* Ex: strain ex                            */
          { 0,     gy[1],   0,     gx[1],   0,     0     },             /*     ey                                   */
          { gy[1], gy[0],   gx[1], gx[0],   0,     0     } },           /*     gxy                                  */
        { { gx[0], 0,       0,     0,       gy[0], 0     },             /* Ey                                       */
          { 0,     gx[1],   0,     0,       0,     gy[1] },
          { gx[1], gx[0],   0,     0,       gy[1], gy[0] } },
    };
    double E[3][3], W[6][6] = { { 0 } };

    bbm_elastic_matrix(&e->material, E);
    for (int a = 0; a < 6; a++)
        for (int b = 0; b < 6; b++)
            for (int r = 0; r < 9; r++)
                for (int x = 0; x < 2; x++)
                    W[a][b] += 4 * tA / 12 * strain[x][r / 3][a] * E[r / 3][r % 3] * strain[x][r % 3][b];
    condense(W, S);
}

/* S s s^T S / (s^T S s) */
static void project(double S[2][2], const double s[2], double P[2][2])
{
    const double f[2] = { S[0][0] * s[0] + S[0][1] * s[1], S[1][0] * s[0] + S[1][1] * s[1] };
    const double sSs = f[0] * s[0] + f[1] * s[1];

    for (int a = 0; a < 2; a++)
        for (int b = 0; b < 2; b++)
            P[a][b] = f[a] * f[b] / sSs;
}

/* A quadrilateral's share in the moments of its bonds: M[0] for the edges 0 and 2 (from vertex 0 to 1, from 2 to 3), which q
 * crosses, M[1] for 1 and 3, which p crosses. M[1] = 1/2 [S p p^T S/(p.S p) + S - S q q^T S/(q.S q)], M[0] = S - M[1]: for
 * a rectangle the bending stiffness of the edge as a beam's section, E t l^3/12 over the distance w of the centres. */
void bbm_hinge_moments(const bbm_element *e, const bbm_vertex v[], double M[2][2][2])
{
    const double p[2] = { (v[1].x + v[2].x - v[0].x - v[3].x) / 2, (v[1].y + v[2].y - v[0].y - v[3].y) / 2 };
    const double q[2] = { (v[2].x + v[3].x - v[0].x - v[1].x) / 2, (v[2].y + v[3].y - v[0].y - v[1].y) / 2 };
    double S[2][2], P[2][2], Q[2][2];

    bending_stiffness(e, p, q, S);
    project(S, p, P);
    project(S, q, Q);
    for (int a = 0; a < 2; a++)
        for (int b = 0; b < 2; b++) {
            M[1][a][b] = (P[a][b] + S[a][b] - Q[a][b]) / 2;
            M[0][a][b] = S[a][b] - M[1][a][b];
        }
}

/* K += Ti^T W Tj with a 2x2 weight W. */
static void add_weighted(double Ti[2][6], const double W[2][2], double Tj[2][6], double sign, double K[6][6])
{
    double WT[2][6];

    for (int r = 0; r < 2; r++)
        for (int b = 0; b < 6; b++)
            WT[r][b] = sign * (W[r][0] * Tj[0][b] + W[r][1] * Tj[1][b]);
    add_product(1, Ti, WT, K);
}

/* One of the two gaps of an edge bond: d = (d1 + s d2)/2 with s = 1 (mean) or -1 (dd), of weight W. */
static void add_gap(const bbm_element *i, const bbm_vertex *const P[2], const bbm_element *j,
                    const bbm_vertex *const Q[2], const double W[2][2], double s, bbm_submatrices *m)
{
    const double d[2] = { (P[0]->u - Q[0]->u + s * (P[1]->u - Q[1]->u)) / 2,
                          (P[0]->v - Q[0]->v + s * (P[1]->v - Q[1]->v)) / 2 };
    const double pull[2] = { W[0][0] * d[0] + W[0][1] * d[1], W[1][0] * d[0] + W[1][1] * d[1] };
    const double push[2] = { -pull[0], -pull[1] };
    double T[2][2][6], Ti[2][6], Tj[2][6], at[2];

    for (int end = 0; end < 2; end++)
        bbm_middle_matrix(i, P[end]->x, P[end]->y, T[end], at);
    for (int a = 0; a < 12; a++)
        Ti[a / 6][a % 6] = (T[0][a / 6][a % 6] + s * T[1][a / 6][a % 6]) / 2;
    for (int end = 0; end < 2; end++)
        bbm_middle_matrix(j, Q[end]->x, Q[end]->y, T[end], at);
    for (int a = 0; a < 12; a++)
        Tj[a / 6][a % 6] = (T[0][a / 6][a % 6] + s * T[1][a / 6][a % 6]) / 2;
    add_weighted(Ti, W, Ti, 1, m->Kii);
    add_weighted(Ti, W, Tj, -1, m->Kij);
    add_weighted(Tj, W, Tj, 1, m->Kjj);
    add_force(Ti, push, m->Fi);
    add_force(Tj, pull, m->Fj);
}

/* A whole edge as one bond between P[0], P[1] of i and Q[0], Q[1] of j. */
void bbm_hinge_submatrices(const bbm_element *i, const bbm_vertex *const P[2], const bbm_element *j,
                           const bbm_vertex *const Q[2], const bbm_hinge *h, bbm_submatrices *s)
{
    add_gap(i, P, j, Q, h->K, 1, s);
    add_gap(i, P, j, Q, h->M, -1, s);
}

/* ---------------------------------------------------------- 3.4 Bonding submatrices at fixed points */

/* Stiffness [N/m] of the spring at a fixed point, Eq. (29): k = alpha G t, (4) with the wall like the element. */
double bbm_fixed_stiffness(double alpha, const bbm_element *e)
{
    return alpha * shear_modulus(&e->material) * e->material.thickness;
}

/* A spring k between the vertex P and the wall point W, d = d0 + T(P) D, d0 = P - W, Eq. (30)-(36)
 *     ->   K_ii += k T^T T,  F_i -= k T^T d0,  Eq. (37).
 * A point held in one direction alone, as on a line of symmetry, has that row of T only. */
void bbm_fixed_submatrix(const bbm_element *e, const bbm_vertex *P, const bbm_node *W, double k, bbm_submatrix *s)
{
    const double push[2] = { k * (W->wall[0] - P->u), k * (W->wall[1] - P->v) };
    double T[2][6], at[2];

    bbm_middle_matrix(e, P->x, P->y, T, at);
    for (int r = 0; r < 2; r++)
        for (int a = 0; a < 6 && (W->held & (r == 0 ? BBM_X : BBM_Y)); a++) {
            for (int b = 0; b < 6; b++)
                s->K[a][b] += k * T[r][a] * T[r][b];
            s->F[a] += T[r][a] * push[r];
        }
}

/* ------------------------------------------------- The coarse space of the linear solver, see solver.c */

/* What the displacement of corner a alone does to the unknowns, D = P (u_a, v_a): of the displacements linear in x, y
 * the one nearest to those of all n corners, by least squares; on a triangle it is exact. With `middles` it is the one
 * nearest to the means over the sides, for elements that are bonded there. Fitted about the mean of the corners, a
 * linear function has the value mean(u) there and the gradient g = M^-1 sum_a d_a u_a, M = sum d d^T:
 *     u_a adds ux = g_x, uy = g_y, v_a the same to v;   ex = ux, ey = vy, gxy = uy + vx, r0 = (vx - uy)/2. */
void bbm_interpolation(const bbm_element *e, const bbm_vertex v[], int middles, int a, double P[6][2])
{
    double x = 0, y = 0, xx = 0, yy = 0, xy = 0, X = 0, Y = 0;

    for (int k = 0; k < e->n; k++) {
        x += v[k].x / e->n;
        y += v[k].y / e->n;
    }
    for (int k = 0; k < e->n; k++) {
        const int next = (k + 1) % e->n;
        const double dx = (middles ? (v[k].x + v[next].x) / 2 : v[k].x) - x;
        const double dy = (middles ? (v[k].y + v[next].y) / 2 : v[k].y) - y;
        const double share = middles ? (k == a || next == a) / 2.0 : k == a;
        xx += dx * dx;
        yy += dy * dy;
        xy += dx * dy;
        X += share * dx;
        Y += share * dy;
    }
    const double det = xx * yy - xy * xy, gx = (yy * X - xy * Y) / det, gy = (xx * Y - xy * X) / det;
    const double u0 = 1.0 / e->n + gx * (e->x - x) + gy * (e->y - y);
    const double matrix[6][2] = { { u0, 0 }, { 0, u0 }, { -gy / 2, gx / 2 }, { gx, 0 }, { 0, gy }, { gy, gx } };

    memcpy(P, matrix, sizeof matrix);
}

/* ------------------------------------------------------------------------ 3.5 Line loading submatrices */

/* A concentrated load f [N] at the vertex P: F_i += T^T(P) f. */
void bbm_point_load(const bbm_element *e, const bbm_vertex *P, const double f[2], double F[6])
{
    double T[2][6], at[2];

    bbm_middle_matrix(e, P->x, P->y, T, at);
    add_force(T, f, F);
}

/* Point and weight g of Gauss and Legendre on 0 <= s <= 1, for Eq. (38) and (42). */
void bbm_gauss_point(int g, double *s, double *weight)
{
    const double inner = 3.0 / 7 - 2.0 / 7 * sqrt(6.0 / 5), outer = 3.0 / 7 + 2.0 / 7 * sqrt(6.0 / 5);
    const double x[BBM_GAUSS] = { -sqrt(outer), -sqrt(inner), sqrt(inner), sqrt(outer) };

    *s = (1 + x[g]) / 2;
    *weight = (18 + (g == 0 || g == 3 ? -1 : 1) * sqrt(30)) / 72;
}

/* A load f(s) [N/m] that varies from a to b, x(s) = xa + (xb - xa) s, Eq. (38)-(41), given at the Gauss points:
 * F_i += int_0^1 T^T(x(s), y(s)) f(s) l ds, Eq. (42). */
void bbm_varying_load_submatrix(const bbm_element *e, const bbm_vertex *a, const bbm_vertex *b,
                                const double f[BBM_GAUSS][2], double F[6])
{
    const double l = hypot(b->x - a->x, b->y - a->y);

    for (int g = 0; g < BBM_GAUSS; g++) {
        double s, w, T[2][6], at[2];
        bbm_gauss_point(g, &s, &w);
        const double wlf[2] = { w * l * f[g][0], w * l * f[g][1] };
        bbm_middle_matrix(e, a->x + (b->x - a->x) * s, a->y + (b->y - a->y) * s, T, at);
        add_force(T, wlf, F);
    }
}

/* A constant load f [N/m] from a to b: F_i += l T^T f = l (fx, fy, -Y fx + X fy, X fx, Y fy, (Y fx + X fy)/2), with T at
 * (X, Y), the middle of the line seen from the barycentre, Eq. (39), (43). */
void bbm_constant_load_submatrix(const bbm_element *e, const bbm_vertex *a, const bbm_vertex *b, const double f[2],
                                 double F[6])
{
    const double l = hypot(b->x - a->x, b->y - a->y), lf[2] = { l * f[0], l * f[1] };
    double T[2][6], at[2];

    bbm_middle_matrix(e, (a->x + b->x) / 2, (a->y + b->y) / 2, T, at);
    add_force(T, lf, F);
}

/* ---------------------------------------------------------------------------- 3.6 Volume force submatrix */

/* A volume force f(x, y) [N/m^2] that varies: F_i += int T^T f dA, Eq. (44)-(46). Each edge and the barycentre make a
 * signed triangle of area c/2, integrated by the midpoints of its sides: exact for f linear in x and y. */
void bbm_varying_volume_submatrix(const bbm_element *e, const bbm_vertex v[], bbm_field *f, const void *context,
                                  double F[6])
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

/* ------------------------------------------------------------------------------ messages and memory */

const char *bbm_status_text(bbm_status s)
{
    static const char *const text[BBM_STATUS_COUNT] = {
        [BBM_OK] = "no error",
        [BBM_NO_MEMORY] = "out of memory",
        [BBM_NO_ELEMENT] = "the model has no element",
        [BBM_NOT_FINITE] = "a number is NaN or infinite",
        [BBM_BAD_INDEX] = "no such node, element or material",
        [BBM_BAD_MODULUS] = "Young's modulus must be positive",
        [BBM_BAD_POISSON] = "Poisson's ratio must lie between -1 and 0.5",
        [BBM_BAD_DENSITY] = "the density must be positive",
        [BBM_BAD_THICKNESS] = "the thickness must be positive",
        [BBM_BAD_PARAMETER] = "a parameter is outside its range",
        [BBM_FEW_VERTICES] = "an element needs three vertices or more",
        [BBM_ZERO_AREA] = "an element has no area",
        [BBM_SELF_CROSSING] = "the boundary of an element meets itself",
        [BBM_OVERLAP] = "elements of one block overlap",
        [BBM_BLOCKS_OVERLAP] = "blocks overlap at the start",
        [BBM_UNUSED_NODE] = "a node belongs to no element",
        [BBM_NOT_BOUNDARY] = "a line load needs a boundary edge",
        [BBM_FREE_TO_MOVE] = "statics needs bodies that are held",
        [BBM_MECHANISM] = "elements bonded at midpoints alone can turn against each other",
        [BBM_NOT_POSITIVE_DEFINITE] = "the stiffness matrix is not positive definite",
        [BBM_NOT_CONVERGED] = "the equations were not solved",
        [BBM_STEPS_EXHAUSTED] = "no equilibrium in the given steps",
        [BBM_NO_EQUILIBRIUM] = "statics finds no equilibrium",
        [BBM_STEP_TOO_LONG] = "the step is too long",
        [BBM_OPEN_CLOSE] = "the open-close iteration does not settle",
        [BBM_STOPPED] = "stopped from outside",
        [BBM_TOO_SOFT] = "the contacts are too soft",
        [BBM_ENERGY] = "the step makes energy",
    };

    return s >= 0 && s < BBM_STATUS_COUNT ? text[s] : "unknown status";
}

const char *bbm_message(const bbm_model *m)
{
    return m->message;
}

/* Puts the sentence "TEXT OF THE STATUS: details" into the model and hands the status on. */
static bbm_status fail(bbm_model *m, bbm_status s, const char *format, ...)
{
    const int used = snprintf(m->message, sizeof m->message, "%s: ", bbm_status_text(s));
    va_list args;

    va_start(args, format);
    vsnprintf(m->message + used, sizeof m->message - (size_t)used, format, args);
    va_end(args);
    return s;
}

static bbm_status out_of_memory(bbm_model *m)
{
    return fail(m, BBM_NO_MEMORY, "%d elements, %d nodes", m->elements, m->nodes);
}

/* Makes room for one more entry in an array of `count`: its room is the next power of two, 16 at least. */
static int grow(void **array, int count, size_t size)
{
    if (count != 0 && (count < 16 || (count & (count - 1)) != 0))
        return 1;
    void *room = realloc(*array, (count == 0 ? 16 : 2 * (size_t)count) * size);
    if (room)
        *array = room;
    return room != NULL;
}

/* ------------------------------------------------------------------------------------- building a model */

/* A model with the defaults of statics in one step. */
bbm_status bbm_model_new(bbm_model **out)
{
    bbm_model *m = calloc(1, sizeof *m);

    *out = m;
    if (!m)
        return BBM_NO_MEMORY;
    m->par = (bbm_parameters){ .dt = INFINITY, .steps = 1, .alpha = 100, .p_n = 1e9, .p_s = 4e8, .faces = 1,
                               .pcg = { .omega = 1, .tolerance = 1e-10, .iterations = 100000,
                                        .form = BBM_TWO_LEVEL } };
    return BBM_OK;
}

/* What bbm_prepare made. */
static void free_prepared(bbm_model *m)
{
    free(m->bond);
    free(m->edge);
    free(m->meet_first);
    free(m->meet);
    free(m->F);
    free(m->D);
    free(m->load);
    free(m->end_element);
    free(m->end_vertex);
    free(m->force);
    free(m->force_before);
    bbm_matrix_free(m->K);
    bbm_contact_free(m->work);
    free(m->contact);
    free(m->pair);
    m->work = NULL;
    m->contact = NULL;
    m->contacts = m->contact_room = 0;
    m->pair = NULL;
    m->pairs = 0;
    m->bond = NULL;
    m->edge = NULL;
    m->meet_first = m->meet = NULL;
    m->end_element = NULL;
    m->end_vertex = NULL;
    m->F = m->D = m->load = m->force = m->force_before = NULL;
    m->K = NULL;
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

/* Remembers the first error of building. */
static bbm_status stick(bbm_model *m, bbm_status s)
{
    return m->status = s;
}

bbm_status bbm_add_material(bbm_model *m, const bbm_material *a, int *index)
{
    const int n = m->materials;

    if (m->status)
        return m->status;
    if (!isfinite(a->E) || !isfinite(a->nu) || !isfinite(a->density) || !isfinite(a->thickness))
        return stick(m, fail(m, BBM_NOT_FINITE, "material %d", n));
    if (a->E <= 0)
        return stick(m, fail(m, BBM_BAD_MODULUS, "material %d has E = %g", n, a->E));
    if (a->nu <= -1 || a->nu >= 0.5)
        return stick(m, fail(m, BBM_BAD_POISSON, "material %d has nu = %g", n, a->nu));
    if (a->density <= 0)
        return stick(m, fail(m, BBM_BAD_DENSITY, "material %d has %g", n, a->density));
    if (a->thickness <= 0)
        return stick(m, fail(m, BBM_BAD_THICKNESS, "material %d has %g", n, a->thickness));
    if (!grow((void **)&m->material, n, sizeof *a))
        return stick(m, out_of_memory(m));
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
        return stick(m, fail(m, BBM_NOT_FINITE, "node %d at (%g, %g)", m->nodes, x, y));
    if (!grow((void **)&m->node, m->nodes, sizeof *m->node))
        return stick(m, out_of_memory(m));
    m->node[m->nodes] = (bbm_node){ .x = x, .y = y };
    if (index)
        *index = m->nodes;
    m->nodes++;
    return BBM_OK;
}

static int known_node(const bbm_model *m, int node)
{
    return node >= 0 && node < m->nodes;
}

/* Twice the signed area of the triangle p q r: positive when they run counter-clockwise. */
static double turn(const bbm_node *p, const bbm_node *q, const bbm_node *r)
{
    return (q->x - p->x) * (r->y - p->y) - (r->x - p->x) * (q->y - p->y);
}

/* Whether r, on the line through p and q, lies between them. */
static int between(const bbm_node *p, const bbm_node *q, const bbm_node *r)
{
    return (r->x - p->x) * (r->x - q->x) + (r->y - p->y) * (r->y - q->y) <= 0;
}

/* Whether the segments ab and cd have a point in common. */
static int segments_meet(const bbm_node *a, const bbm_node *b, const bbm_node *c, const bbm_node *d)
{
    const double abc = turn(a, b, c), abd = turn(a, b, d), cda = turn(c, d, a), cdb = turn(c, d, b);

    if (!signbit(abc) != !signbit(abd) && !signbit(cda) != !signbit(cdb))
        return 1;
    return (abc == 0 && between(a, b, c)) || (abd == 0 && between(a, b, d)) || (cda == 0 && between(c, d, a)) ||
           (cdb == 0 && between(c, d, b));
}

/* Whether the closed polygon through the nodes meets itself: two edges that are not neighbours have a point in
 * common, or an edge folds back on its neighbour (an edge without length does). */
static int meets_itself(const bbm_model *m, int n, const int node[])
{
    for (int i = 0; i < n; i++) {
        const bbm_node *a = &m->node[node[i]], *b = &m->node[node[(i + 1) % n]];
        for (int j = i + 2; j < n && (j + 1) % n != i; j++)
            if (segments_meet(a, b, &m->node[node[j]], &m->node[node[(j + 1) % n]]))
                return 1;
    }
    return 0;
}

/* The signed area of the polygon, its unsigned sum over the fan of vertex 0, and the square of its longest reach. */
static double polygon_area(const bbm_model *m, int n, const int node[], double *fan, double *reach2)
{
    const bbm_node *o = &m->node[node[0]];
    double area = 0;

    *fan = *reach2 = 0;
    for (int i = 1; i < n; i++) {
        const bbm_node *a = &m->node[node[i]], *b = &m->node[node[(i + 1) % n]];
        const double c = turn(o, a, b) / 2;
        area += c;
        *fan += fabs(c);
        *reach2 = fmax(*reach2, (a->x - o->x) * (a->x - o->x) + (a->y - o->y) * (a->y - o->y));
    }
    return area;
}

/* Adds the polygon through the nodes, either way round, as an element of a block. */
bbm_status bbm_add_element(bbm_model *m, int block, int material, int n, const int node[], int *index)
{
    const int e = m->elements, first = m->vertices;
    double fan, reach2;

    if (m->status)
        return m->status;
    if (material < 0 || material >= m->materials)
        return stick(m, fail(m, BBM_BAD_INDEX, "element %d has material %d of %d", e, material, m->materials));
    if (n < 3)
        return stick(m, fail(m, BBM_FEW_VERTICES, "element %d has %d", e, n));
    for (int i = 0; i < n; i++)
        if (!known_node(m, node[i]))
            return stick(m, fail(m, BBM_BAD_INDEX, "element %d has node %d of %d", e, node[i], m->nodes));
    const double area = polygon_area(m, n, node, &fan, &reach2);
    if (fan <= FLAT * reach2)
        return stick(m, fail(m, BBM_ZERO_AREA, "element %d, %g m^2", e, area));
    if (meets_itself(m, n, node))
        return stick(m, fail(m, BBM_SELF_CROSSING, "element %d", e));
    if (!grow((void **)&m->element, e, sizeof *m->element))
        return stick(m, out_of_memory(m));
    for (int i = 0; i < n; i++) {
        const int here = node[area > 0 ? i : n - 1 - i];
        if (!grow((void **)&m->vertex, m->vertices, sizeof *m->vertex))
            return stick(m, out_of_memory(m));
        m->vertex[m->vertices++] = (bbm_vertex){ .node = here, .element = e, .x = m->node[here].x, .y = m->node[here].y };
    }
    m->element[e] = (bbm_element){ .block = block, .material = m->material[material], .first = first, .n = n };
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
    if (!known_node(m, node))
        return stick(m, fail(m, BBM_BAD_INDEX, "fixed node %d of %d", node, m->nodes));
    if (directions < BBM_X || directions > BBM_XY)
        return stick(m, fail(m, BBM_BAD_PARAMETER, "directions %d of fixed node %d", directions, node));
    if (!isfinite(u) || !isfinite(v))
        return stick(m, fail(m, BBM_NOT_FINITE, "the wall point of fixed node %d", node));
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
    if (!known_node(m, node))
        return stick(m, fail(m, BBM_BAD_INDEX, "loaded node %d of %d", node, m->nodes));
    if (!isfinite(fx) || !isfinite(fy))
        return stick(m, fail(m, BBM_NOT_FINITE, "the load of node %d", node));
    m->node[node].load[0] += fx;
    m->node[node].load[1] += fy;
    return BBM_OK;
}

/* Adds a line load with everything but its vertices, which bbm_prepare finds. */
static bbm_status add_line_load(bbm_model *m, const bbm_line_load *load)
{
    for (int g = 0; g < BBM_GAUSS; g++)
        if (!isfinite(load->pressure) || !isfinite(load->f[g][0]) || !isfinite(load->f[g][1]))
            return stick(m, fail(m, BBM_NOT_FINITE, "the line load on nodes %d, %d", load->node[0], load->node[1]));
    if (!grow((void **)&m->line_load, m->line_loads, sizeof *load))
        return stick(m, out_of_memory(m));
    m->line_load[m->line_loads++] = *load;
    return BBM_OK;
}

bbm_status bbm_add_line_load(bbm_model *m, int node1, int node2, double fx, double fy)
{
    bbm_line_load load = { .node = { node1, node2 }, .constant = 1, .f = { { fx, fy } } };

    if (m->status)
        return m->status;
    if (!known_node(m, node1) || !known_node(m, node2))
        return stick(m, fail(m, BBM_BAD_INDEX, "line load on nodes %d, %d of %d", node1, node2, m->nodes));
    return add_line_load(m, &load);
}

/* The load f(x, y) [N/m] on the edge between two nodes, taken at the Gauss points of the starting geometry. */
bbm_status bbm_add_varying_line_load(bbm_model *m, int node1, int node2, bbm_field *f, const void *context)
{
    bbm_line_load load = { .node = { node1, node2 } };

    if (m->status)
        return m->status;
    if (!known_node(m, node1) || !known_node(m, node2))
        return stick(m, fail(m, BBM_BAD_INDEX, "line load on nodes %d, %d of %d", node1, node2, m->nodes));
    const bbm_node *a = &m->node[node1], *b = &m->node[node2];
    for (int g = 0; g < BBM_GAUSS; g++) {
        double s, weight;
        bbm_gauss_point(g, &s, &weight);
        f(a->x + (b->x - a->x) * s, a->y + (b->y - a->y) * s, context, load.f[g]);
    }
    return add_line_load(m, &load);
}

/* --------------------------------------------------------- preparing: 2.2, boundary and internal edges */

/* Lists the vertices at each node: those of node n are meet[meet_first[n]] to meet[meet_first[n+1] - 1]. */
static bbm_status list_meeting_vertices(bbm_model *m)
{
    m->meet_first = calloc((size_t)m->nodes + 1, sizeof *m->meet_first);
    m->meet = calloc((size_t)m->vertices, sizeof *m->meet);
    if (!m->meet_first || !m->meet)
        return out_of_memory(m);
    for (int v = 0; v < m->vertices; v++)
        m->meet_first[m->vertex[v].node]++;
    for (int n = 0, sum = 0; n <= m->nodes; n++) {
        if (n < m->nodes && m->meet_first[n] == 0)
            return fail(m, BBM_UNUSED_NODE, "node %d at (%g, %g)", n, m->node[n].x, m->node[n].y);
        sum += m->meet_first[n];
        m->meet_first[n] = sum;
    }
    for (int v = m->vertices - 1; v >= 0; v--)
        m->meet[--m->meet_first[m->vertex[v].node]] = v;
    return BBM_OK;
}

typedef struct { int block, low, high, element, a, b; } side;   /* of one element, by the nodes low < high at its ends */

static int compare_sides(const void *p, const void *q)
{
    const side *s = p, *t = q;
    const int d[4] = { (s->block > t->block) - (s->block < t->block), (s->low > t->low) - (s->low < t->low),
                       (s->high > t->high) - (s->high < t->high), (s->element > t->element) - (s->element < t->element) };

    return d[0] ? d[0] : d[1] ? d[1] : d[2] ? d[2] : d[3];
}

/* All sides of all elements, sorted so that those between the same nodes in the same block are neighbours. */
static void list_sides(const bbm_model *m, side s[])
{
    for (int v = 0; v < m->vertices; v++) {
        const bbm_element *e = &m->element[m->vertex[v].element];
        const int next = v + 1 < e->first + e->n ? v + 1 : e->first;
        const int p = m->vertex[v].node, q = m->vertex[next].node;
        s[v] = (side){ e->block, p < q ? p : q, p < q ? q : p, m->vertex[v].element, v, next };
    }
    qsort(s, (size_t)m->vertices, sizeof *s, compare_sides);
}

/* Section 2.2: a side that two elements of a block share is an internal edge and gets a bond, one that has no partner
 * is a boundary edge. Elements run counter-clockwise, so partners run opposite ways. */
static bbm_status sort_edges(bbm_model *m, const side s[])
{
    for (int v = 0, same; v < m->vertices; v += same) {
        for (same = 1; v + same < m->vertices; same++)
            if (s[v + same].block != s[v].block || s[v + same].low != s[v].low || s[v + same].high != s[v].high)
                break;
        const side *i = &s[v], *j = &s[v + 1];
        if (same == 1)
            m->edge[m->edges++] = (bbm_edge){ i->element, i->a, i->b, i->block };
        else if (same > 2 || m->vertex[i->a].node == m->vertex[j->a].node)
            return m->culprit = j->element, m->other = i->element,
                   fail(m, BBM_OVERLAP, "elements %d and %d on the same side of nodes %d, %d", i->element,
                        s[v + same - 1].element, i->low, i->high);
        else
            m->bond[m->bonds++] = (bbm_bond){ i->element, j->element, { i->a, i->b }, { j->b, j->a } };
    }
    return BBM_OK;
}

static bbm_status connect_elements(bbm_model *m)
{
    side *s = calloc((size_t)m->vertices, sizeof *s);
    bbm_status status = BBM_OK;

    m->bonds = m->edges = 0;
    m->edge = calloc((size_t)m->vertices, sizeof *m->edge);
    m->bond = calloc((size_t)m->vertices / 2, sizeof *m->bond);
    if (!s || !m->edge || !m->bond) {
        status = out_of_memory(m);
    } else {
        list_sides(m, s);
        status = sort_edges(m, s);
    }
    free(s);
    return status;
}

/* The first boundary edge from node p to node q, or -1; leaving[v] is the one that starts in vertex v, or -1. */
static int find_edge(const bbm_model *m, const int leaving[], int p, int q)
{
    int found = -1;

    for (int a = m->meet_first[p]; a < m->meet_first[p + 1]; a++) {
        const int e = leaving[m->meet[a]];
        if (e >= 0 && m->vertex[m->edge[e].b].node == q && (found < 0 || e < found))
            found = e;
    }
    return found;
}

/* Finds the vertices of each line load: the boundary edge between its nodes. */
static bbm_status place_line_loads(bbm_model *m)
{
    int *leaving = malloc((size_t)m->vertices * sizeof *leaving);
    bbm_status status = leaving ? BBM_OK : out_of_memory(m);

    for (int v = 0; v < m->vertices && !status; v++)
        leaving[v] = -1;
    for (int e = 0; e < m->edges && !status; e++)
        leaving[m->edge[e].a] = e;
    for (int l = 0; l < m->line_loads && !status; l++) {
        bbm_line_load *load = &m->line_load[l];
        const int p = load->node[0], q = load->node[1];
        const int there = find_edge(m, leaving, p, q), back = find_edge(m, leaving, q, p);
        if (there < 0 && back < 0)
            status = fail(m, BBM_NOT_BOUNDARY, "nodes %d and %d", p, q);
        else if (back < 0 || (there >= 0 && there < back))
            load->a = m->edge[there].a, load->b = m->edge[there].b;
        else
            load->a = m->edge[back].b, load->b = m->edge[back].a;
    }
    free(leaving);
    return status;
}

/* Adds a load [N/m] on a boundary edge of the prepared model: a force and a pressure that turns with the edge. */
bbm_status bbm_load_edge(bbm_model *m, int edge, double fx, double fy, double pressure)
{
    bbm_line_load load = { .constant = 1, .f = { { fx, fy } }, .pressure = pressure };

    if (m->status)
        return m->status;
    if (!m->K || edge < 0 || edge >= m->edges)
        return stick(m, fail(m, BBM_BAD_INDEX, "loaded edge %d of %d", edge, m->edges));
    load.a = m->edge[edge].a;
    load.b = m->edge[edge].b;
    load.node[0] = m->vertex[load.a].node;
    load.node[1] = m->vertex[load.b].node;
    return add_line_load(m, &load);
}

/* ------------------------------------------------------------- preparing: what holds a body in statics */

/* The root of element e in the forest up[], with the path halved on the way. */
int bbm_root_of(int up[], int e)
{
    while (up[e] != e)
        e = up[e] = up[up[e]];
    return e;
}

/* The directions in which a body's fixed points hold it, as the 3x3 matrix of the rows (1, 0, -Y) and (0, 1, X) by
 * which they feel a rigid motion: regular when it is held. X, Y from one of its fixed points, over the body's reach. */
typedef struct { double G[3][3], x, y, reach; int fixed; } hold;

static void add_hold(hold *h, const bbm_node *n)
{
    const double X = (n->x - h->x) / h->reach, Y = (n->y - h->y) / h->reach;
    const double row[2][3] = { { 1, 0, -Y }, { 0, 1, X } };

    for (int r = 0; r < 2; r++)
        for (int a = 0; a < 3 && (n->held & (r == 0 ? BBM_X : BBM_Y)); a++)
            for (int b = 0; b < 3; b++)
                h->G[a][b] += row[r][a] * row[r][b];
}

/* Whether a positive semi-definite 3x3 matrix is regular, by elimination. */
static int regular(double G[3][3])
{
    for (int p = 0; p < 3; p++) {
        if (G[p][p] <= LOOSE)
            return 0;
        for (int a = p + 1; a < 3; a++)
            for (int b = p + 1; b < 3; b++)
                G[a][b] -= G[a][p] * G[p][b] / G[p][p];
    }
    return 1;
}

/* Joins what bonds and contacts connect to bodies, known by their root in up[]. That a contact holds in each direction
 * is too kind to it: a block on a slope passes. */
void bbm_join_elements(const bbm_model *m, int up[])
{
    for (int e = 0; e < m->elements; e++)
        up[e] = e;
    for (int b = 0; b < m->bonds; b++)
        up[bbm_root_of(up, m->bond[b].j)] = bbm_root_of(up, m->bond[b].i);
    for (int c = 0; c < bbm_contact_count(m); c++) {
        int pair[2];
        bbm_contact_pair(m, c, pair);
        up[bbm_root_of(up, pair[1])] = bbm_root_of(up, pair[0]);
    }
    for (int e = 0; e < m->elements; e++)
        up[e] = bbm_root_of(up, e);
}

/* Sums up the fixed points of each body. */
static void sum_holds(const bbm_model *m, int up[], hold h[])
{
    for (int v = 0; v < m->vertices; v++) {
        const bbm_node *n = &m->node[m->vertex[v].node];
        hold *body = &h[bbm_root_of(up, m->vertex[v].element)];
        if (n->held && !body->fixed)
            body->fixed = 1, body->x = n->x, body->y = n->y;
    }
    for (int v = 0; v < m->vertices; v++) {
        const bbm_node *n = &m->node[m->vertex[v].node];
        hold *body = &h[bbm_root_of(up, m->vertex[v].element)];
        body->reach = fmax(body->reach, hypot(n->x - body->x, n->y - body->y));
    }
    for (int v = 0; v < m->vertices; v++)
        add_hold(&h[bbm_root_of(up, m->vertex[v].element)], &m->node[m->vertex[v].node]);
}

/* Statics needs bodies that fixed points hold, by themselves or through contacts. */
static bbm_status check_held(bbm_model *m)
{
    int *up = calloc((size_t)m->elements, sizeof *up);
    hold *h = calloc((size_t)m->elements, sizeof *h);
    bbm_status status = BBM_OK;

    if (!up || !h) {
        status = out_of_memory(m);
    } else {
        bbm_join_elements(m, up);
        sum_holds(m, up, h);
        for (int i = 0; i < m->elements && !status; i++)
            if (bbm_root_of(up, i) == i && !regular(h[i].G)) {
                m->culprit = i;
                status = fail(m, BBM_FREE_TO_MOVE, "block %d, the body of element %d at (%g, %g)", m->element[i].block,
                              i, m->element[i].x, m->element[i].y);
            }
    }
    free(up);
    free(h);
    return status;
}

/* Whether fixed points hold every corner of an element. */
static int held_all_round(const bbm_model *m, const bbm_element *e)
{
    int held = 0;

    for (int v = e->first; v < e->first + e->n; v++)
        held += m->node[m->vertex[v].node].held == BBM_XY;
    return held == e->n;
}

/* Joins the corners that bonds tie together, in the forest up[], and counts the corners of the elements in corners[]
 * that are in the coarse space. An element without bonds is not, for there would be as many coarse unknowns as it has of
 * its own; nor is one held at every corner, which hardly moves. SSOR alone is faster for both. */
static void join_corners(const bbm_model *m, int up[], int corners[])
{
    for (int v = 0; v < m->vertices; v++)
        up[v] = v;
    for (int b = 0; b < m->bonds; b++) {
        const bbm_bond *k = &m->bond[b];
        for (int end = 0; end < 2; end++)
            up[bbm_root_of(up, k->q[end])] = bbm_root_of(up, k->p[end]);
        corners[k->i] = held_all_round(m, &m->element[k->i]) ? 0 : m->element[k->i].n;
        corners[k->j] = held_all_round(m, &m->element[k->j]) ? 0 : m->element[k->j].n;
    }
}

/* Lays out the coarse space of the solver: corners that bonds tie together are one node, so that a crack parts them. */
static bbm_status lay_out_coarse(const bbm_model *m, bbm_matrix *K)
{
    const size_t v = (size_t)m->vertices;
    int *up = calloc(3 * v + (size_t)m->elements + 1, sizeof *up), nodes = 0;

    if (!up)
        return BBM_NO_MEMORY;
    int *number = up + v, *node = number + v, *first = node + v;
    join_corners(m, up, first + 1);
    for (int e = 0; e < m->elements; e++) {
        const int corners = first[e + 1];
        for (int k = 0; k < corners; k++) {
            int *n = &number[bbm_root_of(up, m->element[e].first + k)];
            if (*n == 0)
                *n = ++nodes;
            node[first[e] + k] = *n - 1;
        }
        first[e + 1] = first[e] + corners;
    }
    const bbm_status status = bbm_matrix_coarse(K, nodes, first, node);
    free(up);
    return status;
}

/* Lays out K: a submatrix for each element, each bond and each contact, Eq. (5). Without memory the old one stays. */
static bbm_status lay_out_matrix(bbm_model *m)
{
    const int contacts = m->work ? bbm_contact_count(m) : 0, n = contacts + m->bonds;
    int (*pair)[2] = calloc((size_t)n + 1, sizeof *pair);
    int same = m->K && n == m->pairs;
    bbm_matrix *K;

    if (!pair)
        return out_of_memory(m);
    for (int k = 0; k < contacts; k++)
        bbm_contact_pair(m, k, pair[k]);
    for (int b = 0; b < m->bonds; b++) {
        pair[contacts + b][0] = m->bond[b].i;
        pair[contacts + b][1] = m->bond[b].j;
    }
    for (int k = 0; k < n && same; k++)
        same = pair[k][0] == m->pair[k][0] && pair[k][1] == m->pair[k][1];
    if (same) {
        free(pair);
        return BBM_OK;
    }
    if (bbm_matrix_new(m->elements, n, pair, &K) || lay_out_coarse(m, K)) {
        bbm_matrix_free(K);
        free(pair);
        return out_of_memory(m);
    }
    bbm_matrix_free(m->K);
    free(m->pair);
    m->K = K;
    m->pair = pair;
    m->pairs = n;
    return BBM_OK;
}

/* Refuses elements that lie in each other. */
static bbm_status check_overlap(bbm_model *m)
{
    bbm_overlap o;

    if (bbm_find_overlap(m, &o))
        return out_of_memory(m);
    if (o.i < 0)
        return BBM_OK;
    const int p = m->element[o.i].block, q = m->element[o.j].block;
    m->culprit = o.j;
    m->other = o.i;
    return fail(m, p == q ? BBM_OVERLAP : BBM_BLOCKS_OVERLAP, "%g m deep at (%g, %g): block %d with element %d, block %d "
                "with element %d", o.depth, o.x, o.y, p, o.i, q, o.j);
}

/* Checks the model and makes all that the steps need: the vertices at each node, boundary and internal edges, K. */
bbm_status bbm_prepare(bbm_model *m)
{
    bbm_status status = m->status;

    if (status)
        return status;
    free_prepared(m);
    if (m->elements == 0)
        return fail(m, BBM_NO_ELEMENT, "%d nodes", m->nodes);
    if (!status)
        status = list_meeting_vertices(m);
    if (!status)
        status = connect_elements(m);
    if (!status)
        status = check_overlap(m);
    if (!status)
        status = place_line_loads(m);
    if (!status) {
        m->F = calloc(6 * (size_t)m->elements, sizeof *m->F);
        m->D = calloc(6 * (size_t)m->elements, sizeof *m->D);
        m->load = calloc(6 * (size_t)m->elements, sizeof *m->load);
        m->end_element = calloc((size_t)m->elements, sizeof *m->element);
        m->end_vertex = calloc((size_t)m->vertices, sizeof *m->vertex);
        m->force = calloc(4 * (size_t)(m->bonds + m->vertices), sizeof *m->force);
        m->force_before = calloc(4 * (size_t)(m->bonds + m->vertices), sizeof *m->force);
        status = m->F && m->D && m->load && m->force && m->force_before && m->end_element && m->end_vertex
                     ? lay_out_matrix(m) : out_of_memory(m);
    }
    if (!status)
        status = bbm_contact_new(m) ? out_of_memory(m) : BBM_OK;
    return status;
}

/* ------------------------------------------------------------------------------- the time step, Fig. 8 */

/* Refuses parameters that mean nothing; a comparison with NaN is false, so NaN is refused too. */
static bbm_status check_parameters(bbm_model *m)
{
    const bbm_parameters *p = &m->par;
    const struct { const char *name; double value; int good; const char *expected; } check[] = {
        { "dt", p->dt, p->dt > 0, "more than 0" },
        { "steps", p->steps, p->steps >= 1, "1 or more" },
        { "tolerance", p->tolerance, p->tolerance >= 0 && isfinite(p->tolerance), "0 or more" },
        { "keep", p->keep, p->keep >= 0 && p->keep <= 1, "0 to 1" },
        { "augment", p->augment, p->augment >= 0, "0 or more" },
        { "alpha", p->alpha, p->alpha > 0 && isfinite(p->alpha), "more than 0" },
        { "gravity[0]", p->gravity[0], isfinite(p->gravity[0]), "a finite number" },
        { "gravity[1]", p->gravity[1], isfinite(p->gravity[1]), "a finite number" },
        { "shake[0]", p->shake[0], isfinite(p->shake[0]), "a finite number" },
        { "shake[1]", p->shake[1], isfinite(p->shake[1]), "a finite number" },
        { "omega", p->omega, isfinite(p->omega), "a finite number" },
        { "p_n", p->p_n, p->p_n > 0 && isfinite(p->p_n), "more than 0" },
        { "p_s", p->p_s, p->p_s > 0 && isfinite(p->p_s), "more than 0" },
        { "friction", p->friction, p->friction >= 0 && p->friction < 90, "0 to less than 90 degrees" },
        { "cohesion", p->cohesion, p->cohesion >= 0 && isfinite(p->cohesion), "0 or more" },
        { "tension", p->tension, p->tension >= 0 && isfinite(p->tension), "0 or more" },
        { "pcg.omega", p->pcg.omega, p->pcg.omega > 0 && p->pcg.omega < 2, "more than 0, less than 2" },
        { "pcg.tolerance", p->pcg.tolerance, p->pcg.tolerance > 0 && p->pcg.tolerance < 1, "more than 0, less than 1" },
        { "pcg.iterations", p->pcg.iterations, p->pcg.iterations >= 1, "1 or more" },
    };

    for (size_t i = 0; i < sizeof check / sizeof *check; i++)
        if (!check[i].good)
            return fail(m, BBM_BAD_PARAMETER, "%s = %g, expected %s", check[i].name, check[i].value, check[i].expected);
    return BBM_OK;
}

static bbm_status check_bonding(bbm_model *m)
{
    if (bbm_find_mechanism(m, &m->culprit))
        return out_of_memory(m);
    if (m->culprit < 0)
        return BBM_OK;
    return fail(m, BBM_MECHANISM, "block %d, element %d; BBM_MOMENT holds them", m->element[m->culprit].block, m->culprit);
}

/* What must hold before a step: a prepared model, parameters in their ranges, before the first one bonds that hold. */
static bbm_status check_step(bbm_model *m)
{
    if (!m->K)
        return m->status ? m->status : fail(m, BBM_BAD_PARAMETER, "bbm_prepare comes before the steps");
    const bbm_status status = check_parameters(m);
    return status || m->info.step > 0 || m->par.bonding != BBM_MIDPOINTS ? status : check_bonding(m);
}

/* ---------------------------------------------------------- bonds and fixed points of the model */

/* Whether the edge between two elements is bonded as a whole: both are quadrilaterals. */
static int is_hinge(const bbm_model *m, const bbm_bond *b)
{
    return m->par.bonding != BBM_VERTICES && m->element[b->i].n == 4 && m->element[b->j].n == 4;
}

/* The moment M that a quadrilateral asks for on its edge from vertex v on. */
static void own_moment(const bbm_model *m, const bbm_element *e, int v, double M[2][2])
{
    double own[2][2][2];

    memset(M, 0, 4 * sizeof M[0][0]);
    if (m->par.bonding != BBM_MOMENT)
        return;
    bbm_hinge_moments(e, &m->vertex[e->first], own);
    memcpy(M, own[(v - e->first) % 2], 4 * sizeof M[0][0]);
}

/* The moment M of a bond. The halves of its two elements bend one after the other, so their moments act in series: with
 * n the normal of the edge and mi = n.Mi n, M = (Mi + Mj)/2 4 mi mj/(mi + mj)^2, whose n.M n is the harmonic mean. */
static void bond_moment(const bbm_model *m, const bbm_bond *b, double M[2][2])
{
    const bbm_vertex *P = &m->vertex[b->p[0]], *R = &m->vertex[b->p[1]];
    const double nx = R->y - P->y, ny = P->x - R->x;
    double Mi[2][2], Mj[2][2];

    own_moment(m, &m->element[b->i], b->p[0], Mi);
    own_moment(m, &m->element[b->j], b->q[1], Mj);              /* the edge runs the other way in j */
    const double mi = nx * nx * Mi[0][0] + nx * ny * (Mi[0][1] + Mi[1][0]) + ny * ny * Mi[1][1];
    const double mj = nx * nx * Mj[0][0] + nx * ny * (Mj[0][1] + Mj[1][0]) + ny * ny * Mj[1][1];
    const double sum = mi + mj, series = sum > 0 ? 4 * (mi / sum) * (mj / sum) : 0;
    for (int a = 0; a < 4; a++)
        M[a / 2][a % 2] = series * (Mi[a / 2][a % 2] + Mj[a / 2][a % 2]) / 2;
}

/* The bonding submatrices of one bond: at both vertices, or of the edge as a whole. */
static void add_bond(const bbm_model *m, const bbm_bond *b, bbm_submatrices *s)
{
    const bbm_element *i = &m->element[b->i], *j = &m->element[b->j];
    const bbm_vertex *const P[2] = { &m->vertex[b->p[0]], &m->vertex[b->p[1]] };
    const bbm_vertex *const Q[2] = { &m->vertex[b->q[0]], &m->vertex[b->q[1]] };
    const double k = bbm_bonding_stiffness(m->par.alpha, i, j);
    bbm_hinge h = { { { 2 * k, 0 }, { 0, 2 * k } }, { { 0 } } };

    if (is_hinge(m, b)) {
        bond_moment(m, b, h.M);
        bbm_hinge_submatrices(i, P, j, Q, &h, s);
    } else {
        for (int end = 0; end < 2; end++)
            bbm_bonding_submatrices(i, P[end], j, Q[end], k, s);
    }
}

static int next_vertex(const bbm_element *e, int v)
{
    return v + 1 < e->first + e->n ? v + 1 : e->first;
}

/* The directions in which the edge from vertex v on is held as a whole: those of both its ends, in a quadrilateral that is
 * bonded that way. Held at its vertices, such an edge locks like a bond. */
static int held_edge(const bbm_model *m, const bbm_element *e, int v)
{
    if (m->par.bonding == BBM_VERTICES || e->n != 4)
        return 0;
    return m->node[m->vertex[v].node].held & m->node[m->vertex[next_vertex(e, v)].node].held;
}

/* The directions in which vertex v is held by itself: those in which no edge holds it. */
static int held_vertex(const bbm_model *m, const bbm_element *e, int v)
{
    const int last = v > e->first ? v - 1 : e->first + e->n - 1;

    return m->node[m->vertex[v].node].held & ~(held_edge(m, e, v) | held_edge(m, e, last));
}

/* The wall at vertex v as the vertex of an element that keeps still, section 3.4. */
static bbm_vertex wall_vertex(const bbm_model *m, int v)
{
    bbm_vertex Q = m->vertex[v];

    Q.u = m->node[Q.node].wall[0];
    Q.v = m->node[Q.node].wall[1];
    return Q;
}

/* The edge from vertex v on, held in the given directions: a bond with the wall, whose mirror image bends alike, so
 * that the moment is twice the element's own. */
static void hold_edge(const bbm_model *m, const bbm_element *e, int v, int directions, bbm_submatrix *s)
{
    const int next = next_vertex(e, v), in[2] = { directions & BBM_X, directions & BBM_Y };
    const bbm_vertex Q0 = wall_vertex(m, v), Q1 = wall_vertex(m, next);
    const bbm_vertex *const P[2] = { &m->vertex[v], &m->vertex[next] }, *const Q[2] = { &Q0, &Q1 };
    const double k = bbm_fixed_stiffness(m->par.alpha, e);
    bbm_hinge h = { { { 2 * k, 0 }, { 0, 2 * k } }, { { 0 } } };
    bbm_submatrices both = { { { 0 } }, { { 0 } }, { { 0 } }, { 0 }, { 0 } };

    own_moment(m, e, v, h.M);
    for (int a = 0; a < 4; a++) {
        h.M[a / 2][a % 2] *= 2;
        if (!in[a / 2] || !in[a % 2])
            h.K[a / 2][a % 2] = h.M[a / 2][a % 2] = 0;
    }
    bbm_hinge_submatrices(e, P, e, Q, &h, &both);
    for (int a = 0; a < 6; a++) {
        for (int b = 0; b < 6; b++)
            s->K[a][b] += both.Kii[a][b];
        s->F[a] += both.Fi[a];
    }
}

/* The fixed points of one element. */
static void hold_element(const bbm_model *m, const bbm_element *e, bbm_submatrix *s)
{
    for (int v = e->first; v < e->first + e->n; v++) {
        bbm_node W = m->node[m->vertex[v].node];
        if (!W.held)
            continue;
        W.held = held_vertex(m, e, v);
        bbm_fixed_submatrix(e, &m->vertex[v], &W, bbm_fixed_stiffness(m->par.alpha, e), s);
        if (held_edge(m, e, v))
            hold_edge(m, e, v, held_edge(m, e, v), s);
    }
}

/* --------------------------------------------------------------- beyond the paper: bonds that do not give
 * A spring opens under the force that it carries. Deviation: with a multiplier that carries the force in its place it
 * need not: solve, add to each multiplier the force of its spring, f += k d, put f on the right of K D = F in place of the
 * spring's force, solve again (the augmented Lagrangian of Hestenes and Powell; the paper names it for contacts).
 * K stays, and so does all that was made of it. */

/* What a multiplier f makes meet: the mean of P[0], P[1] and that of Q[0], Q[1], or the wall (Q NULL). */
typedef struct { int P[2], Q[2], wall, directions; double k, *f; } condition;

static int bond_conditions(const bbm_model *m, int number, condition c[2])
{
    const bbm_bond *b = &m->bond[number];
    const double k = bbm_bonding_stiffness(m->par.alpha, &m->element[b->i], &m->element[b->j]);
    double *f = &m->force[4 * number];

    if (is_hinge(m, b)) {
        c[0] = (condition){ { b->p[0], b->p[1] }, { b->q[0], b->q[1] }, 0, BBM_XY, 2 * k, f };
        return 1;
    }
    for (int end = 0; end < 2; end++)
        c[end] = (condition){ { b->p[end], b->p[end] }, { b->q[end], b->q[end] }, 0, BBM_XY, k, f + 2 * end };
    return 2;
}

static int vertex_conditions(const bbm_model *m, int v, condition c[2])
{
    const bbm_element *e = &m->element[m->vertex[v].element];
    const double k = bbm_fixed_stiffness(m->par.alpha, e);
    double *f = &m->force[4 * (m->bonds + v)];

    if (!m->node[m->vertex[v].node].held)
        return 0;
    c[0] = (condition){ { v, v }, { v, v }, 1, held_vertex(m, e, v), k, f };
    c[1] = (condition){ { v, next_vertex(e, v) }, { v, next_vertex(e, v) }, 1, held_edge(m, e, v), 2 * k, f + 2 };
    return 2;
}

/* Vertex v, or its wall point, after the step, as a displacement from the start. */
static void moved_vertex(const bbm_model *m, int v, int wall, double u[2])
{
    const bbm_vertex *p = &m->vertex[v];
    double T[2][6], at[2];

    if (wall) {
        memcpy(u, m->node[p->node].wall, 2 * sizeof *u);
        return;
    }
    bbm_middle_matrix(&m->element[p->element], p->x, p->y, T, at);
    for (int r = 0; r < 2; r++) {
        u[r] = r == 0 ? p->u : p->v;
        for (int a = 0; a < 6; a++)
            u[r] += T[r][a] * m->D[6 * p->element + a];
    }
}

/* f += k d */
static void take_over_force(const bbm_model *m, const condition *c)
{
    for (int end = 0; end < 2; end++) {
        double P[2], Q[2];
        moved_vertex(m, c->P[end], 0, P);
        moved_vertex(m, c->Q[end], c->wall, Q);
        for (int r = 0; r < 2; r++)
            if (c->directions & (r == 0 ? BBM_X : BBM_Y))
                c->f[r] += c->k * (P[r] - Q[r]) / 2;
    }
}

/* F_i -= T_i^T f, F_j += T_j^T f */
static void load_multiplier(bbm_model *m, const condition *c)
{
    const double pull[2] = { c->f[0] / 2, c->f[1] / 2 }, push[2] = { -pull[0], -pull[1] };

    for (int end = 0; end < 2; end++) {
        const bbm_vertex *P = &m->vertex[c->P[end]], *Q = &m->vertex[c->Q[end]];
        bbm_point_load(&m->element[P->element], P, push, &m->F[6 * P->element]);
        if (!c->wall)
            bbm_point_load(&m->element[Q->element], Q, pull, &m->F[6 * Q->element]);
    }
}

/* Does one of the two with every multiplier. */
static void visit_multipliers(bbm_model *m, int take_over)
{
    condition c[2];

    for (int k = 0; k < m->bonds + m->vertices; k++) {
        const int n = k < m->bonds ? bond_conditions(m, k, c) : vertex_conditions(m, k - m->bonds, c);
        for (int a = 0; a < n; a++) {
            if (take_over)
                take_over_force(m, &c[a]);
            else
                load_multiplier(m, &c[a]);
        }
    }
}

/* Gravity and the concentrated loads of one element. */
static void load_element(bbm_model *m, int i)
{
    const bbm_element *e = &m->element[i];
    const double M = mass_per_area(e), weight[2] = { M * m->gravity[0], M * m->gravity[1] };

    bbm_volume_submatrix(e, weight, &m->load[6 * i]);
    for (int v = e->first; v < e->first + e->n; v++) {
        const int n = m->vertex[v].node, meeting = m->meet_first[n + 1] - m->meet_first[n];
        const double share[2] = { m->node[n].load[0] / meeting, m->node[n].load[1] / meeting };
        bbm_point_load(e, &m->vertex[v], share, &m->load[6 * i]);
    }
}

/* The sources of energy inside one element: strain, inertia, fixed points. */
static bbm_status assemble_element(bbm_model *m, int i)
{
    const bbm_element *e = &m->element[i];
    bbm_submatrix s = { { { 0 } }, { 0 } };

    bbm_elastic_submatrix(e, &s);
    bbm_inertia_submatrix(e, m->h, &s);
    hold_element(m, e, &s);
    for (int a = 0; a < 6; a++)
        m->F[6 * i + a] += s.F[a];
    return m->keep_K ? BBM_OK : bbm_matrix_add(m->K, i, i, s.K);
}

/* Adds the submatrices of a pair of elements to F, and to K unless it is kept. */
bbm_status bbm_add_submatrices(bbm_model *m, int i, int j, bbm_submatrices *s)
{
    bbm_status status = BBM_OK;

    for (int a = 0; a < 6; a++) {
        m->F[6 * i + a] += s->Fi[a];
        m->F[6 * j + a] += s->Fj[a];
    }
    if (!m->keep_K)
        status = bbm_matrix_add(m->K, i, i, s->Kii);
    if (!m->keep_K && !status)
        status = bbm_matrix_add(m->K, i, j, s->Kij);
    if (!m->keep_K && !status)
        status = bbm_matrix_add(m->K, j, j, s->Kjj);
    return status;
}

/* Whether the step is long enough for two levels to pay: in a short one inertia holds every element by itself, and
 * SSOR alone needs no more iterations than a wave, of speed sqrt(E/density), needs to cross some elements. */
static int long_step(const bbm_model *m)
{
    for (int b = 0; b < m->bonds; b++) {
        const bbm_element *e = &m->element[m->bond[b].i];
        const double way2 = e->material.E / e->material.density * m->h * m->h;
        if (way2 > CROSSED * CROSSED * e->A && !held_all_round(m, e))
            return 1;
    }
    return 0;
}

/* The coarse space of the present geometry. Elements that are not in it are refused, which does no harm. */
static void interpolate_elements(bbm_model *m)
{
    double P[6][2];

    for (int i = 0; i < m->elements; i++) {
        const bbm_element *e = &m->element[i];
        const int middles = m->par.bonding != BBM_VERTICES && e->n == 4;
        for (int a = 0; a < e->n; a++) {
            bbm_interpolation(e, &m->vertex[e->first], middles, a, P);
            if (bbm_matrix_interpolate(m->K, i, a, P))
                break;
        }
    }
}

static bbm_status assemble_bond(bbm_model *m, const bbm_bond *b)
{
    bbm_submatrices s = { { { 0 } }, { { 0 } }, { { 0 } }, { 0 }, { 0 } };

    add_bond(m, b, &s);
    return bbm_add_submatrices(m, b->i, b->j, &s);
}

/* The block lies on the left of a pressed edge, from a to b: the pressure pushes that way. With the edge as it lies
 * in the middle of the step its work is p times the area that the edge sweeps. */
static void load_line(bbm_model *m, const bbm_line_load *l)
{
    const int i = m->vertex[l->a].element;
    const bbm_vertex *a = &m->vertex[l->a], *b = &m->vertex[l->b];
    const double p = l->pressure / hypot(b->x - a->x, b->y - a->y);

    if (l->constant) {
        double T[2][6], am[2], bm[2];
        bbm_middle_matrix(&m->element[i], a->x, a->y, T, am);
        bbm_middle_matrix(&m->element[i], b->x, b->y, T, bm);
        const double f[2] = { l->f[0][0] - p * (bm[1] - am[1]), l->f[0][1] + p * (bm[0] - am[0]) };
        bbm_constant_load_submatrix(&m->element[i], a, b, f, &m->load[6 * i]);
    } else {
        bbm_varying_load_submatrix(&m->element[i], a, b, l->f, &m->load[6 * i]);
    }
}

/* Gravity of the step, less the acceleration of the base at its end, in which the model is at rest. */
static void find_gravity(bbm_model *m)
{
    const bbm_parameters *p = &m->par;
    const double swing = isinf(m->h) ? 0 : sin(p->omega * (m->info.t + m->h));

    for (int a = 0; a < 2; a++)
        m->gravity[a] = p->gravity[a] - p->shake[a] * swing;
}

/* The part of F that comes from outside: gravity, 3.5, 3.6. */
static void gather_loads(bbm_model *m)
{
    memset(m->load, 0, 6 * (size_t)m->elements * sizeof *m->load);
    for (int i = 0; i < m->elements; i++)
        load_element(m, i);
    for (int l = 0; l < m->line_loads; l++)
        load_line(m, &m->line_load[l]);
}

/* K, unless it is kept, and F of the present geometry, Eq. (5). */
static bbm_status assemble(bbm_model *m)
{
    bbm_status status = BBM_OK;

    if (!m->keep_K) {
        gather_loads(m);
        bbm_matrix_clear(m->K);
    }
    memcpy(m->F, m->load, 6 * (size_t)m->elements * sizeof *m->F);
    if (!m->keep_K && m->par.pcg.form == BBM_TWO_LEVEL && long_step(m))
        interpolate_elements(m);
    for (int i = 0; i < m->elements && !status; i++)
        status = assemble_element(m, i);
    for (int b = 0; b < m->bonds && !status; b++)
        status = assemble_bond(m, &m->bond[b]);
    if (m->par.augment > 0)
        visit_multipliers(m, 0);
    return status ? status : bbm_assemble_contacts(m);
}

/* What went wrong in a solution becomes a sentence with the numbers. */
static bbm_status describe_failure(bbm_model *m, bbm_status status)
{
    const bbm_pcg_info *i = &m->info.pcg;
    const int step = m->info.step + 1;

    if (status == BBM_NOT_FINITE)
        return fail(m, status, "step %d, a load, velocity, stress or stiffness is too large", step);
    if (i->element >= 0)
        return fail(m, status, "step %d, element %d of block %d: it has turned over, or the stiffnesses that meet "
                    "there are too far apart", step, i->element, m->element[i->element].block);
    return fail(m, status, "step %d, %d iterations, residual %.2g%s", step, i->iterations, i->residual,
                status == BBM_NOT_CONVERGED ? "; more iterations or a smaller alpha help" : "");
}

/* Solves K D = F, Eq. (5). */
static bbm_status solve(bbm_model *m)
{
    const bbm_pcg_info *i = &m->info.pcg;
    bbm_pcg pcg = m->par.pcg;

    if (pcg.form == BBM_TWO_LEVEL && !long_step(m))
        pcg.form = BBM_EISENSTAT;
    if (m->watch && m->watch(m, m->watch_context))
        return fail(m, BBM_STOPPED, "step %d", m->info.step + 1);
    const bbm_status status = bbm_solve(m->K, m->F, m->D, &pcg, &m->info.pcg);
    m->info.iterations += i->iterations;
    m->info.seconds[BBM_PRECONDITION] += i->seconds[0];
    m->info.seconds[BBM_ITERATE] += i->seconds[1];
    return status ? describe_failure(m, status) : BBM_OK;
}

/* How a point at X from the barycentre moves: translation, strain, then exact rotation by r0,
 * u = (u0, v0) + R(r0) (1 + e) X - X. The paper's u = T D is its first order in r0, by which a turning block
 * swells. Deviation: the positions are updated by the exact form. */
void bbm_move(const bbm_model *m, const bbm_element *e, const double D[6], double x, double y, double u[2])
{
    const double X = x - e->x, Y = y - e->y;
    const double ux = D[3] * X + D[5] / 2 * Y, uy = D[5] / 2 * X + D[4] * Y;

    if (m->par.rotation == BBM_EXACT && !isinf(m->h)) {
        const double s = sin(D[2]), c1 = -2 * sin(D[2] / 2) * sin(D[2] / 2);
        u[0] = D[0] + ux + c1 * (X + ux) - s * (Y + uy);
        u[1] = D[1] + uy + c1 * (Y + uy) + s * (X + ux);
    } else {
        u[0] = D[0] + ux - D[2] * Y;
        u[1] = D[1] + uy + D[2] * X;
    }
}

/* A tensor (xx, yy, xy) turns with the element: R s R^T. */
static void turn_tensor(double s[3], double r)
{
    const double c = cos(2 * r), n = sin(2 * r), mean = (s[0] + s[1]) / 2, half = (s[0] - s[1]) / 2, t = s[2];

    s[0] = mean + half * c - t * n;
    s[1] = mean - half * c + t * n;
    s[2] = half * n + t * c;
}

/* int u.M u dA of a field u = T V. */
static double inertia_form(const bbm_element *e, const double V[6])
{
    double TT[6][6], sum = 0;

    bbm_mode_integral(e, TT);
    for (int a = 0; a < 6; a++)
        for (int b = 0; b < 6; b++)
            sum += V[a] * TT[a][b] * V[b];
    return mass_per_area(e) * sum;
}

/* Stress and strain rates turn with an element that has moved, and the change of its moments by strain, which no force of
 * the step knows of, changes no energy: turning and straining slow down or speed up together. */
static void turn_element(const bbm_element *start, bbm_element *e, const bbm_vertex vertex[])
{
    double rate[3] = { e->V[3], e->V[4], e->V[5] / 2 }, turning[6] = { 0, 0, e->V[2], e->V[3], e->V[4], e->V[5] };
    bbm_element end = *e;

    const double before = inertia_form(start, turning);
    turn_tensor(e->stress, e->D[2]);
    turn_tensor(rate, e->D[2]);
    turning[3] = rate[0], turning[4] = rate[1], turning[5] = 2 * rate[2];
    bbm_element_geometry(&end, vertex);
    const double after = inertia_form(&end, turning), factor = after > 0 ? sqrt(before / after) : 1;
    for (int a = 2; a < 6; a++)
        e->V[a] = factor * turning[a];
}

/* Moves one element of the step's end by its D: vertices, stress by E e, Eq. (7), (8), velocity by Eq. (14). Deviation:
 * stress and strain rates turn with the element. */
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
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++)
            e->stress[a] += E[a][b] * e->D[3 + b];
    bbm_newmark_velocity(e, m->h, m->par.keep);
    if (bbm_is_exact(m))
        turn_element(&start, e, vertex);
    for (int a = 0; a < 3; a++)
        e->sum[a] += e->D[a];
}

/* The model at the end of the step, each element moved by its place in D, Eq. (3): a second one that shares all but what
 * moves; the first stays as it is. */
static bbm_model move_model(const bbm_model *m)
{
    bbm_model end = *m;

    end.element = m->end_element;
    end.vertex = m->end_vertex;
    end.contact = bbm_list_contacts(m, &end.contacts);
    end.info.step++;
    memcpy(end.element, m->element, (size_t)m->elements * sizeof *m->element);
    memcpy(end.vertex, m->vertex, (size_t)m->vertices * sizeof *m->vertex);
    for (int i = 0; i < m->elements; i++) {
        memcpy(end.element[i].D, &m->D[6 * i], sizeof end.element[i].D);
        update_element(m, &end.element[i], &end.vertex[end.element[i].first]);
    }
    return end;
}

/* Makes the step's end the present; how small the step was against all so far, Eq. (71), is left in info.change. */
static void update(bbm_model *m, const bbm_model *end)
{
    double step2 = 0, sum2 = 0;

    memcpy(m->element, end->element, (size_t)m->elements * sizeof *m->element);
    memcpy(m->vertex, end->vertex, (size_t)m->vertices * sizeof *m->vertex);
    for (int i = 0; i < m->elements; i++) {
        const bbm_element *e = &m->element[i];
        for (int a = 0; a < 6; a++)
            m->info.work += m->load[6 * i + a] * e->D[a];
        step2 += e->D[0] * e->D[0] + e->D[1] * e->D[1];
        sum2 += e->sum[0] * e->sum[0] + e->sum[1] * e->sum[1];
    }
    memcpy(m->force_before, m->force, 4 * (size_t)(m->bonds + m->vertices) * sizeof *m->force);
    m->info.change = sum2 > 0 ? sqrt(step2 / sum2) : 0;
    m->info.t += isinf(m->h) ? 0 : m->h;
}

/* Counts the CPU time since `since` for a phase. */
static void count_time(bbm_model *m, int phase, clock_t since)
{
    m->info.seconds[phase] += (double)(clock() - since) / CLOCKS_PER_SEC;
}

/* The energy balance of the step that ends in `end`, and a sentence if it is broken. */
static bbm_status check_balance(bbm_model *m, const bbm_model *end)
{
    double gain, there;
    const bbm_status status = bbm_check_balance(m, end, &gain, &there);

    return status ? fail(m, status, "step %d at t = %g, dt cut to %g: %g J more than its loads' work, of %g J",
                         m->info.step + 1, m->info.t, m->h, gain, there) : BBM_OK;
}

/* Whether the solution solves the equations, and turns and strains no element too far; a comparison with NaN is false. */
static bbm_status check_solution(bbm_model *m)
{
    const double most = isinf(m->h) ? 1 : FAR_STRAIN;
    int far = -1;

    for (int i = 0; i < m->elements; i++)
        for (int a = 3; a < 6; a++)
            if (!(fabs(m->D[6 * i + a]) < most))
                far = i;
    for (int b = 0; b < m->bonds && !isinf(m->h); b++)
        if (!(fabs(m->D[6 * m->bond[b].i + 2]) <= FAR_TURN) || !(fabs(m->D[6 * m->bond[b].j + 2]) <= FAR_TURN))
            far = m->bond[b].i;
    if (far < 0 && (m->par.pcg.tolerance > UNSOLVED || m->info.pcg.residual <= UNSOLVED))
        return BBM_OK;
    if (far < 0)
        return fail(m, BBM_NOT_CONVERGED, "step %d, residual %.2g: the stiffnesses of materials, bonds and contacts are too "
                    "far apart", m->info.step + 1, m->info.pcg.residual);
    const double *D = &m->D[6 * far], strain = fmax(fmax(fabs(D[3]), fabs(D[4])), fabs(D[5]));
    return fail(m, BBM_STEP_TOO_LONG, "step %d: element %d of block %d strains by %.2g and turns by %.2g rad; %s",
                m->info.step + 1, far, m->element[far].block, strain, fabs(D[2]), isinf(m->h)
                ? "in statics smaller loads or a larger E help" : "a smaller dt, velocity or load helps");
}

/* Whether the step has had all the work that it may take. */
static int is_spent(const bbm_model *m)
{
    return m->info.passes >= SOLUTIONS || m->info.iterations / ITERATIONS >= m->par.pcg.iterations;
}

/* The contacts have not settled; in dynamics perhaps because the solution goes too far. */
static bbm_status unsettled(bbm_model *m)
{
    if (!isinf(m->h) && check_solution(m) == BBM_STEP_TOO_LONG)
        return BBM_STEP_TOO_LONG;
    if (isinf(m->h))
        return fail(m, BBM_OPEN_CLOSE, "step %d of statics, %d passes, %d contacts; dynamic with damping 0 (keep = 0) may "
                    "find an equilibrium", m->info.step + 1, m->info.passes, bbm_contact_count(m));
    return fail(m, BBM_OPEN_CLOSE, "step %d at t = %g, dt cut to %g, %d passes, %d contacts", m->info.step + 1, m->info.t,
                m->h, m->info.passes, bbm_contact_count(m));
}

/* Assembles and solves until the contacts have settled and the vectors are those of the step's middle, and then once more
 * for each round of multipliers, which change F alone: K and all that the solver made of it are kept. Deviation: in
 * dynamics each step starts its multipliers from zero. Kept, they would be an integral controller, and in short steps
 * unstable (doc/limits.md). */
static bbm_status settle_contacts(bbm_model *m)
{
    clock_t start = clock();
    bbm_pass pass = BBM_PASS_AGAIN;
    bbm_status status = lay_out_matrix(m);
    const size_t forces = 4 * (size_t)(m->bonds + m->vertices) * sizeof *m->force;

    if (isinf(m->h))
        memcpy(m->force, m->force_before, forces);
    else
        memset(m->force, 0, forces);
    m->keep_K = 0;
    for (int rounds = 0; !status && pass == BBM_PASS_AGAIN;) {
        status = assemble(m);
        count_time(m, BBM_ASSEMBLE, start);
        if (!status)
            status = solve(m);
        if (!status)
            status = bbm_open_close(m, &pass);
        m->keep_K = 0;
        if (!status && pass == BBM_PASS_DONE && rounds++ < m->par.augment) {
            visit_multipliers(m, 1);
            m->keep_K = 1;
            pass = BBM_PASS_AGAIN;
        }
        if (is_spent(m) && pass == BBM_PASS_AGAIN)
            pass = BBM_PASS_GIVE_UP;
        start = clock();
    }
    return !status && pass == BBM_PASS_GIVE_UP ? unsettled(m) : status;
}

/* Whether the springs of all contacts keep their blocks apart. */
static bbm_status check_depth(bbm_model *m)
{
    const bbm_contact *c = NULL;

    if (!(bbm_deepest_contact(m, &c) > DEEP))
        return BBM_OK;
    return fail(m, BBM_TOO_SOFT, "step %d: a corner of block %d is %.2g m deep in block %d, a tenth of the smaller one; larger "
                "stiffnesses p_n, p_s help", m->info.step + 1, m->edge[c->corner].block, -c->d_n, m->edge[c->edge].block);
}

/* Whether the equations, or the states of the contacts, had no end. */
static int is_lost(bbm_status s)
{
    return s == BBM_NOT_POSITIVE_DEFINITE || s == BBM_NOT_CONVERGED || s == BBM_NOT_FINITE || s == BBM_OPEN_CLOSE;
}

/* In statics all contacts of a block may begin to slide in one pass, and nothing holds it then, though not all would have
 * to: the second attempt lets one contact change in each pass, so that the others can take over. */
static bbm_status settle_once_more(bbm_model *m)
{
    bbm_status status = settle_contacts(m);

    if (is_lost(status) && isinf(m->h)) {
        status = bbm_start_again(m);
        if (!status)
            status = settle_contacts(m);
    }
    return status;
}

/* Statics that fails because a block is loose says so, and who. */
static bbm_status explain(bbm_model *m, bbm_status status)
{
    const double h = bbm_long_step(m);
    bbm_pcg pcg = m->par.pcg;
    bbm_pcg_info info;
    int pair[2];

    if (!isinf(m->h) || (!is_lost(status) && status != BBM_STEP_TOO_LONG))
        return status;
    m->h = h;
    m->keep_K = 0;
    const bbm_status assembled = assemble(m);
    m->h = INFINITY;
    pcg.form = BBM_EISENSTAT;
    if (assembled)
        return assembled;
    bbm_push_all(m);
    if (bbm_solve(m->K, m->F, m->D, &pcg, &info) || !bbm_find_loose(m, h, pair))
        return status;
    m->culprit = pair[0];
    m->other = pair[1];
    const int block = m->element[pair[0]].block;
    if (pair[1] < 0)
        return fail(m, BBM_NO_EQUILIBRIUM, "block %d (element %d) is free to move; hold it, or use dynamics", block,
                    pair[0]);
    return fail(m, BBM_NO_EQUILIBRIUM, "block %d (element %d) slides, rolls, tips on or leaves block %d (element %d); raise the "
                "friction, hold it, or use dynamics", block, pair[0], m->element[pair[1]].block, pair[1]);
}

/* Fig. 8 once with the step m->h. Nothing moves before all has gone well: a solution that moves further than its
 * contacts were looked for is the next guess, and if they outrun it again and again the step has not settled. */
static bbm_status try_step(bbm_model *m)
{
    enum { DETECTIONS = 8 };
    bbm_status status = BBM_OK;
    int foreseen = 0;

    for (int i = 0; i < m->elements; i++)
        bbm_element_geometry(&m->element[i], &m->vertex[m->element[i].first]);
    find_gravity(m);
    bbm_guess_step(m);
    for (int k = 0; k < DETECTIONS && !status && !foreseen; k++) {
        const clock_t start = clock();
        status = bbm_detect_contacts(m, &foreseen);             /* the same list as before: the solution holds */
        count_time(m, BBM_DETECT, start);
        if (status || foreseen)
            break;
        bbm_set_middle(m, bbm_guess(m));
        if (isinf(m->h))
            status = check_held(m);
        if (!status)
            status = settle_once_more(m);
        foreseen = !status && !bbm_moved_too_far(m);
    }
    if (!status)
        status = foreseen ? check_solution(m) : unsettled(m);
    if (!status)
        status = check_depth(m);
    if (status)
        return explain(m, status);
    const bbm_model end = move_model(m);
    status = check_balance(m, &end);
    if (status)
        return status;
    update(m, &end);
    return bbm_keep_contacts(m);
}

/* Whether every body is held, by itself or through contacts: what a static step finds out before it solves. */
bbm_status bbm_check_held(bbm_model *m)
{
    bbm_status status = check_step(m);

    m->h = INFINITY;
    if (!status) {
        bbm_guess_step(m);
        status = bbm_detect_contacts(m, NULL);
    }
    return status == BBM_OK ? check_held(m) : status == BBM_NO_MEMORY ? out_of_memory(m) : status;
}

/* One time step. If the contacts do not settle, the step makes energy, or elements turn or strain too far, dt is halved
 * and the step done again, down to dt/1024, as long as that takes no more than some solutions; the nominal step
 * is completed in parts, which grow again. When it fails, the model is that of the last part that went well. */
bbm_status bbm_step(bbm_model *m)
{
    enum { PARTS = 1024 };
    int left = PARTS, part = PARTS;
    bbm_status status = check_step(m);

    m->info.passes = m->info.cuts = m->info.iterations = 0;
    while (!status && left > 0) {
        m->h = isinf(m->par.dt) ? m->par.dt : m->par.dt * part / PARTS;
        status = try_step(m);
        const int again = status == BBM_OPEN_CLOSE || status == BBM_ENERGY || status == BBM_STEP_TOO_LONG
                          || status == BBM_NOT_FINITE || status == BBM_NOT_POSITIVE_DEFINITE;
        if (again && part > 1 && !isinf(m->par.dt) && !is_spent(m)) {
            part /= 2;
            m->info.cuts++;
            m->message[0] = '\0';
            status = BBM_OK;
            continue;
        }
        left -= part;
        if (left > 0 && (left / part) % 2 == 0 && part < PARTS)
            part *= 2;
    }
    if (!status)
        m->info.step++;
    return status == BBM_NO_MEMORY ? out_of_memory(m) : status;
}

/* All time steps. With a tolerance they end when the step has become small against the sum of all, Eq. (71):
 * sqrt(sum |step_i|^2) <= tolerance sqrt(sum |total_i|^2) over the barycentres i. */
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
        return fail(m, BBM_STEPS_EXHAUSTED, "change %.2g after step %d, expected %.2g", m->info.change, m->info.step,
                    m->par.tolerance);
    return BBM_OK;
}

/* ------------------------------------------------------------------------------- results, section 4 */

/* von Mises stress in plane stress. */
double bbm_mises(const double s[3])
{
    return sqrt(s[0] * s[0] - s[0] * s[1] + s[1] * s[1] + 3 * s[2] * s[2]);
}

/* Displacement and stress at a grid point: the mean over the elements of a block (-1: of all) that meet there. */
bbm_status bbm_nodal_result(const bbm_model *m, int node, int block, bbm_result *r)
{
    int count = 0;

    *r = (bbm_result){ 0 };
    if (!m->K || !known_node(m, node))
        return BBM_BAD_INDEX;
    for (int a = m->meet_first[node]; a < m->meet_first[node + 1]; a++) {
        const bbm_vertex *v = &m->vertex[m->meet[a]];
        const bbm_element *e = &m->element[v->element];
        if (block >= 0 && e->block != block)
            continue;
        r->u += v->u;
        r->v += v->v;
        for (int k = 0; k < 3; k++)
            r->stress[k] += e->stress[k];
        count++;
    }
    if (count == 0)
        return BBM_BAD_INDEX;
    r->u /= count;
    r->v /= count;
    for (int k = 0; k < 3; k++)
        r->stress[k] /= count;
    r->mises = bbm_mises(r->stress);
    return BBM_OK;
}

/* ------------------------------------------------------------------------------------------------ energies */

/* 1/2 int V.M V dA of the present geometry, Eq. (11) with the velocity in place of the acceleration. A step hands on a share `keep` of V. */
static double kinetic_energy(const bbm_model *m, const bbm_element *e)
{
    const double keep = m->info.step > 0 ? m->par.keep : 1;
    bbm_element now = *e;
    double V[6];

    bbm_element_geometry(&now, &m->vertex[e->first]);
    for (int a = 0; a < 6; a++)
        V[a] = keep > 0 ? e->V[a] / keep : 2 / m->h * e->D[a];
    return inertia_form(&now, V) / 2;
}

/* 1/2 int stress.strain dA, with Hooke's law (7) the other way round. */
static double elastic_energy(const bbm_element *e)
{
    const double *s = e->stress, E = e->material.E, nu = e->material.nu;
    const double work = (s[0] * s[0] + s[1] * s[1] - 2 * nu * s[0] * s[1] + 2 * (1 + nu) * s[2] * s[2]) / E;

    return e->material.thickness * e->A0 * work / 2;
}

/* 1/2 (f + k d).d of what a multiplier f makes meet: from zero in each step it is part of a stiffer spring. */
static double condition_energy(const bbm_model *m, const condition *c)
{
    double d[2] = { 0, 0 };

    for (int end = 0; end < 2; end++) {
        const bbm_vertex *P = &m->vertex[c->P[end]], *Q = &m->vertex[c->Q[end]];
        const double *W = m->node[Q->node].wall;
        d[0] += (P->u - (c->wall ? W[0] : Q->u)) / 2;
        d[1] += (P->v - (c->wall ? W[1] : Q->v)) / 2;
    }
    return ((c->directions & BBM_X ? (c->f[0] + c->k * d[0]) * d[0] : 0)
            + (c->directions & BBM_Y ? (c->f[1] + c->k * d[1]) * d[1] : 0)) / 2;
}

/* 1/2 dd.M dd of a bond of a whole edge, dd = (d1 - d2)/2. */
static double moment_energy(const bbm_model *m, const bbm_bond *b)
{
    const bbm_vertex *P = &m->vertex[b->p[0]], *R = &m->vertex[b->p[1]];
    const bbm_vertex *Q = &m->vertex[b->q[0]], *S = &m->vertex[b->q[1]];
    const double d[2] = { (P->u - Q->u - R->u + S->u) / 2, (P->v - Q->v - R->v + S->v) / 2 };
    double M[2][2];

    bond_moment(m, b, M);
    return (d[0] * (M[0][0] * d[0] + M[0][1] * d[1]) + d[1] * (M[1][0] * d[0] + M[1][1] * d[1])) / 2;
}

/* The same for an edge that is held: twice the element's own M, in the directions in which it is held. */
static double held_moment_energy(const bbm_model *m, const bbm_element *e, int v)
{
    const int held = held_edge(m, e, v);
    const bbm_vertex *P = &m->vertex[v], *R = &m->vertex[next_vertex(e, v)];
    const double *Q = m->node[P->node].wall, *S = m->node[R->node].wall;
    const double d[2] = { held & BBM_X ? (P->u - Q[0] - R->u + S[0]) / 2 : 0,
                          held & BBM_Y ? (P->v - Q[1] - R->v + S[1]) / 2 : 0 };
    double M[2][2];

    if (!held)
        return 0;
    own_moment(m, e, v, M);
    return d[0] * (M[0][0] * d[0] + M[0][1] * d[1]) + d[1] * (M[1][0] * d[0] + M[1][1] * d[1]);
}

/* What the springs of a contact hold; friction holds what its shear spring would, see bbm_keep_contacts. */
static double contact_energy(const bbm_parameters *p, const bbm_contact *c)
{
    const double T = c->state == BBM_SLIDE ? bbm_shear_strength(p, c->N, c->area) : c->T;

    return c->state == BBM_OPEN ? 0 : c->N * c->N / (2 * p->p_n) + T * T / (2 * p->p_s);
}

/* The energies after the last step; `springs` are bonds, fixed points and closed contacts.
 * None before bbm_prepare. */
void bbm_energies(const bbm_model *m, bbm_energy *energy)
{
    condition c[2];

    *energy = (bbm_energy){ 0, 0, 0 };
    if (!m->K)
        return;
    for (int i = 0; i < m->elements; i++) {
        energy->kinetic += kinetic_energy(m, &m->element[i]);
        energy->elastic += elastic_energy(&m->element[i]);
    }
    for (int b = 0; b < m->bonds; b++) {
        for (int n = bond_conditions(m, b, c); n > 0; n--)
            energy->springs += condition_energy(m, &c[n - 1]);
        energy->springs += is_hinge(m, &m->bond[b]) ? moment_energy(m, &m->bond[b]) : 0;
    }
    for (int v = 0; v < m->vertices; v++) {
        for (int n = vertex_conditions(m, v, c); n > 0; n--)
            energy->springs += condition_energy(m, &c[n - 1]);
        energy->springs += held_moment_energy(m, &m->element[m->vertex[v].element], v);
    }
    for (int k = 0; k < m->contacts; k++)
        energy->springs += contact_energy(&m->par, &m->contact[k]);
}
