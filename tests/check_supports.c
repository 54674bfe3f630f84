/* check_supports.c - what supports, water, bolts and pins do in model files, against theory. */
#define _POSIX_C_SOURCE 200809L
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "programs.h"

START_TEST(a_bar_in_plane_strain_is_stiffer)
{
    static const char *const cut[] = { "quads", "triangles", "crossed" };
    const double E = 1e9, nu = 0.4, s = 1e6, L = 4;

    ck_assert_int_eq(run_printed("strain",
        "plane strain\nmaterial a E %g nu %g density 1 thickness 0.5\n"
        "grid bar a 0 0 %g 1 8 2 %s\nfix set bar.left x\nfix at 0 0 y\n"
        "traction set bar.right %g 0\nstatic\nmonitor end at 4 1\n", E, nu, L, cut[_i], s), 0);
    /* ex = s (1 - nu^2)/E, ey = -s nu (1 + nu)/E, szz = nu s; the bonds give way to 1e-6 of it */
    const double ex = s * (1 - nu * nu) / E, mises = s * sqrt(1 + nu * nu - nu);
    ck_relative(cell("strain", "history.csv", "1,", "end_u"), ex * L, 1e-6);
    ck_relative(cell("strain", "history.csv", "1,", "end_v"), -s * nu * (1 + nu) / E, 1e-5);
    ck_relative(cell("strain", "elements.csv", "1,", "mises"), mises, 1e-5);
    ck_relative(cell("strain", "nodes.csv", "1,", "mises"), mises, 1e-5);
    ck_relative(cell("strain", "summary.csv", "1,", "elastic"), s * ex / 2 * L * 0.5, 1e-5);
    ck_relative(sum("strain", "reactions.csv", "fx", ""), -s * 0.5, 1e-8);
}
END_TEST

/* The levels cross an edge, run through a node, lie above the crest; and the base is far down. */
static const double levels[] = { 16.5, 16, 25, 0.1, 16.5 }, bases[] = { 0, 0, 0, 0, -2e6 };

START_TEST(a_dam_carries_the_force_of_the_water_to_its_base)
{
    const double h = levels[_i], over = fmax(0, h - 20), g = 10, rho = 1030;
    const double force = rho * g * (h * h - over * over) / 2, top = h - over;

    ck_assert_int_eq(run_printed("water",
        "plane strain\nmaterial concrete E 25e9 nu 0.2 density 2400\n"
        "grid dam concrete 0 %g 8 %.15g 4 10\nfix set dam.bottom\ngravity 0 -10\n"
        "water set dam.left %.15g density 1030\nstatic\n", bases[_i], bases[_i] + 20,
        bases[_i] + h), 0);
    ck_relative(sum("water", "reactions.csv", "fx", ""), -force, 1e-6);
    ck_relative(sum("water", "reactions.csv", "fy", ""), 8 * 20 * 2400 * g, 1e-6);
    /* Moment about the middle of the base: int rho g (h - y) y dy over the wet height */
    double turning = 0;
    for (int k = 1; k <= 5; k++) {
        char row[10];
        snprintf(row, sizeof row, "%d,", k);
        turning += cell("water", "reactions.csv", row, "fy") * (2 * (k - 1) - 4);
    }
    ck_near(turning, rho * g * (h * top * top / 2 - top * top * top / 3),
            rho * g * 20 * 20 * 20 / 6, 1e-6);
}
END_TEST

/* A block of half the density floats on when a stage makes gravity twenty times as large; else it
 * would sink by 0.1 m. Its weight shortens it by rho g h/(2 E) = 5e-6 m. */
START_TEST(water_weighs_what_gravity_makes_of_it)
{
    ck_assert_int_eq(run_text("floats", "material wood E 1e9 nu 0.2 density 500\n"
        "grid b wood 0 0 2 1 2 1\ngravity 0 -1\nwater set b 0.5\ndynamic dt 0.005 steps 20\n"
        "monitor b set b\nstage heavy\ngravity 0 -20\nend\n"), 0);
    ck_near(cell("floats", "history.csv", "40,", "b_v"), 0, 5e-6, 1);
}
END_TEST

/* What is at rest is at its depth, however far it would fall in a step. Springs hold it to 1e-6. */
START_TEST(water_presses_on_what_is_at_rest_as_in_statics)
{
    ck_assert_int_eq(run_text("still", "material rock E 1e10 nu 0 density 2500\nblock b rock 0 0 1 0 1 2 0 2\nfixblock b\n"
        "set left nodes 1 4\nwater set left 2\ngravity 0 -9.81\ndynamic dt 0.1 steps 20\nmonitor s support set b\n"), 0);
    ck_relative(cell("still", "history.csv", "20,", "s_fx"), -1000 * 9.81 * 2, 1e-6);
}
END_TEST

/* A caisson of 4 m x 1 m, of half the density of water, on two lines of k = 10^3 to 10^8 N/m; it begins
 * d deep, and sinks by x: 9810 4 (d + x) = 500 4 9.81 - 2 k x. In one step or in 20 that is the same, if
 * its lines keep their direction. */
START_TEST(what_is_moored_floats_as_deep_as_its_weight_and_lines_ask)
{
    const double d = 0.05 + 0.4 * (_i % 3), k = pow(10, 3 + _i % 6), x = 39240 * (0.5 - d) / (39240 + 2 * k);

    ck_assert_int_eq(run_printed("moored", "material r E 1e12 nu 0.2 density 500\n%s\n"
        "block bed r -1 -21 5 -21 5 -20 -1 -20\nfixblock bed\nfix at 4 0 of a x\ncontact friction 30\n"
        "bolt at 0 0 of a at 0 -20 of bed stiffness %g\nbolt at 4 0 of a at 4 -20 of bed stiffness %g\n"
        "gravity 0 -9.81\nwater set a %g\nmonitor m set a\nstatic steps %d\n",
        _i % 2 ? "grid a r 0 0 4 1 4 2" : "block a r 0 0 4 0 4 1 0 1", k, k, d, _i < 6 ? 1 : 20), 0);
    ck_near(cell("moored", "history.csv", _i < 6 ? "1," : "20,", "m_v"), -x, 1, 1e-6);
}
END_TEST

/* A block rises by 0.4 m in the first of some static steps, and stays there. */
START_TEST(what_floats_stays_where_the_first_of_some_static_steps_puts_it)
{
    ck_assert_int_eq(run_text("rises", "material m E 1e9 nu .2 density 100\nblock p m 0 0 2 0 2 1 0 1\ngravity 0 -9.81\n"
        "water set p 0.5\nfix at 0 0 x\nstatic steps 5\nmonitor p set p\n"), 0);
    ck_near(cell("rises", "history.csv", "1,", "p_v"), 0.4, 1, 1e-6);
    ck_near(cell("rises", "history.csv", "5,", "p_v"), 0.4, 1, 1e-6);
}
END_TEST

/* What the water alone holds upright has supports for the other ways. In its place it stays there. */
START_TEST(what_floats_needs_supports_sideways_alone)
{
    static const int steps[] = { 1, 1, 20 };

    ck_assert_int_eq(run_printed("guided", "material r E 1e10 nu 0.2 density 500\nblock a r 0 0 4 0 4 1 0 1\n"
        "fix at 0 0 of a x\ngravity 0 -9.81\nwater set a %g\nmonitor m set a\nstatic steps %d\n",
        _i == 1 ? 1.1 : 0.3, steps[_i]), _i == 1 ? 2 : 0);
    if (_i != 1)
        ck_near(cell("guided", "history.csv", _i ? "20," : "1,", "m_v"), -0.2, 1, 1e-6);
}
END_TEST

/* A turn does not change what a body displaces: 1 % of its weight drives it, 0.098 m/s^2 less what it is
 * compressed, whether it turns by 0.3 rad in a step or not. */
START_TEST(what_turns_in_deep_water_rises_as_fast)
{
    double v[2];

    for (int k = 0; k < 2; k++) {
        ck_assert_int_eq(run_printed("spins", "material m E 1e12 nu 0 density 990\ncontact friction 0\n"
            "block b m -0.5 -51 0.5 -51 0.5 -50 -0.5 -50\ngravity 0 -9.81\nwater set b 0\nvelocity b 0 0 %d\n"
            "dynamic dt 0.1 steps 100\nmonitor m set b\n", 3 * k), 0);
        v[k] = cell("spins", "history.csv", "100,", "m_v");
    }
    ck_relative(v[0], 9.81 / 99 / 2 * 100, 1e-2);       /* first order in dt */
    ck_relative(v[1], v[0], 1e-4);
}
END_TEST

/* A cantilever of 10 m under P = 1.92 E I/L^2 turns by 0.761 rad at its end: the elastica, theta'' = -(P/E I)
 * cos(theta), by 4000 steps of shooting. Shear adds 0.3 % to its deflection, which theory leaves out. */
START_TEST(a_cantilever_that_bends_far_in_statics_is_the_elastica)
{
    ck_assert_int_eq(run_text("elastica", "material a E 2e11 nu 0.3 density 7800 thickness 0.5\ngrid rod a 0 0 10 0.5 20 1\n"
        "fix set rod.left\nload set rod.right 0 2e7\nmonitor t at 10 0\nstatic steps 12\n"), 0);
    ck_assert_str_eq(slurp("out/model/elastica.err"), "");
    ck_relative(cell("elastica", "history.csv", "12,", "t_u"), -1.35123, 6e-3);
    ck_relative(cell("elastica", "history.csv", "12,", "t_v"), 4.88690, 6e-3);
}
END_TEST

/* A bar of 2.1 m swings about its end to where weight and a soft line balance; 0.4 rad further down
 * it is as long as it was, but for its strain. */
START_TEST(what_swings_to_its_place_in_statics_stays_as_long)
{
    ck_assert_int_eq(run_text("swung", "material r E 1e11 nu 0.2 density 2500\nblock b r 0 0 0.9 -1.9 1.1 -1.8 0.2 0.1\n"
        "block w r 9 -3 10 -3 10 3 9 3\nfixblock w\nfix at 0 0\nbolt at 0.9 -1.9 of b at 9 -1.9 of w stiffness 2e3\n"
        "gravity 0 -9.81\ncontact friction 30\nmonitor t at 0.9 -1.9\nstatic steps 40\n"), 0);
    ck_assert_str_eq(slurp("out/model/swung.err"), "");
    const double u = cell("swung", "history.csv", "40,", "t_u"), v = cell("swung", "history.csv", "40,", "t_v");
    ck_assert_double_lt(u, -0.6);
    ck_relative(hypot(0.9 + u, -1.9 + v), hypot(0.9, 1.9), 1e-6);
}
END_TEST

/* 300 kg on 3 m of water swing with sqrt(1000 9.81 3/300) = 9.905/s, and a push of 0.3 m/s moves them
 * by 0.3/9.905 = 0.03029 m, in steps of 0.02 s to 3 s, 28 times the period over 2 pi. */
START_TEST(what_floats_keeps_its_energy_in_steps_of_any_length)
{
    static const double dt[] = { 0.02, 0.2, 0.6, 3 };

    ck_assert_int_eq(run_printed("swings", "material ice E 1e10 nu 0 density 100\ngravity 0 -9.81\n"
        "block p ice 0 -0.1 3 -0.1 3 0.9 0 0.9\nwater set p 0\ncontact friction 0\nvelocity p 0 -0.3\n"
        "monitor m set p\ndynamic dt %g steps 200\n", dt[_i]), 0);
    ck_assert_int_eq(shell("awk -F, 'NR > 1 && $4 > a { a = $4 } END { printf \"%%.15g\", a }' "
                           "out/model/swings/history.csv > out/model/sum"), 0);
    ck_relative(strtod(slurp("out/model/sum"), NULL), 0.3 / sqrt(98.1), _i < 3 ? 5e-3 : 0.05);
}
END_TEST

START_TEST(reactions_balance_forces_and_moments_however_elements_are_bonded)
{
    static const char *const cut[] = { "quads", "triangles", "crossed" };

    ck_assert_int_eq(run_printed("held",
        ROCK "grid a rock 0 0 4 1 6 2 %s\nfix set a.left\nfix at 4 0 y\n"
        "load at 4 1 2e5 -1e5\ngravity 0 -10\nbond at %s\n%s\n", cut[_i % 3],
        _i < 6 ? "moment" : "vertices", _i / 3 % 2 ? "static" : "dynamic dt 0.01 steps 400 velocity_factor 0.9"), 0);
    ck_relative(sum("held", "reactions.csv", "fx", ""), -2e5, 1e-5);
    ck_relative(sum("held", "reactions.csv", "fy", ""), 1e5 + 1e5, 1e-5);
    /* About the origin: the load, and the weight of 100 kN at x = 2 m. */
    ck_assert_int_eq(shell("awk -F, 'NR > 1 { m += $2 * $5 - $3 * $4 } END { printf \"%%.15g\", m }' "
                           "out/model/held/reactions.csv > out/model/sum"), 0);
    ck_relative(strtod(slurp("out/model/sum"), NULL), 4 * 1e5 + 1 * 2e5 + 2 * 1e5, 1e-3);
}
END_TEST

/* A bar between two walls, one of which moves; slowly, so that the middle follows. */
static const char *const pulled[] = { "static", "static steps 3",
                                      "dynamic dt 0.001 steps 1000 ramp 0.8" };

START_TEST(a_support_that_moves_pulls_its_bar)
{
    ck_assert_int_eq(run_printed("pulled",
        "material a E 1e9 nu 0.3 density 1000\ngrid bar a 0 0 4 1 8 2\nfix set bar.left x\n"
        "fix at 0 0 y\nfix set bar.right x by 0.004\nbond alpha 1e6\n%s\n"
        "monitor middle at 2 0\nmonitor end at 4 0\n", pulled[_i]), 0);
    const double most = _i == 2 ? 2e-3 : 1e-3;   /* u/L = 1e-3 more in dynamics */
    ck_relative(cell("pulled", "history.csv", "", "end_u"), 0.004, 1e-5);
    ck_relative(cell("pulled", "history.csv", "", "middle_u"), 0.002, most);
    const double right = cell("pulled", "reactions.csv", "9,", "fx")
                         + cell("pulled", "reactions.csv", "18,", "fx")
                         + cell("pulled", "reactions.csv", "27,", "fx");
    ck_relative(right, 1e6, most);
    ck_near(sum("pulled", "reactions.csv", "fx", ""), 0, 1e6, 1e-5);
    /* E A u^2/(2 L); in dynamics the support's work is that */
    ck_relative(cell("pulled", "summary.csv", "", "elastic"), 1e9 * 0.004 * 0.004 / 8, 3 * most);
    if (_i == 2)
        ck_relative(cell("pulled", "summary.csv", "", "external"), 1e9 * 0.004 * 0.004 / 8,
                    3 * most);
}
END_TEST

/* A stiff belt starts at 10 or 30 m/s under a block that rests on it, without friction. Its supports move it by forces of
 * 1e15 N, whose last digits times its way are no energy. The block stays, but for rounding. */
START_TEST(a_belt_without_friction_leaves_a_block_where_it_is)
{
    ck_assert_int_eq(run_printed("belt", "material s E 1e13 nu 0.25 density 2000\nmaterial r E 1e10 nu 0.25 density 2000\n"
        "block belt s -10 -1 10 -1 10 0 -10 0\nblock b r 0 0 %d 0 %d 0.5 0 0.5\nfixblock belt\ngravity 0 -10\n"
        "monitor b set b\ncontact kn 1e9\n"
        "dynamic dt 0.01 steps 10 settle 50\nfix set belt x by %d\n", _i / 2 + 1, _i / 2 + 1, 1 + 2 * (_i % 2)), 0);
    ck_near(cell("belt", "history.csv", "", "b_u"), 0, 1, 1e-7);
}
END_TEST

/* A block of 20 kN that a roller keeps upright hangs on one bolt of 10 or 15 kN. The bolt has broken when the second step begins;
 * a single step ends before that. A stone elsewhere has contacts. */
START_TEST(statics_names_what_falls_when_its_bolt_breaks)
{
    static const char *const held[] = { "fix at 50 0 of q x\nfix at 50 1 of q x\nstatic steps 2\n", "fix at 50 0 of q x\nstatic steps 1\n" };

    ck_assert_int_eq(run_printed("drops", ROCK "block ground rock 0 -1 1 -1 1 0 0 0\nblock stone rock 0 0 1 0 1 1 0 1\n"
        "block q rock 50 0 51 0 51 1 50 1\nblock roof rock 50 3 51 3 51 4 50 4\nfixblock ground\nfixblock roof\n"
        "gravity 0 -9.81\ncontact friction 30\nbolt at 50.5 0.5 of q at 50.5 3.5 of roof stiffness 1e7 strength 1e4\n%s", held[_i]), 1);
    check_text("out/model/drops.err", _i ? "step 1: a bolt carries more than its strength" : "step 2: statics needs bodies that are held: block 'q'");
}
END_TEST

/* A block hangs on two bolts side by side, with nothing else about that touches anything: it grows them by W/(2 k). */
START_TEST(a_block_hangs_in_statics_on_bolts_that_let_it_swing)
{
    ck_assert_int_eq(run_text("swing", ROCK "block roof rock 0 3 1 3 1 4 0 4\nblock q rock 0 0 1 0 1 1 0 1\nfixblock roof\n"
        "gravity 0 -9.81\nbolt at 0.3 0.5 of q at 0.3 3.5 of roof stiffness 1e6\nbolt at 0.7 0.5 of q at 0.7 3.5 of roof stiffness 1e6\n"
        "static\nmonitor q set q\n"), 0);
    ck_relative(cell("swing", "history.csv", "", "q_v"), -2500 * 9.81 / 2e6, 1e-6);
}
END_TEST

/* Weight swings a block on its bolts, and on the way they are stretched by far more than their strength allows. Where it hangs
 * at last they bear 1 % of that: both hold, whether steps end with a tolerance or by their number. */
START_TEST(a_bolt_does_not_break_on_the_way_to_an_equilibrium)
{
    ck_assert_int_eq(run_printed("sways", "material r E 1e10 nu 0.2 density 2000\nblock roof r -625 156 625 156 625 187 -625 187\n"
        "fixblock roof\nblock b r -43.4 137 -11.4 137 -11.4 153.5 -43.4 153.5\nbolt at -43.4 153.5 of b at -47.9 156 of roof "
        "stiffness 4.3e8 strength 5.3e8\nbolt at -11.4 153.5 of b at -37.7 156 of roof stiffness 2.5e9\ngravity 0.25 -10\n"
        "contact friction 45\nstatic steps 60%s\n", _i ? " tolerance 1e-8" : ""), 0);
    ck_near(cell("sways", "bolts.csv", "1,", "force"), 6e6, 6e6, 0.1);
    check_text("out/model/sways/bolts.csv", "HOLDS\n2,");
}
END_TEST

/* A block lies with a quarter of its width on a ledge and hangs on a soft bolt. It slides off, swings over several
 * times its size, and hangs straight below the roof, where the bolt is longer by its weight over its stiffness. */
START_TEST(what_slides_off_a_ledge_hangs_on_its_bolt)
{
    static const double angle[] = { 60, -50, 35, -30 }, length[] = { 1.5, 1, 2, 1 }, stiff[] = { 3, 30, 300, 1000 };
    const double L = length[_i], turn = angle[_i] * acos(-1) / 180, x = L * sin(turn), y = -L * cos(turn);
    const double side = copysign(0.5, x), weight = 2000 * 9.81 * 0.16;

    ck_assert_int_eq(run_printed("swings", "let x %.16g\nlet y %.16g\nlet l $(x+%g)\nlet u $(y-0.3)\n"
        "material r E 1e10 nu 0.2 density 2000\nblock roof r -0.1 0 0.1 0 0.1 5 -0.1 5\nfixblock roof\n"
        "block ledge r $(l-0.4) $(u-1) $(l+0.4) $(u-1) $(l+0.4) $u $(l-0.4) $u\nfixblock ledge\n"
        "block b r $(x-0.2) $u $(x+0.2) $u $(x+0.2) $(u+0.4) $(x-0.2) $(u+0.4)\n"
        "bolt at 0 0 of roof at $x $y of b stiffness %.16g\ngravity 0 -9.81\ncontact friction 5\n"
        "static steps 100 tolerance 1e-9\n", x, y, side, weight / L * stiff[_i]), 0);
    ck_near(cell("swings", "elements.csv", "3,", "u"), -x, L, 1e-6);
    ck_near(cell("swings", "elements.csv", "3,", "v"), -y - L * (1 + 1 / stiff[_i]), L, 1e-6);
    ck_near(cell("swings", "elements.csv", "3,", "rotation"), 0, 1, 1e-6);
}
END_TEST

/* The first static step swings a block by nearly twice its size, later ones by little. The run still says so. */
START_TEST(what_a_first_static_step_has_moved_far_is_told_after_the_last_one)
{
    ck_assert_int_eq(run_text("swings", "material r E 1e10 nu 0.2 density 2500\nblock roof r -0.3 0.5 0.3 0.5 0.3 4.5 -0.3 4.5\n"
        "fixblock roof\nblock ledge r -1.9504 -0.8477 -0.9308 -0.8477 -0.9308 -0.3477 -1.9504 -0.3477\nfixblock ledge\n"
        "block b r -0.9504 -0.3477 -0.6572 -0.3477 -0.6572 -0.0611 -0.9504 -0.0611\n"
        "bolt at 0 0.5 of roof at -0.8038 -0.2044 of b stiffness 6225.5908\ngravity 0 -9.81\ncontact friction 15.1652\n"
        "static steps 3\n"), 0);
    check_text("out/model/swings.err", "it stands, but not as drawn: blocks slid or turned by 1.8 of their size first");
}
END_TEST

/* Loads swing blocks that hang on two bolts: statics finds them where quasi-static steps do, and neither upside down nor
 * turned once more. 1e-3 m: these steps end so near. */
START_TEST(what_swings_on_its_bolts_hangs_as_short_steps_have_it)
{
    static const char *const hangs[] = {
        "let w 1.19\nlet h 0.77\nlet a 0.25\nlet c -1.23\nlet k 7.8e4\ngravity 0.085 -10\nload at $w 0 of a -3630 -3770\n",
        "let w 1.72\nlet h 2.46\nlet a 0.28\nlet c 1.22\nlet k 5e7\ngravity -1.15 -10\nload at $w 0 of a 21600 18100\n",
        "let w 0.79\nlet h 1.91\nlet a -2.48\nlet c 3.27\nlet k 1.2e7\ngravity 1.8 -10\nload at $w 0 of a -722 -8735\n",
    };
    double at[2][3];

    for (int k = 0; k < 2; k++) {
        ck_assert_int_eq(run_printed("swings", "%smaterial r E 1e10 nu 0.2 density 2000\nblock roof r -20 5 20 5 20 6 -20 6\n"
            "fixblock roof\nblock a r 0 0 $w 0 $w $h 0 $h\nbolt at 0 $h of a at $a 5 of roof stiffness $k\n"
            "bolt at $w $h of a at $c 5 of roof stiffness $k pretension 800\ncontact friction 30\n%s\n", hangs[_i],
            k ? "dynamic dt 0.05 steps 3000 velocity_factor 0" : "static steps 40 tolerance 1e-8"), 0);
        at[k][0] = cell("swings", "elements.csv", "2,", "u");
        at[k][1] = cell("swings", "elements.csv", "2,", "v");
        at[k][2] = cell("swings", "elements.csv", "2,", "rotation");
    }
    for (int a = 0; a < 3; a++)
        ck_near(at[0][a], at[1][a], 1, 1e-3);
}
END_TEST

/* A block of 24.5 kN hangs on a bolt of 1 MN/m; one that is tight by as much holds it where it is. One
 * that breaks at 20 kN has grown by 0.02 m = W/K (1 - cos 20 t), t = 0.0693 s, from where the block falls on
 * with 0.482 m/s; the 10 mm are what steps of 1 ms make of when it breaks. */
START_TEST(a_block_hangs_on_its_bolt)
{
    const double W = 2500 * 9.81, K = 1e6;
    const struct { const char *bolt; double force, v; } table[] = {
        { "", W, -W / K }, { "pretension 24525", W, 0 }, { "strength 30e3", W, -W / K },
        { "strength 20e3", 0, -0.02 - 0.4817 * 0.9307 - 9.81 / 2 * 0.9307 * 0.9307 },
    };

    ck_assert_int_eq(run_printed("bolt",
        ROCK "block roof rock 1 3 2 3 2 4 0 4 0 3\nblock lump rock 0.5 0 1.5 0 1.5 1 1 1 0.5 1\n"
        "fixblock roof\nbolt at 1 1 at 1 3 stiffness 1e6 %s\ngravity 0 -9.81\ncontact friction 30\n"
        "dynamic dt %g steps %d velocity_factor %d\nmonitor top at 1 1\noutput svg\n", table[_i].bolt,
        _i == 3 ? 0.001 : 0.1, _i == 3 ? 1000 : 200, _i == 3), 0);
    ck_assert_str_eq(slurp("out/model/bolt.err"), "");
    ck_near(cell("bolt", "bolts.csv", "1,lump,roof,", "force"), table[_i].force, W, 1e-6);
    ck_near(cell("bolt", "history.csv", "", "top_v"), table[_i].v, W / K, _i == 3 ? 0.4 : 1e-3);
    check_text("out/model/bolt/bolts.csv", _i == 3 ? "BROKEN" : "HOLDS");
    check_text("out/model/bolt/contacts.svg", ">bolt<");
    ck_assert_int_eq(shell("cd out/model; $OLDPWD/%s/bbm bolt.model > said", BUILD), 0);
    ck_assert_int_eq(strstr(slurp("out/model/said"), "\nbolt 1 holds no more since t = 0.0") != NULL, _i == 3);
    check_text("out/model/bolt/mises.svg", ">bolt<");
}
END_TEST

/* On a slope of 30 degrees, level here, with friction of 10: W (sin 30 - cos 30 tan 10), once it has slid
 * so far. On one without friction it swings, and no step makes energy. In statics a bolt that is weaker fails the
 * run, though its only step has done what it should. */
START_TEST(a_bolt_holds_a_block_on_its_slope)
{
    const double phi = _i == 1 ? 0 : 10, W = 2500 * 9.81, force = W * (0.5 - sqrt(0.75) * tan(phi * acos(-1) / 180));

    ck_assert_int_eq(run_printed("tied",
        ROCK "block base rock 0 0 9 0 9 1 0 1\nblock post rock 0 1 1 1 1 2 0 2\nblock lump rock 4 1 5 1 5 2 4 2\n"
        "fixblock base\nfixblock post\nbolt at 4 1 at 1 1 stiffness 1e7 strength %.15g\n"
        "gravity $(9.81/2) $(-9.81*cos(30))\ncontact friction %g\n%s\n",
        _i < 2 ? W : force * (_i == 2 ? 1.001 : 0.999), phi, _i == 0 ? "dynamic dt 0.01 steps 300 settle 50 damping 0"
        : _i == 1 ? "dynamic dt 0.01 steps 300 settle 50" : "static"), _i == 3);
    ck_assert(cell("tied", "summary.csv", "", "gained") <= 1e-9 * W);
    if (_i == 0 || _i == 2)
        ck_relative(cell("tied", "bolts.csv", "1,", "force"), force, 1e-4);
}
END_TEST

/* Two bolts from within a block, also one of elements, to within a roof with a notch carry it by their
 * distances from its centre; it turns by 1e-5. */
START_TEST(a_bolt_ends_anywhere_in_a_block)
{
    static const char *const lump[] = { "block lump rock 0.5 0 1.5 0 1.5 1 0.5 1",
                                        "grid lump rock 0.5 0 1.5 1 3 3" };
    static const struct { const char *end, *said; } wrong[] = {
        { "1 3.5", "1 3.5 lies in no element" }, { "1 3.5 of roof", "1 3.5 lies in no element" },
        { "0.4 5", "a bolt ends at one of several nodes or blocks there" }, { "0.4 6 of roof", "0.4 6 lies in block" },
        { "1.35 0.75", "a bolt without length or within an element" },
    };
    const double W = 2500 * 9.81;

    for (size_t k = 0; k <= sizeof wrong / sizeof *wrong; k++) {
        const int good = k == sizeof wrong / sizeof *wrong;
        ck_assert_int_eq(run_printed("within",
            ROCK "block roof rock 2 3 2 5 0 5 0 3 0.5 3 0.5 4 1.5 4 1.5 3\n%s\nfixblock roof\n"
            "block cap rock 0 5 2 5 2 6 0 6\nfixblock cap\n"
            "bolt at 0.75 0.8 at 0.75 4.5 stiffness 1e9\nbolt at 1.4 0.8 at %s stiffness 1e9\n"
            "gravity 0 -9.81\ncontact friction 30\ndynamic dt 0.1 steps 100 velocity_factor 0\n",
            lump[_i], good ? "1.4 4.9" : wrong[k].end), good ? 0 : 2);
        if (!good)
            check_text("out/model/within.err", wrong[k].said);
    }
    ck_relative(cell("within", "bolts.csv", "1,lump,roof,", "force"), W * 0.4 / 0.65, 1e-4);
    ck_relative(cell("within", "bolts.csv", "2,lump,roof,", "force"), W * 0.25 / 0.65, 1e-4);
}
END_TEST

/* A block on a floor is pressed from above by a block that comes down by 0.2 mm in 40 s. In steps
 * so long it moves to and fro, but the springs above and below it, 2 kn each, and its own stiffness
 * bear what they should, and so does the support. A jump that loses what is squeezed makes energy:
 * then a step took 15 to 200 solutions, in parts. */
START_TEST(a_slow_press_bears_what_its_springs_do)
{
    static const char *const dynamic[] = { "dt 0.1 steps 500", "dt 2 steps 40", "dt 0.1 steps 500" };
    const double sinks = 2500 * 9.81 / 2e9, compliance = 2 / 2e9 + 1 / 1e11;

    ck_assert_int_eq(run_printed("press", "material rigid E 1e14 nu 0.25 density 2500\nmaterial rock E 1e11 nu 0 density 2500\n"
        "block f0 rigid -3 -1 3 -1 3 0 -3 0\nblock b0 rock -0.5 0 0.5 0 0.5 1 -0.5 1\n"
        "block h rigid -0.4 1 0.4 1 0.4 2 -0.4 2\nfixblock f0\nfixblock h\ngravity 0 -9.81\ncontact kn 1e9 friction 30 %s\n"
        "dynamic %s settle 100 ramp 40\nfix set h y by -0.0002\nmonitor H joint h b0\nmonitor q support set h\n",
        _i < 2 ? "" : "restitution 0", dynamic[_i]), 0);
    ck_relative(cell("press", "history.csv", "", "H_normal"), (2e-4 - sinks) / compliance, 2e-3);    /* the block bends, too */
    ck_relative(cell("press", "history.csv", "", "q_fy"), 2500 * 9.81 * 0.8 - cell("press", "history.csv", "", "H_normal"), 1e-6);
    ck_assert_double_le(sum("press", "summary.csv", "open_close", ""), _i == 1 ? 80 : 1000);
}
END_TEST

/* A table of 4e15 Pa under springs of 4e12 N/m: to move it takes 1e9 times as much as it bears. */
START_TEST(what_moves_a_stiff_support_is_not_in_its_force)
{
    ck_assert_int_eq(run_text("stiff", "material rigid E 4e15 nu 0.2 density 1000\nblock T rigid -3 -1 3 -1 3 0 -3 0\n"
        "fixblock T\nfix set T x by -0.0128 y by 0.004\nblock B rigid 0 0 0.25 0 0.25 1 0 1\n"
        "contact kn 4e12 ks 1.6e12 friction 31 restitution 0.5\ndynamic dt 0.001 steps 1\n"
        "monitor j joint T B\nmonitor s support set T\n"), 0);
    const double x = cell("stiff", "history.csv", "1,", "j_fx"), y = cell("stiff", "history.csv", "1,", "j_fy");
    ck_near(cell("stiff", "history.csv", "1,", "s_fx"), -x, y, 1e-4);
    ck_near(cell("stiff", "history.csv", "1,", "s_fy"), -y, y, 1e-4);
    ck_assert_double_gt(fabs(y), 1e5);
}
END_TEST

/* An arch of two bars with hinges at its feet and, 2 m higher, in its middle, which P = 8 kN pulls up: P/2 and, over the
 * lever of 2 m to 2 m, P/2 at each foot; the bar without the load hangs at the pin. In dynamics, at rest, too, where it
 * gives way a little more. */
START_TEST(a_pin_lets_turn_and_carries_what_a_hinge_does)
{
    ck_assert_int_eq(run_printed("hinges", ROCK "block l rock 0 0 1.9 2 2 2\nblock r rock 4 0 2 2 2.1 2\npin l r at 2 2\n"
                                 "fix at 0 0\nfix at 4 0\nload at 2 2 of l 0 8e3\ncontact friction 30\n%s\n"
                                 "monitor left support at 0 0\nmonitor right support at 4 0\nmonitor pin bolt 1\n"
                                 "expect left fx -4e3 within 0.01 %%\nexpect left fy -4e3 within 0.01 %%\n"
                                 "expect right fx 4e3 within 0.01 %%\nexpect right fy -4e3 within 0.01 %%\n"
                                 "expect pin force $(4e3*sqrt(2)) within 0.01 %%\n",
                                 _i ? "dynamic dt 0.1 steps 50 velocity_factor 0" : "static"), 0);
    ck_near(cell("hinges", "bolts.csv", "1,l,r", "force"), 4e3 * sqrt(2), 4e3, 1e-4);
}
END_TEST

/* Two quadrilaterals share the node at which a bolt or a pin pulls them up, and so its force of 1 MN. */
START_TEST(elements_that_meet_at_a_node_share_what_pulls_there)
{
    ck_assert_int_eq(run_printed("share", ROCK "grid a rock 0 0 2 1 2 1\nfix at 0 0 of a\nfix at 2 0 of a\n%s\nstatic\n", _i
        ? "block p rock 1 1 1.5 2 0.5 2\npin a p at 1 1\nload at 0.5 2 of p 0 5e5\nload at 1.5 2 of p 0 5e5\n"
          "fix at 0.5 2 of p x\nfix at 1.5 2 of p x\ncontact friction 30"
        : "block anchor rock 0.5 3 1.5 3 1 4\nfixblock anchor\nbolt at 1 1 of a at 1 4 of anchor stiffness 1e3 pretension 1e6"), 0);
    for (int k = 0; k < 2; k++)         /* the bolt is 0.3 mm shorter then */
        ck_relative(cell("share", "elements.csv", k ? "2,a," : "1,a,", "syy"), 5e5, 1e-6);
    ck_relative(cell("share", "elements.csv", "1,a,", "sxy"), -cell("share", "elements.csv", "2,a,", "sxy"), 1e-6);
}
END_TEST

/* A pendulum on a stiff pin, by the support of the other block, which weighs as much as the support bears at the start. */
START_TEST(a_pin_that_moves_bears_what_its_support_does)
{
    ck_assert_int_eq(run_text("swing", "material rock E 1e12 nu 0.25 density 2500\nblock top rock 0 0 1 1 -1 1\n"
        "fixblock top\nblock b rock 0 0 0.759808 -0.716025 1 -1.732051 0.240192 -1.016025\npin top b at 0 0\n"
        "gravity 0 -9.81\ncontact friction 30\ndynamic dt 0.01 steps 40\nmonitor p bolt 1\nmonitor r support set top\n"), 0);
    ck_assert_str_eq(slurp("out/model/swing.err"), "");         /* its forces on both are opposite, their moments, too */
    for (int k = 20; k <= 40; k++) {
        char row[20];
        snprintf(row, sizeof row, "%d,", k);
        const double x = cell("swing", "history.csv", row, "r_fx"),
                     y = cell("swing", "history.csv", row, "r_fy") - 2500 * 9.81;
        ck_relative(cell("swing", "history.csv", row, "p_force"), hypot(x, y), 1e-5);      /* of balance in motion */
    }
}
END_TEST

/* A block hangs on two bolts and a third holds it across: statics knows all three forces, however stiff the bolts are
 * and soft the block is. Its turns are small, and what they would lengthen a bolt by is no force. */
START_TEST(stiff_bolts_bear_in_statics_what_balance_says)
{
    ck_assert_int_eq(run_printed("three", "material soft E %s nu 0.2 density 2500\nmaterial rock E 1e11 nu 0.2 density 2500\n"
        "block anchor rock -5 5 5 5 5 6 -5 6\nblock wall rock 6 -1 7 -1 7 2 6 2\nfixblock anchor\nfixblock wall\n"
        "block b soft 0 0 2 0 2 1 0 1\nbolt at 0 1 of b at 0 5 of anchor stiffness %s strength 25e3\n"
        "bolt at 2 1 of b at 2 5 of anchor stiffness %s strength 25e3\nbolt at 2 0 of b at 6 0 of wall stiffness %s\n"
        "gravity 0 -9.81\nload at 0 0 of b 5000 0\ncontact friction 30\nstatic\n", _i ? "1e9" : "1e6",
        _i ? "1e13" : "1e9", _i ? "1e13" : "1e9", _i ? "1e13" : "1e9"), 0);
    ck_relative(cell("three", "bolts.csv", "1,", "force"), 2500 * 9.81, 1e-6);
    ck_relative(cell("three", "bolts.csv", "2,", "force"), 2500 * 9.81, 1e-6);
    ck_relative(cell("three", "bolts.csv", "3,", "force"), -5000, 1e-6);
}
END_TEST

/* A fixed block of 6.7 mm is moved against a row of three others on a floor, all of lead at a small gravity. The jump at the
 * end of a step is tried more than once; only the work of the last try counts. */
START_TEST(the_work_of_supports_in_a_jump_that_is_tried_again_counts_once)
{
    ck_assert_int_eq(run_text("again", "material rock E 5e9 nu 0 density 2e6 thickness 6.7e-3\nlet a 6.7e-3\n"
        "block push rock $(-2*a) $(a/100) -$(a) $(a/100) -$(a) $(a) $(-2*a) $(a)\nfixblock push\nfix set push x by 9.3e-5 y by 0\n"
        "block floor rock $(-3*a) -$(a) $(12*a) -$(a) $(12*a) 0 $(-3*a) 0\nfixblock floor\n"
        "block b rock $(a) 0 $(2*a) 0 $(2*a) $(a) $(a) $(a)\nblock c rock 0 0 $(a) 0 $(a) $(0.75*a) 0 $(0.75*a)\n"
        "block d rock -$(a) 0 0 0 0 $(0.8*a) -$(a) $(0.8*a)\ngravity 0 -6.5e-3\npcg tolerance 1e-12\n"
        "contact kn 7e8 ks 4e8 friction 0\ndynamic dt 0.08 steps 13\n"), 0);
}
END_TEST

/* A wall pushes a block along a floor: the force is W tan(30). A second block far off lets the iteration fail; in steps from
 * rest the first one would come to lie with a seventh of that, which is an equilibrium, too. */
START_TEST(statics_does_not_guess_what_a_support_pushes)
{
    ck_assert_int_eq(run_printed("pushed", ROCK "block wall rock -1 0 0 0 0 1 -1 1\nblock floor rock -3 -1 5 -1 5 0 -3 0\n"
        "block b rock 0 0 0.5 0 0.5 0.5 0 0.5\n%sfixblock wall\nfixblock floor\nfix set wall x by 1e-3\ngravity 0 -9.81\n"
        "contact friction 30\njoint wall b friction 0\nstatic steps 4\nmonitor K joint wall b\n",
        _i ? "block far rock 3 0 4 0 4 1 3 1\n" : ""), _i);
    if (_i)
        check_text("out/model/pushed.err", "a support moves, and what slides before it depends on its way; try dynamics");
    else
        ck_relative(cell("pushed", "history.csv", "4,", "K_fx"), -0.25 * 2500 * 9.81 / sqrt(3), 1e-4);
}
END_TEST

/* Nothing presses from outside, so the forces inside are left to their last digits: a stress to which a free body gives
 * way, a support that sinks, a load taken back, a bolt from one end of a body to its other. */
START_TEST(a_body_that_bears_nothing_from_outside_balances_whatever_its_size)
{
    static const char *mesh[] = { "quads", "triangles", "crossed" }, *inside[] = {
        "fix at 0 0\nfix at $w 0 y\nstress b 1e6 -3e5 2e5\nstatic\n",
        "fix at 0 0\nfix at $w 0 y by $(-1e-3*w)\nstatic\n",
        "fix set b.left\nload at $w $h 1000 500\nstatic\nstage off\nload at $w $h -1000 -500\nend\n",
        "fix at 0 0\nfix at $w 0 y\nbolt at 0 $h at $w $h stiffness 1e7 pretension 1e4\nstatic\n" };

    for (int k = 0; k < 24; k++) {
        const double w = 0.37 * pow(1.19, k);
        ck_assert_int_eq(run_printed("within", "let w %g\nlet h %g\nmaterial m E 1e10 nu 0.2 density 2500\n"
            "grid b m 0 0 $w $h %d %d %s\n%s", w, 5 / w, 2 + k % 3, 1 + k % 4, mesh[k % 3], inside[_i]), 0);
        ck_assert_str_eq(slurp("out/model/within.err"), "");
    }
}
END_TEST

/* A free bar of three elements with a bolt of 1 GN/m between two nodes, also of one element: its mean velocity stays. */
START_TEST(a_bolt_within_one_body_moves_it_nowhere)
{
    const char *end[] = { "2 0", "2 1", "3 1" }, *row[] = { "1,", "2,", "3," };
    double v[2] = { 0, 0 };

    ck_assert_int_eq(run_printed("inner", "material m E 1e10 nu 0.2 density 2000\ngrid b m 0 0 3 1 3 1\nvelocity b 1 0 1\n"
        "bolt at 1 0 at %s stiffness 1e9\ndynamic dt 1e-3 steps 100\n", end[_i]), 0);
    for (int k = 0; k < 3; k++) {
        v[0] += cell("inner", "elements.csv", row[k], "vx") / 3;
        v[1] += cell("inner", "elements.csv", row[k], "vy") / 3;
    }
    ck_near(v[0], 1, 1, 1e-9);                          /* what the solver leaves */
    ck_near(v[1], 0, 1, 1e-9);
}
END_TEST

/* A block that is turned by 10 degrees hits a plate, and rubs on it. If the plate moves by 1e-9 m meanwhile, as far as
 * rounding counts nothing has changed; 1e-6: of the hit's velocity. */
START_TEST(a_support_that_hardly_moves_changes_no_hit)
{
    double v[2][3];

    for (int k = 0; k < 2; k++) {
        ck_assert_int_eq(run_printed("grazes", "material rigid E 1e14 nu 0.25 density 2500\nmaterial rock E 1e12 nu 0.25 density "
            "2500\nblock plate rigid -2 -1 2 -1 2 0 -2 0\nlet c $(cos(10))\nlet s $(sin(10))\nfixblock plate\n"
            "block stone rock 0 0.01 $c $(0.01 + s) $(c - s) $(0.01 + c + s) $(-s) $(0.01 + c)\nvelocity stone 0 -1\n"
            "fix set plate %s by %g\ncontact kn 1e9 friction 30\ndynamic dt 5e-4 steps 60\n", _i ? "y" : "x", k * 1e-9), 0);
        v[k][0] = cell("grazes", "elements.csv", "2,", "vx");
        v[k][1] = cell("grazes", "elements.csv", "2,", "vy");
        v[k][2] = cell("grazes", "elements.csv", "2,", "spin");
    }
    ck_assert_double_gt(fabs(v[0][2]), 1);
    for (int a = 0; a < 3; a++)
        ck_near(v[1][a], v[0][a], 1, 1e-6);
}
END_TEST

/* Lifted, or pulled, at one corner from the first step on, while its side lies on the floor. */
START_TEST(a_restitution_changes_no_lift_by_a_support)
{
    const char *way[] = { "x by 0.01 y by 0.01", "y by 0.01", "x by -0.01" };

    ck_assert_int_eq(run_printed("lifts", "material r E 1e9 nu 0 density 2000\nblock base r -2 -1 2 -1 2 0 -2 0\n"
        "block b r -.5 0 .5 0 .5 1 -.5 1\nfixblock base\ngravity 0 -9.81\nfix at .5 1 of b %s\n"
        "contact friction 30 restitution 0\ndynamic dt %g steps 100\nmonitor top at .5 1 of b\nexpect top %s\n",
        way[_i % 3], _i / 3 ? 1e-3 : 1e-4, _i % 3 == 2 ? "u -0.01 within 1 %" : "v 0.01 within 1 %"), 0);
}
END_TEST

/* A block at rest that a bolt presses on the floor. Hits make bodies rigid, and no bolt: 2 kN more than the weight press. */
START_TEST(a_bolt_pulls_alike_whether_hits_give_back_or_not)
{
    ck_assert_int_eq(run_text("pull", ROCK "block floor rock -5 -1 5 -1 5 0 -5 0\nfixblock floor\nblock a rock 0 0 1 0 1 1 0 1\n"
        "gravity 0 -9.81\ncontact friction 30 restitution 0.5\nbolt at 0.5 0.5 of a at 0.5 -0.5 of floor stiffness 1e4 "
        "pretension 2000\ndynamic dt 0.001 steps 10 settle 50\nmonitor p bolt 1\nmonitor f joint a floor\n"), 0);
    ck_relative(cell("pull", "history.csv", "", "p_force"), 2000, 1e-3);
    ck_relative(cell("pull", "history.csv", "", "f_normal"), 2000 + 2500 * 9.81, 1e-3);
    ck_assert_int_eq(run_text("pull", ROCK "block floor rock -5 -1 5 -1 5 0 -5 0\nfixblock floor\nblock a rock 0 0 1 0 1 1 0 1\n"
        "gravity 0 -9.81\ncontact friction 30 restitution 0.5\nbolt at 0.5 0.5 of a at 0.5 -0.5 of floor stiffness 1e6 "
        "pretension 2000\ndynamic dt 0.001 steps 10\n"), 0);
}
END_TEST

/* Freed, a beam that a bolt carries too sinks as one that was never held inside. */
START_TEST(a_support_that_is_gone_leaves_no_force_to_a_bolt)
{
    double sinks[2];

    for (int k = 0; k < 2; k++) {
        ck_assert_int_eq(run_printed("freed", "material rock E 1e10 nu 0 density 2000\n"
            "grid b rock 0 0 4 1 4 2 quads\nblock w rock 0 2 4 2 4 3 0 3\nfixblock w\n"
            "fix at 0 0 x y\nfix at 4 0 y\nbolt at 2 1 of b at 2 2 of w stiffness 1e6\n"
            "traction set b.top 0 -1000\nbond augment 2\nmonitor in at 2 0.5\nstatic\n%s",
            k ? "fix at 2 0.5 y\nstage off\nfix at 2 0.5 free\nend\n" : ""), 0);
        sinks[k] = cell("freed", "history.csv", "", "in_v");
    }
    ck_relative(sinks[1], sinks[0], 1e-5);      /* strains are 1e-6 */
}
END_TEST

Suite *supports_suite(void)
{
    Suite *s = suite_create("supports");
    TCase *t = new_case(s, "supports");

    tcase_add_loop_test(t, a_bar_in_plane_strain_is_stiffer, 0, 3);
    tcase_add_loop_test(t, a_dam_carries_the_force_of_the_water_to_its_base, 0, 5);
    tcase_add_test(t, water_weighs_what_gravity_makes_of_it);
    tcase_add_test(t, water_presses_on_what_is_at_rest_as_in_statics);
    tcase_add_loop_test(t, what_is_moored_floats_as_deep_as_its_weight_and_lines_ask, 0, 12);
    tcase_add_test(t, what_floats_stays_where_the_first_of_some_static_steps_puts_it);
    tcase_add_loop_test(t, what_floats_needs_supports_sideways_alone, 0, 3);
    tcase_add_test(t, what_turns_in_deep_water_rises_as_fast);
    tcase_add_test(t, what_swings_to_its_place_in_statics_stays_as_long);
    tcase_add_test(t, a_cantilever_that_bends_far_in_statics_is_the_elastica);
    tcase_add_loop_test(t, what_floats_keeps_its_energy_in_steps_of_any_length, 0, 4);
    tcase_add_loop_test(t, reactions_balance_forces_and_moments_however_elements_are_bonded, 0, 12);
    tcase_add_loop_test(t, a_support_that_moves_pulls_its_bar, 0, 3);
    tcase_add_loop_test(t, a_belt_without_friction_leaves_a_block_where_it_is, 0, 8);
    tcase_add_loop_test(t, a_block_hangs_on_its_bolt, 0, 4);
    tcase_add_loop_test(t, statics_names_what_falls_when_its_bolt_breaks, 0, 2);
    tcase_add_test(t, a_block_hangs_in_statics_on_bolts_that_let_it_swing);
    tcase_add_loop_test(t, a_bolt_does_not_break_on_the_way_to_an_equilibrium, 0, 2);
    tcase_add_loop_test(t, what_swings_on_its_bolts_hangs_as_short_steps_have_it, 0, 3);
    tcase_add_loop_test(t, what_slides_off_a_ledge_hangs_on_its_bolt, 0, 4);
    tcase_add_test(t, what_a_first_static_step_has_moved_far_is_told_after_the_last_one);
    tcase_add_loop_test(t, a_bolt_holds_a_block_on_its_slope, 0, 4);
    tcase_add_loop_test(t, a_bolt_ends_anywhere_in_a_block, 0, 2);
    tcase_add_test(t, what_moves_a_stiff_support_is_not_in_its_force);
    tcase_add_loop_test(t, a_slow_press_bears_what_its_springs_do, 0, 3);
    tcase_add_loop_test(t, a_pin_lets_turn_and_carries_what_a_hinge_does, 0, 2);
    tcase_add_test(t, the_work_of_supports_in_a_jump_that_is_tried_again_counts_once);
    tcase_add_loop_test(t, statics_does_not_guess_what_a_support_pushes, 0, 2);
    tcase_add_loop_test(t, elements_that_meet_at_a_node_share_what_pulls_there, 0, 2);
    tcase_add_test(t, a_pin_that_moves_bears_what_its_support_does);
    tcase_add_loop_test(t, stiff_bolts_bear_in_statics_what_balance_says, 0, 2);
    tcase_add_loop_test(t, a_body_that_bears_nothing_from_outside_balances_whatever_its_size, 0, 4);
    tcase_add_loop_test(t, a_bolt_within_one_body_moves_it_nowhere, 0, 3);
    tcase_add_test(t, a_bolt_pulls_alike_whether_hits_give_back_or_not);
    tcase_add_loop_test(t, a_support_that_hardly_moves_changes_no_hit, 0, 2);
    tcase_add_loop_test(t, a_restitution_changes_no_lift_by_a_support, 0, 6);
    tcase_add_test(t, a_support_that_is_gone_leaves_no_force_to_a_bolt);
    return s;
}
