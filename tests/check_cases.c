/* check_cases.c - the experiments end to end, as programs: their numbers, their files, and the
 * numbers of the documents; that the core alone is the paper. */
#define _POSIX_C_SOURCE 200809L
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "programs.h"

typedef struct { double computed, reference, error; } row;

/* The row of out/NAME/results.csv for a quantity at a point against a kind of reference; with kind
 * NULL that of a result without a place, by the start of its name, which is in quotes if it has a
 * comma. */
static row find_row(const char *name, const char *quantity, double x, double y, const char *kind)
{
    const size_t n = strlen(quantity);
    char path[100], *rest = NULL;

    snprintf(path, sizeof path, "out/%s/results.csv", name);
    char *text = read_all(path);
    for (char *line = strtok_r(text, "\n", &rest); line; line = strtok_r(NULL, "\n", &rest)) {
        const char *p = line + (*line == '"'), *numbers = strstr(line, ",,,");
        double px = x, py = y;
        char k[40];
        row r;
        if (strncmp(p, quantity, n) != 0)
            continue;
        const int found = kind
            ? sscanf(p + n, ",%lf,%lf,%lf,%lf,%39[^,],%lf", &px, &py, &r.computed, &r.reference, k,
                     &r.error) == 6 && strcmp(k, kind) == 0
            : numbers && sscanf(numbers, ",,,%lf,%lf,%*[a-z],%lf", &r.computed, &r.reference,
                                &r.error) == 3;
        if (found && hypot(px - x, py - y) < 1e-6) {
            free(text);
            return r;
        }
    }
    ck_abort_msg("%s: no row %s(%g,%g) against %s", path, quantity, x, y, kind ? kind : "theory");
    return (row){ 0, 0, 0 };
}

/* One target of the experiments: the largest relative error that a quantity may have, against 0 the
 * absolute one, and why that much. */
typedef struct { const char *name, *quantity; double x, y; const char *kind; double most; } target;

static const target targets[] = {
    /* Displacements of the beam: triangles 0.51 % stiff, springs 0.31 % soft on this mesh. 0.5 % is
     * the promise. */
    { "exp1", "a.v", 24, 0, "fem", 0.005 },     { "exp1", "a.v", 36, 0, "fem", 0.005 },
    { "exp1", "b.v", 24, 0, "fem", 0.005 },     { "exp1", "b.v", 36, 0, "fem", 0.005 },
    { "exp1", "b.v", 48, 0, "fem", 0.005 },     { "exp1", "c.v", 24, 0, "theory", 0.005 },
    { "exp1", "c.v", 48, 0, "theory", 0.005 },  { "exp1", "c.u", 24, 6, "theory", 0.005 },
    { "exp1", "b.u", 24, 6, "fem", 0.005 },     { "exp1", "b.u", 48, 6, "fem", 0.005 },
    /* The tip under a point force has no limit; two meshes of equal fineness differ by h: 1 %. */
    { "exp1", "a.v", 48, 0, "fem_coarse", 0.01 },
    /* Nodal stress at a face is the mean over elements on one side of it, half an element inside:
     * 5 %. */
    { "exp1", "b.sxx", 24, 6, "fem", 0.05 },    { "exp1", "c.mises", 12, 6, "fem", 0.05 },
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
    /* With beyond/, on as many quadrilaterals: no springs give, and bending is exact. 0.1 % is the
     * promise; the stress is still the mean over one side. */
    { "exp1", "beyond.b.v", 24, 0, "fem", 0.001 }, { "exp1", "beyond.b.v", 48, 0, "fem", 0.001 },
    { "exp1", "beyond.b.u", 24, 6, "fem", 0.001 }, { "exp1", "beyond.b.sxx", 24, 6, "fem", 0.05 },
    { "exp2", "beyond.k5.u", 1, 0, "theory", 0.001 },
    { "exp2", "beyond.k5.v", 0, 1, "theory", 0.001 },
    { "exp2", "beyond.k5.u", 5, 0, "theory", 0.001 },
    { "exp2", "beyond.k5.sxx", 0, 1, "theory", 0.04 },
    { "exp2", "beyond.k5.sxx", 0, 2, "theory", 0.01 },
    /* Experiment III: rigid motion is exact but for the solver's 1e-10; 1e-8 is the promise, 1e-3
     * for the marked point. */
    { "exp3", "without.centre.u", 0, 0, NULL, 1e-8 },
    { "exp3", "rigid.centre.u", 0, 0, NULL, 1e-8 }, { "exp3", "beyond.mark.u", 0, 0, NULL, 1e-3 },
    { "exp3", "without.mark.u", 0, 0, NULL, 1e-3 }, { "exp3", "rigid.mark.u", 0, 0, NULL, 1e-3 },
    { "exp3", "gravity.mark.u", 0, 0, NULL, 1e-3 },
    /* v within the static penetration of one corner, W/(2 p_n) = 9.8e-8 m. */
    { "exp3", "without.mark.v", 0, 0, NULL, 9.81e-8 },
    { "exp3", "rigid.mark.v", 0, 0, NULL, 9.81e-8 },
    /* On the plate of 10 GPa the block rises by less than it has sunk: W over 4 m x 1 m shortens
     * 2 m of it by 4.9e-6 m. */
    { "exp3", "gravity.mark.v", 0, 0, NULL, 4.91e-6 }, { "exp3", "beyond.mark.v", 0, 0, NULL, 4.91e-6 },
};

START_TEST(an_experiment_meets_its_target)
{
    const target *t = &targets[_i];
    const row r = find_row(t->name, t->quantity, t->x, t->y, t->kind);
    const double difference = r.computed - r.reference;
    ck_assert_msg(fabs(r.error) <= t->most, "%s(%g,%g): %g, %s %g, error %.2g of %.2g", t->quantity,
                  t->x, t->y, r.computed, t->kind ? t->kind : "theory", r.reference, r.error, t->most);
    /* The column is printed with four digits. */
    ck_assert_double_eq_tol(r.error, r.reference != 0 ? difference / r.reference : difference,
                            1e-3 * fabs(r.error) + 1e-12);
}
END_TEST

/* The block starts where the plate of 10 GPa gives most. Its weight W climbs h up to the middle of
 * the first edge, 0.25 m, and stands h higher at most from there on. With F/m = 1 m/s^2, v^2 = 2 x,
 * that costs it at most the time int W h/(m v^3) dx over 2 m, 3.3 s^3/m^2 W h/m; at 2 m/s as large
 * a part of its 2 m. */
START_TEST(on_a_plate_that_gives_way_the_block_loses_what_it_climbs)
{
    static const char *const of[2][2] = { { "gravity.centre.u", "gravity.centre.v" },
                                          { "beyond.centre.u", "beyond.centre.v" } };
    const double h = find_row("exp3", of[_i][1], 0, 0, NULL).computed;
    const double lost = -find_row("exp3", of[_i][0], 0, 0, NULL).error;

    ck_assert_double_gt(lost, 0);
    ck_assert_double_le(lost, 3.3 * 9.81 * h);
}
END_TEST

START_TEST(theory_in_the_results_is_the_textbook_formula)
{
    /* Timoshenko and Goodier: v(L,0) = -P L^3/(3EI) - (4+5nu) P H^2 L/(24 EI) = -8.9 mm; Kirsch:
     * 3 s, -s at the hole. */
    ck_assert_double_eq_tol(find_row("exp1", "c.v", 48, 0, "theory").reference, -8.9e-3, 1e-15);
    ck_assert_double_eq_tol(find_row("exp2", "k5.sxx", 0, 1, "theory").reference, 3e6, 1e-3);
    ck_assert_double_eq_tol(find_row("exp2", "k5.stt", 1, 0, "theory").reference, -1e6, 1e-3);
    /* The converged finite element knows the same: two independent sources agree to its printed
     * digits. */
    for (int i = 0; i < 3; i++) {
        static const struct { const char *q; double x, y; } at[3] = {
            { "k5.u", 5, 5 }, { "k5.v", 0, 5 }, { "k5.u", 1, 0 },
        };
        const double f = find_row("exp2", at[i].q, at[i].x, at[i].y, "fem").reference;
        ck_relative(find_row("exp2", at[i].q, at[i].x, at[i].y, "theory").reference, f, 1e-8);
    }
}
END_TEST

START_TEST(every_file_of_an_experiment_is_complete)
{
    static const char *const svg[] = {
        "exp1/fig10", "exp1/fig11", "exp1/fig12", "exp1/fig13", "exp1/deformed",
        "exp2/fig15", "exp2/fig15v", "exp2/fig16", "exp2/fig16u", "exp2/fig17", "exp2/fig18",
        "exp2/fig19", "exp2/fig19hoop", "exp2/fig20", "exp2/fig21a",
        "exp2/fig21b", "exp2/fig22", "exp2/fig23", "exp3/fig25",
    };

    for (size_t i = 0; i < sizeof svg / sizeof *svg; i++) {
        char path[100], *text;
        snprintf(path, sizeof path, "out/%s.svg", svg[i]);
        text = read_all(path);
        ck_assert_msg(strstr(text, "<svg") && strstr(text, "</svg>"), "%s is cut short", path);
        ck_assert_msg(!strstr(text, "nan") && !strstr(text, "inf\""), "%s has NaN or inf", path);
        free(text);
    }
}
END_TEST

/* The second run could write neither fig15.svg nor what it prints. */
START_TEST(two_runs_write_the_same_digits)
{
    ck_assert_int_eq(shell("cd out; for f in results.csv fig15v.svg; do "
                           "cmp exp2/$f again/out/exp2/$f >&2 || exit 1; done"), 0);
}
END_TEST

START_TEST(a_picture_of_an_experiment_or_stdout_that_cannot_be_made_costs_no_results)
{
    static const char said[] = "out/again/said";

    check_text(said, "out/exp2/fig15.svg could not be written: Is a directory");
    check_text(said, "stdout: could not be written");
    check_text(said, "\nstatus 1\n");
    ck_assert_int_eq(shell("test $(wc -l < out/again/out/exp2/results.csv) = 818"), 0);
}
END_TEST

START_TEST(the_pictures_of_the_readme_are_what_the_programs_draw)
{
    static const struct { const char *shown, *drawn; int most; } picture[] = {
        { "doc/arch.svg", "out/folds/movie.svg", 200000 },
        { "doc/beam.svg", "out/exp1/deformed.svg", 400000 },
        { "doc/wedge.svg", "out/splits/movie.svg", 300000 },
    };

    ck_assert_int_ne(shell("%s/bbm -q cases/models/arch.model -d t=1 -d steps=220 -o out/folds > "
                           "out/folds.log", BUILD), 0);
    ck_assert_int_eq(shell("%s/bbm -q cases/models/wedge.model -o out/splits > out/splits.log", BUILD), 0);
    for (int k = 0; k < COUNT(picture); k++) {
        const char *shown = picture[k].shown, *drawn = picture[k].drawn;
        ck_assert_msg(shell("cmp %s %s >&2", shown, drawn) == 0, "copy %s to %s", drawn, shown);
        ck_assert_msg(shell("test $(wc -c < %s) -lt %d", shown, picture[k].most) == 0,
                      "%s is large", shown);
        check_text("README.md", shown);
    }
}
END_TEST

/* ------------------------------------------------------------------------------ the paper alone */

/* What a model with beyond/ has computed says so in its line, or stands below the heading "With
 * beyond/". All other lines of the first two experiments are those of `make paper`, blank ones apart. */
START_TEST(without_beyond_the_same_is_printed_as_the_papers_way)
{
    ck_assert_int_eq(system("cd out && awk '/^## With beyond/ { cut = 1 } /^Numbers/ { cut = 0 } "
                            "NF && !cut && !/beyond[/]/' exp1.log exp2.log > run.paper && "
                            "awk NF paper/paper.log | head -n $(wc -l < run.paper) | "
                            "diff - run.paper >&2"), 0);
    ck_assert_int_eq(system("[ $(grep -c '^|' out/run.paper) -gt 90 ]"), 0);
}
END_TEST

START_TEST(without_beyond_the_same_files_are_written)
{
    ck_assert_int_eq(system("cd out/paper/out && [ $(ls exp?/* | wc -l) = 20 ] && "
                            "for f in exp?/*; do { [ ${f#*/} = results.csv ] && "
                            "grep -v '^beyond[.]' ../../$f || cat ../../$f; } | "
                            "cmp $f - || exit 1; done >&2"), 0);
}
END_TEST

START_TEST(without_beyond_the_formulas_are_tested)
{
    check_text("out/paper/paper.log", "suite(s): formulas\n100%: Checks: ");
}
END_TEST

/* What stands in a header before ( ; , } or = and begins with bbm_ or BBM_ is declared there. */
START_TEST(the_core_names_nothing_of_what_stands_beside_it)
{
    ck_assert_int_eq(system("sed 's|/[*].*||' beyond/*.h | "
                            "grep -oE 'bbm_[a-z_0-9]+[(;,]|BBM_[A-Z_0-9]+ *([,}=]|$)' | "
                            "tr -d '(;,}= ' | sort -u > out/beside; "
                            "[ $(wc -l < out/beside) -gt 30 ]"), 0);
    ck_assert_int_eq(shell("exec >&2; set -- bbm.h bbm.c contact.c solver.c base/*.h base/*.c; "
                           "grep -nwFf out/beside $* || grep -n beyond/ $*"), 1);
}
END_TEST

/* Where there is a compiler for C++, a program in it builds, runs and reads a model. */
START_TEST(a_program_in_cplusplus_links_with_the_library)
{
    ck_assert_int_eq(shell("command -v g++ > /dev/null || exit 0; echo '#include \"bbm.h\"\n"
        "int main() { bbm_model *m; bbm_material a = { 1e9, 0, 1, 1 }; int at[] = { 0, 1, 2 };\n"
        "bbm_model_new(&m); bbm_add_material(m, &a, 0); for (int k = 0; k < 3; k++) {\n"
        "bbm_add_node(m, k == 1, k == 2, 0); bbm_fix_node(m, k, BBM_XY, 0, 0); }\n"
        "bbm_add_element(m, 0, 0, 3, at, 0); int s = bbm_prepare(m) || bbm_run(m);\n"
        "bbm_model_free(m); return s; }' > out/plus.cc && g++ -I. -o out/plus out/plus.cc "
        "%s/bbm.o %s/contact.o %s/solver.o %s/base/*.o -lm && out/plus", BUILD, BUILD, BUILD, BUILD), 0);
}
END_TEST

/* --------------------------------------------------------------------------------- the programs */

/* `make check` has run the experiments; without it this does. */
static void run_experiments(void)
{
    if (!getenv("MAKELEVEL"))
        ck_assert_int_eq(system("make -s experiments O=" BUILD), 0);
    ck_assert_int_eq(system("cd out && cat exp1.log exp2.log exp3.log > run.log"), 0);
}

Suite *cases_suite(void)
{
    Suite *s = suite_create("cases");
    TCase *t = new_case(s, "experiments");

    tcase_set_tags(t, "experiments");
    tcase_add_unchecked_fixture(t, run_experiments, NULL);
    tcase_add_loop_test(t, an_experiment_meets_its_target, 0, COUNT(targets));
    tcase_add_loop_test(t, on_a_plate_that_gives_way_the_block_loses_what_it_climbs, 0, 2);
    tcase_add_test(t, theory_in_the_results_is_the_textbook_formula);
    tcase_add_test(t, every_file_of_an_experiment_is_complete);
    tcase_add_test(t, two_runs_write_the_same_digits);
    tcase_add_test(t, a_picture_of_an_experiment_or_stdout_that_cannot_be_made_costs_no_results);
    tcase_add_test(t, the_pictures_of_the_readme_are_what_the_programs_draw);
    tcase_add_test(t, without_beyond_the_same_is_printed_as_the_papers_way);
    tcase_add_test(t, without_beyond_the_same_files_are_written);
    tcase_add_test(t, without_beyond_the_formulas_are_tested);
    tcase_add_test(t, the_core_names_nothing_of_what_stands_beside_it);
    tcase_add_test(t, a_program_in_cplusplus_links_with_the_library);
    return s;
}
