/* check_coarse.c - the coarse space of the solver: two levels, and the interpolation. */
#include <string.h>
#include <time.h>

#include "check.h"
#include "rock.h"
#include "systems.h"

/* ----------------------------------------------------------------------------------- two levels */

enum { MOST_CORNERS = 4 * MOST };

static const bbm_element none = { .n = 4 };     /* where no bond and no hourglass asks for it */

typedef struct {                /* a coarse space: P takes all its unknowns to all rows */
    int nodes, first[MOST + 1], node[MOST_CORNERS], joined;
    long long place[4 * MOST_CORNERS];
    double P[MOST_6][4 * MOST_CORNERS];         /* twice, for a test that doubles the nodes */
    double Q[MOST][4][4];
} dense_coarse;

/* P of the displacement f (u, v), f linear in x and y. */
static void unknowns(bbm_linear f, double Q[4][4], double P[6][2])
{
    const double values[2][2] = { { f.f, 0 }, { 0, f.f } };

    memcpy(P, values, sizeof values);
    for (int a = 0; a < 8; a++)
        P[2 + a / 2][a % 2] = Q[a / 2][a % 2 * 2] * f.fx + Q[a / 2][a % 2 * 2 + 1] * f.fy;
}

/* All nodes of a row come one after the other: each has the Q of a turn by 0.2 or another one. */
static void random_unknowns(dense_coarse *c, int i, int node, unsigned *seed)
{
    const double f = random_entry(seed), fx = random_entry(seed), fy = random_entry(seed);
    const double D[6] = { 0, 0, i % 3 * 0.2, 0.1 * (i % 5), -0.1, 0.3 };
    double P[6][2];

    bbm_slopes(D, c->Q[i]);
    unknowns((bbm_linear){ f, fx, fy }, c->Q[i], P);
    for (int a = 0; a < 12; a++)
        c->P[6 * i + a / 2][2 * node + a % 2] = P[a / 2][a % 2];
}

static void hang(dense_system *s, dense_coarse *c)
{
    for (int i = 0; i < s->n; i++)
        for (int k = c->first[i]; k < c->first[i + 1]; k++)
            c->place[c->node[k]] = s->K->component[i] * BBM_PLACES
                                   + 7919 * (c->node[k] / (c->joined + 1)) % 1024;
    ck_assert_int_eq(bbm_matrix_coarse(s->K, c->nodes, c->first, c->node, c->place, 0), BBM_OK);
    for (int i = 0; i < s->n; i++) {
        double (*Q)[4] = c->Q[i];
        const double det = Q[1][0] * Q[2][1] - Q[1][1] * Q[2][0];
        for (int k = c->first[i]; k < c->first[i + 1]; k++) {
            const int u = 2 * c->node[k];
            const double ex = c->P[6 * i + 3][u], ey = c->P[6 * i + 4][u];
            const bbm_linear P = { c->P[6 * i][u], (Q[2][1] * ex - Q[1][1] * ey) / det,
                                   (Q[1][0] * ey - Q[2][0] * ex) / det };

            ck_assert_int_eq(bbm_matrix_interpolate(s->K, i, k - c->first[i], Q, P, &none), BBM_OK);
        }
    }
}

/* Row i hangs on the nodes i/2 and i/2 + 2, of whose order only the solver knows; every fifth row
 * on none. Each connected component has its own nodes. */
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
            random_unknowns(c, i, c->node[k], &seed);
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
            b[a] = r[6 * i + a] - inner_product(6 * s->n, s->A[6 * i + a], y);
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

/* z += P (P^T A P)^-1 P^T r. Nodes on which no row hangs have a 1 on the diagonal. */
static void dense_correct(const dense_system *s, const dense_coarse *c, const double *r, double *z)
{
    static double Kc[MOST_6][MOST_6];
    double column[MOST_6], AP[MOST_6], b[MOST_6], x[MOST_6];
    const int n = 6 * s->n, coarse = 2 * c->nodes;

    for (int j = 0; j < coarse; j++) {
        for (int i = 0; i < n; i++)
            column[i] = c->P[i][j];
        b[j] = inner_product(n, column, r);
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
        z[i] += inner_product(coarse, c->P[i], x);
}

/* W: the same three corrections of the residual, one after the other, and the residual afresh
 * before each. */
START_TEST(two_level_iterates_are_those_with_dense_matrices)
{
    static double W[MOST_6][MOST_6];
    dense_system *s = new_system(CHAIN, 32);
    dense_coarse *c = new_coarse(s, 33);
    double r[MOST_6];

    for (int i = 0; i < 6 * s->n; i++) {
        double e[MOST_6] = { 0 };

        e[i] = 1;
        gauss_seidel(s, 0, e, W[i]);
        dense_residual(s, e, W[i], r);
        dense_correct(s, c, r, W[i]);
        dense_residual(s, e, W[i], r);
        gauss_seidel(s, 1, r, W[i]);
    }
    check_iterates(s, W, accurate(1, &bbm_two_level));
    free(c);
    free_system(s);
}
END_TEST

/* As for blocks of one triangle: three nodes of its own for each row, and a P that is regular. */
START_TEST(coarse_space_of_all_unknowns_solves_in_one_iteration)
{
    dense_system *s = new_system(_i, 34);
    dense_coarse *c = calloc(1, sizeof *c);
    bbm_pcg pcg = accurate(1, &bbm_two_level);
    double expected[MOST_6], D[MOST_6];
    bbm_pcg_info info;
    unsigned seed = 35;

    c->nodes = 3 * s->n;
    for (int i = 0; i < 3 * s->n; i++) {
        c->first[i / 3 + 1] = i + 1;
        c->node[i] = (i + 5) % c->nodes;
        random_unknowns(c, i / 3, c->node[i], &seed);
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

/* Every node three times, with the same P: Kc is singular, two thirds of its pivots vanish; the
 * space is the same. (Rows that had two of four nodes in common would have a side in common.) */
START_TEST(coarse_displacements_that_move_nothing_change_no_iterate)
{
    dense_system *s = new_system(_i, 24);
    dense_coarse *c = new_coarse(s, 37), *thrice = calloc(1, sizeof *thrice);
    const bbm_pcg pcg = { .omega = 1, .tolerance = 1e-6, .iterations = 1000,
                          .method = &bbm_two_level };
    double D[MOST_6], E[MOST_6];
    bbm_pcg_info once, again;

    ck_assert_int_eq(bbm_solve(s->K, s->F, D, &pcg, &once), BBM_OK);
    thrice->nodes = 3 * c->nodes;
    for (int i = 0; i < s->n; i++) {
        thrice->first[i + 1] = 3 * c->first[i + 1];
        memcpy(thrice->Q[i], c->Q[i], sizeof c->Q[i]);
        for (int k = thrice->first[i]; k < thrice->first[i + 1]; k++) {
            thrice->node[k] = 3 * c->node[k / 3] + k % 3;
            for (int a = 0; a < 12; a++)
                thrice->P[6 * i + a / 2][2 * thrice->node[k] + a % 2] =
                    c->P[6 * i + a / 2][2 * c->node[k / 3] + a % 2];
        }
    }
    hang(s, thrice);
    ck_assert_int_eq(bbm_solve(s->K, s->F, E, &pcg, &again), BBM_OK);
    ck_assert_int_eq(again.iterations, once.iterations);
    assert_same(6 * s->n, E, D, SOLVED);
    free(c);
    free(thrice);
    free_system(s);
}
END_TEST

START_TEST(two_levels_have_the_solution_of_one_and_without_a_coarse_space_all_its_digits)
{
    dense_system *s = new_system(_i, 38);
    dense_coarse *c = new_coarse(s, 39);
    const int first[MOST + 1] = { 0 };
    const bbm_pcg two = accurate(1.9, &bbm_two_level);   /* an omega that is not used */
    bbm_pcg pcg = accurate(1.3, NULL);
    double D[MOST_6], E[MOST_6];
    bbm_pcg_info info;

    ck_assert_int_eq(bbm_solve(s->K, s->F, D, &pcg, &info), BBM_OK);
    ck_assert_int_eq(bbm_solve(s->K, s->F, E, &two, &info), BBM_OK);
    assert_same(6 * s->n, E, D, SOLVED);
    /* it takes the old one away */
    ck_assert_int_eq(bbm_matrix_coarse(s->K, 0, first, NULL, NULL, 0), BBM_OK);
    pcg.method = &bbm_two_level;
    ck_assert_int_eq(bbm_solve(s->K, s->F, E, &pcg, &info), BBM_OK);
    ck_assert_mem_eq(D, E, (size_t)(6 * s->n) * sizeof *D);
    free(c);
    free_system(s);
}
END_TEST

/* What is kept from solve to solve is made again when omega, K, P or the nodes have changed: after
 * each change the solution is that of a system to which the same was done, but which was never
 * solved before. */
static void change(dense_system *s, dense_coarse *c, int changes)
{
    double B[6][6] = { { 1 } };

    if (changes == 2)
        bbm_matrix_add(s->K, 3, 3, B);
    if (changes == 3)
        bbm_matrix_interpolate(s->K, 3, 1, c->Q[3], (bbm_linear){ 1, 2, 3 }, &none);
    if (changes == 4)
        bbm_matrix_clear(s->K);
    if (changes == 4)
        fill_system(s, 40);
    c->node[1] = changes == 5 ? c->nodes - 1 : c->node[1];
    if (changes == 5)
        ck_assert_int_eq(bbm_matrix_coarse(s->K, c->nodes, c->first, c->node, c->place, 0), BBM_OK);
}

START_TEST(solution_does_not_depend_on_earlier_ones)
{
    static const bbm_method *const method[] = { &bbm_two_level, NULL };
    dense_system *s = new_system(GRID, 40);
    dense_coarse *c = new_coarse(s, 41);
    double D[MOST_6], E[MOST_6];
    bbm_pcg_info info;

    for (int k = 0; k < 12; k++) {
        const bbm_pcg pcg = accurate(k % 6 ? 1.2 : 1, method[(k / 6 + _i) % 2]);
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

START_TEST(corners_that_the_coarse_space_does_not_have_are_refused)
{
    dense_system *s = new_system(CHAIN, 42);
    dense_coarse *c = new_coarse(s, 43);
    static const int wrong[][2] = { { -1, 0 }, { 12, 0 }, { 0, -1 }, { 0, 2 }, { 4, 0 },
                                    { 11, 2 } };
    const bbm_linear P = { 0, 0, 0 };

    for (int k = 0; k < COUNT(wrong); k++)
        ck_assert_int_eq(bbm_matrix_interpolate(s->K, wrong[k][0], wrong[k][1], c->Q[0], P, &none),
                         BBM_BAD_INDEX);
    memset(c->first, 0, sizeof c->first);
    ck_assert_int_eq(bbm_matrix_coarse(s->K, 0, c->first, NULL, NULL, 0), BBM_OK);
    ck_assert_int_eq(bbm_matrix_interpolate(s->K, 0, 0, c->Q[0], P, &none), BBM_BAD_INDEX);
    free(c);
    free_system(s);
}
END_TEST

START_TEST(coarse_space_that_finds_no_memory_is_none)
{
    dense_system *s = new_system(GRID, 44);
    dense_coarse *c = new_coarse(s, 45);
    const bbm_pcg pcg = accurate(1, &bbm_two_level);
    bbm_status status = BBM_NO_MEMORY;
    double expected[MOST_6], D[MOST_6];
    bbm_pcg_info info;
    int calls;

    dense_solve(6 * s->n, s->A, s->F, expected);
    for (calls = 0; status != BBM_OK; calls++) {
        test_allocations_left = calls;
        status = bbm_matrix_coarse(s->K, c->nodes, c->first, c->node, c->place, 0);
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

/* ------------------------------------------------------------------------- connected components */

enum { ONE_AFTER_THE_OTHER, THE_OTHER_FIRST, ALTERNATING, ARRANGEMENTS };

/* Two systems in one: row k of it is row number[k] of s[whose[k]]. */
static dense_system *join(dense_system *const s[2], dense_coarse *const c[2], const int *whose,
                          const int *number)
{
    dense_system *t = calloc(1, sizeof *t);
    dense_coarse *d = calloc(1, sizeof *d);
    int row[2][MOST];
    double B[6][6];

    t->n = s[0]->n + s[1]->n;
    d->nodes = 2 * (c[0]->nodes + c[1]->nodes);
    d->joined = 1;
    for (int k = 0; k < t->n; k++) {
        const dense_coarse *from = c[whose[k]];
        const int i = number[k];

        row[whose[k]][i] = k;
        d->first[k + 1] = d->first[k] + from->first[i + 1] - from->first[i];
        for (int m = 0; m < d->first[k + 1] - d->first[k]; m++) {
            const int node = from->node[from->first[i] + m];

            d->node[d->first[k] + m] = 2 * node + whose[k];
            memcpy(d->Q[k], from->Q[i], sizeof d->Q[k]);
            for (int a = 0; a < 12; a++)
                d->P[6 * k + a / 2][4 * node + 2 * whose[k] + a % 2] =
                    from->P[6 * i + a / 2][2 * node + a % 2];
        }
    }
    for (int q = 0; q < 2; q++)
        for (int k = 0; k < s[q]->pairs; k++)
            add_pair(t, row[q][s[q]->pair[k][0]], row[q][s[q]->pair[k][1]]);
    ck_assert_int_eq(bbm_matrix_new(t->n, t->pairs, t->pair, &t->K), BBM_OK);
    for (int q = 0; q < 2; q++)
        for (int k = -s[q]->n; k < s[q]->pairs; k++) {
            const int i = k < 0 ? -1 - k : s[q]->pair[k][0], j = k < 0 ? i : s[q]->pair[k][1];

            get_block(s[q]->K, i, j, B);
            ck_assert_int_eq(bbm_matrix_add(t->K, row[q][i], row[q][j], B), BBM_OK);
        }
    hang(t, d);
    free(d);
    return t;
}

/* The other one's load is 2^40 = 1e12 times larger, which changes no digit of its own. */
START_TEST(what_is_not_connected_is_solved_as_if_it_were_alone)
{
    static const bbm_method *const method[] = { &bbm_two_level, NULL };
    dense_system *const s[2] = { new_system(GRID, 68), new_system(CHAIN, 61) };
    dense_coarse *const c[2] = { new_coarse(s[0], 62), new_coarse(s[1], 63) };
    const int arrangement = _i % ARRANGEMENTS;
    const bbm_pcg pcg = { .omega = 1.2, .tolerance = 1e-8, .iterations = 1000,
                          .method = method[_i / ARRANGEMENTS] };
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
        ck_assert(D[k] == ldexp(alone[whose[k / 6]][6 * number[k / 6] + k % 6],
                                whose[k / 6] ? 40 : 0));
    ck_assert_int_ne(info[0].iterations, info[1].iterations);
    ck_assert_int_eq(both.iterations,
                     info[0].iterations > info[1].iterations ? info[0].iterations
                                                             : info[1].iterations);
    ck_assert(both.residual == fmax(info[0].residual, info[1].residual));
    for (int q = 0; q < 2; q++) {
        free(c[q]);
        free_system(s[q]);
    }
    free_system(t);
}
END_TEST

/* Seconds for 512 chains of three rows on two levels; the rows of a chain are `apart` rows apart.
 * Each end has a coarse node, the middle none, so that no block of Kc joins the two. */
static double chains_time(int apart)
{
    enum { PAIRS = 1024, ROWS = 1536 };
    static const bbm_pcg pcg = { .omega = 1, .tolerance = 1e-10, .iterations = 100,
                                 .method = &bbm_two_level };
    static int pair[PAIRS][2], first[ROWS + 1], node[ROWS];
    static long long place[ROWS];
    static double F[6 * ROWS], D[6 * ROWS];
    const bbm_linear P = { 1, 0, 0 };
    double B[6][6] = { { 0 } }, Q[4][4] = { { 0 } };
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
    for (int i = 0; i < ROWS; i++)
        place[first[i]] = K->component[i] * BBM_PLACES;
    ck_assert_int_eq(bbm_matrix_coarse(K, first[ROWS], first, node, place, 0), BBM_OK);
    for (int i = 0; i < ROWS; i++) {
        for (int a = 0; a < 6; a++) {
            B[a][a] = 2 + a;
            F[6 * i + a] = a + i % 5;
        }
        ck_assert_int_eq(bbm_matrix_add(K, i, i, B), BBM_OK);
        if (first[i + 1] > first[i])
            ck_assert_int_eq(bbm_matrix_interpolate(K, i, 0, Q, P, &none), BBM_OK);
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

/* Were the coarse nodes in the caller's order, each chain whose rows are far apart would look at
 * half of them. */
START_TEST(order_of_the_rows_does_not_matter_to_the_time)
{
    const double near = chains_time(1), far = chains_time(512);

    ck_assert_msg(far < 3 * near, "%g s and %g s", far, near);      /* 1; or else 8 */
}
END_TEST

/* Bytes for the coarse space of a strip of triangles: i has the corners i, i + 1, i + 2 and a side
 * with the next one. */
static size_t strip_bytes(int triangles)
{
    int (*pair)[2] = calloc((size_t)triangles, sizeof *pair);
    int *first = calloc(4 * (size_t)triangles + 1, sizeof *first);
    int *node = first + triangles + 1;
    long long *place = calloc((size_t)triangles + 2, sizeof *place);
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
    ck_assert_int_eq(bbm_matrix_coarse(K, triangles + 2, first, node, place, 0), BBM_OK);
    const size_t bytes = test_bytes - before;
    bbm_matrix_free(K);
    free(pair);
    free(first);
    free(place);
    return bytes;
}

/* Each node of the strip has two rows of Kc that begin two nodes before it, of 6 entries; P of a
 * triangle's corners takes 72 bytes, whether they are held 18, its centroid and stiffness 24, a
 * vector of its unknowns 48, its slopes 128, all that is numbered, listed and measured on the way
 * 270. Nodes across a common side, 3 apart, would take 44 more. */
START_TEST(kc_has_room_for_corners_of_one_element_and_no_others)
{
    ck_assert_uint_le(strip_bytes(200) - strip_bytes(100),
                      100 * (96 + 72 + 18 + 24 + 48 + 128 + 270));
}
END_TEST

/* ------------------------------------------------------------------------- two levels on meshes */

enum { TRIANGLES, QUADRILATERALS, DISTORTED, GRADED_HOLE, CRACKED, BENDING, BENDING_DISTORTED,
       MESHES };

static void mesh_node(bbm_model *m, int mesh, double s, double t, double size, unsigned *seed)
{
    const int distorted = mesh == DISTORTED || mesh == BENDING_DISTORTED;
    const double inside = s > 0 && s < 1 && t > 0 && t < 1 && distorted ? 0.25 * size : 0;
    const double u = random_entry(seed), v = random_entry(seed), r = pow(10, t);
    const double angle = acos(0) * (1 - s);

    if (mesh == GRADED_HOLE)
        bbm_add_node(m, r * cos(angle), r * sin(angle), NULL);
    else
        bbm_add_node(m, 4 * s + inside * u, t + inside * v, NULL);
}

/* n rows of 4 n cells, held on the left and loaded on the right: a beam 4 x 1, or a quarter of a
 * plate with a hole, whose elements differ in area by 100. The crack runs from a quarter of the
 * length to the right end, through all bonds of the line. Quadrilaterals bonded in their middles
 * begin with any of their corners. One step leaves K and F. */
static bbm_model *new_mesh(int mesh, int n, double alpha)
{
    const int nx = 4 * n, across = nx + 1;
    const int bending = mesh == BENDING || mesh == BENDING_DISTORTED;
    const int quadrilaterals = mesh == QUADRILATERALS || bending;
    unsigned seed = 47;
    bbm_model *m = beyond_model();

    bbm_add_material(m, &(bbm_material){ 30e6, 0.3, 1, 1 }, NULL);
    for (int j = 0; j <= n; j++)
        for (int i = 0; i <= nx; i++)
            mesh_node(m, mesh, (double)i / nx, (double)j / n, 1.0 / n, &seed);
    for (int j = 0; j < n; j++)
        for (int i = 0; i < nx; i++) {
            const int a = j * across + i, rising = (i + j) % 2;
            const int q[4] = { a, a + 1, a + across + 1, a + across };
            const int start = bending ? i + j / 2 : 0;
            const int turned[4] = { q[start % 4], q[(start + 1) % 4], q[(start + 2) % 4],
                                    q[(start + 3) % 4] };
            const int lower[3] = { q[0], q[1], q[rising ? 3 : 2] };
            const int upper[3] = { q[2], q[3], q[rising ? 1 : 0] };

            bbm_add_element(m, 0, 0, quadrilaterals ? 4 : 3, quadrilaterals ? turned : lower, NULL);
            if (!quadrilaterals)
                bbm_add_element(m, 0, 0, 3, upper, NULL);
        }
    for (int j = 0; j <= n; j++) {
        bbm_fix_node(m, j * across, BBM_XY, 0, 0);
        bbm_add_load(m, j * across + nx, 0, -1000);
    }
    m->par.alpha = alpha;
    m->beyond->bonding = bending ? BBM_MOMENT : BBM_VERTICES;
    m->par.pcg.iterations = 200;  /* several times what is needed: an error ends at once */
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

    release(m);
    return iterations;
}

/* Not too few, either: if corners that belong together were not one node, the coarse space would be
 * nearly the whole one, solved in an iteration or two at the price of a direct solver. */
START_TEST(iterations_on_two_levels_are_few_and_hardly_grow_with_the_mesh)
{
    static const struct { int mesh; double alpha; int most; } claim[] = {
        { TRIANGLES, 10, 18 }, { TRIANGLES, 100, 18 }, { TRIANGLES, 1000, 16 },
        { QUADRILATERALS, 10, 16 }, { QUADRILATERALS, 1000, 16 },
        { DISTORTED, 10, 28 }, { DISTORTED, 1000, 28 }, { GRADED_HOLE, 10, 20 },
        { GRADED_HOLE, 1000, 20 },   { CRACKED, 10, 24 },       { CRACKED, 1000, 24 },
        { BENDING, 10, 18 }, { BENDING, 100, 22 }, { BENDING, 1000, 21 },
        { BENDING_DISTORTED, 10, 20 }, { BENDING_DISTORTED, 100, 23 },
        { BENDING_DISTORTED, 1000, 24 },
    };
    const int mesh = claim[_i].mesh, most = claim[_i].most;
    const int coarse = mesh_iterations(mesh, 8, claim[_i].alpha);
    const int fine = mesh_iterations(mesh, 16, claim[_i].alpha);

    ck_assert_int_le(fine, most);
    ck_assert_int_ge(fine, most / 2);
    ck_assert_int_le(fine, coarse + (mesh == TRIANGLES ? 1 : 2));
}
END_TEST

/* 4,096 quadrilaterals. With a hundred times the stiffness against the hourglass they take 24 at
 * alpha = 100 and 53 at 1000, with none 27 at both. */
START_TEST(quadrilaterals_by_the_thousand_take_no_more_iterations)
{
    static const struct { int mesh; double alpha; int most; } claim[] = {
        { BENDING, 10, 18 }, { BENDING, 100, 22 }, { BENDING_DISTORTED, 1000, 24 },
    };
    const int iterations = mesh_iterations(claim[_i].mesh, 32, claim[_i].alpha);

    ck_assert_int_le(iterations, claim[_i].most);
    ck_assert_int_ge(iterations, claim[_i].most / 2);
}
END_TEST

/* The same mesh, with a support at every fourth node along its lower side, or half-way up. Were the
 * bonds there left out of Kc, too, their corners would each be held, which takes 41 iterations. */
START_TEST(supports_of_quadrilaterals_by_the_thousand_cost_few_iterations)
{
    bbm_model *m = new_mesh(BENDING, 32, 100);
    const int across = 4 * 32 + 1;

    for (int i = 4; i < across; i += 4)
        bbm_fix_node(m, (_i ? 16 * across : 0) + i, BBM_Y, 0, 0);
    ck_ok(bbm_step(m), m);
    ck_assert_int_le(m->info.pcg.iterations, 36);
    ck_assert_int_ge(m->info.pcg.iterations, 18);
}
END_TEST

/* A bar of one row bends by the moments of its bonds alone, which Kc has to know: left out as on a
 * mesh, it takes 53 iterations. */
START_TEST(a_bar_of_one_row_beside_a_mesh_takes_few_iterations)
{
    static const int nx[2] = { 20, 40 }, ny[2] = { 20, 1 };
    bbm_model *m = beyond_model();

    bbm_add_material(m, &(bbm_material){ 30e6, 0.3, 1, 1 }, NULL);
    for (int k = 0; k < 2; k++) {
        const int first = m->nodes, across = nx[k] + 1;
        for (int n = 0; n < across * (ny[k] + 1); n++)
            bbm_add_node(m, n % across, n / across - 10 * k, NULL);
        for (int n = 0; n < nx[k] * ny[k]; n++) {
            const int a = first + n / nx[k] * across + n % nx[k];
            bbm_add_element(m, k, 0, 4, (int [4]){ a, a + 1, a + 1 + across, a + across }, NULL);
        }
        for (int j = 0; j <= ny[k]; j++)
            bbm_fix_node(m, first + j * across, BBM_XY, 0, 0);
        bbm_add_load(m, first + nx[k], 0, -1);
    }
    ck_ok(bbm_prepare(m), m);
    ck_ok(bbm_step(m), m);
    ck_assert_int_le(m->info.pcg.iterations, 24);
    release(m);
}
END_TEST

/* Both to 1e-12 of what each measures; the condition of K is some 1e6. */
START_TEST(two_levels_and_one_reach_the_same_displacements)
{
    bbm_model *m = new_mesh(_i, 6, 100);
    bbm_pcg pcg = { .omega = 1, .tolerance = 1e-12, .iterations = 5000, .method = &bbm_two_level };
    double *D = calloc(6 * (size_t)m->elements, sizeof *D);
    bbm_pcg_info two, one;

    ck_assert_int_eq(bbm_solve(m->K, m->F, D, &pcg, &two), BBM_OK);
    pcg.method = NULL;
    ck_assert_int_eq(bbm_solve(m->K, m->F, m->D, &pcg, &one), BBM_OK);
    ck_assert_int_lt(10 * two.iterations, one.iterations);
    assert_same(6 * m->elements, D, m->D, 1e-8);
    free(D);
}
END_TEST

/* Two triangles with a side in common have four nodes; a quadrilateral apart has none. */
START_TEST(corners_that_a_bond_ties_together_are_one_coarse_node)
{
    static const int node[2][3] = { { 0, 1, 2 }, { 1, 3, 2 } }, first[] = { 0, 3, 6, 6 };
    static const int held[2][3] = { { -1 - 0, 1, -1 - 2 }, { 1, 3, -1 - 2 } };
    static const int apart[4] = { 4, 5, 7, 6 };
    static const double xy[8][2] = { { 0, 0 }, { 1, 0 }, { 0, 1 }, { 1, 1 },
                                     { 5, 0 }, { 6, 0 }, { 5, 1 }, { 6, 1 } };
    bbm_linear P[2][3];
    bbm_element e[2];
    double E[18], Q[4][4];
    bbm_pcg_info info;
    bbm_model *m = beyond_model();

    bbm_add_material(m, &(bbm_material){ 30e6, 0.3, 1, 1 }, NULL);
    for (int i = 0; i < 8; i++)
        bbm_add_node(m, xy[i][0], xy[i][1], NULL);
    for (int i = 0; i < 2; i++)
        bbm_add_element(m, 0, 0, 3, node[i], NULL);
    bbm_add_element(m, 1, 0, 4, apart, NULL);
    bbm_fix_node(m, 4, BBM_XY, 0, 0);
    bbm_fix_node(m, 5, BBM_XY, 0, 0);
    bbm_fix_node(m, 0, BBM_XY, 0, 0);
    bbm_fix_node(m, 2, BBM_X, 0, 0);
    bbm_add_load(m, 3, 100, -1000);
    ck_ok(bbm_prepare(m), m);
    memcpy(e, m->element, sizeof e);
    for (int k = 0; k < 6; k++)
        P[k / 3][k % 3] = bbm_interpolation(&m->element[k / 3], &m->vertex[3 * (k / 3)], k % 3);
    ck_ok(bbm_step(m), m);
    const long long start = m->K->component[0] * BBM_PLACES, x = 0x2aaaaaaa, y = x / 2;
    const long long place[] = { start, start + x, start + y, start + x + y };
    ck_assert_int_eq(bbm_matrix_coarse(m->K, 4, first, held[0], place, 0), BBM_OK);
    bbm_slopes((double [6]){ 0 }, Q);
    for (int k = 0; k < 6; k++)
        ck_assert_int_eq(bbm_matrix_interpolate(m->K, k / 3, k % 3, Q, P[k / 3][k % 3], &e[k / 3]),
                         BBM_OK);
    ck_assert_int_eq(bbm_solve(m->K, m->F, E, &m->par.pcg, &info), BBM_OK);
    ck_assert_mem_eq(E, m->D, sizeof E);
}
END_TEST

/* Two blocks of one element each, or of bonded ones all of whose corners are held, fall back on
 * SSOR alone; so does every model in steps that a wave needs to cross an element. */
static void mesh_of_blocks(bbm_model *m, int bonded, int held)
{
    bbm_add_material(m, &(bbm_material){ 1e10, 0.2, 2500, 1 }, NULL);
    for (int i = 0; i < 8; i++)
        bbm_add_node(m, 2 * (i / 2), 2 * (i % 2), NULL);
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

START_TEST(one_level_is_used_where_two_do_not_pay)
{
    static const struct { int bonded, held; double dt; int two; } table[] = {
        { 1, 0, 2e-2, 1 }, { 1, 0, 3.6e-3, 1 }, { 1, 0, 2.4e-3, 0 },
        { 1, 0, 2e-4, 0 }, { 0, 0, 2e-2, 0 },   { 1, 1, 2e-2, 0 },
    };
    bbm_model *m[2];

    for (int k = 0; k < 2; k++) {
        m[k] = beyond_model();
        m[k]->par.dt = table[_i].dt;
        m[k]->par.pcg.method = k ? NULL : &bbm_two_level;
        mesh_of_blocks(m[k], table[_i].bonded, table[_i].held);
    }
    ck_assert_int_eq(memcmp(m[0]->D, m[1]->D, 18 * sizeof *m[0]->D) != 0, table[_i].two);
}
END_TEST

/* ---------------------------------------------------------------------------- the interpolation */

static const double CORNER[5][2] = { { 3.1, -2.2 }, { 4.4, -2 }, { 4.6, -0.9 }, { 3.7, 0.2 },
                                     { 2.8, -0.7 } };

static void corners(int n, bbm_element *e, bbm_vertex v[5])
{
    *e = (bbm_element){ .n = n };
    for (int a = 0; a < n; a++)
        v[a] = (bbm_vertex){ .x = CORNER[a][0], .y = CORNER[a][1] };
    bbm_element_geometry(e, v);
}

/* With T of (2), or T_m of a step in which the element turns by 0.5. */
START_TEST(linear_displacements_of_the_corners_are_those_of_the_element)
{
    static const double D[6] = { 0.3, -0.7, 0.2, 1.1, -0.4, 0.9 };
    const int n = 3 + _i % 3;
    double sum[6] = { 0 }, T[2][6], P[6][2], Q[4][4], at[2];
    bbm_model *m = beyond_model();
    bbm_middle middle = { .motion = _i < 3 ? NULL : bbm_motion_of(m) };
    bbm_vertex v[5];
    bbm_element e;

    corners(n, &e, v);
    for (int a = 0; a < 6 && _i >= 3; a++)
        middle.D[a] = 0.1 * (a + 3);
    e.middle = _i < 3 ? NULL : &middle;
    bbm_slopes(middle.D, Q);
    for (int a = 0; a < n; a++) {
        bbm_step_point(&e, v[a].x, v[a].y, T, at);
        unknowns(bbm_interpolation(&e, v, a), Q, P);
        for (int i = 0; i < 6; i++)
            sum[i] += P[i][0] * inner_product(6, T[0], D) + P[i][1] * inner_product(6, T[1], D);
    }
    assert_same(6, sum, D, ROUNDING);
    release(m);
}
END_TEST

/* T^T (T D - u), summed over the middles of the sides, is zero where |T D - u|^2 is
 * least. */
START_TEST(interpolation_is_the_nearest_linear_displacement)
{
    const int n = 3 + _i;
    double u[5][2], D[6] = { 0 }, sum[6] = { 0 }, T[2][6], P[6][2], Q[4][4];
    unsigned seed = 48;
    bbm_vertex v[5];
    bbm_element e;

    corners(n, &e, v);
    bbm_slopes(D, Q);
    for (int a = 0; a < n; a++) {
        unknowns(bbm_interpolation(&e, v, a), Q, P);
        for (int k = 0; k < 2; k++) {
            u[a][k] = random_entry(&seed);
            for (int i = 0; i < 6; i++)
                D[i] += P[i][k] * u[a][k];
        }
    }
    for (int a = 0; a < n; a++) {
        const int b = (a + 1) % n;
        bbm_mode_matrix(&e, (v[a].x + v[b].x) / 2, (v[a].y + v[b].y) / 2, T);
        for (int k = 0; k < 2; k++)
            for (int i = 0; i < 6; i++)
                sum[i] += T[k][i] * (inner_product(6, T[k], D) - (u[a][k] + u[b][k]) / 2);
    }
    for (int i = 0; i < 6; i++)
        ck_near(sum[i], 0, 1.0, 10 * ROUNDING);
}
END_TEST

Suite *coarse_suite(void)
{
    Suite *s = suite_create("coarse");

    add_case(s, "two levels",
        { two_level_iterates_are_those_with_dense_matrices, 1 },
        { coarse_space_of_all_unknowns_solves_in_one_iteration, PATTERNS },
        { coarse_displacements_that_move_nothing_change_no_iterate, PATTERNS },
        { two_levels_have_the_solution_of_one_and_without_a_coarse_space_all_its_digits, PATTERNS },
        { solution_does_not_depend_on_earlier_ones, 2 },
        { corners_that_the_coarse_space_does_not_have_are_refused, 1 },
        { coarse_space_that_finds_no_memory_is_none, 1 });
    add_case(s, "components",
        { what_is_not_connected_is_solved_as_if_it_were_alone, 2 * ARRANGEMENTS },
        { order_of_the_rows_does_not_matter_to_the_time, 1 },
        { kc_has_room_for_corners_of_one_element_and_no_others, 1 });
    add_case(s, "meshes",
        { iterations_on_two_levels_are_few_and_hardly_grow_with_the_mesh, 17 },
        { quadrilaterals_by_the_thousand_take_no_more_iterations, 3 },
        { supports_of_quadrilaterals_by_the_thousand_cost_few_iterations, 2 },
        { a_bar_of_one_row_beside_a_mesh_takes_few_iterations, 1 },
        { two_levels_and_one_reach_the_same_displacements, MESHES },
        { corners_that_a_bond_ties_together_are_one_coarse_node, 1 },
        { one_level_is_used_where_two_do_not_pay, 6 });
    add_case(s, "interpolation",
        { linear_displacements_of_the_corners_are_those_of_the_element, 6 },
        { interpolation_is_the_nearest_linear_displacement, 3 });
    return s;
}
