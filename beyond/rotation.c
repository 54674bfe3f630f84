/* rotation.c - exact rotations, and the vectors of a step at its middle: with both a step keeps
 * energy and momentum.
 *
 * Beyond the paper. T of Eq. (2) belongs to the positions at the start of a step. A body that
 * turns by r while it touches or is bonded ends the step r^2/2 times its lever away from where
 * u = T D had it: it swells, and a spring then holds a length that is not there, so that each step
 * makes energy. The exact motion of a point at X from the barycentre,
 *
 *     u = (u0, v0) + R(r) (1 + e) X - X,         e = [ex gxy/2; gxy/2 ey],
 *
 * is linear in D, too, if it is written at the middle of its way, Xm = X + (u - (u0, v0))/2. With
 * J = [0 -1; 1 0] and R - 1 = tan(r/2) J (R + 1),
 *
 *     u = (u0, v0) + 2 tan(r/2) J Xm + (1 + tan(r/2) J) e X  =  T_m D.
 *
 * With T_m in place of T the length of a bonding spring at the end of the step is exactly
 * d0 + T_m,i Di - T_m,j Dj. In the same way l d_n = b x p and l d_s = b.a of a contact are
 * products, and differences of products are exact with the mean of the other factor:
 * delta(b x p) = delta b x p_m + b_m x delta p. So one rule serves all: points and T at the
 * middle. The work of each force is then what its spring, its load or its pressure loses (Simo,
 * Tarnow, Wong: Comput. Methods Appl. Mech. Eng. 100, 1992, take the middle for the same reason).
 *
 * T_m needs the D of the solution. A step begins with what its velocities foretell and renews T_m
 * in each pass whose solution has another D. Statics keeps T, but where several of its steps follow
 * each other, which are Newton's, an element ends each by the exact motion. With `rotation`
 * BBM_LINEAR, the paper's way, both are T D.
 */
#include "beyond.h"

/* TURN [rad^2]  turn of an element times the error of that turn, times sqrt(alpha), below which T_m
 *               holds: bonds, of stiffness alpha, are wrong by that share of their lever, and a
 *               bonded block that spins by 0.2 rad a step keeps its energy to 1e-9 of it
 * SHARE [-]     force of a contact that comes from T_m of another D, against the largest one on
 *               its elements: what it makes of energy is this share of the energy of the
 *               contact's spring
 * DIRECTION [rad] of a contact's force, which is left: what it does to the angular momentum is
 *               1e-5 of that
 * ROUGH [-]     the most that rounding may be of the force of a contact: springs that are stiffer
 *               do not settle */
#define TURN 1e-8
#define SHARE 3e-6
#define DIRECTION 1e-4
#define ROUGH 1e-3

/* How a point at (X, Y) from the barycentre moves: translation, strain, then the exact rotation,
 * u = (u0, v0) + R(r0) (1 + e) X - X with R X - X = sin(r) J X - 2 sin(r/2)^2 X. */
static void move(const double D[6], double X, double Y, double u[2])
{
    const double ux = D[3] * X + D[5] / 2 * Y, uy = D[5] / 2 * X + D[4] * Y;
    const double s = sin(D[2]), c1 = -2 * pow(sin(D[2] / 2), 2), x = X + ux, y = Y + uy;

    u[0] = D[0] + ux + c1 * x - s * y;
    u[1] = D[1] + uy + c1 * y + s * x;
}

/* T_m at the point that starts the step in (x, y), and where that is in its middle, `at`. */
static void find_point(const bbm_element *e, double x, double y, double T[2][6], double at[2])
{
    const double X = x - e->x, Y = y - e->y, *D = e->middle->D, r = D[2];
    const double ux = D[3] * X + D[5] / 2 * Y, uy = D[5] / 2 * X + D[4] * Y;
    const double t = tan(r / 2), f = r == 0 ? 1 : 2 * t / r;
    const double s = 2 * t / (1 + t * t), c1 = -t * s;                  /* sin(r), cos(r) - 1   */
    const double Xm = X + (ux + c1 * (X + ux) - s * (Y + uy)) / 2;
    const double Ym = Y + (uy + c1 * (Y + uy) + s * (X + ux)) / 2;
    const double matrix[2][6] = {
        /* u0  v0  r0       ex     ey      gxy               */
        {  1,  0,  -f * Ym, X,     -t * Y, (Y - t * X) / 2 },
        {  0,  1,  f * Xm,  t * X, Y,      (X + t * Y) / 2 },
    };

    memcpy(T, matrix, sizeof matrix);
    at[0] = e->x + D[0] / 2 + Xm;
    at[1] = e->y + D[1] / 2 + Ym;
}

/* A tensor (xx, yy, xy) turns with the element: R s R^T, with cos(2 r) - 1 = -2 sin(r)^2. */
void bbm_turn_tensor(double s[3], double r)
{
    const double c1 = -2 * sin(r) * sin(r), n = sin(2 * r), half = (s[0] - s[1]) / 2, t = s[2];

    s[0] += half * c1 - t * n;
    s[1] -= half * c1 - t * n;
    s[2] += half * n + t * c1;
}

/* Stress and strain rates turn with an element that has moved, in statics the stress alone. The
 * stress that the strain adds belongs to the starting area, as in (10): (A stress0 + A0 E e)/A', A'
 * the area at the end. The change of its moments by strain, which no force of the step knows of,
 * changes no energy: turning and straining slow down or speed up together. */
static void turn(const bbm_element *start, bbm_element *e, const bbm_vertex vertex[])
{
    double rate[3] = { e->V[3], e->V[4], e->V[5] / 2 };
    double turning[6] = { 0, 0, e->V[2], e->V[3], e->V[4], e->V[5] };
    bbm_element end = *e;

    if (!e->middle) {
        bbm_turn_tensor(e->stress, e->D[2]);
        return;
    }
    const double before = bbm_inertia_form(start, turning);
    bbm_element_geometry(&end, vertex);
    for (int a = 0; a < 3; a++)
        e->stress[a] = (start->A * start->stress[a] + e->A0 * (e->stress[a] - start->stress[a]))
                     / end.A;
    bbm_turn_tensor(e->stress, e->D[2]);
    bbm_turn_tensor(rate, e->D[2]);
    turning[3] = rate[0], turning[4] = rate[1], turning[5] = 2 * rate[2];
    const double after = bbm_inertia_form(&end, turning);
    const double factor = after > 0 ? sqrt(before / after) : 1;
    for (int a = 2; a < 6; a++)
        e->V[a] = factor * turning[a];
}

static const bbm_motion exact_motion = { find_point, move, turn };

/* How points move in the step in hand: by the exact rotation, or by the paper's T D. Statics has
 * T D, but elements end its steps by the exact rotation, or they would swell by r^2/2 in each. One
 * static step by itself is linear. */
const bbm_motion *bbm_find_motion(const bbm_model *m, int ends)
{
    const int linear = bbm_is_static(m) && (!ends || (m->par.steps == 1 && m->info.step == 0));

    return m->beyond->rotation == BBM_EXACT && !linear ? &exact_motion : NULL;
}

/* Takes the vectors of the step in the middle of D, and lists the gaps with them; not exact: at its
 * start. */
void bbm_set_middle(bbm_model *m)
{
    const bbm_motion *motion = bbm_motion_of(m);

    for (int i = 0; i < m->elements; i++) {
        bbm_middle *middle = &m->beyond->middle[i];
        middle->motion = motion;
        memcpy(middle->D, &m->D[6 * i], sizeof middle->D);
        m->element[i].middle = motion ? middle : NULL;
    }
    bbm_list_gaps(m);
}

/* By how much the turn of element i is another one than that of its T_m. */
static double turn_off(const bbm_model *m, int i)
{
    return fabs(m->D[6 * i + 2] - m->beyond->middle[i].D[2]);
}

/* Whether that is more than can be left. */
static int is_off(const bbm_model *m, int i)
{
    return turn_off(m, i) * (fabs(m->D[6 * i + 2]) + turn_off(m, i)) > TURN / sqrt(m->par.alpha);
}

/* What rounding of positions may make of the force of a contact: no more than a share of its N, of
 * the weight of its elements, or of the force by which its component is solved. Where nothing loads
 * its elements there is no force that it could spoil. */
static double find_rounding(const bbm_model *m, const bbm_contact *c)
{
    const double g = hypot(m->acceleration[0], m->acceleration[1]);
    double force = fmax(fabs(c->N), m->K->forces[m->K->component[c->element[0]]]);
    int loaded = 0;

    for (int k = 0; k < c->parts; k++) {
        const bbm_element *e = &m->element[c->element[k]];
        force = fmax(force, bbm_mass_per_area(e) * e->A * g);
        for (int a = 0; a < 6; a++)
            loaded |= m->load[6 * c->element[k] + a] != 0;
    }
    return loaded ? fmin(c->trial.digits, ROUGH * force) : c->trial.digits;
}

/* Whether the vectors of a contact belong to another step than the solution: forces that are wrong
 * by more than a share of the largest one on its elements, or in direction. */
int bbm_contacts_are_off(const bbm_model *m, double share)
{
    int off = 0;

    for (const bbm_contact *c = m->scratch->contact; c < bbm_end_of_contacts(m) && !off; c++) {
        double d[2], force = fabs(c->N);
        if (c->state == BBM_OPEN)
            continue;
        for (int k = 0; k < c->parts; k++) {
            const int i = c->element[k];
            off |= bbm_motion_of(m) && turn_off(m, i) > DIRECTION;
            force = fmax(force, hypot(m->F[6 * i], m->F[6 * i + 1]));
        }
        const double bound = fmax(share * force, c->trial.force_tolerance + find_rounding(m, c));
        bbm_end_distances(m, c, c->anchor, d);
        off = off || bbm_normal_stiffness(m) * fabs(d[0] - c->d_n) > bound
           || (m->par.p_s * fabs(c->trial.time_left * d[1] - c->d_s) > bound
                   && c->state == BBM_LOCK);
    }
    return off;
}

/* Whether the vectors of bonds, fixed points, loads or contacts belong to another step than the
 * solution. Gravity has none; a load that depends on T has a moment, or strains its element. */
int bbm_middle_is_off(const bbm_model *m)
{
    int off = 0;

    for (int k = 0; k < m->gaps && !off; k++)
        off = is_off(m, m->gap[k].i) || (m->gap[k].j >= 0 && is_off(m, m->gap[k].j));
    for (int a = 0; a < 6 * m->elements && !off; a++)
        off = a % 6 >= 2 && m->load[a] != 0 && is_off(m, a / 6);
    return bbm_motion_of(m) && (off || bbm_contacts_are_off(m, SHARE));
}
