/* passed.c - a corner that a step has let pass into another block.
 *
 * The rules by which contacts are listed and closed keep corners outside. Should a step let one
 * pass all the same - two soft corners that glance off each other and turn - nothing would push it
 * out again: it starts the next step deeper in the block than contacts are and moves in, no contact
 * of the two blocks is closed or has opened inside, and they would go through each other. That step
 * is refused. The sweep asks for each corner near an edge.
 */
#include <math.h>

#include "beyond.h"

typedef struct {                /* where a vertex P lies against a boundary                     */
    double distance;            /* m                                                            */
    int    nearest;             /* edge                                                         */
    int    winding;             /* of the boundary round P                                      */
    double area;                /* m^2      twice what it encloses; of a hole < 0               */
} place;

/* Takes one more edge of the boundary. It ends where the next one starts, for bonds may have opened
 * there, and counts as winding if it crosses the horizontal line through P on its right: up or
 * down. */
static void take_edge(const bbm_model *m, int e, const bbm_vertex *P, place *at)
{
    const bbm_vertex *a = &m->vertex[m->edge[e].a], *b = &m->vertex[m->edge[m->edge[e].after].a];
    const double x = b->x - a->x, y = b->y - a->y, l = hypot(x, y);
    const double px = P->x - a->x, py = P->y - a->y, d = px * y - py * x, s = px * x + py * y;
    const double distance = hypot(d, fmax(0, fmax(-s, s - l * l))) / l;
    const int up = (py >= 0) - (P->y >= b->y);

    at->winding += up * d < 0 ? up : 0;
    at->area -= d;
    if (distance < at->distance) {
        at->distance = distance;
        at->nearest = e;
    }
}

/* How deep P lies in the block of an edge, the distance from its boundary, and from which edge, if
 * that is more than `allowed`; else 0. The outer boundary goes round what is inside once, and so
 * does that of a hole, the other way. Outside the one that the edge belongs to, or near it, the
 * others need not be asked. */
static double depth_in_block(const bbm_model *m, const bbm_vertex *P, int edge, double allowed,
                             int *nearest)
{
    place own = { .distance = INFINITY }, all = own;
    int e = edge;

    do {
        take_edge(m, e, P, &own);
        e = m->edge[e].after;
    } while (e != edge);
    if (own.distance <= allowed || (own.area > 0 && own.winding <= 0))
        return 0;
    for (e = 0; e < m->edges; e++)
        if (m->edge[e].block == m->edge[edge].block)
            take_edge(m, e, P, &all);
    *nearest = all.nearest;
    return all.winding > 0 && all.distance > allowed ? all.distance : 0;
}

/* Whether the blocks i and j have a contact that is closed or has opened inside. */
static int are_in_contact(const bbm_model *m, int i, int j)
{
    int found = 0;

    for (int k = 0; k < m->contacts && !found; k++) {
        const bbm_contact *c = &m->contact[k];
        const int p = m->edge[c->corner].block, q = m->edge[c->edge].block;
        found = ((p == i && q == j) || (p == j && q == i))
             && (c->state != BBM_OPEN || c->inside);
    }
    return found;
}

/* Whether the corner moves out of the edge. */
static int moves_out(const bbm_model *m, int corner, int edge)
{
    const bbm_vertex *P = &m->vertex[m->edge[corner].a];
    const bbm_element *i = &m->element[m->edge[corner].element];
    const bbm_element *j = &m->element[m->edge[edge].element];
    const bbm_direction t = m->edge[edge].along;
    double vi[2], vj[2];

    bbm_displacement(i, i->V, P->x, P->y, vi);
    bbm_displacement(j, j->V, P->x, P->y, vj);
    return (vi[0] - vj[0]) * t.y - (vi[1] - vj[1]) * t.x > 0;
}

/* How deep a corner lies in the block of an edge behind which it is, deeper than contacts are,
 * where no contact of the two blocks accounts for it: the last step let it pass. Else 0, and where
 * it is on its way out. */
double bbm_depth_passed(const bbm_model *m, int corner, int edge)
{
    const bbm_vertex *P = &m->vertex[m->edge[corner].a], *a = &m->vertex[m->edge[edge].a];
    const bbm_direction t = m->edge[edge].along;
    const double x = P->x - a->x, y = P->y - a->y, s = x * t.x + y * t.y;
    const int own = m->edge[corner].block, other = m->edge[edge].block;

    if (own == other || m->edge[corner].side != corner)
        return 0;
    if (x * t.y - y * t.x >= 0 || s < 0 || s > t.length)
        return 0;
    int nearest = edge;
    const double allowed = bbm_allowed_depth(m, corner, edge);
    const double depth = depth_in_block(m, P, edge, allowed, &nearest);
    return depth == 0 || moves_out(m, corner, nearest) || are_in_contact(m, own, other) ? 0 : depth;
}

/* Refuses a step that starts so. */
bbm_status bbm_check_passed(bbm_model *m)
{
    const int corner = m->beyond->passed[0], edge = m->beyond->passed[1];

    if (corner < 0)
        return BBM_OK;
    const bbm_vertex *P = &m->vertex[m->edge[corner].a];
    return bbm_fail(m, BBM_BLOCKS_OVERLAP, "step %d: a corner of block %d passed into block %d at "
                    "(%g, %g), %.2g m deep; a smaller dt helps", m->info.step + 1,
                    m->edge[corner].block, m->edge[edge].block, P->x, P->y,
                    bbm_depth_passed(m, corner, edge));
}
