/* hostile.c - scenes that a stranger would try, run by ./bbm as a user runs it, and judged by its tables alone.
 *
 *     make torture SEED=17 SCENES=1         one of them; out/hostile/17/scene.model is left to look at, its twins beside it
 *
 * A scene is drawn in units of its own: lengths and speeds of about 1, density 1. A frame writes it as a model file: in some
 * unit of length, time and mass, turned, mirrored, moved, its blocks in another order. The tables are read back through the
 * frame, so that twins can be compared number by number. Nothing here knows the library: the oracle is doc/model-file.md,
 * doc/tables.md and mechanics. */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>

enum { BLOCKS = 20, CORNERS = 10, STEPS = 60, CELLS = 2 + 2 * BLOCKS * CORNERS, CONTACTS = 500 };

static const double DEGREE = 3.14159265358979 / 180;

typedef double point[2];

typedef struct {
    int n, fixed;
    point x[CORNERS];
    double v[3], push[2];              /* velocity and spin; the way of a support */
} shape;

typedef struct {
    const char *kind;
    uint64_t state;                    /* of the random numbers */
    shape b[BLOCKS];
    int blocks, steps, is_static, slider;         /* slider: the block that slides on a plane */
    double E, nu, dt, g[2], kn, ks, friction, cohesion, shake[3], water;
} scene;

/* x_model = length Q (x + shift); speeds and gravity grow by `nudge` */
typedef struct {
    const char *name;
    double Q[2][2], shift, length, time, mass, nudge;
    int order, far;
} frame;

typedef struct {
    int status, rows;                  /* rows: of history.csv */
    char said[300];
    point path[STEPS + 1][BLOCKS][CORNERS];
    double v[BLOCKS][3], elastic, springs, up, off_cone;       /* up: reactions */
    double sum[STEPS + 1][5];          /* kinetic, elastic, springs, external, gained */
} run;

enum { REFUSED, TOO_SOFT, BROKEN, ROWS, CONE, ENERGY, WORK, MOMENTUM, SPIN, OVERLAP, THROUGH, THEORY, MIRROR, TURNED, UNITS,
       ORDER, FAR, RULES };

typedef struct {
    uint64_t seed;
    long scenes, count[RULES];
    char folder[60];
} tally;

/* ------------------------------------------------------------------------------------------------------- drawing */

/* splitmix64 */
static double draw(scene *s, double least, double most)
{
    uint64_t z = s->state += 0x9e3779b97f4a7c15u;

    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return least + (most - least) * (double)((z ^ (z >> 31)) >> 11) / 9007199254740992.0;
}

static double draw_power(scene *s, double least, double most) { return pow(10, draw(s, least, most)); }

static int chance(scene *s, double share) { return draw(s, 0, 1) < share; }

static int pick(scene *s, int least, int most) { return least + (int)draw(s, 0, most - least + 1); }

static shape *add(scene *s, int n, const point x[], int fixed)
{
    shape *b = &s->b[s->blocks++];

    b->n = n;
    b->fixed = fixed;
    memcpy(b->x, x, (size_t)n * sizeof x[0]);
    return b;
}

static shape *add_box(scene *s, double x, double y, double X, double Y, int fixed)
{
    return add(s, 4, (const point[]){ { x, y }, { X, y }, { X, Y }, { x, Y } }, fixed);
}

/* A sliver, an L, a star, a regular or an uneven polygon, within r of (x, y), that flies. */
static shape *add_odd(scene *s, double x, double y, double r, double speed)
{
    const double thin = draw_power(s, -2, -0.5), arm = draw(s, 0.2, 0.6), a = chance(s, 0.3) ? 0 : draw(s, 0, 6.28);
    const point fixed[2][6] = { { { -0.9, -thin / 3 }, { 0.9, -thin / 3 }, { 0.9, thin / 3 }, { -0.9, thin / 3 } },
        { { -0.7, -0.7 }, { 0.7, -0.7 }, { 0.7, arm - 0.7 }, { arm - 0.7, arm - 0.7 }, { arm - 0.7, 0.7 }, { -0.7, 0.7 } } };
    const int form = pick(s, 0, 4), n = form < 2 ? 4 + 2 * form : form == 2 ? 2 * pick(s, 3, 5) : pick(s, 3, 8);
    point p[CORNERS];

    for (int k = 0; k < n; k++) {
        const double b = 360 * DEGREE * (k + (form == 4 ? draw(s, -0.3, 0.3) : 0)) / n, R = form == 2 && k % 2 ? arm : 1;
        const double X = form < 2 ? fixed[form][k][0] : R * cos(b), Y = form < 2 ? fixed[form][k][1] : R * sin(b);
        p[k][0] = x + r * (X * cos(a) - Y * sin(a));
        p[k][1] = y + r * (X * sin(a) + Y * cos(a));
    }
    shape *b = add(s, n, (const point *)p, 0);
    for (int d = 0; d < 3; d++)
        b->v[d] = draw(s, -speed, speed);
    return b;
}

/* In free flight, or in a pit. */
static void draw_soup(scene *s)
{
    const int across = pick(s, 1, 4), up = pick(s, 1, 3), pit = chance(s, 0.5);

    for (int k = 0; k < across * up; k++)
        add_odd(s, k % across + 0.5, k / across + 0.5, chance(s, 0.15) ? draw_power(s, -2, -1) : draw(s, 0.15, 0.495), 1);
    if (chance(s, 0.3))
        add_box(s, -5, up + 0.01, across + 5, up + 6, 0)->v[1] = draw(s, -1, 0);
    if (pit) {
        add_box(s, -6, -1, 10, -0.01, 1);
        add_box(s, -6, -0.01, -5.1, 4, 1);
    } else if (chance(s, 0.7)) {
        s->g[1] = 0;
    }
}

/* A brick on a plane of flush slabs, level or inclined. */
static void draw_slabs(scene *s)
{
    const int n = pick(s, 1, 6);
    const double a = chance(s, 0.5) ? 0 : draw(s, 0.05, 0.8), length = 12.0 / n;

    for (int k = 0; k < n; k++)
        add_box(s, k * length - 1, -0.5, (k + 1) * length - 1, 0, 1);
    s->slider = s->blocks;
    add_box(s, 0.2, 0, draw(s, 1, 2), draw(s, 0.05, 0.3), 0)->v[0] = a > 0 && chance(s, 0.5) ? 0 : draw(s, 0.5, 1.5);
    s->g[0] = -s->g[1] * sin(a);
    s->g[1] *= cos(a);
    s->dt = fmin(s->dt, 5.0 / s->steps);
}

/* A small block flies at small ones or at a wall, up to 25 of its sizes in a step. */
static void draw_shot(scene *s)
{
    const double r = draw_power(s, -2, -0.7);
    const int n = pick(s, 1, 4), held = chance(s, 0.5), small = chance(s, 0.5);
    shape *shot = add_odd(s, 0, 0, r, 0.03);

    shot->v[0] = 1;
    s->dt = draw_power(s, -1, 1.4) * 2 * r;
    s->steps = pick(s, 2, 20);
    s->g[1] = 0;
    for (int k = 0; k < n && !small; k++)
        add_box(s, 1 + k, -8, k + draw(s, 1.02, 2), 8, held);
    for (int k = 0; k < n && small; k++)
        add_odd(s, r * (4 + 3 * k) + draw(s, 0, 1), draw(s, -r, r), r, 0)->fixed = held;
    s->blocks = small ? 2 : s->blocks;
}

static void draw_piston(scene *s)
{
    const double gap = chance(s, 0.5) ? 0 : draw(s, 0, 0.2);
    const int n = pick(s, 1, 4);
    shape *p = add_box(s, -2, 0.01, -1, 1, 1);

    p->push[0] = draw_power(s, -2, 0.3);
    p->push[1] = chance(s, 0.3) ? draw(s, 0, 0.5) : 0;
    add_box(s, -3, -1, 12, 0, 1);
    for (int k = 0; k < n; k++)
        add_box(s, k - 1 + gap * (k + 1), 0, k + gap * (k + 1), draw(s, 0.5, 1.5), 0);
}

static void draw_stack(scene *s)
{
    const int n = pick(s, 1, 4), way = pick(s, 0, 5);
    shape *table = add_box(s, -2, -0.5, 6, 0, 1);

    s->friction = draw(s, 20, 50);
    for (int k = 0; k < n; k++)
        for (int i = 0; i < 5 - k; i++)
            add_box(s, i + k * 0.5, k * 0.5, i + 1 + k * 0.5, k * 0.5 + 0.5, 0);
    s->shake[0] = way == 0 ? draw(s, -2, 2) * s->g[1] : 0;
    s->shake[2] = way == 0 ? draw_power(s, -1, 0) / s->dt : 0;
    s->water = way == 1 ? draw(s, 0.1, 3) : 0;
    s->cohesion = way == 2 ? s->E * draw_power(s, -5, -2) : 0;
    table->push[0] = way == 3 ? draw(s, -0.3, 0.3) : 0;
    s->is_static = way == 4;
}

static void draw_wedge(scene *s)
{
    const double open = draw(s, 0.2, 1.5), up = draw(s, 0, 0.2);
    const int held = chance(s, 0.5);

    add(s, 4, (const point[]){ { -3, 0 }, { 0, 0 }, { -open, 2 }, { -3, 2 } }, held);
    add(s, 4, (const point[]){ { 0, 0 }, { 3, 0 }, { 3, 2 }, { open, 2 } }, held);
    add(s, 3, (const point[]){ { 0, up }, { open, 2 + up }, { -open, 2 + up } }, 0)->v[1] = -draw(s, 0, 1);
    add_box(s, -9, -1, 9, 0, 1);
}

/* A row of blocks that cohesion keeps together flies and turns as one, and something may hit it. */
static void draw_weld(scene *s)
{
    const int n = pick(s, 2, 6);
    const double w = draw(s, -1, 1);

    for (int k = 0; k < n; k++)
        memcpy(add_box(s, k, 0, k + 1, 1, 0)->v, (double[3]){ 0, w * (k + 0.5 - n / 2.0), w }, sizeof s->b[0].v);
    s->cohesion = s->E * draw_power(s, -2, 1);
    s->g[1] = 0;
    if (chance(s, 0.5))
        add_odd(s, draw(s, 0, n), 2.6, 0.5, 0.5)->v[1] = -1;
}

static void draw_scene(scene *s, uint64_t seed)
{
    static const struct { const char *name; void (*draw)(scene *); } kind[] = { { "soup", draw_soup }, { "slabs", draw_slabs },
        { "shot", draw_shot }, { "piston", draw_piston }, { "stack", draw_stack }, { "wedge", draw_wedge }, { "weld", draw_weld } };

    memset(s, 0, sizeof *s);
    s->state = seed * 1000003;
    const int k = pick(s, 0, 6);
    s->kind = kind[k].name;
    s->E = draw_power(s, 3, 9);
    s->nu = draw(s, 0, 0.45);
    s->kn = s->E * draw_power(s, -0.5, 2);
    s->ks = s->kn * draw(s, 0.2, 1);
    s->dt = draw_power(s, -2.5, -0.7);
    s->steps = pick(s, 10, STEPS);
    s->friction = chance(s, 0.2) ? 0 : draw(s, 0, 50);
    s->g[1] = -draw_power(s, -1, 1);
    kind[k].draw(s);
}

/* ------------------------------------------------------------------------------------------------------- writing */

static void turn(const frame *f, const double x[2], int inverse, double y[2])
{
    const double a = x[0], b = x[1];

    y[0] = a * f->Q[0][0] + b * f->Q[inverse][!inverse];
    y[1] = a * f->Q[!inverse][inverse] + b * f->Q[1][1];
}

static double handed(const frame *f) { return f->Q[0][0] * f->Q[1][1] - f->Q[0][1] * f->Q[1][0]; }

static void write_vector(FILE *o, const frame *f, const char *text, const double x[2], double shift, double unit)
{
    double y[2];

    turn(f, (const point){ x[0] + shift, x[1] + shift }, 0, y);
    fprintf(o, "%s%.17g %.17g", text, unit * y[0], unit * y[1]);
}

static void write_block(FILE *o, const scene *s, const frame *f, int k)
{
    const shape *b = &s->b[k];
    double p[2];

    fprintf(o, "\nblock b%d rock", k);
    for (int c = 0; c < b->n; c++)
        write_vector(o, f, "  ", b->x[(c + f->order) % b->n], f->shift, f->length);
    if (b->fixed)
        fprintf(o, "\nfixblock b%d", k);
    turn(f, b->push, 0, p);
    if (p[0] != 0 || p[1] != 0)
        fprintf(o, "\nfix set b%d x by %.17g y by %.17g", k, f->length * p[0], f->length * p[1]);
    fprintf(o, "\nvelocity b%d", k);
    write_vector(o, f, " ", b->v, 0, f->length / f->time * f->nudge);
    fprintf(o, " %.17g", b->v[2] * handed(f) / f->time * f->nudge);
    if (s->water > 0 && b->x[0][1] < s->water && !b->fixed)
        fprintf(o, "\nwater set b%d %.17g density %.17g", k, f->length * (s->water + f->shift), f->mass / pow(f->length, 3) / 2.5);
}

static void write_model(FILE *o, const scene *s, const frame *f)
{
    const double spring = f->mass / f->time / f->time, pascal = spring / f->length, gravity = f->length / f->time / f->time;

    fprintf(o, "title %s %s\nmaterial rock E %.17g nu %.17g density %.17g thickness %.17g\n", s->kind, f->name, s->E * pascal, s->nu,
            f->mass / pow(f->length, 3), f->length);
    fprintf(o, "contact kn %.17g ks %.17g friction %.17g cohesion %.17g tension %.17g\n", s->kn * spring, s->ks * spring, s->friction,
            s->cohesion * pascal, s->cohesion * pascal / 2);
    if (s->is_static)
        fprintf(o, "static steps 20 tolerance 1e-6\n");
    else
        fprintf(o, "dynamic dt %.17g steps %d\n", s->dt * f->time, s->steps);
    write_vector(o, f, "pcg tolerance 1e-12\ngravity ", s->g, 0, gravity * f->nudge);
    if (s->shake[2] > 0)
        write_vector(o, f, "\nshake ", s->shake, 0, gravity), fprintf(o, " %.17g", s->shake[2] / f->time);
    for (int i = 0, node = 1; i < s->blocks; i++) {
        const int k = f->order ? s->blocks - 1 - i : i;
        write_block(o, s, f, k);
        for (int c = 0; c < s->b[k].n; c++)
            fprintf(o, "\nmonitor m%d.%d node %d", k, (c + f->order) % s->b[k].n, node++);
    }
    for (int k = 0; k < f->far; k++) {
        fprintf(o, "\nfixblock far%d\nblock far%d rock", k, k);
        for (int c = 0; c < 3; c++)
            write_vector(o, f, "  ", (const point){ 1e4 + c % 2, 1e3 * k + c / 2 }, f->shift, f->length);
    }
    fprintf(o, "\n");
}

/* ------------------------------------------------------------------------------------------------------- reading */

/* Rows of the table as numbers; of a block b7, 7; of any other word, -1. */
static int read_table(const char *folder, const char *name, int columns, int most, double *cell)
{
    static char line[26 * CELLS];
    int rows = 0;

    snprintf(line, sizeof line, "%s/out/%s.csv", folder, name);
    FILE *f = fopen(line, "r");
    while (f && rows <= most && fgets(line, sizeof line, f)) {
        char *p = strtok(line, ",\n");
        for (int c = 0; rows > 0 && c < columns && p; c++, p = strtok(NULL, ",\n"))
            cell[(rows - 1) * columns + c] = *p == 'b' ? atof(p + 1) : (*p >= 'A' && *p != 'n') ? -1 : atof(p);
        rows++;
    }
    if (f)
        fclose(f);
    return rows - 1;
}

/* Area, barycentre and polar moment of area about it. */
static double measure(const point x[], int n, double c[2], double *polar)
{
    double A = 0, X = 0, Y = 0, I = 0;

    for (int k = 0; k < n; k++) {
        const double a = x[k][0] - x[0][0], b = x[k][1] - x[0][1];
        const double p = x[(k + 1) % n][0] - x[0][0], q = x[(k + 1) % n][1] - x[0][1], z = a * q - b * p;
        A += z / 2;
        X += z * (a + p) / 6;
        Y += z * (b + q) / 6;
        I += z * (a * a + a * p + p * p + b * b + b * q + q * q) / 12;
    }
    c[0] = x[0][0] + X / A;
    c[1] = x[0][1] + Y / A;
    *polar = fabs(I - (X * X + Y * Y) / A);
    return fabs(A);
}

static void read_tables(const char *folder, const scene *s, const frame *f, run *r)
{
    static double t[(STEPS + 1) * CELLS];
    const double newton = f->mass * f->length / f->time / f->time, joule = newton * f->length;
    const double pascal = newton / f->length / f->length, speed = f->length / f->time;
    double c[2], I, v[2];
    int width = 2;

    for (int k = 0; k < s->blocks; k++)
        width += 2 * s->b[k].n;
    r->rows = read_table(folder, "history", width, STEPS + 1, t);
    for (int row = 0; row < r->rows; row++)
        for (int i = 0, j = row * width + 2; i < s->blocks; i++)
            for (int e = 0, k = f->order ? s->blocks - 1 - i : i; e < s->b[k].n; e++, j += 2) {
                const int corner = (e + f->order) % s->b[k].n;
                turn(f, (const point){ t[j] / f->length, t[j + 1] / f->length }, 1, r->path[row][k][corner]);
                for (int d = 0; d < 2; d++)
                    r->path[row][k][corner][d] += s->b[k].x[corner][d];
            }
    for (int k = read_table(folder, "summary", 11, STEPS, t) - 1; k >= 0; k--)
        for (int i = 0; i < 5; i++)
            r->sum[k + 1][i] = t[11 * k + 6 + i] / joule;
    for (int k = read_table(folder, "elements", 14, BLOCKS, t) - 1; k >= 0; k--) {
        const double *e = &t[14 * k], a = (e[7] + e[8]) / 2 / pascal, b = hypot((e[7] - e[8]) / 2, e[9]) / pascal;
        if (e[1] < 0)
            continue;
        const int block = (int)e[1];
        r->elastic += measure(s->b[block].x, s->b[block].n, c, &I) * (a * a * (1 - s->nu) + b * b * (1 + s->nu)) / s->E;
        turn(f, (const point){ e[11] / speed, e[12] / speed }, 1, v);
        memcpy(r->v[block], (double[3]){ v[0], v[1], e[13] * f->time * handed(f) }, sizeof r->v[block]);
    }
    for (int k = read_table(folder, "contacts", 8, CONTACTS, t) - 1; k >= 0; k--) {
        const double N = t[8 * k + 5] / newton, T = t[8 * k + 6] / newton;
        r->springs += N * N / (2 * s->kn) + T * T / (2 * s->ks);
        r->off_cone = fmax(r->off_cone, (fmax(-N, fabs(T) - tan(s->friction * DEGREE) * N)) / sqrt(s->kn));
    }
    for (int k = read_table(folder, "reactions", 5, CONTACTS, t) - 1; k >= 0; k--) {
        turn(f, (const point){ t[5 * k + 3] / newton, t[5 * k + 4] / newton }, 1, v);
        r->up += v[1];
    }
}

static void try_frame(const scene *s, const frame *f, const char *folder, run *r)
{
    char text[400];

    memset(r, 0, sizeof *r);
    snprintf(text, sizeof text, "%s/%s.model", folder, f->name);
    FILE *o = fopen(text, "w");
    if (!o)
        exit(2);
    write_model(o, s, f);
    fclose(o);
    snprintf(text, sizeof text, "cd %s; rm -rf out; ulimit -t 60; ../../../bbm -q %s.model -o out > said 2>&1; echo $?", folder,
             f->name);
    o = popen(text, "r");
    while (o && fgets(text, sizeof text, o))
        r->status = atoi(text);
    pclose(o);
    snprintf(text, sizeof text, "%s/said", folder);
    for (o = fopen(text, "r"); o && fgets(text, sizeof text, o);)
        if (!strstr(text, "arning"))
            snprintf(r->said, sizeof r->said, "%.*s", (int)fmin(299, (double)strcspn(text, "\n")), text);
    if (o)
        fclose(o);
    read_tables(folder, s, f, r);
}

/* ------------------------------------------------------------------------------------------------------- geometry */

/* How far the place p is inside the polygon; 0 outside. */
static double depth_of(double X, double Y, const point x[], int n)
{
    double least = INFINITY;
    int inside = 0;

    for (int k = 0; k < n; k++) {
        const double *a = x[k], *b = x[(k + 1) % n], p = b[0] - a[0], q = b[1] - a[1];
        const double t = fmin(1, fmax(0, ((X - a[0]) * p + (Y - a[1]) * q) / (p * p + q * q)));
        least = fmin(least, hypot(X - a[0] - t * p, Y - a[1] - t * q));
        inside ^= (a[1] > Y) != (b[1] > Y) && X < a[0] + (Y - a[1]) / q * p;
    }
    return inside ? least : 0;
}

/* The deepest place of the rim of x inside y: whoever parts the two has to move them at least as far. */
static double rim_depth(const point x[], int n, const point y[], int m)
{
    double most = 0;

    for (int k = 0; k < 16 * n; k++) {
        const double *a = x[k / 16], *b = x[(k / 16 + 1) % n], t = k % 16 / 16.0;
        most = fmax(most, depth_of(a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]), y, m));
    }
    return most;
}

/* How deep the barycentre of block i passes through block j from one row to the next, seen from j, if it is outside before
 * and after. Straight: where j turns far within the step it is not judged. */
static double deepest_pass(const scene *s, const run *r, int row, int i, int j)
{
    const point *x = (const point *)r->path[row][j], *X = (const point *)r->path[row + 1][j];
    const int n = s->b[j].n;
    double a[2], A[2], b[2], B[2], I, most = 0;

    measure((const point *)r->path[row][i], s->b[i].n, a, &I);
    measure((const point *)r->path[row + 1][i], s->b[i].n, A, &I);
    measure(x, n, b, &I);
    measure(X, n, B, &I);
    const double w = atan2(X[0][1] - B[1], X[0][0] - B[0]) - atan2(x[0][1] - b[1], x[0][0] - b[0]), u = A[0] - B[0], v = A[1] - B[1];
    if (cos(w) < 0.9 || depth_of(a[0], a[1], x, n) > 0 || depth_of(A[0], A[1], X, n) > 0)
        return 0;
    const double p = b[0] + cos(w) * u + sin(w) * v - a[0], q = b[1] + cos(w) * v - sin(w) * u - a[1];
    for (double t = 0.02; t < 1; t += 0.02)
        most = fmax(most, depth_of(a[0] + t * p, a[1] + t * q, x, n));
    return most;
}

/* ------------------------------------------------------------------------------------------------------- judging */

static const char *rule_name(int rule)
{
    static const char *const name[RULES] = { "refused", "too soft", "broken off, or no reason given", "rows of history.csv",
        "friction beyond its cone", "energy", "`external` beside own sums", "momentum", "angular momentum", "overlap", "passed through",
        "theory", "mirrored twin", "turned twin", "twin in other units", "twin in another order", "twin with things far away" };
    return name[rule];
}

static void report(tally *t, const scene *s, int rule, const char *said)
{
    t->count[rule]++;
    printf("seed %llu %s: %s: %s\n", (unsigned long long)t->seed, s->kind, rule_name(rule), said);
}

/* Once for each rule and scene. */
static int judge(tally *t, const scene *s, int rule, double value, double bound, int row)
{
    char said[100];

    if (!(value > bound))
        return 0;
    snprintf(said, sizeof said, "%.3g, at most %.3g, row %d", value, bound, row);
    report(t, s, rule, said);
    return 1;
}

/* A spring holds no more than the energy of all of them. */
static void judge_overlap(tally *t, const scene *s, const run *r)
{
    double springs = 0, c[2], I;
    int found = 0;

    for (int row = 0; row + 1 < r->rows && !found; row++) {
        springs = fmax(springs, r->sum[row + 1][2]);
        const double allowed = 1.5 * sqrt(2 * springs / s->kn) + 1e-6;
        for (int k = 0; k < s->blocks * s->blocks && !found; k++) {
            const int i = k / s->blocks, j = k % s->blocks, n = s->b[i].n;
            const point *x = (const point *)r->path[row + 1][i], *y = (const point *)r->path[row + 1][j];
            if (i == j || (s->b[i].fixed && s->b[j].fixed))
                continue;
            const double bound = 0.1 * sqrt(measure(x, n, c, &I)) + allowed;
            found = judge(t, s, OVERLAP, rim_depth(x, n, y, s->b[j].n), allowed, row + 1)
                    || judge(t, s, THROUGH, deepest_pass(s, r, row, i, j), bound, row + 1);
        }
    }
}

typedef struct { double mass, C[2], P[2], size, K, L, L_size, I, turning, work; } ledger;

/* Of all blocks: mass, barycentre, momentum, its parts as positive numbers, energy, angular momentum about the barycentre,
 * its parts, the moment of inertia, how much of it a step of second order may miss, and the work of gravity since row 0. */
static ledger balance(const scene *s, const run *r, int row, const double (*v)[3])
{
    ledger l = { 0 };
    double c[BLOCKS][2], o[2], m[BLOCKS], I[BLOCKS], J;

    for (int k = 0; k < s->blocks; k++) {
        m[k] = measure(s->b[k].x, s->b[k].n, o, &J);
        measure((const point *)r->path[0][k], s->b[k].n, o, &J);
        I[k] = m[k] / measure((const point *)r->path[row][k], s->b[k].n, c[k], &J);
        I[k] *= J;
        l.mass += m[k];
        for (int d = 0; d < 2; d++) {
            l.P[d] += m[k] * v[k][d];
            l.C[d] += m[k] * c[k][d];
            l.work += m[k] * s->g[d] * (c[k][d] - o[d]);
        }
        l.size += m[k] * hypot(v[k][0], v[k][1]);
        l.K += m[k] * (v[k][0] * v[k][0] + v[k][1] * v[k][1]) / 2 + I[k] * v[k][2] * v[k][2] / 2;
    }
    for (int k = 0; k < s->blocks; k++) {
        const double x = c[k][0] - l.C[0] / l.mass, y = c[k][1] - l.C[1] / l.mass, w = v[k][2];
        l.L += m[k] * (x * v[k][1] - y * v[k][0]) + I[k] * w;
        l.L_size += m[k] * hypot(x, y) * hypot(v[k][0], v[k][1]) + I[k] * fabs(w);
        l.I += m[k] * (x * x + y * y) + I[k];
        l.turning += I[k] * fabs(w) * w * w * s->dt * s->dt;
    }
    return l;
}

/* Where nothing is fixed momentum stays but for gravity. Strain rates are not in the tables: their angular momentum is at
 * most sqrt(2 I K), K the kinetic energy that velocities and spins leave over. */
static void judge_balance(tally *t, const scene *s, const run *r, int fixed)
{
    double v[BLOCKS][3], size = 1e-12, most = 0, off = 0;
    const int end = r->rows - 1;

    for (int k = 0; k < s->blocks; k++)
        memcpy(v[k], s->b[k].v, sizeof v[k]);
    const ledger a = balance(s, r, 0, (const double (*)[3])v), z = balance(s, r, end, r->v);
    const double *last = r->sum[end], W = s->water > 0 ? last[3] : z.work, T = end * s->dt;
    for (int row = 1; row <= end; row++) {
        const double *e = r->sum[row], E = e[0] + e[1] + e[2];
        size = fmax(size, fmax(a.K, E) + fabs(e[3]));
        most = fmax(most, (E - e[3] - a.K) / size);
    }
    judge(t, s, ENERGY, fmax(most, (z.K + r->elastic + r->springs - W - a.K) / size), 0.01, end);
    judge(t, s, WORK, fabs(W - last[3]) / size, 1e-4, end);
    const double weight = a.mass * hypot(s->g[0], s->g[1]) * T + 1e-12;
    for (int d = 0; d < 2; d++)
        off = fmax(off, fabs(z.P[d] - a.P[d] - a.mass * s->g[d] * T));
    if (fixed)
        return;
    judge(t, s, MOMENTUM, off / (a.size + z.size + weight), 1e-6, end);
    judge(t, s, SPIN, fabs(z.L - a.L), 1e-5 * (a.L_size + z.L_size) + sqrt(2 * z.I * fmax(0, last[0] - z.K)) + a.turning + z.turning,
          end);
}

/* A block that slides on a plane, but for what springs and elements yield: x'' = g_x - g_y tan phi until it sticks. */
static void judge_slider(tally *t, const scene *s, const run *r)
{
    const shape *b = &s->b[s->slider];
    const double along = s->g[0], hold = -s->g[1] * tan(s->friction * DEGREE), V = b->v[0], T = (r->rows - 1) * s->dt;
    const double a = along - hold, stop = a < 0 ? fmin(T, -V / a) : T, way = V * stop + a * stop * stop / 2;
    double o[2], c[2], I;
    const double A = measure(b->x, b->n, o, &I);

    measure((const point *)r->path[r->rows - 1][s->slider], b->n, c, &I);
    if (way < 9)
        judge(t, s, THEORY, fabs(c[0] - o[0] - way), 0.02 * way + 0.5 * V * s->dt + 20 * A * hypot(along, s->g[1]) * (1 / s->ks + 10 / s->E),
              r->rows - 1);
}

static void judge_scene(tally *t, const scene *s, const run *r)
{
    int fixed = 0, moving = s->shake[2] > 0;
    double c[2], I, weight = 0;

    for (int k = 0; k < s->blocks; k++) {
        fixed |= s->b[k].fixed;
        moving |= s->b[k].push[0] != 0 || s->b[k].push[1] != 0;
        weight -= measure(s->b[k].x, s->b[k].n, c, &I) * s->g[1];
    }
    judge_overlap(t, s, r);
    if (s->is_static)
        judge(t, s, THEORY, fabs(r->up - weight), 1e-3 * weight, 0);
    else if (!judge(t, s, ROWS, abs(r->rows - s->steps - 1), 0, 0) && !moving)
        judge_balance(t, s, r, fixed);
    if (s->cohesion == 0)
        judge(t, s, CONE, r->off_cone, 1e-4 * sqrt(2 * r->springs), r->rows - 1);
    if (s->slider > 0)
        judge_slider(t, s, r);
}

static double apart(const scene *s, const run *p, const run *q, int row)
{
    double most = 0;

    for (int k = 0; k < s->blocks; k++)
        for (int c = 0; c < s->b[k].n; c++)
            most = fmax(most, hypot(p->path[row][k][c][0] - q->path[row][k][c][0], p->path[row][k][c][1] - q->path[row][k][c][1]));
    return most;
}

/* A twin differs by rounding, 1e-14 or so. What that does in this scene shows a run turned by 1e-9, with speeds and gravity
 * larger by 1e-9: a twin may be off by three times as much, and by half of what a spring yields, since rounding decides which
 * of the contacts of a tie carries. */
static void judge_twin(tally *t, const scene *s, int rule, const run *r, const run *twin, const run *nudged)
{
    double allowed = 0;

    if (twin->status != r->status && nudged->status == r->status)
        report(t, s, rule, twin->status ? twin->said : "runs, the scene does not");
    for (int row = 0; row < r->rows && row < twin->rows && row < nudged->rows; row++) {
        const double springs = fmax(r->sum[row][2], r->sum[row + (row + 1 < r->rows)][2]);
        allowed = fmax(allowed, 3 * apart(s, r, nudged, row) + 1e-6 + 0.5 * sqrt(2 * springs / s->ks));
        if (judge(t, s, rule, apart(s, r, twin, row), allowed, row))
            return;
    }
}

static void try_scene(tally *t)
{
    static run r, twin, nudged;
    scene s;

    draw_scene(&s, t->seed);
    const double first = s.water > 0 || chance(&s, 0.4) ? 0 : draw(&s, 0, 6.28), more = s.water > 0 ? 0 : draw(&s, 0.1, 6);
    frame f = { "scene", { { cos(first), -sin(first) }, { sin(first), cos(first) } }, 0, draw_power(&s, -3, 3), draw_power(&s, -3, 1),
                draw_power(&s, -3, 6), 1, 0, 0 };
    frame g[6] = { f, f, f, f, f, f };
    g[0].name = "mirrored", g[0].Q[0][0] *= -1, g[0].Q[0][1] *= -1;
    g[1].name = "turned", g[1].shift = draw(&s, -50, 50);
    g[1].Q[0][0] = g[1].Q[1][1] = cos(first + more), g[1].Q[1][0] = sin(first + more), g[1].Q[0][1] = -g[1].Q[1][0];
    g[2].name = "units", g[2].length = draw_power(&s, -3, 3), g[2].time = draw_power(&s, -3, 1), g[2].mass = draw_power(&s, -3, 6);
    g[3].name = "order", g[3].order = 1;
    g[4].name = "far", g[4].far = 3;
    g[5].name = "nudged", g[5].nudge = 1 + 1e-9, g[5].Q[1][0] += 1e-9, g[5].Q[0][1] -= 1e-9;
    t->scenes++;
    try_frame(&s, &f, t->folder, &r);
    if (r.status == 0)
        judge_scene(t, &s, &r);
    else
        report(t, &s, r.status != 1 || strlen(r.said) < 40 ? BROKEN : strstr(r.said, "too soft") ? TOO_SOFT : REFUSED, r.said);
    try_frame(&s, &g[5], t->folder, &nudged);
    for (int k = 0; k < 5; k++) {
        try_frame(&s, &g[k], t->folder, &twin);
        judge_twin(t, &s, MIRROR + k, &r, &twin, &nudged);
    }
}

/* hostile [seed [scenes [seconds]]], scenes 0: until the time is over */
int main(int count, char **argument)
{
    tally t = { .seed = count > 1 ? strtoull(argument[1], NULL, 10) : 1 };
    const int scenes = count > 2 ? atoi(argument[2]) : 0;
    const double seconds = count > 3 ? atof(argument[3]) : 60;
    const time_t start = time(NULL);
    long findings = 0;

    setvbuf(stdout, NULL, _IOLBF, BUFSIZ);
    snprintf(t.folder, sizeof t.folder, "out/hostile/%llu", (unsigned long long)t.seed);
    for (int k = 0; k < 3; k++)
        mkdir(k == 0 ? "out" : k == 1 ? "out/hostile" : t.folder, 0777);
    for (int k = 0; (scenes == 0 || k < scenes) && difftime(time(NULL), start) < seconds; k++, t.seed++)
        try_scene(&t);
    printf("\n%ld hostile scenes\n", t.scenes);
    for (int rule = 0; rule < RULES; rule++) {
        findings += rule > TOO_SOFT ? t.count[rule] : 0;
        if (t.count[rule] > 0)
            printf("    %-30s %ld, %.1f in a hundred\n", rule_name(rule), t.count[rule], 100.0 * (double)t.count[rule] / (double)t.scenes);
    }
    return findings > 0 || t.count[REFUSED] * 100 > 3 * t.scenes;
}
