/* bench.c - `make bench`: how long an iteration of the linear solver takes, in the paper's textbook form and in
 * Eisenstat's, and what that means for a solve. The two are timed in turn in one run; what is printed are medians and
 * their ratio, since these survive a busy machine. */
#include <stdlib.h>
#include <time.h>

#include "../cases/case.h"

enum { TURNS = 9, ITERATIONS = 100 };

static void place(double i, double j, const void *unused, double xy[2])
{
    (void)unused;
    xy[0] = i;
    xy[1] = j;
}

/* A cantilever of nx x ny crossed cells with its K and F assembled. */
static bbm_model *beam(int nx, int ny)
{
    bbm_model *m = case_model();
    case_grid g = { .nx = nx, .ny = ny, .cut = CASE_CROSSED, .map = place };

    bbm_add_material(m, &(bbm_material){ 30e6, 0.3, 1, 1 }, NULL);
    case_add_grid(m, &g);
    for (int j = 0; j <= ny; j++)
        bbm_fix_node(m, j * (nx + 1), BBM_XY, 0, 0);
    bbm_add_load(m, nx + ny / 2 * (nx + 1), 0, -1000);
    m->par.pcg.iterations = 1;
    case_must(m, bbm_prepare(m));
    (void)bbm_step(m);              /* leaves K and F; one iteration is not meant to converge */
    return m;
}

/* Seconds of a solve that is cut short after some iterations. */
static double solve_time(bbm_model *m, bbm_pcg_form form, int iterations)
{
    bbm_pcg pcg = { .omega = 1, .tolerance = 1e-300, .iterations = iterations, .form = form };
    bbm_pcg_info info;
    const clock_t start = clock();

    (void)bbm_solve(m->K, m->F, m->D, &pcg, &info);
    return (double)(clock() - start) / CLOCKS_PER_SEC;
}

/* Seconds of one iteration: what further iterations add to a solve of one, so that setting up does not count. */
static double iteration_time(bbm_model *m, bbm_pcg_form form)
{
    const double one = solve_time(m, form, 1);

    return (solve_time(m, form, 1 + ITERATIONS) - one) / ITERATIONS;
}

/* Iterations of a whole solve. */
static int iterations(bbm_model *m, bbm_pcg_form form)
{
    bbm_pcg pcg = { .omega = 1, .tolerance = 1e-10, .iterations = 100000, .form = form };
    bbm_pcg_info info;

    case_must(NULL, bbm_solve(m->K, m->F, m->D, &pcg, &info));
    return info.iterations;
}

static int ascending(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;

    return (x > y) - (x < y);
}

static double median(double v[TURNS])
{
    qsort(v, TURNS, sizeof *v, ascending);
    return v[TURNS / 2];
}

int main(void)
{
    printf("SSOR-PCG, omega = 1, alpha = 100: microseconds an iteration, medians of %d turns\n\n"
           "| unknowns | textbook | Eisenstat | ratio | iterations to 1e-10, textbook | Eisenstat |\n"
           "|---|---|---|---|---|---|\n", TURNS);
    for (int n = 1; n <= 4; n *= 2) {
        bbm_model *m = beam(24 * n, 6 * n);
        double textbook[TURNS], eisenstat[TURNS], ratio[TURNS];
        for (int i = 0; i < TURNS; i++) {
            textbook[i] = 1e6 * iteration_time(m, BBM_TEXTBOOK);
            eisenstat[i] = 1e6 * iteration_time(m, BBM_EISENSTAT);
            ratio[i] = eisenstat[i] / textbook[i];
        }
        printf("| %d | %.1f | %.1f | %.2f | %d | %d |\n", 6 * m->elements, median(textbook), median(eisenstat),
               median(ratio), iterations(m, BBM_TEXTBOOK), iterations(m, BBM_EISENSTAT));
        fflush(stdout);
        bbm_model_free(m);
    }
    return 0;
}
