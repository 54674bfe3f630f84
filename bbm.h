/* bbm.h - the bonding block model (BBM), an enrichment of discontinuous deformation analysis (DDA).
 *
 * Sun, Chen, Feng, Wang: "Discontinuous Deformation Analysis Enriched by the Bonding Block Model",
 * Mathematical Problems in Engineering 2015, 723263, doi:10.1155/2015/723263. Eq. (n) and Fig. n
 * mean that paper.
 *
 * A block of a jointed rock mass is subdivided into elements, polygons with the six unknowns
 * D = (u0, v0, r0, ex, ey, gxy) each. Elements of one block that share an edge are glued there by
 * bonding springs; different blocks only touch. Each time step minimises the potential energy,
 * K D = F, and moves the elements by D. A program builds a model, runs it and reads the results:
 *
 *     bbm_model *m;
 *     bbm_model_new(&m);
 *     bbm_add_material(m, &(bbm_material){ .E = 1e9, .density = 2500, .thickness = 1 }, NULL);
 *     for (int k = 0; k < 4; k++)
 *         bbm_add_node(m, x[k], y[k], NULL);
 *     bbm_add_element(m, 0, 0, 4, (int[]){ 0, 1, 2, 3 }, NULL);
 *     bbm_fix_node(m, 0, BBM_XY, 0, 0), bbm_fix_node(m, 1, BBM_Y, 0, 0);
 *     m->par.gravity[1] = -9.81;
 *     if (bbm_prepare(m) || bbm_run(m))
 *         puts(bbm_message(m));
 *     bbm_nodal_result(m, 2, -1, &result);
 *     bbm_model_free(m);
 *
 * Read the structs from small to large, then the functions in three groups: run a model, build one,
 * single formulas. The structs and formulas of bonds and contacts are in base/base.h. Units are SI,
 * indices begin at 0, vertices run counter-clockwise, stress is plane. A function that can fail
 * returns a bbm_status.
 */
#ifndef BBM_H
#define BBM_H

#ifdef __cplusplus
extern "C" {
#endif

#define BBM_VERSION "1.0"

#if defined __FAST_MATH__ || (defined __FINITE_MATH_ONLY__ && __FINITE_MATH_ONLY__)
#error "bbm needs infinity and NaN: compile without -Ofast, -ffast-math, -ffinite-math-only"
#endif

enum { BBM_GAUSS = 4 };                     /* Gauss points of a line load: exact to degree 7   */
enum { BBM_X = 1, BBM_Y = 2, BBM_XY = 3 };  /* directions in which a point is held; they add up */

/* What a call returns. bbm_message() says what failed, where, and what was expected. The core does
 * not look for BBM_SELF_CROSSING and BBM_BLOCKS_OVERLAP. BBM_STEPS_EXHAUSTED: (71) is not met;
 * BBM_NO_EQUILIBRIUM: something falls. */
typedef enum {
    BBM_OK, BBM_NO_MEMORY,
    /* --- the model is wrong --- */
    BBM_NO_ELEMENT, BBM_NOT_FINITE, BBM_BAD_INDEX, BBM_BAD_MATERIAL, BBM_BAD_PARAMETER,
    BBM_BAD_ELEMENT, BBM_SELF_CROSSING, BBM_OVERLAP, BBM_BLOCKS_OVERLAP, BBM_UNUSED_NODE,
    BBM_NOT_BOUNDARY, BBM_FREE_TO_MOVE,
    /* --- the solution failed: the numbers are in bbm_info --- */
    BBM_NOT_POSITIVE_DEFINITE, BBM_NOT_CONVERGED, BBM_STEPS_EXHAUSTED, BBM_NO_EQUILIBRIUM,
    BBM_STEP_TOO_LONG, BBM_OPEN_CLOSE, BBM_TOO_SOFT, BBM_ENERGY, BBM_STOPPED, BBM_STATUS_COUNT
} bbm_status;

/* ------------------------------------------------------------------------------------ the data */

/* Defined in base/base.h: a bond, the gap of a bond or fixed point, a load along an edge (3.3 to
 * 3.5); a boundary edge, a contact (3.7); the matrix K. The paper has nothing of bbm_method,
 * bbm_hooks, bbm_beyond, bbm_motion and bbm_middle. */
typedef struct bbm_bond bbm_bond;       typedef struct bbm_gap bbm_gap;
typedef struct bbm_edge bbm_edge;       typedef struct bbm_contact bbm_contact;
typedef struct bbm_matrix bbm_matrix;   typedef struct bbm_contact_scratch bbm_contact_scratch;
typedef struct bbm_method bbm_method;   typedef struct bbm_line_load bbm_line_load;
typedef struct bbm_hooks bbm_hooks;     typedef struct bbm_beyond bbm_beyond;
typedef struct bbm_motion bbm_motion;   typedef struct bbm_middle bbm_middle;
typedef struct bbm_model bbm_model;

typedef struct {
    double E;                   /* Pa       Young's modulus                  */
    double nu;                  /* -        Poisson's ratio                  */
    double density;             /* kg/m^3   mass per volume                  */
    double thickness;           /* m        out of the plane                 */
} bbm_material;

typedef struct {                /* a grid point; each element that meets there has a vertex on it */
    double x, y;                /* m        starting position                */
    int    held;                /* BBM_X, BBM_Y or both: a fixed point       */
    double wall[2];             /* m        of its wall point W, since the start */
    double load[2];             /* N        concentrated load                */
} bbm_node;

typedef struct {                /* of one element, on one node                                  */
    int    node, element;
    double x, y;                /* m        present position from model.origin                  */
    double u, v;                /* m        displacement since the start                        */
    int    edge;                /* the boundary edge that starts here, by bbm_prepare; for an   */
                                /*          internal edge -1 - w, w the vertex of the other     */
                                /*          element at this place                               */
} bbm_vertex;

typedef struct {                /* triangle, quadrilateral, simple polygon, or a whole block    */
    /* --- input --- */
    int    block;
    int    first, n;            /* its vertices are model.vertex[first .. first+n-1]            */
    bbm_material material;
    double f[2];                /* N/m^2    volume force besides its weight, of (47)            */
    /* --- geometry at the start of the step, by bbm_element_geometry --- */
    double x, y;                /* m        barycentre, from model.origin    */
    double A;                   /* m^2      area                             */
    double Sxx, Syy, Sxy;       /* m^4      second moments of area about the barycentre         */
    /* --- state --- */
    double A0;                  /* m^2      starting area: mass = density * thickness * A0      */
    double V[6];                /* D/s      velocity: the time derivative of D                  */
    double stress[3];           /* Pa       sx, sy, sxy, carried from step to step              */
    double sum[3];              /* m, m, rad    u0, v0 and r0, summed over the steps            */
    double D[6];                /* of the last step, or of its last part: u0, v0 [m], r0 [rad], */
                                /*          ex, ey, gxy [-]                                     */
    double szz;                 /* Pa       stress out of the plane, carried as well            */
    double out_of_plane;        /* -        szz grows by this times the growth of sx + sy;      */
                                /*          0: plane stress                                     */
    const bbm_middle *middle;   /* NULL: T is (2); else the T of a hook                         */
} bbm_element;

/* A load that varies from place to place. The function writes f(x, y) [N/m or N/m^2] into f. x, y:
 * as of nodes for a line load, from model.origin for a volume force. */
typedef void bbm_field(double x, double y, const void *context, double f[2]);

/* What one element adds to K and F. */
typedef struct { double K[6][6], F[6]; } bbm_submatrix;

typedef struct {
    double omega;               /* -        relaxation factor of SSOR, in (0, 2)                */
    double tolerance;           /* -        at most 1e-6: the iteration ends when               */
                                /*          sqrt(r.M^-1 r) is below this share of its first     */
                                /*          value; bbm_solve lowers it where F holds springs    */
                                /*          that close a gap                                    */
    int    iterations;          /* at most, in each connected component of K                    */
    const bbm_method *method;   /* NULL: the paper's                                            */
} bbm_pcg;

typedef struct {                /* what a solve did                                             */
    int    iterations;          /* of the component of K that took most                         */
    double residual;            /* -        |F - K D|/|F|, computed afresh at the end; the      */
                                /*          largest of all components where F is not 0          */
    int    element;             /* whose block row is not positive definite, else -1            */
    double seconds[2];          /* s        CPU time of the preconditioner and of the iteration */
} bbm_pcg_info;

typedef enum { BBM_OPEN, BBM_LOCK, BBM_SLIDE } bbm_contact_state;   /* the figure in contact.c  */

/* The phases whose CPU time is counted. */
enum { BBM_DETECT, BBM_ASSEMBLE, BBM_PRECONDITION, BBM_ITERATE, BBM_PHASES };

/* Defaults: one step of statics, tolerance 0, alpha 100, p_n 1e9, p_s 4e8, faces 1, omega 1, a pcg
 * tolerance of 1e-10, 100000 iterations; all else 0. Reasons for some: doc/paper.md, 4.1. bbm_step
 * refuses what is out of range. Between steps all may change; but in dynamics a stiffness that
 * grows makes energy, and the steps after it may fail for that. */
typedef struct {
    double dt;                  /* s        time step; INFINITY: statics, without inertia       */
    int    steps;               /* in statics: iterations of Newton-Raphson                     */
    double tolerance;           /* -        of (71), which ends the run; 0: do all steps        */
    double velocity_factor;     /* -        share of V that the next step begins with. 0, the   */
                                /*          default: each step begins at rest; dynamics has 1   */
    double alpha;               /* -        factor of the bonding stiffness, (4), (29)          */
    double gravity[2];          /* m/s^2    */
    double p_n, p_s;            /* N/m      normal and shear stiffness of a contact             */
    double friction;            /* degree   friction angle, less than 90                        */
    double round;               /* m        of corners, at most a quarter of the shorter side:  */
                                /*          a lower ledge is no obstacle; 0: sharp; -1: 2e-3 of */
                                /*          the shorter side                                    */
    int    faces;               /* 0: a block touches others with its corners alone; 1: also    */
                                /* with the grid points inside its straight sides, so that a    */
                                /* deformable block lies on its whole side                      */
    bbm_pcg pcg;
} bbm_parameters;

typedef struct {                /* what the last step did                                       */
    int    step;                /* steps done                                                   */
    double t;                   /* s        time so far; statics takes none                     */
    double change;              /* -        (71) asks that this is at most the tolerance        */
    bbm_pcg_info pcg;
    int    passes;              /* solutions of the open-close iteration                        */
    int    cuts;                /* how often dt was halved                                      */
    int    candidates;          /* pairs of a vertex and an edge that the detection compared    */
    int    contacts;            /* that are closed at its end                                   */
    double penetration;         /* m        the deepest of them                                 */
    int    iterations;          /* of SSOR-PCG, in all solutions of the step                    */
    double seconds[BBM_PHASES]; /* s        CPU time, in all steps                              */
} bbm_info;

struct bbm_model {
    /* --- input --- */
    bbm_parameters par;
    int nodes, elements, vertices, line_loads, materials;
    bbm_node      *node;        /* [nodes]                                                      */
    bbm_element   *element;     /* [elements]                                                   */
    bbm_vertex    *vertex;      /* [vertices], element by element                               */
    bbm_line_load *line_load;   /* [line_loads]                                                 */
    bbm_material  *material;    /* [materials]                                                  */
    double origin[2];           /* m        by bbm_add_element: 0, or near a model that is far  */
                                /*          from (0, 0)                                         */
    /* --- made by bbm_prepare --- */
    int is_prepared;            /* 0 again when something is added                              */
    int bonds, edges, gaps, contacts;
    bbm_bond *bond;             /* [bonds]   the internal edges                                 */
    bbm_edge *edge;             /* [edges]   the boundary edges                                 */
    bbm_gap *gap;               /* [gaps]    of bonds and fixed points                          */
    bbm_contact *contact;       /* [contacts] at the end of the last step, by corner and edge   */
    bbm_contact_scratch *scratch;
    int *adjacent_first;        /* [nodes+1] the vertices at node n are                         */
    int *adjacent;              /* [vertices]    adjacent[adjacent_first[n] ..]                 */
    /* --- K D = F --- */
    bbm_matrix *K;
    int links, (*link)[2];      /* the two elements of each contact and bond in K               */
    double *F, *D, *load;       /* [6 elements]; load: the part of F from outside               */
    /* --- the present step --- */
    double h;                   /* s        dt, or a part of it                                 */
    double acceleration[2];     /* m/s^2    of gravity                                          */
    int detections;             /* how often its contacts were listed                           */
    /* --- results --- */
    bbm_info info;
    bbm_status status;          /* the first error while building                               */
    char message[300];          /* what the last error was about                                */
    int  blamed[2];             /* elements that it names                                       */
    /* --- called before each solution, to see K and F; a result other than 0 stops the run --- */
    int (*monitor)(const bbm_model *m, void *context);
    void *monitor_context;
    /* --- what the paper does not have --- */
    bbm_hooks *hook;
    bbm_beyond *beyond;
};

typedef struct {                /* at a grid point                                              */
    double u, v;                /* m                                                            */
    double stress[3];           /* Pa       sx, sy, sxy                                         */
    double szz;                 /* Pa       out of the plane                                    */
    double mises;               /* Pa       von Mises                                           */
} bbm_result;

/* ----------------------------------------------------------------------------- 1. run a model */

/* A step that fails leaves the model as it was; but of a step in parts those before the one that
 * failed are done. */
bbm_status  bbm_run(bbm_model *m);                          /* par.steps more steps             */
bbm_status  bbm_step(bbm_model *m);                         /* one step, Fig. 8                 */
/* The mean over the elements that meet at a node of a prepared model: those of one block, or of all
 * (-1). Without such elements, or if it is not prepared, BBM_BAD_INDEX without a message. */
bbm_status  bbm_nodal_result(const bbm_model *m, int node, int block, bbm_result *r);
void        bbm_displacement(const bbm_element *e, const double D[6], double x, double y,
                             double u[2]);                  /* (1)                              */
double      bbm_mises(const double stress[3], double szz);
const char *bbm_status_text(bbm_status s);
const char *bbm_message(const bbm_model *m);                /* about the last error             */

/* --------------------------------------------------------------------------- 2. build a model
 * Once a bbm_add or bbm_fix has failed, the later calls, bbm_prepare and bbm_step do nothing and
 * return its status. So a program may check bbm_prepare alone. What is added after it needs it
 * again, but for fixed nodes and loads of nodes; after the first step nothing else is added. The
 * index of what was added goes through the last pointer, which may be NULL. */

bbm_status bbm_model_new(bbm_model **m);
void       bbm_model_free(bbm_model *m);                    /* takes NULL                       */
bbm_status bbm_add_material(bbm_model *m, const bbm_material *material, int *index);
bbm_status bbm_add_node(bbm_model *m, double x, double y, int *index);
bbm_status bbm_add_element(bbm_model *m, int block, int material, int n, const int node[],
                           int *index);                     /* the nodes in either sense        */
bbm_status bbm_fix_node(bbm_model *m, int node, int directions, double u, double v);    /* W: m */
bbm_status bbm_add_load(bbm_model *m, int node, double fx, double fy);      /* N, adds up       */
bbm_status bbm_add_line_load(bbm_model *m, int node1, int node2, double fx, double fy); /* N/m  */
bbm_status bbm_add_varying_line_load(bbm_model *m, int node1, int node2, bbm_field *f,
                                     const void *context);
bbm_status bbm_prepare(bbm_model *m);                       /* checks, finds the edges (2.2)    */

/* ---------------------------------------------------------------- 3. single formulas, each alone
 * A submatrix function adds to what it is given. vertex[]: those of the element alone. Mass and (4)
 * take A0, which the caller sets. For bonds and contacts see base/base.h. */

/* 2.1, 2.2 */
void   bbm_element_geometry(bbm_element *e, const bbm_vertex vertex[]); /* m->vertex + e->first */
void   bbm_mode_matrix(const bbm_element *e, double x, double y, double T[2][6]);       /* (2)  */
double bbm_bonding_stiffness(double alpha, const bbm_element *i, const bbm_element *j); /* (4)  */
/* 3.1, 3.2 */
void   bbm_elastic_matrix(const bbm_material *m, double E[3][3]);               /* (7)          */
void   bbm_elastic_submatrix(const bbm_element *e, bbm_submatrix *s);           /* (10)         */
void   bbm_mode_integral(const bbm_element *e, double M[6][6]);                 /* int T^T T dA */
void   bbm_inertia_submatrix(const bbm_element *e, double dt, bbm_submatrix *s);    /* (16), (17) */
void   bbm_newmark_velocity(bbm_element *e, double dt, double factor);          /* (14)         */
/* 3.4, 3.5, 3.6 */
double bbm_fixed_stiffness(double alpha, const bbm_element *e);                 /* (29)         */
void   bbm_point_load(const bbm_element *e, double x, double y, const double f[2], double F[6]);
void   bbm_gauss_point(int g, double *s, double *weight);                       /* 0 <= s <= 1  */
void   bbm_varying_load_submatrix(const bbm_element *e, const bbm_vertex *a, const bbm_vertex *b,
                                  const double f[BBM_GAUSS][2], double F[6]);   /* (42)         */
void   bbm_constant_load_submatrix(const bbm_element *e, const bbm_vertex *a, const bbm_vertex *b,
                                   const double f[2], double F[6]);             /* (43)         */
void   bbm_varying_volume_submatrix(const bbm_element *e, const bbm_vertex vertex[], bbm_field *f,
                                    const void *context, double F[6]);  /* (46), f up to linear */
void   bbm_volume_submatrix(const bbm_element *e, const double f[2], double F[6]);      /* (47) */
void   bbm_gravity_submatrix(const bbm_element *e, const double g[2], double F[6]);     /* (47) */

#ifdef __cplusplus
}
#endif

#endif
