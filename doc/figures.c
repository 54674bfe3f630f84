/* figures.c - the figures of the documents: `make figures` draws them into doc/figures.
 *
 * What can be computed is: deformed shapes by the mode matrix, lengths and directions of a contact
 * by its vectors, the pattern of K by the order that the solver finds. The rest is drawn.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "../base/base.h"
#include "../cases/plot.h"

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
    static const point i[3] = { { 0.2, 0.7 }, { 3.2, -0.2 }, { 2.8, 2.6 } };
    static const point j[3] = { { 4.4, -0.1 }, { 6.9, 1.5 }, { 3.9, 2.9 } };

    place(d, 30, 280, 78);
    polygon(d, 3, i, BLUE);
    polygon(d, 3, j, SAND);
    spring(d, i[1], j[0]);
    spring(d, i[2], j[2]);
    for (int k = 0; k < 3; k++) {
        dot(d, i[k], "#2060a0");
        dot(d, j[k], "#8a6d3b");
    }
    name(d, (point){ 2, 1 }, 0, 0, HEADING, "element i");
    name(d, (point){ 5.1, 1.4 }, 0, 0, HEADING, "element j");
    name(d, i[1], -2, -22, NAME, "P");
    name(d, j[0], 4, -22, NAME, "Q");
    name(d, (point){ 3.8, -0.15 }, 0, 14, FORCE, "k");
    name(d, (point){ 3.35, 2.75 }, 0, 16, FORCE, "k");
    name(d, (point){ 3.8, -0.15 }, 0, -48, MIDDLE, "d = d0 + Ti(P) Di - Tj(Q) Dj");
    name(d, (point){ 3.8, -0.15 }, 0, -67, MIDDLE,
         "drawn apart: at the start P and Q are one point, and the two sides one edge");
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
    name(d, (point){ 2.2, -1.15 }, 0, -6, MIDDLE,
         "N > 0 is pressure; T > 0, and friction, act on i towards P2");
}

static void draw_contacts(drawing *d)
{
    draw_contact(d);
    draw_forces(d);
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
    name(d, plate[0], -14, 8, NAME, "P");
    name(d, (point){ 0.7, -1.4 }, 0, 0, HEADING, "fixed point");
    name(d, (point){ 0.7, -1.4 }, 0, -18, MIDDLE, "d = P - W + T D, both rows of T");
    place(d, 500, 185, 78);
    spring(d, (point){ 0, 0 }, (point){ 0, -0.8 });
    hatch(d, (point){ -0.5, -0.8 }, (point){ 0.5, -0.8 });
    polygon(d, 3, plate, BLUE);
    dot(d, plate[0], "#2060a0");
    arrow(d, (point){ -0.1, 0.12 }, (point){ -0.7, 0.12 }, SOLID);
    name(d, plate[0], -14, -16, NAME, "P");
    name(d, (point){ -0.4, 0.12 }, 0, 8, MIDDLE, "free");
    name(d, (point){ 0.7, -1.4 }, 0, 0, HEADING, "roller: y is held");
    name(d, (point){ 0.7, -1.4 }, 0, -18, MIDDLE, "the second row of T alone");
}

/* --------------------------------------------------------------------------------- the matrix K */

enum { COLUMNS = 8, ROWS = 3, CELLS = COLUMNS * ROWS };

/* The pairs of a grid of squares numbered at random: a mesh generator's numbers. */
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
    draw_pattern(d, pairs, pair, same, "K as a mesh numbers its elements");
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

static void draw_flow(drawing *d)
{
    const double x = 330;
    const point again[4] = { { x + 190, -362 }, { x + 240, -362 }, { x + 240, -195 },
                             { x + 150, -195 } };
    const point anew[4] = { { x + 190, -462 }, { x + 280, -462 }, { x + 280, -195 },
                            { x + 150, -195 } };
    const point cut[4] = { { x - 190, -362 }, { x - 230, -362 }, { x - 230, -43 },
                           { x - 150, -43 } };
    const double end[6] = { 66, 142, 218, 294, 400, 500 };

    draw_box(d, x, 20, "geometry of the elements, gravity", "bbm_begin_step");
    draw_box(d, x, 96, "3.7: which contacts may close?", "bbm_detect");
    draw_box(d, x, 172, "3.1 to 3.8: K and F", "bbm_assemble");
    draw_box(d, x, 248, "4: K D = F by SSOR-PCG", "solve");
    draw_question(d, x, 324, "did a contact change?", "open_close");
    draw_question(d, x, 424, "moved further than foreseen?", "bbm_detect");
    draw_box(d, x, 530, "positions, stresses, velocities", "update");
    for (int k = 0; k < 6; k++)
        arrow(d, (point){ x, -end[k] }, (point){ x, -end[k] - (k < 4 || k > 4 ? 30 : 24) }, SOLID);
    path(d, 4, again);
    line(d, anew[0], anew[1], SOLID);
    line(d, anew[1], anew[2], SOLID);
    line(d, anew[2], again[2], SOLID);
    path(d, 4, cut);
    plot_text(&d->p, x + 210, 356, MIDDLE, "yes");
    plot_text(&d->p, x + 210, 456, MIDDLE, "yes");
    plot_text(&d->p, x + 14, 416, MIDDLE, "no");
    plot_text(&d->p, x + 14, 518, MIDDLE, "no");
    plot_text(&d->p, x - 275, 200, MIDDLE, "does not");
    plot_text(&d->p, x - 275, 218, MIDDLE, "settle:");
    plot_text(&d->p, x - 275, 236, MIDDLE, "half of dt");
    plot_text(&d->p, x + 290, 300, LEFT, "with the");
    plot_text(&d->p, x + 290, 318, LEFT, "new contacts");
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
        { "unknowns", 720, 480, draw_unknowns }, { "bond", 600, 370, draw_bond },
        { "contact", 1040, 400, draw_contacts }, { "fixed", 760, 320, draw_fixed },
        { "matrix", 730, 370, draw_matrix }, { "flow", 730, 600, draw_flow },
    };
    int failed = count != 2;

    for (size_t k = 0; k < sizeof all / sizeof *all && !failed; k++)
        failed = draw(argument[1], all[k].file, all[k].width, all[k].height, all[k].figure);
    return failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
