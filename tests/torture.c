/* torture.c - `make torture`: scenes that nobody has looked at, seed after seed, and what must hold in every step of them.
 *
 *     make torture                        a minute of scenes, from seed 1 on
 *     make torture SEED=17 SCENES=1       one of them, each step
 *     make torture KIND=box TIME=600      one kind, ten minutes
 *
 * Prints what breaks a rule as it goes, with the seed that repeats it; exit 1 if anything did. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "scenes.h"

/* A step may gain that share of what is there: rounding, and what the solver leaves. */
#define GAIN 1e-5

typedef struct {
    uint64_t seed;
    int scenes, kind, verbose;
    double seconds;
} wish;

typedef struct {
    long scenes, steps, findings, passes, cuts;
    int most_passes;
    uint64_t most_seed, gain_seed;
    double gain;
    long status[BBM_STATUS_COUNT];
} tally;

typedef struct { double most; int step, times; } worst;

static void note(worst *w, double value, int step)
{
    w->times++;
    if (value > w->most) {
        w->most = value;
        w->step = step;
    }
}

static void report(const test_scene *s, const worst *w, const char *what, double bound, tally *t)
{
    if (w->times == 0)
        return;
    t->findings++;
    printf("seed %llu %s: %s %.3g at step %d, more than %.3g; %d steps\n", (unsigned long long)s->seed, scene_name(s->kind),
           what, w->most, w->step, bound, w->times);
}

/* One step, and its balance: the share of what is there that it gained. */
static bbm_status balanced_step(bbm_model *m, double (*before)[2], scene_ledger *l, double *gain)
{
    const double start = l->kinetic + l->elastic + l->springs;
    double size;

    scene_barycentres(m, before);
    const bbm_status status = bbm_step(m);
    if (status)
        return status;
    scene_balance(m, l);
    const double work = scene_work(m, before, &size), more = l->kinetic + l->elastic + l->springs - start - work;
    *gain = start + size > 0 ? more / (start + size) : 0;
    return BBM_OK;
}

static void print_scene(const test_scene *s, const bbm_model *m)
{
    const bbm_parameters *p = &s->par;

    printf("seed %llu, %s: %d blocks, %d elements, dt %g, %d steps, p_n %g, p_s %g, friction %.3g, gravity %g\n",
           (unsigned long long)s->seed, scene_name(s->kind), s->blocks, m->elements, p->dt, p->steps, p->p_n, p->p_s,
           p->friction, p->gravity[1]);
    printf("%5s %12s %12s %12s %10s %6s %5s %9s\n", "step", "kinetic", "elastic", "springs", "gain", "passes", "cuts",
           "contacts");
}

static void run_scene(const test_scene *s, const wish *w, tally *t)
{
    bbm_model *m;
    scene_ledger l;
    worst gain = { 0 };
    bbm_status status = scene_build(s, &m);
    double (*before)[2] = calloc(m ? (size_t)m->elements + 1 : 1, sizeof *before), g = 0;

    if (w->verbose)
        print_scene(s, m);
    scene_balance(m, &l);
    while (!status && m->info.step < s->par.steps) {
        status = balanced_step(m, before, &l, &g);
        if (w->verbose)
            printf("%5d %12.6g %12.6g %12.6g %10.2g %6d %5d %9d\n", m->info.step, l.kinetic, l.elastic, l.springs, g,
                   m->info.passes, m->info.cuts, m->info.contacts);
        if (!(g <= GAIN))
            note(&gain, isnan(g) ? INFINITY : g, m->info.step);
        if (g > t->gain)
            t->gain = g, t->gain_seed = s->seed;
        if (m->info.passes > t->most_passes)
            t->most_passes = m->info.passes, t->most_seed = s->seed;
        t->steps++;
        t->passes += m->info.passes;
        t->cuts += m->info.cuts;
    }
    t->scenes++;
    t->status[status]++;
    if (status) {
        t->findings++;
        printf("seed %llu %s: %s\n", (unsigned long long)s->seed, scene_name(s->kind), bbm_message(m));
    }
    report(s, &gain, "a step gains the share", GAIN, t);
    free(before);
    bbm_model_free(m);
}

static void print_tally(const tally *t)
{
    printf("%ld scenes, %ld steps, %ld findings; largest gain of a step %.3g (seed %llu); solutions: %.2f a step, at most "
           "%d (seed %llu); %ld cuts\n", t->scenes, t->steps, t->findings, t->gain, (unsigned long long)t->gain_seed,
           (double)t->passes / (double)(t->steps > 0 ? t->steps : 1), t->most_passes, (unsigned long long)t->most_seed,
           t->cuts);
    for (int k = 1; k < BBM_STATUS_COUNT; k++)
        if (t->status[k] > 0)
            printf("    %ld times: %s\n", t->status[k], bbm_status_text((bbm_status)k));
}

static int kind_of(const char *name)
{
    for (int k = 0; k < SCENE_KINDS; k++)
        if (strcmp(name, scene_name((scene_kind)k)) == 0)
            return k;
    return -1;
}

/* torture [seed [scenes [seconds [kind]]]], scenes 0: until the time is over */
int main(int count, char **argument)
{
    wish w = { .seed = 1, .kind = -1, .seconds = 60 };
    tally t = { 0 };
    test_scene s;
    const time_t start = time(NULL);

    setvbuf(stdout, NULL, _IOLBF, BUFSIZ);
    w.seed = count > 1 ? strtoull(argument[1], NULL, 10) : w.seed;
    w.scenes = count > 2 ? atoi(argument[2]) : w.scenes;
    w.seconds = count > 3 ? atof(argument[3]) : w.seconds;
    w.kind = count > 4 ? kind_of(argument[4]) : w.kind;
    w.verbose = w.scenes == 1;
    for (int k = 0; (w.scenes == 0 || k < w.scenes) && difftime(time(NULL), start) < w.seconds; k++) {
        scene_make(w.seed + (uint64_t)k, w.kind, &s);
        run_scene(&s, &w, &t);
    }
    print_tally(&t);
    return t.findings > 0;
}
