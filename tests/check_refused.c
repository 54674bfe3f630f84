/* check_refused.c - tests of what is refused or said: blocks that overlap, meshes in pieces, mechanisms, runs that fail.
 *
 * Oracles: outlines whose overlap is known on paper; random polygons against a count of points that lie in both; the
 * rank of the conditions by dense elimination.
 */
#include <stdio.h>
#include <string.h>

#include "check.h"

static const double PI = 3.14159265358979323846;

/* A number in [-1, 1], in the same order in every run (Numerical Recipes' linear congruence). */
static double random_number(unsigned *seed)
{
    *seed = (1664525u * *seed + 1013904223u) & 0xffffffffu;
    return (double)(*seed >> 8) / 8388608.0 - 1;
}

static bbm_model *new_model(void)
{
    const bbm_material rock = { 1e10, 0.25, 2500, 1 };
    bbm_model *m;

    ck_assert_int_eq(bbm_model_new(&m), BBM_OK);
    ck_ok(bbm_add_material(m, &rock, NULL), m);
    return m;
}

/* Adds a polygon with nodes of its own as one element; its index. */
static int add_polygon(bbm_model *m, int block, int n, const double p[][2])
{
    int node[40], e = -1;

    ck_assert_int_le(n, 40);
    for (int k = 0; k < n; k++)
        ck_ok(bbm_add_node(m, p[k][0], p[k][1], &node[k]), m);
    ck_ok(bbm_add_element(m, block, 0, n, node, &e), m);
    return e;
}

/* Adds a rectangle of nx times ny elements, turned about the origin [degree]; the index of its first node. */
static int add_grid(bbm_model *m, int block, double x, double y, double w, double h, int nx, int ny, double angle)
{
    const double c = cos(angle * PI / 180), s = sin(angle * PI / 180);
    const int node = m->nodes;

    for (int k = 0; k < (nx + 1) * (ny + 1); k++) {
        const double px = x + w * (k % (nx + 1)) / nx, py = y + h * (k / (nx + 1)) / ny;
        ck_ok(bbm_add_node(m, c * px - s * py, s * px + c * py, NULL), m);
    }
    for (int k = 0; k < nx * ny; k++) {
        const int a = node + k / nx * (nx + 1) + k % nx;
        ck_ok(bbm_add_element(m, block, 0, 4, (int[]){ a, a + 1, a + nx + 2, a + nx + 1 }, NULL), m);
    }
    return node;
}

/* --------------------------------------------------------------------------------------------- blocks that overlap */

/* Two outlines, the depth of their overlap (0: they only touch), and the place. */
typedef struct {
    const char *name;
    int n[2];
    double p[2][12][2], depth, x, y;
} outlines;

static const outlines OUTLINES[] = {
    { "5 mm of a block of 1 m", { 4, 4 },
      { { { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 } }, { { 0, 0.995 }, { 1, 0.995 }, { 1, 2 }, { 0, 2 } } }, 5e-3, 0.5, 0.9975 },
    { "sides that touch", { 4, 4 },
      { { { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 } }, { { 0.5, 1 }, { 2, 1 }, { 2, 2 }, { 0.5, 2 } } }, 0, 0, 0 },
    { "sides that touch but for rounding", { 4, 4 },
      { { { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 } },
        { { 0.5, 1 - 1e-9 }, { 2, 1 - 1e-9 }, { 2, 2 }, { 0.5, 2 } } }, 0, 0, 0 },
    { "one micrometre and a half", { 4, 4 },
      { { { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 } },
        { { 0, 1 - 1.5e-6 }, { 1, 1 - 1.5e-6 }, { 1, 2 }, { 0, 2 } } }, 1.5e-6, 0.5, 1 - 0.75e-6 },
    { "half a micrometre", { 4, 4 },
      { { { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 } },
        { { 0, 1 - 0.5e-6 }, { 1, 1 - 0.5e-6 }, { 1, 2 }, { 0, 2 } } }, 0, 0, 0 },
    { "a corner on a side", { 4, 3 },
      { { { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 } }, { { 0.5, 1 }, { 1, 2 }, { 0, 2 } } }, 0, 0, 0 },
    { "a corner in a side", { 4, 3 },
      { { { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 } }, { { 0.5, 0.9 }, { 1.5, 1.9 }, { -0.5, 1.9 } } }, 0.1, 0.5, 2.9 / 3 },
    { "bars that cross", { 4, 4 },
      { { { -5, -0.1 }, { 5, -0.1 }, { 5, 0.1 }, { -5, 0.1 } }, { { 2, -3 }, { 2.5, -3 }, { 2.5, 3 }, { 2, 3 } } },
      3, 2.25, 0 },
    { "a block within another", { 4, 4 },
      { { { 0, 0 }, { 10, 0 }, { 10, 10 }, { 0, 10 } }, { { 1, 4 }, { 2, 4 }, { 2, 5 }, { 1, 5 } } }, 2, 1.5, 4.5 },
    { "one and the same block", { 4, 4 },
      { { { 0, 0 }, { 2, 0 }, { 2, 1 }, { 0, 1 } }, { { 2, 0 }, { 2, 1 }, { 0, 1 }, { 0, 0 } } }, 1, 1, 0.5 },
    { "a square in the notch of an L", { 6, 4 },
      { { { 0, 0 }, { 2, 0 }, { 2, 1 }, { 1, 1 }, { 1, 2 }, { 0, 2 } }, { { 1, 1 }, { 2, 1 }, { 2, 2 }, { 1, 2 } } }, 0, 0, 0 },
    { "a square that cuts into the notch of an L", { 6, 4 },
      { { { 0, 0 }, { 2, 0 }, { 2, 1 }, { 1, 1 }, { 1, 2 }, { 0, 2 } },
        { { 0.9, 1.2 }, { 2, 1.2 }, { 2, 1.8 }, { 0.9, 1.8 } } }, 0.1, 0.95, 1.5 },
    { "a block in the mouth of a U with collinear corners", { 10, 4 },
      { { { 0, 0 }, { 1, 0 }, { 3, 0 }, { 3, 3 }, { 2, 3 }, { 2, 2 }, { 2, 1 }, { 1, 1 }, { 1, 3 }, { 0, 3 } },
        { { 1, 1 }, { 2, 1 }, { 2, 3 }, { 1, 3 } } }, 0, 0, 0 },
    { "a sliver through a block", { 4, 4 },
      { { { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 } },
        { { -5, 0.5 }, { 5, 0.5 }, { 5, 0.5001 }, { -5, 0.5001 } } }, 0.5, 0.5, 0.50005 },
    { "apart, boxes overlap", { 3, 3 },
      { { { 0, 0 }, { 1, 0 }, { 0, 1 } }, { { 1, 1 }, { 0.01, 1 }, { 1, 0.01 } } }, 0, 0, 0 },
};

START_TEST(blocks_that_overlap_are_refused_with_depth_and_place)
{
    const outlines *o = &OUTLINES[_i / 2];
    bbm_model *m = new_model();
    bbm_overlap found;

    for (int k = 0; k < 2; k++)
        add_polygon(m, 7 + k, o->n[k ^ _i % 2], o->p[k ^ _i % 2]);
    const bbm_status status = bbm_prepare(m);
    ck_assert_msg(status == (o->depth > 0 ? BBM_BLOCKS_OVERLAP : BBM_OK), "%s: %s", o->name, bbm_message(m));
    ck_assert_int_eq(bbm_find_overlap(m, &found), BBM_OK);
    ck_assert_int_eq(found.i, o->depth > 0 ? 0 : -1);
    if (o->depth > 0) {
        ck_assert_int_eq(found.j, 1);
        ck_near(found.depth, o->depth, 10, 1e-15);              /* coordinates are 10 m and smaller */
        ck_near(found.x, o->x, 10, 1e-15);
        ck_near(found.y, o->y, 10, 1e-15);
        ck_assert_ptr_nonnull(strstr(bbm_message(m), "block 7 with element 0, block 8 with element 1"));
    }
    bbm_model_free(m);
}
END_TEST

/* A star of n corners about (x, y): as non-convex as it gets. */
static void star(int n, double x, double y, unsigned *seed, double p[][2])
{
    for (int k = 0; k < n; k++) {
        const double r = 0.55 + 0.45 * random_number(seed), a = 2 * PI * k / n;
        p[k][0] = x + r * cos(a);
        p[k][1] = y + r * sin(a);
    }
}

/* Even-odd rule: whether (x, y) lies in the polygon. */
static int is_inside(int n, double p[][2], double x, double y)
{
    int in = 0;

    for (int a = 0, b = n - 1; a < n; b = a++)
        if ((p[a][1] > y) != (p[b][1] > y) && x < (p[b][0] - p[a][0]) * (y - p[a][1]) / (p[b][1] - p[a][1]) + p[a][0])
            in = !in;
    return in;
}

/* Stars at random distances: where a fine grid of points finds one in both they must be refused, at a place in both;
 * where it finds none, the overlap is shallow against the points' distance of 0.01. */
START_TEST(stars_overlap_where_points_lie_in_both)
{
    enum { N = 17, POINTS = 300 };
    double p[2][N][2];
    unsigned seed = 4711u + (unsigned)_i;
    const double gap = 1 + random_number(&seed), angle = PI * random_number(&seed);
    bbm_model *m = new_model();
    bbm_overlap o;
    int both = 0;

    star(N, 0, 0, &seed, p[0]);
    star(N, gap * cos(angle), gap * sin(angle), &seed, p[1]);
    add_polygon(m, 0, N, (const double (*)[2])p[0]);
    add_polygon(m, 1, N, (const double (*)[2])p[1]);
    for (int k = 0; k < POINTS * POINTS; k++) {
        const double x = -1 + 2.0 * (k % POINTS) / POINTS, y = -1 + 2.0 * (k / POINTS) / POINTS;
        both += is_inside(N, p[0], x, y) && is_inside(N, p[1], x, y);
    }
    const bbm_status status = bbm_prepare(m);
    ck_assert_int_eq(bbm_find_overlap(m, &o), BBM_OK);
    ck_assert_int_eq(status, o.i < 0 ? BBM_OK : BBM_BLOCKS_OVERLAP);
    if (both)
        ck_assert_int_eq(status, BBM_BLOCKS_OVERLAP);
    if (status)
        ck_assert(is_inside(N, p[0], o.x, o.y) && is_inside(N, p[1], o.x, o.y));
    if (status && !both)
        ck_assert_double_lt(o.depth, 0.03);
    bbm_model_free(m);
}
END_TEST

START_TEST(elements_of_one_block_that_overlap_are_refused)
{
    const double square[][2] = { { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 } };
    const double other[][2] = { { 0.5, 0.5 }, { 1.5, 0.5 }, { 1.5, 1.5 }, { 0.5, 1.5 } };
    bbm_model *m = new_model();

    add_polygon(m, 0, 4, square);
    add_polygon(m, 0, 4, other);
    ck_assert_int_eq(bbm_prepare(m), BBM_OVERLAP);
    ck_assert_int_eq(m->culprit, 1);
    ck_assert_int_eq(m->other, 0);
    bbm_model_free(m);
}
END_TEST

/* 5 mm, in meshes of many elements, turned by any angle: the block in front is element by element in the other. */
START_TEST(blocks_of_many_elements_that_overlap_are_refused_at_any_angle)
{
    for (int k = 0; k < 2; k++) {
        bbm_model *m = new_model();
        add_grid(m, 0, 0, 0, 1, 1, 10, 10, 11.0 * _i);
        add_grid(m, 1, 0.33, k ? 1 : 0.995, 1, 1, 7, 7, 11.0 * _i);
        ck_assert_int_eq(bbm_prepare(m), k ? BBM_OK : BBM_BLOCKS_OVERLAP);
        bbm_model_free(m);
    }
}
END_TEST



/* ------------------------------------------------------------------------------------------------ blocks in pieces */

/* 3 x 2 and 2 x 2 elements with nodes of their own along the common side, a triangle that shares one corner with them,
 * and another block. */
START_TEST(a_block_falls_into_the_pieces_that_bonds_join)
{
    bbm_model *m = new_model();
    int piece[20];

    add_grid(m, 0, 0, 0, 3, 2, 3, 2, 0);
    const int node = add_grid(m, 0, 3, 0, 2, 2, 2, 2, 0);
    add_grid(m, 1, 0, 2, 3, 1, 3, 1, 0);
    ck_ok(bbm_add_node(m, 7, 2, NULL), m);
    ck_ok(bbm_add_node(m, 7, 3, NULL), m);
    ck_ok(bbm_add_element(m, 0, 0, 3, (int[]){ node + 8, m->nodes - 2, m->nodes - 1 }, NULL), m);
    ck_ok(bbm_prepare(m), m);
    ck_assert_int_eq(bbm_find_pieces(m, piece), 4);
    for (int e = 0; e < m->elements; e++)
        ck_assert_int_eq(piece[e], e < 6 ? 0 : e < 10 ? 6 : e < 13 ? 10 : 13);
    bbm_model_free(m);
}
END_TEST

/* A node of one element in the middle of the side of another: not one bond. */
START_TEST(a_hanging_node_leaves_pieces)
{
    const double node[][2] = { { 0, 0 }, { 2, 0 }, { 2, 1 }, { 1, 1 }, { 0, 1 }, { 2, 2 }, { 1, 2 }, { 0, 2 } };
    bbm_model *m = new_model();
    int piece[3];

    for (int k = 0; k < 8; k++)
        ck_ok(bbm_add_node(m, node[k][0], node[k][1], NULL), m);
    ck_ok(bbm_add_element(m, 0, 0, 4, (int[]){ 0, 1, 2, 4 }, NULL), m);
    ck_ok(bbm_add_element(m, 0, 0, 4, (int[]){ 4, 3, 6, 7 }, NULL), m);
    ck_ok(bbm_add_element(m, 0, 0, 4, (int[]){ 3, 2, 5, 6 }, NULL), m);
    ck_ok(bbm_prepare(m), m);
    ck_assert_int_eq(bbm_find_pieces(m, piece), 2);
    ck_assert(piece[0] == 0 && piece[1] == 1 && piece[2] == 1);
    bbm_model_free(m);
}
END_TEST

Suite *refused_suite(void)
{
    Suite *s = suite_create("refused");
    TCase *overlap = tcase_create("overlap");

    tcase_add_loop_test(overlap, blocks_that_overlap_are_refused_with_depth_and_place, 0,
                        2 * (int)(sizeof OUTLINES / sizeof *OUTLINES));
    tcase_add_loop_test(overlap, stars_overlap_where_points_lie_in_both, 0, 100);
    tcase_add_test(overlap, elements_of_one_block_that_overlap_are_refused);
    tcase_add_loop_test(overlap, blocks_of_many_elements_that_overlap_are_refused_at_any_angle, 0, 9);
    suite_add_tcase(s, overlap);
    TCase *pieces = tcase_create("pieces");
    tcase_add_test(pieces, a_block_falls_into_the_pieces_that_bonds_join);
    tcase_add_test(pieces, a_hanging_node_leaves_pieces);
    suite_add_tcase(s, pieces);
    return s;
}
