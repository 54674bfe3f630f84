/* step.c - the time step: here the parts of the paper come together.
 *
 *     bbm_assemble    K and F of all submatrices of section 3, Eq. (5)
 *     bbm_try_step    Fig. 8: contacts, K D = F, the open-close iteration, the update
 *     bbm_step        one time step: a step that fails is done again in halves
 *     bbm_run         all steps, or up to the criterion (71) of statics
 *     bbm_nodal_result, bbm_mises    the results of section 4
 *
 * Statics is without inertia: each step is one iteration of Newton-Raphson on the geometry that the
 * last step left.
 */
#include "base.h"

/* ------------------------------------------------------------------- assembly, Eq. (5) */

/* The next gap of the list, between the elements i and j. A hook's `own` stays from list to list.
 * bbm_prepare has made room for bbm_most_gaps. */
bbm_gap *bbm_add_gap(bbm_model *m, int i, int j)
{
    bbm_gap *g = &m->gap[m->gaps++];
    *g = (bbm_gap){ .i = i, .j = j, .own = g->own };
    return g;
}

/* Lists the springs of a bond, one at each vertex. */
void bbm_list_bond(bbm_model *m, const bbm_bond *b)
{
    const bbm_element *i = &m->element[b->i], *j = &m->element[b->j];

    for (int end = 0; end < 2; end++)
        bbm_bonding_gap(i, &m->vertex[b->p[end]], j, &m->vertex[b->q[end]],
                        bbm_bonding_stiffness(m->par.alpha, i, j), bbm_add_gap(m, b->i, b->j));
}

/* Lists the spring of a vertex at a fixed point. */
void bbm_list_fixed_point(bbm_model *m, int v, const bbm_node *W)
{
    const bbm_vertex *P = &m->vertex[v];
    const bbm_element *e = &m->element[P->element];

    if (W->held)
        bbm_fixed_gap(e, P, W, bbm_fixed_stiffness(m->par.alpha, e),
                      bbm_add_gap(m, P->element, -1));
}

/* Lists the gaps of bonds and fixed points, or those of a hook. */
void bbm_list_gaps(bbm_model *m)
{
    m->gaps = 0;
    if (m->hook->list_gaps) {
        m->hook->list_gaps(m);
        return;
    }
    for (int b = 0; b < m->bonds; b++)
        bbm_list_bond(m, &m->bond[b]);
    for (int v = 0; v < m->vertices; v++)
        bbm_list_fixed_point(m, v, &m->node[m->vertex[v].node]);
}

/* The part of F that comes from outside: gravity and volume forces (3.6), loads at nodes and along
 * lines (3.5). The elements that meet at a node share its load equally. */
static void gather_loads(bbm_model *m)
{
    memset(m->load, 0, 6 * (size_t)m->elements * sizeof *m->load);
    for (int i = 0; i < m->elements; i++) {
        if (m->K->body[i] >= 0)                     /* supports bear what they hold all round   */
            bbm_gravity_submatrix(&m->element[i], m->acceleration, &m->load[6 * i]);
        bbm_volume_submatrix(&m->element[i], m->element[i].f, &m->load[6 * i]);
    }
    for (int v = 0; v < m->vertices; v++) {
        const int i = m->vertex[v].element, n = m->vertex[v].node;
        const int adjacent = m->adjacent_first[n + 1] - m->adjacent_first[n];
        const double share[2] = { m->node[n].load[0] / adjacent, m->node[n].load[1] / adjacent };
        bbm_point_load(&m->element[i], m->vertex[v].x, m->vertex[v].y, share, &m->load[6 * i]);
    }
    for (int l = 0; l < m->line_loads; l++) {
        const bbm_line_load *line = &m->line_load[l];
        const bbm_vertex *a = &m->vertex[line->a], *b = &m->vertex[line->b];
        const bbm_element *e = &m->element[a->element];
        if (line->constant)
            bbm_constant_load_submatrix(e, a, b, line->f[0], &m->load[6 * a->element]);
        else
            bbm_varying_load_submatrix(e, a, b, line->f, &m->load[6 * a->element]);
    }
    if (m->hook->load)
        m->hook->load(m);
}

/* Adds the submatrices of two elements, or of i and the wall (j < 0), to K and F. */
void bbm_add_submatrices(bbm_model *m, int i, int j, bbm_submatrices *s)
{
    bbm_matrix_add(m->K, i, i, s->Kii);
    for (int a = 0; a < 6; a++)
        m->F[6 * i + a] += s->Fi[a];
    if (j < 0)
        return;
    for (int a = 0; a < 36 && i == j; a++)          /* within one element: K_ji is there, too  */
        s->Kjj[a / 6][a % 6] += s->Kij[a % 6][a / 6];
    bbm_matrix_add(m->K, i, j, s->Kij);
    bbm_matrix_add(m->K, j, j, s->Kjj);
    for (int a = 0; a < 6; a++)
        m->F[6 * j + a] += s->Fj[a];
}

void bbm_assemble_gap(bbm_model *m, const bbm_gap *g)
{
    bbm_submatrices s = { .Fi = { 0 } };

    bbm_bonding_submatrices(g, &s);
    bbm_add_submatrices(m, g->i, g->j, &s);
}

/* K and F, Eq. (5), for the positions at the start of the step and the present contact states. The
 * forces are measured before fixed points and contacts come: these close gaps with a first force
 * that is far too large. */
void bbm_assemble(bbm_model *m)
{
    const clock_t start = clock();
    int g = 0;

    bbm_matrix_clear(m->K);
    gather_loads(m);                                /* a hook's load may depend on D: part of K */
    memcpy(m->F, m->load, 6 * (size_t)m->elements * sizeof *m->F);
    for (int i = 0; i < m->elements; i++) {
        bbm_submatrix s = { { { 0 } }, { 0 } };
        bbm_elastic_submatrix(&m->element[i], &s);
        if (bbm_has_inertia(m, i))
            bbm_inertia_submatrix(&m->element[i], m->h, &s);
        bbm_matrix_add(m->K, i, i, s.K);
        for (int a = 0; a < 6; a++)
            m->F[6 * i + a] += s.F[a];
    }
    for (; g < m->gaps && m->gap[g].j >= 0; g++)    /* bonds */
        bbm_assemble_gap(m, &m->gap[g]);
    bbm_matrix_measure(m->K, m->F);
    for (; g < m->gaps; g++)                        /* fixed points */
        bbm_assemble_gap(m, &m->gap[g]);
    bbm_assemble_contacts(m);
    if (m->hook->assembled)
        m->hook->assembled(m);
    m->info.seconds[BBM_ASSEMBLE] += (double)(clock() - start) / CLOCKS_PER_SEC;
}

/* ------------------------------------------------------------- the parts of a time step */

/* Geometry of the elements, and a first guess at D for the detection: by velocity, in statics 0. */
bbm_status bbm_begin_step(bbm_model *m)
{
    for (int i = 0; i < m->elements; i++)
        bbm_element_geometry(&m->element[i], &m->vertex[m->element[i].first]);
    memcpy(m->acceleration, m->par.gravity, sizeof m->acceleration);
    const bbm_status status = m->hook->begin ? m->hook->begin(m) : BBM_OK;
    bbm_foresee_step(m);
    return status;
}

/* Lists the contacts that may close in the step, and lays out K for them: at first for the guess at
 * D, later for a solution that moves further than the list allows. `holds`: the list was right for
 * the solution in hand, which therefore holds. */
bbm_status bbm_detect(bbm_model *m, int *holds)
{
    const clock_t start = clock();

    *holds = 1;
    if (m->detections > 0 && !bbm_moved_too_far(m))
        return BBM_OK;
    if (m->detections == BBM_MAX_DETECTIONS)
        return bbm_say_what_failed(m, BBM_OPEN_CLOSE);
    bbm_status status = bbm_detect_contacts(m, holds);
    m->info.seconds[BBM_DETECT] += (double)(clock() - start) / CLOCKS_PER_SEC;
    if (status || *holds)
        return status;
    bbm_list_gaps(m);
    status = bbm_lay_out_matrix(m);
    return status || !m->hook->listed ? status : m->hook->listed(m);
}

/* Solves K D = F, Eq. (5), section 4, and counts the work. */
static bbm_status solve(bbm_model *m)
{
    if (m->monitor && m->monitor(m, m->monitor_context))
        return bbm_fail(m, BBM_STOPPED, "step %d", m->info.step + 1);
    const bbm_status status = bbm_solve(m->K, m->F, m->D, &m->par.pcg, &m->info.pcg);
    m->info.iterations += m->info.pcg.iterations;
    m->info.seconds[BBM_PRECONDITION] += m->info.pcg.seconds[0];
    m->info.seconds[BBM_ITERATE] += m->info.pcg.seconds[1];
    return status ? bbm_say_what_failed(m, status) : BBM_OK;
}

/* One pass of the open-close iteration. A step that has taken too much work ends as one that does
 * not settle. */
static bbm_status open_close(bbm_model *m, bbm_pass *pass)
{
    *pass = bbm_open_close(m);
    return *pass == BBM_PASS_GIVE_UP || (*pass == BBM_PASS_AGAIN && bbm_is_spent(m))
         ? bbm_say_what_failed(m, BBM_OPEN_CLOSE) : BBM_OK;
}

/* Moves the elements and vertices of the model, or of a copy, by the D of the model: vertices by
 * Eq. (1), (3), stress by Eq. (7), (8), velocity by Eq. (14). */
void bbm_move_elements(const bbm_model *m, bbm_element element[], bbm_vertex vertex[])
{
    const bbm_motion *motion = m->hook->motion ? m->hook->motion(m, 1) : NULL;
    double E[3][3], u[2];

    for (bbm_element *e = element; e < element + m->elements; e++) {
        memcpy(e->D, &m->D[6 * (e - element)], sizeof e->D);
        const bbm_element start = *e;
        for (bbm_vertex *p = &vertex[e->first]; p < &vertex[e->first + e->n]; p++) {
            bbm_move(motion, e, e->D, p->x, p->y, u);
            p->u += u[0];
            p->v += u[1];
            p->x = m->node[p->node].x - m->origin[0] + p->u;
            p->y = m->node[p->node].y - m->origin[1] + p->v;
        }
        bbm_elastic_matrix(&e->material, E);
        for (int a = 0; a < 3; a++) {
            for (int b = 0; b < 3; b++)
                e->stress[a] += E[a][b] * e->D[3 + b];
            e->szz += e->out_of_plane * (E[0][a] + E[1][a]) * e->D[3 + a];
            e->sum[a] += e->D[a];
        }
        if (bbm_is_static(m))
            memset(e->V, 0, sizeof e->V);
        else
            bbm_newmark_velocity(e, m->h, m->par.velocity_factor > 0);  /* its share: bbm_step */
        if (motion)
            motion->turn(&start, e, &vertex[e->first]);
    }
}

/* Moves the model by its D, Eq. (3), unless a hook refuses the solution. info.change becomes the
 * left side of Eq. (71) over the right side without its tolerance. */
static bbm_status update(bbm_model *m)
{
    const bbm_status status = m->hook->move ? m->hook->move(m) : BBM_OK;
    double step2 = 0, sum2 = 0;

    if (status)
        return status;
    if (!m->hook->move)
        bbm_move_elements(m, m->element, m->vertex);
    for (const bbm_element *e = m->element; e < m->element + m->elements; e++) {
        step2 += e->D[0] * e->D[0] + e->D[1] * e->D[1];
        sum2 += e->sum[0] * e->sum[0] + e->sum[1] * e->sum[1];
    }
    m->info.change = sum2 > 0 ? sqrt(step2 / sum2) : 0;
    m->info.t += bbm_is_static(m) ? 0 : m->h;
    bbm_store_contacts(m);
    return BBM_OK;
}

/* --------------------------------------------------------------- the time step, Fig. 8 */

/* Fig. 8 once, with the step m->h. The model moves in `update` alone, when all has settled. */
bbm_status bbm_try_step(bbm_model *m)
{
    bbm_status status = bbm_begin_step(m);
    bbm_pass pass = BBM_PASS_AGAIN;
    int holds = 0;

    if (!status)
        status = bbm_detect(m, &holds);             /* 3.7: which contacts may close            */
    while (!status && !holds) {
        do {
            if (pass != BBM_PASS_SAME_K)
                bbm_assemble(m);                    /* K, F: 3.1 to 3.8                         */
            status = solve(m);                      /* K D = F: section 4                       */
            if (!status)
                status = open_close(m, &pass);      /* 3.7: do the contacts fit the solution?   */
        } while (!status && pass != BBM_PASS_DONE);
        if (!status)
            status = bbm_detect(m, &holds);         /* too far for the list of contacts?        */
    }
    return status ? status : update(m);             /* positions, stresses, velocities          */
}

/* One part of a step, of length h. If it fails it is done again as two halves, down to dt/4096. A
 * static step has no halves. */
static bbm_status take_part(bbm_model *m, double h, int tries)
{
    m->h = h;
    bbm_status status = bbm_try_step(m);
    const int parts = bbm_parts_to_try(m, status, tries);

    for (int k = 0; k < parts && (k == 0 || !status); k++)
        status = take_part(m, h / parts, tries + 1);
    return status;
}

/* One time step, Fig. 8. Velocities keep their share at its end, in however many parts it was
 * taken; with a share of 0 each part begins at rest. If it fails, the model stays as the last part
 * that went well left it. */
bbm_status bbm_step(bbm_model *m)
{
    bbm_status status = bbm_check_step(m);

    if (!status)
        status = take_part(m, m->par.dt, 0);
    for (int k = 0; k < 6 * m->elements && !status; k++)
        m->element[k / 6].V[k % 6] *= m->par.velocity_factor;
    if (status && m->K && m->hook->failed)
        status = m->hook->failed(m, status);        /* a hook may find another way            */
    m->info.step += !status;
    return status == BBM_NO_MEMORY ? bbm_out_of_memory(m) : status;
}

/* All time steps. With a tolerance they end when the last step is small against the sum of all
 * steps, Eq. (71): sqrt(sum |step_i|^2) <= tolerance sqrt(sum |total_i|^2), over the barycentres i.
 * `update` computes the two sides. */
bbm_status bbm_run(bbm_model *m)
{
    int step = 0;

    do {
        const bbm_status status = bbm_step(m);
        if (status)
            return status;
        if (m->par.tolerance > 0 && m->info.change <= m->par.tolerance)
            return BBM_OK;
    } while (++step < m->par.steps);
    return m->par.tolerance == 0 ? BBM_OK
         : bbm_fail(m, BBM_STEPS_EXHAUSTED, "change %.2g after step %d, expected %.2g",
                    m->info.change, m->info.step, m->par.tolerance);
}

/* ------------------------------------------------------------------ results, section 4 */

/* von Mises stress. In the paper szz = 0. */
double bbm_mises(const double s[3], double szz)
{
    return sqrt(s[0] * s[0] - s[0] * s[1] + s[1] * s[1] + 3 * s[2] * s[2]
                + szz * (szz - s[0] - s[1]));
}

/* Displacement and nodal stress. */
bbm_status bbm_nodal_result(const bbm_model *m, int node, int block, bbm_result *r)
{
    int count = 0;

    *r = (bbm_result){ 0 };
    if (!m->is_prepared || node < 0 || node >= m->nodes)
        return BBM_BAD_INDEX;
    for (int a = m->adjacent_first[node]; a < m->adjacent_first[node + 1]; a++) {
        const bbm_vertex *v = &m->vertex[m->adjacent[a]];
        const bbm_element *e = &m->element[v->element];
        if (block != -1 && e->block != block)
            continue;
        r->u += v->u;
        r->v += v->v;
        for (int k = 0; k < 3; k++)
            r->stress[k] += e->stress[k];
        r->szz += e->szz;
        count++;
    }
    if (count == 0)
        return BBM_BAD_INDEX;
    r->u /= count;
    r->v /= count;
    for (int k = 0; k < 3; k++)
        r->stress[k] /= count;
    r->szz /= count;
    r->mises = bbm_mises(r->stress, r->szz);
    return BBM_OK;
}
