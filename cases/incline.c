/* incline.c - a block on an incline slides with friction, or sticks.
 *
 *              .-.            block 1 m x 0.5 m, 2500 kg/m^3, W = 12,262.5 N; incline of a = 30 degrees, rigid, fixed
 *             /   `-.
 *            `-.    /'        phi < a   it slides   s = v0 t + g (sin a - cos a tan phi) t^2/2
 *           .-' `-./          phi > a   it sticks, but for what the two shear springs give way: W sin a/(2 p_s)
 *        .-'                            with p_s = 0.4 p_n
 *     .-'
 *  .-'   a = 30 degrees       thrown   downwards it stops after v0^2 / (2 g (cos a tan phi - sin a)) if phi > a,
 *  ---------------------               upwards after v0^2 / (2 g (cos a tan phi + sin a))
 *
 * Shown are the errors at t = 1 s after a start from rest, gravity switched on suddenly, on an incline of one piece and
 * on one of 13: corners then pass from edge to edge. A second table goes on to where the errors grow: soft springs and
 * small steps. By W = dt sqrt(2 p_n/m) the block swings on its springs in a step; a step damps the swing by
 * (1 + W^2/2)^(-1/2), so that where W is small it lasts: the springs wind up for many steps before the block slides, and
 * in very soft ones it hops. A third table starts in equilibrium. */
#include <math.h>

#include "case.h"

enum { ANGLES = 7, STEPS = 100 };

static const double PHI[ANGLES] = { 0, 10, 20, 25, 29, 31, 40 };
static const double A = 30, G = 9.81, WEIGHT = 2500 * 0.5 * 9.81, RAD = 3.14159265358979323846 / 180;

typedef struct { double angle, phi, dt, p_n, v0, time; int base, settle; } slide;   /* v0 down the incline          */

/* The acceleration down an incline; friction acts against a motion that goes down (1) or up (-1). */
static double pull(double angle, double phi, int down)
{
    return G * (sin(angle * RAD) - down * cos(angle * RAD) * tan(phi * RAD));
}

/* The distance from rest after a time. */
static double theory(double phi, double t) { return phi < A ? pull(A, phi, 1) * t * t / 2 : 0; }

/* By how much the block swings on its normal springs in a step. */
static double swing(double dt, double p_n) { return dt * sqrt(2 * p_n / (WEIGHT / G)); }

/* Quasi-static steps until a swing has shrunk by 1e-12; each shrinks it by 1 + W^2/2. */
static int settling(double dt, double p_n) { return (int)(28 / log1p(swing(dt, p_n) * swing(dt, p_n) / 2)) + 2; }

static bbm_model *start(const slide *s)
{
    bbm_model *m = case_block_on_slope(&(case_slope){ s->angle, 1, 0.5, s->phi, s->p_n, s->dt, s->base });
    bbm_element *block = &m->element[m->elements - 1];

    case_must(m, bbm_prepare(m));
    case_settle(m, s->settle);
    m->info.t = 0;
    block->V[0] = -s->v0 * cos(s->angle * RAD);
    block->V[1] = -s->v0 * sin(s->angle * RAD);
    return m;
}

/* The distance slid; way[i], if given, after i steps. */
static double run(const slide *s, double *way, case_effort *effort)
{
    bbm_model *m = start(s);
    const int steps = (int)(s->time / s->dt + 0.5);
    const double from = case_slid(m, s->angle);

    for (int i = 0; i <= steps; i++) {
        if (i > 0)
            case_step(m, effort, NULL);
        if (way)
            way[i] = case_slid(m, s->angle) - from;
    }
    const double slid = case_slid(m, s->angle) - from;
    bbm_model_free(m);
    return slid;
}

/* ------------------------------------------------------------------------------------------------- tables */

static void print_required(case_results *r)
{
    static const struct { double dt, p_n; } c[4] = { { 0.01, 1e9 }, { 0.01, 1e10 }, { 0.01, 1e11 }, { 0.002, 1e11 } };

    printf("\nError at t = 1 s: of the distance, relative; where it sticks (31, 40), the way beyond W sin a/(2 p_s) [m]"
           "\n\n| pieces | dt [s] | p_n [N/m] | phi = 0 | 10 | 20 | 25 | 29 | 31 | 40 | passes | cuts |\n"
           "|---|---|---|---|---|---|---|---|---|---|---|---|\n");
    for (int base = 1; base <= 13; base += 12)
        for (int k = 0; k < 4; k++) {
            case_effort effort = { 0, 0 };
            printf("| %d | %g | %.0e |", base, c[k].dt, c[k].p_n);
            for (int i = 0; i < ANGLES; i++) {
                const double way = run(&(slide){ A, PHI[i], c[k].dt, c[k].p_n, 0, 1, base, 0 }, NULL, &effort);
                const double gives = WEIGHT * sin(A * RAD) / (2 * 0.4 * c[k].p_n), nowhere[2] = { NAN, NAN };
                char name[64];
                snprintf(name, sizeof name, "%s.base%d.dt%g.p_n%.0e.phi%g", PHI[i] < A ? "slide" : "stick", base,
                         c[k].dt, c[k].p_n, PHI[i]);
                const double error = PHI[i] < A ? case_row(r, name, nowhere, way, theory(PHI[i], 1), "theory")
                                   : case_row(r, name, nowhere, way - gives, 0, "theory");
                printf(" %.1e |", error);
            }
            printf(" %d | %d |\n", effort.passes, effort.cuts);
        }
}

/* The error at 1 s for phi = 25 over dt and p_n; how far the block swings in a step is W = dt sqrt(2 p_n/m). */
static void print_sweep(case_results *r, int settle)
{
    static const double dt[] = { 0.02, 0.01, 0.005, 0.002, 0.001, 0.0005 };
    enum { ROWS = sizeof dt / sizeof *dt, COLUMNS = 6 };
    double table[ROWS][1 + COLUMNS], from[COLUMNS][ROWS];
    plot_series s[COLUMNS];
    static const char *const name[COLUMNS] = { "p_n = 1e7 N/m", "1e8", "1e9", "1e10", "1e11", "1e12" };

    printf("\nRelative error at t = 1 s, phi = 25, %s; in brackets W = dt sqrt(2 p_n/m)\n\n"
           "| dt [s] | p_n = 1e7 N/m | 1e8 | 1e9 | 1e10 | 1e11 | 1e12 |\n|---|---|---|---|---|---|---|\n",
           settle ? "start in equilibrium" : "gravity switched on suddenly");
    for (int i = 0; i < ROWS; i++) {
        printf("| %g |", table[i][0] = dt[i]);
        for (int k = 0; k < COLUMNS; k++) {
            const double p_n = pow(10, 7 + k);
            const double way = run(&(slide){ A, 25, dt[i], p_n, 0, 1, 13, settle ? settling(dt[i], p_n) : 0 },
                                   NULL, NULL), error = way / theory(25, 1) - 1;
            table[i][1 + k] = error;
            from[k][i] = fabs(error);
            printf(" %.1e (%.2g) |", error, swing(dt[i], p_n));
        }
        printf("\n");
    }
    for (int k = 0; k < COLUMNS; k++)
        s[k] = (plot_series){ .name = name[k], .n = ROWS, .x = dt, .y = from[k], .style = PLOT_BOTH };
    printf("\n%s\n", settle
           ? "Nothing swings: the error is that of rounding and of the tolerance of the linear solver."
           : "To the right the error is what the shear springs, and at last the block itself, give way once.\n"
             "To the left and below, where W is under about 5, the suddenly loaded block first winds up its springs: it\n"
             "is locked at less than full friction for several steps, and then runs ahead with what it did not lose.\n"
             "In the softest springs it hops, too.");
    case_write_curves(r, settle ? "settled.csv" : "sudden.csv", "dt,p_n=1e7,1e8,1e9,1e10,1e11,1e12", ROWS, 1 + COLUMNS,
                      &table[0][0]);
    if (!settle)
        case_draw_chart(r, "sudden.svg", &(plot_chart){ .title = "Distance slid in 1 s: error if gravity sets in suddenly",
                        .x = { "dt", "s", 1, 0, 0 }, .y = { "relative error", "", 1, 0, 0 }, .count = COLUMNS,
                        .series = s });
}

/* A stop is known to a step: the block comes to rest, and locks, within its last one, decelerated by `down` or `up`. */
static void print_thrown(case_results *r)
{
    const double fast = 3, down = -pull(30, 40, 1), up = pull(20, 30, -1);
    char name[120];

    printf("\n| thrown [m] | computed | theory | error |\n|---|---|---|---|\n");
    for (double dt = 0.01; dt > 0.001; dt /= 5) {
        snprintf(name, sizeof name, "stops after 3 m/s down 30 degrees at phi = 40; dt = %g", dt);
        case_compare(r, name, run(&(slide){ 30, 40, dt, 1e10, fast, 4, 13, 20 }, NULL, NULL), fast * fast / (2 * down));
        snprintf(name, sizeof name, "stops after 3 m/s up 20 degrees at phi = 30; dt = %g", dt);
        case_compare(r, name, -run(&(slide){ 20, 30, dt, 1e10, -fast, 2, 13, 20 }, NULL, NULL), fast * fast / (2 * up));
        snprintf(name, sizeof name, "1 s after 1 m/s down 30 degrees at phi = 10; dt = %g", dt);
        case_compare(r, name, run(&(slide){ 30, 10, dt, 1e10, 1, 1, 13, 20 }, NULL, NULL), 1 + pull(30, 10, 1) / 2);
    }
    printf("\nA block stops within a step; the way is then uncertain by as much as the deceleration times dt^2/2: "
           "%.1e m for dt = 0.01 s uphill.\n", up * 0.01 * 0.01 / 2);
}

/* ------------------------------------------------------------------------------------------------ pictures */

/* The theory of all friction angles is one series, with gaps. */
static void draw_ways(case_results *r)
{
    enum { N = STEPS + 1, MARKS = 11 };
    static const char *const name[ANGLES] = { "phi = 0", "phi = 10", "phi = 20", "phi = 25", "phi = 29", "phi = 31",
                                              "phi = 40" };
    double t[ANGLES][N + 1], exact[ANGLES][N + 1], way[ANGLES][N], some[ANGLES][MARKS], at[MARKS];
    double table[N][1 + 2 * ANGLES];
    plot_series s[1 + ANGLES];

    for (int k = 0; k < ANGLES; k++) {
        run(&(slide){ A, PHI[k], 0.01, 1e9, 0, 1, 13, 0 }, way[k], NULL);
        for (int i = 0; i < N; i++) {
            t[k][i] = table[i][0] = 0.01 * i;
            table[i][1 + 2 * k] = way[k][i];
            table[i][2 + 2 * k] = exact[k][i] = theory(PHI[k], t[k][i]);
        }
        t[k][N] = exact[k][N] = NAN;
        for (int i = 0; i < MARKS; i++) {
            at[i] = t[k][i * STEPS / (MARKS - 1)];
            some[k][i] = way[k][i * STEPS / (MARKS - 1)];
        }
        s[1 + k] = (plot_series){ .name = name[k], .n = MARKS, .x = at, .y = some[k], .style = PLOT_MARKS,
                                  .look = k + 2 };
    }
    s[0] = (plot_series){ .name = "theory", .n = ANGLES * (N + 1), .x = t[0], .y = exact[0], .look = 1 };
    case_draw_chart(r, "distance.svg", &(plot_chart){ .title = "Distance slid on an incline of 30 degrees", .count = 1 + ANGLES,
                    .series = s, .x = { "t", "s", 0, 0, 0 }, .y = { "s", "m", 0, 0, 0 } });
    case_write_curves(r, "distance.csv", "t,phi=0,theory,phi=10,theory,phi=20,theory,phi=25,theory,phi=29,theory,"
                      "phi=31,theory,phi=40,theory", N, 1 + 2 * ANGLES, &table[0][0]);
}

static void draw_film(case_results *r)
{
    scene film = { .title = "A block on an incline of 30 degrees, friction 20 degrees", .window = { -2.5, 1.5, -1.5, 1.4 } };
    bbm_model *m = start(&(slide){ A, 20, 0.01, 1e9, 0, 1, 13, 20 });

    scene_record(&film, m);
    for (int i = 0; i < 120; i++)
        case_step(m, NULL, &film);
    case_draw_movie(r, "slide.svg", m, &film);
    case_draw_panels(r, "states.svg", m, &film, 2, (double[]){ 0.6, 1.2 });
    scene_free(&film);
    bbm_model_free(m);
}

int main(void)
{
    case_results r;

    printf("\n# A block on an incline\n");
    case_open(&r, "incline");
    print_required(&r);
    print_sweep(&r, 0);
    print_sweep(&r, 1);
    print_thrown(&r);
    draw_ways(&r);
    draw_film(&r);
    printf("\nNumbers and pictures: %s/results.csv, distance.csv, distance.svg, sudden.csv, sudden.svg, settled.csv, "
           "states.svg, slide.svg (it moves)\n", r.folder);
    return case_close(&r);
}
