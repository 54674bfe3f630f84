/* overhang.c - how far a stack of blocks can lean over an edge.
 *
 *              .---------.          n = 4 blocks 1 m x 0.25 m. The upper k balance on the end of the block below if
 *           .--------.---'          their common centre of mass is not beyond it; from the top down the largest
 *         .-------.--'              shifts are 1/2, 1/4, 1/6, 1/8, together half the n-th harmonic number:
 *       .------.--'
 *   ____'----.-'                        (1 + 1/2 + 1/3 + 1/4)/2 = 25/24 = 1.0417 m,
 *   /////////|
 *            |<-- f 25/24 -->       whatever the blocks weigh. 0.98 of it stands, 1.02 of it falls.
 *
 * Each interface is then held by its outer corner alone or nearly so, and one that hides a tensile strength in its
 * tolerances would hold more. Where a stack stops standing is searched for by bisection. Near that factor a fall
 * takes long to begin: a stack counts as standing if no block has moved by 1 cm after 3 s. */
#include <math.h>

#include "case.h"

enum { BLOCKS = 4, SETTLE = 50, STEPS = 300 };

/* A stack with f times the greatest overhang: the block that is i-th from above is shifted by f/(2 i). */
static bbm_model *build_stack(double f)
{
    bbm_model *m = case_model();
    double x = -1;

    bbm_add_material(m, &(bbm_material){ 1e14, 0.25, 2500, 1 }, NULL);
    bbm_add_material(m, &(bbm_material){ 1e10, 0.25, 2500, 1 }, NULL);
    case_add_box(m, &(case_box){ .nx = 1, .ny = 1, .x = -1.5, .y = -2, .w = 1.5, .h = 2 });
    case_fix_block(m, 0);
    for (int k = 0; k < BLOCKS; k++) {
        x += f / (2 * (BLOCKS - k));
        case_add_box(m, &(case_box){ .block = 1 + k, .material = 1, .nx = 1, .ny = 1, .x = x, .y = 0.25 * k, .w = 1,
                                     .h = 0.25 });
    }
    m->par.dt = 0.01;
    m->par.gravity[1] = -9.81;
    m->par.p_n = 1e9;
    m->par.p_s = 0.4e9;
    m->par.friction = 30;
    m->par.pcg.tolerance = 1e-14;
    case_must(m, bbm_prepare(m));
    return m;
}

/* The largest displacement of a block. */
static double moved(const bbm_model *m)
{
    double d = 0;

    for (int k = 1; k <= BLOCKS; k++)
        d = fmax(d, hypot(m->element[k].sum[0], m->element[k].sum[1]));
    return d;
}

/* Lets a stack go and returns how far a block has moved after `steps`. s, if not NULL, records; *m, if not NULL, is the
 * caller's to free. */
static double let_go(double f, int steps, scene *s, bbm_model **kept)
{
    bbm_model *m = build_stack(f);

    case_settle(m, SETTLE);
    m->info.t = 0;
    if (s)
        scene_record(s, m);
    for (int i = 0; i < steps; i++)
        case_step(m, NULL, s);
    const double d = moved(m);
    if (kept)
        *kept = m;
    else
        bbm_model_free(m);
    return d;
}

/* The factor between 0.98 and 1.02 at which a stack stops standing. */
static double find_limit(void)
{
    double stands = 0.98, falls = 1.02;

    while (falls - stands > 1e-5) {
        const double f = (stands + falls) / 2;
        if (let_go(f, STEPS, NULL, NULL) < 0.01)
            stands = f;
        else
            falls = f;
    }
    return (stands + falls) / 2;
}

int main(void)
{
    static const double factor[] = { 0.98, 0.995, 1.005, 1.02 };
    case_results r;
    bbm_model *m;
    scene stands = { .title = "A stack with 0.98 of the greatest overhang stands", .window = { -1.5, 1.2, -0.5, 1.2 } };
    scene falls = { .title = "A stack with 1.02 of the greatest overhang falls", .window = { -1.5, 1.7, -2, 1.2 } };

    printf("\n# Overhang of four blocks\n\n| of 25/24 m | moved after 3 s [m] | it |\n|---|---|---|\n");
    case_open(&r, "overhang");
    for (int i = 0; i < 4; i++) {
        const double d = let_go(factor[i], STEPS, NULL, NULL);
        char name[40];
        printf("| %g | %.3g | %s |\n", factor[i], d, d < 0.01 ? "stands" : "falls");
        snprintf(name, sizeof name, "%g stands", factor[i]);
        case_row(&r, name, (double[]){ NAN, NAN }, d < 0.01, factor[i] < 1, "theory");
    }
    printf("\n| | computed | theory | error |\n|---|---|---|---|\n");
    case_compare(&r, "greatest overhang [m]", find_limit() * 25 / 24, 25.0 / 24);
    let_go(factor[0], STEPS, &stands, &m);
    case_draw_panels(&r, "stands.svg", m, &stands, 1, (double[]){ 3 });
    bbm_model_free(m);
    let_go(factor[3], 150, &falls, &m);
    case_draw_panels(&r, "falls.svg", m, &falls, 4, (double[]){ 0, 0.7, 1.0, 1.3 });
    case_draw_movie(&r, "movie.svg", m, &falls);
    printf("\nNumbers and pictures: %s/results.csv, stands.svg, falls.svg, movie.svg\n", r.folder);
    bbm_model_free(m);
    scene_free(&stands);
    scene_free(&falls);
    return case_close(&r);
}
