/* column.c - a column of ten blocks at rest.
 *
 *      .---.                        blocks 1 m x 1 m, 2500 kg/m^3, t = 1 m, on a fixed base; p_n = 1e9 N/m
 *      | 10|
 *      |---|                        Interface k, below block k, carries the weight of the blocks k .. 10:
 *       ...                             F = (11 - k) W,   W = 2500 kg/m^3 * 1 m^3 * 9.81 m/s^2 = 24,525 N,
 *      |---|                        one half at each of its two corners, which sink in by F/(2 p_n).
 *      | 1 |
 *   ___'---'___                     Once at rest it stays there: no velocity, no drift in 1,000 dynamic steps.
 *   ///////////
 *
 * A hundred quasi-static steps lead to equilibrium. What they cannot take away is no error: the blocks are
 * squeezed and bulge, the lower ones more, so that friction pulls inwards at one corner and outwards at the other. */
#include <math.h>

#include "case.h"

enum { BLOCKS = 10, SETTLE = 100, STEPS = 1000 };

static const double W = 2500 * 9.81, p_n = 1e9;

static bbm_model *build_column(void)
{
    bbm_model *m = case_model();

    bbm_add_material(m, &(bbm_material){ 1e14, 0.25, 2500, 1 }, NULL);
    bbm_add_material(m, &(bbm_material){ 1e10, 0.25, 2500, 1 }, NULL);
    case_add_box(m, &(case_box){ .nx = 1, .ny = 1, .x = -2, .y = -1, .w = 5, .h = 1 });
    case_fix_block(m, 0);
    for (int k = 1; k <= BLOCKS; k++)
        case_add_box(m, &(case_box){ .block = k, .material = 1, .nx = 1, .ny = 1, .y = k - 1, .w = 1, .h = 1 });
    m->par.dt = 0.01;
    m->par.gravity[1] = -9.81;
    m->par.p_n = p_n;
    m->par.p_s = 0.4 * p_n;
    m->par.friction = 30;
    m->par.pcg.tolerance = 1e-14;
    case_must(m, bbm_prepare(m));
    return m;
}

/* The normal forces and the penetrations of interface k: their sum, and the mean depth of its closed corners. */
static void measure_interface(const bbm_model *m, int k, double *force, double *depth)
{
    int corners = 0;

    *force = *depth = 0;
    for (int i = 0; i < m->contacts; i++) {
        const bbm_contact *c = &m->contact[i];
        const int a = m->element[m->edge[c->corner].element].block, b = m->element[m->edge[c->edge].element].block;
        if (c->state == BBM_OPEN || (a > b ? a : b) != k)
            continue;
        *force += c->N;
        *depth -= c->d_n;
        corners++;
    }
    *depth /= corners;
}

/* How fast the fastest block is, and how far one has come since `place`. */
static void measure_motion(const bbm_model *m, double place[BLOCKS + 1][2], double *speed, double *drift)
{
    *speed = *drift = 0;
    for (int k = 1; k <= BLOCKS; k++) {
        const bbm_element *e = &m->element[k];
        *speed = fmax(*speed, hypot(e->V[0], e->V[1]));
        *drift = fmax(*drift, hypot(e->sum[0] - place[k][0], e->sum[1] - place[k][1]));
    }
}

int main(void)
{
    bbm_model *m = build_column();
    case_results r;
    case_effort effort = { 0, 0 };
    scene s = { .title = "Contact forces in a column of ten blocks" };
    double place[BLOCKS + 1][2], speed, drift;

    printf("\n# Column of ten blocks at rest\n\n");
    case_open(&r, "column");
    case_settle(m, SETTLE);
    m->info.t = 0;
    for (int k = 1; k <= BLOCKS; k++)
        place[k][0] = m->element[k].sum[0], place[k][1] = m->element[k].sum[1];
    for (int i = 0; i < STEPS; i++)
        case_step(m, &effort, NULL);
    measure_motion(m, place, &speed, &drift);
    printf("| after %d steps | computed | theory | error |\n|---|---|---|---|\n", STEPS);
    for (int k = 1; k <= BLOCKS; k++) {
        double force, depth;
        char name[60];
        measure_interface(m, k, &force, &depth);
        snprintf(name, sizeof name, "force under block %d [N]", k);
        case_compare(&r, name, force, (BLOCKS + 1 - k) * W);
        snprintf(name, sizeof name, "penetration under block %d [m]", k);
        case_compare(&r, name, depth, (BLOCKS + 1 - k) * W / (2 * p_n));
    }
    case_compare(&r, "largest velocity [m/s]", speed, 0);
    case_compare(&r, "largest drift [m]", drift, 0);
    printf("\nAt most %d solution%s in a step, dt halved %d times\n", effort.passes, effort.passes > 1 ? "s" : "",
           effort.cuts);
    scene_record(&s, m);
    case_draw_panels(&r, "forces.svg", m, &s, 1, (double[]){ 0 });
    printf("\nNumbers and picture: %s/results.csv, forces.svg\n", r.folder);
    scene_free(&s);
    bbm_model_free(m);
    return case_close(&r);
}
