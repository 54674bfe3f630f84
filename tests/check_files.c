/* check_files.c - the programs and what they write: that the matrix of -m is that of the results; that
 * a file which cannot be written, memory that is short, a second run in the same folder or Ctrl-C cost as
 * little as they can and are never silent; that runs leave nothing behind. */
#define _POSIX_C_SOURCE 200809L
#include <dirent.h>
#include <fcntl.h>
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "models.h"
#include "programs.h"

static int is_there(const char *path) { return access(path, F_OK) == 0; }

/* Whether a folder has a file whose name ends like this, or one of no bytes. */
static int has_file(const char *folder, const char *ending, int empty)
{
    DIR *d = opendir(folder);
    struct dirent *entry;
    struct stat s;
    int found = 0;

    while (d && (entry = readdir(d)) != NULL) {
        char path[600];
        const size_t n = strlen(entry->d_name), e = strlen(ending);
        snprintf(path, sizeof path, "%s/%s", folder, entry->d_name);
        found |= n >= e && strcmp(entry->d_name + n - e, ending) == 0 && n > 2
                 && (!empty || (stat(path, &s) == 0 && s.st_size == 0));
    }
    if (d)
        closedir(d);
    return found;
}

/* Takes a folder of files away, if it is there. */
static void remove_folder(const char *folder)
{
    DIR *d = opendir(folder);
    struct dirent *entry;

    while (d && (entry = readdir(d)) != NULL) {
        char path[600];
        snprintf(path, sizeof path, "%s/%s", folder, entry->d_name);
        unlink(path);
    }
    if (d)
        closedir(d);
    rmdir(folder);
}

/* Runs ./bbm, or the one with the allocator that fails, without a shell in between, its messages
 * in the file `said`; call[0] is its path. */
static pid_t start(const char *said, char *const call[])
{
    const pid_t child = fork();

    if (child == 0) {
        signal(SIGINT, SIG_DFL);
        close(2);
        if (open(said, O_WRONLY | O_CREAT | O_TRUNC, 0666) == 2)
            execv(call[0], call);
        _exit(99);
    }
    return child;
}

static int exit_of(pid_t child)
{
    int status = 0;

    ck_assert_int_eq(waitpid(child, &status, 0), child);
    ck_assert(WIFEXITED(status));
    return WEXITSTATUS(status);
}

/* -------------------------------------------------------------------------------- Matrix Market */

/* Reads out/model/K.mtx and its right-hand side: A [n][n], then b [n], to be freed. Every entry stands
 * once, in the lower triangle, and their number is as announced. */
static double *read_matrix(int *size)
{
    FILE *f = fopen("out/model/K.mtx", "r");
    int n, columns, entries, i, j;
    double value;

    ck_assert_msg(f && fscanf(f, "%%%%MatrixMarket matrix coordinate real symmetric %d %d %d", &n,
                              &columns, &entries)
                  == 3, "out/model/K.mtx has no head");
    ck_assert(n == columns && n > 0 && n < 2000);
    double *A = malloc((size_t)n * ((size_t)n + 1) * sizeof *A);
    for (int k = 0; k < n * n; k++)
        A[k] = NAN;
    for (int k = 0; k < entries; k++) {
        ck_assert_int_eq(fscanf(f, "%d %d %lf", &i, &j, &value), 3);
        ck_assert_msg(1 <= j && j <= i && i <= n && isnan(A[(i - 1) * n + j - 1])
                      && isfinite(value),
                      "entry %d, %d of K", i, j);
        A[(i - 1) * n + j - 1] = A[(j - 1) * n + i - 1] = value;
    }
    ck_assert_int_eq(fscanf(f, "%lf", &value), EOF);
    fclose(f);
    for (int k = 0; k < n * n; k++)
        A[k] = isnan(A[k]) ? 0 : A[k];
    f = fopen("out/model/K.mtx.rhs", "r");
    ck_assert(f && fscanf(f, "%%%%MatrixMarket matrix array real general %d %d", &i, &columns) == 2
              && i == n);
    for (int k = 0; k < n; k++)
        ck_assert_int_eq(fscanf(f, "%lf", &A[n * n + k]), 1);
    fclose(f);
    *size = n;
    return A;
}

/* Two rows of two squares that touch: the lower one is a block and held, the upper one another and
 * pressed on it. */
static const char touching[] = STEEL
    "node 1 0 0\nnode 2 1 0\nnode 3 1 1\nnode 4 0 1\nnode 5 0 2\nnode 6 1 2\n"
    "node 7 2 0\nnode 8 2 1\nnode 9 2 2\nelement 1 a steel 1 2 3 4\nelement 3 a steel 2 7 8 3\n"
    "element 2 b steel 4 3 6 5\nelement 4 b steel 3 8 9 6\nfix box 0 0 2 0\n"
    "contact friction 60 kn 1e10\ntraction box 0 2 2 2 1e2 -1e3\nstatic\n";

/* The shipped models, one step of each without augmentation. `only`: one solution, which must be that
 * of K and F; where the contacts settle first, the matrix of the first solution is not the result's. */
static const struct { const char *model; int only; } matrices[] = {
    { "exp1", 1 }, { "exp2", 1 }, { "disc", 1 }, { "touching", 1 }, { "arch", 0 }, { "column", 1 },
    { "dam", 0 }, { "exp3", 0 }, { "incline", 0 }, { "overhang", 0 }, { "wall", 0 },
};

/* One block, 2 x 1 m and 2500 kg/m^3, whose form of inertia about its middle is known: m for u and v, m (a^2 + b^2)/12
 * for the rotation (-y, x), m a^2/12 and m b^2/12 for the strains (x, 0) and (0, y), a quarter of the rotation's for the
 * shear (y, x)/2, which meets the rotation with m (a^2 - b^2)/24. */
START_TEST(the_masses_beside_the_matrix_are_those_of_a_rectangle)
{
    const double m = 5000, expected[6] = { m, m, m*5/12, m*4/12, m/12, m*5/48 };

    ck_assert_int_eq(shell("mkdir -p out/model; printf 'material m E 1e9 nu 0 density 2500\nblock b m 3 5 5 5 5 6 3 6\n"
                           "fixblock b\ngravity 0 -1\nstatic\n' > out/model/heavy.model; %s/bbm -q out/model/heavy.model "
                           "-o out/model/heavy -m out/model/heavy.mtx", BUILD), 0);
    FILE *f = fopen("out/model/heavy.mtx.mass", "r");
    int n, i, j, entries = 0;
    double x;
    ck_assert(f && fscanf(f, "%%%%MatrixMarket matrix coordinate real symmetric %d 6 21", &n) == 1 && n == 6);
    for (; fscanf(f, "%d %d %lf", &i, &j, &x) == 3; entries++)
        ck_near(x, i == j ? expected[i - 1] : i == 6 && j == 3 ? m*3/24 : 0, m, 1e-12);
    ck_assert_int_eq(entries, 21);
    fclose(f);
}
END_TEST

START_TEST(the_matrix_leads_to_the_displacements_that_the_program_writes)
{
    const char *name = matrices[_i].model;
    char path[100], line[LONG];
    double largest = 0;
    int n;

    write_text("out/model/touching.source", touching);
    const char *form = strcmp(name, "touching") ? "cases/models/%s.model" : "out/model/%s.source";
    snprintf(path, sizeof path, form, name);
    ck_assert_int_eq(shell("rm -f out/model/K.mtx*; sed -e '/^output\\|^bond\\|^pcg\\|^expect/d' "
                           "-e 's/steps.*/steps 1/' -e 's|^mesh |mesh ../../cases/models/|' %s "
                           "> out/model/matrix.model; "
                           "printf 'bond augment 0\\npcg tolerance 1e-13\\n' >> out/model/matrix.model; "
                           "%s/bbm -q out/model/matrix.model -o out/model/matrix "
                           "-m out/model/K.mtx 2> out/model/matrix.err", path, BUILD), 0);
    double *A = read_matrix(&n), *x = A + n * n;
    ck_assert_int_eq(cell("matrix", "summary.csv", "1,", "open_close") == 1, matrices[_i].only);
    if (strcmp(name, "touching") == 0)
        ck_assert_double_eq(cell("matrix", "summary.csv", "1,", "contacts"), 3);
    if (matrices[_i].only) {
        eliminate(n, A, x);
        FILE *f = fopen("out/model/matrix/elements.csv", "r");
        ck_assert(f && fgets(line, sizeof line, f));
        for (int k = 0; k < n; k++)
            largest = fmax(largest, fabs(x[k]));
        for (int e = 0; e < n / 6; e++) {
            double u, v, turn;
            ck_assert(fgets(line, sizeof line, f)
                      && sscanf(line, "%*[^,],%*[^,],%*f,%*f,%lf,%lf,%lf", &u, &v, &turn) == 3);
            /* Two solvers of 16 digits at a condition of 1e7 or so. */
            ck_near(u, x[6 * e], largest, 1e-8);
            ck_near(v, x[6 * e + 1], largest, 1e-8);
            ck_near(turn, x[6 * e + 2], largest, 1e-8);
        }
        fclose(f);
    }
    free(A);
}
END_TEST

/* ----------------------------------------------------------------------- what cannot be written */

START_TEST(what_cannot_be_written_is_status_1_with_a_message)
{
    static const struct { const char *command, *said; } call[] = {
        { "bbm -q cases/models/incline.model -o Makefile/below",
          "Makefile/below cannot be written: Not a directory" },
        { "bbm -q cases/models/incline.model -o Makefile", "it is there and no folder" },
        { "bbm -q cases/models/incline.model -o out/model/full -m out/model/full.mtx",
          "incline.model: out/model/full.mtx cannot be written: No space" },
        { "bbm cases/models/incline.model -o out/model/full > /dev/full",
          "stdout cannot be written" },
        { "bbm -h > /dev/full", "stdout cannot be written" },
        { "bbm --version > /dev/full", "stdout cannot be written" },
    };

    ck_assert_int_eq(shell("ln -s /dev/full out/model/full.mtx"), 0);
    for (size_t k = 0; k < sizeof call / sizeof *call; k++) {
        ck_assert_int_eq(shell("%s/%s 2> out/model/bad.err", BUILD, call[k].command), 1);
        check_text("out/model/bad.err", call[k].said);
    }
}
END_TEST

START_TEST(a_closed_pipe_is_status_1)
{
    /* 4 writes into a pipe that nobody reads any more, since 3 is closed again. */
    ck_assert_int_eq(shell("cd out/model; rm -f unread; mkfifo unread; exec 3<>unread 4>unread 3<&-; "
                           "../../%s/bbm ../../cases/models/incline.model -o pipe >&4 2> bad.err", BUILD), 1);
    check_text("out/model/bad.err", "stdout cannot be written");
    ck_assert_int_eq(access("out/model/pipe/nodes.csv", F_OK), 0);
}
END_TEST

START_TEST(a_file_that_is_cut_off_never_stands_under_its_name)
{
    /* No file may grow beyond 512 bytes or 1 kB: nodes.csv of the beam would. */
    ck_assert_int_eq(shell("rm -rf out/model/cut; ulimit -f 1; %s/bbm -q cases/models/exp1.model "
                           "-o out/model/cut 2> out/model/bad.err", BUILD), 1);
    check_text("out/model/bad.err", "nodes.csv cannot be written: File too large");
    ck_assert_int_ne(access("out/model/cut/nodes.csv", F_OK), 0);
    ck_assert_int_ne(access("out/model/cut/nodes.csv.tmp", F_OK), 0);
    ck_assert_int_eq(access("out/model/cut/history.csv", F_OK), 0);
}
END_TEST

START_TEST(a_file_without_end_is_refused)
{
    ck_assert_int_eq(shell("%s/bbm /dev/zero -o out/model/endless 2> out/model/bad.err", BUILD), 2);
    check_text("out/model/bad.err", "/dev/zero is longer than 268435456 bytes");
    ck_assert_int_eq(run_text("endless", "mesh /dev/zero\nstatic\n"), 2);
    check_text("out/model/endless.err", "endless.model:1: /dev/zero is longer than");
    ck_assert(!is_there("out/model/endless"));
}
END_TEST

/* ------------------------------------------------------------------------------------- pictures */

/* A block that slides on a table, with pictures; a longer run by other steps. */
#define SLIDE(steps) "title it slides\n" \
    "material rigid E 1e14 nu 0.25 density 2500\nmaterial rock E 1e10 nu 0.2 density 2500\n" \
    "node 1 0 0\nnode 2 9 0\nnode 3 9 2\nnode 4 0 2\nelement 1 table rigid 1 2 3 4\nfixblock table\n" \
    "node 5 4 2\nnode 6 5 2\nnode 7 5 3\nnode 8 4 3\nelement 2 block rock 5 6 7 8\n" \
    "gravity 0 -9.81\ncontact friction 5\nvelocity block 1 0\n" \
    "dynamic dt 0.01 steps " steps "\nmonitor p node 5\noutput every 2 svg vtk\n"

static const char *const pictures[] = { "contacts.svg", "movie.svg", "mises.svg", "history.svg" };
static const char *const tables[] = { "nodes.csv", "elements.csv", "history.csv", "summary.csv",
                                      "timing.csv" };

/* How many of the tables are in a folder. */
static int count_tables(const char *folder)
{
    char path[100];
    int there = 0;

    for (int k = 0; k < 5; k++) {
        snprintf(path, sizeof path, "%s/%s", folder, tables[k]);
        there += is_there(path);
    }
    return there;
}

START_TEST(a_picture_that_cannot_be_made_is_said_and_costs_nothing_else)
{
    char text[100], path[100];

    write_text("out/model/picture.model", SLIDE("10"));
    /* A folder that is not empty stands in its place. */
    ck_assert_int_eq(shell("rm -rf out/model/picture; mkdir -p out/model/picture/%s/x",
                           pictures[_i]), 0);
    ck_assert_int_eq(shell("%s/bbm -q out/model/picture.model -o out/model/picture 2> "
                           "out/model/picture.err", BUILD), 1);
    snprintf(text, sizeof text, "out/model/picture/%s cannot be written: Is a directory",
             pictures[_i]);
    check_text("out/model/picture.err", text);
    for (int k = 0; k < 4; k++) {
        snprintf(path, sizeof path, "out/model/picture/%s", pictures[k]);
        ck_assert(is_there(path));
    }
    ck_assert_int_eq(count_tables("out/model/picture"), 5);
    ck_assert_double_eq(cell("picture", "history.csv", "", "step"), 10);
    ck_assert(!has_file("out/model/picture", ".tmp", 0));
}
END_TEST

/* Each history grows beyond what a file may have, 4 kB or 8. */
START_TEST(a_full_disk_leaves_the_rows_that_were_written)
{
    write_text("out/model/disk.model", SLIDE("600"));
    ck_assert_int_eq(shell("ulimit -f 8; %s/bbm -q out/model/disk.model -o out/model/a/disk 2> "
                           "out/model/bad.err", BUILD), 1);
    check_text("out/model/bad.err",
               "summary.csv cannot be written: File too large; it ends before that");
    ck_assert(is_there("out/model/a/disk/nodes.csv") && !has_file("out/model/a/disk", ".tmp", 0));
    ck_assert_int_eq(shell("cd out/model/a/disk; for f in history summary; do tail -c1 $f.csv | "
                           "grep -q '^$' && awk -F, 'NR == 1 { n = NF } NF != n || (NR > 2 && "
                           "$1 != last + 1) { exit 1 } { last = $1 } END { exit NR < 20 }' $f.csv "
                           "|| exit 1; done"), 0);
}
END_TEST

/* What is said while history.csv is open would land in it. */
START_TEST(streams_that_are_closed_are_no_tables)
{
    write_text("out/model/closed.model", SLIDE("10"));
    ck_assert_int_eq(shell("mkdir -p out/model/closed/step_000002.vtk/x; %s/bbm -q "
                           "out/model/closed.model -o out/model/closed 2>&-", BUILD), 1);
    ck_assert_int_eq(shell("grep -q cannot out/model/closed/*.csv"), 1);
}
END_TEST

/* ------------------------------------------------------------------------- memory that is short */

/* A mesh of Gmsh, statics, with all that can be written. */
#define MESHED STEEL "title a plate\nmesh ../../tests/mesh/square22.msh\nuse steel on plate\n" \
    "fix set left\nset corner nodes 3\nload set corner 0 -1e6\ntraction box 1 0 1 1 1e3 0\n" \
    "monitor p at 1 1\nstatic\noutput svg vtk\n"

/* What makes its own nodes, names and numbers. */
#define NAMED "let h 1.5\nplane strain\nmaterial rock E 1e10 nu 0.25 density 2500\ngravity 0 -10\n" \
    "block base rock -1 -1 3 -1 3 0 -1 0\ngrid dam rock 0 0 1 2 1 2 crossed\nfixblock base\n" \
    "fix set base x by 1e-3\nwater set dam.left $h\njoint dam * friction 50\nmonitor top at 0 2 of dam\n" \
    "bolt at 0 2 of dam at 3 0 stiffness 1e6 pretension 1e3\n" \
    "dynamic dt 0.01 steps 3 settle 1\nexpect top stays by 1\noutput svg vtk\n"

/* Models, and a file that they leave when they end with 0. */
static const struct { const char *model, *text, *last; } short_of_memory[] = {
    { "meshed", MESHED, "step_000001.vtk" }, { "slide", SLIDE("4 settle 1"), "movie.svg" },
    { "named", NAMED, "contacts_000003.vtk" },
};

START_TEST(a_check_without_memory_says_so)
{
    int status = 1;

    write_text("out/model/named.model", NAMED);
    for (int n = 0; status; n++) {
        status = shell("TEST_ALLOCATIONS=%d exec %s/failing/bbm -q --check out/model/named.model -o "
                       "out/model/checked 2> out/model/short.err", n, BUILD);
        const char *said = slurp("out/model/short.err");
        ck_assert_msg(status == !!*said, "%d: %d, %s", n, status, said);
    }
}
END_TEST

/* Runs a model with so many allocations, as test_alloc.c counts them; whether all is there. Whatever it
 * is: a run that lacks something says so and ends with 1; no file is half a file; short of a picture it
 * keeps its tables. */
static int run_short(int model, int allocations, int *kept)
{
    const char *name = short_of_memory[model].model;
    char folder[60], path[100], text[20];

    snprintf(folder, sizeof folder, "out/model/%s", name);
    snprintf(path, sizeof path, "out/model/%s.model", name);
    snprintf(text, sizeof text, "%d", allocations);
    remove_folder(folder);
    unlink("out/model/short.mtx");
    unlink("out/model/short.mtx.rhs");
    setenv("TEST_ALLOCATIONS", text, 1);
    const int status = exit_of(start("out/model/short.err", (char *[]){
        BUILD "/failing/bbm", "-q", path, "-o", folder, "-m", "out/model/short.mtx", NULL }));
    unsetenv("TEST_ALLOCATIONS");
    const char *said = slurp("out/model/short.err");
    ck_assert_msg((status == 0 && !*said) || (status == 1 && *said),
                  "%s, %d allocations: status %d, said: %s", name, allocations, status, said);
    ck_assert_msg(!has_file(folder, ".tmp", 0) && !has_file(folder, "", 1), "%s, %d: left over",
                  name, allocations);
    const int there = count_tables(folder);
    snprintf(path, sizeof path, "%s/%s", folder, short_of_memory[model].last);
    ck_assert_msg(status || (there == 5 && is_there(path) && is_there("out/model/short.mtx.rhs")),
                  "%s, %d: status 0, but not all is there", name, allocations);
    if (strstr(said, ".svg cannot be written")) {
        ck_assert_msg(there == 5, "%s, %d: a picture cost results: %s", name, allocations, said);
        *kept += 1;
    }
    return status == 0;
}

START_TEST(without_memory_a_run_says_so_at_every_allocation)
{
    char path[60];
    int n = 0, kept = 0, good = 0;

    snprintf(path, sizeof path, "out/model/%s.model", short_of_memory[_i].model);
    write_text(path, short_of_memory[_i].text);
    while (!run_short(_i, n, &kept))            /* the first n allocations succeed, then none */
        n += 5;
    ck_assert_int_gt(n, 100);
    ck_assert_int_gt(kept, 0);
    for (int k = 1; k <= n; k++)                /* the k-th alone fails */
        good += run_short(_i, -k, &kept);
    ck_assert_int_lt(good, n / 10);             /* what the program can do without */
}
END_TEST

START_TEST(without_memory_an_experiment_says_so)
{
    static const char *const name[] = {
        "exp1", "exp2", "exp3",
    };

    shell("mkdir -p out/model/cases; cp cases/fem.csv out/model/cases");
    for (size_t k = 0; k < sizeof name / sizeof *name; k++)
        for (int n = 0; n < 20; n = 3 * n + 1) {
            const int status = shell("cd out/model; TEST_ALLOCATIONS=%d exec ../../%s/failing/%s "
                                     "> short.log 2> short.err", n, BUILD, name[k]);
            ck_assert_msg(status == 1 && *slurp("out/model/short.err"),
                          "%s, %d allocations: status %d", name[k], n, status);
        }
}
END_TEST

/* ---------------------------------------------------------- runs that are under way, or stopped */

static void wait_a_little(void) { nanosleep(&(struct timespec){ 0, 10000000 }, NULL); }

/* A million steps of a fall. */
#define LONG_RUN STEEL "node 1 0 0\nnode 2 1 0\nnode 3 1 1\nelement 7 b steel 1 2 3\n" \
    "velocity b 1 0\ndynamic dt 0.001 steps 1000000%s\nmonitor p node 2\noutput svg\n"

/* Starts ./bbm with out/model/long.model and waits until it writes, for a minute at most. */
static pid_t start_long(const char *more)
{
    char text[LONG], path[60];

    snprintf(text, sizeof text, LONG_RUN, more);
    write_text("out/model/long.model", text);
    shell("rm -rf out/model/long; rm -f out/model/long.err");
    const pid_t child = start("out/model/long.err", (char *[]){
        BUILD "/bbm", "-q", "out/model/long.model", "-o", "out/model/long", NULL });
    snprintf(path, sizeof path, "out/model/long/summary.csv.%ld.tmp", (long)child);
    for (int k = 0; k < 6000 && !is_there(path); k++)
        wait_a_little();
    if (!is_there(path))
        kill(child, SIGKILL);
    ck_assert_msg(is_there(path), "no %s", path);
    for (int k = 0; k < 10; k++)
        wait_a_little();
    return child;
}

START_TEST(an_interrupted_run_keeps_what_it_has_computed)
{
    const struct { int number; const char *more; } call[] = {
        { SIGINT, "" }, { SIGTERM, "" }, { SIGINT, " settle 1000000" },
    };
    const int k = _i % COUNT(call);
    const pid_t child = start_long(call[k].more);
    char text[LONG];
    int status;

    /* timeout(1) sends two; many meet all moments. One a second later would end the run at once. */
    for (int round = 0; waitpid(child, &status, WNOHANG) == 0; round++) {
        for (int n = 0; n < 20 && round < 200; n++)
            kill(child, call[k].number);
        nanosleep(&(struct timespec){ 0, 20000 }, NULL);
    }
    ck_assert_msg(WIFEXITED(status) && WEXITSTATUS(status) == 128 + call[k].number,
                  "ended by signal %d", WTERMSIG(status));
    const char *said = slurp("out/model/long.err");
    ck_assert_msg(strstr(said, k == 2 ? "interrupted at settling, step " : "interrupted at step "),
                  "%s", said);
    ck_assert(!has_file("out/model/long", ".tmp", 0) && !has_file("out/model/long", "", 1));
    ck_assert_int_eq(count_tables("out/model/long"), 5);
    if (k == 2)
        return;
    const double step = cell("long", "history.csv", "", "step");
    ck_assert(step > 0 && step < 1000000);
    snprintf(text, sizeof text, "interrupted at step %.0f of 1000000, t = %g s; what was computed "
             "until then is in out/model/long\n", step, step / 1000);
    ck_assert_msg(strstr(said, text) != NULL, "%s, not %s", said, text);
    ck_relative(cell("long", "nodes.csv", "2,b", "u"), step / 1000, 1e-9);
    ck_assert(is_there("out/model/long/movie.svg") && is_there("out/model/long/history.svg"));
}
END_TEST

START_TEST(a_second_signal_ends_a_run_at_once_and_the_next_run_removes_what_it_left)
{
    const pid_t child = start_long("");

    kill(child, SIGSTOP);
    kill(child, SIGINT);
    kill(child, SIGTERM);
    kill(child, SIGCONT);                       /* now both are there at the same time */
    const int status = exit_of(child);
    ck_assert_msg(status == 130 || status == 143, "status %d", status);
    ck_assert(!is_there("out/model/long/nodes.csv"));
    ck_assert(has_file("out/model/long", ".tmp", 0));
    ck_assert_int_eq(shell("sed -i 's/steps 1000000/steps 10/' out/model/long.model; "
                           "%s/bbm -q out/model/long.model -o out/model/long", BUILD), 0);
    ck_assert(!has_file("out/model/long", ".tmp", 0));
    ck_assert_double_eq(cell("long", "history.csv", "", "step"), 10);
}
END_TEST

START_TEST(a_second_run_in_the_same_folder_is_refused_and_disturbs_nothing)
{
    const pid_t child = start_long("");
    write_text("out/model/second.model", SLIDE("10"));
    ck_assert_int_eq(shell("%s/bbm -q out/model/second.model -o out/model/long 2> "
                           "out/model/second.err", BUILD), 1);
    check_text("out/model/second.err",
               "another run is at work there; another folder may be given with -o");
    kill(child, SIGINT);
    ck_assert_int_eq(exit_of(child), 130);
    ck_assert_double_gt(cell("long", "history.csv", "", "p_u"), 0);
    ck_assert(!has_file("out/model/long", ".vtk", 0));
}
END_TEST

/* Each has a picture for every second row of its history; of two that mix they differ. */
START_TEST(of_two_runs_that_start_together_in_one_folder_all_is_of_one)
{
    write_text("out/model/short.model", SLIDE("10"));
    write_text("out/model/other.model", SLIDE("20"));
    ck_assert_int_eq(shell("cd out/model; bbm=../../%s/bbm; for k in $(seq 60); do for m "
                           "in short other; do $bbm -q $m.model -o both 2> $m.err & done; wait; "
                           "n=$(tail -1 both/history.csv | cut -d, -f1); [ $(ls both/step_*.vtk | wc "
                           "-l) = $((n / 2 + 1)) ] || exit 1; done", BUILD), 0);
}
END_TEST

START_TEST(a_run_whose_folder_another_one_has_made_anew_leaves_it_alone)
{
    const pid_t child = start_long("");
    write_text("out/model/second.model", SLIDE("10"));
    ck_assert_int_eq(shell("rm -r out/model/long; %s/bbm -q out/model/second.model -o out/model/long; "
                           "cd out/model/long; cat $(ls) > ../was", BUILD), 0);
    kill(child, SIGINT);
    ck_assert_int_ne(exit_of(child), 0);
    check_text("out/model/long.err", "out/model/long cannot be written: it was removed while the run "
                                     "was at work");
    ck_assert_int_eq(shell("cd out/model/long; cat $(ls) | cmp - ../was"), 0);
}
END_TEST

#define READS STEEL "block b steel 0 0 1 0 1 1\nvelocity b 1 0\nshake %s\ndynamic dt 0.01 steps 2\n"

/* A record by its name, by another name and by a link, and the model itself. */
START_TEST(a_file_that_a_run_reads_is_refused_as_a_place_for_results)
{
    static const struct { const char *record, *options; } call[] = {
        { "history.csv", "run.model -o ." }, { "elsewhere.csv", "run.model -o kept" },
        { "here.csv", "nodes.csv -o ." }, { "here.csv", "K.mtx -m K.mtx" },
        { "here.csv", "K.mtx.rhs -m K.mtx" }, { "here.csv", "K.mtx.mass -m K.mtx" },
        { "here.csv", "bbm.lock -o ." }, { "here.csv", "- -o . < summary.csv" },
        { "history.csv", "--check run.model -o ." },
    };
    char text[LONG];

    snprintf(text, sizeof text, READS, call[_i].record);
    ck_assert_int_eq(shell("rm -rf out/model/reads; mkdir -p out/model/reads/kept"), 0);
    write_text("out/model/reads/run.model", text);
    ck_assert_int_eq(shell("cd out/model/reads; printf '0,0\\n1,1\\n' | tee history.csv here.csv > "
                           "kept/nodes.csv; ln -s kept/nodes.csv elsewhere.csv; for f in nodes.csv K.mtx "
                           "K.mtx.rhs K.mtx.mass bbm.lock summary.csv; do cp run.model $f; done; rm -rf ../was; cp -r . ../was; "
                           "../../../%s/bbm -q %s 2> ../reads.err", BUILD, call[_i].options), 1);
    check_text("out/model/reads.err", " cannot be written: this run reads it");
    ck_assert_int_eq(shell("diff -r out/model/reads out/model/was"), 0);
}
END_TEST

/* Without a reader it would wait for ever. */
START_TEST(a_pipe_under_the_name_of_a_table_is_refused)
{
    write_text("out/model/fifo.model", SLIDE("2"));
    ck_assert_int_eq(shell("mkdir -p out/model/fifo; mkfifo out/model/fifo/elements.csv; timeout -s KILL 10 "
                           "%s/bbm -q out/model/fifo.model -o out/model/fifo 2> out/model/fifo.err", BUILD), 1);
    check_text("out/model/fifo.err", "elements.csv cannot be written: ");
}
END_TEST

START_TEST(a_run_removes_what_an_earlier_one_left_of_its_own_and_nothing_else)
{
    write_text("out/model/again.model", SLIDE("10"));
    ck_assert_int_eq(shell("rm -rf out/model/again; mkdir -p out/model/again/step_000007.vtk; "
                           "cd out/model/again; echo 1 | tee step_000099.vtk step_1.vtk.old notes.txt "
                           "history.csv.1.tmp step_12.vtk.1999999999.tmp "
                           "notes.csv.1999999999.tmp > said"), 0);
    ck_assert_int_eq(shell("%s/bbm -q out/model/again.model -o out/model/again", BUILD), 0);
    ck_assert_int_eq(shell("cd out/model/again; ls -d *.vtk* *.tmp *.txt | tr '\\n' ' ' > ../said"), 0);
    ck_assert_str_eq(slurp("out/model/said"),
                     "contacts_000000.vtk contacts_000002.vtk contacts_000004.vtk "
                     "contacts_000006.vtk contacts_000008.vtk contacts_000010.vtk "
                     "notes.csv.1999999999.tmp notes.txt step_000000.vtk step_000002.vtk "
                     "step_000004.vtk step_000006.vtk step_000007.vtk step_000008.vtk "
                     "step_000010.vtk step_1.vtk.old ");
    /* A run without pictures leaves none of an earlier one beside its tables. */
    ck_assert_int_eq(shell("sed -i /^output/d out/model/again.model; %s/bbm -q "
                           "out/model/again.model -o out/model/again", BUILD), 0);
    ck_assert(!is_there("out/model/again/movie.svg") && !is_there("out/model/again/history.svg")
              && !is_there("out/model/again/step_000010.vtk"));
}
END_TEST

/* ------------------------------------------------------------ what the file leaves out, is said */

/* E t = 1e19, 5e9, 1e9 x 2; the first says "rigid". */
#define STACK(fixed, contact) \
    "material rigid E 1e19 nu 0.2 density 2500\nmaterial rock E 5e9 nu 0.2 density 2500\n" \
    "material clay E 1e9 nu 0.2 density 2000 thickness 2\n" \
    "node 1 0 0\nnode 2 1 0\nnode 3 1 1\nnode 4 0 1\nnode 5 0 2\nnode 6 1 2\nnode 7 0 3\n" \
    "node 8 1 3\nelement 1 base rigid 1 2 3 4\nelement 2 a rock 4 3 6 5\nelement 3 b clay 5 6 8 7\n" \
    "gravity 0 -10\ndynamic dt 0.01 steps 5 settle 5\n" fixed "contact friction 30 " contact

/* Contacts are 50 E t stiff, and 0.4 of it, by the softest material that is not fixed, or of all; `settle 0` is none. */
START_TEST(what_is_left_out_has_its_default)
{
    static const char *const same[][2] = {
        { STACK("fixblock base\n", ""), STACK("fixblock base\n", "kn 1e11 ks 4e10") },
        { STACK("fixblock base\nfixblock b\n", ""), STACK("fixblock base\nfixblock b\n", "kn 2.5e11 ks 1e11") },
        { STACK("fixblock base\nfixblock b\nfixblock a\n", ""),
          STACK("fixblock base\nfixblock b\nfixblock a\n", "kn 1e11 ks 4e10") },
        { SLIDE("10"), SLIDE("1e1 settle 0") },
    };

    ck_assert_int_eq(run_text("left", same[_i][0]), 0);
    ck_assert_int_eq(run_text("given", same[_i][1]), 0);
    ck_assert_int_eq(shell("cd out/model; cmp left/nodes.csv given/nodes.csv && cmp left/history.csv given/history.csv"), 0);
}
END_TEST

#define GLUED(steps) STEEL "node 1 0 0\nnode 2 1 0\nnode 3 1 1\nnode 4 0 1\n" \
    "element 1 a steel 1 2 3\nelement 2 a steel 1 3 4\nfix node 1\ngravity 0 -10\n" \
    "dynamic dt 0.01 steps " steps "\n"

START_TEST(a_run_that_fails_says_at_which_step_and_what_the_library_says)
{
    ck_assert_int_eq(run_text("fails", GLUED("10\npcg iterations 1 coarse off")), 1);
    const char *said = slurp("out/model/fails.err");
    const char *step = strstr(said, "step 1");
    ck_assert_msg(strncmp(said, "out/model/fails.model: ", 23) == 0 && step
                  && !strstr(step + 1, "step 1"), "%s", said);
    ck_assert_ptr_nonnull(strstr(said, bbm_status_text(BBM_NOT_CONVERGED)));
    ck_assert_int_eq(run_text("fails", GLUED("10 settle 3\npcg iterations 1 coarse off")), 1);
    check_text("out/model/fails.err", "out/model/fails.model: settling, ");
    ck_assert_int_eq(run_text("fails", STEEL "block a steel 0 0 2 0 2 1 0 1\nblock b steel 0 1 1 1 1 2 "
                              "0 2\nfixblock a\ngravity 0 -10\ncontact kn 1e3 friction 30\n"
                              "dynamic dt 0.01 steps 100\n"), 1);
    check_text("out/model/fails.err", " of block 'b' is");
    check_text("out/model/fails.err", "larger stiffnesses kn, ks help");
}
END_TEST

START_TEST(what_the_shipped_models_leave_is_nothing_for_git)
{
    ck_assert_int_eq(shell("for m in cases/models/*.model; do "
                           "grep -qx \"/$(basename $m .model)/\" .gitignore || exit 1; done"), 0);
}
END_TEST

/* ---------------------------------------------------------------------------------- the library */

START_TEST(a_compiler_that_breaks_the_arithmetic_is_refused)
{
    static const char *const flag[] = { "-Ofast", "-ffast-math", "-ffinite-math-only" };

    for (int k = 0; k < 3; k++) {
        ck_assert_int_ne(shell("env -u MAKEFLAGS -u MAKELEVEL make -s O=out/model/fast CPPFLAGS= "
                               "CFLAGS=%s "
                               "out/model/fast/solver.o > out/model/said 2>&1", flag[k]), 0);
        check_text("out/model/said", "compile without -Ofast");
    }
}
END_TEST

static bbm_model *square(void)
{
    bbm_model *m = unit_square(&SOLID);

    bbm_fix_node(m, 0, BBM_XY, 0, 0);
    bbm_fix_node(m, 1, BBM_XY, 0, 0);
    bbm_add_load(m, 2, 1e-3, 0);
    return m;
}

START_TEST(a_model_that_is_not_prepared_has_no_energy)
{
    bbm_model *m = square();
    bbm_energy e = { 1, 1, 1 };

    m->element[0].stress[0] = 1e6;          /* it would have one */
    bbm_energies(m, &e);
    ck_assert(e.kinetic == 0 && e.elastic == 0 && e.springs == 0);
}
END_TEST

static int stop_at_the_second(const bbm_model *m, void *solutions)
{
    (void)m;
    return ++*(int *)solutions == 2;
}

static int forget_steps(const bbm_model *m, void *own)
{
    ((bbm_model *)own)->info.step = 0;
    return m != own;
}

START_TEST(a_run_has_its_number_of_steps_whatever_a_monitor_does)
{
    bbm_model *m = square();

    m->par.steps = 5;
    m->monitor = forget_steps;
    m->monitor_context = m;
    ck_ok(bbm_prepare(m), m);
    ck_ok(bbm_run(m), m);
}
END_TEST

/* Adds nodes, for which the array moves. */
static void add_nodes(double x, double y, const void *model, double f[2])
{
    bbm_model *m = *(bbm_model *const *)model;

    for (int k = 0; k < 1000; k++)
        bbm_add_node(m, 9, 9, NULL);
    f[0] = x;
    f[1] = y;
}

/* From (0, 0) to (1, 0): a Gauss point lies at its share of the way. */
START_TEST(the_function_of_a_load_may_add_nodes)
{
    bbm_model *m = square();

    ck_ok(bbm_add_varying_line_load(m, 0, 1, add_nodes, &m), m);
    for (int g = 0; g < BBM_GAUSS; g++) {
        double s, weight;
        bbm_gauss_point(g, &s, &weight);
        ck_near(m->line_load[0].f[g][0], s, 1, 1e-15);      /* a rounding */
        ck_assert(m->line_load[0].f[g][1] == 0);
    }
}
END_TEST

START_TEST(watch_stops_a_step_before_its_next_solution)
{
    bbm_model *m = square();
    int solutions = 0;

    m->beyond->multiplier_rounds = 2;                         /* three solutions in the step */
    m->monitor = stop_at_the_second;
    m->monitor_context = &solutions;
    ck_ok(bbm_prepare(m), m);
    ck_assert_int_eq(bbm_step(m), BBM_STOPPED);
    ck_assert_msg(strstr(bbm_message(m), "step 1") != NULL, "%s", bbm_message(m));
    ck_assert_int_eq(solutions, 2);
    ck_assert_int_eq(m->info.step, 0);
    ck_assert(m->element[0].sum[0] == 0 && m->vertex[2].u == 0);
    ck_ok(bbm_step(m), m);
    ck_assert_int_eq(m->info.step, 1);
}
END_TEST

static void make_folder(void) { shell("rm -rf out/model; mkdir -p out/model"); }

Suite *files_suite(void)
{
    Suite *s = suite_create("files");
    TCase *t = new_case(s, "files");

    tcase_set_timeout(t, 120);
    tcase_add_unchecked_fixture(t, make_folder, NULL);
    tcase_add_test(t, the_masses_beside_the_matrix_are_those_of_a_rectangle);
    tcase_add_loop_test(t, the_matrix_leads_to_the_displacements_that_the_program_writes, 0,
                        COUNT(matrices));
    tcase_add_test(t, what_cannot_be_written_is_status_1_with_a_message);
    tcase_add_test(t, a_full_disk_leaves_the_rows_that_were_written);
    tcase_add_test(t, streams_that_are_closed_are_no_tables);
    tcase_add_test(t, a_check_without_memory_says_so);
    tcase_add_test(t, of_two_runs_that_start_together_in_one_folder_all_is_of_one);
    tcase_add_test(t, a_closed_pipe_is_status_1);
    tcase_add_test(t, a_file_that_is_cut_off_never_stands_under_its_name);
    tcase_add_test(t, a_file_without_end_is_refused);
    tcase_add_loop_test(t, a_picture_that_cannot_be_made_is_said_and_costs_nothing_else, 0, 4);
    tcase_add_loop_test(t, without_memory_a_run_says_so_at_every_allocation, 0, 3);
    tcase_add_test(t, without_memory_an_experiment_says_so);
    tcase_add_loop_test(t, an_interrupted_run_keeps_what_it_has_computed, 0, 6);
    tcase_add_test(t, a_second_signal_ends_a_run_at_once_and_the_next_run_removes_what_it_left);
    tcase_add_test(t, a_second_run_in_the_same_folder_is_refused_and_disturbs_nothing);
    tcase_add_test(t, a_run_whose_folder_another_one_has_made_anew_leaves_it_alone);
    tcase_add_loop_test(t, a_file_that_a_run_reads_is_refused_as_a_place_for_results, 0, 9);
    tcase_add_test(t, a_pipe_under_the_name_of_a_table_is_refused);
    tcase_add_test(t, a_run_removes_what_an_earlier_one_left_of_its_own_and_nothing_else);
    tcase_add_loop_test(t, what_is_left_out_has_its_default, 0, 4);
    tcase_add_test(t, a_run_that_fails_says_at_which_step_and_what_the_library_says);
    tcase_add_test(t, what_the_shipped_models_leave_is_nothing_for_git);
    t = new_case(s, "library");
    tcase_add_test(t, a_compiler_that_breaks_the_arithmetic_is_refused);
    tcase_add_test(t, a_model_that_is_not_prepared_has_no_energy);
    tcase_add_test(t, a_run_has_its_number_of_steps_whatever_a_monitor_does);
    tcase_add_test(t, the_function_of_a_load_may_add_nodes);
    tcase_add_test(t, watch_stops_a_step_before_its_next_solution);
    return s;
}
