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

#include "../bbm.h"

enum { SCENE_CORNERS = 8, SCENE_NODES = 32, SCENE_ELEMENTS = 32, SCENE_BLOCKS = 40 };

typedef enum { SCENE_BOX, SCENE_KINDS } scene_kind;

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
    int blocks;
    scene_block block[SCENE_BLOCKS];
} test_scene;

typedef struct {                /* what there is at one moment                                                  */
    double kinetic, elastic, springs;   /* J                                                                    */
    double P[2], L;             /* N s, N m s   momentum, and that about the origin                             */
    double P_size, L_size;      /* the same, all parts counted as positive: what a drift is small against       */
    double overlap;             /* m        of two blocks, at most, beyond the deepest closed contact           */
} scene_ledger;

uint64_t scene_random(uint64_t *state);                         /* splitmix64                                   */
const char *scene_name(scene_kind kind);
void scene_make(uint64_t seed, int kind, test_scene *s);        /* kind -1: the seed chooses                    */
bbm_status scene_build(const test_scene *s, bbm_model **m);     /* ready for bbm_step                           */

void scene_balance(const bbm_model *m, scene_ledger *l);
void scene_barycentres(const bbm_model *m, double (*x)[2]);     /* [elements]                                   */
double scene_work(const bbm_model *m, double (*before)[2], double *size);       /* of gravity since then        */

#endif
