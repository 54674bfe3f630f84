/* bbm.h - the bonding block model (BBM), an enrichment of discontinuous deformation analysis (DDA).
 *
 * Sun, Chen, Feng, Wang: "Discontinuous Deformation Analysis Enriched by the Bonding Block Model",
 * Mathematical Problems in Engineering 2015, 723263, doi:10.1155/2015/723263. Eq. (n) and Fig. n mean that paper.
 *
 * A block of a jointed rock mass is subdivided into elements, polygons with the six unknowns
 * D = (u0, v0, r0, ex, ey, gxy) each. Elements of one block that share an edge are glued there by bonding springs;
 * different blocks only touch. Each time step minimises the potential energy, K D = F, and moves the elements by D.
 *
 * Read the structs from small to large, then the functions in three tiers: run a model, build one, single formulas.
 * SI units, plane stress, indices from 0, elements counter-clockwise. What can fail returns a bbm_status.
 */
#ifndef BBM_H
#define BBM_H

#define BBM_VERSION "0.1"

#if defined __FAST_MATH__ || (defined __FINITE_MATH_ONLY__ && __FINITE_MATH_ONLY__)
#error "bbm needs IEEE arithmetic with infinity and NaN: compile without -Ofast, -ffast-math, -ffinite-math-only"
#endif

enum { BBM_GAUSS = 4 };                         /* Gauss points of a line load: exact to degree 7              */
enum { BBM_X = 1, BBM_Y = 2, BBM_XY = 3 };      /* directions in which a point is held; they add up            */

typedef enum {
    BBM_OK,
    BBM_NO_MEMORY,
    /* --- the model is wrong: bbm_message() names the element, node or parameter --- */
    BBM_NO_ELEMENT,             /* the model is empty                                                     */
    BBM_NOT_FINITE,             /* a coordinate, load or parameter is NaN or infinite                     */
    BBM_BAD_INDEX,              /* a node, element or material that does not exist                        */
    BBM_BAD_MODULUS,            /* E <= 0                                                                 */
    BBM_BAD_POISSON,            /* nu outside (-1, 0.5)                                                   */
    BBM_BAD_DENSITY,            /* density <= 0                                                           */
    BBM_BAD_THICKNESS,          /* thickness <= 0                                                         */
    BBM_BAD_PARAMETER,          /* dt, alpha, omega, ... outside its range                                */
    BBM_FEW_VERTICES,           /* an element of fewer than three vertices                                */
    BBM_ZERO_AREA,              /* an element without area                                                */
    BBM_SELF_CROSSING,          /* an element whose boundary meets itself                                 */
    BBM_OVERLAP,                /* elements of one block that lie on the same side of an edge             */
    BBM_BLOCKS_OVERLAP,         /* blocks that overlap at the start                                       */
    BBM_UNUSED_NODE,            /* a node that no element has                                             */
    BBM_NOT_BOUNDARY,           /* a line load on what is no boundary edge                                */
    BBM_FREE_TO_MOVE,           /* statics, and the fixed points do not hold a body against rigid motion  */
    BBM_MECHANISM,              /* elements bonded at midpoints alone turn against each other at no energy  */
    /* --- the solution failed: the numbers are in bbm_info --- */
    BBM_NOT_POSITIVE_DEFINITE,  /* K is not; info.element is the row, or -1 if the iteration found out    */
    BBM_NOT_CONVERGED,          /* SSOR-PCG needs more than pcg.iterations                                */
    BBM_STEPS_EXHAUSTED,        /* statics did not meet (71) within the given steps                       */
    BBM_NO_EQUILIBRIUM,         /* statics, and a block slides, tips or falls: m->culprit on m->other             */
    BBM_STEP_TOO_LONG,          /* elements turn or strain too far in a step, even in the smallest one          */
    BBM_OPEN_CLOSE,             /* the open-close iteration does not settle, even in the smallest step    */
    BBM_TOO_SOFT,               /* contacts are as deep as a tenth of a block                             */
    BBM_ENERGY,                 /* the smallest step still makes energy                                   */
    BBM_STOPPED,                /* watch said so                                                          */
    BBM_STATUS_COUNT
} bbm_status;

/* ------------------------------------------------------------------------------------------------ the data */

typedef struct {
    double E;                   /* Pa       Young's modulus                  */
    double nu;                  /* -        Poisson's ratio                  */
    double density;             /* kg/m^3   mass per volume                  */
    double thickness;           /* m        out of the plane                 */
} bbm_material;

typedef struct {                /* a grid point of the mesh; the elements that meet there have a vertex each    */
    double x, y;                /* m        starting position                */
    int    held;                /* BBM_X, BBM_Y or both: a fixed point       */
    double wall[2];             /* m        displacement of the wall point W that it is held to                 */
    double load[2];             /* N        concentrated load                */
} bbm_node;

typedef struct {                /* a corner of one element                                                      */
    int    node, element;
    double x, y;                /* m        present position                 */
    double u, v;                /* m        displacement since the start: x = node.x + u                        */
} bbm_vertex;

typedef struct {                /* an element: triangle, quadrilateral, any simple polygon, or a whole block    */
    /* --- input --- */
    int    block;
    int    first, n;            /* its vertices are model.vertex[first .. first+n-1]                            */
    bbm_material material;
    /* --- geometry of the step, by bbm_element_geometry --- */
    double x, y;                /* m        barycentre                       */
    double A;                   /* m^2      area                             */
    double Sxx, Syy, Sxy;       /* m^4      second moments of area about the barycentre                         */
    /* --- state --- */
    double A0;                  /* m^2      starting area: mass = density * thickness * A0                      */
    double V[6];                /* D/s      velocity of D                    */
    double stress[3];           /* Pa       sx, sy, sxy, carried from step to step                              */
    double sum[3];              /* m, m, rad    u0, v0 and r0, summed over the steps                            */
    /* --- solution of the last step --- */
    double D[6];                /* u0, v0 [m], r0 [rad], ex, ey, gxy [-]                                        */
    double mid[6];              /* the D in whose middle its vectors are taken, beyond/middle.c; 0: the paper   */
} bbm_element;

typedef struct {                /* an internal edge: two bonding springs between elements i and j               */
    int i, j;
    int p[2], q[2];             /* vertices: p[0], p[1] of i coincide with q[0], q[1] of j                      */
} bbm_bond;

typedef struct {                /* a boundary edge from vertex a to vertex b, its element on the left           */
    int element, a, b, block;
} bbm_edge;

typedef enum {                  /* how quadrilaterals are bonded along an edge; all others are at its vertices  */
    BBM_MOMENT,                 /* in its middle, with the resistance to opening that bending needs             */
    BBM_MIDPOINTS,              /* in its middle alone                                                          */
    BBM_VERTICES                /* at both ends: the paper                                                      */
} bbm_bonding;

/* A bond of a whole edge. With d1, d2 the gaps at its ends, d = (d1 + d2)/2, dd = (d1 - d2)/2:
 * Pi = 1/2 d.K d + 1/2 dd.M dd. Two springs k at the ends are K = M = 2 k I.                                     */
typedef struct { double K[2][2], M[2][2]; } bbm_hinge;

typedef struct {                /* a load along a boundary edge                                                 */
    int    node[2];             /* its ends                                  */
    int    constant;            /* then f[0] is all of it, Eq. (43)          */
    double f[BBM_GAUSS][2];     /* N/m      at the Gauss points from node[0] to node[1], Eq. (42)               */
    double pressure;            /* N/m      against the outward normal, turning with the edge; on top of f[0]   */
    int    a, b;                /* the vertices at its ends, by bbm_prepare  */
} bbm_line_load;

/* A load that varies from place to place: writes f(x, y) [N/m or N/m^2] into f. */
typedef void bbm_field(double x, double y, const void *context, double f[2]);

typedef struct { double K[6][6], F[6]; } bbm_submatrix;                                 /* what one element adds */
typedef struct { double Kii[6][6], Kij[6][6], Kjj[6][6], Fi[6], Fj[6]; } bbm_submatrices; /* two; Kji = Kij^T    */

typedef enum {                  /* how K D = F is solved                                                        */
    BBM_EISENSTAT,              /* the paper's SSOR-PCG in half the time of the next, with the same iterates    */
    BBM_TEXTBOOK,               /* the paper's SSOR-PCG                                                         */
    BBM_TWO_LEVEL               /* beyond the paper: with a coarse space; where there is none, the first        */
} bbm_pcg_form;

typedef struct {
    double omega;               /* -        relaxation factor of SSOR, in (0, 2); with two levels it is 1       */
    double tolerance;           /* -        of the residual, in the norm of the preconditioner, against F      */
    int    iterations;          /* at most; both for each connected component of K by itself                    */
    bbm_pcg_form form;
} bbm_pcg;

typedef struct {                /* what a solve did                                                             */
    int    iterations;          /* of the connected component of K that took most                               */
    double residual;            /* -        |F - K D| / |F|, computed afresh at the end; of the component where
                                   it is largest, without those where F is 0                                    */
    int    element;             /* block row where K is not positive definite, else -1                          */
    double seconds[2];          /* s        CPU time of the preconditioner and of the iteration                 */
} bbm_pcg_info;

enum { BBM_DETECT, BBM_ASSEMBLE, BBM_PRECONDITION, BBM_ITERATE, BBM_PHASES };   /* what CPU time is counted for  */

typedef enum { BBM_EXACT, BBM_LINEAR } bbm_rotation;    /* x + R(r0) (1 + e) X, or the paper's x + T D           */

typedef enum { BBM_OPEN, BBM_LOCK, BBM_SLIDE } bbm_contact_state;
typedef enum { BBM_PASS_DONE, BBM_PASS_AGAIN, BBM_PASS_GIVE_UP } bbm_pass;

typedef struct {                /* vertex P1 of one block against an edge P2 P3 of another                      */
    /* --- identity: boundary edges; P1 starts `corner`, P2 ends `edge`, P3 starts it --- */
    int    corner, edge;
    /* --- state, carried from step to step --- */
    bbm_contact_state state;
    double sign;                /* of the slip while it slides: 1 towards P3                                    */
    double anchor;              /* -        P0 = P3 + anchor (P2 - P3)                                          */
    double rest;                /* m        d_n at which the normal spring carries nothing: 0, or where it was  */
                                /*          when it closed inside, so that no spring starts loaded              */
    double N, T;                /* N        normal force; shear force that the spring carries or would carry    */
    int    inside;              /* opened though P1 is still inside: where it had closed inside, see rest       */
    int    whole;               /* closed since the start and not broken: has cohesion and tensile strength     */
    /* --- of the step --- */
    int    rival[4];            /* other lines of entrance, in the list, or -1: two at P3, two at P2            */
    double gap;                 /* m        d_n at the start                                                    */
    double area;                /* m^2      of the joint that P1 stands for; 0 if it is not whole               */
    double share;               /* -        of the step after it hit, on which its shear spring acts            */
    int    before;              /* closed at the start                                                          */
    int    off;                 /* the foot is not on the edge at the start                                     */
    double d_n, d_s;            /* m        normal distance and slip at the end                                 */
    double used;                /* N        the N that the friction of the last solution used                   */
    bbm_contact_state next;
    int    closings;            /* in this step                                                                 */
} bbm_contact;

typedef struct {                /* what the formulas of 3.7 take                                                */
    const bbm_element *i, *j;
    const bbm_vertex *P1, *P2, *P3;
    int exact;                  /* with what (60) drops, see beyond/middle.c; 0: the paper                      */
    double rest;                /* m        see bbm_contact; 0: the paper                                       */
} bbm_touch;

typedef struct { double d, e[6], g[6]; } bbm_spring;    /* its length is d + e.D_i + g.D_j                      */

typedef struct {
    double dt;                  /* s        time step; INFINITY: no inertia                                     */
    int    steps;               /* time steps, in statics load steps (Newton-Raphson iterations)                */
    double tolerance;           /* -        of (71), ends the steps; 0: do all steps                            */
    double keep;                /* -        share of its velocity that a step hands on: 1 dynamics, 0 statics   */
    double alpha;               /* -        of the bonding stiffness, (4) and (29)                              */
    int    augment;             /* further solutions of a step that take the give out of the springs; 0: paper  */
    bbm_bonding bonding;        /* of quadrilaterals; BBM_VERTICES: paper                                       */
    double gravity[2];          /* m/s^2    */
    double shake[2], omega;     /* m/s^2, 1/s   acceleration of the base, shake sin(omega t)                    */
    double p_n, p_s;            /* N/m      stiffness of the normal and of the shear spring of a contact        */
    double friction;            /* degree   friction angle                                                      */
    double cohesion, tension;   /* Pa       shear and tensile strength of unbroken joints, see bbm_contact      */
    bbm_rotation rotation;      /* how positions are updated                                                    */
    int    faces;               /* 1: grid points inside a straight side touch other blocks, too, so that a     */
                                /* deformable block rests on its whole side; 0: on its two corners, as a bridge */
    bbm_pcg pcg;
} bbm_parameters;

typedef struct {                /* what the last step did                                                       */
    int    step;                /* steps done                                                                   */
    double t;                   /* s        time at their end; statics takes none                                */
    double change;              /* -        left side of (71) over its right side without the tolerance         */
    bbm_pcg_info pcg;
    int    passes;              /* solutions of the open-close iteration                                        */
    int    cuts;                /* how often dt was halved                                                      */
    int candidates;             /* pairs of a boundary vertex and a boundary edge that the detection compared   */
    int    contacts;            /* closed                                                                       */
    double penetration;         /* m        the deepest                                                         */
    int    iterations;          /* of SSOR-PCG, in all solutions of the step                                    */
    double work;                /* J        of loads and gravity, in all steps                                  */
    double gained;              /* J        what dynamic steps have made beyond the balance, beyond/balance.c   */
    double gain;                /* -        the most that one of them made, against what was there              */
    double seconds[BBM_PHASES]; /* s        CPU time, in all steps                                              */
} bbm_info;

typedef struct { double kinetic, elastic, springs; } bbm_energy;        /* J */

typedef struct {                /* elements i < j that overlap                                                  */
    int    i, j;
    double depth;               /* m        the shortest way that parts them                                    */
    double x, y;                /* m        the middle of what they share                                       */
} bbm_overlap;

typedef struct bbm_model bbm_model;
typedef struct bbm_beyond bbm_beyond;           /* beyond/beyond.h                                              */
/* Where what the paper does not have comes in (beyond/); NULL: the paper's way. */
typedef struct {
    void (*release)(bbm_model *m);                      /* frees m->beyond                              */
    bbm_status (*check)(bbm_model *m);                  /* of a prepared model                          */
    bbm_status (*check_step)(bbm_model *m);             /* before each step                             */
    bbm_status (*check_contacts)(bbm_model *m);         /* of a step in statics: is all held?           */
    bbm_status (*explain)(bbm_model *m, bbm_status s);  /* of a step in statics that failed             */
    void (*find_gravity)(bbm_model *m);                 /* m->gravity of the step                       */
    bbm_status (*lay_out)(bbm_model *m);                /* K is new                                     */
    void (*before_solution)(bbm_model *m);              /* K and F are assembled                        */
    bbm_status (*friction)(bbm_model *m, int *agree);   /* the next N for the friction forces           */
    int (*settled)(bbm_model *m);                       /* contacts are; 1: solve with this K again     */
    bbm_status (*accept)(bbm_model *m, const bbm_model *end);   /* before anything moves                */
} bbm_hooks;

typedef struct bbm_matrix bbm_matrix;           /* K, in solver.c                                               */
typedef struct bbm_contact_work bbm_contact_work;       /* scratch of contact.c                                 */

struct bbm_model {
    /* --- input --- */
    bbm_parameters par;
    int nodes, elements, vertices, line_loads, materials;
    bbm_node      *node;        /* [nodes]                                   */
    bbm_element   *element;     /* [elements]                                */
    bbm_vertex    *vertex;      /* [vertices], element by element            */
    bbm_line_load *line_load;   /* [line_loads]                              */
    bbm_material  *material;    /* [materials]                               */
    /* --- made by bbm_prepare --- */
    int bonds, edges;
    bbm_bond *bond;             /* [bonds]   the internal edges              */
    bbm_edge *edge;             /* [edges]   the boundary edges              */
    int *meet_first, *meet;     /* [nodes+1], [vertices]: meet[meet_first[n] ..] are the vertices at node n     */
    /* --- state and scratch --- */
    bbm_matrix *K;
    double *F, *D;              /* [6 elements]                              */
    double *load;               /* [6 elements] the part of F that comes from outside: loads, gravity           */
    double gravity[2];          /* m/s^2    of the step in hand: gravity less the acceleration of the base      */
    bbm_element *end_element;   /* [elements] the end of the step in hand, see move_model                       */
    bbm_vertex *end_vertex;     /* [vertices]                                                                   */
    double *force, *force_before;   /* N    [4 (bonds + vertices)] multipliers of bonds and fixed points: forces
                                   from i on j, from element on wall; and those of the start of the step       */
    double h;                   /* s        the step in hand: dt, or a part of it                               */
    int contacts, contact_room;
    bbm_contact *contact;       /* [contacts] at the end of the last step, sorted by corner and edge            */
    bbm_contact_work *work;
    int keep_K;                 /* F alone is assembled                      */
    int pairs, (*pair)[2];      /* elements of the contacts and bonds that K has room for                       */
    bbm_info info;
    bbm_status status;          /* the first error while building            */
    char message[200];          /* what the last error was about             */
    int  culprit, other;        /* the element of BBM_OVERLAP, BBM_FREE_TO_MOVE, BBM_MECHANISM; another one, or -1  */
    /* --- for whoever wants to see K and F, or to stop: called before each solution, which not 0 prevents --- */
    int (*watch)(const bbm_model *m, void *context);
    void *watch_context;
    /* --- beyond the paper --- */
    bbm_hooks hook;
    bbm_beyond *beyond;
};

typedef struct {                /* at a grid point                                                              */
    double u, v;                /* m                                         */
    double stress[3];           /* Pa       sx, sy, sxy                      */
    double mises;               /* Pa       von Mises                        */
} bbm_result;

/* -------------------------------------------------------------------------------------------- 1. run a model */

bbm_status  bbm_run(bbm_model *m);                      /* all steps, Fig. 8                                    */
bbm_status  bbm_step(bbm_model *m);                     /* one step                                             */
bbm_status  bbm_nodal_result(const bbm_model *m, int node, int block, bbm_result *r);  /* block -1: all of them */
void        bbm_displacement(const bbm_element *e, double x, double y, double u[2]);   /* (1), of the last step */
double      bbm_mises(const double stress[3]);
void        bbm_energies(const bbm_model *m, bbm_energy *e);    /* kinetic: before the velocity is damped        */
const char *bbm_status_text(bbm_status s);
const char *bbm_message(const bbm_model *m);            /* the last error in a sentence, with names and numbers */

/* ------------------------------------------------------------------------------------------ 2. build a model
 * Every bbm_add and bbm_set returns the status of the first one that failed and then does nothing more, so that a
 * program may check bbm_prepare alone. The index goes through the last pointer, which may be NULL.              */

bbm_status bbm_model_new(bbm_model **m);
void       bbm_model_free(bbm_model *m);                /* takes NULL                                           */
bbm_status bbm_add_material(bbm_model *m, const bbm_material *material, int *index);
bbm_status bbm_add_node(bbm_model *m, double x, double y, int *index);
bbm_status bbm_add_element(bbm_model *m, int block, int material, int n, const int node[], int *index);
bbm_status bbm_fix_node(bbm_model *m, int node, int directions, double u, double v);   /* u, v of the wall point */
bbm_status bbm_add_load(bbm_model *m, int node, double fx, double fy);                 /* N, adds up            */
bbm_status bbm_add_line_load(bbm_model *m, int node1, int node2, double fx, double fy);/* N/m, constant         */
bbm_status bbm_add_varying_line_load(bbm_model *m, int node1, int node2, bbm_field *f, const void *context);
bbm_status bbm_prepare(bbm_model *m);                   /* checks, sorts the edges (2.2), lays out K            */
int        bbm_find_pieces(const bbm_model *m, int piece[]);       /* what bonds join, by its first element    */
bbm_status bbm_find_overlap(const bbm_model *m, bbm_overlap *o);    /* the deepest at the start; i = -1: none   */
bbm_status bbm_find_mechanism(const bbm_model *m, int *element);    /* of BBM_MIDPOINTS; -1: none               */
/* After bbm_prepare: on a boundary edge; whether all is held against rigid motion, as statics needs.            */
bbm_status bbm_load_edge(bbm_model *m, int edge, double fx, double fy, double pressure);           /* N/m       */
bbm_status bbm_check_held(bbm_model *m);

/* ----------------------------------------------------------------------------- 3. single formulas, each alone
 * A submatrix function adds to what it is given.                                                               */

/* 2.1, 2.2 */
void   bbm_element_geometry(bbm_element *e, const bbm_vertex vertex[]);                /* of its n vertices     */
void   bbm_mode_matrix(const bbm_element *e, double x, double y, double T[2][6]);      /* (2)                   */
double bbm_bonding_stiffness(double alpha, const bbm_element *i, const bbm_element *j);/* (4)                   */
/* 3.1, 3.2 */
void   bbm_elastic_matrix(const bbm_material *m, double E[3][3]);                      /* (7)                   */
void   bbm_elastic_submatrix(const bbm_element *e, bbm_submatrix *s);                  /* (10)                  */
void   bbm_mode_integral(const bbm_element *e, double M[6][6]);                        /* int T^T T dA          */
void   bbm_inertia_submatrix(const bbm_element *e, double dt, bbm_submatrix *s);       /* (16), (17)            */
void   bbm_newmark_velocity(bbm_element *e, double dt, double keep);                   /* (14)                  */
/* 3.3, 3.4 */
void   bbm_bonding_submatrices(const bbm_element *i, const bbm_vertex *P, const bbm_element *j, const bbm_vertex *Q,
                               double k, bbm_submatrices *s);                          /* (27), (28)            */
void   bbm_hinge_moments(const bbm_element *e, const bbm_vertex vertex[], double M[2][2][2]);
void   bbm_hinge_submatrices(const bbm_element *i, const bbm_vertex *const P[2], const bbm_element *j,
                             const bbm_vertex *const Q[2], const bbm_hinge *h, bbm_submatrices *s);
double bbm_fixed_stiffness(double alpha, const bbm_element *e);                        /* (29)                  */
void   bbm_fixed_submatrix(const bbm_element *e, const bbm_vertex *P, const bbm_node *W,
                           double k, bbm_submatrix *s);                                /* (37)                  */
void   bbm_interpolation(const bbm_element *e, const bbm_vertex vertex[], int middles, int a,
                         double P[6][2]);                                              /* for two levels        */
/* 3.5, 3.6 */
void   bbm_point_load(const bbm_element *e, const bbm_vertex *P, const double f[2], double F[6]);
void   bbm_gauss_point(int g, double *s, double *weight);                              /* on 0 <= s <= 1       */
void   bbm_varying_load_submatrix(const bbm_element *e, const bbm_vertex *a, const bbm_vertex *b,
                                  const double f[BBM_GAUSS][2], double F[6]);          /* (42)                  */
void   bbm_constant_load_submatrix(const bbm_element *e, const bbm_vertex *a, const bbm_vertex *b,
                                   const double f[2], double F[6]);                    /* (43)                  */
void   bbm_varying_volume_submatrix(const bbm_element *e, const bbm_vertex vertex[], bbm_field *f,
                                    const void *context, double F[6]);                 /* (46)                  */
void   bbm_volume_submatrix(const bbm_element *e, const double f[2], double F[6]);     /* (47)                  */

/* 3.7, 3.8 */
void   bbm_normal_vectors(const bbm_touch *c, bbm_spring *n);                          /* (52)-(57)             */
void   bbm_normal_submatrices(const bbm_touch *c, double p_n, bbm_submatrices *s);     /* (58a-f)               */
void   bbm_shear_vectors(const bbm_touch *c, double anchor, bbm_spring *s);            /* (53), (60)-(62)       */
void   bbm_shear_submatrices(const bbm_touch *c, double anchor, double p_s, bbm_submatrices *s);  /* (63), (64) */
void   bbm_move(const bbm_model *m, const bbm_element *e, const double D[6], double x, double y, double u[2]);
void   bbm_friction_submatrices(const bbm_touch *c, double anchor, double Fr, bbm_submatrices *s); /* (65)-(69) */
double bbm_shear_strength(const bbm_parameters *p, double N, double area);
bbm_contact_state bbm_next_state(const bbm_parameters *p, const bbm_contact *c, double slack);    /* the table */

/* ------------------------------------------------------------ the parts of a step with contacts, for bbm_step    */
bbm_status bbm_contact_new(bbm_model *m);
void       bbm_contact_free(bbm_contact_work *w);
int        bbm_root_of(int up[], int e);           /* of a forest: up[e] leads from e towards its root          */
void       bbm_join_elements(const bbm_model *m, int up[]);  /* what bonds and listed contacts connect, by roots */
void       bbm_guess_step(bbm_model *m);
int        bbm_moved_too_far(bbm_model *m);
const double *bbm_guess(const bbm_model *m);
bbm_status bbm_detect_contacts(bbm_model *m, int *same);
bbm_contact *bbm_list_contacts(const bbm_model *m, int *contacts);
bbm_status bbm_start_again(bbm_model *m);
int        bbm_contact_count(const bbm_model *m);
void       bbm_contact_pair(const bbm_model *m, int k, int pair[2]);
bbm_status bbm_add_submatrices(bbm_model *m, int i, int j, bbm_submatrices *s);
bbm_status bbm_assemble_contacts(bbm_model *m);
bbm_status bbm_open_close(bbm_model *m, bbm_pass *pass);
double     bbm_deepest_contact(const bbm_model *m, const bbm_contact **deepest);
int        bbm_contacts_are_off(const bbm_model *m, double share);
bbm_status bbm_keep_contacts(bbm_model *m);
/* When statics fails: a step in which inertia is small against stiffness, a push, and who goes far in its solution.  */
double     bbm_long_step(const bbm_model *m);
void       bbm_push_all(bbm_model *m);
int        bbm_find_loose(const bbm_model *m, double h, int pair[2]);

/* ------------------------------------------------ beyond the paper: beyond/middle.c, beyond/balance.c             */
int        bbm_is_exact(const bbm_model *m);
void       bbm_middle_matrix(const bbm_element *e, double x, double y, double T[2][6], double at[2]);
void       bbm_set_middle(bbm_model *m, const double D[]);
int        bbm_middle_is_off(const bbm_model *m);
bbm_status bbm_check_balance(bbm_model *m, const bbm_model *end, double *gain, double *there);

/* ------------------------------------------------------------------------- the linear solver of section 4: K D = F
 * n block rows of 6; `pair` lists the i, j whose submatrix K_ij is not zero, in any order, either way round,
 * repeats allowed. Vectors have 6 n entries in the caller's order. Rows that no pairs connect, however indirectly,
 * are solved apart: neither changes a bit of the other's D.                                                    */

bbm_status bbm_matrix_new(int n, int pairs, int (*pair)[2], bbm_matrix **K);
void       bbm_matrix_free(bbm_matrix *K);                                             /* takes NULL            */
void       bbm_matrix_clear(bbm_matrix *K);
bbm_status bbm_matrix_add(bbm_matrix *K, int i, int j, double B[6][6]);  /* K_ij, K_ji = B^T; i = j: B symmetric */
void       bbm_matrix_get(const bbm_matrix *K, int i, int j, double B[6][6]);          /* B = K_ij              */
void       bbm_matrix_multiply(const bbm_matrix *K, const double *x, double *y);       /* y = K x               */
int        bbm_matrix_bandwidth(const bbm_matrix *K);                                  /* in block rows         */
bbm_status bbm_matrix_coarse(bbm_matrix *K, int nodes, const int *first, const int *node); /* for two levels:
                                   block row i hangs on node[first[i]] .. node[first[i+1]-1], each with two unknowns;
                                   rows that are solved apart have no node in common                            */
bbm_status bbm_matrix_interpolate(bbm_matrix *K, int i, int k, double P[6][2]);        /* by P on the k-th      */
bbm_status bbm_solve(bbm_matrix *K, const double *F, double *D, const bbm_pcg *pcg, bbm_pcg_info *info);

#endif
