/* stability.c - whether a static answer is stable.
 *
 * K of a static step knows how elements, bonds and contacts resist. It does not know that forces
 * get other arms when the model moves: a straight column is in equilibrium under any load. Let the
 * forces f act on an element at the points X from its barycentre. If it turns by r and they keep
 * their directions, their moment changes by -r sum f.X. In equilibrium this sum is t A (sx + sy),
 * whatever the forces are. So the stress has a stiffness of its own against turning,
 *
 *     K_ii[r0][r0] += t A (sx + sy),
 *
 * negative in compression. With it a column buckles at Euler's load, and a block tips over a corner
 * as its weight does at the height of its centre. Left out is what is as small as stress/E, and
 * that the normal of a contact turns with its edge. The answer is stable if K is positive definite
 * with this stiffness: conjugate gradients come upon a direction in which it is not.
 */
#include <string.h>

#include "beyond.h"

/* NUDGED [-]  tolerance of the solution that looks for such a direction */
#define NUDGED 1e-3

/* Lists the contacts of the model as it stands, closed as they are, and assembles K. What slides
 * holds again: it is at rest. */
static bbm_status assemble(bbm_model *m)
{
    const bbm_status status = bbm_begin_statics(m);

    if (status)
        return status;
    for (int k = 0; k < m->scratch->contacts; k++)
        if (m->scratch->contact[k].state == BBM_SLIDE)
            m->scratch->contact[k].state = BBM_LOCK;
    bbm_assemble(m);
    m->hook->before_solution(m);
    return BBM_OK;
}

/* Adds to K the stiffness of the stress, what is positive of it or what is negative. */
static void add_stress(bbm_model *m, double sign)
{
    for (int i = 0; i < m->elements; i++) {
        const bbm_element *e = &m->element[i];
        const double tension = e->material.thickness * e->A * (e->stress[0] + e->stress[1]);
        m->K->D[m->K->place[i]][2][2] += sign * fmax(0, sign * tension);
    }
}

/* Whether the static answer that the model has come to is stable. The model stays as it is, but for
 * D, F and K. Every element is pushed and turned a little, each by another amount, so that no mode
 * is missed. A solution for F = 0 makes the preconditioner, from K with the tension alone, which
 * has to be positive definite itself: what hangs on a pin resists by its tension. */
bbm_status bbm_find_stability(bbm_model *m, int *stable)
{
    bbm_pcg pcg = m->par.pcg;
    bbm_pcg_info info;
    bbm_status status = assemble(m);

    memset(m->F, 0, 6 * (size_t)m->elements * sizeof *m->F);
    if (!status) {
        add_stress(m, 1);
        status = bbm_solve(m->K, m->F, m->D, &pcg, &info);
    }
    if (!status) {
        add_stress(m, -1);
        for (int k = 0; k < 3 * m->elements; k++) {
            const int i = k / 3, a = k % 3;
            const double A = m->element[i].A;
            m->F[6 * i + a] = A * (a < 2 ? 1 : sqrt(A)) * (1 + (37 * i + 11 * a) % 19);
        }
        pcg.tolerance = NUDGED;
        status = bbm_solve(m->K, m->F, m->D, &pcg, &info);
    }
    m->K->ready = 0;
    *stable = status != BBM_NOT_POSITIVE_DEFINITE;
    return *stable ? status : BBM_OK;
}
