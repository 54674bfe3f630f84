/* warn.h - what is allowed and hardly meant: a line each on stderr. */
#ifndef WARN_H
#define WARN_H

#include "model.h"

void warn_before(const model *p, const char *path);     /* of the model                         */
void warn_in_step(const model *p, const char *path, int step, int *said);      /* once a run    */
void warn_after(const model *p, const char *path);      /* of the run                           */

#endif
