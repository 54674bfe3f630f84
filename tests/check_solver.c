/* check_solver.c - the matrix, the order of its rows, and SSOR-PCG. */
#include <float.h>
#include <string.h>
#include <time.h>

#include "check.h"
#include "rock.h"
#include "systems.h"

static int bandwidth_of(const bbm_matrix *K)
{
    int width = 0;

    for (int k = 0; k < K->first[K->n]; k++)
        width = K->back[k] > width ? K->back[k] : width;
    return width;
}

/* ----------------------------------------------------------------------------------- the matrix */

START_TEST(product_is_that_of_the_dense_matrix)
{
    dense_system *s = new_system(_i, 1);
    double y[MOST_6], expected[MOST_6];

    matrix_multiply(s->K, s->F, y);
    dense_multiply(s, s->F, expected);
    assert_same(6 * s->n, y, expected, ROUNDING);
    free_system(s);
}
END_TEST

START_TEST(order_direction_and_repetition_of_the_pairs_change_no_bit)
{
    dense_system *s = new_system(_i, 4), *t = new_system(_i, 4);
    const bbm_pcg pcg = accurate(1, NULL);
    bbm_pcg_info info;
    int other[3 * MOST_PAIRS][2], pairs = 0;
    double D[MOST_6], E[MOST_6];

    /* last pair first, turned round, one to three times, and (i, i) */
    for (int k = s->pairs - 1; k >= 0; k--)
        for (int times = 0; times <= k % 3; times++, pairs++) {
            other[pairs][0] = s->pair[k][1];
            other[pairs][1] = times == 2 ? s->pair[k][1] : s->pair[k][0];
        }
    bbm_matrix_free(t->K);
    ck_assert_int_eq(bbm_matrix_new(t->n, pairs, other, &t->K), BBM_OK);
    fill_system(t, 4);
    ck_assert_int_eq(bandwidth_of(s->K), bandwidth_of(t->K));
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

    matrix_multiply(s->K, s->F, x);
    for (int k = 0; k < s->pairs; k++) {
        for (int a = 0; a < 36; a++) {
            B[a / 6][a % 6] = random_entry(&seed);
            T[a % 6][a / 6] = -B[a / 6][a % 6];
        }
        ck_assert_int_eq(bbm_matrix_add(s->K, s->pair[k][0], s->pair[k][1], B), BBM_OK);
        ck_assert_int_eq(bbm_matrix_add(s->K, s->pair[k][1], s->pair[k][0], T), BBM_OK);
    }
    matrix_multiply(s->K, s->F, y);
    assert_same(6 * s->n, y, x, ROUNDING);
    free_system(s);
}
END_TEST

START_TEST(cleared_matrix_is_zero_and_can_be_filled_again)
{
    dense_system *s = new_system(_i, 7);
    double x[MOST_6], y[MOST_6];

    matrix_multiply(s->K, s->F, x);
    bbm_matrix_clear(s->K);
    matrix_multiply(s->K, s->F, y);
    for (int i = 0; i < 6 * s->n; i++)
        ck_assert(y[i] == 0);
    fill_system(s, 7);
    matrix_multiply(s->K, s->F, y);
    ck_assert_mem_eq(x, y, (size_t)(6 * s->n) * sizeof *x);
    free_system(s);
}
END_TEST

START_TEST(pair_that_is_not_in_the_pattern_is_refused_and_changes_nothing)
{
    static const int wrong[][2] = { { 0, 2 }, { 2, 0 }, { 11, 1 }, { -1, 0 }, { 0, -1 }, { 12, 0 },
                                    { 0, 12 } };
    dense_system *s = new_system(CHAIN, 8);
    double x[MOST_6], y[MOST_6], D[MOST_6], B[6][6] = { { 1 } };
    const bbm_pcg pcg = accurate(1, NULL);
    bbm_pcg_info info;

    matrix_multiply(s->K, s->F, x);
    ck_assert_int_eq(bbm_solve(s->K, s->F, D, &pcg, &info), BBM_OK);
    for (int k = 0; k < COUNT(wrong); k++)
        ck_assert_int_eq(bbm_matrix_add(s->K, wrong[k][0], wrong[k][1], B), BBM_BAD_INDEX);
    matrix_multiply(s->K, s->F, y);
    ck_assert_mem_eq(x, y, (size_t)(6 * s->n) * sizeof *x);
    ck_assert_int_eq(bbm_solve(s->K, s->F, D, &pcg, &info), BBM_BAD_INDEX);
    ck_assert_int_eq(info.iterations, 0);
    bbm_matrix_clear(s->K);
    ck_assert_int_eq(bbm_solve(s->K, s->F, D, &pcg, &info), BBM_NOT_POSITIVE_DEFINITE);
    free_system(s);
}
END_TEST

START_TEST(pattern_with_a_row_that_does_not_exist_is_refused)
{
    int wrong[][2][2] = {
        { { 0, 1 }, { 1, 3 } }, { { 0, 1 }, { 3, 1 } }, { { -1, 0 }, { 1, 2 } },
        { { 0, -1 }, { 1, 2 } }
    };
    bbm_matrix *K;

    for (int k = 0; k < COUNT(wrong); k++) {
        K = (bbm_matrix *)wrong;
        ck_assert_int_eq(bbm_matrix_new(3, 2, wrong[k], &K), BBM_BAD_INDEX);
        ck_assert_ptr_null(K);
    }
}
END_TEST

/* ---------------------------------------------------------------------------- the order of rows */

enum { LONG = 400 };

/* A permutation of n numbers. */
static void shuffle(int n, int *number, unsigned seed)
{
    for (int i = 0; i < n; i++) {
        const int j = (int)((random_entry(&seed) + 1) / 2 * i);
        number[i] = number[j];
        number[j] = i;
    }
}

/* The bandwidth of a strip of width x length rows, each a neighbour of those beside it, numbered at
 * random. */
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
    bandwidth = bandwidth_of(K);
    bbm_matrix_free(K);
    return bandwidth;
}

/* An order by levels of a strip, from one end: a row and those of the next level, no more than two
 * widths in all. From the middle it would be twice that. The least possible: 1 for a chain, 2 for a
 * ring, the width for a strip. */
START_TEST(long_strips_in_any_numbering_get_a_narrow_band)
{
    const unsigned seed = (unsigned)_i;

    ck_assert_int_eq(strip_bandwidth(1, LONG, 0, seed), 1);
    ck_assert_int_eq(strip_bandwidth(1, LONG, 1, seed), 2);
    ck_assert_int_le(strip_bandwidth(2, LONG / 2, 0, seed), 3);
    ck_assert_int_le(strip_bandwidth(4, LONG / 4, 0, seed), 6);
}
END_TEST

/* A comb: a chain with a tooth at each row. The tooth, of degree 1, comes before the next row: the
 * band is 2, not 3. */
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
    ck_assert_int_eq(bandwidth_of(K), 2);
    bbm_matrix_free(K);
}
END_TEST

/* The hub of the star comes next to an end. */
START_TEST(bandwidths_of_small_patterns_are_those_of_theory)
{
    static const int expected[PATTERNS] = { [CHAIN] = 1, [GRID] = 4, [STAR] = 7, [PARTS] = 1,
                                            [REPEATED] = 5 };

    for (int k = 0; k < PATTERNS; k++) {
        dense_system *s = new_system(k, 9);
        ck_assert_int_eq(bandwidth_of(s->K), expected[k]);
        free_system(s);
    }
}
END_TEST

/* --------------------------------------------------------------------------------- the solution */

START_TEST(solution_is_that_of_the_dense_matrix)
{
    dense_system *s = new_system(_i, 10);
    double expected[MOST_6], D[MOST_6 + 1];
    bbm_pcg_info info;

    dense_solve(6 * s->n, s->A, s->F, expected);
    D[6 * s->n] = 77;
    for (int k = 0; k < COUNT(OMEGA); k++) {
        const bbm_pcg pcg = accurate(OMEGA[k], NULL);
        assert_solves(s, D, &pcg, &info, BBM_OK);
        assert_same(6 * s->n, D, expected, SOLVED);
        ck_assert(D[6 * s->n] == 77);
        ck_assert_int_gt(info.iterations, 0);
        ck_assert_int_eq(info.element, -1);
    }
    free_system(s);
}
END_TEST

/* M = 1/(2-w) (D/w + L) (D/w)^-1 (D/w + L)^T, here with the textbooks' factor; D and L are blocks
 * of A in the order of its rows. */
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
            M[i][j] = inner_product(n, E[i], column[j]) / (2 - w);
}

/* A chain keeps its order, so that L is the same here and in solver.c. */
START_TEST(iterates_are_those_of_ssor_pcg_with_dense_matrices)
{
    static double M[MOST_6][MOST_6], W[MOST_6][MOST_6];
    dense_system *s = new_system(CHAIN, 11);

    form_ssor(s, OMEGA[_i], M);
    for (int i = 0; i < 6 * s->n; i++) {
        double e[MOST_6] = { 0 };
        e[i] = 1;
        dense_solve(6 * s->n, M, e, W[i]);
    }
    check_iterates(s, W, accurate(OMEGA[_i], NULL));
    free_system(s);
}
END_TEST

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

START_TEST(residual_is_the_true_one)
{
    dense_system *s = new_system(_i, 14);
    double D[MOST_6];
    bbm_pcg_info info;

    bbm_pcg pcg = accurate(1.2, NULL);
    pcg.tolerance = 1e-3;
    ck_assert_int_eq(bbm_solve(s->K, s->F, D, &pcg, &info), BBM_OK);
    /* two ways to round K D, against a residual that may be rounding itself */
    ck_near(info.residual, largest_residual(s, D), 1.0, ROUNDING);
    free_system(s);
}
END_TEST

START_TEST(a_solution_takes_no_longer_than_the_processor_was_at_it)
{
    dense_system *s = new_system(GRID, 15);
    const bbm_pcg pcg = accurate(1, NULL);
    const clock_t start = clock();
    double D[MOST_6];
    bbm_pcg_info info;

    while (clock() - start < CLOCKS_PER_SEC / 1000)     /* so that the start is not 0 */
        ;
    const clock_t before = clock();
    ck_assert_int_eq(bbm_solve(s->K, s->F, D, &pcg, &info), BBM_OK);
    const double seconds = (double)(clock() - before) / CLOCKS_PER_SEC;
    ck_assert(info.seconds[0] >= 0 && info.seconds[1] >= 0);
    /* a tick */
    ck_assert_double_le(info.seconds[0] + info.seconds[1], seconds + 1.0 / CLOCKS_PER_SEC);
    free_system(s);
}
END_TEST

/* A power of two changes no digit, and the squares of such loads would not be numbers any more. */
START_TEST(loads_of_any_size_give_the_same_digits)
{
    static const int exponent[] = { 900, 600, -600, -900 };
    dense_system *s = new_system(CHAIN, 16);
    const bbm_pcg pcg = accurate(1, NULL);
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
    const bbm_pcg pcg = accurate(1, NULL);
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

/* The exact solution falls by 0.8 from row to row, below every number in 3200 rows: D_i = 0.8^i /
 * (1 - 0.8 c), where 0.8 = (1 - sqrt(1 - 4 c^2)) / (2 c), c = 0.8 / 1.64. */
START_TEST(load_on_one_of_many_rows_makes_no_denormals)
{
    enum { ROWS = 4000 };
    const double c = 0.8 / 1.64;
    const bbm_pcg pcg = accurate(1, NULL);
    bbm_matrix *K = tridiagonal(ROWS, -c);
    double *F = calloc(6 * ROWS, sizeof *F), *D = calloc(6 * ROWS, sizeof *D);
    bbm_pcg_info info;

    F[0] = 1;
    ck_assert_int_eq(bbm_solve(K, F, D, &pcg, &info), BBM_OK);
    for (int i = 0; i < ROWS; i++) {
        ck_near(D[6 * i], pow(0.8, i) / (1 - 0.8 * c), 1.0, 1e-11);
        ck_assert(fabs(D[6 * i]) >= 1e-110 && fabs(D[6 * i + 5]) >= 1e-110 &&
                  fabs(D[6 * i + 5]) <= 1e-90);
    }
    bbm_matrix_free(K);
    free(F);
    free(D);
}
END_TEST

/* -------------------------------------------------------------------------------- what can fail */

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
    const bbm_pcg wrong[] = {
        { 0, 1e-8, 100, NULL }, { 2, 1e-8, 100, NULL }, { -1, 1e-8, 100, NULL },
        { 3, 1e-8, 100, NULL }, { NAN, 1e-8, 100, NULL }, { 1, 0, 100, NULL },
        { 1, -1e-8, 100, NULL }, { 1, NAN, 100, NULL }, { 1, INFINITY, 100, NULL },
        { 1, 1, 100, NULL }, { 1, 1e-8, 0, NULL }, { 1, 1e-8, -1, NULL },
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
    const bbm_pcg pcg = accurate(1, NULL);
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
    const bbm_pcg pcg = accurate(1, NULL);
    bbm_pcg_info info;
    double B[6][6] = { { 0 } };

    for (int k = 0; k < COUNT(place); k++) {
        B[_i / 6][_i % 6] = k % 2 ? NAN : INFINITY;
        ck_assert_int_eq(bbm_matrix_add(s->K, place[k][0], place[k][1], B), BBM_OK);
        ck_assert_int_eq(refused(s, &pcg, &info), BBM_NOT_FINITE);
        bbm_matrix_clear(s->K);
        fill_system(s, 20);
    }
    free_system(s);
}
END_TEST

/* _i is the pivot; it is 0 or -1. */
START_TEST(diagonal_block_that_is_not_positive_definite_is_named)
{
    dense_system *s = new_system(GRID, 21);
    bbm_pcg_info info;

    for (int row = 0; row < s->n; row += 5) {
        const bbm_pcg pcg = accurate(1, NULL);
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

/* K = [1 c; c 1] six times. c = 2: -1 is an eigenvalue. c = 1: p is (1, -1) at once and p.Kp
 * exactly 0. */
START_TEST(matrix_that_is_not_positive_definite_is_found_out_by_the_iteration)
{
    const bbm_pcg pcg = accurate(1, NULL);
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
    bbm_pcg pcg = accurate(1, NULL);
    double D[MOST_6];
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
    ck_near(info.residual, largest_residual(s, D), 1.0, ROUNDING);
    free_system(s);
}
END_TEST

START_TEST(solution_too_large_for_a_number_is_not_returned_in_silence)
{
    const bbm_pcg pcg = accurate(1, NULL);
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

/* With these numbers nothing is rounded: one iteration leaves no residual. The first value, 1/1024,
 * times the tolerance is 0. */
START_TEST(least_tolerance_is_met_by_an_exact_solution)
{
    const bbm_pcg pcg = { .omega = 1, .tolerance = DBL_MIN * DBL_EPSILON, .iterations = 10 };
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

/* ------------------------------------------------------------------------- connected components */

/* Rows 0..3, 4, 5..9 and 10 are the components. */
START_TEST(component_without_load_stays_where_it_is)
{
    dense_system *s = new_system(PARTS, 64);
    const bbm_pcg pcg = accurate(1, NULL);
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
    const bbm_pcg pcg = { .omega = OMEGA[_i], .tolerance = 1e-10, .iterations = 1 };
    double expected[MOST_6], D[MOST_6];
    unsigned seed = 65;
    bbm_pcg_info info;

    s->n = 7;
    ck_assert_int_eq(bbm_matrix_new(s->n, 0, NULL, &s->K), BBM_OK);
    fill_system(s, 66);
    for (int i = 0; i < s->n; i++) {
        double B[6][6], g[6];

        for (int a = 0; a < 6; a++)
            g[a] = random_entry(&seed);
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

/* One iteration is enough for a row alone; a block far larger than those on the diagonal makes one
 * chain indefinite. */
START_TEST(component_that_fails_is_reported_and_the_others_are_solved)
{
    dense_system *s = new_system(PARTS, 67), *t = new_system(PARTS, 67);
    bbm_pcg pcg = accurate(1, NULL);
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
    get_block(t->K, 6, 7, B);
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

Suite *solver_suite(void)
{
    Suite *s = suite_create("solver");

    add_case(s, "matrix",
        { product_is_that_of_the_dense_matrix, PATTERNS },
        { order_direction_and_repetition_of_the_pairs_change_no_bit, PATTERNS },
        { block_added_as_ij_or_transposed_as_ji_is_the_same, 1 },
        { cleared_matrix_is_zero_and_can_be_filled_again, PATTERNS },
        { pair_that_is_not_in_the_pattern_is_refused_and_changes_nothing, 1 },
        { pattern_with_a_row_that_does_not_exist_is_refused, 1 });
    add_case(s, "order",
        { long_strips_in_any_numbering_get_a_narrow_band, 5 },
        { neighbours_of_low_degree_come_first, 5 },
        { bandwidths_of_small_patterns_are_those_of_theory, 1 });
    add_case(s, "solution",
        { solution_is_that_of_the_dense_matrix, PATTERNS },
        { iterates_are_those_of_ssor_pcg_with_dense_matrices, COUNT(OMEGA) });
    add_case(s, "residual and size",
        { residual_is_the_true_one, PATTERNS },
        { a_solution_takes_no_longer_than_the_processor_was_at_it, 1 },
        { loads_of_any_size_give_the_same_digits, 1 },
        { no_load_gives_no_displacement_in_no_iteration, 1 },
        { load_on_one_of_many_rows_makes_no_denormals, 1 });
    add_case(s, "failure",
        { parameter_outside_its_range_is_refused, 1 },
        { entry_of_the_load_that_is_not_finite_is_refused, 1 },
        { entry_of_the_matrix_that_is_not_finite_is_refused, 36 },
        { diagonal_block_that_is_not_positive_definite_is_named, 6 },
        { matrix_that_is_not_positive_definite_is_found_out_by_the_iteration, 1 },
        { limit_of_iterations_ends_with_the_last_iterate_and_its_residual, 1 },
        { solution_too_large_for_a_number_is_not_returned_in_silence, 1 },
        { least_tolerance_is_met_by_an_exact_solution, 1 });
    add_case(s, "components",
        { component_without_load_stays_where_it_is, 1 },
        { rows_that_are_not_connected_take_one_iteration, COUNT(OMEGA) },
        { component_that_fails_is_reported_and_the_others_are_solved, 1 });
    return s;
}
