/* programs.c - running the programs from the tests, and reading what they write. */
#define _POSIX_C_SOURCE 200809L
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>

#include "programs.h"

int shell(const char *format, ...)
{
    char command[LONG];
    va_list args;

    va_start(args, format);
    vsnprintf(command, sizeof command, format, args);
    va_end(args);
    const int status = system(command);
    ck_assert(status != -1 && WIFEXITED(status));
    return WEXITSTATUS(status);
}

const char *slurp(const char *path)
{
    static char text[LONG];
    FILE *f = fopen(path, "rb");
    const size_t got = f ? fread(text, 1, LONG - 1, f) : 0;

    text[got] = '\0';
    if (f)
        fclose(f);
    return text;
}

char *read_all(const char *path)
{
    FILE *f = fopen(path, "rb");

    ck_assert_msg(f && fseek(f, 0, SEEK_END) == 0, "%s cannot be read", path);
    const size_t n = (size_t)ftell(f);
    rewind(f);
    char *text = calloc(n + 1, 1);
    ck_assert(text && fread(text, 1, n, f) == n);
    fclose(f);
    return text;
}

void check_text(const char *path, const char *expected)
{
    char *text = read_all(path);

    ck_assert_msg(strstr(text, expected), "%s lacks '%s': %.1000s", path, expected, text);
    free(text);
}

void write_text(const char *path, const char *text)
{
    FILE *f = fopen(path, "w");

    ck_assert_ptr_nonnull(f);
    fputs(text, f);
    ck_assert_int_eq(fclose(f), 0);
}

int run_text(const char *name, const char *text)
{
    char path[100];

    snprintf(path, sizeof path, "out/model/%s.model", name);
    write_text(path, text);
    return shell("rm -rf out/model/%s; %s/bbm -q out/model/%s.model -o out/model/%s > "
                 "out/model/%s.out 2> out/model/%s.err", name, BUILD, name, name, name, name);
}

int run_printed(const char *name, const char *format, ...)
{
    char text[LONG];
    va_list args;

    va_start(args, format);
    const int length = vsnprintf(text, sizeof text, format, args);
    va_end(args);
    ck_assert_int_lt(length, LONG);
    return run_text(name, text);
}

double cell(const char *name, const char *file, const char *row, const char *column)
{
    char path[100], line[LONG], found[LONG] = "";
    int k = 0;

    snprintf(path, sizeof path, "out/model/%s/%s", name, file);
    FILE *f = fopen(path, "r");
    ck_assert_msg(f && fgets(line, sizeof line, f), "%s cannot be read", path);
    line[strcspn(line, "\n")] = '\0';
    char *rest = NULL, *head = strtok_r(line, ",", &rest);
    for (; head && strcmp(head, column) != 0; head = strtok_r(NULL, ",", &rest))
        k++;
    ck_assert_msg(head != NULL, "%s has no column %s", path, column);
    while (fgets(line, sizeof line, f))
        if (strncmp(line, row, strlen(row)) == 0)
            strcpy(found, line);
    fclose(f);
    ck_assert_msg(*found, "%s has no row %s", path, row);
    char *p = found;
    while (k-- > 0)
        p = strchr(p, ',') + 1;
    return strtod(p, NULL);
}

double sum(const char *name, const char *file, const char *column, const char *part)
{
    ck_assert_int_eq(shell("awk -F, 'NR == 1 { for (k = 1; k <= NF; k++) if ($k == \"%s\") c = k; "
                           "next } /%s/ { s += $c } END { printf \"%%.15g\", s }' out/model/%s/%s "
                           "> out/model/sum", column, part, name, file), 0);
    return strtod(slurp("out/model/sum"), NULL);
}

int run_with(const char *model, const char *lets)
{
    return shell("%s/bbm -q cases/models/%s.model %s -o out/model/%s > out/model/said 2> out/model/err", BUILD,
                 model, lets, model);
}
