/* beyond.c - a model with all that stands beside the paper: what is hooked in where. */
#include <math.h>
#include <stdlib.h>

#include "beyond.h"

static void release(bbm_model *m)
{
    if (!m->beyond)
        return;
    free(m->beyond->edge_load);
    free(m->beyond->joint);
    free(m->beyond->support);
    free(m->beyond);
}

/* A prepared model: elements lie side by side, springs have the energy that they begin with. */
static bbm_status check(bbm_model *m)
{
    m->beyond->springs = bbm_spring_energy(m);
    const bbm_status status = bbm_lay_out_supports(m);
    return status ? status : bbm_check_overlap(m);
}

/* Parameters and settings, and before the first step bonds that hold. */
static bbm_status check_step(bbm_model *m)
{
    bbm_begin_joints(m);
    if (bbm_check_parameters(m))
        return BBM_BAD_PARAMETER;
    if (m->info.step > 0 || m->beyond->bonding != BBM_MIDPOINTS)
        return BBM_OK;
    if (bbm_find_mechanism(m, &m->blamed[0]))
        return BBM_NO_MEMORY;
    return m->blamed[0] < 0 ? BBM_OK
         : bbm_fail(m, BBM_MECHANISM, "block %d, element %d; BBM_MOMENT holds them",
                    m->element[m->blamed[0]].block, m->blamed[0]);
}

/* The base accelerates, and the model is at rest in it: gravity less that, at the end of the
 * step. */
static void accelerate(bbm_model *m)
{
    const bbm_beyond *b = m->beyond;
    const double swing = bbm_is_static(m) ? 0 : sin(b->shake_omega * (m->info.t + m->h));

    for (int a = 0; a < 2; a++)
        m->acceleration[a] -= b->shake[a] * swing;
}

static bbm_status lay_out(bbm_model *m)
{
    const bbm_status status = bbm_lay_out_coarse(m);
    return status ? status : bbm_lay_out_sliding(m);
}

static void begin(bbm_model *m)
{
    bbm_set_middle(m);
    bbm_start_multipliers(m);
}

/* A step that may begin: no corner has passed into a block, and in statics all bodies are held. */
static bbm_status check_listed(bbm_model *m)
{
    const bbm_status status = bbm_check_passed(m);

    return status ? status : bbm_check_supports(m);
}

/* A step that went well: right as far as one can tell, and without energy from nowhere. */
static bbm_status accept(bbm_model *m, const bbm_model *end)
{
    bbm_status status = bbm_check_solution(m);
    double gain, there;

    if (!status)
        status = bbm_check_depth(m);
    if (status)
        return status;
    bbm_find_reactions(m);
    status = bbm_check_balance(m, end, &gain, &there);
    if (status == BBM_ENERGY)
        return bbm_fail(m, BBM_ENERGY, "step %d at t = %g, dt cut to %g: %g J more than its loads' "
                        "work, of %g J", m->info.step + 1, m->info.t, m->h, gain, there);
    if (!status) {
        bbm_store_multipliers(m);
        bbm_stop_supports(m);
    }
    return status;
}

bbm_status bbm_beyond_new(bbm_model **out)
{
    const bbm_status status = bbm_model_new(out);
    bbm_model *m = *out;

    if (status)
        return status;
    m->beyond = calloc(1, sizeof *m->beyond);
    if (!m->beyond) {
        bbm_model_free(m);
        *out = NULL;
        return BBM_NO_MEMORY;
    }
    m->par.pcg.method = &bbm_two_level;
    m->hook = (bbm_hooks){
        .release = release,
        .check_polygon = bbm_check_polygon,
        .check = check,
        .check_step = check_step,
        .accelerate = accelerate,
        .begin = begin,
        .check_listed = check_listed,
        .find_pairs = bbm_sweep,
        .joint_area = bbm_joint_area,
        .strength = bbm_joint_strength,
        .friction = bbm_put_friction_in_K,
        .load = bbm_gather_edge_loads,
        .list_gaps = bbm_list_edge_gaps,
        .is_exact = bbm_moves_exactly,
        .lay_out = lay_out,
        .before_solution = bbm_interpolate_elements,
        .renew = bbm_renew_middle,
        .settled = bbm_take_over,
        .move = bbm_move_exactly,
        .turn = bbm_turn_element,
        .accept = accept,
        .explain = bbm_explain,
    };
    return BBM_OK;
}
