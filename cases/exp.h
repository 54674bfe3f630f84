/* exp.h - what Experiment I shows beyond the paper, in a file of its own, exp1_beyond.c. `make
 * paper` has paper.c in its place and leaves it out. */
#ifndef EXP_H
#define EXP_H

#include "case.h"

enum { EXP1_LENGTH = 48, EXP1_HEIGHT = 12 };    /* m */

/* exp1.c. The beam on a grid under load a, b or c, ready to be prepared; and on the grid of the
 * experiment, 25 k x 6 k cells, solved. */
void exp1_add_beam(bbm_model *m, const char *variant, case_grid *g);
void exp1_solve(bbm_model *m, const char *variant, int cut, int k, double alpha);

/* exp1_beyond.c: tables of load b, against its reference values. */
void exp1_show_beyond(const case_reference *b);

#endif
