/* force.c - the force of a contact as a vector, for pictures, tables and the page. */
#include <math.h>

#include "scene.h"

/* N n - T m, m from P2 to P3 and n out of the edge's block. */
void scene_contact_force(const bbm_model *m, const bbm_contact *c, double N, double T, double f[2])
{
    const bbm_vertex *P2 = &m->vertex[m->edge[c->edge].b], *P3 = &m->vertex[m->edge[c->edge].a];
    const double l = hypot(P3->x - P2->x, P3->y - P2->y);
    const double x = (P3->x - P2->x) / l, y = (P3->y - P2->y) / l;

    f[0] = -N * y - T * x;
    f[1] = N * x - T * y;
}
