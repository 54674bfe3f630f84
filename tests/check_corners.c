/* check_corners.c - section 3.7, corners on corners: which of two lines is the entrance line. */
#include "check.h"
#include "models.h"

/* --------------------------------------------------------------------------- corners on corners */

/* A unit square at rest below and to the left of (5, 3), and one that comes from the upper right,
 * corner against corner, 1 cm away, at `vx` and `vy` m/s. All of this turned by `angle`; the moving
 * block is given first or last. */
static bbm_model *corner_to_corner(double vx, double vy, double angle, int moving_first,
                                   int *moving)
{
    const double c = cos(radians(angle)), s = sin(radians(angle));
    bbm_model *m = weightless_blocks();

    if (!moving_first)
        add_rectangle(m, 0, ROCK, (rectangle){ 4, 2, 1, 1, angle, .fixed = 0 });
    *moving = add_rectangle(m, 1, ROCK, (rectangle){ 5.01, 3.01, 1, 1, angle, .fixed = 0 });
    if (moving_first)
        add_rectangle(m, 0, ROCK, (rectangle){ 4, 2, 1, 1, angle, .fixed = 0 });
    set_velocity(m, *moving, c * vx - s * vy, s * vx + c * vy);
    return m;
}

/* The velocity after some steps in the frame that turned with the blocks. */
static void velocity_in_frame(const bbm_model *m, int e, double angle, double v[2])
{
    const double c = cos(radians(angle)), s = sin(radians(angle));

    v[0] = c * m->element[e].V[0] + s * m->element[e].V[1];
    v[1] = -s * m->element[e].V[0] + c * m->element[e].V[1];
}

/* Whether all closed contacts lie on edges along the given axis of the frame: the two ends of one
 * overlap. */
static int closed_along(const bbm_model *m, double angle, int axis)
{
    const double t[2] = { cos(radians(angle + 90 * axis)), sin(radians(angle + 90 * axis)) };
    int closed = 0;

    for (int k = 0; k < m->contacts; k++) {
        const bbm_edge *e = &m->edge[m->contact[k].edge];
        const double x = m->vertex[e->b].x - m->vertex[e->a].x;
        const double y = m->vertex[e->b].y - m->vertex[e->a].y;
        if (m->contact[k].state == BBM_OPEN)
            continue;
        if (fabs(x * t[1] - y * t[0]) > 0.1)
            return 0;
        closed++;
    }
    return closed > 0;
}

/* By theory the push of the first step is normal to the edge as it lies in the middle of the step:
 * of the change of velocity, in the frame of the blocks, what is along it. */
static double push_along_the_edge(const bbm_model *m, int e, double angle,
                                  const double before[2], int axis)
{
    double v[2], turn = NAN;

    for (int k = 0; k < m->contacts; k++)
        if (m->contact[k].state != BBM_OPEN)
            turn = m->element[m->edge[m->contact[k].edge].element].D[2] / 2;
    velocity_in_frame(m, e, angle, v);
    const double x = v[0] - before[0], y = v[1] - before[1];
    return axis == 0 ? x * cos(turn) + y * sin(turn) : y * cos(turn) - x * sin(turn);
}

/* It crosses both lines of entrance in the first step, from the same distance; the upright one last
 * (or the flat one), which it also crosses less deep. It is pushed back along x (or y) alone. 1e-6:
 * as far as the vectors of the step are renewed. */
START_TEST(two_corners_that_meet_leave_by_the_line_crossed_last)
{
    const int upright = _i % 2;
    const double vx = upright ? -4 : -3, vy = upright ? -3 : -4;

    for (int k = 0; k < 2 * COUNT(ANGLES); k++) {
        const double angle = ANGLES[k / 2];
        int e;
        double v[2];
        bbm_model *m = corner_to_corner(vx, vy, angle, k % 2, &e);
        run_steps(m, 1);
        ck_assert(closed_along(m, angle, upright ? 0 : 1));
        ck_near(push_along_the_edge(m, e, angle, (double[]){ vx, vy }, upright ? 0 : 1),
                0, 4, 1e-6);
        run_steps(m, 4);
        velocity_in_frame(m, e, angle, v);
        ck_assert(v[upright ? 1 : 0] > -2.5);                   /* slower than before */
        release(m);
    }
}
END_TEST

/* A corner that comes down on a corner: left of it, it meets the top, and the push is upright;
 * right of it, the lower corner meets the slanting side, and the push is normal to that. The block
 * is too fast to be turned in the one step. */
START_TEST(a_corner_beside_a_corner_meets_the_side_that_lies_there)
{
    const double x = _i ? 5.02 : 4.98;
    const double diamond[4][2] = { { x, 0.01 }, { x + 1, 1.01 }, { x, 2.01 }, { x - 1, 1.01 } };
    bbm_model *m = weightless_blocks();

    add_rectangle(m, 0, BASE, (rectangle){ .x = 4, .y = -1, .w = 1, .h = 1, .fixed = 1 });
    const int e = add_polygon(m, 1, 4, diamond);
    set_velocity(m, e, 0, -4);
    run_steps(m, 1);
    ck_assert_int_eq(m->info.contacts, 1);
    for (int k = 0; k < m->contacts; k++)
        if (m->contact[k].state != BBM_OPEN)
            ck_assert_int_eq(corner_block(m, &m->contact[k]), _i ? 0 : 1);
    const double *V = m->element[e].V;
    ck_assert(V[1] > -4 + 1e-3);
    ck_near(V[0], _i ? V[1] + 4 : 0, 8, 0.01);  /* as the side turns in the impact, 1 % */
}
END_TEST

/* Whether r is another line on which the corner P of contact c and an end Q of its edge can enter
 * each other, as they stand: a contact of P with the other edge of Q, or of Q with an edge of P,
 * not parallel to the first one. */
static int is_other_line(const bbm_model *m, const bbm_contact *c, const bbm_vertex *Q,
                         const bbm_contact *r)
{
    const bbm_vertex *P = corner_vertex(m, c), *a = start_of(m, r->edge), *b = end_of(m, r->edge);
    const double x = end_of(m, c->edge)->x - start_of(m, c->edge)->x;
    const double y = end_of(m, c->edge)->y - start_of(m, c->edge)->y;
    const int p = corner_vertex(m, r)->node, q = p == P->node ? Q->node : P->node;
    double beyond, clear;

    stand(m, r, &beyond, &clear);
    return (p == P->node || p == Q->node) && (a->node == q || b->node == q) && clear >= -0.01
           && fabs(x * (b->y - a->y) - y * (b->x - a->x)) >
              0.01 * hypot(x, y) * hypot(b->x - a->x, b->y - a->y);
}

/* Fails unless the entrance lines of each contact, two at each end of its edge, are these, as
 * far as they can be entered as the corners stand. Their number. */
static int check_entrances(const bbm_model *m)
{
    int others = 0;

    for (int k = 0; k < m->contacts; k++)
        for (int end = 0; end < 2; end++) {
            const bbm_contact *c = &m->contact[k];
            const bbm_vertex *Q = end ? end_of(m, c->edge) : start_of(m, c->edge);
            int lines = 0, found = 0;
            for (int r = 0; r < m->contacts; r++)
                lines += is_other_line(m, c, Q, &m->contact[r]);
            for (int r = 2 * end; r < 2 * end + 2; r++)
                found += c->trial.entrance[r] >= 0 && is_other_line(m, c, Q, &m->contact[c->trial.entrance[r]]);
            ck_assert_int_eq(found, lines);
            ck_assert(c->trial.entrance[2 * end] < 0 || c->trial.entrance[2 * end] != c->trial.entrance[2 * end + 1]);
            for (int r = 2 * end; r < 2 * end + 2; r++)
                ck_assert(c->trial.entrance[r] < 0 || is_other_line(m, c, Q, &m->contact[c->trial.entrance[r]]));
            others += lines;
        }
    return others;
}

/* Two unit squares corner against corner, block 1 above and to the right of block 0 or to the left,
 * 1 cm away: each corner may meet two edges of the other block, along two entrance lines.
 * In a heap of polygons all corners that are near enough have such lines. */
START_TEST(the_two_lines_between_two_corners_are_entrance_lines)
{
    for (int k = 0; k < 2 * COUNT(ANGLES); k++) {
        bbm_model *m = new_blocks();
        add_rectangle(m, 0, ROCK, (rectangle){ 4, 2, 1, 1, ANGLES[k / 2], .fixed = 0 });
        const double x = k % 2 ? 5.01 : 2.99;
        const int e = add_rectangle(m, 1, ROCK, (rectangle){ x, 3.01, 1, 1, ANGLES[k / 2],
                                                             .fixed = 0 });
        set_velocity(m, e, _i ? 2 : -2, 0);
        detect(m);
        ck_assert_int_eq(m->contacts, 4);
        ck_assert_int_eq(check_entrances(m), 8);
        release(m);
    }
}
END_TEST

START_TEST(entrance_lines_in_a_heap_are_all_other_lines_between_two_corners)
{
    unsigned seed = (unsigned)_i;
    bbm_model *m = new_blocks();

    for (int b = 0; b < BLOCKS; b++) {
        const outline o = random_outline(0, 1.1 * (b % COLUMNS), 1.1 * (b / COLUMNS), &seed);
        add_outline(m, b, &o, 0);
    }
    prepare_apart(m);
    for (int e = 0; e < m->elements; e++)
        set_velocity(m, e, 10 * random_number(&seed), 10 * random_number(&seed));
    detect(m);
    ck_assert_int_gt(check_entrances(m), 20);
}
END_TEST

/* A square's corner Q and the lowest corner P of a diamond, with P beyond the end of the square's
 * top by x and below it by y; the contact of P with the top has been closed. P has left it when Q
 * is outside the diamond's lower side. As Q is still inside, or just on it, it has not. On the
 * right end, and mirrored on the left one; either block first. */
static const struct { double x, y; bbm_contact_state then; } PASSED[] = {
    { 0.015625, 0.03125, BBM_LOCK }, { 0.015625, 0.015625, BBM_LOCK },
    { 0.03125, 0.015625, BBM_OPEN },
};

START_TEST(a_closed_contact_lasts_until_its_corner_has_left_past_the_other_one)
{
    const double side = _i % 2 ? 1 : -1, x = side * (1 + PASSED[_i / 4].x), y = -PASSED[_i / 4].y;
    const double diamond[4][2] = { { x, y }, { x + 1, y + 1 }, { x, y + 2 }, { x - 1, y + 1 } };
    const int square_first = _i / 2 % 2;
    bbm_model *m = weightless_blocks();
    int found = 0;

    if (square_first)
        add_rectangle(m, 0, ROCK, (rectangle){ .x = -1, .y = -2, .w = 2, .h = 2 });
    const int e = add_polygon(m, 1, 4, diamond);
    if (!square_first)
        add_rectangle(m, 0, ROCK, (rectangle){ .x = -1, .y = -2, .w = 2, .h = 2 });
    prepare_apart(m);
    set_velocity(m, e, 0, -4);
    for (int again = 0; again < 2; again++) {
        int n;
        bbm_contact *list = start_step(m, &n);
        for (int k = 0; k < n; k++)
            if (corner_vertex(m, &list[k]) == vertex_of(m, e, 0)) {
                ck_assert_int_eq(list[k].state, again ? PASSED[_i / 4].then : BBM_OPEN);
                list[k].state = BBM_LOCK;
                list[k].d_n = y;
                found++;
            }
        bbm_store_contacts(m);
    }
    ck_assert_int_eq(found, 2);
}
END_TEST

/* A block that overhangs the end of a table: its corner P is on the table, the table's corner Q on
 * its underside. The one is closed, the other open, and stays so. */
START_TEST(the_ends_of_a_joint_open_and_close_by_themselves)
{
    bbm_model *m = new_blocks();

    add_table(m, 0);
    add_rectangle(m, 1, ROCK, (rectangle){ .x = 4, .y = 0, .w = 2, .h = 1 });
    detect(m);
    ck_assert_int_eq(m->contacts, 2);
    m->info.step = 1;
    for (int closed = 0; closed < 2; closed++) {
        for (int k = 0; k < 2; k++)
            m->contact[k].state = corner_block(m, &m->contact[k]) == closed ? BBM_LOCK : BBM_OPEN;
        detect(m);
        ck_assert_int_eq(m->contacts, 2);
        for (int k = 0; k < 2; k++)
            ck_assert_int_eq(m->contact[k].state,
                             corner_block(m, &m->contact[k]) == closed ? BBM_LOCK : BBM_OPEN);
    }
}
END_TEST

/* Both lower corners of a block are closed on a table, near its end. Then the block stands 0.5 m
 * further, with one of them 0.25 m beyond the end: the table's corner, on the block's underside,
 * takes its forces over. */
START_TEST(the_other_corner_takes_over_the_force_when_one_has_left)
{
    const double side = _i % 2 ? 1 : -1;
    bbm_model *m = new_blocks();
    int found = 0;

    add_table(m, 0);
    const int e = add_rectangle(m, 1, ROCK, (rectangle){ .x = side * 4.25 - 0.5, .y = 0,
                                                         .w = 1, .h = 1 });
    detect(m);
    ck_assert_int_eq(m->contacts, 2);
    for (int k = 0; k < 2; k++) {
        const int outer = side * corner_vertex(m, &m->contact[k])->x > 4.5;
        m->contact[k].state = BBM_LOCK;
        m->contact[k].N = outer ? 100 : 50;
        m->contact[k].T = outer ? -10 : -5;
    }
    for (int v = 0; v < 4; v++)
        m->vertex[m->element[e].first + v].x += side * 0.5;
    detect(m);
    ck_assert_int_eq(m->contacts, 2);
    for (int k = 0; k < 2; k++) {
        const bbm_contact *c = &m->contact[k];
        const int Q = corner_block(m, c) == 0;
        ck_assert_int_eq(c->state, BBM_LOCK);
        ck_near(c->N, Q ? 100 : 50, 1, 0);
        ck_near(c->T, Q ? -10 : -5, 1, 0);
        found += Q;
    }
    ck_assert_int_eq(found, 1);
}
END_TEST

/* A block overhangs the end of a table: its corner is closed on the table, and the table's corner
 * on its underside. Then it lies on the table by a ten-millionth only, corner on corner: of the two
 * that have become one contact one stays. */
START_TEST(of_two_closed_contacts_that_meet_corner_on_corner_one_stays)
{
    for (int k = 0; k < 2 * COUNT(ANGLES); k++) {
        const double side = k % 2 ? 1 : -1, c = cos(radians(ANGLES[k / 2]));
        const double s = sin(radians(ANGLES[k / 2]));
        bbm_model *m = new_blocks();
        int closed = 0;
        add_rectangle(m, 0, BASE, (rectangle){ -5, -1, 10, 1, ANGLES[k / 2], .fixed = 1 });
        const int e = add_rectangle(m, 1, ROCK, (rectangle){ side * 5 - 0.5, 0, 1, 1, ANGLES[k / 2],
                                                             .fixed = 0 });
        detect(m);
        ck_assert_int_eq(m->contacts, 2);
        m->contact[0].state = m->contact[1].state = BBM_LOCK;
        for (int v = 0; v < 4; v++) {
            m->vertex[m->element[e].first + v].x += side * c * (0.5 - 1e-7);
            m->vertex[m->element[e].first + v].y += side * s * (0.5 - 1e-7);
        }
        detect(m);
        for (int i = 0; i < m->contacts; i++)
            closed += m->contact[i].state == BBM_LOCK;
        ck_assert_int_eq(closed, 1);
        release(m);
    }
}
END_TEST

/* A square's corner Q, and a corner P of another one, tilted by 0.05 rad the one way, that turns by
 * 0.1 rad to the other way while it comes: which of the four pairs are contacts has changed by the
 * end, where P is 2 cm left of Q's right side and 3 cm or 1 cm below its top. One contact closes,
 * on the line along which they are less deep. The same where a wall stands on Q's square. */
START_TEST(corners_that_turn_past_each_other_close_one_contact)
{
    const double turn = _i % 2 ? 0.1 : -0.1, deep = _i / 2 % 2 ? 0.01 : 0.03;
    const double wall[6][2] = { { 4, 2 }, { 5, 2 }, { 5, 3 }, { 4.2, 3 }, { 4.2, 4 }, { 4, 4 } };
    const double start[2] = { 5.02, 3.02 };
    const outline corner = { 4, { { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 } } };
    const outline o = put(&corner, -turn / 2, start[0], start[1]);
    double u[2];
    bbm_model *m = new_blocks();
    int closed = 0, n;

    if (_i / 4)
        add_polygon(m, 0, 6, wall);
    else
        add_rectangle(m, 0, ROCK, (rectangle){ .x = 4, .y = 2, .w = 1, .h = 1 });
    const int e = add_polygon(m, 1, 4, o.x);
    set_velocity(m, e, -10, -10);
    m->element[e].V[2] = turn / m->par.dt;
    start_step(m, &n);
    m->D[6 * e + 2] = turn;
    bbm_move(bbm_motion_of(m), &m->element[e], &m->D[6 * e], start[0], start[1], u);
    m->D[6 * e] = 4.98 - start[0] - u[0];
    m->D[6 * e + 1] = 3 - deep - start[1] - u[1];
    (void)bbm_open_close(m);
    bbm_store_contacts(m);
    for (int k = 0; k < m->contacts; k++) {
        const bbm_vertex *a = start_of(m, m->contact[k].edge), *b = end_of(m, m->contact[k].edge);
        if (m->contact[k].state == BBM_OPEN)
            continue;
        ck_assert_int_eq(fabs(b->x - a->x) > fabs(b->y - a->y), _i / 2 % 2);
        closed++;
    }
    ck_assert_int_eq(closed, 1);
}
END_TEST

/* A square of 2 cm flies at another one, 3, 10 or 50 cm in a step, spins or not; their middles
 * would come as near as half a side. That one is free or fixed. It is pushed back by a tenth of its
 * speed or more, the same whichever block comes first, and no energy is made. 1e-6: the vectors of
 * a step; 1e-4: that, grown in the parts of a hit. */
START_TEST(no_shot_passes_through_a_small_block)
{
    const outline square = { 4, { { -0.01, -0.01 }, { 0.01, -0.01 }, { 0.01, 0.01 },
                                  { -0.01, 0.01 } } };
    const double way = ((double[]){ 0.03, 0.1, 0.5 })[_i % 3], v = way / 0.01;
    unsigned seed = 1 + (unsigned)_i;

    for (int k = 0; k < 20; k++) {
        const double from = 0.04 + way * (1 + random_number(&seed)) / 2;
        const double y = 0.01 * random_number(&seed), w = _i / 3 % 2 * 50 * random_number(&seed);
        const outline shot = put(&square, PI * random_number(&seed), -from, y);
        const double angle = 180 * random_number(&seed);
        double u[2];
        for (int first = 0; first < 2; first++) {
            bbm_model *m = weightless_blocks();
            if (first)
                add_outline(m, 0, &shot, 0);
            add_rectangle(m, 1, ROCK, (rectangle){ -0.01, -0.01, 0.02, 0.02, angle,
                                                   .fixed = _i / 6 });
            if (!first)
                add_outline(m, 0, &shot, 0);
            ck_ok(bbm_prepare(m), m);
            bbm_element *e = &m->element[!first];
            bbm_energy before, after;
            e->V[0] = v;
            e->V[2] = w;
            bbm_energies(m, &before);
            run_steps(m, 2 + (int)(2 * from / way));
            bbm_energies(m, &after);
            ck_assert_msg(e->V[0] < 0.9 * v, "shot %d: %g of %g m/s", k, e->V[0], v);
            ck_assert(after.kinetic + after.elastic + after.springs < before.kinetic * (1 + 1e-6));
            u[first] = e->V[0];
            release(m);
        }
        ck_near(u[0], u[1], v, 1e-4);
    }
}
END_TEST

/* A bar of 4 m makes a whole turn in a step, under a fixed stone that its ends sweep, or that is
 * too far away. It hits the stone, or keeps its energy. */
START_TEST(a_block_that_turns_far_in_a_step_meets_what_it_sweeps)
{
    bbm_model *m = weightless_blocks();
    bbm_energy before, after;

    m->par.dt = 1;
    add_rectangle(m, 0, ROCK, (rectangle){ -2, 0, 4, 0.2, .fixed = 0 });
    add_rectangle(m, 1, ROCK, (rectangle){ -0.2, _i ? 2.5 : 0.5, 0.4, 0.5, .fixed = 1 });
    ck_ok(bbm_prepare(m), m);
    m->element[0].V[2] = 2 * PI;
    bbm_energies(m, &before);
    run_steps(m, 1);
    bbm_energies(m, &after);
    if (_i)
        ck_near(after.kinetic, before.kinetic, before.kinetic, SOLVED);
    else
        ck_assert(fabs(m->element[0].V[2]) < 0.9 * 2 * PI);
}
END_TEST

/* ------------------------------------------------------------------------------- entrance lines */

/* The flatter of the lines p and q of a wedge counts, whose outward normals are p - 90 degrees and
 * q + 90 degrees; of two as steep the one that faces up, or to the right. */
static double line_that_counts(double p, double q)
{
    const double flatter = fabs(cos(p)) - fabs(cos(q)), up = -cos(p) - cos(q), right = sin(p) + sin(q);

    if (fabs(flatter) > 0.01)
        return flatter > 0 ? p : q;
    return (fabs(up) > 0.01 ? up : right) > 0 ? p : q;
}

/* A tip that moves from the direction a through the tip of a wedge of 100 degrees crosses all
 * lines of both at once. If it is 40 degrees wide it can come in at both sides of the wedge, which
 * lie at a + 50 and a - 50; if it is 80 and lies to the right, at one side of each, at a + 50 and
 * a - 60. Of these two lines one counts, in whatever order the blocks are, whichever of them moves
 * and wherever gravity points, which is here too small to move anything; at a + 50 and a - 60 the
 * one that it crosses at the smaller angle, for it leaves the rounding of that one last. */
START_TEST(of_two_lines_crossed_at_the_same_time_one_counts_at_any_angle)
{
    const int askew = _i / 4, first = _i / 2 % 2, other_moves = _i % 2;
    const double shifts[5] = { 0, 0.002, -0.002, 0.02, -0.02 };

    for (int k = 0; k < 5 * 72; k++) {
        const double a = radians(5 * (k / 5)) + shifts[k % 5], wide = radians(50);
        const double way = 0.01 * (other_moves ? -1 : 1);
        const double g = radians(k % 3 * 40);               /* without gravity, or turned by g  */
        const double expected = askew ? a + radians(50)
                                      : g + line_that_counts(a + radians(50) - g, a - radians(50) - g);
        const double at[2][2] = { { 0, 0 }, { 0.01 * cos(a), 0.01 * sin(a) } };
        bbm_model *m = weightless_blocks();
        int e[2], n;
        m->par.gravity[0] = g > 0 ? 1e-9 * sin(g) : 0;
        m->par.gravity[1] = g > 0 ? -1e-9 * cos(g) : 0;
        for (int b = 0; b < 2; b++) {
            const int tip = b ^ first;
            e[tip] = tip ? add_wedge(m, b, at[1], a - radians(askew ? 60 : 20), a + radians(20))
                         : add_wedge(m, b, at[0], a + PI - wide, a + PI + wide);
        }
        const int moves = e[!other_moves];
        set_velocity(m, moves, -2 * way / m->par.dt * cos(a), -2 * way / m->par.dt * sin(a));
        bbm_contact *list = start_step(m, &n);
        ck_assert_int_eq(look_at(m, moves, -2 * way * cos(a), -2 * way * sin(a)), 1);
        for (int c = 0; c < n; c++)
            if (list[c].state != BBM_OPEN) {
                const bbm_vertex *p = start_of(m, list[c].edge), *q = end_of(m, list[c].edge);
                ck_near((q->x - p->x) * sin(expected) - (q->y - p->y) * cos(expected), 0, 1, 1e-9);
            }
        release(m);
    }
}
END_TEST

/* The tip is inside both lines, 1 mm from each, or it is deep behind the one that is closed. The
 * first solution lifts it out, the second puts it back: the contact that was closed closes again,
 * and no other one, whichever line is flatter. Without friction it is locked or slides. */
START_TEST(a_contact_that_opens_in_one_pass_and_comes_back_keeps_its_line)
{
    const int side = _i % 2, deep = _i / 2;
    const double x = deep && side == RIGHT ? -6e-3 : -1e-3, y = deep && side == TOP ? -6e-3 : -1e-3;
    bbm_contact *c[2];
    bbm_model *m = tip_at(side, x, y, c);

    ck_assert(c[side] && c[side]->state == BBM_LOCK && c[side]->trial.was_closed && c[side]->rest == 0);
    ck_assert(c[!side] && c[!side]->state == BBM_OPEN && !c[!side]->trial.was_closed);
    ck_assert_int_eq(look_at(m, 1, 0.01, 0.01), 0);
    ck_assert_int_eq(look_at(m, 1, 0, 0), 1);
    ck_assert(c[side]->state != BBM_OPEN && c[!side]->state == BBM_OPEN);
    ck_assert_int_eq(look_at(m, 1, 0, 0), 1);
    ck_relative(c[side]->N, (deep ? 6e-3 : 1e-3) * m->par.p_n, 1e-12);
}
END_TEST

/* Beyond the end of the side that was closed, and deeper under it than contacts are: nothing comes
 * in there from behind. The tip comes in at the other side, which it crosses, whether it starts
 * before that or, but for rounding, on it. */
START_TEST(nothing_comes_in_from_behind)
{
    const int other = _i % 2, was = !other;
    const double out = _i / 2 ? 1e-3 : 2e-8, deep = -6e-3;
    bbm_contact *c[2];
    bbm_model *m = tip_at(was, was == TOP ? out : deep, was == TOP ? deep : out, c);

    ck_assert(c[was] && c[was]->state == BBM_OPEN && !c[was]->trial.was_closed);
    ck_assert(c[was]->rest == c[was]->trial.d_n0);             /* nor would it have a force there */
    ck_assert_int_eq(look_at(m, 1, -2e-3, -2e-3), 1);
    ck_assert(c[other]->state != BBM_OPEN);
}
END_TEST

/* A tip beside a square, 15 mm lower than its top, comes up past the square's corner and then goes
 * over it, 2.5 mm above it: where it crosses the line of the one side it is outside the other one.
 * It touches nothing. Turned by all angles, and mirrored. */
START_TEST(a_tip_that_comes_up_past_a_corner_and_goes_over_it_touches_nothing)
{
    const double angle = radians(ANGLES[_i / 2]), side = _i % 2 ? -1 : 1;
    const double c = cos(angle), s = sin(angle), x = 0.02 * side, y = -0.015;
    const double vx = -4 * side, vy = 3.5, from = side > 0 ? 0.7 : PI - 0.9;
    bbm_model *m = weightless_blocks();

    add_rectangle(m, 0, ROCK, (rectangle){ side > 0 ? -1 : 0, -1, 1, 1, ANGLES[_i / 2],
                                           .fixed = 1 });
    const int e = add_wedge(m, 1, (double[]){ c * x - s * y, s * x + c * y }, angle + from,
                            angle + from + 0.2);
    set_velocity(m, e, c * vx - s * vy, s * vx + c * vy);
    run_steps(m, 1);
    ck_assert_int_eq(m->info.contacts, 0);
    ck_near(m->element[e].V[0], c * vx - s * vy, 4, SOLVED);
    ck_near(m->element[e].V[1], s * vx + c * vy, 4, SOLVED);
}
END_TEST

/* A corner P 1 cm right above a corner Q: their blocks are above each other and their sides, seen
 * from there, differ in direction by 0.005 the one way or the other. Of the two contacts that
 * stays whose foot lies on the edge. */
START_TEST(of_two_corners_above_each_other_that_one_touches_whose_foot_lies_on_the_edge)
{
    const double tilt = _i ? -0.005 : 0.005, c = cos(tilt), s = sin(tilt);
    const double above[4][2] = { { -c, 0.01 - s }, { 0, 0.01 }, { -s, 0.01 + c },
                                 { -c - s, 0.01 - s + c } };
    bbm_model *m = weightless_blocks();
    int n;

    add_rectangle(m, 0, ROCK, (rectangle){ .x = -1, .y = -1, .w = 1, .h = 1 });
    add_polygon(m, 1, 4, above);
    set_velocity(m, 1, 0, -0.95);
    start_step(m, &n);
    ck_assert_int_eq(find_listed(m, 1, 1, 0, 2) != NULL, _i);
    ck_assert_int_eq(find_listed(m, 0, 2, 1, 0) != NULL, !_i);
}
END_TEST

/* Two squares, one 2 mm above the other and 1 cm aside, come closer by 5 mm in a step and slip by
 * 3 cm, so that at both ends two corners pass each other first. What touches at the end of the step
 * is what lies over the other's side then: one corner of each. They hold the squares apart, to a
 * tenth of the 3 mm by which these would overlap. Turned by all angles, and mirrored. */
START_TEST(corners_that_pass_each_other_before_they_meet_hold_their_blocks)
{
    const double angle = ANGLES[_i / 2], side = _i % 2 ? -1 : 1, vx = 1.5 * side, vy = -0.25;
    const double c = cos(radians(angle)), s = sin(radians(angle));
    bbm_model *m = weightless_blocks();

    add_rectangle(m, 0, ROCK, (rectangle){ -0.5, -1, 1, 1, angle, .fixed = 0 });
    add_rectangle(m, 1, ROCK, (rectangle){ -0.5 - 0.01 * side, 2e-3, 1, 1, angle, .fixed = 0 });
    for (int e = 0; e < 2; e++)
        set_velocity(m, e, (c * vx - s * vy) * (e ? 1 : -1), (s * vx + c * vy) * (e ? 1 : -1));
    run_steps(m, 1);
    ck_assert(contact_of(m, 1, side > 0 ? 0 : 1) != NULL);
    ck_assert(contact_of(m, 0, side > 0 ? 2 : 3) != NULL);
    for (int k = 0; k < 2; k++) {
        const bbm_vertex *P = vertex_of(m, 1, k), *Q = vertex_of(m, 0, 3 - k);
        ck_near(c * (P->y - Q->y) - s * (P->x - Q->x), 0, 3e-3, 0.1);
    }
}
END_TEST

Suite *corners_suite(void)
{
    Suite *s = suite_create("corners");

    add_case(s, "corners",
        { two_corners_that_meet_leave_by_the_line_crossed_last, 2 },
        { a_corner_beside_a_corner_meets_the_side_that_lies_there, 2 },
        { the_two_lines_between_two_corners_are_entrance_lines, 2 },
        { entrance_lines_in_a_heap_are_all_other_lines_between_two_corners, 4 },
        { a_closed_contact_lasts_until_its_corner_has_left_past_the_other_one, 4 * COUNT(PASSED) },
        { the_ends_of_a_joint_open_and_close_by_themselves, 1 },
        { the_other_corner_takes_over_the_force_when_one_has_left, 2 },
        { of_two_closed_contacts_that_meet_corner_on_corner_one_stays, 1 },
        { corners_that_turn_past_each_other_close_one_contact, 8 },
        { corners_that_pass_each_other_before_they_meet_hold_their_blocks, 2 * COUNT(ANGLES) },
        { no_shot_passes_through_a_small_block, 12 },
        { a_block_that_turns_far_in_a_step_meets_what_it_sweeps, 2 });
    add_case(s, "entrance lines",
        { of_two_lines_crossed_at_the_same_time_one_counts_at_any_angle, 8 },
        { a_contact_that_opens_in_one_pass_and_comes_back_keeps_its_line, 4 },
        { nothing_comes_in_from_behind, 4 },
        { a_tip_that_comes_up_past_a_corner_and_goes_over_it_touches_nothing, 2 * COUNT(ANGLES) },
        { of_two_corners_above_each_other_that_one_touches_whose_foot_lies_on_the_edge, 2 });
    return s;
}
