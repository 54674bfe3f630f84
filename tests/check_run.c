/* check_run.c - ./bbm once, on a model with every statement but `static`: it reads each of them,
 * and writes every file with its columns and rows; and on models of which it is known what came of
 * them before. All else that it does is in check_model.c, check_statements.c, check_files.c and
 * check_pictures.c. */
#define _POSIX_C_SOURCE 200809L
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "programs.h"

/* A plate of the mesh, held at the left; a wall on a base; a ball that falls. */
static const char model[] =
    "title every statement\nlet g 10\nplane stress\ngravity 0 -$g\nshake 0 0 1\n"
    STEEL "mesh ../../tests/mesh/square22.msh\nuse steel on plate\n"
    "node 11 10 10\nnode 12 11 10\nnode 13 11 11\nelement 7 ball steel 11 12 13\n"
    "block base steel -1 -2 3 -2 3 -1 -1 -1\nfixblock base\n"
    "grid wall steel 0 -1 1 -0.5 2 1\nset tip nodes 2 3\nset tip add 2\nfix set left\n"
    "load set tip of plate 10 0\ntraction set wall.right 1 0\npressure set wall.left 1\n"
    "water set wall.top -0.4\nvelocity ball 1 0\nstress plate 1 2 3\nbodyforce wall 0 1\n"
    "contact friction 30\njoint wall base friction 20\n"
    "bond alpha 100\npcg omega 1\nrotation exact\n"
    "dynamic dt 0.001 steps 2 settle 1\n"
    "monitor low at 10 10\nmonitor held support set left\nexpect low v -2.5e-5 within 1e-12\nexpect low moves by 1e-3\n"
    "output every 1 svg vtk balance field s1\n";         /* v: g dt^2/2 of settling, g (2 dt)^2/2 */

/* rows: -1, any number from one on. */
static const struct { const char *file, *first; int rows; } written[] = {
    { "nodes.csv", "node,block,x,y,u,v,sxx,syy,sxy,mises,sxx_fit,syy_fit,sxy_fit", 17 },
    { "elements.csv", "element,block,x,y,u,v,rotation,sxx,syy,sxy,mises,vx,vy,spin", 6 },
    { "contacts.csv", "corner_block,edge_block,x,y,state,normal,shear,gap", -1 },
    { "reactions.csv", "node,x,y,fx,fy", 6 },
    { "balance.csv", "block,element,force,force_share,moment,moment_share,breach,breach_share", 4 },
    { "history.csv", "step,t,low_u,low_v,held_fx,held_fy", 3 },
    { "summary.csv", "step,t,open_close,pcg_iterations,residual,contacts,kinetic,elastic,springs,"
      "external,gained", 2 },
    { "timing.csv", "phase,seconds", 7 },
    { "contacts.svg", "<?xml version=\"1.0\" encoding=\"UTF-8\"?>", -1 },
    { "movie.svg", "<?xml version=\"1.0\" encoding=\"UTF-8\"?>", -1 },
    { "history.svg", "<?xml version=\"1.0\" encoding=\"UTF-8\"?>", -1 },
    { "s1.svg", "<?xml version=\"1.0\" encoding=\"UTF-8\"?>", -1 },
    { "step_000000.vtk", "# vtk DataFile Version 3.0", -1 },
    { "step_000001.vtk", "# vtk DataFile Version 3.0", -1 },
    { "step_000002.vtk", "# vtk DataFile Version 3.0", -1 },
    { "contacts_000000.vtk", "# vtk DataFile Version 3.0", -1 },
    { "contacts_000001.vtk", "# vtk DataFile Version 3.0", -1 },
    { "contacts_000002.vtk", "# vtk DataFile Version 3.0", -1 },
    { "K.mtx", "%%MatrixMarket matrix coordinate real symmetric", -1 },
    { "K.mtx.rhs", "%%MatrixMarket matrix array real general", 37 },
    { "K.mtx.mass", "%%MatrixMarket matrix coordinate real symmetric", 127 },
};

static void run_all(void)
{
    shell("rm -rf out/quick; mkdir -p out/quick out/model");
    write_text("out/quick/all.model", model);
    const int status = shell("%s/bbm -q out/quick/all.model -o out/quick/all -m out/quick/all/K.mtx"
                             " > out/quick/said 2>&1", BUILD);
    ck_assert_msg(status == 0, "%d: %s", status, slurp("out/quick/said"));
}

START_TEST(a_model_with_every_statement_leaves_every_file_with_its_rows)
{
    char path[100], line[LONG];
    int rows = 0;

    snprintf(path, sizeof path, "out/quick/all/%s", written[_i].file);
    FILE *f = fopen(path, "r");
    ck_assert_msg(f && fgets(line, sizeof line, f), "%s is not there", path);
    line[strcspn(line, "\n")] = '\0';
    ck_assert_str_eq(line, written[_i].first);
    while (fgets(line, sizeof line, f))
        rows++;
    fclose(f);
    ck_assert_msg(written[_i].rows < 0 ? rows > 0 : rows == written[_i].rows, "%s: %d rows", path,
                  rows);
}
END_TEST

START_TEST(it_leaves_no_other_file)
{
    shell("ls out/quick/all | wc -l > out/quick/count");
    ck_assert_int_eq(atoi(slurp("out/quick/count")), sizeof written / sizeof *written);
}
END_TEST

/* It says nothing of right or wrong, see kept.sh. */
START_TEST(what_came_of_many_models_is_what_came_of_them_before)
{
    ck_assert_msg(shell("mkdir -p out && sh tests/kept.sh %s/bbm > out/kept.said 2>&1", BUILD) == 0,
                  "%s", slurp("out/kept.said"));
}
END_TEST

Suite *run_suite(void)
{
    Suite *s = suite_create("run");
    TCase *t = new_case(s, "run");

    tcase_add_unchecked_fixture(t, run_all, NULL);
    tcase_add_loop_test(t, a_model_with_every_statement_leaves_every_file_with_its_rows, 0,
                        COUNT(written));
    tcase_add_test(t, it_leaves_no_other_file);
    TCase *kept = new_case(s, "kept");
    tcase_set_timeout(kept, 120);           /* s: the models take three, more with sanitizers */
    tcase_add_test(kept, what_came_of_many_models_is_what_came_of_them_before);
    return s;
}
