/* page.c - what the page calls, see page.h. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "../program/run.h"
#include "../program/scene.h"
#include "page.h"

/* LIMIT    s that a step may take
 * PULLED   solutions that a step may take while a hand pulls: then it slips
 * LOOKS    numbers of the looks at a step */
enum { LIMIT = 60, PULLED = 60, LOOKS = 2000000 };

/* The spring of a hand.
 * SAG      its length under the weight of the block, against the block's size
 * SWING    steps in a radian of its swing, where nothing has a weight
 * DAMPING  against that which lets nothing swing
 * MOST     its largest force, against the weight
 * DEEP     how deep that force may press a contact, against the block's size */
#define SAG     0.05
#define SWING   10
#define DAMPING 0.7
#define MOST    20
#define DEEP    0.01

typedef struct { int n, room, failed; double *x; } numbers;

typedef struct {                        /* of a point of an element, which it pulls to a place */
    int    element;                     /* -1: it holds nothing */
    double k, c, most;                  /* N/m, N s/m, N */
    double at[2], to[2], f[2];          /* m from model.origin; N, on the point */
} hand;

struct page {
    model p;
    run r;
    bbm_status status;
    char said[700], sentence[300];
    numbers out, look, before;          /* before: states of the contacts at the last look */
    int rounds;                         /* of multipliers, at the last look */
    clock_t began;                      /* the step in hand */
    hand hand;
    int steps;                          /* those of the file */
    bbm_hooks library;                  /* behind the hooks of the hand */
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
    return clock() - g->began > (clock_t)LIMIT * CLOCKS_PER_SEC
        || (g->hand.element >= 0 && m->info.passes > PULLED);
}

/* ------------------------------------------------------------------------- a hand */

/* Its force is a load that depends on D, so that no step is too long for it:
 *     f = f0 - s T D,    f0 = k (to - at), at most `most`,    s = k + c/h.
 * Writes f0, and T at the point; returns s. */
static double find_pull(const page *g, double f0[2], double T[2][6])
{
    const hand *a = &g->hand;
    const bbm_model *m = g->p.m;
    const double x = a->to[0] - a->at[0], y = a->to[1] - a->at[1];
    const double k = a->k * hypot(x, y) > a->most ? a->most / hypot(x, y) : a->k;

    f0[0] = k * x, f0[1] = k * y;
    bbm_step_matrix(&m->element[a->element], a->at[0], a->at[1], T);
    return a->k + (bbm_is_static(m) ? 0 : a->c / m->h);
}

/* Adds T^T f0 to the loads, and s T^T T to K. */
static void load_by_hand(bbm_model *m)
{
    const page *g = m->monitor_context;
    const int e = g->hand.element;
    double T[2][6], K[6][6], f0[2];

    if (g->library.load)
        g->library.load(m);
    if (e < 0)
        return;
    const double s = find_pull(g, f0, T);
    bbm_point_load(&m->element[e], g->hand.at[0], g->hand.at[1], f0, &m->load[6 * e]);
    for (int i = 0; i < 36; i++)
        K[i / 6][i % 6] = s * (T[0][i / 6] * T[0][i % 6] + T[1][i / 6] * T[1][i % 6]);
    bbm_matrix_add(m->K, e, e, K);
}

/* The load becomes that of the solution, T^T f, so that its work is in the balance. The point moves
 * with its element. */
static bbm_status move_by_hand(bbm_model *m)
{
    page *g = m->monitor_context;
    hand *a = &g->hand;
    double T[2][6], f0[2], u[2], more[2] = { 0, 0 };

    if (a->element < 0)
        return g->library.move(m);
    const bbm_element *e = &m->element[a->element];
    const double *D = &m->D[6 * a->element], s = find_pull(g, f0, T);
    for (int i = 0; i < 12; i++)
        more[i / 6] -= s * T[i / 6][i % 6] * D[i % 6];
    bbm_point_load(e, a->at[0], a->at[1], more, &m->load[6 * a->element]);
    bbm_move(bbm_motion_of(m), e, D, a->at[0], a->at[1], u);
    const bbm_status status = g->library.move(m);
    for (int r = 0; r < 2 && !status; r++)
        a->f[r] = f0[r] + more[r], a->at[r] += u[r];
    return status;
}

/* A run that is over goes on, by as many steps as the file has. */
static void go_on(page *g)
{
    bbm_parameters *par = &g->p.m->par;
    const int last = g->p.m->info.step + g->steps;

    g->r.stage_is_over &= !g->r.is_over;
    g->r.is_over = 0;
    if (g->p.now == g->p.stages && par->steps < last)
        par->steps = last;
}

/* The spring is as stiff as the block is heavy, or in statics as the material, so that the point
 * follows. */
void page_hold(page *g, int element, double x, double y)
{
    const bbm_model *m = g->p.m;
    double mass = 0, area = 0;

    g->hand.element = -1;
    if (page_state(g) == 2)
        return;
    go_on(g);
    if (element < 0 || element >= m->elements)
        return;
    const bbm_material *of = &m->element[element].material;
    for (const bbm_element *e = m->element; e < m->element + m->elements; e++)
        if (e->block == m->element[element].block) {
            area += e->A0;
            mass += e->A0 * e->material.density * e->material.thickness;
        }
    const double weight = mass * hypot(m->par.gravity[0], m->par.gravity[1]);
    const double k = !g->p.dynamic ? of->E * of->thickness
                   : weight > 0 ? weight / (SAG * sqrt(area)) : mass / pow(SWING * m->par.dt, 2);
    const double most = fmin(weight > 0 ? MOST * weight : INFINITY, DEEP * m->par.p_n * sqrt(area));
    const double X = x - m->origin[0], Y = y - m->origin[1], c = 2 * DAMPING * sqrt(k * mass);
    g->hand = (hand){ element, k, c, g->p.dynamic ? most : INFINITY, { X, Y }, { X, Y }, { 0, 0 } };
}

void page_pull(page *g, double x, double y)
{
    g->hand.to[0] = x - g->p.m->origin[0];
    g->hand.to[1] = y - g->p.m->origin[1];
    go_on(g);
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
    g->hand.element = -1;
    g->steps = g->p.m->par.steps;
    g->library = *g->p.m->hook;
    g->p.m->hook->load = load_by_hand;
    g->p.m->hook->move = move_by_hand;
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

static void begin_step(page *g)
{
    g->began = clock();
    g->look.n = 0;
    g->status = run_step(&g->r);
}

/* A step that a hand makes fail is done again without the hand. */
int page_step(page *g)
{
    if (page_state(g))
        return page_state(g);
    const bbm_model *m = g->p.m;
    const int held = g->hand.element;
    if (held >= 0 && field_is_gone(m, m->element[held].first))
        g->hand.element = -1;
    if (held >= 0 && g->p.dynamic)
        go_on(g);
    begin_step(g);
    if (g->status && g->hand.element >= 0) {
        g->hand.element = -1;
        begin_step(g);
    }
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
    for (int k = 0; k < m->vertices; k++) {
        const bbm_vertex *v = &m->vertex[k];
        const int is_there = !field_is_gone(m, k);
        PUT(&g->out, field_place(m, k, 0), field_place(m, k, 1), is_there * v->u, is_there * v->v,
            m->node[v->node].held, m->element[v->element].block);
    }
}

static void put_elements(page *g, const bbm_model *m)
{
    for (const bbm_element *e = m->element; e < m->element + m->elements; e++) {
        put(&g->out, 6, e->D);
        put(&g->out, 6, e->V);
        put(&g->out, 3, e->stress);
        PUT(&g->out, e->szz, bbm_mises(e->stress, e->szz), hypot(e->sum[0], e->sum[1]),
            e->material.E, e->material.nu, e->material.density, e->material.thickness, e->block,
            e->first, e->n, m->K->place[e - m->element]);
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
        field_contact_force(m, c, field_acts(c, 0), field_acts(c, 1), f);
        PUT(&g->out, c->corner, c->edge, c->state, f[0], f[1], field_acts(c, 0), field_acts(c, 1),
            c->d_n, bbm_shear_strength(&c->strength, c->N), c->slip);
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

static void put_hand(page *g, const bbm_model *m)
{
    const hand *a = &g->hand;
    const double *o = m->origin;

    if (a->element >= 0)
        PUT(&g->out, a->element, a->at[0] + o[0], a->at[1] + o[1], a->to[0] + o[0], a->to[1] + o[1],
            a->f[0], a->f[1]);
}

static void put_bolts(page *g, const bbm_model *m)
{
    for (int n = 0; n < 2 * g->p.bolts; n++)
        if (m->info.t < g->p.bolt[n / 2].until) {
            const scene_end *e = &g->p.bolt[n / 2].end[n % 2];
            PUT(&g->out, e->vertex[0], e->vertex[1], e->vertex[2], e->share[0], e->share[1],
                e->share[2]);
        }
}

static void put_looks(page *g, const bbm_model *m) { (void)m, put(&g->out, g->look.n, g->look.x); }

int page_numbers(page *g, int what)
{
    static const struct { int what; void (*put)(page *g, const bbm_model *m); } table[] = {
        { 'v', put_vertices }, { 'e', put_elements }, { 'd', put_edges }, { 'c', put_contacts },
        { 'l', put_loads }, { 'k', put_pattern }, { 'f', put_facts }, { 'x', put_expectations },
        { 'p', put_looks }, { 'h', put_hand }, { 'b', put_bolts },
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
