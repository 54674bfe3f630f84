/* models.h - the models that the tests share: polygons, bodies of elements, blocks that touch; and
 * what the tests ask of them.
 *
 * Tolerances. ROUNDING, see shapes.h. SOLVED: after a solve, rounding times the condition number:
 * about 10 alpha on small meshes, p_n dt^2/m = 40 to 1e3 with contacts, where the slack of the
 * open-close iteration is 1e-9 of the largest force. Where a tolerance is larger, what it has to
 * let pass is said beside it. */
#ifndef BBM_TESTS_MODELS_H
#define BBM_TESTS_MODELS_H

#include "../beyond/beyond.h"
#include "check.h"
#include "shapes.h"

#define SOLVED 1e-9

/* --------------------------------------------------------------------------- bodies of elements */

extern const bbm_material SOLID;
extern const bbm_material CORK;

/* Statics in one step, which is linear elasticity on the starting geometry; solved as far as
 * rounding allows. */
bbm_model *new_model(const bbm_material *material);

/* nx x ny cells on a rectangle, each one quadrilateral (triangles = 0) or two triangles (1); 2: every third is two. */
typedef struct {
    double x, y, lx, ly;
    int nx, ny, triangles;
    double jitter;              /* displacement of the inner nodes against the cell */
    int first, element;         /* its first node and element: set by add_grid */
    double angle;               /* [rad] by which it is turned about (x, y) */
} grid;

int node_at(const grid *g, int i, int j);
void add_grid(bbm_model *m, grid *g, int block);

/* Holds the left side of a grid and loads its right top corner: a cantilever, ready to run. */
bbm_model *cantilever(const bbm_material *material, grid *g, double fx, double fy);

/* One unit square of the given material: nodes 0 to 3, counter-clockwise from the origin. */
bbm_model *unit_square(const bbm_material *material);

/* Points for polygons, all times a size:
 *
 *     20 21 22 23 24
 *     15 16 17 18 19
 *     10 11 12 13 14
 *      5  6  7  8  9
 *      0  1  2  3  4      and 25 at (1, 1e-13), 26 at (1, 1e-6), 27 at (1e-13, 1) */
bbm_model *points(double size);

bbm_result result_at(const bbm_model *m, int node);

enum { LINKS = 6 };

/* LINKS elements of 0.5 x 1 m in a row, held at the left, pulled by 3 N at the right; material e %
 * materials. */
bbm_model *new_bar(const bbm_material *material, int materials);

/* Total force and moment about the origin of what is loaded on element e of an unsolved model: the
 * first three of F are the work of the load in a translation and in a rotation about the
 * barycentre. */
void total_load(const bbm_model *m, int e, double total[3]);

void rising_load(double x, double y, const void *context, double f[2]);

/* Nodal displacements of the finite element on the model's mesh, of triangles, with its fixed
 * points and loads. */
double *finite_element(const bbm_model *m);

/* The largest difference from it of the nodal displacements that a run of a prepared model gives,
 * against its largest. Frees the model. */
double distance_from_finite_element(bbm_model *m);

/* 0--1--2 */
bbm_model *two_squares(int block0, int block1);

/* A fan of triangles on nodes 0, 1 and one of 2, 3, ... each: (0, 1, 2), (0, 1, 3), ... with the
 * given blocks. */
bbm_model *fan(int triangles, const double top[][2], const int block[]);

/* ---------------------------------------------------------------------------- blocks that touch */

static const double PI = 3.14159265358979323846, GRAVITY = 9.81, DENSITY = 2500;

double radians(double degrees);

enum { ROCK, BASE };            /* materials */

/* Blocks of rock on a base that gives way 10^4 times less, under gravity, the solver as exact as it
 * can be. */
bbm_model *new_blocks(void);
bbm_model *weightless_blocks(void);

/* A rectangle of nx times ny elements, 1 if not given: its lower left corner, sides, and the angle
 * [degree] by which all this is turned about the origin. */
typedef struct { double x, y, w, h, angle; int nx, ny, fixed; } rectangle;

/* Adds it; the index of its first element. */
int add_rectangle(bbm_model *m, int block, int material, rectangle r);

/* Adds a polygon as a block of one element. */
int add_polygon(bbm_model *m, int block, int n, const double p[][2]);

/* Fixed table under y = 0 from x = -5 to 5. */
void add_table(bbm_model *m, int block);

/* Blocks that lie in each other, for the detection alone: prepared while each has its nodes in a
 * place of its own. */
void prepare_apart(bbm_model *m);

/* A hook that lists the gaps of edge bonds without their moments: sides are held in their middles
 * alone. */
void list_middles(bbm_model *m);

void set_springs(bbm_model *m, double p_n, double p_s);        /* of contacts */

/* Unless it is prepared already. With it begin run, run_steps, settle, set_velocity, detect and
 * start_step. */
void prepare(bbm_model *m);

/* As par.steps says. */
void run(bbm_model *m);
void run_steps(bbm_model *m, int steps);

/* Steps without memory of velocity, which end at rest. */
void settle(bbm_model *m, int steps);

void set_velocity(bbm_model *m, int element, double vx, double vy);
const bbm_vertex *vertex_of(const bbm_model *m, int element, int corner);
int corner_block(const bbm_model *m, const bbm_contact *c);
int edge_block(const bbm_model *m, const bbm_contact *c);
const bbm_vertex *start_of(const bbm_model *m, int edge);
const bbm_vertex *end_of(const bbm_model *m, int edge);
const bbm_vertex *corner_vertex(const bbm_model *m, const bbm_contact *c);

/* The sum of the normal forces between two blocks. */
double normal_force(const bbm_model *m, int p, int q);

/* The closed contact of a vertex of an element, or NULL. */
const bbm_contact *contact_of(const bbm_model *m, int element, int corner);

/* What a step may change and the next one starts from, in one piece of memory; the number of
 * doubles. */
enum { STATE = 4000 };

size_t state_of(const bbm_model *m, double state[STATE]);
int same_state(const bbm_model *m, const bbm_model *n);

typedef struct { int n; double x[12][2]; } outline;             /* of a block, counter-clockwise */

/* Turned by `angle` radians and moved. */
outline put(const outline *o, double angle, double x, double y);

extern const outline SQUARE;    /* of 1 m, about the origin */

/* An L with a notch, and a strip of two elements whose corners 1 and 4 are none. */
extern const outline NOTCHED;

outline random_outline(int kind, double x, double y, unsigned *seed);

/* The outline as a block; a strip as two elements. */
void add_outline(bbm_model *m, int block, const outline *o, int strip);

enum { ROWS = 6, COLUMNS = 7, SLABS = 2, BLOCKS = ROWS * COLUMNS + SLABS };

/* Lists the contacts of the next step, as bbm_step does before it solves. */
void detect(bbm_model *m);

extern const double ANGLES[6];

/* A wall of bricks, each row shifted, all turned by some angle: many sides coincide and many
 * corners meet. */
bbm_model *wall(const int order[16], double angle);

/* The interval on which a block lies on another carries its weight like a beam: N = W (b - x)/(b -
 * a) at the end a. */
typedef struct { double x, w; } seat;

extern const seat SEATS[10];

/* How far the foot of a contact's corner is beyond the ends of its edge, and the sine by which the
 * corner's sides point away from the edge, the lesser one. */
void stand(const bbm_model *m, const bbm_contact *c, double *beyond, double *clear);

/* A block of 1 m x 0.5 m on a fixed incline of `pieces` elements at 30 degrees; it is element
 * pieces. */
bbm_model *incline(double phi, double p_n, int pieces);

double slid(const bbm_model *m, int e);

enum { PILE = 6 };

/* Six polygons that fall onto a table in two rows. */
bbm_model *pile(unsigned seed, int reversed);

/* Steps until the pile has lain down, from a model just prepared. */
bbm_status fall(bbm_model *m);

/* The contacts of the step in hand. */
bbm_contact *list_contacts(const bbm_model *m, int *n);

/* Starts a step: what it foretells, and its list; what touches as the run begins is open. */
bbm_contact *start_step(bbm_model *m, int *n);

/* A look at a solution in which one element moves by (u, v) and nothing else; the closed
 * contacts. */
int look_at(bbm_model *m, int e, double u, double v);

/* The contact of the list whose corner starts in a vertex of an element and whose edge starts in
 * one of another, or NULL. */
bbm_contact *find_listed(const bbm_model *m, int e, int corner, int f, int edge);

void shift_element(bbm_model *m, int e, double x, double y);

/* A wedge, 1 m long, whose tip is in `at` and whose sides leave it at these angles, in radians. */
int add_wedge(bbm_model *m, int block, const double at[2], double from, double to);

enum { RIGHT, TOP };            /* sides of the square, by the vertex that starts them, less 1 */

/* A unit square under the origin and to the left of it, and a narrow wedge whose tip, 1 mm to the
 * right of its corner and above it, points down to the left, so that it can come in at both sides.
 * The contact with one side is taken for closed in a step that ended 2 mm deep. Then the tip
 * stands at (x, y), and a step begins; its list. */
bbm_model *tip_at(int side, double x, double y, bbm_contact *touched[2]);

#endif
