/* arch.c - a semicircular masonry arch: how thick, and how rough, it has to be.
 *
 *             .--'--.                 n equal voussoirs (15) with radial joints, mean radius R = 10 m, thickness t,
 *          .-'\  |  /'-.              2500 kg/m^3, between fixed springers.
 *        .'\ .-'"""'-. /'.
 *       /--.'    |    '.--\           Cut at the crown, where by symmetry the thrust H is horizontal, at a height h.
 *      |--|      |<- R ->|-|          The joint at the angle a from the horizontal carries (H, W), W the weight from
 *   ___|__|_____________|__|___       the crown to it, whose line of action lies at x. Moments about the centre tell
 *   ///////             ///////       at which radius r the thrust crosses the joint:
 *
 *                   r (H sin a + W cos a) = H h + W x.
 *
 * The arch stands if there are H, h so that r is between R - t/2 and R + t/2 in all joints - else the arch turns about
 * hinges - and so that nowhere
 *
 *                   abs(H cos a - W sin a) > tan(phi) (H sin a + W cos a),
 *
 * or it slides. Both are linear in H and H h. A search over H gives the least t/R: 0.1061 for n = 15, and 0.1063 if the
 * voussoirs were sectors of a ring and not straight between their corners (Milankovitch's 0.1075 for n to infinity,
 * 21.6 degrees). It also gives the least H of a thicker arch, which needs the least friction: it slides first at the
 * springing, a = 0, where tan(phi) = H/W.
 *
 * Computed: an arch stands if no voussoir has moved by 0.2 m in 4 s. Limits are found by bisection; arches of other
 * numbers of voussoirs stand half a per cent above the least t/R, and fall half a per cent below it. */
#include <math.h>

#include "case.h"

enum { N = 15, SETTLE = 100, STEPS = 400 };

static const double R = 10, RIGHT = 1.57079632679489661923;

static double joint(int n, double k)        /* angle of joint k = 0 .. n from the right springing */
{
    return 2 * RIGHT * k / n;
}

/* --------------------------------------------------------------------------------------- the line of thrust */

/* W and W x of joint k <= n/2 for rho g = 1. A voussoir, a trapezium, has the area A = (ro^2 - ri^2)/2 sin(b), b its
 * angle, and the barycentre at 2/3 cos(b/2) d, d = (ro^2 + ro ri + ri^2)/(ro + ri). An odd number of them has one at
 * the crown: of its half x is d/3 sin(b/2). */
static void weigh(int n, double t, int k, double *W, double *Wx)
{
    const double ri = R - t / 2, ro = R + t / 2, b = joint(n, 1), A = (ro * ro - ri * ri) / 2 * sin(b);
    const double d = (ro * ro + ro * ri + ri * ri) / (ro + ri);

    *W = n % 2 * A / 2;
    *Wx = *W * d / 3 * sin(b / 2);
    for (int i = k; i < n / 2; i++) {
        *W += A;
        *Wx += A * 2 / 3 * cos(b / 2) * d * cos(joint(n, i + 0.5));
    }
}

/* Room for H h under the thrust H: the least of the upper bounds less the largest of the lower ones. */
static double room(int n, double t, double H)
{
    double low = -INFINITY, high = INFINITY, W, Wx;

    for (int k = 0; k <= n / 2; k++) {
        weigh(n, t, k, &W, &Wx);
        const double along = H * sin(joint(n, k)) + W * cos(joint(n, k));
        low = fmax(low, (R - t / 2) * along - Wx);
        high = fmin(high, (R + t / 2) * along - Wx);
    }
    return high - low;
}

/* The thrust with the most room, which is concave in H: search by thirds. */
static double roomiest(int n, double t)
{
    double low = 0, high = 10 * R * t;

    while (high - low > 1e-12 * R) {
        const double a = low + (high - low) / 3, b = high - (high - low) / 3;
        if (room(n, t, a) < room(n, t, b))
            low = a;
        else
            high = b;
    }
    return low;
}

static double least_ratio(int n)
{
    double low = 0.05, high = 0.2;

    while (high - low > 1e-9) {
        const double mid = (low + high) / 2;
        if (room(n, mid * R, roomiest(n, mid * R)) < 0)
            low = mid;
        else
            high = mid;
    }
    return high;
}

/* The friction angle [degree] that the least thrust needs, in the joint that needs most. */
static double least_friction(double ratio)
{
    double low = 0, high = roomiest(N, ratio * R), most = 0, W, Wx;

    while (high - low > 1e-12 * R)
        *(room(N, ratio * R, (low + high) / 2) < 0 ? &low : &high) = (low + high) / 2;
    for (int k = 0; k <= N / 2; k++) {
        const double s = sin(joint(N, k)), c = cos(joint(N, k));
        weigh(N, ratio * R, k, &W, &Wx);
        most = fmax(most, fabs(high * c - W * s) / (high * s + W * c));
    }
    return atan(most) * 90 / RIGHT;
}

/* -------------------------------------------------------------------------------------------- the computation */

/* Block 0 is the right springer, 1 .. n are the voussoirs from there on, n+1 is the left springer. */
static bbm_model *build_arch(int n, double ratio, double friction)
{
    const double t = ratio * R, ri = R - t / 2, ro = R + t / 2;
    bbm_model *m = case_moving_model(&(case_blocks){ 1e12, 0.2, 0.01, 1e10, friction, 1e-12 });

    case_add_box(m, &(case_box){ .nx = 1, .ny = 1, .x = ri - 1, .y = -1, .w = t + 2, .h = 1 });
    for (int k = 0; k < n; k++) {
        int node[4];
        for (int c = 0; c < 4; c++) {
            const double a = joint(n, k + c / 2), r = c % 3 ? ro : ri;
            bbm_add_node(m, r * cos(a), r * sin(a), &node[c]);
        }
        bbm_add_element(m, k + 1, 1, 4, node, NULL);
    }
    case_add_box(m, &(case_box){ .block = n + 1, .nx = 1, .ny = 1, .x = -ro - 1, .y = -1, .w = t + 2, .h = 1 });
    case_fix_block(m, 0);
    case_fix_block(m, n + 1);
    case_must(m, bbm_prepare(m));
    return m;
}

static double moved(const bbm_model *m)
{
    double d = 0;

    for (int k = 1; k < m->elements - 1; k++)
        d = fmax(d, hypot(m->element[k].sum[0], m->element[k].sum[1]));
    return d;
}

/* Lets an arch go until a voussoir has moved `far`, and records it unless s is NULL. */
static bbm_model *let_go(int n, double ratio, double friction, double far, scene *s)
{
    bbm_model *m = build_arch(n, ratio, friction);

    case_settle(m, SETTLE);
    m->info.t = 0;
    if (s)
        scene_record(s, m);
    for (int i = 0; i < STEPS && moved(m) < far; i++)
        case_step(m, s);
    return m;
}

static int stands(int n, double ratio, double friction)
{
    bbm_model *m = let_go(n, ratio, friction, 0.2, NULL);
    const double d = moved(m);

    bbm_model_free(m);
    return d < 0.2;
}

/* Between a value where the arch falls and one where it stands; of t/R if friction > 0, else of the friction. */
static double find_limit(double falls, double good, double ratio, double friction)
{
    const double close = 1e-3 * (good - falls);

    while (good - falls > close) {
        const double mid = (falls + good) / 2;
        *(stands(N, friction > 0 ? mid : ratio, friction > 0 ? friction : mid) ? &good : &falls) = mid;
    }
    return (falls + good) / 2;
}

/* ------------------------------------------------------------------------------------------------- pictures */

/* The radius at which the thrust crosses joint k: (p cross f) summed over its contacts is r n cross sum f, with
 * n = (cos a, sin a). */
static double thrust_radius(const bbm_model *m, int k)
{
    const double a = joint(N, k);
    double f[2] = { 0, 0 }, moment = 0;

    for (int i = 0; i < m->contacts; i++) {
        const bbm_contact *c = &m->contact[i];
        const bbm_edge *corner = &m->edge[c->corner], *edge = &m->edge[c->edge];
        const bbm_vertex *P1 = &m->vertex[corner->a];
        const int up = m->element[corner->element].block > k, below = m->element[edge->element].block > k;
        const int far = m->element[corner->element].block - m->element[edge->element].block;
        double force[2];
        if (c->state == BBM_OPEN || up == below || far > 1 || far < -1)
            continue;
        scene_contact_force(m, c, up ? c->N : -c->N, up ? c->T : -c->T, force);
        f[0] += force[0];
        f[1] += force[1];
        moment += P1->x * force[1] - P1->y * force[0];
    }
    return moment / (cos(a) * f[1] - sin(a) * f[0]);
}

/* An arch with the line through those points, below `top` pixels. */
static void draw_thrust(plot *p, double top, const bbm_model *m, const char *title)
{
    static const double x[2] = { -12.5, 12.5 }, y[2] = { -1.5, 11.3 };

    plot_title(p, 430, top + 26, title);
    plot_draw_frame(p, (plot_box){ 84, top + 40, 692, 692 * 12.8 / 25 }, x, y);
    plot_put(p, "<path fill=\"#e8eef4\" stroke=\"#335577\" d=\"");
    for (int i = 0; i < m->vertices; i++)
        plot_point(p, m->element[m->vertex[i].element].first == i ? "M" : " ", plot_pixel(&p->x, m->vertex[i].x),
                   plot_pixel(&p->y, m->vertex[i].y));
    plot_put(p, "\"/>\n");
    plot_put(p, "<path fill=\"none\" stroke=\"#cc3311\" stroke-width=\"2\" d=\"");
    for (int k = 0; k <= N; k++) {
        const double s = thrust_radius(m, k);
        plot_put(p, "%s%.2f %.2f", k ? " " : "M", plot_pixel(&p->x, s * cos(joint(N, k))),
                 plot_pixel(&p->y, s * sin(joint(N, k))));
    }
    plot_put(p, "\"/>\n");
}

/* The lines of thrust of a thick arch and of one near its limit, at rest. */
static void draw_thrusts(case_results *r)
{
    bbm_model *thick = build_arch(N, 0.15, 30), *thin = build_arch(N, 0.107, 30);
    plot p;

    case_settle(thick, SETTLE);
    case_settle(thin, SETTLE);
    if (case_draw(r, plot_open(&p, case_path(r, "thrust.svg"), 800, 940))) {
        draw_thrust(&p, 0, thick, "Line of thrust of an arch of thickness 0.15 R");
        draw_thrust(&p, 470, thin, "Line of thrust near the least thickness: 0.107 R");
        case_draw(r, plot_close(&p));
    }
    bbm_model_free(thick);
    bbm_model_free(thin);
}

/* Lets an arch go and draws it: NAME.svg at rest or its fall, NAME-states.svg. Returns whether it stood. */
static int show(case_results *r, double ratio, double friction, const char *name, const char *title)
{
    scene s = { .title = title, .window = { -13, 13, -1.2, 11.2 } };
    bbm_model *m = let_go(N, ratio, friction, 8, &s);
    const int stood = moved(m) < 0.2;
    const double t = m->info.t;
    char file[60];

    snprintf(file, sizeof file, "%s.svg", name);
    if (stood)
        case_draw(r, scene_write_panels(&s, m, case_path(r, file), 1, &t));
    else
        case_draw(r, scene_write_movie(&s, m, case_path(r, file)));
    snprintf(file, sizeof file, "%s-states.svg", name);
    if (!stood)
        case_draw(r, scene_write_panels(&s, m, case_path(r, file), 4,
                                        (double[]){ 0.25 * t, 0.5 * t, 0.75 * t, t }));
    scene_free(&s);
    bbm_model_free(m);
    return stood;
}

/* Arches of other numbers of voussoirs: half a per cent above the least t/R, and half a per cent below. */
static void try_others(case_results *r)
{
    static const int n[] = { 9, 11, 16, 21 };

    for (int i = 0; i < LENGTH(n); i++) {
        const double least = least_ratio(n[i]);
        char name[60];
        snprintf(name, sizeof name, "%d voussoirs, 1.005 of t/R = %.5f stands", n[i], least);
        case_compare(r, name, stands(n[i], 1.005 * least, 30), 1);
        snprintf(name, sizeof name, "%d voussoirs, 0.995 of t/R = %.5f stands", n[i], least);
        case_compare(r, name, stands(n[i], 0.995 * least, 30), 0);
    }
}

int main(void)
{
    static const double ratio[] = { 0.107, 0.11, 0.13, 0.15 };
    case_results r;

    printf("\n# Semicircular arch of %d voussoirs\n\n| | computed | theory | error |\n|---|---|---|---|\n", N);
    case_open(&r, "arch");
    case_compare(&r, "least t/R, phi = 30 degrees", find_limit(0.095, 0.12, 0, 30), least_ratio(N));
    for (int i = 0; i < LENGTH(ratio); i++) {
        char name[60];
        snprintf(name, sizeof name, "least phi [degree], t/R = %g", ratio[i]);
        case_compare(&r, name, find_limit(10, 30, ratio[i], 0), least_friction(ratio[i]));
    }
    case_compare(&r, "t/R = 0.15, phi = 30 stands (1 yes, 0 no)",
                 show(&r, 0.15, 30, "stands", "An arch stands: thickness 0.15 R, friction 30 degrees"), 1);
    case_compare(&r, "t/R = 0.15, phi = 15 stands", show(&r, 0.15, 15, "slides", "An arch slides: thickness 0.15 R, friction 15 degrees"), 0);
    case_compare(&r, "t/R = 0.10, phi = 30 stands", show(&r, 0.10, 30, "folds", "An arch folds: thickness 0.10 R, friction 30 degrees"), 0);
    try_others(&r);
    draw_thrusts(&r);
    printf("\nNumbers and pictures: %s/results.csv, stands.svg, thrust.svg, and as films and states slides, folds\n",
           r.folder);
    return case_close(&r) || r.worst > 0.002;     /* the bisection stops at a thousandth of its interval */
}
