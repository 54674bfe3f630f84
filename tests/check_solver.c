/* check_solver.c - tests of solver.c; the name of each test is what it shows.
 *
 * The oracles are a dense matrix, to which every test system is added a second time, and short dense algorithms: the
 * product, Cholesky, and conjugate gradients with M^-1 formed as a matrix, of SSOR and of two levels. For the order of the rows there are shapes whose least
 * bandwidth is known: chains, rings, strips.
 *
 * Tolerances. ROUNDING: sums of some hundred products, 100 eps. SOLVED: the iteration stops at 1e-13, and the test
 * systems have condition numbers of some thousand. ITERATES: the first steps of two conjugate gradient iterations that
 * differ only in rounding, which each step amplifies.
 */
#include <float.h>
#include <string.h>
#include <time.h>

#include "check.h"

#define ROUNDING 1e-13
#define SOLVED   1e-9
#define ITERATES 1e-9

#define COUNT(array) ((int)(sizeof (array) / sizeof (array)[0]))

enum { MOST = 40, MOST_PAIRS = 120, MOST_6 = 6 * MOST };

static const double OMEGA[] = { 0.3, 1.0, 1.1, 1.7 };
static const bbm_pcg_form FORM[] = { BBM_EISENSTAT, BBM_TEXTBOOK };

/* A number in [-1, 1], in the same order in every run. */
static double random_number(unsigned *seed)
{
    *seed = (1103515245u * *seed + 12345u) & 0x7fffffffu;
    return (double)(*seed >> 7) / 8388608.0 - 1;
}

/* ------------------------------------------------------------------------------------------------- test systems */

typedef struct {
    int n, pairs, pair[MOST_PAIRS][2];
    double A[MOST_6][MOST_6], F[MOST_6 + 1];    /* F ends with an infinity that nobody may read */
    bbm_matrix *K;
} dense_system;

static void add_block(dense_system *s, int i, int j, double B[6][6])
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
        g[a] = random_number(seed);
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

/* Three springs for each pair on rows that are held softly, and a random load. */
static void fill(dense_system *s, unsigned seed)
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
        s->F[i] = random_number(&seed);
    s->F[6 * s->n] = INFINITY;
}

static void connect(dense_system *s, int i, int j)
{
    s->pair[s->pairs][0] = i;
    s->pair[s->pairs++][1] = j;
}

enum { CHAIN, GRID, STAR, PARTS, REPEATED, SINGLE, PATTERNS };

/* The patterns; the grid's rows are in a scattered order, 7 i mod 24. */
static dense_system *new_system(int pattern, unsigned seed)
{
    static const int size[PATTERNS] = { 12, 24, 9, 11, 6, 1 };
    dense_system *s = calloc(1, sizeof *s);

    s->n = size[pattern];
    for (int i = 1; i < s->n; i++) {
        if (pattern == CHAIN || (pattern == PARTS && i != 4 && i != 5 && i != 10))
            connect(s, i - 1, i);
        if (pattern == GRID && i % 4 != 0)
            connect(s, 7 * i % 24, 7 * (i - 1) % 24);
        if (pattern == GRID && i >= 4)
            connect(s, 7 * (i - 4) % 24, 7 * i % 24);
        if (pattern == STAR)
            connect(s, i % 2 ? 3 : (i + 3) % 9, i % 2 ? (i + 3) % 9 : 3);
        for (int j = 0; pattern == REPEATED && j <= i; j++) {
            connect(s, i, j);
            connect(s, j, i);
        }
    }
    ck_assert_int_eq(bbm_matrix_new(s->n, s->pairs, s->pair, &s->K), BBM_OK);
    fill(s, seed);
    return s;
}

static void free_system(dense_system *s)
{
    bbm_matrix_free(s->K);
    free(s);
}

/* The least row of the connected component of each row. */
static void label_components(const dense_system *s, int *least)
{
    for (int i = 0; i < s->n; i++)
        least[i] = i;
    for (int times = 0; times < s->n; times++)
        for (int k = 0; k < s->pairs; k++) {
            int *a = &least[s->pair[k][0]], *b = &least[s->pair[k][1]];
            *a = *b = *a < *b ? *a : *b;
        }
}

/* ------------------------------------------------------------------------------------------- dense algorithms */

static double product(int n, const double *x, const double *y)
{
    double sum = 0;

    for (int i = 0; i < n; i++)
        sum += x[i] * y[i];
    return sum;
}

static void dense_multiply(const dense_system *s, const double *x, double *y)
{
    for (int i = 0; i < 6 * s->n; i++)
        y[i] = product(6 * s->n, s->A[i], x);
}

/* x = A^-1 f by Cholesky, A = C C^T. */
static void dense_solve(int n, double A[MOST_6][MOST_6], const double *f, double *x)
{
    static double C[MOST_6][MOST_6];

    for (int i = 0; i < n; i++) {
        for (int j = 0; j <= i; j++) {
            const double d = A[i][j] - product(j, C[i], C[j]);
            C[i][j] = i == j ? sqrt(d) : d / C[j][j];
        }
        x[i] = (f[i] - product(i, C[i], x)) / C[i][i];
    }
    for (int i = n - 1; i >= 0; i--) {
        for (int j = i + 1; j < n; j++)
            x[i] -= C[j][i] * x[j];
        x[i] /= C[i][i];
    }
}

/* M = 1/(2-w) (D/w + L) (D/w)^-1 (D/w + L)^T, here with the textbooks' factor; D and L are blocks of A in the order
 * of its rows. */
static void form_ssor(const dense_system *s, double w, double M[MOST_6][MOST_6])
{
    static double D[MOST_6][MOST_6], E[MOST_6][MOST_6], column[MOST_6][MOST_6];
    const int n = 6 * s->n;

    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++) {
            D[i][j] = i / 6 == j / 6 ? s->A[i][j] / w : 0;
            E[i][j] = i / 6 > j / 6 ? s->A[i][j] : D[i][j];
        }
    for (int j = 0; j < n; j++)
        dense_solve(n, D, E[j], column[j]);
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++)
            M[i][j] = product(n, E[i], column[j]) / (2 - w);
}

/* Conjugate gradients with W = M^-1, as the textbooks have it. Returns the iterations. */
static int dense_pcg(const dense_system *s, double W[MOST_6][MOST_6], double tolerance, int limit, double *x)
{
    double r[MOST_6], z[MOST_6], p[MOST_6], q[MOST_6], rz, first;
    const int n = 6 * s->n;
    int k;

    memcpy(r, s->F, (size_t)n * sizeof *r);
    for (int i = 0; i < n; i++)
        p[i] = z[i] = product(n, W[i], r);
    memset(x, 0, MOST_6 * sizeof *x);
    first = rz = product(n, r, z);
    for (k = 0; k < limit && sqrt(rz) > tolerance * sqrt(first); k++) {
        dense_multiply(s, p, q);
        const double a = rz / product(n, p, q), last = rz;
        for (int i = 0; i < n; i++) {
            x[i] += a * p[i];
            r[i] -= a * q[i];
        }
        for (int i = 0; i < n; i++)
            z[i] = product(n, W[i], r);
        rz = product(n, r, z);
        for (int i = 0; i < n; i++)
            p[i] = z[i] + rz / last * p[i];
    }
    return k;
}

static int dense_ssor_pcg(const dense_system *s, double w, double tolerance, int limit, double *x)
{
    static double M[MOST_6][MOST_6], W[MOST_6][MOST_6];

    form_ssor(s, w, M);
    for (int i = 0; i < 6 * s->n; i++) {
        double e[MOST_6] = { 0 };
        e[i] = 1;
        dense_solve(6 * s->n, M, e, W[i]);
    }
    return dense_pcg(s, W, tolerance, limit, x);
}

static double norm(int n, const double *x)
{
    return sqrt(product(n, x, x));
}

static void assert_same(int n, const double *x, const double *y, double tolerance)
{
    const double size = norm(n, y);

    for (int i = 0; i < n; i++)
        ck_near(x[i], y[i], size, tolerance);
}

/* |F - A D| / |F| of the connected component where it is largest. */
static double largest_residual(const dense_system *s, const double *D)
{
    double KD[MOST_6], largest = 0;
    int least[MOST];

    dense_multiply(s, D, KD);
    label_components(s, least);
    for (int c = 0; c < s->n; c++) {
        double r = 0, f = 0;

        for (int i = 0; i < 6 * s->n; i++)
            if (least[i / 6] == c) {
                r += (s->F[i] - KD[i]) * (s->F[i] - KD[i]);
                f += s->F[i] * s->F[i];
            }
        largest = f > 0 ? fmax(largest, sqrt(r / f)) : largest;
    }
    return largest;
}

static bbm_pcg accurate(double omega, bbm_pcg_form form)
{
    return (bbm_pcg){ .omega = omega, .tolerance = 1e-13, .iterations = 1000, .form = form };
}

/* ------------------------------------------------------------------------------------------------- the matrix */

START_TEST(product_is_that_of_the_dense_matrix)
{
    dense_system *s = new_system(_i, 1);
    double y[MOST_6], expected[MOST_6];

    bbm_matrix_multiply(s->K, s->F, y);
    dense_multiply(s, s->F, expected);
    assert_same(6 * s->n, y, expected, ROUNDING);
    free_system(s);
}
END_TEST

START_TEST(product_is_symmetric)
{
    dense_system *s = new_system(_i, 2);
    double x[MOST_6], Kx[MOST_6], KF[MOST_6];
    unsigned seed = 3;

    for (int i = 0; i < 6 * s->n; i++)
        x[i] = random_number(&seed);
    bbm_matrix_multiply(s->K, x, Kx);
    bbm_matrix_multiply(s->K, s->F, KF);
    ck_near(product(6 * s->n, s->F, Kx), product(6 * s->n, x, KF), norm(6 * s->n, x) * norm(6 * s->n, KF), ROUNDING);
    free_system(s);
}
END_TEST

START_TEST(order_direction_and_repetition_of_the_pairs_change_no_bit)
{
    dense_system *s = new_system(_i, 4), *t = new_system(_i, 4);
    const bbm_pcg pcg = accurate(1, BBM_EISENSTAT);
    bbm_pcg_info info;
    int other[3 * MOST_PAIRS][2], pairs = 0;
    double D[MOST_6], E[MOST_6];

    for (int k = s->pairs - 1; k >= 0; k--)         /* last pair first, turned round, one to three times, and (i, i) */
        for (int times = 0; times <= k % 3; times++, pairs++) {
            other[pairs][0] = s->pair[k][1];
            other[pairs][1] = times == 2 ? s->pair[k][1] : s->pair[k][0];
        }
    bbm_matrix_free(t->K);
    ck_assert_int_eq(bbm_matrix_new(t->n, pairs, other, &t->K), BBM_OK);
    fill(t, 4);
    ck_assert_int_eq(bbm_matrix_bandwidth(s->K), bbm_matrix_bandwidth(t->K));
    ck_assert_int_eq(bbm_solve(s->K, s->F, D, &pcg, &info), BBM_OK);
    ck_assert_int_eq(bbm_solve(t->K, t->F, E, &pcg, &info), BBM_OK);
    ck_assert_mem_eq(D, E, (size_t)(6 * s->n) * sizeof *D);
    free_system(s);
    free_system(t);
}
END_TEST

START_TEST(block_added_as_ij_or_transposed_as_ji_is_the_same)
{
    dense_system *s = new_system(GRID, 5);
    double x[MOST_6], y[MOST_6], B[6][6], T[6][6];
    unsigned seed = 6;

    bbm_matrix_multiply(s->K, s->F, x);
    for (int k = 0; k < s->pairs; k++) {
        for (int a = 0; a < 36; a++) {
            B[a / 6][a % 6] = random_number(&seed);
            T[a % 6][a / 6] = -B[a / 6][a % 6];
        }
        ck_assert_int_eq(bbm_matrix_add(s->K, s->pair[k][0], s->pair[k][1], B), BBM_OK);
        ck_assert_int_eq(bbm_matrix_add(s->K, s->pair[k][1], s->pair[k][0], T), BBM_OK);
    }
    bbm_matrix_multiply(s->K, s->F, y);
    assert_same(6 * s->n, y, x, ROUNDING);
    free_system(s);
}
END_TEST

START_TEST(cleared_matrix_is_zero_and_can_be_filled_again)
{
    dense_system *s = new_system(_i, 7);
    double x[MOST_6], y[MOST_6];

    bbm_matrix_multiply(s->K, s->F, x);
    bbm_matrix_clear(s->K);
    bbm_matrix_multiply(s->K, s->F, y);
    for (int i = 0; i < 6 * s->n; i++)
        ck_assert(y[i] == 0);
    fill(s, 7);
    bbm_matrix_multiply(s->K, s->F, y);
    ck_assert_mem_eq(x, y, (size_t)(6 * s->n) * sizeof *x);
    free_system(s);
}
END_TEST

START_TEST(pair_that_is_not_in_the_pattern_is_refused_and_changes_nothing)
{
    static const int wrong[][2] = { { 0, 2 }, { 2, 0 }, { 11, 1 }, { -1, 0 }, { 0, -1 }, { 12, 0 }, { 0, 12 } };
    dense_system *s = new_system(CHAIN, 8);
    double x[MOST_6], y[MOST_6], B[6][6] = { { 1 } };

    bbm_matrix_multiply(s->K, s->F, x);
    for (int k = 0; k < COUNT(wrong); k++)
        ck_assert_int_eq(bbm_matrix_add(s->K, wrong[k][0], wrong[k][1], B), BBM_BAD_INDEX);
    bbm_matrix_multiply(s->K, s->F, y);
    ck_assert_mem_eq(x, y, (size_t)(6 * s->n) * sizeof *x);
    free_system(s);
}
END_TEST

START_TEST(pattern_with_a_row_that_does_not_exist_is_refused)
{
    int wrong[][2][2] = {
        { { 0, 1 }, { 1, 3 } }, { { 0, 1 }, { 3, 1 } }, { { -1, 0 }, { 1, 2 } }, { { 0, -1 }, { 1, 2 } }
    };
    bbm_matrix *K;

    for (int k = 0; k < COUNT(wrong); k++) {
        K = (bbm_matrix *)wrong;
        ck_assert_int_eq(bbm_matrix_new(3, 2, wrong[k], &K), BBM_BAD_INDEX);
        ck_assert_ptr_null(K);
    }
    ck_assert_int_eq(bbm_matrix_new(0, 0, NULL, &K), BBM_NO_ELEMENT);
    ck_assert_ptr_null(K);
    bbm_matrix_free(K);
}
END_TEST

START_TEST(running_out_of_memory_at_any_call_is_reported)
{
    int pair[3][2] = { { 0, 1 }, { 1, 2 }, { 0, 2 } };
    bbm_matrix *K = NULL;
    int calls;

    for (calls = 0; !K; calls++) {
        test_allocations_left = calls;
        const bbm_status status = bbm_matrix_new(3, 3, pair, &K);
        test_allocations_left = TEST_ALLOCATIONS_UNLIMITED;
        ck_assert_int_eq(status, K ? BBM_OK : BBM_NO_MEMORY);
    }
    ck_assert_int_gt(calls, 1);
    bbm_matrix_free(K);
}
END_TEST

/* -------------------------------------------------------------------------------------------- the order of rows */

enum { LONG = 400 };

/* A permutation of n numbers. */
static void shuffle(int n, int *number, unsigned seed)
{
    for (int i = 0; i < n; i++) {
        const int j = (int)((random_number(&seed) + 1) / 2 * i);
        number[i] = number[j];
        number[j] = i;
    }
}

/* The bandwidth of a strip of width x length rows, each a neighbour of those beside it, numbered at random. */
static int strip_bandwidth(int width, int length, int ring, unsigned seed)
{
    int pair[2 * LONG][2], number[LONG], pairs = 0, bandwidth;
    bbm_matrix *K;

    shuffle(width * length, number, seed);
    for (int i = 0; i < width * length; i++) {
        if (i % width != 0) {
            pair[pairs][0] = number[i];
            pair[pairs++][1] = number[i - 1];
        }
        if (i >= width || ring) {
            pair[pairs][0] = number[(i + width * (length - 1)) % (width * length)];
            pair[pairs++][1] = number[i];
        }
    }
    ck_assert_int_eq(bbm_matrix_new(width * length, pairs, pair, &K), BBM_OK);
    bandwidth = bbm_matrix_bandwidth(K);
    bbm_matrix_free(K);
    return bandwidth;
}

/* An order by levels of a strip, from one end: a row and those of the next level, no more than two widths in all. From
 * the middle it would be twice that. The least possible: 1 for a chain, 2 for a ring, the width for a strip. */
START_TEST(long_strips_in_any_numbering_get_a_narrow_band)
{
    const unsigned seed = (unsigned)_i;

    ck_assert_int_eq(strip_bandwidth(1, LONG, 0, seed), 1);
    ck_assert_int_eq(strip_bandwidth(1, LONG, 1, seed), 2);
    ck_assert_int_le(strip_bandwidth(2, LONG / 2, 0, seed), 3);
    ck_assert_int_le(strip_bandwidth(4, LONG / 4, 0, seed), 6);
}
END_TEST

/* A comb: a chain with a tooth at each row. The tooth, of degree 1, comes before the next row: the band is 2, not 3. */
START_TEST(neighbours_of_low_degree_come_first)
{
    int pair[LONG][2], number[LONG], pairs = 0;
    bbm_matrix *K;

    shuffle(LONG, number, (unsigned)_i);
    for (int i = 0; i < LONG; i += 2, pairs += 2) {
        pair[pairs][0] = pair[pairs + 1][0] = number[i];
        pair[pairs][1] = number[i + 1];
        pair[pairs + 1][1] = number[(i + 2) % LONG];
    }
    ck_assert_int_eq(bbm_matrix_new(LONG, pairs - 1, pair, &K), BBM_OK);
    ck_assert_int_eq(bbm_matrix_bandwidth(K), 2);
    bbm_matrix_free(K);
}
END_TEST

START_TEST(bandwidths_of_small_patterns_are_those_of_theory)
{
    static const int expected[PATTERNS] = { [CHAIN] = 1, [GRID] = 4, [STAR] = 7, [PARTS] = 1, [REPEATED] = 5 };

    for (int k = 0; k < PATTERNS; k++) {
        dense_system *s = new_system(k, 9);
        ck_assert_int_eq(bbm_matrix_bandwidth(s->K), expected[k]);
        free_system(s);
    }
}
END_TEST

/* ------------------------------------------------------------------------------------------------- the solution */

START_TEST(solution_is_that_of_the_dense_matrix)
{
    dense_system *s = new_system(_i, 10);
    double expected[MOST_6], D[MOST_6 + 1];
    bbm_pcg_info info;

    dense_solve(6 * s->n, s->A, s->F, expected);
    D[6 * s->n] = 77;
    for (int k = 0; k < COUNT(OMEGA) * COUNT(FORM); k++) {
        const bbm_pcg pcg = accurate(OMEGA[k / COUNT(FORM)], FORM[k % COUNT(FORM)]);
        ck_assert_int_eq(bbm_solve(s->K, s->F, D, &pcg, &info), BBM_OK);
        assert_same(6 * s->n, D, expected, SOLVED);
        ck_assert(D[6 * s->n] == 77);
        ck_assert_int_gt(info.iterations, 0);
        ck_assert_int_eq(info.element, -1);
    }
    free_system(s);
}
END_TEST

/* A chain keeps its order, so that L is the same here and in solver.c. */
START_TEST(iterates_are_those_of_ssor_pcg_with_dense_matrices)
{
    dense_system *s = new_system(CHAIN, 11);
    double expected[MOST_6], D[MOST_6];
    bbm_pcg_info info;

    for (int k = 0; k < COUNT(OMEGA) * COUNT(FORM); k++) {
        bbm_pcg pcg = accurate(OMEGA[k / COUNT(FORM)], FORM[k % COUNT(FORM)]);
        for (pcg.iterations = 1; pcg.iterations <= 4; pcg.iterations++) {
            ck_assert_int_eq(dense_ssor_pcg(s, pcg.omega, 1e-13, pcg.iterations, expected), pcg.iterations);
            ck_assert_int_eq(bbm_solve(s->K, s->F, D, &pcg, &info), BBM_NOT_CONVERGED);
            ck_assert_int_eq(info.iterations, pcg.iterations);
            assert_same(6 * s->n, D, expected, ITERATES);
        }
    }
    free_system(s);
}
END_TEST

START_TEST(iterations_are_as_many_as_with_dense_matrices)
{
    static const double tolerance[] = { 0.5, 1e-2, 1e-4, 1e-6, 1e-8 };
    dense_system *s = new_system(CHAIN, 12);
    double expected[MOST_6], D[MOST_6];
    bbm_pcg_info info;

    for (int k = 0; k < COUNT(tolerance) * COUNT(FORM); k++) {
        bbm_pcg pcg = accurate(OMEGA[_i], FORM[k % COUNT(FORM)]);
        pcg.tolerance = tolerance[k / COUNT(FORM)];
        const int iterations = dense_ssor_pcg(s, pcg.omega, pcg.tolerance, 1000, expected);
        ck_assert_int_eq(bbm_solve(s->K, s->F, D, &pcg, &info), BBM_OK);
        ck_assert_int_eq(info.iterations, iterations);
    }
    free_system(s);
}
END_TEST

/* By one iteration they may differ, when rounding decides whether the tolerance is met. */
START_TEST(eisenstat_takes_the_textbook_iterations_to_the_same_solution)
{
    dense_system *s = new_system(_i, 13);
    double D[MOST_6], E[MOST_6];
    bbm_pcg_info textbook, eisenstat;

    for (int k = 0; k < COUNT(OMEGA); k++) {
        bbm_pcg pcg = accurate(OMEGA[k], BBM_TEXTBOOK);
        pcg.tolerance = 1e-10;
        ck_assert_int_eq(bbm_solve(s->K, s->F, D, &pcg, &textbook), BBM_OK);
        pcg.form = BBM_EISENSTAT;
        ck_assert_int_eq(bbm_solve(s->K, s->F, E, &pcg, &eisenstat), BBM_OK);
        ck_assert_int_le(abs(eisenstat.iterations - textbook.iterations), 1);
        assert_same(6 * s->n, E, D, 1e-8);
    }
    free_system(s);
}
END_TEST

START_TEST(residual_is_the_true_one)
{
    dense_system *s = new_system(_i, 14);
    double D[MOST_6];
    bbm_pcg_info info;

    for (int k = 0; k < COUNT(FORM); k++) {
        bbm_pcg pcg = accurate(1.2, FORM[k]);
        pcg.tolerance = 1e-3;
        ck_assert_int_eq(bbm_solve(s->K, s->F, D, &pcg, &info), BBM_OK);
        /* two ways to round K D, against a residual that may be rounding itself */
        ck_near(info.residual, largest_residual(s, D), 1.0, ROUNDING);
    }
    free_system(s);
}
END_TEST

START_TEST(a_solution_takes_no_longer_than_the_processor_was_at_it)
{
    dense_system *s = new_system(GRID, 15);
    const bbm_pcg pcg = accurate(1, FORM[_i]);
    const clock_t start = clock();
    double D[MOST_6];
    bbm_pcg_info info;

    while (clock() - start < CLOCKS_PER_SEC / 1000)     /* so that the start is not 0 */
        ;
    const clock_t before = clock();
    ck_assert_int_eq(bbm_solve(s->K, s->F, D, &pcg, &info), BBM_OK);
    const double seconds = (double)(clock() - before) / CLOCKS_PER_SEC;
    ck_assert(info.seconds[0] >= 0 && info.seconds[1] >= 0);
    ck_assert_double_le(info.seconds[0] + info.seconds[1], seconds + 1.0 / CLOCKS_PER_SEC);     /* a tick */
    free_system(s);
}
END_TEST

START_TEST(two_solutions_are_equal_to_the_last_bit)
{
    dense_system *s = new_system(GRID, 15);
    const bbm_pcg pcg = accurate(1, FORM[_i]);
    double D[MOST_6], E[MOST_6];
    bbm_pcg_info info[2];

    ck_assert_int_eq(bbm_solve(s->K, s->F, D, &pcg, &info[0]), BBM_OK);
    ck_assert_int_eq(bbm_solve(s->K, s->F, E, &pcg, &info[1]), BBM_OK);
    ck_assert_mem_eq(D, E, (size_t)(6 * s->n) * sizeof *D);
    ck_assert_int_eq(info[0].iterations, info[1].iterations);
    ck_assert(info[0].residual == info[1].residual);
    free_system(s);
}
END_TEST

/* A power of two changes no digit, and the squares of such loads would not be numbers any more. */
START_TEST(loads_of_any_size_give_the_same_digits)
{
    static const int exponent[] = { 900, 600, -600, -900 };
    dense_system *s = new_system(CHAIN, 16);
    const bbm_pcg pcg = accurate(1, FORM[_i]);
    double D[MOST_6], E[MOST_6], F[MOST_6];
    bbm_pcg_info info;

    ck_assert_int_eq(bbm_solve(s->K, s->F, D, &pcg, &info), BBM_OK);
    for (int k = 0; k < COUNT(exponent); k++) {
        for (int i = 0; i < 6 * s->n; i++)
            F[i] = ldexp(s->F[i], exponent[k]);
        ck_assert_int_eq(bbm_solve(s->K, F, E, &pcg, &info), BBM_OK);
        for (int i = 0; i < 6 * s->n; i++)
            ck_assert(E[i] == ldexp(D[i], exponent[k]));
    }
    free_system(s);
}
END_TEST

START_TEST(no_load_gives_no_displacement_in_no_iteration)
{
    dense_system *s = new_system(PARTS, 17);
    const bbm_pcg pcg = accurate(1, FORM[_i]);
    double F[MOST_6] = { 0 }, D[MOST_6];
    bbm_pcg_info info;

    memcpy(D, s->F, (size_t)(6 * s->n) * sizeof *D);
    ck_assert_int_eq(bbm_solve(s->K, F, D, &pcg, &info), BBM_OK);
    ck_assert_int_eq(info.iterations, 0);
    ck_assert_int_eq(info.element, -1);
    ck_assert(info.residual == 0);
    ck_assert_mem_eq(D, F, (size_t)(6 * s->n) * sizeof *D);
    free_system(s);
}
END_TEST

/* K = tridiagonal (c, 1, c), six times. */
static bbm_matrix *tridiagonal(int n, double c)
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

/* The exact solution falls by 0.8 from row to row, below every number in 3200 rows: D_i = 0.8^i / (1 - 0.8 c), where
 * 0.8 = (1 - sqrt(1 - 4 c^2)) / (2 c), c = 0.8 / 1.64. */
START_TEST(load_on_one_of_many_rows_makes_no_denormals)
{
    enum { ROWS = 4000 };
    const double c = 0.8 / 1.64;
    const bbm_pcg pcg = accurate(1, FORM[_i]);
    bbm_matrix *K = tridiagonal(ROWS, -c);
    double *F = calloc(6 * ROWS, sizeof *F), *D = calloc(6 * ROWS, sizeof *D);
    bbm_pcg_info info;

    F[0] = 1;
    ck_assert_int_eq(bbm_solve(K, F, D, &pcg, &info), BBM_OK);
    for (int i = 0; i < ROWS; i++) {
        ck_near(D[6 * i], pow(0.8, i) / (1 - 0.8 * c), 1.0, 1e-11);
        ck_assert(fabs(D[6 * i]) >= 1e-110 && fabs(D[6 * i + 5]) >= 1e-110 && fabs(D[6 * i + 5]) <= 1e-90);
    }
    bbm_matrix_free(K);
    free(F);
    free(D);
}
END_TEST

/* ------------------------------------------------------------------------------------------------- what can fail */

/* A solve that fails before the first iteration: D = 0. */
static bbm_status refused(dense_system *s, const bbm_pcg *pcg, bbm_pcg_info *info)
{
    double D[MOST_6];
    bbm_status status;

    memcpy(D, s->F, (size_t)(6 * s->n) * sizeof *D);
    info->element = info->iterations = 77;
    info->residual = 77;
    status = bbm_solve(s->K, s->F, D, pcg, info);
    ck_assert_int_eq(info->iterations, 0);
    ck_assert(info->residual == 1);
    for (int i = 0; i < 6 * s->n; i++)
        ck_assert(D[i] == 0);
    return status;
}

START_TEST(parameter_outside_its_range_is_refused)
{
    static const bbm_pcg wrong[] = {
        { 0, 1e-8, 100, BBM_EISENSTAT }, { 2, 1e-8, 100, BBM_EISENSTAT }, { -1, 1e-8, 100, BBM_EISENSTAT },
        { 3, 1e-8, 100, BBM_EISENSTAT }, { NAN, 1e-8, 100, BBM_EISENSTAT }, { 1, 0, 100, BBM_EISENSTAT },
        { 1, -1e-8, 100, BBM_EISENSTAT }, { 1, NAN, 100, BBM_EISENSTAT }, { 1, INFINITY, 100, BBM_EISENSTAT },
        { 1, 1, 100, BBM_EISENSTAT }, { 1, 1e-8, 0, BBM_EISENSTAT }, { 1, 1e-8, -1, BBM_EISENSTAT },
    };
    dense_system *s = new_system(CHAIN, 18);
    bbm_pcg_info info;

    for (int k = 0; k < COUNT(wrong); k++) {
        ck_assert_int_eq(refused(s, &wrong[k], &info), BBM_BAD_PARAMETER);
        ck_assert_int_eq(info.element, -1);
    }
    free_system(s);
}
END_TEST

START_TEST(entry_of_the_load_that_is_not_finite_is_refused)
{
    static const double wrong[] = { NAN, INFINITY, -INFINITY };
    dense_system *s = new_system(CHAIN, 19);
    const bbm_pcg pcg = accurate(1, BBM_EISENSTAT);
    bbm_pcg_info info;

    for (int i = 0; i < 6 * s->n; i++) {
        const double right = s->F[i];
        s->F[i] = wrong[i % 3];
        ck_assert_int_eq(refused(s, &pcg, &info), BBM_NOT_FINITE);
        s->F[i] = right;
    }
    free_system(s);
}
END_TEST

/* _i is the entry; in a chain row 11 is last, in either direction of the order. */
START_TEST(entry_of_the_matrix_that_is_not_finite_is_refused)
{
    static const int place[][2] = { { 0, 0 }, { 11, 11 }, { 0, 1 }, { 10, 11 }, { 5, 5 } };
    dense_system *s = new_system(CHAIN, 20);
    const bbm_pcg pcg = accurate(1, BBM_EISENSTAT);
    bbm_pcg_info info;
    double B[6][6] = { { 0 } };

    for (int k = 0; k < COUNT(place); k++) {
        B[_i / 6][_i % 6] = k % 2 ? NAN : INFINITY;
        ck_assert_int_eq(bbm_matrix_add(s->K, place[k][0], place[k][1], B), BBM_OK);
        ck_assert_int_eq(refused(s, &pcg, &info), BBM_NOT_FINITE);
        bbm_matrix_clear(s->K);
        fill(s, 20);
    }
    free_system(s);
}
END_TEST

/* _i is the pivot; it is 0 or -1. */
START_TEST(diagonal_block_that_is_not_positive_definite_is_named)
{
    dense_system *s = new_system(GRID, 21);
    bbm_pcg_info info;

    for (int k = 0; k < COUNT(FORM); k++)
        for (int row = 0; row < s->n; row += 5) {
            const bbm_pcg pcg = accurate(1, FORM[k]);
            double I[6][6] = { { 0 } };

            bbm_matrix_clear(s->K);
            for (int i = 0; i < s->n; i++) {
                for (int a = 0; a < 6; a++)
                    I[a][a] = i == row && a == _i ? -(row % 2) : 1;
                ck_assert_int_eq(bbm_matrix_add(s->K, i, i, I), BBM_OK);
            }
            ck_assert_int_eq(refused(s, &pcg, &info), BBM_NOT_POSITIVE_DEFINITE);
            ck_assert_int_eq(info.element, row);
        }
    free_system(s);
}
END_TEST

/* K = [1 c; c 1] six times. c = 2: -1 is an eigenvalue. c = 1: p is (1, -1) at once and p.Kp exactly 0. */
START_TEST(matrix_that_is_not_positive_definite_is_found_out_by_the_iteration)
{
    const bbm_pcg pcg = accurate(1, FORM[_i]);
    double F[12] = { 0 }, D[12];
    bbm_pcg_info info;

    for (int c = 1; c <= 2; c++) {
        bbm_matrix *K = tridiagonal(2, c);

        for (int a = 0; a < 6; a++)
            F[6 + a] = 1;
        ck_assert_int_eq(bbm_solve(K, F, D, &pcg, &info), BBM_NOT_POSITIVE_DEFINITE);
        ck_assert_int_eq(info.element, -1);
        ck_assert_int_eq(info.iterations, 0);
        ck_assert(info.residual == 1);
        bbm_matrix_free(K);
    }
}
END_TEST

START_TEST(limit_of_iterations_ends_with_the_last_iterate_and_its_residual)
{
    dense_system *s = new_system(GRID, 22);
    bbm_pcg pcg = accurate(1, FORM[_i]);
    double D[MOST_6], r[MOST_6];
    bbm_pcg_info info;
    int needed;

    ck_assert_int_eq(bbm_solve(s->K, s->F, D, &pcg, &info), BBM_OK);
    needed = pcg.iterations = info.iterations;
    ck_assert_int_eq(bbm_solve(s->K, s->F, D, &pcg, &info), BBM_OK);
    pcg.iterations = needed - 1;
    ck_assert_int_eq(bbm_solve(s->K, s->F, D, &pcg, &info), BBM_NOT_CONVERGED);
    ck_assert_int_eq(info.iterations, needed - 1);
    ck_assert_int_eq(info.element, -1);
    pcg.iterations = 3;
    ck_assert_int_eq(bbm_solve(s->K, s->F, D, &pcg, &info), BBM_NOT_CONVERGED);
    dense_multiply(s, D, r);
    for (int i = 0; i < 6 * s->n; i++)
        r[i] = s->F[i] - r[i];
    ck_near(info.residual, norm(6 * s->n, r) / norm(6 * s->n, s->F), 1.0, ROUNDING);
    free_system(s);
}
END_TEST

START_TEST(solution_too_large_for_a_number_is_not_returned_in_silence)
{
    const bbm_pcg pcg = accurate(1, FORM[_i]);
    double B[6][6] = { { 0 } }, F[18] = { 0 }, D[18];
    bbm_pcg_info info;
    bbm_matrix *K;

    ck_assert_int_eq(bbm_matrix_new(3, 0, NULL, &K), BBM_OK);
    for (int a = 0; a < 6; a++)
        B[a][a] = 1e-20;
    for (int i = 0; i < 3; i++)
        ck_assert_int_eq(bbm_matrix_add(K, i, i, B), BBM_OK);
    F[17] = 1e300;
    ck_assert_int_eq(bbm_solve(K, F, D, &pcg, &info), BBM_NOT_FINITE);
    bbm_matrix_free(K);
}
END_TEST

/* With these numbers nothing is rounded: one iteration leaves no residual. The first value, 1/1024, times the tolerance
 * is 0. */
START_TEST(least_tolerance_is_met_by_an_exact_solution)
{
    const bbm_pcg pcg = { .omega = 1, .tolerance = DBL_MIN * DBL_EPSILON, .iterations = 10, .form = FORM[_i] };
    double B[6][6] = { { 0 } }, F[6] = { 1, 1, 1, 1, 1, 1 }, D[6];
    bbm_pcg_info info;
    bbm_matrix *K;

    ck_assert_int_eq(bbm_matrix_new(1, 0, NULL, &K), BBM_OK);
    for (int a = 0; a < 6; a++)
        B[a][a] = 1048576;
    ck_assert_int_eq(bbm_matrix_add(K, 0, 0, B), BBM_OK);
    ck_assert_int_eq(bbm_solve(K, F, D, &pcg, &info), BBM_OK);
    ck_assert_int_eq(info.iterations, 1);
    for (int a = 0; a < 6; a++)
        ck_assert(D[a] == 1.0 / 1048576);
    bbm_matrix_free(K);
}
END_TEST

/* ------------------------------------------------------------------------------------------------- two levels */

enum { MOST_CORNERS = 4 * MOST };

typedef struct {                /* a coarse space: P takes all its unknowns to all rows                          */
    int nodes, first[MOST + 1], node[MOST_CORNERS];
    double P[MOST_6][4 * MOST_CORNERS];                     /* twice, for a test that doubles the nodes */
} dense_coarse;

static void hang(dense_system *s, dense_coarse *c)
{
    ck_assert_int_eq(bbm_matrix_coarse(s->K, c->nodes, c->first, c->node), BBM_OK);
    for (int i = 0; i < s->n; i++)
        for (int k = c->first[i]; k < c->first[i + 1]; k++) {
            double P[6][2];

            for (int a = 0; a < 12; a++)
                P[a / 2][a % 2] = c->P[6 * i + a / 2][2 * c->node[k] + a % 2];
            ck_assert_int_eq(bbm_matrix_interpolate(s->K, i, k - c->first[i], P), BBM_OK);
        }
}

/* Row i hangs on the nodes i/2 and i/2 + 2, of whose order only the solver knows; every fifth row on none. Each
 * connected component has its own nodes. */
static dense_coarse *new_coarse(dense_system *s, unsigned seed)
{
    dense_coarse *c = calloc(1, sizeof *c);
    const int most = s->n / 2 + 3;
    int least[MOST];

    label_components(s, least);
    for (int i = 0; i < s->n; i++) {
        c->nodes = most * (least[i] + 1) > c->nodes ? most * (least[i] + 1) : c->nodes;
        c->first[i + 1] = c->first[i] + (i % 5 == 4 ? 0 : 2);
        for (int k = c->first[i]; k < c->first[i + 1]; k++) {
            c->node[k] = most * least[i] + i / 2 + 2 * (k - c->first[i]);
            for (int a = 0; a < 12; a++)
                c->P[6 * i + a / 2][2 * c->node[k] + a % 2] = random_number(&seed);
        }
    }
    hang(s, c);
    return c;
}

/* x += B^-1 r, B = D + L, or its transpose with `back`; D and L are blocks of A. */
static void gauss_seidel(const dense_system *s, int back, const double *r, double *x)
{
    static double D[MOST_6][MOST_6];
    double y[MOST_6] = { 0 }, b[6];

    for (int step = 0; step < s->n; step++) {
        const int i = back ? s->n - 1 - step : step;
        for (int a = 0; a < 6; a++) {
            b[a] = r[6 * i + a] - product(6 * s->n, s->A[6 * i + a], y);
            memcpy(D[a], &s->A[6 * i + a][6 * i], 6 * sizeof *D[a]);
        }
        dense_solve(6, D, b, y + 6 * i);
    }
    for (int i = 0; i < 6 * s->n; i++)
        x[i] += y[i];
}

/* r = f - A x */
static void dense_residual(const dense_system *s, const double *f, const double *x, double *r)
{
    dense_multiply(s, x, r);
    for (int i = 0; i < 6 * s->n; i++)
        r[i] = f[i] - r[i];
}

/* z += P (P^T A P)^-1 P^T r; nodes on which no row hangs have a 1 on the diagonal. */
static void dense_correct(const dense_system *s, const dense_coarse *c, const double *r, double *z)
{
    static double Kc[MOST_6][MOST_6];
    double column[MOST_6], AP[MOST_6], b[MOST_6], x[MOST_6];
    const int n = 6 * s->n, coarse = 2 * c->nodes;

    for (int j = 0; j < coarse; j++) {
        for (int i = 0; i < n; i++)
            column[i] = c->P[i][j];
        b[j] = product(n, column, r);
        dense_multiply(s, column, AP);
        for (int k = 0; k < coarse; k++) {
            Kc[k][j] = 0;
            for (int i = 0; i < n; i++)
                Kc[k][j] += c->P[i][k] * AP[i];
        }
        if (Kc[j][j] == 0)
            Kc[j][j] = 1;
    }
    dense_solve(coarse, Kc, b, x);
    for (int i = 0; i < n; i++)
        z[i] += product(coarse, c->P[i], x);
}

/* The same three corrections of the residual, one after the other, and the residual afresh before each. */
static int dense_two_level(const dense_system *s, const dense_coarse *c, double tolerance, int limit, double *x)
{
    static double W[MOST_6][MOST_6];
    double r[MOST_6];

    memset(W, 0, sizeof W);
    for (int i = 0; i < 6 * s->n; i++) {
        double e[MOST_6] = { 0 };

        e[i] = 1;
        gauss_seidel(s, 0, e, W[i]);
        dense_residual(s, e, W[i], r);
        dense_correct(s, c, r, W[i]);
        dense_residual(s, e, W[i], r);
        gauss_seidel(s, 1, r, W[i]);
    }
    return dense_pcg(s, W, tolerance, limit, x);
}

START_TEST(two_levels_reach_the_solution_of_the_dense_matrix)
{
    dense_system *s = new_system(_i, 30);
    dense_coarse *c = new_coarse(s, 31);
    const bbm_pcg pcg = accurate(1.9, BBM_TWO_LEVEL);   /* an omega that is not used */
    double expected[MOST_6], D[MOST_6];
    bbm_pcg_info info;

    dense_solve(6 * s->n, s->A, s->F, expected);
    ck_assert_int_eq(bbm_solve(s->K, s->F, D, &pcg, &info), BBM_OK);
    assert_same(6 * s->n, D, expected, SOLVED);
    free(c);
    free_system(s);
}
END_TEST

START_TEST(two_level_iterates_are_those_with_dense_matrices)
{
    dense_system *s = new_system(CHAIN, 32);
    dense_coarse *c = new_coarse(s, 33);
    bbm_pcg pcg = accurate(1, BBM_TWO_LEVEL);
    double expected[MOST_6], D[MOST_6];
    bbm_pcg_info info;

    for (pcg.iterations = 1; pcg.iterations <= 5; pcg.iterations++) {
        ck_assert_int_eq(dense_two_level(s, c, 1e-13, pcg.iterations, expected), pcg.iterations);
        ck_assert_int_eq(bbm_solve(s->K, s->F, D, &pcg, &info), BBM_NOT_CONVERGED);
        ck_assert_int_eq(info.iterations, pcg.iterations);
        assert_same(6 * s->n, D, expected, ITERATES);
    }
    pcg.iterations = 1000;
    for (pcg.tolerance = 0.1; pcg.tolerance > 1e-9; pcg.tolerance /= 100) {
        const int iterations = dense_two_level(s, c, pcg.tolerance, 1000, expected);
        ck_assert_int_eq(bbm_solve(s->K, s->F, D, &pcg, &info), BBM_OK);
        ck_assert_int_eq(info.iterations, iterations);
    }
    free(c);
    free_system(s);
}
END_TEST

/* As for blocks of one triangle: three nodes of its own for each row, and a P that is regular. */
START_TEST(coarse_space_of_all_unknowns_solves_in_one_iteration)
{
    dense_system *s = new_system(_i, 34);
    dense_coarse *c = calloc(1, sizeof *c);
    bbm_pcg pcg = accurate(1, BBM_TWO_LEVEL);
    double expected[MOST_6], D[MOST_6];
    bbm_pcg_info info;
    unsigned seed = 35;

    c->nodes = 3 * s->n;
    for (int i = 0; i < 3 * s->n; i++) {
        c->first[i / 3 + 1] = i + 1;
        c->node[i] = (i + 5) % c->nodes;
        for (int a = 0; a < 12; a++)
            c->P[6 * (i / 3) + a / 2][2 * c->node[i] + a % 2] = random_number(&seed);
    }
    hang(s, c);
    pcg.tolerance = 1e-8;
    dense_solve(6 * s->n, s->A, s->F, expected);
    ck_assert_int_eq(bbm_solve(s->K, s->F, D, &pcg, &info), BBM_OK);
    ck_assert_int_eq(info.iterations, 1);
    assert_same(6 * s->n, D, expected, 1e-7);
    free(c);
    free_system(s);
}
END_TEST

/* Every node a second time, with the same P: Kc is singular, half of its pivots vanish; the space is the same. */
START_TEST(coarse_displacements_that_move_nothing_change_no_iterate)
{
    dense_system *s = new_system(_i, 24);
    dense_coarse *c = new_coarse(s, 37), *twice = calloc(1, sizeof *twice);
    const bbm_pcg pcg = { .omega = 1, .tolerance = 1e-6, .iterations = 1000, .form = BBM_TWO_LEVEL };
    double D[MOST_6], E[MOST_6];
    bbm_pcg_info once, again;

    ck_assert_int_eq(bbm_solve(s->K, s->F, D, &pcg, &once), BBM_OK);
    twice->nodes = 2 * c->nodes;
    for (int i = 0; i < s->n; i++) {
        twice->first[i + 1] = 2 * c->first[i + 1];
        for (int k = twice->first[i]; k < twice->first[i + 1]; k++) {
            twice->node[k] = 2 * c->node[k / 2] + k % 2;
            for (int a = 0; a < 12; a++)
                twice->P[6 * i + a / 2][2 * twice->node[k] + a % 2] = c->P[6 * i + a / 2][2 * c->node[k / 2] + a % 2];
        }
    }
    hang(s, twice);
    ck_assert_int_eq(bbm_solve(s->K, s->F, E, &pcg, &again), BBM_OK);
    ck_assert_int_eq(again.iterations, once.iterations);
    assert_same(6 * s->n, E, D, SOLVED);
    free(c);
    free(twice);
    free_system(s);
}
END_TEST

START_TEST(without_a_coarse_space_two_levels_are_one)
{
    dense_system *s = new_system(_i, 38);
    dense_coarse *c = new_coarse(s, 39);
    const int none[MOST + 1] = { 0 };
    bbm_pcg pcg = accurate(1.3, BBM_EISENSTAT);
    double D[MOST_6], E[MOST_6];
    bbm_pcg_info info;

    ck_assert_int_eq(bbm_solve(s->K, s->F, D, &pcg, &info), BBM_OK);
    ck_assert_int_eq(bbm_matrix_coarse(s->K, 0, none, NULL), BBM_OK);   /* it takes the old one away */
    pcg.form = BBM_TWO_LEVEL;
    ck_assert_int_eq(bbm_solve(s->K, s->F, E, &pcg, &info), BBM_OK);
    ck_assert_mem_eq(D, E, (size_t)(6 * s->n) * sizeof *D);
    free(c);
    free_system(s);
}
END_TEST

/* What is kept from solve to solve is made again when omega, K, P or the nodes have changed: after each change the
 * solution is that of a system to which the same was done, but which was never solved before. */
static void change(dense_system *s, dense_coarse *c, int changes)
{
    double B[6][6] = { { 1 } }, P[6][2] = { { 1, 2 }, { 3, 4 } };

    if (changes == 2)
        bbm_matrix_add(s->K, 3, 3, B);
    if (changes == 3)
        bbm_matrix_interpolate(s->K, 3, 1, P);
    if (changes == 4)
        bbm_matrix_clear(s->K);
    if (changes == 4)
        fill(s, 40);
    c->node[1] = changes == 5 ? c->nodes - 1 : c->node[1];
    if (changes == 5)
        ck_assert_int_eq(bbm_matrix_coarse(s->K, c->nodes, c->first, c->node), BBM_OK);
}

START_TEST(solution_does_not_depend_on_earlier_ones)
{
    static const bbm_pcg_form form[] = { BBM_TWO_LEVEL, BBM_TEXTBOOK, BBM_EISENSTAT };
    dense_system *s = new_system(GRID, 40);
    dense_coarse *c = new_coarse(s, 41);
    double D[MOST_6], E[MOST_6];
    bbm_pcg_info info;

    for (int k = 0; k < 18; k++) {
        const bbm_pcg pcg = accurate(k % 6 ? 1.2 : 1, form[(k / 6 + _i) % 3]);
        dense_system *t = new_system(GRID, 40);
        dense_coarse *d = new_coarse(t, 41);

        change(s, c, k % 6);
        for (int all = 0; all <= k; all++)
            change(t, d, all % 6);
        for (int times = 0; times < 2; times++) {
            ck_assert_int_eq(bbm_solve(s->K, s->F, D, &pcg, &info), BBM_OK);
            ck_assert_int_eq(bbm_solve(t->K, t->F, E, &pcg, &info), BBM_OK);
            ck_assert_mem_eq(D, E, (size_t)(6 * s->n) * sizeof *D);
        }
        free(d);
        free_system(t);
    }
    free(c);
    free_system(s);
}
END_TEST

START_TEST(coarse_nodes_and_corners_that_do_not_exist_are_refused)
{
    dense_system *s = new_system(CHAIN, 42);
    dense_coarse *c = new_coarse(s, 43);
    static const int wrong[][2] = { { -1, 0 }, { 12, 0 }, { 0, -1 }, { 0, 2 }, { 4, 0 }, { 11, 2 } };
    double P[6][2] = { { 0 } };

    for (int k = 0; k < COUNT(wrong); k++)
        ck_assert_int_eq(bbm_matrix_interpolate(s->K, wrong[k][0], wrong[k][1], P), BBM_BAD_INDEX);
    c->node[3] = -1;
    ck_assert_int_eq(bbm_matrix_coarse(s->K, c->nodes, c->first, c->node), BBM_BAD_INDEX);
    c->node[3] = c->nodes;
    ck_assert_int_eq(bbm_matrix_coarse(s->K, c->nodes, c->first, c->node), BBM_BAD_INDEX);
    memset(c->first, 0, sizeof c->first);
    ck_assert_int_eq(bbm_matrix_coarse(s->K, 0, c->first, NULL), BBM_OK);
    ck_assert_int_eq(bbm_matrix_interpolate(s->K, 0, 0, P), BBM_BAD_INDEX);
    free(c);
    free_system(s);
}
END_TEST

START_TEST(coarse_node_of_two_connected_components_is_refused)
{
    dense_system *s = new_system(PARTS, 47);
    dense_coarse *c = new_coarse(s, 48);
    const bbm_pcg pcg = accurate(1, BBM_EISENSTAT);
    double D[MOST_6];
    bbm_pcg_info info;

    c->node[c->first[10]] = c->node[c->first[5]];
    ck_assert_int_eq(bbm_matrix_coarse(s->K, c->nodes, c->first, c->node), BBM_BAD_INDEX);
    ck_assert_int_eq(bbm_solve(s->K, s->F, D, &pcg, &info), BBM_OK);
    free(c);
    free_system(s);
}
END_TEST

START_TEST(coarse_space_that_finds_no_memory_is_none)
{
    dense_system *s = new_system(GRID, 44);
    dense_coarse *c = new_coarse(s, 45);
    const bbm_pcg pcg = accurate(1, BBM_TWO_LEVEL);
    bbm_status status = BBM_NO_MEMORY;
    double expected[MOST_6], D[MOST_6];
    bbm_pcg_info info;
    int calls;

    dense_solve(6 * s->n, s->A, s->F, expected);
    for (calls = 0; status != BBM_OK; calls++) {
        test_allocations_left = calls;
        status = bbm_matrix_coarse(s->K, c->nodes, c->first, c->node);
        test_allocations_left = TEST_ALLOCATIONS_UNLIMITED;
        ck_assert(status == BBM_OK || status == BBM_NO_MEMORY);
        if (status == BBM_OK)
            hang(s, c);
        ck_assert_int_eq(bbm_solve(s->K, s->F, D, &pcg, &info), BBM_OK);
        assert_same(6 * s->n, D, expected, SOLVED);
    }
    ck_assert_int_gt(calls, 5);
    free(c);
    free_system(s);
}
END_TEST

/* ------------------------------------------------------------------------------------------ connected components */

enum { ONE_AFTER_THE_OTHER, THE_OTHER_FIRST, ALTERNATING, ARRANGEMENTS };

/* Two systems in one: row k of it is row number[k] of s[whose[k]]. */
static dense_system *join(dense_system *const s[2], dense_coarse *const c[2], const int *whose, const int *number)
{
    dense_system *t = calloc(1, sizeof *t);
    dense_coarse *d = calloc(1, sizeof *d);
    int row[2][MOST];
    double B[6][6];

    t->n = s[0]->n + s[1]->n;
    d->nodes = 2 * (c[0]->nodes + c[1]->nodes);
    for (int k = 0; k < t->n; k++) {
        const dense_coarse *from = c[whose[k]];
        const int i = number[k];

        row[whose[k]][i] = k;
        d->first[k + 1] = d->first[k] + from->first[i + 1] - from->first[i];
        for (int m = 0; m < d->first[k + 1] - d->first[k]; m++) {
            const int node = from->node[from->first[i] + m];

            d->node[d->first[k] + m] = 2 * node + whose[k];
            for (int a = 0; a < 12; a++)
                d->P[6 * k + a / 2][4 * node + 2 * whose[k] + a % 2] = from->P[6 * i + a / 2][2 * node + a % 2];
        }
    }
    for (int q = 0; q < 2; q++)
        for (int k = 0; k < s[q]->pairs; k++)
            connect(t, row[q][s[q]->pair[k][0]], row[q][s[q]->pair[k][1]]);
    ck_assert_int_eq(bbm_matrix_new(t->n, t->pairs, t->pair, &t->K), BBM_OK);
    for (int q = 0; q < 2; q++)
        for (int k = -s[q]->n; k < s[q]->pairs; k++) {
            const int i = k < 0 ? -1 - k : s[q]->pair[k][0], j = k < 0 ? i : s[q]->pair[k][1];

            bbm_matrix_get(s[q]->K, i, j, B);
            ck_assert_int_eq(bbm_matrix_add(t->K, row[q][i], row[q][j], B), BBM_OK);
        }
    hang(t, d);
    free(d);
    return t;
}

/* The other one's load is 2^40 = 1e12 times larger, which changes no digit of its own. */
START_TEST(what_is_not_connected_is_solved_as_if_it_were_alone)
{
    static const bbm_pcg_form form[] = { BBM_TWO_LEVEL, BBM_TEXTBOOK, BBM_EISENSTAT };
    dense_system *const s[2] = { new_system(GRID, 68), new_system(CHAIN, 61) };
    dense_coarse *const c[2] = { new_coarse(s[0], 62), new_coarse(s[1], 63) };
    const int arrangement = _i % ARRANGEMENTS;
    const bbm_pcg pcg = { .omega = 1.2, .tolerance = 1e-8, .iterations = 1000, .form = form[_i / ARRANGEMENTS] };
    int whose[MOST], number[MOST], count[2] = { 0, 0 };
    double alone[2][MOST_6], D[MOST_6], F[MOST_6];
    bbm_pcg_info info[2], both;

    for (int k = 0; k < s[0]->n + s[1]->n; k++) {
        whose[k] = arrangement == ALTERNATING ? k % 3 == 1 : (k < s[arrangement]->n) == arrangement;
        number[k] = count[whose[k]]++;
    }
    dense_system *t = join(s, c, whose, number);
    for (int q = 0; q < 2; q++)
        ck_assert_int_eq(bbm_solve(s[q]->K, s[q]->F, alone[q], &pcg, &info[q]), BBM_OK);
    for (int k = 0; k < 6 * t->n; k++)
        F[k] = ldexp(s[whose[k / 6]]->F[6 * number[k / 6] + k % 6], whose[k / 6] ? 40 : 0);
    ck_assert_int_eq(bbm_solve(t->K, F, D, &pcg, &both), BBM_OK);
    for (int k = 0; k < 6 * t->n; k++)
        ck_assert(D[k] == ldexp(alone[whose[k / 6]][6 * number[k / 6] + k % 6], whose[k / 6] ? 40 : 0));
    ck_assert_int_ne(info[0].iterations, info[1].iterations);
    ck_assert_int_eq(both.iterations, info[0].iterations > info[1].iterations ? info[0].iterations : info[1].iterations);
    ck_assert(both.residual == fmax(info[0].residual, info[1].residual));
    for (int q = 0; q < 2; q++) {
        free(c[q]);
        free_system(s[q]);
    }
    free_system(t);
}
END_TEST

/* Rows 0..3, 4, 5..9 and 10 are the components. */
START_TEST(component_without_load_stays_where_it_is)
{
    dense_system *s = new_system(PARTS, 64);
    const bbm_pcg pcg = accurate(1, FORM[_i]);
    double expected[MOST_6], D[MOST_6];
    bbm_pcg_info info;

    memset(s->F + 6 * 5, 0, 6 * 5 * sizeof *s->F);
    dense_solve(6 * s->n, s->A, s->F, expected);
    ck_assert_int_eq(bbm_solve(s->K, s->F, D, &pcg, &info), BBM_OK);
    assert_same(6 * s->n, D, expected, SOLVED);
    for (int i = 6 * 5; i < 6 * 10; i++)
        ck_assert(D[i] == 0);
    ck_near(info.residual, largest_residual(s, D), 1.0, ROUNDING);
    free_system(s);
}
END_TEST

START_TEST(rows_that_are_not_connected_take_one_iteration)
{
    dense_system *s = calloc(1, sizeof *s);
    const bbm_pcg pcg = { .omega = OMEGA[_i / COUNT(FORM)], .tolerance = 1e-10, .iterations = 1, .form = FORM[_i % COUNT(FORM)] };
    double expected[MOST_6], D[MOST_6];
    unsigned seed = 65;
    bbm_pcg_info info;

    s->n = 7;
    ck_assert_int_eq(bbm_matrix_new(s->n, 0, NULL, &s->K), BBM_OK);
    fill(s, 66);
    for (int i = 0; i < s->n; i++) {
        double B[6][6], g[6];

        for (int a = 0; a < 6; a++)
            g[a] = random_number(&seed);
        for (int a = 0; a < 36; a++)
            B[a / 6][a % 6] = g[a / 6] * g[a % 6];
        add_block(s, i, i, B);
    }
    dense_solve(6 * s->n, s->A, s->F, expected);
    ck_assert_int_eq(bbm_solve(s->K, s->F, D, &pcg, &info), BBM_OK);
    assert_same(6 * s->n, D, expected, SOLVED);
    ck_assert_int_eq(info.iterations, 1);
    free_system(s);
}
END_TEST

/* One iteration is enough for a row alone; a block far larger than those on the diagonal makes one chain indefinite. */
START_TEST(component_that_fails_is_reported_and_the_others_are_solved)
{
    dense_system *s = new_system(PARTS, 67), *t = new_system(PARTS, 67);
    bbm_pcg pcg = accurate(1, FORM[_i]);
    double D[MOST_6], E[MOST_6];
    bbm_pcg_info info;

    ck_assert_int_eq(bbm_solve(s->K, s->F, D, &pcg, &info), BBM_OK);
    pcg.iterations = 1;
    ck_assert_int_eq(bbm_solve(s->K, s->F, E, &pcg, &info), BBM_NOT_CONVERGED);
    ck_assert_int_eq(info.iterations, 1);
    ck_near(info.residual, largest_residual(s, E), 1.0, ROUNDING);
    ck_assert_mem_eq(D + 6 * 4, E + 6 * 4, 6 * sizeof *D);
    ck_assert_mem_eq(D + 6 * 10, E + 6 * 10, 6 * sizeof *D);
    double B[6][6];
    bbm_matrix_get(t->K, 6, 7, B);
    for (int a = 0; a < 36; a++)
        B[a / 6][a % 6] *= 100;
    ck_assert_int_eq(bbm_matrix_add(t->K, 6, 7, B), BBM_OK);
    pcg.iterations = 1000;
    ck_assert_int_eq(bbm_solve(t->K, t->F, E, &pcg, &info), BBM_NOT_POSITIVE_DEFINITE);
    ck_assert_int_eq(info.element, -1);
    ck_assert_mem_eq(D, E, 6 * 5 * sizeof *D);
    ck_assert_mem_eq(D + 6 * 10, E + 6 * 10, 6 * sizeof *D);
    free_system(s);
    free_system(t);
}
END_TEST

/* Seconds for 512 chains of three rows on two levels; the rows of a chain are `apart` rows apart. Each end has a coarse
 * node, the middle none, so that no block of Kc joins the two. */
static double chains_time(int apart)
{
    enum { PAIRS = 1024, ROWS = 1536 };
    static const bbm_pcg pcg = { .omega = 1, .tolerance = 1e-10, .iterations = 100, .form = BBM_TWO_LEVEL };
    static int pair[PAIRS][2], first[ROWS + 1], node[ROWS];
    static double F[6 * ROWS], D[6 * ROWS];
    double P[6][2] = { { 1, 0 }, { 0, 1 } }, B[6][6] = { { 0 } };
    bbm_pcg_info info;
    bbm_matrix *K;

    for (int k = 0; k < PAIRS; k++) {
        pair[k][0] = k / 2 / apart * 3 * apart + k / 2 % apart + k % 2 * apart;
        pair[k][1] = pair[k][0] + apart;
    }
    for (int i = 0; i < ROWS; i++) {
        first[i + 1] = first[i] + (i / apart % 3 != 1);
        node[i] = i;
    }
    ck_assert_int_eq(bbm_matrix_new(ROWS, PAIRS, pair, &K), BBM_OK);
    ck_assert_int_eq(bbm_matrix_coarse(K, first[ROWS], first, node), BBM_OK);
    for (int i = 0; i < ROWS; i++) {
        for (int a = 0; a < 6; a++) {
            B[a][a] = 2 + a;
            F[6 * i + a] = a + i % 5;
        }
        ck_assert_int_eq(bbm_matrix_add(K, i, i, B), BBM_OK);
        if (first[i + 1] > first[i])
            ck_assert_int_eq(bbm_matrix_interpolate(K, i, 0, P), BBM_OK);
    }
    for (int a = 0; a < 6; a++)
        B[a][a] = 1;
    for (int k = 0; k < PAIRS; k++)
        ck_assert_int_eq(bbm_matrix_add(K, pair[k][0], pair[k][1], B), BBM_OK);
    const clock_t start = clock();
    for (int times = 0; times < 50; times++)
        ck_assert_int_eq(bbm_solve(K, F, D, &pcg, &info), BBM_OK);
    const clock_t end = clock();
    bbm_matrix_free(K);
    return (double)(end - start) / CLOCKS_PER_SEC;
}

/* Were the coarse nodes in the caller's order, each chain whose rows are far apart would look at half of them. */
START_TEST(order_of_the_rows_does_not_matter_to_the_time)
{
    const double near = chains_time(1), far = chains_time(512);

    ck_assert_msg(far < 3 * near, "%g s and %g s", far, near);      /* 1; or else 8 */
}
END_TEST

/* Bytes for the coarse space of a strip of triangles: i has the corners i, i + 1, i + 2 and a side with the next one. */
static size_t strip_bytes(int triangles)
{
    int (*pair)[2] = calloc((size_t)triangles, sizeof *pair), *first = calloc(4 * (size_t)triangles + 1, sizeof *first);
    int *node = first + triangles + 1;
    bbm_matrix *K;

    for (int i = 0; i < triangles; i++) {
        pair[i][0] = i;
        pair[i][1] = i + (i + 1 < triangles);
        first[i + 1] = 3 * i + 3;
        for (int k = 0; k < 3; k++)
            node[3 * i + k] = i + k;
    }
    ck_assert_int_eq(bbm_matrix_new(triangles, triangles, pair, &K), BBM_OK);
    const size_t before = test_bytes;
    ck_assert_int_eq(bbm_matrix_coarse(K, triangles + 2, first, node), BBM_OK);
    const size_t bytes = test_bytes - before;
    bbm_matrix_free(K);
    free(pair);
    free(first);
    return bytes;
}

/* Each node of the strip has a block in Kc for itself and for the two before it, 32 bytes each; P and Q of a triangle's
 * corners take 576, all that is numbered 152. Nodes across a common side, 3 apart, would take 248 more. */
START_TEST(kc_has_room_for_corners_of_one_element_and_no_others)
{
    ck_assert_uint_le(strip_bytes(200) - strip_bytes(100), 100 * (96 + 576 + 152));
}
END_TEST

START_TEST(matrix_that_is_not_positive_definite_is_found_out_on_two_levels)
{
    static const int first[] = { 0, 1, 2 }, node[] = { 0, 0 };
    const bbm_pcg pcg = accurate(1, BBM_TWO_LEVEL);
    double P[6][2] = { { 1, 0 }, { 0, 1 } }, F[12] = { 0 }, D[12];
    bbm_pcg_info info;
    bbm_matrix *K = tridiagonal(2, 2);

    ck_assert_int_eq(bbm_matrix_coarse(K, 1, first, node), BBM_OK);
    for (int i = 0; i < 2; i++)
        ck_assert_int_eq(bbm_matrix_interpolate(K, i, 0, P), BBM_OK);
    for (int a = 0; a < 6; a++)
        F[6 + a] = 1;
    ck_assert_int_eq(bbm_solve(K, F, D, &pcg, &info), BBM_NOT_POSITIVE_DEFINITE);
    ck_assert_int_eq(info.element, -1);
    bbm_matrix_free(K);
}
END_TEST

START_TEST(blocks_come_out_as_they_went_in)
{
    dense_system *s = new_system(_i, 46);
    double B[6][6];

    for (int i = 0; i < s->n; i++)
        for (int j = 0; j < s->n; j++) {
            bbm_matrix_get(s->K, i, j, B);
            for (int a = 0; a < 36; a++)
                ck_near(B[a / 6][a % 6], s->A[6 * i + a / 6][6 * j + a % 6], 10.0, ROUNDING);
        }
    free_system(s);
}
END_TEST

/* ------------------------------------------------------------------------------------- two levels on meshes */

enum { TRIANGLES, QUADRILATERALS, DISTORTED, GRADED_HOLE, CRACKED, MESHES };

static void mesh_node(bbm_model *m, int mesh, double s, double t, double size, unsigned *seed)
{
    const double inside = s > 0 && s < 1 && t > 0 && t < 1 && mesh == DISTORTED ? 0.25 * size : 0;
    const double u = random_number(seed), v = random_number(seed), r = pow(10, t), angle = acos(0) * (1 - s);

    if (mesh == GRADED_HOLE)
        bbm_add_node(m, r * cos(angle), r * sin(angle), NULL);
    else
        bbm_add_node(m, 4 * s + inside * u, t + inside * v, NULL);
}

/* n rows of 4 n cells, held on the left and loaded on the right: a beam 4 x 1, or a quarter of a plate with a hole,
 * whose elements differ in area by 100. The crack runs from a quarter of the length to the right end, through all bonds of
 * the line. One step leaves K and F. */
static bbm_model *new_mesh(int mesh, int n, double alpha)
{
    const int nx = 4 * n, across = nx + 1;
    unsigned seed = 47;
    bbm_model *m;

    ck_assert_int_eq(bbm_model_new(&m), BBM_OK);
    bbm_add_material(m, &(bbm_material){ 30e6, 0.3, 1, 1 }, NULL);
    for (int j = 0; j <= n; j++)
        for (int i = 0; i <= nx; i++)
            mesh_node(m, mesh, (double)i / nx, (double)j / n, 1.0 / n, &seed);
    for (int j = 0; j < n; j++)
        for (int i = 0; i < nx; i++) {
            const int a = j * across + i, rising = (i + j) % 2;
            const int q[4] = { a, a + 1, a + across + 1, a + across };
            const int lower[3] = { q[0], q[1], q[rising ? 3 : 2] }, upper[3] = { q[2], q[3], q[rising ? 1 : 0] };

            bbm_add_element(m, 0, 0, mesh == QUADRILATERALS ? 4 : 3, mesh == QUADRILATERALS ? q : lower, NULL);
            if (mesh != QUADRILATERALS)
                bbm_add_element(m, 0, 0, 3, upper, NULL);
        }
    for (int j = 0; j <= n; j++) {
        bbm_fix_node(m, j * across, BBM_XY, 0, 0);
        bbm_add_load(m, j * across + nx, 0, -1000);
    }
    m->par.alpha = alpha;
    m->par.bonding = BBM_VERTICES;
    m->par.pcg.iterations = 200;                /* several times what is needed: an error ends at once */
    ck_ok(bbm_prepare(m), m);
    for (int b = m->bonds - 1; b >= 0 && mesh == CRACKED; b--) {
        const bbm_vertex *p = &m->vertex[m->bond[b].p[0]], *q = &m->vertex[m->bond[b].p[1]];
        if (p->y == 0.5 && q->y == 0.5 && fmax(p->x, q->x) > 1)
            m->bond[b] = m->bond[--m->bonds];
    }
    ck_ok(bbm_step(m), m);
    return m;
}

static int mesh_iterations(int mesh, int n, double alpha)
{
    bbm_model *m = new_mesh(mesh, n, alpha);
    const int iterations = m->info.pcg.iterations;

    bbm_model_free(m);
    return iterations;
}

/* Not too few, either: if corners that belong together were not one node, the coarse space would be nearly the whole
 * one, solved in an iteration or two at the price of a direct solver. */
START_TEST(iterations_on_two_levels_are_few_and_do_not_grow_with_the_mesh)
{
    static const struct { int mesh; double alpha; int most; } claim[] = {
        { TRIANGLES, 10, 18 },       { TRIANGLES, 100, 18 },    { TRIANGLES, 1000, 16 },  { QUADRILATERALS, 10, 16 },
        { QUADRILATERALS, 1000, 16 }, { DISTORTED, 10, 28 },    { DISTORTED, 1000, 28 },  { GRADED_HOLE, 10, 20 },
        { GRADED_HOLE, 1000, 20 },   { CRACKED, 10, 24 },       { CRACKED, 1000, 24 },
    };
    const int coarse = mesh_iterations(claim[_i].mesh, 8, claim[_i].alpha);
    const int fine = mesh_iterations(claim[_i].mesh, 16, claim[_i].alpha);

    ck_assert_int_le(fine, claim[_i].most);
    ck_assert_int_ge(fine, claim[_i].most / 2);
    ck_assert_int_le(fine, coarse + (claim[_i].mesh == TRIANGLES ? 1 : 2));
}
END_TEST

/* Both to 1e-12 of what each measures; the condition of K is some 1e6. */
START_TEST(two_levels_and_one_reach_the_same_displacements)
{
    bbm_model *m = new_mesh(_i, 6, 100);
    bbm_pcg pcg = { .omega = 1, .tolerance = 1e-12, .iterations = 5000, .form = BBM_TWO_LEVEL };
    double *D = calloc(6 * (size_t)m->elements, sizeof *D);
    bbm_pcg_info two, one;

    ck_assert_int_eq(bbm_solve(m->K, m->F, D, &pcg, &two), BBM_OK);
    pcg.form = BBM_EISENSTAT;
    ck_assert_int_eq(bbm_solve(m->K, m->F, m->D, &pcg, &one), BBM_OK);
    ck_assert_int_lt(10 * two.iterations, one.iterations);
    assert_same(6 * m->elements, D, m->D, 1e-8);
    free(D);
    bbm_model_free(m);
}
END_TEST

/* Two blocks of one element each, or of bonded ones all of whose corners are held, fall back on SSOR alone; so does
 * every model in steps that a wave needs to cross an element. */
static void mesh_of_blocks(bbm_model *m, int bonded, int held)
{
    bbm_add_material(m, &(bbm_material){ 1e10, 0.2, 2500, 1 }, NULL);
    for (int i = 0; i < 8; i++)
        bbm_add_node(m, i / 2, i % 2, NULL);
    for (int i = 0; i < 3; i++) {
        const int node[4] = { 2 * i, 2 * i + 2, 2 * i + 3, 2 * i + 1 };
        bbm_add_element(m, bonded ? 0 : i, 0, 4, node, NULL);
    }
    for (int i = 0; i < (held ? 8 : 2); i++)
        bbm_fix_node(m, i, BBM_XY, 0, 0);
    bbm_add_load(m, 7, 0, -1000);
    ck_ok(bbm_prepare(m), m);
    ck_ok(bbm_step(m), m);
}

/* Two triangles with a side in common have four nodes. */
START_TEST(corners_that_a_bond_ties_together_are_one_coarse_node)
{
    static const int node[2][3] = { { 0, 1, 2 }, { 1, 3, 2 } }, first[] = { 0, 3, 6 };
    static const double xy[4][2] = { { 0, 0 }, { 1, 0 }, { 0, 1 }, { 1, 1 } };
    double P[2][3][6][2], E[12];
    bbm_pcg_info info;
    bbm_model *m;

    ck_assert_int_eq(bbm_model_new(&m), BBM_OK);
    bbm_add_material(m, &(bbm_material){ 30e6, 0.3, 1, 1 }, NULL);
    for (int i = 0; i < 4; i++)
        bbm_add_node(m, xy[i][0], xy[i][1], NULL);
    for (int i = 0; i < 2; i++)
        bbm_add_element(m, 0, 0, 3, node[i], NULL);
    bbm_fix_node(m, 0, BBM_XY, 0, 0);
    bbm_fix_node(m, 2, BBM_X, 0, 0);
    bbm_add_load(m, 3, 100, -1000);
    ck_ok(bbm_prepare(m), m);
    for (int k = 0; k < 6; k++)
        bbm_interpolation(&m->element[k / 3], &m->vertex[3 * (k / 3)], 0, k % 3, P[k / 3][k % 3]);
    ck_ok(bbm_step(m), m);
    ck_assert_int_eq(bbm_matrix_coarse(m->K, 4, first, node[0]), BBM_OK);
    for (int k = 0; k < 6; k++)
        ck_assert_int_eq(bbm_matrix_interpolate(m->K, k / 3, k % 3, P[k / 3][k % 3]), BBM_OK);
    ck_assert_int_eq(bbm_solve(m->K, m->F, E, &m->par.pcg, &info), BBM_OK);
    ck_assert_mem_eq(E, m->D, sizeof E);
    bbm_model_free(m);
}
END_TEST

START_TEST(one_level_is_used_where_two_do_not_pay)
{
    static const struct { int bonded, held; double dt; int two; } table[] = {
        { 1, 0, 1e-2, 1 }, { 1, 0, 1.8e-3, 1 }, { 1, 0, 1.2e-3, 0 },
        { 1, 0, 1e-4, 0 }, { 0, 0, 1e-2, 0 },   { 1, 1, 1e-2, 0 },
    };
    bbm_model *m[2];

    for (int k = 0; k < 2; k++) {
        ck_assert_int_eq(bbm_model_new(&m[k]), BBM_OK);
        m[k]->par.dt = table[_i].dt;
        m[k]->par.pcg.form = k ? BBM_EISENSTAT : BBM_TWO_LEVEL;
        mesh_of_blocks(m[k], table[_i].bonded, table[_i].held);
    }
    ck_assert_int_eq(memcmp(m[0]->D, m[1]->D, 18 * sizeof *m[0]->D) != 0, table[_i].two);
    bbm_model_free(m[0]);
    bbm_model_free(m[1]);
}
END_TEST

/* ------------------------------------------------------------------------------------------ the interpolation */

static const double CORNER[5][2] = { { 3.1, -2.2 }, { 4.4, -2 }, { 4.6, -0.9 }, { 3.7, 0.2 }, { 2.8, -0.7 } };

static void corners(int n, bbm_element *e, bbm_vertex v[5])
{
    *e = (bbm_element){ .n = n };
    for (int a = 0; a < n; a++)
        v[a] = (bbm_vertex){ .x = CORNER[a][0], .y = CORNER[a][1] };
    bbm_element_geometry(e, v);
}

START_TEST(linear_displacements_of_the_corners_are_those_of_the_element)
{
    static const double D[6] = { 0.3, -0.7, 0.2, 1.1, -0.4, 0.9 };
    const int n = 3 + _i / 2;
    double sum[6] = { 0 }, T[2][6], P[6][2];
    bbm_vertex v[5];
    bbm_element e;

    corners(n, &e, v);
    for (int a = 0; a < n; a++) {
        bbm_mode_matrix(&e, v[a].x, v[a].y, T);
        bbm_interpolation(&e, v, _i % 2, a, P);
        for (int i = 0; i < 6; i++)
            sum[i] += P[i][0] * product(6, T[0], D) + P[i][1] * product(6, T[1], D);
    }
    assert_same(6, sum, D, ROUNDING);
}
END_TEST

START_TEST(corner_of_a_triangle_moves_without_the_others)
{
    double T[2][6], P[6][2];
    bbm_vertex v[5];
    bbm_element e;

    corners(3, &e, v);
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++) {
            bbm_interpolation(&e, v, 0, a, P);
            bbm_mode_matrix(&e, v[b].x, v[b].y, T);
            for (int k = 0; k < 4; k++) {
                double u = 0;
                for (int i = 0; i < 6; i++)
                    u += T[k / 2][i] * P[i][k % 2];
                ck_near(u, a == b && k / 2 == k % 2, 1.0, ROUNDING);
            }
        }
}
END_TEST

/* T^T (T D - u), summed over the corners or the middles of the sides, is zero where |T D - u|^2 is least. */
START_TEST(interpolation_is_the_nearest_linear_displacement)
{
    const int n = 3 + _i / 2, middles = _i % 2;
    double u[5][2], D[6] = { 0 }, sum[6] = { 0 }, T[2][6], P[6][2];
    unsigned seed = 48;
    bbm_vertex v[5];
    bbm_element e;

    corners(n, &e, v);
    for (int a = 0; a < n; a++) {
        bbm_interpolation(&e, v, middles, a, P);
        for (int k = 0; k < 2; k++) {
            u[a][k] = random_number(&seed);
            for (int i = 0; i < 6; i++)
                D[i] += P[i][k] * u[a][k];
        }
    }
    for (int a = 0; a < n; a++) {
        const int b = middles ? (a + 1) % n : a;
        bbm_mode_matrix(&e, (v[a].x + v[b].x) / 2, (v[a].y + v[b].y) / 2, T);
        for (int k = 0; k < 2; k++)
            for (int i = 0; i < 6; i++)
                sum[i] += T[k][i] * (product(6, T[k], D) - (u[a][k] + u[b][k]) / 2);
    }
    for (int i = 0; i < 6; i++)
        ck_near(sum[i], 0, 1.0, 10 * ROUNDING);
}
END_TEST

Suite *solver_suite(void)
{
    Suite *suite = suite_create("solver");
    TCase *matrix = tcase_create("matrix"), *order = tcase_create("order");
    TCase *solution = tcase_create("solution"), *failure = tcase_create("failure");
    TCase *two = tcase_create("two levels");

    tcase_add_loop_test(matrix, product_is_that_of_the_dense_matrix, 0, PATTERNS);
    tcase_add_loop_test(matrix, product_is_symmetric, 0, PATTERNS);
    tcase_add_loop_test(matrix, order_direction_and_repetition_of_the_pairs_change_no_bit, 0, PATTERNS);
    tcase_add_test(matrix, block_added_as_ij_or_transposed_as_ji_is_the_same);
    tcase_add_loop_test(matrix, cleared_matrix_is_zero_and_can_be_filled_again, 0, PATTERNS);
    tcase_add_test(matrix, pair_that_is_not_in_the_pattern_is_refused_and_changes_nothing);
    tcase_add_test(matrix, pattern_with_a_row_that_does_not_exist_is_refused);
    tcase_add_test(matrix, running_out_of_memory_at_any_call_is_reported);
    tcase_add_loop_test(order, long_strips_in_any_numbering_get_a_narrow_band, 0, 5);
    tcase_add_loop_test(order, neighbours_of_low_degree_come_first, 0, 5);
    tcase_add_test(order, bandwidths_of_small_patterns_are_those_of_theory);
    tcase_add_loop_test(solution, solution_is_that_of_the_dense_matrix, 0, PATTERNS);
    tcase_add_test(solution, iterates_are_those_of_ssor_pcg_with_dense_matrices);
    tcase_add_loop_test(solution, iterations_are_as_many_as_with_dense_matrices, 0, COUNT(OMEGA));
    tcase_add_loop_test(solution, eisenstat_takes_the_textbook_iterations_to_the_same_solution, 0, PATTERNS);
    tcase_add_loop_test(solution, residual_is_the_true_one, 0, PATTERNS);
    tcase_add_loop_test(solution, a_solution_takes_no_longer_than_the_processor_was_at_it, 0, COUNT(FORM));
    tcase_add_loop_test(solution, two_solutions_are_equal_to_the_last_bit, 0, COUNT(FORM));
    tcase_add_loop_test(solution, loads_of_any_size_give_the_same_digits, 0, COUNT(FORM));
    tcase_add_loop_test(solution, no_load_gives_no_displacement_in_no_iteration, 0, COUNT(FORM));
    tcase_add_loop_test(solution, load_on_one_of_many_rows_makes_no_denormals, 0, COUNT(FORM));
    tcase_add_test(failure, parameter_outside_its_range_is_refused);
    tcase_add_test(failure, entry_of_the_load_that_is_not_finite_is_refused);
    tcase_add_loop_test(failure, entry_of_the_matrix_that_is_not_finite_is_refused, 0, 36);
    tcase_add_loop_test(failure, diagonal_block_that_is_not_positive_definite_is_named, 0, 6);
    tcase_add_loop_test(failure, matrix_that_is_not_positive_definite_is_found_out_by_the_iteration, 0, COUNT(FORM));
    tcase_add_loop_test(failure, limit_of_iterations_ends_with_the_last_iterate_and_its_residual, 0, COUNT(FORM));
    tcase_add_loop_test(failure, solution_too_large_for_a_number_is_not_returned_in_silence, 0, COUNT(FORM));
    tcase_add_loop_test(solution, least_tolerance_is_met_by_an_exact_solution, 0, COUNT(FORM));
    suite_add_tcase(suite, matrix);
    suite_add_tcase(suite, order);
    suite_add_tcase(suite, solution);
    suite_add_tcase(suite, failure);
    tcase_add_loop_test(two, two_levels_reach_the_solution_of_the_dense_matrix, 0, PATTERNS);
    tcase_add_test(two, two_level_iterates_are_those_with_dense_matrices);
    tcase_add_loop_test(two, coarse_space_of_all_unknowns_solves_in_one_iteration, 0, PATTERNS);
    tcase_add_loop_test(two, coarse_displacements_that_move_nothing_change_no_iterate, 0, PATTERNS);
    tcase_add_loop_test(two, without_a_coarse_space_two_levels_are_one, 0, PATTERNS);
    tcase_add_loop_test(two, solution_does_not_depend_on_earlier_ones, 0, 3);
    tcase_add_test(two, coarse_nodes_and_corners_that_do_not_exist_are_refused);
    tcase_add_test(two, coarse_node_of_two_connected_components_is_refused);
    tcase_add_test(two, coarse_space_that_finds_no_memory_is_none);
    tcase_add_loop_test(two, what_is_not_connected_is_solved_as_if_it_were_alone, 0, 3 * ARRANGEMENTS);
    tcase_add_test(two, order_of_the_rows_does_not_matter_to_the_time);
    tcase_add_loop_test(solution, component_without_load_stays_where_it_is, 0, COUNT(FORM));
    tcase_add_loop_test(solution, rows_that_are_not_connected_take_one_iteration, 0, COUNT(FORM) * COUNT(OMEGA));
    tcase_add_loop_test(failure, component_that_fails_is_reported_and_the_others_are_solved, 0, COUNT(FORM));
    tcase_add_test(two, kc_has_room_for_corners_of_one_element_and_no_others);
    tcase_add_test(two, matrix_that_is_not_positive_definite_is_found_out_on_two_levels);
    tcase_add_loop_test(two, blocks_come_out_as_they_went_in, 0, PATTERNS);
    tcase_add_loop_test(two, iterations_on_two_levels_are_few_and_do_not_grow_with_the_mesh, 0, 11);
    tcase_add_loop_test(two, two_levels_and_one_reach_the_same_displacements, 0, MESHES);
    tcase_add_test(two, corners_that_a_bond_ties_together_are_one_coarse_node);
    tcase_add_loop_test(two, one_level_is_used_where_two_do_not_pay, 0, 6);
    tcase_add_loop_test(two, linear_displacements_of_the_corners_are_those_of_the_element, 0, 6);
    tcase_add_test(two, corner_of_a_triangle_moves_without_the_others);
    tcase_add_loop_test(two, interpolation_is_the_nearest_linear_displacement, 0, 6);
    suite_add_tcase(suite, two);
    return suite;
}
