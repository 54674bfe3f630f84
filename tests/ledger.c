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
    l->speed = fmax(l->speed, fmax(fabs(u), fabs(v)));
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

/* In principal stresses p, q of the starting area: (p^2 + q^2 - 2 nu p q)/(2 E) for each volume. */
static double elastic_energy(const bbm_model *m, const bbm_element *e)
{
    double c[2];
    const double grown = place(m, e, c) / e->A0, mean = (e->stress[0] + e->stress[1]) / 2;
    const double radius = hypot((e->stress[0] - e->stress[1]) / 2, e->stress[2]);
    const double p = grown * (mean + radius), q = grown * (mean - radius);

    return e->material.thickness * e->A0 * (p * p + q * q - 2 * e->material.nu * p * q) / (2 * e->material.E);
}

/* ------------------------------------------------------------------------------------- bonds and fixed points */

static double shear_modulus(const bbm_material *r) { return r->E / (2 * (1 + r->nu)); }

static double bond_stiffness(const bbm_model *m, const bbm_element *i, const bbm_element *j)
{
    const double G = (shear_modulus(&i->material) + shear_modulus(&j->material)) / 2;

    return m->par.alpha * G * (i->material.thickness + j->material.thickness) / 2 * fmax(i->A0 / j->A0, j->A0 / i->A0);
}

static int hinged(const bbm_model *m, const bbm_element *e) { return e->n == 4 && m->beyond->bonding != BBM_VERTICES; }

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

/* The moment that a quadrilateral had on its side k at the start: the stiffness is data, given by the library's formula. */
static void side_moment(const bbm_model *m, const bbm_element *e, int k, double M[2][2])
{
    bbm_element start = *e;
    bbm_vertex at[4];
    double both[2][2][2];

    memset(M, 0, 4 * sizeof M[0][0]);
    if (m->beyond->bonding != BBM_MOMENT || e->n != 4)
        return;
    start.A = e->A0;
    for (int a = 0; a < 4; a++)
        at[a] = (bbm_vertex){ .x = m->node[corner(m, e, a)->node].x, .y = m->node[corner(m, e, a)->node].y };
    bbm_bending_moments(&start, at, both);
    memcpy(M, both[k % 2], 4 * sizeof M[0][0]);
}

/* Of two: half the sum, so scaled that it is the harmonic mean along the normal of the edge; of one alone twice that. */
static void join_moments(double (*A)[2], double (*B)[2], double x, double y, double M[2][2])
{
    const double a = x * x * A[0][0] + x * y * (A[0][1] + A[1][0]) + y * y * A[1][1];
    const double b = x * x * B[0][0] + x * y * (B[0][1] + B[1][0]) + y * y * B[1][1];

    for (int k = 0; k < 4; k++)
        M[k / 2][k % 2] = (a > 0 && b > 0 ? 2 * a * b / ((a + b) * (a + b)) : 2) * (A[k / 2][k % 2] + B[k / 2][k % 2]);
}

static double bond_energy(const bbm_model *m, const bbm_bond *bond)
{
    const bbm_element *i = &m->element[bond->i], *j = &m->element[bond->j];
    const bbm_vertex *P = &m->vertex[bond->p[0]], *R = &m->vertex[bond->p[1]];
    const bbm_vertex *Q = &m->vertex[bond->q[0]], *S = &m->vertex[bond->q[1]];
    const bbm_node *a = &m->node[P->node], *b = &m->node[R->node];
    const double turn = (i->sum[2] + j->sum[2]) / 2, c = cos(turn), s = sin(turn);
    const double d[4] = { P->u - Q->u, P->v - Q->v, R->u - S->u, R->v - S->v };        /* turned back: p, q */
    const double p[2] = { c * d[0] + s * d[1], c * d[1] - s * d[0] }, q[2] = { c * d[2] + s * d[3], c * d[3] - s * d[2] };
    double A[2][2], B[2][2], M[2][2];

    side_moment(m, i, bond->p[0] - i->first, A);
    side_moment(m, j, bond->q[1] - j->first, B);
    join_moments(A, B, b->y - a->y, a->x - b->x, M);
    return edge_energy(bond_stiffness(m, i, j), hinged(m, i) || hinged(m, j), M, p, q);
}

/* Elements of which all nodes are held: at their vertices, if they do not bend, as without bonds. */
static double held_energy(const bbm_model *m, const bbm_element *e)
{
    const double k = m->par.alpha * shear_modulus(&e->material) * e->material.thickness;
    double sum = 0, M[2][2];
    int bonds = 0;

    for (int b = 0; b < m->bonds; b++)
        bonds += &m->element[m->bond[b].i] == e || &m->element[m->bond[b].j] == e;
    for (int a = 0; a < e->n; a++) {
        const bbm_vertex *P = corner(m, e, a), *R = corner(m, e, a + 1);
        const bbm_node *W = &m->node[P->node], *X = &m->node[R->node];
        const double p[2] = { P->u - W->wall[0], P->v - W->wall[1] }, q[2] = { R->u - X->wall[0], R->v - X->wall[1] };
        if (!hinged(m, e) || bonds == 0) {
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

/* By the length of its normal spring, which may have grown since it bore N. */
static double contact_energy(const bbm_model *m, const bbm_contact *c)
{
    const double length = c->rest - c->d_n;

    return c->state == BBM_OPEN ? 0 : m->par.p_n * length * length / 2 + c->T * c->T / (2 * m->par.p_s);
}

/* How far P1 is inside the edge P2 P3 of another block. */
static double contact_depth(const bbm_model *m, const bbm_contact *c)
{
    const bbm_vertex *a = &m->vertex[m->edge[c->edge].a], *b = &m->vertex[m->edge[c->edge].b];
    const bbm_vertex *p = &m->vertex[m->edge[c->corner].a];

    return ((b->x - a->x) * (p->y - a->y) - (b->y - a->y) * (p->x - a->x)) / hypot(b->x - a->x, b->y - a->y);
}

/* ---------------------------------------------------------------------------------------------------- overlaps */

/* The least depth of the convex e behind a side of the convex f; below 0 if one of them parts the two. */
static double depth_behind(const bbm_model *m, const bbm_element *e, const bbm_element *f)
{
    double least = INFINITY;

    for (int k = 0; k < f->n; k++) {
        const bbm_vertex *a = corner(m, f, k), *b = corner(m, f, k + 1);
        const double x = b->x - a->x, y = b->y - a->y, l = hypot(x, y);
        double most = -INFINITY;
        for (int i = 0; i < e->n; i++)
            most = fmax(most, (x * (corner(m, e, i)->y - a->y) - y * (corner(m, e, i)->x - a->x)) / l);
        least = fmin(least, most);
        if (least < 0)
            break;
    }
    return least;
}

static double element_overlap(const bbm_model *m, const bbm_element *e, const bbm_element *f)
{
    const double d = depth_behind(m, e, f);

    return d < 0 ? d : fmin(d, depth_behind(m, f, e));
}

/* How far the sides of a block of bonded elements may bend, which only touches where it has corners and grid points: by
 * its strain along a metre, and by the gaps of its bonds. */
static void find_bending(const bbm_model *m, double bending[])
{
    for (int b = 0; b < m->bonds; b++) {
        const bbm_bond *k = &m->bond[b];
        const bbm_element *e[2] = { &m->element[k->i], &m->element[k->j] };
        double *most = &bending[e[0]->block];
        for (int i = 0; i < 2; i++) {
            const bbm_vertex *P = &m->vertex[k->p[i]], *Q = &m->vertex[k->q[i]];
            const double *s = e[i]->stress, strain = 2 * (fabs(s[0]) + fabs(s[1]) + fabs(s[2])) / e[i]->material.E;
            *most = fmax(*most, strain + hypot(P->u - Q->u, P->v - Q->v));
        }
    }
}

/* How much corners of two blocks may overlap and pass each other: a corner's rounding is a share of its shorter side, which
 * is no longer than the extent of an element of one piece; of many, at most SCENE_CORNERS in a row. */
static double rounding_of(const bbm_model *m, const bbm_element *e, const bbm_element *f)
{
    double extent[2] = { 0, 0 };

    for (int k = 0; k < 2; k++)
        for (int i = 0; i < (k ? f : e)->n; i++) {
            const bbm_vertex *a = corner(m, k ? f : e, 0), *b = corner(m, k ? f : e, i);
            extent[k] = fmax(extent[k], hypot(a->x - b->x, a->y - b->y));
        }
    return m->par.round < 0 ? 2e-3 * fmin(extent[0], extent[1]) * (m->bonds > 0 ? SCENE_CORNERS : 1) : m->par.round;
}

/* The deepest overlap of two blocks less the depth of their deepest contact that is closed, or was since they were last
 * apart: a contact that opens leaves them where they are, and no spring starts loaded that closes there. What rides over
 * the joint of two blocks is as deep in the next one as it is in the contacts that it has with others. */
void scene_overlap(const bbm_model *m, double deepest[SCENE_BLOCKS][SCENE_BLOCKS], scene_ledger *l)
{
    double bending[SCENE_BLOCKS] = { 0 }, deep[SCENE_BLOCKS] = { 0 };
    int apart[SCENE_BLOCKS][SCENE_BLOCKS];

    find_bending(m, bending);
    memset(apart, 1, sizeof apart);
    for (int k = 0; k < m->contacts; k++) {
        const bbm_contact *c = &m->contact[k];
        const int p = m->edge[c->corner].block, q = m->edge[c->edge].block;
        if (c->state == BBM_OPEN)
            continue;
        deepest[p][q] = deepest[q][p] = fmax(deepest[p][q], contact_depth(m, c)), apart[p][q] = apart[q][p] = 0;
        deep[p] = fmax(deep[p], contact_depth(m, c)), deep[q] = fmax(deep[q], contact_depth(m, c));
    }
    for (int i = 0; i < m->elements; i++)
        for (int j = 0; j < i; j++) {
            const bbm_element *e = &m->element[i], *f = &m->element[j];
            const int p = e->block, q = f->block;
            const int held = m->node[corner(m, e, 0)->node].held && m->node[corner(m, f, 0)->node].held;
            const double all = p == q || held ? 0 : element_overlap(m, e, f);
            if (all > 0) {
                deepest[p][q] = deepest[q][p] = fmax(deepest[p][q], fmax(deep[p], deep[q]));
                apart[p][q] = apart[q][p] = 0;
            }
            const double d = all - deepest[p][q] - bending[p] - bending[q] - rounding_of(m, e, f);
            if (all > 0 && d > l->overlap)
                l->overlap = d, l->pair[0] = p, l->pair[1] = q;
        }
    for (int k = 0; k < SCENE_BLOCKS * SCENE_BLOCKS; k++)
        if (apart[k / SCENE_BLOCKS][k % SCENE_BLOCKS])
            deepest[k / SCENE_BLOCKS][k % SCENE_BLOCKS] = 0;
}

/* By how much a contact pulls, or its shear force leaves the cone of Mohr and Coulomb, against its normal force and what
 * moves the lighter of its two elements: its weight, and what stops it in a step. */
static double against_law(const bbm_model *m, const bbm_contact *c, double speed)
{
    const double cone = fmax(0, c->N * c->strength.tan_phi + c->strength.shear);
    const double excess = fmax(fabs(c->T) - cone, -c->N - c->strength.tension);
    const double M = fmin(mass(&m->element[c->element[0]]), mass(&m->element[c->element[1]]));
    const double g = hypot(m->par.gravity[0], m->par.gravity[1]);

    return c->state == BBM_OPEN ? 0 : fmax(0, excess) / (fabs(c->N) + M * (g + speed / m->par.dt));
}

void scene_balance(const bbm_model *m, scene_ledger *l)
{
    memset(l, 0, sizeof *l);
    for (int i = 0; i < m->elements; i++) {
        add_motion(m, &m->element[i], l);
        l->elastic += elastic_energy(m, &m->element[i]);
        l->springs += held_energy(m, &m->element[i]);
    }
    for (int b = 0; b < m->bonds; b++) {
        l->springs += bond_energy(m, &m->bond[b]);
        l->stiffness += 2 * bond_stiffness(m, &m->element[m->bond[b].i], &m->element[m->bond[b].j]);
    }
    for (int k = 0; k < m->contacts; k++) {
        l->springs += contact_energy(m, &m->contact[k]);
        l->law = fmax(l->law, against_law(m, &m->contact[k], l->speed));
    }
}

void scene_remember(const bbm_model *m, scene_memory *before)
{
    for (int i = 0; i < m->elements; i++) {
        place(m, &m->element[i], before[i].x);
        memcpy(before[i].V, m->element[i].V, sizeof before[i].V);
    }
}

/* Of the weight, on the way of the barycentres; `size` counts all parts as positive. That of what is held all round is its
 * supports', which do as much work the other way. */
double scene_work(const bbm_model *m, const scene_memory *before, double *size)
{
    const double *g = m->par.gravity;
    double work = 0, x[2];

    *size = 0;
    for (int i = 0; i < m->elements; i++) {
        const bbm_element *e = &m->element[i];
        place(m, e, x);
        const double w = mass(e) * (g[0] * (x[0] - before[i].x[0]) + g[1] * (x[1] - before[i].x[1]));
        work += bbm_is_held_all_round(m, e) ? 0 : w;
        *size += bbm_is_held_all_round(m, e) ? 0 : fabs(w);
    }
    return work;
}

/* Polar moment of inertia. */
static double inertia(const bbm_model *m, const bbm_element *e)
{
    bbm_element spinning = *e;
    scene_ledger l = { 0 };

    memcpy(spinning.V, (double[6]){ 0, 0, 1 }, sizeof spinning.V);
    add_motion(m, &spinning, &l);
    return 2 * l.kinetic;
}

/* What the angular momentum may change by in the step, for a scheme that keeps the energy: a torque works on the angle r
 * with tan(r/2)/(r/2) in place of 1, and inertia is that of the step's start while the element is strained in it. */
double scene_turning_off(const bbm_model *m, const scene_memory *before)
{
    double sum = 0;

    for (int i = 0; i < m->elements; i++) {
        const double *V = before[i].V, *W = m->element[i].V, dt = m->par.dt;
        const double r = fmin(1, dt * fmax(fabs(V[2]), fabs(W[2])) / 2);
        const double rates = fabs(V[3]) + fabs(V[4]) + fabs(V[5]) + fabs(W[3]) + fabs(W[4]) + fabs(W[5]);
        const double push = fabs(W[2] - V[2]) * (r > 0 ? tan(r) / r - 1 : 0);
        sum += inertia(m, &m->element[i]) * (push + (fabs(V[2]) + fabs(W[2]) + rates) * rates * dt / 2);
    }
    return sum;
}
