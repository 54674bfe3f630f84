/* base.h - the data of 3.3, 3.7 and section 4, and what the files of the library share.
 *
 * The first part is what the paper's formulas take: the gap of a bond or fixed point (3.3, 3.4), a
 * boundary edge, a contact and its three points (3.7), the matrix K (section 4). A reader of the
 * paper may stop at the hooks, which are for what the paper does not have. After them come the
 * functions that the files of the library share, from the bottom up. A program that looks at bonds,
 * edges, contacts or K includes this file in place of bbm.h.
 */
#ifndef BBM_BASE_H
#define BBM_BASE_H

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "../bbm.h"

#define LENGTH(array) ((int)(sizeof array / sizeof *array))      /* how many items it has */

/* --------------------------------------------------------------------- the data of 3.3 and 3.4 */

/* Drawn apart; at the start p[0] lies on q[0] and p[1] on q[1], at two nodes.
 *
 *      .------ p[1]    q[1] ------.
 *       \         \     \          \         i runs p[0] -> p[1] along the edge, its element on the
 *        \   i     \     \    j     \        left, and j the other way, q[1] -> q[0]
 *         \         \     \         /
 *          \         \     \       /         a spring k between p[0] and q[0], another between
 *           `------- p[0]  q[0] --'          p[1] and q[1]
 */
struct bbm_bond {               /* an internal edge: two bonding springs                        */
    int i, j;                   /* the elements that share it                                   */
    int p[2], q[2];             /* vertices: p[0], p[1] of i coincide with q[0], q[1] of j      */
};

typedef struct {                /* what two elements add to K and F; K_ji = K_ij^T              */
    double Kii[6][6], Kij[6][6], Kjj[6][6], Fi[6], Fj[6];
} bbm_submatrices;

typedef struct {                /* of a hook: the force in a gap besides that of its spring     */
    double f[2];                /* N        in the paper 0                                      */
    double f_before[2];         /* N        f at the end of the last step                       */
} bbm_multiplier;

/* The most corners of a node that a hook may join, each with each. */
enum { BBM_JOINED = 64 };

struct bbm_gap {                /* of a spring: d = d0 + T_i D_i - T_j D_j, Eq. (22)            */
    int    i, j;                /* elements; j = -1: the wall, which does not move: T_j = 0     */
    int    node[2];             /* at the wall: the held node, twice; a hook may name two       */
    double W[2][2];             /* N/m      k on its diagonal; 0: not held in that direction    */
    double d0[2];               /* m        d at the start of the step                          */
    double Ti[2][6], Tj[2][6];
    int    elastic;             /* 0: W stands for a rigid joint; 1: a hook's W is a stiffness  */
    bbm_multiplier own;         /* stays when the gaps are listed anew                          */
};

struct bbm_line_load {          /* a load along a boundary edge                                 */
    int    node[2];             /* its ends                                                     */
    int    constant;            /* 1: the load is f[0] all along, Eq. (43)                      */
    double f[BBM_GAUSS][2];     /* N/m      else at the Gauss points from node[0] on, Eq. (42)  */
    int    a, b;                /* the vertices at its ends, by bbm_prepare                     */
};

/* --------------------------------------------------------------------- the data of 3.7 and 3.8 */

/* The most elements of a contact: i, j and, beyond the paper, others that share P1, P2 or P3. */
enum { BBM_PARTS = 5 };

typedef struct {                /* Mohr and Coulomb: abs(T) <= N tan_phi + shear, -N <= tension */
    double tan_phi;             /* -        of the friction angle                               */
    double shear, tension;      /* N        of an unbroken joint; in the paper 0                */
} bbm_strength;

typedef struct { double x, y, length; } bbm_direction;          /* unit vector; m               */
typedef struct { double x, y; } bbm_point;                      /* m, from model.origin         */

struct bbm_edge {               /* a boundary edge from vertex a to b, its element on the left  */
    int element, a, b, block;
    /* --- detect.c --- */
    int    first;               /* an element that stands for the block, the same on all edges  */
    int    before, after;       /* its neighbours along the boundary                            */
    int    next;                /* another edge of the block, in a ring of all                  */
    int    meets[2];            /* at its start a corner of another block, within rounding,     */
                                /*          covers the edge that ends [0] or starts [1] there   */
    int    slides;              /* of its start: a block that lies flush slides along it in     */
                                /*          the step by more than contacts are deep             */
    int    joined[2];           /* of its start: the edges of blocks that lie flush and cover   */
                                /*          the one that ends and the one that starts there; -1 */
    int    held[2];             /* those of them with which the block makes one straight side,  */
                                /*          where both are held and move alike; -1              */
    int    side;                /* the first edge of the straight side that it belongs to       */
    double span, spacing;       /* m        set in that first edge: the side's starting length, */
                                /*          and the mean length of its edges                    */
    double deep;                /* m        of closed contacts in its line, in that first edge  */
    bbm_direction along;        /* from a to b, at present                                      */
    int    contact;             /* where those of the corner a begin in model.contact           */
};

typedef struct {                /* what the detection and the open-close iteration note in a step */
    /* --- detect.c --- */
    int    carried;             /* the last step had the contact, with this edge                */
    int    touches;             /* P1 lies on the edge when the run begins                      */
    int    has_left;            /* P1 was on the edge and has gone past its end                 */
    int    was_closed;          /* at the start                                                 */
    int    beyond_end;          /* at the start the projection of P1 is not on the edge         */
    int    entrance[4];         /* the other entrance lines, two at P3 and two at P2: places in */
                                /*          the list of contacts, or -1                         */
    double d_n0;                /* m        d_n at the start                                    */
    /* --- open_close.c --- */
    double time_left;           /* -        share of the step after P1 hit; the shear spring    */
                                /*          gets this share of the slip                         */
    double past[2];             /* m        how far P1 is past P3 and P2 at the end, if open    */
    double N_of_friction;       /* N        the N that friction is taken for                    */
    int    friction_in_K;       /* 1: a hook takes friction for the N of the solution itself    */
    double force_tolerance;     /* N        forces that differ by less agree                    */
    double digits;              /* N        what a spring makes of the rounding of positions    */
    int    rests;               /*          no force in its component is more than rounding     */
    bbm_contact_state next_state;               /* in the next pass                             */
    int    closings;            /* how often it has closed in the step                          */
    int    unsettled;           /* the last pass has changed its state or its friction          */
    /* --- a hook --- */
    double jump[2];             /* N        what a jump of velocities adds to N and T, which do */
                                /*          not have it, also where it has opened               */
} bbm_trial;

struct bbm_contact {            /* vertex P1 of one block against an edge P2 P3 of another      */
    /* --- identity: two boundary edges. P1 starts `corner`; P3 starts `edge`, P2 ends it --- */
    int    corner, edge;
    int    parts, element[BBM_PARTS];           /* i, j, and in the paper no more               */
    bbm_strength strength;
    /* --- at the end of the step; carried from step to step --- */
    bbm_contact_state state;
    double d_n, d_s;            /* m        normal distance and slip                            */
    double N, T;                /* N        normal force; what the shear spring carries or      */
                                /*          would carry                                         */
    double sign;                /* of the slip while it slides: 1 towards P3                    */
    double anchor;              /* -        where P0 is: P0 = P3 + anchor (P2 - P3)             */
    double slip;                /* m        how far it has slid in all steps since it closed    */
    /* --- beyond the paper; carried, too --- */
    double rest;                /* m        d_n at which the normal spring has no force; in the */
                                /*          paper 0. With bbm_motion a contact that closes with */
                                /*          P1 inside starts unloaded: then it is negative, and */
                                /*          a hook may bring it back to 0 in time               */
    double area;                /* m^2      its share of an unbroken joint, or 0                */
    int    inside;              /* it is open, but P1 is inside since it was closed             */
    int    hit;                 /* a hook has given it an impulse in place of its spring's; 2:  */
                                /*          a hook has found P1 inside, which holds it there    */
    bbm_trial trial;
};

typedef struct {                /* what the formulas of 3.7 take                                */
    const bbm_element *i, *j;
    const bbm_vertex *P1, *P2, *P3;
} bbm_touch;

typedef struct {                /* of a contact: its length is d + e.D_i + g.D_j                */
    double d, v[BBM_PARTS][6];  /* e, g; and beyond the paper one for each further element      */
} bbm_spring;

/* The most passes that change states or renew vectors, and the most detections, in one part. */
enum { BBM_MAX_PASSES = 30, BBM_MAX_DETECTIONS = 8 };

/* What follows a pass of the open-close iteration: nothing, for all fits; a solution with a new K
 * and F; a solution with a new F alone; the end of this attempt. */
typedef enum { BBM_PASS_DONE, BBM_PASS_AGAIN, BBM_PASS_SAME_K, BBM_PASS_GIVE_UP } bbm_pass;

struct bbm_contact_scratch {
    /* --- the contacts of the step --- */
    int contacts;
    bbm_contact *contact;       /* [contacts] of the pairs                                      */
    /* --- open_close.c --- */
    int passes, friction_passes;
    int one_until;              /* before this pass one contact alone changes its state in each */
    uint64_t seen[BBM_MAX_PASSES + 1];          /* the states of each pass, as a number         */
    /* --- detect.c --- */
    int pairs;
    struct bbm_pair *pair;      /* [pairs]    a corner and an edge that may touch, sorted       */
    struct bbm_reach *reach;    /* [elements] how far a block may move, at its element `first`  */
};

/* ----------------------------------------------------------------------- the data of section 4
 * K has n block rows of six. Block rows are numbered in two ways: by the caller, and by their place
 * in the order of base/order.c. The functions of order.c and solve.c take the caller's numbers,
 * those of solver.c the places; so do their vectors, of 6 n entries. */

/* What is not symmetric in K: K += u v^T. */
typedef struct {
    int    parts, row[BBM_PARTS];               /* places of the rows of the elements           */
    double p;                   /* u = p v of the shear spring                                  */
    bbm_spring s, n;            /* v of the normal one, whose d is 0                            */
} bbm_term;

struct bbm_matrix {
    int n;                      /* block rows                                                   */
    int *place, *caller;        /* [n]       place[caller's row], and back                      */
    int *first;                 /* [n+1]     row i of L: the blocks first[i] .. first[i+1]-1    */
    int *back;                  /* [blocks]  its row less its column                            */
    int components, *start;     /* [n+1]     the rows of component c: start[c] .. start[c+1]-1  */
    int *component;             /* [n]       of a caller's row: 0 .. components-1               */
    int *body;                  /* [n]       of a caller's row: its component, or by a hook a   */
                                /*           number below n; -1: of a body that is held         */
    double (*D)[6][6], (*L)[6][6];              /* [n], [blocks], one piece of memory           */
    double *forces;             /* [n]       of each component, see bbm_matrix_measure; 0: none */
    int lacks;                  /* what was added to a block that the pattern does not have     */
    /* --- scratch of bbm_solve --- */
    int from, to;               /* the rows of the component in hand: from .. to-1              */
    double (*inverse)[6][6];    /* [n]       (D_i/omega)^-1                                     */
    double *x, *r, *u, *p, *q;  /* [6 n]     solution, residual, M^-1 r, direction, K p         */
    double *y;                  /* [6 n]     result of the sweep forward                        */
    const bbm_method *method;
    double omega;
    int ready;                  /* `inverse` and what the method made belong to D, L and these  */
    void *extra;                /* what a method keeps with K                                   */
    void (*free_extra)(void *extra);
    /* --- what a hook adds to D, L and L^T; it solves components with terms --- */
    int terms;
    bbm_term *term;             /* [terms]   NULL, or by malloc and released with K             */
    int (*add_terms)(const bbm_matrix *K, const double *x, double *y);  /* y += u v^T x of the  */
                                /*           rows in hand; returns the number of terms          */
    bbm_status (*solve_terms)(bbm_matrix *K, const bbm_pcg *pcg, bbm_pcg_info *info);
};

/* A method other than the paper's. */
struct bbm_method {
    void (*make_ready)(bbm_matrix *K);                  /* for a new K                          */
    void (*correct)(const bbm_matrix *K, const double *y, double *f);   /* f, (D/w) y between   */
};

/* ----------------------------------------------------------------------------------- the hooks */

/* A hook's way to move points, in place of u = T D. */
struct bbm_motion {
    void (*point)(const bbm_element *e, double x, double y, double T[2][6], double at[2]);
                                                            /* T at (x, y), and where that is   */
    void (*move)(const double D[6], double X, double Y, double u[2]);
    void (*turn)(const bbm_element *start, bbm_element *e, const bbm_vertex vertex[]);
                                                            /* stress and V of one that moved   */
};

struct bbm_middle {             /* of an element, whose T is taken in the middle of the step    */
    const bbm_motion *motion;
    double D[6];
    double moment[2][2][2];     /* bending.c: of the starting shape; 0: not yet known           */
};

/* Functions that do a part of the step in another way than the paper. NULL: the paper's way. */
struct bbm_hooks {
    /* --- building --- */
    void (*release)(bbm_model *m);                          /* frees m->beyond                  */
    bbm_status (*check_polygon)(bbm_model *m, int n, const int node[]);     /* of a new element */
    bbm_status (*check)(bbm_model *m);                      /* of a prepared model              */
    /* --- a step begins --- */
    bbm_status (*begin)(bbm_model *m);                      /* may change m->acceleration       */
    const bbm_motion *(*motion)(const bbm_model *m, int ends);      /* of the step, or of points */
                                                            /* and stress as they end it; NULL: */
                                                            /* u = T D                          */
    bbm_status (*find_pairs)(bbm_model *m, double search);  /* bbm_add_pair for all near pairs  */
    void (*strength)(const bbm_model *m, bbm_contact *c);   /* sets c->strength, and c->area of */
                                                            /* one that touches at the start    */
    bbm_status (*listed)(bbm_model *m);                     /* contacts, gaps; K may be new     */
    /* --- K D = F --- */
    void (*load)(bbm_model *m);                             /* adds to m->load                  */
    void (*list_gaps)(bbm_model *m);                        /* in place of bonds, fixed points  */
    void (*assembled)(bbm_model *m);                        /* K and F, Eq. (5)                 */
    /* --- open-close --- */
    int (*partner)(const bbm_model *m, int v);              /* that shares its corner; v: none  */
    void (*vectors)(const bbm_model *m, const bbm_contact *c, double anchor, bbm_spring v[2]);
                                                            /* where a point is such a corner   */
    double (*friction)(bbm_model *m, const bbm_contact *c, const bbm_spring v[2]);
                                        /* puts it in K for the N of the solution; returns Fr */
    bbm_pass (*renew)(bbm_model *m, bbm_pass next);         /* T or F for the next solution     */
    /* --- the end of the step --- */
    bbm_status (*move)(bbm_model *m);                       /* moves the model, or refuses to   */
    bbm_status (*failed)(bbm_model *m, bbm_status s);       /* another way, or why it failed    */
};

/* --------------------------------------------- what the files of the library share, bottom up */

static inline int bbm_is_static(const bbm_model *m) { return isinf(m->h); }

/* Whether element i has inertia: not in statics, nor if a hook says that it is held all round. */
static inline int bbm_has_inertia(const bbm_model *m, int i)
{
    return !bbm_is_static(m) && m->K->body[i] >= 0;
}

/* How points move in the present step; NULL: the paper's way. */
static inline const bbm_motion *bbm_motion_of(const bbm_model *m)
{
    return m->hook->motion ? m->hook->motion(m, 0) : NULL;
}

static inline int bbm_next_vertex(const bbm_element *e, int v)
{
    return v + 1 < e->first + e->n ? v + 1 : e->first;
}

/* The boundary edge that starts at the corner of vertex v: round its node, from element to element
 * over the bonds. */
static inline int bbm_edge_at(const bbm_model *m, int v)
{
    while (m->vertex[v].edge < 0)
        v = -1 - m->vertex[v].edge;
    return m->vertex[v].edge;
}

static inline const bbm_vertex *bbm_start_of(const bbm_model *m, int edge)
{
    return &m->vertex[m->edge[edge].a];
}

static inline const bbm_vertex *bbm_end_of(const bbm_model *m, int edge)
{
    return &m->vertex[m->edge[edge].b];
}

/* The d_n from which the normal spring of a contact counts, so that it carries N at d_n. In the
 * paper 0; with a hook's motion a corner that closes inside starts unloaded. */
static inline double bbm_rest_of(const bbm_model *m, double d_n, double N)
{
    return bbm_motion_of(m) ? fmin(0, d_n + N / m->par.p_n) : 0;
}

/* The end of the list of contacts of the step in hand. */
static inline bbm_contact *bbm_end_of_contacts(const bbm_model *m)
{
    return m->scratch->contact + m->scratch->contacts;
}

/* Whether a contact is of an unbroken joint with cohesion or tensile strength. */
static inline int bbm_is_strong(const bbm_contact *c)
{
    return c->strength.shear > 0 || c->strength.tension > 0;
}

/* A contact that opens carries nothing and remembers nothing. */
static inline void bbm_forget(bbm_contact *c)
{
    c->state = BBM_OPEN;
    c->N = c->T = c->slip = 0;
    c->trial.was_closed = c->inside = 0;
}

/* The vertex that shares a corner of the boundary with v; in the paper none does, and it is v. */
static inline int bbm_partner_of(const bbm_model *m, int v)
{
    return m->hook->partner ? m->hook->partner(m, v) : v;
}

/* The point of the boundary at v: v, or halfway between the two that share it. */
static inline bbm_point bbm_point_at(const bbm_model *m, int v)
{
    const bbm_vertex *P = &m->vertex[v], *Q = &m->vertex[bbm_partner_of(m, v)];

    return (bbm_point){ (P->x + Q->x) / 2, (P->y + Q->y) / 2 };
}

/* Displacement of the point (x, y) by D: u = T D, or by a hook's motion. */
static inline void bbm_move(const bbm_motion *motion, const bbm_element *e, const double D[6],
                            double x, double y, double u[2])
{
    if (motion)
        motion->move(D, x - e->x, y - e->y, u);
    else
        bbm_displacement(e, D, x, y, u);
}

/* bbm.c: 3.3, 3.4 */
void       bbm_step_point(const bbm_element *e, double x, double y, double T[2][6], double at[2]);
void       bbm_step_matrix(const bbm_element *e, double x, double y, double T[2][6]);
double     bbm_mass_per_area(const bbm_element *e);                             /* M of (11)    */
void       bbm_bonding_gap(const bbm_element *i, const bbm_vertex *P, const bbm_element *j,
                           const bbm_vertex *Q, double k, bbm_gap *g);          /* (22)         */
void       bbm_bonding_submatrices(const bbm_gap *g, bbm_submatrices *s);       /* (27), (28)   */
void       bbm_fixed_gap(const bbm_element *e, const bbm_vertex *P, const bbm_node *W, double k,
                         bbm_gap *g);                                           /* (33)         */

/* order.c: a new K, of one row or more. `link` lists the i, j whose submatrix K_ij is not zero, in
 * any order, either way round, repeats allowed. Then its entries. */
bbm_status bbm_matrix_new(int n, int links, int (*link)[2], bbm_matrix **K);
void       bbm_matrix_free(bbm_matrix *K);                      /* takes NULL                   */
int        bbm_compare_pairs(const void *p, const void *q);     /* by their first two integers  */
void       bbm_matrix_clear(bbm_matrix *K);
bbm_status bbm_matrix_add(bbm_matrix *K, int i, int j, double B[6][6]); /* K_ij += B, K_ji += B^T;
                                   what the pattern does not have fails here and in bbm_solve   */
bbm_status bbm_lay_out_matrix(bbm_model *m);                    /* for the gaps and contacts    */

/* solver.c: section 4, for the rows in hand */
void       bbm_add_lower(const bbm_matrix *K, const double *x, double *y);      /* y += L x     */
void       bbm_add_upper(const bbm_matrix *K, const double *x, double *y);      /* y += L^T x   */
void       bbm_multiply(const bbm_matrix *K, const double *p, double *q);       /* q = K p      */
double     bbm_dot_rows(const bbm_matrix *K, const double *x, const double *y); /* x.y          */
void       bbm_combine(const bbm_matrix *K, const double *x, double c, const double *y, double *z);
int        bbm_invert(double w, double D[6][6], double B[6][6]);                /* (D/w)^-1     */
void       bbm_precondition(const bbm_matrix *K, const double *r, double *u);   /* u = M^-1 r   */
bbm_status bbm_count_iteration(double positive, const bbm_pcg *pcg, bbm_pcg_info *info);
bbm_status bbm_iterate(bbm_matrix *K, const bbm_pcg *pcg, bbm_pcg_info *info);  /* x = K^-1 r   */

/* solve.c: K D = F. Rows that no pairs connect, however indirectly, are solved apart: neither
 * changes a bit of the other's D. */
void       bbm_matrix_measure(bbm_matrix *K, const double *F);
bbm_status bbm_solve(bbm_matrix *K, const double *F, double *D, const bbm_pcg *pcg,
                     bbm_pcg_info *info);

/* cut.c: around a step */
typedef struct {                /* of a parameter, low and high included                        */
    const char *name;
    double value, low, high;
    const char *expected;       /* low to high in words                                         */
} bbm_range;

bbm_status bbm_fail(bbm_model *m, bbm_status s, const char *format, ...);
bbm_status bbm_out_of_memory(bbm_model *m);
bbm_status bbm_append(bbm_model *m, void **array, int *count, size_t size, const void *entry,
                      int *index);
bbm_status bbm_check_ranges(bbm_model *m, int n, const bbm_range range[]);
bbm_status bbm_check_step(bbm_model *m);                        /* prepared; parameters         */
int        bbm_parts_to_try(bbm_model *m, bbm_status status, int tries);
int        bbm_is_spent(const bbm_model *m);                    /* too much work for a step     */
bbm_status bbm_say_what_failed(bbm_model *m, bbm_status status);

/* detect.c: which corner may touch which edge */
bbm_status bbm_detect_new(bbm_model *m);
void       bbm_detect_free(bbm_contact_scratch *w);             /* takes NULL                   */
void       bbm_foresee_step(bbm_model *m);                      /* D by the velocities          */
int        bbm_moved_too_far(const bbm_model *m);
bbm_status bbm_list_pairs(bbm_model *m, int *same);             /* and what carries over        */
bbm_status bbm_add_pair(bbm_model *m, int corner, int edge);    /* if they are near             */
int        bbm_carries(const bbm_model *m, int corner, int edge);
double     bbm_allowed_depth(const bbm_model *m, int corner, int edge); /* at the start, m      */
int        bbm_may_enter(const bbm_model *m, int corner, int edge);
int        bbm_is_held_all_round(const bbm_model *m, const bbm_element *e);
double     bbm_way_along(const bbm_model *m, int corner, int edge);     /* of P1 from P3, m     */
double     bbm_rounding(const bbm_model *m, int corner);       /* m                            */
double     bbm_size_at(const bbm_model *m, const bbm_contact *c);       /* m                    */
int        bbm_is_at_corner(const bbm_model *m, const bbm_contact *c);
int        bbm_is_blocked(const bbm_model *m, const bbm_contact *c);
void       bbm_end_distances(const bbm_model *m, const bbm_contact *c, double anchor, double d[2]);
void       bbm_note_depths(bbm_model *m, const bbm_contact *list, int n);
void       bbm_keep_contacts(bbm_model *m);                     /* the step's become the model's */

/* contact.c: 3.7, 3.8 */
void       bbm_normal_vectors(const bbm_touch *c, bbm_spring *n);               /* (57)         */
void       bbm_shear_vectors(const bbm_touch *c, double anchor, bbm_spring *s); /* (61)         */
double     bbm_length_of(const bbm_spring *v, int parts, const int row[], const double *D);
double     bbm_normal_force(const bbm_model *m, double d);                      /* N, (65)      */
double     bbm_normal_stiffness(const bbm_model *m);
double     bbm_normal_energy(const bbm_model *m, double N);                     /* (51)         */
void       bbm_spring_submatrix(double p, const double v[6], const double w[6], double K[6][6]);
                                                                                /* (58), (63)   */
void       bbm_force_submatrix(double f, const double v[6], double F[6]);       /* (58), (69)   */
double     bbm_tangent(double degrees);
double     bbm_shear_strength(const bbm_strength *s, double N);                 /* (65)         */
double     bbm_shear_force(const bbm_contact *c);                               /* T or (65)    */
bbm_contact_state bbm_next_state(const bbm_contact *c, double N, double tolerance);  /* table  */
int        bbm_is_strengthless(const bbm_contact *c, double N);
void       bbm_contact_vectors(const bbm_model *m, const bbm_contact *c, double anchor,
                               bbm_spring v[2]);
void       bbm_assemble_contacts(bbm_model *m);

/* open_close.c: the contacts of a step, and their states */
bbm_status bbm_detect_contacts(bbm_model *m, int *same);
bbm_pass   bbm_open_close(bbm_model *m);
void       bbm_store_contacts(bbm_model *m);

/* step.c: assembly (5), the step */
bbm_gap   *bbm_add_gap(bbm_model *m, int i, int j);
void       bbm_list_gaps(bbm_model *m);
void       bbm_list_bond(bbm_model *m, const bbm_bond *b);
void       bbm_list_fixed_point(bbm_model *m, int v, const bbm_node *W);
void       bbm_add_submatrices(bbm_model *m, int i, int j, bbm_submatrices *s); /* j < 0: wall  */
void       bbm_assemble_gap(bbm_model *m, const bbm_gap *g);
void       bbm_assemble(bbm_model *m);                          /* K and F, Eq. (5)             */
void       bbm_move_elements(const bbm_model *m, bbm_element element[], bbm_vertex vertex[]);
bbm_status bbm_begin_step(bbm_model *m);
bbm_status bbm_detect(bbm_model *m, int *holds);                /* and K for the contacts       */
bbm_status bbm_try_step(bbm_model *m);                          /* Fig. 8 once, with m->h       */

/* build.c */
size_t     bbm_most_gaps(const bbm_model *m);                   /* once bonds are found         */

#endif
