/* output.h - files that stand under their name only when they are complete, and folders.
 *
 *     output_open         begins PATH as PATH.N.tmp, N the number of this process: two runs share no file
 *     output_close        gives it its name
 *     output_drop         gives it up
 *
 * What fails leaves the reason in errno and nothing on the disk. What systems do differently with files is here.
 */
#ifndef OUTPUT_H
#define OUTPUT_H

#include <stdio.h>

typedef struct {
    FILE *file;                 /* NULL: not open                                                              */
    int   direct;               /* a device or a pipe: written as it is, for it must not be replaced           */
    char  path[1100], temporary[1130];
} output;

int  output_open(output *o, const char *path);          /* 1, or 0                                              */
int  output_close(output *o);                           /* 1: the complete file stands under its name; 0        */
void output_drop(output *o);
int  output_make_folder(const char *path);              /* 1: it is there now; 0 (EEXIST: as no folder)         */
/* Length of the name that a temporary file is to have, and the process that writes it; 0: it is none.          */
size_t output_is_temporary(const char *name, long *process);
int  output_is_alive(long process);                     /* where this cannot be asked: 0                        */

#endif
