/* output.c - files that get their name when they are complete; folders, and whose they are.
 *
 * A run locks its folder by a file in it. What is locked is the file that is open (fcntl of POSIX,
 * on Windows one that nobody else may open), and the system gives it free when the process ends,
 * however it ends, also in another container on the same machine. A lock file without its owner is
 * just a file: the next run takes it. */
#define _POSIX_C_SOURCE 200809L
#include "output.h"

#include <errno.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#ifdef _WIN32
#include <direct.h>
#include <share.h>
#define mkdir(path, mode) _mkdir(path)
#define rename(from, to) (remove(to), rename(from, to)) /* there a name that is taken is an error */
#else
#include <fcntl.h>
#endif

#define ENDING ".tmp"

int output_open(output *o, const char *path)
{
    struct stat old;

    *o = (output){ 0 };
    if ((size_t)snprintf(o->path, sizeof o->path, "%s", path) >= sizeof o->path)
        return o->why = errno = ENAMETOOLONG, 0;
    o->direct = stat(path, &old) == 0 && !S_ISREG(old.st_mode);
    if (o->direct && S_ISFIFO(old.st_mode))
        return o->why = errno = ENOTSUP, 0;                 /* nobody may ever read it */
    snprintf(o->temporary, sizeof o->temporary, "%s.%ld" ENDING, path, (long)getpid());
    o->file = fopen(o->direct ? path : o->temporary, "wb");
    o->why = errno = o->file ? 0 : errno;
    return o->file != NULL;
}

int output_note(output *o, int good)
{
    if (!good && !o->why)
        o->why = errno ? errno : EIO;
    return !o->why;
}

int output_keep(output *o)
{
    if (output_note(o, !fflush(o->file) && !ferror(o->file)))
        o->kept = ftell(o->file);
    return !o->why;
}

/* Replaces a file of that name. What is kept of a file that is cut off is what was whole. */
int output_close(output *o)
{
    FILE *file = o->file;

    o->file = NULL;
    if (!file)
        return errno = o->why, 0;
    output_note(o, !fflush(file) && !ferror(file));
    output_note(o, !fclose(file));
    const int keep = !o->why || (o->kept > 0 && !o->direct && !truncate(o->temporary, o->kept));
    if (!keep || !(o->direct || !rename(o->temporary, o->path) || output_note(o, 0)))
        remove(o->temporary);
    errno = o->why;
    return !o->why;
}

int output_make_folder(const char *path)
{
    char part[LONGEST];
    struct stat there;
    int made = 0;

    for (const char *end = path; end; ) {
        end = strchr(end + 1, '/');
        snprintf(part, sizeof part, "%.*s", end ? (int)(end - path) : LONGEST - 1, path);
        made = mkdir(part, 0777) == 0;
    }
    return made || (errno == EEXIST && stat(path, &there) == 0 && S_ISDIR(there.st_mode));
}

int output_has_form(const char *name, const char *stem, const char *ending)
{
    char form[100];
    int n = 0, temporary = 0;

    snprintf(form, sizeof form, "%s%s%%n", stem, ending);
    sscanf(name, form, &n);
    sscanf(name + n, ".%*[0-9]" ENDING "%n", &temporary);
    return n > 0 && !name[n + temporary];
}

/* On Windows all files have the number 0, and none is removed that is open. */
int output_holds(FILE *f, const char *path)
{
    struct stat there, own;

    return !fstat(fileno(f), &own) && !stat(path, &there) && there.st_ino == own.st_ino;
}

FILE *output_lock(const char *path)
{
#ifdef _WIN32
    FILE *f = _fsopen(path, "a", _SH_DENYRW);

    errno = !f && errno == EACCES ? EBUSY : errno;
    return f;
#else
    struct flock all = { .l_type = F_WRLCK, .l_whence = SEEK_SET };
    FILE *f = fopen(path, "a");
    int why = 0;

    if (!f)
        return NULL;
    if (fcntl(fileno(f), F_SETLK, &all))
        why = errno == EACCES || errno == EAGAIN ? EBUSY : errno;
    else if (!output_holds(f, path))
        why = EBUSY;            /* its owner has removed it by now */
    if (!why)
        return f;
    fclose(f);
    errno = why;
    return NULL;
#endif
}

void output_unlock(FILE *f, const char *path)
{
    remove(path);               /* while it is ours; on Windows it is open and stays */
    fclose(f);
#ifdef _WIN32
    remove(path);
#endif
}
