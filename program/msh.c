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

#include "msh.h"

/* A physical group with its name, or an entity (point, curve, surface) with its groups tag[first
 * .. first+n-1]. */
typedef struct { int dimension, number; const char *name; int first, n; } entry;
typedef struct { int count; entry *entry; } list;               /* sorted by dimension and number */

typedef struct {
    model_reader *r;
    model_place at, statement;          /* the last word, and `mesh` in the model file */
    int line;                           /* of what is left of the file */
    char *text, *end;
    char section[40];
    int version;                        /* 22 or 41; 0: not known yet */
    int tags, done;                     /* done: 1: $Nodes, 2: $Elements */
    list group, entity;
    const char **tag;                   /* [tags]       words */
} mesh;

/* ---------------------------------------------------------------------------------------- words */

static int wrong(mesh *m, const char *word, const char *expected)
{
    return model_fail(m->r, m->at, "'%.60s' in $%s, expected %s", word, m->section, expected);
}

/* The next word, NULL at the end of the file. */
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
    return word < m->end ? word : NULL;
}

static char *next_word(mesh *m)
{
    char *word = look_word(m);

    if (!word)
        model_fail(m->r, m->at, "the file ends inside $%s, expected $End%s", m->section,
                   m->section);
    return word;
}

static int whole(mesh *m, int least, int *n)
{
    char *word = next_word(m), *end;

    if (!word)
        return 0;
    const long value = strtol(word, &end, 10);
    if (*end || end == word || value < least || value > INT_MAX / 2)
        return wrong(m, word, least > 0 ? "a whole number, 1 or more" : "a whole number");
    *n = (int)value;
    return 1;
}

static int number(mesh *m, double *x)
{
    char *word = next_word(m), *end;

    if (!word)
        return 0;
    *x = strtod(word, &end);
    return *end || end == word || !isfinite(*x) ? wrong(m, word, "a finite number") : 1;
}

/* The number of a node or element stays a word. */
static const char *id(mesh *m)
{
    char *word = next_word(m);

    if (word && word[strspn(word, "0123456789")] != '\0')
        return wrong(m, word, "a whole number"), NULL;
    while (word && word[0] == '0' && word[1] != '\0')
        word++;
    return word;
}

static int end_section(mesh *m)
{
    const char *word = next_word(m);

    if (!word)
        return 0;
    if (strncmp(word, "$End", 4) == 0 && strcmp(word + 4, m->section) == 0)
        return 1;
    return wrong(m, word, "the end of the section");
}

/* ----------------------------------------------------------------------------- groups, entities */

static int compare(const void *p, const void *q)
{
    const entry *a = p, *b = q;

    return a->dimension != b->dimension
               ? (a->dimension > b->dimension) - (a->dimension < b->dimension)
               : (a->number > b->number) - (a->number < b->number);
}

static const entry *find(const list *l, int dimension, int number_of)
{
    const entry key = { dimension, number_of, NULL, 0, 0 };

    return l->count ? bsearch(&key, l->entry, (size_t)l->count, sizeof key, compare) : NULL;
}

static int add(mesh *m, list *l, const entry *e)
{
    return model_add(m->r, &l->entry, &l->count, sizeof *e, e);
}

static void sort(list *l)
{
    if (l->count)
        qsort(l->entry, (size_t)l->count, sizeof *l->entry, compare);
}

/* dimension, number, "name" */
static int read_names(mesh *m)
{
    int n;

    if (!whole(m, 0, &n))
        return 0;
    while (n-- > 0) {
        entry e = { 0, 0, NULL, 0, 0 };
        char *word;
        if (!whole(m, 0, &e.dimension) || !whole(m, 1, &e.number) || !(word = next_word(m)))
            return 0;
        const size_t length = strlen(word);
        if (length < 3 || word[0] != '"' || word[length - 1] != '"')
            return wrong(m, word, "a name in quotes, without blanks");
        word[length - 1] = '\0';
        e.name = word + 1;
        if (!model_is_name(e.name))
            return wrong(m, e.name, "a name of letters, digits, _ - .");
        if (!add(m, &m->group, &e))
            return 0;
    }
    sort(&m->group);
    return end_section(m);
}

/* Reads the n physical tags of an entity or element. */
static int read_tags(mesh *m, int n)
{
    const char *word;

    while (n-- > 0) {
        if (!(word = next_word(m)))
            return 0;
        word += word[0] == '-';                     /* a reversed curve has a negative tag */
        if (!model_add(m->r, &m->tag, &m->tags, sizeof word, &word))
            return 0;
    }
    return 1;
}

static int read_entity(mesh *m, int dimension)
{
    entry e = { dimension, 0, NULL, m->tags, 0 };
    double box;
    int bounds = 0;

    if (!whole(m, INT_MIN / 2, &e.number))
        return 0;
    for (int k = 0; k < (dimension == 0 ? 3 : 6); k++)
        if (!number(m, &box))
            return 0;
    e.first = m->tags;
    if (!whole(m, 0, &e.n) || !read_tags(m, e.n) || (dimension > 0 && !whole(m, 0, &bounds)))
        return 0;
    while (bounds-- > 0)
        if (!next_word(m))
            return 0;
    return add(m, &m->entity, &e);
}

static int read_entities(mesh *m)
{
    int n[4];

    for (int d = 0; d < 4; d++)
        if (!whole(m, 0, &n[d]))
            return 0;
    for (int d = 0; d < 4; d++)
        while (n[d]-- > 0)
            if (!read_entity(m, d))
                return 0;
    sort(&m->entity);
    return end_section(m);
}

/* ------------------------------------------------------------------------------ nodes, elements */

static int read_position(mesh *m, model_node *n)
{
    double z;

    return number(m, &n->x) && number(m, &n->y) && number(m, &z);
}

/* 4.1 announces how many there are in all blocks of the section. */
static int as_announced(mesh *m, int n, int total)
{
    return n == total ? 1 : model_fail(m->r, m->at, "$%s has %d entries, expected the %d that it "
                                       "announces", m->section, n, total);
}

/* 2.2: number x y z, for each. */
static int read_nodes_22(mesh *m)
{
    int n;

    if (!whole(m, 0, &n))
        return 0;
    while (n-- > 0) {
        model_node node = { .id = id(m), .first = -1 };
        node.at = m->at;
        if (!node.id || !read_position(m, &node) || !model_add_node(m->r, &node))
            return 0;
    }
    return end_section(m);
}

/* 4.1: for each entity its dimension, tag, whether there are parameters, n; n numbers; n times x
 * y z and parameters. */
static int read_nodes_41(mesh *m)
{
    model_reader *r = m->r;
    const int before = r->nodes;
    int blocks, head[4];
    double parameter;

    for (int k = 0; k < 4; k++)                 /* blocks, nodes, least and largest number */
        if (!whole(m, 0, &head[k]))
            return 0;
    const int total = head[1];
    for (blocks = head[0]; blocks > 0; blocks--) {
        const int first = r->nodes;
        for (int k = 0; k < 4; k++)
            if (!whole(m, k == 1 ? INT_MIN / 2 : 0, &head[k]))
                return 0;
        for (int k = 0; k < head[3]; k++) {
            model_node node = { .id = id(m), .first = -1 };
            node.at = m->at;
            if (!node.id || !model_add_node(r, &node))
                return 0;
        }
        for (int k = 0; k < head[3]; k++) {
            if (!read_position(m, &r->node[first + k]))
                return 0;
            for (int p = 0; head[2] && p < head[0]; p++)
                if (!number(m, &parameter))
                    return 0;
        }
    }
    return end_section(m) && as_announced(m, r->nodes - before, total);
}

static int dimension_of(int corners) { return corners < 3 ? corners - 1 : 2; }

static const char *name_of(const mesh *m, int dimension, const char *tag)
{
    const entry *g = find(&m->group, dimension, (int)strtol(tag, NULL, 10));

    return g ? g->name : tag;
}

/* Adds the nodes to the set of each group, and the element to the block of the first one. */
static int add_element(mesh *m, model_element *e, const int corner[], const char **tag, int tags)
{
    const int dimension = dimension_of(e->n);
    model_reader *r = m->r;

    for (int t = 0; t < tags; t++) {
        const int set = model_find_set(r, name_of(m, dimension, tag[t]));
        if (set < 0)
            return 0;
        r->set[set].dimensions |= 1 << dimension;
        for (int k = 0; k < e->n; k++)
            if (!model_add_to_set(r, set, corner[k]))
                return 0;
    }
    if (dimension < 2)
        return 1;
    if (tags == 0)
        return model_fail(r, e->at,
                          "element %.60s lies in no physical surface, expected one, which is its "
                          "block",
                          e->id);
    e->block = model_find_block(r, name_of(m, 2, tag[0]), m->statement);
    if (e->block < 0)
        return 0;
    r->block[e->block].meshed = 1;
    return model_add_element(r, e, corner);
}

/* The nodes of an element, of a type that is known by its number. */
static int read_element(mesh *m, const char *number_of, int type, const char **tag, int tags)
{
    model_element e = { .id = number_of, .at = m->at, .material = -1 };
    int corner[4];

    e.n = type == 15 ? 1 : type >= 1 && type <= 3 ? type + 1 : 0;
    if (e.n == 0)
        return model_fail(m->r, m->at,
                          "element %.60s is of type %d, expected 15, 1, 2 or 3: a point, or a line, "
                          "triangle "
                          "or quadrilateral of first order",
                          number_of, type);
    for (int k = 0; k < e.n; k++) {
        const char *word = id(m);
        if (!word)
            return 0;
        corner[k] = model_find(&m->r->node_of, word);
        if (corner[k] < 0)
            return wrong(m, word, "a node of the mesh");
    }
    return add_element(m, &e, corner, tag, tags);
}

/* 2.2: number, type, number of tags, the physical group (0: none), other tags, nodes. */
static int read_elements_22(mesh *m)
{
    int n, type, tags;

    if (!whole(m, 0, &n))
        return 0;
    while (n-- > 0) {
        const char *number_of = id(m);
        m->tags = 0;
        if (!number_of || !whole(m, 1, &type) || !whole(m, 0, &tags) || !read_tags(m, tags))
            return 0;
        if (!read_element(m, number_of, type, m->tag, tags > 0 && strcmp(m->tag[0], "0") != 0))
            return 0;
    }
    return end_section(m);
}

/* 4.1: for each entity its dimension, tag, the type, n; n times number and nodes. */
static int read_elements_41(mesh *m)
{
    int blocks, head[4], count = 0;

    for (int k = 0; k < 4; k++)
        if (!whole(m, 0, &head[k]))
            return 0;
    const int total = head[1];
    for (blocks = head[0]; blocks > 0; blocks--) {
        for (int k = 0; k < 4; k++)
            if (!whole(m, k == 1 ? INT_MIN / 2 : 0, &head[k]))
                return 0;
        const entry *e = find(&m->entity, head[0], head[1]);
        count += head[3];
        while (head[3]-- > 0) {
            const char *number_of = id(m);
            if (!number_of
                || !read_element(m, number_of, head[2], e ? m->tag + e->first : NULL, e ? e->n : 0))
                return 0;
        }
    }
    return end_section(m) && as_announced(m, count, total);
}

/* ------------------------------------------------------------------------------------- the file */

static int read_format(mesh *m)
{
    const char *version = next_word(m);
    int binary, size;

    if (!version)
        return 0;
    m->version = strcmp(version, "2.2") == 0 ? 22 : strcmp(version, "4.1") == 0 ? 41 : 0;
    if (!m->version)
        return wrong(m, version, "version 2.2 or 4.1");
    if (!whole(m, 0, &binary))
        return 0;
    if (binary)
        return model_fail(m->r, m->at, "the mesh is binary, expected ASCII: gmsh without -bin, "
                          "or Mesh.Binary = 0");
    return whole(m, 0, &size) && end_section(m);
}

static int pass_over(mesh *m)
{
    for (;;) {
        const char *word = next_word(m);
        if (!word)
            return 0;
        if (strncmp(word, "$End", 4) == 0
            && strncmp(word + 4, m->section, sizeof m->section - 1) == 0)
            return 1;
    }
}

static int read_section(mesh *m)
{
    const int old = m->version == 22;
    const struct { const char *name; int (*read)(mesh *m); int done; } section[] = {
        { "MeshFormat", read_format, 0 },
        { "PhysicalNames", read_names, 0 },
        { "Entities", old ? pass_over : read_entities, 0 },
        { "Nodes", old ? read_nodes_22 : read_nodes_41, 1 },
        { "Elements", old ? read_elements_22 : read_elements_41, 2 },
    };

    for (int k = 0; k < LENGTH(section); k++)
        if (strcmp(m->section, section[k].name) == 0) {
            m->done |= section[k].done;
            return section[k].read(m);
        }
    return pass_over(m);
}

static int read_sections(mesh *m)
{
    char *word;

    while ((word = look_word(m)) != NULL) {
        if (word[0] != '$')
            return model_fail(m->r, m->at, "'%.60s', expected a section like $Nodes", word);
        m->section[0] = '\0';
        strncat(m->section, word + 1, sizeof m->section - 1);
        if (!m->version && strcmp(m->section, "MeshFormat") != 0)
            return wrong(m, word, "$MeshFormat as the first section");
        if (!read_section(m))
            return 0;
    }
    if (m->done != 3)
        return model_fail(m->r, m->at, "the file ends without $%s, expected one",
                          m->done & 1 ? "Elements" : "Nodes");
    return 1;
}

int model_read_mesh(model_reader *r, const char *path, model_place statement)
{
    mesh m = { .r = r, .at = { .file = path, .line = 1 }, .statement = statement, .line = 1 };
    size_t size;
    int good = 0;

    m.text = model_load(r, path, statement, &size);
    if (m.text) {
        m.end = m.text + size;
        good = read_sections(&m);
        if (good && r->elements == 0)
            good = model_fail(r, m.at, "no triangle or quadrilateral, expected a mesh of surfaces: "
                              "gmsh -2");
    }
    free(m.group.entry);
    free(m.entity.entry);
    free((void *)m.tag);
    return good;
}
