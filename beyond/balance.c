/* balance.c - the energy balance of a step: the net under all that a step does.
 *
 * Beyond the paper. Newmark with beta = 1/2, gamma = 1 keeps the kinetic energy of a free body and takes potentials at the
 * end of the step: with D the step and f1 the force of a spring at its end, f1.(d1 - d0) is at least what the spring
 * gains. Contacts that open or slide lose energy, and friction opposes the slip. So in every dynamic step
 *
 *     kinetic + elastic + springs at its end  <=  the same at its start + the work of loads and gravity + rounding,
 *
 * and a solution that breaks this is wrong, whatever the reason. It is found before anything moves, and the step is done
 * again with half the time step, like one whose contacts do not settle.
 */
#include <math.h>

#include "../bbm.h"

/* GAIN [-]  a step that makes more than this of what is there is wrong; one that is right makes less than 1e-5 of it,
 *           the error of the solution and of the vectors of the step */
#define GAIN 1e-3

static double sum_of(const bbm_model *m)
{
    bbm_energy e;

    bbm_energies(m, &e);
    return e.kinetic + e.elastic + e.springs;
}

/* What the step from m to `end` makes beyond the work of its loads, J, and what is `there`: the energy at its start and
 * the work of each load, without sign. Noted in end->info... */
bbm_status bbm_check_balance(bbm_model *m, const bbm_model *end, double *gain, double *there)
{
    bbm_model start = *m;
    double work = 0;

    *gain = *there = 0;
    if (isinf(m->h) || m->par.keep < 1)
        return BBM_OK;
    start.force = m->force_before;
    *there = sum_of(&start);
    *gain = sum_of(end) - *there;
    for (int k = 0; k < 6 * m->elements; k++) {
        work += m->load[k] * m->D[k];
        *there += fabs(m->load[k] * m->D[k]);
    }
    *gain -= work;
    if (bbm_is_exact(m) && *gain > GAIN * *there)
        return BBM_ENERGY;
    m->info.gained += fmax(0, *gain);
    if (*there > 0)
        m->info.gain = fmax(m->info.gain, *gain / *there);
    return BBM_OK;
}
