/* statements.h - reads a model file. */
#ifndef STATEMENTS_H
#define STATEMENTS_H

#include "model.h"

/* Reads and checks all; returns the status. `path` may be -, which is stdin. let: `NAME=VALUE` in
 * place of what the file says, [lets]. model_free releases a model that failed, too. */
int model_read(const char *path, int lets, char *const let[], model *p);

#endif
