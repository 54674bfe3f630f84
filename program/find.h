/* find.h - the limit of a number: `./bbm MODEL --find NAME LOW HIGH`. */
#ifndef FIND_H
#define FIND_H

#include "model.h"

typedef struct {
    const char *model, *name;   /* the file; the name of a `let` */
    double low, high;
    int    lets, quiet;
    char **let;                 /* [lets]       NAME=VALUE of the command line; room for one more */
    int  (*stop)(const bbm_model *m, void *none);       /* looked at before each solution */
} find;

int find_limit(const find *f);  /* says what it finds; the exit status */

#endif
