/* sweep.c - which boxes meet, in few comparisons: those around edges, or around elements.
 *
 * Beyond the paper, which compares all with all. Around each boundary edge lies a box, widened by
 * the search distance. The boxes are sorted by where they begin along an axis; a sweep along it
 * meets for each box those that begin before it ends, and only these can have a corner in it. A
 * wall of n bricks has about sqrt(n) of them in each column, which cost less than its equations by
 * far; a long edge under many blocks costs one comparison for each.
 *
 * The axis slants, x + y/4: a column, a row and a wall are spread out along it alike. Where the
 * boxes are less than half as long along x or y, against all that they lie in, that is the axis:
 * thin cells side by side, or what is piled up along a line that falls by four to one.
 */
#include "beyond.h"

enum { AXIS, X, Y };            /* coordinates: along the axis of the sweep, and the usual ones */

/* Begins the box of an edge or element: it has no point. */
bbm_box bbm_empty_box(int of)
{
    return (bbm_box){ { INFINITY, INFINITY, INFINITY }, { -INFINITY, -INFINITY, -INFINITY }, of };
}

/* Widens a box, so that all that is no further from (x, y) than `wide` lies in it. Where a model
 * has blown up, a place that is no number lies in none. */
void bbm_widen_box(bbm_box *b, double x, double y, double wide)
{
    const double at[3] = { x + y / 4, x, y };

    for (int k = 0; k < 3; k++) {
        const double half = k == AXIS ? 1.25 * wide : wide;
        b->low[k] = fmin(b->low[k], at[k] - half);
        b->high[k] = fmax(b->high[k], at[k] + half);
    }
}

static int compare_boxes(const void *p, const void *q)
{
    const double a = ((const bbm_box *)p)->low[AXIS], b = ((const bbm_box *)q)->low[AXIS];

    return (a > b) - (a < b);
}

/* How many boxes lie at a place along a coordinate, in the mean. */
static double pile(int n, const bbm_box *b, int along)
{
    double low = INFINITY, high = -INFINITY, sum = 0;

    for (int k = 0; k < n; k++) {
        low = fmin(low, b[k].low[along]);
        high = fmax(high, b[k].high[along]);
        sum += b[k].high[along] - b[k].low[along];
    }
    return sum / (high - low);
}

void bbm_sort_boxes(int n, bbm_box *b)
{
    const double x = pile(n, b, X), y = pile(n, b, Y);
    const int axis = 2 * fmin(x, y) >= pile(n, b, AXIS) ? AXIS : x < y ? X : Y;

    for (int k = 0; k < n; k++) {
        b[k].low[AXIS] = b[k].low[axis];
        b[k].high[AXIS] = b[k].high[axis];
    }
    qsort(b, (size_t)n, sizeof *b, compare_boxes);
}

/* The next two sorted boxes that meet, after i and j, which begin as 0; 0: there are no more. */
int bbm_next_meeting(int n, const bbm_box *b, int *i, int *j)
{
    for (; *i < n; *j = ++*i)
        while (++*j < n && b[*j].low[AXIS] <= b[*i].high[AXIS])
            if (b[*j].low[Y] <= b[*i].high[Y] && b[*j].high[Y] >= b[*i].low[Y]
                && b[*j].low[X] <= b[*i].high[X] && b[*j].high[X] >= b[*i].low[X])
                return 1;
    return 0;
}

/* Adds the corner of each box with the edge of another block's box in which it lies, and notes one
 * that has passed. */
bbm_status bbm_find_near_pairs(bbm_model *m, double search)
{
    bbm_box *b = malloc(((size_t)m->edges + 1) * sizeof *b);
    bbm_status status = b ? BBM_OK : BBM_NO_MEMORY;

    for (int e = 0; e < m->edges && !status; e++) {
        const bbm_point P = bbm_point_at(m, m->edge[e].a), Q = bbm_point_at(m, m->edge[e].b);
        b[e] = bbm_empty_box(e);
        bbm_widen_box(&b[e], P.x, P.y, search + bbm_rounding(m, e));
        bbm_widen_box(&b[e], Q.x, Q.y, search + bbm_rounding(m, m->edge[e].after));
    }
    if (!status)
        bbm_sort_boxes(m->edges, b);
    for (int i = 0, j = 0; !status && bbm_next_meeting(m->edges, b, &i, &j);)
        for (int k = 0; k < 2 && !status; k++) {
            const bbm_box *e = &b[k ? i : j];
            const int corner = b[k ? j : i].of;
            const bbm_point P = bbm_point_at(m, m->edge[corner].a);
            if (m->edge[e->of].first == m->edge[corner].first || P.x < e->low[X]
                || P.x > e->high[X] || P.y < e->low[Y] || P.y > e->high[Y])
                continue;
            if (bbm_depth_passed(m, corner, e->of) > 0) {
                m->beyond->passed[0] = corner;
                m->beyond->passed[1] = e->of;
            }
            status = bbm_add_pair(m, corner, e->of);
        }
    free(b);
    return status;
}
