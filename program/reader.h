/* reader.h - what the readers of model files share: statements.c, numbers.c, build.c, msh.c.
 *
 * Reading has four steps: the file is cut into statements and words; numbers take the place of
 * their names, and what is repeated is written out; the statements are carried out in an order in
 * which each finds what it needs; the first error ends it all with one sentence, FILE:LINE: what
 * is wrong, and what was expected. msh.c does the same for mesh files and puts nodes, elements and
 * sets in the same reader.
 *
 * Words are never copied: names and ids point into texts that are kept until model_free.
 */
#ifndef READER_H
#define READER_H

#include "model.h"

/* line 0: none is to blame; round: "i = 7", of what is repeated, or NULL. */
typedef struct { const char *file; int line; const char *round; } model_place;
typedef struct { const char *key; int value; } model_slot;     /* key: NULL, empty */
/* From a word to a number; what such a word names, for messages. */
typedef struct { const char *what; int room, count; model_slot *slot; } model_table;

typedef struct {                /* words first .. first+n-1 */
    model_place at;
    int first, n, kind, stage;  /* kind: its row in the table of statements.c; stage: 0, of none */
    const char *name, *form;    /* its first word; what it looks like, for messages */
} model_statement;

/* A word with the values of its numbers, and as the file has it; glued: of several pieces, no
 * number. */
typedef struct { char *text, *source; int glued; } model_given;
/* A number of a round; counts: it is that of `repeat`. */
typedef struct { const char *name, *value; int counts; } model_local;

typedef struct {
    const char *id;
    double x, y, z;             /* z: of a mesh, which has the same everywhere */
    model_place at;
    int by_hand, first;         /* first copy, or -1 */
} model_node;

typedef struct {                /* corner[first .. first+n-1] */
    const char *id;
    model_place at;
    int block, material, first, n;
} model_element;

typedef struct {
    const char *name;
    model_place at;
    int material, meshed, fixed, stressed;      /* material: by `use`, or -1 */
} model_block;

typedef struct { model_place at; int block[2]; } model_bond;    /* of two blocks */

/* dimensions: bits, of groups of points, curves, surfaces of a mesh, and of a curve in none. A copy
 * is that of a node for a block: its library node, and the next copy, or -1. */
typedef struct { int n, *node, dimensions; } model_set;
typedef struct { int node, block, next; } model_copy;
typedef struct { double along; int node; } model_order;

typedef struct {
    model *p;
    model_place whole;                      /* the model file, none of its lines */
    int lets, words, statements, nodes, elements, corners, blocks, materials, sets, copies;
    char *const *let;                       /* [lets]       NAME=VALUE of the command line */
    int cuts, cut_words, depth, repeated, removed, stage, tail;     /* tail: behind a `repeat` */
    int locals, own;                        /* own: those before the round */
    model_statement *cut;                   /* [cuts]       as the file has them, and their words */
    char **cut_word;                        /* [cut_words]  */
    model_local *local;                     /* [locals]     of the round in hand */
    const char *round;
    double grown;                           /* bytes of the values of numbers */
    model_given *word;                      /* [words] */
    model_statement *statement;             /* [statements] */
    model_node *node;
    model_order *order;                     /* [nodes] */
    model_element *element;
    int *corner;                            /* [corners]    nodes of the elements */
    model_block *block;
    bbm_material *material;
    model_set *set;
    model_copy *copy;
    int bonds, bonding;                     /* bonding: whether `bond` has its options */
    model_bond *bond;                       /* [bonds] */
    model_table node_of, element_of, block_of, material_of, set_of, monitor_of, let_of, stage_of,
                joint_of;                   /* of the numbers of blocks: "1 -1" */
    long long last_node, last_element;      /* the largest ids */
    model_block any;                        /* `*`: the blocks without their own */
    int plane_strain, no_shear;             /* no_shear: ks is 0 */
    int chosen, file_nodes, *chosen_node;   /* what the last WHERE names: library nodes, of so */
    int wheres, *named;                     /* many nodes of the file; how many there were; and */
                                            /* [nodes] the last one that named a library node */
    double margin;                          /* m            lengths below it are none */
    const model_statement *light;           /* of a material that weighs next to nothing */
    const model_statement *s;               /* in hand, and its next word; how many of those */
    int next, ahead;                        /* before it are not in its form */
} model_reader;

/* --- errors, memory, tables --- */
/* They return 0; the first message stays. model_blame: at the statement in hand. */
int   model_fail(model_reader *r, model_place at, const char *format, ...);
#define model_blame(r, ...) model_fail(r, (r)->s->at, __VA_ARGS__)
int   model_add_note(model_reader *r, const char *what);        /* what is no error, of it */
#define model_note(r, ...) model_add_note(r, model_print(r, __VA_ARGS__))
int   model_out_of_memory(model_reader *r);
int   model_refused(model_reader *r, bbm_status status);        /* what the library says */
void  model_clean(char *text);                          /* of what a terminal would obey */
const char *model_hint(const char *word);               /* what it may mean; or "" */
/* One more item at the end of an array of `count`; 0: no memory. */
int   model_add(model_reader *r, void *array, int *count, size_t size, const void *item);
void *model_keep(model_reader *r, int n, size_t size);          /* zeros, and one more; or NULL */
char *model_print(model_reader *r, const char *format, ...);    /* as by printf; or NULL */
/* A file that the statement in hand names, with a 0 behind it; or NULL. */
char *model_load(model_reader *r, const char *path, size_t *size);
int   model_find(const model_table *t, const char *key);        /* -1: not there */
int   model_enter(model_reader *r, model_table *t, const char *key, int value);
/* Where the word stands in the text, between blanks, [ ] and |; or NULL. */
const char *model_find_word(const char *text, const char *word);
/* The nearest ones to a word among n, `stride` bytes from name to name, of which the first word
 * counts, NULL: none; with at most `most` letters that differ; as text. */
const char *model_nearest(model_reader *r, const char *word, const void *names, int n,
                          size_t stride, int most);
const char *model_nearest_of(model_reader *r, const model_table *t, const char *word);

/* --- words of the statement in hand --- */
char *model_look(const model_reader *r);           /* the word that comes next, it stays; or NULL */
char *model_word(model_reader *r);
int   model_skip(model_reader *r, const char *word);     /* takes the next word if it is this one */
int   model_keyword(model_reader *r, const char *word);        /* this one must come next */
int   model_at_end(model_reader *r);
int   model_number(model_reader *r, double *x);
int   model_numbers(model_reader *r, int n, double x[]);
int   model_whole(model_reader *r, const char *what, int least, int *n);
const char *model_name(model_reader *r);
const char *model_id(model_reader *r);
int   model_known(model_reader *r, const model_table *t);   /* the next word's number, or -1 */
int   model_block_or_all(model_reader *r);                  /* the same of a block; `*`: -1 */
int   model_is_new(model_reader *r, model_place at, const model_table *t, const char *word);
const char *model_new_name(model_reader *r, const model_table *t);
int   model_note_friction(model_reader *r, double friction);    /* of less than a degree */
int   model_choice(model_reader *r, const char *choices, int *n);

/* `word value`, in any order, each once. One of: a number (low to high, with the rims of `rim`), a
 * whole number, a choice (its place in the list), a flag without a value, or with the number x
 * behind it where `by` follows. */
typedef struct {
    const char *name;
    double *x, low, high;
    const char *rim, *expected;     /* rim: [] both in, () both out, and so on */
    int    *n, least;
    const char *choices;            /* "a|b|c" */
    int    *flag;
    int    seen;
} model_option;

/* So many of the first ones are needed. */
int   model_options(model_reader *r, int needed, int n, model_option o[]);

#define RANGE(text, where, from, to, rims, words) \
    { .name = text, .x = where, .low = from, .high = to, .rim = rims, .expected = words }
#define ABOVE_ZERO(text, where) RANGE(text, where, 0, INFINITY, "()", "more than 0")
#define NORMAL(text, where) \
    RANGE(text, where, 1e-100, 1e100, "[]", "more than 0, from 1e-100 to 1e100")
#define FROM_ZERO(text, where) RANGE(text, where, 0, INFINITY, "[)", "0 or more")
#define NUMBER(text, where) RANGE(text, where, -INFINITY, INFINITY, "()", "a number")
#define ANGLE(text, where) RANGE(text, where, 0, 90, "[)", "0 to less than 90 degrees")
#define COUNT(t_text, t_where, t_least) { .name = t_text, .n = t_where, .least = t_least }
#define CHOICE(text, where, list) { .name = text, .n = where, .choices = list }
/* The letters of a name. */
#define MODEL_NAME "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-."

/* --- nodes, elements, blocks and sets --- */
int   model_add_node(model_reader *r, const model_node *n);
/* Its corners are the e->n last of r->corner, added before. */
int   model_add_corner(model_reader *r, int node);
int   model_add_element(model_reader *r, const model_element *e);
/* A new one if need be; -1: no memory. */
int   model_find_block(model_reader *r, const char *name);
int   model_find_set(model_reader *r, const char *name);
int   model_add_to_set(model_reader *r, int set, int node);
/* msh.c: Gmsh's mesh files; by_surface: each surface of Gmsh is a block. */
int   model_read_mesh(model_reader *r, const char *path, int by_surface);

/* numbers.c: the statements as the file has them become those that count. */
int   model_expand(model_reader *r);

/* --- hooked.c: what takes part in the library's step by hooks --- */
int   model_read_record(model_reader *r, const char *path);     /* of the base's acceleration */
int   model_hook(model_reader *r);

/* --- stage.c --- */
void  model_keep_stage(model_reader *r, int k);         /* stage k begins with what holds now */

/* --- build.c: the library's model --- */
int   model_build(model_reader *r);
int   model_finish(model_reader *r);

/* --- build.c, stage.c: what a statement does --- */
/* It takes its words one by one and returns 1, or 0 after model_fail. What is left of them is
 * surplus. */
typedef int model_action(model_reader *r);
model_action model_fix, model_load_nodes, model_edge_load, model_joint,
             model_velocities, model_stress, model_bodyforce, model_monitors, model_bolts,
             model_pins, model_stage_head;

#endif
