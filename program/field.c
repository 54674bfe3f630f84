/* field.c - the quantities that tables and pictures show. */
#include <math.h>
#include <string.h>

#include "field.h"

const field field_table[] = {
    { "u", "u", "m", FIELD_NODES | FIELD_ELEMENTS },
    { "v", "v", "m", FIELD_NODES | FIELD_ELEMENTS },
    { "rotation", "rotation", "rad", FIELD_ELEMENTS },
    { "sxx", "sxx", "Pa", FIELD_NODES | FIELD_ELEMENTS | FIELD_CELLS },
    { "syy", "syy", "Pa", FIELD_NODES | FIELD_ELEMENTS | FIELD_CELLS },
    { "sxy", "sxy", "Pa", FIELD_NODES | FIELD_ELEMENTS | FIELD_CELLS },
    { "mises", "von Mises stress", "Pa", FIELD_NODES | FIELD_ELEMENTS | FIELD_CELLS },
    { "s1", "s1", "Pa", FIELD_CELLS },
    { "s2", "s2", "Pa", FIELD_CELLS },
    { FIELD_PRINCIPAL, "larger principal stress", "Pa", 0 },
    { "vx", "vx", "m/s", FIELD_MOVING },
    { "vy", "vy", "m/s", FIELD_MOVING },
    { "spin", "spin", "rad/s", FIELD_MOVING },
    { 0 }
};

/* All of them in the order of the table, by Mohr's circle; motion: the rotation so far, and the
 * velocity that the last step hands on. */
static double value(const field *f, const bbm_result *r, const double motion[4])
{
    const double *s = r->stress, middle = (s[0] + s[1]) / 2;
    const double radius = hypot((s[0] - s[1]) / 2, s[2]);
    const double all[] = { r->u, r->v, motion[0], s[0], s[1], s[2], r->mises, middle + radius,
                           middle - radius, fabs(middle) + radius, motion[1], motion[2],
                           motion[3] };

    return all[f - field_table];
}

double field_place(const bbm_model *m, int v, int axis)
{
    const bbm_element *e = m->element;

    if (!field_is_gone(m, v))
        return (axis ? m->vertex[v].y : m->vertex[v].x) + m->origin[axis];
    while (e->block != m->element[m->vertex[v].element].block)
        e++;
    const bbm_node *a = &m->node[m->vertex[e->first].node];
    return axis ? a->y : a->x;
}

const field *field_find(const char *name)
{
    const field *f = field_table;

    while (f->name && strcmp(f->name, name) != 0)
        f++;
    return f->name ? f : NULL;
}

double field_of_element(const field *f, const bbm_model *m, int element)
{
    const bbm_element *e = &m->element[element];
    const double *s = e->stress;
    const bbm_result r = { .u = e->sum[0], .v = e->sum[1], .stress = { s[0], s[1], s[2] },
                           .mises = bbm_mises(s, e->szz) };

    return value(f, &r, (double[]){ e->sum[2], e->V[0], e->V[1], e->V[2] });
}

double field_of_node(const field *f, const bbm_model *m, int node)
{
    const int first = m->adjacent_first[node], end = m->adjacent_first[node + 1];
    double motion[4] = { 0 };
    bbm_result r;

    bbm_nodal_result(m, node, -1, &r);
    for (int a = first; a < end; a++) {
        const bbm_element *e = &m->element[m->vertex[m->adjacent[a]].element];
        motion[0] += e->sum[2] / (end - first);
        for (int k = 0; k < 3; k++)
            motion[1 + k] += e->V[k] / (end - first);
    }
    return value(f, &r, motion);
}

/* N n - T m, m from P2 to P3 and n out of the edge's block. */
void field_contact_force(const bbm_model *m, const bbm_contact *c, double N, double T, double f[2])
{
    const bbm_vertex *P2 = &m->vertex[m->edge[c->edge].b], *P3 = &m->vertex[m->edge[c->edge].a];
    const double l = hypot(P3->x - P2->x, P3->y - P2->y);
    const double x = (P3->x - P2->x) / l, y = (P3->y - P2->y) / l;

    f[0] = -N * y - T * x;
    f[1] = N * x - T * y;
}
