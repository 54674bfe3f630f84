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
 * settle. A step that keeps no velocities (velocity_factor 0) takes energy away on purpose; with
 * `rotation` BBM_LINEAR, the paper's way, a block that turns swells and gains energy by that. There
 * the balance is left alone, or only told.
 */
#include "beyond.h"

/* GAIN [-]      a step that makes more than this share of what is there, in all its parts together,
 *               is wrong: it is what the solution and the vectors of the step may be off
 * LONGER [-]    of what a spring lacks it gets back this share in a step: in a few steps, gently */
#define GAIN 1e-5
#define LONGER 0.05

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

/* The energies of element i of the present geometry, at the start (0) or the end of a step (1).
 * Kinetic: of the velocity that had no `factor` yet. Elastic: 1/2 t A0 s.E^-1 s with Hooke's law
 * (7) and s the stress, where steps are exact on the starting area:
 * s.E^-1 s = (sx^2 + sy^2 - 2 nu sx sy + 2 (1 + nu) sxy^2)/E. */
static bbm_energy energy_of(const bbm_model *m, int i, int when, double factor)
{
    const bbm_element *e = &m->element[i];
    const bbm_material *of = &e->material;
    const double *s = e->stress;
    bbm_element now = *e;
    double V[6];

    bbm_element_geometry(&now, &m->vertex[e->first]);
    for (int a = 0; a < 6; a++)
        V[a] = factor > 0 ? e->V[a] / factor : 2 / m->h * e->D[a];
    const double share = e->middle ? now.A / e->A0 : 1;
    const double elastic = of->thickness * e->A0 * share * share / (2 * of->E)
         * (s[0] * s[0] + s[1] * s[1] - 2 * of->nu * s[0] * s[1] + 2 * (1 + of->nu) * s[2] * s[2]);
    return (bbm_energy){ bbm_has_inertia(m, i) ? bbm_inertia_form(&now, V) / 2 : 0, elastic,
                         m->beyond->account[i].springs[when] };
}

static double sum_of(bbm_energy e) { return e.kinetic + e.elastic + e.springs; }

/* The energies after the last step, before its velocities got their share; none of a model that is
 * not prepared. */
void bbm_energies(const bbm_model *m, bbm_energy *energy)
{
    const double factor = m->info.step > 0 || m->info.t > 0 ? m->par.velocity_factor : 1;

    *energy = (bbm_energy){ 0, 0, 0 };
    for (int i = 0; i < m->elements && m->is_prepared; i++) {
        const bbm_energy e = energy_of(m, i, 0, factor);
        energy->kinetic += e.kinetic;
        energy->elastic += e.elastic;
        energy->springs += e.springs;
    }
}

/* Notes at each element the energy of its springs, at the start (0) or the end of a step (1): of
 * bonds and fixed points as they are listed, and of contacts. A spring counts at one of its
 * elements; friction holds what its shear spring would, see bbm_store_contacts. What is open has no
 * N and no T. */
void bbm_note_springs(bbm_model *m, int when)
{
    bbm_account *a = m->beyond->account;

    for (int i = 0; i < m->elements; i++)
        a[i].springs[when] = 0;
    for (const bbm_gap *g = m->gap; g < m->gap + m->gaps; g++)
        for (int r = 0; r < 2; r++)
            a[g->i].springs[when] += g->d0[r] / 2
                    * (g->own.f[r] + g->W[r][0] * g->d0[0] + g->W[r][1] * g->d0[1]);
    for (const bbm_contact *c = m->scratch->contact; c < bbm_end_of_contacts(m); c++) {
        const double T = bbm_shear_force(c);
        a[c->element[0]].springs[when] += bbm_normal_energy(m, c->N) + T * T / (2 * m->par.p_s);
    }
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

/* A load of the component does some work. */
static void add_work(bbm_account *a, double work)
{
    a->work += work;
    a->gain -= work;
    a->there += fabs(work);
}

/* The accounts of the part of a step from m to `end`, one for each component of K: bodies that
 * touch, are near or are bonded. What rounding of positions makes of kinetic energy, and of the
 * work of contacts, is no gain and no loss; nor is the last digit of what moves an element. Where
 * nothing has inertia, as in statics, and where velocities are not kept, nothing is there. */
void bbm_find_accounts(bbm_model *m, const bbm_model *end)
{
    const bbm_beyond *b = m->beyond;
    bbm_model now = *end;               /* its gaps take the place of those of the step */

    bbm_list_gaps(&now);
    bbm_note_springs(&now, 1);
    for (bbm_account *a = b->account; a < b->account + m->elements; a++)
        a->gain = a->there = a->work = a->asks = a->rounding = a->moves = 0;
    for (int i = 0; i < m->elements; i++) {
        bbm_account *of = &b->account[m->K->component[i]];
        const double *F = &m->F[6 * i], *load = &m->load[6 * i];
        const double before = sum_of(energy_of(m, i, 0, 1));
        const double off = BBM_ROUNDING * hypot(m->element[i].x, m->element[i].y);
        of->moves |= bbm_has_inertia(m, i);
        of->gain += sum_of(energy_of(end, i, 1, 1)) - before;
        of->there += before + off * (hypot(F[0], F[1]) + hypot(load[0], load[1]));
        of->rounding += 2 * bbm_mass_per_area(&end->element[i]) * end->element[i].A0
                      * pow(off / m->h, 2)
                      + DBL_EPSILON * hypot(F[0], F[1]) * hypot(m->D[6 * i], m->D[6 * i + 1]);
        add_work(of, b->account[i].held[0] + b->account[i].held[1]);
        for (int a = 0; a < 6; a++)
            add_work(of, load[a] * m->D[6 * i + a]);
    }
    for (const bbm_contact *c = m->scratch->contact; c < bbm_end_of_contacts(m); c++) {
        const bbm_vertex *P = bbm_start_of(m, c->corner);
        bbm_account *of = &b->account[m->K->component[P->element]];
        of->rounding += BBM_ROUNDING * hypot(c->N, c->T) * hypot(P->x, P->y);
    }
    for (bbm_account *a = b->account; a < b->account + m->elements; a++) {
        a->gain = copysign(fmax(0, fabs(a->gain) - a->rounding), a->gain);
        if (!a->moves || m->par.velocity_factor == 0)
            a->gain = a->there = 0;
    }
}

/* The energy that it takes to give a normal spring that share of what it may get in a step. One
 * that is closed, but began at a depth, where its corner came in over a ledge, lacks length. */
static double energy_to_lengthen(const bbm_model *m, const bbm_contact *c, double share)
{
    const int is_short = c->state != BBM_OPEN && c->N > 0 && c->rest < 0;
    const double N = bbm_normal_force(m, c->d_n - c->rest * (1 - LONGER * share));

    return is_short ? bbm_normal_energy(m, N) - bbm_normal_energy(m, c->N) : 0;
}

/* Short springs get longer. Without this, what slides over joints sinks at each one, for the next
 * block has not yet given way. A component pays with what it has lost in the step, and all its
 * springs get the same share. Where velocities are not kept at all they get it for nothing. */
static void lengthen_springs(bbm_model *m)
{
    bbm_account *of = m->beyond->account;

    for (const bbm_contact *c = m->scratch->contact; c < bbm_end_of_contacts(m); c++)
        of[m->K->component[m->edge[c->corner].element]].asks += energy_to_lengthen(m, c, 1);
    for (bbm_account *a = of; a < of + m->K->components; a++) {
        const double pays = m->par.velocity_factor == 0 ? a->asks : fmax(0, -a->gain);
        a->share = a->asks > 0 ? fmin(1, pays / a->asks) : 0;
    }
    for (bbm_contact *c = m->scratch->contact; c < bbm_end_of_contacts(m); c++) {
        const int i = m->edge[c->corner].element;
        bbm_account *body = &of[m->K->component[i]];
        const double more = energy_to_lengthen(m, c, body->share);
        of[i].springs[0] += more;
        body->gain += more;
        c->rest *= more > 0 ? 1 - LONGER * body->share : 1;
    }
}

/* The energy that the part of a step from m to `end` makes beyond the work of its loads, for each
 * component by itself, as a share of what is there: the energy at the start, the work of each load
 * without sign, and what rounding may make. The largest shares of all parts of a step add up. Too
 * much is refused; if not, m->beyond notes it. */
bbm_status bbm_check_balance(bbm_model *m, const bbm_model *end)
{
    bbm_beyond *b = m->beyond;
    const bbm_account *worst = b->account;
    double share = 0;

    bbm_find_accounts(m, end);
    for (const bbm_account *a = b->account; a < b->account + m->K->components; a++) {
        worst = a->gain > share * a->there ? a : worst;
        share = fmax(0, worst->gain / worst->there);
    }
    if (bbm_motion_of(m) && b->made + share > GAIN)
        return bbm_fail(m, BBM_ENERGY, "step %d at t = %g, dt cut to %g: beyond the work of loads "
                        "its parts have made %.3g of the %.2g J that were there, expected at most "
                        "%g", m->info.step + 1, m->info.t, m->h, b->made + share, worst->there,
                        GAIN);
    b->made += share;
    b->gain = fmax(b->gain, b->made);
    for (int i = 0; i < m->elements; i++)
        b->account[i].springs[0] = b->account[i].springs[1];
    if (bbm_motion_of(m))
        lengthen_springs(m);
    for (const bbm_account *a = b->account; a < b->account + m->K->components; a++) {
        b->work += a->work;
        b->gained += fmax(0, a->gain);
    }
    return BBM_OK;
}
