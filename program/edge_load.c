/* edge_load.c - the loads of edges that pictures show, and whether there are cracks. `make paper`
 * has paper.c in its place. */
#include "../beyond/beyond.h"
#include "scene.h"

int scene_edge_load(const bbm_model *m, int k, scene_line *l)
{
    if (!m->beyond || k >= m->beyond->edge_loads)
        return 0;
    const bbm_edge_load *e = &m->beyond->edge_load[k];
    const double *g = m->par.gravity;
    *l = (scene_line){ .a = e->a, .b = bbm_next_vertex(&m->element[m->vertex[e->a].element], e->a),
                       .loads = 1, .q = &e->f, .pressure = e->pressure,
                       .level = e->level + m->origin[1], .weight = e->density * hypot(g[0], g[1]) };
    return 1;
}

int scene_is_cracked(const bbm_model *m) { return m->beyond && m->beyond->broken > 0; }
