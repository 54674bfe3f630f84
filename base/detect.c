/* detect.c - detection: which corner may touch which edge, what a contact keeps from the last step,
 * and where a corner comes in. It knows positions, edges and closed contacts, and hands on their
 * forces.
 *
 * Each corner is compared with each boundary edge, or a hook knows which are near it. `corner` c is
 * the vertex that starts boundary edge c, so that (corner, edge) are two indices of edges: the
 * identity of a contact. A corner may touch an edge if neither of its two sides points into it, and
 * if it does not lie behind it from the start: blocks do not overlap then, but for the depth of
 * closed contacts.
 *
 * Where two corners P and Q meet, several of these pairs describe one contact. P can come in along
 * two entrance lines: the two edges of Q (left), or one edge of each block (right).
 *
 *          \  P  /              |   A
 *           \   /               P______
 *            \ /                 Q_____
 *      _______Q                  |
 *             |                  |   B
 *        B    |                  |
 *
 * The blocks overlap when P has crossed both lines. The spring goes on the line that is crossed
 * last, where P comes in. A line is crossed when P is deeper behind it than at the surface, which
 * has the depth of contacts and the rounding of the corners. So whatever slides over a seam or a
 * low ledge stays on top: there it is at the surface of the next block. If both are crossed at the
 * same time, the one that was closed counts, or else the one that goes before the other.
 *
 * Two corners of A and B that lie flush are none for a third block: the boundary of the one goes on
 * as that of the other, and the faces between them are covered.
 *
 * Two lines that coincide are one contact, of P on Q's edge or of Q on P's.
 */
#include "base.h"

/* ------------------------------------------------------------------------------------ the data
 *
 * Tolerances; none depends on the size of the domain.
 * STRAIGHT [rad]  sides that differ less in direction at the start are one straight side, and
 *                 sides that differ less in length, relatively, are as long: rounding of a file
 * PARALLEL [rad]  lines that differ less coincide, and a side that points into an edge by less
 *                 lies on it: penetration and elastic bending turn sides by this much
 * BENT     [rad]  the same at a point inside a straight side, of one block or of two that slide
 * TURNS    [rad]  a side that turns by more in a step turns with its element
 * TOUCH    [-]    d_n below this, in mean edges of the two blocks, is closed at the start, and a
 *                 projection closer to the end of an edge is at the end: rounding of a model file,
 *                 elastic strain
 * TIE      [-]    fractions of a step that differ less are the same moment: rounding
 * ROUND    [-]    par.round where none is given, in the shorter side of a corner */
#define STRAIGHT 1e-4
#define PARALLEL 1e-2
#define BENT 0.1
#define TURNS 0.4
#define TOUCH 1e-6
#define TIE 1e-9
#define ROUND 2e-3

static const double STILL[2];   /* turns of the sides of a corner: none */

typedef struct bbm_pair { int corner, edge, dropped; } pair;    /* what may touch               */

typedef struct bbm_reach {      /* of a block, with the index of its first element              */
    double depth;               /* m        |d_n| of its closed contacts, before the step       */
    double depth_now;           /* m        the same of the solution, or 0                      */
    double travel;              /* m        how far its vertices may move in this step          */
    double came;                /* m        the same of the step before                         */
    double girth;               /* m        its boundary at the start                           */
    int    edges;               /* of it                                                        */
    double turn;                /* rad      of an element: how far it may turn in this step     */
} reach;

/* ------------------------------------------------------------------- the boundary of the blocks */

static double cross(bbm_direction p, bbm_direction q) { return p.x * q.y - p.y * q.x; }

static reach *reach_of(const bbm_model *m, int e)
{
    return &m->scratch->reach[m->edge[e].first];
}

/* A quarter of the boundary of the smaller of two blocks in contact. */
double bbm_size_at(const bbm_model *m, const bbm_contact *c)
{
    return fmin(reach_of(m, c->corner)->girth, reach_of(m, c->edge)->girth) / 4;
}

/* Distances up to this are rounding: TOUCH times the mean boundary edge of the block of edge e. */
static double rounding_of(const bbm_model *m, int e)
{
    return reach_of(m, e)->girth * (TOUCH / reach_of(m, e)->edges);
}

/* A vertex inside a straight side is no corner. */
static int is_corner(const bbm_model *m, int c) { return m->edge[c].side == c; }

/* The edge that arrives at a corner (0) or leaves it (1). */
static int own_side(const bbm_model *m, int c, int which) { return which ? c : m->edge[c].before; }

/* The corner that starts an edge (0) or ends it (1). */
static int end_of(const bbm_model *m, int e, int end) { return end ? m->edge[e].after : e; }

/* Directions and lengths of the present edges. */
static void find_directions(bbm_model *m)
{
    for (int e = 0; e < m->edges; e++) {
        const bbm_point a = bbm_point_at(m, m->edge[e].a), b = bbm_point_at(m, m->edge[e].b);
        const double x = b.x - a.x, y = b.y - a.y, l = hypot(x, y);
        m->edge[e].along = (bbm_direction){ x / l, y / l, l };
    }
}

/* Direction and length of an edge at the start. */
static bbm_direction starting(const bbm_model *m, int e)
{
    const bbm_node *a = &m->node[bbm_start_of(m, e)->node], *b = &m->node[bbm_end_of(m, e)->node];
    const double l = hypot(b->x - a->x, b->y - a->y);

    return (bbm_direction){ (b->x - a->x) / l, (b->y - a->y) / l, l };
}

/* Whether edge e goes straight on from the one before it. */
static int goes_on(const bbm_model *m, int e)
{
    const bbm_direction p = starting(m, m->edge[e].before), q = starting(m, e);

    return hypot(q.x - p.x, q.y - p.y) < STRAIGHT;
}

/* The straight sides that the edges belong to. */
static void find_straight_sides(bbm_model *m)
{
    for (int first = 0; first < m->edges; first++) {
        int e = first, parts = 0;
        if (goes_on(m, first))
            continue;
        m->edge[first].span = 0;
        do {
            m->edge[e].side = first;
            m->edge[first].span += starting(m, e).length;
            e = m->edge[e].after;
            parts++;
        } while (goes_on(m, e));
        m->edge[first].spacing = m->edge[first].span / parts;
    }
}

/* Finds the first element of each block, and links its edges to a ring. */
static void number_blocks(bbm_model *m)
{
    pair *of = m->scratch->pair;                            /* block and edge                   */

    for (int e = 0; e < m->edges; e++)
        of[e] = (pair){ m->edge[e].block, e, 0 };
    qsort(of, (size_t)m->edges, sizeof *of, bbm_compare_pairs);
    for (int k = 0, first = 0; k < m->edges; k++) {
        first = of[k].corner == of[first].corner ? first : k;
        m->edge[of[k].edge].first = m->edge[of[first].edge].element;
        const int more = k + 1 < m->edges && of[k + 1].corner == of[k].corner;
        m->edge[of[k].edge].next = of[more ? k + 1 : first].edge;
    }
}

void bbm_detect_free(bbm_contact_scratch *w)
{
    if (!w)
        return;
    free(w->reach);
    free(w->pair);
    free(w->contact);
    free(w);
}

bbm_status bbm_detect_new(bbm_model *m)
{
    bbm_contact_scratch *w = m->scratch = calloc(1, sizeof *w);

    if (!w)
        return BBM_NO_MEMORY;
    w->reach = calloc((size_t)m->elements, sizeof *w->reach);
    w->pair = calloc((size_t)m->edges, sizeof *w->pair);
    w->contact = malloc(sizeof *w->contact);            /* a list without contacts is not NULL  */
    if (!w->reach || !w->pair || !w->contact)
        return BBM_NO_MEMORY;
    number_blocks(m);
    for (int e = 0; e < m->edges; e++) {
        m->edge[e].after = bbm_edge_at(m, m->edge[e].b);
        m->edge[m->edge[e].after].before = e;
        reach_of(m, e)->depth = m->info.penetration;    /* in a run contacts may be as deep */
        reach_of(m, e)->girth += starting(m, e).length;
        reach_of(m, e)->edges++;
    }
    find_directions(m);
    find_straight_sides(m);
    return BBM_OK;
}

/* ----------------------------------------------------------- detection: how far blocks may move */

/* Takes for D what the velocities foretell of the step; in statics 0. Gravity is not foretold: what
 * stands on others does not fall. */
void bbm_foresee_step(bbm_model *m)
{
    const double h = bbm_is_static(m) ? 0 : m->h;

    for (int i = 0; i < m->elements; i++) {
        for (int a = 0; a < 6; a++)
            m->D[6 * i + a] = m->element[i].V[a] * h;
        m->scratch->reach[i].travel = 0;
    }
    bbm_note_depths(m, m->contact, m->contacts);        /* not those of a try that failed       */
    m->detections = 0;
}

typedef struct { double x, y, u, v, far; } moving;      /* m; far: the length of (u, v)         */

/* The point of the boundary at vertex k, and how it moves by D. */
static moving move_point(const bbm_model *m, int k)
{
    const bbm_vertex *P = &m->vertex[k], *Q = &m->vertex[bbm_partner_of(m, k)];
    const bbm_point at = bbm_point_at(m, k);
    double u[2], w[2];

    bbm_move(bbm_motion_of(m), &m->element[P->element], &m->D[6 * P->element], P->x, P->y, u);
    bbm_move(bbm_motion_of(m), &m->element[Q->element], &m->D[6 * Q->element], Q->x, Q->y, w);
    const double x = (u[0] + w[0]) / 2, y = (u[1] + w[1]) / 2;
    return (moving){ at.x, at.y, x, y, hypot(x, y) };
}

/* How far two corners move past each other along t by D. */
static double slip_between(const bbm_model *m, int P, int Q, bbm_direction t)
{
    const moving p = move_point(m, m->edge[P].a), q = move_point(m, m->edge[Q].a);

    return fabs((p.u - q.u) * t.x + (p.v - q.v) * t.y);
}

/* By how much an edge turns by D. */
static double turn_of(const bbm_model *m, int e)
{
    const bbm_direction t = m->edge[e].along;
    const moving a = move_point(m, m->edge[e].a), b = move_point(m, m->edge[e].b);
    const double x = b.u - a.u, y = b.v - a.v;

    return atan2(t.x * y - t.y * x, t.length + t.x * x + t.y * y);
}

/* Whether the solution moves further than the detection has foreseen. */
int bbm_moved_too_far(const bbm_model *m)
{
    for (int e = 0; e < m->edges; e++)
        if (move_point(m, m->edge[e].a).far > reach_of(m, e)->travel
            || fabs(turn_of(m, e)) > m->scratch->reach[m->edge[e].element].turn)
            return 1;
    return 0;
}

/* How far the blocks may move: a tenth more than by the D in hand, and the depth of their contacts,
 * and no less than what this step has foreseen before. They may turn twice as far as by D. Returns
 * the longest way. */
static double foresee(bbm_model *m)
{
    double most = 0;

    for (int i = 0; i < m->elements; i++)
        m->scratch->reach[i].depth_now = m->scratch->reach[i].turn = 0;
    for (int e = 0; e < m->edges; e++) {
        reach *b = reach_of(m, e), *own = &m->scratch->reach[m->edge[e].element];
        own->turn = fmax(own->turn, 2 * fabs(turn_of(m, e)) + PARALLEL / 2);
        const double way = 1.1 * move_point(m, m->edge[e].a).far;
        b->travel = fmax(b->travel, way + b->depth + rounding_of(m, e) / 2);
        most = fmax(most, b->travel);
    }
    return most;
}

/* Distances of a corner and an edge up to this are rounding. */
static double touch_between(const bbm_model *m, int c, int e)
{
    return (rounding_of(m, c) + rounding_of(m, e)) / 2;
}

/* The rounding of a corner: par.round, but at most a quarter of its shorter side. A grid point
 * inside a straight side has none. */
double bbm_rounding(const bbm_model *m, int c)
{
    const double before = m->edge[m->edge[m->edge[c].before].side].span;
    const double shorter = fmin(before, m->edge[m->edge[c].side].span);

    return !is_corner(m, c) ? 0
         : m->par.round < 0 ? ROUND * shorter : fmin(m->par.round, shorter / 4);
}

/* Twice as deep as closed contacts at the sides of two corners are. */
static double contact_depth(const bbm_model *m, int P, int Q)
{
    const int of[4] = { P, m->edge[P].before, Q, m->edge[Q].before };
    double deep = 0;

    for (int k = 0; k < 4; k++)
        deep = fmax(deep, m->edge[m->edge[of[k]].side].deep);
    return 2 * deep + touch_between(m, P, Q);
}

typedef struct {                /* of P1 on an edge, m                                          */
    double d, s, beyond;        /* distance; way along the edge from P3; how far beyond an end  */
} projection;

static projection project(const bbm_model *m, int corner, int e)
{
    const bbm_direction t = m->edge[e].along;
    const bbm_point P = bbm_point_at(m, m->edge[corner].a), a = bbm_point_at(m, m->edge[e].a);
    const double x = P.x - a.x, y = P.y - a.y, s = x * t.x + y * t.y;

    return (projection){ x * t.y - y * t.x, s, fmax(-s, s - t.length) };
}

double bbm_way_along(const bbm_model *m, int corner, int edge)
{
    return project(m, corner, edge).s;
}

/* The end of an edge that is nearer to a corner: the edge that starts there. */
static int end_near(const bbm_model *m, int corner, int e)
{
    return end_of(m, e, 2 * project(m, corner, e).s >= m->edge[e].along.length);
}

/* By how much a corner P and the end Q of an edge may overlap and pass each other all the same: the
 * smaller of their roundings. A lower ledge is no obstacle. */
static double rounding_between(const bbm_model *m, int P, int e)
{
    return fmin(bbm_rounding(m, P), bbm_rounding(m, end_near(m, P, e)));
}

/* How deep a corner may lie behind an edge near its end and still be at the surface: by the
 * rounding and the depth of contacts. This holds where it may pass the end in this step, or may
 * have in the step before. */
static double surface_depth(const bbm_model *m, int c, int e)
{
    const double deep = contact_depth(m, c, end_near(m, c, e)) + rounding_between(m, c, e);
    const reach *i = reach_of(m, c), *j = reach_of(m, e);
    const double way = fmax(i->travel, i->came) + fmax(j->travel, j->came);

    return -project(m, c, e).beyond <= deep + way ? deep : 0;
}

/* Whether fixed points hold every corner of an element. */
int bbm_is_held_all_round(const bbm_model *m, const bbm_element *e)
{
    int held = 0;

    for (int v = e->first; v < e->first + e->n; v++)
        held += m->node[m->vertex[v].node].held == BBM_XY;
    return held == e->n;
}

/* The same of the element of an edge. */
static int is_held(const bbm_model *m, int e)
{
    return bbm_is_held_all_round(m, &m->element[m->edge[e].element]);
}

/* The lesser depth of two blocks, before the step or now. What is held is as deep as what it
 * touches, which may come from another held block. */
static double common_depth(const bbm_model *m, int c, int e, int now)
{
    const reach *i = reach_of(m, c), *j = reach_of(m, e);
    const double p = fmax(i->depth, now ? i->depth_now : 0);
    const double q = fmax(j->depth, now ? j->depth_now : 0);

    return is_held(m, c) ? q : is_held(m, e) ? p : fmin(p, q);
}

/* How deep a vertex that comes to an edge may lie behind it at the start of a step: as deep as
 * closed contacts of the two blocks do. Where points move by T of the start of the step, a corner
 * may also have ended the last step inside, by as much as it moved. */
static double start_depth(const bbm_model *m, int c, int e)
{
    return 2 * common_depth(m, c, e, 0) + touch_between(m, c, e)
         + (bbm_motion_of(m) ? 0 : reach_of(m, c)->travel + reach_of(m, e)->travel);
}

/* The same, or at the surface. Deeper no corner comes in: it would from behind the edge. */
double bbm_allowed_depth(const bbm_model *m, int c, int e)
{
    return fmax(start_depth(m, c, e), surface_depth(m, c, e));
}

/* ---------------------------------------------------------------- detection: who may touch whom */

/* Whether two edges are parallel, and run one against the other (-1), the same way (1), or either
 * (0). */
static int are_parallel(const bbm_model *m, int e, int f, int way)
{
    const bbm_direction p = m->edge[e].along, q = m->edge[f].along;

    return fabs(cross(p, q)) <= PARALLEL && way * (p.x * q.x + p.y * q.y) >= 0;
}

/* Whether a side of the corner lies along the edge and reaches inward from that end of it. */
static int lies_over(const bbm_model *m, int corner, int e, int end)
{
    return are_parallel(m, e, own_side(m, corner, end), -1);
}

/* The same from one end or the other. */
static int lies_along(const bbm_model *m, int corner, int e)
{
    return lies_over(m, corner, e, 0) || lies_over(m, corner, e, 1);
}

/* Whether the start of an edge lies inside one straight side of two held blocks. */
static int is_inner(const bbm_model *m, int c)
{
    return m->edge[c].held[0] >= 0 || m->edge[c].held[1] >= 0;
}

/* The edge that ends at a corner c (0) or starts there (1), as another corner Q meets it: its own,
 * or the one that goes on from it in a block that lies flush and covers its own. Not where a side
 * of Q lies along the other side of c: there Q passes c, or does not, by their rounding. Nor where
 * one lies along the side that would go on: the block of Q then covers that side. But what is held
 * is one side whatever lies on it. */
static int side_at(const bbm_model *m, int c, int which, int Q)
{
    const int joined = m->edge[c].joined[which];

    if (joined < 0 || m->edge[joined].first == m->edge[Q].first)
        return own_side(m, c, which);
    return !is_inner(m, c) && (lies_along(m, Q, own_side(m, c, !which)) || lies_along(m, Q, joined))
         ? own_side(m, c, which) : joined;
}

/* Whether two edges are of one straight side, also where it goes on in a block that is held. */
static int are_in_line(const bbm_model *m, int e, int f)
{
    return m->edge[e].side == m->edge[f].side || m->edge[e].held[0] == f || m->edge[f].held[0] == e;
}

/* Whether the edge is covered where the corner is: another block lies flush with its end there. */
static int is_covered(const bbm_model *m, int corner, int e)
{
    const int Q = end_near(m, corner, e), end = Q != e, cover = side_at(m, Q, !end, corner);
    const int side = end ? m->edge[cover].after : m->edge[cover].before;

    return cover != e && -2 * project(m, corner, e).beyond < m->edge[side].along.length;
}

static bbm_direction turned(bbm_direction t, double r)
{
    return (bbm_direction){ t.x * cos(r) - t.y * sin(r), t.y * cos(r) + t.x * sin(r), t.length };
}

/* Whether a corner can enter over an edge. Neither of its two sides points into the edge by more
 * than an angle, after they have turned by r[0] and r[1] against it, and the block is convex
 * there. Either end of a side may be as deep as closed contacts are. A grid point inside a straight
 * side may come to lie in a hollow, where that side bends, and so may a corner in a side of two
 * blocks that slide past each other. */
static int can_enter(const bbm_model *m, int corner, int e, const double r[2], double angle)
{
    const int Q = end_near(m, corner, e);
    const bbm_direction p = m->edge[side_at(m, corner, 0, Q)].along, t = m->edge[e].along;
    const bbm_direction q = m->edge[side_at(m, corner, 1, Q)].along;
    const double dip = 2 * common_depth(m, corner, e, 1);
    const double arrives = cross(t, turned(p, r[0])), leaves = cross(turned(q, r[1]), t);

    if (!is_corner(m, corner) || m->edge[corner].slides)
        return fmin(arrives, leaves) >= -BENT;
    return leaves >= -angle - dip / fmin(q.length, t.length)
        && arrives >= -angle - dip / fmin(p.length, t.length) && cross(p, q) > -PARALLEL;
}

/* The same for a corner as it lies now. */
int bbm_may_enter(const bbm_model *m, int corner, int e)
{
    return can_enter(m, corner, e, STILL, PARALLEL);
}

/* Whether edge e goes before f where either could be the edge of a contact. The first of these
 * that tells them apart decides: the longer side, the larger block, the flatter edge, the one that
 * faces up, the one that faces right. Down is where gravity points, or -y without gravity. */
static int goes_before(const bbm_model *m, int e, int f)
{
    const double *g = m->par.gravity, fall = hypot(g[0], g[1]);
    const bbm_direction down = { fall > 0 ? g[0] / fall : 0, fall > 0 ? g[1] / fall : -1, 0 };
    const bbm_direction p = m->edge[e].along, q = m->edge[f].along;
    const double up[2] = { cross(p, down), cross(q, down) };        /* of the outward normals */
    const double more[5] = {
        log(m->edge[m->edge[e].side].span / m->edge[m->edge[f].side].span) / STRAIGHT,
        log(reach_of(m, e)->girth / reach_of(m, f)->girth) / STRAIGHT,
        (fabs(up[0]) - fabs(up[1])) / PARALLEL,
        (up[0] - up[1]) / PARALLEL,
        (down.x * (q.x - p.x) + down.y * (q.y - p.y)) / PARALLEL,
    };

    for (int a = 0; a < 5; a++)
        if (fabs(more[a]) > 1)
            return more[a] > 0;
    return e < f;
}

/* Whether the grid points inside the straight side of c touch that of e, too (`faces`), where the
 * two face each other by more than 120 degrees. Those of the shorter side do: then no point comes
 * or goes while it slides on the longer one. But on a side that is held those of the other one do,
 * or they would sag. Of equal sides, and in statics, where nothing slides far, those of the finer
 * side do: a coarse one would not feel it between its points. At a tie those of c do if e goes
 * before it. Deviation: with `faces` = 0 corners alone touch, and a block of many elements sags
 * between them. */
int bbm_carries(const bbm_model *m, int c, int e)
{
    const bbm_edge *mine = &m->edge[m->edge[c].side], *other = &m->edge[m->edge[e].side];
    const bbm_direction p = m->edge[c].along, q = m->edge[e].along;

    if (!m->par.faces || mine->first == other->first || hypot(p.x + q.x, p.y + q.y) > 1)
        return 0;
    const double ratio = mine->spacing / other->spacing;
    const int alike = fabs(mine->span - other->span) <= STRAIGHT * other->span;
    if (is_held(m, c) != is_held(m, e))
        return is_held(m, e);
    return (alike || isinf(m->par.dt)) && fabs(ratio - 1) > STRAIGHT ? ratio < 1
         : goes_before(m, e, c);
}

/* The contact of the last step, closed or open inside, between `corner` and the edge, or else
 * another edge of its straight side, or NULL. */
static const bbm_contact *find_closed(const bbm_model *m, int corner, int edge)
{
    const bbm_contact *found = NULL;

    for (int k = m->edge[corner].contact; k < m->contacts && m->contact[k].corner == corner; k++) {
        const bbm_contact *c = &m->contact[k];
        if (c->state == BBM_OPEN && !c->inside)
            continue;
        if (c->edge == edge)
            return c;
        if (are_in_line(m, c->edge, edge))
            found = c;
    }
    return found;
}

/* Whether the corner may come to the edge in this step, and not from behind it. One that was closed
 * is not deeper than contacts are, and stays near. One that was inside does so as long as it is no
 * deeper than its rounding, also far from the end that it came past, or at any depth if a hook has
 * found it there. */
static int is_near(const bbm_model *m, int corner, int e)
{
    const double approach = reach_of(m, corner)->travel + reach_of(m, e)->travel;
    const bbm_contact *c = find_closed(m, corner, e);
    const double deep = c && c->hit == 2 ? INFINITY : bbm_allowed_depth(m, corner, e);
    const projection f = project(m, corner, e);

    if (m->edge[e].first == m->edge[corner].first
        || (!is_corner(m, corner) && !bbm_carries(m, corner, e))
        || fmax(f.d, f.beyond) > approach + start_depth(m, corner, e))
        return 0;
    return -f.d <= approach + fmax(deep, bbm_rounding(m, corner))
        && (c || f.beyond > touch_between(m, corner, e) || f.d >= -deep);
}

/* Whether the pair may not touch. What was closed may, but two elements that are held all round
 * never do: their contacts would carry rounding alone. A corner that is still outside may turn
 * before it touches, as when a side falls flat on an edge. */
static int is_hidden(const bbm_model *m, pair p)
{
    const reach *of = m->scratch->reach;
    const int sides[2] = { m->edge[m->edge[p.corner].before].element, m->edge[p.corner].element };
    const double turns = fmax(of[sides[0]].turn, of[sides[1]].turn)
                       + of[m->edge[p.edge].element].turn;
    const double angle = project(m, p.corner, p.edge).d > 0 ? turns : PARALLEL;

    return (is_held(m, p.corner) && is_held(m, p.edge))
        || (!find_closed(m, p.corner, p.edge)
            && (is_inner(m, p.corner) || is_covered(m, p.corner, p.edge)
                || !can_enter(m, p.corner, p.edge, STILL, angle)));
}

/* Adds a corner and an edge to the pairs, if they are near. */
bbm_status bbm_add_pair(bbm_model *m, int corner, int edge)
{
    bbm_contact_scratch *w = m->scratch;

    m->info.candidates++;
    if (!is_near(m, corner, edge))
        return BBM_OK;
    const pair found = { corner, edge, 0 };
    return bbm_append(m, (void **)&w->pair, &w->pairs, sizeof found, &found, NULL);
}

/* All pairs that may touch. The hook gets a search distance. It looks at the edges that are as
 * near to a corner along x and y, or by their rounding farther. Two blocks approach each other by
 * two ways, and a vertex lies inside by its depth, which is at most the four ways of start_depth:
 * together six times the longest way. As far across the edge as along it that is sqrt(2) times as
 * much, nine at most. */
static bbm_status find_pairs(bbm_model *m)
{
    const double search = 9 * foresee(m);

    m->scratch->pairs = m->info.candidates = 0;
    bbm_status status = m->hook->find_pairs ? m->hook->find_pairs(m, search) : BBM_OK;
    for (int c = 0; c < m->edges && !m->hook->find_pairs; c++)
        for (int e = 0; e < m->edges && !status; e++)
            status = bbm_add_pair(m, c, e);
    qsort(m->scratch->pair, (size_t)m->scratch->pairs, sizeof(pair), bbm_compare_pairs);
    return status;
}

/* ---------------------------------------------------------------- detection: where corners meet */

/* The index of a pair, or -1. */
static int find_pair(const bbm_model *m, pair p)
{
    const bbm_contact_scratch *w = m->scratch;
    const pair *found = bsearch(&p, w->pair, (size_t)w->pairs, sizeof p, bbm_compare_pairs);

    return found ? (int)(found - w->pair) : -1;
}

/* What else there can be where the corner P of a pair meets an end Q of its edge: P on the next
 * edge; Q on that edge of P that lies on this one when the blocks are flush; Q on the other edge
 * of P. */
typedef enum { NEXT, FLUSH, OTHER } meeting;

static pair meet(const bbm_model *m, pair p, int end, meeting kind)
{
    const int Q = end_of(m, p.edge, end);

    return kind == NEXT ? (pair){ p.corner, side_at(m, Q, end, p.corner), 0 }
                        : (pair){ Q, own_side(m, p.corner, (kind == FLUSH) == end), 0 };
}

/* Whether the pair p gives way to the pair that it meets, where both are one contact. There are
 * three such places.
 * On one straight side (NEXT): p gives way if P lies before the end of the other edge. At the seam
 * of two blocks it does if a side of P reaches over the other edge alone, or if that goes before.
 * At one place, P at Q with both edges in line: the pair that was closed stays, or else the one
 * whose edge goes before the other.
 * Side by side along one line: the pair stays whose projection is on its edge. Both stay if neither
 * was closed and the corners may pass each other in the step. A grid point inside a straight side
 * that lies within the rounding of a corner is that corner, on either side of it. */
static int gives_way(const bbm_model *m, pair p, int end, meeting kind)
{
    const pair q = meet(m, p, end, kind);
    const int P = p.corner, Q = end_of(m, p.edge, end);

    if (!(kind == NEXT ? are_in_line(m, p.edge, q.edge) : are_parallel(m, p.edge, q.edge, 0))
        || find_pair(m, q) < 0)
        return 0;
    const projection f = project(m, P, p.edge), g = project(m, q.corner, q.edge);
    const bbm_direction t = m->edge[p.edge].along, u = m->edge[q.edge].along;
    const int here = find_closed(m, P, p.edge) != NULL;
    const int there = find_closed(m, q.corner, q.edge) != NULL;
    const double touch = touch_between(m, P, p.edge), at = end ? t.length : 0;
    const double most = fmax(fabs(f.s - at), fmax(fabs(f.beyond), fabs(g.beyond)));
    if (kind == NEXT && most > touch)
        return end ? f.s >= t.length : g.s < u.length;
    const int beside = lies_over(m, P, q.edge, !end) - lies_over(m, P, p.edge, end);
    if (kind == NEXT)
        return beside != 0 ? beside > 0 : !goes_before(m, p.edge, q.edge);
    if (is_corner(m, P) != is_corner(m, Q) && most <= fmax(bbm_rounding(m, P), bbm_rounding(m, Q)))
        return is_corner(m, Q);
    if (most > touch)
        return kind == FLUSH && is_corner(m, P) && is_corner(m, Q) && f.beyond > g.beyond
            && (here || there || most > slip_between(m, P, Q, t));
    return here != there ? there : !goes_before(m, p.edge, q.edge);
}

/* Whether a side of Q goes straight on in one of P, and both blocks are held all round and move
 * alike: for others that is one side, and P and Q are no corners. */
static int are_one_side(const bbm_model *m, int P, int Q, int end)
{
    const bbm_direction in = m->edge[m->edge[end ? P : Q].before].along;
    const bbm_direction out = m->edge[end ? Q : P].along, across = { in.y, -in.x, 0 };
    const double parts = fmax(slip_between(m, P, Q, in), slip_between(m, P, Q, across));

    return is_held(m, P) && is_held(m, Q) && parts <= touch_between(m, P, Q)
        && hypot(out.x - in.x, out.y - in.y) < STRAIGHT;
}

/* Finds where the corners of two blocks lie flush, with a side of each on one of the other: there
 * the boundary of one goes on as that of the other. */
static void join_flush_corners(bbm_model *m)
{
    for (int e = 0; e < m->edges; e++) {
        m->edge[e].joined[0] = m->edge[e].joined[1] = -1;
        m->edge[e].held[0] = m->edge[e].held[1] = -1;
        m->edge[e].meets[0] = m->edge[e].meets[1] = m->edge[e].slides = 0;
    }
    for (int k = 0; k < 2 * m->scratch->pairs; k++) {
        const pair p = m->scratch->pair[k / 2];
        const int P = p.corner, end = k % 2, Q = end_of(m, p.edge, end);
        const bbm_direction t = m->edge[p.edge].along;
        const projection f = project(m, P, p.edge);
        const double apart = hypot(f.d, f.s - end * t.length);
        if (!lies_over(m, P, p.edge, end)
            || apart > touch_between(m, P, Q) + rounding_between(m, P, p.edge))
            continue;
        m->edge[Q].meets[!end] = m->edge[P].meets[end] = 1;
        if (apart > contact_depth(m, P, Q))
            continue;
        if (slip_between(m, P, Q, t) > contact_depth(m, P, Q))
            m->edge[P].slides = m->edge[Q].slides = 1;
        const int at_Q = own_side(m, P, !end), at_P = own_side(m, Q, end);
        m->edge[Q].joined[!end] = at_Q;
        m->edge[P].joined[end] = at_P;
        if (apart <= touch_between(m, P, Q) && are_one_side(m, P, Q, end)) {
            m->edge[Q].held[!end] = at_Q;
            m->edge[P].held[end] = at_P;
        }
    }
}

/* Whether another pair stands for this one. */
static int is_duplicate(const bbm_model *m, pair p)
{
    for (int way = 0; way < 6; way++)
        if (gives_way(m, p, way / 3, (meeting)(way % 3)))
            return 1;
    return 0;
}

/* Drops some of the pairs; all are judged on the full list. */
static void drop_pairs(bbm_model *m, int (*is_dropped)(const bbm_model *m, pair p))
{
    bbm_contact_scratch *w = m->scratch;
    int kept = 0;

    for (int k = 0; k < w->pairs; k++)
        w->pair[k].dropped = is_dropped(m, w->pair[k]);
    for (int k = 0; k < w->pairs; k++)
        if (!w->pair[k].dropped)
            w->pair[kept++] = w->pair[k];
    w->pairs = kept;
}

/* ----------------------------------------------- detection: what carries over from step to step */

/* The closed contact of the last step that lives on in p: the same; one of the same corner with
 * the same straight side; or, where two corners have passed each other, that of the other corner
 * if it is no longer in the list. */
static const bbm_contact *find_ancestor(const bbm_model *m, pair p)
{
    const bbm_contact *old = find_closed(m, p.corner, p.edge);

    for (meeting k = FLUSH; k <= OTHER && !old; k++) {
        const pair q = meet(m, p, end_near(m, p.corner, p.edge) != p.edge, k);
        const bbm_contact *c = find_closed(m, q.corner, q.edge);
        if (c && are_parallel(m, p.edge, q.edge, 0) && find_pair(m, q) < 0
            && find_pair(m, (pair){ c->corner, c->edge, 0 }) < 0)
            old = c;
    }
    return old;
}

/* Whether P has left a closed contact past a corner Q: an entrance line on which they can enter
 * each other is open, and covered lines are not in the list; or there is no such line, and the
 * projection is off the edge. A P that hangs on a ledge has left, too: on a covered face of a
 * convex Q, not farther from Q than the rounding, where it can enter over the other face. There P
 * is at the surface, and the covered face is not in the way. A joint with strength holds it all the
 * same. */
static int has_left(const bbm_model *m, const bbm_contact *c)
{
    const int Q = end_near(m, c->corner, c->edge), end = Q != c->edge;
    const bbm_edge *q = &m->edge[Q];
    int lines = 0;

    for (int k = 2 * end; k < 2 * end + 2; k++) {
        if (c->trial.entrance[k] < 0)
            continue;
        const pair r = m->scratch->pair[c->trial.entrance[k]];
        if (project(m, r.corner, r.edge).d > 0 && bbm_may_enter(m, r.corner, r.edge))
            return 1;
        lines++;
    }
    return (c->trial.beyond_end && lines == 0)
        || (c->trial.was_closed && !bbm_is_strong(c) && q->meets[!end] && !is_inner(m, Q)
            && cross(m->edge[q->before].along, q->along) > PARALLEL
            && bbm_may_enter(m, c->corner, own_side(m, Q, end))
            && project(m, c->corner, c->edge).beyond > -rounding_between(m, c->corner, c->edge));
}

/* Makes a pair a contact that goes on from the one that it continues. A corner that has come past
 * a rounded one is inside. A projection beyond the end of the edge is off it. But where a block
 * lies flush it may be as far beyond as that may be apart, and by the rounding; and in a notch of
 * its block, or of it and one that lies flush, or as deep in a hollow, it lies inside. An entrance
 * is another line of the list on which P and a convex end Q of its edge can enter each other: P
 * over the next edge, or Q over that edge of P that would lie on this one, unless it does. In a
 * notch Q both edges hold P at once. */
static void continue_contact(const bbm_model *m, pair p, bbm_contact *c)
{
    const bbm_contact *old = m->contacts ? find_ancestor(m, p) : NULL;
    const projection f = project(m, p.corner, p.edge);
    const double touch = touch_between(m, p.corner, p.edge);
    const int near = end_near(m, p.corner, p.edge);
    const double seam = contact_depth(m, p.corner, near) + rounding_between(m, p.corner, p.edge);

    *c = old ? *old : (bbm_contact){ 0 };
    c->inside |= !old && f.d < -touch && f.beyond <= 0;
    c->corner = p.corner;
    c->edge = p.edge;
    c->trial = (bbm_trial){ .time_left = 1, .N_of_friction = c->N, .d_n0 = f.d };
    c->trial.carried = old && old->corner == p.corner && old->edge == p.edge;
    c->trial.touches = m->contacts == 0 && m->info.step == 0 && m->info.t == 0
                    && fmax(fabs(f.d), f.beyond) <= touch;
    c->trial.was_closed = c->state != BBM_OPEN;
    c->trial.beyond_end = f.beyond > (m->edge[near].joined[near != p.edge] >= 0 ? seam : touch);
    for (int k = 0; k < 4; k++) {
        const pair other = meet(m, p, k / 2, k % 2 ? FLUSH : NEXT);
        const int Q = end_of(m, p.edge, k / 2);
        const int in = side_at(m, Q, 0, p.corner), out = side_at(m, Q, 1, p.corner);
        const double bend = cross(m->edge[in].along, m->edge[out].along);
        const int convex = bend > -PARALLEL;        /* or straight */
        const int meets = convex && (k % 2 == 0 || !are_parallel(m, p.edge, other.edge, 0));
        c->trial.entrance[k] = meets ? find_pair(m, other) : -1;
        c->trial.beyond_end &= Q != near
                            || (convex && f.beyond > fmin(0, bend) * f.d);
    }
    c->trial.has_left = has_left(m, c);
}

/* A closed contact c whose corner has left its edge for that of r, which goes on from it, lives on
 * as r, with its forces, unless r has forces of its own. A corner whose block lies beside c alone
 * stays with it until it reaches over r by the rounding. */
static void hand_over(const bbm_model *m, bbm_contact *c, bbm_contact *r)
{
    const double touch = touch_between(m, c->corner, c->edge);
    const projection f = project(m, c->corner, c->edge), g = project(m, c->corner, r->edge);
    const int edge = r->edge, end = end_near(m, c->corner, edge) != edge;
    const double least = lies_over(m, c->corner, edge, end)
                       ? -touch : rounding_between(m, c->corner, edge);

    if (c->state == BBM_OPEN || r->state != BBM_OPEN || f.beyond <= touch || -g.beyond < least
        || !are_parallel(m, c->edge, edge, 1) || m->edge[c->edge].first == m->edge[edge].first)
        return;
    *r = *c;
    r->edge = edge;
    r->d_n = g.d;
    r->rest = bbm_rest_of(m, g.d, r->N);
    r->anchor = (g.s + r->T / m->par.p_s) / m->edge[edge].along.length;
    bbm_forget(c);
}

/* Lists the contacts that may be closed in this step, from the present positions and the contacts
 * of the last step, which stay as they are. `same`: the list of this step had these pairs already,
 * and is as it was. */
bbm_status bbm_list_pairs(bbm_model *m, int *same)
{
    bbm_contact_scratch *w = m->scratch;
    const int is_listed = m->detections++ > 0;

    find_directions(m);
    for (int e = 0; e < m->edges; e++)
        m->edge[e].contact = m->contacts;
    for (int k = m->contacts - 1; k >= 0; k--)
        m->edge[m->contact[k].corner].contact = k;
    for (int k = 0; k < m->contacts; k++) {
        const int P = m->contact[k].corner;
        for (int r = m->edge[P].contact; r < m->contacts && m->contact[r].corner == P; r++)
            hand_over(m, &m->contact[k], &m->contact[r]);
    }
    const bbm_status status = find_pairs(m);
    if (!status) {
        join_flush_corners(m);
        drop_pairs(m, is_hidden);
        drop_pairs(m, is_duplicate);
    }
    *same = !status && is_listed && w->contacts == w->pairs;
    for (int k = 0; k < w->pairs && *same; k++)
        *same = bbm_compare_pairs(&w->contact[k], &w->pair[k]) == 0;
    if (status || *same)
        return status;
    bbm_contact *list = realloc(w->contact, ((size_t)w->pairs + 1) * sizeof *list);
    if (!list)
        return BBM_NO_MEMORY;
    w->contact = list;
    w->contacts = w->pairs;
    for (int k = 0; k < w->pairs; k++)
        continue_contact(m, w->pair[k], &list[k]);
    return BBM_OK;
}

/* ----------------------------------------------------- where a corner comes in, of the solution */

/* The way from q to p at the end. Differences first: springs are so stiff that the last bit of a
 * coordinate counts. */
static bbm_point way_from(moving q, moving p)
{
    return (bbm_point){ p.x - q.x + p.u - q.u, p.y - q.y + p.v - q.v };
}

/* d_n and d_s, from an anchor, Eq. (52), (53), where the solution puts the points; l alone is the
 * start's. */
void bbm_end_distances(const bbm_model *m, const bbm_contact *c, double anchor, double d[2])
{
    const bbm_edge *e = &m->edge[c->edge];
    const moving P1 = move_point(m, m->edge[c->corner].a);
    const moving P2 = move_point(m, e->b), P3 = move_point(m, e->a);
    const moving P0 = { P3.x + anchor * (P2.x - P3.x), P3.y + anchor * (P2.y - P3.y),
                        P3.u + anchor * (P2.u - P3.u), P3.v + anchor * (P2.v - P3.v), 0 };
    const bbm_point t = way_from(P2, P3), n = way_from(P2, P1), s = way_from(P0, P1);

    d[0] = (t.x * n.y - t.y * n.x) / e->along.length;
    d[1] = (s.x * t.x + s.y * t.y) / e->along.length;
}

/* The fraction of the step at which P gets deeper behind a line than at the surface: 0 if it starts
 * so deep, more than 1 if it ends the step no deeper. */
static double crossed_at(const bbm_model *m, const bbm_contact *c)
{
    const double above = c->trial.d_n0 + surface_depth(m, c->corner, c->edge);
    const double touch = touch_between(m, c->corner, c->edge), way = c->trial.d_n0 - c->d_n;

    return above <= touch ? 0 : way > 0 ? above / way : INFINITY;
}

/* Whether the projection of P is on the edge at the fraction t of the step, so far off its ends. */
static int is_on_edge(const bbm_model *m, const bbm_contact *c, double t, double off)
{
    const double s = project(m, c->corner, c->edge).s, l = m->edge[c->edge].along.length;

    return (1 - t) * s - t * c->trial.past[0] >= off
        && (1 - t) * (l - s) - t * c->trial.past[1] >= off;
}

/* Whether P may come in over its line, if it crosses it: as its sides lie at the end of the step,
 * and, where two elements meet in P, without the bend of its penetration. Not from behind the edge,
 * and not where its projection is beyond the end of the edge at the start of the step, as it
 * crosses the line and at the end of the step, unless the contact was closed. */
static int admits(const bbm_model *m, const bbm_contact *c)
{
    const int Q = end_near(m, c->corner, c->edge);
    const double turn = m->D[6 * c->element[0] + 2] - m->D[6 * c->element[1] + 2];
    const bbm_edge *P = &m->edge[c->corner], *e = &m->edge[c->edge];
    const double side = fmin(P->along.length, m->edge[P->before].along.length);
    const int bends = m->edge[P->before].element != P->element;
    const double angle = bends * fmax(0, -c->d_n) / fmin(side, e->along.length);
    double r[2] = { turn, turn };
    const bbm_trial *t = &c->trial;

    for (int which = 0; which < 2; which++) {
        const double own = turn_of(m, side_at(m, c->corner, which, Q)) - turn_of(m, c->edge);
        r[which] = fabs(own) < TURNS ? own : turn;
    }
    if (!t->was_closed && !c->inside && t->d_n0 < -bbm_allowed_depth(m, c->corner, c->edge))
        return 0;
    return (t->was_closed || !t->beyond_end || is_on_edge(m, c, fmin(1, crossed_at(m, c)), 0)
            || is_on_edge(m, c, 1, 0))
        && can_enter(m, c->corner, c->edge, r, PARALLEL + angle);
}

/* Whether an entrance line r of an open contact c counts in its place: r is closed, or P is outside
 * it from where it crosses c to the end, or crosses it later, for P comes in over the line that it
 * crosses last. A P that leaves over r has been outside if it was less than the rounding of the
 * corners behind it. A P that crosses its own line first, on the edge and farther off its ends than
 * their rounding, is inside wherever an end Q lies: both may bear.
 * What was closed keeps its line until P crosses the other one. Of two lines that are not crossed
 * neither counts where each lies along a side of its corner: P and Q pass each other at the
 * surface. Of two lines crossed at the same time the one counts that was closed at the start of the
 * step, or else that goes before. */
static int counts(const bbm_model *m, const bbm_contact *r, const bbm_contact *c)
{
    const double later = crossed_at(m, r) - crossed_at(m, c), t = fmin(1, crossed_at(m, c));
    const double over_r = r->trial.d_n0 + t * (r->d_n - r->trial.d_n0);
    const double off = rounding_between(m, c->corner, c->edge);

    if (r->corner != c->corner && later > TIE
        && is_on_edge(m, c, t, off) && is_on_edge(m, c, 1, off))
        return 0;
    if (r->state != BBM_OPEN)
        return 1;
    if (r->d_n >= 0)
        return over_r >= (c->trial.was_closed ? 0 : -off);
    if (c->trial.was_closed && crossed_at(m, r) > 1)
        return 0;
    if (crossed_at(m, r) > 1 && crossed_at(m, c) > 1 && lies_along(m, c->corner, c->edge)
        && lies_along(m, r->corner, r->edge))
        return 1;
    const int first = fabs(later) > TIE ? later > 0
                    : r->trial.was_closed != c->trial.was_closed ? r->trial.was_closed
                    : goes_before(m, r->edge, c->edge);
    return first && admits(m, r);
}

/* Whether P crosses another line of a corner than that of c, so that one of them counts. */
int bbm_is_at_corner(const bbm_model *m, const bbm_contact *c)
{
    const bbm_contact *list = m->scratch->contact;
    int crossed = 0;

    for (int k = 0; k < 4; k++) {
        const int r = c->trial.entrance[k];
        crossed |= r >= 0 && list[r].d_n < 0 && !are_parallel(m, c->edge, list[r].edge, 1);
    }
    return crossed && c->state == BBM_OPEN;
}

/* Whether an open contact, though crossed, may not close. */
int bbm_is_blocked(const bbm_model *m, const bbm_contact *c)
{
    const int *line = c->trial.entrance;
    int blocked = c->hit < 2 && !admits(m, c);

    for (int k = 0; k < 4 && c->hit < 2 && !blocked; k++)
        blocked = line[k] >= 0 && counts(m, &m->scratch->contact[line[k]], c);
    return blocked;
}

/* ------------------------------------------------------------------------------ end of the step */

/* How deep the blocks are by a list of contacts, and the sides that lie in the line of one:
 * the depth of a contact that is closed, or open inside after a hit, counts for both. Its sides are
 * as deep as its spring is short: what came in over a ledge goes no deeper over the next one. */
void bbm_note_depths(bbm_model *m, const bbm_contact *list, int n)
{
    for (int i = 0; i < m->elements; i++)
        m->scratch->reach[i].depth_now = 0;
    for (int e = 0; e < m->edges; e++)
        m->edge[e].deep = 0;
    for (const bbm_contact *c = list; c < list + n; c++) {
        const int of[3] = { c->edge, c->corner, m->edge[c->corner].before };
        reach *i = reach_of(m, c->corner), *j = reach_of(m, c->edge);
        const double inside = c->hit && (c->trial.was_closed || c->inside) ? fmax(0, -c->d_n) : 0;
        const double depth = c->state == BBM_OPEN ? inside : fabs(c->d_n);
        const double spring = c->state == BBM_OPEN ? inside : fabs(c->d_n - c->rest);
        i->depth_now = fmax(i->depth_now, depth);
        j->depth_now = fmax(j->depth_now, depth);
        for (int k = 0; k < 3; k++)
            m->edge[m->edge[of[k]].side].deep = fmax(m->edge[m->edge[of[k]].side].deep, spring);
    }
}

/* The list of the step becomes that of the model, which has moved. */
void bbm_keep_contacts(bbm_model *m)
{
    bbm_contact_scratch *w = m->scratch;
    bbm_contact *last = m->contact;

    find_directions(m);
    bbm_note_depths(m, w->contact, w->contacts);
    for (int i = 0; i < m->elements; i++) {
        w->reach[i].depth = w->reach[i].depth_now;
        w->reach[i].came = w->reach[i].travel;
    }
    m->contact = w->contact;
    m->contacts = w->contacts;
    w->contact = last;
    w->contacts = 0;
}
