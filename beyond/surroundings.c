/* surroundings.c - what the surroundings do to a body: loads on its edges, supports, plane strain.
 *
 * Beyond the paper, whose loads along a line, Eq. (38)-(43), lie between two grid points and keep
 * their direction. Where blocks share grid points, or an edge is known by its number alone, the
 * load belongs to one of the edges between them. The block lies on the left of an edge from a to b,
 * and a pressure p pushes that way, p (-(b - a)_y, (b - a)_x)/|b - a|, with the edge in the middle
 * of the step: its work is then p times the area that the edge sweeps. Still water up to the level
 * y = Y presses with density times gravity's size times Y - y, above the level with nothing. This y
 * is that in the middle of the step, too, or in statics at its end. So water has a stiffness for
 * what floats.
 *
 * A fixed point is held to a wall point by a stiff spring and its multiplier: what these carry at
 * the end of the step is the force of the support, the reaction. In equilibrium the reactions
 * balance the loads. A wall point may be displaced between the steps. The support then does work:
 * its force at the end of the step times its way, as for the loads.
 *
 * The paper's plates are free to strain along the axis, out of the plane: plane stress. A slice of
 * a long dam or tunnel is not. With ezz = 0 Hooke's law (7) is the same in the plane with
 *
 *     E/(1 - nu^2) in place of E,      nu/(1 - nu) in place of nu
 *
 * (Timoshenko and Goodier, Theory of Elasticity, chapter 2), G stays, and out of the plane there is
 * szz = nu (sx + sy). With n the nu of the plane, nu = n/(1 + n).
 */
#include "beyond.h"

/* SETTLED [-]  of what presses on an edge, and of the water that its element displaces */
#define SETTLED 1e-9

/* ----------------------------------------------------------------------------- loads on an edge */

static double weight_of(const bbm_model *m, const bbm_edge_load *water)
{
    return water->density * hypot(m->par.gravity[0], m->par.gravity[1]);
}

/* What presses in a direction (0: x, 1: y) on an edge whose element moves by D in the step, N on
 * the right of (5), and two parts of its stiffness -dN/dD. With the depth level - y(s) along the
 * edge, its length l and its inward normal n,
 *
 *     N_r = int (pressure + weight depth) l n_r T_r ds over what is under water.
 *
 * An edge that sinks meets more pressure, which is `sinks`. What this does sideways, and that all
 * pressure turns with its edge, is `turns`: the symmetric part, for all around a body there is no
 * other. In statics both begin with the next step, when the forces have their new arms, too.
 *
 * The mean of a point's start and end lies on the chord of its way: when the element turns by r,
 * cos(r/2) as far from the barycentre. `whole` undoes this, and it displaces the same water. */
static void press(const bbm_model *m, const bbm_edge_load *load, int r, const double D[6],
                  double N[6], double sinks[6][6], double turns[6][6])
{
    const bbm_element *e = &m->element[m->vertex[load->a].element];
    const double weight = weight_of(m, load), end = bbm_is_static(m) ? r : 0.5;
    const double whole = weight > 0 && e->middle ? 1 / cos(e->middle->D[2] / 2) : 1;
    const double middle = load->level - e->y - D[1] / 2;
    double U[2][2][6], x[2][2], depth[2], from = 0, to = 1;     /* T at the two ends, and there */

    for (int i = 0; i < 2; i++) {
        const bbm_vertex *P = &m->vertex[i ? bbm_next_vertex(e, load->a) : load->a];
        bbm_step_point(e, P->x, P->y, U[i], x[i]);
        depth[i] = load->level - P->y;
        for (int k = 0; k < 6; k++)
            depth[i] -= end * U[i][1][k] * D[k];
        depth[i] = middle + whole * (depth[i] - middle);
    }
    const double n = whole * (r ? x[1][0] - x[0][0] : x[0][1] - x[1][1]);
    const double at = depth[0] / (depth[0] - depth[1]);
    if (weight > 0 && depth[0] < 0)
        from = depth[1] > 0 ? at : 1;
    if (weight > 0 && depth[1] < 0)
        to = depth[0] > 0 ? at : from;
    for (int g = 0; g < BBM_GAUSS; g++) {
        double s, share, T[2][6];
        bbm_gauss_point(g, &s, &share);
        s = from + (to - from) * s;
        share *= to - from;
        const double p = load->pressure + weight * ((1 - s) * depth[0] + s * depth[1]);
        for (int k = 0; k < 12; k++)
            T[k / 6][k % 6] = (1 - s) * U[0][k / 6][k % 6] + s * U[1][k / 6][k % 6];
        for (int k = 0; k < 6; k++)
            N[k] += share * p * n * T[r][k];
        for (int k = 0; k < 36; k++) {
            const int i = k / 6, j = k % 6;
            const double sideways = weight * n * T[0][i] * T[1][j];
            const double turning = p * ((U[1][1][j] - U[0][1][j]) * T[0][i]
                                        - (U[1][0][j] - U[0][0][j]) * T[1][i]);
            const double half = share * (r ? turning : sideways) / 2;
            sinks[i][j] += r * end * share * weight * n * T[1][i] * T[1][j];
            turns[i][j] += half;
            turns[j][i] += half;
        }
    }
}

/* Adds a load on a boundary edge of the prepared model. */
static bbm_status add(bbm_model *m, int edge, bbm_edge_load load)
{
    if (m->status)
        return m->status;
    if (!m->K || edge < 0 || edge >= m->edges)
        return m->status = bbm_fail(m, BBM_BAD_INDEX, "loaded edge %d of %d", edge, m->edges);
    if (!isfinite(load.f[0] + load.f[1] + load.pressure + load.level * load.density))
        return m->status = bbm_fail(m, BBM_NOT_FINITE, "the load of edge %d", edge);
    load.a = m->edge[edge].a;
    return m->status = bbm_append(m, (void **)&m->beyond->edge_load, &m->beyond->edge_loads,
                                  sizeof load, &load, NULL);
}

/* A force and a pressure, N/m. */
bbm_status bbm_load_edge(bbm_model *m, int edge, double fx, double fy, double pressure)
{
    return add(m, edge, (bbm_edge_load){ .f = { fx, fy }, .pressure = pressure });
}

/* Water up to the level; its density is that of a m^3 times the thickness, kg/m^2. */
bbm_status bbm_add_water(bbm_model *m, int edge, double level, double density)
{
    return add(m, edge, (bbm_edge_load){ .level = level - m->origin[1], .density = density });
}

/* Adds what lies on edges to the loads of the step, forces by (43), and what presses with the D of
 * bbm_set_middle; to K its `sinks`, and the stiffness of tension, see stability.c. */
void bbm_gather_edge_loads(bbm_model *m)
{
    bbm_beyond *b = m->beyond;

    for (int l = 0; l < b->edge_loads; l++) {
        bbm_edge_load *load = &b->edge_load[l];
        const bbm_vertex *v = &m->vertex[load->a];
        const bbm_element *e = &m->element[v->element];
        double *F = &m->load[6 * v->element], *N = load->N, (*K)[6] = load->sinks;
        memset(N, 0, sizeof load->N);
        memset(K, 0, sizeof load->sinks);
        memset(load->turns, 0, sizeof load->turns);
        bbm_constant_load_submatrix(e, v, &m->vertex[bbm_next_vertex(e, load->a)], load->f, F);
        for (int r = 0; r < 2; r++)
            press(m, load, r, b->middle[v->element].D, N, K, load->turns);
        for (int k = 0; k < 36; k++)
            N[k / 6] += K[k / 6][k % 6] * b->middle[v->element].D[k % 6];
        for (int k = 0; k < 6; k++)
            F[k] += N[k];
        bbm_matrix_add(m->K, v->element, v->element, K);
    }
    for (int i = 0; i < m->elements; i++)
        m->K->D[m->K->place[i]][2][2] += bbm_tension_stiffness(m, i);
}

/* Puts what presses at the solution in the place of what was taken for it among the loads. Returns
 * the most by which the two differ beyond SETTLED of the load, N. */
double bbm_settle_loads(bbm_model *m)
{
    double most = 0;

    for (int l = 0; l < m->beyond->edge_loads; l++) {
        bbm_edge_load *load = &m->beyond->edge_load[l];
        const int i = m->vertex[load->a].element;
        double N[6] = { 0 }, K[6][6] = { { 0 } }, off[6];
        for (int r = 0; r < 2; r++)
            press(m, load, r, &m->D[6 * i], N, K, K);
        for (int k = 0; k < 6; k++) {
            off[k] = N[k] - load->N[k];
            m->load[6 * i + k] += off[k];
            load->N[k] = N[k];
        }
        for (int k = 0; k < 36; k++)
            off[k / 6] += load->sinks[k / 6][k % 6] * m->D[6 * i + k % 6];
        const double all = hypot(N[0], N[1]) + weight_of(m, load) * m->element[i].A;
        most = fmax(most, hypot(off[0], off[1]) - SETTLED * all);
    }
    return most;
}

/* ------------------------------------------------------------------------------------- supports */

/* Displaces the wall point of a node that is held, by the end of the next step. */
bbm_status bbm_move_support(bbm_model *m, int node, double u, double v)
{
    if (!m->is_prepared || node < 0 || node >= m->nodes || !m->node[node].held)
        return bbm_fail(m, BBM_BAD_INDEX, "moved support %d of %d nodes, expected a held one of a "
                        "prepared model", node, m->nodes);
    if (!isfinite(u) || !isfinite(v))
        return bbm_fail(m, BBM_NOT_FINITE, "the way of support %d", node);
    bbm_support *s = &m->beyond->support[node];
    const double to[2] = { u, v };

    for (int a = 0; a < 2; a++) {
        s->moved[a] += to[a] - (s->moved[a] != 0 ? s->to[a] : m->node[node].wall[a]);
        s->to[a] = m->node[node].wall[a] = to[a];
    }
    return BBM_OK;
}

/* What is held all round has the velocity of its supports: V of element e by that of each node in
 * each direction; NULL: the mean one of the step. */
void bbm_follow_supports(const bbm_model *m, bbm_element *e,
                         double (*velocity)(const bbm_model *m, int node, int direction))
{
    const double f = m->beyond->share / m->h;

    memset(e->V, 0, sizeof e->V);
    for (int k = 0; k < e->n; k++) {
        const bbm_linear of = bbm_interpolation(e, &m->vertex[e->first], k);
        const int n = m->vertex[e->first + k].node;
        const double *moved = m->beyond->support[n].moved;
        const double u = velocity ? velocity(m, n, 0) : f * moved[0];
        const double v = velocity ? velocity(m, n, 1) : f * moved[1];
        const double V[6] = { of.f * u, of.f * v, (of.fx * v - of.fy * u) / 2,
                              of.fx * u, of.fy * v, of.fy * u + of.fx * v };
        for (int a = 0; a < 6; a++)
            e->V[a] += V[a];
    }
}

static void take_along(bbm_model *m)
{
    for (int i = 0; i < m->elements; i++)
        if (bbm_is_held_all_round(m, &m->element[i]))
            bbm_follow_supports(m, &m->element[i], NULL);
}

/* A node is held from now on: it holds each of its corners where that is. */
static void catch_node(bbm_model *m, int n, int directions)
{
    m->beyond->support[n].caught |= directions;
    for (int c = 2 * m->adjacent_first[n]; c < 2 * m->adjacent_first[n + 1]; c++) {
        const bbm_vertex *P = &m->vertex[m->adjacent[c / 2]];
        const int a = c % 2;
        if (directions & 1 << a)
            m->beyond->off[m->adjacent[c / 2]][a] = (a ? P->v : P->u) - m->node[n].wall[a]
                                                  + m->beyond->support[n].moved[a];
    }
}

/* Puts the wall points where they are at the end of the part of a step in hand: the rest of their
 * way is left. The velocity of a node that is held from now on counts as that of its support so
 * far: such nodes are caught. */
void bbm_place_supports(bbm_model *m)
{
    for (int n = 0; n < m->nodes; n++) {
        bbm_support *s = &m->beyond->support[n];
        const bbm_vertex *P = &m->vertex[m->adjacent[m->adjacent_first[n]]];
        const bbm_element *e = &m->element[P->element];
        const int anew = m->node[n].held & ~s->held;
        if (m->info.step > 0)
            catch_node(m, n, anew);
        double v[2];
        bbm_displacement(e, e->V, P->x, P->y, v);
        for (int a = 0; a < 2; a++) {
            s->rate[a] = anew & 1 << a ? v[a] : s->rate[a];
            if (s->moved[a] != 0)
                m->node[n].wall[a] = s->to[a] - (1 - m->beyond->share) * s->moved[a];
        }
        s->held = m->node[n].held;
    }
    take_along(m);
}

/* The forces of the supports on their nodes, of the solution, and in a step their work at each
 * element: a node may lie in several bodies. What is held all round adds its weight, which is no
 * part of (5): a corner bears its share in the value of a linear function at the barycentre, so
 * that the moments of all are that of the weight. The gap of an edge is the mean of those of its
 * ends, (d1 + d2)/2, or how they differ, (d1 - d2)/2; of a point both ends are one. */
void bbm_find_reactions(bbm_model *m)
{
    const int jumps = m->beyond->jump_of != NULL;
    const double share = jumps ? 0 : m->beyond->share;
    bbm_support *s = m->beyond->support;

    for (int i = 0; i < m->elements; i++)
        memset(&m->beyond->account[i].held[jumps], 0, (size_t)(2 - jumps) * sizeof(double));
    for (int n = 0; n < m->nodes; n++)
        memset(s[n].part[jumps], 0, (size_t)(2 - jumps) * sizeof *s[n].part);
    for (int v = 0; v < m->vertices && !jumps; v++) {
        const int i = m->vertex[v].element;
        const bbm_element *e = &m->element[i];
        double W[6] = { 0 };
        bbm_gravity_submatrix(e, m->acceleration, W);
        for (int a = 0; a < 2 && m->K->body[i] < 0; a++)
            s[m->vertex[v].node].part[0][a] -=
                bbm_interpolation(e, &m->vertex[e->first], v - e->first).f * W[a];
    }
    for (const bbm_gap *g = m->gap; g < m->gap + m->gaps; g++) {
        double d[2];
        if (g->j >= 0)
            continue;
        bbm_gap_length(m, g, d);
        for (int a = 0; a < 2; a++) {
            const double half = (g->own.f[a] + g->W[a][0] * d[0] + g->W[a][1] * d[1]) / 2;
            s[g->node[0]].part[jumps][a] -= half;
            s[g->node[1]].part[jumps][a] -= g->elastic ? -half : half;
            m->beyond->account[g->i].held[0] -= share * half
                * (s[g->node[0]].moved[a] + (g->elastic ? -1 : 1) * s[g->node[1]].moved[a]);
        }
    }
}

/* The step, or a part of it, is done, and what is left of the way is left. What presses did so with
 * the stress that elements have now. */
void bbm_stop_supports(bbm_model *m)
{
    bbm_beyond *b = m->beyond;

    take_along(m);
    for (int i = 0; i < m->elements; i++)
        b->account[i].pressed = 0;
    for (int l = 0; l < b->edge_loads; l++) {
        const bbm_edge_load *load = &b->edge_load[l];
        b->account[m->vertex[load->a].element].pressed += load->N[3] + load->N[4];
    }
    for (int n = 0; n < m->nodes; n++)
        for (int a = 0; a < 2; a++) {
            bbm_support *s = &b->support[n];
            s->earlier[a] = s->rate[a];
            s->rate[a] = bbm_is_static(m) ? 0 : b->share * s->moved[a] / m->h;
            s->moved[a] -= b->share * s->moved[a];
            s->force[a] = s->part[0][a] + s->part[1][a];
        }
    b->h_before = m->h;
    b->left -= m->h / m->par.dt;
}

/* --------------------------------------------------------------------------------- plane strain */

/* All elements of a prepared model that are not yet in plane strain. */
void bbm_set_plane_strain(bbm_model *m)
{
    for (bbm_element *e = m->element; e < m->element + m->elements; e++)
        if (e->out_of_plane == 0) {
            bbm_material *a = &e->material;
            a->E /= 1 - a->nu * a->nu;
            a->nu /= 1 - a->nu;
            e->out_of_plane = a->nu / (1 + a->nu);
        }
}
