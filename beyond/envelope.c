/* envelope.c - triangular matrices that are factored where they are stored.
 *
 * Of each row everything is stored from its first entry that is not zero to the diagonal: the
 * envelope, which a factorization does not leave. Of K = L U the columns of U lie like the rows of
 * L; of C C^T both are the same. The rows come in pairs that begin in the same column, an even one:
 * they belong to elements or to nodes.
 */
#include <stdlib.h>

#include "beyond.h"

/* Room for one or two triangles, one after the other, whose rows begin at e->left. */
bbm_status bbm_envelope_lay_out(bbm_envelope *e, size_t triangles)
{
    size_t entries = 0;

    e->diagonal = calloc((size_t)e->n, sizeof *e->diagonal);
    if (!e->diagonal)
        return BBM_NO_MEMORY;
    for (int i = 0; i < e->n; i++) {
        e->diagonal[i] = entries + (size_t)(i - e->left[i]);
        entries = e->diagonal[i] + 1;
    }
    e->A = calloc(triangles * entries, sizeof *e->A);
    return e->A ? BBM_OK : BBM_NO_MEMORY;
}

void bbm_envelope_free(bbm_envelope *e)
{
    free(e->left);
    free(e->diagonal);
    free(e->A);
}

/* x.y in four partial sums */
double bbm_dot(int n, const double *x, const double *y)
{
    double sum[4] = { 0 };
    int k = 0;

    for (; k + 4 <= n; k += 4) {
        sum[0] += x[k] * y[k];
        sum[1] += x[k + 1] * y[k + 1];
        sum[2] += x[k + 2] * y[k + 2];
        sum[3] += x[k + 3] * y[k + 3];
    }
    for (; k < n; k++)
        sum[n - k] += x[k] * y[k];
    return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

/* x = U^-1 L^-1 x for the rows from .. to-1, with the columns of U and 1/L_ii, 1/U_ii on the
 * diagonals; on the way back two of them at a time. */
void bbm_substitute(const bbm_envelope *L, const bbm_envelope *U, int from, int to,
                    double *restrict x)
{
    for (int i = from; i < to; i++) {
        const double *row = bbm_entry(L, i, L->left[i]);
        const int n = i - L->left[i];
        x[i] = (x[i] - bbm_dot(n, row, x + L->left[i])) * row[n];
    }
    for (int i = to - 2; i >= from; i -= 2) {
        const double *p = bbm_entry(U, i, U->left[i]), *q = bbm_entry(U, i + 1, U->left[i]);
        const int n = i - U->left[i];
        const double x1 = x[i + 1] * q[n + 1], x0 = (x[i] - q[n] * x1) * p[n];
        double *restrict y = x + U->left[i];
        for (int k = 0; k < n; k += 2) {
            y[k] -= p[k] * x0 + q[k] * x1;
            y[k + 1] -= p[k + 1] * x0 + q[k + 1] * x1;
        }
        x[i] = x0;
        x[i + 1] = x1;
    }
}
