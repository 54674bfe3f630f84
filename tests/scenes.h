/* scenes.h - scenes that nobody has looked at: a generator of blocks that fall, stand, spin and collide, all of it from
 * one number, the seed; and what must hold in every step of them, whatever the scene.
 *
 * A scene is data: blocks of elements with their materials and velocities. So it can be turned, given in other units or in
 * another order before scene_build makes a model of it by the library's functions. The ledger is the oracle: energies,
 * momenta and overlaps from the public state alone (vertices, velocities, stresses, forces of contacts), by formulas of
 * its own. */
#ifndef BBM_TESTS_SCENES_H
#define BBM_TESTS_SCENES_H

#include <stdint.h>

#include "../beyond/beyond.h"

enum { SCENE_CORNERS = 8, SCENE_NODES = 32, SCENE_ELEMENTS = 32, SCENE_BLOCKS = 40 };

typedef enum {
    SCENE_BOX, SCENE_STACK, SCENE_WALL, SCENE_WEDGE, SCENE_CORNERS_MEET, SCENE_CLOUD, SCENE_BONDED, SCENE_KINDS
} scene_kind;

typedef struct { int n, node[SCENE_CORNERS]; } scene_element;

typedef struct {                /* one block                                                                    */
    int nodes, elements, fixed; /* fixed: all its nodes are held                                                */
    double node[SCENE_NODES][2];
    scene_element element[SCENE_ELEMENTS];
    bbm_material material;
    double at[2], v[2], spin;   /* velocity of the point `at`, and about it                                     */
} scene_block;

typedef struct {
    uint64_t seed;
    scene_kind kind;
    bbm_parameters par;         /* with par.steps: how many are of interest                                     */
    bbm_bonding bonding;
    double cohesion, tension;   /* Pa       of unbroken joints                                                  */
    int blocks;
    scene_block block[SCENE_BLOCKS];
} test_scene;

typedef struct {                /* what there is at one moment                                                  */
    double kinetic, elastic, springs;   /* J                                                                    */
    double P[2], L;             /* N s, N m s   momentum, and that about the origin                             */
    double P_size, L_size;      /* the same, all parts counted as positive: what a drift is small against       */
    double stiffness, speed;    /* N/m, m/s     of all bonds and fixed points; the largest                      */
    double overlap;             /* m        of two blocks, at most, beyond their deepest contact, scene_overlap */
    int pair[2];                /* those blocks                                                                 */
    double law;                 /* -        what a contact carries against its law                              */
} scene_ledger;

typedef struct { double x[2], V[6]; } scene_memory;     /* barycentre and velocity of an element before a step   */

enum { RULE_GAIN, RULE_MOMENTUM, RULE_TURNING, RULE_OVERLAP, RULE_LAW, RULE_BITS, RULE_UNITS, RULE_ORDER, RULE_FAR, RULE_FRAME, RULES };

extern const struct scene_rule { const char *text; double bound; } scene_rule[RULES];

typedef struct {                /* what a trial found                                                           */
    bbm_status status;
    char message[200];
    long steps, passes, cuts;
    int most_passes;
    double rounding;            /* m        what another order of the blocks makes                              */
    struct { double most; int step, first, steps; } peak[RULES];    /* the largest, its step; beyond the bound: */
                                /* the first step, how many                                                     */
} scene_trial;

uint64_t scene_random(uint64_t *state);                         /* splitmix64                                   */
const char *scene_name(scene_kind kind);
void scene_make(uint64_t seed, int kind, test_scene *s);        /* kind -1: the seed chooses                    */
bbm_status scene_build(const test_scene *s, bbm_model **m);     /* ready for bbm_step                           */

/* The same scene otherwise. */
void scene_in_units(test_scene *s, double L, double M, double T);       /* units that are so much smaller        */
void scene_in_frame(test_scene *s, double angle, const double shift[2]);
void scene_shuffle(test_scene *s, int place[]);                 /* block k becomes number place[k]              */
void scene_add_far_stone(test_scene *s);                        /* the last block                               */

void scene_balance(const bbm_model *m, scene_ledger *l);
void scene_overlap(const bbm_model *m, double deepest[SCENE_BLOCKS][SCENE_BLOCKS], scene_ledger *l);
void scene_remember(const bbm_model *m, scene_memory *before);  /* [elements]                                   */
double scene_work(const bbm_model *m, const scene_memory *before, double *size);        /* of gravity since     */
double scene_turning_off(const bbm_model *m, const scene_memory *before);

void scene_try(const test_scene *s, int verbose, scene_trial *t);
void scene_try_twin(const test_scene *s, int rule, scene_trial *t);     /* RULE_BITS and on                     */

#endif
