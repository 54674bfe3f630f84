/* slope.c - a slope of 16 columns that topple and slide: how rough it has to be.
 *
 *            .--.--.          Columns dx = 10 m wide, 25 kN/m^3, on steps b = 1 m high, all turned
 *         .--| 9|10|--.       by a = 30 degrees (drawn upright): downhill is to the left. From
 *      .--|  |  |  |11|--.    column to column the top rises by 5 m up to the crest, column 10,
 *   .--|  |  |  |  |__|--'    and then falls by 5.2 m. The tall columns topple and push the low
 *   | 1|  |  |__|--'          ones, which slide.
 *   |__|__|--'
 *
 * Goodman, Bray: Toppling of rock slopes. Rock Engineering for Foundations and Slopes (ASCE,
 * Boulder, Colorado 1976), vol. 2, pp. 201-234.
 *
 * Column n pushes column n-1 with the normal force P_(n-1), at the height L_n above its own foot
 * and M_(n-1) = L_n + b above the neighbour's, at the top of their joint. All joints slip as the
 * columns turn: column n, whose upper side rises, is held back by P_n tan(phi) there. Moments about
 * its lower corner, or the forces along its foot if it slides, tell what it hands on:
 *
 *     topples   P_(n-1) = [ P_n (M_n - dx tan(phi)) + W_n/2 (y_n sin a - dx cos a) ] / L_n
 *     slides    P_(n-1) = P_n - W_n (cos a tan(phi) - sin a) / (1 - tan(phi)^2)
 *     stands    P_(n-1) = 0
 *
 * The largest counts, from P_16 = 0 down. The slope stands if nothing need hold column 1, P_0 <= 0:
 * from 38.13 degrees on (38.15 in print, from rounded numbers). Columns 16 to 14 stand, 13 to 4
 * topple, 3 to 1 slide.
 *
 * Computed: a slope stands if no column has moved by 0.1 m in 20 s. */
#include <math.h>

#include "case.h"

enum { N = 16, CREST = 10, SETTLE = 100, STEPS = 200 };

static const double dx = 10, b = 1, weight = 25e3, DEGREE = 3.14159265358979323846 / 180;

static double height(int n)                 /* of column n = 1 .. N */
{
    return n <= CREST ? 4.0 * n : 4.0 * CREST - 6.2 * (n - CREST);
}

static double top_of_joint(int n)           /* L_n */
{
    return n == 1 ? height(1) : fmin(height(n), height(n - 1) - b);
}

/* ---------------------------------------------------------------------------- limit equilibrium */

/* P_0 .. P_(N-1), and what column 1 would hand on, which may be negative. */
static double push_down(double phi, double P[N + 1])
{
    const double t = tan(phi * DEGREE), s = sin(30 * DEGREE), c = cos(30 * DEGREE);
    double most = 0;

    P[N] = 0;
    for (int n = N; n >= 1; n--) {
        const double y = height(n), W = weight * dx * y, M = n < N ? top_of_joint(n + 1) + b : 0;
        const double topples = (P[n] * (M - dx * t) + W / 2 * (y * s - dx * c)) / top_of_joint(n);
        const double slides = P[n] - W * (c * t - s) / (1 - t * t);
        most = fmax(topples, slides);
        P[n - 1] = fmax(most, 0);
    }
    return most;
}

static double least_friction(void)
{
    double low = 31, high = 44, P[N + 1];

    while (high - low > 1e-9)
        *(push_down((low + high) / 2, P) > 0 ? &low : &high) = (low + high) / 2;
    return high;
}

/* ------------------------------------------------------------------------------ the computation */

static void place(double x, double y, double xy[2])     /* along and across the steps */
{
    xy[0] = cos(30 * DEGREE) * x - sin(30 * DEGREE) * y;
    xy[1] = sin(30 * DEGREE) * x + cos(30 * DEGREE) * y;
}

/* Block 0 are the steps, one polygon; block n is column n. */
static bbm_model *build_slope(double phi)
{
    bbm_model *m = case_model();
    double steps[2 * N + 2][2];

    bbm_add_material(m, &(bbm_material){ 1e14, 0.25, weight / 9.81, 1 }, NULL);
    bbm_add_material(m, &(bbm_material){ 1e12, 0, weight / 9.81, 1 }, NULL);
    place(-2 * dx, -b, steps[0]);
    place(N * dx, -b, steps[1]);
    for (int n = N; n >= 1; n--) {
        place(n * dx, (n - 1) * b, steps[2 * (N - n) + 2]);
        place(n > 1 ? (n - 1) * dx : -2 * dx, (n - 1) * b, steps[2 * (N - n) + 3]);
    }
    case_add_polygon(m, 0, 0, 2 * N + 2, steps);
    case_fix_block(m, 0);
    for (int n = 1; n <= N; n++)
        case_add_box(m, &(case_box){ .block = n, .material = 1, .nx = 1, .ny = 1, .x = (n - 1) * dx,
                                     .y = (n - 1) * b, .w = dx, .h = height(n),
                                     .turn = 30 * DEGREE });
    m->par.dt = 0.1;
    m->par.gravity[1] = -9.81;
    m->par.p_n = 1e12;
    m->par.p_s = 4e11;
    m->par.friction = phi;
    m->par.pcg.tolerance = 1e-12;
    case_must(m, bbm_prepare(m));
    return m;
}

static double moved(const bbm_model *m)
{
    double d = 0;

    for (int n = 1; n <= N; n++)
        d = fmax(d, hypot(m->element[n].sum[0], m->element[n].sum[1]));
    return d;
}

/* Lets a slope go until a column has moved by `far`, and returns how far one has. s, if not NULL,
 * records; *kept, if not NULL, is the caller's to free. */
static double let_go(double phi, double far, scene *s, bbm_model **kept)
{
    bbm_model *m = build_slope(phi);

    case_settle(m, SETTLE);
    m->info.t = 0;
    if (s)
        scene_record(s, m);
    for (int i = 0; i < STEPS && moved(m) < far; i++)
        case_step(m, NULL, s);
    const double d = moved(m);
    if (kept)
        *kept = m;
    else
        bbm_model_free(m);
    return d;
}

static double find_limit(void)
{
    double falls = 37.5, good = 38.7;

    while (good - falls > 2e-3)
        *(let_go((falls + good) / 2, 0.1, NULL, NULL) < 0.1 ? &good : &falls) = (falls + good) / 2;
    return (falls + good) / 2;
}

/* ------------------------------------------------------------------------------------- pictures */

/* The normal forces between columns n and n+1. */
static double push(const bbm_model *m, int n)
{
    double P = 0;

    for (int i = 0; i < m->contacts; i++) {
        const bbm_contact *c = &m->contact[i];
        const int one = m->element[m->edge[c->corner].element].block;
        const int two = m->element[m->edge[c->edge].element].block;
        if (c->state != BBM_OPEN && (one < two ? one : two) == n && one + two == 2 * n + 1)
            P += c->N;
    }
    return P;
}

static void compare_pushes(case_results *r, double phi)
{
    double n[N], theory[N], computed[N], table[N][3], P[N + 1];
    bbm_model *m;

    push_down(phi, P);
    let_go(phi, 0.1, NULL, &m);
    for (int k = 1; k < N; k++) {
        table[k][0] = n[k] = k;
        table[k][1] = computed[k] = push(m, k);
        table[k][2] = theory[k] = P[k];
    }
    case_compare(r, "largest push, of column 7 on column 6 [N]", computed[6], theory[6]);
    case_write_curves(r, "pushes.csv", "n,computed,theory", N - 1, 3, table[1]);
    const plot_series s[] = {
        { .name = "limit equilibrium", .n = N - 1, .x = n + 1, .y = theory + 1, .look = 1 },
        { .name = "BBM", .n = N - 1, .x = n + 1, .y = computed + 1,
          .style = PLOT_MARKS, .look = 2 },
    };
    case_draw_chart(r, "pushes.svg", &(plot_chart){
        .title = "Push of column n + 1 on column n at the limit", .x = { .name = "n" },
        .y = { .name = "P", .unit = "N" }, .count = 2, .series = s });
    bbm_model_free(m);
}

static void draw_fall(case_results *r, double phi)
{
    scene s = { .title = "Columns on a slope, friction one degree below the limit" };
    bbm_model *m;

    let_go(phi, 12, &s, &m);
    const double t = m->info.t;
    case_draw_movie(r, "falls.svg", m, &s);
    case_draw_panels(r, "states.svg", m, &s, 4, (double[]){ 0, 0.5 * t, 0.75 * t, t });
    scene_free(&s);
    bbm_model_free(m);
}

int main(void)
{
    const double limit = least_friction();
    case_results r;

    printf("\n# Slope of %d columns\n\n| | computed | theory | error |\n|---|---|---|---|\n", N);
    case_open(&r, "slope");
    case_compare(&r, "least phi [degree]", find_limit(), limit);
    case_compare(&r, "stands 0.02 degrees above (1 yes, 0 no)",
                 let_go(limit + 0.02, 0.1, NULL, NULL) < 0.1, 1);
    case_compare(&r, "stands 0.02 degrees below", let_go(limit - 0.02, 0.1, NULL, NULL) < 0.1, 0);
    compare_pushes(&r, limit + 0.02);
    draw_fall(&r, limit - 1);
    printf("\nNumbers and pictures: %s/results.csv, pushes.csv, pushes.svg, states.svg, falls.svg "
           "(it moves)\n", r.folder);
    return case_close(&r) || r.worst > 5e-3;  /* of the push: above the limit not all joints slip */
}
