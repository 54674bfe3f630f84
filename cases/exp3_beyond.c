/* exp3_beyond.c - Experiment III beyond the paper: gravity and a plate of 10 GPa, with multipliers,
 * so that the fixed points of the plate hardly give. */
#include "../beyond/beyond.h"
#include "exp.h"

static void augment(bbm_model *m) { m->beyond->multiplier_rounds = 2; }

const exp3_variant exp3_beyond = {
    "held", "gravity, plate of 10 GPa, augmented", 9.81, 1e10, 0, augment,
};
