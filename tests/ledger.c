/* ledger.c - what there is in a model at one moment, from its public state alone: the oracle of the scenes.
 *
 * Integrals over a polygon are sums over the triangles (vertex 0, a, b). A velocity is linear in the place, so that
 * energies and moments are of second degree: the midpoints of a triangle's sides integrate them exactly. */
#include <math.h>
#include <string.h>

#include "scenes.h"

static const bbm_vertex *corner(const bbm_model *m, const bbm_element *e, int k)
{
    return &m->vertex[e->first + k % e->n];
}

/* Present area and barycentre. */
static double place(const bbm_model *m, const bbm_element *e, double x[2])
{
    const bbm_vertex *o = corner(m, e, 0);
    double area = 0, X = 0, Y = 0;

    for (int k = 1; k + 1 < e->n; k++) {
        const bbm_vertex *a = corner(m, e, k), *b = corner(m, e, k + 1);
        const double t = ((a->x - o->x) * (b->y - o->y) - (b->x - o->x) * (a->y - o->y)) / 2;
        area += t;
        X += t * ((a->x - o->x) + (b->x - o->x)) / 3;
        Y += t * ((a->y - o->y) + (b->y - o->y)) / 3;
    }
    x[0] = o->x + X / area;
    x[1] = o->y + Y / area;
    return area;
}

static double mass(const bbm_element *e) { return e->material.density * e->material.thickness * e->A0; }

/* Kinetic energy and moments of the mass dm at (x, y). */
static void add_mass(scene_ledger *l, const bbm_element *e, const double c[2], double x, double y, double dm)
{
    const double X = x - c[0], Y = y - c[1], *V = e->V;
    const double u = V[0] - V[2] * Y + V[3] * X + V[5] / 2 * Y, v = V[1] + V[2] * X + V[4] * Y + V[5] / 2 * X;

    l->kinetic += dm * (u * u + v * v) / 2;
    l->P[0] += dm * u;
    l->P[1] += dm * v;
    l->L += dm * (x * v - y * u);
    l->P_size += dm * sqrt(u * u + v * v);
    l->L_size += dm * (fabs(x * v) + fabs(y * u));
}

static void add_motion(const bbm_model *m, const bbm_element *e, scene_ledger *l)
{
    const bbm_vertex *o = corner(m, e, 0);
    double c[2];
    const double density = mass(e) / place(m, e, c);

    for (int k = 1; k + 1 < e->n; k++) {
        const bbm_vertex *a = corner(m, e, k), *b = corner(m, e, k + 1);
        const double t = ((a->x - o->x) * (b->y - o->y) - (b->x - o->x) * (a->y - o->y)) / 2;
        add_mass(l, e, c, (o->x + a->x) / 2, (o->y + a->y) / 2, density * t / 3);
        add_mass(l, e, c, (a->x + b->x) / 2, (a->y + b->y) / 2, density * t / 3);
        add_mass(l, e, c, (b->x + o->x) / 2, (b->y + o->y) / 2, density * t / 3);
    }
}

/* In principal stresses p, q: (p^2 + q^2 - 2 nu p q)/(2 E) for each volume. */
static double elastic_energy(const bbm_element *e)
{
    const double mean = (e->stress[0] + e->stress[1]) / 2;
    const double radius = hypot((e->stress[0] - e->stress[1]) / 2, e->stress[2]);
    const double p = mean + radius, q = mean - radius;

    return e->material.thickness * e->A0 * (p * p + q * q - 2 * e->material.nu * p * q) / (2 * e->material.E);
}

/* ------------------------------------------------------------------------------------- bonds and fixed points */

static double shear_modulus(const bbm_material *r) { return r->E / (2 * (1 + r->nu)); }

static double bond_stiffness(const bbm_model *m, const bbm_element *i, const bbm_element *j)
{
    const double G = (shear_modulus(&i->material) + shear_modulus(&j->material)) / 2;

    return m->par.alpha * G * (i->material.thickness + j->material.thickness) / 2 * fmax(i->A0 / j->A0, j->A0 / i->A0);
}

static int hinged(const bbm_model *m, const bbm_element *e) { return e->n == 4 && m->par.bonding != BBM_VERTICES; }

/* k |d|^2/2 at both ends of an edge with the gaps p, q; of an edge bonded in its middle 2 k |(p + q)/2|^2/2, and its
 * moment 1/2 dd.M dd, dd = (p - q)/2. */
static double edge_energy(double k, int whole, double (*M)[2], const double p[2], const double q[2])
{
    const double d[2] = { (p[0] + q[0]) / 2, (p[1] + q[1]) / 2 }, b[2] = { (p[0] - q[0]) / 2, (p[1] - q[1]) / 2 };

    if (!whole)
        return k / 2 * (p[0] * p[0] + p[1] * p[1] + q[0] * q[0] + q[1] * q[1]);
    return k * (d[0] * d[0] + d[1] * d[1])
           + (b[0] * (M[0][0] * b[0] + M[0][1] * b[1]) + b[1] * (M[1][0] * b[0] + M[1][1] * b[1])) / 2;
}

/* The moment that a quadrilateral has on its side k: the stiffness is data, given by the library's formula. */
static void side_moment(const bbm_model *m, const bbm_element *e, int k, double M[2][2])
{
    double both[2][2][2];

    memset(M, 0, 4 * sizeof M[0][0]);
    if (m->par.bonding != BBM_MOMENT || e->n != 4)
        return;
    bbm_hinge_moments(e, &m->vertex[e->first], both);
    memcpy(M, both[k % 2], 4 * sizeof M[0][0]);
}

/* Of two: half the sum, so scaled that it is the harmonic mean along the normal of the edge. */
static void join_moments(double (*A)[2], double (*B)[2], double x, double y, double M[2][2])
{
    const double a = x * x * A[0][0] + x * y * (A[0][1] + A[1][0]) + y * y * A[1][1];
    const double b = x * x * B[0][0] + x * y * (B[0][1] + B[1][0]) + y * y * B[1][1];

    for (int k = 0; k < 4; k++)
        M[k / 2][k % 2] = a + b > 0 ? 2 * a * b / ((a + b) * (a + b)) * (A[k / 2][k % 2] + B[k / 2][k % 2]) : 0;
}

static double bond_energy(const bbm_model *m, const bbm_bond *b)
{
    const bbm_element *i = &m->element[b->i], *j = &m->element[b->j];
    const bbm_vertex *P = &m->vertex[b->p[0]], *R = &m->vertex[b->p[1]];
    const bbm_vertex *Q = &m->vertex[b->q[0]], *S = &m->vertex[b->q[1]];
    const double p[2] = { P->u - Q->u, P->v - Q->v }, q[2] = { R->u - S->u, R->v - S->v };
    double A[2][2], B[2][2], M[2][2];

    side_moment(m, i, b->p[0] - i->first, A);
    side_moment(m, j, b->q[1] - j->first, B);
    join_moments(A, B, R->y - P->y, P->x - R->x, M);
    return edge_energy(bond_stiffness(m, i, j), hinged(m, i) && hinged(m, j), M, p, q);
}

/* Elements of which all nodes are held. */
static double held_energy(const bbm_model *m, const bbm_element *e)
{
    const double k = m->par.alpha * shear_modulus(&e->material) * e->material.thickness;
    double sum = 0, M[2][2];

    for (int a = 0; a < e->n; a++) {
        const bbm_vertex *P = corner(m, e, a), *R = corner(m, e, a + 1);
        const bbm_node *W = &m->node[P->node], *X = &m->node[R->node];
        const double p[2] = { P->u - W->wall[0], P->v - W->wall[1] }, q[2] = { R->u - X->wall[0], R->v - X->wall[1] };
        if (!hinged(m, e)) {
            sum += W->held ? k / 2 * (p[0] * p[0] + p[1] * p[1]) : 0;
        } else if (W->held && X->held) {
            side_moment(m, e, a, M);
            for (int c = 0; c < 4; c++)
                M[c / 2][c % 2] *= 2;
            sum += edge_energy(k, 1, M, p, q);
        }
    }
    return sum;
}

/* --------------------------------------------------------------------------------------------------- contacts */

static double contact_energy(const bbm_model *m, const bbm_contact *c)
{
    return c->state == BBM_OPEN ? 0 : c->N * c->N / (2 * m->par.p_n) + c->T * c->T / (2 * m->par.p_s);
}

void scene_balance(const bbm_model *m, scene_ledger *l)
{
    memset(l, 0, sizeof *l);
    for (int i = 0; i < m->elements; i++) {
        add_motion(m, &m->element[i], l);
        l->elastic += elastic_energy(&m->element[i]);
        l->springs += held_energy(m, &m->element[i]);
    }
    for (int b = 0; b < m->bonds; b++)
        l->springs += bond_energy(m, &m->bond[b]);
    for (int k = 0; k < m->contacts; k++)
        l->springs += contact_energy(m, &m->contact[k]);
}

void scene_barycentres(const bbm_model *m, double (*x)[2])
{
    for (int i = 0; i < m->elements; i++)
        place(m, &m->element[i], x[i]);
}

/* Of the weight, on the way of the barycentres from `before`; `size` counts all parts as positive. */
double scene_work(const bbm_model *m, double (*before)[2], double *size)
{
    double work = 0, x[2];

    *size = 0;
    for (int i = 0; i < m->elements; i++) {
        const bbm_element *e = &m->element[i];
        place(m, e, x);
        const double w = mass(e) * (m->par.gravity[0] * (x[0] - before[i][0]) + m->par.gravity[1] * (x[1] - before[i][1]));
        work += w;
        *size += fabs(w);
    }
    return work;
}
