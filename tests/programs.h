/* programs.h - running the programs from the tests, and reading what they write. */
#ifndef BBM_TESTS_PROGRAMS_H
#define BBM_TESTS_PROGRAMS_H

#include "check.h"

#ifndef BUILD
#define BUILD "out/build"       /* where the programs are */
#endif

enum { LONG = 1500 };           /* of a text */

int shell(const char *format, ...);                     /* a command, as by printf; its exit status */
const char *slurp(const char *path);    /* the beginning of a file, until the next; "": not there */
char *read_all(const char *path);                       /* the whole file, to be freed */
void check_text(const char *path, const char *expected);    /* the file has the text in it */
void write_text(const char *path, const char *text);
/* Runs the text as out/model/NAME.model into out/model/NAME; the exit status. Messages: NAME.err. */
int run_text(const char *name, const char *text);
int run_printed(const char *name, const char *format, ...); /* the same, of a text as by printf */
/* A shipped model with other numbers, which are arguments; the exit status. */
int run_with(const char *model, const char *lets);
/* A cell of out/model/NAME/FILE, in the last row that begins with `row` ("" for the last one). */
double cell(const char *name, const char *file, const char *row, const char *column);

/* The sum of a column of out/model/NAME/FILE over the rows that contain `part`. */
double sum(const char *name, const char *file, const char *column, const char *part);

#define ROCK "material rock E 1e10 nu 0.25 density 2500\n"
#define TWO ROCK "block base rock 0 0 10 0 10 1 0 1\nfixblock base\n"
#define STEEL "material steel E 2e11 nu 0.3 density 7800 thickness 0.5\n"

#endif
