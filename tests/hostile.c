/* hostile.c - scenes that a stranger would try, run by ./bbm as a user runs it, and judged by its
 * tables alone: the oracle is doc/model-file.md, doc/tables.md and mechanics.
 *
 *     make torture SEED=17 SCENES=1    leaves out/hostile/17/scene.model to look at, and its twins
 *
 * A scene is drawn in units of its own: lengths and speeds of about 1, density 1. A frame writes it
 * as a model file: in some unit of length, time and mass, turned, mirrored, its blocks in another
 * order. The tables are read back through the frame, so that twins can be compared. */
#define _POSIX_C_SOURCE 200809L         /* popen, mkdir */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>

enum { BLOCKS = 20, CORNERS = 10, STEPS = 60, CELLS = 2 + 2 * BLOCKS * CORNERS, ROWS = 500 };

typedef double point[2];

typedef struct {
    int n, fixed;
    point x[CORNERS];
    double v[3], push;                 /* velocity and spin; the way of a support along x */
} shape;

typedef struct {
    uint64_t seed, state;              /* of the random numbers */
    const char *kind;
    shape b[BLOCKS];
    int blocks, steps, slider, moving; /* slider: the block that slides on a plane */
    double E, nu, dt, g[2], kn, ks, friction, cohesion, shake, water;
} scene;

/* x_model = length Q x; speeds and gravity grow by `nudge` */
typedef struct {
    const char *name;
    double Q[2][2], length, time, mass, nudge;
    int order, far;
} frame;

typedef struct {
    int status, rows;                  /* rows: of history.csv */
    char said[300];
    point path[STEPS + 1][BLOCKS][CORNERS];
    double v[BLOCKS][3], elastic, springs, off_cone;
    double sum[STEPS + 1][5];          /* kinetic, elastic, springs, external, gained */
} run;

enum { REFUSED, SOFT, BROKEN, CONE, ENERGY, WORK, MOMENTUM, SPIN, OVERLAP, THEORY, TWIN,
RULES = TWIN + 5 };

static const char *const RULE[RULES] = { "refused", "too soft", "broken off",
    "beyond the friction cone",
    "energy", "`external` beside own sums", "momentum", "angular momentum", "overlap", "theory",
    "mirrored", "turned", "in other units", "in another order", "with things far away" };

/* ------------------------------------------------------------------------------------ drawing */

/* splitmix64 */
static double draw(scene *s, double least, double most)
{
    uint64_t z = s->state += 0x9e3779b97f4a7c15u;

    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return least + (most - least) * (double)((z ^ (z >> 31)) >> 11) / 9007199254740992.0;
}

static double power(scene *s, double least, double most) { return pow(10, draw(s, least, most)); }
static int chance(scene *s, double share) { return draw(s, 0, 1) < share; }
static int pick(scene *s, int least, int most) { return (int)draw(s, least, most + 1); }

static shape *add(scene *s, int n, const point x[], int fixed)
{
    shape *b = &s->b[s->blocks++];

    b->n = n;
    b->fixed = fixed;
    memcpy(b->x, x, (size_t)n * sizeof x[0]);
    return b;
}

static shape *box(scene *s, double x, double y, double X, double Y, int fixed)
{
    return add(s, 4, (const point[]){ { x, y }, { X, y }, { X, Y }, { x, Y } }, fixed);
}

/* A polygon, a star or an L within r of (x, y), as it is or flattened to a sliver; it flies. */
static shape *add_odd(scene *s, double x, double y, double r, double speed)
{
    static const point l[] = { { -.7, -.7 }, { .7, -.7 }, { .7, 0 }, { 0, 0 }, { 0, .7 }, { -.7,
        .7 } };
    const double flat = chance(s, 0.7) ? 1 : power(s, -2, -0.5), a = chance(s, 0.3) ? 0 : draw(s,
                 0, 6);
    const int form = pick(s, 0, 2), n = form == 0 ? 6 : form == 1 ? 2 * pick(s, 3, 5) : pick(s, 3,
        8);
    const double arm = form == 1 ? draw(s, 0.2, 0.6) : 1;
    point p[CORNERS];

    for (int k = 0; k < n; k++) {
        const double b = 6.2831853 * k / n, R = k % 2 ? arm : 1;
        const double X = form ? R * cos(b) : l[k][0], Y = flat * (form ? R * sin(b) : l[k][1]);
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
        add_odd(s, k % across + 0.5, k / across + 0.5, 0.5 * power(s, chance(s, 0.2) ? -2 : -0.3,
            0), 1);
    if (chance(s, 0.3))
        box(s, -5, up + 0.01, across + 5, up + 6, 0)->v[1] = draw(s, -1, 0);
    if (pit)
        box(s, -6, -1, 10, -0.01, 1);
    else if (chance(s, 0.7))
        s->g[1] = 0;
}

/* A brick on a plane of flush slabs, level or inclined. */
static void draw_slabs(scene *s)
{
    const int n = pick(s, 1, 6);
    const double a = chance(s, 0.5) ? 0 : draw(s, 0.05, 0.8), l = 12.0 / n;

    for (int k = 0; k < n; k++)
        box(s, k * l - 1, -0.5, (k + 1) * l - 1, 0, 1);
    s->slider = s->blocks;
    box(s, 0.2, 0, draw(s, 1, 2), draw(s, 0.05, 0.3), 0)->v[0] = a > 0 ? 0 : draw(s, 0.5, 1.5);
    s->g[0] = -s->g[1] * sin(a);
    s->g[1] *= cos(a);
    s->dt = fmin(s->dt, 5.0 / s->steps);
}

/* A small block flies at another one or at walls, up to 25 of its sizes in a step. */
static void draw_shot(scene *s)
{
    const double r = power(s, -2, -0.7);
    const int held = chance(s, 0.5);

    add_odd(s, 0, 0, r, 0.03)->v[0] = 1;
    s->dt = power(s, -1, 1.4) * 2 * r;
    s->steps = pick(s, 2, 20);
    s->g[1] = 0;
    if (chance(s, 0.5))
        add_odd(s, 3 * r + draw(s, 0, 1), draw(s, -r, r), r, 0)->fixed = held;
    else
        for (int k = pick(s, 1, 4); k > 0; k--)
            box(s, k, -8, k + draw(s, 0.02, 1), 8, held);
}

static void draw_piston(scene *s)
{
    const double gap = chance(s, 0.5) ? 0 : draw(s, 0, 0.2);

    s->moving = 1;
    box(s, -2, 0.01, -1, 1, 1)->push = power(s, -2, 0.3);
    box(s, -3, -1, 12, 0, 1);
    for (int k = pick(s, 1, 4); k > 0; k--)
        box(s, k - 2 + gap * k, 0, k - 1 + gap * k, draw(s, 0.5, 1.5), 0);
}

/* Still, shaken, in water, glued, on a table that moves. */
static void draw_stack(scene *s)
{
    const int way = pick(s, 0, 4);
    shape *table = box(s, -2, -0.5, 6, 0, 1);

    for (int k = pick(s, 0, 3); k >= 0; k--)
        for (int i = 0; i < 5 - k; i++)
            box(s, i + k * 0.5, k * 0.5, i + 1 + k * 0.5, k * 0.5 + 0.5, 0);
    s->moving = way == 0 || way == 3;
    s->shake = way == 0 ? draw(s, -2, 2) * s->g[1] : 0;
    s->water = way == 1 ? draw(s, 0.1, 3) : 0;
    s->cohesion = way == 2 ? s->E * power(s, -5, -2) : 0;
    table->push = way == 3 ? draw(s, -0.3, 0.3) : 0;
}

static void draw_wedge(scene *s)
{
    const double a = draw(s, 0.2, 1.5), up = draw(s, 0, 0.2);
    const int held = chance(s, 0.5);

    add(s, 4, (const point[]){ { -3, 0 }, { 0, 0 }, { -a, 2 }, { -3, 2 } }, held);
    add(s, 4, (const point[]){ { 0, 0 }, { 3, 0 }, { 3, 2 }, { a, 2 } }, held);
    add(s, 3, (const point[]){ { 0, up }, { a, 2 + up }, { -a, 2 + up } }, 0)->v[1] = -draw(s, 0,
        1);
    box(s, -9, -1, 9, 0, 1);
}

/* A row of blocks that cohesion keeps together flies and turns as one; something may hit it. */
static void draw_weld(scene *s)
{
    const int n = pick(s, 2, 6);
    const double w = draw(s, -1, 1);

    for (int k = 0; k < n; k++)
        memcpy(box(s, k, 0, k + 1, 1, 0)->v, (point){ 0, w * (k + 0.5 - n / 2.0) }, sizeof(point));
    for (int k = 0; k < n; k++)
        s->b[k].v[2] = w;
    s->cohesion = s->E * power(s, -2, 1);
    s->g[1] = 0;
    if (chance(s, 0.5))
        add_odd(s, draw(s, 0, n), 2.6, 0.5, 0.5)->v[1] = -1;
}

static void draw_scene(scene *s, uint64_t seed)
{
    static const struct { const char *name; void (*draw)(scene *); } kind[] = {
        { "soup", draw_soup }, { "slabs", draw_slabs }, { "shot", draw_shot }, { "piston",
            draw_piston },
        { "stack", draw_stack }, { "wedge", draw_wedge }, { "weld", draw_weld } };

    memset(s, 0, sizeof *s);
    s->seed = seed;
    s->state = seed * 1000003;
    const int k = pick(s, 0, 6);
    s->kind = kind[k].name;
    s->E = power(s, 3, 9);
    s->nu = draw(s, 0, 0.45);
    s->kn = s->E * power(s, -0.5, 2);
    s->ks = s->kn * draw(s, 0.2, 1);
    s->dt = power(s, -2.5, -0.7);
    s->steps = pick(s, 10, STEPS);
    s->friction = chance(s, 0.2) ? 0 : draw(s, 0, 50);
    s->g[1] = -power(s, -1, 1);
    kind[k].draw(s);
}

/* ------------------------------------------------------------------------------------ writing */

static void turn(const frame *f, const double x[2], int back, double unit, double y[2])
{
    const double a = x[0] * unit, b = x[1] * unit;

    y[0] = a * f->Q[0][0] + b * f->Q[back][!back];
    y[1] = a * f->Q[!back][back] + b * f->Q[1][1];
}

static double handed(const frame *f) { return f->Q[0][0] * f->Q[1][1] - f->Q[0][1] * f->Q[1][0]; }

static void write_vector(FILE *o, const frame *f, const char *text, double x, double y, double unit)
{
    double z[2];

    turn(f, (const point){ x, y }, 0, unit, z);
    fprintf(o, "%s %.17g %.17g", text, z[0], z[1]);
}

static void write_block(FILE *o, const scene *s, const frame *f, int k)
{
    const shape *b = &s->b[k];
    double p[2];

    fprintf(o, "\nblock b%d rock", k);
    for (int c = 0; c < b->n; c++) {
        const double *x = b->x[(c + f->order) % b->n];
        write_vector(o, f, " ", x[0], x[1], f->length);
    }
    turn(f, (const point){ b->push, 0 }, 0, f->length, p);
    if (b->fixed)
        fprintf(o, "\nfixblock b%d", k);
    if (b->push != 0)
        fprintf(o, "\nfix set b%d x by %.17g y by %.17g", k, p[0], p[1]);
    fprintf(o, "\nvelocity b%d", k);
    write_vector(o, f, "", b->v[0], b->v[1], f->length / f->time * f->nudge);
    fprintf(o, " %.17g", b->v[2] * handed(f) / f->time * f->nudge);
    if (s->water > b->x[0][1] && s->water > 0 && !b->fixed)
        fprintf(o, "\nwater set b%d %.17g density %.17g", k, f->length * s->water,
                f->mass / pow(f->length, 3) / 2.5);
}

static void write_model(FILE *o, const scene *s, const frame *f)
{
    const double spring = f->mass / f->time / f->time, pascal = spring / f->length;
    const double pull = f->length / f->time / f->time;

    fprintf(o, "title %s %s, seed %llu\nmaterial rock ", s->kind, f->name,
            (unsigned long long)s->seed);
    fprintf(o, "E %.17g nu %.17g density %.17g thickness %.17g\n", s->E * pascal, s->nu,
            f->mass / pow(f->length, 3), f->length);
    fprintf(o, "contact kn %.17g ks %.17g friction %.17g cohesion %.17g tension %.17g\n",
            s->kn * spring, s->ks * spring, s->friction, s->cohesion * pascal,
            s->cohesion * pascal / 2);
    fprintf(o, "dynamic dt %.17g steps %d\npcg tolerance 1e-12\n", s->dt * f->time, s->steps);
    write_vector(o, f, "gravity", s->g[0], s->g[1], pull * f->nudge);
    write_vector(o, f, "\nshake", s->shake, s->shake / 3, pull);
    fprintf(o, " %.17g", 0.2 / s->dt / f->time);
    for (int i = 0, node = 1; i < s->blocks; i++) {
        const int k = f->order ? s->blocks - 1 - i : i;
        write_block(o, s, f, k);
        for (int c = 0; c < s->b[k].n; c++)
            fprintf(o, "\nmonitor m%d.%d node %d", k, (c + f->order) % s->b[k].n, node++);
    }
    for (int k = 0; k < f->far; k++) {
        fprintf(o, "\nfixblock far%d\nblock far%d rock", k, k);
        for (int c = 0; c < 3; c++)
            write_vector(o, f, " ", 1e4 + c % 2, 1e3 * k + c / 2, f->length);
    }
    fprintf(o, "\n");
}

/* ------------------------------------------------------------------------------------ reading */

/* Rows of a table as numbers; of a block b7, 7; of another word, -1. */
static int read_table(const char *folder, const char *name, int columns, double *cell)
{
    static char line[26 * CELLS];
    int rows = -1;

    snprintf(line, sizeof line, "%s/out/%s.csv", folder, name);
    FILE *f = fopen(line, "r");
    for (; f && rows < ROWS && fgets(line, sizeof line, f); rows++) {
        char *p = strtok(line, ",\n");
        for (int c = 0; rows >= 0 && c < columns && p; c++, p = strtok(NULL, ",\n"))
            cell[rows * columns + c] = *p == 'b' ? atof(p + 1) : *p >= 'A' ? -1 : atof(p);
    }
    if (f)
        fclose(f);
    return rows;
}

/* Area, barycentre and polar moment of area about it. */
static double measure(const point x[], int n, double c[2], double *polar)
{
    double A = 0, X = 0, Y = 0, I = 0;

    for (int k = 0; k < n; k++) {
        const double *o = x[0], *e = x[k], *f = x[(k + 1) % n];
        const double a = e[0] - o[0], b = e[1] - o[1], p = f[0] - o[0], q = f[1] - o[1],
                     z = a * q - b * p;
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

static void read_history(const char *folder, const scene *s, const frame *f, double *t, run *r)
{
    int width = 2;

    for (int k = 0; k < s->blocks; k++)
        width += 2 * s->b[k].n;
    r->rows = read_table(folder, "history", width, t);
    for (int row = 0; row < r->rows && row <= STEPS; row++)
        for (int i = 0, j = row * width + 2; i < s->blocks; i++)
            for (int e = 0, k = f->order ? s->blocks - 1 - i : i; e < s->b[k].n; e++, j += 2) {
                const int c = (e + f->order) % s->b[k].n;
                turn(f, &t[j], 1, 1 / f->length, r->path[row][k][c]);
                r->path[row][k][c][0] += s->b[k].x[c][0];
                r->path[row][k][c][1] += s->b[k].x[c][1];
            }
}

static void read_tables(const char *folder, const scene *s, const frame *f, run *r)
{
    static double t[ROWS * CELLS];
    const double newton = f->mass * f->length / f->time / f->time,
                 pascal = newton / f->length / f->length;
    double c[2], I;

    read_history(folder, s, f, t, r);
    for (int k = read_table(folder, "summary", 11, t) - 1; k >= 0; k--)
        for (int i = 0; i < 5; i++)
            r->sum[k + 1][i] = t[11 * k + 6 + i] / newton / f->length;
    for (int k = read_table(folder, "elements", 14, t) - 1; k >= 0; k--) {
        const double *e = &t[14 * k], a = (e[7] + e[8]) / 2 / pascal, b = hypot(e[7] - e[8],
                     2 * e[9]) / 2 / pascal;
        if (e[1] < 0)
            continue;
        const shape *block = &s->b[(int)e[1]];
        double *v = r->v[(int)e[1]];
        r->elastic += measure(block->x, block->n, c, &I) * (a * a * (1 - s->nu) + b * b * (1
            + s->nu)) / s->E;
        turn(f, &e[11], 1, f->time / f->length, v);
        v[2] = e[13] * f->time * handed(f);
    }
    for (int k = read_table(folder, "contacts", 8, t) - 1; k >= 0; k--) {
        const double N = t[8 * k + 5] / newton, T = t[8 * k + 6] / newton,
                     mu = tan(s->friction / 57.29577951);
        r->springs += N * N / (2 * s->kn) + T * T / (2 * s->ks);
        r->off_cone = fmax(r->off_cone, fmax(-N, fabs(T) - mu * N) / sqrt(s->kn));
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
    snprintf(text, sizeof text, "cd %s; rm -rf out; ulimit -t 60;"
             " ../../../bbm -q %s.model -o out 2>&1; "
             "echo $? > status", folder, f->name);
    for (o = popen(text, "r"); o && fgets(text, sizeof text, o);)
        if (!strstr(text, "arning"))
            snprintf(r->said, sizeof r->said, "%.*s", (int)strcspn(text, "\n") % 299, text);
    pclose(o);
    snprintf(text, sizeof text, "%s/status", folder);
    o = fopen(text, "r");
    if (!o || fscanf(o, "%d", &r->status) != 1)
        exit(2);
    fclose(o);
    read_tables(folder, s, f, r);
}

/* ------------------------------------------------------------------------------------ judging */

static void report(const scene *s, int rule, const char *said, long count[])
{
    count[rule]++;
    printf("seed %llu %s: %s%s: %s\n", (unsigned long long)s->seed, s->kind, RULE[rule],
           rule >= TWIN ? " it differs" : "", said);
}

static int judge(const scene *s, int rule, double value, double bound, int row, long count[])
{
    char said[100];

    snprintf(said, sizeof said, "%.3g, at most %.3g, row %d", value, bound, row);
    if (!(value <= bound))
        report(s, rule, said, count);
    return !(value <= bound);
}

/* How far a place is inside the polygon; 0 outside. */
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

/* The deepest place of the rim of x inside y: whoever parts them has to move them that far. */
static double rim_depth(const point x[], int n, const point y[], int m)
{
    double most = 0;

    for (int k = 0; k < 16 * n; k++) {
        const double *a = x[k / 16], *b = x[(k / 16 + 1) % n], t = k % 16 / 16.0;
        most = fmax(most, depth_of(a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]), y, m));
    }
    return most;
}

/* In each row; of shots also on the straight way between rows, which for a block that bounces ends
 * outside. A spring holds no more than the energy of all of them. */
static void judge_overlap(const scene *s, const run *r, long count[])
{
    const int parts = strcmp(s->kind, "shot") ? 1 : 50;
    double springs = 0;
    point x[BLOCKS][CORNERS];

    for (int k = 0; k < (r->rows - 1) * parts; k++) {
        const int row = k / parts + 1;
        const double t = (k % parts + 1.0) / parts;
        springs = fmax(springs, r->sum[row][2]);
        for (int i = 0; i < s->blocks * CORNERS; i++)
            for (int d = 0; d < 2; d++) {
                const int b = i / CORNERS, c = i % CORNERS;
                x[b][c][d] = (1 - t) * r->path[row - 1][b][c][d] + t * r->path[row][b][c][d];
            }
        const double way = parts > 1 ? 0.1 * s->dt : 0, bound = 1.5 * sqrt(2 * springs / s->kn)
                     + 1e-6;
        for (int p = 0; p < s->blocks * s->blocks; p++) {
            const int i = p / s->blocks, j = p % s->blocks;
            if (i == j || (s->b[i].fixed && s->b[j].fixed))
                continue;
            const double d = rim_depth((const point *)x[i], s->b[i].n, (const point *)x[j],
                         s->b[j].n);
            if (judge(s, OVERLAP, d, bound + (t < 1 ? way : 0), row, count))
                return;
        }
    }
}

typedef struct { double C[2], P[2], weight, size, K, L, L_size, I, work; } ledger;

/* Momentum, kinetic energy, angular momentum about the barycentre, moment of inertia, the sizes of
 * what they are sums of, and the work of gravity from row 0 on. */
static ledger balance(const scene *s, const run *r, int row)
{
    ledger l = { 0 };
    double c[BLOCKS][2], o[2], m[BLOCKS], I[BLOCKS], J, mass = 0;

    for (int k = 0; k < s->blocks; k++) {
        const double *v = row > 0 ? r->v[k] : s->b[k].v;
        m[k] = measure((const point *)r->path[0][k], s->b[k].n, o, &J);
        I[k] = m[k] / measure((const point *)r->path[row][k], s->b[k].n, c[k], &J);
        I[k] *= J;
        mass += m[k];
        for (int d = 0; d < 2; d++) {
            l.P[d] += m[k] * v[d];
            l.C[d] += m[k] * c[k][d];
            l.work += m[k] * s->g[d] * (c[k][d] - o[d]);
            l.weight += m[k] * fabs(s->g[d]);
        }
        l.size += m[k] * hypot(v[0], v[1]);
        l.K += m[k] * (v[0] * v[0] + v[1] * v[1]) / 2 + I[k] * v[2] * v[2] / 2;
    }
    for (int k = 0; k < s->blocks; k++) {
        const double *v = row > 0 ? r->v[k] : s->b[k].v, x = c[k][0] - l.C[0] / mass,
                     y = c[k][1] - l.C[1] / mass;
        l.L += m[k] * (x * v[1] - y * v[0]) + I[k] * v[2];
        l.L_size += m[k] * hypot(x, y) * hypot(v[0], v[1]) + I[k] * fabs(v[2]) * (1 + 1e5
            * pow(v[2] * s->dt, 2));
        l.I += m[k] * (x * x + y * y) + I[k];
    }
    return l;
}

/* Strain rates are not in the tables: their angular momentum is at most sqrt(2 I K), K the kinetic
 * energy that velocities and spins leave over. A step of second order misses angle^2 of a spin. */
static void judge_balance(const scene *s, const run *r, long count[])
{
    const int end = r->rows - 1;
    const ledger a = balance(s, r, 0), z = balance(s, r, end);
    const double *last = r->sum[end], W = s->water > 0 ? last[3] : z.work, T = end * s->dt;
    double size = 1e-12, gain = 0, off = 0;
    int fixed = 0;

    for (int row = 1; row <= end; row++) {
        const double *e = r->sum[row], E = e[0] + e[1] + e[2];
        size = fmax(size, fmax(a.K, E) + fabs(e[3]));
        gain = fmax(gain, (E - e[3] - a.K) / size);
    }
    judge(s, ENERGY, fmax(gain, (z.K + r->elastic + r->springs - W - a.K) / size), 0.01, end,
        count);
    judge(s, WORK, fabs(W - last[3]) / size, 1e-4, end, count);
    for (int k = 0; k < s->blocks; k++)
        fixed |= s->b[k].fixed;
    if (fixed)
        return;
    for (int d = 0; d < 2; d++)
        off = fmax(off, fabs(z.P[d] - a.P[d] - (d ? -1 : 0) * a.weight * T));
    judge(s, MOMENTUM, off / (a.size + z.size + a.weight * T + 1e-12), 1e-6, end, count);
    judge(s, SPIN, fabs(z.L - a.L), 1e-5 * (a.L_size + z.L_size) + sqrt(2 * z.I * fmax(0,
        last[0] - z.K)), end, count);
}

/* x'' = g_x - g_y tan phi until it sticks, but for what springs and elements yield. */
static void judge_slider(const scene *s, const run *r, long count[])
{
    const shape *b = &s->b[s->slider];
    const double a = s->g[0] + s->g[1] * tan(s->friction / 57.29577951), T = (r->rows - 1) * s->dt;
    const double V = b->v[0], stop = a < 0 ? fmin(T, -V / a) : T,
                 way = V * stop + a * stop * stop / 2;
    double o[2], c[2], I;
    const double A = measure(b->x, b->n, o, &I), soft = 20 * A * hypot(s->g[0],
                 s->g[1]) * (1 / s->ks + 10 / s->E);

    measure((const point *)r->path[r->rows - 1][s->slider], b->n, c, &I);
    if (way < 9)
        judge(s, THEORY, fabs(c[0] - o[0] - way), 0.02 * way + 0.5 * V * s->dt + soft, r->rows - 1,
            count);
}

static void judge_scene(const scene *s, const run *r, long count[])
{
    if (r->status != 0 || r->rows != s->steps + 1) {
        const int spoken = r->status == 1 && strlen(r->said) > 40;
        report(s, !spoken ? BROKEN : strstr(r->said, "too soft") ? SOFT : REFUSED, r->said, count);
        return;
    }
    judge_overlap(s, r, count);
    if (!s->moving)
        judge_balance(s, r, count);
    if (s->cohesion == 0)
        judge(s, CONE, r->off_cone / (1e-99 + sqrt(2 * r->springs)), 1e-4, r->rows - 1, count);
    if (s->slider > 0)
        judge_slider(s, r, count);
}

static double apart(const scene *s, const run *p, const run *q, int row)
{
    double most = 0;

    for (int k = 0; k < s->blocks; k++)
        for (int c = 0; c < s->b[k].n; c++) {
            const double *x = p->path[row][k][c], *y = q->path[row][k][c];
            most = fmax(most, hypot(x[0] - y[0], x[1] - y[1]));
        }
    return most;
}

/* A twin differs by rounding, 1e-14 or so. What that does in this scene shows a run turned by 1e-9,
 * with speeds and gravity larger by 1e-9: a twin may be off by three times as much, and by half of
 * what a spring yields, since rounding decides which of the contacts of a tie carries. */
static void judge_twin(const scene *s, int rule, const run *r, const run *twin, const run *nudged,
    long count[])
{
    double allowed = 0;

    if (twin->status != r->status && nudged->status == r->status)
        report(s, rule, twin->status ? twin->said : "runs, the scene does not", count);
    for (int row = 0; row < r->rows && row < twin->rows && row < nudged->rows; row++) {
        const double springs = fmax(r->sum[row][2], r->sum[row + (row + 1 < r->rows)][2]);
        allowed = fmax(allowed, 3 * apart(s, r, nudged, row) + 1e-6 + 0.5 * sqrt(2
            * springs / s->ks));
        if (judge(s, rule, apart(s, r, twin, row), allowed, row, count))
            return;
    }
}

static frame turned(frame f, const char *name, double angle, int mirrored)
{
    f.name = name;
    f.Q[0][0] = (mirrored ? -1 : 1) * cos(angle);
    f.Q[0][1] = -sin(angle);
    f.Q[1][0] = (mirrored ? -1 : 1) * sin(angle);
    f.Q[1][1] = cos(angle);
    return f;
}

static void try_scene(uint64_t seed, const char *folder, long count[])
{
    static run r, twin, nudged;
    scene s;

    draw_scene(&s, seed);
    const double a = s.water > 0 || chance(&s, 0.4) ? 0 : draw(&s, 0, 6),
                 b = s.water > 0 ? 0 : a + draw(&s, 0.1, 6);
    const frame unit = { .length = power(&s, -3, 3), .time = power(&s, -3, 1), .mass = power(&s,
        -3, 6), .nudge = 1 };
    const frame f = turned(unit, "scene", a, 0);
    frame t[] = { turned(f, "mirrored", -a, 1), turned(f, "turned", b, 0), turned(f, "units", a,
        0), turned(f, "order", a, 0),
                  turned(f, "far", a, 0), turned(f, "nudged", a + 1e-9, 0) };
    t[2].length = power(&s, -3, 3), t[2].time = power(&s, -3, 1), t[2].mass = power(&s, -3, 6);
    t[3].order = 1;
    t[4].far = 3;
    t[5].nudge = 1 + 1e-9;
    try_frame(&s, &f, folder, &r);
    judge_scene(&s, &r, count);
    try_frame(&s, &t[5], folder, &nudged);
    for (int k = 0; k < 5; k++) {
        try_frame(&s, &t[k], folder, &twin);
        judge_twin(&s, TWIN + k, &r, &twin, &nudged, count);
    }
}

/* hostile [seed [scenes [seconds]]], scenes 0: until the time is over */
int main(int argc, char **argv)
{
    const uint64_t seed = argc > 1 ? strtoull(argv[1], NULL, 10) : 1;
    const long scenes = argc > 2 ? atol(argv[2]) : 0;
    const double seconds = argc > 3 ? atof(argv[3]) : 60;
    const time_t start = time(NULL);
    long count[RULES] = { 0 }, done = 0, findings = 0;
    char folder[60];

    setvbuf(stdout, NULL, _IOLBF, BUFSIZ);
    snprintf(folder, sizeof folder, "out/hostile/%llu", (unsigned long long)seed);
    mkdir("out", 0777);
    mkdir("out/hostile", 0777);
    mkdir(folder, 0777);
    for (; (scenes == 0 || done < scenes) && difftime(time(NULL), start) < seconds; done++)
        try_scene(seed + (uint64_t)done, folder, count);
    printf("\n%ld hostile scenes\n", done);
    for (int k = 0; k < RULES; k++) {
        findings += k > SOFT ? count[k] : 0;
        printf("    %-28s %ld\n", RULE[k], count[k]);
    }
    return findings > 0 || count[REFUSED] * 100 > 3 * done;
}
