/* check_entrance.c - section 3.7: what may enter an edge in a step, how deep it may start, what
 * opens inside. */
#include <stdio.h>
#include <string.h>

#include "check.h"
#include "models.h"

/* ------------------------------------------------------------------------------------ what hits */

static int was_closed(const bbm_contact old[], int n, int corner)
{
    for (int k = 0; k < n; k++)
        if (old[k].corner == corner && old[k].state != BBM_OPEN)
            return 1;
    return 0;
}

/* How much further the last step would have moved an element's points without its forces, at most:
 * dt/2 of the change of their velocities; the polygons reach 0.6 m from their barycentres, the
 * table 5 m, but it is fixed. */
static double held_back(const bbm_model *m, const double V[][6], int e)
{
    const double *v = m->element[e].V;

    return m->par.dt / 2 * (hypot(v[0] - V[e][0], v[1] - V[e][1]) + 0.6 * fabs(v[2] - V[e][2]));
}

/* In a pile that is thrown about in long steps, a corner that hits an edge has its foot on it, at
 * the end of the step if not at its start, and stands clear of it at the end - as the step would be
 * without the forces of the hit. */
START_TEST(what_hits_an_edge_is_a_corner_with_its_foot_on_it)
{
    bbm_model *m = pile((unsigned)_i + 1, 0);
    int hits = 0;

    for (int b = 0; b < PILE; b++) {
        set_velocity(m, b, 3.0 * (b % 3 - 1), -4);
        m->element[b].V[2] = b % 2 ? 6 : -6;
    }
    for (int i = 0; i < 60; i++) {
        bbm_contact *old = calloc((size_t)m->contacts + 1, sizeof *old);
        const int n = m->contacts;
        double V[PILE + 1][6];
        if (n)
            memcpy(old, m->contact, (size_t)n * sizeof *old);
        for (int e = 0; e <= PILE; e++)
            memcpy(V[e], m->element[e].V, sizeof V[e]);
        run_steps(m, 1);
        for (int k = 0; k < m->contacts; k++) {
            const bbm_contact *c = &m->contact[k];
            double beyond, clear;
            stand(m, c, &beyond, &clear);
            if (c->state == BBM_OPEN || was_closed(old, n, c->corner))
                continue;
            const double i_back = held_back(m, (const double (*)[6])V, m->edge[c->corner].element);
            const double j_back = held_back(m, (const double (*)[6])V, m->edge[c->edge].element);
            ck_assert_msg(!c->trial.beyond_end || beyond < i_back + j_back, "step %d: beyond %g", i, beyond);
            ck_assert_msg(clear > -0.02, "step %d: clear %g", i, clear);
            hits++;
        }
        free(old);
    }
    ck_assert_int_gt(hits, 10);
}
END_TEST

/* 5 mm beside the table's end, at 5 m/s: it crosses the lines of the table's top and bottom and
 * touches nothing. */
START_TEST(a_block_that_falls_past_the_end_of_a_table_does_not_notice_it)
{
    const double v0 = 5, t = 0.3;
    bbm_model *m = new_blocks();

    add_rectangle(m, 0, BASE, (rectangle){ .x = -1, .y = -1, .w = 2, .h = 1, .fixed = 1 });
    const int e = add_rectangle(m, 1, ROCK, (rectangle){ .x = _i ? 1.005 : -1.505, .y = 0.52,
                                                         .w = 0.5, .h = 0.5 });
    set_velocity(m, e, 0, -v0);
    for (int i = 0; i < 30; i++) {
        run_steps(m, 1);
        ck_assert_int_eq(m->info.contacts, 0);
    }
    ck_relative(m->element[e].sum[1], -v0 * t - GRAVITY * t * t / 2, SOLVED);
    ck_near(m->element[e].sum[0], 0, 1, SOLVED);
}
END_TEST

/* The corner is in contact, and next to nothing deep. */
static void expect_stop(const bbm_model *m, int e, int corner)
{
    ck_assert_msg(contact_of(m, e, corner) != NULL, "corner %d has no contact", corner);
    ck_assert_msg(m->info.penetration < 1e-3, "%g m deep, expected less than 1 mm",
                  m->info.penetration);
}

/* A block spins by 0.1 rad in a step, from 0.05 rad to one side to 0.05 rad to the other: the
 * corner that gets below the table's top by 8 mm is one whose side pointed into the table at the
 * start. Turned by all angles, and mirrored. */
START_TEST(a_corner_that_turns_towards_an_edge_in_the_step_is_stopped_by_it)
{
    const double angle = ANGLES[_i / 2], side = _i % 2 ? -1 : 1, c = cos(radians(angle));
    const double s = sin(radians(angle));
    const outline o = put(&SQUARE, radians(angle) + 0.05 * side, -0.5263 * s, 0.5263 * c);
    bbm_model *m = weightless_blocks();

    add_rectangle(m, 0, BASE, (rectangle){ -5, -1, 10, 1, angle, .fixed = 1 });
    const int e = add_polygon(m, 1, 4, o.x);
    set_velocity(m, e, s, -c);
    m->element[e].V[2] = -10 * side;
    run_steps(m, 1);
    expect_stop(m, e, _i % 2 ? 0 : 1);
    for (int k = 0; k < 4; k++)
        ck_assert(c * vertex_of(m, e, k)->y - s * vertex_of(m, e, k)->x > -1e-3);
}
END_TEST

/* As above, but a couple turns it from rest, by 0.1 rad or, while it falls at 1 m/s, by 0.016 rad;
 * a block far away moves so fast that no displacement of this one is more than foreseen. */
START_TEST(a_corner_that_a_load_turns_towards_an_edge_in_the_step_is_stopped_by_it)
{
    const double tilt = _i ? 0.012 : 0.02, end = _i ? -0.004 : -0.08, height = _i ? 0.509 : 0.52;
    const double couple = 2 * (DENSITY / 6) * (end - tilt) / 1e-4;
    const outline o = put(&SQUARE, tilt, 0, height);
    bbm_model *m = weightless_blocks();

    add_table(m, 0);
    const int e = add_polygon(m, 1, 4, o.x);
    const int far = add_rectangle(m, 2, ROCK, (rectangle){ .x = 20, .y = 20, .w = 1, .h = 1 });
    for (int k = 0; k < 4; k++)
        ck_ok(bbm_add_load(m, vertex_of(m, e, k)->node, k < 2 ? couple / 2 : -couple / 2, 0), m);
    set_velocity(m, e, 0, _i ? -1 : 0);
    set_velocity(m, far, 10, 0);
    run_steps(m, 1);
    expect_stop(m, e, 1);
}
END_TEST

/* A tilted block overhangs a table and falls on its lower corner by 2 cm; the table's corner, 1.5 m
 * away, is 2.075 cm under its lower side, in reach of the step (2.2 cm), and is not reached. */
START_TEST(a_corner_is_stopped_though_a_far_one_under_the_same_side_is_not_reached)
{
    const double side = _i ? -1 : 1, left = _i ? -3 : 0;
    const outline flat = { 4, { { left, 0 }, { left + 3, 0 }, { left + 3, 0.5 }, { left, 0.5 } } };
    const outline beam = put(&flat, 0.0105 * side, 3.5 * side, 0.005);
    bbm_model *m = weightless_blocks();

    add_table(m, 0);
    const int e = add_polygon(m, 1, 4, beam.x);
    set_velocity(m, e, 0, -2);
    run_steps(m, 1);
    ck_assert_int_eq(m->contacts, 2);
    ck_assert(contact_of(m, e, _i ? 1 : 0) != NULL);
    ck_assert_int_eq(m->info.contacts, 1);
}
END_TEST

/* A load drives the block 0.5 m in a step from rest, which neither velocity nor gravity foretells;
 * a wall stands at 0.3 m. */
START_TEST(a_block_that_moves_further_than_foreseen_does_not_pass_through_a_wall)
{
    const double W = DENSITY * 0.01, push = 0.5 * 2 * W / 1e-4;
    bbm_model *m = weightless_blocks();

    m->par.p_n = 1e11;
    add_rectangle(m, 0, BASE, (rectangle){ .x = 0.4, .y = -2, .w = 3, .h = 4, .fixed = 1 });
    const int e = add_rectangle(m, 1, ROCK, (rectangle){ .x = 0, .y = 0, .w = 0.1, .h = 0.1 });
    for (int c = 0; c < 4; c++)
        ck_ok(bbm_add_load(m, vertex_of(m, e, c)->node, push / 4, 0), m);
    run_steps(m, 1);
    ck_assert_int_eq(m->info.contacts, 2);
    ck_near(m->element[e].D[0], 0.3, 0.3, 1e-2);
}
END_TEST

/* A corner one of whose sides dips into a table by 0.015, and whose block will turn by 0.01 in the
 * step: it may turn out of the table while it is outside, but not where it is on it. */
START_TEST(a_side_may_turn_out_of_an_edge_while_its_corner_is_outside)
{
    const double tip[2] = { 0, 0 };
    bbm_model *m = weightless_blocks();
    int n;

    add_table(m, 0);
    add_wedge(m, 1, tip, 0, radians(60));
    ck_ok(bbm_prepare(m), m);
    m->element[1].V[2] = 1;
    m->vertex[m->element[1].first + 1].y = -0.015;
    shift_element(m, 1, 0, _i ? 1e-9 : 0);
    start_step(m, &n);
    ck_assert_int_eq(find_listed(m, 1, 0, 0, 2) != NULL, _i);
}
END_TEST

/* A grid point of a block's lower side, between two elements, starts 0.25 m beyond the end of a
 * table; the solution puts it exactly over the end and 0.125 m into the table, or beyond the end by
 * next to nothing. */
START_TEST(the_end_of_an_edge_belongs_to_it)
{
    const double side = _i % 2 ? 1 : -1, beyond = _i / 2 ? 0.25 - 1e-12 : 0.25;
    bbm_model *m = new_blocks();
    int closed = 0, n;

    add_table(m, 0);
    const int e = add_rectangle(m, 1, ROCK, (rectangle){ .x = side * 5.25 - 1, .y = 0.125, .w = 2,
                                                         .h = 1, .nx = 2 });
    set_velocity(m, e, 0, -25);
    set_velocity(m, e + 1, 0, -25);
    start_step(m, &n);
    for (int i = e; i < e + 2; i++) {
        m->D[6 * i] = -side * beyond;
        m->D[6 * i + 1] = -0.25;
    }
    (void)bbm_open_close(m);
    bbm_store_contacts(m);
    for (int k = 0; k < m->contacts; k++)
        closed += m->contact[k].state != BBM_OPEN &&
                  fabs(corner_vertex(m, &m->contact[k])->x) == 5.25;
    ck_assert_int_eq(closed, _i / 2 ? 0 : 1);
}
END_TEST

/* A wedge whose sides rise at 70 and 110 degrees above a slope of 30 degrees. The solution turns it
 * by more than a radian and puts its tip 1 mm into the slope: the tip hits only if both sides still
 * point upwards at the end, by a degree, and not if one of them points into the slope by two. */
START_TEST(a_tip_that_turns_far_hits_if_its_sides_are_clear_at_the_end)
{
    const double clear = _i % 2 ? 1 : -2, turned = radians(_i / 2 ? 70 - clear : clear - 70);
    const double slope = radians(30);
    const double up[2] = { -sin(slope), cos(slope) }, tip[2] = { 0.1 * up[0], 0.1 * up[1] };
    double wedge[3][2] = { { tip[0], tip[1] } };
    bbm_model *m = new_blocks();
    double u[2];
    int n;

    add_rectangle(m, 0, BASE, (rectangle){ -5, -1, 10, 1, 30, .fixed = 1 });
    for (int k = 0; k < 2; k++) {
        wedge[1 + k][0] = tip[0] + cos(slope + radians(k ? 110 : 70));
        wedge[1 + k][1] = tip[1] + sin(slope + radians(k ? 110 : 70));
    }
    const int e = add_polygon(m, 1, 3, (const double (*)[2])wedge);
    set_velocity(m, e, 0, -10);
    start_step(m, &n);
    m->D[6 * e + 2] = turned;
    bbm_move(bbm_motion_of(m), &m->element[e], &m->D[6 * e], tip[0], tip[1], u);
    for (int a = 0; a < 2; a++)
        m->D[6 * e + a] = -1e-3 * up[a] - tip[a] - u[a];
    bbm_set_middle(m);
    (void)bbm_open_close(m);
    bbm_store_contacts(m);
    int hit = 0;
    for (int k = 0; k < m->contacts; k++)
        hit += m->contact[k].state != BBM_OPEN &&
               corner_vertex(m, &m->contact[k]) == vertex_of(m, e, 0);
    ck_assert_int_eq(hit, clear > 0);
}
END_TEST

/* ------------------------------------------------------------------- how deep a point may start */

/* A slab of two elements over a table, its three grid points there 1 mm above it; those at its
 * ends are taken for closed in a step that ended so deep, in m, or for open. Then the slab stands
 * at y, and a step begins. */
static bbm_model *slab_at(const double depth[2], double y, int rotation)
{
    bbm_model *m = weightless_blocks();
    int n;

    m->beyond->rotation = (bbm_rotation)rotation;
    add_table(m, 0);
    add_rectangle(m, 1, ROCK, (rectangle){ .x = -1, .y = 1e-3, .w = 2, .h = 1, .nx = 2 });
    set_velocity(m, 1, 0, -0.3);
    set_velocity(m, 2, 0, -0.3);
    start_step(m, &n);
    ck_assert_int_eq(n, 3);
    for (int k = 0; k < 2; k++) {
        bbm_contact *c = find_listed(m, 1 + k, k, 0, 2);
        c->state = depth[k] > 0 ? BBM_LOCK : BBM_OPEN;
        c->d_n = -fabs(depth[k]);
        c->N = fmax(0, depth[k]) * m->par.p_n;
    }
    bbm_store_contacts(m);
    for (int k = 0; k < 2; k++) {
        shift_element(m, 1 + k, 0, y - 1e-3);
        set_velocity(m, 1 + k, 0, 0);
    }
    start_step(m, &n);
    return m;
}

/* A point of a slab may lie twice as deep in the table as the deepest closed contact of the
 * two, wherever on them that is, and no deeper; what lies deeper without being closed does not
 * count. */
static const double DEPTHS[][2] = {
    { 1e-3, -5e-3 }, { -5e-3, 1e-3 }, { 1e-3, 2e-3 }, { 2e-3, 1e-3 },
};

START_TEST(a_point_may_start_twice_as_deep_as_the_closed_contacts_of_its_blocks)
{
    const double *depth = DEPTHS[_i / 2], most = fmax(depth[0], depth[1]);
    bbm_model *m = slab_at(depth, -2 * most * (_i % 2 ? 1.01 : 0.99), BBM_EXACT);
    int listed = 0, n;
    const bbm_contact *list = list_contacts(m, &n);

    for (int k = 0; k < n; k++)
        listed += corner_vertex(m, &list[k])->x == 0;
    ck_assert_int_eq(listed, _i % 2 == 0);
    ck_near(m->info.penetration, most, most, 0);
}
END_TEST

/* Two slabs, each on a table of its own and closed 1 mm deep there, or not. Then the one stands on
 * the other's table: only if both are as deep with anything may it start 1 mm deep. */
START_TEST(a_point_may_start_as_deep_as_the_contacts_of_both_blocks)
{
    const int closed[2] = { _i % 2, _i / 2 };
    bbm_model *m = weightless_blocks();
    int n;

    for (int k = 0; k < 4; k++)
        add_rectangle(m, k, ROCK, (rectangle){ .x = 9 * (k / 2), .y = k % 2 - 1,
                                               .w = 1 - k % 2 * 0.5, .h = 1 });
    start_step(m, &n);
    for (int k = 0; k < 2; k++) {
        bbm_contact *c = find_listed(m, 2 * k + 1, 1, 2 * k, 2);
        c->state = closed[k] ? BBM_LOCK : BBM_OPEN;
        c->d_n = -1e-3;
    }
    bbm_store_contacts(m);
    shift_element(m, 1, 9.25, -1e-3);
    shift_element(m, 3, -9, 5);
    start_step(m, &n);
    ck_assert_int_eq(n, closed[0] && closed[1] ? 2 : 0);
}
END_TEST

/* Unit squares, to the last bit. One corner closed 1 mm deep: twice that and a millionth of an
 * edge is how deep both may start. Beside the end of a side, by a millionth: that still counts as
 * behind it. */
START_TEST(a_millionth_of_an_edge_is_allowed_for_to_the_last_bit)
{
    const double deep = 2 * 1e-3 + 1e-6, x = _i % 2 ? nextafter(1e-6, 1) : 1e-6;
    bbm_model *m = weightless_blocks();
    int n;

    add_rectangle(m, 0, ROCK, (rectangle){ .x = -1, .y = -1, .w = 1, .h = 1 });
    add_rectangle(m, 1, ROCK, (rectangle){ .x = -0.25, .y = 0, .w = 1, .h = 1 });
    set_velocity(m, 1, 0, -0.01);
    start_step(m, &n);
    bbm_contact *c = find_listed(m, 1, 0, 0, 2);
    c->state = _i / 2 ? BBM_OPEN : BBM_LOCK;
    c->d_n = -1e-3;
    bbm_store_contacts(m);
    for (int k = 0; k < m->contacts; k++)
        m->contact[k].state = BBM_OPEN;                 /* and has opened since */
    if (_i / 2 == 0) {
        shift_element(m, 1, 0, _i % 2 ? -nextafter(deep, 1) : -deep);
        start_step(m, &n);
        ck_assert_int_eq(n, _i % 2 ? 0 : 2);
    } else {
        set_velocity(m, 1, 1, 0);
        for (int k = 0; k < 4; k++) {
            bbm_vertex *v = &m->vertex[m->element[1].first + k];
            v->x = k == 1 || k == 2 ? x + 1 : x;
            v->y = k < 2 ? -0.01 : 0.99;
        }
        start_step(m, &n);
        ck_assert_int_eq(find_listed(m, 1, 0, 0, 2) != NULL, _i % 2);
        shift_element(m, 1, 0, 0.011);                  /* now before it */
        start_step(m, &n);
        ck_assert_int_eq(find_listed(m, 1, 0, 0, 2)->trial.beyond_end, _i % 2);
    }
}
END_TEST

/* A step in which nothing is closed ends that: then the points of the slab may not start inside. */
START_TEST(what_contacts_are_deep_is_that_of_the_last_step)
{
    bbm_model *m = slab_at(DEPTHS[0], 1e-3, BBM_EXACT);
    int n;
    bbm_contact *list = list_contacts(m, &n);

    ck_assert_int_eq(n, 3);
    for (int k = 0; k < n; k++) {
        list[k].state = BBM_OPEN;
        list[k].d_n = 0;                                /* it has opened outside */
    }
    bbm_store_contacts(m);
    for (int k = 0; k < 2; k++)
        shift_element(m, 1 + k, 0, -2.5e-3);
    start_step(m, &n);
    ck_assert_int_eq(n, 0);
}
END_TEST

/* A wedge with one side flat on a table of length l, and beside it another one. That one's contact
 * is taken for 5 mm deep; then the end of the flat side dips into the table by the given sine. If
 * both wedges are of one block, 5 mm twice over the length of the shorter of side and table is
 * what it may dip, and a hundredth; if they are of two, or the tables are, a hundredth. Both ways
 * round. */
START_TEST(a_side_may_dip_as_deep_as_contacts_over_the_shorter_of_both_sides)
{
    const int mirrored = _i % 2, way = mirrored ? -1 : 1, blocks = _i / 8;
    const double l = _i / 4 % 2 ? 0.25 : 4, most = 0.01 + (blocks ? 0 : 2 * 5e-3 / fmin(l, 1));
    const double sine = most + (_i / 2 % 2 ? 1e-4 : -1e-4), away = blocks == 2 ? -way * 9 : 0;
    const double flat[2] = { way * 0.5 * l, 0 }, beside[2] = { way * 0.1 * l + away, 0 };
    bbm_model *m = weightless_blocks();
    int n;

    add_rectangle(m, 0, ROCK, (rectangle){ .x = mirrored ? -l : 0, .y = -1, .w = l, .h = 1 });
    const rectangle own = { .x = beside[0] - l / 2, .y = -1, .w = l, .h = 1 };
    const int other = blocks == 2 ? add_rectangle(m, 3, ROCK, own) : 0;
    const double up = radians(mirrored ? 60 : 100), from = radians(mirrored ? 120 : 0);
    const int e = add_wedge(m, 1, beside, up, up + radians(20));
    const int f = add_wedge(m, blocks == 1 ? 2 : 1, flat, from, from + radians(60));
    start_step(m, &n);
    bbm_contact *c = find_listed(m, e, 0, other, 2);
    ck_assert_msg(c != NULL, "the corner of the wedge beside it is in no contact");
    c->state = BBM_LOCK;
    c->d_n = -5e-3;
    ck_assert_ptr_nonnull(find_listed(m, f, 0, 0, 2));
    bbm_store_contacts(m);
    bbm_vertex *end = &m->vertex[m->element[f].first + (mirrored ? 2 : 1)];
    end->x = flat[0] + way * sqrt(1 - sine * sine);
    end->y = -sine;
    start_step(m, &n);
    ck_assert_msg((find_listed(m, f, 0, 0, 2) != NULL) == (_i / 2 % 2 == 0),
                  "a side that dips by the sine %g %s, with at most %g in place",
                  sine, _i / 2 % 2 ? "may touch" : "may not touch", most);
}
END_TEST

/* Two wedges of one block. The one is on a table, and closes in the first look; in the second look
 * it is so deep, and the other one's tip is 1 mm deep while its side dips into the table by 0.03.
 * That tip closes if this solution is deep enough for such a dip, over sides of 1 m; the first
 * one, which was, does not count. */
START_TEST(a_side_may_dip_as_deep_as_contacts_of_the_solution)
{
    const double at[2][2] = { { -3, 0 }, { 3, 1e-3 } }, turn = -0.03;
    bbm_model *m = weightless_blocks();
    int n;

    add_table(m, 0);
    add_wedge(m, 1, at[0], radians(60), radians(120));
    add_wedge(m, 1, at[1], 0, radians(60));
    set_velocity(m, 2, 0, -1);
    start_step(m, &n);
    ck_assert_msg(look_at(m, 1, 0, -0.02) == 1, "the wedge on the table does not touch it");
    m->D[6 * 2] = turn * (at[1][1] - m->element[2].y);
    m->D[6 * 2 + 1] = -2e-3 - turn * (at[1][0] - m->element[2].x);
    m->D[6 * 2 + 2] = turn;
    look_at(m, 1, 0, _i ? -0.02 : -1e-4);
    ck_assert_msg((find_listed(m, 2, 0, 0, 2)->state != BBM_OPEN) == _i,
                  "a side that dips by 0.03 %s, with contacts %s deep", _i ? "stays open" : "closes", _i ? "20 mm" : "0.1 mm");
}
END_TEST

/* A quarter of its boundary is the size of a block. The smaller one counts, be it the one with the
 * corners or the one with the edge; of two corners the deeper one, and none that is open. A block
 * w x h comes down on a table from -5 to 5, or on one as small; it ends with its corners so deep,
 * one of them twice. */
static const struct { double table, w, h; } SIZES[] = {
    { 10, 1, 1 }, { 10, 2, 0.5 }, { 1, 4, 1 }, { 0.5, 6, 2 },
};

START_TEST(the_depth_of_a_contact_is_told_against_the_smaller_block)
{
    const double l = SIZES[_i / 4].table, w = SIZES[_i / 4].w, h = SIZES[_i / 4].h;
    const double deep = (_i % 2 ? 1.02 : 0.98) * 0.1 * fmin(l + 1, w + h) / 4;
    bbm_model *m = weightless_blocks();
    int n;

    m->beyond->rotation = BBM_LINEAR;
    add_rectangle(m, 0, ROCK, (rectangle){ .x = -l / 2, .y = -1, .w = l, .h = 1 });
    add_rectangle(m, 1, ROCK, (rectangle){ .x = -w / 2, .y = 0.01, .w = w, .h = h });
    set_velocity(m, 1, 0, -10);
    start_step(m, &n);
    m->D[6 + 1] = -0.01 - 1.5 * deep;
    m->D[6 + 2] = (_i / 2 % 2 ? 1 : -1) * deep / fmin(l, w);
    ck_ok(bbm_check_depth(m), m);
    (void)bbm_open_close(m);
    ck_assert_int_eq(bbm_check_depth(m), _i % 2 ? BBM_TOO_SOFT : BBM_OK);
}
END_TEST

/* A block of 1 m that meets its table at v m/s ends the step 0.09 or 0.11 m deep, by the momentum:
 * with 2/dt^2 of its mass and two springs p_n, v dt = deep (1 + p_n dt^2/mass). More than a tenth
 * is refused, and nothing has moved. */
START_TEST(a_contact_deeper_than_a_tenth_of_its_block_is_refused)
{
    const double deep = _i % 2 ? 0.11 : 0.09, dt = _i / 2 ? 0.01 : 0.1, p_n = 1e5;
    const double v = deep / dt * (1 + p_n * dt * dt / DENSITY);
    bbm_model *m = weightless_blocks();

    m->par.dt = dt;
    m->par.p_n = m->par.p_s = p_n;
    add_table(m, 0);
    add_rectangle(m, 1, ROCK, (rectangle){ .x = 0, .y = 0, .w = 1, .h = 1 });
    set_velocity(m, 1, 0, -v);
    ck_assert_int_eq(bbm_step(m), _i % 2 ? BBM_TOO_SOFT : BBM_OK);
    if (_i % 2) {
        ck_assert_msg(strstr(bbm_message(m), "step 1: a corner of block 1 is pressed 0.11 m into block "
                                             "0"), "%s", bbm_message(m));
        ck_assert(m->element[1].V[1] == -v && vertex_of(m, 1, 0)->y == 0 && m->info.step == 0);
    } else {
        ck_near(m->info.penetration, deep, deep, 1e-3);
    }
}
END_TEST

/* ----------------------------------------------------------- contacts that close or open inside */

/* The middle of the slab was open and starts 1 mm deep: it closes when it gets deeper, and its
 * spring counts from there, also in the next step. With the paper's update it counts from the
 * line. */
START_TEST(a_contact_that_closes_inside_starts_without_force)
{
    const int linear = _i;
    bbm_model *m = slab_at(DEPTHS[0], -1e-3, linear ? BBM_LINEAR : BBM_EXACT);
    int n;

    for (int again = 0; again < 2; again++) {
        int found = 0;
        m->D[6 + 1] = again || linear ? 0 : -1e-4;      /* both halves move */
        look_at(m, 2, 0, m->D[6 + 1]);
        bbm_contact *list = list_contacts(m, &n);
        for (int k = 0; k < n; k++) {
            bbm_contact *c = &list[k];
            if (corner_vertex(m, c)->x != 0)
                continue;
            ck_near(c->rest, linear ? 0 : -1e-3, 1e-3, ROUNDING);
            ck_assert(c->state != BBM_OPEN);
            m->D[6 + 1] = linear ? 0 : -1e-4;
            look_at(m, 2, 0, m->D[6 + 1]);
            ck_near(c->N, (linear ? 1e-3 : 1e-4) * m->par.p_n, 1e-3 * m->par.p_n, ROUNDING);
            found++;
        }
        ck_assert_int_eq(found, 1);
        bbm_store_contacts(m);
        start_step(m, &n);
    }
}
END_TEST

/* The same where it does not get deeper: no force, whatever the depth. */
START_TEST(a_point_that_stays_inside_has_no_force)
{
    bbm_model *m = slab_at(DEPTHS[0], -1e-3, BBM_EXACT);

    ck_assert_int_eq(look_at(m, 1, 0, 0), 1);           /* the end that was closed */
    ck_assert_int_eq(look_at(m, 1, 0, 0), 1);
}
END_TEST

/* A slab's end was closed 1 mm deep; it has opened inside, or outside, or was not closed. When it
 * then stands 3 mm deep, in this step and also in the one after, it may only close if it was
 * closed once and has been inside ever since; its spring counts from there. */
START_TEST(a_corner_that_opens_inside_may_close_again)
{
    const int inside = _i == 0;
    bbm_model *m = slab_at(DEPTHS[0], -3e-3, BBM_EXACT);
    int n;
    bbm_contact *c = list_contacts(m, &n);

    ck_assert_int_eq(n, 1);
    ck_assert(c->state == BBM_LOCK && c->trial.was_closed && !c->inside);
    c->trial.was_closed = _i != 1;
    for (int again = 0; again < 2; again++) {
        c->state = BBM_OPEN;
        c->N = 0;
        c->d_n = _i == 2 ? 0 : -3e-3;
        bbm_store_contacts(m);
        ck_assert_int_eq(m->contact[0].inside, inside);
        for (int k = 1; k < 3; k++)
            set_velocity(m, k, 0, -1);
        c = start_step(m, &n);
        ck_assert_int_eq(n, inside);
        if (!inside)
            break;
        ck_assert(c->state == BBM_OPEN && !c->trial.was_closed && c->inside);
        ck_near(c->rest, -3e-3, 3e-3, ROUNDING);
        ck_assert_int_eq(look_at(m, 1, 0, -1e-4), 1);
    }
}
END_TEST

/* The tip that opened inside goes out beyond the end of the side, and comes in from there: at the
 * other side. */
START_TEST(a_corner_that_left_after_it_opened_inside_comes_in_anew)
{
    const int was = _i, other = !was;
    const double out = 1e-3, deep = -6e-3;
    bbm_contact *c[2];
    bbm_model *m = tip_at(was, -1e-3, -1e-3, c);
    int n;

    c[was]->state = BBM_OPEN;
    c[was]->d_n = -1e-3;
    bbm_store_contacts(m);
    shift_element(m, 1, (was == TOP ? out : deep) + 1e-3, (was == TOP ? deep : out) + 1e-3);
    set_velocity(m, 1, -0.5, -0.5);
    start_step(m, &n);
    for (int k = 0; k < 2; k++)
        c[k] = find_listed(m, 1, 0, 0, 1 + k);
    ck_assert(c[was] && !c[was]->inside && c[other]);
    ck_assert_int_eq(look_at(m, 1, -2e-3, -2e-3), 1);
    ck_assert(c[other]->state != BBM_OPEN);
}
END_TEST

/* ---------------------------------------------------------------------- a corner that passed by */

/* The deepest of all corners in the blocks of all edges, as the check before a step has it. */
static double deepest_passed(const bbm_model *m)
{
    double most = 0;

    for (int c = 0; c < m->edges; c++)
        for (int e = 0; e < m->edges; e++)
            most = fmax(most, bbm_depth_passed(m, c, e));
    return most;
}

/* Two squares of 1 m; the right one is put with its lower left corner 1 cm deep in the left one, or
 * beside it, and goes in or out. The step after that is refused and says where, if it lies in it. All
 * this also turned. */
START_TEST(a_corner_that_passed_into_a_block_is_refused)
{
    const int kind = _i % 3;
    const double in = kind == 1 ? -0.01 : 0.01, v = kind == 2 ? 1 : -1, angle = _i / 3 * 60;
    const double c = cos(angle * PI / 180), s = sin(angle * PI / 180);
    char where[100];
    bbm_model *m = weightless_blocks();

    add_rectangle(m, 0, ROCK, (rectangle){ .w = 1, .h = 1, .angle = angle });
    const int e = add_rectangle(m, 1, ROCK, (rectangle){ .x = 1.5, .y = 0.5, .w = 1, .h = 1,
                                                         .angle = angle });
    run_steps(m, 1);
    ck_assert(deepest_passed(m) == 0);
    shift_element(m, e, (-0.5 - in) * c, (-0.5 - in) * s);
    set_velocity(m, e, v * c, v * s);
    ck_near(deepest_passed(m), kind == 1 ? 0 : in, 1, ROUNDING);
    const bbm_status status = bbm_step(m);
    ck_assert_msg(status == (kind == 1 ? BBM_OK : BBM_BLOCKS_OVERLAP), "%s", bbm_message(m));
    snprintf(where, sizeof where, "step 2: a corner of block 1 passed into block 0 at (%.9g, %.9g), "
             "0.01 m deep", 0.99 * c - 0.5 * s, 0.99 * s + 0.5 * c);
    ck_assert_msg(kind == 1 || strstr(bbm_message(m), where), "%s", bbm_message(m));
}
END_TEST

/* The corner of a fragment lies 1 cm deep in the block of the first four edges. That is right if a
 * contact of this corner with this block is closed, also if it is not the first one of the corner. */
START_TEST(each_contact_of_a_corner_may_account_for_its_depth)
{
    bbm_model *m = weightless_blocks();
    int corner = 0, behind = 0;

    add_rectangle(m, 0, ROCK, (rectangle){ .w = 1, .h = 1 });
    const int e = add_rectangle(m, 1, ROCK, (rectangle){ .x = 1.5, .y = 0.5, .w = 1, .h = 1 });
    const int third = add_rectangle(m, 2, ROCK, (rectangle){ .x = 9, .w = 1, .h = 1 });
    run_steps(m, 1);
    shift_element(m, e, -0.51, 0);
    m->beyond->broken = 1;
    while (&m->vertex[m->edge[corner].a] != vertex_of(m, e, 0))
        corner++;
    bbm_contact list[2] = { { .corner = corner, .edge = vertex_of(m, third, 0)->edge },
                            { .corner = corner, .edge = 0, .d_n = -0.01 } };
    bbm_contact *const own = m->contact;
    for (int k = 0; k < m->edges; k++)
        m->edge[k].contact = k == corner ? 0 : 2;
    m->contact = list;
    m->contacts = 2;
    for (int f = 0; f < 4; f++) {
        list[1].state = BBM_OPEN;
        const double depth = bbm_depth_passed(m, corner, f);
        ck_assert(depth == 0 || fabs(depth - 0.01) < ROUNDING);
        behind += depth > 0;
        list[1].state = BBM_LOCK;
        ck_assert(bbm_depth_passed(m, corner, f) == 0);
    }
    ck_assert_int_gt(behind, 0);
    m->contact = own;
    m->contacts = 0;
}
END_TEST

/* The left tip of a square on its tip is 1 cm below the top of another square. It can come in over the right side alone,
 * which is 30 cm away: it has come over that, unless that is too far. */
START_TEST(a_corner_that_passed_has_come_over_a_near_side)
{
    const double tip[4][2] = { { 0.7, 1.99 }, { 1, 1.69 }, { 1.3, 1.99 }, { 1, 2.29 } };
    bbm_model *m = weightless_blocks();
    int over[2];

    add_rectangle(m, 0, ROCK, (rectangle){ .w = 1, .h = 1 });
    add_polygon(m, 1, 4, tip);
    prepare(m);
    shift_element(m, 1, 0, -1);
    const int corner = bbm_edge_at(m, m->element[1].first), side = bbm_edge_at(m, m->element[0].first);
    for (int far = 0; far < 2; far++)
        for (int e = 0; e < 4; e++) {
            const double depth = bbm_depth_behind(m, corner, e, far ? 1 : 0.1, &over[far]);
            ck_assert(depth == 0 || fabs(depth - 0.01) < ROUNDING);
        }
    ck_assert_int_eq(side, 0);
    ck_assert_int_eq(over[0], 2);
    ck_assert_int_eq(over[1], 1);
}
END_TEST

/* A fragment that came off 15 cm deep in a square of 1 m is pressed by 1 mm, or by 15 cm from the surface. */
START_TEST(a_contact_is_too_soft_by_how_far_it_is_pressed)
{
    bbm_model *m = weightless_blocks();

    add_rectangle(m, 0, ROCK, (rectangle){ .w = 1, .h = 1 });
    add_rectangle(m, 1, ROCK, (rectangle){ .x = 1, .w = 1, .h = 1 });
    set_velocity(m, 1, -1e-3, 0);
    run_steps(m, 1);
    ck_assert_int_gt(m->info.contacts, 0);
    bbm_contact list[1] = { m->contact[0] };
    bbm_contact *const own = m->scratch->contact;
    list->state = BBM_LOCK;
    list->d_n = -0.15;
    m->scratch->contact = list;
    m->scratch->contacts = 1;
    list->rest = -0.149;
    ck_assert_int_eq(bbm_check_depth(m), BBM_OK);
    list->rest = 0;
    ck_assert_int_eq(bbm_check_depth(m), BBM_TOO_SOFT);
    ck_assert_msg(strstr(bbm_message(m), "is pressed 0.15 m into block"), "%s", bbm_message(m));
    m->scratch->contact = own;
    m->scratch->contacts = 0;
}
END_TEST

/* A corner passes while a third block presses on one of the two, with corners of its own or on theirs:
 * what it touches does not hold the corner. */
START_TEST(a_contact_with_a_third_block_accounts_for_no_corner_that_passed)
{
    const int upper = _i % 2, wider = _i / 2;           /* it lies on block 1, or under block 0 */
    const double w = wider ? 1.2 : 0.6;
    bbm_model *m = weightless_blocks();

    add_rectangle(m, 0, ROCK, (rectangle){ .w = 1, .h = 1 });
    const int e = add_rectangle(m, 1, ROCK, (rectangle){ .x = 1.5, .y = 0.3, .w = 1, .h = 0.5 });
    const int third = add_rectangle(m, 2, ROCK, (rectangle){
        .x = (upper ? 2 : 0.5) - w / 2, .y = upper ? 0.8 : -1, .w = w, .h = 1 });
    set_velocity(m, third, 0, upper ? -0.1 : 0.1);
    run_steps(m, 1);
    ck_assert_int_eq(m->info.contacts, 2);
    ck_assert_int_eq(corner_block(m, &m->contact[0]), wider ? upper : 2);
    shift_element(m, e, 0.99 - vertex_of(m, e, 0)->x, 0);
    set_velocity(m, e, -1, 0);
    ck_near(deepest_passed(m), 0.01, 0.01, 0.01);   /* the push turns it by less than 1e-4 */
    ck_assert_int_eq(bbm_step(m), BBM_BLOCKS_OVERLAP);
}
END_TEST

/* Three blocks meet in long steps, and a solution of the third would let a corner of one pass into
 * another, with no contact closed between them: it is cut, and no step begins with a corner inside. */
START_TEST(a_solution_that_lets_a_corner_pass_is_cut)
{
    const double x[11][2] = {
        { -0.792752, 0.609545 }, { -0.609545, -0.792752 }, { 0.792752, -0.609545 }, { 0.609545, 0.792752 },
        { 1.442595, 0.706092 }, { 2.856767, 0.695302 }, { 2.867557, 2.109474 }, { 1.453385, 2.120264 },
        { 1.074221, 2.020373 }, { 1.014549, 3.724230 }, { -0.431198, 2.820625 },
    }, V[3][3] = { { 0, 0, -2.757 }, { -1.16, 0.2009, -0.06763 }, { 0, -1.16, -0.00695 } };
    bbm_model *m = beyond_model();
    int cuts = 0;

    m->par = (bbm_parameters){ .dt = 0.211, .steps = 1, .velocity_factor = 1, .alpha = 1000, .faces = 1,
                               .p_n = 5.356e8, .p_s = 0.4 * 5.356e8, .friction = 10, .pcg = m->par.pcg };
    bbm_add_material(m, &(bbm_material){ .E = 1.306e5, .nu = 0.2, .density = 2500, .thickness = 1 }, NULL);
    for (int n = 0; n < 11; n++)
        bbm_add_node(m, x[n][0], x[n][1], NULL);
    for (int b = 0; b < 3; b++)
        bbm_add_element(m, b, 0, b < 2 ? 4 : 3, (int[]){ 4 * b, 4 * b + 1, 4 * b + 2, 4 * b + 3 }, NULL);
    ck_ok(bbm_prepare(m), m);
    for (int b = 0; b < 3; b++)
        memcpy(m->element[b].V, V[b], sizeof V[b]);
    for (int k = 0; k < 3; k++) {
        ck_ok(bbm_step(m), m);
        cuts += m->info.cuts;
    }
    ck_assert_int_gt(cuts, 0);
    ck_assert(deepest_passed(m) == 0);
}
END_TEST

/* A stone in the hole of a ring, whose wall of 2 mm is thinner than its way of 3 cm in a step: its
 * corners are behind the ring's outer edges and in none of its elements. In the wall they are. */
START_TEST(a_stone_in_a_hole_is_not_in_the_ring)
{
    const double out[4][2] = { { -1, -1 }, { 1, -1 }, { 1, 1 }, { -1, 1 } }, wall = 2e-3;
    bbm_model *m = weightless_blocks();

    for (int k = 0; k < 8; k++)
        bbm_add_node(m, out[k % 4][0] * (k < 4 ? 1 : 1 - wall),
                     out[k % 4][1] * (k < 4 ? 1 : 1 - wall), NULL);
    for (int k = 0; k < 4; k++)
        bbm_add_element(m, 7, ROCK, 4, (int[]){ k, (k + 1) % 4, 4 + (k + 1) % 4, 4 + k }, NULL);
    const int e = add_rectangle(m, 1, ROCK, (rectangle){ .x = 0.89, .w = 0.1, .h = 0.1 });
    set_velocity(m, e, 3, 0);
    detect(m);
    ck_assert_int_lt(m->beyond->passed[0], 0);
    ck_assert(deepest_passed(m) == 0);
    shift_element(m, e, 8.5e-3, 0);                     /* 0.5 mm from the inner side of the wall */
    ck_near(deepest_passed(m), 5e-4, 1, ROUNDING);
}
END_TEST

Suite *entrance_suite(void)
{
    Suite *s = suite_create("entrance");

    add_case(s, "hits",
        { what_hits_an_edge_is_a_corner_with_its_foot_on_it, 4 },
        { a_block_that_falls_past_the_end_of_a_table_does_not_notice_it, 2 },
        { a_corner_is_stopped_though_a_far_one_under_the_same_side_is_not_reached, 2 },
        { a_block_that_moves_further_than_foreseen_does_not_pass_through_a_wall, 1 },
        { a_side_may_turn_out_of_an_edge_while_its_corner_is_outside, 2 },
        { the_end_of_an_edge_belongs_to_it, 4 },
        { a_tip_that_turns_far_hits_if_its_sides_are_clear_at_the_end, 4 });
    add_case(s, "entering",
        { a_corner_that_turns_towards_an_edge_in_the_step_is_stopped_by_it, 2 * COUNT(ANGLES) },
        { a_corner_that_a_load_turns_towards_an_edge_in_the_step_is_stopped_by_it, 2 },
        { a_side_may_dip_as_deep_as_contacts_over_the_shorter_of_both_sides, 24 },
        { a_side_may_dip_as_deep_as_contacts_of_the_solution, 2 });
    add_case(s, "loop", { a_side_may_dip_as_deep_as_contacts_of_the_solution, 2 });
    add_case(s, "depth",
        { a_point_may_start_twice_as_deep_as_the_closed_contacts_of_its_blocks, 2 * COUNT(DEPTHS) },
        { a_point_may_start_as_deep_as_the_contacts_of_both_blocks, 4 },
        { a_millionth_of_an_edge_is_allowed_for_to_the_last_bit, 4 },
        { what_contacts_are_deep_is_that_of_the_last_step, 1 },
        { the_depth_of_a_contact_is_told_against_the_smaller_block, 4 * COUNT(SIZES) },
        { a_contact_deeper_than_a_tenth_of_its_block_is_refused, 4 });
    add_case(s, "inside",
        { a_contact_that_closes_inside_starts_without_force, 2 },
        { a_point_that_stays_inside_has_no_force, 1 },
        { a_corner_that_opens_inside_may_close_again, 3 },
        { a_corner_that_left_after_it_opened_inside_comes_in_anew, 2 });
    add_case(s, "passed",
        { a_corner_that_passed_into_a_block_is_refused, 9 },
        { each_contact_of_a_corner_may_account_for_its_depth, 1 },
             { a_corner_that_passed_has_come_over_a_near_side, 1 },
             { a_contact_is_too_soft_by_how_far_it_is_pressed, 1 },
        { a_contact_with_a_third_block_accounts_for_no_corner_that_passed, 4 },
        { a_solution_that_lets_a_corner_pass_is_cut, 1 },
        { a_stone_in_a_hole_is_not_in_the_ring, 1 });
    return s;
}
