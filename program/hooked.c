/* hooked.c - statements that take part in the library's step by its hooks. The library knows its
 * own part of bbm_beyond; what is behind it belongs to the hooks, which find it there.
 */

#include "reader.h"

/* What a bolt's direction in the middle of a step may be off [rad]: so much of the moment of its
 * force goes into the angular momentum. */
#define DIRECTION 1e-10
/* What a static step may move one end of a bolt against the other, of its length: with more its
 * force is not yet that of an equilibrium. */
#define SMALL 0.1

typedef struct {
    bbm_beyond library;
    model *p;
    bbm_hooks hook;                             /* the library's own */
} hooked;

static hooked *hooked_of(const bbm_model *m) { return (hooked *)m->beyond; }

/* --------------------------------------------------- shake FILE: a record of the acceleration */

/* A line TIME AX [AY], with as many columns as those above; what is above the first number is a
 * head. */
static int read_row(model_reader *r, char *line, model_place at, int *columns)
{
    static const char blanks[] = ",; \t\r";
    model *p = r->p;
    double x[3] = { 0 };
    int n = 0, gaps = 0;        /* 1: a comma and nothing else between two numbers, 2: no comma */

    line[strcspn(line, "#")] = '\0';
    for (char *w = line + strspn(line, blanks), *end; *w; w = end) {
        const size_t length = strcspn(w, blanks), gap = strspn(w + length, blanks);
        x[n < 3 ? n : 2] = strtod(w, &end);
        if (end != w + length)
            return (n == 0 && !p->shakings)
                   || model_fail(r, at, "not a number: '%.*s', expected TIME AX [AY]",
                                 (int)length, w);
        n++;
        end += gap;
        gaps |= *end == '\0' ? 0 : memchr(end - gap, ',', gap) ? gap == 1 : 2;
    }
    const char *why = gaps == 3 ? "both commas and blanks or ; (decimals need a point)"
                    : n == 1 ? "no second number" : n > 3 ? "more than three numbers"
                    : *columns && n != *columns ? "not as many numbers as in the rows above"
                    : !isfinite(x[0] + x[1] + x[2]) ? "a number that is not finite"
                    : p->shakings && x[0] <= p->shaking[p->shakings - 1].t
                      ? "a time that is not later than the one before" : NULL;
    if (n == 0 || why)
        return n == 0 || model_fail(r, at, "%s, expected TIME AX [AY]", why);
    *columns = n;
    return model_add(r, &p->shaking, &p->shakings, sizeof *p->shaking,
                     &(model_shaking){ x[0], { x[1], x[2] } });
}

int model_read_record(model_reader *r, const char *path)
{
    model_place at = { path, 1, NULL };
    int columns = 0;
    size_t size;

    for (char *line = model_load(r, path, &size), *next; line && !r->p->status;
         line = next, at.line++) {
        if ((next = strchr(line, '\n')) != NULL)
            *next++ = '\0';
        read_row(r, line, at, &columns);
    }
    return r->p->shakings > 1
           || model_blame(r, "%.200s has fewer than two rows, expected TIME AX [AY]", path);
}

/* ---------------------------------------------------------------------------------------- bolts */

static bbm_vertex point_of(const bbm_model *m, const scene_end *e)
{
    bbm_vertex P = { .element = e->element };

    for (int k = 0; k < 3; k++) {
        P.x += e->share[k] * m->vertex[e->vertex[k]].x;
        P.y += e->share[k] * m->vertex[e->vertex[k]].y;
    }
    return P;
}

double model_bolt_force(const bbm_model *m, const scene_bolt *b, bbm_direction *along)
{
    const bbm_vertex P = point_of(m, &b->end[0]), Q = point_of(m, &b->end[1]);
    const double length = hypot(P.x - Q.x, P.y - Q.y);

    *along = (bbm_direction){ length > 0 ? (P.x - Q.x) / length : 1,
                              length > 0 ? (P.y - Q.y) / length : 0, length };
    return b->k * (length - b->rest);
}

/* A part of a bolt as a gap: along n with the force F at the length L it resists by k along n, and
 * in statics across it a force that pulls turns back with F/L,
 *     W = k n n^T + F/L (1 - n n^T),  d0 = n F/k.
 * With exact rotations n is the direction in the middle of the step. The vector P from end to end
 * becomes P1, and L1^2 - L^2 = (P1 + P).(P1 - P). So the length changes by c n.(P1 - P), with n
 * along P1 + P and c = |P1 + P|/(L1 + L): the work is what the bolt loses, and the force keeps
 * angular momentum. A pin, which is at rest without length, resists in both directions alike. */
static void find_gap(const bbm_model *m, const scene_bolt *part, bbm_gap *g)
{
    scene_bolt b = *part;
    const bbm_vertex P = point_of(m, &b.end[0]), Q = point_of(m, &b.end[1]);
    const bbm_element *i = &m->element[P.element], *j = &m->element[Q.element];
    bbm_direction n;

    b.k *= hooked_of(m)->p->bolt[b.of].k;               /* as the bolt is now */
    const double force = model_bolt_force(m, &b, &n), L = n.length,
                 across = b.rest == 0 ? b.k : bbm_motion_of(m) ? 0 : fmax(0, force) / L;
    double c = 1, d[2];

    bbm_bonding_gap(i, &P, j, &Q, 0, g);
    g->elastic = 1;
    if (i->middle && b.rest > 0) {
        bbm_gap_length(m, g, d);                                /* P1 - P */
        const double x = 2 * L * n.x + d[0], y = 2 * L * n.y + d[1], sum = hypot(x, y);
        c = sum / (L + hypot(x - L * n.x, y - L * n.y));
        n = (bbm_direction){ x / sum, y / sum, L };
    }
    for (int a = 0; a < 4; a++) {
        const double row = a < 2 ? n.x : n.y, column = a % 2 ? n.y : n.x;
        g->W[a / 2][a % 2] = (b.k * c * c - across) * row * column + across * (a % 3 == 0);
        g->d0[a / 2] = (L - b.rest) / c * row;
    }
}

/* The bolts stand behind the library's own gaps. One that is broken holds nothing together. */
static void list_gaps(bbm_model *m)
{
    const model *p = hooked_of(m)->p;

    bbm_list_edge_gaps(m);
    for (int q = 0; q < p->parts; q++) {
        const scene_bolt *b = &p->part[q];
        const int i = b->end[0].element, j = p->bolt[b->of].k > 0 ? b->end[1].element : i;
        find_gap(m, b, bbm_add_gap(m, i, j));
    }
}

/* ------------------------------------------------------------------------------------ the hooks */

/* Gravity less the acceleration of the base in the middle of the step, which is the mean between
 * two rows. */
static bbm_status begin(bbm_model *m)
{
    const bbm_status status = hooked_of(m)->hook.begin(m);
    const model *p = hooked_of(m)->p;
    const model_shaking *q = p->shaking, *end = p->shakings ? q + p->shakings - 1 : q;
    const double t = m->info.t + m->h / 2;

    while (q < end && q[1].t < t)
        q++;
    for (int a = 0; a < 2 && q < end && t >= q->t; a++)
        m->acceleration[a] -= p->shake * (q[0].a[a] + (t - q[0].t) / (q[1].t - q[0].t)
                                                          * (q[1].a[a] - q[0].a[a]));
    return status;
}

/* After a pass: where all has settled, but a bolt has another direction than in the solution, all
 * vectors of the step are renewed. */
static bbm_pass renew(bbm_model *m, bbm_pass next)
{
    const model *p = hooked_of(m)->p;

    next = hooked_of(m)->hook.renew(m, next);
    for (int q = 0; q < p->parts && next == BBM_PASS_DONE && bbm_motion_of(m); q++) {
        const bbm_gap *g = &m->gap[m->gaps - p->parts + q];
        const scene_bolt *b = &p->part[q];
        bbm_gap now = *g;
        find_gap(m, b, &now);
        if (hypot(now.W[0][0] - g->W[0][0], now.W[0][1] - g->W[0][1])
            > DIRECTION * (b->k * p->bolt[b->of].k)) {
            bbm_set_middle(m);
            next = BBM_PASS_AGAIN;
        }
    }
    return next;
}

/* What the bolts carry: the forces of the solution. The positions to which it leads are not exact
 * enough for a pin, nor in statics, where turns are small. */
static bbm_status move(bbm_model *m)
{
    const model *p = hooked_of(m)->p;
    scene_bolt *b = p->bolt, *end = b + p->bolts;
    bbm_direction n;
    double d[2];

    for (; b < end; b++) {
        model_bolt_force(m, b, &n);
        b->way[0] = n.length * n.x, b->way[1] = n.length * n.y;
        b->force[0] = b->force[1] = 0;
    }
    for (int q = 0; q < p->parts; q++) {
        const bbm_gap *g = &m->gap[m->gaps - p->parts + q];
        bbm_gap_length(m, g, d);
        for (int a = 0; a < 2; a++)
            p->bolt[p->part[q].of].force[a] += g->W[a][0] * d[0] + g->W[a][1] * d[1];
    }
    const bbm_status status = hooked_of(m)->hook.move(m);
    for (b = p->bolt; b < end && !status; b++) {
        model_bolt_force(m, b, &n);
        const double x = n.length * n.x - b->way[0], y = n.length * n.y - b->way[1];
        b->swings = bbm_is_static(m) && hypot(x, y) > SMALL * hypot(b->way[0], b->way[1]);
        const int pushes = b->rest > 0 && n.x * b->force[0] + n.y * b->force[1] < 0;
        b->pull = hypot(b->force[0], b->force[1]) * (pushes ? -1 : 1);
    }
    return status;
}

/* No load on what is gone. */
static void gather_loads(bbm_model *m)
{
    bbm_gather_edge_loads(m);
    for (int i = 0; i < m->elements; i++)
        if (field_is_gone(m, m->element[i].first))
            memset(&m->load[6 * i], 0, 6 * sizeof *m->load);
}

int model_hook(model_reader *r)
{
    model *p = r->p;
    bbm_model *m = p->m;
    const size_t gaps = bbm_most_gaps(m), parts = (size_t)p->parts;

    if (p->stages)
        m->hook->load = gather_loads;
    if (!p->shakings && !p->bolts)
        return 1;
    hooked *b = realloc(m->beyond, sizeof *b);
    bbm_gap *gap = realloc(m->gap, (gaps + parts) * sizeof *gap);
    m->beyond = b ? &b->library : m->beyond;
    m->gap = gap ? gap : m->gap;
    if (!b || !gap)
        return model_out_of_memory(r);
    memset(gap + gaps, 0, parts * sizeof *gap);
    *b = (hooked){ b->library, p, *m->hook };
    m->hook->begin = begin;
    m->hook->renew = renew;
    m->hook->move = move;
    m->hook->list_gaps = list_gaps;
    bbm_list_gaps(m);
    bbm_note_springs(m, 0);             /* the energy of bolts that are tight */
    return 1;
}
