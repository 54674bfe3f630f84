/* statements.c - the statements of a model file, in a table near the end: each with its form, the
 * function that carries it out and the phase in which it does, so that a file may have them in
 * any order.
 *
 *     NUMBERS          let, repeat, end           before all others: numbers.c
 *     ALONE            title, node, mesh, material, and all that goes into the parameters
 *     NODES            element                    needs nodes and materials
 *                      shake, output              need to know whether the model is dynamic
 *     MADE             block, grid                number on from the largest ids
 *     ALL_NODES        set                        needs nodes
 *     BLOCKS           use, fixblock              need blocks
 *     MODEL            the rest, on the library's model, which is built and prepared: build.c
 *     MONITORS         monitor                    needs bolts
 *     EXPECTED         expect                     needs monitors
 *
 * The statements of a stage follow, stage by stage, on the finished model: stage.c. */

#include "cell.h"
#include "reader.h"

enum { NUMBERS, ALONE, NODES, MADE, ALL_NODES, BLOCKS, MODEL, MONITORS, EXPECTED, PHASES };
enum { ONCE = 1, STAGED, DYNAMIC = 4 };     /* it may stand once, in a stage, not in statics */

#ifndef MOST_CELLS
#define MOST_CELLS 4000000                  /* of a grid; fewer where inputs are arbitrary */
#endif

#define MOST_NUMBERED 100000000000000000        /* ids of blocks and grids are below it */

/* ----------------------------------------------------------------- statements that need nothing */

static int read_title(model_reader *r)
{
    r->p->title = model_word(r);
    if (r->p->title)
        model_clean(r->p->title);
    return r->p->title != NULL;
}

static int read_node(model_reader *r)
{
    model_node n = { .id = model_id(r), .at = r->s->at, .by_hand = 1, .first = -1 };

    return n.id && model_number(r, &n.x) && model_number(r, &n.y) && model_add_node(r, &n);
}

/* The path of a file that the next word names, beside the model file; or NULL. */
static const char *next_path(model_reader *r)
{
    const char *word = model_word(r), *slash = strrchr(r->whole.file, '/');
    const int folder = slash && word && *word != '/' ? (int)(slash + 1 - r->whole.file) : 0;

    return word ? model_print(r, "%.*s%s", folder, r->whole.file, word) : NULL;
}

static int read_mesh(model_reader *r)
{
    const char *path = next_path(r);
    const int by_surface = path && model_skip(r, "by");

    return path && (!by_surface || model_keyword(r, "surface")) && model_at_end(r)
           && model_read_mesh(r, path, by_surface);
}

static int read_material(model_reader *r)
{
    const char *word = model_new_name(r, &r->material_of);
    bbm_material m = { .thickness = 1 };
    model_option o[] = { NORMAL("E", &m.E), NORMAL("density", &m.density),
                         RANGE("nu", &m.nu, -1, 0.5, "()", "more than -1 and less than 0.5"),
                         NORMAL("thickness", &m.thickness) };

    if (!word || !model_options(r, 3, LENGTH(o), o))
        return 0;
    r->light = m.density < 10 ? r->s : r->light;
    return model_enter(r, &r->material_of, word, r->materials)
           && model_add(r, &r->material, &r->materials, sizeof m, &m);
}

static int read_gravity(model_reader *r) { return model_numbers(r, 2, r->p->m->par.gravity); }

static int read_shake(model_reader *r)
{
    bbm_beyond *b = r->p->m->beyond;
    model_option scale = NUMBER("scale", &r->p->shake);
    const char *path;
    char *end = "";

    r->p->shake = 1;
    if (model_look(r) && (strtod(model_look(r), &end), *end))           /* no number: a file */
        return (path = next_path(r)) && model_options(r, 0, 1, &scale)
               && model_read_record(r, path);
    return model_numbers(r, 2, b->shake) && model_number(r, &b->shake_omega);
}

static int read_plane(model_reader *r)
{
    return model_choice(r, "stress|strain", &r->plane_strain);
}

static int read_contact(model_reader *r)
{
    bbm_parameters *p = &r->p->m->par;
    bbm_beyond *b = r->p->m->beyond;
    model_option o[] = { FROM_ZERO("kn", &p->p_n), FROM_ZERO("ks", &p->p_s),
                         RANGE("restitution", &b->restitution, 0, 1, "[]", "0 to 1"),
                         FROM_ZERO("round", &p->round), FROM_ZERO("cohesion", &b->cohesion),
                         FROM_ZERO("tension", &b->tension), ANGLE("friction", &p->friction) };

    if (!model_options(r, 0, LENGTH(o), o) || !model_note_friction(r, p->friction))
        return 0;
    return !r->s->stage || !(o[0].seen || o[1].seen || o[2].seen || o[3].seen)
           || model_blame(r, "kn, ks, restitution or round in a stage, expected friction, cohesion "
                          "or tension");
}

static int read_static(model_reader *r)
{
    bbm_parameters *p = &r->p->m->par;
    model_option o[] = { COUNT("steps", &p->steps, 1),
                         RANGE("tolerance", &p->tolerance, 0, 1, "()",
                               "more than 0 and less than 1") };

    return model_options(r, 0, LENGTH(o), o)
           && (!o[1].seen || p->steps > 1
               || model_blame(r, "a tolerance of one step, expected `steps N` with more: it "
                                 "compares a step with all steps"));
}

static int read_dynamic(model_reader *r)
{
    bbm_parameters *p = &r->p->m->par;
    double *factor = &p->velocity_factor;
    model_option o[] = { ABOVE_ZERO("dt", &p->dt), COUNT("steps", &p->steps, 1),
                         RANGE("velocity_factor", factor, 0, 1, "[]", "0 to 1"),
                         RANGE("damping", factor, 0, 1, "[]", "0 to 1"),     /* the same */
                         COUNT("settle", &r->p->settle, 0), FROM_ZERO("ramp", &r->p->ramp) };

    *factor = 1;
    r->p->dynamic = 1;
    const int good = model_options(r, 2, LENGTH(o), o);
    return good && (!o[2].seen || !o[3].seen
                    || model_blame(r, "velocity_factor and damping, which are the same, expected "
                                   "one"));
}

/* Two blocks become one body; or the options of all bonds. */
static int read_bond(model_reader *r)
{
    bbm_beyond *b = r->p->m->beyond;
    model_bond two = { .at = r->s->at };
    int kind = 2;
    model_option o[] = { ABOVE_ZERO("alpha", &r->p->m->par.alpha),
                         COUNT("augment", &b->multiplier_rounds, 0),
                         CHOICE("at", &kind, "vertices|moment|auto"),
                         ABOVE_ZERO("tension", &b->bond_tension),
                         ABOVE_ZERO("cohesion", &b->bond_cohesion),
                         ANGLE("friction", &b->bond_friction),
                         FROM_ZERO("energy", &b->bond_energy) };

    if (model_look(r) && model_find(&r->block_of, model_look(r)) >= 0) {
        for (int k = 0; k < 2; k++)
            two.block[k] = model_known(r, &r->block_of);
        if (two.block[0] == two.block[1])
            return model_blame(r, "bond of a block with itself, expected two blocks");
        return model_add(r, &r->bond, &r->bonds, sizeof two, &two);
    }
    if (r->bonding++)
        return model_blame(r, "%s for the second time, expected its options once", r->s->name);
    const int good = model_options(r, 0, LENGTH(o), o);
    if (good && (b->bond_tension > 0) != (b->bond_cohesion > 0))
        return model_blame(r, "bonds break by tension and by shear, expected tension and cohesion");
    if (good && b->bond_tension == 0 && (b->bond_friction > 0 || b->bond_energy > 0))
        return model_blame(r, "friction and energy of bonds that do not break, expected tension "
                           "and cohesion");
    b->bonding = kind == 0 ? BBM_VERTICES : BBM_MOMENT;
    return good;
}

static int read_pcg(model_reader *r)
{
    bbm_pcg *p = &r->p->m->par.pcg;
    int coarse = 0;
    model_option o[] = { RANGE("omega", &p->omega, 0, 2, "()", "more than 0 and less than 2"),
                         RANGE("tolerance", &p->tolerance, 0, 1e-6, "(]",
                               "more than 0, at most 1e-6"),
                         COUNT("iterations", &p->iterations, 1),
                         CHOICE("coarse", &coarse, "on|off") };
    const int good = model_options(r, 0, LENGTH(o), o);
    p->method = coarse == 0 ? &bbm_two_level : NULL;
    return good;
}

static int read_rotation(model_reader *r)
{
    int kind;
    const int good = model_choice(r, "exact|linear", &kind);

    r->p->m->beyond->rotation = kind == 0 ? BBM_EXACT : BBM_LINEAR;
    return good;
}

static int read_output(model_reader *r)
{
    const char *names = "";
    int chosen = (int)(field_find(r->p->field) - field_table);
    double *c = r->p->colours;

    for (const field *f = field_table; f->name && names; f++)
        names = model_print(r, "%s%s%s", names, *names ? "|" : "", f->name);
    model_option o[] = { COUNT("every", &r->p->every, 1), { .name = "vtk", .flag = &r->p->vtk },
                   { .name = "balance", .flag = &r->p->balance },
                   { .name = "svg", .flag = &r->p->svg }, ABOVE_ZERO("scale", &r->p->scale),
                   { .name = "film", .flag = &r->p->film },
                   CHOICE("field", &chosen, names), NUMBER("low", &c[0]), NUMBER("high", &c[1]) };

    const int good = model_options(r, 0, LENGTH(o), o);
    r->p->svg |= r->p->film;
    r->p->field = field_table[chosen].name;
    if (r->p->film && !r->p->dynamic)
        model_note(r, "warning: statics has no film");
    return (good && (c[0] < c[1] || (c[0] == 0 && c[1] == 0)))
           || model_blame(r, "colours from %g to %g, expected low below high", c[0], c[1]);
}

/* ------------------------------------------------------------------- statements that need nodes */

static int read_element(model_reader *r)
{
    model_element e = { .id = model_id(r), .at = r->s->at };
    const char *block = e.id ? model_name(r) : NULL;

    if (!block || (e.material = model_known(r, &r->material_of)) < 0)
        return 0;
    e.n = r->s->n - r->next;
    if (e.n < 3)
        return model_fail(r, e.at, "element %.60s has %d nodes, expected 3 or more", e.id, e.n);
    e.block = model_find_block(r, block);
    for (int k = 0; k < e.n; k++)
        model_add_corner(r, model_known(r, &r->node_of));
    return !r->p->status && model_add_element(r, &e);
}

/* ----------------------------------------------------- blocks and grids with nodes of their own */

/* The id behind the last one of nodes or elements, kept as text. */
static const char *next_id(model_reader *r, long long *last)
{
    if (*last >= MOST_NUMBERED)
        return model_blame(r, "an id of 18 digits or more, expected at most 17 where blocks are "
                           "numbered on"), NULL;
    return model_print(r, "%lld", ++*last);
}

static int add_own_node(model_reader *r, double x, double y)
{
    const model_node n = { .id = next_id(r, &r->last_node), .x = x, .y = y, .at = r->s->at,
                           .by_hand = 1, .first = -1 };

    return n.id && model_add_node(r, &n);
}

static int add_own_element(model_reader *r, int block, int material, int n)
{
    const model_element e = { next_id(r, &r->last_element), r->s->at, block, material, 0, n };

    return e.id && model_add_element(r, &e);
}

/* NAME MATERIAL of a new block; its number, or -1. */
static int new_block(model_reader *r, const char **word, int *material)
{
    *word = model_new_name(r, &r->block_of);
    *material = model_known(r, &r->material_of);
    return *material < 0 ? -1 : model_find_block(r, *word);
}

static int read_block(model_reader *r)
{
    const char *word;
    double xy[2];
    int material;
    const int block = new_block(r, &word, &material), words = r->s->n - r->next;

    if (block < 0)
        return 0;
    for (int k = 0; k < words; k++)
        if (model_number(r, &xy[k % 2]) && k % 2 && add_own_node(r, xy[0], xy[1]))
            model_add_corner(r, r->nodes - 1);
    if (words < 6 || words % 2)
        return model_blame(r, "block '%.60s' has %d coordinates, expected X Y of 3 corners or "
                           "more", word, words);
    return !r->p->status && add_own_element(r, block, material, words / 2);
}

/* The nodes from `first` on, `step` apart, as the set NAME.side. */
static int add_rim(model_reader *r, const char *block, const char *side, int first, int step, int n)
{
    const char *word = model_print(r, "%s.%s", block, side);

    if (!word || !model_is_new(r, r->s->at, &r->set_of, word))
        return 0;
    const int set = model_find_set(r, word);
    for (int k = 0; k < n && !r->p->status; k++)
        model_add_to_set(r, set, first + k * step);
    return !r->p->status;
}

static int read_grid(model_reader *r)
{
    double p[4];
    int material, n[2], kind = CELL_QUADS, element[4][4], corners;
    const char *word;
    const int block = new_block(r, &word, &material), first = r->nodes;

    if (block < 0 || !model_numbers(r, 4, p) || !model_whole(r, "NX", 1, &n[0])
        || !model_whole(r, "NY", 1, &n[1])
        || (model_look(r) && !model_choice(r, "quads|triangles|crossed", &kind)))
        return 0;
    if (!(p[0] < p[2] && p[1] < p[3]))
        return model_blame(r, "a grid from %.9g %.9g to %.9g %.9g, expected X0 < X1 and Y0 < Y1",
                           p[0], p[1], p[2], p[3]);
    if ((double)n[0] * n[1] > MOST_CELLS)
        return model_blame(r, "a grid of %d x %d cells, expected at most %d", n[0], n[1],
                           MOST_CELLS);
    for (int k = 0; k < (n[0] + 1) * (n[1] + 1) && !r->p->status; k++) {
        const double s = (double)(k % (n[0] + 1)) / n[0], t = (double)(k / (n[0] + 1)) / n[1];
        add_own_node(r, (1 - s) * p[0] + s * p[2], (1 - t) * p[1] + t * p[3]);
    }
    for (int k = 0; k < n[0] * n[1] && !r->p->status; k++) {
        const int a = first + k / n[0] * (n[0] + 1) + k % n[0], d = a + n[0] + 1;
        const int corner[5] = { a, a + 1, d + 1, d, r->nodes };
        if (kind == CELL_CROSSED)
            add_own_node(r, (r->node[a].x + r->node[d + 1].x) / 2,
                         (r->node[a].y + r->node[d + 1].y) / 2);
        const int cells = cell_cut(kind, (k / n[0] + k % n[0]) % 2, corner, element, &corners);
        for (int c = 0; c < cells; c++) {
            for (int i = 0; i < corners; i++)
                model_add_corner(r, element[c][i]);
            add_own_element(r, block, material, corners);
        }
    }
    return add_rim(r, word, "left", first, n[0] + 1, n[1] + 1)
        && add_rim(r, word, "right", first + n[0], n[0] + 1, n[1] + 1)
        && add_rim(r, word, "bottom", first, 1, n[0] + 1)
        && add_rim(r, word, "top", first + n[1] * (n[0] + 1), 1, n[0] + 1);
}

/* --------------------------------------------------------------- statements that need all nodes */

static int read_set(model_reader *r)
{
    const char *word = model_name(r);

    if (!word || (!model_skip(r, "add") && !(model_is_new(r, r->s->at, &r->set_of, word)
                                             && model_is_new(r, r->s->at, &r->block_of, word)
                                             && model_keyword(r, "nodes"))))
        return 0;
    const int set = model_find_set(r, word);
    do
        model_add_to_set(r, set, model_known(r, &r->node_of));
    while (model_look(r));
    return !r->p->status;
}

/* A block of the mesh gets the material; `*`: every one that has none of its own. */
static int read_use(model_reader *r)
{
    const int material = model_known(r, &r->material_of);

    model_keyword(r, "on");
    const int block = model_block_or_all(r);
    model_block *b = block < 0 ? &r->any : &r->block[block];
    if (!b->meshed)
        return model_blame(r, "block '%.60s' has its material in its own statement, expected a "
                           "block of a mesh", b->name);
    if (b->material >= 0)
        return model_blame(r, "a material for '%.60s' for the second time, expected one", b->name);
    b->material = material;
    return 1;
}

static int read_fixblock(model_reader *r)
{
    const int block = model_known(r, &r->block_of);

    return block >= 0 && (r->block[block].fixed++ == 0
                          || model_blame(r, "block '%.60s' is fixed for the second time, expected "
                                         "once", r->block[block].name));
}

/* ------------------------------------------------------------------------- what should come out */

static int read_expect(model_reader *r)
{
    model *p = r->p;
    model_expected e = { .monitor = model_known(r, &r->monitor_of) };

    if (e.monitor < 0 || !model_choice(r, p->monitor[e.monitor].of->kinds, &e.kind))
        return 0;
    const int value = e.kind < p->monitor[e.monitor].of->values;
    r->ahead -= !value;
    if ((value && !model_number(r, &e.value)) || !model_keyword(r, value ? "within" : "by"))
        return 0;
    const char *last = model_look(r);
    const size_t n = last ? strlen(last) : 0;
    const int percent = value && n > 1 && last[n - 1] == '%';
    if (percent)                                /* the word may stand in other rounds, too */
        r->word[r->s->first + r->next].text = model_print(r, "%.*s", (int)n - 1, last);
    if (!model_number(r, &e.within))
        return 0;
    if (e.within <= 0)
        return model_blame(r, "a tolerance of %g, expected more than 0", e.within);
    if (value && (percent || model_skip(r, "%")) && (e.within *= fabs(e.value) / 100) <= 0)
        return model_blame(r, "a tolerance in %% of 0, expected one in %s",
                           p->monitor[e.monitor].of == &model_displacement ? "metre" : "newton");
    return model_add(r, &p->expected, &p->expectations, sizeof e, &e);
}

/* ------------------------------------------------------------------------------------ the table */

static const struct kind {
    const char *form;                           /* its name first */
    model_action *read;
    int phase, may;
} kinds[] = {
    { "let NAME VALUE", NULL, NUMBERS, STAGED },
    { "repeat NAME FROM TO, statements, end", NULL, NUMBERS, STAGED },
    { "stage NAME [steps N] [remove BLOCK ...], statements, end", model_stage_head, ALONE, STAGED },
    { "end", NULL, NUMBERS, STAGED },
    { "title TEXT", read_title, ALONE, ONCE },
    { "node ID X Y", read_node, ALONE, 0 },
    { "mesh FILE.msh [by surface]", read_mesh, ALONE, 0 },
    { "material NAME E VALUE nu VALUE density VALUE [thickness VALUE]", read_material, ALONE, 0 },
    { "plane stress|strain", read_plane, ALONE, ONCE },
    { "gravity GX GY", read_gravity, ALONE, ONCE | STAGED },
    { "shake AX AY OMEGA, or shake FILE [scale S]", read_shake, NODES, ONCE | DYNAMIC },
    { "contact [kn VALUE] [ks VALUE] [friction DEGREES] [cohesion PASCAL] [tension PASCAL] "
      "[restitution E] [round LENGTH]", read_contact, ALONE, ONCE | STAGED },
    { "static [steps N] [tolerance VALUE]", read_static, ALONE, ONCE },
    { "dynamic dt VALUE steps N [velocity_factor VALUE] [settle N] [ramp T]", read_dynamic, ALONE,
      ONCE },
    { "bond [alpha VALUE] [augment N] [at vertices|moment|auto] [tension PASCAL cohesion PASCAL "
      "[friction DEGREES] [energy VALUE]], or bond BLOCK BLOCK", read_bond, BLOCKS, 0 },
    { "pcg [omega VALUE] [tolerance VALUE] [iterations N] [coarse on|off]", read_pcg, ALONE, ONCE },
    { "rotation exact|linear", read_rotation, ALONE, ONCE },
    { "output [every N] [vtk] [balance] [svg] [film] [field NAME] [scale N] [low VALUE] "
      "[high VALUE]", read_output, NODES, ONCE },
    { "element ID BLOCK MATERIAL N1 N2 N3 [N4 ...]", read_element, NODES, 0 },
    { "block NAME MATERIAL X1 Y1 X2 Y2 X3 Y3 [X4 Y4 ...]", read_block, MADE, 0 },
    { "grid NAME MATERIAL X0 Y0 X1 Y1 NX NY [quads|triangles|crossed]", read_grid, MADE, 0 },
    { "set NAME nodes|add ID ID ...", read_set, ALL_NODES, 0 },
    { "use MATERIAL on BLOCK", read_use, BLOCKS, 0 },
    { "fixblock BLOCK", read_fixblock, BLOCKS, 0 },
    { "joint BLOCK BLOCK [friction DEGREES] [cohesion PASCAL] [tension PASCAL]", model_joint,
      MODEL, 0 },
    { "fix WHERE [of BLOCK] [x [by U]] [y [by V]]", model_fix, MODEL, STAGED },
    { "load WHERE [of BLOCK] FX FY", model_load_nodes, MODEL, STAGED },
    { "traction WHERE [of BLOCK] TX TY", model_edge_load, MODEL, STAGED },
    { "pressure WHERE [of BLOCK] P", model_edge_load, MODEL, STAGED },
    { "water WHERE [of BLOCK] LEVEL [density VALUE]", model_edge_load, MODEL, 0 },
    { "bolt WHERE WHERE stiffness VALUE [strength VALUE] [pretension VALUE]", model_bolts, MODEL,
      0 },
    { "pin BLOCK BLOCK at X Y", model_pins, MODEL, 0 },
    { "bodyforce BLOCK FX FY", model_bodyforce, MODEL, 0 },
    { "velocity BLOCK VX VY [SPIN]", model_velocities, MODEL, DYNAMIC },
    { "stress BLOCK SXX SYY SXY [gradient SXX SYY SXY]", model_stress, MODEL, 0 },
    { "monitor NAME [support] WHERE [of BLOCK], or monitor NAME joint BLOCK BLOCK [WHERE], or "
      "monitor NAME bolt N", model_monitors, MONITORS, 0 },
    { "expect NAME u|v|normal|shear|fx|fy|force VALUE within TOLERANCE [%], or expect NAME "
      "moves|stays by TOLERANCE", read_expect, EXPECTED, 0 },
};

/* The row of the statement; LENGTH(kinds): there is none. */
static int find_kind(const char *word)
{
    int k = 0;

    while (k < LENGTH(kinds) && model_find_word(kinds[k].form, word) != kinds[k].form)
        k++;
    return k;
}

/* What may be meant: what other programs have in its place, or a word of these statements. */
static int blame_statement(model_reader *r, const char *word, const char *next, model_place at)
{
    static const struct { const char *words, *here; } other[] = {
        { "anchor cable rockbolt spring", "bolt" }, { "for loop while do", "repeat" },
        { "accelerogram earthquake pulse ricker", "shake, which reads a record" },
        { "if else", "min, max and floor of $(...)" }, { "polygon body", "block, grid" },
        { "support boundary fixed", "fix, fixblock" }, { "plot print history", "monitor, output" },
        { "time step solve run damping", "static, dynamic" }, { "excavate", "stage" },
        { "var define", "let" }, { "force", "load" },
    };
    char see[200] = "";

    if (strchr(word, '=') || *next == '=')
        return model_fail(r, at, "there is no statement '%.60s'; a number has its name by: let "
                          "NAME VALUE", word);
    for (int k = 0; k < LENGTH(other); k++)
        if (model_find_word(other[k].words, word))
            snprintf(see, sizeof see, ", %s", other[k].here);
    for (int k = 0; k < LENGTH(kinds); k++)
        if (model_find_word(kinds[k].form, word))
            snprintf(see + strlen(see), sizeof see - strlen(see), ", %.*s",
                     (int)strcspn(kinds[k].form, " "), kinds[k].form);
    if (*see)
        return model_fail(r, at, "there is no statement '%.60s'; see %s", word, see + 2);
    const char *near = model_nearest(r, word, kinds, LENGTH(kinds), sizeof *kinds, 2);
    return model_fail(r, at, "there is no statement '%.60s'; %s%s%sall are in doc/model-file.md%s",
                      word, *near ? "nearest: " : "", near, *near ? "; " : "", model_hint(word));
}

/* Finds the statement that begins with the word; whether there is one. next: what follows. */
static int begin_statement(model_reader *r, const char *word, const char *next, model_place at)
{
    const int k = find_kind(word);

    if (k == LENGTH(kinds))
        return blame_statement(r, word, next, at);
    const model_statement s = { at, r->cut_words, 0, k, 0, word, kinds[k].form };
    return model_add(r, &r->cut, &r->cuts, sizeof s, &s);
}

/* The end of a word: a blank that is not between the parentheses of $(...). */
static char *find_word_end(char *word, const char *blanks)
{
    int open = 0;

    for (; *word && (open || !strchr(blanks, *word)); word++) {
        open += *word == '$' && word[1] == '(' ? word++, 1 : open && *word == '(';
        open -= open && *word == ')';
    }
    return word;
}

/* One line without its end: the statement and its words. The text of a title is one word. */
static int cut_line(model_reader *r, char *line, model_place at)
{
    static const char blanks[] = " \t\r\f\v";

    line[strcspn(line, "#")] = '\0';
    for (int k = 0; *(line += strspn(line, blanks)) != '\0'; k++) {
        char *end = find_word_end(line, blanks);
        if (k == 1 && kinds[r->cut[r->cuts - 1].kind].read == read_title)
            for (end = line + strlen(line); strchr(blanks, end[-1]); )
                end--;
        const int more = *end != '\0';
        *end = '\0';
        if (k == 0 ? !begin_statement(r, line, end + more + strspn(end + more, blanks), at)
                   : !model_add(r, &r->cut_word, &r->cut_words, sizeof line, &line))
            return 0;
        r->cut[r->cuts - 1].n = k;
        line = end + more;
    }
    return 1;
}

static int cut_file(model_reader *r, char *text, size_t size)
{
    char *end = text + size;
    model_place at = { r->whole.file, 1, NULL };

    if (size >= 3 && memcmp(text, "\xef\xbb\xbf", 3) == 0)     /* UTF-8's mark of some editors */
        text += 3;
    for (char *next; text < end && !r->p->status; text = next, at.line++) {
        char *stop = text + strcspn(text, "\n");
        if (*stop == '\0' && stop < end)
            return model_fail(r, at, "a zero byte: the file is binary, expected text");
        *stop = '\0';
        next = stop + 1;
        cut_line(r, text, at);
    }
    return !r->p->status;
}

/* The statements of a stage stand together, from its head on. */
static int read_phase(model_reader *r, int phase, int stage, int from)
{
    for (int k = from; k < r->statements && !r->p->status; k++) {
        r->s = &r->statement[k];
        r->next = r->ahead = 0;
        const struct kind *kind = &kinds[r->s->kind];
        if (stage && r->s->stage > stage)
            break;
        if (kind->phase != phase || r->s->stage != stage)
            continue;
        if (kind->may & DYNAMIC && !r->p->dynamic)
            return model_blame(r, "%s in statics, expected dynamic", r->s->name);
        if (kind->read(r))
            model_at_end(r);
    }
    return !r->p->status;
}

/* Some kinds stand in a stage, some once in it, and one of static and dynamic. */
static int check_places(model_reader *r)
{
    const model_statement *seen[LENGTH(kinds)] = { NULL };      /* the last one of a kind */

    for (int k = 0; k < r->statements; k++) {
        const model_statement *i = &r->statement[k], *before = seen[i->kind];
        const int may = kinds[i->kind].may;
        if (i->stage && !(may & STAGED))
            return model_fail(r, i->at, "%s in a stage, expected load, traction, pressure, fix, "
                              "contact or gravity", i->name);
        if (may & ONCE && before && before->stage == i->stage)
            return model_fail(r, i->at, "%s for the second time, after line %d, expected it once",
                              i->name, before->at.line);
        seen[i->kind] = i;
    }
    const model_statement *s = seen[find_kind("static")], *d = seen[find_kind("dynamic")];
    if (s && d)
        return model_fail(r, s > d ? s->at : d->at, "static and dynamic, expected one of them");
    return s || d
           || model_fail(r, r->whole, "%sneither static nor dynamic, expected one of them, such "
                         "as: static, or: dynamic dt 1e-3 steps 1000",
                         r->statements ? "" : "the file has no statement, ");
}

/* Each stage begins with what the one before it has, and is kept until the run comes to it. */
static int read_all(model_reader *r)
{
    model *p = r->p;
    size_t size;
    char *text = model_load(r, r->whole.file, &size);

    if (!text || !cut_file(r, text, size) || !model_expand(r) || !check_places(r))
        return 0;
    p->stage = model_keep(r, p->stages, sizeof *p->stage);
    for (int stage = 0, from = 0; stage <= p->stages && !p->status; stage++) {
        while (r->statement[from].stage < stage)
            from++;
        for (int phase = NUMBERS + 1; phase < PHASES; phase++)
            if ((phase == MODEL && stage == 0 && !model_build(r))
                || !read_phase(r, phase, stage, from))
                return 0;
        model_keep_stage(r, stage);
    }
    if (p->status)
        return 0;
    model_next_stage(p);
    r->s = r->light;
    if (r->light && (p->m->par.gravity[0] != 0 || p->m->par.gravity[1] != 0))
        model_note(r, "warning: a density below 10 kg/m^3 under gravity; is it in kg/m^3?");
    return model_finish(r);
}

int model_read(const char *path, int lets, char *const let[], model *p)
{
    model_reader r = {
        .p = p, .whole = { path, 0, NULL }, .lets = lets, .let = let,
        .any = { .name = "*", .material = -1, .meshed = 1 }, .node_of.what = "node",
        .element_of.what = "element", .block_of.what = "block", .material_of.what = "material",
        .set_of.what = "set", .monitor_of.what = "monitor", .let_of.what = "let",
        .stage_of.what = "stage",
    };

    *p = (model){ .field = "mises", .ramp = INFINITY, .now = -1 };
    if (bbm_beyond_new(&p->m))
        return model_out_of_memory(&r), p->status;
    p->m->par.p_n = p->m->par.p_s = p->m->par.friction = -1;        /* not given */
    p->m->par.alpha = p->m->beyond->multiplier_rounds = -1;
    read_all(&r);
    return p->status;
}

