/* resting.c - the stress in a block that rests under its own weight.
 *
 *     y ^                            a block of 6 x 8 cells of four bonded triangles, b = 1.5 m, h = 2 m, on a fixed
 *     h |-.-.-.-.-.-.                base; 2500 kg/m^3, E = 100 MPa, nu = 0, p_n = 1e10 N/m
 *       |X|X|X|X|X|X|
 *       '-'-'-'-'-'-'                What a horizontal cut carries is the weight above:
 *       |X|X|X|X|X|X|                    syy = -rho g (h - y)
 *     0 '-'-'-'-'-'-' -> x           on average over a row of cells, y in its middle.
 *   ___________________
 *   ///////////////////
 *
 * Contact is between vertices and edges. With par.faces = 1, the default, all grid points of a side are vertices, and
 * the lower side stands on all of them. With par.faces = 0 only corners are, as in the DDA of whole blocks: then this
 * block stands on its two lower corners like a table on its legs, and the stress flows together there.
 *
 * The row means are right either way (equilibrium, up to the strain: the block is no longer as wide as the formula has
 * it, above all next to its corners). Single elements are near the formula only with faces: within 2 % of rho g h, half
 * as much inside a mesh twice as fine, because a triangle has one stress. */
#include <math.h>

#include "case.h"

enum { NX = 6, NY = 8, CELL = 4, STEPS = 200 };

static const double b = 1.5, h = 2, rho = 2500, g = 9.81;

static void place(double i, double j, const void *unused, double xy[2])
{
    (void)unused;
    xy[0] = b * i / NX;
    xy[1] = h * j / NY;
}

/* The block in equilibrium: quasi-static steps. */
static bbm_model *settle_block(int faces)
{
    bbm_model *m = case_model();

    bbm_add_material(m, &(bbm_material){ 1e12, 0, rho, 1 }, NULL);
    bbm_add_material(m, &(bbm_material){ 1e8, 0, rho, 1 }, NULL);
    case_add_box(m, &(case_box){ .nx = 1, .ny = 1, .x = -0.5, .y = -0.5, .w = b + 1, .h = 0.5 });
    case_fix_block(m, 0);
    case_add_grid(m, &(case_grid){ .nx = NX, .ny = NY, .cut = CASE_CROSSED, .block = 1, .material = 1, .map = place });
    m->par.dt = 0.01;
    m->par.gravity[1] = -g;
    m->par.p_n = 1e10;
    m->par.p_s = 4e9;
    m->par.friction = 30;
    m->par.faces = faces;
    m->par.pcg.tolerance = 1e-13;
    case_must(m, bbm_prepare(m));
    case_settle(m, STEPS);
    return m;
}

/* The mean of syy in row j of cells, and how far that of a single element is from theory at most. */
static double row_stress(const bbm_model *m, int j, double *worst)
{
    double sum = 0, area = 0;

    *worst = 0;
    for (int i = 0; i < CELL * NX; i++) {
        bbm_element e = m->element[1 + j * CELL * NX + i];
        bbm_element_geometry(&e, &m->vertex[e.first]);
        sum += e.A * e.stress[1];
        area += e.A;
        *worst = fmax(*worst, fabs(e.stress[1] + rho * g * (h - e.y)));
    }
    return sum / area;
}

static void draw(case_results *r, const bbm_model *const m[2])
{
    double exact[2] = { -rho * g * h, 0 }, ends[2] = { 0, h };
    double y[2][CELL * NX * NY], value[2][CELL * NX * NY];

    for (int k = 0; k < 2; k++)
        for (int i = 0; i < CELL * NX * NY; i++) {
            bbm_element e = m[k]->element[1 + i];
            bbm_element_geometry(&e, &m[k]->vertex[e.first]);
            y[k][i] = e.y;
            value[k][i] = e.stress[1];
        }
    const plot_series s[] = {
        { .name = "-rho g (h - y)", .n = 2, .x = exact, .y = ends, .look = 1 },
        { .name = "elements, corners only", .n = CELL * NX * NY, .x = value[0], .y = y[0], .style = PLOT_MARKS,
          .look = 2 },
        { .name = "elements, faces too", .n = CELL * NX * NY, .x = value[1], .y = y[1], .style = PLOT_MARKS,
          .look = 3 },
    };
    case_draw_chart(r, "rows.svg", &(plot_chart){ .title = "Block under its own weight: stress syy by height",
                    .x = { "syy", "Pa", 0, -280e3, 20e3 }, .y = { "y", "m", 0, 0, 0 }, .count = 3, .series = s });
}

int main(void)
{
    case_results r;
    bbm_model *m[2];

    printf("\n# Bonded block under its own weight\n\n| syy [Pa] | computed | theory | error |\n|---|---|---|---|\n");
    case_open(&r, "resting");
    for (int k = 0; k < 2; k++) {
        m[k] = settle_block(k);
        double largest = 0;
        for (int j = 0; j < NY; j++) {
            const double theory = -rho * g * h * (1 - (j + 0.5) / NY);
            double worst;
            char name[60];
            const double mean = row_stress(m[k], j, &worst);
            largest = fmax(largest, worst);
            snprintf(name, sizeof name, "%s, mean of row %d", k ? "faces too" : "corners only", j + 1);
            case_compare(&r, name, mean, theory);
        }
        printf("| %s, worst element, of rho g h | %.1e | 0 | |\n", k ? "faces too" : "corners only",
               largest / (rho * g * h));
    }
    draw(&r, (const bbm_model *const *)m);
    case_draw_map(&r, "corners.svg", m[0],
                  &(scene_map){ "Stress syy, standing on its corners", "syy", -1 });
    case_draw_map(&r, "faces.svg", m[1],
                  &(scene_map){ "Stress syy, standing on its face", "syy", -1 });
    printf("\nNumbers and pictures: %s/results.csv, rows.svg, corners.svg, faces.svg\n", r.folder);
    for (int k = 0; k < 2; k++)
        bbm_model_free(m[k]);
    return case_close(&r);
}
