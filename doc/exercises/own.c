/* own.c - what a student's copy of a source computes: the bar of doc/02-two-elements.md and a fall,
 * each beside its closed form. `make exercise` runs it after green. */
#include <stdio.h>

#include "../../base/base.h"

static void run(bbm_model *m, int steps)
{
    m->par.steps = steps;
    if (bbm_prepare(m) || bbm_run(m))
        printf("    %s\n", bbm_message(m));
}

static void pull_a_bar(bbm_model *m)
{
    const double x[6] = { 0, 1, 2, 0, 1, 2 }, y[6] = { 0, 0, 0, 1, 1, 1 };
    bbm_result end = { 0 };

    bbm_add_material(m, &(bbm_material){ .E = 8000, .density = 1, .thickness = 1 }, NULL);
    for (int k = 0; k < 6; k++)
        bbm_add_node(m, x[k], y[k], NULL);
    bbm_add_element(m, 0, 0, 4, (int[]){ 0, 1, 4, 3 }, NULL);
    bbm_add_element(m, 0, 0, 4, (int[]){ 1, 2, 5, 4 }, NULL);
    bbm_fix_node(m, 0, BBM_XY, 0, 0);
    bbm_fix_node(m, 3, BBM_X, 0, 0);
    bbm_add_line_load(m, 2, 5, 16, 0);
    m->par.alpha = 10;
    m->par.dt = INFINITY;
    m->par.tolerance = 0;
    run(m, 1);
    bbm_nodal_result(m, 2, -1, &end);
    printf("    the end of two bonded squares moves by %.4f m; by hand 0.0044 m\n", end.u);
}

static void let_a_block_fall(bbm_model *m)
{
    bbm_add_material(m, &(bbm_material){ .E = 1e9, .density = 2500, .thickness = 1 }, NULL);
    for (int k = 0; k < 4; k++)
        bbm_add_node(m, k == 1 || k == 2, k / 2, NULL);
    bbm_add_element(m, 0, 0, 4, (int[]){ 0, 1, 2, 3 }, NULL);
    m->par.gravity[1] = -9.81;
    m->par.dt = 0.01;
    m->par.tolerance = 0;
    m->par.velocity_factor = 1;
    run(m, 100);
    printf("    a block falls %.4f m in 1 s; g t^2/2 = 4.9050 m\n", -m->element[0].sum[1]);
}

int main(void)
{
    void (*const show[])(bbm_model *) = { pull_a_bar, let_a_block_fall };

    puts("Computed with your code:");
    for (int k = 0; k < 2; k++) {
        bbm_model *m;
        if (bbm_model_new(&m))
            return 1;
        show[k](m);
        bbm_model_free(m);
    }
    return 0;
}
