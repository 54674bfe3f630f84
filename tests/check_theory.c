/* check_theory.c - the textbook formulas (70) and (72) against what makes them solutions: the
 * equations of plane elasticity inside, the tractions on the boundary, and how the body is held.
 * Derivatives are taken by differences. */
#include "check.h"

#include "../cases/theory.h"

static const theory_beam beam = { .P = 1000, .L = 48, .H = 12, .E = 30e6, .nu = 0.3 };
static const theory_plate plate = { .S = 1e6, .E = 2900e9, .nu = 0.3 };

typedef void function(double x, double y, double f[]);

/* d f[k]/dx (way 0) or d f[k]/dy (way 1) at (x, y) by the differences of fourth order over h. */
static double derivative(function *f, int k, int way, double x, double y, double h)
{
    const double weight[4] = { 1.0 / 12, -8.0 / 12, 8.0 / 12, -1.0 / 12 };
    const double step[4] = { -2, -1, 1, 2 };
    double sum = 0, value[3];

    for (int i = 0; i < 4; i++) {
        f(x + (way == 0) * step[i] * h, y + (way == 1) * step[i] * h, value);
        sum += weight[i] * value[k] / h;
    }
    return sum;
}

/* div s = 0 */
static void check_equilibrium(function *s, double x, double y, double h, double bound)
{
    ck_near(derivative(s, 0, 0, x, y, h) + derivative(s, 2, 1, x, y, h), 0, 1, bound);
    ck_near(derivative(s, 2, 0, x, y, h) + derivative(s, 1, 1, x, y, h), 0, 1, bound);
}

/* Stress of the strain of u by Hooke's law in plane stress. */
static void stress_of(function *u, double E, double nu, double x, double y, double h, double s[3])
{
    const double ex = derivative(u, 0, 0, x, y, h), ey = derivative(u, 1, 1, x, y, h);
    const double gxy = derivative(u, 0, 1, x, y, h) + derivative(u, 1, 0, x, y, h);

    s[0] = E / (1 - nu * nu) * (ex + nu * ey);
    s[1] = E / (1 - nu * nu) * (ey + nu * ex);
    s[2] = E / (2 * (1 + nu)) * gxy;
}

/* ----------------------------------------------------------------------------------------- (70) */

static void beam_u(double x, double y, double u[]) { theory_beam_displacement(&beam, x, y, u); }

/* Differences of fourth order are exact for polynomials to degree four. */
static void beam_stress(double x, double y, double s[])
{
    stress_of(beam_u, beam.E, beam.nu, x, y, 1, s);
}

START_TEST(the_theory_of_the_beam_is_in_equilibrium_and_bends_by_its_load_alone)
{
    const double size = beam.P * beam.L / (beam.H * beam.H / 6);    /* Pa, the largest stress */
    const double tiny = 1e-9 * size;                    /* round-off of u over 1 m, times E */
    double s[3], force = 0;

    for (int i = 0; i <= 8; i++)
        for (int j = -6; j <= 6; j++) {
            const double x = 6 * i, y = j;
            check_equilibrium(beam_stress, x, y, 1, tiny);
            beam_stress(x, y, s);
            ck_near(s[0], beam.P * (beam.L - x) * y / (beam.H * beam.H * beam.H / 12), 1, tiny);
            ck_near(s[1], 0, 1, tiny);
            if (abs(j) == 6)
                ck_near(s[2], 0, 1, tiny);
            force += (abs(j) == 6 ? 1 : j % 2 ? 4 : 2) * s[2] / (3 * 9); /* Simpson */
        }
    ck_near(force, -beam.P, 1, 12 * tiny);
}
END_TEST

START_TEST(the_theory_of_the_beam_is_held_at_three_points_of_its_end)
{
    double u[2];

    beam_u(0, 0, u);
    ck_near(u[0], 0, 1, 0);
    ck_near(u[1], 0, 1, 0);
    for (int side = -1; side <= 1; side += 2) {
        beam_u(0, side * beam.H / 2, u);
        ck_near(u[0], 0, 1e-3, 1e-15);
    }
}
END_TEST

/* ----------------------------------------------------------------------------------------- (72) */

static void plate_u(double x, double y, double u[]) { theory_plate_displacement(&plate, x, y, u); }
static void plate_s(double x, double y, double s[]) { theory_plate_stress(&plate, x, y, s); }

/* Around the hole, from its edge outwards. The differences are off by about h^4 and by 1e-16/h:
 * 1e-9 of S for 1e-3 m. */
START_TEST(the_theory_of_the_plate_is_in_equilibrium_and_u_is_that_of_its_stresses)
{
    const double h = 1e-3, E = plate.E, nu = plate.nu;

    for (int i = 0; i < 120; i++) {
        const double r = 1 + i / 24, th = 0.05 + i % 24 * 0.26, x = r * cos(th), y = r * sin(th);
        double s[3], t[3];
        plate_s(x, y, s);
        stress_of(plate_u, E, nu, x, y, h, t);
        for (int k = 0; k < 3; k++)
            ck_near(t[k], s[k], plate.S, 1e-8);
        check_equilibrium(plate_s, x, y, h, 1e-8 * plate.S);
    }
}
END_TEST

START_TEST(the_hole_of_the_plate_is_free_and_far_away_there_is_tension_along_x)
{
    for (int i = 0; i < 24; i++) {
        const double th = 0.05 + i * 0.26, x = cos(th), y = sin(th);
        double s[3];
        plate_s(x, y, s);
        ck_near(s[0] * x + s[2] * y, 0, plate.S, 1e-14);
        ck_near(s[2] * x + s[1] * y, 0, plate.S, 1e-14);
        plate_s(1e4 * x, 1e4 * y, s);                       /* the hole is felt as 1/r^2 */
        ck_near(s[0], plate.S, plate.S, 1e-7);
        ck_near(s[1], 0, plate.S, 1e-7);
        ck_near(s[2], 0, plate.S, 1e-7);
    }
}
END_TEST

START_TEST(the_axes_of_the_plate_stay_straight)
{
    for (double r = -5; r <= 5; r += 0.5) {
        const double size = plate.S / plate.E;              /* m, of the displacements */
        double u[2];
        if (fabs(r) < 1)
            continue;
        plate_u(r, 0, u);
        ck_near(u[1], 0, size, 1e-14);
        plate_u(0, r, u);
        ck_near(u[0], 0, size, 1e-14);
    }
}
END_TEST

Suite *theory_suite(void)
{
    Suite *s = suite_create("theory");

    add_case(s, "beam",
        { the_theory_of_the_beam_is_in_equilibrium_and_bends_by_its_load_alone, 1 },
        { the_theory_of_the_beam_is_held_at_three_points_of_its_end, 1 });
    add_case(s, "plate",
        { the_theory_of_the_plate_is_in_equilibrium_and_u_is_that_of_its_stresses, 1 },
        { the_hole_of_the_plate_is_free_and_far_away_there_is_tension_along_x, 1 },
        { the_axes_of_the_plate_stay_straight, 1 });
    return s;
}
