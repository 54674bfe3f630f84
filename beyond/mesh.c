/* mesh.c - meshes that cannot be meant: elements that lie in each other, blocks in pieces.
 *
 * A contact keeps a corner out of an edge that it comes to from outside. Blocks that overlap from
 * the start have no such history: the corner is behind the edge, no spring pushes it out, and the
 * blocks fall through each other. Such a model is refused, with the place and the depth. Elements
 * of one block may not overlap, either, and no element may meet itself.
 *
 * From an element that is not convex triangles are cut, ear by ear, until the rest is. Two convex
 * parts overlap when no edge of either has the other part wholly outside, and by the least way
 * that parts them: the edge with the shortest one tells it (separating axes). Bars that cross, or
 * a block within another, are found like a corner in a side. Candidates are parts whose
 * projections on an axis overlap; the axis slants, x + y/4, as in sweep.c.
 *
 * Bonds join elements that share a side, both its nodes. A mesh that is meant to be one block can
 * fall into pieces without a sign of it: two parts with nodes of their own at the same places, a
 * node in the middle of a neighbour's side (a hanging node), two elements that share a corner
 * alone. Since elements of one block do not touch each other either, the pieces then move through
 * each other. It may be meant - several stones under one name - so it is no error; but whoever
 * runs a model should hear of it.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "beyond.h"

/* TOUCH [-]  overlaps up to this, in mean boundary edges of all blocks, are rounding of a model
 *            file */
#define TOUCH 1e-6

typedef struct {                /* a convex part of an element                                  */
    int element, n;
    const bbm_node **p;         /* [n]                                                          */
    double low, high;           /* m        on the axis                                         */
} part;

/* Twice the signed area of the triangle a b c: positive if it runs counter-clockwise. */
static double orient(const bbm_node *a, const bbm_node *b, const bbm_node *c)
{
    return (b->x - a->x) * (c->y - a->y) - (c->x - a->x) * (b->y - a->y);
}

/* ---------------------------------------------------------------- polygons that meet themselves */

/* Whether the segments a b and c d have a point in common: the line of neither has the other
 * strictly on one side, and their boxes meet, which tells it if all are on one line. */
static int segments_meet(const bbm_node *a, const bbm_node *b, const bbm_node *c, const bbm_node *d)
{
    const double abc = orient(a, b, c), abd = orient(a, b, d);
    const double cda = orient(c, d, a), cdb = orient(c, d, b);

    return fmin(abc, abd) <= 0 && fmax(abc, abd) >= 0 && fmin(cda, cdb) <= 0 && fmax(cda, cdb) >= 0
        && fmin(a->x, b->x) <= fmax(c->x, d->x) && fmax(a->x, b->x) >= fmin(c->x, d->x)
        && fmin(a->y, b->y) <= fmax(c->y, d->y) && fmax(a->y, b->y) >= fmin(c->y, d->y);
}

/* Refuses a new element whose boundary meets itself: two edges that are not neighbours have a
 * point in common. An edge that folds back on its neighbour, or has no length, meets the next but
 * one. */
bbm_status bbm_check_polygon(bbm_model *m, int n, const int node[])
{
    const bbm_node *p = m->node;

    for (int i = 0; i < n; i++)
        for (int j = i + 2; j < n && (j + 1) % n != i; j++)
            if (segments_meet(&p[node[i]], &p[node[i + 1]], &p[node[j]], &p[node[(j + 1) % n]]))
                return bbm_fail(m, BBM_SELF_CROSSING, "element %d", m->elements);
    return BBM_OK;
}

/* ------------------------------------------------------------------------------- convex parts */

/* The corner to cut off next, -1: the polygon is convex. An ear is convex and has no other corner
 * in its triangle. Should rounding hide all of them, the smallest corner: what it does wrong is as
 * small. */
static int find_ear(int n, const bbm_node **p)
{
    int convex = 1, ear = -1;
    double least = INFINITY;

    for (int k = 0; k < n && (convex || least >= 0); k++) {
        const bbm_node *a = p[(k + n - 1) % n], *b = p[k], *c = p[(k + 1) % n];
        const double area = orient(a, b, c);
        int is_ear = area > 0;
        for (int q = k + 2; q < k + n - 1 && is_ear; q++) {
            const bbm_node *d = p[q % n];
            is_ear = orient(a, b, d) < 0 || orient(b, c, d) < 0 || orient(c, a, d) < 0;
        }
        const double size = is_ear ? -1 : fabs(area);
        if (size < least) {
            least = size;
            ear = k;
        }
        convex = convex && area >= 0;
    }
    return convex ? -1 : ear;
}

/* A part of element e, with its projection. */
static part make_part(int e, int n, const bbm_node **p)
{
    part s = { e, n, p, INFINITY, -INFINITY };

    for (int k = 0; k < n; k++) {
        const double at = p[k]->x + p[k]->y / 4;
        s.low = fmin(s.low, at);
        s.high = fmax(s.high, at);
    }
    return s;
}

/* The parts of element e at its starting position. Returns their number. In p is room for 4 times
 * its corners: those that are left, and three of each ear. */
static int cut_element(const bbm_model *m, int e, part *to, const bbm_node **p)
{
    int n = m->element[e].n, parts = 0;
    const bbm_node **ear = p + n;

    for (int k = 0; k < n; k++)
        p[k] = &m->node[m->vertex[m->element[e].first + k].node];
    for (int k = find_ear(n, p); n > 3 && k >= 0; k = find_ear(n, p), ear += 3) {
        for (int c = 0; c < 3; c++)
            ear[c] = p[(k + n - 1 + c) % n];
        to[parts++] = make_part(e, 3, ear);
        n--;
        memmove(p + k, p + k + 1, (size_t)(n - k) * sizeof *p);
    }
    to[parts++] = make_part(e, n, p);
    return parts;
}

/* -------------------------------------------------------------------------------------- depth */

/* The shortest way, up to `least`, on which b leaves a over one of the edges of a; 0 or less, not
 * the shortest: b is outside of one already. */
static double way_out(const part *a, const part *b, double least)
{
    for (int k = 0; k < a->n && least > 0; k++) {
        const bbm_node *p = a->p[k], *q = a->p[(k + 1) % a->n];
        double deepest = -INFINITY;
        for (int v = 0; v < b->n; v++)
            deepest = fmax(deepest, orient(p, q, b->p[v]));
        least = fmin(least, deepest / hypot(q->x - p->x, q->y - p->y));
    }
    return least;
}

/* Sums up, and counts, the points where the edges of a begin to lie in b: corners of a, and points
 * where they enter b. `from` and `to` are shares of the edge from p to q. */
static void add_corners(const part *a, const part *b, double sum[3])
{
    for (int k = 0; k < a->n; k++) {
        const bbm_node *p = a->p[k], *q = a->p[(k + 1) % a->n];
        double from = 0, to = 1;
        for (int e = 0; e < b->n; e++) {
            const double at_p = orient(b->p[e], b->p[(e + 1) % b->n], p);
            const double at_q = orient(b->p[e], b->p[(e + 1) % b->n], q);
            if (at_p < 0)
                from = fmax(from, at_q > 0 ? at_p / (at_p - at_q) : INFINITY);
            else if (at_q < 0)
                to = fmin(to, at_p / (at_p - at_q));
        }
        if (from <= to) {
            sum[0] += p->x + from * (q->x - p->x);
            sum[1] += p->y + from * (q->y - p->y);
            sum[2]++;
        }
    }
}

/* Two parts that overlap, and the middle of what they share: where an edge of it ends, one of the
 * other part begins, so that both together list its corners. */
static bbm_overlap describe(const part *a, const part *b, double depth)
{
    const int first = a->element < b->element;
    double sum[3] = { 0, 0, 0 };

    add_corners(a, b, sum);
    add_corners(b, a, sum);
    return (bbm_overlap){ first ? a->element : b->element, first ? b->element : a->element, depth,
                          sum[0] / sum[2], sum[1] / sum[2] };
}

/* --------------------------------------------------------------------------------- the check */

static int compare_parts(const void *p, const void *q)
{
    const part *a = p, *b = q;

    return a->low != b->low ? (a->low > b->low ? 1 : -1) : a->p > b->p ? 1 : -1;
}

/* Of n sorted parts the pair that is deepest in each other and deeper than o->depth, if there is
 * one. */
static void find_deepest(int n, const part s[], bbm_overlap *o)
{
    for (int a = 0; a < n; a++)
        for (int b = a + 1; b < n && s[b].low < s[a].high; b++) {
            if (s[a].element == s[b].element)
                continue;
            const double depth = way_out(&s[a], &s[b], way_out(&s[b], &s[a], INFINITY));
            if (depth > o->depth)
                *o = describe(&s[a], &s[b], depth);
        }
}

/* Looks for the two elements of a prepared model that overlap deepest at the start; o->i = -1 if
 * none do. */
bbm_status bbm_find_overlap(const bbm_model *m, bbm_overlap *o)
{
    const size_t v = (size_t)m->vertices;
    const bbm_node **p = calloc(4 * v, sizeof *p);
    part *s = calloc(v, sizeof *s);
    double length = 0;
    int n = 0;

    for (int e = 0; e < m->edges; e++)
        length += m->edge[e].along.length;
    *o = (bbm_overlap){ -1, -1, TOUCH * length / m->edges, 0, 0 };
    const bbm_status status = p && s ? BBM_OK : BBM_NO_MEMORY;
    if (!status) {
        for (int e = 0; e < m->elements; e++)
            n += cut_element(m, e, s + n, p + 4 * m->element[e].first);
        qsort(s, (size_t)n, sizeof *s, compare_parts);
        find_deepest(n, s, o);
    }
    free(p);
    free(s);
    return status;
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
    return bbm_fail(m, p == q ? BBM_OVERLAP : BBM_BLOCKS_OVERLAP, "%g m deep at (%g, %g): block %d "
                    "with element %d, block %d with element %d", o.depth, o.x, o.y, p, o.i, q, o.j);
}

/* ----------------------------------------------------------------------------- blocks in pieces */

/* The root of e in the forest up[], with the path halved on the way. */
int bbm_root_of(int up[], int e)
{
    while (up[e] != e)
        e = up[e] = up[up[e]];
    return e;
}

/* For each element the first one of its piece, the elements that bonds join to it; piece[elements]
 * of the caller. Returns the number of pieces: as many as blocks, if each holds together. */
int bbm_find_pieces(const bbm_model *m, int piece[])
{
    int pieces = m->elements;

    for (int e = 0; e < m->elements; e++)
        piece[e] = e;
    for (int b = 0; b < m->bonds; b++) {
        const int i = bbm_root_of(piece, m->bond[b].i), j = bbm_root_of(piece, m->bond[b].j);
        pieces -= i != j;
        piece[i > j ? i : j] = i > j ? j : i;           /* the root is the first element */
    }
    for (int e = 0; e < m->elements; e++)
        piece[e] = piece[piece[e]];                     /* of an element before e, done already */
    return pieces;
}
