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

/* Whether the line along a side of p has all of q beyond it, or further than that away. */
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

/* Whether the last block, convex and of one element as all, has room around itself. */
static int has_room(const test_scene *s, double room)
{
    const scene_block *p = &s->block[s->blocks - 1];

    for (int k = 0; k < s->blocks - 1; k++)
        if (!side_parts(p, &s->block[k], room) && !side_parts(&s->block[k], p, room))
            return 0;
    return 1;
}

/* A convex stone: corners on a circle, no two at the same place. */
static scene_block *add_stone(test_scene *s, bbm_material material, uint64_t *r, double x, double y)
{
    const int n = 3 + one_of(r, 5);
    const double radius = between(r, 0.2, 0.45), start = between(r, 0, TURN);
    double corner[SCENE_CORNERS][2], d[2];

    for (int k = 0; k < n; k++) {
        direction_of(start + TURN / n * (k + between(r, -0.4, 0.4)), d);
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

static bbm_material random_rock(uint64_t *r)
{
    static const double E[] = { 1e8, 1e9, 1e10, 1e10, 1e11 };

    return (bbm_material){ pick(r, E, 5), between(r, 0, 0.4), between(r, 1000, 4000), 1 };
}

/* ------------------------------------------------------------------------------------------------------ scenes */

/* Stones that fall into a box of a floor and two walls. */
static void make_box(test_scene *s, uint64_t *r)
{
    const bbm_material wall = { 1e11, 0.25, 2500, 1 };
    const int stones = 3 + one_of(r, 8);
    const double half = between(r, 0.8, 2), gap = 1e-3;

    add_rectangle(s, wall, -half - 0.5, -0.5, 2 * half + 1, 0.5)->fixed = 1;
    add_rectangle(s, wall, -half - 0.5, gap, 0.5, 6)->fixed = 1;
    add_rectangle(s, wall, half, gap, 0.5, 6)->fixed = 1;
    for (int k = 0; k < stones; k++) {
        scene_block *b;
        for (double top = 1;; top += 0.05) {
            b = add_stone(s, random_rock(r), r, between(r, -half, half), between(r, 0.2, top));
            if (has_room(s, 1e-3))
                break;
            s->blocks--;
        }
        throw_block(b, r, 2, 6);
    }
}

static const struct { const char *name; void (*make)(test_scene *, uint64_t *); } KINDS[SCENE_KINDS] = {
    [SCENE_BOX] = { "box", make_box },
};

const char *scene_name(scene_kind kind) { return KINDS[kind].name; }

static void choose_parameters(test_scene *s, uint64_t *r)
{
    static const double p_n[] = { 1e6, 1e7, 1e8, 1e9, 1e9, 1e9, 1e9, 1e9, 1e10, 1e11 };
    static const double friction[] = { 0, 0, 10, 20, 30, 35 }, dt[] = { 2e-3, 5e-3, 1e-2, 1e-2, 2e-2 };

    s->par.dt = pick(r, dt, 5);
    s->par.keep = 1;
    s->par.p_n = pick(r, p_n, 10);
    s->par.p_s = s->par.p_n * between(r, 0.3, 1);
    s->par.friction = pick(r, friction, 6);
    s->par.gravity[1] = -9.81;
    s->par.pcg.tolerance = 1e-12;
    s->par.steps = 100 + one_of(r, 200);
}

void scene_make(uint64_t seed, int kind, test_scene *s)
{
    uint64_t r = seed;
    bbm_model *defaults;
    const int chosen = one_of(&r, SCENE_KINDS);

    memset(s, 0, sizeof *s);
    s->seed = seed;
    s->kind = (scene_kind)(kind < 0 ? chosen : kind);
    if (bbm_model_new(&defaults) == BBM_OK)
        s->par = defaults->par;
    bbm_model_free(defaults);
    choose_parameters(s, &r);
    KINDS[s->kind].make(s, &r);
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
    if (bbm_model_new(m))
        return BBM_NO_MEMORY;
    (*m)->par = s->par;
    for (int k = 0; k < s->blocks; k++)
        add_block(*m, k, &s->block[k]);
    return bbm_prepare(*m);
}
