/* check_joints.c - joints: cohesion and tensile strength where blocks touch from the start. */
#include "check.h"
#include "models.h"

/* --------------------------------------------------------------------------------------- joints */

/* A block that comes fast to the end of the table, level with its top: on the line, but not on the
 * edge. Or to its top from above. Both are in reach of the step, and neither is part of a joint. */
START_TEST(a_joint_is_where_a_corner_lies_on_an_edge)
{
    bbm_model *m = new_blocks();

    m->beyond->cohesion = 1e4;
    add_table(m, 0);
    add_rectangle(m, 1, ROCK, (rectangle){ .x = _i ? 0 : 5.125, .y = _i ? 0.125 : 0,
                                           .w = 1, .h = 1 });
    set_velocity(m, 1, _i ? 0 : -15, _i ? -15 : 0);
    detect(m);
    ck_assert_int_ge(m->contacts, 1);
    for (int k = 0; k < m->contacts; k++)
        ck_assert(m->contact[k].area == 0 && m->contact[k].state == BBM_OPEN);
}
END_TEST

/* Unit squares one above the other, or the upper one shifted so that just its corner is past the
 * end of the lower side: a millionth of the mean edge is still closed, and still on the edge, and
 * more is not. */
START_TEST(a_joint_may_gape_by_a_millionth_of_an_edge)
{
    for (int k = 0; k < 2; k++) {
        const double small = _i ? (k ? 1.001e-6 : 0.999e-6) : k ? nextafter(1e-6, 1) : 1e-6;
        bbm_model *m = new_blocks();
        m->beyond->tension = 1;
        add_rectangle(m, 0, ROCK, (rectangle){ .x = _i ? -1 : 0, .y = -1, .w = 1, .h = 1 });
        add_rectangle(m, 1, ROCK, (rectangle){ .x = _i ? small : 0, .y = _i ? 0 : small,
                                               .w = 1, .h = 1 });
        set_velocity(m, 1, 1, 0);
        detect(m);
        ck_assert_int_ge(m->contacts, 1);
        int off = 0;
        for (int c = 0; c < m->contacts; c++) {
            ck_assert(_i || (m->contact[c].area > 0) == (k == 0));
            off |= m->contact[c].trial.beyond_end;
        }
        ck_assert_int_eq(off, _i && k);
        release(m);
    }
}
END_TEST

/* A block 2 m x 1 m on a table, a joint since the start, without gravity: friction 30 degrees, 5
 * kPa of cohesion, 3 kPa of tensile strength. `fx` on its lower corners together, `fy` on the upper
 * ones. */
static bbm_model *joined(double fx, double fy)
{
    bbm_model *m = weightless_blocks();

    m->par.friction = 30;
    m->beyond->cohesion = 5000;
    m->beyond->tension = 3000;
    m->par.velocity_factor = 0;
    add_table(m, 0);
    add_rectangle(m, 1, ROCK, (rectangle){ .x = 0, .y = 0, .w = 2, .h = 1 });
    for (int c = 0; c < 2; c++)  /* the shear acts at the joint, the pull at the top */
        ck_ok(bbm_add_load(m, vertex_of(m, 1, c)->node, fx / 2, 0), m);
    for (int c = 2; c < 4; c++)
        ck_ok(bbm_add_load(m, vertex_of(m, 1, c)->node, 0, fy / 2), m);
    ck_ok(bbm_prepare(m), m);
    return m;
}

/* Blocks that touch when some time has gone have no joint, though the first step is still under
 * way. */
START_TEST(a_joint_is_there_at_the_start_or_never)
{
    bbm_model *m = joined(0, 0);

    m->info.t = _i ? 1e-3 : 0;
    detect(m);
    ck_assert_int_eq(m->contacts, 2);
    for (int k = 0; k < 2; k++)
        ck_assert_int_eq(m->contact[k].area > 0, !_i);
}
END_TEST

/* Also without friction and cohesion, where it slides all the time, and holds until it is pulled
 * off. */
START_TEST(a_joint_breaks_at_its_tensile_strength_whatever_its_shear_strength)
{
    const int breaks = _i % 2;
    bbm_model *m = joined(0, (breaks ? 1.01 : 0.99) * 3000 * 2);

    if (_i / 2)
        m->par.friction = m->beyond->cohesion = 0;
    run_steps(m, 50);
    ck_assert_int_eq(m->info.contacts, breaks ? 0 : 2);
    if (breaks)
        ck_assert(m->element[1].sum[1] > 1e-3);
    else
        ck_relative(normal_force(m, 0, 1), -0.99 * 6000, 1e-5);
}
END_TEST

/* c l + N tan(phi): with a thrust of 10 kN, and with a pull of 4 kN; the joint that holds is at
 * rest. */
START_TEST(a_joint_slips_at_its_cohesion_and_friction)
{
    const double N = _i % 2 ? -4000 : 10000, bound = 5000 * 2 + N * tan(PI / 6);
    bbm_model *m = joined((_i / 2 ? 1.01 : 0.99) * bound, -N);

    run_steps(m, 60);
    if (_i / 2) {
        ck_assert(m->element[1].sum[0] > 1e-4);
    } else {
        ck_assert(contact_of(m, 1, 0) && contact_of(m, 1, 0)->state == BBM_LOCK);
        /* the block's own shear */
        ck_near(m->element[1].sum[0], 0.99 * bound / (2 * m->par.p_s), 1e-5, 0.1);
    }
}
END_TEST

/* Under a thrust at its right the joint could hold 0.9 of what both sides bear together, if the left one slid on at its
 * cohesion. It breaks there, and the right side cannot hold all; half of it both hold. */
START_TEST(one_static_step_finds_whether_a_joint_holds)
{
    bbm_model *m = joined((_i ? 0.9 : 0.5) * (5000 * 2 + 10000 * tan(PI / 6)), 0);

    ck_ok(bbm_add_load(m, vertex_of(m, 1, 2)->node, 0, -10000), m);
    m->par.dt = INFINITY;
    m->par.steps = 1;
    ck_assert_int_eq(bbm_step(m), _i ? BBM_NO_EQUILIBRIUM : BBM_OK);
    for (int k = 0; k < m->contacts; k++)
        ck_assert_int_eq(m->contact[k].area > 0, 1);
}
END_TEST

/* Without friction and cohesion statics finds the same joint by steps from rest. At first inertia bears the weight of 2.5 t
 * in these, and all of the pull at the foot acts on the joint. */
START_TEST(a_static_joint_is_judged_when_its_weight_has_come)
{
    const double pulls = (_i % 2 ? 1.01 : 0.99) * 3000 * 2 + 2 * DENSITY * GRAVITY;
    bbm_model *m = joined(0, 0);

    m->par.gravity[1] = -GRAVITY;
    m->par.friction = m->beyond->cohesion = 0;
    set_springs(m, _i / 2 ? 5e11 : 5e9, 0.4 * m->par.p_n);
    for (int c = 0; c < 2; c++)
        ck_ok(bbm_add_load(m, vertex_of(m, 1, c)->node, 0, pulls / 2), m);
    m->par.dt = INFINITY;
    m->par.steps = 1;
    ck_assert_int_eq(bbm_step(m), _i % 2 ? BBM_NO_EQUILIBRIUM : BBM_OK);
}
END_TEST

/* Sheared off under a thrust of 1 kN. Then a push above the friction, though below the cohesion,
 * moves it on, and a pull of a hundredth of the strength lifts it. */
START_TEST(a_joint_that_broke_has_no_strength_left)
{
    const double bound = 10000 + 1000 * tan(PI / 6);
    bbm_model *m = joined(1.05 * bound, -1000);

    run_steps(m, 40);
    ck_assert(m->element[1].sum[0] > 1e-4);
    for (int k = 0; k < m->contacts; k++)
        ck_assert(m->contact[k].area == 0);
    for (int c = 0; c < 2; c++)
        ck_ok(bbm_add_load(m, vertex_of(m, 1, c)->node, 500 - 1.05 * bound / 2, 0), m);
    const double here = m->element[1].sum[0];
    run_steps(m, 20);
    ck_assert(m->element[1].sum[0] > here + 1e-4);
    for (int c = 0; c < 4; c++)
        ck_ok(bbm_add_load(m, vertex_of(m, 1, c)->node, c < 2 ? -500 : 0, c < 2 ? 0 : 530), m);
    run_steps(m, 20);
    ck_assert_int_eq(m->info.contacts, 0);
}
END_TEST

/* The sides of the seats above, in pieces, and a table of half the thickness: what cohesion and
 * tension act on is the overlap, shared out among the contacts so that each has half the way to the
 * next. At sizes that differ by 2000, as given and shifted by what a model file rounds. */
static const int PIECES[][2] = { { 1, 1 }, { 4, 1 }, { 1, 3 }, { 4, 3 }, { 2, 2 },
                                 { 4, 2 }, { 4, 8 } };

/* On one block of so many pieces, or on as many held ones side by side. */
static double joint_area(double size, double x, double w, const int pieces[2], int held)
{
    const int blocks = held ? pieces[0] : 1;
    const double part = size / blocks;
    const bbm_material thin = { 1e10, 0.25, 2500, 0.5 };
    bbm_model *m = new_blocks();
    double sum = 0;
    int material;

    ck_ok(bbm_add_material(m, &thin, &material), m);
    m->beyond->tension = 1;
    for (int b = 0; b < blocks; b++)
        add_rectangle(m, b, material, (rectangle){ .x = b * part, .y = -size, .w = part, .h = size,
                                                   .nx = held ? 1 : pieces[0], .fixed = held });
    add_rectangle(m, blocks, ROCK, (rectangle){ .x = x, .y = 0, .w = w, .h = size, .nx = pieces[1] });
    detect(m);
    for (int k = 0; k < m->contacts; k++) {
        ck_assert(m->contact[k].area == 0 || m->contact[k].state == BBM_LOCK);
        sum += m->contact[k].area;
    }
    release(m);
    return sum;
}

START_TEST(the_areas_of_a_joints_contacts_add_up_to_its_own)
{
    const int *pieces = PIECES[_i / COUNT(SEATS)];
    const double sizes[] = { 1, 40, 0.02 };

    for (int k = 0; k < 9; k++) {
        const double size = sizes[k / 3], shift = 1e-7 * (k % 3 - 1);
        const double x = SEATS[_i % COUNT(SEATS)].x + shift, w = SEATS[_i % COUNT(SEATS)].w;
        const double overlap = fmin(1, x + w) - fmax(0, x);
        for (int held = 0; held < 2; held++)
            ck_relative(joint_area(size, size * x, size * w, pieces, held), overlap * size * 0.5,
                        shift == 0 ? SOLVED : 1e-6);
    }
}
END_TEST

/* The block is laid down on the table, from 1 mm above; it can then be lifted by next to
 * nothing. */
START_TEST(blocks_that_come_to_touch_have_no_tensile_strength)
{
    bbm_model *m = weightless_blocks();

    m->par.friction = 30;
    m->beyond->tension = 3000;
    m->par.velocity_factor = 0;
    add_table(m, 0);
    add_rectangle(m, 1, ROCK, (rectangle){ .x = 0, .y = 1e-3, .w = 2, .h = 1 });
    ck_ok(bbm_add_load(m, vertex_of(m, 1, 2)->node, 0, -3000), m);
    ck_ok(bbm_add_load(m, vertex_of(m, 1, 3)->node, 0, -3000), m);
    run_steps(m, 60);
    ck_assert_int_eq(m->info.contacts, 2);
    ck_ok(bbm_add_load(m, vertex_of(m, 1, 2)->node, 0, 3005), m);
    ck_ok(bbm_add_load(m, vertex_of(m, 1, 3)->node, 0, 3005), m);
    run_steps(m, 20);
    ck_assert_int_eq(m->info.contacts, 0);
}
END_TEST

/* Two squares side by side on a table. The joint of one with the table, given either way, is not that of the squares;
 * with any block (-1), it is. */
START_TEST(a_joint_is_that_of_its_two_blocks)
{
    static const int between[][2] = { { 0, 1 }, { 1, 0 }, { 1, -1 }, { -1, 1 } };
    bbm_model *m = new_blocks();

    m->par.friction = 10;
    ck_ok(bbm_add_joint(m, between[_i], 40, -1, -1), m);
    add_table(m, 0);
    add_rectangle(m, 1, ROCK, (rectangle){ .x = 0, .y = 0, .w = 1, .h = 1 });
    add_rectangle(m, 2, ROCK, (rectangle){ .x = 1, .y = 0, .w = 1, .h = 1 });
    detect(m);
    for (int k = 0; k < m->contacts; k++) {
        const bbm_contact *c = &m->contact[k];
        const int i = m->edge[c->corner].block, j = m->edge[c->edge].block;
        const int fits = i + j == 1 || (_i > 1 && (i == 1 || j == 1));
        ck_near(c->strength.tan_phi, tan((fits ? 40 : 10) * PI / 180), 1, ROUNDING);
    }
    ck_assert_int_gt(m->contacts, 4);
}
END_TEST

START_TEST(a_joint_of_no_meaning_is_refused)
{
    static const double strength[][3] = {
        { 90, 0, 0 }, { NAN, 0, 0 }, { 0, NAN, 0 }, { 0, INFINITY, 0 }, { 0, 0, INFINITY }, { 0, 0, NAN },
    };
    const double *s = strength[_i];
    bbm_model *m = beyond_model();

    ck_assert_int_eq(bbm_add_joint(m, (int[]){ 0, -1 }, s[0], s[1], s[2]), BBM_BAD_PARAMETER);
    ck_assert_ptr_nonnull(strstr(bbm_message(m), "expected finite ones, less than 90 degrees"));
    ck_assert_int_eq(bbm_add_joint(m, (int[]){ 0, -1 }, 89, 0, 1e300), BBM_BAD_PARAMETER);
    ck_assert_int_eq(bbm_prepare(m), BBM_BAD_PARAMETER);
    release(m);
    m = beyond_model();
    ck_ok(bbm_add_joint(m, (int[]){ 0, -1 }, 89, 0, 1e300), m);
}
END_TEST

/* A cantilever of 9 x 3 cells of four triangles, loaded at its end: one block, or 108 of them in
 * unbroken joints as stiff as bonds. Of the many contacts where corners meet only some are joints;
 * all others open or slide in the first pass. Deflection of its end. */
static double sag(int joints)
{
    enum { NX = 9, NY = 3 };
    bbm_model *m = beyond_model();

    bbm_add_material(m, &(bbm_material){ 30e6, 0.3, 1, 1 }, NULL);
    for (int j = 0; j <= NY; j++)
        for (int i = 0; i <= NX; i++)
            bbm_add_node(m, 48.0 * i / NX, 12.0 * j / NY, NULL);
    for (int c = 0; c < NX * NY; c++) {
        const int a = c / NX * (NX + 1) + c % NX, corner[4] = { a, a + 1, a + NX + 2, a + NX + 1 };
        int middle;
        bbm_add_node(m, 48.0 * (c % NX + 0.5) / NX, 12.0 * (c / NX + 0.5) / NY, &middle);
        for (int k = 0; k < 4; k++)
            bbm_add_element(m, joints ? 4 * c + k : 0, 0, 3,
                            (int[]){ corner[k], corner[(k + 1) % 4], middle }, NULL);
    }
    for (int j = 0; j <= NY; j++) {
        bbm_fix_node(m, j * (NX + 1), BBM_XY, 0, 0);
        bbm_add_load(m, j * (NX + 1) + NX, 0, -250);
    }
    m->par.p_n = m->par.p_s = 1e11;
    m->par.friction = 45;
    m->beyond->cohesion = m->beyond->tension = 1e9;
    m->par.alpha = 1000;
    run_steps(m, 1);
    const double v = m->vertex[m->adjacent[m->adjacent_first[NX]]].v;
    release(m);
    return v;
}

/* To 0.2 %: bonds with alpha = 1000 give by that much more than these contacts. */
START_TEST(statics_finds_the_states_of_many_blocks_in_unbroken_joints)
{
    ck_relative(sag(1), sag(0), 0.002);
}
END_TEST

/* For blocks in strong joints, with the springs of ./bbm. */
static bbm_model *new_glued(void)
{
    bbm_model *m = new_blocks();

    m->beyond->cohesion = m->beyond->tension = 1e6;
    m->par.friction = 30;
    set_springs(m, 50 * m->material[ROCK].E, 20 * m->material[ROCK].E);
    return m;
}

/* A block on a mesh in an unbroken joint without any force, from the start (0) or after its weight has gone (1): the rounding
 * of its springs, 1e-16 m of 5e11 N/m, is nothing to settle. */
START_TEST(a_joint_without_a_force_stays_as_it_is)
{
    grid g = { .x = -1, .y = -1, .lx = 3, .ly = 1, .nx = 5, .ny = 1 };
    bbm_model *m = new_glued();

    m->material[BASE] = m->material[ROCK];
    add_grid(m, &g, 0);
    for (int k = 0; k < 2 * (g.nx + 1); k++)
        ck_ok(bbm_fix_node(m, k, BBM_XY, 0, 0), m);
    add_rectangle(m, 1, ROCK, (rectangle){ .w = 1, .h = 0.5 });
    m->par.gravity[1] *= _i;
    run_steps(m, 20);
    m->par.gravity[1] = 0;
    run_steps(m, 20);
    ck_assert_int_eq(m->info.contacts, 2);
    for (int k = 0; k < m->contacts; k++)
        ck_assert(m->contact[k].state == BBM_OPEN || m->contact[k].area > 0);
    release(m);
}
END_TEST

/* Four blocks meet at a point. When they have settled the run begins, once more at t = 0: what stands across the point has no
 * joint then, either, though it has come to touch. */
START_TEST(no_joint_begins_when_blocks_have_settled)
{
    bbm_model *m = new_glued();

    add_table(m, 0);
    for (int k = 0; k < 4; k++)
        add_rectangle(m, 1 + k, ROCK, (rectangle){ .x = k % 2, .y = .5 * (k / 2), .w = 1, .h = 0.5 });
    ck_ok(bbm_add_load(m, m->nodes - 2, -1e5, 0), m);
    run_steps(m, 1);
    const int contacts = m->info.contacts;
    settle(m, 20);
    m->info.t = m->info.step = 0;
    run_steps(m, 1);
    ck_assert_int_eq(m->info.contacts, contacts);
    for (int k = 0; k < m->contacts; k++)
        ck_assert(!m->contact[k].trial.touches);
    release(m);
}
END_TEST

/* A block stands on another one, beside an abutment as high as that, whose corner it meets: exactly, or by a rounding more. It
 * has no joint with what it meets in a corner alone. */
START_TEST(blocks_across_a_corner_have_no_joint)
{
    bbm_model *m = new_glued();

    m->par.dt = INFINITY;
    m->par.steps = 1;
    add_rectangle(m, 0, ROCK, (rectangle){ .x = -1, .y = -1, .w = 4, .h = 1, .fixed = 1 });
    add_rectangle(m, 1, ROCK, (rectangle){ .x = 1, .w = 1, .h = 1, .fixed = 1 });
    add_rectangle(m, 2, ROCK, (rectangle){ .w = 1, .h = 1 });
    add_rectangle(m, 3, ROCK, (rectangle){ .y = 1, .w = 1 + _i * 1e-15, .h = 1 });
    run_steps(m, 1);
    for (const bbm_contact *c = m->contact; c < m->contact + m->contacts; c++)
        if (m->edge[c->corner].block + m->edge[c->edge].block == 4)
            ck_assert(c->area == 0 && c->N == 0);
    ck_assert_int_eq(m->info.contacts, 6);
    release(m);
}
END_TEST

/* While statics follows the motion, joints hold whatever comes, if they have any strength. */
START_TEST(a_joint_that_is_to_hold_needs_one_strength_alone)
{
    bbm_model *m = joined(0, 0);

    m->beyond->cohesion *= _i % 2;
    m->beyond->tension *= _i / 2;
    m->beyond->joints_hold = 1;
    detect(m);
    ck_assert_int_eq(m->contacts, 2);
    for (int k = 0; k < 2; k++)
        ck_assert_int_eq(fmin(m->contact[k].strength.shear, m->contact[k].strength.tension) > 1e50, _i > 0);
}
END_TEST

Suite *joints_suite(void)
{
    Suite *s = suite_create("joints");

    add_case(s, "joints",
        { a_joint_is_where_a_corner_lies_on_an_edge, 2 },
        { a_joint_may_gape_by_a_millionth_of_an_edge, 2 },
        { a_joint_is_there_at_the_start_or_never, 2 },
        { a_joint_breaks_at_its_tensile_strength_whatever_its_shear_strength, 4 },
        { a_joint_slips_at_its_cohesion_and_friction, 4 },
        { one_static_step_finds_whether_a_joint_holds, 2 },
        { a_static_joint_is_judged_when_its_weight_has_come, 4 },
        { a_joint_that_broke_has_no_strength_left, 1 },
        { the_areas_of_a_joints_contacts_add_up_to_its_own, COUNT(PIECES) * COUNT(SEATS) },
        { blocks_that_come_to_touch_have_no_tensile_strength, 1 },
        { a_joint_is_that_of_its_two_blocks, 4 },
        { a_joint_of_no_meaning_is_refused, 6 },
        { a_joint_without_a_force_stays_as_it_is, 2 },
        { no_joint_begins_when_blocks_have_settled, 1 },
        { blocks_across_a_corner_have_no_joint, 2 },
        { statics_finds_the_states_of_many_blocks_in_unbroken_joints, 1 },
        { a_joint_that_is_to_hold_needs_one_strength_alone, 4 });
    return s;
}
