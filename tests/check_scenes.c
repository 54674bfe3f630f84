/* check_scenes.c - scenes that nobody has looked at, a few of each kind, and what must hold in every step of them; `make
 * torture` tries as many as one likes. The bounds and their reasons are in trial.c. Before that, the oracle itself: the
 * ledger against closed forms, and the generator, which must give the same scene on each machine. */
#include <stdio.h>
#include <string.h>

#include "check.h"
#include "scenes.h"

enum { SEEDS = 10, TWIN_SEEDS = 5 };

/* ------------------------------------------------------------------------------------------------- the oracle */

/* The first outputs from 0 that its authors publish. */
START_TEST(the_generator_of_random_numbers_is_splitmix64)
{
    uint64_t state = 0;

    ck_assert(scene_random(&state) == 0xe220a8397b1dcdafu);
    ck_assert(scene_random(&state) == 0x6e789e6aa1b965f4u);
}
END_TEST

/* A free plate of w x h that flies and spins, strained and stressed. */
static bbm_model *plate(double w, double h, double x, double y)
{
    const bbm_material rock = { 1e9, 0.25, 2000, 0.5 };
    bbm_model *m = beyond_model();

    bbm_add_material(m, &rock, NULL);
    for (int k = 0; k < 4; k++)
        bbm_add_node(m, x + (k == 1 || k == 2 ? w : 0), y + (k > 1 ? h : 0), NULL);
    bbm_add_element(m, 0, 0, 4, (int[]){ 0, 1, 2, 3 }, NULL);
    ck_ok(bbm_prepare(m), m);
    return m;
}

/* Energies m v^2/2 + J r^2/2 + m/24 (ex^2 w^2 + ey^2 h^2) and s^2/(2 E), J = m (w^2 + h^2)/12. */
START_TEST(the_ledger_knows_a_plate_that_spins_and_stretches)
{
    const double w = 2, h = 3, mass = 2000 * 0.5 * w * h, J = mass * (w * w + h * h) / 12;
    bbm_model *m = plate(w, h, 4, 5);
    bbm_element *e = &m->element[0];
    scene_ledger l;

    memcpy(e->V, (double[6]){ 3, -2, 1.5, 0.25, -0.5, 0 }, sizeof e->V);
    e->stress[0] = 1e6;
    scene_balance(m, &l);
    ck_relative(l.kinetic, mass * 13 / 2 + J * 2.25 / 2 + mass / 24 * (w * w / 16 + h * h / 4), 1e-14);
    ck_relative(l.elastic, 1e12 / 2e9 * w * h * 0.5, 1e-14);
    ck_relative(l.P[0], 3 * mass, 1e-14);
    ck_relative(l.P[1], -2 * mass, 1e-14);
    ck_relative(l.L, mass * (5 * -2 - 6.5 * 3) + J * 1.5, 1e-14);
    ck_assert(l.springs == 0);
}
END_TEST

/* The library adds up its energies in another way: they agree after some steps of bonded blocks, of all bonds. */
START_TEST(the_ledger_and_the_library_agree)
{
    test_scene s;
    bbm_model *m;
    bbm_energy energy;
    scene_ledger l;

    scene_make(100 + 2 * (uint64_t)_i, SCENE_BONDED, &s);
    s.bonding = _i ? BBM_VERTICES : BBM_MOMENT;
    ck_ok(scene_build(&s, &m), m);
    for (int k = 0; k < 20; k++)
        ck_ok(bbm_step(m), m);
    bbm_energies(m, &energy);
    scene_balance(m, &l);
    ck_assert(l.springs > 0);
    ck_near(l.kinetic, energy.kinetic, energy.kinetic, 1e-3);       /* the library's geometry is that of the step's start */
    ck_near(l.elastic, energy.elastic, energy.elastic, 1e-12);
    ck_near(l.springs, energy.springs, energy.springs, 1e-6);
    release(m);
}
END_TEST

START_TEST(blocks_begin_beside_each_other)
{
    test_scene s;
    bbm_model *m;
    scene_ledger l;

    for (uint64_t seed = 0; seed < 30; seed++) {
        scene_make(seed, _i, &s);
        ck_ok(scene_build(&s, &m), m);
        scene_balance(m, &l);
        scene_overlap(m, (double[SCENE_BLOCKS][SCENE_BLOCKS]){ { 0 } }, &l);
        ck_assert_msg(l.overlap < 1e-14, "%s, seed %d: %g", scene_name(s.kind), (int)seed, l.overlap);
        release(m);
    }
}
END_TEST

/* ------------------------------------------------------------------------------------------------- the scenes */

static void check_rules(const test_scene *s, const scene_trial *t)
{
    for (int r = 0; r < RULES; r++)
        ck_assert_msg(t->peak[r].steps == 0, "seed %d, %s: %s %g in step %d, at most %g", (int)s->seed, scene_name(s->kind),
                      scene_rule[r].text, t->peak[r].most, t->peak[r].step, scene_rule[r].bound);
}

static void make(int i, int seeds, test_scene *s) { scene_make((uint64_t)(1 + i % seeds), i / seeds, s); }

START_TEST(no_step_of_any_scene_fails_or_makes_energy_or_momentum_or_lets_blocks_overlap)
{
    test_scene s;
    scene_trial t;

    make(_i, SEEDS, &s);
    scene_try(&s, 0, &t);
    ck_assert_msg(t.status == BBM_OK || t.status == BBM_TOO_SOFT, "seed %d, %s: %s", (int)s.seed, scene_name(s.kind), t.message);
    check_rules(&s, &t);
}
END_TEST

/* Scenes that once showed a fault: a line that was closed loses to one behind it; two lines block each other; one of the two
 * contacts of a flush joint is dropped; a corner slides along a bent side; a block that leans loses its closed contact; a
 * corner opens inside and comes back; a grid point lies in a hollow; a contact cannot come back beyond the end
 * of its edge; an edge is longer at the end of the step; a corner passes while another one of its block is held, or comes
 * in over a line on which it is neither at the start nor at the end of the step; two corners pass each other in a step. */
static const struct { int kind, seed; } FAULTS[] = {
    { SCENE_BOX, 4 }, { SCENE_BOX, 437 }, { SCENE_WALL, 404 }, { SCENE_BONDED, 182 }, { SCENE_WALL, 63 },
    { SCENE_CORNERS_MEET, 660 }, { SCENE_STACK, 18 },
    { SCENE_BOX, 735 }, { SCENE_BOX, 296 }, { SCENE_WALL, 10156 }, { SCENE_BOX, 1503 }, { SCENE_CLOUD, 10496 },
    { SCENE_STACK, 10039 }, { SCENE_BOX, 512 }, { SCENE_WALL, 722 },
};

START_TEST(scenes_that_once_showed_a_fault_show_none)
{
    test_scene s;
    scene_trial t;

    scene_make((uint64_t)FAULTS[_i].seed, FAULTS[_i].kind, &s);
    scene_try(&s, 0, &t);
    ck_assert_msg(t.status == BBM_OK, "%s", t.message);
    check_rules(&s, &t);
}
END_TEST

static void check_twin(int i, int rule)
{
    test_scene s;
    scene_trial t = { .status = BBM_OK };

    make(i, TWIN_SEEDS, &s);
    if (rule == RULE_FAR)
        scene_try_twin(&s, RULE_ORDER, &t);
    scene_try_twin(&s, rule, &t);
    check_rules(&s, &t);
}

START_TEST(a_scene_in_units_of_powers_of_two_is_the_same_to_the_last_bit) { check_twin(_i, RULE_BITS); } END_TEST
START_TEST(a_scene_in_other_units_is_the_same) { check_twin(_i, RULE_UNITS); } END_TEST
START_TEST(a_scene_in_another_order_is_the_same) { check_twin(_i, RULE_ORDER); } END_TEST
START_TEST(a_scene_in_another_frame_is_the_same) { check_twin(_i, RULE_FRAME); } END_TEST
START_TEST(a_stone_far_away_does_not_matter) { check_twin(_i, RULE_FAR); } END_TEST

/* Walls in which bricks lie as far from each other as what once was a share of the mean edge of all
 * blocks, the stone's among them. */
START_TEST(the_size_of_a_stone_far_away_does_not_matter)
{
    static const uint64_t seed[] = { 1153, 1571, 1881, 2081 };
    test_scene s;
    scene_trial t = { .status = BBM_OK };

    scene_make(seed[_i], -1, &s);
    scene_try_twin(&s, RULE_FAR, &t);
    check_rules(&s, &t);
}
END_TEST

Suite *scenes_suite(void)
{
    Suite *s = suite_create("scenes");

    add_case(s, "ledger",
        { the_generator_of_random_numbers_is_splitmix64, 1 },
        { the_ledger_knows_a_plate_that_spins_and_stretches, 1 },
        { the_ledger_and_the_library_agree, 2 },
        { blocks_begin_beside_each_other, SCENE_KINDS });
    add_case(s, "torture",
        { no_step_of_any_scene_fails_or_makes_energy_or_momentum_or_lets_blocks_overlap,
          SEEDS * SCENE_KINDS },
        { scenes_that_once_showed_a_fault_show_none, COUNT(FAULTS) });
    add_case(s, "twins",
        { a_scene_in_units_of_powers_of_two_is_the_same_to_the_last_bit, TWIN_SEEDS * SCENE_KINDS },
        { a_scene_in_other_units_is_the_same, TWIN_SEEDS * SCENE_KINDS },
        { a_scene_in_another_order_is_the_same, TWIN_SEEDS * SCENE_KINDS },
        { a_scene_in_another_frame_is_the_same, TWIN_SEEDS * SCENE_KINDS },
        { a_stone_far_away_does_not_matter, TWIN_SEEDS * SCENE_KINDS },
        { the_size_of_a_stone_far_away_does_not_matter, 4 });
    return s;
}
