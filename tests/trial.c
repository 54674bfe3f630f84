/* trial.c - a scene is tried: all its steps, with the ledger after each; or for some steps together with a twin, the same
 * scene otherwise (other units, order, frame, one more stone far away), of which the result is known from its own.
 *
 * Twins differ by rounding, and collisions let that grow: without limit in the end. So they are compared until some steps
 * after the first contact, and while no step is cut, for where the iteration did not settle is a matter of rounding. Not
 * so for units that are powers of two, where no bit may differ. What rounding does to a scene is what another order of
 * its blocks does: a stone far away may matter a thousand times that, for an order is but one sample of it. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scenes.h"

/* The bounds and their reasons.
 * energy             what the solver leaves, and vectors of a D that is right to 1e-5 of the largest force: its share of
 *                    what contacts hold
 * momentum           rounding, 300 steps
 * angular momentum   directions of forces that are right to the same 1e-4 turn by that share of the impulse; 3e-6 is seen
 * overlap            forces within 1e-9 of the largest agree: 1e-9 of 1e8 N at p_n = 1e6 N/m
 * cones              forces within 1e-9 of the largest agree; rounding of places makes more of stiff springs
 * other units, order, frame    the same 1e-9 of forces, over three steps in contact, for each step since the first: what a
 *                    hit makes of rounding is a velocity, which parts the twins by as much in each step; 2e-7 is seen
 * bits               smaller numbers are dropped by the solver
 * far                what is out of reach for the run has no part in it: rounding of places of 100 m */
const struct scene_rule scene_rule[RULES] = {
    [RULE_GAIN]     = { "a step makes energy, of what was there",        1e-5  },
    [RULE_MOMENTUM] = { "momentum drifts",                               1e-9  },
    [RULE_TURNING]  = { "angular momentum drifts",                       1e-5  },
    [RULE_OVERLAP]  = { "blocks overlap deeper than their contacts [m]", 1e-7  },
    [RULE_LAW]      = { "contacts leave their cones",                    1e-6  },
    [RULE_BITS]     = { "other units, powers of two, differ [m]",        1e-90 },
    [RULE_UNITS]    = { "other units differ [m]",                        1e-6  },
    [RULE_ORDER]    = { "another order differs [m]",                     1e-6  },
    [RULE_FAR]      = { "a stone far away matters [m]",                  1e-12 },
    [RULE_FRAME]    = { "another frame differs [m]",                     1e-6  },
};

enum { AFTER_CONTACT = 3, TWIN_STEPS = 60 };

typedef struct {                /* how to find the scene in its twin                                            */
    double L, M, T, angle, shift[2];
    int place[SCENE_BLOCKS];
} likeness;

/* Remembers what is larger than all so far; NaN is. */
static void note(scene_trial *t, int rule, double value, int step)
{
    if (value > t->peak[rule].most || isnan(value)) {
        t->peak[rule].most = isnan(value) ? INFINITY : value;
        t->peak[rule].step = step;
    }
    if (!(value <= scene_rule[rule].bound) && t->peak[rule].steps++ == 0)
        t->peak[rule].first = step;
}

static double beyond(double x, double allowed) { return isnan(x) ? x : fmax(0, x - allowed); }

/* Neither gravity nor anything fixed. */
static int is_isolated(const test_scene *s)
{
    int fixed = s->par.gravity[0] != 0 || s->par.gravity[1] != 0;

    for (int k = 0; k < s->blocks; k++)
        fixed = fixed || s->block[k].fixed;
    return !fixed;
}

/* What the step gained, as a share of what was there at its start. */
static double gain_of(const bbm_model *m, const scene_memory *before, const scene_ledger *start, const scene_ledger *end)
{
    double size;
    const double work = scene_work(m, before, &size);
    const double had = start->kinetic + start->elastic + start->springs;
    const double gain = end->kinetic + end->elastic + end->springs - had - work;

    return had + size > 0 ? gain / (had + size) : gain;
}

/* N. What the solver leaves in a step: rounding in K D, the way of the step in all springs; and what it reports. */
static double forces_left(const bbm_model *m, const scene_ledger *l)
{
    double F2 = 0;

    for (int i = 0; i < 6 * m->elements; i++)
        F2 += m->F[i] * m->F[i];
    return 1e-15 * (l->stiffness + m->par.p_n * m->contacts) * l->speed * m->par.dt
           + m->info.pcg.residual * sqrt(F2 * m->elements);
}

/* m. By that the lightest element may miss its place. */
static double place_left(const bbm_model *m)
{
    double least = INFINITY;
    scene_ledger l;

    for (int i = 0; i < m->elements; i++) {
        const bbm_element *e = &m->element[i];
        least = fmin(least, e->material.density * e->material.thickness * e->A0);
    }
    scene_balance(m, &l);
    return forces_left(m, &l) * m->par.dt * m->par.dt / (2 * least);
}

static void judge(const bbm_model *m, const scene_ledger *first, const scene_ledger *l, double left, double off,
                  scene_trial *t)
{
    const double drift = hypot(l->P[0] - first->P[0], l->P[1] - first->P[1]), turning = fabs(l->L - first->L);

    note(t, RULE_MOMENTUM, beyond(drift, left) / first->P_size, m->info.step);
    note(t, RULE_TURNING, beyond(turning, off) / first->L_size, m->info.step);
}

static void print_step(const bbm_model *m, const scene_ledger *l, double gain)
{
    if (m->info.step == 1)
        printf("%5s %12s %12s %12s %10s %10s %10s %7s %6s %5s %9s\n", "step", "kinetic", "elastic", "springs", "gain", "L",
               "overlap", "blocks", "passes", "cuts", "contacts");
    printf("%5d %12.6g %12.6g %12.6g %10.2g %10.4g %10.2g %3d,%3d %6d %5d %9d\n", m->info.step, l->kinetic, l->elastic,
           l->springs, gain, l->L, l->overlap, l->pair[0], l->pair[1], m->info.passes, m->info.cuts, m->info.contacts);
}

static void count(const bbm_model *m, scene_trial *t)
{
    t->steps++;
    t->passes += m->info.passes;
    t->cuts += m->info.cuts;
    t->most_passes = m->info.passes > t->most_passes ? m->info.passes : t->most_passes;
}

static void fail(const bbm_model *m, bbm_status status, scene_trial *t)
{
    t->status = status;
    snprintf(t->message, sizeof t->message, "%s", status == BBM_NO_MEMORY ? "no memory" : bbm_message(m));
}

void scene_try(const test_scene *s, int verbose, scene_trial *t)
{
    bbm_model *m;
    bbm_status status = scene_build(s, &m);
    scene_memory *before = calloc(m ? (size_t)m->elements + 1 : 1, sizeof *before);
    scene_ledger first = { 0 }, start, end;
    double left = 0, off = 0, deepest[SCENE_BLOCKS][SCENE_BLOCKS] = { { 0 } };

    memset(t, 0, sizeof *t);
    if (!status)
        scene_balance(m, &first);
    start = first;
    while (before && !status && m->info.step < s->par.steps) {
        scene_remember(m, before);
        status = bbm_step(m);
        count(m, t);
        if (status)
            break;
        scene_balance(m, &end);
        scene_overlap(m, deepest, &end);
        const double gain = gain_of(m, before, &start, &end);
        note(t, RULE_GAIN, gain, m->info.step);
        note(t, RULE_OVERLAP, end.overlap, m->info.step);
        note(t, RULE_LAW, end.law, m->info.step);
        left += forces_left(m, &end) * m->par.dt;
        off += scene_turning_off(m, before);
        if (is_isolated(s))
            judge(m, &first, &end, left, left + off, t);
        if (verbose)
            print_step(m, &end, gain);
        start = end;
    }
    if (status)
        fail(m, status, t);
    free(before);
    bbm_model_free(m);
}

/* ----------------------------------------------------------------------------------------------------- twins */

static likeness make_twin(const test_scene *s, int rule, test_scene *twin)
{
    likeness k = { .L = 1, .M = 1, .T = 1 };

    *twin = *s;
    for (int i = 0; i < SCENE_BLOCKS; i++)
        k.place[i] = i;
    if (rule == RULE_BITS && s->seed % 2)               /* M a square, for Cholesky's roots of K */
        k.L = ldexp(1, -20), k.M = ldexp(1, 14), k.T = ldexp(1, 12);
    if (rule == RULE_BITS && s->seed % 2 == 0)
        k.L = ldexp(1, 20), k.M = ldexp(1, 30), k.T = ldexp(1, -12);
    if (rule == RULE_UNITS)
        k.L = 1000, k.M = 1e-3, k.T = 1e3;
    if (rule == RULE_BITS || rule == RULE_UNITS)
        scene_in_units(twin, k.L, k.M, k.T);
    if (rule == RULE_ORDER)
        scene_shuffle(twin, k.place);
    if (rule == RULE_FAR)
        scene_add_far_stone(twin);
    if (rule == RULE_FRAME) {
        k.angle = 0.7, k.shift[0] = -3, k.shift[1] = 2;
        scene_in_frame(twin, k.angle, k.shift);
    }
    return k;
}

static double apart(const double p[2], const double q[2]) { return hypot(p[0] - q[0], p[1] - q[1]); }

/* A vector as the twin should have it, with the unit of length l. */
static void seen(const likeness *k, double x, double y, double unit, double v[2])
{
    v[0] = unit * (cos(k->angle) * x - sin(k->angle) * y);
    v[1] = unit * (sin(k->angle) * x + cos(k->angle) * y);
}

/* Largest difference of a place, or of the way in a step, of an element and its twin [m in the units of the first]. */
static double element_differs(const bbm_model *m, const bbm_element *e, const bbm_model *n, const bbm_element *f,
                              const likeness *k)
{
    double most = 0, v[2];

    for (int i = 0; i < e->n; i++) {
        const bbm_vertex *p = &m->vertex[e->first + i], *q = &n->vertex[f->first + i];
        seen(k, p->x, p->y, k->L, v);
        const double x[2] = { v[0] + k->shift[0], v[1] + k->shift[1] };
        most = fmax(most, apart(x, (double[2]){ q->x, q->y }) / k->L);
    }
    seen(k, e->V[0], e->V[1], k->L / k->T, v);
    most = fmax(most, apart(v, f->V) / k->L * n->par.dt);
    most = fmax(most, fabs(e->V[2] / k->T - f->V[2]) * n->par.dt);
    return isfinite(most) && isfinite(f->V[0]) && isfinite(e->V[0]) ? most : NAN;
}

static double differs(const bbm_model *m, const bbm_model *n, const likeness *k)
{
    int first[SCENE_BLOCKS + 1] = { 0 }, seen_of[SCENE_BLOCKS + 1] = { 0 };
    double most = 0;

    for (int i = n->elements - 1; i >= 0; i--)
        first[n->element[i].block] = i;
    for (int i = 0; i < m->elements; i++) {
        const int block = m->element[i].block, twin = k->place[block];
        const double d = element_differs(m, &m->element[i], n, &n->element[first[twin] + seen_of[block]++], k);
        if (!(d <= most))
            most = d;
    }
    return most;
}

static void compare(bbm_model *m, bbm_model *n, const likeness *k, int rule, scene_trial *t)
{
    const int steps = m->par.steps < TWIN_STEPS ? m->par.steps : TWIN_STEPS;
    double allowed = rule == RULE_FAR ? 1000 * t->rounding : 0;
    int since = 0;

    for (int left = AFTER_CONTACT, i = 0; left > 0 && i < steps; i++) {
        const bbm_status status = bbm_step(m), other = bbm_step(n);
        if (status || other) {
            if (rule == RULE_BITS && status != other)
                note(t, rule, INFINITY, i + 1);
            return;
        }
        if (rule != RULE_BITS && m->info.cuts + n->info.cuts > 0)
            return;
        allowed += rule == RULE_BITS || rule == RULE_FAR ? 0 : (i + 1) * place_left(m);
        const double difference = differs(m, n, k);
        since += rule != RULE_BITS && rule != RULE_FAR && (since > 0 || m->info.contacts > 0);
        note(t, rule, beyond(difference, allowed) / (since > 0 ? since : 1), i + 1);
        t->rounding = rule == RULE_ORDER ? fmax(t->rounding, difference) : t->rounding;
        left -= rule == RULE_BITS ? 0 : m->info.contacts > 0;
        t->steps++;
    }
}

/* Adds what the scene and its twin differ by, in the steps that can be compared. */
void scene_try_twin(const test_scene *s, int rule, scene_trial *t)
{
    static const double exact = 1e-15;
    test_scene a = *s, b;
    bbm_model *m = NULL, *n = NULL;

    a.par.pcg.tolerance = exact;
    const likeness k = make_twin(&a, rule, &b);
    if (scene_build(&a, &m) || scene_build(&b, &n))
        note(t, rule, INFINITY, 0);
    else
        compare(m, n, &k, rule, t);
    bbm_model_free(m);
    bbm_model_free(n);
}
