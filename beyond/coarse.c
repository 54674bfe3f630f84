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
 * positive definite by its form. Some 15 iterations suffice on a mesh of any fineness. What the
 * nodes of a model are, and P, is in interpolation.c.
 *
 * Quadrilaterals need a second set of displacements of the nodes. No stiff spring joins the two:
 * each has a Kc of its own, and their corrections are added. In the second set little joins u and
 * v, and the matrices of both are much alike, so that the mean of these two is enough for either:
 * half as many unknowns in half as wide an envelope, an eighth of the work.
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

typedef struct {                /* displacements of the nodes and their Kc                      */
    int unknowns, apart;        /* of a node in Kc: u and v, or one matrix for both alike; from */
                                /*           u to v of a node in x                              */
    double (*P)[6][2], (*Q)[6][2];  /* as node   given; C_i^T P                                 */
    int *left;                  /* [n unknowns]  the first column of row i of Kc that is not 0  */
    size_t *diagonal;           /* [n unknowns]  where Kc_ii is; the row lies before it         */
    double *A;                  /* Kc, then its factor, with 1/C_ii on the diagonal             */
    double *size, *x;           /* [n unknowns], [2 n]  what a pivot is measured by; a vector   */
} coarse_set;

typedef struct {
    int n, sets;                /* nodes, some without a corner; 1 or 2                         */
    int *start;                 /* [rows+1]  a component of the rows i .. j-1 has the nodes     */
                                /*           start[i] .. start[j]-1, and start[i] is even       */
    int *first, *node;          /* [rows+1]  row i has the nodes node[first[i] .. first[i+1]-1] */
    coarse_set set[2];
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
            c->start[i] -= i == K->start[k] ? c->start[i] % 2 : 0;
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

/* left of the first set. */
static void find_neighbours(const bbm_matrix *K, const coarse_space *c, int *left)
{
    for (int k = 0; k < 2 * c->n; k++)
        left[k] = k / 2 * 2;
    for (int i = 0; i < K->n; i++)
        for (int k = K->first[i]; k <= K->first[i + 1]; k++) {
            const int j = k < K->first[i + 1] ? i - K->back[k] : i, side = share_a_side(c, i, j);
            for (int a = c->first[i]; a < c->first[i + 1] && !side; a++)
                for (int b = c->first[j]; b < c->first[j + 1]; b++) {
                    const int p = 2 * c->node[a], q = 2 * c->node[b], row = p > q ? p : q;
                    if (p + q - row < left[row])
                        left[row] = left[row + 1] = p + q - row;
                }
        }
}

/* Room for Kc. Two rows of it, of one node or of two, begin in the same even column. */
static bbm_status lay_out_envelope(const coarse_space *c, coarse_set *s)
{
    const int *left = c->set[0].left;
    size_t entries = 0;

    for (int k = 0; k < s->unknowns * c->n; k++) {
        if (s->unknowns == 1) {
            const int p = left[k / 2 * 4], q = left[k / 2 * 4 + 2];
            s->left[k] = (p < q ? p : q) / 4 * 2;
        }
        s->diagonal[k] = entries + (size_t)(k - s->left[k]);
        entries = s->diagonal[k] + 1;
    }
    s->A = calloc(entries, sizeof *s->A);
    return s->A ? BBM_OK : BBM_NO_MEMORY;
}

static bbm_status allocate_set(const coarse_space *c, size_t corners, int unknowns, coarse_set *s)
{
    const size_t n = (size_t)c->n;

    s->unknowns = unknowns;
    s->apart = unknowns == 2 ? 1 : c->n;
    s->P = calloc(2 * corners, sizeof *s->P);
    s->left = calloc(2 * n, sizeof *s->left);
    s->diagonal = calloc(2 * n, sizeof *s->diagonal);
    s->size = calloc(4 * n, sizeof *s->size);
    s->Q = s->P + corners;
    s->x = s->size + 2 * n;
    return s->P && s->left && s->diagonal && s->size ? BBM_OK : BBM_NO_MEMORY;
}

static bbm_status lay_out(const bbm_matrix *K, int nodes, const int *first, const int *node,
                          coarse_space *c)
{
    const size_t rows = (size_t)K->n + 1, corners = (size_t)first[K->n];
    bbm_status status = BBM_OK;

    c->n = (nodes + K->components + 1) / 2 * 2;
    c->pays = 1;
    c->start = calloc(2 * rows + corners, sizeof *c->start);
    if (!c->start)
        return BBM_NO_MEMORY;
    c->first = c->start + rows;
    c->node = c->first + rows;
    for (int k = 0; k < c->sets && !status; k++)
        status = allocate_set(c, corners, 2 - k, &c->set[k]);
    if (!status)
        status = list_nodes(K, first, node, c->set[0].left, c);
    if (!status)
        find_neighbours(K, c, c->set[0].left);
    for (int k = 0; k < c->sets && !status; k++)
        status = lay_out_envelope(c, &c->set[k]);
    return status;
}

static void coarse_free(void *extra)
{
    coarse_space *c = extra;

    for (int k = 0; c && k < c->sets; k++) {
        free(c->set[k].P);
        free(c->set[k].left);
        free(c->set[k].diagonal);
        free(c->set[k].size);
        free(c->set[k].A);
    }
    if (c)
        free(c->start);
    free(c);
}

/* Gives K a coarse space in place of the one it had: block row i has the nodes node[first[i]] ..
 * node[first[i+1]-1], all different, or none, and no two components the same node. Rows of three
 * nodes that share two of them must be triangles bonded along that side. There are one or two sets
 * of displacements of the nodes. */
bbm_status bbm_matrix_coarse(bbm_matrix *K, int sets, int nodes, const int *first, const int *node)
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
    if (!c)
        return BBM_NO_MEMORY;
    c->sets = sets;
    const bbm_status status = lay_out(K, nodes, first, node, c);
    if (status)
        coarse_free(c);
    else
        K->extra = c;
    return status;
}

/* The displacement of the k-th node of block row i alone, in one of the sets, gives the row's
 * unknowns P (u, v). */
bbm_status bbm_matrix_interpolate(bbm_matrix *K, int set, int i, int k, double P[6][2])
{
    const coarse_space *c = K->extra;

    if (!c || set < 0 || set >= c->sets || i < 0 || i >= K->n)
        return BBM_BAD_INDEX;
    const int *first = &c->first[K->place[i]];
    if (k < 0 || k >= first[1] - first[0])
        return BBM_BAD_INDEX;
    memcpy(c->set[set].P[first[0] + k], P, sizeof *c->set[set].P);
    K->ready = 0;
    return BBM_OK;
}

/* Whether it is worth its while in the step in hand. */
void bbm_matrix_use_coarse(bbm_matrix *K, int pays)
{
    coarse_space *c = K->extra;

    if (c)
        c->pays = pays;
}

/* ---------------------------------------------------------------------------- Kc and its factor */

/* Kc_ij, left of the diagonal or on it; those right of it in the same row lie after it. */
static double *entry(const coarse_set *s, int i, int j)
{
    return &s->A[s->diagonal[i] - (size_t)(i - j)];
}

/* Y = B X */
static void multiply(double B[6][6], double X[6][2], double Y[6][2])
{
    for (int a = 0; a < 6; a++) {
        double u = 0, v = 0;
        for (int k = 0; k < 6; k++) {
            u += B[a][k] * X[k][0];
            v += B[a][k] * X[k][1];
        }
        Y[a][0] = u;
        Y[a][1] = v;
    }
}

/* Kc += f (P^T Y + its transpose), where P is that of corner a of node i and Y belongs to node j;
 * of one matrix for u and v alike, the mean of both. */
static void add_block(const coarse_set *s, double f, double P[6][2], int i, double Y[6][2], int j)
{
    double sum[2][2] = { { 0 } };

    for (int b = 0; b < 6; b++)
        for (int k = 0; k < 4; k++)
            sum[k / 2][k % 2] += P[b][k / 2] * Y[b][k % 2];
    if (s->unknowns == 1)
        *(i > j ? entry(s, i, j) : entry(s, j, i))
            += (i == j ? f : f / 2) * (sum[0][0] + sum[1][1]);
    for (int k = 0; k < 4 && s->unknowns == 2; k++) {
        const int p = 2 * i + k / 2, q = 2 * j + k % 2;
        *(p > q ? entry(s, p, q) : entry(s, q, p)) += (p == q ? 2 : 1) * f * sum[k / 2][k % 2];
    }
}

/* Q = C^T P = C^-1 D P, and Kc = P^T (D + L + L^T) P, of which the first is what pivots are
 * measured by. */
static void sum_coarse(const bbm_matrix *K, const coarse_space *c, const coarse_set *s)
{
    const int n = s->unknowns * c->n;
    double Y[6][2];

    memset(s->A, 0, (s->diagonal[n - 1] + 1) * sizeof *s->A);
    for (int i = 0; i < K->n; i++)
        for (int b = c->first[i]; b < c->first[i + 1]; b++) {
            multiply(K->D[i], s->P[b], Y);
            multiply(K->G[i], Y, s->Q[b]);
            for (int a = c->first[i]; a <= b; a++)
                add_block(s, a == b ? 0.5 : 1, s->P[a], c->node[a], Y, c->node[b]);
        }
    for (int k = 0; k < n; k++)
        s->size[k] = *entry(s, k, k);
    for (int i = 0; i < K->n; i++)
        for (int k = K->first[i]; k < K->first[i + 1]; k++) {
            const int j = i - K->back[k], side = share_a_side(c, i, j);
            for (int b = c->first[j]; b < c->first[j + 1]; b++) {
                multiply(K->L[k], s->P[b], Y);
                for (int a = c->first[i]; a < c->first[i + 1]; a++)
                    if (!side || c->node[a] == c->node[b])
                        add_block(s, 1, s->P[a], c->node[a], Y, c->node[b]);
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
static void factor(const coarse_set *s, int n)
{
    for (int i = 0; i < n; i += 2)
        for (int j = s->left[i]; j <= i; j += 2) {
            const int from = s->left[i] > s->left[j] ? s->left[i] : s->left[j];
            double sum[4];
            multiply_rows(j - from, entry(s, i, from), entry(s, i + 1, from), entry(s, j, from),
                          entry(s, j + 1, from), sum);
            for (int a = 0; a < 2; a++)
                for (int b = 0; b < 2 && j + b <= i + a; b++) {
                    double *to = entry(s, i + a, j + b), *pivot = entry(s, j + b, j + b);
                    const double t = *to - sum[2 * a + b] - (b ? to[-1] * pivot[-1] : 0);
                    if (to != pivot)
                        *to = t * *pivot;
                    else
                        *to = t > VANISHING * s->size[i + a] ? 1 / sqrt(t) : 0;
                }
        }
}

static void make_ready(bbm_matrix *K)
{
    const coarse_space *c = K->extra;

    for (int k = 0; k < c->sets; k++) {
        sum_coarse(K, c, &c->set[k]);
        factor(&c->set[k], c->set[k].unknowns * c->n);
    }
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
static void solve(const coarse_set *s, int from, int to, double *restrict x)
{
    for (int i = from; i < to; i++) {
        const double *row = entry(s, i, s->left[i]);
        const int n = i - s->left[i];
        x[i] = (x[i] - bbm_dot(n, row, x + s->left[i])) * row[n];
    }
    for (int i = to - 2; i >= from; i -= 2) {
        const double *p = entry(s, i, s->left[i]), *q = entry(s, i + 1, s->left[i]);
        const int n = i - s->left[i];
        const double x1 = x[i + 1] * q[n + 1], x0 = (x[i] - q[n] * x1) * p[n];
        double *restrict y = x + s->left[i];
        for (int k = 0; k < n; k += 2) {
            y[k] -= p[k] * x0 + q[k] * x1;
            y[k + 1] -= p[k + 1] * x0 + q[k + 1] * x1;
        }
        x[i] = x0;
        x[i + 1] = x1;
    }
}

/* x = Kc^-1 Q^T u for the rows in hand. */
static void solve_set(const bbm_matrix *K, const coarse_space *c, const coarse_set *s,
                      const double *u)
{
    const int from = s->unknowns * c->start[K->from], to = s->unknowns * c->start[K->to];
    const int vectors = 3 - s->unknowns;

    for (int k = 0; k < vectors; k++)
        memset(s->x + k * c->n + from, 0, (size_t)(to - from) * sizeof *s->x);
    for (int i = K->from; i < K->to; i++)
        for (int a = c->first[i]; a < c->first[i + 1]; a++) {
            double *x = &s->x[s->unknowns * c->node[a]], sum[2] = { 0 };
            for (int k = 0; k < 6; k++) {
                sum[0] += s->Q[a][k][0] * u[6 * i + k];
                sum[1] += s->Q[a][k][1] * u[6 * i + k];
            }
            x[0] += sum[0];
            x[s->apart] += sum[1];
        }
    for (int k = 0; k < vectors; k++)
        solve(s, from, to, s->x + k * c->n);
}

/* u += Q x for the rows in hand. */
static void interpolate_set(const bbm_matrix *K, const coarse_space *c, const coarse_set *s,
                            double *u)
{
    for (int i = K->from; i < K->to; i++)
        for (int a = c->first[i]; a < c->first[i + 1]; a++) {
            const double *x = &s->x[s->unknowns * c->node[a]], x0 = x[0], x1 = x[s->apart];
            for (int k = 0; k < 6; k++)
                u[6 * i + k] += s->Q[a][k][0] * x0 + s->Q[a][k][1] * x1;
        }
}

/* y += S sum(Q Kc^-1 Q^T) S^T y over the sets; u is free between the sweeps. */
static void correct(const bbm_matrix *K, double *y)
{
    const coarse_space *c = K->extra;
    const size_t bytes = 6 * (size_t)(K->to - K->from) * sizeof *y;

    memset(K->u + 6 * K->from, 0, bytes);
    bbm_multiply_upper(K, 1, y, K->u);
    for (int k = 0; k < c->sets; k++)
        solve_set(K, c, &c->set[k], K->u);
    memset(K->u + 6 * K->from, 0, bytes);
    for (int k = 0; k < c->sets; k++)
        interpolate_set(K, c, &c->set[k], K->u);
    bbm_multiply_lower(K, 1, K->u, y);
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
