/* model.c - the reader of model files. The statements stand in a table near the end, each with its form, the function
 * that carries it out and the phase in which it does: a file may have them in any order.
 *
 *     NOTHING NEEDED   title, node, mesh, material, and all that goes into the parameters
 *     NODES            element, set               need nodes and materials
 *     BLOCKS           use, fixblock              need blocks
 *     MODEL            the rest, on the library's model, which is built and prepared before
 *
 * Every function of a statement takes its words one by one from the reader (next_word, number, whole, options, where)
 * and returns 1, or 0 after model_fail. Words are never copied: names and ids point into the text of the file.
 */
#include <ctype.h>
#include <errno.h>
#include <limits.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "model.h"

/* Of the model's size: nodes closer to a given place, or to the rim of a box, are there. */
#define NEAR 1e-6

enum { LARGEST = 1 << 28 };             /* bytes of a file: a longer one, or one without end, is no model */

enum { NOTHING_NEEDED, NODES, BLOCKS, MODEL, PHASES };

/* ------------------------------------------------------------------------------------- errors, memory, words */

int model_fail(model_reader *r, model_place at, const char *format, ...)
{
    char *message = r->p->message;
    const int room = (int)sizeof r->p->message;
    va_list args;

    if (r->p->status)
        return 0;
    r->p->status = 2;
    int used = at.line > 0 ? snprintf(message, (size_t)room, "%.200s:%d: ", at.file, at.line)
                           : snprintf(message, (size_t)room, "%.200s: ", at.file);
    va_start(args, format);
    vsnprintf(message + used, (size_t)(room - used), format, args);
    va_end(args);
    for (char *c = message; *c; c++)
        if (iscntrl((unsigned char)*c))
            *c = '?';
    return 0;
}

static int out_of_memory(model_reader *r)
{
    model_fail(r, (model_place){ r->path, 0 }, "out of memory");
    r->p->status = 1;
    return 0;
}

/* What the library refuses, and no line is to blame for. */
static int refused(model_reader *r, bbm_status status)
{
    if (status == BBM_NO_MEMORY)
        return out_of_memory(r);
    return model_fail(r, (model_place){ r->path, 0 }, "%.400s",
                      *bbm_message(r->p->m) ? bbm_message(r->p->m) : bbm_status_text(status));
}

/* The room is a power of two, 16 at least: when the count has reached it, it is doubled. */
int model_grow(model_reader *r, void *array, int count, size_t size)
{
    void **a = array, *more;

    if (count != 0 && (count < 16 || (count & (count - 1)) != 0))
        return 1;
    more = count > INT_MAX / 4 ? NULL : realloc(*a, (count == 0 ? 16 : 2 * (size_t)count) * size);
    if (!more)
        return out_of_memory(r);
    *a = more;
    return 1;
}

static void *make_room(model_reader *r, int count, size_t size)
{
    void *p = calloc((size_t)count + 1, size);

    if (!p)
        out_of_memory(r);
    return p;
}

/* The place of a key in the table, or the empty one where it belongs; FNV-1a. */
static int place_of(const model_table *t, const char *key)
{
    unsigned hash = 2166136261u;

    for (const char *c = key; *c; c++)
        hash = (hash ^ (unsigned char)*c) * 16777619u;
    int i = (int)(hash & (unsigned)(t->room - 1));
    while (t->key[i] && strcmp(t->key[i], key) != 0)
        i = (i + 1) & (t->room - 1);
    return i;
}

int model_find(const model_table *t, const char *key)
{
    const int i = t->room ? place_of(t, key) : 0;

    return t->room && t->key[i] ? t->value[i] : -1;
}

int model_enter(model_reader *r, model_table *t, const char *key, int value)
{
    if (2 * t->count >= t->room) {
        const int room = t->room ? 2 * t->room : 64;
        model_table larger = { room, t->count, make_room(r, room, sizeof(int)), make_room(r, room, sizeof(char *)) };
        for (int k = 0; k < t->room && larger.value && larger.key; k++)
            if (t->key[k]) {
                const int to = place_of(&larger, t->key[k]);
                larger.key[to] = t->key[k];
                larger.value[to] = t->value[k];
            }
        model_table *old = larger.value && larger.key ? t : &larger;
        free(old->value);
        free((void *)old->key);
        if (old == &larger)
            return 0;
        *t = larger;
    }
    const int i = place_of(t, key);
    t->count += t->key[i] == NULL;
    t->key[i] = key;
    t->value[i] = value;
    return 1;
}

/* The whole file as a text with a 0 behind it, kept until model_free; NULL after an error. */
char *model_load(model_reader *r, const char *path, model_place at, size_t *size)
{
    model *p = r->p;
    FILE *f = fopen(path, "rb");
    size_t room = 65536, got = 1;
    char *text = f ? malloc(room) : NULL;

    *size = 0;
    while (text && got > 0 && *size < LARGEST - 1) {
        got = fread(text + *size, 1, room - 1 - *size, f);
        *size += got;
        if (*size == room - 1 && room < LARGEST) {
            char *more = realloc(text, room *= 2);
            if (!more)
                free(text);
            text = more;
        }
    }
    const int bad = !f || ferror(f), why = errno;
    if (bad)
        model_fail(r, at, "%.200s cannot be read: %s", path, strerror(why));
    else if (*size == LARGEST - 1)
        model_fail(r, at, "%.200s is longer than %d bytes, expected a text", path, LARGEST);
    else if (!text || !model_grow(r, &p->text, p->texts, sizeof *p->text))
        out_of_memory(r);
    if (f)
        fclose(f);
    if (p->status) {
        free(text);
        return NULL;
    }
    text[*size] = '\0';
    return p->text[p->texts++] = text;
}

int model_is_name(const char *word)
{
    return *word && word[strspn(word, "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-.")] == '\0';
}

static const char *form_of(const model_statement *s);

static int wrong(model_reader *r, const char *what, const char *word)
{
    return model_fail(r, r->s->at, "%s '%.60s', expected: %s", what, word, form_of(r->s));
}

/* The word that comes next stays; NULL at the end. */
static char *look(const model_reader *r)
{
    return r->next < r->s->n ? r->word[r->s->first + r->next] : NULL;
}

static char *next_word(model_reader *r)
{
    char *word = look(r);

    if (word)
        r->next++;
    else
        model_fail(r, r->s->at, "a word is missing, expected: %s", form_of(r->s));
    return word;
}

/* Takes the next word if it is this one. */
static int skip(model_reader *r, const char *word)
{
    const int there = look(r) && strcmp(look(r), word) == 0;

    r->next += there;
    return there;
}

static int at_end(model_reader *r)
{
    return look(r) ? wrong(r, "surplus word", look(r)) : 1;
}

static int number(model_reader *r, double *x)
{
    char *word = next_word(r), *end;

    if (!word)
        return 0;
    *x = strtod(word, &end);
    if (*word == '\0' || *end != '\0' || strpbrk(word, "xXpP"))
        return wrong(r, "not a number:", word);
    if (!isfinite(*x))
        return wrong(r, "not a finite number:", word);
    return 1;
}

static int whole(model_reader *r, const char *what, int least, int *n)
{
    char *word = next_word(r), *end;

    if (!word)
        return 0;
    errno = 0;
    const long value = strtol(word, &end, 10);
    if (*end != '\0' || end == word)
        return wrong(r, "not a whole number:", word);
    if (value < least)
        return model_fail(r, r->s->at, "%s is %ld, expected a whole number, %d or more", what, value, least);
    if (errno || value > INT_MAX / 2)
        return wrong(r, "too large:", word);
    *n = (int)value;
    return 1;
}

static const char *name(model_reader *r)
{
    const char *word = next_word(r);

    if (word && !model_is_name(word))
        return wrong(r, "not a name (letters, digits, _ - .):", word), NULL;
    return word;
}

/* An id is a whole number; zeros before it do not count. */
static const char *id(model_reader *r)
{
    const char *word = next_word(r);

    if (word && word[strspn(word, "0123456789")] != '\0')
        return wrong(r, "an id is a whole number, not", word), NULL;
    while (word && word[0] == '0' && word[1] != '\0')
        word++;
    return word;
}

/* The number that a word stands for in a table; -1 after an error. */
static int known(model_reader *r, const model_table *t, const char *what, const char *word)
{
    const int found = word ? model_find(t, word) : -1;

    if (word && found < 0)
        model_fail(r, r->s->at, "unknown %s '%.60s', expected one that the model has", what, word);
    return found;
}

static int is_new(model_reader *r, const model_table *t, const char *what, const char *word)
{
    if (model_find(t, word) >= 0)
        return model_fail(r, r->s->at, "%s '%.60s' for the second time, expected a new one", what, word);
    return 1;
}

/* ------------------------------------------------------------------------------------------------- options */

/* `word value`, in any order, each once. One of: a number (low to high, with the rims of `rim`), a whole number, a
 * choice (its place in the list), a flag without a value. */
typedef struct {
    const char *name;
    double *x, low, high;
    const char *rim, *expected;     /* rim: [] both in, () both out, and so on                                      */
    int    *n, least;
    const char *choices;            /* "a|b|c"                                                                      */
    int    *flag;
    int    needed, seen;
} option;

static int choice(model_reader *r, const char *choices, int *n)
{
    const char *word = next_word(r);
    const size_t length = word ? strlen(word) : 0;

    *n = 0;
    for (const char *c = choices; word && c; c = strchr(c, '|'), *n += 1) {
        c += *c == '|';
        if (strncmp(c, word, length) == 0 && (c[length] == '|' || c[length] == '\0'))
            return 1;
    }
    return word ? model_fail(r, r->s->at, "'%.60s', expected one of %s", word, choices) : 0;
}

static int in_range(model_reader *r, const option *o)
{
    const double x = *o->x;
    const int good = (o->rim[0] == '[' ? x >= o->low : x > o->low) && (o->rim[1] == ']' ? x <= o->high : x < o->high);

    return good ? 1 : model_fail(r, r->s->at, "%s is %g, expected %s", o->name, x, o->expected);
}

static int option_value(model_reader *r, option *o)
{
    if (o->seen)
        return model_fail(r, r->s->at, "%s for the second time, expected: %s", o->name, form_of(r->s));
    o->seen = 1;
    if (o->flag)
        return *o->flag = 1;
    if (o->choices)
        return choice(r, o->choices, o->n);
    if (o->n)
        return whole(r, o->name, o->least, o->n);
    return number(r, o->x) && in_range(r, o);
}

static int options(model_reader *r, int n, option o[])
{
    while (look(r)) {
        int k = 0;
        while (k < n && !skip(r, o[k].name))
            k++;
        if (k == n)
            return wrong(r, "unknown option", look(r));
        if (!option_value(r, &o[k]))
            return 0;
    }
    for (int k = 0; k < n; k++)
        if (o[k].needed && !o[k].seen)
            return model_fail(r, r->s->at, "%s is missing, expected: %s", o[k].name, form_of(r->s));
    return 1;
}

#define ABOVE_ZERO(text, where) { .name = text, .x = where, .low = 0, .high = INFINITY, .rim = "()", \
                                  .expected = "more than 0" }
#define FROM_ZERO(text, where) { .name = text, .x = where, .low = 0, .high = INFINITY, .rim = "[)", \
                                 .expected = "0 or more" }
#define COUNT(t_text, t_where, t_least) { .name = t_text, .n = t_where, .least = t_least }
#define CHOICE(text, where, list) { .name = text, .n = where, .choices = list }
#define LENGTH(array) ((int)(sizeof array / sizeof *array))

/* ------------------------------------------------------------------------- statements that need nothing */

static int read_title(model_reader *r)
{
    r->p->title = next_word(r);
    return r->p->title != NULL;
}

int model_add_node(model_reader *r, const model_node *n)
{
    if (model_find(&r->node_of, n->id) >= 0)
        return model_fail(r, n->at, "node '%s' for the second time, expected a new one", n->id);
    if (!model_grow(r, &r->node, r->nodes, sizeof *n) || !model_enter(r, &r->node_of, n->id, r->nodes))
        return 0;
    r->node[r->nodes++] = *n;
    return 1;
}

static int read_node(model_reader *r)
{
    model_node n = { .id = id(r), .at = r->s->at, .by_hand = 1, .first = -1 };

    return n.id && number(r, &n.x) && number(r, &n.y) && at_end(r) && model_add_node(r, &n);
}

static int read_mesh(model_reader *r)
{
    const char *word = next_word(r), *slash = strrchr(r->path, '/');

    if (!word || !at_end(r))
        return 0;
    const size_t folder = slash && word[0] != '/' ? (size_t)(slash + 1 - r->path) : 0, length = strlen(word) + 1;
    if (!model_grow(r, &r->p->text, r->p->texts, sizeof *r->p->text))
        return 0;
    char *path = make_room(r, (int)(folder + length), 1);
    if (!path)
        return 0;
    memcpy(path, r->path, folder);
    memcpy(path + folder, word, length);
    r->p->text[r->p->texts++] = path;
    return model_read_mesh(r, path, r->s->at);
}

static int read_material(model_reader *r)
{
    const char *word = name(r);
    bbm_material m = { .thickness = 1 };
    option o[] = {
        ABOVE_ZERO("E", &m.E), ABOVE_ZERO("density", &m.density), ABOVE_ZERO("thickness", &m.thickness),
        { .name = "nu", .x = &m.nu, .low = -1, .high = 0.5, .rim = "()", .expected = "more than -1 and less than 0.5" },
    };

    o[0].needed = o[1].needed = o[3].needed = 1;
    if (!word || !is_new(r, &r->material_of, "material", word) || !options(r, LENGTH(o), o)
        || !model_grow(r, &r->material, r->materials, sizeof m) || !model_enter(r, &r->material_of, word, r->materials))
        return 0;
    r->material[r->materials++] = m;
    return 1;
}

static int read_gravity(model_reader *r)
{
    double *g = r->p->m->par.gravity;

    return number(r, &g[0]) && number(r, &g[1]) && at_end(r);
}

static int read_shake(model_reader *r)
{
    bbm_beyond *b = r->p->m->beyond;

    return number(r, &b->shake[0]) && number(r, &b->shake[1]) && number(r, &b->shake_omega) && at_end(r);
}

static int read_contact(model_reader *r)
{
    bbm_parameters *p = &r->p->m->par;
    option o[] = {
        FROM_ZERO("kn", &p->p_n), FROM_ZERO("ks", &p->p_s), FROM_ZERO("cohesion", &p->cohesion),
        FROM_ZERO("tension", &p->tension),
        { .name = "friction", .x = &p->friction, .low = 0, .high = 90, .rim = "[)",
          .expected = "0 to less than 90 degrees" },
    };

    return options(r, LENGTH(o), o);
}

static int read_static(model_reader *r)
{
    bbm_parameters *p = &r->p->m->par;
    option o[] = { COUNT("steps", &p->steps, 1), ABOVE_ZERO("tolerance", &p->tolerance) };

    p->steps = 1;
    return options(r, LENGTH(o), o);
}

static int read_dynamic(model_reader *r)
{
    bbm_parameters *p = &r->p->m->par;
    option o[] = {
        ABOVE_ZERO("dt", &p->dt), COUNT("steps", &p->steps, 1), COUNT("settle", &r->p->settle, 0),
        { .name = "damping", .x = &p->velocity_factor, .low = 0, .high = 1, .rim = "[]", .expected = "0 to 1" },
    };

    o[0].needed = o[1].needed = 1;
    p->velocity_factor = 1;
    r->p->dynamic = 1;
    return options(r, LENGTH(o), o);
}

static int read_bond(model_reader *r)
{
    static const bbm_bonding bonding[] = { BBM_VERTICES, BBM_MIDPOINTS, BBM_MOMENT, BBM_MOMENT };
    bbm_beyond *b = r->p->m->beyond;
    int kind = 3;
    option o[] = { ABOVE_ZERO("alpha", &r->p->m->par.alpha), COUNT("augment", &b->multiplier_rounds, 0),
                   CHOICE("at", &kind, "vertices|midpoints|moment|auto") };

    if (!options(r, LENGTH(o), o))
        return 0;
    b->bonding = bonding[kind];
    return 1;
}

static int read_pcg(model_reader *r)
{
    bbm_pcg *p = &r->p->m->par.pcg;
    int coarse = 0;
    option o[] = {
        { .name = "omega", .x = &p->omega, .low = 0, .high = 2, .rim = "()",
          .expected = "more than 0 and less than 2" },
        { .name = "tolerance", .x = &p->tolerance, .low = 0, .high = 1, .rim = "()",
          .expected = "more than 0 and less than 1" },
        COUNT("iterations", &p->iterations, 1), CHOICE("coarse", &coarse, "on|off"),
    };

    if (!options(r, LENGTH(o), o))
        return 0;
    p->method = coarse == 0 ? &bbm_two_level : &bbm_eisenstat;
    return 1;
}

static int read_rotation(model_reader *r)
{
    int kind;

    if (!choice(r, "exact|linear", &kind) || !at_end(r))
        return 0;
    r->p->m->beyond->rotation = kind == 0 ? BBM_EXACT : BBM_LINEAR;
    return 1;
}

static int read_output(model_reader *r)
{
    static const char *const fields[] = { "mises", "sxx", "syy", "sxy", "s1", "s2", "u", "v" };
    int field = 0;
    option o[] = { COUNT("every", &r->p->every, 1), { .name = "vtk", .flag = &r->p->vtk },
                   { .name = "svg", .flag = &r->p->svg }, ABOVE_ZERO("scale", &r->p->scale),
                   CHOICE("field", &field, "mises|sxx|syy|sxy|s1|s2|u|v") };

    if (!options(r, LENGTH(o), o))
        return 0;
    r->p->field = fields[field];
    return 1;
}

/* ------------------------------------------------------------------------------ statements that need nodes */

int model_find_block(model_reader *r, const char *word, model_place at)
{
    const int found = model_find(&r->block_of, word);

    if (found >= 0)
        return found;
    if (!model_grow(r, &r->block, r->blocks, sizeof *r->block) || !model_enter(r, &r->block_of, word, r->blocks))
        return -1;
    r->block[r->blocks] = (model_block){ .name = word, .at = at, .material = -1 };
    return r->blocks++;
}

int model_add_element(model_reader *r, const model_element *e, const int corner[])
{
    if (model_find(&r->element_of, e->id) >= 0)
        return model_fail(r, e->at, "element '%s' for the second time, expected a new one", e->id);
    if (!model_grow(r, &r->element, r->elements, sizeof *e) || !model_enter(r, &r->element_of, e->id, r->elements))
        return 0;
    r->element[r->elements] = *e;
    r->element[r->elements++].first = r->corners;
    for (int k = 0; k < e->n; k++) {
        if (!model_grow(r, &r->corner, r->corners, sizeof *corner))
            return 0;
        r->corner[r->corners++] = corner[k];
    }
    return 1;
}

static int read_element(model_reader *r)
{
    model_element e = { .id = id(r), .at = r->s->at };
    const char *block = e.id ? name(r) : NULL;

    if (!block || (e.material = known(r, &r->material_of, "material", next_word(r))) < 0)
        return 0;
    e.n = r->s->n - r->next;
    if (e.n < 3)
        return model_fail(r, e.at, "element %s has %d nodes, expected 3 or more", e.id, e.n);
    int *corner = make_room(r, e.n, sizeof *corner), good = corner && (e.block = model_find_block(r, block, e.at)) >= 0;
    for (int k = 0; k < e.n && good; k++)
        good = (corner[k] = known(r, &r->node_of, "node", id(r))) >= 0;
    good = good && model_add_element(r, &e, corner);
    free(corner);
    return good;
}

int model_find_set(model_reader *r, const char *word)
{
    const int found = model_find(&r->set_of, word);

    if (found >= 0)
        return found;
    if (!model_grow(r, &r->set, r->sets, sizeof *r->set) || !model_enter(r, &r->set_of, word, r->sets))
        return -1;
    r->set[r->sets] = (model_set){ 0, NULL, 0 };
    return r->sets++;
}

int model_add_to_set(model_reader *r, int set, int node)
{
    model_set *s = &r->set[set];

    if (!model_grow(r, &s->node, s->n, sizeof *s->node))
        return 0;
    s->node[s->n++] = node;
    return 1;
}

static int read_set(model_reader *r)
{
    const char *word = name(r);

    if (!word || !is_new(r, &r->set_of, "set", word))
        return 0;
    if (!skip(r, "nodes"))
        return look(r) ? wrong(r, "not the word nodes:", look(r)) : next_word(r) != NULL;
    const int set = model_find_set(r, word);
    for (int good = set >= 0, first = 1; first || look(r); first = 0) {
        const int node = good ? known(r, &r->node_of, "node", id(r)) : -1;
        if (node < 0 || !model_add_to_set(r, set, node))
            return 0;
    }
    return 1;
}

/* A block of the mesh gets the material; `*`: every one that has none of its own. */
static int read_use(model_reader *r)
{
    const int material = known(r, &r->material_of, "material", next_word(r));

    if (material < 0)
        return 0;
    if (!skip(r, "on"))
        return look(r) ? wrong(r, "not the word on:", look(r)) : next_word(r) != NULL;
    const char *word = next_word(r);
    const int star = word && strcmp(word, "*") == 0, block = star ? 0 : known(r, &r->block_of, "block", word);
    if (block < 0 || !at_end(r))
        return 0;
    if (!star && !r->block[block].meshed)
        return model_fail(r, r->s->at, "block '%s' has its material by `element`, expected a block of a mesh", word);
    int *m = star ? &r->other_material : &r->block[block].material;
    if (*m >= 0)
        return model_fail(r, r->s->at, "a material for '%s' for the second time, expected one", word);
    *m = material;
    return 1;
}

static int next_block(model_reader *r) { return known(r, &r->block_of, "block", next_word(r)); }

static int read_fixblock(model_reader *r)
{
    const int block = next_block(r);

    if (block < 0 || !at_end(r))
        return 0;
    if (r->block[block].fixed)
        return model_fail(r, r->s->at, "block '%s' is fixed for the second time, expected once", r->block[block].name);
    return r->block[block].fixed = 1;
}

/* -------------------------------------------------------------------------- building the library's model */

/* What the file leaves out: the contacts are as stiff as the softest material of a block that is not fixed, for a fixed
 * one is often given an E that only says "rigid". */
static void set_defaults(model_reader *r)
{
    bbm_parameters *p = &r->p->m->par;
    double softest[2] = { INFINITY, INFINITY };         /* of the blocks that are free, of all */

    for (int e = 0; e < r->elements; e++) {
        const bbm_material *m = &r->material[r->element[e].material];
        for (int k = r->block[r->element[e].block].fixed; k < 2; k++)
            softest[k] = fmin(softest[k], m->E * m->thickness);
    }
    r->p->slippery = r->blocks > 1 && p->p_n != 0 && p->p_s != 0 && p->friction < 0;
    p->friction = fmax(p->friction, 0);
    if (p->p_n < 0)
        p->p_n = 50 * softest[isinf(softest[0]) ? 1 : 0];
    if (p->p_s < 0)
        p->p_s = 0.4 * p->p_n;
    if (p->p_s == 0)                            /* a shear spring that carries nothing: no friction */
        p->friction = p->cohesion = 0;
    if (p->p_n == 0)                            /* no contact: springs that cannot be felt */
        p->p_n = 1e-200;
    if (p->p_s == 0)
        p->p_s = 0.4 * p->p_n;
}

static int give_materials(model_reader *r)
{
    for (int e = 0; e < r->elements; e++) {
        model_element *el = &r->element[e];
        const model_block *b = &r->block[el->block];
        if (el->material < 0)
            el->material = b->material >= 0 ? b->material : r->other_material;
        if (el->material < 0)
            return model_fail(r, b->at, "block '%s' has no material, expected: use MATERIAL on %s", b->name, b->name);
    }
    return 1;
}

/* Lists the blocks that meet at each node, in their order: each gets a node of its own. */
static int copy_nodes(model_reader *r)
{
    for (int e = 0; e < r->elements; e++)
        for (int k = r->element[e].first; k < r->element[e].first + r->element[e].n; k++) {
            int *link = &r->node[r->corner[k]].first;
            while (*link >= 0 && r->copy[*link].block != r->element[e].block)
                link = &r->copy[*link].next;
            if (*link >= 0)
                continue;
            *link = r->copies;
            if (!model_grow(r, &r->copy, r->copies, sizeof *r->copy))
                return 0;
            r->copy[r->copies++] = (model_copy){ -1, r->element[e].block, -1 };
        }
    return 1;
}

static int add_nodes(model_reader *r)
{
    model *p = r->p;

    p->node = make_room(r, r->copies, sizeof *p->node);
    p->node_block = make_room(r, r->copies, sizeof *p->node_block);
    for (int n = 0, now = 0; n < r->nodes && !p->status; n++) {
        model_node *a = &r->node[n];
        if (a->first < 0 && a->by_hand)
            return model_fail(r, a->at, "no element has node %s, expected one", a->id);
        a->copies = 0;
        for (int c = a->first; c >= 0; c = r->copy[c].next, now++, a->copies++) {
            r->copy[c].node = now;
            p->node[now] = a->id;
            p->node_block[now] = r->copy[c].block;
            if (bbm_add_node(p->m, a->x, a->y, NULL))
                return out_of_memory(r);
        }
    }
    return !p->status;
}

static int add_element(model_reader *r, const model_element *e)
{
    int *corner = &r->corner[e->first], index;

    for (int k = 0; k < e->n; k++) {
        int c = r->node[corner[k]].first;
        while (r->copy[c].block != e->block)
            c = r->copy[c].next;
        corner[k] = r->copy[c].node;
    }
    const bbm_status status = bbm_add_element(r->p->m, e->block, e->material, e->n, corner, &index);
    if (status == BBM_NO_MEMORY)
        return out_of_memory(r);
    if (status == BBM_SELF_CROSSING)
        return model_fail(r, e->at, "the boundary of element %s meets itself, expected a simple polygon", e->id);
    const bbm_element *b = status ? NULL : &r->p->m->element[index];
    if (!b || !(b->A > 0) || !isfinite(b->x * b->Sxx) || !isfinite(b->y * b->Syy))
        return model_fail(r, e->at, "element %s has no area, or one too large, expected a polygon", e->id);
    r->p->element[index] = e->id;
    r->p->centre[index][0] = b->x;
    r->p->centre[index][1] = b->y;
    return 1;
}

/* Box of the nodes in use: their copies are the nodes of the library. */
static void measure_box(model_reader *r)
{
    const bbm_model *m = r->p->m;

    r->low[0] = r->low[1] = INFINITY;
    r->high[0] = r->high[1] = -INFINITY;
    for (int n = 0; n < m->nodes; n++) {
        r->low[0] = fmin(r->low[0], m->node[n].x);
        r->low[1] = fmin(r->low[1], m->node[n].y);
        r->high[0] = fmax(r->high[0], m->node[n].x);
        r->high[1] = fmax(r->high[1], m->node[n].y);
    }
    r->margin = NEAR * hypot(r->high[0] - r->low[0], r->high[1] - r->low[1]);
}

/* Names the blocks and the elements that lie in each other. */
static int overlap(model_reader *r)
{
    const model *p = r->p;
    bbm_overlap o;

    if (bbm_find_overlap(p->m, &o))
        return out_of_memory(r);
    return model_fail(r, r->element[o.j].at, "element %s of block '%s' lies %g m deep in element %s of block '%s' at "
                      "%g %g, expected blocks that touch at most", p->element[o.j], r->block[r->element[o.j].block].name,
                      o.depth, p->element[o.i], r->block[r->element[o.i].block].name, o.x, o.y);
}

static int build(model_reader *r)
{
    model *p = r->p;

    if (r->elements == 0)
        return model_fail(r, (model_place){ r->path, 0 }, "the model has no element, expected: element ..., or mesh "
                          "FILE");
    if (!give_materials(r) || !copy_nodes(r) || !add_nodes(r))
        return 0;
    set_defaults(r);
    for (int k = 0; k < r->materials; k++)
        bbm_add_material(p->m, &r->material[k], NULL);
    p->element = make_room(r, r->elements, sizeof *p->element);
    p->centre = make_room(r, r->elements, sizeof *p->centre);
    for (int e = 0; e < r->elements && !p->status; e++)
        add_element(r, &r->element[e]);
    if (p->status)
        return 0;
    measure_box(r);
    const bbm_status status = bbm_prepare(p->m);
    const model_element *e = &r->element[status == BBM_OVERLAP ? p->m->blamed[0] : 0];
    if (status == BBM_OVERLAP)
        return model_fail(r, e->at, "element %s lies on another one of its block, expected elements side by side",
                          e->id);
    if (status)
        return status == BBM_BLOCKS_OVERLAP ? overlap(r) : refused(r, status);
    p->velocity = make_room(r, r->blocks, sizeof *p->velocity);
    r->chosen_node = make_room(r, r->nodes, sizeof *r->chosen_node);
    return !p->status;
}

/* ----------------------------------------------------------------------- statements that need the model */

static int choose(model_reader *r, int node)
{
    model_node *n = &r->node[node];
    const int mark = (int)(r->s - r->statement) + 1;

    if (n->copies > 0 && n->mark != mark)
        r->chosen_node[r->chosen++] = node;
    n->mark = mark;
    return 1;
}

static void choose_nearest(model_reader *r, double x, double y)
{
    double best = INFINITY;
    int found = -1;

    for (int n = 0; n < r->nodes; n++) {
        const double d = r->node[n].copies > 0 ? hypot(r->node[n].x - x, r->node[n].y - y) : INFINITY;
        if (d < best)
            best = d, found = n;
    }
    if (found >= 0)
        choose(r, found);
}

static int choose_box(model_reader *r, double box[4])
{
    for (int k = 0; k < 4; k++)
        if (!number(r, &box[k]))
            return 0;
    if (!(box[0] <= box[2] && box[1] <= box[3]))
        return model_fail(r, r->s->at, "a box from %g, %g to %g, %g, expected: box XMIN YMIN XMAX YMAX", box[0], box[1],
                          box[2], box[3]);
    for (int n = 0; n < r->nodes; n++) {
        const double x = r->node[n].x, y = r->node[n].y, d = r->margin;
        if (x >= box[0] - d && x <= box[2] + d && y >= box[1] - d && y <= box[3] + d)
            choose(r, n);
    }
    return 1;
}

static int choose_at(model_reader *r, double at[2], int nearest)
{
    if (!number(r, &at[0]) || !number(r, &at[1]))
        return 0;
    if (nearest)
        choose_nearest(r, at[0], at[1]);
    for (int n = 0; n < r->nodes && !nearest; n++)
        if (hypot(r->node[n].x - at[0], r->node[n].y - at[1]) <= r->margin)
            choose(r, n);
    return 1;
}

/* WHERE: the nodes that it names, at least one, in r->chosen_node. `nearest`: at X Y is the nearest node, however
 * far. */
static int where(model_reader *r, int nearest)
{
    double place[4];
    int good = 0, found;

    r->chosen = 0;
    if (skip(r, "node")) {
        good = (found = known(r, &r->node_of, "node", id(r))) >= 0 && choose(r, found);
    } else if (skip(r, "at")) {
        good = choose_at(r, place, nearest);
    } else if (skip(r, "set")) {
        good = (found = known(r, &r->set_of, "set", next_word(r))) >= 0;
        if (good && (r->set[found].dimensions & (r->set[found].dimensions - 1)))
            return model_fail(r, r->s->at, "the mesh has several groups of that name, one of surfaces and one of "
                              "curves or points, expected one");
        for (int k = 0; good && k < r->set[found].n; k++)
            choose(r, r->set[found].node[k]);
    } else if (skip(r, "box")) {
        good = choose_box(r, place);
    } else if (look(r)) {
        wrong(r, "unknown place", look(r));
    } else {
        next_word(r);
    }
    if (good && r->chosen == 0)
        return model_fail(r, r->s->at, "no node there, expected a place that names one");
    return good;
}

static int read_fix(model_reader *r)
{
    int x = 0, y = 0;
    option o[] = { { .name = "x", .flag = &x }, { .name = "y", .flag = &y } };

    if (!where(r, 0) || !options(r, LENGTH(o), o))
        return 0;
    const int directions = x || y ? (x ? BBM_X : 0) | (y ? BBM_Y : 0) : BBM_XY;
    for (int k = 0; k < r->chosen; k++)
        for (int c = r->node[r->chosen_node[k]].first; c >= 0; c = r->copy[c].next)
            bbm_fix_node(r->p->m, r->copy[c].node, directions, 0, 0);
    return 1;
}

/* What meets at a library node. */
static int meeting(const bbm_model *m, int node) { return m->adjacent_first[node + 1] - m->adjacent_first[node]; }

/* Each node of WHERE has the same share, and of that each element there. */
static int read_load(model_reader *r)
{
    bbm_model *m = r->p->m;
    double f[2];

    if (!where(r, 0) || !number(r, &f[0]) || !number(r, &f[1]) || !at_end(r))
        return 0;
    for (int k = 0; k < r->chosen; k++) {
        const int first = r->node[r->chosen_node[k]].first;
        int all = 0;
        for (int c = first; c >= 0; c = r->copy[c].next)
            all += meeting(m, r->copy[c].node);
        for (int c = first; c >= 0; c = r->copy[c].next) {
            const double share = (double)meeting(m, r->copy[c].node) / all / r->chosen;
            bbm_add_load(m, r->copy[c].node, share * f[0], share * f[1]);
        }
    }
    return m->status ? model_fail(r, r->s->at, "loads too large to add up, expected finite ones") : 1;
}

/* Traction or pressure on the boundary edges with both ends in WHERE. */
static int load_edges(model_reader *r, double tx, double ty, double pressure)
{
    bbm_model *m = r->p->m;
    char *in = make_room(r, m->nodes, 1);
    int found = 0;

    if (!in)
        return 0;
    for (int k = 0; k < r->chosen; k++)
        for (int c = r->node[r->chosen_node[k]].first; c >= 0; c = r->copy[c].next)
            in[r->copy[c].node] = 1;
    for (int e = 0; e < m->edges; e++)
        if (in[m->vertex[m->edge[e].a].node] && in[m->vertex[m->edge[e].b].node]) {
            const double t = m->element[m->edge[e].element].material.thickness;
            bbm_load_edge(m, e, tx * t, ty * t, pressure * t);
            found = 1;
        }
    free(in);
    if (!found)
        return model_fail(r, r->s->at, "no boundary edge has both ends there, expected one");
    if (m->status == BBM_NO_MEMORY)
        return out_of_memory(r);
    return m->status ? model_fail(r, r->s->at, "a load too large, expected a finite one") : 1;
}

static int read_traction(model_reader *r)
{
    double t[2];

    return where(r, 0) && number(r, &t[0]) && number(r, &t[1]) && at_end(r) && load_edges(r, t[0], t[1], 0);
}

static int read_pressure(model_reader *r)
{
    double p;

    return where(r, 0) && number(r, &p) && at_end(r) && load_edges(r, 0, 0, p);
}

static int read_velocity(model_reader *r)
{
    const int block = next_block(r);
    model_velocity v = { { 0, 0, 0 }, 1 };

    if (block < 0 || !number(r, &v.V[0]) || !number(r, &v.V[1]) || (look(r) && !number(r, &v.V[2])) || !at_end(r))
        return 0;
    if (r->p->velocity[block].given)
        return model_fail(r, r->s->at, "a velocity of '%s' for the second time, expected one", r->block[block].name);
    r->p->velocity[block] = v;
    return 1;
}

static int read_stress(model_reader *r)
{
    const int block = next_block(r);

    if (block < 0)
        return 0;
    model_block *b = &r->block[block];
    if (b->stressed++)
        return model_fail(r, r->s->at, "a stress of '%s' for the second time, expected one", b->name);
    return number(r, &b->stress[0]) && number(r, &b->stress[1]) && number(r, &b->stress[2]) && at_end(r);
}

static int read_monitor(model_reader *r)
{
    const char *word = name(r);
    model *p = r->p;

    if (!word || !is_new(r, &r->monitor_of, "monitor", word) || !where(r, 1) || !at_end(r))
        return 0;
    if (!model_grow(r, &p->monitor, p->monitors, sizeof *p->monitor) || !model_enter(r, &r->monitor_of, word, 0))
        return 0;
    model_monitor *m = &p->monitor[p->monitors++];
    *m = (model_monitor){ word, 0, NULL };
    for (int k = 0; k < r->chosen; k++)
        for (int c = r->node[r->chosen_node[k]].first; c >= 0; c = r->copy[c].next) {
            if (!model_grow(r, &m->node, m->nodes, sizeof *m->node))
                return 0;
            m->node[m->nodes++] = r->copy[c].node;
        }
    return 1;
}

/* ---------------------------------------------------------------------------------------------- the table */

static const struct kind { const char *name, *form; int (*read)(model_reader *r); int phase, once; } kinds[] = {
    { "title", "title TEXT", read_title, NOTHING_NEEDED, 1 },
    { "node", "node ID X Y", read_node, NOTHING_NEEDED, 0 },
    { "mesh", "mesh FILE.msh", read_mesh, NOTHING_NEEDED, 0 },
    { "material", "material NAME E VALUE nu VALUE density VALUE [thickness VALUE]", read_material, NOTHING_NEEDED, 0 },
    { "gravity", "gravity GX GY", read_gravity, NOTHING_NEEDED, 1 },
    { "shake", "shake AX AY OMEGA", read_shake, NOTHING_NEEDED, 1 },
    { "contact", "contact [kn VALUE] [ks VALUE] [friction DEGREES] [cohesion PASCAL] [tension PASCAL]", read_contact,
      NOTHING_NEEDED, 1 },
    { "static", "static [steps N] [tolerance VALUE]", read_static, NOTHING_NEEDED, 1 },
    { "dynamic", "dynamic dt VALUE steps N [damping VALUE] [settle N]", read_dynamic, NOTHING_NEEDED, 1 },
    { "bond", "bond [alpha VALUE] [augment N] [at vertices|midpoints|moment|auto]", read_bond, NOTHING_NEEDED, 1 },
    { "pcg", "pcg [omega VALUE] [tolerance VALUE] [iterations N] [coarse on|off]", read_pcg, NOTHING_NEEDED, 1 },
    { "rotation", "rotation exact|linear", read_rotation, NOTHING_NEEDED, 1 },
    { "output", "output [every N] [vtk] [svg] [field mises|sxx|syy|sxy|s1|s2|u|v] [scale N]", read_output, NOTHING_NEEDED, 1 },
    { "element", "element ID BLOCK MATERIAL N1 N2 N3 [N4 ...]", read_element, NODES, 0 },
    { "set", "set NAME nodes ID ID ...", read_set, NODES, 0 },
    { "use", "use MATERIAL on BLOCK", read_use, BLOCKS, 0 },
    { "fixblock", "fixblock BLOCK", read_fixblock, BLOCKS, 0 },
    { "fix", "fix WHERE [x] [y]", read_fix, MODEL, 0 },
    { "load", "load WHERE FX FY", read_load, MODEL, 0 },
    { "traction", "traction WHERE TX TY", read_traction, MODEL, 0 },
    { "pressure", "pressure WHERE P", read_pressure, MODEL, 0 },
    { "velocity", "velocity BLOCK VX VY [SPIN]", read_velocity, MODEL, 0 },
    { "stress", "stress BLOCK SXX SYY SXY", read_stress, MODEL, 0 },
    { "monitor", "monitor NAME WHERE (node ID | at X Y | set NAME | box XMIN YMIN XMAX YMAX)", read_monitor, MODEL, 0 },
};

enum { STATIC = 7, DYNAMIC = 8 };

static const char *form_of(const model_statement *s) { return kinds[s->kind].form; }

static int add_word(model_reader *r, char *word)
{
    if (!model_grow(r, &r->word, r->words, sizeof *r->word))
        return 0;
    r->word[r->words++] = word;
    return 1;
}

/* Finds the statement that begins with the word; whether it may stand here. */
static int begin_statement(model_reader *r, const char *word, model_place at)
{
    int k = 0;

    while (k < LENGTH(kinds) && strcmp(kinds[k].name, word) != 0)
        k++;
    if (k == LENGTH(kinds))
        return model_fail(r, at, "unknown statement '%.60s', expected one like node, element, material, static", word);
    if (kinds[k].once && r->seen[k].line > 0)
        return model_fail(r, at, "%s for the second time, after line %d, expected it once", word, r->seen[k].line);
    r->seen[k] = at;
    if (!model_grow(r, &r->statement, r->statements, sizeof *r->statement))
        return 0;
    r->statement[r->statements++] = (model_statement){ at, r->words, 0, k };
    return 1;
}

/* One line without its end: the statement and its words. The text of a title is one word. */
static int cut_line(model_reader *r, char *line, model_place at)
{
    static const char blanks[] = " \t\r\f\v";

    line[strcspn(line, "#")] = '\0';
    for (int k = 0; *(line += strspn(line, blanks)) != '\0'; k++) {
        char *end = line + strcspn(line, blanks);
        const int title = k == 1 && kinds[r->statement[r->statements - 1].kind].read == read_title;
        if (title)
            for (end = line + strlen(line); strchr(blanks, end[-1]); )
                end--;
        const int more = *end != '\0';
        *end = '\0';
        if (k == 0 ? !begin_statement(r, line, at) : !add_word(r, line))
            return 0;
        r->statement[r->statements - 1].n = k;
        line = end + more;
    }
    return 1;
}

static int cut_file(model_reader *r, char *text, size_t size)
{
    char *end = text + size;
    model_place at = { r->path, 1 };

    if (size >= 3 && memcmp(text, "\xef\xbb\xbf", 3) == 0)      /* the mark of UTF-8 that some editors write */
        text += 3;
    for (char *next; text < end; text = next, at.line++) {
        char *stop = memchr(text, '\n', (size_t)(end - text));
        next = stop ? stop + 1 : end;
        if (stop)
            *stop = '\0';
        if (text + strlen(text) < (stop ? stop : end))
            return model_fail(r, at, "a zero byte: the file is binary, expected text");
        if (!cut_line(r, text, at))
            return 0;
    }
    return 1;
}

static int read_phase(model_reader *r, int phase)
{
    for (int k = 0; k < r->statements && !r->p->status; k++) {
        r->s = &r->statement[k];
        r->next = 0;
        if (kinds[r->s->kind].phase == phase)
            kinds[r->s->kind].read(r);
    }
    return !r->p->status;
}

static int check_kind(model_reader *r)
{
    const model_place *s = &r->seen[STATIC], *d = &r->seen[DYNAMIC];

    if (s->line && d->line)
        return model_fail(r, s->line > d->line ? *s : *d, "static and dynamic, expected one of them");
    if (!s->line && !d->line)
        return model_fail(r, (model_place){ r->path, 0 }, "neither static nor dynamic, expected one of them");
    return 1;
}

/* What the statements have noted for each block goes to its nodes and elements; statics must be held. */
static int finish(model_reader *r)
{
    model *p = r->p;

    for (int n = 0; n < p->m->nodes; n++)
        if (r->block[p->node_block[n]].fixed)
            bbm_fix_node(p->m, n, BBM_XY, 0, 0);
    for (int e = 0; e < p->m->elements; e++)
        memcpy(p->m->element[e].stress, r->block[p->m->element[e].block].stress, sizeof p->m->element[e].stress);
    p->block = make_room(r, r->blocks, sizeof *p->block);
    for (p->blocks = 0; p->block && p->blocks < r->blocks; p->blocks++)
        p->block[p->blocks] = r->block[p->blocks].name;
    int loose;
    if (p->status)
        return 0;
    if (bbm_find_mechanism(p->m, &loose))
        return out_of_memory(r);
    if (loose >= 0)
        return model_fail(r, r->element[loose].at, "the elements of block '%s' are bonded at midpoints and can turn against "
                          "each other, expected: bond at moment", p->block[p->m->element[loose].block]);
    const bbm_status status = p->dynamic ? BBM_OK : bbm_check_held(p->m);
    if (status == BBM_FREE_TO_MOVE)
        return model_fail(r, (model_place){ r->path, 0 }, "block '%s' is free to move, expected fix, fixblock or a "
                          "contact that holds it in statics", p->block[p->m->element[p->m->blamed[0]].block]);
    if (status)
        return refused(r, status);
    return !p->status;
}

static void free_reader(model_reader *r)
{
    model_table *table[] = { &r->node_of, &r->element_of, &r->block_of, &r->material_of, &r->set_of, &r->monitor_of };

    for (int k = 0; k < LENGTH(table); k++) {
        free(table[k]->value);
        free((void *)table[k]->key);
    }
    for (int k = 0; k < r->sets; k++)
        free(r->set[k].node);
    free(r->word), free(r->statement), free(r->node), free(r->element), free(r->corner), free(r->block);
    free(r->material), free(r->set), free(r->copy), free(r->chosen_node);
}

static int read_all(model_reader *r)
{
    size_t size;
    char *text = model_load(r, r->path, (model_place){ r->path, 0 }, &size);

    if (!text || !cut_file(r, text, size) || !check_kind(r))
        return 0;
    for (int phase = 0; phase < PHASES; phase++)
        if ((phase == MODEL && !build(r)) || !read_phase(r, phase))
            return 0;
    return finish(r);
}

int model_read(const char *path, model *p)
{
    model_reader r = { .p = p, .path = path, .other_material = -1 };

    *p = (model){ .field = "mises" };
    if (bbm_beyond_new(&p->m)) {
        out_of_memory(&r);
    } else {
        p->m->par.p_n = p->m->par.p_s = p->m->par.friction = -1;        /* not given */
        p->m->beyond->multiplier_rounds = 2;
        p->m->beyond->bonding = BBM_MOMENT;
        p->m->par.faces = 1;
        p->m->par.pcg.method = &bbm_two_level;
        read_all(&r);
    }
    free_reader(&r);
    return p->status;
}

double model_mises(const bbm_model *m, int element)
{
    const bbm_element *e = &m->element[element];

    return bbm_mises(e->stress, bbm_stress_out_of_plane(m, e));
}

/* Each block as a rigid body: v + spin x (X - barycentre of the block). */
int model_start(model *p)
{
    bbm_model *m = p->m;
    double (*sum)[3] = calloc((size_t)p->blocks, sizeof *sum);

    for (int e = 0; e < m->elements && sum; e++) {
        const bbm_element *i = &m->element[e];
        const double mass = i->material.density * i->material.thickness * i->A0;
        sum[i->block][0] += mass * i->x;
        sum[i->block][1] += mass * i->y;
        sum[i->block][2] += mass;
    }
    for (int e = 0; e < m->elements && sum; e++) {
        bbm_element *i = &m->element[e];
        const double *v = p->velocity[i->block].V, *s = sum[i->block];
        const double V[6] = { v[0] - v[2] * (i->y - s[1] / s[2]), v[1] + v[2] * (i->x - s[0] / s[2]), v[2], 0, 0, 0 };
        memcpy(i->V, V, sizeof V);
    }
    free(sum);
    return sum != NULL;
}

void model_free(model *p)
{
    bbm_model_free(p->m);
    for (int k = 0; k < p->texts; k++)
        free(p->text[k]);
    for (int k = 0; k < p->monitors; k++)
        free(p->monitor[k].node);
    free(p->text), free((void *)p->block), free((void *)p->node), free(p->node_block), free((void *)p->element);
    free(p->centre), free(p->velocity), free(p->monitor);
    *p = (model){ 0 };
}
