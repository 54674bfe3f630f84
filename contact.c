/* contact.c - contacts between blocks: sections 3.7 and 3.8 of the paper, the open-close
 * iteration.
 *
 * Blocks touch where a vertex P1 of one meets an edge P2 P3 of another. A stiff spring p_n then
 * resists penetration, a spring p_s resists slip, and where Mohr and Coulomb's bound is passed,
 * friction takes the place of p_s:
 *
 *                   d_n < 0                     |T| > N tan(phi) + c A
 *       .------.  ------------->  .------.  --------------------------->  .-------.
 *       | OPEN |                  | LOCK |                                | SLIDE |
 *       '------'  <-------------  '------'  <---------------------------  '-------'
 *           ^     N < -tension A               s T < N tan(phi) + c A         |
 *           '-----------------------------------------------------------------'
 *                                       N < 0
 *
 * N = -p_n d_n is the normal force, T = p_s d_s what the shear spring carries or would carry, s
 * the sign of the slip, A the contact's share of the area of an unbroken joint: 0, or a hook's.
 * d_s counts from the anchor P0, a point of the edge's material: where P1 hit, and there it stays
 * while the contact is locked; while it slides, the anchor follows so that the spring would just
 * carry the friction force of the last step. What is left of s T above the bound is slip; when it
 * turns against the friction, s T falls below the bound and the contact locks with the force it
 * had.
 *
 * A step reads (try_step): detect, assemble, solve, open-close - again until nothing changes -
 * update.
 *
 * Detection. Each corner is compared with each boundary edge, or a hook knows which are near it.
 * `corner` c is the vertex that starts boundary edge c, so that (corner, edge) are two indices of
 * edges: the identity of a contact. A corner may touch an edge if neither of its two sides points
 * into it, and if it does not lie behind it from the start: blocks do not overlap then, but for
 * the depth of closed contacts.
 *
 * Where two corners P and Q meet, several of these pairs describe one contact. The entrance lines,
 * along which P can come in, are
 *
 *          \  P  /              |   A            the two edges of Q (left), or one edge of each
 *           \   /               P______          block (right). The blocks overlap when both are
 *            \ /                 Q_____          crossed, and the spring goes on the one that is
 *      _______Q                  |               crossed last, where P comes in. Two lines that
 *             |                  |   B           coincide are one contact: of P on Q's edge and Q
 *        B    |                  |               on P's edge that one stays whose projection is
 *
 * on its edge; at a tie, the one that it was before, or else the edge that faces up. Both lines at
 * the same time: the one that was closed or else the flatter one counts, the same in any order of
 * the blocks.
 *
 * The iteration. N of a sliding contact depends on its friction and the friction on N: solve with
 * the friction of the last N until they agree; a hook may need fewer solutions. Only then are the
 * states judged, on forces that belong to them, and all that do not fit change. When a set of
 * states comes back that has been there before, the iteration would cycle: for as many passes as
 * there have been, only the contact that fits worst changes in each. A contact that closes outside
 * its cone of friction, or for a second time, starts as SLIDE. Nothing of the model moves before
 * all has settled: a step that does not settle is done again with half the time step, without a
 * trace of the first trial.
 *
 * Deviations from the paper: with a hook, points and T at the middle of the step; grid points
 * inside the shorter of two straight sides touch, too (bbm_carries), so that a deformable block
 * rests on its whole side.
 */
#include "base/base.h"

#include <float.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* --------------------------------------------------------------------- 3.7.1 Normal submatrices */

/* The normal distance of P1 from P2 P3, positive outside. With the three points moved by T D,
 * Eq. (48)-(50), and the terms of second order dropped, d_n = S/l = S0/l + e.D_i + g.D_j,
 * Eq. (52)-(57), (59):
 *     S0 = det [1 x1 y1; 1 x2 y2; 1 x3 y3],   e = T_i^T(P1) (y2 - y3, x3 - x2)/l,
 *     g = T_j^T(P2) (y3 - y1, x1 - x3)/l + T_j^T(P3) (y1 - y2, x2 - x1)/l.
 * Deviation: where a hook says so, points and T of e and g are those of the middle of the step;
 * then only the change of l is dropped. */
void bbm_normal_vectors(const bbm_touch *c, bbm_spring *n)
{
    const double x1 = c->P1->x, y1 = c->P1->y, x2 = c->P2->x, y2 = c->P2->y;
    const double x3 = c->P3->x, y3 = c->P3->y, l = hypot(x3 - x2, y3 - y2);
    double T1[2][6], T2[2][6], T3[2][6], p1[2], p2[2], p3[2];

    bbm_step_matrix(c->i, x1, y1, T1, p1);
    bbm_step_matrix(c->j, x2, y2, T2, p2);
    bbm_step_matrix(c->j, x3, y3, T3, p3);
    n->d = ((x2 - x1) * (y3 - y1) - (x3 - x1) * (y2 - y1)) / l;
    for (int a = 0; a < 6; a++) {
        n->e[a] = (T1[0][a] * (p2[1] - p3[1]) + T1[1][a] * (p3[0] - p2[0])) / l;
        n->g[a] = (T2[0][a] * (p3[1] - p1[1]) + T2[1][a] * (p1[0] - p3[0])
                   + T3[0][a] * (p1[1] - p2[1]) + T3[1][a] * (p2[0] - p1[0])) / l;
    }
}

/* A spring p over d = d0 + e.D_i + g.D_j, Pi = p/2 d^2, Eq. (51): K_ii += p e e^T, K_ij += p e g^T,
 * K_jj += p g g^T, F_i -= p d0 e, F_j -= p d0 g, Eq. (58), (63). */
static void add_spring(double p, const bbm_spring *v, bbm_submatrices *s)
{
    for (int a = 0; a < 6; a++) {
        for (int b = 0; b < 6; b++) {
            s->Kii[a][b] += p * v->e[a] * v->e[b];
            s->Kij[a][b] += p * v->e[a] * v->g[b];
            s->Kjj[a][b] += p * v->g[a] * v->g[b];
        }
        s->Fi[a] -= p * v->d * v->e[a];
        s->Fj[a] -= p * v->d * v->g[a];
    }
}

/* Pi_n = p_n/2 d_n^2, Eq. (51)   ->   Eq. (58)-(59), (58a-f). Deviation: it counts from `rest`, see
 * bbm_contact. */
void bbm_normal_submatrices(const bbm_touch *c, double p_n, bbm_submatrices *s)
{
    bbm_spring n;

    bbm_normal_vectors(c, &n);
    n.d -= c->rest;
    add_spring(p_n, &n, s);
}

/* ---------------------------------------------------------------------- 3.7.2 Shear submatrices */

/* The displacement of P1 along the edge against its anchor P0, d_s = S1 + e.D_i + g.D_j,
 * Eq. (48)-(50), (53), (60)-(62),
 *     m = (P3 - P2)/l,   S1 = (P1 - P0).m,   e = T_i^T(P1) m,   g = -T_j^T(P0) m,
 * Eq. (64), (67), (68). The anchor is the point P0 = P3 + anchor (P2 - P3) of the edge's material.
 * Deviation: at the middle of the step, and with what (60) drops, the turning of m:
 * (T3 - T2)^T (P1 - P0)/l in g. Without it friction does not keep angular momentum. */
void bbm_shear_vectors(const bbm_touch *c, double anchor, bbm_spring *s)
{
    const bbm_vertex *P1 = c->P1, *P2 = c->P2, *P3 = c->P3;
    const double x0 = P3->x + anchor * (P2->x - P3->x), y0 = P3->y + anchor * (P2->y - P3->y);
    const double l = hypot(P3->x - P2->x, P3->y - P2->y);
    double T1[2][6], T0[2][6], T2[2][6], T3[2][6], p1[2], p0[2], p2[2], p3[2];

    bbm_step_matrix(c->i, P1->x, P1->y, T1, p1);
    bbm_step_matrix(c->j, x0, y0, T0, p0);
    bbm_step_matrix(c->j, P2->x, P2->y, T2, p2);
    bbm_step_matrix(c->j, P3->x, P3->y, T3, p3);
    const double mx = (p3[0] - p2[0]) / l, my = (p3[1] - p2[1]) / l;
    const double ax = c->exact ? (p1[0] - p0[0]) / l : 0, ay = c->exact ? (p1[1] - p0[1]) / l : 0;
    s->d = ((P1->x - x0) * (P3->x - P2->x) + (P1->y - y0) * (P3->y - P2->y)) / l;
    for (int a = 0; a < 6; a++) {
        s->e[a] = T1[0][a] * mx + T1[1][a] * my;
        s->g[a] = -T0[0][a] * mx - T0[1][a] * my
                + (T3[0][a] - T2[0][a]) * ax + (T3[1][a] - T2[1][a]) * ay;
    }
}

/* Pi_s = p_s/2 d_s^2, Eq. (51)   ->   Eq. (63), (64). */
void bbm_shear_submatrices(const bbm_touch *c, double anchor, double p_s, bbm_submatrices *s)
{
    bbm_spring v;

    bbm_shear_vectors(c, anchor, &v);
    add_spring(p_s, &v, s);
}

/* --------------------------------------------------------------------- 3.8 Friction submatrices */

/* The friction force Fr, positive when P1 slips towards P3, Eq. (65): F_i -= Fr e, F_j -= Fr g,
 * Eq. (66)-(69). */
void bbm_friction_submatrices(const bbm_touch *c, double anchor, double Fr, bbm_submatrices *s)
{
    bbm_spring v;

    bbm_shear_vectors(c, anchor, &v);
    for (int a = 0; a < 6; a++) {
        s->Fi[a] -= Fr * v.e[a];
        s->Fj[a] -= Fr * v.g[a];
    }
}

/* The strengths that a contact has: those of the model, or of its joint. */
const bbm_parameters *bbm_strength_of(const bbm_model *m, const bbm_contact *c)
{
    return m->hook.strength ? m->hook.strength(m, c->corner, c->edge) : &m->par;
}

static double tan_friction(const bbm_parameters *p) { return tan(p->friction * acos(-1) / 180); }

/* Mohr and Coulomb: the largest shear force under the normal force N, Eq. (65), with cohesion on
 * the area of an unbroken joint. Under tension such a joint has what is left of its cohesion. */
double bbm_shear_strength(const bbm_parameters *p, double N, double area)
{
    return fmax(0, N * tan_friction(p) + p->cohesion * area);
}

/* The transfer table of the figure above: the state that follows from d_n, N and T. Forces that
 * differ by less than the tolerance agree. An opening contact has none: it would be a hidden
 * tensile strength. */
bbm_contact_state bbm_next_state(const bbm_parameters *p, const bbm_contact *c, double tolerance)
{
    const double strength = bbm_shear_strength(p, c->N, c->area);

    if (c->state == BBM_OPEN)
        return -p->p_n * (c->d_n - c->rest) > tolerance ? BBM_LOCK : BBM_OPEN;
    if (c->N < -p->tension * c->area)
        return BBM_OPEN;
    if (p->friction == 0 && p->cohesion == 0)
        return BBM_SLIDE;
    if (c->state == BBM_LOCK)
        return fabs(c->T) > strength + tolerance ? BBM_SLIDE : BBM_LOCK;
    return c->sign * c->T < strength - tolerance ? BBM_LOCK : BBM_SLIDE;
}

/* ---------------------------------------------------------------------------------------- the data
 *
 * Tolerances; none depends on the size of the domain.
 * STRAIGHT [rad]  sides that differ less in direction at the start are one straight side, and
 *                 sides that differ less in length, relatively, are as long: rounding of a file
 * PARALLEL [rad]  lines that differ less coincide, and a side that points into an edge by less
 *                 lies on it: what penetration and elastic bending turn
 * BENT     [rad]  the same for a side that was straight, at a grid point inside it that touches:
 *                 soft blocks bend more
 * TOUCH    [-]    d_n below this, in mean edges of the two blocks, is closed at the start, and a
 *                 projection closer to the end of an edge is at the end: rounding of a model file,
 *                 elastic strain
 * AGREE    [-]    forces that differ by less, against the largest force of what K connects,
 *                 agree: what the solver can tell
 * TIE      [-]    fractions of a step that differ less are the same moment: rounding */
#define STRAIGHT 1e-4
#define PARALLEL 1e-2
#define BENT 0.1
#define TOUCH 1e-6
#define AGREE 1e-9
#define TIE 1e-9

/* Passes that change states or renew the vectors of the step, and that change friction forces
 * between two of them. */
enum { PASSES = 40, FRICTION_PASSES = 100 };

typedef struct { int corner, edge, dropped; } pair;         /* what may touch               */

typedef struct {                /* of a block, with the index of its first element              */
    double depth;               /* m        |d_n| of its closed contacts, before the step       */
    double depth_now;           /* m        the same of the solution, or before it if deeper    */
    double travel;              /* m        how far its vertices may move in this step          */
    double girth;               /* m        its boundary at the start                           */
    int    edges;               /* of it                                                        */
    /* --- of an element; of a component of K, with its number --- */
    double turn;                /* rad      how far it may turn in this step                    */
    double force;               /* N        the largest one in it                               */
} motion;

struct bbm_contact_scratch {
    motion *motion;             /* [elements] of blocks                                         */
    int pairs, pair_room;
    pair *pair;                 /* [pairs]  that may touch, by corner and edge                  */
    /* --- the contacts of the step --- */
    int is_listed;
    int contacts;
    bbm_contact *contact;       /* [contacts] of the pairs                                      */
    /* --- the iteration --- */
    int passes, friction_passes;
    int one_until;              /* the pass until which one contact changes its state in each   */
    uint64_t seen[PASSES + 1];  /* the states of each pass                                      */
};

/* ------------------------------------------------------------------- the boundary of the blocks */

static const bbm_vertex *start_of(const bbm_model *m, int e) { return &m->vertex[m->edge[e].a]; }
static const bbm_vertex *end_of(const bbm_model *m, int e) { return &m->vertex[m->edge[e].b]; }
static int element_of(const bbm_model *m, int e) { return m->edge[e].element; }
static double cross(bbm_direction p, bbm_direction q) { return p.x * q.y - p.y * q.x; }

static motion *motion_of(const bbm_model *m, int e)
{
    return &m->scratch->motion[m->edge[e].first];
}

/* The length of the boundary of the block of edge e. */
double bbm_girth(const bbm_model *m, int e) { return motion_of(m, e)->girth; }

/* Distances up to this are rounding: TOUCH times the mean boundary edge of the block of edge e. */
static double rounding_of(const bbm_model *m, int e)
{
    return motion_of(m, e)->girth * (TOUCH / motion_of(m, e)->edges);
}

/* A vertex inside a straight side is no corner. */
static int is_corner(const bbm_model *m, int c) { return m->edge[c].side == c; }

/* Less than 180 degrees inside, or straight. */
static int is_convex(const bbm_model *m, int c)
{
    return cross(m->edge[m->edge[c].before].along, m->edge[c].along) > -PARALLEL;
}

static int coincide(const bbm_model *m, int e, int f)
{
    return fabs(cross(m->edge[e].along, m->edge[f].along)) <= PARALLEL;
}

/* Directions and lengths of the present edges. */
static void find_directions(bbm_model *m)
{
    for (int e = 0; e < m->edges; e++) {
        const bbm_vertex *a = start_of(m, e), *b = end_of(m, e);
        const double x = b->x - a->x, y = b->y - a->y, l = hypot(x, y);
        m->edge[e].along = (bbm_direction){ x / l, y / l, l };
    }
}

/* Links each edge with the one that starts where it ends: from element to element round that node,
 * over the bonds, as far as they go. */
static void link_edges(bbm_model *m)
{
    for (int e = 0; e < m->edges; e++) {
        int v = m->edge[e].b;
        while (m->vertex[v].edge < 0)
            v = -1 - m->vertex[v].edge;
        m->edge[e].after = m->vertex[v].edge;
        m->edge[m->edge[e].after].before = e;
    }
}

/* Whether edge e goes straight on from the one before it. */
static int goes_on(const bbm_model *m, int e)
{
    const bbm_direction p = m->edge[m->edge[e].before].along, q = m->edge[e].along;

    return hypot(q.x - p.x, q.y - p.y) < STRAIGHT;
}

/* The straight sides that the edges belong to. */
static void find_sides(bbm_model *m)
{
    for (int first = 0; first < m->edges; first++) {
        int e = first;
        if (goes_on(m, first))
            continue;
        do {
            m->edge[e].side = first;
            e = m->edge[e].after;
        } while (goes_on(m, e));
        const bbm_vertex *a = start_of(m, first), *b = start_of(m, e);
        m->edge[first].span = hypot(b->x - a->x, b->y - a->y);
    }
}

/* By corner and edge, the first two members of pairs and of contacts. */
static int compare_pairs(const void *p, const void *q)
{
    const int *a = p, *b = q, k = a[0] == b[0];

    return (a[k] > b[k]) - (a[k] < b[k]);
}

/* Finds the first element of each block. */
static void number_blocks(bbm_model *m)
{
    pair *of = m->scratch->pair;                            /* block and edge                   */

    for (int e = 0; e < m->edges; e++)
        of[e] = (pair){ m->edge[e].block, e, 0 };
    qsort(of, (size_t)m->edges, sizeof *of, compare_pairs);
    for (int k = 0, first = 0; k < m->edges; k++) {
        first = of[k].corner == of[first].corner ? first : k;
        m->edge[of[k].edge].first = m->edge[of[first].edge].element;
    }
}

void bbm_contact_free(bbm_contact_scratch *w)
{
    if (!w)
        return;
    free(w->motion);
    free(w->pair);
    free(w->contact);
    free(w);
}

bbm_status bbm_contact_new(bbm_model *m)
{
    bbm_contact_scratch *w = m->scratch = calloc(1, sizeof *w);

    if (!w)
        return BBM_NO_MEMORY;
    w->motion = calloc((size_t)m->elements, sizeof *w->motion);
    w->pair = calloc((size_t)m->edges, sizeof *w->pair);
    if (!w->motion || !w->pair)
        return BBM_NO_MEMORY;
    w->pair_room = m->edges;
    number_blocks(m);
    link_edges(m);
    find_directions(m);
    find_sides(m);
    for (int e = 0; e < m->edges; e++) {
        motion *b = motion_of(m, e);
        b->depth = m->info.penetration;         /* in a run contacts may be as deep */
        b->girth += m->edge[e].along.length;
        b->edges++;
    }
    return BBM_OK;
}

/* ----------------------------------------------------------- detection: how far blocks may move */

/* Takes for D what the velocities and gravity foretell of the step; in statics a step is as long as
 * the last one at most. */
void bbm_guess_step(bbm_model *m)
{
    const double h = bbm_is_static(m) ? 0 : m->h, *g = m->acceleration;
    const double fall[6] = { g[0] * h * h / 2, g[1] * h * h / 2 };

    for (int i = 0; i < m->elements; i++) {
        const bbm_element *e = &m->element[i];
        for (int a = 0; a < 6; a++)
            m->D[6 * i + a] = bbm_is_static(m) ? e->D[a] : e->V[a] * h + fall[a];
        m->scratch->motion[i].travel = 0;
    }
    m->scratch->is_listed = 0;
}

/* How far the vertex that starts edge e moves by D. */
static double way_of(const bbm_model *m, int e)
{
    const bbm_vertex *p = start_of(m, e);
    double u[2];

    bbm_move(m, &m->element[p->element], &m->D[6 * p->element], p->x, p->y, u);
    return hypot(u[0], u[1]);
}

/* Whether the solution moves further than the detection has foreseen. */
int bbm_moved_too_far(bbm_model *m)
{
    int too_far = 0;

    for (int e = 0; e < m->edges && !too_far; e++) {
        const int i = element_of(m, e);
        too_far = way_of(m, e) > motion_of(m, e)->travel
               || fabs(m->D[6 * i + 2]) > m->scratch->motion[i].turn;
    }
    return too_far;
}

/* How far the blocks may move, by D as far as it is known: a tenth more, or what rounding and a
 * closed contact give, and no less than what this step has foreseen before; and turn: twice that.
 * Returns the largest way. */
static double foresee(bbm_model *m)
{
    double most = 0;

    for (int i = 0; i < m->elements; i++) {
        motion *of = &m->scratch->motion[i];
        of->depth_now = of->depth;
        of->turn = 2 * fabs(m->D[6 * i + 2]) + PARALLEL / 2;
    }
    for (int e = 0; e < m->edges; e++) {
        motion *b = motion_of(m, e);
        b->travel = fmax(b->travel, 1.1 * way_of(m, e) + b->depth + rounding_of(m, e) / 2);
        most = fmax(most, b->travel);
    }
    return most;
}

/* Distances of a corner and an edge up to this are rounding. */
static double touch_between(const bbm_model *m, int c, int e)
{
    return (rounding_of(m, c) + rounding_of(m, e)) / 2;
}

/* How deep a vertex may lie behind an edge at the start of a step: as deep as closed contacts of
 * the two blocks do. Nothing comes in from behind. What moves by T of the start of a step may also
 * end it inside, by its way; and a corner that slides on along a straight side, which may be bent
 * by now, keeps its contact. */
double bbm_allowed_depth(const bbm_model *m, int c, int e)
{
    const motion *i = motion_of(m, c), *j = motion_of(m, e);
    const double way = bbm_is_exact(m) ? 0 : i->travel + j->travel;

    return 2 * fmin(i->depth, j->depth) + touch_between(m, c, e) + way;
}

/* ---------------------------------------------------------------- detection: who may touch whom */

typedef struct {                /* of P1 on an edge, m                                          */
    double d, s, beyond;        /* distance; way along the edge from P3; how far beyond an end  */
} projection;

static projection project(const bbm_model *m, int corner, int e)
{
    const bbm_vertex *P = start_of(m, corner), *a = start_of(m, e);
    const bbm_direction t = m->edge[e].along;
    const double x = P->x - a->x, y = P->y - a->y, s = x * t.x + y * t.y;

    return (projection){ x * t.y - y * t.x, s, fmax(-s, s - t.length) };
}

/* Neither side of the corner points into the edge, by more than an angle, after its block has
 * turned by r against the edge's, and the block is convex there: it lies on the outside. Either
 * end of a side may be as deep as closed contacts are. A grid point inside a straight side may
 * come to lie in a hollow where that bends. */
static int can_enter(const bbm_model *m, int corner, int e, double r, double angle)
{
    const bbm_direction t = m->edge[e].along, q = m->edge[corner].along;
    const bbm_direction p = m->edge[m->edge[corner].before].along;
    const bbm_direction s = { t.x * cos(r) + t.y * sin(r), t.y * cos(r) - t.x * sin(r), 1 };
    const double dip = 2 * fmin(motion_of(m, corner)->depth_now, motion_of(m, e)->depth_now);

    if (!is_corner(m, corner))
        return fmin(cross(q, s), cross(s, p)) >= -BENT;
    return cross(q, s) >= -angle - dip / fmin(q.length, t.length)
        && cross(s, p) >= -angle - dip / fmin(p.length, t.length) && is_convex(m, corner);
}

/* Of two edges along p and q that face each other, whether the outward normal of the first,
 * (p.y, -p.x), is the one that points up, or if both are upright, to the right. */
static int faces_up(bbm_direction p, bbm_direction q)
{
    return (fabs(p.x - q.x) > PARALLEL ? p.x - q.x : q.y - p.y) < 0;
}

/* Whether the grid points inside the straight side of c touch the one of e, too (`faces`): those
 * of the shorter side do, of equal sides those of the upper one. They carry all of it; none comes
 * or goes while it slides on the longer. Deviation: with `faces` = 0 corners alone touch, and a
 * block of many elements sags between them. */
int bbm_carries(const bbm_model *m, int c, int e)
{
    const bbm_direction p = m->edge[c].along, q = m->edge[e].along;
    const double mine = m->edge[m->edge[c].side].span, other = m->edge[m->edge[e].side].span;

    if (!m->par.faces || hypot(p.x + q.x, p.y + q.y) > 1)       /* they do not face each other  */
        return 0;
    return fabs(mine - other) > STRAIGHT * other ? mine < other : faces_up(q, p);
}

/* The contact of the last step, closed or open inside, between `corner` and the edge - or, if
 * `all`, another one of its straight side - or NULL. */
static const bbm_contact *find_closed(const bbm_model *m, int corner, int edge, int all)
{
    const bbm_contact *found = NULL;

    for (int k = m->edge[corner].contact; k < m->contacts && m->contact[k].corner == corner; k++) {
        const bbm_contact *c = &m->contact[k];
        if (c->state == BBM_OPEN && !c->inside)
            continue;
        if (c->edge == edge)
            return c;
        if (all && m->edge[c->edge].side == m->edge[edge].side)
            found = c;
    }
    return found;
}

/* Whether the corner may come to touch the edge in this step. If it is still outside it may also
 * turn there first, as when a side falls flat on an edge. */
static int may_touch(const bbm_model *m, int corner, int e)
{
    const motion *of = m->scratch->motion;
    const double turns = of[element_of(m, corner)].turn + of[element_of(m, e)].turn;
    const double approach = motion_of(m, corner)->travel + motion_of(m, e)->travel;
    const double deep = bbm_allowed_depth(m, corner, e);
    const projection f = project(m, corner, e);

    if (m->edge[e].block == m->edge[corner].block)
        return 0;
    if (!is_corner(m, corner) && !bbm_carries(m, corner, e))
        return 0;
    if (fmax(fabs(f.d), f.beyond) > approach + deep)
        return 0;
    if (f.beyond <= touch_between(m, corner, e) && f.d < -deep && !find_closed(m, corner, e, 1))
        return 0;
    return find_closed(m, corner, e, 0)
        || can_enter(m, corner, e, 0, f.d > 0 ? turns : PARALLEL);
}

/* Adds a corner and an edge to the pairs, if they may touch. */
bbm_status bbm_add_pair(bbm_model *m, int corner, int edge)
{
    bbm_contact_scratch *w = m->scratch;

    m->info.candidates++;
    if (!may_touch(m, corner, edge))
        return BBM_OK;
    if (w->pairs == w->pair_room) {
        pair *larger = realloc(w->pair, 2 * (size_t)w->pairs * sizeof *larger);
        if (!larger)
            return BBM_NO_MEMORY;
        w->pair = larger;
        w->pair_room *= 2;
    }
    w->pair[w->pairs++] = (pair){ corner, edge, 0 };
    return BBM_OK;
}

/* All pairs that may touch. The search distance, for the hook: how far two blocks may approach each
 * other and how deep a vertex may lie are together six times the largest way at most, seen along an
 * axis from a slanting edge nine times. */
static bbm_status list_pairs(bbm_model *m)
{
    const double search = 9 * foresee(m);
    bbm_status status = BBM_OK;

    m->scratch->pairs = m->info.candidates = 0;
    if (m->hook.find_pairs)
        status = m->hook.find_pairs(m, search);
    for (int c = 0; c < m->edges && !m->hook.find_pairs; c++)
        for (int e = 0; e < m->edges && !status; e++)
            status = bbm_add_pair(m, c, e);
    qsort(m->scratch->pair, (size_t)m->scratch->pairs, sizeof(pair), compare_pairs);
    return status;
}

/* ---------------------------------------------------------------- detection: where corners meet */

/* The index of a pair, or -1. */
static int find_pair(const bbm_model *m, pair p)
{
    const bbm_contact_scratch *w = m->scratch;

    for (int k = m->edge[p.corner].pair; k < w->pairs && w->pair[k].corner == p.corner; k++)
        if (w->pair[k].edge == p.edge)
            return k;
    return -1;
}

/* Where the pairs of each corner begin. */
static void index_pairs(bbm_model *m)
{
    for (int e = 0; e < m->edges; e++)
        m->edge[e].pair = m->scratch->pairs;
    for (int k = m->scratch->pairs - 1; k >= 0; k--)
        m->edge[m->scratch->pair[k].corner].pair = k;
}

/* What else there can be where the corner P of a pair meets an end Q of its edge: P on the next
 * edge; Q on that edge of P that lies on this one when the blocks are flush; Q on the other edge
 * of P. */
typedef enum { NEXT, FLUSH, OTHER } meeting;

static pair meet(const bbm_model *m, pair p, int end, meeting kind)
{
    const int Q = end ? m->edge[p.edge].after : p.edge;

    if (kind == NEXT)
        return (pair){ p.corner, end ? Q : m->edge[Q].before, 0 };
    return (pair){ Q, (kind == FLUSH) == end ? p.corner : m->edge[p.corner].before, 0 };
}

/* Whether of two pairs that are one contact, p and what it meets, the other one stays. On a
 * straight side: if P comes before the end of that edge. Seen from both sides, when the edges
 * coincide and P lies at Q: the one that was closed, or else whose edge faces up. Of two corners,
 * flush, just one has its projection on the other's edge: the one stays. */
static int gives_way(const bbm_model *m, pair p, int end, meeting kind)
{
    const pair q = meet(m, p, end, kind);
    const int Q = end ? m->edge[p.edge].after : p.edge;

    if ((kind == NEXT ? is_corner(m, Q) : !coincide(m, p.edge, q.edge)) || find_pair(m, q) < 0)
        return 0;
    const projection f = project(m, p.corner, p.edge), g = project(m, q.corner, q.edge);
    const bbm_direction t = m->edge[p.edge].along, u = m->edge[q.edge].along;
    if (kind == NEXT)
        return end ? f.s >= t.length : g.s < u.length;
    const double beside = fabs(f.s - (end ? t.length : 0));
    const double most = fmax(beside, fmax(fabs(f.beyond), fabs(g.beyond)));
    if (most > touch_between(m, p.corner, p.edge))
        return kind == FLUSH && is_corner(m, p.corner) && is_corner(m, Q) && f.beyond > g.beyond;
    const int here = find_closed(m, p.corner, p.edge, 0) != NULL;
    const int there = find_closed(m, q.corner, q.edge, 0) != NULL;
    return here != there ? there : !faces_up(t, u);
}

/* Drops the pairs that another one stands for; all are judged on the full list. */
static void drop_duplicates(bbm_model *m)
{
    bbm_contact_scratch *w = m->scratch;
    int kept = 0;

    index_pairs(m);
    for (int k = 0; k < w->pairs; k++)
        for (int way = 0; way < 6; way++)
            w->pair[k].dropped |= gives_way(m, w->pair[k], way / 3, (meeting)(way % 3));
    for (int k = 0; k < w->pairs; k++)
        if (!w->pair[k].dropped)
            w->pair[kept++] = w->pair[k];
    w->pairs = kept;
    index_pairs(m);
}

/* Another line on which P and an end Q of its edge can enter each other, if both are convex
 * corners and it is in the list; else -1. In a notch Q both edges hold P at once. */
static int find_entrance(const bbm_model *m, pair p, int end, meeting kind)
{
    const pair other = meet(m, p, end, kind);
    const int Q = end ? m->edge[p.edge].after : p.edge;

    return is_convex(m, Q) && !coincide(m, p.edge, other.edge) ? find_pair(m, other) : -1;
}

/* ----------------------------------------------- detection: what carries over from step to step */

static bbm_touch touch_of(const bbm_model *m, const bbm_contact *c)
{
    const bbm_element *i = &m->element[element_of(m, c->corner)];
    const bbm_element *j = &m->element[element_of(m, c->edge)];

    return (bbm_touch){ i, j, start_of(m, c->corner), end_of(m, c->edge), start_of(m, c->edge),
                        bbm_is_exact(m), c->rest };
}

/* Puts the anchor where the shear spring carries the force T: (P1 - P0).m = T/p_s, m from P2 to
 * P3. */
static void place_anchor(const bbm_model *m, bbm_contact *c, double T)
{
    const double s = project(m, c->corner, c->edge).s;

    c->anchor = (s + T / m->par.p_s) / m->edge[c->edge].along.length;
}

/* The closed contact of the last step that lives on in p: the same; one of the same corner with
 * the same straight side; or, where two corners have passed each other, that of the other corner
 * if it is no longer in the list. */
static const bbm_contact *find_ancestor(const bbm_model *m, pair p)
{
    const bbm_contact *old = find_closed(m, p.corner, p.edge, 1);

    for (int k = 0; k < 4 && !old; k++) {
        const pair q = meet(m, p, k / 2, k == 0 || k == 3 ? FLUSH : OTHER);
        if (coincide(m, p.edge, q.edge) && find_pair(m, q) < 0)
            old = find_closed(m, q.corner, q.edge, 0);
    }
    return old;
}

/* A closed contact is free when P has left past a corner Q: an entrance line on which they can
 * enter each other is open, or there is none and the projection is off the edge. */
static int has_left(const bbm_model *m, const bbm_contact *c)
{
    int lines = 0;

    for (int k = 0; k < 4; k++) {
        if (c->entrance[k] < 0)
            continue;
        const pair r = m->scratch->pair[c->entrance[k]];
        if (project(m, r.corner, r.edge).d > 0 && can_enter(m, r.corner, r.edge, 0, PARALLEL))
            return 1;
        lines++;
    }
    return c->beyond_end && lines == 0;
}

/* Whether a contact is an unbroken joint that holds by more than friction. */
static int is_strong(const bbm_parameters *p, const bbm_contact *c)
{
    return c->area > 0 && (p->cohesion > 0 || p->tension > 0);
}

/* Makes a pair a contact, with the state of the one that it continues. A projection beyond the end
 * of the edge is off it, but not in a notch, where it lies inside the block. A joint that touches
 * at the start is closed from the start in statics, or if it has a strength. */
static void make_contact(bbm_model *m, pair p, bbm_contact *c)
{
    const bbm_contact *old = m->contacts ? find_ancestor(m, p) : NULL;
    const int same = old && old->corner == p.corner && old->edge == p.edge;
    const projection f = project(m, p.corner, p.edge);
    const double touch = touch_between(m, p.corner, p.edge);

    *c = old ? *old : (bbm_contact){ 0 };
    c->corner = p.corner;
    c->edge = p.edge;
    c->d_n0 = f.d;
    c->time_left = 1;
    c->N_of_friction = c->N;
    c->was_closed = c->state != BBM_OPEN;
    c->closings = 0;
    c->beyond_end = f.beyond > touch
                 && is_convex(m, f.s < 0 ? p.edge : m->edge[p.edge].after);
    for (int k = 0; k < 4; k++)
        c->entrance[k] = find_entrance(m, p, k / 2, k % 2 ? FLUSH : NEXT);
    if (!old && m->info.step == 0 && m->info.t == 0
        && fmax(fabs(f.d), f.beyond) <= touch) {
        c->area = m->hook.joint_area ? m->hook.joint_area(m, p.corner, p.edge) : 0;
        c->state = is_strong(bbm_strength_of(m, c), c) || bbm_is_static(m) ? BBM_LOCK : BBM_OPEN;
    }
    if (has_left(m, c)) {
        c->state = BBM_OPEN;
        c->N = c->T = c->was_closed = c->inside = 0;
    }
    if (!same || c->state == BBM_OPEN) {
        place_anchor(m, c, c->T);
        c->rest = bbm_is_exact(m) ? fmin(0, c->d_n0 + c->N / m->par.p_n) : 0;
    }
    if (m->trial == BBM_ONE_BY_ONE && c->state == BBM_SLIDE)
        c->state = BBM_LOCK;
}

/* Lists the contacts that may be closed in this step, from the present positions and the contacts
 * of the last step, which stay as they are; `same` (may be NULL): the list of this step had these
 * pairs already. Where one state changes in each pass, contacts that slid begin as locked by the
 * force that their friction had. */
bbm_status bbm_detect_contacts(bbm_model *m, int *same)
{
    bbm_contact_scratch *w = m->scratch;

    find_directions(m);
    for (int e = 0; e < m->edges; e++)
        m->edge[e].contact = m->contacts;
    for (int k = m->contacts - 1; k >= 0; k--)
        m->edge[m->contact[k].corner].contact = k;
    const bbm_status status = list_pairs(m);
    if (!status)
        drop_duplicates(m);
    int known = !status && w->is_listed && w->contacts == w->pairs;
    for (int k = 0; k < w->pairs && known; k++)
        known = compare_pairs(&w->contact[k], &w->pair[k]) == 0;
    if (same)
        *same = known;
    if (status || known)
        return status;
    bbm_contact *list = realloc(w->contact, ((size_t)w->pairs + 1) * sizeof *list);
    if (!list)
        return BBM_NO_MEMORY;
    w->contact = list;
    w->contacts = w->pairs;
    for (int k = 0; k < w->pairs; k++)
        make_contact(m, w->pair[k], &list[k]);
    w->is_listed = 1;
    w->passes = w->friction_passes = 0;
    w->one_until = m->trial == BBM_ONE_BY_ONE ? PASSES + 1 : 0;
    return BBM_OK;
}

/* The contacts of the step in hand. */
bbm_contact *bbm_list_contacts(const bbm_model *m, int *contacts)
{
    *contacts = m->scratch->contacts;
    return m->scratch->contact;
}

/* ------------------------------------------------------------------------------------- assembly */

/* Whether a strong joint under N has no shear strength left. */
static int is_strengthless(const bbm_parameters *p, const bbm_contact *c, double N)
{
    return is_strong(p, c) && bbm_shear_strength(p, N, c->area) == 0;
}

/* The friction of a sliding contact under the N that is taken for it, Eq. (65). It goes on below
 * N = 0, where the strength ends, unless the joint is strong and may be in tension: such a contact
 * opens when it is judged, and until then N depends on N without a kink. */
static double friction_force(const bbm_parameters *p, const bbm_contact *c)
{
    const double N = c->N_of_friction;

    return c->sign * (is_strong(p, c) ? bbm_shear_strength(p, N, c->area) : N * tan_friction(p));
}

/* Friction as a load under the N of the last solution, Eq. (65), (69), or as a hook has it. */
static void add_friction(bbm_model *m, bbm_contact *c, const bbm_touch *t, bbm_submatrices *s)
{
    const bbm_parameters *p = bbm_strength_of(m, c);

    c->friction_in_K = m->hook.friction && !is_strengthless(p, c, c->N_of_friction)
                    && m->hook.friction(m, c, t, s);
    if (!c->friction_in_K)
        bbm_friction_submatrices(t, c->anchor, friction_force(p, c), s);
}

/* Adds the springs of the closed contacts, Eq. (58) and (63), or spring and friction, Eq. (65),
 * (69), to K and F. */
void bbm_assemble_contacts(bbm_model *m)
{
    for (int k = 0; k < m->scratch->contacts; k++) {
        bbm_contact *c = &m->scratch->contact[k];
        const bbm_touch t = touch_of(m, c);
        bbm_submatrices s = { { { 0 } }, { { 0 } }, { { 0 } }, { 0 }, { 0 } };
        if (c->state == BBM_OPEN)
            continue;
        bbm_normal_submatrices(&t, m->par.p_n, &s);
        if (c->state == BBM_LOCK)
            bbm_shear_submatrices(&t, c->anchor, c->time_left * m->par.p_s, &s);
        else
            add_friction(m, c, &t, &s);
        bbm_add_submatrices(m, element_of(m, c->corner), element_of(m, c->edge), &s);
    }
}

/* ------------------------------------------------------------- the open-close iteration: forces */

/* d = d0 + e.D_i + g.D_j of the solution, Eq. (57), (61). */
static double spring_length(const bbm_model *m, const bbm_contact *c, const bbm_spring *v)
{
    const double *Di = &m->D[6 * element_of(m, c->corner)], *Dj = &m->D[6 * element_of(m, c->edge)];
    double d = v->d;

    for (int a = 0; a < 6; a++)
        d += v->e[a] * Di[a] + v->g[a] * Dj[a];
    return d;
}

/* d_n, d_s, N and T of the solution. An open contact has its anchor at P3, so that -d_s is the way
 * along the edge. */
static void measure(const bbm_model *m, bbm_contact *c)
{
    const bbm_touch t = touch_of(m, c);
    const int open = c->state == BBM_OPEN;
    bbm_spring n, s;

    c->anchor = open ? 0 : c->anchor;
    c->time_left = open ? 1 : c->time_left;
    bbm_normal_vectors(&t, &n);
    bbm_shear_vectors(&t, c->anchor, &s);
    c->d_n = spring_length(m, c, &n);
    c->d_s = c->time_left * spring_length(m, c, &s);
    c->N = open ? 0 : -m->par.p_n * (c->d_n - c->rest);
    c->T = open ? 0 : m->par.p_s * c->d_s;
    if (c->friction_in_K && !is_strengthless(bbm_strength_of(m, c), c, c->N))
        c->N_of_friction = c->N;
}

/* The largest force in the component of K that an element belongs to. */
static double *force_on(const bbm_model *m, int element)
{
    return &m->scratch->motion[bbm_component_of(m->K, element)].force;
}

/* The largest force in each component: on an element, inertia included, or in a contact. What the
 * solver leaves as its residual, and so in every N of it, is small against this and nothing else.
 */
static void find_tolerances(const bbm_model *m)
{
    const bbm_contact_scratch *w = m->scratch;

    for (int i = 0; i < m->elements; i++)
        w->motion[i].force = 0;
    for (int i = 0; i < m->elements; i++) {
        double *most = force_on(m, i);
        *most = fmax(*most, hypot(m->F[6 * i], m->F[6 * i + 1]));
    }
    for (int k = 0; k < w->contacts; k++) {
        double *most = force_on(m, element_of(m, w->contact[k].corner));
        *most = fmax(*most, fabs(w->contact[k].N));
    }
    for (int k = 0; k < w->contacts; k++)
        w->contact[k].force_tolerance = AGREE * *force_on(m, element_of(m, w->contact[k].corner));
}

/* Whether every friction force belongs to its N. */
static int forces_agree(const bbm_model *m)
{
    int agree = 1;

    for (int k = 0; k < m->scratch->contacts && agree; k++) {
        const bbm_contact *c = &m->scratch->contact[k];
        agree = c->state != BBM_SLIDE || bbm_strength_of(m, c)->friction == 0
             || fabs(c->N - c->N_of_friction) <= c->force_tolerance;
    }
    return agree;
}

/* Takes the N of the solution for the friction of the next one. */
static void renew_friction(bbm_contact_scratch *w)
{
    for (int k = 0; k < w->contacts; k++)
        w->contact[k].N_of_friction = w->contact[k].N;
    w->friction_passes++;
}

/* ------------------------------------------------------------- the open-close iteration: states */

/* Whether the projection of an open contact is on the edge, at the start of the step or at its end:
 * there the way from P3 is -d_s, and that from P2 the d_s of an anchor in P2. */
static int is_on_edge(const bbm_model *m, const bbm_contact *c)
{
    const bbm_touch t = touch_of(m, c);
    bbm_spring s;

    bbm_shear_vectors(&t, 1, &s);
    return !c->beyond_end || (c->d_s <= 0 && spring_length(m, c, &s) >= 0);
}

/* Whether the corner, as it is turned at the end of the step, can enter there. */
static int enters_at_end(const bbm_model *m, const bbm_contact *c)
{
    const double *Di = &m->D[6 * element_of(m, c->corner)], *Dj = &m->D[6 * element_of(m, c->edge)];

    return can_enter(m, c->corner, c->edge, Di[2] - Dj[2], PARALLEL);
}

/* Whether P may come in over its line, if it is crossed: not from behind; not beyond the end of the
 * edge from the start of the step to its end, unless it was closed and has not left. */
static int admits(const bbm_model *m, const bbm_contact *c)
{
    if (!c->was_closed && !c->inside && c->d_n0 < -bbm_allowed_depth(m, c->corner, c->edge))
        return 0;
    return (c->was_closed || is_on_edge(m, c)) && enters_at_end(m, c);
}

/* The fraction of the step at which P crosses a line; 0 for one that it starts on, or inside as
 * contacts are. */
static double crossed_at(const bbm_model *m, const bbm_contact *c)
{
    const double touch = touch_between(m, c->corner, c->edge);

    return c->d_n0 <= touch ? 0 : c->d_n0 / (c->d_n0 - c->d_n);
}

/* The sine by which a line is steep; one that rises to the right passes for flatter. */
static double steepness(bbm_direction p)
{
    return fabs(p.y) - ((p.x > 0) == (p.y > 0) ? PARALLEL : 0);
}

/* Whether of an open contact c and an entrance line r of it the line counts: it is closed, not
 * crossed, or crossed later, for the line crossed last is where P comes in. At the same time: the
 * one that was closed at the start of the step, or else the flatter one. */
static int counts(const bbm_model *m, const bbm_contact *r, const bbm_contact *c)
{
    const double later = crossed_at(m, r) - crossed_at(m, c);

    if (r->state != BBM_OPEN)
        return 1;
    if (r->d_n >= 0)
        return enters_at_end(m, r);
    if (fabs(later) > TIE)
        return later > 0 && admits(m, r);
    if (r->was_closed != c->was_closed)
        return r->was_closed && admits(m, r);
    return steepness(m->edge[r->edge].along) < steepness(m->edge[c->edge].along) && admits(m, r);
}

/* Whether an open contact, though crossed, may not close. */
static int is_blocked(const bbm_model *m, const bbm_contact *c)
{
    int blocked = !admits(m, c);

    for (int k = 0; k < 4 && !blocked; k++)
        blocked = c->entrance[k] >= 0 && counts(m, &m->scratch->contact[c->entrance[k]], c);
    return blocked;
}

/* A contact closes when P1 hits: at the fraction d0/(d0 - d_n) of the step, at which the distance
 * d0 has closed. It is anchored where it stood at the start, and its shear spring feels the share
 * of the slip that is left, so that it never pushes along. It starts as SLIDE where its springs
 * would be outside the cone of friction as P1 comes in, or when it closes for a second time in the
 * step: the shear spring of its first trial has opened it, and need not be there. */
static void change_state(const bbm_model *m, bbm_contact *c)
{
    const double d0 = fmax(0, c->d_n0), s = project(m, c->corner, c->edge).s;
    const int closes = c->state == BBM_OPEN;
    const double slip = closes ? c->d_s + s : c->T;

    if (closes) {
        c->time_left = 1 - d0 / (d0 - c->d_n);
        c->anchor = s / m->edge[c->edge].along.length;
        const bbm_parameters *p = bbm_strength_of(m, c);
        const double T = c->time_left * m->par.p_s * fabs(slip);
        const double N = -m->par.p_n * (c->d_n - fmin(0, c->rest));
        const int slides = ++c->closings > 1 || T > bbm_shear_strength(p, N, c->area);
        c->next_state = slides ? BBM_SLIDE : BBM_LOCK;
    }
    if (c->next_state == BBM_SLIDE) {
        c->sign = copysign(1, slip);
        c->N_of_friction = c->N;
    }
    c->state = c->next_state;
}

/* The state that a contact takes in the next pass. What is blocked stays open. A locked contact in
 * tension may have been pulled open by its shear spring: if that carries more than friction would
 * under as much pressure, the contact first slides, which takes the spring away - but not where
 * friction is a load of a static step: it would push the wrong way. */
static bbm_contact_state find_next_state(const bbm_model *m, const bbm_contact *c)
{
    const bbm_parameters *p = bbm_strength_of(m, c);
    const bbm_contact_state next = bbm_next_state(p, c, c->force_tolerance);
    const double strength = bbm_shear_strength(p, fabs(c->N), c->area);

    if (c->state == BBM_OPEN && next != BBM_OPEN && is_blocked(m, c))
        return BBM_OPEN;
    if (c->state == BBM_LOCK && next == BBM_OPEN && fabs(c->T) > strength && strength > 0
        && m->trial != BBM_FRICTION_A_LOAD)
        return BBM_SLIDE;
    return next;
}

/* By how much force the state of a contact does not fit the solution. */
static double misfit(const bbm_model *m, const bbm_contact *c)
{
    if (c->state == BBM_OPEN)
        return m->par.p_n * (c->rest - c->d_n);
    if (c->next_state == BBM_OPEN)
        return -c->N;
    return fabs(fabs(c->T) - bbm_shear_strength(bbm_strength_of(m, c), c->N, c->area));
}

/* Changes the states that do not fit the solution, all or the one that fits worst, which is the
 * same in any order of the blocks; the number of changes. */
static int change_states(bbm_model *m)
{
    bbm_contact_scratch *w = m->scratch;
    const int one = w->passes < w->one_until;
    bbm_contact *worst = NULL;
    int changes = 0;

    for (int k = 0; k < w->contacts; k++) {
        bbm_contact *c = &w->contact[k];
        c->next_state = find_next_state(m, c);
        if (c->next_state != c->state && (!worst || misfit(m, c) > misfit(m, worst)))
            worst = c;
    }
    for (int k = 0; k < w->contacts; k++) {
        bbm_contact *c = &w->contact[k];
        if (c->next_state == c->state || (one && c != worst))
            continue;
        change_state(m, c);
        changes++;
    }
    return changes;
}

/* Notes the states of this pass as one number (FNV-1a); if they have been there before, the
 * iteration cycles - but not if they are those of the last pass, after which only the vectors of
 * the step were renewed. */
static void note_states(bbm_contact_scratch *w)
{
    uint64_t hash = 14695981039346656037u;

    for (int k = 0; k < w->contacts; k++) {
        const double state = copysign(w->contact[k].state, w->contact[k].sign);
        hash = (hash ^ (uint64_t)(int64_t)state) * 1099511628211u;
    }
    for (int p = 0; p < w->passes; p++)
        if (w->seen[p] == hash && w->seen[w->passes - 1] != hash)
            w->one_until = 2 * w->passes;
    w->seen[w->passes] = hash;
}

/* The depth of a closed contact counts for both its bodies. */
static void note_depth(const bbm_model *m, const bbm_contact *c)
{
    motion *i = motion_of(m, c->corner), *j = motion_of(m, c->edge);
    const double depth = c->state == BBM_OPEN ? 0 : fabs(c->d_n);

    i->depth_now = fmax(i->depth_now, depth);
    j->depth_now = fmax(j->depth_now, depth);
}

/* One look at the solution: whether the friction forces belong to their N, then the states to the
 * forces, and the vectors of the step to the displacements - but not with a K that is kept. */
bbm_pass bbm_open_close(bbm_model *m)
{
    bbm_contact_scratch *w = m->scratch;

    m->info.passes++;
    for (int i = 0; i < m->elements; i++)
        w->motion[i].depth_now = w->motion[i].depth;
    for (int k = 0; k < w->contacts; k++) {
        measure(m, &w->contact[k]);
        note_depth(m, &w->contact[k]);
    }
    find_tolerances(m);
    if (!forces_agree(m)) {
        renew_friction(w);
        return w->friction_passes <= FRICTION_PASSES ? BBM_PASS_AGAIN : BBM_PASS_GIVE_UP;
    }
    w->friction_passes = 0;
    note_states(w);
    const int changes = change_states(m);
    const int renewed = !m->K_is_kept && m->hook.renew && m->hook.renew(m);
    if (!changes && !renewed)
        return BBM_PASS_DONE;
    return ++w->passes <= PASSES ? BBM_PASS_AGAIN : BBM_PASS_GIVE_UP;
}

/* ------------------------------------------------------------------------------ end of the step */

/* After the positions have moved: the anchor of a sliding contact follows, so that its spring
 * would carry the friction force; a joint that has opened, or slid against a shear strength, is
 * broken. */
static void store_contact(bbm_model *m, bbm_contact *c)
{
    const double strength = bbm_shear_strength(bbm_strength_of(m, c), c->N, c->area);

    note_depth(m, c);
    if (c->state == BBM_SLIDE)
        c->T = c->sign * strength;
    if (c->state == BBM_SLIDE || c->time_left < 1)
        place_anchor(m, c, c->T);
    if (c->state == BBM_OPEN || (c->state == BBM_SLIDE && strength > 0))
        c->area = 0;
    c->inside = c->state == BBM_OPEN && c->d_n < 0 && (c->was_closed || c->inside);
    if (c->state != BBM_OPEN) {
        m->info.contacts++;
        m->info.penetration = fmax(m->info.penetration, -c->d_n);
    }
}

/* The list of the step becomes that of the model. */
bbm_status bbm_store_contacts(bbm_model *m)
{
    bbm_contact_scratch *w = m->scratch;
    bbm_contact *last = m->contact;
    const int last_contacts = m->contacts;

    find_directions(m);
    m->info.contacts = 0;
    m->info.penetration = 0;
    for (int i = 0; i < m->elements; i++)
        w->motion[i].depth_now = 0;
    for (int k = 0; k < w->contacts; k++)
        store_contact(m, &w->contact[k]);
    for (int i = 0; i < m->elements; i++)
        w->motion[i].depth = w->motion[i].depth_now;
    m->contact = w->contact;
    m->contacts = w->contacts;
    w->contact = last;
    w->contacts = last_contacts;
    w->is_listed = 0;
    return BBM_OK;
}
