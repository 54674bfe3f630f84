/* solver.c - the linear solver of section 4, SSOR-PCG: K D = F by conjugate gradients with SSOR as
 * the preconditioner.
 *
 * K is symmetric and consists of 6x6 blocks, a block row for each element. Write
 *
 *     K = L + D + L^T,      D: the diagonal blocks,  L: the blocks left of them.
 *
 * The D of the equations, the unknowns, is x below. Only the diagonal blocks and those of L that
 * are not zero are stored, row by row. The rows are in reverse Cuthill-McKee order, which
 * base/order.c makes. With a relaxation factor w, 0 < w < 2, the iteration is:
 *
 *     M = (D/w + L) (D/w)^-1 (D/w + L)^T
 *
 *     x = 0,  r = F,  u = M^-1 r,  p = u
 *     until sqrt(r.u) <= tolerance * its first value:
 *         a = r.u / p.K p
 *         x += a p,  r -= a K p
 *         u = M^-1 r
 *         p = u + (r.u / its last value) p
 *
 * M is never formed. u = M^-1 r takes two sweeps over the rows of L, forward for y, backward for u:
 *
 *     (D/w + L) y = r,      (D/w + L)^T u = (D/w) y
 *
 * M often has a factor 1/(2-w). It is left out, for it changes neither x nor the number of
 * iterations.
 *
 * Components. Elements that bonds and contacts join, directly or through others, make a component
 * of K. Each component is solved by itself: its rows are `from` to `to` - 1, it has its own scale
 * of F and its own end of the iteration, and no other component changes a bit of its x. If all were
 * one iteration, the forces of a stone that flies past would set the scale, and the small forces in
 * a pile at rest would stay unsolved.
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
#include <stdlib.h>
#include <string.h>

#include "base/base.h"

/* [-] in place of a zero of F, against its largest entry */
#define NEGLIGIBLE 1e-100

/* ----------------------------------------------------------------------------------- the matrix */

void bbm_matrix_clear(bbm_matrix *K)
{
    memset(K->D, 0, (size_t)(K->n + K->first[K->n]) * sizeof *K->D);
    K->ready = K->terms = K->lacks = 0;
}

/* Where K_ij is stored, or K_ji if row i comes before row j; NULL: nowhere. Most rows have one to
 * three blocks left of the diagonal, so that all are looked at. */
static double (*find_block(const bbm_matrix *K, int i, int j))[6]
{
    if (i < 0 || i >= K->n || j < 0 || j >= K->n)
        return NULL;
    const int a = K->place[i], b = K->place[j], row = a > b ? a : b, left = abs(a - b);

    for (int k = K->first[row]; k < K->first[row + 1]; k++)
        if (K->back[k] == left)
            return K->L[k];
    return left == 0 ? K->D[row] : NULL;
}

/* K_ij += B; if K_ji is stored, K_ji += B^T. */
bbm_status bbm_matrix_add(bbm_matrix *K, int i, int j, double B[6][6])
{
    double (*to)[6] = find_block(K, i, j);

    K->lacks |= !to;
    if (!to)
        return BBM_BAD_INDEX;
    const int right = K->place[i] < K->place[j];
    for (int a = 0; a < 6; a++)
        for (int b = 0; b < 6; b++)
            to[a][b] += right ? B[b][a] : B[a][b];
    K->ready = 0;
    return BBM_OK;
}

/* ----------------------------------------------------------------------------- products of blocks
 * These loops let a compiler do two entries at a time without a change in the order of a sum. */

/* y += c B x */
static void multiply_add(double c, double B[6][6], const double *restrict x, double *restrict y)
{
    for (int a = 0; a < 6; a++)
        y[a] += c * ((B[a][0] * x[0] + B[a][1] * x[1]) + (B[a][2] * x[2] + B[a][3] * x[3])
                     + (B[a][4] * x[4] + B[a][5] * x[5]));
}

/* y += c B^T x */
static void multiply_add_transposed(double c, double B[6][6], const double *restrict x,
                                    double *restrict y)
{
    for (int b = 0; b < 6; b++)
        y[b] += c * ((B[0][b] * x[0] + B[1][b] * x[1]) + (B[2][b] * x[2] + B[3][b] * x[3])
                     + (B[4][b] * x[4] + B[5][b] * x[5]));
}

/* y = B x for a symmetric B. */
static void multiply_symmetric(double B[6][6], const double *restrict x, double *restrict y)
{
    for (int b = 0; b < 6; b++)
        y[b] = (B[0][b] * x[0] + B[1][b] * x[1]) + (B[2][b] * x[2] + B[3][b] * x[3])
             + (B[4][b] * x[4] + B[5][b] * x[5]);
}

/* ---------------------------------------------- products with K, in the rows of one component */

/* y += L x */
void bbm_add_lower(const bbm_matrix *K, const double *x, double *y)
{
    for (int i = K->from; i < K->to; i++)
        for (int k = K->first[i]; k < K->first[i + 1]; k++)
            multiply_add(1, K->L[k], x + 6 * (i - K->back[k]), y + 6 * i);
}

/* y += L^T x */
void bbm_add_upper(const bbm_matrix *K, const double *x, double *y)
{
    for (int i = K->from; i < K->to; i++)
        for (int k = K->first[i]; k < K->first[i + 1]; k++)
            multiply_add_transposed(1, K->L[k], x + 6 * i, y + 6 * (i - K->back[k]));
}

/* q = K p = D p + L p + L^T p in one pass over L, and the terms of a hook. */
void bbm_multiply(const bbm_matrix *K, const double *p, double *q)
{
    for (int i = K->from; i < K->to; i++) {
        multiply_symmetric(K->D[i], p + 6 * i, q + 6 * i);
        for (int k = K->first[i]; k < K->first[i + 1]; k++) {
            multiply_add(1, K->L[k], p + 6 * (i - K->back[k]), q + 6 * i);
            multiply_add_transposed(1, K->L[k], p + 6 * i, q + 6 * (i - K->back[k]));
        }
    }
    if (K->terms > 0)
        K->add_terms(K, p, q);
}

/* x.y */
double bbm_dot_rows(const bbm_matrix *K, const double *x, const double *y)
{
    double s = 0;

    for (int i = 6 * K->from; i < 6 * K->to; i += 6)
        s += (x[i] * y[i] + x[i + 1] * y[i + 1]) + (x[i + 2] * y[i + 2] + x[i + 3] * y[i + 3])
           + (x[i + 4] * y[i + 4] + x[i + 5] * y[i + 5]);
    return s;
}

/* z = x + c y; z may be x or y. */
void bbm_combine(const bbm_matrix *K, const double *x, double c, const double *y, double *z)
{
    for (int i = 6 * K->from; i < 6 * K->to; i++)
        z[i] = x[i] + c * y[i];
}

/* ------------------------------------------------------------------------------------- SSOR-PCG */

/* Solves (D/w + L) y = r for y, and leaves f = r - L y = (D/w) y. */
static void sweep_forward(const bbm_matrix *K, const double *r, double *y, double *f)
{
    for (int i = K->from; i < K->to; i++) {
        memcpy(f + 6 * i, r + 6 * i, 6 * sizeof *f);
        for (int k = K->first[i]; k < K->first[i + 1]; k++)
            multiply_add(-1, K->L[k], y + 6 * (i - K->back[k]), f + 6 * i);
        multiply_symmetric(K->inverse[i], f + 6 * i, y + 6 * i);
    }
}

/* Solves (D/w + L)^T u = f for u. On entry `u` holds f. */
static void sweep_backward(const bbm_matrix *K, double *u)
{
    for (int i = K->to - 1; i >= K->from; i--) {
        double f[6];
        memcpy(f, u + 6 * i, sizeof f);
        multiply_symmetric(K->inverse[i], f, u + 6 * i);
        for (int k = K->first[i]; k < K->first[i + 1]; k++)
            multiply_add_transposed(-1, K->L[k], u + 6 * i, u + 6 * (i - K->back[k]));
    }
}

/* u = M^-1 r. A method may change f between the sweeps. */
void bbm_precondition(const bbm_matrix *K, const double *r, double *u)
{
    sweep_forward(K, r, K->y, u);
    if (K->method && K->method->correct)
        K->method->correct(K, K->y, u);
    sweep_backward(K, u);
}

/* Counts an iteration. Refuses it if the limit is reached, or if p.K p is not positive: then K is
 * not positive definite, or p.K p is NaN. */
bbm_status bbm_count_iteration(double pKp, const bbm_pcg *pcg, bbm_pcg_info *info)
{
    if (info->iterations == pcg->iterations)
        return BBM_NOT_CONVERGED;
    if (!(pKp > 0))
        return BBM_NOT_POSITIVE_DEFINITE;
    info->iterations++;
    return BBM_OK;
}

/* SSOR-PCG, the iteration on top of this file. On entry x = 0, p = 0, r = F. */
static bbm_status iterate(bbm_matrix *K, const bbm_pcg *pcg, bbm_pcg_info *info)
{
    double *x = K->x, *r = K->r, *u = K->u, *p = K->p, *q = K->q, b = 0;

    bbm_precondition(K, r, u);
    double ru = bbm_dot_rows(K, r, u);
    const double stop = pcg->tolerance * sqrt(ru);
    while (!(sqrt(ru) <= stop)) {
        bbm_combine(K, u, b, p, p);             /* p = u + b p */
        bbm_multiply(K, p, q);                  /* q = K p     */
        const double pKp = bbm_dot_rows(K, p, q), a = ru / pKp, last = ru;
        const bbm_status status = bbm_count_iteration(pKp, pcg, info);
        if (status)
            return status;
        bbm_combine(K, x, a, p, x);             /* x += a p    */
        bbm_combine(K, r, -a, q, r);            /* r -= a q    */
        bbm_precondition(K, r, u);              /* u = M^-1 r  */
        ru = bbm_dot_rows(K, r, u);
        b = ru / last;
    }
    return BBM_OK;
}

/* --------------------------------------------------------------------------------- the solution */

static int all_finite(size_t count, const double *x)
{
    for (size_t i = 0; i < count; i++)
        if (!isfinite(x[i]))
            return 0;
    return 1;
}

/* B = (D/w)^-1. Gauss-Jordan elimination turns B from D into -D^-1, symmetric in each step; then B
 * is multiplied by -w. Returns 0 if D is not positive definite. */
static int invert(double w, double D[6][6], double B[6][6])
{
    memcpy(B, D, 36 * sizeof **B);
    for (int k = 0; k < 6; k++) {
        double row[6];
        if (!(B[k][k] > 0))
            return 0;
        const double scale = 1 / B[k][k];
        memcpy(row, B[k], sizeof row);
        for (int i = 0; i < 6; i++)
            for (int j = 0; j < 6; j++)
                B[i][j] -= row[i] * row[j] * scale;
        for (int i = 0; i < 6; i++)
            B[k][i] = B[i][k] = row[i] * scale;
        B[k][k] = -scale;
    }
    for (int a = 0; a < 36; a++)
        B[a / 6][a % 6] *= -w;
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
        if (!invert(K->omega, K->D[i], K->inverse[i])) {
            info->element = K->caller[i];
            return BBM_NOT_POSITIVE_DEFINITE;
        }
    if (K->method && K->method->make_ready)
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

/* Notes the largest force in each component. The tolerance is a share of these where the F of
 * bbm_solve is larger. A spring that closes a gap begins with a force far above the one that it
 * carries in the end. A small share of the first may be more than the second. */
void bbm_matrix_measure(bbm_matrix *K, const double *F)
{
    for (int c = 0; c < K->components; c++) {
        K->from = K->start[c];
        K->to = K->start[c + 1];
        K->forces[c] = largest(K, F, 2);
    }
}

/* Solves one component. If its iteration fails, its rows of the solution D are the last x. */
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
    const bbm_status status = (has_terms ? K->solve_terms : iterate)(K, &pcg, info);
    bbm_multiply(K, K->x, K->q);
    for (int i = 6 * K->from; i < 6 * K->to; i++) {
        const int row = 6 * K->caller[i / 6] + i % 6;
        const double f = F[row] / scale, r = f - K->q[i];
        D[row] = scale * K->x[i];
        rr += r * r;
        ff += f * f;
    }
    info->residual = sqrt(rr / ff);
    return status;
}

/* K D = F, component by component. A component that fails does not stop the others. If no iteration
 * could begin, D is 0, and info has 0 iterations and residual 1. */
bbm_status bbm_solve(bbm_matrix *K, const double *F, double *D, const bbm_pcg *wanted,
                     bbm_pcg_info *info)
{
    const clock_t start = clock();
    bbm_pcg pcg = *wanted;

    *info = (bbm_pcg_info){ .residual = 1, .element = -1 };
    memset(D, 0, 6 * (size_t)K->n * sizeof *D);
    if (pcg.method && pcg.method->choose)
        pcg.method->choose(K, &pcg);
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
    K->from = 0;
    K->to = K->n;
    info->seconds[1] = (double)(clock() - ready) / CLOCKS_PER_SEC;
    return !status && !all_finite(6 * (size_t)K->n, D) ? BBM_NOT_FINITE : status;
}
