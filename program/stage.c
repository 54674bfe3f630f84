/* stage.c - stages: what a run changes on its way.
 *
 * The statements of all stages are carried out when the file is read, so that what is wrong in them
 * is said before anything runs. What then holds is kept for each stage, and taken over when the run
 * comes to it; the run before them is stage 0.
 *
 * The library knows no removal. A block that is removed is held far away, as it was before the run:
 * without stress, velocity, loads and gravity. Nothing touches it there, and D of its elements is
 * 0. The energy that it had, and that of its contacts, leaves the balance.
 */
#include <limits.h>

#include "reader.h"

#define FAR 1e4                 /* sizes of the model from a removed block to the next one */

/* A monitor of a block that is removed would show nothing. */
int model_stage_head(model_reader *r)
{
    model *p = r->p;
    const char *word = model_new_name(r, &r->stage_of);
    int steps = p->stage[0].par.steps;

    if (!word || !model_enter(r, &r->stage_of, word, r->s->stage)
        || (model_skip(r, "steps") && !model_whole(r, "steps", 1, &steps)))
        return 0;
    p->stage[r->s->stage].name = word;
    if (p->m->par.steps > INT_MAX / 2 - steps)
        return model_blame(r, "more than %d steps in all, expected fewer", INT_MAX / 2);
    p->m->par.steps += steps;
    if (!model_skip(r, "remove"))
        return 1;
    do {
        const int block = model_known(r, &r->block_of);
        if (block < 0)
            return 0;
        for (int k = 0; k < p->monitors; k++)
            for (int n = 0; n < p->monitor[k].nodes; n++)
                if (p->node_block[p->monitor[k].node[n]] == block)
                    return model_blame(r, "monitor '%.60s' is on block '%.60s', expected one that "
                                       "stays", p->monitor[k].name, p->block[block]);
        if (p->gone[block])
            return model_blame(r, "block '%.60s' is removed for the second time, expected once",
                               p->block[block]);
        p->gone[block] = r->s->stage;
        if (++r->removed == p->blocks)
            return model_blame(r, "the last block is removed, expected one that stays");
    } while (model_look(r));
    for (int b = 0; b < p->blocks; b++)
        if (p->gone[b] != p->gone[p->body[b]])
            return model_blame(r, "block '%.60s' is bonded to '%.60s', expected both removed",
                               p->block[b], p->block[p->body[b]]);
    return 1;
}

/* What fixes a block goes to its nodes; without shear springs there is no friction. Supports begin
 * the next stage where they are. */
void model_keep_stage(model_reader *r, int k)
{
    bbm_model *m = r->p->m;
    bbm_node *node = model_keep(r, m->nodes, sizeof *node);

    if (r->no_shear)
        m->par.friction = m->beyond->cohesion = 0;
    r->p->stage[k] = (model_stage){ r->p->stage[k].name, m->par, m->beyond->cohesion,
                                    m->beyond->tension, m->beyond->edge_loads, node };
    for (int v = 0; v < m->vertices && k == 0; v++)
        if (r->block[m->element[m->vertex[v].element].block].fixed)
            m->node[m->vertex[v].node].held = BBM_XY;
    for (int n = 0; n < m->nodes && node; n++) {
        node[n] = m->node[n];
        m->node[n].wall[0] = m->node[n].wall[1] = 0;
    }
}

/* Element i, so many m to the right of where it was at the start, without weight. */
static void carry_away(bbm_model *m, int i, double far)
{
    bbm_element *e = &m->element[i];

    *e = (bbm_element){ .block = e->block, .first = e->first, .n = e->n, .material = e->material,
                        .A0 = e->A0, .middle = e->middle, .out_of_plane = FIELD_GONE };
    e->material.density = 0;
    for (bbm_vertex *v = &m->vertex[e->first]; v < &m->vertex[e->first + e->n]; v++) {
        v->u = far, v->v = 0;
        v->x = m->node[v->node].x - m->origin[0] + far;
        v->y = m->node[v->node].y - m->origin[1];
    }
    bbm_element_geometry(e, &m->vertex[e->first]);
}

/* How a stage holds and loads a node; one that was free is held where it is. */
static void change_node(bbm_model *m, int n, bbm_node *to)
{
    const int v = m->adjacent[m->adjacent_first[n]], gone = field_is_gone(m, v);
    const double u[2] = { m->vertex[v].u, m->vertex[v].v };
    bbm_node *a = &m->node[n];

    if (gone)
        *to = (bbm_node){ .held = BBM_XY };
    for (int k = 0; k < 2; k++) {
        if (gone || to->held & ~a->held & 1 << k)
            a->wall[k] = u[k];
        to->wall[k] += a->wall[k];
        a->load[k] = to->load[k];
    }
    a->held = to->held;
}

/* The gaps of fixed points may be others and begin without multipliers; K is laid out anew.
 * Contacts and bolts of what is gone end; the first step loses the energy of their springs. */
void model_next_stage(model *p)
{
    bbm_model *m = p->m;
    const model_stage *s = &p->stage[++p->now];
    const int contacts = m->contacts;
    scene_bolt *b = p->bolt;
    double size = 0;

    for (int n = 0; n < m->nodes; n++)
        size = fmax(size, hypot(m->node[n].x - m->node[0].x, m->node[n].y - m->node[0].y));
    for (int i = 0; i < m->elements && p->now; i++)
        if (p->gone[m->element[i].block] == p->now)
            carry_away(m, i, FAR * size * (p->body[m->element[i].block] + 1));
    for (int n = 0; n < m->nodes; n++)
        change_node(m, n, &s->node[n]);
    for (int k = 0; k < p->bolts; k++, b++)
        if (b->k > 0 && (field_is_gone(m, b->end[0].vertex[0])
                         || field_is_gone(m, b->end[1].vertex[0])))
            b->k = b->pull = b->strength = 0, b->until = m->info.t;
    for (int k = 0; k < m->gaps; k++)
        if (k >= 2 * m->bonds || field_is_gone(m, m->element[m->gap[k].i].first)) {
            m->gap[k].own = (bbm_multiplier){ 0 };
            if (k < 2 * m->bonds)                       /* a crack without its slip and opening */
                memset(m->beyond->kept[k / 2].rest, 0, sizeof m->beyond->kept->rest);
        }
    m->contacts = 0;
    for (int k = 0; k < contacts; k++)
        if (!field_is_gone(m, m->edge[m->contact[k].corner].a)
            && !field_is_gone(m, m->edge[m->contact[k].edge].a))
            m->contact[m->contacts++] = m->contact[k];
    m->par = s->par;
    m->beyond->cohesion = s->cohesion;
    m->beyond->tension = s->tension;
    m->beyond->edge_loads = s->edge_loads;
    m->links = -1;
    p->begun = m->info.step;
}
