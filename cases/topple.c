/* topple.c - a block on an incline stands, slides, topples, or does both: the chart of a and phi.
 *
 *          .-.                   width b along the incline, height h, k = b/h; it starts from rest
 *         /   `-. h              delta = atan(k)       the weight leaves the foot of the block at a = delta
 *        /      /                tan phi_c = [(1 + 4 k^2) tan a + 3 k] / [(4 + k^2) + 3 k tan a]
 *        `-.   /
 *      b .-'`-/                  a <= delta   phi > a: stands           phi < a: slides
 *     .-'                        a >  delta   phi < delta: slides       delta < phi < phi_c: slides and topples
 *  .-'  a                                     phi > phi_c: topples
 *  ------------
 * Above phi_c the block turns about its lower corner, with J = m (b^2 + h^2)/3. The turning accelerates the centre,
 * and that takes a normal and a shear force in the corner: phi_c is the friction angle that can just carry them.
 *
 * The borders are those of the first instant: a block that has turned stands differently, one that topples may begin
 * to slide. Therefore each run is judged after 0.05 s, when none has turned by more than a degree: it slides if its
 * lower corner has left its place by more than 0.1 mm, it topples if it has turned by more than 1e-4 rad. What must
 * move, 2 degrees from a border, moves three times as far, what must not a thirtieth; both are printed. (After 0.1 s a
 * slender block on 80 degrees that should topple only has turned so far that it slides.)
 *
 * Points lie 2 degrees off each border in phi, and on a grid where that is not within 2 degrees of a border. */
#include <math.h>
#include <string.h>

#include "case.h"

enum { STANDS, SLIDES, TOPPLES, BOTH, REGIMES };        /* SLIDES | TOPPLES == BOTH */
enum { SHAPES = 4, MOST = 600, CURVE = 61 };

static const double PI = 3.14159265358979323846, FROM = 4, TO = 80;
static const char *const REGIME[REGIMES] = { "stands", "slides", "topples", "slides and topples" };

typedef struct { double k, a, phi, slid, turned; int theory, found; } trial;   /* angles in degrees                   */

typedef struct { double k; const char *name; int n; trial at[MOST]; } chart;

static double tangent(double degrees) { return tan(degrees * PI / 180); }
static double angle(double tangent_of) { return atan(tangent_of) * 180 / PI; }

static double critical(double k, double a)
{
    return angle(((1 + 4 * k * k) * tangent(a) + 3 * k) / ((4 + k * k) + 3 * k * tangent(a)));
}

static int theory(double k, double a, double phi)
{
    const double delta = angle(k);

    if (a <= delta)
        return phi > a ? STANDS : SLIDES;
    return phi < delta ? SLIDES : phi < critical(k, a) ? BOTH : TOPPLES;
}

static void run(trial *t)
{
    const double rad = t->a * PI / 180;
    bbm_model *m = case_moving_model(&(case_blocks){ 1e10, 0.25, 0.0025, 1e11, t->phi, 1e-14 });

    case_add_box(m, &(case_box){ .nx = 1, .ny = 1, .x = -12, .y = -1, .w = 18, .h = 1,
                                 .turn = rad });
    case_fix_block(m, 0);
    case_add_box(m, &(case_box){ .block = 1, .material = 1, .nx = 1, .ny = 1, .w = t->k, .h = 1,
                                 .turn = rad });
    case_must(m, bbm_prepare(m));
    t->turned = 0;
    for (int i = 0; i < 20; i++) {
        case_step(m, NULL);
        t->turned += m->element[m->elements - 1].D[2];
    }
    const bbm_vertex *corner = &m->vertex[m->element[m->elements - 1].first];
    t->slid = -cos(rad) * corner->u - sin(rad) * corner->v;
    t->found = (t->slid > 1e-4 ? SLIDES : 0) + (t->turned > 1e-4 ? TOPPLES : 0);
    bbm_model_free(m);
}

/* One more point, unless it lies outside or within 2 degrees of a border. */
static void add(chart *c, double a, double phi)
{
    const int here = theory(c->k, a, phi);

    if (phi < FROM / 2 || phi > TO || fabs(a - angle(c->k)) < 1.999 || c->n == MOST
        || here != theory(c->k, a, phi + 1.999) || here != theory(c->k, a, phi - 1.999))
        return;
    c->at[c->n] = (trial){ .k = c->k, .a = a, .phi = phi, .theory = here };
    run(&c->at[c->n++]);
}

static void fill(chart *c)
{
    const double delta = angle(c->k);

    for (double phi = FROM; phi < TO; phi += 6) {
        add(c, delta - 2, phi);
        add(c, delta + 2, phi);
    }
    for (double a = FROM; a <= TO; a += 4)
        for (int side = -2; side <= 2; side += 4) {
            add(c, a, fmin(a, delta) + side);
            if (a > delta)
                add(c, a, critical(c->k, a) + side);
        }
    for (double a = FROM; a <= TO; a += 8)
        for (double phi = FROM; phi <= TO; phi += 8)
            add(c, a, phi);
}

/* ------------------------------------------------------------------------------------------------- results */

/* Agreement by regime; the worst margins: how far the least motion is above the limit and the greatest rest below. */
static int print_agreement(case_results *r, const chart c[SHAPES])
{
    double slowest = INFINITY, restless = 0, turned = 0;
    int all = 0, agreed = 0;

    printf("\n| b/h | delta | stands | slides | topples | slides and topples | agree with theory |\n"
           "|---|---|---|---|---|---|---|\n");
    for (int s = 0; s < SHAPES; s++) {
        int of[REGIMES] = { 0 }, right[REGIMES] = { 0 }, sum = 0;
        for (int i = 0; i < c[s].n; i++) {
            const trial *t = &c[s].at[i];
            const double motion[2] = { fabs(t->slid), fabs(t->turned) };
            of[t->theory]++;
            right[t->theory] += t->theory == t->found;
            sum += t->theory == t->found;
            turned = fmax(turned, t->turned);
            for (int k = 0; k < 2; k++)
                if (t->theory & (k + 1))
                    slowest = fmin(slowest, motion[k]);
                else
                    restless = fmax(restless, motion[k]);
        }
        printf("| %s | %.2f |", c[s].name, angle(c[s].k));
        for (int k = 0; k < REGIMES; k++)
            printf(" %d of %d |", right[k], of[k]);
        printf(" %d of %d |\n", sum, c[s].n);
        all += c[s].n;
        agreed += sum;
    }
    printf("\nLimit 1e-4 (m, rad) after 0.05 s. What must move has moved by at least %.1e, what must not by at most "
           "%.1e;\nthe largest turn is %.2f degrees.\n", slowest, restless, turned * 180 / PI);
    case_row(r, "agreeing", (double[]){ NAN, NAN }, agreed, all, "theory");
    return all - agreed;
}

static void list_wrong(const chart c[SHAPES])
{
    for (int s = 0; s < SHAPES; s++)
        for (int i = 0; i < c[s].n; i++) {
            const trial *t = &c[s].at[i];
            if (t->theory != t->found)
                printf("b/h = %s, a = %.2f, phi = %.2f: %s, theory: %s; slid %.1e m, turned %.1e\n", c[s].name, t->a,
                       t->phi, REGIME[t->found], REGIME[t->theory], t->slid, t->turned);
        }
}

static void write_points(case_results *r, const chart *c)
{
    double table[MOST][7];
    char file[40], *slash;

    for (int i = 0; i < c->n; i++) {
        const trial *t = &c->at[i];
        const double row[7] = { t->k, t->a, t->phi, t->slid, t->turned, t->found, t->theory };
        memcpy(table[i], row, sizeof row);
    }
    snprintf(file, sizeof file, "points_%s.csv", c->name);
    if ((slash = strchr(file, '/')))
        *slash = '-';
    case_write_curves(r, file, "b_over_h,a,phi,slid,turned,found,theory", c->n, 7, &table[0][0]);
}

/* The borders as one series with gaps; the points by what was found. */
static void draw_chart(plot *p, plot_box box, const chart *c)
{
    const double delta = angle(c->k);
    double x[CURVE + 7], y[CURVE + 7], at[REGIMES][2][MOST], wrong[2][MOST];
    int n = 0, of[REGIMES] = { 0 }, off = 0;
    char title[40];

    const double lines[6][2] = { { 0, 0 }, { delta, delta }, { 90, delta }, { NAN, NAN }, { delta, 90 },
                                 { delta, delta } };
    for (; n < 6; n++)
        x[n] = lines[n][0], y[n] = lines[n][1];
    for (int i = 0; i < CURVE; i++, n++) {
        x[n] = delta + (89 - delta) * i / (CURVE - 1);
        y[n] = critical(c->k, x[n]);
    }
    for (int i = 0; i < c->n; i++) {
        const trial *t = &c->at[i];
        const int k = of[t->found]++;
        at[t->found][0][k] = t->a, at[t->found][1][k] = t->phi;
        if (t->found != t->theory)
            wrong[0][off] = t->a, wrong[1][off++] = t->phi;
    }
    plot_series s[REGIMES + 2] = { { .name = "theory", .n = n, .x = x, .y = y, .look = 1 } };
    for (int k = 0; k < REGIMES; k++)
        s[1 + k] = (plot_series){ .name = REGIME[k], .n = of[k], .x = at[k][0], .y = at[k][1], .style = PLOT_MARKS,
                                  .look = k + 2 };
    s[REGIMES + 1] = (plot_series){ .name = "wrong", .n = off, .x = wrong[0], .y = wrong[1], .style = PLOT_MARKS,
                                    .look = 8 };
    snprintf(title, sizeof title, "Block with b/h = %s", c->name);
    plot_draw_chart(p, box, &(plot_chart){ .title = title, .x = { "incline a", "degrees", 0, 0, 90 },
                    .y = { "friction phi", "degrees", 0, 0, 90 }, .count = REGIMES + 1 + (off > 0), .series = s });
}

static void draw_charts(case_results *r, const chart c[SHAPES])
{
    plot p;

    if (!case_draw(r, plot_open(&p, case_path(r, "chart.svg"), 1160, 1080)))
        return;
    for (int s = 0; s < SHAPES; s++)
        draw_chart(&p, (plot_box){ s % 2 * 580, s / 2 * 540, 580, 540 }, &c[s]);
    case_draw(r, plot_close(&p));
}

/* The four regimes side by side, at the same friction of 30 degrees. */
static void draw_film(case_results *r)
{
    static const struct { double a, k, x; } at[] = { { 20, 0.5, 0 }, { 40, 1, 5 }, { 32, 0.5, 10 }, { 60, 0.5, 14 } };
    scene film = { .title = "Friction 30 degrees: stands, slides, topples, slides and topples" };
    bbm_model *m = case_moving_model(&(case_blocks){ 1e10, 0.25, 0.005, 1e10, 30, 1e-13 });

    for (int i = 0; i < LENGTH(at); i++) {
        const double turn = at[i].a * PI / 180, x = cos(turn) * at[i].x, y = -sin(turn) * at[i].x;
        case_add_box(m, &(case_box){ .block = 2 * i, .nx = 1, .ny = 1, .x = x - 2, .y = y - 0.4, .w = 4, .h = 0.4,
                                     .turn = turn });
        case_fix_block(m, 2 * i);
        case_add_box(m, &(case_box){ .block = 2 * i + 1, .material = 1, .nx = 1, .ny = 1, .x = x, .y = y,
                                     .w = 1.6 * at[i].k, .h = 1.6, .turn = turn });
    }
    case_must(m, bbm_prepare(m));
    scene_record(&film, m);
    for (int i = 0; i < 120; i++)
        case_step(m, &film);
    case_draw(r, scene_write_movie(&film, m, case_path(r, "regimes.svg")));
    case_draw(r, scene_write_panels(&film, m, case_path(r, "states.svg"), 2,
                                    (double[]){ 0.3, 0.6 }));
    scene_free(&film);
    bbm_model_free(m);
}

int main(void)
{
    static const struct { double k; const char *name; } shape[SHAPES] = {
        { 1.0 / 3, "1/3" }, { 0.5, "1/2" }, { 1, "1" }, { 2, "2" },
    };
    chart c[SHAPES];
    case_results r;

    printf("\n# Slide or topple\n");
    case_open(&r, "topple");
    for (int s = 0; s < SHAPES; s++) {
        c[s] = (chart){ .k = shape[s].k, .name = shape[s].name };
        fill(&c[s]);
        write_points(&r, &c[s]);
    }
    if (print_agreement(&r, c) > 0)
        list_wrong(c);
    draw_charts(&r, c);
    draw_film(&r);
    printf("\nNumbers and pictures: %s/results.csv, points_1-3.csv to points_2.csv, chart.svg, states.svg, "
           "regimes.svg (it moves)\n", r.folder);
    return case_close(&r);
}
