/* pressure.c - loads on one boundary edge: a traction, and a pressure that turns with the edge.
 *
 * Beyond the paper, whose loads along a line, Eq. (38)-(43), lie between two grid points and keep
 * their direction. Where blocks share grid points, or an edge is known by its number alone, the
 * load belongs to one of the edges between them. The block lies on the left of an edge from a to b,
 * and a pressure p pushes that way, p (-(b - a)_y, (b - a)_x)/|b - a|, with the edge in the middle
 * of the step: its work is then p times the area that the edge sweeps.
 */
#include <math.h>
#include <stdlib.h>

#include "beyond.h"

/* Adds a load [N/m] on a boundary edge of the prepared model. */
bbm_status bbm_load_edge(bbm_model *m, int edge, double fx, double fy, double pressure)
{
    bbm_beyond *b = m->beyond;

    if (m->status)
        return m->status;
    if (!m->K || edge < 0 || edge >= m->edges)
        return m->status = bbm_fail(m, BBM_BAD_INDEX, "loaded edge %d of %d", edge, m->edges);
    if (!isfinite(fx) || !isfinite(fy) || !isfinite(pressure))
        return m->status = bbm_fail(m, BBM_NOT_FINITE, "the load of edge %d", edge);
    bbm_edge_load *larger = realloc(b->edge_load, ((size_t)b->edge_loads + 1) * sizeof *larger);
    if (!larger)
        return m->status = bbm_fail(m, BBM_NO_MEMORY, "%d loaded edges", b->edge_loads);
    b->edge_load = larger;
    larger[b->edge_loads++] = (bbm_edge_load){ m->edge[edge].a, { fx, fy }, pressure };
    return BBM_OK;
}

/* Adds them to the loads of the step, Eq. (43). */
void bbm_gather_edge_loads(bbm_model *m)
{
    for (int l = 0; l < m->beyond->edge_loads; l++) {
        const bbm_edge_load *load = &m->beyond->edge_load[l];
        const bbm_vertex *a = &m->vertex[load->a];
        const bbm_element *e = &m->element[a->element];
        const bbm_vertex *b = &m->vertex[bbm_next_vertex(e, load->a)];
        const double p = load->pressure / hypot(b->x - a->x, b->y - a->y);
        double T[2][6], am[2], bm[2];
        bbm_step_matrix(e, a->x, a->y, T, am);
        bbm_step_matrix(e, b->x, b->y, T, bm);
        const double f[2] = { load->f[0] - p * (bm[1] - am[1]), load->f[1] + p * (bm[0] - am[0]) };
        bbm_constant_load_submatrix(e, a, b, f, &m->load[6 * a->element]);
    }
}
