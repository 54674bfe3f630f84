/* torture.c - `make torture`: scenes that nobody has looked at, seed after seed, and what must hold in every step of them.
 *
 *     make torture                        a minute of scenes, from seed 1 on
 *     make torture SEED=17 SCENES=1       one of them, each step
 *     make torture KIND=box TIME=600      one kind, ten minutes
 *
 * Prints what breaks a rule as it goes, with the seed that repeats it; exit 1 if anything did. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "scenes.h"

typedef struct {
    uint64_t seed;
    int scenes, kind, verbose;
    double seconds;
} wish;

typedef struct {
    long scenes, steps, findings, passes, cuts, status[BBM_STATUS_COUNT], broken[RULES];
    int most_passes;
    uint64_t most_seed, peak_seed[RULES];
    double peak[RULES];
} tally;

static void print_scene(const test_scene *s)
{
    const bbm_parameters *p = &s->par;
    int elements = 0;

    for (int k = 0; k < s->blocks; k++)
        elements += s->block[k].elements;
    printf("%d blocks, %d elements, %d steps, p_s %g, gravity %g, alpha %g, bonding %d, cohesion %g, tension %g\n", s->blocks,
           elements, p->steps, p->p_s, p->gravity[1], p->alpha, (int)s->bonding, s->cohesion, s->tension);
}

static void print_name(const test_scene *s)
{
    printf("seed %llu %s (p_n %g, dt %g, friction %g): ", (unsigned long long)s->seed, scene_name(s->kind), s->par.p_n,
           s->par.dt, s->par.friction);
}

static void report(const test_scene *s, const scene_trial *f, tally *t)
{
    if (f->status && f->status != BBM_TOO_SOFT) {                /* which is an answer */
        t->findings++;
        print_name(s);
        printf("%s\n", f->message);
    }
    for (int r = 0; r < RULES; r++)
        if (f->peak[r].steps > 0) {
            t->findings++;
            t->broken[r]++;
            print_name(s);
            printf("%s: %.3g at step %d, at most %.3g; %d steps, from %d on\n", scene_rule[r].text, f->peak[r].most,
                   f->peak[r].step, scene_rule[r].bound, f->peak[r].steps, f->peak[r].first);
        }
}

static void add_to(tally *t, const test_scene *s, const scene_trial *f)
{
    t->scenes++;
    t->steps += f->steps;
    t->passes += f->passes;
    t->cuts += f->cuts;
    t->status[f->status]++;
    if (f->most_passes > t->most_passes)
        t->most_passes = f->most_passes, t->most_seed = s->seed;
    for (int r = 0; r < RULES; r++)
        if (f->peak[r].most > t->peak[r])
            t->peak[r] = f->peak[r].most, t->peak_seed[r] = s->seed;
}

static void run_scene(const test_scene *s, const wish *w, tally *t)
{
    scene_trial f;

    if (w->verbose) {
        print_name(s);
        print_scene(s);
    }
    scene_try(s, w->verbose, &f);
    for (int rule = RULE_BITS; rule < RULES; rule++)
        scene_try_twin(s, rule, &f);
    report(s, &f, t);
    add_to(t, s, &f);
}

static void print_tally(const tally *t)
{
    printf("\n%ld scenes, %ld steps, %ld findings; solutions: %.2f a step, at most %d (seed %llu); %ld cuts\n", t->scenes,
           t->steps, t->findings, (double)t->passes / (double)(t->steps > 0 ? t->steps : 1), t->most_passes,
           (unsigned long long)t->most_seed, t->cuts);
    for (int r = 0; r < RULES; r++)
        printf("    %-48s at most %-9.3g (seed %llu), %ld scenes beyond %g\n", scene_rule[r].text, t->peak[r],
               (unsigned long long)t->peak_seed[r], t->broken[r], scene_rule[r].bound);
    for (int k = 1; k < BBM_STATUS_COUNT; k++)
        if (t->status[k] > 0)
            printf("    %ld scenes: %s\n", t->status[k], bbm_status_text((bbm_status)k));
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
