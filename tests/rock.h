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

#endif
