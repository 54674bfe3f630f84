/* check_input.c - what is refused and how it is said; steps that fail; memory. */
#include <stddef.h>
#include <stdio.h>
#include <string.h>

#include "check.h"
#include "models.h"

/* ----------------------------------------------------------------------------------- bad models */

/* Fails unless the status is the expected one and the message opens with its text and names what it
 * was about. */
static void check_error(const bbm_model *m, bbm_status got, bbm_status expected, const char *named)
{
    const char *text = bbm_status_text(expected), *message = bbm_message(m);

    ck_assert_msg(got == expected, "%s (%s), expected %s", bbm_status_text(got), message, text);
    ck_assert_msg(strncmp(message, text, strlen(text)) == 0 && strstr(message, named),
                  "\"%s\", expected \"%s: ...%s...\"", message, text, named);
}

static const struct { bbm_material material; bbm_status status; const char *named; }
BAD_MATERIALS[] = {
    { { NAN, 0.3, 1, 1 }, BBM_BAD_MATERIAL, "material 1 has E = nan" },
    { { 1, INFINITY, 1, 1 }, BBM_BAD_MATERIAL, "material 1 has nu = inf" },
    { { 1, NAN, 1, 1 }, BBM_BAD_MATERIAL, "material 1 has nu = nan" },
    { { 1, 0.3, NAN, 1 }, BBM_BAD_MATERIAL, "material 1 has density = nan" },
    { { 1, 0.3, 1, -INFINITY }, BBM_BAD_MATERIAL, "material 1 has thickness = -inf" },
    { { 0, 0.3, 1, 1 }, BBM_BAD_MATERIAL, "material 1 has E = 0" },
    { { -5, 0.3, 1, 1 }, BBM_BAD_MATERIAL, "material 1 has E = -5" },
    { { 1e-200, 0.3, 1, 1 }, BBM_BAD_MATERIAL, "E = 1e-200, expected more than 0, from 1e-100 to 1e+100" },
    { { 1, -1, 1, 1 }, BBM_BAD_MATERIAL, "material 1 has nu = -1" },
    { { 1, 0.5, 1, 1 }, BBM_BAD_MATERIAL, "material 1 has nu = 0.5" },
    { { 1, 0.6, 1, 1 }, BBM_BAD_MATERIAL, "material 1 has nu = 0.6" },
    { { 1, 0.3, 0, 1 }, BBM_BAD_MATERIAL, "material 1 has density = 0" },
    { { 1, 0.3, -2, 1 }, BBM_BAD_MATERIAL, "material 1 has density = -2" },
    { { 1, 0.3, 1, 0 }, BBM_BAD_MATERIAL, "material 1 has thickness = 0" },
    { { 1, 0.3, 1, -3 }, BBM_BAD_MATERIAL, "material 1 has thickness = -3" },
};

START_TEST(bad_materials_are_refused)
{
    bbm_model *m = new_model(&SOLID);

    check_error(m, bbm_add_material(m, &BAD_MATERIALS[_i].material, NULL), BAD_MATERIALS[_i].status,
                BAD_MATERIALS[_i].named);
    ck_assert_int_eq(bbm_prepare(m), BAD_MATERIALS[_i].status);
}
END_TEST

START_TEST(materials_up_to_the_limits_are_taken)
{
    const bbm_material limit[] = { { 1e-100, 0.499, 1e-100, 1e-100 }, { 1, -0.999, 1, 1 },
                                   { 1e100, 0, 1e100, 1e100 } };
    bbm_model *m = new_model(&SOLID);

    for (int i = 0; i < COUNT(limit); i++)
        ck_ok(bbm_add_material(m, &limit[i], NULL), m);
}
END_TEST

enum { MOST = 12 };

static const struct { bbm_status status; int n, node[MOST]; } POLYGONS[] = {
    { BBM_BAD_ELEMENT, 0, { 0 } },
    { BBM_BAD_ELEMENT, 2, { 0, 1 } },
    { BBM_BAD_ELEMENT, 3, { 0, 1, 2 } },                      /* a line */
    { BBM_BAD_ELEMENT, 3, { 6, 6, 6 } },                      /* a point */
    { BBM_BAD_ELEMENT, 3, { 0, 6, 0 } },
    { BBM_SELF_CROSSING, 4, { 0, 6, 18, 12 } },            /* there and back */
    { BBM_BAD_ELEMENT, 3, { 0, 2, 25 } },                     /* as flat as rounding */
    { BBM_BAD_ELEMENT, 3, { 0, 10, 27 } },
    { BBM_BAD_ELEMENT, 3, { 0, 5, 27 } },                     /* long, with one short side */
    { BBM_OK, 3, { 0, 2, 26 } },                            /* flat, but not a line */
    { BBM_SELF_CROSSING, 4, { 0, 2, 10, 12 } },  /* bow ties, of no signed area and of some */
    { BBM_SELF_CROSSING, 4, { 0, 3, 10, 12 } },
    { BBM_SELF_CROSSING, 4, { 0, 1, 15, 18 } },
    { BBM_SELF_CROSSING, 5, { 0, 4, 11, 22, 13 } },         /* the pentagram's way */
    { BBM_SELF_CROSSING, 4, { 0, 2, 2, 12 } },              /* a node twice running */
    { BBM_SELF_CROSSING, 6, { 0, 2, 6, 12, 10, 6 } },       /* ... and at a pinch */
    { BBM_SELF_CROSSING, 4, { 0, 4, 2, 12 } },  /* spikes: along the side, and from a corner */
    { BBM_SELF_CROSSING, 5, { 0, 2, 12, 18, 6 } },
    { BBM_SELF_CROSSING, 5, { 0, 2, 12, 1, 10 } },          /* a corner on a side */
    { BBM_SELF_CROSSING, 5, { 0, 2, 5, 12, 10 } },
    { BBM_SELF_CROSSING, 6, { 0, 4, 14, 11, 3, 10 } },
    { BBM_SELF_CROSSING, 8, { 0, 4, 9, 2, 1, 5, 15, 10 } }, /* sides that lie on one another */
    { BBM_SELF_CROSSING, 7, { 0, 4, 24, 23, 3, 1, 20 } },
    { BBM_OK, 4, { 0, 2, 12, 10 } },
    { BBM_OK, 5, { 0, 1, 2, 12, 10 } },                     /* a straight corner */
    { BBM_OK, 4, { 0, 4, 6, 20 } },                         /* an arrow */
    { BBM_OK, 6, { 0, 4, 9, 6, 21, 20 } },                  /* an L */
    { BBM_OK, 8, { 0, 4, 24, 23, 8, 6, 21, 20 } },  /* a U: sides in line with one another, apart */
    { BBM_OK, 12, { 1, 3, 8, 9, 19, 18, 23, 21, 16, 15, 5, 6 } },   /* a cross */
    { BBM_OK, 8, { 0, 6, 2, 8, 4, 24, 22, 20 } },  /* teeth: tips in line with the side behind */
    { BBM_OK, 8, { 0, 4, 14, 13, 7, 11, 15, 5 } },
};

/* From each corner, either way round, and whether it is measured in micrometres or kilometres: the
 * answer belongs to the polygon, not to how it is written. */
START_TEST(polygons_are_judged_by_their_shape)
{
    const int n = POLYGONS[_i].n, starts = n < 1 ? 1 : n;

    for (int way = 0; way < 6 * starts; way++) {
        const int start = way / 6;
        bbm_model *m = points(ldexp(1, 27 * (way % 3 - 1)));
        int node[MOST];
        for (int c = 0; c < n; c++)
            node[c] = POLYGONS[_i].node[(way % 2 ? start + n - c : start + c) % n];
        ck_ok(bbm_add_element(m, 0, 0, 3, (int[]){ 0, 1, 5 }, NULL), m);
        const bbm_status status = bbm_add_element(m, 1, 0, n, node, NULL);
        if (POLYGONS[_i].status != BBM_OK)
            check_error(m, status, POLYGONS[_i].status, "element 1");
        else
            ck_ok(status, m);
        release(m);
    }
}
END_TEST

static void not_a_number(double x, double y, const void *context, double f[2])
{
    const int *component = context;

    f[0] = f[1] = x + y;
    f[*component] = x + y > 1.5 ? NAN : 0;  /* at some of the points only */
}

static const int COMPONENT[2] = { 0, 1 };

/* One wrong call each on the unit square. */
static bbm_status call_wrongly(bbm_model *m, int which)
{
    const int corners[4] = { 0, 1, 2, 3 }, high[3] = { 0, 1, 4 }, low[3] = { -1, 1, 2 };
    const int flat[3] = { 0, 2, 0 };

    switch (which) {
    case 0:  return bbm_add_node(m, NAN, 2, NULL);
    case 1:  return bbm_add_node(m, 2, INFINITY, NULL);
    case 2:  return bbm_add_element(m, 0, 1, 4, corners, NULL);
    case 3:  return bbm_add_element(m, 0, -1, 4, corners, NULL);
    case 4:  return bbm_add_element(m, 0, 0, 3, high, NULL);
    case 5:  return bbm_add_element(m, 0, 0, 3, low, NULL);
    case 6:  return bbm_fix_node(m, 4, BBM_XY, 0, 0);
    case 7:  return bbm_fix_node(m, -1, BBM_XY, 0, 0);
    case 8:  return bbm_fix_node(m, 2, 0, 0, 0);
    case 9:  return bbm_fix_node(m, 2, 4, 0, 0);
    case 10: return bbm_fix_node(m, 2, BBM_X, NAN, 0);
    case 11: return bbm_fix_node(m, 2, BBM_X, 0, INFINITY);
    case 12: return bbm_add_load(m, 4, 1, 1);
    case 13: return bbm_add_load(m, 3, NAN, 1);
    case 14: return bbm_add_load(m, 3, 1, -INFINITY);
    case 15: return bbm_add_line_load(m, 0, 4, 1, 1);
    case 16: return bbm_add_line_load(m, -1, 3, 1, 1);
    case 17: return bbm_add_line_load(m, 0, 1, NAN, 1);
    case 18: return bbm_add_line_load(m, 0, 1, 1, NAN);
    case 19: return bbm_add_varying_line_load(m, 0, 4, not_a_number, &COMPONENT[0]);
    case 20: return bbm_add_varying_line_load(m, -2, 1, not_a_number, &COMPONENT[0]);
    case 21: return bbm_add_varying_line_load(m, 2, 1, not_a_number, &COMPONENT[0]);
    case 22: return bbm_add_varying_line_load(m, 1, 2, not_a_number, &COMPONENT[1]);
    case 23: return bbm_add_element(m, 0, 0, 2, corners, NULL);
    case 24: return bbm_add_element(m, -1, 0, 4, corners, NULL);
    case 25: return bbm_add_varying_line_load(m, 1, 2, NULL, NULL);
    default: return bbm_add_element(m, 0, 0, 3, flat, NULL);
    }
}

static const struct { bbm_status status; const char *named; } WRONG_CALLS[] = {
    { BBM_NOT_FINITE, "node 4 at (nan, 2)" },
    { BBM_NOT_FINITE, "node 4 at (2, inf)" },
    { BBM_BAD_INDEX, "element 1 has material 1 of 1" },
    { BBM_BAD_INDEX, "element 1 has material -1 of 1" },
    { BBM_BAD_INDEX, "element 1 has node 4 of 4" },
    { BBM_BAD_INDEX, "element 1 has node -1 of 4" },
    { BBM_BAD_INDEX, "fixed node 4 of 4" },
    { BBM_BAD_INDEX, "fixed node -1 of 4" },
    { BBM_BAD_PARAMETER, "directions 0 of fixed node 2" },
    { BBM_BAD_PARAMETER, "directions 4 of fixed node 2" },
    { BBM_NOT_FINITE, "fixed node 2" },
    { BBM_NOT_FINITE, "fixed node 2" },
    { BBM_BAD_INDEX, "loaded node 4 of 4" },
    { BBM_NOT_FINITE, "node 3" },
    { BBM_NOT_FINITE, "node 3" },
    { BBM_BAD_INDEX, "nodes 0, 4 of 4" },
    { BBM_BAD_INDEX, "nodes -1, 3 of 4" },
    { BBM_NOT_FINITE, "nodes 0, 1" },
    { BBM_NOT_FINITE, "nodes 0, 1" },
    { BBM_BAD_INDEX, "nodes 0, 4 of 4" },
    { BBM_BAD_INDEX, "nodes -2, 1 of 4" },
    { BBM_NOT_FINITE, "nodes 2, 1" },
    { BBM_NOT_FINITE, "nodes 1, 2" },
    { BBM_BAD_ELEMENT, "element 1 has 2 vertices" },
    { BBM_BAD_INDEX, "element 1 has block -1, expected 0 or more" },
    { BBM_BAD_PARAMETER, "the line load on nodes 1, 2 has no f" },
    { BBM_BAD_ELEMENT, "element 1 has no area" },
};

/* After it, correct calls of every kind return the same status and change nothing. */
START_TEST(the_first_error_of_building_stays)
{
    const bbm_status first = WRONG_CALLS[_i].status;
    const double scale[2] = { 1, 1 };
    bbm_model *m = unit_square(&SOLID);
    char message[sizeof m->message];

    check_error(m, call_wrongly(m, _i), first, WRONG_CALLS[_i].named);
    strcpy(message, bbm_message(m));
    ck_assert_int_eq(bbm_add_material(m, &BAD_MATERIALS[0].material, NULL), first);
    ck_assert_int_eq(bbm_add_material(m, &CORK, NULL), first);
    ck_assert_int_eq(bbm_add_node(m, 2, 3, NULL), first);
    ck_assert_int_eq(bbm_add_element(m, 0, 0, 4, (int[]){ 0, 1, 2, 3 }, NULL), first);
    ck_assert_int_eq(bbm_fix_node(m, 0, BBM_XY, 0, 0), first);
    ck_assert_int_eq(bbm_add_load(m, 0, 1, 1), first);
    ck_assert_int_eq(bbm_add_line_load(m, 0, 1, 1, 1), first);
    ck_assert_int_eq(bbm_add_varying_line_load(m, 0, 1, rising_load, scale), first);
    ck_assert_int_eq(bbm_prepare(m), first);
    ck_assert_int_eq(bbm_run(m), first);
    ck_assert_str_eq(bbm_message(m), message);
    ck_assert(m->materials == 1 && m->nodes == 4 && m->elements == 1 && m->line_loads == 0);
    ck_assert(m->node[0].held == 0 && m->node[0].load[0] == 0);
}
END_TEST

START_TEST(a_model_without_elements_is_refused)
{
    bbm_model *m = points(1);

    check_error(m, bbm_prepare(m), BBM_NO_ELEMENT, "28 nodes");
}
END_TEST

START_TEST(a_node_that_no_element_has_is_named)
{
    bbm_model *m = unit_square(&SOLID);

    ck_ok(bbm_add_node(m, 2.5, -3, NULL), m);
    ck_ok(bbm_add_node(m, 0.5, 7, NULL), m);
    check_error(m, bbm_prepare(m), BBM_UNUSED_NODE, "node 4 at (2.5, -3)");
    ck_ok(bbm_add_element(m, 0, 0, 3, (int[]){ 1, 4, 2 }, NULL), m);  /* a model may be mended */
    check_error(m, bbm_prepare(m), BBM_UNUSED_NODE, "node 5 at (0.5, 7)");
    ck_ok(bbm_add_element(m, 0, 0, 3, (int[]){ 2, 5, 3 }, NULL), m);
    ck_ok(bbm_prepare(m), m);
}
END_TEST

START_TEST(elements_of_one_block_on_the_same_side_of_an_edge_are_named)
{
    const double top[3][2] = { { 0, 1 }, { 1, 1 }, { 0.5, -1 } };
    bbm_model *m = fan(2, top, (int[]){ 0, 0 }), *n = fan(3, top, (int[]){ 6, 6, 6 });
    bbm_model *o = fan(2, top, (int[]){ 0, 1 }), *p = fan(2, top + 1, (int[]){ 0, 0 });

    const char *const said = "element 0 and element 1 on the same side, from node 0 to node 1";
    check_error(m, bbm_prepare(m), BBM_OVERLAP, said);
    check_error(n, bbm_prepare(n), BBM_OVERLAP, said);
    check_error(o, bbm_prepare(o), BBM_BLOCKS_OVERLAP,
                "0.25 m deep at (0.75, 0.25): block 0 with element 0, "
                "block 1 with element 1");
    ck_ok(bbm_prepare(p), p);                                              /* above and below */
    ck_assert(o->bonds == 0 && p->bonds == 1);
}
END_TEST

START_TEST(a_load_on_an_edge_that_does_not_exist_is_refused)
{
    bbm_model *m = unit_square(&SOLID);

    if (_i > 0)
        ck_ok(bbm_prepare(m), m);
    if (_i == 3)
        ck_ok(bbm_load_edge(m, 3, 1, 2, 3), m);
    else
        check_error(m, bbm_load_edge(m, (int[]){ 0, -1, 4 }[_i], 1, 2, 3), BBM_BAD_INDEX,
                    "loaded edge");
}
END_TEST

START_TEST(a_line_load_on_what_is_no_boundary_edge_is_refused)
{
    /* inside, a diagonal, points */
    const int nodes[4][2] = { { 1, 4 }, { 0, 4 }, { 2, 2 }, { 0, 0 } };
    const char *const named[4] = { "nodes 1 and 4", "nodes 0 and 4", "nodes 2 and 2",
                                   "nodes 0 and 0" };
    bbm_model *m = two_squares(0, 0);

    ck_ok(bbm_add_line_load(m, 0, 1, 1, 1), m);
    ck_ok(bbm_add_line_load(m, nodes[_i][0], nodes[_i][1], 1, 1), m);
    check_error(m, bbm_prepare(m), BBM_NOT_BOUNDARY, named[_i]);
}
END_TEST

START_TEST(a_load_on_an_edge_that_two_blocks_have_goes_to_the_first)
{
    const double top[2][2] = { { 0, 1 }, { 1, -1 } };
    bbm_model *m = fan(2, top, (int[]){ 0, 1 });

    ck_ok(bbm_add_line_load(m, 0, 1, 1, 1), m);
    ck_ok(bbm_prepare(m), m);
    ck_assert(m->line_load[0].a == 0 && m->line_load[0].b == 1);
}
END_TEST

/* Two squares of 1 m, block 5 with nodes 0-3 and block 7 with nodes 4-7, and a second element of
 * block 7 with 8, 9; each numbered counter-clockwise from its left bottom; all times a size, and
 * maybe far from the origin. */
static bbm_model *two_bodies(double size, double far)
{
    const double x[10][2] = { { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 }, { 3, 0 }, { 4, 0 }, { 4, 1 },
                              { 3, 1 }, { 5, 0 },
                              { 5, 1 } };
    bbm_model *m = new_model(&SOLID);

    for (int n = 0; n < 10; n++)
        ck_ok(bbm_add_node(m, size * x[n][0] + far, size * x[n][1] - far, NULL), m);
    ck_ok(bbm_add_element(m, 5, 0, 4, (int[]){ 0, 1, 2, 3 }, NULL), m);
    ck_ok(bbm_add_element(m, 7, 0, 4, (int[]){ 4, 5, 6, 7 }, NULL), m);
    ck_ok(bbm_add_element(m, 7, 0, 4, (int[]){ 5, 8, 9, 6 }, NULL), m);
    return m;
}

static const struct { int points, held[4][2], free_block; } HOLDS[] = {
    /* block 7 is held at node 9 (its second element) and 4 in all but the last */
    { 0, { { 0 } }, 5 },
    { 1, { { 0, BBM_XY } }, 5 },
    { 2, { { 0, BBM_X }, { 3, BBM_X } }, 5 },  /* rollers that let it slide */
    { 4, { { 0, BBM_Y }, { 1, BBM_Y }, { 2, BBM_Y }, { 3, BBM_Y } }, 5 },
    { 2, { { 0, BBM_XY }, { 1, BBM_X } }, 5 },  /* the lines of action meet in a point */
    { 2, { { 0, BBM_XY }, { 3, BBM_Y } }, 5 },
    { 3, { { 3, BBM_X }, { 1, BBM_Y }, { 2, BBM_X } }, 5 },
    { 2, { { 0, BBM_XY }, { 2, BBM_X } }, -1 },
    { 2, { { 0, BBM_XY }, { 1, BBM_Y } }, -1 },
    { 3, { { 0, BBM_X }, { 3, BBM_X }, { 1, BBM_Y } }, -1 },
    { 2, { { 1, BBM_XY }, { 3, BBM_XY } }, -1 },
    { 2, { { 0, BBM_XY }, { 1, BBM_Y } }, 7 },
};

START_TEST(statics_refuses_a_body_that_is_free_to_move_and_names_it)
{
    const double ways[3][2] = { { 1, 0 }, { 1, 1e6 / 3 }, { 1e-6, 0 } };
    const int free_block = HOLDS[_i].free_block;

    for (int way = 0; way < 3; way++) {
        bbm_model *m = two_bodies(ways[way][0], ways[way][1]);
        for (int p = 0; p < HOLDS[_i].points; p++)
            ck_ok(bbm_fix_node(m, HOLDS[_i].held[p][0], HOLDS[_i].held[p][1], 0, 0), m);
        ck_ok(bbm_fix_node(m, 9, BBM_XY, 0, 0), m);
        if (free_block != 7)
            ck_ok(bbm_fix_node(m, 4, BBM_Y, 0, 0), m);
        ck_ok(bbm_prepare(m), m);
        const bbm_status status = bbm_run(m);
        if (free_block < 0) {
            ck_ok(status, m);
        } else {
            check_error(m, status, BBM_FREE_TO_MOVE, free_block == 5 ? "block 5" : "block 7");
            if (free_block == 5 && way == 0)
                check_error(m, status, BBM_FREE_TO_MOVE, "element 0 at (0.5, 0.5)");
            m->par.dt = 0.1;  /* with inertia it may move */
            ck_ok(bbm_run(m), m);
        }
        release(m);
    }
}
END_TEST

/* Two points a millionth of the body apart hold it; at a hundred millionth it counts as free. */
START_TEST(fixed_points_close_together_hold_a_body_within_reason)
{
    for (int way = 0; way < 2; way++) {
        bbm_model *m = new_model(&SOLID);
        const double x[4][2] = { { 0, 0 }, { way ? 1e-3 : 1e-7, 0 }, { 1, 0 }, { 0, 1 } };
        add_polygon(m, 0, 4, x);
        ck_ok(bbm_fix_node(m, 0, BBM_XY, 0, 0), m);
        ck_ok(bbm_fix_node(m, 1, BBM_XY, 0, 0), m);
        ck_ok(bbm_prepare(m), m);
        ck_assert_int_eq(bbm_step(m), way ? BBM_OK : BBM_FREE_TO_MOVE);
        release(m);
    }
}
END_TEST

/* ------------------------------------------------------------------------------- bad parameters */

#define PARAMETER(name, value) { offsetof(bbm_parameters, name), value, #name }
#define SETTING(name, value) { offsetof(bbm_beyond, name), value, #name }

/* Of the core, then of beyond/. */
static const struct { size_t offset; double value; const char *name; } PARAMETERS[] = {
    PARAMETER(dt, 0), PARAMETER(dt, -1), PARAMETER(dt, NAN),
    PARAMETER(tolerance, -1e-9), PARAMETER(tolerance, NAN), PARAMETER(tolerance, INFINITY),
    PARAMETER(velocity_factor, -0.01), PARAMETER(velocity_factor, 1.01),
    PARAMETER(velocity_factor, NAN),
    PARAMETER(alpha, 0), PARAMETER(alpha, -100), PARAMETER(alpha, NAN), PARAMETER(alpha, INFINITY),
    PARAMETER(gravity[0], NAN), PARAMETER(gravity[1], INFINITY),
    PARAMETER(p_n, 0), PARAMETER(p_n, INFINITY), PARAMETER(p_n, NAN),
    PARAMETER(p_s, 0), PARAMETER(p_s, INFINITY), PARAMETER(p_s, NAN),
    PARAMETER(friction, -1), PARAMETER(friction, 90), PARAMETER(friction, NAN),
    PARAMETER(round, -2), PARAMETER(round, INFINITY), PARAMETER(round, NAN),
    PARAMETER(pcg.omega, 0), PARAMETER(pcg.omega, 2), PARAMETER(pcg.omega, NAN),
    PARAMETER(pcg.tolerance, 0), PARAMETER(pcg.tolerance, 2e-6), PARAMETER(pcg.tolerance, NAN),
}, SETTINGS[] = {
    SETTING(cohesion, -1e-9), SETTING(cohesion, INFINITY), SETTING(cohesion, NAN),
    SETTING(tension, -1e-9), SETTING(tension, INFINITY), SETTING(tension, NAN),
    SETTING(shake[0], NAN), SETTING(shake[1], INFINITY), SETTING(shake_omega, -INFINITY),
    SETTING(bond_tension, -1), SETTING(bond_tension, NAN), SETTING(bond_cohesion, NAN), SETTING(bond_friction, 90),
    SETTING(bond_energy, -1e-9), SETTING(reach, -1e-9), SETTING(reach, NAN),
};

/* The unit square, held, loaded and prepared. */
static bbm_model *held_square(void)
{
    bbm_model *m = unit_square(&SOLID);

    ck_ok(bbm_fix_node(m, 0, BBM_XY, 0, 0), m);
    ck_ok(bbm_fix_node(m, 1, BBM_Y, 0, 0), m);
    ck_ok(bbm_add_load(m, 2, 1, -3), m);
    ck_ok(bbm_prepare(m), m);
    return m;
}

static void check_refusal(bbm_model *m, void *numbers, size_t offset, double value, const char *name)
{
    char named[60];

    snprintf(named, sizeof named, "%s = %g", name, value);
    memcpy((char *)numbers + offset, &value, sizeof value);
    check_error(m, bbm_step(m), BBM_BAD_PARAMETER, named);
    ck_assert_int_eq(m->info.step, 0);
    release(m);
}

/* The core knows its parameters by itself, without the hook. */
START_TEST(parameters_outside_their_range_are_refused_by_name)
{
    bbm_model *m = held_square();

    m->hook->begin = NULL;
    check_refusal(m, &m->par, PARAMETERS[_i].offset, PARAMETERS[_i].value, PARAMETERS[_i].name);
}
END_TEST

START_TEST(settings_outside_their_range_are_refused_by_name)
{
    bbm_model *m = held_square();

    check_refusal(m, m->beyond, SETTINGS[_i].offset, SETTINGS[_i].value, SETTINGS[_i].name);
}
END_TEST

START_TEST(counts_below_one_are_refused_by_name)
{
    bbm_model *m = held_square();

    m->par.steps = 0;
    check_error(m, bbm_run(m), BBM_BAD_PARAMETER, "steps = 0");
    m->par.steps = 1;
    m->par.pcg.iterations = 0;
    check_error(m, bbm_run(m), BBM_BAD_PARAMETER, "iterations = 0");
    m->par.pcg.iterations = 1;
    m->beyond->multiplier_rounds = -1;
    check_error(m, bbm_run(m), BBM_BAD_PARAMETER, "multiplier_rounds = -1");
}
END_TEST

START_TEST(parameters_at_the_ends_of_their_range_are_taken)
{
    bbm_model *m = held_square();

    m->par.velocity_factor = 1;
    m->par.dt = 1e-3;
    m->par.tolerance = 0;
    m->par.steps = 1;
    ck_ok(bbm_run(m), m);
    m->par.pcg.omega = 1.99;
    m->par.pcg.tolerance = 1e-6;
    ck_ok(bbm_run(m), m);
    m->par.friction = m->beyond->cohesion = m->beyond->tension = 0;
    m->par.p_n = m->par.p_s = 1e-3;
    ck_ok(bbm_run(m), m);
    m->par.friction = 89.9;
    ck_ok(bbm_run(m), m);
}
END_TEST

/* Not a step without it, or one that writes beyond its arrays. */
START_TEST(a_step_needs_bbm_prepare_and_again_after_what_is_added)
{
    bbm_model *m = unit_square(&SOLID);
    bbm_result r;

    check_error(m, bbm_step(m), BBM_BAD_PARAMETER, "bbm_prepare");
    ck_ok(bbm_prepare(m), m);
    ck_ok(_i == 0 ? bbm_add_node(m, 9, 9, NULL)
        : _i == 1 ? bbm_add_element(m, 1, 0, 3, (int[]){ 0, 1, 2 }, NULL)
        : bbm_add_line_load(m, 0, 1, 0, 1), m);
    ck_assert_int_eq(bbm_nodal_result(m, m->nodes - 1, -1, &r), BBM_BAD_INDEX);
    check_error(m, bbm_step(m), BBM_BAD_PARAMETER, "a step needs bbm_prepare, after what is added too");
}
END_TEST

START_TEST(a_support_that_does_not_exist_does_not_move)
{
    bbm_model *m = unit_square(&SOLID);

    check_error(m, bbm_move_support(m, 0, 1, 0), BBM_BAD_INDEX, "moved support 0 of 4 nodes");
    ck_ok(bbm_prepare(m), m);
    check_error(m, bbm_move_support(m, 4, 1, 0), BBM_BAD_INDEX, "moved support 4");
    check_error(m, bbm_move_support(m, -1, 1, 0), BBM_BAD_INDEX, "moved support -1");
    check_error(m, bbm_move_support(m, 3, 1, 0), BBM_BAD_INDEX, "moved support 3");
    ck_ok(bbm_fix_node(m, 3, BBM_X, 0, 0), m);
    check_error(m, bbm_move_support(m, 3, NAN, 0), BBM_NOT_FINITE, "support 3");
    ck_ok(bbm_move_support(m, 3, 1, 0), m);
}
END_TEST

/* 120 quadrilaterals meet in one node: there is no gap between each two of them, and each corner is held. */
START_TEST(many_corners_in_one_node_take_no_room_that_grows_with_their_square)
{
    enum { N = 120 };
    bbm_model *m = beyond_model();

    ck_ok(bbm_add_material(m, &SOLID, NULL), m);
    ck_ok(bbm_add_node(m, 0, 0, NULL), m);
    for (int k = 0; k < 2 * N; k++)
        ck_ok(bbm_add_node(m, (k % 2 + 1) * cos(PI * k / N), (k % 2 + 1) * sin(PI * k / N), NULL), m);
    for (int k = 0; k < N; k++)
        ck_ok(bbm_add_element(m, 0, 0, 4, (int[]){ 0, 1 + 2 * k, 2 + 2 * k, 1 + (2 * k + 2) % (2 * N) }, NULL), m);
    ck_ok(bbm_fix_node(m, 0, BBM_XY, 0, 0), m);
    ck_ok(bbm_fix_node(m, 1, BBM_Y, 0, 0), m);
    ck_ok(bbm_prepare(m), m);
    ck_assert_uint_lt(bbm_most_gaps(m), 2 * (size_t)m->bonds + 4 * (size_t)m->vertices);
    ck_ok(bbm_step(m), m);
    release(m);
}
END_TEST

/* Nor does a load lie on an edge along which another element has come to lie. */
START_TEST(a_loaded_edge_that_is_none_any_more_is_refused)
{
    bbm_model *m = unit_square(&SOLID);
    int far[2];

    ck_ok(bbm_prepare(m), m);
    const int a = m->vertex[m->edge[1].a].node, b = m->vertex[m->edge[1].b].node;
    ck_ok(bbm_load_edge(m, 1, 0, 0, 5), m);
    bbm_add_node(m, 2 * m->node[b].x - m->node[a].x + 1, m->node[b].y, &far[0]);
    bbm_add_node(m, 2, m->node[a].y, &far[1]);
    ck_ok(bbm_add_element(m, 0, 0, 4, (int[]){ a, far[1], far[0], b }, NULL), m);
    check_error(m, bbm_prepare(m), BBM_BAD_INDEX, "a loaded edge of element 0 is none any more");
}
END_TEST

/* ------------------------------------------------------------------------------ steps that fail */

START_TEST(a_negative_stiffness_is_found)
{
    bbm_model *m = two_squares(0, 0);

    ck_ok(bbm_fix_node(m, 0, BBM_XY, 0, 0), m);
    ck_ok(bbm_fix_node(m, 3, BBM_XY, 0, 0), m);
    ck_ok(bbm_add_load(m, 5, 1, 1), m);
    ck_ok(bbm_prepare(m), m);
    m->element[1].material.E = -1e9;
    check_error(m, bbm_step(m), BBM_NOT_POSITIVE_DEFINITE, "step 1, ");
}
END_TEST

START_TEST(every_status_has_a_text_of_its_own)
{
    for (int s = 0; s < BBM_STATUS_COUNT; s++) {
        const char *text = bbm_status_text((bbm_status)s);
        ck_assert(text && strlen(text) > 5 && strcmp(text, bbm_status_text(BBM_STATUS_COUNT)) != 0);
        for (int t = 0; t < s; t++)
            ck_assert_str_ne(text, bbm_status_text((bbm_status)t));
    }
    ck_assert_str_eq(bbm_status_text((bbm_status)-1), bbm_status_text(BBM_STATUS_COUNT));
}
END_TEST

/* ------------------------------------------------------------------------ memory and repetition */

/* Builds and runs a model that uses every function which allocates; *m is NULL if there was not
 * even room for that. */
static bbm_status build_and_run(bbm_model **m)
{
    const double scale[2] = { 1e-3, -1e-3 };
    const bbm_status status = bbm_beyond_new(m);

    if (status)
        return status;
    (*m)->beyond->bonding = BBM_VERTICES;
    (*m)->par.gravity[1] = -1e-3;
    (*m)->par.steps = 3;
    bbm_add_material(*m, &SOLID, NULL);
    for (int n = 0; n < 40; n++)
        bbm_add_node(*m, n / 2, n % 2, NULL);
    for (int e = 0; e < 19; e++)
        bbm_add_element(*m, 0, 0, 4, (int[]){ 2 * e, 2 * e + 2, 2 * e + 3, 2 * e + 1 }, NULL);
    for (int e = 0; e < 18; e++)
        bbm_add_line_load(*m, 2 * e + 1, 2 * e + 3, 0, -1e-6);
    bbm_add_varying_line_load(*m, 38, 39, rising_load, scale);
    bbm_fix_node(*m, 0, BBM_XY, 0, 0);
    bbm_fix_node(*m, 1, BBM_X, 0, 0);
    const bbm_status prepared = bbm_prepare(*m);
    return prepared ? prepared : bbm_run(*m);
}

/* Call k alone fails, or all from call k on. */
START_TEST(whichever_allocation_fails_the_status_is_no_memory_and_nothing_leaks)
{
    bbm_model *reference, *m;
    int k = 1;

    ck_assert_int_eq(build_and_run(&reference), BBM_OK);
    for (bbm_status status = BBM_NO_MEMORY; status != BBM_OK; k++) {
        test_allocations_left = _i ? k - 1 : -k;
        status = build_and_run(&m);
        const int reached = !_i && test_allocations_left >= 0;
        test_allocations_left = TEST_ALLOCATIONS_UNLIMITED;
        ck_assert(status == BBM_NO_MEMORY || (status == BBM_OK && !reached));
        if (status && m)
            check_error(m, status, BBM_NO_MEMORY, " nodes");
        /* bbm_prepare or a step failed: both can be repeated */
        if (status && m && m->status == BBM_OK) {
            m->par.steps = 3 - m->info.step;
            run(m);
        }
        if (m && m->status == BBM_OK)
            ck_assert(same_state(m, reference) && m->info.step == reference->info.step);
        release(m);
    }
    ck_assert(k > 20);
    release(reference);
}
END_TEST

/* Doubling: 16, 32, 64, ... and each at the entry that needs it. */
START_TEST(an_array_grows_by_doubling_when_it_is_full)
{
    const int next[] = { 0, 16, 32, 64, 128, 256, INT_MAX };
    bbm_model *m = new_model(&SOLID);

    for (int n = 0, grown = 0; n < 300; n++) {
        test_allocations_left = 1000;
        ck_ok(bbm_add_node(m, n, 0, NULL), m);
        ck_assert_int_eq(test_allocations_left, n == next[grown] ? 999 : 1000);
        grown += n == next[grown];
    }
    test_allocations_left = TEST_ALLOCATIONS_UNLIMITED;
    for (int n = 0; n < 300; n++)
        ck_assert(m->node[n].x == n);
}
END_TEST

Suite *input_suite(void)
{
    Suite *s = suite_create("input");

    add_case(s, "bad models",
        { bad_materials_are_refused, COUNT(BAD_MATERIALS) },
        { materials_up_to_the_limits_are_taken, 1 },
        { polygons_are_judged_by_their_shape, COUNT(POLYGONS) },
        { the_first_error_of_building_stays, COUNT(WRONG_CALLS) },
        { a_model_without_elements_is_refused, 1 },
        { a_node_that_no_element_has_is_named, 1 },
        { elements_of_one_block_on_the_same_side_of_an_edge_are_named, 1 },
        { a_load_on_an_edge_that_does_not_exist_is_refused, 4 },
        { a_line_load_on_what_is_no_boundary_edge_is_refused, 4 },
        { a_load_on_an_edge_that_two_blocks_have_goes_to_the_first, 1 },
        { statics_refuses_a_body_that_is_free_to_move_and_names_it, COUNT(HOLDS) },
        { fixed_points_close_together_hold_a_body_within_reason, 1 });
    add_case(s, "bad parameters",
        { parameters_outside_their_range_are_refused_by_name, COUNT(PARAMETERS) },
        { settings_outside_their_range_are_refused_by_name, COUNT(SETTINGS) },
        { a_support_that_does_not_exist_does_not_move, 1 },
        { many_corners_in_one_node_take_no_room_that_grows_with_their_square, 1 },
        { a_loaded_edge_that_is_none_any_more_is_refused, 1 },
        { counts_below_one_are_refused_by_name, 1 },
        { parameters_at_the_ends_of_their_range_are_taken, 1 },
        { a_step_needs_bbm_prepare_and_again_after_what_is_added, 3 });
    add_case(s, "failing steps",
        { a_negative_stiffness_is_found, 1 },
        { every_status_has_a_text_of_its_own, 1 });
    add_case(s, "memory",
        { whichever_allocation_fails_the_status_is_no_memory_and_nothing_leaks, 2 },
        { an_array_grows_by_doubling_when_it_is_full, 1 });
    return s;
}
