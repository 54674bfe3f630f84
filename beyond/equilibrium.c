/* equilibrium.c - whether the forces on each body balance.
 *
 * Every solution is judged before anything moves, body by body; a body is what bonds join. Its
 * forces are those of the tables: loads, normal and shear forces of its contacts, reactions, bolts,
 * and in dynamics inertia. Their sum has to vanish, and so has their moment about the centre of the
 * body. What is left of the sum counts against the forces on this body, added without their
 * directions; what is left of the moment counts against these times the size of the body. So N and
 * N m do not mix, and however heavy another body is, it excuses nothing.
 *
 * Each contact is judged by its law anew, whatever its state was accepted for. It does not pull,
 * and it is as deep as N says; friction holds no more than its cone; an open one is not inside. A
 * bolt turns nothing by itself. The force by which one of these is broken counts against the forces
 * on each of its bodies. Statics has to keep the laws. In dynamics a spring that is too stiff for
 * the digits of a position cannot, and a shorter step does not help: what is broken is noted and
 * told.
 *
 * The springs of bonds pull at both their ends, which are a gap apart where a step begins with open
 * bonds. Their forces cancel, but for that lever: it is taken along, and is no force of the body.
 */
#include "beyond.h"

/* IN_MOTION [-]  what may be left in dynamics: a step makes no more of its energy, see energy.c
 * NO_FORCE [N]   in any unit: the solver has such a force in place of 0
 * STIFF [-]      what K has on its diagonal against inertia: a step loses 1e-16 times as much of it
 * INSIDE [-]     what may be left of the force by which the component is solved, of the forces
 *                inside a body, and of what would bring a support to its place at once: the
 *                solution is no more exact
 * UNLOADED [-]   of what its bonds can carry: a piece that has broken off and bears less bears
 *                nothing. The solver knows the forces from before the break to 1e-10 */
#define IN_MOTION 1e-5
#define STIFF 1e7
#define NO_FORCE 1e-60
#define INSIDE 1e-10
#define UNLOADED 1e-9

/* Centre and size of each body, the side of a square of its area. No forces. A body is noted at its
 * first element, which begins it before the others add to it. A stiff one has lost digits of its
 * inertia, which stands beside stiffness in K. */
static void begin_bodies(bbm_model *m)
{
    for (int i = 0; i < m->elements; i++) {
        m->beyond->balance[i] = (bbm_balance){ .inside = m->K->forces[m->K->component[i]] };
        bbm_balance *b = &m->beyond->balance[m->beyond->body[i]];
        const bbm_element *e = &m->element[i];
        b->area += e->A;
        b->x += (e->x - b->x) * e->A / b->area;
        b->y += (e->y - b->y) * e->A / b->area;
        b->size = sqrt(b->area);
        b->inside += sqrt(e->A) * e->material.thickness
                   * (fabs(e->stress[0]) + fabs(e->stress[1]) + fabs(e->stress[2]));
        b->stiff |= bbm_has_inertia(m, i) && m->K->D[m->K->place[i]][0][0]
                    > STIFF * 2 * bbm_mass_per_area(e) * e->A / (m->h * m->h);
        b->rounding = UNLOADED * m->beyond->bond_tension * b->size * e->material.thickness;
    }
}

/* Adds a force on element i, F as on the right of (5); returns its moment about the origin. In
 * dynamics its lever is that of the middle of the step, and F[2] is its moment times
 * tan(r/2)/(r/2), see rotation.c. `counts`: 1, or 0 for bonds. k: the stiffness that makes it of
 * displacements and of their rounding. */
static double add_force(bbm_model *m, int i, const double F[6], int counts, double k)
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
    b->rounding += counts * BBM_ROUNDING * k * (fabs(D[0]) + fabs(D[1]) + fabs(D[2]) * b->size);
    return F[2] / turns + (X + b->x) * F[1] - (Y + b->y) * F[0];
}

/* Adds the forces of a bond, a fixed point or a bolt. Between two bodies in dynamics their moments
 * have to cancel. */
static void add_gap(bbm_model *m, const bbm_gap *g)
{
    const int *body = m->beyond->body, counts = g->j < 0 || body[g->i] != body[g->j];
    const double k = g->j < 0 ? 0 : g->W[0][0] + g->W[1][1];
    bbm_balance *b = &m->beyond->balance[body[g->i]];
    double d[2], f[2], Fi[6] = { 0 }, Fj[6] = { 0 };

    bbm_gap_length(m, g, d);
    for (int a = 0; a < 2; a++) {
        f[a] = g->own.f[a] + g->W[a][0] * d[0] + g->W[a][1] * d[1];
        for (int c = 0; c < 6 && g->j < 0; c++)     /* what is held in x may go far in y        */
            b->rounding += BBM_ROUNDING * g->W[a][a] * fabs(g->Ti[a][c] * m->D[6 * g->i + c]);
        bbm_force_submatrix(f[a], g->Ti[a], Fi);
        bbm_force_submatrix(-f[a], g->Tj[a], Fj);
    }
    if (!counts)
        b->inside += hypot(f[0], f[1]);
    else if (g->j < 0)
        b->inside += hypot(g->W[0][0] * g->d0[0], g->W[1][1] * g->d0[1]);
    double moment = add_force(m, g->i, Fi, counts, k);
    if (g->j < 0)
        return;
    moment += add_force(m, g->j, Fj, counts, k);
    if (counts && bbm_motion_of(m)) {
        bbm_balance *other = &m->beyond->balance[body[g->j]];
        b->breach = fmax(b->breach, fabs(moment) / b->size);
        other->breach = fmax(other->breach, fabs(moment) / other->size);
    }
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

/* Adds the forces of a contact, and what they break of its law by more than the solver's error. An
 * open one may be as deep as rounding, of its place and of the length of its edge. How far either
 * side moves has rounding for both. */
static void add_contact(bbm_model *m, const bbm_contact *c)
{
    const bbm_vertex *P = bbm_start_of(m, c->corner);
    const double size = hypot(P->x, P->y) + m->edge[c->edge].along.length;
    const double digits = c->state == BBM_OPEN ? BBM_ROUNDING * size : 0;
    const double N = bbm_normal_force(m, c->d_n + digits - c->rest);
    const double T = fabs(bbm_shear_force(c)) - bbm_shear_strength(&c->strength, c->N);
    const double rounding = c->trial.rests ? 0 : c->trial.digits;
    const double solved = fmax(0, c->trial.force_tolerance - rounding);
    const double all = c->state != BBM_OPEN
                     ? fmax(fmax(fabs(N - c->N), T), -N - c->strength.tension)
                     : bbm_is_blocked(m, c) ? 0 : N;
    const double breach = fmax(0, all - solved), k = c->state == BBM_OPEN ? 0 : m->par.p_n;
    double F[BBM_PARTS][6] = { { 0 } };

    if (c->state != BBM_OPEN)
        bbm_contact_forces(m, c, F);
    for (int i = 0; i < c->parts; i++) {
        const int e = c->element[i];
        const double *D = &m->D[6 * c->element[i == 0]];    /* of the other side                */
        bbm_balance *b = &m->beyond->balance[m->beyond->body[e]];
        add_force(m, e, F[i], 1, k);
        b->breach = fmax(b->breach, breach);
        b->rounding += BBM_ROUNDING * k * hypot(D[0], D[1]);
    }
}

/* Of the forces on a body the share that is left, and that which breaks laws. */
static double lack_of(const bbm_balance *b)
{
    const double left = fmax(hypot(b->force[0], b->force[1]), fabs(b->moment) / b->size);

    return left > b->rounding + INSIDE * b->inside + NO_FORCE ? left / b->forces : 0;
}

static double breach_share(const bbm_balance *b)
{
    return b->breach > NO_FORCE ? b->breach / (b->forces + b->breach) : 0;
}

/* The body of which the most is left or broken. */
static const bbm_balance *worst_of(const bbm_model *m, double (*share)(const bbm_balance *b))
{
    const bbm_balance *worst = m->beyond->balance, *end = worst + m->elements;

    for (const bbm_balance *b = worst; b < end; b++)
        worst = share(b) > share(worst) ? b : worst;
    return worst;
}

/* Adds up the forces on all bodies. Notes what is left or broken without inertia. */
static void add_up(bbm_model *m)
{
    begin_bodies(m);
    for (int i = 0; i < m->elements; i++) {
        double W[6] = { 0 };
        bbm_gravity_submatrix(&m->element[i], m->acceleration, W);
        if (m->K->body[i] < 0)                              /* its supports bear its weight     */
            m->beyond->balance[m->beyond->body[i]].forces += 2 * hypot(W[0], W[1]);
        const double turn[6] = { [2] = -bbm_tension_stiffness(m, i) * m->D[6 * i + 2] };
        add_force(m, i, &m->load[6 * i], 1, 0);
        add_force(m, i, turn, 1, 0);
    }
    for (int k = 0; k < m->gaps; k++)
        add_gap(m, &m->gap[k]);
    for (int k = 0; k < m->scratch->contacts; k++)
        add_contact(m, &m->scratch->contact[k]);
    m->beyond->lack = fmax(lack_of(worst_of(m, lack_of)), breach_share(worst_of(m, breach_share)));
    for (int i = 0; i < m->elements; i++) {
        bbm_submatrix s = { { { 0 } }, { 0 } };             /* inertia, both sides of (16), (17) */
        double F[6] = { 0 };
        if (bbm_has_inertia(m, i))
            bbm_inertia_submatrix(&m->element[i], m->h, &s);
        for (int a = 0; a < 36; a++)
            F[a / 6] -= s.K[a / 6][a % 6] * m->D[6 * i + a % 6];
        add_force(m, i, s.F, 1, 0);
        add_force(m, i, F, 1, 0);
    }
}

/* K has lost digits of the inertia of a stiff body. The balance of its forces has not, for those of
 * its bonds cancel. What is left of the balance, spread over the elements of the body, is solved
 * for the rest of D, and contacts are judged anew. */
bbm_pass bbm_refine(bbm_model *m)
{
    double *r = m->beyond->lacking, *d = r + 6 * m->elements;
    int stiff = 0;

    add_up(m);
    for (int i = 0; i < m->elements; i++) {
        const bbm_balance *b = &m->beyond->balance[m->beyond->body[i]];
        stiff |= b->stiff;
        const double share = b->stiff ? m->element[i].A / b->area : 0;
        r[6 * i] = share * b->force[0];
        r[6 * i + 1] = share * b->force[1];
        r[6 * i + 2] = share * b->moment;
    }
    if (!stiff || m->par.velocity_factor == 0
        || bbm_solve(m->K, r, d, &m->par.pcg, &(bbm_pcg_info){ 0 }))
        return BBM_PASS_DONE;
    for (int k = 0; k < 6 * m->elements; k++)
        m->D[k] += d[k];
    m->beyond->refines = 1;
    const bbm_pass next = bbm_open_close(m);
    m->beyond->refines = 0;
    return next;
}

/* Refuses a solution in which the forces on a body do not balance, or in statics a contact breaks
 * its law. */
bbm_status bbm_check_equilibrium(bbm_model *m)
{
    add_up(m);
    const bbm_balance *worst = worst_of(m, lack_of), *broken = worst_of(m, breach_share);
    const double lack = lack_of(worst), breach = breach_share(broken);
    if (lack > (bbm_is_static(m) ? BBM_BALANCED : IN_MOTION))
        return bbm_fail(m, BBM_NOT_CONVERGED, "step %d: forces on block %d lack %.2g of balance: "
                        "a smaller pcg tolerance helps, or the stiffnesses of materials, bonds and "
                        "contacts are too far apart",
                        m->info.step + 1, m->element[worst - m->beyond->balance].block, lack);
    if (bbm_is_static(m) && breach > BBM_BALANCED)
        return bbm_fail(m, BBM_NOT_CONVERGED, "step %d: contacts of block %d carry %.2g of its "
                        "forces against their law", m->info.step + 1,
                        m->element[broken - m->beyond->balance].block, breach);
    m->beyond->breach = isinf(m->par.dt) ? 0 : fmax(m->beyond->breach, breach);
    return BBM_OK;
}
