/* bench.c - `make bench`: how long an iteration of the linear solver takes, in the paper's textbook form and in
 * Eisenstat's, and what that means for a solve; and how the time to find the contacts grows with the model. What is
 * compared is timed in turn in one run, and what is printed are medians and their ratio, since these survive a busy
 * machine. */
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

static void bench_solver(void)
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
}

/* A wall of n x n bricks in running bond. */
static void add_wall(bbm_model *m, int n)
{
    for (int row = 0; row < n; row++)
        for (int i = 0; i < n; i++) {
            const case_box b = { .block = row * n + i, .nx = 1, .ny = 1, .x = i + row % 2 / 2.0, .y = row, .w = 1, .h = 1 };
            case_add_box(m, &b);
        }
}

/* A subdivided block on a subdivided plate: straight sides of n and 2 n edges in contact. */
static void add_long_sides(bbm_model *m, int n)
{
    const case_box plate = { .block = 0, .nx = 2 * n, .ny = 1, .x = -0.5, .y = -1, .w = 2 * n, .h = 1 };
    const case_box block = { .block = 1, .nx = n, .ny = 1, .x = 0, .y = 0, .w = n, .h = 1 };

    case_add_box(m, &plate);
    case_add_box(m, &block);
}

/* A model whose contacts have been found once and are closed, as in the middle of a run; they have a cohesion, so that
 * the length of each joint is looked up, too. */
static bbm_model *model_in_contact(void add(bbm_model *, int), int n)
{
    bbm_model *m = case_model();

    bbm_add_material(m, &(bbm_material){ 1e10, 0.25, 2500, 1 }, NULL);
    add(m, n);
    m->par.cohesion = 1e5;
    case_must(m, bbm_prepare(m));
    m->h = 0.01;
    bbm_guess_step(m);
    case_must(m, bbm_detect_contacts(m));
    case_must(m, bbm_keep_contacts(m));
    for (int k = 0; k < m->contacts; k++)
        m->contact[k].state = BBM_LOCK;
    return m;
}

/* Nanoseconds to find the contacts, for each boundary edge. */
static double detection_time(bbm_model *m)
{
    const int times = 100000 / m->edges + 1;
    const clock_t start = clock();

    for (int i = 0; i < times; i++)
        case_must(m, bbm_detect_contacts(m));
    return 1e9 * (double)(clock() - start) / CLOCKS_PER_SEC / times / m->edges;
}

static void bench_detection(const char *name, void add(bbm_model *, int), const int size[3])
{
    bbm_model *m[3];
    double time[3][TURNS], ratio[3][TURNS];

    for (int i = 0; i < 3; i++)
        m[i] = model_in_contact(add, size[i]);
    for (int t = 0; t < TURNS; t++)
        for (int i = 0; i < 3; i++) {
            time[i][t] = detection_time(m[i]);
            ratio[i][t] = time[i][t] / time[0][t];
        }
    for (int i = 0; i < 3; i++) {
        printf("| %s | %d | %d | %.0f | %.2f |\n", name, m[i]->edges, bbm_contact_count(m[i]), median(time[i]),
               median(ratio[i]));
        bbm_model_free(m[i]);
    }
}

int main(void)
{
    bench_solver();
    printf("\nDetection of contacts: nanoseconds a boundary edge, and against the smallest model\n\n"
           "| model | edges | contacts | ns an edge | ratio |\n|---|---|---|---|---|\n");
    bench_detection("wall of bricks", add_wall, (const int[]){ 16, 50, 158 });
    bench_detection("two long sides", add_long_sides, (const int[]){ 166, 1666, 16666 });
    return 0;
}
