/* impact.c - blocks that meet in free space: momentum, angular momentum, and a cradle.
 *
 *      .---.        .---.           1 m x 1 m, 2500 kg/m^3, no gravity, p_n = 1e9 N/m
 *      |   | -> v0  |   |
 *      '---'        '---'           Momentum is exact: a contact pushes both blocks with one force, and the mass is
 *                                   density times the starting area, or a block that is squeezed would be lighter.
 *
 *   .-. ->  .-.   .-.   .-.   .-.   Cradle: n blocks in a row, apart from each other, the first with v0. Two equal
 *   '-'     '-'   '-'   '-'   '-'   masses with the restitution e leave an impact with (1-e)/2 and (1+e)/2 of the
 *                                   velocity, so that the last one flies off with v0 ((1+e)/2)^(n-1).
 *
 * e is measured in the impact of two. It depends on when in a step they arrive, and each impact of the cradle differs
 * in that: where a step is no small part of the contact, e of one does not tell e of the next. On average it is
 * (1+q)^(-pi/(2 th)) with q = W^2/2, cos th = (2-q)/(2 sqrt(1+q)), W = dt sqrt(2 * 2 p_n/m), as in drop.c: two springs
 * of p_n between the masses m, m.
 *
 * Angular momentum is kept up to the strain of the blocks, with friction and without. The forces of a contact act at
 * the points of the middle of the step, where their moments sum to zero (beyond/rotation.c). The paper's shear forces,
 * (60)-(62) of the start, would leave a couple of the shear force and the penetration. What is left falls as 1/E and
 * grows as the force of the impact does, as p_n^(1/2): strain changes the moment of inertia of what turns (turn_element
 * in bbm.c). The time step hardly changes it. The table gives the error as a share of what the first block brings along,
 * m v0 times the offset. */
#include <math.h>

#include "case.h"

enum { BALLS = 5 };

static const double density = 2500;

/* A row of n blocks with gaps, each `offset` above the one before; the first has the velocity 1. */
static bbm_model *build_row(int n, double gap, double offset, double friction, double p_n, double dt)
{
    bbm_model *m = case_model();

    bbm_add_material(m, &(bbm_material){ 1e12, 0.25, density, 1 }, NULL);
    for (int k = 0; k < n; k++)
        case_add_box(m, &(case_box){ .block = k, .nx = 1, .ny = 1, .x = k * (1 + gap) - 0.5, .y = offset * k - 0.5,
                                     .w = 1, .h = 1 });
    m->par.dt = dt;
    m->par.velocity_factor = 1;
    m->par.p_n = p_n;
    m->par.p_s = 0.4 * p_n;
    m->par.friction = friction;
    m->par.pcg.tolerance = 1e-15;
    case_must(m, bbm_prepare(m));
    m->element[0].V[0] = 1;
    return m;
}

/* P[0], P[1]: momentum of all blocks; P[2]: angular momentum about the origin, sum int x cross v dm, v = T V:
 * M (x v - y u) + M/A ((Sxx + Syy) r + Sxy (ey - ex) + (Sxx - Syy) gxy/2), u, v, .. the velocities V. */
static void sum_momentum(const bbm_model *m, double P[3])
{
    P[0] = P[1] = P[2] = 0;
    for (int i = 0; i < m->elements; i++) {
        bbm_element e = m->element[i];
        const double M = density * e.A0;
        bbm_element_geometry(&e, &m->vertex[e.first]);
        P[0] += M * e.V[0];
        P[1] += M * e.V[1];
        P[2] += M * (e.x * e.V[1] - e.y * e.V[0]) + M / e.A
                * ((e.Sxx + e.Syy) * e.V[2] + e.Sxy * (e.V[4] - e.V[3]) + (e.Sxx - e.Syy) / 2 * e.V[5]);
    }
}

/* Lets two blocks meet. error: of momentum along x and y in the first's, of angular momentum in its own times offset.
 * Returns e, the velocity at which they part over that at which they met. */
static double meet(double offset, double friction, double p_n, double dt, double error[3])
{
    bbm_model *m = build_row(2, 0.05, offset, friction, p_n, dt);
    double before[3], after[3];

    sum_momentum(m, before);
    while (m->info.t < 0.2)
        case_step(m, NULL, NULL);
    sum_momentum(m, after);
    for (int i = 0; i < 3; i++)
        error[i] = (after[i] - before[i]) / density / (i == 2 ? offset : 1);
    const double e = m->element[1].V[0] - m->element[0].V[0];
    bbm_model_free(m);
    return e;
}

static void show_momentum(case_results *r)
{
    const double nowhere[2] = { NAN, NAN };
    double error[3];

    printf("| off-centre by 0.3 m | momentum along x, error | along y | angular momentum, error |\n"
           "|---|---|---|---|\n");
    for (int phi = 0; phi <= 30; phi += 30)
        for (int k = 0; k < 5; k++) {
            const double p_n = pow(10, 9 + k % 3), dt = k < 3 ? 2e-5 : 1e-4;
            char name[90];
            if (k > 2 && p_n > 1e9)
                continue;
            meet(0.3, phi, p_n, dt, error);
            printf("| phi = %d, p_n = %g, dt = %g s | %.1e | %.1e | %+.2e |\n", phi, p_n, dt, error[0],
                   error[1], error[2]);
            snprintf(name, sizeof name, "momentum for phi = %d p_n = %g dt = %g", phi, p_n, dt);
            case_row(r, name, nowhere, 1 + error[0], 1, "theory");
            snprintf(name, sizeof name, "angular momentum gained for phi = %d p_n = %g dt = %g", phi, p_n, dt);
            case_row(r, name, nowhere, error[2], 0, "theory");
        }
}

/* The restitution of two blocks on average. */
static double theory(double p_n, double dt)
{
    const double q = dt * dt * 2 * p_n / density, th = acos((2 - q) / (2 * sqrt(1 + q)));

    return pow(1 + q, -acos(-1) / (2 * th));
}

/* The velocity of the last block against that of the formula; s, if not NULL, records. */
static void swing(case_results *r, double dt, double e, scene *s)
{
    bbm_model *m = build_row(BALLS, 0.1, 0, 0, 1e9, dt);
    char name[80];

    if (s)
        scene_record(s, m);
    for (int k = 0; m->info.t < 1; k++) {
        case_step(m, NULL, NULL);
        if (s && (k + 1) % 100 == 0)
            scene_record(s, m);
    }
    snprintf(name, sizeof name, "last of %d blocks, dt = %g s, e = %.4f [m/s]", BALLS, dt, e);
    case_compare(r, name, m->element[BALLS - 1].V[0], pow((1 + e) / 2, BALLS - 1));
    if (s) {
        scene_record(s, m);
        case_draw_movie(r, "cradle.svg", m, s);
        case_draw_panels(r, "states.svg", m, s, 3, (double[]){ 0, 0.25, 1 });
    }
    bbm_model_free(m);
}

int main(void)
{
    case_results r;
    scene s = { .title = "A block hits a row of four" };
    double error[3];

    printf("\n# Impact\n\n");
    case_open(&r, "impact");
    show_momentum(&r);
    printf("\n| head-on | computed | theory | error |\n|---|---|---|---|\n");
    for (double dt = 1e-3; dt > 5e-6; dt /= 10) {
        char name[60];
        const double e = meet(0, 0, 1e9, dt, error);
        snprintf(name, sizeof name, "momentum, dt = %g s", dt);
        case_compare(&r, name, 1 + error[0], 1);
        snprintf(name, sizeof name, "restitution e, dt = %g s", dt);
        case_compare(&r, name, e, theory(1e9, dt));
        swing(&r, dt, e, dt < 5e-5 ? &s : NULL);
    }
    printf("\nNumbers and pictures: %s/results.csv, states.svg, cradle.svg\n", r.folder);
    scene_free(&s);
    return case_close(&r);
}
