/* multipliers.c - bonds and fixed points that do not open.
 *
 * Beyond the paper. A penalty spring opens under the force that it carries. With a multiplier that
 * carries the force in its place it need not: solve, add to each multiplier the force of its
 * spring, f += W d, which goes to the right of K D = F in place of the spring's force, solve again
 * (the augmented Lagrangian of Hestenes, J. Optim. Theory Appl. 4, 1969, and Powell, in:
 * Optimization, 1969; the paper names it for contacts). K stays, and so does all that was made of
 * it.
 *
 * In statics multipliers go on from step to step. In dynamics each step starts them from zero:
 * kept, they would be an integral controller, and in short steps unstable (doc/beyond.md).
 */
#include "beyond.h"

/* d = d0 + Ti Di - Tj Dj of the solution, Eq. (18), (30). */
void bbm_gap_length(const bbm_model *m, const bbm_gap *g, double d[2])
{
    for (int r = 0; r < 2; r++) {
        double ui = 0, uj = 0;
        for (int a = 0; a < 6; a++) {
            ui += g->Ti[r][a] * m->D[6 * g->i + a];
            uj += g->j < 0 ? 0 : g->Tj[r][a] * m->D[6 * g->j + a];
        }
        d[r] = g->d0[r] + ui - uj;
    }
}

/* Begins a round of a dynamic step with the states in which contacts settled in that round of the
 * last step; the passes judge them. Bonds are softer before multipliers take over, so that other
 * contacts slide or are closed in each round, and in each step the same. Returns whether a state is
 * new. */
static int recall_states(bbm_model *m, int round)
{
    bbm_contact_scratch *w = m->scratch;
    int changed = 0;

    w->round = round;
    w->passes = w->one_until = 0;
    for (bbm_contact *c = w->contact; c < w->contact + w->contacts; c++) {
        const bbm_settled *s = &c->settled[round < 2 ? round : 2];
        if ((s->state == c->state && s->sign == c->sign) || s->time_left == 0
            || bbm_is_static(m) || c->has_left || (c->beyond_end && !c->was_closed))
            continue;
        if (c->state == BBM_OPEN) {
            c->anchor = bbm_way_along(m, c->corner, c->edge) / m->edge[c->edge].along.length;
            c->time_left = s->time_left;
        }
        c->state = s->state;
        c->sign = s->sign;
        changed = 1;
    }
    return changed;
}

void bbm_start_multipliers(bbm_model *m)
{
    for (int k = 0; k < m->gaps; k++)
        for (int r = 0; r < 2; r++)
            m->gap[k].own.f[r] = bbm_is_static(m) ? m->gap[k].own.f_before[r] : 0;
    recall_states(m, 0);
}

/* The contacts have settled: f += W d, in F, too, as often as was asked for. Returns which solution
 * follows. In dynamics it takes a bond, or a fixed point of an element that is not held at all its
 * vertices: one that is, a base, has springs as stiff as the contacts on it. */
bbm_pass bbm_take_over(bbm_model *m)
{
    int needed = bbm_is_static(m);
    double d[2];

    for (int g = 0; g < m->gaps && !needed; g++)
        needed = m->gap[g].j >= 0 || !bbm_is_held_all_round(m, &m->element[m->gap[g].i]);
    if (m->scratch->round >= m->beyond->multiplier_rounds || !needed)
        return BBM_PASS_DONE;
    for (int k = 0; k < m->gaps; k++) {
        bbm_gap *g = &m->gap[k];
        bbm_gap_length(m, g, d);
        for (int r = 0; r < 2 && !g->elastic; r++) {
            const double df = g->W[r][0] * d[0] + g->W[r][1] * d[1];
            g->own.f[r] += df;
            for (int a = 0; a < 6; a++) {
                m->F[6 * g->i + a] -= df * g->Ti[r][a];
                m->F[6 * (g->j < 0 ? g->i : g->j) + a] += df * g->Tj[r][a];     /* wall: T = 0 */
            }
        }
    }
    return recall_states(m, m->scratch->round + 1) ? BBM_PASS_AGAIN : BBM_PASS_SAME_K;
}

/* At the end of a step. */
void bbm_store_multipliers(bbm_model *m)
{
    for (int k = 0; k < m->gaps; k++)
        for (int r = 0; r < 2; r++)
            m->gap[k].own.f_before[r] = m->gap[k].own.f[r];
}
