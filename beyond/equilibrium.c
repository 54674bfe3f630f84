/* equilibrium.c - whether the forces on each body balance.
 *
 * Every solution is judged before anything moves, body by body; a body is what bonds join. Its
 * forces are those of the tables: loads, normal and shear forces of its contacts, reactions, bolts,
 * and in dynamics inertia. Their sum has to vanish, and so has their moment about the centre of the
 * body. What is left of the sum counts against the forces on this body, added without their
 * directions; what is left of the moment counts against these times the size of the body. So N and
 * N m do not mix, and however heavy another body is, it excuses nothing.
 *
 * The springs of bonds pull at both their ends, which are a gap apart where a step begins with open
 * bonds. Their forces cancel, but for that lever: it is taken along, and is no force of the body.
 */
#include <float.h>

#include "beyond.h"

/* IN_MOTION [-]  what may be left in dynamics: a step makes no more of its energy, see energy.c
 * NO_FORCE [N]   in any unit: the solver has such a force in place of 0
 * ROUNDING [-]   of a displacement: some dozens of its last digit. What a spring makes of it may be
 *                left, too */
#define IN_MOTION 1e-5
#define NO_FORCE 1e-60
#define ROUNDING (64 * DBL_EPSILON)

/* Centre and size of each body, the side of a square with its polar moment of area. No forces. */
static void begin_bodies(bbm_model *m)
{
    bbm_balance *body = m->beyond->balance;

    for (int i = 0; i < m->elements; i++)
        body[i] = (bbm_balance){ 0 };
    for (int i = 0; i < m->elements; i++) {
        bbm_balance *b = &body[m->beyond->body[i]];
        const bbm_element *e = &m->element[i];
        b->area += e->A;
        b->x += (e->x - b->x) * e->A / b->area;
        b->y += (e->y - b->y) * e->A / b->area;
    }
    for (int i = 0; i < m->elements; i++) {
        bbm_balance *b = &body[m->beyond->body[i]];
        const bbm_element *e = &m->element[i];
        const double X = e->x - b->x, Y = e->y - b->y;
        b->size = sqrt(b->size * b->size
                       + 6 * (e->Sxx + e->Syy + e->A * (X * X + Y * Y)) / b->area);
    }
}

/* Adds a force on element i, F as on the right of (5). In dynamics its lever is that of the middle
 * of the step, and F[2] is its moment times tan(r/2)/(r/2), see rotation.c. `counts`: 1, or 0 for
 * bonds. k: the stiffness that makes it of displacements and of their rounding. */
static void add_force(bbm_model *m, int i, const double F[6], int counts, double k)
{
    const bbm_element *e = &m->element[i];
    bbm_balance *b = &m->beyond->balance[m->beyond->body[i]];
    const double *D = &m->D[6 * i], r = e->middle ? m->beyond->middle[i].D[2] : 0;
    const double turns = r == 0 ? 1 : 2 * tan(r / 2) / r, half = e->middle ? 0.5 : 0;
    const double X = e->x + half * D[0] - b->x, Y = e->y + half * D[1] - b->y;
    const double pair = (fabs(F[2]) + fabs(F[3]) + fabs(F[4]) + fabs(F[5])) / b->size;

    b->force[0] += F[0];
    b->force[1] += F[1];
    b->moment += F[2] / turns + X * F[1] - Y * F[0];
    b->forces += counts * fmax(hypot(F[0], F[1]), pair);
    b->rounding += counts * ROUNDING * k * (fabs(D[0]) + fabs(D[1]) + fabs(D[2]) * b->size);
}

/* Adds the forces of a bond, a fixed point or a bolt. */
static void add_gap(bbm_model *m, const bbm_gap *g)
{
    const int *body = m->beyond->body, counts = g->j < 0 || body[g->i] != body[g->j];
    double d[2], f[2], Fi[6], Fj[6];

    bbm_gap_length(m, g, d);
    for (int a = 0; a < 2; a++)
        f[a] = g->own.f[a] + g->W[a][0] * d[0] + g->W[a][1] * d[1];
    for (int a = 0; a < 6; a++) {
        Fi[a] = -f[0] * g->Ti[0][a] - f[1] * g->Ti[1][a];
        Fj[a] = f[0] * g->Tj[0][a] + f[1] * g->Tj[1][a];
    }
    add_force(m, g->i, Fi, counts, g->W[0][0] + g->W[1][1]);
    if (g->j >= 0)
        add_force(m, g->j, Fj, counts, g->W[0][0] + g->W[1][1]);
}

/* The forces of a contact on its elements, as on the right of (5). */
void bbm_contact_forces(const bbm_model *m, const bbm_contact *c, double F[BBM_PARTS][6])
{
    const double T = bbm_shear_force(c);
    bbm_spring v[2];

    bbm_contact_vectors(m, c, c->anchor, v);
    for (int k = 0; k < 6 * c->parts; k++)
        F[k / 6][k % 6] = c->N * v[0].v[k / 6][k % 6] - T * v[1].v[k / 6][k % 6];
}

/* Adds the inertia of an element, both sides of (16), (17). */
static void add_inertia(bbm_model *m, int i)
{
    bbm_submatrix s = { { { 0 } }, { 0 } };
    double F[6] = { 0 };

    bbm_inertia_submatrix(&m->element[i], m->h, &s);
    for (int a = 0; a < 36; a++)
        F[a / 6] -= s.K[a / 6][a % 6] * m->D[6 * i + a % 6];
    add_force(m, i, s.F, 1, 0);
    add_force(m, i, F, 1, 0);
}

/* The share that a body lacks of balance. */
static double lack_of(const bbm_balance *b)
{
    const double left = fmax(hypot(b->force[0], b->force[1]), fabs(b->moment) / b->size);

    return left > b->rounding + NO_FORCE ? left / b->forces : 0;
}

/* The element that stands for the body that lacks most. */
static int find_worst(const bbm_model *m)
{
    const bbm_balance *b = m->beyond->balance;
    int worst = 0;

    for (int i = 1; i < m->elements; i++)
        worst = lack_of(&b[i]) > lack_of(&b[worst]) ? i : worst;
    return worst;
}

/* Refuses a solution in which the forces on a body do not balance. Notes what is left without
 * inertia. */
bbm_status bbm_check_equilibrium(bbm_model *m)
{
    const bbm_contact *c = m->scratch->contact, *end = c + m->scratch->contacts;
    const bbm_balance *b = m->beyond->balance;
    double F[BBM_PARTS][6];

    begin_bodies(m);
    for (int i = 0; i < m->elements; i++)
        add_force(m, i, &m->load[6 * i], 1, 0);
    for (int k = 0; k < m->gaps; k++)
        add_gap(m, &m->gap[k]);
    for (; c < end; c++) {
        const int parts = c->state == BBM_OPEN ? 0 : c->parts;
        if (parts > 0)
            bbm_contact_forces(m, c, F);
        for (int k = 0; k < parts; k++)
            add_force(m, c->element[k], F[k], 1, m->par.p_n);
    }
    m->beyond->lack = lack_of(&b[find_worst(m)]);
    for (int i = 0; i < m->elements && !bbm_is_static(m); i++)
        add_inertia(m, i);
    const int worst = find_worst(m);
    const double lack = lack_of(&b[worst]);
    if (lack <= (bbm_is_static(m) ? BBM_BALANCED : IN_MOTION))
        return BBM_OK;
    return bbm_fail(m, BBM_NOT_CONVERGED, "step %d: forces on block %d lack %.2g of balance: the "
                    "stiffnesses of materials, bonds and contacts are too far apart",
                    m->info.step + 1, m->element[worst].block, lack);
}
