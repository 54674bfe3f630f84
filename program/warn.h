/* warn.h - what is allowed and hardly meant: a line each on stderr. */
#ifndef WARN_H
#define WARN_H

#include "run.h"

void warn_before(const model *p, const char *path);     /* of the model                         */
void warn_in_step(const run *r, const char *path, int *said);   /* of a long way: once a run    */
void warn_after(const model *p, const char *path);      /* of the run                           */

#endif
