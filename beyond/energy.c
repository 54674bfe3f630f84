/* energy.c - energies, and the balance of a step: the net under all that a step does.
 *
 * Beyond the paper. Newmark with beta = 1/2, gamma = 1 keeps the kinetic energy of a free body and
 * takes potentials at the end of the step: with d0 and d1 the lengths of a spring at the start and
 * at the end and f1 its force at the end, f1 (d1 - d0) is at least what the spring gains. Contacts
 * that open or slide lose energy, and friction opposes the slip. So in every dynamic step
 *
 *     kinetic + elastic + springs at its end
 *         <=  the same at its start + the work of loads and gravity + rounding,
 *
 * and a solution that breaks this is wrong, whatever the reason. It is found out before anything
 * moves, and the step is done again with half the time step, like one whose contacts do not
 * settle. A step that does not keep velocities whole (velocity_factor below 1) takes energy away
 * on purpose; with `rotation` BBM_LINEAR, the paper's way, a block that turns swells and gains
 * energy by that. There the balance is left alone, or only told.
 */
#include <float.h>
#include <math.h>
#include <string.h>

#include "beyond.h"

/* GAIN [-]      a step that makes more than this share of what is there is wrong; one that is right
 *               makes some 1e-5 at most, what the solution and the vectors of the step are off
 * ROUNDING [-]  of positions, in which forces do work: some dozens of the last digit of a
 *               coordinate */
#define GAIN 1e-3
#define ROUNDING (64 * DBL_EPSILON)

/* int u.M u dA of a field u = T V, for Eq. (11). */
double bbm_inertia_form(const bbm_element *e, const double V[6])
{
    double TT[6][6], sum = 0;

    bbm_mode_integral(e, TT);
    for (int a = 0; a < 6; a++)
        for (int b = 0; b < 6; b++)
            sum += V[a] * TT[a][b] * V[b];
    return bbm_mass_per_area(e) * sum;
}

/* Kinetic energy of the present geometry, with the velocity before its factor. */
static double kinetic_energy(const bbm_model *m, const bbm_element *e)
{
    const double factor = m->info.step > 0 || m->info.t > 0 ? m->par.velocity_factor : 1;
    bbm_element now = *e;
    double V[6];

    if (factor == 0 && isinf(m->h))
        return 0;
    bbm_element_geometry(&now, &m->vertex[e->first]);
    for (int a = 0; a < 6; a++)
        V[a] = factor > 0 ? e->V[a] / factor : 2 / m->h * e->D[a];
    return bbm_inertia_form(&now, V) / 2;
}

/* 1/2 int stress.strain dA = 1/2 t A s.E^-1 s with Hooke's law (7): without strain s.E^-1 s is what
 * is left, with the other sign, of [0 s; s E]. */
static double elastic_energy(const bbm_element *e)
{
    double E[3][3], W[4][4] = { { 0 } };

    bbm_elastic_matrix(&e->material, E);
    for (int a = 0; a < 9; a++)
        W[1 + a / 3][1 + a % 3] = E[a / 3][a % 3];
    for (int a = 0; a < 3; a++)
        W[0][1 + a] = W[1 + a][0] = e->stress[a];
    bbm_condense(4, 1, W);
    return -e->material.thickness * e->A0 * W[0][0] / 2;
}

/* The energies after the last step; none before bbm_prepare. */
void bbm_energies(const bbm_model *m, bbm_energy *energy)
{
    *energy = (bbm_energy){ 0, 0, 0 };
    if (!m->K)
        return;
    energy->springs = m->beyond->springs;
    for (int i = 0; i < m->elements; i++) {
        energy->kinetic += kinetic_energy(m, &m->element[i]);
        energy->elastic += elastic_energy(&m->element[i]);
    }
}

/* What the springs of a contact hold; friction holds what its shear spring would, see
 * bbm_store_contacts. */
static double contact_energy(const bbm_model *m, const bbm_contact *c)
{
    const bbm_parameters *p = &m->par;
    const double T = c->state == BBM_SLIDE ? bbm_shear_strength(&c->strength, c->N) : c->T;

    return c->state == BBM_OPEN ? 0 : c->N * c->N / (2 * p->p_n) + T * T / (2 * p->p_s);
}

/* Energy of all springs: of the bonds and fixed points as they are listed, and of the contacts. */
double bbm_spring_energy(const bbm_model *m)
{
    const bbm_contact *c = m->scratch->contact;
    double energy = 0;

    for (int k = 0; k < m->gaps; k++) {
        const bbm_gap *g = &m->gap[k];
        for (int r = 0; r < 2; r++)
            energy += g->d0[r] / 2
                    * (g->own.f[r] + g->own.W[r][0] * g->d0[0] + g->own.W[r][1] * g->d0[1]);
    }
    for (int k = 0; k < m->scratch->contacts; k++)
        energy += contact_energy(m, &c[k]);
    return energy;
}

/* The model at the end of the step, before it moves: a second one, which shares all with the first
 * but what will move. */
bbm_model bbm_end_of_step(const bbm_model *m)
{
    bbm_model end = *m;

    end.element = m->beyond->end_element;
    end.vertex = m->beyond->end_vertex;
    memcpy(end.element, m->element, (size_t)m->elements * sizeof *m->element);
    memcpy(end.vertex, m->vertex, (size_t)m->vertices * sizeof *m->vertex);
    bbm_move_elements(m, end.element, end.vertex);
    end.info.t += bbm_is_static(m) ? 0 : m->h;
    return end;
}

/* The energy that the step from m to `end` makes beyond the work of its loads and supports, `gain`,
 * and what is `there`: the energy at the start, the work of each load without sign, and what
 * rounding may make. A step that does not keep velocities whole has none. */
bbm_balance bbm_find_balance(const bbm_model *m, const bbm_model *end)
{
    const bbm_beyond *b = m->beyond;
    bbm_model now = *end;               /* its gaps take the place of those of the step */
    bbm_energy before, after;

    bbm_list_gaps(&now);
    bbm_energies(m, &before);
    bbm_energies(end, &after);
    bbm_balance s = { .work = b->jump_work, .springs = bbm_spring_energy(&now) };
    const double had = before.kinetic + before.elastic + before.springs;
    s.there = had + fabs(b->jump_work);
    for (int i = 0; i < m->elements; i++) {
        const bbm_element *e = &m->element[i];
        const double *F = &m->F[6 * i], *load = &m->load[6 * i];
        s.there += ROUNDING * (hypot(F[0], F[1]) + hypot(load[0], load[1])) * hypot(e->x, e->y);
        for (int a = 6 * i; a < 6 * i + 6; a++) {
            s.work += m->load[a] * m->D[a];
            s.there += fabs(m->load[a] * m->D[a]);
        }
    }
    for (int n = 0; n < m->nodes; n++)
        for (int a = 0; a < 2; a++) {
            const double work = b->support[n].force[a] * b->share * b->support[n].moved[a];
            s.work += work;
            s.there += fabs(work);
        }
    s.gain = after.kinetic + after.elastic + s.springs - had - s.work;
    if (bbm_is_static(m) || m->par.velocity_factor < 1)
        s.gain = s.there = 0;
    return s;
}

/* Too much gain is BBM_ENERGY; if not, m->beyond notes the balance. */
bbm_status bbm_check_balance(bbm_model *m, const bbm_model *end, double *gain, double *there)
{
    const bbm_balance s = bbm_find_balance(m, end);
    bbm_beyond *b = m->beyond;

    *gain = s.gain;
    *there = s.there;
    if (bbm_motion_of(m) && s.gain > GAIN * s.there)
        return BBM_ENERGY;
    b->work += s.work;
    b->springs = s.springs;
    b->gained += fmax(0, s.gain);
    b->gain = s.there > 0 ? fmax(b->gain, s.gain / s.there) : b->gain;
    return BBM_OK;
}
