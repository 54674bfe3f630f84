/* warn.c - what is allowed and hardly meant: each is a line on stderr, and the run goes on. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "warn.h"

enum { NAMED = 10 };            /* pieces of a block that a warning names                       */

/* [-] (71) of the last static step above which it is said */
#define UNSETTLED 0.01

static void put_warning(const char *path, const char *text)
{
    fprintf(stderr, "%s: warning: %s\n", path, text);
}

/* What the file leaves out and hardly means. */
static void warn_of_loads(const model *p, const char *path)
{
    const bbm_model *m = p->m;
    const bbm_beyond *b = m->beyond;
    const double *g = m->par.gravity;
    const int weighs = g[0] != 0 || g[1] != 0;
    int held = b->edge_loads > 0,
        load = held || weighs || p->moving || p->shakings || b->shake[0] != 0 || b->shake[1] != 0;

    for (int n = 0; n < m->nodes; n++) {
        held |= m->node[n].held;
        load |= m->node[n].load[0] != 0 || m->node[n].load[1] != 0;
    }
    for (int k = 0; k < p->blocks; k++)
        load |= p->velocity[k].given;
    for (int e = 0; e < m->elements; e++)
        for (int k = 0; k < 3; k++)
            load |= m->element[e].stress[k] != 0;
    if (!load)
        put_warning(path, "nothing loads the model; gravity, load, traction, pressure or fix ... "
                          "by does");
    if (!held && weighs)
        put_warning(path, "nothing is fixed: under gravity all blocks fall; fixblock or fix holds "
                          "them");
    if (g[1] >= 0 && weighs)
        put_warning(path, "gravity is not downward; on earth it is: gravity 0 -9.81");
    if (p->slippery)
        put_warning(path, "no friction between blocks: `contact friction DEGREES` gives it");
}

/* A block whose elements nothing bonds together may be meant, but is said: with an element of
 * each piece. */
static void warn_of_pieces(const model *p, const char *path)
{
    const bbm_model *m = p->m;
    int *piece = calloc((size_t)m->elements + (size_t)p->blocks, sizeof *piece);

    if (!piece)
        return;
    int *count = piece + m->elements;
    bbm_find_pieces(m, piece);
    for (int e = 0; e < m->elements; e++)
        count[m->element[e].block] += piece[e] == e;
    for (int b = 0; b < p->blocks; b++) {
        int left = NAMED;
        if (count[b] < 2)
            continue;
        fprintf(stderr, "%s: warning: block '%.60s' is in %d pieces that no bond joins, with the "
                "elements", path, p->block[b], count[b]);
        for (int e = 0; e < m->elements && left > 0; e++)
            if (piece[e] == e && m->element[e].block == b)
                fprintf(stderr, "%s %s", left-- == NAMED ? "" : ",", p->element[e]);
        fprintf(stderr, "%s; elements are bonded along sides whose two nodes they share\n",
                count[b] > NAMED ? " ..." : "");
    }
    free(piece);
}

/* -------------------------------------------------------------- bodies, and what is between */

/* A block. Gaps up to NEAR of its size may be meant as none; one below TOUCH of it is none. */
typedef struct {
    double box[4], size, gap;   /* m            x and y from, to; size: root of its area        */
    int    elements, free, held, thrown, edge, near;    /* free, held: its nodes; edge: the     */
} body;                                                 /* first; near: at the gap              */

/* next: edge; group: of blocks that touch; alike: pairs of meshes of one material with the same
 * nodes along a side. */
typedef struct { const model *p; const bbm_model *m; body *body; int *next, *group, alike; } bodies;

#define NEAR 0.05
#define TOUCH 1e-6

static void measure(bodies *s)
{
    const bbm_model *m = s->m;

    for (int b = 0; b < s->p->blocks; b++) {
        s->body[b] = (body){ .box = { INFINITY, -INFINITY, INFINITY, -INFINITY }, .gap = INFINITY,
                             .edge = -1, .thrown = s->p->velocity[b].given };
        s->group[b] = b;
    }
    for (int e = 0; e < m->elements; e++) {
        body *b = &s->body[m->element[e].block];
        b->size = hypot(b->size, sqrt(m->element[e].A0));
        b->elements++;
        for (int k = m->element[e].first; k < m->element[e].first + m->element[e].n; k++) {
            const bbm_vertex *v = &m->vertex[k];
            b->box[0] = fmin(b->box[0], v->x), b->box[1] = fmax(b->box[1], v->x);
            b->box[2] = fmin(b->box[2], v->y), b->box[3] = fmax(b->box[3], v->y);
        }
    }
    for (int n = 0; n < m->nodes; n++)
        *(m->node[n].held ? &s->body[s->p->node_block[n]].held
                          : &s->body[s->p->node_block[n]].free) += 1;
    for (int k = 0; k < 2 * s->p->bolts; k++)       /* what a bolt holds is not said to fall */
        s->body[s->p->bolt[k / 2].end[k % 2].block].thrown = 1;
    for (int e = 0; e < m->edges; e++) {
        body *b = &s->body[m->element[m->edge[e].element].block];
        s->next[e] = b->edge;
        b->edge = e;
    }
}

/* The least distance, if it is below `far`, of a corner of block a from an edge of b, and how many
 * corners are corners of both. */
static double find_gap(const bodies *s, const body *a, const body *b, double far, int *shared)
{
    double gap = far;

    for (int e = a->edge; e >= 0; e = s->next[e]) {
        const bbm_vertex *P = &s->m->vertex[s->m->edge[e].a];
        if (P->x < b->box[0] - far || P->x > b->box[1] + far || P->y < b->box[2] - far
            || P->y > b->box[3] + far)
            continue;
        for (int f = b->edge; f >= 0; f = s->next[f]) {
            const bbm_vertex *Q = &s->m->vertex[s->m->edge[f].a];
            gap = fmin(gap, model_distance(s->m, e, f));
            *shared += hypot(P->x - Q->x, P->y - Q->y) <= TOUCH / NEAR * far;
        }
    }
    return gap;
}

static body *group_of(const bodies *s, int b) { return &s->body[bbm_root_of(s->group, b)]; }

static int has_strength(const bbm_beyond *b) { return b->joints || b->tension + b->cohesion > 0; }

/* Blocks that touch are a group, which is held if one of them is. Two meshes of one material with
 * the same nodes along a side were hardly meant as two. */
static void compare(bodies *s, const char *path, int i, int j)
{
    body *a = &s->body[i], *b = &s->body[j], *of = group_of(s, i), *to = group_of(s, j);
    const double size = fmin(a->size, b->size), far = NEAR * size;
    int shared = 0;

    if (a->box[0] > b->box[1] + far || b->box[0] > a->box[1] + far || a->box[2] > b->box[3] + far
        || b->box[2] > a->box[3] + far)
        return;
    const double gap = fmin(find_gap(s, a, b, far, &shared), find_gap(s, b, a, far, &(int){ 0 }));
    if (gap <= TOUCH * size) {
        to->held += of == to ? 0 : of->held;
        to->thrown |= of->thrown;
        s->group[of - s->body] = (int)(to - s->body);
    }
    if (gap < fmin(far, a->gap))
        a->gap = gap, a->near = j;
    if (gap < fmin(far, b->gap))
        b->gap = gap, b->near = i;
    const bbm_material *m = &s->m->element[s->m->edge[a->edge].element].material,
                       *n = &s->m->element[s->m->edge[b->edge].element].material;
    if (shared > 2 && a->elements > 1 && b->elements > 1 && a->free && b->free && m->E == n->E
        && m->density == n->density && !has_strength(s->m->beyond) && s->alike++ == 0)
        fprintf(stderr, "%s: warning: blocks '%.60s' and '%.60s' have nodes in the same places, "
                "but blocks are never bonded: there is a joint without tension between them; "
                "elements of one block are bonded\n", path, s->p->block[i], s->p->block[j]);
}

/* A block that touches nothing that is held, directly or by others: with the nearest one, if the
 * gap may be meant as none. */
static void warn_of_flight(const bodies *s, const char *path)
{
    int found = -1, more = 0;

    for (int b = 0; b < s->p->blocks; b++) {
        if (group_of(s, b)->held || group_of(s, b)->thrown)
            continue;
        more += found >= 0;
        if (found < 0 || s->body[b].gap < s->body[found].gap)
            found = b;
    }
    if (found < 0)
        return;
    fprintf(stderr, "%s: warning: block '%.60s'", path, s->p->block[found]);
    fprintf(stderr, more ? " and %d more touch nothing that is held: they fall" :
            " touches nothing that is held: it falls", more);
    if (s->body[found].gap > TOUCH * s->body[found].size && isfinite(s->body[found].gap))
        fprintf(stderr, "; between it and block '%.60s' there is a gap of %.3g m",
                s->p->block[s->body[found].near], s->body[found].gap);
    fputc('\n', stderr);
}

/* E in GPa: a block that gives way to its own weight. Steps that are too long or too short: by the
 * time in which a block falls by its own size, and that of a wave through an element. */
static void warn_of_times(const bodies *s, const char *path)
{
    const bbm_model *m = s->p->m;
    const bbm_parameters *par = &m->par;
    const double g = hypot(par->gravity[0], par->gravity[1]);
    double fall = INFINITY, wave = INFINITY, softest = 0;
    int soft = 0;

    for (int e = 0; e < m->elements; e++) {
        const bbm_element *i = &m->element[e];
        const body *b = &s->body[i->block];
        const bbm_material *r = &i->material;
        const double squeezed = r->density * g * (b->box[3] - b->box[2]) / r->E;
        if (!b->free)
            continue;
        fall = fmin(fall, sqrt(2 * b->size / g));
        wave = fmin(wave, sqrt(i->A0 * r->density / r->E));
        if (squeezed > softest)
            softest = squeezed, soft = e;
    }
    if (softest > 0.02)
        fprintf(stderr, "%s: warning: its own weight would make block '%.60s' %.2g %% lower: E is "
                "%g Pa; is it in Pa?\n", path, s->p->block[m->element[soft].block], 100 * softest,
                m->element[soft].material.E);
    if (s->p->dynamic && par->velocity_factor > 0 && par->dt > fall / 2)
        fprintf(stderr, "%s: warning: a step of %g s is long: a block falls by its own size in "
                "%.2g s\n", path, par->dt, fall);
    if (s->p->dynamic && isfinite(wave) && par->dt * par->steps < wave)
        fprintf(stderr, "%s: warning: the run of %g s is short: a wave needs %.2g s through an "
                "element\n", path, par->dt * par->steps, wave);
}

static void warn_of_bodies(const model *p, const char *path)
{
    const bbm_model *m = p->m;
    bodies s = { .p = p, .m = m, .body = malloc((size_t)p->blocks * sizeof *s.body),
                 .next = malloc((size_t)(m->edges + p->blocks) * sizeof *s.next) };
    int held = 0;

    if (s.body && s.next) {
        s.group = s.next + m->edges;
        measure(&s);
        for (int i = 0; i < p->blocks; i++)
            for (int j = 0; j < i; j++)
                compare(&s, path, i, j);
        if (s.alike > 1)
            fprintf(stderr, "%s: warning: in all %d pairs of blocks have this\n", path, s.alike);
        for (int b = 0; b < p->blocks; b++)
            held |= s.body[b].held;
        if (p->dynamic && held && (m->par.gravity[0] != 0 || m->par.gravity[1] != 0))
            warn_of_flight(&s, path);
        warn_of_times(&s, path);
    }
    free(s.body);
    free(s.next);
}

/* ------------------------------------------------------------------- before, in and after a run */

void warn_before(const model *p, const char *path)
{
    if (p->dynamic && p->m->beyond->multiplier_rounds > 0)
        put_warning(path, "bond augment has no part in dynamics; a larger alpha stiffens bonds");
    warn_of_loads(p, path);
    warn_of_pieces(p, path);
    warn_of_bodies(p, path);
}

void warn_in_step(const model *p, const char *path, int step, int *said)
{
    for (int e = 0; e < p->m->elements && p->dynamic && !*said; e++) {
        const bbm_element *i = &p->m->element[e];
        const double way = hypot(i->D[0], i->D[1]);
        if (way * way <= i->A0)
            continue;
        fprintf(stderr, "%s: warning: step %d: element %.60s of block '%.60s' moved by %.3g m, "
                "more than its own size; a smaller dt misses no contact\n", path, step,
                p->element[e], p->block[i->block], way);
        *said = 1;
    }
}

void warn_after(const model *p, const char *path)
{
    double most = 0;

    for (int e = 0; e < p->m->elements && !p->dynamic; e++)
        most = fmax(most, fabs(p->m->element[e].sum[2]));
    if (most > 0.1)                             /* the way across an arm makes it 0.5 % longer */
        put_warning(path, "elements turn by more than 0.1 rad, which statics takes as small: "
                          "lengths are wrong; dynamic with velocity_factor 0 has them right");
    if (!p->dynamic && p->stages == 0 && p->m->info.step > 1 && p->m->info.change > UNSETTLED)
        fprintf(stderr, "%s: warning: the last step was %.2g of the way of all: no equilibrium "
                "yet; more steps, or `static steps N tolerance VALUE`\n", path, p->m->info.change);
}

