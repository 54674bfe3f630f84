/* surroundings.c - what the surroundings do to a body: loads on its edges, supports, plane strain.
 *
 * Beyond the paper, whose loads along a line, Eq. (38)-(43), lie between two grid points and keep
 * their direction. Where blocks share grid points, or an edge is known by its number alone, the
 * load belongs to one of the edges between them. The block lies on the left of an edge from a to b,
 * and a pressure p pushes that way, p (-(b - a)_y, (b - a)_x)/|b - a|, with the edge in the middle
 * of the step: its work is then p times the area that the edge sweeps. Still water up to the level
 * y = Y presses with density times gravity's size times Y - y, above the level with nothing. This y
 * is where the velocity would bring the edge by then: what is at rest feels the water of its depth.
 *
 * A fixed point is held to a wall point by a stiff spring and its multiplier: what these carry at
 * the end of the step is the force of the support, the reaction. In equilibrium the reactions
 * balance the loads. A wall point may be displaced between the steps. The support then does work:
 * its force at the end of the step times its way, as for the loads. (Newmark with beta = 1/2,
 * gamma = 1 takes the forces at the end, see energy.c.)
 *
 * The paper's plates are free to strain along the axis, out of the plane: plane stress. A slice of
 * a long dam or tunnel is not. With ezz = 0 Hooke's law (7) is the same in the plane with
 *
 *     E/(1 - nu^2) in place of E,      nu/(1 - nu) in place of nu
 *
 * (Timoshenko and Goodier, Theory of Elasticity, chapter 2), G stays, and out of the plane there is
 * szz = nu (sx + sy), with n = nu/(1 - nu): nu = n/(1 + n).
 */
#include <string.h>

#include "beyond.h"

/* ----------------------------------------------------------------------------- loads on an edge */

/* p = c[0] + c[1] s for the depths below the level (negative: above it) at both ends. Along an edge
 * displacements are linear in the way s, so that force and moment are all that an element feels: an
 * edge that the level crosses gets the p that has the same two,
 *     int p ds = c0 + c1/2,  int p s ds = c0/2 + c1/3. */
static void press(double depth_a, double depth_b, double c[2])
{
    const double most = fmax(depth_a, depth_b), least = fmin(depth_a, depth_b);

    c[0] = depth_a;
    c[1] = depth_b - depth_a;
    if (least >= 0)
        return;
    const double wet = most > 0 ? most / (most - least) : 0;    /* share of the edge */
    const double force = fmax(most, 0) * wet / 2;
    const double s = depth_a > depth_b ? wet / 3 : 1 - wet / 3; /* where that acts */
    c[1] = 12 * force * s - 6 * force;
    c[0] = force - c[1] / 2;
}

/* What lies on the edge in the step, which adds to F of its element, Eq. (42). */
static void add_load(const bbm_model *m, bbm_edge_load *load, double F[6])
{
    const bbm_vertex *a = &m->vertex[load->a];
    const bbm_element *e = &m->element[a->element];
    const bbm_vertex *b = &m->vertex[bbm_next_vertex(e, load->a)];
    const double weight = load->density * hypot(m->par.gravity[0], m->par.gravity[1]);
    const double half = bbm_is_static(m) ? 0 : m->h / 2;
    double T[2][6], am[2], bm[2], va[2], vb[2], c[2];

    bbm_step_point(e, a->x, a->y, T, am);
    bbm_step_point(e, b->x, b->y, T, bm);
    bbm_displacement(e, e->V, a->x, a->y, va);
    bbm_displacement(e, e->V, b->x, b->y, vb);
    press(load->level - a->y - half * va[1], load->level - b->y - half * vb[1], c);
    for (int g = 0; g < BBM_GAUSS; g++) {
        double s, share;
        bbm_gauss_point(g, &s, &share);
        const double p = (load->pressure + weight * (c[0] + c[1] * s))
                         / hypot(b->x - a->x, b->y - a->y);
        load->q[g][0] = load->f[0] - p * (bm[1] - am[1]);
        load->q[g][1] = load->f[1] + p * (bm[0] - am[0]);
    }
    bbm_varying_load_submatrix(e, a, b, (const double (*)[2])load->q, F);
}

/* Adds a load on a boundary edge of the prepared model. */
static bbm_status add(bbm_model *m, int edge, bbm_edge_load load)
{
    bbm_beyond *b = m->beyond;
    double F[6] = { 0 };

    if (m->status)
        return m->status;
    if (!m->K || edge < 0 || edge >= m->edges)
        return m->status = bbm_fail(m, BBM_BAD_INDEX, "loaded edge %d of %d", edge, m->edges);
    if (!isfinite(load.f[0] + load.f[1] + load.pressure + load.level * load.density))
        return m->status = bbm_fail(m, BBM_NOT_FINITE, "the load of edge %d", edge);
    load.a = m->edge[edge].a;
    add_load(m, &load, F);
    return m->status = bbm_append(m, (void **)&b->edge_load, &b->edge_loads, sizeof load, &load,
                                  NULL);
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

/* Adds them to the loads of the step, and to K what forces get by turning under tension, see
 * stability.c. */
void bbm_gather_edge_loads(bbm_model *m)
{
    for (int l = 0; l < m->beyond->edge_loads; l++) {
        bbm_edge_load *load = &m->beyond->edge_load[l];
        add_load(m, load, &m->load[6 * m->vertex[load->a].element]);
    }
    for (int i = 0; i < m->elements; i++)
        m->K->D[m->K->place[i]][2][2] += bbm_tension_stiffness(m, i);
}

/* ------------------------------------------------------------------------------------- supports */

/* Displaces the wall point of a node that is held, by the end of the next step. */
void bbm_move_support(bbm_model *m, int node, double u, double v)
{
    bbm_support *s = &m->beyond->support[node];
    const double to[2] = { u, v };

    for (int a = 0; a < 2; a++) {
        s->moved[a] += to[a] - (s->moved[a] != 0 ? s->to[a] : m->node[node].wall[a]);
        s->to[a] = m->node[node].wall[a] = to[a];
    }
}

/* Puts the wall points where they are at the end of the part of a step in hand: the rest of their
 * way is left. The velocity with which a node comes that is held from now on counts as that of its
 * support so far. */
void bbm_place_supports(bbm_model *m)
{
    const double left = 1 - m->beyond->share;

    for (int n = 0; n < m->nodes; n++) {
        bbm_support *s = &m->beyond->support[n];
        const bbm_vertex *P = &m->vertex[m->adjacent[m->adjacent_first[n]]];
        const bbm_element *e = &m->element[P->element];
        const int anew = m->node[n].held & ~s->held;
        double v[2];
        bbm_displacement(e, e->V, P->x, P->y, v);
        for (int a = 0; a < 2; a++) {
            s->rate[a] = anew & 1 << a ? v[a] : s->rate[a];
            s->jump[a] = 0;
            if (s->moved[a] != 0)
                m->node[n].wall[a] = s->to[a] - left * s->moved[a];
        }
        s->held = m->node[n].held;
    }
}

/* The force of a support on its node, in the step or in the jump. */
static double *force_of(const bbm_model *m, int node)
{
    return m->beyond->jump_of ? m->beyond->support[node].jump : m->beyond->support[node].force;
}

/* The forces of the supports on their nodes, of the solution, and in a step their work at each
 * element: a node may lie in several bodies. The gap of an edge is the mean of those of its ends,
 * (d1 + d2)/2, or how they differ, (d1 - d2)/2; of a point both ends are one. */
void bbm_find_reactions(bbm_model *m)
{
    const bbm_support *s = m->beyond->support;
    const double share = m->beyond->jump_of ? 0 : m->beyond->share;

    for (int i = 0; i < m->elements; i++)
        m->beyond->account[i].held *= share == 0;
    for (int n = 0; n < m->nodes; n++)
        memset(force_of(m, n), 0, 2 * sizeof *force_of(m, n));
    for (int k = 0; k < m->gaps; k++) {
        bbm_gap *g = &m->gap[k];
        double d[2];
        if (g->j >= 0)
            continue;
        bbm_gap_length(m, g, d);
        for (int a = 0; a < 2; a++) {
            const double half = (g->own.f[a] + g->W[a][0] * d[0] + g->W[a][1] * d[1]) / 2;
            force_of(m, g->node[0])[a] -= half;
            force_of(m, g->node[1])[a] -= g->elastic ? -half : half;
            m->beyond->account[g->i].held -= share * half
                * (s[g->node[0]].moved[a] + (g->elastic ? -1 : 1) * s[g->node[1]].moved[a]);
        }
    }
}

/* The step, or a part of it, is done, and what is left of the way is left. */
void bbm_stop_supports(bbm_model *m)
{
    bbm_beyond *b = m->beyond;

    for (int n = 0; n < m->nodes; n++)
        for (int a = 0; a < 2; a++) {
            bbm_support *s = &b->support[n];
            s->rate[a] = bbm_is_static(m) ? 0 : b->share * s->moved[a] / m->h;
            s->moved[a] -= b->share * s->moved[a];
            s->force[a] += s->jump[a];
        }
    b->h_before = m->h;
    b->left -= m->h / m->par.dt;
}

/* --------------------------------------------------------------------------------- plane strain */

/* All elements of a prepared model that are not yet in plane strain. */
void bbm_set_plane_strain(bbm_model *m)
{
    for (int i = 0; i < m->elements; i++) {
        bbm_material *a = &m->element[i].material;
        if (m->element[i].out_of_plane != 0)
            continue;
        a->E /= 1 - a->nu * a->nu;
        a->nu /= 1 - a->nu;
        m->element[i].out_of_plane = a->nu / (1 + a->nu);
    }
}
