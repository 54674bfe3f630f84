/* plot.h - pictures as SVG: text and lines, axes, curve charts.
 *
 * Plain arrays in, one file out. A chart is a struct with designated initialisers; what is left out
 * (zero, NULL) is chosen by the writer: ticks, dashes, the power of ten or the prefix of a unit.
 *
 *     const plot_series s[] = {
 *         { .name = "theory", .n = 49, .x = x, .y = exact, .look = 1 },
 *         { .name = "BBM", .n = 49, .x = x, .y = v, .look = 2,
 *           .style = PLOT_MARKS } };
 *     const plot_chart c = { .title = "Deflection of the axis", .x = { .name = "x", .unit = "m" },
 *                            .y = { .name = "v", .unit = "m" }, .count = 2, .series = s };
 *     if (!plot_write_chart("out/axis.svg", &c)) ...
 *
 * Values are in the unit given; the picture may show them in mm or kPa and says so. Texts are
 * UTF-8; a byte that is none is taken as Latin-1, so that every file is well formed. A picture
 * under its own name is never half a picture (output.h). Pictures of blocks are in scene.h.
 */
#ifndef PLOT_H
#define PLOT_H

#include "../base/base.h"
#include "output.h"

typedef enum {
    PLOT_LINE,                  /* the first such series solid, later ones with dashes            */
    PLOT_BAND,                  /* the area within the points, behind the lines in the list; much */
                                /* higher than what it holds, it is cut off at the axes           */
    PLOT_MARKS,                 /* a mark at each point                                           */
    PLOT_BOTH                   /* a solid line, and a mark at each point                         */
} plot_style;

typedef struct {                /* what an axis or a colour bar measures                          */
    const char *name, *unit;    /* m, N, s, J, Pa, alone or before a slash, may get a prefix;     */
                                /* NULL: a count, with whole numbers at the ticks                 */
} plot_quantity;

typedef struct {
    const char   *name;         /* in the legend                                                  */
    int           n;
    const double *x, *y;        /* [n]; NaN leaves a gap                                          */
    plot_style    style;
    int           look;         /* 1, 2, ..: colour and mark. The same in each chart lets the     */
                                /* reader know a method again                                     */
} plot_series;

typedef struct {
    const char        *title;
    plot_quantity      x, y;
    int                count;
    const plot_series *series;  /* [count]                                                        */
} plot_chart;

/* Returns 1 when the complete file stands under its name, else 0, with the reason in errno. */
int plot_write_chart(const char *path, const plot_chart *c);

/* Several panels in one file, and whatever else SVG can do, in pixels from the top left: plot_open,
 * any number of panels and plot_put, plot_close. After plot_open failed the others do nothing. */

typedef struct { double x, y, w, h; } plot_box;

typedef struct {
    double lo, hi, step;        /* ends and distance of the ticks, in the shown unit              */
    double scale;               /* shown value = scale * value                                    */
    double from, to;            /* pixels of lo and hi                                            */
    char   label[160];          /* v [mm]                                                         */
} plot_axis;

typedef struct {
    output    out;
    plot_axis x, y;             /* of the last panel                                              */
    double    width;            /* pixels                                                         */
} plot;

int    plot_open(plot *p, const char *path, double width, double height);   /* 1; 0: it cannot be */
int    plot_close(plot *p);                         /* 1: complete, 0: nothing is there           */
void   plot_put(plot *p, const char *format, ...);  /* SVG, as by printf                          */
void   plot_point(plot *p, const char *before, double x, double y);         /* of a path          */
void   plot_line(plot *p, const char *attributes, double x1, double y1, double x2, double y2);
void   plot_rectangle(plot *p, plot_box b, const char *attributes);
void   plot_text(plot *p, double x, double y, const char *attributes, const char *text);
double plot_text_width(const char *text);           /* pixels, generous                           */
void   plot_title(plot *p, double x, double y, const char *text);           /* x: its middle      */
/* One more entry of a legend: its text. A symbol around y = 0, x up to PLOT_SYMBOL, is to follow,
 * and the end of the group, </g>. In a plot that is not open this only counts the rows. */
enum { PLOT_ROW = 24, PLOT_SYMBOL = 48 };           /* pixels */
typedef struct { double x, y, room, right; int rows; } plot_legend; /* from (x, y) on, row by row */
void   plot_begin_entry(plot *p, plot_legend *l, const char *text);
double plot_pixel(const plot_axis *a, double value);        /* p->x, p->y: value to pixel         */
void   plot_widen(double range[][2], double x, double y);   /* of x and y: they hold the point    */
double plot_nice(double x);                         /* 1, 2 or 5 times a power of ten, near x     */
void   plot_draw_chart(plot *p, plot_box box, const plot_chart *c);
/* Axes in metres, from x[0] to x[1] over the width of the frame b, likewise y. */
void   plot_draw_frame(plot *p, plot_box b, const double x[2], const double y[2]);

/* A colour bar: the axis of its bands, which are `step` wide; what a value gets; the bar itself. */
typedef struct { char text[8]; } plot_colour;
plot_axis   plot_bar_axis(const plot_quantity *q, const double range[2]);
int         plot_bands(const plot_axis *bar);
plot_colour plot_value_colour(const plot_axis *bar, double value);  /* outside: of the last band  */
void        plot_draw_bar(plot *p, plot_box b, const plot_axis *bar, const double range[2]);

#endif
