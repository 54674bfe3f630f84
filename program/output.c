/* output.c - files that get their name when they are complete; folders. */
#define _POSIX_C_SOURCE 200809L
#include "output.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#ifdef _WIN32
#include <direct.h>
#else
#include <signal.h>
#endif

#define ENDING ".tmp"

int output_open(output *o, const char *path)
{
    struct stat old;

    o->file = NULL;
    if ((size_t)snprintf(o->path, sizeof o->path, "%s", path) >= sizeof o->path) {
        errno = ENAMETOOLONG;
        return 0;
    }
    o->direct = stat(path, &old) == 0 && !S_ISREG(old.st_mode);
    if (o->direct)
        memcpy(o->temporary, o->path, sizeof o->path);
    else
        snprintf(o->temporary, sizeof o->temporary, "%s.%ld" ENDING, path, (long)getpid());
    o->file = fopen(o->temporary, "wb");
    return o->file != NULL;
}

static void give_up(const output *o, int why)
{
    if (!o->direct)
        remove(o->temporary);
    errno = why;
}

void output_drop(output *o)
{
    const int why = errno;

    if (o->file) {
        fclose(o->file);
        give_up(o, why);
    }
    o->file = NULL;
}

/* Replaces a file of that name. */
static int give_name(const char *from, const char *to)
{
#ifdef _WIN32
    remove(to);                 /* there, a name that is taken is an error */
#endif
    return rename(from, to) == 0;
}

int output_close(output *o)
{
    FILE *file = o->file;

    o->file = NULL;
    if (!file)
        return 0;
    errno = 0;
    const int bad = fflush(file) || ferror(file), why = errno;
    if (fclose(file) || bad || (!o->direct && !give_name(o->temporary, o->path))) {
        give_up(o, why ? why : errno);
        return 0;
    }
    return 1;
}

int output_make_folder(const char *path)
{
    struct stat there;
#ifdef _WIN32
    const int made = _mkdir(path) == 0;
#else
    const int made = mkdir(path, 0777) == 0;
#endif

    return made || (errno == EEXIST && stat(path, &there) == 0 && S_ISDIR(there.st_mode));
}

size_t output_is_temporary(const char *name, long *process)
{
    const size_t n = strlen(name), ending = strlen(ENDING);
    size_t k = n < ending ? 0 : n - ending;

    if (k == 0 || strcmp(name + k, ENDING) != 0)
        return 0;
    while (k > 0 && name[k - 1] >= '0' && name[k - 1] <= '9')
        k--;
    *process = strtol(name + k, NULL, 10);
    return k > 1 && name[k - 1] == '.' && *process > 0 ? k - 1 : 0;
}

int output_is_alive(long process)
{
#ifdef _WIN32
    (void)process;
    return 0;
#else
    return process != (long)getpid() && (kill((pid_t)process, 0) == 0 || errno == EPERM);
#endif
}
