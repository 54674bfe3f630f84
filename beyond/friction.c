/* friction.c - the normal forces that friction forces belong to, in few solutions.
 *
 * Beyond the paper, where friction is a load: in statics, and where LU does not pay (sliding.c).
 * N of a sliding contact depends on its friction and the friction on N. The
 * plain way, each solution with the friction of the last N, contracts by about tan(phi) h/b for a
 * block of width b and height h: where it slides near its toppling limit it crawls or never ends.
 * But for given states the map from the N that friction takes, x, to what the solution makes of
 * it, x + r, is affine (see friction_force in contact.c), and conjugate residuals find its fixed
 * point in few more solutions than contacts slide: each change of x and the change of r that it
 * made become a direction, in r orthonormal to the others. The next x moves along them so that
 * they remove of r what they can, and by the rest of r, which makes a new direction.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "beyond.h"

/* Takes from (dr, dx) what the known directions account for. */
static void remove_directions(const bbm_friction_search *f, int n, double dr[], double dx[])
{
    for (int d = 0; d < f->directions; d++) {
        const double *r = &f->dr[d * n], *x = &f->dx[d * n];
        double a = 0;
        for (int k = 0; k < n; k++)
            a += dr[k] * r[k];
        for (int k = 0; k < n; k++) {
            dr[k] -= a * r[k];
            dx[k] -= a * x[k];
        }
    }
}

/* The last change of x, and the change of r that it made, become a direction. */
static void learn_direction(bbm_friction_search *f, const bbm_contact c[], int n)
{
    double *dr = &f->dr[f->directions * n], *dx = &f->dx[f->directions * n], size = 0;

    for (int k = 0; k < n; k++) {
        const int slides = c[k].state == BBM_SLIDE;
        dx[k] = slides ? c[k].N_of_friction - f->x[k] : 0;
        dr[k] = slides ? c[k].N - c[k].N_of_friction - f->r[k] : 0;
    }
    remove_directions(f, n, dr, dx);
    for (int k = 0; k < n; k++)
        size += dr[k] * dr[k];
    for (int k = 0; k < n && size > 0; k++) {
        dr[k] /= sqrt(size);
        dx[k] /= sqrt(size);
    }
    f->directions += size > 0;
}

/* Room for the vectors, all in one. */
static bbm_status make_room(bbm_friction_search *f, int n)
{
    const size_t of_all = ((size_t)BBM_FRICTION_DIRECTIONS + 1) * (size_t)n;

    if (n <= f->room)
        return BBM_OK;
    free(f->x);
    f->x = calloc(2 * (size_t)n + 2 * of_all, sizeof *f->x);
    f->room = f->x ? n : 0;
    f->r = f->x + n;
    f->dx = f->r + n;
    f->dr = f->dx + of_all;
    return f->x ? BBM_OK : BBM_NO_MEMORY;
}

/* The next N for the friction of the sliding contacts; `pass` counts from 0 with the same states.
 */
bbm_status bbm_find_friction(bbm_model *m, int pass)
{
    bbm_friction_search *f = &m->beyond->friction;
    int n;
    bbm_contact *c = bbm_list_contacts(m, &n);

    if (make_room(f, n))
        return BBM_NO_MEMORY;
    if (pass == 0 || f->directions == BBM_FRICTION_DIRECTIONS)
        f->directions = 0;
    if (pass > 0)
        learn_direction(f, c, n);
    double *dr = &f->dr[f->directions * n], *dx = &f->dx[f->directions * n];
    for (int k = 0; k < n; k++) {
        f->x[k] = c[k].N_of_friction;
        f->r[k] = dr[k] = c[k].state == BBM_SLIDE ? c[k].N - c[k].N_of_friction : 0;
        dx[k] = 0;
    }
    remove_directions(f, n, dr, dx);
    for (int k = 0; k < n; k++)
        if (c[k].state == BBM_SLIDE)
            c[k].N_of_friction = f->x[k] + dx[k] + dr[k];
    return BBM_OK;
}
