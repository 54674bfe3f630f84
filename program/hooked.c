/* hooked.c - statements that take part in the library's step by its hooks. The library knows its
 * own part of bbm_beyond; what is behind it belongs to the hooks, which find it there.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "reader.h"

typedef struct {
    bbm_beyond library;
    model *p;
    bbm_status (*begin)(bbm_model *m);          /* the library's hook */
} hooked;

static hooked *hooked_of(const bbm_model *m) { return (hooked *)m->beyond; }

/* --------------------------------------------------- shake FILE: a record of the acceleration */

/* A line TIME AX [AY]; what is above the first number is a head. */
static int read_row(model_reader *r, char *line, model_place at)
{
    static const char blanks[] = ",; \t\r";
    model *p = r->p;
    double x[4] = { 0 };
    char *end = "";
    int n = 0;

    line[strcspn(line, "#")] = '\0';
    for (char *w = strtok(line, blanks); w && n < 4 && !*end; w = strtok(NULL, blanks))
        x[n++] = strtod(w, &end);
    if (n == 0 || (n == 1 && *end && !p->shakings))
        return 1;
    if (*end || n < 2 || n > 3 || !isfinite(x[0] + x[1] + x[2])
        || (p->shakings && x[0] <= p->shaking[p->shakings - 1].t))
        return model_fail(r, at, "expected numbers TIME AX [AY], each time behind the one before");
    return model_add(r, &p->shaking, &p->shakings, sizeof *p->shaking,
                     &(model_shaking){ x[0], { x[1], x[2] } });
}

int model_read_record(model_reader *r, const char *path)
{
    model_place at = { path, 1, NULL };
    size_t size;

    for (char *line = model_load(r, path, r->s->at, &size), *next; line; line = next, at.line++) {
        if ((next = strchr(line, '\n')) != NULL)
            *next++ = '\0';
        if (!read_row(r, line, at))
            return 0;
    }
    return r->p->shakings || model_blame(r, "%.200s has no row, expected TIME AX [AY]", path);
}

/* Gravity less the acceleration of the base in the middle of the step, which is the mean between
 * two rows. */
static bbm_status begin(bbm_model *m)
{
    const bbm_status status = hooked_of(m)->begin(m);
    const model *p = hooked_of(m)->p;
    const model_shaking *q = p->shaking, *end = q + p->shakings - 1;
    const double t = m->info.t + m->h / 2;

    while (q < end && q[1].t < t)
        q++;
    for (int a = 0; a < 2 && t >= q->t && q < end; a++)
        m->acceleration[a] -= p->shake * (q[0].a[a] + (t - q[0].t) / (q[1].t - q[0].t)
                                                          * (q[1].a[a] - q[0].a[a]));
    return status;
}

/* ------------------------------------------------------------------------------------ the hooks */

int model_hook(model_reader *r)
{
    model *p = r->p;
    bbm_hooks *hook = p->m->hook;

    if (!p->shakings)
        return 1;
    hooked *b = realloc(p->m->beyond, sizeof *b);
    if (!b)
        return model_out_of_memory(r);
    p->m->beyond = &b->library;
    b->p = p;
    b->begin = hook->begin;
    hook->begin = begin;
    return 1;
}
