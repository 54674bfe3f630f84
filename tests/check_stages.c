/* check_stages.c - stages of model files: what each one keeps of the last, and what it takes away. */
#define _POSIX_C_SOURCE 200809L
#include <math.h>
#include <stdio.h>

#include "programs.h"

/* A block is taken away, and the corner of the one beside it stays on the seam of two flush blocks below, by rounding on this
 * side or that: another stage, in which nothing happens, changes no force. */
START_TEST(an_empty_stage_changes_no_force)
{
    for (int k = 0; k < 2; k++)
        ck_assert_int_eq(run_printed(k ? "more" : "once",
                                     "material m E 1e11 nu 0.2 density 2000\nblock base m -1 -1 4 -1 4 0 -1 0\n"
                                     "block A m 0 0 1 0 1 .7 0 .7\nblock B m 1 0 2.2 0 2.2 .7 1 .7\n"
                                     "block C m 0 .7 1 .7 1 1.4 0 1.4\nblock D m 1 .7 1.75 .7 1.75 1.4 1 1.4\n"
                                     "block T m 0 1.4 2 1.4 2 2 0 2\nfixblock base\ngravity -1 -9.81\n"
                                     "contact friction 20 cohesion 1e6 tension 1e6\nstatic\nstage s1 remove D\nend\n%s",
                                     k ? "stage empty\nend\n" : ""), 0);
    for (int k = 0; k < 2; k++)                 /* of some 10 kN */
        ck_near(sum("more", "contacts.csv", k ? "normal" : "shear", "^C,B"),
                sum("once", "contacts.csv", k ? "normal" : "shear", "^C,B"), 1e4, 1e-6);
}
END_TEST

/* Three blocks on a rigid one, each with the weight w; then the top one is gone. */
#define COLUMN "material rigid E 1e18 nu 0 density 2000\nmaterial rock E 1e12 nu 0 density 2000\n" \
    "block base rigid -1 -1 2 -1 2 0 -1 0\nblock a rock 0 0 1 0 1 1 0 1\n" \
    "block b rock 0 1 1 1 1 2 0 2\nblock c rock 0 2 1 2 1 3 0 3\nfixblock base\n" \
    "contact kn 1e14 friction 30\ngravity 0 -10\nmonitor top at 0 2 of b\n"

static const char *const solved[] = { "static\n", "dynamic dt 0.01 steps 60 velocity_factor 0\n" };

START_TEST(a_column_springs_back_when_its_top_is_removed)
{
    const double w = 20000, E = 1e12, kn = 1e14;
    const char *first = _i ? "reactions_000060.csv" : "reactions_000001.csv";

    ck_assert_int_eq(run_printed("stage",
        COLUMN "monitor on joint b c\n%sstage off remove c\nend\n", solved[_i]), 0);
    ck_relative(sum("stage", first, "fy", ""), 6 * w, 1e-6);      /* the base weighs three */
    ck_relative(sum("stage", "reactions.csv", "fy", ""), 5 * w, 1e-6);
    ck_relative(cell("stage", "history.csv", _i ? "60," : "1,", "on_normal"), w, 1e-6);
    ck_assert(cell("stage", "history.csv", "", "on_normal") == 0);
    /* two blocks of 1 m and two joints of two contacts carry w less; strains are 1e-7 */
    const double rebound = cell("stage", "history.csv", "", "top_v")
                         - cell("stage", "history.csv", _i ? "60," : "1,", "top_v");
    ck_relative(rebound, 2 * w / E + 2 * w / (2 * kn), 1e-6);
    ck_assert_int_eq(shell("! grep -q ,c, out/model/stage/nodes.csv && grep -q ,c, out/model/stage/"
                           "nodes_0000%s.csv", _i ? "60" : "01"), 0);
    ck_assert_double_le(cell("stage", "summary.csv", "", "gained"), 1e-12);
}
END_TEST

/* Sums of its weight's shares would be rounding, and forces that nothing balances. */
START_TEST(what_is_removed_has_no_weight_whatever_its_size)
{
    for (int k = 0; k < 10; k++) {
        char text[600];
        const double high = 1.8 + 0.0371 * k;
        snprintf(text, sizeof text, "material rock E 1e10 nu 0.2 density 2500\nblock floor rock -3 -1 6 -1 6 0 -3 0\n"
                 "block a rock 0 0 0.7 0 0.7 1.3 0 1.3\nblock b rock 0.2 1.3 0.7 1.3 0.7 %g 0.2 %g\n"
                 "fixblock floor\ngravity 0 -9.81\ncontact friction 45\nstatic\nstage s1 remove b\nend\n", high, high);
        ck_assert_int_eq(run_text("gone", text), 0);
        ck_relative(sum("gone", "reactions.csv", "fy", ""), (9 + 0.7 * 1.3) * 2500 * 9.81, 1e-9);
    }
}
END_TEST

/* The run has 10 steps, its stage 40, in which the block goes 40 mm: half of that in half of them. */
START_TEST(a_support_of_a_stage_takes_the_whole_stage_for_its_way)
{
    ck_assert_int_eq(run_text("ramped", "material r E 5e9 nu .2 density 2500\nblock s r 0 0 1 0 1 1 0 1\nfix set s\n"
        "dynamic dt 0.005 steps 10\nmonitor s set s\nstage on steps 40\n  fix set s x by 0.04\nend\n"), 0);
    ck_near(cell("ramped", "history.csv", "30,", "s_u"), 0.02, 0.04, 1e-9);
    ck_near(cell("ramped", "history.csv", "50,", "s_u"), 0.04, 0.04, 1e-9);
}
END_TEST

START_TEST(an_arch_stands_without_its_formwork_to_its_limit)
{
    static const struct { const char *t; int status; } arch[] = { { "1.5", 0 }, { "1.1", 0 },
                                                                  { "1", 3 } };

    /* one wedge below each voussoir; theory has the limit at 1.061 */
    ck_assert_int_eq(shell("{ sed 's/^dynamic.*/dynamic dt 0.01 steps 10 settle 100/; s/^end$/block "
        "f$i rigid 0 0 $(ri*cos(a)) $(ri*sin(a)) $(ri*cos(b)) $(ri*sin(b))\\nfixblock f$i\\nend/' "
        "cases/models/arch.model; echo 'stage strike steps 300 remove '$(seq -f f%%g 15); echo end; "
        "} > out/model/strike.model"), 0);
    ck_assert_int_eq(shell("%s/bbm -q out/model/strike.model -d t=%s -o out/model/strike > "
                           "out/model/said", BUILD, arch[_i].t), arch[_i].status);
}
END_TEST

/* At 25 degrees a block rests by a friction of 30 and slides by 20, s = g/2 (sin a - tan 20 cos a)
 * t^2. A step more or less is 2/300 of it. */
START_TEST(a_block_slides_from_where_it_was_when_friction_falls)
{
    const double a = acos(-1) * 25 / 180, t = 0.6;

    ck_assert_int_eq(run_text("soften", "let a 25\nmaterial rigid E 1e14 nu 0.25 density 2500\n"
        "material rock E 1e10 nu 0 density 2500\nlet c $(cos(a))\nlet s $(sin(a))\n"
        "block slope rigid 0 0 $(40*c) 0 $(40*c) $(40*s)\nfixblock slope\n"
        "block stone rock $(30*c) $(30*s) $(32*c) $(32*s) $(32*c - s) $(32*s + c) $(30*c - s) "
        "$(30*s + c)\ngravity 0 -10\ndynamic dt 0.002 steps 100 settle 20\n"
        "monitor s at $(30*c) $(30*s) of stone\nstage soften steps 300\ncontact friction 20\nend\n"
        "contact friction 30\n"), 0);
    ck_assert_double_le(fabs(cell("soften", "history.csv", "100,", "s_u")), 1e-6);
    ck_relative(cell("soften", "history.csv", "", "s_u"),
                -5 * t * t * cos(a) * (sin(a) - tan(acos(-1) / 9) * cos(a)), 1e-5);
}
END_TEST

START_TEST(each_stage_is_said_when_it_begins_and_by_a_check)
{
    write_text("out/model/said.model", COLUMN "dynamic dt 0.01 steps 3\nstage off remove c\nend\n"
               "stage on steps 2\nend\nbolt at 0.5 0.5 of a at 0.5 2.5 of c stiffness 1e6\n");
    for (int k = 0; k < 2; k++) {
        ck_assert_int_eq(shell("%s/bbm out/model/said.model %s -o out/model/stages > out/model/stages.said",
                               BUILD, k ? "--check" : ""), 0);
        check_text("out/model/stages.said", "\nstage off: after step 3, t = 0.03 s, to step 6\n");
        check_text("out/model/stages.said", "\nstage on: after step 6, t = 0.06 s, to step 8\n");
    }
    check_text("out/model/stages/bolts.csv", "\n1,a,c,0,REMOVED\n");
}
END_TEST

/* The contacts of what is removed end before a step that then fails: nothing holds e. */
START_TEST(a_stage_that_fails_at_once_has_whole_files_of_contacts)
{
    ck_assert_int_eq(run_text("falls", COLUMN "block d rock 1.2 0 1.8 0 1.8 1 1.2 1\n"
                              "block e rock 1.2 1 1.8 1 1.8 2 1.2 2\nstatic\noutput vtk\nstage off remove d\nend\n"), 1);
    ck_assert_int_eq(shell("cd out/model/falls && n=$(sed -n 's/^POINT_DATA //p' contacts_000001.vtk) && "
                           "test $n = $(sed 1d contacts.csv | wc -l) && test $n = "
                           "$(sed '1,/^POINTS/d; /^VERTICES/,$d' contacts_000001.vtk | wc -l)"), 0);
}
END_TEST

static const char *const bad_stages[][2] = {
    { "stage x\n", ":11: stage without its `end`" },
    { "stage x remove q\nend\n", ":11: unknown block 'q'" },
    { "stage x\nstatic\nend\n", ":12: static in a stage, expected load" },
    { "stage x remove c\nend\nstage y remove c\nend\n", ":13: block 'c' is removed for the second" },
    { "stage x remove c\nload set c 1 0\nend\n", ":12: no node there of block c" },
    { "stage x remove b\nend\n", ":11: monitor 'top' is on block 'b'" },
    { "stage x\nstage y\nend\nend\n", ":12: a stage in a stage" },
    { "stage x\ncontact ks 1\nend\n", ":12: kn, ks, restitution or round in a stage" },
    { "bolt at 0.5 0.5 at 0.5 2.5 stiffness 1e16\n", ":11: stiffness is 1e+16, expected 1e-100 to 1e15" },
};

START_TEST(a_wrong_stage_is_refused_before_anything_runs)
{
    ck_assert_int_eq(run_printed("wrong", COLUMN "%sstatic\n", bad_stages[_i][0]), 2);
    check_text("out/model/wrong.err", bad_stages[_i][1]);
    ck_assert_int_eq(shell("test ! -e out/model/wrong"), 0);
}
END_TEST

START_TEST(what_touched_nothing_goes_unnoticed)
{
    for (int k = 0; k < 2; k++)
        ck_assert_int_eq(run_printed(k ? "gone" : "there",
            COLUMN "grid far rock 9 20 10 21 2 2\nvelocity far 0 0\n"
            "dynamic dt 0.01 steps 20\nstage none%s\nend\n", k ? " remove far" : ""), 0);
    ck_assert_int_eq(shell("cd out/model && cmp gone/history.csv there/history.csv && grep -v ,far, "
                           "there/nodes.csv | cmp - gone/nodes.csv"), 0);
}
END_TEST

Suite *stages_suite(void)
{
    Suite *s = suite_create("stages");
    TCase *t = new_case(s, "stages");

    tcase_add_test(t, what_touched_nothing_goes_unnoticed);
    tcase_add_test(t, an_empty_stage_changes_no_force);
    tcase_add_loop_test(t, a_column_springs_back_when_its_top_is_removed, 0, 2);
    tcase_add_test(t, what_is_removed_has_no_weight_whatever_its_size);
    tcase_add_test(t, a_support_of_a_stage_takes_the_whole_stage_for_its_way);
    tcase_add_loop_test(t, an_arch_stands_without_its_formwork_to_its_limit, 0, 3);
    tcase_add_test(t, a_block_slides_from_where_it_was_when_friction_falls);
    tcase_add_test(t, each_stage_is_said_when_it_begins_and_by_a_check);
    tcase_add_test(t, a_stage_that_fails_at_once_has_whole_files_of_contacts);
    tcase_add_loop_test(t, a_wrong_stage_is_refused_before_anything_runs, 0, COUNT(bad_stages));
    return s;
}
