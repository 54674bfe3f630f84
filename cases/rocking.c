/* rocking.c - a block that rocks from corner to corner.
 *
 *        .-.              R half the diagonal, a its slope, tan(a) = width/height; let go at rest,
 *       /   `-. height    turned by th0 < a about a lower corner, it swings back to upright:
 *      /      /
 *     /      /                  th'' = -p^2 sin(a - th),        p^2 = 3 g/(4 R)
 *    `-.    /
 *  _____`-./_____         With sin((a - th)/2) = s cosh(u), s = sin((a - th0)/2), the time to the
 *        th0              first impact is
 *
 *        t1 = (1/p) integral du / sqrt(1 - s^2 cosh^2 u),       from 0 to acosh(sin(a/2)/s).
 *
 * For slender blocks the root is 1, a - th takes the place of its sine, and the period is Housner's
 *
 *        T = 4 t1 = (4/p) acosh(1/(1 - th0/a))
 *
 * (Housner: The behavior of inverted pendulum structures during earthquakes. Bulletin of the
 * Seismological Society of America 53 (1963), pp. 403-417.) If the block does not bounce and hits
 * with the other corner alone, angular momentum about that one is kept: the block goes on with
 * th' (1 - 3/2 sin^2 a), and rises to th1,
 *
 *        cos(a - th1) - cos(a) = (1 - 3/2 sin^2 a)^2 (cos(a - th0) - cos(a)).
 *
 * Computed with dt = 1 ms: t1 is late by less than a step; Housner's T is a fourth of a per cent
 * short for a block five times as high as wide. The impact takes its share only nearly: the springs
 * of both corners are loaded for a few steps, and give back what the time step leaves them. */
#include <math.h>

#include "case.h"

enum { INTERVALS = 200, MOST = 12000, PEAKS = 8 };

static const double g = 9.81, width = 1, dt = 0.001;

typedef struct { double height, share; } rocker;        /* share: th0/a */

static double slope(const rocker *k) { return atan(width / k->height); }

static double frequency(const rocker *k) { return sqrt(3 * g / (2 * hypot(width, k->height))); }

static double housner(const rocker *k) { return acosh(1 / (1 - k->share)) / frequency(k); }

/* t1 by Simpson's rule. */
static double first_impact(const rocker *k)
{
    const double s = sin(slope(k) * (1 - k->share) / 2);
    const double du = acosh(sin(slope(k) / 2) / s) / INTERVALS;
    double sum = 0;

    for (int i = 0; i <= INTERVALS; i++) {
        const double c = s * cosh(i * du);
        sum += (i == 0 || i == INTERVALS ? 1 : i % 2 ? 4 : 2) / sqrt(1 - c * c);
    }
    return sum * du / 3 / frequency(k);
}

/* th1/a */
static double second_share(const rocker *k)
{
    const double a = slope(k), e = 1 - 1.5 * sin(a) * sin(a);

    return 1 - acos(cos(a) + e * e * (cos(a * (1 - k->share)) - cos(a))) / a;
}

static bbm_model *build_block(const rocker *k)
{
    bbm_model *m = case_model();

    bbm_add_material(m, &(bbm_material){ 1e14, 0.25, 2500, 1 }, NULL);
    bbm_add_material(m, &(bbm_material){ 1e12, 0, 2500, 1 }, NULL);
    case_add_box(m, &(case_box){ .nx = 1, .ny = 1, .x = -2, .y = -0.5, .w = 5, .h = 0.5 });
    case_fix_block(m, 0);
    case_add_box(m, &(case_box){ .block = 1, .material = 1, .nx = 1, .ny = 1, .w = width,
                                 .h = k->height, .turn = k->share * slope(k) });
    m->par.dt = dt;
    m->par.velocity_factor = 1;
    m->par.gravity[1] = -g;
    m->par.p_n = 1e11;
    m->par.p_s = 4e10;
    m->par.friction = 60;
    m->par.pcg.tolerance = 1e-12;
    case_must(m, bbm_prepare(m));
    return m;
}

/* th/a after each step, until it has had so many peaks, or MOST steps; returns their number. */
static int rock(const rocker *k, int peaks, double share[MOST], case_results *movie)
{
    bbm_model *m = build_block(k);
    scene film = { .title = "A tall block rocks" };
    int n = 0;

    if (movie)
        scene_record(&film, m);
    for (; n < MOST && peaks > 0; n++) {
        case_step(m, NULL, movie && n % 50 == 49 ? &film : NULL);
        share[n] = k->share + m->element[1].sum[2] / slope(k);
        peaks -= n > 1 && fabs(share[n]) < fabs(share[n - 1])
                 && fabs(share[n - 2]) <= fabs(share[n - 1]);
    }
    if (movie) {
        case_draw_movie(movie, "rocks.svg", m, &film);
        case_draw_panels(movie, "states.svg", m, &film, 4, (double[]){ 0, 1.1, 1.9, 2.7 });
    }
    scene_free(&film);
    bbm_model_free(m);
    return n;
}

/* When th is zero for the first time, between two steps. */
static double crossing(const double share[MOST])
{
    int n = 0;

    while (n + 1 < MOST && share[n] > 0)
        n++;
    return dt * (n + share[n - 1] / (share[n - 1] - share[n]));
}

static void print_table(case_results *r)
{
    static const double height[] = { 2, 5, 10 }, at[] = { 0.2, 0.5, 0.8, 0.95 };
    double share[MOST];
    char name[60];

    printf("| first impact [s] | computed | theory | error |\n|---|---|---|---|\n");
    for (int i = 0; i < 12; i++) {
        const rocker k = { height[i / 4], at[i % 4] };
        rock(&k, 1, share, NULL);
        snprintf(name, sizeof name, "height %g m, th0 = %g a", k.height, k.share);
        case_compare(r, name, crossing(share), first_impact(&k));
        snprintf(name, sizeof name, "height %g m, th0 = %g a, Housner", k.height, k.share);
        if (k.height > 4 * width)
            case_compare(r, name, crossing(share), housner(&k));
    }
}

/* The rocking over time, and the peaks of the theory, th_n after t1(th_0) + 2 t1(th_1) + .. */
static void draw(case_results *r)
{
    rocker k = { 5, 0.8 };
    double share[MOST], t[MOST], peak[PEAKS + 1] = { k.share }, when[PEAKS + 1] = { 0 };
    const int n = rock(&k, PEAKS, share, r);

    for (int i = 0; i < n; i++)
        t[i] = (i + 1) * dt;
    for (int i = 1; i <= PEAKS; i++) {
        when[i] = when[i - 1] + first_impact(&k);
        k.share = second_share(&k);
        when[i] += first_impact(&k);
        peak[i] = i % 2 ? -k.share : k.share;
    }
    const plot_series s[] = {
        { .name = "BBM", .n = n, .x = t, .y = share, .look = 1 },
        { .name = "peaks of the theory", .n = PEAKS + 1, .x = when, .y = peak,
          .style = PLOT_MARKS, .look = 2 },
    };
    case_draw_chart(r, "rocking.svg", &(plot_chart){
        .title = "A block of 1 m x 5 m rocks", .x = { .name = "t", .unit = "s" },
        .y = { .name = "th/a" }, .count = 2, .series = s });
}

int main(void)
{
    case_results r;

    printf("\n# A rocking block\n\n");
    case_open(&r, "rocking");
    print_table(&r);
    draw(&r);
    printf("\nNumbers and pictures: %s/results.csv, rocking.svg, states.svg, rocks.svg (it "
           "moves)\n", r.folder);
    return case_close(&r) || r.worst > 4e-3;
}
