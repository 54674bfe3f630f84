/* plot.c - SVG by fprintf: axes, curves, colour bars.
 *
 * An axis turns values into pixels and knows its ticks, which are multiples of 1, 2 or 5 times a
 * power of ten. It also picks the prefix or the power of ten that keeps the numbers short, and puts
 * it into its label. Where the numbers along x would touch, the ticks are farther apart.
 *
 * The colours of curves are those of Okabe and Ito, the colours of bands follow viridis; both can
 * be told apart by the colour-blind. Dashes, marks and the rising lightness of the bands do the
 * same for a print in grey.
 */
#include "plot.h"

#include <stdarg.h>

enum { TEXT = 14, TICK_TEXT = 48, LEVELS = 11 };    /* pixels; the last: wanted bands */

static const double LETTER = 7.8;       /* pixels, generous mean width of a letter of size TEXT */
static const double UNSEEN = 1e-3;      /* of a step: results end there that may be meant to be 0 */
/* A band is cut off if it is so many times as high as the curves in it, unless these are flat but
 * for rounding: less than so much of its height. */
static const double HIGHER = 5, FLAT = 1e-6;

/* ------------------------------------------------------------------------------- file and text */

void plot_put(plot *p, const char *format, ...)
{
    va_list list;

    if (!p->out.file)
        return;
    va_start(list, format);
    output_note(&p->out, vfprintf(p->out.file, format, list) >= 0);
    va_end(list);
}

/* Two decimals, without trailing zeros. */
void plot_point(plot *p, const char *before, double x, double y)
{
    plot_put(p, "%s%.8g %.8g", before, floor(x * 100 + 0.5) / 100, floor(y * 100 + 0.5) / 100);
}

void plot_line(plot *p, const char *attributes, double x1, double y1, double x2, double y2)
{
    plot_put(p, "<path %s d=\"", attributes);
    plot_point(p, "M", x1, y1);
    plot_point(p, " ", x2, y2);
    plot_put(p, "\"/>\n");
}

void plot_rectangle(plot *p, plot_box b, const char *attributes)
{
    plot_put(p, "<rect x=\"%.2f\" y=\"%.2f\" width=\"%.2f\" height=\"%.2f\" %s/>\n", b.x, b.y, b.w,
             b.h, attributes);
}

/* Bytes of the character of UTF-8 that begins here and that XML allows; 0: there is none. */
static int character(const unsigned char *s)
{
    const int n = *s < ' ' ? 0 : *s < 0x80 ? 1 : *s < 0xC2 ? 0 : *s < 0xE0 ? 2 : *s < 0xF0 ? 3
                : *s < 0xF5 ? 4 : 0;

    for (int i = 1; i < n; i++)
        if ((s[i] & 0xC0) != 0x80)
            return 0;
    return n;
}

void plot_text(plot *p, double x, double y, const char *attributes, const char *text)
{
    const unsigned char *s = (const unsigned char *)text;

    if (!text || !*text)
        return;
    plot_put(p, "<text x=\"%.2f\" y=\"%.2f\" %s>", x, y, attributes);
    for (int n; *s; s += n ? n : 1) {
        n = character(s);
        if (*s == '<' || *s == '>' || *s == '&' || (n == 0 && *s >= 0xA0))  /* Latin-1 */
            plot_put(p, "&#%d;", *s);
        else
            plot_put(p, "%.*s", n, (const char *)s);
    }
    plot_put(p, "</text>\n");
}

/* Letters of three bytes and more may be as wide as two. */
double plot_text_width(const char *text)
{
    int letters = 0;

    for (const char *s = text; s && *s; s++)
        letters += (*s & 0xC0) == 0x80 ? 0 : (*s & 0xE0) == 0xE0 ? 2 : 1;
    return LETTER * letters;
}

void plot_begin_entry(plot *p, plot_legend *l, const char *text)
{
    const double w = PLOT_SYMBOL + 32 + plot_text_width(text);

    if (l->rows == 0 || l->right + w > l->room) {
        l->rows++;
        l->right = 0;
    }
    plot_put(p, "<g transform=\"translate(%.2f %.2f)\">\n", l->x + l->right,
             l->y + PLOT_ROW * (l->rows - 1));
    plot_text(p, PLOT_SYMBOL + 8, 5, "", text);
    l->right += w;
}

void plot_title(plot *p, double x, double y, const char *text)
{
    plot_text(p, x, y, "text-anchor=\"middle\" font-size=\"17\" font-weight=\"bold\"", text);
}

int plot_open(plot *p, const char *path, double width, double height)
{
    *p = (plot){ .width = width };
    output_open(&p->out, path);
    plot_put(p, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
             "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%.0f\" height=\"%.0f\" "
             "viewBox=\"0 0 %.0f %.0f\" font-family=\"sans-serif\" font-size=\"%d\">\n"
             "<rect width=\"100%%\" height=\"100%%\" fill=\"white\"/>\n",
             width, height, width, height, TEXT);
    return p->out.file != NULL;
}

int plot_close(plot *p)
{
    plot_put(p, "</svg>\n");
    return output_close(&p->out);
}

/* ------------------------------------------------------------------------------------- numbers */

void plot_widen(double range[][2], double x, double y)
{
    for (int k = 0; k < 2; k++) {
        range[k][0] = fmin(range[k][0], k ? y : x);
        range[k][1] = fmax(range[k][1], k ? y : x);
    }
}

double plot_nice(double x)
{
    static const double mantissa[] = { 1, 2, 5, 10 };
    const double power = pow(10, floor(log10(x)));
    double best = power;

    for (int i = 1; i < LENGTH(mantissa); i++)
        if (fabs(log(mantissa[i] * power / x)) < fabs(log(best / x)))
            best = mantissa[i] * power;
    return best;
}

/* A multiple of the step, with the decimals that the step needs and a typographic minus. */
static void number_text(char *text, size_t size, double value, double step)
{
    int decimals = 0;

    for (double s = step; decimals < 12 && fabs(s - floor(s + 0.5)) > 1e-6 * s; decimals++)
        s *= 10;
    snprintf(text, size, "%s%.*f", value < 0 ? "−" : "", decimals, fabs(value));
}

/* ---------------------------------------------------------------------------------------- axes */

/* Values in a range, and up to `largest`: as they are from 0.1 to 10^4, else scaled by a power of
 * 1000, which goes into the label: a prefix for m, N, s, J, Pa, alone or before a slash. */
static void scale_axis(plot_axis *a, const plot_quantity *q, const double range[2], double largest)
{
    static const char *const prefix[] = { "p", "n", "µ", "m", "", "k", "M", "G", "T" };
    const char *unit = q->unit ? q->unit : "", *name = q->name ? q->name : "";
    const size_t n = strcspn(unit, "/");
    int e = 0;

    if (largest > 1e-300 && (largest < 0.1 || largest >= 1e4))
        e = 3 * (int)floor(log10(largest) / 3);
    const double scale = pow(10, -e);
    *a = (plot_axis){ .lo = range[0] * scale, .hi = range[1] * scale, .scale = scale };
    const int takes = (n == 1 && strchr("mNsJ", *unit)) || (n == 2 && strncmp(unit, "Pa", n) == 0);
    if (e && (!takes || e < -12 || e > 12))
        snprintf(a->label, sizeof a->label, "%s [1e%d%s%s]", name, e, *unit ? " " : "", unit);
    else if (*unit)
        snprintf(a->label, sizeof a->label, "%s [%s%s]", name, prefix[e / 3 + 4], unit);
    else
        snprintf(a->label, sizeof a->label, "%s", name);
}

/* Values in a range, with about `count` ticks; no value at all is from > to, and all of them equal
 * widens the axis. */
static plot_axis make_axis(const plot_quantity *q, const double range[2], double count)
{
    const double none[2] = { 0, 1 }, *end = range[0] > range[1] ? none : range;
    plot_axis a;

    scale_axis(&a, q, end, fmax(fabs(end[0]), fabs(end[1])));
    const double largest = fmax(fabs(a.lo), fabs(a.hi));
    if (a.hi - a.lo <= 1e-9 * largest || largest < 1e-300) {
        const double margin = largest < 1e-300 ? 0.5 : 0.05 * largest;
        a.lo -= margin;
        a.hi += margin;
    }
    a.step = fmax(plot_nice((a.hi - a.lo) / count), q->unit ? 0 : a.scale);
    return a;
}

static void round_axis(plot_axis *a)    /* to whole steps */
{
    a->lo = floor(a->lo / a->step + UNSEEN) * a->step;
    a->hi = ceil(a->hi / a->step - UNSEEN) * a->step;
}

static double shown_pixel(const plot_axis *a, double shown)
{
    return a->from + (shown - a->lo) / (a->hi - a->lo) * (a->to - a->from);
}

double plot_pixel(const plot_axis *a, double value) { return shown_pixel(a, value * a->scale); }

/* The next tick from *i on: pixel and text. Returns 0 past the last. */
static int next_tick(const plot_axis *a, int *i, double *pixel, char text[TICK_TEXT])
{
    const double at = (ceil(a->lo / a->step - 1e-6) + (*i)++) * a->step;

    number_text(text, TICK_TEXT, at, a->step);
    *pixel = shown_pixel(a, at);
    return at <= a->hi + 1e-6 * (a->hi - a->lo);
}

static double widest_tick(const plot_axis *a)
{
    char text[TICK_TEXT];
    double at, widest = 0;

    for (int i = 0; next_tick(a, &i, &at, text); )
        widest = fmax(widest, plot_text_width(text));
    return widest;
}

/* The ticks of x so far apart that their numbers do not touch. */
static void spread_ticks(plot_axis *a)
{
    const double unit = fabs(a->to - a->from) / (a->hi - a->lo);

    while (a->step < a->hi - a->lo && widest_tick(a) + LETTER > a->step * unit)
        a->step = plot_nice(2.2 * a->step);
}

/* Across the box where there is a grid, else short. */
static void draw_ticks(plot *p, const plot_axis *a, plot_box b, int upright, int grid)
{
    const char *stroke = grid ? "stroke=\"#dddddd\"" : "stroke=\"#333333\"";
    const double length = !grid ? 5 : upright ? b.w : b.h, bottom = b.y + b.h;
    char text[TICK_TEXT];
    double at;

    for (int i = 0; next_tick(a, &i, &at, text); )
        if (upright) {
            plot_line(p, stroke, b.x, at, b.x + length, at);
            plot_text(p, b.x - 8, at + 5, "text-anchor=\"end\"", text);
        } else {
            plot_line(p, stroke, at, bottom, at, bottom - length);
            plot_text(p, at, bottom + 19, "text-anchor=\"middle\"", text);
        }
}

/* The axes get their place around box b: grid or tick strokes, frame and labels. */
static void draw_axes(plot *p, plot_box b, int grid)
{
    const double x = b.x - 22 - widest_tick(&p->y), y = b.y + b.h / 2;
    char turned[120];

    p->x.from = b.x;
    p->x.to = b.x + b.w;
    p->y.from = b.y + b.h;
    p->y.to = b.y;
    spread_ticks(&p->x);
    draw_ticks(p, &p->x, b, 0, grid);
    draw_ticks(p, &p->y, b, 1, grid);
    plot_rectangle(p, b, "fill=\"none\" stroke=\"#333333\"");
    plot_text(p, b.x + b.w / 2, b.y + b.h + 42, "text-anchor=\"middle\"", p->x.label);
    snprintf(turned, sizeof turned, "text-anchor=\"middle\" transform=\"rotate(-90 %.2f %.2f)\"",
             x, y);
    plot_text(p, x, y, turned, p->y.label);
}

/* The unit is that of the larger extent, not of the distance from the origin. */
void plot_draw_frame(plot *p, plot_box b, const double x[2], const double y[2])
{
    static const plot_quantity q[2] = { { "x", "m" }, { "y", "m" } };

    for (int k = 0; k < 2; k++) {
        plot_axis *a = k ? &p->y : &p->x;
        scale_axis(a, &q[k], k ? y : x, fmax(x[1] - x[0], y[1] - y[0]));
        a->step = plot_nice((x[1] - x[0]) * a->scale * 60 / b.w);
    }
    draw_axes(p, b, 0);
}

/* -------------------------------------------------------------------------------------- charts */

static int is_shown(const plot_series *s, int i) { return isfinite(s->x[i]) && isfinite(s->y[i]); }

/* A series without values, or a band that is much higher than what it holds, leaves the axes as
 * those before it made them. */
static void chart_axes(plot *p, plot_box box, const plot_chart *c)
{
    double range[2][2] = { { INFINITY, -INFINITY }, { INFINITY, -INFINITY } };

    for (const plot_series *s = c->series; s < c->series + c->count; s++) {
        double own[2][2] = { { INFINITY, -INFINITY }, { INFINITY, -INFINITY } };
        for (int i = 0; i < s->n; i++)
            if (!isinf(s->x[i]) && !isinf(s->y[i]))     /* of a gap, x */
                plot_widen(own, s->x[i], s->y[i]);
        const double height = own[1][1] - own[1][0], inside = range[1][1] - range[1][0];
        const int out = height < 0 || (s->style == PLOT_BAND && inside < height / HIGHER
                                       && inside > height * FLAT && own[1][0] <= range[1][0]
                                       && own[1][1] >= range[1][1]);
        for (int k = 0; k < 2 && !out; k++)
            plot_widen(range, own[0][k], own[1][k]);
    }
    p->x = make_axis(&c->x, range[0], fmax(2, box.w / 90));
    p->y = make_axis(&c->y, range[1], fmax(2, box.h / 70));
    round_axis(&p->y);
}

static void draw_mark(plot *p, int look, double x, double y)
{
    static const char *const shape[] = {
        "m0 4.4l4.2 -7.2h-8.4z",                                /* triangle on its tip */
        "m-3.6 0a3.6 3.6 0 1 0 7.2 0a3.6 3.6 0 1 0 -7.2 0z",    /* circle   */
        "m-3.3 -3.3h6.6v6.6h-6.6z",                             /* square   */
        "m0 -4.4l4.2 7.2h-8.4z",                                /* triangle */
        "m0 -4.6l4.6 4.6l-4.6 4.6l-4.6 -4.6z"                   /* diamond  */
    };

    plot_point(p, "<path d=\"M", x, y);
    plot_put(p, "%s\"/>\n", shape[look % LENGTH(shape)]);
}

static void draw_line(plot *p, const plot_series *s)
{
    plot_put(p, "<path d=\"");
    for (int i = 0; i < s->n; i++)
        if (is_shown(s, i))
            plot_point(p, i > 0 && is_shown(s, i - 1) ? " " : "M", plot_pixel(&p->x, s->x[i]),
                       fmin(fmax(plot_pixel(&p->y, s->y[i]), p->y.to), p->y.from));
    plot_put(p, "\"/>\n");
}

/* Lines without marks take the dashes in turn; the first is solid. */
static void begin_series(plot *p, const plot_chart *c, int k)
{
    static const char *const dashes[] = { "none", "9 5", "2 4", "10 4 2 4", "16 5" };
    static const char *const colour[] = { "#56B4E9", "#000000", "#D55E00", "#0072B2", "#009E73",
                                          "#CC79A7", "#E69F00" };
    const char *own = colour[c->series[k].look % LENGTH(colour)];
    const int band = c->series[k].style == PLOT_BAND;
    int before = 0;

    for (int i = 0; i < k && c->series[k].style == PLOT_LINE; i++)
        before += c->series[i].style == PLOT_LINE;
    plot_put(p, "<g fill=\"%s\" fill-opacity=\"0.2\" stroke=\"%s\" stroke-width=\"%s\" "
             "stroke-linejoin=\"round\" stroke-dasharray=\"%s\">\n",
             band ? own : "none", own, band ? "0.6" : "1.8", dashes[before % LENGTH(dashes)]);
}

/* Returns the number of rows. */
static int draw_legend(plot *p, plot_legend l, const plot_chart *c)
{
    for (int k = 0; k < c->count; k++) {
        plot_begin_entry(p, &l, c->series[k].name);
        begin_series(p, c, k);
        if (c->series[k].style == PLOT_BAND)
            plot_rectangle(p, (plot_box){ 4, -6, 40, 12 }, "");
        else if (c->series[k].style != PLOT_MARKS)
            plot_line(p, "", 4, 0, 44, 0);
        if (c->series[k].style >= PLOT_MARKS)
            draw_mark(p, c->series[k].look, 24, 0);
        plot_put(p, "</g></g>\n");
    }
    return l.rows;
}

void plot_draw_chart(plot *p, plot_box box, const plot_chart *c)
{
    chart_axes(p, box, c);
    const double left = 40 + widest_tick(&p->y), top = c->title ? 40 : 16;
    plot_box b = { box.x + left, box.y + top, box.w - left - 24, 0 };
    b.h = box.h - top - 60 - PLOT_ROW * draw_legend(&(plot){ 0 }, (plot_legend){ .room = b.w }, c);
    draw_axes(p, b, 1);
    plot_title(p, b.x + b.w / 2, b.y - 14, c->title);
    for (int k = 0; k < c->count; k++) {
        const plot_series *s = &c->series[k];
        begin_series(p, c, k);
        if (s->style != PLOT_MARKS)
            draw_line(p, s);
        for (int i = 0; i < s->n && s->style >= PLOT_MARKS; i++)
            if (is_shown(s, i))
                draw_mark(p, s->look, plot_pixel(&p->x, s->x[i]), plot_pixel(&p->y, s->y[i]));
        plot_put(p, "</g>\n");
    }
    draw_legend(p, (plot_legend){ b.x, b.y + b.h + 66, b.w, 0, 0 }, c);
}

int plot_write_chart(const char *path, const plot_chart *c)
{
    plot p;

    plot_open(&p, path, 860, 540);
    plot_draw_chart(&p, (plot_box){ 0, 0, 860, 540 }, c);
    return plot_close(&p);
}

/* ---------------------------------------------------------------------------------- colour bars */

plot_axis plot_bar_axis(const plot_quantity *q, const double range[2])
{
    plot_axis bar = make_axis(q, range, LEVELS);

    round_axis(&bar);
    bar.lo -= 1e-6 * bar.step;          /* a field of one level, but for rounding: one colour */
    return bar;
}

int plot_bands(const plot_axis *bar)
{
    return (int)fmax(1, floor((bar->hi - bar->lo) / bar->step + 0.5));
}

/* viridis */
plot_colour plot_value_colour(const plot_axis *bar, double value)
{
    static const int rgb[10][3] = {
        { 68, 1, 84 }, { 72, 40, 120 }, { 62, 74, 137 }, { 49, 104, 142 }, { 38, 130, 142 },
        { 31, 158, 137 }, { 53, 183, 121 }, { 109, 205, 89 }, { 180, 222, 44 }, { 253, 231, 37 } };
    const double band = floor((value * bar->scale - bar->lo) / bar->step);
    const double s = (fmax(0, fmin(band, plot_bands(bar) - 1)) + 0.5) / plot_bands(bar);
    const int i = (int)(9 * s);
    unsigned c[3];
    plot_colour result;

    for (int k = 0; k < 3; k++)
        c[k] = (unsigned)(rgb[i][k] + (9 * s - i) * (rgb[i + 1][k] - rgb[i][k]) + 0.5);
    snprintf(result.text, sizeof result.text, "#%02x%02x%02x", c[0] & 255, c[1] & 255, c[2] & 255);
    return result;
}

/* The bands side by side, an arrow in the colour of the last one where values lie beyond it, their
 * levels as far as there is room, below them what they measure and the extremes, to about a
 * hundredth of a band. */
void plot_draw_bar(plot *p, plot_box b, const plot_axis *bar, const double range[2])
{
    const int bands = plot_bands(bar);
    const double w = b.w / bands, unit = pow(10, floor(log10(bar->step) + 1e-9) - 2);
    plot_axis levels = *bar;
    char text[TICK_TEXT], end[2][TICK_TEXT], whole[280];
    double at;

    for (int k = 0; k < bands; k++) {
        const double middle = (bar->lo + (k + 0.5) * bar->step) / bar->scale;
        snprintf(text, sizeof text, "fill=\"%s\"", plot_value_colour(bar, middle).text);
        plot_rectangle(p, (plot_box){ b.x + k * w, b.y, w + (k < bands - 1), b.h }, text);
    }
    for (int k = 0; k < 2; k++) {
        const double value = range[k] * bar->scale, x = k ? b.x + b.w : b.x;
        if (k ? value > bar->hi + 1e-6 * bar->step : value < bar->lo)
            plot_put(p, "<polygon class=\"beyond\" points=\"%.2f,%.2f %.2f,%.2f %.2f,%.2f\" "
                     "fill=\"%s\" stroke=\"#333333\"/>\n", x, b.y, k ? x + b.h : x - b.h,
                     b.y + b.h / 2, x, b.y + b.h, plot_value_colour(bar, range[k]).text);
        number_text(end[k], sizeof end[k], floor(value / unit + 0.5) * unit, unit);
    }
    plot_rectangle(p, b, "fill=\"none\" stroke=\"#333333\"");
    levels.from = b.x;
    levels.to = b.x + b.w;
    spread_ticks(&levels);
    for (int i = 0; next_tick(&levels, &i, &at, text); )
        plot_text(p, at, b.y + b.h + 18, "text-anchor=\"middle\"", text);
    snprintf(whole, sizeof whole, "%s, from %s to %s", bar->label, end[0], end[1]);
    plot_text(p, b.x + b.w / 2, b.y + b.h + 40, "text-anchor=\"middle\"", whole);
}
