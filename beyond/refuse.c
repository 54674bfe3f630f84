/* refuse.c - settings that mean nothing, and solutions that are none.
 *
 * A step whose elements go too far for what is linear in it, or whose contacts are too soft to keep
 * blocks apart is not a step: it ends in a message, and the model stays as it was.
 */

#include "beyond.h"

/* FAR_STRAIN [-]  what an element may strain in a step; of a static one without contacts and bolts
 *                 it is 1: the element has turned over
 * LINEAR [-]      the same of the only step of such a model, which is linear for loads of any size
 *                 whose squares are numbers
 * FAR_TURN [rad]  what an element may turn in a step: T of the middle of a step grows without bound
 *                 towards half a turn, the detection takes the way of a corner for that from its
 *                 start to its end, and what hangs on bolts may find another equilibrium behind it.
 *                 In a static step without contacts and bolts there is no bound
 * CURVE [-]       how far off the straight way from start to end a corner may be, as seen from an
 *                 edge that it may touch, against the smaller block: where it crosses the edge is
 *                 taken from the straight way
 * DEEP [-]        depth of a contact against the size of its smaller block at which its springs do
 *                 not keep the blocks apart any more */
#define FAR_STRAIN 0.5
#define LINEAR 1e100
#define FAR_TURN 1.0
#define CURVE 0.05
#define DEEP 0.1

/* Refuses settings that mean nothing. */
bbm_status bbm_check_settings(bbm_model *m)
{
    const bbm_beyond *b = m->beyond;
    const double most = nextafter(INFINITY, 0);
    const bbm_range range[] = {
        { "cohesion", b->cohesion, 0, most, "0 or more" },
        { "tension", b->tension, 0, most, "0 or more" },
        { "bond_tension", b->bond_tension, 0, most, "0 or more" },
        { "bond_cohesion", b->bond_cohesion, 0, most, "0 or more" },
        { "bond_friction", b->bond_friction, 0, nextafter(90, 0), "0 to less than 90 degrees" },
        { "bond_energy", b->bond_energy, 0, most, "0 or more" },
        { "reach", b->reach, 0, INFINITY, "0 or more" },
        { "multiplier_rounds", b->multiplier_rounds, 0, most, "0 or more" },
        { "restitution", b->restitution, -1, 1, "0 to 1, or -1 for none" },
        { "shake[0]", b->shake[0], -most, most, "a finite number" },
        { "shake[1]", b->shake[1], -most, most, "a finite number" },
        { "shake_omega", b->shake_omega, -most, most, "a finite number" },
    };

    return bbm_check_ranges(m, LENGTH(range), range);
}

/* Whether a closed contact turns an element too far. Its vectors mean nothing then, and what they
 * would close or open in the next pass does not either. */
int bbm_contact_turns_over(const bbm_model *m)
{
    int over = 0;

    for (const bbm_contact *c = m->scratch->contact; c < bbm_end_of_contacts(m); c++)
        for (int i = 0; i < c->parts; i++)
            over |= c->state != BBM_OPEN && !(fabs(m->D[6 * c->element[i] + 2]) <= FAR_TURN);
    return over && bbm_motion_of(m);
}

/* How far the corner of a contact, as its edge sees it, is half-way off the middle of the straight
 * way, m. From the centre of j P1 goes from x0 to x1, over x. By then j has turned by a, and at the
 * end by 2 a, so that this is |x - (R(a) x0 + R(-a) x1)/2|. */
static double curve_of(const bbm_model *m, const bbm_contact *c)
{
    const bbm_element *i = &m->element[c->element[0]], *j = &m->element[c->element[1]];
    const bbm_vertex *P1 = bbm_start_of(m, c->corner);
    const double *Di = &m->D[6 * c->element[0]], *Dj = &m->D[6 * c->element[1]];
    const double cosine = cos(Dj[2] / 2), sine = sin(Dj[2] / 2);
    double half[6], whole[2], u[2];

    for (int a = 0; a < 6; a++)
        half[a] = Di[a] / 2;
    bbm_move(bbm_motion_of(m), i, Di, P1->x, P1->y, whole);
    bbm_move(bbm_motion_of(m), i, half, P1->x, P1->y, u);
    const double x = (whole[0] - Dj[0]) / 2, y = (whole[1] - Dj[1]) / 2;
    const double X = P1->x - j->x, Y = P1->y - j->y;
    return hypot(X + u[0] - Dj[0] / 2 - cosine * (X + x) - sine * y,
                 Y + u[1] - Dj[1] / 2 - cosine * (Y + y) + sine * x);
}

/* Whether blocks touch, or bolts and pins join them. */
int bbm_blocks_meet(const bbm_model *m)
{
    int meet = m->scratch->contacts > 0;

    for (const bbm_gap *g = m->gap; g < m->gap + m->gaps; g++)
        meet |= g->j >= 0 && m->beyond->body[g->i] != m->beyond->body[g->j];
    return meet;
}

/* Whether the solution turns and strains no element too far, and none turns while a corner of it,
 * or one at an edge of it, goes a way that is too far off the straight one; a comparison with NaN
 * is false. */
bbm_status bbm_check_solution(bbm_model *m)
{
    const int alone = bbm_is_static(m) && !bbm_blocks_meet(m);
    const double most = !alone ? FAR_STRAIN : m->par.steps == 1 ? LINEAR : 1;
    const double turn = alone ? INFINITY : FAR_TURN;
    int far = -1;

    for (const bbm_contact *c = m->scratch->contact; c < bbm_end_of_contacts(m) && far < 0; c++)
        if (bbm_motion_of(m) && c->state == BBM_OPEN && curve_of(m, c) > CURVE * bbm_size_at(m, c))
            far = c->element[fabs(m->D[6 * c->element[0] + 2])
                             <= fabs(m->D[6 * c->element[1] + 2])];
    for (int i = 0; i < m->elements; i++)
        for (int a = 2; a < 6; a++)
            if (!(fabs(m->D[6 * i + a]) < (a == 2 ? turn : most)))
                far = i;
    if (far < 0)
        return BBM_OK;
    const double *D = &m->D[6 * far], strain = fmax(fmax(fabs(D[3]), fabs(D[4])), fabs(D[5]));
    return bbm_fail(m, BBM_STEP_TOO_LONG, "step %d: element %d of block %d strains by %.2g and "
                    "turns by %.2g rad; %s", m->info.step + 1, far, m->element[far].block, strain,
                    fabs(D[2]), bbm_is_static(m) ? "in statics smaller loads or a larger E help"
                                                 : "a smaller dt, velocity or load helps");
}

/* Whether the springs of all contacts keep their blocks apart. */
bbm_status bbm_check_depth(bbm_model *m)
{
    for (const bbm_contact *c = m->scratch->contact; c < bbm_end_of_contacts(m); c++)
        if (c->state != BBM_OPEN && c->rest - c->d_n > DEEP * bbm_size_at(m, c))
            return bbm_fail(m, BBM_TOO_SOFT, "step %d: a corner of block %d is pressed %.2g m "
                            "into block %d, a tenth of the smaller one; larger stiffnesses p_n, "
                            "p_s help", m->info.step + 1, m->edge[c->corner].block,
                            c->rest - c->d_n, m->edge[c->edge].block);
    return BBM_OK;
}
