/* sweep.c - which corners and edges are near each other, in few comparisons.
 *
 * Beyond the paper, which compares all with all. Around each boundary edge lies a box, widened by
 * the search distance. The boxes are sorted by where they begin along an axis; a sweep along it
 * meets for each box those that begin before it ends, and only these can have a corner in it. A
 * wall of n bricks has about sqrt(n) of them in each column, which cost less than its equations by
 * far; a long edge under many blocks costs one comparison for each.
 *
 * The axis slants, x + y/4: a column, a row and a wall are spread out along it alike. Only what is
 * piled up along a line that falls by four to one is not, and is found all the same.
 */
#include <float.h>
#include <stdlib.h>

#include "beyond.h"

enum { AXIS, X, Y };            /* coordinates: along the axis of the sweep, and the usual ones */

typedef struct {                /* around an edge; `at` is its corner           */
    double low[3], high[3], at[3];      /* m                                    */
    int edge;
} box;

static int compare_boxes(const void *p, const void *q)
{
    const double a = ((const box *)p)->low[AXIS], b = ((const box *)q)->low[AXIS];

    return (a > b) - (a < b);
}

/* Where a model has blown up, a place that is no number is far away. */
static box box_of(const bbm_model *m, int edge, double search)
{
    const bbm_vertex *a = &m->vertex[m->edge[edge].a], *b = &m->vertex[m->edge[edge].b];
    box around = { .edge = edge, .at = { a->x + a->y / 4, a->x, a->y } };
    const double end[3] = { b->x + b->y / 4, b->x, b->y };

    for (int k = 0; k < 3; k++) {
        const double wide = k == AXIS ? 1.25 * search : search;
        around.low[k] = fmax(-DBL_MAX, fmin(around.at[k], end[k]) - wide);
        around.high[k] = fmin(DBL_MAX, fmax(around.at[k], end[k]) + wide);
    }
    return around;
}

/* The corner of one box and the edge of another, if it lies in it. */
static bbm_status compare(bbm_model *m, const box *c, const box *e)
{
    for (int k = X; k <= Y; k++)
        if (c->at[k] < e->low[k] || c->at[k] > e->high[k])
            return BBM_OK;
    if (bbm_depth_passed(m, c->edge, e->edge) > 0) {
        m->beyond->passed[0] = c->edge;
        m->beyond->passed[1] = e->edge;
    }
    return bbm_add_pair(m, c->edge, e->edge);
}

bbm_status bbm_sweep(bbm_model *m, double search)
{
    box *b = malloc(((size_t)m->edges + 1) * sizeof *b);
    bbm_status status = b ? BBM_OK : BBM_NO_MEMORY;

    m->beyond->passed[0] = -1;
    for (int e = 0; e < m->edges && !status; e++)
        b[e] = box_of(m, e, search);
    if (!status)
        qsort(b, (size_t)m->edges, sizeof *b, compare_boxes);
    for (int i = 0; i < m->edges && !status; i++)
        for (int j = i + 1; j < m->edges && !status && b[j].low[AXIS] <= b[i].high[AXIS]; j++)
            if (b[j].low[Y] <= b[i].high[Y] && b[j].high[Y] >= b[i].low[Y]) {
                status = compare(m, &b[i], &b[j]);
                if (!status)
                    status = compare(m, &b[j], &b[i]);
            }
    free(b);
    return status;
}
