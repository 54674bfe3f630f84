/* exp3.c - Experiment III: a block slides without friction (section 4.4, Fig. 24 and 25).
 *
 *           y ^      block 4 m x 1 m, 4 x 2 quadrilaterals; the traction on its left side sums to
 *     ____    |      F = 10 kN
 *  F |____|   |
 *  __|____o___|_____ plate 20 m x 2 m, 40 x 4 quadrilaterals, its base fixed; the origin is its
 * |         P |---> |  x                                                        centroid
 * |_________________| E = 10 GPa, nu = 0.25, 2500 kg/m^2, t = 1 m, so m = 10 t
 *  /////////////////
 *                    u(t) = F t^2/(2 m), v(t) = 0 for the centre of mass, and for P, the lower
 *                    right corner
 *
 *     without  no gravity, as in the text: the block touches the plate and carries nothing
 *     gravity  9.81 m/s^2; the plate gives way under the block, least in the middle between two of
 *              its grid points. So the block climbs and sinks over each edge, and stays behind
 *     rigid    the same on a plate of 1e13 Pa: what is left of the error is not the plate's
 *     line     the same, the traction as a line load
 *     beyond   10 GPa again, with beyond/ and alpha = 1e4; all others are the paper's way, by the
 *              core alone. Quadrilaterals bonded at vertices lock, and so does their plate. With
 *              edge bonds it gives way to each grid point as an elastic plate does, six times as
 *              far, and the block climbs six times as high
 *
 * The traction of 10 kN/m is given as the forces that do its work on the grid points of that side,
 * 2.5, 5 and 2.5 kN. As a line load, Eq. (43), it acts on the side's present length, and the weight
 * shortens that by about density g h/(2 E) = 1e-6: so much of F is missing, and of u.
 *
 * The block is first brought into equilibrium under its weight and the traction, in quasi-static
 * steps: displacements count from there, without the elastic shortening of about F L/(2 E A) =
 * 2e-6 m. Then it is let go from rest and moves 2 m in 2 s, with P over four edges of the plate. */

#include "case.h"

enum { STEPS = 200, SETTLE = 10, RUNS = 5 };

static const double F = 1e4, MASS = 2500 * 4, DT = 0.01, ROUNDING = 1e-8;     /* N, kg, s, m */

typedef struct {
    const char *name, *label;
    double gravity, plate;                  /* m/s^2, Pa                                        */
    int line, beyond;                       /* the traction is a line load; with beyond/        */
} variant;

typedef struct {
    bbm_model *m;
    int first, mark;                        /* first element of the block; the node P           */
    double at[4][STEPS + 1];                /* m        u, v of the centre of mass, then of P   */
} slide;

/* The model, brought into equilibrium by quasi-static steps: springs that are loaded suddenly would
 * swing. */
static void build(bbm_model *m, const variant *v, int *first)
{
    bbm_add_material(m, &(bbm_material){ v->plate, 0.25, 2500, 1 }, NULL);
    bbm_add_material(m, &(bbm_material){ 1e10, 0.25, 2500, 1 }, NULL);
    case_add_grid(m, &(case_grid){ .nx = 40, .ny = 4, .x = -10, .y = -1, .w = 20, .h = 2 });
    for (int n = 0; n <= 40; n++)               /* its base */
        bbm_fix_node(m, n, BBM_XY, 0, 0);
    *first = case_add_grid(m, &(case_grid){ .block = 1, .material = 1, .nx = 4, .ny = 2,
                                            .x = -8, .y = 1, .w = 4, .h = 1 });
    for (int j = 0; j < 2; j++) {               /* the traction on the left side of the block */
        const bbm_vertex *corner = &m->vertex[m->element[*first + 4 * j].first];
        if (v->line)
            bbm_add_line_load(m, corner[3].node, corner[0].node, F, 0);
        for (int k = 0; k < 4 && !v->line; k += 3)
            bbm_add_load(m, corner[k].node, F / 4, 0);
    }
    m->par.dt = DT;
    m->par.gravity[1] = -v->gravity;
    m->par.alpha = v->beyond ? 1e4 : 1000;
    m->par.p_n = 5e11;
    m->par.p_s = 2e11;
    m->par.pcg.tolerance = 1e-10;
    m->par.steps = STEPS;
    case_must(m, bbm_prepare(m));
    for (int i = 0; i < SETTLE; i++)            /* each begins at rest */
        case_must(m, bbm_step(m));
    m->par.velocity_factor = 1;
}

/* u, v of the centre of mass (the elements are equal) and of P. */
static void measure(const slide *s, double at[4])
{
    bbm_result P;

    at[0] = at[1] = 0;
    for (int e = s->first; e < s->m->elements; e++)
        for (int c = 0; c < 2; c++)
            at[c] += s->m->element[e].sum[c] / (s->m->elements - s->first);
    case_must(NULL, bbm_nodal_result(s->m, s->mark, 1, &P));
    at[2] = P.u;
    at[3] = P.v;
}

/* Returns 0 if there is no such model. */
static int run(slide *s, const variant *v)
{
    double start[4], now[4];

    s->m = v->beyond ? case_beyond_model(0, 1) : case_paper_model();
    if (!s->m)
        return 0;
    build(s->m, v, &s->first);
    s->mark = s->m->vertex[s->m->element[s->first + 3].first + 1].node;
    measure(s, start);
    s->m->info.t = 0;
    for (int i = 0; i <= STEPS; i++) {
        if (i > 0)
            case_must(s->m, bbm_step(s->m));
        measure(s, now);
        for (int c = 0; c < 4; c++)
            s->at[c][i] = now[c] - start[c];
    }
    return 1;
}

static double theory(double t) { return F * t * t / (2 * MASS); }

/* -------------------------------------------------------------------------------------- results */

/* Of errors below ROUNDING the digits differ from one machine to the next. */
static void print_run(case_results *r, const slide *s, const variant *v)
{
    const double exact = theory(STEPS * DT), nowhere[2] = { NAN, NAN };
    double high[2] = { 0 };

    for (int i = 0; i <= STEPS; i++)
        for (int k = 0; k < 2; k++)
            high[k] = fmax(high[k], fabs(s->at[1 + 2 * k][i]));
    const struct { const char *name, *label; double computed, theory; } row[] = {
        { "centre.u", "u of the centre", s->at[0][STEPS], exact },
        { "mark.u", "u of P", s->at[2][STEPS], exact }, { "centre.v", NULL, high[0], 0 },
        { "mark.v", "largest v of P", high[1], 0 },
    };
    for (int k = 0; k < LENGTH(row); k++) {
        const double e = row[k].computed - row[k].theory;
        char name[64];
        snprintf(name, sizeof name, "%s.%s", v->name, row[k].name);
        case_row(r, name, nowhere, row[k].computed, row[k].theory, "theory");
        if (!row[k].label)
            continue;
        printf("| %s, %s | %.6f | %g | ", row[k].label, v->label, row[k].computed, row[k].theory);
        printf(fabs(e) < ROUNDING ? "below 1e-08 m |\n" : "%+.0e m |\n", e);
    }
}

/* Fig. 25: u of P, and v in a scale in which it can be seen. */
static void draw_figure(case_results *r, const slide s[], const variant v[])
{
    enum { N = STEPS + 1, MARKS = 21, EACH = STEPS / (MARKS - 1) };
    double t[N], exact[N], some[2][MARKS];
    plot p;

    for (int i = 0; i < N; i++) {
        t[i] = i * DT;
        exact[i] = theory(t[i]);
        some[0][i / EACH] = t[i / EACH * EACH];
        some[1][i / EACH] = s[0].at[2][i / EACH * EACH];
    }
    const plot_series way[] = {
        { "u = F t²/(2 m)", N, t, exact, PLOT_LINE, 1 },
        { "u, BBM", MARKS, some[0], some[1], PLOT_MARKS, 2 },
    };
    plot_series lift[3];
    for (int k = 0; k < 3; k++)
        lift[k] = (plot_series){ v[k].label, N, t, s[k].at[3], PLOT_LINE, k + 2 };
    plot_open(&p, case_path(r, "fig25.svg"), 1240, 480);
    plot_draw_chart(&p, (plot_box){ 0, 0, 620, 480 }, &(plot_chart){
        .title = "Fig. 25: u of P", .x = { "t", "s" }, .y = { "u", "m" },
        .count = LENGTH(way), .series = way });
    plot_draw_chart(&p, (plot_box){ 620, 0, 620, 480 }, &(plot_chart){
        .title = "Fig. 25: v of P, which is 0 in theory", .x = { "t", "s" },
        .y = { "v", "m" }, .count = LENGTH(lift), .series = lift });
    case_draw(r, plot_close(&p));
}

int main(void)
{
    static const variant v[RUNS] = {
        { "without", "without gravity", 0, 1e10, 0, 0 },
        { "gravity", "gravity, plate of 10 GPa", 9.81, 1e10, 0, 0 },
        { "rigid", "gravity, rigid plate", 9.81, 1e13, 0, 0 },
        { "line", "gravity, rigid plate, line load", 9.81, 1e13, 1, 0 },
        { "beyond", "gravity, plate of 10 GPa, with beyond/", 9.81, 1e10, 0, 1 },
    };
    case_results r;
    slide s[RUNS];
    int runs = 0;

    printf("\n# Experiment III: frictionless sliding, the paper's way\n\n");
    case_open(&r, "exp3");
    while (runs < RUNS && run(&s[runs], &v[runs]))
        runs++;
    case_print_parameters(s[1].m);
    printf("\n| Experiment III, displacement [m] at t = %g s | computed | exact | error |\n"
           "|---|---|---|---|\n", STEPS * DT);
    for (int k = 0; k < runs; k++)
        print_run(&r, &s[k], &v[k]);
    draw_figure(&r, s, v);
    printf("\nNumbers and pictures: %s\n", r.folder);
    for (int k = 0; k < runs; k++)
        bbm_model_free(s[k].m);
    return case_close(&r);
}
