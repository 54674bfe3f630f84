/* beyond.c - a model with all that stands beside the paper: what is hooked in where. */
#include "beyond.h"

/* What belongs to the elements and nodes of a prepared model. */
static void free_prepared(bbm_beyond *b)
{
    void *const array[] = { b->middle, b->end_element, b->end_vertex, b->support, b->account,
                            b->body, b->off, b->balance, b->lacking, b->crack, b->best,
                            b->broke };

    for (int k = 0; k < LENGTH(array); k++)
        free(array[k]);
}

static void release(bbm_model *m)
{
    free_prepared(m->beyond);
    free(m->beyond->edge_load);
    free(m->beyond->joint);
    free(m->beyond);
}

/* A prepared model: elements lie side by side, springs have the energy that they begin with. */
static bbm_status check(bbm_model *m)
{
    const size_t n = (size_t)m->elements, bonds = (size_t)m->bonds + 1;
    bbm_beyond *b = m->beyond;

    free_prepared(b);
    b->middle = calloc(n, sizeof *b->middle);
    b->end_element = calloc(n, sizeof *b->end_element);
    b->end_vertex = calloc((size_t)m->vertices, sizeof *b->end_vertex);
    b->support = calloc((size_t)m->nodes, sizeof *b->support);
    b->off = calloc((size_t)m->vertices, sizeof *b->off);
    b->account = calloc(n, sizeof *b->account);
    b->body = calloc(2 * n, sizeof *b->body);
    b->balance = calloc(n, sizeof *b->balance);
    b->lacking = calloc(12 * n, sizeof *b->lacking);
    b->crack = calloc(2 * bonds, sizeof *b->crack);
    b->best = calloc((size_t)m->nodes, sizeof *b->best);
    b->broke = calloc(bonds, sizeof *b->broke);
    if (!b->middle || !b->end_element || !b->end_vertex || !b->support || !b->off || !b->account
        || !b->body || !b->balance || !b->lacking || !b->crack || !b->best || !b->broke)
        return BBM_NO_MEMORY;
    const bbm_status status = bbm_begin_cracks(m);
    if (status)
        return status;
    for (int l = 0; l < b->edge_loads; l++) {
        const bbm_vertex *a = &m->vertex[b->edge_load[l].a];
        if (a->edge < 0)
            return bbm_fail(m, BBM_BAD_INDEX, "a loaded edge of element %d is none any more: "
                            "elements have come to lie along it", a->element);
    }
    bbm_note_springs(m, 0);
    return bbm_check_overlap(m);
}

/* Seen from the base, gravity is less by the base's acceleration in the middle of the step. */
static bbm_status begin(bbm_model *m)
{
    bbm_beyond *b = m->beyond;
    const int at_rest = isinf(m->par.dt);
    const double swing = at_rest ? 0 : sin(b->shake_omega * (m->info.t + m->h / 2));

    if (bbm_check_settings(m))
        return BBM_BAD_PARAMETER;
    b->left = m->info.passes == 0 ? 1 : b->left;
    b->share = at_rest ? 1 : m->h / m->par.dt / b->left;
    bbm_place_supports(m);
    for (int a = 0; a < 2; a++)
        m->acceleration[a] -= b->shake[a] * swing;
    b->made *= m->h < m->par.dt;                    /* a step begins whole */
    b->passed[0] = -1;
    return bbm_start_cracks(m);
}

/* A step of these contacts may begin: with T of its middle, if no corner has passed into a block,
 * and in statics if all bodies are held. A new K has no room for the terms of friction yet. What is
 * held all round has neither weight nor inertia in (5). Deviation: in the core it has both, and the
 * springs of (29) give way, more for a larger element. */
static bbm_status listed(bbm_model *m)
{
    if (!m->K->term && (bbm_lay_out_coarse(m) || bbm_lay_out_sliding(m)))
        return BBM_NO_MEMORY;
    for (int i = 0; i < m->elements; i++)
        m->K->body[i] = bbm_is_held_all_round(m, &m->element[i]) ? -1 : m->beyond->body[i];
    bbm_set_middle(m);
    bbm_start_multipliers(m);
    const bbm_status status = bbm_check_passed(m);
    return status ? status : bbm_check_supports(m);
}

/* After a pass: if it turns a block too far, no further one will do; when all has settled,
 * multipliers take over what the springs carry; in the end, and where K is new anyway, T of the
 * step is renewed; then joints and bonds that bear too much break; at last D gets what K has lost,
 * and after that contacts alone are judged. */
static bbm_pass renew(bbm_model *m, bbm_pass next)
{
    if (m->beyond->refines)
        return next;
    if (bbm_contact_turns_over(m))
        return BBM_PASS_GIVE_UP;
    if (next == BBM_PASS_DONE && (next = bbm_take_over(m)) != BBM_PASS_DONE)
        return next;
    if (bbm_settle_loads(m) > 0 || bbm_middle_is_off(m)) {
        bbm_set_middle(m);
        return BBM_PASS_AGAIN;
    }
    if (next == BBM_PASS_DONE && (next = bbm_break_joints(m)) == BBM_PASS_DONE)
        next = bbm_break_bonds(m);
    return next == BBM_PASS_DONE ? bbm_refine(m) : next;
}

static void assembled(bbm_model *m)
{
    bbm_stiffen(m);
    bbm_interpolate_elements(m);
}

/* Moves the model to the end of the step, with the velocities after the jump, if the step went
 * well: right as far as one can tell, no corner passed, no energy from nowhere. */
static bbm_status move(bbm_model *m)
{
    double hit[2] = { 0 };
    bbm_status status;

    if ((status = bbm_check_solution(m)) || (status = bbm_check_equilibrium(m))
        || (status = bbm_check_depth(m)))
        return status;
    bbm_find_reactions(m);
    bbm_model end = bbm_end_of_step(m);
    if ((status = bbm_check_reach(m, &end)) || (status = bbm_check_passing(m, &end))
        || (status = bbm_jump(m, &end, hit)) || (status = bbm_check_balance(m, &end)))
        return status;
    m->beyond->hit[0] += hit[0];
    m->beyond->hit[1] += hit[1];
    bbm_store_multipliers(m);
    bbm_keep_cracks(m);
    memcpy(m->element, end.element, (size_t)m->elements * sizeof *m->element);
    memcpy(m->vertex, end.vertex, (size_t)m->vertices * sizeof *m->vertex);
    bbm_stop_supports(m);
    return BBM_OK;
}

bbm_status bbm_beyond_new(bbm_model **out)
{
    bbm_model *m = bbm_model_new(out) ? NULL : *out;

    if (!m || !(m->beyond = calloc(1, sizeof *m->beyond))) {
        bbm_model_free(m);
        *out = NULL;
        return BBM_NO_MEMORY;
    }
    m->par.pcg.method = &bbm_two_level;
    m->par.round = -1;
    *m->beyond = (bbm_beyond){ .reach = INFINITY, .restitution = -1, .passed = { -1 } };
    *m->hook = (bbm_hooks){
        .release = release,
        .check_polygon = bbm_check_polygon,
        .check = check,
        .begin = begin,
        .motion = bbm_find_motion,
        .find_pairs = bbm_catch_corners,
        .strength = bbm_joint_strength,
        .listed = listed,
        .load = bbm_gather_edge_loads,
        .list_gaps = bbm_list_edge_gaps,
        .assembled = assembled,
        .partner = bbm_find_partner,
        .vectors = bbm_shared_vectors,
        .friction = bbm_put_friction_in_K,
        .renew = renew,
        .move = move,
        .failed = bbm_say_cracks,
    };
    return BBM_OK;
}
