/* check_growth.c - nothing grows with the square: of each statement, and of each error in a model that
 * is large, twice as much takes at most 2.5 times the time of the processor and the memory. What grows
 * with the square takes four times as much. Measured are half as much and twice as much: two doublings
 * tell 6.25 from 16, which a busy machine does not blur. */
#define _DEFAULT_SOURCE
#include <dirent.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#include "programs.h"

/* GROWTH [-]  twice as much, and a quarter for caches and for sorting
 * LEAST [s]   what takes less is the start of the program; MOST [s]: ended after that
 * TRIES       at most, until it is small enough: on a machine with other work to do the least counts
 * SHARES      of the wrong models, one after the other */
#define GROWTH 2.5
#define LEAST 0.004
enum { MOST = 4, TRIES = 25, SHARES = 4 };

/* A model: `before`; `each` for k = 0 .. n-1; `behind`. There @ stands for k, ^ for k + 1, $ for n. */
typedef struct { const char *before, *each, *behind; int n; } growing;

#define STONE "material m E 1e9 nu 0.2 density 2500\n"
#define RUN STONE "dynamic dt 1e-3 steps 1\n"
#define ONE RUN "block s m 0 0 1 0 1 1 0 1\nblock t m 2 0 3 0 3 1 2 1\n"
#define TWICE(statement) { ONE statement, statement, "", 30000 }

static const growing rows[] = {
    { "", "let a@ @\n", ONE, 20000 },
    { ONE "let a0 1\n", "let a^ $(a@+1)\n", "", 20000 },
    { ONE, "repeat i 1 1\nload node 1 0 0\nend\n", "", 8000 },
    { ONE "repeat i 1 $\n", "", "load node 1 0 0\nend\n", 20000 },
    { ONE "fixblock s\ngravity 0 -9\n", "stage s@ steps 1\nload node 1 0 1\nend\n", "", 4000 },
    { ONE "fixblock s\nrepeat i 0 500\nblock b$i m 9 $i 10 $i 10 $(i+1)\nend\n",
      "stage s@ remove b@\nend\n", "", 200 },
    { ONE "title ", "a ", "\n", 200000 },
    { ONE, "node 9@ @ 0\n", "", 20000 },
    { RUN, "node 1@ @ 0\nnode 2@ @ 1\nelement ^ b m 1@ 1^ 2^ 2@\n", "node 1$ $ 0\nnode 2$ $ 1\n", 2000 },
    { "", "material m@ E 1e9 nu 0.2 density 2500\n", ONE, 10000 },
    { RUN, "block b@ m @ 0 ^ 0 ^ 1 @ 1\n", "", 1200 },
    { RUN, "block b@ m @ 0 ^ 0 ^ 1 @ 1\nfix at @ 0\n", "", 1500 },
    { RUN, "block b@ m 0 @ 1 @ 1 ^ 0 ^\nfixblock b@\nvelocity b@ 1 0\nstress b@ 1 2 3\nbodyforce b@ 0 1\n", "", 1000 },
    { RUN "grid g m 0 0 1 1 $ 1\n", "", "", 2000 },
    { RUN "grid g m 0 0 1 1 1 $\n", "", "", 2000 },
    { RUN "grid g m 0 0 $ 20 $ 20\n", "", "", 100 },
    { ONE, "set a@ nodes 1 2\n", "", 10000 },
    { ONE "set a nodes", " 1", "\n", 100000 },
    { ONE, "joint s t friction 3\n", "", 2000 },
    { ONE, "joint * s friction 0.3\n", "", 2000 },
    { ONE, "fix node 1\nfix at 0 0 x\n", "", 8000 },
    { ONE, "load node 1 0 1\nload box 0 0 1 1 0 1\n", "", 8000 },
    { ONE, "traction set s 0 1\n", "", 300 },
    { ONE, "pressure set s 1\n", "", 300 },
    { ONE "gravity 0 -9\n", "water set s 2\n", "", 300 },
    { ONE, "bolt at 1 0 at 2 0 stiffness 1\n", "", 5000 },
    { RUN "block s m 0 0 1 0 1 1 0 1\nblock t m 1 0 2 0 2 1 1 1\n", "pin s t at 1 0\n", "", 2000 },
    { RUN "block b0 m -1 0 0 0 0 1 -1 1\n", "block b^ m @ 0 ^ 0 ^ 1 @ 1\nbond b@ b^\n", "", 1000 },
    { ONE, "monitor p@ at 9 9\n", "", 5000 },
    { ONE "fix node 1\n", "monitor p@ support node 1\n", "", 5000 },
    { ONE, "monitor p@ joint s *\n", "", 8000 },
    { ONE "monitor p at 0 0\n", "expect p u 0 within 1\n", "", 15000 },
    { ONE, "mesh none.msh\n", "", 20000 },
    { ONE, "use m on *\n", "", 20000 },
    TWICE("plane stress\n"), TWICE("gravity 0 -9\n"), TWICE("shake 1 0 1\n"),
    TWICE("contact friction 30\n"), TWICE("static\n"), TWICE("bond alpha 10\n"),
    TWICE("pcg omega 1\n"), TWICE("rotation exact\n"), TWICE("output svg\n"),
    { RUN "block b m 0 0 ", "^ 0 ", "$ 1 0 1\n", 300 },
    { ONE, "# nothing\n", "", 200000 },
    { ONE, "unknown\n", "", 20000 },
    { STONE "static\ngrid g m 0 0 $ 1 $ 1\n", "", "", 2000 },
    { ONE, "block b@ m 9@ 0 9^ 0 9^ 1 9@ 1\n", "block o m 9$ 0 9^ 0 9^ 1 9@ 1\n", 1000 },
};

static void put(FILE *f, const char *text, int k, int n)
{
    for (; *text; text++)
        if (*text == '@' || *text == '^' || (*text == '$' && strchr(" \n", text[1])))
            fprintf(f, "%d", *text == '@' ? k : *text == '^' ? k + 1 : n);
        else
            fputc(*text, f);
}

static void write_model(const growing *g, int n)
{
    FILE *f = fopen("out/model/growth.model", "w");

    ck_assert_ptr_nonnull(f);
    put(f, g->before, 0, n);
    for (int k = 0; k < n; k++)
        put(f, g->each, k, n);
    put(f, g->behind, n, n);
    ck_assert_int_eq(fclose(f), 0);
}

/* What ./bbm --check takes: seconds, and memory. */
static void measure(double took[2])
{
    struct rusage u;
    int status;
    const pid_t child = fork();

    if (child == 0) {
        setrlimit(RLIMIT_CPU, &(struct rlimit){ MOST, MOST });
        const int nowhere = open("/dev/null", O_WRONLY);
        dup2(nowhere, 2);
        execl(BUILD "/bbm", "bbm", "-q", "--check", "-o", "out/model/growth", "out/model/growth.model",
              (char *)NULL);
        _exit(99);
    }
    ck_assert_int_eq(wait4(child, &status, 0, &u), child);
    ck_assert_msg(WIFEXITED(status) && WEXITSTATUS(status) <= 2, "it took more than %d s, or crashed", MOST);
    took[0] = fmin(took[0], (double)(u.ru_utime.tv_sec + u.ru_stime.tv_sec)
                            + 1e-6 * (double)(u.ru_utime.tv_usec + u.ru_stime.tv_usec));
    took[1] = fmin(took[1], (double)u.ru_maxrss);
}

/* Half as much and twice as much, until the growth is small enough or has been measured often. */
static void check_growth(const growing *g, const char *what)
{
    double half[2] = { INFINITY, INFINITY }, twice[2] = { INFINITY, INFINITY };
    int grows = 1;

    for (int k = 0; k < TRIES && grows; k++) {
        write_model(g, g->n / 2);
        measure(half);
        write_model(g, 2 * g->n);
        measure(twice);
        grows = twice[0] > GROWTH * GROWTH * fmax(LEAST, half[0]) || twice[1] > GROWTH * GROWTH * half[1];
    }
    ck_assert_msg(!grows, "%s: %g s and %g s, %g kB and %g kB", what, half[0], twice[0], half[1], twice[1]);
}

START_TEST(twice_as_many_statements_take_twice_as_much)
{
    const growing *g = &rows[_i];
    char what[100];

    snprintf(what, sizeof what, "row %d, %.40s", _i, *g->each ? g->each : g->before);
    check_growth(g, what);
}
END_TEST

/* As they stand in the table of program/statements.c. */
START_TEST(each_statement_is_there)
{
    char *text = read_all("program/statements.c"), *at = strstr(text, "} kinds[] = {"), name[40];

    while ((at = strstr(at, "\n    { \"")) != NULL && sscanf(at += 8, "%39[a-z]", name) == 1) {
        int there = 0;
        for (int k = 0; k < COUNT(rows); k++)
            there |= strstr(rows[k].each, name) || strstr(rows[k].before, name);
        ck_assert_msg(there, "%s", name);
    }
    free(text);
}
END_TEST

#define LARGE "\nmaterial large E 1e9 nu 0.2 density 2500\ngrid large large 1000 0 $ 1 $ 1\n"

/* The wrong models, each with a grid beside what is wrong. Those of `repeat` run to its bound, whatever follows. */
START_TEST(an_error_in_a_model_twice_as_large_takes_twice_as_much)
{
    DIR *d = opendir("tests/bad");
    struct dirent *entry;
    char path[300];

    for (int k = 0; (entry = readdir(d)) != NULL; )
        if (strstr(entry->d_name, ".model") && strncmp(entry->d_name, "repeat", 6) != 0 && k++ % SHARES == _i) {
            snprintf(path, sizeof path, "tests/bad/%.200s", entry->d_name);
            char *text = read_all(path);
            check_growth(&(growing){ text, "", LARGE, 500 }, path);
            free(text);
        }
    closedir(d);
}
END_TEST

/* The text of a round, "i = 7", is kept for messages: with this name that were 2 GB. */
START_TEST(rounds_with_a_long_name_are_bounded)
{
    char name[1001];

    memset(name, 'i', 1000);
    name[1000] = '\0';
    ck_assert_int_eq(run_printed("rounds", ONE "repeat %s 1 500000\nend\n", name), 2);
    check_text("out/model/rounds.err", "rounds.model:6: iiii");
    check_text("out/model/rounds.err", "the values of numbers take more than 67108864 bytes");
}
END_TEST

static void make_folder(void) { shell("rm -rf out/model; mkdir -p out/model"); }

Suite *growth_suite(void)
{
    Suite *s = suite_create("growth");
    TCase *t = new_case(s, "growth");

    tcase_set_timeout(t, 120);
    tcase_add_unchecked_fixture(t, make_folder, NULL);
    tcase_add_loop_test(t, twice_as_many_statements_take_twice_as_much, 0, COUNT(rows));
    tcase_add_test(t, each_statement_is_there);
    tcase_add_test(t, rounds_with_a_long_name_are_bounded);
    tcase_add_loop_test(t, an_error_in_a_model_twice_as_large_takes_twice_as_much, 0, SHARES);
    return s;
}
