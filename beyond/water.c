/* water.c - the pressure of still water on boundary edges.
 *
 * Beyond the paper, whose line loads keep their direction. Below its level y = Y water presses with
 * p = w (Y - y) against the outward normal, w [N/m^3] its weight; above with nothing. Each step takes
 * the edges as they lie at its start.
 *
 * Along a straight edge displacements are linear in the way s, 0 at a and 1 at b, so that the force
 * int p ds and the moment int p s ds are all that an element feels of p. An edge that the level
 * crosses gets the p linear in s that has the same two.
 */
#include <math.h>
#include <stdlib.h>

#include "beyond.h"

/* p = c[0] + c[1] s for the depths (negative: above the level) at both ends.
 *     int p ds = c0 + c1/2,  int p s ds = c0/2 + c1/3 */
static void press(double depth_a, double depth_b, double c[2])
{
    const double most = fmax(depth_a, depth_b), least = fmin(depth_a, depth_b);

    c[0] = depth_a;
    c[1] = depth_b - depth_a;
    if (least >= 0)
        return;
    const double wet = most > 0 ? most / (most - least) : 0;    /* share of the edge */
    const double force = fmax(most, 0) * wet / 2;
    const double s = depth_a > depth_b ? wet / 3 : 1 - wet / 3; /* where that acts */
    c[1] = 12 * force * s - 6 * force;
    c[0] = force - c[1] / 2;
}

/* A step begins: the loads of the edges under water. */
void bbm_press_water(bbm_model *m)
{
    for (int k = 0; k < m->beyond->waters; k++) {
        const bbm_water *w = &m->beyond->water[k];
        bbm_line_load *l = &m->line_load[w->load];
        const bbm_vertex *a = &m->vertex[l->a], *b = &m->vertex[l->b];
        const double length = hypot(b->x - a->x, b->y - a->y);
        double c[2];
        press(w->level - a->y, w->level - b->y, c);
        for (int g = 0; g < BBM_GAUSS; g++) {
            double s, share;
            bbm_gauss_point(g, &s, &share);
            const double p = w->weight * (c[0] + c[1] * s) / length;
            l->f[g][0] = -p * (b->y - a->y);
            l->f[g][1] = p * (b->x - a->x);
        }
    }
}

/* Water up to the level [m] on a boundary edge of the prepared model; its weight [N/m^2] is that of
 * a m^3 times the thickness. */
bbm_status bbm_add_water(bbm_model *m, int edge, double level, double weight)
{
    bbm_beyond *b = m->beyond;
    const bbm_status status = bbm_load_edge(m, edge, 0, 0, level * weight);
    bbm_water *more = status ? NULL : realloc(b->water, ((size_t)b->waters + 1) * sizeof *more);

    if (!more)
        return status ? status : BBM_NO_MEMORY;
    m->line_load[m->line_loads - 1].constant = 0;
    b->water = more;
    b->water[b->waters++] = (bbm_water){ m->line_loads - 1, level, weight };
    return BBM_OK;
}
