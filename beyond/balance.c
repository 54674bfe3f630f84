/* balance.c - the energy balance of a step: the net under all that a step does.
 *
 * Beyond the paper. Newmark with beta = 1/2, gamma = 1 keeps the kinetic energy of a free body and takes potentials at the
 * end of the step: with d0 and d1 the lengths of a spring at the start and at the end and f1 its force at the end,
 * f1 (d1 - d0) is at least what the spring gains. Contacts that open or slide lose energy, and friction opposes the slip.
 * So in every dynamic step
 *
 *     kinetic + elastic + springs at its end  <=  the same at its start + the work of loads and gravity + rounding,
 *
 * and a solution that breaks this is wrong, whatever the reason. It is found out before anything moves, and the step is
 * done again with half the time step, like one whose contacts do not settle. A step that does not keep velocities whole
 * (`keep` below 1) takes energy away on purpose; with `rotation` BBM_LINEAR, the paper's way, a block that turns swells
 * and gains energy by that. There the balance is left alone, or only told.
 */
#include <float.h>
#include <math.h>

#include "../bbm.h"

/* GAIN [-]      a step that makes more than this share of what is there is wrong; one that is right makes some 1e-5 at most,
 *               what the solution and the vectors of the step are off
 * ROUNDING [-]  of positions, in which forces do work: some dozens of the last digit of a coordinate */
#define GAIN 1e-3
#define ROUNDING (64 * DBL_EPSILON)

static double sum_of(const bbm_model *m)
{
    bbm_energy e;

    bbm_energies(m, &e);
    return e.kinetic + e.elastic + e.springs;
}

/* The energy that the step from m to `end` makes beyond the work of its loads: `gain`, J, which also goes to m->info if it
 * is small enough; if not, BBM_ENERGY. It is compared with what is `there`, J: the energy at the start, the work of each
 * load without sign, and what rounding may make. */
bbm_status bbm_check_balance(bbm_model *m, const bbm_model *end, double *gain, double *there)
{
    bbm_model start = *m;

    *gain = *there = 0;
    if (isinf(m->h) || m->par.keep < 1)
        return BBM_OK;
    start.force = m->force_before;
    *there = sum_of(&start);
    *gain = sum_of(end) - *there;
    for (int i = 0; i < m->elements; i++) {
        const bbm_element *e = &m->element[i];
        const double *F = &m->F[6 * i], *load = &m->load[6 * i];
        *there += ROUNDING * (hypot(F[0], F[1]) + hypot(load[0], load[1])) * hypot(e->x, e->y);
        for (int a = 6 * i; a < 6 * i + 6; a++) {
            *gain -= m->load[a] * m->D[a];
            *there += fabs(m->load[a] * m->D[a]);
        }
    }
    if (bbm_is_exact(m) && *gain > GAIN * *there)
        return BBM_ENERGY;
    m->info.gained += fmax(0, *gain);
    if (*there > 0)
        m->info.gain = fmax(m->info.gain, *gain / *there);
    return BBM_OK;
}
