/* rock.h - jointed rock: blocks that slide, lean and lie on each other, for `make bench` and the
 * tests. */
#ifndef BBM_TESTS_ROCK_H
#define BBM_TESTS_ROCK_H

#include "../beyond/beyond.h"

enum { ROCK_SLOPE, ROCK_STEPS, ROCK_WALL, ROCK_PILE, ROCK_INCLINE, ROCK_TALL_WALL, ROCK_SCENES };

typedef struct {
    const char *name;
    bbm_model *(*make)(void);   /* to be prepared; NULL: no memory */
    int steps;                  /* how many are of interest */
} rock_scene;

extern const rock_scene rock[ROCK_SCENES];

/* B = K_ij, without terms; 0 where the pattern has no block. */
void get_block(const bbm_matrix *K, int i, int j, double B[6][6]);

#endif
