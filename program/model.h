/* model.h - a problem read from a model file: ten lines of text, or a mesh from Gmsh, in place of
 * a program.
 *
 * It has the prepared library model and what the library does not keep: names, pictures wanted,
 * monitors. A node of the file that several blocks share becomes a node of each of them,
 * for blocks are never bonded and each has its own results there. These copies are the nodes of
 * the library's model, in the order of the file.
 */
#ifndef MODEL_H
#define MODEL_H

#include <stdio.h>

#include "../beyond/beyond.h"
#include "field.h"
#include "scene.h"

enum { MODEL_FOLLOWED = 4 };    /* numbers that a monitor has at most */

/* What a monitor follows. kinds: what may be expected of it, the names of its values first;
 * expected: what a picture calls these kinds. */
typedef struct {
    const char *what, *unit, *kinds, *name[MODEL_FOLLOWED + 1], *expected[MODEL_FOLLOWED];
    int values;
} model_followed;

typedef struct {                /* of library nodes, of the joint of two blocks, -1: any, or of */
                                /* the bolt block[0] */
    const char *name;
    const model_followed *of;
    int nodes, *node, block[2], touched;        /* touched: whether the joint ever had a force */
} model_monitor;

typedef struct { double V[3]; int given; } model_velocity;                  /* m/s, m/s, rad/s */
typedef struct { int monitor, kind; double value, within; } model_expected;     /* at the end */

typedef struct { double t, a[2]; } model_shaking;     /* s, m/s^2: of the base, a row of a record */

typedef struct {                /* what holds from a stage on; the first is the run before them */
    const char *name;
    bbm_parameters par;         /* steps: the last of the stage */
    double cohesion, tension;
    int edge_loads;
    bbm_node *node;             /* [nodes]      held, load; wall: how far it is moved in the */
} model_stage;                  /*              stage, and once that has begun, to where */

/* What stands before each array; link: what points here. All stay until model_free. */
typedef struct model_kept { struct model_kept *next, **link; double array[]; } model_kept;

enum { MODEL_MOVES = 2, MODEL_STAYS };                  /* kinds of what is expected of nodes */

typedef struct {
    bbm_model *m;
    char  *title;               /* or NULL */
    int    dynamic, settle;     /* quasi-static steps before t = 0 */
    int    every, vtk, svg, balance;    /* every: 0, the end only */
    int    film;                /* whether it has the colours of the field, too */
    const char *field;          /* of the picture, a name of field.h */
    double colours[2];          /* their range; zeros: that of the field */
    double scale;               /* by which it enlarges displacements; 0: as the picture chooses */
    int    slippery;            /* several blocks, which may touch, and no friction given */
    int    blocks, monitors;
    const char **block;         /* [blocks]     names */
    const char **node;          /* [m->nodes]   ids */
    int   *node_block;          /* [m->nodes]   the first one of several that are bonded */
    int   *body;                /* [blocks]     the same of blocks that are bonded */
    const char **element;       /* [m->elements] ids */
    double (*centre)[2];        /* [m->elements] m, barycentres at the start */
    model_velocity *velocity;   /* [blocks]     initial */
    model_monitor *monitor;     /* [monitors] */
    int    expectations;
    model_expected *expected;   /* [expectations] value and within: m */
    int    moving;              /* supports: whether any moves */
    double ramp;                /* s            in which; 0: at once; INFINITY: in all steps */
    int    stages, now, begun;  /* behind the first run; the one in hand, 0: none, and its start */
    model_stage *stage;         /* [stages+1] */
    int   *gone;                /* [blocks]     the stage that removes it; 0: none */
    int    shakings;            /* rows of a record of the base's acceleration */
    model_shaking *shaking;     /* [shakings]   between them it is linear, outside it is 0 */
    double shake;               /* its scale */
    int    bolts;
    scene_bolt *bolt;           /* [bolts]      vertices of the library's model */
    int    parts;
    scene_bolt *part;           /* [parts]      of bolts, from element to element */
    model_kept *kept;           /* all that is allocated for the file: arrays, and the texts of
                                                which names and ids are words */
    int    inputs;
    const char **input;         /* [inputs]     the files that were read */
    int    notes;
    const char **note;          /* [notes]      what is allowed and hardly meant, FILE:LINE: ... */
    int    status;              /* 0, 1: failed, 2: the input is wrong */
    char   message[600];
} model;

/* statements.c: reads and checks all; returns the status. `path` may be -, which is stdin. let:
 * `NAME=VALUE` in place of what the file says, [lets]. model_free releases a model that failed,
 * too. */
int  model_read(const char *path, int lets, char *const let[], model *p);
/* The library's last error, or the status, in the words of the file; out: with what it returns. */
const char *model_says(const model *p, bbm_status status, char out[400]);
/* How far the start of a boundary edge is from another edge, m. */
double model_distance(const bbm_model *m, int corner, int edge);
#define MODEL_TOUCH 1e-6        /* of the size of what is near: what is nearer touches it */
/* Whether a corner of a block lies on a side of it without being its end, so that neither a bond
 * nor a contact is there; the first one as text. */
int  model_touches_itself(const model *p, char out[300]);
int  model_start(model *p);     /* sets the initial velocities; 0: no memory */
void model_next_stage(model *p);        /* stage.c: begins it, from where the run is */
extern const model_followed model_displacement, model_force, model_support, model_pull;
/* u, v of nodes; of a joint normal, shear, and fx, fy of its second block on the first; fx, fy of
 * the supports on nodes; the pull of a bolt; and 0. */
void model_follow(const model *p, model_monitor *m, double x[MODEL_FOLLOWED]);
/* hooked.c: what makes a bolt as long as it is, N, and its direction, from the second end to the
 * first. */
double model_bolt_force(const bbm_model *m, const scene_bolt *b, bbm_direction *along);
void model_free(model *p);

#endif
