/* overlap.c - blocks that lie in each other: at the start, or because a step let a corner pass.
 *
 * A contact keeps a corner out of an edge that it comes to from outside. Blocks that overlap have
 * no such history: the corner is behind the edge, no spring pushes it out, and the blocks go
 * through each other. Both checks ask how deep a point lies in what a boundary encloses: its
 * distance from the boundary, if that goes round it.
 *
 * At the start, elements of different blocks or of one block overlap if one of these points lies in
 * the other element: a corner; the middle of a part of a side between two sides of the other
 * element, as of bars that cross; a point within, if both elements are the same. The deepest of
 * them is told. Candidates are elements whose boxes meet, see sweep.c.
 *
 * In a step the rules by which contacts are listed and closed keep corners outside. Should a step
 * let one pass all the same - two soft corners that glance off each other and turn - it starts the
 * next step deeper in the block than contacts are and moves in, and no contact of the two blocks is
 * closed or has opened inside. That step is refused. The sweep asks for each corner near an edge.
 */
#include "beyond.h"

/* TOUCH [-]  overlaps up to this, in mean boundary edges of all blocks, are rounding of a model
 *            file
 * ENDS [-]   a side that ends on another one, up to this share of either, cuts it: rounding
 * DEEPER [-] a corner that is this many times as deep as the contacts of its block with another one
 *            is held by none of them; edges that turn in the step change the depths by less */
#define TOUCH 1e-6
#define ENDS 1e-9
#define DEEPER 1.1

typedef struct {                /* where a point lies against a boundary                        */
    double distance2;           /* m^2      the square of its distance                          */
    int    nearest;             /* side                                                         */
    int    winding;             /* of the boundary round the point                              */
} place;

/* Takes one more side of the boundary, from a to b. It counts as winding if it crosses the
 * horizontal line through P on its right: up or down. */
static void take_side(bbm_point a, bbm_point b, int side, bbm_point P, place *at)
{
    const double x = b.x - a.x, y = b.y - a.y, l2 = x * x + y * y;
    const double px = P.x - a.x, py = P.y - a.y, d = px * y - py * x, s = px * x + py * y;
    const double beyond = s < 0 ? s : s > l2 ? s - l2 : 0;
    const double distance2 = (d * d + beyond * beyond) / l2;
    const int up = (py >= 0) - (P.y >= b.y);

    at->winding += up * d < 0 ? up : 0;
    if (distance2 < at->distance2) {
        at->distance2 = distance2;
        at->nearest = side;
    }
}

/* --------------------------------------------------------------------------------- at the start */

/* Corner k of element e at the start. */
static bbm_point corner_of(const bbm_model *m, int e, int k)
{
    const bbm_element *of = &m->element[e];
    const bbm_node *n = &m->node[m->vertex[of->first + (k + of->n) % of->n].node];

    return (bbm_point){ n->x, n->y };
}

/* How deep P lies in element e; 0 outside. */
static double depth_in(const bbm_model *m, int e, bbm_point P)
{
    place at = { .distance2 = INFINITY };

    for (int k = 0; k < m->element[e].n; k++)
        take_side(corner_of(m, e, k), corner_of(m, e, k + 1), k, P, &at);
    return at.winding > 0 ? sqrt(at.distance2) : 0;
}

/* Where the side c d cuts the side p q, as a share of that; -1: nowhere, or both are parallel. */
static double cut_at(bbm_point p, bbm_point q, bbm_point c, bbm_point d)
{
    const double x = q.x - p.x, y = q.y - p.y, u = d.x - c.x, v = d.y - c.y;
    const double cross = x * v - y * u;
    const double s = ((c.x - p.x) * v - (c.y - p.y) * u) / cross;
    const double t = ((c.x - p.x) * y - (c.y - p.y) * x) / cross;

    return s >= -ENDS && s <= 1 + ENDS && t >= -ENDS && t <= 1 + ENDS ? s : -1;
}

/* Takes a point of elements i and j as their overlap if it is deeper than what is known. */
static void note_depth(int i, int j, bbm_point P, double depth, bbm_overlap *o)
{
    if (depth > o->depth)
        *o = (bbm_overlap){ i < j ? i : j, i < j ? j : i, depth, P.x, P.y };
}

/* Side k of element i in element j: its start, and the middles between any two of its ends and the
 * cuts of j's sides. */
static void probe_side(const bbm_model *m, int i, int k, int j, bbm_overlap *o)
{
    const bbm_point p = corner_of(m, i, k), q = corner_of(m, i, k + 1);
    const int n = m->element[j].n;

    note_depth(i, j, p, depth_in(m, j, p), o);
    for (int a = -1; a < n; a++) {
        const double s = a < 0 ? 0 : cut_at(p, q, corner_of(m, j, a), corner_of(m, j, a + 1));
        for (int b = a + 1; b <= n && s >= -ENDS; b++) {
            const double t = b == n ? 1 : cut_at(p, q, corner_of(m, j, b), corner_of(m, j, b + 1));
            const double mid = (s + t) / 2;
            const bbm_point P = { p.x + mid * (q.x - p.x), p.y + mid * (q.y - p.y) };
            if (t >= -ENDS)
                note_depth(i, j, P, depth_in(m, j, P), o);
        }
    }
}

/* The overlap of element i with element j, as far as it is seen from i. The middles of the
 * triangles at its corners, one of which lies in it, show that j is the same. */
static void probe_element(const bbm_model *m, int i, int j, bbm_overlap *o)
{
    for (int k = 0; k < m->element[i].n; k++) {
        const bbm_point a = corner_of(m, i, k - 1), b = corner_of(m, i, k);
        const bbm_point c = corner_of(m, i, k + 1);
        const bbm_point P = { (a.x + b.x + c.x) / 3, (a.y + b.y + c.y) / 3 };
        probe_side(m, i, k, j, o);
        note_depth(i, j, P, fmin(depth_in(m, i, P), depth_in(m, j, P)), o);
    }
}

/* Whether a side of element i has all of i on its left and all of j on its right. */
static int are_apart(const bbm_model *m, int i, int j)
{
    const int n = m->element[i].n, all = n + m->element[j].n;
    int c = 0;

    for (int k = 0; k < n && c < all; k++) {
        const bbm_point a = corner_of(m, i, k), b = corner_of(m, i, k + 1);
        for (c = 0; c < all; c++) {
            const bbm_point P = c < n ? corner_of(m, i, c) : corner_of(m, j, c - n);
            const double left = (b.x - a.x) * (P.y - a.y) - (b.y - a.y) * (P.x - a.x);
            if (c < n ? left < 0 : left > 0)
                break;
        }
    }
    return c == all;
}

/* Looks for the two elements of a prepared model that overlap deepest at the start; o->i = -1 if
 * none do. */
bbm_status bbm_find_overlap(const bbm_model *m, bbm_overlap *o)
{
    bbm_box *b = malloc((size_t)m->elements * sizeof *b);
    double length = 0;

    if (!b)
        return BBM_NO_MEMORY;
    for (int e = 0; e < m->edges; e++)
        length += m->edge[e].along.length;
    *o = (bbm_overlap){ -1, -1, TOUCH * length / m->edges, 0, 0 };
    for (int i = 0; i < m->elements; i++) {
        b[i] = bbm_empty_box(i);
        for (int k = 0; k < m->element[i].n; k++)
            bbm_widen_box(&b[i], corner_of(m, i, k).x, corner_of(m, i, k).y, 0);
    }
    bbm_sort_boxes(m->elements, b);
    for (int i = 0, j = 0; bbm_next_meeting(m->elements, b, &i, &j);) {
        const int e = b[i].of, f = b[j].of;
        if (are_apart(m, e, f) || are_apart(m, f, e))
            continue;
        probe_element(m, e, f, o);
        probe_element(m, f, e, o);
    }
    free(b);
    return BBM_OK;
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
    return bbm_fail(m, p == q ? BBM_OVERLAP : BBM_BLOCKS_OVERLAP, "%g m deep at (%.9g, %.9g): "
                    "block %d with element %d, block %d with element %d", o.depth, o.x, o.y, p,
                    o.i, q, o.j);
}

/* ------------------------------------------------------------------------------------ in a step */

/* How deep a corner lies in the block of an edge, the distance from its boundary; 0 outside. The
 * outer boundary goes round what is inside once, and so does that of a hole, the other way. Where
 * an edge ends the next one starts a little apart, as far as their bonds have opened. The boundary
 * goes from start to start and once more from end to end. What lies inside of one of them alone
 * lies in such a gap, where no contact keeps it out. `over`: the edge over which the corner has
 * come, the nearest that it can enter over, if it is not far, or else the nearest. */
static double depth_in_block(const bbm_model *m, int corner, int edge, double far, int *over)
{
    const bbm_point P = bbm_point_at(m, m->edge[corner].a);
    place starts = { .distance2 = INFINITY }, ends = starts, entered = { far * far, -1, 0 };
    int e = edge;

    do {
        const bbm_edge *E = &m->edge[e];
        take_side(bbm_point_at(m, E->a), bbm_point_at(m, m->edge[E->after].a), e, P, &starts);
        take_side(bbm_point_at(m, m->edge[E->before].b), bbm_point_at(m, E->b), e, P, &ends);
        if (bbm_may_enter(m, corner, e))
            take_side(bbm_point_at(m, E->a), bbm_point_at(m, E->b), e, P, &entered);
        e = E->next;
    } while (e != edge);
    *over = entered.nearest >= 0 ? entered.nearest : starts.nearest;
    return starts.winding > 0 && ends.winding > 0
         ? sqrt(fmin(starts.distance2, ends.distance2)) : 0;
}

/* How deep the deepest of n contacts between the blocks of two edges is that is closed or has
 * opened inside; -1: there is none. */
static double depth_between(const bbm_model *m, const bbm_contact *c, int n, int e, int f)
{
    const int i = m->edge[e].first, j = m->edge[f].first;
    double depth = -1;

    for (; n > 0; n--, c++) {
        const int p = m->edge[c->corner].first, q = m->edge[c->edge].first;
        if ((c->state != BBM_OPEN || c->inside) && ((p == i && q == j) || (p == j && q == i)))
            depth = fmax(depth, fmax(0, -c->d_n));
    }
    return depth;
}

/* How deep a corner lies in the block of an edge behind which it is, deeper than contacts are, and
 * the edge over which it has come, no farther than `far` [m] if it can; else 0, as for two that are
 * held, which have no contacts. */
double bbm_depth_behind(const bbm_model *m, int corner, int edge, double far, int *over)
{
    const bbm_point P = bbm_point_at(m, m->edge[corner].a), a = bbm_point_at(m, m->edge[edge].a);
    const bbm_point b = bbm_point_at(m, m->edge[edge].b);
    const double x = P.x - a.x, y = P.y - a.y, u = b.x - a.x, v = b.y - a.y, l = hypot(u, v);
    const double s = x * u + y * v, allowed = bbm_allowed_depth(m, corner, edge);

    if (m->edge[corner].side != corner || m->edge[corner].joined[0] >= 0
        || m->edge[corner].joined[1] >= 0 || s < 0 || s > l * l || y * u - x * v <= allowed * l
        || (bbm_is_held_all_round(m, &m->element[m->edge[corner].element])
            && bbm_is_held_all_round(m, &m->element[m->edge[edge].element])))
        return 0;
    const double depth = depth_in_block(m, corner, edge, far, over);
    return depth > fmax(allowed, bbm_allowed_depth(m, corner, *over)) ? depth : 0;
}

/* That depth where no contact of the corner and that block accounts for it: the last step let the
 * corner pass. Else 0. */
double bbm_depth_passed(const bbm_model *m, int corner, int edge)
{
    double depth = bbm_depth_behind(m, corner, edge, INFINITY, &(int){ 0 });

    for (int k = m->edge[corner].contact; k < m->contacts && m->contact[k].corner == corner; k++)
        depth = depth_between(m, &m->contact[k], 1, corner, edge) >= 0 ? 0 : depth;
    return depth;
}

/* Refuses a step before which, or a solution by which, a corner has passed the edge; end: the model
 * in which it lies, at the start or at the end of the step. */
static bbm_status refuse(bbm_model *m, const bbm_model *end, int corner, int edge, double depth)
{
    const bbm_vertex *P = bbm_start_of(end, corner);
    const int before = end == m;

    return bbm_fail(m, before ? BBM_BLOCKS_OVERLAP : BBM_STEP_TOO_LONG, "step %d: a corner of "
                    "block %d %s into block %d at (%.9g, %.9g), %.2g m deep; %s may help",
                    m->info.step + 1, m->edge[corner].block, before ? "passed" : "passes",
                    m->edge[edge].block, P->x + m->origin[0], P->y + m->origin[1], depth,
                    bbm_is_static(m) ? "loads in several stages" : "a smaller dt");
}

/* Refuses a step at whose start a corner has passed an edge that the sweep has met. */
bbm_status bbm_check_passed(bbm_model *m)
{
    const int corner = m->beyond->passed[0], edge = m->beyond->passed[1];

    return corner < 0 ? BBM_OK : refuse(m, m, corner, edge, bbm_depth_passed(m, corner, edge));
}

/* Refuses a solution that lets a corner pass: its contact is not closed, nor was it, and it ends
 * deeper in the block of the edge than the contacts of the two blocks. */
bbm_status bbm_check_passing(bbm_model *m, const bbm_model *end)
{
    const bbm_contact *list = m->scratch->contact;
    const int n = m->scratch->contacts;

    for (const bbm_contact *c = list; c < list + n; c++) {
        if (c->state != BBM_OPEN || c->d_n >= 0 || c->trial.was_closed || c->inside)
            continue;
        const double depth = bbm_depth_behind(end, c->corner, c->edge, INFINITY, &(int){ 0 });
        if (depth > DEEPER * fmax(0, depth_between(m, list, n, c->corner, c->edge)))
            return refuse(m, end, c->corner, c->edge, depth);
    }
    return BBM_OK;
}
