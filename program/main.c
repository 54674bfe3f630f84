/* main.c - ./bbm MODEL runs a model file: reads it (statements.c), steps, writes the results
 * (write.c).
 *
 * Exit status: 0, all is done, and as expected; 1, the run failed, with what was computed until
 * then in the files; 2, the input is wrong, and nothing was written; 3, an `expect` of the model
 * is not met; 130, 143: interrupted (Ctrl-C, kill), with what was computed until then in the
 * files. Errors, warnings and progress go to stderr, what was run and what came out to stdout. */
#define _POSIX_C_SOURCE 200809L
#define _DEFAULT_SOURCE                 /* else glibc takes a handler away when it is called */
#include <signal.h>
#include <unistd.h>

#include "run.h"
#include "write.h"

/* The signal that came. Signals have no other way to say something: this variable, and it alone,
 * has file scope. */
static volatile sig_atomic_t stopped;
enum { SILENCE = 10 };              /* s between lines of progress to a file */

typedef struct {                /* what the command line asks for */
    const char *model, *find;   /* find: a `let` whose limit between two ends is wanted, or NULL */
    char *matrix, folder[1024];
    int  lets, quiet, check, exit;      /* exit: its status, or -1: go on */
    char **let;                 /* [lets]       NAME=VALUE; room for one more */
    double end[2];
} arguments;

static const char usage[] =
    "usage: bbm [-q] [--check] [-d NAME=VALUE] [-o FOLDER] [-m FILE] MODEL\n"
    "       bbm [-q] [-d NAME=VALUE] --find NAME LOW HIGH MODEL\n"
    "  MODEL       a model file; -: standard input\n"
    "  -d          takes the place of `let NAME`; may be given several times\n"
    "  --check     reads the model and tells what it is, with a picture; computes nothing\n"
    "  --find      bisects `let NAME` until its expectations change; writes no results\n"
    "  -o FOLDER   for the results; without it the model's name, here. Units: doc/tables.md\n"
    "  -m FILE.mtx matrix of the first solution (Matrix Market); right side, masses: .rhs, .mass\n"
    "  -q          quiet: only what is wrong or was asked for\n  -h, --version\n";

static int complain(arguments *a, const char *what, const char *word)
{
    fprintf(stderr, "bbm: %s%.60s; `bbm -h` lists the options\n", what, word);
    return a->exit = 2;
}

/* By default: the model's name without folder and ending. */
static int name_folder(arguments *a, const char *given)
{
    const char *base = strrchr(a->model, '/'), *dot;

    base = given ? given : strcmp(a->model, "-") == 0 ? "stdin" : base ? base + 1 : a->model;
    dot = given ? NULL : strrchr(base, '.');
    const size_t n = dot && dot > base ? (size_t)(dot - base) : strlen(base);
    if (n == 0 || n >= sizeof a->folder)
        return complain(a, "no folder of that name, expected -o FOLDER", "");
    snprintf(a->folder, sizeof a->folder, "%.*s", (int)n, base);
    return 0;
}

/* NAME LOW HIGH. */
static int read_find(arguments *a, char *word[])
{
    char rest;

    if (a->find || !word[0] || !word[1] || !word[2])
        return complain(a, "expected --find NAME LOW HIGH, once", "");
    a->find = word[0];
    for (int k = 0; k < 2; k++)
        if (sscanf(word[k + 1], "%lf%c", &a->end[k], &rest) != 1 || !isfinite(a->end[k]))
            return complain(a, "--find needs two numbers, not ", word[k + 1]);
    return a->end[0] == a->end[1] ? complain(a, "--find needs two different numbers", "") : 0;
}

/* The options may stand before and after the model; behind `--` a name may begin with a dash. */
static int read_arguments(arguments *a, int argc, char *argv[])
{
    char *folder = NULL;
    int options = 1;

    *a = (arguments){ .exit = -1, .let = argv };
#ifdef _WIN32
    for (int k = 1; k < argc; k++)
        for (char *c = argv[k]; *c; c++)
            *c = *c == '\\' ? '/' : *c;        /* both part folders there */
#endif
    for (int k = 1; k < argc; k++) {
        char *word = argv[k];
        if (!options || word[0] != '-' || word[1] == '\0') {
            if (a->model)
                return complain(a, "expected one model file, not also ", word);
            a->model = word;
        } else if (strcmp(word, "--") == 0) {
            options = 0;
        } else if (strcmp(word, "-q") == 0) {
            a->quiet = 1;
        } else if (strcmp(word, "-h") == 0 || strcmp(word, "--help") == 0) {
            return printf("%s", usage), a->exit = 0;
        } else if (strcmp(word, "--version") == 0) {
            return printf("bbm %s\n", BBM_VERSION), a->exit = 0;
        } else if (strcmp(word, "--check") == 0) {
            a->check = 1;
        } else if (strcmp(word, "--find") == 0) {
            if (read_find(a, argv + k + 1))
                return a->exit;
            k += 3;
        } else if (strchr("omd", word[1])) {
            char **value = word[1] == 'o' ? &folder : word[1] == 'm' ? &a->matrix
                         : &a->let[a->lets++];          /* they gather at the front of argv */
            *value = word[2] ? word + 2 : argv[++k];
            if (k == argc || **value == '\0' || (word[1] == 'd' && !strchr(*value, '=')))
                return complain(a, "-o and -m need a name, -d NAME=VALUE in one word", "");
        } else {
            return complain(a, "unknown option ", word);
        }
    }
    const size_t n = a->matrix ? strlen(a->matrix) : 0;
    if (a->matrix && (n < 5 || strcmp(a->matrix + n - 4, ".mtx") != 0))
        return complain(a, "-m needs a name that ends in .mtx", "");
    if (a->find && (folder || a->matrix || a->check || (a->model && strcmp(a->model, "-") == 0)))
        return complain(a, "--find reads a file again and writes none: no -o, -m, --check, -", "");
    return a->model ? name_folder(a, folder) : complain(a, "expected a model file", "");
}

/* ------------------------------------------------------------------------------------- progress */

static const char *plural(int n) { return n == 1 ? "" : "s"; }

typedef struct {
    int shown, begun, warned;                   /* begun: a line without its end */
    time_t line;                                /* when the last one was written */
} progress;

static void show_progress(progress *s, const run *r)
{
    const model *p = r->p;
    const bbm_info *i = &p->m->info;
    const int all = r->settling ? p->settle : p->stage[p->stages].par.steps;
    const int done = r->settling ? all - r->settling : r->is_over ? all
                   : r->has_begun ? i->step : 0;
    const time_t t = time(NULL);

    if (!s->shown || done == 0
        || (t < s->line + (isatty(2) ? 1 : SILENCE) && !(isatty(2) && done == all)))
        return;
    s->line = t;
    s->begun = isatty(2);
    fprintf(stderr, "%s%sstep %d of %d, %d open-close pass%s, %d contact%s%s",
            s->begun ? "\r" : "", r->settling ? "settling, " : "", done, all, i->passes,
            i->passes == 1 ? "" : "es", i->contacts, plural(i->contacts),
            s->begun ? "   " : "\n");
}

static void describe(const model *p, const char *path)
{
    const bbm_model *m = p->m;

    printf("%s%s%s\n", path, p->title ? ": " : "", p->title ? p->title : "");
    printf("%d element%s in %d block%s, %d nodes, %d bond%s; ", m->elements, plural(m->elements),
           p->blocks, plural(p->blocks), m->nodes, m->bonds, plural(m->bonds));
    printf("%s%d step%s", p->dynamic ? "dynamic, " : m->par.tolerance > 0 ? "static, at most "
                        : "static, ", m->par.steps, plural(m->par.steps));
    if (p->dynamic)
        printf(" of %g s", m->par.dt);
    if (p->settle)
        printf(" after %d quasi-static one%s", p->settle, plural(p->settle));
    puts("");
    fflush(stdout);
}

/* A stage, which begins after the step `from`. */
static void describe_stage(const model *p, int k, int from)
{
    printf("stage %.60s: after step %d", p->stage[k].name, from);
    if (p->dynamic)
        printf(", t = %g s", from * p->m->par.dt);
    printf(", to step %d\n", p->stage[k].par.steps);
}

static void summarise(const model *p, const char *folder)
{
    const bbm_model *m = p->m;
    const bbm_beyond *b = m->beyond;
    double far = 0, most = 0;
    int v_far = 0, e_most = 0;
    bbm_energy e;

    for (int v = 0; v < m->vertices; v++)
        if (hypot(m->vertex[v].u, m->vertex[v].v) > far && !field_is_gone(m, v))
            far = hypot(m->vertex[v].u, m->vertex[v].v), v_far = v;
    for (int k = 0; k < m->elements; k++)
        if (bbm_mises(m->element[k].stress, m->element[k].szz) > most)
            most = bbm_mises(m->element[k].stress, m->element[k].szz), e_most = k;
    printf("%d step%s, ", m->info.step, plural(m->info.step));
    if (p->dynamic)
        printf("t = %g s, ", m->info.t);
    printf("%d contact%s closed, residual %.1e\n", m->info.contacts, plural(m->info.contacts),
           m->info.pcg.residual);
    if (b->broken > 0 || b->crack_energy > 0)
        printf("%d bond%s broke, %d bodies; softening took at most %.6g J; %d corner%s caught "
               "inside\n", b->broken, plural(b->broken), bbm_find_pieces(m, b->body),
               b->crack_energy, b->caught, plural(b->caught));
    if (p->dynamic)                                         /* below 1e-12 it is rounding */
        printf(b->gain > 1e-12
               ? "no step made more than %.1e of its energy beyond the work of loads\n"
               : "no step made energy beyond the work of loads\n", b->gain);
    bbm_energies(m, &e);
    if (b->restitution >= 0 && b->hit[0] > 1e-12 * (fabs(b->work) + e.kinetic + e.elastic))
        printf("of what hits came with in their normal velocities %.0f %% was given back, %.0f %% "
               "asked for\n", 100 * b->hit[1] / b->hit[0], 100 * b->restitution * b->restitution);
    printf("largest displacement %.6g m, node %.60s; largest von Mises stress %.6g Pa, element "
           "%s\nresults in %s\n",
           far, p->node[m->vertex[v_far].node], most, p->element[e_most], folder);
}

/* Elements, fixed nodes and mass of each block, and what is between them. */
static void describe_blocks(const model *p, int touching)
{
    const bbm_model *m = p->m;
    struct { int elements, fixed; double mass; } *of = calloc((size_t)p->blocks, sizeof *of);

    if (!of) {
        puts("no memory to describe the blocks");
        return;
    }
    for (const bbm_element *i = m->element; i < m->element + m->elements; i++) {
        of[i->block].elements++;
        of[i->block].mass += i->material.density * i->material.thickness * i->A0;
    }
    for (int n = 0; n < m->nodes; n++)
        of[p->node_block[n]].fixed += m->node[n].held != 0;
    printf("%-20s %9s %12s %14s\n", "block", "elements", "fixed nodes", "mass [kg]");
    for (int b = 0; b < p->blocks; b++)
        printf("%-20s %9d %12d %14.6g\n", p->block[b], of[b].elements, of[b].fixed, of[b].mass);
    free(of);
    printf("%d contact%s at the start; kn %g N/m, ks %g N/m, friction %g degrees, %d joint%s of "
           "other strength\n", touching, plural(touching), m->par.p_n, m->par.p_s,
           m->par.friction, m->beyond->joints, plural(m->beyond->joints));
}

/* -------------------------------------------------------------------------------------- the run */

/* All steps, with rows in the tables for the start and each one of the model. What went wrong is in
 * the library's message or in w. */
static bbm_status run_all(run *r, write_results *w, progress *s)
{
    bbm_status status = BBM_OK;

    while (!r->is_over && !stopped && !w->status && !(status = run_step(r))) {
        if (r->has_begun)
            write_step(w, r->p->m->info.step);
        if (r->stage_is_over && !r->is_over) {
            write_stage(w);
            fputs(s->begun ? "\n" : "", stderr);
            if (s->shown)
                describe_stage(r->p, r->p->now + 1, r->p->m->info.step);
        }
        warn_in_step(r, w->source, &s->warned);
        show_progress(s, r);
    }
    return status;
}

/* Looked at before each solution: the matrix if there are results and it is wanted, and whether to
 * stop. */
static int before_solution(const bbm_model *m, void *results)
{
    write_results *w = results;

    (void)m;
    if (w && w->matrix)
        write_matrix(w);
    return stopped != 0;
}

/* The first signal is noted; another one, or the same more than a second later, ends the program
 * at once. (timeout(1) sends the same to the program and to its group.) */
static void stop(int number)
{
    static volatile time_t first;

    if (stopped && (number != stopped || time(NULL) > first + 1))
        _Exit(128 + number);
    first = stopped ? first : time(NULL);
    stopped = number;
    signal(number, stop);                       /* some systems forget it */
}

#ifndef SIGHUP
#define SIGHUP SIGTERM          /* Windows has none */
#endif

/* What is ignored (nohup) stays ignored. */
static void catch_signals(void)
{
    static const int caught[] = { SIGINT, SIGTERM, SIGHUP };

    for (int k = 0; k < LENGTH(caught); k++)
        if (signal(caught[k], stop) == SIG_IGN)
            signal(caught[k], SIG_IGN);
}

/* What the model is, block by block, and a picture of it. */
static int check(write_results *w, int quiet)
{
    const model *p = w->p;
    bbm_model *m = p->m;
    int touching = 0;

    m->h = INFINITY;                            /* contacts that touch are closed in statics */
    bbm_foresee_step(m);
    const bbm_status status = bbm_detect_contacts(m, &(int){ 0 });
    if (status)
        return fprintf(stderr, "%s: %s\n", w->source, bbm_status_text(status)), 1;
    for (int k = 0; k < m->scratch->contacts; k++)
        touching += m->scratch->contact[k].state != BBM_OPEN;
    if (!write_check(w) || quiet)
        return w->status;
    for (int k = 1; k <= p->stages; k++)
        describe_stage(p, k, p->stage[k - 1].par.steps);
    describe_blocks(p, touching);
    printf("nothing was computed; a picture is in %s/model.svg\n", w->folder);
    return 0;
}

static int run_model(write_results *w, int quiet)
{
    model *p = w->p;
    progress s = { .shown = !quiet, .line = time(NULL) };
    bbm_status status = BBM_OK;
    run r = { .p = p, .settling = p->settle };
    char text[500];
    int all_met = 1;

    catch_signals();
    p->m->monitor = before_solution;
    p->m->monitor_context = w;
    if (write_open(w)) {
        status = run_all(&r, w, &s);
        fputs(s.begun ? "\n" : "", stderr);
        write_close(w);
        run_says(&r, status, text);
        if (stopped && !w->status)
            fprintf(stderr, "%s: interrupted at %sstep %d of %d, t = %g s; what was computed until "
                    "then is in %s\n", w->source, r.has_begun ? "" : "settling, ", p->m->info.step,
                    r.has_begun ? p->m->par.steps : p->settle, p->m->info.t, w->folder);
        else if (status)
            fprintf(stderr, "%s: %s\n", w->source, text);
    }
    for (int k = 0; k < p->bolts && !quiet; k++)
        if (p->bolt[k].k == 0)
            printf("bolt %d holds no more since t = %.6g s\n", k + 1, p->bolt[k].until);
    if (stopped || status || w->status)
        return stopped ? 128 + (int)stopped : 1;
    if (!quiet)
        summarise(p, w->folder);
    warn_after(p, w->source);
    for (int k = 0; k < p->expectations; k++) {
        const int met = run_is_met(p, k, text);
        all_met &= met;
        if (!met || !quiet)
            printf("expected: %s\n", text);
    }
    return all_met ? 0 : 3;
}

/* ------------------------------------------------------------------- the limit of a number: --find
 * The model runs with the number LOW and HIGH. Where the expectations are met at one end and not at
 * the other, the middle takes the place of the end that it is like, until the ends are within a
 * thousandth of where they began. A run that fails has not met them. */

enum { NOT_MET, MET, UNKNOWN };         /* the last: the input is wrong, or it was interrupted */
enum { HALVINGS = 10 };         /* 2^-10 of the interval is a thousandth */

/* Whether all is as expected; text: of what is not, or of the last. */
static int judge(model *p, char text[520])
{
    run r = { .p = p, .settling = p->settle };
    bbm_status status = BBM_OK;

    p->m->monitor = before_solution;
    while (!status && !r.is_over && !stopped)
        status = run_step(&r);
    if (stopped)
        return UNKNOWN;
    if (status) {
        run_says(&r, status, text);
        strcat(text, ": NOT MET");
        return NOT_MET;
    }
    for (int k = 0; k < p->expectations; k++)
        if (!run_is_met(p, k, text))
            return NOT_MET;
    return MET;
}

/* One run; what it says, unless it is to be quiet. */
static int try_number(const arguments *a, double x, int first)
{
    char text[520] = "", number[200];
    model p;
    int answer = UNKNOWN;

    a->let[a->lets] = number;
    snprintf(number, sizeof number, "%.100s=%.15g", a->find, x);
    const int status = model_read(a->model, a->lets + 1, a->let, &p);
    for (int k = 0; k < p.notes && first && !status; k++)
        fprintf(stderr, "%s\n", p.note[k]);
    if (status)
        fprintf(stderr, "%s = %.9g: %s\n", a->find, x, p.message);
    else if (p.expectations == 0)
        fprintf(stderr, "%s: --find needs an `expect`, as: expect NAME stays by 0.01\n", a->model);
    else
        answer = judge(&p, text);
    if (answer <= MET && !a->quiet)
        printf("%s = %-12.9g %s\n", a->find, x, text);
    fflush(stdout);
    model_free(&p);
    return answer;
}

/* Says what it finds; the exit status. */
static int find_limit(const arguments *a)
{
    double x[2] = { a->end[0], a->end[1] };
    const int low = try_number(a, x[0], 1), high = low > MET ? low : try_number(a, x[1], 0);
    int answer = high, runs = 2;

    if (high <= MET && low == high)
        return printf("the expectations are %s at %s = %g and %g, 2 runs; expected a number "
                      "between one that meets them and one that does not\n",
                      answer == MET ? "met" : "not met", a->find, x[0], x[1]), 3;
    for (; answer <= MET && runs < HALVINGS + 2; runs++) {
        const double middle = x[0] + (x[1] - x[0]) / 2;
        answer = try_number(a, middle, 0);
        x[answer != low] = middle;
    }
    if (answer > MET)
        return 2;
    printf("the limit is %s = %.6g +- %.2g: the expectations are met at %.9g, not at %.9g; %d "
           "runs\n", a->find, (x[0] + x[1]) / 2, fabs(x[1] - x[0]) / 2, x[low != MET],
           x[low == MET], runs);
    return 0;
}

static int read_and_run(const arguments *a, clock_t start)
{
    model p;

    if (a->find) {
        catch_signals();
        const int status = find_limit(a);
        return stopped ? 128 + (int)stopped : status;
    }
    int status = model_read(a->model, a->lets, a->let, &p);
    write_results w = { .p = &p, .source = a->model, .folder = a->folder, .matrix = a->matrix,
                        .start = start, .reading = clock() - start };
    for (int k = 0; k < p.notes && !status; k++)
        fprintf(stderr, "%s\n", p.note[k]);
    if (status) {
        fprintf(stderr, "%s\n", p.message);
    } else {
        warn_before(&p, a->model);
        if (!a->quiet)
            describe(&p, a->model);
        status = a->check ? check(&w, a->quiet) : run_model(&w, a->quiet);
    }
    model_free(&p);
    return status;
}

/* A stream that is closed (2>&-) leaves its number to the next file, a table: an empty file takes
 * it, which cannot be written. */
int main(int argc, char *argv[])
{
    const clock_t start = clock();
    FILE *f = fopen("/dev/null", "r");
    arguments a;

    while (f && fileno(f) < 3)
        f = fopen("/dev/null", "r");
    if (f)
        fclose(f);
#ifdef SIGXFSZ
    signal(SIGPIPE, SIG_IGN);     /* a pipe or a disk that takes no more is an error like another */
    signal(SIGXFSZ, SIG_IGN);
#endif
    read_arguments(&a, argc, argv);
    const int status = a.exit >= 0 ? a.exit : read_and_run(&a, start);
    const int lost = fflush(stdout) || ferror(stdout);
    if (lost)
        fprintf(stderr, "bbm: stdout cannot be written\n");
    return status ? status : lost;
}
