/* open_close.c - the open-close iteration of Shi (1988), which the paper takes for granted: which
 * contacts are open, locked or slide in a step. The table of states is in contact.c.
 *
 * The iteration. N of a sliding contact depends on its friction, and the friction on N. So solve
 * with the friction of the last N until both agree; a hook may need fewer solutions. Only then look
 * at the states: all that do not fit their forces change, joints last, and a new solution follows.
 * If a set of states comes back, the iteration would cycle. Then, for as many passes as there have
 * been, only the contact that fits worst changes.
 *
 * Nothing moves before all contacts fit. If they never do, the step is done again as if it had not
 * been tried: in halves, or in statics in another way.
 */
#include "base.h"

/* AGREE  [-]  forces agree if they differ by less than this share of N, or of the force by which
 *             their component of K is solved: the solver is not more exact
 * DIGITS [-]  rounding of a position after some sums, against the position. What a spring makes of
 *             it counts as no force
 * FIT    [-]  of a force, the most that rounding may add to its tolerance: so friction is right to
 *             0.01 degrees
 * LATER  [-]  the turn of what waits for others that are no joint, beyond that of a joint
 * ALIKE  [-]  joints that bear this share of what the most loaded one does break with it: one by
 *             one a long joint would take more passes than there are */
#define AGREE 1e-9
#define DIGITS 1e-15
#define FIT 2e-4
#define LATER 1e200
#define ALIKE 0.7

/* The most passes in a row that change friction forces alone. */
enum { FRICTION_PASSES = 100 };

/* --------------------------------------------------------------------- the contacts of a step */

/* Puts the anchor where the shear spring carries the T of the contact: (P1 - P0).m = T/p_s. */
static void place_anchor(const bbm_model *m, bbm_contact *c)
{
    const double s = bbm_way_along(m, c->corner, c->edge);

    c->anchor = (s + c->T / m->par.p_s) / m->edge[c->edge].along.length;
}

/* A contact begins the step with the state of its last step. Its elements are i and j, and those
 * that share P1, P2 or P3 with them. It begins open if P1 has left it past the end of the edge. Its
 * strength is the model's friction angle, or what a hook says. If it is open or its edge is another
 * one, its anchor and rest are placed anew; the rest alone where a hit has unloaded its spring.
 *
 * One that touches when the run begins is closed: what lies flush is under load. It stays open
 * where P1 can come in over more than one line of a corner, for its way will show over which one.
 * An unbroken joint is closed in any case. */
static void begin_contact(const bbm_model *m, bbm_contact *c)
{
    const int P[3] = { m->edge[c->corner].a, m->edge[c->edge].b, m->edge[c->edge].a };
    int lines = 0;

    c->element[0] = m->edge[c->corner].element;
    c->element[1] = m->edge[c->edge].element;
    c->parts = 2;
    for (int k = 0; k < 3; k++)
        if (bbm_partner_of(m, P[k]) != P[k])
            c->element[c->parts++] = m->vertex[bbm_partner_of(m, P[k])].element;
    for (int k = 0; k < 4; k++)
        lines += c->trial.entrance[k] >= 0;
    if (c->trial.has_left)
        bbm_forget(c);
    c->strength = (bbm_strength){ .tan_phi = bbm_tangent(m->par.friction) };
    if (m->hook->strength)
        m->hook->strength(m, c);
    if (c->trial.touches && !c->trial.has_left)
        c->state = lines == 0 || bbm_is_strong(c) ? BBM_LOCK : BBM_OPEN;
    const int begins = !c->trial.carried || c->state == BBM_OPEN;
    if (begins)
        place_anchor(m, c);
    if (begins || (c->hit == 1 && c->N == 0))
        c->rest = bbm_rest_of(m, c->trial.d_n0, c->N);
}

/* Lists the contacts that may be closed in this step, each with the state with which it begins.
 * `same`: the list of this step was the same already, and stays. */
bbm_status bbm_detect_contacts(bbm_model *m, int *same)
{
    bbm_contact_scratch *w = m->scratch;
    const bbm_status status = bbm_list_pairs(m, same);

    if (status || *same)
        return status;
    for (int k = 0; k < w->contacts; k++)
        begin_contact(m, &w->contact[k]);
    w->passes = w->friction_passes = w->one_until = 0;
    return BBM_OK;
}

/* ------------------------------------------------------------- the open-close iteration: forces */

/* d_n and d_s, from an anchor, by these vectors. */
static void vector_distances(const bbm_model *m, const bbm_contact *c, double anchor, double d[2])
{
    bbm_spring v[2];

    bbm_contact_vectors(m, c, anchor, v);
    for (int k = 0; k < 2; k++)
        d[k] = bbm_length_of(&v[k], c->parts, c->element, m->D);
}

/* d_n of an open contact, and how far P1 lies past either end of its edge in the solution: d_s from
 * an anchor at P3, and minus d_s from one at P2. A hook's motion says where the points are. */
static void measure_open(const bbm_model *m, bbm_contact *c)
{
    double from[2][2];                                      /* P3 and P2 */

    for (int end = 0; end < 2; end++)
        (bbm_motion_of(m) ? bbm_end_distances : vector_distances)(m, c, end, from[end]);
    c->anchor = 0;
    c->trial.time_left = 1;
    c->d_s = c->trial.past[0] = from[0][1];
    c->trial.past[1] = -from[1][1];
    c->d_n = from[0][0];
    c->N = c->T = 0;
}

/* d_n, d_s, N and T of a closed contact. The slip of the share of the step after it closed is what
 * loads its shear spring. */
static void measure_closed(const bbm_model *m, bbm_contact *c)
{
    double d[2];

    vector_distances(m, c, c->anchor, d);
    c->d_n = d[0];
    c->d_s = c->trial.time_left * d[1];
    c->N = bbm_normal_force(m, c->d_n - c->rest);
    c->T = m->par.p_s * c->d_s;
    if (c->trial.friction_in_K && !bbm_is_strengthless(c, c->N))
        c->trial.N_of_friction = c->N;
}

/* The force tolerance of a contact: a share of its own force, or of the force on a body by which
 * its component is solved. The error of every N is small against this force alone. What the spring
 * makes of the rounding of positions is added, all of it where that force would move an element by
 * no more than rounding in a step, so that all forces are rounding. In statics nothing is added. */
static void find_tolerance(const bbm_model *m, bbm_contact *c)
{
    const bbm_vertex *P2 = bbm_end_of(m, c->edge), *P3 = bbm_start_of(m, c->edge);
    const double load = m->K->forces[m->K->component[c->element[0]]];
    const double force = fmax(fabs(c->N), load);
    const double rounding = DIGITS * (hypot(P2->x, P2->y) + hypot(P3->x, P3->y));
    const bbm_element *p = &m->element[c->element[0]], *q = &m->element[c->element[1]];
    const double mass = fmin(bbm_mass_per_area(p) * p->A, bbm_mass_per_area(q) * q->A);

    c->trial.rests = load <= 2 * mass / (m->h * m->h) * rounding;
    c->trial.digits = bbm_is_static(m) ? 0 : m->par.p_n * rounding;
    c->trial.force_tolerance = AGREE * force
        + (c->trial.rests ? c->trial.digits : fmin(c->trial.digits, FIT * force));
}

/* Takes the N of this solution for the friction of the next one. Returns whether it is not the one
 * that friction was taken for. */
static int renew_friction(bbm_contact *c)
{
    const double change = fabs(c->N - c->trial.N_of_friction);

    c->trial.N_of_friction = c->N;
    return c->state == BBM_SLIDE && c->strength.tan_phi != 0
        && !(change <= c->trial.force_tolerance);
}

/* ------------------------------------------------------------- the open-close iteration: states */

/* Closes a contact. P1 comes from d0 at the start to d_n at the end, so that it hits at the
 * fraction d0/(d0 - d_n) of the step. The slip counts from where P1 stood at the start, which lies
 * between P3 and P2. Since (53) is linear in the anchor, this slip lies between those from P3 and
 * from P2. The shear spring gets the share of it after the hit, so that it never drives the slip.
 * The contact begins to slide if that is more than friction can hold. It also does if it closes for
 * the second time in the step, since then its shear spring has opened it. */
static void close_contact(const bbm_model *m, bbm_contact *c)
{
    const double d0 = fmax(0, c->trial.d_n0);

    place_anchor(m, c);                                     /* T is 0 */
    const double slip = (1 - c->anchor) * c->trial.past[0] - c->anchor * c->trial.past[1];
    c->trial.time_left = 1 - d0 / (d0 - c->d_n);
    const double T = c->trial.time_left * m->par.p_s * fabs(slip);
    const double N = bbm_normal_force(m, c->d_n - c->rest);
    const int slides = ++c->trial.closings > 1 || T > bbm_shear_strength(&c->strength, N);
    c->state = slides ? BBM_SLIDE : BBM_LOCK;
    c->sign = copysign(1, slip);
}

/* The state of a contact in the next pass, of an open one by the N that it would have if it were
 * closed. A blocked contact stays open. A locked one in tension may have been pulled open by its
 * shear spring. If that carries more than friction would hold under as much pressure, the contact
 * slides first, which removes the spring. */
static bbm_contact_state find_next_state(const bbm_model *m, const bbm_contact *c)
{
    const double N = c->state == BBM_OPEN ? bbm_normal_force(m, c->d_n - c->rest) : c->N;
    const bbm_contact_state next = bbm_next_state(c, N, c->trial.force_tolerance);
    const double strength = bbm_shear_strength(&c->strength, fabs(c->N));

    if (c->state == BBM_OPEN && next != BBM_OPEN && bbm_is_blocked(m, c))
        return BBM_OPEN;
    if (c->state == BBM_LOCK && next == BBM_OPEN && fabs(c->T) > strength && strength > 0)
        return BBM_SLIDE;
    return next;
}

/* The force by which a state fails to fit the solution; of an open one the N if it were closed. */
static double misfit(const bbm_model *m, const bbm_contact *c)
{
    return c->state == BBM_OPEN || c->trial.next_state == BBM_OPEN
         ? fabs(bbm_normal_force(m, c->d_n - c->rest))
         : fabs(fabs(c->T) - bbm_shear_strength(&c->strength, c->N));
}

/* When the turn of a contact comes that does not fit the solution: those with the largest number
 * change, and the others wait. Joints break last, when all that lets go more easily has done so.
 * Of joints those go first that bear the most of their strength: -N/tension, or of the strength in
 * shear (|T| - N tan(phi))/(c A). A contact whose P crosses several lines of a corner waits for
 * those that change its way. */
static double turn_of(const bbm_model *m, const bbm_contact *c, int one)
{
    const bbm_strength *s = &c->strength;

    if (c->state != BBM_OPEN && c->trial.next_state != BBM_LOCK && bbm_is_strong(c))
        return fmax(-c->N / s->tension, (fabs(c->T) - c->N * s->tan_phi) / s->shear);
    return one ? LATER * misfit(m, c) : bbm_is_at_corner(m, c) ? LATER : INFINITY;
}

/* Changes the states that do not fit the solution, of those whose turn it is, or only the one of
 * them that fits worst. That one is the same in any order of the blocks, but for a tie. Returns the
 * number of changes. */
static int change_states(bbm_model *m)
{
    bbm_contact_scratch *w = m->scratch;
    const int one = w->passes < w->one_until;
    double first = 0;
    int changes = 0;

    for (bbm_contact *c = w->contact; c < w->contact + w->contacts; c++) {
        c->trial.next_state = find_next_state(m, c);
        c->trial.unsettled = c->trial.next_state != c->state;
        if (c->trial.unsettled)
            first = fmax(first, turn_of(m, c, one));
    }
    for (bbm_contact *c = w->contact; c < w->contact + w->contacts && !(one && changes); c++) {
        if (!c->trial.unsettled || turn_of(m, c, one) < (one ? 1 : ALIKE) * first)
            continue;
        if (c->state == BBM_OPEN)
            close_contact(m, c);
        else {
            c->state = c->trial.next_state;
            c->sign = copysign(1, c->T);
        }
        changes++;
    }
    return changes;
}

/* Notes the states of this pass, with the direction of each slip, as one number, a hash (FNV-1a).
 * An earlier pass with the same number had the same states: the iteration cycles, and from now on
 * one contact alone changes in each pass, for as many passes as there have been. The last pass may
 * have had them: then a hook has only renewed the vectors. The hash takes 1 to 5, as negative
 * numbers would collide. */
static void note_states(bbm_contact_scratch *w)
{
    uint64_t hash = 14695981039346656037u;

    for (const bbm_contact *c = w->contact; c < w->contact + w->contacts; c++) {
        const int direction = c->state == BBM_SLIDE && c->sign < 0 ? -1 : 1;
        hash = (hash ^ (uint64_t)(3 + direction * (int)c->state)) * 1099511628211u;
    }
    for (int p = 0; p < w->passes; p++)
        if (w->seen[p] == hash && w->seen[w->passes - 1] != hash)
            w->one_until = 2 * w->passes;
    w->seen[w->passes] = hash;
}

/* Checks a solution: first whether the friction forces agree with their N, then whether the states
 * fit the forces. A hook may find more to do. */
bbm_pass bbm_open_close(bbm_model *m)
{
    bbm_contact_scratch *w = m->scratch;
    int renewed = 0;

    m->info.passes++;
    for (bbm_contact *c = w->contact; c < w->contact + w->contacts; c++) {
        (c->state == BBM_OPEN ? measure_open : measure_closed)(m, c);
        find_tolerance(m, c);
        c->trial.unsettled = renew_friction(c);
        renewed |= c->trial.unsettled;
    }
    bbm_note_depths(m, w->contact, w->contacts);
    if (renewed)
        return ++w->friction_passes <= FRICTION_PASSES ? BBM_PASS_AGAIN : BBM_PASS_GIVE_UP;
    w->friction_passes = 0;
    note_states(w);
    bbm_pass next = change_states(m) ? BBM_PASS_AGAIN : BBM_PASS_DONE;
    if (m->hook->renew)
        next = m->hook->renew(m, next);
    return next == BBM_PASS_AGAIN && ++w->passes > BBM_MAX_PASSES ? BBM_PASS_GIVE_UP : next;
}

/* ------------------------------------------------------------------------------ end of the step */

/* Ends the step: its contacts become those of the model, which has moved. The anchor of a contact
 * that slides, or has closed in the step, is placed where the whole shear spring carries T. One
 * that slides has slid by as much as its anchor moved. A joint that has opened, or slid against a
 * shear strength, is broken. */
void bbm_store_contacts(bbm_model *m)
{
    m->info.penetration = m->info.contacts = 0;
    bbm_keep_contacts(m);
    for (bbm_contact *c = m->contact; c < m->contact + m->contacts; c++) {
        const double strength = bbm_shear_strength(&c->strength, c->N);
        c->T = bbm_shear_force(c);
        if (c->state == BBM_SLIDE)
            c->slip += fabs(c->d_s - c->T / m->par.p_s);
        if (c->state == BBM_SLIDE || c->trial.time_left < 1)
            place_anchor(m, c);
        if (c->state == BBM_OPEN || (c->state == BBM_SLIDE && strength > 0))
            c->area = 0;
        c->inside = c->state == BBM_OPEN && c->d_n < 0 && (c->trial.was_closed || c->inside);
        m->info.contacts += c->state != BBM_OPEN;
        m->info.penetration = fmax(m->info.penetration, c->state == BBM_OPEN ? 0 : -c->d_n);
    }
}
