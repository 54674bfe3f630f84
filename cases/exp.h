/* exp.h - what Experiments I and III show beyond the paper: in files of their own, exp1_beyond.c
 * and exp3_beyond.c. `make paper` has paper.c in their place and leaves it out. */
#ifndef EXP_H
#define EXP_H

#include "case.h"

enum { EXP1_LENGTH = 48, EXP1_HEIGHT = 12 };    /* m */

/* exp1.c. The beam on a grid under load a, b or c; and on the grid of the experiment, with 25 k x
 * 6 k crossed cells and the paper's bonds and solver: ready to be prepared. */
void exp1_add_beam(bbm_model *m, char variant, case_grid *g);
bbm_model *exp1_beam(char variant, int k, double alpha);

/* exp1_beyond.c: tables of load b, against its reference values. */
void exp1_show_beyond(const case_reference *b);

typedef struct {                    /* a run of Experiment III                                  */
    const char *name, *label;
    double gravity, plate;          /* m/s^2, Pa                                                */
    int    line;                    /* the traction is a line load                              */
    void (*change)(bbm_model *m);   /* what the paper does not have; or NULL                    */
} exp3_variant;

extern const exp3_variant exp3_beyond;          /* exp3_beyond.c; without a name: none          */

#endif
