/* exp1_beyond.c - Experiment I beyond the paper: bonds that multipliers hold, and quadrilaterals
 * that bend. Errors are against the converged finite element. */
#include "../beyond/beyond.h"
#include "exp.h"

/* The error of the deflection of the axis in x, in percent. */
static double deflection_error(const bbm_model *m, const case_reference *b, double x)
{
    return case_percent(case_at(m, "v", x, 0), case_find(b, "v", x, 0)->converged);
}

/* v(24,0) for three values of alpha: the paper's way, with one and two rounds of multipliers. */
static void print_augmented(const case_reference *b)
{
    printf("\nMultipliers: v(24,0), load b, against the converged finite element\n\n"
           "| alpha | the paper's way | with beyond/: one round | with beyond/: two rounds |\n"
           "|---|---|---|---|\n");
    for (double alpha = 10; alpha <= 1000; alpha *= 10) {
        printf("| %g |", alpha);
        for (int rounds = 0; rounds <= 2; rounds++) {
            bbm_model *m = rounds ? case_beyond_model(rounds) : case_paper_model();
            exp1_solve(m, "b", CELL_CROSSED, 2, alpha);
            printf(" %+.4f %% |", deflection_error(m, b, 24));
            bbm_model_free(m);
        }
        printf("\n");
    }
}

/* The beam under load b on a uniform grid, with bonds that do not give. */
static bbm_model *solve_uniform(int nx, int ny, int cut, bbm_bonding bonding)
{
    bbm_model *m = case_beyond_model(2);
    case_grid g = { .nx = nx, .ny = ny, .cut = cut, .y = -EXP1_HEIGHT / 2, .w = EXP1_LENGTH,
                    .h = EXP1_HEIGHT };

    exp1_add_beam(m, "b", &g);
    m->beyond->bonding = bonding;
    case_solve(m);
    return m;
}

/* Quadrilaterals by their bond, beside triangles of as many unknowns. */
static void print_quadrilaterals(const case_reference *b)
{
    printf("\nQuadrilaterals by their bonds, load b, all with two rounds of multipliers: error of "
           "v(48,0), v(24,0)\n\n"
           "| unknowns | at vertices, as the paper has it | with moment | triangles |\n"
           "|---|---|---|---|\n");
    for (int n = 1; n <= 4; n *= 2) {
        printf("| %d |", 6 * 24 * 6 * n * n);
        for (int kind = 0; kind < 3; kind++) {
            bbm_model *m = kind < 2
                ? solve_uniform(24 * n, 6 * n, CELL_QUADS, kind ? BBM_MOMENT : BBM_VERTICES)
                : solve_uniform(18 * n, 4 * n, CELL_ALTERNATING, BBM_VERTICES);
            printf(" %+.3f %%, %+.3f %% |", deflection_error(m, b, 48), deflection_error(m, b, 24));
            bbm_model_free(m);
        }
        printf("\n");
    }
}

void exp1_show_beyond(const case_reference *b)
{
    printf("\n## With beyond/\n");
    print_augmented(b);
    print_quadrilaterals(b);
}
