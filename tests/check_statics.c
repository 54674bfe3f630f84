/* check_statics.c - statics tells the truth: at 99 % of a limit load it stands, at 101 % it falls,
 * and what falls is named; what fails leaves the model as it was.
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

static const struct { bbm_model *(*build)(double f); const char *how; } LIMIT[] = {
    { portal, "lifts off" }, { tall, "lifts off" }, { flat, "slides on" }, { arch, "lifts off" },
    { wedge, "slides on" }, { bar, "slides on" }, { stop, "slides on" },
};

START_TEST(a_scene_stands_to_99_percent_of_its_limit_and_falls_at_101)
{
    const int falls = _i % 2;
    bbm_model *m = LIMIT[_i / 2].build(falls ? 1.01 : 0.99);

    ck_ok(bbm_prepare(m), m);
    const bbm_status status = bbm_step(m);
    ck_assert_msg(status == (falls ? BBM_NO_EQUILIBRIUM : BBM_OK), "%s", bbm_message(m));
    ck_assert_msg(!falls || strstr(bbm_message(m), LIMIT[_i / 2].how), "%s", bbm_message(m));
    if (!falls)
        ck_ok(bbm_step(m), m);
    ck_assert(falls || m->info.change < 1e-3);      /* the second step of Newton: turns of 1e-5 */
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
    m->par.gravity[0] = -6 - 1.5 * _i;
    run_steps(m, 2);
}
END_TEST

Suite *statics_suite(void)
{
    Suite *s = suite_create("statics");

    add_case(s, "statics",
        { a_scene_stands_to_99_percent_of_its_limit_and_falls_at_101, 2 * COUNT(LIMIT) },
        { a_static_step_that_fails_leaves_the_model_as_it_was, 2 });
    tcase_add_loop_test(new_case(s, "wedged"), a_contact_that_no_friction_holds_opens, 0, 6);
    return s;
}
