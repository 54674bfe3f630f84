/* sliding.c - friction in the matrix: normal and friction forces that agree in every solution.
 *
 * Beyond the paper, where friction is a load under the N of the last solution. But N is linear in
 * the unknowns, N = -p_n (d_n0 + e.D_i + g.D_j - rest), and so is the friction force
 * sign (N tan(phi) + c A) along the shear vectors s of a sliding contact. Put in,
 *
 *     K += -sign tan(phi) p_n s (x) n,
 *     F -= sign (c A - tan(phi) p_n (d_n0 - rest)) s,          n, s: (e, g) of normal and of shear.
 *
 * The price: K is not symmetric. Each component of K where a contact slides is solved by LU. In the
 * variables of solver.c, scaled so that the symmetric part of each diagonal block is I,
 *
 *     K = L U,  L_ij = K_ij - sum_k<j L_ik U_kj,  U_ji = (K_ji - sum_k<j L_jk U_ki)/L_jj,  U_ii = 1
 *
 * in the envelope of K, which has the same shape below and above the diagonal: rows of L up to it,
 * columns of U above it. No rows are interchanged. The work grows as the square of the envelope's
 * width; where it does not pay, friction is a load, as it is in statics, where a block that all its
 * contacts let slide is held by nothing: the symmetric K is singular then, but its conjugate
 * gradients find what there is.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "beyond.h"

/* Of a pivot, against the scaled diagonal: rounding of what cancelled. */
#define VANISHING 1e-12
/* LU pays up to so many products of two blocks for each block left of the diagonal: a wall of 1,000
 * bricks takes as long with 20 solutions by LU as with 120 of friction as a load. No more than some
 * 26 kB a block row. */
#define PAYS 700.0

/* ------------------------------------------------------------------------------------- assembly */

/* Adds the friction of a sliding contact for the N of the solution; 0: it is none, or a load. */
int bbm_put_friction_in_K(bbm_model *m, const bbm_contact *c, const bbm_touch *t,
                          bbm_submatrices *f)
{
    const bbm_parameters *joint = bbm_strength_of(m, c);
    const double p = -c->sign * tan(joint->friction * acos(-1) / 180) * m->par.p_n;
    const int row[2] = { m->K->place[m->edge[c->corner].element],
                         m->K->place[m->edge[c->edge].element] };
    bbm_term *k = &m->K->term[m->K->terms];
    bbm_spring n, s;

    if (p == 0 || bbm_is_static(m) || !m->beyond->factor.pays[row[0]])
        return 0;
    bbm_normal_vectors(t, &n);
    bbm_shear_vectors(t, c->anchor, &s);
    bbm_friction_submatrices(t, c->anchor, p * (n.d - t->rest)
                             + c->sign * joint->cohesion * c->area, f);
    if (m->K_is_kept)
        return 1;
    memcpy(k->row, row, sizeof row);
    for (int a = 0; a < 6; a++) {
        k->u[0][a] = p * s.e[a];
        k->u[1][a] = p * s.g[a];
        k->v[0][a] = n.e[a];
        k->v[1][a] = n.g[a];
    }
    m->K->terms++;
    m->K->ready = 0;
    return 1;
}

/* ----------------------------------------------------------------------------------- the factor */

/* L_ij and U_ji for j <= i: what lies at the same place of row i and of column i. */
static double *lower(const bbm_factor *f, int i, int j)
{
    return &f->L[f->diagonal[i] - (size_t)(i - j)];
}

static double *upper(const bbm_factor *f, int j, int i)
{
    return &f->U[f->diagonal[i] - (size_t)(i - j)];
}

/* left and diagonal of the rows in hand, and room for them. */
static bbm_status lay_out(const bbm_matrix *K, bbm_factor *f)
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

/* K += G u (G v)^T */
static void add_term(const bbm_matrix *K, const bbm_factor *f, const bbm_term *t)
{
    double u[12] = { 0 }, v[12] = { 0 };

    for (int a = 0; a < 72; a++) {
        u[a / 6] += K->G[t->row[a / 36]][a / 6 % 6][a % 6] * t->u[a / 36][a % 6];
        v[a / 6] += K->G[t->row[a / 36]][a / 6 % 6][a % 6] * t->v[a / 36][a % 6];
    }
    for (int a = 0; a < 12; a++)
        for (int b = 0; b < 12; b++) {
            const int i = 6 * t->row[a / 6] + a % 6, j = 6 * t->row[b / 6] + b % 6;
            *(i >= j ? lower(f, i, j) : upper(f, i, j)) += u[a] * v[b];
        }
}

/* The rows in hand of the scaled K = I + (S + S^T)/w and its terms. */
static void fill(const bbm_matrix *K, const bbm_factor *f)
{
    for (int i = K->from; i < K->to; i++) {
        for (int row = 6 * i; row < 6 * i + 6; row++)
            *lower(f, row, row) = 1;
        for (int k = K->first[i]; k < K->first[i + 1]; k++)
            for (int a = 0; a < 36; a++) {
                const int row = 6 * i + a / 6, column = 6 * (i - K->back[k]) + a % 6;
                *lower(f, row, column) = *upper(f, column, row)
                    = K->S[k][a / 6][a % 6] / K->omega;
            }
    }
    for (int t = 0; t < K->terms; t++)
        if (K->term[t].row[0] >= K->from && K->term[t].row[0] < K->to)
            add_term(K, f, &K->term[t]);
}

/* L and U in place of K. Returns the row of a pivot that vanishes or is no number, or -1. */
static int factor(const bbm_matrix *K, const bbm_factor *f)
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
static bbm_status solve_sliding(bbm_matrix *K, const bbm_pcg *pcg, bbm_pcg_info *info)
{
    bbm_factor *f = &K->beyond->factor;
    double *x = K->x;

    (void)pcg;
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
        x[i] /= K->omega;
    }
    info->iterations = 1;
    return BBM_OK;
}

/* ------------------------------------------------------------------------------------- a new K */

/* Where LU pays. */
static void find_work(const bbm_matrix *K, int pays[])
{
    for (int c = 0; c < K->components; c++) {
        double work = 0;
        for (int i = K->start[c]; i < K->start[c + 1]; i++) {
            double back = 0;
            for (int k = K->first[i]; k < K->first[i + 1]; k++)
                back = fmax(back, K->back[k]);
            work += back * back;
        }
        for (int i = K->start[c]; i < K->start[c + 1]; i++)
            pays[i] = work <= PAYS * (K->first[K->start[c + 1]] - K->first[K->start[c]]);
    }
}

void bbm_free_factor(bbm_factor *f)
{
    free(f->term);
    free(f->pays);
    free(f->diagonal);
    free(f->L);
    *f = (bbm_factor){ 0 };
}

/* Room for the friction of all contacts. */
bbm_status bbm_lay_out_sliding(bbm_model *m)
{
    const size_t n = (size_t)m->K->n;
    bbm_factor *f = &m->beyond->factor;

    bbm_free_factor(f);
    f->term = calloc((size_t)m->pairs + 1, sizeof *f->term);
    f->pays = calloc(7 * n, sizeof *f->pays);
    f->diagonal = calloc(6 * n, sizeof *f->diagonal);
    if (!f->term || !f->pays || !f->diagonal)
        return BBM_NO_MEMORY;
    f->left = f->pays + n;
    find_work(m->K, f->pays);
    m->K->term = f->term;
    m->K->beyond = m->beyond;
    m->K->solve_terms = solve_sliding;
    return BBM_OK;
}
