/* check_moving.c - blocks that slide, are thrown, shaken, lean and rock, by model files, against
 * closed forms. */
#define _POSIX_C_SOURCE 200809L
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "programs.h"

static const double G = 9.81, RAD = 3.14159265358979323846 / 180;

/* A rectangle from (x, y), w x h, of n quadrilaterals side by side, turned about the origin. */
static void put_box(FILE *f, const char *name, const char *material, const double box[4], int n,
                    double turn)
{
    static int nodes;
    const double c = cos(turn), s = sin(turn);
    const int first = nodes + 1;

    for (int k = 0; k < 2 * (n + 1); k++) {
        const double x = box[0] + k / 2 * box[2] / n, y = box[1] + k % 2 * box[3];
        fprintf(f, "node %d %.16g %.16g\n", ++nodes, c * x - s * y, s * x + c * y);
    }
    for (int k = 0; k < n; k++)
        fprintf(f, "element %d %s %s %d %d %d %d\n", first + k, name, material, first + 2 * k,
                first + 2 * k + 2, first + 2 * k + 3, first + 2 * k + 1);
}

/* Runs what was written to out/model/moving.model. */
static void run_moving(FILE *f)
{
    fclose(f);
    ck_assert_int_eq(shell("%s/bbm -q out/model/moving.model -o out/model/moving 2> "
                           "out/model/err", BUILD), 0);
}

/* A slope that falls to the left and a block of 1 m x 0.5 m on it, of 2500 kg/m^3. */
typedef struct { double angle, phi, dt, p_n; int pieces, steps, settle; } slope;

static FILE *begin_slope(const slope *s)
{
    FILE *f = fopen("out/model/moving.model", "w");

    ck_assert_ptr_nonnull(f);
    fprintf(f,
            "material rigid E 1e14 nu 0.25 density 2500\nmaterial rock E 1e10 nu 0.25 density "
            "2500\n"
            "fixblock slope\ngravity 0 -9.81\ncontact kn %g friction %g\npcg tolerance 1e-14\n"
            "dynamic dt %g steps %d settle %d\nmonitor foot at 0 0 of block\n",
            s->p_n, s->phi, s->dt, s->steps, s->settle);
    put_box(f, "slope", "rigid", (double[]){ -12, -1, 18, 1 }, s->pieces, s->angle * RAD);
    put_box(f, "block", "rock", (double[]){ 0, 0, 1, 0.5 }, 1, s->angle * RAD);
    return f;
}

/* The way down of the block's corner since t = 0, after so many steps. */
static double slid(const slope *s, int step)
{
    const double a = s->angle * RAD;
    double way = 0;
    char row[20];

    for (int k = 0; k < 2; k++) {
        snprintf(row, sizeof row, "%d,", k ? step : 0);
        way += (k ? -1 : 1) * (cos(a) * cell("moving", "history.csv", row, "foot_u")
                               + sin(a) * cell("moving", "history.csv", row, "foot_v"));
    }
    return way;
}

/* The acceleration down a slope; friction acts against a motion that goes down (1) or up (-1). */
static double pull(double angle, double phi, int down)
{
    return G * (sin(angle * RAD) - down * cos(angle * RAD) * tan(phi * RAD));
}

START_TEST(a_block_that_is_thrown_stops_where_it_should)
{
    static const struct { double angle, phi, v, time, most; } thrown[] = {
        { 30, 40, 3, 4, 1e-3 },             /* it stops: within a step, |a| dt^2/2 */
        { 20, 30, -3, 2, 1e-3 },            /* upwards */
        { 30, 10, 1, 1, 1e-9 },             /* it goes on */
    };
    const double v = thrown[_i % 3].v, dt = _i < 3 ? 0.01 : 0.002;
    const slope s = { thrown[_i % 3].angle, thrown[_i % 3].phi, dt, 1e10, 13,
                      (int)(thrown[_i % 3].time / dt + 0.5), 20 };
    const double a = s.angle * RAD, g = pull(s.angle, s.phi, v > 0 ? 1 : -1);
    FILE *f = begin_slope(&s);

    fprintf(f, "velocity block %.16g %.16g\n", -v * cos(a), -v * sin(a));
    run_moving(f);
    ck_relative(slid(&s, s.steps), g * v < 0 ? -v * v / (2 * g) : v + g / 2, thrown[_i % 3].most);
}
END_TEST

/* --------------------------------------------------------------------------------------- shaken */

/* The base accelerates by A sin(w t), uphill and horizontal. The block slides when that passes a_y =
 * g tan(phi - a), at t1 = asin(a_y/A)/w; then s'' = C (A sin w t - a_y), C = cos(phi - a)/cos(phi),
 * until s' is zero again. It never slips upwards, for A < g tan(phi + a). Since t1: */
typedef struct { slope s; double A, w; } shaking;

static double yield(const shaking *k) { return G * tan((k->s.phi - k->s.angle) * RAD); }

static double share(const shaking *k)
{
    return cos((k->s.phi - k->s.angle) * RAD) / cos(k->s.phi * RAD);
}

static double speed(const shaking *k, double t1, double t)
{
    return share(k) * (k->A / k->w * (cos(k->w * t1) - cos(k->w * t)) - yield(k) * (t - t1));
}

static double way(const shaking *k, double t1, double t)
{
    const double A = k->A, w = k->w;

    return share(k) * (A / w * cos(w * t1) * (t - t1) - A / (w * w) * (sin(w * t) - sin(w * t1))
                       - yield(k) * (t - t1) * (t - t1) / 2);
}

/* The way of one slip: the speed grows until w t = pi - w t1 and vanishes before the next passing
 * of a_y. */
static double slip(const shaking *k)
{
    const double t1 = asin(yield(k) / k->A) / k->w;
    double low = acos(-1) / k->w - t1, high = 2 * acos(-1) / k->w + t1;

    for (int i = 0; i < 100; i++)
        *(speed(k, t1, (low + high) / 2) > 0 ? &low : &high) = (low + high) / 2;
    return way(k, t1, low);
}

START_TEST(a_shaken_block_slips_once_in_each_period)
{
    static const struct { double angle, phi, A, w, dt, p_n; } table[] = {
        { 10, 20, 4, 6, 0.01, 1e9 }, { 10, 20, 4, 6, 0.005, 1e9 }, { 10, 20, 4, 6, 0.01, 1e11 },
        { 10, 20, 4, 6, 0.002, 1e11 }, { 10, 20, 4, 6, 0.001, 1e11 }, { 5, 20, 4, 10, 0.002, 1e11 },
        { 20, 30, 3, 8, 0.002, 1e11 }, { 25, 30, 2, 12, 0.002, 1e11 },
    };
    const double period = 2 * acos(-1) / table[_i].w, dt = table[_i].dt;
    const shaking k = { { table[_i].angle, table[_i].phi, dt, table[_i].p_n, 5,
                          (int)(5 * period / dt + 0.5), 50 }, table[_i].A, table[_i].w };
    FILE *f = begin_slope(&k.s);

    fprintf(f, "shake %g 0 %g\n", k.A, k.w);
    run_moving(f);
    for (int slips = 1; slips <= 5; slips += 4)
        ck_relative(slid(&k.s, (int)(slips * period / dt + 0.5)), slips * slip(&k), 0.01);
}
END_TEST

/* A record with a slip to each side, rest before it and behind. */
static const double record[][3] = { { 0.05, 0, 0 }, { 0.15, 4, 1 }, { 0.35, -4, -1 }, { 0.55, 0, 0 } };

static double recorded(double t, int a)
{
    for (int k = 0; k < 3; k++)
        if (t >= record[k][0] && t < record[k + 1][0])
            return record[k][a] + (t - record[k][0]) / (record[k + 1][0] - record[k][0])
                                      * (record[k + 1][a] - record[k][a]);
    return 0;
}

/* Newmark, Geotechnique 15, 1965: it slips when |ax| > mu (g + ay), then s'' = -ax -+ mu (g + ay)
 * until s' is zero. */
static double newmark(double scale, double mu, double time)
{
    const double dt = 1e-6;
    double s = 0, v = 0;

    for (double t = dt / 2; t < time; t += dt) {
        const double a = -scale * recorded(t, 1), rub = mu * (G + scale * recorded(t, 2));
        const double sign = v > 0 || (v == 0 && a > 0) ? 1 : -1, before = v;
        if (v == 0 && fabs(a) <= rub)
            continue;
        v += (a - sign * rub) * dt;
        v = before * v < 0 ? 0 : v;
        s += v * dt;
    }
    return s;
}

START_TEST(a_block_follows_a_record_as_newmark_has_it)
{
    static const struct { double scale, dt; } table[] = { { 1, 1e-3 }, { 1, 5e-4 }, { -0.7, 5e-4 },
                                                          { 1.5, 5e-4 } };
    const double scale = table[_i].scale, dt = table[_i].dt, time = 1.2;
    const slope s = { 0, 10, dt, 1e11, 13, (int)(time / dt + 0.5), 50 };
    FILE *q = fopen("out/model/record.csv", "w"), *f = begin_slope(&s);

    fprintf(q, "# made by hand\n\"time\", ax; ay\n\n");
    for (int k = 0; k < 4; k++)
        fprintf(q, "%g%s %g;%g  # row %d\r\n", record[k][0], k % 2 ? "," : "", record[k][1],
                record[k][2], k);
    fclose(q);
    fprintf(f, "shake record.csv scale %g\n", scale);
    run_moving(f);
    ck_relative(-slid(&s, s.steps), newmark(scale, tan(10 * RAD), time), 1e-3);
}
END_TEST

/* ------------------------------------------------------------------------------ stacks, rocking */

/* Whether four blocks stand whose shifts are f times 1/8, 1/6, 1/4, 1/2 m from below. */
static int stack_stands(double f)
{
    FILE *file = fopen("out/model/moving.model", "w");
    double x = -1;

    ck_assert_ptr_nonnull(file);
    fprintf(file, "material rigid E 1e14 nu 0.25 density 2500\nmaterial rock E 1e10 nu 0.25 "
                  "density 2500\n"
                  "block table rigid -1.5 -2 0 -2 0 0 -1.5 0\nfixblock table\ngravity 0 -9.81\n"
                  "contact kn 1e9 friction 30\npcg tolerance 1e-14\ndynamic dt 0.01 steps 300 "
                  "settle 50\n"
                  "monitor foot at 0 0 of b0\nmonitor end at 9 1 of b3\n");
    for (int k = 0; k < 4; k++) {
        x += f / (2 * (4 - k));
        fprintf(file, "block b%d rock %.15g %g %.15g %g %.15g %g %.15g %g\n", k, x, k / 4.0, x + 1,
                k / 4.0, x + 1, (k + 1) / 4.0, x, (k + 1) / 4.0);
    }
    run_moving(file);
    return hypot(cell("moving", "history.csv", "300,", "end_u"),
                 cell("moving", "history.csv", "300,", "end_v"))
           < 0.01;
}

/* The upper k balance on the end of the block below if their common centre of mass is not beyond it:
 * together 25/24 m, the half of 1 + 1/2 + 1/3 + 1/4. Near the limit a fall takes long to begin. */
START_TEST(a_stack_leans_as_far_as_its_centres_of_mass_allow)
{
    static const struct { double f; int stands; } table[] = { { 0.98, 1 }, { 0.999, 1 }, { 1.001, 0 }, { 1.02, 0 } };

    ck_assert_int_eq(stack_stands(table[_i].f), table[_i].stands);
}
END_TEST

/* A block is pulled up at its foot by its weight and f times the tensile strength of its joint. At first inertia bears
 * the weight, and all of the pull acts on the joint. But the settled state decides. */
START_TEST(a_joint_that_holds_the_settled_state_does_not_break_on_the_way)
{
    const double f = _i % 2 ? 1.03 : 0.97, side = _i / 2 ? 10 : 1, strength = 2e4 * side * side;
    FILE *file = fopen("out/model/moving.model", "w");

    ck_assert_ptr_nonnull(file);
    fprintf(file, "material rock E 1e10 nu 0.25 density 2500\nblock table rock 0 -1 20 -1 20 0 0 0\n"
                  "fixblock table\nblock b0 rock 5 0 %g 0 %g %g 5 %g\ngravity 0 -9.81\n"
                  "contact friction 20\njoint b0 table cohesion 1e7 tension %g\n"
                  "load box 5 0 %g 0 of b0 0 %.15g\ndynamic dt 0.001 steps 100 settle 200\n"
                  "monitor foot at 5 0 of b0\n",
            5 + side, 5 + side, side / 2, side / 2, 2e4 * side, 5 + side,
            2500 * 9.81 * side * side / 2 + f * strength);
    run_moving(file);
    ck_assert_int_eq(cell("moving", "history.csv", "100,", "foot_v") < 1e-6 * side, f < 1);
}
END_TEST

/* A block of one cell on a base of four, pulled off in statics by f times what its joint holds. Corners of the block and a
 * grid point of the base share the joint, in steps from rest, too. In dynamics the corners alone share it. */
START_TEST(a_static_joint_has_its_area_once_on_a_finer_base)
{
    const double f[] = { 0.7, 1.03, 1.4 };

    ck_assert_int_eq(run_printed("pulled", "material a E 7e9 nu 0.25 density 2500\nmaterial b E 2e9 nu 0.25 density 2500\n"
                                 "grid G a -2 -1 2 0 4 2\ngrid B b -1 0 1 0.5 1 1 triangles\nfix set G.bottom\n"
                                 "contact friction 20 cohesion 1e5 tension 5e4\nstatic\nload set B.top 0 %.15g\n",
                                 f[_i] * 1e5), _i > 0);
}
END_TEST

/* A piston comes to a corner at the very end of a step: what rounding makes of the moment is no force that lacks balance. */
START_TEST(a_piston_that_arrives_as_a_step_ends_is_no_failure)
{
    const double E[] = { 1e9, 1e10, 1e11, 1e12 };

    ck_assert_int_eq(run_printed("arrives", "material r E %g nu 0.2 density 2500\nblock P r -2 -1 0 -1 0 1 -2 1\n"
                                 "block b r 0.05 0 0.55 -0.3 0.85 0.2 0.35 0.5\nfixblock P\nfix set P x by 0.3 y by 0\n"
                                 "dynamic dt 0.01 steps 30\n", E[_i]), 0);
}
END_TEST

/* A block whose corner stands at the seam of two bases, and moves by micrometres from one to the other in a static step in
 * which both bear it. The tables have the forces of both: together with those of a block beside it they are its weight. */
START_TEST(at_a_seam_both_contacts_of_a_corner_keep_their_forces)
{
    ck_assert_int_eq(run_text("seam", "material a E 1e9 nu 0 density 2500\nmaterial b E 5e8 nu 0 density 2500\n"
                              "grid L a -2 -1 0 0 2 1 quads\ngrid R b 0 -1 2 0 2 1 crossed\ngrid B b -1 0 0 0.5 1 1\n"
                              "grid C b -2 0 -1 1 2 1\nfix set L.bottom\nfix set R.bottom\ncontact friction 15\n"
                              "gravity 0 -9.81\nstatic\nmonitor J joint B *\n"), 0);
    ck_relative(cell("seam", "history.csv", "1,", "J_fy"), 2500 * 9.81 / 2, 1e-6);
}
END_TEST

/* A block 1 m wide, R half its diagonal, a its slope, let go at rest, turned by th0 < a about a lower
 * corner: th'' = -p^2 sin(a - th), p^2 = 3 g/(4 R). With sin((a - th)/2) = s cosh(u), s =
 * sin((a - th0)/2), the time to the first impact is, by Simpson's rule,
 *
 *     t1 = (1/p) integral du/sqrt(1 - s^2 cosh^2 u) from 0 to acosh(sin(a/2)/s). */
static double first_impact(double height, double part)
{
    enum { INTERVALS = 200 };
    const double a = atan(1 / height), s = sin(a * (1 - part) / 2),
                 du = acosh(sin(a / 2) / s) / INTERVALS;
    double sum = 0;

    for (int i = 0; i <= INTERVALS; i++) {
        const double c = s * cosh(i * du);
        sum += (i == 0 || i == INTERVALS ? 1 : i % 2 ? 4 : 2) / sqrt(1 - c * c);
    }
    return sum * du / 3 / sqrt(3 * G / (2 * hypot(1, height)));
}

/* When the other lower corner, 1 m away, is back at y = 0, between two rows of history.csv. */
static double find_impact(double start)
{
    FILE *f = fopen("out/model/moving/history.csv", "r");
    char line[LONG];
    double t = 0, y = start, u, v, found = NAN;

    ck_assert(f && fgets(line, sizeof line, f));
    while (isnan(found) && fgets(line, sizeof line, f)) {
        const double t0 = t, y0 = y;
        ck_assert_int_eq(sscanf(line, "%*d,%lf,%lf,%lf", &t, &u, &v), 3);
        y = start + v;
        if (y <= 0)
            found = t0 + (t - t0) * y0 / (y0 - y);
    }
    fclose(f);
    return found;
}

START_TEST(a_block_rocks_back_in_its_time)
{
    static const double height[] = { 2, 5, 10 }, part[] = { 0.2, 0.5, 0.8, 0.95 };
    const double h = height[_i / 4], a = atan(1 / h), th = part[_i % 4] * a,
                 t1 = first_impact(h, part[_i % 4]);

    ck_assert_int_eq(run_printed("moving",
        "material rigid E 1e14 nu 0.25 density 2500\nmaterial stiff E 1e12 nu 0 density 2500\n"
        "block base rigid -2 -0.5 3 -0.5 3 0 -2 0\nfixblock base\ngravity 0 -9.81\n"
        "contact kn 1e11 friction 60\npcg tolerance 1e-12\ndynamic dt 0.001 steps %d\n"
        "monitor corner node 7\nnode 5 0 0\nnode 7 %.16g %.16g\nnode 8 %.16g %.16g\n"
        "node 9 %.16g %.16g\nelement 1 block stiff 5 7 8 9\n", (int)(1200 * t1), cos(th), sin(th),
        cos(th) - h * sin(th), sin(th) + h * cos(th), -h * sin(th), h * cos(th)), 0);
    /* It is late by less than a step, which is 4e-3 of the shortest. */
    ck_relative(find_impact(sin(th)), t1, _i ? 1e-3 : 2e-3);
    /* Housner's acosh(1/(1 - th0/a))/p, of slender blocks: small angles, 4e-3 is the promise. */
    if (h > 4)
        ck_relative(find_impact(sin(th)),
                    acosh(1 / (1 - part[_i % 4])) / sqrt(3 * G / (2 * hypot(1, h))), 4e-3);
}
END_TEST

/* A block of 0.5 m x 2 m on a base that swings is thrown over, and stays down whatever dt; without a
 * restitution it stands up again at dt 2e-3. */
START_TEST(a_block_that_is_thrown_over_stays_down_whatever_the_step)
{
    static const double dt[] = { 4e-3, 2e-3, 1e-3, 5e-4 };

    ck_assert_int_eq(run_printed("moving",
        "material r E 1e12 nu 0 density 2000\nmaterial w E 1e13 nu 0 density 2000\n"
        "block f w -5 -1 5 -1 5 0 -5 0\nfixblock f\nblock b r -0.25 0 0.25 0 0.25 2 -0.25 2\n"
        "gravity 0 -9.81\nshake 8 0 3\ncontact kn 1e10 ks 4e9 friction 60 restitution %g\n"
        "dynamic dt %g steps %g\nmonitor m at 0.25 2 of b\n",
        _i / 4 * 0.3, dt[_i % 4], ceil(2.094 / dt[_i % 4])), 0);
    ck_near(cell("moving", "history.csv", "", "m_v"), -1.5, 1.5, 1e-3);     /* it lies: 0.5 m high */
    if (_i == 0)                                            /* hits are counted with restitution alone */
        ck_assert_int_eq(shell("cd out/model; sed 's/restitution 0//' moving.model > free.model; "
                               "B=$OLDPWD/%s/bbm; $B moving.model | grep -q '^of what hits came with' && "
                               "! $B free.model | grep '^hits'", BUILD), 0);
    if (_i == 4)                                                        /* 0.3^2 */
        ck_assert_int_eq(shell("%s/bbm out/model/moving.model -o out/model/moving | grep -q 'given back, 9 %% asked for$'", BUILD), 0);
}
END_TEST

/* The block turns by 0.01 rad: its upper right corner goes back, the lower one does not. */
START_TEST(a_monitor_is_at_the_nearest_node_whatever_lies_far_away)
{
    ck_assert_int_eq(run_text("near", "material r E 1e9 nu 0.25 density 2500\ncontact friction 0\n"
                              "block b r 0 0 0.5 0 0.5 0.1 0 0.1\nblock f r 2e5 0 2e5 1 1e5 1\n"
                              "velocity b 0 0 1\ndynamic dt 0.01 steps 1\nmonitor tip at 0.5 0.1\n"), 0);
    ck_assert_double_lt(cell("near", "history.csv", "", "tip_u"), -1e-4);
}
END_TEST

/* Angular momentum about the origin and twice the energy of motion of two blocks of 100 kg, 0.2 m square. */
static void spin_of(const char *name, double *momentum, double *energy)
{
    *momentum = *energy = 0;
    for (int k = 1; k <= 2; k++) {
        const char row[] = { (char)('0' + k), ',', 0 };
        const double x = cell(name, "elements.csv", row, "x") + cell(name, "elements.csv", row, "u");
        const double y = cell(name, "elements.csv", row, "y") + cell(name, "elements.csv", row, "v");
        const double vx = cell(name, "elements.csv", row, "vx"), vy = cell(name, "elements.csv", row, "vy");
        const double spin = cell(name, "elements.csv", row, "spin"), inertia = 100 * 0.08 / 12;
        *momentum += 100 * (x * vy - y * vx) + inertia * spin;
        *energy += 100 * (vx * vx + vy * vy) + inertia * spin * spin;
    }
}

/* Two blocks of 100 kg turn about each other at 1 rad/s: their bolt carries m w^2 r = 110 N, a hundredth of
 * a turn per step makes 1e-4 of it. Their strain by their own spin is 5e-10 of the energy. */
START_TEST(a_bolt_that_turns_keeps_angular_momentum_and_energy)
{
    const double L = 2 * 100 * (1.1 * 1.1 + 0.08 / 12);
    double momentum, energy;

    ck_assert_int_eq(run_printed("spun",
        "material r E 1e11 nu 0 density 2500\nblock a r -1.2 -0.1 -1 -0.1 -1 0.1 -1.2 0.1\n"
        "block b r 1 -0.1 1.2 -0.1 1.2 0.1 1 0.1\nvelocity a 0 -1.1 1\nvelocity b 0 1.1 1\n"
        "bolt at -1 0 of a at 1 0 of b stiffness %g pretension 110\ncontact friction 0\n"
        "dynamic dt 0.01 steps 200\n", _i ? 1e6 : 1e8), 0);
    ck_relative(cell("spun", "bolts.csv", "1,", "force"), 110, 1e-4);
    spin_of("spun", &momentum, &energy);
    ck_relative(momentum, L, 1e-10);
    ck_relative(energy, L, 1e-8);
    ck_assert(strstr(slurp("out/model/spun.err"), "off their law") == NULL);
}
END_TEST

#define BLOCK_SHAKEN "material rock E 1e10 nu 0.25 density 2500\nblock b rock 0 0 1 0 1 1 0 1\nshake pulse.csv\ndynamic dt "

/* A record of rows far apart, but for a pulse that steps of 0.01 s hardly see. */
START_TEST(a_pulse_that_is_shorter_than_a_step_is_told)
{
    write_text("out/model/pulse.csv", "0 0\n0.5 0\n0.505 10\n0.51 0\n2 0\n");
    ck_assert_int_eq(run_text("pulse", _i ? BLOCK_SHAKEN "0.01 steps 200\n" : BLOCK_SHAKEN "0.005 steps 400\n"), 0);
    ck_assert_int_eq(strstr(slurp("out/model/pulse.err"), "do not feel all of it") != NULL, _i);
}
END_TEST

/* A block swings on a stiff bolt of 2 m from 30 degrees, T = 2 pi sqrt(L/g)/agm(1, cos 15): after 2 1/4
 * periods it hangs straight down. Steps of T/400 change T by (w dt)^2/24 = 1e-5, and it by 1.4e-4 rad. */
START_TEST(a_pendulum_on_a_bolt_keeps_its_period)
{
    double a = 1, b = cos(15 * RAD);

    for (int k = 0; k < 6; k++) {
        const double mean = (a + b) / 2;
        b = sqrt(a * b);
        a = mean;
    }
    ck_assert_int_eq(run_printed("swings",
        "let x $(2*sin(30))\nlet y $(-2*cos(30))\nmaterial r E 1e11 nu 0 density 2500\n"
        "block roof r -1 0 1 0 1 1 -1 1\nfixblock roof\n"
        "block b r $(x-0.1) $(y-0.1) $(x+0.1) $(y-0.1) $(x+0.1) $(y+0.1) $(x-0.1) $(y+0.1)\n"
        "bolt at 0 0 of roof at $x $y of b stiffness %g\ngravity 0 -9.81\ncontact friction 0\n"
        "dynamic dt %.16g steps 900\nmonitor m at $(x-0.1) $(y-0.1) of b\n",
        1e9, 2 * acos(-1) * sqrt(2 / G) / a / 400), 0);
    ck_near(cell("swings", "history.csv", "", "m_u"), -1, 2, 2e-4);
    ck_assert(cell("swings", "summary.csv", "", "gained") <= 1e-9 * 981);
}
END_TEST

/* Many bricks hit together. Stiff springs find no states of their contacts at once, but those that soft ones have found
 * fit. No energy is made, and hits and friction take some. Far away a stone lands in each of ten steps, and leaves with E
 * of its velocity whatever the wall does: within half a step of gravity, and the thousandth of the jump. */
START_TEST(a_wall_that_a_stone_hits_goes_on_with_a_restitution)
{
    static const struct { const char *stone; double u, v, friction, restitution; } hit[] = {
        { "1.5078 1.9 5.9268 1.9 5 2.4 3 2.4", 1.374, -4, 38.619, 0.3 },
        { "-2 0.9245 -1 0.7490 -1 1.4 -2 1.4", 8, 0, 25.197, 0.6 },
    };
    FILE *f = fopen("out/model/moving.model", "w");

    fprintf(f, "material r E 1e9 nu 0.25 density 2500\nblock base r -5 -1 10 -1 10 0 -5 0\nfixblock base\n");
    for (int b = 0; b < 20; b++) {
        const double x = b % 5 + b / 5 % 2 * 0.5, y = b / 5 * 0.4;
        fprintf(f, "block w%d r %g %g %g %g %g %g %g %g\n", b, x, y, x + 1, y, x + 1, y + 0.4, x, y + 0.4);
    }
    for (int k = 0; k < 10; k++) {
        const double time = 0.002 * (k + 60 - 0.5), x = 100 + 5 * k, y = 0.5 * time + 9.81 / 2 * time * time;
        fprintf(f, "block f%d r %g -1 %g -1 %g 0 %g 0\nfixblock f%d\nvelocity s%d 0 -0.5\n", k, x, x + 2, x + 2, x, k, k);
        fprintf(f, "block s%d r %g %.9g %g %.9g %g %.9g %g %.9g\n", k, x, y, x + 1, y, x + 1, y + 1, x, y + 1);
    }
    fprintf(f, "block st r %s\nvelocity st %g %g\ngravity 0 -9.81\n"
            "contact kn 1e8 friction %g restitution %g\ndynamic dt 0.002 steps 85\n",
            hit[_i].stone, hit[_i].u, hit[_i].v, hit[_i].friction, hit[_i].restitution);
    run_moving(f);
    for (int k = 0; k < 10; k++) {
        const double time = 0.002 * (k + 60 - 0.5), E = hit[_i].restitution;
        char row[20];
        snprintf(row, sizeof row, "%d,s%d,", 23 + 2 * k, k);
        ck_near(cell("moving", "elements.csv", row, "vy"), E * (0.5 + 9.81 * time) - 9.81 * (0.17 - time), 1, 0.001 * 9.81 + 0.002);
    }
    const double first = cell("moving", "summary.csv", "1,", "kinetic");
    ck_assert_double_le(cell("moving", "summary.csv", "85,", "gained"), 1e-6 * first);
    ck_assert_double_lt(cell("moving", "summary.csv", "85,", "kinetic"), first);
}
END_TEST

Suite *moving_suite(void)
{
    Suite *s = suite_create("moving");
    TCase *t = new_case(s, "moving");

    tcase_add_loop_test(t, a_block_that_is_thrown_stops_where_it_should, 0, 6);
    tcase_add_loop_test(t, a_shaken_block_slips_once_in_each_period, 0, 8);
    tcase_add_loop_test(t, a_block_follows_a_record_as_newmark_has_it, 0, 4);
    tcase_add_loop_test(t, a_stack_leans_as_far_as_its_centres_of_mass_allow, 0, 4);
    tcase_add_loop_test(t, a_static_joint_has_its_area_once_on_a_finer_base, 0, 3);
    tcase_add_loop_test(t, a_piston_that_arrives_as_a_step_ends_is_no_failure, 0, 4);
    tcase_add_test(t, at_a_seam_both_contacts_of_a_corner_keep_their_forces);
    tcase_add_loop_test(t, a_joint_that_holds_the_settled_state_does_not_break_on_the_way, 0, 4);
    tcase_add_loop_test(t, a_block_rocks_back_in_its_time, 0, 12);
    tcase_add_loop_test(t, a_block_that_is_thrown_over_stays_down_whatever_the_step, 0, 8);
    tcase_add_loop_test(t, a_bolt_that_turns_keeps_angular_momentum_and_energy, 0, 2);
    tcase_add_test(t, a_pendulum_on_a_bolt_keeps_its_period);
    tcase_add_loop_test(t, a_wall_that_a_stone_hits_goes_on_with_a_restitution, 0, 2);
    tcase_add_loop_test(t, a_pulse_that_is_shorter_than_a_step_is_told, 0, 2);
    tcase_add_test(t, a_monitor_is_at_the_nearest_node_whatever_lies_far_away);
    return s;
}
