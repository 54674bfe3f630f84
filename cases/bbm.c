/* bbm.c - ./bbm MODEL runs a model file: reads it (model.c, msh.c), steps, writes the results (write.c).
 *
 * Exit status: 0, all is done; 1, the run failed, with what was computed until then in the files; 2, the input is
 * wrong, and nothing was written; 130, 143: interrupted (Ctrl-C, kill), with what was computed until then in the files.
 * Errors, warnings and progress go to stderr, what was run and what came out to stdout. */
#define _POSIX_C_SOURCE 200809L
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "write.h"

/* The signal that came. Signals have no other way to say something: this variable, and it alone, has file scope. */
static volatile sig_atomic_t stopped;
enum { NAMED = 10 };                            /* pieces of a block that a warning names at most */

typedef struct { const char *model, *matrix; char folder[1024]; int quiet, exit; } arguments;  /* exit: -1, go on    */

static const char *usage(void)
{
    return "usage: bbm [-q] [-o FOLDER] [-m FILE] MODEL\n"
           "  -o FOLDER   for the results; without it the model's name, in the present folder\n"
           "  -m FILE     the matrix of the first solution (Matrix Market), and its right-hand side as FILE.rhs\n"
           "  -q          quiet: errors and warnings alone\n"
           "  -h, --version\n";
}

static int complain(arguments *a, const char *what)
{
    fprintf(stderr, "bbm: %s\n%s", what, usage());
    return a->exit = 2;
}

/* By default: the model's name without folder and ending. */
static int name_folder(arguments *a, const char *given)
{
    const char *base = strrchr(a->model, '/'), *dot;

    base = given ? given : base ? base + 1 : a->model;
    dot = given ? NULL : strrchr(base, '.');
    const size_t n = dot && dot > base ? (size_t)(dot - base) : strlen(base);
    if (n == 0 || n >= sizeof a->folder)
        return complain(a, "no folder of that name; expected -o FOLDER");
    memcpy(a->folder, base, n);
    a->folder[n] = '\0';
    return 0;
}

/* The options may stand before and after the model; behind `--` a name may begin with a dash. */
static int read_arguments(arguments *a, int argc, char *argv[])
{
    const char *folder = NULL;
    int options = 1;

    *a = (arguments){ .exit = -1 };
    for (int k = 1; k < argc; k++) {
#ifdef _WIN32
        for (char *c = argv[k]; *c; c++)
            *c = *c == '\\' ? '/' : *c;        /* both part folders there */
#endif
        const char *word = argv[k], **value = strncmp(word, "-o", 2) == 0 ? &folder : &a->matrix;
        if (!options || word[0] != '-' || word[1] == '\0') {
            if (a->model)
                return complain(a, "expected one model file");
            a->model = word;
        } else if (strcmp(word, "--") == 0) {
            options = 0;
        } else if (strcmp(word, "-q") == 0) {
            a->quiet = 1;
        } else if (strcmp(word, "-h") == 0 || strcmp(word, "--help") == 0) {
            return printf("%s", usage()), a->exit = 0;
        } else if (strcmp(word, "--version") == 0) {
            return printf("bbm %s\n", BBM_VERSION), a->exit = 0;
        } else if (word[1] == 'o' || word[1] == 'm') {
            *value = word[2] ? word + 2 : argv[++k];
            if (k == argc || **value == '\0')
                return complain(a, "-o and -m need a name");
        } else {
            return complain(a, "unknown option");
        }
    }
    return a->model ? name_folder(a, folder) : complain(a, "expected a model file");
}

/* --------------------------------------------------------------------------------------------------- progress */

typedef struct { int shown, steps, begun; clock_t start, last; } progress;      /* begun: a line without its end */

static void show_progress(progress *s, const bbm_model *m, int step)
{
    const double each = (double)(clock() - s->start) / CLOCKS_PER_SEC / (step > 0 ? step : 1);

    if (!s->shown || (clock() - s->last < CLOCKS_PER_SEC / 10 && step < s->steps))
        return;
    s->last = clock();
    fprintf(stderr, "\rstep %d of %d, t = %.6g s, %d open-close passes, %d contacts, %.0f s left   ", step, s->steps,
            m->info.t, m->info.passes, m->info.contacts, each * (s->steps - step));
    s->begun = 1;
    fflush(stderr);
}

static void end_progress(progress *s)
{
    if (s->begun)
        fputc('\n', stderr);
    s->begun = 0;
}

static void describe(const model *p, const char *path)
{
    const bbm_model *m = p->m;

    printf("%s%s%s\n", path, p->title ? ": " : "", p->title ? p->title : "");
    printf("%d elements in %d blocks, %d nodes, %d bonds; ", m->elements,
           p->blocks, m->nodes, m->bonds);
    if (p->dynamic)
        printf("dynamic, %d steps of %g s%s\n", m->par.steps, m->par.dt, p->settle ? ", settled before" : "");
    else
        printf("static, %d step%s%s\n", m->par.steps, m->par.steps == 1 ? "" : "s",
               m->par.tolerance > 0 ? " at most" : "");
    fflush(stdout);
}

/* What the file leaves out and hardly means. */
static void warn(const model *p, const char *path)
{
    const bbm_model *m = p->m;
    int held = 0;

    for (int n = 0; n < m->nodes; n++)
        held |= m->node[n].held;
    if (!held && (m->par.gravity[0] != 0 || m->par.gravity[1] != 0))
        fprintf(stderr, "%s: warning: nothing is fixed: under gravity all blocks fall; fixblock or fix holds them\n",
                path);
    if (p->slippery)
        fprintf(stderr, "%s: warning: blocks touch without friction: `contact friction DEGREES` gives it\n", path);
}

static void summarise(const model *p, const char *folder)
{
    const bbm_model *m = p->m;
    double far = 0, most = 0;
    int v_far = 0, e_most = 0;

    for (int v = 0; v < m->vertices; v++)
        if (hypot(m->vertex[v].u, m->vertex[v].v) > far)
            far = hypot(m->vertex[v].u, m->vertex[v].v), v_far = v;
    for (int e = 0; e < m->elements; e++)
        if (model_mises(m, e) > most)
            most = model_mises(m, e), e_most = e;
    printf("%d step%s, t = %g s, %d contacts closed, residual %.1e\n", m->info.step, m->info.step == 1 ? "" : "s",
           m->info.t, m->info.contacts, m->info.pcg.residual);
    if (p->dynamic)
        printf("no step made more than %.1e of its energy beyond the work of loads\n", m->beyond->gain);
    printf("largest displacement %.6g m, node %s; largest von Mises stress %.6g Pa, element %s\nresults in %s\n", far,
           p->node[m->vertex[v_far].node], most, p->element[e_most], folder);
}

/* A block whose elements nothing bonds together may be meant, but is said: with an element of each piece. */
static void warn_of_pieces(const model *p, const char *path)
{
    const bbm_model *m = p->m;
    int *piece = calloc((size_t)m->elements + (size_t)p->blocks, sizeof *piece), *count = piece + m->elements;

    if (!piece || bbm_find_pieces(m, piece) == p->blocks) {
        free(piece);
        return;
    }
    for (int e = 0; e < m->elements; e++)
        count[m->element[e].block] += piece[e] == e;
    for (int b = 0; b < p->blocks; b++) {
        int left = count[b] > 1 ? NAMED : 0;
        if (count[b] > 1)
            fprintf(stderr, "%s: warning: block '%s' is in %d pieces that no bond joins, with the elements", path,
                    p->block[b], count[b]);
        for (int e = 0; e < m->elements && left > 0; e++)
            if (piece[e] == e && m->element[e].block == b)
                fprintf(stderr, "%s %s", left-- == NAMED ? "" : ",", p->element[e]);
        if (count[b] > 1)
            fprintf(stderr, "%s; elements are bonded along sides whose two nodes they share\n",
                    count[b] > NAMED ? " ..." : "");
    }
    free(piece);
}

/* --------------------------------------------------------------------------------------------------- the run */

/* Quasi-static steps without shaking. */
static bbm_status settle(model *p)
{
    bbm_model *m = p->m;
    const bbm_parameters par = m->par;
    const bbm_beyond beyond = *m->beyond;
    bbm_status status = BBM_OK;

    m->par.velocity_factor = m->beyond->shake[0] = m->beyond->shake[1] = 0;
    for (int k = 0; k < p->settle && !status && !stopped; k++)
        status = bbm_step(m);
    m->par = par;
    memcpy(m->beyond->shake, beyond.shake, sizeof beyond.shake);
    return status;
}

/* All steps, or until (71) is met; what went wrong is in the library's message or in w. */
static bbm_status run_steps(write_results *w, progress *s)
{
    bbm_model *m = w->p->m;
    const bbm_parameters *par = &m->par;
    bbm_status status = BBM_OK;
    int met = 0;

    if (!model_start(w->p))
        status = BBM_NO_MEMORY;
    if (!status)
        write_step(w, 0);
    for (int step = 1; step <= par->steps && !status && !w->status && !met && !stopped; step++) {
        status = bbm_step(m);
        if (!status)
            write_step(w, step);
        met = !status && par->tolerance > 0 && m->info.change <= par->tolerance;
        show_progress(s, m, met ? s->steps : step);
    }
    return !status && !w->status && !stopped && par->tolerance > 0 && !met ? BBM_STEPS_EXHAUSTED : status;
}

/* Statics without equilibrium, by the names of the file. */
static void report_loose(const model *p, const char *path)
{
    const bbm_model *m = p->m;
    const int i = m->blamed[0], j = m->blamed[1];

    fprintf(stderr, "%s: step %d: statics finds no equilibrium: block '%s' (element %s) ", path, m->info.step + 1,
            p->block[m->element[i].block], p->element[i]);
    if (j >= 0)
        fprintf(stderr, "slides, rolls, tips on or leaves block '%s' (element %s); raise the friction, fix it, or use dynamic\n",
                p->block[m->element[j].block], p->element[j]);
    else
        fprintf(stderr, "is free to move; fix it, or use dynamic\n");
}

/* The message of a run that failed; `when`: in which part of it. The library's own message may name the step. */
static void report(const model *p, bbm_status status, const char *when, const arguments *a)
{
    const bbm_model *m = p->m;
    const char *message = *m->message ? m->message : bbm_status_text(status);

    if (stopped)
        fprintf(stderr, "%s: interrupted at %sstep %d of %d, t = %g s; what was computed until then is in %s\n",
                a->model, when, m->info.step, *when ? p->settle : m->par.steps, m->info.t, a->folder);
    else if (status == BBM_STEPS_EXHAUSTED)
        fprintf(stderr, "%s: step %d: no equilibrium, change %.2g, expected %.2g; more steps may help\n", a->model,
                m->info.step, m->info.change, m->par.tolerance);
    else if (status == BBM_NO_EQUILIBRIUM)
        report_loose(p, a->model);
    else if (status && strstr(message, "step "))
        fprintf(stderr, "%s: %s%s\n", a->model, when, message);
    else if (status)
        fprintf(stderr, "%s: %sstep %d: %s\n", a->model, when, m->info.step + 1, message);
}

/* Looked at before each solution: the matrix if it is wanted, and whether to stop. */
static int before_solution(const bbm_model *m, void *results)
{
    write_results *w = results;

    (void)m;
    if (w->matrix)
        write_matrix(w);
    return stopped != 0;
}

/* The first signal is noted; another one, or the same more than a second later, ends the program at once. (timeout(1)
 * sends the same to the program and to its group.) */
static void stop(int number)
{
    static volatile time_t first;

    if (stopped && (number != stopped || time(NULL) > first + 1))
        _Exit(128 + number);
    if (!stopped)
        first = time(NULL);
    stopped = number;
    signal(number, stop);                       /* some systems forget it */
}

/* What is ignored (nohup) stays ignored. */
static void catch_signals(void)
{
    static const int caught[] = { SIGINT, SIGTERM,
#ifdef SIGHUP
        SIGHUP,
#endif
    };

    for (size_t k = 0; k < sizeof caught / sizeof *caught; k++)
        if (signal(caught[k], stop) == SIG_IGN)
            signal(caught[k], SIG_IGN);
}

static int run(model *p, const arguments *a, clock_t start)
{
    write_results w = { .p = p, .source = a->model, .folder = a->folder, .matrix = a->matrix, .start = start,
                        .reading = clock() - start };
    progress s = { !a->quiet && isatty(2), p->m->par.steps, 0, clock(), 0 };
    bbm_status status = BBM_OK;
    const char *when = "settling, ";

    catch_signals();
    warn(p, a->model);
    warn_of_pieces(p, a->model);
    p->m->monitor = before_solution;
    p->m->monitor_context = &w;
    if (!a->quiet)
        describe(p, a->model);
    if (write_open(&w)) {
        status = settle(p);
        if (!status && !stopped) {
            when = "";
            p->m->info.t = p->m->info.step = 0;
            status = run_steps(&w, &s);
        }
        end_progress(&s);
        write_close(&w);
        report(p, status, when, a);
    }
    if (!a->quiet && !status && !w.status && !stopped)
        summarise(p, a->folder);
    return stopped ? 128 + (int)stopped : status || w.status ? 1 : 0;
}

static int read_and_run(const arguments *a, clock_t start)
{
    model p;
    int status = model_read(a->model, 0, NULL, &p);

    if (status)
        fprintf(stderr, "%s\n", p.message);
    else
        status = run(&p, a, start);
    model_free(&p);
    return status;
}

int main(int argc, char *argv[])
{
    const clock_t start = clock();
    arguments a;

#ifdef SIGXFSZ
    signal(SIGPIPE, SIG_IGN);                   /* a pipe or a disk that takes no more is an error like another */
    signal(SIGXFSZ, SIG_IGN);
#endif
    read_arguments(&a, argc, argv);
    const int status = a.exit >= 0 ? a.exit : read_and_run(&a, start);
    if (fflush(stdout) || ferror(stdout)) {
        fprintf(stderr, "bbm: stdout cannot be written\n");
        return status ? status : 1;
    }
    return status;
}
