/* warn.c - what is allowed and hardly meant: each is a line on stderr, and the run goes on. */

#include "run.h"

enum { NAMED = 10 };            /* pieces of a block that a warning names                       */

/* Of the way: the last static step; as many steps as have settled, if each is like the last. Where
 * all of them are alike, which is 1, something slides freely. */
#define UNSETTLED 0.01
#define DRIFT 0.05
/* Of the forces on a body: what statics may leave out of balance where it has led, since it takes
 * the forces to have the arms that they had before its last step. */
#define ELSEWHERE 2e-3
/* With which rows of cells bend by 0.84 of what they should. */
#define TAPER 0.5
/* Of its size: an element that moves by less in a step is at rest but for rounding. */
#define STILL 1e-10
/* Of their size: from there on blocks that have moved without end would be said to fall. */
#define PARTED 0.02
/* Of the size of the smaller of two elements: what came off lies less deep in its neighbours. */
#define PASSED 0.02
/* Grid points of the one side for one of the other. */
#define COARSE 2.5

#define warn(path, ...) \
    (fprintf(stderr, "%s: warning: ", path), fprintf(stderr, __VA_ARGS__), fputc('\n', stderr))

/* What the file leaves out and hardly means. A stage keeps what it does not change, of which
 * nothing is said again. */
static void warn_of_loads(const model *p, const char *path)
{
    const bbm_model *m = p->m;
    const bbm_beyond *b = m->beyond;
    int load = p->moving || p->shakings || b->shake[0] != 0 || b->shake[1] != 0, fell = 0, rose = 0;
    char in[80] = "";

    for (int k = 0; k <= p->stages; k++) {
        const model_stage *s = &p->stage[k];
        const double *g = s->par.gravity;
        const int weighs = g[0] != 0 || g[1] != 0;
        const int rises = weighs && g[1] >= 0 && g[0] * g[1] == 0;  /* a model may be turned */
        int held = s->edge_loads > 0;
        load |= weighs || held;
        for (int n = 0; n < m->nodes; n++) {
            const int gone = p->gone[p->node_block[n]];
            held |= s->node[n].held && (gone == 0 || gone > k);
            load |= s->node[n].load[0] != 0 || s->node[n].load[1] != 0;
        }
        if (k > 0)
            snprintf(in, sizeof in, "stage %.60s: ", s->name);
        if (weighs && !held && !fell)
            warn(path, "%snothing is fixed: under gravity all blocks fall; fixblock or fix holds "
                       "them", in);
        if (rises && !rose)
            warn(path, "%sgravity is not downward; on earth it is: gravity 0 -9.81", in);
        fell = weighs && !held, rose = rises;
    }
    for (int k = 0; k < p->blocks; k++)
        load |= p->velocity[k].given;
    for (int k = 0; k < 3 * m->elements; k++)
        load |= m->element[k / 3].stress[k % 3] != 0 || m->element[k / 3].f[k % 2] != 0;
    for (int k = 0; k < p->bolts; k++)
        load |= p->bolt[k].pull != 0;
    if (!load)
        warn(path, "nothing loads the model; gravity, load, traction, pressure, bodyforce or "
                   "fix ... by does");
}

/* -------------------------------------------------------------- bodies, and what is between */

/* A block. A gap is to a block before it that it faces: below CLOSE, of the size of the smaller
 * one, it is hardly meant, and below MODEL_TOUCH it is none. */
typedef struct {
    bbm_box box;
    double size, gap;           /* m            size: root of its area                          */
    int    elements, pieces, free, held, thrown, edge, near;        /* free, held: its nodes;   */
} body;                         /*              edge: the first; near: the block at the gap     */

/* next: edge; group: of blocks that touch; piece: of elements that are bonded; met: pairs that are
 * close; alike: pairs of meshes of one material with a side in common; ledges: pairs that
 * touch, with corners less apart than they are rounded by; rough: those with too few digits. */
typedef struct {
    const model *p;
    body *body;
    bbm_box *box;
    int *next, *group, *piece, met, alike, ledges, rough;
} bodies;

#define CLOSE 0.01
/* Rounding of a place, of its distance from the origin; what may be made of it, of a weight, see
 * base/open_close.c. */
#define DIGITS 1e-15
#define ROUGH 1e-3
/* Bonds of a body beside its inertia in K, which then has next to no digits left. */
#define STIFFEST 1e12

static void measure(bodies *s)
{
    const bbm_model *m = s->p->m;

    for (int b = 0; b < s->p->blocks; b++) {
        s->body[b] = (body){ .box = bbm_empty_box(b), .gap = INFINITY, .edge = -1,
                             .thrown = s->p->velocity[b].given };
        s->group[b] = b;
    }
    for (int e = 0; e < m->elements; e++) {
        body *b = &s->body[m->element[e].block];
        b->size = hypot(b->size, sqrt(m->element[e].A0));
        b->elements++;
        b->pieces += s->piece[e] == e;
        for (int k = m->element[e].first; k < m->element[e].first + m->element[e].n; k++)
            bbm_widen_box(&b->box, m->vertex[k].x, m->vertex[k].y, 0);
    }
    for (int n = 0; n < m->nodes; n++)
        *(m->node[n].held ? &s->body[s->p->node_block[n]].held
                          : &s->body[s->p->node_block[n]].free) += 1;
    for (int k = 0; k < 2 * s->p->bolts; k++)       /* what a bolt holds is not said to fall */
        s->body[s->p->bolt[k / 2].end[k % 2].block].thrown = 1;
    for (int b = 0; b < s->p->blocks; b++) {
        const bbm_box *of = &s->body[b].box;
        s->box[b] = *of;
        bbm_widen_box(&s->box[b], of->low[1], of->low[2], CLOSE * s->body[b].size);
        bbm_widen_box(&s->box[b], of->high[1], of->high[2], CLOSE * s->body[b].size);
    }
    bbm_sort_boxes(s->p->blocks, s->box);
    for (int e = 0; e < m->edges; e++) {
        int *first = &s->body[m->edge[e].block].edge;
        s->next[e] = *first;
        *first = e;
    }
}

/* A block whose elements nothing bonds together may be meant, but is said: with an element of
 * each piece. */
static void warn_of_pieces(const bodies *s, const char *path)
{
    for (int b = 0; b < s->p->blocks; b++) {
        if (s->body[b].pieces < 2)
            continue;
        fprintf(stderr, "%s: warning: block '%.60s' is in %d pieces that no bond joins, with the "
                "elements", path, s->p->block[b], s->body[b].pieces);
        for (int e = 0, left = NAMED; e < s->p->m->elements && left > 0; e++)
            if (s->piece[e] == e && s->p->m->element[e].block == b)
                fprintf(stderr, "%s %s", left-- == NAMED ? "" : ",", s->p->element[e]);
        fprintf(stderr, "%s; elements are bonded along sides whose two nodes they share\n",
                s->body[b].pieces > NAMED ? " ..." : "");
    }
}

static int is_convex(const bbm_model *m, int e)
{
    const bbm_direction in = m->edge[m->edge[e].before].along, out = m->edge[e].along;

    return in.x * out.y > in.y * out.x;
}

/* The least distance, if it is below `far`, of a corner of block a from an edge of b that it faces.
 * Counts the corners that touch, those that are corners of both, and those nearly so. */
static double find_gap(const bodies *s, const body *a, const body *b, double far, int count[3])
{
    const bbm_model *m = s->p->m;
    const double touch = MODEL_TOUCH / CLOSE * far;
    double gap = far;

    for (int e = a->edge; e >= 0; e = s->next[e]) {
        const bbm_vertex *P = bbm_start_of(m, e);
        double least = far;
        if (P->x < b->box.low[1] - far || P->x > b->box.high[1] + far
            || P->y < b->box.low[2] - far || P->y > b->box.high[2] + far)
            continue;
        for (int f = b->edge; f >= 0; f = s->next[f]) {
            const double way = bbm_way_along(m, e, f), d = model_distance(m, e, f);
            if (way > -touch && way < m->edge[f].along.length + touch)
                least = fmin(least, d);
            const double apart = hypot(d, fmax(0, way));
            count[1] += d <= touch && way < touch;
            count[2] += apart > touch && is_convex(m, e) && is_convex(m, f)
                     && apart < fmin(bbm_rounding(m, e), bbm_rounding(m, f));
        }
        count[0] += least <= touch;
        gap = fmin(gap, least);
    }
    return gap;
}

static body *group_of(const bodies *s, int b) { return &s->body[bbm_root_of(s->group, b)]; }

/* Blocks that touch are a group, which is held if one of them is. Two meshes with a side in
 * common, from end to end, were hardly meant as two if they have one material or no friction. */
static void compare(bodies *s, const char *path, int one, int two)
{
    const int i = one > two ? one : two, j = one + two - i;
    body *a = &s->body[i], *b = &s->body[j], *of = group_of(s, i), *to = group_of(s, j);
    const double size = fmin(a->size, b->size), far = CLOSE * size;
    const body *small = a->size < b->size ? a : b;
    const bbm_model *m = s->p->m;
    const bbm_vertex *at = bbm_start_of(m, small->edge);
    const bbm_material *of_small = &m->element[at->element].material;
    const double weight = of_small->density * of_small->thickness * size * size
                        * hypot(m->par.gravity[0], m->par.gravity[1]);
    const double digits = m->par.p_n * DIGITS * (hypot(at->x, at->y) + a->size + b->size);
    int count[3] = { 0 };

    const double gap = fmin(find_gap(s, a, b, far, count), find_gap(s, b, a, far, count));
    s->met += gap < far;
    if (gap <= MODEL_TOUCH * size) {
        to->held += of == to ? 0 : of->held;
        to->thrown |= of->thrown;
        s->group[of - s->body] = (int)(to - s->body);
        if (count[2] > 0 && s->ledges++ == 0)
            warn(path, "corners of blocks '%.60s' and '%.60s' are less apart than they are rounded "
                 "by, and no obstacle; `contact round 0` is sharp", s->p->block[j], s->p->block[i]);
        if (small->free && weight > 0 && digits > ROUGH * weight && s->rough++ == 0)
            warn(path, "positions have too few digits for kn: their rounding moves the forces of "
                 "block '%.60s' by %.1g of its weight, beside a block so large; a smaller kn helps",
                 s->p->block[small - s->body], digits / weight);
    } else if (gap < fmin(far, a->gap)) {
        a->gap = gap, a->near = j;
    }
    const bbm_material *r = &m->element[m->edge[a->edge].element].material,
                       *q = &m->element[m->edge[b->edge].element].material;
    if (count[0] > 4 && count[1] > 3 && a->elements > 1 && b->elements > 1 && a->free && b->free
        && ((r->E == q->E && r->density == q->density) || s->p->slippery) && !m->beyond->joints
        && m->beyond->tension + m->beyond->cohesion <= 0 && s->alike++ == 0)
        warn(path, "blocks '%.60s' and '%.60s' share a side, not bonded: `bond %.60s %.60s` bonds "
                   "them, `joint` says that it is meant", s->p->block[j], s->p->block[i],
             s->p->block[j], s->p->block[i]);
}

/* fall: whether a block falls that touches nothing that is held, directly or by others. What is
 * given a velocity may begin anywhere. */
static void warn_of_gaps(const bodies *s, const char *path, int fall)
{
    const model_velocity *v = s->p->velocity;
    const char *const *name = s->p->block;
    int falls = 0, gaps = 0, who = 0, at = 0;

    for (int b = 0; b < s->p->blocks; b++) {
        if (fall && !group_of(s, b)->held && !group_of(s, b)->thrown && falls++ == 0)
            who = b;
        if (isfinite(s->body[b].gap) && !v[b].given && !v[s->body[b].near].given && gaps++ == 0)
            at = b;
    }
    if (falls > 0)
        warn(path, "block '%.60s' touches nothing held: it falls (1 of %d)", name[who], falls);
    if (gaps > 0)
        warn(path, "between blocks '%.60s' and '%.60s' there is a gap of %.3g m (1 of %d)",
             name[s->body[at].near], name[at], s->body[at].gap, gaps);
}

/* E in GPa: a block that gives way to its own weight. Steps that are too long: by the time in which
 * a block falls by its own size. And those in which a body that is bonded and not held loses
 * momentum: in K its inertia stands beside its bonds, which are alpha (c dt/L)^2 times as stiff,
 * with c the velocity of sound and L the side of an element, and loses its last digits. */
static void warn_of_times(const bodies *s, const char *path)
{
    const bbm_model *m = s->p->m;
    const bbm_parameters *par = &m->par;
    const double g = hypot(par->gravity[0], par->gravity[1]);
    double fall = INFINITY, softest = 0;
    int soft = 0, stiff = -1;

    for (int e = 0; e < m->elements; e++) {
        const bbm_element *i = &m->element[e];
        const body *b = &s->body[i->block];
        const bbm_material *r = &i->material;
        const double squeezed = r->density * g * (b->box.high[2] - b->box.low[2]) / r->E;
        const double ratio = par->alpha * r->E * par->dt * par->dt / (r->density * i->A0);
        if (b->elements > b->pieces && ratio > STIFFEST && !b->held)
            stiff = e;
        if (!b->free)
            continue;
        fall = fmin(fall, sqrt(2 * b->size / g));
        if (squeezed > softest)
            softest = squeezed, soft = e;
    }
    if (softest > 0.02)
        warn(path, "its own weight would make block '%.60s' %.2g %% lower: E is %g; is it in Pa?",
             s->p->block[m->element[soft].block], 100 * softest, m->element[soft].material.E);
    if (s->p->dynamic && par->velocity_factor > 0 && par->dt > fall / 2)
        warn(path, "a step of %g s is long: a block falls by its size in %.2g s", par->dt, fall);
    if (s->p->dynamic && par->velocity_factor == 1 && stiff >= 0)
        warn(path, "a step of %g s is long: rounding takes momentum of block '%.60s', whose bonds "
             "are so stiff", par->dt, s->p->block[m->element[stiff].block]);
}

static void warn_of_bodies(const model *p, const char *path)
{
    const bbm_model *m = p->m;
    const int weighs = m->par.gravity[0] != 0 || m->par.gravity[1] != 0;
    bodies s = { .p = p, .body = malloc((size_t)p->blocks * sizeof *s.body),
                 .box = malloc((size_t)p->blocks * sizeof *s.box),
                 .next = malloc((size_t)(m->edges + p->blocks + m->elements) * sizeof *s.next) };
    char text[300];
    int held = 0;

    if (s.body && s.box && s.next) {
        s.group = s.next + m->edges;
        s.piece = s.group + p->blocks;
        bbm_find_pieces(m, s.piece);
        measure(&s);
        warn_of_pieces(&s, path);
        if (model_touches_itself(p, text))
            warn(path, "%s; blocks of their own touch", text);
        for (int b = 0; b < p->blocks; b++)
            held |= s.body[b].held;
        for (int i = 0, j = 0; bbm_next_meeting(p->blocks, s.box, &i, &j);)
            compare(&s, path, s.box[i].of, s.box[j].of);
        warn_of_gaps(&s, path, p->dynamic && held && weighs);
        if (p->slippery && (p->dynamic || s.met))
            warn(path, "no friction between blocks: `contact friction DEGREES` gives it");
        warn_of_times(&s, path);
    }
    free(s.body);
    free(s.box);
    free(s.next);
}

/* -------------------------------------------------------------------------------------- cells */

/* How many quadrilaterals lie, one behind the other, beyond the edge from vertex v on. */
static int count_rows(const bbm_model *m, int v)
{
    int rows = 0;

    for (; m->vertex[v].edge < 0 && rows < m->elements; rows++) {
        const int across = -1 - m->vertex[v].edge;
        const bbm_element *e = &m->element[m->vertex[across].element];
        if (e->n != 4)
            break;
        v = bbm_next_vertex(e, across);
    }
    return rows;
}

/* The taper of a quadrilateral x = c + xi p + eta q + xi eta g, or of the same turned, g.p p.p/h^2
 * with h the area of p and q, over the rows that lie along p. Bent along p to the curvature kappa
 * it would have to stretch along q, by kappa g.p p.p/(4 h |p|); rows bend by 1/(1 + 3/4 taper^2)
 * of what they should. One row alone is free to stretch. */
static double find_taper(const bbm_model *m, const bbm_element *e, int turned)
{
    const int v = e->first, first = v + turned;
    double x[4][2], p[2], q[2], g[2];

    for (int k = 0; k < 4; k++) {
        const bbm_node *n = &m->node[m->vertex[v + (k + turned) % 4].node];
        x[k][0] = n->x, x[k][1] = n->y;
    }
    for (int a = 0; a < 2; a++) {
        p[a] = (x[1][a] + x[2][a] - x[0][a] - x[3][a]) / 2;
        q[a] = (x[2][a] + x[3][a] - x[0][a] - x[1][a]) / 2;
        g[a] = x[0][a] - x[1][a] + x[2][a] - x[3][a];
    }
    const double h = p[0] * q[1] - p[1] * q[0], along = g[0] * p[0] + g[1] * p[1];
    const double taper = fabs(along) * (p[0] * p[0] + p[1] * p[1]) / (h * h);
    if (taper < 2 * TAPER)
        return 0;
    const int rows = 1 + count_rows(m, first) + count_rows(m, v + (turned + 2) % 4);
    return rows > 1 ? taper / rows : 0;
}

/* Cells that no bond lets bend as they should: MacNeal, Int. J. Num. Meth. Eng. 24, 1987. A few in
 * a mesh, as where it is graded, do no harm. */
static void warn_of_cells(const model *p, const char *path)
{
    const bbm_model *m = p->m;
    double most = 0;
    int cells = 0, worst = 0;

    for (int k = 0; k < 2 * m->elements && m->beyond->bonding == BBM_MOMENT; k++) {
        const bbm_element *e = &m->element[k / 2];
        const double taper = e->n == 4 ? find_taper(m, e, k % 2) : 0;
        cells += taper > TAPER;
        if (taper > most)
            most = taper, worst = k / 2;
    }
    if (10 * cells > m->elements)
        warn(path, "element %.60s of block '%.60s' is a long trapezoid (1 of %d): where rows of "
                   "such cells bend, they lock; shorter cells or parallelograms do not",
             p->element[worst], p->block[m->element[worst].block], cells);
}

/* Waves of a shake that are short for steps, and what steps leave out of a record. */
static void warn_of_shaking(const model *p, const char *path)
{
    const double dt = p->m->par.dt, end = dt * p->stage[p->stages].par.steps,
                 *a = p->m->beyond->shake, period = 2 * acos(-1) / fabs(p->m->beyond->shake_omega);

    if ((a[0] != 0 || a[1] != 0) && 6 * dt > period)
        warn(path, "a step of %g s is long: the period of shake is %.3g s", dt, period);
    if (p->shakings == 0)
        return;
    const double from = p->shaking[0].t, to = p->shaking[p->shakings - 1].t;
    double apart = INFINITY;
    for (int k = 1; k < p->shakings; k++)
        apart = fmin(apart, p->shaking[k].t - p->shaking[k - 1].t);
    if (p->shake == 0 || to > end * (1 + 1e-9) || apart < 0.999 * dt)
        warn(path, "shake has %d rows from %g s to %g s and the scale %g: steps of %g s to %g s do "
                   "not feel all of it", p->shakings, from, to, p->shake, dt, end);
}

/* A side of few grid points that touches a longer one of many: in dynamics the longer one has no
 * contacts of its own. */
static void warn_of_coarse_sides(const model *p, const char *path)
{
    const bbm_model *m = p->m;
    const bbm_contact *c = m->contact, *end = c + m->contacts;

    for (int coarse = 0; p->dynamic && c < end && !coarse; c++)
        for (int k = 0; k < 2 && c->state != BBM_OPEN && !coarse; k++) {
            const int e = k ? m->edge[c->corner].before : c->corner;
            const double apart = m->edge[m->edge[e].side].spacing;
            coarse = bbm_carries(m, e, c->edge)
                  && apart > COARSE * m->edge[m->edge[c->edge].side].spacing;
            if (coarse)
                warn(path, "the finer block '%.60s' touches block '%.60s' at points %.3g m apart "
                           "alone, and sags between them; a mesh as fine on both sides helps",
                     p->block[m->edge[c->edge].block], p->block[m->edge[e].block], apart);
        }
}

/* ------------------------------------------------------------------- before, in and after a run */

/* A hit acts in no time: its force is its impulse over a step. */
void warn_before(const model *p, const char *path)
{
    const bbm_beyond *b = p->m->beyond;
    double tension = b->tension;

    if (p->dynamic && b->multiplier_rounds > 0)
        warn(path, "bond augment has no part in dynamics; a larger alpha stiffens bonds");
    warn_of_loads(p, path);
    warn_of_bodies(p, path);
    warn_of_cells(p, path);
    warn_of_shaking(p, path);
    for (int k = 0; k < b->joints; k++)
        tension = fmax(tension, b->joint[k].tension);
    if (p->dynamic && b->restitution >= 0 && tension > 0)
        warn(path, "with restitution a hit pulls at a joint by its impulse over dt: dt decides "
                   "whether tension bears it; without restitution springs do");
}

void warn_in_step(const run *r, const char *path, int *said)
{
    const model *p = r->p;
    const double drift = p->m->info.step * p->m->info.change;
    const int ends = r->is_over && p->m->par.velocity_factor <= 0;
    double most = 0;
    int who = -1;

    for (int e = 0; e < p->m->elements && p->dynamic; e++) {
        const bbm_element *i = &p->m->element[e];
        const double way = hypot(i->D[0], i->D[1]);
        if (way * way > i->A0 * STILL * STILL && way > most)
            most = way, who = e;
        if (!*said && (*said = way * way > i->A0))
            warn(path, "step %d: element %.60s of block '%.60s' moved by %.3g m, more than its own "
                       "size; a smaller dt misses no contact", p->m->info.step, p->element[e],
                 p->block[i->block], way);
    }
    if (((!r->has_begun && r->settling == 0 && drift < 0.999) || ends) && drift > DRIFT && who >= 0)
        warn(path, "%s is not at rest: element %.60s of block '%.60s' moves by %.2g m in its last "
                   "step; more steps or a longer dt help", ends ? "the run" : "settling",
             p->element[who], p->block[p->m->element[who].block], most);
}

/* Of the forces on and in a body that has moved the share that does not balance where the last
 * static step has led. The model stays as it is, but for D, F and K. */
static double find_imbalance(bbm_model *m)
{
    bbm_pass (*const renew)(bbm_model *, bbm_pass) = m->hook->renew;
    const bbm_info info = m->info;
    double share = 0;

    if (bbm_begin_statics(m))
        return 0;
    memset(m->D, 0, 6 * (size_t)m->elements * sizeof *m->D);
    bbm_assemble(m);
    m->hook->renew = NULL;                                  /* nothing breaks */
    (void)bbm_open_close(m);
    m->hook->renew = renew;
    (void)bbm_check_equilibrium(m);
    m->info = info;
    for (int i = 0; i < m->elements; i++) {
        const bbm_balance *b = &m->beyond->balance[m->beyond->body[i]];
        const double *sum = m->element[i].sum, way = hypot(sum[0], sum[1]) / b->size;
        const double left = fmax(hypot(b->force[0], b->force[1]), fabs(b->moment) / b->size);
        if (fmax(way, fabs(sum[2])) > PARTED)
            share = fmax(share, left / (b->forces + b->inside));
    }
    return share;
}

/* Fragments that have passed into each other, or into what they fell on: those overlap in a model
 * that begins where this one has come to, in which each vertex is a node. */
static void warn_of_fragments(const model *p, const char *path)
{
    bbm_model now = *p->m;
    bbm_overlap o = { .i = -1 };

    if (now.beyond->broken == 0)
        return;
    now.node = calloc((size_t)now.vertices, sizeof *now.node);
    now.vertex = calloc((size_t)now.vertices, sizeof *now.vertex);
    for (int v = 0; v < now.vertices && now.node && now.vertex; v++) {
        now.vertex[v].node = v;
        now.node[v].x = p->m->vertex[v].x + now.origin[0];
        now.node[v].y = p->m->vertex[v].y + now.origin[1];
    }
    if (now.node && now.vertex)
        (void)bbm_find_overlap(&now, &o);
    free(now.node);
    free(now.vertex);
    if (o.i >= 0 && o.depth > now.info.penetration
        + PASSED * sqrt(fmin(now.element[o.i].A, now.element[o.j].A)))
        warn(path, "elements '%.60s' and '%.60s' are %.2g m deep in each other at (%.9g, %.9g): "
                   "what broke has passed; a smaller dt may help", p->element[o.i],
             p->element[o.j], o.depth, o.x, o.y);
}

void warn_after(const model *p, const char *path)
{
    double most = 0, strain = 0;
    char text[400];
    int stable = 1;

    for (int k = 0; k < p->monitors; k++)
        if (p->monitor[k].of == &model_force && !p->monitor[k].touched)
            warn(path, "monitor %.60s: nothing touched in its joint", p->monitor[k].name);
    for (int e = 0; e < p->m->elements && !p->dynamic; e++) {
        most = fmax(most, fabs(p->m->element[e].D[2]));
        for (int k = 3; k < 6; k++)
            strain = fmax(strain, fabs(p->m->element[e].D[k]));
    }
    if (strain > 0.1)
        warn(path, "elements strain by up to %.2g, which statics takes as small: displacements are "
                   "large beside the model; is E in Pa?", strain);
    if (most > 0.1)                             /* the way across an arm makes it 0.5 % longer */
        warn(path, "elements turn by more than 0.1 rad in the last step, which statics takes as "
                   "small: lengths are wrong; more steps help");
    if (p->m->beyond->parted > PARTED)
        warn(path, "it stands, but not as drawn: blocks slid or turned by %.2g of their size first",
             p->m->beyond->parted);
    if (p->m->beyond->breach > BBM_BALANCED)
        warn(path, "contacts or bolts were off their law by up to %.1g of the forces on a block: "
                   "positions have no more digits; a smaller kn or softer bolts help",
             p->m->beyond->breach);
    warn_of_coarse_sides(p, path);
    warn_of_fragments(p, path);
    const double lack = p->dynamic ? 0 : find_imbalance(p->m);
    const bbm_status found = p->dynamic ? BBM_OK : bbm_find_stability(p->m, &stable);
    if (found == BBM_BLOCKS_OVERLAP)
        warn(path, "contacts are missing: %s", model_says(p, found, text));
    if (found == BBM_OK && !stable)
        warn(path, "in equilibrium, but not stable: a push, however small, moves it until other "
                   "contacts stop it, or for good");
    if (lack > ELSEWHERE && most <= 0.1 && strain <= 0.1)
        warn(path, "forces lack %.1g of balance where blocks have come to: more steps help", lack);
    else if (!p->dynamic && p->stages == 0 && p->m->info.step > 1
             && p->m->info.change > UNSETTLED)
        warn(path, "the last step was %.2g of the way of all: no equilibrium yet: more steps help",
             p->m->info.change);
}
