/* write.c - results as files. Every number has 15 significant digits, those of K and F 17, with
 * which a double comes back as it was. Nodes are those of the library's model: a node of the
 * file for each block that has it. */
#define _POSIX_C_SOURCE 200809L
#include <dirent.h>
#include <errno.h>
#include <sys/stat.h>

#include "plot.h"
#include "write.h"

#define LOCK "bbm.lock"

/* What history.svg shows: so many rows at most, and its columns; those of monitor k are from
 * MONITORS + MODEL_FOLLOWED k on. */
enum { ROWS = 1025, T = 0, KINETIC, ELASTIC, SPRINGS, EXTERNAL, GAINED, MONITORS };
enum { PANEL = 300, BANDS = 6 };        /* pixels; expectations of a monitor that are drawn */

/* ---------------------------------------------------------------------------------------- files */

static int fail(write_results *w, const char *path, const char *why)
{
    fprintf(stderr, "%s: ", w->source);
    if (w->p->m->info.step > 0)
        fprintf(stderr, "step %d: ", w->p->m->info.step);
    fprintf(stderr, "%s cannot be written: %s\n", path, why);
    w->status = 1;
    return 0;
}

/* In the folder, until the next one; form: a name, with %06d where the number of the step is. */
static const char *path_of(write_results *w, const char *form)
{
    const int n = snprintf(w->path, sizeof w->path, "%s/", w->folder);

    snprintf(w->path + n, sizeof w->path - (size_t)n, form, w->step);
    return w->path;
}

static int open_file(write_results *w, output *f, const char *path)
{
    return w->lock && (output_open(f, path) || fail(w, path, strerror(errno)));
}

static int close_file(write_results *w, output *f)
{
    char why[200];

    if (output_close(f) || !w->lock)
        return 1;
    snprintf(why, sizeof why, "%.100s%s", strerror(errno),
             f->kept > 0 ? "; it ends before that" : "");
    return fail(w, f->path, why);
}

static int write_file(write_results *w, const char *path,
                      void (*put)(FILE *f, const write_results *w))
{
    output f;

    if (!open_file(w, &f, path))
        return 0;
    put(f.file, w);
    return close_file(w, &f);
}

/* --------------------------------------------------------------------------------------- tables */

static void put_numbers(FILE *f, int n, const double x[])
{
    for (int k = 0; k < n; k++)
        fprintf(f, ",%.15g", x[k]);
}

/* A row for each element, or for each node and part that has it: what it is, where it began, the
 * fields of the file. A part is what elements of `m` have for their block. */
static void put_results(FILE *f, const model *p, const bbm_model *m, int files)
{
    const int nodes = files & FIELD_NODES;

    fprintf(f, "%s,block,x,y", nodes ? "node" : "element");
    for (const field *q = field_table; q->name; q++)
        if (q->files & files)
            fprintf(f, ",%s", q->name);
    fputc('\n', f);
    for (int k = 0; k < (nodes ? m->vertices : m->elements); k++) {
        const int v = nodes ? m->adjacent[k] : m->element[k].first, n = m->vertex[v].node;
        const int e = m->vertex[v].element, part = m->element[e].block;
        int again = field_is_gone(m, v);
        for (int a = m->adjacent_first[n]; nodes && a < k; a++)
            again |= m->element[m->vertex[m->adjacent[a]].element].block == part;
        if (again)
            continue;
        fprintf(f, "%s,%s", nodes ? p->node[n] : p->element[k], p->block[p->m->element[e].block]);
        put_numbers(f, 2, nodes ? (double[]){ m->node[n].x, m->node[n].y } : p->centre[k]);
        double all[FIELD_ROWS];
        if (nodes)
            field_all_of_node(m, n, part, 1, all);
        for (const field *q = field_table; q->name; q++)
            if (q->files & files)
                put_numbers(f, 1, nodes ? &all[q - field_table]
                                        : (double[]){ field_of_element(q, m, k) });
        fputc('\n', f);
    }
}

/* Where bonds have broken, each piece of a block has its own rows. */
static void put_nodes(FILE *f, const write_results *w)
{
    const bbm_beyond *b = w->p->m->beyond;
    bbm_model m = *w->p->m;

    if (b->broken > 0) {
        m.element = b->end_element;                     /* scratch between the steps */
        bbm_find_pieces(w->p->m, b->body);
        for (int i = 0; i < m.elements; i++) {
            m.element[i] = w->p->m->element[i];
            m.element[i].block = b->body[i];
        }
    }
    put_results(f, w->p, &m, FIELD_NODES);
}

static void put_elements(FILE *f, const write_results *w)
{
    put_results(f, w->p, w->p->m, w->p->dynamic ? FIELD_ELEMENTS | FIELD_MOVING : FIELD_ELEMENTS);
}

/* The closed ones: where the corner is, what presses and shears, how far it is outside. */
static void put_contacts(FILE *f, const write_results *w)
{
    const model *p = w->p;
    const bbm_model *m = p->m;

    fprintf(f, "corner_block,edge_block,x,y,state,normal,shear,gap\n");
    for (const bbm_contact *c = m->contact; c < m->contact + m->contacts; c++) {
        const bbm_edge *corner = &m->edge[c->corner];
        const bbm_vertex *P1 = &m->vertex[corner->a];
        const bbm_node *start = &m->node[P1->node];
        if (c->state != BBM_OPEN)
            fprintf(f, "%s,%s,%.15g,%.15g,%s,%.15g,%.15g,%.15g\n", p->block[corner->block],
                    p->block[m->edge[c->edge].block], start->x + P1->u, start->y + P1->v,
                    c->state == BBM_LOCK ? "LOCK" : "SLIDE", field_acts(c, 0), field_acts(c, 1),
                    c->d_n);
    }
}

/* The force of the support on each fixed node. */
static void put_reactions(FILE *f, const write_results *w)
{
    const model *p = w->p;

    fprintf(f, "node,x,y,fx,fy\n");
    for (int n = 0; n < p->m->nodes; n++) {
        const bbm_node *a = &p->m->node[n];
        const double *F = p->m->beyond->support[n].force;
        if (a->held && !field_is_gone(p->m, p->m->adjacent[p->m->adjacent_first[n]]))
            fprintf(f, "%s,%.15g,%.15g,%.15g,%.15g\n", p->node[n], a->x, a->y, F[0], F[1]);
    }
}

static void put_bolts(FILE *f, const write_results *w)
{
    const model *p = w->p;

    fprintf(f, "bolt,block_1,block_2,force,state\n");
    for (const scene_bolt *b = p->bolt; b < p->bolt + p->bolts; b++)
        fprintf(f, "%d,%s,%s,%.15g,%s\n", (int)(b - p->bolt) + 1, p->block[b->end[0].block],
                p->block[b->end[1].block], b->pull,
                b->strength == 0 ? "REMOVED" : b->until < INFINITY ? "BROKEN" : "HOLDS");
}

/* The bonds that have broken, in the order of steps, where they were then. */
static void put_cracks(FILE *f, const write_results *w)
{
    const bbm_beyond *b = w->p->m->beyond;

    fprintf(f, "step,bond,x,y,mode\n");
    for (const bbm_break *k = b->broke; k < b->broke + b->broken; k++)
        fprintf(f, "%d,%d,%.15g,%.15g,%s\n", k->step, k->bond + 1, k->x, k->y,
                k->shears ? "SHEAR" : "TENSION");
}

/* What is left of the forces on each body in the last solution, what a contact or bolt of it has
 * against its law, and their shares of all of them. */
static void put_balance(FILE *f, const write_results *w)
{
    const model *p = w->p;

    fprintf(f, "block,element,force,force_share,moment,moment_share,breach,breach_share\n");
    for (int e = 0; e < p->m->elements; e++) {
        const bbm_balance *b = &p->m->beyond->balance[e];
        const double force = hypot(b->force[0], b->force[1]), all = b->forces > 0 ? b->forces : 1;
        if (b->area == 0 || field_is_gone(p->m, p->m->element[e].first))
            continue;
        fprintf(f, "%s,%s", p->block[p->m->element[e].block], p->element[e]);
        put_numbers(f, 6, (double[]){ force, force / all, b->moment, b->moment / (all * b->size),
                                      b->breach, b->breach / (all + b->breach) });
        fputc('\n', f);
    }
}

/* Static steps take no time: t stays 0. */
static double time_of(const write_results *w)
{
    return w->p->dynamic ? w->step * w->p->m->par.dt : 0;
}

static double *column(const write_results *w, int k) { return w->kept + (size_t)k * ROWS; }

/* Into the present row of history.svg, which is of 2^halved steps. */
static void keep(const write_results *w, int first, int n, const double x[])
{
    for (int k = 0; k < n && w->kept; k++)
        column(w, first + k)[w->row] = x[k];
}

static void put_history(const write_results *w)
{
    const model *p = w->p;

    fprintf(w->history.file, "%d,%.15g", w->step, time_of(w));
    for (int k = 0; k < p->monitors; k++) {
        double x[MODEL_FOLLOWED];
        model_follow(p, &p->monitor[k], x);
        put_numbers(w->history.file, p->monitor[k].of->values, x);
        keep(w, MONITORS + MODEL_FOLLOWED * k, MODEL_FOLLOWED, x);
    }
    fputc('\n', w->history.file);
}

static void put_summary(const write_results *w)
{
    const bbm_info *i = &w->p->m->info;
    const bbm_beyond *b = w->p->m->beyond;
    bbm_energy e;

    bbm_energies(w->p->m, &e);
    const double row[] = { w->p->dynamic ? time_of(w) : w->step, e.kinetic, e.elastic, e.springs,
                           b->work, b->gained };
    keep(w, T, LENGTH(row), row);
    if (w->step == 0)
        return;
    fprintf(w->summary.file, "%d,%.15g,%d,%d,%.15g,%d", w->step, time_of(w), i->passes,
            i->iterations, i->pcg.residual, i->contacts);
    put_numbers(w->summary.file, MONITORS - KINETIC, row + KINETIC);
    fputc('\n', w->summary.file);
}

static double seconds(clock_t t) { return (double)t / CLOCKS_PER_SEC; }

static void put_timing(FILE *f, const write_results *w)
{
    const double *s = w->p->m->info.seconds;

    fprintf(f, "phase,seconds\nread,%.15g\ndetect,%.15g\nassemble,%.15g\nprecondition,%.15g\n",
            seconds(w->reading), s[BBM_DETECT], s[BBM_ASSEMBLE], s[BBM_PRECONDITION]);
    fprintf(f, "iterate,%.15g\nwrite,%.15g\ntotal,%.15g\n", s[BBM_ITERATE], seconds(w->writing),
            seconds(clock() - w->start));
}

/* ------------------------------------------------------------------------------------------ VTK */

/* Legacy VTK, ASCII. */
static void put_head(FILE *f, const write_results *w, const char *kind, int points)
{
    fprintf(f, "# vtk DataFile Version 3.0\n%.200s\nASCII\nDATASET %s\n",
            w->p->title ? w->p->title : "bbm", kind);
    fprintf(f, "FIELD FieldData 1\nTIME 1 1 double\n%.15g\nPOINTS %d double\n", time_of(w), points);
}

/* Points where they started, with the displacement as a vector to warp by; cells with stress. */
static void put_vtk(FILE *f, const write_results *w)
{
    const bbm_model *m = w->p->m;

    put_head(f, w, "UNSTRUCTURED_GRID", m->nodes);
    for (int n = 0; n < m->nodes; n++)
        fprintf(f, "%.15g %.15g 0\n", m->node[n].x, m->node[n].y);
    fprintf(f, "CELLS %d %d\n", m->elements, m->elements + m->vertices);
    for (int e = 0; e < m->elements; e++) {
        fprintf(f, "%d", m->element[e].n);
        for (int v = m->element[e].first; v < m->element[e].first + m->element[e].n; v++)
            fprintf(f, " %d", m->vertex[v].node);
        fputc('\n', f);
    }
    fprintf(f, "CELL_TYPES %d\n", m->elements);
    for (int e = 0; e < m->elements; e++)
        fprintf(f, "%d\n", field_is_gone(m, m->element[e].first) ? 0 : m->element[e].n == 3 ? 5
                            : m->element[e].n == 4 ? 9 : 7);
    fprintf(f, "CELL_DATA %d\nSCALARS block int 1\nLOOKUP_TABLE default\n", m->elements);
    for (int e = 0; e < m->elements; e++)
        fprintf(f, "%d\n", m->element[e].block);
    for (const field *q = field_table; q->name; q++) {
        if (!(q->files & FIELD_CELLS))
            continue;
        fprintf(f, "SCALARS %s double 1\nLOOKUP_TABLE default\n", q->name);
        for (int e = 0; e < m->elements; e++)
            fprintf(f, "%.15g\n", field_of_element(q, m, e));
    }
    fprintf(f, "POINT_DATA %d\nVECTORS u double\n", m->nodes);
    for (int n = 0; n < m->nodes; n++) {
        bbm_result r;
        bbm_nodal_result(m, n, -1, &r);
        const int there = !field_is_gone(m, m->adjacent[m->adjacent_first[n]]);
        fprintf(f, "%.15g %.15g 0\n", there * r.u, there * r.v);
    }
}

/* The closed contacts as points, with the forces on the corner's block. Where a stage has begun,
 * they are not as many as in the last step. */
static void put_vtk_contacts(FILE *f, const write_results *w)
{
    const bbm_model *m = w->p->m;
    const bbm_contact *end = m->contact + m->contacts;
    double force[2];
    int n = 0;

    for (const bbm_contact *c = m->contact; c < end; c++)
        n += c->state != BBM_OPEN;
    put_head(f, w, "POLYDATA", n);
    for (const bbm_contact *c = m->contact; c < end; c++)
        if (c->state != BBM_OPEN)
            fprintf(f, "%.15g %.15g 0\n", field_place(m, m->edge[c->corner].a, 0),
                    field_place(m, m->edge[c->corner].a, 1));
    fprintf(f, "VERTICES %d %d\n", n, 2 * n);
    for (int k = 0; k < n; k++)
        fprintf(f, "1 %d\n", k);
    fprintf(f, "POINT_DATA %d\nSCALARS state int 1\nLOOKUP_TABLE default\n", n);
    for (const bbm_contact *c = m->contact; c < end; c++)
        if (c->state != BBM_OPEN)
            fprintf(f, "%d\n", (int)c->state);
    for (int shear = 0; shear < 2; shear++) {
        fprintf(f, "VECTORS %s double\n", shear ? "shear" : "normal");
        for (const bbm_contact *c = m->contact; c < end; c++) {
            const double of[2] = { field_acts(c, 0), field_acts(c, 1) };
            field_contact_force(m, c, shear ? 0 : of[0], shear ? of[1] : 0, force);
            if (c->state != BBM_OPEN)
                fprintf(f, "%.15g %.15g 0\n", force[0], force[1]);
        }
    }
}

static void write_vtk(write_results *w)
{
    if (write_file(w, path_of(w, "step_%06d.vtk"), put_vtk))
        write_file(w, path_of(w, "contacts_%06d.vtk"), put_vtk_contacts);
}

void write_stage(write_results *w)
{
    if (write_file(w, path_of(w, "nodes_%06d.csv"), put_nodes))
        write_file(w, path_of(w, "reactions_%06d.csv"), put_reactions);
}

/* ------------------------------------------------------------------------------------- pictures */

/* The picture at the last path; one that cannot be made costs no results. */
static void note_picture(write_results *w, int done)
{
    if (!done)
        fail(w, w->path, strerror(errno));
}

/* The present state. */
static void draw_now(write_results *w, const char *name)
{
    scene now = { .title = w->p->title, .bolts = w->p->bolts, .bolt = w->p->bolt };

    scene_record(&now, w->p->m);
    note_picture(w, scene_write_movie(&now, w->p->m, path_of(w, name)));
    scene_free(&now);
}

/* A panel of history.svg: the columns from `first` on, by their names, and behind them the c.count
 * other curves that are in s. */
static void draw_panel(const write_results *w, plot *p, plot_chart c, plot_series s[], int first,
                       const char *const name[])
{
    const int place = first < MONITORS ? w->p->monitors : (first - MONITORS) / MODEL_FOLLOWED;

    for (int k = 0; name[k]; k++, c.count++)
        s[k] = (plot_series){ name[k], w->row + 1, column(w, T), column(w, first + k), PLOT_LINE,
                              k + 2 };
    c.x = w->p->dynamic ? (plot_quantity){ "t", "s" } : (plot_quantity){ "step", NULL };
    c.series = s;
    plot_draw_chart(p, (plot_box){ 0, 40 + PANEL * place, p->width, PANEL }, &c);
}

/* What it follows, and the bands in which that is expected to end. */
static void draw_monitor(const write_results *w, plot *p, int monitor)
{
    const model_followed *of = w->p->monitor[monitor].of;
    const double from = column(w, T)[0], to = column(w, T)[w->row], x[] = { from, to, to, from };
    plot_chart c = { .title = w->p->monitor[monitor].name, .y = { of->what, of->unit } };
    plot_series s[MODEL_FOLLOWED + BANDS];
    double y[BANDS][4];
    char name[BANDS][100];

    for (int k = 0; k < w->p->expectations && c.count < BANDS; k++) {
        const model_expected *e = &w->p->expected[k];
        if (e->monitor != monitor)
            continue;
        for (int i = 0; i < 4; i++)
            y[c.count][i] = e->value + (i < 2 ? -e->within : e->within);
        snprintf(name[c.count], sizeof *name, "%s, %.4g to %.4g %s", of->expected[e->kind],
                 y[c.count][0], y[c.count][2], of->unit);
        s[of->values + c.count] = (plot_series){ name[c.count], 4, x, y[c.count], PLOT_BAND,
                                                 2 + e->kind };
        c.count++;
    }
    draw_panel(w, p, c, s, MONITORS + MODEL_FOLLOWED * monitor, of->name);
}

/* What a run has been through: monitors, energies. */
static void draw_history(write_results *w)
{
    const model *m = w->p;
    const char *path = path_of(w, "history.svg");
    plot_series s[5];
    plot p;

    errno = ENOMEM;
    int done = w->kept && plot_open(&p, path, fmax(860, 1.3 * plot_text_width(m->title) + 20),
                                    40 + PANEL * (m->monitors + 1));
    if (done) {
        plot_title(&p, p.width / 2, 28, m->title);
        for (int k = 0; k < m->monitors; k++)
            draw_monitor(w, &p, k);
        draw_panel(w, &p, (plot_chart){ .title = "Energies", .y = { "energy", "J" } }, s, KINETIC,
                   (const char *[]){ "kinetic", "elastic", "springs", "external", "gained", NULL });
        done = plot_close(&p);
    }
    note_picture(w, done);
}

static void draw_pictures(write_results *w)
{
    const bbm_model *m = w->p->m;
    scene map = w->film;
    char name[100];

    draw_now(w, "contacts.svg");
    if (w->p->dynamic && (w->film.frames > 0 || w->film.failed)) /* neither: the start has failed */
        note_picture(w, scene_write_movie(&w->film, m, path_of(w, "movie.svg")));
    map.field = w->p->field;
    map.scale = map.scale > 0 ? map.scale : w->p->dynamic;      /* a static one is magnified */
    snprintf(name, sizeof name, "%.90s.svg", map.field);
    note_picture(w, scene_write_map(&map, m, path_of(w, name)));
    if (w->row > 0 && (w->p->dynamic || m->par.steps > 1))
        draw_history(w);
}

/* -------------------------------------------------------------------------------- Matrix Market */

/* A block of K at the caller's rows i and j: its entries on the diagonal of K and below it. */
static void put_block(FILE *f, int i, int j, double B[6][6])
{
    for (int a = 0; a < 6; a++)
        for (int b = 0; b < (i == j ? a + 1 : 6); b++)
            fprintf(f, "%d %d %.17g\n", 6 * (i > j ? i : j) + (i < j ? b : a) + 1,
                    6 * (i > j ? j : i) + (i < j ? a : b) + 1, B[a][b]);
}

static void put_matrix(FILE *f, const write_results *w)
{
    const bbm_matrix *K = w->p->m->K;

    fprintf(f, "%%%%MatrixMarket matrix coordinate real symmetric\n%d %d %lld\n", 6 * K->n,
            6 * K->n, 36LL * K->first[K->n] + 21LL * K->n);
    for (int i = 0; i < K->n; i++) {
        put_block(f, K->caller[i], K->caller[i], K->D[i]);
        for (int k = K->first[i]; k < K->first[i + 1]; k++)
            put_block(f, K->caller[i], K->caller[i - K->back[k]], K->L[k]);
    }
}

/* The form of the inertia: 1/2 V.M V is the kinetic energy of the velocities V of the unknowns. */
static void put_mass(FILE *f, const write_results *w)
{
    const bbm_model *m = w->p->m;

    fprintf(f, "%%%%MatrixMarket matrix coordinate real symmetric\n%d %d %d\n", 6 * m->elements,
            6 * m->elements, 21 * m->elements);
    for (int e = 0; e < m->elements; e++) {
        double M[6][6];
        bbm_mode_integral(&m->element[e], M);
        for (int k = 0; k < 36; k++)
            M[k / 6][k % 6] *= bbm_mass_per_area(&m->element[e]);
        put_block(f, e, e, M);
    }
}

static void put_right_side(FILE *f, const write_results *w)
{
    const bbm_model *m = w->p->m;

    fprintf(f, "%%%%MatrixMarket matrix array real general\n%d 1\n", 6 * m->elements);
    for (int k = 0; k < 6 * m->elements; k++)
        fprintf(f, "%.17g\n", m->F[k]);
}

void write_matrix(write_results *w)
{
    const clock_t start = clock();
    char name[2][LONGEST];

    for (int k = 0; k < 2; k++)
        snprintf(name[k], LONGEST, "%s.%s", w->matrix, k ? "mass" : "rhs");
    if (write_file(w, w->matrix, put_matrix) && write_file(w, name[0], put_right_side))
        write_file(w, name[1], put_mass);
    w->matrix = NULL;
    w->writing += clock() - start;
}

/* -------------------------------------------------------------------------------------- the run */

/* Whether a run writes a file of that name, or begins it. */
static int is_ours(const char *name)
{
    static const char *const form[] = {
        "nodes.csv", "elements.csv", "history.csv", "summary.csv", "timing.csv", "contacts.csv",
        "reactions.csv", "bolts.csv", "cracks.csv", "balance.csv", "contacts.svg", "movie.svg",
        "model.svg", "history.svg", "step_%*[0-9].vtk", "contacts_%*[0-9].vtk",
        "nodes_%*[0-9].csv", "reactions_%*[0-9].csv",
    };
    int ours = 0;

    for (int k = 0; k < LENGTH(form); k++)
        ours |= output_has_form(name, form[k], "");
    for (const field *q = field_table; q->name; q++)
        ours |= output_has_form(name, q->name, ".svg");
    return ours;
}

/* Whether the run has read no such file, by this name or another one. (On Windows files have no
 * number; size and time tell.) */
static int spare_input(write_results *w, const char *path)
{
    struct stat a, b;

    for (int k = 0; k < w->p->inputs && !w->status && stat(path, &a) == 0; k++)
        if (stat(w->p->input[k], &b) == 0 && a.st_ino == b.st_ino && a.st_dev == b.st_dev
            && a.st_size == b.st_size && a.st_mtime == b.st_mtime)
            fail(w, path, "this run reads it; another name or folder may be given");
    return !w->status;
}

/* Removes what an earlier run left in the folder, so that all that stands there is of one run; or
 * looks whether it may. */
static int empty_folder(write_results *w, int look)
{
    struct stat what;
    DIR *folder = opendir(w->folder);

    if (!folder)
        return fail(w, w->folder, strerror(errno));
    for (struct dirent *entry; !w->status && (entry = readdir(folder)) != NULL; )
        if (is_ours(entry->d_name) && stat(path_of(w, entry->d_name), &what) == 0
            && S_ISREG(what.st_mode) && spare_input(w, w->path) && !look && remove(w->path))
            fail(w, w->path, strerror(errno));
    closedir(folder);
    return !w->status;
}

/* Whether the folder is still that of the run: somebody may have removed it, and another run may
 * have made it anew. If not, the run has none from now on. */
static int holds_folder(write_results *w)
{
    if (w->lock && !output_holds(w->lock, path_of(w, LOCK))) {
        fail(w, w->folder, "it was removed while the run was at work");
        fclose(w->lock);
        w->lock = NULL;
    }
    return w->lock != NULL;
}

/* The end of a run; whether all went well. */
static int leave_folder(write_results *w)
{
    if (holds_folder(w))
        output_unlock(w->lock, path_of(w, LOCK));
    return !w->status;
}

/* Makes the folder, if need be, and locks it. */
static int open_folder(write_results *w)
{
    if (strlen(w->folder) + strlen("/contacts_2147483647.vtk") >= sizeof w->path)
        return fail(w, w->folder, strerror(ENAMETOOLONG));
    if (!output_make_folder(w->folder))
        return fail(w, w->folder,
                    errno == EEXIST ? "it is there and no folder; another one may be given with -o"
                                    : strerror(errno));
    if (!spare_input(w, path_of(w, LOCK)) || !empty_folder(w, 1))
        return 0;
    w->lock = output_lock(path_of(w, LOCK));
    return w->lock ? 1 : fail(w, w->folder, errno == EBUSY
                                  ? "another run is at work there; another folder may be given "
                                    "with -o" : strerror(errno));
}

int write_check(write_results *w)
{
    if (open_folder(w))
        draw_now(w, "model.svg");
    return leave_folder(w);
}

int write_open(write_results *w)
{
    static const char *const ending[] = { "", ".rhs", ".mass" };
    char name[LONGEST];

    for (int k = 0; k < LENGTH(ending) && w->matrix; k++) {
        snprintf(name, sizeof name, "%s%s", w->matrix, ending[k]);
        if (!spare_input(w, name))
            return 0;
    }
    if (!open_folder(w) || !empty_folder(w, 0)
        || !open_file(w, &w->history, path_of(w, "history.csv"))
        || !open_file(w, &w->summary, path_of(w, "summary.csv"))) {
        output_note(&w->history, 0);
        output_close(&w->history);
        return leave_folder(w);
    }
    fprintf(w->history.file, "step,t");
    for (int m = 0; m < w->p->monitors; m++)
        for (int k = 0; k < w->p->monitor[m].of->values; k++)
            fprintf(w->history.file, ",%s_%s", w->p->monitor[m].name, w->p->monitor[m].of->name[k]);
    fprintf(w->history.file, "\n");
    fprintf(w->summary.file, "step,t,open_close,pcg_iterations,residual,contacts,kinetic,elastic,"
                             "springs,external,gained\n");
    output_keep(&w->history);
    output_keep(&w->summary);
    w->film = (scene){ .title = w->p->title, .bolts = w->p->bolts, .bolt = w->p->bolt,
                       .scale = w->p->scale, .field = w->p->film ? w->p->field : NULL,
                       .limits = { w->p->colours[0], w->p->colours[1] } };
    w->kept = calloc(ROWS * (MONITORS + MODEL_FOLLOWED * (size_t)w->p->monitors), sizeof *w->kept);
    return 1;
}

void write_step(write_results *w, int step)
{
    const clock_t start = clock();
    const model *p = w->p;

    w->step = step;
    if (!holds_folder(w))
        return;
    if (step > (ROWS - 1) << w->halved) {               /* every second row goes */
        for (int k = 0; k < MONITORS + MODEL_FOLLOWED * p->monitors && w->kept; k++)
            for (int r = 1; r <= ROWS / 2; r++)
                column(w, k)[r] = column(w, k)[2 * r];
        w->halved++;
    }
    w->row = step ? 1 + (step - 1) / (1 << w->halved) : 0;
    put_history(w);
    put_summary(w);
    if (p->svg && p->dynamic && (p->every == 0 || step % p->every == 0))
        scene_record(&w->film, p->m);
    if (p->vtk && p->every && step % p->every == 0)
        write_vtk(w);
    w->status |= !output_keep(&w->history) || !output_keep(&w->summary);
    w->writing += clock() - start;
}

void write_close(write_results *w)
{
    const clock_t start = clock();
    const model *p = w->p;
    const struct { const char *name; void (*put)(FILE *f, const write_results *w); } table[] = {
        { "nodes.csv", put_nodes },
        { "elements.csv", put_elements },
        { "contacts.csv", put_contacts },
        { "reactions.csv", put_reactions },
        { "balance.csv", p->balance ? put_balance : NULL },
        { "bolts.csv", p->bolts ? put_bolts : NULL },
        { "cracks.csv", p->m->beyond->bond_tension > 0 ? put_cracks : NULL },
    };

    holds_folder(w);
    close_file(w, &w->history);
    close_file(w, &w->summary);
    for (int k = 0; k < LENGTH(table); k++)
        if (table[k].put)
            write_file(w, path_of(w, table[k].name), table[k].put);
    if (p->vtk && (p->every == 0 || w->step % p->every != 0))
        write_vtk(w);
    if (p->svg && w->lock)
        draw_pictures(w);
    scene_free(&w->film);
    free(w->kept);
    w->writing += clock() - start;
    write_file(w, path_of(w, "timing.csv"), put_timing);
    leave_folder(w);
}
