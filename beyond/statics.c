/* statics.c - what holds a body, and which block goes when statics finds no equilibrium.
 *
 * Before a step in statics the gaps between a body and the wall, fixed points in the main, must
 * hold it against rigid motion; a body is what gaps and contacts join. That a block slides, tips
 * or falls shows later: K is singular then, or the open-close iteration without an end, and the
 * solver cannot tell why. So the failed step is solved once more with inertia, in a step so long
 * that inertia is nothing against stiffness: what is held hardly notices, and what is not goes
 * far. A push on all elements moves what rolls or slides but has no load that way, too. The
 * element that goes furthest is of the block to blame; where it parts from a neighbour at a
 * contact, the neighbour is what it slides on or tips over.
 */
#include <math.h>
#include <stdlib.h>

#include "beyond.h"

/* LOOSE [-]  a pivot of the matrix of what holds a body is zero if less than this share of it is
 *            left: about 1e-5 rad of free turning
 * SLOW [-]   elastic over inertial stiffness of an element in the long step, so that the solver
 *            still sees both
 * FREE [-]   share of the way of a free element that a loose one goes at least; the end of a
 *            clamped bar of n elements goes about n^4/(4 SLOW) of it
 * PARTS [-]  relative motion at a contact, against the largest motion, that is no strain */
#define LOOSE 1e-10
#define SLOW 1e9
#define FREE 2e-3
#define PARTS 0.1

/* ------------------------------------------------------------------------- what holds a body */

/* G += T^T W/tr(W) T: what a gap to the wall feels of a rigid motion (u, v, r) of its body about a
 * point from which its element is at (X, Y). */
static void add_hold(bbm_gap g, double X, double Y, double G[3][3])
{
    const double trace = g.own.W[0][0] + g.own.W[1][1];

    for (int r = 0; r < 2; r++)
        g.Ti[r][2] += g.Ti[r][1] * X - g.Ti[r][0] * Y;
    for (int k = 0; k < 36 && trace > 0; k++) {
        const int a = k / 12, b = k / 4 % 3, r = k / 2 % 2, s = k % 2;
        G[a][b] += g.Ti[r][a] * g.own.W[r][s] / trace * g.Ti[s][b];
    }
}

/* Whether a positive semi-definite 3x3 matrix is regular, by its pivots. */
static int is_regular(double G[3][3])
{
    const double whole[3] = { G[0][0], G[1][1], G[2][2] };

    bbm_condense(3, 1, G);
    return G[0][0] > LOOSE * whole[0] && G[1][1] > LOOSE * whole[1] && G[2][2] > LOOSE * whole[2];
}

static int body(const bbm_model *m, int i) { return bbm_component_of(m->K, i); }

/* Statics needs bodies that the wall holds, by themselves or through contacts; a component of K is
 * a body. That a contact holds in each direction is too kind to it: a block on a slope passes, and
 * fails later. */
bbm_status bbm_check_supports(bbm_model *m)
{
    const bbm_element *e = m->element;
    int loose = -1;

    if (!bbm_is_static(m))
        return BBM_OK;
    int *first = calloc((size_t)m->elements, sizeof *first);
    double (*G)[3][3] = calloc((size_t)m->elements, sizeof *G);
    const bbm_status status = first && G ? BBM_OK : BBM_NO_MEMORY;
    for (int i = m->elements - 1; i >= 0 && !status; i--)
        first[body(m, i)] = i;
    for (int g = 0; g < m->gaps && !status; g++) {
        const bbm_element *own = &e[m->gap[g].i], *o = &e[first[body(m, m->gap[g].i)]];
        if (m->gap[g].j < 0)
            add_hold(m->gap[g], own->x - o->x, own->y - o->y, G[body(m, m->gap[g].i)]);
    }
    for (int i = 0; i < m->elements && !status && loose < 0; i++)
        if (first[body(m, i)] == i && !is_regular(G[body(m, i)]))
            loose = i;
    free(first);
    free(G);
    if (loose < 0)
        return status;
    m->blamed[0] = loose;
    return bbm_fail(m, BBM_FREE_TO_MOVE, "block %d, the body of element %d at (%g, %g)",
                    e[loose].block, loose, e[loose].x + m->origin[0],
                    e[loose].y + m->origin[1]);
}

/* Whether every body of a prepared model is held, by itself or through contacts. */
bbm_status bbm_check_held(bbm_model *m)
{
    bbm_status status = bbm_check_step(m);
    int other;

    m->h = INFINITY;
    if (!status)
        status = bbm_begin_step(m);
    return status ? status : bbm_detect(m, &other);
}

/* --------------------------------------------------------------------- which block goes */

/* Solves the step once more, so long that it shows what is loose, with a push as large as all
 * loads (1 N, if there are none) on all elements by their mass, one way, askew to most slopes, and
 * without the friction in K, which could hold or drive what slides.
 * A free element would go *far under the loads. */
static bbm_status take_long_step(bbm_model *m, double *far)
{
    double load = 0, mass = 0, h2 = 0;
    bbm_pcg pcg = m->par.pcg;
    bbm_pcg_info info;

    for (int i = 0; i < m->elements; i++) {
        const bbm_element *e = &m->element[i];
        load += hypot(m->load[6 * i], m->load[6 * i + 1]);
        mass += e->material.density * e->material.thickness * e->A0;
        h2 = fmax(h2, 2 * SLOW * e->material.density * e->A0 / e->material.E);
    }
    const double a = (load > 0 ? load : 1) / mass, push[2] = { a * cos(1), a * sin(1) };
    *far = load / mass * h2 / 2;
    m->h = sqrt(h2);
    bbm_matrix_keep(m->K, 0);
    bbm_assemble(m);
    m->h = INFINITY;
    m->K->terms = 0;
    for (int i = 0; i < m->elements; i++)
        bbm_gravity_submatrix(&m->element[i], push, &m->F[6 * i]);
    pcg.method = NULL;
    return bbm_solve(m->K, m->F, m->D, &pcg, &info);
}

static double way(const bbm_model *m, int i) { return hypot(m->D[6 * i], m->D[6 * i + 1]); }

/* How far two motions of elements lie apart, seen from the first. */
static double distance(const bbm_model *m, int i, int j)
{
    const bbm_element *a = &m->element[i], *b = &m->element[j];
    const double *p = &m->D[6 * i], *q = &m->D[6 * j], X = a->x - b->x, Y = a->y - b->y;

    return hypot(p[0] - q[0] + q[2] * Y, p[1] - q[1] - q[2] * X) + fabs(p[2] - q[2]) * sqrt(a->A0);
}

/* How far the element goes that goes furthest; and this one, or the two at the contact where
 * blocks part most, the one that goes further first. The second is -1 if no blocks part. */
static double find_loose(const bbm_model *m, int pair[2])
{
    const bbm_contact *list = m->scratch->contact;

    pair[0] = 0;
    pair[1] = -1;
    for (int i = 1; i < m->elements; i++)
        if (way(m, i) > way(m, pair[0]))
            pair[0] = i;
    const double furthest = way(m, pair[0]);
    double most = PARTS * furthest;
    for (int k = 0; k < m->scratch->contacts; k++) {
        const int c[2] = { m->edge[list[k].corner].element, m->edge[list[k].edge].element };
        const double apart = distance(m, c[0], c[1]);
        if (apart > most) {
            most = apart;
            pair[0] = c[way(m, c[0]) < way(m, c[1])];
            pair[1] = c[0] + c[1] - pair[0];
        }
    }
    return furthest;
}

/* Statics that fails because a block is loose says so, and who; a dynamic step whose contacts do
 * not settle because the solution goes too far says that. */
bbm_status bbm_explain(bbm_model *m, bbm_status status)
{
    double far;
    int p[2];

    if (!bbm_is_static(m))
        return status == BBM_OPEN_CLOSE && bbm_check_solution(m) == BBM_STEP_TOO_LONG
             ? BBM_STEP_TOO_LONG : status;
    if (status != BBM_NOT_FINITE && (status < BBM_NOT_POSITIVE_DEFINITE || status > BBM_TOO_SOFT))
        return status;
    if (take_long_step(m, &far) || !(find_loose(m, p) > FREE * far))
        return status;
    m->blamed[0] = p[0];
    m->blamed[1] = p[1];
    if (p[1] < 0)
        return bbm_fail(m, BBM_NO_EQUILIBRIUM, "block %d (element %d) is free to move; hold it, or "
                        "use dynamics", m->element[p[0]].block, p[0]);
    return bbm_fail(m, BBM_NO_EQUILIBRIUM, "block %d (element %d) slides, rolls, tips on or leaves "
                    "block %d (element %d); raise the friction, hold it, or use dynamics",
                    m->element[p[0]].block, p[0], m->element[p[1]].block, p[1]);
}
