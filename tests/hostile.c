/* hostile.c - scenes that a stranger would try, run by ./bbm as a user runs it, and judged by its tables alone.
 *
 *     make torture                          does it after its own scenes, from seed 1 on
 *     make torture SEED=17 SCENES=1         one of them: out/hostile/17/scene.model is left to look at, its twins beside it
 *
 * A scene is drawn in units of its own: lengths of about 1, speeds of about 1, density 1. A frame writes it as a model
 * file: in some unit of length, time and mass, turned, mirrored, moved, its blocks in another order. The tables are read
 * back through the frame, so that twins can be compared number by number. Nothing here knows the library: the oracle is
 * doc/model-file.md, doc/tables.md, doc/failures.md, and mechanics. */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>

enum { BLOCKS = 20, CORNERS = 12, STEPS = 60, CELLS = 2 + 2 * BLOCKS * CORNERS, LINE = 26 * CELLS };

typedef double point[2];

typedef struct {
    point x[CORNERS];
    int n, fixed;
    double v[3], push[2], load[2], pressure;   /* velocity and spin; way of a support; N; Pa */
} shape;

typedef struct {
    const char *kind;
    uint64_t state;                            /* of the random numbers */
    shape b[BLOCKS];
    int blocks, steps, settle, is_static, strain, joint;
    double E, nu, dt, g[2], kn, ks, friction, cohesion, tension, shake[3], water, incline;
} scene;

/* x_model = length Q (x + shift) */
typedef struct {
    const char *name;
    double Q[2][2], shift[2], length, time, mass, nudge;
    int order, far;
} frame;

typedef struct {
    int status, rows;                          /* rows: of history.csv */
    char said[400];
    point path[STEPS + 1][BLOCKS][CORNERS];
    double v[BLOCKS][3], elastic, springs, reaction[2], off_cone;
    double sum[STEPS + 1][5];                  /* kinetic, elastic, springs, external, gained */
} run;

enum { REFUSED, TOO_SOFT, BROKEN, TABLES, CONE, ENERGY, GAINED, MOMENTUM, SPIN, OVERLAP, THROUGH, THEORY, MIRROR, TURNED,
       UNITS, ORDER, FAR, RULES };

static const char *rule_name(int rule)
{
    static const char *const name[RULES] = { "refused", "too soft", "broken off or without reason", "tables disagree",
        "friction beyond its cone", "energy grows", "gained too much", "momentum", "angular momentum", "overlap",
        "passed through", "theory", "mirrored twin", "turned twin", "twin in other units", "twin in another order",
        "twin with things far away" };
    return name[rule];
}

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

static shape *add(scene *s, int n, const point x[])
{
    shape *b = &s->b[s->blocks++];

    memset(b, 0, sizeof *b);
    b->n = n;
    memcpy(b->x, x, (size_t)n * sizeof x[0]);
    return b;
}

static shape *add_box(scene *s, double x, double y, double X, double Y)
{
    return add(s, 4, (const point[]){ { x, y }, { X, y }, { X, Y }, { x, Y } });
}

/* A sliver, an L, a star, a triangle or a polygon, within r of (x, y). */
static shape *add_odd(scene *s, double x, double y, double r)
{
    const int form = pick(s, 0, 4), n = form == 1 ? 6 : form == 2 ? 2 * pick(s, 3, 5) : form == 3 ? 3 : form ? pick(s, 4, 8) : 4;
    const double angle = chance(s, 0.3) ? 0 : draw(s, 0, 6.28), thin = draw_power(s, -2, -0.5), arm = draw(s, 0.2, 0.6);
    const point sliver[] = { { -0.9, -thin / 3 }, { 0.9, -thin / 3 }, { 0.9, thin / 3 }, { -0.9, thin / 3 } };
    const point l[] = { { -0.7, -0.7 }, { 0.7, -0.7 }, { 0.7, arm - 0.7 }, { arm - 0.7, arm - 0.7 }, { arm - 0.7, 0.7 }, { -0.7, 0.7 } };
    point p[CORNERS];

    for (int k = 0; k < n; k++) {
        const double a = 6.2831853 * (k + (form == 4 ? draw(s, -0.3, 0.3) : 0)) / n, R = form == 2 && k % 2 ? arm : 1;
        const double X = form == 0 ? sliver[k][0] : form == 1 ? l[k][0] : R * cos(a);
        const double Y = form == 0 ? sliver[k][1] : form == 1 ? l[k][1] : R * sin(a);
        p[k][0] = x + r * (X * cos(angle) - Y * sin(angle));
        p[k][1] = y + r * (X * sin(angle) + Y * cos(angle));
    }
    return add(s, n, (const point *)p);
}

static void add_soup(scene *s, double speed)
{
    const int across = pick(s, 1, 4), up = pick(s, 1, 3);

    for (int k = 0; k < across * up; k++) {
        const double r = chance(s, 0.15) ? draw_power(s, -2, -1) : draw(s, 0.15, 0.495);
        shape *b = add_odd(s, k % across + 0.5, k / across + 0.5, r);
        for (int c = 0; c < 3; c++)
            b->v[c] = draw(s, -speed, speed);
    }
    if (chance(s, 0.3))
        add_box(s, -5, up + 0.01, across + 5, up + 6)->v[1] = draw(s, -speed, 0);
}

static void draw_soup(scene *s)
{
    add_soup(s, 1);
    if (chance(s, 0.3))
        s->b[0].pressure = draw(s, 0, 0.01) * s->E;
    if (chance(s, 0.3))
        s->b[0].load[0] = draw(s, -1, 1);
}

static void draw_pit(scene *s)
{
    add_soup(s, draw(s, 0, 1));
    add_box(s, -6, -1, 10, -0.01)->fixed = 1;
    add_box(s, -6, -0.01, -5.1, 4)->fixed = 1;
    s->g[1] = -draw_power(s, -1, 1);
}

static void draw_slabs(scene *s)
{
    const int n = pick(s, 2, 6), held = chance(s, 0.5);

    for (int k = 0; k < n; k++)
        add_box(s, k, -0.5, k + 1, 0)->fixed = held;
    if (!held)
        add_box(s, -1, -1, n + 1, -0.5)->fixed = 1;
    add_box(s, 0.2, 0, draw(s, 0.3, 1.6), draw(s, 0.05, 0.4))->v[0] = draw(s, 0.5, 1.5);
    s->g[1] = -draw_power(s, -1, 1);
    s->dt = draw_power(s, -2.5, -1);
}

static void draw_shot(scene *s)
{
    const double r = draw_power(s, -2, -0.7), way = draw_power(s, -1, 1.4);
    const int n = pick(s, 1, 4), held = chance(s, 0.5);

    add_odd(s, 0, draw(s, 1, 2), r)->v[0] = 1;
    s->b[0].v[1] = draw(s, -0.3, 0.3);
    s->dt = way * 2 * r;
    s->steps = s->steps < 30 ? s->steps : 30;
    for (int k = 0; k < n; k++)
        add_box(s, 1 + k, -8, k + draw(s, 1.02, 2), 8)->fixed = held;
}

static void draw_piston(scene *s)
{
    const double gap = chance(s, 0.5) ? 0 : draw(s, 0, 0.2);
    const int n = pick(s, 1, 4);
    shape *p = add_box(s, -2, 0.01, -1, 1);

    p->fixed = 1;
    p->push[0] = draw_power(s, -2, 0.3);
    p->push[1] = chance(s, 0.3) ? draw(s, 0, 0.5) : 0;
    add_box(s, -3, -1, 12, 0)->fixed = 1;
    for (int k = 0; k < n; k++)
        add_box(s, k - 1 + gap * (k + 1), 0, k + gap * (k + 1), draw(s, 0.5, 1.5));
    if (chance(s, 0.3))
        add_box(s, 7, 0, 8, 2)->fixed = 1;
    s->g[1] = chance(s, 0.8) ? -draw_power(s, -1, 1) : 0;
}

static void draw_stack(scene *s)
{
    const int n = pick(s, 1, 4), way = pick(s, 0, 5);
    shape *table = add_box(s, -2, -0.5, 6, 0);

    table->fixed = 1;
    s->g[1] = -draw_power(s, -1, 1);
    s->friction = draw(s, 20, 50);
    for (int k = 0; k < n; k++)
        for (int i = 0; i < 5 - k; i++)
            add_box(s, i + k * 0.5, k * 0.5, i + 1 + k * 0.5, k * 0.5 + 0.5);
    if (way == 0)
        s->shake[0] = draw(s, -2, 2) * s->g[1], s->shake[1] = draw(s, 0, 0.3), s->shake[2] = draw_power(s, -1, 0) / s->dt;
    if (way == 1)
        s->water = draw(s, 0.1, 3);
    if (way == 2)
        s->cohesion = s->E * draw_power(s, -5, -2), s->tension = s->cohesion / 2;
    if (way == 3)
        table->push[0] = draw(s, -0.3, 0.3), table->push[1] = draw(s, 0, 0.1);
    s->is_static = way == 4;
    s->settle = way == 5 ? 10 : 0;
}

static void draw_wedge(scene *s)
{
    const double open = draw(s, 0.2, 1.5), up = draw(s, 0, 0.2);
    const int held = chance(s, 0.5);

    add(s, 4, (const point[]){ { -3, 0 }, { 0, 0 }, { -open, 2 }, { -3, 2 } })->fixed = held;
    add(s, 4, (const point[]){ { 0, 0 }, { 3, 0 }, { 3, 2 }, { open, 2 } })->fixed = held;
    add(s, 3, (const point[]){ { 0, up }, { open, 2 + up }, { -open, 2 + up } })->v[1] = -draw(s, 0, 1);
    add_box(s, -9, -1, 9, 0)->fixed = 1;
    s->g[1] = -draw_power(s, -1, 1);
}

static void draw_incline(scene *s)
{
    const double g = draw_power(s, -1, 1);

    s->incline = draw(s, 0.05, 0.8);
    add_box(s, -2, -1, 60, 0)->fixed = 1;
    add_box(s, 0, 0, draw(s, 1, 3), draw(s, 0.2, 0.5));
    s->g[0] = g * sin(s->incline);
    s->g[1] = -g * cos(s->incline);
    s->E *= 100;
    s->kn *= 100;
    s->dt = draw_power(s, -2.5, -1) / sqrt(g);
}

/* A row of blocks that cohesion keeps together flies and turns as one. */
static void draw_weld(scene *s)
{
    const int n = pick(s, 2, 6);
    const double w = draw(s, -1, 1), u = draw(s, -1, 1);

    for (int k = 0; k < n; k++) {
        shape *b = add_box(s, k, 0, k + 1, 1);
        b->v[0] = u - w * (0.5 - 0.5);
        b->v[1] = w * (k + 0.5 - n / 2.0);
        b->v[2] = w;
    }
    s->cohesion = s->tension = s->E * draw_power(s, -2, 1);
    if (chance(s, 0.5))
        add_odd(s, draw(s, 0, n), 2.6, 0.5)->v[1] = -1;
}

static void draw_scene(scene *s, uint64_t seed)
{
    static const struct { const char *name; void (*draw)(scene *); } kind[] = { { "soup", draw_soup }, { "pit", draw_pit },
        { "slabs", draw_slabs }, { "shot", draw_shot }, { "piston", draw_piston }, { "stack", draw_stack },
        { "wedge", draw_wedge }, { "incline", draw_incline }, { "weld", draw_weld } };

    memset(s, 0, sizeof *s);
    s->state = seed * 1000003;
    const int k = pick(s, 0, 8);
    s->kind = kind[k].name;
    s->E = draw_power(s, 3, 7);
    s->nu = draw(s, 0, 0.45);
    s->kn = s->E * draw_power(s, 0, 2);
    s->ks = s->kn * draw(s, 0.2, 1);
    s->dt = draw_power(s, -2.5, -0.7);
    s->steps = pick(s, 15, STEPS);
    s->strain = chance(s, 0.5);
    s->friction = chance(s, 0.2) ? 0 : draw(s, 0, 50);
    s->joint = chance(s, 0.1);
    kind[k].draw(s);
}

/* ------------------------------------------------------------------------------------------------------- writing */

static void turn(const frame *f, const double x[2], int inverse, double y[2])
{
    const double a = x[0], b = x[1];

    y[0] = a * f->Q[0][0] + b * (inverse ? f->Q[1][0] : f->Q[0][1]);
    y[1] = a * (inverse ? f->Q[0][1] : f->Q[1][0]) + b * f->Q[1][1];
}

static double handed(const frame *f) { return f->Q[0][0] * f->Q[1][1] - f->Q[0][1] * f->Q[1][0]; }

static void write_vector(FILE *o, const frame *f, const char *text, const double x[2], double unit)
{
    double y[2];

    turn(f, x, 0, y);
    fprintf(o, "%s%.17g %.17g", text, unit * y[0], unit * y[1]);
}

static void write_corner(FILE *o, const frame *f, const char *text, const double x[2])
{
    const double moved[2] = { x[0] + f->shift[0], x[1] + f->shift[1] };

    write_vector(o, f, text, moved, f->length);
}

static void write_block(FILE *o, const scene *s, const frame *f, int k)
{
    const shape *b = &s->b[k];
    const double speed = f->length / f->time * f->nudge, force = f->mass * f->length / f->time / f->time;

    fprintf(o, "block b%d rock", k);
    for (int c = 0; c < b->n; c++)
        write_corner(o, f, "  ", b->x[(c + f->order * 2) % b->n]);
    fprintf(o, "\n");
    if (b->fixed)
        fprintf(o, "fixblock b%d\n", k);
    if (b->push[0] != 0 || b->push[1] != 0) {
        double p[2];
        turn(f, b->push, 0, p);
        fprintf(o, "fix set b%d x by %.17g y by %.17g\n", k, f->length * p[0], f->length * p[1]);
    }
    if (b->v[0] != 0 || b->v[1] != 0 || b->v[2] != 0) {
        fprintf(o, "velocity b%d", k);
        write_vector(o, f, " ", b->v, speed);
        fprintf(o, " %.17g\n", b->v[2] * handed(f) / f->time * f->nudge);
    }
    if (b->load[0] != 0) {
        fprintf(o, "load set b%d", k);
        write_vector(o, f, " ", b->load, force);
        fprintf(o, "\n");
    }
    if (b->pressure > 0)
        fprintf(o, "pressure set b%d %.17g\n", k, b->pressure * force / f->length / f->length);
    if (s->water > 0 && !b->fixed && b->x[0][1] < s->water)
        fprintf(o, "water set b%d %.17g density %.17g\n", k, f->length * (s->water + f->shift[1]), f->mass / pow(f->length, 3) / 2.5);
}

static void write_model(FILE *o, const scene *s, const frame *f)
{
    const double pascal = f->mass / f->length / f->time / f->time, spring = f->mass / f->time / f->time;
    const double gravity = f->length / f->time / f->time;

    fprintf(o, "title %s %s\nplane %s\n", s->kind, f->name, s->strain ? "strain" : "stress");
    fprintf(o, "material rock E %.17g nu %.17g density %.17g thickness %.17g\n", s->E * pascal, s->nu,
            f->mass / pow(f->length, 3), f->length);
    fprintf(o, "contact kn %.17g ks %.17g friction %.17g cohesion %.17g tension %.17g\n", s->kn * spring, s->ks * spring,
            s->friction, s->cohesion * pascal, s->tension * pascal);
    if (s->joint)
        fprintf(o, "joint b0 * friction %.17g\n", s->friction / 2);
    if (s->g[0] != 0 || s->g[1] != 0)
        write_vector(o, f, "gravity ", s->g, gravity * f->nudge), fprintf(o, "\n");
    if (s->shake[2] > 0)
        write_vector(o, f, "shake ", s->shake, gravity), fprintf(o, " %.17g\n", s->shake[2] / f->time);
    if (s->is_static)
        fprintf(o, "static steps 20 tolerance 1e-6\n");
    else
        fprintf(o, "dynamic dt %.17g steps %d settle %d\n", s->dt * f->time, s->steps, s->settle);
    fprintf(o, "pcg tolerance 1e-12\n");
    for (int k = 0; k < s->blocks; k++)
        write_block(o, s, f, f->order ? s->blocks - 1 - k : k);
    for (int k = 0; f->far && k < 4; k++) {
        fprintf(o, "block far%d rock", k);
        write_corner(o, f, " ", (const point){ 1e4, 1e3 * k });
        write_corner(o, f, " ", (const point){ 1e4 + 1, 1e3 * k });
        write_corner(o, f, " ", (const point){ 1e4, 1e3 * k + 1 });
        fprintf(o, "\n");
        if (k % 2 || s->is_static)
            fprintf(o, "fixblock far%d\n", k);
    }
    for (int i = 0, node = 1; i < s->blocks; i++) {
        const int k = f->order ? s->blocks - 1 - i : i, n = s->b[k].n;
        for (int c = 0; c < n; c++)
            fprintf(o, "monitor m%d.%d node %d\n", k, (c + f->order * 2) % n, node++);
    }
}

/* ------------------------------------------------------------------------------------------------------- reading */

static int read_row(FILE *f, char *line, const char *cell[])
{
    int n = 0;

    if (!f || !fgets(line, LINE, f))
        return 0;
    for (char *p = strtok(line, ",\n"); p && n < CELLS; p = strtok(NULL, ",\n"))
        cell[n++] = p;
    return n;
}

static FILE *open_table(const char *folder, const char *name, char *line)
{
    const char *cell[CELLS];
    char path[900];

    snprintf(path, sizeof path, "%s/%s.csv", folder, name);
    FILE *f = fopen(path, "r");
    read_row(f, line, cell);
    return f;
}

static void read_history(const char *folder, const scene *s, const frame *f, char *line, run *r)
{
    const char *cell[CELLS];
    FILE *t = open_table(folder, "history", line);

    for (r->rows = 0; r->rows <= STEPS && read_row(t, line, cell) > 2; r->rows++)
        for (int j = 0, c = 2; j < s->blocks; j++)
            for (int o = 0, k = f->order ? s->blocks - 1 - j : j; o < s->b[k].n; o++, c += 2) {
                const int i = (o + f->order * 2) % s->b[k].n;
                const point u = { atof(cell[c]) / f->length, atof(cell[c + 1]) / f->length };
                double *x = r->path[r->rows][k][i];
                turn(f, u, 1, x);
                x[0] += s->b[k].x[i][0];
                x[1] += s->b[k].x[i][1];
            }
    if (t)
        fclose(t);
}

static void read_tables(const char *folder, const scene *s, const frame *f, run *r)
{
    static char line[LINE];
    const char *c[CELLS];
    const double joule = f->mass * f->length * f->length / f->time / f->time, newton = joule / f->length;
    const double E = s->strain ? s->E / (1 - s->nu * s->nu) : s->E, nu = s->strain ? s->nu / (1 - s->nu) : s->nu;
    const double slope = tan(s->friction * 3.14159265358979 / 180);
    FILE *t;

    read_history(folder, s, f, line, r);
    for (t = open_table(folder, "summary", line); read_row(t, line, c) > 10 && atoi(c[0]) <= STEPS && atoi(c[0]) >= 0;)
        for (int k = 0; k < 5; k++)
            r->sum[atoi(c[0])][k] = atof(c[6 + k]) / joule;
    for (t ? fclose(t) : 0, t = open_table(folder, "elements", line); read_row(t, line, c) > 10;) {
        const int k = atoi(c[1] + 1);
        const double p = (atof(c[7]) + atof(c[8])) / 2, q = hypot((atof(c[7]) - atof(c[8])) / 2, atof(c[9]));
        const double pascal = newton / f->length / f->length, a = (p + q) / pascal, b = (p - q) / pascal;
        double area = 0;
        if (c[1][0] == 'f')
            continue;
        for (int i = 0; i < s->b[k].n; i++) {
            const double *x = s->b[k].x[i], *y = s->b[k].x[(i + 1) % s->b[k].n];
            area += (x[0] * y[1] - x[1] * y[0]) / 2;
        }
        r->elastic += fabs(area) * (a * a + b * b - 2 * nu * a * b) / (2 * E);
        if (s->is_static)
            continue;
        turn(f, (const point){ atof(c[11]) * f->time / f->length, atof(c[12]) * f->time / f->length }, 1, r->v[k]);
        r->v[k][2] = atof(c[13]) * f->time * handed(f);
    }
    for (t ? fclose(t) : 0, t = open_table(folder, "contacts", line); read_row(t, line, c) > 7;) {
        const double N = atof(c[5]) / newton, T = atof(c[6]) / newton;
        r->springs += N * N / (2 * s->kn) + T * T / (2 * s->ks);
        r->off_cone = fmax(r->off_cone, fmax(-N, fabs(T) - slope * N));
    }
    for (t ? fclose(t) : 0, t = open_table(folder, "reactions", line); read_row(t, line, c) > 4;) {
        double R[2];
        turn(f, (const point){ atof(c[3]) / newton, atof(c[4]) / newton }, 1, R);
        r->reaction[0] += R[0];
        r->reaction[1] += R[1];
    }
    if (t)
        fclose(t);
}

static void try_frame(const scene *s, const frame *f, const char *folder, run *r)
{
    char command[900], name[300];

    memset(r, 0, sizeof *r);
    snprintf(name, sizeof name, "%s/%s.model", folder, f->name);
    FILE *o = fopen(name, "w");
    if (!o)
        exit(2);
    write_model(o, s, f);
    fclose(o);
    snprintf(command, sizeof command, "ulimit -t 60; rm -rf %s/out; ./bbm -q %s -o %s/out > %s/said 2>&1; echo $? > %s/status", folder,
             name, folder, folder, folder);
    if (system(command))
        exit(2);
    snprintf(name, sizeof name, "%s/status", folder);
    if ((o = fopen(name, "r")) && fscanf(o, "%d", &r->status) == 1)
        fclose(o);
    snprintf(name, sizeof name, "%s/said", folder);
    for (o = fopen(name, "r"); o && fgets(command, sizeof command, o);)
        if (!strstr(command, "arning"))
            snprintf(r->said, sizeof r->said, "%.399s", command);
    r->said[strcspn(r->said, "\n")] = 0;
    if (o)
        fclose(o);
    snprintf(name, sizeof name, "%s/out", folder);
    read_tables(name, s, f, r);
}

/* ------------------------------------------------------------------------------------------------------- geometry */

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

/* How far the place p is inside the polygon; 0 outside. */
static double depth_of(const double p[2], const point x[], int n)
{
    double least = INFINITY;
    int inside = 0;

    for (int k = 0; k < n; k++) {
        const double *a = x[k], *b = x[(k + 1) % n], l = (b[0] - a[0]) * (b[0] - a[0]) + (b[1] - a[1]) * (b[1] - a[1]);
        const double s = ((p[0] - a[0]) * (b[0] - a[0]) + (p[1] - a[1]) * (b[1] - a[1])) / l, t = fmin(1, fmax(0, s));
        least = fmin(least, hypot(p[0] - a[0] - t * (b[0] - a[0]), p[1] - a[1] - t * (b[1] - a[1])));
        if ((a[1] > p[1]) != (b[1] > p[1]) && p[0] < a[0] + (p[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0]))
            inside = !inside;
    }
    return inside ? least : 0;
}

/* The deepest place of the rim of x inside y: whoever parts the two has to move them at least as far. */
static double rim_depth(const point x[], int n, const point y[], int m)
{
    double most = 0;

    for (int k = 0; k < n; k++)
        for (int i = 0; i < 16; i++) {
            const double *a = x[k], *b = x[(k + 1) % n], t = i / 16.0;
            most = fmax(most, depth_of((const point){ a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]) }, y, m));
        }
    return most;
}

/* How deep the barycentre of one block passes through another from one row to the next, seen from the other, if it is
 * outside before and after. Straight: a block that turns the other way round within a step is not judged. */
static double deepest_pass(const run *r, int row, int i, int ni, int j, int nj)
{
    double a[2], A[2], b[2], B[2], I, most = 0;

    measure((const point *)r->path[row][i], ni, a, &I);
    measure((const point *)r->path[row + 1][i], ni, A, &I);
    measure((const point *)r->path[row][j], nj, b, &I);
    measure((const point *)r->path[row + 1][j], nj, B, &I);
    const double *e = r->path[row][j][0], *E = r->path[row + 1][j][0];
    const double w = atan2(E[1] - B[1], E[0] - B[0]) - atan2(e[1] - b[1], e[0] - b[0]);
    const double X = cos(w) * (A[0] - B[0]) + sin(w) * (A[1] - B[1]), Y = cos(w) * (A[1] - B[1]) - sin(w) * (A[0] - B[0]);
    if (cos(w) < 0.9 || depth_of(a, (const point *)r->path[row][j], nj) > 0 || depth_of(A, (const point *)r->path[row + 1][j], nj) > 0)
        return 0;
    for (double t = 0.02; t < 1; t += 0.02) {
        const point p = { a[0] + t * (b[0] + X - a[0]), a[1] + t * (b[1] + Y - a[1]) };
        most = fmax(most, depth_of(p, (const point *)r->path[row][j], nj));
    }
    return most;
}

/* ------------------------------------------------------------------------------------------------------- judging */

typedef struct {
    uint64_t seed;
    long scenes, twins, count[RULES];
    char folder[100];
} tally;

static void find(tally *t, const scene *s, int rule, const char *text, double value, double bound, int row)
{
    t->count[rule]++;
    printf("seed %llu %s: %s: %s %.3g, at most %.3g, row %d\n", (unsigned long long)t->seed, s->kind, rule_name(rule), text, value,
           bound, row);
}

/* A message has its row in doc/failures.md. */
static int has_row(const char *said)
{
    char line[500];
    int found = 0;
    FILE *f = fopen("doc/failures.md", "r");

    while (f && fgets(line, sizeof line, f))
        if (line[0] == '|' && strstr(line + 2, " |")) {
            *strstr(line + 2, " |") = 0;
            found |= strlen(line) > 10 && strstr(said, line + 2) != NULL;
        }
    if (f)
        fclose(f);
    return found;
}

static int judge_status(tally *t, const scene *s, const run *r)
{
    if (r->status == 0)
        return 1;
    const int rule = r->status > 2 || !has_row(r->said) ? BROKEN : strstr(r->said, "too soft") ? TOO_SOFT : REFUSED;
    t->count[rule]++;
    printf("seed %llu %s: %s: status %d, %s\n", (unsigned long long)t->seed, s->kind, rule_name(rule), r->status, r->said);
    return 0;
}

static void judge_overlap(tally *t, const scene *s, const run *r)
{
    double springs = 0, deep = 0, through = 0;

    for (int row = 0; row < r->rows; row++) {
        springs = fmax(springs, r->sum[row + (row < r->rows - 1)][2]);
        const double allowed = 1.5 * sqrt(2 * springs / s->kn) + 1e-6;
        for (int i = 0; i < s->blocks; i++)
            for (int j = 0; j < s->blocks; j++) {
                const point *x = (const point *)r->path[row][i], *y = (const point *)r->path[row][j];
                double c[2], I;
                if (i == j || (s->b[i].fixed && s->b[j].fixed))
                    continue;
                const double d = rim_depth(x, s->b[i].n, y, s->b[j].n);
                if (d > allowed && deep == 0)
                    find(t, s, OVERLAP, "depth", deep = d, allowed, row);
                const double bound = 0.1 * sqrt(measure(x, s->b[i].n, c, &I)) + allowed;
                if (row + 1 < r->rows && through == 0 && (through = deepest_pass(r, row, i, s->b[i].n, j, s->b[j].n)) > bound)
                    find(t, s, THROUGH, "depth", through, bound, row);
                else
                    through = 0;
            }
    }
}

typedef struct { double mass, M[2], C[2], P[2], size, K, L, L_size, I, moving; } ledger;

/* Mass, barycentre, momentum, angular momentum about the barycentre, and energy of what is not fixed; `moving`: sum of
 * what each block's angular momentum is by its own spin, times its angle in a step squared. */
static void balance(const scene *s, const run *r, int row, int start, ledger *l)
{
    memset(l, 0, sizeof *l);
    for (int turn_about = 0; turn_about < 2; turn_about++)
        for (int k = 0; k < s->blocks; k++) {
            const double *v = start ? s->b[k].v : r->v[k];
            double c[2], I, J;
            const double m = measure(s->b[k].x, s->b[k].n, c, &J), A = measure((const point *)r->path[row][k], s->b[k].n, c, &I);
            if (s->b[k].fixed)
                continue;
            I *= m / A;
            if (!turn_about) {
                l->mass += m;
                for (int d = 0; d < 2; d++)
                    l->P[d] += m * v[d], l->C[d] += m * c[d];
                l->size += m * hypot(v[0], v[1]);
                l->K += m * (v[0] * v[0] + v[1] * v[1]) / 2 + I * v[2] * v[2] / 2;
            } else {
                const double x = c[0] - l->C[0] / l->mass, y = c[1] - l->C[1] / l->mass;
                l->L += m * (x * v[1] - y * v[0]) + I * v[2];
                l->L_size += m * hypot(x, y) * hypot(v[0], v[1]) + I * fabs(v[2]);
                l->I += m * (x * x + y * y) + I;
                l->moving += I * fabs(v[2]) * v[2] * v[2] * s->dt * s->dt;
            }
        }
}

/* Work of gravity and loads from row 0 on. */
static double work(const scene *s, const run *r, int row)
{
    double sum = 0;

    for (int k = 0; k < s->blocks; k++) {
        double a[2], b[2], I;
        const double m = measure(s->b[k].x, s->b[k].n, a, &I);
        measure((const point *)r->path[0][k], s->b[k].n, a, &I);
        measure((const point *)r->path[row][k], s->b[k].n, b, &I);
        for (int d = 0; d < 2; d++)
            sum += m * s->g[d] * (b[d] - a[d]);
        for (int i = 0; i < s->b[k].n; i++)
            sum += s->b[k].load[0] / s->b[k].n * (r->path[row][k][i][0] - r->path[0][k][i][0]);
    }
    return sum;
}

/* Energy by own sums at the end, and row by row by the table, whose work of gravity is checked. */
static void judge_energy(tally *t, const scene *s, const run *r)
{
    const int end = r->rows - 1;
    const double *last = r->sum[end];
    double loads = s->water, size = 1e-12, once = 0;
    ledger start, now;

    balance(s, r, 0, 1, &start);
    balance(s, r, end, 0, &now);
    for (int k = 0; k < s->blocks; k++)
        loads = fmax(loads, s->b[k].pressure);
    const double W = loads > 0 ? last[3] : work(s, r, end);
    for (int row = 1; row <= end; row++) {
        const double *e = r->sum[row], E = e[0] + e[1] + e[2] - e[3];
        size = fmax(size, fmax(start.K, e[0] + e[1] + e[2]) + fabs(e[3]));
        if (E - start.K - e[4] > 1e-3 * size && once == 0)
            find(t, s, ENERGY, "by the table, beyond what it says is gained, share", once = (E - start.K - e[4]) / size, 1e-3, row);
    }
    if (last[4] > 0.01 * size)
        find(t, s, GAINED, "share", last[4] / size, 0.01, end);
    const double gain = (now.K + r->elastic + r->springs - W - start.K) / size;
    if (gain > 0.01)
        find(t, s, ENERGY, "by own sums, share", gain, 0.01, end);
    if (fabs(W - last[3]) > 1e-4 * size)
        find(t, s, TABLES, "work of loads and gravity beside `external`, share", (W - last[3]) / size, 1e-4, end);
    if (fabs(r->elastic - last[1]) > 1e-6 * size)
        find(t, s, TABLES, "energy of stresses beside `elastic`, share", (r->elastic - last[1]) / size, 1e-6, end);
    if (now.K - last[0] > 1e-3 * size)
        find(t, s, TABLES, "energy of velocities beside `kinetic`, share", (now.K - last[0]) / size, 1e-3, end);
    if (r->springs - last[2] > 1e-6 * size)
        find(t, s, TABLES, "energy of contacts beside `springs`, share", (r->springs - last[2]) / size, 1e-6, end);
}

/* Where nothing is fixed. Strain rates are not in the tables: their angular momentum is at most sqrt(2 I K), K the kinetic
 * energy that velocities and spins leave over. A scheme of second order turns with an error of angle^2/12 a step. */
static void judge_momentum(tally *t, const scene *s, const run *r)
{
    const int end = r->rows - 1;
    const double T = end * s->dt;
    double F[2] = { 0 }, once = 0, torque = 0;
    ledger start, now;

    balance(s, r, 0, 1, &start);
    balance(s, r, end, 0, &now);
    for (int k = 0; k < s->blocks; k++)
        F[0] += s->b[k].load[0], torque = fmax(torque, fabs(s->b[k].load[0]));
    const double size = start.size + now.size + (start.mass * hypot(s->g[0], s->g[1]) + torque) * T + 1e-12;
    for (int d = 0; d < 2; d++) {
        F[d] += start.mass * s->g[d];
        const double off = fabs(now.P[d] - start.P[d] - F[d] * T) / size;
        if (off > 1e-6)
            find(t, s, MOMENTUM, "share", off, 1e-6, end);
        for (int row = 1; row <= end && once == 0; row++) {
            const double time = row * s->dt;
            ledger l;
            balance(s, r, row, 0, &l);
            const double way = start.C[d] + start.P[d] * time + F[d] * time * time / 2;
            if (fabs(l.C[d] - way) > 1e-6 * size * T)
                find(t, s, MOMENTUM, "of the barycentre, share", once = fabs(l.C[d] - way) / (size * T), 1e-6, row);
        }
    }
    const double bound = 1e-5 * (start.L_size + now.L_size) + sqrt(2 * now.I * fmax(0, r->sum[end][0] - now.K)) + now.moving + start.moving;
    if (torque == 0 && fabs(now.L - start.L) > bound)
        find(t, s, SPIN, "change", fabs(now.L - start.L), bound, end);
}

/* A block on an incline: s = g (sin a - cos a tan phi) t^2/2, or it sticks, but for its springs. */
static void judge_incline(tally *t, const scene *s, const run *r)
{
    double a[2], b[2], I;
    const double A = measure((const point *)r->path[0][1], 4, a, &I), T = (r->rows - 1) * s->dt;
    const double phi = (s->joint ? s->friction / 2 : s->friction) * 3.14159265358979 / 180;

    measure((const point *)r->path[r->rows - 1][1], 4, b, &I);
    const double way = fmax(0, (s->g[0] + s->g[1] * tan(phi)) * T * T / 2), g = hypot(s->g[0], s->g[1]);
    const double bound = 0.01 * way + 10 * A * g * (1 / s->kn + 1 / s->ks + 10 / s->E);
    if (fabs(b[0] - a[0] - way) > bound)
        find(t, s, THEORY, "way beside that of the incline", fabs(b[0] - a[0] - way), bound, r->rows - 1);
}

static void judge_scene(tally *t, const scene *s, const run *r)
{
    int fixed = 0, moving = s->shake[2] > 0 || s->settle > 0;
    double W = 0, a[2], I, weight = 0;

    for (int k = 0; k < s->blocks; k++) {
        fixed |= s->b[k].fixed;
        moving |= s->b[k].push[0] != 0 || s->b[k].push[1] != 0;
        W = measure(s->b[k].x, s->b[k].n, a, &I) * s->g[1];
        weight += W;
    }
    if (!s->is_static && r->rows != s->steps + 1)
        find(t, s, TABLES, "rows of history.csv", r->rows, s->steps + 1, 0);
    if (r->rows < 1)
        return;
    judge_overlap(t, s, r);
    if (!s->joint && s->cohesion + s->tension == 0 && r->off_cone > 1e-6 * s->kn * sqrt(2 * r->springs / s->kn))
        find(t, s, CONE, "newton", r->off_cone, 1e-6 * s->kn * sqrt(2 * r->springs / s->kn), r->rows - 1);
    if (s->is_static && fabs(r->reaction[1] + weight) > 1e-3 * fabs(weight))
        find(t, s, THEORY, "reactions beside the weight", r->reaction[1], -weight, 0);
    if (!s->is_static && !moving)
        judge_energy(t, s, r);
    if (!s->is_static && !fixed)
        judge_momentum(t, s, r);
    if (s->incline > 0)
        judge_incline(t, s, r);
}

/* The first row in which two runs are apart by more than the bound. */
static double apart(const scene *s, const run *p, const run *q, int row)
{
    double most = 0;

    for (int k = 0; k < s->blocks; k++)
        for (int c = 0; c < s->b[k].n; c++)
            most = fmax(most, hypot(p->path[row][k][c][0] - q->path[row][k][c][0], p->path[row][k][c][1] - q->path[row][k][c][1]));
    return most;
}

/* What rounding does in a scene shows a run with velocities and gravity larger by 1e-10: a twin may be a thousand times
 * further off, in that row or before, and by a millionth of the way. */
static void judge_twin(tally *t, const scene *s, int rule, const run *r, const run *twin, const run *nudged)
{
    double allowed = 0;

    t->twins++;
    if (twin->status != r->status && nudged->status == r->status) {
        t->count[rule]++;
        printf("seed %llu %s: %s: status %d in place of %d, %s\n", (unsigned long long)t->seed, s->kind, rule_name(rule), twin->status,
               r->status, twin->said);
    }
    for (int row = 0; row < r->rows && row < twin->rows && row < nudged->rows; row++) {
        allowed = fmax(allowed, 3 * apart(s, r, nudged, row) + 1e-6 + 0.5 * sqrt(2 * fmax(r->sum[row][2], r->sum[row + (row < r->rows - 1)][2]) / s->ks));
        const double d = apart(s, r, twin, row);
        if (d > allowed) {
            find(t, s, rule, "apart", d, allowed, row);
            return;
        }
    }
}

static void try_scene(tally *t)
{
    static run r, twin, nudged;
    scene s;

    draw_scene(&s, t->seed);
    const double angle = draw(&s, 0.1, 6), w = s.water > 0;
    const double first = w || chance(&s, 0.4) ? 0 : draw(&s, 0, 6.28);
    frame plain = { .name = "scene", .Q = { { 1, 0 }, { 0, 1 } }, .length = draw_power(&s, -3, 3), .time = draw_power(&s, -3, 1),
                    .mass = draw_power(&s, -3, 6), .nudge = 1 };
    plain.Q[0][0] = plain.Q[1][1] = cos(first), plain.Q[1][0] = sin(first), plain.Q[0][1] = -plain.Q[1][0];
    frame f[7] = { plain, plain, plain, plain, plain, plain };
    f[0].name = "mirrored", f[0].Q[0][0] *= -1, f[0].Q[0][1] *= -1;
    f[1].name = "turned", f[1].shift[0] = draw(&s, -50, 50), f[1].shift[1] = draw(&s, -50, 50);
    if (w == 0)
        f[1].Q[0][0] = f[1].Q[1][1] = cos(first + angle), f[1].Q[1][0] = sin(first + angle), f[1].Q[0][1] = -f[1].Q[1][0];
    f[2].name = "units", f[2].length = draw_power(&s, -3, 3), f[2].time = draw_power(&s, -3, 1), f[2].mass = draw_power(&s, -3, 6);
    f[3].name = "order", f[3].order = 1;
    f[4].name = "far", f[4].far = 1;
    f[5].name = "nudged", f[5].nudge = 1 + 1e-9, f[5].Q[1][0] += 1e-9, f[5].Q[0][1] -= 1e-9;
    t->scenes++;
    try_frame(&s, &plain, t->folder, &r);
    if (judge_status(t, &s, &r))
        judge_scene(t, &s, &r);
    try_frame(&s, &f[5], t->folder, &nudged);
    for (int k = 0; k < 5 && r.status <= 1; k++) {
        try_frame(&s, &f[k], t->folder, &twin);
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
    mkdir("out", 0777);
    mkdir("out/hostile", 0777);
    snprintf(t.folder, sizeof t.folder, "out/hostile/%llu", (unsigned long long)t.seed);
    mkdir(t.folder, 0777);
    for (int k = 0; (scenes == 0 || k < scenes) && difftime(time(NULL), start) < seconds; k++, t.seed++)
        try_scene(&t);
    printf("\n%ld scenes, %ld twins; refused %.1f %%, too soft %.1f %%\n", t.scenes, t.twins,
           100.0 * (double)t.count[REFUSED] / (double)t.scenes, 100.0 * (double)t.count[TOO_SOFT] / (double)t.scenes);
    for (int rule = 0; rule < RULES; rule++) {
        findings += rule > TOO_SOFT ? t.count[rule] : 0;
        if (t.count[rule] > 0)
            printf("    %-30s %ld\n", rule_name(rule), t.count[rule]);
    }
    return findings > 0 || t.count[REFUSED] * 100 > 3 * t.scenes;
}
