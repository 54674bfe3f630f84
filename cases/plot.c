/* plot.c - SVG by fprintf: axes, curves, filled contours.
 *
 * An axis turns values into pixels and knows its ticks, which are multiples of 1, 2 or 5 times a power of ten. It also
 * picks the prefix or the power of ten that keeps the numbers short, and puts it into its label.
 *
 * A contour map paints one band between two levels after the other. In each triangle the value is linear, so that the
 * band's share of the triangle is the triangle cut by two straight lines; a larger polygon is first split into the
 * triangles from its mean point to its sides. All shares of a band are one path, drawn with a thin stroke in its own
 * colour: the stroke closes the hairlines that antialiasing would leave along common sides.
 *
 * The colours of curves are those of Okabe and Ito, the colours of bands follow viridis; both can be told apart by the
 * colour-blind. Dashes, marks and the rising lightness of the bands do the same for a print in grey.
 */
#include "plot.h"

#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

enum { TEXT = 14, ROW = 22, TICK_TEXT = 48, LEVELS = 11 };     /* pixels, but for the last: wanted bands         */

static const double LETTER = 7.8;       /* pixels, generous mean width of a letter of size TEXT */

/* ------------------------------------------------------------------------------------------- file and text */

void plot_put(plot *p, const char *format, ...)
{
    if (!p->out.file) return;
    va_list list;
    va_start(list, format);
    if (vfprintf(p->out.file, format, list) < 0 && !p->failed) p->failed = errno;
    va_end(list);
}

/* Two decimals, without trailing zeros. */
static void put_point(plot *p, double x, double y)
{
    plot_put(p, "%.7g %.7g ", floor(x * 100 + 0.5) / 100, floor(y * 100 + 0.5) / 100);
}

static void put_line(plot *p, double x1, double y1, double x2, double y2)
{
    plot_put(p, "<path d=\"M");
    put_point(p, x1, y1);
    put_point(p, x2, y2);
    plot_put(p, "\"/>\n");
}

static void put_box(plot *p, plot_box b, const char *attributes)
{
    plot_put(p, "<rect x=\"%.2f\" y=\"%.2f\" width=\"%.2f\" height=\"%.2f\" %s/>\n", b.x, b.y, b.w, b.h, attributes);
}

void plot_text(plot *p, double x, double y, const char *attributes, const char *text)
{
    if (!text) return;
    plot_put(p, "<text x=\"%.2f\" y=\"%.2f\" %s>", x, y, attributes);
    for (; *text; text++)
        if (*text == '<') plot_put(p, "&lt;");
        else if (*text == '>') plot_put(p, "&gt;");
        else if (*text == '&') plot_put(p, "&amp;");
        else if ((unsigned char)*text >= ' ') plot_put(p, "%c", *text);
    plot_put(p, "</text>\n");
}

static double text_width(const char *s)
{
    int letters = 0;
    for (; s && *s; s++) letters += (*s & 0xC0) != 0x80;        /* bytes that begin a character */
    return LETTER * letters;
}

int plot_open(plot *p, const char *path, double width, double height)
{
    *p = (plot){ 0 };
    if (!output_open(&p->out, path)) return 0;
    plot_put(p, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\" ");
    plot_put(p, "width=\"%.0f\" height=\"%.0f\" viewBox=\"0 0 %.0f %.0f\" ", width, height, width, height);
    plot_put(p, "font-family=\"sans-serif\" font-size=\"%d\">\n", TEXT);
    plot_put(p, "<rect width=\"100%%\" height=\"100%%\" fill=\"white\"/>\n");
    return 1;
}

int plot_close(plot *p)
{
    plot_put(p, "</svg>\n");
    if (!p->failed) return output_close(&p->out);
    errno = p->failed;
    output_drop(&p->out);
    return 0;
}

/* -------------------------------------------------------------------------------------------------- numbers */

static void widen(double *lo, double *hi, double value)
{
    *lo = fmin(*lo, value);
    *hi = fmax(*hi, value);
}

/* The step of 1, 2, 5 (and 2.5 if `quarters`) times a power of ten next to span / count. */
static double nice_step(double span, double count, int quarters)
{
    static const double mantissa[] = { 1, 2, 2.5, 5, 10 };
    double raw = span / count, power = pow(10, floor(log10(raw))), best = power;
    for (int i = 1; i < 5; i++)
        if ((i != 2 || quarters) && fabs(log(mantissa[i] * power / raw)) < fabs(log(best / raw)))
            best = mantissa[i] * power;
    return best;
}

/* A multiple of the step, with the decimals that the step needs and a typographic minus. */
static void number_text(char *text, size_t size, double value, double step)
{
    int decimals = 0;
    double s = step;
    for (; decimals < 12 && fabs(s - floor(s + 0.5)) > 1e-6 * s; decimals++) s *= 10;
    snprintf(text, size, "%s%.*f", value < 0 ? "−" : "", decimals, fabs(value));
}

static void power_text(char *text, size_t size, int exponent)
{
    static const char *const raised[] = { "⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹" };
    char digits[16];
    snprintf(digits, sizeof digits, "%d", abs(exponent));
    snprintf(text, size, "10%s", exponent < 0 ? "⁻" : "");
    for (const char *d = digits; *d; d++) {
        size_t used = strlen(text);
        snprintf(text + used, size - used, "%s", raised[*d - '0']);
    }
}

/* ----------------------------------------------------------------------------------------------------- axes */

static int takes_prefix(const char *unit)
{
    static const char *const symbol[] = { "m", "N", "Pa", "s" };
    for (int i = 0; i < 4; i++) {
        size_t n = strlen(symbol[i]);
        if (strncmp(unit, symbol[i], n) == 0 && (unit[n] == '\0' || unit[n] == '/')) return 1;
    }
    return 0;
}

/* Values up to `largest`: as they are from 0.1 to 10^4, else scaled by a power of 1000, which goes into the label. */
static void scale_axis(plot_axis *a, const plot_quantity *q, double largest)
{
    static const char *const prefix[] = { "p", "n", "µ", "m", "", "k", "M", "G", "T" };
    const char *unit = q->unit ? q->unit : "", *name = q->name ? q->name : "";
    char power[48];
    int e = 0;
    if (!a->log && largest > 1e-300 && (largest < 0.1 || largest >= 1e4)) e = 3 * (int)floor(log10(largest) / 3);
    a->scale = pow(10, -e);
    power_text(power, sizeof power, e);
    if (e && (!takes_prefix(unit) || e < -12 || e > 12))
        snprintf(a->label, sizeof a->label, "%s [×%s%s%s]", name, power, *unit ? " " : "", unit);
    else if (*unit)
        snprintf(a->label, sizeof a->label, "%s [%s%s]", name, prefix[e / 3 + 4], unit);
    else
        snprintf(a->label, sizeof a->label, "%s", name);
}

/* Values from lo to hi, with about `count` ticks; no value at all is lo > hi, and all of them equal widens the axis. */
static plot_axis make_axis(const plot_quantity *q, double lo, double hi, double count)
{
    plot_axis a = { .log = q->log };
    if (q->low < q->high && !(q->log && q->low <= 0)) {
        widen(&lo, &hi, q->low);
        widen(&lo, &hi, q->high);
    }
    if (lo > hi) {
        lo = q->log ? 0.1 : 0;
        hi = 1;
    }
    scale_axis(&a, q, fmax(fabs(lo), fabs(hi)));
    a.lo = a.log ? log10(lo) : lo * a.scale;
    a.hi = a.log ? log10(hi) : hi * a.scale;
    double largest = fmax(fabs(a.lo), fabs(a.hi)), margin = a.log ? 0.04 * (a.hi - a.lo) : 0;
    if (a.hi - a.lo <= 1e-9 * largest || largest < 1e-300) margin = a.log || largest < 1e-300 ? 0.5 : 0.05 * largest;
    a.lo -= margin;
    a.hi += margin;
    a.step = a.log ? ceil((a.hi - a.lo) / 10) : nice_step(a.hi - a.lo, count, 0);
    return a;
}

static void round_axis(plot_axis *a)    /* to whole steps */
{
    if (a->log) return;
    a->lo = floor(a->lo / a->step + 1e-9) * a->step;
    a->hi = ceil(a->hi / a->step - 1e-9) * a->step;
}

double plot_pixel(const plot_axis *a, double value)
{
    double shown = a->log ? log10(value) : value * a->scale;
    return a->from + (shown - a->lo) / (a->hi - a->lo) * (a->to - a->from);
}

/* A logarithmic axis over few decades also has lines at 2 .. 9, over very few also numbers at 2 and 5. */
static double log_tick(const plot_axis *a, int i, char text[TICK_TEXT])
{
    int    fine = a->hi - a->lo < 6, few = a->hi - a->lo < 2.1, m = fine ? i % 9 + 1 : 1;
    double exponent = floor(a->lo / a->step) * a->step + (fine ? i / 9 : i * a->step);
    char   power[TICK_TEXT / 2];
    power_text(power, sizeof power, (int)exponent);
    text[0] = '\0';
    if (few && (m == 1 || m == 2 || m == 5) && fabs(exponent) <= 3)
        snprintf(text, TICK_TEXT, "%g", m * pow(10, exponent));
    else if (m == 1)
        snprintf(text, TICK_TEXT, "%s", power);
    else if (few && (m == 2 || m == 5))
        snprintf(text, TICK_TEXT, "%d×%s", m, power);
    return exponent + log10(m);
}

/* The i-th tick: pixel and text, which may be empty. Returns 0 past the last, 1 at a tick, -1 before the first. */
static int next_tick(const plot_axis *a, int i, double *pixel, char text[TICK_TEXT])
{
    double slack = 1e-6 * (a->hi - a->lo), at;
    if (a->log) at = log_tick(a, i, text);
    else {
        at = (ceil(a->lo / a->step - 1e-6) + i) * a->step;
        number_text(text, TICK_TEXT, at, a->step);
    }
    *pixel = a->from + (at - a->lo) / (a->hi - a->lo) * (a->to - a->from);
    if (!(at <= a->hi + slack)) return 0;
    return at >= a->lo - slack ? 1 : -1;
}

static double widest_tick(const plot_axis *a)
{
    char   text[TICK_TEXT];
    double at, widest = 0;
    for (int i = 0, more; (more = next_tick(a, i, &at, text)) != 0; i++)
        if (more > 0) widest = fmax(widest, text_width(text));
    return widest;
}

static void draw_ticks(plot *p, const plot_axis *a, plot_box b, int upright, int grid)
{
    char   text[TICK_TEXT];
    double at, length = grid ? upright ? b.w : b.h : 5;
    plot_put(p, "<g stroke=\"%s\" stroke-width=\"1\">\n", grid ? "#dddddd" : "#333333");
    for (int i = 0, more; (more = next_tick(a, i, &at, text)) != 0; i++)
        if (more > 0 && upright) put_line(p, b.x, at, b.x + length, at);
        else if (more > 0)       put_line(p, at, b.y + b.h, at, b.y + b.h - length);
    plot_put(p, "</g>\n");
    for (int i = 0, more; (more = next_tick(a, i, &at, text)) != 0; i++)
        if (more > 0 && upright) plot_text(p, b.x - 8, at + 5, "text-anchor=\"end\"", text);
        else if (more > 0)       plot_text(p, at, b.y + b.h + 19, "text-anchor=\"middle\"", text);
}

/* Grid or tick strokes, frame, labels and title around box b. */
static void draw_axes(plot *p, plot_box b, const char *title, int grid)
{
    char   turned[120];
    double x = b.x - 22 - widest_tick(&p->y), y = b.y + b.h / 2;
    draw_ticks(p, &p->x, b, 0, grid);
    draw_ticks(p, &p->y, b, 1, grid);
    put_box(p, b, "fill=\"none\" stroke=\"#333333\"");
    plot_text(p, b.x + b.w / 2, b.y + b.h + 42, "text-anchor=\"middle\"", p->x.label);
    snprintf(turned, sizeof turned, "text-anchor=\"middle\" transform=\"rotate(-90 %.2f %.2f)\"", x, y);
    plot_text(p, x, y, turned, p->y.label);
    plot_text(p, b.x + b.w / 2, b.y - 14, "text-anchor=\"middle\" font-size=\"17\" font-weight=\"bold\"", title);
}

/* --------------------------------------------------------------------------------------------------- charts */

static int is_shown(const plot_chart *c, const plot_series *s, int i)
{
    return isfinite(s->x[i]) && isfinite(s->y[i]) && (!c->x.log || s->x[i] > 0) && (!c->y.log || s->y[i] > 0);
}

static void chart_axes(plot *p, plot_box box, const plot_chart *c)
{
    double x0 = INFINITY, x1 = -INFINITY, y0 = INFINITY, y1 = -INFINITY;
    for (int k = 0; k < c->count; k++) {
        const plot_series *s = &c->series[k];
        for (int i = 0; i < s->n; i++) {
            if (!is_shown(c, s, i)) continue;
            widen(&x0, &x1, s->x[i]);
            widen(&y0, &y1, s->y[i]);
        }
    }
    p->x = make_axis(&c->x, x0, x1, fmax(2, box.w / 90));
    p->y = make_axis(&c->y, y0, y1, fmax(2, box.h / 70));
    round_axis(&p->y);
}

static const char *series_colour(int look)
{
    static const char *const colour[] = { "#000000", "#D55E00", "#0072B2", "#009E73", "#CC79A7", "#E69F00", "#56B4E9" };
    return colour[look % 7];
}

static int series_look(const plot_chart *c, int k)
{
    return c->series[k].look > 0 ? c->series[k].look - 1 : k;
}

/* Lines without marks take the patterns in turn; the first is solid. */
static const char *series_dashes(const plot_chart *c, int k)
{
    static const char *const pattern[] = { "none", "9 5", "2 4", "10 4 2 4", "16 5", "5 3 2 3 2 3" };
    int before = 0;
    if (c->series[k].style >= PLOT_MARKS) return pattern[0];
    for (int i = 0; i < k; i++) before += c->series[i].style == PLOT_LINE || c->series[i].style == PLOT_DASHED;
    return pattern[before == 0 && c->series[k].style == PLOT_DASHED ? 5 : before % 6];
}

static void draw_mark(plot *p, int look, double x, double y)
{
    static const char *const shape[] = {
        "m-3.6 0a3.6 3.6 0 1 0 7.2 0a3.6 3.6 0 1 0 -7.2 0z",    /* circle   */
        "m-3.3 -3.3h6.6v6.6h-6.6z",                             /* square   */
        "m0 -4.4l4.2 7.2h-8.4z",                                /* triangle */
        "m0 -4.6l4.6 4.6l-4.6 4.6l-4.6 -4.6z",                  /* diamond  */
        "m-3.4 -3.4l6.8 6.8m0 -6.8l-6.8 6.8",                   /* cross    */
        "m-4.4 0h8.8m-4.4 -4.4v8.8",                            /* plus     */
        "m0 4.4l4.2 -7.2h-8.4z"                                 /* triangle on its tip */
    };
    plot_put(p, "<path d=\"M");
    put_point(p, x, y);
    plot_put(p, "%s\"/>\n", shape[look % 7]);
}

static void draw_line(plot *p, const plot_chart *c, const plot_series *s)
{
    int drawing = 0;
    plot_put(p, "<path d=\"");
    for (int i = 0; i < s->n; i++) {
        int shown = is_shown(c, s, i);
        if (shown && !drawing) plot_put(p, "M");
        if (shown) put_point(p, plot_pixel(&p->x, s->x[i]), plot_pixel(&p->y, s->y[i]));
        drawing = shown;
    }
    plot_put(p, "\"/>\n");
}

static void draw_marks(plot *p, const plot_chart *c, const plot_series *s, int look)
{
    double last_x = -INFINITY, last_y = 0, apart = s->style == PLOT_BOTH ? 14 : 0;
    for (int i = 0; i < s->n; i++) {
        if (!is_shown(c, s, i)) continue;
        double x = plot_pixel(&p->x, s->x[i]), y = plot_pixel(&p->y, s->y[i]);
        if (hypot(x - last_x, y - last_y) < apart) continue;
        draw_mark(p, look, x, y);
        last_x = x;
        last_y = y;
    }
}

static void begin_series(plot *p, const plot_chart *c, int k)
{
    plot_put(p, "<g fill=\"none\" stroke=\"%s\" stroke-width=\"1.8\" ", series_colour(series_look(c, k)));
    plot_put(p, "stroke-linejoin=\"round\" stroke-dasharray=\"%s\">\n", series_dashes(c, k));
}

/* Columns of the legend: as few as keep it to the rows that the widest entry allows. */
static int legend_columns(const plot_chart *c, double width, double *column)
{
    *column = 0;
    for (int k = 0; k < c->count; k++) *column = fmax(*column, 70 + text_width(c->series[k].name));
    int fit = (int)fmax(1, width / fmax(*column, 1)), rows = (c->count + fit - 1) / fit;
    return rows > 0 ? (c->count + rows - 1) / rows : 1;
}

static void draw_legend(plot *p, plot_box b, const plot_chart *c)
{
    double column;
    int columns = legend_columns(c, b.w, &column);
    for (int k = 0; k < c->count; k++) {
        double x = b.x + b.w / 2 + (k % columns - columns / 2.0) * column + 10, y = b.y + ROW * (k / columns);
        begin_series(p, c, k);
        if (c->series[k].style != PLOT_MARKS) put_line(p, x, y, x + 40, y);
        if (c->series[k].style >= PLOT_MARKS) draw_mark(p, series_look(c, k), x + 20, y);
        plot_put(p, "</g>\n");
        plot_text(p, x + 48, y + 5, "", c->series[k].name);
    }
}

void plot_draw_chart(plot *p, plot_box box, const plot_chart *c)
{
    double column;
    chart_axes(p, box, c);
    double left = 40 + widest_tick(&p->y), top = c->title ? 40 : 16;
    plot_box b = { box.x + left, box.y + top, box.w - left - 24, 0 };
    int columns = legend_columns(c, b.w, &column), rows = (c->count + columns - 1) / columns;
    b.h = box.h - top - 60 - ROW * rows;
    p->x.from = b.x;
    p->x.to = b.x + b.w;
    p->y.from = b.y + b.h;
    p->y.to = b.y;
    draw_axes(p, b, c->title, 1);
    for (int k = 0; k < c->count; k++) {
        const plot_series *s = &c->series[k];
        begin_series(p, c, k);
        if (s->style != PLOT_MARKS) draw_line(p, c, s);
        if (s->style >= PLOT_MARKS) draw_marks(p, c, s, series_look(c, k));
        plot_put(p, "</g>\n");
    }
    draw_legend(p, (plot_box){ b.x, b.y + b.h + 66, b.w, 0 }, c);
}

int plot_write_chart(const char *path, const plot_chart *c)
{
    plot p;
    if (!plot_open(&p, path, 860, 540)) return 0;
    plot_draw_chart(&p, (plot_box){ 0, 0, 860, 540 }, c);
    return plot_close(&p);
}

/* ----------------------------------------------------------------------------------------------------- maps */

typedef struct { double x, y, value; } point;

typedef struct { double x0, x1, y0, y1, value0, value1, moved; } extent;

/* Of the mesh before and after it is magnified. */
static extent map_extent(const plot_map *m, double magnify)
{
    extent e = { INFINITY, -INFINITY, INFINITY, -INFINITY, INFINITY, -INFINITY, 0 };
    for (int i = 0; i < m->mesh.nodes; i++) {
        double x = m->mesh.x[i], y = m->mesh.y[i], u = m->u ? m->u[i] : 0, v = m->v ? m->v[i] : 0;
        if (!isfinite(x + y + u + v)) continue;
        widen(&e.x0, &e.x1, x);
        widen(&e.x0, &e.x1, x + magnify * u);
        widen(&e.y0, &e.y1, y);
        widen(&e.y0, &e.y1, y + magnify * v);
        e.moved = fmax(e.moved, hypot(u, v));
        if (m->value && isfinite(m->value[i])) widen(&e.value0, &e.value1, m->value[i]);
    }
    return e.x0 <= e.x1 ? e : (extent){ 0, 1, 0, 1, INFINITY, -INFINITY, 0 };
}

static double map_magnify(const plot_map *m)
{
    extent e = map_extent(m, 0);
    double largest = fmax(e.x1 - e.x0, e.y1 - e.y0);
    if (m->magnify > 0 || e.moved <= 1e-12 * largest || largest <= 0) return m->magnify > 0 ? m->magnify : 1;
    return nice_step(0.1 * largest / e.moved, 1, 0);
}

static point map_point(const plot *p, const plot_map *m, int i, double magnify)
{
    double u = magnify > 0 && m->u ? m->u[i] : 0, v = magnify > 0 && m->v ? m->v[i] : 0;
    return (point){ plot_pixel(&p->x, m->mesh.x[i] + magnify * u), plot_pixel(&p->y, m->mesh.y[i] + magnify * v),
                    m->value ? m->value[i] : 0 };
}

/* The part of a convex polygon where sign * (value - level) >= 0; returns its number of corners. */
static int cut(const point in[], int n, double level, double sign, point out[])
{
    int count = 0;
    for (int i = 0; i < n; i++) {
        point a = in[i], b = in[(i + 1) % n];
        int a_stays = sign * (a.value - level) >= 0, b_stays = sign * (b.value - level) >= 0;
        if (a_stays) out[count++] = a;
        if (a_stays == b_stays) continue;
        double t = (level - a.value) / (b.value - a.value);
        out[count++] = (point){ a.x + t * (b.x - a.x), a.y + t * (b.y - a.y), level };
    }
    return count;
}

static void put_polygon(plot *p, const point corner[], int n)
{
    plot_put(p, "M");
    for (int i = 0; i < n; i++) put_point(p, corner[i].x, corner[i].y);
    plot_put(p, "z\n");
}

/* The share of one triangle in the band from level[0] to level[1]. */
static void put_share(plot *p, const point triangle[3], const double level[2])
{
    point above[4], band[5];
    double least = fmin(triangle[0].value, fmin(triangle[1].value, triangle[2].value));
    double most = fmax(triangle[0].value, fmax(triangle[1].value, triangle[2].value));
    if (most < level[0] || least >= level[1] || !isfinite(most - least)) return;
    int n = cut(triangle, 3, level[0], 1, above);
    n = cut(above, n, level[1], -1, band);
    if (n >= 3) put_polygon(p, band, n);
}

static int cell_mean(const plot *p, const plot_map *m, int cell, double magnify, point *mean)
{
    int first = m->mesh.first[cell], n = m->mesh.first[cell + 1] - first;
    *mean = (point){ 0, 0, 0 };
    for (int i = 0; i < n; i++) {
        point a = map_point(p, m, m->mesh.corner[first + i], magnify);
        mean->x += a.x / n, mean->y += a.y / n, mean->value += a.value / n;
    }
    return isfinite(mean->x + mean->y + mean->value);
}

static void put_cell_share(plot *p, const plot_map *m, int cell, double magnify, const double level[2])
{
    const int *corner = &m->mesh.corner[m->mesh.first[cell]];
    int n = m->mesh.first[cell + 1] - m->mesh.first[cell];
    point t[3];
    if (!cell_mean(p, m, cell, magnify, &t[2])) return;
    if (n == 3) t[2] = map_point(p, m, corner[2], magnify);
    for (int i = 0; i < (n == 3 ? 1 : n); i++) {
        t[0] = map_point(p, m, corner[i], magnify);
        t[1] = map_point(p, m, corner[(i + 1) % n], magnify);
        put_share(p, t, level);
    }
}

typedef struct { char text[8]; } colour;

/* viridis, 0 <= s <= 1 */
static colour band_colour(double s)
{
    static const int rgb[10][3] = { { 68, 1, 84 }, { 72, 40, 120 }, { 62, 74, 137 }, { 49, 104, 142 }, { 38, 130, 142 },
        { 31, 158, 137 }, { 53, 183, 121 }, { 109, 205, 89 }, { 180, 222, 44 }, { 253, 231, 37 } };
    int i = s >= 1 ? 8 : (int)(9 * s);
    unsigned c[3];
    colour result;
    for (int k = 0; k < 3; k++) c[k] = (unsigned)(rgb[i][k] + (9 * s - i) * (rgb[i + 1][k] - rgb[i][k]) + 0.5);
    snprintf(result.text, sizeof result.text, "#%02x%02x%02x", c[0] & 255, c[1] & 255, c[2] & 255);
    return result;
}

static int band_count(const plot_axis *bar)
{
    return (int)fmax(1, floor((bar->hi - bar->lo) / bar->step + 0.5));
}

static void draw_bands(plot *p, const plot_map *m, const plot_axis *bar, double magnify)
{
    int bands = band_count(bar);
    for (int k = 0; k < bands; k++) {
        colour fill = band_colour((k + 0.5) / bands);
        double level[2] = { k ? (bar->lo + k * bar->step) / bar->scale : -INFINITY,
                            k < bands - 1 ? (bar->lo + (k + 1) * bar->step) / bar->scale : INFINITY };
        plot_put(p, "<path fill=\"%s\" stroke=\"%s\" stroke-width=\"0.6\" ", fill.text, fill.text);
        plot_put(p, "stroke-linejoin=\"round\" d=\"");
        for (int c = 0; c < m->mesh.cells; c++) put_cell_share(p, m, c, magnify, level);
        plot_put(p, "\"/>\n");
    }
}

/* All cells as one path, with the given fill and stroke. */
static void draw_cells(plot *p, const plot_map *m, double magnify, const char *attributes)
{
    plot_put(p, "<path %s stroke-linejoin=\"round\" d=\"", attributes);
    for (int c = 0; c < m->mesh.cells; c++) {
        point mean;
        if (!cell_mean(p, m, c, magnify, &mean)) continue;
        plot_put(p, "M");
        for (int i = m->mesh.first[c]; i < m->mesh.first[c + 1]; i++) {
            point a = map_point(p, m, m->mesh.corner[i], magnify);
            put_point(p, a.x, a.y);
        }
        plot_put(p, "z\n");
    }
    plot_put(p, "\"/>\n");
}

static int compare_sides(const void *a, const void *b)
{
    const int *s = a, *t = b;
    if (s[0] != t[0]) return s[0] < t[0] ? -1 : 1;
    return (s[1] > t[1]) - (s[1] < t[1]);
}

/* The sides that only one cell has. */
static void draw_outline(plot *p, const plot_map *m, double magnify, const char *attributes)
{
    int n = 0, total = m->mesh.cells > 0 ? m->mesh.first[m->mesh.cells] - m->mesh.first[0] : 0;
    int (*side)[2] = total > 0 ? malloc((size_t)total * sizeof *side) : NULL;
    if (!side) {
        if (total > 0) p->failed = ENOMEM;
        return;
    }
    for (int c = 0; c < m->mesh.cells; c++)
        for (int i = m->mesh.first[c], end = m->mesh.first[c + 1]; i < end; i++, n++) {
            int a = m->mesh.corner[i], b = m->mesh.corner[i + 1 < end ? i + 1 : m->mesh.first[c]];
            side[n][0] = a < b ? a : b;
            side[n][1] = a < b ? b : a;
        }
    qsort(side, (size_t)n, sizeof *side, compare_sides);
    plot_put(p, "<path fill=\"none\" stroke-linecap=\"round\" %s d=\"", attributes);
    for (int i = 0, same; i < n; i += same) {
        for (same = 1; i + same < n && compare_sides(side[i], side[i + same]) == 0; ) same++;
        point a = map_point(p, m, side[i][0], magnify), b = map_point(p, m, side[i][1], magnify);
        if (same > 1 || !isfinite(a.x + a.y + b.x + b.y)) continue;
        plot_put(p, "M");
        put_point(p, a.x, a.y);
        put_point(p, b.x, b.y);
    }
    plot_put(p, "\"/>\n");
    free(side);
}

/* The extremes, to about a hundredth of a band. */
static void range_text(char *text, size_t size, const plot_axis *bar, const extent *e)
{
    char low[TICK_TEXT], high[TICK_TEXT];
    double unit = pow(10, floor(log10(bar->step) + 1e-9) - 2);
    number_text(low, sizeof low, floor(e->value0 * bar->scale / unit + 0.5) * unit, unit);
    number_text(high, sizeof high, floor(e->value1 * bar->scale / unit + 0.5) * unit, unit);
    snprintf(text, size, e->value0 <= e->value1 ? "%s, from %s to %s" : "%s", bar->label, low, high);
}

/* The bands side by side, their levels as far as there is room, and below them what they measure. */
static void draw_bar(plot *p, plot_box b, const plot_axis *bar, const extent *e)
{
    char text[TICK_TEXT], range[280], attributes[40];
    int bands = band_count(bar), first = (int)floor(bar->lo / bar->step + 0.5), skip = 1;
    double w = b.w / bands;
    for (int k = 0; k < bands; k++) {
        snprintf(attributes, sizeof attributes, "fill=\"%s\"", band_colour((k + 0.5) / bands).text);
        put_box(p, (plot_box){ b.x + k * w, b.y, w + (k < bands - 1), b.h }, attributes);
    }
    put_box(p, b, "fill=\"none\" stroke=\"#333333\"");
    while (widest_tick(bar) + 8 > skip * w && skip < bands) skip += skip == 2 ? 3 : skip;   /* 1, 2, 5, 10 */
    for (int k = 0; k <= bands; k++) {
        if ((first + k) % skip) continue;
        number_text(text, sizeof text, (first + k) * bar->step, bar->step);
        plot_text(p, b.x + k * w, b.y + b.h + 18, "text-anchor=\"middle\"", text);
    }
    range_text(range, sizeof range, bar, e);
    plot_text(p, b.x + b.w / 2, b.y + b.h + 40, "text-anchor=\"middle\"", range);
}

/* Equal scales on both axes, the mesh in the middle of the box with a margin of 3 %. Returns the frame. */
static plot_box map_axes(plot *p, plot_box box, const extent *e)
{
    double more = 0.03 * fmax(e->x1 - e->x0, e->y1 - e->y0);
    double w = e->x1 - e->x0 + 2 * more, h = e->y1 - e->y0 + 2 * more;
    if (w <= 0 || h <= 0) w = h = more = 1;
    double pixels = fmin(box.w / w, box.h / h), step = nice_step(60 / pixels, 1, 0);
    plot_box b = { box.x + (box.w - pixels * w) / 2, box.y + (box.h - pixels * h) / 2, pixels * w, pixels * h };
    p->x = (plot_axis){ e->x0 - more, e->x0 - more + w, step, 1, b.x, b.x + b.w, 0, "x [m]" };
    p->y = (plot_axis){ e->y0 - more, e->y0 - more + h, step, 1, b.y + b.h, b.y, 0, "y [m]" };
    return b;
}

enum { MAP_LEFT = 84, MAP_RIGHT = 24, MAP_TOP = 40, MAP_BOTTOM = 56, MAP_BAR = 76 };   /* around the frame, pixels */

static double map_bottom(const plot_map *m)
{
    return MAP_BOTTOM + (m->value ? MAP_BAR : 0);
}

/* The title, and by how much the displacements are magnified. */
static void map_title(const plot_map *m, double magnify, char *text, size_t size)
{
    const char *title = m->title ? m->title : "";
    if (m->u || m->v)
        snprintf(text, size, "%s%sdisplacements × %g", title, m->title ? ", " : "", magnify);
    else
        snprintf(text, size, "%s", title);
}

void plot_draw_map(plot *p, plot_box box, const plot_map *m)
{
    int    moved = m->u || m->v;
    double magnify = moved ? map_magnify(m) : 0;
    extent e = map_extent(m, magnify);
    char   title[200];
    plot_box b = map_axes(p, (plot_box){ box.x + MAP_LEFT, box.y + MAP_TOP, box.w - MAP_LEFT - MAP_RIGHT,
                                         box.h - MAP_TOP - map_bottom(m) }, &e);
    plot_axis bar = make_axis(&m->quantity, e.value0, e.value1, LEVELS);
    bar.step = nice_step(bar.hi - bar.lo, LEVELS, 1);
    round_axis(&bar);
    if (m->value) draw_bands(p, m, &bar, magnify);
    if (!m->value)
        draw_cells(p, m, magnify, "fill=\"#e8eef4\" stroke=\"#335577\" stroke-width=\"0.5\"");
    else if (!m->hide_mesh)
        draw_cells(p, m, magnify, "fill=\"none\" stroke=\"#000000\" stroke-width=\"0.4\" stroke-opacity=\"0.45\"");
    if (moved) draw_outline(p, m, 0, "stroke=\"#666666\" stroke-width=\"1.4\"");
    draw_outline(p, m, magnify, "stroke=\"#000000\" stroke-width=\"1\"");
    map_title(m, magnify, title, sizeof title);
    draw_axes(p, b, title, 0);
    if (m->value) draw_bar(p, (plot_box){ b.x, b.y + b.h + MAP_BOTTOM + 4, b.w, 16 }, &bar, &e);
}

/* The frame is 752 pixels wide, or 560 high if that is less; the page is as wide as the title at least, which stands over
 * the middle of the frame. */
int plot_write_map(const char *path, const plot_map *m)
{
    plot p;
    char title[200];
    double magnify = m->u || m->v ? map_magnify(m) : 0;
    extent e = map_extent(m, magnify);
    plot_box b = map_axes(&p, (plot_box){ 0, 0, 752, 560 }, &e);
    map_title(m, magnify, title, sizeof title);
    double width = fmax(b.w + MAP_LEFT + MAP_RIGHT, 1.4 * text_width(title) + MAP_LEFT - MAP_RIGHT);
    plot_box all = { 0, 0, width, b.h + MAP_TOP + map_bottom(m) };
    if (!plot_open(&p, path, all.w, all.h)) return 0;
    plot_draw_map(&p, all, m);
    return plot_close(&p);
}
