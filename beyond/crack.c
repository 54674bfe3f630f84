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
 * one with the largest s/s1. So a mesh whose bonds all lie askew is as strong as another one. A
 * bond along the tension, with less than a third, is not pulled apart by it.
 *
 * When all else in a step has settled, and the list of contacts reaches as far as the solution
 * moves, the bond with the largest load breaks, and those that are loaded as much, which symmetry
 * asks for. Then the step is solved again, until all hold. So one crack runs before a cloud of them
 * appears. Nothing has moved by then: the order is that of the loads and not of the list, and a
 * step that is tried again begins with the cracks of the last one.
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
#include "beyond.h"

/* SAME [-]  loads that differ less are the same: symmetry, and the rounding of a solution
 * ACROSS [-] the least s/s1: 55 degrees, which no usual mesh has
 * WIDE [-]  of the size of an element: how far a crack that softens may open
 * BREAKS    the most passes of a step in which bonds break */
#define SAME 1e-6
#define ACROSS (1 / 3.0)
#define WIDE 0.1
enum { TEETH = 10, BROKEN = TEETH + 1, BREAKS = 1000 };

/* ----------------------------------------------------------------------------- how bonds soften */

/* Where tooth j ends, as a share of w_c; as much of the strength is gone there. Behind the last
 * tooth nothing is left. */
static double end_of(int j) { return j == 0 ? 0 : fmin(1, (j - 0.5) / TEETH); }

/* c of a tooth, in tension/w_c. */
static double slope_of(int tooth) { return 1 / end_of(tooth) - 1; }

/* What a bond has taken that begins a tooth, in tension w_c for each area: where a tooth ends, c
 * falls to that of the next one, and 1/2 c w^2 with it. */
static double taken(int tooth)
{
    double sum = 0;

    for (int j = 1; j < tooth; j++)
        sum += (slope_of(j) - slope_of(j + 1)) * pow(end_of(j), 2) / 2;
    return sum;
}

/* The outward normal n of element i on its bond, at the start or as it is turned now. Returns the
 * area of the bond. */
static double find_normal(const bbm_model *m, const bbm_bond *b, int now, double n[2])
{
    const bbm_node *P = &m->node[m->vertex[b->p[0]].node], *Q = &m->node[m->vertex[b->p[1]].node];
    const bbm_element *i = &m->element[b->i], *j = &m->element[b->j];
    const double x = Q->y - P->y, y = P->x - Q->x, l = hypot(x, y);
    const double r = now * (i->sum[2] + j->sum[2]) / 2;

    n[0] = (x * cos(r) - y * sin(r)) / l;
    n[1] = (x * sin(r) + y * cos(r)) / l;
    return l * fmin(i->material.thickness, j->material.thickness);
}

/* N/m, of the spring at each end of a bond, Eq. (4). */
static double stiffness(const bbm_model *m, const bbm_bond *b)
{
    return bbm_bonding_stiffness(m->par.alpha, &m->element[b->i], &m->element[b->j]);
}

/* c of both ends of a bond together, N/m. */
static double soft_stiffness(const bbm_model *m, const bbm_bond *b, int tooth)
{
    const double T = m->beyond->bond_tension, w_c = m->beyond->bond_energy / (T * taken(BROKEN));
    double n[2];

    return tooth == BROKEN ? 0 : find_normal(m, b, 0, n) * T * slope_of(tooth) / w_c;
}

/* How often a bond has softened. */
int bbm_tooth_of(const bbm_model *m, int b)
{
    return m->is_prepared && m->beyond->crack ? m->beyond->crack[b].tooth : 0;
}

int bbm_is_broken(const bbm_model *m, int b) { return bbm_tooth_of(m, b) == BROKEN; }

/* Lists the two springs of a bond that softens or has broken, and marks its nodes; 0: it does not.
 * `rest`, where the first has no length and less that of the second, turns with the bond. */
int bbm_list_crack(bbm_model *m, int b)
{
    const bbm_bond *of = &m->bond[b];
    const bbm_element *i = &m->element[of->i], *j = &m->element[of->j];
    double n[2], N[2];

    if (bbm_tooth_of(m, b) == 0)
        return 0;
    const bbm_crack *c = &m->beyond->crack[b];
    const double soft = soft_stiffness(m, of, c->tooth) / 2;
    bbm_list_bond(m, of);
    find_normal(m, of, 1, n);
    find_normal(m, of, !i->middle, N);
    for (int end = 0; end < 2; end++) {
        bbm_gap *g = &m->gap[m->gaps - 2 + end];
        const double push = c->pushes[end] ? g->W[0][0] - soft : 0, sign = end ? -1 : 1;
        m->beyond->best[m->vertex[of->p[end]].node] = 1;
        g->own = (bbm_multiplier){ { 0 }, { 0 } };
        g->elastic = 1;
        for (int a = 0; a < 4; a++)
            g->W[a / 2][a % 2] = (a % 3 == 0 ? soft : 0) + push * N[a / 2] * N[a % 2];
        if (i->middle)
            bbm_turn_opening(i, j, g);
        g->d0[0] -= sign * (c->rest[0] * n[0] - c->rest[1] * n[1]);
        g->d0[1] -= sign * (c->rest[0] * n[1] + c->rest[1] * n[0]);
    }
    return 1;
}

/* ----------------------------------------------------------------------------- which one breaks */

/* Adds the stress around a node of a body, times area, and the area. */
static void add_stress(const bbm_model *m, int node, int body, double sum[4])
{
    double E[3][3];

    for (int a = m->adjacent_first[node]; a < m->adjacent_first[node + 1]; a++) {
        const int i = m->vertex[m->adjacent[a]].element, counts = m->beyond->body[i] == body;
        const bbm_element *e = &m->element[i];
        bbm_elastic_matrix(&e->material, E);
        sum[3] += counts * e->A;
        for (int k = 0; k < 3; k++)
            sum[k] += counts * e->A * (e->stress[k] + E[k][0] * m->D[6 * i + 3]
                                       + E[k][1] * m->D[6 * i + 4] + E[k][2] * m->D[6 * i + 5]);
    }
}

/* s, t and s1 of a bond: of the stress around it, or if it softens of its own springs. */
static void find_traction(const bbm_model *m, int b, double s[3])
{
    const bbm_bond *of = &m->bond[b];
    double n[2], d[2], f[2] = { 0, 0 }, S[4] = { 0 };
    const double area = find_normal(m, of, 1, n);
    const int softens = bbm_tooth_of(m, b) > 0;

    for (int end = 0; end < 2; end++) {
        const bbm_gap *g = &m->gap[2 * b + end];
        add_stress(m, m->vertex[of->p[end]].node, m->beyond->body[of->i], S);
        bbm_gap_length(m, g, d);
        for (int r = 0; r < 2; r++)
            f[r] -= (g->W[r][0] * d[0] + g->W[r][1] * d[1]) / area;
    }
    for (int r = 0; r < 2 && !softens; r++)
        f[r] = (S[r] * n[r] + S[2] * n[1 - r]) / S[3];
    s[0] = f[0] * n[0] + f[1] * n[1];
    s[1] = f[1] * n[0] - f[0] * n[1];
    s[2] = softens ? s[0] : ((S[0] + S[1]) / 2 + hypot((S[0] - S[1]) / 2, S[2])) / S[3];
}

/* How many times too much a bond bears: the larger one of
 *
 *     s1 / tension   and   (|t| + s tan(friction)) / cohesion,
 *
 * each strength as far as it is left. Above 1 it breaks. Divided by it, s and t are just borne. */
static double find_load(const bbm_model *m, int b)
{
    const bbm_beyond *y = m->beyond;
    bbm_crack *c = &y->crack[b];
    const double best = fmin(y->best[m->vertex[m->bond[b].p[0]].node],
                             y->best[m->vertex[m->bond[b].p[1]].node]);
    const double left = 1 - end_of(c->tooth), friction = bbm_tangent(y->bond_friction);

    if (c->tooth == BROKEN)
        return 0;
    const double sheared = (fabs(c->s[1]) + c->s[0] * friction) / (y->bond_cohesion * left);
    const int pulls = c->tooth > 0 ? c->s[0] > 0
                                   : c->across > 0 && c->across >= (1 - SAME) * best;
    const double pulled = pulls ? c->s[2] / (y->bond_tension * left) : 0;

    c->shears = sheared > pulled;
    return fmax(pulled, sheared);
}

/* The next tooth that is softer than the bond, or the end. The first time the two ends get springs
 * of their own: as long as the bond in the mean, and nothing of its bending is left in them. */
static void damage(bbm_model *m, int b)
{
    bbm_crack *c = &m->beyond->crack[b];
    const bbm_bond *of = &m->bond[b];
    const bbm_vertex *v = m->vertex, *P = &v[of->p[0]], *Q = &v[of->q[0]];
    const bbm_vertex *R = &v[of->p[1]], *S = &v[of->q[1]];
    const double x = (P->u - Q->u - R->u + S->u) / 2, y = (P->v - Q->v - R->v + S->v) / 2;
    double n[2];

    if (c->tooth == 0) {
        find_normal(m, of, 1, n);
        c->rest[0] = x * n[0] + y * n[1];
        c->rest[1] = y * n[0] - x * n[1];
        c->pushes[0] = c->pushes[1] = c->shears;
    }
    do
        c->tooth = m->beyond->bond_energy > 0 ? c->tooth + 1 : BROKEN;
    while (soft_stiffness(m, of, c->tooth) >= 2 * stiffness(m, of));
}

/* Lets those ends of cracks push that are closed, and no others; whether there were others. One
 * that would carry less than SAME of the strength is closed or open by rounding only, and stays. */
static int renew_pushes(bbm_model *m)
{
    const bbm_beyond *y = m->beyond;
    const double none = SAME * fmin(y->bond_tension, y->bond_cohesion);
    double n[2], d[2];
    int changes = 0;

    for (int k = 0; k < 2 * m->bonds; k++) {
        const double area = find_normal(m, &m->bond[k / 2], 1, n);
        int *pushes = &y->crack[k / 2].pushes[k % 2];
        bbm_gap_length(m, &m->gap[k], d);
        const double p = stiffness(m, &m->bond[k / 2]) * (d[0] * n[0] + d[1] * n[1]) / area;
        if (y->crack[k / 2].tooth > 0 && (*pushes ? p <= -none : p > none)) {
            *pushes = !*pushes;
            changes++;
        }
    }
    return changes;
}

/* The first element of a piece that has come off and that supports do not hold, by themselves or by
 * contacts and bolts; -1: there is none. What a crack presses on is not held: it may slide. */
static int find_loose(const bbm_model *m)
{
    int *body = m->beyond->body + m->elements;

    bbm_find_pieces(m, body);
    for (const bbm_contact *c = m->scratch->contact; c < bbm_end_of_contacts(m); c++)
        if (c->state != BBM_OPEN)
            body[bbm_root_of(body, c->element[0])] = bbm_root_of(body, c->element[1]);
    for (const bbm_gap *g = m->gap + 2 * m->bonds; g < m->gap + m->gaps; g++)
        if (g->j >= 0)
            body[bbm_root_of(body, g->i)] = bbm_root_of(body, g->j);
    for (int i = 0; i < m->elements; i++)
        body[i] = bbm_root_of(body, i);
    for (int b = 0; b < m->bonds; b++) {
        const int of[2] = { body[m->bond[b].i], body[m->bond[b].j] };
        for (int k = 0; k < 2 && of[0] != of[1]; k++)
            if (!bbm_is_held(m, body, of[k]))
                return of[k];
    }
    return -1;
}

/* Once all has settled: asks for another pass if a bond pushes that did not, or breaks the bonds
 * that bear the most of their strength, if they bear more than all of it. Steps from rest, with
 * which statics looks for an equilibrium, break none: it finds none with such an overload. Nor does
 * a solution that moves farther than the list of contacts reaches. Its contacts are listed as if
 * for the first time, so that the step goes on even if the new list is the same. */
bbm_pass bbm_break_bonds(bbm_model *m)
{
    bbm_beyond *y = m->beyond;

    if (y->bond_tension <= 0)
        return BBM_PASS_DONE;
    if (!renew_pushes(m)) {
        memset(y->best, 0, (size_t)m->nodes * sizeof *y->best);
        for (int b = 0; b < m->bonds; b++) {    /* how well one that is as new lies across the   */
            bbm_crack *c = &y->crack[b];        /* tension around it; the best at each node      */
            find_traction(m, b, c->s);
            c->across = c->tooth == 0 && c->s[0] > ACROSS * fabs(c->s[2]) ? c->s[0] / c->s[2] : 0;
            for (int end = 0; end < 2; end++) {
                double *best = &y->best[m->vertex[m->bond[b].p[end]].node];
                *best = fmax(*best, c->across);
            }
        }
        y->overload = 1;
        for (int b = 0; b < m->bonds; b++)
            y->overload = fmax(y->overload, find_load(m, b));
        if (y->overload > 1 && bbm_moved_too_far(m))
            m->detections = 0;
        if (y->overload == 1 || m->detections == 0 || (isinf(m->par.dt) && !bbm_is_static(m)))
            return BBM_PASS_DONE;
        for (int b = 0; b < m->bonds; b++)
            if (find_load(m, b) >= y->overload * (1 - SAME))
                damage(m, b);
        m->scratch->passes = m->scratch->one_until = 0;
        y->breaks++;
        y->loose = bbm_is_static(m) ? find_loose(m) : -1;
    }
    y->round = 0;
    bbm_list_gaps(m);
    return y->loose >= 0 || y->breaks > BREAKS ? BBM_PASS_GIVE_UP : BBM_PASS_AGAIN;
}

/* ------------------------------------------------------------------------------------ fragments */

/* Room for more contacts. */
static bbm_status widen_contacts(bbm_model *m, int more)
{
    bbm_contact *list = realloc(m->contact, (size_t)(m->contacts + more + 1) * sizeof *list);

    m->contact = list ? list : m->contact;
    return list ? BBM_OK : BBM_NO_MEMORY;
}

/* Of a contact k whose corner was shared with the vertex shares[k], and is no more, each of the two
 * corners gets half of the forces: a mirrored model would leave all of it to the other one. Other
 * elements begin to share a corner, which then jumps. Contacts keep their forces: their springs
 * count from where they carry these. */
static void part_contacts(bbm_model *m, const int shares[], int n)
{
    for (int k = 0; k < n; k++) {
        bbm_contact *c = &m->contact[k];
        const int other = bbm_edge_at(m, shares[k]);
        if (other == c->corner)
            continue;
        c->N /= 2;
        c->T /= 2;
        c->area /= 2;
        m->contact[m->contacts] = *c;
        m->contact[m->contacts++].corner = other;
    }
    for (bbm_contact *c = m->contact; c < m->contact + m->contacts; c++) {
        bbm_spring v[2];
        bbm_shared_vectors(m, c, 0, v);         /* d_n, and d_s from P3 */
        c->rest = v[0].d + c->N / m->par.p_n;
        c->anchor = (c->T / m->par.p_s - v[1].d) / m->edge[c->edge].along.length;
    }
    qsort(m->contact, (size_t)m->contacts, sizeof *m->contact, bbm_compare_pairs);
}

/* What has broken in the last step is a boundary, and what has come off is a body. Without memory
 * for that the model has to be prepared anew. The detection begins anew, body by body. */
static bbm_status part_bodies(bbm_model *m)
{
    bbm_beyond *y = m->beyond;
    const int n = m->contacts;
    int kept = 0, *shares = malloc(((size_t)n + 1) * sizeof *shares);

    if (!shares || widen_contacts(m, n))
        return free(shares), BBM_NO_MEMORY;
    for (int k = 0; k < n; k++)
        shares[k] = bbm_find_partner(m, m->edge[m->contact[k].corner].a);
    for (int b = 0; b < m->bonds; b++) {
        const bbm_bond of = m->bond[b];
        const int side[2][2] = { { of.p[0], of.p[1] }, { of.q[1], of.q[0] } };
        for (int k = 0; k < 2 && bbm_is_broken(m, b) && m->vertex[side[k][0]].edge < 0; k++) {
            const bbm_edge new = { k ? of.j : of.i, side[k][0], side[k][1], .joined = { -1, -1 },
                                   .held = { -1, -1 } };
            m->vertex[new.a].edge = m->edges;
            m->edge[m->edges++] = new;
        }
        if (y->body[of.i] != y->body[of.j])
            continue;
        m->bond[kept] = of;
        y->crack[kept] = y->kept[kept] = y->crack[b];
        memmove(&m->gap[2 * kept++], &m->gap[2 * b], 2 * sizeof *m->gap);
    }
    m->gaps -= 2 * (m->bonds - kept);
    memmove(&m->gap[2 * kept], &m->gap[2 * m->bonds],
            (size_t)(m->gaps - 2 * kept) * sizeof *m->gap);
    m->bonds = kept;
    y->parts = 0;
    for (int e = 0; e < m->edges; e++)
        m->edge[e].block = y->body[m->edge[e].element];
    bbm_detect_free(m->scratch);
    const bbm_status status = bbm_detect_new(m);
    for (int e = 0; e < m->edges; e++)
        m->edge[e].block = m->element[m->edge[e].element].block;
    part_contacts(m, shares, n);
    free(shares);
    m->is_prepared = !status;
    return status;
}

/* A step, or a part of one, begins with the cracks of the last one. */
bbm_status bbm_start_cracks(bbm_model *m)
{
    bbm_beyond *y = m->beyond;

    memcpy(y->crack, y->kept, (size_t)m->bonds * sizeof *y->crack);
    y->breaks = 0;
    y->loose = -1;
    bbm_find_pieces(m, y->body);
    return y->parts ? part_bodies(m) : BBM_OK;
}

/* The step went well: notes what broke, and what softening has taken. */
void bbm_keep_cracks(bbm_model *m)
{
    bbm_beyond *y = m->beyond;
    double n[2];

    for (int b = 0; b < m->bonds; b++) {
        bbm_crack *c = &y->crack[b];
        const bbm_vertex *P = &m->vertex[m->bond[b].p[0]], *Q = &m->vertex[m->bond[b].q[1]];
        y->crack_energy += (taken(c->tooth) - taken(y->kept[b].tooth)) / taken(BROKEN)
                         * y->bond_energy * find_normal(m, &m->bond[b], 0, n);
        if (c->tooth == BROKEN && y->kept[b].tooth != BROKEN) {
            y->broke[y->broken++] = (bbm_break){ m->info.step + 1, c->bond, c->shears,
                                                 (P->x + Q->x) / 2 + m->origin[0],
                                                 (P->y + Q->y) / 2 + m->origin[1] };
            y->parts = 1;
        }
    }
    memcpy(y->kept, y->crack, (size_t)m->bonds * sizeof *y->crack);
}

/* Finds near pairs. Where bonds have broken, a corner that has passed into another body becomes a
 * contact that has opened inside, and all begins once more. */
bbm_status bbm_catch_corners(bbm_model *m, double search)
{
    bbm_beyond *y = m->beyond;
    bbm_status status;

    while (!(status = bbm_find_near_pairs(m, search)) && y->broken > 0 && y->passed[0] >= 0) {
        bbm_contact c = { .corner = y->passed[0], .edge = y->passed[1], .inside = 1, .hit = 2 };
        search = fmax(search, bbm_depth_behind(m, c.corner, c.edge, search, &c.edge));
        if (widen_contacts(m, 1))
            return BBM_NO_MEMORY;
        m->contact[m->contacts++] = c;
        qsort(m->contact, (size_t)m->contacts, sizeof *m->contact, bbm_compare_pairs);
        for (int k = m->contacts - 1; k >= 0; k--)
            m->edge[m->contact[k].corner].contact = k;
        y->caught++;
        y->passed[0] = -1;
        m->scratch->pairs = 0;
    }
    return status;
}

/* A step has failed, because of bonds that broke in it, or for another reason. */
bbm_status bbm_say_cracks(bbm_model *m, bbm_status s)
{
    const bbm_beyond *y = m->beyond;
    const int breaks = y->breaks, loose = y->loose;

    if (!m->is_prepared || s == BBM_NO_MEMORY || s == BBM_STOPPED)
        return s;
    memcpy(y->crack, y->kept, (size_t)m->bonds * sizeof *y->crack);
    if (loose >= 0) {
        const bbm_element *e = &m->element[m->blamed[0] = loose];
        return bbm_fail(m, BBM_NO_EQUILIBRIUM, "step %d: block %d breaks through, and no support "
                        "holds its piece at (%.9g, %.9g); dynamics shows how its pieces fall",
                        m->info.step + 1, e->block, e->x + m->origin[0], e->y + m->origin[1]);
    }
    const int told = bbm_is_static(m) && m->scratch->contacts > 0;      /* by statics.c */
    s = breaks <= BREAKS ? bbm_try_otherwise(m, s) : s;
    return s != BBM_OPEN_CLOSE || breaks == 0 || told ? s
         : bbm_fail(m, s, "step %d at t = %g, and bonds broke in %d passes; a smaller %s helps",
                    m->info.step + 1, m->info.t, breaks, bbm_is_static(m) ? "load" : "dt or load");
}

/* Of a prepared model: nothing has broken yet. Refuses what breaking bonds are not for: hits that
 * have no stress; corners that come off inside another piece where no contact begins unloaded, see
 * bbm_rest_of; cracks so wide that corners which come off lie as deep as no contact may. */
bbm_status bbm_begin_cracks(bbm_model *m)
{
    bbm_beyond *y = m->beyond;
    const char *why = y->restitution >= 0 ? "restitution: its jump has no stress that breaks any"
                    : y->rotation == BBM_LINEAR && isfinite(m->par.dt) ? "linear rotation: its "
                      "contacts throw out corners that come off inside another piece" : NULL;

    y->edges = m->edges;
    y->kept = y->crack + m->bonds;
    for (int b = 0; b < m->bonds; b++)
        y->kept[b].bond = b;
    y->crack_energy = y->broken = y->caught = y->parts = 0;
    y->loose = -1;
    if (y->bond_tension > 0 && why)
        return bbm_fail(m, BBM_BAD_PARAMETER, "bonds that break and %s, expected one of the two",
                        why);
    for (const bbm_bond *b = m->bond; b < m->bond + m->bonds && y->bond_energy > 0; b++) {
        const double open = y->bond_energy / (y->bond_tension * taken(BROKEN));
        const double size = sqrt(fmin(m->element[b->i].A0, m->element[b->j].A0));
        if (open > WIDE * size)
            return bbm_fail(m, BBM_BAD_PARAMETER, "a crack that softens is free at %.3g m, by "
                            "energy/tension, expected at most a tenth of its elements, %.3g m",
                            open, WIDE * size);
    }
    return BBM_OK;
}
