/* write.c - results as files. Every number has 15 significant digits, those of K and F 17, with which a double comes
 * back as it was. Nodes are those of the library's model: a node of the file for each block that has it. */
#define _POSIX_C_SOURCE 200809L
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "case.h"
#include "write.h"

/* ------------------------------------------------------------------------------------------------------ files */

static int fail(write_results *w, const char *path, const char *why)
{
    if (!w->status)
        snprintf(w->message, sizeof w->message, "%s cannot be written: %s", path, why);
    w->status = 1;
    return 0;
}

/* A file that is there and is no regular one, a device or a pipe, is written as it is: it must not be replaced. */
static int open_file(write_results *w, write_file *f, const char *folder, const char *name)
{
    struct stat old;

    f->file = NULL;
    if ((size_t)snprintf(f->path, sizeof f->path, "%s%s%s", folder, *folder ? "/" : "", name) >= sizeof f->path)
        return fail(w, f->path, "the name is too long");
    f->direct = stat(f->path, &old) == 0 && !S_ISREG(old.st_mode);
    snprintf(f->temporary, sizeof f->temporary, "%s%s", f->path, f->direct ? "" : ".tmp");
    f->file = fopen(f->temporary, "w");
    return f->file ? 1 : fail(w, f->path, strerror(errno));
}

static int close_file(write_results *w, write_file *f)
{
    FILE *file = f->file;

    f->file = NULL;
    if (!file)
        return 0;
    errno = 0;
    const int bad = fflush(file) || ferror(file), why = errno;
    if (fclose(file) || bad) {
        if (!f->direct)
            remove(f->temporary);
        return fail(w, f->path, strerror(why ? why : errno));
    }
    if (!f->direct && rename(f->temporary, f->path))
        return fail(w, f->path, strerror(errno));
    return 1;
}

/* ----------------------------------------------------------------------------------------------------- tables */

static void put_numbers(FILE *f, int n, const double x[])
{
    for (int k = 0; k < n; k++)
        fprintf(f, ",%.15g", x[k]);
}

static void put_nodes(FILE *f, const model *p)
{
    fprintf(f, "node,block,x,y,u,v,sxx,syy,sxy,mises\n");
    for (int n = 0; n < p->m->nodes; n++) {
        bbm_result r;
        bbm_nodal_result(p->m, n, -1, &r);
        const double x[] = { p->m->node[n].x, p->m->node[n].y, r.u, r.v };
        fprintf(f, "%s,%s", p->node[n], p->block[p->node_block[n]]);
        put_numbers(f, 4, x);
        put_numbers(f, 3, r.stress);
        put_numbers(f, 1, &r.mises);
        fputc('\n', f);
    }
}

static void put_elements(FILE *f, const model *p)
{
    fprintf(f, "element,block,x,y,u,v,rotation,sxx,syy,sxy,mises\n");
    for (int e = 0; e < p->m->elements; e++) {
        const bbm_element *i = &p->m->element[e];
        const double mises = bbm_mises(i->stress);
        fprintf(f, "%s,%s", p->element[e], p->block[i->block]);
        put_numbers(f, 2, p->centre[e]);
        put_numbers(f, 3, i->sum);
        put_numbers(f, 3, i->stress);
        put_numbers(f, 1, &mises);
        fputc('\n', f);
    }
}

/* Static steps take no time: t stays 0. */
static double time_of(const model *p, int step) { return p->dynamic ? step * p->m->par.dt : 0; }

static void put_history(const write_results *w, int step)
{
    const model *p = w->p;

    fprintf(w->history.file, "%d,%.15g", step, time_of(p, step));
    for (int k = 0; k < p->monitors; k++) {
        const model_monitor *m = &p->monitor[k];
        double mean[2] = { 0, 0 };
        for (int n = 0; n < m->nodes; n++) {
            bbm_result r;
            bbm_nodal_result(p->m, m->node[n], -1, &r);
            mean[0] += r.u / m->nodes;
            mean[1] += r.v / m->nodes;
        }
        put_numbers(w->history.file, 2, mean);
    }
    fputc('\n', w->history.file);
}

static void put_summary(const write_results *w, int step)
{
    const bbm_info *i = &w->p->m->info;
    bbm_energy e;

    bbm_energies(w->p->m, &e);
    fprintf(w->summary.file, "%d,%.15g,%d,%d,%.15g,%d", step, time_of(w->p, step), i->passes, i->iterations,
            i->pcg.residual, i->contacts);
    put_numbers(w->summary.file, 4, (double[]){ e.kinetic, e.elastic, e.springs, i->work });
    fputc('\n', w->summary.file);
}

static double seconds(clock_t t) { return (double)t / CLOCKS_PER_SEC; }

static void put_timing(FILE *f, const write_results *w)
{
    const double *s = w->p->m->info.seconds;

    fprintf(f, "phase,seconds\nread,%.15g\ndetect,%.15g\nassemble,%.15g\nprecondition,%.15g\niterate,%.15g\n",
            seconds(w->reading), s[BBM_DETECT], s[BBM_ASSEMBLE], s[BBM_PRECONDITION], s[BBM_ITERATE]);
    fprintf(f, "write,%.15g\ntotal,%.15g\n", seconds(w->writing), seconds(clock() - w->start));
}

/* -------------------------------------------------------------------------------------------------------- VTK */

static void put_scalars(FILE *f, const bbm_model *m, const char *name, int component)
{
    fprintf(f, "SCALARS %s double 1\nLOOKUP_TABLE default\n", name);
    for (int e = 0; e < m->elements; e++)
        fprintf(f, "%.15g\n", component < 3 ? m->element[e].stress[component] : bbm_mises(m->element[e].stress));
}

static void put_cells(FILE *f, const bbm_model *m)
{
    fprintf(f, "CELLS %d %d\n", m->elements, m->elements + m->vertices);
    for (int e = 0; e < m->elements; e++) {
        fprintf(f, "%d", m->element[e].n);
        for (int v = m->element[e].first; v < m->element[e].first + m->element[e].n; v++)
            fprintf(f, " %d", m->vertex[v].node);
        fputc('\n', f);
    }
    fprintf(f, "CELL_TYPES %d\n", m->elements);
    for (int e = 0; e < m->elements; e++)
        fprintf(f, "%d\n", m->element[e].n == 3 ? 5 : m->element[e].n == 4 ? 9 : 7);
}

/* Legacy VTK, ASCII: points where they started, with the displacement as a vector to warp by; cells with stress. */
static void put_vtk(FILE *f, const model *p, double t)
{
    const bbm_model *m = p->m;
    static const char *const name[] = { "sxx", "syy", "sxy", "mises" };

    fprintf(f, "# vtk DataFile Version 3.0\n%.200s\nASCII\nDATASET UNSTRUCTURED_GRID\n", p->title ? p->title : "bbm");
    fprintf(f, "FIELD FieldData 1\nTIME 1 1 double\n%.15g\nPOINTS %d double\n", t, m->nodes);
    for (int n = 0; n < m->nodes; n++)
        fprintf(f, "%.15g %.15g 0\n", m->node[n].x, m->node[n].y);
    put_cells(f, m);
    fprintf(f, "CELL_DATA %d\nSCALARS block int 1\nLOOKUP_TABLE default\n", m->elements);
    for (int e = 0; e < m->elements; e++)
        fprintf(f, "%d\n", m->element[e].block);
    for (int k = 0; k < 4; k++)
        put_scalars(f, m, name[k], k);
    fprintf(f, "POINT_DATA %d\nVECTORS u double\n", m->nodes);
    for (int n = 0; n < m->nodes; n++) {
        bbm_result r;
        bbm_nodal_result(m, n, -1, &r);
        fprintf(f, "%.15g %.15g 0\n", r.u, r.v);
    }
}

static int write_vtk(write_results *w, int step)
{
    write_file f;
    char name[32];

    snprintf(name, sizeof name, "step_%06d.vtk", step);
    if (!open_file(w, &f, w->folder, name))
        return 0;
    put_vtk(f.file, w->p, time_of(w->p, step));
    return close_file(w, &f);
}

/* --------------------------------------------------------------------------------------------------- pictures */

static const char *path_of(const write_results *w, const char *name, char path[1024])
{
    snprintf(path, 1024, "%s/%s", w->folder, name);
    return path;
}

/* The arrays of a map: [nodes] x, y, u, v, mises; [elements+1] first; [vertices] corner. */
static void fill_map(const bbm_model *m, double *at, int *first, int *corner)
{
    for (int n = 0; n < m->nodes; n++) {
        bbm_result r;
        bbm_nodal_result(m, n, -1, &r);
        const double value[5] = { m->node[n].x, m->node[n].y, r.u, r.v, r.mises };
        for (int k = 0; k < 5; k++)
            at[k * m->nodes + n] = value[k];
    }
    for (int e = 0; e < m->elements; e++)
        first[e + 1] = m->element[e].first + m->element[e].n;
    for (int v = 0; v < m->vertices; v++)
        corner[v] = m->vertex[v].node;
}

/* The deformed mesh with von Mises. Static displacements are magnified, those of a motion are not. */
static int draw_mises(write_results *w)
{
    const bbm_model *m = w->p->m;
    const size_t n = (size_t)m->nodes;
    double *at = calloc(5 * n, sizeof *at);
    int *first = calloc((size_t)m->elements + 1, sizeof *first), *corner = calloc((size_t)m->vertices, sizeof *corner);
    char path[1024];
    int done = at && first && corner;

    if (done) {
        fill_map(m, at, first, corner);
        done = plot_write_map(path_of(w, "mises.svg", path), &(plot_map){
            .title = w->p->title, .mesh = { m->nodes, m->elements, at, at + n, first, corner },
            .quantity = { "von Mises", "Pa", 0, 0, 0 }, .value = at + 4 * n, .u = at + 2 * n, .v = at + 3 * n,
            .magnify = w->p->dynamic ? 1 : 0 });
    }
    free(at);
    free(first);
    free(corner);
    return done ? 1 : fail(w, path_of(w, "mises.svg", path), strerror(errno));
}

static int draw_pictures(write_results *w)
{
    const bbm_model *m = w->p->m;
    const double now = m->info.t;
    scene end = { .title = w->p->title };
    char path[1024];

    case_record(&end, m);
    int done = scene_write_panels(&end, m, path_of(w, "contacts.svg", path), 1, &now);
    scene_free(&end);
    if (done && w->p->dynamic && w->film.frames > 0)     /* none, if the first step failed */
        done = scene_write_movie(&w->film, m, path_of(w, "movie.svg", path));
    return done ? draw_mises(w) : fail(w, path, strerror(errno));
}

/* ---------------------------------------------------------------------------------------------- Matrix Market */

static int compare_pairs(const void *p, const void *q)
{
    const int *a = p, *b = q;

    return a[0] != b[0] ? (a[0] > b[0]) - (a[0] < b[0]) : (a[1] > b[1]) - (a[1] < b[1]);
}

/* The pairs i >= j with a submatrix, sorted, each once: the diagonal, bonds and contacts. Returns their number. */
static int list_blocks(const bbm_model *m, int (*pair)[2])
{
    const int others = m->bonds + m->pairs;
    int n = 0;

    for (int i = 0; i < m->elements; i++)
        pair[i][0] = pair[i][1] = i;
    for (int k = 0; k < others; k++) {
        const int i = m->pair[k][0], j = m->pair[k][1];
        pair[m->elements + k][0] = i > j ? i : j;
        pair[m->elements + k][1] = i > j ? j : i;
    }
    qsort(pair, (size_t)(m->elements + others), sizeof *pair, compare_pairs);
    for (int k = 0; k < m->elements + others; k++)
        if (n == 0 || compare_pairs(pair[n - 1], pair[k]) != 0)
            memmove(pair[n++], pair[k], sizeof *pair);
    return n;
}

static void put_matrix(FILE *f, const bbm_model *m, int blocks, int (*pair)[2])
{
    fprintf(f, "%%%%MatrixMarket matrix coordinate real symmetric\n%d %d %lld\n", 6 * m->elements, 6 * m->elements,
            36LL * (blocks - m->elements) + 21LL * m->elements);
    for (int k = 0; k < blocks; k++) {
        const int i = pair[k][0], j = pair[k][1];
        double B[6][6];
        bbm_matrix_get(m->K, i, j, B);
        for (int a = 0; a < 6; a++)
            for (int b = 0; b < (i == j ? a + 1 : 6); b++)
                fprintf(f, "%d %d %.17g\n", 6 * i + a + 1, 6 * j + b + 1, B[a][b]);
    }
}

void write_matrix(const bbm_model *m, void *results)
{
    write_results *w = results;
    const clock_t start = clock();
    int (*pair)[2];
    char name[1024];
    write_file f;

    if (w->matrix_done++)
        return;
    pair = calloc((size_t)m->elements + (size_t)m->bonds + (size_t)m->pairs, sizeof *pair);
    if (!pair) {
        fail(w, w->matrix, "out of memory");
    } else if (open_file(w, &f, "", w->matrix)) {
        put_matrix(f.file, m, list_blocks(m, pair), pair);
        close_file(w, &f);
    }
    free(pair);
    snprintf(name, sizeof name, "%s.rhs", w->matrix);
    if (!w->status && open_file(w, &f, "", name)) {
        fprintf(f.file, "%%%%MatrixMarket matrix array real general\n%d 1\n", 6 * m->elements);
        for (int k = 0; k < 6 * m->elements; k++)
            fprintf(f.file, "%.17g\n", m->F[k]);
        close_file(w, &f);
    }
    w->writing += clock() - start;
}

/* ------------------------------------------------------------------------------------------------- the run */

int write_open(write_results *w)
{
    struct stat there;

    if (mkdir(w->folder, 0777) && errno != EEXIST)
        return fail(w, w->folder, strerror(errno));
    if (stat(w->folder, &there) || !S_ISDIR(there.st_mode))
        return fail(w, w->folder, "it is there and no folder; another one may be given with -o");
    if (!open_file(w, &w->history, w->folder, "history.csv") || !open_file(w, &w->summary, w->folder, "summary.csv")) {
        if (w->history.file)
            fclose(w->history.file), remove(w->history.temporary);
        return 0;
    }
    fprintf(w->history.file, "step,t");
    for (int k = 0; k < w->p->monitors; k++)
        fprintf(w->history.file, ",%s_u,%s_v", w->p->monitor[k].name, w->p->monitor[k].name);
    fprintf(w->history.file, "\n");
    fprintf(w->summary.file, "step,t,open_close,pcg_iterations,residual,contacts,kinetic,elastic,springs,external\n");
    w->film.title = w->p->title;
    return 1;
}

int write_step(write_results *w, int step)
{
    const clock_t start = clock();
    const model *p = w->p;

    w->step = step;
    put_history(w, step);
    if (step > 0)
        put_summary(w, step);
    if (p->svg && p->dynamic && (p->every == 0 || step % p->every == 0))
        case_record(&w->film, p->m);
    if (p->vtk && p->every && step % p->every == 0)
        write_vtk(w, step);
    if (ferror(w->history.file) || ferror(w->summary.file))
        fail(w, w->folder, strerror(errno));
    w->writing += clock() - start;
    return !w->status;
}

int write_close(write_results *w)
{
    const clock_t start = clock();
    const model *p = w->p;
    const struct { const char *name; void (*put)(FILE *f, const model *p); } table[] = {
        { "nodes.csv", put_nodes }, { "elements.csv", put_elements },
    };
    write_file f;

    close_file(w, &w->history);
    close_file(w, &w->summary);
    for (int k = 0; k < 2; k++)
        if (open_file(w, &f, w->folder, table[k].name)) {
            table[k].put(f.file, p);
            close_file(w, &f);
        }
    if (p->vtk && (p->every == 0 || w->step % p->every != 0))
        write_vtk(w, w->step);
    if (p->svg)
        draw_pictures(w);
    scene_free(&w->film);
    w->writing += clock() - start;
    if (open_file(w, &f, w->folder, "timing.csv")) {
        put_timing(f.file, w);
        close_file(w, &f);
    }
    return !w->status;
}
