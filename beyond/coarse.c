/* coarse.c - a second, coarse level for the SSOR-PCG of solver.c, by which the number of iterations
 * no longer grows with the mesh.
 *
 * SSOR removes in one iteration what is stiff and local, but carries news of the load by one
 * element per sweep; the finer the mesh, the more iterations. What it is slow at is known
 * beforehand: displacements that are continuous from element to element cost the bonding springs
 * nothing, so that in their sight everything else is stiff. On triangles these are the
 * displacements of the constant-strain finite element. So take the corners of the elements as a
 * coarse grid, where corners tied together by bonds are one node, and correct between the two
 * sweeps of SSOR in the whole space of its displacements at once. P takes the displacements of the
 * nodes to the unknowns of the elements, six rows and two columns for each corner; Kc = P^T K P is
 * the stiffness on the coarse grid, with all fixed points, contacts and inertia in it. In the
 * scaled variables of solver.c, with w = 1 and Q = C^T P,
 *
 *     y = E^-1 r                       sweep forward; it leaves the residual r - K y = -S^T y
 *     z = y - Q Kc^-1 Q^T S^T y        its correction
 *     u = E^-T (r - S z)               sweep backward
 *
 * and since r = y + S y, that is no more than a correction of y between the sweeps as they are,
 *
 *     y = E^-1 r,   y += S Q Kc^-1 Q^T S^T y,   u = E^-T y,
 *
 * positive definite by its form. Some 15 iterations suffice on a mesh of any fineness.
 *
 * Kc has an envelope: from the first entry of each row that is not zero to the diagonal, everything
 * is stored and factored by Cholesky. The nodes are numbered by the last row that has them, so that
 * the envelope is narrow as the band of K is. Displacements of the nodes that move no element (the
 * hourglass of quadrilaterals) have no stiffness: of their pivots rounding is left, some eps of
 * what was summed up before it cancelled. A pivot below VANISHING of that is struck out with its
 * row: the coarse space is then a little smaller, and the preconditioner as positive definite as
 * before.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "beyond.h"

/* Of a pivot, against its share of P^T D P. */
#define VANISHING 1e-12
/* Elements that a wave crosses in a step, from which on two levels solve faster than one: measured,
 * with blocks of 2 to 300 elements they break even at 1 to 4. */
#define CROSSED 3.0

typedef struct {
    int n;                      /* nodes, two unknowns each                                     */
    int *start;                 /* [rows+1]  a component of the rows i .. j-1 has the nodes     */
                                /*           start[i] .. start[j]-1                             */
    int *first, *node;          /* [rows+1]  row i has the nodes node[first[i] .. first[i+1]-1] */
    double (*P)[6][2], (*Q)[6][2];  /* as node   given; C_i^T P                                 */
    int *left;                  /* [2 n]     the first column of row i of Kc that is not zero   */
    size_t *diagonal;           /* [2 n]     where Kc_ii is; the row left of it lies before it  */
    double *A;                  /* Kc, then its factor, with 1/C_ii on the diagonal             */
    double *size, *x;           /* [2 n]     what a pivot is measured by; a vector              */
    int pays;                   /* in the step in hand                                          */
} coarse_space;

/* ----------------------------------------------------------------------------------- the layout */

/* first, node and start; the nodes are numbered from the last row on, from the last number down. */
static bbm_status list_nodes(const bbm_matrix *K, const int *first, const int *node, int *number,
                             coarse_space *c)
{
    for (int i = 0; i < K->n; i++)
        c->first[i + 1] = c->first[i] + first[K->caller[i] + 1] - first[K->caller[i]];
    c->start[K->n] = c->n;
    for (int k = K->components - 1; k >= 0; k--)
        for (int i = K->start[k + 1] - 1; i >= K->start[k]; i--) {
            const int *row = node + first[K->caller[i]];
            c->start[i] = c->start[i + 1];
            for (int a = c->first[i]; a < c->first[i + 1]; a++, row++) {
                if (number[*row] == 0)
                    number[*row] = c->start[i]--;
                if (number[*row] > c->start[K->start[k + 1]])
                    return BBM_BAD_INDEX;               /* it is in two components */
                c->node[a] = number[*row] - 1;
            }
        }
    return BBM_OK;
}

/* Whether two rows are triangles with a side in common. The springs of a side feel no more than the
 * displacements of its two ends: K_ij adds to their diagonal blocks of Kc, and to nothing else. */
static int share_a_side(const coarse_space *c, int i, int j)
{
    int common = 0;

    if (i == j || c->first[i + 1] - c->first[i] != 3 || c->first[j + 1] - c->first[j] != 3)
        return 0;
    for (int k = 0; k < 9; k++)
        common += c->node[c->first[i] + k / 3] == c->node[c->first[j] + k % 3];
    return common == 2;
}

/* left and diagonal. Returns the number of entries. */
static size_t lay_out_envelope(const bbm_matrix *K, coarse_space *c)
{
    size_t entries = 0;

    for (int k = 0; k < 2 * c->n; k++)
        c->left[k] = k / 2 * 2;
    for (int i = 0; i < K->n; i++)
        for (int k = K->first[i]; k <= K->first[i + 1]; k++) {
            const int j = k < K->first[i + 1] ? i - K->back[k] : i, side = share_a_side(c, i, j);
            for (int a = c->first[i]; a < c->first[i + 1] && !side; a++)
                for (int b = c->first[j]; b < c->first[j + 1]; b++) {
                    const int p = 2 * c->node[a], q = 2 * c->node[b], row = p > q ? p : q;
                    if (p + q - row < c->left[row])
                        c->left[row] = c->left[row + 1] = p + q - row;
                }
        }
    for (int k = 0; k < 2 * c->n; k++) {
        c->diagonal[k] = entries + (size_t)(k - c->left[k]);
        entries = c->diagonal[k] + 1;
    }
    return entries;
}

static bbm_status lay_out(const bbm_matrix *K, int nodes, const int *first, const int *node,
                          coarse_space *c)
{
    const size_t rows = (size_t)K->n + 1, corners = (size_t)first[K->n], n = (size_t)nodes;

    c->n = nodes;
    c->pays = 1;
    c->start = calloc(2 * rows + corners + 2 * n, sizeof *c->start);
    c->diagonal = calloc(2 * n, sizeof *c->diagonal);
    c->size = calloc(4 * n, sizeof *c->size);
    c->P = calloc(2 * corners, sizeof *c->P);
    if (!c->start || !c->diagonal || !c->size || !c->P)
        return BBM_NO_MEMORY;
    c->first = c->start + rows;
    c->node = c->first + rows;
    c->left = c->node + corners;
    c->x = c->size + 2 * n;
    c->Q = c->P + corners;
    if (list_nodes(K, first, node, c->left, c))
        return BBM_BAD_INDEX;
    c->A = calloc(lay_out_envelope(K, c), sizeof *c->A);
    return c->A ? BBM_OK : BBM_NO_MEMORY;
}

static void coarse_free(void *extra)
{
    coarse_space *c = extra;

    if (!c)
        return;
    free(c->start);
    free(c->diagonal);
    free(c->size);
    free(c->A);
    free(c->P);
    free(c);
}

/* Gives K a coarse space in place of the one it had: block row i has the nodes node[first[i]] ..
 * node[first[i+1]-1], all different, or none, and no two components the same node. Rows of three
 * nodes that share two of them must be triangles bonded along that side. */
bbm_status bbm_matrix_coarse(bbm_matrix *K, int nodes, const int *first, const int *node)
{
    for (int k = 0; k < first[K->n]; k++)
        if (node[k] < 0 || node[k] >= nodes)
            return BBM_BAD_INDEX;
    coarse_free(K->extra);
    K->extra = NULL;
    K->free_extra = coarse_free;
    K->ready = 0;
    if (first[K->n] == 0)
        return BBM_OK;
    coarse_space *c = calloc(1, sizeof *c);
    const bbm_status status = c ? lay_out(K, nodes, first, node, c) : BBM_NO_MEMORY;
    if (status)
        coarse_free(c);
    else
        K->extra = c;
    return status;
}

/* The displacement of the k-th node of block row i alone gives the row's unknowns P (u, v). */
bbm_status bbm_matrix_interpolate(bbm_matrix *K, int i, int k, double P[6][2])
{
    const coarse_space *c = K->extra;

    if (!c || i < 0 || i >= K->n)
        return BBM_BAD_INDEX;
    const int *first = &c->first[K->place[i]];
    if (k < 0 || k >= first[1] - first[0])
        return BBM_BAD_INDEX;
    memcpy(c->P[first[0] + k], P, sizeof *c->P);
    K->ready = 0;
    return BBM_OK;
}

/* ---------------------------------------------------------------------------- Kc and its factor */

/* Kc_ij, left of the diagonal or on it; those right of it in the same row lie after it. */
static double *entry(const coarse_space *c, int i, int j)
{
    return &c->A[c->diagonal[i] - (size_t)(i - j)];
}

/* Y = B X */
static void multiply(double B[6][6], double X[6][2], double Y[6][2])
{
    for (int a = 0; a < 6; a++)
        for (int b = 0; b < 2; b++) {
            Y[a][b] = 0;
            for (int k = 0; k < 6; k++)
                Y[a][b] += B[a][k] * X[k][b];
        }
}

/* Kc += f (P^T Y + its transpose), where P is that of corner a and Y belongs to node j. */
static void add_block(coarse_space *c, double f, int a, double Y[6][2], int j)
{
    for (int k = 0; k < 4; k++) {
        const int p = 2 * c->node[a] + k / 2, q = 2 * j + k % 2;
        double s = 0;
        for (int b = 0; b < 6; b++)
            s += c->P[a][b][k / 2] * Y[b][k % 2];
        *(p > q ? entry(c, p, q) : entry(c, q, p)) += p == q ? 2 * f * s : f * s;
    }
}

/* Q = C^T P = C^-1 D P, and Kc = P^T (D + L + L^T) P, of which the first is what pivots are
 * measured by. */
static void sum_coarse(const bbm_matrix *K, coarse_space *c)
{
    double Y[6][2];

    memset(c->A, 0, (c->diagonal[2 * c->n - 1] + 1) * sizeof *c->A);
    for (int i = 0; i < K->n; i++)
        for (int b = c->first[i]; b < c->first[i + 1]; b++) {
            multiply(K->D[i], c->P[b], Y);
            multiply(K->G[i], Y, c->Q[b]);
            for (int a = c->first[i]; a <= b; a++)
                add_block(c, a == b ? 0.5 : 1, a, Y, c->node[b]);
        }
    for (int k = 0; k < 2 * c->n; k++)
        c->size[k] = *entry(c, k, k);
    for (int i = 0; i < K->n; i++)
        for (int k = K->first[i]; k < K->first[i + 1]; k++) {
            const int j = i - K->back[k], side = share_a_side(c, i, j);
            for (int b = c->first[j]; b < c->first[j + 1]; b++) {
                multiply(K->L[k], c->P[b], Y);
                for (int a = c->first[i]; a < c->first[i + 1]; a++)
                    if (!side || c->node[a] == c->node[b])
                        add_block(c, 1, a, Y, c->node[b]);
            }
        }
}

/* s = the products of the rows a0 and a1 with b0 and b1, over an even number of columns, each in
 * two partial sums: one alone would wait for each addition to end. */
static void multiply_rows(int n, const double *a0, const double *a1, const double *b0,
                          const double *b1, double s[4])
{
    double sum[4][2] = { { 0 } };

    for (int k = 0; k < n; k += 2)
        for (int e = 0; e < 2; e++) {
            sum[0][e] += a0[k + e] * b0[k + e];
            sum[1][e] += a0[k + e] * b1[k + e];
            sum[2][e] += a1[k + e] * b0[k + e];
            sum[3][e] += a1[k + e] * b1[k + e];
        }
    for (int k = 0; k < 4; k++)
        s[k] = sum[k][0] + sum[k][1];
}

/* Kc = C C^T:  C_ij = (Kc_ij - sum_k<j C_ik C_jk)/C_jj, two rows and two columns at a time. */
static void factor(coarse_space *c)
{
    for (int i = 0; i < 2 * c->n; i += 2)
        for (int j = c->left[i]; j <= i; j += 2) {
            const int from = c->left[i] > c->left[j] ? c->left[i] : c->left[j];
            double s[4];
            multiply_rows(j - from, entry(c, i, from), entry(c, i + 1, from), entry(c, j, from),
                          entry(c, j + 1, from), s);
            for (int a = 0; a < 2; a++)
                for (int b = 0; b < 2 && j + b <= i + a; b++) {
                    double *to = entry(c, i + a, j + b), *pivot = entry(c, j + b, j + b);
                    const double t = *to - s[2 * a + b] - (b ? to[-1] * pivot[-1] : 0);
                    if (to != pivot)
                        *to = t * *pivot;
                    else
                        *to = t > VANISHING * c->size[i + a] ? 1 / sqrt(t) : 0;
                }
        }
}

static void make_ready(bbm_matrix *K)
{
    sum_coarse(K, K->extra);
    factor(K->extra);
}

/* x.y in four partial sums */
double bbm_dot(int n, const double *x, const double *y)
{
    double sum[4] = { 0 };
    int k = 0;

    for (; k + 4 <= n; k += 4) {
        sum[0] += x[k] * y[k];
        sum[1] += x[k + 1] * y[k + 1];
        sum[2] += x[k + 2] * y[k + 2];
        sum[3] += x[k + 3] * y[k + 3];
    }
    for (; k < n; k++)
        sum[n - k] += x[k] * y[k];
    return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

/* x = C^-T C^-1 x for the unknowns from .. to-1 of Kc; on the way back two rows at a time. */
static void solve(const coarse_space *c, int from, int to, double *restrict x)
{
    for (int i = from; i < to; i++) {
        const double *row = entry(c, i, c->left[i]);
        const int n = i - c->left[i];
        x[i] = (x[i] - bbm_dot(n, row, x + c->left[i])) * row[n];
    }
    for (int i = to - 2; i >= from; i -= 2) {
        const double *p = entry(c, i, c->left[i]), *q = entry(c, i + 1, c->left[i]);
        const int n = i - c->left[i];
        const double x1 = x[i + 1] * q[n + 1], x0 = (x[i] - q[n] * x1) * p[n];
        double *restrict y = x + c->left[i];
        for (int k = 0; k < n; k += 2) {
            y[k] -= p[k] * x0 + q[k] * x1;
            y[k + 1] -= p[k + 1] * x0 + q[k + 1] * x1;
        }
        x[i] = x0;
        x[i + 1] = x1;
    }
}

/* y += S Q Kc^-1 Q^T S^T y; u is free between the sweeps. */
static void correct(const bbm_matrix *K, double *y)
{
    const coarse_space *c = K->extra;
    const int from = 2 * c->start[K->from], to = 2 * c->start[K->to];
    double *u = K->u;

    memset(u + 6 * K->from, 0, 6 * (size_t)(K->to - K->from) * sizeof *u);
    memset(c->x + from, 0, (size_t)(to - from) * sizeof *c->x);
    bbm_multiply_upper(K, 1, y, u);
    for (int i = K->from; i < K->to; i++)
        for (int a = c->first[i]; a < c->first[i + 1]; a++) {
            double s[2] = { 0 };
            for (int k = 0; k < 6; k++) {
                s[0] += c->Q[a][k][0] * u[6 * i + k];
                s[1] += c->Q[a][k][1] * u[6 * i + k];
            }
            c->x[2 * c->node[a]] += s[0];
            c->x[2 * c->node[a] + 1] += s[1];
        }
    solve(c, from, to, c->x);
    memset(u + 6 * K->from, 0, 6 * (size_t)(K->to - K->from) * sizeof *u);
    for (int i = K->from; i < K->to; i++)
        for (int a = c->first[i]; a < c->first[i + 1]; a++) {
            const double *x = &c->x[2 * c->node[a]], x0 = x[0], x1 = x[1];
            for (int k = 0; k < 6; k++)
                u[6 * i + k] += c->Q[a][k][0] * x0 + c->Q[a][k][1] * x1;
        }
    bbm_multiply_lower(K, 1, u, y);
}

/* Without a coarse space, or where it does not pay, Eisenstat's form. */
static void choose(const bbm_matrix *K, bbm_pcg *pcg)
{
    const coarse_space *c = K->extra;

    if (c && c->pays)
        pcg->omega = 1;
    else
        pcg->method = &bbm_eisenstat;
}

const bbm_method bbm_two_level = { .choose = choose, .make_ready = make_ready, .correct = correct };

/* ------------------------------------------------------------------ the coarse space of a model */

/* What the displacement of corner a alone does to the unknowns, D = P (u_a, v_a): of the
 * displacements linear in x, y the one nearest to those of all n corners, by least squares; on a
 * triangle it is exact. With `middles` it is the one nearest to the means over the sides, for
 * elements that are bonded there. Fitted about the mean of the corners, a linear function has the
 * value mean(u) there and the gradient g = M^-1 sum_a d_a u_a, M = sum d d^T:
 *     u_a adds ux = g_x, uy = g_y, v_a the same to v;   ex = ux, ey = vy, gxy = uy + vx,
 *     r0 = (vx - uy)/2. */
void bbm_interpolation(const bbm_element *e, const bbm_vertex v[], int middles, int a,
                       double P[6][2])
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
    const double det = xx * yy - xy * xy;
    const double gx = (yy * X - xy * Y) / det, gy = (xx * Y - xy * X) / det;
    const double u0 = 1.0 / e->n + gx * (e->x - x) + gy * (e->y - y);
    const double matrix[6][2] = {
        { u0, 0 }, { 0, u0 }, { -gy / 2, gx / 2 }, { gx, 0 }, { 0, gy }, { gy, gx }
    };

    memcpy(P, matrix, sizeof matrix);
}

/* Whether fixed points hold every corner of an element. */
static int held_all_round(const bbm_model *m, const bbm_element *e)
{
    int held = 0;

    for (int v = e->first; v < e->first + e->n; v++)
        held += m->node[m->vertex[v].node].held == BBM_XY;
    return held == e->n;
}

/* A coarse space for a new K: corners that bonds tie together are one node, so that a crack parts
 * them. An element without bonds is not in it, for there would be as many coarse unknowns as it has
 * of its own; nor is one held at every corner, which hardly moves. SSOR alone is faster for both.
 * */
bbm_status bbm_lay_out_coarse(bbm_model *m)
{
    const size_t v = (size_t)m->vertices;
    int *up = calloc(3 * v + (size_t)m->elements + 1, sizeof *up), nodes = 0;

    if (!up)
        return BBM_NO_MEMORY;
    int *number = up + v, *node = number + v, *first = node + v;
    for (int k = 0; k < m->vertices; k++)
        up[k] = k;
    for (int k = 0; k < m->bonds; k++) {
        const bbm_bond *b = &m->bond[k];
        for (int end = 0; end < 2; end++)
            up[bbm_root_of(up, b->q[end])] = bbm_root_of(up, b->p[end]);
        first[b->i + 1] = first[b->j + 1] = 1;                  /* it has a bond */
    }
    for (int i = 0; i < m->elements; i++) {
        const bbm_element *e = &m->element[i];
        const int count = first[i + 1] && !held_all_round(m, e) ? e->n : 0;
        for (int k = 0; k < count; k++) {
            int *n = &number[bbm_root_of(up, e->first + k)];
            if (*n == 0)
                *n = ++nodes;
            node[first[i] + k] = *n - 1;
        }
        first[i + 1] = first[i] + count;
    }
    const bbm_status status = bbm_matrix_coarse(m->K, nodes, first, node);
    free(up);
    return status;
}

/* Whether the step is long enough for two levels to pay: in a short one inertia holds every element
 * by itself, and SSOR alone needs no more iterations than a wave, of speed sqrt(E/density), needs
 * to cross some elements. */
static int step_is_long(const bbm_model *m)
{
    for (int b = 0; b < m->bonds; b++) {
        const bbm_element *e = &m->element[m->bond[b].i];
        const double way2 = e->material.E / e->material.density * m->h * m->h;
        if (way2 > CROSSED * CROSSED * e->A && !held_all_round(m, e))
            return 1;
    }
    return 0;
}

/* The coarse space of the present geometry, unless it is that already. Elements that are not in it
 * are refused, which does no harm. */
void bbm_interpolate_elements(bbm_model *m)
{
    coarse_space *c = m->K->extra;
    double P[6][2];

    if (!c || m->K->ready || m->par.pcg.method != &bbm_two_level)
        return;
    c->pays = step_is_long(m);
    for (int i = 0; i < m->elements && c->pays; i++) {
        const bbm_element *e = &m->element[i];
        const int middles = m->beyond->bonding != BBM_VERTICES && e->n == 4;
        for (int a = 0; a < e->n; a++) {
            bbm_interpolation(e, &m->vertex[e->first], middles, a, P);
            (void)bbm_matrix_interpolate(m->K, i, a, P);
        }
    }
}
