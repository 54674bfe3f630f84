/* solver.c - the linear solver of section 4: K D = F by conjugate gradients preconditioned with SSOR.
 *
 * Storage. K is symmetric and consists of 6x6 blocks, a block row for each element. Write
 *
 *     K = L + D + L^T,      D: the diagonal blocks,  L: the blocks left of them.
 *
 * Only D and those blocks of L that are not zero are stored, row by row: `first` says where the blocks of a row begin
 * and `column` which column each of them is in. The block rows are not in the caller's order but in the reverse
 * Cuthill-McKee order: number the elements from one end of the body to the other, breadth first, and turn the numbers
 * round. The blocks of L then lie in a narrow band below the diagonal, and what a sweep reads was written shortly
 * before. The band itself is not stored: an element has three or four neighbours and a band has sqrt(n) places, all
 * but those few zero for ever, because an iteration, unlike a factorisation, fills nothing in.
 * The pattern is made once (bbm_matrix_new); each time step clears K and adds the submatrices anew.
 *
 * SSOR-PCG as in the textbooks, with a relaxation factor w, 0 < w < 2:
 *
 *     M = (D/w + L) (D/w)^-1 (D/w + L)^T
 *
 *     x = 0,  r = F,  z = M^-1 r,  p = z
 *     until sqrt(r.z) <= tolerance * its first value:
 *         q = K p
 *         a = r.z / p.q
 *         x += a p,  r -= a q
 *         z = M^-1 r                          a forward sweep over L and a backward sweep over L^T
 *         p = z + (r.z / its last value) p
 *
 * The factor 1/(2-w) that M often has is left out: it changes neither x nor the end of the iteration.
 * An iteration reads L twice for M^-1 and once for K p, where each block serves as L and as L^T.
 *
 * Eisenstat's trick (SIAM J. Sci. Stat. Comput. 2, 1981) is to iterate in the variables between the two sweeps. Factor
 * D_i = C_i C_i^T and scale once, S_ij = C_i^-1 L_ij C_j^-T, b = C^-1 F. With E = I + w S the scaled matrix is
 *
 *     I + S + S^T = 1/w (E + E^T - (2-w) I),
 *
 * so that w E^-1 (I + S + S^T) E^-T p costs no product, only the two sweeps that M needs in any case:
 *
 *     x = 0,  r = E^-1 b,  p = r
 *     until sqrt(r.r) <= tolerance * its first value:
 *         t = E^-T p                          backward sweep
 *         y = E^-1 (p - (2-w) t)              forward sweep
 *         a = r.r / p.(t + y)
 *         x += a t,  r -= a (t + y)
 *         p = r + (r.r / its last value) p
 *     D = w C^-T x
 *
 * Both take the same iterations to the same D but for rounding, and stop at the same one: r.r here is r.z there, but
 * for a constant factor. The second form leaves out the product with K and all products with D_i^-1; what is left is
 * so little that reading and writing the vectors counts, too, and steps that use the same ones are done together.
 *
 * What a tolerance can mean. The residual of the recurrence, r, shrinks as far as one likes, but F - K D cannot become
 * smaller than about eps |K| |D|, in a stiff body 1e-10 |F| or more (eps = 2e-16). A tolerance much below 1e-10 buys
 * iterations and nothing else. Therefore bbm_solve stops on r and then reports the true residual, computed afresh.
 *
 * Denormals. When a single element is loaded, a sweep carries the load from element to element and weakens it each
 * time, down to numbers below 1e-308, on which many processors take ten or a hundred times longer; rounding can keep
 * them alive through all the rest of the body. Therefore F is scaled to a largest entry of 1, and its zeros become
 * NEGLIGIBLE: no number fades below that, squares of such numbers are still far from 1e-308, and nothing that matters
 * changes. It costs nothing in an iteration.
 */
#include "bbm.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define NEGLIGIBLE 1e-100                       /* -  against the largest entry of F                            */

typedef struct { double a[6][6]; } matrix6;

/* Block rows are numbered in two ways: by the caller, and by their place in the reverse Cuthill-McKee order.    */
struct bbm_matrix {
    int n, blocks;              /* block rows, blocks in L                                                      */
    int *place, *caller;        /* [n]       place[caller's row], and back                                      */
    int *first;                 /* [n+1]     the blocks of row i of L are first[i] .. first[i+1]-1              */
    int *column;                /* [blocks]                                                                     */
    matrix6 *D, *L;             /* [n], [blocks]                                                                */
    /* --- scratch of bbm_solve; vectors have 6 n entries in the order of the places --- */
    matrix6 *C, *S;             /* [n], [blocks]  C_i^-1 and -w S_ij; in the textbook form C is -w D_i^-1       */
    double *f, *x, *r, *p, *q;  /* right-hand side, solution, residual, direction, product                      */
    double *y, *z;              /* results of a forward and of a backward sweep                                 */
};

/* ------------------------------------------------------------------------------------ the pattern and its order */

typedef struct {                /* who is a neighbour of whom, in the caller's numbers                          */
    int n;
    int *first, *end;           /* [n+1], [n]  the neighbours of i are list[first[i] .. end[i]-1], ascending    */
    int *level;                 /* [n]         distance from the start of the search, -1: not yet found         */
    int *list, *raw;            /* [2 pairs]   raw: before sorting                                              */
} graph;

/* Lists both numbers of each pair, each in the row of the other. */
static void list_neighbours(graph *g, int pairs, int (*pair)[2])
{
    int i, k;

    for (k = 0; k < 2 * pairs; k++)
        g->first[pair[k / 2][k % 2] + 1]++;
    for (i = 0; i < g->n; i++) {
        g->first[i + 1] += g->first[i];
        g->end[i] = g->first[i];
    }
    for (k = 0; k < 2 * pairs; k++)
        g->raw[g->end[pair[k / 2][k % 2]]++] = pair[k / 2][1 - k % 2];
}

/* Sorts by transposing: visiting the rows i in turn and appending i to the list of each neighbour makes every list
 * ascend, whatever the order of the pairs was. A repeated pair comes twice running and is appended once.        */
static void sort_neighbours(graph *g)
{
    int i, j, k;

    memcpy(g->end, g->first, (size_t)g->n * sizeof *g->end);
    for (i = 0; i < g->n; i++)
        for (k = g->first[i]; k < g->first[i + 1]; k++) {
            j = g->raw[k];
            if (j != i && (g->end[j] == g->first[j] || g->list[g->end[j] - 1] != i))
                g->list[g->end[j]++] = i;
        }
}

static bbm_status graph_new(graph *g, int n, int pairs, int (*pair)[2])
{
    g->n = n;
    g->first = calloc(3 * (size_t)n + 1 + 4 * (size_t)pairs, sizeof *g->first);
    if (!g->first)
        return BBM_NO_MEMORY;
    g->end = g->first + n + 1;
    g->level = g->end + n;
    g->list = g->level + n;
    g->raw = g->list + 2 * (size_t)pairs;
    list_neighbours(g, pairs, pair);
    sort_neighbours(g);
    return BBM_OK;
}

static int degree(const graph *g, int i)
{
    return g->end[i] - g->first[i];
}

/* Cuthill-McKee: the rows of a component, breadth first; those found from the same row by ascending degree. */
static int breadth_first(graph *g, int start, int *order)
{
    int count = 1, next, k, m;

    order[0] = start;
    g->level[start] = 0;
    for (next = 0; next < count; next++) {
        int i = order[next], found = count;

        for (k = g->first[i]; k < g->end[i]; k++) {
            int j = g->list[k];

            if (g->level[j] >= 0)
                continue;
            g->level[j] = g->level[i] + 1;
            for (m = count++; m > found && degree(g, order[m - 1]) > degree(g, j); m--)
                order[m] = order[m - 1];
            order[m] = j;
        }
    }
    return count;
}

/* A good start lies at an end of the component: search from anywhere, start again from the row found last, and so on
 * while that takes the search further. Returns the number of rows.                                              */
static int order_component(graph *g, int start, int *order)
{
    int depth = -1, count, last, k;

    for (;;) {
        count = breadth_first(g, start, order);
        last = order[count - 1];
        if (g->level[last] <= depth)
            return count;
        depth = g->level[last];
        start = last;
        for (k = 0; k < count; k++)
            g->level[order[k]] = -1;
    }
}

/* place and caller: all components one after the other, then the whole order turned round. */
static void reverse_cuthill_mckee(graph *g, bbm_matrix *K)
{
    int *order = K->caller, done = 0, i;

    for (i = 0; i < g->n; i++)
        g->level[i] = -1;
    for (i = 0; i < g->n; i++)
        if (g->level[i] < 0)
            done += order_component(g, i, order + done);
    for (i = 0; i < g->n; i++)
        K->place[order[i]] = g->n - 1 - i;
    for (i = 0; i < g->n; i++)
        K->caller[K->place[i]] = i;
}

/* first and column: the neighbours left of the diagonal. */
static void lay_out_rows(const graph *g, bbm_matrix *K)
{
    int count = 0, i, j, k;

    for (i = 0; i < g->n; i++) {
        for (k = g->first[K->caller[i]]; k < g->end[K->caller[i]]; k++) {
            j = K->place[g->list[k]];
            if (j < i)
                K->column[count++] = j;
        }
        K->first[i + 1] = count;
    }
}

/* ------------------------------------------------------------------------------------------------- the matrix */

/* All arrays of one type are one piece of memory. */
static bbm_status allocate(bbm_matrix *K, const graph *g)
{
    const size_t n = (size_t)g->n;
    size_t blocks;
    int i;

    K->n = g->n;
    for (i = 0; i < g->n; i++)
        K->blocks += degree(g, i);
    K->blocks /= 2;
    blocks = (size_t)K->blocks;
    if (!(K->place = calloc(3 * n + 1 + blocks, sizeof *K->place))
        || !(K->D = calloc(2 * (n + blocks), sizeof *K->D))
        || !(K->p = calloc(7 * 6 * n, sizeof *K->p)))
        return BBM_NO_MEMORY;
    K->caller = K->place + n;
    K->first = K->caller + n;
    K->column = K->first + n + 1;
    K->L = K->D + n;
    K->C = K->L + blocks;
    K->S = K->C + n;
    K->q = K->p + 6 * n;
    K->z = K->q + 6 * n;
    K->r = K->z + 6 * n;
    K->x = K->r + 6 * n;
    K->y = K->x + 6 * n;
    K->f = K->y + 6 * n;
    return BBM_OK;
}

void bbm_matrix_free(bbm_matrix *K)
{
    if (!K)
        return;
    free(K->place);
    free(K->D);
    free(K->p);
    free(K);
}

bbm_status bbm_matrix_new(int n, int pairs, int (*pair)[2], bbm_matrix **K)
{
    graph g = { 0, NULL, NULL, NULL, NULL, NULL };
    bbm_matrix *A;
    bbm_status status;
    int k;

    *K = NULL;
    if (n < 1)
        return BBM_NO_ELEMENT;
    for (k = 0; k < 2 * pairs; k++)
        if (pair[k / 2][k % 2] < 0 || pair[k / 2][k % 2] >= n)
            return BBM_BAD_INDEX;
    A = calloc(1, sizeof *A);
    status = A ? graph_new(&g, n, pairs, pair) : BBM_NO_MEMORY;
    if (status == BBM_OK)
        status = allocate(A, &g);
    if (status != BBM_OK)
        goto done;
    reverse_cuthill_mckee(&g, A);
    lay_out_rows(&g, A);
    *K = A;
    A = NULL;
done:
    free(g.first);
    bbm_matrix_free(A);
    return status;
}

void bbm_matrix_clear(bbm_matrix *K)
{
    memset(K->D, 0, (size_t)K->n * sizeof *K->D);
    memset(K->L, 0, (size_t)K->blocks * sizeof *K->L);
}

/* The block of row i and column j <= i, or NULL. A row has one to three blocks left of the diagonal: look at each. */
static matrix6 *find_block(const bbm_matrix *K, int i, int j)
{
    int k;

    for (k = K->first[i]; k < K->first[i + 1]; k++)
        if (K->column[k] == j)
            return &K->L[k];
    return i == j ? &K->D[i] : NULL;
}

/* K_ij += B. In the order of the places the block may lie right of the diagonal: then its transpose is stored. */
bbm_status bbm_matrix_add(bbm_matrix *K, int i, int j, double B[6][6])
{
    matrix6 *to;
    int row, column, right, a, b;

    if (i < 0 || i >= K->n || j < 0 || j >= K->n)
        return BBM_BAD_INDEX;
    row = K->place[i];
    column = K->place[j];
    right = row < column;
    to = right ? find_block(K, column, row) : find_block(K, row, column);
    if (!to)
        return BBM_BAD_INDEX;
    for (a = 0; a < 6; a++)
        for (b = 0; b < 6; b++)
            to->a[a][b] += right ? B[b][a] : B[a][b];
    return BBM_OK;
}

int bbm_matrix_bandwidth(const bbm_matrix *K)
{
    int width = 0, i, k;

    for (i = 0; i < K->n; i++)
        for (k = K->first[i]; k < K->first[i + 1]; k++)
            if (i - K->column[k] > width)
                width = i - K->column[k];
    return width;
}

/* ------------------------------------------------------------------------------------------------- the kernels
 * Written so that a compiler can do two entries at a time without changing the order of a sum.                  */

/* y += B x, each row in two partial sums: of the even and of the odd columns. */
static void add_product(const matrix6 *B, const double *restrict x, double *restrict y)
{
    double s[6][2];
    int a;

    for (a = 0; a < 6; a++) {
        s[a][0] = B->a[a][0] * x[0] + B->a[a][2] * x[2] + B->a[a][4] * x[4];
        s[a][1] = B->a[a][1] * x[1] + B->a[a][3] * x[3] + B->a[a][5] * x[5];
    }
    for (a = 0; a < 6; a++)
        y[a] += s[a][0] + s[a][1];
}

/* y += B^T x, and for a symmetric B y += B x. */
static void add_transposed(const matrix6 *B, const double *restrict x, double *restrict y)
{
    int b;

    for (b = 0; b < 6; b++)
        y[b] += (B->a[0][b] * x[0] + B->a[1][b] * x[1]) + (B->a[2][b] * x[2] + B->a[3][b] * x[3])
              + (B->a[4][b] * x[4] + B->a[5][b] * x[5]);
}

/* x.y */
static double dot(int n, const double *x, const double *y)
{
    double s = 0.0;
    int i;

    for (i = 0; i < n; i++, x += 6, y += 6)
        s += (x[0] * y[0] + x[1] * y[1]) + (x[2] * y[2] + x[3] * y[3]) + (x[4] * y[4] + x[5] * y[5]);
    return s;
}

/* z = x + c y; z may be x or y. */
static void combine(int n, const double *x, double c, const double *y, double *z)
{
    int i;

    for (i = 0; i < 6 * n; i += 2) {
        double even = x[i] + c * y[i], odd = x[i + 1] + c * y[i + 1];

        z[i] = even;
        z[i + 1] = odd;
    }
}

static void copy(int n, const double *x, double *y)
{
    memcpy(y, x, 6 * (size_t)n * sizeof *y);
}

static void set_zero(int n, double *x)
{
    memset(x, 0, 6 * (size_t)n * sizeof *x);
}

/* y = K x. Block row i of x and y is row[i], or i itself without `row`. */
static void multiply(const bbm_matrix *K, const int *row, const double *x, double *y)
{
    int i, k;

    for (i = 0; i < K->n; i++) {
        const int to = 6 * (row ? row[i] : i);

        set_zero(1, y + to);
        add_transposed(&K->D[i], x + to, y + to);
        for (k = K->first[i]; k < K->first[i + 1]; k++) {
            const int from = 6 * (row ? row[K->column[k]] : K->column[k]);

            add_product(&K->L[k], x + from, y + to);
            add_transposed(&K->L[k], x + to, y + from);
        }
    }
}

void bbm_matrix_multiply(const bbm_matrix *K, const double *x, double *y)
{
    multiply(K, K->caller, x, y);
}

/* G = C^-1, where D = C C^T is the Cholesky factorisation. Returns 0 if D is not positive definite. */
static int invert_factor(const matrix6 *D, matrix6 *G)
{
    double C[6][6], s;
    int i, j, k;

    for (j = 0; j < 6; j++)
        for (i = j; i < 6; i++) {
            s = D->a[i][j];
            for (k = 0; k < j; k++)
                s -= C[i][k] * C[j][k];
            if (i == j && !(s > 0.0))
                return 0;
            C[i][j] = i == j ? sqrt(s) : s / C[j][j];
        }
    for (j = 0; j < 6; j++)
        for (i = 0; i < 6; i++) {
            s = i == j;
            for (k = j; k < i; k++)
                s -= C[i][k] * G->a[k][j];
            G->a[i][j] = i < j ? 0.0 : s / C[i][i];
        }
    return 1;
}

/* K->C = C_i^-1. If D_i is not positive definite, info->element says which row that is. */
static bbm_status factor_diagonal(bbm_matrix *K, bbm_pcg_info *info)
{
    int i;

    for (i = 0; i < K->n; i++)
        if (!invert_factor(&K->D[i], &K->C[i])) {
            info->element = K->caller[i];
            return BBM_NOT_POSITIVE_DEFINITE;
        }
    return BBM_OK;
}

/* Counts an iteration, unless the limit is reached or p.Kp, perhaps a NaN, shows that K is not positive definite. */
static bbm_status may_go_on(double pKp, const bbm_pcg *pcg, bbm_pcg_info *info)
{
    if (info->iterations == pcg->iterations)
        return BBM_NOT_CONVERGED;
    if (!(pKp > 0.0))
        return BBM_NOT_POSITIVE_DEFINITE;
    info->iterations++;
    return BBM_OK;
}

/* ---------------------------------------------------------------------------------------------- textbook SSOR-PCG */

/* K->C = -w D_i^-1 = -w C_i^-T C_i^-1, from C_i^-1 */
static void invert_diagonal(bbm_matrix *K, double w)
{
    int i, a, b, k;

    for (i = 0; i < K->n; i++) {
        const matrix6 G = K->C[i];

        for (a = 0; a < 6; a++)
            for (b = 0; b < 6; b++) {
                double s = 0.0;

                for (k = 0; k < 6; k++)
                    s += G.a[k][a] * G.a[k][b];
                K->C[i].a[a][b] = -w * s;
            }
    }
}

/* z = M^-1 r:     (D/w + L) y = r            y_i = -w D_i^-1 (sum_j<i L_ij y_j - r_i)
 *               (D/w + L)^T z = D/w y        z_i = y_i - w D_i^-1 sum_k>i L_ki^T z_k, each sum gathered in z_i  */
static void apply_ssor(const bbm_matrix *K, const double *r, double *z)
{
    double *y = K->y, s[6];
    int i, k, a;

    set_zero(K->n, y);
    set_zero(K->n, z);
    for (i = 0; i < K->n; i++) {
        for (a = 0; a < 6; a++)
            s[a] = -r[6 * i + a];
        for (k = K->first[i]; k < K->first[i + 1]; k++)
            add_product(&K->L[k], y + 6 * K->column[k], s);
        add_transposed(&K->C[i], s, y + 6 * i);
    }
    for (i = K->n - 1; i >= 0; i--) {
        copy(1, z + 6 * i, s);
        copy(1, y + 6 * i, z + 6 * i);
        add_transposed(&K->C[i], s, z + 6 * i);
        for (k = K->first[i]; k < K->first[i + 1]; k++)
            add_transposed(&K->L[k], z + 6 * i, z + 6 * K->column[k]);
    }
}

static bbm_status textbook(bbm_matrix *K, const bbm_pcg *pcg, bbm_pcg_info *info)
{
    const int n = K->n;
    double *x = K->x, *r = K->r, *z = K->z, *p = K->p, *q = K->q, rz, last, stop, pq;
    bbm_status status = BBM_OK;

    invert_diagonal(K, pcg->omega);
    set_zero(n, x);
    copy(n, K->f, r);
    apply_ssor(K, r, z);
    copy(n, z, p);
    rz = dot(n, r, z);
    stop = pcg->tolerance * sqrt(rz);
    while (!(sqrt(rz) <= stop)) {
        multiply(K, NULL, p, q);
        pq = dot(n, p, q);
        status = may_go_on(pq, pcg, info);
        if (status != BBM_OK)
            break;
        combine(n, x, rz / pq, p, x);
        combine(n, r, -rz / pq, q, r);
        apply_ssor(K, r, z);
        last = rz;
        rz = dot(n, r, z);
        combine(n, z, rz / last, p, p);
    }
    return status;
}

/* --------------------------------------------------------------------------------------- SSOR-PCG by Eisenstat */

/* K->S = -w C_i^-1 L_ij C_j^-T, so that E z = b reads z_i = b_i + sum_j<i (-w S_ij) z_j. */
static void scale_blocks(bbm_matrix *K, double w)
{
    int i, k, a, b, c;

    for (i = 0; i < K->n; i++)
        for (k = K->first[i]; k < K->first[i + 1]; k++) {
            const matrix6 *Gi = &K->C[i], *Gj = &K->C[K->column[k]], *L = &K->L[k];
            matrix6 *S = &K->S[k];

            memset(S, 0, sizeof *S);
            for (a = 0; a < 6; a++) {
                double t[6] = { 0, 0, 0, 0, 0, 0 };

                for (c = 0; c <= a; c++)
                    for (b = 0; b < 6; b++)
                        t[b] -= w * Gi->a[a][c] * L->a[c][b];
                add_product(Gj, t, S->a[a]);
            }
        }
}

/* t = E^-T p, where t holds p at first: each row, once it is done, is passed on to the rows that need it. */
static void backward(const bbm_matrix *K, double *t)
{
    int i, k;

    for (i = K->n - 1; i >= 0; i--)
        for (k = K->first[i]; k < K->first[i + 1]; k++)
            add_transposed(&K->S[k], t + 6 * i, t + 6 * K->column[k]);
}

/* y = E^-1 (p - (2-w) t) */
static void forward(const bbm_matrix *K, double w, const double *p, const double *t, double *restrict y)
{
    int i, k, a;

    for (i = 0; i < K->n; i++) {
        for (a = 6 * i; a < 6 * i + 6; a++)
            y[a] = p[a] - (2.0 - w) * t[a];
        for (k = K->first[i]; k < K->first[i + 1]; k++)
            add_product(&K->S[k], y + 6 * K->column[k], y + 6 * i);
    }
}

/* p.(t + y) */
static double dot_sum(int n, const double *p, const double *t, const double *y)
{
    double s = 0.0;
    int i;

    for (i = 0; i < n; i++, p += 6, t += 6, y += 6)
        s += (p[0] * (t[0] + y[0]) + p[1] * (t[1] + y[1])) + (p[2] * (t[2] + y[2]) + p[3] * (t[3] + y[3]))
           + (p[4] * (t[4] + y[4]) + p[5] * (t[5] + y[5]));
    return s;
}

/* x += a t, r -= a (t + y). Returns r.r. */
static double advance(const bbm_matrix *K, double a, const double *restrict t, const double *restrict y)
{
    double *restrict x = K->x, *restrict r = K->r, even = 0.0, odd = 0.0;
    int i;

    for (i = 0; i < 6 * K->n; i += 2) {
        x[i] += a * t[i];
        x[i + 1] += a * t[i + 1];
        r[i] -= a * (t[i] + y[i]);
        r[i + 1] -= a * (t[i + 1] + y[i + 1]);
        even += r[i] * r[i];
        odd += r[i + 1] * r[i + 1];
    }
    return even + odd;
}

/* p = r + b p, and a copy of it in t */
static void turn(int n, const double *restrict r, double b, double *restrict p, double *restrict t)
{
    int i;

    for (i = 0; i < 6 * n; i += 2) {
        p[i] = t[i] = r[i] + b * p[i];
        p[i + 1] = t[i + 1] = r[i + 1] + b * p[i + 1];
    }
}

static bbm_status eisenstat(bbm_matrix *K, const bbm_pcg *pcg, bbm_pcg_info *info)
{
    const int n = K->n;
    const double w = pcg->omega;
    double *x = K->x, *r = K->r, *p = K->p, *t = K->z, *y = K->y, rr, last, stop, pq;
    bbm_status status = BBM_OK;
    int i;

    scale_blocks(K, w);
    set_zero(n, x);
    set_zero(n, p);
    for (i = 0; i < n; i++)                     /* p = b */
        add_product(&K->C[i], K->f + 6 * i, p + 6 * i);
    forward(K, w, p, x, r);                     /* r = E^-1 b, as x = 0 */
    turn(n, r, 0.0, p, t);
    rr = dot(n, r, r);
    stop = pcg->tolerance * sqrt(rr);
    while (!(sqrt(rr) <= stop)) {
        backward(K, t);
        forward(K, w, p, t, y);
        pq = dot_sum(n, p, t, y);
        status = may_go_on(pq, pcg, info);
        if (status != BBM_OK)
            break;
        last = rr;
        rr = advance(K, rr / pq, t, y);
        turn(n, r, rr / last, p, t);
    }
    set_zero(n, y);
    for (i = 0; i < n; i++)                     /* x = w C^-T x */
        add_transposed(&K->C[i], x + 6 * i, y + 6 * i);
    combine(n, y, w - 1.0, y, x);
    return status;
}

/* ------------------------------------------------------------------------------------------------ the solution */

static int all_finite(size_t count, const double *x)
{
    size_t i;

    for (i = 0; i < count; i++)
        if (!isfinite(x[i]))
            return 0;
    return 1;
}

/* The largest entry of x without its sign */
static double largest(int n, const double *x)
{
    double m = 0.0;
    int i;

    for (i = 0; i < 6 * n; i++)
        m = fmax(m, fabs(x[i]));
    return m;
}

/* f = F / scale, so that its largest entry is 1. NEGLIGIBLE in place of 0 keeps denormals away. */
static void scale_load(bbm_matrix *K, const double *F, double scale)
{
    int i, a;

    for (i = 0; i < K->n; i++)
        for (a = 0; a < 6; a++) {
            double *f = &K->f[6 * K->place[i] + a];

            *f = F[6 * i + a] / scale;
            if (*f == 0.0)
                *f = NEGLIGIBLE;
        }
}

static bbm_status check(const bbm_matrix *K, const double *F, const bbm_pcg *pcg)
{
    const size_t n = (size_t)K->n, blocks = (size_t)K->blocks;

    if (!(pcg->omega > 0.0 && pcg->omega < 2.0) || !(pcg->tolerance > 0.0 && pcg->tolerance < 1.0))
        return BBM_BAD_PARAMETER;
    if (pcg->iterations < 1)
        return BBM_BAD_PARAMETER;
    if (!all_finite(6 * n, F) || !all_finite(36 * n, (double *)K->D) || !all_finite(36 * blocks, (double *)K->L))
        return BBM_NOT_FINITE;
    return BBM_OK;
}

/* |f - K x| / |f|; overwrites r and q. */
static double true_residual(bbm_matrix *K)
{
    multiply(K, NULL, K->x, K->q);
    combine(K->n, K->f, -1.0, K->q, K->r);
    return sqrt(dot(K->n, K->r, K->r) / dot(K->n, K->f, K->f));
}

/* If the iteration ends early, D is its last iterate; if it did not begin, D is 0, iterations 0 and residual 1. */
bbm_status bbm_solve(bbm_matrix *K, const double *F, double *D, const bbm_pcg *pcg, bbm_pcg_info *info)
{
    const bbm_pcg_info none = { 0, 1.0, -1 };
    bbm_status status = check(K, F, pcg);
    double scale;
    int i, a;

    *info = none;
    set_zero(K->n, D);
    if (status == BBM_OK)
        status = factor_diagonal(K, info);
    if (status != BBM_OK)
        return status;
    scale = largest(K->n, F);
    if (scale == 0.0) {
        info->residual = 0.0;
        return BBM_OK;
    }
    scale_load(K, F, scale);
    status = pcg->form == BBM_TEXTBOOK ? textbook(K, pcg, info) : eisenstat(K, pcg, info);
    info->residual = true_residual(K);
    for (i = 0; i < K->n; i++)
        for (a = 0; a < 6; a++)
            D[6 * i + a] = scale * K->x[6 * K->place[i] + a];
    return status == BBM_OK && !all_finite(6 * (size_t)K->n, D) ? BBM_NOT_FINITE : status;
}
