/* coarse.c - a second, coarse level for the SSOR-PCG of solver.c, by which the number of iterations
 * does not grow with the mesh.
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
 * positive definite by its form. On triangles some 15 iterations suffice on a mesh of any fineness,
 * on quadrilaterals some 20. What the nodes of a model are, and P, is in interpolation.c.
 *
 * The bond of two elements with a side in common opens by no displacement of the nodes, if they are
 * triangles, or quadrilaterals bonded in the middle of the side. So it has no part in Kc, which is
 * the sum of what the elements have without such bonds. K_ij E, where E continues the linear
 * displacement of i into j, is less what the bond adds to K_ii: the element's own stiffness is K_ii
 * + sum_j K_ij E. On quadrilaterals this leaves out the moments of the bonds, which feel little
 * else than the hourglass, displacements of the four corners to and fro by turns, in which P does
 * not move the element. Kc gets a small stiffness against it, as do quadrilaterals with one point
 * of integration (Flanagan and Belytschko, Int. J. Num. Meth. Eng. 17, 1981). All other blocks of K
 * enter Kc whole.
 *
 * Modes. A quadrilateral bonded in its middles has two coarse nodes more, its modes, which no other
 * element has: (u, v) s, and (u, v) t, with s and t the linear functions that are -1/2 and 1/2 in
 * the middles of two opposite sides and 0 in the others. Along a row of elements s may be up and
 * down by turns, with a size that changes slowly: that opens the bonds very little, though no nodes
 * make it, and no sweep sees much of it. So Kc also has the entries between a mode and itself, and
 * between the modes of two elements across their side: a chain for each row of elements, at the
 * price of a sweep. All other entries of modes are left out.
 *
 * Kc is factored by Cholesky (factor.c), in the order of nested dissection (A. George, SIAM J.
 * Numer. Anal. 10, 1973). The plane is halved again and again. What joins the halves of a cell are
 * entries of Kc between a node in the one and a node in the other; the nodes in the lower half that
 * have such entries are numbered behind all others of the cell. Without them nothing joins the
 * halves, nor does an entry of the factor. They are few: n nodes have a factor of some n log n
 * entries, in place of the n^1.5 of a band. The modes follow in the order of the rows.
 *
 * Displacements of the nodes that move no element have no stiffness: of their pivots rounding is
 * left, some eps of what was summed up before it cancelled. They are struck out: the coarse space
 * is then a little smaller, and the preconditioner as positive definite as before.
 */
#include "beyond.h"

/* [-] against the hourglass, of E t. Measured, alpha = 10 to 1e5: with ten times as much iterations
 * grow with alpha; with none they are half as many again. */
#define HOURGLASS 1e-3

typedef struct {                /* a corner of a row, or a mode                                 */
    int node, held;             /* its node; whether that is held                               */
    bbm_linear P;
} coarse_corner;

typedef struct {                /* a row of K                                                   */
    int start, mode;            /* a component of the rows i .. j-1 has the nodes row[i].start  */
                                /* .. row[j].start-1 and the modes row[i].mode .. row[j].mode-1 */
    int corners, modes;         /* how many; modes: 2 or 0                                      */
    coarse_corner *corner;      /* [corners + modes]                                            */
    double at[2];               /* centroid                                                     */
    double Q[4][4];             /* unknowns 2 to 5 of the slopes ux, uy, vx, vy                 */
    double hourglass;           /* stiffness against it, N/m                                    */
} coarse_row;

typedef struct {
    int nodes;                  /* without modes; some without a corner                         */
    coarse_row *row;            /* [rows+1]                                                     */
    coarse_corner *corner;      /* of all rows, one after the other                             */
    bbm_factor Kc;              /* then its factor                                              */
    double *x;                  /* [2 (nodes + modes)]  a vector                                */
    double *z;                  /* [6 rows]  a vector                                           */
} coarse_space;

/* ----------------------------------------------------------------------------------- the layout */

/* What the block of the rows i and j adds to Kc: WHOLE, all of it; ACROSS, what modes across a side
 * have. Nothing to be added whole is the bond of two triangles, or of two quadrilaterals with
 * modes, at no node that is held or in contact. mode: which corners of i and j are those across
 * their side. */
enum { WHOLE = 1, ACROSS = 2 };

static int find_share(const coarse_row *i, const coarse_row *j, int mode[2])
{
    const int modes = i->modes && j->modes;
    int common = 0, held = 0, sum[2] = { 0 };

    for (int a = 0; a < i->corners; a++)
        for (int b = 0; b < j->corners; b++)
            if (i->corner[a].node == j->corner[b].node) {
                common++;
                held |= i->corner[a].held;
                sum[0] += a;
                sum[1] += b;
            }
    mode[0] = i->corners + (sum[0] != 3);           /* corners 1 and 2, or 3 and 0 */
    mode[1] = j->corners + (sum[1] != 3);
    if (common != 2 || !(modes || (i->corners == 3 && j->corners == 3)))
        return WHOLE;
    return (modes ? ACROSS : 0) | (held ? WHOLE : 0);
}

static int add_entry(int (*entry)[2], int n, int p, int q)
{
    if (entry)
        memcpy(entry[n], (int [2]){ p, q }, sizeof *entry);
    return n + 1;
}

/* The entries of Kc below its diagonal: the pairs of nodes that meet in an element, or in elements
 * whose block is added whole, and the modes across a side; some several times. Returns their
 * number; entry NULL: no more than that. */
static int list_entries(const bbm_matrix *K, const coarse_space *c, int (*entry)[2])
{
    int n = 0, mode[2];

    for (int row = 0; row < K->n; row++)
        for (int k = K->first[row]; k <= K->first[row + 1]; k++) {
            const coarse_row *i = &c->row[row], *j = k < K->first[row + 1] ? i - K->back[k] : i;
            const int share = find_share(i, j, mode);
            if (share & ACROSS)
                n = add_entry(entry, n, i->corner[mode[0]].node, j->corner[mode[1]].node);
            for (int a = 0; a < i->corners && share & WHOLE; a++)
                for (int b = i == j ? a + 1 : 0; b < j->corners; b++)
                    n = add_entry(entry, n, i->corner[a].node, j->corner[b].node);
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

/* Numbers the nodes by sorted keys; modes stay. key, number: [n], scratch, the first 0. */
static void number_nodes(const bbm_matrix *K, coarse_space *c, const long long *place, int entries,
                         int (*entry)[2], long long (*key)[KEYS], int *number)
{
    for (int k = 0; k < entries; k++) {
        const int p = entry[k][0], q = entry[k][1];
        if (p < c->nodes)
            key[place[p] < place[q] ? p : q][SIZE] |= place[p] ^ place[q];
    }
    for (int v = 0; v < c->nodes; v++) {
        long long all = 0;
        while (all < key[v][SIZE])
            all = 2 * all + 1;
        key[v][SIZE] = all;
        key[v][LAST] = place[v] | all;
        key[v][NODE] = v;
    }
    qsort(key, (size_t)c->nodes, sizeof *key, compare_keys);
    for (int k = 0; k < c->nodes; k++)
        number[key[k][NODE]] = k;
    for (coarse_corner *a = c->corner; a < c->row[K->n].corner; a++)
        if (a->node < c->nodes)
            a->node = number[a->node];
    for (int k = 0, v = 0; k <= K->components; k++) {
        while (v < c->nodes && key[v][LAST] < BBM_PLACES * k)
            v++;
        c->row[K->start[k]].start = v;
    }
}

/* mode, corners, modes and held of each row, and node in the caller's numbers. */
static bbm_status list_nodes(const bbm_matrix *K, int nodes, const int *first, const int *node,
                             const int *middles, coarse_space *c)
{
    c->nodes = nodes;
    c->row = calloc((size_t)K->n + 1, sizeof *c->row);
    c->corner = calloc((size_t)(first[K->n] + (middles ? 2 * K->n : 0)), sizeof *c->corner);
    if (!c->row || !c->corner)
        return BBM_NO_MEMORY;
    c->row->mode = nodes;
    c->row->corner = c->corner;
    for (int i = 0; i < K->n; i++) {
        const int *from = first + K->caller[i];
        coarse_row *r = &c->row[i];
        coarse_corner *corner = r->corner;
        r->corners = from[1] - from[0];
        r->modes = middles && middles[K->caller[i]] ? 2 : 0;
        for (int k = from[0]; k < from[1]; k++)
            *corner++ = node[k] < 0 ? (coarse_corner){ .node = -1 - node[k], .held = 1 }
                                    : (coarse_corner){ .node = node[k] };
        for (int k = 0; k < r->modes; k++)
            *corner++ = (coarse_corner){ .node = r->mode + k };
        r[1].mode = r->mode + r->modes;
        r[1].corner = corner;
    }
    return BBM_OK;
}

static bbm_status lay_out(const bbm_matrix *K, const long long *place, coarse_space *c)
{
    const size_t nodes = (size_t)c->nodes, all = (size_t)c->row[K->n].mode;
    const int entries = list_entries(K, c, NULL);
    int (*entry)[2] = calloc((size_t)entries + nodes, sizeof *entry);
    long long (*key)[KEYS] = calloc(nodes, sizeof *key);
    bbm_status status = BBM_NO_MEMORY;

    c->x = calloc(2 * all + 6 * (size_t)K->n, sizeof *c->x);
    if (c->x && entry && key) {
        c->z = c->x + 2 * all;
        list_entries(K, c, entry);
        number_nodes(K, c, place, entries, entry, key, entry[entries]);
        list_entries(K, c, entry);
        status = bbm_factor_lay_out(&c->Kc, (int)all, entries, entry);
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
    free(c->row);
    free(c->corner);
    free(c->x);
    bbm_factor_free(&c->Kc);
    free(c);
}

/* Gives K a coarse space in place of the one it had: block row i has the nodes node[first[i]] ..
 * node[first[i+1]-1], all different, or none; -1 - v stands for a node v that is held, or in
 * contact. middles[i], if not NULL: row i has modes, a quadrilateral whose bonds with its like are
 * in the middles of their sides. place[v] is BBM_PLACES times the component of K that node v is in,
 * and less than BBM_PLACES more: near nodes should have the upper bits in common. */
bbm_status bbm_matrix_coarse(bbm_matrix *K, int nodes, const int *first, const int *node,
                             const long long *place, const int *middles)
{
    coarse_free(K->extra);
    K->extra = NULL;
    K->free_extra = coarse_free;
    K->ready = 0;
    if (first[K->n] == 0)
        return BBM_OK;
    coarse_space *c = calloc(1, sizeof *c);
    if (c && !list_nodes(K, nodes, first, node, middles, c) && !lay_out(K, place, c))
        return K->extra = c, BBM_OK;
    coarse_free(c);
    return BBM_NO_MEMORY;
}

/* The displacement (u, v) of the k-th node of block row i alone displaces the row by f (u, v), f
 * linear in x and y. u0 and v0 are the values at the centroid of its element e, the other unknowns
 * Q times the slopes ux, uy, vx, vy. */
bbm_status bbm_matrix_interpolate(bbm_matrix *K, int i, int k, double Q[4][4], bbm_linear f,
                                  const bbm_element *e)
{
    const coarse_space *c = K->extra;
    coarse_row *r = c && i >= 0 && i < K->n ? &c->row[K->place[i]] : NULL;

    if (!r || k < 0 || k >= r->corners)
        return BBM_BAD_INDEX;
    r->corner[k].P = f;
    r->at[0] = e->x;
    r->at[1] = e->y;
    r->hourglass = HOURGLASS * e->material.E * e->material.thickness;
    memcpy(r->Q, Q, sizeof r->Q);
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

/* Kc += P^T B P + its transpose, the first P that of the corner i and the other that of j. If these
 * are the same, the sum is symmetric and is added once. Pivots are measured by such sums. */
static void add_block(const bbm_factor *Kc, const coarse_corner *i, double B[6][6],
                      const coarse_corner *j)
{
    double Y[2][6], sum[2][2] = { { 0 } };

    for (int a = 0; a < 6; a++) {
        double row[2] = { 0 };
        add_to_node(&j->P, B[a], row);
        Y[0][a] = row[0];
        Y[1][a] = row[1];
    }
    for (int k = 0; k < 2; k++)
        add_to_node(&i->P, Y[k], sum[k]);
    for (int k = 0; k < 4; k++) {
        const int p = 2 * i->node + k / 2, q = 2 * j->node + k % 2;
        if (i != j || p >= q)
            *bbm_entry(Kc, p > q ? p : q, p > q ? q : p)
                += (p == q && i != j ? 2 : 1) * sum[k % 2][k / 2];
        if (i == j && p == q)
            Kc->size[p] += sum[k / 2][k / 2];
    }
}

/* own += B E, where E continues values and slopes by the way d. */
static void add_continued(double B[6][6], const double d[2], double own[6][6])
{
    for (int a = 0; a < 6; a++)
        for (int b = 0; b < 6; b++)
            own[a][b] += B[a][b] + (b < 2 ? 0 : B[a][b / 4] * d[b % 2]);
}

/* What the block B of the rows i and j adds, to the corners or to the elements' own stiffness, and
 * to the modes. */
static void add_pair(const bbm_factor *Kc, const coarse_row *i, const coarse_row *j,
                     double B[6][6], double own_i[6][6], double own_j[6][6])
{
    const double way[2] = { j->at[0] - i->at[0], j->at[1] - i->at[1] };
    double transposed[6][6];
    int mode[2];
    const int share = find_share(i, j, mode);

    for (int b = 0; b < j->corners && share & WHOLE; b++)
        for (int a = 0; a < i->corners; a++)
            add_block(Kc, &i->corner[a], B, &j->corner[b]);
    if (share & ACROSS)
        add_block(Kc, &i->corner[mode[0]], B, &j->corner[mode[1]]);
    if (share & WHOLE)
        return;
    for (int a = 0; a < 36; a++)
        transposed[a / 6][a % 6] = B[a % 6][a / 6];
    add_continued(B, way, own_i);
    add_continued(transposed, (double [2]){ -way[0], -way[1] }, own_j);
}

/* P of the modes of a row, s and t: half of what two corners next to each other do, less half of
 * what the others do. Adds their block of Kc. */
static void add_modes(const bbm_factor *Kc, const coarse_row *r, double B[6][6])
{
    const coarse_corner *of = r->corner;

    for (int k = 0; k < r->modes; k++) {
        const bbm_linear *up[2] = { &of[1 + k].P, &of[2 + k].P };
        const bbm_linear *down[2] = { &of[0].P, &of[3 - 2 * k].P };
        coarse_corner *mode = &r->corner[4 + k];
        mode->P.f = (up[0]->f + up[1]->f - down[0]->f - down[1]->f) / 2;
        mode->P.fx = (up[0]->fx + up[1]->fx - down[0]->fx - down[1]->fx) / 2;
        mode->P.fy = (up[0]->fy + up[1]->fy - down[0]->fy - down[1]->fy) / 2;
        add_block(Kc, mode, B, mode);
    }
}

/* The stiffness of an element without bonds, and against its hourglass, to and fro by turns. */
static void add_element(const bbm_factor *Kc, const coarse_row *r, double own[6][6])
{
    const coarse_corner *of = r->corner;

    for (int b = 0; b < r->corners; b++)
        for (int a = 0; a <= b; a++)
            add_block(Kc, &of[a], own, &of[b]);
    for (int k = 0; k < 32 && r->modes; k++) {
        const int p = 2 * of[k / 8].node + k % 2, q = 2 * of[k / 2 % 4].node + k % 2;
        if (p >= q)
            *bbm_entry(Kc, p, q) += (k / 8 + k / 2) % 2 ? -r->hourglass : r->hourglass;
    }
}

/* Kc, and its factor. own: the elements' own stiffness against values and slopes, in the room of
 * the six vectors of an iteration that has not begun. */
static void make_coarse(bbm_matrix *K)
{
    const coarse_space *c = K->extra;
    double (*own)[6][6] = (double (*)[6][6])K->x;
    double V[6][6], B[6][6];

    memset(c->Kc.A, 0, (c->Kc.entries + 2 * (size_t)c->Kc.n) * sizeof *c->Kc.A);
    memset(own, 0, (size_t)K->n * sizeof *own);
    for (int i = 0; i < K->n; i++) {
        coarse_row *r = &c->row[i];
        take_block(K->D[i], r->Q, V);
        take_block(V, r->Q, B);
        add_continued(B, (double [2]){ 0 }, own[i]);
        add_modes(&c->Kc, r, B);
        for (int k = K->first[i]; k < K->first[i + 1]; k++) {
            take_block(K->L[k], r[-K->back[k]].Q, V);
            take_block(V, r->Q, B);
            add_pair(&c->Kc, r, r - K->back[k], B, own[i], own[i - K->back[k]]);
        }
    }
    for (int i = 0; i < K->n; i++)
        add_element(&c->Kc, &c->row[i], own[i]);
    bbm_factor_make(&c->Kc);
}

/* z = P x for the rows in hand. */
static void interpolate(const bbm_matrix *K, const coarse_space *c)
{
    for (int i = K->from; i < K->to; i++) {
        coarse_row *r = &c->row[i];
        double *z = &c->z[6 * i], (*Q)[4] = r->Q, s[4] = { 0 };
        memset(z, 0, 6 * sizeof *z);
        for (const coarse_corner *a = r->corner; a < r[1].corner; a++)
            for (int k = 0; k < 2; k++) {
                const double x = c->x[2 * a->node + k];
                z[k] += a->P.f * x;
                s[2 * k] += a->P.fx * x;
                s[2 * k + 1] += a->P.fy * x;
            }
        for (int a = 0; a < 4; a++)
            z[2 + a] = Q[a][0] * s[0] + Q[a][1] * s[1] + Q[a][2] * s[2] + Q[a][3] * s[3];
    }
}

/* f += L P Kc^-1 P^T L^T y */
static void correct(const bbm_matrix *K, const double *y, double *f)
{
    const coarse_space *c = K->extra;
    coarse_row *from = &c->row[K->from], *to = &c->row[K->to];
    const int range[2][2] = { { from->start, to->start }, { from->mode, to->mode } };
    double s[6];

    memset(c->z + 6 * K->from, 0, 6 * (size_t)(K->to - K->from) * sizeof *c->z);
    for (int k = 0; k < 2; k++)
        memset(c->x + 2 * range[k][0], 0, 2 * (size_t)(range[k][1] - range[k][0]) * sizeof *c->x);
    bbm_add_upper(K, y, c->z);
    for (coarse_row *r = from; r < to; r++) {
        take_to_slopes(r->Q, &c->z[6 * (r - c->row)], s);
        for (const coarse_corner *a = r->corner; a < r[1].corner; a++)
            add_to_node(&a->P, s, &c->x[2 * a->node]);
    }
    for (int k = 0; k < 2; k++)
        bbm_substitute(&c->Kc, range[k][0], range[k][1], c->x);
    interpolate(K, c);
    bbm_add_lower(K, c->z, f);
}

const bbm_method bbm_two_level = { make_coarse, correct };
