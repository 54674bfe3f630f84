/* contact.c - contacts between blocks: sections 3.7 and 3.8 of the paper, and the open-close iteration.
 *
 * Blocks touch where a vertex P1 of one meets an edge P2 P3 of another. A stiff spring p_n then resists penetration, a
 * spring p_s resists slip, and where Mohr and Coulomb's bound is passed, friction takes the place of p_s:
 *
 *                        d_n < 0                     |T| > N tan(phi) + c A
 *            .------.  ------------->  .------.  --------------------------->  .-------.
 *            | OPEN |                  | LOCK |                                | SLIDE |
 *            '------'  <-------------  '------'  <---------------------------  '-------'
 *                ^     N < -tension A               s T < N tan(phi) + c A         |
 *                '-----------------------------------------------------------------'
 *                                            N < 0
 *
 * N = -p_n d_n is the normal force, T = p_s d_s what the shear spring carries or would carry, s the sign of the slip, A
 * the contact's share of the area of an unbroken joint.
 * d_s counts from the anchor P0, a point of the edge's material: where P1 hit, and there it stays while the contact is
 * locked; while it slides, the anchor follows so that the spring would just carry the friction force of the last step.
 * What is left of s T above the bound is slip; when it turns against the friction, s T falls below the bound and the
 * contact locks with the force it had.
 *
 * A step reads (bbm_step): detect, assemble, solve, open-close - again until nothing changes - update.
 *
 * Detection. The boundary edges, in boxes widened by the search distance, are entered into a uniform grid; each corner
 * looks up its own cell. `corner` c is the vertex that starts boundary edge c, so that (corner, edge) are two indices
 * of edges: the identity of a contact. A corner may touch an edge if neither of its two sides points into it,
 * and if it does not lie behind it from the start: blocks do not overlap then, but for the depth of closed contacts.
 *
 * Where two corners P and Q meet, several of these pairs describe one contact. The lines along which P can enter are
 *
 *          \  P  /              |   A                   the two edges of Q (left), or one edge of each block (right).
 *           \   /               P______                 Two lines that differ are rivals: the blocks overlap when both
 *            \ /                 Q_____                 are crossed, and the spring goes on the one that is crossed
 *      _______Q                  |                      last, where P comes in. Two lines that coincide
 *             |                  |   B                  are one contact: of P on Q's edge and Q on P's edge that one
 *        B    |                  |                      stays whose foot lies on its edge; at a tie, the one that it
 *                                                       was before, or else the edge that faces up.
 * Both at the same time, the one that was closed or else the flatter line counts: the same in any order of the blocks.
 *
 * The iteration. N of a sliding contact depends on its friction and the friction on N. For given states that map is
 * affine (but see friction_force): its fixed point is found by conjugate residuals (agree), in few more solutions
 * than contacts slide, however badly the plain iteration N -> friction -> N converges. Only then are the states judged,
 * on forces that belong to them. When a set of states comes back that has been there before, the iteration would cycle:
 * from then on only the first contact that wants to change does so in each pass (Murty's rule of the least index), and
 * a contact that closes for a second time starts as SLIDE. Nothing of the model moves before all has settled: a step
 * that does not settle is done again with half the time step, without a trace of the first trial.
 *
 * Deviations from the paper: points and T at the middle of the step (beyond/middle.c); grid points inside the shorter of
 * two straight sides touch, too (carries), so that a deformable block rests on its whole side.
 */
#include "bbm.h"

#include <float.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* ------------------------------------------------------------------------------- 3.7.1 Normal submatrices */

/* The normal distance of P1 from P2 P3, positive outside. With the three points moved by T D, Eq. (48)-(50), and the
 * terms of second order dropped, d_n = S/l = S0/l + e.D_i + g.D_j, Eq. (52)-(57), (59):
 *     S0 = det [1 x1 y1; 1 x2 y2; 1 x3 y3],   e = T_i^T(P1) (y2 - y3, x3 - x2)/l,
 *     g = T_j^T(P2) (y3 - y1, x1 - x3)/l + T_j^T(P3) (y1 - y2, x2 - x1)/l.
 * Deviation: points and T of e and g at the middle of the step (beyond/middle.c); then only the change of l is dropped. */
void bbm_normal_vectors(const bbm_touch *c, bbm_spring *n)
{
    const double x1 = c->P1->x, y1 = c->P1->y, x2 = c->P2->x, y2 = c->P2->y, x3 = c->P3->x, y3 = c->P3->y;
    const double l = hypot(x3 - x2, y3 - y2);
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

/* A spring p over d = d0 + e.D_i + g.D_j, Pi = p/2 d^2, Eq. (51): K_ii += p e e^T, K_ij += p e g^T, K_jj += p g g^T,
 * F_i -= p d0 e, F_j -= p d0 g, Eq. (58), (63). */
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

/* Pi_n = p_n/2 d_n^2, Eq. (51)   ->   Eq. (58)-(59), (58a-f). Deviation: it counts from `rest`, see bbm_contact. */
void bbm_normal_submatrices(const bbm_touch *c, double p_n, bbm_submatrices *s)
{
    bbm_spring n;

    bbm_normal_vectors(c, &n);
    n.d -= c->rest;
    add_spring(p_n, &n, s);
}

/* -------------------------------------------------------------------------------- 3.7.2 Shear submatrices */

/* The displacement of P1 along the edge against its anchor P0, d_s = S1 + e.D_i + g.D_j, Eq. (48)-(50), (53), (60)-(62),
 *     m = (P3 - P2)/l,   S1 = (P1 - P0).m,   e = T_i^T(P1) m,   g = -T_j^T(P0) m,     Eq. (64), (67), (68).
 * The anchor is the point P0 = P3 + anchor (P2 - P3) of the edge's material. Deviation: at the middle of the step, and with
 * what (60) drops, the turning of m: (T3 - T2)^T (P1 - P0)/l in g. Without it friction does not keep angular momentum. */
void bbm_shear_vectors(const bbm_touch *c, double anchor, bbm_spring *s)
{
    const double x0 = c->P3->x + anchor * (c->P2->x - c->P3->x), y0 = c->P3->y + anchor * (c->P2->y - c->P3->y);
    const double l = hypot(c->P3->x - c->P2->x, c->P3->y - c->P2->y);
    double T1[2][6], T0[2][6], T2[2][6], T3[2][6], p1[2], p0[2], p2[2], p3[2];

    bbm_step_matrix(c->i, c->P1->x, c->P1->y, T1, p1);
    bbm_step_matrix(c->j, x0, y0, T0, p0);
    bbm_step_matrix(c->j, c->P2->x, c->P2->y, T2, p2);
    bbm_step_matrix(c->j, c->P3->x, c->P3->y, T3, p3);
    const double mx = (p3[0] - p2[0]) / l, my = (p3[1] - p2[1]) / l;
    const double ax = c->exact ? (p1[0] - p0[0]) / l : 0, ay = c->exact ? (p1[1] - p0[1]) / l : 0;
    s->d = ((c->P1->x - x0) * (c->P3->x - c->P2->x) + (c->P1->y - y0) * (c->P3->y - c->P2->y)) / l;
    for (int a = 0; a < 6; a++) {
        s->e[a] = T1[0][a] * mx + T1[1][a] * my;
        s->g[a] = -T0[0][a] * mx - T0[1][a] * my + (T3[0][a] - T2[0][a]) * ax + (T3[1][a] - T2[1][a]) * ay;
    }
}

/* Pi_s = p_s/2 d_s^2, Eq. (51)   ->   Eq. (63), (64). */
void bbm_shear_submatrices(const bbm_touch *c, double anchor, double p_s, bbm_submatrices *s)
{
    bbm_spring v;

    bbm_shear_vectors(c, anchor, &v);
    add_spring(p_s, &v, s);
}

/* ----------------------------------------------------------------------------- 3.8 Friction submatrices */

/* The friction force Fr, positive when P1 slips towards P3, Eq. (65): F_i -= Fr e, F_j -= Fr g, Eq. (66)-(69). */
void bbm_friction_submatrices(const bbm_touch *c, double anchor, double Fr, bbm_submatrices *s)
{
    bbm_spring v;

    bbm_shear_vectors(c, anchor, &v);
    for (int a = 0; a < 6; a++) {
        s->Fi[a] -= Fr * v.e[a];
        s->Fj[a] -= Fr * v.g[a];
    }
}

static double tan_friction(const bbm_parameters *p) { return tan(p->friction * acos(-1) / 180); }

/* Mohr and Coulomb: the largest shear force under the normal force N, Eq. (65) with cohesion on the joint's area.
 * A joint under tension has what is left of its cohesion. */
double bbm_shear_strength(const bbm_parameters *p, double N, double area)
{
    return fmax(0, N * tan_friction(p) + p->cohesion * area);
}

/* The transfer table of the figure above: the state that follows from d_n, N and T. Forces within `slack` agree. An
 * opening contact has none: a slack there would be a hidden tensile strength. */
bbm_contact_state bbm_next_state(const bbm_parameters *p, const bbm_contact *c, double slack)
{
    const double strength = bbm_shear_strength(p, c->N, c->area);

    if (c->state == BBM_OPEN)
        return -p->p_n * (c->d_n - c->rest) > slack ? BBM_LOCK : BBM_OPEN;
    if (c->N < (c->whole ? -p->tension * c->area : 0))
        return BBM_OPEN;
    if (p->friction == 0 && p->cohesion == 0)
        return BBM_SLIDE;
    if (c->state == BBM_LOCK)
        return fabs(c->T) > strength + slack ? BBM_SLIDE : BBM_LOCK;
    return c->sign * c->T < strength - slack ? BBM_LOCK : BBM_SLIDE;
}

/* ------------------------------------------------------------------------------------------ the data
 *
 * Tolerances; none depends on the size of the domain.
 * STRAIGHT [rad]  sides that differ less in direction at the start are one straight side, and sides
 *                 that differ less in length, relatively, are as long: rounding of a model file
 * PARALLEL [rad]  lines that differ less coincide, and a side that points into an edge by less lies
 *                 on it: what penetration and elastic bending turn
 * BENT     [rad]  the same for a side that was straight, at a grid point inside it that touches: soft
 *                 blocks bend more
 * TOUCH    [-]    gaps below this, in mean edge lengths, are closed at the start, and projections
 *                 closer to the end of an edge are at the end: rounding of a model file, elastic strain
 * AGREE    [-]    forces that differ by less, against the largest force of what K connects, agree:
 *                 what the solver can tell
 * TIE      [-]    fractions of a step that differ less are the same moment: rounding               */
#define STRAIGHT 1e-4
#define PARALLEL 1e-2
#define BENT 0.1
#define TOUCH 1e-6
#define AGREE 1e-9
#define TIE 1e-9

/* Passes that change states or renew the vectors of the step, and that change friction forces between
 * two of them; directions that `agree` remembers. */
enum { PASSES = 60, FORCES = 100, DIRECTIONS = 16 };

typedef struct { int corner, edge, dropped; } pair;             /* what may touch                   */

typedef struct {                /* around an edge, as wide as the search distance, and its corner   */
    double low[2], high[2], at[2];      /* m        [0] along the axis of the sweep                 */
    int edge;
} box;

typedef struct {                /* a block, with the number of its first element                    */
    double girth;               /* m        length of its boundary at the start                     */
    double depth;               /* m        |d_n| of its closed contacts, at most, before the step  */
    double depth_now;           /* m        the same of the solution, or before it if that was more */
    double travel;              /* m        how far its vertices may move in the step               */
    double moved;               /* m        how far they do                                         */
} body;

struct bbm_contact_work {
    double mean;                /* m        mean length of the boundary edges                       */
    double touch;               /* m        TOUCH times that of the start                           */
    int *body_of;               /* [elements]                                                       */
    body *body;                 /* [elements]                                                       */
    /* --- what may touch, in the making --- */
    double *guess;              /* [6 elements] D, as far as known before the solution              */
    box *box;                   /* [edges]                                                          */
    int pairs, pair_room;
    pair *pair;                 /* [pairs]  sorted by corner and edge                               */
    /* --- the contacts of the step --- */
    int listed;                 /* 0: not yet                                                       */
    int contacts;
    bbm_contact *contact;       /* [contacts], sorted like the pairs                                */
    int *part;                  /* [elements] an element of what K connects with it                 */
    double *force;              /* [elements] N, of a part: the largest one in it                   */
    /* --- the iteration --- */
    int passes, forces, single;
    uint64_t seen[PASSES + 1];  /* the states of each pass                                          */
    int directions, vector_room;
    double *x, *r;              /* [pairs]  the N that friction used; what the solution adds to it  */
    double *dx, *dr;            /* [(DIRECTIONS+1) pairs] changes of x, orthonormal changes of r    */
};

/* ---------------------------------------------------------------------- the boundary of the blocks */

static const bbm_vertex *start_of(const bbm_model *m, int e) { return &m->vertex[m->edge[e].a]; }
static const bbm_vertex *end_of(const bbm_model *m, int e) { return &m->vertex[m->edge[e].b]; }
static double cross(bbm_direction p, bbm_direction q) { return p.x * q.y - p.y * q.x; }

static body *body_of(const bbm_model *m, int e)
{
    return &m->work->body[m->work->body_of[m->edge[e].element]];
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

/* Directions and mean length of the present edges. */
static void find_directions(bbm_model *m)
{
    m->work->mean = 0;
    for (int e = 0; e < m->edges; e++) {
        const bbm_vertex *a = start_of(m, e), *b = end_of(m, e);
        const double x = b->x - a->x, y = b->y - a->y, l = hypot(x, y);
        m->edge[e].along = (bbm_direction){ x / l, y / l, l };
        m->work->mean += l / m->edges;
    }
}

/* Links each edge with the one that starts where it ends: from element to element round that node,
 * over the bonds, as far as they go. */
static bbm_status link_edges(bbm_model *m)
{
    int *across = malloc((size_t)m->vertices * sizeof *across);

    if (!across)
        return BBM_NO_MEMORY;
    for (int b = 0; b < m->bonds; b++) {            /* the side from a vertex on: its vertex beyond */
        across[m->bond[b].p[0]] = m->bond[b].q[0];
        across[m->bond[b].q[1]] = m->bond[b].p[1];
    }
    for (int e = 0; e < m->edges; e++) {
        int v = m->edge[e].b;
        while (m->vertex[v].edge < 0)
            v = across[v];
        m->edge[e].after = m->vertex[v].edge;
        m->edge[m->edge[e].after].before = e;
    }
    free(across);
    return BBM_OK;
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

static int compare_pairs(const void *p, const void *q)
{
    const pair *a = p, *b = q;
    const int d = (a->corner > b->corner) - (a->corner < b->corner);

    return d ? d : (a->edge > b->edge) - (a->edge < b->edge);
}

/* Finds the first element of each block. */
static void number_bodies(bbm_model *m)
{
    bbm_contact_work *w = m->work;
    pair *of = w->pair;                             /* block and element                            */

    for (int i = 0; i < m->elements; i++)
        of[i] = (pair){ m->element[i].block, i, 0 };
    qsort(of, (size_t)m->elements, sizeof *of, compare_pairs);
    for (int k = 0, first = 0; k < m->elements; k++) {
        first = of[k].corner == of[first].corner ? first : k;
        w->body_of[of[k].edge] = of[first].edge;
    }
}

void bbm_contact_free(bbm_contact_work *w)
{
    if (!w)
        return;
    free(w->body_of);
    free(w->body);
    free(w->guess);
    free(w->box);
    free(w->pair);
    free(w->contact);
    free(w->part);
    free(w->force);
    free(w->x);
    free(w->r);
    free(w->dx);
    free(w->dr);
    free(w);
}

bbm_status bbm_contact_new(bbm_model *m)
{
    const size_t n = (size_t)m->elements;
    bbm_contact_work *w = m->work = calloc(1, sizeof *w);

    if (!w)
        return BBM_NO_MEMORY;
    w->body_of = calloc(n, sizeof *w->body_of);
    w->body = calloc(n, sizeof *w->body);
    w->guess = calloc(6 * n, sizeof *w->guess);
    w->box = calloc((size_t)m->edges, sizeof *w->box);
    w->pair = calloc(n, sizeof *w->pair);
    w->part = calloc(n, sizeof *w->part);
    w->force = calloc(n, sizeof *w->force);
    if (!w->body_of || !w->body || !w->guess || !w->box || !w->pair || !w->part || !w->force
        || link_edges(m))
        return BBM_NO_MEMORY;
    w->pair_room = m->elements;
    number_bodies(m);
    find_directions(m);
    find_sides(m);
    w->touch = TOUCH * w->mean;
    for (int e = 0; e < m->edges; e++) {
        body_of(m, e)->girth += m->edge[e].along.length;
        body_of(m, e)->depth = m->info.penetration;     /* in a run contacts may be as deep as that */
    }
    return BBM_OK;
}

/* ---------------------------------------------------------------- detection: how far blocks may move */

/* What the velocities and gravity foretell of the step; in statics a step is as long as the last one
 * at most. */
void bbm_guess_step(bbm_model *m)
{
    const double h = m->h, fall[6] = { m->acceleration[0] * h * h / 2, m->acceleration[1] * h * h / 2 };

    for (int i = 0; i < m->elements; i++)
        for (int a = 0; a < 6; a++)
            m->work->guess[6 * i + a] = bbm_is_static(m) ? m->element[i].D[a] : m->element[i].V[a] * h + fall[a];
    m->work->listed = 0;
}

/* D as far as known before the solution, [6 elements]. */
const double *bbm_guess(const bbm_model *m)
{
    return m->work->guess;
}

/* How far the boundary of each body moves by D. */
static void find_moved(const bbm_model *m, const double D[])
{
    double u[2];

    for (int b = 0; b < m->elements; b++)
        m->work->body[b].moved = 0;
    for (int e = 0; e < m->edges; e++) {
        const bbm_vertex *p = start_of(m, e);
        body *b = body_of(m, e);
        bbm_move(m, &m->element[p->element], &D[6 * p->element], p->x, p->y, u);
        b->moved = fmax(b->moved, hypot(u[0], u[1]));
    }
}

/* Whether the solution moves further than the detection has foreseen; it then is the next guess. */
int bbm_moved_too_far(bbm_model *m)
{
    bbm_contact_work *w = m->work;
    int too_far = 0;

    find_moved(m, m->D);
    for (int i = 0; i < m->elements; i++) {
        const double turn = fabs(w->guess[6 * i + 2]);
        too_far |= w->body[i].moved > w->body[i].travel;
        too_far |= fabs(m->D[6 * i + 2]) > 2 * turn + PARALLEL / 2;
    }
    if (too_far)
        memcpy(w->guess, m->D, 6 * (size_t)m->elements * sizeof *w->guess);
    return too_far;
}

/* How far the bodies may move: a tenth more than the guess, or what rounding and a closed contact
 * give; and no less than what this step has foreseen before. Returns the largest way. */
static double foresee(bbm_model *m)
{
    double most = 0;

    find_moved(m, m->work->guess);
    for (int i = 0; i < m->elements; i++) {
        body *b = &m->work->body[i];
        const double way = 1.1 * b->moved + b->depth + m->work->touch / 2;
        b->depth_now = b->depth;
        b->travel = m->work->listed ? fmax(way, b->travel) : way;
        most = fmax(most, b->travel);
    }
    return most;
}

/* How far two blocks may approach each other in this step. */
static double approach(const bbm_model *m, int c, int e)
{
    return body_of(m, c)->travel + body_of(m, e)->travel;
}

/* How deep a vertex may lie behind an edge at the start of a step: as deep as closed contacts of the
 * two blocks do. Nothing comes in from behind. What moves by T of the start of a step may also end it
 * inside; and a corner that slides on along a straight side, which may be bent by now, keeps its
 * contact. */
static double behind(const bbm_model *m, int c, int e)
{
    const double depth = fmin(body_of(m, c)->depth, body_of(m, e)->depth);

    return 2 * depth + m->work->touch + (bbm_is_exact(m) ? 0 : approach(m, c, e));
}

/* ------------------------------------------------------------------ detection: who may touch whom */

typedef struct { double d, s, off; } projection;    /* of P1 on an edge: distance, way along it, how */
                                                    /* far beyond its ends                           */
static projection project(const bbm_model *m, int corner, int e)
{
    const bbm_vertex *P = start_of(m, corner), *a = start_of(m, e);
    const bbm_direction t = m->edge[e].along;
    const double x = P->x - a->x, y = P->y - a->y, s = x * t.x + y * t.y;

    return (projection){ x * t.y - y * t.x, s, fmax(-s, s - t.length) };
}

/* Neither side of the corner points into the edge, up to a slack, after its block has turned by r
 * against the edge's, and the block is convex there: it lies on the outside. Either end of a side may
 * be as deep as closed contacts are. A grid point inside a straight side may come to lie in a hollow
 * where that bends. */
static int can_enter(const bbm_model *m, int corner, int e, double r, double slack)
{
    const bbm_direction t = m->edge[e].along, q = m->edge[corner].along;
    const bbm_direction p = m->edge[m->edge[corner].before].along;
    const bbm_direction s = { t.x * cos(r) + t.y * sin(r), t.y * cos(r) - t.x * sin(r), 1 };
    const double deep = 2 * fmin(body_of(m, corner)->depth_now, body_of(m, e)->depth_now);

    if (!is_corner(m, corner))
        return fmin(cross(q, s), cross(s, p)) >= -BENT;
    return cross(q, s) >= -slack - deep / fmin(q.length, t.length)
        && cross(s, p) >= -slack - deep / fmin(p.length, t.length) && is_convex(m, corner);
}

/* Of two edges along p and q that face each other, whether the outward normal of the first,
 * (p.y, -p.x), is the one that points up, or if both are upright, to the right. */
static int faces_up(bbm_direction p, bbm_direction q)
{
    return (fabs(p.x - q.x) > PARALLEL ? p.x - q.x : q.y - p.y) < 0;
}

/* Whether the grid points inside the straight side of c touch the one of e, too (`faces`): those of
 * the shorter side do, of equal sides those of the upper one. They carry all of it; none comes or
 * goes while it slides on the longer. Deviation: with `faces` = 0 corners alone touch, and a block of
 * many elements sags between them. */
static int carries(const bbm_model *m, int c, int e)
{
    const bbm_direction p = m->edge[c].along, q = m->edge[e].along;
    const double mine = m->edge[m->edge[c].side].span, other = m->edge[m->edge[e].side].span;

    if (!m->par.faces || hypot(p.x + q.x, p.y + q.y) > 1)           /* they do not face each other */
        return 0;
    return fabs(mine - other) > STRAIGHT * other ? mine < other : faces_up(q, p);
}

/* The contact of the last step, closed or open inside, between `corner` and the edge - or, if `all`,
 * another one of its straight side - or NULL. */
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

/* Whether the corner may come to touch the edge in this step. If it is still outside it may also turn
 * there first, as when a side falls flat on an edge. */
static int may_touch(const bbm_model *m, int corner, int e)
{
    const double *D = m->work->guess;
    const double turns = fabs(D[6 * m->edge[corner].element + 2]) + fabs(D[6 * m->edge[e].element + 2]);
    const projection f = project(m, corner, e);

    if (m->edge[e].block == m->edge[corner].block || !(is_corner(m, corner) || carries(m, corner, e)))
        return 0;
    if (fmax(fabs(f.d), f.off) > approach(m, corner, e) + behind(m, corner, e))
        return 0;
    if (f.off <= m->work->touch && f.d < -behind(m, corner, e) && !find_closed(m, corner, e, 1))
        return 0;
    if (find_closed(m, corner, e, 0))
        return 1;
    return can_enter(m, corner, e, 0, f.d > 0 ? PARALLEL + 2 * turns : PARALLEL);
}

static int compare_boxes(const void *p, const void *q)
{
    const double a = ((const box *)p)->low[0], b = ((const box *)q)->low[0];

    return (a > b) - (a < b);
}

/* Lays the boxes round the edges and sorts them along the axis in which the model is longer. In one
 * that has blown up a place that is no number is far away. */
static void sort_boxes(bbm_model *m, double search)
{
    double least[2] = { DBL_MAX, DBL_MAX }, most[2] = { -DBL_MAX, -DBL_MAX };

    for (int v = 0; v < m->vertices; v++) {
        const double x[2] = { m->vertex[v].x, m->vertex[v].y };
        for (int k = 0; k < 2; k++) {
            least[k] = fmin(least[k], x[k]);
            most[k] = fmax(most[k], x[k]);
        }
    }
    const int axis = most[1] - least[1] > most[0] - least[0];
    for (int e = 0; e < m->edges; e++) {
        const double a[2] = { start_of(m, e)->x, start_of(m, e)->y };
        const double b[2] = { end_of(m, e)->x, end_of(m, e)->y };
        box *edge = &m->work->box[e];
        edge->edge = e;
        for (int k = 0; k < 2; k++) {
            edge->at[k] = a[k ^ axis];
            edge->low[k] = fmax(-DBL_MAX, fmin(a[k ^ axis], b[k ^ axis]) - search);
            edge->high[k] = fmin(DBL_MAX, fmax(a[k ^ axis], b[k ^ axis]) + search);
        }
    }
    qsort(m->work->box, (size_t)m->edges, sizeof *m->work->box, compare_boxes);
}

/* Adds the corner of one box and the edge of another to the pairs, if they may touch. */
static bbm_status add_pair(bbm_model *m, const box *c, const box *e)
{
    bbm_contact_work *w = m->work;

    if (c->at[0] < e->low[0] || c->at[0] > e->high[0] || c->at[1] < e->low[1] || c->at[1] > e->high[1])
        return BBM_OK;
    m->info.candidates++;
    if (!may_touch(m, c->edge, e->edge))
        return BBM_OK;
    if (w->pairs == w->pair_room) {
        pair *larger = realloc(w->pair, (2 * (size_t)w->pairs + 64) * sizeof *larger);
        if (!larger)
            return BBM_NO_MEMORY;
        w->pair = larger;
        w->pair_room = 2 * w->pairs + 64;
    }
    w->pair[w->pairs++] = (pair){ c->edge, e->edge, 0 };
    return BBM_OK;
}

/* All pairs that may touch: a sweep over the boxes meets each other one that begins before it ends. */
static bbm_status list_pairs(bbm_model *m, double search)
{
    const box *b = m->work->box;
    bbm_status status = BBM_OK;

    m->work->pairs = m->info.candidates = 0;
    sort_boxes(m, search);
    for (int i = 0; i < m->edges; i++)
        for (int j = i + 1; j < m->edges && !status && b[j].low[0] <= b[i].high[0]; j++)
            if (b[j].low[1] <= b[i].high[1] && b[j].high[1] >= b[i].low[1]) {
                status = add_pair(m, &b[i], &b[j]);
                status = status ? status : add_pair(m, &b[j], &b[i]);
            }
    qsort(m->work->pair, (size_t)m->work->pairs, sizeof *m->work->pair, compare_pairs);
    return status;
}

/* ----------------------------------------------------------------------- detection: where corners meet */

/* The place of a pair in the list in the making, or -1. */
static int find_pair(const bbm_contact_work *w, pair p)
{
    const pair *found = bsearch(&p, w->pair, (size_t)w->pairs, sizeof p, compare_pairs);

    return found ? (int)(found - w->pair) : -1;
}

/* What else there can be where the corner P of a pair meets an end Q of its edge: P on the next edge;
 * Q on that edge of P that lies on this one when the blocks are flush; Q on the other edge of P. */
typedef enum { NEXT, FLUSH, OTHER } meeting;

static pair meet(const bbm_model *m, pair p, int end, meeting kind)
{
    const int Q = end ? m->edge[p.edge].after : p.edge;

    if (kind == NEXT)
        return (pair){ p.corner, end ? Q : m->edge[Q].before, 0 };
    return (pair){ Q, (kind == FLUSH) == end ? p.corner : m->edge[p.corner].before, 0 };
}

/* Whether of two pairs that are one contact, p and what it meets, the other one stays. On a straight
 * side: if P comes before the end of that edge. Seen from both sides, when the edges coincide and P lies
 * at Q: the one that was closed, or else whose edge faces up. Of two corners, flush, just one has its
 * projection on the other's edge: the one stays. */
static int gives_way(const bbm_model *m, pair p, int end, meeting kind)
{
    const pair q = meet(m, p, end, kind);
    const int Q = end ? m->edge[p.edge].after : p.edge;

    if ((kind == NEXT ? is_corner(m, Q) : !coincide(m, p.edge, q.edge)) || find_pair(m->work, q) < 0)
        return 0;
    const projection f = project(m, p.corner, p.edge), g = project(m, q.corner, q.edge);
    const double lf = m->edge[p.edge].along.length, lg = m->edge[q.edge].along.length;
    if (kind == NEXT)
        return end ? f.s >= lf : g.s < lg;
    if (fmax(fabs(f.s - (end ? lf : 0)), fmax(fabs(f.off), fabs(g.off))) > m->work->touch)
        return kind == FLUSH && is_corner(m, p.corner) && is_corner(m, Q) && f.off > g.off;
    const int here = find_closed(m, p.corner, p.edge, 0) != NULL;
    const int there = find_closed(m, q.corner, q.edge, 0) != NULL;
    return here != there ? there : !faces_up(m->edge[p.edge].along, m->edge[q.edge].along);
}

/* Drops the pairs that another one stands for; all are judged on the full list. */
static void drop_duplicates(bbm_model *m)
{
    bbm_contact_work *w = m->work;
    int kept = 0;

    for (int k = 0; k < w->pairs; k++)
        for (int way = 0; way < 6; way++)
            w->pair[k].dropped |= gives_way(m, w->pair[k], way / 3, (meeting)(way % 3));
    for (int k = 0; k < w->pairs; k++)
        if (!w->pair[k].dropped)
            w->pair[kept++] = w->pair[k];
    w->pairs = kept;
}

/* Another line on which P and an end Q of its edge can enter each other, if both are convex corners
 * that may meet in this step and it is in the list; else -1. In a notch Q both edges hold P at once. */
static int find_rival(const bbm_model *m, pair p, int end, meeting kind)
{
    const pair other = meet(m, p, end, kind);
    const int Q = end ? m->edge[p.edge].after : p.edge;
    const bbm_vertex *a = start_of(m, p.corner), *b = start_of(m, Q);

    if (!is_convex(m, Q) || coincide(m, p.edge, other.edge))
        return -1;
    const double reach = approach(m, p.corner, p.edge) + behind(m, p.corner, p.edge);
    return hypot(a->x - b->x, a->y - b->y) > 2 * reach ? -1 : find_pair(m->work, other);
}

/* -------------------------------------------------------- detection: what carries over from step to step */

static bbm_touch touch_of(const bbm_model *m, const bbm_contact *c)
{
    const bbm_vertex *P1 = start_of(m, c->corner), *P2 = end_of(m, c->edge), *P3 = start_of(m, c->edge);

    return (bbm_touch){ &m->element[P1->element], &m->element[P2->element], P1, P2, P3, bbm_is_exact(m),
                        c->rest };
}

/* Puts the anchor where the shear spring carries the force T: (P1 - P0).m = T/p_s, m from P2 to P3. */
static void place_anchor(const bbm_model *m, bbm_contact *c, double T)
{
    const double s = project(m, c->corner, c->edge).s;

    c->anchor = (s + T / m->par.p_s) / m->edge[c->edge].along.length;
}

/* The closed contact of the last step that lives on in p: the same; one of the same corner with the
 * same straight side; or, where two corners have passed each other, that of the other corner if it is
 * no longer in the list. */
static const bbm_contact *find_ancestor(const bbm_model *m, pair p)
{
    const bbm_contact *old = find_closed(m, p.corner, p.edge, 1);

    for (int k = 0; k < 4 && !old; k++) {
        const pair q = meet(m, p, k / 2, k == 0 || k == 3 ? FLUSH : OTHER);
        if (coincide(m, p.edge, q.edge) && find_pair(m->work, q) < 0)
            old = find_closed(m, q.corner, q.edge, 0);
    }
    return old;
}

/* The last edge of the straight side of e. */
static int last_of(const bbm_model *m, int e)
{
    while (!is_corner(m, m->edge[e].after))
        e = m->edge[e].after;
    return e;
}

/* Area of the joint that P stands for, on which cohesion and tensile strength act: to both sides, as
 * far as its own side lies on the edge, half the way to the next point that touches - the next grid
 * point of the side that `carries`, or the end of either side. */
static double joint_area(const bbm_model *m, pair p)
{
    const bbm_edge *edge = m->edge;
    const double s = project(m, p.corner, p.edge).s;
    double length = 0;

    for (int k = 0; k < 2; k++) {
        const int mine = k ? p.corner : edge[p.corner].before;
        const int i = carries(m, mine, p.edge), j = carries(m, p.edge, mine);
        int a = k ? edge[i ? mine : last_of(m, mine)].after : i ? mine : edge[mine].side;
        int b = k ? (j ? p.edge : edge[p.edge].side) : edge[j ? p.edge : last_of(m, p.edge)].after;
        if (!coincide(m, mine, p.edge))
            continue;
        if (!is_corner(m, b) && fabs(project(m, b, p.edge).s - s) <= m->work->touch)
            b = k ? edge[b].before : edge[b].after;
        length += fmin(fabs(project(m, a, p.edge).s - s), fabs(project(m, b, p.edge).s - s)) / 2;
    }
    return length * fmin(m->element[edge[p.corner].element].material.thickness,
                         m->element[edge[p.edge].element].material.thickness);
}

/* A closed contact is free when P has left past a corner Q: a rival line on which they can enter each
 * other is open, or there is none and the projection is off the edge. */
static int has_left(const bbm_model *m, const bbm_contact *c)
{
    int rivals = 0;

    for (int k = 0; k < 4; k++) {
        if (c->rival[k] < 0)
            continue;
        const pair r = m->work->pair[c->rival[k]];
        if (project(m, r.corner, r.edge).d > 0 && can_enter(m, r.corner, r.edge, 0, PARALLEL))
            return 1;
        rivals++;
    }
    return c->off && rivals == 0;
}

/* Makes a pair a contact, with the state of the one that it continues. A projection beyond the end of
 * the edge is off it, but not in a notch, where it lies inside the block. A joint that touches at the
 * start is closed from the start in statics, or if it has a strength. */
static void make_contact(bbm_model *m, pair p, bbm_contact *c)
{
    const bbm_contact *old = m->contacts ? find_ancestor(m, p) : NULL;
    const projection f = project(m, p.corner, p.edge);
    const int strong = m->par.cohesion > 0 || m->par.tension > 0;
    const int start = m->info.step == 0 && m->info.t == 0;

    *c = (bbm_contact){ .corner = p.corner, .edge = p.edge, .gap = f.d, .share = 1 };
    if (old) {
        c->state = old->state, c->sign = old->sign, c->anchor = old->anchor, c->whole = old->whole;
        c->N = c->used = old->N, c->T = old->T, c->rest = old->rest;
        c->before = old->state != BBM_OPEN, c->inside = old->inside;
    } else if (start && fmax(fabs(f.d), f.off) <= m->work->touch) {
        c->whole = 1;
        c->state = strong || bbm_is_static(m) ? BBM_LOCK : BBM_OPEN;
    }
    for (int k = 0; k < 4; k++)
        c->rival[k] = find_rival(m, p, k / 2, k % 2 ? FLUSH : NEXT);
    c->off = f.off > m->work->touch && is_convex(m, f.s < 0 ? p.edge : m->edge[p.edge].after);
    c->area = strong && c->whole ? joint_area(m, p) : 0;
    if (c->state != BBM_OPEN && has_left(m, c))
        c->state = BBM_OPEN, c->N = c->T = 0, c->before = 0;
    c->inside = c->inside && !has_left(m, c);
    if (!old || c->state == BBM_OPEN || old->corner != p.corner || old->edge != p.edge) {
        place_anchor(m, c, c->T);
        c->rest = bbm_is_exact(m) ? fmin(0, c->gap + c->N / m->par.p_n) : 0;
    }
}

/* Whether the list of this step has the pairs that were found once more. */
static int is_same_list(const bbm_contact_work *w)
{
    int same = w->listed && w->contacts == w->pairs;

    for (int k = 0; k < w->pairs && same; k++)
        same = w->contact[k].corner == w->pair[k].corner && w->contact[k].edge == w->pair[k].edge;
    return same;
}

/* Lists the contacts that may be closed in this step, from the present positions and the contacts of
 * the last step, which stay as they are; `same` (may be NULL): the list of this step had these pairs
 * already. */
bbm_status bbm_detect_contacts(bbm_model *m, int *same)
{
    bbm_contact_work *w = m->work;

    find_directions(m);
    for (int e = 0; e < m->edges; e++)
        m->edge[e].contact = m->contacts;
    for (int k = m->contacts - 1; k >= 0; k--)
        m->edge[m->contact[k].corner].contact = k;
    const bbm_status status = list_pairs(m, 9 * foresee(m));
    if (!status)
        drop_duplicates(m);
    const int known = !status && is_same_list(w);
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
    w->listed = 1;
    bbm_join_elements(m, w->part);
    w->passes = w->forces = w->single = w->directions = 0;
    return BBM_OK;
}

/* Detects them again, with those locked that slid, by the force that their friction had; from now on
 * one state changes in each pass. */
bbm_status bbm_start_again(bbm_model *m)
{
    bbm_contact_work *w = m->work;
    w->listed = 0;
    const bbm_status status = bbm_detect_contacts(m, NULL);

    for (int k = 0; k < w->contacts && !status; k++)
        if (w->contact[k].state == BBM_SLIDE)
            w->contact[k].state = BBM_LOCK;
    w->single = 1;
    return status;
}

/* ------------------------------------------------------------------------------------------ assembly */

/* The contacts of the step in hand. */
bbm_contact *bbm_list_contacts(const bbm_model *m, int *contacts)
{
    *contacts = m->work->contacts;
    return m->work->contact;
}

int bbm_contact_count(const bbm_model *m)
{
    return m->work->contacts;
}

/* The elements of contact k. */
void bbm_contact_pair(const bbm_model *m, int k, int elements[2])
{
    elements[0] = m->edge[m->work->contact[k].corner].element;
    elements[1] = m->edge[m->work->contact[k].edge].element;
}

/* The element of a contact's corner. */
static int element_of(const bbm_model *m, const bbm_contact *c) { return m->edge[c->corner].element; }

/* The friction of a sliding contact under the N of the last solution. It goes on below N = 0, where the strength ends,
 * unless the joint is whole and may be in tension: such a contact opens when it is judged, and until then N depends on
 * N without a kink (agree). */
static double friction_force(const bbm_parameters *p, const bbm_contact *c)
{
    return c->sign * (c->area > 0 ? bbm_shear_strength(p, c->used, c->area) : c->used * tan_friction(p));
}

/* The springs of a closed contact, Eq. (58) and (63), or spring and friction, Eq. (65), (69). */
static bbm_status assemble_contact(bbm_model *m, const bbm_contact *c)
{
    const bbm_touch t = touch_of(m, c);
    const int i = m->edge[c->corner].element, j = m->edge[c->edge].element;
    bbm_submatrices s = { { { 0 } }, { { 0 } }, { { 0 } }, { 0 }, { 0 } };

    bbm_normal_submatrices(&t, m->par.p_n, &s);
    if (c->state == BBM_LOCK)
        bbm_shear_submatrices(&t, c->anchor, c->share * m->par.p_s, &s);
    else
        bbm_friction_submatrices(&t, c->anchor, friction_force(&m->par, c), &s);
    return bbm_add_submatrices(m, i, j, &s);
}

bbm_status bbm_assemble_contacts(bbm_model *m)
{
    bbm_status status = BBM_OK;

    for (int k = 0; k < m->work->contacts && !status; k++)
        if (m->work->contact[k].state != BBM_OPEN)
            status = assemble_contact(m, &m->work->contact[k]);
    return status;
}

/* ---------------------------------------------------------------- the open-close iteration: distances */

/* d = d0 + e.D_i + g.D_j of the solution, Eq. (57), (61). */
static double spring_length(const bbm_model *m, const bbm_contact *c, const bbm_spring *v)
{
    const double *Di = &m->D[6 * m->edge[c->corner].element], *Dj = &m->D[6 * m->edge[c->edge].element];
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
    bbm_spring n, s;

    if (c->state == BBM_OPEN)
        c->anchor = 0, c->share = 1;
    bbm_normal_vectors(&t, &n);
    bbm_shear_vectors(&t, c->anchor, &s);
    c->d_n = spring_length(m, c, &n);
    c->d_s = c->share * spring_length(m, c, &s);
    c->N = c->state == BBM_OPEN ? 0 : -m->par.p_n * (c->d_n - c->rest);
    c->T = c->state == BBM_OPEN ? 0 : m->par.p_s * c->d_s;
}

/* The largest force in each part of K: on an element, inertia included, or in a contact. What the
 * solver leaves as its residual, and so in every N of the part, is small against this and nothing else. */
static void find_forces(const bbm_model *m)
{
    const bbm_contact_work *w = m->work;

    memset(w->force, 0, (size_t)m->elements * sizeof *w->force);
    for (int i = 0; i < m->elements; i++)
        w->force[w->part[i]] = fmax(w->force[w->part[i]], hypot(m->F[6 * i], m->F[6 * i + 1]));
    for (int k = 0; k < w->contacts; k++) {
        double *F = &w->force[w->part[element_of(m, &w->contact[k])]];
        *F = fmax(*F, fabs(w->contact[k].N));
    }
    for (int k = 0; k < w->contacts; k++)
        w->contact[k].tolerance = AGREE * w->force[w->part[element_of(m, &w->contact[k])]];
}

/* The closed contact that is deepest against the size of its smaller block, a quarter of its boundary; returns that share,
 * or 0 if none is closed. */
double bbm_deepest_contact(const bbm_model *m, const bbm_contact **deepest)
{
    const bbm_contact_work *w = m->work;
    double most = 0;

    for (int k = 0; k < w->contacts; k++) {
        const bbm_contact *c = &w->contact[k];
        const double share = -c->d_n / (fmin(body_of(m, c->corner)->girth, body_of(m, c->edge)->girth) / 4);
        if (c->state != BBM_OPEN && share > most) {
            most = share;
            *deepest = c;
        }
    }
    return most;
}

/* ------------------------------------------------------------------- the open-close iteration: friction */

/* Room for the vectors of `agree`. */
static int vectors_fit(bbm_contact_work *w)
{
    const size_t n = (size_t)w->contacts;

    if (w->contacts <= w->vector_room)
        return 1;
    free(w->x), free(w->r), free(w->dx), free(w->dr);
    w->x = calloc(n, sizeof *w->x);
    w->r = calloc(n, sizeof *w->r);
    w->dx = calloc(n * (DIRECTIONS + 1), sizeof *w->dx);
    w->dr = calloc(n * (DIRECTIONS + 1), sizeof *w->dr);
    w->vector_room = w->x && w->r && w->dx && w->dr ? w->contacts : 0;
    return w->vector_room > 0;
}

/* Takes from (dr, dx) what the directions before `d` account for. */
static void remove_directions(const bbm_contact_work *w, int d, double dr[], double dx[])
{
    for (int q = 0; q < d; q++) {
        double a = 0;
        for (int k = 0; k < w->contacts; k++)
            a += dr[k] * w->dr[q * w->contacts + k];
        for (int k = 0; k < w->contacts; k++) {
            dr[k] -= a * w->dr[q * w->contacts + k];
            dx[k] -= a * w->dx[q * w->contacts + k];
        }
    }
}

/* The last change of x, and the change of r that it made, become a direction: in r orthonormal to the others. */
static void learn_direction(bbm_contact_work *w)
{
    double *dx = &w->dx[w->directions * w->contacts], *dr = &w->dr[w->directions * w->contacts], size = 0;

    for (int k = 0; k < w->contacts; k++) {
        const bbm_contact *c = &w->contact[k];
        const int slides = c->state == BBM_SLIDE;
        dx[k] = slides ? c->used - w->x[k] : 0;
        dr[k] = slides ? c->N - c->used - w->r[k] : 0;
    }
    remove_directions(w, w->directions, dr, dx);
    for (int k = 0; k < w->contacts; k++)
        size += dr[k] * dr[k];
    if (size == 0)
        return;
    for (int k = 0; k < w->contacts; k++) {
        dx[k] /= sqrt(size);
        dr[k] /= sqrt(size);
    }
    w->directions++;
}

/* The next N for the friction of the sliding contacts, by conjugate residuals. With x the N that friction used and
 * r = N - x of the solution, r is affine in x as long as no state changes. Move x so that the known directions remove
 * of r what they can, and by the rest of r, which makes a new direction. */
static bbm_status agree(bbm_contact_work *w)
{
    if (!vectors_fit(w))
        return BBM_NO_MEMORY;
    if (w->directions == DIRECTIONS)
        w->directions = 0;
    if (w->forces++ > 0)
        learn_direction(w);
    for (int k = 0; k < w->contacts; k++) {
        const bbm_contact *c = &w->contact[k];
        w->x[k] = c->used;
        w->r[k] = c->state == BBM_SLIDE ? c->N - c->used : 0;
    }
    double *dr = &w->dr[w->directions * w->contacts], *dx = &w->dx[w->directions * w->contacts];
    memcpy(dr, w->r, (size_t)w->contacts * sizeof *dr);
    memset(dx, 0, (size_t)w->contacts * sizeof *dx);
    remove_directions(w, w->directions, dr, dx);
    for (int k = 0; k < w->contacts; k++)
        if (w->contact[k].state == BBM_SLIDE)
            w->contact[k].used = w->x[k] + dx[k] + dr[k];
    return BBM_OK;
}

/* Whether every friction force belongs to its N. */
static int forces_agree(const bbm_model *m)
{
    const bbm_contact_work *w = m->work;

    for (int k = 0; k < w->contacts && m->par.friction > 0; k++) {
        const bbm_contact *c = &w->contact[k];
        if (c->state == BBM_SLIDE && fabs(c->N - c->used) > c->tolerance)
            return 0;
    }
    return 1;
}

/* --------------------------------------------------------------------- the open-close iteration: states */

/* Whether the projection of an open contact is on the edge, at the start of the step or at its end:
 * there the way from P3 is -d_s, and that from P2 the d_s of an anchor in P2. */
static int is_on_edge(const bbm_model *m, const bbm_contact *c)
{
    const bbm_touch t = touch_of(m, c);
    bbm_spring s;

    bbm_shear_vectors(&t, 1, &s);
    return !c->off || (c->d_s <= 0 && spring_length(m, c, &s) >= 0);
}

/* Whether the corner, as it is turned at the end of the step, can enter there. */
static int enters_at_end(const bbm_model *m, const bbm_contact *c)
{
    const double *Di = &m->D[6 * m->edge[c->corner].element], *Dj = &m->D[6 * m->edge[c->edge].element];

    return can_enter(m, c->corner, c->edge, Di[2] - Dj[2], PARALLEL);
}

/* Whether P may come in over its line, if it is crossed: not from behind; not beyond the end of the
 * edge from the start of the step to its end, unless it was closed and has not left. */
static int admits(const bbm_model *m, const bbm_contact *c)
{
    return (c->before || c->inside || c->gap >= -behind(m, c->corner, c->edge))
        && (c->before || is_on_edge(m, c)) && enters_at_end(m, c);
}

/* The fraction of the step at which P crosses a line; 0 for one that it starts on, or inside as
 * contacts are. */
static double crossed_at(const bbm_model *m, const bbm_contact *c)
{
    return c->gap <= m->work->touch ? 0 : c->gap / (c->gap - c->d_n);
}

/* The sine by which a line is steep; one that rises to the right passes for flatter. */
static double steepness(bbm_direction p)
{
    return fabs(p.y) - ((p.x > 0) == (p.y > 0) ? PARALLEL : 0);
}

/* Which of two lines counts, of an open contact c and an entrance line r of it: r, if it is closed, is
 * not crossed, or is crossed later: the line crossed last is where P comes in. At the same time: the one
 * that was closed at the start of the step, or else the flatter one. */
static int counts(const bbm_model *m, const bbm_contact *r, const bbm_contact *c)
{
    const double later = crossed_at(m, r) - crossed_at(m, c);

    if (r->state != BBM_OPEN)
        return 1;
    if (r->d_n >= 0)
        return enters_at_end(m, r);
    if (fabs(later) > TIE)
        return later > 0 && admits(m, r);
    if (r->before != c->before)
        return r->before && admits(m, r);
    return steepness(m->edge[r->edge].along) < steepness(m->edge[c->edge].along) && admits(m, r);
}

/* Whether an open contact, though crossed, may not close. */
static int is_blocked(const bbm_model *m, const bbm_contact *c)
{
    int blocked = !admits(m, c);

    for (int k = 0; k < 4 && !blocked; k++)
        blocked = c->rival[k] >= 0 && counts(m, &m->work->contact[c->rival[k]], c);
    return blocked;
}

/* A contact closes when P1 hits: at the fraction d0/(d0 - d_n) of the step, at which the gap d0 has closed. Its shear
 * spring feels the share of the slip that is left, so that it never pushes along. Returns the way of P1 along the edge in
 * the step, towards P3. */
static double anchor_at_hit(const bbm_model *m, bbm_contact *c)
{
    const double gap = fmax(0, c->gap), s = project(m, c->corner, c->edge).s;

    c->share = 1 - gap / (gap - c->d_n);
    c->anchor = s / m->edge[c->edge].along.length;
    return c->d_s + s;
}

/* A contact that closes for a second time in a step was opened by the shear spring of its first trial, which need not
 * be there: it tries to slide. */
static void change_state(const bbm_model *m, bbm_contact *c)
{
    const double slip = c->state == BBM_OPEN ? anchor_at_hit(m, c) : c->T;

    if (c->state == BBM_OPEN && ++c->closings > 1)
        c->next = BBM_SLIDE;
    if (c->next == BBM_SLIDE) {
        c->sign = copysign(1, slip);
        c->used = c->N;
    }
    c->state = c->next;
}

/* Changes the states that do not fit the solution, all or the first of them; the number of changes. */
static int change_states(bbm_model *m)
{
    bbm_contact_work *w = m->work;
    int changes = 0;

    for (int k = 0; k < w->contacts; k++) {
        bbm_contact *c = &w->contact[k];
        c->next = bbm_next_state(&m->par, c, c->tolerance);
        if (c->state == BBM_OPEN && c->next != BBM_OPEN && is_blocked(m, c))
            c->next = BBM_OPEN;
    }
    for (int k = 0; k < w->contacts && !(w->single && changes); k++)
        if (w->contact[k].next != w->contact[k].state) {
            change_state(m, &w->contact[k]);
            changes++;
        }
    return changes;
}

/* Notes the states of this pass as one number (FNV-1a); if they have been there before, the iteration cycles - but not
 * if they are those of the last pass, after which only the vectors of the step were renewed. */
static void watch_for_cycles(bbm_contact_work *w)
{
    uint64_t hash = 14695981039346656037u;

    for (int k = 0; k < w->contacts; k++)
        hash = (hash ^ ((uint64_t)(int64_t)copysign(w->contact[k].state, w->contact[k].sign))) * 1099511628211u;
    for (int p = 0; p < w->passes; p++)
        if (w->seen[p] == hash && w->seen[w->passes - 1] != hash)
            w->single = 1;
    w->seen[w->passes] = hash;
}

/* How deep a contact is. */
static double depth_of(const bbm_contact *c)
{
    return c->state == BBM_OPEN ? 0 : fabs(c->d_n);
}

/* One look at the solution: whether the friction forces belong to their N, then the states to the forces, and the vectors
 * of the step to the displacements - but not in a round of multipliers, which keeps K. */
bbm_status bbm_open_close(bbm_model *m, bbm_pass *pass)
{
    bbm_contact_work *w = m->work;

    m->info.passes++;
    for (int b = 0; b < m->elements; b++)
        w->body[b].depth_now = w->body[b].depth;
    for (int k = 0; k < w->contacts; k++) {
        bbm_contact *c = &w->contact[k];
        body *i = body_of(m, c->corner), *j = body_of(m, c->edge);
        measure(m, c);
        i->depth_now = fmax(i->depth_now, depth_of(c));
        j->depth_now = fmax(j->depth_now, depth_of(c));
    }
    find_forces(m);
    if (!forces_agree(m)) {
        *pass = w->forces < FORCES ? BBM_PASS_AGAIN : BBM_PASS_GIVE_UP;
        return agree(w);
    }
    w->forces = w->directions = 0;
    watch_for_cycles(w);
    const int changes = change_states(m), off = !m->K_is_kept && m->hook.renew && m->hook.renew(m);
    if (!changes && !off)
        *pass = BBM_PASS_DONE;
    else
        *pass = ++w->passes <= PASSES ? BBM_PASS_AGAIN : BBM_PASS_GIVE_UP;
    return BBM_OK;
}

/* ------------------------------------------------------------------------------------------- end of the step */

/* After the positions have moved: the anchor of a sliding contact follows, so that its spring would carry the friction
 * force; a joint that has opened, or slid against a shear strength, is broken; the list becomes that of the model. */
bbm_status bbm_keep_contacts(bbm_model *m)
{
    bbm_contact_work *w = m->work;
    bbm_contact *last = m->contact;
    const int last_contacts = m->contacts;

    find_directions(m);
    m->info.contacts = 0;
    m->info.penetration = 0;
    for (int b = 0; b < m->elements; b++)
        w->body[b].depth = 0;
    for (int k = 0; k < w->contacts; k++) {
        bbm_contact *c = &w->contact[k];
        body *i = body_of(m, c->corner), *j = body_of(m, c->edge);
        const double strength = bbm_shear_strength(&m->par, c->N, c->area);
        c->whole = c->whole && (c->state == BBM_LOCK || (c->state == BBM_SLIDE && strength == 0));
        c->inside = c->state == BBM_OPEN && c->d_n < 0 && (c->before || c->inside);
        if (c->state == BBM_SLIDE)
            c->T = c->sign * strength;
        if (c->state == BBM_SLIDE || c->share < 1)
            place_anchor(m, c, c->T);
        i->depth = fmax(i->depth, depth_of(c));
        j->depth = fmax(j->depth, depth_of(c));
        if (c->state != BBM_OPEN) {
            m->info.contacts++;
            m->info.penetration = fmax(m->info.penetration, -c->d_n);
        }
    }
    m->contact = w->contact;
    m->contacts = w->contacts;
    w->contact = last;
    w->contacts = last_contacts;
    w->listed = 0;
    return BBM_OK;
}
