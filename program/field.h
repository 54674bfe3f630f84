/* field.h - the quantities that tables and pictures show, by name: a row each in the table of
 * field.c. A new row, and its value there, is a column of the files that it names, and what
 * `output field NAME` draws. */
#ifndef FIELD_H
#define FIELD_H

#include "../base/base.h"

enum {                          /* where a field is written, as bits                            */
    FIELD_NODES = 1,            /* nodes.csv                                                    */
    FIELD_ELEMENTS = 2,         /* elements.csv                                                 */
    FIELD_MOVING = 4,           /* elements.csv in dynamics                                     */
    FIELD_CELLS = 8             /* the cells of step_*.vtk                                      */
};

#define FIELD_PRINCIPAL "principal"     /* drawn as crosses                                     */

typedef struct {
    const char *name, *label, *unit;    /* label: in a picture                                  */
    int files;
} field;

enum { FIELD_ROWS = 16 };
extern const field field_table[];       /* [FIELD_ROWS], and one without a name                 */

/* Whether a stage has removed the block of vertex v, by the mark that stage.c gives its elements.
 * No other one has it: szz is more than -1 times sx + sy. */
#define FIELD_GONE (-1)
static inline int field_is_gone(const bbm_model *m, int v)
{
    return m->element[m->vertex[v].element].out_of_plane == FIELD_GONE;
}

/* x (axis 0) or y of where vertex v is drawn, m; those of a block that is gone in one point, where
 * it began. */
double field_place(const bbm_model *m, int v, int axis);
const field *field_find(const char *name);                      /* NULL: there is none          */
double field_of_element(const field *f, const bbm_model *m, int element);
/* That of the mean displacement, stress and motion of the elements of a block that meet there. */
double field_of_node(const field *f, const bbm_model *m, int node, int block);    /* -1: all */
/* All values of the table; `fits`: with the plane fit, which takes time; else stress for it. */
void   field_all_of_node(const bbm_model *m, int node, int block, int fits, double all[FIELD_ROWS]);

/* The normal (0) and the shear force (1) of a contact that acted in the last step, N: of its
 * springs or friction, and what a jump of velocities adds. */
static inline double field_acts(const bbm_contact *c, int shear)
{
    return (shear ? c->T : c->N) + c->trial.jump[shear];
}

/* The force of a contact that carries N and T on the corner's block, as a vector. */
void field_contact_force(const bbm_model *m, const bbm_contact *c, double N, double T, double f[2]);

#endif
