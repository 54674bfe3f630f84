/* order.c - the pattern of K, the order of its rows, which of them hang together, and its entries.
 *
 * Pattern. K consists of 6x6 blocks, a block row for each element. An element has three or four
 * neighbours, so that most blocks are zero for ever, and an iteration, unlike a factorisation,
 * fills none of them. Only the diagonal blocks and those left of them that are not zero are stored,
 * row by row: `first` says where the blocks of a row begin, `back` how far left of the diagonal
 * each of them is. The pattern is made once; each time step clears K and adds the submatrices anew.
 *
 * Order. The rows are not in the caller's order but in the reverse Cuthill-McKee order: number the
 * elements from one end of the body to the other, breadth first, and reverse the numbers. The
 * blocks then lie in a narrow band, and what a sweep reads was written shortly before.
 *
 * Components. Rows that no block joins, however indirectly, belong to different components. The
 * order puts the rows of a component one after the other.
 */
#include "base.h"

typedef struct {                /* who is a neighbour of whom, in the caller's numbers         */
    int *first, (*end)[2];      /* [n+1]  of i: end[first[i] .. first[i+1]-1][1], ascending     */
    int *level;                 /* [n]    distance from the start of the search, -1: not found  */
} graph;

/* For qsort and bsearch of what begins with two integers: by the first, then by the second. */
int bbm_compare_pairs(const void *a, const void *b)
{
    const int *p = a, *q = b, by = p[0] == q[0];

    return (p[by] > q[by]) - (p[by] < q[by]);
}

/* Sorts both ends of all links by the row and then by the neighbour, and drops what comes twice. */
static bbm_status graph_new(graph *g, int n, int links, int (*link)[2])
{
    g->first = calloc(2 * (size_t)n + 1, sizeof *g->first);
    g->end = calloc(2 * (size_t)links + 1, sizeof *g->end);
    if (!g->first || !g->end)
        return BBM_NO_MEMORY;
    g->level = g->first + n + 1;
    for (int k = 0; k < 2 * links; k++) {
        g->end[k][0] = link[k / 2][k % 2];
        g->end[k][1] = link[k / 2][1 - k % 2];
        if (g->end[k][0] < 0 || g->end[k][0] >= n)
            return BBM_BAD_INDEX;
    }
    qsort(g->end, 2 * (size_t)links, sizeof *g->end, bbm_compare_pairs);
    int count = 0;
    for (int i = 0, k = 0; i < n; i++) {
        for (; k < 2 * links && g->end[k][0] == i; k++)
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

/* place[i] of row i: all components one after the other, then the whole order reversed. A component
 * begins with the row that a search finds last, for it lies at an end. `order`: scratch. */
static void reverse_cuthill_mckee(graph *g, int n, int order[], int place[])
{
    int done = 0;

    for (int i = 0; i < n; i++)
        if (g->level[i] < 0) {
            const int count = breadth_first(g, i, place);
            for (int k = 0; k < count; k++)
                g->level[place[k]] = -1;
            done += breadth_first(g, place[count - 1], order + done);
        }
    for (int i = 0; i < n; i++)
        place[order[i]] = n - 1 - i;
}

/* ----------------------------------------------------------------------------------- the matrix */

/* All arrays of one type are one piece of memory. */
static bbm_status allocate(bbm_matrix *K, int rows, const graph *g)
{
    const size_t n = (size_t)rows, blocks = (size_t)g->first[n] / 2;

    K->n = rows;
    K->place = calloc(6 * (n + 1) + blocks, sizeof *K->place);
    K->D = calloc(2 * n + blocks, sizeof *K->D);
    K->x = calloc(37 * n, sizeof *K->x);
    if (!K->place || !K->D || !K->x)
        return BBM_NO_MEMORY;
    int **const list[] = { &K->caller, &K->first, &K->start, &K->component, &K->body, &K->back };
    for (int k = 0; k < LENGTH(list); k++)
        *list[k] = K->place + (n + 1) * (size_t)(k + 1);
    K->L = K->D + n;
    K->inverse = K->L + blocks;
    double **const vector[] = { &K->r, &K->u, &K->p, &K->q, &K->y, &K->forces };
    for (int k = 0; k < LENGTH(vector); k++)
        *vector[k] = K->x + 6 * n * (size_t)(k + 1);
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
        K->component[row] = K->body[row] = K->components;
        if (g->level[row] == 0)
            K->start[++K->components] = i + 1;
    }
}

bbm_status bbm_matrix_new(int n, int links, int (*link)[2], bbm_matrix **out)
{
    graph g = { 0 };
    bbm_matrix *K = calloc(1, sizeof *K);
    bbm_status status = K ? graph_new(&g, n, links, link) : BBM_NO_MEMORY;

    status = status ? status : allocate(K, n, &g);
    if (!status) {
        reverse_cuthill_mckee(&g, n, K->caller, K->place);
        lay_out_rows(K, &g);
    } else
        bbm_matrix_free(K);
    free(g.first);
    free(g.end);
    *out = status ? NULL : K;
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
    free(K->term);
    free(K);
}

/* --------------------------------------------------------------------------------- the entries */

void bbm_matrix_clear(bbm_matrix *K)
{
    memset(K->D, 0, (size_t)(K->n + K->first[K->n]) * sizeof *K->D);
    K->ready = K->terms = K->lacks = 0;
}

/* Where K_ij is stored, or K_ji if row i comes before row j; NULL: nowhere. Most rows have one to
 * three blocks left of the diagonal, so that all are looked at. */
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

/* K_ij += B; if K_ji is stored, K_ji += B^T. */
bbm_status bbm_matrix_add(bbm_matrix *K, int i, int j, double B[6][6])
{
    double (*to)[6] = find_block(K, i, j);

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

/* ------------------------------------------------------------------- K for the contacts in hand */

/* Lays out K: a submatrix for each element, each gap between two of them and each two elements of a
 * contact, Eq. (5). Without memory the old one stays. */
bbm_status bbm_lay_out_matrix(bbm_model *m)
{
    const int most = m->scratch->contacts * (BBM_PARTS * (BBM_PARTS - 1) / 2) + m->gaps;
    int (*link)[2] = calloc((size_t)most + 1, sizeof *link), n = 0;
    bbm_matrix *K;

    if (!link)
        return BBM_NO_MEMORY;
    for (const bbm_contact *c = m->scratch->contact; c < bbm_end_of_contacts(m); c++)
        for (int j = 1; j < c->parts; j++)
            for (int i = 0; i < j; i++)
                memcpy(link[n++], (int [2]){ c->element[i], c->element[j] }, sizeof *link);
    for (int g = 0; g < m->gaps; g++)
        if (m->gap[g].j >= 0)
            memcpy(link[n++], (int [2]){ m->gap[g].i, m->gap[g].j }, sizeof *link);
    const int same = m->K && n == m->links && memcmp(link, m->link, (size_t)n * sizeof *link) == 0;
    if (same || bbm_matrix_new(m->elements, n, link, &K)) {
        free(link);
        return same ? BBM_OK : BBM_NO_MEMORY;
    }
    bbm_matrix_free(m->K);
    free(m->link);
    m->K = K;
    m->link = link;
    m->links = n;
    return BBM_OK;
}
