/* exp2.c - Experiment II: a plate with a circular hole under tension (section 4.3, Fig. 14-23,
 * Tables 4 and 5).
 *
 *   y=5 ____________        a = 1 m, quarter of a plate 10 m x 10 m, t = 0.2 m, tension s = 1 MPa
 *      |            |-> s   along x, E = 2900 GPa, nu = 0.3; symmetry: v = 0 on y = 0, u = 0 on
 *     o|            |-> s   x = 0
 *     o|_           |-> s   b5  s on x = 5, y = 5 free: the paper's plate, its size ours
 *        \          |-> s   k5  the tractions of (72) on x = 5 and y = 5: the infinite plate, so
 *         |_________|-> s       (72) is exact
 *         1 o  o    5       One large step, as in the paper.
 *
 * `exp2` writes tables and out/exp2/; `exp2 converge` prints the errors on three meshes for four
 * values of alpha, solved on two levels where there is beyond/. All else is the paper's way, by the
 * core alone; the rows of the last table that say so are by as many quadrilaterals with beyond/. */
#include "case.h"
#include "theory.h"

static const double S = 1e6, E = 2900e9, nu = 0.3, t = 0.2, PI = 3.14159265358979323846;

static const case_run run[] = { { "b5", 0, ", plate b5" }, { "k5", 0, "" },
                                { "k5", 1, ", with beyond/" } };

/* Stress along the circle around the hole through (x, y). */
static double hoop(const double stress[3], double x, double y)
{
    const double th = atan2(y, x), s = sin(th), c = cos(th);

    return stress[0] * s * s + stress[1] * c * c - 2 * stress[2] * s * c;
}

/* The value of (72) for u, v, sxx, syy, sxy or stt (hoop stress). */
static double theory(const char *quantity, double x, double y)
{
    double u[2], s[3];

    theory_plate_displacement(&(theory_plate){ S, E, nu }, x, y, u);
    theory_plate_stress(&(theory_plate){ S, E, nu }, x, y, s);
    return strcmp(quantity, "u") == 0 ? u[0] : strcmp(quantity, "v") == 0 ? u[1]
         : strcmp(quantity, "sxx") == 0 ? s[0] : strcmp(quantity, "syy") == 0 ? s[1]
         : strcmp(quantity, "sxy") == 0 ? s[2] : hoop(s, x, y);
}

/* Traction [N/m] of (72) on a side with the outward normal n. */
static void traction(double x, double y, const void *normal, double f[2])
{
    const double *n = normal;
    double s[3];

    theory_plate_stress(&(theory_plate){ S, E, nu }, x, y, s);
    f[0] = t * (s[0] * n[0] + s[2] * n[1]);
    f[1] = t * (s[2] * n[0] + s[1] * n[1]);
}

/* Point i, j of the mesh: ring line i of 17 k, ray j of 12 k (k = 2 is the experiment's). On the
 * axes the rings go from 1 to 1.5, 2 and 5 in zones of 7, 3 and 7 cells, each longer than the last
 * by a constant factor, and from circles at the hole to squares at the edge. */
static void place(double i, double j, const void *division, double xy[2])
{
    const double k = *(const int *)division, c = i / k, th = PI / 2 * j / (12 * k);
    const double r = c <= 7 ? pow(1.5, c / 7)
                   : c <= 10 ? 1.5 * pow(4.0 / 3, (c - 7) / 3) : 2 * pow(2.5, (c - 10) / 7);
    const double edge = 5 / fmax(cos(th), sin(th)), f = 1 + (r - 1) / 4 * (edge - 1);

    xy[0] = j == 12 * k ? 0 : f * cos(th);
    xy[1] = f * sin(th);
}

/* The quarter plate of 17 k x 12 k cells, solved in one step; variant k5 or b5. */
static void solve_plate(bbm_model *m, const char *variant, int cut, int k, double alpha)
{
    case_grid g = { .nx = 17 * k, .ny = 12 * k, .cut = cut, .map = place, .context = &k };
    static const double right[2] = { 1, 0 }, top[2] = { 0, 1 };
    const int row = g.nx + 1, exact = strcmp(variant, "k5") == 0;

    bbm_add_material(m, &(bbm_material){ E, nu, 0.01 / t, t }, NULL);
    case_add_grid(m, &g);
    for (int i = 0; i <= g.nx; i++) {
        bbm_fix_node(m, g.first + i, BBM_Y, 0, 0);
        bbm_fix_node(m, g.first + g.ny * row + i, BBM_X, 0, 0);
    }
    for (int j = 0; j < g.ny; j++) {
        const int a = g.first + j * row + g.nx, b = a + row;
        if (exact)
            bbm_add_varying_line_load(m, a, b, traction, j < g.ny / 2 ? right : top);
        else if (j < g.ny / 2)
            bbm_add_line_load(m, a, b, t * S, 0);
    }
    m->par.alpha = alpha;
    case_solve(m);
}

/* The computed value at a grid point; stt is the hoop stress there. */
static double computed(const bbm_model *m, const char *quantity, double x, double y)
{
    if (strcmp(quantity, "stt"))
        return case_at(m, quantity, x, y);
    const double stress[3] = { case_at(m, "sxx", x, y), case_at(m, "syy", x, y),
                               case_at(m, "sxy", x, y) };
    return hoop(stress, x, y);
}

/* --------------------------------------------------------------------------------------- tables */

static const case_place stress[] = { { "sxx", 0, 1 }, { "sxx", 0, 1.5 }, { "sxx", 0, 2 },
                                     { "sxx", 0, 5 }, { "sxx", 5, 0 } };
static const case_place moved[] = { { "v", 0, 1 }, { "u", 1, 0 }, { "u", 5, 0 }, { "u", 5, 5 },
                                    { "v", 5, 5 }, { "v", 0, 5 } };
static const case_table table[] = {
    { "Table 4", "stress sxx [MPa]", 1e-6, LENGTH(stress), stress },
    { "Table 5", "displacements [1e-6 m]", 1e6, LENGTH(moved), moved },
};

/* For plate k5 (72) is exact. */
static const case_point point[] = {
    { 1, "u", 1, 0, 1e6 }, { 1, "v", 0, 1, 1e6 }, { 1, "u", 5, 0, 1e6 },
    { 1, "sxx", 0, 1, 1e-6 }, { 1, "sxx", 0, 2, 1e-6 },
    { 2, "u", 1, 0, 1e6 }, { 2, "v", 0, 1, 1e6 }, { 2, "u", 5, 0, 1e6 },
    { 2, "sxx", 0, 1, 1e-6 }, { 2, "sxx", 0, 2, 1e-6 },
};

/* --------------------------------------------------------------------------------------- curves */

/* A quantity at the grid points of a line, given by the first node, a step of node numbers and
 * their count, against (72) and six-node triangles on the same mesh. The abscissa is x, y or the
 * angle in degrees. */
typedef struct {
    const char *file, *title, *quantity, *abscissa;
    int first, step, count;
} line_of;

/* A chart, and rows of results.csv. */
static void draw_line(case_results *r, const bbm_model *const m[], const line_of *l)
{
    double at[128], value[2][128], exact[128], fem[128];
    char name[32], variant[16];
    case_reference ref;

    snprintf(variant, sizeof variant, "b5.%s", l->abscissa);
    case_read("exp2", variant, &ref);
    for (int i = 0; i < l->count; i++) {
        const bbm_node *n = &m[0]->node[l->first + i * l->step];
        at[i] = l->abscissa[0] == 'x' ? n->x : l->abscissa[0] == 'y' ? n->y
              : atan2(n->y, n->x) * 180 / PI;
        exact[i] = theory(l->quantity, n->x, n->y);
        fem[i] = case_find(&ref, l->quantity, n->x, n->y)->six_node;
        for (int k = 0; k < 2; k++) {
            value[k][i] = computed(m[k], l->quantity, n->x, n->y);
            snprintf(name, sizeof name, "%s.%s", run[k].variant, l->quantity);
            case_row(r, name, (double[]){ n->x, n->y }, value[k][i], exact[i], "theory");
        }
    }
    const plot_series s[] = {
        { "theory (72), infinite plate", l->count, at, exact, PLOT_LINE, 1 },
        { "BBM, its tractions (k5)", l->count, at, value[1], PLOT_MARKS, 4 },
        { "BBM, uniform stress (b5)", l->count, at, value[0], PLOT_MARKS, 2 },
        { "FEM, six-node triangles (b5)", l->count, at, fem, PLOT_LINE, 3 },
    };
    case_draw(r, plot_write_chart(case_path(r, l->file), &(plot_chart){
        .title = l->title, .count = LENGTH(s), .series = s,
        .x = { l->abscissa, l->abscissa[0] == 'a' ? "degrees" : "m" },
        .y = { l->quantity[1] == 't' ? "hoop stress" : l->quantity,
               l->quantity[0] == 's' ? "Pa" : "m" } }));
}

/* Fig. 15-19. */
static void show(case_results *r, const bbm_model *const m[], const case_reference unused[])
{
    enum { NX = 2 * 17, NY = 2 * 12, ROW = NX + 1 };
    const line_of line[] = {
        { "fig15.svg", "Fig. 15: displacement u on y = 0", "u", "x", 0, 1, ROW },
        { "fig15v.svg", "Fig. 15: displacement v on y = 0", "v", "x", 0, 1, ROW },
        { "fig16.svg", "Fig. 16: displacement v on x = 0", "v", "y", NY * ROW, 1, ROW },
        { "fig16u.svg", "Fig. 16: displacement u on x = 0", "u", "y", NY * ROW, 1, ROW },
        { "fig17.svg", "Fig. 17: stress sxx on y = 0", "sxx", "x", 0, 1, ROW },
        { "fig18.svg", "Fig. 18: stress sxx on x = 0", "sxx", "y", NY * ROW, 1, ROW },
        { "fig19.svg", "Fig. 19: stress sxx on the hole", "sxx", "angle", 0, ROW, NY + 1 },
        { "fig19hoop.svg", "Hoop stress on the hole", "stt", "angle", 0, ROW, NY + 1 },
    };

    (void)unused;
    for (int i = 0; i < LENGTH(line); i++)
        draw_line(r, m, &line[i]);
}

/* Fig. 20-23. */
static const case_map map[] = {
    { "fig20.svg", { .title = "Fig. 20: stress sxx, plate b5", .field = "sxx", .scale = -1 } },
    { "fig21a.svg", { .title = "Fig. 21: stress syy, plate b5", .field = "syy", .scale = -1 } },
    { "fig21b.svg", { .title = "Fig. 21: stress sxy, plate b5", .field = "sxy", .scale = -1 } },
    { "fig22.svg", { .title = "Fig. 22: displacement u, plate b5", .field = "u", .scale = -1 } },
    { "fig23.svg", { .title = "Fig. 23: displacement v, plate b5", .field = "v", .scale = -1 } },
};

int main(int argc, char **argv)
{
    return case_main(&(case_experiment){
        .name = "exp2", .title = "Experiment II: plate with a hole", .solve = solve_plate,
        .computed = computed, .theory = theory, .runs = LENGTH(run), .run = run,
        .tables = LENGTH(table), .table = table, .show = show,
        .summary = "Experiment II, plate k5 [1e-6 m, MPa]", .points = LENGTH(point),
        .point = point, .maps = LENGTH(map), .map = map,
        .error = { { "u", 1, 0 }, { "sxx", 0, 1 } },
        .errors = "Experiment II, plate k5, the paper's way: error of u(1,0), of sxx(0,1) "
                  "against theory (72)" }, argc, argv);
}
