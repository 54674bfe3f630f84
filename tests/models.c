/* models.c - the models that the tests share. */
#include <string.h>

#include "models.h"

const bbm_material SOLID = { .E = 1000, .nu = 0.3, .density = 2, .thickness = 0.5 };

const bbm_material CORK = { .E = 1000, .nu = 0, .density = 2, .thickness = 0.5 };

enum { MODELS = 64 };

/* The models that a test has made; the last place is for any other one. */
static bbm_model **all_models(void)
{
    static bbm_model *model[MODELS];

    return model;
}

static bbm_model **place_of(const bbm_model *m)
{
    bbm_model **place = all_models();

    while (place < all_models() + MODELS - 1 && *place != m)
        place++;
    return place;
}

bbm_model *beyond_model(void)
{
    bbm_model **m = place_of(NULL);

    ck_assert_int_eq(bbm_beyond_new(m), BBM_OK);
    return *m;
}

void release(bbm_model *m)
{
    *place_of(m) = NULL;
    bbm_model_free(m);
}

void release_models(void)
{
    for (int k = 0; k < MODELS; k++)
        release(all_models()[k]);
}

bbm_model *new_model(const bbm_material *material)
{
    bbm_model *m = beyond_model();

    m->beyond->bonding = BBM_VERTICES;         /* the paper's bonds; check_beyond.c has the others */
    ck_ok(bbm_add_material(m, material, NULL), m);
    m->par.pcg.tolerance = 1e-15;
    m->par.pcg.iterations = 1000; /* several times what is needed: an error ends at once */
    return m;
}

int node_at(const grid *g, int i, int j)
{
    return g->first + j * (g->nx + 1) + i;
}

static void add_cell(bbm_model *m, const grid *g, int i, int j, int block)
{
    const int c[4] = { node_at(g, i, j), node_at(g, i + 1, j), node_at(g, i + 1, j + 1),
                       node_at(g, i, j + 1) };
    const int rising[2][3] = { { c[0], c[1], c[2] }, { c[0], c[2], c[3] } };
    const int falling[2][3] = { { c[0], c[1], c[3] }, { c[1], c[2], c[3] } };
    const int material = m->materials - 1, cut = g->triangles == 1 || (g->triangles == 2 && (i + 2 * j) % 3 == 0);

    if (!cut)
        ck_ok(bbm_add_element(m, block, material, 4, c, NULL), m);
    for (int t = 0; t < 2 && cut; t++)
        ck_ok(bbm_add_element(m, block, material, 3, (i + j) % 2 ? falling[t] : rising[t],
                              NULL), m);
}

void add_grid(bbm_model *m, grid *g, int block)
{
    const double c = cos(g->angle), s = sin(g->angle);
    unsigned seed = 5;

    g->first = m->nodes;
    g->element = m->elements;
    for (int j = 0; j <= g->ny; j++)
        for (int i = 0; i <= g->nx; i++) {
            const int inner = i > 0 && i < g->nx && j > 0 && j < g->ny;
            const double x = (i + inner * g->jitter * random_number(&seed)) * g->lx / g->nx;
            const double y = (j + inner * g->jitter * random_number(&seed)) * g->ly / g->ny;
            ck_ok(bbm_add_node(m, g->x + c * x - s * y, g->y + s * x + c * y, NULL), m);
        }
    for (int j = 0; j < g->ny; j++)
        for (int i = 0; i < g->nx; i++)
            add_cell(m, g, i, j, block);
}

bbm_model *cantilever(const bbm_material *material, grid *g, double fx, double fy)
{
    bbm_model *m = new_model(material);

    add_grid(m, g, 0);
    for (int j = 0; j <= g->ny; j++)
        ck_ok(bbm_fix_node(m, node_at(g, 0, j), BBM_XY, 0, 0), m);
    ck_ok(bbm_add_load(m, node_at(g, g->nx, g->ny), fx, fy), m);
    ck_ok(bbm_prepare(m), m);
    return m;
}

bbm_model *unit_square(const bbm_material *material)
{
    const double x[4][2] = { { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 } };
    bbm_model *m = new_model(material);

    add_polygon(m, 0, 4, x);
    return m;
}

bbm_model *points(double size)
{
    bbm_model *m = new_model(&SOLID);

    for (int n = 0; n < 25; n++)
        ck_ok(bbm_add_node(m, n % 5 * size, n / 5 * size, NULL), m);
    ck_ok(bbm_add_node(m, size, 1e-13 * size, NULL), m);
    ck_ok(bbm_add_node(m, size, 1e-6 * size, NULL), m);
    ck_ok(bbm_add_node(m, 1e-13 * size, size, NULL), m);
    return m;
}

bbm_result result_at(const bbm_model *m, int node)
{
    bbm_result r;

    ck_assert_int_eq(bbm_nodal_result(m, node, -1, &r), BBM_OK);
    return r;
}

bbm_model *new_bar(const bbm_material *material, int materials)
{
    bbm_model *m = new_model(material);
    const double f = 3 / 2.0;

    for (int a = 1; a < materials; a++)
        ck_ok(bbm_add_material(m, &material[a], NULL), m);
    for (int i = 0; i <= LINKS; i++)
        for (int j = 0; j < 2; j++)
            ck_ok(bbm_add_node(m, 0.5 * i, j, NULL), m);
    for (int e = 0; e < LINKS; e++)
        ck_ok(bbm_add_element(m, 0, e % materials, 4,
                              (int[]){ 2 * e, 2 * e + 2, 2 * e + 3, 2 * e + 1 }, NULL), m);
    for (int j = 0; j < 2; j++) {
        ck_ok(bbm_fix_node(m, j, BBM_XY, 0, 0), m);
        ck_ok(bbm_add_load(m, 2 * LINKS + j, f, 0), m);
    }
    ck_ok(bbm_prepare(m), m);
    return m;
}

void total_load(const bbm_model *m, int e, double total[3])
{
    const double *F = &m->F[6 * e];
    const bbm_element *b = &m->element[e];

    total[0] += F[0];
    total[1] += F[1];
    total[2] += F[2] + b->x * F[1] - b->y * F[0];
}

void rising_load(double x, double y, const void *context, double f[2])
{
    const double *scale = context;

    f[0] = scale[0] * x * y;
    f[1] = scale[1] * x * x;
}

/* K += t A B^T E B of one triangle; the unknowns of node n are 2 n and 2 n + 1. */
static void add_triangle(const bbm_model *m, const bbm_element *e, int n, double *K)
{
    const bbm_material *s = &e->material;
    const double c = s->E / (1 - s->nu * s->nu);
    const double E[3][3] = { { c, c * s->nu, 0 }, { c * s->nu, c, 0 },
                                                             { 0, 0, c * (1 - s->nu) / 2 } };
    double B[3][6] = { { 0 } };
    int row[6];

    const bbm_vertex *v = &m->vertex[e->first];
    const double A = ((v[1].x - v[0].x) * (v[2].y - v[0].y) -
                      (v[2].x - v[0].x) * (v[1].y - v[0].y)) / 2;
    for (int a = 0; a < 3; a++) {
        const bbm_vertex *q = &v[(a + 1) % 3], *r = &v[(a + 2) % 3];
        B[0][2 * a] = B[2][2 * a + 1] = (q->y - r->y) / (2 * A);
        B[1][2 * a + 1] = B[2][2 * a] = (r->x - q->x) / (2 * A);
        row[2 * a] = 2 * v[a].node;
        row[2 * a + 1] = 2 * v[a].node + 1;
    }
    for (int a = 0; a < 6; a++)
        for (int b = 0; b < 6; b++)
            for (int p = 0; p < 3; p++)
                for (int q = 0; q < 3; q++)
                    K[row[a] * n + row[b]] += s->thickness * A * B[p][a] * E[p][q] * B[q][b];
}

double *finite_element(const bbm_model *m)
{
    const int n = 2 * m->nodes;
    double *K = calloc((size_t)(n * n), sizeof *K), *u = calloc((size_t)n, sizeof *u);

    for (int e = 0; e < m->elements; e++)
        add_triangle(m, &m->element[e], n, K);
    for (int a = 0; a < n; a++) {
        u[a] = m->node[a / 2].load[a % 2];
        if (!(m->node[a / 2].held & (a % 2 ? BBM_Y : BBM_X)))
            continue;
        for (int b = 0; b < n; b++)
            K[a * n + b] = K[b * n + a] = 0;
        K[a * n + a] = 1;
        u[a] = 0;
    }
    eliminate(n, K, u);
    free(K);
    return u;
}

double distance_from_finite_element(bbm_model *m)
{
    double *u = finite_element(m), size = 0, error = 0;

    ck_ok(bbm_run(m), m);
    for (int n = 0; n < m->nodes; n++) {
        const bbm_result r = result_at(m, n);
        size = fmax(size, hypot(u[2 * n], u[2 * n + 1]));
        error = fmax(error, hypot(r.u - u[2 * n], r.v - u[2 * n + 1]));
    }
    free(u);
    release(m);
    return error / size;
}

bbm_model *two_squares(int block0, int block1)
{
    bbm_model *m = new_model(&SOLID);

    for (int n = 0; n < 6; n++)
        ck_ok(bbm_add_node(m, n % 3, n / 3, NULL), m);
    ck_ok(bbm_add_element(m, block0, 0, 4, (int[]){ 0, 1, 4, 3 }, NULL), m);
    ck_ok(bbm_add_element(m, block1, 0, 4, (int[]){ 1, 2, 5, 4 }, NULL), m);
    return m;
}

bbm_model *fan(int triangles, const double top[][2], const int block[])
{
    bbm_model *m = new_model(&SOLID);

    ck_ok(bbm_add_node(m, 0, 0, NULL), m);
    ck_ok(bbm_add_node(m, 1, 0, NULL), m);
    for (int e = 0; e < triangles; e++) {
        ck_ok(bbm_add_node(m, top[e][0], top[e][1], NULL), m);
        ck_ok(bbm_add_element(m, block[e], 0, 3, (int[]){ 0, 1, 2 + e }, NULL), m);
    }
    return m;
}

double radians(double degrees) { return degrees * PI / 180; }

bbm_model *new_blocks(void)
{
    const bbm_material rock = { 1e10, 0.25, 2500, 1 }, base = { 1e14, 0.25, 2500, 1 };
    bbm_model *m = beyond_model();

    m->par.dt = 0.01;
    m->par.velocity_factor = 1;
    m->par.gravity[1] = -GRAVITY;
    m->par.pcg.tolerance = 1e-14;
    m->par.pcg.iterations = 1000; /* several times what is needed: an error ends at once */
    ck_ok(bbm_add_material(m, &rock, NULL), m);
    ck_ok(bbm_add_material(m, &base, NULL), m);
    return m;
}

bbm_model *weightless_blocks(void)
{
    bbm_model *m = new_blocks();

    m->par.gravity[1] = 0;
    return m;
}

int add_rectangle(bbm_model *m, int block, int material, rectangle r)
{
    const int nx = r.nx ? r.nx : 1, ny = r.ny ? r.ny : 1, first = m->elements, node = m->nodes;
    const double c = cos(radians(r.angle)), s = sin(radians(r.angle));

    for (int j = 0; j <= ny; j++)
        for (int i = 0; i <= nx; i++) {
            const double x = r.x + r.w * i / nx, y = r.y + r.h * j / ny;
            ck_ok(bbm_add_node(m, c * x - s * y, s * x + c * y, NULL), m);
            if (r.fixed)
                ck_ok(bbm_fix_node(m, m->nodes - 1, BBM_XY, 0, 0), m);
        }
    for (int j = 0; j < ny; j++)
        for (int i = 0; i < nx; i++) {
            const int a = node + j * (nx + 1) + i;
            ck_ok(bbm_add_element(m, block, material, 4,
                                  (int[]){ a, a + 1, a + nx + 2, a + nx + 1 }, NULL), m);
        }
    return first;
}

int add_polygon(bbm_model *m, int block, int n, const double p[][2])
{
    int node[40], e = -1;

    ck_assert_int_le(n, COUNT(node));
    for (int k = 0; k < n; k++)
        ck_ok(bbm_add_node(m, p[k][0], p[k][1], &node[k]), m);
    ck_ok(bbm_add_element(m, block, ROCK, n, node, &e), m);
    return e;
}

void add_table(bbm_model *m, int block)
{
    add_rectangle(m, block, BASE, (rectangle){ .x = -5, .y = -1, .w = 10, .h = 1, .fixed = 1 });
}

void prepare_apart(bbm_model *m)
{
    for (int away = 1; away >= 0; away--) {
        for (int v = 0; v < m->vertices; v++)
            m->node[m->vertex[v].node].x = m->vertex[v].x +
                                           away * 1e3 * m->element[m->vertex[v].element].block;
        if (away)
            ck_ok(bbm_prepare(m), m);
    }
}

void list_middles(bbm_model *m)
{
    bbm_list_edge_gaps(m);
    for (int g = 0; g < m->gaps; g++)
        if (m->gap[g].elastic)
            memset(m->gap[g].W, 0, sizeof m->gap[g].W);
}

void set_springs(bbm_model *m, double p_n, double p_s)
{
    m->par.p_n = p_n;
    m->par.p_s = p_s;
}

void prepare(bbm_model *m)
{
    if (!m->is_prepared)
        ck_ok(bbm_prepare(m), m);
}

void run(bbm_model *m)
{
    prepare(m);
    ck_ok(bbm_run(m), m);
}

void run_steps(bbm_model *m, int steps)
{
    prepare(m);
    for (int i = 0; i < steps; i++)
        ck_ok(bbm_step(m), m);
}

void settle(bbm_model *m, int steps)
{
    const double keep = m->par.velocity_factor;

    m->par.velocity_factor = 0;
    run_steps(m, steps);
    m->par.velocity_factor = keep;
}

void set_velocity(bbm_model *m, int element, double vx, double vy)
{
    prepare(m);
    m->element[element].V[0] = vx;
    m->element[element].V[1] = vy;
}

const bbm_vertex *vertex_of(const bbm_model *m, int element, int corner)
{
    return &m->vertex[m->element[element].first + corner];
}

static int block_of(const bbm_model *m, int edge)
{
    return m->element[m->edge[edge].element].block;
}

int corner_block(const bbm_model *m, const bbm_contact *c) { return block_of(m, c->corner); }
int edge_block(const bbm_model *m, const bbm_contact *c) { return block_of(m, c->edge); }
const bbm_vertex *start_of(const bbm_model *m, int edge) { return &m->vertex[m->edge[edge].a]; }
const bbm_vertex *end_of(const bbm_model *m, int edge) { return &m->vertex[m->edge[edge].b]; }

const bbm_vertex *corner_vertex(const bbm_model *m, const bbm_contact *c)
{
    return start_of(m, c->corner);
}

/* Whether a contact is closed and joins the two blocks. */
static int closed_between(const bbm_model *m, const bbm_contact *c, int p, int q)
{
    const int a = corner_block(m, c), b = edge_block(m, c);

    return c->state != BBM_OPEN && ((a == p && b == q) || (a == q && b == p));
}

double normal_force(const bbm_model *m, int p, int q)
{
    double N = 0;

    for (int k = 0; k < m->contacts; k++)
        if (closed_between(m, &m->contact[k], p, q))
            N += m->contact[k].N;
    return N;
}

const bbm_contact *contact_of(const bbm_model *m, int element, int corner)
{
    for (int k = 0; k < m->contacts; k++)
        if (m->contact[k].state != BBM_OPEN &&
            corner_vertex(m, &m->contact[k]) == vertex_of(m, element, corner))
            return &m->contact[k];
    return NULL;
}

size_t state_of(const bbm_model *m, double state[STATE])
{
    size_t n = 0;

    ck_assert(4 * m->vertices + 18 * m->elements + 9 * m->contacts + 1 <= STATE);
    for (int v = 0; v < m->vertices; v++) {
        const bbm_vertex *p = &m->vertex[v];
        const double here[4] = { p->x, p->y, p->u, p->v };
        memcpy(&state[n], here, sizeof here);
        n += 4;
    }
    for (int i = 0; i < m->elements; i++) {
        const bbm_element *e = &m->element[i];
        const double here[3] = { e->A0, e->sum[0], e->sum[1] };
        memcpy(&state[n], here, sizeof here);
        memcpy(&state[n + 3], e->V, sizeof e->V);
        memcpy(&state[n + 9], e->stress, sizeof e->stress);
        memcpy(&state[n + 12], e->D, sizeof e->D);
        n += 18;
    }
    for (int k = 0; k < m->contacts; k++) {
        const bbm_contact *c = &m->contact[k];
        const double here[9] = { c->corner, c->edge, c->state, c->sign, c->anchor, c->N,
                                 c->T, c->slip, c->area };
        memcpy(&state[n], here, sizeof here);
        n += 9;
    }
    state[n++] = m->info.t;
    return n;
}

int same_state(const bbm_model *m, const bbm_model *n)
{
    static double a[STATE], b[STATE];       /* written before they are read */
    const size_t size = state_of(m, a);

    return state_of(n, b) == size && memcmp(a, b, size * sizeof *a) == 0;
}

outline put(const outline *o, double angle, double x, double y)
{
    outline p = { .n = o->n };

    for (int k = 0; k < o->n; k++) {
        p.x[k][0] = x + cos(angle) * o->x[k][0] - sin(angle) * o->x[k][1];
        p.x[k][1] = y + sin(angle) * o->x[k][0] + cos(angle) * o->x[k][1];
    }
    return p;
}

const outline SQUARE = { 4, { { -0.5, -0.5 }, { 0.5, -0.5 }, { 0.5, 0.5 }, { -0.5, 0.5 } } };

const outline NOTCHED = {
    6, { { -0.5, -0.5 }, { 0.5, -0.5 }, { 0.5, 0 }, { 0, 0 }, { 0, 0.5 }, { -0.5, 0.5 } },
};

static const outline STRIP = {
    6, { { -0.6, -0.2 }, { 0, -0.2 }, { 0.6, -0.2 }, { 0.6, 0.2 }, { 0, 0.2 }, { -0.6, 0.2 } },
};

outline random_outline(int kind, double x, double y, unsigned *seed)
{
    const double angle = PI * random_number(seed);
    outline p = { .n = 3 + (int)(2.4 * (1 + random_number(seed))) };

    if (kind == 1)
        return put(&NOTCHED, angle, x, y);
    if (kind == 2)
        return put(&STRIP, angle, x, y);
    for (int k = 0; k < p.n; k++) {
        const double a = 2 * PI * (k + 0.3 * random_number(seed)) / p.n;
        p.x[k][0] = 0.6 * cos(a);
        p.x[k][1] = 0.6 * sin(a);
    }
    return put(&p, angle, x, y);
}

void add_outline(bbm_model *m, int block, const outline *o, int strip)
{
    const int n = m->nodes;

    if (!strip) {
        add_polygon(m, block, o->n, o->x);
        return;
    }
    for (int k = 0; k < 6; k++)
        ck_ok(bbm_add_node(m, o->x[k][0], o->x[k][1], NULL), m);
    ck_ok(bbm_add_element(m, block, ROCK, 4, (int[]){ n, n + 1, n + 4, n + 5 }, NULL), m);
    ck_ok(bbm_add_element(m, block, ROCK, 4, (int[]){ n + 1, n + 2, n + 3, n + 4 }, NULL), m);
}

void detect(bbm_model *m)
{
    prepare(m);
    m->h = m->par.dt;
    bbm_foresee_step(m);
    ck_ok(bbm_detect_contacts(m, &(int){ 0 }), m);
    bbm_store_contacts(m);
}

const double ANGLES[] = { 0, 20, 90, 135, 180, 270 };

bbm_model *wall(const int order[16], double angle)
{
    bbm_model *m = new_blocks();

    for (int k = 0; k < 16; k++) {
        const int row = order[k] / 4, column = order[k] % 4;
        const double x = column + (row == 1 ? 0.5 : row == 3 ? 0.25 : 0);
        add_rectangle(m, order[k], ROCK,
                      (rectangle){ x, row, 1, 1, angle, .nx = 1 + order[k] % 2 });
    }
    ck_ok(bbm_prepare(m), m);
    return m;
}

const seat SEATS[] = {
    { 0, 1 }, { 0.25, 0.5 }, { -0.5, 2 }, { 0.25, 1 }, { -0.25, 1 }, { 0, 0.5 },
    { 0.5, 0.5 }, { 0, 1.5 },
    { 0.25, 1.2 }, { -0.45, 1.2 },
};

void stand(const bbm_model *m, const bbm_contact *c, double *beyond, double *clear)
{
    const bbm_element *e = &m->element[m->edge[c->corner].element];
    const int k = m->edge[c->corner].a - e->first;
    const bbm_vertex *P = corner_vertex(m, c), *A = start_of(m, c->edge), *B = end_of(m, c->edge);
    const bbm_vertex *v = &m->vertex[e->first], *next = &v[(k + 1) % e->n];
    const bbm_vertex *last = &v[(k + e->n - 1) % e->n];
    const double l = hypot(B->x - A->x, B->y - A->y);
    const double t[2] = { (B->x - A->x) / l, (B->y - A->y) / l };
    const double s = (P->x - A->x) * t[0] + (P->y - A->y) * t[1];

    *beyond = fmax(-s, s - l);
    *clear = fmin(((next->x - P->x) * t[1] - (next->y - P->y) * t[0]) /
                      hypot(next->x - P->x, next->y - P->y),
                  ((last->x - P->x) * t[1] - (last->y - P->y) * t[0]) /
                      hypot(last->x - P->x, last->y - P->y));
}

bbm_model *incline(double phi, double p_n, int pieces)
{
    bbm_model *m = new_blocks();

    m->par.friction = phi;
    set_springs(m, p_n, 0.4 * p_n);
    add_rectangle(m, 0, BASE, (rectangle){ -8, -1, 10, 1, 30, .nx = pieces, .fixed = 1 });
    add_rectangle(m, 1, ROCK, (rectangle){ 0.013, 0, 1, 0.5, 30, .fixed = 0 });
    ck_ok(bbm_prepare(m), m);
    return m;
}

double slid(const bbm_model *m, int e)
{
    return -cos(PI / 6) * m->element[e].sum[0] - sin(PI / 6) * m->element[e].sum[1];
}

bbm_model *pile(unsigned seed, int reversed)
{
    outline o[PILE];
    bbm_model *m = new_blocks();

    m->par.friction = 30;
    m->par.pcg.tolerance = 1e-11;
    for (int b = 0; b < PILE; b++)
        o[b] = random_outline(0, 1.3 * (b % 3), 0.61 + 1.22 * (b / 3), &seed);
    if (!reversed)
        add_table(m, PILE);
    for (int k = 0; k < PILE; k++)
        add_outline(m, reversed ? PILE - 1 - k : k, &o[reversed ? PILE - 1 - k : k], 0);
    if (reversed)
        add_table(m, PILE);
    ck_ok(bbm_prepare(m), m);
    return m;
}

bbm_status fall(bbm_model *m)
{
    bbm_status status = bbm_prepare(m);

    while (!status && m->info.step < 40)
        status = bbm_step(m);
    return status;
}

bbm_contact *list_contacts(const bbm_model *m, int *n)
{
    *n = m->scratch->contacts;
    return m->scratch->contact;
}

bbm_contact *start_step(bbm_model *m, int *n)
{
    prepare(m);
    m->h = m->par.dt;
    bbm_foresee_step(m);
    ck_ok(bbm_detect_contacts(m, &(int){ 0 }), m);
    memset(m->D, 0, 6 * (size_t)m->elements * sizeof *m->D);
    bbm_contact *list = list_contacts(m, n);
    for (int k = 0; k < *n; k++)
        list[k].state = list[k].trial.touches ? BBM_OPEN : list[k].state;
    return list;
}

int look_at(bbm_model *m, int e, double u, double v)
{
    int n, closed = 0;

    m->D[6 * e] = u;
    m->D[6 * e + 1] = v;
    (void)bbm_open_close(m);
    const bbm_contact *list = list_contacts(m, &n);
    for (int k = 0; k < n; k++)
        closed += list[k].state != BBM_OPEN;
    return closed;
}

bbm_contact *find_listed(const bbm_model *m, int e, int corner, int f, int edge)
{
    int n;
    bbm_contact *list = list_contacts(m, &n);

    for (int k = 0; k < n; k++)
        if (corner_vertex(m, &list[k]) == vertex_of(m, e, corner)
            && start_of(m, list[k].edge) == vertex_of(m, f, edge))
            return &list[k];
    return NULL;
}

void shift_element(bbm_model *m, int e, double x, double y)
{
    for (int k = 0; k < m->element[e].n; k++) {
        m->vertex[m->element[e].first + k].x += x;
        m->vertex[m->element[e].first + k].y += y;
    }
}

int add_wedge(bbm_model *m, int block, const double at[2], double from, double to)
{
    const double p[3][2] = { { at[0], at[1] }, { at[0] + cos(from), at[1] + sin(from) },
                             { at[0] + cos(to), at[1] + sin(to) } };

    return add_polygon(m, block, 3, p);
}

bbm_model *tip_at(int side, double x, double y, bbm_contact *touched[2])
{
    const double tip[2] = { 1e-3, 1e-3 };
    bbm_model *m = weightless_blocks();
    int n;

    add_rectangle(m, 0, ROCK, (rectangle){ .x = -1, .y = -1, .w = 1, .h = 1 });
    add_wedge(m, 1, tip, radians(25), radians(65));
    ck_ok(bbm_prepare(m), m);
    set_velocity(m, 1, -0.3, -0.3);
    start_step(m, &n);
    bbm_contact *c = find_listed(m, 1, 0, 0, 1 + side);
    ck_assert_ptr_nonnull(c);
    c->state = BBM_LOCK;
    c->d_n = -2e-3;
    c->N = 2e-3 * m->par.p_n;
    bbm_store_contacts(m);
    shift_element(m, 1, x - tip[0], y - tip[1]);
    set_velocity(m, 1, 0, 0);
    start_step(m, &n);
    for (int k = 0; k < 2; k++)
        touched[k] = find_listed(m, 1, 0, 0, 1 + k);
    return m;
}
