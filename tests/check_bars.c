/* check_bars.c - bars of quadrilaterals in pure bending against the theory of beams, whatever
 * changes along the bar.
 *
 * A bar along x under the moment that the tractions 1000 y [N/m] make at its end, E t kappa =
 * 1000, has
 *     u = theta(x) y,   theta' = kappa,   v = -int theta dx - nu kappa y^2/2,
 *     sxx = E kappa y,   syy = sxy = 0.
 * Where E t changes along the bar so does kappa, and v is continuous only if nu kappa is one
 * constant: then this is the exact plane stress. The materials of the bars here have nu in
 * proportion to E t, or nu = 0; a bar of one row cannot feel the difference and follows the theory
 * of beams with any nu. Lengths of elements may change as they like; so may E from row to row, if
 * the rows lie symmetric about the axis.
 */
#include "../beyond/beyond.h"
#include "check.h"
#include "rock.h"

enum { COLUMNS = 6 };

typedef struct {                /* its columns are in turn of the first and of the second kind */
    const char *name;
    int rows;
    double height, w[2], E[2], t[2], nu;
    double turn;                /* of the whole bar, in rad */
    int layers;                 /* rows are of the first and second kind in place of columns */
    int plain;                  /* nu is that of all */
} bar;

static const bar bars[] = {
    { "equal, high", 1, 1, { .5, .5 }, { 1, 1 }, { 1, 1 }, 0.3, 0, 0, 0 },
    { "equal, square", 1, 1, { 1, 1 }, { 1, 1 }, { 1, 1 }, 0.3, 0, 0, 0 },
    { "equal, long, turned", 1, 1, { 3, 3 }, { 1, 1 }, { 1, 1 }, 0.3, 2.5, 0, 0 },
    { "two rows, high", 2, 1, { .5, .5 }, { 1, 1 }, { 1, 1 }, 0.3, 0, 0, 0 },
    { "two rows, long", 2, 1, { 2, 2 }, { 1, 1 }, { 1, 1 }, 0.3, 0, 0, 0 },
    { "three rows", 3, 1, { 1, 1 }, { 1, 1 }, { 1, 1 }, 0.3, 0.4, 0, 0 },
    { "four rows, high", 4, 1, { .7, .7 }, { 1, 1 }, { 1, 1 }, 0.3, 0, 0, 0 },
    { "four rows, long", 4, 1, { 3, 3 }, { 1, 1 }, { 1, 1 }, 0.3, 0, 0, 0 },
    { "lengths 1 : 3", 1, 1, { 1, 3 }, { 1, 1 }, { 1, 1 }, 0.3, 0, 0, 0 },
    { "lengths 1 : 9, turned", 1, 1, { 1, 9 }, { 1, 1 }, { 1, 1 }, 0.3, 0.5, 0, 0 },
    { "two rows, lengths 1 : 3, turned", 2, 1, { 1, 3 }, { 1, 1 }, { 1, 1 }, 0.3, 2, 0, 0 },
    { "three rows, lengths 1 : 9", 3, 1, { 1, 9 }, { 1, 1 }, { 1, 1 }, 0.3, 0, 0, 0 },
    { "four rows, lengths 9 : 1", 4, 1, { 9, 1 }, { 1, 1 }, { 1, 1 }, 0.3, 0, 0, 0 },
    { "moduli 1 : 1000", 1, 1, { 1, 1 }, { 1, 1000 }, { 1, 1 }, 0.3, 0, 0, 0 },
    { "moduli 1000 : 1, equal nu", 1, 1, { 1, 2 }, { 1000, 1 }, { 1, 1 }, 0.3, 0.7, 0, 1 },
    { "two rows, moduli 1 : 1000", 2, 1, { 1, 1 }, { 1, 1000 }, { 1, 1 }, 0.3, 0, 0, 0 },
    { "three rows, moduli 1000 : 1, turned", 3, 1, { 2, 1 }, { 1000, 1 }, { 1, 1 }, 0.3, 1, 0, 0 },
    { "four rows, moduli 1 : 1000, nu = 0", 4, 1, { 1, 1 }, { 1, 1000 }, { 1, 1 }, 0, 0, 0, 0 },
    { "thicknesses 1 : 5", 1, 1, { 1, 1 }, { 1, 1 }, { 1, 5 }, 0.3, 0, 0, 0 },
    { "four rows, thicknesses 5 : 1, turned", 4, 1, { 1, 2 }, { 1, 1 }, { 5, 1 }, 0.3, 3, 0, 0 },
    { "all three change", 2, 2, { 1, 9 }, { 1, 1000 }, { 3, 1 }, 0.3, 0.5, 0, 0 },
    { "three layers, lengths 1 : 3", 3, 1, { 1, 3 }, { 1, 1000 }, { 1, 1 }, 0.3, 0, 1, 0 },
    { "three layers, turned", 3, 1, { 2, 1 }, { 1000, 1 }, { 1, 1 }, 0.3, 0.5, 1, 0 },
};

/* Which of its two kinds an element of column i and row j is. */
static int kind(const bar *b, int i, int j) { return (b->layers ? j : i) % 2; }

static double stiffness(const bar *b, int k) { return 1e9 * b->E[k] * b->t[k]; }

static double curvature(const bar *b, int i) { return 1000 / stiffness(b, kind(b, i, 0)); }

/* The tractions of theory at the end, as seen from the bar turned back, the row's stiffness
 * against that of row 0. */
typedef struct { double cosine, sine, factor; } end_load;

static void tractions(double x, double y, const void *context, double f[2])
{
    const end_load *l = context;
    const double s = 1000 * l->factor * (-l->sine * x + l->cosine * y);

    f[0] = l->cosine * s;
    f[1] = l->sine * s;
}

/* x and -v of theory on the axis at each grid line. */
static void deflect(const bar *b, double x[COLUMNS + 1], double w[COLUMNS + 1])
{
    double angle = 0;

    x[0] = w[0] = 0;
    for (int i = 0; i < COLUMNS; i++) {
        const double dx = b->w[i % 2], kappa = curvature(b, i);
        x[i + 1] = x[i] + dx;
        w[i + 1] = w[i] + angle * dx + kappa * dx * dx / 2;
        angle += kappa * dx;
    }
}

static double nu_of(const bar *b, int k)
{
    const double most = fmax(stiffness(b, 0), stiffness(b, 1));

    return b->plain || b->layers ? b->nu : b->nu * stiffness(b, k) / most;
}

static bbm_model *make(const bar *b, const double x[COLUMNS + 1])
{
    const double c = cos(b->turn), s = sin(b->turn);
    const double lateral = nu_of(b, kind(b, 0, 0)) * curvature(b, 0) / 2;
    bbm_model *m = beyond_model();

    m->par.pcg.tolerance = 1e-14;
    m->par.pcg.iterations = 1000;       /* several times what is needed: an error ends at once */
    for (int k = 0; k < 2; k++)
        bbm_add_material(m, &(bbm_material){ 1e9 * b->E[k], nu_of(b, k), 1000, b->t[k] }, NULL);
    for (int j = 0; j <= b->rows; j++)
        for (int i = 0; i <= COLUMNS; i++) {
            const double y = b->height * (j - b->rows / 2.0), v = -lateral * y * y;
            bbm_add_node(m, c * x[i] - s * y, s * x[i] + c * y, NULL);
            if (i == 0)
                bbm_fix_node(m, m->nodes - 1, BBM_XY, -s * v, c * v);
        }
    for (int j = 0; j < b->rows; j++)
        for (int i = 0; i < COLUMNS; i++) {
            const int a = j * (COLUMNS + 1) + i, d = a + COLUMNS + 1;
            bbm_add_element(m, 0, kind(b, i, j), 4, (int[]){ a, a + 1, d + 1, d }, NULL);
        }
    for (int j = 0; j < b->rows; j++) {
        const int right = (j + 1) * (COLUMNS + 1) - 1, last = COLUMNS - 1;
        const double factor = stiffness(b, kind(b, last, j)) / stiffness(b, kind(b, last, 0));
        const end_load load = { c, s, factor };
        bbm_add_varying_line_load(m, right, right + COLUMNS + 1, tractions, &load);
    }
    return m;
}

/* The largest difference of the deflection from theory at a node, over the deflection at the end.
 */
static double bar_error(const bar *b, double alpha, int augment, bbm_bonding bonding)
{
    double x[COLUMNS + 1], w[COLUMNS + 1], worst = 0;

    deflect(b, x, w);
    bbm_model *m = make(b, x);
    m->par.alpha = alpha;
    m->beyond->multiplier_rounds = augment;
    m->beyond->bonding = bonding;
    ck_ok(bbm_prepare(m), m);
    ck_ok(bbm_run(m), m);
    for (int n = 0; n < m->nodes; n++) {
        const int i = n % (COLUMNS + 1), j = n / (COLUMNS + 1);
        const double y = b->height * (j - b->rows / 2.0);
        const double v = -w[i] - nu_of(b, kind(b, 0, 0)) * curvature(b, 0) * y * y / 2;
        bbm_result r;
        ck_assert_int_eq(bbm_nodal_result(m, n, -1, &r), BBM_OK);
        worst = fmax(worst, fabs(cos(b->turn) * r.v - sin(b->turn) * r.u - v) / w[COLUMNS]);
    }
    release(m);
    return worst;
}

START_TEST(bars_of_rectangles_bend_exactly)
{
    const bar *b = &bars[_i];
    const double springs = bar_error(b, 1e4, 0, BBM_MOMENT);
    const double multipliers = bar_error(b, 1000, 2, BBM_MOMENT);
    const double locked = bar_error(b, 1e4, 0, BBM_VERTICES);

    ck_assert_msg(springs < 1e-3, "%s: off by %g", b->name, springs);
    ck_assert_msg(multipliers < 1e-6, "%s: off by %g with multipliers", b->name, multipliers);
    ck_assert_msg(locked > 0.5, "%s: at vertices it should lock, is off by %g", b->name, locked);
}
END_TEST

/* A quadrilateral of any shape and the same turned by half a turn about the middle of one edge. */
static bbm_model *make_twins(const double ratio[2])
{
    const double xy[6][2] = { { 2, -1 },      { 2.4, 1.2 },  { 0.3, 1.7 },
                              { -0.2, -0.4 }, { 4.1, -1.5 }, { 4.6, 0.6 } };
    bbm_model *m = beyond_model();

    for (int k = 0; k < 2; k++)
        bbm_add_material(m, &(bbm_material){ 1e7 * ratio[k], 0.3, 1000, 0.5 }, NULL);
    for (int n = 0; n < 6; n++)
        bbm_add_node(m, xy[n][0], xy[n][1], NULL);
    bbm_add_element(m, 0, 0, 4, (int[]){ 0, 1, 2, 3 }, NULL);
    bbm_add_element(m, 0, 1, 4, (int[]){ 1, 0, 4, 5 }, NULL);
    for (int n = 2; n < 4; n++)
        bbm_fix_node(m, n, BBM_XY, 0, 0);
    ck_ok(bbm_prepare(m), m);
    ck_ok(bbm_run(m), m);
    return m;
}

/* Elements of one shape whose moduli are r and 1 - r: the harmonic mean of their moments is 2 r (1
 * - r) that of modulus 1. */
START_TEST(a_bond_of_two_elements_of_one_shape_has_the_moment_of_springs_in_series)
{
    const double r[] = { 0.5, 0.1, 0.75 }, ratio[2] = { r[_i], 1 - r[_i] };
    bbm_model *m = make_twins(ratio);
    bbm_element unit = m->element[0];
    double W[2][2][2];
    bbm_submatrices s = { .Fi = { 0 } };
    bbm_gap end[2];
    double own[2][2][2], K[6][6];

    ck_assert_int_eq(m->bonds, 1);
    const bbm_bond *b = &m->bond[0];
    bbm_vertex start[8];
    for (int v = 0; v < 8; v++) {
        const bbm_node *n = &m->node[m->vertex[v].node];
        start[v] = (bbm_vertex){ .x = n->x, .y = n->y };
    }
    for (int e = 0; e < 2; e++)
        bbm_element_geometry(&m->element[e], &start[4 * e]);
    unit.material.E = 1e7;
    bbm_bending_moments(&unit, start, own);
    const double k = bbm_bonding_stiffness(m->par.alpha, &m->element[0], &m->element[1]);
    for (int a = 0; a < 4; a++) {
        W[0][a / 2][a % 2] = a % 3 == 0 ? 2 * k : 0;
        W[1][a / 2][a % 2] = 2 * ratio[0] * ratio[1] * own[b->p[0] % 2][a / 2][a % 2];
    }
    for (int n = 0; n < 2; n++)
        bbm_bonding_gap(&m->element[b->i], &start[b->p[n]], &m->element[b->j], &start[b->q[n]], k,
                        &end[n]);
    for (int g = 0; g < 2; g++) {
        bbm_gap gap = { .i = b->i, .j = b->j };
        bbm_edge_gap(end, g == 0 ? 1 : -1, W[g], &gap);
        bbm_bonding_submatrices(&gap, &s);
    }
    get_block(m->K, b->i, b->j, K);
    for (int a = 0; a < 36; a++)        /* K of its middle is 100 times larger: 1e-13 of it */
        ck_near(K[a / 6][a % 6], s.Kij[a / 6][a % 6], W[1][0][0] + W[1][1][1], 1e-11);
}
END_TEST

Suite *bars_suite(void)
{
    Suite *s = suite_create("bars");

    add_case(s, "bars",
        { bars_of_rectangles_bend_exactly, COUNT(bars) },
        { a_bond_of_two_elements_of_one_shape_has_the_moment_of_springs_in_series, 3 });
    return s;
}
