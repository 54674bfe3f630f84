/* bending.c - bonds with which quadrilaterals bend.
 *
 * Beyond the paper. Two quadrilaterals that bend open, at the ends of their edge, the gaps d1 and
 * d2 = -d1, for no D bends. Springs at the ends forbid that: the mesh locks. Seen as one bond of
 * the whole edge the two springs k are two gaps of their own, the mean d = (d1 + d2)/2 and the
 * opening dd = (d1 - d2)/2, with the energy
 *
 *     Pi = 1/2 d.K d + 1/2 dd.M dd,      K = M = 2 k I.
 *
 * K stands for a rigid joint and stays. M is made only as large as the bending stiffness that the
 * elements lack: the bond is rigid in its middle and bends as the material would. With M = 0 a grid
 * of rectangles w_i x h_j would be loose: if element i, j turns about its centre by (-1)^(i+j)
 * c/(w_i h_j), all middles stay together. A fixed edge is a bond with the wall, whose mirror image
 * bends alike. A triangle does not bend: beside it a quadrilateral bends as at the wall. A fixed
 * node is the mean of its corners, as it is for loads.
 */
#include "beyond.h"

/* ------------------------------------------------------------------------ the moment of an edge */

/* Condenses the symmetric W to its first rows: minimises the energy 1/2 x.W x over all other
 * unknowns, from the last one on. Their pivots are left on the diagonal. */
void bbm_condense(int n, int rows, double *W)
{
    for (int p = n - 1; p >= rows; p--) {
        const double scale = 1 / W[p * n + p];
        for (int a = 0; a < p; a++)
            for (int b = 0; b < p; b++)
                W[a * n + b] -= W[a * n + p] * W[p * n + b] * scale;
    }
}

/* The stiffness of a quadrilateral x = c + xi p + eta q, -1/2 <= xi, eta <= 1/2, against the
 * bending that D lacks, u = h xi eta + a xi^2/2 + b eta^2/2 with h, a, b vectors (Wilson's
 * incompatible modes: Taylor, Beresford, Wilson, Int. J. Num. Meth. Eng. 10, 1976). Its gradient
 * is xi (a gx + h gy) + eta (h gx + b gy) with gx, gy the gradients of xi and eta, its strain
 * xi Ex + eta Ey; W = t A/12 (Ex^T E Ex + Ey^T E Ey). What the two bonds that p crosses and the
 * two that q crosses feel is dd = h/2, therefore S = 4 (W condensed to h), the first two rows and
 * columns of what is 0 on entry. */
static void bending_stiffness(const bbm_element *e, const double p[2], const double q[2],
                              double S[6][6])
{
    const double det = p[0] * q[1] - p[1] * q[0], tA = e->material.thickness * e->A;
    const double gx[2] = { q[1] / det, -q[0] / det }, gy[2] = { -p[1] / det, p[0] / det };
    const double strain[2][3][6] = {
        /*  hx     hy       ax     ay       bx     by */
        { { gy[0], 0,       gx[0], 0,       0,     0     },     /* Ex: strain ex */
          { 0,     gy[1],   0,     gx[1],   0,     0     },     /*     ey        */
          { gy[1], gy[0],   gx[1], gx[0],   0,     0     } },   /*     gxy       */
        { { gx[0], 0,       0,     0,       gy[0], 0     },     /* Ey            */
          { 0,     gx[1],   0,     0,       0,     gy[1] },
          { gx[1], gx[0],   0,     0,       gy[1], gy[0] } },
    };
    double E[3][3];

    bbm_elastic_matrix(&e->material, E);
    for (int k = 0; k < 18; k++) {
        const double *left = strain[k % 2][k / 6], *right = strain[k % 2][k / 2 % 3];
        const double f = 4 * tA / 12 * E[k / 6][k / 2 % 3];
        for (int a = 0; a < 6 && f != 0; a++)
            for (int b = 0; b < 6 && left[a] != 0; b++)
                S[a][b] += f * left[a] * right[b];
    }
    bbm_condense(6, 2, S[0]);
}

/* A quadrilateral's share in the moments of its bonds: M[0] for the edges 0 and 2 (from vertex 0
 * to 1, from 2 to 3), which q crosses, M[1] for 1 and 3, which p crosses.
 *
 * A row along p that bends turns its edges q, which opens them along r, at right angles to q. Its
 * stress acts along p: S r = c p. In the same way S s = d q for s at right angles to p. So
 *
 *     M[1] = S r r^T S/(r.S r) = c p p^T/(p.r),      M[0] = S - M[1] = d q q^T/(q.s):
 *
 * for a rectangle the bending stiffness of the edge as a beam's section, E t l^3/12 over the
 * distance w of the centres. A row needs no bond on its other edges to bend so. */
void bbm_bending_moments(const bbm_element *e, const bbm_vertex v[], double M[2][2][2])
{
    const double p[2] = { (v[1].x + v[2].x - v[0].x - v[3].x) / 2,
                          (v[1].y + v[2].y - v[0].y - v[3].y) / 2 };
    const double q[2] = { (v[2].x + v[3].x - v[0].x - v[1].x) / 2,
                          (v[2].y + v[3].y - v[0].y - v[1].y) / 2 };
    double S[6][6] = { { 0 } };

    bending_stiffness(e, p, q, S);
    const double Sr[2] = { S[0][0] * q[1] - S[0][1] * q[0], S[1][0] * q[1] - S[1][1] * q[0] };
    const double rSr = q[1] * Sr[0] - q[0] * Sr[1];
    for (int a = 0; a < 2; a++)
        for (int b = 0; b < 2; b++) {
            M[1][a][b] = Sr[a] * Sr[b] / rSr;
            M[0][a][b] = S[a][b] - M[1][a][b];
        }
}

/* ------------------------------------------------------------------------- the gaps of an edge */

/* Of an edge with the gaps d1 and d2 at its ends the gap (d1 + sign d2)/2 with the weight W. */
void bbm_edge_gap(const bbm_gap end[2], double sign, double W[2][2], bbm_gap *g)
{
    memcpy(g->W, W, sizeof g->W);
    g->elastic = sign < 0;
    for (int r = 0; r < 2; r++) {
        g->d0[r] = (end[0].d0[r] + sign * end[1].d0[r]) / 2;
        for (int a = 0; a < 6; a++) {
            g->Ti[r][a] = (end[0].Ti[r][a] + sign * end[1].Ti[r][a]) / 2;
            g->Tj[r][a] = (end[0].Tj[r][a] + sign * end[1].Tj[r][a]) / 2;
        }
    }
}

/* Lists both gaps of an edge of element i, held in the given directions; j = -1: by the wall. */
static void list_edge(bbm_model *m, int i, int j, const bbm_gap end[2], int directions, double k,
                      double M[2][2])
{
    double W[2][2][2] = { { { 2 * k, 0 }, { 0, 2 * k } } };

    memcpy(W[1], M, sizeof W[1]);
    for (int which = 0; which < 2; which++) {
        for (int a = 0; a < 4; a++)
            if (!(directions & 1 << a / 2) || !(directions & 1 << a % 2))
                W[which][a / 2][a % 2] = 0;
        bbm_gap *g = bbm_add_gap(m, i, j);
        for (int n = 0; n < 2 && j < 0; n++)
            g->node[n] = end[n].node[0];
        bbm_edge_gap(end, which == 0 ? 1 : -1, W[which], g);
    }
}

/* The moment M that a quadrilateral asks for on its edge from vertex v on; returns n.M n with the
 * normal n of the edge. Where steps are exact M belongs to the starting shape: it is constant then,
 * found once, and its forces have a potential. */
static double own_moment(const bbm_model *m, const bbm_element *e, int v, double M[2][2])
{
    const int edge = v - e->first, exact = e->middle != NULL;
    bbm_element shape = *e;
    bbm_vertex at[5];
    double now[2][2][2], (*own)[2][2] = exact ? m->beyond->middle[e - m->element].moment : now;

    shape.A = exact ? e->A0 : e->A;
    for (int k = 0; k < 5; k++) {
        at[k] = m->vertex[e->first + k % 4];
        at[k].x = exact ? m->node[at[k].node].x - m->origin[0] : at[k].x;
        at[k].y = exact ? m->node[at[k].node].y - m->origin[1] : at[k].y;
    }
    if (!exact || own[0][0][0] + own[0][1][1] == 0)
        bbm_bending_moments(&shape, at, own);
    memcpy(M, own[edge % 2], 4 * sizeof M[0][0]);
    const double nx = at[edge + 1].y - at[edge].y, ny = at[edge].x - at[edge + 1].x;
    return nx * nx * M[0][0] + nx * ny * (M[0][1] + M[1][0]) + ny * ny * M[1][1];
}

/* The moment M of a bond. The halves of its two elements bend one after the other, so their
 * moments act in series: with n the normal of the edge and mi = n.Mi n,
 *
 *     M = 2 (Mi + Mj) mi mj/(mi + mj)^2,
 *
 * whose n.M n is the harmonic mean; or 2 Mi, if j does not bend or is the wall, NULL. p, q: where
 * the edge starts in i and, the other way, in j. */
static void bond_moment(const bbm_model *m, const bbm_element *i, int p, const bbm_element *j,
                        int q, double M[2][2])
{
    double Mi[2][2] = { { 0 } }, Mj[2][2] = { { 0 } };
    const double mi = i->n == 4 ? own_moment(m, i, p, Mi) : 0;
    const double mj = j && j->n == 4 ? own_moment(m, j, q, Mj) : 0;
    const double sum = mi + mj, series = mi > 0 && mj > 0 ? 2 * (mi / sum) * (mj / sum) : 2;

    for (int a = 0; a < 4; a++)
        M[a / 2][a % 2] = series * (Mi[a / 2][a % 2] + Mj[a / 2][a % 2]);
}

/* M turns with the edge, by the mean turn r of its elements, and the opening d is measured in a
 * frame that does so. With R = R(r), t = tan(r/2) and dm the mean of d at the start and at the end
 *
 *     R^T d = d0 + H (Ti Di - Tj Dj - 2 t J dm),      H = (1 + R^T)/2 = [1 t; -t 1]/(1 + t^2),
 *
 * is linear in D as T_m is, see rotation.c. */
void bbm_turn_opening(const bbm_element *i, const bbm_element *j, bbm_gap *g)
{
    const double *Di = i->middle->D, *Dj = j->middle->D;
    const double r = (Di[2] + Dj[2]) / 2, t = tan(r / 2), f = r == 0 ? 1 : 2 * t / r;
    double d[2] = { g->d0[0], g->d0[1] }, (*W)[2] = g->W, M[3] = { W[0][0], W[1][1], W[0][1] };

    bbm_turn_tensor(M, (i->sum[2] + j->sum[2]) / 2);
    W[0][0] = M[0], W[1][1] = M[1], W[0][1] = W[1][0] = M[2];
    for (int a = 0; a < 12; a++)
        d[a / 6] += (g->Ti[a / 6][a % 6] * Di[a % 6] - g->Tj[a / 6][a % 6] * Dj[a % 6]) / 2;
    for (int side = 0; side < 2; side++) {
        double (*T)[6] = side ? g->Tj : g->Ti;
        T[0][2] += (side ? -f : f) / 2 * d[1];
        T[1][2] -= (side ? -f : f) / 2 * d[0];
        for (int a = 0; a < 6; a++) {
            const double x = T[0][a];
            T[0][a] = (x + t * T[1][a]) / (1 + t * t);
            T[1][a] = (T[1][a] - t * x) / (1 + t * t);
        }
    }
}

/* ----------------------------------------------------------------- contacts of shared corners */

/* The vertex that shares a corner of the boundary with v: one edge ends there and the next starts,
 * in elements that bonds join, from one to the next. A bond with a moment does not hold vertices
 * together, and bonds at vertices only do so as well as their springs can. The corner is halfway
 * between the two, and half of a force on it acts on each. If all of it acted on one element, the
 * bonds would carry half of it to the other, and that would strain both. A mirrored model would
 * choose the other element. */
int bbm_find_partner(const bbm_model *m, int v)
{
    const bbm_edge *e = &m->edge[bbm_edge_at(m, v)];

    return m->beyond->bonding != BBM_MOMENT ? v : v == e->a ? m->edge[e->before].b : e->a;
}

/* The vectors of a contact some of whose points P1, P2, P3 are shared. Each point moves by u, the
 * mean of what T D moves its two vertices by, or one and the same. With P1 - P0 = P1 - r P2 - (1 -
 * r) P3, r the anchor, a = (P1 - P0)/l and m = (P3 - P2)/l, as in bbm_shear_vectors
 *
 *     d = d0 + q1.u1 + q2.u2 + q3.u3,
 *     d_n: q1 = (y2 - y3, x3 - x2)/l,   q2 = (y3 - y1, x1 - x3)/l,   q3 = (y1 - y2, x2 - x1)/l,
 *     d_s: q1 = m,                      q2 = -r m - a,               q3 = (r - 1) m + a,
 *
 * all points in q those of the moment of T, and an element gets T^T q/2 of each vertex. */
void bbm_shared_vectors(const bbm_model *m, const bbm_contact *c, double r, bbm_spring v[2])
{
    const int P[3] = { m->edge[c->corner].a, m->edge[c->edge].b, m->edge[c->edge].a };
    const double turns = m->element[m->vertex[P[0]].element].middle ? 1 : 0;
    const double weight[3] = { 1, -r, r - 1 }, turn[3] = { 0, -turns, turns };
    double T[3][2][2][6], p[3][2] = { { 0 } }, at[2];
    bbm_point x[3];

    for (int k = 0; k < 6; k++) {
        const bbm_vertex *V = &m->vertex[k % 2 ? bbm_partner_of(m, P[k / 2]) : P[k / 2]];
        bbm_step_point(&m->element[V->element], V->x, V->y, T[k / 2][k % 2], at);
        p[k / 2][0] += at[0] / 2;
        p[k / 2][1] += at[1] / 2;
        x[k / 2] = bbm_point_at(m, P[k / 2]);
    }
    const double X = x[2].x - x[1].x, Y = x[2].y - x[1].y, l = hypot(X, Y);
    const double x1 = x[0].x - x[1].x, y1 = x[0].y - x[1].y;
    memset(v, 0, 2 * sizeof *v);
    v[0].d = (X * y1 - Y * x1) / l;
    v[1].d = ((x1 + weight[2] * X) * X + (y1 + weight[2] * Y) * Y) / l;
    for (int k = 0, more = 2; k < 3; k++) {
        const double *p2 = p[(k + 1) % 3], *p3 = p[(k + 2) % 3];
        const int shared = bbm_partner_of(m, P[k]) != P[k];
        for (int n = 0; n < 8; n++) {                   /* of each distance, vertex, direction */
            const int b = n % 2, other = n / 2 % 2;
            const double a = p[0][b] - p[2][b] - r * (p[1][b] - p[2][b]);
            const double q = (n < 4 ? b ? p3[0] - p2[0] : p2[1] - p3[1]
                              : weight[k] * (p[2][b] - p[1][b]) + turn[k] * a) / l;
            double *part = v[n / 4].v[other && shared ? more : k > 0];
            for (int i = 0; i < 6; i++)
                part[i] += T[k][other][b][i] * q / 2;
        }
        more += shared;
    }
}

/* The directions in which the edge of a quadrilateral from vertex v on is held: those of both its
 * ends. Held at its vertices, such an edge locks like a bond; but not that of an element that has
 * never had bonds, for it does not bend. What has lost its last bond is held as before, for to
 * change that would make energy. */
static int held_edge(const bbm_model *m, const bbm_element *e, int v)
{
    const int n = m->vertex[v].node, next = m->vertex[bbm_next_vertex(e, v)].node;
    const bbm_support *s = m->beyond->support;
    const int caught = m->is_prepared ? s[n].caught | s[next].caught : 0;
    int bonded = 0;

    for (int k = e->first; k < e->first + e->n; k++)
        bonded |= m->vertex[k].edge < 0
               || (m->is_prepared && m->vertex[k].edge >= m->beyond->edges);
    return m->beyond->bonding == BBM_VERTICES || e->n != 4 || !bonded
         ? 0 : m->node[n].held & m->node[next].held & ~caught;
}

/* A bond of a quadrilateral is one of its whole edge, every other one is the paper's. In the
 * directions in which the edge is held each of the two elements is held in its place. */
static void list_bond(bbm_model *m, const bbm_bond *b)
{
    const bbm_element *i = &m->element[b->i], *j = &m->element[b->j];
    const double k = bbm_bonding_stiffness(m->par.alpha, i, j);
    bbm_gap end[2];
    double M[2][2];

    if (m->beyond->bonding == BBM_VERTICES || (i->n != 4 && j->n != 4)) {
        bbm_list_bond(m, b);
        return;
    }
    for (int e = 0; e < 2; e++)
        bbm_bonding_gap(i, &m->vertex[b->p[e]], j, &m->vertex[b->q[e]], k, &end[e]);
    bond_moment(m, i, b->p[0], j, b->q[1], M);
    const int held = held_edge(m, i, b->p[0]) | held_edge(m, j, b->q[1]);
    list_edge(m, b->i, b->j, end, BBM_XY & ~held, k, M);
    if (i->middle)
        bbm_turn_opening(i, j, &m->gap[m->gaps - 1]);
}

/* The next after v of the corners that bonds join around a node. At the last one a boundary edge
 * starts; after it comes the first one, where the edge before that ends. */
static int next_corner(const bbm_model *m, int v)
{
    const int edge = m->vertex[v].edge;

    return edge < 0 ? -1 - edge : m->edge[m->edge[edge].before].b;
}

/* The node of a vertex. One that was caught on its way holds each where it was then. */
static bbm_node wall_of(const bbm_model *m, int v)
{
    bbm_node W = m->node[m->vertex[v].node];

    for (int a = 0; a < 2 && m->is_prepared; a++)
        W.wall[a] += m->beyond->off[v][a];
    return W;
}

/* Lists the part of vertex v in what holds its node, in the directions in which no edge is held
 * there. To hold every corner would clamp quadrilaterals, for where they bend their corners part.
 * So the mean d of the n corners is held. With their gaps d_i to the wall and K the sum of their
 * springs,
 *
 *     K d.d = sum_i K/n d_i.d_i - sum_{i<j} K/n^2 (d_i - d_j).(d_i - d_j):
 *
 * a spring holds each corner, and one of negative stiffness parts each two. Where an edge is held
 * the corner of a triangle is held by itself, and so are all of a node that has too many. Where a
 * bond softens or has broken nothing would hold the sides of the crack together, and each corner is
 * held. In dynamics it is from the start where bonds may break, since to catch a corner makes
 * energy. */
static void list_held_node(bbm_model *m, int v)
{
    const int i = m->vertex[v].element;
    bbm_node alone = wall_of(m, v), own = alone;
    int corners = 0, quadrilaterals = 0, w = v;
    double K = 0;

    do {
        const bbm_element *e = &m->element[m->vertex[w].element];
        const int before = w > e->first ? w - 1 : e->first + e->n - 1;
        alone.held &= ~(held_edge(m, e, w) | held_edge(m, e, before));
        quadrilaterals += e->n == 4;
        K += bbm_fixed_stiffness(m->par.alpha, e);
        corners++;
        w = next_corner(m, w);
    } while (w != v && corners <= BBM_JOINED);
    own.held &= m->element[i].n == 4 ? 0 : ~alone.held;
    bbm_list_fixed_point(m, v, &own);
    if (!alone.held || quadrilaterals == 0 || corners > BBM_JOINED
        || m->beyond->bonding == BBM_VERTICES
        || (m->beyond->bond_tension > 0 && !bbm_is_static(m))
        || (m->is_prepared && m->beyond->best[m->vertex[v].node] > 0)) {
        bbm_list_fixed_point(m, v, &alone);
        return;
    }
    const double k = K / corners;
    bbm_fixed_gap(&m->element[i], &m->vertex[v], &alone, k, bbm_add_gap(m, i, -1));
    while ((w = next_corner(m, w)) != v) {
        const int j = m->vertex[w].element;
        if (w < v)
            continue;
        bbm_gap *g = bbm_add_gap(m, i, j);
        bbm_bonding_gap(&m->element[i], &m->vertex[v], &m->element[j], &m->vertex[w], 0, g);
        const bbm_node other = wall_of(m, w);
        for (int a = 0; a < 2; a++) {
            g->d0[a] += other.wall[a] - alone.wall[a];
            g->W[a][a] = alone.held & 1 << a ? -k / corners : 0;
        }
    }
}

/* Lists what holds vertex v, which is held, and the edge from v on, where it is held, as a bond
 * with the wall: its moment is twice the element's own. */
static void list_fixed(bbm_model *m, int v)
{
    const int i = m->vertex[v].element;
    const bbm_element *e = &m->element[i];
    const int ends[2] = { v, bbm_next_vertex(e, v) };
    const int edge = held_edge(m, e, v);
    const double k = bbm_fixed_stiffness(m->par.alpha, e);
    bbm_gap end[2];
    double M[2][2];

    list_held_node(m, v);
    if (!edge)
        return;
    for (int n = 0; n < 2; n++)
        bbm_fixed_gap(e, &m->vertex[ends[n]], &m->node[m->vertex[ends[n]].node], k, &end[n]);
    bond_moment(m, e, v, NULL, 0, M);
    double turned[3] = { M[0][0], M[1][1], M[0][1] };
    bbm_turn_tensor(turned, e->middle ? e->sum[2] : 0);
    M[0][0] = turned[0], M[1][1] = turned[1], M[0][1] = M[1][0] = turned[2];
    list_edge(m, i, -1, end, edge, k, M);
}

/* What glues, with whole edges where quadrilaterals meet. */
void bbm_list_edge_gaps(bbm_model *m)
{
    for (int n = 0; n < m->nodes && m->is_prepared; n++)
        m->beyond->best[n] = 0;
    for (int b = 0; b < m->bonds; b++)
        if (!bbm_list_crack(m, b))
            list_bond(m, &m->bond[b]);
    for (int v = 0; v < m->vertices; v++)
        if (m->node[m->vertex[v].node].held)
            list_fixed(m, v);
}
