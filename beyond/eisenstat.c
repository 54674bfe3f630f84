/* eisenstat.c - the paper's SSOR-PCG in the variables between its two sweeps.
 *
 * Eisenstat's trick (SIAM J. Sci. Stat. Comput. 2, 1981). The scaled matrix of solver.c is
 *
 *     w K = w I + S + S^T = E + E^T - (2-w) I,      E = I + S,
 *
 * so that w E^-1 K E^-T p costs no product, only the two sweeps that the preconditioner needs in
 * any case:
 *
 *     x = 0,  r = E^-1 F,  p = r
 *     until sqrt(r.r) <= tolerance * its first value:
 *         t = E^-T p                          backward sweep
 *         y = E^-1 (p - (2-w) t)              forward sweep
 *         a = r.r / p.(t + y)
 *         x += a t,  r -= a (t + y)
 *         p = r + (r.r / its last value) p
 *
 * The iterates are those of solver.c but for rounding, and so is the end: r.r here is r.u there.
 * What is left out is the product with K. What is left is so little that reading and writing the
 * vectors counts, too, and steps that use the same ones are done together.
 */
#include <math.h>

#include "beyond.h"

/* p.(t + y) */
static double dot_sum(const bbm_matrix *K, const double *p, const double *t, const double *y)
{
    double s = 0;

    for (int i = 6 * K->from; i < 6 * K->to; i += 6)
        s += (p[i] * (t[i] + y[i]) + p[i + 1] * (t[i + 1] + y[i + 1]))
           + (p[i + 2] * (t[i + 2] + y[i + 2]) + p[i + 3] * (t[i + 3] + y[i + 3]))
           + (p[i + 4] * (t[i + 4] + y[i + 4]) + p[i + 5] * (t[i + 5] + y[i + 5]));
    return s;
}

/* x += a t, r -= a (t + y). Returns r.r. */
static double advance(const bbm_matrix *K, double a, const double *restrict t,
                      const double *restrict y)
{
    double *restrict x = K->x, *restrict r = K->r, even = 0, odd = 0;

    for (int i = 6 * K->from; i < 6 * K->to; i += 2) {
        x[i] += a * t[i];
        x[i + 1] += a * t[i + 1];
        r[i] -= a * (t[i] + y[i]);
        r[i + 1] -= a * (t[i + 1] + y[i + 1]);
        even += r[i] * r[i];
        odd += r[i + 1] * r[i + 1];
    }
    return even + odd;
}

/* p = r + b p, and a copy of it in t. */
static void new_direction(const bbm_matrix *K, double b, double *restrict p, double *restrict t)
{
    const double *restrict r = K->r;

    for (int i = 6 * K->from; i < 6 * K->to; i += 2) {
        p[i] = t[i] = r[i] + b * p[i];
        p[i + 1] = t[i + 1] = r[i + 1] + b * p[i + 1];
    }
}

static bbm_status iterate(bbm_matrix *K, const bbm_pcg *pcg, bbm_pcg_info *info)
{
    double *t = K->u, *y = K->y;

    bbm_multiply_lower(K, -1, K->r, K->r);
    double rr = dot_sum(K, K->r, K->r, K->q);           /* q = 0 */
    new_direction(K, 0, K->p, t);
    const double stop = pcg->tolerance * sqrt(rr);
    while (!(sqrt(rr) <= stop)) {
        bbm_multiply_upper(K, -1, t, t);
        bbm_combine(K, K->p, K->omega - 2, t, y);
        bbm_multiply_lower(K, -1, y, y);
        const double pq = dot_sum(K, K->p, t, y), last = rr;
        const bbm_status status = bbm_count_iteration(pq, pcg, info);
        if (status)
            return status;
        rr = advance(K, rr / pq, t, y);
        new_direction(K, rr / last, K->p, t);
    }
    return BBM_OK;
}

const bbm_method bbm_eisenstat = { .iterate = iterate };
