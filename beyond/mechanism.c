/* mechanism.c - quadrilaterals bonded at the middles of their sides alone, that can turn against
 * each other.
 *
 * A grid of rectangles bonded so has a motion that costs nothing: neighbours turn in opposite
 * senses, like a chequerboard of gears, about the middles of their common sides (doc/limits.md,
 * section 2). The equations are then singular, or what holds the motion has nothing to do with the
 * body's stiffness: the displacements are wrong, and nothing in them says so.
 *
 * Rigid elements tell it, since what strains an element costs energy in any case. Let each have
 * three unknowns, two displacements and a rotation. Let E be the energy of unit springs in all gaps
 * of bonds that have a stiffness, and half of one in those of fixed points; let R be that of unit
 * springs in the gaps without stiffness, the opening of the bonded sides. A mechanism has E = 0
 * and R > 0. A body that moves as a whole has E = R = 0, and in bending E is as large as R,
 * however long the body is. The softest sound motion is a chequerboard that fades along a body of
 * n elements to a clamped end: E = 0.15 R/n^2, measured. What is held more softly than that is
 * refused with the mechanisms, for a grid whose nodes are off by a hundredth is no better than a
 * perfect one.
 *
 *     E - HELD R/n^2 + TINY |D|^2
 *
 * is positive for all motions but these, and has as many negative pivots as there are of them
 * (Sylvester). Gaussian elimination shows the first. Of the matrix only a window is kept, as wide
 * as the band: the gaps of an element are added when it is the next one, and its rows are
 * forgotten after it.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "beyond.h"

/* HELD [-]  of E n^2/R, between 0.15 of a clamped end and 0.07 of two pins, which hold a
 *           chequerboard at one node each
 * TINY [-]  keeps the pivots of free bodies above their rounding, 1e-16 times the number of
 *           elements */
#define HELD 0.1
#define TINY 1e-10

typedef struct {
    int *place;                 /* [elements] in the order of elimination                       */
    int *first, *next;          /* [elements], [gaps] from first[k] on, over next, to -1: the   */
                                /*            gaps of which place k is the first                */
    double *held;               /* [elements] HELD/n^2, n^2 = size^2 of the body over the       */
                                /*            element's area                                    */
    int n;                      /* unknowns in the window                                       */
    double *row;                /* [n * n]    row r from its diagonal on is at r % n            */
} window;

static double *entry(const window *w, int r, int c)
{
    return &w->row[(size_t)(r % w->n) * (size_t)w->n + (size_t)(c - r)];
}

/* Adds the springs of a gap between rigid elements. A rotation is measured in the size of its
 * element, so that all unknowns are lengths. */
static void add_gap(const bbm_model *m, const window *w, const bbm_gap *g)
{
    const int element[2] = { g->i, g->j }, n = g->j < 0 ? 3 : 6;

    for (int r = 0; r < 2; r++) {
        double T[6], weight = g->j < 0 ? 0.5 : 1;
        int at[6];
        for (int s = 0; s < n; s++) {
            const int e = element[s / 3];
            T[s] = s < 3 ? g->Ti[r][s] : -g->Tj[r][s - 3];
            T[s] /= s % 3 == 2 ? sqrt(m->element[e].A0) : 1;
            at[s] = 3 * w->place[e] + s % 3;
        }
        if (g->own.W[r][r] == 0)
            weight = g->j < 0 ? 0 : -(w->held[g->i] + w->held[g->j]) / 2;
        for (int s = 0; s < n * n; s++)
            if (at[s / n] <= at[s % n])
                *entry(w, at[s / n], at[s % n]) += weight * T[s / n] * T[s % n];
    }
}

/* Eliminates unknown p, the first in the window; its row becomes that of p + n. Returns 1 if the
 * pivot is positive. */
static int eliminate(const window *w, int p)
{
    double *top = entry(w, p, p);
    const double pivot = top[0];

    for (int k = 1; k < w->n && pivot > 0; k++) {
        double *row = entry(w, p + k, p + k);
        const double f = top[k] / pivot;
        for (int c = k; c < w->n && f != 0; c++)
            row[c - k] -= f * top[c];
    }
    memset(top, 0, (size_t)w->n * sizeof *top);
    return pivot > 0;
}

/* The order of elimination, that of K, and the list of gaps for each place. */
static bbm_status lay_out(const bbm_model *m, window *w)
{
    memcpy(w->place, m->K->place, (size_t)m->elements * sizeof *w->place);
    w->n = 3;
    for (int e = 0; e < m->elements; e++)
        w->first[e] = -1;
    for (int g = 0; g < m->gaps; g++) {
        const int i = w->place[m->gap[g].i], j = m->gap[g].j < 0 ? i : w->place[m->gap[g].j];
        const int low = i < j ? i : j, band = 3 * (abs(i - j) + 1);
        w->next[g] = w->first[low];
        w->first[low] = g;
        w->n = band > w->n ? band : w->n;
    }
    w->row = calloc((size_t)w->n * (size_t)w->n, sizeof *w->row);
    return w->row ? BBM_OK : BBM_NO_MEMORY;
}

/* The share of R that counts. The size of a body is twice the way from the mean of its elements to
 * its furthest vertex; `piece` and `sum` are scratch. */
static void measure(const bbm_model *m, int piece[], double (*sum)[4], double held[])
{
    bbm_find_pieces(m, piece);
    for (int e = 0; e < m->elements; e++) {
        sum[piece[e]][0] += m->element[e].x;
        sum[piece[e]][1] += m->element[e].y;
        sum[piece[e]][2]++;
    }
    for (int v = 0; v < m->vertices; v++) {
        double *s = sum[piece[m->vertex[v].element]];
        s[3] = fmax(s[3], hypot(m->vertex[v].x - s[0] / s[2], m->vertex[v].y - s[1] / s[2]));
    }
    for (int e = 0; e < m->elements; e++)
        held[e] = HELD * m->element[e].A0 / pow(2 * sum[piece[e]][3], 2);
}

/* Looks for elements that can turn against each other with `bonding` BBM_MIDPOINTS: one of them, or
 * -1. */
bbm_status bbm_find_mechanism(bbm_model *m, int *element)
{
    const size_t n = (size_t)m->elements;
    int sound = 1;

    *element = -1;
    if (m->beyond->bonding != BBM_MIDPOINTS)
        return BBM_OK;
    bbm_list_gaps(m);
    int *place = calloc(2 * n + (size_t)m->gaps, sizeof *place);
    double (*sum)[4] = calloc(n, sizeof *sum), *held = calloc(n, sizeof *held);
    window w = { place, place + n, place + 2 * n, held, 0, NULL };
    bbm_status status = place && sum && held ? BBM_OK : BBM_NO_MEMORY;
    if (!status) {
        measure(m, w.place, sum, held);
        status = lay_out(m, &w);
    }
    for (int k = 0; k < m->elements && sound && !status; k++) {
        for (int a = 3 * k; a < 3 * k + 3; a++)
            *entry(&w, a, a) += TINY;
        for (int g = w.first[k]; g >= 0; g = w.next[g])
            add_gap(m, &w, &m->gap[g]);
        for (int a = 3 * k; a < 3 * k + 3 && sound; a++)
            sound = eliminate(&w, a);
        for (int e = 0; e < m->elements && !sound; e++)
            if (place[e] == k)
                *element = e;
    }
    free(place);
    free(sum);
    free(held);
    free(w.row);
    return status;
}
