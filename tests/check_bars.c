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
#include "models.h"
#include "rock.h"

enum { BAR = 6 };              /* its columns */

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
static void deflect(const bar *b, double x[BAR + 1], double w[BAR + 1])
{
    double angle = 0;

    x[0] = w[0] = 0;
    for (int i = 0; i < BAR; i++) {
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

static bbm_model *make(const bar *b, const double x[BAR + 1])
{
    const double c = cos(b->turn), s = sin(b->turn);
    const double lateral = nu_of(b, kind(b, 0, 0)) * curvature(b, 0) / 2;
    bbm_model *m = beyond_model();

    m->par.pcg.tolerance = 1e-14;
    m->par.pcg.iterations = 1000;       /* several times what is needed: an error ends at once */
    for (int k = 0; k < 2; k++)
        bbm_add_material(m, &(bbm_material){ 1e9 * b->E[k], nu_of(b, k), 1000, b->t[k] }, NULL);
    for (int j = 0; j <= b->rows; j++)
        for (int i = 0; i <= BAR; i++) {
            const double y = b->height * (j - b->rows / 2.0), v = -lateral * y * y;
            bbm_add_node(m, c * x[i] - s * y, s * x[i] + c * y, NULL);
            if (i == 0)
                bbm_fix_node(m, m->nodes - 1, BBM_XY, -s * v, c * v);
        }
    for (int j = 0; j < b->rows; j++)
        for (int i = 0; i < BAR; i++) {
            const int a = j * (BAR + 1) + i, d = a + BAR + 1;
            bbm_add_element(m, 0, kind(b, i, j), 4, (int[]){ a, a + 1, d + 1, d }, NULL);
        }
    for (int j = 0; j < b->rows; j++) {
        const int right = (j + 1) * (BAR + 1) - 1, last = BAR - 1;
        const double factor = stiffness(b, kind(b, last, j)) / stiffness(b, kind(b, last, 0));
        const end_load load = { c, s, factor };
        bbm_add_varying_line_load(m, right, right + BAR + 1, tractions, &load);
    }
    return m;
}

/* The largest difference of the deflection from theory at a node, over the deflection at the end.
 */
static double bar_error(const bar *b, double alpha, int augment, bbm_bonding bonding)
{
    double x[BAR + 1], w[BAR + 1], worst = 0;

    deflect(b, x, w);
    bbm_model *m = make(b, x);
    m->par.alpha = alpha;
    m->beyond->multiplier_rounds = augment;
    m->beyond->bonding = bonding;
    ck_ok(bbm_prepare(m), m);
    ck_ok(bbm_run(m), m);
    for (int n = 0; n < m->nodes; n++) {
        const int i = n % (BAR + 1), j = n / (BAR + 1);
        const double y = b->height * (j - b->rows / 2.0);
        const double v = -w[i] - nu_of(b, kind(b, 0, 0)) * curvature(b, 0) * y * y / 2;
        bbm_result r;
        ck_assert_int_eq(bbm_nodal_result(m, n, -1, &r), BBM_OK);
        worst = fmax(worst, fabs(cos(b->turn) * r.v - sin(b->turn) * r.u - v) / w[BAR]);
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

/* A row of parallelograms, their sides slanted by `shift`, their vertices from any corner on. The
 * middle of each side sinks as the axis of a beam does. */
typedef struct { double shift, w[2], E[2]; int start; } slanted_bar;

static const slanted_bar slanted[] = {
    { 0.5, { 1, 1 }, { 1, 1 }, 0 },   { 1, { 1, 1 }, { 1, 1 }, 1 }, { 2, { 1, 1 }, { 1, 1 }, 2 },
    { -1, { 0.5, 0.5 }, { 1, 1 }, 3 }, { 1, { 1, 3 }, { 1, 1 }, 0 }, { -2, { 2, 1 }, { 1, 100 }, 1 },
};

START_TEST(rows_of_parallelograms_bend_as_beams)
{
    const slanted_bar *b = &slanted[_i];
    const bar straight = { "", 1, 1, { b->w[0], b->w[1] }, { b->E[0], b->E[1] }, { 1, 1 }, 0.3,
                           0, 0, 1 };
    double x[BAR + 1], w[BAR + 1];
    bbm_model *m = beyond_model();

    deflect(&straight, x, w);                   /* under the moment 1000/12 */
    m->beyond->multiplier_rounds = 3;
    m->par.pcg.tolerance = 1e-14;
    for (int k = 0; k < 2; k++)
        bbm_add_material(m, &(bbm_material){ 1e9 * b->E[k], 0.3, 1000, 1 }, NULL);
    for (int i = 0; i <= BAR; i++)
        for (int side = -1; side < 2; side += 2)
            bbm_add_node(m, x[i] + side * b->shift / 2, side / 2.0, NULL);
    for (int i = 0; i < BAR; i++) {
        const int a = 2 * i, ring[7] = { a, a + 2, a + 3, a + 1, a, a + 2, a + 3 };
        bbm_add_element(m, 0, i % 2, 4, &ring[b->start], NULL);
    }
    for (int side = 0; side < 2; side++) {
        bbm_fix_node(m, side, BBM_XY, 0, 0);
        bbm_add_load(m, 2 * BAR + side, (side ? 1000 : -1000) / 12.0, 0);
    }
    run(m);
    for (int i = 0; i <= BAR; i++) {
        const double v = (result_at(m, 2 * i).v + result_at(m, 2 * i + 1).v) / 2;
        ck_near(v, -w[i], w[BAR], 1e-6);        /* multipliers, see above */
    }
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

/* ------------------------------------------------------------------------------------- supports */

/* Round node 0, in turn, 3 to 8 quadrilaterals: kites from node 0 to one rim node after another, by
 * way of an outer one; or every second kite is two triangles. */
enum { FEWEST = 3, MOST = 8, STARS = MOST - FEWEST + 1 };

/* Bit 0: with triangles; 1: of two materials; 2: distorted. Held at two outer
 * nodes, loaded at all round node 0. */
static bbm_model *make_star(int n, int kind)
{
    bbm_model *m = beyond_model();
    unsigned seed = 39;

    m->par.pcg.tolerance = 1e-14;
    for (int k = 0; k < 2; k++)
        bbm_add_material(m, &(bbm_material){ k ? 1e9 : 1e10, 0.3, 1000, 1 }, NULL);
    bbm_add_node(m, 0, 0, NULL);
    for (int k = 0; k < 2 * n; k++) {
        const double shake = kind & 4 ? 0.1 : 0, r = (k % 2 ? 1.6 : 1) + shake * random_number(&seed);
        const double at = PI / n * (k + shake * random_number(&seed));
        bbm_add_node(m, r * cos(at), r * sin(at), NULL);
        bbm_add_load(m, m->nodes - 1, 1e6 * random_number(&seed), 1e6 * random_number(&seed));
    }
    for (int k = 0; k < n; k++) {
        const int rim = 1 + 2 * k, next = 1 + 2 * ((k + 1) % n), of = kind & 2 ? k % 2 : 0;
        if (kind & 1 && k % 2) {
            bbm_add_element(m, 0, of, 3, (int[]){ 0, rim, next }, NULL);
            bbm_add_element(m, 0, of, 3, (int[]){ rim, rim + 1, next }, NULL);
        } else {
            bbm_add_element(m, 0, of, 4, (int[]){ 0, rim, rim + 1, next }, NULL);
        }
    }
    bbm_fix_node(m, 2, BBM_XY, 0, 0);
    bbm_fix_node(m, 4, BBM_XY, 0, 0);
    return m;
}

/* Both have moved alike, all nodes, by the largest way w within `tolerance`. */
static void ck_alike(const bbm_model *m, const bbm_model *n, double tolerance)
{
    double w = 0;

    for (int k = 0; k < m->nodes; k++)
        w = fmax(w, hypot(result_at(m, k).u, result_at(m, k).v));
    for (int v = 0; v < m->vertices; v++) {
        ck_near(n->vertex[v].u, m->vertex[v].u, w, tolerance);
        ck_near(n->vertex[v].v, m->vertex[v].v, w, tolerance);
    }
}

/* Node 0 is held where it is anyway. */
START_TEST(a_support_with_reaction_0_changes_no_answer)
{
    const int n = FEWEST + _i % STARS, kind = _i / STARS;
    bbm_model *m = make_star(n, kind), *held = make_star(n, kind);

    run(m);
    bbm_fix_node(held, 0, BBM_XY, result_at(m, 0).u, result_at(m, 0).v);
    run(held);
    ck_alike(m, held, 1e-8);                    /* what the solver leaves */
    for (int a = 0; a < 2; a++)                 /* of loads of 1e6 N */
        ck_near(held->beyond->support[0].force[a], 0, 1e6, 1e-6);
}
END_TEST

/* It acts on all corners that meet at the node, as a load does. */
START_TEST(a_support_is_as_good_as_its_reaction_as_a_load)
{
    const int n = FEWEST + _i % STARS, kind = _i / STARS;
    bbm_model *m = make_star(n, kind), *loaded = make_star(n, kind);

    bbm_fix_node(m, 0, BBM_Y, 0, 0.01);
    run(m);
    const double *R = m->beyond->support[0].force;
    ck_assert_double_gt(fabs(R[1]), 1e5);
    ck_assert(R[0] == 0);
    bbm_add_load(loaded, 0, R[0], R[1]);
    run(loaded);
    ck_alike(m, loaded, 1e-8);                  /* what the solver leaves */
}
END_TEST

/* 20 m x 1 m of 10 or 20 cells in one or two rows, with a load of 10 kN/m. */
static bbm_model *make_beam(grid *g, int rows)
{
    bbm_model *m = beyond_model();

    *g = (grid){ .x = -10, .lx = 20, .ly = 1, .nx = 20, .ny = rows };
    m->beyond->multiplier_rounds = 3;
    m->par.pcg.tolerance = 1e-14;
    bbm_add_material(m, &(bbm_material){ 1e10, 0, 1000, 1 }, NULL);
    add_grid(m, g, 0);
    for (int i = 0; i < g->nx; i++)
        bbm_add_line_load(m, node_at(g, i, rows), node_at(g, i + 1, rows), 0, -1e4);
    bbm_fix_node(m, node_at(g, 0, 0), BBM_Y, 0, 0);
    bbm_fix_node(m, node_at(g, g->nx, 0), BBM_Y, 0, 0);
    return m;
}

/* x is held at the left end or, by symmetry no less right, on the axis of the beam: in one node,
 * from the first to the last held one, as a pin or a whole section. */
START_TEST(a_beam_bends_alike_wherever_it_is_held_along_its_axis)
{
    static const struct { int rows, first, last; } held[] = {
        { 1, 0, 0 }, { 1, 1, 1 }, { 1, 0, 1 },
        { 2, 0, 0 }, { 2, 1, 1 }, { 2, 2, 2 }, { 2, 0, 2 },
    };
    const int rows = held[_i].rows;
    grid g;
    bbm_model *m = make_beam(&g, rows), *n = make_beam(&g, rows);

    bbm_fix_node(m, node_at(&g, 0, 0), BBM_XY, 0, 0);
    for (int j = held[_i].first; j <= held[_i].last; j++)
        bbm_fix_node(n, node_at(&g, g.nx / 2, j), BBM_X, 0, 0);
    run(m);
    run(n);
    const double middle = result_at(m, node_at(&g, g.nx / 2, 0)).v;
    for (int k = 0; k < m->nodes; k++)
        ck_near(result_at(n, k).v, result_at(m, k).v, middle, 1e-8);    /* the solver's */
}
END_TEST

/* Theory with shear: 5 q L^4/(384 E I) + q L^2/(8 k G A) over L^3/(48 E I) + L/(4 k G A), L = 20,
 * k = 5/6. A pin that clamps gets 3 % more. */
START_TEST(the_support_in_the_middle_of_two_spans_carries_what_theory_says)
{
    const double EI = 1e10 / 12, kGA = 5e9 * 5 / 6, q = 1e4, L = 20;
    const double sinks = 5 * q * pow(L, 4) / (384 * EI) + q * L * L / (8 * kGA);
    grid g;
    bbm_model *m = make_beam(&g, 1 + _i);

    bbm_fix_node(m, node_at(&g, g.nx / 2, 0), BBM_XY, 0, 0);
    run(m);
    const double R = m->beyond->support[node_at(&g, g.nx / 2, 0)].force[1];
    ck_relative(R, sinks / (pow(L, 3) / (48 * EI) + L / (4 * kGA)), 3e-3);  /* 20 elements */
}
END_TEST

/* A beam falls on two blocks under its ends and rebounds with a hit's jump; in the middle of its
 * lower side, x is held or not. */
START_TEST(a_support_with_reaction_0_changes_no_hit)
{
    bbm_model *m[2];

    for (int k = 0; k < 2; k++) {
        grid g = { .x = -4, .y = 0.001, .lx = 8, .ly = 1, .nx = 8, .ny = 1 };
        m[k] = new_blocks();
        m[k]->par.dt = 1e-3;
        m[k]->beyond->restitution = 0.5;
        set_springs(m[k], 1e10, 1e10);
        m[k]->par.friction = 0;
        add_grid(m[k], &g, 0);
        for (int side = -1; side < 2; side += 2)
            add_rectangle(m[k], 2 + side, BASE, (rectangle){ side < 0 ? -5 : 3, -1, 2, 1, .fixed = 1 });
        if (k)
            bbm_fix_node(m[k], node_at(&g, 4, 0), BBM_X, 0, 0);
        prepare(m[k]);
        for (int e = 0; e < 8; e++)
            set_velocity(m[k], e, 0, -1);
        run_steps(m[k], 20);
    }
    ck_assert_double_gt(m[0]->beyond->hit[0], 0);
    ck_alike(m[0], m[1], 1e-7);
}
END_TEST

/* A single quadrilateral of 2 m x 1 m: one lower corner is held, the other moves 1 mm away. It stretches by that, for it has
 * as many unknowns as these supports hold. */
START_TEST(two_held_corners_of_one_quadrilateral_hold_its_length)
{
    const bbm_material material = { 1e10, 0, 2500, 1 };
    grid g = { .lx = 2, .ly = 1, .nx = 1, .ny = 1 };
    bbm_model *m = new_model(&material);

    m->beyond->bonding = BBM_MOMENT;
    m->beyond->multiplier_rounds = 2;
    add_grid(m, &g, 0);
    bbm_fix_node(m, 0, BBM_XY, 0, 0);
    bbm_fix_node(m, 1, BBM_XY, 1e-3, 0);
    run(m);
    ck_relative(m->element[0].stress[0], 5e6, 1e-3);
    ck_near(result_at(m, 0).u, 0, 1e-3, 1e-3);
    ck_relative(result_at(m, 1).u, 1e-3, 1e-3);
}
END_TEST

/* A cantilever of four squares is turned by its clamp, by 0, 40 or 80 degrees. Then a load across it bends it alike. */
START_TEST(a_clamp_holds_against_turning_at_any_angle)
{
    const bbm_material material = { 1e9, 0.2, 2500, 1 };
    double bends[3];

    for (int k = 0; k < 3; k++) {
        grid g = { .lx = 4, .ly = 1, .nx = 4, .ny = 1 };
        bbm_model *m = new_model(&material);
        const int tip = 9, clamp = 5;
        m->beyond->bonding = BBM_MOMENT;
        m->par.alpha = 1000;
        m->par.dt = 0.02;
        m->par.velocity_factor = 0.5;
        add_grid(m, &g, 0);
        bbm_fix_node(m, 0, BBM_XY, 0, 0);
        bbm_fix_node(m, clamp, BBM_XY, 0, 0);
        ck_ok(bbm_prepare(m), m);
        const double angle = k * radians(40);
        for (int step = 1; step <= 40; step++) {
            ck_ok(bbm_move_support(m, clamp, -sin(angle * step / 40), cos(angle * step / 40) - 1), m);
            run_steps(m, 1);
        }
        run_steps(m, 60);
        const bbm_result was = result_at(m, tip);
        m->node[tip].load[0] = 1e4 * sin(angle);
        m->node[tip].load[1] = -1e4 * cos(angle);
        run_steps(m, 200);
        const bbm_result now = result_at(m, tip);
        bends[k] = (now.u - was.u) * sin(angle) - (now.v - was.v) * cos(angle);
        ck_relative(bends[k], bends[0], 1e-2);
        release(m);
    }
}
END_TEST

/* A grid at rest under its weight on its lower side: to hold another node there, or at the top, changes nothing, in statics
 * and in dynamics. Nor does it make energy to let one go. With triangles, quadrilaterals, and these bonded at vertices. */
START_TEST(a_node_that_is_held_or_let_go_on_the_way_makes_nothing)
{
    const bbm_material material = { 1e8, 0.25, 2500, 1 };
    const int is_static = _i % 2, at = _i / 2 % 3, kind = _i / 6;
    grid g = { .lx = 2, .ly = 1, .nx = 2, .ny = 2, .triangles = kind == 0 };
    bbm_model *m = new_model(&material);
    double was[9][2];

    m->beyond->bonding = kind == 1 ? BBM_MOMENT : BBM_VERTICES;
    m->beyond->multiplier_rounds = 2 * is_static;
    m->par.gravity[1] = -9.81;
    m->par.alpha = is_static ? 100 : 1000;
    m->par.dt = is_static ? INFINITY : 1e-3;
    m->par.velocity_factor = 0;
    add_grid(m, &g, 0);
    for (int i = 0; i <= g.nx; i++)
        bbm_fix_node(m, node_at(&g, i, 0), BBM_XY, 0, 0);
    ck_ok(bbm_prepare(m), m);
    run_steps(m, is_static ? 3 : 600);
    for (int n = 0; n < 9; n++)
        was[n][0] = result_at(m, n).u, was[n][1] = result_at(m, n).v;
    m->par.velocity_factor = 1;
    const int n = node_at(&g, at == 1, at == 2 ? 0 : at + 1);
    if (at < 2)
        bbm_fix_node(m, n, BBM_XY, was[n][0], was[n][1]);
    else
        m->node[n].held = BBM_Y;
    for (int k = 2 * m->bonds; k < m->gaps; k++)
        m->gap[k].own = (bbm_multiplier){ 0 };              /* gaps of fixed points are others then */
    run_steps(m, 20);
    for (int k = 0; k < 9 && at < 2; k++)
        ck_near(hypot(result_at(m, k).u - was[k][0], result_at(m, k).v - was[k][1]), 0, fabs(was[8][1]), 1e-4);
}
END_TEST

/* A beam of 10 x 1, held along 0.5 of its lower side at the left, with 1 kN at its right. By finer
 * and finer triangles its end sinks by 5.69e-4 with 32 rows, by as much less than 5.79e-4 as half
 * the difference to 16 rows says. A foot that could not turn would make it 4e-4, one node alone no
 * support. At most `error` is what so few rows leave: where two nodes hold one side, 0.15. */
START_TEST(two_held_nodes_side_by_side_hold_the_line_between_them)
{
    const struct { int rows; double error; } mesh[] = { { 2, 0.15 }, { 4, 0.03 }, { 8, 0.02 } };
    const bbm_material material = { 1e10, 0, 1000, 1 };
    const int n = mesh[_i].rows;
    grid g = { .lx = 10, .ly = 1, .nx = 10 * n, .ny = n };
    bbm_model *m = new_model(&material);

    m->beyond->bonding = BBM_MOMENT;
    m->beyond->multiplier_rounds = 3;
    add_grid(m, &g, 0);
    for (int i = 0; i <= n / 2; i++)
        bbm_fix_node(m, node_at(&g, i, 0), BBM_XY, 0, 0);
    for (int j = 0; j <= n; j++)
        bbm_add_load(m, node_at(&g, g.nx, j), 0, -1e3 / (n + 1));
    run(m);
    ck_near(result_at(m, node_at(&g, g.nx, n)).v, -5.79e-4, 5.79e-4, mesh[_i].error);
}
END_TEST

/* By -0.0489 with triangles and -0.0512 with quadrilaterals; with those bonded to each other at their ends it would be
 * stiffer than both. */
START_TEST(a_beam_of_both_kinds_bends_between_those_of_one)
{
    double tip[3];

    for (int k = 0; k < 3; k++) {
        grid g = { .lx = 5, .ly = 1, .nx = 20, .ny = 4, .triangles = k, .angle = _i };
        bbm_model *m = new_model(&(bbm_material){ 1e9, 0, 1000, 1 });
        m->beyond->bonding = BBM_MOMENT;
        add_grid(m, &g, 0);
        for (int j = 0; j <= g.ny; j++)
            bbm_fix_node(m, node_at(&g, 0, j), BBM_XY, 0, 0);
        for (int j = 0; j <= g.ny; j++)
            bbm_add_load(m, node_at(&g, g.nx, j), 2e4 * sin(g.angle), -2e4 * cos(g.angle));
        run(m);
        const bbm_result r = result_at(m, node_at(&g, g.nx, 2));
        tip[k] = hypot(r.u, r.v);
    }
    ck_assert_double_gt(tip[2], 1.01 * tip[1]);
    ck_assert_double_lt(tip[2], 0.999 * tip[0]);
}
END_TEST

/* Held below and at its sides, under its weight. Its multipliers converge: with two rounds it sinks as with ten. */
START_TEST(a_mesh_of_both_kinds_sinks_alike_however_often_its_multipliers_take_over)
{
    double top[2];

    for (int k = 0; k < 2; k++) {
        grid g = { .lx = 4, .ly = 3, .nx = 4, .ny = 3, .triangles = 2, .jitter = 0.2, .angle = _i };
        bbm_model *m = new_model(&(bbm_material){ 1e9, 0.25, 1000, 1 });
        m->beyond->bonding = BBM_MOMENT;
        m->beyond->multiplier_rounds = k ? 10 : 2;
        m->par.gravity[0] = 10 * sin(g.angle);
        m->par.gravity[1] = -10 * cos(g.angle);
        add_grid(m, &g, 0);
        for (int n = 0; n < m->nodes; n++)
            if (n % 5 == 0 || n % 5 == 4 || n < 5)
                bbm_fix_node(m, n, BBM_XY, 0, 0);
        run(m);
        top[k] = hypot(result_at(m, node_at(&g, 2, 3)).u, result_at(m, node_at(&g, 2, 3)).v);
    }
    ck_relative(top[0], top[1], 1e-3);                  /* (2/alpha)^3 times some hundred */
}
END_TEST

/* Two triangles and a quadrilateral, whose left side is struck: their bonds open, and the corner of the quadrilateral is
 * no longer where the side of the triangle ends. What struck it is outside of that gap, too. */
START_TEST(a_corner_beside_bonds_that_open_does_not_lie_inside)
{
    static const double x[][2] = { { -0.6667, 0.2 }, { -1, 0.2 }, { -0.6667, 0.4 }, { -1, 0.4 }, { -0.6667, 0.6 },
                                   { -1, 0.6 }, { -1, 0.4539 }, { -1, 1.154 }, { -1.5, 0.4539 } };
    bbm_model *m = new_model(&(bbm_material){ 4.93e9, 0.2, 2500, 1 });
    const double side = _i ? -1 : 1;

    m->beyond->bonding = BBM_MOMENT;
    for (int k = 0; k < COUNT(x); k++)
        bbm_add_node(m, side * x[k][0], x[k][1], NULL);
    bbm_add_element(m, 0, 0, 3, (int[]){ 0, 1, 3 }, NULL);
    bbm_add_element(m, 0, 0, 3, (int[]){ 0, 3, 2 }, NULL);
    bbm_add_element(m, 0, 0, 4, (int[]){ 2, 3, 5, 4 }, NULL);
    bbm_add_element(m, 1, 0, 3, (int[]){ 6, 7, 8 }, NULL);
    set_springs(m, 2.47e11, 1e11);
    m->par.friction = 0;
    m->par.dt = 4.27e-5;
    m->par.velocity_factor = 1;
    m->par.alpha = 100;
    prepare(m);
    for (int e = 0; e < 3; e++)
        m->element[e].V[0] = -0.1988 * side;
    run_steps(m, 20);
    release(m);
}
END_TEST

Suite *bars_suite(void)
{
    Suite *s = suite_create("bars");

    add_case(s, "bars",
        { bars_of_rectangles_bend_exactly, COUNT(bars) },
        { rows_of_parallelograms_bend_as_beams, COUNT(slanted) },
        { a_beam_of_both_kinds_bends_between_those_of_one, 2 },
        { a_corner_beside_bonds_that_open_does_not_lie_inside, 2 },
        { a_bond_of_two_elements_of_one_shape_has_the_moment_of_springs_in_series, 3 });
    add_case(s, "supports",
        { a_support_with_reaction_0_changes_no_answer, STARS * 8 },
        { a_support_is_as_good_as_its_reaction_as_a_load, STARS * 8 },
        { a_beam_bends_alike_wherever_it_is_held_along_its_axis, 7 },
        { the_support_in_the_middle_of_two_spans_carries_what_theory_says, 2 },
        { a_support_with_reaction_0_changes_no_hit, 1 },
        { two_held_nodes_side_by_side_hold_the_line_between_them, 3 },
        { two_held_corners_of_one_quadrilateral_hold_its_length, 1 },
        { a_clamp_holds_against_turning_at_any_angle, 1 },
        { a_node_that_is_held_or_let_go_on_the_way_makes_nothing, 18 },
        { a_mesh_of_both_kinds_sinks_alike_however_often_its_multipliers_take_over, 2 });
    return s;
}
