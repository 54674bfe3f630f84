/* contact.c - contacts between blocks: sections 3.7 and 3.8 of the paper, and what contacts add to
 * K and F.
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
 * joint, in the paper 0. A is the contact's share of the joint's area.
 *
 * d_s counts from the anchor P0, a point of the edge's material. P0 is where P1 stood at the start
 * of the step in which it hit. In LOCK it stays. In SLIDE it is moved at the end of each step, so
 * that p_s d_s is the friction force. In the next step only new slip raises s T above the bound.
 * When the slip turns round, s T falls below it, and the contact locks with the force that it had.
 *
 * base/detect.c finds which corners may touch which edges. base/open_close.c changes the states by
 * this table until all contacts fit the solution.
 */
#include "base/base.h"

/* --------------------------------------------------------------------- 3.7.1 Normal submatrices */

/* The normal distance of P1 from P2 P3, positive outside, d_n = S/l, Eq. (52). The points move by
 * T D, Eq. (48), (49), (50), and the terms of second order are dropped, Eq. (54), (55), (56):
 *     d_n = S0/l + e.D_i + g.D_j, Eq. (57), (59),
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

/* The normal law. N = -p_n d, positive in compression, Eq. (65), d the distance from `rest`; its
 * stiffness in K, -dN/dd; and what it stores, Pi_n of Eq. (51). Whoever changes it changes its
 * inverse, too: bbm_rest_of of base.h, and where crack.c sets `rest`. The table of states needs an
 * N that falls as d grows. */
double bbm_normal_force(const bbm_model *m, double d) { return -m->par.p_n * d; }

double bbm_normal_stiffness(const bbm_model *m) { return m->par.p_n; }

double bbm_normal_energy(const bbm_model *m, double N) { return N * N / (2 * m->par.p_n); }

/* A spring p, normal or shear, over d = d0 + e.D_i + g.D_j: Pi = p/2 d^2, Eq. (51)   ->
 * Eq. (58a-f), (63): K_ii += p e e^T, K_ij += p e g^T, K_jj += p g g^T. v and w: e or g. */
void bbm_spring_submatrix(double p, const double v[6], const double w[6], double K[6][6])
{
    for (int a = 0; a < 6; a++)
        for (int b = 0; b < 6; b++)
            K[a][b] += p * v[a] * w[b];
}

/* The force f of a contact at D = 0 is a load on both sides: F_i -= f e, F_j -= f g. A spring has
 * f = p d0, Eq. (58), (63). The friction force Fr of Eq. (65), positive when P1 slips towards P3,
 * has the e and g of the shear spring, Eq. (66), (67), (68), (69). */
void bbm_force_submatrix(double f, const double v[6], double F[6])
{
    for (int a = 0; a < 6; a++)
        F[a] -= f * v[a];
}

/* ---------------------------------------------------------------------- 3.7.2 Shear submatrices */

/* The displacement of P1 along the edge against the anchor P0 = P3 + anchor (P2 - P3), a point of
 * the edge's material, Eq. (53). The points move as in Eq. (48), (49), (50), and as there
 *     d_s = S1 + e.D_i + g.D_j, Eq. (60), (61), (62), (64), (67), (68),
 *     m = (P3 - P2)/l,   S1 = (P1 - P0).m,   e = T_i^T(P1) m,   g = -T_j^T(P0) m.
 * Deviation: with the T and the points of a hook g has what (61) drops, the turning of m, as well:
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

/* The length of a spring: d0 + e.D_i + g.D_j, Eq. (57), (61). row: which D each vector has. */
double bbm_length_of(const bbm_spring *v, int parts, const int row[], const double *D)
{
    double length = v->d;

    for (int a = 0; a < 6; a++) {
        double sum = 0;
        for (int k = 0; k < parts; k++)
            sum += v->v[k][a] * D[6 * row[k] + a];
        length += sum;
    }
    return length;
}

/* --------------------------------------------------------------------------------- 3.8 Friction */

double bbm_tangent(double degrees) { return tan(degrees * acos(-1) / 180); }

/* Mohr and Coulomb: the largest shear force under the normal force N, N tan(phi), Eq. (65), and the
 * cohesion of an unbroken joint. Tension, N < 0, takes away from it, down to 0. */
double bbm_shear_strength(const bbm_strength *s, double N)
{
    return fmax(0, N * s->tan_phi + s->shear);
}

/* The shear force of a contact: what its spring carries, or friction while it slides, Eq. (65). */
double bbm_shear_force(const bbm_contact *c)
{
    return c->state == BBM_SLIDE ? c->sign * bbm_shear_strength(&c->strength, c->N) : c->T;
}

/* The figure on top as a table: the state that follows from N and T. N of an open contact is what
 * it would be if it were closed. Forces that differ by less than the tolerance agree. A closed
 * contact opens without a tolerance: it would be a hidden tensile strength. Without friction and
 * cohesion what is closed slides. How one closes, and a locked one in tension: close_contact and
 * find_next_state in base/open_close.c. */
bbm_contact_state bbm_next_state(const bbm_contact *c, double N, double tolerance)
{
    const double strength = bbm_shear_strength(&c->strength, N);

    if (c->state == BBM_OPEN)
        return N > tolerance ? BBM_LOCK : BBM_OPEN;
    if (N < -c->strength.tension)
        return BBM_OPEN;
    if (c->strength.tan_phi == 0 && c->strength.shear == 0)
        return BBM_SLIDE;
    if (c->state == BBM_LOCK)
        return fabs(c->T) > strength + tolerance ? BBM_SLIDE : BBM_LOCK;
    return c->sign * c->T < strength - tolerance ? BBM_LOCK : BBM_SLIDE;
}

/* ----------------------------------------------------------------- what contacts add to K and F */

/* Whether tension N has taken all shear strength from a strong joint. */
int bbm_is_strengthless(const bbm_contact *c, double N)
{
    return bbm_is_strong(c) && bbm_shear_strength(&c->strength, N) == 0;
}

/* Friction of a sliding contact, Eq. (65), with N_of_friction for N, or what a hook says. While N
 * still changes it may be negative. Friction is negative then, too, which keeps the iteration
 * linear. A strong joint may stay in tension and takes its strength instead. */
static double find_friction(bbm_model *m, bbm_contact *c, const bbm_spring v[2])
{
    const double N = c->trial.N_of_friction, strength = bbm_shear_strength(&c->strength, N);

    c->trial.friction_in_K = m->hook->friction && !bbm_is_strengthless(c, N);
    return c->trial.friction_in_K ? m->hook->friction(m, c, v)
         : c->sign * (bbm_is_strong(c) ? strength : N * c->strength.tan_phi);
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
 * normal and the shear spring, Eq. (58) and (63), this one times `time_left`, in the paper 1.
 * SLIDE: the normal spring and friction, Eq. (65), (69). Deviation: d_n counts from `rest`, which
 * is 0 in the paper; see bbm_contact. */
void bbm_assemble_contacts(bbm_model *m)
{
    for (bbm_contact *c = m->scratch->contact; c < bbm_end_of_contacts(m); c++) {
        const double p_s = c->state == BBM_LOCK ? c->trial.time_left * m->par.p_s : 0;
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
                bbm_spring_submatrix(bbm_normal_stiffness(m), v[0].v[a], v[0].v[b], K);
                bbm_spring_submatrix(p_s, v[1].v[a], v[1].v[b], K);
                bbm_matrix_add(m->K, c->element[a], c->element[b], K);
            }
            bbm_force_submatrix(-bbm_normal_force(m, v[0].d), v[0].v[a], F);
            bbm_force_submatrix(T, v[1].v[a], F);
            for (int x = 0; x < 6; x++)
                m->F[6 * c->element[a] + x] += F[x];
        }
    }
}
