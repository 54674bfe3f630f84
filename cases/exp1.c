/* exp1.c - Experiment I: a cantilever under a load at its free end (section 4.2, Fig. 9-13,
 * Tables 2 and 3).
 *
 *     y ^                         L = 48 m, H = 12 m, t = 1 m, E = 30 MPa, nu = 0.3, P = 1 kN
 *   6 |_______________
 *   //|               | |         a   clamped, concentrated load at (48, 0): the paper's experiment
 *   //|---------------| v P   > x b   clamped, the same load as parabolic shear over the end
 *  -6 |_______________|           c   parabolic shear, and on x = 0 the displacements of (70):
 *     0               48              (70) is then exact
 *
 * `exp1` writes tables and out/exp1/; `exp1 converge` prints the errors on three meshes for four
 * values of alpha, solved on two levels where there is beyond/. All else is the paper's way, by the
 * core alone; the rows of the last table that say so are by as many quadrilaterals with beyond/. */

#include "case.h"
#include "theory.h"

static const double L = 48, H = 12, P = 1000, E = 30e6, nu = 0.3, I = 144;

static const case_run run[] = {
    { "a", 0, ", load a" }, { "b", 0, ", load b" }, { "c", 0, ", load c" },
    { "b", 1, ", load b, with beyond/" },
};

/* Eq. (70): u, v, and at the faces the von Mises stress; else NaN. */
static double theory(const char *quantity, double x, double y)
{
    double u[2];

    theory_beam_displacement(&(theory_beam){ P, L, H, E, nu }, x, y, u);
    return quantity[0] == 'u' ? u[0] : quantity[0] == 'v' ? u[1]
         : quantity[0] == 'm' ? P * (L - x) * fabs(y) / I : NAN;
}

/* Parabolic shear that sums to P, a field for the line loads [N/m]. */
static void shear(double x, double y, const void *unused, double f[2])
{
    (void)x, (void)unused;
    f[0] = 0;
    f[1] = -P / (2 * I) * (H * H / 4 - y * y);
}

/* Grid line i, j of the mesh: 25 x 6 cells, each divided k x k times (k = 2 is the experiment's).
 * Along x three zones of 12, 9 and 4 cells, 1.5, 2 and 3 m long, shorter where the bending moment
 * is larger; along y a little thinner at the faces. Every point that the tables name is a grid
 * point. */
static void place(double i, double j, const void *division, double xy[2])
{
    const double k = *(const int *)division, c = i / k, t = j / (3 * k) - 1;

    xy[0] = c <= 12 ? 1.5 * c : c <= 21 ? 18 + 2 * (c - 12) : 36 + 3 * (c - 21);
    xy[1] = H / 2 * t * (1 + 0.1 * (1 - t * t));
}

/* The beam on a grid whose first and last columns lie on x = 0 and x = L, held and loaded as the
 * variant says. */
static void add_beam(bbm_model *m, const char *variant, case_grid *g)
{
    const int row = g->nx + 1;

    bbm_add_material(m, &(bbm_material){ E, nu, 1, 1 }, NULL);
    case_add_grid(m, g);
    for (int j = 0; j <= g->ny; j++) {
        const int left = g->first + j * row;
        const double y = m->node[left].y, exact = *variant == 'c';
        bbm_fix_node(m, left, BBM_XY, exact * theory("u", 0, y), exact * theory("v", 0, y));
    }
    const int right = g->first + g->nx;
    if (*variant == 'a')
        bbm_add_load(m, right + g->ny / 2 * row, 0, -P);
    else
        for (int j = 0; j < g->ny; j++)
            bbm_add_varying_line_load(m, right + j * row, right + (j + 1) * row, shear, NULL);
}

/* The paper's load a is solved as in the paper, by Newton-Raphson steps until (71) holds; for b and
 * c one step gives the answer of small displacements, as their references do. */
static void solve(bbm_model *m, const char *variant, int cut, int k, double alpha)
{
    case_grid g = { .nx = 25 * k, .ny = 6 * k, .cut = cut, .map = place, .context = &k };

    add_beam(m, variant, &g);
    m->par.alpha = alpha;
    if (*variant == 'a')
        m->par.steps = 10, m->par.tolerance = 1e-8;
    case_solve(m);
}

/* Plain DDA: the beam is one block of six unknowns. */
static bbm_model *solve_dda(double alpha)
{
    static const double corner[6][2] = { { 0, -6 }, { 48, -6 }, { 48, 0 }, { 48, 6 }, { 0, 6 },
                                         { 0, 0 } };
    bbm_model *m = case_paper_model();

    bbm_add_material(m, &(bbm_material){ E, nu, 1, 1 }, NULL);
    for (int n = 0; n < 6; n++)
        bbm_add_node(m, corner[n][0], corner[n][1], NULL);
    bbm_add_element(m, 0, 0, 6, (int[]){ 0, 1, 2, 3, 4, 5 }, NULL);
    bbm_fix_node(m, 0, BBM_XY, 0, 0);
    bbm_fix_node(m, 4, BBM_XY, 0, 0);
    bbm_fix_node(m, 5, BBM_XY, 0, 0);
    bbm_add_load(m, 2, 0, -P);
    m->par.alpha = alpha;
    case_solve(m);
    return m;
}

/* --------------------------------------------------------------------------------------- tables */

/* Fig. 10 as a table and as a picture: the deflection of the axis. */
static void show_deflection(case_results *r, const bbm_model *dda, const bbm_model *bbm,
                            const case_reference *ref)
{
    enum { N = 9 };
    double x[N], v[4][N];

    printf("\nFig. 10 - deflection v [mm] of the axis, load a (concentrated)\n\n"
           "| x [m] | DDA | BBM | FEM | FEM, converged | theory (70) | BBM against FEM |\n"
           "|---|---|---|---|---|---|---|\n");
    for (int i = 0; i < N; i++) {
        double u[2];
        x[i] = 6 * i;
        const struct case_value *f = case_find(ref, "v", x[i], 0);
        bbm_displacement(&dda->element[0], dda->element[0].D, x[i], 0, u);
        v[0][i] = u[1];
        v[1][i] = case_at(bbm, "v", x[i], 0);
        v[2][i] = f->six_node;
        v[3][i] = theory("v", x[i], 0);
        if (i == 0)
            continue;
        printf("| %.0f | %.4f | %.4f | %.4f | ", x[i], 1e3 * v[0][i], 1e3 * v[1][i], 1e3 * v[2][i]);
        printf(isnan(f->converged) ? "no limit | " : "%.4f | ", 1e3 * f->converged);
        printf("%.4f | %+.2f %% |\n", 1e3 * v[3][i], case_percent(v[1][i], f->six_node));
    }
    const plot_series s[] = {
        { "theory, Eq. (70)", N, x, v[3], PLOT_LINE, 1 },
        { "FEM, six-node triangles", N, x, v[2], PLOT_MARKS, 3 },
        { "BBM", N, x, v[1], PLOT_MARKS, 2 },
        { "DDA, one block", N, x, v[0], PLOT_BOTH, 4 },
    };
    case_draw(r, plot_write_chart(case_path(r, "fig10.svg"), &(plot_chart){
        .title = "Fig. 10: deflection of the axis", .x = { "x", "m" },
        .y = { "v", "m" }, .count = LENGTH(s), .series = s }));
}

/* For each way to load and to hold the beam. */
static const case_place moved[] = { { "u", 24, 6 }, { "v", 24, 6 }, { "v", 36, 0 },
                                    { "u", 48, 6 }, { "v", 48, 6 } };
static const case_place bent[] = { { "mises", 12, 6 }, { "mises", 24, 6 } };
static const case_table table[] = {
    { "Table 3", "displacements [mm]", 1e3, LENGTH(moved), moved },
    { "Fig. 13", "von Mises stress [kPa]", 1e-3, LENGTH(bent), bent },
};

static const case_point point[] = {
    { 0, "v", 24, 0, 1e3 }, { 0, "v", 36, 0, 1e3 }, { 1, "v", 24, 0, 1e3 },
    { 1, "v", 48, 0, 1e3 }, { 2, "v", 24, 0, 1e3 }, { 2, "v", 48, 0, 1e3 },
    { 3, "v", 24, 0, 1e3 }, { 3, "v", 48, 0, 1e3 },
};

/* Fig. 11-13: contours, and the deformed mesh. */
static const case_map map[] = {
    { "fig11.svg", { .title = "Fig. 11: displacement u, load a", .field = "u", .scale = -1 } },
    { "fig12.svg", { .title = "Fig. 12: displacement v, load a", .field = "v", .scale = -1 } },
    { "fig13.svg", { .title = "Fig. 13: von Mises stress, load a",
                     .field = "mises", .scale = -1 } },
    { "deformed.svg", { .title = "Deformed beam, von Mises stress", .field = "mises" } },
};

/* ---------------------------------------------------------------------------- beyond the paper */

/* Bonds that multipliers hold, and quadrilaterals that bend. The error of the deflection of the
 * axis in x, in percent, against the converged finite element. */
static double deflection_error(const bbm_model *m, const case_reference *b, double x)
{
    return case_percent(case_at(m, "v", x, 0), case_find(b, "v", x, 0)->converged);
}

/* v(24,0) for three values of alpha: the paper's way, with one and two rounds of multipliers. */
static void print_augmented(const case_reference *b)
{
    printf("\nMultipliers: v(24,0), load b, against the converged finite element\n\n"
           "| alpha | the paper's way | with beyond/: one round | with beyond/: two rounds |\n"
           "|---|---|---|---|\n");
    for (double alpha = 10; alpha <= 1000; alpha *= 10) {
        printf("| %g |", alpha);
        for (int rounds = 0; rounds <= 2; rounds++) {
            bbm_model *m = rounds ? case_beyond_model(rounds, 1) : case_paper_model();
            solve(m, "b", CELL_CROSSED, 2, alpha);
            printf(" %+.4f %% |", deflection_error(m, b, 24));
            bbm_model_free(m);
        }
        printf("\n");
    }
}

/* The beam under load b on a uniform grid, with bonds that do not give. */
static bbm_model *solve_uniform(int nx, int ny, int cut, int moments)
{
    bbm_model *m = case_beyond_model(2, moments);
    case_grid g = { .nx = nx, .ny = ny, .cut = cut, .y = -H / 2, .w = L, .h = H };

    add_beam(m, "b", &g);
    case_solve(m);
    return m;
}

/* Quadrilaterals by their bond, beside triangles of as many unknowns. */
static void print_quadrilaterals(const case_reference *b)
{
    printf("\nQuadrilaterals by their bonds, load b, all with two rounds of multipliers: error of "
           "v(48,0), v(24,0)\n\n"
           "| unknowns | at vertices, as the paper has it | with moment | triangles |\n"
           "|---|---|---|---|\n");
    for (int n = 1; n <= 4; n *= 2) {
        printf("| %d |", 6 * 24 * 6 * n * n);
        for (int kind = 0; kind < 3; kind++) {
            bbm_model *m = kind < 2
                ? solve_uniform(24 * n, 6 * n, CELL_QUADS, kind)
                : solve_uniform(18 * n, 4 * n, CELL_ALTERNATING, 0);
            printf(" %+.3f %%, %+.3f %% |", deflection_error(m, b, 48), deflection_error(m, b, 24));
            bbm_model_free(m);
        }
        printf("\n");
    }
}

/* Table 2: a mesh of n triangles with B boundary edges and no hole has 1 + (n + B)/2 grid points
 * and (3 n + B)/2 edges, and a six-node triangle has a node at each. */
static void show(case_results *r, const bbm_model *const m[], const case_reference ref[])
{
    bbm_model *dda = solve_dda(1000);
    const int n = m[0]->elements;

    printf("\nTable 2 - unknowns; six-node triangles: in the paper, a node counted for each of its "
           "elements, and on this mesh\n\n"
           "| DDA, one block | BBM, %d triangles | FEM of the paper, 2202 triangles | FEM, %d |\n"
           "|---|---|---|---|\n| %d | %d | %d | %d |\n", n, n, 6 * dda->elements, 6 * n,
           2 * 6 * 2202, 2 * (1 + 2 * n + m[0]->edges));
    show_deflection(r, dda, m[0], &ref[0]);
    if (m[3]) {
        printf("\n## With beyond/\n");
        print_augmented(&ref[1]);
        print_quadrilaterals(&ref[1]);
    }
    bbm_model_free(dda);
}

int main(int argc, char **argv)
{
    return case_main(&(case_experiment){
        .name = "exp1", .title = "Experiment I: cantilever", .solve = solve,
        .computed = case_at, .theory = theory, .runs = LENGTH(run), .run = run,
        .tables = LENGTH(table), .table = table, .show = show,
        .summary = "Experiment I, deflection [mm]", .points = LENGTH(point), .point = point,
        .maps = LENGTH(map), .map = map, .error = { { "v", 24, 0 } },
        .errors = "Experiment I, load b, the paper's way: error of v(24,0) against the converged "
                  "finite element" }, argc, argv);
}
