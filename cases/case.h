/* case.h - what the experiments share: structured meshes, reference values, tables, results as
 * files. */
#ifndef CASE_H
#define CASE_H

#include <stdio.h>

#include "../bbm.h"
#include "plot.h"
#include "scene.h"

/* How a cell of a grid is cut: not, in 2, in 4 triangles. */
enum { CASE_QUADS, CASE_ALTERNATING, CASE_CROSSED };

static const double case_alpha[4] = { 10, 100, 1000, 1e5 };     /* of the tables of convergence */

typedef struct {                    /* a grid of nx x ny cells, mapped by a function            */
    int nx, ny, cut, block, material;
    void (*map)(double i, double j, const void *context, double xy[2]); /* grid line -> point */
    const void *context;
    int first;                      /* its first node, set by case_add_grid: node (i, j) is     */
                                    /* first + j (nx+1) + i                                     */
} case_grid;

typedef struct {                    /* values of cases/fem.csv for one problem and variant      */
    struct case_value { char quantity[32]; double x, y, converged, six_node, three_node; } *value;
    int values;
} case_reference;

typedef struct {                    /* out/NAME/results.csv                                     */
    char folder[64];
    FILE *csv;
    double worst;                   /* largest |relative error| of the rows since it was set to 0 */
    int failed;                     /* 1: a picture could not be made                           */
} case_results;

/* A status is printed with its message and the program ends with 1: what is written so far
 * stays. */
void   case_must(const bbm_model *m, bbm_status s);

/* beyond.c, or paper.c for `make paper`. A new model; one with the paper's bonds and solver. */
bbm_model *case_model(void);
bbm_model *case_paper_model(void);

/* The elements of a cell, of so many corners each; returns their number. node[4] is the one in the
 * middle, where it is crossed; odd: i + j of its place. */
int    case_cut_cell(int cut, int odd, const int node[5], int element[4][4], int *corners);
/* What is added is there, or the program has ended. */
void   case_add_grid(bbm_model *m, case_grid *g);
/* A block of one element: the polygon through xy, nodes of its own. Returns the element. */
int    case_add_polygon(bbm_model *m, int block, int material, int n, double (*xy)[2]);
/* A rectangle of nx x ny quadrilaterals: lower left corner (x, y), w x h, then turned about the
 * origin by an angle. Returns its first element; element (i, j) is j nx + i further. */
typedef struct { int block, material, nx, ny; double x, y, w, h, turn; } case_box;
int    case_add_box(bbm_model *m, const case_box *b);
void   case_fix_block(bbm_model *m, int block);                 /* every node of it             */
/* Element 0: a fixed, rigid incline, falling to the left, from `base` pieces; the last element: a
 * block that stands on it, its lower left corner in the origin. Ready to be prepared, with p_s =
 * 0.4 p_n, 2500 kg/m^3 and gravity. Angles in degrees. */
typedef struct { double angle, w, h, friction, p_n, dt; int base; } case_slope;
bbm_model *case_block_on_slope(const case_slope *s);
int    case_node(const bbm_model *m, double x, double y);       /* the node nearest to (x, y)   */
bbm_result case_at(const bbm_model *m, double x, double y);     /* the result there             */
/* u, v, sxx, syy, sxy, svm */
double case_quantity(const bbm_result *r, const char *quantity);
/* Relative error in percent: below zero means smaller, which for a displacement is stiffer. */
double case_percent(double computed, double reference);

typedef struct { int passes, cuts; } case_effort;   /* most passes of a step; all halvings of dt */
void   case_step(bbm_model *m, case_effort *e, scene *s);       /* one step; e and s may be NULL */
/* Quasi-static steps, to start a run in equilibrium: springs that are loaded suddenly would
 * swing. */
void   case_settle(bbm_model *m, int steps);

void   case_read_reference(const char *problem, const char *variant, case_reference *r);
const struct case_value *case_find(const case_reference *r, const char *quantity, double x,
                                   double y);
void   case_free_reference(case_reference *r);

/* Makes out/NAME and opens its results.csv. */
void   case_open(case_results *r, const char *name);
/* Closes it and returns the exit status of the program: 1 if a picture could not be made. NULL:
 * there is none. */
int    case_close(case_results *r);
/* One row of results.csv; kind is theory, fem (converged) or fem_coarse (six-node triangles).
 * Returns the error. */
double case_row(case_results *r, const char *quantity, const double xy[2], double computed,
                double reference, const char *kind);
/* The row `| name | computed | theory | error |` on stdout and in results.csv (without a place). */
double case_compare(case_results *r, const char *name, double computed, double reference);
const char *case_path(const case_results *r, const char *file, char path[128]);
/* table [rows][columns] as CSV */
void   case_write_curves(const case_results *r, const char *file, const char *header, int rows,
                         int columns, const double *table);

/* Pictures in the folder of the results: FILE.svg. One that cannot be made is said on stderr, and
 * case_close tells. */
void   case_draw_chart(case_results *r, const char *file, const plot_chart *c);
/* Several charts in one file, by plot.h. */
void   case_open_page(case_results *r, const char *file, plot *p, double width, double height);
void   case_close_page(case_results *r, plot *p);
void   case_draw_movie(case_results *r, const char *file, const bbm_model *m, const scene *s);
/* The frames nearest to n times. */
void   case_draw_panels(case_results *r, const char *file, const bbm_model *m, const scene *s,
                        int n, const double time[]);
/* Contours of a field of scene.h. */
void   case_draw_map(case_results *r, const char *file, const bbm_model *m, const scene_map *map);
void   case_print_parameters(const bbm_model *m);       /* Table 1, and what the solution took  */
void   case_progress(const char *what);                 /* one line on stdout, at once          */

#endif
