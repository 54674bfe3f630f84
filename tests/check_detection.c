/* check_detection.c - section 3.7, the detection: which grid points may touch which edges, and how
 * far it looks. */
#include <string.h>

#include "check.h"
#include "models.h"

/* ----------------------------------------------------------------------- detection, by outlines */

/* Two long blocks through the midst of the others, far longer than a cell of the grid; one strikes
 * upwards, one falls. */
static const outline SLAB[SLABS] = {
    { 4, { { -1.5, -3.8 }, { 9, 3.4 }, { 9.2, 3.9 }, { -1.7, -3.4 } } },
    { 4, { { -1.6, 4.1 }, { 9.3, -3.6 }, { 9.4, -3.1 }, { -1.2, 4.3 } } },
};

/* Blocks of all kinds at random, near each other and in places over each other, without gravity.
 * Here or there. */
static bbm_model *random_blocks(outline o[BLOCKS], unsigned seed, const double at[2])
{
    bbm_model *m = weightless_blocks();

    for (int b = 0; b < BLOCKS; b++) {
        const double x = at[0] + 1.3 * (b % COLUMNS) + 0.1 * random_number(&seed);
        const double y = at[1] + 1.3 * (b / COLUMNS) - 3;
        o[b] = b < BLOCKS - SLABS ? random_outline(b % 3, x, y, &seed)
                                  : put(&SLAB[BLOCKS - 1 - b], 0, at[0], at[1]);
    }
    for (int b = 0; b < BLOCKS; b++)
        add_outline(m, b, &o[b], b % 3 == 2 && b < BLOCKS - SLABS);
    prepare_apart(m);
    return m;
}

/* of a contact: its corner, the start and the end of its edge */
typedef struct { double x[6]; } place;

static int compare_places(const void *p, const void *q)
{
    const place *a = p, *b = q;

    for (int k = 0; k < 6; k++)
        if (a->x[k] != b->x[k])
            return a->x[k] < b->x[k] ? -1 : 1;
    return 0;
}

/* The list of contacts without indices, sorted. */
static place *list_places(const bbm_model *m)
{
    place *p = calloc((size_t)m->contacts + 1, sizeof *p);

    for (int k = 0; k < m->contacts; k++) {
        const bbm_contact *c = &m->contact[k];
        const bbm_vertex *v[3] = { corner_vertex(m, c), start_of(m, c->edge), end_of(m, c->edge) };
        for (int q = 0; q < 3; q++) {
            p[k].x[2 * q] = v[q]->x;
            p[k].x[2 * q + 1] = v[q]->y;
        }
    }
    qsort(p, (size_t)m->contacts, sizeof *p, compare_places);
    return p;
}

typedef struct {                /* a vertex against an edge, by geometry alone */
    /* over the line; beyond the edge's nearer end, negative on the edge */
    double height, beyond;
    double clear;       /* sine by which the vertex's sides point away from the edge, the lesser */
    double parallel;    /* the lesser angle of its sides with the edge */
    double bulge;       /* sine of the turn at the vertex, positive when convex */
    int end;            /* which end is nearer */
} sight;

static sight look(const outline *a, int i, const outline *b, int k)
{
    const double *P = a->x[i], *next = a->x[(i + 1) % a->n], *last = a->x[(i + a->n - 1) % a->n];
    const double *A = b->x[k], *B = b->x[(k + 1) % b->n], l = hypot(B[0] - A[0], B[1] - A[1]);
    /* n points out */
    const double t[2] = { (B[0] - A[0]) / l, (B[1] - A[1]) / l }, n[2] = { t[1], -t[0] };
    const double to[2] = { next[0] - P[0], next[1] - P[1] };
    const double from[2] = { last[0] - P[0], last[1] - P[1] };
    const double lt = hypot(to[0], to[1]), lf = hypot(from[0], from[1]);
    const double s = (P[0] - A[0]) * t[0] + (P[1] - A[1]) * t[1];
    const double away[2] = { (to[0] * n[0] + to[1] * n[1]) / lt,
                             (from[0] * n[0] + from[1] * n[1]) / lf };

    return (sight){ .height = (P[0] - A[0]) * n[0] + (P[1] - A[1]) * n[1],
                    .beyond = fmax(-s, s - l),
                    .clear = fmin(away[0], away[1]), .parallel = fmin(fabs(away[0]), fabs(away[1])),
                    .bulge = (to[0] * from[1] - to[1] * from[0]) / lt / lf,
                    .end = s < l / 2 ? k : (k + 1) % b->n };
}

static double bulge_at(const outline *o, int k)
{
    return look(o, k, o, (k + 2) % o->n).bulge;
}

static int is_listed(const place *list, int n, const outline *a, int i, const outline *b, int k)
{
    const double *P = a->x[i], *A = b->x[k], *B = b->x[(k + 1) % b->n];
    const place p = { { P[0], P[1], A[0], A[1], B[0], B[1] } };

    return bsearch(&p, list, (size_t)n, sizeof p, compare_places) != NULL;
}

/* Compares the list with the definition. What is nearer than the ways of both blocks must be in it;
 * what is further than 1.15 times that must not: the program may look a little further. What lies
 * behind an edge, more than rounding (1e-5 m), is not in it. A point inside a straight side may
 * touch, too, within 0.1 rad. Sides nearer to parallel than 0.012 are left to other tests, as one
 * of two contacts is dropped there. Beyond an end of an edge that is no corner, the next edge is
 * the one to touch. */
static void check_list(const bbm_model *m, const outline o[BLOCKS], const double way[BLOCKS])
{
    place *list = list_places(m);
    int must = 0, may = 0, wrong = 0;           /* to say of each that it is right takes seconds */

    for (int a = 0; a < BLOCKS; a++)
        for (int b = 0; b < BLOCKS; b++)
            for (int ik = 0; ik < o[a].n * o[b].n && a != b; ik++) {
                const int i = ik / o[b].n, k = ik % o[b].n;
                const int listed = is_listed(list, m->contacts, &o[a], i, &o[b], k);
                const sight s = look(&o[a], i, &o[b], k);
                const int corner = s.bulge > 1e-3, inside = fabs(s.bulge) < 1e-3 && s.clear > -0.11;
                const int here = s.beyond < 0 || bulge_at(&o[b], s.end) > 1e-3;
                const double reach = way[a] + way[b], far = fmax(fabs(s.height), s.beyond);
                may += listed;
                wrong += listed && !(((corner && s.clear > -0.011) || inside) && far < 1.15 * reach
                                     + 1e-5 && (s.height > -1e-5 || s.beyond > 0));
                if (!corner || s.clear < 0 || s.parallel < 0.012 ||
                    hypot(s.height, fmax(0, s.beyond)) > reach || s.height < 0)
                    continue;
                wrong += !listed && here;
                must += listed;
            }
    ck_assert_int_eq(wrong, 0);
    ck_assert_int_eq(may, m->contacts);
    ck_assert(way[17] < 0.05 || must > SLABS);
    free(list);
}

static const double PLACES[3][2] = { { 0, 0 }, { 70, -40 }, { -30, 60 } };

START_TEST(the_sweep_finds_the_pairs_that_comparing_all_with_all_finds)
{
    const double disp = _i % 2 ? 0.15 : 0.01;
    unsigned seed = (unsigned)_i + 1;
    outline o[BLOCKS];
    bbm_model *m = random_blocks(o, seed, PLACES[_i / 2]);
    double way[BLOCKS];

    double angle[BLOCKS];               /* elements of one block would turn its sides */
    for (int b = 0; b < BLOCKS; b++) {
        way[b] = disp * (b == 17 ? 1 : fabs(random_number(&seed)));
        angle[b] = PI * random_number(&seed);
    }
    for (int e = 0; e < m->elements; e++) {
        const int b = m->element[e].block;
        set_velocity(m, e, way[b] / m->par.dt * cos(angle[b]), way[b] / m->par.dt * sin(angle[b]));
    }
    detect(m);
    check_list(m, o, way);
    place *swept = list_places(m);
    const int n = m->contacts;
    m->hook->find_pairs = NULL;
    detect(m);
    place *all = list_places(m);
    ck_assert_int_eq(n, m->contacts);
    ck_assert(memcmp(swept, all, (size_t)n * sizeof *all) == 0);
    ck_assert_int_eq(m->info.candidates, m->edges * m->edges);
    free(swept);
    free(all);
}
END_TEST

/* Models that lie along a line of any direction, also the one along which the sweep makes no
 * headway; one that has blown up ends in an error, and soon. */
START_TEST(the_sweep_finds_the_contacts_of_a_row_in_any_direction)
{
    const double angle = _i < 8 ? _i * PI / 4 : atan2(-4, 1);
    bbm_model *m = new_blocks();

    for (int b = 0; b < 40; b++)
        add_rectangle(m, b, ROCK, (rectangle){ .x = b, .w = 1, .h = 1,
                                               .angle = angle * 180 / PI });
    prepare_apart(m);
    detect(m);
    ck_assert_int_eq(m->contacts, 2 * 39);
    for (int v = 0; v < m->vertices; v += 3)
        m->vertex[v].x = v % 2 ? NAN : INFINITY;
    ck_assert_int_ne(bbm_step(m), BBM_OK);
}
END_TEST

/* Bricks in n rows, or a block on a plate of n and 2 n pieces; the edges for each that the
 * detection compares: those in whose box it lies. In a wall that is at most four edges of other
 * bricks at each corner but the outer ones, whatever the number and the size of the bricks. */
static double compared(int bricks, int n, double size)
{
    bbm_model *m = new_blocks();

    for (int k = 0; bricks && k < n * n; k++) {
        const double shift = k / n % 2 / 2.0;
        add_rectangle(m, k, ROCK, (rectangle){ (k % n + shift) * size, k / n * size, size, size,
                                               0, .nx = 1 });
    }
    if (!bricks) {
        add_rectangle(m, 0, ROCK, (rectangle){ -0.5 * size, -size, 2 * n * size, size,
                                               .nx = 2 * n });
        add_rectangle(m, 1, ROCK, (rectangle){ 0, 0, n * size, size, .nx = n });
    }
    detect(m);
    const double each = (double)m->info.candidates / m->edges;
    release(m);
    return each;
}

START_TEST(the_detection_compares_a_corner_with_the_few_edges_around_it)
{
    const double size = _i % 2 ? 0.02 : 50;
    const int bricks = _i / 2;

    ck_assert(compared(bricks, bricks ? 4 : 10, size) < (bricks ? 3 : 0.4));
    ck_assert(compared(bricks, bricks ? 30 : 600, size) < (bricks ? 3 : 0.4));
}
END_TEST

/* A block with a slit from the right that is as good as closed: the corner of the lower lip lies on
 * the upper one. */
START_TEST(a_block_does_not_touch_itself)
{
    const double slit = 1e-8;
    const double c[8][2] = { { 0, 0 }, { 2, 0 }, { 2, 1 }, { 1, 1 }, { 1, 1 + slit },
                             { 3, 1 + slit }, { 3, 2 }, { 0, 2 } };
    bbm_model *m = new_blocks();

    add_polygon(m, 0, 8, c);
    detect(m);
    ck_assert_int_eq(m->contacts, 0);
}
END_TEST

/* The notch of an L, its inner corner and the walls beside it: only the block in the notch has
 * corners there. */
START_TEST(an_inner_corner_is_no_corner)
{
    bbm_model *m = new_blocks();
    int notch = 0;

    add_outline(m, 0, &NOTCHED, 0);
    add_rectangle(m, 1, ROCK, (rectangle){ .x = 0, .y = 0, .w = 0.25, .h = 0.25 });
    detect(m);
    for (int k = 0; k < m->contacts; k++) {
        notch += corner_block(m, &m->contact[k]) == 0;
        for (int r = 0; r < 4; r++)
            ck_assert_int_lt(m->contact[k].trial.entrance[r], 0);        /* both walls hold at once */
    }
    ck_assert_int_eq(notch, 0);
    ck_assert_int_eq(m->contacts, 4);  /* two corners on each wall; the inner one on both */
}
END_TEST

/* Two triangles of one block that meet in a node, 1 m long, the second between 45 and 80 degrees;
 * the floor begins at x. Both stand on it like a V and its mirror image: two corners, not one broad
 * one, nor a notch. Or the first one hangs down beside the floor's end, and the other one's corner
 * stands there alone. */
static const struct { double from, to, x; int corners; } TIPS[] = {
    { 100, 135, -5, 2 }, { 169, 211, 0.01, 1 },
};

START_TEST(each_of_two_tips_in_a_node_is_a_corner)
{
    for (int i = 0; i < 2 * COUNT(ANGLES); i++) {
        const double angle = ANGLES[i / 2], at[4] = { TIPS[_i].from, TIPS[_i].to, 45, 80 };
        bbm_model *m = new_blocks();
        int corners = 0;
        ck_ok(bbm_add_node(m, 0, 0, NULL), m);
        for (int k = 0; k < 4; k++)
            ck_ok(bbm_add_node(m, cos(radians(at[k] + angle)), sin(radians(at[k] + angle)),
                               NULL), m);
        for (int k = 0; k < 2; k++) {
            const int a = k == i % 2 ? 1 : 3;
            ck_ok(bbm_add_element(m, 0, ROCK, 3, (int[]){ 0, a, a + 1 }, NULL), m);
        }
        const int e = add_rectangle(m, 1, BASE, (rectangle){ TIPS[_i].x, -1, 10, 1, angle,
                                                             .fixed = 0 });
        set_velocity(m, e, 2, 0);
        detect(m);
        for (int k = 0; k < m->contacts; k++)
            corners += corner_block(m, &m->contact[k]) == 0 &&
                       start_of(m, m->contact[k].edge) == vertex_of(m, e, 2);
        ck_assert_int_eq(corners, TIPS[_i].corners);
        release(m);
    }
}
END_TEST

static int same_places(const bbm_model *m, const bbm_model *n)
{
    place *p = list_places(m), *q = list_places(n);
    const int same = m->contacts == n->contacts &&
                     memcmp(p, q, (size_t)m->contacts * sizeof *p) == 0;

    free(p);
    free(q);
    return same;
}

START_TEST(the_list_of_contacts_does_not_depend_on_the_order_of_the_blocks)
{
    const int orders[3][16] = { { 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15 },
                                { 15, 14, 13, 12, 11, 10, 9, 8, 7, 6, 5, 4, 3, 2, 1, 0 },
                                { 7, 2, 13, 8, 3, 14, 9, 4, 15, 10, 5, 0, 11, 6, 1, 12 } };
    bbm_model *first = wall(orders[0], ANGLES[_i]);

    detect(first);
    ck_assert(first->contacts > 40);
    for (int k = 1; k < 3; k++) {
        bbm_model *other = wall(orders[k], ANGLES[_i]);
        detect(other);
        ck_assert(same_places(first, other));
        release(other);
    }
}
END_TEST

/* ---------------------------------------------------------------------- which grid points touch */

/* The angle turns blocks and gravity alike. The upper block sinks in by different amounts at its
 * ends, which turns its weight by some W/p_n = 2e-5; it grows broader under its weight, which the
 * contacts resist by equal shear forces. */
START_TEST(two_blocks_on_each_other_touch_at_the_two_ends_of_their_joint)
{
    const double x = SEATS[_i].x, w = SEATS[_i].w, a = fmax(0, x), b = fmin(1, x + w);
    const double W = DENSITY * GRAVITY * w;
    const double left = W * (b - x - w / 2) / (b - a);

    for (int k = 0; k < COUNT(ANGLES); k++) {
        const double turned = radians(ANGLES[k]);
        bbm_model *m = new_blocks();
        add_rectangle(m, 0, BASE, (rectangle){ 0, -1, 1, 1, ANGLES[k], .fixed = 1 });
        add_rectangle(m, 1, ROCK, (rectangle){ x, 0, w, 1, ANGLES[k], .fixed = 0 });
        m->par.gravity[0] = GRAVITY * sin(turned);
        m->par.gravity[1] = -GRAVITY * cos(turned);
        m->par.friction = 30;
        settle(m, 40);
        ck_assert_int_eq(m->info.contacts, 2);
        double T = 0;
        for (int c = 0; c < m->contacts; c++) {
            const bbm_vertex *P = corner_vertex(m, &m->contact[c]);
            const double along = P->x * cos(turned) + P->y * sin(turned);
            if (m->contact[c].state == BBM_OPEN)
                continue;
            ck_near(m->contact[c].N, fabs(along - a) < 0.01 ? left : W - left, W, 5e-5);
            T += m->contact[c].T;
        }
        ck_near(T, 0, W, 1e-4);
        release(m);
    }
}
END_TEST

/* Two equal squares, one or both of them in four pieces, turned by all angles: five grid points of
 * the pieces touch; if both have them, those of the upper square, or of the right one where both are
 * level. */
START_TEST(of_two_equal_sides_the_grid_points_of_the_finer_one_touch)
{
    const double angle = ANGLES[_i / 3], c = cos(radians(angle)), s = sin(radians(angle));
    /* whether the second square is the upper one, or right */
    const int second = fabs(c) > 0.1 ? c > 0 : s < 0;
    const int pieces = _i % 3;                              /* which square has them; 2: both */
    bbm_model *m = new_blocks();

    add_rectangle(m, 0, ROCK, (rectangle){ 3, -6, 1, 1, angle, .nx = pieces == 1 ? 1 : 4 });
    add_rectangle(m, 1, ROCK, (rectangle){ 3, -5, 1, 1, angle, .nx = pieces == 0 ? 1 : 4 });
    detect(m);
    ck_assert_int_eq(m->contacts, 5);
    int own = 0;                            /* at the two ends the corners of both lie together */
    for (int k = 0; k < m->contacts; k++)
        own += corner_block(m, &m->contact[k]) == (pieces == 2 ? second : pieces);
    ck_assert_int_ge(own, 3);
}
END_TEST

/* Two blocks flush at two corners, the second taller, or at one corner, the second longer but with
 * less boundary: at each there is one contact, on the second one's edge, at all angles and in
 * either order. Between blocks so unlike nothing asks what is up. */
START_TEST(of_two_corners_at_one_place_that_of_the_smaller_block_touches)
{
    const int longer = _i / 2, second = 1 - _i % 2;

    for (int k = 0; k < COUNT(ANGLES); k++) {
        rectangle r[2] = { { 3, -6, 1, 1, .angle = ANGLES[k] }, { 3, -5, 1, 1.5, .angle = ANGLES[k] } };
        bbm_model *m = weightless_blocks();
        if (longer)
            r[1] = (rectangle){ 3, -5, 1.5, 0.4, .angle = ANGLES[k] };
        add_rectangle(m, 0, ROCK, r[second ? 0 : 1]);
        add_rectangle(m, 1, ROCK, r[second ? 1 : 0]);
        detect(m);
        ck_assert_int_eq(m->contacts, 2);
        for (int c = 0; c < m->contacts; c++)
            ck_assert_int_eq(corner_block(m, &m->contact[c]), 1 - second);
        release(m);
    }
}
END_TEST

/* A coarse block of 0.9 m, or 0.4 m, on a base with a grid point each 25 cm: three of them, or one,
 * touch between its corners, in statics; else its corners alone, and those alone on a held base. */
START_TEST(in_statics_the_grid_points_of_the_finer_side_touch)
{
    const double w = _i / 2 == 1 ? 0.4 : 0.9;
    const int in_statics = _i % 2, held = _i / 2 == 2;
    bbm_model *m = new_blocks();

    m->par.dt = in_statics ? INFINITY : m->par.dt;
    add_rectangle(m, in_statics, BASE,
                  (rectangle){ .x = -2, .y = -1, .w = 4, .h = 1, .nx = 16, .fixed = held });
    add_rectangle(m, !in_statics, ROCK, (rectangle){ .x = -w / 2, .y = 0, .w = w, .h = 1 });
    detect(m);
    ck_assert_int_eq(m->contacts, !in_statics || held ? 2 : w < 0.5 ? 3 : 5);
}
END_TEST

/* A block of 1.5 m in eight cells lies over one of 1.2 m. If that is held, seven grid points of the longer one touch, too, or
 * it would sag between the two corners; else those alone touch. */
START_TEST(grid_points_touch_a_shorter_side_that_is_held)
{
    bbm_model *m = new_blocks();

    add_rectangle(m, 0, BASE, (rectangle){ .x = -0.6, .y = -1, .w = 1.2, .h = 1, .fixed = _i });
    add_rectangle(m, 1, ROCK, (rectangle){ .x = -0.75, .y = 0, .w = 1.5, .h = 0.05, .nx = 8 });
    detect(m);
    ck_assert_int_eq(m->contacts, _i ? 9 : 2);
}
END_TEST

/* The side of one block in pieces, and in the middle of it the shorter side of another one in
 * pieces: the grid points of the shorter side touch, wherever the two are, of whatever size,
 * whichever is the upper one. */
START_TEST(of_two_sides_the_grid_points_of_the_shorter_one_touch)
{
    const double x[4] = { 0, 4, -5, 2 }, y[4] = { 0, 7, -3, -4 }, size[3] = { 1, 1e-3, 1e3 };

    for (int k = 0; k < 12 * COUNT(ANGLES); k++) {
        const double l = size[k % 3], below = l * (_i ? 0.5 : 1), above = l * (_i ? 1 : 0.5);
        const double angle = ANGLES[k / 12];
        const double X = l * x[k / 3 % 4], Y = l * y[k / 3 % 4];
        bbm_model *m = new_blocks();
        add_rectangle(m, 0, ROCK, (rectangle){ X - below / 2, Y - l, below, l, angle, .nx = 4 });
        add_rectangle(m, 1, ROCK, (rectangle){ X - above / 2, Y, above, l, angle, .nx = 3 });
        detect(m);
        ck_assert_int_eq(m->contacts, _i ? 5 : 4);
        for (int c = 0; c < m->contacts; c++)
            ck_assert_int_eq(corner_block(m, &m->contact[c]), _i ? 0 : 1);
        release(m);
    }
}
END_TEST

/* Two equal squares, the upper one shifted by half a millionth of their side, as the rounding of a
 * model file may: the corners are at one place all the same, and hold it at both ends. Of 10 m, of
 * 0.1 m, to the right, to the left. */
START_TEST(rounding_in_a_model_file_does_not_undo_a_contact)
{
    const double size = _i / 2 ? 0.1 : 10, shift = (_i % 2 ? -5e-7 : 5e-7) * size;
    const double W = DENSITY * GRAVITY * size * size;

    for (int k = 0; k < COUNT(ANGLES); k++) {
        bbm_model *m = new_blocks();
        add_rectangle(m, 0, BASE, (rectangle){ 0, -size, size, size, ANGLES[k], .fixed = 1 });
        add_rectangle(m, 1, ROCK, (rectangle){ shift, 0, size, size, ANGLES[k], .fixed = 0 });
        m->par.gravity[0] = GRAVITY * sin(radians(ANGLES[k]));
        m->par.gravity[1] = -GRAVITY * cos(radians(ANGLES[k]));
        m->par.friction = 30;
        set_springs(m, 1e12, 4e11);
        settle(m, 20);
        ck_assert_int_eq(m->info.contacts, 2);
        ck_relative(normal_force(m, 0, 1), W, 1e-5);
        release(m);
    }
}
END_TEST

/* Two sides that end in one point, along the x axis and off it by `slope`, the sine of their angle,
 * to the last bit. A hundredth is still parallel, any more is not. The sides are 100 m long, so
 * that y/l is exact. */
static void slope_to(double sine, double x[2])
{
    x[0] = sqrt(1e4 - 1e4 * sine * sine);
    x[1] = 100 * sine;
    ck_assert(hypot(x[0], x[1]) == 100 && x[1] / 100 == sine);
}

/* Corner on corner, the one side on the x axis and the other above it: one contact when they are
 * parallel, else two. A corner one of whose sides dips into a floor by a hundredth touches it, by
 * more it cannot. One that is hollow by a hundredth is a notch, and by less it still touches. */
START_TEST(sides_are_parallel_up_to_a_hundredth)
{
    const int more = _i % 2;
    double s[2];
    bbm_model *m = new_blocks();

    slope_to(_i / 2 == 2 ? (more ? 0.01 : 0.0099) : more ? 0.0101 : 0.01, s);
    if (_i / 2 == 0) {
        const double below[4][2] = { { -100, -9 }, { 0, -9 }, { 0, 0 }, { -100, 0 } };
        const double above[4][2] = { { 0, 0 }, { 0, 9 }, { -s[0], 9 }, { -s[0], s[1] } };
        add_polygon(m, 0, 4, below);
        add_polygon(m, 1, 4, above);
    } else {
        const double dips[4][2] = { { 0, 0 }, { s[0], -s[1] }, { s[0], 9 }, { 0, 9 } };
        const double left[4][2] = { { 0, 0 }, { 0, 9 }, { -s[0], 9 }, { -s[0], -s[1] } };
        const double notch[5][2] = { { -s[0], -s[1] }, { 0, 0 }, { 100, 0 }, { 100, 9 },
                                     { -s[0], 9 } };
        add_rectangle(m, 0, BASE, (rectangle){ .x = -10, .y = -10, .w = 20, .h = 10 });
        if (_i / 2 != 2)
            add_polygon(m, 1, 4, _i / 2 == 1 ? dips : left);
        else
            add_polygon(m, 1, 5, notch);
    }
    prepare_apart(m);
    detect(m);
    int here = 0;
    for (int k = 0; k < m->contacts; k++)
        here += corner_vertex(m, &m->contact[k])->x == 0;
    ck_assert_msg(here == (_i / 2 == 0 ? 1 + more : 1 - more),
                  "%d corners at x = 0 may touch, expected %d", here,
                  _i / 2 == 0 ? 1 + more : 1 - more);
}
END_TEST

/* A slab of triangles, at whose grid points meet some that have a vertex, but no edge, on the
 * boundary; its triangles in either order, before or after the squares that lie above and below it.
 * Each square touches with two corners; the nodes within the slab's sides are none. */
START_TEST(a_node_where_triangles_meet_on_a_straight_side_is_no_corner)
{
    for (int i = 0; i < 2 * COUNT(ANGLES); i++) {
        const double angle = ANGLES[i / 2], c = cos(radians(angle)), s = sin(radians(angle));
        const double x[7][2] = { { -2, -1 }, { 0, -1 }, { 2, -1 }, { 2, 0 }, { 0, 0 }, { -2, 0 },
                                 { 0, -0.5 } };
        const int ring[6][2] = { { 0, 1 }, { 1, 2 }, { 2, 3 }, { 3, 4 }, { 4, 5 }, { 5, 0 } };
        bbm_model *m = new_blocks();
        int first = 0;
        for (int part = 0; part < 2; part++) {
            if (part == i % 2) {
                add_rectangle(m, 1, ROCK, (rectangle){ -0.5, 0, 1, 1, .angle = angle });
                add_rectangle(m, 2, ROCK, (rectangle){ -0.5, -2, 1, 1, .angle = angle });
                first = m->nodes;
                continue;
            }
            for (int k = 0; k < 7; k++)
                ck_ok(bbm_add_node(m, c * x[k][0] - s * x[k][1], s * x[k][0] + c * x[k][1],
                                   NULL), m);
            for (int k = 0; k < 6; k++) {
                const int *f = ring[_i ? 5 - k : k];
                const int node[3] = { first + f[0], first + f[1], first + 6 };
                ck_ok(bbm_add_element(m, 0, ROCK, 3, node, NULL), m);
            }
        }
        detect(m);
        ck_assert_int_eq(m->contacts, 4);
        for (int k = 0; k < 4; k++)
            ck_assert_int_ne(corner_block(m, &m->contact[k]), 0);
        release(m);
    }
}
END_TEST

/* A plate of 1 cm in four pieces comes down on a table, through which its upper side is in reach,
 * too: what touches are the grid points of its lower side. */
START_TEST(points_that_face_away_from_an_edge_do_not_touch_it)
{
    for (int k = 0; k < COUNT(ANGLES); k++) {
        const double c = cos(radians(ANGLES[k])), s = sin(radians(ANGLES[k]));
        bbm_model *m = new_blocks();
        add_rectangle(m, 0, BASE, (rectangle){ -5, -1, 10, 1, ANGLES[k], .fixed = 1 });
        const int e = add_rectangle(m, 1, ROCK, (rectangle){ -1, 0.03, 2, 0.01,
                                                             ANGLES[k], .nx = 4 });
        for (int i = e; i < e + 4; i++)
            set_velocity(m, i, 5 * s, -5 * c);
        detect(m);
        ck_assert_msg(m->contacts == 5, "%d pairs may touch, expected 5", m->contacts);
        for (int i = 0; i < m->contacts; i++) {
            const bbm_vertex *P = corner_vertex(m, &m->contact[i]);
            ck_near(c * P->y - s * P->x, 0.03, 1, ROUNDING);
        }
        release(m);
    }
}
END_TEST

/* A slab of two elements a little above a table, bent so that from the grid point in the middle of
 * its lower side one half, or the other, or both fall towards the table: by a tenth, to the last
 * bit, the point may still touch the table, by more it may not. */
START_TEST(a_grid_point_in_a_hollow_may_touch_up_to_a_tenth)
{
    const int halves = 1 + _i / 2;
    const double sine = _i % 2 ? 0.1001 : 0.1, gap = 1e-3;
    bbm_model *m = weightless_blocks();
    int n, found = 0;

    add_table(m, 0);
    add_rectangle(m, 1, ROCK, (rectangle){ .x = -1, .y = gap, .w = 2, .h = 1, .nx = 2 });
    set_velocity(m, 1, 0, -20);
    shift_element(m, 1, 0, -gap);
    shift_element(m, 2, 0, -gap);
    for (int k = 0; k < 2; k++)
        if (halves & (1 << k)) {
            bbm_vertex *end = &m->vertex[m->element[1 + k].first + k];
            end->x = (k ? 1 : -1) * sqrt(1 - sine * sine);
            end->y = -sine;
            ck_assert(hypot(end->x, end->y) == 1);
        }
    const bbm_contact *list = start_step(m, &n);
    for (int k = 0; k < n; k++)
        found += corner_vertex(m, &list[k])->x == 0;
    ck_assert_msg(found == (_i % 2 == 0), "bent by the sine %g, the point %s", sine,
                  found ? "may touch" : "may not touch");
}
END_TEST

/* A block in four pieces whose middle is 2 cm short of the end of its table, or 2 cm beyond, in
 * steps so long that the grid point there is in reach: only what lies on the table is held, so that
 * the block stays, or falls. */
START_TEST(grid_points_beyond_the_end_of_a_table_are_not_held)
{
    for (int k = 0; k < 2 * COUNT(ANGLES); k++) {
        const double beyond = k % 2 ? 0.02 : -0.02, angle = radians(ANGLES[k / 2]);
        bbm_model *m = new_blocks();
        m->par.friction = 30;
        m->par.dt = 0.1;
        m->par.gravity[0] = GRAVITY * sin(angle);
        m->par.gravity[1] = -GRAVITY * cos(angle);
        add_rectangle(m, 0, BASE, (rectangle){ -5, -1, 10, 1, ANGLES[k / 2], .fixed = 1 });
        const double x = _i ? 5 + beyond - 0.5 : -5 - beyond - 0.5;
        const int e = add_rectangle(m, 1, ROCK, (rectangle){ x, 0, 1, 0.25,
                                                             ANGLES[k / 2], .nx = 4 });
        for (int step = 0; step < 8; step++) {
            run_steps(m, 1);
            for (int c = 0; c < m->contacts; c++) {
                const bbm_vertex *P = corner_vertex(m, &m->contact[c]);
                const double along = fabs(cos(angle) * P->x + sin(angle) * P->y);
                ck_assert(m->contact[c].state == BBM_OPEN || along < 5 + 1e-3);
            }
        }
        const double *way = m->element[e + (_i ? 3 : 0)].sum;
        const double drop = -sin(angle) * way[0] + cos(angle) * way[1];
        ck_assert_msg(k % 2 ? drop < -1e-3 : fabs(drop) < 1e-4, "%g", drop);
        release(m);
    }
}
END_TEST

/* ------------------------------------------------------------------ how far the detection looks */

/* A block comes to a fixed one, down or from the side: the detection looks for 1.1 times its way. */
START_TEST(the_detection_looks_as_far_as_a_block_comes_in_the_step)
{
    const double v = 1, gap = (_i % 2 ? 1.02 : 0.98) * 1.1 * v * 0.2;
    const int level = _i / 2;
    bbm_model *m = new_blocks();

    m->par.dt = 0.2;
    add_table(m, 0);
    add_rectangle(m, 1, ROCK, (rectangle){ .x = level ? 5 + gap : 0, .y = level ? -0.75 : gap,
                                           .w = 1, .h = 0.5 });
    set_velocity(m, 1, level ? -v : 0, level ? 0 : -v);
    detect(m);
    ck_assert_int_eq(m->contacts, _i % 2 ? 0 : 2);
    release(m);
}
END_TEST

/* It falls from rest, which the velocities do not foretell: the step is detected again by its solution. */
START_TEST(what_falls_from_rest_is_met_in_the_same_step)
{
    const double gap = (_i ? 1.1 : 0.9) * GRAVITY * 0.2 * 0.2 / 2;
    bbm_model *m = new_blocks();
    int closed = 0;

    m->par.dt = 0.2;
    add_table(m, 0);
    add_rectangle(m, 1, ROCK, (rectangle){ .y = gap, .w = 1, .h = 0.5 });
    run_steps(m, 1);
    for (int k = 0; k < m->contacts; k++)
        closed += m->contact[k].state != BBM_OPEN;
    ck_assert_int_eq(closed, _i ? 0 : 2);
    release(m);
}
END_TEST

/* Four unit squares, two for a floor and two above it. Of those above, one or both are on the
 * floor; then they stand elsewhere in the same step. Only the same pairs of corners and edges, in
 * the same step, are the same list; that keeps its states. */
static const struct { double x[2], y[2]; int same; } MOVES[] = {
    { { 0, 5 }, { 0, 5 }, 1 },          /* as it was                                         */
    { { 3, 5 }, { 0, 5 }, 0 },          /* the same corners, the other half of the floor     */
    { { 0, 0 }, { 5, 0 }, 0 },          /* the corners of the other block, the same edge     */
    { { 0, 3 }, { 0, 0 }, 0 },          /* and another contact                               */
    { { 5, 5 }, { 5, 5 }, 0 },          /* none                                              */
};

START_TEST(a_list_is_the_same_if_it_has_the_same_pairs_in_the_same_step)
{
    bbm_model *m = weightless_blocks();
    int n, same = -1;

    for (int k = 0; k < 2; k++)
        add_rectangle(m, k, BASE, (rectangle){ .x = 3 * k - 0.5, .y = -1, .w = 2, .h = 1 });
    for (int k = 0; k < 2; k++)
        add_rectangle(m, 2 + k, ROCK, (rectangle){ .x = 5.0 * k, .y = 5.0 * k, .w = 1, .h = 1 });
    start_step(m, &n);
    m->info.step = 1;
    ck_assert_int_eq(look_at(m, 2, 0, -1e-3), 2);
    for (int k = 0; k < 2; k++)
        shift_element(m, 2 + k, MOVES[_i].x[k] - 5 * k, MOVES[_i].y[k] - 5 * k);
    ck_ok(bbm_detect_contacts(m, &same), m);
    ck_assert_int_eq(same, MOVES[_i].same);
    const bbm_contact *list = list_contacts(m, &n);
    for (int k = 0; k < n; k++)
        ck_assert_int_eq(list[k].state, same ? BBM_LOCK : BBM_OPEN);
    ck_ok(bbm_detect_contacts(m, &same), m);
    ck_assert_int_eq(same, 1);
    bbm_foresee_step(m);
    ck_ok(bbm_detect_contacts(m, &same), m);
    ck_assert_int_eq(same, 0);
}
END_TEST

/* Two blocks fly, the elements of both in turn in the model; one of them has an element that is
 * fast, and that far all its corners are looked for, also those of the other element; but not
 * those of the other block. */
START_TEST(a_block_reaches_as_far_as_its_fastest_element_wherever_that_stands_in_the_model)
{
    const double gap = 0.02;
    const int fast = _i;
    bbm_model *m = weightless_blocks();
    int found[2] = { 0, 0 }, n;

    add_rectangle(m, 7, BASE, (rectangle){ .x = -10, .y = -1, .w = 30, .h = 1 });
    for (int k = 0; k < 4; k++) {
        const double x = 5 * (k % 2) + 1.5 * (k / 2);
        add_rectangle(m, 3 - k % 2, ROCK, (rectangle){ .x = x, .y = gap, .w = 1, .h = 1 });
    }
    set_velocity(m, 1 + fast, 0, 3);
    const bbm_contact *list = start_step(m, &n);
    for (int k = 0; k < n; k++)
        found[corner_block(m, &list[k]) == 2]++;
    ck_assert_int_eq(found[fast % 2], 4);
    ck_assert_int_eq(found[!(fast % 2)], 0);
}
END_TEST

/* Unit squares one above the other, at rest: each may move by half of a millionth of an edge, and
 * lie a millionth deep, so that gaps of two millionths are in reach, to the last bit. */
START_TEST(two_blocks_at_rest_reach_two_millionths_of_an_edge)
{
    const double gap = _i ? nextafter(2e-6, 1) : 2e-6;
    bbm_model *m = weightless_blocks();

    add_rectangle(m, 0, BASE, (rectangle){ .x = 0, .y = -1, .w = 1, .h = 1 });
    add_rectangle(m, 1, ROCK, (rectangle){ .x = 0, .y = gap, .w = 1, .h = 1 });
    detect(m);
    ck_assert_int_eq(m->contacts, _i ? 0 : 2);
}
END_TEST

Suite *detection_suite(void)
{
    Suite *s = suite_create("detection");

    add_case(s, "outlines",
        { the_sweep_finds_the_pairs_that_comparing_all_with_all_finds, 6 },
        { the_sweep_finds_the_contacts_of_a_row_in_any_direction, 9 },
        { the_detection_compares_a_corner_with_the_few_edges_around_it, 4 },
        { a_block_does_not_touch_itself, 1 },
        { an_inner_corner_is_no_corner, 1 },
        { each_of_two_tips_in_a_node_is_a_corner, COUNT(TIPS) },
        { the_list_of_contacts_does_not_depend_on_the_order_of_the_blocks, COUNT(ANGLES) });
    add_case(s, "grid points",
        { two_blocks_on_each_other_touch_at_the_two_ends_of_their_joint, COUNT(SEATS) },
        { of_two_corners_at_one_place_that_of_the_smaller_block_touches, 4 },
        { in_statics_the_grid_points_of_the_finer_side_touch, 6 },
        { grid_points_touch_a_shorter_side_that_is_held, 2 },
        { of_two_equal_sides_the_grid_points_of_the_finer_one_touch, 3 * COUNT(ANGLES) },
        { of_two_sides_the_grid_points_of_the_shorter_one_touch, 2 },
        { rounding_in_a_model_file_does_not_undo_a_contact, 4 },
        { a_node_where_triangles_meet_on_a_straight_side_is_no_corner, 2 },
        { grid_points_beyond_the_end_of_a_table_are_not_held, 2 });
    add_case(s, "entering",
        { sides_are_parallel_up_to_a_hundredth, 8 },
        { points_that_face_away_from_an_edge_do_not_touch_it, 1 },
        { a_grid_point_in_a_hollow_may_touch_up_to_a_tenth, 6 });
    add_case(s, "reach",
        { the_detection_looks_as_far_as_a_block_comes_in_the_step, 4 },
             { what_falls_from_rest_is_met_in_the_same_step, 2 },
        { a_list_is_the_same_if_it_has_the_same_pairs_in_the_same_step, COUNT(MOVES) },
        { a_block_reaches_as_far_as_its_fastest_element_wherever_that_stands_in_the_model, 4 },
        { two_blocks_at_rest_reach_two_millionths_of_an_edge, 2 });
    return s;
}
