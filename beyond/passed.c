/* passed.c - a corner that a step has let pass into another block.
 *
 * The rules by which contacts are listed and closed keep corners outside. Should a step let one
 * pass all the same - two soft corners that glance off each other and turn - nothing would push it
 * out again: it starts the next step deeper in the block than contacts are, no contact of the two
 * blocks is closed or has opened inside, and the blocks would go through each other. That step is
 * refused. The sweep asks for each corner near an edge.
 */
#include <math.h>

#include "beyond.h"

/* Takes an edge for the distance of P from a boundary, and for the number of edges that cross the
 * horizontal line through P on its right, up less down. An edge ends where the next one starts, for
 * bonds may have opened there. Returns twice its part of the area that the boundary encloses. */
static double count_edge(const bbm_model *m, int e, const bbm_vertex *P, double *distance,
                         int *winding)
{
    const bbm_vertex *a = &m->vertex[m->edge[e].a], *b = &m->vertex[m->edge[m->edge[e].after].a];
    const double x = b->x - a->x, y = b->y - a->y, l = hypot(x, y);
    const double px = P->x - a->x, py = P->y - a->y, d = px * y - py * x, s = px * x + py * y;
    const int up = (py >= 0) - (P->y >= b->y);

    *distance = fmin(*distance, hypot(d, fmax(0, fmax(-s, s - l * l))) / l);
    *winding += up * d < 0 ? up : 0;
    return -d;
}

/* How deep P lies in the block of an edge, the distance from its boundary; 0 outside. The outer
 * boundary, which encloses an area > 0, goes round what is inside once, and so does that of a hole,
 * the other way. Outside the one that the edge belongs to, the others need not be asked. */
static double depth_in_block(const bbm_model *m, const bbm_vertex *P, int edge)
{
    double depth = INFINITY, area = 0;
    int winding = 0, e = edge;

    do {
        area += count_edge(m, e, P, &depth, &winding);
        e = m->edge[e].after;
    } while (e != edge);
    if (area > 0 && winding <= 0)
        return 0;
    depth = INFINITY;
    winding = 0;
    for (e = 0; e < m->edges; e++)
        if (m->edge[e].block == m->edge[edge].block)
            (void)count_edge(m, e, P, &depth, &winding);
    return winding > 0 ? depth : 0;
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

/* How deep a corner lies in the block of an edge behind which it is, deeper than contacts are,
 * where no contact of the two blocks accounts for it: the last step let it pass. Else 0. */
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
    const double depth = depth_in_block(m, P, edge);
    const int passed = depth > bbm_allowed_depth(m, corner, edge) && !are_in_contact(m, own, other);
    return passed ? depth : 0;
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
