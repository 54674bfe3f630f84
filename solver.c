/* solver.c - the linear solver of section 4: K D = F by conjugate gradients preconditioned with SSOR. This is complete
 * in itself and comes first. After it, under an essay of its own, comes what goes beyond the paper: a second, coarse
 * level, by which the number of iterations no longer grows with the mesh.
 *
 * Storage. K is symmetric and consists of 6x6 blocks, a block row for each element. Write
 *
 *     K = L + D + L^T,      D: the diagonal blocks,  L: the blocks left of them.
 *
 * Only D and those blocks of L that are not zero are stored, row by row: `first` says where the blocks of a row begin
 * and `back` how far left of the diagonal each of them is. The block rows are not in the caller's order but in the
 * reverse Cuthill-McKee order: number the elements from one end of the body to the other, breadth first, and turn the
 * numbers round. The blocks of L then lie in a narrow band below the diagonal, and what a sweep reads was written shortly
 * before. The band itself is not stored: an element has three or four neighbours and a band has sqrt(n) places, all
 * but those few zero for ever, because an iteration, unlike a factorisation, fills nothing in.
 * The pattern is made once (bbm_matrix_new); each time step clears K and adds the submatrices anew.
 *
 * Nothing far away matters. Blocks that no bond and no contact joins, however indirectly, are different components of
 * K: no row of one has a block in a column of another. Each component is solved by itself, with its own scale of F,
 * its own steps and its own end of the iteration. In one iteration for all, a stone that flies past would count the
 * forces in a pile at rest as nothing against its own, and leave them unsolved. The order puts the rows of a component
 * one after the other, and `back` tells the same wherever they begin: a component is a matrix like K, with fewer rows.
 * Its D is the same to the last bit whatever else there is.
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
 * them alive through all the rest of the body. Therefore F is scaled to a largest entry near 1, and its zeros become
 * NEGLIGIBLE: no number fades below that, squares of such numbers are still far from 1e-308, and nothing that matters
 * changes. It costs nothing in an iteration.
 */
#include "bbm.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#define NEGLIGIBLE 1e-100                       /* -  against the largest entry of F                            */

typedef struct { double a[6][6]; } matrix6;
typedef struct { double a[6][2]; } matrix62;
typedef struct { double a[2][2]; } matrix2;

typedef struct {                /* the coarse space; its nodes are numbered by their place in an RCM order      */
    int n;                      /* nodes, two unknowns each                                                     */
    int *first, *node;          /* [rows+1]  the nodes of block row i are node[first[i]] .. node[first[i+1]-1]  */
    int *left;                  /* [n]       the first column of row i of Kc that is not zero                   */
    size_t *diagonal;           /* [n]       where Kc_ii is; the row left of it comes before it, without gaps   */
    size_t blocks;              /* in Kc                                                                        */
    matrix62 *P, *Q;            /* [first[rows]]  P as given, and C_i^T P                                       */
    matrix2 *A;                 /* [blocks]  Kc, then its factor, with inverted diagonal blocks                 */
    double *size, *c;           /* [2 n]     what a pivot is measured by; the coarse vector                     */
    int from, to;               /* in a component: its nodes are from .. to-1                                   */
} coarse_space;

/* Block rows are numbered in two ways: by the caller, and by their place in the reverse Cuthill-McKee order.    */
struct bbm_matrix {
    int n, blocks;              /* block rows, blocks in L                                                      */
    int *place, *caller;        /* [n]       place[caller's row], and back                                      */
    int *first;                 /* [n+1]     the blocks of row i of L are first[i] .. first[i+1]-1              */
    int *back;                  /* [blocks]  row less column                                                    */
    int components, *start;     /* [n+1]     the rows of component c are start[c] .. start[c+1]-1               */
    matrix6 *D, *L;             /* [n], [blocks]                                                                */
    /* --- scratch of bbm_solve; vectors have 6 n entries in the order of the places --- */
    matrix6 *C, *S;             /* [n], [blocks]  C_i^-1 and -w S_ij; in the textbook form C is -w D_i^-1       */
    double *f, *x, *r, *p, *q;  /* right-hand side, solution, residual, direction, product                      */
    double *y, *z;              /* results of a forward and of a backward sweep                                 */
    coarse_space *coarse;       /* NULL: none                                                                   */
    int ready;                  /* C, S and the coarse factor belong to D, L and the following                  */
    bbm_pcg_form form;
    double omega;
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

/* order and place, its inverse: all components one after the other, then the whole order turned round. */
static void reverse_cuthill_mckee(graph *g, int *order, int *place)
{
    int done = 0, i;

    for (i = 0; i < g->n; i++)
        g->level[i] = -1;
    for (i = 0; i < g->n; i++)
        if (g->level[i] < 0)
            done += order_component(g, i, order + done);
    for (i = 0; i < g->n; i++)
        place[order[i]] = g->n - 1 - i;
    for (i = 0; i < g->n; i++)
        order[place[i]] = i;
}

/* first and back: the neighbours left of the diagonal. A component ends with the row where the search began. */
static void lay_out_rows(const graph *g, bbm_matrix *K)
{
    int count = 0, i, j, k;

    for (i = 0; i < g->n; i++) {
        for (k = g->first[K->caller[i]]; k < g->end[K->caller[i]]; k++) {
            j = K->place[g->list[k]];
            if (j < i)
                K->back[count++] = i - j;
        }
        K->first[i + 1] = count;
        if (g->level[K->caller[i]] == 0)
            K->start[++K->components] = i + 1;
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
    if (!(K->place = calloc(4 * n + 2 + blocks, sizeof *K->place))
        || !(K->D = calloc(2 * (n + blocks), sizeof *K->D))
        || !(K->p = calloc(7 * 6 * n, sizeof *K->p)))
        return BBM_NO_MEMORY;
    K->caller = K->place + n;
    K->first = K->caller + n;
    K->start = K->first + n + 1;
    K->back = K->start + n + 1;
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

static void coarse_free(coarse_space *c)
{
    if (!c)
        return;
    free(c->first);
    free(c->diagonal);
    free(c->P);
    free(c->A);
    free(c->size);
    free(c);
}

void bbm_matrix_free(bbm_matrix *K)
{
    if (!K)
        return;
    coarse_free(K->coarse);
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
    reverse_cuthill_mckee(&g, A->caller, A->place);
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
    K->ready = 0;
}

/* The block of row i and column j <= i, or NULL. A row has one to three blocks left of the diagonal: look at each. */
static matrix6 *find_block(const bbm_matrix *K, int i, int j)
{
    int k;

    for (k = K->first[i]; k < K->first[i + 1]; k++)
        if (i - K->back[k] == j)
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
    K->ready = 0;
    return BBM_OK;
}

/* B = K_ij; 0 where the pattern has no block. */
void bbm_matrix_get(const bbm_matrix *K, int i, int j, double B[6][6])
{
    const int right = K->place[i] < K->place[j];
    const matrix6 *from = right ? find_block(K, K->place[j], K->place[i]) : find_block(K, K->place[i], K->place[j]);
    int a, b;

    for (a = 0; a < 6; a++)
        for (b = 0; b < 6; b++)
            B[a][b] = !from ? 0.0 : right ? from->a[b][a] : from->a[a][b];
}

int bbm_matrix_bandwidth(const bbm_matrix *K)
{
    int width = 0, i, k;

    for (i = 0; i < K->n; i++)
        for (k = K->first[i]; k < K->first[i + 1]; k++)
            if (K->back[k] > width)
                width = K->back[k];
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
            const int from = 6 * (row ? row[i - K->back[k]] : i - K->back[k]);

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
            add_product(&K->L[k], y + 6 * i - 6 * K->back[k], s);
        add_transposed(&K->C[i], s, y + 6 * i);
    }
    for (i = K->n - 1; i >= 0; i--) {
        copy(1, z + 6 * i, s);
        copy(1, y + 6 * i, z + 6 * i);
        add_transposed(&K->C[i], s, z + 6 * i);
        for (k = K->first[i]; k < K->first[i + 1]; k++)
            add_transposed(&K->L[k], z + 6 * i, z + 6 * i - 6 * K->back[k]);
    }
}

static bbm_status textbook(bbm_matrix *K, const bbm_pcg *pcg, bbm_pcg_info *info)
{
    const int n = K->n;
    double *x = K->x, *r = K->r, *z = K->z, *p = K->p, *q = K->q, rz, last, stop, pq;
    bbm_status status = BBM_OK;

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
            const matrix6 *Gi = &K->C[i], *Gj = &K->C[i - K->back[k]], *L = &K->L[k];
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
            add_transposed(&K->S[k], t + 6 * i, t + 6 * i - 6 * K->back[k]);
}

/* y = E^-1 (p - (2-w) t) */
static void forward(const bbm_matrix *K, double w, const double *p, const double *t, double *restrict y)
{
    int i, k, a;

    for (i = 0; i < K->n; i++) {
        for (a = 6 * i; a < 6 * i + 6; a++)
            y[a] = p[a] - (2.0 - w) * t[a];
        for (k = K->first[i]; k < K->first[i + 1]; k++)
            add_product(&K->S[k], y + 6 * i - 6 * K->back[k], y + 6 * i);
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

/* ------------------------------------------------------------------------ beyond the paper: two levels
 *
 * SSOR removes in one iteration what is stiff and local, but carries news of the load by one element per sweep; the
 * finer the mesh, the more iterations. What it is slow at is known beforehand: displacements that are continuous from
 * element to element cost the bonding springs nothing, so that in their sight everything else is stiff. On triangles
 * these are the displacements of the constant-strain finite element. So take the corners of the elements as a coarse
 * grid, where corners tied together by bonds are one node, and correct between the two sweeps of SSOR in the whole
 * space of its displacements at once. With w = 1 and in the scaled variables of Eisenstat, E = I + S, Q = C^T P,
 *
 *     z = E^-1 r                              forward sweep
 *     z += Q Kc^-1 Q^T (r - K z)              r - K z = -S^T z, gathered in the same sweep
 *     u = E^-T (r - S z)                      backward sweep; without the correction: E^-T E^-1 r, which is SSOR
 *
 * P takes the displacements of the nodes to the unknowns of the elements, six rows and two columns for each corner;
 * Kc = P^T K P = Q^T (I + S + S^T) Q is the stiffness on the coarse grid, with all fixed points, contacts and inertia
 * in it. Since E^T u = r - S z, K u needs no product with all of K, and conjugate gradients go
 *
 *     K u = (I + S + S^T) u = r + S (u - z)
 *     p = u + b p,  q = K u + b q             q is K p
 *     a = r.u / p.q,  x += a p,  r -= a q
 *
 * with three passes over L an iteration. That many iterations, some 15, suffice on a mesh of any fineness.
 *
 * Kc has an envelope: from the first block of each row that is not zero to the diagonal, everything is stored and
 * factored by Cholesky; Cuthill and McKee number its nodes, too. Displacements of the nodes that move no element (the
 * hourglass of quadrilaterals) have no stiffness: of their pivots rounding is left, some eps of what was summed up
 * before it cancelled. A pivot below VANISHING of that is struck out with its row: the coarse space is then a
 * little smaller, and the preconditioner as positive definite as before.                                          */

#define VANISHING 1e-12                         /* -  against the pivot's share of P^T D P                      */

/* Whether the elements of two block rows are triangles with a side in common. The springs of that side feel only the
 * displacements of its two nodes: K_ij adds to their diagonal blocks in Kc and to nothing else.                   */
static int share_a_side(const coarse_space *c, int i, int j)
{
    int common = 0, a, b;

    if (c->first[i + 1] - c->first[i] != 3 || c->first[j + 1] - c->first[j] != 3)
        return 0;
    for (a = c->first[i]; a < c->first[i + 1]; a++)
        for (b = c->first[j]; b < c->first[j + 1]; b++)
            common += c->node[a] == c->node[b];
    return common == 2;
}

/* Lists, or only counts, the pairs of nodes that belong to one element, or to two elements with a block in K. */
static int list_coarse_pairs(const bbm_matrix *K, const coarse_space *c, int (*pair)[2])
{
    int count = 0, i, j, k, a, b;

    for (i = 0; i < K->n; i++)
        for (k = K->first[i]; k <= K->first[i + 1]; k++) {
            j = k < K->first[i + 1] ? i - K->back[k] : i;
            if (i != j && share_a_side(c, i, j))
                continue;
            for (a = c->first[i]; a < c->first[i + 1]; a++)
                for (b = c->first[j]; b < (i == j ? a : c->first[j + 1]); b++, count++)
                    if (pair) {
                        pair[count][0] = c->node[a];
                        pair[count][1] = c->node[b];
                    }
        }
    return count;
}

/* Numbers the nodes anew, by their place in the order, and lays out the envelope. */
static bbm_status lay_out_envelope(const bbm_matrix *K, coarse_space *c)
{
    const int pairs = list_coarse_pairs(K, c, NULL);
    int (*pair)[2] = calloc((size_t)pairs + 1, sizeof *pair);
    int *order = calloc(2 * (size_t)c->n, sizeof *order), *place;
    graph g = { 0, NULL, NULL, NULL, NULL, NULL };
    bbm_status status = BBM_NO_MEMORY;
    int i, k;

    if (!pair || !order)
        goto done;
    place = order + c->n;
    list_coarse_pairs(K, c, pair);
    status = graph_new(&g, c->n, pairs, pair);
    if (status != BBM_OK)
        goto done;
    reverse_cuthill_mckee(&g, order, place);
    for (k = 0; k < c->first[K->n]; k++)
        c->node[k] = place[c->node[k]];
    for (i = 0; i < c->n; i++) {
        c->left[i] = i;
        for (k = g.first[order[i]]; k < g.end[order[i]]; k++)
            if (place[g.list[k]] < c->left[i])
                c->left[i] = place[g.list[k]];
        c->diagonal[i] = c->blocks + (size_t)(i - c->left[i]);
        c->blocks = c->diagonal[i] + 1;
    }
done:
    free(g.first);
    free(pair);
    free(order);
    return status;
}

static bbm_status allocate_coarse(coarse_space *c, int rows, int corners, int nodes)
{
    const size_t n = (size_t)nodes;

    if (!(c->first = calloc((size_t)rows + 1 + (size_t)corners + n, sizeof *c->first))
        || !(c->diagonal = calloc(n, sizeof *c->diagonal))
        || !(c->P = calloc(2 * (size_t)corners, sizeof *c->P))
        || !(c->size = calloc(4 * n, sizeof *c->size)))
        return BBM_NO_MEMORY;
    c->n = nodes;
    c->node = c->first + rows + 1;
    c->left = c->node + corners;
    c->Q = c->P + corners;
    c->c = c->size + 2 * n;
    return BBM_OK;
}

/* The nodes as given, and in left[] the component of each, from 1; 0: no row hangs on it. */
static bbm_status list_nodes(const bbm_matrix *K, const int *first, const int *node, coarse_space *c)
{
    int component = 1, i, k = 0;

    for (i = 0; i < K->n; i++) {
        const int *from = node + first[K->caller[i]], *end = node + first[K->caller[i] + 1];

        component += i == K->start[component];
        for (; from < end; from++) {
            if (c->left[*from] != 0 && c->left[*from] != component)
                return BBM_BAD_INDEX;
            c->left[*from] = component;
            c->node[k++] = *from;
        }
        c->first[i + 1] = k;
    }
    return BBM_OK;
}

/* Numbers the nodes one component after the other, those of each in the order that they have: the solution of one need
 * not look at the nodes of others.                                                                                */
static bbm_status sort_nodes(const bbm_matrix *K, coarse_space *c)
{
    int *next = calloc((size_t)K->components + 2, sizeof *next), i;

    if (!next)
        return BBM_NO_MEMORY;
    for (i = 0; i < c->n; i++)
        next[c->left[i] + 1]++;
    for (i = 0; i <= K->components; i++)
        next[i + 1] += next[i];
    for (i = 0; i < c->n; i++)
        c->left[i] = next[c->left[i]]++;
    for (i = 0; i < c->first[K->n]; i++)
        c->node[i] = c->left[c->node[i]];
    free(next);
    return BBM_OK;
}

/* Gives K a coarse space in place of the one it had: block row i hangs on node[first[i]] .. node[first[i+1]-1], all
 * different, or on none, and no two components on the same node. Rows of three nodes that share two of them must be
 * triangles bonded along that side.                                                                              */
bbm_status bbm_matrix_coarse(bbm_matrix *K, int nodes, const int *first, const int *node)
{
    const int corners = first[K->n];
    coarse_space *c;
    bbm_status status;
    int k;

    for (k = 0; k < corners; k++)
        if (node[k] < 0 || node[k] >= nodes)
            return BBM_BAD_INDEX;
    coarse_free(K->coarse);
    K->coarse = NULL;
    K->ready = 0;
    if (corners == 0)
        return BBM_OK;
    c = calloc(1, sizeof *c);
    status = c ? allocate_coarse(c, K->n, corners, nodes) : BBM_NO_MEMORY;
    if (status == BBM_OK)
        status = list_nodes(K, first, node, c);
    if (status == BBM_OK)
        status = sort_nodes(K, c);
    if (status == BBM_OK)
        status = lay_out_envelope(K, c);
    if (status == BBM_OK && !(c->A = calloc(c->blocks, sizeof *c->A)))
        status = BBM_NO_MEMORY;
    if (status == BBM_OK)
        K->coarse = c;
    else
        coarse_free(c);
    return status;
}

/* The displacement of the k-th node of block row i alone gives the row's unknowns the values P (u, v). */
bbm_status bbm_matrix_interpolate(bbm_matrix *K, int i, int k, double P[6][2])
{
    const coarse_space *c = K->coarse;
    int at;

    if (!c || i < 0 || i >= K->n)
        return BBM_BAD_INDEX;
    at = c->first[K->place[i]] + k;
    if (k < 0 || at >= c->first[K->place[i] + 1])
        return BBM_BAD_INDEX;
    memcpy(c->P[at].a, P, sizeof c->P[at]);
    K->ready = 0;
    return BBM_OK;
}

/* Y = B X */
static void multiply62(const matrix6 *B, const matrix62 *X, matrix62 *Y)
{
    int a, b, k;

    for (a = 0; a < 6; a++)
        for (b = 0; b < 2; b++) {
            double s = 0.0;

            for (k = 0; k < 6; k++)
                s += B->a[a][k] * X->a[k][b];
            Y->a[a][b] = s;
        }
}

/* Q = C^T P = C^-1 D P */
static void scale_interpolation(bbm_matrix *K)
{
    const coarse_space *c = K->coarse;
    matrix62 DP;
    int i, k;

    for (i = 0; i < K->n; i++)
        for (k = c->first[i]; k < c->first[i + 1]; k++) {
            multiply62(&K->D[i], &c->P[k], &DP);
            multiply62(&K->C[i], &DP, &c->Q[k]);
        }
}

/* Kc_ij += sign P^T Q and Kc_ji += its transpose, of which only the one left of the diagonal is stored. */
static void add_coarse(coarse_space *c, int i, int j, double sign, const matrix62 *P, const matrix62 *Q)
{
    const int right = i < j, from = right ? i : j, row = right ? j : i;
    matrix2 *to = &c->A[c->diagonal[row] - (size_t)(row - from)];
    int a, b, k;

    for (a = 0; a < 2; a++)
        for (b = 0; b < 2; b++) {
            double s = 0.0;

            for (k = 0; k < 6; k++)
                s += P->a[k][a] * Q->a[k][b];
            to->a[right ? b : a][right ? a : b] += sign * s;
            if (i == j)
                to->a[b][a] += sign * s;
        }
}

/* The part Q_i^T S_ij Q_j of Kc, from the block -S_ij. */
static void add_coarse_block(coarse_space *c, int i, int j, const matrix6 *S)
{
    const int side = share_a_side(c, i, j);
    matrix62 SQ;
    int a, b;

    for (b = c->first[j]; b < c->first[j + 1]; b++) {
        multiply62(S, &c->Q[b], &SQ);
        for (a = c->first[i]; a < c->first[i + 1]; a++)
            if (!side || c->node[a] == c->node[b])
                add_coarse(c, c->node[a], c->node[b], -1.0, &c->Q[a], &SQ);
    }
}

/* Kc = Q^T (I + S + S^T) Q: first Q^T Q, whose diagonal is what the pivots are measured by. */
static void sum_coarse(const bbm_matrix *K, coarse_space *c)
{
    int i, k, a, b;

    memset(c->A, 0, c->blocks * sizeof *c->A);
    for (i = 0; i < K->n; i++)
        for (a = c->first[i]; a < c->first[i + 1]; a++)
            for (b = c->first[i]; b <= a; b++)
                add_coarse(c, c->node[a], c->node[b], a == b ? 0.5 : 1.0, &c->Q[a], &c->Q[b]);
    for (i = 0; i < 2 * c->n; i++)
        c->size[i] = c->A[c->diagonal[i / 2]].a[i % 2][i % 2];
    for (i = 0; i < K->n; i++)
        for (k = K->first[i]; k < K->first[i + 1]; k++)
            add_coarse_block(c, i, i - K->back[k], &K->S[k]);
}

/* s -= sum_k A_k B_k^T over n blocks, in partial sums of the even and of the odd columns. */
static void subtract_products(int n, const matrix2 *A, const matrix2 *B, matrix2 *s)
{
    double t[2][2][2] = { { { 0, 0 }, { 0, 0 } }, { { 0, 0 }, { 0, 0 } } };
    int k;

    for (k = 0; k < n; k++) {
        const double *a = A[k].a[0], *b = B[k].a[0];

        t[0][0][0] += a[0] * b[0];
        t[0][0][1] += a[1] * b[1];
        t[0][1][0] += a[0] * b[2];
        t[0][1][1] += a[1] * b[3];
        t[1][0][0] += a[2] * b[0];
        t[1][0][1] += a[3] * b[1];
        t[1][1][0] += a[2] * b[2];
        t[1][1][1] += a[3] * b[3];
    }
    for (k = 0; k < 4; k++)
        s->a[k / 2][k % 2] -= t[k / 2][k % 2][0] + t[k / 2][k % 2][1];
}

/* s = C_ii^-1, where C_ii C_ii^T = s; 0 in place of 1/sqrt(pivot) where the pivot vanishes. */
static void invert_small(const double *size, matrix2 *s)
{
    const double p0 = s->a[0][0], g0 = p0 > VANISHING * size[0] ? 1.0 / sqrt(p0) : 0.0, c10 = s->a[1][0] * g0;
    const double p1 = s->a[1][1] - c10 * c10, g1 = p1 > VANISHING * size[1] ? 1.0 / sqrt(p1) : 0.0;
    const matrix2 G = { { { g0, 0.0 }, { -g1 * c10 * g0, g1 } } };

    *s = G;
}

/* Kc = C C^T:  C_ij = (Kc_ij - sum_k<j C_ik C_jk^T) C_jj^-T */
static void factor_coarse(coarse_space *c)
{
    int i, j, a;

    for (i = 0; i < c->n; i++)
        for (j = c->left[i]; j <= i; j++) {
            const int from = c->left[i] > c->left[j] ? c->left[i] : c->left[j];
            matrix2 *s = &c->A[c->diagonal[i] - (size_t)(i - j)], *G = &c->A[c->diagonal[j]];

            subtract_products(j - from, s - (j - from), G - (j - from), s);
            if (i == j)
                invert_small(c->size + 2 * i, s);
            for (a = 0; a < 2 && j < i; a++) {
                s->a[a][1] = s->a[a][0] * G->a[1][0] + s->a[a][1] * G->a[1][1];
                s->a[a][0] = s->a[a][0] * G->a[0][0];
            }
        }
}

/* s -= sum_k A_k x_k over n blocks, each row in two partial sums: one alone would wait for each addition to end. */
static void subtract_row(int n, const matrix2 *A, const double *x, double *s)
{
    double t[2][2] = { { 0, 0 }, { 0, 0 } };
    int k;

    for (k = 0; k < n; k++, x += 2) {
        t[0][0] += A[k].a[0][0] * x[0];
        t[0][1] += A[k].a[0][1] * x[1];
        t[1][0] += A[k].a[1][0] * x[0];
        t[1][1] += A[k].a[1][1] * x[1];
    }
    s[0] -= t[0][0] + t[0][1];
    s[1] -= t[1][0] + t[1][1];
}

/* x_k -= A_k^T y for n blocks. */
static void subtract_column(int n, const matrix2 *restrict A, const double y[2], double *restrict x)
{
    const double y0 = y[0], y1 = y[1];
    int k;

    for (k = 0; k < n; k++, x += 2) {
        x[0] -= A[k].a[0][0] * y0 + A[k].a[1][0] * y1;
        x[1] -= A[k].a[0][1] * y0 + A[k].a[1][1] * y1;
    }
}

/* c = Kc^-1 c = C^-T C^-1 c for the nodes of a component */
static void solve_coarse(const coarse_space *c)
{
    int i;

    for (i = c->from; i < c->to; i++) {
        const int count = i - c->left[i];
        const matrix2 *G = &c->A[c->diagonal[i]];
        double *y = c->c + 2 * i;

        subtract_row(count, G - count, y - 2 * count, y);
        y[1] = G->a[1][0] * y[0] + G->a[1][1] * y[1];
        y[0] = G->a[0][0] * y[0];
    }
    for (i = c->to - 1; i >= c->from; i--) {
        const int count = i - c->left[i];
        const matrix2 *G = &c->A[c->diagonal[i]];
        double *y = c->c + 2 * i;

        y[0] = G->a[0][0] * y[0] + G->a[1][0] * y[1];
        y[1] = G->a[1][1] * y[1];
        subtract_column(count, G - count, y, y - 2 * count);
    }
}

/* z += Q Kc^-1 Q^T g */
static void correct(const bbm_matrix *K, const double *g, double *z)
{
    const coarse_space *c = K->coarse;
    int i, k, a;

    memset(c->c + 2 * c->from, 0, 2 * (size_t)(c->to - c->from) * sizeof *c->c);
    for (i = 0; i < K->n; i++, g += 6)
        for (k = c->first[i]; k < c->first[i + 1]; k++) {
            double *to = c->c + 2 * c->node[k];

            for (a = 0; a < 6; a++) {
                to[0] += c->Q[k].a[a][0] * g[a];
                to[1] += c->Q[k].a[a][1] * g[a];
            }
        }
    solve_coarse(c);
    for (i = 0; i < K->n; i++, z += 6)
        for (k = c->first[i]; k < c->first[i + 1]; k++) {
            const double *from = c->c + 2 * c->node[k];

            for (a = 0; a < 6; a++)
                z[a] += c->Q[k].a[a][0] * from[0] + c->Q[k].a[a][1] * from[1];
        }
}

/* y = z and z = u of the table above. Returns r.u. */
static double precondition(const bbm_matrix *K)
{
    double *restrict y = K->y, *restrict u = K->z;
    int i, k;

    copy(K->n, K->r, y);
    set_zero(K->n, u);
    for (i = 0; i < K->n; i++) {                /* y = E^-1 r; u = -S^T y */
        for (k = K->first[i]; k < K->first[i + 1]; k++)
            add_product(&K->S[k], y + 6 * i - 6 * K->back[k], y + 6 * i);
        for (k = K->first[i]; k < K->first[i + 1]; k++)
            add_transposed(&K->S[k], y + 6 * i, u + 6 * i - 6 * K->back[k]);
    }
    correct(K, u, y);
    copy(K->n, K->r, u);
    for (i = K->n - 1; i >= 0; i--) {           /* u = E^-T (r - S y) */
        for (k = K->first[i]; k < K->first[i + 1]; k++)
            add_product(&K->S[k], y + 6 * i - 6 * K->back[k], u + 6 * i);
        for (k = K->first[i]; k < K->first[i + 1]; k++)
            add_transposed(&K->S[k], u + 6 * i, u + 6 * i - 6 * K->back[k]);
    }
    return dot(K->n, K->r, u);
}

/* p = u + b p, q = r + S (u - z) + b q. Returns p.q. */
static double new_direction(const bbm_matrix *K, double b)
{
    double *restrict y = K->y, *restrict q = K->q;
    int i, k;

    combine(K->n, K->z, b, K->p, K->p);
    combine(K->n, K->r, b, q, q);
    for (i = 0; i < K->n; i++) {
        combine(1, y + 6 * i, -1.0, K->z + 6 * i, y + 6 * i);
        for (k = K->first[i]; k < K->first[i + 1]; k++)
            add_product(&K->S[k], y + 6 * i - 6 * K->back[k], q + 6 * i);
    }
    return dot(K->n, K->p, q);
}

static bbm_status two_level(bbm_matrix *K, const bbm_pcg *pcg, bbm_pcg_info *info)
{
    const int n = K->n;
    double *x = K->x, *r = K->r, *p = K->p, *q = K->q, b = 0.0, last, ru, stop, pq;
    bbm_status status = BBM_OK;
    int i;

    set_zero(n, x);
    set_zero(n, p);
    set_zero(n, q);
    set_zero(n, r);
    for (i = 0; i < n; i++)                     /* r = C^-1 f */
        add_product(&K->C[i], K->f + 6 * i, r + 6 * i);
    ru = precondition(K);
    stop = pcg->tolerance * sqrt(ru);
    while (!(sqrt(ru) <= stop)) {
        pq = new_direction(K, b);
        status = may_go_on(pq, pcg, info);
        if (status != BBM_OK)
            break;
        combine(n, x, ru / pq, p, x);
        combine(n, r, -ru / pq, q, r);
        last = ru;
        ru = precondition(K);
        b = ru / last;
    }
    copy(n, x, p);
    set_zero(n, x);
    for (i = 0; i < n; i++)                     /* x = C^-T x */
        add_transposed(&K->C[i], p + 6 * i, x + 6 * i);
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

/* The power of two below the largest entry of F in the rows of K: to divide by it rounds nothing. */
static double magnitude(const bbm_matrix *K, const double *F)
{
    double m = 0.0;
    int i, exponent;

    for (i = 0; i < 6 * K->n; i++)
        m = fmax(m, fabs(F[6 * K->caller[i / 6] + i % 6]));
    (void)frexp(m, &exponent);
    return m == 0.0 ? 0.0 : ldexp(1.0, exponent - 1);
}

/* f = F / scale, so that its largest entry is in [1, 2). NEGLIGIBLE in place of 0 keeps denormals away. */
static void scale_load(bbm_matrix *K, const double *F, double scale)
{
    int i;

    for (i = 0; i < 6 * K->n; i++) {
        K->f[i] = F[6 * K->caller[i / 6] + i % 6] / scale;
        if (K->f[i] == 0.0)
            K->f[i] = NEGLIGIBLE;
    }
}

static bbm_status check(const double *F, int n, const bbm_pcg *pcg)
{
    if (!(pcg->omega > 0.0 && pcg->omega < 2.0) || !(pcg->tolerance > 0.0 && pcg->tolerance < 1.0))
        return BBM_BAD_PARAMETER;
    if (pcg->iterations < 1)
        return BBM_BAD_PARAMETER;
    return all_finite(6 * (size_t)n, F) ? BBM_OK : BBM_NOT_FINITE;
}

/* Makes of K what the solution needs; further solutions with the same K find it ready. */
static bbm_status make_ready(bbm_matrix *K, bbm_pcg_form form, double omega, bbm_pcg_info *info)
{
    const size_t n = (size_t)K->n, blocks = (size_t)K->blocks;
    bbm_status status;

    if (K->ready && K->form == form && K->omega == omega)
        return BBM_OK;
    K->ready = 0;
    if (!all_finite(36 * n, (double *)K->D) || !all_finite(36 * blocks, (double *)K->L))
        return BBM_NOT_FINITE;
    status = factor_diagonal(K, info);
    if (status != BBM_OK)
        return status;
    if (form == BBM_TEXTBOOK)
        invert_diagonal(K, omega);
    else
        scale_blocks(K, omega);
    if (form == BBM_TWO_LEVEL) {
        scale_interpolation(K);
        sum_coarse(K, K->coarse);
        factor_coarse(K->coarse);
    }
    K->ready = 1;
    K->form = form;
    K->omega = omega;
    return BBM_OK;
}

/* |f - K x| / |f|; overwrites r and q. */
static double true_residual(bbm_matrix *K)
{
    multiply(K, NULL, K->x, K->q);
    combine(K->n, K->f, -1.0, K->q, K->r);
    return sqrt(dot(K->n, K->r, K->r) / dot(K->n, K->f, K->f));
}

/* A = the component of K with the rows from .. to-1; c: room for its coarse space. Its vectors are those of K. */
static void take_component(const bbm_matrix *K, int from, int to, bbm_matrix *A, coarse_space *c)
{
    int k;

    *A = *K;
    A->n = to - from;
    A->caller += from;
    A->first += from;
    A->D += from;
    A->C += from;
    if (!K->coarse)
        return;
    *c = *K->coarse;
    c->first += from;
    for (k = c->first[0]; k < c->first[A->n]; k++) {
        if (k == c->first[0] || c->node[k] < c->from)
            c->from = c->node[k];
        if (c->node[k] >= c->to)
            c->to = c->node[k] + 1;
    }
    A->coarse = c;
}

/* The rows of D that belong to the component K. */
static bbm_status solve_component(bbm_matrix *K, const double *F, double *D, const bbm_pcg *pcg, bbm_pcg_info *info)
{
    const double scale = magnitude(K, F);
    bbm_status status;
    int i;

    if (scale == 0.0)
        return BBM_OK;
    scale_load(K, F, scale);
    if (K->form == BBM_TWO_LEVEL)
        status = two_level(K, pcg, info);
    else
        status = K->form == BBM_TEXTBOOK ? textbook(K, pcg, info) : eisenstat(K, pcg, info);
    info->residual = true_residual(K);
    for (i = 0; i < 6 * K->n; i++)
        D[6 * K->caller[i / 6] + i % 6] = scale * K->x[i];
    return status;
}

static bbm_status solve_components(const bbm_matrix *K, const double *F, double *D, const bbm_pcg *pcg,
                                   bbm_pcg_info *info)
{
    bbm_status status = BBM_OK, s;
    bbm_matrix A;
    coarse_space c;
    int k;

    info->residual = 0.0;
    for (k = 0; k < K->components; k++) {
        bbm_pcg_info one = { 0, 0.0, -1, { 0, 0 } };

        take_component(K, K->start[k], K->start[k + 1], &A, &c);
        s = solve_component(&A, F, D, pcg, &one);
        status = status == BBM_OK ? s : status;
        if (one.iterations > info->iterations)
            info->iterations = one.iterations;
        if (!(one.residual <= info->residual))
            info->residual = one.residual;
    }
    return status;
}

static double seconds_since(clock_t start) { return (double)(clock() - start) / CLOCKS_PER_SEC; }

/* Where the iteration ends early, D is its last iterate; if it did not begin, D is 0, iterations 0 and residual 1.
 * One component that fails does not keep the others from being solved.                                           */
bbm_status bbm_solve(bbm_matrix *K, const double *F, double *D, const bbm_pcg *pcg, bbm_pcg_info *info)
{
    const bbm_pcg_info none = { 0, 1.0, -1, { 0, 0 } };
    clock_t start = clock();
    const bbm_pcg_form form = pcg->form == BBM_TWO_LEVEL && !K->coarse ? BBM_EISENSTAT : pcg->form;
    bbm_status status = check(F, K->n, pcg);

    *info = none;
    set_zero(K->n, D);
    if (status == BBM_OK)
        status = make_ready(K, form, form == BBM_TWO_LEVEL ? 1.0 : pcg->omega, info);
    info->seconds[0] = seconds_since(start);
    start = clock();
    if (status != BBM_OK)
        return status;
    status = solve_components(K, F, D, pcg, info);
    info->seconds[1] = seconds_since(start);
    return status == BBM_OK && !all_finite(6 * (size_t)K->n, D) ? BBM_NOT_FINITE : status;
}
