/* scene.h - pictures of blocks: one state, a film; contours of a field.
 *
 * A scene is a recording. The choices are set first, one call per step records, one call writes;
 * the first frame is the start, the last one the end of the run. However long the run is, at most
 * 64 frames stay: whenever they are full, every second one is given up.
 *
 *     scene s = { .title = "Block on an incline" };
 *     scene_record(&s, m);
 *     for (int i = 0; i < steps; i++) {
 *         case_must(m, bbm_step(m));
 *         scene_record(&s, m);
 *     }
 *     if (!scene_write_movie(&s, m, "out/incline/slide.svg")) ...
 *     scene_free(&s);
 *
 * The film is one SVG that a browser plays over and over, a click stops it, the arrow keys step, a
 * bar shows and chooses the time; a viewer that cannot play shows the first frame. Supports, loads
 * and contact forces are drawn, these not where a field is.
 */
#ifndef SCENE_H
#define SCENE_H

#include "../base/base.h"

typedef struct {                /* of a closed contact                                            */
    bbm_point at, force;        /* m, N     of the corner; on its block                           */
    double N;                   /* N        normal                                                */
    int    kind, block[2];      /* of its arrow; the corner's and the edge's                      */
} scene_force;

enum { SCENE_MOVED = 4, SCENE_GONE = 8 };       /* a support not where it began; no block there   */

/* Of a vertex: where it is [m]; the load of its node [N]; the value of the field, NaN: its block is
 * gone; BBM_X + BBM_Y and SCENE_MOVED, or SCENE_GONE. */
typedef struct { bbm_point at, load; double value; int held; } scene_vertex;

typedef struct {                /* what was recorded at one time                                  */
    double time;                /* s                                                              */
    int    call;                /* of scene_record, from 0                                        */
    int    forces, lines;       /* lines: loads of edges                                          */
    int    edges;               /* of the boundary: further ones open in a crack, later           */
    scene_vertex *vertex;       /*          [vertices]                                            */
    scene_force *force;         /*          [forces]                                              */
} scene_frame;

typedef struct {                /* a point of an element: the sum of share times vertex           */
    int    block, element, vertex[3];
    double share[3];
} scene_end;

typedef struct {                /* a spring along the line between two points, by hooked.c        */
    scene_end end[2];
    double k, rest, strength, until;    /* N/m, m, N, 0: removed; s: when it broke, or INFINITY   */
    double pull, force[2];              /* N        what it carries; of the solution              */
    double way[2];                      /* m        from end to end, at the start of a step       */
    int swings;                         /*          by a good part of that in a static step       */
    int of;                             /*          of a part: its bolt, and k its share          */
} scene_bolt;

typedef struct {
    /* --- choices: what is left out (zero) is chosen by the writer --- */
    const char *title;
    int    bolts;
    const scene_bolt *bolt;     /*          [bolts]                                               */
    double scale;               /* -        of the displacements. 0: of a film, as they are; of a */
                                /*          map, the largest is about a tenth of the model, and   */
                                /*          less where an element or an edge would change too     */
                                /*          much. < 0: a map does not show them                   */
    const char *field;          /* a name of field.h; NULL: a film in tints                       */
    double limits[2];           /* of its colours; zeros: those of all values but the outermost   */
    /* --- the recording --- */
    int    frames, calls, every, failed;
    scene_frame *frame;         /*          [frames]; every-th call, and the last one             */
} scene;

/* Records the present positions, contact forces and time, if the positions are finite. Without
 * memory the scene cannot be written. */
void scene_record(scene *s, const bbm_model *m);
void scene_free(scene *s);      /* the recording; the choices stay                                */

/* They return 1 when the complete file stands under its name, else 0 and errno. Nothing recorded is
 * nothing to write. Of one frame the film is a picture that stands still. */
int  scene_write_movie(const scene *s, const bbm_model *m, const char *path);

/* The present state, which need not be recorded, with contours of the field, or with crosses. */
int  scene_write_map(const scene *s, const bbm_model *m, const char *path);

/* A load along an edge from vertex a to b: a force [N/m], or those at the Gauss points, and a
 * pressure; of water, which has weight [N/m^2], those at the Gauss points are all of it. */
typedef struct {
    int a, b, loads;
    const double (*q)[2];
    double pressure, level, weight;
} scene_line;

/* edge_load.c: load k of those that are given for an edge; 0: there are no more. */
int scene_edge_load(const bbm_model *m, int k, scene_line *l);
int scene_is_cracked(const bbm_model *m);           /* edge_load.c: bonds have broken            */

#endif
