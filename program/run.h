/* run.h - a run of a model file, step by step, and what came out of it: what ./bbm and the page
 * share.
 *
 *     run r = { .p = &p, .settling = p.settle };
 *     while (!status && !r.is_over)
 *         status = run_step(&r);
 */
#ifndef RUN_H
#define RUN_H

#include "model.h"

typedef struct {
    model *p;
    int settling, has_begun;            /* settling: quasi-static steps that are left */
    int stage_is_over, is_over;
} run;

/* Settles by a step; if that is done, begins at t = 0; then takes the steps of the model, until all
 * are done or (71) is met, and those of each stage. BBM_STEPS_EXHAUSTED: all are done, and it is
 * not met. */
bbm_status run_step(run *r);
void run_says(const run *r, bbm_status status, char out[500]);      /* why a run failed */
int  run_is_met(const model *p, int k, char out[300]);  /* expectation k beside what came out */

/* warn.c: what is allowed and hardly meant, a line each on stderr: of the model; of a way that is
 * long, once a run; of the run. */
void warn_before(const model *p, const char *path);
void warn_in_step(const run *r, const char *path, int *said);
void warn_after(const model *p, const char *path);

#endif
