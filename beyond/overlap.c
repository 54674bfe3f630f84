/* overlap.c - elements that lie in each other at the start.
 *
 * A contact keeps a corner out of an edge that it comes to from outside. Blocks that overlap from the start have no
 * such history: the corner is behind the edge, no spring pushes it out, and the blocks fall through each other without
 * a word. Such a model is refused, with the place and the depth. Elements of one block may not overlap, either.
 *
 * An element is convex, or it is cut into triangles, ear by ear. Two convex pieces overlap when no edge of either has
 * the other piece wholly outside, and by the least way that parts them: the edge with the shortest one tells it
 * (separating axes). Bars that cross, or a block within another, are found like a corner in a side.
 * The candidates are pieces whose boxes overlap: sorted along the axis on which fewer boxes lie side by side.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "beyond.h"

/* Overlaps up to this, in mean boundary edges, are rounding of a model file, as in contact.c (TOUCH). */
#define TOUCH 1e-6

typedef struct { double x, y; } point;
typedef struct {                /* a convex part of an element                                                  */
    int element, n;
    const point *p;             /* [n]                                                                          */
    double low[2], high[2];     /* its box, the axis to sort along first                                        */
} piece;

/* Twice the signed area of the triangle a b c. */
static double turn(point a, point b, point c) { return (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y); }

/* ------------------------------------------------------------------------- polygons that meet themselves */

static point at(const bbm_model *m, int node) { return (point){ m->node[node].x, m->node[node].y }; }

/* Whether r, on the line through p and q, lies between them. */
static int between(point p, point q, point r)
{
    return (r.x - p.x) * (r.x - q.x) + (r.y - p.y) * (r.y - q.y) <= 0;
}

/* Whether the segments ab and cd have a point in common. */
static int segments_meet(point a, point b, point c, point d)
{
    const double abc = turn(a, b, c), abd = turn(a, b, d), cda = turn(c, d, a), cdb = turn(c, d, b);

    if (!signbit(abc) != !signbit(abd) && !signbit(cda) != !signbit(cdb))
        return 1;
    return (abc == 0 && between(a, b, c)) || (abd == 0 && between(a, b, d)) || (cda == 0 && between(c, d, a)) ||
           (cdb == 0 && between(c, d, b));
}

/* Whether the closed polygon through the nodes meets itself: two edges that are not neighbours have a point in
 * common, or an edge folds back on its neighbour (an edge without length does). */
static int meets_itself(const bbm_model *m, int n, const int node[])
{
    for (int i = 0; i < n; i++) {
        const point a = at(m, node[i]), b = at(m, node[(i + 1) % n]);
        for (int j = i + 2; j < n && (j + 1) % n != i; j++)
            if (segments_meet(a, b, at(m, node[j]), at(m, node[(j + 1) % n])))
                return 1;
    }
    return 0;
}

/* Refuses a new element whose boundary meets itself. */
bbm_status bbm_check_polygon(bbm_model *m, int n, const int node[])
{
    return meets_itself(m, n, node) ? bbm_fail(m, BBM_SELF_CROSSING, "element %d", m->elements)
                                    : BBM_OK;
}

/* ---------------------------------------------------------------------------------------- convex pieces */

static int is_convex(int n, const point p[])
{
    for (int a = 0; a < n; a++)
        if (turn(p[a], p[(a + 1) % n], p[(a + 2) % n]) < 0)
            return 0;
    return 1;
}

/* Whether corner k can be cut off: it is flat, or convex with no other corner in its triangle. */
static int is_ear(int n, const point p[], int k)
{
    const point a = p[(k + n - 1) % n], b = p[k], c = p[(k + 1) % n];

    if (turn(a, b, c) <= 0)
        return turn(a, b, c) == 0;
    for (int q = 0; q < n; q++)
        if (q != k && q != (k + 1) % n && q != (k + n - 1) % n && turn(a, b, p[q]) >= 0 && turn(b, c, p[q]) >= 0
            && turn(c, a, p[q]) >= 0)
            return 0;
    return 1;
}

/* The ear to cut next; should rounding hide them all, the smallest corner: what it does wrong is as small. */
static int find_ear(int n, const point p[])
{
    int smallest = 0;
    double least = INFINITY;

    for (int k = 0; k < n; k++) {
        const double size = fabs(turn(p[(k + n - 1) % n], p[k], p[(k + 1) % n]));
        if (is_ear(n, p, k))
            return k;
        if (size < least)
            least = size, smallest = k;
    }
    return smallest;
}

/* Cuts the polygon `left`, which is used up, into triangles: three points each, at `to`. Returns their number. */
static int cut_ears(int n, point left[], point *to)
{
    int count = 0;

    for (; n >= 3; n--) {
        const int k = find_ear(n, left);
        const point ear[3] = { left[(k + n - 1) % n], left[k], left[(k + 1) % n] };
        if (turn(ear[0], ear[1], ear[2]) > 0)
            memcpy(to + 3 * count++, ear, sizeof ear);
        memmove(left + k, left + k + 1, (size_t)(n - k - 1) * sizeof *left);
    }
    return count;
}

/* The box of a piece; the axis to sort along comes first. */
static void measure_box(piece *a, int axis)
{
    const int x = axis, y = 1 - axis;

    a->low[0] = a->low[1] = INFINITY;
    a->high[0] = a->high[1] = -INFINITY;
    for (int k = 0; k < a->n; k++) {
        a->low[x] = fmin(a->low[x], a->p[k].x);
        a->low[y] = fmin(a->low[y], a->p[k].y);
        a->high[x] = fmax(a->high[x], a->p[k].x);
        a->high[y] = fmax(a->high[y], a->p[k].y);
    }
}

/* The pieces of one element at its starting position; `p` and `left` have room for its points. Returns their number. */
static int cut_element(const bbm_model *m, int e, piece *to, point *p, point *left)
{
    const bbm_element *i = &m->element[e];

    for (int a = 0; a < i->n; a++) {
        const bbm_node *n = &m->node[m->vertex[i->first + a].node];
        p[a] = left[a] = (point){ n->x, n->y };
    }
    if (is_convex(i->n, p)) {
        *to = (piece){ .element = e, .n = i->n, .p = p };
        return 1;
    }
    const int count = cut_ears(i->n, left, p);
    for (int t = 0; t < count; t++)
        to[t] = (piece){ .element = e, .n = 3, .p = p + 3 * t };
    return count;
}

/* ----------------------------------------------------------------------------------------------- depth */

/* The shortest way on which b leaves a over one of the edges of a; 0 or less when it is outside of one already. */
static double way_out(const piece *a, const piece *b, double enough)
{
    double least = INFINITY;

    for (int k = 0; k < a->n && least > enough; k++) {
        const point p = a->p[k], q = a->p[(k + 1) % a->n];
        const double l = hypot(q.x - p.x, q.y - p.y);
        double deepest = -INFINITY;
        for (int v = 0; v < b->n; v++)
            deepest = fmax(deepest, turn(p, q, b->p[v]));
        least = fmin(least, deepest / l);
    }
    return least;
}

static int compare_pieces(const void *p, const void *q)
{
    const piece *a = p, *b = q;

    if (a->low[0] != b->low[0])
        return a->low[0] > b->low[0] ? 1 : -1;
    return a->p > b->p ? 1 : -1;
}

/* The deepest pair of sorted pieces, deeper than o->depth, which is the tolerance; NULL: there is none. */
static void find_deepest(int n, const piece s[], const piece *pair[2], bbm_overlap *o)
{
    for (int a = 0; a < n; a++)
        for (int b = a + 1; b < n && s[b].low[0] < s[a].high[0]; b++) {
            if (s[b].low[1] >= s[a].high[1] || s[a].low[1] >= s[b].high[1] || s[a].element == s[b].element)
                continue;
            const double there = way_out(&s[a], &s[b], o->depth);
            const double depth = there > o->depth ? fmin(there, way_out(&s[b], &s[a], o->depth)) : there;
            if (depth > o->depth)
                o->depth = depth, pair[0] = &s[a], pair[1] = &s[b];
        }
}

static void add_point(point p, double sum[3])
{
    sum[0] += p.x;
    sum[1] += p.y;
    sum[2]++;
}

/* Sums the corners of a that lie in b. */
static void add_corners(const piece *a, const piece *b, double sum[3])
{
    for (int k = 0; k < a->n; k++) {
        int inside = 1;
        for (int q = 0; q < b->n && inside; q++)
            inside = turn(b->p[q], b->p[(q + 1) % b->n], a->p[k]) >= 0;
        if (inside)
            add_point(a->p[k], sum);
    }
}

/* The middle of what two pieces have in common, seen from its corners: corners of one in the other, and edges that
 * cross. */
static void find_place(const piece *a, const piece *b, bbm_overlap *o)
{
    double sum[3] = { 0, 0, 0 };

    add_corners(a, b, sum);
    add_corners(b, a, sum);
    for (int k = 0; k < a->n * b->n; k++) {
        const point p = a->p[k % a->n], q = a->p[(k + 1) % a->n];
        const point r = b->p[k / a->n], s = b->p[(k / a->n + 1) % b->n];
        const double at_p = turn(r, s, p), at_q = turn(r, s, q);
        if (at_p * at_q < 0 && turn(p, q, r) * turn(p, q, s) < 0)
            add_point((point){ p.x + at_p / (at_p - at_q) * (q.x - p.x), p.y + at_p / (at_p - at_q) * (q.y - p.y) }, sum);
    }
    o->x = sum[0] / sum[2];
    o->y = sum[1] / sum[2];
}

/* -------------------------------------------------------------------------------------------- the check */

/* The axis on which the boxes lie side by side: the sum of their widths is small against the width of all. */
static int choose_axis(int n, const piece s[])
{
    double sum[2] = { 0, 0 }, low[2] = { INFINITY, INFINITY }, high[2] = { -INFINITY, -INFINITY };

    for (int k = 0; k < n; k++)
        for (int x = 0; x < 2; x++) {
            sum[x] += s[k].high[x] - s[k].low[x];
            low[x] = fmin(low[x], s[k].low[x]);
            high[x] = fmax(high[x], s[k].high[x]);
        }
    return sum[1] * (high[0] - low[0]) < sum[0] * (high[1] - low[1]);
}

static int cut_elements(const bbm_model *m, piece s[], point *p, point *left)
{
    int n = 0;

    for (int e = 0; e < m->elements; e++)
        n += cut_element(m, e, s + n, p + 3 * m->element[e].first, left);
    for (int k = 0; k < n; k++)
        measure_box(&s[k], 0);
    if (choose_axis(n, s) == 1)
        for (int k = 0; k < n; k++)
            measure_box(&s[k], 1);
    qsort(s, (size_t)n, sizeof *s, compare_pieces);
    return n;
}

static double tolerance(const bbm_model *m)
{
    double sum = 0;

    for (int e = 0; e < m->edges; e++) {
        const bbm_node *a = &m->node[m->vertex[m->edge[e].a].node], *b = &m->node[m->vertex[m->edge[e].b].node];
        sum += hypot(b->x - a->x, b->y - a->y);
    }
    return TOUCH * sum / m->edges;
}

/* Looks for the two elements of a prepared model that overlap deepest at the start; o->i = -1 if none do. */
bbm_status bbm_find_overlap(const bbm_model *m, bbm_overlap *o)
{
    const size_t v = (size_t)m->vertices;
    point *p = calloc(3 * v, sizeof *p), *left = calloc(v, sizeof *left);
    piece *s = calloc(v, sizeof *s);
    const piece *pair[2] = { NULL, NULL };

    *o = (bbm_overlap){ -1, -1, tolerance(m), 0, 0 };
    const int ok = p && left && s;
    if (ok) {
        find_deepest(cut_elements(m, s, p, left), s, pair, o);
        if (pair[0]) {
            find_place(pair[0], pair[1], o);
            o->i = pair[0]->element < pair[1]->element ? pair[0]->element : pair[1]->element;
            o->j = pair[0]->element + pair[1]->element - o->i;
        }
    }
    free(p);
    free(left);
    free(s);
    return ok ? BBM_OK : BBM_NO_MEMORY;
}

/* Refuses elements that lie in each other. */
bbm_status bbm_check_overlap(bbm_model *m)
{
    bbm_overlap o;

    if (bbm_find_overlap(m, &o))
        return BBM_NO_MEMORY;
    if (o.i < 0)
        return BBM_OK;
    const int p = m->element[o.i].block, q = m->element[o.j].block;
    m->blamed[0] = o.j;
    m->blamed[1] = o.i;
    return bbm_fail(m, p == q ? BBM_OVERLAP : BBM_BLOCKS_OVERLAP, "%g m deep at (%g, %g): block %d with element %d, block %d "
                "with element %d", o.depth, o.x, o.y, p, o.i, q, o.j);
}
