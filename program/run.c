/* run.c - a run of a model file, step by step, and what came out of it. */

#include "run.h"

/* Bolts that carried more than their strength in the last step break: in statics if it has found an
 * equilibrium, or without a tolerance led near one. */
static void break_bolts(const model *p)
{
    const bbm_parameters *par = &p->m->par;
    const int balances = p->dynamic || par->tolerance <= 0 || p->m->info.change <= par->tolerance;

    for (scene_bolt *b = p->bolt; b < p->bolt + p->bolts && balances; b++)
        if (b->pull > b->strength && !b->swings)
            b->k = b->pull = 0, b->until = p->m->info.t;
}

/* A quasi-static step without shaking. In the first half of them no joint breaks: inertia still
 * bears the weight there, and a load may act on a joint alone. */
static bbm_status settle(run *r)
{
    bbm_model *m = r->p->m;
    const bbm_parameters par = m->par;
    double *now = m->beyond->shake;
    const double shake[2] = { now[0], now[1] }, scale = r->p->shake;

    break_bolts(r->p);
    m->par.velocity_factor = now[0] = now[1] = r->p->shake = 0;
    m->beyond->joints_hold = 2 * r->settling > r->p->settle;
    const bbm_status status = bbm_step(m);
    m->par = par;
    m->beyond->joints_hold = 0;
    memcpy(now, shake, sizeof shake);
    r->p->shake = scale;
    r->settling -= !status;
    return status;
}

/* The rest of the way of a displaced support is even over the time that is left of the ramp, which
 * ends with the stage. */
static void move_supports(const model *p)
{
    const bbm_model *m = p->m;
    const double dt = m->par.dt, steps = m->par.steps - p->begun,
                 whole = p->now || isinf(p->ramp) ? dt * steps : INFINITY,
                 left = fmin(p->ramp, whole) - dt * (m->info.step - p->begun),
                 share = p->dynamic && left > dt ? dt / left : 1;

    for (int n = 0; n < m->nodes && p->moving; n++) {
        const double *at = m->node[n].wall, *to = p->stage[p->now].node[n].wall;
        if (m->node[n].held)
            bbm_move_support(p->m, n, at[0] + share * (to[0] - at[0]),
                             at[1] + share * (to[1] - at[1]));
    }
}

bbm_status run_step(run *r)
{
    bbm_model *m = r->p->m;
    const bbm_parameters *par = &m->par;

    if (r->settling)
        return settle(r);
    if (!r->has_begun) {
        r->has_begun = 1;
        m->info.t = m->info.step = 0;
        return model_start(r->p) ? BBM_OK : BBM_NO_MEMORY;
    }
    if (r->stage_is_over)
        model_next_stage(r->p);
    r->stage_is_over = 0;
    if (m->info.step == par->steps)
        return BBM_STEPS_EXHAUSTED;
    break_bolts(r->p);
    move_supports(r->p);
    const bbm_status status = bbm_step(m);
    if (!status && bbm_start_cracks(m))                         /* what has come off is a body  */
        return bbm_out_of_memory(m);
    r->stage_is_over = !status && (par->tolerance > 0 ? m->info.change <= par->tolerance
                                                      : m->info.step == par->steps);
    for (int k = 0; k < r->p->bolts && !r->p->dynamic; k++)     /* one breaks in the next step */
        r->stage_is_over &= r->p->bolt[k].pull <= r->p->bolt[k].strength;
    r->is_over = r->stage_is_over && r->p->now == r->p->stages;
    return status;
}

/* The library's own message may name the step. Joints may have a strength that they can lose. */
void run_says(const run *r, bbm_status status, char out[500])
{
    const bbm_model *m = r->p->m;
    const bbm_beyond *b = m->beyond;
    int strong = b->cohesion > 0 || b->tension > 0;
    char text[400], step[30];

    for (int k = 0; k < b->joints; k++)
        strong |= b->joint[k].cohesion > 0 || b->joint[k].tension > 0;
    snprintf(step, sizeof step, "step %d: ", m->info.step + 1);
    if (status == BBM_STEPS_EXHAUSTED)
        snprintf(out, 500, m->par.tolerance > 0
                 ? "step %d: no equilibrium, change %.2g, expected %.2g; more steps, or a larger "
                   "tolerance, may help"
                 : "step %d: a bolt carries more than its strength; more steps may help",
                 m->info.step, m->info.change, m->par.tolerance);
    else
        snprintf(out, 500, "%s%s%.380s%s", r->has_begun ? "" : "settling, ",
                 strstr(model_says(r->p, status, text), "step ") ? "" : step, text,
                 status == BBM_NO_EQUILIBRIUM && strong
                 ? "; a joint breaks point by point, the sooner the finer its mesh" : "");
}

int run_is_met(const model *p, int k, char out[300])
{
    const model_expected *e = &p->expected[k];
    model_monitor *m = &p->monitor[e->monitor];
    const int value = e->kind < m->of->values;
    char what[100];
    double x[MODEL_FOLLOWED];

    model_follow(p, m, x);
    const double got = value ? x[e->kind] : hypot(x[0], x[1]);
    const int met = value ? fabs(got - e->value) <= e->within
                  : e->kind == MODEL_MOVES ? got > e->within : got < e->within;
    const char *kind = value ? m->of->name[e->kind]
                     : e->kind == MODEL_MOVES ? "moves by more" : "stays by less";
    snprintf(what, sizeof what, value ? "%s %.6g within %.2g" : "%s than %.6g", kind,
             value ? e->value : e->within, e->within);
    snprintf(out, 300, "%s %s %s; computed: %.6g %s: %s", m->name, what, m->of->unit, got,
             m->of->unit, met ? "ok" : "NOT MET");
    return met;
}
