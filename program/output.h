/* output.h - files that stand under their name only when they are complete, and folders.
 *
 *     output_open         begins PATH as PATH.N.tmp, N the number of this process: two runs share
 *                         no file
 *     output_keep         what is written so far is worth keeping
 *     output_close        gives it its name, or, after an error that was noted, gives it up
 *
 * What fails leaves the reason in errno and nothing on the disk, but what is to be kept. What
 * systems do differently with files is here.
 */
#ifndef OUTPUT_H
#define OUTPUT_H

#include <stdio.h>

enum { LONGEST = 1100 };        /* of a name with its folder, with a 0 behind */

typedef struct {
    FILE *file;                 /* NULL: not open */
    int   direct;               /* a device or a pipe: written as it is, never replaced */
    int   why;                  /* the errno of the first error, or 0 */
    long  kept;                 /* bytes that stay whatever comes */
    char  path[LONGEST], temporary[LONGEST + 30];
} output;

int    output_open(output *o, const char *path);    /* 1, or 0 */
int    output_note(output *o, int good);    /* whether all was good so far; the first error stays */
int    output_keep(output *o);                      /* 1, or 0 */
int    output_close(output *o);             /* 1: the complete file stands under its name; 0, as */
                                            /* of one that could not be opened */
int    output_make_folder(const char *path);        /* 1: it is there; 0 (EEXIST: as no folder) */
/* Whether a name, or what it is to be, is stem and ending, a form of scanf. */
int    output_has_form(const char *name, const char *stem, const char *ending);
FILE  *output_lock(const char *path);           /* NULL (EBUSY: another process has it) */
int    output_holds(FILE *f, const char *path);     /* whether the file there is still that one */
void   output_unlock(FILE *f, const char *path);    /* and removes it */

#endif
