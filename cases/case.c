/* case.c - what the experiments share. A program of cases/ runs from the project's top folder: it
 * reads cases/fem.csv and writes below out/. */
#define _POSIX_C_SOURCE 200809L
#include <errno.h>

#include "../program/field.h"
#include "case.h"

static void stop(const char *what, const char *why)
{
    fprintf(stderr, "%s: %s\n", what, why);
    exit(1);
}

void case_must(const bbm_model *m, bbm_status s)
{
    if (s)
        stop("bbm", m ? bbm_message(m) : bbm_status_text(s));
}

bbm_model *case_paper_model(void)
{
    bbm_model *m;

    case_must(NULL, bbm_model_new(&m));
    return m;
}

void case_solve(bbm_model *m)
{
    case_must(m, bbm_prepare(m));
    case_must(m, bbm_run(m));
}

void case_print_parameters(const bbm_model *m)
{
    const bbm_parameters *p = &m->par;
    const int touch = m->info.contacts > 0;

    printf("\nTable 1 - parameters\n\n"
           "| dt [s] | steps at most | tolerance (71) | omega | tolerance PCG | alpha |%s\n"
           "|---|---|---|---|---|---|%s\n| ",
           touch ? " p_n [N/m] | p_s [N/m] |" : "", touch ? "---|---|" : "");
    printf(isinf(p->dt) ? "static" : "%g", p->dt);
    printf(" | %d | %g | %g | %g | %g |", p->steps, p->tolerance, p->pcg.omega, p->pcg.tolerance,
           p->alpha);
    if (touch)
        printf(" %g | %g |", p->p_n, p->p_s);
    printf("\n");
}

/* --------------------------------------------------------------------------------------- meshes */

static void add_mapped_node(bbm_model *m, const case_grid *g, double i, double j)
{
    double xy[2] = { g->x + g->w * i / g->nx, g->y + g->h * j / g->ny };

    if (g->map)
        g->map(i, j, g->context, xy);
    bbm_add_node(m, xy[0], xy[1], NULL);
}

int case_add_grid(bbm_model *m, case_grid *g)
{
    const int first = m->elements, row = g->nx + 1;
    int element[4][4], corners;

    g->first = m->nodes;
    for (int n = 0; n < row * (g->ny + 1); n++)
        add_mapped_node(m, g, n % row, n / row);
    for (int c = 0; c < g->nx * g->ny; c++) {
        const int i = c % g->nx, j = c / g->nx, low = g->first + j * row + i, high = low + row;
        if (g->cut == CELL_CROSSED)
            add_mapped_node(m, g, i + 0.5, j + 0.5);
        const int node[5] = { low, low + 1, high + 1, high, m->nodes - 1 };
        const int cells = cell_cut(g->cut, (i + j) % 2, node, element, &corners);
        for (int k = 0; k < cells; k++)
            bbm_add_element(m, g->block, g->material, corners, element[k], NULL);
    }
    case_must(m, m->status);
    return first;
}

double case_at(const bbm_model *m, const char *quantity, double x, double y)
{
    double least = INFINITY;
    int nearest = 0;

    for (int n = 0; n < m->nodes; n++) {
        const double distance = hypot(m->node[n].x - x, m->node[n].y - y);
        if (distance < least)
            least = distance, nearest = n;
    }
    return field_of_node(field_find(quantity), m, nearest, -1);
}

double case_percent(double computed, double reference)
{
    return 100 * (computed - reference) / reference;
}

/* ----------------------------------------------------------------------------- reference values */

/* A line is: problem, variant, quantity, x, y, converged, six_node_triangles, one more; nan where
 * there is none. */
void case_read(const char *problem, const char *variant, case_reference *r)
{
    char line[256], of[2][32];
    FILE *f = fopen("cases/fem.csv", "r");
    struct case_value v;

    r->values = 0;
    if (!f)
        stop("cases/fem.csv", "cannot be read; run the program from the project's top folder");
    while (fgets(line, sizeof line, f)) {
        if (sscanf(line, "%31[^,],%31[^,],%31[^,],%lf,%lf,%lf,%lf", of[0], of[1], v.quantity, &v.x,
                   &v.y, &v.converged, &v.six_node) < 7
            || strcmp(of[0], problem) != 0 || strcmp(of[1], variant) != 0 || isnan(v.x))
            continue;
        if (r->values == LENGTH(r->value))
            stop("cases/fem.csv", "has more values than there is room for");
        r->value[r->values++] = v;
    }
    fclose(f);
}

const struct case_value *case_find(const case_reference *r, const char *name, double x, double y)
{
    for (const struct case_value *v = r->value; v < r->value + r->values; v++)
        if (strcmp(v->quantity, name) == 0 && hypot(v->x - x, v->y - y) < 1e-6)
            return v;
    stop(name, "no such reference value in cases/fem.csv");
    return NULL;
}

/* ----------------------------------------------------------------------------- results as files */

const char *case_path(case_results *r, const char *file)
{
    snprintf(r->path, sizeof r->path, "%s/%s", r->folder, file);
    return r->path;
}

void case_open(case_results *r, const char *name)
{
    snprintf(r->folder, sizeof r->folder, "out/%s", name);
    r->failed = 0;
    if (!output_make_folder(r->folder))
        stop(r->folder, strerror(errno));
    r->csv = fopen(case_path(r, "results.csv"), "w");
    if (!r->csv)
        stop(r->path, strerror(errno));
    fprintf(r->csv, "quantity,x,y,computed,reference,kind,relative_error\n");
}

int case_close(case_results *r)
{
    if (r && (ferror(r->csv) | fclose(r->csv)))
        stop(r->folder, "results.csv could not be written");
    if (fflush(stdout) || ferror(stdout))
        stop("stdout", "could not be written");
    return r ? r->failed : 0;
}

void case_row(case_results *r, const char *quantity, const double xy[2], double computed,
              double reference, const char *kind)
{
    const double error = reference != 0 ? (computed - reference) / reference : computed;

    fprintf(r->csv, isnan(xy[0]) ? "%s,,," : "%s,%.9g,%.9g,", quantity, xy[0], xy[1]);
    fprintf(r->csv, "%.15g,%.15g,%s,%.3e\n", computed, reference, kind, error);
}

/* Each reference value against the computed one is a row of results.csv. */
static void compare_all(case_results *r, const case_experiment *p, const bbm_model *m,
                        const case_run *run, const case_reference *ref)
{
    for (const struct case_value *f = ref->value; f < ref->value + ref->values; f++) {
        const double xy[2] = { f->x, f->y };
        char name[40];
        const double value = p->computed(m, f->quantity, f->x, f->y);
        const double exact = p->theory(f->quantity, f->x, f->y);
        snprintf(name, sizeof name, "%s%s.%s", run->beyond ? "beyond." : "", run->variant,
                 f->quantity);
        if (!isnan(exact))
            case_row(r, name, xy, value, exact, "theory");
        if (!isnan(f->converged))
            case_row(r, name, xy, value, f->converged, "fem");
        case_row(r, name, xy, value, f->six_node, "fem_coarse");
    }
}

void case_draw(case_results *r, int done)
{
    r->failed |= !done;
    if (!done)
        fprintf(stderr, "%s could not be written: %s\n", r->path, strerror(errno));
}

/* ---------------------------------------------------------------------------- Experiments I, II */

static void print_summary(const case_experiment *e, bbm_model *const m[],
                          const case_reference ref[])
{
    printf("\n| %s, alpha = 1000 | computed | exact | error |\n|---|---|---|---|\n", e->summary);
    for (const case_point *p = e->point; p < e->point + e->points && m[p->run]; p++) {
        const double value = e->computed(m[p->run], p->quantity, p->x, p->y);
        const double exact = case_find(&ref[p->run], p->quantity, p->x, p->y)->converged;
        printf("| %s(%.0f,%.0f)%s | %.4f | %.4f | %+.2f %% |\n", p->quantity, p->x, p->y,
               e->run[p->run].summary, p->unit * value, p->unit * exact,
               case_percent(value, exact));
    }
}

/* The values of a run, beside six-node triangles, the finite element that converged, and theory. */
static void print_table(const case_experiment *e, const case_table *t, const char *variant,
                        const bbm_model *m, const case_reference *ref)
{
    printf("\n%s, %s - %s; FEM: six-node triangles\n\n"
           "| | BBM | FEM | FEM, converged | theory | against FEM | against converged |\n"
           "|---|---|---|---|---|---|---|\n", t->name, variant, t->what);
    for (const case_place *p = t->place; p < t->place + t->places; p++) {
        const struct case_value *f = case_find(ref, p->quantity, p->x, p->y);
        const double value = e->computed(m, p->quantity, p->x, p->y);
        printf("| %s(%.4g,%.4g) | %.5f | %.5f | %.5f | %.5f | %+.2f %% | %+.2f %% |\n",
               p->quantity, p->x, p->y, t->unit * value, t->unit * f->six_node,
               t->unit * f->converged, t->unit * e->theory(p->quantity, p->x, p->y),
               case_percent(value, f->six_node), case_percent(value, f->converged));
    }
}

/* For alpha = 1e5 SSOR-PCG takes seconds on the finest mesh. Two levels solve the same equations
 * and print the same digits, so where there is beyond/ they do it. */
static void print_convergence(const case_experiment *e)
{
    static const double alpha[4] = { 10, 100, 1000, 1e5 };
    case_reference ref;

    case_read(e->name, e->run[1].variant, &ref);
    printf("\n%s\n\n"
           "| triangles | alpha = 10 | alpha = 100 | alpha = 1000 | alpha = 100000 |\n"
           "|---|---|---|---|---|", e->errors);
    for (int k = 0; k < 3 * 4; k++) {                /* three meshes, each with four alphas */
        bbm_model *m = case_beyond_model(0, 1);
        if (!m)
            m = case_paper_model();
        e->solve(m, e->run[1].variant, CELL_CROSSED, k / 4 + 1, alpha[k % 4]);
        if (k % 4 == 0)
            printf("\n| %d |", m->elements);
        for (const case_place *p = e->error; p < e->error + 2 && p->quantity; p++)
            printf("%s %+.3f %%", p == e->error ? "" : ",",
                   case_percent(e->computed(m, p->quantity, p->x, p->y),
                                case_find(&ref, p->quantity, p->x, p->y)->converged));
        printf(" |");
        bbm_model_free(m);
    }
    printf("\n");
}

int case_main(const case_experiment *e, int argc, char **argv)
{
    case_results r;
    case_reference ref[4];
    bbm_model *m[4];

    if (argc > 1 && strcmp(argv[1], "converge") == 0) {
        print_convergence(e);
        return case_close(NULL);
    }
    printf("\n# %s, the paper's way\n\n", e->title);
    case_open(&r, e->name);
    for (int k = 0; k < e->runs; k++) {
        const case_run *run = &e->run[k];
        m[k] = run->beyond ? case_beyond_model(2, 1) : case_paper_model();
        case_read(e->name, run->variant, &ref[k]);
        if (m[k]) {
            e->solve(m[k], run->variant, run->beyond ? CELL_QUADS : CELL_CROSSED,
                     run->beyond ? 4 : 2, 1000);
            compare_all(&r, e, m[k], run, &ref[k]);
        }
    }
    case_print_parameters(m[0]);
    print_summary(e, m, ref);
    for (int k = 0; k < e->runs; k++)
        for (int i = 0; i < e->tables && !e->run[k].beyond; i++)
            print_table(e, &e->table[i], e->run[k].variant, m[k], &ref[k]);
    e->show(&r, (const bbm_model *const *)m, ref);
    for (int k = 0; k < e->maps; k++)
        case_draw(&r, scene_write_map(&e->map[k].map, m[0], case_path(&r, e->map[k].file)));
    printf("\nNumbers and pictures: %s\n", r.folder);
    for (int k = 0; k < e->runs; k++)
        bbm_model_free(m[k]);
    return case_close(&r);
}
