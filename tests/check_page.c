/* check_page.c - what the page shows is what the library has: its calls, compiled like all else.
 * The same in WebAssembly and in a browser: check_page.js, of `make check-page`. */
#include <stdio.h>
#include <string.h>

#include "../page/page.h"
#include "../program/run.h"
#include "check.h"

enum { STEPS = 5 };

/* The next numbers of the page are these, to the last bit. */
static const double *same(const double *x, int n, const double *expected)
{
    for (int k = 0; k < n; k++)
        ck_assert_msg(x[k] == expected[k], "%d: %.17g, expected %.17g", k, x[k], expected[k]);
    return x + n;
}

#define SAME(x, ...)                                                                               \
    same(x, COUNT(((double[]){ __VA_ARGS__ })), (double[]){ __VA_ARGS__ })

static void compare_elements(page *g, const bbm_model *m)
{
    ck_assert_int_eq(page_numbers(g, 'v'), 6 * m->vertices);
    const double *x = page_data(g);
    for (const bbm_vertex *v = m->vertex; v < m->vertex + m->vertices; v++)
        x = SAME(x, v->x + m->origin[0], v->y + m->origin[1], v->u, v->v, m->node[v->node].held,
                 m->element[v->element].block);
    ck_assert_int_eq(page_numbers(g, 'e'), 26 * m->elements);
    x = page_data(g);
    for (const bbm_element *e = m->element; e < m->element + m->elements; e++, x += 7) {
        x = same(same(same(x, 6, e->D), 6, e->V), 3, e->stress);
        x = SAME(x + 1, bbm_mises(e->stress, *x), hypot(e->sum[0], e->sum[1]), e->material.E);
        SAME(x + 3, e->block, e->first, e->n, m->K->place[e - m->element]);
    }
}

static void compare_contacts(page *g, const bbm_model *m)
{
    ck_assert_int_eq(page_numbers(g, 'k'), 2 * m->K->first[m->K->n]);
    ck_assert_int_eq(page_numbers(g, 'd'), 3 * m->edges);
    ck_assert_int_eq(page_numbers(g, 'c'), 10 * m->contacts);
    const double *x = page_data(g);
    for (const bbm_contact *c = m->contact; c < m->contact + m->contacts; c++, x += 10) {
        SAME(x, c->corner, c->edge, c->state);
        SAME(x + 5, c->N, c->T, c->d_n, bbm_shear_strength(&c->strength, c->N), c->slip);
        ck_relative(hypot(x[3], x[4]), hypot(c->N, c->T), 1e-15 * 8);       /* some roundings */
    }
}

static void compare_facts(page *g, const model *p)
{
    const bbm_info *i = &p->m->info;
    char said[300];
    double x[MODEL_FOLLOWED];

    ck_assert_int_eq(page_numbers(g, 'f'), 22 + MODEL_FOLLOWED * p->monitors);
    SAME(page_data(g), i->step, p->dynamic ? i->step * p->m->par.dt : 0);
    SAME(page_data(g) + 8, i->passes, i->iterations, i->pcg.residual, i->cuts, i->contacts);
    for (int k = 0; k < p->monitors; k++) {
        model_follow(p, &p->monitor[k], x);
        same(page_data(g) + 22 + MODEL_FOLLOWED * k, MODEL_FOLLOWED, x);
    }
    for (int k = 0; k < p->expectations; k++) {
        page_numbers(g, 'x');
        ck_assert_int_eq((int)page_data(g)[5 * k + 4], run_is_met(p, k, said));
        ck_assert_str_eq(page_text(g, 'x', k), said);
    }
}

static const char *const models[] = { "incline", "dam", "exp2", "arch", "cradle" };

/* The model, by the page and by the library. */
static page *load(const char *folder, const char *name, int status, model *p)
{
    char path[100];

    snprintf(path, sizeof path, "%s/%s.model", folder, name);
    ck_assert_int_eq(model_read(path, 0, NULL, p), status);
    page *g = page_load(path);
    ck_assert_int_eq(page_state(g), status);
    return g;
}

START_TEST(after_load_and_each_step_the_arrays_are_those_of_the_library)
{
    model p;
    page *g = load("cases/models", models[_i], 0, &p);
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
    model p, q;
    page *good = load("cases/models", "incline", 0, &q), *g = load("tests/bad", wrong[_i], 2, &p);

    ck_assert_str_eq(page_text(g, 'm', 0), p.message);
    ck_assert_int_gt(atoi(strstr(p.message, ".model:") + 7), 0);
    ck_assert_int_eq(page_step(g), 2);
    ck_assert_int_eq(page_numbers(g, 'v'), 0);
    ck_assert_int_eq(page_step(good), 0);
    page_free(g), page_free(good);
    model_free(&p), model_free(&q);
}
END_TEST

/* Each look begins with as many closed contacts as the one before has left, and states change where
 * they are judged alone. How many looks followed a solution. */
static int check_looks(page *g)
{
    int closed = 0, solutions = 0;

    for (int n = page_numbers(g, 'p'), k = 0; k < n; k += 4) {
        const int what = (int)page_data(g)[k + 2], end = k + 8 * (int)page_data(g)[k + 3];
        int was = 0, is = 0;
        for (; k < end; k += 8) {
            const double *x = page_data(g) + k + 4;
            const int from = (int)x[2], to = (int)x[3];
            ck_assert(what == PAGE_JUDGED || what == PAGE_DONE || from == to);
            was += from != BBM_OPEN;
            is += to != BBM_OPEN;
        }
        ck_assert(what == PAGE_LISTED || was == closed);
        closed = is;
        solutions += what != PAGE_LISTED;
    }
    return solutions;
}

/* Until the dominoes fall on each other; the incline slides from the first step on. */
START_TEST(the_looks_at_a_step_lead_from_state_to_state)
{
    model p;
    page *g = load("cases/models", _i ? "dominoes" : "incline", 0, &p);

    for (int k = 0; k < (_i ? 900 : 3); k++) {
        ck_assert_int_eq(page_step(g), 0);
        const int looks = check_looks(g);
        page_numbers(g, 'f');
        const double *f = page_data(g);
        ck_assert(f[0] == 0 || f[11] > 0 || (looks > 0 && looks == (int)f[8]));    /* f[11]: cuts */
    }
    page_free(g);
    model_free(&p);
}
END_TEST

/* The block of the incline, 1 m x 0.5 m, in the air; by its centre, so that it does not turn. After
 * so many steps, four times those of the file, what still swings is below 1e-5. */
START_TEST(a_hand_that_lifts_a_block_carries_its_weight)
{
    model p;
    page *g = load("cases/models", "incline", 0, &p);

    page_hold(g, 1, 0.3080127019, 0.4665063510);
    page_pull(g, 0.3080127019, 2);
    for (int k = 0; k < 400; k++)
        ck_assert_int_eq(page_step(g), 0);
    ck_assert_int_eq(page_numbers(g, 'h'), 7);
    const double *h = page_data(g), W = 2500 * 9.81 * 0.5;
    ck_assert_double_eq_tol(h[5], 0, 1e-5 * W);
    ck_relative(h[6], W, 1e-5);
    page_hold(g, -1, 0, 0);
    ck_assert_int_eq(page_numbers(g, 'h'), 0);
    for (int k = 0; k < 99; k++)
        ck_assert_int_eq(page_step(g), 0);
    page_free(g);
    model_free(&p);
}
END_TEST

Suite *page_suite(void)
{
    Suite *s = suite_create("page");

    add_case(s, "page",
        { after_load_and_each_step_the_arrays_are_those_of_the_library, COUNT(models) },
        { a_wrong_model_gives_its_line_and_cannot_step, COUNT(wrong) },
        { the_looks_at_a_step_lead_from_state_to_state, 2 },
        { a_hand_that_lifts_a_block_carries_its_weight, 1 });
    return s;
}
