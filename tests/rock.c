/* rock.c - jointed rock: blocks that slide, lean and lie on each other, for `make bench` and the
 * tests.
 *
 * All of it is drawn upright and inclined by its gravity: downhill is to the left. The springs of
 * the contacts are those of a new model, p_n = 1e9 and p_s = 4e8 N/m. */
#include <math.h>
#include <stdlib.h>

#include "rock.h"

static const double PI = 3.14159265358979323846;

enum { ROCK, BASE };            /* materials */

static bbm_model *new_rock(double angle, double friction, double dt)
{
    bbm_model *m;

    if (bbm_beyond_new(&m))
        return NULL;
    bbm_add_material(m, &(bbm_material){ 1e10, 0.25, 2500, 1 }, NULL);
    bbm_add_material(m, &(bbm_material){ 1e13, 0.25, 2500, 1 }, NULL);
    m->par.gravity[0] = -9.81 * sin(angle * PI / 180);
    m->par.gravity[1] = -9.81 * cos(angle * PI / 180);
    m->par.velocity_factor = 1;
    m->par.friction = friction;
    m->par.dt = dt;
    m->par.pcg.tolerance = 1e-12;
    return m;
}

/* A block of one element; one of the base is held. */
static void add_block(bbm_model *m, int block, int material, int n, double (*xy)[2])
{
    int node[6];

    for (int k = 0; k < n; k++) {
        bbm_add_node(m, xy[k][0], xy[k][1], &node[k]);
        if (material == BASE)
            bbm_fix_node(m, node[k], BBM_XY, 0, 0);
    }
    bbm_add_element(m, block, material, n, node, NULL);
}

/* Lower left corner (x, y), w x h. */
static void add_box(bbm_model *m, int block, int material, double x, double y, double w, double h)
{
    double xy[4][2] = { { x, y }, { x + w, y }, { x + w, y + h }, { x, y + h } };

    add_block(m, block, material, 4, xy);
}

enum { COLUMNS = 30 };

/* Columns of 1 m that rise uphill from 0.5 to 3.4 m: the tall ones lean on the low ones. */
static void add_columns(bbm_model *m)
{
    for (int i = 0; i < COLUMNS; i++)
        add_box(m, 1 + i, ROCK, i, 0, 1, 0.5 + 0.1 * i);
}

static bbm_model *make_slope(void)
{
    bbm_model *m = new_rock(30, 25, 0.01);

    if (m) {
        add_box(m, 0, BASE, -1, -1, 1.2 * COLUMNS + 3, 1);
        add_columns(m);
    }
    return m;
}

/* The base are blocks of 1.2 m, each 1 mm lower than the one downhill: no column stands flat. */
static bbm_model *make_steps(void)
{
    bbm_model *m = new_rock(30, 25, 0.01);

    if (m) {
        for (int i = 0; i < COLUMNS; i++)
            add_box(m, 1000 + i, BASE, 1.2 * i, -1 - 0.001 * i, 1.2, 1);
        add_columns(m);
    }
    return m;
}

/* Bricks of 1 m x 0.5 m in running bond, with half ones at the ends of every other course. */
static void add_bricks(bbm_model *m, int courses, int bricks)
{
    int block = 1;

    add_box(m, 0, BASE, -3, -1, bricks + 6, 1);
    for (int row = 0; row < courses; row++)
        for (double x = 0; x < bricks;) {
            const double w = row % 2 && (x == 0 || x == bricks - 0.5) ? 0.5 : 1;
            add_box(m, block++, ROCK, x, 0.5 * row, w, 0.5);
            x += w;
        }
}

/* By statics as in cases/tilt.c it falls from 31.3 degrees on. */
static bbm_model *make_wall(void)
{
    bbm_model *m = new_rock(30, 55, 0.01);

    if (m)
        add_bricks(m, 10, 5);
    return m;
}

static bbm_model *make_tall_wall(void)
{
    bbm_model *m = new_rock(20, 30, 0.01);

    if (m)
        add_bricks(m, 32, 31);
    return m;
}

/* Numbers from 0 to 1 from a linear congruential generator. */
static double random_number(unsigned *state)
{
    *state = (*state * 1103515245u + 12345u) & 0xffffffffu;
    return (*state >> 8) / 16777216.0;
}

/* Polygons of 4 to 6 corners fall into a box of 16 m. */
static bbm_model *make_pile(void)
{
    bbm_model *m = new_rock(0, 30, 0.005);
    unsigned state = 7;

    if (!m)
        return NULL;
    add_box(m, 0, BASE, -8, -1, 16, 1);
    add_box(m, 1, BASE, -9, -1, 1, 30);
    add_box(m, 2, BASE, 8, -1, 1, 30);
    for (int k = 0; k < 100; k++) {
        const double x = -7 + 1.5 * (k % 10) + 0.3 * (k / 10 % 2) + 0.2 * random_number(&state);
        const double y = 0.8 + 1.45 * (k / 10), turn = 6 * random_number(&state);
        const int n = 4 + (int)(3 * random_number(&state));
        double xy[6][2];
        for (int c = 0; c < n; c++) {
            const double R = 0.5 + 0.15 * random_number(&state), angle = turn + 2 * PI * c / n;
            xy[c][0] = x + R * cos(angle);
            xy[c][1] = y + R * sin(angle);
        }
        add_block(m, 3 + k, ROCK, n, xy);
    }
    return m;
}

static bbm_model *make_incline(void)
{
    bbm_model *m = new_rock(30, 20, 0.001);

    if (m) {
        add_box(m, 0, BASE, -6, -1, 12, 1);
        add_box(m, 1, ROCK, 0, 0, 1, 0.5);
        add_box(m, 2, ROCK, 1.5, 0, 1, 0.5);
    }
    return m;
}

const rock_scene rock[ROCK_SCENES] = {
    { "slope of 30 columns", make_slope, 60 },
    { "the same, stepped base", make_steps, 60 },
    { "wall of 55 bricks near its limit", make_wall, 40 },
    { "pile of 100 polygons", make_pile, 300 },
    { "two blocks on an incline", make_incline, 1000 },
    { "wall of 1,008 bricks", make_tall_wall, 4 },
};

void get_block(const bbm_matrix *K, int i, int j, double B[6][6])
{
    const int p = K->place[i], q = K->place[j], row = p > q ? p : q, left = abs(p - q);
    double (*from)[6] = left == 0 ? K->D[row] : NULL;

    for (int k = K->first[row]; k < K->first[row + 1]; k++)
        from = K->back[k] == left ? K->L[k] : from;
    for (int a = 0; a < 6; a++)
        for (int b = 0; b < 6; b++)
            B[a][b] = !from ? 0 : p < q ? from[b][a] : from[a][b];
}
