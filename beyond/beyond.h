/* beyond.h - what stands beside the paper: its settings, and the model that has it all.
 *
 * The core, the files on top and base/, knows nothing of this. bbm_beyond_new makes a model as
 * bbm_model_new does and hooks everything into it; what it takes to run is in m->beyond. All that
 * stands here takes such a model. Each subject is a file of its own with an essay.
 */
#ifndef BBM_BEYOND_H
#define BBM_BEYOND_H

#include <float.h>

#include "../base/base.h"

/* [-] of a position or a displacement: some dozens of its last digit. What a spring makes of it may
 * be left, and so may its work. */
#define BBM_ROUNDING (64 * DBL_EPSILON)

typedef enum { BBM_EXACT, BBM_LINEAR } bbm_rotation;    /* x + R(r0) (1 + e) X; the paper's T D */

typedef enum {                  /* how quadrilaterals are bonded; others at their vertices      */
    BBM_MOMENT,                 /* in the middle of the edge, with the moment of bending        */
    BBM_VERTICES                /* at both ends: the paper                                      */
} bbm_bonding;

typedef struct {                /* surroundings.c, of a node                                    */
    double force[2];            /* N        on it, at the end of the last step; 0: it is free   */
    double moved[2];            /* m        its wall point, since that step                     */
    double to[2];               /* m        where that is then                                  */
    double rate[2];             /* m/s      the same over the length of that step               */
    double earlier[2];          /* m/s      the same of the step, or part of one, before        */
    double part[2][2];          /* N        its force in the step in hand; in its jump, impact.c */
    int    held, caught;        /* directions in which the last step held it; and in which it   */
                                /*          was free in a step before                           */
} bbm_support;

typedef struct {                /* energy.c: of an element, and of the component of this number */
    double springs[2];          /* J        what springs store that are counted at the element: */
                                /*          at the start, and in the solution in hand           */
    double gain, there, work;   /* J        of a component, in a part of a step                 */
    double rounding;            /* J        what rounding of positions may make of its gain     */
    double pressed;             /* N m      sum f.X of what presses on element i, see stability.c */
    double held[2];             /* J        work of the supports of element i, in a part of a   */
                                /*          step, and in the jump at its end                    */
    int    struck;              /* impact.c: velocities in the component change at once (1), by */
                                /*          more than contacts bear (2)                         */
    int    jumps;               /* impact.c: the component does; -1: it keeps no shape; -2: nor */
                                /*          does it rub                                         */
    double asked;               /* -        of the energy that hits are to give back            */
    int    unsettled;           /* the jump has found no states for all its contacts            */
    double asks;                /* J        what its short springs ask for to get longer        */
    double share;               /* -        of that which they get                              */
    double mass;                /* kg       in a hit: what is free to move                      */
    int moves;                  /* something has inertia                                        */
} bbm_account;

typedef struct {                /* equilibrium.c: of a body, at its first element               */
    double x, y, area, size;    /* m, m, m^2, m     the centre, and how large it is             */
    double force[2], moment;    /* N, N m   what is left: the sum, and about the centre         */
    double forces, rounding;    /* N        all of them without direction; of what is left      */
    double inside;              /* N        the forces inside it, without direction             */
    int    stiff;               /*          so much that its inertia loses digits in K          */
    double breach;              /* N        the most that a contact or bolt has against its law */
} bbm_balance;

typedef struct {                /* joints.c: a joint of its own strength; < 0: the model's      */
    int    block[2];            /* -1: any                                                      */
    double friction;            /* degree   friction angle                                      */
    double cohesion, tension;   /* Pa       as long as it is unbroken                           */
} bbm_joint;

typedef struct {                /* surroundings.c: on the edge that starts at the vertex a      */
    int    a;
    double f[2], pressure;      /* N/m      pressure: against the outward normal, turns with it */
    double level, density;      /* m, kg/m^2 of water, which presses besides; 0: there is none  */
    double N[6];                /*          what presses in the step, in F                      */
    double sinks[6][6], turns[6][6];        /* of its stiffness what is in K, and what is not   */
} bbm_edge_load;

typedef struct {                /* crack.c: of a bond                                           */
    int    bond;                /* its number at the start                                      */
    int    tooth;               /* 0: as new; more: how often it has softened, or broken        */
    int    pushes[2];           /* its ends are closed                                          */
    int    shears;              /* more than it pulls                                           */
    double rest[2];             /* m        of the spring at the first end, along the normal    */
                                /*          and across; less that of the other one              */
    double s[3];                /* Pa       s, t, s1 of crack.c                                 */
    double across;              /* -        how well it lies across the tension around it       */
} bbm_crack;

typedef struct {                /* crack.c: a bond that has broken                              */
    int    step, bond, shears;
    double x, y;                /* m        its middle then                                     */
} bbm_break;

struct bbm_beyond {
    /* --- settings --- */
    double bond_tension, bond_cohesion, bond_friction, bond_energy;     /* Pa, Pa, degree, J/m^2 */
                                /*          crack.c; tension 0: none breaks; energy 0: brittle  */
    bbm_bonding  bonding;       /* bending.c                                                    */
    bbm_rotation rotation;      /* rotation.c                                                   */
    double cohesion, tension;   /* Pa       joints.c: of unbroken joints                        */
    int joints_hold;            /* 1: they bear anything, as long as they are unbroken          */
    int multiplier_rounds;      /* multipliers.c: further solutions of a static step; 0: paper  */
    int round;                  /* of them, in this step                                        */
    double shake[2];            /* m/s^2    acceleration of the base: shake sin(shake_omega t)  */
    double shake_omega;         /* 1/s      */
    double reach;               /* -        statics.c: how far blocks may part in a static step */
    double restitution;         /* -        impact.c: -1: none, as the springs do               */
    int passed[2];              /* overlap.c: a corner and an edge whose block it passed into;  */
                                /* -1: none                                                     */
    int joints;
    bbm_joint *joint;           /* [joints]                                                     */
    bbm_support *support;       /* [nodes]                                                      */
    double (*off)[2];           /* [vertices] m     from its node, when that was caught         */
    double left, share;         /* -        of dt that is left to do, and of it the part that   */
                                /*          is in hand                                          */
    double h_before;            /* s        the last step                                       */
    bbm_contact *jump_of;       /* [contacts] impact.c: of the step that ends with the jump     */
    bbm_middle *middle;         /* [elements], rotation.c                                       */
    bbm_element *end_element;   /* [elements], energy.c: the end of the step                    */
    bbm_vertex *end_vertex;     /* [vertices]                                                   */
    bbm_crack *crack, *kept;    /* [bonds]  crack.c: of the step in hand; of the last one       */
    double *best;               /* [nodes]  scratch; in a list 1: cracks end there              */
    int edges;                  /*          of bodies as they were prepared; behind them sides  */
                                /*          of cracks                                           */
    int breaks;                 /*          in how many passes of the step bonds broke          */
    int parts;                  /*          whether bonds broke in the last step                */
    int loose;                  /*          an element of a piece that came off in statics and  */
                                /*          that no support holds; or -1                        */
    int edge_loads;
    bbm_edge_load *edge_load;   /* [edge_loads]                                                 */
    /* --- results --- */
    int broken, caught;         /* crack.c: bonds; corners that were inside another body        */
    bbm_break *broke;           /* [broken] in the order of steps                               */
    double crack_energy;        /* J        that softening has taken                            */
    double work;                /* J        of loads and gravity, in all steps                  */
    int *body;                  /* [2 elements] the first element of its body, what bonds join; */
                                /*          the second half is scratch                          */
    bbm_balance *balance;       /* [elements] equilibrium.c: of the solution in hand            */
    double *lacking;            /* [12 elements] equilibrium.c, N, m: the F that is left of the */
                                /*          balance, and the D that it asks for                 */
    int refines;                /*          D has just got that, and contacts are judged        */
    double lack;                /* -        the most that a body has left, without inertia      */
    double parted;              /* -        how far blocks went in steps from rest, in sizes    */
    double overload;            /* -        crack.c: load of a bond over its strength, least 1  */
    double breach;              /* -        the most against a law in all dynamic steps         */
    bbm_account *account;       /* [elements]                                                   */
    double gained;              /* J        what dynamic steps have made beyond the balance     */
    double gain;                /* -        the most that one made, against what was there      */
    double hit[2];              /* J        impact.c: of contacts that closed, before and after */
    double made;                /* -        what the step in hand has, as in `gain`             */
};

/* As bbm_model_new, but with round -1, two levels and no restitution. A node that bbm_fix_node
 * holds after a step is held where it is then, whatever u and v, and bbm_move_support counts from
 * there. */
bbm_status bbm_beyond_new(bbm_model **m);

/* coarse.c: two levels, for pcg.method */
#define BBM_PLACES (1LL << 30)  /* of a component */
typedef struct { double f, fx, fy; } bbm_linear;    /* f(x, y) at the centroid, 1/m: its slopes */
extern const bbm_method bbm_two_level;
bbm_status bbm_matrix_coarse(bbm_matrix *K, int nodes, const int *first, const int *node,
                             const long long *place, const int *middles);
bbm_status bbm_matrix_interpolate(bbm_matrix *K, int i, int k, double Q[4][4], bbm_linear f,
                                  const bbm_element *e);

/* factor.c */
typedef struct { int from, to; size_t at; } bbm_part;  /* columns, in pairs; its first entry in A */
typedef struct {
    int n, *first;              /* [n+1]    pairs of rows; i has part[first[i] .. first[i+1]-1] */
    bbm_part *part;
    size_t entries;
    double *A;                  /* of a part the first row, then the second                     */
    double *size;               /* [2 n]    what a pivot is measured by                         */
} bbm_factor;
bbm_status bbm_factor_lay_out(bbm_factor *f, int n, int entries, int (*entry)[2]);
void       bbm_factor_free(bbm_factor *f);
double    *bbm_entry(const bbm_factor *f, int i, int j);
void       bbm_factor_make(const bbm_factor *f);
void       bbm_substitute(const bbm_factor *f, int from, int to, double *x);

/* interpolation.c */
void       bbm_slopes(const double D[6], double Q[4][4]);
bbm_linear bbm_interpolation(const bbm_element *e, const bbm_vertex vertex[], int a);
bbm_status bbm_lay_out_coarse(bbm_model *m);
void       bbm_interpolate_elements(bbm_model *m);

/* energy.c. The energies after the last step; kinetic: with the velocity before its factor. */
typedef struct { double kinetic, elastic, springs; } bbm_energy;        /* J */
void       bbm_energies(const bbm_model *m, bbm_energy *e);
void       bbm_note_springs(bbm_model *m, int when);     /* of the solution in hand             */
bbm_model  bbm_end_of_step(const bbm_model *m);
void       bbm_find_accounts(bbm_model *m, const bbm_model *end);
bbm_status bbm_check_balance(bbm_model *m, const bbm_model *end);
double     bbm_inertia_form(const bbm_element *e, const double V[6]);   /* int u.M u dA, u = T V */

/* rotation.c */
const bbm_motion *bbm_find_motion(const bbm_model *m, int ends);
void       bbm_turn_tensor(double s[3], double r);
void       bbm_set_middle(bbm_model *m);
int        bbm_middle_is_off(const bbm_model *m);
int        bbm_contacts_are_off(const bbm_model *m, double share);

/* bending.c */
void       bbm_condense(int n, int rows, double *W);                 /* [n][n] */
void       bbm_bending_moments(const bbm_element *e, const bbm_vertex vertex[], double M[2][2][2]);
void       bbm_edge_gap(const bbm_gap end[2], double sign, double W[2][2], bbm_gap *g);
void       bbm_turn_opening(const bbm_element *i, const bbm_element *j, bbm_gap *g);
void       bbm_list_edge_gaps(bbm_model *m);
int        bbm_find_partner(const bbm_model *m, int v);
void       bbm_shared_vectors(const bbm_model *m, const bbm_contact *c, double r, bbm_spring v[2]);

/* multipliers.c */
void       bbm_gap_length(const bbm_model *m, const bbm_gap *g, double d[2]);   /* of m->D      */
void       bbm_start_multipliers(bbm_model *m);
bbm_pass   bbm_take_over(bbm_model *m);
void       bbm_store_multipliers(bbm_model *m);

/* crack.c */
bbm_status bbm_begin_cracks(bbm_model *m);
int        bbm_tooth_of(const bbm_model *m, int b);
int        bbm_is_broken(const bbm_model *m, int b);
int        bbm_list_crack(bbm_model *m, int b);
bbm_pass   bbm_break_bonds(bbm_model *m);
bbm_status bbm_start_cracks(bbm_model *m);
void       bbm_keep_cracks(bbm_model *m);
bbm_status bbm_catch_corners(bbm_model *m, double search);
bbm_status bbm_say_cracks(bbm_model *m, bbm_status s);

/* sliding.c */
bbm_status bbm_lay_out_sliding(bbm_model *m);
double     bbm_put_friction_in_K(bbm_model *m, const bbm_contact *c, const bbm_spring v[2]);

/* sweep.c */
typedef struct {                /* around an edge or element, m                                 */
    double low[3], high[3];     /* along the axis of the sweep, x and y                         */
    int    of;
} bbm_box;
bbm_box    bbm_empty_box(int of);
void       bbm_widen_box(bbm_box *b, double x, double y, double wide);
void       bbm_sort_boxes(int n, bbm_box *b);
int        bbm_next_meeting(int n, const bbm_box *b, int *i, int *j);
bbm_status bbm_find_near_pairs(bbm_model *m, double search);

/* joints.c */
bbm_status bbm_add_joint(bbm_model *m, const int block[2], double friction, double cohesion,
                         double tension);
void       bbm_joint_strength(const bbm_model *m, bbm_contact *c);
bbm_pass   bbm_break_joints(bbm_model *m);

/* surroundings.c; of a prepared model, the loads on a boundary edge in N/m */
bbm_status bbm_load_edge(bbm_model *m, int edge, double fx, double fy, double pressure);
bbm_status bbm_add_water(bbm_model *m, int edge, double level, double density);
void       bbm_gather_edge_loads(bbm_model *m);
double     bbm_settle_loads(bbm_model *m);
bbm_status bbm_move_support(bbm_model *m, int node, double u, double v);    /* m, in all        */
void       bbm_place_supports(bbm_model *m);
void       bbm_find_reactions(bbm_model *m);
void       bbm_follow_supports(const bbm_model *m, bbm_element *e,
                               double (*velocity)(const bbm_model *m, int node, int direction));
void       bbm_stop_supports(bbm_model *m);
void       bbm_set_plane_strain(bbm_model *m);          /* of the elements that are there       */

/* impact.c */
void       bbm_stiffen(bbm_model *m);                   /* K of a step with a hit               */
bbm_status bbm_jump(bbm_model *m, bbm_model *end, double hit[2]);   /* of a step that settled   */

/* refuse.c, statics.c */
bbm_status bbm_check_settings(bbm_model *m);
int        bbm_contact_turns_over(const bbm_model *m);
int        bbm_blocks_meet(const bbm_model *m);
bbm_status bbm_check_solution(bbm_model *m);
bbm_status bbm_check_depth(bbm_model *m);
int        bbm_is_held(const bbm_model *m, const int body[], int i);
bbm_status bbm_check_supports(bbm_model *m);            /* of the contacts that are listed      */
bbm_status bbm_begin_statics(bbm_model *m);             /* of a prepared model                  */
bbm_status bbm_check_reach(bbm_model *m, const bbm_model *end);
bbm_status bbm_try_otherwise(bbm_model *m, bbm_status s);

/* equilibrium.c. BBM_BALANCED [-]: what may be left in statics of the forces on a body, or of their
 * moment; nobody knows a limit load better. */
#define BBM_BALANCED 1e-6
void       bbm_contact_forces(const bbm_model *m, const bbm_contact *c, double F[BBM_PARTS][6]);
bbm_pass   bbm_refine(bbm_model *m);                    /* D, where K has lost inertia          */
bbm_status bbm_check_equilibrium(bbm_model *m);         /* of the solution in hand              */

/* stability.c */
double     bbm_tension_stiffness(const bbm_model *m, int i);
bbm_status bbm_find_stability(bbm_model *m, int *stable);   /* after a static step with BBM_OK  */

/* overlap.c */
typedef struct {                /* elements i < j that overlap                                  */
    int    i, j;
    double depth;               /* m        of the deepest point of the one in the other        */
    double x, y;                /* m        that point                                          */
} bbm_overlap;
bbm_status bbm_check_overlap(bbm_model *m);
bbm_status bbm_find_overlap(const bbm_model *m, bbm_overlap *o);    /* the deepest; i = -1: none */
double     bbm_depth_behind(const bbm_model *m, int corner, int edge, double far, int *over);
double     bbm_depth_passed(const bbm_model *m, int corner, int edge);      /* m                */
bbm_status bbm_check_passed(bbm_model *m);              /* of all that the sweep has met        */
bbm_status bbm_check_passing(bbm_model *m, const bbm_model *end);   /* in the step in hand      */

/* mesh.c */
bbm_status bbm_check_polygon(bbm_model *m, int n, const int node[]);
int        bbm_find_pieces(const bbm_model *m, int piece[]);        /* what bonds join          */
int        bbm_root_of(int up[], int e);        /* of a forest: up[e] leads to the root of e    */

#endif
