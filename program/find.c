/* find.c - the limit of a number, by bisection: the model runs with the number LOW and HIGH. Where
 * the expectations are met at one end and not at the other, the middle takes the place of the end
 * that it is like, until the ends are within a thousandth of where they began. A run that fails has
 * not met them. */

#include "run.h"

enum { NOT_MET, MET, WRONG, STOPPED };
enum { HALVINGS = 10 };         /* 2^-10 of the interval is a thousandth */

/* Whether all is as expected; text: of what is not, or of the last. */
static int run_model(const arguments *a, model *p, char text[520])
{
    run r = { .p = p, .settling = p->settle };
    bbm_status status = BBM_OK;

    p->m->monitor = a->stop;
    while (!status && !r.is_over && !a->stop(p->m, NULL))
        status = run_step(&r);
    if (a->stop(p->m, NULL))
        return STOPPED;
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
    int answer = WRONG;

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
        answer = run_model(a, &p, text);
    if (answer <= MET && !a->quiet)
        printf("%s = %-12.9g %s\n", a->find, x, text);
    fflush(stdout);
    model_free(&p);
    return answer;
}

int find_limit(const arguments *a)
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
        return answer == STOPPED ? 1 : 2;
    printf("the limit is %s = %.6g +- %.2g: the expectations are met at %.9g, not at %.9g; %d "
           "runs\n", a->find, (x[0] + x[1]) / 2, fabs(x[1] - x[0]) / 2, x[low != MET],
           x[low == MET], runs);
    return 0;
}
