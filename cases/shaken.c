/* shaken.c - a block on an incline that is shaken.
 *
 *            .-.              base acceleration A sin(w t), uphill and horizontal; block 1 m x 0.5 m, 2500 kg/m^3
 *           /   `-.           the block slides when it passes a_y = g tan(phi - a), at t1 = asin(a_y/A)/w; then
 *          `-.    /
 *         .-' `-./              s'' = C (A sin w t - a_y),   C = cos(phi - a)/cos(phi)
 *      .-'                      s   = C [(A/w) cos(w t1) (t - t1) - (A/w^2) (sin w t - sin w t1) - a_y (t - t1)^2/2]
 *   .-'   a
 *  ----------  --> A sin(w t) until s' is zero again; then it sticks until the next passing of a_y. It never slips
 *                             upwards: A < g tan(phi + a).
 *
 * Seen from the base, the shaking is a horizontal gravity -A sin(w t), taken in the middle of each step. Shown is the
 * way after the first slip and after five, over dt, and on other slopes. The block starts in equilibrium. What is left
 * of the error is the giving of the springs, and the step in which a slip begins or ends: of second order in dt. */
#include <math.h>

#include "case.h"

enum { MOST = 6000 };

static const double G = 9.81, PI = 3.14159265358979323846;

typedef struct { double angle, phi, A, w, periods, dt, p_n; } shaking;

static double rad(double degrees) { return degrees * PI / 180; }

static double yield(const shaking *k) { return G * tan(rad(k->phi - k->angle)); }

/* Since it began to slide at t1: the speed and the way. */
static double speed(const shaking *k, double t1, double t)
{
    return cos(rad(k->phi - k->angle)) / cos(rad(k->phi))
           * (k->A / k->w * (cos(k->w * t1) - cos(k->w * t)) - yield(k) * (t - t1));
}

static double way(const shaking *k, double t1, double t)
{
    const double A = k->A, w = k->w;

    return cos(rad(k->phi - k->angle)) / cos(rad(k->phi)) * (A / w * cos(w * t1) * (t - t1)
           - A / (w * w) * (sin(w * t) - sin(w * t1)) - yield(k) * (t - t1) * (t - t1) / 2);
}

/* When the first slip begins, and when it ends: the speed grows until w t = pi - w t1 and vanishes before the next
 * passing of a_y, if A is not much larger than a_y (a bisection). */
static double slip_begins(const shaking *k) { return asin(yield(k) / k->A) / k->w; }

static double slip_ends(const shaking *k)
{
    const double t1 = slip_begins(k);
    double low = PI / k->w - t1, high = 2 * PI / k->w + t1;

    for (int i = 0; i < 100; i++) {
        const double t = (low + high) / 2;
        if (speed(k, t1, t) > 0)
            low = t;
        else
            high = t;
    }
    return low;
}

/* The way after any time: each period adds one slip, if the slip ends within the period in which it began. */
static double theory(const shaking *k, double t)
{
    const double T = 2 * PI / k->w, t1 = slip_begins(k), t2 = slip_ends(k), whole = way(k, t1, t2);
    double s = 0;

    for (double begin = t1; begin < t; begin += T)
        s += t - begin < t2 - t1 ? way(k, t1, t - begin + t1) : whole;
    return s;
}

/* The way down the base after each step; returns their number. */
static int run(const shaking *k, double t[MOST], double s[MOST], case_results *movie)
{
    bbm_model *m = case_block_on_slope(&(case_slope){ k->angle, 1, 0.5, k->phi, k->p_n, k->dt, 5 });
    scene film = { .title = "A block on a shaken incline, seen from the incline", .window = { -1.4, 1.4, -0.6, 1 } };
    const int steps = (int)(k->periods * 2 * PI / k->w / k->dt + 0.5);

    case_must(m, bbm_prepare(m));
    case_settle(m, 50);
    m->info.t = 0;
    const double start = case_slid(m, k->angle);
    if (movie)
        scene_record(&film, m);
    for (int i = 0; i < steps && i < MOST; i++) {
        m->par.gravity[0] = -k->A * sin(k->w * (m->info.t + k->dt / 2));
        case_step(m, NULL, movie ? &film : NULL);
        t[i] = m->info.t;
        s[i] = case_slid(m, k->angle) - start;
    }
    if (movie)
        case_draw_movie(movie, "shaken.svg", m, &film);
    scene_free(&film);
    bbm_model_free(m);
    return steps;
}

static void print_table(case_results *r)
{
    static const shaking k[] = {
        { 10, 20, 4, 6, 5, 0.02, 1e9 }, { 10, 20, 4, 6, 5, 0.01, 1e9 }, { 10, 20, 4, 6, 5, 0.005, 1e9 },
        { 10, 20, 4, 6, 5, 0.01, 1e11 }, { 10, 20, 4, 6, 5, 0.002, 1e11 }, { 10, 20, 4, 6, 5, 0.001, 1e11 },
        { 5, 20, 4, 10, 5, 0.002, 1e11 }, { 20, 30, 3, 8, 5, 0.002, 1e11 }, { 25, 30, 2, 12, 5, 0.002, 1e11 },
    };
    double t[MOST], s[MOST];

    printf("\n| a | phi | A [m/s^2] | w [1/s] | dt [s] | p_n [N/m] | one slip [m]: computed | theory | error "
           "| five slips: computed | theory | error |\n|---|---|---|---|---|---|---|---|---|---|---|---|\n");
    for (size_t i = 0; i < sizeof k / sizeof *k; i++) {
        const int n = run(&k[i], t, s, NULL);
        printf("| %g | %g | %g | %g | %g | %.0e |", k[i].angle, k[i].phi, k[i].A, k[i].w, k[i].dt, k[i].p_n);
        for (int slips = 1; slips <= 5; slips += 4) {
            const int at = n * slips / 5 - 1;
            const double exact = theory(&k[i], t[at]), nowhere[2] = { NAN, NAN };
            char name[80];
            snprintf(name, sizeof name, "slip%d.a%g.phi%g.dt%g.p_n%.0e", slips, k[i].angle, k[i].phi, k[i].dt,
                     k[i].p_n);
            printf(" %.8f | %.8f | %+.1e |", s[at], exact, case_row(r, name, nowhere, s[at], exact, "theory"));
        }
        printf("\n");
    }
    printf("\nA slip begins and ends within a step: the error is of second order in dt, and depends on where in its "
           "step that happens.\nLargest error: %.1e.\n", r->worst);
}

/* The slip over time, and under it what shakes the base. */
static void draw(case_results *r, const shaking *k)
{
    enum { ROOM = 600 };
    double t[MOST], s[MOST], at[ROOM], some[ROOM], exact[ROOM], base[ROOM], a_y[ROOM], table[ROOM][4];
    const int n = run(k, t, s, r);
    int marks = 0;
    plot p;

    for (int i = 0; i < n && i < ROOM; i++) {
        table[i][0] = t[i], table[i][1] = s[i];
        table[i][2] = exact[i] = theory(k, t[i]);
        table[i][3] = base[i] = k->A * sin(k->w * t[i]);
        a_y[i] = yield(k);
        if (i % 10 == 9)
            at[marks] = t[i], some[marks++] = s[i];
    }
    const plot_series slip[] = { { .name = "theory", .n = n, .x = t, .y = exact, .look = 1 },
                                 { .name = "BBM", .n = marks, .x = at, .y = some, .style = PLOT_MARKS, .look = 2 } };
    const plot_series shake[] = { { .name = "A sin(w t)", .n = n, .x = t, .y = base, .look = 3 },
                                  { .name = "a_y = g tan(phi - a)", .n = n, .x = t, .y = a_y, .look = 1,
                                    .style = PLOT_DASHED } };
    case_open_page(r, "slip.svg", &p, 860, 760);
    plot_draw_chart(&p, (plot_box){ 0, 0, 860, 460 }, &(plot_chart){
        .title = "Slip on a shaken incline: a = 10, phi = 20 degrees, dt = 0.01 s", .count = 2, .series = slip,
        .x = { "t", "s", 0, 0, 5 }, .y = { "s", "m", 0, 0, 0 } });
    plot_draw_chart(&p, (plot_box){ 0, 460, 860, 300 }, &(plot_chart){
        .title = "Acceleration of the base", .count = 2, .series = shake,
        .x = { "t", "s", 0, 0, 5 }, .y = { "acceleration", "m/s²", 0, 0, 0 } });
    case_close_page(r, &p);
    case_write_curves(r, "slip.csv", "t,s,theory,base_acceleration", n, 4, &table[0][0]);
}

int main(void)
{
    case_results r;

    printf("\n# A block on a shaken incline\n");
    case_open(&r, "shaken");
    print_table(&r);
    draw(&r, &(shaking){ 10, 20, 4, 6, 5, 0.01, 1e9 });
    printf("\nNumbers and pictures: %s/results.csv, slip.csv, slip.svg, shaken.svg (it moves)\n", r.folder);
    return case_close(&r);
}
