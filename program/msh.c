/* msh.c - Gmsh's mesh files, MSH 2.2 and 4.1, ASCII (gmsh.info, "MSH file format").
 *
 * Both are sections of numbers, $Name ... $EndName. Wanted are $PhysicalNames, $Nodes and
 * $Elements, and of 4.1 also $Entities: in 2.2 each element names its physical group, in 4.1 the
 * curve or surface that it lies in does. Triangles and quadrilaterals become elements, their
 * physical surface is their block. Every physical group, of points, curves or surfaces, is a set
 * of nodes. Other sections are passed over, and so is z.
 *
 * The file is read word by word; the words are cut out of its text, in place, and ids are words
 * of it. The numbers of things that a section announces are only counted down, never trusted
 * with memory. */
#include <ctype.h>
#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "reader.h"

/* A physical group with its name, or an entity (point, curve, surface) with its groups tag[first
 * .. first+n-1]. */
typedef struct { int dimension, number; const char *name; int first, n; } entry;
typedef struct { int count; entry *entry; } list;

typedef struct {
    model_reader *r;
    model_place at;                     /* the last word */
    int line;                           /* of what is left of the file */
    char *text, *end;
    char section[40];
    int version;                        /* 22 or 41; 0: not known yet */
    int tags, done;                     /* done: 1: $Nodes, 2: $Elements */
    int entries, announced;             /* 4.1: in all blocks of the section, and by its head */
    list group, entity;
    const char **tag;                   /* [tags]       words */
} mesh;

/* ---------------------------------------------------------------------------------------- words */

static int wrong(mesh *m, const char *word, const char *expected)
{
    return model_fail(m->r, m->at, "'%.60s' in $%s, expected %s", word, m->section, expected);
}

/* The next word, "" at the end of the file. */
static char *look_word(mesh *m)
{
    char *word;

    for (; m->text < m->end && (isspace((unsigned char)*m->text) || *m->text == '\0'); m->text++)
        m->line += *m->text == '\n';
    m->at.line = m->line;
    word = m->text;
    while (m->text < m->end && !isspace((unsigned char)*m->text) && *m->text != '\0')
        m->text++;
    if (m->text < m->end) {
        m->line += *m->text == '\n';
        *m->text++ = '\0';
    }
    return word;
}

/* After an error there are no more words, all numbers are 0, and the first message stays. */
static char *next_word(mesh *m)
{
    char *word = m->r->p->status ? m->end : look_word(m);

    if (*word == '\0')
        model_fail(m->r, m->at, "the file ends inside $%s, expected $End%s", m->section,
                   m->section);
    return word;
}

/* Whether one more of n is to be read. */
static int more(const mesh *m, int *n) { return !m->r->p->status && (*n)-- > 0; }

static int whole(mesh *m, int least)
{
    char *word = next_word(m), *end;
    const long value = strtol(word, &end, 10);

    if (*end || end == word || value < least || value > INT_MAX / 2)
        return wrong(m, word, least > 0 ? "a whole number, 1 or more" : "a whole number");
    return (int)value;
}

/* Of all entities, or of one: the second may be a tag, which may be negative. */
static void read_head(mesh *m, int head[4])
{
    for (int k = 0; k < 4; k++)
        head[k] = whole(m, k == 1 ? INT_MIN / 2 : 0);
}

static double number(mesh *m)
{
    char *word = next_word(m), *end;
    const double x = strtod(word, &end);

    return *end || end == word || !isfinite(x) ? wrong(m, word, "a finite number") : x;
}

/* The number of a node or element stays a word. */
static const char *id(mesh *m)
{
    char *word = next_word(m);

    if (word[strspn(word, "0123456789")] != '\0')
        wrong(m, word, "a whole number");
    while (word[0] == '0' && word[1] != '\0')
        word++;
    return word;
}

/* ----------------------------------------------------------------------------- groups, entities */

static const entry *find(const list *l, int dimension, int number_of)
{
    for (int k = 0; k < l->count; k++)
        if (l->entry[k].dimension == dimension && l->entry[k].number == number_of)
            return &l->entry[k];
    return NULL;
}

/* dimension, number, "name" */
static void read_names(mesh *m)
{
    for (int n = whole(m, 0); more(m, &n); ) {
        entry e = { .dimension = whole(m, 0) };
        e.number = whole(m, 1);
        const char *word = next_word(m);
        const size_t length = *word == '"' ? strspn(word + 1, MODEL_NAME) : 0;
        if (length == 0 || strcmp(word + 1 + length, "\"") != 0)
            wrong(m, word, "a name in quotes, of letters, digits, _ - .");
        e.name = model_print(m->r, "%.*s", (int)length, word + 1);
        model_add(m->r, &m->group.entry, &m->group.count, sizeof e, &e);
    }
}

/* Reads the n physical tags of an entity or element. */
static void read_tags(mesh *m, int n)
{
    while (more(m, &n)) {
        const char *word = next_word(m);
        word += word[0] == '-';                     /* a reversed curve has a negative tag */
        model_add(m->r, &m->tag, &m->tags, sizeof word, &word);
    }
}

static void read_entity(mesh *m, int dimension)
{
    entry e = { dimension, whole(m, INT_MIN / 2), NULL, m->tags, 0 };

    for (int k = dimension == 0 ? 3 : 6; more(m, &k); )         /* the box around it */
        number(m);
    e.n = whole(m, 0);
    read_tags(m, e.n);
    for (int bounds = dimension > 0 ? whole(m, 0) : 0; more(m, &bounds); )
        next_word(m);
    model_add(m->r, &m->entity.entry, &m->entity.count, sizeof e, &e);
}

static void read_entities(mesh *m)
{
    int n[4];

    read_head(m, n);
    for (int d = 0; d < 4; d++)
        while (more(m, &n[d]))
            read_entity(m, d);
}

/* ------------------------------------------------------------------------------ nodes, elements */

/* 4.1: the number of entities, of entries, the least and the largest number; for each entity its
 * dimension, tag, type of elements or whether its nodes have parameters, n; and n entries.
 * 2.2: the number of entries, which are read one by one. */
static void read_entries(mesh *m, void (*read)(mesh *m, const int of[4]))
{
    int head[4], of[4] = { 0, 0, 0, 1 };

    if (m->version == 41)
        read_head(m, head);
    else
        head[0] = head[1] = whole(m, 0);
    for (m->announced = head[1]; more(m, &head[0]); m->entries += of[3]) {
        if (m->version == 41)
            read_head(m, of);
        read(m, of);
    }
}

/* n numbers; n times x y z and parameters. */
static void read_some_nodes(mesh *m, const int of[4])
{
    for (int n = of[3]; more(m, &n); ) {
        model_node node = { .id = id(m), .first = -1 };
        node.at = m->at;
        model_add_node(m->r, &node);
    }
    for (int n = of[3]; more(m, &n); ) {
        model_node *node = &m->r->node[m->r->nodes - 1 - n];
        node->x = number(m);
        node->y = number(m);
        for (int rest = of[2] ? 1 + of[0] : 1; more(m, &rest); )
            number(m);
    }
}

static void read_nodes(mesh *m) { read_entries(m, read_some_nodes); }

static const char *name_of(const mesh *m, int dimension, const char *tag)
{
    const entry *g = find(&m->group, dimension, (int)strtol(tag, NULL, 10));

    return g ? g->name : tag;
}

/* Adds the nodes to the set of each group, and the element to the block of the first one. */
static int add_element(mesh *m, model_element *e, const entry *in)
{
    const int dimension = e->n < 3 ? e->n - 1 : 2;
    model_reader *r = m->r;

    for (int t = 0; t < in->n; t++) {
        const int set = model_find_set(r, name_of(m, dimension, m->tag[in->first + t]));
        if (set < 0)
            return 0;
        r->set[set].dimensions |= 1 << dimension;
        for (int k = r->corners - e->n; k < r->corners; k++)
            if (!model_add_to_set(r, set, r->corner[k]))
                return 0;
    }
    if (dimension < 2)
        return 1;
    if (in->n == 0)
        return model_fail(r, e->at, "element %.60s lies in no physical surface, expected one, "
                          "which is its block", e->id);
    e->block = model_find_block(r, name_of(m, 2, m->tag[in->first]));
    if (e->block < 0)
        return 0;
    r->block[e->block].meshed = 1;
    return model_add_element(r, e);
}

/* The nodes of an element, of a type that is known by its number. */
static int read_element(mesh *m, const char *number_of, int type, const entry *in)
{
    model_element e = { .id = number_of, .at = m->at, .material = -1 };

    e.n = type == 15 ? 1 : type >= 1 && type <= 3 ? type + 1 : 0;
    if (e.n == 0)
        return model_fail(m->r, m->at, "element %.60s is of type %d, expected 15, 1, 2 or 3: a "
                          "point, or a line, triangle or quadrilateral of first order",
                          number_of, type);
    for (int k = 0; k < e.n; k++) {
        const char *word = id(m);
        if (!model_add_corner(m->r, model_find(&m->r->node_of, word)))
            return wrong(m, word, "a node of the mesh");
    }
    return add_element(m, &e, in);
}

/* Number and nodes; in 2.2 between them the type, the number of tags, the physical group (0: none)
 * and other tags. */
static void read_some_elements(mesh *m, const int of[4])
{
    const entry *found = find(&m->entity, of[0], of[1]);
    entry in = found ? *found : (entry){ 0 };

    for (int n = of[3], type = of[2]; more(m, &n); ) {
        const char *number_of = id(m);
        if (m->version == 22) {
            type = whole(m, 1);
            m->tags = 0;
            read_tags(m, whole(m, 0));
            in.n = m->tags > 0 && strcmp(m->tag[0], "0") != 0;
        }
        read_element(m, number_of, type, &in);
    }
}

static void read_elements(mesh *m) { read_entries(m, read_some_elements); }

/* ------------------------------------------------------------------------------------- the file */

static void read_format(mesh *m)
{
    const char *version = next_word(m);

    m->version = strcmp(version, "2.2") == 0 ? 22 : strcmp(version, "4.1") == 0 ? 41 : 0;
    if (!m->version)
        wrong(m, version, "version 2.2 or 4.1");
    if (whole(m, 0))
        model_fail(m->r, m->at, "the mesh is binary, expected ASCII: gmsh without -bin, or "
                   "Mesh.Binary = 0");
    whole(m, 0);
}

static int is_end(const mesh *m, const char *word)
{
    return strncmp(word, "$End", 4) == 0
           && strncmp(word + 4, m->section, sizeof m->section - 1) == 0;
}

/* One that is not known is passed over. */
static void read_section(mesh *m)
{
    const struct { const char *name; void (*read)(mesh *m); int done; } section[] = {
        { "MeshFormat", read_format, 0 },
        { "PhysicalNames", read_names, 0 },
        { "Entities", m->version == 22 ? NULL : read_entities, 0 },
        { "Nodes", read_nodes, 1 },
        { "Elements", read_elements, 2 },
        { m->section, NULL, 0 },
    };
    int k = 0;

    while (strcmp(m->section, section[k].name) != 0)
        k++;
    m->done |= section[k].done;
    m->entries = m->announced = 0;
    if (section[k].read)
        section[k].read(m);
    const char *word = next_word(m);
    while (!section[k].read && *word && !is_end(m, word))
        word = next_word(m);
    if (!is_end(m, word))
        wrong(m, word, "the end of the section");
    if (m->entries != m->announced)
        model_fail(m->r, m->at, "$%s has %d entries, expected the %d that it announces",
                   m->section, m->entries, m->announced);
}

int model_read_mesh(model_reader *r, const char *path)
{
    mesh m = { .r = r, .at = { .file = path, .line = 1 }, .line = 1 };
    size_t size;

    m.text = model_load(r, path, &size);
    if (!m.text)
        return 0;
    m.end = m.text + size;
    for (const char *word; !r->p->status && *(word = look_word(&m)); ) {
        if (word[0] != '$')
            model_fail(r, m.at, "'%.60s', expected a section like $Nodes", word);
        m.section[0] = '\0';
        strncat(m.section, word + 1, sizeof m.section - 1);
        if (!m.version && strcmp(m.section, "MeshFormat") != 0)
            wrong(&m, word, "$MeshFormat as the first section");
        read_section(&m);
    }
    if (m.done != 3)
        model_fail(r, m.at, "the file ends without $%s, expected one",
                   m.done & 1 ? "Elements" : "Nodes");
    if (r->elements == 0)
        model_fail(r, m.at, "no triangle or quadrilateral, expected a mesh of surfaces: gmsh -2");
    return !r->p->status;
}
