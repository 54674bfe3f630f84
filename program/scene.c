/* scene.c - blocks as SVG: states, films, contours.
 *
 * All frames of a scene share one window, so that panels can be compared and the film stands still.
 * A browser plays the <animate> elements of the blocks that move side by side; each lists one
 * outline per frame and goes in a straight line from one to the next. The last one is repeated, so
 * that the end can be looked at. What cannot be interpolated, the time, forces and supports, is a
 * group per frame that is visible at its turn.
 *
 * A block that is fixed as a whole is hatched in grey. The other fills carry no meaning but tell
 * blocks apart: each block takes the tint whose nearest bearer is farthest. They are those of Okabe
 * and Ito, lightened, so that the colour-blind can tell them apart and arrows can be seen on them.
 *
 * With a field each element has the colour of its value. The colours range over the values of all
 * frames, but for a hundredth of these at each end: one corner or hit with a very large stress does
 * not make all others alike.
 *
 * A map is a scene of one frame, whose displacements may be magnified; in place of the tints it
 * paints one band between two levels after the other. In each triangle the value is linear, so that
 * the band's share of the triangle is the triangle cut by two straight lines; a larger polygon is
 * first split into the triangles from its mean point to its sides. All shares of a band are one
 * path, drawn with a thin stroke in its own colour: the stroke closes the hairlines that
 * antialiasing would leave along common sides.
 */
#include "scene.h"

#include <errno.h>

#include "field.h"
#include "plot.h"

/* Kept; values repeated at the end; blocks that a tint looks at. */
enum { FRAMES = 64, HOLD = 6, TINTS = 6, NEIGHBOURS = 300 };
enum { LEFT = 92, RIGHT = 24, OVER = 40, UNDER = 56, BAR = 76, ARROW = PLOT_SYMBOL, SUPPORT = 10,
       MARGIN = 20 };                           /* pixels */
/* One of so many values may lie beyond each end of the colours, and be larger than a cross. */
enum { OUTSIDE = 100, LARGER = 20 };

static const double VISIBLE = 0.3;      /* pixels: what moves less stays                          */
static const double FAIR = 0.5;         /* of an element's width: how much an edge may change     */
static const double MOST = 1e5;         /* displacements are magnified: above, rounding is seen   */

/* Arrows: the largest is so wide, in pixels; name, unit: in the legend, with the force between
 * them. Contacts have a head on both sides. */
enum { LOAD, LOCKED = BBM_LOCK, SLIDING = BBM_SLIDE, PULLED, LINE_LOAD, WATER, PRESSURE, TENSION,
       KINDS };

static const struct { const char *colour; double width; const char *name, *unit; } arrow[KINDS] = {
    [LOAD] = { "#aa2288", 4, "load", "N" }, [LINE_LOAD] = { "#aa2288", 3, "load", "N/m" },
    [WATER] = { "#0077bb", 3, "water", "N/m" },
    [LOCKED] = { "#004488", 6, "contact force", "N, locked" },
    [SLIDING] = { "#cc3311", 6, "contact force", "N, sliding" },
    [PULLED] = { "#117733", 6, "contact force", "N, pulling" },
    [TENSION] = { "#cc3311", 2.6, "tension", "Pa" },
    [PRESSURE] = { "#004488", 1.8, "pressure", "Pa" },
};

static int is_contact(int kind) { return kind >= LOCKED && kind <= PULLED; }
static int is_stress(int kind) { return kind >= PRESSURE; }
static int has_two_heads(int kind) { return is_contact(kind) || is_stress(kind); }

/* All contacts have the scale of one kind, and both stresses. */
static int scale_of(int k) { return is_contact(k) ? LOCKED : is_stress(k) ? TENSION : k; }

/* Crosses have none. */
static int has_colours(const char *name) { return name && strcmp(name, FIELD_PRINCIPAL) != 0; }

typedef bbm_point point;

typedef struct {                        /* a block                                                */
    int first, n;                       /* its vertices: first, film.next[first], ..              */
    int held, fixed, tint;              /* fixed: at a point or more                              */
    double box[2][2];                   /* m        x from, to; y from, to, in the first frame    */
} body;

typedef struct {                        /* what the functions below draw with                     */
    plot         p;
    int          thrust;                /* it is drawn                                            */
    plot_box     panel;                 /* pixels                                                 */
    double       over, w, h;            /* around it too; over: above it                          */
    const scene *s;
    const bbm_model *m;
    int          bodies, held, whole;   /* whether any is held; is free, of one element           */
    body        *body;
    int         *next;                  /*          [vertices] the next one of the block          */
    point       *normal;                /*          [nodes] outward, of the boundary there        */
    int         *hidden;                /*          [elements] whether its cross is               */
    double       window[2][2];          /* m                                                      */
    double       scale;                 /* pixels/m                                               */
    double       most[KINDS];           /* the largest force of each kind, by scale_of            */
    double       length[KINDS];         /* its pixels                                             */
    int          seen[KINDS], supports[4];      /* of each kind of arrow; held in each way        */
    double       seconds;               /* of one pass; zero: nothing moves                       */
    plot_axis    bar;                   /* of the colours of a field                              */
    double       range[2];              /* of its values                                          */
} film;

/* ----------------------------------------------------------------------------------- recording */

static void drop_frame(const scene_frame *f)
{
    free(f->vertex);
    free(f->force);
}

void scene_free(scene *s)
{
    for (int k = 0; k < s->frames; k++)
        drop_frame(&s->frame[k]);
    free(s->frame);
    s->frame = NULL;
    s->frames = s->calls = s->failed = 0;
}

/* With what holds each vertex now, and the loads. */
static int make_frame(scene_frame *f, const bbm_model *m)
{
    f->vertex = malloc((size_t)m->vertices * sizeof *f->vertex);
    f->force = malloc((2 * (size_t)m->elements + (size_t)m->contacts) * sizeof *f->force);
    f->edges = m->edges;
    for (scene_line l; scene_edge_load(m, f->lines, &l); )
        f->lines++;
    for (int v = 0; v < m->vertices && f->vertex; v++) {
        const bbm_node *i = &m->node[m->vertex[v].node];
        const int moved = i->wall[0] != 0 || i->wall[1] != 0 ? SCENE_MOVED : 0;
        f->vertex[v] = (scene_vertex){ .load = { i->load[0], i->load[1] },
                                       .held = field_is_gone(m, v) ? SCENE_GONE : i->held + moved };
    }
    return f->vertex && f->force;
}

/* The principal stresses of each element in their directions, at its mean point. */
static void put_crosses(scene_frame *f, const bbm_model *m)
{
    f->forces = 0;
    for (const bbm_element *e = m->element; e < m->element + m->elements; e++) {
        const double *s = e->stress, middle = (s[0] + s[1]) / 2;
        const double radius = hypot(s[0] - middle, s[2]), angle = atan2(s[2], s[0] - middle) / 2;
        point mean = { 0, 0 };
        for (int v = e->first; v < e->first + e->n; v++) {
            mean.x += f->vertex[v].at.x / e->n;
            mean.y += f->vertex[v].at.y / e->n;
        }
        for (int k = 0; k < 2; k++) {
            const double p = k ? middle - radius : middle + radius, a = angle + k * acos(0);
            f->force[f->forces++] = (scene_force){ mean, { p * cos(a), p * sin(a) }, 0,
                                                   p > 0 ? TENSION : PRESSURE, { e->block } };
        }
    }
}

/* Places at the start and displacements, so many times each, and the values at nodes or of
 * elements. Returns whether all are finite. */
static int fill_frame(scene_frame *f, const bbm_model *m, const field *shown, int nodal,
                      const double times[2])
{
    int finite = 1;

    for (int v = 0; v < m->vertices; v++) {
        scene_vertex *s = &f->vertex[v];
        const int i = m->vertex[v].node, gone = s->held == SCENE_GONE;
        bbm_result r;
        bbm_nodal_result(m, i, -1, &r);
        if (scene_is_cracked(m))                        /* a crack parts what meets at a node   */
            r.u = m->vertex[v].u, r.v = m->vertex[v].v;
        s->at = gone ? (point){ times[0] * field_place(m, v, 0), times[0] * field_place(m, v, 1) }
                 : (point){ times[0] * m->node[i].x + times[1] * r.u,
                            times[0] * m->node[i].y + times[1] * r.v };
        s->value = gone ? NAN : !shown ? 0
                 : nodal ? field_of_node(shown, m, i, m->element[m->vertex[v].element].block)
                         : field_of_element(shown, m, m->vertex[v].element);
        finite &= gone || isfinite(r.u + r.v + s->value);
    }
    if (shown && !has_colours(shown->name))
        put_crosses(f, m);
    return finite;
}

/* Frames whose turn has not come go, to make room for this one: the last one alone, or half of all,
 * if the turn of all had come. */
void scene_record(scene *s, const bbm_model *m)
{
    scene_frame f = { .time = m->info.t, .call = s->calls++ };
    int kept = 0;

    if (!s->frame) {
        s->frame = calloc(FRAMES, sizeof *s->frame);
        s->every = 1;
    }
    s->failed |= !s->frame || !make_frame(&f, m);
    if (s->failed || !fill_frame(&f, m, s->field ? field_find(s->field) : NULL, 0,
                                 (double[]){ 1, s->scale > 0 ? s->scale : 1 })) {
        drop_frame(&f);
        return;
    }
    for (int k = 0; k < m->contacts && !s->field; k++) {
        const bbm_contact *c = &m->contact[k];
        const bbm_edge *corner = &m->edge[c->corner];
        const double N = field_acts(c, 0);
        double force[2];
        field_contact_force(m, c, N, field_acts(c, 1), force);
        if (c->state != BBM_OPEN)
            f.force[f.forces++] = (scene_force){ f.vertex[corner->a].at, { force[0], force[1] }, N,
                                                 N < 0 ? PULLED : (int)c->state,
                                                 { corner->block, m->edge[c->edge].block } };
    }
    if (s->frames == FRAMES && s->frame[FRAMES - 1].call % s->every == 0)
        s->every *= 2;
    for (int k = 0; k < s->frames; k++)
        if (s->frame[k].call % s->every)
            drop_frame(&s->frame[k]);
        else
            s->frame[kept++] = s->frame[k];
    s->frame[kept] = f;
    s->frames = kept + 1;
}

/* -------------------------------------------------------------------------------------- blocks */

static double gap(point a, point b) { return hypot(b.x - a.x, b.y - a.y); }

/* m, in a frame */
static point position(const film *f, int frame, int v) { return f->s->frame[frame].vertex[v].at; }

/* pixels */
static point pixel(const film *f, point a)
{
    return (point){ plot_pixel(&f->p.x, a.x), plot_pixel(&f->p.y, a.y) };
}

static point at(const film *f, int frame, int v) { return pixel(f, position(f, frame, v)); }

/* The distance of two blocks is that of their boxes, and a little of that of their centres. The
 * last ones before the block are looked at. */
static int choose_tint(const film *f, const body *b)
{
    double nearest[TINTS], apart[2], way[2];
    int best = 0;

    for (int k = 0; k < TINTS; k++)
        nearest[k] = INFINITY;
    for (const body *a = b - f->body > NEIGHBOURS ? b - NEIGHBOURS : f->body; a < b; a++) {
        for (int k = 0; k < 2; k++) {
            apart[k] = fmax(0, fmax(a->box[k][0] - b->box[k][1], b->box[k][0] - a->box[k][1]));
            way[k] = (a->box[k][0] + a->box[k][1] - b->box[k][0] - b->box[k][1]) / 2;
        }
        const double distance = hypot(apart[0], apart[1]) + 0.01 * hypot(way[0], way[1]);
        nearest[a->tint] = a->held ? nearest[a->tint] : fmin(nearest[a->tint], distance);
    }
    for (int k = 1; k < TINTS; k++)
        best = nearest[k] > nearest[best] ? k : best;
    return best;
}

/* Block by block, which are numbered from 0, in the order of their elements. Held: each of its
 * vertices, in both directions, where it was, in each frame in which it is there. Those that are
 * gone in the first frame are held and have no vertices. */
static body *body_of(const film *f, int v)
{
    return &f->body[f->m->element[f->m->vertex[v].element].block];
}

static void find_bodies(film *f)
{
    const bbm_model *m = f->m;
    const scene_frame *first = f->s->frame, *end = first + f->s->frames;

    for (int v = m->vertices - 1; v >= 0; v--) {
        body *b = body_of(f, v);
        for (; f->bodies <= b - f->body; f->bodies++)
            f->body[f->bodies] = (body){ -1, 0, 1, 0, 0, { { INFINITY, -INFINITY },
                                                           { INFINITY, -INFINITY } } };
        f->next[v] = b->first;
        b->first = v;
        b->n++;
        for (const scene_frame *g = first; g < end; g++)
            b->held &= g->vertex[v].held == BBM_XY || g->vertex[v].held == SCENE_GONE;
        b->fixed |= end[-1].vertex[v].held & BBM_XY;
        plot_widen(b->box, position(f, 0, v).x, position(f, 0, v).y);
    }
    for (body *b = f->body; b < f->body + f->bodies; b++) {
        b->n *= b->first >= 0 && first->vertex[b->first].held != SCENE_GONE;
        f->held |= b->held && b->n > 0;
        f->whole |= !b->held && b->n > 0 && b->n == m->element[m->vertex[b->first].element].n;
        b->tint = choose_tint(f, b);
    }
}

/* Of boundary edges whose two ends are held alike, or else of all: where supports stand. */
static void find_normals(film *f)
{
    const bbm_model *m = f->m;

    for (int e = 0; e < m->edges; e++) {
        const int a = m->vertex[m->edge[e].a].node, b = m->vertex[m->edge[e].b].node;
        const double weight = m->node[a].held && m->node[a].held == m->node[b].held ? 1 : 1e-6;
        for (int k = 0; k < 2; k++) {
            f->normal[k ? b : a].x += weight * (m->node[b].y - m->node[a].y);
            f->normal[k ? b : a].y += weight * (m->node[a].x - m->node[b].x);
        }
    }
}

/* Writes what a block is like in a frame. */
typedef void writer(film *f, int frame, const body *b);

static void end_film(film *f)
{
    free(f->body);
    free(f->next);
    free(f->normal);
    free(f->hidden);
}

/* Returns 0 and errno where there is nothing to draw or no memory. */
static int begin_film(film *f)
{
    const bbm_model *m = f->m;

    f->body = malloc((size_t)m->elements * sizeof *f->body);
    f->next = malloc((size_t)m->vertices * sizeof *f->next);
    f->normal = calloc((size_t)m->nodes, sizeof *f->normal);
    f->hidden = calloc((size_t)m->elements, sizeof *f->hidden);
    errno = f->s->frames || f->s->failed ? ENOMEM : EINVAL;
    if (f->s->failed || !f->s->frames || !f->body || !f->next || !f->normal || !f->hidden)
        return 0;
    find_bodies(f);
    find_normals(f);
    return 1;
}

/* The polygons of a block's elements. */
static void put_elements(film *f, int frame, const body *b)
{
    for (int k = 0, v = b->first; k < b->n; k++, v = f->next[v]) {
        const bbm_element *e = &f->m->element[f->m->vertex[v].element];
        const point a = at(f, frame, v);
        plot_point(&f->p, v == e->first ? "M" : " ", a.x, a.y);
        if (bbm_next_vertex(e, v) < v)
            plot_put(&f->p, "z");
    }
}

/* The boundaries of a block: each from its first edge on. */
static void put_outline(film *f, int frame, const body *b)
{
    const bbm_edge *edge = f->m->edge;

    for (int k = 0, v = b->first; k < b->n; k++, v = f->next[v]) {
        const int first = f->m->vertex[v].edge;
        int e = first, back = first;
        while (e >= 0 && edge[e].after > first && edge[back].before > first)
            e = edge[e].after, back = edge[back].before;
        if (first < 0 || edge[e].after != first)
            continue;
        do {                                            /* e is the last one */
            e = edge[e].after;
            const point a = at(f, frame, edge[e].a);
            plot_point(&f->p, e == first ? "M" : " ", a.x, a.y);
        } while (edge[e].after != first);
        plot_put(&f->p, "z");
    }
}

/* The boundary edges of a block one by one; those of a crack that is still to open have no length.
 */
static void put_edges(film *f, int frame, const body *b)
{
    for (int k = 0, v = b->first; k < b->n; k++, v = f->next[v]) {
        const int e = f->m->vertex[v].edge;
        if (e < 0)
            continue;
        const point p = at(f, frame, v);
        const point q = e < f->s->frame[frame].edges ? at(f, frame, f->m->edge[e].b) : p;
        plot_point(&f->p, "M", p.x, p.y);
        plot_point(&f->p, " ", q.x, q.y);
    }
}

/* The number of values of an animation: a frame each, the last one again and again. */
static int value_count(const film *f) { return f->s->frames + HOLD; }

static int is_moving(const film *f, const body *b)
{
    for (int i = 1; i < f->s->frames && f->seconds > 0; i++)
        for (int k = 0, v = b->first; k < b->n; k++, v = f->next[v])
            if (gap(at(f, 0, v), at(f, i, v)) > VISIBLE)
                return 1;
    return 0;
}

/* What `put` writes for each frame. */
static void animate(film *f, const char *attribute, const body *b, writer *put)
{
    const int last = f->s->frames - 1;

    plot_put(&f->p, "<animate attributeName=\"%s\" dur=\"%.3gs\" repeatCount=\"indefinite\" "
             "values=\"", attribute, f->seconds);
    for (int i = 0; i < value_count(f); i++) {
        plot_put(&f->p, i ? ";" : "");
        put(f, i < last ? i : last, b);
    }
    plot_put(&f->p, "\"/>");
}

/* The colour of the block's first element. */
static void put_colour(film *f, int frame, const body *b)
{
    const double value = f->s->frame[frame].vertex[b->first].value;

    plot_put(&f->p, "%s", plot_value_colour(&f->bar, value).text);
}

/* What `put` draws of a block; fill: NULL, the colour of its first element. */
static void put_shape(film *f, int frame, const body *b, const char *fill, double width,
                      writer *put)
{
    plot_put(&f->p, "<path fill=\"%s", fill ? fill : "");
    if (!fill)
        put_colour(f, frame, b);
    plot_put(&f->p, "\" stroke=\"#000000\" stroke-width=\"%g\" d=\"", width);
    put(f, frame, b);
    plot_put(&f->p, "\">");
    if (is_moving(f, b))
        animate(f, "d", b, put);
    if (!fill && f->seconds > 0)
        animate(f, "fill\" calcMode=\"discrete", b, put_colour);
    plot_put(&f->p, "</path>\n");
}

/* A block that does not move in the film is drawn with its elements, and each one with those in the
 * colours of a field. */
static void draw_block(film *f, int frame, const body *b)
{
    static const char *const tint[TINTS] = { "#f6cf8b", "#b3dcf5", "#8fd3bd", "#f7f0a6", "#e6c3d7",
                                             "#eba98f" };
    const int coloured = has_colours(f->s->field) && !b->held;

    for (body e = *b; coloured && e.first >= 0; e.first = f->next[e.first + e.n - 1]) {
        e.n = f->m->element[f->m->vertex[e.first].element].n;
        put_shape(f, frame, &e, NULL, 0.3, put_elements);
    }
    const int cracks = f->m->edges > f->s->frame[0].edges;
    put_shape(f, frame, b, coloured ? "none" : b->held ? "url(#held)" : tint[b->tint],
              cracks ? 0 : 1.3, put_outline);
    if (cracks)
        put_shape(f, frame, b, "none", 1.3, put_edges);
    if (!coloured && !is_moving(f, b))
        put_shape(f, frame, b, "none", 0.3, put_elements);
}

/* All of them, or those that are held. */
static void draw_blocks(film *f, int frame, int all)
{
    for (const body *b = f->body; b < f->body + f->bodies; b++)
        if (b->n > 0 && (all || b->held))
            draw_block(f, frame, b);
}

/* ------------------------------------------------------------------- forces, loads and supports */

/* Something at a point, in m, of a size in pixels, y upwards: a support, or an arrow from there, of
 * a share of the largest force of its kind. */
typedef void visitor(film *f, int kind, point from, point size, double share);

/* A force of a kind. `side`: outward normal, 0 if it starts at the point in any case; against it
 * the arrow ends there. Arrows of loads are as long as the force is large, and left out if that is
 * less than 2 pixels; those of contacts are as wide, those of stresses as long, and left out below
 * a twentieth. */
static void visit_force(film *f, int kind, point from, point force, point side, visitor *visit)
{
    double *most = &f->most[scale_of(kind)];
    const double size = hypot(force.x, force.y), share = fmin(1, size / *most);
    const double pixels = f->length[kind] * (is_contact(kind) ? 1 : share);
    const double before = has_two_heads(kind) ? 0.5 : force.x * side.x + force.y * side.y < 0;
    const point d = { pixels / size * force.x, pixels / size * force.y };

    if (!isfinite(size + from.x + from.y) || size == 0)
        return;
    if (!visit && !is_stress(kind))     /* the largest is looked for */
        *most = fmax(*most, size);
    if (!visit || share < (has_two_heads(kind) ? 0.05 : 2.0 / ARROW))
        return;
    f->seen[kind] = 1;
    from = (point){ from.x - before * d.x / f->scale, from.y - before * d.y / f->scale };
    visit(f, kind, from, d, is_stress(kind) ? 1 : share);
}

/* y of vertex v as it is, though displacements may be magnified. */
static double height(const film *f, int frame, int v)
{
    const double start = position(f, 0, v).y, scale = f->s->scale > 0 ? f->s->scale : 1;

    return start + (position(f, frame, v).y - start) / scale;
}

/* Arrows along a loaded edge, 10 pixels apart or more: of what varies, at the Gauss points; of
 * water, what presses there. To be measured (visit NULL), at both ends. */
static void visit_edge(film *f, int frame, const scene_line *l, point *last, visitor *visit)
{
    const point a = position(f, frame, l->a), b = position(f, frame, l->b);
    const double length = gap(a, b);
    const point side = { (b.y - a.y) / length, (a.x - b.x) / length };
    const int wet = l->weight > 0, varies = l->loads > 1 && !wet;
    const int n = varies ? l->loads : visit ? (int)fmax(1, length * f->scale / 16) : 2;

    for (int i = 0; i < n; i++) {
        const double *q = wet ? (double [2]){ 0, 0 } : l->q[varies ? i : 0];
        double s = visit ? (i + 0.5) / n : i, weight;
        if (varies)
            bbm_gauss_point(i, &s, &weight);
        const point x = { a.x + s * (b.x - a.x), a.y + s * (b.y - a.y) };
        if (visit && gap(x, *last) * f->scale < 10)
            continue;
        *last = x;
        const double y = (1 - s) * height(f, frame, l->a) + s * height(f, frame, l->b);
        const double p = l->pressure + l->weight * fmax(0, l->level - y);
        visit_force(f, wet ? WATER : LINE_LOAD, x, (point){ q[0] - p * side.x, q[1] - p * side.y },
                    side, visit);
    }
}

/* All arrows of a kind in a frame, those shorter than 2 pixels left out. */
static void visit_forces(film *f, int frame, int kind, visitor *visit)
{
    const bbm_model *m = f->m;
    const scene_frame *g = &f->s->frame[frame];
    point last = { INFINITY, 0 };

    for (int i = 0; kind == LOAD && i < m->nodes; i++) {
        const scene_vertex *a = &g->vertex[m->adjacent[m->adjacent_first[i]]];
        visit_force(f, kind, a->at, a->load, f->normal[i], visit);
    }
    for (int i = 0; kind == LINE_LOAD && i < m->line_loads; i++) {
        const bbm_line_load *l = &m->line_load[i];
        visit_edge(f, frame, &(scene_line){ l->a, l->b, l->constant ? 1 : BBM_GAUSS, l->f,
                                              0, 0, 0 }, &last, visit);
    }
    scene_line l;
    for (int i = 0; i < g->lines && scene_edge_load(m, i, &l); i++)
        if (kind == (l.weight > 0 ? WATER : LINE_LOAD))
            visit_edge(f, frame, &l, &last, visit);
    for (int i = 0; i < g->forces; i++)
        if (g->force[i].kind == kind && !(is_stress(kind) && f->hidden[i / 2]))
            visit_force(f, kind, g->force[i].at, g->force[i].force, (point){ 0, 0 }, visit);
}

/* The supports of blocks that are not held as a whole, those of one kind 8 pixels apart or more. */
static void visit_supports(film *f, int frame, visitor *visit)
{
    point last[4] = { { 0, 0 }, { INFINITY, 0 }, { INFINITY, 0 }, { INFINITY, 0 } };

    for (const body *b = f->body; b < f->body + f->bodies; b++)
        for (int k = 0, v = b->first; k < b->n && !b->held; k++, v = f->next[v]) {
            const int held = f->s->frame[frame].vertex[v].held & BBM_XY;
            const point x = position(f, frame, v);
            point d = f->normal[f->m->vertex[v].node];
            if (held == 0 || gap(x, last[held]) * f->scale < 8)
                continue;
            last[held] = x;
            f->supports[held] = 1;
            if (held != BBM_XY)                         /* a roller stands along an axis */
                d = held == BBM_X ? (point){ d.x < 0 ? -1 : 1, 0 } : (point){ 0, d.y > 0 ? 1 : -1 };
            const double l = hypot(d.x, d.y);
            d = l > 0 ? (point){ SUPPORT * d.x / l, SUPPORT * d.y / l } : (point){ 0, -SUPPORT };
            visit(f, held, x, d, 1);
        }
}

/* From pixel a along d, with room for heads, which are 1.6 widths long. */
static void put_shaft(film *f, int kind, point a, point d, double share)
{
    const double l = hypot(d.x, d.y), most = l / (is_stress(kind) ? 8 : 4);
    const double w = fmax(0.5, fmin(arrow[kind].width, most) * share);
    const double head = 1.6 * w / l, before = has_two_heads(kind) * head;
    char style[40];

    snprintf(style, sizeof style, "stroke-width=\"%.2g\"", w);
    plot_line(&f->p, style, a.x + before * d.x, a.y + before * d.y, a.x + (1 - head) * d.x,
              a.y + (1 - head) * d.y);
}

static void put_arrow(film *f, int kind, point from, point size, double share)
{
    put_shaft(f, kind, pixel(f, from), (point){ size.x, -size.y }, share);
}

/* What the arrows of a kind have in common. */
static void begin_arrows(film *f, int kind)
{
    plot_put(&f->p, "<g stroke=\"%s\" marker-end=\"url(#head%d)\"", arrow[kind].colour, kind);
    plot_put(&f->p, has_two_heads(kind) ? " marker-start=\"url(#head%d)\">\n" : ">\n", kind);
}

/* A triangle or, in one direction, a roller, and the ground. */
static void put_support(film *f, int held, point from, point size, double share)
{
    const point a = pixel(f, from), d = { size.x, -size.y }, b = { a.x + d.x, a.y + d.y };

    (void)share;
    plot_point(&f->p, "M", a.x, a.y);
    if (held == BBM_XY) {
        plot_point(&f->p, " ", b.x - 0.5 * d.y, b.y + 0.5 * d.x);
        plot_point(&f->p, " ", b.x + 0.5 * d.y, b.y - 0.5 * d.x);
    } else {
        plot_point(&f->p, "A5 5 0 0 1 ", b.x, b.y);
        plot_point(&f->p, "A5 5 0 0 1 ", a.x, a.y);
    }
    plot_point(&f->p, "zM", b.x - 0.7 * d.y, b.y + 0.7 * d.x);
    plot_point(&f->p, " ", b.x + 0.7 * d.y, b.y - 0.7 * d.x);
}

#define THRUST "fill=\"none\" stroke=\"#ee7733\" stroke-width=\"2.5\" stroke-linecap=\"round\""

/* What a block feels of two others, and the third time of all the rest: how many touch it, 3 for
 * more, which, and the forces on it, with the sums of N and of N times the place, then the mean
 * place; whether a line of thrust goes through it. */
typedef struct { int n, line, other[3]; point at[3], force[3]; double N[3]; } neighbours;

static void add_force(neighbours *b, const scene_force *c, int side)
{
    const int other = c->block[!side], sign = side ? -1 : 1;
    int k = 0;

    while (k < b->n && k < 2 && b->other[k] != other)
        k++;
    b->n = k < b->n ? b->n : k + 1;
    b->other[k] = other;
    b->at[k] = (point){ b->at[k].x + c->N * c->at.x, b->at[k].y + c->N * c->at.y };
    b->force[k] = (point){ b->force[k].x + sign * c->force.x, b->force[k].y + sign * c->force.y };
    b->N[k] += c->N;
}

/* The line of thrust goes through each block that two others press together: from the point where
 * the force of the one acts to that of the other, the forces within 60 degrees or so of that way.
 * It goes on at both ends, into another line, or into a block that is fixed or that nothing else
 * touches. A film has none: it would be half as large again. */
static void draw_thrust(film *f, int frame)
{
    const scene_frame *g = &f->s->frame[frame];
    neighbours *b = calloc((size_t)f->bodies, sizeof *b), *end = b ? b + f->bodies : b;

    for (int i = 0; i < 2 * g->forces && b; i++)
        add_force(&b[g->force[i / 2].block[i % 2]], &g->force[i / 2], i % 2);
    for (neighbours *k = b; k < end; k++) {
        for (int i = 0; i < 2; i++)
            k->at[i] = (point){ k->at[i].x / k->N[i], k->at[i].y / k->N[i] };
        const point *x = k->at, *F = k->force;
        k->line = k->n == 2 && !f->body[k - b].fixed && k->N[0] > 0 && k->N[1] > 0
                  && (F[0].x - F[1].x) * (x[1].x - x[0].x) + (F[0].y - F[1].y) * (x[1].y - x[0].y)
                     > 0.5 * gap(x[0], x[1]) * (hypot(F[0].x, F[0].y) + hypot(F[1].x, F[1].y));
    }
    for (int i = 0, same = 0; same < 2 * f->bodies && b; i = (i + 1) % (2 * f->bodies), same++) {
        const int other = b[i / 2].other[i % 2];
        if (b[i / 2].line && !b[other].line && !f->body[other].fixed && b[other].n > 1)
            same = b[i / 2].line = 0;
    }
    for (neighbours *k = b; k < end; k++) {
        const point from = pixel(f, k->at[0]), to = pixel(f, k->at[1]);
        if (k->line)
            plot_line(&f->p, THRUST, from.x, from.y, to.x, to.y);
        f->thrust |= k->line;
    }
    free(b);
}

#define BOLT "fill=\"none\" stroke=\"#000000\" stroke-width=\"3\" stroke-linecap=\"round\""

/* Those that hold at the time of the frame. */
static void draw_bolts(film *f, int frame)
{
    for (int k = 0; k < f->s->bolts; k++) {
        const scene_bolt *b = &f->s->bolt[k];
        point end[2] = { { 0, 0 } };
        for (int a = 0; a < 6; a++) {
            const point p = at(f, frame, b->end[a / 3].vertex[a % 3]);
            end[a / 3].x += b->end[a / 3].share[a % 3] * p.x;
            end[a / 3].y += b->end[a / 3].share[a % 3] * p.y;
        }
        if (f->s->frame[frame].time < b->until)
            plot_line(&f->p, BOLT, end[0].x, end[0].y, end[1].x, end[1].y);
    }
}

/* ------------------------------------------------------------------------------------- legend */

static void put_entry(film *f, plot_legend *l, const char *symbol, const char *text)
{
    plot_begin_entry(&f->p, l, text);
    plot_put(&f->p, "%s</g>\n", symbol);
}

/* The longest arrow of a kind, and its force. */
static void put_force_entry(film *f, plot_legend *l, int kind)
{
    static const char *const prefix[] = { "", "k", "M", "G" };
    const double size = f->most[scale_of(kind)];
    const int power = (size >= 1e3) + (size >= 1e6) + (size >= 1e9);
    char text[80];

    snprintf(text, sizeof text, "%s %.3g %s%s%s", arrow[kind].name, size / pow(1000, power),
             prefix[power], arrow[kind].unit,
             is_stress(kind) && f->range[1] > size ? " and more" : "");
    plot_begin_entry(&f->p, l, text);
    begin_arrows(f, kind);
    put_shaft(f, kind, (point){ 0, 0 }, (point){ f->length[kind], 0 }, 1);
    plot_put(&f->p, "</g></g>\n");
}

/* Returns the number of rows. A bar, the whole of which takes the clicks, is full at the last frame.
 */
static int draw_legend(film *f, double x, double y, double room)
{
    plot_legend l = { x, y, room, 0, 0 };
    const int last = f->s->frames - 1;
    char text[60];

    if (f->held)
        put_entry(f, &l, "<rect y=\"-8\" width=\"48\" height=\"16\" fill=\"url(#held)\" "
                  "stroke=\"#000000\"/>", "fixed block");
    if (f->supports[BBM_XY])
        put_entry(f, &l, "<path fill=\"none\" stroke=\"#333333\" d=\"M38 -5l-5 10h10zM31 5h14\"/>",
                  "fixed point");
    if (f->supports[BBM_X] + f->supports[BBM_Y])
        put_entry(f, &l, "<path fill=\"none\" stroke=\"#333333\" d=\"M31 5h14\"/>"
                  "<circle cx=\"38\" r=\"5\" fill=\"none\" stroke=\"#333333\"/>",
                  "fixed in one direction");
    if (f->thrust)
        put_entry(f, &l, "<path " THRUST " d=\"M0 0H48\"/>", "line of thrust");
    if (f->s->bolts)
        put_entry(f, &l, "<path " BOLT " d=\"M0 0H48\"/>", "bolt");
    for (int kind = 0; kind < KINDS; kind++)
        if (f->seen[kind])
            put_force_entry(f, &l, kind);
    if (f->whole && f->s->field && strcmp(field_find(f->s->field)->unit, "Pa") == 0)
        put_entry(f, &l, "", "stress of a block of one element: its mean");
    if (f->s->scale > 0 && f->s->scale != 1) {
        snprintf(text, sizeof text, "displacements × %.12g", f->s->scale);
        put_entry(f, &l, "", text);
    }
    if (f->seconds > 0) {
        const double time = f->s->frame[last].time - f->s->frame[0].time;
        const double all = value_count(f) - 1;
        snprintf(text, sizeof text, "%.2g × real speed", time * all / (last * f->seconds));
        put_entry(f, &l, "", text);
        plot_put(&f->p, "<g id=\"how\" visibility=\"hidden\">");
        put_entry(f, &l, "", "click, space: stop or play");
        put_entry(f, &l, "", "arrow keys: step; Home, End, bar: go there");
        const plot_box b = { x, y + PLOT_ROW * l.rows++ - 6, room, 12 };
        plot_rectangle(&f->p, b, "id=\"bar\" fill=\"#dddddd\" style=\"touch-action: none\"");
        plot_put(&f->p, "<g fill=\"#0072b2\" pointer-events=\"none\">"
                 "<rect x=\"%.1f\" y=\"%.1f\" height=\"%g\"><animate attributeName=\"width\" "
                 "dur=\"%.3gs\" repeatCount=\"indefinite\" values=\"0;%.1f;%.1f\" "
                 "keyTimes=\"0;%.5f;1\"/></rect></g>\n</g>\n",
                 b.x, b.y, b.h, f->seconds, b.w, b.w, last / all);
    }
    return l.rows;
}

/* ----------------------------------------------------------------------------------- the pages */

static void widen_window(film *f, int kind, point from, point size, double share)
{
    (void)kind, (void)share;
    plot_widen(f->window, from.x, from.y);
    plot_widen(f->window, from.x + size.x / f->scale, from.y + size.y / f->scale);
}

/* Crosses of blocks that are held, and where one before them, half as large at least, is nearer
 * than the longest arrow. */
static void hide_crosses(film *f)
{
    const scene_force *cross = f->s->frame[f->s->frames - 1].force;

    for (int i = 0; i < f->m->elements; i++)
        for (int k = i; k >= 0 && !f->hidden[i]; k--)
            f->hidden[i] = k == i ? f->body[cross[2 * i].block[0]].held : !f->hidden[k]
                && gap(cross[2 * i].at, cross[2 * k].at) * f->scale < f->length[TENSION]
                && gap(cross[2 * i].force, cross[2 * i + 1].force)
                   < 2 * gap(cross[2 * k].force, cross[2 * k + 1].force);
}

/* Window and scale. How long an arrow is in metres depends on the scale of the panel, and that on
 * the window, which holds all arrows and has a margin: by repetition. Those of contacts are not
 * longer than the mean of the blocks that can move. The page has about 860 x 660 pixels. */
static void measure(film *f)
{
    double *x = f->window[0], *y = f->window[1];
    const double around = LEFT + RIGHT, over = f->over + UNDER;
    double sizes = 0, blocks = 0;               /* their mean is NaN, and no bound, of none */

    for (const body *b = f->body; b < f->body + f->bodies; b++) {
        blocks += !b->held;
        sizes += b->held ? 0 : fmin(b->box[0][1] - b->box[0][0], b->box[1][1] - b->box[1][0]);
    }
    if (f->s->frames == 1 && !f->s->field)              /* whether there is any */
        draw_thrust(f, 0);
    for (int round = 0; round < 5; round++) {   /* without arrows, the largest force; then with */
        const double element = sqrt(f->w * f->h / f->m->elements);
        for (int kind = 0; kind < KINDS; kind++)
            f->length[kind] = fmax(12, fmin(ARROW, is_contact(kind) ? sizes / blocks * f->scale
                                            : is_stress(kind) ? 0.6 * element : ARROW));
        if (round == 1 && f->s->field && !has_colours(f->s->field))
            hide_crosses(f);
        for (int a = 0; a < 2; a++)
            f->window[a][0] = INFINITY, f->window[a][1] = -INFINITY;
        for (int i = 0; i < f->s->frames; i++) {
            for (int v = 0; v < f->m->vertices; v++)
                plot_widen(f->window, position(f, i, v).x, position(f, i, v).y);
            if (round > 0)
                visit_supports(f, i, widen_window);
            for (int kind = 0; kind < KINDS; kind++)
                visit_forces(f, i, kind, round > 0 ? widen_window : NULL);
        }
        const double more = 0.03 * fmax(x[1] - x[0], y[1] - y[0]);
        const double w = x[1] - x[0] + 2 * more, h = y[1] - y[0] + 2 * more;
        x[0] -= more, y[0] -= more;
        x[1] += more, y[1] += more;
        f->scale = fmin((860 - around) / w, (660 - over) / h);
        f->w = f->scale * w + around;
        f->h = f->scale * h + over;
    }
}

/* Statics takes no time. */
static int is_timed(const film *f) { return f->s->frame[f->s->frames - 1].time > 0; }

static int by_size(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;

    return (x > y) - (x < y);
}

/* Of all frames, in blocks that are free. Returns 0 and errno without memory. */
static int find_colours(film *f)
{
    const field *shown = field_find(f->s->field);
    const plot_quantity q = { .name = shown->label, .unit = shown->unit };
    double *x = calloc((size_t)f->s->frames * (size_t)f->m->vertices, sizeof *x);
    int n = 0;

    errno = ENOMEM;
    if (!x)
        return 0;
    for (const scene_frame *g = f->s->frame; g < f->s->frame + f->s->frames; g++)
        for (int v = 0; v < f->m->vertices; v++)
            if (isfinite(g->vertex[v].value) && !body_of(f, v)->held)
                x[n++] = g->vertex[v].value;
    n = n ? n : 1;
    qsort(x, (size_t)n, sizeof *x, by_size);
    f->range[0] = x[0];
    f->range[1] = x[n - 1];
    const int out = n / (has_colours(f->s->field) ? OUTSIDE : LARGER);
    const double most[2] = { x[out], x[n - 1 - out] };
    f->bar = plot_bar_axis(&q, f->s->limits[0] < f->s->limits[1] ? f->s->limits : most);
    f->most[TENSION] = f->bar.hi / f->bar.scale;
    free(x);
    return 1;
}

/* Opens a page for a panel and, below it, the colours of a field; draws title, legend and axes.
 * What follows until end_panel is cut off at the panel. Lines have no round ends: a block that is
 * gone is one point, which would be a dot. */
static int open_page(film *f, const char *path)
{
    if (!begin_film(f) || (f->s->field && !find_colours(f)))
        return 0;
    const double top = f->s->title ? 36 : 0;
    f->over = is_timed(f) ? OVER : 14;
    measure(f);
    const double width = fmax(f->w, 1.3 * plot_text_width(f->s->title) + MARGIN);
    const double bottom = top + f->h + (has_colours(f->s->field) ? BAR : 0);
    const int rows = draw_legend(f, 0, 0, width - 2 * MARGIN);
    f->panel = (plot_box){ (width - f->w) / 2 + LEFT, top + f->over, f->w - LEFT - RIGHT,
                           f->h - f->over - UNDER };
    plot_open(&f->p, path, width, bottom + PLOT_ROW * rows + 8);
    plot_put(&f->p, "<defs><pattern id=\"held\" width=\"7\" height=\"7\" "
             "patternUnits=\"userSpaceOnUse\" patternTransform=\"rotate(45)\">"
             "<rect width=\"7\" height=\"7\" fill=\"#e4e4e4\"/>"
             "<path d=\"M0 0V7\" stroke=\"#a0a0a0\" stroke-width=\"1.5\"/></pattern>");
    for (int k = 0; k < KINDS; k++)
        plot_put(&f->p, "<marker id=\"head%d\" orient=\"auto-start-reverse\" overflow=\"visible\">"
                 "<path d=\"%s\" fill=\"%s\"/></marker>\n", k,
                 k == PULLED || k == PRESSURE ? "M1.6 -1.3L0 0L1.6 1.3z" : "M0 -1.3L1.6 0L0 1.3z",
                 arrow[k].colour);
    plot_put(&f->p, "</defs>\n");
    plot_title(&f->p, width / 2, 28, f->s->title);
    draw_legend(f, MARGIN, bottom + PLOT_ROW / 2.0, width - 2 * MARGIN);
    plot_draw_frame(&f->p, f->panel, f->window[0], f->window[1]);
    plot_put(&f->p, "<clipPath id=\"panel0\">");
    plot_rectangle(&f->p, f->panel, "");
    plot_put(&f->p, "</clipPath>\n<g clip-path=\"url(#panel0)\" stroke-linejoin=\"round\">\n");
    return 1;
}

static void end_panel(film *f)
{
    plot_put(&f->p, "</g>\n");
    plot_rectangle(&f->p, f->panel, "fill=\"none\" stroke=\"#333333\"");
}

/* Below the panel, over its width. */
static void draw_colours(film *f)
{
    const plot_box b = f->panel, bar = { b.x, b.y + b.h + UNDER + 4, b.w, 16 };

    if (has_colours(f->s->field))
        plot_draw_bar(&f->p, bar, &f->bar, f->range);
}

/* What stands over the blocks of a panel; the time begins at the same place in each frame. */
static void draw_state(film *f, int frame)
{
    char time[60];

    draw_bolts(f, frame);
    plot_put(&f->p, "<path fill=\"#ffffff\" stroke=\"#333333\" d=\"");
    visit_supports(f, frame, put_support);
    plot_put(&f->p, "\"/>\n");
    for (int kind = 0; kind < KINDS; kind++) {
        if (!f->seen[kind])
            continue;
        begin_arrows(f, kind);
        visit_forces(f, frame, kind, put_arrow);
        plot_put(&f->p, "</g>\n");
    }
    if (f->thrust)
        draw_thrust(f, frame);
    snprintf(time, sizeof time, "t = %.6g s", f->s->frame[frame].time);
    plot_text(&f->p, f->panel.x + f->panel.w / 2 - 32, f->panel.y - 12, "",
              is_timed(f) ? time : NULL);
}

/* A click or the space bar stops and plays, the arrow keys step by a frame, Home and End go to the
 * first and the last, the bar goes to where it is pressed and follows the pointer, and the film
 * fills the window. Where scripts do not run, it plays. */
static void put_script(film *f)
{
    plot_put(&f->p, "<script>\nconst film = document.documentElement;\n"
             "const step = %.6g, end = %d * step, bar = document.getElementById('bar');\n"
             "document.getElementById('how').setAttribute('visibility', 'visible');\n"
             "film.setAttribute('width', '100%%'), film.setAttribute('height', '100%%');\n"
             "const play = () => film.animationsPaused() ? film.unpauseAnimations() :\n"
             "    film.pauseAnimations();\n", f->seconds / (value_count(f) - 1), f->s->frames - 1);
    plot_put(&f->p, "let held = false;\nconst go = (to) => {\n    film.pauseAnimations();\n"
             "    film.setCurrentTime(Math.max(0, to));\n};\nconst drag = (e) => {\n"
             "    const b = bar.getBoundingClientRect();\n    if (!held || !e.buttons) return;\n"
             "    go(end * Math.min(1, (e.clientX - b.left) / b.width));\n};\n"
             "film.onpointerdown = (e) => { held = e.target === bar; drag(e); };\n"
             "film.onpointermove = drag;\nfilm.onclick = () => held || play();\n");
    plot_put(&f->p, "window.onkeydown = (e) => {\n    const now = film.getCurrentTime();\n"
             "    const to = { ArrowLeft: now - step, ArrowRight: now + step,\n"
             "                 Home: 0, End: end }[e.key];\n    if (e.key === ' ') play();\n"
             "    if (to !== undefined) go(to), e.preventDefault();\n};\n</script>\n");
}

/* The state of a frame is a group that is visible from half an interval before it to half an
 * interval behind it, the last one to the end; at first the first. */
int scene_write_movie(const scene *s, const bbm_model *m, const char *path)
{
    film f = { .s = s, .m = m };
    const int intervals = value_count(&f) - 1;

    if (s->frames > 1)
        f.seconds = fmin(fmax(s->frame[s->frames - 1].time - s->frame[0].time, 6), 12);
    int done = open_page(&f, path);
    if (done) {
        draw_blocks(&f, 0, 1);
        end_panel(&f);
        draw_colours(&f);
        for (int k = 0; k < s->frames && f.seconds > 0; k++) {
            plot_put(&f.p, "<g%s><animate attributeName=\"visibility\" calcMode=\"discrete\" "
                     "dur=\"%.3gs\" repeatCount=\"indefinite\" values=\"hidden;visible;hidden\" "
                     "keyTimes=\"0;%.5f;%.5f\"/>\n", k ? " visibility=\"hidden\"" : "",
                     f.seconds, fmax(0, (k - 0.5) / intervals),
                     k == s->frames - 1 ? 1 : (k + 0.5) / intervals);
            draw_state(&f, k);
            plot_put(&f.p, "</g>\n");
        }
        if (f.seconds > 0)
            put_script(&f);
        else
            draw_state(&f, 0);
        done = plot_close(&f.p);
    }
    end_film(&f);
    return done;
}

/* --------------------------------------------------------------------------------------- maps */

typedef struct { double x, y, value; } sample;     /* pixels */

/* By so much the displacements d can be magnified that no edge changes, in length or direction, by
 * more than FAIR of its element's width: its area by its longest edge, of a triangle twice that,
 * which is its least height. Before it turns over an edge changes by all of it. 1, 2 or 5 times a
 * power of ten, 1 at least. */
static double find_scale(const scene *s, const bbm_model *m)
{
    const scene_vertex *x = s->frame[0].vertex, *d = s->frame[1].vertex;
    double range[2][2] = { { INFINITY, -INFINITY }, { INFINITY, -INFINITY } };
    double moved = 0, fair = INFINITY;

    for (int v = 0; v < m->vertices; v++) {
        plot_widen(range, x[v].at.x, x[v].at.y);
        moved = fmax(moved, hypot(d[v].at.x, d[v].at.y));
    }
    for (const bbm_element *i = m->element; i < m->element + m->elements; i++) {
        double longest = 0, change = 0;
        for (int a = i->first; a < i->first + i->n; a++) {
            const int b = bbm_next_vertex(i, a);
            longest = fmax(longest, gap(x[a].at, x[b].at));
            change = fmax(change, gap(d[a].at, d[b].at));
        }
        fair = fmin(fair, FAIR * (i->n == 3 ? 2 : 1) * i->A0 / longest / change);
    }
    const double size = fmax(range[0][1] - range[0][0], range[1][1] - range[1][0]);
    double scale = moved > 1e-12 * size ? plot_nice(fmin(0.1 * size / moved, MOST)) : 1;
    while (scale > 1 && scale > fair)
        scale = plot_nice(scale / 2.2);
    return fmax(scale, 1);
}

/* The part of a convex polygon where sign * (value - level) >= 0; returns its number of corners. */
static int clip(const sample in[], int n, double level, double sign, sample out[])
{
    int count = 0;

    for (int i = 0; i < n; i++) {
        const sample a = in[i], b = in[(i + 1) % n];
        const int stays = sign * (a.value - level) >= 0;
        if (stays)
            out[count++] = a;
        if (stays == (sign * (b.value - level) >= 0))
            continue;
        const double t = (level - a.value) / (b.value - a.value);
        out[count++] = (sample){ a.x + t * (b.x - a.x), a.y + t * (b.y - a.y), level };
    }
    return count;
}

static sample sample_of(const film *f, int frame, int v)
{
    return (sample){ at(f, 1, v).x, at(f, 1, v).y, f->s->frame[frame].vertex[v].value };
}

/* The share of an element, triangle by triangle, in the band from level[0] to level[1]. */
static void put_share(film *f, int frame, const bbm_element *e, const double level[2])
{
    const int parts = e->n == 3 ? 1 : e->n, end = e->first + e->n;
    sample t[3] = { { 0, 0, 0 } }, above[4], band[5];

    for (int v = end - parts; v < end; v++) {           /* the mean point, or the third */
        const sample a = sample_of(f, frame, v);
        t[2] = (sample){ t[2].x + a.x / parts, t[2].y + a.y / parts, t[2].value + a.value / parts };
    }
    for (int v = e->first; v < e->first + parts; v++) {
        t[0] = sample_of(f, frame, v);
        t[1] = sample_of(f, frame, bbm_next_vertex(e, v));
        const double a = t[0].value, b = t[1].value, c = t[2].value;
        if (fmax(a, fmax(b, c)) < level[0] || fmin(a, fmin(b, c)) >= level[1])
            continue;
        const int n = clip(above, clip(t, 3, level[0], 1, above), level[1], -1, band);
        for (int i = 0; i < n && n >= 3; i++)
            plot_point(&f->p, i ? " " : "M", band[i].x, band[i].y);
        plot_put(&f->p, n >= 3 ? "z\n" : "");
    }
}

/* The values of a frame. */
static void draw_bands(film *f, int frame)
{
    const plot_axis *bar = &f->bar;
    const int bands = plot_bands(bar);

    for (int k = 0; k < bands; k++) {
        const double from = (bar->lo + k * bar->step) / bar->scale, step = bar->step / bar->scale;
        const double level[2] = { k ? from : -INFINITY, k < bands - 1 ? from + step : INFINITY };
        const plot_colour fill = plot_value_colour(bar, from + step / 2);
        plot_put(&f->p, "<path fill=\"%s\" stroke=\"%s\" stroke-width=\"0.6\" d=\"",
                 fill.text, fill.text);
        for (const bbm_element *e = f->m->element; e < f->m->element + f->m->elements; e++)
            if (!f->body[e->block].held)
                put_share(f, frame, e, level);
        plot_put(&f->p, "\"/>\n");
    }
}

/* Of all blocks what `put` draws of one. */
static void draw_lines(film *f, int frame, const char *stroke, writer *put)
{
    plot_put(&f->p, "<path fill=\"none\" %s d=\"", stroke);
    for (int b = 0; b < f->bodies; b++)
        put(f, frame, &f->body[b]);
    plot_put(&f->p, "\"/>\n");
}

/* Below all the boundaries where they were; bands, the lines of the mesh, the boundaries where they
 * are. */
int scene_write_map(const scene *choices, const bbm_model *m, const char *path)
{
    scene_frame state[2] = { { .time = m->info.t }, { .time = m->info.t } };
    const field *shown = field_find(choices->field);
    scene s = *choices;
    film f = { .s = &s, .m = m };
    int done = 0, nodal = has_colours(choices->field);

    s.frames = 2;
    s.frame = state;
    s.failed = 0;
    errno = ENOMEM;
    if (make_frame(&state[0], m) && make_frame(&state[1], m)) {
        errno = EDOM;
        done = fill_frame(&state[0], m, shown, nodal, (double[]){ 1, 0 })
               && fill_frame(&state[1], m, shown, nodal, (double[]){ 0, 1 });
        s.scale = s.scale == 0 && done ? find_scale(&s, m) : fmax(0, s.scale);
        fill_frame(&state[1], m, shown, nodal, (double[]){ 1, s.scale });
        state[0].lines = 0;                     /* an outline: nothing presses on it */
        done = done && open_page(&f, path);
    }
    if (done) {
        draw_lines(&f, 0, "stroke=\"#666666\"", put_outline);
        if (nodal)
            draw_bands(&f, 1);
        draw_blocks(&f, 1, 0);
        draw_lines(&f, 1, "stroke=\"#000000\" stroke-width=\"0.4\" stroke-opacity=\"0.45\"",
                   put_elements);
        draw_lines(&f, 1, "stroke=\"#000000\"", put_outline);
        end_panel(&f);
        draw_state(&f, 1);
        draw_colours(&f);
        done = plot_close(&f.p);
    }
    end_film(&f);
    drop_frame(&state[0]);
    drop_frame(&state[1]);
    return done;
}
