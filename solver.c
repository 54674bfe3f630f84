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
 * K falls into components, which are solved one by one. The rows of the one in hand are `from` to
 * `to` - 1. base/solve.c does what stands around the iteration.
 */
#include "base/base.h"

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

/* B = (D/w)^-1. Gauss-Jordan elimination leaves -D^-1 in B, which is symmetric in each step. The
 * last loop multiplies by -w. Returns 0 if D is not positive definite. */
int bbm_invert(double w, double D[6][6], double B[6][6])
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

/* Counts an iteration. Refuses it if the limit is reached, or if p.K p, or r.z of a hook's method,
 * is not positive: then K is not positive definite, or it is NaN. */
bbm_status bbm_count_iteration(double positive, const bbm_pcg *pcg, bbm_pcg_info *info)
{
    if (info->iterations == pcg->iterations)
        return BBM_NOT_CONVERGED;
    if (!(positive > 0))
        return BBM_NOT_POSITIVE_DEFINITE;
    info->iterations++;
    return BBM_OK;
}

/* SSOR-PCG, the iteration on top of this file. On entry x = 0, p = 0, r = F. */
bbm_status bbm_iterate(bbm_matrix *K, const bbm_pcg *pcg, bbm_pcg_info *info)
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
