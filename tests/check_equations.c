/* check_equations.c - doc/equations.md against the sources: each equation of the paper has one row;
 * a function of the row cites it; each function of the row is defined in the file behind it, under a
 * comment that cites an equation of the row; each test of the row is there.
 *
 * A citation is "Eq. (n)", and all that goes on behind it: "Eq. (18)-(23)", "Eq. (53), (60)-(62)",
 * "Eq. (57) and (61)", "Eq. (58a-f)".
 */
#define _POSIX_C_SOURCE 200809L
#include <ctype.h>
#include <glob.h>
#include <stdio.h>
#include <string.h>

#include "programs.h"

enum { EQUATIONS = 72, NAME = 120 };

/* ------------------------------------------------------------------------- what a comment cites */

/* Reads "(12)", "(58a-f)" at *p; 0 if there is none. */
static int read_number(const char **p)
{
    char *end;

    if (**p != '(' || !isdigit((unsigned char)(*p)[1]))
        return 0;
    const long n = strtol(*p + 1, &end, 10);
    while (islower((unsigned char)*end) || *end == '-')
        end++;
    if (*end != ')')
        return 0;
    *p = end + 1;
    return (int)n;
}

static int skip(const char **p, const char *word)
{
    if (strncmp(*p, word, strlen(word)) != 0)
        return 0;
    *p += strlen(word);
    return 1;
}

/* Whether a text, the line ends of a comment taken out, cites equation n. */
static int cites(const char *text, int n)
{
    for (const char *p = strstr(text, "Eq. ("); p; p = strstr(p, "Eq. (")) {
        p += strlen("Eq. ");
        for (int first = read_number(&p), more = first; more; more = first) {
            const int last = p[0] == '-' && p[1] == '(' ? (p++, read_number(&p)) : first;
            if (first <= n && n <= last)
                return 1;
            first = skip(&p, ", ") || skip(&p, " and ") ? read_number(&p) : 0;
        }
    }
    return 0;
}

START_TEST(citations_are_read_as_they_are_meant)
{
    const char text[] = "see (3); Eq. (4): k, Eq. (18)-(20), (22) and (58a-f)  ->  (30), Eq. (5).";
    const int cited[] = { 4, 5, 18, 19, 20, 22, 58 };

    for (int n = 1, k = 0; n <= EQUATIONS; n++) {
        const int expected = k < 7 && cited[k] == n;
        ck_assert_msg(cites(text, n) == expected, "(%d) in \"%s\"", n, text);
        k += expected;
    }
}
END_TEST

/* ---------------------------------------------------------------------------------- the sources */

/* Where the function is defined: its name at the beginning of a line that does not end in a
 * semicolon. NULL: nowhere. */
static const char *find_definition(const char *source, const char *function)
{
    const size_t length = strlen(function);

    for (const char *p = strstr(source, function); p; p = strstr(p + 1, function)) {
        const char *line = p;
        while (line > source && line[-1] != '\n')
            line--;
        if (p == line || !isalpha((unsigned char)*line) || p[length] != '(')
            continue;
        if ((p[-1] == ' ' || p[-1] == '*') && p[strcspn(p, ";{")] == '{')
            return line;
    }
    return NULL;
}

/* The comment that ends in the line before `definition`, in one line, or "". */
static void comment_above(const char *source, const char *definition, char *comment, size_t size)
{
    const char *end = definition, *p;

    *comment = '\0';
    if (end - source < 3 || strncmp(end - 3, "*/\n", 3) != 0)
        return;
    for (p = end - 3; p > source && strncmp(p, "/*", 2) != 0; p--)
        ;
    size_t n = 0;
    for (; p < end && n + 1 < size; p++) {
        if (*p != '\n')
            comment[n++] = *p;
        else if (strncmp(p, "\n * ", 4) == 0)
            comment[n++] = ' ', p += 3;
        while (n > 1 && comment[n - 1] == ' ' && comment[n - 2] == ' ')
            n--;
    }
    comment[n] = '\0';
}

START_TEST(the_comment_of_a_function_is_the_one_right_above_it)
{
    const char source[] = "/* of f, Eq.\n * (3). */\nint f(int a);\n\n"
                          "/* of g,\n *     Eq. (4). */\nstatic double g(int a)\n{\n"
                          "    f(a);\n}\n\nint f(int a)\n{\n}\n";
    char comment[200];

    comment_above(source, find_definition(source, "g"), comment, sizeof comment);
    ck_assert_str_eq(comment, "/* of g, Eq. (4). */");
    const char *f = find_definition(source, "f");
    ck_assert(f && strcmp(f, "int f(int a)\n{\n}\n") == 0);
    comment_above(source, f, comment, sizeof comment);
    ck_assert_str_eq(comment, "");
    ck_assert(find_definition(source, "a") == NULL);
}
END_TEST

static int is_test(const char *name)
{
    char start[NAME + 20];
    glob_t files;
    int found = 0;

    snprintf(start, sizeof start, "START_TEST(%s)", name);
    ck_assert_int_eq(glob("tests/*.c", 0, NULL, &files), 0);
    for (size_t f = 0; f < files.gl_pathc && !found; f++) {
        char *text = read_all(files.gl_pathv[f]);
        found = strstr(text, start) != NULL;
        free(text);
    }
    globfree(&files);
    return found;
}

/* ------------------------------------------------------------------------------------ the table */

/* Copies the name between backticks at p; the character behind it. */
static char *read_name(char *p, char name[NAME])
{
    const size_t n = strcspn(p + 1, "`");

    ck_assert_msg(n > 0 && n < NAME && p[n + 1] == '`', "an odd name: %.60s", p);
    memcpy(name, p + 1, n);
    name[n] = '\0';
    return p + n + 2;
}

/* The function is defined in the file, and its comment cites an equation of the row, if it has one:
 * these are noted. */
static void check_function(const char *row, const char *function, const char *file,
                           int noted[EQUATIONS + 1])
{
    char *source = read_all(file), comment[4000];
    const char *definition = find_definition(source, function);
    int equations = 0, found = 0;

    ck_assert_msg(definition != NULL, "%s: %s does not define %s", row, file, function);
    comment_above(source, definition, comment, sizeof comment);
    for (int n = 1; n <= EQUATIONS; n++)
        if (cites(row, n)) {
            equations++;
            if (cites(comment, n))
                found = noted[n] = 1;
        }
    ck_assert_msg(!equations || found, "%s: the comment of %s cites none of %s", file, function, row);
    free(source);
}

/* "`f`, `g` (bbm.c), `h` (contact.c)": the names since the last file are in the next one. The
 * number of functions. */
static int check_functions(const char *row, char *column, int noted[EQUATIONS + 1])
{
    char name[20][NAME], file[NAME];
    int names = 0, all = 0;

    for (char *p = column; *p;) {
        if (*p == '`') {
            ck_assert_int_lt(names, 20);
            p = read_name(p, name[names++]);
        } else if (sscanf(p, "(%100[a-z0-9/_.])", file) == 1) {
            for (int k = 0; k < names; k++, all++)
                check_function(row, name[k], file, noted);
            names = 0;
            p = strchr(p, ')');
        } else {
            p++;
        }
    }
    ck_assert_msg(names == 0, "%s: no file behind %s", row, names ? name[names - 1] : "");
    return all;
}

static int check_tests(const char *row, char *column)
{
    char name[NAME];
    int all = 0;

    for (char *p = strchr(column, '`'); p; p = strchr(p, '`'), all++) {
        p = read_name(p, name);
        ck_assert_msg(is_test(name), "%s: there is no test %s", row, name);
    }
    return all;
}

START_TEST(each_equation_has_functions_that_cite_it_and_tests_that_exist)
{
    char *text = read_all("doc/equations.md"), *rest = NULL;
    int rows[EQUATIONS + 1] = { 0 }, noted[EQUATIONS + 1] = { 0 };

    for (char *line = strtok_r(text, "\n", &rest); line; line = strtok_r(NULL, "\n", &rest)) {
        char *end, *column[4] = { line + 1, NULL, NULL, NULL };
        char row[NAME];
        if (strncmp(line, "| ", 2) != 0 || strncmp(line, "| Eq.", 5) == 0)
            continue;
        for (int c = 1; c < 4; c++) {
            end = strchr(column[c - 1], '|');
            ck_assert_msg(end != NULL, "four columns are expected: %.60s", line);
            *end = '\0';
            column[c] = end + 1;
        }
        snprintf(row, sizeof row, "Eq. %s", line + 2);
        ck_assert_msg(check_functions(row, column[2], noted) > 0, "%s: no function", line);
        ck_assert_msg(check_tests(row, column[3]) > 0, "%s: no test", line);
        for (int n = 1; n <= EQUATIONS; n++)
            rows[n] += cites(row, n);
    }
    for (int n = 1; n <= EQUATIONS; n++)
        ck_assert_msg(rows[n] == 1 && noted[n], "doc/equations.md has %d rows for Eq. (%d), cited: %d",
                      rows[n], n, noted[n]);
    free(text);
}
END_TEST

/* Whether a word stands in the text by itself. */
static int has_word(const char *text, const char *word)
{
    const size_t length = strlen(word);

    for (const char *p = strstr(text, word); p; p = strstr(p + 1, word))
        if ((p == text || (!isalnum((unsigned char)p[-1]) && p[-1] != '_'))
            && !isalnum((unsigned char)p[length]) && p[length] != '_')
            return 1;
    return 0;
}

/* Each name in the picture of the house, a word with an underscore in it, is one of the sources; each
 * file is there, and each file of beyond/ is in it. */
START_TEST(the_picture_of_the_house_names_what_there_is)
{
    const char *const path[] = { "bbm.h", "bbm.c", "contact.c", "solver.c", "base/base.h", "base/build.c",
                                 "beyond/beyond.c" };
    const char *const folder[] = { "", "base/", "beyond/" };
    char *picture = read_all("doc/house.svg"), *source[COUNT(path)], word[NAME], file[NAME + 16];
    int names = 0, files = 0;

    for (int k = 0; k < COUNT(path); k++)
        source[k] = read_all(path[k]);
    for (const char *p = picture; *p;) {
        const size_t n = strspn(p, "abcdefghijklmnopqrstuvwxyz_0123456789");
        if (n == 0 || n >= NAME || *p == '_') {
            p += n == 0 ? 1 : n;
            continue;
        }
        snprintf(word, sizeof word, "%.*s", (int)n, p);
        p += n;
        int known = 0;
        for (int k = 0; k < COUNT(path); k++)
            known |= has_word(source[k], word);
        if (strchr(word, '_') && word[n - 1] != '_') {
            ck_assert_msg(known, "doc/house.svg names %s", word);
            names++;
        }
        if (p[0] == '.' && p[1] == 'c' && !isalpha((unsigned char)p[2])) {
            FILE *f = NULL;
            for (int k = 0; k < 3 && !f; k++) {
                snprintf(file, sizeof file, "%s%s.c", folder[k], word);
                f = fopen(file, "r");
            }
            ck_assert_msg(f != NULL, "doc/house.svg names %s.c", word);
            fclose(f);
            files++;
        }
    }
    ck_assert(names > 30 && files > 15);
    glob_t all;
    ck_assert_int_eq(glob("beyond/*.c", 0, NULL, &all), 0);
    for (size_t k = 0; k < all.gl_pathc; k++)
        ck_assert_msg(strstr(picture, all.gl_pathv[k] + strlen("beyond/"))
                      || strcmp(all.gl_pathv[k], "beyond/beyond.c") == 0,
                      "doc/house.svg lacks %s", all.gl_pathv[k]);
    globfree(&all);
    for (int k = 0; k < COUNT(path); k++)
        free(source[k]);
    free(picture);
}
END_TEST

Suite *equations_suite(void)
{
    Suite *s = suite_create("equations");
    TCase *t = new_case(s, "equations");

    tcase_add_test(t, citations_are_read_as_they_are_meant);
    tcase_add_test(t, the_comment_of_a_function_is_the_one_right_above_it);
    tcase_add_test(t, each_equation_has_functions_that_cite_it_and_tests_that_exist);
    tcase_add_test(t, the_picture_of_the_house_names_what_there_is);
    return s;
}
