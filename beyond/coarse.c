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
 * the stiffness on the coarse grid, with all fixed points, contacts and inertia in it. Where T is
 * taken in the middle of a step that turns, so is P (bbm_slopes). With w = 1,
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
 * Kc is factored by Cholesky (factor.c), in the order of nested dissection (A. George, SIAM J.
 * Numer. Anal. 10, 1973). The plane is halved again and again. What joins the halves of a cell are
 * entries of Kc between a node in the one and a node in the other; the nodes in the lower half that
 * have such entries are numbered behind all others of the cell. Without them nothing joins the
 * halves, nor does an entry of the factor. They are few: n nodes have a factor of some n log n
 * entries, in place of the n^1.5 of a band.
 *
 * Rows i and j with a side in common. The springs of a side measure gaps between t_i and t_j, the
 * displacements of the side as either element has it. P gives a triangle there what is linear
 * between the two nodes of the side, s, so t_i = t_j = s. But on a quadrilateral t_i hangs on all
 * four nodes, and Kc would join two nodes that no element has both: its factor would have nearly
 * three times as many entries. So Kc measures t_i - s and t_j - s in place of t_i - t_j. A linear
 * displacement opens none of these. With R for the unknowns of i, or j, that s makes, K_ij adds
 *
 *     P_i^T K_ij P_j - (P_i - R_i)^T K_ij (P_j - R_j),
 *
 * and Kc still is positive semidefinite. At alpha = 100 a large model takes a third more iterations
 * and 0.6 of the time. A small one would gain nothing, and one with contacts would lose: they keep
 * K_ij whole. So do two rows with a held node: between them there may be a spring of negative
 * stiffness (bending.c), and with that the sum might not be positive.
 *
 * Displacements of the nodes that move no element (the hourglass of quadrilaterals) have no
 * stiffness: of their pivots rounding is left, some eps of what was summed up before it cancelled.
 * They are struck out: the coarse space is then a little smaller, and the preconditioner as
 * positive definite as before.
 */
#include <stdlib.h>
#include <string.h>

#include "beyond.h"

/* Nodes of a large model. Measured, alpha = 100 and 1000: with 2,000 nodes a solution takes as long
 * by the smaller Kc, with 2,600 it takes 0.8 and 0.9 of the time. */
#define LARGE 2500

typedef struct {
    int n;                      /* nodes, some without a corner                                 */
    int large;                  /* of many nodes, and without contacts                          */
    int *start;                 /* [rows+1]  a component of the rows i .. j-1 has the nodes     */
                                /*           start[i] .. start[j]-1                             */
    int *first, *node;          /* [rows+1]  row i has the nodes node[first[i] .. first[i+1]-1] */
    int *held;                  /* as node: it is                                               */
    bbm_linear *P;              /* as node                                                      */
    double (*at)[2];            /* as node: from the row's centroid                             */
    double (*Q)[4][4];          /* [rows]   unknowns 2 to 5 of the slopes ux, uy, vx, vy        */
    bbm_factor Kc;              /* then its factor                                              */
    double *x;                  /* [2 n]     a vector                                           */
    double *z;                  /* [6 rows]  a vector                                           */
} coarse_space;

/* ----------------------------------------------------------------------------------- the layout */

/* The corners of row i that row j has, too, if both are elements with a side in common, that is,
 * share two of three nodes or more. Returns how many nodes both have, these twice; 0: they share
 * nodes, but no side, or one that Kc takes whole; -1: they share none. */
static int find_side(const coarse_space *c, int i, int j, int corner[2])
{
    const int ni = c->first[i + 1] - c->first[i], nj = c->first[j + 1] - c->first[j];
    int common = 0, held = 0;

    for (int a = c->first[i]; a < c->first[i + 1]; a++)
        for (int b = c->first[j]; b < c->first[j + 1]; b++)
            if (c->node[a] == c->node[b]) {
                corner[common++ % 2] = a;
                held |= c->held[a];
            }
    if (common == 2 && ni > 2 && nj > 2 && (ni + nj == 6 || (c->large && !held)))
        return ni + nj;
    return common > 0 ? 0 : -1;
}

/* The entries of Kc below its diagonal: the pairs of nodes that meet in an element, or in elements
 * that a block of K joins without a common side, some several times. entry NULL: counts them. With
 * a block of a contact or a bolt, which share no node, a model no longer counts as large: it would
 * take far more iterations by the smaller Kc. */
static int list_entries(const bbm_matrix *K, coarse_space *c, int (*entry)[2])
{
    int n = 0, p[2];

    for (int i = 0; i < K->n; i++)
        for (int k = K->first[i]; k <= K->first[i + 1]; k++) {
            const int j = k < K->first[i + 1] ? i - K->back[k] : i, side = find_side(c, i, j, p);
            const int before = n;
            for (int a = c->first[i]; a < c->first[i + 1] && side <= 0; a++)
                for (int b = i == j ? a + 1 : c->first[j]; b < c->first[j + 1]; b++, n++)
                    if (entry)
                        memcpy(entry[n], (int [2]){ c->node[a], c->node[b] }, sizeof *entry);
            c->large &= side >= 0 || n == before;
        }
    return n;
}

/* What a node is numbered by: its cell is the smallest that has it and the nodes of higher places
 * to which an entry joins it; the last place there, and how many there are, less 1. */
enum { LAST, SIZE, NODE, KEYS };

static int compare_keys(const void *a, const void *b)
{
    const long long *p = a, *q = b;
    int k = 0;

    while (k < NODE && p[k] == q[k])
        k++;
    return (p[k] > q[k]) - (p[k] < q[k]);
}

/* Numbers the nodes by sorted keys, also in the entries. key, number: [n], scratch, the first 0. */
static void number_nodes(const bbm_matrix *K, coarse_space *c, const long long *place, int entries,
                         int (*entry)[2], long long (*key)[KEYS], int *number)
{
    for (int k = 0; k < entries; k++) {
        const int p = entry[k][0], q = entry[k][1];
        key[place[p] < place[q] ? p : q][SIZE] |= place[p] ^ place[q];
    }
    for (int v = 0; v < c->n; v++) {
        long long all = 0;
        while (all < key[v][SIZE])
            all = 2 * all + 1;
        key[v][SIZE] = all;
        key[v][LAST] = place[v] | all;
        key[v][NODE] = v;
    }
    qsort(key, (size_t)c->n, sizeof *key, compare_keys);
    for (int k = 0; k < c->n; k++)
        number[key[k][NODE]] = k;
    for (int a = 0; a < c->first[K->n]; a++)
        c->node[a] = number[c->node[a]];
    for (int k = 0; k < 2 * entries; k++)
        entry[k / 2][k % 2] = number[entry[k / 2][k % 2]];
    for (int k = 0, v = 0; k <= K->components; k++) {
        while (v < c->n && key[v][LAST] < BBM_PLACES * k)
            v++;
        c->start[K->start[k]] = v;
    }
}

static int node_of(int number) { return number < 0 ? -1 - number : number; }

static bbm_status lay_out(const bbm_matrix *K, int nodes, const int *first, const int *node,
                          const long long *place, coarse_space *c)
{
    const size_t corners = (size_t)first[K->n], rows = (size_t)K->n + 1;

    c->n = nodes;
    c->start = calloc(2 * rows + 2 * corners, sizeof *c->start);
    c->P = calloc(corners * (sizeof *c->P + sizeof *c->at) + rows * sizeof *c->Q, 1);
    c->x = calloc(2 * (size_t)nodes + 6 * rows, sizeof *c->x);
    if (!c->start || !c->P || !c->x)
        return BBM_NO_MEMORY;
    c->at = (double (*)[2])(c->P + corners);
    c->Q = (double (*)[4][4])(c->at + corners);
    c->first = c->start + rows;
    c->node = c->first + rows;
    c->held = c->node + corners;
    c->z = c->x + 2 * nodes;
    for (int i = 0; i < K->n; i++) {
        const int *from = first + K->caller[i];
        c->first[i + 1] = c->first[i] + from[1] - from[0];
        for (int a = c->first[i], k = from[0]; k < from[1]; a++, k++) {
            c->held[a] = node[k] < 0;
            c->node[a] = node_of(node[k]);
        }
    }
    c->large = nodes > LARGE;
    list_entries(K, c, NULL);               /* clears `large` if there are contacts: counted anew */
    const int entries = list_entries(K, c, NULL);
    int (*entry)[2] = calloc((size_t)entries + (size_t)nodes, sizeof *entry);
    long long (*key)[KEYS] = calloc((size_t)nodes, sizeof *key);
    bbm_status status = BBM_NO_MEMORY;
    if (entry && key) {
        list_entries(K, c, entry);
        number_nodes(K, c, place, entries, entry, key, entry[entries]);
        status = bbm_factor_lay_out(&c->Kc, nodes, entries, entry);
    }
    free(entry);
    free(key);
    return status;
}

static void coarse_free(void *extra)
{
    coarse_space *c = extra;

    if (!c)
        return;
    free(c->start);
    free(c->P);
    free(c->x);
    bbm_factor_free(&c->Kc);
    free(c);
}

/* Gives K a coarse space in place of the one it had: block row i has the nodes node[first[i]] ..
 * node[first[i+1]-1], all different, or none; -1 - v stands for a node v that is held. Rows of
 * three nodes or more that share two of them must be elements bonded along that side. place[v] is
 * BBM_PLACES times the component of K that node v is in, and less than BBM_PLACES more: near nodes
 * should have the upper bits in common. */
bbm_status bbm_matrix_coarse(bbm_matrix *K, int nodes, const int *first, const int *node,
                             const long long *place)
{
    for (int k = 0; k < first[K->n]; k++)
        if (node_of(node[k]) >= nodes)
            return BBM_BAD_INDEX;
    coarse_free(K->extra);
    K->extra = NULL;
    K->free_extra = coarse_free;
    K->ready = 0;
    if (first[K->n] == 0)
        return BBM_OK;
    coarse_space *c = calloc(1, sizeof *c);
    const bbm_status status = c ? lay_out(K, nodes, first, node, place, c) : BBM_NO_MEMORY;
    if (status)
        coarse_free(c);
    K->extra = status ? NULL : c;
    return status;
}

/* The displacement (u, v) of the k-th node of block row i alone displaces the row by f (u, v), f
 * linear in x and y; (x, y) [m]: where the node lies. Both are taken from the element's centroid.
 * u0 and v0 are the values there, the other unknowns Q times the slopes ux, uy, vx, vy. */
bbm_status bbm_matrix_interpolate(bbm_matrix *K, int i, int k, double Q[4][4], bbm_linear f,
                                  double x, double y)
{
    const coarse_space *c = K->extra;
    const int *first = c && i >= 0 && i < K->n ? &c->first[K->place[i]] : NULL;

    if (!first || k < 0 || k >= first[1] - first[0])
        return BBM_BAD_INDEX;
    c->P[first[0] + k] = f;
    memcpy(c->at[first[0] + k], (double [2]){ x, y }, sizeof *c->at);
    memcpy(c->Q[K->place[i]], Q, sizeof *c->Q);
    K->ready = 0;
    return BBM_OK;
}

/* ---------------------------------------------------------------------------- Kc and its factor */

/* x += the share of one node in y, the forces on values and slopes of one row. */
static void add_to_node(const bbm_linear *P, const double y[6], double x[2])
{
    x[0] += P->f * y[0] + P->fx * y[2] + P->fy * y[3];
    x[1] += P->f * y[1] + P->fx * y[4] + P->fy * y[5];
}

/* y: the forces on values and slopes that are z on the unknowns; only the slopes need Q^T. */
static void take_to_slopes(double Q[4][4], const double z[6], double y[6])
{
    for (int b = 0; b < 4; b++)
        y[2 + b] = Q[0][b] * z[2] + Q[1][b] * z[3] + Q[2][b] * z[4] + Q[3][b] * z[5];
    memcpy(y, z, 2 * sizeof *y);
}

/* W = (B Q)^T, the block B of two rows for values and slopes of the second. */
static void take_block(double B[6][6], double Q[4][4], double W[6][6])
{
    double y[6];

    for (int a = 0; a < 6; a++) {
        take_to_slopes(Q, B[a], y);
        for (int b = 0; b < 6; b++)
            W[b][a] = y[b];
    }
}

/* Y = s B P, by columns. */
static void multiply(double s, double B[6][6], const bbm_linear *P, double Y[2][6])
{
    for (int a = 0; a < 6; a++) {
        double row[2] = { 0 };
        add_to_node(P, B[a], row);
        Y[0][a] = s * row[0];
        Y[1][a] = s * row[1];
    }
}

/* Kc += P^T Y + its transpose, where P belongs to node i and Y to node j; `own`: P is Y's, the
 * sum is symmetric and is added once. Pivots are measured by such sums. */
static void add_block(const coarse_space *c, const bbm_linear *P, int i, double Y[2][6], int j,
                      int own)
{
    double sum[2][2] = { { 0 } };

    for (int k = 0; k < 2; k++)
        add_to_node(P, Y[k], sum[k]);
    for (int k = 0; k < 4; k++) {
        const int p = 2 * i + k / 2, q = 2 * j + k % 2;
        if (!own || p >= q)
            *bbm_entry(&c->Kc, p > q ? p : q, p > q ? q : p)
                += (p == q && !own ? 2 : 1) * sum[k % 2][k / 2];
        if (own && p == q)
            c->Kc.size[p] += sum[k / 2][k / 2];
    }
}

/* Z = P - R of corner a of a row with this side: R is 1 at a and 0 at the side's other end and
 * does not change across the side, or 0 if a is not on the side. Returns whether it is. */
static int find_rest(const coarse_space *c, int a, const int side[2], bbm_linear *Z)
{
    const int common = a == side[0] || a == side[1];
    const double *from = c->at[a], *to = c->at[side[a == side[0]]];
    const double x = to[0] - from[0], y = to[1] - from[1], l2 = x * x + y * y;
    const double r = common / l2, f = to[0] * x + to[1] * y;

    *Z = (bbm_linear){ c->P[a].f - r * f, c->P[a].fx + r * x, c->P[a].fy + r * y };
    return common;
}

/* Kc = P^T (D + L + L^T) P, but for rows with a side in common what the head says, and its factor.
 * Between triangles all of that is 0 but the sums of a node with itself. */
static void make_coarse(bbm_matrix *K)
{
    const coarse_space *c = K->extra;
    double V[6][6], B[6][6], Y[2][6], W[2][6];
    int p[2], q[2];
    bbm_linear Z;

    memset(c->Kc.A, 0, (c->Kc.entries + 2 * (size_t)c->n) * sizeof *c->Kc.A);
    for (int i = 0; i < K->n; i++)
        for (int k = K->first[i]; k <= K->first[i + 1]; k++) {
            const int D = k == K->first[i + 1], j = D ? i : i - K->back[k];
            const int side = find_side(c, i, j, p);
            find_side(c, j, i, q);
            take_block(D ? K->D[i] : K->L[k], c->Q[j], V);
            take_block(V, c->Q[i], B);
            for (int b = c->first[j]; b < c->first[j + 1]; b++) {
                const int common = side > 6 && find_rest(c, b, q, &Z);
                multiply(1, B, &c->P[b], Y);
                if (side > 6)
                    multiply(-1, B, &Z, W);
                for (int a = c->first[i]; a < (D ? b + 1 : c->first[i + 1]); a++) {
                    if (side == 6 ? c->node[a] != c->node[b]
                                  : side > 6 && !find_rest(c, a, p, &Z) && !common)
                        continue;
                    add_block(c, &c->P[a], c->node[a], Y, c->node[b], D && a == b);
                    if (side > 6)
                        add_block(c, &Z, c->node[a], W, c->node[b], 0);
                }
            }
        }
    bbm_factor_make(&c->Kc);
}

/* z = P x for the rows in hand. */
static void interpolate(const bbm_matrix *K, const coarse_space *c)
{
    for (int i = K->from; i < K->to; i++) {
        double *z = &c->z[6 * i], (*Q)[4] = c->Q[i], s[4] = { 0 };
        memset(z, 0, 6 * sizeof *z);
        for (int a = c->first[i]; a < c->first[i + 1]; a++) {
            const bbm_linear *P = &c->P[a];
            const double *x = &c->x[2 * c->node[a]];
            z[0] += P->f * x[0];
            z[1] += P->f * x[1];
            s[0] += P->fx * x[0];
            s[1] += P->fy * x[0];
            s[2] += P->fx * x[1];
            s[3] += P->fy * x[1];
        }
        for (int a = 0; a < 4; a++)
            z[2 + a] = Q[a][0] * s[0] + Q[a][1] * s[1] + Q[a][2] * s[2] + Q[a][3] * s[3];
    }
}

/* f += L P Kc^-1 P^T L^T y */
static void correct(const bbm_matrix *K, const double *y, double *f)
{
    const coarse_space *c = K->extra;
    const int from = c->start[K->from], to = c->start[K->to];
    double s[6];

    memset(c->z + 6 * K->from, 0, 6 * (size_t)(K->to - K->from) * sizeof *c->z);
    memset(c->x + 2 * from, 0, 2 * (size_t)(to - from) * sizeof *c->x);
    bbm_add_upper(K, y, c->z);
    for (int i = K->from; i < K->to; i++) {
        take_to_slopes(c->Q[i], &c->z[6 * i], s);
        for (int a = c->first[i]; a < c->first[i + 1]; a++)
            add_to_node(&c->P[a], s, &c->x[2 * c->node[a]]);
    }
    bbm_substitute(&c->Kc, from, to, c->x);
    interpolate(K, c);
    bbm_add_lower(K, c->z, f);
}

/* Without a coarse space, or where it does not pay, the paper's method. */
static void choose(const bbm_matrix *K, bbm_pcg *pcg)
{
    pcg->omega = K->extra ? 1 : pcg->omega;
    pcg->method = K->extra ? pcg->method : NULL;
}

const bbm_method bbm_two_level = { choose, make_coarse, correct };
