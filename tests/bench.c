/* bench.c - `make bench`: how long the linear solver takes, what contact costs, and finding the
 * contacts. First solutions by the paper's SSOR-PCG and on two levels, then triangles and
 * quadrilaterals up to sizes that take seconds, beside CHOLMOD if it is there; then steps of walls,
 * of jointed rock, of a tunnel in it and of blocks that slide, with friction in K and as a load;
 * then how the time to find the contacts grows with the model. What is compared is timed in turn in
 * one run; printed are medians and their ratio, since these survive a busy machine. Solutions and
 * iterations are as many on every machine.
 *
 * With BENCH_LARGE in the environment CHOLMOD solves the largest model, too. `make bench` gives
 * CHOLMOD one thread. With more its BLAS waits for work in a loop while ours runs, and the clock
 * counts the time of all threads.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#ifdef CHOLMOD
#include <suitesparse/cholmod.h>
#endif

#include "../beyond/beyond.h"
#include "../cases/case.h"
#include "rock.h"

enum { TURNS = 9 };

static void place(double i, double j, const void *unused, double xy[2])
{
    (void)unused;
    xy[0] = i;
    xy[1] = j;
}

/* A cantilever of nx x ny cells with its K and F assembled. */
static bbm_model *beam(int nx, int ny, int cut, double alpha)
{
    bbm_model *m = case_beyond_model(0, 1);
    case_grid g = { .nx = nx, .ny = ny, .cut = cut, .map = place };

    bbm_add_material(m, &(bbm_material){ 30e6, 0.3, 1, 1 }, NULL);
    case_add_grid(m, &g);
    for (int j = 0; j <= ny; j++)
        bbm_fix_node(m, j * (nx + 1), BBM_XY, 0, 0);
    bbm_add_load(m, nx + ny / 2 * (nx + 1), 0, -1000);
    m->par.alpha = alpha;
    m->par.pcg.iterations = 1;
    case_must(m, bbm_prepare(m));
    (void)bbm_step(m);              /* leaves K and F; one iteration is not meant to converge */
    return m;
}

/* Adds nothing to K, so that the next solution has to make everything of it anew. */
static void touch(bbm_matrix *K)
{
    double zero[6][6] = { { 0 } };

    case_must(NULL, bbm_matrix_add(K, 0, 0, zero));
}

static int ascending(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;

    return (x > y) - (x < y);
}

static double median(double v[], int turns)
{
    qsort(v, (size_t)turns, sizeof *v, ascending);
    return v[turns / 2];
}

/* A wall of n x n bricks in running bond. */
static void add_wall(bbm_model *m, int n)
{
    for (int row = 0; row < n; row++)
        for (int i = 0; i < n; i++) {
            const double x = i + row % 2 / 2.0;
            case_add_grid(m, &(case_grid){ .block = row * n + i, .nx = 1, .ny = 1, .x = x, .y = row,
                                           .w = 1, .h = 1 });
        }
}

/* A subdivided block on a subdivided plate: straight sides of n and 2 n edges in contact. */
static void add_long_sides(bbm_model *m, int n)
{
    case_add_grid(m, &(case_grid){ .block = 0, .nx = 2 * n, .ny = 1, .x = -0.5, .y = -1, .w = 2 * n,
                                   .h = 1 });
    case_add_grid(m, &(case_grid){ .block = 1, .nx = n, .ny = 1, .x = 0, .y = 0, .w = n, .h = 1 });
}

/* A model whose contacts have been found once and are closed, as in the middle of a run; they have
 * a cohesion, so that the length of each joint is looked up, too. */
static bbm_model *model_in_contact(void add(bbm_model *, int), int n)
{
    bbm_model *m = case_beyond_model(0, 1);

    bbm_add_material(m, &(bbm_material){ 1e10, 0.25, 2500, 1 }, NULL);
    add(m, n);
    m->beyond->cohesion = 1e5;
    case_must(m, bbm_prepare(m));
    m->h = 0.01;
    bbm_foresee_step(m);
    case_must(m, bbm_detect_contacts(m, &(int){ 0 }));
    bbm_store_contacts(m);
    for (int k = 0; k < m->contacts; k++)
        m->contact[k].state = BBM_LOCK;
    return m;
}

/* Nanoseconds to find the contacts, for each boundary edge. */
static double detection_time(bbm_model *m)
{
    const int times = 100000 / m->edges + 1;
    const clock_t start = clock();

    for (int i = 0; i < times; i++) {
        bbm_foresee_step(m);                                      /* or the list would be known */
        case_must(m, bbm_detect_contacts(m, &(int){ 0 }));
    }
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
        printf("| %s | %d | %d | %.1f | %.0f | %.2f |\n", name, m[i]->edges, m[i]->scratch->contacts,
               (double)m[i]->info.candidates / m[i]->edges, median(time[i], TURNS), median(ratio[i], TURNS));
        bbm_model_free(m[i]);
    }
}

/* Milliseconds of a whole solution, all that it makes of K included: the median of some turns. */
static double whole_time(bbm_model *m, const bbm_method *method, int turns, int *count)
{
    bbm_pcg pcg = { .omega = 1, .tolerance = 1e-10, .iterations = 100000, .method = method };
    bbm_pcg_info info;
    double t[TURNS];

    for (int i = 0; i < turns; i++) {
        touch(m->K);
        const clock_t start = clock();
        case_must(NULL, bbm_solve(m->K, m->F, m->D, &pcg, &info));
        t[i] = 1e3 * (double)(clock() - start) / CLOCKS_PER_SEC;
    }
    *count = info.iterations;
    return median(t, turns);
}

/* The paper's SSOR-PCG against two levels, and how both grow with the number of unknowns. */
static void print_levels(void)
{
    static const int rows[] = { 6, 17, 34 };

    printf("\nSolutions to 1e-10, SSOR-PCG against two levels; growth is the power of the number of unknowns by which a\n"
           "time grows from the line above\n\n"
           "| unknowns | alpha | SSOR: iterations | us each | ms | growth | two levels: iterations | ms | growth | ratio |\n"
           "|---|---|---|---|---|---|---|---|---|---|\n");
    for (double alpha = 10; alpha <= 1000; alpha *= 10) {
        double last[3] = { 0 };
        for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
            bbm_model *m = beam(4 * rows[k], rows[k], CELL_ALTERNATING, alpha);
            const int turns = k < 1 ? TURNS : 3, n = 6 * m->elements;
            int one, two;
            const double t1 = whole_time(m, NULL, turns, &one), t2 = whole_time(m, &bbm_two_level, TURNS, &two);
            const double by = log(n / last[0]);
            printf(k ? "| %d | %g | %d | %.1f | %.1f | %.2f |" : "| %d | %g | %d | %.1f | %.1f | |", n, alpha, one,
                   1e3 * t1 / one, t1, log(t1 / last[1]) / by);
            printf(k ? " %d | %.1f | %.2f |" : " %d | %.1f | |", two, t2, log(t2 / last[2]) / by);
            printf(" %.1f |\n", t1 / t2);
            fflush(stdout);
            last[0] = n, last[1] = t1, last[2] = t2;
            bbm_model_free(m);
        }
    }
}

/* --------------------------------------------------------------------------- what grows with size */

/* Kilobytes of memory that the program has in hand, where the system tells. */
static double resident(void)
{
    FILE *f = fopen("/proc/self/status", "r");
    char line[128];
    double kB = NAN;

    while (f && fgets(line, sizeof line, f))
        (void)sscanf(line, "VmRSS: %lf", &kB);
    if (f)
        fclose(f);
    return kB;
}

/* Milliseconds to lay out K and the coarse space anew, to prepare both, and to solve. */
static double anew_time(bbm_model *m, int *iterations)
{
    const bbm_pcg pcg = { .omega = 1, .tolerance = 1e-10, .iterations = 100000,
                          .method = &bbm_two_level };
    bbm_matrix *old = m->K;
    bbm_pcg_info info;

    m->K = NULL;
    clock_t start = clock();
    case_must(m, bbm_lay_out_matrix(m));
    const clock_t pattern = clock() - start;
    memcpy(m->K->D, old->D, (size_t)old->n * sizeof *old->D);
    memcpy(m->K->L, old->L, (size_t)old->first[old->n] * sizeof *old->L);
    bbm_matrix_free(old);
    start = clock();
    case_must(m, bbm_lay_out_coarse(m));
    bbm_interpolate_elements(m);
    case_must(m, bbm_solve(m->K, m->F, m->D, &pcg, &info));
    *iterations = info.iterations;
    return 1e3 * (double)(clock() - start + pattern) / CLOCKS_PER_SEC;
}

#ifdef CHOLMOD

/* Column 6 i + a of the upper triangle of K, in the order of its rows, is row a of L_i and of D_i
 * up to the diagonal. */
static cholmod_sparse *upper_triangle(const bbm_matrix *K, cholmod_common *c)
{
    const size_t n = 6 * (size_t)K->n, most = 36 * (size_t)(K->first[K->n] + K->n);
    cholmod_sparse *A = cholmod_allocate_sparse(n, n, most, 0, 1, 1, CHOLMOD_REAL, c);
    int *start = A->p, *row = A->i, count = 0;
    double *value = A->x;

    for (int j = 0; j < 6 * K->n; j++) {
        const int i = j / 6, a = j % 6;
        start[j] = count;
        for (int k = K->first[i]; k < K->first[i + 1]; k++)
            for (int b = 0; b < 6; b++, count++) {
                row[count] = 6 * (i - K->back[k]) + b;
                value[count] = K->L[k][a][b];
            }
        for (int b = 0; b <= a; b++, count++) {
            row[count] = 6 * i + b;
            value[count] = K->D[i][a][b];
        }
    }
    start[6 * K->n] = count;
    return A;
}

/* Milliseconds of CHOLMOD to analyse, factorize and solve, the order as it chooses; the largest
 * difference between its solution and that of two levels, against the largest of all. */
static double direct_time(const bbm_model *m, double *difference)
{
    const bbm_matrix *K = m->K;
    cholmod_common c;
    double most = 0;

    cholmod_start(&c);
    c.supernodal = CHOLMOD_SUPERNODAL;
    cholmod_sparse *A = upper_triangle(K, &c);
    cholmod_dense *b = cholmod_zeros(A->nrow, 1, CHOLMOD_REAL, &c);
    for (int k = 0; k < 6 * K->n; k++)
        ((double *)b->x)[k] = m->F[6 * K->caller[k / 6] + k % 6];
    const clock_t start = clock();
    cholmod_factor *L = cholmod_analyze(A, &c);
    cholmod_factorize(A, L, &c);
    cholmod_dense *x = cholmod_solve(CHOLMOD_A, L, b, &c);
    const double ms = 1e3 * (double)(clock() - start) / CLOCKS_PER_SEC;
    *difference = 0;
    for (int k = 0; x && k < 6 * K->n; k++) {
        const double D = m->D[6 * K->caller[k / 6] + k % 6];
        most = fmax(most, fabs(D));
        *difference = fmax(*difference, fabs(((double *)x->x)[k] - D));
    }
    *difference = x ? *difference / most : NAN;
    cholmod_free_dense(&x, &c);
    cholmod_free_dense(&b, &c);
    cholmod_free_factor(&L, &c);
    cholmod_free_sparse(&A, &c);
    cholmod_finish(&c);
    return ms;
}

#else

static double direct_time(const bbm_model *m, double *difference)
{
    (void)m;
    return *difference = NAN;
}

#endif

/* Large models on two levels, and by the direct solver. The memory is all that the program has since
 * the first of them; it is not known where an earlier model had more. */
static void print_sizes(void)
{
    static const struct { int cut, rows, turns; } size[] = {
        { CELL_ALTERNATING, 17, TURNS }, { CELL_ALTERNATING, 34, 5 }, { CELL_ALTERNATING, 68, 3 },
        { CELL_QUADS, 34, 5 }, { CELL_QUADS, 68, 3 }, { CELL_QUADS, 136, 1 },
        { CELL_ALTERNATING, 158, 1 },
    };
    const double start = resident();
    double last[2][2] = { { 0 } }, most = start;

    printf("\nSolutions to 1e-10 on two levels, alpha = 100, with the layout of K and all that is made of it; growth as\n"
           "above; in turn with CHOLMOD, supernodal, which analyses, factorizes and solves\n\n"
           "| elements | unknowns | iterations | ms | growth | kB an element | CHOLMOD: ms | ratio | difference |\n"
           "|---|---|---|---|---|---|---|---|---|\n");
    for (size_t k = 0; k < sizeof size / sizeof *size; k++) {
        bbm_model *m = beam(4 * size[k].rows, size[k].rows, size[k].cut, 100);
        const int turns = size[k].turns, direct = 6 * m->elements < 1000000 || getenv("BENCH_LARGE");
        double ours[TURNS], theirs[TURNS], now = 0, difference = NAN;
        int count = 0, quads = size[k].cut == CELL_QUADS;
        for (int i = 0; i < turns; i++) {
            ours[i] = anew_time(m, &count);
            now = i == 0 ? resident() : now;
            theirs[i] = direct ? direct_time(m, &difference) : NAN;
        }
        const double t = median(ours, turns), other = median(theirs, turns), n = 6.0 * m->elements;
        printf("| %s | %.0f | %d | %.1f | ", quads ? "quadrilaterals" : "triangles", n, count, t);
        printf(last[quads][0] > 0 ? "%.2f |" : "|", log(t / last[quads][1]) / log(n / last[quads][0]));
        printf(now > most ? " %.1f |" : " |", (now - start) / m->elements);
        printf(isnan(other) ? " | | |\n" : " %.1f | %.2f | %.0e |\n", other, other / t, difference);
        most = fmax(most, now);
        fflush(stdout);
        last[quads][0] = n, last[quads][1] = t;
        bbm_model_free(m);
    }
#ifndef CHOLMOD
    printf("\nThe columns of CHOLMOD need SuiteSparse where bench is built: apt-get install libsuitesparse-dev\n");
#endif
}

/* Courses of n bricks each on a fixed base, half as many as bricks. */
static void add_wall_at_rest(bbm_model *m, double n)
{
    int block = 1;

    m->par.p_n = m->par.p_s = 1e9;
    case_add_grid(m, &(case_grid){ .nx = 1, .ny = 1, .x = -1, .y = -1, .w = n + 2, .h = 1 });
    for (int row = 0; row < (int)n / 2; row++)
        for (double x = 0, w; x < n; x += w) {
            w = row % 2 && (x == 0 || x == n - 0.5) ? 0.5 : 1;
            case_add_grid(m, &(case_grid){ .block = block++, .nx = 1, .ny = 1, .x = x, .y = row / 2.0,
                                           .w = w, .h = 0.5 });
        }
}

/* Six courses of four blocks of nine elements, every fifth of them of one; kn in E. */
static void add_jointed_rock(bbm_model *m, double kn)
{
    m->par.p_n = m->par.p_s = kn * 1e10;
    case_add_grid(m, &(case_grid){ .nx = 1, .ny = 1, .x = -1, .y = -1, .w = 6, .h = 1 });
    for (int k = 0; k < 24; k++)
        case_add_grid(m, &(case_grid){ .block = 1 + k, .nx = k % 5 ? 3 : 1, .ny = k % 5 ? 3 : 1,
                                       .x = k % 4, .y = k / 4, .w = 1, .h = 1 });
}

/* A tunnel of 5 m x 4 m in rock of 20 m x 20 m with two joint sets, blocks of 2.5 m x 2 m with nx x
 * nx elements each, under 1 MPa: when it is dug blocks of the roof slide. */
static void add_tunnel(bbm_model *m, double nx)
{
    m->par.dt = 0.002;
    m->par.velocity_factor = 1;
    m->par.friction = 35;
    m->par.p_n = 5e11, m->par.p_s = 2e11;
    case_add_grid(m, &(case_grid){ .nx = 1, .ny = 1, .x = -10, .y = -11, .w = 20, .h = 1 });
    for (int row = 0, b = 1; row < 10; row++)
        for (double x = -10, w; x < 10; x += w, b++) {
            const int i = m->nodes, dug = row / 2 == 2 && fabs(x + 1.25 * (1 + row % 2)) < 2;
            w = row % 2 && (x == -10 || x == 8.75) ? 1.25 : 2.5;
            if (dug)
                continue;
            case_add_grid(m, &(case_grid){ .block = b, .nx = (int)nx, .ny = (int)nx, .x = x,
                                           .y = 2 * row - 10, .w = w, .h = 2 });
            for (int n = i; n < m->nodes; n++)
                if (fabs(m->node[n].x) == 10)
                    bbm_fix_node(m, n, BBM_X, 0, 0);
            for (int n = m->nodes - (int)nx; row == 9 && n < m->nodes; n++)
                bbm_add_line_load(m, n - 1, n, 0, -1e6);
        }
}

/* cases/models/exp3.model: Experiment III beyond the paper. */
static void add_slider(bbm_model *m, double stiffness)
{
    m->par.p_n = stiffness, m->par.p_s = stiffness / 2.5;
    m->par.pcg.tolerance = 1e-12;
    case_add_grid(m, &(case_grid){ .nx = 40, .ny = 4, .x = -10, .y = -1, .w = 20, .h = 2 });
    for (int n = 0; n < m->nodes; n++)
        bbm_fix_node(m, n, BBM_XY, 0, 0);
    const int first = case_add_grid(m, &(case_grid){ .block = 1, .nx = 4, .ny = 2, .x = -8, .y = 1,
                                                     .w = 4, .h = 1 });
    for (int e = first; e < m->elements; e++)
        m->element[e].V[0] = 1;
    for (int j = 0; j < 2; j++)
        bbm_add_line_load(m, m->nodes - 15 + 5 * j, m->nodes - 10 + 5 * j, 1e4, 0);
    m->par.velocity_factor = 1;
}

/* Steps of models at rest, or nearly so, after a few that bring them there. */
static void print_steps(void)
{
    static const struct { const char *name; void (*add)(bbm_model *, double); double size; } run[] = {
        { "wall", add_wall_at_rest, 10 }, { "wall", add_wall_at_rest, 20 },
        { "wall", add_wall_at_rest, 45 }, { "wall", add_wall_at_rest, 100 },
        { "jointed rock, kn = 0.5 E", add_jointed_rock, 0.5 }, { "5 E", add_jointed_rock, 5 },
        { "50 E", add_jointed_rock, 50 }, { "500 E", add_jointed_rock, 500 },
        { "tunnel", add_tunnel, 2 }, { "tunnel", add_tunnel, 7 }, { "exp3.model", add_slider, 5e11 },
    };
    double last[2] = { 0 };

    printf("\nSteps, medians of %d; of a solution the iterations in the mean; growth: the power of the number of elements\n\n"
           "| model | elements | solutions | iterations | ms | growth |\n|---|---|---|---|---|---|\n", TURNS);
    for (size_t k = 0; k < sizeof run / sizeof *run; k++) {
        bbm_model *m = case_beyond_model(0, 1);
        double t[TURNS], solutions = 0, iterations = 0;
        bbm_add_material(m, &(bbm_material){ 1e10, 0.25, 2500, 1 }, NULL);
        m->par.gravity[1] = -9.81;
        m->par.alpha = 1000;
        m->par.dt = 0.01;
        m->par.velocity_factor = 0;
        run[k].add(m, run[k].size);
        for (int n = 0; n < 4; n++)
            bbm_fix_node(m, n, BBM_XY, 0, 0);
        case_must(m, bbm_prepare(m));
        for (int i = -4; i < TURNS; i++) {
            const clock_t start = clock();
            case_must(m, bbm_step(m));
            t[i < 0 ? 0 : i] = 1e3 * (double)(clock() - start) / CLOCKS_PER_SEC;
            solutions += i < 0 ? 0 : m->info.passes;
            iterations += i < 0 ? 0 : m->info.iterations;
        }
        const double ms = median(t, TURNS);
        printf("| %s | %d | %.1f | %.1f | %.2f |", run[k].name, m->elements, solutions / TURNS,
               iterations / solutions, ms);
        printf(k > 0 && k < 4 ? " %.2f |\n" : " |\n", log(ms / last[1]) / log(m->elements / last[0]));
        fflush(stdout);
        last[0] = m->elements, last[1] = ms;
        bbm_model_free(m);
    }
}

/* --------------------------------------------------------------------------- what contact costs */

typedef struct { double solutions, ms; } effort;        /* of a step, in the mean */

static effort run_rock(const rock_scene *s, int friction_is_a_load)
{
    bbm_model *m = s->make();
    effort e = { 0 };

    case_must(m, m ? bbm_prepare(m) : BBM_NO_MEMORY);
    if (friction_is_a_load)
        m->hook->friction = NULL;
    const clock_t start = clock();
    for (int i = 0; i < s->steps; i++) {
        case_must(m, bbm_step(m));
        e.solutions += (double)m->info.passes / s->steps;
    }
    e.ms = 1e3 * (double)(clock() - start) / CLOCKS_PER_SEC / s->steps;
    bbm_model_free(m);
    return e;
}

static void print_contact(void)
{
    printf("\nFriction in K, and as the paper has it, a load with the N of the last solution until\n"
           "both agree: means of all steps; ratio: of the times\n\n"
           "| scene | steps | in K: solutions a step | ms | load: solutions a step | ms | ratio |\n"
           "|---|---|---|---|---|---|---|\n");
    for (int k = 0; k < ROCK_SCENES; k++) {
        const effort in_K = run_rock(&rock[k], 0), load = run_rock(&rock[k], 1);
        printf("| %s | %d | %.2f | %.3f | %.2f | %.3f | %.1f |\n", rock[k].name, rock[k].steps,
               in_K.solutions, in_K.ms, load.solutions, load.ms, load.ms / in_K.ms);
        fflush(stdout);
    }
}

int main(void)
{
    print_levels();
    print_sizes();
    print_steps();
    print_contact();
    printf("\nDetection of contacts: edges that a corner is compared with, nanoseconds a boundary\n"
           "edge, and that against the smallest model\n\n"
           "| model | edges | contacts | compared | ns an edge | ratio |\n"
           "|---|---|---|---|---|---|\n");
    bench_detection("wall of bricks", add_wall, (const int[]){ 16, 50, 158 });
    bench_detection("two long sides", add_long_sides, (const int[]){ 166, 1666, 16666 });
    return 0;
}
