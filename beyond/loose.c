/* loose.c - which block goes, when statics finds no equilibrium.
 *
 * A block that slides, tips or falls leaves K singular, or the open-close iteration without an end; the solver cannot
 * tell why. So the failed step is solved once more with inertia, in a step so long that inertia is nothing against
 * stiffness (bbm_long_step): what is held hardly notices, and what is not goes far. A push on all elements (bbm_push_all) moves
 * what rolls or slides but has no load that way, too. The element that goes furthest is of
 * the block to blame; where it parts from a neighbour at a contact, the neighbour is what it slides on or tips over.
 */
#include "../bbm.h"

#include <math.h>

/* SLOW  [-]: elastic over inertial stiffness of an element in the long step, so that the solver still sees both
 * CARRIED [-]: share of the load that inertia carries if a block is loose; of what is held it is about n^4/SLOW for a
 *              bar of n elements
 * PARTS [-]: relative motion at a contact, against the largest motion, that is no strain */
#define SLOW 1e9
#define CARRIED 1e-3
#define PARTS 0.1

double bbm_long_step(const bbm_model *m)
{
    double h2 = 0;

    for (int i = 0; i < m->elements; i++) {
        const bbm_element *e = &m->element[i];
        h2 = fmax(h2, 2 * SLOW * e->material.density * e->A0 / e->material.E);
    }
    return sqrt(h2);
}

static double mass_of(const bbm_element *e) { return e->material.density * e->material.thickness * e->A0; }

static double sum_of_loads(const bbm_model *m)
{
    double load = 0;

    for (int i = 0; i < m->elements; i++)
        load += hypot(m->load[6 * i], m->load[6 * i + 1]);
    return load;
}

/* Adds to F as much again as the loads (1 N, if there are none), all one way, askew to most slopes, shared by mass. */
void bbm_push_all(bbm_model *m)
{
    const double load = sum_of_loads(m), push = load > 0 ? load : 1;
    double mass = 0;

    for (int i = 0; i < m->elements; i++)
        mass += mass_of(&m->element[i]);
    for (int i = 0; i < m->elements; i++) {
        m->F[6 * i] += push * cos(1) * mass_of(&m->element[i]) / mass;
        m->F[6 * i + 1] += push * sin(1) * mass_of(&m->element[i]) / mass;
    }
}

/* How far two motions of elements lie apart, seen from the first. */
static double distance(const bbm_model *m, int i, int j)
{
    const bbm_element *a = &m->element[i], *b = &m->element[j];
    const double *p = &m->D[6 * i], *q = &m->D[6 * j], X = a->x - b->x, Y = a->y - b->y;

    return hypot(p[0] - q[0] + q[2] * Y, p[1] - q[1] - q[2] * X) + fabs(p[2] - q[2]) * sqrt(a->A0);
}

/* Of the solution D of a step h: the element that goes furthest and its like across the contact where it parts from
 * another block, or -1 if there is none. Returns 0 if all are held. */
int bbm_find_loose(const bbm_model *m, double h, int pair[2])
{
    double inertia = 0, furthest = 0, most = 0;

    pair[0] = pair[1] = -1;
    for (int i = 0; i < m->elements; i++) {
        const bbm_element *e = &m->element[i];
        const double way = hypot(m->D[6 * i], m->D[6 * i + 1]);
        inertia += 2 / (h * h) * mass_of(e) * way;
        if (way > furthest)
            furthest = way, pair[0] = i;
    }
    for (int k = 0; k < bbm_contact_count(m); k++) {
        int c[2];
        bbm_contact_pair(m, k, c);
        const int first = hypot(m->D[6 * c[0]], m->D[6 * c[0] + 1]) >= hypot(m->D[6 * c[1]], m->D[6 * c[1] + 1]);
        const double apart = distance(m, c[0], c[1]);
        if (apart > fmax(most, PARTS * furthest))
            most = apart, pair[0] = c[!first], pair[1] = c[first];
    }
    return inertia > CARRIED * sum_of_loads(m);
}
