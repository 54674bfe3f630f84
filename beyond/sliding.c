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
 * z -= d, rounding would part the two, and what r has and z has not would stay in r for ever. Where
 * z and q are nearly orthogonal c would be nothing, and the iteration would stop for ever: c is at
 * least LEAST sqrt(r.z/v.q).
 *
 * Terms are few, so that K without them is nearly K. In small components, where that is faster, M
 * is this whole matrix, factored by factor.c.
 *
 * In statics a block that all its contacts let slide is held by nothing, and K is singular. But no
 * force asks for that motion, and it is in no residual: where there is an equilibrium it is found.
 * Where there is none, it is given up: with M factored, after as many iterations as there are terms
 * and 100 more. M^-1 K is the unit matrix plus one of that rank, so that as many are enough but for
 * rounding.
 */
#include "beyond.h"

/* Block rows up to which K without its terms is factored. Measured: walls that stand take 0.01 of
 * the time with 800 rows, ten steps of walls 0.5 with 800, 0.4 with 1600. An eighth as many with a
 * coarse space: meshes in contact take as long with 177 rows, 1.3 times as long with 325. */
#define SMALL 2000
/* Of c, against |z|/|q| in these norms (Sleijpen, van der Vorst, Numer. Algorithms 10, 1995). */
#define LEAST 0.7
/* Of the residual that rounding left, what the second iteration leaves. */
#define AGAIN 1e-6

/* y += u v^T x for the rows in hand. Returns the number of terms. */
static int add_terms(const bbm_matrix *K, const double *x, double *y)
{
    int count = 0;

    for (const bbm_term *t = K->term; t < K->term + K->terms; t++)
        if (t->row[0] >= K->from && t->row[0] < K->to) {
            const double vx = bbm_length_of(&t->n, t->parts, t->row, x);
            for (int k = 0; k < 6 * t->parts; k++)
                y[6 * t->row[k / 6] + k % 6] += t->p * t->s.v[k / 6][k % 6] * vx;
            count++;
        }
    return count;
}

/* --------------------------------------------------------------------------- the preconditioner */

/* K_ij, j <= i, of the rows in hand, which are counted from 0 in f; an element has three pairs. */
static void put_block(const bbm_factor *f, int i, int j, double B[6][6])
{
    for (int a = 0; a < 36; a++) {
        const int row = 6 * i + a / 6, column = 6 * j + a % 6;
        if (column <= row)
            *bbm_entry(f, row, column) = B[a / 6][a % 6];
        if (column == row)
            f->size[row] = B[a / 6][a % 6];
    }
}

/* Factors the rows in hand without their terms. */
static bbm_status factor(const bbm_matrix *K, bbm_factor *f)
{
    const int rows = K->to - K->from, blocks = K->first[K->to] - K->first[K->from];
    int (*entry)[2] = calloc(9 * (size_t)(rows + blocks), sizeof *entry), n = 0;

    for (int i = 0; i < rows && entry; i++)
        for (int k = K->first[K->from + i]; k <= K->first[K->from + i + 1]; k++)
            for (int a = 0; a < 9; a++, n++) {
                entry[n][0] = 3 * (k < K->first[K->from + i + 1] ? i - K->back[k] : i) + a % 3;
                entry[n][1] = 3 * i + a / 3;
            }
    bbm_status status = entry ? bbm_factor_lay_out(f, 3 * rows, n, entry) : BBM_NO_MEMORY;
    for (int i = 0; i < rows && !status; i++) {
        put_block(f, i, i, K->D[K->from + i]);
        for (int k = K->first[K->from + i]; k < K->first[K->from + i + 1]; k++)
            put_block(f, i, i - K->back[k], K->L[k]);
    }
    if (!status)
        bbm_factor_make(f);
    free(entry);
    return status;
}

/* u = M^-1 r. f->A: NULL, too large to be factored. */
static void precondition(const bbm_matrix *K, const bbm_factor *f, const double *r, double *u)
{
    if (f->A) {
        bbm_combine(K, r, 0, r, u);
        bbm_substitute(f, 0, f->n, u + 6 * K->from);
    } else
        bbm_precondition(K, r, u);
}

/* ------------------------------------------------------------------------------- the iteration */

/* The iteration of the head, from x and r = F - K x on. d: room for three vectors; `last` is z0.r.
 * `stop` is a length of r, or 0: the tolerance times the first. */
static bbm_status iterate(bbm_matrix *K, const bbm_factor *f, double *d, double *stop,
                          const bbm_pcg *pcg, bbm_pcg_info *info)
{
    double *r = K->r, *z = K->u, *p = K->p, *q = K->q, *z0 = d + 6 * K->n, *v = z0 + 6 * K->n;
    bbm_status status = BBM_OK;

    precondition(K, f, r, z);
    bbm_combine(K, z, 0, z, z0);
    bbm_combine(K, z, 0, z, p);
    double rz = bbm_dot_rows(K, r, z), last = rz;
    *stop = fmax(*stop, (*stop > 0 ? AGAIN : pcg->tolerance) * sqrt(rz));
    while (!(rz <= *stop * *stop) && !(status = bbm_count_iteration(rz, pcg, info))) {
        bbm_multiply(K, p, q);
        const double a = last / bbm_dot_rows(K, z0, q);
        bbm_combine(K, K->x, a, p, K->x);
        bbm_combine(K, r, -a, q, r);
        bbm_combine(K, z, 0, z, d);
        precondition(K, f, r, z);
        bbm_combine(K, d, -1, z, d);
        bbm_multiply(K, z, q);
        precondition(K, f, q, v);
        const double vq = bbm_dot_rows(K, v, q), zq = bbm_dot_rows(K, z, q);
        const double least = LEAST * sqrt(bbm_dot_rows(K, r, z) / vq);
        const double c = vq > 0 ? copysign(fmax(fabs(zq / vq), least), zq) : 0;
        bbm_combine(K, K->x, c, z, K->x);
        bbm_combine(K, r, -c, q, r);
        bbm_combine(K, z, -c, v, z);
        rz = bbm_dot_rows(K, r, z);
        const double z0r = bbm_dot_rows(K, z0, r);
        bbm_combine(K, p, -c / a, d, p);
        bbm_combine(K, z, z0r / last * (a / c), p, p);
        last = z0r;
    }
    return status;
}

/* K x = F for the rows in hand. */
static bbm_status solve(bbm_matrix *K, const bbm_pcg *wanted, bbm_pcg_info *info)
{
    const int rows = K->to - K->from, few = K->terms + 100;
    bbm_pcg pcg = *wanted;
    bbm_factor f = { 0 };
    double *d = malloc(24 * (size_t)K->n * sizeof *d), *F = d + 18 * K->n, stop = 0;

    if (!d)
        return BBM_NO_MEMORY;
    bbm_combine(K, K->r, 0, K->r, F);
    bbm_status status = rows <= (K->extra ? SMALL / 8 : SMALL) ? factor(K, &f) : BBM_OK;
    pcg.iterations = f.A && few < pcg.iterations ? few : pcg.iterations;
    for (int again = 0; again < 2 && !status; again++) {
        status = iterate(K, &f, d, &stop, &pcg, info);
        bbm_multiply(K, K->x, K->q);
        bbm_combine(K, F, -1, K->q, K->r);
    }
    bbm_factor_free(&f);
    free(d);
    return status;
}

/* Puts the friction of a sliding contact into K, for the N of the solution; returns the load, what
 * it is at D = 0. The length of v[0], its normal spring, counts from `rest`. */
double bbm_put_friction_in_K(bbm_model *m, const bbm_contact *c, const bbm_spring v[2])
{
    const double p = -c->sign * c->strength.tan_phi * bbm_normal_stiffness(m);
    bbm_term t = { c->parts, { 0 }, p, v[1], v[0] };

    t.n.d = 0;
    for (int i = 0; i < c->parts; i++)
        t.row[i] = m->K->place[c->element[i]];
    if (p != 0)
        m->K->term[m->K->terms++] = t;
    return p * v[0].d + c->sign * c->strength.shear;
}

/* Room for the friction of all contacts of a new K. */
bbm_status bbm_lay_out_sliding(bbm_model *m)
{
    m->K->term = calloc((size_t)m->links + 1, sizeof *m->K->term);
    m->K->add_terms = add_terms;
    m->K->solve_terms = solve;
    return m->K->term ? BBM_OK : BBM_NO_MEMORY;
}
