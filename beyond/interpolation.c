/* interpolation.c - the coarse space of a model: the nodes of coarse.c, and what they move.
 *
 * The nodes are the corners of the elements, one where bonds tie corners together, and an element
 * follows its corners: by the displacement, linear in x and y, that is nearest to theirs. Whatever
 * opens no stiff bond has to be in this space, or is left to SSOR, which is slow if it is smooth.
 * Triangles bonded at their corners are all right. Quadrilaterals bonded in the middles of their
 * sides follow the means of their corners over the sides, which is exact: a linear displacement is
 * the same sum over both pairs of opposite middles, and so are such means. But there are others
 * that open almost none. In a grid let element i, j be displaced by
 *
 *     (-1)^(i+j) (a s + b t),      -1/2 <= s, t <= 1/2 across the element,  a, b any smooth fields.
 *
 * At a common side both neighbours do the same but for the change of a or b from one to the next:
 * the gaps are differences of a along s, and of b along t. No sweep sees much of that, and the
 * finer the mesh, or the stiffer the bonds, the less. Nodes that move by f to and fro by turns, f
 * smooth, make a = df/dt, b = df/ds, which opens no gap; that is in the space. Orthogonal to these
 * are a = dg/ds, b = -dg/dt, which no nodes make. For them coarse.c gives each quadrilateral two
 * modes of its own.
 */
#include "beyond.h"

/* Elements that a wave crosses in a step, from which on two levels solve faster than one: measured,
 * with blocks of 2 to 300 elements they break even at 1 to 4. */
#define CROSSED 3.0

/* Bonds an element, from which on modes pay: blocks of 7 x 7 have as many. Measured: with blocks of
 * 2 x 2 a step takes 1.2 times as long, of 7 x 7 as long, of 12 x 12 half. */
#define MANY_BONDS (12 / 7.0)

/* The unknowns r0, ex, ey, gxy of a linear displacement are Q times its slopes ux, uy, vx, vy. With
 * T of (2), where D = 0, they are (vx - uy)/2, ux, vy and uy + vx. With T_m of rotation.c for an
 * element that moves by D, with t = tan(r0/2), q = 1/(1 + t^2), p = t q, the slopes of r and e are
 *
 *     G = r (2 t/r0) J (1 + R(r0) (1 + e(D)))/2 + (1 + t J) e,
 *
 * and the product q (1 - t J) G has the skew part r (2 t/r0) q (1 + (ex + ey)/4) J, and as its
 * symmetric part e and r (t/r0) q [-gxy/2 - t ex, (ex - ey - t gxy)/2; ..., gxy/2 - t ey]. */
void bbm_slopes(const double D[6], double Q[4][4])
{
    const double t = tan(D[2] / 2), q = 1 / (1 + t * t), p = t * q, f = t == 0 ? 1 : 2 * t / D[2];
    const double skew = 1 / (2 * f * (1 + (D[3] + D[4]) / 4)), share = f * q / 2;
    const double turn[4] = { -t * skew, -skew, skew, -t * skew };
    const double of_turn[3] = { share * (-D[5] / 2 - t * D[3]), share * (D[5] / 2 - t * D[4]),
                                share * (D[3] - D[4] - t * D[5]) };
    const double strain[3][4] = { { q, 0, p, 0 }, { 0, -p, 0, q }, { -p, q, q, p } };

    memcpy(Q[0], turn, sizeof turn);
    for (int a = 0; a < 12; a++)
        Q[1 + a / 4][a % 4] = strain[a / 4][a % 4] - of_turn[a / 4] * turn[a % 4];
}

/* What the displacement of corner a alone does to the element, its P: of the
 * displacements linear in x, y the one nearest to the means of the corners' over the n sides, by
 * least squares; on a triangle, and for a quadrilateral's middles, it is exact. Fitted about the
 * mean of the corners, a linear function has the value mean(u) there and, with d_k the middle of
 * side k from there, u_k that mean and M = sum d d^T, the gradient g = M^-1 sum_k d_k u_k:
 *     u_a adds ux = g_x, uy = g_y, v_a the same to v. */
bbm_linear bbm_interpolation(const bbm_element *e, const bbm_vertex v[], int a)
{
    double x = 0, y = 0, xx = 0, yy = 0, xy = 0, X = 0, Y = 0;

    for (int k = 0; k < e->n; k++) {
        x += v[k].x / e->n;
        y += v[k].y / e->n;
    }
    for (int k = 0; k < e->n; k++) {
        const int next = (k + 1) % e->n;
        const double dx = (v[k].x + v[next].x) / 2 - x, dy = (v[k].y + v[next].y) / 2 - y;
        const double share = (k == a || next == a) / 2.0;
        xx += dx * dx;
        yy += dy * dy;
        xy += dx * dy;
        X += share * dx;
        Y += share * dy;
    }
    const double det = xx * yy - xy * xy;
    const double gx = (yy * X - xy * Y) / det, gy = (xx * Y - xy * X) / det;
    return (bbm_linear){ 1.0 / e->n + gx * (e->x - x) + gy * (e->y - y), gx, gy };
}

/* Where each vertex lies: in its component of K, and in a square round this, which is halved again
 * and again, left and right and then below and above. From its first bit on, what place[v] is more
 * than BBM_PLACES times the component says in which half. */
static void find_places(const bbm_model *m, bbm_box *box, long long *place)
{
    for (int k = 0; k < m->elements; k++)
        box[k] = bbm_empty_box(k);
    for (int k = 0; k < m->vertices; k++)
        bbm_widen_box(&box[m->K->component[m->vertex[k].element]], m->vertex[k].x,
                      m->vertex[k].y, 0);
    for (int k = 0; k < m->vertices; k++) {
        const int component = m->K->component[m->vertex[k].element];
        const bbm_box *b = &box[component];
        const double size = fmax(b->high[1] - b->low[1], b->high[2] - b->low[2]) / 32767;
        const int x = (int)fmin(32767, (m->vertex[k].x - b->low[1]) / size);    /* or no number */
        const int y = (int)fmin(32767, (m->vertex[k].y - b->low[2]) / size);
        place[k] = BBM_PLACES * component;
        for (int bit = 1; bit <= 1 << 14; bit *= 2)
            place[k] += bit * (2 * (x & bit) + (y & bit));
    }
}

/* A coarse space for a new K: corners that bonds tie together are one node; one that softens or has
 * broken ties none. An element without bonds is in it, too, if it lies against others with bonds:
 * left out, it is to them a stiff block that only SSOR moves. Where nothing is bonded, there would
 * be as many coarse unknowns as there are others; an element held at every corner hardly moves; in
 * short steps inertia holds every element by itself, and SSOR alone needs no more iterations than a
 * wave, of speed sqrt(E/density), needs to cross some elements. SSOR is faster for all three. An
 * element has modes if it is a quadrilateral bonded in its middles, in a model of many, and no part
 * of a single row, which bends by the moments of its bonds alone. */
bbm_status bbm_lay_out_coarse(bbm_model *m)
{
    const size_t v = (size_t)m->vertices, n = (size_t)m->elements;
    int *up = calloc(4 * v + 3 * n + 1, sizeof *up), nodes = 0;
    long long *place = calloc(v, sizeof *place);
    bbm_box *box = malloc(n * sizeof *box);

    if (!up || !place || !box)
        return free(up), free(place), free(box), BBM_NO_MEMORY;
    int *number = up + v, *node = number + v, *first = node + v;
    int *worth = first + n + 1;                                     /* [components of K] */
    int *middles = worth + n, *held = middles + n;
    for (int k = 0; k < m->vertices; k++)
        up[k] = k;
    for (int k = 0; k < m->bonds; k++) {
        const bbm_bond *b = &m->bond[k];
        for (int end = 0; end < 2 && bbm_tooth_of(m, k) == 0; end++)
            up[bbm_root_of(up, b->q[end])] = bbm_root_of(up, b->p[end]);
        const bbm_element *e = &m->element[b->i];
        const double way2 = e->material.E / e->material.density * m->par.dt * m->par.dt;
        worth[m->K->component[b->i]] |= way2 > CROSSED * CROSSED * e->A
                                            && !bbm_is_held_all_round(m, e);
    }
    find_places(m, box, place);
    for (int k = 0; k < m->vertices; k++)
        if (up[k] == k) {
            number[k] = nodes;
            place[nodes++] = place[k];
        }
    for (int k = 0; k < 3 * m->scratch->contacts; k++) {
        const bbm_contact *c = &m->scratch->contact[k / 3];
        const bbm_edge *e = &m->edge[k % 3 ? c->edge : c->corner];
        held[number[bbm_root_of(up, k % 3 == 2 ? e->b : e->a)]] = 1;
    }
    for (int i = 0; i < m->elements; i++) {
        const bbm_element *e = &m->element[i];
        const bbm_vertex *at = &m->vertex[e->first];
        const int in = worth[m->K->component[i]] && !bbm_is_held_all_round(m, e);
        for (int k = 0; k < in * e->n; k++) {
            const int of = number[bbm_root_of(up, e->first + k)];
            node[first[i] + k] = held[of] || m->node[at[k].node].held ? -1 - of : of;
        }
        first[i + 1] = first[i] + in * e->n;
        middles[i] = in && e->n == 4 && m->beyond->bonding != BBM_VERTICES
                  && m->bonds > MANY_BONDS * m->elements
                  && (at[0].edge < 0 || at[2].edge < 0) && (at[1].edge < 0 || at[3].edge < 0);
    }
    const bbm_status status = bbm_matrix_coarse(m->K, nodes, first, node, place, middles);
    free(up);
    free(place);
    free(box);
    return status;
}

/* The coarse space of the present geometry, unless it is that already. Elements that are not in it
 * are refused, which does no harm. */
void bbm_interpolate_elements(bbm_model *m)
{
    double Q[4][4];

    if (!m->K->extra || m->K->ready || m->par.pcg.method != &bbm_two_level)
        return;
    for (int i = 0; i < m->elements; i++) {
        const bbm_element *e = &m->element[i];
        bbm_slopes(e->middle ? e->middle->D : (double [6]){ 0 }, Q);
        for (int k = 0; k < e->n; k++)
            (void)bbm_matrix_interpolate(m->K, i, k, Q,
                                         bbm_interpolation(e, &m->vertex[e->first], k), e);
    }
}
