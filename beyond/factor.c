/* factor.c - Cholesky's factor of a symmetric matrix, K = C C^T, without most of its zeros.
 *
 * The rows come in pairs, the two unknowns of a node. Of a pair of rows of C those columns are
 * stored that are not zero for the pattern of K, as parts: runs of columns one beside the other, of
 * which the last ends with the diagonal. The factorization does not leave them.
 *
 * Which columns those are is known beforehand (J. W. H. Liu, ACM Trans. Math. Software 12, 1986).
 * Call the first row below the diagonal at which column j of C is not zero its parent. If C_ij is
 * not zero, nor is C_ik for the parent k of j. So the columns of row i are those of K in that row,
 * their parents, and so on up to i. They are few or many by the order of the rows.
 */
#include "beyond.h"

/* Of a pivot, against what it is measured by: rounding of what cancelled. */
#define VANISHING 1e-12

/* ----------------------------------------------------------------------------------- the layout */

typedef struct {
    int *last, *before;         /* the last entry of K in row i, [n], and the one before an     */
                                /* entry in its row, [entries]; -1: none                        */
    int *parent;                /* [n]      of column j, -1: none yet                           */
    int *seen;                  /* [n]      the row that has column j, the last one so far      */
    int parts;                  /* found so far                                                 */
} search;

static size_t width(const bbm_part *p) { return 2 * (size_t)(p->to - p->from); }

static size_t place_in(const bbm_part *p, int j) { return p->at + 2 * (size_t)(j - p->from); }

static bbm_status add_part(bbm_factor *f, search *s, int j)
{
    const bbm_part column = { j, j + 1, 0 };

    return bbm_append(NULL, (void **)&f->part, &s->parts, sizeof column, &column, NULL);
}

/* The parts of row i: its columns in the order of the walk, sorted, then those side by side as one
 * part. */
static bbm_status find_parts(bbm_factor *f, search *s, int i, int (*entry)[2])
{
    int n = s->parts;
    bbm_status status = add_part(f, s, i);

    f->first[i] = n;
    s->seen[i] = i;
    for (int k = s->last[i]; k >= 0; k = s->before[k])
        for (int j = entry[k][0] + entry[k][1] - i; s->seen[j] != i && !status; j = s->parent[j]) {
            s->parent[j] = s->parent[j] < 0 ? i : s->parent[j];
            s->seen[j] = i;
            status = add_part(f, s, j);
        }
    if (status)
        return status;
    qsort(f->part + n, (size_t)(s->parts - n), sizeof *f->part, bbm_compare_pairs);
    for (int k = n + 1; k < s->parts; k++)
        if (f->part[k].from == f->part[n].to)
            f->part[n].to = f->part[k].to;
        else
            f->part[++n] = f->part[k];
    s->parts = n + 1;
    return BBM_OK;
}

/* Room for C of n pairs of rows: K is not zero at the entries, two pairs of rows each, in any
 * order; some may come twice, and the diagonal need not be among them. */
bbm_status bbm_factor_lay_out(bbm_factor *f, int n, int entries, int (*entry)[2])
{
    const size_t rows = (size_t)n;
    int *memory = malloc((3 * rows + (size_t)entries + 1) * sizeof *memory);
    search s = { memory, memory + 3 * rows, memory + rows, memory + 2 * rows, 0 };
    bbm_status status = memory ? BBM_OK : BBM_NO_MEMORY;

    f->n = n;
    f->first = calloc(rows + 1, sizeof *f->first);
    if (memory && f->first) {
        memset(memory, -1, 3 * rows * sizeof *memory);
        for (int k = 0; k < entries; k++) {
            const int row = entry[k][entry[k][0] < entry[k][1]];
            s.before[k] = s.last[row];
            s.last[row] = k;
        }
        for (int i = 0; i < n && !status; i++)
            status = find_parts(f, &s, i, entry);
        f->first[n] = s.parts;
        for (int k = 0; k < s.parts; f->entries += 2 * width(&f->part[k++]))
            f->part[k].at = f->entries;
        f->A = status ? NULL : calloc(f->entries + 2 * rows + 1, sizeof *f->A);
        f->size = f->A ? f->A + f->entries : NULL;
    }
    free(memory);
    return f->A ? BBM_OK : BBM_NO_MEMORY;
}

void bbm_factor_free(bbm_factor *f)
{
    free(f->first);
    free(f->part);
    free(f->A);
}

/* K_ij, then C_ij, of the rows i and j <= i. */
double *bbm_entry(const bbm_factor *f, int i, int j)
{
    const bbm_part *p = f->part + f->first[i / 2 + 1] - 1;

    while (p->from > j / 2)
        p--;
    return f->A + place_in(p, j / 2) + (size_t)(i % 2) * width(p) + j % 2;
}

/* ----------------------------------------------------------------------------------- the factor */

/* s += the products of two rows at a with two at b over n columns, an even number; the second row
 * lies m or l behind the first, or is the same. Each has two partial sums: one would wait for each
 * addition. */
static void add_products(size_t n, const double *a, size_t m, const double *b, size_t l,
                         double s[4])
{
    double sum[4][2] = { { 0 } };

    for (size_t k = 0; k < n; k += 2)
        for (size_t e = 0; e < 2; e++) {
            sum[0][e] += a[k + e] * b[k + e];
            sum[1][e] += a[k + e] * b[l + k + e];
            sum[2][e] += a[m + k + e] * b[k + e];
            sum[3][e] += a[m + k + e] * b[l + k + e];
        }
    for (int k = 0; k < 4; k++)
        s[k] += sum[k][0] + sum[k][1];
}

/* s += the products of the rows i with the rows j <= i, pairs both, over the columns before j. */
static void multiply_rows(const bbm_factor *f, int i, int j, double s[4])
{
    const bbm_part *p = f->part + f->first[i], *q = f->part + f->first[j];
    const bbm_part *end = f->part + f->first[j + 1];

    while (q < end) {
        const int from = p->from > q->from ? p->from : q->from;
        const int stop = q + 1 == end ? j : q->to, to = p->to < stop ? p->to : stop;
        if (from < to)
            add_products(2 * (size_t)(to - from), f->A + place_in(p, from), width(p),
                         f->A + place_in(q, from), width(q), s);
        p += p->to < stop;
        q += to == stop;
    }
}

/* 1/C_jj from C_jj^2; 0, which strikes out the row, where that vanishes against `size`. */
static double find_pivot(double square, double size)
{
    return square > VANISHING * size ? 1 / sqrt(square) : 0;
}

/* C_ij in place of K_ij in the part p of the rows i, two rows and two columns at a time, on the
 * diagonal 1/C_jj:
 *
 *     C_ij = (K_ij - sum_k<j C_ik C_jk)/C_jj,      C_jj^2 = K_jj - sum_k<j C_jk^2. */
static void make_entry(const bbm_factor *f, int i, int j, const bbm_part *p)
{
    const double *d = bbm_entry(f, 2 * j, 2 * j), *e = bbm_entry(f, 2 * j + 1, 2 * j);
    double *c = f->A + place_in(p, j), s[4] = { 0 };

    multiply_rows(f, i, j, s);
    for (int a = 0; a < 2; a++, c += width(p)) {
        c[0] -= s[2 * a];
        c[0] = i == j && a == 0 ? find_pivot(c[0], f->size[2 * i]) : c[0] * d[0];
        c[1] -= s[2 * a + 1] + c[0] * e[0];
        c[1] = i == j && a == 1 ? find_pivot(c[1], f->size[2 * i + 1]) : c[1] * e[1];
    }
}

/* C in place of K. Pivots are measured by `size`. What stands above the diagonal is never used. */
void bbm_factor_make(const bbm_factor *f)
{
    for (int i = 0; i < f->n; i++)
        for (const bbm_part *p = f->part + f->first[i]; p < f->part + f->first[i + 1]; p++)
            for (int j = p->from; j < p->to; j++)
                make_entry(f, i, j, p);
}

/* x = K^-1 x for the pairs of rows from .. to-1, which no entry of K joins with others. The second
 * sweep goes through memory backwards only, which is faster where the factor is large. */
void bbm_substitute(const bbm_factor *f, int from, int to, double *restrict x)
{
    for (int i = from; i < to; i++) {
        const bbm_part *last = f->part + f->first[i + 1] - 1;
        const double *d = f->A + place_in(last, i), *e = d + width(last);
        for (const bbm_part *p = f->part + f->first[i]; p <= last; p++) {
            double s[4] = { 0 };
            add_products(width(p) - (p == last ? 2 : 0), f->A + p->at, width(p), x + 2 * p->from,
                         0, s);
            x[2 * i] -= s[0];
            x[2 * i + 1] -= s[2];
        }
        x[2 * i] *= d[0];
        x[2 * i + 1] = (x[2 * i + 1] - e[0] * x[2 * i]) * e[1];
    }
    for (int i = to - 1; i >= from; i--) {
        const bbm_part *last = f->part + f->first[i + 1] - 1;
        const double *d = f->A + place_in(last, i), *e = d + width(last);
        const double x1 = x[2 * i + 1] * e[1], x0 = (x[2 * i] - e[0] * x1) * d[0];
        for (const bbm_part *p = last; p >= f->part + f->first[i]; p--) {
            const double *u = f->A + p->at, *v = u + width(p);
            double *restrict y = x + 2 * p->from;
            for (size_t k = width(p) - (p == last ? 2 : 0); k > 0; k -= 2) {
                y[k - 2] -= u[k - 2] * x0 + v[k - 2] * x1;
                y[k - 1] -= u[k - 1] * x0 + v[k - 1] * x1;
            }
        }
        x[2 * i] = x0;
        x[2 * i + 1] = x1;
    }
}
