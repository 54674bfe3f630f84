/* reader.c - what the readers of files share: errors, memory, tables of names, the words, numbers
 * and options of a statement, and the nodes, elements, blocks and sets that they find. */
#include <ctype.h>
#include <errno.h>
#include <float.h>
#include <limits.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "reader.h"

enum { LARGEST = 1 << 28 };     /* bytes of a file: a longer one, or one without end, is no model */

/* ------------------------------------------------------------------------ errors, memory, words */

void model_clean(char *text)
{
    for (char *c = text; *c; c++)
        if (iscntrl((unsigned char)*c))
            *c = '?';
}

int model_fail(model_reader *r, model_place at, const char *format, ...)
{
    char *message = r->p->message;
    const size_t room = sizeof r->p->message;
    va_list args;

    if (r->p->status)
        return 0;
    r->p->status = 2;
    size_t used = (size_t)snprintf(message, room, "%.200s:", at.file);
    if (at.line > 0)
        used += (size_t)snprintf(message + used, room - used, "%d:", at.line);
    message[used++] = ' ';
    if (at.round)
        used += (size_t)snprintf(message + used, room - used, "%.100s: ", at.round);
    va_start(args, format);
    vsnprintf(message + used, room - used, format, args);
    va_end(args);
    model_clean(message);
    return 0;
}

int model_note(model_reader *r, const char *format, ...)
{
    enum { ROOM = 600 };
    char *text = model_text(r, ROOM);
    va_list args;

    if (!text)
        return 0;
    const int used = snprintf(text, ROOM, "%.200s:%d: ", r->s->at.file, r->s->at.line);
    va_start(args, format);
    vsnprintf(text + used, (size_t)(ROOM - used), format, args);
    va_end(args);
    model_clean(text);
    return model_add(r, &r->p->note, &r->p->notes, sizeof text, &text);
}

int model_out_of_memory(model_reader *r)
{
    model_fail(r, (model_place){ .file = r->path }, "out of memory");
    r->p->status = 1;
    return 0;
}

/* A line is to blame for elements that overlap alone. */
int model_refused(model_reader *r, bbm_status status)
{
    const int overlap = status == BBM_OVERLAP || status == BBM_BLOCKS_OVERLAP;
    const model_place none = { .file = r->path };
    char text[400];

    if (status == BBM_NO_MEMORY)
        return model_out_of_memory(r);
    return model_fail(r, overlap ? r->element[r->p->m->blamed[0]].at : none, "%s",
                      model_says(r->p, status, text));
}

/* The room is a power of two, 16 at least: when the count has reached it, it is doubled. */
int model_add(model_reader *r, void *array, int *count, size_t size, const void *item)
{
    void **a = array;
    const size_t n = (size_t)*count;

    if (n == 0 || (n >= 16 && (n & (n - 1)) == 0)) {
        void *more = *count > INT_MAX / 4 ? NULL : realloc(*a, (n == 0 ? 16 : 2 * n) * size);
        if (!more)
            return model_out_of_memory(r);
        *a = more;
    }
    memcpy((char *)*a + n * size, item, size);
    *count += 1;
    return 1;
}

void *model_room(model_reader *r, int count, size_t size)
{
    void *p = calloc((size_t)count + 1, size);

    if (!p)
        model_out_of_memory(r);
    return p;
}

static char *keep_text(model_reader *r, char *text)
{
    if (model_add(r, &r->p->text, &r->p->texts, sizeof text, &text))
        return text;
    free(text);
    return NULL;
}

/* Room for a text that is kept until model_free; NULL: no memory. */
char *model_text(model_reader *r, size_t size)
{
    char *text = calloc(size + 1, 1);

    if (text)
        return keep_text(r, text);
    model_out_of_memory(r);
    return NULL;
}

/* The slot of a key in the table, or the empty one where it belongs; FNV-1a. */
static int slot_of(const model_table *t, const char *key)
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
    const int i = t->room ? slot_of(t, key) : 0;

    return t->room && t->key[i] ? t->value[i] : -1;
}

int model_enter(model_reader *r, model_table *t, const char *key, int value)
{
    if (2 * t->count >= t->room) {
        const int room = t->room ? 2 * t->room : 64;
        model_table larger = { room, t->count, model_room(r, room, sizeof(int)),
                               model_room(r, room, sizeof(char *)) };
        for (int k = 0; k < t->room && larger.value && larger.key; k++)
            if (t->key[k]) {
                const int to = slot_of(&larger, t->key[k]);
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
    const int i = slot_of(t, key);
    t->count += t->key[i] == NULL;
    t->key[i] = key;
    t->value[i] = value;
    return 1;
}

/* The whole file as a text with a 0 behind it, kept until model_free; NULL after an error. */
char *model_load(model_reader *r, const char *path, model_place at, size_t *size)
{
    FILE *f = path == r->path && strcmp(path, "-") == 0 ? stdin : fopen(path, "rb");
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
    else if (!text)
        model_out_of_memory(r);
    if (f && f != stdin)
        fclose(f);
    if (r->p->status) {
        free(text);
        return NULL;
    }
    text[*size] = '\0';
    return keep_text(r, text);
}

/* How many letters, large or small, are to be changed, added or taken away (Levenshtein 1966). */
static int distance(const char *a, const char *b)
{
    enum { MOST = 40 };
    int row[MOST + 1], n = 0;

    for (; n < MOST && b[n]; n++)
        row[n] = n;
    row[n] = n;
    for (int i = 0; i < MOST && a[i]; i++) {
        int diagonal = row[0]++;
        for (int k = 0; k < n; k++) {
            const int change =
                diagonal + (tolower((unsigned char)a[i]) != tolower((unsigned char)b[k]));
            diagonal = row[k + 1];
            const int other = (row[k] < diagonal ? row[k] : diagonal) + 1;
            row[k + 1] = change < other ? change : other;
        }
    }
    return row[n];
}

const char *model_nearest(const char *word, const void *names, int n, size_t stride, char text[200])
{
    const char *found[3] = { NULL, NULL, NULL };
    int d[3] = { INT_MAX, INT_MAX, INT_MAX };

    for (int k = 0; k < n; k++) {
        const char *const name = *(const char *const *)((const char *)names + (size_t)k * stride);
        int at = 3;
        const int far = name ? distance(word, name) : INT_MAX;
        for (; at > 0 && name
               && (far < d[at - 1] || (far == d[at - 1] && strcmp(name, found[at - 1]) < 0));
             at--)
            if (at < 3)
                found[at] = found[at - 1], d[at] = d[at - 1];
        if (at < 3)
            found[at] = name, d[at] = far;
    }
    text[0] = '\0';
    for (int k = 0; k < 3 && found[k]; k++)
        snprintf(text + strlen(text), 200 - strlen(text), "%s%.60s", k ? ", " : "", found[k]);
    return text;
}

const char *model_nearest_of(const model_table *t, const char *word, char text[200])
{
    return model_nearest(word, (const void *)t->key, t->room, sizeof *t->key, text);
}

int model_unknown(model_reader *r, const model_table *t, const char *what, const char *word)
{
    char text[200];

    if (t->count == 0)
        return model_blame(r, "unknown %s '%.60s': the model has none", what, word);
    return model_blame(r, "unknown %s '%.60s', expected one that the model has, such as %s", what,
                       word, model_nearest_of(t, word, text));
}

int model_is_name(const char *word)
{
    return *word && word[strspn(word, MODEL_NAME)] == '\0';
}

const char *model_hint(const char *word)
{
    const char *c = word;

    while (*c > 0 && *c < 127)
        c++;
    return strncmp(word, "//", 2) == 0 ? "; a comment begins with #"
         : strpbrk(word, "(*/^") ? "; arithmetic is $(...)"
         : *c ? "; it has letters beyond ASCII: minus is -" : "";
}

/* What the file has in place of a word of the statement, or NULL: the same. */
static const char *source_of(const model_reader *r, const char *word)
{
    for (int k = r->s->first; k < r->s->first + r->s->n; k++)
        if (r->word[k] == word && r->given[k].text != word)
            return r->given[k].text;
    return NULL;
}

int model_wrong(model_reader *r, const char *what, const char *word)
{
    const char *source = source_of(r, word);

    return model_blame(r, "%s '%.60s'%s%.60s, expected: %s%s", what, word, source ? ", from " : "",
                       source ? source : "", r->s->form,
                       model_find(&r->let_of, word) >= 0 ? "; $ stands before the name of a number"
                                                         : model_hint(word));
}

/* The word that comes next stays; NULL at the end. */
char *model_look(const model_reader *r)
{
    return r->next < r->s->n ? r->word[r->s->first + r->next] : NULL;
}

char *model_word(model_reader *r)
{
    char *word = model_look(r);

    if (word)
        r->next++;
    else
        model_blame(r, "a word is missing, expected: %s", r->s->form);
    return word;
}

/* Takes the next word if it is this one. */
int model_skip(model_reader *r, const char *word)
{
    const int there = model_look(r) && strcmp(model_look(r), word) == 0;

    r->next += there;
    return there;
}

int model_keyword(model_reader *r, const char *word)
{
    if (model_skip(r, word))
        return 1;
    return model_look(r) ? model_blame(r, "not the word %s: '%.60s', expected: %s", word,
                                       model_look(r), r->s->form)
                         : model_word(r) != NULL;
}

int model_at_end(model_reader *r)
{
    return model_look(r) ? model_wrong(r, "surplus word", model_look(r)) : 1;
}

/* A word that is to be a number: none that is put together, as 2$p. */
static char *number_word(model_reader *r)
{
    char *word = model_word(r);
    const int at = r->s->first + r->next - 1;

    if (word && r->given[at].glued)
        return model_blame(r, "'%.60s' would be '%.60s'; a number is one piece, as 5, $p, -$p or "
                           "$(2*p)", r->given[at].text, word), NULL;
    return word;
}

int model_number(model_reader *r, double *x)
{
    char *word = number_word(r), *end;

    if (!word)
        return 0;
    *x = strtod(word, &end);
    if (*word == '\0' || *end != '\0' || strpbrk(word, "xXpP"))
        return model_wrong(r, "not a number:", word);
    if (!isfinite(*x))
        return model_wrong(r, "not a finite number:", word);
    if (fabs(*x) < DBL_MIN && strcspn(word, "123456789") < strcspn(word, "eE"))
        return model_wrong(r, "too small, and not 0:", word);
    return 1;
}

/* The last words of a statement. */
int model_numbers(model_reader *r, int n, double x[])
{
    for (int k = 0; k < n; k++)
        if (!model_number(r, &x[k]))
            return 0;
    return model_at_end(r);
}

int model_whole(model_reader *r, const char *what, int least, int *n)
{
    char *word = number_word(r), *end;

    if (!word)
        return 0;
    errno = 0;
    const long value = strtol(word, &end, 10);
    if (*end != '\0' || end == word)
        return model_wrong(r, "not a whole number:", word);
    if (value < least)
        return model_blame(r, "%s is %ld, expected a whole number, %d or more", what, value, least);
    if (errno || value > INT_MAX / 2)
        return model_wrong(r, "too large:", word);
    *n = (int)value;
    return 1;
}

const char *model_name(model_reader *r)
{
    const char *word = model_word(r);

    if (word && !model_is_name(word))
        return model_wrong(r, "not a name (letters, digits, _ - .):", word), NULL;
    return word;
}

/* An id is a whole number; zeros before it do not count. */
const char *model_id(model_reader *r)
{
    const char *word = model_word(r);

    if (word && word[strspn(word, "0123456789")] != '\0')
        return model_wrong(r, "an id is a whole number, not", word), NULL;
    while (word && word[0] == '0' && word[1] != '\0')
        word++;
    return word;
}

/* The number that a word stands for in a table; -1 after an error. */
int model_known(model_reader *r, const model_table *t, const char *what, const char *word)
{
    const int found = word ? model_find(t, word) : -1;

    if (word && found < 0)
        model_unknown(r, t, what, word);
    return found;
}

int model_next_block(model_reader *r)
{
    return model_known(r, &r->block_of, "block", model_word(r));
}

/* Angles are in degrees; tan(phi) is given elsewhere. */
int model_note_friction(model_reader *r, double friction)
{
    return !(friction > 0 && friction < 1)
           || model_note(r, "warning: a friction of %g degrees; if it is meant as tan(phi), phi is "
                         "%.3g degrees", friction, atan(friction) * 180 / acos(-1));
}

int model_is_new(model_reader *r, const model_table *t, const char *what, const char *word)
{
    if (model_find(t, word) >= 0)
        return model_blame(r, "%s '%.60s' for the second time, expected a new one", what, word);
    return 1;
}

/* -------------------------------------------------------------------------------------- options */

int model_choice(model_reader *r, const char *choices, int *n)
{
    const char *word = model_word(r);
    const size_t length = word ? strlen(word) : 0;

    *n = 0;
    for (const char *c = choices; word && c; c = strchr(c, '|'), *n += 1) {
        c += *c == '|';
        if (strncmp(c, word, length) == 0 && (c[length] == '|' || c[length] == '\0'))
            return 1;
    }
    return word ? model_blame(r, "'%.60s', expected one of %s", word, choices) : 0;
}

static int in_range(model_reader *r, const model_option *o)
{
    const double x = *o->x;
    const int good = (o->rim[0] == '[' ? x >= o->low : x > o->low)
                     && (o->rim[1] == ']' ? x <= o->high : x < o->high);

    const char *source = source_of(r, r->word[r->s->first + r->next - 1]);
    return good ? 1 : model_blame(r, "%s is %g%s%.60s, expected %s", o->name, x,
                                  source ? ", from " : "", source ? source : "", o->expected);
}

static int option_value(model_reader *r, model_option *o)
{
    if (o->seen)
        return model_blame(r, "%s for the second time, expected: %s", o->name, r->s->form);
    o->seen = 1;
    if (o->flag)
        return *o->flag = 1;
    if (o->choices)
        return model_choice(r, o->choices, o->n);
    if (o->n)
        return model_whole(r, o->name, o->least, o->n);
    return model_number(r, o->x) && in_range(r, o);
}

int model_options(model_reader *r, int n, model_option o[])
{
    while (model_look(r)) {
        int k = 0;
        while (k < n && !model_skip(r, o[k].name))
            k++;
        if (k == n)
            return model_wrong(r, "unknown option", model_look(r));
        if (!option_value(r, &o[k]))
            return 0;
    }
    for (int k = 0; k < n; k++)
        if (o[k].needed && !o[k].seen)
            return model_blame(r, "%s is missing, expected: %s", o[k].name, r->s->form);
    return 1;
}

/* ------------------------------------------------------------- nodes, elements, blocks and sets */

/* One that is too long is the largest number. */
static void note_id(long long *last, const char *id)
{
    const long long value = strtoll(id, NULL, 10);

    *last = value > *last ? value : *last;
}

int model_add_node(model_reader *r, const model_node *n)
{
    if (model_find(&r->node_of, n->id) >= 0)
        return model_fail(r, n->at, "node '%.60s' for the second time, expected a new one", n->id);
    note_id(&r->last_node, n->id);
    return model_enter(r, &r->node_of, n->id, r->nodes)
           && model_add(r, &r->node, &r->nodes, sizeof *n, n);
}

int model_find_block(model_reader *r, const char *word, model_place at)
{
    const model_block block = { .name = word, .at = at, .material = -1 };
    const int found = model_find(&r->block_of, word);

    if (found >= 0)
        return found;
    return model_enter(r, &r->block_of, word, r->blocks)
           && model_add(r, &r->block, &r->blocks, sizeof block, &block) ? r->blocks - 1 : -1;
}

int model_add_corner(model_reader *r, int node)
{
    return node >= 0 && model_add(r, &r->corner, &r->corners, sizeof node, &node);
}

int model_add_element(model_reader *r, const model_element *e)
{
    model_element own = *e;

    own.first = r->corners - e->n;
    note_id(&r->last_element, e->id);
    if (model_find(&r->element_of, e->id) >= 0)
        return model_fail(r, e->at, "element '%.60s' for the second time, expected a new one",
                          e->id);
    return model_enter(r, &r->element_of, e->id, r->elements)
           && model_add(r, &r->element, &r->elements, sizeof own, &own);
}

int model_find_set(model_reader *r, const char *word)
{
    const model_set set = { 0, NULL, 0 };
    const int found = model_find(&r->set_of, word);

    if (found >= 0)
        return found;
    return model_enter(r, &r->set_of, word, r->sets)
           && model_add(r, &r->set, &r->sets, sizeof set, &set) ? r->sets - 1 : -1;
}

int model_add_to_set(model_reader *r, int set, int node)
{
    return model_add(r, &r->set[set].node, &r->set[set].n, sizeof node, &node);
}
