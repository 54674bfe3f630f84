/* numbers.c - numbers with a name, arithmetic and repetition: makes of the statements of the file
 * those that are carried out.
 *
 *     let NAME VALUE              $NAME stands for the number, in any statement; $NAME$i for that
 *                                 whose name ends in the number i
 *     $(...)                      stands for its value, with 15 digits:
 *
 *         sum      = product { (+|-) product }
 *         product  = factor { (*|/) factor }
 *         factor   = (+|-) factor | primary [ ^ factor ]             -2^2 is -4, 2^3^2 is 2^9
 *         primary  = number | NAME | $NAME | pi | function(sum {, sum}) | (sum)
 *
 *     repeat NAME FROM TO         the statements up to its `end`, for each whole number from FROM
 *       ...                       to TO, which is $NAME in them; a `let` there is that of the
 *     end                         round alone, or else changes the one outside, as a sum; with a
 *                                 number in its name it stays
 *
 *     stage NAME ... end          the statements between get the number of the stage
 *
 * The `let`s above the first `repeat` are read first, so that statements above them may use them.
 * Those behind it may use what it has changed. */
#include <ctype.h>
#include <limits.h>

#include "reader.h"

/* Letters of a name, of a number; parentheses, and repetitions, in one another; statements that
 * repetitions make; bytes that the values of numbers take. */
enum {
    NAME_ROOM = 100, NUMBER_ROOM = 32, DEEPEST = 100, DEEPEST_REPEAT = 20, MOST_REPEATED = 1000000,
    MOST_BYTES = 1 << 26
};

/* ---------------------------------------------------------------------------------------- names */

/* A number of the round; or NULL. */
static model_local *find_local(const model_reader *r, const char *name)
{
    for (int k = 0; k < r->locals; k++)
        if (strcmp(r->local[k].name, name) == 0)
            return &r->local[k];
    return NULL;
}

/* The value, of the round or of the file, of the longest name that the text begins with and that
 * ends where its letters end, and its length; NULL: there is none. */
static const char *find_value(const model_reader *r, const char *text, size_t *n)
{
    char name[NAME_ROOM];
    const size_t letters = strspn(text, MODEL_NAME);

    for (*n = letters < NAME_ROOM ? letters : NAME_ROOM - 1; *n > 0; --*n) {
        if (isalnum((unsigned char)text[*n]) || text[*n] == '_')
            continue;
        snprintf(name, sizeof name, "%.*s", (int)*n, text);
        const model_local *own = find_local(r, name);
        const int at = model_find(&r->let_of, name);
        if (own || at >= 0)
            return own ? own->value : r->word[at].text;
    }
    const char *number = text[letters] == '$' ? find_value(r, text + letters + 1, n) : NULL;
    if (!number || letters == 0)
        return NULL;
    snprintf(name, sizeof name, "%.*s%s", (int)letters, text, number);
    const int at = model_find(&r->let_of, name);
    *n += letters + 1;
    return at < 0 ? NULL : r->word[at].text;
}

static int blame_name(model_reader *r, const char *name)
{
    const int n = (int)strspn(name, MODEL_NAME);

    return model_blame(r, "no `let`%s says what $%.*s is%s%s",
                       strcmp(r->s->name, "let") == 0 || r->tail ? " above" : "",
                       n < 60 ? n : 60, name, r->let_of.count ? ", expected one such as $" : "",
                       model_nearest_of(r, &r->let_of, name));
}

/* ----------------------------------------------------------------------------------- arithmetic */

typedef struct {
    model_reader *r;
    const char *text, *at;      /* all of it, for messages; what comes next */
    int depth, pi;              /* pi: whether it stands there, but as a divisor */
} formula;

static double sum(formula *f);

static double blame_formula(formula *f, const char *what)
{
    const char *form = *f->at ? "%s at '%.30s' in '%.80s'" : "%s at the end%s of '%.80s'";

    model_blame(f->r, form, what, f->at, f->text);
    return 0;
}

/* Takes the next letter if it is one of these, after blanks; after an error there is none. */
static char take(formula *f, const char *letters)
{
    f->at += strspn(f->at, " \t");
    return !f->r->p->status && *f->at && strchr(letters, *f->at) ? *f->at++ : 0;
}

static const double DEGREE = 3.14159265358979323846 / 180;

/* Multiples of 90 degrees have their exact values. */
static double sine(double x) { return fmod(x, 180) == 0 ? 0 : sin(x * DEGREE); }
static double cosine(double x) { return fmod(fabs(x), 180) == 90 ? 0 : cos(x * DEGREE); }
static double tangent(double x) { return sine(x) / cosine(x); }
static double arc_sine(double x) { return asin(x) / DEGREE; }
static double arc_cosine(double x) { return acos(x) / DEGREE; }
static double arc_tangent(double x) { return atan(x) / DEGREE; }

/* A function of one number; or of two and more, pair by pair. */
typedef struct { const char *name; double (*one)(double), (*two)(double, double); } function;

static const function functions[] = {
    { "sqrt", sqrt, NULL }, { "sin", sine, NULL }, { "cos", cosine, NULL },
    { "tan", tangent, NULL }, { "asin", arc_sine, NULL }, { "acos", arc_cosine, NULL },
    { "atan", arc_tangent, NULL }, { "abs", fabs, NULL }, { "floor", floor, NULL },
    { "min", NULL, fmin }, { "max", NULL, fmax },
};

/* The numbers in its parentheses, whose first is taken. */
static double call(formula *f, const function *of)
{
    const int pi = f->pi;
    double x = (f->pi = 0, sum(f));
    int numbers = 1;

    if (f->pi && (of->one == sine || of->one == cosine || of->one == tangent) && fabs(x) < 7)
        model_note(f->r, "warning: %s of %g, with pi: angles are in degrees", of->name, x);
    f->pi |= pi;
    for (; take(f, ","); numbers++) {
        const double y = sum(f);
        x = of->two ? of->two(x, y) : x;
    }
    const char *why = !take(f, ")") ? "an operator or ) is missing"
                    : of->one && numbers > 1 ? "one number too many"
                    : of->two && numbers < 2 ? "a second number is missing" : NULL;
    return why ? blame_formula(f, why) : of->one ? of->one(x) : x;
}

static double name(formula *f)
{
    const size_t letters = strcspn(f->at, "+-*/^(),$ \t");
    const function *of = NULL;
    size_t n;

    for (const function *k = functions; k < functions + LENGTH(functions); k++)
        if (strlen(k->name) == letters && strncmp(k->name, f->at, letters) == 0)
            of = k;
    if (of && f->at[letters + strspn(f->at + letters, " \t")] == '(') {
        f->at += letters;
        return take(f, "("), call(f, of);
    }
    const char *value = find_value(f->r, f->at, &n);
    if (value)
        return f->at += n, strtod(value, NULL);
    if (letters == 2 && strncmp(f->at, "pi", 2) == 0)
        return f->pi |= f->at == f->text || f->at[-1] != '/', f->at += 2, acos(-1);
    if (of)
        return blame_formula(f, "a function without its (");
    if (f->at[letters] == '(')
        return blame_formula(f, "no function is called so (there are sqrt sin cos tan asin acos "
                                "atan abs floor min max), or a * is missing,");
    return blame_name(f->r, f->at);
}

static double primary(formula *f)
{
    char *end;

    if (take(f, "(")) {
        const double x = sum(f);
        return take(f, ")") ? x : blame_formula(f, "an operator or ) is missing");
    }
    take(f, "$");
    if (isalpha((unsigned char)*f->at) || *f->at == '_')
        return name(f);
    if (!isdigit((unsigned char)*f->at) && *f->at != '.')
        return blame_formula(f, "a number is missing");
    const double x = strtod(f->at, &end);
    if (end == f->at || memchr(f->at, 'x', (size_t)(end - f->at)))
        return blame_formula(f, "not a number");
    f->at = end;
    return x;
}

static double factor(formula *f)
{
    const char sign = take(f, "+-");

    if (++f->depth > DEEPEST)
        return blame_formula(f, "too many parentheses or signs");
    double x = sign ? factor(f) : primary(f);
    if (!sign && take(f, "^"))
        x = pow(x, factor(f));
    f->depth--;
    return sign == '-' ? -x : x;
}

static double product(formula *f)
{
    double x = factor(f);

    for (char c; (c = take(f, "*/")); )
        x = c == '*' ? x * factor(f) : x / factor(f);
    return x;
}

static double sum(formula *f)
{
    double x = product(f);

    for (char c; (c = take(f, "+-")); )
        x = c == '+' ? x + product(f) : x - product(f);
    return x;
}

/* The value of the $(...) that the text begins with, as text, and its length. */
static const char *evaluate(model_reader *r, const char *text, char number[NUMBER_ROOM], size_t *n)
{
    formula f = { r, text, text + 1, 0, 0 };
    const double x = primary(&f) + 0.0;         /* -0 is 0 */

    if (!isfinite(x))
        model_blame(r, "'%.80s' has no value, it is %s", text, isnan(x) ? "no number" : "infinite");
    snprintf(number, NUMBER_ROOM, "%.15g", x);
    *n = (size_t)(f.at - text);
    return r->p->status ? NULL : number;
}

/* ------------------------------------------------------------------------- a word, a statement */

/* So many more bytes are taken. */
static int grow(model_reader *r, size_t bytes)
{
    return (r->grown += (double)bytes) <= MOST_BYTES
           || model_blame(r, "the values of numbers take more than %d bytes, expected less",
                          MOST_BYTES);
}

/* The word with the value in place of each piece $NAME or $(...); NULL after an error. glued: it
 * has several pieces, but for a sign or %, and is no number. */
static char *expand(model_reader *r, char *word, int *glued)
{
    char number[NUMBER_ROOM], *text = NULL;
    int pieces = 0, letters = 0;

    *glued = 0;
    if (!strchr(word, '$'))
        return word;
    for (const char *from = word; *from; ) {
        const char *value = from;
        size_t n = strcspn(from, "$"), length = n;
        if (n == 0) {
            value = from[1] == '(' ? evaluate(r, from, number, &n) : find_value(r, ++from, &n);
            if (!value)
                return r->p->status ? NULL : (blame_name(r, from), NULL);
            length = strlen(value);
        }
        from += n;
        pieces += length != 1 || !strchr("+-%", *value);
        if (!grow(r, length))
            return NULL;
        while (length-- > 0)
            model_add(r, &text, &letters, 1, value++);
    }
    model_add(r, &text, &letters, 1, "");
    *glued = pieces > 1;
    return r->p->status ? NULL : text;
}

/* Adds the statement with its words as they are now; it is then the one in hand. */
static int add_statement(model_reader *r, const model_statement *source)
{
    model_statement s = *source;

    s.at.round = r->round;
    s.stage = r->stage;
    s.first = r->words;
    if (!model_add(r, &r->statement, &r->statements, sizeof s, &s))
        return 0;
    r->s = &r->statement[r->statements - 1];
    r->next = r->ahead = 0;
    if (r->round && ++r->repeated > MOST_REPEATED)
        return model_blame(r, "repetitions make more than %d statements, expected fewer",
                           MOST_REPEATED);
    for (int k = 0; k < s.n; k++) {
        model_given w = { .source = r->cut_word[source->first + k] };
        w.text = expand(r, w.source, &w.glued);
        model_add(r, &r->word, &r->words, sizeof w, &w);
    }
    return !r->p->status;
}

/* ----------------------------------------------------------------------------- let, repeat, end */

static int is(const model_statement *s, const char *word) { return strcmp(s->name, word) == 0; }
static int opens(const model_statement *s) { return is(s, "repeat") || is(s, "stage"); }

static int blame_twice(model_reader *r, const char *word)
{
    return model_blame(r, "'%.60s' for the second time in one round, expected a new name", word);
}

/* In a round: changes the number of that name outside, or keeps one with a number in its name, or
 * is the round's. */
static int set_number(model_reader *r, const char *word, int at)
{
    const int old = model_find(&r->let_of, word);
    const model_local l = { word, r->word[at].text, 0 };
    model_local *own = find_local(r, word);

    if (own && (own->counts || own - r->local >= r->own))
        return blame_twice(r, word);
    if (own)
        return own->value = l.value, 1;
    if (old >= 0)
        return r->word[old].text = r->word[at].text, 1;
    return strchr(r->word[at - 1].source, '$') ? model_enter(r, &r->let_of, word, at)
                                               : model_add(r, &r->local, &r->locals, sizeof l, &l);
}

/* The number is the word behind the name, or that of the command line in its place. */
static int read_let(model_reader *r)
{
    const char *word = r->round ? model_name(r) : model_new_name(r, &r->let_of);
    const size_t n = word ? strlen(word) : 0;
    const int at = r->s->first + r->next;
    double x;

    for (int k = 0; k < r->lets && n > 0 && !r->round && model_look(r); k++)
        if (strncmp(r->let[k], word, n) == 0 && r->let[k][n] == '=') {
            if (strcmp(r->word[at].source, "-d or --find") == 0)
                return model_fail(r, r->s->at, "-d or --find give '%.60s' twice", word);
            r->word[at].source = "-d or --find";
            r->word[at].text = expand(r, r->let[k] + n + 1, &r->word[at].glued);
        }
    if (!word || !model_number(r, &x) || !model_at_end(r))
        return 0;
    return r->round ? set_number(r, word, at) : model_enter(r, &r->let_of, word, at);
}

/* The `end` of the `repeat` or `stage` at k; -1: there is none. */
static int find_end(const model_reader *r, int k)
{
    for (int open = 0; k < r->cuts; k++) {
        open += opens(&r->cut[k]) - is(&r->cut[k], "end");
        if (open == 0)
            return k;
    }
    return -1;
}

static int walk(model_reader *r, int from, int to);

/* The statements between the `repeat` at `from` and its `end`, round by round. "i = 7, j = 2" of
 * the round is for messages; its last word is the value. */
static int repeat(model_reader *r, int from, int end)
{
    const char *outer = r->round;
    const int locals = r->locals, own = r->own;
    int low, high;

    add_statement(r, &r->cut[from]);
    const char *word = model_new_name(r, &r->let_of);
    if (word && find_local(r, word))
        return blame_twice(r, word);
    if (!word || !model_whole(r, "FROM", -INT_MAX / 2, &low)
        || !model_whole(r, "TO", -INT_MAX / 2, &high) || !model_at_end(r))
        return 0;
    if (++r->depth > DEEPEST_REPEAT)
        return model_blame(r, "more than %d times repeat in repeat, expected fewer",
                           DEEPEST_REPEAT);
    for (int i = low; i <= high; i++) {
        if (!(r->round = model_print(r, "%s%s%s = %d", outer ? outer : "", outer ? ", " : "", word,
                                     i)) || !grow(r, strlen(r->round)))
            return 0;
        const model_local l = { word, strrchr(r->round, ' ') + 1, 1 };
        r->own = locals;
        if (!model_add(r, &r->local, &r->locals, sizeof l, &l) || !walk(r, from + 1, end)
            || !add_statement(r, &r->cut[end]) || !model_at_end(r))
            return 0;
        r->locals = locals;
    }
    r->round = outer;
    r->own = own;
    r->depth--;
    return 1;
}

/* The statements from .. to-1; the `let`s above the first `repeat` have been read before. An `end`
 * is that of a stage. */
static int walk(model_reader *r, int from, int to)
{
    for (int k = from; k < to; k++) {
        const model_statement *s = &r->cut[k];
        const int end = is(s, "repeat") ? find_end(r, k) : k;
        if (r->stage && (is(s, "stage") || (is(s, "let") && !r->round)))
            return model_fail(r, s->at, "a %s in a stage, expected it before or behind the stage",
                              s->name);
        r->stage = is(s, "stage") ? ++r->p->stages : r->stage;
        if (is(s, "repeat") ? !repeat(r, k, end)
            : is(s, "let") ? (r->round || k + r->tail > r->cuts)
                             && (!add_statement(r, s) || !read_let(r))
            : !add_statement(r, s) || (is(s, "end") && !model_at_end(r)))
            return 0;
        r->stage = is(s, "end") ? 0 : r->stage;
        k = end;
    }
    return 1;
}

/* Reads each `let` above the first `repeat`. Each `repeat` and `stage` has its `end`. */
static int read_lets(model_reader *r)
{
    for (int k = 0; k < r->cuts; k++) {
        const model_statement *s = &r->cut[k];
        const int end = opens(s) ? find_end(r, k) : k;
        if (end < 0)
            return model_fail(r, s->at, "%s without its `end`, expected: %s", s->name, s->form);
        if (is(s, "end"))
            return model_fail(r, s->at, "this `end` closes no `repeat` and no `stage`");
        if (is(s, "let") && !r->tail && (!add_statement(r, s) || !read_let(r)))
            return 0;
        r->tail = r->tail == 0 && is(s, "repeat") ? r->cuts - end : r->tail;
        k = end;
    }
    return 1;
}

/* Each -d needs its let. */
static int check_given(model_reader *r)
{
    for (int k = 0; k < r->lets; k++) {
        char word[NAME_ROOM];
        snprintf(word, sizeof word, "%.*s", (int)strcspn(r->let[k], "="), r->let[k]);
        const int at = model_find(&r->let_of, word);
        if (at < 0 || strcmp(r->word[at].source, "-d or --find") != 0)
            return model_fail(r, r->whole, "'%.60s' of -d or --find, expected NAME=VALUE with a "
                              "name of a `let`%s%s", r->let[k], at >= 0 ? " outside of `repeat`"
                              : r->let_of.count ? ", such as " : "; the model has none",
                              at >= 0 ? "" : model_nearest_of(r, &r->let_of, word));
    }
    return 1;
}

int model_expand(model_reader *r) { return read_lets(r) && walk(r, 0, r->cuts) && check_given(r); }
