/* build.c - how a model is built: what is added is checked where it is added; bbm_prepare finds the
 * edges that elements share (2.2) and makes the arrays that the steps need.
 */
#include <stddef.h>

#include "base.h"

/* An element whose area is below FLAT times the square of its length is degenerate: round-off would
 * decide the sign of its area. */
#define FLAT 1e-12

/* What a material may have: products of three or their squares are still numbers then. */
#define LEAST 1e-100

/* A model that lies more than FAR/2 sizes of its first element away from (0, 0) gets an origin of
 * its own. Else the last digit of a coordinate, times p_n, would be a force that counts. */
#define FAR 1024

/* ----------------------------------------------------------------------------- building a model */

/* A model with the defaults of statics in one step. */
bbm_status bbm_model_new(bbm_model **out)
{
    struct { bbm_model model; bbm_hooks hook; } *both = calloc(1, sizeof *both);

    *out = both ? &both->model : NULL;
    if (!both)
        return BBM_NO_MEMORY;
    both->model.hook = &both->hook;
    both->model.par = (bbm_parameters){
        .dt = INFINITY, .steps = 1, .alpha = 100, .p_n = 1e9, .p_s = 4e8, .faces = 1,
        .pcg = { .omega = 1, .tolerance = 1e-10, .iterations = 100000 },
    };
    return BBM_OK;
}

/* What bbm_prepare made, the members from `is_prepared` up to `h`. */
static void free_prepared(bbm_model *m)
{
    void *const array[] = { m->bond, m->edge, m->adjacent_first, m->F, m->gap, m->link,
                            m->contact };

    for (int k = 0; k < LENGTH(array); k++)
        free(array[k]);
    bbm_matrix_free(m->K);
    bbm_detect_free(m->scratch);
    for (int i = 0; i < m->elements; i++)
        m->element[i].middle = NULL;
    memset((char *)m + offsetof(bbm_model, is_prepared), 0,
           offsetof(bbm_model, h) - offsetof(bbm_model, is_prepared));
}

void bbm_model_free(bbm_model *m)
{
    if (!m)
        return;
    free_prepared(m);
    if (m->hook->release)
        m->hook->release(m);
    void *const array[] = { m->node, m->element, m->vertex, m->line_load, m->material, m };
    for (int k = 0; k < LENGTH(array); k++)
        free(array[k]);
}

/* Remembers the first error of building, and says what it is. A model that has one takes no more:
 * what follows is not done, and gives that error. */
#define REFUSE(m, ...) ((m)->status = (m)->status ? (m)->status : bbm_fail(m, __VA_ARGS__))

#define COMPLETE "a model that has made a step takes no more"

/* Puts a copy of an entry at the end of an array of the model, which is to be prepared anew, counts
 * it, and gives its index. One that has made a step stays as it is. */
#define APPEND(m, array, count, entry, index) \
    ((m)->info.step > 0 ? bbm_fail(m, BBM_BAD_PARAMETER, COMPLETE) : \
     ((m)->is_prepared = 0, (m)->status = (m)->status ? (m)->status : \
      bbm_append(m, (void **)&(array), &(count), sizeof *(array), entry, index)))

bbm_status bbm_add_material(bbm_model *m, const bbm_material *a, int *index)
{
    const struct { const char *name; double value; } positive[3] = {
        { "E", a->E }, { "density", a->density }, { "thickness", a->thickness } };
    const int n = m->materials;

    for (int k = 0; k < 3; k++)
        if (!(positive[k].value >= LEAST && positive[k].value <= 1 / LEAST))
            return REFUSE(m, BBM_BAD_MATERIAL, "material %d has %s = %g, expected more than 0, "
                          "from 1e-100 to 1e+100", n, positive[k].name, positive[k].value);
    if (!(a->nu > -1 && a->nu < 0.5))
        return REFUSE(m, BBM_BAD_MATERIAL, "material %d has nu = %g, expected more than -1, less "
                      "than 0.5", n, a->nu);
    return APPEND(m, m->material, m->materials, a, index);
}

bbm_status bbm_add_node(bbm_model *m, double x, double y, int *index)
{
    if (!isfinite(x) || !isfinite(y))
        return REFUSE(m, BBM_NOT_FINITE, "node %d at (%.9g, %.9g)", m->nodes, x, y);
    return APPEND(m, m->node, m->nodes, (&(bbm_node){ .x = x, .y = y }), index);
}

/* A model with an error takes none. */
static int is_node(const bbm_model *m, int n) { return n >= 0 && n < m->nodes && !m->status; }

/* The signed area of a polygon; 0 if it is nothing against the square of the longest distance from
 * vertex 0. */
static double polygon_area(const bbm_model *m, int n, const int node[])
{
    const bbm_node *o = &m->node[node[0]];
    double area = 0, reach2 = 0;

    for (int i = 1; i < n; i++) {
        const bbm_node *a = &m->node[node[i]], *b = &m->node[node[(i + 1) % n]];
        const double ax = a->x - o->x, ay = a->y - o->y;
        area += (ax * (b->y - o->y) - (b->x - o->x) * ay) / 2;
        reach2 = fmax(reach2, ax * ax + ay * ay);
    }
    return fabs(area) > FLAT * reach2 ? area : 0;
}

/* Adds the polygon through the nodes, either way round, as an element of a block. */
bbm_status bbm_add_element(bbm_model *m, int block, int material, int n, const int node[],
                           int *index)
{
    const int e = m->elements, first = m->vertices;

    if (material < 0 || material >= m->materials)
        return REFUSE(m, BBM_BAD_INDEX, "element %d has material %d of %d", e, material,
                      m->materials);
    if (block < 0)
        return REFUSE(m, BBM_BAD_INDEX, "element %d has block %d, expected 0 or more", e, block);
    if (n < 3)
        return REFUSE(m, BBM_BAD_ELEMENT, "element %d has %d vertices, expected 3 or more", e, n);
    for (int i = 0; i < n; i++)
        if (!is_node(m, node[i]))
            return REFUSE(m, BBM_BAD_INDEX, "element %d has node %d of %d", e, node[i], m->nodes);
    if (m->hook->check_polygon && m->hook->check_polygon(m, n, node))
        return m->status = BBM_SELF_CROSSING;
    const double area = polygon_area(m, n, node);
    if (area == 0)
        return REFUSE(m, BBM_BAD_ELEMENT, "element %d has no area", e);
    if (e == 0) {
        const double grid = FAR * sqrt(fabs(area));
        m->origin[0] = grid * rint(m->node[node[0]].x / grid);
        m->origin[1] = grid * rint(m->node[node[0]].y / grid);
    }
    for (int i = 0; i < n; i++) {
        const int at = node[area > 0 ? i : n - 1 - i];
        const bbm_vertex v = { .node = at, .element = e, .x = m->node[at].x - m->origin[0],
                               .y = m->node[at].y - m->origin[1] };
        const bbm_status status = APPEND(m, m->vertex, m->vertices, &v, NULL);
        if (status)
            return status;
    }
    bbm_element new = { .block = block, .material = m->material[material], .first = first, .n = n };
    bbm_element_geometry(&new, &m->vertex[first]);
    new.A0 = new.A;
    return APPEND(m, m->element, m->elements, &new, index);
}

/* Holds a node in the given directions to a wall point displaced by (u, v). */
bbm_status bbm_fix_node(bbm_model *m, int node, int directions, double u, double v)
{
    if (!is_node(m, node))
        return REFUSE(m, BBM_BAD_INDEX, "fixed node %d of %d", node, m->nodes);
    if (directions < BBM_X || directions > BBM_XY)
        return REFUSE(m, BBM_BAD_PARAMETER, "directions %d of fixed node %d", directions, node);
    if (!isfinite(u) || !isfinite(v))
        return REFUSE(m, BBM_NOT_FINITE, "the wall point of fixed node %d", node);
    m->node[node].held |= directions;
    if (directions & BBM_X)
        m->node[node].wall[0] = u;
    if (directions & BBM_Y)
        m->node[node].wall[1] = v;
    return BBM_OK;
}

bbm_status bbm_add_load(bbm_model *m, int node, double fx, double fy)
{
    if (!is_node(m, node))
        return REFUSE(m, BBM_BAD_INDEX, "loaded node %d of %d", node, m->nodes);
    if (!isfinite(fx) || !isfinite(fy))
        return REFUSE(m, BBM_NOT_FINITE, "the load of node %d", node);
    m->node[node].load[0] += fx;
    m->node[node].load[1] += fy;
    return BBM_OK;
}

/* Adds a line load with everything but its vertices, which bbm_prepare finds. With f it varies, and
 * is taken at the Gauss points of the starting geometry. */
static bbm_status add_line(bbm_model *m, bbm_line_load load, bbm_field *f, const void *context)
{
    const int p = load.node[0], q = load.node[1];

    if (!is_node(m, p) || !is_node(m, q))
        return REFUSE(m, BBM_BAD_INDEX, "line load on nodes %d, %d of %d", p, q, m->nodes);
    const bbm_node a = m->node[p], b = m->node[q];      /* f may add nodes */
    for (int g = 0; g < BBM_GAUSS; g++) {
        double s, weight;
        bbm_gauss_point(g, &s, &weight);
        if (f)
            f(a.x + (b.x - a.x) * s, a.y + (b.y - a.y) * s, context, load.f[g]);
        if (!isfinite(load.f[g][0]) || !isfinite(load.f[g][1]))
            return REFUSE(m, BBM_NOT_FINITE, "the line load on nodes %d, %d", p, q);
    }
    return APPEND(m, m->line_load, m->line_loads, &load, NULL);
}

bbm_status bbm_add_line_load(bbm_model *m, int node1, int node2, double fx, double fy)
{
    const bbm_line_load load = { .node = { node1, node2 }, .constant = 1, .f = { { fx, fy } } };

    return add_line(m, load, NULL, NULL);
}

/* A load f(x, y) [N/m] on the edge between two nodes. */
bbm_status bbm_add_varying_line_load(bbm_model *m, int node1, int node2, bbm_field *f,
                                     const void *context)
{
    if (!f)
        return REFUSE(m, BBM_BAD_PARAMETER, "the line load on nodes %d, %d has no f", node1, node2);
    return add_line(m, (bbm_line_load){ .node = { node1, node2 } }, f, context);
}

/* ------------------------------------------------------ preparing: 2.2, the edges, and K */

/* Lists the vertices at each node: adjacent[adjacent_first[n]] and on are those of node n. */
static bbm_status list_adjacent_vertices(bbm_model *m)
{
    int *first = calloc((size_t)m->nodes + 1 + (size_t)m->vertices, sizeof *first);

    if (!first)
        return BBM_NO_MEMORY;
    m->adjacent_first = first;
    m->adjacent = first + m->nodes + 1;
    for (int v = 0; v < m->vertices; v++)
        first[m->vertex[v].node]++;
    for (int n = 0; n <= m->nodes; n++) {
        if (n < m->nodes && first[n] == 0)
            return bbm_fail(m, BBM_UNUSED_NODE, "node %d at (%.9g, %.9g)", n, m->node[n].x,
                            m->node[n].y);
        first[n] += n > 0 ? first[n - 1] : 0;
    }
    for (int v = m->vertices - 1; v >= 0; v--)
        m->adjacent[--first[m->vertex[v].node]] = v;
    return BBM_OK;
}

/* The vertex where a side of a block from node p to node q starts, but for the vertex v; or -1. */
static int find_side(const bbm_model *m, int block, int p, int q, int v)
{
    for (int a = m->adjacent_first[p]; a < m->adjacent_first[p + 1]; a++) {
        const int w = m->adjacent[a];
        const bbm_element *e = &m->element[m->vertex[w].element];
        if (w != v && e->block == block && m->vertex[bbm_next_vertex(e, w)].node == q)
            return w;
    }
    return -1;
}

/* Section 2.2: a side that two elements of a block share is an internal edge and gets a bond; a
 * side without a partner is a boundary edge. Elements run counter-clockwise, so that partners run
 * in opposite directions. Two elements that run in the same direction overlap. */
static bbm_status connect_elements(bbm_model *m)
{
    m->edge = calloc((size_t)m->vertices, sizeof *m->edge);
    m->bond = calloc((size_t)m->vertices / 2, sizeof *m->bond);
    if (!m->edge || !m->bond)
        return BBM_NO_MEMORY;
    for (int v = 0; v < m->vertices; v++) {
        const int i = m->vertex[v].element, next = bbm_next_vertex(&m->element[i], v);
        const int p = m->vertex[v].node, q = m->vertex[next].node, block = m->element[i].block;
        const int same = find_side(m, block, p, q, v), w = find_side(m, block, q, p, -1);
        if (same >= 0) {
            m->blamed[0] = m->vertex[same].element;
            m->blamed[1] = i;
            return bbm_fail(m, BBM_OVERLAP, "element %d and element %d on the same side, from "
                            "node %d to node %d", i, m->blamed[0], p, q);
        }
        const int across = w < 0 ? 0 : bbm_next_vertex(&m->element[m->vertex[w].element], w);
        m->vertex[v].edge = w < 0 ? m->edges : -1 - across;
        if (w < 0)
            m->edge[m->edges++] = (bbm_edge){ .element = i, .a = v, .b = next, .block = block,
                                              .joined = { -1, -1 }, .held = { -1, -1 } };
        else if (v < w)
            m->bond[m->bonds++] = (bbm_bond){ i, m->vertex[w].element, { v, next },
                                              { across, w } };
    }
    return BBM_OK;
}

/* Finds the vertices of each line load: those of the first boundary edge between its nodes. */
static bbm_status place_line_loads(bbm_model *m)
{
    for (int l = 0; l < m->line_loads; l++) {
        bbm_line_load *load = &m->line_load[l];
        int found = 0;
        for (int k = 0; k < 2 * m->edges && !found; k++) {
            const bbm_edge *e = &m->edge[k / 2];
            load->a = k % 2 ? e->b : e->a;
            load->b = k % 2 ? e->a : e->b;
            found = m->vertex[load->a].node == load->node[0]
                 && m->vertex[load->b].node == load->node[1];
        }
        if (!found)
            return bbm_fail(m, BBM_NOT_BOUNDARY, "nodes %d and %d", load->node[0], load->node[1]);
    }
    return BBM_OK;
}

/* The most gaps that there may be. A bond has two. A vertex that is held has one, and a hook may
 * add two of the edge that starts there, and one between each two corners of a node that has not
 * too many. */
size_t bbm_most_gaps(const bbm_model *m)
{
    size_t most = 2 * (size_t)m->bonds + 3 * (size_t)m->vertices;

    for (int n = 0; n < m->nodes && m->hook->list_gaps; n++) {
        const size_t corners = (size_t)(m->adjacent_first[n + 1] - m->adjacent_first[n]);
        most += corners > BBM_JOINED ? 0 : corners * (corners - 1) / 2;
    }
    return most;
}

/* The arrays that the steps need. */
static bbm_status allocate(bbm_model *m)
{
    m->F = calloc(18 * (size_t)m->elements, sizeof *m->F);
    m->gap = calloc(bbm_most_gaps(m), sizeof *m->gap);
    m->contact = malloc(sizeof *m->contact);            /* there is none as yet                 */
    if (!m->F || !m->gap || !m->contact || bbm_detect_new(m))
        return BBM_NO_MEMORY;
    m->D = m->F + 6 * (size_t)m->elements;
    m->load = m->D + 6 * (size_t)m->elements;
    bbm_list_gaps(m);
    return bbm_lay_out_matrix(m);
}

/* Checks the model and makes all that the steps need. */
bbm_status bbm_prepare(bbm_model *m)
{
    bbm_status (*const part[])(bbm_model *) = { list_adjacent_vertices, connect_elements,
                                                place_line_loads, allocate, m->hook->check };
    bbm_status status = m->status;

    if (status)
        return status;
    if (m->info.step > 0)
        return bbm_fail(m, BBM_BAD_PARAMETER, COMPLETE);
    free_prepared(m);
    if (m->elements == 0)
        return bbm_fail(m, BBM_NO_ELEMENT, "%d nodes", m->nodes);
    for (size_t k = 0; k < sizeof part / sizeof *part && !status; k++)
        status = part[k] ? part[k](m) : BBM_OK;
    m->is_prepared = !status;
    return status == BBM_NO_MEMORY ? bbm_out_of_memory(m) : status;
}
