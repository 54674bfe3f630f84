/* impact.c - velocities after a hit, and of what is held by supports that move.
 *
 * Beyond the paper. V' = 2/h D - V, Eq. (14), has no damping where D is prescribed, by a stiff
 * contact or by a support that moves: what V' is then depends on the share of the step before the
 * hit, and in the next steps it alternates. Here such a step ends with a jump: the velocities at
 * its end become others, V' -> V'', in no time. Positions stay.
 *
 * The jump is one more solution of (5), of a step of length h that begins where this one has ended.
 * Its unknowns are X = h/2 V''. It begins with half of V' for V. Then (16), (17) say
 *
 *     (2 M/h^2 + K) X = 2 M/h (V'/2) + F,
 *
 * and K has the same elastic, bonding, normal and shear submatrices as ever. Only what they count
 * from is another. Elements and bonds count from h/2 V', so that they resist a change of their
 * shape. K h^2/2 alone would do so in long steps only. So where there is a hit with a restitution
 * Young's modulus counts as at least so large that bodies move as rigid ones, in the step and in
 * the jump. What the hit gives back depends neither on dt nor on the mesh then, and leaves no body
 * vibrating. A held point counts from h/2 w, w the velocity of its support, and so does what is
 * held all round. A closed contact counts from h/2 v, v the velocity that is asked for: 0; or, if
 * it is hit, -E times the normal velocity with which it came; or, without a restitution, the one
 * that it has, also along the edge. One that has closed in this step is hit, but not again before
 * it has been outside: a block that comes to rest would hop from corner to corner, and sink in each
 * hop. The open-close iteration finds which contacts stay closed and which slide. It judges the
 * forces of the step and of the jump together, for they act in the same time: F takes back the
 * contact forces of the step, and the jump finds them anew. A contact that is not hit begins with
 * its normal force, or what is squeezed would lose it; without a restitution with its shear force,
 * too. In between two bodies all this is push and pull, so that momentum stays.
 *
 * With a restitution a contact that is hit, or that the jump opens, has had its impulse: its spring
 * starts unloaded. Without one it keeps what it bears, or a light block that moves to and fro under
 * a slow press would never be pressed. The law of Newton (-E times the velocity at the points that
 * touch) may make energy where several points hit together or rub, and a little by the order of the
 * step. Such a jump is done again with less asked of the contacts, in the end with 0 for all that
 * is asked of contacts, elements and bonds: (M + h^2/2 K) V'' = M V' takes energy from any motion.
 * Where a corner that slides jams it may not settle; then it is done without friction.
 *
 * A support has moved by r1 h1 in this step and by r0 h0 in the one before. At the end of the step
 * its velocity is r1 + (r1 - r0) h1/(h0 + h1), right to second order. But where it changes at once,
 * as where it starts or stops, it is r1, and what lies on the support is struck.
 */
#include "beyond.h"

/* STIFF [-]     springs of contacts in the jump, against 2 m/h^2 of the heaviest element that is
 *               not held: velocities are right to its inverse
 * RIGID [-]     E t in a hit, against 2 m/h^2 of what its component has that is free to move: what
 *               hits give back is right to 1e-3. A hundred times as much, and rounding in bonds
 *               costs momentum
 * EARLY [-]     of a step: what would hit so soon hits with the others
 * EVEN [-]      the least that the change in the step before is of a change that is even: where an
 *               even one starts it is a half
 * SLIGHT [-]    of a velocity, what it may change in a step in any case
 * GAIN [-]      energy that a jump may make, against what was there: rounding
 * WORKED [-]    the same where no hit asks for anything: the work of supports that move is right to
 *               second order in the step */
#define STIFF 1e5
#define RIGID 1e4
#define EARLY 1e-2
#define EVEN 0.3
#define SLIGHT 1e-2
#define GAIN 1e-9
#define WORKED 1e-7

/* How often springs double that begin soft. */
enum { SOFTER = 10 };

/* The velocity of P1 along the normal (0) or the edge (1), where elements move as those of `of`. */
static double velocity(const bbm_model *m, const bbm_contact *c, const bbm_element of[], int way)
{
    double sum = 0;
    bbm_spring v[2];

    bbm_contact_vectors(m, c, c->anchor, v);
    for (int a = 0; a < 6 * c->parts; a++)
        sum += v[way].v[a / 6][a % 6] * of[c->element[a / 6]].V[a % 6];
    return sum;
}

/* h/2 times the normal velocity with which P1 came. It changes evenly over the step, with the mean
 * -d0/(t h), and P1 hits after the share t of the step. Of what has closed twice, or is open in the
 * end, springs have changed the way: it has the velocity of the start. */
static double approach(const bbm_model *m, const bbm_contact *c)
{
    const double t = 1 - c->trial.time_left, came = m->h / 2 * velocity(m, c, m->element, 0);

    return t == 0 || c->trial.closings > 1 ? came : (1 - 2 * t) * came - fmax(0, c->trial.d_n0);
}

/* 1/mass of an element that is free to move. */
static double mobility(const bbm_model *m, int i)
{
    const bbm_element *e = &m->element[i];

    return bbm_is_held_all_round(m, e) ? 0 : 1 / (bbm_mass_per_area(e) * e->A);
}

/* Of the component of an element. */
static bbm_account *account_of(const bbm_model *m, int i)
{
    return &m->beyond->account[m->K->component[i]];
}

/* Whether the velocity of a support changes as it did in the step before, or hardly at all; else it
 * jumps. */
static int changes_evenly(const bbm_model *m, int node)
{
    const bbm_support *s = &m->beyond->support[node];
    double before = 0, now = 0, least = 0;

    for (int a = 0; a < 2; a++) {
        const double r = m->beyond->share * s->moved[a] / m->h, change = r - s->rate[a];
        before += change * (s->rate[a] - s->earlier[a]);
        now += change * change;
        least += pow(SLIGHT * r, 2);
    }
    return before >= EVEN * now || now <= least;
}

/* What closes in the step hits, and what was closed if its component is struck: the velocity of a
 * support has changed at once, or the run begins after settling, and a contact comes faster than it
 * makes good by what it bears in the step. But an unbroken joint does not hit. */
static int may_hit(const bbm_model *m, const bbm_contact *c)
{
    return !bbm_is_strong(c) && (!c->trial.was_closed || account_of(m, c->element[0])->struck > 1);
}

static int has_closed(const bbm_model *m, const bbm_contact *c)
{
    return c->state != BBM_OPEN && may_hit(m, c);
}

/* The velocity of a support at the end of the step. */
static double support_velocity(const bbm_model *m, int node, int a)
{
    const bbm_support *s = &m->beyond->support[node];
    const double r = m->beyond->share * s->moved[a] / m->h;

    return changes_evenly(m, node) ? r + (r - s->rate[a]) * m->h / (m->h + m->beyond->h_before) : r;
}

/* Marks the components with a hit that has a restitution, also with one that an earlier pass had,
 * and finds the mass in them that is free to move. */
static void find_hits(const bbm_model *m)
{
    for (int i = 0; i < m->elements; i++)
        m->beyond->account[i].mass = m->beyond->account[i].jumps = m->beyond->account[i].struck = 0;
    for (const bbm_vertex *v = m->vertex; v < m->vertex + m->vertices; v++)
        account_of(m, v->element)->struck |= m->info.t == 0 || !changes_evenly(m, v->node);
    for (const bbm_contact *c = m->scratch->contact; c < bbm_end_of_contacts(m); c++) {
        const double mobile = mobility(m, c->element[0]) + mobility(m, c->element[1]);
        const double bears = fmax(0, bbm_normal_force(m, c->trial.d_n0 - c->rest));
        bbm_account *of = account_of(m, c->element[0]);
        if (of->struck && -2 / m->h * approach(m, c) > m->h * bears * mobile)
            of->struck = 2;
    }
    for (const bbm_contact *c = m->scratch->contact; c < bbm_end_of_contacts(m); c++)
        account_of(m, m->edge[c->corner].element)->jumps |= m->beyond->restitution >= 0
            && may_hit(m, c) && (c->state != BBM_OPEN || c->trial.closings > 0);
    for (int i = 0; i < m->elements; i++)
        if (account_of(m, i)->jumps && mobility(m, i) > 0)
            account_of(m, i)->mass += 1 / mobility(m, i);
}

/* By how much an element is stiffer in a hit, so that its component moves as rigid bodies do. */
static double rigidity(const bbm_model *m, int i)
{
    const bbm_material *of = &m->element[i].material;

    return fmax(1, RIGID * 2 * account_of(m, i)->mass / (m->h * m->h * of->E * of->thickness));
}

/* Adds to K what makes bodies rigid in a step with a hit: they resist strain, without Poisson's
 * effect, and the opening of bonds, from what they have at its start. Springs of bonds, not their
 * moments, are alpha times as stiff by themselves. */
void bbm_stiffen(bbm_model *m)
{
    if (m->beyond->restitution < 0 || bbm_is_static(m) || m->par.velocity_factor == 0
        || m->beyond->jump_of)
        return;
    find_hits(m);
    for (int i = 0; i < m->elements; i++) {
        bbm_element e = m->element[i];
        bbm_submatrix s = { { { 0 } }, { 0 } };
        e.material.E *= rigidity(m, i) - 1;
        e.material.nu = 0;
        bbm_elastic_submatrix(&e, &s);
        bbm_matrix_add(m->K, i, i, s.K);
    }
    for (const bbm_gap *g = m->gap; g < m->gap + m->gaps; g++) {
        const double stiffer = fmax(1, rigidity(m, g->i) / (g->elastic ? 1 : m->par.alpha)) - 1;
        bbm_gap more = *g;
        const int holds = g->j < 0 || g->W[0][0] + g->W[1][1] < 0;      /* a node: bending.c */
        if (stiffer == 0 || holds || m->beyond->body[g->i] != m->beyond->body[g->j])
            continue;
        memset(more.d0, 0, sizeof more.d0);
        for (int a = 0; a < 4; a++)
            more.W[a / 2][a % 2] *= stiffer;
        bbm_assemble_gap(m, &more);
    }
}

/* F takes back the contact forces of the step. */
static void take_back(bbm_model *m)
{
    memset(m->load, 0, 6 * (size_t)m->elements * sizeof *m->load);
    for (int k = 0; k < m->scratch->contacts; k++) {
        const bbm_contact *c = &m->beyond->jump_of[k];
        double F[BBM_PARTS][6];
        bbm_contact_forces(m, c, F);
        for (int i = 0; i < 6 * c->parts && isfinite(m->scratch->contact[k].rest); i++)
            m->load[6 * c->element[i / 6] + i % 6] -= F[i / 6][i % 6];
    }
}

/* The elements at the end of the step. */
static void start_elements(bbm_model *m, const bbm_model *end)
{
    double heaviest = 0, E[3][3];

    for (int i = 0; i < m->elements; i++) {
        bbm_element *e = &m->element[i];
        *e = end->element[i];
        e->middle = NULL;
        bbm_element_geometry(e, &m->vertex[e->first]);
        if (m->K->body[i] < 0)
            bbm_follow_supports(m, e, support_velocity);
        e->material.E *= rigidity(end, i);
        e->material.nu *= m->beyond->restitution < 0;   /* what is rigid does not spread        */
        bbm_elastic_matrix(&e->material, E);
        memset(e->stress, 0, sizeof e->stress);
        for (int a = 0; a < 6; a++) {
            e->V[a] *= account_of(m, i)->jumps ? 0.5 : 0;
            m->D[6 * i + a] = m->h * e->V[a];
        }
        for (int a = 0; a < 9 && account_of(m, i)->jumps > 0; a++)
            e->stress[a / 3] -= E[a / 3][a % 3] * m->D[6 * i + 3 + a % 3];
        if (account_of(m, i)->jumps && mobility(m, i) > 0)
            heaviest = fmax(heaviest, 1 / mobility(m, i));
    }
    m->par.p_n = m->par.p_s = fmax(end->par.p_n, STIFF * 2 * heaviest / (m->h * m->h));
}

/* The gaps of the jump. The bonds of a body are listed alpha times as stiff as its elements are
 * now. They become as stiff as these, or as they were if that is more, and so do its fixed points.
 * What is held all round stays as stiff as it is listed, for hits lose what it gives way. */
static void start_gaps(bbm_model *m, const bbm_model *end)
{
    double d[2];

    bbm_list_gaps(m);
    for (bbm_gap *g = m->gap; g < m->gap + m->gaps; g++) {
        const int body = m->K->body[g->i], joins = g->j >= 0 && m->K->body[g->j] != body;
        for (int a = 0; a < 4 && body >= 0 && !joins && !g->elastic; a++)
            g->W[a / 2][a % 2] *= fmax(1 / rigidity(end, g->i), 1 / m->par.alpha);
        memset(g->d0, 0, sizeof g->d0);
        bbm_gap_length(m, g, d);
        for (int a = 0; a < 2; a++) {
            const double w0 = support_velocity(m, g->node[0], a);
            const double w1 = support_velocity(m, g->node[1], a);
            g->d0[a] = g->j >= 0 ? -(account_of(m, g->i)->jumps > 0 && g->W[a][a] >= 0) * d[a]
                     : -m->h / 4 * (g->elastic ? w0 - w1 : w0 + w1);
        }
    }
}

/* The contacts of `step`, the model at the start of the step, with springs as stiff as p_n is; d_s
 * is linear in the anchor. `again`: in the states that softer ones have found. */
static void start_contacts(bbm_model *m, const bbm_model *step, int again)
{
    const double E = m->beyond->restitution;

    for (int k = 0; k < m->scratch->contacts; k++) {
        bbm_contact *c = &m->scratch->contact[k], found = *c;
        *c = m->beyond->jump_of[k];
        const bbm_account *of = account_of(m, m->edge[c->corner].element);
        bbm_spring v[2], from_end[2];
        bbm_contact_vectors(m, c, 0, v);
        bbm_contact_vectors(m, c, 1, from_end);
        const double slip = bbm_shear_force(c) / m->par.p_s - m->h * velocity(m, c, m->element, 1);
        c->anchor = (v[1].d - (E < 0 && of->jumps > 0) * slip) / (v[1].d - from_end[1].d);
        const int hits = E >= 0 && has_closed(m, c) && (c->hit != 1 || of->struck > 1);
        const double asked = hits ? E * sqrt(of->asked) * fmax(0, -approach(step, c))
                           : c->N / m->par.p_n + (E < 0) * m->h * velocity(m, c, m->element, 0);
        c->state = of->jumps == 0 ? BBM_OPEN : c->state;
        c->rest = c->state == BBM_OPEN ? -INFINITY : v[0].d + (of->jumps > 0) * asked;
        c->strength = of->jumps < -1 ? (bbm_strength){ 0 } : c->strength;
        c->trial = (bbm_trial){ .was_closed = 1, .time_left = 1, .entrance = { -1, -1, -1, -1 },
                                .N_of_friction = c->trial.N_of_friction };
        c->state = again ? found.state : c->state;
        c->sign = again ? found.sign : c->sign;
    }
}

/* Solves until all contacts fit; if they do not, notes which components did not settle. Where many
 * contacts hit together the stiffest springs may find no states, but softer ones do. Then springs
 * begin 2^-SOFTER times as stiff and double, each time with the states that were found last. If a
 * softer one finds none, the stiffest are tried once more, for the components that settle. */
static bbm_status solve(bbm_model *m, const bbm_model *step, const bbm_model *end)
{
    bbm_status status = BBM_OK;
    bbm_pass pass = BBM_PASS_DONE;

    start_elements(m, end);
    start_gaps(m, end);
    const double p = m->par.p_n;
    for (int k = 0, soft = 0; k >= 0 && !status; soft = 1) {
        m->par.p_n = m->par.p_s = ldexp(p, -k);
        start_contacts(m, step, soft && k < SOFTER);
        m->scratch->passes = m->scratch->friction_passes = m->scratch->one_until = 0;
        for (pass = BBM_PASS_AGAIN; !status && pass == BBM_PASS_AGAIN; pass = bbm_open_close(m)) {
            bbm_assemble(m);
            status = bbm_solve(m->K, m->F, m->D, &m->par.pcg, &m->info.pcg);
        }
        k = pass == BBM_PASS_DONE ? k - 1 : soft ? (k > 0) - 1 : SOFTER;
    }
    for (int i = 0; i < m->elements; i++)
        m->beyond->account[i].unsettled = status != BBM_OK;
    for (const bbm_contact *c = m->scratch->contact; c < bbm_end_of_contacts(m); c++)
        account_of(m, m->edge[c->corner].element)->unsettled |= c->trial.unsettled;
    return status || pass == BBM_PASS_DONE ? status : BBM_OPEN_CLOSE;
}

/* ----------------------------------------------------------------------------- around the jump */

/* Whether the wall point of a node moves, or has moved in the step before. */
static int moves(const bbm_model *m, int node)
{
    const bbm_support *s = &m->beyond->support[node];

    return s->moved[0] != 0 || s->moved[1] != 0 || s->rate[0] != 0 || s->rate[1] != 0;
}

/* Which components jump: those with a hit with a restitution, or a support that moves. Returns
 * whether there is one. What would hit in the next small share of a step hits as well, for rounding
 * does not decide which corner of a flat block is first; and so does what would have hit if
 * friction at another corner had not lifted it. */
static int find_causes(const bbm_model *m, const bbm_model *end)
{
    int any = 0;

    find_hits(m);
    for (bbm_contact *c = m->scratch->contact; c < bbm_end_of_contacts(m); c++)
        if (account_of(m, c->element[0])->jumps && c->state == BBM_OPEN && !c->trial.was_closed
            && !bbm_is_blocked(m, c)
            && (c->d_n < -EARLY * m->h * velocity(m, c, end->element, 0)
                || c->trial.d_n0 < -m->h * velocity(m, c, m->element, 0)))
            c->state = BBM_LOCK;
    for (int v = 0; v < m->vertices; v++)
        any |= account_of(m, m->vertex[v].element)->jumps |= moves(m, m->vertex[v].node);
    return any;
}

/* The work of the supports that move, at each element: the force of each spring on h times the mean
 * of V' and V'' at its end. The elements of the jump have V'/2, and -d0 is h/2 V'' of the wall. */
static void find_work(bbm_model *m)
{
    double d[2];

    bbm_find_reactions(m);
    for (const bbm_gap *g = m->gap; g < m->gap + m->gaps; g++) {
        if (g->j >= 0 || !(moves(m, g->node[0]) || moves(m, g->node[1])))
            continue;
        bbm_gap_length(m, g, d);
        for (int a = 0; a < 2; a++) {
            double way = -g->d0[a];
            for (int k = 0; k < 6; k++)
                way += m->h * g->Ti[a][k] * m->element[g->i].V[k];
            m->beyond->account[g->i].held[1] -= (g->W[a][0] * d[0] + g->W[a][1] * d[1]) * way;
        }
    }
}

/* The elements at the end of the step take their velocities. The contacts are what they were, and
 * note what the jump adds to their forces. With a restitution the spring of one that has had its
 * impulse starts unloaded. */
static void take(bbm_model *m, bbm_model *end)
{
    find_work(m);
    for (int a = 0; a < 6 * m->elements; a++)
        if (account_of(m, a / 6)->jumps)
            end->element[a / 6].V[a % 6] = 2 / m->h * m->D[a];
    for (int k = 0; k < m->scratch->contacts; k++) {
        bbm_contact *c = &m->scratch->contact[k];
        const int jumped = isfinite(c->rest), opens = c->state == BBM_OPEN;
        const double N = c->N, T = bbm_shear_force(c);
        *c = m->beyond->jump_of[k];
        if (jumped && m->beyond->restitution >= 0 && (opens || has_closed(m, c))) {
            c->hit = 1;
            c->N = c->T = c->trial.time_left = 0;
        }
        c->trial.jump[0] = jumped ? N - c->N : 0;
        c->trial.jump[1] = jumped ? T - bbm_shear_force(c) : 0;
    }
}

/* The kinetic energy of the normal velocities of all hits, as they came and as they are left, with
 * the reduced mass of the two elements, J. */
static void find_energy_of_hits(const bbm_model *m, const bbm_model *step, const bbm_model *end,
                                double hit[2])
{
    for (int k = 0; k < m->scratch->contacts; k++) {
        const bbm_contact *c = &m->beyond->jump_of[k];
        const double mobile = mobility(m, c->element[0]) + mobility(m, c->element[1]);
        if (!has_closed(m, c) || mobile == 0)
            continue;
        const double came = 2 / m->h * approach(step, c);
        const double left = velocity(m, c, end->element, 0);
        hit[0] += came * came / (2 * mobile);
        hit[1] += left * left / (2 * mobile);
    }
}

/* The jump that is asked for. Where it makes energy, contacts are to give back less: by twice the
 * share that it makes, and in each further try by twice as much again, for what hits have may be a
 * small part of all. In the end nothing is asked, then nothing is kept, and then nothing rubs. A
 * component that settles and makes no energy keeps what it was asked for, whatever others do. */
static bbm_status choose(bbm_model *m, bbm_model *step, bbm_model *end)
{
    const double most = m->beyond->restitution < 0 ? WORKED : GAIN;
    bbm_status status = BBM_OK;
    int again = 1;

    for (int c = 0; c < m->elements; c++)
        m->beyond->account[c].asked = 1;
    for (int tries = 1; again && status != BBM_NO_MEMORY; tries++) {
        *end = bbm_end_of_step(step);
        status = solve(m, step, end);
        take(m, end);
        bbm_find_accounts(step, end);
        again = 0;
        for (bbm_account *a = m->beyond->account; a < m->beyond->account + m->elements; a++) {
            const int fits = !a->unsettled && (a->jumps < 0 || a->gain <= most * a->there);
            if (fits || a->jumps == 0 || a->jumps == -2)
                continue;
            a->jumps = a->jumps < 0 ? -2 : a->asked > 0 ? 1 : -1;
            a->asked = a->unsettled ? 0 : fmax(0, a->asked - ldexp(a->gain / a->there, tries));
            again = 1;
        }
    }
    return status ? bbm_say_what_failed(step, status) : BBM_OK;
}

/* The velocities at the end of the step, where a contact has closed or a support moves. `end` has
 * those of (14). The model of the jump is that at the end of the step, with lists of its own; its
 * gaps take the place of those of the step, which are listed anew. hit, which begins with 0,
 * gets the energy of the hits, as they came and as they are left. */
bbm_status bbm_jump(bbm_model *m, bbm_model *end, double hit[2])
{
    const size_t n = (size_t)m->elements, contacts = (size_t)m->scratch->contacts;
    bbm_status status = BBM_NO_MEMORY;
    bbm_hooks hook = *m->hook;
    bbm_model jump = *end;

    if (bbm_is_static(m) || m->par.velocity_factor == 0 || !find_causes(m, end))
        return BBM_OK;
    hook.motion = NULL;
    hook.renew = NULL;
    hook.load = take_back;
    jump.hook = &hook;
    jump.element = calloc(n, sizeof *jump.element);
    jump.F = calloc(18 * n, sizeof *jump.F);
    bbm_contact *list = m->beyond->jump_of = calloc(contacts + 1, sizeof *list);
    if (jump.element && jump.F && list) {
        jump.D = jump.F + 6 * n;
        jump.load = jump.D + 6 * n;
        memcpy(list, m->scratch->contact, contacts * sizeof *list);
        status = choose(&jump, m, end);
        find_energy_of_hits(&jump, m, end, hit);
    }
    free(jump.element);
    free(jump.F);
    free(list);
    m->beyond->jump_of = NULL;
    return status;
}
