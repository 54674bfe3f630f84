/* reader.c - what the readers of files share: errors, memory, tables of names, the words, numbers
 * and options of a statement, and the nodes, elements, blocks and sets that they find. */
#include <ctype.h>
#include <errno.h>
#include <limits.h>
#include <stdarg.h>

#include "reader.h"

enum { LARGEST = 1 << 28 };     /* bytes of a file: a longer one, or one without end, is no model */

/* ------------------------------------------------------------------------ errors, memory, words */

void model_clean(char *text)
{
    for (char *c = text; *c; c++)
        if (iscntrl((unsigned char)*c))
            *c = '?';
}

/* FILE:LINE: i = 7: what is said. */
int model_fail(model_reader *r, model_place at, const char *format, ...)
{
    const size_t room = sizeof r->p->message;
    char *text = r->p->message;
    va_list args;

    if (r->p->status)
        return 0;
    r->p->status = 2;
    snprintf(text, room, at.line > 0 ? "%.200s:%d: " : "%.200s: ", at.file, at.line);
    if (at.round)
        snprintf(text + strlen(text), room - strlen(text), "%.100s: ", at.round);
    va_start(args, format);
    vsnprintf(text + strlen(text), room - strlen(text), format, args);
    va_end(args);
    model_clean(text);
    return 0;
}

int model_add_note(model_reader *r, const char *what)
{
    char *note = model_print(r, "%.200s:%d: %s", r->s->at.file, r->s->at.line, what ? what : "");

    if (note)
        model_clean(note);
    return note && model_add(r, &r->p->note, &r->p->notes, sizeof note, &note);
}

int model_out_of_memory(model_reader *r)
{
    model_fail(r, r->whole, "out of memory");
    r->p->status = 1;
    return 0;
}

/* A line is to blame for elements that overlap alone. */
int model_refused(model_reader *r, bbm_status status)
{
    const int overlap = status == BBM_OVERLAP || status == BBM_BLOCKS_OVERLAP;
    char text[400];

    if (status == BBM_NO_MEMORY)
        return model_out_of_memory(r);
    return model_fail(r, overlap ? r->element[r->p->m->blamed[0]].at : r->whole, "%s",
                      model_says(r->p, status, text));
}

/* The array, NULL: a new one, with room for n items; or NULL, and it stays as it is. */
static void *resize(model_reader *r, void *array, size_t n, size_t size)
{
    model_kept **link = array ? ((model_kept *)array - 1)->link : &r->p->kept;
    model_kept *k = n > INT_MAX / 2 ? NULL : realloc(array ? *link : NULL, sizeof *k + n * size);

    if (!k)
        return model_out_of_memory(r), NULL;
    k->next = array ? k->next : *link;
    k->link = link;
    *link = k;
    if (k->next)
        k->next->link = &k->next;
    return k + 1;
}

/* The room is a power of two, 16 at least: when the count has reached it, it is doubled. */
int model_add(model_reader *r, void *array, int *count, size_t size, const void *item)
{
    void **a = array;
    const size_t n = (size_t)*count;

    if (n == 0 || (n >= 16 && (n & (n - 1)) == 0)) {
        void *more = resize(r, *a, n == 0 ? 16 : 2 * n, size);
        if (!more)
            return 0;
        *a = more;
    }
    memcpy((char *)*a + n * size, item, size);
    *count += 1;
    return 1;
}

void *model_keep(model_reader *r, int n, size_t size)
{
    const size_t room = (size_t)n + 1;
    void *array = resize(r, NULL, room, size);

    return array ? memset(array, 0, room * size) : NULL;
}

char *model_print(model_reader *r, const char *format, ...)
{
    va_list args, again;

    va_start(args, format);
    va_copy(again, args);
    char *text = model_keep(r, vsnprintf(NULL, 0, format, args), 1);
    if (text)
        vsprintf(text, format, again);
    va_end(again);
    va_end(args);
    return text;
}

/* The slot of a key in the table, or the empty one where it belongs; FNV-1a. */
static model_slot *slot_of(const model_table *t, const char *key)
{
    unsigned hash = 2166136261u;

    for (const char *c = key; *c; c++)
        hash = (hash ^ (unsigned char)*c) * 16777619u;
    int i = (int)(hash & (unsigned)(t->room - 1));
    while (t->slot[i].key && strcmp(t->slot[i].key, key) != 0)
        i = (i + 1) & (t->room - 1);
    return &t->slot[i];
}

int model_find(const model_table *t, const char *key)
{
    const model_slot *s = t->room ? slot_of(t, key) : NULL;

    return s && s->key ? s->value : -1;
}

int model_enter(model_reader *r, model_table *t, const char *key, int value)
{
    if (2 * t->count >= t->room) {
        model_table larger = { .what = t->what, .room = t->room ? 2 * t->room : 64 };
        if (!(larger.slot = model_keep(r, larger.room, sizeof *larger.slot)))
            return 0;
        for (int k = 0; k < t->room; k++)
            if (t->slot[k].key)
                model_enter(r, &larger, t->slot[k].key, t->slot[k].value);
        *t = larger;
    }
    model_slot *s = slot_of(t, key);
    t->count += s->key == NULL;
    *s = (model_slot){ key, value };
    return 1;
}

/* The whole file as a text with a 0 behind it, kept until model_free; NULL after an error. */
char *model_load(model_reader *r, const char *path, size_t *size)
{
    const model_place at = r->s ? r->s->at : (model_place){ .file = path };
    const int is_model = path == r->whole.file;
    FILE *f = is_model && strcmp(path, "-") == 0 ? stdin : fopen(path, "rb");
    char *text = NULL;
    size_t n = 0;

    int more = f != NULL;
    for (size_t room = 1 << 12; more; room *= 2) {
        text = resize(r, text, room + 1, 1);
        n += text ? fread(text + n, 1, room - n, f) : 0;
        more = n == room && n < LARGEST;
    }
    if (!f || ferror(f))
        model_fail(r, at, "%.200s cannot be read: %s%s", path, strerror(errno),
                   is_model && !strchr(path, '.') ? "; does its name lack .model?" : "");
    else if (n == LARGEST)
        model_fail(r, at, "%.200s is longer than %d bytes, expected a text", path, LARGEST);
    if (f && f != stdin)
        fclose(f);
    path = f == stdin ? "/dev/stdin" : path;
    model_add(r, &r->p->input, &r->p->inputs, sizeof path, &path);
    *size = n;
    if (!r->p->status)
        text[n] = '\0';
    return r->p->status ? NULL : text;
}

/* How many letters, large or small, of the first word of b are to be changed, added or taken away
 * (Levenshtein 1966). */
static int distance(const char *a, const char *b)
{
    enum { MOST = 40 };
    int row[MOST + 1], n = 0;

    for (; n < MOST && b[n] && b[n] != ' '; n++)
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

const char *model_nearest(model_reader *r, const char *word, const void *names, int n,
                          size_t stride, int most)
{
    const char *found[4] = { NULL }, *text = "";        /* the fourth one is not wanted */
    int d[4] = { INT_MAX, INT_MAX, INT_MAX };

    for (int k = 0; k < n; k++) {
        const char *const name = *(const char *const *)((const char *)names + (size_t)k * stride);
        const int far = name ? distance(word, name) : INT_MAX;
        int at = 3;
        for (; at > 0 && far <= most
               && (far < d[at - 1] || (far == d[at - 1] && strcmp(name, found[at - 1]) < 0));
             at--)
            found[at] = found[at - 1], d[at] = d[at - 1];
        found[at] = name, d[at] = far;
    }
    for (int k = 0; k < 3 && found[k] && text; k++)
        text = model_print(r, "%s%s%.*s", text, k ? ", " : "", (int)strcspn(found[k], " "),
                           found[k]);
    return text ? text : "";
}

const char *model_nearest_of(model_reader *r, const model_table *t, const char *word)
{
    return model_nearest(r, word, t->slot, t->room, sizeof *t->slot, INT_MAX - 1);
}

const char *model_find_word(const char *text, const char *word)
{
    const size_t n = strlen(word);

    for (const char *at = text; n > 0 && (at = strstr(at, word)); at++)
        if ((at == text || strchr(" [|", at[-1])) && strchr(" ]|", at[n]))  /* 0 is one of them */
            return at;
    return NULL;
}

const char *model_hint(const char *word)
{
    const char *c = word;

    while (*c > 0 && *c < 127)
        c++;
    return strncmp(word, "//", 2) == 0 ? "; a comment begins with #"
         : strcmp(word, "midpoints") == 0
           ? ": bonded in the middles of their sides alone elements can turn against each other"
         : strspn(word, "([") && !strpbrk(word, "+*/^")
           ? "; numbers stand without brackets and commas"
         : model_find_word("GPa MPa kPa Pa MN kN N N/m km m cm mm kg kg/m3 s m/s m/s2 deg",
                          word + strspn(word, "+-.0123456789eE"))
           ? "; numbers stand without units, which are Pa, N, m, kg, s and degrees"
         : strpbrk(word, "(*/^") || (*word && strpbrk(word + 1, "+-")
                                     && !word[strspn(word, "0123456789.+-")])
           ? "; arithmetic is $(...), with angles in degrees"
         : strstr(word, "\xe2\x88\x92") || strstr(word, "\xe2\x80\x93") ? "; minus is -"
         : *c ? "; it has letters beyond ASCII"
         : strchr(word, ',') ? "; decimals need a point, and blanks stand between numbers" : "";
}

/* ", from " and what the file has in place of a word of the statement, or "": the same. */
static const char *source_of(model_reader *r, const char *word)
{
    for (int k = r->s->first; k < r->s->first + r->s->n; k++)
        if (r->word[k].text == word && r->word[k].source != word)
            return model_print(r, ", from %.60s", r->word[k].source);
    return "";
}

static int wrong(model_reader *r, const char *what, const char *word)
{
    return model_blame(r, "%s '%.60s'%s, expected: %s%s", what, word, source_of(r, word),
                       r->s->form,
                       model_find(&r->let_of, word) >= 0 ? "; $ stands before the name of a number"
                                                         : model_hint(word));
}

/* The word that comes next stays; NULL at the end. After an error there are no more words. */
char *model_look(const model_reader *r)
{
    return !r->p->status && r->next < r->s->n ? r->word[r->s->first + r->next].text : NULL;
}

/* Where there is none, the word of the form that comes next is missing; of what is optional in it,
 * none is named. */
char *model_word(model_reader *r)
{
    int optional = 0, n, k = r->next + 1 - r->ahead;

    if (r->p->status || model_look(r))
        return r->p->status ? NULL : r->word[r->s->first + r->next++].text;
    const char *name = r->s->form;
    for (; (n = (int)strcspn(name, " ,")) > 0; name += n + (name[n] == ' ')) {
        optional |= *name == '[';
        if (!optional && k-- == 0)
            break;
        optional &= name[n - 1] != ']';
    }
    return model_blame(r, "%.*s is missing, expected: %s", n ? n : 6, n ? name : "a word",
                       r->s->form), NULL;
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
    const char *found = model_look(r);

    return model_skip(r, word)
           || model_blame(r, found ? "not the word %s: '%.60s', expected: %s"
                          : "the word %s is missing%s, expected: %s", word, found ? found : "",
                          r->s->form);
}

int model_at_end(model_reader *r)
{
    return model_look(r) ? wrong(r, "surplus word", model_look(r)) : !r->p->status;
}

/* None that is put together, as 2$p. */
int model_number(model_reader *r, double *x)
{
    char *word = model_word(r), *end;

    if (!word)
        return 0;
    const model_given *given = &r->word[r->s->first + r->next - 1];
    if (given->glued)
        return model_blame(r, "'%.60s' would be '%.60s'; a number is one piece, as 5, $p, -$p or "
                           "$(2*p)", given->source, word);
    *x = strtod(word, &end);
    const int tiny = fabs(*x) < DBL_MIN && strcspn(word, "123456789") < strcspn(word, "eE");
    const char *why = *word == '\0' || *end || strpbrk(word, "xXpP") ? "not a number:"
                    : !isfinite(*x) ? "not a finite number:"
                    : tiny ? "too small, and not 0:" : NULL;
    return !why || wrong(r, why, word);
}

int model_numbers(model_reader *r, int n, double x[])
{
    for (int k = 0; k < n; k++)
        model_number(r, &x[k]);
    return !r->p->status;
}

int model_whole(model_reader *r, const char *what, int least, int *n)
{
    const char *word = model_look(r);
    double x;

    if (!model_number(r, &x))
        return 0;
    if (x != floor(x) || x < least || x > INT_MAX / 2)
        return model_blame(r, "%s is %.15g%s, expected a whole number from %d to %d", what, x,
                           source_of(r, word), least, INT_MAX / 2);
    *n = (int)x;
    return 1;
}

const char *model_name(model_reader *r)
{
    const char *word = model_word(r);

    if (word && word[strspn(word, MODEL_NAME)] != '\0')
        return wrong(r, "not a name (letters, digits, _ - .):", word), NULL;
    return word;
}

/* An id: digits; zeros before the first other one do not count. */
const char *model_id(model_reader *r)
{
    const char *word = model_word(r);

    if (word && word[strspn(word, "0123456789")] != '\0')
        return wrong(r, "an id has digits alone, not", word), NULL;
    while (word && word[0] == '0' && word[1] != '\0')
        word++;
    return word;
}

/* The number that the next word stands for; -1 after an error. */
int model_known(model_reader *r, const model_table *t)
{
    const char *word = t == &r->node_of ? model_id(r) : model_word(r);
    const int found = word ? model_find(t, word) : -1;

    if (word && found < 0)
        model_blame(r, t->count == 0 ? "unknown %s '%.60s': the file has no statement `%s`"
                    : "unknown %s '%.60s', expected one that the model has, such as %s", t->what,
                    word, t->count == 0 ? t->what : model_nearest_of(r, t, word));
    return found;
}

int model_block_or_all(model_reader *r)
{
    return model_skip(r, "*") ? -1 : model_known(r, &r->block_of);
}

int model_is_new(model_reader *r, model_place at, const model_table *t, const char *word)
{
    return model_find(t, word) < 0
           || model_fail(r, at, "%s '%.60s' for the second time, expected a new one", t->what,
                         word);
}

const char *model_new_name(model_reader *r, const model_table *t)
{
    const char *word = model_name(r);

    return word && model_is_new(r, r->s->at, t, word) ? word : NULL;
}

/* Angles are in degrees; tan(phi) is given elsewhere. */
int model_note_friction(model_reader *r, double friction)
{
    return !(friction > 0 && friction < 1)
           || model_note(r, "warning: a friction of %g degrees; if it is meant as tan(phi), phi is "
                         "%.3g degrees", friction, atan(friction) * 180 / acos(-1));
}

/* -------------------------------------------------------------------------------------- options */

int model_choice(model_reader *r, const char *choices, int *n)
{
    const char *word = model_word(r), *at = word ? model_find_word(choices, word) : NULL;

    *n = 0;
    for (const char *c = at; c && c > choices; c--)
        *n += c[-1] == '|';
    return at || (word && model_blame(r, "'%.60s', expected one of %s%s", word, choices,
                                      model_hint(word)));
}

static int option_value(model_reader *r, model_option *o)
{
    const char *word = model_look(r);

    if (o->seen)
        return model_blame(r, "%s for the second time, expected: %s", o->name, r->s->form);
    o->seen = 1;
    if (!o->flag && !word)
        return model_blame(r, "the value of %s is missing, expected: %s", o->name, r->s->form);
    if (o->flag)
        return (*o->flag = 1) && (!o->x || !model_skip(r, "by") || model_number(r, o->x));
    if (o->choices)
        return model_choice(r, o->choices, o->n);
    if (o->n)
        return model_whole(r, o->name, o->least, o->n);
    if (!model_number(r, o->x))
        return 0;
    const int good = (o->rim[0] == '[' ? *o->x >= o->low : *o->x > o->low)
                     && (o->rim[1] == ']' ? *o->x <= o->high : *o->x < o->high);
    return good || model_blame(r, "%s is %g%s, expected %s", o->name, *o->x, source_of(r, word),
                               o->expected);
}

int model_options(model_reader *r, int needed, int n, model_option o[])
{
    while (model_look(r)) {
        int k = 0;
        while (k < n && !model_skip(r, o[k].name))
            k++;
        if (k == n)
            return wrong(r, "unknown option", model_look(r));
        option_value(r, &o[k]);
    }
    for (int k = 0; k < needed; k++)
        if (!o[k].seen)
            return model_blame(r, "%s is missing, expected: %s", o[k].name, r->s->form);
    return !r->p->status;
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
    note_id(&r->last_node, n->id);
    return model_is_new(r, n->at, &r->node_of, n->id)
           && model_enter(r, &r->node_of, n->id, r->nodes)
           && model_add(r, &r->node, &r->nodes, sizeof *n, n);
}

int model_find_block(model_reader *r, const char *word)
{
    const model_block block = { .name = word, .at = r->s->at, .material = -1 };

    if (model_find(&r->block_of, word) < 0 && model_enter(r, &r->block_of, word, r->blocks)
        && model_add(r, &r->p->block, &r->p->blocks, sizeof word, &word))
        model_add(r, &r->block, &r->blocks, sizeof block, &block);
    return r->p->status ? -1 : model_find(&r->block_of, word);
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
    return model_is_new(r, e->at, &r->element_of, e->id)
           && model_enter(r, &r->element_of, e->id, r->elements)
           && model_add(r, &r->element, &r->elements, sizeof own, &own);
}

int model_find_set(model_reader *r, const char *word)
{
    const model_set set = { 0, NULL, 0 };

    if (model_find(&r->set_of, word) < 0 && model_enter(r, &r->set_of, word, r->sets))
        model_add(r, &r->set, &r->sets, sizeof set, &set);
    return r->p->status ? -1 : model_find(&r->set_of, word);
}

int model_add_to_set(model_reader *r, int set, int node)
{
    return node >= 0 && model_add(r, &r->set[set].node, &r->set[set].n, sizeof node, &node);
}
