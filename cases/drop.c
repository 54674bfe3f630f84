/* drop.c - a block that is dropped: the rebound is never faster than the impact.
 *
 *      .---.                       1 m x 1 m, 2500 kg/m^3, from 0.1 m flat, and turned by 10 degrees on its corner
 *      |   |   |
 *      '---'   v g                 p_n = 1e9 N/m. On two springs of p_n the flat block is an oscillator of frequency
 *   ____________                       w = sqrt(2 p_n / m),   W = w dt.
 *   ////////////                   beta = 1/2, gamma = 1 gives it, with x1 = x + dt v + dt^2/2 a1, v1 = v + dt a1,
 *
 *   a1 = -w^2 x1:    (x1, dt v1) = 1/(1+q) [    1      1  ] (x, dt v),      q = W^2/2,
 *                                          [ -2 q    1-q ]
 * a matrix of eigenvalues (1+q)^(-1/2) exp(+-i th), cos th = (2-q)/(2 sqrt(1+q)), while W < 4: it damps. Contact lasts
 * half a period, pi/th steps, so that the block leaves with the share
 *
 *     rebound/impact = (1+q)^(-pi/(2 th))   ->   exp(-pi W/4) for small W
 *
 * of its velocity. Where a step is no small part of the contact (W > 1/2) it also matters when in the step the block
 * arrives, and the formula is a guide only; from W = 4 on there is none. Below 1 the share must stay for every dt: a
 * tolerance that closes contacts before they touch would hand out energy. */
#include <math.h>

#include "case.h"
#include "theory.h"

enum { STEPS = 9 };

static const double p_n = 1e9, mass = 2500;
static const double dt[STEPS] = { 1e-2, 5e-3, 2e-3, 1e-3, 5e-4, 2e-4, 1e-4, 5e-5, 2e-5 };

static bbm_model *build_drop(double step, int tilted)
{
    const double c = tilted ? 0.3 : 0.1;
    bbm_model *m = case_moving_model(&(case_blocks){ 1e11, 0.25, step, p_n, 30, 1e-12 });

    case_add_box(m, &(case_box){ .nx = 1, .ny = 1, .x = -1.5, .y = -0.5, .w = 3, .h = 0.5 });
    case_fix_block(m, 0);
    case_add_box(m, &(case_box){ .block = 1, .material = 1, .nx = 1, .ny = 1, .x = -0.5, .y = c, .w = 1, .h = 1,
                                 .turn = tilted ? acos(-1) / 18 : 0 });
    case_must(m, bbm_prepare(m));
    return m;
}

/* Fastest rise after the first touch over fastest fall before it; *start and *most: energy at the start and at most. */
static double drop(double step, int tilted, double *impact, double *start, double *most)
{
    bbm_model *m = build_drop(step, tilted);
    const bbm_element *e = &m->element[1];
    const double y0 = (bbm_element_geometry(&m->element[1], &m->vertex[e->first]), e->y);
    double rebound = 0;
    int touched = 0;

    *impact = 0;
    *most = *start = mass * 9.81 * y0;
    while (m->info.t < 0.4) {
        case_step(m, NULL);
        touched = touched || m->info.contacts > 0;
        if (touched)
            rebound = fmax(rebound, e->V[1]);
        else
            *impact = fmax(*impact, -e->V[1]);
        *most = fmax(*most, mass * ((e->V[0] * e->V[0] + e->V[1] * e->V[1]) / 2 + (e->Sxx + e->Syy) / e->A * e->V[2]
                                    * e->V[2] / 2 + 9.81 * (y0 + e->sum[1])));
    }
    bbm_model_free(m);
    return rebound / *impact;
}

static double theory(double step)
{
    const double W = step * sqrt(2 * p_n / mass);

    return theory_rebound(W * W / 2);
}

static void draw(case_results *r, const double ratio[2][STEPS])
{
    enum { N = 81 };
    double x[N], y[N], flat[N], one[N];

    for (int i = 0; i < N; i++) {
        x[i] = 1e-5 * pow(1000, i / (N - 1.0));
        flat[i] = theory(x[i]);
        y[i] = exp(-acos(-1) / 4 * x[i] * sqrt(2 * p_n / mass));
        one[i] = 1;
    }
    const plot_series s[] = {
        { .name = "never above 1", .n = N, .x = x, .y = one, .look = 5 },
        { .name = "(1+q)^(-pi/(2 th))", .n = N, .x = x, .y = flat, .look = 1 },
        { .name = "exp(-pi W/4)", .n = N, .x = x, .y = y, .look = 3 },
        { .name = "BBM, flat", .n = STEPS, .x = dt, .y = ratio[0], .style = PLOT_MARKS, .look = 2 },
        { .name = "BBM, turned by 10 degrees", .n = STEPS, .x = dt, .y = ratio[1], .style = PLOT_MARKS, .look = 4 },
    };
    case_draw(r, plot_write_chart(case_path(r, "rebound.svg"), &(plot_chart){
        .title = "Drop test: rebound over impact velocity", .x = { "time step dt", "s", 1, 0, 0 },
        .y = { "rebound / impact", "", 0, 0, 1.05 }, .count = LENGTH(s), .series = s }));
}

static void draw_movie(case_results *r)
{
    bbm_model *m = build_drop(1e-3, 1);
    scene s = { .title = "A block is dropped on its corner" };

    scene_record(&s, m);
    while (m->info.t < 1.2)
        case_step(m, &s);
    case_draw(r, scene_write_movie(&s, m, case_path(r, "movie.svg")));
    case_draw(r, scene_write_panels(&s, m, case_path(r, "states.svg"), 4,
                                    (double[]){ 0, 0.21, 0.5, 1.2 }));
    scene_free(&s);
    bbm_model_free(m);
}

int main(void)
{
    case_results r;
    double ratio[2][STEPS], impact, start, most, gain = 0;

    printf("\n# Drop test\n\n"
           "| dt [s] | W | impact [m/s] | rebound/impact, flat | theory | error | turned by 10 degrees |\n"
           "|---|---|---|---|---|---|---|\n");
    case_open(&r, "drop");
    for (int i = 0; i < STEPS; i++) {
        char name[40];
        ratio[1][i] = drop(dt[i], 1, &impact, &start, &most);
        gain = fmax(gain, most / start - 1);
        ratio[0][i] = drop(dt[i], 0, &impact, &start, &most);
        gain = fmax(gain, most / start - 1);
        snprintf(name, sizeof name, "rebound/impact at dt = %g s", dt[i]);
        printf("| %g | %.3g | %.4f | %.4f | ", dt[i], dt[i] * sqrt(2 * p_n / mass), impact, ratio[0][i]);
        if (isnan(theory(dt[i])))
            printf("below 1 | | ");
        else
            printf("%.4f | %+.1e | ", theory(dt[i]),
                   case_row(&r, name, (double[]){ NAN, NAN }, ratio[0][i], theory(dt[i]), "theory"));
        printf("%.4f |\n", ratio[1][i]);
    }
    printf("\nEnergy in these %d runs: at most %.1e of that at the start more than it\n", 2 * STEPS, gain);
    draw(&r, (const double (*)[STEPS])ratio);
    draw_movie(&r);
    printf("\nNumbers and pictures: %s/results.csv, rebound.svg, states.svg, movie.svg\n", r.folder);
    return case_close(&r);
}
