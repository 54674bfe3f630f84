/* mechanism.c - quadrilaterals bonded at the middles of their sides alone, that can turn against each other.
 *
 * A grid of rectangles bonded so has a motion that costs nothing: neighbours turn in opposite senses, like a chequerboard
 * of gears, about the middles of their common sides (doc/limits.md, section 2). The equations are then singular, or what
 * holds the motion has nothing to do with the body's stiffness, and the displacements are wrong without a word.
 *
 * Rigid elements tell it, since what strains an element costs energy in any case. Let each have three unknowns, two
 * displacements and a rotation; let E be the energy of unit springs where bonds and fixed points hold middles and
 * vertices, and R what springs at both ends of the bonded sides would have more, for the turning against each other. A
 * mechanism has E = 0 and R > 0. A body that moves as a whole has E = R = 0, and in bending E is as large as R, however
 * long the body is. The softest sound motion is a chequerboard that fades along a body of n elements to a clamped end:
 * E = 0.15 R/n^2, measured. What is held more softly than that is refused with the mechanisms, for a grid whose nodes
 * are off by a hundredth is no better than a perfect one.
 *
 *     E - HELD R/n^2 + TINY |D|^2
 *
 * is positive for all motions but these, and has as many negative pivots as there are of them (Sylvester). An LDL^T
 * factorisation shows the first. Of that only a window as wide as the band is kept: elements are sorted along the body,
 * block by block.
 */
#include "beyond.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* HELD [-]: of E n^2/R, between 0.15 of a clamped end and 0.07 of two pins, which hold a chequerboard at one node each.
 * TINY [-]: keeps the pivots of free bodies above their rounding, 1e-16 times the number of elements. */
#define HELD 0.1
#define TINY 1e-10

typedef struct { int block, element; double x; } place;         /* to sort by                                   */
typedef struct { int low, bond; } bond_place;                   /* a bond, and the lower place of its elements  */

typedef struct {
    int band;                   /* places of the elements of a bond are closer than this                        */
    int *place;                 /* [elements]                                                                   */
    int *element;               /* [elements] at a place                                                        */
    double *held;               /* [elements] HELD/n^2, n^2 = reach of the block^2/area of the element          */
    bond_place *bond;           /* [bonds] sorted                                                               */
    double *row;                /* [3 band * 3 band] row r of the matrix from its diagonal on, at r % (3 band)  */
} window;

/* ------------------------------------------------------------------------------------------------ conditions */

/* Adds w a b^T to the submatrix of two places, the first of them not after the second. */
static void add_product(window *w, int i, int j, const double a[3], const double b[3], double weight)
{
    const int n = 3 * w->band;

    for (int p = 0; p < 3; p++)
        for (int q = i == j ? p : 0; q < 3; q++)
            w->row[(size_t)((3 * i + p) % n) * (size_t)n + (size_t)(3 * (j - i) + q - p)] += weight * a[p] * b[q];
}

/* A spring between the motions a.D_i and b.D_j. */
static void add_spring(window *w, int i, const double a[3], int j, const double b[3], double weight)
{
    const double minus[3] = { -b[0], -b[1], -b[2] };

    add_product(w, w->place[i], w->place[i], a, a, weight);
    add_product(w, w->place[j], w->place[j], b, b, weight);
    if (w->place[i] < w->place[j])
        add_product(w, w->place[i], w->place[j], a, minus, weight);
    else
        add_product(w, w->place[j], w->place[i], minus, a, weight);
}

/* How the middle of two vertices of an element moves along x (0) or y (1). The rotation is measured in the size of the
 * element, so that all unknowns are lengths. */
static void middle_motion(const bbm_model *m, const bbm_element *e, int v, int next, int along, double a[3])
{
    const double x = (m->vertex[v].x + m->vertex[next].x) / 2 - e->x, y = (m->vertex[v].y + m->vertex[next].y) / 2 - e->y;

    a[0] = along == 0;
    a[1] = along == 1;
    a[2] = (along == 0 ? -y : x) / sqrt(e->A0);
}

/* Middles, or vertices, of a bonded side stay together; what its ends would add counts against it. */
static void add_bond(const bbm_model *m, window *w, const bbm_bond *b)
{
    const bbm_element *i = &m->element[b->i], *j = &m->element[b->j];
    const int middle = i->n == 4 && j->n == 4;
    double a[3], c[3];

    for (int k = 0; k < 4; k++) {
        const int end = k / 2, other = middle ? 1 - end : end;
        middle_motion(m, i, b->p[end], b->p[other], k % 2, a);
        middle_motion(m, j, b->q[end], b->q[other], k % 2, c);
        add_spring(w, b->i, a, b->j, c, 1);
    }
    if (middle) {
        const bbm_vertex *p = &m->vertex[b->p[0]], *q = &m->vertex[b->p[1]];
        const double l = hypot(q->x - p->x, q->y - p->y);
        const double turn_i[3] = { 0, 0, l / sqrt(i->A0) }, turn_j[3] = { 0, 0, l / sqrt(j->A0) };
        add_spring(w, b->i, turn_i, b->j, turn_j, -(w->held[b->i] + w->held[b->j]) / 4);
    }
}

/* The fixed points of an element, those of a quadrilateral's side with both ends held in the middle of it. */
static void add_fixed_points(const bbm_model *m, window *w, int number)
{
    const bbm_element *e = &m->element[number];
    const int i = w->place[number];
    double a[3];

    for (int k = 0; k < 2 * e->n; k++) {
        const int v = e->first + k / 2, next = e->first + (k / 2 + 1) % e->n, last = e->first + (k / 2 + e->n - 1) % e->n;
        const int bit = k % 2 ? BBM_Y : BBM_X, here = m->node[m->vertex[v].node].held & bit;
        const int side = e->n == 4 && (m->node[m->vertex[next].node].held & bit);
        const int side_before = e->n == 4 && (m->node[m->vertex[last].node].held & bit);
        if (!here || (side_before && !side))
            continue;
        middle_motion(m, e, v, side ? next : v, k % 2, a);
        add_product(w, i, i, a, a, 1);
    }
}

/* --------------------------------------------------------------------------------------------- elimination */

static int compare_places(const void *p, const void *q)
{
    const place *a = p, *b = q;

    if (a->block != b->block)
        return a->block > b->block ? 1 : -1;
    if (a->x != b->x)
        return a->x > b->x ? 1 : -1;
    return a->element > b->element ? 1 : -1;
}

static int compare_bonds(const void *p, const void *q)
{
    const bond_place *a = p, *b = q;

    if (a->low != b->low)
        return a->low > b->low ? 1 : -1;
    return a->bond > b->bond ? 1 : -1;
}

/* Sorts the elements along the longer side of the model, block by block, and the bonds by their place. */
static void sort_elements(const bbm_model *m, window *w, place *p)
{
    double low[2] = { INFINITY, INFINITY }, high[2] = { -INFINITY, -INFINITY };

    for (int e = 0; e < m->elements; e++) {
        low[0] = fmin(low[0], m->element[e].x), low[1] = fmin(low[1], m->element[e].y);
        high[0] = fmax(high[0], m->element[e].x), high[1] = fmax(high[1], m->element[e].y);
    }
    for (int e = 0; e < m->elements; e++) {
        const bbm_element *i = &m->element[e];
        p[e] = (place){ i->block, e, high[1] - low[1] > high[0] - low[0] ? i->y : i->x };
    }
    qsort(p, (size_t)m->elements, sizeof *p, compare_places);
    for (int k = 0; k < m->elements; k++) {
        w->element[k] = p[k].element;
        w->place[p[k].element] = k;
    }
    w->band = 1;
    for (int b = 0; b < m->bonds; b++) {
        const int i = w->place[m->bond[b].i], j = w->place[m->bond[b].j], far = abs(i - j) + 1;
        w->bond[b] = (bond_place){ i < j ? i : j, b };
        w->band = far > w->band ? far : w->band;
    }
    qsort(w->bond, (size_t)m->bonds, sizeof *w->bond, compare_bonds);
}

/* The share of R that counts, for the elements at the places first .. end-1, one block. */
static void measure_block(const bbm_model *m, window *w, int first, int end)
{
    double x = 0, y = 0, reach2 = 0;

    for (int k = first; k < end; k++) {
        x += m->element[w->element[k]].x / (end - first);
        y += m->element[w->element[k]].y / (end - first);
    }
    for (int k = first; k < end; k++) {
        const bbm_element *e = &m->element[w->element[k]];
        for (int v = e->first; v < e->first + e->n; v++) {
            const double dx = m->vertex[v].x - x, dy = m->vertex[v].y - y;
            reach2 = fmax(reach2, 4 * (dx * dx + dy * dy));
        }
    }
    for (int k = first; k < end; k++)
        w->held[w->element[k]] = HELD * m->element[w->element[k]].A0 / reach2;
}

static void measure_blocks(const bbm_model *m, window *w)
{
    for (int first = 0, end; first < m->elements; first = end) {
        for (end = first + 1; end < m->elements; end++)
            if (m->element[w->element[end]].block != m->element[w->element[first]].block)
                break;
        measure_block(m, w, first, end);
    }
}

/* Eliminates unknown p, the first in the window; its pivot. The row becomes that of p + 3 band. */
static double eliminate(window *w, int p)
{
    const int n = 3 * w->band;
    double *top = &w->row[(size_t)(p % n) * (size_t)n];
    const double pivot = top[0] != 0 ? top[0] : TINY;

    for (int k = 1; k < n; k++) {
        double *row = &w->row[(size_t)((p + k) % n) * (size_t)n];
        const double f = top[k] / pivot;
        for (int c = k; c < n && f != 0; c++)
            row[c - k] -= f * top[c];
    }
    memset(top, 0, (size_t)n * sizeof *top);
    return pivot;
}

/* The first element at which a mechanism shows, or -1. */
static int find_negative_pivot(const bbm_model *m, window *w)
{
    static const double unit[3][3] = { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } };
    int found = -1;

    for (int k = 0, b = 0; k < m->elements && found < 0; k++) {
        for (int a = 0; a < 3; a++)
            add_product(w, k, k, unit[a], unit[a], TINY);
        add_fixed_points(m, w, w->element[k]);
        for (; b < m->bonds && w->bond[b].low == k; b++)
            add_bond(m, w, &m->bond[w->bond[b].bond]);
        for (int a = 0; a < 3; a++)
            if (eliminate(w, 3 * k + a) < 0)
                found = w->element[k];
    }
    return found;
}

/* Looks for elements that can turn against each other with `bonding` BBM_MIDPOINTS: one of them, or -1. */
bbm_status bbm_find_mechanism(const bbm_model *m, int *element)
{
    const size_t n = (size_t)m->elements;
    place *p = calloc(n, sizeof *p);
    window w = { 1, calloc(n, sizeof *w.place), calloc(n, sizeof *w.element), calloc(n, sizeof *w.held),
                 calloc((size_t)m->bonds + 1, sizeof *w.bond), NULL };
    bbm_status status = p && w.place && w.element && w.held && w.bond ? BBM_OK : BBM_NO_MEMORY;

    *element = -1;
    if (!status && m->beyond->bonding == BBM_MIDPOINTS) {
        sort_elements(m, &w, p);
        measure_blocks(m, &w);
        w.row = calloc(9 * (size_t)w.band, (size_t)w.band * sizeof *w.row);
        if (w.row)
            *element = find_negative_pivot(m, &w);
        else
            status = BBM_NO_MEMORY;
    }
    free(p), free(w.place), free(w.element), free(w.held), free(w.bond), free(w.row);
    return status;
}
