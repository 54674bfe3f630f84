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

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* --- tolerances; none depends on the size of the domain ---
 * STRAIGHT [rad]  sides that differ less in direction at the start are one straight side, and sides that differ less
 *                 in length, relatively, are as long: rounding of a model file
 * PARALLEL [rad]  lines that differ less coincide, and a side that points into an edge by less lies on it: what
 *                 penetration and elastic bending turn
 * BENT     [rad]  the same for a side that was straight, at a grid point inside it that touches: soft blocks bend more
 * TOUCH    [-]    gaps below this, in mean edge lengths, are closed at the start, and feet closer to the end of
 *                 an edge are at the end: rounding of a model file, elastic strain
 * AGREE    [-]    forces that differ by less, against the largest force of what K connects, agree: what the solver can
 *                 tell
 * DIRECTION [rad] of a contact's force, which is left: what it does to the angular momentum is 1e-5 of that
 * TIE      [-]    fractions of a step that differ less are the same moment: rounding                                */
#define STRAIGHT 1e-4
#define PARALLEL 1e-2
#define BENT 0.1
#define TOUCH 1e-6
#define AGREE 1e-9
#define TIE 1e-9
#define DIRECTION 1e-4

#define FAR 1e15        /* cells of the grid */

/* Places of the grid for each edge, 4 x 4; directions that `agree` remembers; passes that change states or renew
 * the vectors of the step, and that change forces between two of them. */
enum { PLACES = 16, DIRECTIONS = 16, PASSES = 60, FORCES = 100 };

typedef struct { double x, y, length; } direction;              /* unit vector along an edge                     */
typedef struct { int corner, edge; } pair;
typedef struct { int edge, next; } entry;

struct bbm_contact_work {
    /* --- the boundary, [edges]; the block lies on the left of an edge --- */
    int *before, *after;        /* neighbours along the boundary                                                */
    int *side, *last;           /* first and last edge of the straight side that the edge belongs to            */
    double *span;               /* m        length of that side at the start                                    */
    direction *along;           /* of the present positions                                                     */
    double mean;                /* m        their mean length                                                   */
    double touch;               /* m        TOUCH times that of the start                                       */
    /* --- what the step may do --- */
    double *guess;              /* [6 elements] D, as far as known before the solution                          */
    int *part;                  /* [elements] an element of what K connects with it                             */
    double *force;              /* [elements] N, of a part: the largest force on its elements and in its contacts */
    int *body;                  /* [edges]  the first boundary edge of the same block                           */
    double *girth;              /* [edges]  m, of a body: length of its boundary at the start                   */
    double *depth;              /* [edges]  m, of a body: |d_n| of its closed contacts, at most, before the step */
    double *now;                /* [edges]  m, the same of the solution, or of the start if that is deeper      */
    double *travel;             /* [edges]  m, of a body: how far its vertices may move in the step             */
    double *moved;              /* [edges]  m, the same of the solution                                         */
    double search;              /* m        vertices further from an edge do not reach it, in any block         */
    /* --- the grid --- */
    double cell;                /* m        width of its cells                                                  */
    int *head;                  /* [PLACES edges] the last entry of each place, or -1                           */
    entry *entries;
    int entered, entry_room;
    /* --- the list in the making, sorted by corner and edge --- */
    int pairs, pair_room, list_room;
    pair *pairs_of;             /* [pairs]                                                                      */
    int *first, *old;           /* [edges+1] those of corner c are pairs_of[first[c] ..]; in the model's list,  */
                                /*           of the last step, contact[old[c] ..]                               */
    bbm_contact *list;          /* [listed]                                                                     */
    int listed;                 /* -1: no list of this step yet                                                 */
    /* --- the iteration --- */
    int passes, forces, single;
    uint64_t seen[PASSES + 1];  /* the states of each pass                                                      */
    int directions, vector_room;
    double *x, *r;              /* [pairs]  the N that friction used; what the solution adds to it              */
    double *dx, *dr;            /* [(DIRECTIONS+1) pairs] changes of x, and the orthonormal changes of r        */
};

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

/* ------------------------------------------------------------------------- the boundary of the blocks, once */

static const bbm_vertex *start_of(const bbm_model *m, int e) { return &m->vertex[m->edge[e].a]; }
static const bbm_vertex *end_of(const bbm_model *m, int e) { return &m->vertex[m->edge[e].b]; }
static double cross(direction p, direction q) { return p.x * q.y - p.y * q.x; }

/* A vertex inside a straight side is no corner. */
static int is_corner(const bbm_contact_work *w, int c) { return w->side[c] == c; }

/* Less than 180 degrees inside, or straight. */
static int is_convex(const bbm_contact_work *w, int c)
{
    return cross(w->along[w->before[c]], w->along[c]) > -PARALLEL;
}

/* Directions and mean length of the present edges. */
static void find_directions(bbm_model *m)
{
    bbm_contact_work *w = m->work;

    w->mean = 0;
    for (int e = 0; e < m->edges; e++) {
        const double x = end_of(m, e)->x - start_of(m, e)->x, y = end_of(m, e)->y - start_of(m, e)->y, l = hypot(x, y);
        w->along[e] = (direction){ x / l, y / l, l };
        w->mean += l / m->edges;
    }
}

/* The boundary edge that ends where e starts; ends[v] is that which ends in vertex v, or -1. Where the boundary of a
 * block touches itself there are several: the right one leaves the smallest angle inside, it turns the most. */
static int find_before(const bbm_model *m, const int ends[], int e)
{
    const int node = start_of(m, e)->node;
    const direction q = m->work->along[e];
    double most = -INFINITY;
    int found = e;

    for (int a = m->adjacent_first[node]; a < m->adjacent_first[node + 1]; a++) {
        const int f = ends[m->adjacent[a]];
        if (f < 0 || m->edge[f].block != m->edge[e].block)
            continue;
        const direction p = m->work->along[f];
        const double turn = atan2(cross(p, q), p.x * q.x + p.y * q.y);
        if (turn > most) {
            most = turn;
            found = f;
        }
    }
    return found;
}

/* Whether edge e goes straight on from the one before it. */
static int goes_on(const bbm_contact_work *w, int e)
{
    const direction p = w->along[w->before[e]], q = w->along[e];

    return hypot(q.x - p.x, q.y - p.y) < STRAIGHT;
}

static void link_edges(bbm_model *m, int ends[])
{
    bbm_contact_work *w = m->work;

    find_directions(m);
    for (int v = 0; v < m->vertices; v++)
        ends[v] = -1;
    for (int e = 0; e < m->edges; e++)
        ends[m->edge[e].b] = e;
    for (int e = 0; e < m->edges; e++) {
        w->before[e] = find_before(m, ends, e);
        w->after[w->before[e]] = e;
    }
    w->touch = TOUCH * w->mean;
    for (int e = 0; e < m->edges; e++)
        w->side[e] = w->last[e] = e;
    for (int e = 0; e < m->edges; e++) {
        for (int f = w->after[e]; !goes_on(w, e) && f != e && goes_on(w, f); f = w->after[f])
            w->side[f] = e, w->last[e] = f;
    }
    for (int e = 0; e < m->edges; e++)
        w->last[e] = w->last[w->side[e]];
    for (int e = 0; e < m->edges; e++) {
        const bbm_vertex *a = start_of(m, w->side[e]), *b = end_of(m, w->last[e]);
        w->span[e] = hypot(b->x - a->x, b->y - a->y);
    }
}

static int compare_pairs(const void *a, const void *b)
{
    const pair *p = a, *q = b;
    const int d = (p->corner > q->corner) - (p->corner < q->corner);

    return d ? d : (p->edge > q->edge) - (p->edge < q->edge);
}

/* Finds the first boundary edge of each block; 0: no memory. */
static int number_bodies(bbm_model *m)
{
    pair *of = calloc((size_t)m->edges, sizeof *of);                        /* block and edge */

    if (!of)
        return 0;
    for (int e = 0; e < m->edges; e++)
        of[e] = (pair){ m->edge[e].block, e };
    qsort(of, (size_t)m->edges, sizeof *of, compare_pairs);
    for (int k = 0, first = 0; k < m->edges; k++) {
        first = of[k].corner == of[first].corner ? first : k;
        m->work->body[of[k].edge] = of[first].edge;
    }
    free(of);
    return 1;
}

void bbm_contact_free(bbm_contact_work *w)
{
    if (!w)
        return;
    free(w->before);
    free(w->after);
    free(w->side);
    free(w->last);
    free(w->span);
    free(w->along);
    free(w->guess);
    free(w->part);
    free(w->force);
    free(w->body);
    free(w->girth);
    free(w->depth);
    free(w->now);
    free(w->travel);
    free(w->moved);
    free(w->head);
    free(w->entries);
    free(w->pairs_of);
    free(w->first);
    free(w->old);
    free(w->list);
    free(w->x);
    free(w->r);
    free(w->dx);
    free(w->dr);
    free(w);
}

bbm_status bbm_contact_new(bbm_model *m)
{
    const size_t n = (size_t)m->edges;
    int *ends = calloc((size_t)m->vertices, sizeof *ends);
    bbm_contact_work *w = m->work = calloc(1, sizeof *w);

    if (w) {
        w->before = calloc(n, sizeof *w->before);
        w->after = calloc(n, sizeof *w->after);
        w->side = calloc(n, sizeof *w->side);
        w->last = calloc(n, sizeof *w->last);
        w->span = calloc(n, sizeof *w->span);
        w->along = calloc(n, sizeof *w->along);
        w->first = calloc(n + 1, sizeof *w->first);
        w->old = calloc(n + 1, sizeof *w->old);
        w->head = calloc(PLACES * n, sizeof *w->head);
        w->guess = calloc(6 * (size_t)m->elements, sizeof *w->guess);
        w->part = calloc((size_t)m->elements, sizeof *w->part);
        w->force = calloc((size_t)m->elements, sizeof *w->force);
        w->body = calloc(n, sizeof *w->body);
        w->girth = calloc(n, sizeof *w->girth);
        w->depth = calloc(n, sizeof *w->depth);
        w->now = calloc(n, sizeof *w->now);
        w->travel = calloc(n, sizeof *w->travel);
        w->moved = calloc(n, sizeof *w->moved);
    }
    const int ok = ends && w && w->before && w->after && w->side && w->last && w->span && w->along && w->first && w->old
                   && w->head && w->guess && w->part && w->force && w->body && w->girth && w->depth && w->now && w->travel && w->moved
                   && number_bodies(m);
    if (ok)
        link_edges(m, ends);
    for (int e = 0; e < m->edges && ok; e++) {
        w->girth[w->body[e]] += w->along[e].length;
        w->depth[e] = m->info.penetration;          /* prepared again in a run: contacts may be as deep as they were */
    }
    free(ends);
    return ok ? BBM_OK : BBM_NO_MEMORY;
}

/* -------------------------------------------------------------------------------- detection: the grid */

/* Makes room for one more entry in an array: twice the room when it is full. */
static int grow(void **array, int count, int *room, size_t size)
{
    const int more = 2 * count + 64;

    if (count < *room)
        return 1;
    void *larger = realloc(*array, (size_t)more * size);
    if (!larger)
        return 0;
    *array = larger;
    *room = more;
    return 1;
}

/* A cell is as wide as a mean edge's box. */
static void lay_out_grid(bbm_model *m)
{
    bbm_contact_work *w = m->work;

    w->cell = 1.01 * w->mean + 2 * w->search;
    w->entered = 0;
    for (int i = 0; i < PLACES * m->edges; i++)
        w->head[i] = -1;
}

/* The column of x, or the row of y; FAR cells away, where only a model that has blown up gets, all are one. */
static int64_t cell_of(const bbm_contact_work *w, double x)
{
    return (int64_t)fmax(-FAR, fmin(FAR, floor(x / w->cell)));
}

/* The place of a cell in the table. A square of 4 x 4 cells lies together in memory, since neighbours are looked up one
 * after the other; two odd 64-bit numbers and the high half spread the squares, one for each edge. Cells that share a
 * place only cost a comparison. */
static int *place_of(const bbm_model *m, int64_t column, int64_t row)
{
    const uint64_t i = (uint64_t)column, j = (uint64_t)row;
    const uint64_t square = ((i >> 2) * 0xC2B2AE3D27D4EB4Fu ^ (j >> 2) * 0x9E3779B97F4A7C15u) >> 32;

    return &m->work->head[square % (uint64_t)m->edges << 4 | (j & 3) << 2 | (i & 3)];
}

/* Enters the box of the piece (x, y) to (x + dx, y + dy) of edge e, widened by the search distance. */
static int enter_piece(bbm_model *m, int e, double x, double y, double dx, double dy)
{
    bbm_contact_work *w = m->work;
    const int64_t left = cell_of(w, fmin(x, x + dx) - w->search), right = cell_of(w, fmax(x, x + dx) + w->search);
    const int64_t low = cell_of(w, fmin(y, y + dy) - w->search), high = cell_of(w, fmax(y, y + dy) + w->search);

    for (int64_t row = low; row <= high; row++)
        for (int64_t column = left; column <= right; column++) {
            int *head = place_of(m, column, row);
            if (*head >= 0 && w->entries[*head].edge == e)
                continue;
            if (!grow((void **)&w->entries, w->entered, &w->entry_room, sizeof *w->entries))
                return 0;
            w->entries[w->entered] = (entry){ e, *head };
            *head = w->entered++;
        }
    return 1;
}

/* Enters all edges, the last first so that the lists ascend; long ones in pieces no longer than a cell. */
static bbm_status fill_grid(bbm_model *m)
{
    bbm_contact_work *w = m->work;

    lay_out_grid(m);
    for (int e = m->edges - 1; e >= 0; e--) {
        const bbm_vertex *a = start_of(m, e), *b = end_of(m, e);
        const double pieces = floor(w->along[e].length / w->cell) + 1;
        const double dx = (b->x - a->x) / pieces, dy = (b->y - a->y) / pieces;
        for (int p = 0; p < pieces; p++)
            if (!enter_piece(m, e, a->x + p * dx, a->y + p * dy, dx, dy))
                return BBM_NO_MEMORY;
    }
    return BBM_OK;
}

/* --------------------------------------------------------------------- detection: who may touch whom */

typedef struct { double d, s, off; } foot;  /* of P1 on an edge: distance, way along it, how far beyond its ends */

static foot find_foot(const bbm_model *m, int corner, int e)
{
    const bbm_vertex *P = start_of(m, corner), *a = start_of(m, e);
    const direction t = m->work->along[e];
    const double x = P->x - a->x, y = P->y - a->y, s = x * t.x + y * t.y;

    return (foot){ x * t.y - y * t.x, s, fmax(-s, s - t.length) };
}

/* Neither side of the corner points into the edge, up to a slack, after its block has turned by r against the edge's,
 * and the block is convex there: it lies on the outside. Either end of a side may be as deep as closed contacts are.
 * A grid point inside a straight side may come to lie in a hollow where that bends. */
static int can_enter(const bbm_contact_work *w, int corner, int e, double r, double slack)
{
    const direction t = w->along[e], q = w->along[corner], p = w->along[w->before[corner]];
    const direction s = { t.x * cos(r) + t.y * sin(r), t.y * cos(r) - t.x * sin(r), 1 };
    const double deep = 2 * fmin(w->now[w->body[corner]], w->now[w->body[e]]);

    if (!is_corner(w, corner))
        return fmin(cross(q, s), cross(s, p)) >= -BENT;
    return cross(q, s) >= -slack - deep / fmin(q.length, t.length)
        && cross(s, p) >= -slack - deep / fmin(p.length, t.length) && is_convex(w, corner);
}

static int coincide(const bbm_contact_work *w, int e, int f)
{
    return fabs(cross(w->along[e], w->along[f])) <= PARALLEL;
}

/* Of two edges along p and q that face each other, whether the outward normal of the first, (p.y, -p.x), is the one
 * that points up, or if both are upright, to the right. */
static int faces_up(direction p, direction q)
{
    return (fabs(p.x - q.x) > PARALLEL ? p.x - q.x : q.y - p.y) < 0;
}

/* Whether the grid points inside the straight side of c touch the one of e, too (`faces`): those of the shorter side
 * do, of equal sides those of the upper one. They carry all of it; none comes or goes while it slides on the longer.
 * Deviation: with `faces` = 0 corners alone touch, and a block of many elements sags between them. */
static int carries(const bbm_model *m, int c, int e)
{
    const bbm_contact_work *w = m->work;
    const direction p = w->along[c], q = w->along[e];

    if (!m->par.faces || hypot(p.x + q.x, p.y + q.y) > 1)           /* they do not face each other */
        return 0;
    if (fabs(w->span[c] - w->span[e]) > STRAIGHT * w->span[e])
        return w->span[c] < w->span[e];
    return faces_up(q, p);
}

/* How far two blocks may approach each other in this step. */
static double approach(const bbm_contact_work *w, int c, int e)
{
    return w->travel[w->body[c]] + w->travel[w->body[e]];
}

/* How deep a vertex may lie behind an edge at the start of a step: as deep as closed contacts of the two blocks do.
 * Nothing comes in from behind. What moves by T of the start of a step may also end it inside; and a corner that slides on
 * along a straight side, which may be bent by now, keeps its contact. */
static double behind(const bbm_model *m, int c, int e)
{
    const bbm_contact_work *w = m->work;

    return 2 * fmin(w->depth[w->body[c]], w->depth[w->body[e]]) + w->touch + (bbm_is_exact(m) ? 0 : approach(w, c, e));
}

/* The contact of the last step, closed or open inside, between `corner` and the edge - or, if `all`, another one of its straight side -
 * or NULL. */
static const bbm_contact *find_closed(const bbm_model *m, int corner, int edge, int all)
{
    const bbm_contact *found = NULL;

    for (int k = m->work->old[corner]; k < m->work->old[corner + 1]; k++) {
        const bbm_contact *c = &m->contact[k];
        if (c->state == BBM_OPEN && !c->inside)
            continue;
        if (c->edge == edge)
            return c;
        if (all && m->work->side[c->edge] == m->work->side[edge])
            found = c;
    }
    return found;
}

/* Whether the corner may come to touch the edge in this step. If it is still outside it may also turn there first, as
 * when a side falls flat on an edge. */
static int may_touch(const bbm_model *m, int corner, int e)
{
    const bbm_contact_work *w = m->work;
    const double turns = fabs(w->guess[6 * m->edge[corner].element + 2]) + fabs(w->guess[6 * m->edge[e].element + 2]);
    const foot f = find_foot(m, corner, e);

    if (fmax(fabs(f.d), f.off) > approach(w, corner, e) + behind(m, corner, e))
        return 0;
    if (f.off <= w->touch && f.d < -behind(m, corner, e) && !find_closed(m, corner, e, 1))
        return 0;
    if (find_closed(m, corner, e, 0))
        return 1;
    return can_enter(w, corner, e, 0, f.d > 0 ? PARALLEL + 2 * turns : PARALLEL);
}

/* All pairs that may touch. */
static bbm_status list_pairs(bbm_model *m)
{
    bbm_contact_work *w = m->work;

    w->pairs = m->info.candidates = 0;
    for (int c = 0; c < m->edges; c++) {
        const bbm_vertex *P = start_of(m, c);
        w->first[c] = w->pairs;
        for (int k = *place_of(m, cell_of(w, P->x), cell_of(w, P->y)); k >= 0; k = w->entries[k].next) {
            const int e = w->entries[k].edge;
            m->info.candidates++;
            if (m->edge[e].block == m->edge[c].block || !(is_corner(w, c) || carries(m, c, e)) || !may_touch(m, c, e))
                continue;
            if (!grow((void **)&w->pairs_of, w->pairs, &w->pair_room, sizeof *w->pairs_of))
                return BBM_NO_MEMORY;
            w->pairs_of[w->pairs++] = (pair){ c, e };
        }
    }
    w->first[m->edges] = w->pairs;
    return BBM_OK;
}

/* The place of (corner, edge) in the list in the making, or -1. */
static int find_pair(const bbm_contact_work *w, int corner, int edge)
{
    for (int k = w->first[corner]; k < w->first[corner + 1]; k++)
        if (w->pairs_of[k].edge == edge)
            return k;
    return -1;
}

static int is_listed(const bbm_contact_work *w, int corner, int edge) { return find_pair(w, corner, edge) >= 0; }

/* Of two neighbours e and f on one straight side, P touches the first if its foot comes before the end of that one. */
static int belongs_to_neighbour(const bbm_model *m, int corner, int e)
{
    const bbm_contact_work *w = m->work;
    const int f = w->after[e], d = w->before[e];

    if (!is_corner(w, f) && is_listed(w, corner, f) && find_foot(m, corner, e).s >= w->along[e].length)
        return 1;
    return !is_corner(w, e) && is_listed(w, corner, d) && find_foot(m, corner, d).s < w->along[d].length;
}

/* P on edge f against Q, an end of f, on edge e, where P is an end of e: one contact seen from both sides, if the
 * edges coincide and P lies at Q. When the sides are aligned, when both start in P and Q or both end there, just one
 * of P and Q has its foot on the other's edge. Whether P on f has to go. */
static int loses_to(const bbm_model *m, pair mine, pair other, int aligned)
{
    const bbm_contact_work *w = m->work;

    if (!coincide(w, mine.edge, other.edge) || !is_listed(w, other.corner, other.edge))
        return 0;
    const foot P = find_foot(m, mine.corner, mine.edge), Q = find_foot(m, other.corner, other.edge);
    const double beside = P.s - (other.corner == mine.edge ? 0 : w->along[mine.edge].length);
    if (fmax(fabs(beside), fmax(fabs(P.off), fabs(Q.off))) > w->touch)
        return aligned && P.off > Q.off;
    const int here = find_closed(m, mine.corner, mine.edge, 0) != NULL;
    const int there = find_closed(m, other.corner, other.edge, 0) != NULL;
    return here != there ? there : !faces_up(w->along[mine.edge], w->along[other.edge]);
}

/* The four pairs of an end Q of P's edge with an edge of which P is an end: 0 and 3 have aligned sides. */
static pair reversed_pair(const bbm_contact_work *w, pair p, int k)
{
    return (pair){ k < 2 ? p.edge : w->after[p.edge], k % 2 ? p.corner : w->before[p.corner] };
}

static int is_duplicate(const bbm_model *m, pair p)
{
    const bbm_contact_work *w = m->work;

    for (int k = 0; k < 4; k++) {
        const pair q = reversed_pair(w, p, k);
        if (loses_to(m, p, q, k % 3 == 0 && is_corner(w, p.corner) && is_corner(w, q.corner)))
            return 1;
    }
    return belongs_to_neighbour(m, p.corner, p.edge);
}

/* Drops the pairs that another one stands for; all are judged on the full list before the first one goes. */
static bbm_status drop_duplicates(bbm_model *m)
{
    bbm_contact_work *w = m->work;
    char *drop = malloc((size_t)w->pairs + 1);
    int kept = 0;

    if (!drop)
        return BBM_NO_MEMORY;
    for (int k = 0; k < w->pairs; k++)
        drop[k] = (char)is_duplicate(m, w->pairs_of[k]);
    for (int c = 0, k = 0; c <= m->edges; c++) {
        w->first[c] = kept;
        for (; k < w->pairs && w->pairs_of[k].corner == c; k++)
            if (!drop[k])
                w->pairs_of[kept++] = w->pairs_of[k];
    }
    w->pairs = kept;
    free(drop);
    return BBM_OK;
}

/* The contact `other`, on another line along which P and an end Q of its edge can enter each other, if both are convex
 * corners that may meet in this step and it is in the list; else -1. In a notch Q both edges hold P at once. */
static int find_rival(const bbm_model *m, pair p, int Q, pair other)
{
    const bbm_contact_work *w = m->work;
    const bbm_vertex *a = start_of(m, p.corner), *b = start_of(m, Q);

    if (!is_convex(w, Q) || coincide(w, p.edge, other.edge))
        return -1;
    const double reach = approach(w, p.corner, p.edge) + behind(m, p.corner, p.edge);
    return hypot(a->x - b->x, a->y - b->y) > 2 * reach ? -1 : find_pair(w, other.corner, other.edge);
}

/* ------------------------------------------------------------- detection: what carries over from step to step */

static bbm_touch touch_of(const bbm_model *m, const bbm_contact *c)
{
    const bbm_vertex *P1 = start_of(m, c->corner), *P2 = end_of(m, c->edge), *P3 = start_of(m, c->edge);

    return (bbm_touch){ &m->element[P1->element], &m->element[P2->element], P1, P2, P3, bbm_is_exact(m), c->rest };
}

/* Puts the anchor where the shear spring carries the force T: (P1 - P0).m = T/p_s, m from P2 to P3. */
static void place_anchor(const bbm_model *m, bbm_contact *c, double T)
{
    c->anchor = (find_foot(m, c->corner, c->edge).s + T / m->par.p_s) / m->work->along[c->edge].length;
}

/* The closed contact of the last step that lives on in p: the same; one of the same corner with the same straight side;
 * or, where two corners have passed each other, that of the other corner if it is no longer in the list. */
static const bbm_contact *find_ancestor(const bbm_model *m, pair p)
{
    const bbm_contact_work *w = m->work;
    const bbm_contact *old = find_closed(m, p.corner, p.edge, 1);

    for (int k = 0; k < 4 && !old; k++) {
        const pair q = reversed_pair(w, p, k);
        if (coincide(w, p.edge, q.edge) && !is_listed(w, q.corner, q.edge))
            old = find_closed(m, q.corner, q.edge, 0);
    }
    return old;
}

/* Area of the joint that P stands for, on which cohesion and tensile strength act: to both sides, as far as its own
 * side lies on the edge, half the way to the next point that touches - the next grid point of the side that `carries`,
 * or the end of either side. */
static double joint_area(const bbm_model *m, pair p)
{
    const bbm_contact_work *w = m->work;
    const double s = find_foot(m, p.corner, p.edge).s;
    double length = 0;

    for (int k = 0; k < 2; k++) {
        const int mine = k ? p.corner : w->before[p.corner];
        const int i = carries(m, mine, p.edge), j = carries(m, p.edge, mine);
        int a = k ? w->after[i ? mine : w->last[mine]] : i ? mine : w->side[mine];
        int b = k ? (j ? p.edge : w->side[p.edge]) : w->after[j ? p.edge : w->last[p.edge]];
        if (!coincide(w, mine, p.edge))
            continue;
        if (!is_corner(w, b) && fabs(find_foot(m, b, p.edge).s - s) <= w->touch)
            b = k ? w->before[b] : w->after[b];
        length += fmin(fabs(find_foot(m, a, p.edge).s - s), fabs(find_foot(m, b, p.edge).s - s)) / 2;
    }
    return length * fmin(m->element[m->edge[p.corner].element].material.thickness,
                         m->element[m->edge[p.edge].element].material.thickness);
}

/* A closed contact is free when P has left past a corner Q: a rival line on which they can enter each other is open, or
 * there is none and the foot is off the edge. */
static int has_left(const bbm_model *m, const bbm_contact *c)
{
    const bbm_contact_work *w = m->work;
    int rivals = 0;

    for (int k = 0; k < 4; k++) {
        if (c->rival[k] < 0)
            continue;
        const pair r = w->pairs_of[c->rival[k]];
        if (find_foot(m, r.corner, r.edge).d > 0 && can_enter(w, r.corner, r.edge, 0, PARALLEL))
            return 1;
        rivals++;
    }
    return c->off && rivals == 0;
}

/* Makes a pair a contact, with the state of the one that it continues. A foot beyond the end of the edge is off it,
 * but not in a notch, where it lies inside the block. A joint that touches at the start is closed from the start in
 * statics, or if it has a strength. */
static void make_contact(bbm_model *m, pair p, bbm_contact *c)
{
    const bbm_contact_work *w = m->work;
    const bbm_contact *old = m->contacts ? find_ancestor(m, p) : NULL;
    const foot f = find_foot(m, p.corner, p.edge);
    const int strong = m->par.cohesion > 0 || m->par.tension > 0, end = w->after[p.edge];
    const int start = m->info.step == 0 && m->info.t == 0;

    *c = (bbm_contact){ .corner = p.corner, .edge = p.edge, .gap = f.d, .share = 1 };
    if (old) {
        c->state = old->state, c->sign = old->sign, c->anchor = old->anchor, c->whole = old->whole;
        c->N = c->used = old->N, c->T = old->T, c->rest = old->rest;
        c->before = old->state != BBM_OPEN, c->inside = old->inside;
    } else if (start && fmax(fabs(f.d), f.off) <= w->touch) {
        c->whole = 1;
        c->state = strong || isinf(m->h) ? BBM_LOCK : BBM_OPEN;
    }
    c->rival[0] = find_rival(m, p, p.edge, (pair){ p.corner, w->before[p.edge] });
    c->rival[1] = find_rival(m, p, p.edge, (pair){ p.edge, w->before[p.corner] });
    c->rival[2] = find_rival(m, p, end, (pair){ p.corner, end });
    c->rival[3] = find_rival(m, p, end, (pair){ end, p.corner });
    c->off = f.off > w->touch && is_convex(w, f.s < 0 ? p.edge : end);
    c->area = strong && c->whole ? joint_area(m, p) : 0;
    if (c->state != BBM_OPEN && has_left(m, c))
        c->state = BBM_OPEN, c->N = c->T = 0, c->before = 0;
    c->inside = c->inside && !has_left(m, c);
    if (!old || c->state == BBM_OPEN || old->corner != p.corner || old->edge != p.edge) {
        place_anchor(m, c, c->T);
        c->rest = bbm_is_exact(m) ? fmin(0, c->gap + c->N / m->par.p_n) : 0;
    }
}

/* How far the boundary of each body moves by D; of a body, at its first edge. */
static void find_travel(const bbm_model *m, const double D[], double travel[])
{
    double u[2];

    memset(travel, 0, (size_t)m->edges * sizeof *travel);
    for (int e = 0; e < m->edges; e++) {
        const bbm_vertex *p = start_of(m, e);
        double *most = &travel[m->work->body[e]];
        bbm_move(m, &m->element[p->element], &D[6 * p->element], p->x, p->y, u);
        *most = fmax(*most, hypot(u[0], u[1]));
    }
}

/* What the velocities and gravity foretell of the step; in statics a step is as long as the last one at most. */
void bbm_guess_step(bbm_model *m)
{
    const double fall[6] = { m->acceleration[0] * m->h * m->h / 2, m->acceleration[1] * m->h * m->h / 2 };

    for (int i = 0; i < m->elements; i++)
        for (int a = 0; a < 6; a++)
            m->work->guess[6 * i + a] = isinf(m->h) ? m->element[i].D[a] : m->element[i].V[a] * m->h + fall[a];
    m->work->listed = -1;
}

/* D as far as known before the solution, [6 elements]. */
const double *bbm_guess(const bbm_model *m)
{
    return m->work->guess;
}

/* Whether the solution moves further than the detection has foreseen; it then is the next guess. */
int bbm_moved_too_far(bbm_model *m)
{
    bbm_contact_work *w = m->work;
    int too_far = 0;

    find_travel(m, m->D, w->moved);
    for (int e = 0; e < m->edges; e++)
        too_far |= w->moved[e] > w->travel[e];
    for (int i = 0; i < m->elements && !too_far; i++)
        too_far = fabs(m->D[6 * i + 2]) > 2 * fabs(w->guess[6 * i + 2]) + PARALLEL / 2;
    if (too_far)
        memcpy(w->guess, m->D, 6 * (size_t)m->elements * sizeof *w->guess);
    return too_far;
}

/* How far the bodies may move: a tenth more than the guess, or what rounding and a closed contact give; and no less than
 * what this step has foreseen before. */
static void foresee(bbm_model *m)
{
    bbm_contact_work *w = m->work;

    memcpy(w->now, w->depth, (size_t)m->edges * sizeof *w->now);
    find_travel(m, w->guess, w->moved);
    w->search = 0;
    for (int e = 0; e < m->edges; e++) {
        const double way = 1.1 * w->moved[e] + w->depth[e] + w->touch / 2;
        w->travel[e] = w->listed < 0 ? way : fmax(way, w->travel[e]);
        w->search = fmax(w->search, w->travel[e]);
    }
    w->search = 4 * w->search + w->touch;
}

/* Room for the pairs as contacts. */
static int list_fits(bbm_contact_work *w)
{
    if (w->pairs <= w->list_room)
        return 1;
    free(w->list);
    w->list = calloc((size_t)w->pairs, sizeof *w->list);
    w->list_room = w->list ? w->pairs : 0;
    return w->list_room > 0;
}

/* The element of a contact's corner. */
static int element_of(const bbm_model *m, const bbm_contact *c) { return m->edge[c->corner].element; }

/* Whether the list of this step has the pairs that were found once more. */
static int is_same_list(const bbm_contact_work *w)
{
    int same = w->listed == w->pairs;

    for (int k = 0; k < w->pairs && same; k++)
        same = w->list[k].corner == w->pairs_of[k].corner && w->list[k].edge == w->pairs_of[k].edge;
    return same;
}

/* Lists the contacts that may be closed in this step, from the present positions and the contacts of the last step,
 * which stay as they are; `same` (may be NULL): the list of this step had these pairs already. */
bbm_status bbm_detect_contacts(bbm_model *m, int *same)
{
    bbm_contact_work *w = m->work;

    find_directions(m);
    foresee(m);
    bbm_status status = fill_grid(m);
    if (!status)
        status = list_pairs(m);
    if (!status)
        status = drop_duplicates(m);
    const int known = !status && is_same_list(w);
    if (same)
        *same = known;
    if (status || known)
        return status;
    if (!list_fits(w))
        return BBM_NO_MEMORY;
    for (int k = 0; k < w->pairs; k++)
        make_contact(m, w->pairs_of[k], &w->list[k]);
    w->listed = w->pairs;
    bbm_join_elements(m, w->part);
    w->passes = w->forces = w->single = w->directions = 0;
    return BBM_OK;
}

/* Detects them again, with those locked that slid, by the force that their friction had; from now on one state changes in
 * each pass. */
bbm_status bbm_start_again(bbm_model *m)
{
    bbm_contact_work *w = m->work;
    m->work->listed = -1;
    const bbm_status status = bbm_detect_contacts(m, NULL);

    for (int k = 0; k < w->pairs && !status; k++)
        if (w->list[k].state == BBM_SLIDE)
            w->list[k].state = BBM_LOCK;
    w->single = 1;
    return status;
}

/* ------------------------------------------------------------------------------------------ assembly */

/* The contacts of the step in hand. */
bbm_contact *bbm_list_contacts(const bbm_model *m, int *contacts)
{
    *contacts = m->work->pairs;
    return m->work->list;
}

int bbm_contact_count(const bbm_model *m)
{
    return m->work->pairs;
}

/* The elements of contact k. */
void bbm_contact_pair(const bbm_model *m, int k, int elements[2])
{
    elements[0] = m->edge[m->work->pairs_of[k].corner].element;
    elements[1] = m->edge[m->work->pairs_of[k].edge].element;
}

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

    for (int k = 0; k < m->work->pairs && !status; k++)
        if (m->work->list[k].state != BBM_OPEN)
            status = assemble_contact(m, &m->work->list[k]);
    return status;
}

/* ---------------------------------------------------------------- the open-close iteration: distances */

/* d_n and d_s at the end of the step, Eq. (52), (53), as the update will move the points; l alone is the start's. */
static void exact_distances(const bbm_model *m, const bbm_contact *c, double d[2])
{
    const bbm_touch t = touch_of(m, c);
    const double *Di = &m->D[6 * m->edge[c->corner].element], *Dj = &m->D[6 * m->edge[c->edge].element];
    const double x0 = t.P3->x + c->anchor * (t.P2->x - t.P3->x), y0 = t.P3->y + c->anchor * (t.P2->y - t.P3->y);
    double u1[2], u2[2], u3[2], u0[2];

    bbm_move(m, t.i, Di, t.P1->x, t.P1->y, u1);
    bbm_move(m, t.j, Dj, t.P2->x, t.P2->y, u2);
    bbm_move(m, t.j, Dj, t.P3->x, t.P3->y, u3);
    bbm_move(m, t.j, Dj, x0, y0, u0);
    const double x = t.P3->x - t.P2->x + u3[0] - u2[0], y = t.P3->y - t.P2->y + u3[1] - u2[1];
    const double l = hypot(t.P3->x - t.P2->x, t.P3->y - t.P2->y);
    const double px = t.P1->x - t.P2->x + u1[0] - u2[0], py = t.P1->y - t.P2->y + u1[1] - u2[1];
    d[0] = (x * py - y * px) / l;
    d[1] = ((t.P1->x - x0 + u1[0] - u0[0]) * x + (t.P1->y - y0 + u1[1] - u0[1]) * y) / l;
}

/* d = d0 + e.D_i + g.D_j of the solution, Eq. (57), (61). */
static double spring_length(const bbm_model *m, const bbm_contact *c, const bbm_spring *v)
{
    const double *Di = &m->D[6 * m->edge[c->corner].element], *Dj = &m->D[6 * m->edge[c->edge].element];
    double d = v->d;

    for (int a = 0; a < 6; a++)
        d += v->e[a] * Di[a] + v->g[a] * Dj[a];
    return d;
}

/* d_n, d_s, N and T of the solution, Eq. (57) and (61). An open contact has its anchor at P3, so that -d_s is the way
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

/* The largest force in each part: on an element, inertia included, or in a contact. What the solver leaves as its residual,
 * and so in every N of the part, is small against this and nothing else. */
static void find_forces(const bbm_model *m)
{
    const bbm_contact_work *w = m->work;

    memset(w->force, 0, (size_t)m->elements * sizeof *w->force);
    for (int i = 0; i < m->elements; i++)
        w->force[w->part[i]] = fmax(w->force[w->part[i]], hypot(m->F[6 * i], m->F[6 * i + 1]));
    for (int k = 0; k < w->pairs; k++) {
        double *F = &w->force[w->part[element_of(m, &w->list[k])]];
        *F = fmax(*F, fabs(w->list[k].N));
    }
}

/* Forces of a contact that differ by less agree. */
static double slack_of(const bbm_model *m, const bbm_contact *c)
{
    return AGREE * m->work->force[m->work->part[element_of(m, c)]];
}

/* Whether element i turns by another angle than that of its vectors, by more than the direction of a force may be wrong. */
static int turns_otherwise(const bbm_model *m, int i)
{
    return bbm_is_exact(m) && fabs(m->D[6 * i + 2] - m->element[i].mode_D[2]) > DIRECTION;
}

/* Whether the vectors of a contact belong to another step than the solution: forces that are wrong by more than a share
 * of the largest one on its two elements, or in direction, or an open contact on the wrong side. */
int bbm_contacts_are_off(const bbm_model *m, double share)
{
    for (int k = 0; k < m->work->pairs; k++) {
        const bbm_contact *c = &m->work->list[k];
        const int i = element_of(m, c), j = m->edge[c->edge].element;
        const double *Fi = &m->F[6 * i], *Fj = &m->F[6 * j];
        const double F = fmax(fabs(c->N), fmax(hypot(Fi[0], Fi[1]), hypot(Fj[0], Fj[1]))), slack = fmax(share * F, slack_of(m, c));
        double d[2];
        exact_distances(m, c, d);
        const double n = m->par.p_n * fabs(d[0] - c->d_n), s = m->par.p_s * fabs(c->share * d[1] - c->d_s);
        if (c->state != BBM_OPEN && (turns_otherwise(m, i) || turns_otherwise(m, j)))
            return 1;
        if (c->state == BBM_OPEN ? n > slack && (d[0] < 0) != (c->d_n < 0) : n > slack || (c->state == BBM_LOCK && s > slack))
            return 1;
    }
    return 0;
}

/* The closed contact that is deepest against the size of its smaller block, a quarter of its boundary; returns that share,
 * or 0 if none is closed. */
double bbm_deepest_contact(const bbm_model *m, const bbm_contact **deepest)
{
    const bbm_contact_work *w = m->work;
    double most = 0;

    for (int k = 0; k < w->pairs; k++) {
        const bbm_contact *c = &w->list[k];
        const double share = -c->d_n / (fmin(w->girth[w->body[c->corner]], w->girth[w->body[c->edge]]) / 4);
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
    const size_t n = (size_t)w->pairs;

    if (w->pairs <= w->vector_room)
        return 1;
    free(w->x), free(w->r), free(w->dx), free(w->dr);
    w->x = calloc(n, sizeof *w->x);
    w->r = calloc(n, sizeof *w->r);
    w->dx = calloc(n * (DIRECTIONS + 1), sizeof *w->dx);
    w->dr = calloc(n * (DIRECTIONS + 1), sizeof *w->dr);
    w->vector_room = w->x && w->r && w->dx && w->dr ? w->pairs : 0;
    return w->vector_room > 0;
}

/* Takes from (dr, dx) what the directions before `d` account for. */
static void remove_directions(const bbm_contact_work *w, int d, double dr[], double dx[])
{
    for (int q = 0; q < d; q++) {
        double a = 0;
        for (int k = 0; k < w->pairs; k++)
            a += dr[k] * w->dr[q * w->pairs + k];
        for (int k = 0; k < w->pairs; k++) {
            dr[k] -= a * w->dr[q * w->pairs + k];
            dx[k] -= a * w->dx[q * w->pairs + k];
        }
    }
}

/* The last change of x, and the change of r that it made, become a direction: in r orthonormal to the others. */
static void learn_direction(bbm_contact_work *w)
{
    double *dx = &w->dx[w->directions * w->pairs], *dr = &w->dr[w->directions * w->pairs], size = 0;

    for (int k = 0; k < w->pairs; k++) {
        const bbm_contact *c = &w->list[k];
        const int slides = c->state == BBM_SLIDE;
        dx[k] = slides ? c->used - w->x[k] : 0;
        dr[k] = slides ? c->N - c->used - w->r[k] : 0;
    }
    remove_directions(w, w->directions, dr, dx);
    for (int k = 0; k < w->pairs; k++)
        size += dr[k] * dr[k];
    if (size == 0)
        return;
    for (int k = 0; k < w->pairs; k++) {
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
    for (int k = 0; k < w->pairs; k++) {
        const bbm_contact *c = &w->list[k];
        w->x[k] = c->used;
        w->r[k] = c->state == BBM_SLIDE ? c->N - c->used : 0;
    }
    double *dr = &w->dr[w->directions * w->pairs], *dx = &w->dx[w->directions * w->pairs];
    memcpy(dr, w->r, (size_t)w->pairs * sizeof *dr);
    memset(dx, 0, (size_t)w->pairs * sizeof *dx);
    remove_directions(w, w->directions, dr, dx);
    for (int k = 0; k < w->pairs; k++)
        if (w->list[k].state == BBM_SLIDE)
            w->list[k].used = w->x[k] + dx[k] + dr[k];
    return BBM_OK;
}

/* Whether every friction force belongs to its N. */
static int forces_agree(const bbm_model *m)
{
    const bbm_contact_work *w = m->work;

    for (int k = 0; k < w->pairs && m->par.friction > 0; k++) {
        const bbm_contact *c = &w->list[k];
        if (c->state == BBM_SLIDE && fabs(c->N - c->used) > slack_of(m, c))
            return 0;
    }
    return 1;
}

/* --------------------------------------------------------------------- the open-close iteration: states */

/* The length of an edge at the end of the step. */
static double end_length(const bbm_model *m, int edge)
{
    const bbm_vertex *a = start_of(m, edge), *b = end_of(m, edge);
    const double *D = &m->D[6 * m->edge[edge].element];
    double ua[2], ub[2];

    bbm_move(m, &m->element[a->element], D, a->x, a->y, ua);
    bbm_move(m, &m->element[b->element], D, b->x, b->y, ub);
    return hypot(b->x - a->x + ub[0] - ua[0], b->y - a->y + ub[1] - ua[1]);
}

/* Whether the foot of an open contact is on the edge, at the start of the step or at its end, where the way along it is
 * -d_s times the length at the start over that at the end. */
static int foot_on_edge(const bbm_model *m, const bbm_contact *c)
{
    if (!c->off)
        return 1;
    const double l = end_length(m, c->edge);
    return c->d_s <= 0 && -c->d_s * m->work->along[c->edge].length <= l * l;
}

static int enters_at_end(const bbm_model *m, const bbm_contact *c)
{
    const double r = m->D[6 * m->edge[c->corner].element + 2] - m->D[6 * m->edge[c->edge].element + 2];

    return can_enter(m->work, c->corner, c->edge, r, PARALLEL);
}

/* Of two lines across each other that are crossed at the same time, p counts and not q: the flatter one; of two as steep,
 * that which rises to the right. */
static int goes_first(direction p, direction q)
{
    const double flatter = fabs(q.y) - fabs(p.y);
    const int p_rises = (p.x > 0) == (p.y > 0), q_rises = (q.x > 0) == (q.y > 0);

    return fabs(flatter) > PARALLEL || p_rises == q_rises ? flatter > 0 : p_rises;
}

/* The fraction of the step at which P crosses a line; 0 for one that it starts on, or inside as contacts are. */
static double crossed_at(const bbm_contact_work *w, const bbm_contact *c)
{
    return c->gap <= w->touch ? 0 : c->gap / (c->gap - c->d_n);
}

/* Whether P starts behind the line, so that it cannot come in there. */
static int is_behind(const bbm_model *m, const bbm_contact *c)
{
    return !c->before && !c->inside && c->gap < -behind(m, c->corner, c->edge);
}

/* Whether an open contact, though crossed, may not close: from behind; off the edge from the start of the step to its end,
 * unless it was closed and has not left; if a side points into the edge by then; or a rival line is closed, is not
 * crossed, or is crossed later: the line crossed last is where P comes in. At the same time: the one that was closed at
 * the start of the step. */
static int is_blocked(const bbm_model *m, const bbm_contact *c)
{
    const bbm_contact_work *w = m->work;

    if (!(c->before || foot_on_edge(m, c)) || !enters_at_end(m, c) || is_behind(m, c))
        return 1;
    for (int k = 0; k < 4; k++) {
        if (c->rival[k] < 0)
            continue;
        const bbm_contact *r = &w->list[c->rival[k]];
        if (r->state != BBM_OPEN)
            return 1;
        if (!enters_at_end(m, r))
            continue;
        const double mine = crossed_at(w, c), other = crossed_at(w, r);
        const int tie = fabs(other - mine) <= TIE;
        const int first = !tie ? other > mine : r->before != c->before ? r->before
                        : goes_first(w->along[r->edge], w->along[c->edge]);
        if (r->d_n >= 0 || (first && foot_on_edge(m, r) && !is_behind(m, r)))
            return 1;
    }
    return 0;
}

/* A contact closes when P1 hits: at the fraction d0/(d0 - d_n) of the step, at which the gap d0 has closed. Its shear
 * spring feels the share of the slip that is left, so that it never pushes along. Returns the way of P1 along the edge in
 * the step, towards P3. */
static double anchor_at_hit(const bbm_model *m, bbm_contact *c)
{
    const double gap = fmax(0, c->gap), s = find_foot(m, c->corner, c->edge).s;

    c->share = 1 - gap / (gap - c->d_n);
    c->anchor = s / m->work->along[c->edge].length;
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

    for (int k = 0; k < w->pairs; k++) {
        bbm_contact *c = &w->list[k];
        c->next = bbm_next_state(&m->par, c, slack_of(m, c));
        if (c->state == BBM_OPEN && c->next != BBM_OPEN && is_blocked(m, c))
            c->next = BBM_OPEN;
    }
    for (int k = 0; k < w->pairs && !(w->single && changes); k++)
        if (w->list[k].next != w->list[k].state) {
            change_state(m, &w->list[k]);
            changes++;
        }
    return changes;
}

/* Notes the states of this pass as one number (FNV-1a); if they have been there before, the iteration cycles - but not
 * if they are those of the last pass, after which only the vectors of the step were renewed. */
static void watch_for_cycles(bbm_contact_work *w)
{
    uint64_t hash = 14695981039346656037u;

    for (int k = 0; k < w->pairs; k++)
        hash = (hash ^ ((uint64_t)(int64_t)copysign(w->list[k].state, w->list[k].sign))) * 1099511628211u;
    for (int p = 0; p < w->passes; p++)
        if (w->seen[p] == hash && w->seen[w->passes - 1] != hash)
            w->single = 1;
    w->seen[w->passes] = hash;
}

/* The depth of a closed contact counts for both its bodies. */
static void note_depth(const bbm_contact_work *w, const bbm_contact *c, double depth[])
{
    const double deep = c->state == BBM_OPEN ? 0 : fabs(c->d_n);

    depth[w->body[c->corner]] = fmax(depth[w->body[c->corner]], deep);
    depth[w->body[c->edge]] = fmax(depth[w->body[c->edge]], deep);
}

/* One look at the solution: whether the friction forces belong to their N, then the states to the forces, and the vectors
 * of the step to the displacements - but not in a round of multipliers, which keeps K. */
bbm_status bbm_open_close(bbm_model *m, bbm_pass *pass)
{
    bbm_contact_work *w = m->work;

    m->info.passes++;
    memcpy(w->now, w->depth, (size_t)m->edges * sizeof *w->now);
    for (int k = 0; k < w->pairs; k++) {
        measure(m, &w->list[k]);
        note_depth(w, &w->list[k], w->now);
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
    int *first = w->old, room = m->contact_room;

    find_directions(m);
    m->info.contacts = 0;
    m->info.penetration = 0;
    memset(w->depth, 0, (size_t)m->edges * sizeof *w->depth);
    for (int k = 0; k < w->pairs; k++) {
        bbm_contact *c = &w->list[k];
        const double strength = bbm_shear_strength(&m->par, c->N, c->area);
        c->whole = c->whole && (c->state == BBM_LOCK || (c->state == BBM_SLIDE && strength == 0));
        c->inside = c->state == BBM_OPEN && c->d_n < 0 && (c->before || c->inside);
        if (c->state == BBM_SLIDE)
            c->T = c->sign * strength;
        if (c->state == BBM_SLIDE || c->share < 1)
            place_anchor(m, c, c->T);
        if (c->state != BBM_OPEN) {
            m->info.contacts++;
            m->info.penetration = fmax(m->info.penetration, -c->d_n);
            note_depth(w, c, w->depth);
        }
    }
    w->listed = -1;
    m->contact = w->list;
    m->contacts = w->pairs;
    m->contact_room = w->list_room;
    w->old = w->first;
    w->list = last;
    w->list_room = room;
    w->first = first;
    return BBM_OK;
}
