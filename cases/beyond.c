/* beyond.c - the programs' models: with all of beyond/. `make paper` has paper.c in its place. */
#include "../beyond/beyond.h"
#include "case.h"

bbm_model *case_model(void)
{
    bbm_model *m;

    case_must(NULL, bbm_beyond_new(&m));
    return m;
}

bbm_model *case_paper_model(void)
{
    bbm_model *m = case_model();

    m->beyond->bonding = BBM_VERTICES;
    m->par.pcg.method = NULL;
    return m;
}

int scene_edge_load(const bbm_model *m, int k, scene_line *l)
{
    if (!m->beyond || k >= m->beyond->edge_loads)
        return 0;
    const bbm_edge_load *e = &m->beyond->edge_load[k];
    *l = (scene_line){ .a = e->a, .b = bbm_next_vertex(&m->element[m->vertex[e->a].element], e->a),
                       .loads = 1, .q = &e->f, .pressure = e->pressure };
    if (e->weight > 0)
        l->loads = BBM_GAUSS, l->q = e->q;
    return 1;
}
