/* scene.c - blocks that move, as SVG.
 *
 * All frames of a scene share one window, so that panels can be compared and the film stands still. The frame with
 * its axes is an empty map of plot.c, which also gives the scale from metres to pixels.
 *
 * A block is one group of two paths: its elements, filled, with thin lines, and over them its boundary edges. In the
 * film a block is moved in the cheapest way that is right to a third of a pixel:
 *
 *     it stays                              the group alone
 *     it moves like a rigid body            the group is shifted and turned: a few numbers per frame
 *     it visibly changes its shape          both paths are given anew for each frame
 *
 * A browser plays <animate> elements of equal duration side by side; each lists one value per frame and goes in a
 * straight line from one to the next. The last value is repeated, so that the end can be looked at. What cannot be
 * interpolated, the time and the forces, is a group per frame that is visible at its turn.
 *
 * Fills carry no meaning; grey hatching does: a block that is held at two points or more. The tints are those of
 * Okabe and Ito, lightened, so that the colour-blind can tell them apart and arrows can be seen on them.
 */
#include "scene.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "plot.h"

enum { FRAMES = 60, HOLD = 6, AROUND = 108, OVER = 100, ROW = 26, ARROW = 48, MARGIN = 20 };
                                                            /* kept; values repeated at the end; the rest in pixels */

static const double VISIBLE = 0.3;      /* pixels: what moves less stays, what bends less is rigid  */
static const double LETTER = 7.8;       /* pixels, generous mean width of a letter                  */

typedef struct { double x, y; } point;

typedef struct {                        /* what the functions below draw with */
    plot         p;
    const scene *s;
    const bbm_model *m;
    double       x[2], y[2];            /* m        the window                                         */
    double       newton;                /* pixels/N length of an arrow                                 */
    double       seconds;               /* of one pass; zero: nothing moves                            */
} film;

/* ----------------------------------------------------------------------------------------------- recording */

static void drop_frame(scene_frame *f)
{
    free(f->at);
    free(f->force);
    *f = (scene_frame){ 0 };
}

void scene_free(scene *s)
{
    for (int k = 0; k < s->frames; k++) drop_frame(&s->frame[k]);
    free(s->frame);
    s->frame = NULL;
    s->frames = s->vertices = s->calls = s->every = s->failed = 0;
}

static int most_frames(const scene *s)
{
    return s->most >= 2 ? s->most : FRAMES;
}

/* Makes room for one more: the last frame only stays if its turn has come, and half of them go if all have come. */
static void thin_out(scene *s)
{
    int kept = s->frames;
    if (kept && s->frame[kept - 1].call % s->every) drop_frame(&s->frame[--kept]);
    if (kept == most_frames(s)) {
        const int n = kept;
        s->every *= 2;
        kept = 0;
        for (int k = 0; k < n; k++)
            if (s->frame[k].call % s->every) drop_frame(&s->frame[k]);
            else s->frame[kept++] = s->frame[k];
    }
    s->frames = kept;
}

static int copy_frame(scene_frame *f, const bbm_model *m, int forces, const scene_force *force)
{
    f->at = malloc((size_t)m->vertices * sizeof *f->at);
    f->force = forces ? malloc((size_t)forces * sizeof *f->force) : NULL;
    if (!f->at || (forces && !f->force)) {
        drop_frame(f);
        return 0;
    }
    for (int v = 0; v < m->vertices; v++) {
        f->at[v][0] = m->vertex[v].x;
        f->at[v][1] = m->vertex[v].y;
    }
    if (forces) memcpy(f->force, force, (size_t)forces * sizeof *force);
    return 1;
}

int scene_record(scene *s, const bbm_model *m, double time, int forces, const scene_force *force)
{
    scene_frame f = { .time = time, .call = s->calls++, .forces = forces };
    for (int v = 0; v < m->vertices; v++)
        if (!isfinite(m->vertex[v].x + m->vertex[v].y)) return 0;
    if (!s->frame) {
        s->frame = calloc((size_t)most_frames(s), sizeof *s->frame);
        s->vertices = m->vertices;
        s->every = 1;
    }
    if (!s->frame || m->vertices != s->vertices || !copy_frame(&f, m, forces, force)) s->failed = 1;
    if (s->failed) {
        drop_frame(&f);
        return 0;
    }
    thin_out(s);
    s->frame[s->frames++] = f;
    return 1;
}

/* ---------------------------------------------------------------------------------------------- the window */

static void widen(double range[2], double value)
{
    range[0] = fmin(range[0], value);
    range[1] = fmax(range[1], value);
}

/* The window, and the scale of the forces. */
static void measure(film *f)
{
    const double *w = f->s->window;
    double largest = f->s->longest;
    f->x[0] = f->y[0] = INFINITY;
    f->x[1] = f->y[1] = -INFINITY;
    for (int k = 0; k < f->s->frames; k++) {
        const scene_frame *g = &f->s->frame[k];
        for (int v = 0; v < f->s->vertices; v++) {
            widen(f->x, g->at[v][0]);
            widen(f->y, g->at[v][1]);
        }
        for (int i = 0; i < g->forces && f->s->longest <= 0; i++)
            if (g->force[i].state != SCENE_OPEN) largest = fmax(largest, hypot(g->force[i].fx, g->force[i].fy));
    }
    if (w[0] < w[1] && w[2] < w[3]) {
        f->x[0] = w[0], f->x[1] = w[1];
        f->y[0] = w[2], f->y[1] = w[3];
    }
    f->newton = largest > 0 ? ARROW / largest : 0;
}

static point at(const film *f, int frame, int vertex)
{
    const double *x = f->s->frame[frame].at[vertex];
    return (point){ plot_pixel(&f->p.x, x[0]), plot_pixel(&f->p.y, x[1]) };
}

/* Two decimals, without trailing zeros. */
static void put_point(film *f, const char *before, double x, double y)
{
    plot_put(&f->p, "%s%.8g %.8g", before, floor(x * 100 + 0.5) / 100, floor(y * 100 + 0.5) / 100);
}

static void put_frame(film *f, const char *attributes)
{
    plot_put(&f->p, "<rect x=\"%.2f\" y=\"%.2f\" width=\"%.2f\" height=\"%.2f\" %s/>\n", f->p.x.from, f->p.y.to,
             f->p.x.to - f->p.x.from, f->p.y.from - f->p.y.to, attributes);
}

/* The frame with its axes; what follows until end_panel is cut off at it. */
static void begin_panel(film *f, plot_box box, int number)
{
    static const int first[1] = { 0 };
    const plot_map axes = { .mesh = { 2, 0, f->x, f->y, first, NULL } };
    plot_draw_map(&f->p, box, &axes);
    plot_put(&f->p, "<clipPath id=\"panel%d\">", number);
    put_frame(f, "");
    plot_put(&f->p, "</clipPath>\n<g clip-path=\"url(#panel%d)\" ", number);
    plot_put(&f->p, "stroke-linejoin=\"round\" stroke-linecap=\"round\">\n");
}

static void end_panel(film *f)
{
    plot_put(&f->p, "</g>\n");
    put_frame(f, "fill=\"none\" stroke=\"#333333\"");
}

/* --------------------------------------------------------------------------------------------------- blocks */

static int begins_block(const bbm_model *m, int e)
{
    for (int i = e - 1; i >= 0; i--)
        if (m->element[i].block == m->element[e].block) return 0;
    return 1;
}

static int has_vertex(const bbm_model *m, int block, int v)
{
    return m->element[m->vertex[v].element].block == block;
}

/* Whether a block is held at two points: it cannot move as a whole. */
static int is_held(const bbm_model *m, int block)
{
    int first = -1;
    for (int v = 0; v < m->vertices; v++) {
        const int n = m->vertex[v].node;
        if (!has_vertex(m, block, v) || m->node[n].held != BBM_XY || n == first) continue;
        if (first >= 0) return 1;
        first = n;
    }
    return 0;
}

/* The polygons of a block's elements, in pixels from o. */
static void put_elements(film *f, int frame, int block, point o)
{
    for (int i = 0; i < f->m->elements; i++) {
        const bbm_element *e = &f->m->element[i];
        if (e->block != block) continue;
        for (int k = 0; k < e->n; k++) {
            const point a = at(f, frame, e->first + k);
            put_point(f, k ? " " : "M", a.x - o.x, a.y - o.y);
        }
        plot_put(&f->p, "z");
    }
}

/* The boundary edges of a block, one that starts where the last one ended without a new start. */
static void put_outline(film *f, int frame, int block, point o)
{
    for (int i = 0, last = -1; i < f->m->edges; i++) {
        const bbm_edge *e = &f->m->edge[i];
        if (f->m->element[e->element].block != block) continue;
        const point a = at(f, frame, e->a), b = at(f, frame, e->b);
        if (e->a != last) put_point(f, "M", a.x - o.x, a.y - o.y);
        put_point(f, " ", b.x - o.x, b.y - o.y);
        last = e->b;
    }
}

typedef void part(film *f, int frame, int block, point o);

/* What it is, with its attributes; a list of values follows. */
static void begin_animation(film *f, const char *what)
{
    plot_put(&f->p, "<%s dur=\"%.3gs\" repeatCount=\"indefinite\" values=\"", what, f->seconds);
}

/* The frame of the i-th value of an animation; the number of values. */
static int shown_frame(const film *f, int i)
{
    return i < f->s->frames ? i : f->s->frames - 1;
}

static int value_count(const film *f)
{
    return f->s->frames + HOLD;
}

static void put_part(film *f, int frame, int block, point o, int changes, part *draw)
{
    const char *line = "fill=\"none\" stroke=\"#000000\" stroke-width=\"1.3\"";
    plot_put(&f->p, "<path %s d=\"", draw == put_outline ? line : "");
    draw(f, frame, block, o);
    plot_put(&f->p, changes ? "\">" : "\"/>\n");
    if (!changes) return;
    begin_animation(f, "animate attributeName=\"d\"");
    for (int i = 0; i < value_count(f); i++) {
        draw(f, shown_frame(f, i), block, o);
        plot_put(&f->p, i + 1 < value_count(f) ? ";" : "\"/></path>\n");
    }
}

typedef struct {                        /* of a block from the first frame to another, in pixels */
    point  C, c;                        /* centre then and now                                   */
    double angle;                       /* rad      as a rigid body turns, clockwise             */
    double error;                       /* largest distance of a vertex from there               */
    double moved;                       /* largest distance of a vertex from its first place     */
} motion;

/* The rigid motion that fits best: with X, x from the centre then and now, tan(angle) = sum X cross x / sum X.x;
 * of all such angles the one nearest to `before`. */
static motion fit(const film *f, int frame, int block, double before)
{
    const double turn = 2 * acos(-1);
    motion r = { { 0, 0 }, { 0, 0 }, 0, 0, 0 };
    double n = 0, cross = 0, dot = 0;
    for (int v = 0; v < f->m->vertices; v++) {
        if (!has_vertex(f->m, block, v)) continue;
        const point A = at(f, 0, v), a = at(f, frame, v);
        n++;
        r.C = (point){ r.C.x + (A.x - r.C.x) / n, r.C.y + (A.y - r.C.y) / n };
        r.c = (point){ r.c.x + (a.x - r.c.x) / n, r.c.y + (a.y - r.c.y) / n };
        r.moved = fmax(r.moved, hypot(a.x - A.x, a.y - A.y));
    }
    for (int v = 0; v < f->m->vertices; v++) {
        if (!has_vertex(f->m, block, v)) continue;
        const point A = at(f, 0, v), a = at(f, frame, v);
        cross += (A.x - r.C.x) * (a.y - r.c.y) - (A.y - r.C.y) * (a.x - r.c.x);
        dot += (A.x - r.C.x) * (a.x - r.c.x) + (A.y - r.C.y) * (a.y - r.c.y);
    }
    r.angle = atan2(cross, dot);
    r.angle += turn * floor((before - r.angle) / turn + 0.5);
    for (int v = 0; v < f->m->vertices; v++) {
        if (!has_vertex(f->m, block, v)) continue;
        const point A = at(f, 0, v), a = at(f, frame, v), X = { A.x - r.C.x, A.y - r.C.y };
        r.error = fmax(r.error, hypot(a.x - r.c.x - cos(r.angle) * X.x + sin(r.angle) * X.y,
                                      a.y - r.c.y - sin(r.angle) * X.x - cos(r.angle) * X.y));
    }
    return r;
}

typedef enum { STAYS, IS_RIGID, CHANGES } kind;

static kind find_kind(const film *f, int block)
{
    kind k = STAYS;
    for (int i = 1; i < f->s->frames && f->seconds > 0; i++) {
        const motion r = fit(f, i, block, 0);
        if (r.error > VISIBLE) return CHANGES;
        if (r.moved > VISIBLE) k = IS_RIGID;
    }
    return k;
}

/* The animations of a group that is shifted, and of the group in it that is turned. */
static void put_motion(film *f, int block)
{
    begin_animation(f, "animateTransform attributeName=\"transform\" type=\"translate\"");
    for (int i = 0; i < value_count(f); i++) {
        const motion r = fit(f, shown_frame(f, i), block, 0);
        put_point(f, i ? ";" : "", r.c.x, r.c.y);
    }
    plot_put(&f->p, "\"/><g>");
    begin_animation(f, "animateTransform attributeName=\"transform\" type=\"rotate\"");
    for (double i = 0, angle = 0; i < value_count(f); i++) {
        angle = fit(f, shown_frame(f, (int)i), block, angle).angle;
        plot_put(&f->p, "%s%.6g", i > 0 ? ";" : "", floor(angle * 180 / acos(-1) * 100 + 0.5) / 100);
    }
    plot_put(&f->p, "\"/>\n");
}

static void draw_block(film *f, int frame, int block)
{
    static const char *const fill[] = { "#f6cf8b", "#b3dcf5", "#8fd3bd", "#f7f0a6", "#e6c3d7" };
    const kind k = find_kind(f, block);
    const point o = k == IS_RIGID ? fit(f, frame, block, 0).c : (point){ 0, 0 };
    if (is_held(f->m, block)) plot_put(&f->p, "<g fill=\"url(#held)\" ");
    else plot_put(&f->p, "<g fill=\"%s\" ", fill[abs(block % 5)]);
    plot_put(&f->p, "stroke=\"#667788\" stroke-width=\"0.5\"");
    if (k == IS_RIGID) plot_put(&f->p, " transform=\"translate(%.2f %.2f)\"", o.x, o.y);
    plot_put(&f->p, ">\n");
    if (k == IS_RIGID) put_motion(f, block);
    put_part(f, frame, block, o, k == CHANGES, put_elements);
    put_part(f, frame, block, o, k == CHANGES, put_outline);
    plot_put(&f->p, k == IS_RIGID ? "</g></g>\n" : "</g>\n");
}

static void draw_blocks(film *f, int frame)
{
    for (int e = 0; e < f->m->elements; e++)
        if (begins_block(f->m, e)) draw_block(f, frame, f->m->element[e].block);
}

/* ------------------------------------------------------------------------------------ forces, marks, legend */

static const char *const state_style[3] = { "", "stroke=\"#004488\" stroke-width=\"1.8\"",
                                            "stroke=\"#cc3311\" stroke-width=\"1.8\"" };

static void put_arrow(film *f, point a, double dx, double dy)
{
    const double length = hypot(dx, dy), head = fmin(6, length / 2) / (length > 0 ? length : 1);
    const double hx = head * dx, hy = head * dy;
    const point b = { a.x + dx, a.y + dy };
    put_point(f, "M", a.x, a.y);
    put_point(f, " ", b.x, b.y);
    put_point(f, "M", b.x - hx + 0.5 * hy, b.y - hy - 0.5 * hx);
    put_point(f, " ", b.x, b.y);
    put_point(f, " ", b.x - hx - 0.5 * hy, b.y - hy + 0.5 * hx);
}

/* The contact forces of a frame, state by state; those shorter than a pixel are left out. */
static void draw_forces(film *f, int frame)
{
    const scene_frame *g = &f->s->frame[frame];
    for (int state = SCENE_LOCK; state <= SCENE_SLIDE && g->forces; state++) {
        plot_put(&f->p, "<path fill=\"none\" %s d=\"", state_style[state]);
        for (int i = 0; i < g->forces; i++) {
            const scene_force *c = &g->force[i];
            const double length = f->newton * hypot(c->fx, c->fy);
            if (c->state != state || !(length >= 1) || !isfinite(length + c->x + c->y)) continue;
            put_arrow(f, (point){ plot_pixel(&f->p.x, c->x), plot_pixel(&f->p.y, c->y) }, f->newton * c->fx,
                      -f->newton * c->fy);
        }
        plot_put(&f->p, "\"/>\n");
    }
}

static const char *mark_fill(int k)
{
    static const char *const fill[] = { "#000000", "#ffffff", "#999999" };
    return fill[k % 3];
}

/* A mark with its trace up to a frame; in the film it moves along it. */
static void draw_mark(film *f, int frame, int k)
{
    const int v = f->s->mark[k].vertex;
    if (v < 0 || v >= f->s->vertices) return;
    plot_put(&f->p, "<path fill=\"none\" stroke=\"#000000\" stroke-dasharray=\"3 3\" d=\"");
    for (int i = 0; i < (f->seconds > 0 ? f->s->frames : frame + 1); i++)
        put_point(f, i ? " " : "M", at(f, i, v).x, at(f, i, v).y);
    plot_put(&f->p, "\"/>\n<circle r=\"4.5\" cx=\"%.2f\" cy=\"%.2f\" fill=\"%s\" stroke=\"#000000\">\n",
             at(f, frame, v).x, at(f, frame, v).y, mark_fill(k));
    for (int axis = 0; axis < 2 && f->seconds > 0; axis++) {
        begin_animation(f, axis ? "animate attributeName=\"cy\"" : "animate attributeName=\"cx\"");
        for (int i = 0; i < value_count(f); i++) {
            const point a = at(f, shown_frame(f, i), v);
            plot_put(&f->p, "%s%.2f", i ? ";" : "", axis ? a.y : a.x);
        }
        plot_put(&f->p, "\"/>\n");
    }
    plot_put(&f->p, "</circle>\n");
}

typedef struct { double x, y, width, right; int rows; } legend;   /* from (x, y) on, row by row */

/* One more symbol, ARROW pixels long, and its text. Before the file is open this only counts the rows. */
static void put_entry(film *f, legend *l, const char *symbol, const char *text)
{
    const double w = ARROW + 32 + LETTER * (double)strlen(text);
    if (l->rows == 0 || l->right + w > l->width) {
        l->rows++;
        l->right = 0;
    }
    plot_put(&f->p, "<g transform=\"translate(%.2f %.2f)\">%s\n", l->x + l->right, l->y + ROW * (l->rows - 1), symbol);
    plot_text(&f->p, ARROW + 8, 5, "", text);
    plot_put(&f->p, "</g>\n");
    l->right += w;
}

static void put_force_entries(film *f, legend *l)
{
    char symbol[160], text[40];
    const double longest = ARROW / f->newton;
    const int power = longest >= 1e6 ? 2 : longest >= 1e3;
    for (int state = SCENE_LOCK; state <= SCENE_SLIDE; state++) {
        snprintf(symbol, sizeof symbol, "<path d=\"M0 0H%d\" %s/>", ARROW, state_style[state]);
        put_entry(f, l, symbol, state == SCENE_LOCK ? "locked contact" : "sliding contact");
    }
    snprintf(symbol, sizeof symbol, "<path d=\"M0 0H%dm-6 -3l6 3l-6 3\" fill=\"none\" stroke=\"#000000\"/>", ARROW);
    snprintf(text, sizeof text, "%.3g %sN", longest / pow(1000, power), power == 2 ? "M" : power ? "k" : "");
    put_entry(f, l, symbol, text);
}

/* Returns the number of rows. */
static int draw_legend(film *f, double x, double y, double width)
{
    legend l = { x, y, width, 0, 0 };
    char symbol[160];
    int held = 0;
    for (int e = 0; e < f->m->elements && !held; e++)
        held = begins_block(f->m, e) && is_held(f->m, f->m->element[e].block);
    if (held) put_entry(f, &l, "<rect y=\"-8\" width=\"48\" height=\"16\" fill=\"url(#held)\" stroke=\"#000000\"/>",
                        "fixed block");
    if (f->newton > 0) put_force_entries(f, &l);
    for (int k = 0; k < f->s->marks; k++) {
        snprintf(symbol, sizeof symbol, "<circle cx=\"%d\" r=\"4.5\" fill=\"%s\" stroke=\"#000000\"/>", ARROW - 8,
                 mark_fill(k));
        if (f->s->mark[k].name) put_entry(f, &l, symbol, f->s->mark[k].name);
    }
    return l.rows;
}

/* ------------------------------------------------------------------------------------------------ the pages */

typedef struct { int columns; double top, w, h; } layout;  /* all panels of w x h pixels, below the title */

/* The number of columns that makes n panels largest, on a page of about 1100 x 760 pixels (one panel: 860 x 660). */
static layout arrange(const film *f, int n)
{
    const double more = 0.06 * fmax(f->x[1] - f->x[0], f->y[1] - f->y[0]);
    const double w = f->x[1] - f->x[0] + more, h = f->y[1] - f->y[0] + more;
    layout best = { 1, f->s->title ? 36 : 8, 0, 0 };
    double largest = 0;
    for (int c = 1; c <= n; c++) {
        const int rows = (n + c - 1) / c;
        const double scale = fmin(((n > 1 ? 1100 : 860) / c - AROUND) / w, ((n > 1 ? 760.0 : 660.0) / rows - OVER) / h);
        if (scale <= largest) continue;
        largest = scale;
        best.columns = c;
    }
    best.w = largest * w + AROUND;
    best.h = largest * h + OVER;
    return best;
}

/* Opens a page for n panels and draws title and legend. */
static int open_page(film *f, const char *path, int n, layout *l)
{
    errno = f->s->failed ? ENOMEM : EINVAL;
    if (f->s->failed || f->s->frames < 1 || n < 1 || f->m->vertices != f->s->vertices) return 0;
    measure(f);
    *l = arrange(f, n);
    const double width = fmax(l->columns * l->w, f->s->title ? LETTER * 1.3 * (double)strlen(f->s->title) + MARGIN : 0);
    const double bottom = l->top + l->h * ((n + l->columns - 1) / l->columns);
    const int rows = draw_legend(f, 0, 0, width - 2 * MARGIN);
    if (!plot_open(&f->p, path, width, bottom + ROW * rows + 8)) return 0;
    plot_put(&f->p, "<defs><pattern id=\"held\" width=\"7\" height=\"7\" patternUnits=\"userSpaceOnUse\" "
             "patternTransform=\"rotate(45)\"><rect width=\"7\" height=\"7\" fill=\"#e4e4e4\"/>"
             "<path d=\"M0 0V7\" stroke=\"#a0a0a0\" stroke-width=\"1.5\"/></pattern></defs>\n");
    plot_text(&f->p, width / 2, 28, "text-anchor=\"middle\" font-size=\"17\" font-weight=\"bold\"", f->s->title);
    draw_legend(f, MARGIN, bottom + ROW / 2.0, width - 2 * MARGIN);
    return 1;
}

/* Decimals that tell the frames apart, of whole steps as many as they have. */
static void time_text(char *text, size_t size, const scene *s, double time)
{
    const double apart = s->frames > 1 ? s->frame[1].time - s->frame[0].time : 0;
    int decimals = 0;
    for (double d = fabs(apart); decimals < 6 && fabs(d - floor(d + 0.5)) > 1e-6 * d; d *= 10) decimals++;
    snprintf(text, size, "t = %.*f s", decimals, time);
}

/* Above the panel. */
static void put_time(film *f, const char *text)
{
    plot_text(&f->p, (f->p.x.from + f->p.x.to) / 2, f->p.y.to - 12, "text-anchor=\"middle\"", text);
}

int scene_write_panels(const scene *s, const bbm_model *m, const char *path, int n, const double time[])
{
    film f = { .s = s, .m = m };
    layout l;
    char text[60];
    if (!open_page(&f, path, n, &l)) return 0;
    for (int k = 0; k < n; k++) {
        int i = 0;
        for (int j = 1; j < s->frames; j++)
            if (fabs(s->frame[j].time - time[k]) < fabs(s->frame[i].time - time[k])) i = j;
        begin_panel(&f, (plot_box){ k % l.columns * l.w, l.top + k / l.columns * l.h, l.w, l.h }, k);
        draw_blocks(&f, i);
        draw_forces(&f, i);
        for (int j = 0; j < s->marks; j++) draw_mark(&f, i, j);
        end_panel(&f);
        time_text(text, sizeof text, s, s->frame[i].time);
        if (n > 1 || s->frame[i].time > 0) put_time(&f, text);
    }
    return plot_close(&f.p);
}

int scene_write_state(const scene *s, const bbm_model *m, const char *path, int forces, const scene_force *force)
{
    scene now = *s;
    const double time = 0;
    now.frames = now.calls = now.failed = 0;
    now.frame = NULL;
    const int done = scene_record(&now, m, time, forces, force) && scene_write_panels(&now, m, path, 1, &time);
    scene_free(&now);
    return done;
}

/* A group that is visible from half an interval before its frame to half an interval behind it, at first the first. */
static void begin_turn(film *f, int frame)
{
    const int last = f->s->frames - 1, intervals = value_count(f) - 1;
    const double from = (frame - 0.5) / intervals, to = (frame + 0.5) / intervals;
    plot_put(&f->p, "<g%s>", frame ? " visibility=\"hidden\"" : "");
    if (last == 0) return;
    plot_put(&f->p, "<animate attributeName=\"visibility\" calcMode=\"discrete\" ");
    plot_put(&f->p, "dur=\"%.3gs\" repeatCount=\"indefinite\" ", f->seconds);
    if (frame == 0) plot_put(&f->p, "values=\"visible;hidden\" keyTimes=\"0;%.5f\"/>\n", to);
    else if (frame == last) plot_put(&f->p, "values=\"hidden;visible\" keyTimes=\"0;%.5f\"/>\n", from);
    else plot_put(&f->p, "values=\"hidden;visible;hidden\" keyTimes=\"0;%.5f;%.5f\"/>\n", from, to);
}

int scene_write_movie(const scene *s, const bbm_model *m, const char *path)
{
    film f = { .s = s, .m = m };
    layout l;
    char text[60];
    if (!open_page(&f, path, 1, &l)) return 0;
    const double run = s->frame[s->frames - 1].time - s->frame[0].time;
    if (s->frames > 1) f.seconds = s->play > 0 ? s->play : fmin(fmax(run, 4), 12);
    begin_panel(&f, (plot_box){ 0, l.top, l.w, l.h }, 0);
    draw_blocks(&f, 0);
    for (int k = 0; k < s->frames; k++) {
        begin_turn(&f, k);
        draw_forces(&f, k);
        plot_put(&f.p, "</g>\n");
    }
    for (int j = 0; j < s->marks; j++) draw_mark(&f, 0, j);
    end_panel(&f);
    for (int k = 0; k < s->frames; k++) {
        begin_turn(&f, k);
        time_text(text, sizeof text, s, s->frame[k].time);
        put_time(&f, text);
        plot_put(&f.p, "</g>\n");
    }
    return plot_close(&f.p);
}
