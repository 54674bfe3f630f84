/* check_cases.c - the experiments end to end, as programs: their numbers, their files; and that doc/equations.md
 * points at functions and tests that exist. */
#define _POSIX_C_SOURCE 200809L
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"

Suite *cases_suite(void);

#ifndef BUILD
#define BUILD "out/build"
#endif

/* The whole file as a string, to be freed; the test fails when it cannot be read. */
static char *slurp(const char *path)
{
    FILE *f = fopen(path, "rb");
    char *text = NULL;
    size_t size = 0, got;

    ck_assert_msg(f != NULL, "%s cannot be read", path);
    do {
        text = realloc(text, size + 65537);
        ck_assert_ptr_nonnull(text);
        got = fread(text + size, 1, 65536, f);
        size += got;
    } while (got > 0);
    text[size] = '\0';
    fclose(f);
    return text;
}

static void run(const char *program)
{
    char command[200];

    snprintf(command, sizeof command, "%s/%s > out/%s.log", BUILD, program, program);
    ck_assert_int_eq(system(command), 0);
}

typedef struct { double computed, reference, error; } row;

/* The row of out/NAME/results.csv for a quantity at a point against a kind of reference. */
static row find_row(const char *name, const char *quantity, double x, double y, const char *kind)
{
    char path[100], *text, *line, *rest = NULL;

    snprintf(path, sizeof path, "out/%s/results.csv", name);
    text = slurp(path);
    for (line = strtok_r(text, "\n", &rest); line; line = strtok_r(NULL, "\n", &rest)) {
        char q[40], k[40];
        double px, py;
        row r;
        if (sscanf(line, "%39[^,],%lf,%lf,%lf,%lf,%39[^,],%lf", q, &px, &py, &r.computed, &r.reference, k, &r.error) == 7
            && strcmp(q, quantity) == 0 && hypot(px - x, py - y) < 1e-6 && strcmp(k, kind) == 0) {
            free(text);
            return r;
        }
    }
    ck_abort_msg("%s: no row %s(%g,%g) against %s", path, quantity, x, y, kind);
    return (row){ 0, 0, 0 };
}

/* One target of the experiments: the largest relative error that a quantity may have, and why that much. */
typedef struct { const char *name, *quantity; double x, y; const char *kind; double most; } target;

static const target targets[] = {
    /* Displacements of the beam: triangles 0.51 % stiff, springs 0.31 % soft on this mesh. 0.5 % is the promise. */
    { "exp1", "a.v", 24, 0, "fem", 0.005 },     { "exp1", "a.v", 36, 0, "fem", 0.005 },
    { "exp1", "b.v", 24, 0, "fem", 0.005 },     { "exp1", "b.v", 36, 0, "fem", 0.005 },
    { "exp1", "b.v", 48, 0, "fem", 0.005 },     { "exp1", "c.v", 24, 0, "theory", 0.005 },
    { "exp1", "c.v", 48, 0, "theory", 0.005 },  { "exp1", "c.u", 24, 6, "theory", 0.005 },
    { "exp1", "b.u", 24, 6, "fem", 0.005 },     { "exp1", "b.u", 48, 6, "fem", 0.005 },
    /* The tip under a point force has no limit; two meshes of equal fineness differ by h: 1 %. */
    { "exp1", "a.v", 48, 0, "fem_coarse", 0.01 },
    /* Nodal stress at a face is the mean over elements on one side of it, half an element inside: 5 %. */
    { "exp1", "b.sxx", 24, 6, "fem", 0.05 },    { "exp1", "c.svm", 12, 6, "fem", 0.05 },
    /* The infinite plate: the promise is 0.5 % in the displacements, 4 % in the peak stress. */
    { "exp2", "k5.u", 1, 0, "theory", 0.005 },  { "exp2", "k5.v", 0, 1, "theory", 0.005 },
    { "exp2", "k5.u", 5, 0, "theory", 0.005 },  { "exp2", "k5.sxx", 0, 1, "theory", 0.04 },
    { "exp2", "k5.sxx", 0, 1.5, "theory", 0.01 }, { "exp2", "k5.sxx", 0, 2, "theory", 0.01 },
    { "exp2", "k5.stt", 0.5, 0.866025404, "theory", 0.04 },
    /* The paper's plate against six-node triangles: the paper's own errors are 0.07 % to 1.27 %. */
    { "exp2", "b5.u", 1, 0, "fem_coarse", 0.0127 }, { "exp2", "b5.v", 0, 1, "fem_coarse", 0.0127 },
    { "exp2", "b5.u", 0.707106781, 0.707106781, "fem_coarse", 0.0127 },
    { "exp2", "b5.v", 0.707106781, 0.707106781, "fem_coarse", 0.0127 },
    { "exp2", "b5.u", 5, 0, "fem_coarse", 0.0127 }, { "exp2", "b5.v", 0, 5, "fem_coarse", 0.0127 },
    { "exp2", "b5.sxx", 0, 1, "fem_coarse", 0.04 }, { "exp2", "b5.sxx", 5, 0, "fem_coarse", 0.01 },
};

START_TEST(an_experiment_meets_its_target)
{
    const target *t = &targets[_i];
    const row r = find_row(t->name, t->quantity, t->x, t->y, t->kind);

    ck_assert_msg(fabs(r.error) <= t->most, "%s(%g,%g): %g, %s %g, error %.2g of %.2g", t->quantity, t->x, t->y,
                  r.computed, t->kind, r.reference, r.error, t->most);
    /* The column is printed with four digits. */
    ck_assert_double_eq_tol(r.error, (r.computed - r.reference) / r.reference, 1e-3 * fabs(r.error) + 1e-12);
}
END_TEST

START_TEST(theory_in_the_results_is_the_textbook_formula)
{
    /* Timoshenko and Goodier: v(L,0) = -P L^3/(3EI) - (4+5nu) P H^2 L/(24 EI) = -8.9 mm; Kirsch: 3 s, -s at the hole. */
    ck_assert_double_eq_tol(find_row("exp1", "c.v", 48, 0, "theory").reference, -8.9e-3, 1e-15);
    ck_assert_double_eq_tol(find_row("exp2", "k5.sxx", 0, 1, "theory").reference, 3e6, 1e-3);
    ck_assert_double_eq_tol(find_row("exp2", "k5.stt", 1, 0, "theory").reference, -1e6, 1e-3);
    /* The converged finite element knows the same: two independent sources agree to its printed digits. */
    for (int i = 0; i < 3; i++) {
        static const struct { const char *q; double x, y; } at[3] = { { "k5.u", 5, 5 }, { "k5.v", 0, 5 }, { "k5.u", 1, 0 } };
        const double f = find_row("exp2", at[i].q, at[i].x, at[i].y, "fem").reference;
        ck_assert_double_eq_tol(find_row("exp2", at[i].q, at[i].x, at[i].y, "theory").reference, f, 1e-8 * fabs(f));
    }
}
END_TEST

START_TEST(every_file_of_an_experiment_is_complete)
{
    static const char *const svg[] = {
        "exp1/fig10", "exp1/fig11", "exp1/fig12", "exp1/fig13", "exp1/deformed", "exp2/fig15", "exp2/fig16",
        "exp2/fig17", "exp2/fig18", "exp2/fig19", "exp2/fig20", "exp2/fig21a", "exp2/fig21b", "exp2/fig22",
        "exp2/fig23", "exp2/deformed",
    };

    for (size_t i = 0; i < sizeof svg / sizeof *svg; i++) {
        char path[100], *text;
        snprintf(path, sizeof path, "out/%s.svg", svg[i]);
        text = slurp(path);
        ck_assert_msg(strstr(text, "<svg") && strstr(text, "</svg>"), "%s is cut short", path);
        ck_assert_msg(!strstr(text, "nan") && !strstr(text, "inf\""), "%s has NaN or infinity", path);
        free(text);
    }
}
END_TEST

START_TEST(two_runs_write_the_same_digits)
{
    char *first = slurp("out/exp1/results.csv"), *picture = slurp("out/exp1/fig13.svg");

    run("exp1");
    char *again = slurp("out/exp1/results.csv"), *drawn = slurp("out/exp1/fig13.svg");
    ck_assert_str_eq(first, again);
    ck_assert_str_eq(picture, drawn);
    free(first);
    free(again);
    free(picture);
    free(drawn);
}
END_TEST

/* Every row of a document's tables that holds a percentage stands in the output of the programs, letter by letter. */
static void compare_tables(const char *document, const char *output)
{
    char *text = slurp(document), *printed = slurp(output), *line, *rest = NULL;
    int rows = 0;

    for (line = strtok_r(text, "\n", &rest); line; line = strtok_r(NULL, "\n", &rest))
        if (line[0] == '|' && strchr(line, '%')) {
            ck_assert_msg(strstr(printed, line) != NULL, "%s: no program prints: %s", document, line);
            rows++;
        }
    ck_assert_int_ge(rows, 6);
    free(text);
    free(printed);
}

START_TEST(the_numbers_of_the_documents_are_what_the_programs_print)
{
    ck_assert_int_eq(system("cat out/exp1.log out/exp2.log > out/run.log"), 0);
    compare_tables("README.md", "out/run.log");
    ck_assert_int_eq(system("(" BUILD "/exp1 converge; " BUILD "/exp2 converge) > out/converge.log"), 0);
    compare_tables("doc/convergence.md", "out/converge.log");
}
END_TEST

START_TEST(the_picture_of_the_readme_is_what_the_program_draws)
{
    char *shown = slurp("doc/beam.svg"), *drawn = slurp("out/exp1/deformed.svg");

    ck_assert_msg(strcmp(shown, drawn) == 0, "copy out/exp1/deformed.svg to doc/beam.svg");
    free(shown);
    free(drawn);
}
END_TEST

START_TEST(each_equation_points_at_a_function_and_a_test_that_exist)
{
    static const char *const files[] = {
        "bbm.h", "bbm.c", "solver.c", "cases/exp1.c", "cases/exp2.c", "tests/check_bbm.c", "tests/check_solver.c",
        "tests/check_cases.c",
    };
    enum { FILES = sizeof files / sizeof *files };
    char *source[FILES], *text = slurp("doc/equations.md"), *line, *rest = NULL;
    int seen[73] = { 0 };

    for (int f = 0; f < FILES; f++)
        source[f] = slurp(files[f]);
    for (line = strtok_r(text, "\n", &rest); line; line = strtok_r(NULL, "\n", &rest)) {
        int first, last, names = 0;
        const int got = sscanf(line, "| (%d)-(%d)", &first, &last);
        if (line[0] != '|')
            continue;
        for (int n = first; got >= 1 && n <= (got == 2 ? last : first) && n <= 72; n++)
            seen[n] = 1;
        for (char *p = strchr(line, '`'); p; p = strchr(p + 1, '`')) {
            char name[100];
            int found = 0;
            if (sscanf(p + 1, "%99[A-Za-z0-9_]`", name) != 1 || p[1 + strlen(name)] != '`')
                continue;
            for (int f = 0; f < FILES; f++)
                found |= strstr(source[f], name) != NULL;
            ck_assert_msg(found, "doc/equations.md names `%s`, which no source has", name);
            names++;
            p += strlen(name) + 1;
        }
        ck_assert_msg(got < 1 || names >= 2, "no function or no test: %s", line);
    }
    for (int n = 1; n <= 72; n++)
        ck_assert_msg(seen[n] || (n >= 48 && n <= 69), "doc/equations.md has no row for equation (%d)", n);
    free(text);
    for (int f = 0; f < FILES; f++)
        free(source[f]);
}
END_TEST

static void run_experiments(void)
{
    run("exp1");
    run("exp2");
}

Suite *cases_suite(void)
{
    Suite *s = suite_create("cases");
    TCase *t = tcase_create("experiments");

    tcase_set_timeout(t, 60);
    tcase_add_unchecked_fixture(t, run_experiments, NULL);
    tcase_add_loop_test(t, an_experiment_meets_its_target, 0, sizeof targets / sizeof *targets);
    tcase_add_test(t, theory_in_the_results_is_the_textbook_formula);
    tcase_add_test(t, every_file_of_an_experiment_is_complete);
    tcase_add_test(t, two_runs_write_the_same_digits);
    suite_add_tcase(s, t);
    t = tcase_create("documents");
    tcase_set_timeout(t, 60);
    tcase_add_test(t, the_numbers_of_the_documents_are_what_the_programs_print);
    tcase_add_test(t, the_picture_of_the_readme_is_what_the_program_draws);
    tcase_add_test(t, each_equation_points_at_a_function_and_a_test_that_exist);
    suite_add_tcase(s, t);
    return s;
}
