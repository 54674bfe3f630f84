/* page.c - what the page calls, see page.h. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "../program/run.h"
#include "../program/scene.h"
#include "../program/warn.h"
#include "page.h"

/* s that a step may take; numbers of the looks at a step. */
enum { LIMIT = 60, LOOKS = 2000000 };

typedef struct { int n, room, failed; double *x; } numbers;

struct page {
    model p;
    run r;
    bbm_status status;
    char said[700], sentence[300];
    numbers out, look, before;          /* before: states of the contacts at the last look */
    int rounds;                         /* of multipliers, at the last look */
    clock_t began;                      /* the step in hand */
};

static void put(numbers *a, int n, const double x[])
{
    if (a->n + n > a->room) {
        const int room = 2 * (a->n + n) + 1000;
        double *more = realloc(a->x, (size_t)room * sizeof *more);
        a->failed |= !more;
        if (!more)
            return;
        a->x = more;
        a->room = room;
    }
    memcpy(a->x + a->n, x, (size_t)n * sizeof *x);
    a->n += n;
}

#define PUT(a, ...)                                                                                \
    put(a, (int)(sizeof((double[]){ __VA_ARGS__ }) / sizeof(double)), (double[]){ __VA_ARGS__ })

/* ------------------------------------------------------------------------- inside a step */

static void note_look(page *g, const bbm_contact list[], int n, int what)
{
    const int count = g->look.n + 3;

    if (what == PAGE_LISTED)
        g->before.n = 0;
    for (int k = 0; k < n && what == PAGE_LISTED; k++)
        PUT(&g->before, list[k].state);
    if (g->before.n != n || g->look.n > LOOKS)
        return;
    PUT(&g->look, g->p.m->info.t, g->p.m->h, what, 0);
    for (int k = 0; k < n && !g->look.failed; k++) {
        const bbm_contact *c = &list[k];
        const int from = (int)g->before.x[k];
        g->before.x[k] = c->state;
        if (from == BBM_OPEN && c->state == BBM_OPEN)
            continue;
        PUT(&g->look, c->corner, c->edge, from, c->state, c->N, c->T, c->d_n,
            c->N < -c->strength.tension);
        g->look.x[count]++;
    }
}

/* Before each solution. A step without end is stopped. */
static int before_solution(const bbm_model *m, void *context)
{
    const bbm_contact_scratch *w = m->scratch;
    page *g = context;
    const int round = m->beyond->round, more = round > g->rounds;

    g->rounds = round;
    note_look(g, w->contact, w->contacts, w->friction_passes ? PAGE_FRICTION
              : more ? PAGE_SAME_K : w->passes ? PAGE_JUDGED : PAGE_LISTED);
    return clock() - g->began > (clock_t)LIMIT * CLOCKS_PER_SEC;
}

/* ------------------------------------------------------------------------- load and step */

page *page_load(const char *path)
{
    page *g = calloc(1, sizeof *g);

    if (!g)
        return NULL;
    if (model_read(path, 0, NULL, &g->p))
        return g;
    g->r = (run){ .p = &g->p, .settling = g->p.settle };
    g->p.m->monitor = before_solution;
    g->p.m->monitor_context = g;
    warn_before(&g->p, path);
    return g;
}

void page_free(page *g)
{
    if (!g)
        return;
    model_free(&g->p);
    free(g->out.x), free(g->look.x), free(g->before.x);
    free(g);
}

int page_state(const page *g) { return !g || g->p.status || g->status ? 2 : g->r.is_over; }

int page_step(page *g)
{
    if (page_state(g))
        return page_state(g);
    g->began = clock();
    g->look.n = 0;
    g->status = run_step(&g->r);
    if (g->r.is_over)
        warn_after(&g->p, "the run");
    if (g->status)
        run_says(&g->r, g->status, g->said);
    else if (g->look.n > 0)
        note_look(g, g->p.m->contact, g->p.m->contacts, PAGE_DONE);
    if (g->status == BBM_STOPPED)
        sprintf(strchr(g->said, 0), ", which took more than %d s", LIMIT);
    return page_state(g);
}

/* ------------------------------------------------------------------------- numbers */

static void put_vertices(page *g, const bbm_model *m)
{
    for (const bbm_vertex *v = m->vertex; v < m->vertex + m->vertices; v++)
        PUT(&g->out, field_place(m, (int)(v - m->vertex), 0), field_place(m, (int)(v - m->vertex), 1),
            v->u, v->v, m->node[v->node].held, m->element[v->element].block);
}

static void put_elements(page *g, const bbm_model *m)
{
    for (const bbm_element *e = m->element; e < m->element + m->elements; e++) {
        put(&g->out, 6, e->D);
        put(&g->out, 6, e->V);
        put(&g->out, 3, e->stress);
        PUT(&g->out, e->szz, bbm_mises(e->stress, e->szz), hypot(e->sum[0], e->sum[1]), e->material.E,
            e->material.nu, e->material.density, e->material.thickness, e->block, e->first, e->n,
            m->K->place[e - m->element]);
    }
}

static void put_edges(page *g, const bbm_model *m)
{
    for (const bbm_edge *d = m->edge; d < m->edge + m->edges; d++)
        PUT(&g->out, d->a, d->b, d->block);
}

static void put_contacts(page *g, const bbm_model *m)
{
    for (int k = 0; k < m->contacts; k++) {
        const bbm_contact *c = &m->contact[k];
        double f[2];
        field_contact_force(m, c, c->N, c->T, f);
        PUT(&g->out, c->corner, c->edge, c->state, f[0], f[1], c->N, c->T, c->d_n,
            bbm_shear_strength(&c->strength, c->N), c->slip);
    }
}

/* What turns with an edge, or varies along it, by its mean. */
static void put_loads(page *g, const bbm_model *m)
{
    scene_line l;

    for (int n = 0; n < m->nodes; n++)
        if (m->node[n].load[0] != 0 || m->node[n].load[1] != 0)
            PUT(&g->out, m->adjacent[m->adjacent_first[n]], -1, m->node[n].load[0],
                m->node[n].load[1]);
    for (int k = 0; scene_edge_load(m, k, &l); k++) {
        const bbm_vertex *a = &m->vertex[l.a], *b = &m->vertex[l.b];
        const double length = hypot(b->x - a->x, b->y - a->y);
        double f[2] = { -l.pressure * (b->y - a->y) / length, l.pressure * (b->x - a->x) / length };
        for (int q = 0; q < l.loads; q++)
            f[0] += l.q[q][0] / l.loads, f[1] += l.q[q][1] / l.loads;
        PUT(&g->out, l.a, l.b, f[0], f[1]);
    }
}

/* i - back is the column. */
static void put_pattern(page *g, const bbm_model *m)
{
    const bbm_matrix *K = m->K;

    for (int i = 0; i < K->n; i++)
        for (int b = K->first[i]; b < K->first[i + 1]; b++)
            PUT(&g->out, i, i - K->back[b]);
}

/* The time is that of ./bbm, the nominal one. */
static void put_facts(page *g, const bbm_model *m)
{
    const bbm_info *i = &m->info;
    bbm_energy e;
    double x[MODEL_FOLLOWED];

    bbm_energies(m, &e);
    PUT(&g->out, i->step, g->p.dynamic ? i->step * m->par.dt : 0, m->par.steps, g->p.dynamic,
        g->r.settling, g->p.settle, g->r.has_begun, m->par.dt, i->passes, i->iterations,
        i->pcg.residual, i->cuts, i->contacts, i->penetration, i->candidates, i->change, e.kinetic,
        e.elastic, e.springs, m->beyond->work, m->beyond->gained, g->p.scale);
    for (int k = 0; k < g->p.monitors; k++) {
        model_follow(&g->p, &g->p.monitor[k], x);
        put(&g->out, MODEL_FOLLOWED, x);
    }
}

static void put_expectations(page *g, const bbm_model *m)
{
    (void)m;
    for (int k = 0; k < g->p.expectations; k++) {
        const model_expected *e = &g->p.expected[k];
        PUT(&g->out, e->monitor, e->kind, e->value, e->within, run_is_met(&g->p, k, g->sentence));
    }
}

static void put_looks(page *g, const bbm_model *m) { (void)m, put(&g->out, g->look.n, g->look.x); }

int page_numbers(page *g, int what)
{
    static const struct { int what; void (*put)(page *g, const bbm_model *m); } table[] = {
        { 'v', put_vertices }, { 'e', put_elements }, { 'd', put_edges }, { 'c', put_contacts },
        { 'l', put_loads }, { 'k', put_pattern }, { 'f', put_facts }, { 'x', put_expectations },
        { 'p', put_looks },
    };

    g->out.n = g->out.failed = 0;
    for (int k = 0; k < LENGTH(table) && !g->p.status; k++)
        if (table[k].what == what)
            table[k].put(g, g->p.m);
    return g->out.failed || g->look.failed ? -1 : g->out.n;
}

double *page_data(page *g) { return g->out.x; }

/* ------------------------------------------------------------------------- texts */

const char *page_text(page *g, int what, int k)
{
    const model *p = &g->p;

    if (!g || what == 'm')
        return !g ? "out of memory" : g->p.status ? p->message : g->said;
    if (g->p.status || k < 0)
        return "";
    if (what == 'x' && k < p->expectations)
        run_is_met(p, k, g->sentence);
    return what == 't' && p->title ? p->title
         : what == 'b' && k < p->blocks ? p->block[k]
         : what == 'e' && k < p->m->elements ? p->element[k]
         : what == 'o' && k < p->monitors ? p->monitor[k].name
         : what == 'q' && k < p->monitors ? p->monitor[k].of->kinds
         : what == 'n' && k < p->m->vertices ? p->node[p->m->vertex[k].node]
         : what == 'x' && k < p->expectations ? g->sentence : "";
}
