/* model.h - a problem read from a model file: ten lines of text, or a mesh from Gmsh, in place of a program.
 *
 * model_read gives the prepared library model and what the library does not keep: names, pictures wanted, monitors.
 * A node of the file that several blocks share becomes a node of each of them, for blocks are never bonded and each has
 * its own results there. These copies are the nodes of the library's model, in the order of the file.
 *
 * Reading has three steps: the file is cut into statements and words; the statements are carried out in an order in
 * which each finds what it needs; the first error ends it all with one sentence, FILE:LINE: what is wrong, and what was
 * expected. msh.c does the same for the mesh files and puts nodes, elements and sets in the same reader.
 */
#ifndef MODEL_H
#define MODEL_H

#include "../beyond/beyond.h"

typedef struct { const char *name; int nodes, *node; } model_monitor;      /* the mean of u, v over library nodes   */
typedef struct { double V[3]; int given; } model_velocity;                  /* m/s, m/s, rad/s                       */

typedef struct {
    bbm_model *m;
    char  *title;               /* or NULL                                                                      */
    int    dynamic, settle;     /* quasi-static steps before t = 0                                              */
    int    every, vtk, svg;     /* every: 0, the end only                                                       */
    const char *field;          /* of the picture: mises, sxx, syy, sxy, s1, s2, u or v                         */
    double scale;               /* by which it enlarges displacements; 0: as the picture chooses                */
    int    slippery;            /* several blocks, which may touch, and no friction given                       */
    int    blocks, monitors;
    const char **block;         /* [blocks]     names                                                           */
    const char **node;          /* [m->nodes]   ids                                                             */
    int   *node_block;          /* [m->nodes]                                                                   */
    const char **element;       /* [m->elements] ids                                                            */
    double (*centre)[2];        /* [m->elements] m, barycentres at the start                                    */
    model_velocity *velocity;   /* [blocks]     initial                                                         */
    model_monitor *monitor;     /* [monitors]                                                                   */
    int    texts;
    char **text;                /* [texts]      the files read: names and ids are words of them                 */
    int    status;              /* 0, 1: failed, 2: the input is wrong                                          */
    char   message[600];
} model;

/* Reads and checks all; returns the status. model_free releases a model that failed, too. */
int  model_read(const char *path, model *p);
double model_mises(const bbm_model *m, int element);                       /* Pa                                    */
int  model_start(model *p);     /* sets the initial velocities; 0: no memory                                    */
void model_free(model *p);

/* ------------------------------------------------------------------------------- for the readers of files alone */

typedef struct { const char *file; int line; } model_place;                 /* line 0: none is to blame             */
typedef struct { int room, count, *value; const char **key; } model_table;  /* from a word to a number              */
typedef struct { model_place at; int first, n, kind; } model_statement;     /* words first .. first+n-1             */

typedef struct {
    const char *id;
    double x, y;
    model_place at;
    int by_hand, first, copies, mark;   /* first copy, or -1; their number; the last statement that named it   */
} model_node;

typedef struct { const char *id; model_place at; int block, material, first, n; } model_element; /* corner[first ..] */
typedef struct {
    const char *name;
    model_place at;
    int material, meshed, fixed, stressed;      /* material: by `use`, or -1                                    */
    double stress[3];
} model_block;
typedef struct { int n, *node, dimensions; } model_set;   /* bits: of points, curves, surfaces of a mesh     */
typedef struct { int node, block, next; } model_copy;   /* of a node for a block: library node; the next copy, or -1 */

typedef struct {
    model *p;
    const char *path;                       /* of the model file                                                */
    int words, statements, nodes, elements, corners, blocks, materials, sets, chosen, copies;
    char **word;                            /* [words]                                                          */
    model_statement *statement;             /* [statements]                                                     */
    model_node *node;
    model_element *element;
    int *corner;                            /* [corners]    nodes of the elements                               */
    model_block *block;
    bbm_material *material;
    model_set *set;
    model_copy *copy;
    model_table node_of, element_of, block_of, material_of, set_of, monitor_of;
    int other_material;                     /* of `use MATERIAL on *`, or -1                                    */
    int *chosen_node;                       /* [chosen]     what the last WHERE names                           */
    double low[2], high[2], margin;         /* m            the model's box; lengths below the margin are none  */
    const model_statement *s;               /* in hand, and its next word                                       */
    int next;
    model_place seen[32];                   /* where a statement that makes sense once stands                   */
} model_reader;

int   model_fail(model_reader *r, model_place at, const char *format, ...);    /* 0; the first message stays        */
char *model_load(model_reader *r, const char *path, model_place at, size_t *size);     /* with a 0 behind; or NULL  */
int   model_grow(model_reader *r, void *array, int count, size_t size);        /* room for one more; 0: no memory   */
int   model_find(const model_table *t, const char *key);                        /* -1: not there                     */
int   model_enter(model_reader *r, model_table *t, const char *key, int value); /* 1; 0: no memory                   */
int   model_is_name(const char *word);
int   model_add_node(model_reader *r, const model_node *n);
int   model_add_element(model_reader *r, const model_element *e, const int corner[]);
int   model_find_block(model_reader *r, const char *name, model_place at);      /* a new one if need be; -1          */
int   model_find_set(model_reader *r, const char *name);
int   model_add_to_set(model_reader *r, int set, int node);
int   model_read_mesh(model_reader *r, const char *path, model_place at);       /* in msh.c                          */

#endif
