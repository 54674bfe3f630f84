/* check_statics.c - statics tells the truth: at 99 % of a limit load it stands, at 101 % it falls,
 * whatever the units, the direction and the weight of the base, and what falls is named; forces are
 * judged body by body; what fails leaves the model as it was.
 *
 * The limits are those of rigid blocks, by hand. Springs give way by 1e-5 of a block at most and
 * change them by no more. */
#include <string.h>

#include "models.h"

static bbm_model *new_scene(double friction)
{
    bbm_model *m = new_blocks();

    m->par.dt = INFINITY;
    set_springs(m, 1e10, 4e9);
    m->par.friction = friction;
    m->par.pcg.iterations = 100000;
    add_table(m, 0);
    return m;
}

/* Two piers and a lintel, pushed at its top. They turn about their right feet and lift the lintel
 * on their left corners: H 2 r = W_lintel r/2 + 2 W_pier r/4. */
static bbm_model *portal(double f)
{
    bbm_model *m = new_scene(35);

    add_rectangle(m, 1, ROCK, (rectangle){ .x = 0, .y = 0, .w = 0.5, .h = 2 });
    add_rectangle(m, 2, ROCK, (rectangle){ .x = 2.5, .y = 0, .w = 0.5, .h = 2 });
    add_rectangle(m, 3, ROCK, (rectangle){ .x = 0, .y = 2, .w = 3, .h = 0.4 });
    ck_ok(bbm_add_load(m, m->nodes - 2, f * DENSITY * GRAVITY * (1.2 / 4 + 1.0 / 4), 0), m);
    return m;
}

/* A block of 1 x 2 or 2 x 1, on ground that is tilted: it tips at width over height, or slides. */
static bbm_model *tilted(double f, double w, double h)
{
    bbm_model *m = new_scene(35);

    add_rectangle(m, 1, ROCK, (rectangle){ .x = 0, .y = 0, .w = w, .h = h });
    m->par.gravity[0] = f * GRAVITY * fmin(w / h, tan(radians(35)));
    return m;
}

static bbm_model *tall(double f) { return tilted(f, 1, 2); }
static bbm_model *flat(double f) { return tilted(f, 2, 1); }

/* A semicircular arch of 13 voussoirs with the mean radius 1: t = 0.1028 is the least thickness in
 * whose joints a line of thrust fits (cases/arch.c). */
static bbm_model *arch(double f)
{
    enum { N = 13 };
    bbm_model *m = new_scene(35);

    for (int k = 0; k < N; k++) {
        const double a = k * PI / N, b = a + PI / N, i = 1 - 0.0514 / f, o = 1 + 0.0514 / f;
        const double p[][2] = { { i * cos(a), i * sin(a) }, { o * cos(a), o * sin(a) },
                                { o * cos(b), o * sin(b) }, { i * cos(b), i * sin(b) } };
        add_polygon(m, 1 + k, 4, p);
    }
    return m;
}

/* A wedge pushed under a block that leans on a wall without friction: a = atan(0.2), and H = W
 * tan(a + phi) + (W + W_wedge) tan(phi). */
static bbm_model *wedge(double f)
{
    bbm_model *m = new_scene(20);
    const double phi = radians(20), W = 1.275, H = W * tan(atan(0.2) + phi) + (W + 1.5) * tan(phi);

    add_polygon(m, 1, 4, (const double[][2]){ { 0, 0 }, { 3, 0 }, { 3, 0.2 }, { 0, 0.8 } });
    add_polygon(m, 2, 4, (const double[][2]){ { 1, 0.6 }, { 2.5, 0.3 }, { 2.5, 1.3 }, { 1, 1.3 } });
    add_rectangle(m, 3, BASE, (rectangle){ .x = 2.5, .y = 0.5, .w = 1, .h = 1, .fixed = 1 });
    ck_ok(bbm_add_load(m, 4, f * DENSITY * GRAVITY * H, 0), m);
    ck_assert_int_eq(bbm_add_joint(m, (int[]){ 2, 3 }, 0, 0, 0), BBM_OK);
    return m;
}

/* An elastic bar, pressed on the ground by its weight and pulled at its end: each element begins to
 * slide when those before it do. */
static bbm_model *bar(double f)
{
    bbm_model *m = new_scene(30);

    add_rectangle(m, 1, ROCK, (rectangle){ .x = -4, .y = 0, .w = 8, .h = 0.2, .nx = 40 });
    for (int k = 0; k < 2; k++)
        ck_ok(bbm_add_load(m, 44 + 41 * k, f * DENSITY * GRAVITY * 0.8 * tan(radians(30)), 0), m);
    return m;
}

/* A stone that slides towards a stop, three of its sizes away: farther than statics looks. */
static bbm_model *stop(double f)
{
    bbm_model *m = flat(f);

    add_rectangle(m, 2, BASE, (rectangle){ .x = 6, .y = 0, .w = 1, .h = 1, .fixed = 1 });
    return m;
}

/* A wedge that a jaw presses on a wall by H, drawn out by H (tan(phi) + tan(phi - a)). Contacts are so stiff that the jaw is
 * long in coming, and the wedge has gone before if steps from rest are short. */
static bbm_model *pulled(double f)
{
    const double a = radians(20), s = tan(a), H = 1e4, phi = radians(38);
    const double wedge[][2] = { { -0.2, 1 }, { 0.2, 1 }, { 0.2 + s, 2 }, { -0.2, 2 } };
    const double jaw[][2] = { { 0.2 - s / 2, 0.5 }, { 2.2, 0.5 }, { 2.2, 2.5 }, { 0.2 + 1.5 * s, 2.5 } };
    bbm_model *m = new_scene(38);

    set_springs(m, 3e12, 1.2e12);
    m->par.gravity[1] = 0;
    add_rectangle(m, 1, BASE, (rectangle){ .x = -2.2, .y = 0.5, .w = 2, .h = 2, .fixed = 1 });
    add_polygon(m, 2, 4, wedge);
    add_polygon(m, 3, 4, jaw);
    for (int n = m->nodes - 8; n < m->nodes; n++) {
        const int of_jaw = n >= m->nodes - 4;
        ck_ok(bbm_add_load(m, n, -of_jaw * H / 4, !of_jaw * f * H * (tan(phi) + tan(phi - a)) / 4), m);
        ck_ok(of_jaw ? bbm_fix_node(m, n, BBM_Y, 0, 0) : BBM_OK, m);
    }
    return m;
}

/* The same, with friction in the two joints alone. */
static bbm_model *jointed(double f)
{
    bbm_model *m = pulled(f);

    m->par.friction = 0;
    for (int b = 1; b <= 2; b++)
        ck_assert_int_eq(bbm_add_joint(m, (int[]){ b, b + 1 }, 38, 0, 0), BBM_OK);
    return m;
}

static const struct { bbm_model *(*build)(double f); const char *how; } LIMIT[] = {
    { portal, "lifts off" }, { tall, "lifts off" }, { flat, "slides on" }, { arch, "lifts off" },
    { wedge, "slides on" }, { bar, "slides on" }, { stop, "slides on" }, { pulled, "slides on" },
    { jointed, "slides on" },
};

START_TEST(a_scene_stands_to_99_percent_of_its_limit_and_falls_at_101)
{
    const int falls = _i % 2;
    bbm_model *m = LIMIT[_i / 2].build(falls ? 1.01 : 0.99);

    m->beyond->reach = 1;                           /* of a program; statics itself takes less */
    ck_ok(bbm_prepare(m), m);
    const bbm_status status = bbm_step(m);
    ck_assert(m->beyond->reach == 1);
    ck_assert_msg(status == (falls ? BBM_NO_EQUILIBRIUM : BBM_OK), "%s", bbm_message(m));
    ck_assert_msg(!falls || strstr(bbm_message(m), LIMIT[_i / 2].how), "%s", bbm_message(m));
    if (!falls)
        ck_ok(bbm_step(m), m);
    ck_assert(falls || m->info.change < 1e-3);      /* the second step of Newton: turns of 1e-5 */
}
END_TEST

/* ------------------------------------------------------------------- in any unit, on any base */

typedef struct { double size, length, force; } measures;   /* m; units in a metre, in a newton */

static const measures MEASURES[] = {
    { 1, 1, 1 }, { 0.01, 1, 1 }, { 100, 1, 1 }, { 1, 1e3, 1 }, { 0.01, 1e3, 1 }, { 100, 1e3, 1 },
    { 1, 1e2, 1e-3 }, { 0.01, 1e2, 1e-3 }, { 100, 1e2, 1e-3 },
};

/* Gives a scene that is 1 m large other measures, a base of `heavy` times its density, the settings
 * of ./bbm, and the angle a to which it is turned. g: along the base and to it. */
static void measure_scene(bbm_model *m, measures u, double heavy, double a, const double g[2])
{
    const double l = u.length, E = 1e10 * u.force / (l * l), density = 2500 * u.force / pow(l, 4);

    for (int k = 0; k < 2; k++) {
        m->material[k] = (bbm_material){ E, 0.2, k == BASE ? heavy * density : density, l };
        m->par.gravity[k] = l * (k ? sin(a) * g[0] + cos(a) * g[1] : cos(a) * g[0] - sin(a) * g[1]);
    }
    set_springs(m, 50 * E * l, 20 * E * l);
    m->par.alpha = 100;
    m->par.pcg.iterations = 100000;
    m->beyond->multiplier_rounds = 2;
}

/* One to four stones of one width on each other, at any angle, at f times their limit. The base is
 * tilted (i even), or their top is pushed: a joint slides at tan(phi) of the weight W above it, and
 * what is above it, of height h and width w, tips at W w/h of a tilt or W w/2h of a push. */
static bbm_model *turned_pile(int i, double f, measures u, double heavy)
{
    unsigned seed = (unsigned)i + 1;
    const double a = PI * random_number(&seed), w = 0.9 + 0.6 * random_number(&seed);
    const int stones = 1 + i / 2 % 4, push = i % 2;
    const double phi = 22.5 + 17.5 * random_number(&seed), t = tan(radians(phi));
    const double l = u.size * u.length;
    double h[4], top = 0, bottom = 0, limit = INFINITY;
    bbm_model *m = new_blocks();

    m->par.dt = INFINITY;
    m->par.friction = phi;
    for (int k = 0; k < stones; k++)
        top += h[k] = 0.7 + 0.5 * random_number(&seed);
    double above = top;
    for (int k = 0; k < stones; above -= h[k++])
        limit = fmin(limit, push ? fmin(t * above, w / 2) : fmin(t, w / above));
    const double tilt = push ? 0 : atan(f * limit);
    measure_scene(m, u, heavy, a, (double[]){ GRAVITY * sin(tilt), -GRAVITY * cos(tilt) });
    add_rectangle(m, 0, BASE, (rectangle){ .x = -3 * l, .y = -l, .w = 7 * l, .h = l,
                                           .angle = a * 180 / PI, .fixed = 1 });
    for (int k = 0; k < stones; k++, bottom += h[k - 1])
        add_rectangle(m, k + 1, ROCK, (rectangle){ .y = l * bottom, .w = l * w, .h = l * h[k],
                                                   .angle = a * 180 / PI });
    const double H = push * f * limit * w * 2500 * GRAVITY * u.size * u.size * u.force;
    ck_ok(bbm_add_load(m, m->nodes - 1, H * cos(a), H * sin(a)), m);
    return m;
}

/* Whether it stands after so many steps; that it falls is said. */
static int stands(bbm_model *m, int steps)
{
    bbm_status status = bbm_prepare(m);

    while (!status && steps-- > 0)
        status = bbm_step(m);
    ck_assert_msg(!status || status == BBM_NO_EQUILIBRIUM, "%s", bbm_message(m));
    return !status;
}

START_TEST(a_pile_stands_to_97_percent_of_its_limit_and_falls_at_105_turned_and_in_other_units)
{
    for (int i = 0; i < 16; i++) {
        bbm_model *m = turned_pile(i, _i % 2 ? 1.05 : 0.97, MEASURES[_i / 2], 1);
        ck_assert_msg(stands(m, 3) == !(_i % 2), "pile %d: %s", i, bbm_message(m));
        release(m);
    }
}
END_TEST

/* A fixed base carries itself, and has no part in the forces: to 1e-6 of the weight of each stone,
 * as exact as a step from rest may end. */
START_TEST(what_a_base_weighs_changes_no_limit_and_no_force)
{
    const double heavy[] = { 1e-6, 1e-3, 1e3, 1e6 };

    for (int i = 0; i < 8; i++) {
        bbm_model *m = turned_pile(i, _i % 2 ? 1.05 : 0.9, MEASURES[_i / 2 % 3], 1);
        bbm_model *n = turned_pile(i, _i % 2 ? 1.05 : 0.9, MEASURES[_i / 2 % 3], heavy[_i / 6]);
        ck_assert(stands(m, 1) == !(_i % 2) && stands(n, 1) == !(_i % 2));
        for (int b = 1; b < m->elements && _i % 2 == 0; b++) {
            const double W = m->element[b].A0 * 2500 * GRAVITY;
            ck_near(normal_force(n, b, b - 1), normal_force(m, b, b - 1), W, 1e-6);
        }
        release(m);
        release(n);
    }
}
END_TEST

/* A corner of two small stones between three large held blocks, pushed by 0.97 of what they hold,
 * friction 15.3 degrees. Static steps alone do not find where it stands. */
static bbm_model *corner(double heavy)
{
    const double p[][4][2] = {
        { { 8.440325, 0.872304 }, { -0.996219, 8.541026 }, { -4.780229, 3.884711 },
          { 4.656314, -3.784011 } },
        { { 4.656314, -3.784011 }, { 0, 0 }, { -0.075821, -0.093299 }, { 4.580494, -3.877310 } },
        { { -0.123915, 0.100701 }, { -4.780229, 3.884711 }, { -4.856050, 3.791412 },
          { -0.199735, 0.007402 } },
        { { 0, 0 }, { -0.123915, 0.100701 }, { -0.139631, 0.081362 }, { -0.109098, -0.134248 } },
        { { -0.139631, 0.081362 }, { -0.240614, -0.042900 }, { -0.116699, -0.143601 },
          { -0.109098, -0.134248 } },
    };
    bbm_model *m = new_blocks();

    m->par.dt = INFINITY;
    m->par.friction = 15.305207864701828;
    measure_scene(m, MEASURES[0], heavy, 0, (double[]){ 6.1868572950054537, 7.6130740710463209 });
    m->material[BASE].E *= 100;
    for (int b = 0; b < 5; b++) {
        add_polygon(m, b, 4, p[b]);
        m->element[b].material = m->material[b < 3 ? BASE : ROCK];
        for (int k = 0; k < 4 && b < 3; k++)
            ck_ok(bbm_fix_node(m, m->vertex[4 * b + k].node, BBM_XY, 0, 0), m);
    }
    ck_ok(bbm_add_load(m, m->vertex[18].node, -192.45181041218706, -166.52717269216538), m);
    return m;
}

/* Steps from rest end where friction holds, which depends on their way: the inertia of what is held
 * has no part in it. The last digit of the weight of a block, of 4e12 N, is 4e-4 N; contacts carry
 * up to 300 N. */
START_TEST(what_is_held_has_no_inertia_in_steps_from_rest)
{
    bbm_model *m = corner(1), *n = corner((double[]){ 1e-6, 1e-3, 1e3, 1e6 }[_i]);

    ck_assert(stands(m, 1) && stands(n, 1));
    for (int b = 3; b < 5; b++)
        for (int a = 0; a < b; a++)
            ck_near(normal_force(n, a, b), normal_force(m, a, b), 4e-4, 1);
    release(m);
    release(n);
}
END_TEST

/* A ladder from (1, 0) on the ground to (0, y) at the wall, its weight at x. At the limit N mu is
 * the friction on the ground and the pressure on the wall: mu^2 x + mu y = 1 - x. */
START_TEST(a_ladder_on_a_base_of_any_weight_needs_the_friction_of_the_closed_form)
{
    const double p[][2] = { { 1, 0 }, { 1.06, 0 }, { 0, 1.8 }, { 0, 1.7 } };
    const double outer = 1.06 * 1.8 / 2, inner = 1.7 / 2, y = 1.8;
    const double x = (outer * 1.06 - inner) / 3 / (outer - inner);
    const double mu = (sqrt(y * y + 4 * x * (1 - x)) - y) / (2 * x);
    const int falls = _i % 2;
    bbm_model *m = new_blocks();

    m->par.dt = INFINITY;
    m->par.friction = atan((falls ? 0.999 : 1.001) * mu) * 180 / PI;
    measure_scene(m, MEASURES[0], pow(10, 6 * (_i / 2) - 6), 0, (double[]){ 0, -GRAVITY });
    add_rectangle(m, 0, BASE, (rectangle){ .x = -30, .y = -1, .w = 60, .h = 1, .fixed = 1 });
    add_rectangle(m, 1, BASE, (rectangle){ .x = -1, .y = 0, .w = 1, .h = 5, .fixed = 1 });
    add_polygon(m, 2, 4, p);
    ck_assert_int_eq(stands(m, 1), !falls);
}
END_TEST

/* Presses a block of nx by ny elements of ROCK, 2 w wide and w high, down by P. Its lower side has the radius R and touches
 * y = 0; its top is held along x. The first node of that side is returned, the others follow. */
static int press_round_side(bbm_model *m, double w, double R, int nx, int ny, double P)
{
    const int first = m->nodes;

    for (int j = 0; j <= ny; j++)
        for (int i = 0; i <= nx; i++) {
            const double x = w * (2.0 * i / nx - 1), t = (double)j / ny;
            ck_ok(bbm_add_node(m, x, w * t + (1 - t) * x * x / (2 * R), NULL), m);
        }
    for (int k = 0; k < nx * ny; k++) {
        const int n = first + k % nx + k / nx * (nx + 1);
        ck_ok(bbm_add_element(m, 1, ROCK, 4, (int[]){ n, n + 1, n + nx + 2, n + nx + 1 }, NULL), m);
    }
    for (int i = 0; i <= nx; i++) {
        ck_ok(bbm_fix_node(m, m->nodes - 1 - i, BBM_X, 0, 0), m);
        ck_ok(bbm_add_load(m, m->nodes - 1 - i, 0, -P / (nx + 1)), m);
    }
    return first;
}

static bbm_model *new_pressed(double E, double nu, double friction, int steps)
{
    bbm_model *m = new_blocks();

    m->beyond->bonding = BBM_MOMENT;
    m->beyond->multiplier_rounds = 2;
    m->par.dt = INFINITY;
    m->par.steps = steps;
    m->par.pcg.tolerance = 1e-10;
    m->par.gravity[1] = 0;
    m->par.friction = friction;
    m->material[ROCK].E = E;
    m->material[ROCK].nu = nu;
    set_springs(m, 50 * E, 20 * E);
    return m;
}

/* A block of 2 m x 1 m with a round lower side, R = 10 m, is pressed on a base until a half of it would touch by Hertz. In one
 * static step no corner of the round side ends deeper in the base than twice the deepest that is closed: what has come in
 * bears, though it was far at the start and its sides pointed the other way. */
START_TEST(a_round_side_that_flattens_bears_at_all_its_corners)
{
    const int columns[] = { 4, 8, 12, 16 }, nx = columns[_i % 4];
    bbm_model *m = new_pressed(1e9, 0, _i < 12 ? 0 : 30, 1);

    add_rectangle(m, 0, ROCK, (rectangle){ .x = -1.5, .y = -1, .w = 3, .h = 1, .fixed = 1 });
    const int first = press_round_side(m, 1, 10, nx, _i / 4 % 3 + 1, PI * 0.25 * 1e9 / 40);
    ck_ok(bbm_prepare(m), m);
    ck_ok(bbm_step(m), m);
    for (int i = 0; i <= nx; i++) {
        const bbm_result P = result_at(m, first + i);
        ck_assert_double_gt(m->node[first + i].y + P.v, -2 * m->info.penetration - 1e-6);
    }
}
END_TEST

/* How deep a node lies behind the present lines between the nodes from `first` to `last`, from left to right. */
static double depth_behind(const bbm_model *m, int node, int first, int last)
{
    double at[3][2], depth = 0;

    for (int n = first; n < last; n++) {
        for (int k = 0; k < 3; k++) {
            const int i = k == 2 ? node : n + k;
            const bbm_result r = result_at(m, i);
            at[k][0] = m->node[i].x + r.u;
            at[k][1] = m->node[i].y + r.v;
        }
        const double s = (at[2][0] - at[0][0]) / (at[1][0] - at[0][0]);
        if (s >= 0 && s <= 1)
            depth = at[0][1] + s * (at[1][1] - at[0][1]) - at[2][1];
    }
    return depth;
}

/* The same where the base is of elements as large, its grid points below those of the block or half a cell off: its side bends,
 * and its points enter the block between those of the block. In one step or in more nothing that has come in is lost. */
START_TEST(a_round_side_bears_at_all_its_corners_on_a_base_that_bends)
{
    static const struct { int nx, ny, half, steps; double w, a; } of[] = {
        { 8, 1, 1, 1, 0.05, 0.03 }, { 8, 1, 1, 4, 0.05, 0.03 }, { 12, 2, 0, 8, 0.1, 0.0383 }, { 10, 2, 0, 8, 0.1, 0.051 },
        { 12, 2, 0, 8, 0.1, 0.043 }, { 16, 1, 1, 8, 0.1, 0.03 }, { 4, 2, 1, 1, 0.8, 0.4 },
    };
    const int row = _i % COUNT(of), nx = of[row].nx, ny = of[row].ny, cells = nx + of[row].half;
    const double w = of[row].w, wide = w * cells / nx, a = of[row].a;
    bbm_model *m = new_pressed(1e10, 0.2, 30, of[row].steps);

    add_rectangle(m, 0, ROCK, (rectangle){ .x = -wide, .y = -w, .w = 2 * wide, .h = w, .nx = cells, .ny = ny });
    for (int n = 0; n <= cells; n++)
        ck_ok(bbm_fix_node(m, n, BBM_XY, 0, 0), m);
    const int top = ny * (cells + 1), first = press_round_side(m, w, 1, nx, ny, PI * a * a * 0.5e10 / 4);
    ck_ok(bbm_prepare(m), m);
    if (_i != row)                              /* contacts so stiff that bonds open farther than a search goes */
        set_springs(m, 5e12, 2e12);
    ck_ok(bbm_run(m), m);
    for (int i = 0; i <= nx; i++)
        ck_assert_double_lt(depth_behind(m, first + i, top, top + cells), 2 * m->info.penetration);
}
END_TEST

/* A block stands on two flush blocks, a corner of its foot at or near their seam, and gravity leans towards the other one: it
 * slides at the friction of a base of one piece, for the side of the neighbour is covered. The two are fixed (0), or free on a
 * base, stiff (1), or so soft that the foot sinks by a tenth of the rounding below the neighbour's edge (2), or turned (3). */
START_TEST(a_seam_below_a_foot_holds_no_block_that_slides)
{
    const double off[] = { 0, 1e-9, 1e-6, 1e-3 }, part[] = { 0.97, 1.03, 1.5 };

    for (int k = 0; k < 2 * COUNT(off) * COUNT(part); k++) {
        const double friction = k % 2 ? 20 : 5, x = off[k / 2 % COUNT(off)];
        const int above = k / 2 / COUNT(off);
        const double tilt = part[above] * tan(radians(friction));
        bbm_model *m = new_blocks();
        m->material[BASE].E = 1e11;
        m->material[ROCK].E = _i == 2 ? 1e8 : 1e11;
        m->par.dt = INFINITY;
        m->par.steps = 1;
        m->par.friction = friction;
        const double turn = _i == 3 ? 0.7 * 180 / PI : 0, c = cos(radians(turn)), q = sin(radians(turn));
        m->par.gravity[0] = GRAVITY * (q - c * tilt);
        m->par.gravity[1] = -GRAVITY * (c + q * tilt);
        set_springs(m, 50 * m->material[ROCK].E, 20 * m->material[ROCK].E);
        add_rectangle(m, 0, BASE, (rectangle){ .angle = turn, .x = -5, .y = -3, .w = 8, .h = 1, .fixed = 1 });
        add_rectangle(m, 1, BASE, (rectangle){ .angle = turn, .x = -5, .y = -2, .w = 1, .h = 2, .fixed = 1 });
        add_rectangle(m, 2, ROCK, (rectangle){ .angle = turn, .x = -4, .y = -2, .w = 4, .h = 2, .fixed = _i == 0 });
        add_rectangle(m, 3, ROCK, (rectangle){ .angle = turn, .y = -2, .w = 2, .h = 2, .fixed = _i == 0 });
        add_rectangle(m, 4, ROCK, (rectangle){ .angle = turn, .x = x, .w = 1, .h = 1 });
        ck_ok(bbm_prepare(m), m);
        ck_assert_int_eq(bbm_step(m), above ? BBM_NO_EQUILIBRIUM : BBM_OK);
        release(m);
    }
}
END_TEST

/* Four bricks in two columns, gravity leans, and the upper right one is pushed to the left, so that its lower corner sinks below
 * the foot of its neighbour: it has left that edge for the one of the brick below. Its force acts where it did in the solution. */
START_TEST(a_contact_that_leaves_its_edge_in_a_static_step_has_its_force_there)
{
    bbm_model *m = new_blocks();

    m->material[ROCK].E = m->material[BASE].E = 1e10;
    m->par.dt = INFINITY;
    m->par.steps = 1;
    m->par.friction = 30;
    m->par.gravity[0] = -1.6117;
    set_springs(m, 5e11, 2e11);
    add_rectangle(m, 0, BASE, (rectangle){ .x = -4, .y = -1, .w = 10, .h = 1, .fixed = 1 });
    for (int k = 0; k < 4; k++)
        add_rectangle(m, 1 + k, ROCK, (rectangle){ .x = k % 2, .y = k / 2, .w = 1, .h = 1 });
    ck_ok(bbm_add_load(m, m->nodes - 2, -2e4, 0), m);
    ck_ok(bbm_prepare(m), m);
    for (int step = 0; step < 2; step++) {
        ck_ok(bbm_step(m), m);
        for (const bbm_contact *c = m->contact; c < m->contact + m->contacts; c++)
            if (c->state != BBM_OPEN)       /* digits of a position of 2 m */
                ck_near(c->N, m->par.p_n * (c->rest - c->d_n), 1, m->par.p_n * 1e-15);
    }
    release(m);
}
END_TEST

/* Contacts that stay locked have after five static steps the shear forces of the first one: where a corner stands on a grid
 * point inside the side of a mesh (0), and where the corners of two flush blocks pass each other as one bulges more (1). */
START_TEST(locked_contacts_keep_their_shear_forces_from_step_to_step)
{
    const double on_grid_point[4][2] = { { 0, 0 }, { 2, 0 }, { 2, 4 }, { 1, 4 } };
    const double on_square[4][2] = { { 0, 0 }, { 2, 0 }, { 4, 4 }, { 0, 4 } };
    const double stiffness = (_i ? 1 : 50) * 1e10;
    grid g = { .x = -12 * !_i, .y = _i ? -2 : -4, .lx = _i ? 2 : 24, .ly = _i ? 2 : 4, .nx = _i ? 1 : 2, .ny = 1,
               .triangles = !_i };
    bbm_model *m = new_blocks();
    double T[2][2] = { { 0 } };

    m->material[_i ? BASE : ROCK] = (bbm_material){ 1e10, 0.45, 2500, 1 };
    m->material[_i ? ROCK : BASE] = (bbm_material){ 1e10, 0.2, 2500, 1 };
    m->par.dt = INFINITY;
    m->par.friction = 80;
    set_springs(m, stiffness, 0.4 * stiffness);
    add_grid(m, &g, 0);
    for (int i = 0; i <= g.nx && _i == 0; i++)
        ck_ok(bbm_fix_node(m, node_at(&g, i, 0), BBM_XY, 0, 0), m);
    add_rectangle(m, 1, ROCK, (rectangle){ .x = -5, .y = -6, .w = 10, .h = 2 + 2 * _i, .fixed = 1 });
    add_polygon(m, 2, 4, _i ? on_square : on_grid_point);
    ck_ok(bbm_add_load(m, m->nodes - 2, -2e4 * !_i, -2e4 * !_i), m);
    ck_ok(bbm_prepare(m), m);
    for (int step = 0; step < 5; step++) {
        ck_ok(bbm_step(m), m);
        for (const bbm_contact *c = m->contact; c < m->contact + m->contacts; c++) {
            const double x = m->vertex[m->edge[c->corner].a].x, y = m->vertex[m->edge[c->corner].a].y;
            if (c->state == BBM_LOCK && fabs(y) < 0.1)
                T[step > 0][x > 1] = c->T;
        }
    }
    ck_assert(fabs(T[0][0]) > 1e4);
    for (int k = 0; k < 2; k++)             /* the first step has the geometry of the start: strains of 1e-5, sides of 4 m */
        ck_relative(T[1][k], T[0][k], 1e-3);
    release(m);
}
END_TEST

/* Two blocks that stand, the upper one of two elements, are pushed to and fro in long steps that keep no velocity. Nothing
 * slides, and each spring counts from the face all the time. */
START_TEST(what_stands_in_long_steps_keeps_its_springs)
{
    bbm_model *m = new_blocks();

    m->par.dt = _i ? 10 : 0.3;
    m->par.velocity_factor = 0;
    m->par.friction = 60;
    set_springs(m, 1e9, 4e8);
    add_rectangle(m, 0, ROCK, (rectangle){ .x = -1, .y = -.5, .w = 9, .h = .5, .fixed = 1 });
    add_rectangle(m, 1, ROCK, (rectangle){ .w = 1, .h = .5 });
    add_rectangle(m, 2, ROCK, (rectangle){ .y = .5, .w = 1, .h = .5, .nx = 2, .ny = 1 });
    for (int k = 0; k < 3; k++) {
        m->par.gravity[0] = (k == 1 ? 0.06 : k == 2 ? -0.06 : 0) * GRAVITY;
        run_steps(m, 3);
    }
    ck_assert_int_eq(m->info.contacts, 5);
    for (const bbm_contact *c = m->contact; c < m->contact + m->contacts; c++)
        if (c->state != BBM_OPEN)
            ck_near(c->N, -m->par.p_n * c->d_n, c->N, 1e-6);    /* the digits of a length of 9 m */
    release(m);
}
END_TEST

/* A block that is pressed on a mesh, its corners on grid points or beside them by 1e-4 of its side, rests on three springs
 * and goes down as far, in the first static step as in those after it. */
START_TEST(a_corner_on_a_grid_point_is_one_contact_in_each_step)
{
    const double beside[] = { 0, 1e-4, -1e-4 };
    double v[COUNT(beside)][2];

    for (int k = 0; k < COUNT(beside); k++) {
        grid g = { .y = -1, .lx = 3, .ly = 1, .nx = 6, .ny = 2 };
        bbm_model *m = new_blocks();
        m->material[BASE] = m->material[ROCK];
        m->par.dt = INFINITY;
        m->par.friction = 30;
        set_springs(m, 1e9, 4e8);
        add_grid(m, &g, 0);
        for (int i = 0; i <= g.nx; i++)
            ck_ok(bbm_fix_node(m, node_at(&g, i, 0), BBM_XY, 0, 0), m);
        add_rectangle(m, 1, ROCK, (rectangle){ .x = 1 + beside[k], .w = 1, .h = .5 });
        for (int top = 1; top <= 2; top++)
            ck_ok(bbm_add_load(m, m->nodes - top, 0, -5e5), m);
        for (int step = 0; step < 2; step++) {
            run_steps(m, 1);
            ck_assert_int_eq(m->info.contacts, 3);
            v[k][step] = result_at(m, m->nodes - 1).v;
        }
        release(m);
    }
    for (int k = 0; k < 2 * COUNT(beside); k++)         /* the geometry of the second step: strains of 3e-4 */
        ck_relative(v[k / 2][k % 2], v[0][0], 1e-3);
}
END_TEST

/* Four bars lie round a core like a pinwheel, on a base, with friction of 40 degrees. They stand to a tilt of 0.75 by limit
 * analysis, and so they do in slow dynamics. */
START_TEST(a_pinwheel_of_bars_stands_at_any_tilt_below_its_limit)
{
    static const rectangle bar[] = { { .x = 0, .y = 0, .w = 2, .h = 1 }, { .x = 2, .y = 0, .w = 1, .h = 2 },
                                     { .x = 1, .y = 2, .w = 2, .h = 1 }, { .x = 0, .y = 1, .w = 1, .h = 2 },
                                     { .x = 1, .y = 1, .w = 1, .h = 1 } };
    bbm_model *m = new_blocks();

    m->material[ROCK].E = 1e11;
    m->par.dt = INFINITY;
    m->par.steps = 1;
    m->par.friction = 40;
    m->par.gravity[0] = -GRAVITY * (0.44 + 0.02 * _i);
    set_springs(m, 5e12, 2e12);
    for (int k = 0; k < COUNT(bar); k++)
        add_rectangle(m, k, ROCK, bar[k]);
    add_rectangle(m, COUNT(bar), BASE, (rectangle){ .x = -3, .y = -1, .w = 9, .h = 1, .fixed = 1 });
    ck_ok(bbm_prepare(m), m);
    ck_ok(bbm_step(m), m);
    for (int v = 0; v < m->vertices; v++)
        ck_assert_double_lt(hypot(m->vertex[v].u, m->vertex[v].v), 1e-5);       /* of its elastic way */
}
END_TEST

/* A stone on a fixed base is shaken, in dynamics. A base of any weight stays where it is; its supports bear that. */
START_TEST(what_a_fixed_block_weighs_moves_nothing)
{
    const double heavy[] = { 1, 1e3, 1e9 };
    double v[3] = { 0 };

    for (int k = 0; k < 3; k++) {
        bbm_model *m = new_blocks();
        m->par.dt = 1e-3;
        m->par.friction = 10;
        measure_scene(m, MEASURES[0], heavy[k], 0, (double[]){ 0, -GRAVITY });
        m->beyond->shake[0] = 3;
        m->beyond->shake_omega = 20;
        add_rectangle(m, 0, BASE, (rectangle){ .x = -300, .y = -200, .w = 601, .h = 200, .fixed = 1 });
        const int e = add_rectangle(m, 1, ROCK, (rectangle){ .w = 1, .h = 1 });
        run_steps(m, 60);
        double borne = 0;
        for (int n = 0; n < 4; n++)
            borne += m->beyond->support[n].force[1];
        ck_relative(borne, 601.0 * 200 * 2500 * GRAVITY * heavy[k], 2e-5);  /* a stone is 1e-5 of it */
        ck_near(m->vertex[0].v, 0, 1, 1e-6);
        v[k] = m->element[e].V[0];
        ck_near(v[k], v[0], 0.1, 1e-4);      /* a light base gives way under the stone */
        release(m);
    }
    ck_assert_double_gt(fabs(v[0]), 0.01);
}
END_TEST

/* A stone far from the ends of its slope of 30 degrees, where the digits of a position make up to 1
 * % of its weight; and far from the origin. Friction of 0.02 degrees is 8e-4 of its weight. */
START_TEST(a_small_stone_slides_below_the_slope_anywhere_on_a_base_of_any_weight)
{
    const double size[] = { 0.1, 0.01 }, at[] = { 0, 12, 1000 }, slope = radians(30);
    const double x = at[_i / 2 % 3], s = size[_i / 6 % 2];
    const int falls = _i % 2;
    bbm_model *m = new_blocks();

    m->par.dt = INFINITY;
    m->par.friction = falls ? 29.98 : 30.02;
    measure_scene(m, MEASURES[0], _i / 12 ? 1e6 : 1, 0.3,
                  (double[]){ GRAVITY * sin(slope), -GRAVITY * cos(slope) });
    add_rectangle(m, 0, BASE, (rectangle){ .x = x - 12, .y = -2, .w = 18, .h = 2, .fixed = 1,
                                           .angle = 0.3 * 180 / PI });
    add_rectangle(m, 1, ROCK, (rectangle){ .x = x, .w = s, .h = s, .angle = 0.3 * 180 / PI });
    ck_assert_msg(stands(m, 1) == !falls, "%s", bbm_message(m));
}
END_TEST

/* Adds to the equations of the first element a part of its weight, or of that times its side, as a
 * force down to the right or a moment that no load, contact or support has. */
typedef struct { int row; double part; } push;

static int push_from_nowhere(const bbm_model *m, void *context)
{
    const push *p = context;
    const double weight = bbm_mass_per_area(&m->element[0]) * m->element[0].A0
                        * hypot(m->acceleration[0], m->acceleration[1]);

    if (p->row == 2)
        m->F[2] += p->part * weight * sqrt(m->element[0].A0);
    else {
        m->F[0] += p->part * weight * sqrt(0.5);
        m->F[1] -= p->part * weight * sqrt(0.5);
    }
    return 0;
}

/* Two stones, of which one weighs 1e9 times as much, are held in statics, and fall in dynamics. The
 * weight of each counts twice, with what bears or slows it: a share of 2.5e-7 or 4e-6 is left, in
 * dynamics ten times as much. */
START_TEST(forces_and_moments_on_each_body_are_judged_against_its_own)
{
    const int refused = _i % 2, row = 1 + _i / 2 % 2, falls = _i / 4 % 2;
    const measures u = MEASURES[_i / 8];
    const double l = u.size * u.length;
    push p = { row, (refused ? 8e-6 : 5e-7) * (falls ? 10 : 1) };
    bbm_model *m = new_blocks();

    m->par.dt = falls ? 0.01 : INFINITY;
    measure_scene(m, u, 1e9, 1, (double[]){ 0, -GRAVITY });
    add_rectangle(m, 0, ROCK, (rectangle){ .w = l, .h = l, .angle = 30, .fixed = !falls });
    add_rectangle(m, 1, BASE, (rectangle){ .x = 9 * l, .w = l, .h = l, .fixed = !falls });
    ck_ok(bbm_prepare(m), m);
    m->monitor = push_from_nowhere;
    m->monitor_context = &p;
    ck_assert_int_eq(bbm_step(m), refused ? BBM_NOT_CONVERGED : BBM_OK);
    ck_assert(!refused || strstr(bbm_message(m), "block 0 lack"));
}
END_TEST

/* In place of moving the model: a contact of the stone is to hold `force` more than its law lets
 * it, by a cone that is too narrow or a spring that is too short, or a corner of another block is
 * inside though open. What is said of the first solution. */
typedef struct { int law; double force; int broken; bbm_status said; } breach;

static bbm_status break_law(bbm_model *m)
{
    breach *b = m->monitor_context;

    for (int k = 0; k < m->scratch->contacts && !b->broken; k++) {
        bbm_contact *c = &m->scratch->contact[k];
        if (corner_block(m, c) != (b->law == 2 ? 2 : 1))
            continue;
        ck_assert_int_eq(c->state, b->law == 2 ? BBM_OPEN : BBM_LOCK);
        if (b->law == 0)
            c->strength.tan_phi = (fabs(c->T) - b->force) / c->N;
        else if (b->law == 1)
            c->rest += b->force / m->par.p_n;
        else
            c->d_n = -b->force / m->par.p_n;
        b->broken = 1;
        b->said = bbm_check_equilibrium(m);
    }
    return BBM_STOPPED;
}

/* A stone on a slope, beside a block that hangs so close above it that it touches. The weight of
 * each counts twice, with what bears it, in dynamics up to four times, with what slows it: a share
 * of 2.5e-7 or 4e-6 is broken, or half of it. In dynamics it is noted. */
START_TEST(what_contacts_have_against_their_laws_is_refused_in_statics_and_noted_in_dynamics)
{
    const int refused = _i % 2, law = _i / 2 % 3, moves = _i / 6;
    bbm_model *m = new_blocks();
    breach b = { .law = law };

    m->par.dt = moves ? 0.01 : INFINITY;
    m->par.friction = 60;
    measure_scene(m, MEASURES[0], 1, 0, (double[]){ GRAVITY * 0.5, -GRAVITY });
    set_springs(m, 1e10, 4e9);              /* the last digit of a metre is 1e-10 of the weight */
    const int base = add_rectangle(m, 0, BASE, (rectangle){ .x = -3, .y = -1, .w = 7, .h = 1 });
    for (int v = 0; v < 3; v++)             /* two that are held all round would not touch */
        bbm_fix_node(m, vertex_of(m, base, v)->node, BBM_XY, 0, 0);
    add_rectangle(m, 1, ROCK, (rectangle){ .w = 1, .h = 1 });
    add_rectangle(m, 2, ROCK, (rectangle){ .x = 2, .y = 1e-12, .w = 1, .h = 1, .fixed = 1 });
    const double W = 2500 * hypot(0.5, 1) * GRAVITY;
    b.force = (refused ? 8e-6 : 5e-7) * W;
    ck_ok(bbm_prepare(m), m);
    m->monitor_context = &b;
    m->hook->move = break_law;
    ck_assert_int_eq(bbm_step(m), BBM_STOPPED);
    ck_assert(b.broken);
    ck_assert_int_eq(b.said, refused && !moves ? BBM_NOT_CONVERGED : BBM_OK);
    ck_near(m->beyond->breach, moves * 0.375 * b.force / W, b.force / W, 0.13);
}
END_TEST

/* In place of moving the model: spoils a contact of the solution, deep and with three times its force. */
typedef struct { bbm_status (*move)(bbm_model *m), said; } spoiler;

static bbm_status spoil(bbm_model *m)
{
    spoiler *s = m->monitor_context;
    bbm_contact *c = m->scratch->contact;

    ck_assert(c->state == BBM_LOCK);
    c->N *= 3;
    c->d_n = -0.5;
    s->said = s->move(m);
    return BBM_STOPPED;
}

/* A solution that is none is told as such, and a step is tried again, before its contacts are called too soft. */
START_TEST(a_solution_that_does_not_balance_is_no_fault_of_soft_contacts)
{
    bbm_model *m = new_blocks();
    spoiler s = { m->hook->move, BBM_OK };

    m->par.dt = _i ? 0.01 : INFINITY;
    m->par.friction = 60;
    add_rectangle(m, 0, BASE, (rectangle){ .x = -3, .y = -1, .w = 7, .h = 1, .fixed = 1 });
    add_rectangle(m, 1, ROCK, (rectangle){ .w = 1, .h = 1 });
    ck_ok(bbm_prepare(m), m);
    m->monitor_context = &s;
    m->hook->move = spoil;
    ck_assert_int_eq(bbm_step(m), BBM_STOPPED);
    ck_assert_int_eq(s.said, BBM_NOT_CONVERGED);
}
END_TEST

/* Behind the library's own gaps a bolt of 2 m between two squares, tight, that pulls along itself
 * or across. */
static void list_bolt(bbm_model *m, int across)
{
    const bbm_vertex P = { .x = m->element[0].x, .y = m->element[0].y };
    const bbm_vertex Q = { .x = m->element[1].x, .y = m->element[1].y };

    bbm_list_edge_gaps(m);
    bbm_gap *g = bbm_add_gap(m, 0, 1);
    bbm_bonding_gap(&m->element[0], &P, &m->element[1], &Q, 0, g);
    g->elastic = 1;
    g->W[across][across] = 1e3;
    g->d0[across] = 1;
    g->d0[!across] = 0;
}

static void list_straight_bolt(bbm_model *m) { list_bolt(m, 0); }
static void list_crooked_bolt(bbm_model *m) { list_bolt(m, 1); }

static bbm_status judge_alone(bbm_model *m)
{
    ck_assert_int_eq(bbm_check_equilibrium(m), BBM_OK);
    return BBM_STOPPED;
}

/* Across, 1e3 N make a couple of 2e3 N m from nothing, on squares of 1 m: 2e3 N beside the force
 * itself and what slows each square. */
START_TEST(a_bolt_that_makes_angular_momentum_is_told)
{
    bbm_model *m = weightless_blocks();

    m->hook->list_gaps = _i ? list_crooked_bolt : list_straight_bolt;
    add_rectangle(m, 0, ROCK, (rectangle){ .w = 1, .h = 1 });
    add_rectangle(m, 1, ROCK, (rectangle){ .x = 2, .w = 1, .h = 1 });
    ck_ok(bbm_prepare(m), m);
    m->hook->move = judge_alone;
    ck_assert_int_eq(bbm_step(m), BBM_STOPPED);
    ck_near(m->beyond->breach, _i * 0.5, 1, _i ? 0.01 : SOLVED);
}
END_TEST

/* Portals that stand, of which one is pushed over in between, or has no work left for an answer. */
START_TEST(a_static_step_that_fails_leaves_the_model_as_it_was)
{
    bbm_model *m = portal(0.6), *n = portal(0.6);
    double *load = m->node[m->nodes - 2].load;

    run_steps(m, 1);
    run_steps(n, 1);
    for (int i = 0; i < m->elements; i++)           /* what a step computes from positions */
        bbm_element_geometry(&m->element[i], &m->vertex[m->element[i].first]);
    bbm_element e[4];
    bbm_vertex v[16];
    const size_t bytes = (size_t)m->contacts * sizeof(bbm_contact);
    bbm_contact *c = malloc(bytes);
    memcpy(e, m->element, sizeof e);
    memcpy(v, m->vertex, sizeof v);
    memcpy(c, m->contact, bytes);
    *load *= 2;
    m->par.pcg.iterations = _i ? 5 : 10000;
    ck_assert_int_eq(bbm_step(m), _i ? BBM_OPEN_CLOSE : BBM_NO_EQUILIBRIUM);
    ck_assert_msg(!_i || strstr(bbm_message(m), "was found; try dynamics"), "%s", bbm_message(m));
    ck_assert_ptr_null(strstr(bbm_message(m), "dt"));
    ck_assert_int_eq(memcmp(e, m->element, sizeof e), 0);
    ck_assert_int_eq(memcmp(v, m->vertex, sizeof v), 0);
    ck_assert(m->contacts == n->contacts && memcmp(c, m->contact, bytes) == 0);
    *load /= 2;
    m->par.pcg.iterations = 10000;
    run_steps(m, 1);
    run_steps(n, 1);
    ck_assert(same_state(m, n));
    free(c);
}
END_TEST

/* Blocks that slide would part, which is refused: the forces of the supports stay those of the last step that was done,
 * not of a solution that was refused. */
START_TEST(a_solution_that_is_refused_leaves_no_reactions)
{
    bbm_model *m = new_blocks();
    double was[4];

    m->par.friction = 10;
    add_rectangle(m, 0, ROCK, (rectangle){ .x = -10, .y = -1, .w = 20, .h = 1, .fixed = 1 });
    const int e = add_rectangle(m, 1, ROCK, (rectangle){ .w = 1, .h = 1 });
    prepare(m);
    run_steps(m, 3);
    for (int n = 0; n < 4; n++)
        was[n] = m->beyond->support[n].force[0];
    m->node[vertex_of(m, e, 1)->node].load[0] = 1e5;
    m->beyond->reach = 0;
    ck_assert_int_eq(bbm_step(m), BBM_STEP_TOO_LONG);
    for (int n = 0; n < 4; n++)
        ck_assert(m->beyond->support[n].force[0] == was[n]);
}
END_TEST

/* Three by four bricks at six tilts, 31 to 54 degrees. Sooner or later friction would wedge
 * one in. */
START_TEST(a_contact_that_no_friction_holds_opens)
{
    bbm_model *m = new_scene(50);

    m->material[ROCK] = (bbm_material){ 1e11, 0.2, 2000, 1 };
    for (int row = 0, b = 1; row < 4; row++)
        for (int k = 0; k < 3 + row % 2; k++, b++) {
            const double left = 0.4 * k - row % 2 * 0.2, x = fmax(0, left);
            const double end = fmin(1.2, left + 0.4);
            const rectangle brick = { .x = x, .y = 0.2 * row, .w = end - x, .h = 0.2 };
            add_rectangle(m, b, ROCK, brick);
        }
    m->par.dt = 0.01;
    set_springs(m, 5e12, 2e12);
    m->par.gravity[0] = -6 - 3 * _i;
    run_steps(m, 2);
}
END_TEST

/* A strip of 10 m x 0.05 m, taut with 1 or 10 MPa between two clamps, sags under its weight q by
 *     q L^2/(8 N) - q L tanh(k L/4)/(2 N k),    k = sqrt(N/(E I)),
 * a string less its clamps, and its tension stays. 32 elements sag 4 % more; without the stiffness of
 * the tension they sag ten times as far, and no tension is left. */
START_TEST(what_is_taut_sags_as_its_tension_says_and_stays_taut)
{
    const double stress = _i % 2 ? 1e6 : 1e7, L = 10, h = 0.05, E = 1e10, q = 1000 * 9.81 * h;
    const double N = stress * h, k = sqrt(12 * N / (E * h * h * h));
    grid g = { .lx = L, .ly = h, .nx = 32, .ny = 1, .angle = _i / 2 };
    bbm_model *m = new_model(&(bbm_material){ E, 0, 1000, 1 });

    m->beyond->bonding = BBM_MOMENT;
    m->beyond->multiplier_rounds = 2;
    m->par.gravity[0] = 9.81 * sin(g.angle);
    m->par.gravity[1] = -9.81 * cos(g.angle);
    add_grid(m, &g, 0);
    for (int j = 0; j < 4; j++)
        bbm_fix_node(m, node_at(&g, j % 2 * g.nx, j / 2), BBM_XY, 0, 0);
    prepare(m);
    for (int e = 0; e < m->elements; e++) {
        const double c = cos(g.angle), s = sin(g.angle), along[3] = { c * c, s * s, s * c };
        for (int a = 0; a < 3; a++)
            m->element[e].stress[a] = stress * along[a];
    }
    run_steps(m, 30);
    const bbm_result middle = result_at(m, node_at(&g, g.nx / 2, 0));
    ck_relative(hypot(middle.u, middle.v), q * L * L / (8 * N) - q * L * tanh(k * L / 4) / (2 * N * k), 0.05);
    ck_relative(m->element[g.nx / 2].stress[0] + m->element[g.nx / 2].stress[1], stress, 0.05);
    release(m);
}
END_TEST

Suite *statics_suite(void)
{
    Suite *s = suite_create("statics");

    add_case(s, "statics",
        { a_scene_stands_to_99_percent_of_its_limit_and_falls_at_101, 2 * COUNT(LIMIT) },
        { what_is_taut_sags_as_its_tension_says_and_stays_taut, 4 },
        { a_round_side_that_flattens_bears_at_all_its_corners, 24 },
        { a_round_side_bears_at_all_its_corners_on_a_base_that_bends, 14 },
        { a_seam_below_a_foot_holds_no_block_that_slides, 4 },
        { a_contact_that_leaves_its_edge_in_a_static_step_has_its_force_there, 1 },
        { locked_contacts_keep_their_shear_forces_from_step_to_step, 2 },
        { what_stands_in_long_steps_keeps_its_springs, 2 },
        { a_corner_on_a_grid_point_is_one_contact_in_each_step, 1 },
        { a_pinwheel_of_bars_stands_at_any_tilt_below_its_limit, 10 },
        { a_static_step_that_fails_leaves_the_model_as_it_was, 2 },
        { a_solution_that_is_refused_leaves_no_reactions, 1 });
    add_case(s, "measures",
        { a_pile_stands_to_97_percent_of_its_limit_and_falls_at_105_turned_and_in_other_units,
          2 * COUNT(MEASURES) },
        { what_a_fixed_block_weighs_moves_nothing, 1 },
        { what_a_base_weighs_changes_no_limit_and_no_force, 24 },
        { a_ladder_on_a_base_of_any_weight_needs_the_friction_of_the_closed_form, 6 },
        { what_is_held_has_no_inertia_in_steps_from_rest, 4 },
        { a_small_stone_slides_below_the_slope_anywhere_on_a_base_of_any_weight, 24 },
        { forces_and_moments_on_each_body_are_judged_against_its_own, 8 * COUNT(MEASURES) },
        { what_contacts_have_against_their_laws_is_refused_in_statics_and_noted_in_dynamics, 12 },
        { a_solution_that_does_not_balance_is_no_fault_of_soft_contacts, 2 },
        { a_bolt_that_makes_angular_momentum_is_told, 2 });
    tcase_add_loop_test(new_case(s, "wedged"), a_contact_that_no_friction_holds_opens, 0, 3);
    return s;
}
