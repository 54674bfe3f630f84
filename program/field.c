/* field.c - the quantities that tables and pictures show. */
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
    { "sxx_fit", "sxx of a plane fit", "Pa", FIELD_NODES },
    { "syy_fit", "syy of a plane fit", "Pa", FIELD_NODES },
    { "sxy_fit", "sxy of a plane fit", "Pa", FIELD_NODES },
    { 0 }
};

/* All of them in the order of the table, by Mohr's circle; motion: the rotation so far, and the
 * velocity that the last step hands on; fit: stress. */
static void list_values(const bbm_result *r, const double motion[4], const double fit[3],
                        double all[FIELD_ROWS])
{
    const double *s = r->stress, middle = (s[0] + s[1]) / 2;
    const double radius = hypot((s[0] - s[1]) / 2, s[2]);
    const double list[FIELD_ROWS] = {
        r->u, r->v, motion[0], s[0], s[1], s[2], r->mises, middle + radius, middle - radius,
        fabs(middle) + radius, motion[1], motion[2], motion[3], fit[0], fit[1], fit[2]
    };

    memcpy(all, list, sizeof list);
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
    double all[FIELD_ROWS];

    list_values(&r, (double[]){ e->sum[2], e->V[0], e->V[1], e->V[2] }, s, all);
    return all[f - field_table];
}

#define ON_A_LINE 1e-9          /* what is left of a square where barycentres lie on a line */

/* Ours, not the paper's: at a node the plane s = a + b x + c y fitted to the stress at the
 * barycentres of the elements of the block around it and of their neighbours, those at several of
 * their nodes so many times. Where these lie on a line, s stays. */
static void fit_stress(const bbm_model *m, int node, int block, double s[3])
{
    const int *first = m->adjacent_first, *at = m->adjacent;
    const bbm_vertex *P = &m->vertex[at[first[node]]];
    double G[3][6] = { { 0 } };

    for (int a = first[node]; a < first[node + 1]; a++) {
        const bbm_element *e = &m->element[m->vertex[at[a]].element];
        for (int v = e->first; v < e->first + e->n; v++)
            for (int b = first[m->vertex[v].node]; b < first[m->vertex[v].node + 1]; b++) {
                const bbm_element *i = &m->element[m->vertex[at[b]].element];
                const double p[6] = { 1, i->x - P->x, i->y - P->y, i->stress[0], i->stress[1],
                                      i->stress[2] };
                for (int k = 0; k < 18 && i->block == block; k++)
                    G[k / 6][k % 6] += p[k / 6] * p[k % 6];
            }
    }
    for (int k = 0; k < 3; k++)
        for (int r = 0; r < 3; r++) {
            const double part = G[r][k] / G[k][k], before = G[r][r];
            for (int c = 0; c < 6 && r != k; c++)
                G[r][c] -= part * G[k][c];
            if (r > k && !(G[r][r] > ON_A_LINE * before))
                return;
        }
    for (int k = 0; k < 3; k++)
        s[k] = G[0][3 + k] / G[0][0];
}

void field_all_of_node(const bbm_model *m, int node, int block, int fits, double all[FIELD_ROWS])
{
    const int first = m->adjacent_first[node], end = m->adjacent_first[node + 1];
    double motion[4] = { 0 };
    bbm_result r;

    bbm_nodal_result(m, node, block, &r);
    for (int a = first; a < end; a++) {
        const bbm_element *e = &m->element[m->vertex[m->adjacent[a]].element];
        motion[0] += e->sum[2] / (end - first);
        for (int k = 0; k < 3; k++)
            motion[1 + k] += e->V[k] / (end - first);
    }
    double fit[3] = { r.stress[0], r.stress[1], r.stress[2] };
    if (fits && block >= 0)
        fit_stress(m, node, block, fit);
    list_values(&r, motion, fit, all);
}

double field_of_node(const field *f, const bbm_model *m, int node, int block)
{
    double all[FIELD_ROWS];

    field_all_of_node(m, node, block, f->files == FIELD_NODES, all);
    return all[f - field_table];
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
