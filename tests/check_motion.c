/* check_motion.c - dynamic steps keep energy and momentum: the vectors of the middle of the step, the energy balance,
 * multipliers in steps of every length, corners, thin plates and stones far away. */
#include <string.h>

#include "models.h"

static bbm_model *new_solid(double modulus, double dt)
{
    bbm_model *m = beyond_model();

    bbm_add_material(m, &(bbm_material){ modulus, 0.2, 2500, 1 }, NULL);
    m->par.dt = dt;
    m->par.velocity_factor = 1;
    return m;
}

/* A rectangle of nx x ny quadrilaterals, or twice as many triangles, turned by `angle` about its lower left corner. Returns
 * its first element. */
typedef struct { double x, y, w, h, angle; int nx, ny, triangles; } box;

static int add_box(bbm_model *m, int block, const box *b)
{
    grid g = { .x = b->x, .y = b->y, .lx = b->w, .ly = b->h, .nx = b->nx ? b->nx : 1, .ny = b->ny ? b->ny : 1,
               .triangles = b->triangles, .angle = b->angle };

    add_grid(m, &g, block);
    return g.element;
}

static void hold_block(bbm_model *m, int block)
{
    for (int v = 0; v < m->vertices; v++)
        if (m->element[m->vertex[v].element].block == block)
            ck_ok(bbm_fix_node(m, m->vertex[v].node, BBM_XY, 0, 0), m);
}

/* The block moves by (vx, vy) and turns by w about (x, y). */
static void throw_block(bbm_model *m, int block, double vx, double vy, double w, double x, double y)
{
    prepare(m);
    for (int i = 0; i < m->elements; i++) {
        bbm_element *e = &m->element[i];
        if (e->block != block)
            continue;
        e->V[0] = vx - w * (e->y - y);
        e->V[1] = vy + w * (e->x - x);
        e->V[2] = w;
    }
}

static double sum_of(const bbm_model *m)
{
    bbm_energy e;

    bbm_energies(m, &e);
    return e.kinetic + e.elastic + e.springs;
}

/* ------------------------------------------------------------------------------------ the middle of the step */

/* D of large turns and strains, from one number. */
static void some_motion(int seed, double D[6])
{
    for (int a = 0; a < 6; a++)
        D[a] = (a < 2 ? 0.5 : a == 2 ? 1.5 : 0.2) * sin(1 + 7.3 * seed + 2.1 * a);
}

/* The exact motion of the point X from the barycentre, written with complex numbers' multiplication. */
static void exact_motion(const bbm_element *e, const double D[6], double x, double y, double moved[2])
{
    const double X = x - e->x, Y = y - e->y;
    const double sx = X + D[3] * X + D[5] / 2 * Y, sy = Y + D[5] / 2 * X + D[4] * Y;

    moved[0] = e->x + D[0] + cos(D[2]) * sx - sin(D[2]) * sy;
    moved[1] = e->y + D[1] + sin(D[2]) * sx + cos(D[2]) * sy;
}

static double sum_row(const double T[6], const double D[6])
{
    double sum = 0;

    for (int a = 0; a < 6; a++)
        sum += T[a] * D[a];
    return sum;
}

/* By the exact rotation in dynamics; by T D in statics and where rotations are linear. */
START_TEST(positions_follow_the_exact_rotation_in_dynamics_and_the_modes_otherwise)
{
    unsigned seed = 13;
    bbm_model *m = new_solid(1e9, 0.01);

    for (int trial = 0; trial < 36; trial++) {
        const bbm_element e = { .x = 4 * random_number(&seed), .y = 4 * random_number(&seed) };
        const double x = 4 * random_number(&seed), y = 4 * random_number(&seed);
        double D[6], T[2][6], u[2], to[2];
        for (int a = 0; a < 6; a++)
            D[a] = random_number(&seed);
        m->beyond->rotation = trial % 3 == 1 ? BBM_LINEAR : BBM_EXACT;
        m->h = trial % 3 == 2 ? INFINITY : 0.1;
        bbm_move(bbm_motion_of(m), &e, D, x, y, u);
        exact_motion(&e, D, x, y, to);
        bbm_mode_matrix(&e, x, y, T);
        ck_near(u[0], trial % 3 ? sum_row(T[0], D) : to[0] - x, 10, ROUNDING);
        ck_near(u[1], trial % 3 ? sum_row(T[1], D) : to[1] - y, 10, ROUNDING);
    }
}
END_TEST

/* Also for a D in whose middle it is not: then it is T to first order. 4e-16 of numbers up to 3, summed up: 1e-14. */
START_TEST(the_matrix_of_the_middle_moves_points_exactly)
{
    bbm_model *m = new_solid(1e9, 0.01);
    const int i = add_box(m, 0, &(box){ 1, 2, 1.5, 0.5, 0.3, 1, 1, 0 });
    double T[2][6], at[2], to[2], paper[2][6];

    ck_ok(bbm_prepare(m), m);
    m->h = m->par.dt;
    bbm_mode_matrix(&m->element[i], 2.5, 1, paper);
    bbm_step_point(&m->element[i], 2.5, 1, T, at);
    ck_assert_int_eq(memcmp(T, paper, sizeof T), 0);                /* mid is 0: the paper's */
    for (int seed = 0; seed < 20; seed++) {
        bbm_element *e = &m->element[i];
        some_motion(seed, m->D);
        bbm_set_middle(m);
        exact_motion(e, m->D, 2.5, 1, to);
        bbm_step_point(e, 2.5, 1, T, at);
        ck_near(2.5 + sum_row(T[0], m->D), to[0], 1, 1e-14);
        ck_near(1 + sum_row(T[1], m->D), to[1], 1, 1e-14);
        ck_near(at[0], (2.5 + to[0]) / 2, 1, 1e-14);
        ck_near(at[1], (1 + to[1]) / 2, 1, 1e-14);
    }
    m->beyond->rotation = BBM_LINEAR;
    bbm_set_middle(m);
    bbm_step_point(&m->element[i], 2.5, 1, T, at);
    ck_assert_int_eq(memcmp(T, paper, sizeof T), 0);
    m->beyond->rotation = BBM_EXACT;
    m->h = INFINITY;
    bbm_set_middle(m);
    bbm_step_point(&m->element[i], 2.5, 1, T, at);
    ck_assert_int_eq(memcmp(T, paper, sizeof T), 0);
}
END_TEST

/* 1e-8 is the largest product of the turn of an element and the error of that turn, to the last
 * bit, and with bonds a hundred times stiffer a tenth; with the paper's update there is none. It counts for either element of a bond, and for those
 * with a fixed point, a load or a line load; what flies freely needs no vectors. */
START_TEST(the_vectors_are_off_when_an_element_turns_further_than_they_did)
{
    enum { HELD = 2, LOAD_X, LOAD_Y, PRESSED, FREE, ALL };
    const double off = 1.0 / 65536, both = 1e-9 * 65536;    /* of which no bit gets lost */
    bbm_model *m = new_solid(1e9, 0.01);

    for (int k = 0; k < ALL - 1; k++)
        add_box(m, k, &(box){ 5 * k, 0, 1, 1, 0, k ? 1 : 2, 1, 0 });
    ck_ok(bbm_fix_node(m, m->vertex[m->element[HELD].first + 3].node, BBM_Y, 0, 0), m);
    ck_ok(bbm_add_load(m, m->vertex[m->element[LOAD_X].first + 2].node, 1, 0), m);
    ck_ok(bbm_add_load(m, m->vertex[m->element[LOAD_Y].first + 2].node, 0, 1), m);
    ck_ok(bbm_prepare(m), m);
    for (int e = 0; e < m->edges; e++)
        if (m->edge[e].element == PRESSED)
            ck_ok(bbm_load_edge(m, e, 0, 0, 1), m);
    m->h = m->par.dt;
    bbm_assemble(m);                                        /* of gravity and loads */
    for (int k = 0; k < ALL; k++) {
        double *mid = &m->beyond->middle[k].D[2];
        m->D[6 * k + 2] = both - off;
        *mid = both;
        ck_assert(!bbm_middle_is_off(m));
        *mid = nextafter(both, 1);
        ck_assert_int_eq(bbm_middle_is_off(m), k != FREE);
        m->D[6 * k + 2] = 0.01;
        *mid = 0.01 - 0.9e-7;
        ck_assert(!bbm_middle_is_off(m));
        m->par.alpha = 1e4;
        ck_assert_int_eq(bbm_middle_is_off(m), k != FREE);
        m->par.alpha = 100;
        *mid = 0.01 + 1.1e-7;
        ck_assert_int_eq(bbm_middle_is_off(m), k != FREE);
        m->beyond->rotation = BBM_LINEAR;
        ck_assert(!bbm_middle_is_off(m));
        m->beyond->rotation = BBM_EXACT;
        *mid = 0.01;
    }
}
END_TEST

/* l d_n and l d_s of three points, by their products. */
static void products(double p1[2], double p2[2], double p3[2], double p0[2], double d[2])
{
    const double bx = p3[0] - p2[0], by = p3[1] - p2[1];

    d[0] = bx * (p1[1] - p2[1]) - by * (p1[0] - p2[0]);
    d[1] = bx * (p1[0] - p0[0]) + by * (p1[1] - p0[1]);
}

/* The lengths of both springs of a contact at the end of the step, over the length l of the edge at its start. */
START_TEST(with_the_vectors_of_the_middle_the_springs_of_a_contact_have_their_exact_lengths)
{
    bbm_model *m = new_solid(1e9, 0.01);
    const int i = add_box(m, 0, &(box){ 0, 0, 1.5, 0.5, 0.3, 1, 1, 0 });
    const int j = add_box(m, 1, &(box){ 0.5, -2, 1, 1, -0.2, 1, 1, 0 });
    const bbm_element *a = &m->element[i], *b = &m->element[j];

    ck_ok(bbm_prepare(m), m);
    m->h = m->par.dt;
    for (int seed = 0; seed < 20; seed++) {
        const bbm_vertex *P1 = &m->vertex[a->first], *P2 = &m->vertex[b->first + 1], *P3 = &m->vertex[b->first];
        const double anchor = 0.3, l = hypot(P3->x - P2->x, P3->y - P2->y);
        const bbm_touch c = { a, b, P1, P2, P3 };
        bbm_spring n, s;
        double p1[2], p2[2], p3[2], p0[2], d[2];
        some_motion(seed, m->D);
        some_motion(seed + 100, m->D + 6);
        bbm_set_middle(m);
        bbm_normal_vectors(&c, &n);
        bbm_shear_vectors(&c, anchor, &s);
        exact_motion(a, m->D, P1->x, P1->y, p1);
        exact_motion(b, m->D + 6, P2->x, P2->y, p2);
        exact_motion(b, m->D + 6, P3->x, P3->y, p3);
        exact_motion(b, m->D + 6, P3->x + anchor * (P2->x - P3->x), P3->y + anchor * (P2->y - P3->y), p0);
        products(p1, p2, p3, p0, d);
        ck_near(n.d + sum_row(n.v[0], m->D) + sum_row(n.v[1], m->D + 6), d[0] / l, 1, 1e-13);
        ck_near(s.d + sum_row(s.v[0], m->D) + sum_row(s.v[1], m->D + 6), d[1] / l, 1, 1e-13);
    }
}
END_TEST

/* The same for contacts of quadrilaterals that share their corners; one without such corners has the vectors of the paper,
 * up to rounding. */
START_TEST(the_springs_of_contacts_at_shared_corners_have_their_exact_lengths)
{
    bbm_model *m = weightless_blocks();
    int n, shared = 0;

    m->par.faces = 1;
    add_rectangle(m, 0, ROCK, (rectangle){ .x = -1.6, .y = -1, .w = 3, .h = 1, .nx = 3 });
    add_rectangle(m, 1, ROCK, (rectangle){ .x = -1, .w = 2, .h = 1, .nx = 2 });
    add_rectangle(m, 2, ROCK, (rectangle){ .x = 5, .y = -1, .w = 2, .h = 1 });
    add_rectangle(m, 3, ROCK, (rectangle){ .x = 5.3, .w = 1, .h = 1 });
    start_step(m, &n);
    for (int seed = 0; seed < 20; seed++) {
        for (int i = 0; i < m->elements; i++)
            some_motion(seed + 100 * i, &m->D[6 * i]);
        bbm_set_middle(m);
        for (const bbm_contact *c = m->scratch->contact; c < m->scratch->contact + n; c++) {
            bbm_spring v[2], other[2];
            double d[2];
            bbm_contact_vectors(m, c, 0.3, v);
            bbm_end_distances(m, c, 0.3, d);
            for (int k = 0; k < 2; k++)
                ck_near(bbm_length_of(&v[k], c->parts, c->element, m->D), d[k], 1, 1e-13);
            shared += c->parts == BBM_PARTS;
            if (c->parts > 2)
                continue;
            bbm_shared_vectors(m, c, 0.3, other);
            for (int k = 0; k < 2; k++) {
                ck_near(other[k].d, v[k].d, 1, 1e-13);
                for (int a = 0; a < 6; a++) {
                    ck_near(other[k].v[0][a], v[k].v[0][a], 1, 1e-13);
                    ck_near(other[k].v[1][a], v[k].v[1][a], 1, 1e-13);
                }
            }
        }
    }
    ck_assert_int_ge(shared, 20);
}
END_TEST

/* --------------------------------------------------------------------------------------------- bonded blocks spin */

/* At the solution D the opening of a bond in the frame that turns with its edge is R^T (d0 + d), d the opening by D, of any two
 * motions. Rounding. */
START_TEST(the_opening_of_a_bond_turns_with_its_edge)
{
    const double D[2][6] = { { 0.1, -0.2, 0.35, 1e-2, 2e-2, -3e-2 }, { -0.3, 0.4, 0.15, -2e-2, 1e-2, 5e-2 } };
    const double r = (D[0][2] + D[1][2]) / 2;
    bbm_element e[2] = { { 0 } };
    bbm_middle at[2] = { { 0 } };
    bbm_gap g = { .d0 = { 0.02, -0.03 }, .W = { { 1, 0 }, { 0, 1 } } };

    for (int k = 0; k < 12; k++) {
        g.Ti[k / 6][k % 6] = 1 + 0.3 * sin(k + 1);
        g.Tj[k / 6][k % 6] = 1 + 0.3 * cos(2 * k + 1);
    }
    for (int k = 0; k < 2; k++) {
        memcpy(at[k].D, D[k], sizeof at[k].D);
        e[k].middle = &at[k];
    }
    const bbm_gap was = g;
    double d[2] = { was.d0[0], was.d0[1] }, turned[2] = { was.d0[0], was.d0[1] };
    bbm_turn_opening(&e[0], &e[1], &g);
    for (int k = 0; k < 12; k++) {
        d[k / 6] += was.Ti[k / 6][k % 6] * D[0][k % 6] - was.Tj[k / 6][k % 6] * D[1][k % 6];
        turned[k / 6] += g.Ti[k / 6][k % 6] * D[0][k % 6] - g.Tj[k / 6][k % 6] * D[1][k % 6];
    }
    ck_near(turned[0], cos(r) * d[0] + sin(r) * d[1], 1, 1e-14);
    ck_near(turned[1], cos(r) * d[1] - sin(r) * d[0], 1, 1e-14);
}
END_TEST

static const struct { double w; int triangles; bbm_bonding bonding; double alpha; } SPINS[] = {
    { 1, 0, BBM_MOMENT, 100 },  { 5, 0, BBM_MOMENT, 100 },   { 20, 0, BBM_MOMENT, 100 },   { 20, 0, BBM_MOMENT, 1e3 },
    { 5, 1, BBM_VERTICES, 1e3 }, { 20, 1, BBM_VERTICES, 100 }, { 20, 0, BBM_VERTICES, 1e3 },
};

/* A free block of 3 x 3 cells that flies, spins by up to 0.2 rad a step, and is under a pressure all round, or not. In the
 * first steps it is strained by the centrifugal force and the pressure, and swings; from then on it keeps its energy.
 * Springs and elements hold no more than that stress asks for, twice that in a swing: rho w^2 R^2 with R = 0.7, along
 * two axes, squared over 2 E; the springs 2.5/alpha of it. A spring that turns by w dt in a step pulls as it lies at its end
 * and loses (w dt)^2 of its energy. A pressure that balances itself does no work but on those strains. K D is rounded, by forces of
 * eps times the stiffness and the way of a step, some ten in all, which do work along it. Equations take no
 * more iterations than those of a block at rest; with a coarse space of the step's start triangles take 70 and more. */
START_TEST(a_bonded_block_that_spins_keeps_its_energy)
{
    for (int pressed = 0; pressed < 2; pressed++) {
        bbm_model *m = new_solid(1e10, 0.01);
        const double w = SPINS[_i].w, stress = 2500 * w * w * 0.5 + pressed * 1e4, elastic = stress * stress / 1e10;
        const double way = 0.01 * (hypot(2, 1) + 0.7 * w), rounding = 10 * 2.2e-16 * SPINS[_i].alpha * 1e10 * way * way;
        bbm_energy e;
        add_box(m, 0, &(box){ 0, 0, 1, 1, 0, 3, 3, SPINS[_i].triangles });
        m->par.alpha = SPINS[_i].alpha;
        m->beyond->bonding = SPINS[_i].bonding;
        ck_ok(bbm_prepare(m), m);
        for (int edge = 0; edge < m->edges && pressed; edge++)
            ck_ok(bbm_load_edge(m, edge, 0, 0, 1e4), m);
        throw_block(m, 0, 2, -1, w, 0.5, 0.5);
        const double start = sum_of(m);
        run_steps(m, 50);
        const double before = sum_of(m) - m->beyond->work;
        run_steps(m, 100);
        bbm_energies(m, &e);
        ck_assert_int_le(m->info.iterations, 20 * m->info.passes);
        ck_near(start, before, 4 * elastic + 50 * rounding, 1);
        ck_near(sum_of(m) - m->beyond->work, before, before + 1e8 * w * w * 1e-4 * e.springs + 1e8 * rounding, 1e-6);
        ck_near(m->beyond->work, 0, 4 * elastic, 1);
        ck_assert(e.elastic < 4 * elastic && e.springs < 4 * 2.5 / m->par.alpha * elastic);
        ck_assert_msg(m->beyond->gain < 1e-6, "gain %g", m->beyond->gain);
        release(m);
    }
}
END_TEST

/* ------------------------------------------------------------------------------ steps of every length, and the net */

/* A block of one square or of bonded cells, fixed or thrown, in steps from 1e-2 to 1e-7 s: what it has is at most what it
 * got. Multipliers that are kept from step to step, as in statics, make 1e29 J of nothing at 3e-4 s. */
START_TEST(bonds_make_no_energy_in_steps_of_any_length)
{
    const int fixed = _i % 2, kind = _i / 2 % 3;

    for (double dt = 1e-2; dt > 0.9e-7; dt /= sqrt(10)) {
        bbm_model *m = new_solid(1e9, dt);
        add_box(m, 0, &(box){ 0, 0, 10, 10, 0, kind ? 3 : 1, kind ? 3 : 1, kind == 2 });
        m->beyond->multiplier_rounds = 2;
        m->par.alpha = _i < 6 ? 100 : 1e5;
        m->par.gravity[1] = fixed ? -9.81 : 0;
        if (fixed)
            hold_block(m, 0);
        throw_block(m, 0, fixed ? 0 : 1, 0, fixed ? 0 : 0.5, 5, 5);
        const double before = sum_of(m);
        run_steps(m, 150);
        ck_assert_msg(sum_of(m) <= before + m->beyond->work + 1e-8 * (before + fabs(m->beyond->work)), "dt %g: %g J of %g",
                      dt, sum_of(m), before + m->beyond->work);
        ck_assert_msg(m->beyond->gain < 1e-5, "dt %g: %g", dt, m->beyond->gain);
        release(m);
    }
}
END_TEST

/* The balance of a step of the test's making: two elements that do not touch, their loads and all forces on them,
 * move without strain and are a little faster at the end. What is there of each: the kinetic energy at the
 * start, the work of each load without sign, and 64 roundings of a coordinate along which forces
 * and loads do work. In statics, and where velocities are not kept, nothing is. Where a share is kept, it is at the end of
 * the step. */
START_TEST(the_balance_of_a_step_is_what_it_says)
{
    const double F[2][2] = { { 3e9, 4e9 }, { -5e9, 12e9 } };
    const double load[2][2] = { { 8e9, -6e9 }, { 15e9, 8e9 } };
    const double size[2] = { (5e9 + 10e9) * hypot(300.5, 400.5), (13e9 + 17e9) * hypot(305.5, 400.5) };
    const double work[2] = { 8e2 - 6e2, 30e2 + 16e2 }, way[2] = { 8e2 + 6e2, 30e2 + 16e2 }, v = 2.001;
    const int none = _i == 1 || _i == 2;
    bbm_model *m = new_solid(1e9, 0.01);

    for (int k = 0; k < 2; k++)
        add_box(m, k, &(box){ 300 + 5 * k, 400, 1, 1, 0, 1, 1, 0 });
    throw_block(m, 0, 2, 0, 0, 0, 0);
    throw_block(m, 1, 2, 0, 0, 0, 0);
    m->h = _i == 1 ? INFINITY : m->par.dt;
    m->par.velocity_factor = _i == 2 ? 0 : _i == 3 ? 0.5 : 1;
    m->info.step = 1;
    for (int k = 0; k < 12; k++) {
        m->F[k] = k % 6 < 2 ? F[k / 6][k % 6] : 0;
        m->load[k] = k % 6 < 2 ? load[k / 6][k % 6] : 0;
        m->D[k] = k % 6 < 2 ? 1e-7 * (1 + k / 6) : 0;
    }
    bbm_model end = *m;
    end.element = calloc(2, sizeof *end.element);
    memcpy(end.element, m->element, 2 * sizeof *end.element);
    for (int k = 0; k < 2; k++)
        end.element[k].V[0] = v;
    ck_assert_int_eq(bbm_check_balance(m, &end), BBM_OK);
    for (int k = 0; k < 2; k++) {
        const bbm_account *a = &m->beyond->account[m->K->component[k]];
        const double rounding = 64 * ldexp(1, -52) * size[k];
        ck_near(a->there, none ? 0 : 1250 * 4 + way[k] + rounding, rounding, 1e-6);
        ck_near(a->gain, none ? 0 : 1250 * (v * v - 4) - work[k], 1e4, 1e-12);
    }
    memset(m->F, 0, 12 * sizeof *m->F);
    memset(m->load, 0, 12 * sizeof *m->load);
    for (int k = 0; k < 2; k++)
        m->element[k].V[0] = 0;
    m->beyond->gain = m->beyond->gained = 0;
    m->beyond->rotation = BBM_LINEAR;                   /* from nothing: counted alone */
    ck_assert_int_eq(bbm_check_balance(m, &end), BBM_OK);
    ck_near(m->beyond->gained, none ? 0 : 2 * 1250 * v * v, 1, 1e-9);
    ck_assert(m->beyond->gain == (none ? 0 : INFINITY));
    m->beyond->rotation = BBM_EXACT;
    ck_assert_int_eq(bbm_check_balance(m, &end), none ? BBM_OK : BBM_ENERGY);
    free(end.element);
}
END_TEST

/* Adds an impulse [N s] and a force [N] to the first element in each solution: energy from nowhere. */
static int kick(const bbm_model *m, void *push)
{
    m->F[0] += ((double *)push)[0] / m->h + ((double *)push)[1];
    return 0;
}

/* A push that no load does is found out in every part of the step, and the block is where it was. One that does less than
 * 1e-5 goes through, and is counted: an impulse J makes v J of the 2500 v^2/2 that were there. */
START_TEST(a_step_that_makes_energy_is_cut_and_then_refused)
{
    double push[2] = { 2500 * 2e-5, 0 };     /* 1e-5 of the forces; more is no solution either */
    bbm_model *m = new_solid(1e9, 0.01);

    add_box(m, 0, &(box){ 0, 0, 1, 1, 0, 1, 1, 0 });
    throw_block(m, 0, 1, 0, 0, 0, 0);
    m->monitor = kick;
    m->monitor_context = push;
    ck_assert_int_eq(bbm_step(m), BBM_ENERGY);
    ck_assert_int_eq(m->info.cuts, 12);
    ck_assert_msg(strstr(bbm_message(m), "step 1 at t = 0, dt cut to 2.44"), "%s", bbm_message(m));
    ck_assert(m->vertex[0].u == 0 && m->element[0].V[0] == 1 && m->info.step == 0 && m->beyond->gained == 0);
    push[0] = 2500 * 0.000004;
    ck_ok(bbm_step(m), m);
    ck_near(m->beyond->gained, 2500 * 0.000004, 1, 1e-6);
    ck_near(m->beyond->gain, 0.000008, 1, 1e-9);
    push[0] = -push[0];
    ck_ok(bbm_step(m), m);
    ck_near(m->beyond->gained, 2500 * 0.000004, 1, 1e-6);
}
END_TEST

/* Twice 1e-5 of the energy of a block that a far one, a million times as strong, may not hide; and 1.5e-5 in the nominal
 * step, of which each half has less. */
START_TEST(a_step_is_judged_whole_and_each_body_by_itself)
{
    double push[2] = { _i ? 0 : 2500 * 1e-5, _i ? 2500 * 0.75e-5 / 0.01 : 0 };
    bbm_model *m = new_solid(1e9, 0.01);

    add_box(m, 0, &(box){ 0, 0, 1, 1, 0, 1, 1, 0 });
    add_box(m, 1, &(box){ 20, 0, 10, 10, 0, 1, 1, 0 });
    throw_block(m, 0, 1, 0, 0, 0, 0);
    throw_block(m, 1, _i ? 0 : 100, 0, 0, 0, 0);
    m->monitor = kick;
    m->monitor_context = push;
    ck_assert_int_eq(bbm_step(m), BBM_ENERGY);
}
END_TEST

/* A soft block that hits a wall is pressed to less than half its area and comes back; a bar of 10 x 1 squares, or of 10 x 2, is
 * bent and drawn out by a third while it spins and swings. With the present area in (10), or M of the present shape, some
 * step makes 1e-5 to 1e-2 of its energy and is refused, or cut. What is left is the solver's. */
START_TEST(bodies_that_strain_and_bend_far_make_no_energy)
{
    bbm_model *m = new_solid(_i ? 1e6 : 7e6, _i ? 0.01 : 0.002);

    add_box(m, 0, _i ? &(box){ 0, 0, 10, 1, 0, 10, _i, 0 } : &(box){ 0.1, 0, 0.4, 0.3, 0.3, 1, 1, 0 });
    if (_i == 0) {
        add_box(m, 1, &(box){ -1, -5, 1, 10, 0, 1, 1, 0 });
        hold_block(m, 1);
    }
    throw_block(m, 0, _i ? 0 : -60, 0, _i ? 3 : 0, 5, 0.5);
    for (int e = 0; e < m->elements && _i; e++)
        m->element[e].V[1] += 0.3 * (m->element[e].x - 5) * (m->element[e].x - 5);
    run_steps(m, 200);
    ck_assert_msg(m->beyond->gain < 1e-9, "gain %g", m->beyond->gain);
}
END_TEST

/* A block slides on a slab, at the origin and 1e11 m from it, where the last digit of a position is 1.5e-5 m. */
START_TEST(a_model_far_from_the_origin_moves_as_one_at_it)
{
    double u[2], v[2];

    for (int k = 0; k < 2; k++) {
        const double far = k * 1e11;
        bbm_model *m = new_solid(1e9, 0.001);
        add_box(m, 0, &(box){ far, -far, 4, 1, 0, 1, 1, 0 });
        hold_block(m, 0);
        add_box(m, 1, &(box){ far + 1, 1 - far, 1, 1, 0, 1, 1, 0 });
        m->par.gravity[0] = 3;
        m->par.gravity[1] = -9.81;
        run_steps(m, 100);
        u[k] = m->vertex[4].u;
        v[k] = m->vertex[4].v;
        release(m);
    }
    ck_near(u[1], u[0], 0.015, 1e-9);
    ck_near(v[1], v[0], 0.015, 1e-9);
}
END_TEST

/* ------------------------------------------------------------------------------------------------- contacts */

/* Four slabs of 2 cm lie on each other and on a floor; a stone flies by far away, or falls there. */
static bbm_model *slabs(double x, double v)
{
    bbm_model *m = new_solid(1e9, 0.01);

    m->par.gravity[1] = -9.81;
    m->par.friction = 30;
    add_box(m, 0, &(box){ -2, -1, 4, 1, 0, 1, 1, 0 });
    hold_block(m, 0);
    for (int k = 0; k < 4; k++)
        add_box(m, 1 + k, &(box){ -0.5, 0.02 * k, 1, 0.02, 0, 1, 1, 0 });
    const int e = add_box(m, 5, &(box){ x, 5, 0.5, 0.5, 0, 1, 1, 0 });
    ck_ok(bbm_prepare(m), m);
    m->element[e].V[0] = v;
    return m;
}

/* Up to 100 m/s, or 10 km away, in the same pattern of K: the solver's tolerance, 1e-10 of all forces, is what is
 * left. */
START_TEST(a_stone_far_away_changes_nothing)
{
    static const double at[3][2] = { { 20, 5 }, { 20, 100 }, { 1e4, 0 } };
    bbm_model *m = slabs(at[_i][0], at[_i][1]), *n = slabs(20, 0);

    for (int i = 0; i < 30; i++) {
        run_steps(m, 1);
        run_steps(n, 1);
        for (int k = 0; k < m->element[5].first; k++) {
            ck_near(m->vertex[k].u, n->vertex[k].u, 1, 1e-10);
            ck_near(m->vertex[k].v, n->vertex[k].v, 1, 1e-10);
        }
        for (int k = 0; k < m->contacts; k++)
            ck_near(m->contact[k].N, n->contact[k].N, 4 * 0.02 * 2500 * 9.81, 1e-9);
    }
    ck_assert_int_eq(m->info.contacts, n->info.contacts);
}
END_TEST

/* A fixed unit square, and one of 0.5 whose lower left corner is 1 cm inside its right side's line and `above` its top,
 * turned, that falls on it at 2 m/s or comes at an angle: frictionless, it gains nothing. */
START_TEST(a_corner_that_comes_in_over_a_corner_gains_no_energy)
{
    const double turn[4] = { 0.3, 0.1, 0.6, 1.2 }, above[3] = { 2e-3, 1e-2, 1e-4 }, inside[2] = { 0.01, 0.001 };
    bbm_model *m = new_solid(1e9, 0.01);
    const double way = _i / 24 ? 0.5 : 0;

    set_springs(m, 1e9, 4e8);
    add_box(m, 0, &(box){ -1, -1, 1, 1, 0, 1, 1, 0 });
    hold_block(m, 0);
    add_box(m, 1, &(box){ -inside[_i / 12 % 2], above[_i / 4 % 3], 0.5, 0.5, turn[_i % 4], 1, 1, 0 });
    throw_block(m, 1, -2 * sin(way), -2 * cos(way), 0, 0, 0);
    for (int i = 0; i < 40; i++) {
        const double before = sum_of(m);
        run_steps(m, 1);
        ck_assert_msg(sum_of(m) <= before * (1 + 1e-6), "step %d: %g J become %g", i, before, sum_of(m));
    }
}
END_TEST

/* A block of 1 m falls at 10 to 400 m/s on a plate of 2 cm, in steps in which it goes many times through it. It gets no
 * deeper than the springs at its corners let it, v sqrt(m/(2 p_n)), also when that is deeper than the plate, and comes
 * back. */
START_TEST(a_fast_block_does_not_pass_a_thin_plate)
{
    const double v[4] = { 10, 50, 100, 400 }, stiff = _i % 4 == 3 ? 1e11 : 1e9, deep = v[_i % 4] * sqrt(2500 / 2 / stiff);
    bbm_model *m = new_solid(1e10, 0.01);

    m->par.p_n = stiff;

    add_box(m, 0, &(box){ -2, -0.02, 4, 0.02, 0, 1, 1, 0 });
    hold_block(m, 0);
    const int e = add_box(m, 1, &(box){ -0.5, 0.3, 1, 1, _i / 4 * 0.1, 1, 1, 0 });
    throw_block(m, 1, 0, -v[_i % 4], 0, 0, 0);
    const double before = sum_of(m);
    for (int i = 0; i < 50; i++) {
        run_steps(m, 1);
        ck_assert(sum_of(m) <= before * (1 + 1e-6));
        for (int k = 0; k < 4; k++)
            ck_assert_msg(m->vertex[m->element[e].first + k].y > (i < 10 ? -deep : -1e-3), "step %d: y = %g", i,
                          m->vertex[m->element[e].first + k].y);
    }
}
END_TEST

/* Sixteen blocks that spin over each other in steps of 1.5 s, in which they fall 11 m: a step is done, or is refused with a
 * status, after 10,000 solutions and ten times the iterations that one may take; it always ends. */
START_TEST(a_step_far_too_long_ends)
{
    bbm_model *m = new_solid(1e9, 1.5);
    bbm_status status = BBM_OK;

    m->par.gravity[1] = -9.81;
    m->par.friction = 30;
    m->par.pcg.iterations = _i ? 20 : 1000;
    add_box(m, 16, &(box){ -5, -1, 10, 1, 0, 1, 1, 0 });
    hold_block(m, 16);
    for (int k = 0; k < 16; k++)
        add_box(m, k, &(box){ -2.5 + 1.2 * (k % 4), 0.3 + 1.2 * (k / 4), 0.8, 0.5, 0.3, 1, 1, 0 });
    for (int k = 0; k < 16; k++)
        throw_block(m, k, k % 3 - 1, -1, 2 * (k % 2), 0, 0);
    for (int i = 0; i < 3 && !status; i++) {
        status = bbm_step(m);
        ck_assert(m->info.passes <= 10000 && m->info.iterations < 11 * m->par.pcg.iterations);
        ck_assert(m->beyond->gain < 1e-3);
    }
    ck_assert_msg(!status || status == BBM_OPEN_CLOSE || status == BBM_ENERGY || status == BBM_STEP_TOO_LONG
                  || status == BBM_NOT_CONVERGED, "%s", bbm_message(m));
}
END_TEST

/* Three blocks of a size of 1e-7 to 1e3 m lie in a pile for 50 steps, in which one falls by 1e-5 of its size
 * or less: none goes further than that, and none is refused for what rounding does. */
START_TEST(a_pile_stands_at_every_size)
{
    const double size = pow(10, _i - 7);
    bbm_model *m = new_blocks();

    m->par.dt = fmin(1e-5, 1e-3 * sqrt(size));
    m->par.friction = 30;
    m->par.p_n = m->par.p_s = 5e11;
    add_rectangle(m, 0, ROCK, (rectangle){ .x = -20 * size, .y = -2 * size, .w = 40 * size, .h = 2 * size, .fixed = 1 });
    for (int k = 0; k < 3; k++)
        add_rectangle(m, k + 1, ROCK, (rectangle){ .x = (k - 1 - k / 2 * 1.5) * size, .y = k / 2 * size,
                                                   .w = size, .h = size });
    run_steps(m, 50);
    for (int v = 4; v < m->vertices; v++)
        ck_near(hypot(m->vertex[v].u, m->vertex[v].v), 0, size, 1e-5);
}
END_TEST

/* A block of six elements flies and turns in steps in which sound runs 450 or 4,500 times through it, so that its inertia
 * loses 8 or 10 of its digits beside the stiffness of its bonds. After a thousand steps it has its velocity and its spin. */
START_TEST(a_meshed_block_that_flies_in_long_steps_keeps_what_it_has)
{
    bbm_model *m = new_solid(5e10, _i ? 1 : 0.1);
    double v[3] = { 0 };

    add_box(m, 0, &(box){ .w = 1, .h = 1, .nx = 3, .ny = 2 });
    throw_block(m, 0, 1e-3, 2e-3, 1e-3, 0.5, 0.5);
    run_steps(m, 1000);
    for (int i = 0; i < 6; i++)
        for (int k = 0; k < 3; k++)
            v[k] += m->element[i].V[k] / 6;
    ck_near(hypot(v[0], v[1]), hypot(1e-3, 2e-3), 1e-3, _i ? 1e-6 : 1e-9);      /* 1e-4 of what a step loses, once more */
    ck_near(v[2], 1e-3, 1e-3, _i ? 2e-5 : 1e-9);
}
END_TEST

Suite *motion_suite(void)
{
    Suite *s = suite_create("motion");

    add_case(s, "motion",
        { positions_follow_the_exact_rotation_in_dynamics_and_the_modes_otherwise, 1 },
        { the_matrix_of_the_middle_moves_points_exactly, 1 },
        { the_vectors_are_off_when_an_element_turns_further_than_they_did, 1 },
        { with_the_vectors_of_the_middle_the_springs_of_a_contact_have_their_exact_lengths, 1 },
        { the_springs_of_contacts_at_shared_corners_have_their_exact_lengths, 1 },
        { the_opening_of_a_bond_turns_with_its_edge, 1 },
        { a_bonded_block_that_spins_keeps_its_energy, COUNT(SPINS) },
        { bonds_make_no_energy_in_steps_of_any_length, 12 },
        { a_meshed_block_that_flies_in_long_steps_keeps_what_it_has, 2 },
        { the_balance_of_a_step_is_what_it_says, 4 },
        { a_step_that_makes_energy_is_cut_and_then_refused, 1 },
        { a_step_is_judged_whole_and_each_body_by_itself, 2 },
        { bodies_that_strain_and_bend_far_make_no_energy, 3 },
        { a_model_far_from_the_origin_moves_as_one_at_it, 1 },
        { a_stone_far_away_changes_nothing, 3 },
        { a_corner_that_comes_in_over_a_corner_gains_no_energy, 48 },
        { a_fast_block_does_not_pass_a_thin_plate, 8 },
        { a_pile_stands_at_every_size, 11 },
        { a_step_far_too_long_ends, 2 });
    return s;
}
