/* write.h - the results of a model file as files: CSV, VTK for ParaView, pictures (SVG), K and F
 * (Matrix Market).
 *
 *     write_open       makes the folder and locks it, or empties it of an earlier run, begins
 *                      history.csv, summary.csv
 *     write_step       a row of each, a picture, for the start (step 0) and each nominal step
 *     write_stage      tables of where a stage ends and another one begins
 *     write_close      the end of the run: nodes.csv, elements.csv, contacts.csv, ... pictures
 *
 * A file has its name when it is complete (output.h); history.csv and summary.csv, if they cannot
 * be, have the rows that could be written. Each error is a line on stderr and makes `status` 1;
 * what comes after it still tries to keep what there is.
 */
#ifndef WRITE_H
#define WRITE_H

#include "model.h"
#include "output.h"

typedef struct {
    model *p;
    const char *source, *folder, *matrix; /* the model file, for messages; matrix: of -m, or NULL */
    char path[LONGEST];                 /* in the folder, the last one */
    output history, summary;
    FILE *lock;                         /* of the folder */
    scene film;
    double *kept;                       /* [columns][ROWS] for history.svg, or NULL: no memory */
    int row, halved;                    /* of it: the present one; how often half of them went */
    int step;                           /* the last one that has its rows */
    clock_t reading, start, writing;    /* CPU time: of reading, at the start, of writing        */
    int status;                         /* 0, or 1 after a message */
} write_results;

int  write_check(write_results *w);                         /* model.svg alone; 1, or 0 */
int  write_open(write_results *w);                          /* 1, or 0 after an error */
void write_step(write_results *w, int step);
void write_stage(write_results *w);     /* nodes_N.csv, reactions_N.csv of the last step N */
void write_close(write_results *w);
void write_matrix(write_results *w);            /* K and F of -m, which is NULL then: it is done */

#endif
