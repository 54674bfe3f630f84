/* systems.c - what the tests of the solver share: systems of equations and dense algorithms. */
#include <string.h>

#include "systems.h"

const double OMEGA[] = { 0.3, 1.0, 1.1, 1.7 };

double random_entry(unsigned *seed)
{
    *seed = (1103515245u * *seed + 12345u) & 0x7fffffffu;
    return (double)(*seed >> 7) / 8388608.0 - 1;
}

void add_block(dense_system *s, int i, int j, double B[6][6])
{
    for (int a = 0; a < 6; a++)
        for (int b = 0; b < 6; b++) {
            s->A[6 * i + a][6 * j + b] += B[a][b];
            if (i != j)
                s->A[6 * j + b][6 * i + a] += B[a][b];
        }
    ck_assert_int_eq(bbm_matrix_add(s->K, i, j, B), BBM_OK);
}

/* A spring between rows i and j: k g g^T, where g has twelve random entries. */
static void add_spring(dense_system *s, int i, int j, double k, unsigned *seed)
{
    double g[12], B[3][6][6];

    for (int a = 0; a < 12; a++)
        g[a] = random_entry(seed);
    for (int a = 0; a < 6; a++)
        for (int b = 0; b < 6; b++) {
            B[0][a][b] = k * g[a] * g[b];
            B[1][a][b] = k * g[a] * g[6 + b];
            B[2][a][b] = k * g[6 + a] * g[6 + b];
        }
    add_block(s, i, i, B[0]);
    add_block(s, i, j, B[1]);
    add_block(s, j, j, B[2]);
}

void fill_system(dense_system *s, unsigned seed)
{
    memset(s->A, 0, sizeof s->A);
    for (int i = 0; i < s->n; i++) {
        double B[6][6] = { { 0 } };

        for (int a = 0; a < 6; a++)
            B[a][a] = 0.1 * (1 + a);
        add_block(s, i, i, B);
    }
    for (int k = 0; k < 3 * s->pairs; k++)
        if (s->pair[k / 3][0] != s->pair[k / 3][1])
            add_spring(s, s->pair[k / 3][0], s->pair[k / 3][1], 1 + k % 3, &seed);
    for (int i = 0; i < 6 * s->n; i++)
        s->F[i] = random_entry(&seed);
    s->F[6 * s->n] = INFINITY;
}

void add_pair(dense_system *s, int i, int j)
{
    s->pair[s->pairs][0] = i;
    s->pair[s->pairs++][1] = j;
}

dense_system *new_system(int pattern, unsigned seed)
{
    static const int size[PATTERNS] = { 12, 24, 9, 11, 6, 1 };
    dense_system *s = calloc(1, sizeof *s);

    s->n = size[pattern];
    for (int i = 1; i < s->n; i++) {
        if (pattern == CHAIN || (pattern == PARTS && i != 4 && i != 5 && i != 10))
            add_pair(s, i - 1, i);
        if (pattern == GRID && i % 4 != 0)
            add_pair(s, 7 * i % 24, 7 * (i - 1) % 24);
        if (pattern == GRID && i >= 4)
            add_pair(s, 7 * (i - 4) % 24, 7 * i % 24);
        if (pattern == STAR)
            add_pair(s, i % 2 ? 3 : (i + 3) % 9, i % 2 ? (i + 3) % 9 : 3);
        for (int j = 0; pattern == REPEATED && j <= i; j++) {
            add_pair(s, i, j);
            add_pair(s, j, i);
        }
    }
    ck_assert_int_eq(bbm_matrix_new(s->n, s->pairs, s->pair, &s->K), BBM_OK);
    fill_system(s, seed);
    return s;
}

void free_system(dense_system *s)
{
    bbm_matrix_free(s->K);
    free(s);
}

void label_components(const dense_system *s, int *least)
{
    for (int i = 0; i < s->n; i++)
        least[i] = i;
    for (int times = 0; times < s->n; times++)
        for (int k = 0; k < s->pairs; k++) {
            int *a = &least[s->pair[k][0]], *b = &least[s->pair[k][1]];
            *a = *b = *a < *b ? *a : *b;
        }
}

double inner_product(int n, const double *x, const double *y)
{
    double sum = 0;

    for (int i = 0; i < n; i++)
        sum += x[i] * y[i];
    return sum;
}

void matrix_multiply(bbm_matrix *K, const double *x, double *y)
{
    K->from = 0;
    K->to = K->n;
    for (int i = 0; i < K->n; i++)
        memcpy(K->p + 6 * i, x + 6 * K->caller[i], 6 * sizeof *x);
    bbm_multiply(K, K->p, K->q);
    for (int i = 0; i < K->n; i++)
        memcpy(y + 6 * K->caller[i], K->q + 6 * i, 6 * sizeof *y);
}

void dense_multiply(const dense_system *s, const double *x, double *y)
{
    for (int i = 0; i < 6 * s->n; i++)
        y[i] = inner_product(6 * s->n, s->A[i], x);
}

void eliminate(int n, double *A, double *b)
{
    for (int p = 0; p < n; p++)
        for (int r = p + 1; r < n; r++) {
            const double factor = A[r * n + p] / A[p * n + p];
            for (int c = p; c < n && factor != 0; c++)
                A[r * n + c] -= factor * A[p * n + c];
            b[r] -= factor * b[p];
        }
    for (int r = n - 1; r >= 0; r--) {
        for (int c = r + 1; c < n; c++)
            b[r] -= A[r * n + c] * b[c];
        b[r] /= A[r * n + r];
    }
}

void dense_solve(int n, double A[MOST_6][MOST_6], const double *f, double *x)
{
    static double copy[MOST_6 * MOST_6];

    for (int i = 0; i < n; i++)
        memcpy(copy + i * n, A[i], (size_t)n * sizeof *copy);
    memmove(x, f, (size_t)n * sizeof *x);
    eliminate(n, copy, x);
}

int dense_pcg(const dense_system *s, double W[MOST_6][MOST_6], double tolerance,
              int limit, double *x)
{
    double r[MOST_6], z[MOST_6], p[MOST_6], q[MOST_6], rz, first;
    const int n = 6 * s->n;
    int k;

    memcpy(r, s->F, (size_t)n * sizeof *r);
    for (int i = 0; i < n; i++)
        p[i] = z[i] = inner_product(n, W[i], r);
    memset(x, 0, MOST_6 * sizeof *x);
    first = rz = inner_product(n, r, z);
    for (k = 0; k < limit && sqrt(rz) > tolerance * sqrt(first); k++) {
        dense_multiply(s, p, q);
        const double a = rz / inner_product(n, p, q), last = rz;
        for (int i = 0; i < n; i++) {
            x[i] += a * p[i];
            r[i] -= a * q[i];
        }
        for (int i = 0; i < n; i++)
            z[i] = inner_product(n, W[i], r);
        rz = inner_product(n, r, z);
        for (int i = 0; i < n; i++)
            p[i] = z[i] + rz / last * p[i];
    }
    return k;
}

double norm(int n, const double *x)
{
    return sqrt(inner_product(n, x, x));
}

void assert_same(int n, const double *x, const double *y, double tolerance)
{
    const double size = norm(n, y);

    for (int i = 0; i < n; i++)
        ck_assert_msg(fabs(x[i] - y[i]) <= tolerance * size,
                      "x[%d] = %.17g, expected %.17g within %.2g", i, x[i], y[i], tolerance * size);
}

void assert_solves(const dense_system *s, double *D, const bbm_pcg *pcg, bbm_pcg_info *info,
                   bbm_status expected)
{
    const bbm_status status = bbm_solve(s->K, s->F, D, pcg, info);

    ck_assert_msg(status == expected, "after %d iterations the solver says: %s; expected: %s",
                  info->iterations, bbm_status_text(status), bbm_status_text(expected));
}

bbm_pcg accurate(double omega, const bbm_method *method)
{
    return (bbm_pcg){ .omega = omega, .tolerance = 1e-13, .iterations = 1000, .method = method };
}

bbm_matrix *tridiagonal(int n, double c)
{
    int (*pair)[2] = calloc((size_t)n, sizeof *pair);
    bbm_matrix *K;

    for (int i = 1; i < n; i++) {
        pair[i - 1][0] = i - 1;
        pair[i - 1][1] = i;
    }
    ck_assert_int_eq(bbm_matrix_new(n, n - 1, pair, &K), BBM_OK);
    for (int i = 0; i < n; i++) {
        double I[6][6] = { { 0 } }, C[6][6] = { { 0 } };

        for (int a = 0; a < 6; a++) {
            I[a][a] = 1;
            C[a][a] = c;
        }
        ck_assert_int_eq(bbm_matrix_add(K, i, i, I), BBM_OK);
        if (i > 0)
            ck_assert_int_eq(bbm_matrix_add(K, i, i - 1, C), BBM_OK);
    }
    free(pair);
    return K;
}

void check_iterates(const dense_system *s, double W[MOST_6][MOST_6], bbm_pcg pcg)
{
    static const double tolerance[] = { 0.5, 1e-2, 1e-4, 1e-6, 1e-8 };
    double expected[MOST_6], D[MOST_6];
    bbm_pcg_info info;

    for (pcg.iterations = 1; pcg.iterations <= 5; pcg.iterations++) {
        ck_assert_int_eq(dense_pcg(s, W, 1e-13, pcg.iterations, expected), pcg.iterations);
        assert_solves(s, D, &pcg, &info, BBM_NOT_CONVERGED);
        ck_assert_int_eq(info.iterations, pcg.iterations);
        assert_same(6 * s->n, D, expected, ITERATES);
    }
    pcg.iterations = 1000;
    for (int t = 0; t < COUNT(tolerance); t++) {
        pcg.tolerance = tolerance[t];
        assert_solves(s, D, &pcg, &info, BBM_OK);
        ck_assert_int_eq(info.iterations, dense_pcg(s, W, pcg.tolerance, 1000, expected));
    }
}
