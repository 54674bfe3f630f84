/* hole.c - Exercise 8.3: a mesh of one's own around the hole of Experiment II, and Table 2 on it.
 *
 *   5 ._________.          A quarter of a plate of 10 m x 10 m with a hole of radius 1 m is pulled
 *     |    /    |-> 1 MPa  along x. Grid point (i, j) lies on ray j of 2n, from the x axis to the y
 *     |___/  __/|-> 1 MPa  axis, and is number i of 0 to n on it, from the hole outwards. Each cell
 *       `\ _/   |-> 1 MPa  is cut from (i, j) to (i + 1, j + 1).
 *         |_____|
 *          1    5
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/base.h"

static const double PI = 3.14159265358979323846;

/* Adds the nodes and the triangles, of block 0 and material 0, in this order: node (i, j) is number
 * j (n + 1) + i. Cells are shorter at the hole, by a constant factor, since the stress varies as
 * 1/r^2 there. Returns how many unknowns six-node triangles have on this mesh: two at each grid
 * point and at the middle of each side, once, however many triangles share it. */
static int add_mesh(bbm_model *m, int n)
{
    for (int j = 0; j <= 2 * n; j++)
        for (int i = 0; i <= n; i++) {
            const double angle = PI / 2 * j / (2 * n), c = j == 2 * n ? 0 : cos(angle);
            const double edge = 5 / fmax(c, sin(angle)), f = (pow(5, (double)i / n) - 1) / 4;
            const double r = 1 + f * (edge - 1);
            bbm_add_node(m, r * c, r * sin(angle), NULL);
        }
    for (int j = 0; j < 2 * n; j++)
        for (int i = 0; i < n; i++) {
            const int a = j * (n + 1) + i, b = a + n + 1;
            bbm_add_element(m, 0, 0, 3, (int[]){ a, a + 1, b + 1 }, NULL);
            bbm_add_element(m, 0, 0, 3, (int[]){ a, b + 1, b }, NULL);
        }
    const int points = (n + 1) * (2 * n + 1), triangles = 4 * n * n, outer = 6 * n;
    return 2 * (points + (3 * triangles + outer) / 2);
}

/* Grid points and different sides, counted one by one. */
static int count_unknowns(const bbm_model *m)
{
    int sides = 0;

    for (int v = 0; v < m->vertices; v++) {
        const bbm_element *e = &m->element[m->vertex[v].element];
        const int a = m->vertex[v].node, last = v == e->first + e->n - 1;
        const int b = m->vertex[last ? e->first : v + 1].node;
        int seen = 0;
        for (int w = 0; w < v; w++) {
            const bbm_element *f = &m->element[m->vertex[w].element];
            const int c = m->vertex[w].node;
            const int d = m->vertex[w == f->first + f->n - 1 ? f->first : w + 1].node;
            seen |= (a == c && b == d) || (a == d && b == c);
        }
        sides += !seen;
    }
    return 2 * (m->nodes + sides);
}

static void hold_and_pull(bbm_model *m)
{
    for (int k = 0; k < m->nodes; k++) {
        if (fabs(m->node[k].x) < 1e-9)
            bbm_fix_node(m, k, BBM_X, 0, 0);
        if (fabs(m->node[k].y) < 1e-9)
            bbm_fix_node(m, k, BBM_Y, 0, 0);
    }
    for (int k = 0; k < m->edges; k++) {
        const bbm_vertex *a = &m->vertex[m->edge[k].a], *b = &m->vertex[m->edge[k].b];
        if (fabs(a->x - 5) < 1e-9 && fabs(b->x - 5) < 1e-9)
            bbm_add_line_load(m, a->node, b->node, 0.2e6, 0);
    }
}

static int expect(const char *what, double got, double expected, double bound)
{
    const int right = fabs(got - expected) <= bound;

    printf("%s%s %.4g, expected %.4g within %.2g\n", right ? "" : "wrong: ", what, got, expected,
           bound);
    return right;
}

/* The node nearest to (x, y). */
static int nearest(const bbm_model *m, double x, double y)
{
    int best = 0;

    for (int k = 1; k < m->nodes; k++)
        if (hypot(m->node[k].x - x, m->node[k].y - y)
            < hypot(m->node[best].x - x, m->node[best].y - y))
            best = k;
    return best;
}

/* The area of n chords in place of the circle; one body; Table 2; and the converged finite elements
 * of paper.md, sxx(0,1) to 3 %, u(5,0) to 1 %. */
static int check(bbm_model *m, int n, int unknowns)
{
    double area = 0;
    bbm_result top, end;

    if (m->elements == 0 || bbm_prepare(m))
        return expect("triangles", m->elements, 4 * n * n, 0);
    for (int e = 0; e < m->elements; e++)
        area += m->element[e].A;
    int right = expect("area", area, 25 - n * sin(PI / 2 / (2 * n)), 1e-9);
    right &= expect("boundary edges", m->edges, 6 * n, 0);
    right &= expect("bonds", m->bonds, (3 * m->elements - m->edges) / 2, 0);
    right &= expect("unknowns of six-node triangles", unknowns, count_unknowns(m), 0);
    printf("unknowns of the bonded triangles %d\n", 6 * m->elements);
    m->par.alpha = 1000;
    m->par.dt = INFINITY;
    m->par.steps = 1;
    hold_and_pull(m);
    if (bbm_prepare(m) || bbm_run(m)
        || bbm_nodal_result(m, nearest(m, 0, 1), -1, &top)
        || bbm_nodal_result(m, nearest(m, 5, 0), -1, &end))
        return 0;
    right &= expect("sxx(0,1) [MPa]", top.stress[0] / 1e6, 3.36, 0.03 * 3.36);
    return right & expect("u(5,0) [um]", 1e6 * end.u, 2.1135, 0.01 * 2.1135);
}

int main(void)
{
    const int n = 16;
    bbm_model *m;
    int right = 0;

    if (bbm_model_new(&m) == BBM_OK) {
        bbm_add_material(m, &(bbm_material){ 2900e9, 0.3, 0.05, 0.2 }, NULL);
        right = check(m, n, add_mesh(m, n));
        if (bbm_message(m)[0])
            printf("wrong: %s\n", bbm_message(m));
    }
    bbm_model_free(m);
    return right ? EXIT_SUCCESS : EXIT_FAILURE;
}
