/* limit.c - statics of ./bbm against limit analysis. A scene of rigid blocks carries its weight and
 * a load that grows in proportion. A linear program has the factor up to which there are forces
 * that balance each block (the static theorem): at both ends of each touching segment a pressure
 * N >= 0 and a friction |T| <= mu N. Above this limit nothing can stand. Below it a scene without
 * friction has to stand; one with friction may fall all the same, for friction is not associated.
 *
 *     out/build/limit check                   the linear program against closed forms
 *     out/build/limit 17 100                  the scenes 17 to 116, five runs each
 *     out/build/limit 17 100 60 dynamic       at most 60 s; dynamics runs what is found once more
 *     out/build/limit 17 1                    scene 17 again, its models in out/limit/17
 *
 * A scene is drawn in units of its own, in which blocks are about 1 long and weigh their area;
 * x + iy is a place or a vector, gravity is -i. The model file has it turned, mirrored, in some
 * size and in some units. */
#define _XOPEN_SOURCE 600               /* popen, drand48 */
#include <complex.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <time.h>

enum { BLOCKS = 24, CORNERS = 12, TOUCHES = 80, ROWS = 3 * BLOCKS, COLUMNS = 1 + 4 * TOUCHES };
enum { STACK, WALL, CUT, ARCH };

typedef double complex point;

typedef struct {
    int n, held;
    point x[CORNERS], centre;           /* counter-clockwise */
    double area;
} shape;

/* A segment along which two blocks touch; the normal is that of b, into a. */
typedef struct { int a, b; point end[2], normal; } touch;

typedef struct {
    unsigned long seed;
    shape b[BLOCKS];
    touch t[TOUCHES];
    int blocks, touches, bad;           /* bad: not only faces that touch along their length */
    int kind, size, unit, heavy, mirrored, steps;
    int loaded, corner;                 /* where the force acts */
    point force, tilt, Q;               /* the load is one of two; a tilt is added to gravity */
    double friction, limit;             /* degrees; the largest factor of the load */
    double stiffer;                     /* Young's modulus is so many times as large; 0: once */
} scene;

/* Maximise x[0] of a x = b, x >= 0. */
typedef struct { int rows, columns; double a[ROWS][COLUMNS], b[ROWS]; } program;

/* The simplex tableau: columns, artificial columns, right side; below them the reduced costs. */
typedef struct {
    int m, n, base[ROWS];
    double t[ROWS + 1][COLUMNS + ROWS + 1];
} tableau;

/* ------------------------------------------------------------------------ the linear program */

/* Solves the row for a column's variable and takes it out of all the others. */
static void pivot(tableau *s, int row, int column)
{
    const double p = s->t[row][column];

    for (int j = 0; j <= s->n + s->m; j++)
        s->t[row][j] /= p;
    for (int i = 0; i <= s->m; i++) {
        const double f = i == row ? 0 : s->t[i][column];
        for (int j = 0; j <= s->n + s->m && f != 0; j++)
            s->t[i][j] -= f * s->t[row][j];
        s->t[i][column] = i == row;
    }
    s->base[row] = column;
}

/* Bland's rule: the first column that lowers the costs; of the rows that limit it the one with the
 * first variable. 1: the costs are least; 0: without bound; -1: given up. */
static int descend(tableau *s)
{
    for (int turn = 0; turn < 20000; turn++) {
        int column = 0, row = -1;
        double least = INFINITY;
        while (column < s->n && s->t[s->m][column] > -1e-10)
            column++;
        if (column == s->n)
            return 1;
        for (int i = 0; i < s->m; i++) {
            const double p = s->t[i][column], ratio = fmax(0, s->t[i][s->n + s->m]) / p;
            if (p > 1e-9 && (row < 0 || ratio < least - 1e-12
                             || (ratio < least + 1e-12 && s->base[i] < s->base[row]))) {
                row = i;
                least = ratio;
            }
        }
        if (row < 0)
            return 0;
        pivot(s, row, column);
    }
    return -1;
}

/* The rows with b >= 0, each with an artificial variable; the costs are the sum of these. */
static void begin(const program *p, tableau *s)
{
    memset(s, 0, sizeof *s);
    s->m = p->rows;
    s->n = p->columns;
    for (int i = 0; i < s->m; i++) {
        const double sign = p->b[i] < 0 ? -1 : 1;
        for (int j = 0; j < s->n; j++)
            s->t[i][j] = sign * p->a[i][j];
        s->t[i][s->n + i] = 1;
        s->t[i][s->n + s->m] = sign * p->b[i];
        s->base[i] = s->n + i;
        for (int j = 0; j <= s->n + s->m; j++)
            s->t[s->m][j] -= s->base[i] == j ? 0 : s->t[i][j];
    }
}

/* Whether the result is proved. The forces x fulfil a x = b and x >= 0. The mechanism u, the costs
 * of the artificial variables, has u a >= 0 in each column, and at least 1 in that of the load; so
 * no x[0] exceeds u b. Errors are measured by the largest force and the largest way. */
static int is_proved(const program *p, const tableau *s, double value)
{
    double x[COLUMNS] = { 0 }, u[ROWS], way = 1, size = 1, bound = 0;

    for (int i = 0; i < s->m; i++) {
        const double right = s->t[i][s->n + s->m];
        u[i] = s->t[s->m][s->n + i] * (p->b[i] < 0 ? -1 : 1);
        way = fmax(way, fabs(u[i]));
        bound += u[i] * p->b[i];
        if (s->base[i] < s->n)
            x[s->base[i]] = right;
        size = right < -1e-8 ? NAN : fmax(size, right);
    }
    for (int i = 0; i < s->m; i++) {
        double sum = -p->b[i];
        for (int j = 0; j < s->n; j++)
            sum += p->a[i][j] * x[j];
        if (!(fabs(sum) <= 1e-8 * size))
            return 0;
    }
    for (int j = 0; j < s->n; j++) {
        double sum = j == 0 ? -1 : 0;
        for (int i = 0; i < s->m; i++)
            sum += u[i] * p->a[i][j];
        if (sum < -1e-8 * way)
            return 0;
    }
    return fabs(bound - value) <= 1e-7 * fmax(1, value);
}

/* The largest x[0]; INFINITY: without bound; -1: there is no x; NAN: not found. */
static double maximise(const program *p)
{
    static tableau s;

    begin(p, &s);
    if (descend(&s) < 0)
        return NAN;
    if (s.t[s.m][s.n + s.m] < -1e-9)
        return -1;
    for (int i = 0; i < s.m; i++) {
        int best = 0;
        for (int j = 1; j < s.n; j++)
            best = fabs(s.t[i][j]) > fabs(s.t[i][best]) ? j : best;
        if (s.base[i] >= s.n && fabs(s.t[i][best]) > 1e-9)
            pivot(&s, i, best);
    }
    memset(s.t[s.m], 0, sizeof s.t[s.m]);
    s.t[s.m][0] = -1;
    for (int i = 0; i < s.m; i++)
        for (int j = 0; j <= s.n + s.m && s.base[i] == 0; j++)
            s.t[s.m][j] += s.t[i][j];
    const int end = descend(&s);
    const double value = s.t[s.m][s.n + s.m];
    return end == 0 ? INFINITY : end > 0 && is_proved(p, &s, value) ? value : NAN;
}

/* Adds a force at a place to the three rows of a block, which have no units: two components over
 * the block's weight, and the moment over its weight and size. */
static void add_force(const scene *s, int block, point at, point f, double row[], int stride)
{
    const shape *b = &s->b[block];

    row[0] += creal(f) / b->area;
    row[stride] += cimag(f) / b->area;
    row[2 * stride] += cimag(conj(at - b->centre) * f) / (b->area * sqrt(b->area));
}

/* Column 0 is the load's factor; each other one is a force along an edge of a friction cone, and in
 * any cone a force is the sum of two that are not negative. */
static void write_program(const scene *s, double mu, program *p)
{
    int row[BLOCKS];

    memset(p, 0, sizeof *p);
    p->columns = 1 + 4 * s->touches;
    for (int k = 0; k < s->blocks; k++) {
        row[k] = s->b[k].held ? -1 : 3 * p->rows++;
        if (row[k] < 0)
            continue;
        add_force(s, k, s->b[k].centre, s->b[k].area * I, &p->b[row[k]], 1);
        add_force(s, k, s->b[k].centre, s->b[k].area * s->tilt, p->a[row[k]], COLUMNS);
        if (k == s->loaded)
            add_force(s, k, s->b[k].x[s->corner], s->force, p->a[row[k]], COLUMNS);
    }
    p->rows *= 3;
    for (int j = 1; j < p->columns; j++) {
        const touch *t = &s->t[(j - 1) / 4];
        const point f = t->normal * (1 + (j % 2 ? 1 : -1) * mu * I), at = t->end[(j - 1) % 4 / 2];
        if (row[t->a] >= 0)
            add_force(s, t->a, at, f, &p->a[row[t->a]][j], COLUMNS);
        if (row[t->b] >= 0)
            add_force(s, t->b, at, -f, &p->a[row[t->b]][j], COLUMNS);
    }
}

/* The largest factor of the load. */
static double find_limit(const scene *s, double mu)
{
    static program p;

    write_program(s, mu, &p);
    return maximise(&p);
}

/* Whether there is equilibrium at a factor, also with a thousandth of its weight, either way, more
 * in any one row (`strictly`). */
static int balances(const scene *s, double mu, double factor, int strictly)
{
    static program p;
    int yes = 1;

    write_program(s, mu, &p);
    for (int i = 0; i < p.rows; i++) {
        p.b[i] -= factor * p.a[i][0];
        p.a[i][0] = 0;
    }
    yes = maximise(&p) >= 0;
    for (int k = 0; k < 2 * p.rows && strictly && yes; k++) {
        const double b = p.b[k / 2];
        p.b[k / 2] += k % 2 ? 1e-3 : -1e-3;
        yes = maximise(&p) >= 0;
        p.b[k / 2] = b;
    }
    return yes;
}

/* ------------------------------------------------------------------------------------ drawing */

static double draw(double least, double most) { return least + (most - least) * drand48(); }
static int chance(double share) { return drand48() < share; }
static int pick(int least, int most) { return (int)draw(least, most + 1); }
static point draw_way(void) { return cexp(draw(0, 6.2831853) * I); }

/* Area and barycentre. */
static void measure(shape *b)
{
    point S = 0;

    b->area = 0;
    for (int k = 0; k < b->n; k++) {
        const point p = b->x[k] - b->x[0], q = b->x[(k + 1) % b->n] - b->x[0];
        b->area += cimag(conj(p) * q) / 2;
        S += cimag(conj(p) * q) * (p + q) / 6;
    }
    b->centre = b->x[0] + S / b->area;
}

/* Adds a block of four corners. */
static void add_four(scene *s, int held, const point x[4])
{
    shape *b = &s->b[s->blocks++];

    *b = (shape){ 4, held, { x[0], x[1], x[2], x[3] }, 0, 0 };
    measure(b);
}

static void add_box(scene *s, int held, double x, double y, double X, double Y)
{
    add_four(s, held, (point[]){ x + I * y, X + I * y, X + I * Y, x + I * Y });
}

/* What is held below, and with sides up to a height left and right: small, or large. */
static void add_base(scene *s, double x, double X, double height)
{
    const double d = s->heavy ? 60 : 0.5;

    add_box(s, 1, x - d, -d, X + d, 0);
    if (height > 0) {
        add_box(s, 1, x - d, 0, x, height);
        add_box(s, 1, X, 0, X + d, height);
    }
}

/* Blocks on each other; between sides all are as wide as these are apart. */
static void draw_stack(scene *s, int sides)
{
    const int n = pick(1, 4);
    double x = 0, X = draw(0.6, 1.5), y = 0;

    add_base(s, x, X, sides ? draw(0.3, 2) : 0);
    for (int k = 0; k < n; k++) {
        const double h = draw(0.3, 1), wide = draw(0.4, 1.5);
        if (!sides && k > 0) {
            x += draw(-0.3, 0.3) + (X - x - wide) / 2;
            X = x + wide;
        }
        add_box(s, 0, x, y, X, y + h);
        y += h;
    }
}

/* Bricks in courses, every other one with a half at its ends. */
static void draw_wall(scene *s, int sides)
{
    const int bricks = pick(1, 3), courses = pick(2, 4);
    const double h = draw(0.3, 0.8);

    add_base(s, 0, bricks, sides ? draw(0.5, courses) * h : 0);
    for (int row = 0; row < courses; row++)
        for (int k = 0; k < bricks + row % 2; k++)
            add_box(s, 0, fmax(0, k - row % 2 * 0.5), row * h, fmin(bricks, k + 1 - row % 2 * 0.5),
                    row * h + h);
}

/* The part of a block to the left of the line through p along d. */
static shape part_of(const shape *b, point p, point d)
{
    shape part = { 0, 0, { 0 }, 0, 0 };

    for (int k = 0; k < b->n; k++) {
        const point x = b->x[k], y = b->x[(k + 1) % b->n];
        const double f = cimag(conj(d) * (x - p)), g = cimag(conj(d) * (y - p));
        if (f > 0)
            part.x[part.n++] = x;
        if (f * g < 0)
            part.x[part.n++] = x + f / (f - g) * (y - x);
    }
    measure(&part);
    return part;
}

/* A rectangle of which one piece after another is cut in two: three pieces meet at a point. */
static void draw_cut(scene *s, int sides)
{
    const double X = draw(1, 2), Y = draw(0.8, 2);

    add_base(s, 0, X, sides ? draw(0.3, 0.95) * Y : 0);
    const int first = s->blocks;
    add_box(s, 0, 0, 0, X, Y);
    for (int k = pick(1, 4); k > 0; k--) {
        shape *b = &s->b[pick(first, s->blocks - 1)];
        const point p = b->centre + draw(0, 0.1) * draw_way(), d = draw_way();
        s->b[s->blocks++] = part_of(b, p, -d);
        *b = part_of(b, p, d);
    }
}

/* Voussoirs of a mean radius 2 between springers, up to a half circle. */
static void draw_arch(scene *s, int sides)
{
    const int n = pick(2, 9);
    const double half = draw(0.6, 1.5707963), t = draw(0.3, 1.2);
    const double d = sides || !s->heavy ? 0.5 : 40, r = 2 - t / 2, R = 2 + t / 2;
    const point left = I * cexp(half * I), right = -conj(left), turn = cexp(-2 * half / n * I);

    add_four(s, 1, (point[]){ (r + d * I) * left, r * left, R * left, (R + d * I) * left });
    add_four(s, 1, (point[]){ r * right, (r - d * I) * right, (R - d * I) * right, R * right });
    for (int k = 0; k < n; k++) {
        const point p = left * cpow(turn, k), q = left * cpow(turn, k + 1);
        add_four(s, 0, (point[]){ r * p, r * q, R * q, R * p });
    }
}

/* The segment along which edge i of one block and edge j of another one touch, if they do. */
static void find_touch(scene *s, int a, int i, int b, int j)
{
    const shape *p = &s->b[a], *q = &s->b[b];
    const point x = p->x[i], d = p->x[(i + 1) % p->n] - x, e = q->x[(j + 1) % q->n] - q->x[j];
    const point way = d / cabs(d), from = conj(way) * (q->x[(j + 1) % q->n] - x);
    const double to = creal(conj(way) * (q->x[j] - x));
    const double least = fmax(0, creal(from)), most = fmin(cabs(d), to);

    if (creal(conj(way) * e) > -(1 - 1e-9) * cabs(e) || fabs(cimag(from)) > 1e-9
        || most < least - 0.05)
        return;
    s->bad |= most - least < 0.05 || s->touches == TOUCHES;
    if (!s->bad)
        s->t[s->touches++] = (touch){ a, b, { x + least * way, x + most * way }, way * I };
}

/* All of them. No edge is to be shorter than 0.1, and none to touch along less than 0.05. */
static void find_touches(scene *s)
{
    s->touches = 0;
    for (int a = 0; a < s->blocks; a++) {
        const shape *p = &s->b[a];
        s->bad |= p->n < 3 || p->area < 0.03;
        for (int i = 0; i < p->n; i++)
            s->bad |= cabs(p->x[(i + 1) % p->n] - p->x[i]) < 0.1;
        for (int b = 0; b < a; b++)
            for (int k = 0; k < p->n * s->b[b].n && !(p->held && s->b[b].held); k++)
                find_touch(s, a, k / s->b[b].n, b, k % s->b[b].n);
    }
}

/* A force on a corner, or a tilt. */
static void draw_load(scene *s)
{
    const point way = chance(0.5) ? 2 * pick(0, 1) - 1 : draw_way();

    do
        s->loaded = pick(0, s->blocks - 1);
    while (s->b[s->loaded].held);
    s->corner = pick(0, s->b[s->loaded].n - 1);
    *(chance(0.35) ? &s->tilt : &s->force) = way;
}

/* Whether a scene stands without the load, its limit depends little on the friction, and without
 * friction nothing in it is free to slide. */
static int is_fit(scene *s)
{
    const double mu = tan(s->friction / 57.29577951);

    if (s->bad || !balances(s, mu, 0, 0))
        return 0;
    s->limit = find_limit(s, mu);
    if (!(s->limit > 0.05 && s->limit < (s->tilt != 0 ? 5 : 20)))
        return 0;
    return mu > 0 ? find_limit(s, 1.002 * mu) < 1.01 * s->limit
                  : balances(s, mu, 0.97 * s->limit, 1);
}

/* Draws until a scene is fit. The seed is spread, since drand48 begins alike for neighbours. */
static int draw_scene(scene *s, unsigned long seed)
{
    static void (*const kind[])(scene *, int) = { draw_stack, draw_wall, draw_cut, draw_arch };
    scene frame = { .seed = seed, .kind = 0 };

    srand48((long)(seed * 2654435761u % 4294967296u));
    frame.friction = chance(0.2) ? 0 : draw(3, 40);
    frame.kind = pick(0, frame.friction > 0 ? ARCH : CUT);
    frame.size = pick(0, 3);
    frame.unit = pick(0, 2);
    frame.heavy = pick(0, 1);
    frame.mirrored = pick(0, 1);
    frame.steps = chance(0.5) ? 0 : pick(5, 40);
    frame.Q = draw_way();
    for (int k = 0; k < 2000; k++) {
        *s = frame;
        kind[s->kind](s, s->friction > 0 ? chance(0.25) : 1);
        find_touches(s);
        draw_load(s);
        if (is_fit(s))
            return 1;
    }
    return 0;
}

/* ------------------------------------------------------------------------------------ running */

/* Length in m, mass in kg; seconds in all. */
typedef struct { double length, mass; } units;

/* The lines of the table: kinds, sizes, units, and so on. */
enum { BY_SIZE = 4, BY_UNIT = 8, BY_BASE = 11, BY_FRICTION = 13, BY_LOAD = 15, BY_FACTOR = 17,
       ALL = 22, LINES };

static const char *const NAME[LINES] = { "stack", "wall", "cut", "arch", "1 cm", "10 cm", "1 m",
    "100 m", "SI", "mm N MPa", "cm kN", "light base", "heavy base", "no friction", "friction",
    "force", "tilt", "at 1.05", "at 1.2", "at 1.5", "at 0.95", "at 0.97", "all" };

static const units UNIT[] = { { 1, 1 }, { 1e-3, 1e3 }, { 1e-2, 1e5 } };
static const double SIZE[] = { 0.01, 0.1, 1, 100 }, FACTOR[] = { 1.05, 1.2, 1.5, 0.95, 0.97 };

static void write_vector(FILE *o, const scene *s, const char *text, point x, double size)
{
    const point z = s->Q * (s->mirrored ? -conj(x) : x) * size;

    fprintf(o, "%s %.17g %.17g", text, creal(z), cimag(z));
}

/* Rock of 2500 kg/m^3, so stiff that a block yields by 2.5e-6 of its size or less; contacts as they
 * are by default. In dynamics it settles before it is left alone. */
static void write_model(FILE *o, const scene *s, double factor, int dynamic)
{
    const units *u = &UNIT[s->unit];
    const double length = SIZE[s->size] / u->length, pascal = u->length / u->mass;
    const double density = 2500 * pow(u->length, 3) / u->mass, g = 9.81 / u->length;
    fprintf(o, "title %s, at %g of its limit %.6g\n", NAME[s->kind], factor, s->limit);
    const double E = 1e10 * fmax(1, s->stiffer) * fmax(1, SIZE[s->size]) * pascal;

    fprintf(o, "material rock E %.17g nu 0.2 density %.17g\n", E, density);
    fprintf(o, "material held E %.17g nu 0.2 density %.17g\n", 100 * E, density);
    fprintf(o, "contact friction %.17g\n", s->friction);
    if (dynamic)
        fprintf(o, "dynamic dt %.3g steps 400 settle 200\n", 0.01 * sqrt(length / g));
    else if (s->steps > 0)
        fprintf(o, "static steps %d tolerance 1e-6\n", s->steps);
    else
        fprintf(o, "static\n");
    write_vector(o, s, "gravity", -I + factor * s->limit * s->tilt, g);
    for (int k = 0; k < s->blocks; k++) {
        fprintf(o, "\nblock b%d %s", k, s->b[k].held ? "held" : "rock");
        for (int c = 0; c < s->b[k].n; c++)
            write_vector(o, s, "", s->b[k].x[c], length);
        if (s->b[k].held)
            fprintf(o, "\nfixblock b%d", k);
    }
    if (s->force != 0) {
        write_vector(o, s, "\nload at", s->b[s->loaded].x[s->corner], length);
        fprintf(o, " of b%d", s->loaded);
        write_vector(o, s, "", factor * s->limit * s->force, density * g * length * length);
    }
    fprintf(o, "\n");
}

/* The farthest way of a barycentre, in sizes. */
static double find_way(const scene *s, const char *folder)
{
    char line[400];
    double most = 0, u, v;

    snprintf(line, sizeof line, "%s/out/elements.csv", folder);
    FILE *f = fopen(line, "r");
    while (f && fgets(line, sizeof line, f))
        if (sscanf(line, "%*d,%*[^,],%*[^,],%*[^,],%lf,%lf", &u, &v) == 2)
            most = fmax(most, hypot(u, v) * UNIT[s->unit].length / SIZE[s->size]);
    if (f)
        fclose(f);
    return most;
}

enum { STANDS, FALLS, UNKNOWN, BROKEN };

/* What ./bbm says: status 0; "it falls"; another reason; neither. Dynamics: falls what goes on by
 * more than a hundredth of its size. */
static int ask(const scene *s, double factor, int dynamic, const char *folder, double *way)
{
    char text[300];

    snprintf(text, sizeof text, "mkdir -p %s; cd %s; rm -rf out; cat > scene.model; ulimit -t 60; "
             "../../../bbm -q scene.model -o out > /dev/null 2> said; s=$?; [ $s = 0 ] && exit 0; "
             "grep -q 'it falls' said && exit 1; [ $s = 1 -a -s said ] && exit 2; exit 3",
             folder, folder);
    FILE *o = popen(text, "w");
    if (!o)
        return BROKEN;
    write_model(o, s, factor, dynamic);
    const int end = WEXITSTATUS(pclose(o));
    *way = find_way(s, folder);
    return dynamic && end != BROKEN && *way > 0.01 ? FALLS : end;
}

/* ------------------------------------------------------------------------------------ judging */

enum { RUNS, FALSE_STANDS, FALSE_FALLS, EARLY, YIELDS, THIRD_ABOVE, THIRD_BELOW, ODD, OUTCOMES };
/* Early: below the limit, but with friction. Yields: without, but stiffer blocks stand. */
static const char *const OUTCOME[] = { "runs", "false stands", "false falls", "early falls",
    "yields", "unknown above", "unknown below", "broken off" };

/* What a run counts as besides a run; RUNS: it is right. */
static int judge(const scene *s, double factor, int said)
{
    if (said == BROKEN)
        return ODD;
    if (said == UNKNOWN)
        return factor > 1 ? THIRD_ABOVE : THIRD_BELOW;
    if ((said == STANDS) == (factor < 1))
        return RUNS;
    return said == STANDS ? FALSE_STANDS : s->friction > 0 ? EARLY : FALSE_FALLS;
}

/* Counts a run in each line of the table that it belongs to. */
static void count_run(const scene *s, int k, int outcome, long tally[][OUTCOMES])
{
    const int line[] = { s->kind, BY_SIZE + s->size, BY_UNIT + s->unit, BY_BASE + s->heavy,
        BY_FRICTION + (s->friction > 0), BY_LOAD + (s->tilt != 0), BY_FACTOR + k, ALL };

    for (int i = 0; i < 8; i++) {
        tally[line[i]][RUNS]++;
        tally[line[i]][outcome] += outcome != RUNS;
    }
}

/* A line for each finding, and its model is kept. */
static void try_scene(const scene *s, const char *folder, int dynamic, long tally[][OUTCOMES])
{
    scene rigid = *s;
    static const char *const said[] = { "stands", "falls", "is not known", "breaks off" };
    char text[200];
    double way;

    for (int k = 0; k < 5; k++) {
        int outcome = judge(s, FACTOR[k], ask(s, FACTOR[k], 0, folder, &way));
        rigid.stiffer = 100;            /* the linear program is about rigid blocks */
        if (outcome == FALSE_FALLS) {
            outcome = ask(&rigid, FACTOR[k], 0, folder, &way) == STANDS ? YIELDS : FALSE_FALLS;
            ask(s, FACTOR[k], 0, folder, &way);             /* its model is kept */
        }
        count_run(s, k, outcome, tally);
        if (outcome == RUNS)
            continue;
        printf("seed %lu %s, %s, %s, %s, friction %.3g: %s at %g of its limit %.4g, way %.1e",
               s->seed, NAME[s->kind], NAME[BY_SIZE + s->size], NAME[BY_UNIT + s->unit],
               NAME[BY_BASE + s->heavy], s->friction, OUTCOME[outcome], FACTOR[k], s->limit, way);
        snprintf(text, sizeof text, "mv %s/scene.model %s/%lu-%g.model", folder, folder, s->seed,
                 FACTOR[k]);
        if (system(text) == 0 && dynamic) {
            const int end = ask(s, FACTOR[k], 1, folder, &way);
            printf("; dynamics: %s, way %.1e", said[end], way);
        }
        printf("\n");
    }
}

static void print_tally(long tally[][OUTCOMES])
{
    printf("\n%-12s", "");
    for (int k = 0; k < OUTCOMES; k++)
        printf(" %13s", OUTCOME[k]);
    for (int i = 0; i < LINES; i++) {
        printf("\n%-12s", NAME[i]);
        for (int k = 0; k < OUTCOMES; k++)
            printf(" %13ld", tally[i][k]);
    }
    printf("\n");
}

/* ----------------------------------------------------------------------------------- checking */

/* 1e-6: the linear program is solved to 1e-8 or so. */
static int compare(const char *name, double value, double theory)
{
    const int good = fabs(value - theory) < 1e-6 * theory;

    printf("%-40s %.7f  theory %.7f%s\n", name, value, theory, good ? "" : "  WRONG");
    return good;
}

/* The limit by a tilt, or by a push to the left at a corner of a block, on a base from -2 to 9. */
static double limit_of(scene *s, int block, int corner, double mu)
{
    add_box(s, 1, -2, -1, 9, 0);
    find_touches(s);
    s->loaded = block;
    s->corner = corner;
    *(block < 0 ? &s->tilt : &s->force) = -1;
    return s->bad ? NAN : find_limit(s, mu);
}

/* The least friction with which it stands. */
static double least_friction(scene *s)
{
    double low = 0, high = 10;

    find_touches(s);
    while (high - low > 1e-12)
        *(balances(s, (low + high) / 2, 0, 0) ? &high : &low) = (low + high) / 2;
    return s->bad ? NAN : high;
}

/* A leg from the ground, x in [1, a], to the line x = 0, y in [b, c]. */
static void add_leg(scene *s, double a, double b, double c)
{
    add_four(s, 0, (point[]){ 1, a, c * I, b * I });
}

static int check_blocks(void)
{
    scene incline = { .loaded = -1 }, push = { 0 }, stack = { 0 }, wedge = { .blocks = 2 };
    const double a = atan(0.3), mu = 0.7;

    add_box(&incline, 0, 0, 0, 1, 0.2);
    add_box(&push, 0, 0, 0, 0.5, 1);
    add_box(&stack, 0, 0, 0, 1, 0.5);
    add_box(&stack, 0, 0.1, 0.5, 1, 1.3);
    add_box(&wedge, 0, 0, 0, 3, 1);
    wedge.b[0] = part_of(&wedge.b[2], 0.5 + 0.5 * I, -1 + 0.3 * I);
    wedge.b[1] = part_of(&wedge.b[2], 0.5 + 0.5 * I, 1 - 0.3 * I);
    wedge.b[0].held = 1;
    wedge.blocks = 2;
    return compare("a block on an incline slides", limit_of(&incline, -1, 0, 0.6), 0.6)
         & compare("a block pushed on top topples", limit_of(&push, 0, 2, 3), 0.5 * 0.25)
         & compare("a stack on an incline topples", limit_of(&stack, -1, 0, 0.9),
                   (0.5 * 0.5 + 0.72 * 0.55) / (0.5 * 0.25 + 0.72 * 0.9))
         & compare("a piece slides up a cut", limit_of(&wedge, -1, 0, mu), tan(a + atan(mu)));
}

/* The foot slides: N1 = W - mu N2 at x = 1, N2 = mu N1 at y = c. Of two cards each is a ladder on a
 * wall without friction. */
static int check_legs(void)
{
    scene ladder = { .loaded = -1 }, cards = { .loaded = -1 };
    const double a = 1.15, b = 1.7, c = 1.9;

    add_leg(&ladder, a, b, c);
    add_leg(&cards, a, b, c);
    const double x = creal(ladder.b[0].centre);
    add_box(&ladder, 1, -1, 0.5, 0, 5);
    add_four(&cards, 0, (point[]){ b * I, c * I, -a, -1 });
    add_box(&ladder, 1, -2, -1, 9, 0);
    add_box(&cards, 1, -2, -1, 9, 0);
    return compare("friction of a ladder", least_friction(&ladder),
                   (sqrt(c * c - 4 * x * (x - 1)) - c) / (2 * x))
         & compare("friction of an arch of two stones", least_friction(&cards), (1 - x) / c);
}

/* limit check, or limit [seed [scenes [seconds]]] [dynamic], scenes 0: until the time is over */
int main(int argc, char **argv)
{
    const int dynamic = argc > 1 && strcmp(argv[argc - 1], "dynamic") == 0, given = argc - dynamic;
    const unsigned long seed = given > 1 ? strtoul(argv[1], NULL, 10) : 1;
    const long scenes = given > 2 ? atol(argv[2]) : 0;
    const time_t end = time(NULL) + (given > 3 ? atol(argv[3]) : 60);
    long tally[LINES][OUTCOMES] = { { 0 } }, done = 0, none = 0;
    char folder[60];
    scene s;

    if (given > 1 && strcmp(argv[1], "check") == 0)
        return !(check_blocks() & check_legs());
    setvbuf(stdout, NULL, _IOLBF, BUFSIZ);
    snprintf(folder, sizeof folder, "out/limit/%lu", seed);
    for (; (scenes == 0 || done < scenes) && time(NULL) < end; done++)
        if (draw_scene(&s, seed + (unsigned long)done))
            try_scene(&s, folder, dynamic, tally);
        else
            none++;
    print_tally(tally);
    printf("%ld scenes, %ld of them not drawn\n", done, none);
    return tally[ALL][FALSE_STANDS] + tally[ALL][FALSE_FALLS] + tally[ALL][ODD] > 0;
}
