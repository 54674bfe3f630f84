/* write.h - the results of a model file as files: CSV, VTK for ParaView, pictures (SVG), K and F (Matrix Market).
 *
 *     write_open          makes the folder, begins history.csv and summary.csv
 *     write_step          a row of each, a picture, for the start (step 0) and each nominal step
 *     write_close         the end of the run: nodes.csv, elements.csv, timing.csv, pictures
 *
 * A file is written as NAME.tmp and renamed when it is complete. The first error stays in `message`; what comes after
 * it still tries to keep what there is.
 */
#ifndef WRITE_H
#define WRITE_H

#include <stdio.h>
#include <time.h>

#include "model.h"
#include "scene.h"

typedef struct { FILE *file; int direct; char path[1024], temporary[1030]; } write_file;   /* direct: a device        */

typedef struct {
    model *p;
    const char *folder, *matrix;        /* matrix: of -m, or NULL                                                 */
    write_file history, summary;
    scene film;
    int matrix_done, step;              /* step: the last one that has its rows                                   */
    clock_t reading, start, writing;    /* CPU time of reading, at the start of the program, of writing           */
    int status;                         /* 0, or 1 with a message                                                 */
    char message[1400];
} write_results;

int  write_open(write_results *w);
int  write_step(write_results *w, int step);                /* 1, or 0 after an error                              */
int  write_close(write_results *w);
void write_matrix(const bbm_model *m, void *results);       /* a watch of the library: the first K and F          */

#endif
