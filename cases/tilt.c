/* tilt.c - a wall that is tilted until it falls.
 *
 *     .---.-------.---.     Two bricks of 2 m x 1 m in each of six courses, or a whole one and two
 *     |---'---.---'---|     halves; friction 55 degrees. Tilting the wall by a is a gravity that
 *     |---.---'---.---|     turns: (sin a, -cos a) g.
 *     |---'---.---'---|
 *     |---.---'---.---|     The wall does not turn in one piece: some bricks on the left stay
 *     '-------'-------'     behind, along steps. In the courses k = 0 .. 5 what lies right of a
 *     /////////////////     joint x_k turns about the corner (4, 0), with x_k <= x_(k-1), for a
 *                           brick stays only if all below it does. Between the two no joint
 * presses. The part topples as soon as its weight passes the corner:
 *
 *     tan(a) = sum (4 - x_k)^2/2 / sum (4 - x_k) (k + 1/2),       at least 77/139, 28.98 degrees;
 *
 * in one piece it would be 33.7 degrees. (So it is if joints do not slip. Statics of the bed joints
 * alone, a linear program, finds the same for friction of 50 to 55 degrees.)
 *
 * Computed: a wall stands if no brick has moved by 0.1 m in 4 s. The bricks carry each other in
 * many ways, and the friction in the upright joints may go either way; longer steps than 1 ms need
 * thousands of passes to settle. */
#include <math.h>

#include "case.h"

enum { COURSES = 6, SETTLE = 200, STEPS = 4000 };

static const double DEGREE = 3.14159265358979323846 / 180, WIDTH = 4, FRICTION = 55;
static const double joint[2][4] = { { 0, 2, 4 }, { 0, 1, 3, 4 } };  /* of even and odd courses */

/* The least tan(a) of all parts that turn, from course k up, given x_(k-1) and both sums below. */
static double least_slope(int k, double below, double lever, double height)
{
    double least = INFINITY;

    if (k == COURSES)
        return lever / height;
    for (const double *x = joint[k % 2]; *x < WIDTH && *x <= below; x++) {
        const double w = WIDTH - *x;
        least = fmin(least, least_slope(k + 1, *x, lever + w * w / 2, height + w * (k + 0.5)));
    }
    return least;
}

static bbm_model *build_wall(double tilt)
{
    bbm_model *m = case_model();
    int block = 0;

    bbm_add_material(m, &(bbm_material){ 1e14, 0.25, 2500, 1 }, NULL);
    bbm_add_material(m, &(bbm_material){ 1e12, 0, 2500, 1 }, NULL);
    case_add_box(m, &(case_box){ .nx = 1, .ny = 1, .x = -2, .y = -0.5, .w = 10, .h = 0.5 });
    case_fix_block(m, 0);
    for (int k = 0; k < COURSES; k++)
        for (const double *x = joint[k % 2]; *x < WIDTH; x++)
            case_add_box(m, &(case_box){ .block = ++block, .material = 1, .nx = 1, .ny = 1,
                                         .x = x[0], .y = k, .w = x[1] - x[0], .h = 1 });
    m->par.dt = 0.001;
    m->par.gravity[0] = 9.81 * sin(tilt * DEGREE);
    m->par.gravity[1] = -9.81 * cos(tilt * DEGREE);
    m->par.p_n = 1e12;
    m->par.p_s = 4e11;
    m->par.friction = FRICTION;
    m->par.pcg.tolerance = 1e-12;
    case_must(m, bbm_prepare(m));
    return m;
}

static double moved(const bbm_model *m)
{
    double d = 0;

    for (int k = 1; k < m->elements; k++)
        d = fmax(d, hypot(m->element[k].sum[0], m->element[k].sum[1]));
    return d;
}

/* Lets a wall go until a brick has moved by `far`; returns whether it stood. Draws it for r. */
static int stands(double tilt, double far, case_results *r, const char *title)
{
    bbm_model *m = build_wall(tilt);
    scene s = { .title = title, .window = { -1, 7, -0.5, 7 } };

    case_settle(m, SETTLE);
    m->info.t = 0;
    scene_record(&s, m);
    for (int i = 0; i < STEPS && moved(m) < far; i++)
        case_step(m, NULL, r && i % 20 == 19 ? &s : NULL);
    const int stood = moved(m) < 0.1;
    if (r && stood)
        case_draw_panels(r, "stands.svg", m, &s, 1, (double[]){ m->info.t });
    if (r && !stood) {
        case_draw_movie(r, "falls.svg", m, &s);
        case_draw_panels(r, "states.svg", m, &s, 4,
                         (double[]){ 0, 0.6 * m->info.t, 0.8 * m->info.t, m->info.t });
    }
    scene_free(&s);
    bbm_model_free(m);
    return stood;
}

int main(void)
{
    const double limit = atan(least_slope(0, WIDTH, 0, 0)) / DEGREE;
    double low = 28.6, high = 29.4;
    case_results r;

    printf("\n# Tilted wall of %d courses\n\n| | computed | theory | error |\n"
           "|---|---|---|---|\n", COURSES);
    case_open(&r, "tilt");
    while (high - low > 0.02)
        *(stands((low + high) / 2, 0.1, NULL, NULL) ? &low : &high) = (low + high) / 2;
    case_compare(&r, "largest tilt [degree]", (low + high) / 2, limit);
    case_compare(&r, "stands 0.1 degrees below (1 yes, 0 no)",
                 stands(limit - 0.1, 0.1, &r, "A wall stands, 0.1 degrees before its limit"), 1);
    case_compare(&r, "stands 0.1 degrees above",
                 stands(limit + 0.1, 3, &r, "A wall falls, 0.1 degrees beyond its limit"), 0);
    printf("\nNumbers and pictures: %s/results.csv, stands.svg, states.svg, falls.svg (it moves)\n",
           r.folder);
    return case_close(&r) || r.worst > 1e-3;
}
