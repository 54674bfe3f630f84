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
 * Read the structs from small to large, then the functions in tiers: run a model, build one, single
 * formulas; what the files of the library share comes last, and K stands in base/base.h. SI units,
 * plane stress, indices from 0, elements counter-clockwise. What can fail returns a bbm_status.
 */
#ifndef BBM_H
#define BBM_H

#define BBM_VERSION "0.1"

#if defined __FAST_MATH__ || (defined __FINITE_MATH_ONLY__ && __FINITE_MATH_ONLY__)
#error "bbm needs infinity and NaN: compile without -Ofast, -ffast-math, -ffinite-math-only"
#endif

enum { BBM_GAUSS = 4 };                     /* Gauss points of a line load: exact to degree 7   */
enum { BBM_X = 1, BBM_Y = 2, BBM_XY = 3 };  /* directions in which a point is held; they add up */

/* What a call returns, and what that says; bbm_message() adds where, and what was expected. */
#define BBM_STATUSES(status)                                                                      \
    status(BBM_OK,                    "no error")                                                 \
    status(BBM_NO_MEMORY,             "out of memory")                                            \
    /* --- the model is wrong --- */                                                              \
    status(BBM_NO_ELEMENT,            "the model has no element")                                 \
    status(BBM_NOT_FINITE,            "a number is NaN or infinite")                              \
    status(BBM_BAD_INDEX,             "no such node, element or material")                        \
    status(BBM_BAD_MATERIAL,          "a material is impossible")                                 \
    status(BBM_BAD_PARAMETER,         "a parameter is outside its range")                         \
    status(BBM_BAD_ELEMENT,           "an element is no polygon")                                 \
    status(BBM_SELF_CROSSING,         "the boundary of an element meets itself")                  \
    status(BBM_OVERLAP,               "elements of one block overlap")                            \
    status(BBM_BLOCKS_OVERLAP,        "blocks overlap at the start")                              \
    status(BBM_UNUSED_NODE,           "a node belongs to no element")                             \
    status(BBM_NOT_BOUNDARY,          "a line load needs a boundary edge")                        \
    status(BBM_FREE_TO_MOVE,          "statics needs bodies that are held")                       \
    status(BBM_MECHANISM, "elements bonded at midpoints alone can turn against each other")       \
    /* --- the solution failed: the numbers are in bbm_info --- */                                \
    status(BBM_NOT_POSITIVE_DEFINITE, "the stiffness matrix is not positive definite")            \
    status(BBM_NOT_CONVERGED,         "the equations were not solved")                            \
    status(BBM_STEPS_EXHAUSTED,       "no equilibrium in the given steps")                        \
    status(BBM_NO_EQUILIBRIUM,        "statics finds no equilibrium")                             \
    status(BBM_STEP_TOO_LONG,         "the step is too long")                                     \
    status(BBM_OPEN_CLOSE,            "the open-close iteration does not settle")                 \
    status(BBM_TOO_SOFT,              "the contacts are too soft")                                \
    status(BBM_ENERGY,                "the step makes energy")                                    \
    status(BBM_STOPPED,               "stopped from outside")

#define BBM_STATUS_NAME(name, text) name,
typedef enum { BBM_STATUSES(BBM_STATUS_NAME) BBM_STATUS_COUNT } bbm_status;

/* ------------------------------------------------------------------------------------ the data */

typedef struct {
    double E;                   /* Pa       Young's modulus                  */
    double nu;                  /* -        Poisson's ratio                  */
    double density;             /* kg/m^3   mass per volume                  */
    double thickness;           /* m        out of the plane                 */
} bbm_material;

typedef struct {                /* a grid point; the elements that meet there have a vertex each */
    double x, y;                /* m        starting position                */
    int    held;                /* BBM_X, BBM_Y or both: a fixed point       */
    double wall[2];             /* m        displacement of the wall point W that it is held to */
    double load[2];             /* N        concentrated load                */
} bbm_node;

typedef struct {                /* a corner of one element                                      */
    int    node, element;
    double x, y;                /* m        present position                 */
    double u, v;                /* m        displacement since the start: x = node.x + u        */
    int    edge;                /* the boundary edge that starts here, or -1 - w, where w is    */
                                /*          the vertex across the bond; by bbm_prepare          */
} bbm_vertex;

typedef struct bbm_element bbm_element;

/* The displacement mode matrix of a step at the point that starts it in (x, y), and where the point
 * is then: `at`. */
typedef void bbm_mode(const bbm_element *e, double x, double y, double T[2][6], double at[2]);

struct bbm_element {            /* triangle, quadrilateral, simple polygon, or a whole block    */
    /* --- input --- */
    int    block;
    int    first, n;            /* its vertices are model.vertex[first .. first+n-1]            */
    bbm_material material;
    /* --- geometry of the step, by bbm_element_geometry --- */
    double x, y;                /* m        barycentre                       */
    double A;                   /* m^2      area                             */
    double Sxx, Syy, Sxy;       /* m^4      second moments of area about the barycentre         */
    /* --- state --- */
    double A0;                  /* m^2      starting area: mass = density * thickness * A0      */
    double V[6];                /* D/s      velocity of D                    */
    double stress[3];           /* Pa       sx, sy, sxy, carried from step to step              */
    double sum[3];              /* m, m, rad    u0, v0 and r0, summed over the steps            */
    double D[6];                /* of the last step: u0, v0 [m], r0 [rad], ex, ey, gxy [-]      */
    /* --- T of the step, NULL: (2); and the D for which that was made --- */
    bbm_mode *mode;
    double mode_D[6];
};

typedef struct {                /* an internal edge: two bonding springs, elements i and j      */
    int i, j;
    int p[2], q[2];             /* vertices: p[0], p[1] of i coincide with q[0], q[1] of j      */
} bbm_bond;

typedef struct { double x, y, length; } bbm_direction;         /* unit vector; m                */

typedef struct {                /* a boundary edge from vertex a to b, its element on the left  */
    int element, a, b, block;
    /* --- contact.c --- */
    int    first;               /* one of the elements of its block, for all of them            */
    int    before, after;       /* its neighbours along the boundary                            */
    int    side;                /* the first edge of the straight side that it belongs to       */
    double span;                /* m        length of that side at the start, of its first edge */
    bbm_direction along;        /* of the present positions                                     */
    int    contact, pair;       /* the first ones of the corner a in model.contact and in the   */
                                /* pairs that may touch                                         */
} bbm_edge;

/* What glues: the gap d = d0 + T_i D_i - T_j D_j, with the energy 1/2 d.W d + f.d. */
typedef struct {
    int    i, j;                /* elements; j = -1: the wall, which does not move: T_j = 0     */
    int    penalty;             /* 1: W stands for a rigid joint; 0: it is a stiffness          */
    double d0[2];               /* m        at the start of the step         */
    double Ti[2][6], Tj[2][6];
    double W[2][2];             /* N/m      weight: k I for a spring k       */
    double f[2];                /* N        multiplier: what it carries besides W d; 0: paper   */
    double f_before[2];         /* N        the same at the end of the last step                */
    int    node[2];             /* j = -1: the grid points that are held, half each             */
} bbm_gap;

typedef struct {                /* a load along a boundary edge                                 */
    int    node[2];             /* its ends                                  */
    int    constant;            /* then f[0] is all of it, Eq. (43)          */
    double f[BBM_GAUSS][2];     /* N/m      at the Gauss points from node[0] to [1], Eq. (42)   */
    int    a, b;                /* the vertices at its ends, by bbm_prepare  */
} bbm_line_load;

/* A load that varies from place to place: writes f(x, y) [N/m or N/m^2] into f. */
typedef void bbm_field(double x, double y, const void *context, double f[2]);

/* What one element adds to K and F, and what two add; K_ji = K_ij^T. */
typedef struct { double K[6][6], F[6]; } bbm_submatrix;
typedef struct { double Kii[6][6], Kij[6][6], Kjj[6][6], Fi[6], Fj[6]; } bbm_submatrices;

typedef struct bbm_method bbm_method;           /* another than the paper's, see base/base.h    */

typedef struct {
    double omega;               /* -        relaxation factor of SSOR, in (0, 2)                */
    double tolerance;           /* -        of the residual, in the preconditioner's norm       */
    int    iterations;          /* at most; both for each connected component of K by itself    */
    const bbm_method *method;   /* NULL: the paper's                                            */
} bbm_pcg;

typedef struct {                /* what a solve did                                             */
    int    iterations;          /* of the connected component of K that took most               */
    double residual;            /* -        |F - K D|/|F|, computed afresh at the end; of the   */
                                /*          component where it is largest, if its F is not 0    */
    int    element;             /* block row where K is not positive definite, else -1          */
    double seconds[2];          /* s        CPU time of the preconditioner and of the iteration */
} bbm_pcg_info;

/* What CPU time is counted for. */
enum { BBM_DETECT, BBM_ASSEMBLE, BBM_PRECONDITION, BBM_ITERATE, BBM_PHASES };

typedef enum { BBM_OPEN, BBM_LOCK, BBM_SLIDE } bbm_contact_state;
/* Trials of a static step: as ever; friction as a load in any case; one change of state a pass. */
enum { BBM_AS_EVER, BBM_FRICTION_A_LOAD, BBM_ONE_BY_ONE };
typedef enum { BBM_PASS_DONE, BBM_PASS_AGAIN, BBM_PASS_GIVE_UP } bbm_pass;

typedef struct {                /* vertex P1 of one block against an edge P2 P3 of another      */
    /* --- identity: boundary edges; P1 starts `corner`, P2 ends `edge`, P3 starts it --- */
    int    corner, edge;
    /* --- state, carried from step to step --- */
    bbm_contact_state state;
    double sign;                /* of the slip while it slides: 1 towards P3                    */
    double anchor;              /* -        P0 = P3 + anchor (P2 - P3)                          */
    double rest;                /* m        d_n at which the normal spring carries nothing: 0,  */
                                /*          or where it was when it closed inside, so that no   */
                                /*          spring starts loaded                                */
    double N, T;                /* N        normal force; what the shear spring carries or      */
                                /*          would carry                                         */
    double area;                /* m^2      that P1 stands for of an unbroken joint, or 0       */
    int    inside;              /* opened with P1 still inside, where it had closed, see rest   */
    /* --- of the step --- */
    int    entrance[4];         /* the other entrance lines, contacts in the list or -1: two    */
                                /*          at P3, two at P2                                    */
    int    was_closed;          /* at the start                                                 */
    int    beyond_end;          /* the projection of P1 is not on the edge at the start         */
    double d_n0;                /* m        d_n at the start                                    */
    double time_left;           /* -        of the step when P1 hit, on which the shear spring  */
                                /*          acts                                                */
    double d_n, d_s;            /* m        normal distance and slip at the end                 */
    double N_of_friction;       /* N        the N that friction is taken for                    */
    int    friction_in_K;       /* that is the N of the solution itself                         */
    double force_tolerance;     /* N        forces that differ by less agree                    */
    bbm_contact_state next_state;
    int    closings;
} bbm_contact;

typedef struct {                /* what the formulas of 3.7 take                                */
    const bbm_element *i, *j;
    const bbm_vertex *P1, *P2, *P3;
    int exact;                  /* with what (60) drops; 0: the paper                           */
    double rest;                /* m        see bbm_contact; 0: the paper                       */
} bbm_touch;

typedef struct { double d, e[6], g[6]; } bbm_spring;        /* length d + e.D_i + g.D_j     */

typedef struct {
    double dt;                  /* s        time step; INFINITY: statics, without inertia        */
    int    steps;               /* time steps; in statics load steps (Newton-Raphson iterations) */
    double tolerance;           /* -        of (71), ends the steps; 0: do all steps            */
    double velocity_factor;     /* -        share of V with which the next step begins: 1       */
                                /*          dynamics, 0 a step from rest                        */
    double alpha;               /* -        of the bonding stiffness, (4) and (29)              */
    double gravity[2];          /* m/s^2    */
    double p_n, p_s;            /* N/m      normal and shear stiffness of a contact             */
    double friction;            /* degree   friction angle                                      */
    double cohesion, tension;   /* Pa       shear and tensile strength of unbroken joints       */
    int    faces;               /* 1: grid points inside a straight side touch other blocks,    */
                                /* too: a deformable block rests on its whole side; 0: on its   */
                                /* two corners, as a bridge                                     */
    bbm_pcg pcg;
} bbm_parameters;

typedef struct {                /* what the last step did                                       */
    int    step;                /* steps done                                                   */
    double t;                   /* s        time at their end; statics takes none                */
    double change;              /* -        left side of (71) over its right side / tolerance   */
    bbm_pcg_info pcg;
    int    passes;              /* solutions of the open-close iteration                        */
    int    cuts;                /* how often dt was halved                                      */
    int    candidates;          /* pairs of a vertex and an edge that the detection compared    */
    int    contacts;            /* closed                                                       */
    double penetration;         /* m        the deepest                                         */
    int    iterations;          /* of SSOR-PCG, in all solutions of the step                    */
    double seconds[BBM_PHASES]; /* s        CPU time, in all steps                              */
} bbm_info;

typedef struct bbm_model bbm_model;
typedef struct bbm_matrix bbm_matrix;               /* K, see base/base.h                       */
typedef struct bbm_contact_scratch bbm_contact_scratch;     /* in contact.c             */
typedef struct bbm_beyond bbm_beyond;               /* of the hooks                             */

/* Where what the paper does not have comes in; NULL: the paper's way. */
typedef struct {
    /* --- building --- */
    void (*release)(bbm_model *m);                          /* frees m->beyond                  */
    bbm_status (*check_polygon)(bbm_model *m, int n, const int node[]);     /* of a new element */
    bbm_status (*check)(bbm_model *m);                      /* of a prepared model              */
    /* --- a step begins --- */
    bbm_status (*check_step)(bbm_model *m);                 /* parameters in their ranges       */
    void (*accelerate)(bbm_model *m);                       /* changes m->acceleration          */
    void (*begin)(bbm_model *m);                            /* the contacts are listed          */
    bbm_status (*check_listed)(bbm_model *m);               /* and the gaps                     */
    bbm_status (*find_pairs)(bbm_model *m, double search);  /* bbm_add_pair for all near pairs  */
    double (*joint_area)(const bbm_model *m, int corner, int edge);         /* at the start     */
    const bbm_parameters *(*strength)(const bbm_model *m, int corner, int edge); /* of a contact */
    /* --- K D = F --- */
    void (*load)(bbm_model *m);                             /* adds to m->load                  */
    void (*list_gaps)(bbm_model *m);                        /* in place of bonds, fixed points  */
    bbm_status (*lay_out)(bbm_model *m);                    /* K is new                         */
    void (*before_solution)(bbm_model *m);                  /* K and F are assembled            */
    /* --- open-close --- */
    int (*friction)(bbm_model *m, const bbm_contact *c, const bbm_touch *t, bbm_submatrices *s);
                                                            /* 1: added for the N of the solution */
    int (*is_exact)(const bbm_model *m);                    /* T is that of the middle of a step */
    int (*renew)(bbm_model *m);                             /* T of the elements; 1: it changed */
    int (*settled)(bbm_model *m);                           /* 1: solve once more with this K   */
    /* --- the end of the step --- */
    void (*move)(const bbm_model *m, const double D[6], double X, double Y, double u[2]);
                                                            /* in place of u = T D              */
    void (*turn)(const bbm_element *start, bbm_element *e, const bbm_vertex vertex[]);
                                                            /* an element that has moved, if so */
    double (*out_of_plane)(const bbm_element *e);           /* its szz; NULL: plane stress      */
    bbm_status (*accept)(bbm_model *m, const bbm_model *end);       /* before the model moves   */
    bbm_status (*explain)(bbm_model *m, bbm_status s);      /* why the step failed              */
} bbm_hooks;

struct bbm_model {
    /* --- input --- */
    bbm_parameters par;
    int nodes, elements, vertices, line_loads, materials;
    bbm_node      *node;        /* [nodes]                                                      */
    bbm_element   *element;     /* [elements]                                                   */
    bbm_vertex    *vertex;      /* [vertices], element by element                               */
    bbm_line_load *line_load;   /* [line_loads]                                                 */
    bbm_material  *material;    /* [materials]                                                  */
    /* --- made by bbm_prepare --- */
    int bonds, edges;
    bbm_bond *bond;             /* [bonds]   the internal edges                                 */
    bbm_edge *edge;             /* [edges]   the boundary edges                                 */
    int *adjacent_first;        /* [nodes+1] the vertices at node n are                         */
    int *adjacent;              /* [vertices]    adjacent[adjacent_first[n] ..]                 */
    /* --- K D = F --- */
    bbm_matrix *K;
    double *F, *D;              /* [6 elements]                                                 */
    double *load;               /* [6 elements] the part of F from outside: loads, gravity      */
    int gaps;
    bbm_gap *gap;               /* [gaps]    bonds and fixed points                             */
    bbm_element *end_element;   /* [elements] the end of the step, see move_model               */
    bbm_vertex *end_vertex;     /* [vertices]                                                   */
    /* --- contacts --- */
    int contacts;
    bbm_contact *contact;       /* [contacts] at the end of the last step, by corner and edge   */
    bbm_contact_scratch *scratch;
    int pairs, (*pair)[2];      /* elements of the contacts and bonds that K has room for       */
    /* --- the step in hand --- */
    double h;                   /* s        dt, or a part of it                                 */
    double acceleration[2];     /* m/s^2    of gravity                                          */
    int detections;             /* of contacts                                                  */
    int trial;                  /* of a static step                                             */
    int K_is_kept;              /* F alone is assembled                                         */
    /* --- results --- */
    bbm_info info;
    bbm_status status;          /* the first error while building                               */
    char message[200];          /* what the last error was about                                */
    int  blamed[2];             /* elements that it names; -1: none                             */
    /* --- called before each solution, to see K and F, or to stop: by a result that is not 0 --- */
    int (*monitor)(const bbm_model *m, void *context);
    void *monitor_context;
    /* --- what the paper does not have --- */
    bbm_hooks hook;
    bbm_beyond *beyond;
};

typedef struct {                /* at a grid point                                              */
    double u, v;                /* m                                                            */
    double stress[3];           /* Pa       sx, sy, sxy                                         */
    double szz;                 /* Pa       out of the plane                                    */
    double mises;               /* Pa       von Mises                                           */
} bbm_result;

/* ----------------------------------------------------------------------------- 1. run a model */

bbm_status  bbm_run(bbm_model *m);                          /* all steps                        */
bbm_status  bbm_step(bbm_model *m);                         /* one step, Fig. 8                 */
/* The mean over the elements of a block (-1: of all) at a node. */
bbm_status  bbm_nodal_result(const bbm_model *m, int node, int block, bbm_result *r);
void        bbm_displacement(const bbm_element *e, const double D[6], double x, double y,
                             double u[2]);                  /* (1)                              */
double      bbm_stress_out_of_plane(const bbm_model *m, const bbm_element *e);  /* Pa           */
double      bbm_mises(const double stress[3], double szz);
const char *bbm_status_text(bbm_status s);
const char *bbm_message(const bbm_model *m);                /* the last error in a sentence     */

/* --------------------------------------------------------------------------- 2. build a model
 * Every bbm_add and bbm_set returns the status of the first one that failed and then does nothing
 * more, so that a program may check bbm_prepare alone. The index goes through the last pointer,
 * which may be NULL. */

bbm_status bbm_model_new(bbm_model **m);
void       bbm_model_free(bbm_model *m);                    /* takes NULL                       */
bbm_status bbm_add_material(bbm_model *m, const bbm_material *material, int *index);
bbm_status bbm_add_node(bbm_model *m, double x, double y, int *index);
bbm_status bbm_add_element(bbm_model *m, int block, int material, int n, const int node[],
                           int *index);                     /* the nodes in either sense        */
bbm_status bbm_fix_node(bbm_model *m, int node, int directions, double u, double v);    /* wall */
bbm_status bbm_add_load(bbm_model *m, int node, double fx, double fy);      /* N, adds up       */
bbm_status bbm_add_line_load(bbm_model *m, int node1, int node2, double fx, double fy); /* N/m  */
bbm_status bbm_add_varying_line_load(bbm_model *m, int node1, int node2, bbm_field *f,
                                     const void *context);
bbm_status bbm_prepare(bbm_model *m);                       /* checks, finds the edges (2.2)    */

/* ---------------------------------------------------------------- 3. single formulas, each alone
 * A submatrix function adds to what it is given. */

/* 2.1, 2.2 */
void   bbm_element_geometry(bbm_element *e, const bbm_vertex vertex[]);         /* n vertices   */
void   bbm_mode_matrix(const bbm_element *e, double x, double y, double T[2][6]);       /* (2)  */
double bbm_bonding_stiffness(double alpha, const bbm_element *i, const bbm_element *j); /* (4)  */
/* 3.1, 3.2 */
void   bbm_elastic_matrix(const bbm_material *m, double E[3][3]);               /* (7)          */
void   bbm_elastic_submatrix(const bbm_element *e, bbm_submatrix *s);           /* (10)         */
void   bbm_mode_integral(const bbm_element *e, double M[6][6]);                 /* int T^T T dA */
void   bbm_inertia_submatrix(const bbm_element *e, double dt, bbm_submatrix *s);    /* (16), (17) */
void   bbm_newmark_velocity(bbm_element *e, double dt, double factor);          /* (14)         */
/* 3.3, 3.4 */
void   bbm_step_matrix(const bbm_element *e, double x, double y, double T[2][6], double at[2]);
void   bbm_bonding_gap(const bbm_element *i, const bbm_vertex *P, const bbm_element *j,
                       const bbm_vertex *Q, double k, bbm_gap *g);              /* (18)-(23)    */
void   bbm_bonding_submatrices(bbm_gap *g, bbm_submatrices *s);                 /* (27), (28)   */
double bbm_fixed_stiffness(double alpha, const bbm_element *e);                 /* (29)         */
void   bbm_fixed_gap(const bbm_element *e, const bbm_vertex *P, const bbm_node *W, double k,
                     bbm_gap *g);                                               /* (30)-(36)    */
/* 3.5, 3.6 */
void   bbm_point_load(const bbm_element *e, const bbm_vertex *P, const double f[2], double F[6]);
void   bbm_gauss_point(int g, double *s, double *weight);                       /* 0 <= s <= 1  */
void   bbm_varying_load_submatrix(const bbm_element *e, const bbm_vertex *a, const bbm_vertex *b,
                                  const double f[BBM_GAUSS][2], double F[6]);   /* (42)         */
void   bbm_constant_load_submatrix(const bbm_element *e, const bbm_vertex *a, const bbm_vertex *b,
                                   const double f[2], double F[6]);             /* (43)         */
void   bbm_varying_volume_submatrix(const bbm_element *e, const bbm_vertex vertex[], bbm_field *f,
                                    const void *context, double F[6]);          /* (46)         */
void   bbm_volume_submatrix(const bbm_element *e, const double f[2], double F[6]);      /* (47) */
void   bbm_gravity_submatrix(const bbm_element *e, const double g[2], double F[6]);     /* (47) */

/* 3.7, 3.8 */
void   bbm_normal_vectors(const bbm_touch *c, bbm_spring *n);                   /* (52)-(57)    */
void   bbm_normal_submatrices(const bbm_touch *c, double p_n, bbm_submatrices *s);  /* (58a-f)  */
void   bbm_shear_vectors(const bbm_touch *c, double anchor, bbm_spring *s); /* (53), (60)-(62)  */
void   bbm_shear_submatrices(const bbm_touch *c, double anchor, double p_s,
                             bbm_submatrices *s);                               /* (63), (64)   */
void   bbm_friction_submatrices(const bbm_touch *c, double anchor, double Fr,
                                bbm_submatrices *s);                            /* (65)-(69)    */
const bbm_parameters *bbm_strength_of(const bbm_model *m, const bbm_contact *c);
double bbm_shear_strength(const bbm_parameters *p, double N, double area);
bbm_contact_state bbm_next_state(const bbm_parameters *p, const bbm_contact *c,
                                 double tolerance);                             /* the table    */

/* ------------------------------------------------------ 4. what the files of the library share */

/* bbm.c */
bbm_status bbm_fail(bbm_model *m, bbm_status s, const char *format, ...);
int        bbm_is_static(const bbm_model *m);
int        bbm_is_exact(const bbm_model *m);                    /* see bbm_hooks                */
double     bbm_mass_per_area(const bbm_element *e);             /* M of (11)                    */
int        bbm_next_vertex(const bbm_element *e, int v);
bbm_gap   *bbm_add_gap(bbm_model *m, int i, int j);
void       bbm_list_gaps(bbm_model *m);
void       bbm_list_bond(bbm_model *m, const bbm_bond *b);
void       bbm_list_fixed_point(bbm_model *m, int v, int directions);
void       bbm_gap_length(const bbm_model *m, bbm_gap *g, double d[2]);         /* of m->D      */
bbm_status bbm_check_step(bbm_model *m);                        /* parameters, and a hook's    */
void       bbm_begin_step(bbm_model *m);
bbm_status bbm_detect(bbm_model *m, int *other);                /* and K for the contacts       */
void       bbm_assemble(bbm_model *m);                          /* K and F, Eq. (5)             */
void       bbm_add_submatrices(bbm_model *m, int i, int j, bbm_submatrices *s); /* j < 0: wall  */
void       bbm_move(const bbm_model *m, const bbm_element *e, const double D[6], double x, double y,
                    double u[2]);

/* contact.c: the parts of a step with contacts, for bbm_step */
bbm_status bbm_contact_new(bbm_model *m);
void       bbm_contact_free(bbm_contact_scratch *w);
double     bbm_girth(const bbm_model *m, int edge);             /* m, of its block              */
void       bbm_guess_step(bbm_model *m);                        /* D as far as it is foretold   */
int        bbm_moved_too_far(bbm_model *m);
bbm_status bbm_detect_contacts(bbm_model *m, int *same);
bbm_status bbm_add_pair(bbm_model *m, int corner, int edge);    /* if they may touch            */
int        bbm_carries(const bbm_model *m, int corner, int edge);
double     bbm_allowed_depth(const bbm_model *m, int corner, int edge); /* at the start, m      */
bbm_contact *bbm_list_contacts(const bbm_model *m, int *contacts);      /* of the step in hand  */
void       bbm_assemble_contacts(bbm_model *m);
bbm_pass   bbm_open_close(bbm_model *m);
bbm_status bbm_store_contacts(bbm_model *m);

#endif
