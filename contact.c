/* contact.c - contacts between blocks: sections 3.7 and 3.8 of the paper, then the open-close
 * iteration.
 *
 * Blocks touch where a vertex P1 of one meets an edge P2 P3 of another. A stiff spring p_n then
 * resists penetration, a spring p_s resists slip, and where Mohr and Coulomb's bound is passed,
 * friction takes the place of p_s:
 *
 *                   d_n < 0                     |T| > N tan(phi) + c A
 *       .------.  ------------->  .------.  --------------------------->  .-------.
 *       | OPEN |                  | LOCK |                                | SLIDE |
 *       '------'  <-------------  '------'  <---------------------------  '-------'
 *           ^     N < -tension A               s T < N tan(phi) + c A         |
 *           '-----------------------------------------------------------------'
 *                                  N < -tension A
 *
 * N = -p_n d_n is the normal force. T = p_s d_s is what the shear spring carries, or would carry. s
 * is the sign of the slip. c and tension are the cohesion and the tensile strength of an unbroken
 * joint, A is the contact's share of its area: in the paper all 0.
 *
 * d_s counts from the anchor P0, a point of the edge's material. P0 is where P1 hit, and stays
 * there while the contact is locked. While it slides, P0 follows at such a distance that the spring
 * would carry the friction force of the last step. Then what s T has above the bound is new slip.
 * When the slip turns round, s T falls below the bound and the contact locks with the force that it
 * had.
 *
 * The iteration. N of a sliding contact depends on its friction, and the friction on N. So solve
 * with the friction of the last N until both agree; a hook may need fewer solutions. Only then look
 * at the states: all that do not fit their forces change, and a new solution follows. If a set of
 * states comes back, the iteration would cycle. Then, for as many passes as there have been, only
 * the contact that fits worst changes. A contact that closes with more shear than friction can
 * hold, or for the second time in the step, starts as SLIDE. Without friction and cohesion a
 * contact never stays locked.
 *
 * Nothing moves before all contacts fit. If they never do, the step is done again as if it had not
 * been tried: in halves, or in statics in another way.
 *
 * base/detect.c finds which corners may touch which edges.
 */
#include <string.h>

#include "base/base.h"

/* AGREE  [-]  forces agree if they differ by less than this share of the largest force in their
 *             component of K: the solver is not more exact
 * DIGITS [-]  rounding of a position after some sums, against the position. What a spring makes of
 *             it counts as no force
 * ROUGH  [-]  but at most this share of the largest force does. Stiffer springs do not settle */
#define AGREE 1e-9
#define DIGITS 1e-15
#define ROUGH 1e-3

/* The most passes in a row that change friction forces alone. */
enum { FRICTION_PASSES = 100 };

/* --------------------------------------------------------------------- 3.7.1 Normal submatrices */

/* The normal distance of P1 from P2 P3, positive outside. The points move by T D, Eq. (48)-(50),
 * and the terms of second order are dropped: d_n = S/l = S0/l + e.D_i + g.D_j, Eq. (52)-(57), (59):
 *     S0 = det [1 x1 y1; 1 x2 y2; 1 x3 y3],   e = T_i^T(P1) (y2 - y3, x3 - x2)/l,
 *     g = T_j^T(P2) (y3 - y1, x1 - x3)/l + T_j^T(P3) (y1 - y2, x2 - x1)/l.
 * In e and g a hook has T and the points p1, p2, p3 of another moment of the step. */
void bbm_normal_vectors(const bbm_touch *c, bbm_spring *n)
{
    const double x1 = c->P1->x, y1 = c->P1->y, x2 = c->P2->x, y2 = c->P2->y;
    const double x3 = c->P3->x, y3 = c->P3->y, l = hypot(x3 - x2, y3 - y2);
    double T1[2][6], T2[2][6], T3[2][6], p1[2], p2[2], p3[2], *e = n->v[0], *g = n->v[1];

    n->d = ((x2 - x1) * (y3 - y1) - (x3 - x1) * (y2 - y1)) / l;
    bbm_step_point(c->i, x1, y1, T1, p1);
    bbm_step_point(c->j, x2, y2, T2, p2);
    bbm_step_point(c->j, x3, y3, T3, p3);
    for (int a = 0; a < 6; a++) {
        e[a] = (T1[0][a] * (p2[1] - p3[1]) + T1[1][a] * (p3[0] - p2[0])) / l;
        g[a] = (T2[0][a] * (p3[1] - p1[1]) + T2[1][a] * (p1[0] - p3[0])
                + T3[0][a] * (p1[1] - p2[1]) + T3[1][a] * (p2[0] - p1[0])) / l;
    }
}

/* A spring p, normal or shear, over d = d0 + e.D_i + g.D_j: Pi = p/2 d^2, Eq. (51)   ->
 * Eq. (58), (58a-f), (63): K_ii += p e e^T, K_ij += p e g^T, K_jj += p g g^T. v and w: e or g. */
void bbm_spring_submatrix(double p, const double v[6], const double w[6], double K[6][6])
{
    for (int a = 0; a < 6; a++)
        for (int b = 0; b < 6; b++)
            K[a][b] += p * v[a] * w[b];
}

/* The force f of a contact at D = 0 is a load on both sides: F_i -= f e, F_j -= f g. A spring has
 * f = p d0, Eq. (59), (64). The friction force Fr of Eq. (65), positive when P1 slips towards P3,
 * has the e and g of the shear spring, Eq. (66)-(69). */
void bbm_force_submatrix(double f, const double v[6], double F[6])
{
    for (int a = 0; a < 6; a++)
        F[a] -= f * v[a];
}

/* ---------------------------------------------------------------------- 3.7.2 Shear submatrices */

/* The displacement of P1 along the edge against the anchor P0 = P3 + anchor (P2 - P3), a point of
 * the edge's material: d_s = S1 + e.D_i + g.D_j, Eq. (48)-(50), (53), (60)-(62), (64), (67), (68):
 *     m = (P3 - P2)/l,   S1 = (P1 - P0).m,   e = T_i^T(P1) m,   g = -T_j^T(P0) m.
 * Deviation: with the T and the points of a hook g has what (60) drops, the turning of m, as well:
 * (T_j(P3) - T_j(P2))^T (P1 - P0)/l. Without it friction does not keep angular momentum. */
void bbm_shear_vectors(const bbm_touch *c, double anchor, bbm_spring *s)
{
    const bbm_vertex *P1 = c->P1, *P2 = c->P2, *P3 = c->P3;
    const double x0 = P3->x + anchor * (P2->x - P3->x), y0 = P3->y + anchor * (P2->y - P3->y);
    const double l = hypot(P3->x - P2->x, P3->y - P2->y), turns = c->i->middle ? 1 : 0;
    double T1[2][6], T0[2][6], T2[2][6], T3[2][6], p1[2], p0[2], p2[2], p3[2];
    double *e = s->v[0], *g = s->v[1];

    s->d = ((P1->x - x0) * (P3->x - P2->x) + (P1->y - y0) * (P3->y - P2->y)) / l;
    bbm_step_point(c->i, P1->x, P1->y, T1, p1);
    bbm_step_point(c->j, x0, y0, T0, p0);
    bbm_step_point(c->j, P2->x, P2->y, T2, p2);
    bbm_step_point(c->j, P3->x, P3->y, T3, p3);
    const double mx = (p3[0] - p2[0]) / l, my = (p3[1] - p2[1]) / l;
    const double ax = turns * (p1[0] - p0[0]) / l, ay = turns * (p1[1] - p0[1]) / l;
    for (int a = 0; a < 6; a++) {
        e[a] = T1[0][a] * mx + T1[1][a] * my;
        g[a] = -T0[0][a] * mx - T0[1][a] * my
             + (T3[0][a] - T2[0][a]) * ax + (T3[1][a] - T2[1][a]) * ay;
    }
}

/* --------------------------------------------------------------------------------- 3.8 Friction */

double bbm_tangent(double degrees) { return tan(degrees * acos(-1) / 180); }

/* Mohr and Coulomb: the largest shear force under the normal force N, N tan(phi), Eq. (65), and the
 * cohesion of an unbroken joint. Tension, N < 0, takes away from it, down to 0. */
double bbm_shear_strength(const bbm_strength *s, double N)
{
    return fmax(0, N * s->tan_phi + s->shear);
}

/* The figure on top as a table: the state that follows from d_n, N and T. Forces that differ by
 * less than the tolerance agree. A closed contact opens without a tolerance: it would be a hidden
 * tensile strength. */
bbm_contact_state bbm_next_state(double p_n, const bbm_contact *c, double tolerance)
{
    const double strength = bbm_shear_strength(&c->strength, c->N);

    if (c->state == BBM_OPEN)
        return -p_n * (c->d_n - c->rest) > tolerance ? BBM_LOCK : BBM_OPEN;
    if (c->N < -c->strength.tension)
        return BBM_OPEN;
    if (c->strength.tan_phi == 0 && c->strength.shear == 0)
        return BBM_SLIDE;
    if (c->state == BBM_LOCK)
        return fabs(c->T) > strength + tolerance ? BBM_SLIDE : BBM_LOCK;
    return c->sign * c->T < strength - tolerance ? BBM_LOCK : BBM_SLIDE;
}

/* --------------------------------------------------------------------- the contacts of a step */

/* Puts the anchor where the shear spring carries the force T: (P1 - P0).m = T/p_s. */
static void place_anchor(const bbm_model *m, bbm_contact *c, double T)
{
    const double s = bbm_way_along(m, c->corner, c->edge);

    c->anchor = (s + T / m->par.p_s) / m->edge[c->edge].along.length;
}

/* Whether a contact is of an unbroken joint with cohesion or tensile strength. */
static int is_strong(const bbm_contact *c)
{
    return c->strength.shear > 0 || c->strength.tension > 0;
}

/* The elements of a contact: i and j, and those that share P1, P2 or P3 with them. */
static void find_elements(const bbm_model *m, bbm_contact *c)
{
    const int P[3] = { m->edge[c->corner].a, m->edge[c->edge].b, m->edge[c->edge].a };

    c->element[0] = bbm_element_of(m, c->corner);
    c->element[1] = bbm_element_of(m, c->edge);
    c->parts = 2;
    for (int k = 0; k < 3; k++)
        if (bbm_partner_of(m, P[k]) != P[k])
            c->element[c->parts++] = m->vertex[bbm_partner_of(m, P[k])].element;
}

/* The state with which a contact begins the step: that of its last step. But one that touches when
 * the run begins is closed: what lies flush is so under load. In dynamics it is open where P can
 * come in over several lines of a corner, unless its joint has a strength: its way shows over which
 * one. One that P1 has left past the end of the edge is open. It can carry friction by the model's
 * angle, or what a hook says. The anchor is placed anew if the contact is open or its edge is
 * another one. */
static void begin_contact(const bbm_model *m, bbm_contact *c)
{
    int lines = 0;

    find_elements(m, c);
    c->time_left = 1;
    c->N_of_friction = c->N;
    c->closings = 0;
    for (int k = 0; k < 4; k++)
        lines += c->entrance[k] >= 0;
    if (c->has_left) {
        c->state = BBM_OPEN;
        c->N = c->T = c->slip = c->was_closed = c->inside = 0;
    }
    c->strength = (bbm_strength){ .tan_phi = bbm_tangent(m->par.friction) };
    if (m->hook->strength)
        m->hook->strength(m, c);
    if (c->touches && !c->has_left)
        c->state = lines == 0 || is_strong(c) || isinf(m->par.dt) ? BBM_LOCK : BBM_OPEN;
    if (!c->carried || c->state == BBM_OPEN) {
        place_anchor(m, c, c->T);
        c->rest = bbm_motion_of(m) ? fmin(0, c->d_n0 + c->N / m->par.p_n) : 0;
    }
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

/* Whether tension N has taken all shear strength from a strong joint. */
static int is_strengthless(const bbm_contact *c, double N)
{
    return is_strong(c) && bbm_shear_strength(&c->strength, N) == 0;
}

/* Friction of a sliding contact, Eq. (65), with N_of_friction for N, or what a hook says. While the
 * N are still changing one may be negative. Its friction is, too: each N then depends linearly on
 * the last. A strong joint may stay in tension, so it has its strength instead. */
static double find_friction(bbm_model *m, bbm_contact *c, const bbm_spring v[2])
{
    const double N = c->N_of_friction, strength = bbm_shear_strength(&c->strength, N);

    c->friction_in_K = m->hook->friction && !is_strengthless(c, N);
    return c->friction_in_K ? m->hook->friction(m, c, v)
         : c->sign * (is_strong(c) ? strength : N * c->strength.tan_phi);
}

/* The vectors of a contact for d_n, and for d_s from an anchor. */
void bbm_contact_vectors(const bbm_model *m, const bbm_contact *c, double anchor, bbm_spring v[2])
{
    const bbm_touch t = { &m->element[c->element[0]], &m->element[c->element[1]],
                          bbm_start_of(m, c->corner), bbm_end_of(m, c->edge),
                          bbm_start_of(m, c->edge) };

    if (c->parts == 2) {
        bbm_normal_vectors(&t, &v[0]);
        bbm_shear_vectors(&t, anchor, &v[1]);
    } else
        m->hook->vectors(m, c, anchor, v);
}

/* Adds the closed contacts to K and F: K_ij for each two elements, and each with itself. LOCK: the
 * normal and the shear spring, Eq. (58) and (63). SLIDE: the normal spring and friction, Eq. (65),
 * (69). Deviation: d_n counts from `rest`, which is 0 in the paper; see bbm_contact. */
void bbm_assemble_contacts(bbm_model *m)
{
    for (int k = 0; k < m->scratch->contacts; k++) {
        bbm_contact *c = &m->scratch->contact[k];
        const double p_s = c->state == BBM_LOCK ? c->time_left * m->par.p_s : 0;
        bbm_spring v[2];
        if (c->state == BBM_OPEN)
            continue;
        bbm_contact_vectors(m, c, c->anchor, v);
        v[0].d -= c->rest;
        const double T = c->state == BBM_LOCK ? p_s * v[1].d : find_friction(m, c, v);
        for (int a = 0; a < c->parts; a++) {
            double F[6] = { 0 };
            for (int b = a; b < c->parts; b++) {
                double K[6][6] = { { 0 } };
                bbm_spring_submatrix(m->par.p_n, v[0].v[a], v[0].v[b], K);
                bbm_spring_submatrix(p_s, v[1].v[a], v[1].v[b], K);
                bbm_matrix_add(m->K, c->element[a], c->element[b], K);
            }
            bbm_force_submatrix(m->par.p_n * v[0].d, v[0].v[a], F);
            bbm_force_submatrix(T, v[1].v[a], F);
            for (int x = 0; x < 6; x++)
                m->F[6 * c->element[a] + x] += F[x];
        }
    }
}

/* ------------------------------------------------------------- the open-close iteration: forces */

/* The length of a spring: d0 + e.D_i + g.D_j, Eq. (57), (61). row: which D each vector has. */
double bbm_length_of(const bbm_spring *v, int parts, const int row[], const double *D)
{
    const double *e = v->v[0], *g = v->v[1], *Di = &D[6 * row[0]], *Dj = &D[6 * row[1]];
    double length = v->d;

    for (int a = 0; a < 6; a++) {
        double sum = e[a] * Di[a] + g[a] * Dj[a];
        for (int k = 2; k < parts; k++)
            sum += v->v[k][a] * D[6 * row[k] + a];
        length += sum;
    }
    return length;
}

/* d_n and d_s, from an anchor, by these vectors. */
static void vector_distances(const bbm_model *m, const bbm_contact *c, double anchor, double d[2])
{
    bbm_spring v[2];

    bbm_contact_vectors(m, c, anchor, v);
    for (int k = 0; k < 2; k++)
        d[k] = bbm_length_of(&v[k], c->parts, c->element, m->D);
}

/* d_n, d_s, N and T of the solution. An open contact is measured where a hook's motion puts the
 * points. With an anchor at P3, -d_s is how far P1 lies from P3 along the edge; with one at P2, d_s
 * is how far it lies from P2. */
static void measure(const bbm_model *m, bbm_contact *c)
{
    const int open = c->state == BBM_OPEN, moved = open && bbm_motion_of(m);
    void (*distances)(const bbm_model *, const bbm_contact *, double, double [2]) =
        moved ? bbm_end_distances : vector_distances;
    double d[2];

    if (open) {
        distances(m, c, 1, d);
        c->past[1] = -d[1];
        c->anchor = 0;
        c->time_left = 1;
    }
    distances(m, c, c->anchor, d);
    c->past[0] = d[1];
    c->d_n = d[0];
    c->d_s = c->time_left * d[1];
    c->N = open ? 0 : -m->par.p_n * (c->d_n - c->rest);
    c->T = open ? 0 : m->par.p_s * c->d_s;
    if (c->friction_in_K && !is_strengthless(c, c->N))
        c->N_of_friction = c->N;
}

/* The force tolerance of each contact: a share of the largest force in its component of K. That is
 * the force on an element, inertia included, or in a contact. The solver's residual, and with it
 * the error of every N, is small against this force alone. What the spring makes of the rounding of
 * positions is added. */
static void find_tolerances(const bbm_model *m)
{
    const bbm_contact_scratch *w = m->scratch;

    memcpy(w->force, m->K->forces, (size_t)m->K->components * sizeof *w->force);
    for (int k = 0; k < w->contacts; k++) {
        double *most = &w->force[bbm_component_of(m->K, w->contact[k].element[0])];
        *most = fmax(*most, fabs(w->contact[k].N));
    }
    for (int k = 0; k < w->contacts; k++) {
        bbm_contact *c = &w->contact[k];
        const bbm_vertex *P2 = bbm_end_of(m, c->edge), *P3 = bbm_start_of(m, c->edge);
        const double force = w->force[bbm_component_of(m->K, c->element[0])];
        const double digits = m->par.p_n * (hypot(P2->x, P2->y) + hypot(P3->x, P3->y)) * DIGITS;
        c->force_tolerance = AGREE * force + fmin(digits, ROUGH * force);
    }
}

/* Takes the N of this solution for the friction of the next one. Returns whether an N is not the
 * one that its friction was taken for. */
static int renew_friction(const bbm_model *m)
{
    int renewed = 0;

    for (int k = 0; k < m->scratch->contacts; k++) {
        bbm_contact *c = &m->scratch->contact[k];
        renewed |= c->state == BBM_SLIDE && c->strength.tan_phi != 0
                && !(fabs(c->N - c->N_of_friction) <= c->force_tolerance);
        c->N_of_friction = c->N;
    }
    return renewed;
}

/* ------------------------------------------------------------- the open-close iteration: states */

/* Gives a contact its next state. When it closes, P1 hits at the fraction d0/(d0 - d_n) of the
 * step, d0 the distance at the start. Until the end of the step the anchor is where P1 stood at the
 * start. The slip from there lies between those from P3 and from P2, for (53) is linear in the
 * anchor. The shear spring feels the share of it after the hit: so it never drives the slip. The
 * contact starts as SLIDE if its shear spring would carry more than friction can hold, or if it
 * closes for the second time in the step: the shear spring had opened it. */
static void change_state(const bbm_model *m, bbm_contact *c)
{
    const double at = bbm_way_along(m, c->corner, c->edge) / m->edge[c->edge].along.length;
    const double d0 = fmax(0, c->d_n0);
    const int closes = c->state == BBM_OPEN;
    const double slip = closes ? (1 - at) * c->past[0] - at * c->past[1] : c->T;

    if (closes) {
        c->time_left = 1 - d0 / (d0 - c->d_n);
        c->anchor = at;
        const double T = c->time_left * m->par.p_s * fabs(slip);
        const double N = -m->par.p_n * (c->d_n - fmin(0, c->rest));
        const int slides = ++c->closings > 1 || T > bbm_shear_strength(&c->strength, N);
        c->next_state = slides ? BBM_SLIDE : BBM_LOCK;
    }
    if (c->next_state == BBM_SLIDE)
        c->sign = copysign(1, slip);
    c->state = c->next_state;
}

/* The state of a contact in the next pass. A blocked contact stays open. A locked one in tension
 * may have been pulled open by its shear spring. If that carries more than friction would hold
 * under as much pressure, the contact slides first, which removes the spring. */
static bbm_contact_state find_next_state(const bbm_model *m, const bbm_contact *c)
{
    const bbm_contact_state next = bbm_next_state(m->par.p_n, c, c->force_tolerance);
    const double strength = bbm_shear_strength(&c->strength, fabs(c->N));

    if (c->state == BBM_OPEN && next != BBM_OPEN && bbm_is_blocked(m, c))
        return BBM_OPEN;
    if (c->state == BBM_LOCK && next == BBM_OPEN && fabs(c->T) > strength && strength > 0)
        return BBM_SLIDE;
    return next;
}

/* The force by which a state fails to fit the solution. */
static double misfit(const bbm_model *m, const bbm_contact *c)
{
    if (c->state == BBM_OPEN)
        return m->par.p_n * (c->rest - c->d_n);
    if (c->next_state == BBM_OPEN && c->N < 0)
        return -c->N;
    return fabs(fabs(c->T) - bbm_shear_strength(&c->strength, c->N));
}

/* Whether P crosses more than one line of a corner, so that one of them counts. */
static int is_at_corner(const bbm_model *m, const bbm_contact *c)
{
    int crossed = 0;

    for (int k = 0; k < 4; k++)
        crossed |= c->entrance[k] >= 0 && m->scratch->contact[c->entrance[k]].d_n < 0;
    return crossed && c->state == BBM_OPEN;
}

/* Changes all states that do not fit the solution, or only the one that fits worst. A contact whose
 * P crosses several lines of a corner waits until all others fit, since they change the way of P.
 * The worst is the same in any order of the blocks, but for a tie. Returns the number of changes.
 */
static int change_states(bbm_model *m)
{
    bbm_contact_scratch *w = m->scratch;
    const int one = w->passes < w->one_until;
    bbm_contact *worst = NULL;
    int changes = 0, sure = 0;

    for (int k = 0; k < w->contacts; k++) {
        bbm_contact *c = &w->contact[k];
        c->next_state = find_next_state(m, c);
        if (c->next_state != c->state && (!worst || misfit(m, c) > misfit(m, worst)))
            worst = c;
        sure |= c->next_state != c->state && !is_at_corner(m, c);
    }
    for (int k = 0; k < w->contacts; k++) {
        bbm_contact *c = &w->contact[k];
        if (c->next_state == c->state || (one ? c != worst : sure && is_at_corner(m, c)))
            continue;
        change_state(m, c);
        changes++;
    }
    return changes;
}

/* Notes the states of this pass, and which way each contact slides, as one number, a hash (FNV-1a).
 * It takes no negative numbers, whose hashes collide. If an earlier pass had the same states, the
 * iteration cycles, unless that was the last pass: then only T of the step was new. */
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

    m->info.passes++;
    for (int k = 0; k < w->contacts; k++)
        measure(m, &w->contact[k]);
    bbm_note_depths(m);
    find_tolerances(m);
    if (renew_friction(m))
        return ++w->friction_passes <= FRICTION_PASSES ? BBM_PASS_AGAIN : BBM_PASS_GIVE_UP;
    w->friction_passes = 0;
    note_states(w);
    bbm_pass next = change_states(m) ? BBM_PASS_AGAIN : BBM_PASS_DONE;
    if (m->hook->renew)
        next = m->hook->renew(m, next);
    return next == BBM_PASS_AGAIN && ++w->passes > BBM_MAX_PASSES ? BBM_PASS_GIVE_UP : next;
}

/* ------------------------------------------------------------------------------ end of the step */

/* When the model has moved: the anchor of a sliding contact follows, so that a shear spring would
 * carry the friction force. It has slid by as much as the anchor moved. A joint that has opened, or
 * slid against a shear strength, is broken. */
static void store_contact(bbm_model *m, bbm_contact *c)
{
    const double strength = bbm_shear_strength(&c->strength, c->N);

    if (c->state == BBM_SLIDE) {
        c->T = c->sign * strength;
        c->slip += fabs(c->d_s - c->T / m->par.p_s);
    }
    if (c->state == BBM_SLIDE || c->time_left < 1)
        place_anchor(m, c, c->T);
    if (c->state == BBM_OPEN || (c->state == BBM_SLIDE && strength > 0))
        c->area = 0;
    c->inside = c->state == BBM_OPEN && c->d_n < 0 && (c->was_closed || c->inside);
    if (c->state != BBM_OPEN) {
        m->info.contacts++;
        m->info.penetration = fmax(m->info.penetration, -c->d_n);
    }
}

/* Ends the step: its contacts become those of the model, which has moved. */
void bbm_store_contacts(bbm_model *m)
{
    m->info.contacts = 0;
    m->info.penetration = 0;
    bbm_keep_contacts(m);
    for (int k = 0; k < m->contacts; k++)
        store_contact(m, &m->contact[k]);
}
