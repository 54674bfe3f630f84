/* check_page.c - what the page shows is what the library has: its calls, compiled like all else. The
 * same in WebAssembly and in a browser: check_page.js, of `make check-page`. */
#include <stdio.h>
#include <string.h>

#include "../page/page.h"
#include "../program/run.h"
#include "../program/statements.h"
#include "check.h"

enum { STEPS = 5 };

static page *load(const char *path, const char *lets)
{
    char text[100];

    snprintf(text, sizeof text, "%s", lets);
    page *g = page_load(path, text);
    ck_assert_ptr_nonnull(g);
    return g;
}

/* The next numbers are those of an array, to the last bit. */
static const double *same(const double *x, int n, const double *expected, const char *what)
{
    for (int k = 0; k < n; k++)
        ck_assert_msg(x[k] == expected[k], "%s %d: %.17g, expected %.17g", what, k, x[k], expected[k]);
    return x + n;
}

#define SAME(x, what, ...)                                                                         \
    same(x, COUNT(((double[]){ __VA_ARGS__ })), (double[]){ __VA_ARGS__ }, what)

static void compare_elements(page *g, const bbm_model *m)
{
    ck_assert_int_eq(page_numbers(g, 'v'), 4 * m->vertices);
    const double *x = page_data(g);
    for (const bbm_vertex *v = m->vertex; v < m->vertex + m->vertices; v++)
        x = SAME(x, "vertex", v->x + m->origin[0], v->y + m->origin[1], v->u, v->v);
    ck_assert_int_eq(page_numbers(g, 'e'), 22 * m->elements);
    x = page_data(g);
    for (const bbm_element *e = m->element; e < m->element + m->elements; e++) {
        x = same(same(x, 6, e->D, "D"), 6, e->V, "V");
        x = same(x, 3, e->stress, "stress");
        x = SAME(x, "szz, mises", bbm_stress_out_of_plane(e),
                 bbm_mises(e->stress, bbm_stress_out_of_plane(e)));
        x = same(x, 3, e->sum, "sum");
        x = SAME(x, "barycentre", e->x + m->origin[0], e->y + m->origin[1]);
    }
    ck_assert_int_eq(page_numbers(g, 'a'), 7 * m->elements);
    x = page_data(g);
    for (const bbm_element *e = m->element; e < m->element + m->elements; e++)
        x = SAME(x, "element", e->first, e->n, e->block, e->material.E, e->material.nu,
                 e->material.density, e->material.thickness);
}

static void compare_contacts(page *g, const bbm_model *m)
{
    int held = 0;

    ck_assert_int_eq(page_numbers(g, 'd'), 3 * m->edges);
    const double *x = page_data(g);
    for (const bbm_edge *d = m->edge; d < m->edge + m->edges; d++)
        x = SAME(x, "edge", d->a, d->b, d->block);
    ck_assert_int_eq(page_numbers(g, 'c'), 13 * m->contacts);
    x = page_data(g);
    for (const bbm_contact *c = m->contact; c < m->contact + m->contacts; c++, x += 13) {
        const bbm_vertex *P = bbm_start_of(m, c->corner);
        SAME(x, "contact", c->corner, c->edge, c->state, P->x + m->origin[0], P->y + m->origin[1]);
        SAME(x + 7, "forces", c->N, c->T, c->d_n, bbm_shear_strength(&c->strength, c->N), c->slip);
        ck_near(hypot(x[5], x[6]), hypot(c->N, c->T), hypot(c->N, c->T), 1e-15 * 8);
    }
    for (int v = 0; v < m->vertices; v++)
        held += m->node[m->vertex[v].node].held != 0;
    ck_assert_int_eq(page_numbers(g, 'h'), 2 * held);
    const int links = m->K->first[m->K->n];
    ck_assert_int_eq(page_numbers(g, 'k'), 1 + m->K->n + 2 * links);
    ck_assert_int_eq(page_numbers(g, 'l') % 4, 0);
}

static void compare_facts(page *g, const model *p)
{
    const bbm_info *i = &p->m->info;
    char said[300];
    double u[2];

    ck_assert_int_eq(page_numbers(g, 'f'), 22);
    const double *f = page_data(g);
    SAME(f, "step", i->step, p->dynamic ? i->step * p->m->par.dt : 0);
    SAME(f + 8, "facts", i->passes, i->iterations, i->pcg.residual, i->cuts, i->contacts,
         i->penetration, i->candidates, i->change);
    SAME(f + 19, "work", p->m->beyond->work, p->m->beyond->gained);
    ck_assert_int_eq(page_numbers(g, 'o'), 2 * p->monitors);
    for (int k = 0; k < p->monitors; k++) {
        model_displacement(p, &p->monitor[k], u);
        same(page_data(g) + 2 * k, 2, u, "monitor");
    }
    ck_assert_int_eq(page_numbers(g, 'x'), 5 * p->expectations);
    for (int k = 0; k < p->expectations; k++) {
        ck_assert_int_eq((int)page_data(g)[5 * k + 4], run_is_met(p, k, said));
        ck_assert_str_eq(page_text(g, 'x', k), said);
    }
}

static const struct { const char *path, *let; } models[] = {
    { "cases/models/incline.model", "phi=10" }, { "cases/models/dam.model", NULL },
    { "cases/models/exp2.model", NULL }, { "cases/models/arch.model", NULL },
    { "cases/models/cradle.model", NULL },
};

START_TEST(after_load_and_each_step_the_arrays_are_those_of_the_library)
{
    page *g = load(models[_i].path, models[_i].let ? models[_i].let : "");
    model p;

    ck_assert_int_eq(model_read(models[_i].path, models[_i].let != NULL,
                                (char *[]){ (char *)(size_t)models[_i].let }, &p), 0);
    run r = { .p = &p, .settling = p.settle };
    for (int k = 0; k < STEPS && page_state(g) == 0; k++) {
        compare_elements(g, p.m);
        compare_contacts(g, p.m);
        compare_facts(g, &p);
        ck_assert_int_eq(run_step(&r), BBM_OK);
        ck_assert_int_eq(page_step(g), r.is_over);
    }
    page_free(g);
    model_free(&p);
}
END_TEST

static const char *const wrong[] = { "alpha-zero", "block-crossing", "let-dollar" };

START_TEST(a_wrong_model_gives_its_line_and_cannot_step)
{
    char path[100];
    model p;

    snprintf(path, sizeof path, "tests/bad/%s.model", wrong[_i]);
    page *g = load(path, ""), *good = load(models[0].path, "");
    ck_assert_int_eq(model_read(path, 0, NULL, &p), 2);
    ck_assert_str_eq(page_text(g, 'm', 0), p.message);
    ck_assert_int_gt(atoi(strstr(p.message, ".model:") + 7), 0);
    ck_assert_int_eq(page_state(g), 2);
    ck_assert_int_eq(page_step(g), 2);
    ck_assert_int_eq(page_numbers(g, 'v'), 0);
    ck_assert_str_eq(page_text(g, 'b', 0), "");
    ck_assert_int_eq(page_step(good), 0);
    page_free(g);
    page_free(good);
    model_free(&p);
}
END_TEST

/* The rows as states before and after; the last one has none. */
static const int before[] = { 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 2 };
static const int after[] = { 0, 1, 2, 0, 2, 2, 1, 2, 0, 1, 0, 2 };

/* Each look begins with the states in which the one before has ended. How many followed a solution. */
static int check_looks(page *g)
{
    int (*state)[2] = NULL, states = 0, solutions = 0;

    for (int n = page_numbers(g, 'p'), k = 0; k < n; ) {
        const double *look = page_data(g) + k;
        const int count = (int)look[3], what = (int)look[2];
        int (*now)[2] = calloc((size_t)count + 1, sizeof *now), open = 0;
        for (int c = 0; c < count; c++) {
            const double *x = look + 4 + 8 * c;
            const int from = (int)x[2], to = (int)x[3], row = (int)x[7];
            ck_assert(row == PAGE_HANDED_ON ? what == PAGE_DONE : before[row] == from && after[row] == to);
            ck_assert(what == PAGE_JUDGED || what == PAGE_DONE || from == to);
            open += what != PAGE_LISTED && from == 0;
            now[c][0] = from, now[c][1] = to;
        }
        int closed = 0;
        for (int c = 0; c < states; c++)
            closed += state[c][1] != 0;
        ck_assert(what == PAGE_LISTED || count - open == closed);
        free(state);
        state = now, states = count;
        solutions += what != PAGE_LISTED;
        k += 4 + 8 * count;
    }
    free(state);
    return solutions;
}

/* Until the dominoes fall on each other; the incline slides from the first step on. */
START_TEST(the_looks_at_a_step_lead_from_state_to_state_by_rows_of_the_table)
{
    page *g = load(_i ? "cases/models/dominoes.model" : "cases/models/incline.model", "");

    for (int k = 0; k < (_i ? 900 : 3); k++) {
        ck_assert_int_eq(page_step(g), 0);
        page_numbers(g, 'f');
        const int step = (int)page_data(g)[0], passes = (int)page_data(g)[8];
        const int cuts = (int)page_data(g)[11], looks = check_looks(g);
        ck_assert(step == 0 || cuts > 0 || (looks > 0 && looks == passes));
    }
    page_free(g);
}
END_TEST

Suite *page_suite(void)
{
    Suite *s = suite_create("page");
    const loop_test e[] = {
        { after_load_and_each_step_the_arrays_are_those_of_the_library, COUNT(models) },
        { a_wrong_model_gives_its_line_and_cannot_step, COUNT(wrong) },
        { the_looks_at_a_step_lead_from_state_to_state_by_rows_of_the_table, 2 },
    };

    add_case(s, "page", e, COUNT(e));
    return s;
}
