/* systems.h - what the tests of the solver share: systems of equations, each with a dense matrix
 * that gets all that is added to the sparse one, and short dense algorithms.
 *
 * Tolerances. ROUNDING: sums of some hundred products, 100 eps. SOLVED: the iteration stops at
 * 1e-13, and the test systems have condition numbers of some thousand. ITERATES: the first steps of
 * two conjugate gradient iterations that differ only in rounding, which each step amplifies. */
#ifndef BBM_TESTS_SYSTEMS_H
#define BBM_TESTS_SYSTEMS_H

#include "../beyond/beyond.h"
#include "check.h"

#define ROUNDING 1e-13
#define SOLVED   1e-9
#define ITERATES 1e-9

enum { MOST = 40, MOST_PAIRS = 120, MOST_6 = 6 * MOST };

extern const double OMEGA[4];

/* A number in [-1, 1], in the same order in every run. */
double random_entry(unsigned *seed);

typedef struct {
    int n, pairs, pair[MOST_PAIRS][2];
    double A[MOST_6][MOST_6], F[MOST_6 + 1];    /* F ends with an infinity that nobody may read */
    bbm_matrix *K;
} dense_system;

void add_block(dense_system *s, int i, int j, double B[6][6]);

/* Three springs for each pair on rows that are held softly, and a random load. */
void fill_system(dense_system *s, unsigned seed);

void add_pair(dense_system *s, int i, int j);

enum { CHAIN, GRID, STAR, PARTS, REPEATED, SINGLE, PATTERNS };

/* The patterns; the grid's rows are in a scattered order, 7 i mod 24. */
dense_system *new_system(int pattern, unsigned seed);

void free_system(dense_system *s);

/* The least row of the connected component of each row. */
void label_components(const dense_system *s, int *least);

double inner_product(int n, const double *x, const double *y);
void dense_multiply(const dense_system *s, const double *x, double *y);

/* x = A^-1 f. */
void dense_solve(int n, double A[MOST_6][MOST_6], const double *f, double *x);

/* Conjugate gradients with W = M^-1, as the textbooks have it. Returns the iterations. */
int dense_pcg(const dense_system *s, double W[MOST_6][MOST_6], double tolerance,
              int limit, double *x);

/* The solver's iterates, one by one and down to some tolerances, are those of dense_pcg. */
void check_iterates(const dense_system *s, double W[MOST_6][MOST_6], bbm_pcg pcg);

double norm(int n, const double *x);
void assert_same(int n, const double *x, const double *y, double tolerance);
/* The solver ends with this status. */
void assert_solves(const dense_system *s, double *D, const bbm_pcg *pcg, bbm_pcg_info *info,
                   bbm_status expected);
bbm_pcg accurate(double omega, const bbm_method *method);

/* K = tridiagonal (c, 1, c), six times. */
bbm_matrix *tridiagonal(int n, double c);

#endif
