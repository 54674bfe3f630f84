/* coarse.c - a second, coarse level for the SSOR-PCG of solver.c, by which the number of iterations
 * does not grow with a mesh of triangles.
 *
 * SSOR removes in one iteration what is stiff and local, but carries news of the load by one
 * element per sweep; the finer the mesh, the more iterations. What it is slow at is known
 * beforehand: displacements that are continuous from element to element cost the bonding springs
 * nothing, so that in their sight everything else is stiff. On triangles these are the
 * displacements of the constant-strain finite element. So take the corners of the elements as a
 * coarse grid, where corners tied together by bonds are one node, and correct between the two
 * sweeps of SSOR in the whole space of its displacements at once. P takes the displacements of the
 * nodes to the unknowns of the elements, six rows and two columns for each corner; Kc = P^T K P is
 * the stiffness on the coarse grid, with all fixed points, contacts and inertia in it. With w = 1,
 *
 *     (D + L) y = r                    sweep forward; it leaves the residual r - K y = -L^T y
 *     z = y - P Kc^-1 P^T L^T y        its correction
 *     (D + L^T) u = r - L z            sweep backward
 *
 * and since r = D y + L y, this only adds to the right-hand side of the sweep backward,
 *
 *     (D + L) y = r,   f = D y + L P Kc^-1 P^T L^T y,   (D + L^T) u = f,
 *
 * positive definite by its form. On triangles some 15 iterations suffice on a mesh of any fineness.
 * What the nodes of a model are, and P, is in interpolation.c.
 *
 * Kc is factored by Cholesky in its envelope. The nodes are numbered by the last row that has them,
 * so that the envelope is narrow as the band of K is. Displacements of the nodes that move no
 * element (the hourglass of quadrilaterals) have no stiffness: of their pivots rounding is left,
 * some eps of what was summed up before it cancelled. A pivot below VANISHING of that is struck out
 * with its row: the coarse space is then a little smaller, and the preconditioner as positive
 * definite as before.
 */
#include <stdlib.h>
#include <string.h>

#include "beyond.h"

/* Of a pivot, against its share of P^T D P. */
#define VANISHING 1e-12

typedef struct {
    int n;                      /* nodes, some without a corner                                 */
    int *start;                 /* [rows+1]  a component of the rows i .. j-1 has the nodes     */
                                /*           start[i] .. start[j]-1                             */
    int *first, *node;          /* [rows+1]  row i has the nodes node[first[i] .. first[i+1]-1] */
    double (*P)[6][2];          /* as node                                                      */
    bbm_envelope Kc;            /* then its factor, with 1/C_ii on the diagonal                 */
    double *size, *x;           /* [2 n]     what a pivot is measured by; a vector              */
    double *z;                  /* [6 rows]  a vector                                           */
    int pays;                   /* in the step in hand                                          */
} coarse_space;

/* ----------------------------------------------------------------------------------- the layout */

/* first, node and start; the nodes are numbered from the last row on, from the last number down. */
static bbm_status list_nodes(const bbm_matrix *K, const int *first, const int *node,
                             coarse_space *c)
{
    int *number = c->Kc.left;           /* not in use yet: 0 */

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

/* left. Both rows of a node begin with the first node that it meets in an element, or in elements
 * that a block of K joins. */
static void find_neighbours(const bbm_matrix *K, const coarse_space *c)
{
    int *left = c->Kc.left;

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

static bbm_status allocate(const bbm_matrix *K, size_t corners, coarse_space *c)
{
    const size_t n = (size_t)c->n, rows = (size_t)K->n + 1;

    c->start = calloc(2 * rows + corners, sizeof *c->start);
    c->P = calloc(corners, sizeof *c->P);
    c->Kc.left = calloc(2 * n, sizeof *c->Kc.left);
    c->Kc.n = 2 * c->n;
    c->size = calloc(4 * n + 6 * rows, sizeof *c->size);
    if (!c->start || !c->P || !c->Kc.left || !c->size)
        return BBM_NO_MEMORY;
    c->first = c->start + rows;
    c->node = c->first + rows;
    c->x = c->size + 2 * n;
    c->z = c->x + 2 * n;
    return BBM_OK;
}

static bbm_status lay_out(const bbm_matrix *K, int nodes, const int *first, const int *node,
                          coarse_space *c)
{
    c->n = nodes;
    c->pays = 1;
    bbm_status status = allocate(K, (size_t)first[K->n], c);
    if (!status)
        status = list_nodes(K, first, node, c);
    if (status)
        return status;
    find_neighbours(K, c);
    return bbm_envelope_lay_out(&c->Kc, 1);
}

static void coarse_free(void *extra)
{
    coarse_space *c = extra;

    if (!c)
        return;
    free(c->start);
    free(c->P);
    free(c->size);
    bbm_envelope_free(&c->Kc);
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
    if (!c)
        return BBM_NO_MEMORY;
    const bbm_status status = lay_out(K, nodes, first, node, c);
    if (status)
        coarse_free(c);
    else
        K->extra = c;
    return status;
}

/* The displacement (u, v) of the k-th node of block row i alone gives the row's unknowns,
 * P (u, v). */
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

/* Whether it is worth its while in the step in hand. */
void bbm_matrix_use_coarse(bbm_matrix *K, int pays)
{
    coarse_space *c = K->extra;

    if (c)
        c->pays = pays;
}

/* ---------------------------------------------------------------------------- Kc and its factor */

/* Y = B X */
static void multiply(double B[6][6], double X[6][2], double Y[6][2])
{
    memset(Y, 0, 12 * sizeof Y[0][0]);
    for (int a = 0; a < 6; a++)
        for (int k = 0; k < 12; k++)
            Y[a][k % 2] += B[a][k / 2] * X[k / 2][k % 2];
}

/* Kc += f (P^T Y + its transpose), where P belongs to node i and Y to node j. */
static void add_block(const coarse_space *c, double f, double P[6][2], int i, double Y[6][2], int j)
{
    double sum[2][2] = { { 0 } };

    for (int b = 0; b < 6; b++)
        for (int k = 0; k < 4; k++)
            sum[k / 2][k % 2] += P[b][k / 2] * Y[b][k % 2];
    for (int k = 0; k < 4; k++) {
        const int p = 2 * i + k / 2, q = 2 * j + k % 2;
        *bbm_entry(&c->Kc, p > q ? p : q, p > q ? q : p)
            += (p == q ? 2 : 1) * f * sum[k / 2][k % 2];
    }
}

/* Kc = P^T (D + L + L^T) P, of which the first is what pivots are measured by. */
static void sum_coarse(const bbm_matrix *K, const coarse_space *c)
{
    const int n = c->Kc.n;
    double Y[6][2];

    memset(c->Kc.A, 0, (c->Kc.diagonal[n - 1] + 1) * sizeof *c->Kc.A);
    for (int i = 0; i < K->n; i++)
        for (int b = c->first[i]; b < c->first[i + 1]; b++) {
            multiply(K->D[i], c->P[b], Y);
            for (int a = c->first[i]; a <= b; a++)
                add_block(c, a == b ? 0.5 : 1, c->P[a], c->node[a], Y, c->node[b]);
        }
    for (int k = 0; k < n; k++)
        c->size[k] = *bbm_entry(&c->Kc, k, k);
    for (int i = 0; i < K->n; i++)
        for (int k = K->first[i]; k < K->first[i + 1]; k++) {
            const int j = i - K->back[k], side = share_a_side(c, i, j);
            for (int b = c->first[j]; b < c->first[j + 1]; b++) {
                multiply(K->L[k], c->P[b], Y);
                for (int a = c->first[i]; a < c->first[i + 1]; a++)
                    if (!side || c->node[a] == c->node[b])
                        add_block(c, 1, c->P[a], c->node[a], Y, c->node[b]);
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
static void factor(const bbm_envelope *e, const double *size)
{
    const int *left = e->left;

    for (int i = 0; i < e->n; i += 2)
        for (int j = left[i]; j <= i; j += 2) {
            const int from = left[i] > left[j] ? left[i] : left[j];
            double sum[4];
            multiply_rows(j - from, bbm_entry(e, i, from), bbm_entry(e, i + 1, from),
                          bbm_entry(e, j, from), bbm_entry(e, j + 1, from), sum);
            for (int a = 0; a < 2; a++)
                for (int b = 0; b < 2 && j + b <= i + a; b++) {
                    double *to = bbm_entry(e, i + a, j + b), *pivot = bbm_entry(e, j + b, j + b);
                    const double t = *to - sum[2 * a + b] - (b ? to[-1] * pivot[-1] : 0);
                    if (to != pivot)
                        *to = t * *pivot;
                    else
                        *to = t > VANISHING * size[i + a] ? 1 / sqrt(t) : 0;
                }
        }
}

static void make_ready(bbm_matrix *K)
{
    const coarse_space *c = K->extra;

    sum_coarse(K, c);
    factor(&c->Kc, c->size);
}

/* x = P^T z for the rows in hand. */
static void restrict_to_nodes(const bbm_matrix *K, const coarse_space *c)
{
    const int from = c->start[K->from], to = c->start[K->to];

    memset(c->x + 2 * from, 0, 2 * (size_t)(to - from) * sizeof *c->x);
    for (int i = K->from; i < K->to; i++)
        for (int a = c->first[i]; a < c->first[i + 1]; a++) {
            double *x = &c->x[2 * c->node[a]];
            for (int k = 0; k < 12; k++)
                x[k % 2] += c->P[a][k / 2][k % 2] * c->z[6 * i + k / 2];
        }
}

/* z = P x for the rows in hand. */
static void interpolate(const bbm_matrix *K, const coarse_space *c)
{
    for (int i = K->from; i < K->to; i++) {
        double *z = &c->z[6 * i];
        memset(z, 0, 6 * sizeof *z);
        for (int a = c->first[i]; a < c->first[i + 1]; a++) {
            const double *x = &c->x[2 * c->node[a]];
            for (int k = 0; k < 6; k++)
                z[k] += c->P[a][k][0] * x[0] + c->P[a][k][1] * x[1];
        }
    }
}

/* f += L P Kc^-1 P^T L^T y */
static void correct(const bbm_matrix *K, const double *y, double *f)
{
    const coarse_space *c = K->extra;

    memset(c->z + 6 * K->from, 0, 6 * (size_t)(K->to - K->from) * sizeof *c->z);
    bbm_add_upper(K, y, c->z);
    restrict_to_nodes(K, c);
    bbm_substitute(&c->Kc, &c->Kc, 2 * c->start[K->from], 2 * c->start[K->to], c->x);
    interpolate(K, c);
    bbm_add_lower(K, c->z, f);
}

/* Without a coarse space, or where it does not pay, the paper's method. */
static void choose(const bbm_matrix *K, bbm_pcg *pcg)
{
    const coarse_space *c = K->extra;

    if (c && c->pays)
        pcg->omega = 1;
    else
        pcg->method = NULL;
}

const bbm_method bbm_two_level = { choose, make_ready, correct };
