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
 * (van der Vorst, SIAM J. Sci. Stat. Comput. 13, 1992), which takes two products with K for each
 * iteration, but no more vectors the longer it goes on, and no K^T. It iterates between the sweeps
 * of SSOR as eisenstat.c does, with the correction of coarse.c where the method has one. In the
 * scaled variables of solver.c, with B the correction,
 *
 *     A = w E^-1 K E^-T B,      K = (E + E^T - (2-w) I)/w + sum u v^T
 *
 *     r = E^-1 F,  r0 = r,  x = p = 0
 *     until sqrt(r.r) <= tolerance * its first value:
 *         p = r + (r0.r / its last value) (a/w') (p - w' A p)
 *         a = r0.r / r0.A p,   x += a E^-T B p,   r -= a A p
 *         w' = r.A r / A r.A r,   x += w' E^-T B r,   r -= w' A r
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

/* Of a pivot, against the scaled diagonal: rounding of what cancelled. */
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

/* The terms of the rows in hand, scaled: w G u and G v. */
static void scale_terms(const bbm_matrix *K, bbm_sliding *s)
{
    s->terms = 0;
    for (int k = 0; k < K->terms; k++) {
        const bbm_term *t = &K->term[k];
        if (t->row[0] < K->from || t->row[0] >= K->to)
            continue;
        bbm_term *to = &s->scaled[s->terms++];
        *to = (bbm_term){ .row = { t->row[0], t->row[1] } };
        for (int a = 0; a < 72; a++) {
            const int end = a / 36, i = a / 6 % 6, j = a % 6;
            const double G = K->G[t->row[end]][i][j];
            to->u[end][i] += K->omega * G * t->u[end][j];
            to->v[end][i] += G * t->v[end][j];
        }
    }
}

/* ----------------------------------------------------------------------------------- the factor */

/* L_ij and U_ji for j <= i: what lies at the same place of row i and of column i. */
static double *lower(const bbm_sliding *f, int i, int j)
{
    return &f->L[f->diagonal[i] - (size_t)(i - j)];
}

static double *upper(const bbm_sliding *f, int j, int i)
{
    return &f->U[f->diagonal[i] - (size_t)(i - j)];
}

/* left and diagonal of the rows in hand, and room for them. */
static bbm_status lay_out(const bbm_matrix *K, bbm_sliding *f)
{
    size_t entries = 0;

    for (int i = K->from; i < K->to; i++) {
        int back = 0;
        for (int k = K->first[i]; k < K->first[i + 1]; k++)
            back = K->back[k] > back ? K->back[k] : back;
        for (int row = 6 * i; row < 6 * i + 6; row++) {
            f->left[row] = 6 * (i - back);
            f->diagonal[row] = entries + (size_t)(row - f->left[row]);
            entries = f->diagonal[row] + 1;
        }
    }
    if (entries > f->room) {
        free(f->L);
        f->L = malloc(2 * entries * sizeof *f->L);
        f->room = f->L ? entries : 0;
    }
    f->U = f->L + entries;
    if (f->L)
        memset(f->L, 0, 2 * entries * sizeof *f->L);
    return f->L ? BBM_OK : BBM_NO_MEMORY;
}

/* The rows in hand of the scaled w K = w I + S + S^T and its terms. */
static void fill(const bbm_matrix *K, const bbm_sliding *f)
{
    for (int i = K->from; i < K->to; i++) {
        for (int row = 6 * i; row < 6 * i + 6; row++)
            *lower(f, row, row) = K->omega;
        for (int k = K->first[i]; k < K->first[i + 1]; k++)
            for (int a = 0; a < 36; a++) {
                const int row = 6 * i + a / 6, column = 6 * (i - K->back[k]) + a % 6;
                *lower(f, row, column) = *upper(f, column, row) = K->S[k][a / 6][a % 6];
            }
    }
    for (const bbm_term *t = f->scaled; t < f->scaled + f->terms; t++)
        for (int a = 0; a < 144; a++) {
            const int p = a / 12, q = a % 12;
            const int i = 6 * t->row[p / 6] + p % 6, j = 6 * t->row[q / 6] + q % 6;
            *(i >= j ? lower(f, i, j) : upper(f, i, j)) += t->u[p / 6][p % 6] * t->v[q / 6][q % 6];
        }
}

/* L and U in place of K. Returns the row of a pivot that vanishes or is no number, or -1. */
static int factor(const bbm_matrix *K, const bbm_sliding *f)
{
    for (int i = 6 * K->from; i < 6 * K->to; i++) {
        for (int j = f->left[i]; j <= i; j++) {
            const int from = f->left[i] > f->left[j] ? f->left[i] : f->left[j];
            const int n = j - from;
            double *L = lower(f, i, from), *U = upper(f, from, i);
            L[n] -= bbm_dot(n, L, upper(f, from, j));
            if (j < i)
                U[n] = (U[n] - bbm_dot(n, lower(f, j, from), U)) / *lower(f, j, j);
        }
        const double pivot = *lower(f, i, i);
        if (!(fabs(pivot) > VANISHING) || isinf(pivot))
            return i / 6;
    }
    return -1;
}

/* x = K^-1 r */
static bbm_status solve_directly(bbm_matrix *K, bbm_pcg_info *info)
{
    bbm_sliding *f = &K->beyond->sliding;
    double *x = K->x;

    if (lay_out(K, f))
        return BBM_NO_MEMORY;
    fill(K, f);
    const int singular = factor(K, f);
    info->element = singular < 0 ? -1 : K->caller[singular];
    if (singular >= 0)
        return BBM_NOT_POSITIVE_DEFINITE;
    for (int i = 6 * K->from; i < 6 * K->to; i++) {
        const int left = f->left[i];
        x[i] = (K->r[i] - bbm_dot(i - left, lower(f, i, left), x + left)) / *lower(f, i, i);
    }
    for (int i = 6 * K->to - 1; i >= 6 * K->from; i--) {
        const double *U = upper(f, f->left[i], i);
        for (int k = f->left[i]; k < i; k++)
            x[k] -= U[k - f->left[i]] * x[i];
    }
    info->iterations++;
    return BBM_OK;
}

/* ------------------------------------------------------------------------------- the iteration */

static void add_terms(const bbm_sliding *s, const double *x, double *y)
{
    for (int k = 0; k < s->terms; k++) {
        const bbm_term *t = &s->scaled[k];
        const int i = 6 * t->row[0], j = 6 * t->row[1];
        double vx = 0;
        for (int a = 0; a < 6; a++)
            vx += t->v[0][a] * x[i + a] + t->v[1][a] * x[j + a];
        for (int a = 0; a < 6; a++) {
            y[i + a] += t->u[0][a] * vx;
            y[j + a] += t->u[1][a] * vx;
        }
    }
}

/* u = E^-T B p and q = A p = u + E^-1 (B p - (2-w) u + w sum u v^T u). */
static void multiply(const bbm_matrix *K, const double *p, double *q)
{
    double *u = K->u;

    bbm_combine(K, p, 0, p, K->y);
    if (K->method->correct)
        K->method->correct(K, K->y);
    bbm_combine(K, K->y, 0, K->y, u);
    bbm_multiply_upper(K, -1, u, u);
    bbm_combine(K, K->y, K->omega - 2, u, q);
    add_terms(&K->beyond->sliding, u, q);
    bbm_multiply_lower(K, -1, q, q);
    bbm_combine(K, q, 1, u, q);
}

static double dot(const bbm_matrix *K, const double *x, const double *y)
{
    return bbm_dot(6 * (K->to - K->from), x + 6 * K->from, y + 6 * K->from);
}

/* x += a u, r -= a q. Returns r.r. */
static double advance(const bbm_matrix *K, double a, const double *q)
{
    bbm_combine(K, K->x, a, K->u, K->x);
    bbm_combine(K, K->r, -a, q, K->r);
    return dot(K, K->r, K->r);
}

static bbm_status iterate(bbm_matrix *K, const bbm_pcg *pcg, bbm_pcg_info *info)
{
    bbm_sliding *s = &K->beyond->sliding;
    double *r = K->r, *p = K->p, *Ar = K->q, *Ap = s->Ap, *r0 = s->r0, b = 0, w = 0;

    bbm_multiply_lower(K, -1, r, r);
    bbm_combine(K, r, 0, r, r0);
    bbm_combine(K, p, 0, p, Ap);
    double rr = dot(K, r, r), rho = rr;
    const double stop = pcg->tolerance * sqrt(rr);
    while (!(sqrt(rr) <= stop)) {
        const bbm_status status = bbm_count_iteration(rr, pcg, info);
        if (status)
            return status;
        bbm_combine(K, p, -w, Ap, p);
        bbm_combine(K, r, b, p, p);
        multiply(K, p, Ap);
        const double a = rho / dot(K, r0, Ap), last = rho;
        advance(K, a, Ap);
        multiply(K, r, Ar);
        const double tt = dot(K, Ar, Ar);
        w = tt > 0 ? dot(K, Ar, r) / tt : 0;
        rr = advance(K, w, Ar);
        rho = dot(K, r0, r);
        b = rho / last * (a / w);
    }
    return BBM_OK;
}

/* In dynamics LU has the last word, after no more iterations than there are unknowns. */
static bbm_status solve_sliding(bbm_matrix *K, const bbm_pcg *pcg, bbm_pcg_info *info)
{
    bbm_sliding *s = &K->beyond->sliding;
    const int unknowns = 6 * (K->to - K->from);
    bbm_pcg few = *pcg;

    scale_terms(K, s);
    if (s->may_factor && unknowns <= 6 * SMALL)
        return solve_directly(K, info);
    if (s->may_factor && few.iterations > unknowns)
        few.iterations = unknowns;
    const bbm_status status = iterate(K, &few, info);
    if (!status || !s->may_factor)
        return status;
    bbm_combine(K, s->r0, 0, s->r0, K->r);
    bbm_multiply_lower(K, 1, s->r0, K->r);              /* r = E r0 */
    return solve_directly(K, info);
}

/* ------------------------------------------------------------------------------------- a new K */

void bbm_free_sliding(bbm_sliding *s)
{
    free(s->term);
    free(s->r0);
    free(s->left);
    free(s->diagonal);
    free(s->L);
    *s = (bbm_sliding){ 0 };
}

/* Room for the friction of all contacts of a new K. */
bbm_status bbm_lay_out_sliding(bbm_model *m)
{
    const size_t n = 6 * (size_t)m->K->n, pairs = (size_t)m->links + 1;
    bbm_sliding *s = &m->beyond->sliding;

    bbm_free_sliding(s);
    s->term = calloc(2 * pairs, sizeof *s->term);
    s->r0 = calloc(2 * n, sizeof *s->r0);
    s->left = calloc(n, sizeof *s->left);
    s->diagonal = calloc(n, sizeof *s->diagonal);
    if (!s->term || !s->r0 || !s->left || !s->diagonal)
        return BBM_NO_MEMORY;
    s->may_factor = !bbm_is_static(m);
    s->scaled = s->term + pairs;
    s->Ap = s->r0 + n;
    m->K->term = s->term;
    m->K->beyond = m->beyond;
    m->K->solve_terms = solve_sliding;
    return BBM_OK;
}
