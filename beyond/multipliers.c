/* multipliers.c - bonds and fixed points that do not open.
 *
 * Beyond the paper. A penalty spring opens under the force that it carries. With a multiplier that
 * carries the force in its place it need not: solve, add to each multiplier the force of its
 * spring, f += W d, which goes to the right of K D = F in place of the spring's force, solve again
 * (the augmented Lagrangian of Hestenes, J. Optim. Theory Appl. 4, 1969, and Powell, in:
 * Optimization, 1969; the paper names it for contacts). K stays, and so does all that was made of
 * it.
 *
 * They go on from step to step of statics, also in those from rest (statics.c). In dynamics they
 * would be an integral controller, and in short steps unstable (doc/beyond.md): there bonds are
 * springs alone, and a larger alpha makes them stiffer.
 */
#include "beyond.h"

/* d [m] = d0 + Ti Di - Tj Dj of the solution, Eq. (22), (33). */
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

/* f of the last step in statics, also in its steps from rest; 0 in dynamics. */
void bbm_start_multipliers(bbm_model *m)
{
    for (int k = 0; k < 2 * m->gaps; k++)
        m->gap[k / 2].own.f[k % 2] = isinf(m->par.dt) ? m->gap[k / 2].own.f_before[k % 2] : 0;
    m->beyond->round = 0;
}

/* The contacts have settled: f += W d, in F, too, as often as was asked for. Returns which solution
 * follows. */
bbm_pass bbm_take_over(bbm_model *m)
{
    double d[2];

    if (!isinf(m->par.dt) || m->beyond->round++ >= m->beyond->multiplier_rounds)
        return BBM_PASS_DONE;
    m->scratch->passes = m->scratch->one_until = 0;
    for (bbm_gap *g = m->gap; g < m->gap + m->gaps; g++) {
        bbm_gap_length(m, g, d);
        for (int r = 0; r < 2 && !g->elastic; r++) {        /* at the wall Tj = 0 */
            const double df = g->W[r][0] * d[0] + g->W[r][1] * d[1];
            g->own.f[r] += df;
            bbm_force_submatrix(df, g->Ti[r], &m->F[6 * g->i]);
            bbm_force_submatrix(-df, g->Tj[r], &m->F[6 * (g->j < 0 ? g->i : g->j)]);
        }
    }
    return BBM_PASS_SAME_K;
}

/* At the end of a step. */
void bbm_store_multipliers(bbm_model *m)
{
    for (int k = 0; k < 2 * m->gaps; k++)
        m->gap[k / 2].own.f_before[k % 2] = m->gap[k / 2].own.f[k % 2];
}
