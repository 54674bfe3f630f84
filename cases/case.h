/* case.h - what the experiments share: structured meshes, reference values, tables, results as
 * files. */
#ifndef CASE_H
#define CASE_H

#include "../program/cell.h"
#include "../program/plot.h"
#include "../program/scene.h"

typedef struct {                    /* a grid of nx x ny cells                                  */
    int nx, ny, cut, block, material;
    double x, y, w, h;              /* over a rectangle, from its lower left corner, or mapped: */
    void (*map)(double i, double j, const void *context, double xy[2]); /* grid line -> point */
    const void *context;
    int first;                      /* its first node, set by case_add_grid: node (i, j) is     */
                                    /* first + j (nx+1) + i                                     */
} case_grid;

typedef struct {                    /* values of cases/fem.csv for one problem and variant      */
    int values;
    struct case_value { char quantity[32]; double x, y, converged, six_node; } value[110];
} case_reference;

typedef struct {                    /* out/NAME/results.csv                                     */
    char folder[64], path[128];     /* path: of case_path, the last file                        */
    FILE *csv;
    int failed;                     /* 1: a picture could not be made                           */
} case_results;

/* A status is printed with its message and the program ends with 1: what is written so far
 * stays. */
void   case_must(const bbm_model *m, bbm_status s);

/* A new model of the core alone: the paper's way. What the experiments print or draw is computed by
 * it, but for what has `beyond/` in its row or heading. */
bbm_model *case_paper_model(void);
/* beyond.c: a new model with all of beyond/, so many rounds of multipliers, and bonds with moments
 * or at vertices. NULL from paper.c, which `make paper` has in its place. */
bbm_model *case_beyond_model(int rounds, int moments);

/* Returns its first element; of quadrilaterals, (i, j) is j nx + i further. What is added is there,
 * or the program has ended. */
int    case_add_grid(bbm_model *m, case_grid *g);
/* u, v, sxx, syy, sxy or mises of the node nearest to the point. */
double case_at(const bbm_model *m, const char *quantity, double x, double y);
void   case_solve(bbm_model *m);                                /* prepared and run             */
/* Relative error in percent: below zero means smaller, which for a displacement is stiffer. */
double case_percent(double computed, double reference);

/* The values of a variant, in the order of the file. */
void   case_read(const char *problem, const char *variant, case_reference *r);
const struct case_value *case_find(const case_reference *r, const char *name, double x, double y);
typedef struct {                    /* a solution of an experiment, alpha = 1000                */
    const char *variant;
    int beyond;                     /* with beyond/: quadrilaterals, as many as the triangles   */
    const char *summary;            /* of the others, which are the paper's way; the last: its  */
} case_run;                         /* name in the summary                                      */
typedef struct { const char *file; scene map; } case_map;
/* A row of the summary: a value of a run, whose unit is one unit-th of SI's. */
typedef struct { int run; const char *quantity; double x, y, unit; } case_point;

typedef struct { const char *quantity; double x, y; } case_place;
typedef struct {                    /* values at places, in one unit-th of SI's                 */
    const char *name, *what;        /* of the table or figure of the paper, and what it shows   */
    double unit;
    int places;
    const case_place *place;
} case_table;

typedef struct {                    /* Experiment I or II                                       */
    const char *name, *title;       /* of its folder, and of what it prints                     */
    /* Solves a variant on a grid of k times its cells; and of u, v, sxx, .. at a grid point the
     * computed value, and theory's, NaN where there is none. */
    void (*solve)(bbm_model *m, const char *variant, int cut, int k, double alpha);
    double (*computed)(const bbm_model *m, const char *quantity, double x, double y);
    double (*theory)(const char *quantity, double x, double y);
    int runs, maps, points, tables; /* runs: 4 at most; maps: of the first                      */
    const case_run *run;
    const case_table *table;        /* of each run in the paper's way                           */
    const case_map *map;
    const char *summary;            /* the head of the table of what the experiment comes to    */
    const case_point *point;        /* [points] its rows, against converged finite elements     */
    /* Its other tables and pictures, of each run, NULL where there is no beyond/, with its
     * reference values. */
    void (*show)(case_results *r, const bbm_model *const m[], const case_reference ref[]);
    /* The table of convergence, of the variant of the second run: the errors at one or two places,
     * against converged finite elements. */
    const char *errors;
    case_place error[2];
} case_experiment;

/* All of it, or with the argument `converge` the table of convergence alone; the exit status. */
int    case_main(const case_experiment *e, int argc, char **argv);

/* Makes out/NAME and opens its results.csv. */
void   case_open(case_results *r, const char *name);
/* Closes it and returns the exit status of the program: 1 if a picture could not be made. NULL:
 * there is none. */
int    case_close(case_results *r);
/* One row of results.csv; kind is theory, fem (converged) or fem_coarse (six-node triangles). */
void   case_row(case_results *r, const char *quantity, const double xy[2], double computed,
                double reference, const char *kind);
const char *case_path(case_results *r, const char *file);       /* in the folder, until the next */
/* done: of a picture at case_path, by plot.h or scene.h. One that cannot be made is said on stderr,
 * and case_close tells. */
void   case_draw(case_results *r, int done);
void   case_print_parameters(const bbm_model *m);       /* Table 1                              */

#endif
