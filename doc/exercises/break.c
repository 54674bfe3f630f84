/* break.c - Exercise 9.2: a bond that breaks.
 *
 *     |.-----.-----.        Two squares of 1 m, bonded; the left one is held by the wall. A force F
 *     ||     |     | -> F   on the right one grows by 1 kN a step, so slowly that inertia is
 *     |'-----'-----'        nothing, until the bond breaks. After that the right square is free:
 *                           u = F t^2/(2m).
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/base.h"

/* Takes the bonds out of the list of which a spring carries more than `strength` [N] after the last
 * step. The springs of bond b are the gaps 2b and 2b + 1; they carry k times the length of d. Returns
 * how many bonds broke. */
static int break_bonds(bbm_model *m, double strength)
{
    int broken = 0;

    for (int b = m->bonds - 1; b >= 0; b--) {
        double most = 0;
        for (int end = 0; end < 2; end++) {
            const bbm_gap *g = &m->gap[2 * b + end];
            const bbm_vertex *P = &m->vertex[m->bond[b].p[end]], *Q = &m->vertex[m->bond[b].q[end]];
            most = fmax(most, g->W[0][0] * hypot(P->u - Q->u, P->v - Q->v));
        }
        if (most <= strength)
            continue;
        broken++;
        m->bonds--;
        for (int k = b; k < m->bonds; k++)
            m->bond[k] = m->bond[k + 1];
    }
    return broken;
}

static bbm_model *make_bar(void)
{
    static const int left[4] = { 0, 1, 4, 3 }, right[4] = { 1, 2, 5, 4 };
    bbm_model *m;

    if (bbm_model_new(&m))
        return NULL;
    bbm_add_material(m, &(bbm_material){ .E = 1e10, .nu = 0.2, .density = 2500, .thickness = 1 },
                     NULL);
    for (int k = 0; k < 6; k++)
        bbm_add_node(m, k % 3, k / 3, NULL);
    bbm_add_element(m, 0, 0, 4, left, NULL);
    bbm_add_element(m, 0, 0, 4, right, NULL);
    bbm_fix_node(m, 0, BBM_XY, 0, 0);
    bbm_fix_node(m, 3, BBM_X, 0, 0);                      /* free to contract: no force across    */
    return m;
}

static int run(bbm_model *m)
{
    const double strength = 10.5e3, mass = 2500;
    int load = 0, broken = 0;

    if (bbm_prepare(m))
        return 0;
    m->par.dt = 1;                                      /* the bar swings in a millisecond          */
    m->par.velocity_factor = 0;
    while (!broken && load < 100) {
        load++;
        bbm_add_load(m, 2, 500, 0);
        bbm_add_load(m, 5, 500, 0);
        if (bbm_step(m))
            return 0;
        broken = break_bonds(m, strength);
    }
    /* Each spring carries half of F: 11 kN of 22 are the first that are more than 10.5. */
    printf("%s%d bond broke at F = %d kN, expected 1 at 22\n", load == 22 ? "" : "wrong: ", broken,
           load);
    const double u = m->element[1].sum[0];
    m->par.dt = 0.01;
    m->par.velocity_factor = 1;
    for (int step = 0; step < 10; step++)
        if (bbm_step(m))
            return 0;
    /* The square is let go strained, and swings; its barycentre does not: 1e-9. */
    const double way = m->element[1].sum[0] - u, expected = 22e3 * 0.1 * 0.1 / 2 / mass;
    const int right = load == 22 && fabs(way - expected) <= 1e-9 * expected;
    printf("%sway in 0.1 s %.9f m, expected %.9f\n", right ? "" : "wrong: ", way, expected);
    return right;
}

int main(void)
{
    bbm_model *m = make_bar();
    const int right = m && run(m);

    if (m && bbm_message(m)[0])
        printf("wrong: %s\n", bbm_message(m));
    bbm_model_free(m);
    return right ? EXIT_SUCCESS : EXIT_FAILURE;
}
