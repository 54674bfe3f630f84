/* turning.c - a free block that turns keeps its area, if it is turned.
 *
 *      .---.   w = 1 rad/s          1 m x 1 m, no gravity, dt = 0.01 s, 200 steps: 2 s, 2 rad. In each step r0 = w dt.
 *      |   |
 *      '---'   The paper moves a point X from the barycentre by x + T D, which for a rotation is
 *
 *                  x' = X + r0 (-Y, X):     lengths grow by sqrt(1 + r0^2), the area by 1 + r0^2, each step,
 *
 *              (1 + (w dt)^2)^200 - 1 = 2.02 %. The exact rotation x' = R(r0) (1 + e) X keeps it.
 *
 * A smaller step only helps in proportion: the area grows by w^2 dt t.
 *
 * A block of n x n bonded elements keeps its area, too, up to the stretch of a turning elastic block, of the order of
 * rho w^2/E = 2.5e-6 here. It keeps its angular momentum as well, up to that strain, 1.5e-8 at every dt, because its
 * bonds pull along the directions of the middle of the step (beyond/middle.c). The paper's would not keep it: if the
 * barycentres are held on their circles along a, the direction at the start of the step, x' = x + dt v + dt^2/2 a,
 * v' = v + dt a, then with x cross a = 0
 *
 *     x' cross v' = x cross v + dt^2/2 v cross a = (1 + (w dt)^2/2) x cross v.
 *
 * Of the block's moment of inertia 1 - 1/n^2 is that of the barycentres, so that it would gain the share
 * (1 - 1/n^2) w^2 dt t/2, of first order in dt: the last column. */
#include <math.h>

#include "../beyond/beyond.h"
#include "case.h"

enum { STEPS = 200 };

static bbm_model *build_turning(bbm_rotation rotation, double dt, int n)
{
    bbm_model *m = case_model();

    bbm_add_material(m, &(bbm_material){ 1e9, 0.25, 2500, 1 }, NULL);
    case_add_box(m, &(case_box){ .nx = n, .ny = n, .x = -0.5, .y = -0.5, .w = 1, .h = 1 });
    m->par.dt = dt;
    m->par.velocity_factor = 1;
    m->beyond->rotation = rotation;
    m->par.pcg.tolerance = 1e-14;
    case_must(m, bbm_prepare(m));
    for (int i = 0; i < m->elements; i++) {
        bbm_element *e = &m->element[i];
        bbm_element_geometry(e, &m->vertex[e->first]);
        e->V[0] = -e->y;
        e->V[1] = e->x;
        e->V[2] = 1;
    }
    return m;
}

/* The area of all elements as they are now. */
static double area(const bbm_model *m)
{
    double A = 0;

    for (int i = 0; i < m->elements; i++) {
        bbm_element e = m->element[i];
        bbm_element_geometry(&e, &m->vertex[e.first]);
        A += e.A;
    }
    return A;
}

/* The angular momentum about the origin for the density 1, sum int x cross v dA, v = T V:
 * A0 (x v - y u) + A0/A ((Sxx + Syy) r + Sxy (ey - ex) + (Sxx - Syy) gxy/2), u, v, .. the velocities V. */
static double angular_momentum(const bbm_model *m)
{
    double L = 0;

    for (int i = 0; i < m->elements; i++) {
        bbm_element e = m->element[i];
        bbm_element_geometry(&e, &m->vertex[e.first]);
        L += e.A0 * (e.x * e.V[1] - e.y * e.V[0]) + e.A0 / e.A
             * ((e.Sxx + e.Syy) * e.V[2] + e.Sxy * (e.V[4] - e.V[3]) + (e.Sxx - e.Syy) / 2 * e.V[5]);
    }
    return L;
}

/* Turns for 2 s; growth[k] of the area after k steps, if not NULL. Returns the growth at the end. *gain: the share of
 * angular momentum gained. */
static double turn(bbm_rotation rotation, double dt, int n, double *growth, double *gain)
{
    bbm_model *m = build_turning(rotation, dt, n);
    const int steps = (int)floor(2 / dt + 0.5);
    const double start = angular_momentum(m);

    for (int i = 0; i < steps; i++) {
        if (growth)
            growth[i] = area(m) - 1;
        case_step(m, NULL, NULL);
    }
    const double end = area(m) - 1;
    if (growth)
        growth[steps] = end;
    *gain = angular_momentum(m) / start - 1;
    bbm_model_free(m);
    return end;
}

static void draw(case_results *r, const double growth[2][STEPS + 1])
{
    double t[STEPS + 1], exact[STEPS + 1], table[STEPS + 1][4];

    for (int i = 0; i <= STEPS; i++) {
        t[i] = table[i][0] = 0.01 * i;
        exact[i] = table[i][3] = pow(1 + 1e-4, i) - 1;
        table[i][1] = growth[0][i];
        table[i][2] = growth[1][i];
    }
    const plot_series s[] = {
        { .name = "(1 + (w dt)^2)^k - 1", .n = STEPS + 1, .x = t, .y = exact, .look = 1 },
        { .name = "linear update of the paper", .n = STEPS + 1, .x = t, .y = growth[1], .style = PLOT_BOTH, .look = 2 },
        { .name = "exact rotation", .n = STEPS + 1, .x = t, .y = growth[0], .style = PLOT_BOTH, .look = 4 },
    };
    case_draw_chart(r, "area.svg", &(plot_chart){ .title = "Turning block: growth of the area, dt = 0.01 s",
                    .x = { "t", "s", 0, 0, 0 }, .y = { "growth of the area", "", 0, 0, 0.022 }, .count = 3,
                    .series = s });
    case_write_curves(r, "area.csv", "t,exact_rotation,linear,theory", STEPS + 1, 4, &table[0][0]);
}

int main(void)
{
    case_results r;
    double growth[2][STEPS + 1], gain;

    printf("\n# Turning block\n\n| growth of the area in 2 s | computed | theory | error |\n|---|---|---|---|\n");
    case_open(&r, "turning");
    turn(BBM_EXACT, 0.01, 1, growth[0], &gain);
    turn(BBM_LINEAR, 0.01, 1, growth[1], &gain);
    case_compare(&r, "exact rotation, dt = 0.01 s", growth[0][STEPS], 0);
    case_compare(&r, "linear update, dt = 0.01 s", growth[1][STEPS], pow(1 + 1e-4, STEPS) - 1);
    case_compare(&r, "linear update, dt = 0.001 s", turn(BBM_LINEAR, 0.001, 1, NULL, &gain), pow(1 + 1e-6, 2000) - 1);
    printf("\n| 3 x 3 bonded elements, exact rotation | area | angular momentum gained | with the paper's vectors it would be |\n"
           "|---|---|---|---|\n");
    for (double dt = 0.01; dt > 0.001; dt /= 2) {
        const double end = turn(BBM_EXACT, dt, 3, NULL, &gain), paper = (1 - 1.0 / 9) * dt;
        char name[60];
        snprintf(name, sizeof name, "angular momentum gained at dt = %g s", dt);
        case_row(&r, name, (double[]){ NAN, NAN }, gain, 0, "theory");
        printf("| dt = %g s | %+.1e | %+.1e | %+.1e |\n", dt, end, gain, paper);
    }
    draw(&r, (const double (*)[STEPS + 1])growth);
    printf("\nNumbers and picture: %s/results.csv, area.csv, area.svg\n", r.folder);
    return case_close(&r);
}
