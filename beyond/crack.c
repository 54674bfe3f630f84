/* crack.c - bonds that break: where a body breaks first, and how its fragments fall. It is no
 * measure of how strong a notched body is: ahead of a notch the stress grows with a finer mesh.
 *
 * Beyond the paper, whose last sentence announces it. Around a bond there is the stress sigma, the
 * mean by area over the elements of its body that meet at its two nodes. With n the normal of the
 * bond, s and t the normal and the shear component of sigma n, and s1 the larger principal stress,
 * a bond holds as long as
 *
 *     s1 <= tension     and     |t| <= cohesion - s tan(friction),        s > 0: tension.
 *
 * The first one is asked of the bond that lies best across the tension at one of its nodes, the
 * one with the largest s/s1. So a mesh whose bonds all lie askew is as strong as another one.
 *
 * When all else in a step has settled, the bond with the largest load breaks, and those that are
 * loaded as much, which symmetry asks for. Then the step is solved again, until all hold. So one
 * crack runs before a cloud of them appears. Nothing has moved by then: the order is that of the
 * loads and not of the list, and a step that is tried again begins with the cracks of the last one.
 *
 * A bond that has broken, or that softens, has a spring at each of its two ends, with w the opening
 * and v the slip there. In compression it has the stiffness k of (4), else what is left of it:
 *
 *     Pi = 1/2 k min(0, w)^2 + 1/2 c (max(0, w)^2 + v^2),     0 <= c < k.
 *
 * Brittle (energy 0): c = 0 at once. Else the tension of the bond falls along the teeth of a saw
 * about the line from its strength at w = 0 to 0 at w = w_c. At each tooth c falls, and together
 * they take the energy times the area. The Pi of a tooth is nowhere more than that of the last one:
 * no bond makes energy by breaking, and K stays positive definite. In an open or closed crack there
 * is no friction.
 *
 * Fragments. From the next step on both sides of a broken bond are boundary edges. Where broken
 * bonds go all round a piece, it is a body of its own: they leave the list of bonds, and contacts
 * take their place. A body has no contacts with itself, so that the springs above stay where a
 * crack ends inside. A corner that lies in another body, and that no contact has kept out, is taken
 * as one that has opened there: it may go out, and no deeper. */
#include <stdlib.h>
#include <string.h>

#include "beyond.h"

/* SAME [-]  loads that differ less are the same: symmetry, and the rounding of a solution
 * BREAKS    the most passes of a step in which bonds break */
#define SAME 1e-6
enum { TEETH = 10, BROKEN = TEETH + 1, BREAKS = 1000 };

/* ------------------------------------------------------------------------------ how bonds soften */

/* Where tooth j ends, as a share of w_c; as much of the strength is gone there. */
static double end_of_tooth(int j) { return j == 0 ? 0 : (j - 0.5) / TEETH; }

/* The strength that is left, as a share. */
static double left(const bbm_crack *c) { return c->tooth == BROKEN ? 0 : 1 - end_of_tooth(c->tooth); }

/* The area of a bond at the start. */
static double area_of(const bbm_model *m, const bbm_bond *b)
{
    const bbm_node *P = &m->node[m->vertex[b->p[0]].node], *Q = &m->node[m->vertex[b->p[1]].node];

    return hypot(Q->x - P->x, Q->y - P->y) * fmin(m->element[b->i].material.thickness,
                                                  m->element[b->j].material.thickness);
}

/* w_c: the sum of 1/2 c_j (w_j^2 - w_(j-1)^2) over the teeth is the energy of an area of 1. */
static double last_opening(const bbm_beyond *y)
{
    double sum = 0;

    for (int j = 1; j <= TEETH; j++)
        sum += (1 / end_of_tooth(j) - 1) / 2
             * (pow(end_of_tooth(j), 2) - pow(end_of_tooth(j - 1), 2));
    return y->bond_energy / (y->bond_tension * sum);
}

/* c of both ends of a bond together, N/m. */
static double softness(const bbm_model *m, const bbm_bond *b, int tooth)
{
    const bbm_beyond *y = m->beyond;

    return tooth == BROKEN ? 0
         : area_of(m, b) * y->bond_tension * (1 / end_of_tooth(tooth) - 1) / last_opening(y);
}

/* By how much the elements of a bond have turned. */
static double turn_of(const bbm_model *m, const bbm_bond *b)
{
    return (m->element[b->i].sum[2] + m->element[b->j].sum[2]) / 2;
}

/* The outward normal of element i on its bond, turned by r from where it was at the start. */
static void find_normal(const bbm_model *m, const bbm_bond *b, double r, double n[2])
{
    const bbm_node *P = &m->node[m->vertex[b->p[0]].node], *Q = &m->node[m->vertex[b->p[1]].node];
    const double x = Q->y - P->y, y = P->x - Q->x, l = hypot(x, y);

    n[0] = (x * cos(r) - y * sin(r)) / l;
    n[1] = (x * sin(r) + y * cos(r)) / l;
}

/* The crack of a bond of a prepared model; NULL: it is as new. */
static bbm_crack *crack_of(const bbm_model *m, int b)
{
    bbm_crack *c = m->is_prepared && m->beyond->crack ? &m->beyond->crack[b] : NULL;

    return c && c->tooth > 0 ? c : NULL;
}

int bbm_is_broken(const bbm_model *m, int b)
{
    return crack_of(m, b) && crack_of(m, b)->tooth == BROKEN;
}

/* Lists the two springs of a bond that softens or has broken; 0: it does not. `rest`, where they
 * have no length, turns with the bond. */
int bbm_list_crack(bbm_model *m, int b)
{
    const bbm_crack *c = crack_of(m, b);
    const bbm_bond *of = &m->bond[b];
    double n[2], N[2];

    if (!c)
        return 0;
    const bbm_element *i = &m->element[of->i], *j = &m->element[of->j];
    bbm_list_bond(m, of);
    find_normal(m, of, turn_of(m, of), n);
    find_normal(m, of, i->middle ? 0 : turn_of(m, of), N);
    for (int end = 0; end < 2; end++) {
        bbm_gap *g = &m->gap[m->gaps - 2 + end];
        const double soft = softness(m, of, c->tooth) / 2;
        const double push = c->pushes[end] ? g->W[0][0] - soft : 0;
        g->own = (bbm_multiplier){ { 0 }, { 0 } };
        g->elastic = 1;
        for (int a = 0; a < 4; a++)
            g->W[a / 2][a % 2] = (a % 3 == 0 ? soft : 0) + push * N[a / 2] * N[a % 2];
        if (i->middle)
            bbm_turn_opening(i, j, g);
        g->d0[0] -= c->rest[end][0] * n[0] - c->rest[end][1] * n[1];
        g->d0[1] -= c->rest[end][0] * n[1] + c->rest[end][1] * n[0];
    }
    return 1;
}

/* -------------------------------------------------------------------------------- which one breaks */

/* Adds the stress around a node to a sum of stress times area, and the area. */
static void add_stress(const bbm_model *m, int node, int body, double sum[4])
{
    double E[3][3];

    for (int a = m->adjacent_first[node]; a < m->adjacent_first[node + 1]; a++) {
        const int i = m->vertex[m->adjacent[a]].element;
        const bbm_element *e = &m->element[i];
        if (m->beyond->body[i] != body)
            continue;
        bbm_elastic_matrix(&e->material, E);
        sum[3] += e->A;
        for (int k = 0; k < 3; k++)
            sum[k] += e->A * (e->stress[k] + E[k][0] * m->D[6 * i + 3] + E[k][1] * m->D[6 * i + 4]
                              + E[k][2] * m->D[6 * i + 5]);
    }
}

/* s, t and s1 of a bond: of the stress around it, or if it softens of its own springs. */
static void find_traction(const bbm_model *m, int b, double s[3])
{
    const bbm_bond *of = &m->bond[b];
    double n[2], d[2], f[2] = { 0, 0 }, sum[4] = { 0 };

    find_normal(m, of, turn_of(m, of), n);
    for (int end = 0; end < 2 && !crack_of(m, b); end++)
        add_stress(m, m->vertex[of->p[end]].node, m->beyond->body[of->i], sum);
    for (int r = 0; r < 2 && !crack_of(m, b); r++)
        f[r] = (sum[r] * n[r] + sum[2] * n[1 - r]) / sum[3];
    for (const bbm_gap *g = &m->gap[2 * b]; g < &m->gap[2 * b + 2] && crack_of(m, b); g++) {
        bbm_gap_length(m, g, d);
        for (int r = 0; r < 2; r++)
            f[r] -= (g->W[r][0] * d[0] + g->W[r][1] * d[1]) / area_of(m, of);
    }
    s[0] = f[0] * n[0] + f[1] * n[1];
    s[1] = f[1] * n[0] - f[0] * n[1];
    s[2] = crack_of(m, b) ? s[0] : (sum[0] + sum[1]) / 2 / sum[3]
                                 + hypot((sum[0] - sum[1]) / 2, sum[2]) / sum[3];
}

/* How well each bond lies across the tension around it, and the best at each node. */
static void find_best(const bbm_model *m)
{
    bbm_beyond *y = m->beyond;
    double s[3];

    memset(y->best, 0, (size_t)m->nodes * sizeof *y->best);
    for (int b = 0; b < m->bonds; b++) {
        bbm_crack *c = &y->crack[b];
        find_traction(m, b, s);
        c->across = s[0] > 0 && c->tooth == 0 ? s[0] / s[2] : 0;
        for (int end = 0; end < 2; end++) {
            double *best = &y->best[m->vertex[m->bond[b].p[end]].node];
            *best = fmax(*best, c->across);
        }
    }
}

/* The load of a bond against its strength; more than 1: it breaks. */
static double find_load(const bbm_model *m, int b, int *shears)
{
    const bbm_beyond *y = m->beyond;
    const bbm_crack *c = &y->crack[b];
    double s[3];

    if (c->tooth == BROKEN)
        return 0;
    find_traction(m, b, s);
    const double *best[2] = { &y->best[m->vertex[m->bond[b].p[0]].node],
                              &y->best[m->vertex[m->bond[b].p[1]].node] };
    const int best_across = c->across >= (1 - SAME) * fmin(*best[0], *best[1]);
    const double pulled = c->tooth > 0 || (best_across && s[0] > 0)
                        ? s[2] / (y->bond_tension * left(c)) : 0;
    const double strength = y->bond_cohesion * left(c) - s[0] * bbm_tangent(y->bond_friction);
    const double sheared = strength > 0 ? fabs(s[1]) / strength : s[0] > 0 ? INFINITY : 0;
    *shears = sheared > pulled;
    return fmax(pulled, sheared);
}

/* The next tooth that is softer than the bond, or the end. The first time the two ends get springs
 * of their own: as long as the bond in the mean, and nothing of its bending is left in them. */
static void damage(bbm_model *m, int b)
{
    bbm_crack *c = &m->beyond->crack[b];
    const bbm_bond *of = &m->bond[b];
    const double k = 2 * bbm_bonding_stiffness(m->par.alpha, &m->element[of->i],
                                               &m->element[of->j]);
    double n[2], d[2][2];

    find_normal(m, of, turn_of(m, of), n);
    for (int end = 0; end < 2; end++) {
        d[end][0] = m->vertex[of->p[end]].u - m->vertex[of->q[end]].u;
        d[end][1] = m->vertex[of->p[end]].v - m->vertex[of->q[end]].v;
    }
    for (int end = 0; end < 2 && c->tooth == 0; end++) {
        const double x = (d[end][0] - d[1 - end][0]) / 2, y = (d[end][1] - d[1 - end][1]) / 2;
        c->rest[end][0] = x * n[0] + y * n[1];
        c->rest[end][1] = y * n[0] - x * n[1];
        c->pushes[end] = c->shears;
    }
    do
        c->tooth = m->beyond->bond_energy > 0 ? c->tooth + 1 : BROKEN;
    while (softness(m, of, c->tooth) >= k);
}

/* Whether the ends of cracks push that are closed, and no others. */
static int renew_pushes(bbm_model *m)
{
    double n[2], d[2];
    int changes = 0;

    for (int b = 0; b < m->bonds; b++)
        for (int end = 0; end < 2 && crack_of(m, b); end++) {
            int *pushes = &crack_of(m, b)->pushes[end];
            const int did = *pushes;
            find_normal(m, &m->bond[b], turn_of(m, &m->bond[b]), n);
            bbm_gap_length(m, &m->gap[2 * b + end], d);
            *pushes = d[0] * n[0] + d[1] * n[1] > 0;
            changes += *pushes != did;
        }
    return changes;
}

/* All has settled: do all bonds hold, and push where they are closed? If not, once more. Steps from
 * rest, with which statics looks for an equilibrium, break nothing. */
bbm_pass bbm_break_bonds(bbm_model *m)
{
    bbm_beyond *y = m->beyond;
    double most = 1;
    int changes, shears;

    if (y->bond_tension <= 0)
        return BBM_PASS_DONE;
    changes = renew_pushes(m);
    if (!changes && (bbm_is_static(m) || isfinite(m->par.dt))) {
        find_best(m);
        for (int b = 0; b < m->bonds; b++)
            most = fmax(most, find_load(m, b, &shears));
        for (int b = 0; b < m->bonds && most > 1; b++)
            y->crack[b].chosen = find_load(m, b, &y->crack[b].shears) >= most * (1 - SAME);
        for (int b = 0; b < m->bonds && most > 1; b++)
            if (y->crack[b].chosen)
                damage(m, b);
    }
    if (!changes && most <= 1)
        return BBM_PASS_DONE;
    if (!changes) {
        m->scratch->passes = m->scratch->one_until = y->round = 0;
        y->breaks++;
    }
    bbm_list_gaps(m);
    return y->breaks > BREAKS ? BBM_PASS_GIVE_UP : BBM_PASS_AGAIN;
}

/* -------------------------------------------------------------------------------------- fragments */

/* The side of a bond that starts at vertex v becomes a boundary edge. */
static void open_side(bbm_model *m, int v, int next)
{
    m->vertex[v].edge = m->edges;
    m->edge[m->edges++] = (bbm_edge){ .element = m->vertex[v].element, .a = v, .b = next };
}

/* Where the corners of contacts lie, times a sign, is added to where they count from. Two elements
 * share a corner no more when a bond between them has broken, and it jumps. Contacts keep their
 * forces. */
static void add_places(bbm_model *m, double sign)
{
    for (bbm_contact *c = m->contact; c < m->contact + m->contacts; c++) {
        double P[2], a[2], b[2];
        bbm_point_at(m, m->edge[c->corner].a, P);
        bbm_point_at(m, m->edge[c->edge].a, a);
        bbm_point_at(m, m->edge[c->edge].b, b);
        const double x = b[0] - a[0], y = b[1] - a[1], l = hypot(x, y);
        c->rest += sign * ((P[0] - a[0]) * y - (P[1] - a[1]) * x) / l;
        c->anchor += sign * ((P[0] - a[0]) * x + (P[1] - a[1]) * y) / (l * l);
    }
}

/* The detection begins anew with all boundaries as they were at the start, body by body. */
static bbm_status renew_detection(bbm_model *m)
{
    bbm_vertex *now = m->vertex, *start = malloc((size_t)m->vertices * sizeof *start);

    if (!start)
        return bbm_out_of_memory(m);
    for (int v = 0; v < m->vertices; v++) {
        start[v] = now[v];
        start[v].x -= now[v].u;
        start[v].y -= now[v].v;
    }
    for (int e = 0; e < m->edges; e++)
        m->edge[e].block = m->beyond->body[m->edge[e].element];
    bbm_detect_free(m->scratch);
    m->vertex = start;
    const bbm_status status = bbm_detect_new(m);
    m->vertex = now;
    free(start);
    for (int e = 0; e < m->edges; e++)
        m->edge[e].block = m->element[m->edge[e].element].block;
    return status ? bbm_out_of_memory(m) : BBM_OK;
}

/* What has broken in the last step is a boundary, and what has come off is a body. */
static bbm_status part_bodies(bbm_model *m)
{
    bbm_beyond *y = m->beyond;
    int kept = 0;

    add_places(m, -1);
    for (int b = 0; b < m->bonds; b++) {
        const bbm_bond *of = &m->bond[b];
        if (bbm_is_broken(m, b) && m->vertex[of->p[0]].edge < 0) {
            open_side(m, of->p[0], of->p[1]);
            open_side(m, of->q[1], of->q[0]);
        }
        if (y->body[of->i] != y->body[of->j])
            continue;
        m->bond[kept] = *of;
        y->kept[kept] = y->crack[b];
        memmove(&m->gap[2 * kept++], &m->gap[2 * b], 2 * sizeof *m->gap);
    }
    memmove(&m->gap[2 * kept], &m->gap[2 * m->bonds],
            (size_t)(m->gaps - 2 * m->bonds) * sizeof *m->gap);
    m->gaps -= 2 * (m->bonds - kept);
    m->bonds = kept;
    memcpy(y->crack, y->kept, (size_t)kept * sizeof *y->crack);
    add_places(m, 1);
    return renew_detection(m);
}

/* A step, or a part of one, begins with the cracks of the last one. */
bbm_status bbm_start_cracks(bbm_model *m)
{
    bbm_beyond *y = m->beyond;

    memcpy(y->crack, y->kept, (size_t)m->bonds * sizeof *y->crack);
    y->breaks = 0;
    bbm_find_pieces(m, y->body);
    const bbm_status status = y->parts ? part_bodies(m) : BBM_OK;
    y->parts = 0;
    return status;
}

/* The step went well: notes what broke, and what softening has taken. */
void bbm_keep_cracks(bbm_model *m)
{
    bbm_beyond *y = m->beyond;

    for (int b = 0; b < m->bonds; b++) {
        const bbm_crack *c = &y->crack[b];
        const bbm_vertex *P = &m->vertex[m->bond[b].p[0]], *Q = &m->vertex[m->bond[b].p[1]];
        for (int j = y->kept[b].tooth; j < c->tooth && y->bond_energy > 0; j++)
            y->crack_energy += j == 0 ? 0 : pow(end_of_tooth(j) * last_opening(y), 2) / 2
                             * (softness(m, &m->bond[b], j) - softness(m, &m->bond[b], j + 1));
        if (c->tooth != BROKEN || y->kept[b].tooth == BROKEN)
            continue;
        y->broke[y->broken++] = (bbm_break){ m->info.step + 1, c->bond, c->shears,
                                             (P->x + Q->x) / 2 + m->origin[0],
                                             (P->y + Q->y) / 2 + m->origin[1] };
        y->parts = 1;
    }
    memcpy(y->kept, y->crack, (size_t)m->bonds * sizeof *y->crack);
}

/* Finds near pairs. Where bonds have broken, a corner that has passed into another body becomes a
 * contact that has opened inside, and all begins once more. */
bbm_status bbm_catch_corners(bbm_model *m, double search)
{
    bbm_beyond *y = m->beyond;
    bbm_status status = bbm_find_near_pairs(m, search);

    while (!status && y->broken > 0 && y->passed[0] >= 0) {
        bbm_contact c = { .corner = y->passed[0], .edge = y->passed[1], .inside = 1, .hit = 2 };
        (void)bbm_depth_behind(m, c.corner, c.edge, &c.edge);
        bbm_contact *more = realloc(m->contact, ((size_t)m->contacts + 1) * sizeof *more);
        if (!more)
            return BBM_NO_MEMORY;
        m->contact = more;
        m->contact[m->contacts++] = c;
        qsort(m->contact, (size_t)m->contacts, sizeof *m->contact, bbm_compare_pairs);
        for (int k = m->contacts - 1; k >= 0; k--)
            m->edge[m->contact[k].corner].contact = k;
        y->caught++;
        y->passed[0] = -1;
        m->scratch->pairs = 0;
        status = bbm_find_near_pairs(m, search);
    }
    return status;
}

/* A step has failed because bonds broke, or for another reason. */
bbm_status bbm_say_cracks(bbm_model *m, bbm_status s)
{
    const bbm_beyond *y = m->beyond;
    const bbm_crack *last = NULL;
    int pieces = 0;

    for (int b = 0; b < m->bonds; b++)
        last = y->crack && y->crack[b].tooth > y->kept[b].tooth ? &y->crack[b] : last;
    if (!last || s == BBM_NO_MEMORY || s == BBM_STOPPED)
        return bbm_try_otherwise(m, s);
    if (y->breaks > BREAKS)
        return bbm_fail(m, s, "step %d: bonds break in more than %d passes; a smaller dt or load "
                        "helps", m->info.step + 1, BREAKS);
    for (int i = 0; i < m->elements; i++)
        pieces -= y->body[i] == i;
    pieces += bbm_find_pieces(m, y->body);
    const int of = m->element[m->bond[last - y->crack].i].block;
    if (!bbm_is_static(m) || pieces == 0)
        return bbm_try_otherwise(m, s);
    return bbm_fail(m, BBM_NO_EQUILIBRIUM, "step %d: block %d breaks through, and %d piece%s come%s "
                    "off; dynamics shows how", m->info.step + 1, of, pieces,
                    pieces == 1 ? "" : "s", pieces == 1 ? "s" : "");
}

/* Of a prepared model. */
bbm_status bbm_lay_out_cracks(bbm_model *m)
{
    bbm_beyond *y = m->beyond;
    const size_t n = (size_t)m->bonds + 1;

    y->crack = calloc(2 * n, sizeof *y->crack);
    y->best = calloc((size_t)m->nodes, sizeof *y->best);
    y->broke = calloc(n, sizeof *y->broke);
    if (!y->crack || !y->best || !y->broke)
        return BBM_NO_MEMORY;
    y->kept = y->crack + n;
    for (int b = 0; b < m->bonds; b++)
        y->crack[b].bond = y->kept[b].bond = b;
    y->broken = y->caught = y->parts = 0;
    y->crack_energy = 0;
    return BBM_OK;
}
