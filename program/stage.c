/* stage.c - stages: what a run changes on its way.
 *
 * The statements of all stages are carried out when the file is read, on the finished model, so
 * that what is wrong in them is said before anything runs. What holds then, gravity, strengths,
 * loads and held nodes, is kept for each stage, and the model is given back what it begins with.
 * When the run comes to a stage it takes over what was kept.
 *
 * The library knows no removal. A block that is removed is held far away, as it was before the run:
 * without stress, velocity, loads and gravity. Nothing touches it there, and D of its elements is
 * 0.
 */
#include <stdlib.h>
#include <string.h>

#include "field.h"
#include "reader.h"

#define FAR 1e4                 /* sizes of the model from a removed block to the next one */

/* -------------------------------------------------------------------------------------- reading */

/* A monitor of a block that is removed would show nothing. */
static int check_monitors(model_reader *r, int block)
{
    const model *p = r->p;

    for (const model_monitor *m = p->monitor; m < p->monitor + p->monitors; m++)
        for (int n = 0; n < m->nodes; n++)
            if (p->node_block[m->node[n]] == block)
                return model_blame(r, "monitor '%.60s' is on block '%.60s', expected none on a "
                                   "block that is removed", m->name, p->block[block]);
    return 1;
}

int model_stage_head(model_reader *r)
{
    model *p = r->p;
    model_stage *s = &p->stage[r->s->stage];

    if (!(s->name = model_name(r)))
        return 0;
    for (const model_stage *other = p->stage + 1; other < s; other++)
        if (strcmp(other->name, s->name) == 0)
            return model_blame(r, "stage '%.60s' for the second time, expected a new one", s->name);
    if (model_skip(r, "steps") && !model_whole(r, "steps", 1, &s->steps))
        return 0;
    if (!model_skip(r, "remove"))
        return model_at_end(r);
    do {
        const int block = model_next_block(r);
        if (block < 0 || !check_monitors(r, block))
            return 0;
        if (p->gone[block])
            return model_blame(r, "block '%.60s' is removed for the second time, expected once",
                               p->block[block]);
        p->gone[block] = r->s->stage;
    } while (model_look(r));
    return 1;
}

static void *copy(model_reader *r, const void *from, int count, size_t size)
{
    void *to = model_room(r, count, size);

    if (to && count > 0)
        memcpy(to, from, (size_t)count * size);
    return to;
}

int model_keep_stage(model_reader *r, int k)
{
    const model *p = r->p;
    const bbm_parameters *par = &p->m->par;
    const bbm_beyond *b = p->m->beyond;
    model_stage *s = &p->stage[k];

    memcpy(s->gravity, par->gravity, sizeof s->gravity);
    s->friction = par->friction, s->cohesion = b->cohesion, s->tension = b->tension;
    s->joints = b->joints, s->edge_loads = b->edge_loads;
    s->node = copy(r, p->m->node, p->m->nodes, sizeof *s->node);
    s->moved_to = copy(r, p->moved_to, p->m->nodes, sizeof *s->moved_to);
    s->joint = copy(r, b->joint, b->joints, sizeof *s->joint);
    s->edge_load = copy(r, b->edge_load, b->edge_loads, sizeof *s->edge_load);
    return !p->status;
}

/* The lists of the model have room for the longest, which they had when the last stage was read. */
void model_use_stage(model *p, int k)
{
    const model_stage *s = &p->stage[k];
    bbm_parameters *par = &p->m->par;
    bbm_beyond *b = p->m->beyond;

    memcpy(par->gravity, s->gravity, sizeof s->gravity);
    par->friction = s->friction, b->cohesion = s->cohesion, b->tension = s->tension;
    b->joints = s->joints, b->edge_loads = 0;
    for (int n = 0; n < p->m->nodes; n++) {
        p->m->node[n].held = s->node[n].held;
        memcpy(p->m->node[n].load, s->node[n].load, sizeof s->node[n].load);
        memcpy(p->moved_to[n], s->moved_to[n], sizeof s->moved_to[n]);
    }
    for (int j = 0; j < s->joints; j++)
        b->joint[j] = s->joint[j];
    for (int l = 0; l < s->edge_loads; l++)
        if (!field_is_gone(p->m, s->edge_load[l].a))
            b->edge_load[b->edge_loads++] = s->edge_load[l];
}

/* ------------------------------------------------------------------------------- a stage begins */

/* Node n of a block that is gone: held where its element lies, unloaded. */
static void forget_node(model *p, int n)
{
    const bbm_model *m = p->m;
    bbm_node *a = &m->node[n];

    *a = (bbm_node){ .x = a->x, .y = a->y, .held = BBM_XY,
                     .wall = { m->vertex[m->adjacent[m->adjacent_first[n]]].u } };
    m->beyond->support[n] = (bbm_support){ .force = { 0 } };
    memset(p->moved_to[n], 0, sizeof p->moved_to[n]);
}

/* In place of the library's hook: no load on what is gone. */
void model_gather_loads(bbm_model *m)
{
    bbm_gather_edge_loads(m);
    for (int i = 0; i < m->elements; i++)
        if (field_is_gone(m, m->element[i].first))
            memset(&m->load[6 * i], 0, 6 * sizeof *m->load);
}

/* Element i, by so many m to the right of where it was at the start. */
static void carry_away(bbm_model *m, int i, double far)
{
    bbm_element *e = &m->element[i];

    e->out_of_plane = FIELD_GONE;
    memset(e->V, 0, sizeof e->V);
    memset(e->stress, 0, sizeof e->stress);
    memset(e->sum, 0, sizeof e->sum);
    memset(e->D, 0, sizeof e->D);
    for (bbm_vertex *v = &m->vertex[e->first]; v < &m->vertex[e->first + e->n]; v++) {
        v->u = far, v->v = 0;
        v->x = m->node[v->node].x - m->origin[0] + far;
        v->y = m->node[v->node].y - m->origin[1];
    }
    bbm_element_geometry(e, &m->vertex[e->first]);
}

/* The blocks that the stage in hand removes, with their bolts. */
static void remove_blocks(model *p)
{
    const bbm_model *m = p->m;
    double low[2] = { INFINITY, INFINITY }, high[2] = { -INFINITY, -INFINITY };

    for (int n = 0; n < m->nodes; n++) {
        low[0] = fmin(low[0], m->node[n].x), high[0] = fmax(high[0], m->node[n].x);
        low[1] = fmin(low[1], m->node[n].y), high[1] = fmax(high[1], m->node[n].y);
    }
    for (int i = 0; i < m->elements; i++)
        if (p->gone[m->element[i].block] == p->now)
            carry_away(p->m, i, FAR * hypot(high[0] - low[0], high[1] - low[1])
                                    * (m->element[i].block + 1));
    for (scene_bolt *b = p->bolt; b < p->bolt + p->bolts; b++)
        for (int end = 0; end < 2; end++)
            if (p->gone[b->block[end]] == p->now && b->until == INFINITY)
                b->k = 0, b->until = m->info.t;
}

/* Lists the gaps anew: each keeps the multiplier of the same one before, in the same order; new
 * ones, and those of what is gone, have none. */
static bbm_status renew_gaps(bbm_model *m)
{
    const int olds = m->gaps;
    bbm_gap *old = malloc(((size_t)olds + 1) * sizeof *old);

    if (!old)
        return BBM_NO_MEMORY;
    for (int k = 0; k < olds; k++) {
        old[k] = m->gap[k];
        m->gap[k].own = (bbm_weight){ 0 };
    }
    bbm_list_gaps(m);
    for (int k = 0, from = 0; k < m->gaps; k++) {
        bbm_gap *g = &m->gap[k];
        int o = from;
        while (o < olds && (old[o].i != g->i || old[o].j != g->j || old[o].node[0] != g->node[0]
                            || old[o].node[1] != g->node[1]))
            o++;
        if (o == olds || field_is_gone(m, m->element[g->i].first))
            continue;
        memcpy(g->own.f, old[o].own.f, sizeof g->own.f);
        memcpy(g->own.f_before, old[o].own.f_before, sizeof g->own.f_before);
        from = o + 1;
    }
    free(old);
    return BBM_OK;
}

/* Contacts of what is gone go, and so does the energy of its springs. */
static void renew_contacts(bbm_model *m)
{
    bbm_contact_scratch *w = m->scratch;
    bbm_contact *list = w->contact;
    const int listed = w->contacts;
    int kept = 0;

    for (int k = 0; k < m->contacts; k++)
        if (!field_is_gone(m, m->edge[m->contact[k].corner].a)
            && !field_is_gone(m, m->edge[m->contact[k].edge].a))
            m->contact[kept++] = m->contact[k];
    m->contacts = w->contacts = kept;
    w->contact = m->contact;
    bbm_note_springs(m, 0);
    w->contact = list;
    w->contacts = listed;
    m->links = -1;                              /* of no K: the next one is laid out anew */
}

/* A node that was free is held where it is. */
bbm_status model_next_stage(model *p)
{
    bbm_model *m = p->m;
    const model_stage *s = &p->stage[++p->now];

    for (int n = 0; n < m->nodes; n++) {
        bbm_result at;
        bbm_nodal_result(m, n, -1, &at);
        for (int a = 0; a < 2; a++)
            if (s->node[n].held & ~m->node[n].held & 1 << a)
                m->node[n].wall[a] = a ? at.v : at.u;
    }
    remove_blocks(p);
    model_use_stage(p, p->now);
    for (int n = 0; n < m->nodes; n++) {
        if (p->gone[p->node_block[n]] && p->gone[p->node_block[n]] <= p->now)
            forget_node(p, n);
        memcpy(p->moved_from[n], m->node[n].wall, sizeof p->moved_from[n]);
    }
    p->begun = m->info.step;
    p->moving = 1;
    const bbm_status status = renew_gaps(m);
    renew_contacts(m);
    return status;
}
