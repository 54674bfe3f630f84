/* joints.c - cohesion and tensile strength of unbroken joints, and joints of their own strength.
 *
 * Beyond the paper, whose contacts have friction alone. Where blocks touch at the start there is a
 * joint; cohesion and tensile strength act on its area, of which each contact stands for a share:
 * to both sides half the way to the next point that touches. The shares add up to the joint. A
 * contact has its share until it opens, or slips though it has a shear strength: from then on it
 * is 0. In statics it is 0 within the same step, and others have to bear what it bore.
 *
 * The strengths are those of the model, unless a joint is given for the two blocks: the first one
 * that fits counts.
 */

#include "beyond.h"

/* Straight sides that differ less in direction lie on each other, and points that are closer, in
 * lengths of their edge, are the same: rounding of a model file. */
#define PARALLEL 1e-2
#define SAME 1e-6

/* N. Of a joint that bears anything. */
#define ANY 1e100

/* The corner after (1) or before a corner, along one side. */
static int next_corner(const bbm_model *m, int c, int ends)
{
    const int held = m->edge[c].held[ends];
    const int e = held >= 0 ? held : ends ? c : m->edge[c].before;

    return ends ? m->edge[e].after : e;
}

/* The end of an edge, or of its whole straight side: the corner that starts it, or ends it. */
static int end_of_side(const bbm_model *m, int edge, int whole, int ends)
{
    int c = ends ? m->edge[edge].after : edge;

    while (m->edge[c].held[ends] >= 0 || (whole && m->edge[c].side != c))
        c = next_corner(m, c, ends);
    return c;
}

/* The share of a contact that touches at the start, as far as its own sides lie on the edge. The
 * next point is the next grid point of the side of which they touch, or the end of either side. */
static double joint_area(const bbm_model *m, int corner, int edge)
{
    const bbm_edge *e = &m->edge[edge];
    const double s = bbm_way_along(m, corner, edge), same = SAME * e->along.length;
    double length = 0;

    for (int ends = 0; ends < 2; ends++) {
        const int mine = ends ? corner : m->edge[corner].before;
        const bbm_direction t = m->edge[mine].along;
        if (fabs(t.x * e->along.y - t.y * e->along.x) > PARALLEL)
            continue;
        const int own = end_of_side(m, mine, !bbm_carries(m, mine, edge), ends);
        int other = end_of_side(m, edge, !bbm_carries(m, edge, mine), !ends);
        if (m->edge[other].side != other && fabs(bbm_way_along(m, other, edge) - s) <= same)
            other = next_corner(m, other, !ends);
        const double way = fmin(fabs(bbm_way_along(m, own, edge) - s),
                                fabs(bbm_way_along(m, other, edge) - s));
        length += way > same ? way / 2 : 0;         /* blocks across a corner have no joint */
    }
    return length * fmin(m->element[m->edge[corner].element].material.thickness,
                         m->element[e->element].material.thickness);
}

/* Adds a joint between two blocks, -1: any; angle in degrees, strengths in Pa; less than 0: the
 * model's. */
bbm_status bbm_add_joint(bbm_model *m, const int block[2], double friction, double cohesion,
                         double tension)
{
    bbm_beyond *b = m->beyond;

    if (!m->status && !(friction < 90 && cohesion < INFINITY && tension < INFINITY))
        m->status = bbm_fail(m, BBM_BAD_PARAMETER, "a joint with friction = %g, cohesion = %g, "
                             "tension = %g, expected finite ones, less than 90 degrees", friction,
                             cohesion, tension);
    const bbm_joint joint = { { block[0], block[1] }, friction, cohesion, tension };
    return m->status = m->status ? m->status
         : bbm_append(m, (void **)&b->joint, &b->joints, sizeof joint, &joint, NULL);
}

static double or_else(double own, double other) { return own < 0 ? other : own; }

static int fits(const int block[2], int i, int j)
{
    return (block[0] < 0 || block[0] == i) && (block[1] < 0 || block[1] == j);
}

/* The strength of a contact, by the first joint that fits its blocks, or that of the model. One
 * that touches at the start gets its share of the joint. */
void bbm_joint_strength(const bbm_model *m, bbm_contact *c)
{
    const int i = m->edge[c->corner].block, j = m->edge[c->edge].block;
    const bbm_beyond *b = m->beyond;
    bbm_joint joint = { { -1, -1 }, -1, -1, -1 };

    for (int k = b->joints - 1; k >= 0; k--)
        if (fits(b->joint[k].block, i, j) || fits(b->joint[k].block, j, i))
            joint = b->joint[k];
    if (c->trial.touches)
        c->area = joint_area(m, c->corner, c->edge);
    const double shear = or_else(joint.cohesion, b->cohesion) * c->area;
    const double tension = or_else(joint.tension, b->tension) * c->area;
    const double more = b->joints_hold && shear + tension > 0 ? ANY : 0;
    c->strength = (bbm_strength){ bbm_tangent(or_else(joint.friction, m->par.friction)),
                                  shear + more, tension + more };
}

/* Once all has settled in statics: breaks the joints that slide against their cohesion, and asks
 * for another pass if there are any. */
bbm_pass bbm_break_joints(bbm_model *m)
{
    bbm_pass next = BBM_PASS_DONE;

    for (bbm_contact *c = m->scratch->contact; c < bbm_end_of_contacts(m); c++)
        if (isinf(m->par.dt) && c->state == BBM_SLIDE && c->strength.shear > 0
            && bbm_shear_strength(&c->strength, c->N) > 0) {
            c->area = c->strength.shear = c->strength.tension = 0;
            m->scratch->passes = m->scratch->one_until = m->beyond->round = 0;
            next = BBM_PASS_AGAIN;
        }
    return next;
}
