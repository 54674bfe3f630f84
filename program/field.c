/* field.c - the quantities that tables and pictures show. */
#include <math.h>
#include <string.h>

#include "field.h"

/* --- from displacement and stress --- */

static double u(const bbm_result *r) { return r->u; }
static double v(const bbm_result *r) { return r->v; }
static double sxx(const bbm_result *r) { return r->stress[0]; }
static double syy(const bbm_result *r) { return r->stress[1]; }
static double sxy(const bbm_result *r) { return r->stress[2]; }
static double mises(const bbm_result *r) { return r->mises; }

/* Mohr's circle. */
static double middle(const bbm_result *r) { return (r->stress[0] + r->stress[1]) / 2; }

static double radius(const bbm_result *r)
{
    return hypot((r->stress[0] - r->stress[1]) / 2, r->stress[2]);
}

static double s1(const bbm_result *r) { return middle(r) + radius(r); }
static double s2(const bbm_result *r) { return middle(r) - radius(r); }

/* --- of an element: its rotation so far; the velocity that the last step hands on --- */

static double rotation(const bbm_model *m, int e) { return m->element[e].sum[2]; }
static double vx(const bbm_model *m, int e) { return m->element[e].V[0]; }
static double vy(const bbm_model *m, int e) { return m->element[e].V[1]; }
static double spin(const bbm_model *m, int e) { return m->element[e].V[2]; }

/* In the order of the columns. */
const field field_table[] = {
    { "u", "u", "m", u, NULL, FIELD_NODES | FIELD_ELEMENTS },
    { "v", "v", "m", v, NULL, FIELD_NODES | FIELD_ELEMENTS },
    { "rotation", "rotation", "rad", NULL, rotation, FIELD_ELEMENTS },
    { "sxx", "sxx", "Pa", sxx, NULL, FIELD_NODES | FIELD_ELEMENTS | FIELD_CELLS },
    { "syy", "syy", "Pa", syy, NULL, FIELD_NODES | FIELD_ELEMENTS | FIELD_CELLS },
    { "sxy", "sxy", "Pa", sxy, NULL, FIELD_NODES | FIELD_ELEMENTS | FIELD_CELLS },
    { "mises", "von Mises stress", "Pa", mises, NULL, FIELD_NODES | FIELD_ELEMENTS | FIELD_CELLS },
    { "s1", "s1", "Pa", s1, NULL, FIELD_CELLS },
    { "s2", "s2", "Pa", s2, NULL, FIELD_CELLS },
    { "vx", "vx", "m/s", NULL, vx, FIELD_MOVING },
    { "vy", "vy", "m/s", NULL, vy, FIELD_MOVING },
    { "spin", "spin", "rad/s", NULL, spin, FIELD_MOVING },
    { 0 }
};

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
    bbm_result r = { .u = e->sum[0], .v = e->sum[1], .szz = bbm_stress_out_of_plane(e) };

    if (!f->of_result)
        return f->of_element(m, element);
    memcpy(r.stress, e->stress, sizeof r.stress);
    r.mises = bbm_mises(r.stress, r.szz);
    return f->of_result(&r);
}

double field_of_node(const field *f, const bbm_model *m, int node)
{
    const int first = m->adjacent_first[node], end = m->adjacent_first[node + 1];
    bbm_result r;
    double sum = 0;

    bbm_nodal_result(m, node, -1, &r);
    for (int a = first; a < end && !f->of_result; a++)
        sum += f->of_element(m, m->vertex[m->adjacent[a]].element);
    return f->of_result ? f->of_result(&r) : sum / (end - first);
}
