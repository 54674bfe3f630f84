/* bolt.c - Exercise 9.1: bolts between blocks, through the hook `list_gaps`.
 *
 *      fixed   .------------.        A block of 2 m x 1 m hangs on two upright bolts below a fixed
 *              '-o--------o-'        block, and a third bolt holds it at its foot against a load H
 *   .--.         |        |          that pulls to the right. Each bolt carries a force along
 *   |  |        .o--------o.         itself alone: the weight is shared by two, H is carried by the
 *   |  |        |          |         third. A bolt of stiffness k under the force f grows by f/k.
 *   |  o--------o----------' -> H
 *   '--'
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/base.h"

enum { BOLTS = 3 };

typedef struct { int P, Q; double k; } bolt;            /* vertices; N/m                            */

static const bolt BOLT[BOLTS] = { { 11, 0, 2e7 }, { 10, 1, 2e7 }, { 8, 5, 1e7 } };

/* Adds a gap for each bolt to the list of what glues. P and Q are points of two elements, and
 * bbm_bonding_gap gives d = (uP - uQ) + Ti(P) Di - Tj(Q) Dj, its rows along x and y, each with the
 * stiffness k. A bolt along the unit vector n from P to Q resists along n alone: its first row is
 * n.d, and its second has no stiffness. The list has room for three gaps of each vertex. */
static void add_bolts(bbm_model *m)
{
    for (int b = 0; b < BOLTS; b++) {
        const bbm_vertex *P = &m->vertex[BOLT[b].P], *Q = &m->vertex[BOLT[b].Q];
        const double l = hypot(Q->x - P->x, Q->y - P->y);
        const double n[2] = { (Q->x - P->x) / l, (Q->y - P->y) / l };
        bbm_gap *g = bbm_add_gap(m, P->element, Q->element);
        bbm_bonding_gap(&m->element[P->element], P, &m->element[Q->element], Q, BOLT[b].k, g);
        g->d0[0] = n[0] * g->d0[0] + n[1] * g->d0[1];
        for (int a = 0; a < 6; a++) {
            g->Ti[0][a] = n[0] * g->Ti[0][a] + n[1] * g->Ti[1][a];
            g->Tj[0][a] = n[0] * g->Tj[0][a] + n[1] * g->Tj[1][a];
        }
        g->W[1][1] = 0;
    }
}

/* Bonds and fixed points as in the paper, and the bolts. */
static void list_gaps(bbm_model *m)
{
    m->hook->list_gaps = NULL;
    bbm_list_gaps(m);
    m->hook->list_gaps = list_gaps;
    add_bolts(m);
}

static void add_rectangle(bbm_model *m, int block, double x, double y, double w, double h)
{
    const double corner[4][2] = { { x, y }, { x + w, y }, { x + w, y + h }, { x, y + h } };
    int node[4];

    for (int k = 0; k < 4; k++)
        bbm_add_node(m, corner[k][0], corner[k][1], &node[k]);
    bbm_add_element(m, block, 0, 4, node, NULL);
}

/* How much longer the bolt is than at the start, along itself. */
static double elongation(const bbm_model *m, const bolt *b)
{
    const bbm_vertex *P = &m->vertex[b->P], *Q = &m->vertex[b->Q];
    const bbm_node *p = &m->node[P->node], *q = &m->node[Q->node];

    return hypot(Q->x - P->x, Q->y - P->y) - hypot(q->x - p->x, q->y - p->y);
}

int main(void)
{
    const double weight = 2 * 1 * 2500 * 10, H = 30e3;
    const double expected[BOLTS] = { weight / 2 / 2e7, weight / 2 / 2e7, H / 1e7 };
    int wrong = 0;
    bbm_model *m;

    if (bbm_model_new(&m))
        return EXIT_FAILURE;
    bbm_add_material(m, &(bbm_material){ .E = 1e10, .nu = 0.2, .density = 2500, .thickness = 1 },
                     NULL);
    add_rectangle(m, 0, 0, 2, 2, 1);                    /* vertices 0 to 3: fixed, above            */
    add_rectangle(m, 1, -3, -2, 1, 2);                  /* 4 to 7: fixed, on the left               */
    add_rectangle(m, 2, 0, -2, 2, 1);                   /* 8 to 11: hangs                           */
    for (int k = 0; k < 8; k++)
        bbm_fix_node(m, k, BBM_XY, 0, 0);
    bbm_add_load(m, 9, H, 0);
    m->par.gravity[1] = -10;
    m->hook->list_gaps = list_gaps;
    bbm_status status = bbm_prepare(m);
    if (!status)
        status = bbm_run(m);
    if (status) {
        printf("wrong: %s\n", status == BBM_NOT_POSITIVE_DEFINITE ? "no bolt holds the block"
                                                                  : bbm_message(m));
        wrong = 1;
    }
    /* The bolts turn by 1e-3, which is of second order in their lengths: 1e-3 of what they grow. */
    for (int b = 0; b < BOLTS && !wrong; b++) {
        const double got = elongation(m, &BOLT[b]);
        wrong = !(fabs(got - expected[b]) <= 2e-3 * expected[b]);
        printf("%sbolt %d grows by %.5f m, expected %.5f\n", wrong ? "wrong: " : "", b, got,
               expected[b]);
    }
    bbm_model_free(m);
    return wrong ? EXIT_FAILURE : EXIT_SUCCESS;
}
