/* solve.c - K D = F around the iteration of solver.c: components, scaling, what is made ready.
 *
 * Components. Elements that bonds and contacts join, directly or through others, make a component
 * of K. Each component is solved by itself: its rows are `from` to `to` - 1, it has its own scale
 * of F and its own end of the iteration, and no other component changes a bit of its x.
 *
 * What a tolerance can mean. The r of the iteration becomes as small as one likes. But F - K x does
 * not become smaller than about eps |K| |x|, eps = 2e-16; in a stiff body that is 1e-10 |F| or
 * more. So a tolerance much below 1e-10 costs iterations and gains nothing. bbm_solve stops by r,
 * and then reports the residual F - K x, computed afresh.
 *
 * Denormals. When a single element is loaded, a sweep carries the load from element to element and
 * weakens it each time, down to numbers below 1e-308. Many processors take ten or a hundred times
 * longer on these. Therefore F is scaled to a largest entry near 1, and its zeros become
 * NEGLIGIBLE. That is too small to change a result, and its square is still far above 1e-308.
 */
#include "base.h"

/* [-] in place of a zero of F, against its largest entry */
#define NEGLIGIBLE 1e-100
/* [-] of the largest force on a body of the component: with less it has next to none */
#define NEXT_TO_NONE 1e-6

static int all_finite(size_t count, const double *x)
{
    for (size_t i = 0; i < count; i++)
        if (!isfinite(x[i]))
            return 0;
    return 1;
}

/* Checks K, F and the parameters, then inverts the diagonal blocks. If one is not positive
 * definite, info->element is its row. Further solutions with the same K find this done. */
static bbm_status make_ready(bbm_matrix *K, const double *F, const bbm_pcg *pcg, bbm_pcg_info *info)
{
    if (!(pcg->omega > 0 && pcg->omega < 2) || !(pcg->tolerance > 0 && pcg->tolerance < 1)
        || pcg->iterations < 1)
        return BBM_BAD_PARAMETER;
    if (K->lacks)
        return BBM_BAD_INDEX;
    if (!all_finite(6 * (size_t)K->n, F))
        return BBM_NOT_FINITE;
    if (K->ready && K->method == pcg->method && K->omega == pcg->omega)
        return BBM_OK;
    K->method = pcg->method;
    K->omega = pcg->omega;
    if (!all_finite(36 * (size_t)(K->n + K->first[K->n]), **K->D))
        return BBM_NOT_FINITE;
    for (int i = 0; i < K->n; i++)
        if (!bbm_invert(K->omega, K->D[i], K->inverse[i])) {
            info->element = K->caller[i];
            return BBM_NOT_POSITIVE_DEFINITE;
        }
    if (K->method)
        K->method->make_ready(K);
    K->ready = 1;
    return BBM_OK;
}

/* The largest of the first so many entries of each six of F in the component. */
static double largest(const bbm_matrix *K, const double *F, int entries)
{
    double most = 0;

    for (int i = K->from; i < K->to; i++)
        for (int a = 0; a < entries; a++)
            most = fmax(most, fabs(F[6 * K->caller[i] + a]));
    return most;
}

/* Notes of each body its largest force, and of these the least in each component. The tolerance is
 * a share of that where the F of bbm_solve is larger, so that a light body is solved beside a heavy
 * one. Held bodies do not count, unless all are held, nor those that have next to no force. A
 * spring that closes a gap also begins with a force far above the one that it carries in the end.
 */
void bbm_matrix_measure(bbm_matrix *K, const double *F)
{
    double *on = K->y;                              /* [bodies] the largest force on each */

    memset(on, 0, (size_t)K->n * sizeof *on);
    for (int k = 0; k < 6 * K->n; k++)
        if (k % 6 < 2 && K->body[k / 6] >= 0)
            on[K->body[k / 6]] = fmax(on[K->body[k / 6]], fabs(F[k]));
    for (int c = 0; c < K->components; c++) {
        double most = 0, least = INFINITY;
        K->from = K->start[c];
        K->to = K->start[c + 1];
        for (const int *row = K->caller + K->from; row < K->caller + K->to; row++)
            if (K->body[*row] >= 0)
                most = fmax(most, on[K->body[*row]]);
        for (const int *row = K->caller + K->from; row < K->caller + K->to; row++)
            if (K->body[*row] >= 0 && on[K->body[*row]] >= NEXT_TO_NONE * most)
                least = fmin(least, on[K->body[*row]]);
        K->forces[c] = most > 0 ? least : largest(K, F, 2);
    }
}

/* Solves one component. If its iteration fails, its rows of the solution D are the last x. What is
 * held is solved once more by itself: the force that moves a support is so large that the share of
 * it that the iteration leaves may be more than the support bears. */
static bbm_status solve_component(bbm_matrix *K, const double *F, double *D, double forces,
                                  bbm_pcg pcg, bbm_pcg_info *info)
{
    const double most = largest(K, F, 6), now = largest(K, F, 2);
    double rr = 0, ff = 0;

    if (most == 0)
        return BBM_OK;
    const double scale = ldexp(1, ilogb(most));     /* a power of two: division rounds nothing */
    if (forces > 0 && forces < now)
        pcg.tolerance *= forces / now;
    for (int i = 6 * K->from; i < 6 * K->to; i++) {
        const double f = F[6 * K->caller[i / 6] + i % 6] / scale;
        K->r[i] = f == 0 ? NEGLIGIBLE : f;
        K->x[i] = K->p[i] = K->q[i] = 0;
    }
    const int has_terms = K->terms > 0 && K->add_terms(K, K->x, K->q);
    const bbm_status status = (has_terms ? K->solve_terms : bbm_iterate)(K, &pcg, info);
    bbm_multiply(K, K->x, K->q);
    for (int i = 6 * K->from; i < 6 * K->to; i++) {
        const int row = 6 * K->caller[i / 6] + i % 6;
        const double f = F[row] / scale;
        K->r[i] = f - K->q[i];
        D[row] = scale * K->x[i];
        rr += K->r[i] * K->r[i];
        ff += f * f;
    }
    for (int i = K->from; i < K->to; i++)
        for (int a = 0; a < 36 && K->body[K->caller[i]] < 0; a++)
            D[6 * K->caller[i] + a / 6] += scale / K->omega * K->inverse[i][a / 6][a % 6]
                                         * K->r[6 * i + a % 6];
    info->residual = sqrt(rr / ff);
    return status;
}

/* K D = F, component by component. A component that fails does not stop the others. If no iteration
 * could begin, D is 0, and info has 0 iterations and residual 1. A method has w = 1. Where it keeps
 * nothing with K, the paper's takes its place. */
bbm_status bbm_solve(bbm_matrix *K, const double *F, double *D, const bbm_pcg *wanted,
                     bbm_pcg_info *info)
{
    const clock_t start = clock();
    bbm_pcg pcg = *wanted;

    *info = (bbm_pcg_info){ .residual = 1, .element = -1 };
    memset(D, 0, 6 * (size_t)K->n * sizeof *D);
    pcg.method = K->extra ? pcg.method : NULL;
    pcg.omega = pcg.method ? 1 : pcg.omega;
    bbm_status status = make_ready(K, F, &pcg, info);
    const clock_t ready = clock();
    info->seconds[0] = (double)(ready - start) / CLOCKS_PER_SEC;
    if (status)
        return status;
    info->residual = 0;
    for (int c = 0; c < K->components; c++) {
        bbm_pcg_info one = { 0 };
        K->from = K->start[c];
        K->to = K->start[c + 1];
        const bbm_status s = solve_component(K, F, D, K->forces[c], pcg, &one);
        status = status ? status : s;
        info->iterations = one.iterations > info->iterations ? one.iterations : info->iterations;
        info->residual = one.residual <= info->residual ? info->residual : one.residual;
    }
    info->seconds[1] = (double)(clock() - ready) / CLOCKS_PER_SEC;
    return !status && !all_finite(6 * (size_t)K->n, D) ? BBM_NOT_FINITE : status;
}
