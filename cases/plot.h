/* plot.h - pictures for the experiments: curve charts and filled contours over a mesh, as SVG.
 *
 * Plain arrays in, one file out. A picture is a struct with designated initialisers; what is left out (zero, NULL) is
 * chosen by the writer: ticks, levels, colours, dashes, marks, the power of ten or the prefix of a unit.
 *
 *     const plot_series s[] = { { .name = "theory", .n = 49, .x = x, .y = exact },
 *                               { .name = "BBM", .n = 49, .x = x, .y = v, .style = PLOT_MARKS } };
 *     const plot_chart c = { .title = "Deflection of the axis", .x = { .name = "x", .unit = "m" },
 *                            .y = { .name = "v", .unit = "m" }, .count = 2, .series = s };
 *     if (!plot_write_chart("out/axis.svg", &c)) ...
 *
 * Values are in the unit given; the picture may show them in mm or kPa and says so. Texts are UTF-8. A
 * picture under its own name is never half a picture (output.h).
 */
#ifndef PLOT_H
#define PLOT_H

#include "output.h"

typedef enum {
    PLOT_LINE,                  /* the first such series solid, each later one with its own dashes              */
    PLOT_DASHED,                /* as PLOT_LINE, but never solid                                                */
    PLOT_MARKS,                 /* a mark at each point                                                         */
    PLOT_BOTH                   /* a solid line, marks along it at least 14 pixels apart                        */
} plot_style;

typedef struct {                /* what an axis or a colour bar measures                                        */
    const char *name, *unit;    /* a unit m, N, Pa, s, alone or before a slash, may get a prefix                */
    int    log;                 /* logarithmic axis, charts only; values <= 0 are left out                      */
    double low, high;           /* low < high: show at least these, e.g. zero, or the range of another picture  */
} plot_quantity;

typedef struct {
    const char   *name;         /* in the legend                                                                */
    int           n;
    const double *x, *y;        /* [n]; NaN leaves a gap                                                        */
    plot_style    style;
    int           look;         /* 1, 2, ..: colour and mark; 0: the place in the chart. The same in each chart
                                   lets the reader know a method again                                          */
} plot_series;

typedef struct {
    const char        *title;
    plot_quantity      x, y;
    int                count;
    const plot_series *series;  /* [count]                                                                      */
} plot_chart;

typedef struct {                /* cells are polygons: cell c has corners corner[first[c] .. first[c+1]-1]      */
    int           nodes, cells;
    const double *x, *y;        /* m        [nodes]                                                             */
    const int    *first;        /*          [cells+1]                                                           */
    const int    *corner;       /*          node numbers                                                        */
} plot_mesh;

typedef struct {
    const char   *title;
    plot_mesh     mesh;
    plot_quantity quantity;
    const double *value;        /*          [nodes], or NULL: the mesh alone; NaN leaves out the cells there    */
    const double *u, *v;        /* m        [nodes] displacements, or NULL: not deformed                        */
    double        magnify;      /* -        of the displacements; 0: so that the largest is a tenth of the mesh */
    int           hide_mesh;    /* no lines between the cells                                                   */
} plot_map;

/* Whole pictures. They return 1 when the complete file stands under its name, else 0, with the reason in errno. */
int plot_write_chart(const char *path, const plot_chart *c);
int plot_write_map(const char *path, const plot_map *m);

/* Several panels in one file, and whatever else SVG can do, in pixels from the top left:
 * plot_open, any number of panels and plot_put, plot_close. After plot_open failed the others do nothing.       */

typedef struct { double x, y, w, h; } plot_box;

typedef struct {
    double lo, hi, step;        /* ends and distance of the ticks, in the shown unit; log: powers of ten        */
    double scale;               /* shown value = scale * value                                                  */
    double from, to;            /* pixels of lo and hi                                                          */
    int    log;
    char   label[160];          /* v [mm]                                                                       */
} plot_axis;

typedef struct {
    output    out;
    int       failed;           /* the first error, as errno has it                                             */
    plot_axis x, y;             /* of the last panel                                                            */
} plot;

int    plot_open(plot *p, const char *path, double width, double height);   /* 1, or 0: it cannot be written    */
void   plot_draw_chart(plot *p, plot_box box, const plot_chart *c);
void   plot_draw_map(plot *p, plot_box box, const plot_map *m);
void   plot_put(plot *p, const char *format, ...);                          /* SVG, as by printf                */
void   plot_text(plot *p, double x, double y, const char *attributes, const char *text);  /* text is escaped    */
double plot_pixel(const plot_axis *a, double value);                        /* p->x, p->y: value to pixel       */
int    plot_close(plot *p);                                                 /* 1: complete, 0: nothing there    */

#endif
