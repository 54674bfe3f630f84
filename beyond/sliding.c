/* sliding.c - friction in the matrix: normal and friction forces that agree in every solution.
 *
 * Beyond the paper, where friction is a load under the N of the last solution. But N is linear in
 * the unknowns, N = -p_n (d_n0 + e.D_i + g.D_j - rest), and so is the friction force
 * sign (N tan(phi) + c A) along the shear vectors s of a sliding contact. Put in,
 *
 *     K += -sign tan(phi) p_n s (x) n,
 *     F -= sign (c A - tan(phi) p_n (d_n0 - rest)) s,          n, s: (e, g) of normal and of shear.
 *
 * The price: K is not symmetric. Each component of K where a contact slides is solved by BiCGSTAB
 * (van der Vorst, SIAM J. Sci. Stat. Comput. 13, 1992), which takes two products with K and with
 * M^-1 for each iteration, but no more vectors the longer it goes on, and no K^T. M is that of
 * solver.c, with the correction of coarse.c if the method has one, and r.M^-1 r is the square of a
 * residual's length, as there:
 *
 *     x = 0,  r = F,  z = M^-1 r,  z0 = z,  p = z
 *     until sqrt(r.z) <= tolerance * its first value:
 *         q = K p,  a = z0.r / z0.q
 *         x += a p,  r -= a q,  d = z - M^-1 r,  z = M^-1 r
 *         q = K z,  v = M^-1 q,  c = z.q / v.q
 *         x += c z,  r -= c q,  z -= c v
 *         p = z + (z0.r / its last value) (a/c) (p - (c/a) d)
 *
 * d is a M^-1 K p. In each iteration z is computed from r once, for if it were only updated, by
 * z -= d, rounding would part the two, and what r has and z has not would stay in r for ever.
 *
 * It may fail. Where it does, and where that is faster, in small components, the solution is by LU,
 *
 *     K = L U,  L_ij = K_ij - sum_k<j L_ik U_kj,  U_ji = (K_ji - sum_k<j L_jk U_ki)/L_jj,  U_ii = 1
 *
 * in the envelope of K, which has the same shape below and above the diagonal: rows of L up to it,
 * columns of U above it. No rows are interchanged.
 *
 * In statics a block that all its contacts let slide is held by nothing. K is singular then, and
 * has no L U; but every x above is made of products with K, and no force asks for that motion:
 * where there is an equilibrium it is found.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "beyond.h"

/* Of a pivot, against the diagonal of K: rounding of what cancelled. */
#define VANISHING 1e-12
/* Block rows up to which LU is faster, measured on walls. */
#define SMALL 100

/* Adds the friction of a sliding contact for the N of the solution; 0: there is none. */
int bbm_put_friction_in_K(bbm_model *m, const bbm_contact *c, const bbm_touch *t,
                          bbm_submatrices *f)
{
    const double p = -c->sign * c->strength.tan_phi * m->par.p_n;
    bbm_term *k = &m->K->term[m->K->terms];
    bbm_spring n, s;

    if (p == 0 || m->trial == BBM_FRICTION_A_LOAD)
        return 0;
    bbm_normal_vectors(t, &n);
    bbm_shear_vectors(t, c->anchor, &s);
    bbm_friction_submatrices(t, c->anchor, p * (n.d - t->rest)
                             + c->sign * c->strength.shear, f);
    if (m->K->is_kept)
        return 1;
    k->row[0] = m->K->place[m->edge[c->corner].element];
    k->row[1] = m->K->place[m->edge[c->edge].element];
    for (int a = 0; a < 6; a++) {
        k->u[0][a] = p * s.e[a];
        k->u[1][a] = p * s.g[a];
        k->v[0][a] = n.e[a];
        k->v[1][a] = n.g[a];
    }
    m->K->terms++;
    return 1;
}

static int is_in_hand(const bbm_matrix *K, const bbm_term *t)
{
    return t->row[0] >= K->from && t->row[0] < K->to;
}

/* y += u v^T x for the rows in hand. Returns the number of terms. */
static int add_terms(const bbm_matrix *K, const double *x, double *y)
{
    int count = 0;

    for (const bbm_term *t = K->term; t < K->term + K->terms; t++) {
        const int i = 6 * t->row[0], j = 6 * t->row[1];
        double vx = 0;
        if (!is_in_hand(K, t))
            continue;
        for (int a = 0; a < 6; a++)
            vx += t->v[0][a] * x[i + a] + t->v[1][a] * x[j + a];
        for (int a = 0; a < 6; a++) {
            y[i + a] += t->u[0][a] * vx;
            y[j + a] += t->u[1][a] * vx;
        }
        count++;
    }
    return count;
}

/* ----------------------------------------------------------------------------------- the factor */

typedef struct {                /* of the rows in hand, which are counted from 0 here           */
    int *left;                  /* [6 rows]  the first column of a row that is not zero         */
    size_t *diagonal;           /* [6 rows]  where L_ii is; the row left of it lies before it   */
    double *L, *U;              /* U by columns                                                 */
} factors;

/* L_ij and U_ji for j <= i: what lies at the same place of row i and of column i. */
static double *lower(const factors *f, int i, int j)
{
    return &f->L[f->diagonal[i] - (size_t)(i - j)];
}

static double *upper(const factors *f, int j, int i)
{
    return &f->U[f->diagonal[i] - (size_t)(i - j)];
}

static bbm_status lay_out(const bbm_matrix *K, factors *f)
{
    const size_t n = 6 * (size_t)(K->to - K->from);
    size_t entries = 0;

    f->left = calloc(n, sizeof *f->left);
    f->diagonal = calloc(n, sizeof *f->diagonal);
    if (!f->left || !f->diagonal)
        return BBM_NO_MEMORY;
    for (int i = K->from; i < K->to; i++) {
        int back = 0;
        for (int k = K->first[i]; k < K->first[i + 1]; k++)
            back = K->back[k] > back ? K->back[k] : back;
        for (int row = 6 * (i - K->from); row < 6 * (i - K->from) + 6; row++) {
            f->left[row] = 6 * (i - K->from - back);
            f->diagonal[row] = entries + (size_t)(row - f->left[row]);
            entries = f->diagonal[row] + 1;
        }
    }
    f->L = calloc(2 * entries, sizeof *f->L);
    f->U = f->L + entries;
    return f->L ? BBM_OK : BBM_NO_MEMORY;
}

/* K_ij = B, and K_ji = B^T, for i >= j. */
static void put_block(const factors *f, int i, int j, double B[6][6])
{
    for (int a = 0; a < 36; a++) {
        const int row = 6 * i + a / 6, column = 6 * j + a % 6;
        if (column <= row)
            *lower(f, row, column) = *upper(f, column, row) = B[a / 6][a % 6];
    }
}

/* The rows in hand of K and its terms. */
static void fill(const bbm_matrix *K, const factors *f)
{
    for (int i = K->from; i < K->to; i++) {
        put_block(f, i - K->from, i - K->from, K->D[i]);
        for (int k = K->first[i]; k < K->first[i + 1]; k++)
            put_block(f, i - K->from, i - K->from - K->back[k], K->L[k]);
    }
    for (const bbm_term *t = K->term; t < K->term + K->terms; t++)
        for (int a = 0; a < 144 && is_in_hand(K, t); a++) {
            const int p = a / 12, q = a % 12, i = 6 * (t->row[p / 6] - K->from) + p % 6;
            const int j = 6 * (t->row[q / 6] - K->from) + q % 6;
            *(i >= j ? lower(f, i, j) : upper(f, i, j)) += t->u[p / 6][p % 6] * t->v[q / 6][q % 6];
        }
}

/* L and U in place of K. Returns the row of a pivot that vanishes or is no number, or n. */
static int factor(const bbm_matrix *K, const factors *f, int n)
{
    for (int i = 0; i < n; i++) {
        for (int j = f->left[i]; j <= i; j++) {
            const int from = f->left[i] > f->left[j] ? f->left[i] : f->left[j];
            double *L = lower(f, i, from), *U = upper(f, from, i);
            L[j - from] -= bbm_dot(j - from, L, upper(f, from, j));
            if (j < i)
                U[j - from] = (U[j - from] - bbm_dot(j - from, lower(f, j, from), U))
                              / *lower(f, j, j);
        }
        const double pivot = *lower(f, i, i);
        const double before = K->D[K->from + i / 6][i % 6][i % 6];
        if (!(fabs(pivot) > VANISHING * before) || isinf(pivot))
            return i;
    }
    return n;
}

/* x = U^-1 L^-1 x */
static void substitute(const factors *f, int n, double *x)
{
    for (int i = 0; i < n; i++) {
        const int left = f->left[i];
        x[i] = (x[i] - bbm_dot(i - left, lower(f, i, left), x + left)) / *lower(f, i, i);
    }
    for (int i = n - 1; i >= 0; i--) {
        const double *U = upper(f, f->left[i], i);
        for (int k = f->left[i]; k < i; k++)
            x[k] -= U[k - f->left[i]] * x[i];
    }
}

/* x = K^-1 x */
static bbm_status solve_directly(const bbm_matrix *K, double *x, bbm_pcg_info *info)
{
    const int n = 6 * (K->to - K->from);
    factors f = { 0 };
    bbm_status status = lay_out(K, &f);

    if (!status) {
        fill(K, &f);
        const int row = factor(K, &f, n);
        status = row < n ? BBM_NOT_POSITIVE_DEFINITE : BBM_OK;
        info->element = row < n ? K->caller[K->from + row / 6] : -1;
    }
    if (!status) {
        substitute(&f, n, x);
        info->iterations++;
    }
    free(f.left);
    free(f.diagonal);
    free(f.L);
    return status;
}

/* ------------------------------------------------------------------------------- the iteration */

/* x += a p, r -= a q */
static void advance(const bbm_matrix *K, double a, const double *p, const double *q)
{
    bbm_combine(K, K->x, a, p, K->x);
    bbm_combine(K, K->r, -a, q, K->r);
}

/* The iteration of the head, from x = 0 and r = F to x; d is room for three vectors, a length is the
 * square root of rz, and `last` is z0.r. */
static bbm_status bicgstab(bbm_matrix *K, double *d, const bbm_pcg *pcg, bbm_pcg_info *info)
{
    double *r = K->r, *z = K->u, *p = K->p, *q = K->q;
    double *z0 = d + 6 * K->n, *v = z0 + 6 * K->n;

    bbm_precondition(K, r, z);
    bbm_combine(K, z, 0, z, z0);
    bbm_combine(K, z, 0, z, p);
    double rz = bbm_dot_rows(K, r, z), last = rz;
    const double stop = pcg->tolerance * sqrt(rz);
    while (!(rz <= stop * stop)) {
        const bbm_status status = bbm_count_iteration(rz, pcg, info);
        if (status)
            return status;
        bbm_multiply(K, p, q);
        const double a = last / bbm_dot_rows(K, z0, q);
        advance(K, a, p, q);
        bbm_combine(K, z, 0, z, d);
        bbm_precondition(K, r, z);
        bbm_combine(K, d, -1, z, d);
        bbm_multiply(K, z, q);
        bbm_precondition(K, q, v);
        const double vq = bbm_dot_rows(K, v, q), c = vq > 0 ? bbm_dot_rows(K, z, q) / vq : 0;
        advance(K, c, z, q);
        bbm_combine(K, z, -c, v, z);
        rz = bbm_dot_rows(K, r, z);
        const double z0r = bbm_dot_rows(K, z0, r);
        bbm_combine(K, p, -c / a, d, p);
        bbm_combine(K, z, z0r / last * (a / c), p, p);
        last = z0r;
    }
    return BBM_OK;
}

static bbm_status iterate(bbm_matrix *K, const bbm_pcg *pcg, bbm_pcg_info *info)
{
    double *z = malloc(3 * 6 * (size_t)K->n * sizeof *z);
    const bbm_status status = z ? bicgstab(K, z, pcg, info) : BBM_NO_MEMORY;

    free(z);
    return status;
}

/* In dynamics K is regular: LU has the last word, after no more iterations than there are
 * unknowns. */
static bbm_status solve_regular(bbm_matrix *K, const bbm_pcg *pcg, bbm_pcg_info *info)
{
    const int unknowns = 6 * (K->to - K->from);
    const size_t bytes = (size_t)unknowns * sizeof(double);
    double *F = malloc(bytes);
    bbm_status status = BBM_NOT_CONVERGED;
    bbm_pcg few = *pcg;

    if (!F)
        return BBM_NO_MEMORY;
    memcpy(F, K->r + 6 * K->from, bytes);
    if (few.iterations > unknowns)
        few.iterations = unknowns;
    if (unknowns > 6 * SMALL)
        status = iterate(K, &few, info);
    if (status) {
        status = solve_directly(K, F, info);
        memcpy(K->x + 6 * K->from, F, status ? 0 : bytes);
    }
    free(F);
    return status;
}

/* Room for the friction of all contacts of a new K. */
bbm_status bbm_lay_out_sliding(bbm_model *m)
{
    m->K->term = calloc((size_t)m->links + 1, sizeof *m->K->term);
    m->K->add_terms = add_terms;
    m->K->solve_terms = bbm_is_static(m) ? iterate : solve_regular;
    return m->K->term ? BBM_OK : BBM_NO_MEMORY;
}
