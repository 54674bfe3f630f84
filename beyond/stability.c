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
 * as its weight does at the height of its centre. Pressure and water turn with their edge, which is
 * a stiffness of its own, see surroundings.c. Left out is what is as small as stress/E, and that
 * the normal of a contact turns with its edge. The answer is stable if K is positive definite with
 * all this: conjugate gradients come upon a direction in which it is not.
 *
 * What tension has of it is in the K of every static step, but for sum f.X of what presses. Without
 * it a taut string turns too far in one step and back by more in the next.
 */
#include "beyond.h"

/* NUDGED [-]  tolerance of the solution that looks for such a direction: one that is soft beside
 *             others, as of pinned bars on weak bolts, is come upon late */
#define NUDGED 1e-8

/* The stiffness of the stress of an element against turning, N m. */
static double turning_stiffness(const bbm_element *e)
{
    return e->material.thickness * e->A * (e->stress[0] + e->stress[1]);
}

/* What is in K of it: tension, in statics. */
double bbm_tension_stiffness(const bbm_model *m, int i)
{
    const double turning = turning_stiffness(&m->element[i]) - m->beyond->account[i].pressed;

    return bbm_is_static(m) ? fmax(0, turning) : 0;
}

/* Whether the static answer that the model has come to is stable. The model stays as it is, but for
 * D, F and K. The contacts are listed as it stands, closed as they are; what slides holds again: it
 * is at rest. Every element is pushed and turned a little, each by another amount, so that no mode
 * is missed. A solution for F = 0 makes the preconditioner, from K with the tension alone, which
 * has to be positive definite itself: what hangs on a pin resists by its tension. */
bbm_status bbm_find_stability(bbm_model *m, int *stable)
{
    bbm_pcg pcg = m->par.pcg;
    bbm_status status = bbm_begin_statics(m);

    for (int k = 0; k < m->scratch->contacts && !status; k++)
        if (m->scratch->contact[k].state == BBM_SLIDE)
            m->scratch->contact[k].state = BBM_LOCK;
    if (!status) {
        bbm_assemble(m);
        memset(m->F, 0, 6 * (size_t)m->elements * sizeof *m->F);
        status = bbm_solve(m->K, m->F, m->D, &pcg, &(bbm_pcg_info){ 0 });
    }
    for (int l = 0; l < m->beyond->edge_loads && !status; l++) {
        bbm_edge_load *load = &m->beyond->edge_load[l];
        const int i = m->vertex[load->a].element;
        bbm_matrix_add(m->K, i, i, load->turns);
    }
    for (int i = 0; i < m->elements && !status; i++) {
        const double A = m->element[i].A;
        for (int a = 0; a < 3; a++)
            m->F[6 * i + a] = A * (a < 2 ? 1 : sqrt(A)) * (1 + (37 * i + 11 * a) % 19);
        m->K->D[m->K->place[i]][2][2] += turning_stiffness(&m->element[i])
                                       - bbm_tension_stiffness(m, i);
    }
    pcg.tolerance = NUDGED;
    if (!status)
        status = bbm_solve(m->K, m->F, m->D, &pcg, &(bbm_pcg_info){ 0 });
    m->K->ready = 0;
    *stable = status != BBM_NOT_POSITIVE_DEFINITE;
    return *stable ? status : BBM_OK;
}
