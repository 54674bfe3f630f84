/* check_statements.c - what statements of model files mean: sets, grids and places, numbers with a name, what a model
 * expects of itself, limits, and warnings of what is hardly meant. */
#define _POSIX_C_SOURCE 200809L
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "programs.h"

/* Both sides of limits: 0.02 degrees from the least friction angle of the slope by limit equilibrium,
 * 38.13392 degrees (the side below is in doc/lab.md), with water 39.0063; g (sin a, -cos a) with a thousandth more and less than the wall's 28.98456
 * degrees; the spread of 0.589 m to each side at which the arch falls by limit analysis; the spin
 * that gives the first domino energy enough; half a per cent of the arch's least thickness, by
 * doc/thrust.awk; a wall of friction 0.7 on a table that is shaken with 0.8 g; Kirsch's tunnel; a drop rebounds by
 * theory, whatever dt. `rotation exact` alone leads a corner to its place, whatever the step. */
static const struct { const char *model, *lets; int status; } limits[] = {
    { "tunnel", "", 0 }, { "slope", "-d phi=38.15392", 0 },
    { "tilt", "-d gx=4.75801059 -d gy=-8.57889475 -d dt=0.004", 3 },
    { "tilt", "-d gx=4.74932844 -d gy=-8.58370429 -d dt=0.004", 0 },
    { "spread", "-d half=0.601", 3 }, { "spread", "-d half=0.577", 0 },
    { "dominoes", "-d spin=-1.45", 3 }, { "dominoes", "-d spin=-1.6", 0 },
    { "turning", "", 0 }, { "turning", "-d dt=0.001 -d steps=2000", 0 }, { "tunnel", "-d K=2 -d q=0", 0 },
    { "arch", "-d n=9 -d t=1.010 -d steps=200", 3 }, { "arch", "-d n=9 -d t=1.020 -d steps=200", 0 },
    { "arch", "-d n=16 -d t=1.066 -d steps=200", 3 }, { "arch", "-d n=16 -d t=1.077 -d steps=200", 0 },
    { "wall", "-d A=8 -d courses=4 -d bricks=8", 3 },
    { "slope", "-d wet=0.5 -d phi=38.98", 3 }, { "slope", "-d wet=0.5 -d phi=39.02", 0 },
    { "drop", "", 0 }, { "drop", "-d dt=0.001", 0 }, { "drop", "-d dt=0.0002", 0 }, { "drop", "-d dt=0.00005", 0 },
};

START_TEST(a_shipped_model_stands_to_its_limit_and_falls_beyond)
{
    ck_assert_int_eq(run_with(limits[_i].model, limits[_i].lets), limits[_i].status);
    /* The push by limit equilibrium; above the limit not all joints slip. */
    if (_i == 1)
        ck_relative(sum("slope", "contacts.csv", "normal", "^c6,c7,")
                        + sum("slope", "contacts.csv", "normal", "^c7,c6,"),
                    4803220, 5e-3);
}
END_TEST

/* Between bounds that bisection narrows to a thousandth of where it began: a; atan(k); the formula of
 * topple.model. A block that leans a little on its springs has a limit up to 0.07 % away. */
static const struct { const char *call; double limit, within; } found[] = {
    { "topple.model --find phi 10 40", 20, 0.05 },
    { "topple.model --find phi 40 10 -d a=25", 25, 0.05 },
    { "topple.model -d phi=60 --find a 10 40", 26.5651, 0.05 },
    { "topple.model -d k=1 -d phi=60 --find a 30 60", 45, 0.15 },      /* its springs sway */
    { "topple.model -d a=40 -d sway=1 --find phi 20 40", 29.9808, 0.05 },
    { "topple.model -d a=60 -d sway=1 --find phi 20 60", 35.9393, 0.05 },
    { "conveyor.model --find phi 5 20", 10, 0.015 },
    { "conveyor.model -d a=20 --find phi 10 40", 20, 0.03 },
    { "keyblock.model --find part 0.9 1.1", 1, 1e-3 },
    { "bolted.model --find part 0.9 1.1", 1, 1e-3 }, { "bolted.model -d pull=0.9 --find part 0.9 1.1", 1, 1e-3 },
    { "portal.model --find part 0.9 1.1", 1, 1e-3 }, { "portal.model -d b=0.8 --find part 0.9 1.1", 1, 1e-3 },
    { "portal.model -d span=3 -d t=0.3 -d h=3 --find part 0.9 1.1", 1, 1e-3 },
    { "water.model --find part 0.9 1.1", 1, 1e-3 }, { "retaining.model --find part 0.9 1.1", 1, 1e-3 },      /* both turn */
    { "retaining.model -d phi=20 --find part 0.9 1.1", 1, 1e-3 },   /* slides */
};

START_TEST(a_limit_is_found_by_bisection)
{
    ck_assert_int_eq(shell("%s/bbm -q cases/models/%s > out/model/said", BUILD, found[_i].call), 0);
    const char *said = slurp("out/model/said");
    ck_assert_msg(strstr(said, "; 12 runs\n"), "%s", said);
    ck_near(strtod(strstr(said, " = ") + 3, NULL), found[_i].limit, 1, found[_i].within);
}
END_TEST

/* Both ends alike; no expectation; no such let; a number that it cannot be; no file. */
START_TEST(what_has_no_limit_is_said)
{
    static const struct { const char *call; int status; const char *said; } table[] = {
        { "topple.model --find phi 30 40", 3, "the expectations are met at phi = 30 and 40, 2 runs; expected" },
        { "exp1.model --find phi 3 4", 2, "'phi=3' of -d or --find, expected NAME=VALUE with a name of a `let`; " },
        { "topple.model --find phi 30 x", 2, "--find needs two numbers, not x;" },
        { "topple.model -d phi=3 --find phi 10 20", 2, "-d or --find give 'phi' twice" },
        { "topple.model --find phi 1 2 --find a 3 4", 2, "expected --find NAME LOW HIGH, once;" },
        { "topple.model -d phi 30", 2, "-d NAME=VALUE in one word;" },
        { "topple.model --find phi 30", 2, "expected --find NAME LOW HIGH, once" },
        { "arch.model --find n 15 20", 3, "" }, { "topple.model --find phi 80 90", 2, "friction is 90, from $phi" },
        { "topple.model --find phi 10 20 -o x", 2, "--find reads a file again and writes none" },
    };

    for (size_t k = 0; k < sizeof table / sizeof *table; k++) {
        ck_assert_int_eq(shell("%s/bbm -q cases/models/%s > out/model/said 2>&1", BUILD, table[k].call),
                         table[k].status);
        check_text("out/model/said", table[k].said);
    }
}
END_TEST

/* What runs, and is hardly meant: the line that takes the place of one of these, and what is said. */
#define STONE TWO "block stone rock 4 1 5 1 5 2 4 2\n"
#define REST "gravity 0 -9.81\ndynamic dt 0.01 steps 2\ncontact friction 30\n"
#define SLABS(ledge, round) ROCK "block a rock 0 0 2 0 2 1 0 1\nblock b rock 2 0 4 0 4 " ledge " 2 " ledge "\nfixblock a\nfixblock b\n" \
    "block c rock 0.5 1 1.5 1 1.5 2 0.5 2\ngravity 0 -9.81\ndynamic dt 0.01 steps 2\ncontact friction 30" round "\n"
#define FALLS "block b rock 0 0 1 0 1 1\ngravity 0 -10\ndynamic dt 0.01 steps 2\n" ROCK
#define PAIR FALLS "block c rock 0 0 1 1 0 1\nfixblock b\n"
#define ROD "material a E 2e11 nu 0.3 density 7800 thickness 0.5\ngrid rod a 0 0 10 0.5 20 1\nfix set rod.left\nstatic\n"
#define CELLS(a, b, c, d, e, f) ROCK "node 1 " a " 0\nnode 2 " b " 0\nnode 3 " c " 0\nnode 4 0 1\nnode 5 4 1\nnode 6 8 1\nnode 7 " d \
    " 2\nnode 8 " e " 2\nnode 9 " f " 2\nelement 1 b rock 1 2 5 4\nelement 2 b rock 2 3 6 5\nelement 3 b rock 4 5 8 7\n" \
    "element 4 b rock 5 6 9 8\nfix node 1\nfix node 4\nfix node 7\nload node 9 0 -1\nstatic\n"
/* On a slope of 30 degrees; far from the origin: the last digit of 30 m times kn is 0.7 % of its weight. */
#define PEBBLE ROCK "block base rock 0 -1 30 -1 30 0 0 0\nfixblock base\nblock b rock 20 0 20.01 0 20.01 0.01 20 0.01\n" \
    "gravity $(9.81*tan(30)) -9.81\ndynamic dt 0.01 steps 20\n"

static const char slips[] = "warning: no friction between blocks: `contact friction DEGREES` gives it";

#define PIER(n) ROCK "block pier rock 0 -1 1 -1 1 0 0 0\nfix at 0 -1\nfix at 1 -1\ngrid slab rock -1 0 2 1 $(3*" #n ") 1\n" \
    "gravity 0 -9.81\ncontact friction 30\ndynamic dt 0.01 steps 1 settle 20\n"

static const struct { const char *text, *said; } doubtful[] = {
    { FALLS, "nothing is fixed: under gravity all blocks fall; fixblock or fix holds them" }, { FALLS "fix at 0 0\n", NULL },
    { FALLS "fixblock b\n", NULL }, { PAIR, slips }, { PAIR "contact kn 1e9\n", slips }, { PAIR "contact friction 0\n", NULL },
    { PAIR "contact friction 30\n", NULL }, { PAIR "contact kn 0\n", NULL }, { PAIR "joint b c\n", ":7: warning: this joint" },
    { SLABS("1.001", ""), "corners of blocks 'a' and 'b' are less apart than they are rounded by" },
    { SLABS("1.003", ""), NULL }, { SLABS("1.001", " round 0"), NULL },
    /* beside a hollow of one block */
    { ROCK "block base rock -4 -1 8 -1 8 0 0 0 0 2e-5 -4 2e-5\nfixblock base\nblock b rock 1e-6 0 1 0 1 1 1e-6 1\n"
      "gravity 0 -9.81\ncontact friction 20 round 0.002\ndynamic dt 0.01 steps 1\n", NULL },
    { ROD "load set rod.right 0 1\noutput film\n", ":6: warning: statics has no film" },
    /* turns by P L^2/(2 E I): 0.05, 0.19 */
    { ROD "load set rod.right 0 1e6\n", NULL }, { ROD "load set rod.right 0 4e6\n", "elements turn by more than 0.1 rad "
      "in the last step, which statics takes as small: lengths are wrong; more steps help" },
    /* a round side of six coarse cells on a base of six, pressed until nearly all of it would touch: one step misses a corner */
    { "material r E 1e9 nu 0.2 density 2500\nplane strain\ncontact friction 20\nrepeat i 0 6\nnode $(i+1) $(0.8*(i/3-1)) "
      "$(0.32*(i/3-1)^2)\nnode $(i+8) $(0.8*(i/3-1)) 0.8\nnode $(i+15) $(0.8*(i/3-1)) -0.8\nnode $(i+22) $(0.8*(i/3-1)) 0\nend\n"
      "repeat i 1 6\nelement $i punch r $i $(i+1) $(i+8) $(i+7)\nelement $(i+6) floor r $(i+14) $(i+15) $(i+22) $(i+21)\nend\n"
      "set bot nodes 15 16 17 18 19 20 21\nset top nodes 8 9 10 11 12 13 14\nfix set bot\nfix set top x\n"
      "load set top 0 -2.1206e8\nstatic\n", "contacts are missing: blocks overlap: step 2: a corner of block 'punch' passed" },
    /* a pier of one side under four cells and under two */
    { PIER(4), "the finer block 'slab' touches block 'pier' at points 1 m apart alone, and sags between them" },
    { PIER(2), NULL },
    /* The step is short beside the swing of the beam, 0.1 s; and long. */
    { ROCK "grid a rock 0 0 10 1 10 1\nfix set a.left\ngravity 0 -9.81\ndynamic dt 0.001 steps 9 velocity_factor 0\n",
      "warning: the run is not at rest: element 5 of block 'a' moves by " },
    { ROCK "grid a rock 0 0 10 1 10 1\nfix set a.left\ngravity 0 -9.81\ndynamic dt 1 steps 9 velocity_factor 0\n", NULL },
    /* strain f/E = 0.2, 0.02 */
    { ROD "traction set rod.right 4e10 0\n", "elements strain by up to 0.2, which statics takes as small: displacements are large beside the model; is E in Pa?" },
    { ROD "traction set rod.right 4e9 0\n", NULL },
    { "let angle $(sin(pi/6))\n" STONE REST, ":1: warning: sin of 0.523599, with pi: angles are in degrees" },
    { "let angle $(sin(180/pi*0.1) + pi*cos(30))\n" STONE REST, NULL },
    /* two squares, of which the second has nodes of its own on the side between them */
    { ROCK "node 1 0 0\nnode 2 1 0\nnode 3 1 1\nnode 4 0 1\nnode 5 1 0.5\nnode 6 2 0.5\nnode 7 2 1.5\nnode 8 1 1.5\n"
      "element 1 b rock 1 2 3 4\nelement 2 b rock 5 6 7 8\nfix set b\ngravity 0 -9.81\nstatic\n",
      "warning: node 3 of block 'b' lies on its side from node 8 to 5, not as its end: there is neither a bond nor a contact; blocks of their own touch" },
    { TWO "block stone rock 4 1.001 5 1.001 5 2 4 2\n" REST, "warning: between blocks 'base' and 'stone' there is a gap of 0.001 m (1 of 1)\n" },
    { TWO "block a rock 4 3 5 3 5 4 4 4\nblock b rock 5 3 6 3 6 4 5 4\n" REST, "block 'a' touches nothing held: it falls (1 of 2)\n" },
    { STONE "block t rock 5.001 1 6 1 6 2 5.001 2\n" REST, "between blocks 'stone' and 't' there is a gap of 0.001 m (1 of 1)\n" },
    { STONE "block t rock 5.02 1 6 1 6 2 5.02 2\n" REST, NULL }, { STONE "block t rock 5 1 6 1 6 2 5 2\n" REST, NULL },
    { STONE "dynamic dt 0.01 steps 2\ncontact friction 30\n", "nothing loads the model; " },
    { STONE "gravity 6 8\ndynamic dt 0.01 steps 2\ncontact friction 30\n", NULL },
    { STONE "gravity 9.81 0\ndynamic dt 0.01 steps 2\ncontact friction 30\n", "gravity is not downward; " },
    { STONE "gravity 0 9.81\ndynamic dt 0.01 steps 2\ncontact friction 30\n", "gravity is not downward; " },
    { STONE REST "stage up\ngravity 0 9.81\nend\nstage on\nend\n", "model: warning: stage up: gravity is not downward; " },
    { STONE REST "stage oops remove base\nend\n", "model: warning: stage oops: nothing is fixed: under gravity all blocks fall" },
    { STONE REST "shake 4 0 200\n", "a step of 0.01 s is long: the period of shake is 0.0314 s\n" }, { STONE REST "shake 4 0 99\n", NULL },
    { STONE REST "shake ../../tests/late.csv\n", "shake has 3 rows from 100 s to 102 s and the scale 1: steps of 0.01 s to 0.02 s do not" },
    { STONE REST "block cap rock 4 2 5 2 5 3 4 3\nmonitor j joint cap base\nmonitor k joint cap stone\n", "warning: monitor j: nothing touched in its joint\n" },
    { STONE "gravity 0 -9.81\ndynamic dt 1e-5 steps 99 settle 9\ncontact friction 30\n", "settling is not at rest: element 2 of block 'stone' moves by " },
    { STONE "gravity 0 -9.81\ndynamic dt 1 steps 2\ncontact friction 30\n", "a step of 1 s is long: a block falls by its size in 0.45 s" },
    { STONE "grid fly rock 20 5 21 6 3 2\nvelocity fly 1e-4 0\ndynamic dt 200 steps 2\ncontact friction 30\n", "takes momentum of block 'fly', whose bonds are so stiff\n" },
    { STONE "gravity 0 -9.81\ndynamic dt 0.01 steps 2\ncontact friction 30 restitution 0.5 tension 1e5\n", "with restitution a hit pulls at a joint" },
    { STONE "gravity 0 -9.81\ndynamic dt 0.01 steps 2\ncontact friction 30 restitution 0.5\njoint * * tension 1e5\n",
      "with restitution a hit pulls at a joint by its impulse over dt: dt decides whether tension bears it; without restitution springs do\n" },
    { STONE "gravity 0 -9.81\ndynamic dt 0.01 steps 2\ncontact friction 30 restitution 0.5 cohesion 1e5\n", NULL },
    { STONE "velocity stone 0 200\ndynamic dt 0.01 steps 2\ncontact friction 30\n", "step 1: element 2 of block 'stone' moved by 2 m, more than its own size" },
    { STONE "gravity 0 -9.81\ndynamic dt 0.01 steps 2\ncontact friction 0.6\n", ":7: warning: a friction of 0.6 degrees; if it is meant as tan(phi), phi is 31 degrees" },
    { STONE REST "monitor far at 50 3\n", ":8: warning: the nearest node, 3 at 10 1, is 40 m away from 50 3" },
    { TWO "block far rock 4 3 5 3 5 4 4 4\nfixblock far\ngravity 0 -9.81\nstatic\n", NULL },
    { "material rock E 1e10 nu 0.2 density 2.5\nblock a rock 0 0 1 0 1 1 0 1\nfixblock a\ngravity 0 -9.81\nstatic\n",
      ":1: warning: a density below 10 kg/m^3 under gravity; is it in kg/m^3?" },
    { "material rock E 1e6 nu 0.2 density 2500\nblock a rock 0 0 1 0 1 1 0 1\nfix at 0 0\nfix at 1 0 y\ngravity 0 -9.81\n"
      "static\n", "its own weight would make block 'a' 2.5 % lower: E is 1e+06; is it in Pa?" },
    { ROCK "grid a rock 0 0 2 1 4 2\ngrid b rock 2 0 4 1 4 2\nfix set a.left\nfix set b.right\ngravity 0 -9.81\n"
      "contact friction 30\nstatic\n", "blocks 'a' and 'b' share a side, not bonded: `bond a b` bonds them, `joint` says that it is meant" },
    { ROCK "grid a rock 0 0 2 1 4 2\ngrid b rock 2 0 4 1 3 3\nfix set a.left\nfix set b.right\ngravity 0 -9.81\n"
      "contact friction 30\nstatic\n", "blocks 'a' and 'b' share a side, not bonded: `bond a b` bonds them, `joint` says that it is meant" },
    { ROCK "grid a rock 0 0 2 1 4 2\ngrid b rock 2 0 4 1 4 2\ngrid c rock 4 0 6 1 4 2\nfix set a.left\nfix set c.right\n"
      "fix at 3 0\nfix at 3 1\ngravity 0 -9.81\ncontact friction 30\nstatic\n", "blocks 'a' and 'b' share a side, not bonded: `bond a b` bonds them, `joint` says that it is meant\n" },
    { ROCK "block b rock 0 0 1 0 1 1 0 1\nfix node 1\nfix node 2\ngravity 0 -9.81\nbond augment 1\ndynamic dt 0.01 steps 9\n",
      "warning: bond augment has no part in dynamics; a larger alpha stiffens bonds\n" },
    { CELLS("0", "3.5", "8", "0", "4.5", "8"), "element 2 of block 'b' is a long trapezoid (1 of 4): where rows of such cells bend, they lock; "
      "shorter cells or parallelograms do not\n" },
    { CELLS("0", "3.5", "8", "0", "4.5", "8") "bond at vertices\n", NULL }, { CELLS("-1", "3", "7", "1", "5", "9"), NULL },
    { CELLS("0", "3.9", "8", "0", "4.1", "8"), NULL },
    { PEBBLE "contact friction 40 kn 3e11\n", "positions have too few digits for kn: their rounding moves the forces of block 'b'" },
    { PEBBLE "contact friction 40 kn 1e11\n", NULL },
    { PEBBLE "contact friction 29.995 kn 1e12\n", "of the forces on a block: "
      "positions have no more digits; a smaller kn or softer bolts help\n" },
    /* before and after its hit nothing bears on a block */
    { "material r E 1e12 nu 0 density 2500\ncontact kn 1e9 friction 20\nblock a r -1.1 0 -0.1 0 -0.1 1 -1.1 1\nvelocity a 1 0\n"
      "block b r 0 0 1 0 1 1 0 1\ndynamic dt 1e-4 steps 3000\n", NULL },
    { "material r E 1e12 nu 0 density 2500\ncontact kn 1e9 friction 0 restitution .5\ndynamic dt 1e-4 steps 1100\n"
      "block a r -1.1 0 -0.1 0 -0.1 1 -1.1 1\nvelocity a 1 0\nblock b r 0 0 1 0 1 1 0 1\nblock c r 1 0 2 0 2 1 1 1\n"
      "block d r 2 0 3 0 3 1 2 1\njoint b c friction 0\njoint c d friction 0\n", NULL },
    /* two pinned bars under 100 kN need k = P (1/1 + 1/1) = 2e5 N/m at their pin, a little more below a top that gives way */
#define BARS(k) "material r E 1e10 nu 0.2 density 2000\nblock b0 r 0 0 0.1 0.5 0 1 -0.1 0.5\nblock b1 r 0 1 0.1 1.5 0 2 -0.1 1.5\n" \
      "block w r 3 0 4 0 4 3 3 3\nfixblock w\npin b0 b1 at 0 1\nfix at 0 0 of b0\nload at 0 2 of b1 0 -1e5\n" \
      "bolt at 0 1 of b0 at 3 1 of w stiffness " k "\nbolt at 0 2 of b1 at 3 2 of w stiffness 1e6\ncontact friction 30\nstatic\n"
    /* a block on two bolts at one corner: the second step ends 1e-4 m off, where bolts of 1 GN/m have 0.3 of its weight too much */
#define HANGS "material r E 1e11 nu 0.2 density 2500\nblock w r -40 20 40 20 40 22 -40 22\nfixblock w\nblock b r 0 0 2 0 2 2 0 2\n" \
      "bolt at 0 0 of b at -4 20 of w stiffness 1e9\nbolt at 0 0 of b at 4 20 of w stiffness 1e9\ngravity 0 -9.81\nstatic steps "
    { HANGS "2\n", "forces lack 0.06 of balance where blocks have come to: more steps help\n" }, { HANGS "3\n", NULL },
    { "material r E 1e11 nu 0 density 2500\nblock w r -40 20 40 20 40 22 -40 22\nfixblock w\nblock b r 0 0 2 0 2 1 0 1\n"
      "bolt at 0 1 of b at -3 20 of w stiffness 1e9\nbolt at 2 1 of b at 4 20 of w stiffness 1e9\ngravity 0 -9.81\nstatic steps 2\n",
      "the last step was 0.018 of the way of all: no equilibrium yet: more steps help\n" },
    { BARS("2.6e5"), NULL },
    { BARS("1.9e5"), "in equilibrium, but not stable: a push, however small, moves it until other contacts stop it, or for good\n" },
    /* a post under water, 3.9 kN heavier than it, is pinned 1.025 m below its centre, and two lines hold it 2 m up:
     * 2 k 2^2 = 3900 1.025 for k = 499.6 N/m */
#define BUOY(k, g, w) "material r E 1e11 nu 0.2 density 2000\nblock b r 0 0 0.1 0.1 0.1 2 -0.1 2 -0.1 0.1\nblock w r 3 1 4 1 4 3 3 3\n" \
      "block v r -3 1 -3 3 -4 3 -4 1\nfixblock v\nfixblock w\nfix at 0 0 of b\ngravity 0 " g "\nwater set b 7 density " w "\nstatic steps 20\n" \
      "bolt at 0.1 2 of b at 3 2 of w stiffness " k "\nbolt at -0.1 2 of b at -3 2 of v stiffness " k "\ncontact friction 30\n"
    { BUOY("490", "-10", "1000"), "in equilibrium, but not stable: a push, however small, moves it until other contacts stop it, or for good\n" }, { BUOY("510", "-10", "1000"), NULL },
    /* in three times as heavy water it stands by its buoyancy */
    { BUOY("5", "-10", "3000"), NULL },
    /* the pressure on top turns with it: it pushes the bar back as far as it leans */
    { BUOY("9", "-1e-9", "1000") "pressure box -1 1.99 1 2.01 1e5\n", NULL },
    /* what hangs on a pin is stable, and what stands on one is not */
    { ROCK "block top rock 0 0 1 1 -1 1\nfixblock top\nblock b rock 0 0 0.3 -1 0 -2 -0.3 -1\npin top b at 0 0\ngravity 0 -9.81\n"
      "contact friction 30\nstatic\n", NULL },
    { ROCK "block top rock 0 0 -1 -1 1 -1\nfixblock top\nblock b rock 0 0 0.3 1 0 2 -0.3 1\npin top b at 0 0\ngravity 0 -9.81\n"
      "contact friction 30\nstatic\n", "in equilibrium, but not stable: a push, however small, moves it until other contacts stop it, or for good\n" },
    { PEBBLE "contact friction 29.995 kn 1e8 ks 1e8\n", NULL },
    /* two leaning columns of two bricks, beyond what they bear as drawn, come to lean on each other: 0.048 m further on */
    { "material m E 1e10 nu 0.2 density 2500\nblock base m -4 -1 6 -1 6 0 -4 0\nfixblock base\n"
      "block a m 0 0 1 0 1.128607 1 0.128607 1\nblock b m 1 0 2 0 2.128607 1 1.128607 1\n"
      "block c m 0.128607 1 1.128607 1 1.257214 2 0.257214 2\nblock d m 1.128607 1 2.128607 1 2.257214 2 1.257214 2\n"
      "gravity 7.83684 -9.81\ncontact friction 40\nstatic\n", "it stands, but not as drawn: blocks slid or turned by 0.042 of their size first\n" },
};

START_TEST(what_is_hardly_meant_is_a_warning_and_said_once)
{
    const int status = run_text("doubtful", doubtful[_i].text);
    const char *said = slurp("out/model/doubtful.err");
    const char *at = doubtful[_i].said ? strstr(said, doubtful[_i].said) : NULL;
    ck_assert_msg(!doubtful[_i].said ? status == 0 && !*said : at && strchr(at, '\n') && strchr(at, '\n')[1] == '\0' && strncmp(said, "out/model/doubtful.model:", 25) == 0,
                  "%s", said);
    const char *same = strstr(said, "share a side");
    ck_assert(!same || !strstr(same + 1, "share a side"));
}
END_TEST

/* No part of the time is negative, and all parts together are no more than all of it, but for digits. */
START_TEST(the_parts_of_the_time_are_shares_of_it)
{
    ck_assert_int_eq(run_text("timed", ROCK "grid a rock 0 0 2 1 60 30\nfix set a.left\ngravity 0 -9.81\nstatic\n"), 0);
    ck_assert_int_eq(shell("awk -F, 'NR > 1 { bad += $2 < 0; sum += $1 == \"total\" ? -$2 : $2 } END { exit bad || sum > 1e-3 }' out/model/timed/timing.csv"), 0);
    ck_assert_double_gt(cell("timed", "timing.csv", "precondition", "seconds"), 0);
}
END_TEST

/* Of both kinds of steps, to the last byte. */
START_TEST(bonds_are_as_stiff_as_the_document_says_unless_the_file_does)
{
    static const char *const how[][2] = { { "static", "bond alpha 100 augment 2" },
                                          { "dynamic dt 0.01 steps 9", "bond alpha 1000" } };

    for (int k = 0; k < 2; k++)
        ck_assert_int_eq(run_printed(k ? "spoken" : "silent", ROCK "grid a rock 0 0 2 1 4 2\nfix set a.left\n"
                                     "gravity 0 -9.81\n%s\n%s\n", how[_i][0], k ? how[_i][1] : ""), 0);
    ck_assert_int_eq(shell("cmp out/model/spoken/nodes.csv out/model/silent/nodes.csv"), 0);
}
END_TEST

START_TEST(shipped_models_give_no_warning)
{
    ck_assert_int_eq(shell("for m in cases/models/*.model; do %s/bbm --check -q $m -o out/model/quiet 2>&1; done "
                           "| grep warning", BUILD), 1);
}
END_TEST

/* ---------------------------------------------------------------------------- blocks and places */

START_TEST(a_grid_has_its_cells_and_its_rim)
{
    static const struct { const char *cut; int elements, nodes; } grid[] = {
        { "", 6, 12 }, { "quads", 6, 12 }, { "triangles", 12, 12 }, { "crossed", 24, 18 },
    };

    ck_assert_int_eq(run_printed("grid",
        ROCK "node 40 9 9\nnode 41 10 9\nnode 42 9 10\nelement 7 a rock 40 41 42\nfixblock a\n"
        "grid g rock 0 0 3 2 3 2 %s\nfix set g.bottom\nfix set g.top x\nfix set g.left\n"
        "fix set g.right y\ngravity 0 -10\nstatic\n", grid[_i].cut), 0);
    ck_assert_int_eq(shell("test $(wc -l < out/model/grid/elements.csv) = %d && test $(wc -l < "
                           "out/model/grid/nodes.csv) = %d", grid[_i].elements + 2,
                           grid[_i].nodes + 4), 0);
    ck_assert_int_eq(shell("grep -q '^43,g,0,0,' out/model/grid/nodes.csv && grep -q '^8,g,' "
                           "out/model/grid/elements.csv"), 0);
    /* 3 of a, all of the rim */
    ck_assert_int_eq(shell("test $(wc -l < out/model/grid/reactions.csv) = 14"), 0);
}
END_TEST

/* Two squares that share an edge, and two blocks of `block` there: of BLOCK takes one. */
START_TEST(a_block_is_the_set_of_its_nodes)
{
    /* a and b share nodes 2 and 3; of those, the set a has two of b. */
    static const char mesh[] = ROCK "node 1 0 0\nnode 2 1 0\nnode 3 1 1\nnode 4 0 1\nnode 5 2 0\nnode 6 2 1\n"
                               "element 1 a rock 1 2 3 4\nelement 2 b rock 2 5 6 3\ngravity 0 -1\n";
    static const struct { const char *where; int status, rows; } table[] = {
        { "set a", 0, 4 }, { "set a of a", 0, 4 }, { "set a of b", 0, 2 }, { "set b of a", 0, 2 },
    };

    ck_assert_int_eq(run_printed("whole",
        "%sfix %s\ndynamic dt 0.01 steps 1\n", mesh, table[_i].where), table[_i].status);
    ck_assert_int_eq(shell("test $(wc -l < out/model/whole/reactions.csv) = %d", table[_i].rows + 1), 0);
}
END_TEST

START_TEST(of_block_takes_the_nodes_of_one_block)
{
    ck_assert_int_eq(run_text("of",
        ROCK "block a rock 0 0 1 0 1 1 0 1\nblock b rock 1 0 2 0 2 1 1 1\nfix set a\n"
        "fix box 1 0 1 1 of b x\ngravity 0 -10\ndynamic dt 0.01 steps 10\nmonitor a at 1 1 of a\n"
        "monitor b at 1 1 of b\nmonitor both at 1 1\ncontact friction 0\n"), 0);
    ck_near(cell("of", "history.csv", "10,", "a_v"), 0, 1, 1e-9);
    ck_relative(cell("of", "history.csv", "10,", "b_v"), -0.05, 1e-3);
    ck_near(cell("of", "history.csv", "10,", "both_v"), 0, 1, 1e-9);
    ck_assert_str_eq(slurp("out/model/of.err"), "out/model/of.model:10: note: 2 nodes lie there, "
                     "node 3 of block 'a' is taken; `of BLOCK` takes another\n");
}
END_TEST

/* --------------------------------------------------------------------- expectations and numbers */

#define FALL ROCK "let g 10\nlet steps 100\nblock a rock 0 0 1 0 1 1 0 1\ngravity 0 -$g\n" \
    "dynamic dt 0.01 steps $steps\nmonitor a at 0 0\n"

START_TEST(what_is_expected_is_compared)
{
    static const struct { const char *expect; int status; const char *said; } table[] = {
        { "a v -5 within 1 %", 0, "a v -5 within 0.05 m; computed: -5 m: ok" },
        { "a v -5 within 1%", 0, "a v -5 within 0.05 m; computed: -5 m: ok" },
        { "a v -5.1 within 0.09", 3, "a v -5.1 within 0.09 m; computed: -5 m: NOT MET" },
        { "a u 0 within 1e-9", 0, "a u 0 within 1e-09 m; computed: " },
        { "a moves by 4", 0, "a moves by more than 4 m; computed: 5 m: ok" },
        { "a moves by 6", 3, "a moves by more than 6 m; computed: 5 m: NOT MET" },
        { "a stays by 6", 0, "a stays by less than 6 m; computed: 5 m: ok" },
        { "a stays by 4", 3, "a stays by less than 4 m; computed: 5 m: NOT MET" },
    };
    char text[LONG];

    snprintf(text, sizeof text, FALL "expect %s\n", table[_i].expect);
    write_text("out/model/fell.model", text);
    ck_assert_int_eq(shell("%s/bbm out/model/fell.model -o out/model/fell > out/model/said 2> "
                           "out/model/err", BUILD), table[_i].status);
    check_text("out/model/said", table[_i].said);
}
END_TEST

START_TEST(a_number_of_the_command_line_takes_the_place_of_let)
{
    write_text("out/model/let.model", FALL "let twice $g\ntitle \033]g is $g\n");
    ck_assert_int_eq(shell("%s/bbm -q out/model/let.model -d g=20 -dsteps=50 -o "
                           "out/model/let 2> out/model/err", BUILD), 0);
    ck_relative(cell("let", "history.csv", "50,", "a_v"), -20 * 0.125, 1e-9);
    ck_assert_int_eq(shell("%s/bbm -q out/model/let.model -d g=20 -d 'steps=$(g + 30)' -o "
                           "out/model/let 2> out/model/err", BUILD), 0);
    ck_relative(cell("let", "history.csv", "", "a_v"), -20 * 0.125, 1e-9);
    ck_assert_int_eq(shell("%s/bbm -q out/model/let.model -d f=20 2> out/model/err", BUILD), 2);
    ck_assert_str_eq(slurp("out/model/err"), "out/model/let.model: 'f=20' of -d or --find, "
                     "expected NAME=VALUE with a name of a `let`, such as g, steps, twice\n");
    ck_assert_int_eq(shell("%s/bbm -q out/model/let.model -d g=1O 2> out/model/err", BUILD), 2);
    ck_assert_str_eq(slurp("out/model/err"), "out/model/let.model:2: not a number: '1O', from -d or --find, "
                                                   "expected: let NAME VALUE\n");
    ck_assert_int_eq(shell("%s/bbm - < out/model/let.model -o out/model/let 2> out/model/err | "
                           "grep -q -- '-: ?]g is 10'", BUILD), 0);
    ck_relative(cell("let", "history.csv", "100,", "a_v"), -5, 1e-9);
    /* A word with many of them costs no more than its length. */
    ck_assert_int_eq(shell("sed -i '/^title/s/.*/title '$(printf '$g%%.0s' $(seq 3000))/ "
                           "out/model/let.model; TEST_ALLOCATIONS=2000 %s/failing/bbm -q "
                           "out/model/let.model -o out/model/let 2> out/model/err", BUILD), 0);
}
END_TEST

START_TEST(arithmetic_has_its_value_to_15_digits)
{
    write_text("out/model/sums.model", "title $(1 + 2*3) $(2^3^2) $(-2^2) $(2^-1) $(7/2 - -1) $((1+2)*3) $t$(t)$a-b "
               "$(a-b) $(a - b) $(0.1+0.2) $(sin(30)) $(cos(90)) $(tan(45)) $(asin(-1)) $(acos(0)) $(atan(1)) "
               "$(sqrt(2)) $(abs(-3)) $(floor(-1.5)) $(min(3,1, 2)) $(max(t, 5)) $(pi) $(1e3) $(-0) $t.left\n"
               "let t 1.5\nlet a 5\nlet b 2\nlet a-b 7\n" ROCK "block x rock 0 0 1 0 1 1\ndynamic dt 1 steps 1\n");
    ck_assert_int_eq(shell("%s/bbm out/model/sums.model -o out/model/sums | head -1 > out/model/said", BUILD), 0);
    ck_assert_str_eq(slurp("out/model/said"), "out/model/sums.model: 7 512 -4 0.5 4.5 9 1.51.57 7 3 0.3 0.5 0 1 "
                     "-90 90 45 1.4142135623731 3 -2 1 5 3.14159265358979 1000 0 1.5.left\n");
}
END_TEST

/* Books of length 1 that each stand out by 1/(2 i): the sum is 25/24. A number for each round, and a set that grows. */
START_TEST(rounds_add_up_numbers_and_sets_and_keep_numbers_by_name)
{
    ck_assert_int_eq(run_text("books", ROCK "let x 0\nlet n 4\nrepeat i 1 $n\nlet x $(x + 1/(2*i))\nlet w$i $(i*i)\n"
                              "let s 0\nrepeat j 1 $i\nlet s $(s + j)\nend\nblock b$i rock $x $s $(x + 1) $s $(x + 1) $(s + 1)\n"
                              "set all add $(3*i - 2) $(3*i - 1)\nend\nrepeat i 1 $n\n"
                              "block c$i rock $(20 + w$i) 0 $(21 + $w$i) 0 $(20 + w$i) 1\nfixblock c$i\nend\n"
                              "let end $(30 + x)\nblock last rock $end 0 $(end + 1) 0 $end 1\nfix set last\nfix set all\n"
                              "gravity 0 -10\ncontact friction 30\nstatic\n"), 0);
    const double sum = 25.0 / 24;
    ck_near(cell("books", "nodes.csv", "10,b4", "x"), sum, 1, 1e-14);
    ck_assert_double_eq(cell("books", "nodes.csv", "10,b4", "y"), 1 + 2 + 3 + 4);
    ck_assert_double_eq(cell("books", "nodes.csv", "22,c4", "x"), 36);
    ck_assert_double_eq(cell("books", "nodes.csv", "23,c4", "x"), 37);
    ck_near(cell("books", "nodes.csv", "25,last", "x"), 30 + sum, 1, 1e-13);
    /* two nodes of each b, three of each c and of the last */
    ck_assert_int_eq(shell("[ $(wc -l < out/model/books/reactions.csv) = %d ]", 1 + 2*4 + 3*4 + 3), 0);
    /* From the command line comes what stands behind a round, but nothing that a round has made. */
    ck_assert_int_eq(shell("%s/bbm -q out/model/books.model -d end=50 -o out/model/books", BUILD), 0);
    ck_assert_double_eq(cell("books", "nodes.csv", "25,last", "x"), 50);
    ck_assert_int_eq(shell("%s/bbm -q out/model/books.model -d w2=7 2> out/model/err", BUILD), 2);
    check_text("out/model/err", "'w2=7' of -d or --find, expected NAME=VALUE with a name of a `let` outside of `repeat`\n");
}
END_TEST

/* A wall in a triangle by rounds, of which the first has none, and by hand. */
START_TEST(what_is_repeated_is_what_stands_there_so_often)
{
    static const char *const by[] = {
        "let n 2\nrepeat j 0 $n\nlet x $(2*j)\nrepeat i 1 $j\nblock v$i-$j rock $x $i $(x + 1) $i $x $(i + 0.5)\n"
        "monitor top$j.$i at $x $i of v$i-$j\nexpect top$j.$i u 1 within $(50*n)%\nend\nend\n",
        "block v1-1 rock 2 1 3 1 2 1.5\nblock v1-2 rock 4 1 5 1 4 1.5\nblock v2-2 rock 4 2 5 2 4 2.5\n",
    };

    for (int k = 0; k < 2; k++) {
        ck_assert_int_eq(run_printed(k ? "hand" : "rounds",
            ROCK "%svelocity v1-1 1 0\nvelocity v1-2 1 0\nvelocity v2-2 1 0\n"
            "dynamic dt 0.1 steps 10\n", by[k]), 0);
    }
    ck_assert_int_eq(shell("cd out/model && cmp rounds/nodes.csv hand/nodes.csv && "
                           "cmp rounds/elements.csv hand/elements.csv"), 0);
    ck_relative(cell("rounds", "history.csv", "10,", "top2.2_u"), 1, 1e-9);
}
END_TEST

START_TEST(a_check_draws_and_computes_nothing)
{
    ck_assert_int_eq(shell("rm -rf out/model/arch_; %s/bbm --check cases/models/arch.model -o "
                           "out/model/arch_ > out/model/said", BUILD), 0);
    check_text("out/model/said", "32 contacts at the start; kn 1e+10 N/m");
    ck_assert_int_eq(shell("test \"$(ls out/model/arch_)\" = model.svg"), 0);
    ck_assert_int_eq(shell("%s/bbm --check cases/models/dam.model -o out/model/arch_ | grep -q "
                           "'friction 0 degrees, 1 joint of other strength$'", BUILD), 0);
}
END_TEST

START_TEST(the_example_of_the_document_runs_when_it_is_pasted)
{
    ck_assert_int_eq(shell("sed -n '/^    # a block/,/^$/s/^    //p' doc/model-file.md > "
                           "out/model/slope.model; test $(wc -l < out/model/slope.model) -gt 10"),
                           0);
    ck_assert_int_eq(shell("%s/bbm out/model/slope.model -o out/model/slope > out/model/said 2> "
                           "out/model/err && ! test -s out/model/err && grep -q 'foot u .*: ok' "
                           "out/model/said", BUILD), 0);
}
END_TEST

Suite *statements_suite(void)
{
    Suite *s = suite_create("statements");
    TCase *t = new_case(s, "statements");

    tcase_add_test(t, the_parts_of_the_time_are_shares_of_it);
    tcase_add_loop_test(t, a_shipped_model_stands_to_its_limit_and_falls_beyond, 0, COUNT(limits));
    tcase_add_loop_test(t, a_limit_is_found_by_bisection, 0, COUNT(found));
    tcase_add_test(t, what_has_no_limit_is_said);
    tcase_add_loop_test(t, what_is_hardly_meant_is_a_warning_and_said_once, 0, COUNT(doubtful));
    tcase_add_loop_test(t, bonds_are_as_stiff_as_the_document_says_unless_the_file_does, 0, 2);
    tcase_add_test(t, shipped_models_give_no_warning);
    tcase_add_loop_test(t, a_grid_has_its_cells_and_its_rim, 0, 4);
    tcase_add_loop_test(t, a_block_is_the_set_of_its_nodes, 0, 4);
    tcase_add_test(t, of_block_takes_the_nodes_of_one_block);
    tcase_add_loop_test(t, what_is_expected_is_compared, 0, 8);
    tcase_add_test(t, a_number_of_the_command_line_takes_the_place_of_let);
    tcase_add_test(t, arithmetic_has_its_value_to_15_digits);
    tcase_add_test(t, what_is_repeated_is_what_stands_there_so_often);
    tcase_add_test(t, rounds_add_up_numbers_and_sets_and_keep_numbers_by_name);
    tcase_add_test(t, a_check_draws_and_computes_nothing);
    tcase_add_test(t, the_example_of_the_document_runs_when_it_is_pasted);
    return s;
}
