/* scenes.c - the generator of scenes. See scenes.h.
 *
 * Every number comes from splitmix64 by operations that IEEE 754 rounds the same way on each machine; turns are formed
 * by a series of their own instead of libm's sine. */
#include <math.h>
#include <string.h>

#include "scenes.h"

/* --------------------------------------------------------------------------------------------- random numbers */

/* Steele, Lea, Flood: Fast splittable pseudorandom number generators, OOPSLA 2014. */
uint64_t scene_random(uint64_t *state)
{
    uint64_t z = *state += 0x9e3779b97f4a7c15u;

    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

static double between(uint64_t *r, double low, double high)
{
    return low + (high - low) * (double)(scene_random(r) >> 11) / 9007199254740992.0;
}

static int one_of(uint64_t *r, int n) { return (int)(scene_random(r) % (uint64_t)n); }

static double pick(uint64_t *r, const double *list, int n) { return list[one_of(r, n)]; }

/* (cos a, sin a): the series of the 64th part, squared six times. */
static void direction_of(double a, double d[2])
{
    const double b = a / 64, q = b * b;

    d[0] = 1 - q / 2 * (1 - q / 12 * (1 - q / 30 * (1 - q / 56 * (1 - q / 90))));
    d[1] = b * (1 - q / 6 * (1 - q / 20 * (1 - q / 42 * (1 - q / 72))));
    for (int k = 0; k < 6; k++) {
        const double c = d[0] * d[0] - d[1] * d[1], s = 2 * d[0] * d[1];
        d[0] = c;
        d[1] = s;
    }
}

static const double TURN = 6.283185307179586;

/* ------------------------------------------------------------------------------------------------------ blocks */

static scene_block *new_block(test_scene *s, bbm_material material)
{
    scene_block *b = &s->block[s->blocks++];

    memset(b, 0, sizeof *b);
    b->material = material;
    return b;
}

/* A block of one element. */
static scene_block *add_polygon(test_scene *s, bbm_material material, int n, double (*x)[2])
{
    scene_block *b = new_block(s, material);

    b->nodes = b->element[0].n = n;
    b->elements = 1;
    for (int k = 0; k < n; k++) {
        memcpy(b->node[k], x[k], sizeof x[k]);
        b->element[0].node[k] = k;
        b->at[0] += x[k][0] / n;
        b->at[1] += x[k][1] / n;
    }
    return b;
}

static scene_block *add_rectangle(test_scene *s, bbm_material material, double x, double y, double w, double h)
{
    double corner[4][2] = { { x, y }, { x + w, y }, { x + w, y + h }, { x, y + h } };

    return add_polygon(s, material, 4, corner);
}

static bbm_material random_rock(uint64_t *r)
{
    static const double E[] = { 1e8, 1e9, 1e10, 1e10, 1e11 };

    const double modulus = pick(r, E, 5), nu = between(r, 0, 0.4), density = between(r, 1000, 4000);

    return (bbm_material){ modulus, nu, density, 1 };
}

/* A convex stone: corners on a circle, no two at the same place, the first in the direction `first`. */
static scene_block *add_stone(test_scene *s, uint64_t *r, double x, double y, double first)
{
    const bbm_material material = random_rock(r);
    const int n = 3 + one_of(r, 5);
    const double radius = between(r, 0.2, 0.45);
    double corner[SCENE_CORNERS][2], d[2];

    for (int k = 0; k < n; k++) {
        direction_of(first + TURN / n * (k + (k > 0 ? between(r, -0.4, 0.4) : 0)), d);
        corner[k][0] = x + radius * d[0];
        corner[k][1] = y + radius * d[1];
    }
    return add_polygon(s, material, n, corner);
}

static void throw_block(scene_block *b, uint64_t *r, double speed, double spin)
{
    b->v[0] = between(r, -speed, speed);
    b->v[1] = between(r, -speed, speed);
    b->spin = between(r, -spin, spin);
}

/* Whether the line along a side of p has all of q beyond it, at least `room` away. */
static int side_parts(const scene_block *p, const scene_block *q, double room)
{
    for (int k = 0; k < p->element[0].n; k++) {
        const double *a = p->node[k], *b = p->node[(k + 1) % p->element[0].n];
        const double x = b[1] - a[1], y = a[0] - b[0], l = sqrt(x * x + y * y);
        double least = INFINITY;
        for (int i = 0; i < q->nodes; i++)
            least = fmin(least, (x * (q->node[i][0] - a[0]) + y * (q->node[i][1] - a[1])) / l);
        if (least >= room)
            return 1;
    }
    return 0;
}

/* Whether the last block, convex and not yet subdivided, as all, has room around itself. */
static int has_room(const test_scene *s, double room)
{
    const scene_block *p = &s->block[s->blocks - 1];

    for (int k = 0; k < s->blocks - 1; k++)
        if (!side_parts(p, &s->block[k], room) && !side_parts(&s->block[k], p, room))
            return 0;
    return 1;
}

/* A stone where there is room for it: in a box that grows upwards from (left, low) by steps. */
static scene_block *drop_stone(test_scene *s, uint64_t *r, double left, double right, double low)
{
    for (double high = low + 0.5;; high += 0.05) {
        const double x = between(r, left, right), y = between(r, low, high);
        const double first = between(r, 0, TURN);
        scene_block *b = add_stone(s, r, x, y, first);
        if (has_room(s, 1e-3))
            return b;
        s->blocks--;
    }
}

/* Triangles around a point inside. */
static void cut_like_a_cake(scene_block *b)
{
    const int n = b->nodes;

    memcpy(b->node[n], b->at, sizeof b->at);
    b->nodes++;
    b->elements = n;
    for (int k = 0; k < n; k++)
        b->element[k] = (scene_element){ 3, { k, (k + 1) % n, n } };
}

/* A quadrilateral into nx times ny (0), or twice as many triangles (1), or every other one into two (2). */
static void cut_like_a_grid(scene_block *b, int nx, int ny, int triangles)
{
    double c[4][2];

    memcpy(c, b->node, sizeof c);
    b->nodes = b->elements = 0;
    for (int j = 0; j <= ny; j++)
        for (int i = 0; i <= nx; i++, b->nodes++)
            for (int k = 0; k < 2; k++) {
                const double x = i / (double)nx, y = j / (double)ny;
                b->node[b->nodes][k] = (1 - y) * ((1 - x) * c[0][k] + x * c[1][k]) + y * ((1 - x) * c[3][k] + x * c[2][k]);
            }
    for (int j = 0; j < ny; j++)
        for (int i = 0; i < nx; i++) {
            const int p = j * (nx + 1) + i, q = p + nx + 1;
            if (triangles == 1 || (triangles == 2 && (i + j) % 2)) {
                b->element[b->elements++] = (scene_element){ 3, { p, p + 1, q + 1 } };
                b->element[b->elements++] = (scene_element){ 3, { p, q + 1, q } };
            } else {
                b->element[b->elements++] = (scene_element){ 4, { p, p + 1, q + 1, q } };
            }
        }
}

/* Cuts a share of the blocks into bonded elements. */
static void subdivide(test_scene *s, uint64_t *r, double share)
{
    for (int k = 0; k < s->blocks; k++) {
        scene_block *b = &s->block[k];
        if (between(r, 0, 1) >= share)
            continue;
        const int nx = 1 + one_of(r, 4), ny = 2 + one_of(r, 2), triangles = one_of(r, 2) + (s->seed % 10 == 1);
        if (b->nodes == 4 && one_of(r, 4) > 0)
            cut_like_a_grid(b, nx, ny, triangles);
        else
            cut_like_a_cake(b);
    }
}

/* ------------------------------------------------------------------------------------------------------ scenes */

static const bbm_material WALL = { 1e11, 0.25, 2500, 1 };

/* Stones that fall into a box of a floor and two walls. */
static void make_box(test_scene *s, uint64_t *r)
{
    const int stones = 3 + one_of(r, 8);
    const double half = between(r, 0.8, 2), gap = one_of(r, 2) ? 0 : 1e-3;

    add_rectangle(s, WALL, -half - 0.5, -0.5, 2 * half + 1, 0.5)->fixed = 1;
    add_rectangle(s, WALL, -half - 0.5, gap, 0.5, 6)->fixed = 1;
    add_rectangle(s, WALL, half, gap, 0.5, 6)->fixed = 1;
    for (int k = 0; k < stones; k++)
        throw_block(drop_stone(s, r, -half, half, 0.2), r, 2, 6);
}

/* A stone from the left that flies into whatever stands between y = 0 and `height`. */
static void shoot(test_scene *s, uint64_t *r, double height)
{
    scene_block *b;

    for (double x = -1;; x -= 0.1) {
        const double y = between(r, 0.1, height), first = between(r, 0, TURN);
        b = add_stone(s, r, x, y, first);
        if (has_room(s, 1e-2))
            break;
        s->blocks--;
    }
    b->v[0] = between(r, 1, 20);
    b->v[1] = between(r, -1, 2);
    b->spin = between(r, -6, 6);
}

/* Slabs on top of each other, thick and thin; at half of them something is thrown. */
static void make_stack(test_scene *s, uint64_t *r)
{
    const int slabs = 2 + one_of(r, 5), thin = one_of(r, 3) == 0;
    double y = 0, x = 0, below = 1;

    add_rectangle(s, WALL, -2.5, -0.5, 5, 0.5)->fixed = 1;
    for (int k = 0; k < slabs; k++) {
        const double w = between(r, 0.3, 1.2), h = thin ? between(r, 0.02, 0.06) : between(r, 0.1, 0.5);
        const double reach = 0.4 * fmin(w, below);
        x += between(r, -reach, reach);
        add_rectangle(s, random_rock(r), x - w / 2, y, w, h);
        below = w;
        y += h;
    }
    if (one_of(r, 2))
        shoot(s, r, y + 0.2);
}

/* Bricks in running bond, their joints with or without strength, and a stone that flies into them. */
static void make_wall(test_scene *s, uint64_t *r)
{
    static const double strength[] = { 0, 0, 1e4, 1e5, 1e6 };
    const int rows = 2 + one_of(r, 3), columns = 1 + one_of(r, 3);
    const bbm_material rock = random_rock(r);
    const double w = 0.5, h = 0.25;

    add_rectangle(s, WALL, -2.5, -0.5, 5, 0.5)->fixed = 1;
    for (int j = 0; j < rows; j++)
        for (int i = 0; i < columns; i++)
            add_rectangle(s, rock, w * (i + j % 2 / 2.0), h * j, w, h);
    s->cohesion = pick(r, strength, 5);
    s->tension = s->cohesion * between(r, 0, 1);
    if (one_of(r, 4) > 0)
        shoot(s, r, h * rows);
}

/* A wedge that falls into a notch of two slopes, and stones on top. */
static void make_wedge(test_scene *s, uint64_t *r)
{
    const double g = between(r, 0.01, 0.1), w = 2, h = between(r, 0.5, 4), width = between(r, 0.2, 0.5);
    const double slope = h / (w - g) * (one_of(r, 2) ? 1 : between(r, 0.8, 1.3));
    const double flat = one_of(r, 2) ? between(r, 0.1, 0.9) : 0;
    const bbm_material rock = random_rock(r);

    add_polygon(s, WALL, 4, (double[][2]){ { -w, -0.2 }, { -g, -0.2 }, { -g, 0 }, { -w, h } })->fixed = 1;
    add_polygon(s, WALL, 4, (double[][2]){ { g, -0.2 }, { w, -0.2 }, { w, h }, { g, 0 } })->fixed = 1;
    for (double y = 0.01;; y += 0.01) {
        const double top = y + slope * width, x = flat * width, low = y + slope * x;
        double corner[4][2] = { { x, low }, { width, top }, { -width, top }, { -x, low } };
        add_polygon(s, rock, flat > 0 ? 4 : 3, corner);
        if (has_room(s, 1e-3))
            break;
        s->blocks--;
    }
    throw_block(&s->block[2], r, 1, 1);
    for (int k = one_of(r, 4); k > 0; k--)
        throw_block(drop_stone(s, r, -1, 1, s->block[2].node[1][1] + 0.3), r, 1, 6);
}

/* A corner against a corner. */
static void make_corners(test_scene *s, uint64_t *r)
{
    static const double beside[] = { 0, 0, 1e-6, 1e-3, 1e-2, 0.05 };
    const double gap = between(r, 1e-3, 0.05), off = pick(r, beside, 6);
    scene_block *b[2];

    for (int k = 0; k < 2; k++) {
        b[k] = add_stone(s, r, 0, 0, k * TURN / 2);
        const double x = (k ? gap : 0) - b[k]->node[0][0], y = (k ? off : 0) - b[k]->node[0][1];
        for (int i = 0; i < b[k]->nodes; i++) {
            b[k]->node[i][0] += x;
            b[k]->node[i][1] += y;
        }
        b[k]->at[0] += x;
        b[k]->at[1] += y;
        throw_block(b[k], r, 0.5, one_of(r, 2) ? 2 : 0);
    }
    b[0]->v[0] = between(r, 0.5, 8);
    if (one_of(r, 3) == 0)
        b[1]->fixed = 1, b[1]->v[0] = b[1]->v[1] = b[1]->spin = 0;
    s->par.gravity[1] = 0;
}

/* Stones in empty space on their way to the middle; one may be fast. */
static void make_cloud(test_scene *s, uint64_t *r)
{
    const int stones = 2 + one_of(r, 7);

    for (int k = 0; k < stones; k++) {
        scene_block *b = drop_stone(s, r, -1.5, 1.5, -1.5);
        const double speed = k == 0 && one_of(r, 3) == 0 ? between(r, 5, 50) : between(r, 0.2, 3);
        throw_block(b, r, 0.5, 6);
        b->v[0] -= speed * b->at[0];
        b->v[1] -= speed * b->at[1];
    }
    s->par.gravity[1] = 0;
}

/* Blocks of bonded elements, in empty space or on a floor. */
static void make_bonded(test_scene *s, uint64_t *r)
{
    const int stones = 1 + one_of(r, 4);

    for (int k = 0; k < stones; k++) {
        const double x = between(r, -1, 1), y = between(r, 0, 1.5), w = between(r, 0.3, 0.8), h = between(r, 0.3, 0.8);
        scene_block *b = one_of(r, 2) ? add_rectangle(s, random_rock(r), x, y, w, h) : add_stone(s, r, x, y, 0);
        if (!has_room(s, 1e-3)) {
            s->blocks--;
            b = drop_stone(s, r, -1, 1, 0.1);
        }
        throw_block(b, r, 0.5, 6);
        b->v[0] -= b->at[0] * between(r, 0.2, 3);
    }
    subdivide(s, r, 0.8);
    s->par.gravity[1] = 0;
    if (one_of(r, 2)) {
        s->par.gravity[1] = -9.81;
        add_rectangle(s, WALL, -2.5, -1.1, 5, 0.5)->fixed = 1;
    }
}

static const struct { const char *name; void (*make)(test_scene *, uint64_t *); double cut; } KINDS[SCENE_KINDS] = {
    [SCENE_BOX]     = { "box",     make_box,     0   },
    [SCENE_STACK]   = { "stack",   make_stack,   0.2 },
    [SCENE_WALL]    = { "wall",    make_wall,    0   },
    [SCENE_WEDGE]   = { "wedge",   make_wedge,   0.1 },
    [SCENE_CORNERS_MEET] = { "corners", make_corners, 0   },
    [SCENE_CLOUD]   = { "cloud",   make_cloud,   0   },
    [SCENE_BONDED]  = { "bonded",  make_bonded,  0   },
};

const char *scene_name(scene_kind kind) { return KINDS[kind].name; }

static void choose_parameters(test_scene *s, uint64_t *r)
{
    static const double p_n[] = { 1e6, 1e7, 1e8, 1e9, 1e9, 1e9, 1e9, 1e9, 1e10, 1e11 };
    static const double friction[] = { 0, 0, 10, 20, 30, 35 }, dt[] = { 2e-3, 5e-3, 1e-2, 1e-2, 2e-2 };
    static const double alpha[] = { 10, 30, 100 };

    s->par.dt = pick(r, dt, 5);
    s->par.velocity_factor = 1;
    s->par.p_n = pick(r, p_n, 10);
    s->par.p_s = s->par.p_n * between(r, 0.3, 1);
    s->par.friction = pick(r, friction, 6);
    s->par.gravity[1] = -9.81;
    s->par.alpha = pick(r, alpha, 3);
    s->bonding = one_of(r, 2) ? BBM_VERTICES : BBM_MOMENT;
    s->par.alpha *= one_of(r, 4) ? 1 : 100;
    s->par.pcg.tolerance = 1e-13;
    s->par.steps = 100 + one_of(r, 200);
}

/* The statics of the library's defaults, made dynamic. */
void scene_make(uint64_t seed, int kind, test_scene *s)
{
    uint64_t r = seed;
    bbm_model *defaults;
    const int chosen = one_of(&r, SCENE_KINDS);

    memset(s, 0, sizeof *s);
    s->seed = seed;
    s->kind = (scene_kind)(kind < 0 ? chosen : kind);
    if (bbm_beyond_new(&defaults) == BBM_OK)
        s->par = defaults->par;
    bbm_model_free(defaults);
    choose_parameters(s, &r);
    KINDS[s->kind].make(s, &r);
    if (KINDS[s->kind].cut > 0)
        subdivide(s, &r, KINDS[s->kind].cut);
}

/* ------------------------------------------------------------------------------------ the same scene, otherwise */

/* In units of length, mass and time that are L, M, T times smaller. */
void scene_in_units(test_scene *s, double L, double M, double T)
{
    const double force = M * L / (T * T), pressure = force / (L * L);

    s->par.dt *= T;
    s->par.p_n *= force / L;
    s->par.p_s *= force / L;
    s->cohesion *= pressure;
    s->tension *= pressure;
    for (int k = 0; k < 2; k++)
        s->par.gravity[k] *= L / (T * T);
    for (int i = 0; i < s->blocks; i++) {
        scene_block *b = &s->block[i];
        b->material.E *= pressure;
        b->material.density *= M / (L * L * L);
        b->material.thickness *= L;
        b->spin /= T;
        for (int k = 0; k < 2 * b->nodes; k++)
            b->node[k / 2][k % 2] *= L;
        for (int k = 0; k < 2; k++) {
            b->at[k] *= L;
            b->v[k] *= L / T;
        }
    }
}

static void turn_vector(const double d[2], double v[2])
{
    const double x = d[0] * v[0] - d[1] * v[1], y = d[1] * v[0] + d[0] * v[1];

    v[0] = x;
    v[1] = y;
}

/* Turned by an angle about the origin, with its gravity, then shifted. */
void scene_in_frame(test_scene *s, double angle, const double shift[2])
{
    double d[2];

    direction_of(angle, d);
    turn_vector(d, s->par.gravity);
    for (int i = 0; i < s->blocks; i++) {
        scene_block *b = &s->block[i];
        turn_vector(d, b->v);
        turn_vector(d, b->at);
        for (int k = 0; k < b->nodes; k++)
            turn_vector(d, b->node[k]);
        for (int k = 0; k < 2; k++) {
            b->at[k] += shift[k];
            for (int n = 0; n < b->nodes; n++)
                b->node[n][k] += shift[k];
        }
    }
}

/* Its blocks in another order: block k becomes number place[k]. */
void scene_shuffle(test_scene *s, int place[])
{
    uint64_t r = s->seed ^ 0x5ca1ab1e;

    for (int k = 0; k < s->blocks; k++)
        place[k] = k;
    for (int k = s->blocks - 1; k > 0; k--) {
        const int i = one_of(&r, k + 1), was = place[k];
        place[k] = place[i];
        place[i] = was;
    }
    const test_scene old = *s;
    for (int k = 0; k < s->blocks; k++)
        s->block[place[k]] = old.block[k];
}

/* One more stone, far away and fast, that flies off. */
void scene_add_far_stone(test_scene *s)
{
    uint64_t r = s->seed ^ 0xfa57;
    const double speed = between(&r, 5, 100), x = between(&r, 50, 100), y = between(&r, -50, 50);
    scene_block *b = add_stone(s, &r, x, y, 0);

    b->v[0] = speed;
    b->spin = between(&r, -6, 6);
}

/* ---------------------------------------------------------------------------------------------------- the model */

static void add_block(bbm_model *m, int number, const scene_block *b)
{
    const int first = m->nodes;
    int material;

    bbm_add_material(m, &b->material, &material);
    for (int k = 0; k < b->nodes; k++) {
        bbm_add_node(m, b->node[k][0], b->node[k][1], NULL);
        if (b->fixed)
            bbm_fix_node(m, first + k, BBM_XY, 0, 0);
    }
    for (int k = 0; k < b->elements; k++) {
        int node[SCENE_CORNERS], e;
        for (int i = 0; i < b->element[k].n; i++)
            node[i] = first + b->element[k].node[i];
        if (bbm_add_element(m, number, material, b->element[k].n, node, &e))
            return;
        m->element[e].V[0] = b->v[0] - b->spin * (m->element[e].y - b->at[1]);
        m->element[e].V[1] = b->v[1] + b->spin * (m->element[e].x - b->at[0]);
        m->element[e].V[2] = b->spin;
    }
}

bbm_status scene_build(const test_scene *s, bbm_model **m)
{
    if (bbm_beyond_new(m))
        return BBM_NO_MEMORY;
    (*m)->par = s->par;
    (*m)->beyond->bonding = s->bonding;
    (*m)->beyond->cohesion = s->cohesion;
    (*m)->beyond->tension = s->tension;
    for (int k = 0; k < s->blocks; k++)
        add_block(*m, k, &s->block[k]);
    return bbm_prepare(*m);
}
