/* check_mesh.c - section 2.2: boundary edges, bonds, nodal results, the order of indices. */
#include "check.h"
#include "models.h"

/* -------------------------------------------------------------------------------- 2.2, the mesh */

/* Euler: nodes - sides + elements = 1 for a body without holes. Edges run counter-clockwise round
 * the body, whose area is 12 by Green's theorem. */
START_TEST(every_side_is_a_bond_or_a_boundary_edge_with_its_element_on_the_left)
{
    grid g = { .lx = 4, .ly = 3, .nx = 4, .ny = 3, .triangles = _i, .jitter = 0.2 };
    bbm_model *m = cantilever(&SOLID, &g, 1, 0);

    ck_assert_int_eq(m->edges, 2 * (4 + 3));
    ck_assert_int_eq(m->bonds, _i ? 4 * 4 + 5 * 3 - 14 + 12 : 4 * 4 + 5 * 3 - 14);
    ck_assert_int_eq(m->nodes - (m->edges + m->bonds) + m->elements, 1);
    ck_assert_int_eq(2 * m->bonds + m->edges, m->vertices);
    for (int b = 0; b < m->bonds; b++) {
        const bbm_bond *bond = &m->bond[b];
        ck_assert_int_lt(bond->i, bond->j);
        for (int end = 0; end < 2; end++) {
            ck_assert_int_eq(m->vertex[bond->p[end]].node, m->vertex[bond->q[end]].node);
            ck_assert_int_eq(m->vertex[bond->p[end]].element, bond->i);
            ck_assert_int_eq(m->vertex[bond->q[end]].element, bond->j);
        }
        ck_assert_int_ne(bond->p[0], bond->p[1]);
    }
    double twice = 0;
    for (int i = 0; i < m->edges; i++) {
        const bbm_vertex *a = &m->vertex[m->edge[i].a], *b = &m->vertex[m->edge[i].b];
        ck_assert(a->element == m->edge[i].element && b->element == m->edge[i].element);
        twice += a->x * b->y - b->x * a->y;
    }
    ck_relative(twice, 24, ROUNDING);
}
END_TEST

/* 3--4--5    two squares between the same six nodes */
START_TEST(elements_of_different_blocks_are_not_bonded)
{
    bbm_model *m = two_squares(0, 1), *n = two_squares(4, 4), *t = new_model(&SOLID);

    ck_ok(bbm_prepare(m), m);
    ck_ok(bbm_prepare(n), n);
    ck_assert(m->bonds == 0 && m->edges == 8);
    ck_assert(n->bonds == 1 && n->edges == 6);
    /* Sorted, the last side of the first triangle and the first side of the second are
     * neighbours. */
    for (int k = 0; k < 4; k++)
        ck_ok(bbm_add_node(t, k % 2, k / 2, NULL), t);
    for (int k = 0; k < 2; k++)
        ck_ok(bbm_add_element(t, k, 0, 3, (int[]){ k, k + 1, k + 2 }, NULL), t);
    ck_ok(bbm_prepare(t), t);
    ck_assert(t->bonds == 0 && t->edges == 6);
}
END_TEST

/* Two blocks on the same ground: an edge 0, 1 with an element of each above and one of each below.
 * Their edges are sorted before the model is refused. */
START_TEST(blocks_that_lie_on_one_another_are_sorted_apart)
{
    const double top[4][2] = { { 0, 1 }, { 1, 1 }, { 0, -1 }, { 1, -1 } };
    bbm_model *m = fan(4, top, (int[]){ 0, 1, 0, 1 }), *n = fan(4, top, (int[]){ 3, 0, 0, 3 });

    ck_assert_int_eq(bbm_prepare(m), BBM_BLOCKS_OVERLAP);
    ck_assert_int_eq(bbm_prepare(n), BBM_BLOCKS_OVERLAP);
    ck_assert(m->bonds == 2 && m->edges == 8 && n->bonds == 2 && n->edges == 8);
}
END_TEST

static void expect_result(const bbm_model *m, int node, int block, bbm_status expected,
                          bbm_result *r)
{
    const bbm_status status = bbm_nodal_result(m, node, block, r);

    ck_assert_msg(status == expected,
                  "node %d, block %d: the status is \"%s\", expected \"%s\"", node, block,
                  bbm_status_text(status), bbm_status_text(expected));
}

static void expect_mean(const bbm_result *r, const double expected[6])
{
    const double got[6] = { r->u, r->v, r->stress[0], r->stress[1], r->stress[2], r->szz };
    static const char *const name[6] = { "u", "v", "sxx", "syy", "sxy", "szz" };

    for (int k = 0; k < 6; k++)
        ck_assert_msg(got[k] == expected[k], "%s is %g, expected %g", name[k], got[k], expected[k]);
}

START_TEST(nodal_results_are_the_mean_over_the_elements_of_a_block_that_meet)
{
    bbm_model *m = two_squares(2, 3);
    bbm_result r;

    expect_result(m, 1, -1, BBM_BAD_INDEX, &r);  /* nothing prepared yet */
    ck_ok(bbm_prepare(m), m);
    for (int v = 0; v < m->vertices; v++) {
        m->vertex[v].u = 1 + v;
        m->vertex[v].v = 10 * v;
    }
    for (int a = 0; a < 3; a++) {
        m->element[0].stress[a] = 1 + a;
        m->element[1].stress[a] = 5 - 3 * a;
    }
    m->element[0].szz = 4;
    m->element[1].szz = 2;
    expect_result(m, 4, -1, BBM_OK, &r);              /* vertices 2 and 7 */
    expect_mean(&r, (double[]){ 5.5, 45, 3, 2, 1, 3 });
    ck_relative(r.mises, sqrt(9 + 4 + 9 - 3 * 2 - 2 * 3 - 3 * 3 + 3 * 1.0), ROUNDING);
    expect_result(m, 4, 2, BBM_OK, &r);
    expect_mean(&r, (double[]){ 3, 20, 1, 2, 3, 4 });
    expect_result(m, 4, -2, BBM_BAD_INDEX, &r);
    expect_result(m, 4, 3, BBM_OK, &r);
    expect_mean(&r, (double[]){ 8, 70, 5, 2, -1, 2 });
    expect_result(m, 0, 2, BBM_OK, &r);
    expect_result(m, 0, 3, BBM_BAD_INDEX, &r);  /* block 3 is not there */
    expect_result(m, 6, -1, BBM_BAD_INDEX, &r);
    expect_result(m, -1, -1, BBM_BAD_INDEX, &r);
    for (int v = 0; v < m->vertices; v++)
        m->element[m->vertex[v].element].block = 0;  /* block 0 is a block, not all of them */
    m->element[1].block = 1;
    expect_result(m, 4, 0, BBM_OK, &r);
    ck_assert_msg(r.u == 3, "u of block 0 is %g, expected 3", r.u);
}
END_TEST

START_TEST(clockwise_elements_are_turned_round)
{
    const int corners[2][4] = { { 0, 1, 2, 3 }, { 3, 2, 1, 0 } };
    bbm_model *m[2];

    for (int way = 0; way < 2; way++) {
        m[way] = new_model(&SOLID);
        for (int n = 0; n < 4; n++)
            ck_ok(bbm_add_node(m[way], SHAPES[1].x[n][0], SHAPES[1].x[n][1], NULL), m[way]);
        ck_ok(bbm_add_element(m[way], 0, 0, 4, corners[way], NULL), m[way]);
        ck_ok(bbm_fix_node(m[way], 0, BBM_XY, 0, 0), m[way]);
        ck_ok(bbm_fix_node(m[way], 1, BBM_Y, 0, 0), m[way]);
        ck_ok(bbm_add_load(m[way], 2, 1, 3), m[way]);
        ck_ok(bbm_prepare(m[way]), m[way]);
        ck_ok(bbm_step(m[way]), m[way]);
    }
    ck_assert(m[1]->element[0].A > 0);
    ck_relative(m[1]->element[0].A0, m[0]->element[0].A0, ROUNDING);
    for (int n = 0; n < 4; n++) {
        ck_near(result_at(m[1], n).u, result_at(m[0], n).u, 0.01, SOLVED);
        ck_near(result_at(m[1], n).v, result_at(m[0], n).v, 0.01, SOLVED);
        ck_near(result_at(m[1], n).mises, result_at(m[0], n).mises, 1, SOLVED);
    }
}
END_TEST

START_TEST(a_load_on_an_edge_of_clockwise_elements_finds_it)
{
    bbm_model *m = new_model(&SOLID);
    double total[3] = { 0 };

    for (int n = 0; n < 4; n++)
        ck_ok(bbm_add_node(m, n == 1 || n == 2, n / 2, NULL), m);
    ck_ok(bbm_add_element(m, 0, 0, 4, (int[]){ 3, 2, 1, 0 }, NULL), m);
    ck_ok(bbm_fix_node(m, 0, BBM_XY, 0, 0), m);
    ck_ok(bbm_fix_node(m, 3, BBM_X, 0, 0), m);
    ck_ok(bbm_add_line_load(m, 1, 2, 4, 2), m);
    run_steps(m, 1);
    total_load(m, 0, total);
    ck_near(total[0], 4, 1, ROUNDING);
    ck_near(total[1], 2, 1, ROUNDING);
    ck_near(total[2], 2 - 4 * 0.5, 1, ROUNDING);
}
END_TEST

START_TEST(indices_count_from_zero)
{
    bbm_model *m = new_model(&SOLID);
    int index = -1;

    ck_ok(bbm_add_material(m, &CORK, &index), m);
    ck_assert_int_eq(index, 1);
    for (int n = 0; n < 40; n++) {
        ck_ok(bbm_add_node(m, n, n % 2, &index), m);
        ck_assert_int_eq(index, n);
    }
    for (int e = 0; e < 38; e++) {
        ck_ok(bbm_add_element(m, 0, 1, 3, (int[]){ e, e + 1, e + 2 }, &index), m);
        ck_assert_int_eq(index, e);
    }
    ck_ok(bbm_prepare(m), m);
    ck_assert(m->bonds == 37 && m->edges == 40 && m->element[3].material.nu == 0);
}
END_TEST

Suite *mesh_suite(void)
{
    Suite *s = suite_create("mesh");

    add_case(s, "mesh",
        { every_side_is_a_bond_or_a_boundary_edge_with_its_element_on_the_left, 2 },
        { elements_of_different_blocks_are_not_bonded, 1 },
        { blocks_that_lie_on_one_another_are_sorted_apart, 1 },
        { nodal_results_are_the_mean_over_the_elements_of_a_block_that_meet, 1 },
        { clockwise_elements_are_turned_round, 1 },
        { a_load_on_an_edge_of_clockwise_elements_finds_it, 1 },
        { indices_count_from_zero, 1 });
    return s;
}
