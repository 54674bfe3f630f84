/* coarse.c - a second, coarse level for the SSOR-PCG of solver.c, by which the number of iterations no
 * longer grows with the mesh. ESSAY
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "beyond.h"

/* Of a pivot, against its share of P^T D P: what is left of it below this is rounding. */
#define VANISHING 1e-12
/* Elements that a wave crosses in a step, from which on two levels solve faster than one: measured, with
 * blocks of 2 to 300 elements they break even at 1 to 4. */
#define CROSSED 3.0

typedef struct {
    int n;                      /* nodes, two unknowns each; numbered so that Kc has a narrow band */
    int *first, *node;          /* [rows+1]  node[first[i]] .. node[first[i+1]-1]: those of row i, */
                                /*           then those of the rows left of it                     */
    int *corner;                /* [rows+1]  row i itself has corner[i+1] - corner[i] of them      */
    int *start;                 /* [rows+1]  rows i .. j-1, a component, have start[i] .. start[j]-1 */
    double (*P)[6][2];          /* [corners] as given                                              */
    double (*T)[6][2];          /* as node   C^-1 L P                                              */
    int *at;                    /* [n]       where in T the blocks of the row in hand are          */
    int *left;                  /* [2 n]     the first column of row i of Kc that is not zero      */
    size_t *diagonal;           /* [2 n]     where Kc_ii is; the row left of it lies before it     */
    double *A;                  /* Kc, then its factor, with 1/C_ii on the diagonal                */
    double *size, *x;           /* [2 n]     what a pivot is measured by; a vector                 */
    int pays;                   /* in this step                                                    */
} coarse_space;

/* ------------------------------------------------------------------------------------- the layout */

static int corners(const coarse_space *c, int i)
{
    return c->corner[i + 1] - c->corner[i];
}

/* Whether two rows are triangles with a side in common. The springs of that side feel its two ends alone,
 * and the blocks L P and K P of the third nodes vanish. */
static int share_a_side(const coarse_space *c, int i, int j)
{
    int common = 0;

    for (int k = 0; k < 9 && corners(c, i) == 3 && corners(c, j) == 3; k++)
        common += c->node[c->first[i] + k / 3] == c->node[c->first[j] + k % 3];
    return common == 2;
}

/* Appends a node to the list of row i, unless it is there. */
static void list_node(coarse_space *c, int i, int node, int *count)
{
    if (c->at[node] >= c->first[i])
        return;
    c->at[node] = *count;
    c->node[(*count)++] = node;
}

/* The lists of nodes, numbered as they are found but from the last number down: bbm_order, which reverses,
 * then keeps those of a component together, and the components in the order of their rows. */
static bbm_status list_nodes(const bbm_matrix *K, const int *first, const int *node, coarse_space *c)
{
    int *number = c->left, count = 0, component = 0;    /* of the caller's nodes, from 1 */

    for (int k = 0; k < c->n; k++)
        c->at[k] = -1;
    for (int i = 0; i < K->n; i++) {
        const int row = K->caller[i];
        component += i == K->start[component + 1];
        c->start[i + 1] = c->start[i];
        c->corner[i + 1] = c->corner[i] + first[row + 1] - first[row];
        for (int a = first[row]; a < first[row + 1]; a++) {
            if (number[node[a]] == 0)
                number[node[a]] = ++c->start[i + 1];
            if (number[node[a]] <= c->start[K->start[component]])
                return BBM_BAD_INDEX;
            list_node(c, i, c->n - number[node[a]], &count);
        }
        for (int k = K->first[i]; k < K->first[i + 1]; k++) {
            const int j = i - K->back[k];
            for (int b = 0; b < corners(c, j) && !share_a_side(c, i, j); b++)
                list_node(c, i, c->node[c->first[j] + b], &count);
        }
        c->first[i + 1] = count;
    }
    return BBM_OK;
}

/* Lists, or only counts, the pairs of nodes that have a block in Kc = P^T (D + L + L^T) P. */
static int list_pairs(const coarse_space *c, int rows, int (*pair)[2])
{
    int count = 0;

    for (int i = 0; i < rows; i++)
        for (int a = c->first[i]; a < c->first[i] + corners(c, i); a++)
            for (int b = a + 1; b < c->first[i + 1]; b++, count++)
                if (pair) {
                    pair[count][0] = c->node[a];
                    pair[count][1] = c->node[b];
                }
    return count;
}

/* Numbers the nodes by their place in the order, and finds how far left of the diagonal Kc begins. */
static bbm_status lay_out_envelope(coarse_space *c, int rows)
{
    const int pairs = list_pairs(c, rows, NULL);
    int (*pair)[2] = calloc((size_t)pairs + 1, sizeof *pair), *place = c->at;
    size_t entries = 0;

    if (!pair)
        return BBM_NO_MEMORY;
    list_pairs(c, rows, pair);
    const bbm_status status = bbm_order(c->n, pairs, pair, place);
    for (int k = 0; k < 2 * c->n; k++)
        c->left[k] = k / 2 * 2;
    for (int k = 0; k < 2 * pairs && !status; k++) {
        int *left = &c->left[2 * place[pair[k / 2][k % 2]]];
        const int column = 2 * place[pair[k / 2][1 - k % 2]];
        left[0] = left[1] = column < left[0] ? column : left[0];
    }
    for (int k = 0; k < c->first[rows] && !status; k++)
        c->node[k] = place[c->node[k]];
    for (int k = 0; k < 2 * c->n; k++) {
        c->diagonal[k] = entries + (size_t)(k - c->left[k]);
        entries = c->diagonal[k] + 1;
    }
    free(pair);
    c->A = status ? NULL : calloc(entries, sizeof *c->A);
    return c->A ? BBM_OK : BBM_NO_MEMORY;
}

static bbm_status lay_out(const bbm_matrix *K, int nodes, const int *first, const int *node, coarse_space *c)
{
    const size_t rows = (size_t)K->n + 1, n = (size_t)nodes;
    size_t room = (size_t)first[K->n];

    for (int i = 0; i < K->n; i++)
        for (int k = K->first[i]; k < K->first[i + 1]; k++) {
            const int j = K->caller[i - K->back[k]];
            room += (size_t)(first[j + 1] - first[j]);
        }
    c->n = nodes;
    c->pays = 1;
    c->first = calloc(3 * rows + 3 * n + room, sizeof *c->first);
    c->diagonal = calloc(2 * n, sizeof *c->diagonal);
    c->size = calloc(4 * n, sizeof *c->size);
    if (!c->first || !c->diagonal || !c->size)
        return BBM_NO_MEMORY;
    c->corner = c->first + rows;
    c->start = c->corner + rows;
    c->at = c->start + rows;
    c->left = c->at + n;
    c->node = c->left + 2 * n;
    c->x = c->size + 2 * n;
    bbm_status status = list_nodes(K, first, node, c);
    if (!status)
        status = lay_out_envelope(c, K->n);
    if (status)
        return status;
    c->P = calloc((size_t)c->corner[K->n] + (size_t)c->first[K->n], sizeof *c->P);
    c->T = c->P + c->corner[K->n];
    return c->P ? BBM_OK : BBM_NO_MEMORY;
}

static void coarse_free(void *extra)
{
    coarse_space *c = extra;

    if (!c)
        return;
    free(c->first);
    free(c->diagonal);
    free(c->size);
    free(c->A);
    free(c->P);
    free(c);
}

/* Gives K a coarse space in place of the one it had: block row i hangs on node[first[i]] .. node[first[i+1]-1], all
 * different, or on none, and no two components on the same node. Rows of three nodes that share two of them must be
 * triangles bonded along that side. */
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

/* The displacement of the k-th node of block row i alone gives the row's unknowns the values P (u, v). */
bbm_status bbm_matrix_interpolate(bbm_matrix *K, int i, int k, double P[6][2])
{
    const coarse_space *c = K->extra;

    if (!c || i < 0 || i >= K->n || k < 0 || k >= corners(c, K->place[i]))
        return BBM_BAD_INDEX;
    memcpy(c->P[c->corner[K->place[i]] + k], P, sizeof *c->P);
    K->ready = 0;
    return BBM_OK;
}

/* ------------------------------------------------------------------------------- Kc and its factor */

/* Y += c B X */
static void multiply_add(double c, double B[6][6], double X[6][2], double Y[6][2])
{
    for (int a = 0; a < 6; a++)
        for (int b = 0; b < 2; b++) {
            double s = 0;
            for (int k = 0; k < 6; k++)
                s += B[a][k] * X[k][b];
            Y[a][b] += c * s;
        }
}

/* Kc_ij, left of the diagonal or on it. */
static double *entry(const coarse_space *c, int i, int j)
{
    return &c->A[c->diagonal[i] - (size_t)(i - j)];
}

/* Kc += P^T U + U^T P, where P belongs to node i and U to node j. */
static void add_block(coarse_space *c, int i, int j, double P[6][2], double U[6][2])
{
    for (int a = 0; a < 2; a++)
        for (int b = 0; b < 2; b++) {
            const int row = 2 * i + a, column = 2 * j + b;
            double s = 0;
            for (int k = 0; k < 6; k++)
                s += P[k][a] * U[k][b];
            *(row > column ? entry(c, row, column) : entry(c, column, row)) += row == column ? 2 * s : s;
        }
}

/* T = L P, then Kc += P^T (D/2 + L) P + its transpose, then T = C^-1 L P of a row. */
static void add_row(const bbm_matrix *K, coarse_space *c, int i)
{
    for (int t = c->first[i]; t < c->first[i + 1]; t++) {
        memset(c->T[t], 0, sizeof *c->T);
        c->at[c->node[t]] = t;
    }
    for (int k = K->first[i]; k < K->first[i + 1]; k++) {
        const int j = i - K->back[k];
        for (int b = 0; b < corners(c, j); b++) {
            const int t = c->at[c->node[c->first[j] + b]];
            if (t >= c->first[i])
                multiply_add(1, K->L[k], c->P[c->corner[j] + b], c->T[t]);
        }
    }
    for (int t = c->first[i]; t < c->first[i + 1]; t++) {
        double LP[6][2], U[6][2] = { { 0 } }, (*P)[6][2] = &c->P[c->corner[i]];
        if (t < c->first[i] + corners(c, i)) {
            multiply_add(0.5, K->D[i], P[t - c->first[i]], U);
            for (int k = 0; k < 12; k++)
                c->size[2 * c->node[t] + k % 2] += 2 * P[t - c->first[i]][k / 2][k % 2] * U[k / 2][k % 2];
        }
        memcpy(LP, c->T[t], sizeof LP);
        memset(c->T[t], 0, sizeof LP);
        multiply_add(1, K->G[i], LP, c->T[t]);
        for (int k = 0; k < 12; k++)
            U[k / 2][k % 2] += LP[k / 2][k % 2];
        for (int a = 0; a < corners(c, i); a++)
            add_block(c, c->node[c->first[i] + a], c->node[t], P[a], U);
    }
}

/* s = the products of the rows a0 and a1 with b0 and b1, over an even number of columns. Each in two
 * partial sums: one alone would wait for each addition to end. */
static void multiply_rows(int n, const double *a0, const double *a1, const double *b0, const double *b1,
                          double *restrict s)
{
    double sum[8] = { 0 };

    for (int k = 0; k < n; k += 2) {
        const double *p = a0 + k, *q = a1 + k, *x = b0 + k, *y = b1 + k;
        sum[0] += p[0] * x[0];
        sum[1] += p[1] * x[1];
        sum[2] += p[0] * y[0];
        sum[3] += p[1] * y[1];
        sum[4] += q[0] * x[0];
        sum[5] += q[1] * x[1];
        sum[6] += q[0] * y[0];
        sum[7] += q[1] * y[1];
    }
    for (int k = 0; k < 4; k++)
        s[k] = sum[2 * k] + sum[2 * k + 1];
}

/* Kc = C C^T:  C_ij = (Kc_ij - sum_k<j C_ik C_jk) / C_jj, two rows and two columns at a time. */
static void factor(coarse_space *c)
{
    for (int i = 0; i < 2 * c->n; i += 2)
        for (int j = c->left[i]; j <= i; j += 2) {
            const int from = c->left[i] > c->left[j] ? c->left[i] : c->left[j];
            double s[2][2];
            multiply_rows(j - from, entry(c, i, from), entry(c, i + 1, from), entry(c, j, from),
                          entry(c, j + 1, from), s[0]);
            for (int a = 0; a < 2; a++)
                for (int b = 0; b < (i == j ? a + 1 : 2); b++) {
                    double *to = entry(c, i + a, j + b), *diagonal = entry(c, j + b, j + b);
                    const double t = *to - s[a][b] - (b ? to[-1] * diagonal[-1] : 0);
                    *to = to != diagonal ? t * *diagonal : t > VANISHING * c->size[i + a] ? 1 / sqrt(t) : 0;
                }
        }
}

static void make_ready(bbm_matrix *K)
{
    coarse_space *c = K->extra;
    const size_t last = c->diagonal[2 * c->n - 1];

    memset(c->A, 0, (last + 1) * sizeof *c->A);
    memset(c->size, 0, 2 * (size_t)c->n * sizeof *c->size);
    for (int k = 0; k < c->n; k++)
        c->at[k] = -1;
    for (int i = 0; i < K->n; i++)
        add_row(K, c, i);
    factor(c);
}

/* x.y in four partial sums: one alone would wait for each addition to end. */
static double dot(int n, const double *x, const double *y)
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

/* x = Kc^-1 x = C^-T C^-1 x for the unknowns from .. to-1, and back two of them at a time */
static void solve(const coarse_space *c, int from, int to, double *restrict x)
{
    for (int i = from; i < to; i++)
        x[i] = (x[i] - dot(i - c->left[i], entry(c, i, c->left[i]), x + c->left[i])) * *entry(c, i, i);
    for (int i = to - 2; i >= from; i -= 2) {
        const int n = i - c->left[i];
        const double *p = entry(c, i, c->left[i]), *q = entry(c, i + 1, c->left[i]);
        const double x1 = x[i + 1] * q[n + 1], x0 = (x[i] - q[n] * x1) * p[n];
        double *restrict y = x + c->left[i];
        x[i] = x0;
        x[i + 1] = x1;
        for (int k = 0; k < n; k += 2) {
            y[k] -= p[k] * x0 + q[k] * x1;
            y[k + 1] -= p[k + 1] * x0 + q[k + 1] * x1;
        }
    }
}

/* y += T Kc^-1 T^T y */
static void correct(const bbm_matrix *K, double *restrict y)
{
    const coarse_space *c = K->extra;
    const int from = 2 * c->start[K->from], to = 2 * c->start[K->to];
    double *restrict x = c->x;

    memset(x + from, 0, (size_t)(to - from) * sizeof *x);
    for (int i = K->from; i < K->to; i++)
        for (int t = c->first[i]; t < c->first[i + 1]; t++) {
            double s[2] = { 0 };
            for (int a = 0; a < 6; a++) {
                s[0] += c->T[t][a][0] * y[6 * i + a];
                s[1] += c->T[t][a][1] * y[6 * i + a];
            }
            x[2 * c->node[t]] += s[0];
            x[2 * c->node[t] + 1] += s[1];
        }
    solve(c, from, to, x);
    for (int i = K->from; i < K->to; i++)
        for (int t = c->first[i]; t < c->first[i + 1]; t++) {
            const double x0 = x[2 * c->node[t]], x1 = x[2 * c->node[t] + 1];
            for (int a = 0; a < 6; a++)
                y[6 * i + a] += c->T[t][a][0] * x0 + c->T[t][a][1] * x1;
        }
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

/* -------------------------------------------------------------------------- the coarse space of a model */

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

/* Joins the corners that bonds tie together, in the forest up[], and counts the corners of the elements in corners[]
 * that are in the coarse space. An element without bonds is not, for there would be as many coarse unknowns as it has of
 * its own; nor is one held at every corner, which hardly moves. SSOR alone is faster for both. */
static void join_corners(const bbm_model *m, int up[], int count[])
{
    for (int v = 0; v < m->vertices; v++)
        up[v] = v;
    for (int b = 0; b < m->bonds; b++) {
        const bbm_bond *k = &m->bond[b];
        for (int end = 0; end < 2; end++)
            up[bbm_root_of(up, k->q[end])] = bbm_root_of(up, k->p[end]);
        count[k->i] = held_all_round(m, &m->element[k->i]) ? 0 : m->element[k->i].n;
        count[k->j] = held_all_round(m, &m->element[k->j]) ? 0 : m->element[k->j].n;
    }
}

/* Lays out the coarse space of the solver: corners that bonds tie together are one node, so that a crack parts them. */
bbm_status bbm_lay_out_coarse(bbm_model *m)
{
    const size_t v = (size_t)m->vertices;
    int *up = calloc(3 * v + (size_t)m->elements + 1, sizeof *up), nodes = 0;

    if (!up)
        return BBM_NO_MEMORY;
    int *number = up + v, *node = number + v, *first = node + v;
    join_corners(m, up, first + 1);
    for (int e = 0; e < m->elements; e++) {
        const int count = first[e + 1];
        for (int k = 0; k < count; k++) {
            int *n = &number[bbm_root_of(up, m->element[e].first + k)];
            if (*n == 0)
                *n = ++nodes;
            node[first[e] + k] = *n - 1;
        }
        first[e + 1] = first[e] + count;
    }
    const bbm_status status = bbm_matrix_coarse(m->K, nodes, first, node);
    free(up);
    return status;
}

/* Whether the step is long enough for two levels to pay: in a short one inertia holds every element by itself, and
 * SSOR alone needs no more iterations than a wave, of speed sqrt(E/density), needs to cross some elements. */
static int two_levels_pay(const bbm_model *m)
{
    for (int b = 0; b < m->bonds; b++) {
        const bbm_element *e = &m->element[m->bond[b].i];
        const double way2 = e->material.E / e->material.density * m->h * m->h;
        if (way2 > CROSSED * CROSSED * e->A && !held_all_round(m, e))
            return 1;
    }
    return 0;
}

/* The coarse space of the present geometry, unless K has not changed. Elements that are not in it are refused, which does
 * no harm. */
void bbm_interpolate_elements(bbm_model *m)
{
    coarse_space *c = m->K->extra;
    double P[6][2];

    if (!c || m->K->ready || m->par.pcg.method != &bbm_two_level)
        return;
    c->pays = two_levels_pay(m);
    for (int i = 0; i < m->elements && c->pays; i++) {
        const bbm_element *e = &m->element[i];
        const int middles = m->beyond->bonding != BBM_VERTICES && e->n == 4;
        for (int a = 0; a < e->n; a++) {
            bbm_interpolation(e, &m->vertex[e->first], middles, a, P);
            if (bbm_matrix_interpolate(m->K, i, a, P))
                break;
        }
    }
}
