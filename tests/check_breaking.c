/* check_breaking.c - joints, bonds and bodies that break in model files: when, in which order, and what is left. */
#define _POSIX_C_SOURCE 200809L
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "programs.h"

#define NEVER "joint * * tension 40e3\njoint roof lump tension 60e3\n"

/* A lump of 49 kN hangs from 1 m^2 of a joint; 60 kPa hold it, 40 kPa do not. The first joint that
 * fits counts. */
START_TEST(a_joint_holds_by_its_own_tensile_strength)
{
    static const struct { const char *joints; int status; } table[] = {
        { "joint roof lump tension 60e3\njoint * * tension 40e3\n", 0 },
        { NEVER, 3 },
        { "contact tension 60e3\n", 0 }, { "contact tension 40e3\n", 3 },
        { "contact tension 60e3\njoint lump roof friction 20\n", 0 },
        { "contact tension 60e3\njoint lump * tension 0\n", 3 },
    };

    ck_assert_int_eq(run_printed("hangs",
        ROCK "block roof rock 0 2 3 2 3 3 0 3\nblock lump rock 1 0 2 0 2 2 1 2\nfixblock roof\n%s"
        "gravity 0 -9.81\ndynamic dt 0.001 steps 200 settle 100\nmonitor lump at 1 0\n"
        "expect lump stays by 1e-3\n", table[_i].joints), table[_i].status);
    if (strcmp(table[_i].joints, NEVER) == 0)
        ck_assert_str_eq(slurp("out/model/hangs.err"), "out/model/hangs.model:6: warning: "
                         "this joint never counts, below one that fits the same blocks\n");
}
END_TEST

/* A wall is glued to a block with 400 kN. A belt starts below the block, or the wall moves. With the floor still locked
 * its springs would take more than that, but it lets go at its friction, or at the 2 kN of its own glue, and the wall's
 * glue bears no more than this asks. */
START_TEST(glue_holds_where_the_floor_lets_go_first)
{
    static const char *const floors[] = { "", "joint b belt tension 1e3 cohesion 1e3\n" }, *const moves[] = {
        "ks 1e8 friction 16.1\nfix set belt x by 0.2\ndynamic dt 0.01 steps 200 settle 50\n",
        "ks 4e8 friction 16.1\nfix set belt x by 0.2\ndynamic dt 0.01 steps 200 settle 50\n",
        "ks 4e8 friction 16.1\nfix set w x by -0.01\ndynamic dt 0.05 steps 10 velocity_factor 0 settle 20\n",
    };
    const int move = _i / 2;

    ck_assert_int_eq(run_printed("glued", "material r E 1e13 nu 0 density 2000\nblock belt r -50 -1 50 -1 50 0 -50 0\n"
        "block w r -1 0.05 0 0.05 0 0.45 -1 0.45\nblock b r 0 0 2 0 2 0.5 0 0.5\nfixblock belt\nfixblock w\n"
        "joint w b tension 1e6 cohesion 1e7\n%sgravity 0 -10\nmonitor b at 2 0.5 of b\nmonitor j joint w b\n"
        "contact kn 1e9 %s", floors[_i % 2], moves[move]), 0);
    ck_near(cell("glued", "history.csv", "", "b_u"), move < 2 ? 0 : -0.01, 0.02, 1e-3);
    if (move < 2)                               /* to 1e-3: the belt turns and gives way a little */
        ck_relative(-cell("glued", "history.csv", "", "j_normal"),
                    tan(16.1 * acos(-1) / 180) * (20000 - cell("glued", "history.csv", "", "j_shear")), 1e-3);
}
END_TEST

/* A roof rises with a block that is glued to it by 400 kN and to the floor by 2 kN: the floor lets go. */
START_TEST(what_is_lifted_comes_off_where_it_is_held_least)
{
    ck_assert_int_eq(run_printed("glued", "material r E 1e13 nu 0 density 2000\nblock floor r -5 -1 5 -1 5 0 -5 0\n"
        "block roof r 0 0.5 2 0.5 2 1 0 1\nblock b r 0 0 2 0 2 0.5 0 0.5\nfixblock floor\nfixblock roof\n"
        "joint roof b tension 2e5 cohesion 1e7\njoint b floor tension 1e3 cohesion 1e7\ngravity 0 -10\nmonitor b set b\n"
        "contact kn 1e9 friction 20\nfix set roof y by 0.01\ndynamic dt 0.05 steps 10 velocity_factor 0 settle 20\n"), 0);
    ck_near(cell("glued", "history.csv", "", "b_v"), 0.01 - 21600 / 2e9, 0.01, 1e-3);    /* weight, 1.6 kN of inertia */
}
END_TEST

/* A joint of 10 m in 40 pieces is torn off in shear by a push of 2 MN. In steps of 0.1 ms it has gone 0.3703 m after 0.1 s;
 * in longer ones it falls short of that by 1.1, 2.7 and 2.8 %. If all pieces that bear too much broke at once, it would
 * by 19 % in the longest ones. */
START_TEST(a_long_joint_tears_from_where_it_bears_most)
{
    static const double dt[] = { 5e-4, 2e-3, 1e-2 }, off[] = { 0.013, 0.03, 0.03 };

    ck_assert_int_eq(run_printed("torn", "material r E 1e10 nu 0.2 density 2500\nblock base r -5 -2 15 -2 15 0 -5 0\n"
        "grid b r 0 0 10 1 40 2\nfixblock base\njoint b base tension 1e5 cohesion 2e5 friction 30\ngravity 0 -10\n"
        "contact kn 1e10 friction 30\npressure set b.left 2e6\ndynamic dt %g steps %g\nmonitor b set b\n",
        dt[_i], 0.1 / dt[_i]), 0);
    ck_relative(cell("torn", "history.csv", "", "b_u"), 0.3703, off[_i]);
}
END_TEST

/* A joint of 80 pieces is pulled straight off by 4 MN; its pieces bear nearly the same. Then its block, of 25 t, goes up
 * with what its weight leaves: a t^2/2, to 1e-3, for a bonded block sways. */
START_TEST(a_long_joint_that_bears_alike_comes_off_at_once)
{
    ck_assert_int_eq(run_printed("torn", "material r E 1e10 nu 0.2 density 2500\nblock base r -5 -2 15 -2 15 0 -5 0\n"
        "grid b r 0 0 10 1 80 2\nfixblock base\njoint b base tension 1e5 cohesion 2e5 friction 30\ngravity 0 -10\n"
        "contact kn 1e10 friction 30\ntraction set b.top 0 4e5\ndynamic dt 1e-3 steps 50\nmonitor b set b\n"), 0);
    ck_relative(cell("torn", "history.csv", "", "b_v"), (4e6 / 25e3 - 10) * 0.05 * 0.05 / 2, 1e-3);
}
END_TEST

/* A block is pulled along by 8 kN; its joint holds 10 kPa and 10 kN tan(10), and then 1 kPa and that, or no friction. */
START_TEST(a_stage_changes_what_a_joint_takes_from_contact)
{
    const struct { const char *contact, *joint, *stage; int status; } table[] = {
        { "friction 10 cohesion 1e4", "joint f s friction 10", "cohesion 1e3", 1 },
        { "friction 10 cohesion 1e4", "joint f s cohesion 7e3", "cohesion 1e3", 0 },
        { "friction 10 cohesion 1e4", "joint * s cohesion 7e3", "friction 1", 1 },
        { "friction 10 cohesion 1e4", "", "cohesion 1e3", 1 },
    };

    ck_assert_int_eq(run_printed("weaker", "material r E 1e10 nu 0 density 2500\nmaterial R E 1e13 nu 0 density 2500\n"
        "block f R -2 -1 3 -1 3 0 -2 0\nblock s r 0 0 1 0 1 1 0 1\nfixblock f\ncontact kn 1e8 %s\n%s\n"
        "load at 0 0 of s 4e3 -5e3\nload at 1 0 of s 4e3 -5e3\nstatic\nstage weaker\n  contact %s\nend\n",
        table[_i].contact, table[_i].joint, table[_i].stage), table[_i].status);
}
END_TEST

/* A joint that loses its cohesion point by point says so where it gives way. */
START_TEST(a_joint_that_breaks_says_how)
{
    ck_assert_int_eq(shell("%s/bbm -q doc/shear.model -d s=1.5e5 -o out/model/shear > out/model/said 2>&1", BUILD), 1);
    ck_assert(strstr(slurp("out/model/said"), "slides on block 'base' (element 1), and goes on; a joint breaks point by point"));
}
END_TEST

/* A weak stone shatters on a floor, and the tips of two of its fragments pass each other while a crack that softens slides.
 * No corner of either lies in the other, and from then on they go through each other, which is told. Nothing is told of a
 * stone that stays whole, of fragments that overlap by 0.2 mm, and of one that soft contacts let sink into the floor. */
START_TEST(fragments_that_have_passed_into_each_other_are_told)
{
    static const char *const ways[] = {
        "bond tension 1e5 cohesion 3e5 friction 35 energy 15\nvelocity s 2 -12 0\ncontact friction 10\ndynamic dt 5e-4 steps 60\n",
        "bond tension 1e9 cohesion 3e9 friction 35 energy 15\nvelocity s 2 -12 0\ncontact friction 10\ndynamic dt 5e-4 steps 60\n",
        "bond tension 1e5 cohesion 3e5 friction 35 energy 15\nvelocity s 2 -5 0\ncontact friction 10\ndynamic dt 3e-4 steps 60\n",
        "bond tension 1e3 cohesion 3e4 friction 35\nvelocity s 0 -3 0\ndynamic dt 5e-4 steps 20\ncontact friction 10 kn 3e6\n",
    };

    ck_assert_int_eq(run_printed("passed", "material r E 1e10 nu 0.2 density 2500\nmaterial hard E 5e10 nu 0.2 density 2500\n"
        "node 1 0 0.002\nnode 2 0.3939 0.0715\nnode 3 0.7878 0.1409\n"
        "node 4 -0.0695 0.3959\nnode 5 0.3245 0.4654\nnode 6 0.7184 0.5348\nnode 7 -0.1389 0.7898\nnode 8 0.255 0.8593\n"
        "node 9 0.6489 0.9288\nelement 1 s r 1 2 4\nelement 2 s r 2 5 4\nelement 3 s r 2 3 6\nelement 4 s r 2 6 5\n"
        "element 5 s r 4 5 8\nelement 6 s r 4 8 7\nelement 7 s r 5 6 8\nelement 8 s r 6 9 8\n"
        "block floor hard -30 -1 30 -1 30 0 -30 0\nfixblock floor\ngravity 0 -9.81\n%s", ways[_i]), 0);
    ck_assert_int_eq(strchr(slurp("out/model/passed/cracks.csv"), '1') != NULL, _i != 1);
    if (_i == 0)
        check_text("out/model/passed.err", "elements '5' and '7' are 0.0");
    else
        ck_assert_str_eq(slurp("out/model/passed.err"), "");
}
END_TEST

/* The core of the disc is a block of its own, and the solver has too few iterations. Steps from rest list more gaps than
 * there were; when they fail, too, all is put back where it was, and the run ends with its message. */
START_TEST(a_search_for_an_equilibrium_that_fails_puts_back_what_it_took)
{
    ck_assert_int_eq(shell("sed 's/element $k disc/element $k core/; s/^bond .*/&\\npcg iterations 50/' "
                           "cases/models/brazil.model > out/model/core.model"), 0);
    ck_assert_int_eq(shell(BUILD "/bbm -q out/model/core.model -o out/model/core 2> out/model/core.err"), 1);
    check_text("out/model/core.err", "neither an equilibrium nor a block that falls was found");
}
END_TEST

/* A bar of six cells hangs from one end and falls at 5 m/s: in the first step its bonds bear hundreds of times their
 * strength, most at that end. The first one there breaks, by tension, and the others hold. */
START_TEST(of_bonds_that_bear_far_too_much_the_one_that_bears_most_breaks)
{
    static const char *const ways[] = { "grid b r 0 0 1 6 1 6\nfix set b.top\nvelocity b 0 -5 0\ngravity 0 -9.81\n",
                                        "grid b r 0 0 6 1 6 1\nfix set b.left\nvelocity b 5 0 0\ngravity 9.81 0\n" };

    ck_assert_int_eq(run_printed("column", "material r E 1e10 nu 0 density 2500\nbond tension 1e5 cohesion 3e5 friction 35\n"
        "%sdynamic dt 0.01 steps 3\n", ways[_i]), 0);
    ck_assert_str_eq(slurp("out/model/column/cracks.csv"),
                     _i ? "step,bond,x,y,mode\n1,1,1,0.5,TENSION\n" : "step,bond,x,y,mode\n1,5,0.5,5,TENSION\n");
}
END_TEST

/* A bar is pulled against a wall 1 mm away, in one step. Its own bonds would bear 4 MPa; but the wall lets it stretch by 1 mm
 * of 4 m alone, and it bears 0.25 MPa. No bond breaks before the wall is in the list of contacts. */
START_TEST(a_bond_holds_where_a_contact_that_closes_in_the_step_bears_the_load)
{
    static const char *const ways[] = { "static", "static steps 3", "dynamic dt 1 steps 3 velocity_factor 0",
                                        "dynamic dt 0.01 steps 5" };

    ck_assert_int_eq(run_printed("wall", "material r E 1e9 nu 0 density 2500\ngrid b r 0 0 4 1 4 1\nfix set b.left\n"
        "block w r 4.001 -1 5 -1 5 2 4.001 2\nfixblock w\nload set b.right 4e6 0\nbond tension 1e6 cohesion 1e7\n"
        "contact friction 30 kn 1e12\n%s\n", ways[_i]), 0);
    ck_assert_str_eq(slurp("out/model/wall/cracks.csv"), "step,bond,x,y,mode\n");
}
END_TEST

/* A bond is pulled open in one static step, far beyond what it bears. Its cohesion is so low that shear breaks it, so that its
 * ends push at first and open in the next pass. It ends on the line of the same tooth, from the origin, as in twenty steps;
 * 1e-6: the solver's. */
START_TEST(a_static_step_far_beyond_its_strength_leaves_a_bond_no_stronger)
{
    double force[2];

    for (int k = 0; k < 2; k++) {
        ck_assert_int_eq(run_printed("far", "material r E 1e11 nu 0.2 density 2500\ngrid b r 0 0 2 1 2 1\nbond tension 1e6 "
            "cohesion 3e5 friction 30 energy 1e4\nfix set b.left x\nfix at 0 0 y\nfix at 2 0 y\n"
            "fix set b.right x by 3e-4\nmonitor s support set b.right\nstatic steps %d\n", k ? 20 : 1), 0);
        force[k] = cell("far", "history.csv", k ? "20," : "1,", "s_fx");
    }
    ck_assert_double_gt(force[0], 1e5);
    ck_relative(force[0], force[1], 1e-6);
}
END_TEST

/* A quadrilateral without bonds does not bend, and both its feet are held, whatever bonds may bear. */
START_TEST(strength_of_bonds_changes_nothing_where_there_is_none)
{
    for (int k = 0; k < 2; k++)
        ck_assert_int_eq(run_printed(k ? "strong" : "plain", "material rock E 1e9 nu 0.2 density 2500\n"
            "block a rock 0 0 1 0 1 1 0 1\nfix at 0 0\nfix at 1 0\nload at 0 1 0 -1e5\nload at 1 1 0 -1e5\n%sstatic\n"
            "monitor foot at 1 0\nmonitor top at 0 1\n", k ? "bond tension 1e9 cohesion 1e9\n" : ""), 0);
    ck_relative(cell("strong", "history.csv", "", "top_v"), cell("plain", "history.csv", "", "top_v"), 1e-12);
    ck_near(cell("strong", "history.csv", "", "foot_u"), cell("plain", "history.csv", "", "foot_u"), 1e-4, 1e-9);
}
END_TEST

/* A cantilever of two quadrilaterals breaks off in the first steps. Its other half, whose side is held, has no bond left then, and
 * is held as before. */
START_TEST(a_held_quadrilateral_that_loses_its_last_bond_makes_no_energy)
{
    ck_assert_int_eq(run_text("torn", "material a E 1e9 nu 0.2 density 2000\ngrid q a 0 0 2 1 2 1\nfix set q.left\n"
        "bond tension 1e3 cohesion 3e3\ngravity 0 -9.81\ndynamic dt 0.001 steps 100\nmonitor tip at 2 0\n"), 0);
    ck_relative(cell("torn", "history.csv", "", "tip_v"), -9.81 * 0.1 * 0.1 / 2, 0.01);    /* it leaves with some velocity */
}
END_TEST

/* Two layers, turned, are pulled along their only joint by three times its strength: nothing is across it. */
START_TEST(a_bond_along_the_tension_holds)
{
    char text[1000];

    snprintf(text, sizeof text, "let a %d\nlet c $(cos(a))\nlet s $(sin(a))\nmaterial rock E 1e10 nu 0 density 2500\n"
        "node 1 0 0\nnode 2 $(4*c) $(4*s)\nnode 3 $(-s/2) $(c/2)\nnode 4 $(4*c-s/2) $(4*s+c/2)\nnode 5 $(-s) $c\n"
        "node 6 $(4*c-s) $(4*s+c)\nelement 1 bar rock 1 2 4 3\nelement 2 bar rock 3 4 6 5\nset l nodes 1 3 5\n"
        "set r nodes 2 4 6\ntraction set r $(3e6*c) $(3e6*s)\ntraction set l $(-3e6*c) $(-3e6*s)\nfix at 0 0\n"
        "fix at $(-s) $c\nbond tension 1e6 cohesion 1e7\nstatic\n", 10 * _i);
    ck_assert_int_eq(run_text("along", text), 0);
    check_text("out/model/along/cracks.csv", "step,bond,x,y,mode\n");
    ck_assert_ptr_null(strstr(slurp("out/model/along/cracks.csv"), "TENSION"));
}
END_TEST

/* A bar of two cells on a floor, that is pulled apart by more than friction holds: its bond bears 25.5 kPa. Statics finds
 * that equilibrium in steps from rest, which break nothing. It is one if the bond is as strong as that. */
START_TEST(an_equilibrium_in_which_a_bond_bears_too_much_is_none)
{
    ck_assert_int_eq(run_printed("bar", "material rock E 1e9 nu 0.2 density 2500\nblock g rock -6 -1 6 -1 6 0 -6 0\n"
        "fixblock g\ngrid a rock -2 0 2 1 2 1 quads\ncontact friction 10\ngravity 0 -9.81\ntraction set a.left -3e4 0\n"
        "traction set a.right 3e4 0\nbond tension %s cohesion 1e6 friction 30\nstatic\n", _i ? "1e3" : "3e4"), _i);
    ck_assert_int_eq(strstr(slurp("out/model/bar.err"), "try dynamics") != NULL, _i);
}
END_TEST

/* Two squares are torn apart without velocities, at odd angles: then each step takes 2 M/dt^2 times the
 * way of the one that is pulled, half of it at each node. The other one bears nothing, and no step is cut. */
START_TEST(what_is_torn_off_costs_its_drag_alone)
{
    ck_assert_int_eq(run_text("torn", "material rock E 1e9 nu 0 density 2500\nlet c $(cos(20))\nlet s $(sin(20))\n"
        "block l rock 0 0 $c $s $(c-s) $(s+c) $(-s) $c\n"
        "block b rock $c $s $(2*c) $(2*s) $(2*c-s) $(2*s+c) $(c-s) $(s+c)\nbond l b\n"
        "bond tension 1e6 cohesion 1e8 energy 1000\nfix at 0 0\nfix at $(-s) $c\n"
        "fix at $(2*c) $(2*s) x by $(0.012*c) y by $(0.012*s)\n"
        "fix at $(2*c-s) $(2*s+c) x by $(0.012*c) y by $(0.012*s)\n"
        "dynamic dt 0.02 steps 100 velocity_factor 0\nmonitor e support at $(2*c) $(2*s)\n"), 0);
    ck_relative(hypot(cell("torn", "history.csv", "", "e_fx"), cell("torn", "history.csv", "", "e_fy")),
                2500 * 0.012 / 100 / (0.02 * 0.02), 1e-6);
    ck_assert_double_lt(sum("torn", "summary.csv", "open_close", ""), 150);
}
END_TEST

#define GLUED(pull) ROCK "grid base rock 0 -1 2 0 2 1\ngrid bar rock 0 0 2 3 2 1\nbond base bar\n" \
    "bond tension 1e6 cohesion 1e7\nfix set base.bottom\ntraction set bar.top 0 " pull "\nstatic\n"

/* A bar is bonded to a base whose bottom is fixed, and pulled by a hundredth less and more than the bonds hold. */
START_TEST(a_block_that_breaks_off_another_one_is_named)
{
    const int falls = run_text("glued", _i == 0 ? GLUED("0.99e6") : GLUED("1.01e6"));

    ck_assert_int_eq(falls, _i);
    if (falls)
        ck_assert_msg(strstr(slurp("out/model/glued.err"), "block 'bar' breaks through, and no support holds its piece"),
                      "%s", slurp("out/model/glued.err"));
}
END_TEST

/* It leaves no spring of a crack behind: what stays is at rest, and would be given energy. */
START_TEST(a_block_with_cracks_can_be_removed)
{
    ck_assert_int_eq(shell("{ sed '/^monitor/d; /^expect/d' cases/models/wedge.model; echo 'stage off steps 5 remove "
                           "stone'; echo end; } | %s/bbm -q - -d G=20 -d steps=10 -o out/model/removed", BUILD), 0);
}
END_TEST

/* A bar of two squares is pulled apart by 1 mm: both nodes of its middle have two rows. */
START_TEST(each_side_of_a_crack_has_its_own_nodes)
{
    ck_assert_int_eq(run_printed("sides", "material rock E 1e10 nu 0 density 2500\n"
        "bond tension 1e6 cohesion 3e6\ngrid bar rock 0 0 2 1 2 1\nfix set bar.left x y\n"
        "fix set bar.right y\nfix set bar.right x by 1e-3\nstatic\n"), 0);
    ck_assert_int_eq(shell("test \"$(awk -F, '$3 == 1 { printf \"%%.6f \", sqrt($5^2) }' "
                           "out/model/sides/nodes.csv)\" = '0.000000 0.001000 0.000000 0.001000 '"),
                     0);
}
END_TEST

/* The corner of a brick lies at the middle of the side of one above it, where a soft bond opens by more
 * than contacts are deep: contacts are at the mean of both its ends, and so is the boundary. */
START_TEST(a_corner_at_an_open_bond_has_not_passed_into_the_block)
{
    ck_assert_int_eq(run_text("staggered", "material rigid E 1e14 nu 0.25 density 2500\n"
        "material rock E 1e9 nu 0.25 density 2500\nfixblock base\ngravity -6.3058 -7.5149\ncontact friction 32\n"
        "dynamic dt 0.01 steps 10\nblock base rigid -10 -1 8 -1 8 0 -10 0\n"
        "grid a rock 0 0 1 1 2 2\ngrid c rock 0.5 1 1.5 2 2 2\n"), 0);
}
END_TEST

/* The bond that breaks leaves the lower block to two bolts and a third one across, or to two pins. */
START_TEST(what_bolts_hold_hangs_when_its_bond_breaks)
{
    const char *held[] = {
        "bolt at 0.2 0.8 of a at 0.2 -0.8 of c stiffness 1e9\nbolt at 0.8 0.8 of a at 0.8 -0.8 of c stiffness 1e9\n"
        "bolt at 0.2 0.8 of a at 0.8 -0.8 of c stiffness 1e9\n", "pin a c at 0.2 0\npin a c at 0.8 0\n", "",
    };

    ck_assert_int_eq(run_printed("hung", "material m E 1e10 nu 0.2 density 2000\nblock a m 0 0 1 0 1 1 0 1\n"
        "block c m 0 -1 1 -1 1 0 0 0\nbond a c\nbond tension 1e3 cohesion 3e5 friction 30\nfix at 0 1 of a\n"
        "fix at 1 1 of a\ngravity 0 -9.81\n%sstatic\n", held[_i]), _i == 2);
}
END_TEST

Suite *breaking_suite(void)
{
    Suite *s = suite_create("breaking");
    TCase *t = new_case(s, "breaking");

    tcase_add_loop_test(t, a_joint_holds_by_its_own_tensile_strength, 0, 6);
    tcase_add_loop_test(t, glue_holds_where_the_floor_lets_go_first, 0, 6);
    tcase_add_test(t, what_is_lifted_comes_off_where_it_is_held_least);
    tcase_add_loop_test(t, a_long_joint_tears_from_where_it_bears_most, 0, 3);
    tcase_add_test(t, a_long_joint_that_bears_alike_comes_off_at_once);
    tcase_add_loop_test(t, a_stage_changes_what_a_joint_takes_from_contact, 0, 4);
    tcase_add_test(t, a_joint_that_breaks_says_how);
    tcase_add_test(t, a_search_for_an_equilibrium_that_fails_puts_back_what_it_took);
    tcase_add_loop_test(t, of_bonds_that_bear_far_too_much_the_one_that_bears_most_breaks, 0, 2);
    tcase_add_loop_test(t, a_bond_holds_where_a_contact_that_closes_in_the_step_bears_the_load, 0, 4);
    tcase_add_test(t, a_static_step_far_beyond_its_strength_leaves_a_bond_no_stronger);
    tcase_add_loop_test(t, fragments_that_have_passed_into_each_other_are_told, 0, 4);
    tcase_add_test(t, a_held_quadrilateral_that_loses_its_last_bond_makes_no_energy);
    tcase_add_test(t, strength_of_bonds_changes_nothing_where_there_is_none);
    tcase_add_test(t, a_block_with_cracks_can_be_removed);
    tcase_add_loop_test(t, a_block_that_breaks_off_another_one_is_named, 0, 2);
    tcase_add_loop_test(t, a_bond_along_the_tension_holds, 0, 9);
    tcase_add_loop_test(t, an_equilibrium_in_which_a_bond_bears_too_much_is_none, 0, 2);
    tcase_add_test(t, what_is_torn_off_costs_its_drag_alone);
    tcase_add_test(t, each_side_of_a_crack_has_its_own_nodes);
    tcase_add_test(t, a_corner_at_an_open_bond_has_not_passed_into_the_block);
    tcase_add_loop_test(t, what_bolts_hold_hangs_when_its_bond_breaks, 0, 3);
    return s;
}
