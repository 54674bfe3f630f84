/* supports.c - forces of supports, and supports that move.
 *
 * Beyond the paper. A fixed point is held to a wall point by a stiff spring and its multiplier:
 * what these carry at the end of the step is the force of the support, the reaction. In
 * equilibrium the reactions balance the loads.
 *
 * A wall point may be displaced between the steps. The support then does work: its force at the
 * end of the step times its way, as for the loads. (Newmark with beta = 1/2, gamma = 1 takes the
 * forces at the end, see energy.c.)
 */
#include <stdlib.h>
#include <string.h>

#include "beyond.h"

/* Room for all nodes of a prepared model. */
bbm_status bbm_lay_out_supports(bbm_model *m)
{
    free(m->beyond->support);
    m->beyond->support = calloc((size_t)m->nodes, sizeof *m->beyond->support);
    return m->beyond->support ? BBM_OK : BBM_NO_MEMORY;
}

/* Displaces the wall point of a node that is held. */
void bbm_move_support(bbm_model *m, int node, double u, double v)
{
    const double to[2] = { u, v };

    for (int a = 0; a < 2; a++) {
        m->beyond->support[node].moved[a] += to[a] - m->node[node].wall[a];
        m->node[node].wall[a] = to[a];
    }
}

/* The forces of the supports on their nodes, of the solution. The gap of an edge is the mean of
 * those of its ends, (d1 + d2)/2, or how they differ, (d1 - d2)/2; of a point both ends are one. */
void bbm_find_reactions(bbm_model *m)
{
    for (int n = 0; n < m->nodes; n++)
        memset(m->beyond->support[n].force, 0, sizeof m->beyond->support[n].force);
    for (int k = 0; k < m->gaps; k++) {
        bbm_gap *g = &m->gap[k];
        double d[2];
        if (g->j >= 0)
            continue;
        bbm_gap_length(m, g, d);
        for (int a = 0; a < 2; a++) {
            const double half = (g->own.f[a] + g->own.W[a][0] * d[0] + g->own.W[a][1] * d[1]) / 2;
            m->beyond->support[g->node[0]].force[a] -= half;
            m->beyond->support[g->node[1]].force[a] -= g->own.penalty ? half : -half;
        }
    }
}

/* The step is done: the supports stand. */
void bbm_stop_supports(bbm_model *m)
{
    for (int n = 0; n < m->nodes; n++)
        memset(m->beyond->support[n].moved, 0, sizeof m->beyond->support[n].moved);
}
