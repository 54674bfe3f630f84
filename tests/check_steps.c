/* check_steps.c - steps of bodies: motion against closed forms, statics on the moved geometry, when
 * a run ends. */
#include <string.h>

#include "check.h"
#include "models.h"

/* ------------------------------------------------------------------------------------- dynamics */

/* Two bonded elements (triangles or quadrilaterals) off the origin, free, with time steps of 0.01
 * s. */
static bbm_model *flyer(int triangles)
{
    grid g = { .x = 3, .y = -2, .lx = 2, .ly = 1.5, .nx = triangles ? 1 : 2, .ny = 1,
               .triangles = triangles };
    bbm_model *m = new_model(&SOLID);

    add_grid(m, &g, 0);
    ck_ok(bbm_prepare(m), m);
    m->par.dt = 0.01;
    m->par.steps = 100;
    m->par.velocity_factor = 1;
    return m;
}

/* Newmark with the acceleration of the step's end is exact when that is constant. */
START_TEST(a_thrown_body_follows_the_parabola)
{
    bbm_model *m = flyer(_i);
    const double v[2] = { 2, 3 }, g[2] = { 0.5, -9.81 };

    for (int e = 0; e < m->elements; e++)
        memcpy(m->element[e].V, v, sizeof v);
    memcpy(m->par.gravity, g, sizeof g);
    ck_ok(bbm_run(m), m);
    ck_assert_int_eq(m->info.step, 100);
    ck_relative(m->info.t, 1, ROUNDING);
    for (int n = 0; n < m->nodes; n++) {
        ck_near(result_at(m, n).u, v[0] + g[0] / 2, 1, ROUNDING);
        ck_near(result_at(m, n).v, v[1] + g[1] / 2, 1, ROUNDING);
    }
    for (int e = 0; e < m->elements; e++) {
        const bbm_element *b = &m->element[e];
        ck_near(b->V[0], v[0] + g[0], 10, ROUNDING);
        ck_near(b->V[1], v[1] + g[1], 10, ROUNDING);
        ck_near(b->sum[0], v[0] + g[0] / 2, 10, ROUNDING);
        ck_near(b->sum[1], v[1] + g[1] / 2, 10, ROUNDING);
        for (int a = 0; a < 3; a++)
            ck_near(b->stress[a], 0, SOLID.E, ROUNDING);
    }
}
END_TEST

/* In a frame that moves with its base a body feels the base's acceleration the other way round;
 * taken in the middle of the step, t = 0.005 and 0.015 s, where sin(omega t) is 1 and -1. */
START_TEST(the_acceleration_of_the_base_acts_like_gravity_the_other_way)
{
    bbm_model *m = flyer(_i);
    const double a[2] = { 3, -2 }, g[2] = { 0.5, -9.81 };

    memcpy(m->par.gravity, g, sizeof g);
    memcpy(m->beyond->shake, a, sizeof a);
    m->beyond->shake_omega = acos(-1) / 0.01;
    for (int step = 1; step <= 2; step++) {
        ck_ok(bbm_step(m), m);
        for (int e = 0; e < m->elements; e++)
            for (int r = 0; r < 2; r++)
                ck_near(m->element[e].V[r], (step * g[r] - (step == 1) * a[r]) * 0.01, 0.1, ROUNDING);
    }
}
END_TEST

START_TEST(a_spinning_element_keeps_its_angular_velocity_and_its_mass)
{
    bbm_model *m = unit_square(&SOLID);

    m->beyond->rotation = _i == 0 ? BBM_LINEAR : BBM_EXACT;
    ck_ok(bbm_prepare(m), m);
    m->par.dt = 0.01;
    m->par.steps = 50;
    m->par.velocity_factor = 1;
    m->element[0].V[2] = 3;
    ck_ok(bbm_run(m), m);
    for (int a = 0; a < 6; a++)
        ck_near(m->element[0].V[a], a == 2 ? 3 : 0, 3, ROUNDING);
    /* as I + r dt J turns, it grows; the exact rotation keeps the area */
    ck_relative(m->element[0].A, _i == 0 ? pow(1 + 0.03 * 0.03, 49) : 1, ROUNDING);
    ck_relative(m->element[0].A0, 1, ROUNDING);
}
END_TEST

/* Too heavy to be strained in the step, it turns by 0.7 rad and takes its stress along: R s R^T. */
START_TEST(stress_turns_with_the_element)
{
    const bbm_material heavy = { .E = 1, .nu = 0.3, .density = 1e15, .thickness = 1 };
    const double s[3] = { 3, -1, 2 }, c = cos(0.7), n = sin(0.7), R[2][2] = { { c, -n }, { n, c } };
    const double before[2][2] = { { s[0], s[2] }, { s[2], s[1] } };
    bbm_model *m = unit_square(&heavy);
    double after[2][2] = { { 0 } };

    ck_ok(bbm_prepare(m), m);
    m->beyond->rotation = _i == 0 ? BBM_LINEAR : BBM_EXACT;
    m->par.dt = 0.5;
    m->element[0].V[2] = 0.7 / 0.5;
    memcpy(m->element[0].stress, s, sizeof s);
    ck_ok(bbm_step(m), m);
    for (int a = 0; a < 16; a++)
        after[a / 8][a / 4 % 2] += R[a / 8][a / 2 % 2] * before[a / 2 % 2][a % 2] *
                                       R[a / 4 % 2][a % 2];
    ck_near(m->element[0].stress[0], _i == 0 ? s[0] : after[0][0], 1, ROUNDING);
    ck_near(m->element[0].stress[1], _i == 0 ? s[1] : after[1][1], 1, ROUNDING);
    ck_near(m->element[0].stress[2], _i == 0 ? s[2] : after[0][1], 1, ROUNDING);
}
END_TEST

/* Bonds pull at both sides alike, and the mass does not follow the area. */
START_TEST(bonded_elements_keep_their_momentum_while_they_shake_each_other)
{
    bbm_model *m = flyer(_i);
    unsigned seed = 21;
    double before[2] = { 0 }, after[2] = { 0 };

    for (int e = 0; e < m->elements; e++)
        for (int a = 0; a < 6; a++)
            m->element[e].V[a] = random_number(&seed);
    for (int e = 0; e < m->elements; e++)
        for (int r = 0; r < 2; r++)
            before[r] += m->element[e].A0 * m->element[e].V[r];
    ck_ok(bbm_run(m), m);
    for (int e = 0; e < m->elements; e++)
        for (int r = 0; r < 2; r++)
            after[r] += m->element[e].A0 * m->element[e].V[r];
    for (int r = 0; r < 2; r++)
        ck_near(after[r], before[r], 1, SOLVED);                           /* 100 solves */
    ck_assert(fabs(m->element[0].V[0] - m->element[1].V[0]) > 1e-6);
}
END_TEST

/* A square of nu = 0 that breathes in x alone: mass M Sxx = density t/12, stiffness t E, so W^2 =
 * 12 E dt^2/density. One step takes (q, dt V), q the strain so far, to (2 q + 2 dt V, (2 - W^2) dt
 * V - 2 W^2 q)/(2 + W^2): the amplitude falls by the root of the determinant, (1 + W^2/2)^(-1/2),
 * the phase advances by the angle whose cosine is half the trace over that. The shape changes by
 * 1e-8: tolerance 1e-6. */
START_TEST(a_vibrating_element_is_damped_as_newmarks_recurrence_says)
{
    const double W2 = 0.5, q0 = 1e-8, p0 = 0.5e-8;
    const double decay = 1 / sqrt(1 + W2 / 2), angle = acos((4 - W2) / (2 + W2) / 2 / decay);
    const double q1 = (2 * q0 + 2 * p0) / (2 + W2);
    const double sine = (q1 / decay - q0 * cos(angle)) / sin(angle);
    bbm_model *m = unit_square(&CORK);

    ck_ok(bbm_prepare(m), m);
    m->par.dt = sqrt(W2 * CORK.density / (12 * CORK.E));
    m->par.velocity_factor = 1;
    m->element[0].stress[0] = CORK.E * q0;
    m->element[0].V[3] = p0 / m->par.dt;
    for (int n = 1; n <= 40; n++) {
        ck_ok(bbm_step(m), m);
        const double q = pow(decay, n) * (q0 * cos(n * angle) + sine * sin(n * angle));
        ck_near(m->element[0].stress[0] / CORK.E, q, q0, 1e-6);
    }
}
END_TEST

/* Velocities set to zero after each step, the inertia of 2/dt^2 only slows the way to the same end.
 * The share of the error that a step leaves is below 1/(1 + (w dt)^2/2), w the lowest frequency;
 * the load moves the shape by 1e-9. */
START_TEST(steps_without_memory_of_velocity_end_in_the_static_answer)
{
    grid g = { .lx = 3, .ly = 1, .nx = 3, .ny = 1, .triangles = 1 };
    bbm_model *m = cantilever(&SOLID, &g, 1e-8, -1e-8), *n = cantilever(&SOLID, &g, 1e-8, -1e-8);

    n->par.dt = 2;
    n->par.steps = 60;
    ck_ok(bbm_step(m), m);
    ck_ok(bbm_run(n), n);
    const double size = result_at(m, node_at(&g, 3, 1)).v, stress = result_at(m, 0).mises;
    for (int i = 0; i < m->nodes; i++) {
        ck_near(result_at(n, i).u, result_at(m, i).u, size, 1e-7);
        ck_near(result_at(n, i).v, result_at(m, i).v, size, 1e-7);
        ck_near(result_at(n, i).mises, result_at(m, i).mises, stress, 1e-7);
    }
}
END_TEST

/* -------------------------------------------------------------------------------------- statics */

/* Resultant of all that pulls at the body where it is now: loads, weight, and the springs of the
 * fixed points. The moment is about the origin. Bonds and stresses are in balance by themselves. */
static void out_of_balance(const bbm_model *m, double f[3])
{
    for (int v = 0; v < m->vertices; v++) {
        const bbm_vertex *p = &m->vertex[v];
        const bbm_node *n = &m->node[p->node];
        const bbm_material *s = &m->element[p->element].material;
        const double k = m->par.alpha * s->E / 2 / (1 + s->nu) * s->thickness;
        const int meeting = m->adjacent_first[p->node + 1] - m->adjacent_first[p->node];
        const double fx = n->load[0] / meeting + (n->held & BBM_X ? k * (n->wall[0] - p->u) : 0);
        const double fy = n->load[1] / meeting + (n->held & BBM_Y ? k * (n->wall[1] - p->v) : 0);
        f[0] += fx;
        f[1] += fy;
        f[2] += p->x * fy - p->y * fx;
    }
    for (int i = 0; i < m->elements; i++) {
        const bbm_element *e = &m->element[i];
        const double weight = e->material.density * e->material.thickness * e->A0;
        f[0] += weight * m->par.gravity[0];
        f[1] += weight * m->par.gravity[1];
        f[2] += weight * (e->x * m->par.gravity[1] - e->y * m->par.gravity[0]);
    }
}

/* A cantilever that bends by a quarter of its length: forces and moments balance on the bent
 * shape. */
START_TEST(statics_ends_in_balance_on_the_moved_geometry)
{
    grid g = { .lx = 3, .ly = 1, .nx = 6, .ny = 2, .triangles = _i };
    bbm_model *m = cantilever(&SOLID, &g, 5, -4);
    double f[3] = { 0 };

    m->par.steps = 60;
    m->par.tolerance = 1e-11;
    m->par.gravity[1] = -1;
    ck_ok(bbm_run(m), m);
    ck_assert(m->info.step > 3 && m->info.step < 60);
    ck_assert(result_at(m, node_at(&g, 6, 2)).v < -0.02);
    out_of_balance(m, f);
    const double most = fmax(fabs(f[0]), fmax(fabs(f[1]), fabs(f[2])));
    ck_near(most, 0, 10, 1e-8);         /* residual forces, of K D: 1e-11 of it */
}
END_TEST

/* One element under large tension: the stress is the load over the section as it is then, t h (1 -
 * nu e ...). */
START_TEST(stress_is_that_of_the_present_section)
{
    bbm_model *m = unit_square(&SOLID);

    ck_ok(bbm_fix_node(m, 0, BBM_XY, 0, 0), m);
    ck_ok(bbm_fix_node(m, 3, BBM_X, 0, 0), m);
    ck_ok(bbm_add_load(m, 1, 25, 0), m);
    ck_ok(bbm_add_load(m, 2, 25, 0), m);
    m->par.steps = 50;
    m->par.tolerance = 1e-13;
    run(m);
    const double h = m->vertex[2].y - m->vertex[1].y;
    ck_assert(h < 0.98);
    ck_relative(m->element[0].stress[0], 50 / (SOLID.thickness * h), SOLVED);
    ck_near(m->element[0].stress[1], 0, 100, SOLVED);
}
END_TEST

/* With a tolerance it is at rest after one step; without one a run does all its steps. */
START_TEST(a_body_without_load_stays_where_it_is)
{
    bbm_model *m = unit_square(&SOLID);

    ck_ok(bbm_fix_node(m, 0, BBM_XY, 0, 0), m);
    ck_ok(bbm_fix_node(m, 1, BBM_Y, 0, 0), m);
    m->par.tolerance = _i ? 0 : 1e-6;
    m->par.steps = 3;
    run(m);
    ck_assert(m->info.step == (_i ? 3 : 1) && m->info.t == 0 && m->info.change == 0);
    ck_assert(result_at(m, 2).u == 0 && result_at(m, 2).mises == 0);
}
END_TEST

/* ------------------------------------------------------------------------------ when a run ends */

/* (71) by hand: the barycentres of two elements that move by D in a step, and by the sum in all. */
START_TEST(the_stop_criterion_compares_the_step_with_the_sum_of_all_steps)
{
    bbm_model *m = new_bar(&SOLID, 1);
    double total[LINKS][2] = { { 0 } };

    for (int step = 1; step <= 3; step++) {
        double step2 = 0, sum2 = 0;
        ck_ok(bbm_step(m), m);
        for (int e = 0; e < LINKS; e++)
            for (int r = 0; r < 2; r++) {
                total[e][r] += m->element[e].D[r];
                step2 += m->element[e].D[r] * m->element[e].D[r];
                sum2 += total[e][r] * total[e][r];
                ck_near(m->element[e].sum[r], total[e][r], 1, 1e-15);
            }
        ck_assert_int_eq(m->info.step, step);
        ck_relative(m->info.change, sqrt(step2 / sum2), ROUNDING);
    }
}
END_TEST

START_TEST(a_run_stops_at_the_first_step_that_is_small_enough)
{
    bbm_model *m = new_bar(&SOLID, 1), *n = new_bar(&SOLID, 1);
    double change[3];

    for (int step = 0; step < 3; step++) {
        ck_ok(bbm_step(m), m);
        change[step] = m->info.change;
    }
    ck_assert(change[0] == 1 && change[1] < 0.1 && change[2] < change[1]);
    n->par.steps = 3;
    n->par.tolerance = change[1];  /* small enough: as small, too */
    ck_ok(bbm_run(n), n);
    ck_assert_int_eq(n->info.step, 2);
}
END_TEST

START_TEST(a_run_that_stops_short_says_so_and_keeps_what_it_has)
{
    bbm_model *m = new_bar(&SOLID, 1);

    m->par.steps = 2;
    m->par.tolerance = 1e-13;
    ck_assert_int_eq(bbm_run(m), BBM_STEPS_EXHAUSTED);
    ck_assert_int_eq(m->info.step, 2);
    ck_assert_ptr_nonnull(strstr(bbm_message(m), "after step 2"));
    ck_assert(result_at(m, 2 * LINKS).u > 0);
    ck_assert_int_eq(bbm_run(m), BBM_STEPS_EXHAUSTED);  /* goes on where it stopped */
    ck_assert_int_eq(m->info.step, 4);
    m->par.steps = 20;
    ck_ok(bbm_run(m), m);
    ck_assert(m->info.step < 24 && m->info.change <= 1e-13);
}
END_TEST

Suite *steps_suite(void)
{
    Suite *s = suite_create("steps");

    add_case(s, "dynamics",
        { a_thrown_body_follows_the_parabola, 2 },
        { the_acceleration_of_the_base_acts_like_gravity_the_other_way, 2 },
        { a_spinning_element_keeps_its_angular_velocity_and_its_mass, 2 },
        { stress_turns_with_the_element, 2 },
        { bonded_elements_keep_their_momentum_while_they_shake_each_other, 2 },
        { a_vibrating_element_is_damped_as_newmarks_recurrence_says, 1 },
        { steps_without_memory_of_velocity_end_in_the_static_answer, 1 });
    add_case(s, "statics",
        { statics_ends_in_balance_on_the_moved_geometry, 2 },
        { stress_is_that_of_the_present_section, 1 },
        { a_body_without_load_stays_where_it_is, 2 });
    add_case(s, "end of a run",
        { the_stop_criterion_compares_the_step_with_the_sum_of_all_steps, 1 },
        { a_run_stops_at_the_first_step_that_is_small_enough, 1 },
        { a_run_that_stops_short_says_so_and_keeps_what_it_has, 1 });
    return s;
}
