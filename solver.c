/* solver.c - the linear solver of section 4: K D = F by conjugate gradients preconditioned with
 * SSOR.
 *
 * Storage. K is symmetric and consists of 6x6 blocks, a block row for each element. Write
 *
 *     K = L + D + L^T,      D: the diagonal blocks,  L: the blocks left of them.
 *
 * Only D and those blocks of L that are not zero are stored, row by row: `first` says where the
 * blocks of a row begin and `back` how far left of the diagonal each of them is. The block rows are
 * not in the caller's order but in the reverse Cuthill-McKee order: number the elements from one
 * end of the body to the other, breadth first, and reverse the numbers; rows with many neighbours,
 * as a base under all has, come last. The blocks of L then lie in
 * a narrow band below the diagonal, and what a sweep reads was written shortly before. The band
 * itself is not stored: an element has three or four neighbours and a band has sqrt(n) places, all
 * but those few zero for ever, because an iteration, unlike a factorisation, fills nothing in. The
 * pattern is made once (bbm_matrix_new); each time step clears K and adds the submatrices anew.
 *
 * Nothing far away matters. Blocks that no bond and no contact joins, however indirectly, are
 * different components of K: no row of one has a block in a column of another. Each component is
 * solved by itself, with its own scale of F, its own steps and its own end of the iteration. In one
 * iteration for all, a stone that flies past would count the forces in a pile at rest as nothing
 * against its own, and leave them unsolved. The order puts the rows of a component one after the
 * other: they are the rows `from` to `to` - 1 of all that follows. Its D is the same to the last
 * bit whatever else there is.
 *
 * SSOR-PCG as in the textbooks, with a relaxation factor w, 0 < w < 2:
 *
 *     M = (D/w + L) (D/w)^-1 (D/w + L)^T
 *
 *     x = 0,  r = F,  u = M^-1 r,  p = u
 *     until sqrt(r.u) <= tolerance * its first value:
 *         a = r.u / p.K p
 *         x += a p,  r -= a K p
 *         u = M^-1 r
 *         p = u + (r.u / its last value) p
 *
 * The factor 1/(2-w) that M often has is left out: it changes neither x nor the end of the
 * iteration.
 *
 * Scaling. Factor D_i = C_i C_i^T once, and write r, x, K for C^-1 r, C^T x, C^-1 K C^-T: the
 * iterates stay the same. The diagonal blocks of K become I and those of L C_i^-1 L_ij C_j^-T; let
 * S be w times the latter, and E = I + S. Then
 *
 *     K = I + (S + S^T)/w,    M = E E^T/w.
 *
 * Two sweeps over S are M^-1 but for the factor w, and since the second says S^T u = y - u, a
 * product with K takes only one more pass over S:
 *
 *     y = E^-1 r,   u = E^-T y,   w K u = y + (w-1) u + S u,
 *
 * and with p = u + b p also w K p = w K u + b (w K p). The factors w cancel in a and in r, and
 * leave 1/w of x: D = w C^-T x.
 *
 * Another method than this one may make something of K when it has been scaled, correct y between
 * the sweeps, or iterate in a way of its own (bbm_method).
 *
 * What a tolerance can mean. The residual of the recurrence, r, shrinks as far as one likes, but F
 * - K D cannot become smaller than about eps |K| |D|, in a stiff body 1e-10 |F| or more (eps =
 * 2e-16). A tolerance much below 1e-10 buys iterations and nothing else. Therefore bbm_solve stops
 * on r and then reports the true residual, computed afresh.
 *
 * Denormals. When a single element is loaded, a sweep carries the load from element to element and
 * weakens it each time, down to numbers below 1e-308, on which many processors take ten or a
 * hundred times longer; rounding can keep them alive through all the rest of the body. Therefore F
 * is scaled to a largest entry near 1, and its zeros become NEGLIGIBLE: no number fades below that,
 * squares of such numbers are still far from 1e-308, and nothing that matters changes. It costs
 * nothing in an iteration.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "base/base.h"

/* Against the largest entry of F. */
#define NEGLIGIBLE 1e-100
/* A row has many neighbours: more than so many times the mean of its component. */
#define HUB 3.0

/* -------------------------------------------------------------------- the pattern and its order */

typedef struct {                /* who is a neighbour of whom, in the caller's numbers         */
    int n;
    int *first, (*end)[2];      /* [n+1]  of i: end[first[i] .. first[i+1]-1][1], ascending     */
    int *level;                 /* [n]    distance from the start of the search, -1: not found  */
    int *order;                 /* [n]    as they are found                                     */
} graph;

static int compare_ends(const void *a, const void *b)
{
    const int *p = a, *q = b, by = p[0] == q[0];

    return (p[by] > q[by]) - (p[by] < q[by]);
}

/* Sorts both ends of all pairs by the row and then by the neighbour, and drops what comes twice. */
static bbm_status graph_new(graph *g, int n, int pairs, int (*pair)[2])
{
    if (n < 1)
        return BBM_NO_ELEMENT;
    for (int k = 0; k < 2 * pairs; k++)
        if (pair[k / 2][k % 2] < 0 || pair[k / 2][k % 2] >= n)
            return BBM_BAD_INDEX;
    g->n = n;
    g->first = calloc(3 * (size_t)n + 1, sizeof *g->first);
    g->end = calloc(2 * (size_t)pairs + 1, sizeof *g->end);
    if (!g->first || !g->end)
        return BBM_NO_MEMORY;
    g->level = g->first + n + 1;
    g->order = g->level + n;
    for (int k = 0; k < 2 * pairs; k++) {
        g->end[k][0] = pair[k / 2][k % 2];
        g->end[k][1] = pair[k / 2][1 - k % 2];
    }
    qsort(g->end, 2 * (size_t)pairs, sizeof *g->end, compare_ends);
    int count = 0;
    for (int i = 0, k = 0; i < n; i++) {
        for (; k < 2 * pairs && g->end[k][0] == i; k++)
            if (g->end[k][1] != i && (count == g->first[i] || g->end[count - 1][1] != g->end[k][1]))
                g->end[count++][1] = g->end[k][1];
        g->first[i + 1] = count;
        g->level[i] = -1;
    }
    return BBM_OK;
}

static int degree(const graph *g, int i) { return g->first[i + 1] - g->first[i]; }

/* Cuthill-McKee: the rows of a component, breadth first; those found from the same row by ascending
 * degree. Returns their number. */
static int breadth_first(graph *g, int start, int *order)
{
    int count = 1;

    order[0] = start;
    g->level[start] = 0;
    for (int next = 0; next < count; next++) {
        const int i = order[next], found = count;
        for (int k = g->first[i]; k < g->first[i + 1]; k++) {
            const int j = g->end[k][1];
            if (g->level[j] >= 0)
                continue;
            g->level[j] = g->level[i] + 1;
            int m = count++;
            for (; m > found && degree(g, order[m - 1]) > degree(g, j); m--)
                order[m] = order[m - 1];
            order[m] = j;
        }
    }
    return count;
}

/* A good start lies at an end of the component: search from anywhere, start again from the row
 * found last, and so on while that takes the search further. */
static int order_component(graph *g, int start, int *order)
{
    for (int depth = -1;;) {
        const int count = breadth_first(g, start, order);
        start = order[count - 1];
        if (g->level[start] <= depth)
            return count;
        depth = g->level[start];
        for (int k = 0; k < count; k++)
            g->level[order[k]] = -1;
    }
}

/* The rows of a component in the order to reverse: first those with many neighbours, as a base
 * under all has; they come last then and widen no envelope. `rows`: scratch. Returns their
 * number. */
static int order_with_hubs(graph *g, int start, int *order, int *rows)
{
    const int count = breadth_first(g, start, rows);
    int done = 0, ends = 0;

    for (int k = 0; k < count; k++)
        ends += degree(g, rows[k]);
    for (int k = 0; k < count; k++)
        if (degree(g, rows[k]) > HUB * ends / count)
            order[done++] = rows[k];
        else
            g->level[rows[k]] = -1;
    for (int k = 0; k < count; k++)
        if (g->level[rows[k]] < 0)
            done += order_component(g, rows[k], order + done);
    for (int k = 0; k < count; k++)
        g->level[order[k]] = k > 0;
    return count;
}

/* place[i] of row i: all components one after the other, then the whole order reversed. */
static void reverse_cuthill_mckee(graph *g, int place[])
{
    int done = 0;

    for (int i = 0; i < g->n; i++)
        if (g->level[i] < 0)
            done += order_with_hubs(g, i, g->order + done, place);
    for (int i = 0; i < g->n; i++)
        place[g->order[i]] = g->n - 1 - i;
}

/* ----------------------------------------------------------------------------------- the matrix */

/* All arrays of one type are one piece of memory. */
static bbm_status allocate(bbm_matrix *K, const graph *g)
{
    const size_t n = (size_t)g->n, blocks = (size_t)g->first[n] / 2;

    K->n = K->to = g->n;
    K->place = calloc(5 * n + 2 + blocks, sizeof *K->place);
    K->D = calloc(2 * (n + blocks), sizeof *K->D);
    K->x = calloc(6 * 6 * n, sizeof *K->x);
    if (!K->place || !K->D || !K->x)
        return BBM_NO_MEMORY;
    K->caller = K->place + n;
    K->first = K->caller + n;
    K->start = K->first + n + 1;
    K->component = K->start + n + 1;
    K->back = K->component + n;
    K->L = K->D + n;
    K->G = K->L + blocks;
    K->S = K->G + n;
    K->r = K->x + 6 * n;
    K->y = K->r + 6 * n;
    K->u = K->y + 6 * n;
    K->p = K->u + 6 * n;
    K->q = K->p + 6 * n;
    return BBM_OK;
}

/* caller, component, first, back and start. A component ends with the row where the search
 * began. */
static void lay_out_rows(bbm_matrix *K, const graph *g)
{
    int count = 0;

    for (int i = 0; i < K->n; i++)
        K->caller[K->place[i]] = i;
    for (int i = 0; i < K->n; i++) {
        const int row = K->caller[i];
        for (int k = g->first[row]; k < g->first[row + 1]; k++)
            if (K->place[g->end[k][1]] < i)
                K->back[count++] = i - K->place[g->end[k][1]];
        K->first[i + 1] = count;
        K->component[row] = K->components;
        if (g->level[row] == 0)
            K->start[++K->components] = i + 1;
    }
}

bbm_status bbm_matrix_new(int n, int pairs, int (*pair)[2], bbm_matrix **out)
{
    graph g = { 0 };
    bbm_matrix *K = calloc(1, sizeof *K);
    bbm_status status = K ? graph_new(&g, n, pairs, pair) : BBM_NO_MEMORY;

    if (!status)
        status = allocate(K, &g);
    if (!status) {
        reverse_cuthill_mckee(&g, K->place);
        lay_out_rows(K, &g);
    } else {
        bbm_matrix_free(K);
        K = NULL;
    }
    free(g.first);
    free(g.end);
    *out = K;
    return status;
}

void bbm_matrix_free(bbm_matrix *K)
{
    if (!K)
        return;
    if (K->free_extra)
        K->free_extra(K->extra);
    free(K->place);
    free(K->D);
    free(K->x);
    free(K);
}

void bbm_matrix_keep(bbm_matrix *K, int keep) { K->is_kept = keep; }

void bbm_matrix_clear(bbm_matrix *K)
{
    if (K->is_kept)
        return;
    memset(K->D, 0, (size_t)K->n * sizeof *K->D);
    memset(K->L, 0, (size_t)K->first[K->n] * sizeof *K->L);
    K->ready = K->terms = K->lacks = 0;
}

/* Where K_ij, or K_ji if i comes before j, is stored; NULL: nowhere. A row has one to three blocks
 * left of the diagonal: look at each. */
static double (*find_block(const bbm_matrix *K, int i, int j))[6]
{
    if (i < 0 || i >= K->n || j < 0 || j >= K->n)
        return NULL;
    const int a = K->place[i], b = K->place[j], row = a > b ? a : b, left = abs(a - b);

    for (int k = K->first[row]; k < K->first[row + 1]; k++)
        if (K->back[k] == left)
            return K->L[k];
    return left == 0 ? K->D[row] : NULL;
}

/* K_ij += B */
bbm_status bbm_matrix_add(bbm_matrix *K, int i, int j, double B[6][6])
{
    double (*to)[6] = find_block(K, i, j);

    if (K->is_kept)
        return BBM_OK;
    K->lacks |= !to;
    if (!to)
        return BBM_BAD_INDEX;
    const int right = K->place[i] < K->place[j];
    for (int a = 0; a < 6; a++)
        for (int b = 0; b < 6; b++)
            to[a][b] += right ? B[b][a] : B[a][b];
    K->ready = 0;
    return BBM_OK;
}

/* B = K_ij, without terms; 0 where the pattern has no block. */
void bbm_matrix_get(const bbm_matrix *K, int i, int j, double B[6][6])
{
    double (*from)[6] = find_block(K, i, j);
    const int right = K->place[i] < K->place[j];

    for (int a = 0; a < 6; a++)
        for (int b = 0; b < 6; b++)
            B[a][b] = !from ? 0 : right ? from[b][a] : from[a][b];
}

/* ------------------------------------------------------------------------------------- the kernels
 * Written so that a compiler can do two entries at a time without changing the order of a sum. */

/* y += c B x, each row in two partial sums: of the even and of the odd columns. */
static void multiply_add(double c, double B[6][6], const double *restrict x, double *restrict y)
{
    double s[6][2];

    for (int a = 0; a < 6; a++) {
        s[a][0] = B[a][0] * x[0] + B[a][2] * x[2] + B[a][4] * x[4];
        s[a][1] = B[a][1] * x[1] + B[a][3] * x[3] + B[a][5] * x[5];
    }
    for (int a = 0; a < 6; a++)
        y[a] += c * (s[a][0] + s[a][1]);
}

/* y += c B^T x, and for a symmetric B y += c B x. */
static void multiply_add_transposed(double c, double B[6][6], const double *restrict x,
                                    double *restrict y)
{
    for (int b = 0; b < 6; b++)
        y[b] += c * ((B[0][b] * x[0] + B[1][b] * x[1]) + (B[2][b] * x[2] + B[3][b] * x[3])
                     + (B[4][b] * x[4] + B[5][b] * x[5]));
}

static int is_in_hand(const bbm_matrix *K, const bbm_term *t)
{
    return t->row[0] >= K->from && t->row[0] < K->to;
}

/* y += u v^T x in the caller's order. */
static void multiply_term(const bbm_matrix *K, const bbm_term *t, const double *x, double *y)
{
    double vx = 0;

    for (int k = 0; k < 12; k++)
        vx += t->v[k / 6][k % 6] * x[6 * K->caller[t->row[k / 6]] + k % 6];
    for (int k = 0; k < 12; k++)
        y[6 * K->caller[t->row[k / 6]] + k % 6] += t->u[k / 6][k % 6] * vx;
}

/* y = K x in the caller's order, for the rows in hand. */
void bbm_matrix_multiply(const bbm_matrix *K, const double *x, double *y)
{
    for (int i = K->from; i < K->to; i++) {
        const int row = 6 * K->caller[i];
        memset(y + row, 0, 6 * sizeof *y);
        multiply_add_transposed(1, K->D[i], x + row, y + row);
        for (int k = K->first[i]; k < K->first[i + 1]; k++) {
            const int column = 6 * K->caller[i - K->back[k]];
            multiply_add(1, K->L[k], x + column, y + row);
            multiply_add_transposed(1, K->L[k], x + row, y + column);
        }
    }
    for (int t = 0; t < K->terms; t++)
        if (is_in_hand(K, &K->term[t]))
            multiply_term(K, &K->term[t], x, y);
}

/* y += c S x. With c = -1 and x = y that is y = E^-1 y: a row takes those before it as they are. */
void bbm_multiply_lower(const bbm_matrix *K, double c, const double *x, double *y)
{
    for (int i = K->from; i < K->to; i++)
        for (int k = K->first[i]; k < K->first[i + 1]; k++)
            multiply_add(c, K->S[k], x + 6 * (i - K->back[k]), y + 6 * i);
}

/* y += c S^T x. With c = -1 and x = y that is y = E^-T y: a row is passed on once it is done. */
void bbm_multiply_upper(const bbm_matrix *K, double c, const double *x, double *y)
{
    for (int i = K->to - 1; i >= K->from; i--)
        for (int k = K->first[i]; k < K->first[i + 1]; k++)
            multiply_add_transposed(c, K->S[k], x + 6 * i, y + 6 * (i - K->back[k]));
}

/* x.y */
static double dot(const bbm_matrix *K, const double *x, const double *y)
{
    double s = 0;

    for (int i = 6 * K->from; i < 6 * K->to; i += 6)
        s += (x[i] * y[i] + x[i + 1] * y[i + 1]) + (x[i + 2] * y[i + 2] + x[i + 3] * y[i + 3])
           + (x[i + 4] * y[i + 4] + x[i + 5] * y[i + 5]);
    return s;
}

static void copy(const bbm_matrix *K, const double *from, double *to)
{
    memcpy(to + 6 * K->from, from + 6 * K->from, 6 * (size_t)(K->to - K->from) * sizeof *to);
}

/* z = x + c y; z may be x or y. */
void bbm_combine(const bbm_matrix *K, const double *x, double c, const double *y, double *z)
{
    for (int i = 6 * K->from; i < 6 * K->to; i += 2) {
        const double even = x[i] + c * y[i], odd = x[i + 1] + c * y[i + 1];
        z[i] = even;
        z[i + 1] = odd;
    }
}

/* ---------------------------------------------------------------------------------- the scaling */

/* G = C^-1, where D = C C^T by Cholesky. Returns 0 if D is not positive definite. */
static int invert_factor(double D[6][6], double G[6][6])
{
    double C[6][6];

    for (int j = 0; j < 6; j++)
        for (int i = j; i < 6; i++) {
            double s = D[i][j];
            for (int k = 0; k < j; k++)
                s -= C[i][k] * C[j][k];
            if (i == j && !(s > 0))
                return 0;
            C[i][j] = i == j ? sqrt(s) : s / C[j][j];
        }
    for (int j = 0; j < 6; j++)
        for (int i = 0; i < 6; i++) {
            double s = i == j;
            for (int k = j; k < i; k++)
                s -= C[i][k] * G[k][j];
            G[i][j] = i < j ? 0 : s / C[i][i];
        }
    return 1;
}

/* S = w Gi L Gj^T */
static void scale_block(double w, double Gi[6][6], double L[6][6], double Gj[6][6], double S[6][6])
{
    memset(S, 0, 36 * sizeof **S);
    for (int a = 0; a < 6; a++) {
        double t[6] = { 0 };
        for (int c = 0; c <= a; c++)
            for (int b = 0; b < 6; b++)
                t[b] += w * Gi[a][c] * L[c][b];
        multiply_add(1, Gj, t, S[a]);
    }
}

static int all_finite(size_t count, const double *x)
{
    for (size_t i = 0; i < count; i++)
        if (!isfinite(x[i]))
            return 0;
    return 1;
}

/* Makes of K what the solution needs; further solutions with the same K find it ready. If a D_i is
 * not positive definite, info->element says which row that is. */
static bbm_status make_ready(bbm_matrix *K, const bbm_pcg *pcg, bbm_pcg_info *info)
{
    if (K->ready && K->method == pcg->method && K->omega == pcg->omega)
        return BBM_OK;
    K->ready = 0;
    if (!all_finite(36 * (size_t)K->n, **K->D) || !all_finite(36 * (size_t)K->first[K->n], **K->L))
        return BBM_NOT_FINITE;
    for (int i = 0; i < K->n; i++) {
        if (!invert_factor(K->D[i], K->G[i])) {
            info->element = K->caller[i];
            return BBM_NOT_POSITIVE_DEFINITE;
        }
        for (int k = K->first[i]; k < K->first[i + 1]; k++)
            scale_block(pcg->omega, K->G[i], K->L[k], K->G[i - K->back[k]], K->S[k]);
    }
    K->ready = 1;
    K->method = pcg->method;
    K->omega = pcg->omega;
    if (K->method->make_ready)
        K->method->make_ready(K);
    return BBM_OK;
}

/* The power of two below the largest entry of F in the rows in hand: to divide by it rounds
 * nothing. */
static double magnitude(const bbm_matrix *K, const double *F)
{
    double m = 0;
    int exponent;

    for (int i = 6 * K->from; i < 6 * K->to; i++)
        m = fmax(m, fabs(F[6 * K->caller[i / 6] + i % 6]));
    (void)frexp(m, &exponent);
    return m == 0 ? 0 : ldexp(1, exponent - 1);
}

/* x = p = q = 0 and r = G F/scale; the largest entry of F/scale is in [1, 2). */
static void scale_load(const bbm_matrix *K, const double *F, double scale)
{
    for (int i = K->from; i < K->to; i++) {
        double f[6];
        for (int a = 0; a < 6; a++) {
            f[a] = F[6 * K->caller[i] + a] / scale;
            f[a] = f[a] == 0 ? NEGLIGIBLE : f[a];
            K->x[6 * i + a] = K->r[6 * i + a] = K->p[6 * i + a] = K->q[6 * i + a] = 0;
        }
        multiply_add(1, K->G[i], f, K->r + 6 * i);
    }
}

/* D = scale w G^T x */
static void unscale_solution(const bbm_matrix *K, double scale, double *D)
{
    for (int i = K->from; i < K->to; i++)
        multiply_add_transposed(scale * K->omega, K->G[i], K->x + 6 * i, D + 6 * K->caller[i]);
}

/* ------------------------------------------------------------------------------------- SSOR-PCG */

/* Counts an iteration, unless the limit is reached or p.Kp, perhaps a NaN, shows that K is not
 * positive definite. */
bbm_status bbm_count_iteration(double pKp, const bbm_pcg *pcg, bbm_pcg_info *info)
{
    if (info->iterations == pcg->iterations)
        return BBM_NOT_CONVERGED;
    if (!(pKp > 0))
        return BBM_NOT_POSITIVE_DEFINITE;
    info->iterations++;
    return BBM_OK;
}

/* y = E^-1 r, u = E^-T y. Returns r.u. */
static double precondition(const bbm_matrix *K)
{
    copy(K, K->r, K->y);
    bbm_multiply_lower(K, -1, K->y, K->y);
    if (K->method->correct)
        K->method->correct(K, K->y);
    copy(K, K->y, K->u);
    bbm_multiply_upper(K, -1, K->u, K->u);
    return dot(K, K->r, K->u);
}

/* p = u + b p,  q = w K p = y + (w-1) u + S u + b q. Returns p.q. */
static double new_direction(const bbm_matrix *K, double b)
{
    bbm_combine(K, K->u, b, K->p, K->p);
    bbm_combine(K, K->y, b, K->q, K->q);
    bbm_combine(K, K->q, K->omega - 1, K->u, K->q);
    bbm_multiply_lower(K, 1, K->u, K->q);
    return dot(K, K->p, K->q);
}

/* The textbook's iteration, from x = 0 and r = F of the rows in hand. */
static bbm_status iterate(bbm_matrix *K, const bbm_pcg *pcg, bbm_pcg_info *info)
{
    double ru = precondition(K), b = 0;
    const double stop = pcg->tolerance * sqrt(ru);

    while (!(sqrt(ru) <= stop)) {
        const double pq = new_direction(K, b), last = ru;
        const bbm_status status = bbm_count_iteration(pq, pcg, info);
        if (status)
            return status;
        bbm_combine(K, K->x, ru / pq, K->p, K->x);
        bbm_combine(K, K->r, -ru / pq, K->q, K->r);
        ru = precondition(K);
        b = ru / last;
    }
    return BBM_OK;
}

/* --------------------------------------------------------------------------------- the solution */

static bbm_status check(const bbm_matrix *K, const double *F, const bbm_pcg *pcg)
{
    if (!(pcg->omega > 0 && pcg->omega < 2) || !(pcg->tolerance > 0 && pcg->tolerance < 1)
        || pcg->iterations < 1)
        return BBM_BAD_PARAMETER;
    if (K->lacks)
        return BBM_BAD_INDEX;
    return all_finite(6 * (size_t)K->n, F) ? BBM_OK : BBM_NOT_FINITE;
}

/* From x = 0 and r = F, scaled, to x for the rows in hand. */
static bbm_status solve_rows(bbm_matrix *K, const bbm_pcg *pcg, bbm_pcg_info *info)
{
    for (int t = 0; t < K->terms; t++)
        if (is_in_hand(K, &K->term[t]))
            return K->solve_terms(K, pcg, info);
    return (K->method->iterate ? K->method->iterate : iterate)(K, pcg, info);
}

/* The rows of D in hand. Where the iteration ends early, they are those of its last iterate. */
static bbm_status solve_component(bbm_matrix *K, const double *F, double *D, const bbm_pcg *pcg,
                                  bbm_pcg_info *info)
{
    const double scale = magnitude(K, F);
    double rr = 0, ff = 0;

    if (scale == 0)
        return BBM_OK;
    scale_load(K, F, scale);
    const bbm_status status = solve_rows(K, pcg, info);
    unscale_solution(K, scale, D);
    bbm_matrix_multiply(K, D, K->q);
    for (int i = 6 * K->from; i < 6 * K->to; i++) {
        const int row = 6 * K->caller[i / 6] + i % 6;
        const double r = (F[row] - K->q[row]) / scale, f = F[row] / scale;
        rr += r * r;
        ff += f * f;
    }
    info->residual = sqrt(rr / ff);
    return status;
}

/* If the iteration did not begin, D is 0, iterations 0 and residual 1. One component that fails
 * does not keep the others from being solved. */
bbm_status bbm_solve(bbm_matrix *K, const double *F, double *D, const bbm_pcg *wanted,
                     bbm_pcg_info *info)
{
    static const bbm_method paper = { 0 };
    const clock_t start = clock();
    bbm_pcg pcg = *wanted;
    bbm_status status = check(K, F, &pcg);

    *info = (bbm_pcg_info){ .residual = 1, .element = -1 };
    memset(D, 0, 6 * (size_t)K->n * sizeof *D);
    if (!pcg.method)
        pcg.method = &paper;
    if (pcg.method->choose)
        pcg.method->choose(K, &pcg);
    if (!status)
        status = make_ready(K, &pcg, info);
    const clock_t ready = clock();
    info->seconds[0] = (double)(ready - start) / CLOCKS_PER_SEC;
    if (status)
        return status;
    info->residual = 0;
    for (int c = 0; c < K->components; c++) {
        bbm_pcg_info one = { .element = -1 };
        K->from = K->start[c];
        K->to = K->start[c + 1];
        const bbm_status s = solve_component(K, F, D, &pcg, &one);
        info->element = status ? info->element : one.element;
        status = status ? status : s;
        info->iterations = one.iterations > info->iterations ? one.iterations : info->iterations;
        info->residual = one.residual <= info->residual ? info->residual : one.residual;
    }
    K->from = 0;
    K->to = K->n;
    info->seconds[1] = (double)(clock() - ready) / CLOCKS_PER_SEC;
    return !status && !all_finite(6 * (size_t)K->n, D) ? BBM_NOT_FINITE : status;
}
