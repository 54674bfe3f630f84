/* statics.c - what holds a body; static steps whose contacts find no end; and which block falls.
 *
 * Before a step in statics the gaps between a component of K and the wall, fixed points in the
 * main, must hold it against rigid motion. That a block slides, tips or falls shows later.
 *
 * A static step asks for the states of all contacts at once, and each that slides or opens takes
 * away what held others. K may be singular long before the states are right, though there is an
 * equilibrium. So a step that fails is done in another way: in steps from rest, as those with
 * par.velocity_factor = 0. Inertia, 2 M/h^2, holds each block where it is, and the shorter h is the
 * less do contacts feel of each other. Where it settles h grows, and the model creeps towards the
 * equilibrium with what slides sliding. As soon as a static step from there finds it, near by, that
 * is the end: it stands. If two blocks part by more than FAR, they have done so in the attempt, and
 * if forces come no nearer to balance, it falls, and these are named. Else nothing was found, which
 * is said as well; and the model is what it was.
 */
#include "beyond.h"

/* LOOSE [-]    a pivot of the matrix of what holds a body is zero if less than this share of it is
 *              left: about 1e-5 rad of free turning
 * STRIDE [-]   how far blocks may part, against the smaller one's size, in a step from rest and
 *              in the static step from there: contacts and directions are those of its start. Once
 *              they have parted by more than FAR it grows in proportion, up to FAR/2
 * LEAP [-]     the same of a static step from where the model is: elastic bodies may flatten
 * FAR [-]      how far they have parted in all when that is no elastic way
 * SLOWS [-]    nor if forces lack less of balance than this share of what they did at half the way:
 *              elastic bodies come to rest so, and what falls does not
 * SWING [-]    FAR of a program with gaps of its own, as bolts: what swings on them goes far
 * LONG [-]     the first step from rest that is tried, against a swing on what is softest: as in
 *              slow dynamics contacts then close under the whole load, and little slides before
 * SHORT [-]    the shortest step
 * DRIFT [-]    by which, in each step, what was tried is forgotten */
#define LOOSE 1e-10
#define STRIDE 1e-3
#define LEAP 0.2
#define FAR 0.02
#define SLOWS 0.9
#define SWING 4.0
#define LONG 100
#define SHORT 1e-3
#define DRIFT 0.9

/* ------------------------------------------------------------------------- what holds a body */

/* G += T^T W/tr(W) T: what a gap to the wall feels of a rigid motion (u, v, r) of its body about
 * the barycentre of element o. */
static void add_hold(const bbm_element *e, bbm_gap g, int o, double G[3][3])
{
    const double trace = g.W[0][0] + g.W[1][1];

    for (int r = 0; r < 2; r++)
        g.Ti[r][2] += g.Ti[r][1] * (e[g.i].x - e[o].x) - g.Ti[r][0] * (e[g.i].y - e[o].y);
    for (int k = 0; k < 36 && trace > 0 && g.j < 0; k++) {
        const int a = k / 12, b = k / 4 % 3, r = k / 2 % 2, s = k % 2;
        G[a][b] += g.Ti[r][a] * g.W[r][s] / trace * g.Ti[s][b];
    }
}

/* G += t t^T, where the level of water crosses an edge: what floats does not sink there. */
static void add_floating(const bbm_model *m, const bbm_edge_load *load, double x, double G[3][3])
{
    const bbm_vertex *a = &m->vertex[load->a];
    const bbm_vertex *b = &m->vertex[bbm_next_vertex(&m->element[a->element], load->a)];
    const double depth[2] = { load->level - a->y, load->level - b->y };
    const double s = depth[0] == depth[1] ? 0 : depth[0] / (depth[0] - depth[1]);
    const double t[3] = { 0, 1, a->x + s * (b->x - a->x) - x };

    for (int k = 0; k < 9 && load->density > 0 && depth[0] * depth[1] <= 0; k++)
        G[k / 3][k % 3] += t[k / 3] * t[k % 3];
}

/* Whether a positive semi-definite 3x3 matrix is regular, by its pivots. */
static int is_regular(double G[3][3])
{
    const double whole[3] = { G[0][0], G[1][1], G[2][2] };

    bbm_condense(3, 1, G[0]);
    return G[0][0] > LOOSE * whole[0] && G[1][1] > LOOSE * whole[1] && G[2][2] > LOOSE * whole[2];
}

/* Whether the wall holds the body of element i by itself; body[] has a number for each element. */
int bbm_is_held(const bbm_model *m, const int body[], int i)
{
    double G[3][3] = { { 0 } };

    for (const bbm_gap *g = m->gap; g < m->gap + m->gaps; g++)
        if (body[g->i] == body[i])
            add_hold(m->element, *g, i, G);
    return is_regular(G);
}

/* Statics needs bodies that the wall holds, by themselves or through contacts, or on which they
 * float; a component of K is a body. That a contact holds in each direction is too kind to it: a
 * block on a slope passes, and fails later. */
bbm_status bbm_check_supports(bbm_model *m)
{
    const int *body = m->K->component;
    const bbm_element *e = m->element;
    struct { int first; double G[3][3]; } *of = calloc((size_t)m->elements, sizeof *of);
    int loose = -1;

    if (!of)
        return BBM_NO_MEMORY;
    for (int i = m->elements - 1; i >= 0; i--)
        of[body[i]].first = i;
    for (const bbm_gap *g = m->gap; g < m->gap + m->gaps; g++)
        add_hold(e, *g, of[body[g->i]].first, of[body[g->i]].G);
    for (int l = 0; l < m->beyond->edge_loads; l++) {
        const bbm_edge_load *load = &m->beyond->edge_load[l];
        const int c = body[m->vertex[load->a].element];
        add_floating(m, load, e[of[c].first].x, of[c].G);
    }
    for (int i = m->elements - 1; i >= 0 && bbm_is_static(m); i--)
        if (of[body[i]].first == i && !is_regular(of[body[i]].G))
            loose = i;
    free(of);
    if (loose < 0)
        return BBM_OK;
    m->blamed[0] = loose;
    return bbm_fail(m, BBM_FREE_TO_MOVE, "block %d, the body of element %d at (%.9g, %.9g)",
                    e[loose].block, loose, e[loose].x + m->origin[0], e[loose].y + m->origin[1]);
}

/* Begins a static step of a prepared model: lists its gaps and contacts, and refuses a body that is
 * not held, by itself or through contacts. */
bbm_status bbm_begin_statics(bbm_model *m)
{
    m->h = INFINITY;
    const bbm_status status = bbm_begin_step(m);
    return status ? status : bbm_detect(m, &(int){ 0 });
}

/* ----------------------------------------------------------------------- who parts from whom */

/* How far the corner of a contact and the point of the edge below it have parted on the way from
 * one model to another, against the size of the smaller block; a turn counts in radians. u: the way
 * of the corner, m, without what it has sunk in; turn: that of its element, both against the edge.
 */
static double find_parting(const bbm_model *from, const bbm_model *to, const bbm_contact *c,
                           double u[2], double *turn)
{
    const bbm_edge *p = &to->edge[c->corner], *q = &to->edge[c->edge];
    const double share = fmin(1, fmax(0, bbm_way_along(to, c->corner, c->edge) / q->along.length));
    const double part[3] = { 1, share - 1, -share };
    const int vertex[3] = { p->a, q->a, q->b };

    u[0] = u[1] = *turn = 0;
    for (int k = 0; k < 3; k++) {
        const bbm_vertex *start = &from->vertex[vertex[k]], *end = &to->vertex[vertex[k]];
        const int i = end->element;
        u[0] += part[k] * (end->u - start->u);
        u[1] += part[k] * (end->v - start->v);
        *turn += part[k] * (to->element[i].sum[2] - from->element[i].sum[2]);
    }
    const double in = fmax(0, u[1] * q->along.x - u[0] * q->along.y);
    u[0] += in * q->along.y;
    u[1] -= in * q->along.x;
    return hypot(u[0], u[1]) / bbm_size_at(to, c) + fabs(*turn);
}

/* How far blocks have parted at most: at a contact in the list that is closed or was so when the
 * step began, or at `worst`, which becomes that contact; its edge is -1 before the first. */
static double find_most_parted(const bbm_model *from, const bbm_model *to, const bbm_contact *list,
                               int n, bbm_contact *worst)
{
    double u[2], turn, most = worst->edge < 0 ? 0 : find_parting(from, to, worst, u, &turn);

    for (const bbm_contact *c = list; c < list + n; c++) {
        const double parted = find_parting(from, to, c, u, &turn);
        if ((c->state != BBM_OPEN || c->trial.was_closed || c->trial.touches) && parted > most) {
            most = parted;
            *worst = *c;
        }
    }
    return most;
}

/* Refuses a static step in which blocks part by a good part of their size, for its contacts are
 * those of its start, and any step that goes further than `reach`. */
bbm_status bbm_check_reach(bbm_model *m, const bbm_model *end)
{
    bbm_contact worst = { .edge = -1 };
    const double most = find_most_parted(m, end, m->scratch->contact, m->scratch->contacts, &worst);

    if (most <= (bbm_is_static(m) ? fmin(LEAP, m->beyond->reach) : m->beyond->reach))
        return BBM_OK;
    return bbm_fail(m, BBM_STEP_TOO_LONG, "step %d: blocks %d and %d part by %.2g of their size",
                    m->info.step + 1, m->edge[worst.corner].block, m->edge[worst.edge].block, most);
}

/* How far an element has gone; a held one nowhere, though its supports may give way. */
static double way_of(const bbm_model *from, const bbm_model *m, int i)
{
    const double *a = from->element[i].sum, *b = m->element[i].sum;

    return m->K->body[i] < 0 ? 0 : hypot(b[0] - a[0], b[1] - a[1]);
}

/* Says which two blocks have parted, the one first that has gone further; and how: along the edge
 * without much of a turn, or else away from it. */
static bbm_status blame(bbm_model *m, const bbm_model *from, const bbm_contact *c)
{
    const bbm_direction t = m->edge[c->edge].along;
    const int k = way_of(from, m, c->element[1]) > way_of(from, m, c->element[0]);
    const int i = m->blamed[0] = c->element[k], j = m->blamed[1] = c->element[!k];
    double u[2], turn;

    find_parting(from, m, c, u, &turn);
    const double across = fmax(fabs(u[0] * t.y - u[1] * t.x), fabs(turn) * bbm_size_at(m, c));
    return bbm_fail(m, BBM_NO_EQUILIBRIUM, "step %d: block %d (element %d) %s block %d (element "
                    "%d), and goes on", from->info.step + 1, m->element[i].block, i,
                    fabs(u[0] * t.x + u[1] * t.y) > across ? "slides on" : "lifts off",
                    m->element[j].block, j);
}

/* ------------------------------------------------------------------------ steps from rest */

/* Statics from where the model is now: it has to find the equilibrium near by, and soon. */
static bbm_status try_statics(bbm_model *m)
{
    const int most = m->par.pcg.iterations, few = 6 * m->elements + 100, done = m->info.iterations;

    m->h = INFINITY;
    m->par.pcg.iterations = few < most ? few : most;
    m->info.iterations = 0;
    const bbm_status status = bbm_try_step(m);
    m->par.pcg.iterations = most;
    m->info.iterations += done;
    return status;
}

/* Steps from rest, each as long as it settles and blocks part little in it, until statics finds an
 * equilibrium from where they are, forces balance without inertia, or blocks have parted. Joints
 * hold until forces balance with what holds them: at first inertia bears the weight. A length that
 * failed, or after which statics did, is not tried again for some steps. Lengths count in the time
 * in which the lightest element that is not held swings on a contact spring, or with friction on
 * the softest element if that gives way more: then it matters who comes first. */
static bbm_status creep(bbm_model *m, const bbm_model *from)
{
    double failed = INFINITY, tried = 0, parted = 0, lacks = 1, before = INFINITY;
    double least = INFINITY, softest = m->par.p_n;
    double far = m->hook->list_gaps == bbm_list_edge_gaps ? FAR : SWING;
    bbm_contact worst = { .edge = -1 };
    bbm_status status = BBM_OPEN_CLOSE;
    bbm_beyond *b = m->beyond;

    int hold = b->joints > 0 || b->cohesion > 0 || b->tension > 0;
    for (const bbm_element *i = m->element; i < m->element + m->elements; i++)
        if (m->K->body[i - m->element] >= 0) {
            least = fmin(least, bbm_mass_per_area(i) * i->A0);
            if (m->par.friction > 0 || b->joints > 0)
                softest = fmin(softest, i->material.E * i->material.thickness);
        }
    const double swing = sqrt(2 * least / softest);
    double h = LONG * swing;
    while (h > SHORT * swing && !bbm_is_spent(m)) {
        m->h = h;
        b->joints_hold = hold;
        status = bbm_try_step(m);
        b->joints_hold = 0;
        const int settles = !status;
        if (settles) {
            parted = find_most_parted(from, m, m->contact, m->contacts, &worst);
            b->parted = fmax(b->parted, parted);
            b->reach = fmax(STRIDE, fmin(FAR / 2, STRIDE / FAR * parted));
            lacks = b->lack;
            before = parted <= far / 2 ? lacks : before;    /* at half of that way */
            if (parted > far && lacks > SLOWS * before)
                return blame(m, from, &worst);
            if (parted > far) {
                far *= 2;
                before = lacks;
            }
            const int balances = lacks <= BBM_BALANCED && b->overload <= 1;
            status = balances && !hold ? BBM_OK
                   : balances || h > tried ? try_statics(m) : BBM_OPEN_CLOSE;
            hold &= !balances;
        }
        if (!status || status == BBM_NO_MEMORY || status == BBM_STOPPED)
            return status;
        tried = !settles ? tried : DRIFT * (h > tried ? 2 * h : tried);
        failed = settles ? failed / DRIFT : h;
        h *= !settles ? 0.25 : 4 * h < failed ? 2 : 1;
    }
    const int has_reason = status != BBM_OPEN_CLOSE && status != BBM_STEP_TOO_LONG;
    if (status == BBM_TOO_SOFT || (tried == 0 && has_reason))
        return status;
    return bbm_fail(m, BBM_OPEN_CLOSE, "step %d: neither an equilibrium nor a block that falls was "
                    "found; try dynamics; forces lack %.1g of balance, and blocks have parted by "
                    "%.1g of their size", from->info.step + 1, lacks, parted);
}

/* What steps change but the contacts, to one piece of memory or back. Returns its bytes; to NULL:
 * no more than that. */
static size_t copy_state(const bbm_model *m, char *to, int back)
{
    const struct { void *at; size_t bytes; } piece[] = {
        { m->element, (size_t)m->elements * sizeof *m->element },
        { m->vertex, (size_t)m->vertices * sizeof *m->vertex },
        { m->gap, (size_t)m->gaps * sizeof *m->gap },
        { m->beyond->support, (size_t)m->nodes * sizeof *m->beyond->support },
        { m->beyond->account, (size_t)m->elements * sizeof *m->beyond->account },
        { m->beyond, sizeof *m->beyond },
    };
    size_t bytes = 0;

    for (int k = 0; k < LENGTH(piece); k++) {
        if (to)
            memcpy(back ? piece[k].at : to + bytes, back ? to + bytes : piece[k].at,
                   piece[k].bytes);
        bytes += piece[k].bytes;
    }
    return bytes;
}

/* A static step that failed where blocks touch is tried in steps from rest. What fails leaves the
 * model as it was. */
static bbm_status settle(bbm_model *m)
{
    char *was = malloc(copy_state(m, NULL, 0));
    bbm_contact *list = malloc(((size_t)m->contacts + 1) * sizeof *list);
    const double reach = m->beyond->reach;
    bbm_model from = *m;

    if (!was || !list)
        return free(was), free(list), BBM_NO_MEMORY;
    copy_state(m, was, 0);
    from.element = (void *)was;
    from.vertex = (void *)(from.element + m->elements);
    memcpy(list, m->contact, (size_t)m->contacts * sizeof *list);
    m->beyond->reach = STRIDE;
    m->par.velocity_factor = 0;
    const bbm_status status = creep(m, &from);
    m->h = INFINITY;
    m->par = from.par;
    m->info.t = from.info.t;
    m->beyond->reach = reach;
    if (!status)
        m->message[0] = '\0';
    else {
        m->gaps = from.gaps;
        copy_state(m, was, 1);                  /* what it was, but for its message */
        free(m->scratch->contact);
        m->scratch->contact = list;
        m->scratch->contacts = from.contacts;
        bbm_keep_contacts(m);
        m->info = from.info;
        list = NULL;
    }
    free(was);
    free(list);
    return status;
}

/* A static step that failed is tried otherwise where bodies meet, or bolts join them, but not if a
 * support moves: in steps from rest it does so at once, and what it pushes stops anywhere where
 * friction holds it. A dynamic step whose contacts do not settle because the solution goes too far
 * says that. */
bbm_status bbm_try_otherwise(bbm_model *m, bbm_status status)
{
    if (!bbm_is_static(m))
        return status == BBM_OPEN_CLOSE && bbm_check_solution(m) == BBM_STEP_TOO_LONG
             ? BBM_STEP_TOO_LONG : status;
    const int lost = status == BBM_NOT_FINITE
                  || (status >= BBM_NOT_POSITIVE_DEFINITE && status <= BBM_TOO_SOFT);
    if (!lost || !bbm_blocks_meet(m))
        return status;
    for (int n = 0; n < 2 * m->nodes; n++)
        if (m->beyond->support[n / 2].moved[n % 2] != 0)
            return bbm_fail(m, BBM_OPEN_CLOSE, "step %d: a support moves, and what slides before "
                            "it depends on its way; try dynamics with velocity_factor 0 and a ramp",
                            m->info.step + 1);
    return settle(m);
}
