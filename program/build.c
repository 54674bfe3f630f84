/* build.c - the library's model of what the statements say, and the statements that need it:
 * where it is held and loaded, WHERE by its nodes. */

#include "reader.h"

/* Of the smallest element's size: nodes closer to a given place, or to the rim of a box, are
 * there. */
#define NEAR 1e-6
#define SLANT 0.618

/* ----------------------------------------------------------------- building the library's model */

/* What the file leaves out. The contacts are as stiff as the softest material of a block that is
 * not fixed, for a fixed one is often given an E that only says "rigid". In dynamics, where
 * multipliers have no part, bonds are as stiff as fast motions can take without further passes. */
static void set_defaults(model_reader *r)
{
    bbm_parameters *p = &r->p->m->par;
    double softest[2] = { INFINITY, INFINITY };         /* of the blocks that are free, of all */
    int *rounds = &r->p->m->beyond->multiplier_rounds;

    *rounds = *rounds >= 0 ? *rounds : r->p->dynamic ? 0 : 2;
    p->alpha = p->alpha > 0 ? p->alpha : r->p->dynamic ? 1000 : 100;
    for (int e = 0; e < r->elements; e++) {
        const bbm_material *m = &r->p->m->element[e].material;
        for (int k = r->block[r->element[e].block].fixed; k < 2; k++)
            softest[k] = fmin(softest[k], m->E * m->thickness);
    }
    r->p->slippery = r->blocks > 1 + r->bonds && p->p_n != 0 && p->p_s != 0 && p->friction < 0;
    r->no_shear = p->p_s == 0;
    p->friction = fmax(p->friction, 0);
    if (p->p_n < 0)
        p->p_n = 50 * softest[isinf(softest[0]) ? 1 : 0];
    else if (p->p_n == 0)                       /* no contact: springs that cannot be felt */
        p->p_n = 1e-200;
    if (p->p_s <= 0)
        p->p_s = 0.4 * p->p_n;
}

/* Lists the blocks that meet at each node, in their order: each gets a node of its own. */
static int copy_nodes(model_reader *r)
{
    for (int e = 0; e < r->elements; e++)
        for (int k = r->element[e].first; k < r->element[e].first + r->element[e].n; k++) {
            int *link = &r->node[r->corner[k]].first;
            while (*link >= 0 && r->copy[*link].block != r->element[e].block)
                link = &r->copy[*link].next;
            if (*link >= 0)
                continue;
            *link = r->copies;
            const model_copy copy = { -1, r->element[e].block, -1 };
            if (!model_add(r, &r->copy, &r->copies, sizeof copy, &copy))
                return 0;
        }
    return 1;
}

/* Whether the copy is that of the block, -1: of any, and no stage has removed it. */
static int is_of(const model_reader *r, int block, int c)
{
    return (block < 0 || r->copy[c].block == block) && !r->p->gone[r->copy[c].block];
}

/* The copy of a node for a block, -1: any block; or -1, there is none. */
static int find_copy(const model_reader *r, int block, int node)
{
    int c = r->node[node].first;

    while (c >= 0 && !is_of(r, block, c))
        c = r->copy[c].next;
    return c;
}

/* Copies in one place in blocks that are bonded are one: up, a forest, leads from each to the one
 * that stands for them. */
static void join_copies(const model_reader *r, int up[], bbm_box box[])
{
    int n = 0;

    for (int c = 0; c < r->copies; c++)
        up[c] = c;
    for (const model_element *e = r->element; e < r->element + r->elements && r->bonds; e++) {
        const int *corner = &r->corner[e->first];
        const model_node *a = &r->node[corner[0]], *b = &r->node[corner[1]];
        for (int k = 0; k < e->n; k++, n++) {
            const model_node *at = &r->node[corner[k]];
            box[n] = bbm_empty_box(find_copy(r, e->block, corner[k]));
            bbm_widen_box(&box[n], at->x, at->y, NEAR * hypot(b->x - a->x, b->y - a->y));
        }
    }
    bbm_sort_boxes(n, box);
    for (int i = 0, j = 0; bbm_next_meeting(n, box, &i, &j);) {
        const int p = r->copy[box[i].of].block, q = r->copy[box[j].of].block;
        if (p != q && r->p->body[p] == r->p->body[q])
            up[bbm_root_of(up, box[i].of)] = bbm_root_of(up, box[j].of);
    }
}

static int add_nodes(model_reader *r)
{
    model *p = r->p;
    int *up = model_keep(r, r->copies, sizeof *up), now = 0;
    bbm_box *box = model_keep(r, r->corners, sizeof *box);

    if (!up || !box)
        return 0;
    join_copies(r, up, box);
    p->node = model_keep(r, r->copies, sizeof *p->node);
    p->node_block = model_keep(r, r->copies, sizeof *p->node_block);
    for (const model_node *a = r->node; a < r->node + r->nodes && !p->status; a++) {
        if (a->first < 0 && a->by_hand)
            return model_fail(r, a->at, "no element has node %.60s, expected one", a->id);
        for (int c = a->first; c >= 0; c = r->copy[c].next) {
            int *first = &r->copy[bbm_root_of(up, c)].node;
            const int is_new = *first < 0;
            *first = r->copy[c].node = is_new ? now : *first;
            if (!is_new)
                continue;
            p->node[now] = a->id;
            p->node_block[now++] = r->copy[c].block;
            if (bbm_add_node(p->m, a->x, a->y, NULL))
                return model_out_of_memory(r);
        }
    }
    return !p->status;
}

/* What is shorter than a part of the smallest element is no length: what lies far away does not
 * matter. */
static int add_element(model_reader *r, const model_element *e)
{
    const model_block *of = &r->block[e->block];
    const int material = e->material >= 0 ? e->material
                       : of->material >= 0 ? of->material : r->any.material;
    int *corner = &r->corner[e->first], index;

    if (material < 0)
        return model_fail(r, of->at, "block '%.60s' has no material, expected: use MATERIAL on "
                          "%.60s", of->name, of->name);
    for (int k = 0; k < e->n; k++)
        corner[k] = r->copy[find_copy(r, e->block, corner[k])].node;
    const bbm_status status = bbm_add_element(r->p->m, r->p->body[e->block], material,
                                              e->n, corner, &index);
    if (status == BBM_NO_MEMORY)
        return model_out_of_memory(r);
    for (int k = 0; status && k < e->n; k++) {
        const bbm_node *a = &r->p->m->node[corner[k]],
                       *b = &r->p->m->node[corner[(k + 1) % e->n]];
        if (a->x == b->x && a->y == b->y)
            return model_fail(r, e->at, "element %.60s of block '%.60s' has the corner %.9g %.9g "
                              "twice, expected it once", e->id, of->name, a->x, a->y);
    }
    if (status == BBM_SELF_CROSSING)
        return model_fail(r, e->at, "the boundary of element %.60s of block '%.60s' meets itself, "
                          "expected a simple polygon", e->id, of->name);
    const bbm_element *b = status ? NULL : &r->p->m->element[index];
    if (!b || !(b->A > 0) || !isfinite(b->x * b->Sxx) || !isfinite(b->y * b->Syy))
        return model_fail(r, e->at, "element %.60s of block '%.60s' has no area, or one too large, "
                          "expected a polygon", e->id, of->name);
    r->p->element[index] = e->id;
    r->p->centre[index][0] = b->x + r->p->m->origin[0];
    r->p->centre[index][1] = b->y + r->p->m->origin[1];
    r->margin = fmin(r->margin, NEAR * sqrt(b->A0));
    return 1;
}

/* Elements and edges get the blocks of the file in place of the bodies. Blocks that are bonded have
 * a side in common. */
static int name_blocks(model_reader *r)
{
    bbm_model *m = r->p->m;
    int (*side)[2] = model_keep(r, 2 * m->bonds, sizeof *side);  /* blocks that bonds join */

    if (!side)
        return 0;
    for (int e = 0; e < m->elements; e++)
        m->element[e].block = r->element[e].block;
    for (int e = 0; e < m->edges; e++)
        m->edge[e].block = m->element[m->edge[e].element].block;
    for (int k = 0; k < m->bonds; k++) {
        const int i = m->element[m->bond[k].i].block, j = m->element[m->bond[k].j].block;
        side[2 * k][0] = side[2 * k + 1][1] = i;
        side[2 * k][1] = side[2 * k + 1][0] = j;
    }
    qsort(side, 2 * (size_t)m->bonds, sizeof *side, bbm_compare_pairs);
    for (int k = 0; k < r->bonds; k++) {
        const model_bond *b = &r->bond[k];
        if (!bsearch(b->block, side, 2 * (size_t)m->bonds, sizeof *side, bbm_compare_pairs))
            return model_fail(r, b->at, "no side of block '%.60s' has the ends of one of block "
                              "'%.60s', expected sides that meet from node to node",
                              r->block[b->block[0]].name, r->block[b->block[1]].name);
    }
    return 1;
}

/* The first one of the blocks that bonds join is the root of their forest. */
static int find_bodies(model_reader *r)
{
    int *body = r->p->body = model_keep(r, r->blocks, sizeof *body);

    for (int b = 0; b < r->blocks && body; b++)
        body[b] = b;
    for (int k = 0; k < r->bonds && body; k++) {
        const int *b = r->bond[k].block, i = bbm_root_of(body, b[0]), j = bbm_root_of(body, b[1]);
        body[i > j ? i : j] = i > j ? j : i;
    }
    for (int b = 0; b < r->blocks && body; b++)
        body[b] = bbm_root_of(body, b);
    return body != NULL;
}

static int compare_along(const void *a, const void *b)
{
    const model_order *p = a, *q = b;

    return p->along != q->along ? (p->along > q->along) - (p->along < q->along)
                                : p->node - q->node;
}

int model_build(model_reader *r)
{
    model *p = r->p;

    if (r->elements == 0)
        return model_fail(r, r->whole, "the model has no element, expected: block ..., grid ..., "
                          "mesh FILE or element ...");
    p->gone = model_keep(r, r->blocks, sizeof *p->gone);
    r->order = model_keep(r, r->nodes, sizeof *r->order);
    if (!p->gone || !r->order || !find_bodies(r) || !copy_nodes(r) || !add_nodes(r))
        return 0;
    for (int n = 0; n < r->nodes; n++)          /* few of a stack or of a grid come together */
        r->order[n] = (model_order){ r->node[n].x + SLANT * r->node[n].y, n };
    qsort(r->order, (size_t)r->nodes, sizeof *r->order, compare_along);
    for (int k = 0; k < r->materials; k++)
        bbm_add_material(p->m, &r->material[k], NULL);
    p->element = model_keep(r, r->elements, sizeof *p->element);
    p->centre = model_keep(r, r->elements, sizeof *p->centre);
    r->margin = INFINITY;
    for (int e = 0; e < r->elements && !p->status; e++)
        add_element(r, &r->element[e]);
    if (p->status)
        return 0;
    set_defaults(r);
    const bbm_status status = bbm_prepare(p->m);
    if (status)
        return model_refused(r, status);
    if (!name_blocks(r))
        return 0;
    if (r->plane_strain)
        bbm_set_plane_strain(p->m);
    for (int b = 0; b < r->blocks; b++)         /* a block is a set, too, behind the others */
        if (model_find(&r->set_of, r->block[b].name) < 0)
            model_enter(r, &r->set_of, r->block[b].name, r->sets + b);
    p->velocity = model_keep(r, r->blocks, sizeof *p->velocity);
    r->chosen_node = model_keep(r, p->m->nodes, sizeof *r->chosen_node);
    r->named = model_keep(r, p->m->nodes, sizeof *r->named);
    return !p->status;
}

/* ---------------------------------------------------------------------------------------- WHERE */

enum { BY_NODE, BY_AT, BY_SET, BY_BOX };

/* What stands behind WHERE; found: the node or set; block: -1, any. */
typedef struct { int kind, found, block; double x[4]; } selection;

/* Takes the library nodes of a node, each once for a WHERE. */
static void choose(model_reader *r, const selection *w, int node)
{
    int c = find_copy(r, w->block, node);

    if (c < 0 || r->named[r->copy[c].node] == r->wheres)
        return;
    r->file_nodes++;
    for (; c >= 0; c = r->copy[c].next)
        if (is_of(r, w->block, c) && r->named[r->copy[c].node] != r->wheres) {
            r->chosen_node[r->chosen++] = r->copy[c].node;
            r->named[r->copy[c].node] = r->wheres;
        }
}

/* The first of the nearest nodes; -1: there is none. */
static int find_nearest(const model_reader *r, const selection *w)
{
    double best = INFINITY;
    int found = -1;

    for (int n = 0; n < r->nodes; n++) {
        const double d = hypot(r->node[n].x - w->x[0], r->node[n].y - w->x[1]);
        if (d < best - r->margin && find_copy(r, w->block, n) >= 0)
            best = d, found = n;
    }
    return found;
}

/* That others lie there as well is said, and that it is far away: by more than a tenth of the
 * model. */
static void choose_nearest(model_reader *r, const selection *w)
{
    const int found = find_nearest(r, w);
    double far = 0;
    int there = 0;

    if (found < 0)
        return;
    choose(r, w, found);
    const model_node *at = &r->node[found];
    for (int n = 0; n < r->nodes; n++) {
        const double d = hypot(r->node[n].x - at->x, r->node[n].y - at->y);
        far = fmax(far, d);
        there += d <= r->margin && find_copy(r, w->block, n) >= 0;
    }
    const double d = hypot(at->x - w->x[0], at->y - w->x[1]);
    if (d > far / 10)
        model_note(r, "warning: the nearest node, %.60s at %.9g %.9g, is %.3g m away from "
                   "%.9g %.9g", at->id, at->x, at->y, d, w->x[0], w->x[1]);
    if (there > 1)
        model_note(r, "note: %d nodes lie there, node %.60s of block '%.60s' is taken; `of BLOCK` "
                   "takes another", there, at->id, r->block[r->copy[at->first].block].name);
}

/* Takes the nodes at a place or in a box. */
static void choose_there(model_reader *r, const selection *w)
{
    const double *a = w->x, *b = w->kind == BY_AT ? a : a + 2, d = r->margin;
    const double from = a[0] + SLANT * a[1] - 2 * d, to = b[0] + SLANT * b[1] + 2 * d;
    int k = 0;

    for (int end = r->nodes; k < end;)
        if (r->order[(k + end) / 2].along < from)
            k = (k + end) / 2 + 1;
        else
            end = (k + end) / 2;
    for (; k < r->nodes && r->order[k].along <= to; k++) {
        const model_node *n = &r->node[r->order[k].node];
        if (n->x >= a[0] - d && n->x <= b[0] + d && n->y >= a[1] - d && n->y <= b[1] + d)
            choose(r, w, r->order[k].node);
    }
}

/* The words of WHERE; a set may be all nodes of a block. */
static int read_selection(model_reader *r, selection *w)
{
    static const struct { const char *word; int numbers; } kind[] = {
        [BY_NODE] = { "node", 0 }, [BY_AT] = { "at", 2 }, [BY_SET] = { "set", 0 },
        [BY_BOX] = { "box", 4 },
    };

    *w = (selection){ 0 };
    while (w->kind < LENGTH(kind) && !model_skip(r, kind[w->kind].word))
        w->kind++;
    if (w->kind == LENGTH(kind)) {
        const char *word = model_word(r);
        const int set = word ? model_find(&r->set_of, word) : -1;
        if (set >= 0)
            return model_blame(r, "'%.60s' is a %s, expected: set %.60s", word,
                               set < r->sets ? "set" : "block", word);
        return word && model_blame(r, "unknown place '%.60s', expected node ID, at X Y, set NAME "
                                   "(also of a block) or box XMIN YMIN XMAX YMAX in: %s", word,
                           r->s->form);
    }
    if (!model_numbers(r, kind[w->kind].numbers, w->x))
        return 0;
    const model_table *of = w->kind == BY_NODE ? &r->node_of : &r->set_of;
    const int is_block = model_look(r) && model_find(&r->block_of, model_look(r)) >= 0;
    if (kind[w->kind].numbers == 0 && (w->found = model_known(r, of)) < 0)
        return 0;
    const int is_set = w->kind == BY_SET && w->found < r->sets;
    const int what = is_set ? r->set[w->found].dimensions : 0;
    if (what & (what - 1) || (is_set && is_block && what != 1 << 2))
        return model_blame(r, "several things have that name, of blocks, sets and the mesh's "
                              "groups of surfaces, curves and points, expected one");
    w->block = w->kind == BY_SET && !is_set ? w->found - r->sets : -1;
    if (w->kind == BY_BOX && !(w->x[0] <= w->x[2] && w->x[1] <= w->x[3]))
        return model_blame(r, "a box from %g, %g to %g, %g, expected: box XMIN YMIN XMAX YMAX",
                           w->x[0], w->x[1], w->x[2], w->x[3]);
    return !model_skip(r, "of") || (w->block = model_known(r, &r->block_of)) >= 0;
}

static int blame_nowhere(model_reader *r, const selection *w)
{
    const int n = w->kind == BY_AT ? find_nearest(r, w) : -1;
    const char *of = w->block >= 0 ? " of block " : "",
               *name = w->block >= 0 ? r->block[w->block].name : "";

    if (n < 0)
        return model_blame(r, "no node there%s%.60s%s, expected a place that names one", of, name,
                           w->block >= 0 && r->p->gone[w->block] ? ", which is removed" : "");
    return model_blame(r, "no node there%s%.60s, the nearest is node %.60s at %.9g %.9g", of, name,
                       r->node[n].id, r->node[n].x, r->node[n].y);
}

/* WHERE: the nodes that it names in r->chosen_node. `nearest`: at X Y is the nearest node, however
 * far. */
static int read_where(model_reader *r, int nearest, selection *w)
{
    const int ahead = r->ahead - r->next - 1;

    r->chosen = r->file_nodes = 0;
    r->wheres++;
    if (model_look(r))                          /* the form has no names for words in it */
        r->ahead = r->s->n + 2;
    if (!read_selection(r, w))
        return 0;
    r->ahead = ahead + r->next;
    if (w->kind == BY_NODE)
        choose(r, w, w->found);
    else if (w->kind == BY_SET && w->found < r->sets)
        for (int k = 0; k < r->set[w->found].n; k++)
            choose(r, w, r->set[w->found].node[k]);
    else if (w->kind == BY_AT && nearest)
        choose_nearest(r, w);
    else if (w->kind != BY_SET)
        choose_there(r, w);
    else
        for (int n = 0; n < r->nodes; n++)
            if (find_copy(r, w->found - r->sets, n) >= 0)
                choose(r, w, n);
    return 1;
}

/* The same, of one node at least. */
static int where(model_reader *r, int nearest)
{
    selection w;

    return read_where(r, nearest, &w) && (r->chosen > 0 || blame_nowhere(r, &w));
}

/* --------------------------------------------------------------- statements that need the model */

/* x and y, each with `by`; none: both. In a stage `by` counts from where the node is then, and
 * `free` ends what holds it. */
int model_fix(model_reader *r)
{
    double by[2] = { 0, 0 };
    int x = 0, y = 0, held = 0;
    model *p = r->p;

    const int ends = where(r, 0) && r->s->stage && model_skip(r, "free");
    model_option o[] = { { .name = "x", .flag = &x, .x = ends ? NULL : &by[0] },
                         { .name = "y", .flag = &y, .x = ends ? NULL : &by[1] } };
    if (!model_options(r, 0, LENGTH(o), o))
        return 0;
    const int directions = x || y ? BBM_X * x + BBM_Y * y : BBM_XY;
    for (int k = 0; k < r->chosen; k++) {
        const int n = r->chosen_node[k];
        bbm_node *at = &p->m->node[n];
        for (int a = 0; a < 2; a++)
            if (directions & at->held & 1 << a && at->wall[a] != by[a]
                && !(r->s->stage && at->wall[a] == 0))
                return model_blame(r, "node %.60s is displaced by %g in %s here, by %g in another "
                                      "statement, expected one of them", p->node[n], by[a],
                                   o[a].name, at->wall[a]);
        held |= at->held & directions;
        p->moving |= by[0] != 0 || by[1] != 0;
        bbm_fix_node(p->m, n, directions, by[0], by[1]);
        at->held &= ends ? ~directions : BBM_XY;
    }
    return !ends || held
           || model_blame(r, "nothing is fixed there in that direction, expected a support");
}

/* Each node of the file has the same share, and of that each element there. */
int model_load_nodes(model_reader *r)
{
    bbm_model *m = r->p->m;
    const int *n = r->chosen_node, *first = m->adjacent_first;
    double f[2];

    if (!where(r, 0) || !model_numbers(r, 2, f))
        return 0;
    for (int k = 0, end; k < r->chosen; k = end) {
        int all = 0;
        for (end = k; end < r->chosen && r->p->node[n[end]] == r->p->node[n[k]]; end++)
            all += first[n[end] + 1] - first[n[end]];
        for (int c = k; c < end; c++) {
            const double share = (double)(first[n[c] + 1] - first[n[c]]) / all / r->file_nodes;
            bbm_add_load(m, n[c], share * f[0], share * f[1]);
        }
    }
    return m->status ? model_blame(r, "loads too large to add up, expected finite ones") : 1;
}

/* Loads the boundary edges with both ends in WHERE: a traction or a pressure, in Pa, or water up to
 * a level, in m. */
int model_edge_load(model_reader *r)
{
    bbm_model *m = r->p->m;
    const int pulls = strcmp(r->s->name, "traction") == 0, water = strcmp(r->s->name, "water") == 0;
    double x[3] = { 0 }, density = 1000;        /* x: the traction; the pressure, or the level */
    model_option o[] = { ABOVE_ZERO("density", &density) };
    int found = 0, dry = water;

    if (!where(r, 0) || !(pulls ? model_numbers(r, 2, x) : model_number(r, &x[2]))
        || (water && !model_options(r, 0, LENGTH(o), o)))
        return 0;
    if (water && !(hypot(m->par.gravity[0], m->par.gravity[1]) > 0))
        return model_blame(r, "water without weight, expected gravity");
    for (int e = 0; e < m->edges; e++) {
        const bbm_vertex *a = bbm_start_of(m, e), *b = bbm_end_of(m, e);
        const double t = m->element[m->edge[e].element].material.thickness;
        if (r->named[a->node] != r->wheres || r->named[b->node] != r->wheres)
            continue;
        found = 1;
        dry &= fmin(a->y, b->y) + m->origin[1] >= x[2];
        if (water)
            bbm_add_water(m, e, x[2], density * t);
        else
            bbm_load_edge(m, e, x[0] * t, x[1] * t, x[2] * t);
    }
    if (!found)
        return model_blame(r, "no boundary edge has both ends there, expected a set or a box with "
                           "both");
    if (dry)
        return model_blame(r, "no edge there lies below y = %.9g, expected one under water", x[2]);
    if (m->status == BBM_NO_MEMORY)
        return model_out_of_memory(r);
    return m->status ? model_blame(r, "a load too large, expected a finite one") : 1;
}

/* BLOCK BLOCK, `*`: -1, any. */
static int read_blocks(model_reader *r, int block[2])
{
    for (int k = 0; k < 2; k++)
        block[k] = model_block_or_all(r);
    if (block[0] >= 0 && block[0] == block[1])
        model_blame(r, "a joint or pin of a block with itself, expected two blocks");
    return !r->p->status;
}

/* What is left out is as in `contact`. A joint that can never count is hardly meant. */
int model_joint(model_reader *r)
{
    double friction = -1, cohesion = -1, tension = -1;
    model_option o[] = { ANGLE("friction", &friction), FROM_ZERO("cohesion", &cohesion),
                         FROM_ZERO("tension", &tension) };
    int block[2], above = 0;
    const char *key = NULL;

    if (!read_blocks(r, block) || !model_options(r, 0, LENGTH(o), o)
        || !model_note_friction(r, friction))
        return 0;
    if (!o[0].seen && !o[1].seen && !o[2].seen)
        model_note(r, "warning: this joint has what `contact` has, without friction, cohesion or "
                   "tension of its own");
    for (int k = 7; k >= 0; k--) {      /* with a * or two and the other way; as it stands */
        key = model_print(r, "%d %d", k & 1 ? -1 : block[k / 4], k & 2 ? -1 : block[1 - k / 4]);
        above |= key && model_find(&r->joint_of, key) >= 0;
    }
    if (above)
        model_note(r, "warning: this joint never counts, below one that fits the same blocks");
    if (!key || !model_enter(r, &r->joint_of, key, 0))
        return 0;
    r->p->slippery = 0;
    if (r->no_shear)
        friction = cohesion = 0;
    return bbm_add_joint(r->p->m, block, friction, cohesion, tension) ? model_out_of_memory(r) : 1;
}

int model_velocities(model_reader *r)
{
    const int block = model_known(r, &r->block_of);
    model_velocity v = { { 0, 0, 0 }, 1 };

    if (block < 0 || !model_numbers(r, 2, v.V) || (model_look(r) && !model_number(r, &v.V[2])))
        return 0;
    const int stays = r->block[block].fixed && (v.V[0] != 0 || v.V[1] != 0 || v.V[2] != 0);
    if (r->p->velocity[block].given || stays)
        return model_blame(r, stays ? "a velocity of '%.60s', which is fixed, expected 0"
                           : "a velocity of '%.60s' for the second time, expected one",
                           r->block[block].name);
    r->p->velocity[block] = v;
    return 1;
}

/* N/m^3, besides the weight; `*`: of every block. They add up. */
int model_bodyforce(model_reader *r)
{
    const int block = model_block_or_all(r);
    double f[2] = { 0, 0 };
    const int good = model_numbers(r, 2, f);

    for (bbm_element *e = r->p->m->element; e < r->p->m->element + r->elements; e++)
        for (int k = 0; k < 2 && (block < 0 || e->block == block); k++)
            e->f[k] += e->material.thickness * f[k];
    return good;
}

/* At y = 0, and along y for each metre; `*`: of every block that has none of its own. */
int model_stress(model_reader *r)
{
    const int block = model_block_or_all(r);
    model_block *b = block < 0 ? &r->any : &r->block[block];
    double s[6] = { 0 };

    if (b->stressed)
        return model_blame(r, "a stress of '%.60s' for the second time, expected one", b->name);
    if (!model_numbers(r, 3, s)
        || (model_look(r) && !(model_keyword(r, "gradient") && model_numbers(r, 3, s + 3))))
        return 0;
    for (int e = 0; e < r->elements; e++) {
        bbm_element *i = &r->p->m->element[e];
        if (block < 0 ? r->block[i->block].stressed : i->block != block)
            continue;
        for (int k = 0; k < 3; k++)
            i->stress[k] = s[k] + s[3 + k] * r->p->centre[e][1];
        i->szz = i->out_of_plane * (i->stress[0] + i->stress[1]);
    }
    return b->stressed = 1;
}

int model_monitors(model_reader *r)
{
    model *p = r->p;
    model_monitor m = { .name = model_new_name(r, &r->monitor_of) };
    const int joint = m.name && model_skip(r, "joint"), held = m.name && model_skip(r, "support"),
              bolt = m.name && model_skip(r, "bolt");

    m.of = joint ? &model_force : held ? &model_support : bolt ? &model_pull : &model_displacement;
    r->chosen = 0;
    if (!m.name || (joint && !read_blocks(r, m.block))
        || (bolt && !model_whole(r, "the number of the bolt", 1, &m.block[0]))
        || ((joint ? model_look(r) != NULL : !bolt) && !where(r, !joint && !held))
        || !model_enter(r, &r->monitor_of, m.name, p->monitors)
        || !(m.node = model_keep(r, r->chosen, sizeof *m.node)))
        return 0;
    if (bolt && m.block[0]-- > p->bolts)
        return model_blame(r, "bolt %d of %d, expected the number of one", m.block[0] + 1,
                           p->bolts);
    if (m.block[0] < 0 && m.block[1] < 0)
        return model_blame(r, "a joint of any block with any, expected one block at least");
    for (; m.nodes < r->chosen; m.nodes++)
        m.node[m.nodes] = r->chosen_node[m.nodes];
    return model_add(r, &p->monitor, &p->monitors, sizeof m, &m);
}

/* The shares of the corners of a triangle in the point. Returns 1 if that is in it or as near as
 * rounding, -1: in one that runs clockwise, else 0. */
static int find_shares(const bbm_model *m, const double at[2], scene_end *e)
{
    const bbm_vertex *p = &m->vertex[e->vertex[0]], *q = &m->vertex[e->vertex[1]],
                     *r = &m->vertex[e->vertex[2]];
    const double x = at[0] - m->origin[0] - p->x, y = at[1] - m->origin[1] - p->y,
                 area = (q->x - p->x) * (r->y - p->y) - (r->x - p->x) * (q->y - p->y);

    e->share[1] = (x * (r->y - p->y) - y * (r->x - p->x)) / area;
    e->share[2] = (y * (q->x - p->x) - x * (q->y - p->y)) / area;
    e->share[0] = 1 - e->share[1] - e->share[2];
    const double least = fmin(e->share[0], fmin(e->share[1], e->share[2]));
    return area > 0 ? least > -NEAR : -(least > NEAR);
}

static scene_end at_node(const bbm_model *m, int v)
{
    const int e = m->vertex[v].element;

    return (scene_end){ m->element[e].block, e, { v, v, v }, { 1, 0, 0 } };
}

/* In how many blocks, or whether in this one, the point lies: it becomes an end. The triangles at
 * the first corner of a polygon that is not convex count against each other. */
static int find_end(const bbm_model *m, int block, const double at[2], scene_end *end)
{
    int found = 0;

    for (const bbm_element *e = m->element; e < m->element + m->elements; e++) {
        scene_end here = { 0 };
        int inside = 0;
        for (int k = e->first + 1; k < e->first + e->n - 1; k++) {
            scene_end next = { e->block, (int)(e - m->element), { e->first, k, k + 1 }, { 0 } };
            const int in = find_shares(m, at, &next);
            here = in > 0 ? next : here;
            inside += in;
        }
        if (inside > 0 && (block < 0 || block == e->block)) {
            found += !found || end->block != e->block;
            *end = here;
        }
    }
    for (int k = 0; k < 3 && found; k++)
        if (end->share[k] > 1 - NEAR)
            *end = at_node(m, end->vertex[k]);
    return found;
}

/* The end of a bolt: a node, or else a place in an element. */
static int read_end(model_reader *r, scene_end *end)
{
    const bbm_model *m = r->p->m;
    selection w;

    if (!read_where(r, 0, &w))
        return 0;
    const int found = r->chosen || w.kind != BY_AT ? r->chosen : find_end(m, w.block, w.x, end);
    if (found > 1)
        return model_blame(r, "a bolt ends at one of several nodes or blocks there, expected: "
                              "at X Y of BLOCK");
    if (r->chosen)
        *end = at_node(m, m->adjacent[m->adjacent_first[r->chosen_node[0]]]);
    if (found == 0 && w.kind == BY_AT)
        return find_end(m, -1, w.x, end)
               ? model_blame(r, "%.9g %.9g lies in block '%.60s', not in '%.60s'", w.x[0], w.x[1],
                             r->block[end->block].name, r->block[w.block].name)
               : model_blame(r, "%.9g %.9g lies in no element, expected one or a node", w.x[0],
                             w.x[1]);
    return found > 0 || blame_nowhere(r, &w);
}

/* Adds a bolt. The elements that meet at a node have equal shares in what ends there, so its parts
 * are from each of one end to each of the other. */
static int add_bolt(model_reader *r, const scene_bolt *b)
{
    model *p = r->p;
    const bbm_model *m = p->m;
    const int *at[2];
    int n[2];

    for (int k = 0; k < 2; k++) {
        const int node = m->vertex[b->end[k].vertex[0]].node, *first = &m->adjacent_first[node];
        at[k] = &m->adjacent[*first];
        n[k] = b->end[k].share[0] == 1 ? first[1] - *first : 1;
    }
    for (int q = 0; q < n[0] * n[1]; q++) {
        scene_bolt part = { .of = p->bolts, .k = 1.0 / (n[0] * n[1]), .rest = b->rest };
        for (int k = 0; k < 2; k++)
            part.end[k] = n[k] > 1 ? at_node(m, at[k][k ? q / n[0] : q % n[0]]) : b->end[k];
        if (!model_add(r, &p->part, &p->parts, sizeof part, &part))
            return 0;
    }
    return model_add(r, &p->bolt, &p->bolts, sizeof *b, b);
}

/* A spring between two points. */
int model_bolts(model_reader *r)
{
    const bbm_model *m = r->p->m;
    scene_bolt b = { .strength = INFINITY, .until = INFINITY };
    double pretension = 0;
    bbm_direction along;
    model_option o[] = { RANGE("stiffness", &b.k, 1e-100, 1e15, "[]", "1e-100 to 1e15"),
                         ABOVE_ZERO("strength", &b.strength),
                         FROM_ZERO("pretension", &pretension) };

    if (!read_end(r, &b.end[0]) || !read_end(r, &b.end[1]) || !model_options(r, 1, LENGTH(o), o))
        return 0;
    if (pretension > b.strength)
        return model_blame(r, "a pretension of %g N breaks the bolt, expected at most its "
                           "strength, %g N", pretension, b.strength);
    model_bolt_force(m, &b, &along);
    if (!(along.length > r->margin) || b.end[0].element == b.end[1].element)
        return model_blame(r, "a bolt without length or within an element, expected two places; "
                              "`pin` joins two blocks at a point");
    b.rest = along.length - pretension / b.k;
    b.pull = pretension;
    return add_bolt(r, &b);
}

#define PIN 1000                /* a pin is as stiff as a bond of this alpha */

/* Two blocks turn about a point that both have. */
int model_pins(model_reader *r)
{
    const bbm_model *m = r->p->m;
    scene_bolt b = { .strength = INFINITY, .until = INFINITY };
    double at[2];
    int block[2];

    if (!read_blocks(r, block) || !model_keyword(r, "at") || !model_numbers(r, 2, at))
        return 0;
    for (int k = 0; k < 2; k++)
        if (block[k] < 0 || find_end(m, block[k], at, &b.end[k]) != 1)
            return model_blame(r, "%.9g %.9g lies in no element of '%.60s', expected a point of "
                               "both", at[0], at[1], block[k] < 0 ? "*" : r->block[block[k]].name);
    b.k = bbm_bonding_stiffness(PIN, &m->element[b.end[0].element], &m->element[b.end[1].element]);
    return add_bolt(r, &b);
}

/* A body is free: which block of another one is nearest to its first element. */
static int blame_free(model_reader *r)
{
    const bbm_model *m = r->p->m;
    const int loose = m->blamed[0], body = m->K->component[loose];
    char near[300] = "", touch[300];
    double gap = INFINITY;

    for (int e = 0; e < m->edges; e++)
        for (int f = 0; f < m->edges && m->edge[e].element == loose; f++) {
            const int other = m->edge[f].element;
            const double d = fmin(model_distance(m, f, e), fmin(model_distance(m, e, f),
                                                       model_distance(m, m->edge[e].after, f)));
            if (m->K->component[other] == body || d >= gap)
                continue;
            gap = d;
            snprintf(near, sizeof near, "; element %.60s is %.3g m away from block '%.60s'",
                     r->p->element[loose], gap, r->p->block[m->element[other].block]);
        }
    if (model_touches_itself(r->p, touch))
        snprintf(near, sizeof near, "; %.290s", touch);
    return model_fail(r, r->whole, "block '%.60s' is free to move, "
                      "expected fix, fixblock or a contact that holds it in statics%s",
                      r->p->block[m->element[loose].block], near);
}

/* The supports of a block that is held at all its nodes hold what is bonded to it as well. What
 * takes part in the steps is hooked in; statics must be held. */
int model_finish(model_reader *r)
{
    const bbm_model *m = r->p->m;

    for (const bbm_bond *b = m->bond; b < m->bond + m->bonds && m->beyond->bond_tension > 0; b++) {
        const bbm_element *i = &m->element[b->i], *j = &m->element[b->j];
        if (i->block != j->block && (bbm_is_held_all_round(m, i) || bbm_is_held_all_round(m, j)))
            return model_fail(r, r->whole, "bonds that break between blocks '%.60s' and '%.60s', "
                              "one of which is held at the nodes of both, expected supports at "
                              "other nodes", r->p->block[i->block], r->p->block[j->block]);
    }
    const int hooked = model_hook(r);
    const bbm_status status = !hooked || r->p->dynamic ? BBM_OK : bbm_begin_statics(r->p->m);
    if (status == BBM_FREE_TO_MOVE)
        return blame_free(r);
    return status ? model_refused(r, status) : hooked;
}
