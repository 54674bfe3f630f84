/* mesh.c - meshes that cannot be meant: elements that meet themselves, blocks in pieces.
 *
 * Bonds join elements that share a side, both its nodes. A mesh that is meant to be one block can
 * fall into pieces without a sign of it: two parts with nodes of their own at the same places, a
 * node in the middle of a neighbour's side (a hanging node), two elements that share a corner
 * alone. Since elements of one block do not touch each other either, the pieces then move through
 * each other. It may be meant - several stones under one name - so it is no error; but whoever
 * runs a model should hear of it.
 */
#include "beyond.h"

/* ---------------------------------------------------------------- polygons that meet themselves */

/* Twice the signed area of the triangle a b c: positive if it runs counter-clockwise. */
static double orient(const bbm_node *a, const bbm_node *b, const bbm_node *c)
{
    return (b->x - a->x) * (c->y - a->y) - (c->x - a->x) * (b->y - a->y);
}

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
    for (int b = 0; b < m->bonds; b++)
        if (!bbm_is_broken(m, b)) {
            const int i = bbm_root_of(piece, m->bond[b].i), j = bbm_root_of(piece, m->bond[b].j);
            pieces -= i != j;
            piece[i > j ? i : j] = i > j ? j : i;       /* the root is the first element */
        }
    for (int e = 0; e < m->elements; e++)
        piece[e] = piece[piece[e]];                     /* of an element before e, done already */
    return pieces;
}
