/* figures.c - the figures of the documents: `make figures` draws them into doc/figures.
 *
 * What can be computed is: deformed shapes by the mode matrix, the pattern of K by the order that
 * the solver finds, beams by the core, the line of thrust by its moments. The rest is drawn.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "../base/base.h"
#include "../program/plot.h"

#define THIN "fill=\"none\" stroke=\"#999\" stroke-width=\"1\" stroke-dasharray=\"5 4\""
#define SOLID "fill=\"none\" stroke=\"#222\" stroke-width=\"1.6\""
#define BLUE "fill=\"#dce9f7\" stroke=\"#2060a0\" stroke-width=\"1.8\""
#define SAND "fill=\"#f4ead7\" stroke=\"#8a6d3b\" stroke-width=\"1.8\""
#define RED "fill=\"none\" stroke=\"#c03028\" stroke-width=\"2\""
#define LEFT "text-anchor=\"start\""
#define MIDDLE "text-anchor=\"middle\""
#define NAME "text-anchor=\"middle\" font-size=\"16\" font-style=\"italic\""
#define FORCE "text-anchor=\"middle\" font-size=\"16\" font-style=\"italic\" fill=\"#c03028\""
#define HEADING "text-anchor=\"middle\" font-size=\"15\" font-weight=\"bold\""

/* A drawing in metres: the point (0, 0) lies at (x, y) pixels, y upwards. */
typedef struct { plot p; double x, y, scale; } drawing;

typedef struct { double x, y; } point;

static const double QUARTER = 1.57079632679489661923;   /* of a turn, rad */

static double px(const drawing *d, double x) { return d->x + d->scale * x; }
static double py(const drawing *d, double y) { return d->y - d->scale * y; }

static void place(drawing *d, double x, double y, double scale)
{
    d->x = x;
    d->y = y;
    d->scale = scale;
}

static void polygon(drawing *d, int n, const point p[], const char *look)
{
    plot_put(&d->p, "<polygon points=\"");
    for (int k = 0; k < n; k++)
        plot_put(&d->p, "%s%.1f,%.1f", k ? " " : "", px(d, p[k].x), py(d, p[k].y));
    plot_put(&d->p, "\" stroke-linejoin=\"round\" %s/>\n", look);
}

static void line(drawing *d, point a, point b, const char *look)
{
    plot_put(&d->p, "<path d=\"M%.1f %.1f L%.1f %.1f\" %s/>\n", px(d, a.x), py(d, a.y), px(d, b.x),
             py(d, b.y), look);
}

/* From a to b, with a head at b. */
static void arrow(drawing *d, point a, point b, const char *look)
{
    const double ax = px(d, a.x), ay = py(d, a.y), bx = px(d, b.x), by = py(d, b.y);
    const double l = hypot(bx - ax, by - ay), ux = (bx - ax) / l, uy = (by - ay) / l;

    plot_put(&d->p, "<path d=\"M%.1f %.1f L%.1f %.1f M%.1f %.1f L%.1f %.1f L%.1f %.1f\" %s/>\n", ax,
             ay, bx, by, bx - 9 * ux - 4 * uy, by - 9 * uy + 4 * ux, bx, by,
             bx - 9 * ux + 4 * uy, by - 9 * uy - 4 * ux, look);
}

static void dot(drawing *d, point a, const char *colour)
{
    plot_put(&d->p, "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"3.5\" fill=\"%s\"/>\n", px(d, a.x),
             py(d, a.y), colour);
}

/* At a point, moved by pixels to the right and up. */
static void name(drawing *d, point a, double right, double up, const char *look, const char *text)
{
    plot_text(&d->p, px(d, a.x) + right, py(d, a.y) - up, look, text);
}

static void spring(drawing *d, point a, point b)
{
    enum { TEETH = 10 };
    const double ax = px(d, a.x), ay = py(d, a.y), bx = px(d, b.x), by = py(d, b.y);
    const double l = hypot(bx - ax, by - ay), nx = (by - ay) / l, ny = (ax - bx) / l;

    plot_put(&d->p, "<path d=\"M%.1f %.1f", ax, ay);
    for (int k = 1; k < TEETH; k++) {
        const double s = k == 1 ? 0.2 : k == TEETH - 1 ? 0.8 : 0.2 + 0.6 * (k - 1) / (TEETH - 2);
        const double off = k == 1 || k == TEETH - 1 ? 0 : k % 2 ? 5 : -5;
        plot_put(&d->p, " L%.1f %.1f", ax + s * (bx - ax) + off * nx,
                 ay + s * (by - ay) + off * ny);
    }
    plot_put(&d->p, " L%.1f %.1f\" stroke-linejoin=\"round\" " RED "/>\n", bx, by);
}

/* Ground below the line from a to b. */
static void hatch(drawing *d, point a, point b)
{
    const double l = hypot(b.x - a.x, b.y - a.y), ux = (b.x - a.x) / l, uy = (b.y - a.y) / l;

    line(d, a, b, SOLID);
    for (double s = 8 / d->scale; s < l; s += 12 / d->scale) {
        const point p = { a.x + s * ux, a.y + s * uy };
        const point q = { p.x + (uy - ux) * 9 / d->scale, p.y - (ux + uy) * 9 / d->scale };
        line(d, p, q, "stroke=\"#222\"");
    }
}

/* ----------------------------------------------------------------------------- the six unknowns */

static const point TRIANGLE[3] = { { -0.9, -0.6 }, { 1.0, -0.6 }, { -0.1, 1.2 } };

static bbm_element make_triangle(bbm_vertex v[3])
{
    bbm_element e = { .n = 3 };

    for (int k = 0; k < 3; k++)
        v[k] = (bbm_vertex){ .x = TRIANGLE[k].x, .y = TRIANGLE[k].y };
    bbm_element_geometry(&e, v);
    return e;
}

/* The triangle before and after one unknown, by the mode matrix. */
static void draw_unknown(drawing *d, int unknown, double size)
{
    bbm_vertex v[3];
    bbm_element e = make_triangle(v);
    point moved[4];

    e.D[unknown] = size;
    for (int k = 0; k < 4; k++) {
        const point p = k < 3 ? TRIANGLE[k] : (point){ e.x, e.y };
        double u[2];
        bbm_displacement(&e, e.D, p.x, p.y, u);
        moved[k] = (point){ p.x + u[0], p.y + u[1] };
    }
    polygon(d, 3, moved, BLUE);
    polygon(d, 3, TRIANGLE, THIN);
    for (int k = 0; k < 3; k++)
        if (hypot(moved[k].x - TRIANGLE[k].x, moved[k].y - TRIANGLE[k].y) > 0.15)
            arrow(d, TRIANGLE[k], moved[k], RED);
    dot(d, (point){ e.x, e.y }, "#999");
    dot(d, moved[3], "#2060a0");
}

static void draw_unknowns(drawing *d)
{
    static const struct { const char *name, *what; double size; } unknown[6] = {
        { "u0", "displacement along x", 0.5 }, { "v0", "displacement along y", 0.4 },
        { "r0", "rotation, counter-clockwise", 0.35 }, { "ex", "strain along x", 0.5 },
        { "ey", "strain along y", 0.4 }, { "gxy", "shear strain", 0.7 },
    };

    for (int k = 0; k < 6; k++) {
        place(d, 120 + 240 * (k % 3), 135 + 230 * (k / 3), 68);
        draw_unknown(d, k, unknown[k].size);
        name(d, (point){ 0, 0 }, 0, -80, HEADING, unknown[k].name);
        name(d, (point){ 0, 0 }, 0, -97, MIDDLE, unknown[k].what);
    }
}

/* ---------------------------------------------------------------------- two elements and a bond */

static void draw_bond(drawing *d)
{
    static const point i[3] = { { 0, 0.7 }, { 2.6, -0.1 }, { 2.3, 2.6 } };
    static const point j[3] = { { 4.7, 0.1 }, { 7.2, 1.5 }, { 4.4, 2.9 } };
    static const point P0 = { 3.2, -0.95 }, Q0 = { 4.0, -0.8 };

    place(d, 30, 260, 78);
    polygon(d, 3, i, BLUE);
    polygon(d, 3, j, SAND);
    spring(d, i[1], j[0]);
    spring(d, i[2], j[2]);
    for (int k = 0; k < 3; k++) {
        dot(d, i[k], "#2060a0");
        dot(d, j[k], "#8a6d3b");
    }
    name(d, (point){ 1.6, 1 }, 0, 0, HEADING, "element i");
    name(d, (point){ 5.5, 1.4 }, 0, 0, HEADING, "element j");
    name(d, i[1], -12, -16, NAME, "P");
    name(d, j[0], 14, -10, NAME, "Q");
    name(d, (point){ 3.65, 0 }, 0, -18, FORCE, "k");
    name(d, (point){ 3.35, 2.75 }, 0, 16, FORCE, "k");
    arrow(d, (point){ 4.6, 0.4 }, (point){ 2.75, 0.22 }, SOLID);
    name(d, (point){ 3.65, 0.31 }, 0, 10, NAME, "d");
    dot(d, P0, "#999");
    dot(d, Q0, "#999");
    arrow(d, Q0, P0, SOLID);
    name(d, P0, -12, -4, NAME, "P");
    name(d, Q0, 12, -4, NAME, "Q");
    name(d, Q0, -31, 5, NAME, "d0");
    name(d, Q0, 30, -4, LEFT, "at the start of the step");
    name(d, (point){ 3.6, -1.5 }, 0, 0, MIDDLE, "d = P - Q = d0 + Ti(P) Di - Tj(Q) Dj at the end");
    name(d, (point){ 3.6, -1.5 }, 0, -19, MIDDLE,
         "drawn apart: P and Q were one point, the two sides one edge");
}

/* ------------------------------------------------------------------------------------ a contact */

static void draw_contact(drawing *d)
{
    static const point block[4] = { { 2.6, 0.75 }, { 4.3, 1.9 }, { 2.7, 2.9 }, { 1.2, 1.8 } };
    static const point base[4] = { { 5.4, 0 }, { 0, 0 }, { 0.5, -1.2 }, { 5, -1.2 } };
    const point P0 = { 1.8, 0 }, foot = { 2.6, 0 };

    place(d, 60, 270, 85);
    polygon(d, 4, base, SAND);
    polygon(d, 4, block, BLUE);
    line(d, block[0], foot, THIN);
    arrow(d, foot, (point){ 2.6, 0.72 }, SOLID);
    arrow(d, (point){ 1.82, -0.25 }, (point){ 2.6, -0.25 }, SOLID);
    line(d, P0, (point){ 1.8, -0.35 }, THIN);
    line(d, foot, (point){ 2.6, -0.35 }, THIN);
    arrow(d, (point){ 4.2, 0 }, (point){ 4.2, 0.75 }, SOLID);
    arrow(d, (point){ 4.2, 0 }, (point){ 4.95, 0 }, SOLID);
    dot(d, block[0], "#2060a0");
    dot(d, P0, "#8a6d3b");
    dot(d, base[0], "#8a6d3b");
    dot(d, base[1], "#8a6d3b");
    name(d, block[0], -20, -8, NAME, "P1");
    name(d, P0, -4, 10, NAME, "P0");
    name(d, base[1], -14, 8, NAME, "P2");
    name(d, base[0], 14, 8, NAME, "P3");
    name(d, (point){ 2.6, 0.3 }, 8, 2, LEFT, "d_n > 0: open");
    name(d, (point){ 2.2, -0.25 }, 0, -20, MIDDLE, "d_s > 0: towards P3");
    name(d, (point){ 4.2, 0.75 }, -12, 0, NAME, "n");
    name(d, (point){ 4.95, 0 }, 8, 8, NAME, "m");
    name(d, (point){ 2.6, 2 }, 0, 0, HEADING, "block i");
    name(d, (point){ 3.9, -0.8 }, 0, 0, HEADING, "block j");
}

/* The forces of a closed contact on both sides: pushed apart, and drawn back along the edge. */
static void draw_forces(drawing *d)
{
    static const point block[3] = { { 2.2, 0.9 }, { 3.6, 2.4 }, { 0.8, 2.4 } };
    static const point base[4] = { { 4.4, 0 }, { 0, 0 }, { 0, -0.9 }, { 4.4, -0.9 } };
    const point at = { 2.2, 0 };

    place(d, 620, 270, 85);
    polygon(d, 4, base, SAND);
    polygon(d, 3, block, BLUE);
    arrow(d, (point){ 2.2, 0.9 }, (point){ 2.2, 1.75 }, RED);
    arrow(d, at, (point){ 2.2, -0.75 }, RED);
    arrow(d, (point){ 2.2, 0.9 }, (point){ 1.2, 0.9 }, RED);
    arrow(d, at, (point){ 3.2, 0 }, RED);
    dot(d, block[0], "#2060a0");
    dot(d, at, "#8a6d3b");
    name(d, (point){ 2.2, 1.6 }, 14, 0, FORCE, "N");
    name(d, (point){ 2.2, -0.6 }, 14, 0, FORCE, "N");
    name(d, (point){ 1.2, 0.9 }, -14, -5, FORCE, "T");
    name(d, (point){ 3.2, 0 }, 6, 10, FORCE, "T");
    arrow(d, (point){ 2.9, 2.75 }, (point){ 3.9, 2.75 }, SOLID);
    name(d, (point){ 1.95, 2.75 }, 0, -5, MIDDLE, "i has slipped this way:");
    dot(d, base[0], "#8a6d3b");
    dot(d, base[1], "#8a6d3b");
    name(d, block[0], 16, -10, NAME, "P1");
    name(d, base[1], -14, 8, NAME, "P2");
    name(d, base[0], 14, 8, NAME, "P3");
    name(d, (point){ 2.2, -1.15 }, 0, -6, MIDDLE,
         "N > 0 is pressure; T > 0, and friction, act on i towards P2");
}

/* A closed contact: the corner is inside by N/p_n. */
static void draw_penetration(drawing *d)
{
    static const point block[3] = { { 1.4, -0.3 }, { 2.4, 1.2 }, { 0.4, 1.2 } };
    static const point base[4] = { { 3.2, 0 }, { 0, 0 }, { 0, -0.9 }, { 3.2, -0.9 } };

    place(d, 1110, 270, 85);
    polygon(d, 4, base, SAND);
    polygon(d, 3, block, "fill=\"#dce9f7\" fill-opacity=\"0.7\" stroke=\"#2060a0\" "
            "stroke-width=\"1.8\"");
    line(d, base[0], base[1], SAND);
    line(d, block[0], (point){ 2.5, -0.3 }, THIN);
    arrow(d, (point){ 2.3, 0 }, (point){ 2.3, -0.3 }, SOLID);
    dot(d, block[0], "#2060a0");
    name(d, block[0], 0, -22, NAME, "P1");
    name(d, (point){ 2.3, -0.3 }, 8, 8, LEFT, "d_n < 0");
    name(d, (point){ 1.45, -1.15 }, 0, -6, MIDDLE, "closed: inside by N/p_n");
    name(d, (point){ 1.45, 1.5 }, 0, 0, MIDDLE, "much enlarged");
}

static void draw_contacts(drawing *d)
{
    draw_contact(d);
    draw_forces(d);
    draw_penetration(d);
}

/* --------------------------------------------------------------------- fixed points and rollers */

static void draw_fixed(drawing *d)
{
    static const point plate[3] = { { 0, 0 }, { 2.4, -0.3 }, { 1.4, 1.9 } };

    place(d, 90, 185, 78);
    spring(d, (point){ 0, 0 }, (point){ 0, -0.8 });
    spring(d, (point){ 0, 0 }, (point){ -0.8, 0 });
    hatch(d, (point){ -0.35, -0.8 }, (point){ 0.35, -0.8 });
    hatch(d, (point){ -0.8, 0.35 }, (point){ -0.8, -0.35 });
    polygon(d, 3, plate, BLUE);
    dot(d, plate[0], "#2060a0");
    dot(d, (point){ 0, -0.8 }, "#222");
    dot(d, (point){ -0.8, 0 }, "#222");
    name(d, plate[0], -14, 8, NAME, "P");
    name(d, (point){ 0, -0.8 }, 16, 6, NAME, "W");
    name(d, (point){ -0.8, 0 }, 0, -42, NAME, "W");
    name(d, (point){ 0.7, -1.4 }, 0, 0, HEADING, "fixed point");
    name(d, (point){ 0.7, -1.4 }, 0, -18, MIDDLE, "d = P - W + T D, both rows of T;");
    name(d, (point){ 0.7, -1.4 }, 0, -36, MIDDLE, "drawn apart: P lies on the wall point W");
    place(d, 500, 185, 78);
    spring(d, (point){ 0, 0 }, (point){ 0, -0.8 });
    hatch(d, (point){ -0.5, -0.8 }, (point){ 0.5, -0.8 });
    polygon(d, 3, plate, BLUE);
    dot(d, plate[0], "#2060a0");
    arrow(d, (point){ -0.1, 0.12 }, (point){ -0.7, 0.12 }, SOLID);
    dot(d, (point){ 0, -0.8 }, "#222");
    name(d, (point){ 0, -0.8 }, 16, 6, NAME, "W");
    name(d, plate[0], -14, -16, NAME, "P");
    name(d, (point){ -0.4, 0.12 }, 0, 8, MIDDLE, "free");
    name(d, (point){ 0.7, -1.4 }, 0, 0, HEADING, "roller: y is held");
    name(d, (point){ 0.7, -1.4 }, 0, -18, MIDDLE, "the second row of T alone");
}

/* --------------------------------------------------------------------------------- the matrix K */

enum { COLUMNS = 8, ROWS = 3, CELLS = COLUMNS * ROWS };

/* The pairs of a grid of squares that are numbered at random. */
static int list_pairs(int pair[][2], int number[CELLS])
{
    unsigned seed = 5;
    int n = 0;

    for (int k = 0; k < CELLS; k++)
        number[k] = k;
    for (int k = CELLS - 1; k > 0; k--) {
        seed = seed * 1103515245u + 12345u;
        const int other = (int)(seed / 65536u % (unsigned)(k + 1)), kept = number[k];
        number[k] = number[other];
        number[other] = kept;
    }
    for (int k = 0; k < CELLS; k++) {
        if (k % COLUMNS < COLUMNS - 1) {
            pair[n][0] = number[k];
            pair[n++][1] = number[k + 1];
        }
        if (k + COLUMNS < CELLS) {
            pair[n][0] = number[k];
            pair[n++][1] = number[k + COLUMNS];
        }
    }
    return n;
}

static void square(drawing *d, double x, double y, double side, const char *look)
{
    plot_put(&d->p, "<rect x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"%.1f\" %s/>\n", x, y, side,
             side, look);
}

/* A square for each block of K: place_of[] says in which row and column. */
static void draw_pattern(drawing *d, int pairs, int (*pair)[2], const int place_of[CELLS],
                         const char *title)
{
    int band = 0;

    square(d, d->x, d->y, CELLS * d->scale, SOLID);
    for (int k = 0; k < pairs + CELLS; k++) {
        const int i = place_of[k < pairs ? pair[k][0] : k - pairs];
        const int j = place_of[k < pairs ? pair[k][1] : k - pairs];
        band = abs(i - j) > band ? abs(i - j) : band;
        for (int mirror = 0; mirror < 2; mirror++)
            square(d, d->x + (mirror ? i : j) * d->scale, d->y + (mirror ? j : i) * d->scale,
                   d->scale - 1, i == j ? "fill=\"#c03028\"" : "fill=\"#2060a0\"");
    }
    plot_text(&d->p, d->x + CELLS * d->scale / 2, d->y - 12, HEADING, title);
    char text[60];
    snprintf(text, sizeof text, "furthest block from the diagonal: %d", band);
    plot_text(&d->p, d->x + CELLS * d->scale / 2, d->y + CELLS * d->scale + 20, MIDDLE, text);
}

static void draw_matrix(drawing *d)
{
    int pair[2 * CELLS][2], number[CELLS], same[CELLS];
    const int pairs = list_pairs(pair, number);
    bbm_matrix *K;

    for (int k = 0; k < CELLS; k++)
        same[k] = k;
    if (bbm_matrix_new(CELLS, pairs, pair, &K))
        return;
    place(d, 40, 40, 12);
    draw_pattern(d, pairs, pair, same, "K, elements numbered at random");
    place(d, 400, 40, 12);
    draw_pattern(d, pairs, pair, K->place, "K after reverse Cuthill-McKee");
    bbm_matrix_free(K);
}

/* --------------------------------------------------------------------------------------- Fig. 8 */

#define CODE "text-anchor=\"middle\" font-family=\"monospace\" fill=\"#555\""

/* Depths are from above here. */
static void draw_box(drawing *d, double x, double depth, const char *what, const char *function)
{
    const point p[4] = { { x - 150, -depth }, { x + 150, -depth }, { x + 150, -depth - 46 },
                         { x - 150, -depth - 46 } };

    polygon(d, 4, p, BLUE);
    plot_text(&d->p, x, depth + 20, MIDDLE, what);
    plot_text(&d->p, x, depth + 37, CODE, function);
}

static void draw_question(drawing *d, double x, double depth, const char *what,
                          const char *function)
{
    const point p[4] = { { x, -depth }, { x + 190, -depth - 38 }, { x, -depth - 76 },
                         { x - 190, -depth - 38 } };

    polygon(d, 4, p, SAND);
    plot_text(&d->p, x, depth + 36, MIDDLE, what);
    plot_text(&d->p, x, depth + 53, CODE, function);
}

/* A line through points with a head at the last one. */
static void path(drawing *d, int n, const point p[])
{
    for (int k = 0; k + 2 < n; k++)
        line(d, p[k], p[k + 1], SOLID);
    arrow(d, p[n - 2], p[n - 1], SOLID);
}

static void draw_end(drawing *d, double x, double depth, const char *what)
{
    plot_put(&d->p, "<rect x=\"%.1f\" y=\"%.1f\" width=\"120\" height=\"32\" rx=\"16\" "
             SOLID "/>\n", x - 60, depth);
    plot_text(&d->p, x, depth + 21, MIDDLE, what);
}

/* From a question at a depth sideways by `out` to a box at another one. */
static void back(drawing *d, double x, double from, double to, double out)
{
    const double side = out < 0 ? -1 : 1;

    path(d, 4, (point[]){ { x + 190 * side, -from }, { x + out, -from }, { x + out, -to },
                          { x + 150 * side, -to } });
}

static void draw_flow(drawing *d)
{
    const double x = 470, down[9] = { 44, 120, 196, 272, 348, 454, 554, 630, 736 };

    draw_end(d, x, 12, "start");
    draw_box(d, x, 74, "geometry of the elements, gravity", "bbm_begin_step");
    draw_box(d, x, 150, "3.7: which contacts may close?", "bbm_detect");
    draw_box(d, x, 226, "3.1 to 3.8: K and F", "bbm_assemble");
    draw_box(d, x, 302, "4: K D = F by SSOR-PCG", "solve");
    draw_question(d, x, 378, "did a contact change?", "open_close");
    draw_question(d, x, 478, "moved further than foreseen?", "bbm_detect");
    draw_box(d, x, 584, "positions, stresses, velocities", "update");
    draw_question(d, x, 660, "(71) met, or the last step?", "bbm_run");
    draw_end(d, x, 766, "end");
    for (int k = 0; k < 9; k++)
        arrow(d, (point){ x, -down[k] }, (point){ x, -down[k] - (k == 5 ? 24 : 30) }, SOLID);
    back(d, x, 416, 249, 240);
    back(d, x, 516, 249, 290);
    back(d, x, 416, 97, -300);
    back(d, x, 698, 97, -380);
    plot_text(&d->p, x + 212, 410, MIDDLE, "yes");
    plot_text(&d->p, x + 212, 510, MIDDLE, "yes");
    plot_text(&d->p, x + 16, 470, MIDDLE, "no");
    plot_text(&d->p, x + 16, 572, MIDDLE, "no");
    plot_text(&d->p, x + 18, 754, MIDDLE, "yes");
    plot_text(&d->p, x - 214, 692, MIDDLE, "no");
    plot_text(&d->p, x - 390, 300, "text-anchor=\"end\"", "next");
    plot_text(&d->p, x - 390, 318, "text-anchor=\"end\"", "step");
    plot_text(&d->p, x - 292, 240, LEFT, "still yes after");
    plot_text(&d->p, x - 292, 258, LEFT, "30 passes:");
    plot_text(&d->p, x - 292, 276, LEFT, "half of dt");
    plot_text(&d->p, x + 300, 380, LEFT, "with the new");
    plot_text(&d->p, x + 300, 398, LEFT, "contacts");
}

/* ----------------------------------------------------------------------- rock, blocks, elements */

enum { TRIANGLES = 9 };

static const struct { int block; point p[3]; } rock[TRIANGLES] = {
    { 0, { { 0, 0 }, { 2, 0 }, { 1.8, 1.4 } } },
    { 0, { { 0, 0 }, { 1.8, 1.4 }, { 0, 1.3 } } },
    { 1, { { 2, 0 }, { 4, 0 }, { 4, 1.6 } } },
    { 1, { { 2, 0 }, { 4, 1.6 }, { 1.8, 1.4 } } },
    { 2, { { 1.8, 1.4 }, { 2.6, 1.473 }, { 2.4, 3 } } },
    { 2, { { 1.8, 1.4 }, { 2.4, 3 }, { 0, 3 } } },
    { 2, { { 1.8, 1.4 }, { 0, 3 }, { 0, 1.3 } } },
    { 3, { { 2.6, 1.473 }, { 4, 1.6 }, { 4, 3 } } },
    { 3, { { 2.6, 1.473 }, { 4, 3 }, { 2.4, 3 } } },
};

/* Moved away from the middle with its block, and shrunk to its barycentre. */
static point apart(int k, int corner, double blocks, double elements)
{
    static const point centre[4] = { { 0.95, 0.67 }, { 2.95, 0.75 }, { 1.2, 2.2 }, { 3.3, 2.3 } };
    const point *p = rock[k].p, c = centre[rock[k].block];
    const point b = { (p[0].x + p[1].x + p[2].x) / 3, (p[0].y + p[1].y + p[2].y) / 3 };

    return (point){ b.x + elements * (p[corner].x - b.x) + blocks * (c.x - 2),
                    b.y + elements * (p[corner].y - b.y) + blocks * (c.y - 1.5) };
}

/* The corners of all triangles are numbered from 0. */
static point corner_of(int i) { return rock[i / 3].p[i % 3]; }

static int is_same(point a, point b) { return hypot(a.x - b.x, a.y - b.y) < 1e-6; }

/* Whether no triangle before it has that corner in the same block. */
static int is_first(int i)
{
    for (int j = 0; j < i; j++)
        if (rock[i / 3].block == rock[j / 3].block && is_same(corner_of(i), corner_of(j)))
            return 0;
    return 1;
}

/* Whether the side from that corner lies between two triangles of the block. */
static int is_inside(int i)
{
    const point a = corner_of(i), b = rock[i / 3].p[(i + 1) % 3];

    for (int j = 0; j < 3 * TRIANGLES; j++)
        if (rock[i / 3].block == rock[j / 3].block && is_same(corner_of(j), b)
            && is_same(rock[j / 3].p[(j + 1) % 3], a))
            return 1;
    return 0;
}

/* What joins corners that were one point: bonds in a block, contacts between two. */
static void join_corners(drawing *d, double blocks, double elements)
{
    for (int i = 0; i < 3 * TRIANGLES; i++)
        for (int j = i + 1; j < 3 * TRIANGLES; j++) {
            const int same = rock[i / 3].block == rock[j / 3].block;
            if (i / 3 == j / 3 || !is_same(corner_of(i), corner_of(j))
                || (!same && !(is_first(i) && is_first(j))))
                continue;
            line(d, apart(i / 3, i % 3, blocks, elements), apart(j / 3, j % 3, blocks, elements),
                 same ? RED : "stroke=\"#222\" stroke-width=\"1.5\" stroke-dasharray=\"3 3\"");
        }
}

static void draw_rock(drawing *d)
{
    static const char *const heading[3] = { "rock with joints", "blocks", "elements" };
    static const char *const what[3] = { "", "contacts between blocks", "bonds inside a block" };
    static const double blocks[3] = { 0, 0.14, 0.3 }, elements[3] = { 1, 1, 0.8 };

    for (int panel = 0; panel < 3; panel++) {
        place(d, 60 + 330 * panel, 225, 62);
        for (int k = 0; k < TRIANGLES; k++) {
            point p[3];
            for (int c = 0; c < 3; c++)
                p[c] = apart(k, c, blocks[panel], elements[panel]);
            polygon(d, 3, p, panel == 2 ? BLUE : "fill=\"#f4ead7\" stroke=\"#f4ead7\"");
        }
        for (int k = 0; k < 3 * TRIANGLES && panel < 2; k++)
            if (!is_inside(k))
                line(d, apart(k / 3, k % 3, blocks[panel], 1),
                     apart(k / 3, (k + 1) % 3, blocks[panel], 1),
                     "stroke=\"#8a6d3b\" stroke-width=\"1.8\"");
        if (panel)
            join_corners(d, blocks[panel], elements[panel]);
        name(d, (point){ 2, -0.75 }, 0, 0, HEADING, heading[panel]);
        name(d, (point){ 2, -0.75 }, 0, -19, panel == 2 ? "text-anchor=\"middle\" fill=\"#c03028\""
             : MIDDLE, what[panel]);
    }
}

/* ------------------------------------------------------------------------------ the experiments */

/* Between two arrow heads. */
static void dimension(drawing *d, point a, point b, double right, double up, const char *text)
{
    const point middle = { (a.x + b.x) / 2, (a.y + b.y) / 2 };

    arrow(d, middle, a, "fill=\"none\" stroke=\"#666\"");
    arrow(d, middle, b, "fill=\"none\" stroke=\"#666\"");
    name(d, middle, right, up, MIDDLE, text);
}

static void axes(drawing *d, point o, double length)
{
    arrow(d, o, (point){ o.x + length, o.y }, SOLID);
    arrow(d, o, (point){ o.x, o.y + length }, SOLID);
    name(d, (point){ o.x + length, o.y }, 8, -4, NAME, "x");
    name(d, (point){ o.x, o.y + length }, 10, 0, NAME, "y");
}

static void draw_setup_1(drawing *d)
{
    static const point beam[4] = { { 0, -6 }, { 48, -6 }, { 48, 6 }, { 0, 6 } };

    place(d, 70, 120, 8);
    polygon(d, 4, beam, BLUE);
    hatch(d, (point){ 0, 7 }, (point){ 0, -7 });
    axes(d, (point){ 0, 0 }, 5);
    arrow(d, (point){ 48, 5 }, (point){ 48, 0 }, RED);
    name(d, (point){ 48, 0 }, 26, 8, FORCE, "1 kN");
    dimension(d, (point){ 0, -8 }, (point){ 48, -8 }, 0, -18, "48 m");
    dimension(d, (point){ 54, -6 }, (point){ 54, 6 }, 26, -4, "12 m");
    name(d, (point){ 24, 7 }, 0, 10, HEADING, "I: load a at one node; b, c as parabolic shear");
}

static void roller(drawing *d, point a)
{
    plot_put(&d->p, "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"5\" " SOLID "/>\n", px(d, a.x),
             py(d, a.y));
}

static void draw_setup_2(drawing *d)
{
    enum { ARC = 16 };
    point plate[ARC + 4] = { { 5, 0 }, { 5, 5 }, { 0, 5 } };

    for (int k = 0; k <= ARC; k++)
        plate[3 + k] = (point){ sin(QUARTER * k / ARC), cos(QUARTER * k / ARC) };
    place(d, 590, 300, 48);
    polygon(d, ARC + 4, plate, BLUE);
    for (int k = 0; k < 5; k++) {
        const point left = { -0.12, 1.2 + 0.92 * k }, below = { 1.2 + 0.92 * k, -0.12 };
        const point right = { 5, 0.3 + 1.1 * k };
        roller(d, left);
        roller(d, below);
        arrow(d, right, (point){ 5.6, right.y }, RED);
    }
    axes(d, (point){ 0, 0 }, 0.55);
    name(d, (point){ 5.6, 2.5 }, 6, 0, "text-anchor=\"start\" fill=\"#c03028\"", "1 MPa");
    dimension(d, (point){ 0, 5.3 }, (point){ 5, 5.3 }, 0, 6, "5 m");
    dimension(d, (point){ 0, -0.5 }, (point){ 1, -0.5 }, 0, -18, "1 m");
    dimension(d, (point){ 1, -0.5 }, (point){ 5, -0.5 }, 0, -18, "4 m");
    for (int k = 0; k < 5; k++) {
        static const point corner[5] = { { 0, 1 }, { 1, 0 }, { 5, 0 }, { 5, 5 }, { 0, 5 } };
        dot(d, corner[k], "#c03028");
    }
    name(d, (point){ 2.5, 5.3 }, 0, 26, HEADING, "II: a quarter of the plate b5");
    name(d, (point){ 2.9, 2.7 }, 0, 0, MIDDLE, "t = 0.2 m; points of Table 5");
}

static void draw_setup_3(drawing *d)
{
    static const point plate[4] = { { -10, -1 }, { 10, -1 }, { 10, 1 }, { -10, 1 } };
    static const point block[4] = { { -8, 1 }, { -4, 1 }, { -4, 2 }, { -8, 2 } };

    place(d, 260, 345, 20);
    polygon(d, 4, plate, SAND);
    polygon(d, 4, block, BLUE);
    hatch(d, (point){ -10, -1 }, (point){ 10, -1 });
    axes(d, (point){ 0, 0 }, 1.8);
    arrow(d, (point){ -10.5, 1.5 }, (point){ -8, 1.5 }, RED);
    name(d, (point){ -10.5, 1.5 }, 14, 8, FORCE, "10 kN");
    dot(d, (point){ -4, 1 }, "#c03028");
    name(d, (point){ -4, 1 }, 12, 6, NAME, "P");
    dimension(d, (point){ -8, 2.4 }, (point){ -4, 2.4 }, 0, 5, "4 m");
    dimension(d, (point){ -2.4, 1 }, (point){ -2.4, 2 }, 22, -4, "1 m");
    dimension(d, (point){ -10, -1.9 }, (point){ 10, -1.9 }, 0, -18, "20 m");
    dimension(d, (point){ 10.5, -1 }, (point){ 10.5, 1 }, 22, -5, "2 m");
    name(d, (point){ 2.5, 3 }, 0, 0, HEADING, "III: no friction");
}

static void draw_setup(drawing *d)
{
    draw_setup_1(d);
    draw_setup_2(d);
    draw_setup_3(d);
}

/* --------------------------------------------------------------------- the beam of Experiment I */

/* nx x ny cells of four triangles, clamped, 1 kN spread over the nodes of the end; no cells: one
 * block. NULL where there is no memory. */
static bbm_model *solve_beam(int nx, int ny, double alpha)
{
    static const double one[6][2] = {
        { 0, -6 }, { 48, -6 }, { 48, 0 }, { 48, 6 }, { 0, 6 }, { 0, 0 },
    };
    bbm_model *m;

    if (bbm_model_new(&m))
        return NULL;
    bbm_add_material(m, &(bbm_material){ 30e6, 0.3, 1, 1 }, NULL);
    for (int k = 0; k < 6 && nx == 0; k++)
        bbm_add_node(m, one[k][0], one[k][1], NULL);
    for (int j = 0; j <= ny && nx; j++)
        for (int i = 0; i <= nx; i++)
            bbm_add_node(m, 48.0 * i / nx, 12.0 * j / ny - 6, NULL);
    for (int k = 0; k < nx * ny; k++) {
        const int i = k % nx, j = k / nx, a = j * (nx + 1) + i, c = (nx + 1) * (ny + 1) + k;
        const int corner[5] = { a, a + 1, a + nx + 2, a + nx + 1, a };
        bbm_add_node(m, 48 * (i + 0.5) / nx, 12 * (j + 0.5) / ny - 6, NULL);
        for (int e = 0; e < 4; e++)
            bbm_add_element(m, 0, 0, 3, (int[]){ corner[e], corner[e + 1], c }, NULL);
    }
    if (nx == 0)
        bbm_add_element(m, 0, 0, 6, (int[]){ 0, 1, 2, 3, 4, 5 }, NULL);
    for (int n = 0; n < m->nodes; n++) {
        if (m->node[n].x == 0)
            bbm_fix_node(m, n, BBM_XY, 0, 0);
        if (m->node[n].x == 48)
            bbm_add_load(m, n, 0, -1000.0 / (nx ? ny + 1 : 3));
    }
    m->par.alpha = alpha;
    if (!bbm_prepare(m) && !bbm_run(m))
        return m;
    bbm_model_free(m);
    return NULL;
}

/* The mean over the elements at the node at (x, y). */
static bbm_result at_node(const bbm_model *m, double x, double y)
{
    bbm_result r = { 0 };

    for (int n = 0; n < m->nodes; n++)
        if (hypot(m->node[n].x - x, m->node[n].y - y) < 1e-9)
            bbm_nodal_result(m, n, -1, &r);
    return r;
}

/* (70) on the axis, m. */
static double beam_theory(double x)
{
    return -1000 / (6 * 30e6 * 144) * ((4 + 5 * 0.3) * 144 * x / 4 + (3 * 48 - x) * x * x);
}

enum { MAGNIFIED = 800 };

/* Displacements magnified, elements shrunk to their barycentres. */
static void draw_beam(drawing *d, const bbm_model *m, double size, const char *look)
{
    for (int k = 0; k < m->elements; k++) {
        const bbm_element *e = &m->element[k];
        point p[6], c = { 0, 0 };
        for (int v = 0; v < e->n; v++) {
            const bbm_vertex *at = &m->vertex[e->first + v];
            const bbm_node *start = &m->node[at->node];
            p[v] = (point){ start->x + MAGNIFIED * (at->x + m->origin[0] - start->x),
                            start->y + MAGNIFIED * (at->y + m->origin[1] - start->y) };
            c.x += p[v].x / e->n;
            c.y += p[v].y / e->n;
        }
        for (int v = 0; v < e->n; v++)
            p[v] = (point){ c.x + size * (p[v].x - c.x), c.y + size * (p[v].y - c.y) };
        polygon(d, e->n, p, look);
    }
}

static void draw_bending(drawing *d)
{
    static const struct { const char *what; int nx, ny; double alpha, size; } way[3] = {
        { "DDA: one block, it can only shear", 0, 0, 1000, 1 },
        { "BBM: 128 triangles, drawn apart; in truth springs hold them", 16, 2, 1000, 0.8 },
        { "Finite element: the triangles share their nodes (here: alpha = 1e6)", 16, 2, 1e6, 1 },
    };

    for (int k = 0; k < 3; k++) {
        bbm_model *m = solve_beam(way[k].nx, way[k].ny, way[k].alpha);
        char text[80];
        if (!m)
            return;
        place(d, 60, 100 + 205 * k, 9.5);
        hatch(d, (point){ 0, 7 }, (point){ 0, -7 });
        draw_beam(d, m, way[k].size, BLUE);
        for (int x = 0; x < 48; x += 2)
            line(d, (point){ x, MAGNIFIED * beam_theory(x) },
                 (point){ x + 1, MAGNIFIED * beam_theory(x + 1) }, RED);
        snprintf(text, sizeof text, "tip %.2f mm", 1e3 * at_node(m, 48, 0).v);
        name(d, (point){ 49, 0 }, 10, 20, LEFT, text);
        name(d, (point){ 2, 7.5 }, 0, 0, LEFT, way[k].what);
        bbm_model_free(m);
    }
    name(d, (point){ 49, 0 }, 10, 0, "text-anchor=\"start\" fill=\"#c03028\"", "theory (70)");
    name(d, (point){ 49, 0 }, 10, -18, "text-anchor=\"start\" fill=\"#c03028\"", "-8.90 mm");
    name(d, (point){ 49, 0 }, 10, -50, LEFT, "displacements");
    name(d, (point){ 49, 0 }, 10, -68, LEFT, "x 800");
}

/* The error of v(24,0) against alpha; the triangles' and the springs' have opposite signs.
 * Both are logarithms. */
static void draw_error(drawing *d)
{
    enum { MESHES = 3, ALPHAS = 7 };
    static const char *const label[MESHES] = { "64 triangles", "256 triangles", "1024 triangles" };
    double power[ALPHAS], e[MESHES][ALPHAS], soft[ALPHAS];
    plot_series s[MESHES + 1];

    for (int k = 0; k < ALPHAS; k++) {
        power[k] = k;
        soft[k] = log10(260) - k;
    }
    for (int k = 0; k < MESHES; k++) {
        for (int a = 0; a < ALPHAS; a++) {
            bbm_model *m = solve_beam(8 << k, 2 << k, pow(10, a));
            e[k][a] = m ? log10(100 * fabs(at_node(m, 24, 0).v / -2.8449e-3 - 1)) : 0;
            bbm_model_free(m);
        }
        s[k] = (plot_series){ .name = label[k], .n = ALPHAS, .x = power, .y = e[k], .look = k + 2,
                              .style = PLOT_BOTH };
    }
    s[MESHES] = (plot_series){ .name = "springs alone: 2.6/alpha", .n = 5, .x = power, .y = soft,
                               .look = 1 };
    plot_draw_chart(&d->p, (plot_box){ 0, 0, 700, 460 }, &(plot_chart){
        .title = "Error of v(24,0): too soft on the left, too stiff on the right",
        .x = { "log10(alpha)", NULL }, .y = { "log10(error in %)", NULL },
        .count = MESHES + 1, .series = s });
}

/* ------------------------------------------------------ the amplitude that a step leaves, over W */

/* The largest eigenvalue of the step of a mass on a spring, of the matrix in doc/05-loads.md. The
 * rule with beta = 1/4, gamma = 1/2 leaves all. */
static void draw_damping(drawing *d)
{
    enum { POINTS = 241 };
    double W[POINTS], left[POINTS], all[POINTS];

    for (int k = 0; k < POINTS; k++) {
        W[k] = 0.05 * k;
        const double W2 = W[k] * W[k], half = (4 - W2) / (2 * (2 + W2)), det = 2 / (2 + W2);
        const double root = half * half - det;
        left[k] = root < 0 ? sqrt(det) : fabs(half) + sqrt(root);
        all[k] = 1;
    }
    plot_draw_chart(&d->p, (plot_box){ 0, 0, 700, 400 }, &(plot_chart){
        .title = "Amplitude after a step",
        .x = { "W = w dt", NULL }, .y = { "share of that before", NULL }, .count = 2,
        .series = (plot_series[]){
            { .name = "the paper: beta 1/2, gamma 1", .n = POINTS, .x = W, .y = left, .look = 2 },
            { .name = "beta 1/4, gamma 1/2", .n = POINTS, .x = W, .y = all, .look = 1 } } });
}

/* --------------------------------------------------------- the stress of elements, and of nodes */

enum { CELLS_HIGH = 8, STEPS = 8 };

/* sxx of the triangles that a cell has above (2), below (0), and at the sides (1, 3): the mean of
 * the cells left and right of x = 24. */
static double cell_stress(const bbm_model *m, int j, int k)
{
    const int nx = 4 * CELLS_HIGH, left = 4 * (j * nx + nx / 2 - 1), right = left + 4;

    return (m->element[left + k].stress[0] + m->element[right + k].stress[0]) / 2;
}

static void draw_stress(drawing *d)
{
    bbm_model *m = solve_beam(4 * CELLS_HIGH, CELLS_HIGH, 1000);
    double y[2][3 * STEPS], s[2][3 * STEPS], at[STEPS / 2 + 1], mean[STEPS / 2 + 1];
    const double h = 12.0 / CELLS_HIGH, end[2] = { 0, 6 }, exact[2] = { 0, 1000 };

    for (int k = 0; k < 3 * STEPS; k++)
        y[0][k] = y[1][k] = s[0][k] = s[1][k] = NAN;
    for (int k = 0; m && k < STEPS; k++) {
        const int j = CELLS_HIGH / 2 + k / 2;               /* the upper half, by half cells */
        for (int c = 0; c < 2; c++) {
            y[0][3 * k + c] = (k + c) * h / 2;
            s[0][3 * k + c] = cell_stress(m, j, k % 2 ? 2 : 0);
            y[1][3 * k + c] = (k + c) * h / 2;
            s[1][3 * k + c] = (cell_stress(m, j, 1) + cell_stress(m, j, 3)) / 2;
        }
    }
    for (int k = 0; m && k <= STEPS / 2; k++) {
        at[k] = k * h;
        mean[k] = at_node(m, 24, at[k]).stress[0];
    }
    const plot_series series[] = {
        { .name = "theory", .n = 2, .x = end, .y = exact, .look = 1 },
        { .name = "triangles above and below in a cell", .n = 3 * STEPS, .x = y[0], .y = s[0],
          .look = 2 },
        { .name = "triangles left and right in a cell", .n = 3 * STEPS, .x = y[1], .y = s[1],
          .look = 4 },
        { .name = "nodal mean", .n = STEPS / 2 + 1, .x = at, .y = mean, .look = 3,
          .style = PLOT_MARKS },
    };
    if (m)
        plot_draw_chart(&d->p, (plot_box){ 0, 0, 700, 460 }, &(plot_chart){
            .title = "sxx at x = 24 m from the axis to the face, 1,024 triangles",
            .x = { "y", "m" }, .y = { "sxx", "Pa" }, .count = 4,
            .series = series });
    bbm_model_free(m);
}

/* ----------------------------------------------------------------------------- a line of thrust */

/* A semicircular arch of mean radius 1 and thickness t, its own weight 1 for each radian. The
 * resultant of the part up to the angle phi from the crown crosses its section at the radius r, by
 * the moments about that point:
 *     H (c - r cos phi) = r phi sin phi - g (1 - cos phi)
 * H acts at the height c at the crown, g is the radius of the centre of gravity of a slice. H lets
 * the line end at r = c. */
static double thrust_radius(double phi, double c, double t)
{
    const double g = 1 + t * t / 12, H = (QUARTER * c - g) / c;

    return (H * c + g * (1 - cos(phi))) / (H * cos(phi) + phi * sin(phi));
}

static void half_circle(drawing *d, double radius, const char *look)
{
    for (int k = 0; k < 60; k++) {
        const double a = QUARTER * (k - 30) / 30, b = QUARTER * (k - 29) / 30;
        line(d, (point){ radius * sin(a), radius * cos(a) },
             (point){ radius * sin(b), radius * cos(b) }, look);
    }
}

static void draw_arch(drawing *d, double t, double c, int hinges)
{
    enum { STONES = 15 };
    double least = 2, where = 0;

    half_circle(d, 1 - t / 2, "stroke=\"#8a6d3b\" stroke-width=\"1.8\"");
    half_circle(d, 1 + t / 2, "stroke=\"#8a6d3b\" stroke-width=\"1.8\"");
    for (int k = 0; k <= STONES; k++) {
        const double a = -QUARTER + 2 * QUARTER * k / STONES;
        line(d, (point){ (1 - t / 2) * sin(a), (1 - t / 2) * cos(a) },
             (point){ (1 + t / 2) * sin(a), (1 + t / 2) * cos(a) }, "stroke=\"#8a6d3b\"");
    }
    for (int k = -90; k < 90; k++) {
        const double a = QUARTER * k / 90, b = QUARTER * (k + 1) / 90;
        const double r = thrust_radius(fabs(a), c, t), q = thrust_radius(fabs(b), c, t);
        line(d, (point){ r * sin(a), r * cos(a) }, (point){ q * sin(b), q * cos(b) }, RED);
        if (k >= 0 && r < least)
            least = r, where = a;
    }
    for (int k = -2; k <= 2 && hinges; k++) {
        const double a = k % 2 ? where * k : QUARTER * k / 2, r = thrust_radius(fabs(a), c, t);
        dot(d, (point){ r * sin(a), r * cos(a) }, "#222");
    }
    hatch(d, (point){ -1.15, 0 }, (point){ -0.8, 0 });
    hatch(d, (point){ 0.8, 0 }, (point){ 1.15, 0 });
}

static void draw_thrust(drawing *d)
{
    place(d, 220, 245, 170);
    draw_arch(d, 0.2, 1.06, 0);
    name(d, (point){ 0, 0.35 }, 0, 0, HEADING, "t/R = 0.2");
    name(d, (point){ 0, 0.35 }, 0, -20, MIDDLE, "a line fits inside:");
    name(d, (point){ 0, 0.35 }, 0, -38, MIDDLE, "the arch stands");
    place(d, 650, 245, 170);
    draw_arch(d, 0.1075, 1 + 0.1075 / 2, 1);
    name(d, (point){ 0, 0.35 }, 0, 0, HEADING, "t/R = 0.1075");
    name(d, (point){ 0, 0.35 }, 0, -20, MIDDLE, "the last line touches the faces");
    name(d, (point){ 0, 0.35 }, 0, -38, MIDDLE, "at five points: hinges");
}

/* ---------------------------------------------------------------------------------- the program */

static int draw(const char *folder, const char *file, double width, double height,
                void (*figure)(drawing *d))
{
    char where[300];
    drawing d = { .scale = 1 };

    snprintf(where, sizeof where, "%s/%s.svg", folder, file);
    if (!plot_open(&d.p, where, width, height)) {
        perror(where);
        return 1;
    }
    figure(&d);
    return !plot_close(&d.p);
}

int main(int count, char *argument[])
{
    static const struct { const char *file; double width, height; void (*figure)(drawing *d); }
    all[] = {
        { "unknowns", 720, 480, draw_unknowns }, { "bond", 640, 410, draw_bond },
        { "contact", 1400, 400, draw_contacts }, { "fixed", 760, 345, draw_fixed },
        { "matrix", 730, 370, draw_matrix }, { "flow", 890, 812, draw_flow },
        { "rock", 1020, 305, draw_rock }, { "setup", 930, 420, draw_setup },
        { "bending", 660, 655, draw_bending }, { "error", 700, 460, draw_error },
        { "stress", 700, 460, draw_stress }, { "thrust", 870, 300, draw_thrust },
        { "damping", 700, 400, draw_damping },
    };
    int failed = count != 2;

    for (size_t k = 0; k < sizeof all / sizeof *all && !failed; k++)
        failed = draw(argument[1], all[k].file, all[k].width, all[k].height, all[k].figure);
    return failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
