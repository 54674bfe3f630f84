/* multipliers.c - Exercise 9.3: multipliers that are kept from step to step, for one mass on one
 * bond; doc/beyond.md, Multipliers.
 *
 * The three numbers of a step are x, the gap; y = V dt; z = f/c, the multiplier over c = 2 m/dt^2.
 * W2 = k dt^2/m, so that k/c = W2/2; n is the number of rounds.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* One step from s = (x, y, z): solve (c + k) x' = c (x + y) - f; n times take the spring's force
 * over into the multiplier, f += k x', and solve again. y' = 2 (x' - x) - y, Eq. (14). */
static void take_step(double W2, int n, double s[3])
{
    const double k_c = W2 / 2, x = s[0], y = s[1];

    for (int round = 0; round <= n; round++) {
        s[2] += round > 0 ? k_c * s[0] : 0;
        s[0] = (x + y - s[2]) / (1 + k_c);
    }
    s[1] = 2 * (s[0] - x) - y;
}

/* The matrix of a step: what it makes of each unit vector is a column. */
static void make_matrix(double W2, int n, double M[3][3])
{
    for (int column = 0; column < 3; column++) {
        double s[3] = { column == 0, column == 1, column == 2 };
        take_step(W2, n, s);
        for (int row = 0; row < 3; row++)
            M[row][column] = s[row];
    }
}

/* The factor of many steps, for each: M^(2^30) by squaring, its size taken out each time. */
static double growth(double W2, int n)
{
    double M[3][3], power = 1, logarithm = 0;

    make_matrix(W2, n, M);
    for (int squared = 0; squared < 30; squared++, power *= 2) {
        double P[3][3] = { { 0 } }, size = 0;
        for (int i = 0; i < 27; i++)
            P[i / 9][i % 3] += M[i / 9][i / 3 % 3] * M[i / 3 % 3][i % 3];
        for (int i = 0; i < 9; i++)
            size = fmax(size, fabs(P[i / 3][i % 3]));
        for (int i = 0; i < 9; i++)
            M[i / 3][i % 3] = P[i / 3][i % 3] / size;
        logarithm += log(size) / (2 * power);
    }
    return exp(logarithm);
}

/* Whether the matrix is that of doc/beyond.md. */
static int check_matrix(double W2, int n)
{
    const double a = 1 / (1 + W2 / 2), B = pow(a, n), A = a * B;
    const double expected[3][3] = { { A, A, -A }, { 2 * A - 2, 2 * A - 1, -2 * A },
                                    { 1 - B, 1 - B, B } };
    double M[3][3];

    make_matrix(W2, n, M);
    for (int i = 0; i < 9; i++)
        if (!(fabs(M[i / 3][i % 3] - expected[i / 3][i % 3]) <= 1e-14)) {
            printf("wrong: row %d, column %d is %.15g, expected %.15g\n", i / 3, i % 3,
                   M[i / 3][i % 3], expected[i / 3][i % 3]);
            return 0;
        }
    return 1;
}

int main(void)
{
    static const int rounds[3] = { 1, 2, 5 };

    for (int r = 0; r < 3; r++)
        if (!check_matrix(0.3, rounds[r]) || !check_matrix(3, rounds[r]))
            return EXIT_FAILURE;
    puts("rounds  unstable below W2  largest factor of a step");
    for (int r = 0; r < 3; r++) {
        double low = 1e-3, high = 10, most = 0;
        while (high - low > 1e-6) {
            const double middle = (low + high) / 2;
            *(growth(middle, rounds[r]) > 1 ? &low : &high) = middle;
        }
        for (double W2 = 1e-3; W2 < low; W2 += 1e-3)
            most = fmax(most, growth(W2, rounds[r]));
        printf("%-7d %-18.2f %.2f\n", rounds[r], low, most);
    }
    return EXIT_SUCCESS;
}
