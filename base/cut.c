/* cut.c - what stands around the step of Fig. 8: messages, what must hold before it, what went
 * wrong in it, and when it is cut in two and tried again.
 *
 * The parts of a step that was cut grow again, and together take no more than SOLUTIONS solutions.
 * A static step has no parts; a hook may know another way.
 */
#include <stdarg.h>
#include <stdio.h>

#include "base.h"

/* A step that has taken more work than this does not settle.
 * SOLUTIONS   in all its parts: several times what the worst walls needed
 * ITERATIONS  in all solutions, as a multiple of what one solution may take
 * HALVINGS    of dt, to the shortest part */
enum { SOLUTIONS = 10000, ITERATIONS = 10, HALVINGS = 12 };

/* ------------------------------------------------------------------------------------ messages */

const char *bbm_status_text(bbm_status s)
{
    static const char *const text[BBM_STATUS_COUNT] = {
        [BBM_OK] = "no error",
        [BBM_NO_MEMORY] = "out of memory",
        [BBM_NO_ELEMENT] = "the model has no element",
        [BBM_NOT_FINITE] = "a number is NaN or infinite",
        [BBM_BAD_INDEX] = "no such node, element or material",
        [BBM_BAD_MATERIAL] = "a material is impossible",
        [BBM_BAD_PARAMETER] = "a parameter is outside its range",
        [BBM_BAD_ELEMENT] = "an element is no polygon",
        [BBM_SELF_CROSSING] = "the boundary of an element meets itself",
        [BBM_OVERLAP] = "elements of one block overlap",
        [BBM_BLOCKS_OVERLAP] = "blocks overlap",
        [BBM_UNUSED_NODE] = "a node belongs to no element",
        [BBM_NOT_BOUNDARY] = "a line load needs a boundary edge",
        [BBM_FREE_TO_MOVE] = "statics needs bodies that are held",
        [BBM_NOT_POSITIVE_DEFINITE] = "the stiffness matrix is not positive definite",
        [BBM_NOT_CONVERGED] = "the equations were not solved",
        [BBM_STEPS_EXHAUSTED] = "no equilibrium in the given steps",
        [BBM_NO_EQUILIBRIUM] = "it falls",
        [BBM_STEP_TOO_LONG] = "the step is too long",
        [BBM_OPEN_CLOSE] = "the open-close iteration does not settle",
        [BBM_TOO_SOFT] = "the contacts are too soft",
        [BBM_ENERGY] = "the step makes energy",
        [BBM_STOPPED] = "stopped from outside",
    };

    return s >= 0 && s < BBM_STATUS_COUNT ? text[s] : "unknown status";
}

const char *bbm_message(const bbm_model *m) { return m->message; }

/* Puts the sentence "TEXT OF THE STATUS: details" into the model and returns the status. */
bbm_status bbm_fail(bbm_model *m, bbm_status s, const char *format, ...)
{
    const int n = snprintf(m->message, sizeof m->message, "%s: ", bbm_status_text(s));
    va_list args;

    va_start(args, format);
    vsnprintf(m->message + n, sizeof m->message - (size_t)n, format, args);
    va_end(args);
    return s;
}

bbm_status bbm_out_of_memory(bbm_model *m)
{
    return bbm_fail(m, BBM_NO_MEMORY, "%d elements, %d nodes", m->elements, m->nodes);
}

/* Puts a copy of an entry at the end of an array of *count entries, whose room is the next power of
 * two. Its index goes through the last pointer, which may be NULL; so may the model, which gets the
 * message. */
bbm_status bbm_append(bbm_model *m, void **array, int *count, size_t size, const void *entry,
                      int *index)
{
    const size_t n = (size_t)*count;
    void *room = *array;

    if (n == 0 || (n >= 16 && (n & (n - 1)) == 0))
        room = realloc(*array, (n == 0 ? 16 : 2 * n) * size);
    if (!room)
        return m ? bbm_out_of_memory(m) : BBM_NO_MEMORY;
    *array = room;
    memcpy((char *)room + n * size, entry, size);
    ++*count;
    if (index)
        *index = (int)n;
    return BBM_OK;
}

/* -------------------------------------------------------------------- what went wrong in a step */

/* Whether the step has had all the work that it may take. */
int bbm_is_spent(const bbm_model *m)
{
    return m->info.passes >= SOLUTIONS || m->info.iterations / ITERATIONS >= m->par.pcg.iterations;
}

/* What went wrong in a solution, or in the open-close iteration, as a sentence with numbers. */
bbm_status bbm_say_what_failed(bbm_model *m, bbm_status status)
{
    const bbm_pcg_info *i = &m->info.pcg;
    const int step = m->info.step + 1;

    if (status == BBM_OPEN_CLOSE && bbm_is_static(m))
        return bbm_fail(m, status, "step %d, %d passes, %d contacts", step, m->info.passes,
                        m->scratch->contacts);
    if (status == BBM_OPEN_CLOSE)
        return bbm_fail(m, status, "step %d at t = %g, dt cut to %g, %d passes, %d contacts", step,
                        m->info.t, m->h, m->info.passes, m->scratch->contacts);
    if (status == BBM_NOT_FINITE)
        return bbm_fail(m, status, "step %d, a load, velocity, stress or stiffness is too large",
                        step);
    if (i->element >= 0)
        return bbm_fail(m, status, "step %d, element %d of block %d: it is free to move, it has "
                        "turned over, or the stiffnesses that meet there are too far apart",
                        step, i->element, m->element[i->element].block);
    return bbm_fail(m, status, "step %d, iteration %d, residual %.2g%s", step, i->iterations,
                    i->residual, status == BBM_NOT_CONVERGED
                                     ? "; more iterations or a smaller alpha help" : "");
}

/* ------------------------------------------------------------------------- the parts of a step */

/* Refuses the first value that is outside its range; a comparison with NaN is false, so NaN is
 * refused, too. */
bbm_status bbm_check_ranges(bbm_model *m, int n, const bbm_range range[])
{
    for (const bbm_range *r = range; r < range + n; r++)
        if (!(r->value >= r->low && r->value <= r->high))
            return bbm_fail(m, BBM_BAD_PARAMETER, "%s = %g, expected %s", r->name, r->value,
                            r->expected);
    return BBM_OK;
}

/* What must hold before a step: a prepared model, parameters in their ranges. Counting begins. */
bbm_status bbm_check_step(bbm_model *m)
{
    const bbm_parameters *p = &m->par;
    const double over = nextafter(0, 1), most = nextafter(INFINITY, 0);
    const bbm_range range[] = {
        { "dt", p->dt, over, INFINITY, "more than 0" },
        { "steps", p->steps, 1, most, "1 or more" },
        { "tolerance", p->tolerance, 0, most, "0 or more" },
        { "velocity_factor", p->velocity_factor, 0, 1, "0 to 1" },
        { "alpha", p->alpha, over, most, "more than 0" },
        { "gravity[0]", p->gravity[0], -most, most, "a finite number" },
        { "gravity[1]", p->gravity[1], -most, most, "a finite number" },
        { "p_n", p->p_n, over, most, "more than 0" },
        { "p_s", p->p_s, over, most, "more than 0" },
        { "friction", p->friction, 0, nextafter(90, 0), "0 to less than 90 degrees" },
        { "round", p->round, -1, most, "0 or more, or -1" },
        { "pcg.omega", p->pcg.omega, over, nextafter(2, 0), "more than 0, less than 2" },
        { "pcg.tolerance", p->pcg.tolerance, over, 1e-6, "more than 0, at most 1e-6" },
        { "pcg.iterations", p->pcg.iterations, 1, most, "1 or more" },
    };

    m->info.passes = m->info.cuts = m->info.iterations = 0;
    if (m->status)
        return m->status;
    if (!m->is_prepared)
        return bbm_fail(m, BBM_BAD_PARAMETER, "a step needs bbm_prepare, after what is added too");
    return bbm_check_ranges(m, LENGTH(range), range);
}

/* In how many parts a part that has ended with `status` is tried again: 2, or 0 if it is done, or
 * as short as it may be, or static. What may go well otherwise: the equations, or the states of the
 * contacts, had no end, it makes energy, or something goes too far. */
int bbm_parts_to_try(bbm_model *m, bbm_status status, int tries)
{
    const int may = status == BBM_NOT_POSITIVE_DEFINITE || status == BBM_NOT_CONVERGED
                 || status == BBM_NOT_FINITE || status == BBM_OPEN_CLOSE || status == BBM_ENERGY
                 || status == BBM_STEP_TOO_LONG;

    if (!may || tries == HALVINGS || bbm_is_static(m) || bbm_is_spent(m))
        return 0;
    m->info.cuts++;
    m->message[0] = '\0';
    return 2;
}
