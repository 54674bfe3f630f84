/* newmark.c - Exercise 5.3: Newmark's method with any beta and gamma, for one mass on one spring.
 *
 * x is the displacement, y = V dt and z = a dt^2 are velocity and acceleration in its unit, and
 * W2 = k dt^2/m. The paper has beta = 1/2, gamma = 1, Eq. (13), (14).
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* One step of
 *     x' = x + y + (1/2 - beta) z + beta z'
 *     y' = y + (1 - gamma) z + gamma z'
 *     z' = -W2 x'
 * from s = (x, y, z) to s = (x', y', z'). */
static void take_step(double beta, double gamma, double W2, double s[3])
{
    const double x = s[0], y = s[1], z = s[2];

    s[0] = (x + y + (0.5 - beta) * z) / (1 + beta * W2);
    s[2] = -W2 * s[0];
    s[1] = y + (1 - gamma) * z + gamma * s[2];
}

static int failed;

/* 1000 steps may lose 1000 roundings of the largest number, which is below 100. */
static void compare(const char *what, double got, double expected)
{
    if (failed || fabs(got - expected) <= 1e-11)
        return;
    printf("wrong: %s is %.15g, expected %.15g\n", what, got, expected);
    failed = 1;
}

/* Three rules that are known in another form: the paper's matrix, doc/05-loads.md; the
 * trapezoidal rule, which keeps the energy; central differences. */
static void check_rules(double W2)
{
    double paper[3] = { 1, 0.5, -W2 }, mean[3] = { 1, 0.5, -W2 }, central[3] = { 1, 0, -W2 };
    double x = 1, y = 0.5, last = 1, now = 1 - W2 / 2;

    for (int n = 0; n < 1000; n++) {
        const double X = (2 * x + 2 * y) / (2 + W2);
        y = (-2 * W2 * x + (2 - W2) * y) / (2 + W2);
        x = X;
        take_step(0.5, 1, W2, paper);
        compare("the paper's x", paper[0], x);
        compare("the paper's V dt", paper[1], y);
        take_step(0.25, 0.5, W2, mean);
        compare("the energy at beta = 1/4, gamma = 1/2", W2 * mean[0] * mean[0] + mean[1] * mean[1],
                W2 + 0.25);
        take_step(0, 0.5, W2, central);
        compare("x by central differences", central[0], now);
        const double next = 2 * now - last - W2 * now;
        last = now;
        now = next;
    }
}

/* The largest |x| of a hundred steps, after 200 others. */
static double amplitude(double beta, double gamma, double W)
{
    double s[3] = { 1, 0, -W * W }, most = 0;

    for (int n = 0; n < 300; n++) {
        take_step(beta, gamma, W * W, s);
        most = n < 200 ? 0 : fmax(most, fabs(s[0]));
    }
    return most;
}

int main(void)
{
    static const double rule[4][2] = { { 0.5, 1 }, { 0.25, 0.5 }, { 0, 0.5 }, { 0.3025, 0.6 } };
    static const double W[4] = { 0.03, 0.3, 1.9, 2.1 };

    check_rules(0.09);
    if (failed)
        return EXIT_FAILURE;
    puts("amplitude after 200 steps\nbeta    gamma  W = 0.03     0.3          1.9          2.1");
    for (int r = 0; r < 4; r++) {
        printf("%-7g %-6g", rule[r][0], rule[r][1]);
        for (int w = 0; w < 4; w++)
            printf(" %-*.4g", w < 3 ? 12 : 0, amplitude(rule[r][0], rule[r][1], W[w]));
        putchar('\n');
    }
    return EXIT_SUCCESS;
}
