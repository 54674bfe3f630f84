/* hostile.c - scenes that a stranger would try, run by ./bbm as a user runs it, and judged by its
 * tables alone: the oracle is doc/model-file.md, doc/tables.md and mechanics.
 *
 *     make torture SEED=17 SCENES=1    leaves out/hostile/17/scene.model to look at, and its twins
 *
 * A scene is drawn in units of its own: lengths and speeds of about 1, density 1; x + iy is a place
 * or a vector. A frame writes it as a model file: in some unit of length, time and mass, turned,
 * mirrored, its blocks in another order. The tables are read back through the frame, so that twins
 * can be compared. */
#define _XOPEN_SOURCE 600               /* popen, drand48 */
#include <complex.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <time.h>

enum { BLOCKS = 20, CORNERS = 10, STEPS = 60, CELLS = 2 + 2 * BLOCKS * CORNERS, ROWS = 500 };

typedef double complex point;

typedef struct {
    int n, fixed;
    point x[CORNERS], v, push;         /* velocity; the way of a support */
    double spin;
} shape;

typedef struct {
    unsigned long seed;
    const char *kind;
    shape b[BLOCKS];
    int blocks, steps, slider;         /* slider: the block that slides on a plane */
    point g;
    double E, nu, dt, kn, ks, friction, cohesion, shake, water;
} scene;

/* x_model = length Q x, or -conj(x) for x; speeds and gravity grow by `nudge` */
typedef struct {
    const char *name;
    point Q;
    double length, time, mass, nudge;
    int mirrored, order;
} frame;

typedef struct {
    int status, rows;                  /* rows: of history.csv */
    point path[STEPS + 1][BLOCKS][CORNERS], v[BLOCKS];
    double spin[BLOCKS], sum[STEPS + 1][4];     /* kinetic, elastic, springs, external */
    double force, off_cone;            /* the largest of a contact, beyond the friction cone */
} run;

enum { REFUSED, BROKEN, CONE, ENERGY, MOMENTUM, OVERLAP, THEORY, TWIN, RULES = TWIN + 4 };

static const char *const RULE[RULES] = { "refused", "broken off", "beyond the friction cone",
    "energy", "momentum", "overlap", "theory", "other if mirrored", "other if turned",
    "other in other units", "other in another order" };

/* ------------------------------------------------------------------------------------ drawing */

static double draw(double least, double most) { return least + (most - least) * drand48(); }
static double power(double least, double most) { return pow(10, draw(least, most)); }
static int chance(double share) { return drand48() < share; }
static int pick(int least, int most) { return (int)draw(least, most + 1); }

static shape *box(scene *s, double x, double y, double X, double Y, int fixed)
{
    shape *b = &s->b[s->blocks++];

    *b = (shape){ 4, fixed, { x + I * y, X + I * y, X + I * Y, x + I * Y }, 0, 0, 0 };
    return b;
}

/* A polygon or a star within r of (x, y), as it is or flattened to a sliver; it flies. */
static shape *add_odd(scene *s, double x, double y, double r, double speed)
{
    const double flat = chance(0.7) ? 1 : power(-2, -0.5);
    const double a = chance(0.3) ? 0 : draw(0, 6);
    const double arm = chance(0.5) ? draw(0.2, 0.6) : 1;
    shape *b = box(s, 0, 0, 1, 1, 0);

    b->n = arm < 1 ? 2 * pick(3, 5) : pick(3, 8);
    for (int k = 0; k < b->n; k++) {
        const point p = (k % 2 ? arm : 1) * cexp(I * 6.2831853 * k / b->n);
        b->x[k] = x + I * y + r * (creal(p) + I * flat * cimag(p)) * cexp(I * a);
    }
    b->v = speed * cexp(I * draw(0, 6));
    b->spin = draw(-speed, speed);
    return b;
}

/* In free flight, or in a pit. */
static void draw_soup(scene *s)
{
    const int across = pick(1, 4), up = pick(1, 3);

    for (int k = 0; k < across * up; k++)
        add_odd(s, k % across + 0.5, k / across + 0.5, 0.5 * power(-1, 0), 1);
    if (chance(0.5))
        box(s, -6, -1, 10, -0.01, 1);
    s->g *= chance(0.6);
}

/* A brick on a plane of flush slabs, level or inclined. */
static void draw_slabs(scene *s)
{
    const int n = pick(1, 6);
    const double a = chance(0.5) ? 0 : draw(0.05, 0.8), l = 12.0 / n;

    for (int k = 0; k < n; k++)
        box(s, k * l - 1, -0.5, (k + 1) * l - 1, 0, 1);
    s->slider = s->blocks;
    box(s, 0.2, 0, draw(1, 2), draw(0.05, 0.3), 0)->v = a > 0 ? 0 : draw(0.5, 1.5);
    s->g *= cexp(I * a);
    s->dt = fmin(s->dt, 1.2 / s->steps);
}

/* A small block flies at others, thin walls among them, up to 25 of its sizes in a step. */
static void draw_shot(scene *s)
{
    const double r = power(-2, -0.7);

    add_odd(s, 0, 0, r, 0.03)->v = 1;
    s->dt = power(-1, 1.4) * 2 * r;
    s->g = 0;
    for (int k = pick(1, 4); k > 0; k--)
        add_odd(s, 2 * k + r, draw(-r, r), draw(r, 1), 0)->fixed = chance(0.5);
}

static void draw_piston(scene *s)
{
    const double gap = chance(0.5) ? 0 : draw(0, 0.2);

    box(s, -2, 0.01, -1, 1, 1)->push = power(-2, 0.3);
    box(s, -3, -1, 12, 0, 1);
    for (int k = pick(1, 4); k > 0; k--)
        box(s, k - 2 + gap * k, 0, k - 1 + gap * k, draw(0.5, 1.5), 0);
}

/* Still, shaken, in water, glued. */
static void draw_stack(scene *s)
{
    const int way = pick(0, 3);

    box(s, -2, -0.5, 6, 0, 1);
    for (int k = pick(0, 3); k >= 0; k--)
        for (int i = 0; i < 5 - k; i++)
            box(s, i + k * 0.5, k * 0.5, i + 1 + k * 0.5, k * 0.5 + 0.5, 0);
    s->shake = way == 0 ? draw(-2, 2) * cabs(s->g) : 0;
    s->water = way == 1 ? draw(0.1, 3) : 0;
    s->cohesion = way == 2 ? s->E * power(-5, -2) : 0;
}

static void draw_scene(scene *s, unsigned long seed)
{
    static const struct { const char *name; void (*draw)(scene *); } kind[] = {
        { "soup", draw_soup }, { "slabs", draw_slabs }, { "shot", draw_shot },
        { "piston", draw_piston }, { "stack", draw_stack } };

    memset(s, 0, sizeof *s);
    s->seed = seed;
    srand48((long)seed);
    const int k = pick(0, 4);
    s->kind = kind[k].name;
    s->E = power(3, 9);
    s->nu = draw(0, 0.45);
    s->kn = s->E * power(-0.5, 2);
    s->ks = s->kn * draw(0.2, 1);
    s->dt = power(-2.5, -0.7);
    s->steps = pick(10, STEPS);
    s->friction = chance(0.2) ? 0 : draw(0, 50);
    s->g = -I * power(-1, 1);
    kind[k].draw(s);
}

/* ------------------------------------------------------------------------------------ writing */

static void write_vector(FILE *o, const frame *f, const char *text, point x)
{
    const point z = f->Q * (f->mirrored ? -conj(x) : x);

    fprintf(o, "%s %.17g %.17g", text, creal(z), cimag(z));
}

static point read_vector(const frame *f, point z)
{
    return f->mirrored ? -conj(z) * f->Q : z * conj(f->Q);
}

static void write_block(FILE *o, const scene *s, const frame *f, int k)
{
    const shape *b = &s->b[k];
    const point z = f->Q * (f->mirrored ? -b->push : b->push) * f->length;

    fprintf(o, "\nblock b%d rock", k);
    for (int c = 0; c < b->n; c++)
        write_vector(o, f, "", b->x[(c + f->order) % b->n] * f->length);
    if (b->fixed)
        fprintf(o, "\nfixblock b%d", k);
    if (b->push != 0)
        fprintf(o, "\nfix set b%d x by %.17g y by %.17g", k, creal(z), cimag(z));
    fprintf(o, "\nvelocity b%d", k);
    write_vector(o, f, "", b->v * f->length / f->time * f->nudge);
    fprintf(o, " %.17g", b->spin * (f->mirrored ? -1 : 1) / f->time * f->nudge);
    if (s->water > cimag(b->x[0]) && s->water > 0 && !b->fixed)
        fprintf(o, "\nwater set b%d %.17g density %.17g", k, f->length * s->water,
                f->mass / pow(f->length, 3) / 2.5);
}

static void write_model(FILE *o, const scene *s, const frame *f)
{
    const double spring = f->mass / f->time / f->time, pascal = spring / f->length;
    const double pull = f->length / f->time / f->time, glue = s->cohesion * pascal;

    fprintf(o, "material rock E %.17g nu %.17g density %.17g thickness %.17g\n", s->E * pascal,
            s->nu, f->mass / pow(f->length, 3), f->length);
    fprintf(o, "contact kn %.17g ks %.17g friction %.17g cohesion %.17g tension %.17g\n",
            s->kn * spring, s->ks * spring, s->friction, glue, glue / 2);
    fprintf(o, "dynamic dt %.17g steps %d\npcg tolerance 1e-12\n", s->dt * f->time, s->steps);
    write_vector(o, f, "gravity", s->g * pull * f->nudge);
    write_vector(o, f, "\nshake", s->shake * (1 + I / 3) * pull);
    fprintf(o, " %.17g", 0.2 / s->dt / f->time);
    for (int i = 0, node = 1; i < s->blocks; i++) {
        const int k = f->order ? s->blocks - 1 - i : i;
        write_block(o, s, f, k);
        for (int c = 0; c < s->b[k].n; c++)
            fprintf(o, "\nmonitor m%d.%d node %d\n", k, (c + f->order) % s->b[k].n, node++);
    }
}

/* ------------------------------------------------------------------------------------ reading */

/* Rows of a table as numbers; of a block b7, 7; of another word, -1. */
static int read_table(const char *folder, const char *name, double cell[][CELLS])
{
    static char line[26 * CELLS];
    int rows = -1;

    snprintf(line, sizeof line, "%s/out/%s.csv", folder, name);
    FILE *f = fopen(line, "r");
    for (; f && rows < ROWS && fgets(line, sizeof line, f); rows++) {
        char *p = strtok(line, ",\n");
        for (int c = 0; rows >= 0 && c < CELLS && p; c++, p = strtok(NULL, ",\n"))
            cell[rows][c] = *p == 'b' ? atof(p + 1) : *p >= 'A' ? -1 : atof(p);
    }
    if (f)
        fclose(f);
    return rows;
}

static void read_tables(const char *folder, const scene *s, const frame *f, run *r)
{
    static double t[ROWS][CELLS];
    const double newton = f->mass * f->length / f->time / f->time;

    r->rows = read_table(folder, "history", t);
    for (int row = 0; row < r->rows && row <= STEPS; row++)
        for (int i = 0, j = 2; i < s->blocks; i++)
            for (int e = 0, k = f->order ? s->blocks - 1 - i : i; e < s->b[k].n; e++, j += 2) {
                const int c = (e + f->order) % s->b[k].n;
                const point way = read_vector(f, t[row][j] + I * t[row][j + 1]);
                r->path[row][k][c] = s->b[k].x[c] + way / f->length;
            }
    for (int k = read_table(folder, "summary", t) - 1; k >= 0; k--)
        for (int i = 0; i < 4; i++)
            r->sum[k + 1][i] = t[k][6 + i] / newton / f->length;
    for (int k = read_table(folder, "elements", t) - 1; k >= 0; k--) {
        const int b = (int)t[k][1];
        r->v[b] = read_vector(f, t[k][11] + I * t[k][12]) / f->length * f->time;
        r->spin[b] = t[k][13] * f->time * (f->mirrored ? -1 : 1);
    }
    for (int k = read_table(folder, "contacts", t) - 1; k >= 0; k--) {
        const double N = t[k][5] / newton, T = fabs(t[k][6]) / newton;
        r->force = fmax(r->force, N);
        r->off_cone = fmax(r->off_cone, fmax(-N, T - N * tan(s->friction / 57.29577951)));
    }
}

/* Status 99: refused without a reason. */
static void try_frame(const scene *s, const frame *f, const char *folder, run *r)
{
    char text[400];

    memset(r, 0, sizeof *r);
    snprintf(text, sizeof text, "mkdir -p %s; cd %s; rm -rf out; cat > %s.model; ulimit -t 60; "
             "../../../bbm -q %s.model -o out 2> said; s=$?; grep -v arning: said; "
             "[ $s = 0 -o -s said ] || s=99; exit $s", folder, folder, f->name, f->name);
    FILE *o = popen(text, "w");
    write_model(o, s, f);
    r->status = WEXITSTATUS(pclose(o));
    read_tables(folder, s, f, r);
}

/* ------------------------------------------------------------------------------------ judging */

static int judge(const scene *s, int rule, double value, double bound, int row, long count[])
{
    if (value <= bound)
        return 0;
    count[rule]++;
    return printf("seed %lu %s %s: %.3g, at most %.3g, row %d\n", s->seed,
                  s->kind, RULE[rule], value, bound, row);
}

/* Area, barycentre and polar moment of area about it. */
static double measure(const point x[], int n, point *centre, double *polar)
{
    double A = 0, J = 0;
    point S = 0;

    for (int k = 0; k < n; k++) {
        const point a = x[k] - x[0], b = x[(k + 1) % n] - x[0];
        const double z = cimag(conj(a) * b);
        A += z / 2;
        S += z * (a + b) / 6;
        J += z * creal(a * conj(a) + a * conj(b) + b * conj(b)) / 12;
    }
    *centre = x[0] + S / A;
    *polar = fabs(J - creal(S * conj(S)) / A);
    return fabs(A);
}

/* How far a place is inside the polygon; 0 outside, where it sees the sides go round by 0. */
static double depth_of(point p, const point x[], int n)
{
    double least = INFINITY, round = 0;

    for (int k = 0; k < n; k++) {
        const point a = x[k] - p, b = x[(k + 1) % n] - p, d = b - a;
        const double t = -creal(conj(a) * d) / creal(conj(d) * d);
        least = fmin(least, cabs(a + fmin(1, fmax(0, t)) * d));
        round += carg(conj(a) * b);
    }
    return fabs(round) > 3 ? least : 0;
}

/* The deepest place of the rim of x inside y: whoever parts them has to move them that far. */
static double rim_depth(const point x[], int n, const point y[], int m)
{
    double most = 0;

    for (int k = 0; k < 16 * n; k++)
        most = fmax(most, depth_of(x[k / 16] + k % 16 / 16.0 * (x[(k / 16 + 1) % n] - x[k / 16]),
                                   y, m));
    return most;
}

/* In each row. A spring holds no more than the energy of all of them. */
static void judge_overlap(const scene *s, const run *r, long count[])
{
    double springs = 0;

    for (int row = 1; row < r->rows; row++) {
        const point (*x)[CORNERS] = r->path[row];
        springs = fmax(springs, r->sum[row][2]);
        for (int p = 0; p < s->blocks * s->blocks; p++) {
            const int i = p / s->blocks, j = p % s->blocks, held = s->b[i].fixed && s->b[j].fixed;
            const double d = i == j || held ? 0 : rim_depth(x[i], s->b[i].n, x[j], s->b[j].n);
            if (judge(s, OVERLAP, d, 1.5 * sqrt(2 * springs / s->kn) + 1e-6, row, count))
                return;
        }
    }
}

typedef struct { point P; double mass, K, work; int fixed, moving; } ledger;

/* Momentum, mass, kinetic energy, the work of gravity from row 0 on. */
static ledger balance(const scene *s, const run *r, int row)
{
    ledger l = { 0, 0, 0, 0, 0, s->shake != 0 };

    for (int k = 0; k < s->blocks; k++) {
        const point v = row > 0 ? r->v[k] : s->b[k].v;
        const double w = row > 0 ? r->spin[k] : s->b[k].spin;
        point o, c;
        double J;
        const double m = measure(r->path[0][k], s->b[k].n, &o, &J);
        const double turning = m / measure(r->path[row][k], s->b[k].n, &c, &J) * J;
        l.fixed |= s->b[k].fixed;
        l.moving |= s->b[k].push != 0;
        l.mass += m;
        l.P += m * v;
        l.work += m * creal(conj(s->g) * (c - o));
        l.K += m * creal(v * conj(v)) / 2 + turning * w * w / 2;
    }
    return l;
}

static void judge_balance(const scene *s, const run *r, long count[])
{
    const int end = r->rows - 1;
    const ledger a = balance(s, r, 0), z = balance(s, r, end);
    const double *last = r->sum[end], W = s->water > 0 ? last[3] : z.work;
    const point pull = a.mass * s->g * end * s->dt;
    double size = 1e-12, gain = 0;

    for (int row = 1; row <= end; row++) {
        const double *e = r->sum[row], E = e[0] + e[1] + e[2];
        size = fmax(size, fmax(a.K, E) + fabs(e[3]));
        gain = fmax(gain, (E - e[3] - a.K) / size);
    }
    gain = fmax(gain, (z.K + last[1] + last[2] - W - a.K) / size);
    judge(s, ENERGY, a.moving ? 0 : gain, 0.01, end, count);
    size = sqrt(2 * a.mass * (a.K + z.K)) + cabs(pull) + 1e-12;
    if (!a.fixed)
        judge(s, MOMENTUM, cabs(z.P - a.P - pull) / size, 1e-6, end, count);
}

/* x'' = g_x - g_y tan phi until it sticks, but for what springs and elements yield. */
static void judge_slider(const scene *s, const run *r, long count[])
{
    const shape *b = &s->b[s->slider];
    const double a = creal(s->g) + cimag(s->g) * tan(s->friction / 57.29577951);
    const double V = creal(b->v), T = (r->rows - 1) * s->dt, stop = a < 0 ? fmin(T, -V / a) : T;
    const double way = V * stop + a * stop * stop / 2;
    point o, c;
    double J;
    const double soft = 20 * measure(b->x, b->n, &o, &J) * cabs(s->g) * (1 / s->ks + 10 / s->E);

    measure(r->path[r->rows - 1][s->slider], b->n, &c, &J);
    judge(s, THEORY, fabs(creal(c - o) - way), 0.02 * way + 0.5 * V * s->dt + soft, r->rows - 1,
          count);
}

/* 5e-15 are some last digits of places up to 12, of which springs make forces. */
static void judge_scene(const scene *s, const run *r, long count[])
{
    if (r->status != 0 || r->rows != s->steps + 1) {
        judge(s, r->status == 1 ? REFUSED : BROKEN, r->status, -1, r->rows, count);
        return;
    }
    judge_overlap(s, r, count);
    judge_balance(s, r, count);
    if (s->cohesion == 0)
        judge(s, CONE, r->off_cone, 1e-4 * r->force + 5e-15 * s->kn, r->rows - 1, count);
    if (s->slider > 0)
        judge_slider(s, r, count);
}

static double apart(const scene *s, const run *p, const run *q, int row)
{
    double most = 0;

    for (int k = 0; k < s->blocks; k++)
        for (int c = 0; c < s->b[k].n; c++)
            most = fmax(most, cabs(p->path[row][k][c] - q->path[row][k][c]));
    return most;
}

static frame drawn(const char *name, double angle)
{
    return (frame){ name, cexp(I * angle), power(-3, 3), power(-3, 1), power(-3, 6), 1, 0, 0 };
}

static frame nudged(frame f)
{
    f.Q *= cexp(1e-9 * I);
    f.nudge = 1 + 1e-9;
    return f;
}

/* By how much a twin is off, in the first row where it is: [0] apart, [1] allowed, [2] the row. A
 * twin differs by rounding, 1e-14 or so. What that does in this scene show four runs turned by 1e-9
 * and more, with speeds and gravity larger by 1e-9: a twin may be off by three times their spread,
 * and by half of what a spring yields, since rounding decides which of the contacts of a tie
 * carries. */
static int is_off(const scene *s, const run *r, const run *twin, const double spread[], double by[])
{
    double allowed = 0;
    int row = 0, off = spread[0] < 1 && twin->status != r->status;

    by[0] = off;
    for (; row < r->rows && row < twin->rows && !off; row++) {
        const double springs = fmax(r->sum[row][2], r->sum[row + (row + 1 < r->rows)][2]);
        allowed = fmax(allowed, 3 * spread[row] + 1e-6 + sqrt(springs / s->ks / 2));
        by[0] = apart(s, r, twin, row);
        off = by[0] > allowed;
    }
    by[1] = allowed;
    by[2] = row;
    return off;
}

/* A scene in which rounding decides between a few ways shows by chance one of them four times and
 * another one in the twin. So the twin is run with the same nudges, and is another only if all of
 * its runs are off. */
static void judge_twin(const scene *s, int rule, const frame *of, const run *r,
    const double spread[], const char *folder, long count[])
{
    static run twin;
    double first[3], by[3];
    frame f = *of;

    for (int k = 0; k < 4; k++, f = nudged(f)) {
        try_frame(s, &f, folder, &twin);
        if (!is_off(s, r, &twin, spread, k == 0 ? first : by))
            return;
    }
    judge(s, rule, first[0], first[1], (int)first[2], count);
}

static void try_scene(unsigned long seed, const char *folder, long count[])
{
    static run r, other;
    double spread[STEPS + 1] = { 0 };
    scene s;

    draw_scene(&s, seed);
    const double a = s.water > 0 || chance(0.4) ? 0 : draw(0, 6);
    const double b = s.water > 0 ? 0 : a + draw(0.1, 6);
    const frame f = drawn("scene", a);
    frame near = f, t[] = { f, f, drawn("units", a), f };
    near.name = "nudged";
    t[0].name = "mirrored", t[0].mirrored = 1, t[0].Q = conj(f.Q);
    t[1].name = "turned", t[1].Q = cexp(I * b);
    t[3].name = "order", t[3].order = 1;
    try_frame(&s, &f, folder, &r);
    judge_scene(&s, &r, count);
    for (int k = 0; k < 4; k++) {
        near = nudged(near);
        try_frame(&s, &near, folder, &other);
        for (int row = 0; row < r.rows; row++)
            spread[row] = fmax(spread[row], other.status == r.status ?
                               apart(&s, &r, &other, row) : INFINITY);
    }
    for (int k = 0; k < 4; k++)
        judge_twin(&s, TWIN + k, &t[k], &r, spread, folder, count);
}

/* hostile [seed [scenes [seconds]]], scenes 0: until the time is over */
int main(int argc, char **argv)
{
    const unsigned long seed = argc > 1 ? strtoul(argv[1], NULL, 10) : 1;
    const long scenes = argc > 2 ? atol(argv[2]) : 0;
    const time_t end = time(NULL) + (argc > 3 ? atol(argv[3]) : 60);
    long count[RULES] = { 0 }, done = 0, findings = 0;
    char folder[60];

    setvbuf(stdout, NULL, _IOLBF, BUFSIZ);
    snprintf(folder, sizeof folder, "out/hostile/%lu", seed);
    for (; (scenes == 0 || done < scenes) && time(NULL) < end; done++)
        try_scene(seed + (unsigned long)done, folder, count);
    printf("\n%ld hostile scenes\n", done);
    for (int k = 0; k < RULES; k++) {
        findings += k > REFUSED ? count[k] : 0;
        printf("    %-28s %ld\n", RULE[k], count[k]);
    }
    return findings > 0 || count[REFUSED] * 100 > 3 * done;
}
