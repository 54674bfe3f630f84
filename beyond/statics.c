/* statics.c - what holds a body, and which block goes when statics finds no equilibrium.
 *
 * Before a step in statics the fixed points of each body, what bonds and contacts join, must hold it
 * against rigid motion. That a block slides, tips or falls shows later: K is singular then, or the
 * open-close iteration without an end, and the solver cannot tell why. So the failed step is solved once
 * more with inertia, in a step so long that inertia is nothing against stiffness: what is held hardly
 * notices, and what is not goes far. A push on all elements moves what rolls or slides but has no load
 * that way, too. The element that goes furthest is of the block to blame; where it parts from a neighbour
 * at a contact, the neighbour is what it slides on or tips over.
 */
#include <math.h>
#include <stdlib.h>

#include "beyond.h"

/* SLOW  [-]: elastic over inertial stiffness of an element in the long step, so that the solver still sees both
 * CARRIED [-]: share of the load that inertia carries if a block is loose; of what is held it is about n^4/SLOW for a
 *              bar of n elements
 * PARTS [-]: relative motion at a contact, against the largest motion, that is no strain 
 * LOOSE [-]: pivots of the (dimensionless) matrix of a body's fixings below this are zero: about 1e-5 rad
 *            of free turning */
#define SLOW 1e9
#define CARRIED 1e-3
#define PARTS 0.1
#define LOOSE 1e-10

/* ------------------------------------------------------------------- what holds a body */

/* The directions in which a body's fixed points hold it, as the 3x3 matrix of the rows (1, 0, -Y) and (0, 1, X) by
 * which they feel a rigid motion: regular when it is held. X, Y from one of its fixed points, over the body's reach. */
typedef struct { double G[3][3], x, y, reach; int fixed; } hold;

static void add_hold(hold *h, const bbm_node *n)
{
    const double X = (n->x - h->x) / h->reach, Y = (n->y - h->y) / h->reach;
    const double row[2][3] = { { 1, 0, -Y }, { 0, 1, X } };

    for (int r = 0; r < 2; r++)
        for (int a = 0; a < 3 && (n->held & (r == 0 ? BBM_X : BBM_Y)); a++)
            for (int b = 0; b < 3; b++)
                h->G[a][b] += row[r][a] * row[r][b];
}

/* Whether a positive semi-definite 3x3 matrix is regular, by elimination. */
static int regular(double G[3][3])
{
    for (int p = 0; p < 3; p++) {
        if (G[p][p] <= LOOSE)
            return 0;
        for (int a = p + 1; a < 3; a++)
            for (int b = p + 1; b < 3; b++)
                G[a][b] -= G[a][p] * G[p][b] / G[p][p];
    }
    return 1;
}

/* Sums up the fixed points of each body. */
static void sum_holds(const bbm_model *m, int up[], hold h[])
{
    for (int v = 0; v < m->vertices; v++) {
        const bbm_node *n = &m->node[m->vertex[v].node];
        hold *body = &h[bbm_root_of(up, m->vertex[v].element)];
        if (n->held && !body->fixed)
            body->fixed = 1, body->x = n->x, body->y = n->y;
    }
    for (int v = 0; v < m->vertices; v++) {
        const bbm_node *n = &m->node[m->vertex[v].node];
        hold *body = &h[bbm_root_of(up, m->vertex[v].element)];
        body->reach = fmax(body->reach, hypot(n->x - body->x, n->y - body->y));
    }
    for (int v = 0; v < m->vertices; v++)
        add_hold(&h[bbm_root_of(up, m->vertex[v].element)], &m->node[m->vertex[v].node]);
}

/* Statics needs bodies that fixed points hold, by themselves or through contacts. That a contact holds in
 * each direction is too kind to it: a block on a slope passes, and fails later. */
bbm_status bbm_check_supports(bbm_model *m)
{
    int *up = calloc((size_t)m->elements, sizeof *up);
    hold *h = calloc((size_t)m->elements, sizeof *h);
    bbm_status status = BBM_OK;

    if (!up || !h) {
        status = BBM_NO_MEMORY;
    } else {
        bbm_join_elements(m, up);
        sum_holds(m, up, h);
        for (int i = 0; i < m->elements && !status; i++)
            if (bbm_root_of(up, i) == i && !regular(h[i].G)) {
                m->blamed[0] = i;
                status = bbm_fail(m, BBM_FREE_TO_MOVE, "block %d, the body of element %d at (%g, %g)", m->element[i].block,
                              i, m->element[i].x, m->element[i].y);
            }
    }
    free(up);
    free(h);
    return status;
}

/* Whether every body of a prepared model is held, by itself or through contacts. */
bbm_status bbm_check_held(bbm_model *m)
{
    bbm_status status = bbm_check_step(m);

    m->h = INFINITY;
    if (!status) {
        bbm_guess_step(m);
        status = bbm_detect_contacts(m, NULL);
    }
    return status ? status : bbm_check_supports(m);
}

/* --------------------------------------------------------------------- which block goes */

static double long_step(const bbm_model *m)
{
    double h2 = 0;

    for (int i = 0; i < m->elements; i++) {
        const bbm_element *e = &m->element[i];
        h2 = fmax(h2, 2 * SLOW * e->material.density * e->A0 / e->material.E);
    }
    return sqrt(h2);
}

static double mass_of(const bbm_element *e) { return e->material.density * e->material.thickness * e->A0; }

static double sum_of_loads(const bbm_model *m)
{
    double load = 0;

    for (int i = 0; i < m->elements; i++)
        load += hypot(m->load[6 * i], m->load[6 * i + 1]);
    return load;
}

/* Adds to F as much again as the loads (1 N, if there are none), all one way, askew to most slopes, shared by mass. */
static void push_all(bbm_model *m)
{
    const double load = sum_of_loads(m), push = load > 0 ? load : 1;
    double mass = 0;

    for (int i = 0; i < m->elements; i++)
        mass += mass_of(&m->element[i]);
    for (int i = 0; i < m->elements; i++) {
        m->F[6 * i] += push * cos(1) * mass_of(&m->element[i]) / mass;
        m->F[6 * i + 1] += push * sin(1) * mass_of(&m->element[i]) / mass;
    }
}

/* How far two motions of elements lie apart, seen from the first. */
static double distance(const bbm_model *m, int i, int j)
{
    const bbm_element *a = &m->element[i], *b = &m->element[j];
    const double *p = &m->D[6 * i], *q = &m->D[6 * j], X = a->x - b->x, Y = a->y - b->y;

    return hypot(p[0] - q[0] + q[2] * Y, p[1] - q[1] - q[2] * X) + fabs(p[2] - q[2]) * sqrt(a->A0);
}

/* Of the solution D of a step h: the element that goes furthest and its like across the contact where it parts from
 * another block, or -1 if there is none. Returns 0 if all are held. */
static int find_loose(const bbm_model *m, double h, int pair[2])
{
    double inertia = 0, furthest = 0, most = 0;

    pair[0] = pair[1] = -1;
    for (int i = 0; i < m->elements; i++) {
        const bbm_element *e = &m->element[i];
        const double way = hypot(m->D[6 * i], m->D[6 * i + 1]);
        inertia += 2 / (h * h) * mass_of(e) * way;
        if (way > furthest)
            furthest = way, pair[0] = i;
    }
    for (int k = 0; k < bbm_contact_count(m); k++) {
        int c[2];
        bbm_contact_pair(m, k, c);
        const int first = hypot(m->D[6 * c[0]], m->D[6 * c[0] + 1]) >= hypot(m->D[6 * c[1]], m->D[6 * c[1] + 1]);
        const double apart = distance(m, c[0], c[1]);
        if (apart > fmax(most, PARTS * furthest))
            most = apart, pair[0] = c[!first], pair[1] = c[first];
    }
    return inertia > CARRIED * sum_of_loads(m);
}

/* Statics that fails because a block is loose says so, and who; a dynamic step whose contacts do not settle
 * because the solution goes too far says that. */
bbm_status bbm_explain(bbm_model *m, bbm_status status)
{
    const double h = long_step(m);
    bbm_pcg pcg = m->par.pcg;
    bbm_pcg_info info;
    int pair[2];

    if (!bbm_is_static(m))
        return status == BBM_OPEN_CLOSE && bbm_check_solution(m) == BBM_STEP_TOO_LONG
             ? BBM_STEP_TOO_LONG : status;
    if (status != BBM_NOT_POSITIVE_DEFINITE && status != BBM_NOT_CONVERGED && status != BBM_NOT_FINITE
        && status != BBM_OPEN_CLOSE && status != BBM_STEP_TOO_LONG)
        return status;
    m->h = h;
    m->K_is_kept = 0;
    const bbm_status assembled = bbm_assemble(m);
    m->h = INFINITY;
    pcg.method = &bbm_eisenstat;
    if (assembled)
        return assembled;
    push_all(m);
    if (bbm_solve(m->K, m->F, m->D, &pcg, &info) || !find_loose(m, h, pair))
        return status;
    m->blamed[0] = pair[0];
    m->blamed[1] = pair[1];
    const int block = m->element[pair[0]].block;
    if (pair[1] < 0)
        return bbm_fail(m, BBM_NO_EQUILIBRIUM, "block %d (element %d) is free to move; hold it, or use "
                        "dynamics", block, pair[0]);
    return bbm_fail(m, BBM_NO_EQUILIBRIUM, "block %d (element %d) slides, rolls, tips on or leaves block "
                    "%d (element %d); raise the friction, hold it, or use dynamics", block, pair[0],
                    m->element[pair[1]].block, pair[1]);
}
