/* check_flush.c - sections 3.7, 3.8 where blocks lie flush or nearly so: what slides over the joint
 * of two blocks goes on as if they were one.
 *
 * A scene is drawn from a number: a base of one block or several, and a body. Its frame has the
 * first top along x; all of it is turned, mirrored and rescaled, so that seams lie in floors,
 * slopes and walls, and the base comes first or last. The oracle is mechanics where a body slides,
 * else the same scene with a base of one block. SCENES=2000 tries as many of each kind as that. */
#include "models.h"

typedef struct {
    unsigned seed;
    double size, angle;         /* m, degree    of the scene; by which it is turned             */
    int mirrored, base_last;
    double g[2], friction;      /* m/s^2, degree    in the frame                                */
    double v[2], spin;          /* m/s, 1/s     of the body                                     */
    double kn, dt, restitution;
    int steps, settling, bases;
    outline base[40], whole;    /* several blocks, or one                                       */
    outline body;
} scene;

typedef struct { double x[2], v[2], spin; } motion;     /* of the body's barycentre             */

static double between(scene *s, double low, double high)
{
    return low + (high - low) * (random_number(&s->seed) + 1) / 2;
}

static double power(scene *s, double low, double high) { return pow(10, between(s, low, high)); }
static int chance(scene *s, double share) { return between(s, 0, 1) < share; }

static outline box(double x, double y, double X, double Y)
{
    return (outline){ 4, { { x, y }, { X, y }, { X, Y }, { x, Y } } };
}

/* A place of the scene in the model. */
static void put_place(const scene *s, const double x[2], double at[2])
{
    const double c = cos(radians(s->angle)), q = sin(radians(s->angle));
    const double X = s->mirrored ? -x[0] : x[0];

    at[0] = c * X - q * x[1];
    at[1] = q * X + c * x[1];
}

static void get_place(const scene *s, const double at[2], double x[2])
{
    const double c = cos(radians(s->angle)), q = sin(radians(s->angle)), X = c * at[0] + q * at[1];

    x[0] = s->mirrored ? -X : X;
    x[1] = c * at[1] - q * at[0];
}

static void put_block(bbm_model *m, const scene *s, int block, const outline *o, int fixed)
{
    int node[12];

    for (int k = 0; k < o->n; k++) {
        const int from = s->mirrored ? o->n - 1 - k : k;
        const double x[2] = { o->x[from][0] * s->size, o->x[from][1] * s->size };
        double at[2];
        put_place(s, x, at);
        ck_ok(bbm_add_node(m, at[0], at[1], &node[k]), m);
        if (fixed)
            ck_ok(bbm_fix_node(m, node[k], BBM_XY, 0, 0), m);
    }
    ck_ok(bbm_add_element(m, block, fixed ? BASE : ROCK, o->n, node, NULL), m);
}

/* Builds the scene, with its base in one block or not; the element of the body. */
static bbm_model *build(const scene *s, int whole, int *e)
{
    const int bases = whole ? 1 : s->bases;
    bbm_model *m = new_blocks();

    *e = s->base_last ? 0 : bases;
    if (s->base_last)
        put_block(m, s, bases, &s->body, 0);
    for (int k = 0; k < bases; k++)
        put_block(m, s, k, whole ? &s->whole : &s->base[k], 1);
    if (!s->base_last)
        put_block(m, s, bases, &s->body, 0);
    put_place(s, s->g, m->par.gravity);
    set_springs(m, s->kn, 0.4 * s->kn);
    m->par.friction = s->friction;
    m->par.dt = s->dt;
    m->beyond->restitution = s->restitution;
    prepare(m);
    return m;
}

/* The mean of the corners of an element. */
static void middle_of(const bbm_model *m, int e, double x[2])
{
    const bbm_element *b = &m->element[e];

    x[0] = m->origin[0], x[1] = m->origin[1];
    for (int v = b->first; v < b->first + b->n; v++)
        x[0] += m->vertex[v].x / b->n, x[1] += m->vertex[v].y / b->n;
}

/* Where the body is and how it moves after the steps, or fails. */
static bbm_status move_body(const scene *s, int whole, motion *end)
{
    int e;
    bbm_model *m = build(s, whole, &e);
    bbm_status status = BBM_OK;

    m->par.velocity_factor = 0;
    for (int k = 0; k < s->settling && !status; k++)
        status = bbm_step(m);
    m->par.velocity_factor = 1;
    double x[2], y[2];
    middle_of(m, e, x);
    put_place(s, s->v, m->element[e].V);
    m->element[e].V[2] = s->mirrored ? -s->spin : s->spin;
    for (int k = 0; k < 2 * s->steps && !status; k++) {    /* a step that is cut may be much shorter */
        m->par.dt = (k % 2 ? 0.02 : 0.98) * s->dt;
        status = bbm_step(m);
    }
    const bbm_element *b = &m->element[e];
    middle_of(m, e, y);
    get_place(s, (double[]){ y[0] - x[0], y[1] - x[1] }, end->x);
    get_place(s, b->V, end->v);
    end->spin = s->mirrored ? -b->V[2] : b->V[2];
    release(m);
    return status;
}

/* ---------------------------------------------------------------------------------- the scenes */

/* What all kinds have in common; the base is drawn in lengths of `size`. */
static scene new_scene(unsigned seed)
{
    scene s = { .seed = 7919 * seed + 1, .restitution = -1 };

    for (int k = 0; k < 5; k++)
        (void)random_number(&s.seed);
    s.size = power(&s, -1, 1);
    s.angle = chance(&s, 0.3) ? 0 : between(&s, -180, 180);
    s.mirrored = chance(&s, 0.5);
    s.base_last = chance(&s, 0.5);
    return s;
}

/* Springs that give way by a share of the body's size under its weight. */
static void choose_springs(scene *s, double g)
{
    const double weight = DENSITY * s->size * s->size * g;

    s->kn = weight / (s->size * power(s, -7, -3.5));
}

/* A sled comes over the joint of two blocks, behind which the top bends down. */
static scene kink_scene(unsigned seed)
{
    scene s = new_scene(seed);
    const double fall = radians(chance(&s, 0.7) ? power(&s, -0.7, 1.5) : between(&s, 30, 84));
    const double w = between(&s, 0.4, 1.5), h = between(&s, 0.3, 1), at = between(&s, 0, 0.5);
    const double c = 20 * cos(fall), d = 20 * sin(fall), slant = between(&s, -3, 3);
    const double beta = chance(&s, 0.5) ? 0 : between(&s, -1.2, 1.2), v = power(&s, -0.5, 0.8);

    s.base[0] = (outline){ 4, { { -20, -30 }, { slant, -30 }, { 0, 0 }, { -20, 0 } } };
    s.base[1] = (outline){ 4, { { slant, -30 }, { 20, -30 }, { c, -d }, { 0, 0 } } };
    s.whole = (outline){ 5, { { -20, -30 }, { 20, -30 }, { c, -d }, { 0, 0 }, { -20, 0 } } };
    s.bases = 2;
    s.body = box(-w - at, 0, -at, h);
    s.friction = chance(&s, 0.5) ? 0 : between(&s, 5, 30);
    s.g[0] = GRAVITY * sin(beta), s.g[1] = -GRAVITY * cos(beta);
    s.v[0] = v * sqrt(GRAVITY * s.size);
    choose_springs(&s, GRAVITY);
    s.steps = 120;
    s.dt = (w + at + 1) * s.size / (s.v[0] * s.steps + 1e-9) * between(&s, 0.5, 1.2);
    s.dt = fmin(s.dt, 0.02 * sqrt(s.size));
    s.settling = 20;
    return s;
}

/* A body that slides down a straight top; all its weight is on it. */
static scene slider_scene(unsigned seed)
{
    scene s = new_scene(seed);
    const double beta = chance(&s, 0.3) ? 0 : between(&s, 0.1, 0.7);
    const double w = between(&s, 0.6, 1.5);

    s.whole = box(-9, -3, 20, 0);
    s.body = box(-w - 0.01, 0, -0.01, between(&s, 0.2, 0.5) * w);
    s.friction = chance(&s, 0.5) ? 0 : beta * 57.3 * between(&s, 0.1, 0.8);
    s.g[0] = GRAVITY * sin(beta), s.g[1] = -GRAVITY * cos(beta);
    s.v[0] = sqrt(GRAVITY * s.size) * power(&s, -0.3, 0.5);
    choose_springs(&s, GRAVITY);
    s.steps = 150;
    s.dt = fmin(2 * w * s.size / s.v[0], sqrt(2 * w * s.size / GRAVITY)) / s.steps
         * between(&s, 0.5, 1.5);
    s.settling = 20;
    return s;
}

/* Tiles, each second one lower by up to a lip. */
static void lay_tiles(scene *s, double lip, double w, int exact)
{
    s->bases = 16;
    for (int k = 0; k < s->bases; k++) {
        const double x = w * (k - 6);
        s->base[k] = box(x, -1, x + w, k % 2 ? -lip : exact ? 0 : -lip * between(s, 0, 1));
    }
}

static scene lip_scene(unsigned seed)
{
    scene s = slider_scene(seed);

    lay_tiles(&s, power(&s, -8, -5), 0.55, 1);
    return s;
}

static scene step_scene(unsigned seed)
{
    scene s = slider_scene(seed);

    lay_tiles(&s, 2e-3 * fmin(0.55, s.body.x[2][1]) * power(&s, -2, -0.1), 0.55, 0);
    return s;
}

/* An open joint, whose far side stands by a little higher or lower. */
static scene gap_scene(unsigned seed)
{
    scene s = slider_scene(seed);
    const double w = s.body.x[1][0] - s.body.x[0][0];
    const double gap = w * power(&s, -5, -0.4), lip = chance(&s, 0.5) ? 0 : power(&s, -7, -4);

    s.bases = 2;
    s.base[0] = box(-9, -3, 0.3 * w, 0);
    s.base[1] = box(0.3 * w + gap, -3, 20, chance(&s, 0.5) ? lip : -lip);
    return s;
}

/* A polygon lands with a corner beside the joint of two blocks with one straight top, or on it with
 * a side all but flat. */
static scene drop(unsigned seed, int flat)
{
    scene s = new_scene(seed);
    const double slope = between(&s, -0.7, 0.7), t[2] = { cos(slope), sin(slope) };
    const double x = flat ? between(&s, -0.9, 0.9)
                   : (chance(&s, 0.5) ? 1 : -1) * power(&s, -4, -1.7);
    const int n = 3 + (int)between(&s, 0, 5.999);
    const double turn = flat ? PI / n - PI / 2 + between(&s, -0.01, 0.01)
                      : chance(&s, 0.3) ? PI / n - slope : between(&s, 0, 2 * PI / n);
    double low = INFINITY, at = 0;

    s.base[0] = box(-5, -9, 0, 0);
    s.base[1] = box(0, -9, 5, 0);
    s.whole = box(-5, -9, 5, 0);
    s.bases = 2;
    s.body.n = n;
    for (int k = 0; k < n; k++) {
        const double a = turn + 2 * PI * k / n;
        s.body.x[k][0] = 0.5 * cos(a);
        s.body.x[k][1] = 0.5 * sin(a);
        if (s.body.x[k][1] < low)
            low = s.body.x[k][1], at = s.body.x[k][0];
    }
    for (int k = 0; k < n; k++)
        s.body.x[k][0] += x - at, s.body.x[k][1] += 0.02 - low;
    s.g[0] = GRAVITY * t[1], s.g[1] = -GRAVITY * t[0];
    const double v = sqrt(GRAVITY * s.size) * power(&s, -0.3, 0.3);
    s.v[0] = v * t[1], s.v[1] = -v * t[0];
    s.friction = chance(&s, 0.5) ? 0 : between(&s, 5, 40);
    s.restitution = chance(&s, 0.5) ? -1 : between(&s, 0, 1);
    choose_springs(&s, GRAVITY);
    s.dt = power(&s, -2.3, -1) * sqrt(s.size / GRAVITY) * 0.3;
    s.steps = (int)(0.03 * s.size / (v * t[0] * s.dt)) + 6;
    return s;
}

static scene landing_scene(unsigned seed) { return drop(seed, 0); }
static scene flat_scene(unsigned seed) { return drop(seed, 1); }

/* --------------------------------------------------------------------------------- the oracles */

/* How far the body is from where a slider is after the steps, against its way. */
static double slider_is_off(const scene *s)
{
    const double t = s->steps * s->dt, a = s->g[0] + s->g[1] * bbm_tangent(s->friction);
    const double way = s->v[0] * t + a * t * t / 2;
    motion end = { { 0 }, { 0 }, 0 };

    if (move_body(s, 0, &end))
        return INFINITY;
    return fmax(fabs(end.x[0] - way), fabs(end.x[1])) / way;
}

/* The same against the scene with a base of one block. */
static double whole_is_off(const scene *s)
{
    const double t = s->steps * s->dt;
    motion end = { { 0 }, { 0 }, 0 }, one = end;

    if (move_body(s, 1, &one))
        return 0;
    if (move_body(s, 0, &end))
        return INFINITY;
    const double v = fmax(hypot(one.v[0], one.v[1]), hypot(s->v[0], s->v[1])) + GRAVITY * s->dt;
    return fmax(hypot(end.x[0] - one.x[0], end.x[1] - one.x[1]) / (v * t),
                fmax(hypot(end.v[0] - one.v[0], end.v[1] - one.v[1]),
                     s->size * fabs(end.spin - one.spin) / 2) / v);
}

/* Bounds: a hit from a hidden face or a ledge throws back, by 1 and more. A slider is right to its
 * springs. On the bend of two blocks two corners carry, of one block one: a body that chatters
 * there differs by that, up to 0.12 is seen. Two blocks with one straight top are one side: 2e-4 is
 * seen, where a corner comes past the seam in the step in which it hits. */
static const struct {
    const char *name;
    scene (*draw)(unsigned seed);
    double (*is_off)(const scene *s), bound;
} KIND[] = {
    { "kink", kink_scene, whole_is_off, 0.2 },
    { "lip", lip_scene, slider_is_off, 0.01 },
    { "step", step_scene, slider_is_off, 0.01 },
    { "gap", gap_scene, slider_is_off, 0.01 },
    { "landing", landing_scene, whole_is_off, 1e-3 },
    { "flat", flat_scene, whole_is_off, 1e-3 },
};

START_TEST(what_slides_over_seams_low_ledges_and_open_joints_goes_on)
{
    const int scenes = getenv("SCENES") ? atoi(getenv("SCENES")) : 20;

    for (unsigned seed = 0; seed < (unsigned)scenes; seed++) {
        const scene s = KIND[_i].draw(seed);
        const double off = KIND[_i].is_off(&s);
        ck_assert_msg(off <= KIND[_i].bound, "%s, seed %u: off by %g, at most %g",
                      KIND[_i].name, seed, off, KIND[_i].bound);
    }
}
END_TEST

/* Two blocks stand on each other, and their sides make one face. A block comes against it, its side
 * at 0.03 rad to it, and hits the upper block, 3 mm above the joint: that one gives way by more
 * than contacts are deep. So the lower one, which is fixed, is hit at its corner in the same step.
 * What comes sinks in by no more than the springs, v sqrt(m/p_n) = 0.2 mm at 1 m/s. */
START_TEST(a_corner_counts_where_the_block_that_covers_it_is_pushed_away)
{
    const double lean = 0.03, side = _i ? -1 : 1, gap = 5e-4, high = 1.003, low = high - 1;
    const double x[4][2] = { { -1, low }, { -gap - lean, low }, { -gap, high }, { -1, high } };
    bbm_model *m = new_blocks();
    int node[4], e;

    add_rectangle(m, 0, BASE, (rectangle){ .x = side > 0 ? 0 : -1, .w = 1, .h = 1, .fixed = 1 });
    add_rectangle(m, 1, ROCK, (rectangle){ .x = side > 0 ? 0 : -1, .y = 1, .w = 1, .h = 1 });
    for (int k = 0; k < 4; k++)
        ck_ok(bbm_add_node(m, side * x[k][0], x[k][1], &node[k]), m);
    ck_ok(bbm_add_element(m, 2, ROCK, 4, node, &e), m);
    m->par.gravity[1] = 0;
    m->par.friction = 0;
    set_springs(m, 5e10, 2e10);
    set_velocity(m, e, side, 0);
    for (int step = 0; step < 3; step++) {
        run_steps(m, 1);
        const bbm_vertex *p = vertex_of(m, e, side > 0 ? 1 : 2);
        const bbm_vertex *q = vertex_of(m, e, side > 0 ? 2 : 1);
        const double at = q->x + (p->x - q->x) * (1 - q->y) / (p->y - q->y);
        ck_assert_double_lt(side * at, 2e-4);
    }
}
END_TEST

static int add_box(bbm_model *m, int block, int material, double side, rectangle r)
{
    r.x = side > 0 ? r.x : -r.x - r.w;
    return add_rectangle(m, block, material, r);
}

/* A slab of 3 m whose top ends in a ledge, then one whose top is lower; a block lies behind the
 * ledge and is pulled against it by 5 m/s^2. The ledge holds it if it is higher than the rounding,
 * which is given, or 2e-3 of the block's side of 1 m; sharp corners are held by any. */
static const struct { double round, ledge; int holds; } LEDGES[] = {
    { -1, 1.9e-3, 0 }, { -1, 2.1e-3, 1 }, { 5e-3, 4.9e-3, 0 }, { 5e-3, 5.1e-3, 1 }, { 0, 1e-4, 1 },
};

START_TEST(a_ledge_lower_than_the_rounding_holds_no_block)
{
    const double ledge = LEDGES[_i / 2].ledge, side = _i % 2 ? -1 : 1;
    bbm_model *m = new_blocks();

    m->par.round = LEDGES[_i / 2].round;
    add_rectangle(m, 0, BASE, (rectangle){ .x = side > 0 ? 0 : -3, .y = -1, .w = 3,
                                           .h = 1 + ledge, .fixed = 1 });
    add_rectangle(m, 1, BASE, (rectangle){ .x = side > 0 ? -3 : 0, .y = -1, .w = 3, .h = 1,
                                           .fixed = 1 });
    const int e = add_rectangle(m, 2, ROCK, (rectangle){ .x = side > 0 ? -2.001 : 0.001, .w = 2,
                                                         .h = 1 });
    m->par.gravity[0] = side * 5;
    run_steps(m, 50);
    ck_near(vertex_of(m, e, 0)->u, LEDGES[_i / 2].holds ? side * 1e-3 : side * 0.625, 0.625, 0.01);
}
END_TEST

/* A block slides at 0.5 m/s on slabs of 0.25 m, each 0.22 mm higher than the last one. The roundings
 * of 0.5 mm let it pass two of them. It is never deeper in all, but for what the springs give way,
 * 2 v sqrt(m/p_n) = 0.07 mm. */
START_TEST(a_staircase_of_low_ledges_lets_no_block_sink_by_more_than_the_rounding)
{
    const double side = _i ? -1 : 1, ledge = 2.2e-4, wide = 0.25;
    bbm_model *m = new_blocks();

    for (int k = 0; k < 8; k++)
        add_box(m, k, BASE, side, (rectangle){ .x = k ? (k - 1) * wide : -2, .y = -1,
                                               .w = k ? wide : 2, .h = 1 + k * ledge, .fixed = 1 });
    const int e = add_box(m, 8, ROCK, side, (rectangle){ .x = -1.1, .w = 1, .h = 1 });
    m->par.dt = 0.01;
    set_springs(m, 5e11, 2e11);
    set_velocity(m, e, 0.5 * side, 0);
    for (int step = 0; step < 300; step++) {
        run_steps(m, 1);
        const bbm_vertex *front = vertex_of(m, e, side > 0 ? 1 : 0);
        const int under = (int)fmax(0, ceil((side * front->x - 1e-3) / wide));
        ck_assert_double_lt(under * ledge - front->y, 5e-4 + 7e-5);
    }
}
END_TEST

/* A beam leans by 0.02 rad, its lower corner 0.1 mm inside the end of a table and above it. Behind
 * the lines of both corners it is no ledge, but a beam that lands on the table: it sinks in by no
 * more than its springs, v sqrt(m/p_n) = 0.05 mm at 0.05 m/s, and not by the rounding of 1 mm. */
START_TEST(a_beam_that_lands_on_the_end_of_a_table_stays_on_it)
{
    const double lean = 0.02, side = _i ? -1 : 1;
    bbm_model *m = new_blocks();

    add_rectangle(m, 0, BASE, (rectangle){ .x = _i ? -3 : 0, .y = -1, .w = 3, .h = 1, .fixed = 1 });
    const double c = cos(lean), s = sin(lean), x = side * 1e-4;
    const double at[4][2] = { { x, 1e-4 }, { x + side * 2 * c, 1e-4 + 2 * s },
                              { x + side * (2 * c - 0.5 * s), 1e-4 + 2 * s + 0.5 * c },
                              { x - side * 0.5 * s, 1e-4 + 0.5 * c } };
    int node[4], e;
    for (int k = 0; k < 4; k++)
        ck_ok(bbm_add_node(m, at[k][0], at[k][1], &node[k]), m);
    ck_ok(bbm_add_element(m, 1, ROCK, 4, node, &e), m);
    m->par.gravity[1] = -10;
    m->par.friction = 30;
    set_springs(m, 1e9, 4e8);
    m->par.dt = 5e-3;
    prepare(m);
    for (int k = 0; k < 4; k++) {
        ck_ok(bbm_step(m), m);
        for (int v = 0; v < 4; v++)
            ck_assert_double_gt(vertex_of(m, e, v)->y, -1e-4);
    }
}
END_TEST

/* A block slides down along a wall. Both come to stand on a floor of two slabs with its joint below
 * theirs, and the slab of the block lies 0.3 mm lower, less than the rounding of 2 mm. So the block
 * touches the end of the other slab, too. The wall goes away over the joint. The block goes with
 * it, leaning on it, or where the wall is faster as friction lets it; either way it leaves the end
 * in the first step, long before the wall has gone as far as the corners are rounded. */
START_TEST(a_ledge_that_a_wall_leaves_behind_holds_no_block)
{
    const double side = _i % 2 ? -1 : 1, friction = 10, pull = 5, low = 3e-4, dt = 1e-3;
    const double slides = pull - GRAVITY * bbm_tangent(friction), wall_moves = _i < 2 ? 8 : 2;
    const double a = fmin(slides, wall_moves), time = 0.15;
    bbm_model *m = new_blocks();

    add_box(m, 0, BASE, side, (rectangle){ .x = -3, .y = -1, .w = 3, .h = 1, .fixed = 1 });
    add_box(m, 1, BASE, side, (rectangle){ .x = 0, .y = -1 - low, .w = 3, .h = 1, .fixed = 1 });
    const int wall = add_box(m, 2, BASE, side,
                             (rectangle){ .x = -1, .y = 0, .w = 1, .h = 1, .fixed = 1 });
    const int e = add_box(m, 3, ROCK, side, (rectangle){ .x = 0, .y = 2e-3, .w = 1, .h = 1 });
    m->par.gravity[0] = -side * pull;
    m->par.friction = friction;
    m->par.dt = 0.01;
    run_steps(m, 20);
    m->par.dt = dt;
    for (double t = dt; t < time + dt / 2; t += dt) {
        for (int k = 0; k < 4; k++)
            bbm_move_support(m, vertex_of(m, wall, k)->node, -side * wall_moves * t * t / 2, 0);
        run_steps(m, 1);
    }
    /* within two steps */
    ck_near(-side * vertex_of(m, e, 0)->u, a * time * time / 2, a * time * 2 * dt, 1);
}
END_TEST

/* The corner of a square falls on the seam of two free blocks between walls, that touch or are less apart than their contacts
 * are deep: it stays on top. */
START_TEST(a_corner_that_falls_on_the_seam_of_two_free_blocks_stays_on_them)
{
    static const double gaps[] = { 0, 1e-7, 1e-6, 3e-6, 1e-5, 3e-5 };

    for (int k = 0; k < 2 * COUNT(gaps); k++) {
        const double gap = gaps[k / 2], lift = k % 2 ? 0.1 : 0.01, top = 0.5 + lift;
        const double square[4][2] = { { gap / 2, top }, { 0.4, top + 0.4 }, { 0, top + 0.8 }, { -0.4, top + 0.4 } };
        bbm_model *m = new_blocks();
        m->par.dt = 1e-3;
        m->par.friction = _i ? 30 : 0;
        set_springs(m, 1e9, 4e8);
        add_rectangle(m, 0, BASE, (rectangle){ .x = -5, .y = -1, .w = 12, .h = 1, .fixed = 1 });
        add_rectangle(m, 1, BASE, (rectangle){ .x = -1.2, .w = 0.2, .h = 0.5, .fixed = 1 });
        add_rectangle(m, 2, BASE, (rectangle){ .x = 1 + gap, .w = 0.2, .h = 0.5, .fixed = 1 });
        add_rectangle(m, 3, ROCK, (rectangle){ .x = -1, .w = 1, .h = 0.5 });
        add_rectangle(m, 4, ROCK, (rectangle){ .x = gap, .w = 1, .h = 0.5 });
        const int e = add_polygon(m, 5, 4, square);
        run_steps(m, 200);
        ck_assert_double_gt(m->element[e].sum[1], -lift - 1e-3);    /* what springs give way */
        release(m);
    }
}
END_TEST

/* A block lies on three flush blocks that are held. The middle one rises and takes it along, or the outer ones draw away. Its
 * corners count from then on, and begin without force where they are. */
START_TEST(held_blocks_that_part_below_a_block_carry_it)
{
    for (int k = 0; k < 4; k++) {
        const double way = pow(10, -k - 2), off = 1.2e-6;       /* m: a millionth of an edge is rounding; and it sinks twice */
        bbm_model *m = new_blocks();
        m->par.dt = 1e-3;
        m->par.friction = 30;
        set_springs(m, 1e11, 4e10);
        for (int b = 0; b < 3; b++)
            add_rectangle(m, b, BASE, (rectangle){ .x = b, .w = 1, .h = 0.5, .fixed = 1 });
        const int e = add_rectangle(m, 3, ROCK, (rectangle){ .x = 0.4, .y = 0.5, .w = 2.2, .h = 0.2 });
        prepare(m);
        for (int step = 1; step <= 200; step++) {
            const double at = way * (1 - cos(PI * step / 200)) / 2;         /* it starts and stops gently */
            for (int b = 0; b < 3; b++)
                for (int v = 0; v < 4 && (_i == 0) == (b == 1); v++)
                    ck_ok(bbm_move_support(m, vertex_of(m, b, v)->node, _i ? (b - 1) * at : 0, _i ? 0 : at), m);
            ck_ok(bbm_step(m), m);
        }
        ck_near(m->element[e].sum[1], _i ? 0 : way, 1, off);
        release(m);
    }
}
END_TEST

/* The forces of a block of two cells, or of one polygon with a node in the middle of its lower side, that rests on held ground:
 * of one block with a grid point below its middle, or of two with a seam there; `off` shifts these. */
static int rest_on(int seam, int polygon, double off, bbm_model *m, double N[3])
{
    const double base[][2] = { { -1, 0 }, { 0, 0 }, { 1, 0 }, { 1, 0.7 }, { -1, 0.7 } };

    set_springs(m, 1e11, 4e10);
    m->par.friction = 20;
    for (int b = 0; b <= seam; b++)
        add_rectangle(m, b, BASE, (rectangle){ .x = off + 2 * (b - 1.0), .y = -0.5, .w = seam ? 2 : 4, .h = 0.5,
                                               .nx = seam ? 1 : 2, .fixed = 1 });
    if (polygon)
        add_polygon(m, 2, 5, base);
    else
        add_rectangle(m, 2, ROCK, (rectangle){ .x = -1, .w = 2, .h = 0.7, .nx = 2 });
    if (isinf(m->par.dt))
        run_steps(m, 1);
    else
        settle(m, 100);
    for (int k = 0; k < m->contacts && k < 3; k++)
        N[k] = m->contact[k].N;
    return m->contacts;
}

/* It carries what it carries where no other point lies below it. */
START_TEST(a_grid_point_on_a_seam_or_a_grid_point_of_held_ground_carries_its_share)
{
    for (int k = 0; k < 4; k++) {
        const double off[] = { 0, 1e-12, -1e-7, 0.01 };
        double N[4][3] = { { 0 } };
        for (int o = 3; o >= 0; o--) {
            bbm_model *m = new_blocks();
            m->par.dt = _i ? INFINITY : 1e-3;
            ck_assert_int_eq(rest_on(k / 2, k % 2, off[o], m, N[o]), 3);
            for (int c = 0; c < 3; c++) {
                ck_relative(N[o][c], N[3][c], 1e-3);        /* the ground bends otherwise */
                ck_relative(m->contact[c].N, -1e11 * m->contact[c].d_n, 1e-6);
            }
            release(m);
        }
    }
}
END_TEST

/* Blocks of 1 m side by side are held at their bottoms alone. A block in so many cells slides over them without friction and
 * begins and ends steps with its corners on their seams; it is held up all the way, and by nothing in it. */
START_TEST(what_slides_over_blocks_on_supports_passes_their_seams_wherever_a_step_ends)
{
    static const struct { double w, v; int cells, steps; } RUN[] = { { 2, 5, 4, 20 }, { 1, 12.5, 2, 36 }, { 1, 20, 4, 20 } };

    for (int k = 0; k < 2 * COUNT(RUN); k++) {
        const double w = RUN[k / 2].w, v = RUN[k / 2].v, way = RUN[k / 2].steps * v * 1e-2, side = k % 2 ? -1 : 1;
        bbm_model *m = new_blocks();
        m->par.dt = 1e-2;
        set_springs(m, 1e9, 4e8);
        for (int b = 0; b < 7; b++) {
            add_rectangle(m, b, BASE, (rectangle){ .x = side < 0 ? -b - 1 : b, .y = -1, .w = 1, .h = 1 });
            for (int n = m->nodes - 4; n < m->nodes - 2; n++)
                ck_ok(bbm_fix_node(m, n, BBM_XY, 0, 0), m);
        }
        const int e = add_rectangle(m, 7, ROCK, (rectangle){ .x = side < 0 ? -w : 0, .w = w, .h = w, .nx = RUN[k / 2].cells });
        prepare(m);
        if (_i)
            settle(m, 20);
        for (int i = e; i < m->elements; i++)
            m->element[i].V[0] = side * v;
        run_steps(m, RUN[k / 2].steps);
        ck_relative(m->element[e].sum[0], side * way, 1e-3);
        ck_near(m->element[e].sum[1], 0, w, 1e-3);
        release(m);
    }
}
END_TEST

/* Two blocks side by side; below their joint, a little to the right, is the seam of two held blocks. On the last bit of the
 * first of these both bear all that they would without a seam. */
START_TEST(a_block_bears_on_the_last_bit_of_a_held_block)
{
    for (int k = 0; k < 8; k++) {
        const double off = pow(10, -5 + k / 8.0);
        bbm_model *m = new_blocks();
        m->par.dt = 1e-2;
        m->par.friction = 20;
        set_springs(m, 3e9, 1.2e9);
        for (int b = 0; b < 2; b++)
            add_rectangle(m, b, BASE, (rectangle){ .x = 5 * (b - 1) + off, .y = -1, .w = 5, .h = 1, .fixed = 1 });
        for (int b = 0; b < 2; b++)
            add_rectangle(m, 2 + b, ROCK, (rectangle){ .x = 4 * (b - 1), .w = 4, .h = 4 - 2 * b, .nx = _i ? 3 : 1 });
        prepare(m);
        for (int i = 2; i < m->elements; i++)
            m->element[i].material.E = 1.9e9;                   /* it widens as it is pressed */
        settle(m, 60);
        for (int c = 0; c < m->contacts; c++)
            if (m->contact[c].state != BBM_OPEN)
                ck_near(m->contact[c].N, -3e9 * m->contact[c].d_n, 1e5, 1e-3);
        release(m);
    }
}
END_TEST

Suite *flush_suite(void)
{
    Suite *s = suite_create("flush");

    add_case(s, "seams", { what_slides_over_seams_low_ledges_and_open_joints_goes_on, COUNT(KIND) },
        { a_corner_that_falls_on_the_seam_of_two_free_blocks_stays_on_them, 2 },
        { what_slides_over_blocks_on_supports_passes_their_seams_wherever_a_step_ends, 2 },
        { held_blocks_that_part_below_a_block_carry_it, 2 },
        { a_block_bears_on_the_last_bit_of_a_held_block, 2 },
        { a_grid_point_on_a_seam_or_a_grid_point_of_held_ground_carries_its_share, 2 },
        { a_ledge_lower_than_the_rounding_holds_no_block, 2 * COUNT(LEDGES) },
        { a_ledge_that_a_wall_leaves_behind_holds_no_block, 4 },
        { a_staircase_of_low_ledges_lets_no_block_sink_by_more_than_the_rounding, 2 },
        { a_corner_counts_where_the_block_that_covers_it_is_pushed_away, 2 },
        { a_beam_that_lands_on_the_end_of_a_table_stays_on_it, 2 });
    return s;
}
