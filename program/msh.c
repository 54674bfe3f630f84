/* msh.c - Gmsh's mesh files, MSH 2 and 4.1, ASCII (gmsh.info, "MSH file format").
 *
 * Both are sections of numbers, $Name ... $EndName. Wanted are $PhysicalNames, $Nodes (or
 * $ParametricNodes) and $Elements, and of 4.1 also $Entities and $PartitionedEntities: in 2 each
 * element names its physical group and its curve or surface, in 4.1 that names its groups. Other
 * sections are passed over.
 *
 * Triangles and quadrilaterals become elements, their physical surface is their block. Every
 * physical group, of points, curves or surfaces, is a set of nodes. Without physical surfaces all
 * elements are one block, `mesh`; `by surface` makes each surface a block, named by its number. A
 * curve in no group is a set of its number.
 *
 * The file is read word by word; the words are cut out of its text, in place, and ids are words
 * of it. The numbers of things that a section announces are only counted down, never trusted
 * with memory. */
#include <ctype.h>
#include <limits.h>

#include "reader.h"

/* Of a side of an element: z that differs by less is the same. */
#define FLAT 1e-3

/* A physical group with its name, or an entity (point, curve, surface) with its own number, of a
 * partition that of its parent, 0: none, and its groups tag[first .. first+n-1]. */
typedef struct { int dimension, number; const char *name; int own, first, n; } entry;
typedef struct { int count; entry *entry; } list;

typedef struct {
    model_reader *r;
    model_place at;                     /* the last word */
    int line;                           /* of what is left of the file */
    char *text, *end;
    const char *section;
    int version;                        /* 2 or 41; 0: not known yet */
    int by_surface;                     /* whether each surface is a block */
    const char *in_group, *in_none;     /* an element in a physical surface, and in none */
    int first;                          /* of the elements of the file */
    double z;                           /* of the plane in which it lies */
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

/* The name of the file, for a command. */
static const char *file_of(const mesh *m)
{
    const char *slash = strrchr(m->at.file, '/');

    return slash ? slash + 1 : m->at.file;
}

/* The next word, "" at the end of the file. Quotes hold blanks together. */
static char *look_word(mesh *m)
{
    char *word;
    int quoted = 0;

    for (; m->text < m->end && (isspace((unsigned char)*m->text) || *m->text == '\0'); m->text++)
        m->line += *m->text == '\n';
    m->at.line = m->line;
    word = m->text;
    while (m->text < m->end && *m->text != '\0' && *m->text != '\n'
           && (quoted || !isspace((unsigned char)*m->text)))
        quoted ^= *m->text++ == '"';
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
        if ((l->entry[k].dimension == dimension || l->entry[k].dimension < 0)
            && l->entry[k].number == number_of)
            return &l->entry[k];
    return NULL;
}

/* dimension (in 2.0 there is none: -1), number, "name". What no name has, as a blank, becomes _. */
static void read_names(mesh *m)
{
    for (int n = whole(m, 0); more(m, &n); ) {
        entry e = { .dimension = -1, .number = whole(m, 0) };
        if (m->text[strspn(m->text, " \t")] != '"')
            e.dimension = e.number, e.number = whole(m, 1);
        char *word = next_word(m), *close = word + strlen(word) - 1;
        if (close < word + 2 || *word != '"' || *close != '"')
            wrong(m, word, "a name in quotes");
        else
            *close = '\0', word++;
        for (char *c = word; *(c += strspn(c, MODEL_NAME)); )
            *c = '_';
        for (int k = 0; k < m->group.count; k++)
            if (m->group.entry[k].dimension == e.dimension
                && strcmp(m->group.entry[k].name, word) == 0)
                wrong(m, word, "another name than that of a group before it, with _ for blanks");
        e.name = word;
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

/* One of a partition has its parent's dimension and number and its partitions behind its own
 * number. */
static void read_entity(mesh *m, int dimension, int partitioned)
{
    entry e = { dimension, whole(m, INT_MIN / 2), NULL, 0, m->tags, 0 };

    e.own = e.number;
    if (partitioned) {
        const int of = whole(m, INT_MIN / 2), parent = whole(m, INT_MIN / 2);
        e.own = of == dimension ? parent : 0;
        for (int partitions = whole(m, 0); more(m, &partitions); )
            next_word(m);
    }
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
    const int partitioned = *m->section == 'P';
    int n[4];

    if (partitioned) {                  /* the number of partitions; ghosts and their partitions */
        whole(m, 0);
        for (int ghosts = 2 * whole(m, 0); more(m, &ghosts); )
            whole(m, 0);
    }
    read_head(m, n);
    for (int d = 0; d < 4; d++)
        while (more(m, &n[d]))
            read_entity(m, d, partitioned);
}

/* ------------------------------------------------------------------------------ nodes, elements */

/* n numbers; n times x y z and parameters, as many as the dimension says that stands before them
 * in $ParametricNodes. */
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
        node->z = number(m);
        int rest = of[2] ? of[0] : 0;
        if (*m->section == 'P') {
            rest = whole(m, 0);
            number(m), rest -= rest == 3 ? 3 : 0;       /* its entity; one of a volume has none */
        }
        while (more(m, &rest))
            number(m);
    }
}

static const char *name_of(const mesh *m, int dimension, const char *tag)
{
    const entry *g = find(&m->group, dimension, (int)strtol(tag, NULL, 10));

    return g ? g->name : tag;
}

/* Adds the nodes of an element, the last corners, to a set. */
static void add_to_set(mesh *m, const model_element *e, const char *name, int dimensions)
{
    model_reader *r = m->r;
    const int set = name ? model_find_set(r, name) : -1;

    if (set >= 0)
        r->set[set].dimensions |= dimensions;
    for (int k = r->corners - e->n; k < r->corners && set >= 0; k++)
        model_add_to_set(r, set, r->corner[k]);
}

/* The block of an element, of its first group or else of the file; or NULL. */
static const char *find_block(mesh *m, const model_element *e, const entry *in)
{
    if (m->by_surface && in->own > 0)
        return model_print(m->r, "%d", in->own);
    *(in->n > 0 ? &m->in_group : &m->in_none) = e->id;
    if (m->in_group && m->in_none)
        return model_fail(m->r, e->at, "element %.60s lies in no physical surface, element %.60s "
                          "in one, expected all or none in one; `mesh FILE by surface` makes each "
                          "surface a block", m->in_none, m->in_group), NULL;
    return in->n > 0 ? name_of(m, 2, m->tag[in->first]) : "mesh";
}

/* Adds the nodes to the set of each group, or of the curve if it has none, and the element to its
 * block. */
static int add_element(mesh *m, model_element *e, const entry *in)
{
    const int dimension = e->n < 3 ? e->n - 1 : 2;
    model_reader *r = m->r;

    for (int t = 0; t < in->n; t++)
        add_to_set(m, e, name_of(m, dimension, m->tag[in->first + t]), 1 << dimension);
    if (dimension == 1 && in->n == 0 && in->own > 0)
        add_to_set(m, e, model_print(r, "%d", in->own), 1 << 3);
    if (dimension < 2 || r->p->status)
        return 0;
    const int *corner = &r->corner[r->corners - e->n];
    const model_node *a = &r->node[corner[0]], *b = &r->node[corner[1]];
    m->z = r->elements == m->first ? a->z : m->z;
    for (int k = 0; k < e->n; k++)
        if (fabs(r->node[corner[k]].z - m->z) > FLAT * hypot(b->x - a->x, b->y - a->y))
            return model_fail(r, r->node[corner[k]].at, "node %.60s lies at z = %g, others at %g, "
                              "expected a mesh in a plane z = constant", r->node[corner[k]].id,
                              r->node[corner[k]].z, m->z);
    const char *block = find_block(m, e, in);
    if (!block || (e->block = model_find_block(r, block)) < 0)
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
        return model_fail(m->r, m->at, type >= 4 && type <= 7
                          ? "element %.60s is of type %d, a volume, expected lines, triangles and "
                            "quadrilaterals: gmsh -2 meshes surfaces alone"
                          : "element %.60s is of type %d, expected 15, 1, 2 or 3, which are of "
                            "first order: `gmsh -0` of a file with the line: Merge \"%.60s\"; "
                            "SetOrder 1; Save \"NEW.msh\";", number_of, type, file_of(m));
    for (int k = 0; k < e.n; k++) {
        const char *word = id(m);
        if (!model_add_corner(m->r, model_find(&m->r->node_of, word)))
            return wrong(m, word, "a node of the mesh");
    }
    return add_element(m, &e, in);
}

/* Number and nodes; in 2 between them the type, the number of tags, the physical group and the
 * curve or surface (0: none), and other tags. */
static void read_some_elements(mesh *m, const int of[4])
{
    const entry *found = find(&m->entity, of[0], of[1]);
    entry in = found ? *found : (entry){ .own = of[1] };

    for (int n = of[3], type = of[2]; more(m, &n); ) {
        const char *number_of = id(m);
        if (m->version == 2) {
            type = whole(m, 1);
            m->tags = 0;
            read_tags(m, whole(m, 0));
            in.n = m->tags > 0 && strcmp(m->tag[0], "0") != 0;
            in.own = m->tags > 1 ? abs((int)strtol(m->tag[1], NULL, 10)) : 0;
        }
        read_element(m, number_of, type, &in);
    }
}

/* 4.1: the number of entities, of entries, the least and the largest number; for each entity its
 * dimension, tag, type of elements or whether its nodes have parameters, n; and n entries.
 * 2: the number of entries, which are read one by one. */
static void read_entries(mesh *m)
{
    int head[4], of[4] = { 0, 0, 0, 1 };

    if (m->version == 41)
        read_head(m, head);
    else
        head[0] = head[1] = whole(m, 0);
    for (m->announced = head[1]; more(m, &head[0]); m->entries += of[3]) {
        if (m->version == 41)
            read_head(m, of);
        (*m->section == 'E' ? read_some_elements : read_some_nodes)(m, of);
    }
}

/* ------------------------------------------------------------------------------------- the file */

static int blame_format(mesh *m, const char *what)
{
    return model_fail(m->r, m->at, "%.60s, expected a text of version 2 or 4.1: gmsh -save -format "
                      "msh41 -o NEW.msh %.200s", what, file_of(m));
}

static void read_format(mesh *m)
{
    const char *version = next_word(m);

    m->version = strcmp(version, "4.1") == 0 ? 41
               : strncmp(version, "2.", 2) == 0 || strcmp(version, "2") == 0 ? 2 : 0;
    if (!m->version)
        blame_format(m, model_print(m->r, "the mesh is of version '%.20s'", version));
    if (whole(m, 0))
        blame_format(m, "the mesh is binary");
    whole(m, 0);
}

static int is_end(const mesh *m, const char *word)
{
    return strncmp(word, "$End", 4) == 0 && strcmp(word + 4, m->section) == 0;
}

/* One that is not known is passed over. */
static void read_section(mesh *m)
{
    const struct { const char *name; void (*read)(mesh *m); int done; } section[] = {
        { "MeshFormat", read_format, 0 },
        { "PhysicalNames", read_names, 0 },
        { "Entities", m->version == 2 ? NULL : read_entities, 0 },
        { "PartitionedEntities", read_entities, 0 },
        { "Nodes", read_entries, 1 },
        { "ParametricNodes", read_entries, 1 },
        { "Elements", read_entries, 2 },
        { m->section, NULL, 0 },
    };
    int k = 0;

    while (strcmp(m->section, section[k].name) != 0)
        k++;
    if (!m->version && k > 0 && section[k].read)
        blame_format(m, "no $MeshFormat stands before this section");
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

int model_read_mesh(model_reader *r, const char *path, int by_surface)
{
    mesh m = { .r = r, .at = { .file = path, .line = 1 }, .line = 1, .by_surface = by_surface,
               .first = r->elements };
    size_t size;

    m.text = model_load(r, path, &size);
    if (!m.text)
        return 0;
    m.end = m.text + size;
    for (const char *word; !r->p->status && *(word = look_word(&m)); ) {
        m.section = word + 1;
        if (word[0] != '$')
            model_fail(r, m.at, "'%.60s', expected a section like $Nodes; of another format "
                       "makes one: meshio convert -a -o gmsh22 %.200s NEW.msh", word, file_of(&m));
        else if (strcmp(m.section, "NOD") == 0)
            blame_format(&m, "the mesh is of version '1'");
        else
            read_section(&m);
    }
    if (m.done != 3)
        model_fail(r, m.at, "the file ends without $%s, expected a mesh: gmsh -2 makes one",
                   m.done & 1 ? "Elements" : "Nodes");
    if (r->elements == m.first)
        model_fail(r, m.at, "no triangle or quadrilateral, expected a mesh of surfaces: gmsh -2");
    return !r->p->status;
}
