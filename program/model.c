/* model.c - what a run asks of a model that was read from a file. */

#include "model.h"

/* The next words of the library's text in those of the file; how many letters they had. */
static int translate(const model *p, const char *text, char word[80])
{
    const struct { const char *from, *to; int count; const char **name; } list[] = {
        { "block %d%n", "block '%.60s'", p->blocks, p->block },
        { "element %d%n", "element %.60s", p->m->elements, p->element },
        { "node %d%n", "node %.60s", p->m->nodes, p->node },
    };

    for (int k = 0, n, used = 0; k < LENGTH(list); k++)
        if (sscanf(text, list[k].from, &n, &used) == 1 && n >= 0 && n < list[k].count) {
            snprintf(word, 80, list[k].to, list[k].name[n]);
            return used;
        }
    const int stiffness = strncmp(text, "p_n", 3) == 0 || strncmp(text, "p_s", 3) == 0;
    snprintf(word, 80, stiffness ? "k%c" : "%c", text[stiffness ? 2 : 0]);
    return stiffness ? 3 : 1;
}

const char *model_says(const model *p, bbm_status status, char out[400])
{
    const char *text = *bbm_message(p->m) ? bbm_message(p->m) : bbm_status_text(status);
    char word[80];

    *out = '\0';
    while (*text) {
        text += translate(p, text, word);
        strncat(out, word, 399 - strlen(out));
    }
    return out;
}

const model_followed
    model_displacement = { "displacement", "m", "u|v|moves|stays", { "u", "v" },
                           { "u expected", "v expected", "to leave", "to stay" }, 2 },
    model_force = { "force", "N", "normal|shear|fx|fy", { "normal", "shear", "fx", "fy" },
                    { "normal expected", "shear expected", "fx expected", "fy expected" }, 4 },
    model_support = { "force of the supports", "N", "fx|fy", { "fx", "fy" },
                      { "fx expected", "fy expected" }, 2 },
    model_pull = { "force", "N", "force", { "force" }, { "expected" }, 1 };

static int fits(const int block[2], int i, int j)
{
    return (block[0] < 0 || block[0] == i) && (block[1] < 0 || block[1] == j);
}

/* The shear of a contact is the same from both sides: where each of two blocks has corners on the
 * other one, all of them add up; or those of the nodes alone. */
void model_follow(const model *p, model_monitor *m, double x[MODEL_FOLLOWED])
{
    const bbm_model *b = p->m;

    memset(x, 0, MODEL_FOLLOWED * sizeof *x);
    for (int n = 0; n < m->nodes && m->of == &model_displacement; n++) {
        bbm_result r;
        bbm_nodal_result(b, m->node[n], -1, &r);
        x[0] += r.u / m->nodes;
        x[1] += r.v / m->nodes;
    }
    for (int k = 0; k < 2 * m->nodes && m->of == &model_support; k++)
        x[k % 2] += b->beyond->support[m->node[k / 2]].force[k % 2];
    if (m->of == &model_pull)
        x[0] = p->bolt[m->block[0]].pull;
    for (int k = 0; k < b->contacts && m->of == &model_force; k++) {
        const bbm_contact *c = &b->contact[k];
        const int i = b->edge[c->corner].block, j = b->edge[c->edge].block,
                  sign = fits(m->block, i, j) - fits(m->block, j, i);
        int here = m->nodes == 0;
        for (int n = 0; n < m->nodes; n++)
            here |= m->node[n] == bbm_start_of(b, c->corner)->node;
        double of[] = { field_acts(c, 0), field_acts(c, 1), 0, 0 };
        field_contact_force(b, c, sign * of[0], sign * of[1], of + 2);
        for (int a = 0; a < LENGTH(of) && sign && here; a++)
            x[a] += of[a];
        m->touched |= sign && here && c->state != BBM_OPEN;
    }
}

double model_distance(const bbm_model *m, int corner, int edge)
{
    const bbm_vertex *P = bbm_start_of(m, corner), *a = bbm_start_of(m, edge);
    const bbm_direction t = m->edge[edge].along;
    const double s = fmax(0, fmin(t.length, bbm_way_along(m, corner, edge)));

    return hypot(P->x - a->x - s * t.x, P->y - a->y - s * t.y);
}

int model_touches_itself(const model *p, char out[300])
{
    const bbm_model *m = p->m;
    bbm_box *b = malloc((size_t)m->edges * sizeof *b);
    int corner = m->edges, side = 0;

    for (int e = 0; e < m->edges && b; e++) {
        b[e] = bbm_empty_box(e);
        bbm_widen_box(&b[e], bbm_start_of(m, e)->x, bbm_start_of(m, e)->y, 0);
        bbm_widen_box(&b[e], bbm_end_of(m, e)->x, bbm_end_of(m, e)->y,
                      MODEL_TOUCH * m->edge[e].along.length);
    }
    if (b)
        bbm_sort_boxes(m->edges, b);
    for (int i = 0, j = 0, k = 0; b && (k % 2 || bbm_next_meeting(m->edges, b, &i, &j)); k++) {
        const int c = b[k % 2 ? j : i].of, e = b[k % 2 ? i : j].of, n = bbm_start_of(m, c)->node;
        if (m->edge[c].first == m->edge[e].first && n != bbm_start_of(m, e)->node
            && n != bbm_end_of(m, e)->node && (c < corner || (c == corner && e < side))
            && model_distance(m, c, e) <= MODEL_TOUCH * m->edge[e].along.length)
            corner = c, side = e;
    }
    free(b);
    if (corner < m->edges)
        snprintf(out, 300, "node %.40s of block '%.60s' lies on its side from node %.40s to %.40s, "
                 "not as its end: there is neither a bond nor a contact",
                 p->node[bbm_start_of(m, corner)->node], p->block[m->edge[corner].block],
                 p->node[bbm_start_of(m, side)->node], p->node[bbm_end_of(m, side)->node]);
    return corner < m->edges;
}

/* Each block as a rigid body: v + spin x (X - barycentre of the block). */
int model_start(model *p)
{
    bbm_model *m = p->m;
    double (*sum)[3] = calloc((size_t)p->blocks, sizeof *sum);

    for (const bbm_element *i = m->element; i < m->element + m->elements && sum; i++) {
        const double mass = i->material.density * i->material.thickness * i->A0;
        sum[i->block][0] += mass * i->x;
        sum[i->block][1] += mass * i->y;
        sum[i->block][2] += mass;
    }
    for (bbm_element *i = m->element; i < m->element + m->elements && sum; i++) {
        const double *v = p->velocity[i->block].V, *s = sum[i->block];
        const double x = i->x - s[0] / s[2], y = i->y - s[1] / s[2];
        memcpy(i->V, (double[6]){ v[0] - v[2] * y, v[1] + v[2] * x, v[2] }, sizeof i->V);
    }
    free(sum);
    return sum != NULL;
}

void model_free(model *p)
{
    bbm_model_free(p->m);
    for (model_kept *k = p->kept, *next; k; k = next) {
        next = k->next;
        free(k);
    }
    *p = (model){ 0 };
}
