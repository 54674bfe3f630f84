/* check_pictures.c - what the pictures show, read back from the SVG: that they are well formed,
 * that magnified displacements turn no element over, that blocks, arrows and texts stay where they
 * are to be, and that times, titles, hatching and tints are right. */
#define _POSIX_C_SOURCE 200809L
#include <glob.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "programs.h"

/* The number of an attribute of the element that begins at s; NaN: it has none. */
static double attribute(const char *s, const char *name)
{
    char form[40];

    snprintf(form, sizeof form, " %s=\"", name);
    const char *end = strchr(s, '>'), *found = strstr(s, form);
    return found && found < end ? strtod(found + strlen(form), NULL) : NAN;
}

static int has(const char *s, const char *what)
{
    const char *end = strchr(s, '>'), *found = strstr(s, what);

    return found && found < end;
}

typedef struct { double x, y; } point;

/* The points of a path one after the other, absolute; *new: one after M. Returns 0 at its end. An
 * arc counts as its end. */
static int next_point(const char **s, point *at, int *new)
{
    static char command;

    *new = 0;
    for (char *end;; (*s)++)
        if (strchr("MLAlmz", **s) && **s) {
            command = **s;
            *new |= command == 'M' || command == 'm';
            if (command == 'A')
                *s += strlen("A5 5 0 0 1");
        } else if (**s == '"' || **s == ';' || **s == '\0') {
            return 0;
        } else if (**s != ' ' && **s != '\n') {
            const int relative = command == 'l' || command == 'm';
            const double x = strtod(*s, &end), y = strtod(end, &end);
            *at = relative ? (point){ at->x + x, at->y + y } : (point){ x, y };
            *s = end;
            return 1;
        }
}

static const char *path_of(const char *s) { return strstr(s, " d=\"") + 4; }

/* ------------------------------------------------------------------------------ all pictures */

static glob_t pictures;

/* The pictures of the shipped models, twenty steps of each, and of a program. */
static void make_pictures(void)
{
    ck_assert_int_eq(shell("mkdir -p out/model; for m in cases/models/*.model; do "
                           "sed -e 's/steps [0-9][0-9]*/steps 20/' -e '/^expect/d' "
                           "-e 's|^mesh |mesh ../../cases/models/|' $m > out/model/drawn.model; "
                           "%s/bbm -q out/model/drawn.model "
                           "-o out/model/drawn-$(basename $m .model) "
                           "|| exit 1; done", BUILD), 0);
    ck_assert_int_eq(shell("mkdir -p out/model/programs/cases && cp cases/fem.csv out/model/programs/cases && "
                           "cd out/model/programs && ../../../%s/exp2 > drawn.log", BUILD), 0);
    ck_assert_int_eq(glob("out/model/drawn-*/*.svg", 0, NULL, &pictures), 0);
    ck_assert_int_eq(glob("out/model/programs/out/*/*.svg", GLOB_APPEND, NULL, &pictures), 0);
    ck_assert_int_gt((int)pictures.gl_pathc, 30);
}

static void forget_pictures(void) { globfree(&pictures); }

/* Each element that begins ends, in the right order. */
static void check_form(const char *path, const char *text)
{
    char open[30][20];
    int depth = 0;

    for (const char *s = strchr(text, '<'); s; s = strchr(s + 1, '<')) {
        const size_t n = strcspn(s + 1, " >/\n");
        const char *end = strchr(s, '>');
        ck_assert_msg(end && depth < 29, "%s: %.40s", path, s);
        if (s[1] == '/') {
            const char *last = depth > 0 ? open[--depth] : "";
            ck_assert_msg(*last && strncmp(last, s + 2, strlen(last)) == 0, "%s: %.40s ends <%s>", path, s, last);
        } else if (s[1] != '?' && end[-1] != '/') {
            snprintf(open[depth++], sizeof open[0], "%.*s", (int)n, s + 1);
        }
    }
    ck_assert_msg(depth == 0, "%s: <%s> has no end", path, depth > 0 ? open[depth - 1] : "");
    ck_assert_msg(!strstr(text, "nan") && !strstr(text, "inf ") && !strstr(text, "inf\""),
                  "%s: NaN or infinity", path);
    ck_assert_msg(!strstr(text, "&&") && !strstr(text, "& "), "%s: & is no XML", path);
}

typedef struct { double x, y, w, h; } box;

/* The frames of the panels: the rectangles of clipping paths. */
static int find_frames(const char *text, box frame[], int most)
{
    int n = 0;

    for (const char *s = strstr(text, "<clipPath"); s && n < most; s = strstr(s + 1, "<clipPath")) {
        const char *r = strstr(s, "<rect");
        frame[n++] = (box){ attribute(r, "x"), attribute(r, "y"), attribute(r, "width"), attribute(r, "height") };
    }
    return n;
}

static int is_in(const box *b, point p)
{
    return p.x >= b->x + 3 && p.x <= b->x + b->w - 3 && p.y >= b->y + 3 && p.y <= b->y + b->h - 3;
}

/* Every point of a list of paths, with ; between them, is in one of the frames, not at its edge. */
static void check_path(const char *path, const char *d, const box frame[], int n)
{
    do {
        point p = { 0, 0 };
        ck_assert_msg(strchr("M\"", *d), "%s: a path begins with %.10s", path, d);
        for (int new; next_point(&d, &p, &new); ) {
            int inside = 0;
            for (int k = 0; k < n; k++)
                inside |= is_in(&frame[k], p);
            ck_assert_msg(inside, "%s: (%g, %g) is outside the frame", path, p.x, p.y);
        }
    } while (*d++ == ';');
}

/* Arrows, supports and blocks that are not held, in all frames of a film. */
static void check_places(const char *path, const char *text)
{
    box frame[9];
    const int n = find_frames(text, frame, 9);

    for (const char *s = strstr(text, "<clipPath"); s; s = strstr(s + 1, "<"))
        if (strncmp(s, "<animate attributeName=\"d\"", 26) == 0)
            check_path(path, strstr(s, " values=\"") + 9, frame, n);
        else if (strncmp(s, "<path stroke-width", 18) == 0 || (strncmp(s, "<path", 5) == 0 && has(s, "fill=\"#")))
            check_path(path, path_of(s), frame, n);
}

typedef struct { box b; int time; char words[40]; } label;

/* A text's box from the number of its letters, 0.53 of their size wide on average. */
static label find_label(const char *s, double shift_x, double shift_y)
{
    const char *words = strchr(s, '>') + 1;
    const double given = attribute(s, "font-size"), size = isnan(given) ? 14 : given;
    label l = { { attribute(s, "x") + shift_x, attribute(s, "y") + shift_y - size, 0, size }, 0, "" };
    int letters = 0;

    for (const char *c = words; *c != '<'; c++)
        letters += (*c & 0xC0) != 0x80;
    snprintf(l.words, sizeof l.words, "%.*s", (int)strcspn(words, "<"), words);
    l.b.w = 0.53 * size * letters;
    l.b.x -= has(s, "middle") ? l.b.w / 2 : has(s, "\"end\"") ? l.b.w : 0;
    l.time = strncmp(words, "t = ", 4) == 0;
    return l;
}

/* Texts do not touch each other, but for the times of a film, and none leaves the page. */
static void check_labels(const char *path, const char *text)
{
    static label l[2000];
    double x = 0, y = 0;
    int n = 0;
    const char *svg = strstr(text, "<svg");

    for (const char *s = svg; s; s = strchr(s + 1, '<')) {
        const char *shift = strncmp(s, "<g transform=\"translate(", 24) ? NULL : s + 24;
        if (shift)
            ck_assert_int_eq(sscanf(shift, "%lf %lf", &x, &y), 2);
        else if (strncmp(s, "</g>", 4) == 0)
            x = y = 0;
        else if (strncmp(s, "<text", 5) == 0 && !has(s, "rotate") && n < 2000)
            l[n++] = find_label(s, x, y);
    }
    for (int i = 0; i < n; i++) {
        const box *a = &l[i].b;
        ck_assert_msg(a->x >= 0 && a->x + a->w <= attribute(svg, "width"),
                      "%s: '%s' leaves the page", path, l[i].words);
        for (int j = 0; j < i; j++) {
            const box *b = &l[j].b;
            const int apart = a->x + a->w < b->x || b->x + b->w < a->x || a->y + a->h <= b->y || b->y + b->h <= a->y;
            ck_assert_msg(apart || (l[i].time && l[j].time), "%s: '%s' touches '%s'", path, l[i].words, l[j].words);
        }
    }
}

/* The bar at the bottom of a film is full when the last frame, which is visible before, has come. */
static void check_bar(const char *path, const char *text)
{
    const char *id = strstr(text, " id=\"bar\""), *bar = id ? strstr(id, "values=\"0;") : NULL;
    double w[2] = { 0 }, full = 0, last = 0;

    for (const char *s = text; (s = strstr(s, "hidden\" keyTimes=\"0;")) != NULL; s++)
        last = fmax(last, strtod(strchr(s, ';') + 1, NULL));
    ck_assert_msg(bar && sscanf(bar, "values=\"0;%lf;%lf\" keyTimes=\"0;%lf;1\"", &w[0], &w[1], &full) == 3
                  && w[0] > 200 && w[0] == w[1] && full > last && full < 1,
                  "%s has no bar that is full at %g or later", path, last);
    ck_assert_msg(strstr(text, "onpointermove = drag") && strstr(text, ">arrow keys: step; Home, End, bar: go there<"),
                  "the bar of %s cannot be dragged", path);
}

START_TEST(pictures_are_well_formed_and_all_is_inside_and_no_texts_touch)
{
    int films = 0;

    for (size_t k = 0; k < pictures.gl_pathc; k++) {
        const char *path = pictures.gl_pathv[k];
        char *text = read_all(path);
        check_form(path, text);
        check_labels(path, text);
        if (strstr(text, "<clipPath"))
            check_places(path, text);
        if (strstr(text, "<animate")) {         /* it plays by itself, and can be stopped */
            ck_assert_msg(strstr(text, "pauseAnimations"), "%s cannot be stopped", path);
            check_bar(path, text);
            films++;
        }
        free(text);
    }
    ck_assert_int_gt(films, 5);
}
END_TEST

START_TEST(the_numbers_of_axes_do_not_touch)
{
    static const struct { double x, y, size; const char *unit; } at[] = {
        { 0, 0, 1e-3, "x [mm]" }, { 512345, 5401234, 40, "x [m]" }, { -0.5, 0, 0.9, "x [m]" },
        { 1e6, 1e6, 2e4, "x [km]" }, { 512345, 0, 0.3, "x [m]" },
    };
    const double x = at[_i].x, y = at[_i].y, size = at[_i].size;
    char model[LONG];

    snprintf(model, sizeof model, STEEL "node 1 %.9g %.9g\nnode 2 %.9g %.9g\nnode 3 %.9g %.9g\n"
             "element 1 b steel 1 2 3\nfix node 1\nfix node 2\nload node 3 1 0\nstatic\n"
             "output svg\n", x, y, x + size, y, x, y + size / 2);
    ck_assert_int_eq(run_text("axes", model), 0);
    char *text = read_all("out/model/axes/contacts.svg");
    check_labels("contacts.svg", text);
    free(text);
    check_text("out/model/axes/contacts.svg", at[_i].unit);
}
END_TEST

/* ------------------------------------------------------------------------------ displacements */

/* A ring around a hole, 2 m and 20 m wide, in rings that grow outwards by 10^0.1. Its wall is pulled inwards. */
#define RING "material rock E 1e10 nu 0.25 density 2500\nrepeat j 0 10\nlet r $(2*10^(j/10))\nrepeat i 0 31\n" \
    "node $(1 + i + 32*j) $(r*cos(11.25*i)) $(r*sin(11.25*i))\nend\nend\nrepeat i 321 352\nfix node $i\nend\n" \
    "repeat j 0 9\nrepeat i 1 32\nlet a $(i + 32*j)\nlet b $(a + 1 - 32*floor(i/32))\nlet c $(a + 32)\nlet d $(b + 32)\n" \
    "%send\nend\npressure box -2.1 -2.1 2.1 2.1 -1e7\nstatic\noutput svg\n"

static const char *const ring[] = { "element $a rock rock $a $c $d $b\n",  /* or the triangles of their diagonals */
                                    "element $a rock rock $a $c $d\nelement $(a + 1000) rock rock $a $d $b\n" };

/* Twice the area of a polygon, above 0 if it runs against the clock on the page, where y points
 * down; *next: the polygon behind it, or NULL. */
static double area_of(const char *d, const char **next)
{
    point first = { 0, 0 }, last = first, p = first;
    double area = 0;
    int new, n = 0;

    for (const char *s = d; *next = NULL, next_point(&s, &p, &new); n++, last = p) {
        if (new && n > 0) {
            *next = strchr(d + 1, 'M');
            break;
        }
        if (n == 0)
            first = p;
        else
            area -= last.x * p.y - p.x * last.y;
    }
    return area - (last.x * first.y - first.x * last.y);
}

START_TEST(no_element_is_turned_over_by_magnified_displacements)
{
    /* The wall of the tunnel comes inwards by p r (1 + nu) / E or so, 2.4 mm, in 40 m. */
    const char *next;
    int n = 0;

    ck_assert_int_eq(run_printed("tunnel", RING, ring[_i]), 0);
    char *text = read_all("out/model/tunnel/mises.svg"), *mesh = strstr(text, "stroke-opacity");
    ck_assert_ptr_nonnull(mesh);
    for (const char *s = path_of(mesh); s; s = next, n++)
        ck_assert_msg(area_of(s, &next) > 0, "element %d is turned over", n);
    ck_assert_int_eq(n, _i ? 640 : 320);
    const char *times = strstr(text, "displacements × ");
    ck_assert_ptr_nonnull(times);
    const double scale = strtod(times + strlen("displacements × "), NULL);
    const double wall = -cell("tunnel", "nodes.csv", "1,", "u");
    ck_assert_msg(wall > 1e-3 && scale * wall > 0.2 && scale * wall < 0.7,        /* of 2 m */
                  "the wall moves by %g m, drawn %g times", wall, scale);
    free(text);
}
END_TEST

/* ------------------------------------------------------------- times, titles, hatching, tints */

#define FALL STEEL "node 1 0 0\nnode 2 1 0\nnode 3 1 1\nelement 7 b steel 1 2 3\n" \
    "velocity b 1 0\noutput svg\n"

START_TEST(a_picture_says_its_title_and_the_time_that_it_shows)
{
    static const struct { const char *model, *said; } call[] = {
        { "dynamic dt 0.015 steps 100\n", ">t = 1.5 s<" },
        { "dynamic dt 0.5 steps 2\n", ">t = 1 s<" },
        { "dynamic dt 0.001 steps 1234\n", ">t = 1.234 s<" },
        { "dynamic dt 1e-4 steps 3\n", ">t = 0.0003 s<" },
        { "dynamic dt 0.1 steps 2\ntitle Böschung, 坡\n", ">Böschung, 坡<" },
        { "dynamic dt 0.1 steps 2\ntitle B\xF6schung\n", ">B&#246;schung<" },      /* Latin-1 */
        { "dynamic dt 0.1 steps 2\ntitle a < b & c > d\n", ">a &#60; b &#38; c &#62; d<" },
        { "dynamic dt 0.1 steps 2\ntitle \xE4\xA0 \xC0\xAF\n", ">&#228;&#160; &#192;&#175;<" },
    };
    char model[LONG];

    snprintf(model, sizeof model, FALL "%s", call[_i].model);
    ck_assert_int_eq(run_text("titled", model), 0);
    check_text("out/model/titled/mises.svg", call[_i].said);
    check_text("out/model/titled/contacts.svg", call[_i].said);
    for (int k = 0; k < 2 && _i > 3; k++)
        check_text(k ? "out/model/titled/movie.svg" : "out/model/titled/history.svg", call[_i].said);
    if (_i == 3)
        check_text("out/model/titled/movie.svg", ">0.00015 × real speed<");   /* 3e-4 s in 3/9 of 6 s */
}
END_TEST

/* Displacements that are drawn ten times as large are those under ten times the gravity. */
START_TEST(a_film_magnifies_displacements_if_it_is_asked_to)
{
    static const char *const fall = STEEL "block a steel 0 0 1 0 1 1 0 1\ngravity 0 -%d\n"
                                    "dynamic dt 0.1 steps 5\noutput every 1 svg%s\n";
    char *film[2], text[LONG];

    for (int k = 0; k < 2; k++) {
        snprintf(text, sizeof text, fall, k ? 10 : 1, k ? "" : " scale 10");
        ck_assert_int_eq(run_text("larger", text), 0);
        film[k] = read_all("out/model/larger/movie.svg");
        ck_assert_int_eq(strstr(film[k], ">displacements × 10<") != NULL, k == 0);
        char *way = strstr(film[k], "attributeName=\"d\"");
        ck_assert_ptr_nonnull(way);
        const size_t length = strcspn(way, "/");
        memmove(film[k], way, length);
        film[k][length] = '\0';
    }
    ck_assert_str_eq(film[0], film[1]);
    free(film[0]);
    free(film[1]);
}
END_TEST

/* The colours of the bar, band by band. */
static int find_bands(const char *text, char band[][8])
{
    int n = 0;

    for (const char *s = strstr(text, "<clipPath"); (s = strstr(s + 1, "<rect")) != NULL; )
        if (has(s, "fill=\"#"))
            snprintf(band[n++], 8, "%s", strstr(s, "fill=") + 6);
    return n;
}

/* 200 blocks at 1, 2, ..., 200 m/s and one at 10 km/s fly for 1 ms: a hundredth of the ways is beyond the colours, which
 * are from 0 to 0.2 m, or 2 m. The last of three frames is repeated. */
#define FLYING STEEL "repeat i 1 201\nblock b$i steel $(9*i) 0 $(9*i + 8) 0 $(9*i) 8\nvelocity b$i $(i + 9799*floor(i/201)) 0\n" \
    "end\ndynamic dt 5e-4 steps 2\noutput film field u"

START_TEST(a_film_has_the_colours_of_its_field_and_one_large_value_does_not_dim_them)
{
    const int wide = _i ? 400 : 40;
    char band[30][8];

    ck_assert_int_eq(run_text("flying", _i ? FLYING " low 0 high 2\n" : FLYING "\n"), 0);
    char *text = read_all("out/model/flying/movie.svg");
    const char *s = text;
    ck_assert_int_eq(find_bands(text, band), 10);
    for (int i = 1; i <= 201; i++) {
        s = strstr(strstr(s, "\"fill\" calcMode=\"discrete\""), "values=") + 8;
        for (int k = 0; k < 9; k++) {
            const int b = (k < 2 ? k : 2) * (i > 200 ? 10000 : i) / wide;
            ck_assert_msg(strncmp(s + 8 * k, band[b < 9 ? b : 9], 7) == 0, "block %d: %.72s, band %d", i, s, b);
        }
    }
    free(text);
    check_text("out/model/flying/movie.svg", _i ? ">u [m], from 0.000 to 10.000<" : ">u [m], from 0.0000 to 10.0000<");
}
END_TEST

static int times(const char *text, const char *what)
{
    int n = 0;

    for (const char *s = strstr(text, what); s; s = strstr(s + 1, what))
        n++;
    return n;
}

/* The blocks of FLYING move by 0.1 to 0.2 m and 10 m. */
START_TEST(a_bar_has_an_arrow_at_each_end_beyond_which_there_are_values)
{
    static const char *const flying[3] = { FLYING " low 0 high 20\n", FLYING " low 2 high 20\n", FLYING " low 2 high 4\n" };

    ck_assert_int_eq(run_text("flying", flying[_i]), 0);
    char *text = read_all("out/model/flying/movie.svg");
    ck_assert_int_eq(times(text, "class=\"beyond\""), _i);
    free(text);
}
END_TEST

/* How often something stands in a picture of a shipped model. */
static int count(const char *model, const char *what)
{
    char path[100];

    snprintf(path, sizeof path, "out/model/drawn-%s/contacts.svg", model);
    char *text = read_all(path);
    const int n = times(text, what);
    free(text);
    return n;
}

START_TEST(fixed_blocks_are_hatched_and_supports_and_loads_are_drawn)
{
    static const struct { const char *model; int hatched, fixed, roller, load, locked, sliding; } drawn[] = {
        { "exp1", 0, 1, 0, 1, 0, 0 }, { "exp2", 0, 0, 1, 1, 0, 0 }, { "exp3", 0, 1, 0, 1, 0, 1 },
        { "dam", 0, 1, 1, 0, 1, 1 }, { "disc", 0, 1, 1, 1, 0, 0 },
        { "incline", 1, 0, 0, 0, 0, 1 }, { "arch", 3, 0, 0, 0, 1, 0 },
    };

    for (size_t k = 0; k < sizeof drawn / sizeof *drawn; k++) {
        const char *name = drawn[k].model;
        ck_assert_int_eq(count(name, "<path fill=\"url(#held)\""), drawn[k].hatched);
        ck_assert_int_eq(count(name, ">fixed point<"), drawn[k].fixed);
        ck_assert_int_eq(count(name, ">fixed in one direction<"), drawn[k].roller);
        ck_assert_int_eq(count(name, ">load "), drawn[k].load);
        ck_assert_int_eq(count(name, "N, locked<"), drawn[k].locked);
        ck_assert_int_eq(count(name, "N, sliding<"), drawn[k].sliding);
        ck_assert_int_eq(count(name, ">contact force "), drawn[k].locked + drawn[k].sliding);
    }
    /* 4.268 m of water. */
    ck_assert_int_eq(count("water", ">water 41.9 kN/m<"), 1);
}
END_TEST

/* The ends of a path's first and last lines, in order; the number of its points. */
static int find_ends(const char *s, point *first, point *last)
{
    const char *d = path_of(s);
    point p = { 0, 0 };
    int n = 0;

    for (int new; next_point(&d, &p, &new); *last = p)
        *first = n++ ? *first : p;
    return n;
}

/* Of s in the direction of 30 degrees (s cos^2, s sin^2, s sin cos), of half of that as pressure, and of shear, in
 * which tension is at 45 degrees and pressure across it. The heads of an arrow are 1.6 widths long. */
START_TEST(crosses_have_the_directions_and_the_sizes_of_principal_stresses)
{
    static const struct { const char *colour; int arrow; double angle, size; } cross[] = {
        { "#cc3311\" m", 1, 30, 1 }, { "#004488\" m", 1, 30, 0.5 }, { "#cc3311\" m", 2, 45, 1 }, { "#004488\" m", 2, 135, 1 },
    };
    double length[4];

    ck_assert_int_eq(run_text("crosses", STEEL "let c $(sqrt(3)/4)\nrepeat i 1 3\ngrid b$i steel $(3*i) 0 $(3*i + 2) 2 1 1\n"
                              "end\nstress b1 0.75e6 0.25e6 $(1e6*c)\nstress b2 -0.375e6 -0.125e6 $(-0.5e6*c)\n"
                              "stress b3 0 0 1e6\ndynamic dt 1e-9 steps 1\noutput svg field principal\n"), 0);
    char *text = read_all("out/model/crosses/principal.svg");
    for (int i = 0; i < 4; i++) {
        const char *s = strstr(strstr(text, "<clipPath"), cross[i].colour);
        point a, b;
        for (int k = 0; k < cross[i].arrow; k++)
            s = strstr(s + 1, "<path");
        ck_assert_int_eq(find_ends(s, &a, &b), 2);
        length[i] = hypot(b.x - a.x, b.y - a.y) + 2 * 1.6 * attribute(s, "stroke-width");
        ck_near(fmod(atan2(a.y - b.y, b.x - a.x) * 180 / acos(-1) + 360, 180), cross[i].angle, 180, 1e-3);
        ck_near(length[i] / length[0], cross[i].size, 1, 1e-2);
    }
    free(text);
    check_text("out/model/crosses/principal.svg", ">tension 1 MPa<");
}
END_TEST

/* Of 400 elements in 2 x 2 m that are 40 pixels wide those have crosses that are 12 pixels apart; beside them one of
 * more than twice the stress has, and one of the same has none. */
START_TEST(crosses_do_not_lie_on_each_other)
{
    ck_assert_int_eq(run_text("graded", STEEL "grid a steel 0 0 2 2 20 20\ngrid b steel 10 0 40 30 3 3\nstress * -1e6 -2e6 0\n"
                              "block c steel 2.2 0 2.3 0 2.3 0.1 2.2 0.1\nblock d steel 2.2 1.2 2.3 1.2 2.3 1.3 2.2 1.3\nstress d -3e6 -5e6 0\n"
                              "dynamic dt 1e-9 steps 1\noutput svg field principal\n"), 0);
    char *text = read_all("out/model/graded/principal.svg"), *s = strstr(strstr(text, "<clipPath"), "\"#004488\" m");
    *strstr(s, "</g>") = '\0';
    const int arrows = times(s, "<path");
    ck_assert_int_eq(arrows, 2 * (9 + 4 + 1));
    free(text);
}
END_TEST

/* A square of 39 kN that is loaded above its left corner by as much again: the corners carry 58.5 and
 * 19.5 kN. Turned round it hangs from bonded contacts. The widest arrow has 6 pixels; two digits. */
START_TEST(an_arrow_is_as_wide_as_its_force_and_lies_on_both_sides_of_its_corner)
{
    static const char *const load[] = { "gravity 0 -10\nload at 0 1 of b 0 -39000\ncontact friction 30\n",
                                        "gravity 0 10\nload at 0 1 of b 0 39000\ncontact friction 30 tension 1e9\n" };
    double width[2] = { 0, 0 };
    char model[LONG];

    snprintf(model, sizeof model, "material steel E 2e11 nu 0 density 3900\nblock table steel -1 -1 2 -1 2 0 -1 0\n"
             "block b steel 0 0 1 0 1 1 0 1\nfixblock table\ndynamic dt 0.01 steps 2 settle 50\noutput svg\n%s",
             load[_i]);
    ck_assert_int_eq(run_text("carried", model), 0);
    char *text = read_all("out/model/carried/contacts.svg");
    const char *s = strstr(strstr(text, "<clipPath"), "marker-start"), *block = strstr(text, "<path fill=\"#");
    for (int k = 0; k < 2; k++) {
        point a, b, p = { 0, 0 };
        int new, found = 0;
        s = strstr(s + 1, "<path");
        ck_assert_int_eq(find_ends(s, &a, &b), 2);
        width[k] = attribute(s, "stroke-width");
        for (const char *d = path_of(block); next_point(&d, &p, &new); )
            found |= hypot(p.x - (a.x + b.x) / 2, p.y - (a.y + b.y) / 2) < 0.1;
        ck_assert_msg(found, "the middle of arrow %d is no corner", k);
    }
    ck_near(fmax(width[0], width[1]), 6, 6, 0.01);
    ck_near(fmin(width[0], width[1]), 2, 6, 0.01);
    free(text);
    check_text("out/model/carried/contacts.svg",
               _i ? ">contact force 58.5 kN, pulling<" : ">contact force 58.5 kN, locked<");
}
END_TEST

/* A block of the weight W = 10 kN on another one is pushed by 5 kN at their joint: there the force goes
 * through the middle, and at the foot of the lower one, 1 m below, 5 kN 1 m/(2 W) = 0.25 m beside it.
 * The line leans by that much in 1 m, to what an element of E = 1e11 Pa and 0.01 pixels leave. The
 * upper one, which one block touches, has no line, and nor has the film. */
START_TEST(the_line_of_thrust_goes_through_the_points_where_forces_act)
{
    point a, b;

    ck_assert_int_eq(run_text("thrust", "material m E 1e11 nu 0 density 1000\nblock base m -1 -1 2 -1 2 0 -1 0\n"
                              "block low m 0 0 1 0 1 1 0 1\nblock high m 0 1 1 1 1 2 0 2\nfixblock base\n"
                              "contact friction 60\ngravity 0 -10\nload box -1 1 2 1 of high 5000 0\n"
                              "dynamic dt 0.01 steps 2 settle 50\noutput svg\n"), 0);
    char *text = read_all("out/model/thrust/contacts.svg");
    const char *line = strstr(strstr(text, "<clipPath"), "\"#ee7733\"");
    ck_assert_int_eq(find_ends(line, &a, &b), 2);
    ck_near((a.x - b.x) / (a.y - b.y), 0.25, 0.25, 1e-3);
    ck_assert_ptr_null(strstr(line + 1, "\"#ee7733\""));
    free(text);
    check_text("out/model/thrust/contacts.svg", ">line of thrust<");
    text = read_all("out/model/thrust/movie.svg");
    ck_assert_ptr_null(strstr(text, "line of thrust"));
    free(text);                         /* columns and stones that lean on each other; in a wall it would end */
    ck_assert_int_eq(run_text("thrust", "material m E 1e10 nu 0.2 density 2500\nblock base m -1 -1 5 -1 5 0 -1 0\n"
                              "block l m 0 0 1 0 1 2 0 2\nblock r m 3 0 4 0 4 2 3 2\nblock s m 0 2 2 2 2 2.5 0 2.5\n"
                              "block t m 2 2 4 2 4 2.5 2 2.5\nfixblock base\nload at 2 2.5 of s 0 -1e4\ngravity 0 -10\n"
                              "contact friction 35\ndynamic dt 0.005 steps 20 settle 40\noutput svg\n"), 0);
    text = read_all("out/model/thrust/contacts.svg");
    ck_assert(times(text, "\"#ee7733\"") == 5 && count("wall", "line of thrust") + count("tilt", "line of thrust") == 0);
    free(text);
}
END_TEST

/* u = t: the curve ends in the middle of its band, whose height is a fifth of the way. Every fourth
 * step of 3001 has a point, and the last one. */
START_TEST(the_history_has_all_curves_and_the_band_in_which_a_monitor_is_to_end)
{
    static const char *const said[] = { ">p<", ">u<", ">v<", ">u expected, 1.35 to 1.65 m<", ">to stay, -20 to 20 m<", ">Energies<", ">kinetic<",
        ">elastic<", ">springs<", ">external<", ">gained<" };
    point first, last, low, high;

    ck_assert_int_eq(run_printed("told", FALL "dynamic dt 0.0005 steps 3001\nmonitor p node 2\ntitle %0120d\n"
                                 "expect p u 1.5 within 0.15\nexpect p stays by 20\n", 0), 0);
    char *text = read_all("out/model/told/history.svg"), *s = strstr(text, "stroke-width=\"1.8\"");
    for (size_t k = 0; k < sizeof said / sizeof *said; k++)
        ck_assert_msg(strstr(text, said[k]), "no %s", said[k]);
    ck_assert_int_eq(find_ends(strstr(s, "<path"), &first, &last), 752);
    ck_assert_int_eq(find_ends(strstr(strstr(s, "stroke-width=\"0.6\""), "<path"), &low, &high), 4);
    ck_near((low.y + high.y) / 2, last.y, fabs(last.y - first.y), 0.002);
    ck_near((low.y - high.y) / (first.y - last.y), 0.2, 1, 0.002);
    ck_near(high.x, first.x, last.x - first.x, 1e-3);
    s = strstr(strstr(strstr(s, "stroke-width=\"0.6\"") + 1, "stroke-width=\"0.6\""), "<path");
    ck_assert_int_eq(find_ends(s, &low, &high), 4);
    ck_assert(low.y - high.y < 200 && first.y - last.y > (low.y - high.y) / 2);
    check_labels("history.svg", text);
    free(text);                         /* a curve that is flat leaves its band: 10 mm */
    ck_assert_int_eq(run_text("told", STEEL "block b steel 0 0 1 0 1 1 0 1\nfixblock b\nblock c steel 9 0 10 0 10 1 9 1\n"
                              "monitor p at 0 0\nexpect p stays by 0.01\ndynamic dt 0.1 steps 2\noutput svg\n"), 0);
    check_text("out/model/told/history.svg", ">displacement [mm]<");
    ck_assert_int_eq(run_text("told", FALL "dynamic dt 0.1 steps 2\n"), 0);
    text = read_all("out/model/told/history.svg");
    ck_assert(!strstr(text, "displacement") && strstr(text, ">Energies<"));
    free(text);                         /* statics of several steps, and of one */
    ck_assert_int_eq(shell("cd out/model && [ -f drawn-dam/history.svg ] && ! [ -f drawn-exp1/history.svg ]"), 0);
}
END_TEST

START_TEST(a_field_that_is_one_level_has_one_colour_and_large_forces_are_short)
{
    ck_assert_int_eq(run_text("even", "material a E 1e9 nu 0.25 density 1\ngrid a a 0 0 4 2 4 2\n"
                              "fix set a.left x\nfix at 0 0 y\ntraction set a.right 1e6 0\nstatic\n"
                              "output svg field sxx\n"), 0);
    char *text = read_all("out/model/even/sxx.svg");
    ck_assert_int_eq(times(text, "stroke-width=\"0.6\" d=\"M"), 1);
    free(text);
    ck_assert_int_eq(run_text("even", "material a E 1e12 nu 0.25 density 1\ngrid a a 0 0 4 2 4 2\n"
                              "fix set a.left\nload at 4 1 0 -2.5e9\nstatic\noutput svg\n"), 0);
    check_text("out/model/even/contacts.svg", ">load 2.5 GN<");
}
END_TEST

/* Each row of the table of program/field.c, in colours of its own range or of one that is asked for; what an earlier run
 * drew goes. */
START_TEST(each_field_is_drawn_under_its_name_with_its_unit_and_range)
{
    static const struct { const char *field, *said; int status; } shown[] = {
        { "u", ">u [m], ", 0 }, { "v", ">v [m], ", 0 }, { "rotation", ">rotation [rad], ", 0 },
        { "sxx", ">sxx [Pa], from ", 0 }, { "syy", ">syy [", 0 }, { "sxy", ">sxy [", 0 },
        { "mises", ">von Mises stress [", 0 }, { "s1", ">s1 [", 0 }, { "s2", ">s2 [", 0 }, { "principal", ">tension ", 0 },
        { "vx", ">vx [m/s], ", 0 }, { "vy", ">vy [m/s], ", 0 }, { "spin", ">spin [rad/s], ", 0 },
        { "sxx low -2e6 high 3e6", ">sxx [MPa], from 0.007 to ", 0 }, { "u low 3", "colours from 3 to 0", 2 },
        { "u low 3 high 3", "colours from 3 to 3, expected low below high", 2 },
    };
    char model[LONG], path[100];

    snprintf(model, sizeof model, STEEL "grid a steel 0 0 2 1 2 1\nvelocity a 3 4 2\n"
             "dynamic dt 0.1 steps 2\noutput svg field %s\n", shown[_i].field);
    ck_assert_int_eq(shell("rm -rf out/model/shown; mkdir -p out/model/shown; touch out/model/shown/spin.svg "
                           "out/model/shown/s1.svg"), 0);
    write_text("out/model/shown.model", model);
    ck_assert_int_eq(shell("%s/bbm -q out/model/shown.model -o out/model/shown 2> out/model/said", BUILD),
                     shown[_i].status);
    snprintf(path, sizeof path, "out/model/shown/%.*s.svg", (int)strcspn(shown[_i].field, " "), shown[_i].field);
    check_text(shown[_i].status ? "out/model/said" : path, shown[_i].said);
    ck_assert_int_eq(shell("[ $(ls out/model/shown/*.svg | wc -l) = %d ]", shown[_i].status ? 2 : 4), 0);
}
END_TEST

/* In a block that turns, a corner that one element has is the fastest, and the slowest, of all. */
START_TEST(a_field_of_elements_is_their_mean_at_a_node)
{
    static const char *const column[] = { "vx", "vy", "spin" };
    double from = 0, to = 0, mean[] = { 3, 4, 2 };

    ck_assert_int_eq(run_text("turned", STEEL "grid a steel 0 0 2 1 4 2\nvelocity a 3 4 2\n"
                              "dynamic dt 0.1 steps 2\noutput svg field vx\n"), 0);
    char *text = read_all("out/model/turned/vx.svg"), *range = strstr(text, "vx [m/s], from ");
    ck_assert_ptr_nonnull(range);
    ck_assert_int_eq(sscanf(range, "vx [m/s], from %lf to %lf", &from, &to), 2);
    for (int k = 0; k < 3; k++)         /* of opposite elements; the bonds swing by 1e-5 */
        ck_relative((cell("turned", "elements.csv", "1,", column[k]) + cell("turned", "elements.csv", "8,", column[k])) / 2,
                    mean[k], 1e-4);
    ck_relative(from, cell("turned", "elements.csv", "8,", "vx"), 1e-3); /* it has four digits */
    ck_relative(to, cell("turned", "elements.csv", "1,", "vx"), 1e-3);
    free(text);
}
END_TEST

/* Eight courses of so many bricks, 2 x 1 m, each course half a brick further than the one below. */
START_TEST(blocks_that_touch_have_other_tints)
{
    static struct { box b; char tint[8]; } block[300];
    int n = 0, touching = 0;

    ck_assert_int_eq(run_printed("bricks", "material m E 1e9 nu 0.2 density 2000\ncontact friction 30\nrepeat y 0 7\n"
                                 "repeat i 1 %d\nlet x $(2*i + y - 2*floor(y/2))\nblock b$y-$i m $x $y $(x + 2) $y "
                                 "$(x + 2) $(y + 1) $x $(y + 1)\nend\nend\ndynamic dt 0.001 steps 1\noutput svg\n", 3 + _i), 0);
    char *text = read_all("out/model/bricks/contacts.svg");
    for (const char *s = strstr(text, "<path"); s && n < 300; s = strstr(s + 1, "<path")) {
        if (!has(s, "<path fill=\"#") || has(s, "#ffffff"))
            continue;
        point p = { 0, 0 };
        int new;
        box b = { INFINITY, INFINITY, -INFINITY, -INFINITY };
        memcpy(block[n].tint, s + 12, 7);
        for (const char *d = path_of(s); next_point(&d, &p, &new); ) {
            b.x = fmin(b.x, p.x), b.y = fmin(b.y, p.y);
            b.w = fmax(b.w, p.x), b.h = fmax(b.h, p.y);
        }
        block[n++].b = (box){ b.x, b.y, b.w - b.x, b.h - b.y };
    }
    free(text);
    for (int i = 0; i < n; i++)
        for (int j = 0; j < i; j++) {
            const box *a = &block[i].b, *b = &block[j].b;
            const double x = fmin(a->x + a->w, b->x + b->w) - fmax(a->x, b->x);
            const double y = fmin(a->y + a->h, b->y + b->h) - fmax(a->y, b->y);
            if (x < -1 || y < -1 || (x < 1 && y < 1))
                continue;
            touching++;
            ck_assert_msg(strcmp(block[i].tint, block[j].tint), "blocks %d and %d are %s", i, j, block[i].tint);
        }
    ck_assert_int_eq(n, 8 * (3 + _i));
    ck_assert_int_gt(touching, 3 * n / 2);
}
END_TEST

/* Water 2 m deep presses with 19.6 kN/m at most, also on an edge that it does not cover. */
START_TEST(water_is_drawn_as_it_presses)
{
    ck_assert_int_eq(run_printed("wet", "material r E 1e9 nu 0.2 density 2500\nblock b r 0 %d 1 %d 1 %d 0 %d\n"
                                 "fix box 0 %d 1 %d\ngravity 0 -9.81\nwater box 0 0 0 9 %d\nstatic\noutput svg\n",
                                 _i, _i, _i + 3, _i + 3, _i + 3, _i + 3, _i + 2), 0);
    check_text("out/model/wet/contacts.svg", ">water 19.6 kN/m<");
    check_text("out/model/wet/mises.svg", ">water 19.6 kN/m<");
}
END_TEST

/* It rises from 0.9 m to 0.5 m deep, drawn as 0.8 m higher: 4.91 kN/m press in the end. */
START_TEST(water_is_drawn_as_deep_as_a_body_floats)
{
    ck_assert_int_eq(run_text("floated", "material r E 1e10 nu 0 density 500\nblock a r 0 0 4 0 4 1 0 1\nfix at 4 0 x\n"
                              "gravity 0 -9.81\nwater set a 0.9\nstatic\noutput svg scale 2\n"), 0);
    check_text("out/model/floated/contacts.svg", ">water 4.91 kN/m<");
    check_text("out/model/floated/mises.svg", ">water 4.91 kN/m<");
    check_text("out/model/floated/mises.svg", ">displacements × 2<");
}
END_TEST

/* A column sinks by rho g h^2/2E = 5e-5 m, which is enlarged as without the block, or by 5e-9 m. */
START_TEST(a_block_that_is_gone_does_not_move_far_and_rounding_is_not_enlarged)
{
    ck_assert_int_eq(run_printed("gone", "material r E 1e%d nu 0 density 2500\nblock b r 0 0 1 0 1 2 0 2\n"
                              "block far r 50 0 51 0 51 1 50 1\nfix box 0 0 51 0\ngravity 0 -9.81\nstatic\n"
                              "stage out remove far\nend\noutput svg\n", _i ? 13 : 9), 0);
    check_text("out/model/gone/mises.svg", _i ? ">displacements × 100000<" : ">displacements × 10000<");
}
END_TEST

/* A prop goes that is fixed as a whole, a support ends, a load begins; round caps would make a dot of the prop. */
START_TEST(a_film_of_stages_shows_what_is_fixed_in_each)
{
    ck_assert_int_eq(run_text("strike", "material r E 1e9 nu 0 density 2500\nblock prop r 0 0 1 0 1 1 0 1\n"
                              "block beam r 0 1 3 1 3 2 0 2\nfixblock prop\nfix at 3 2\ngravity 0 -9.81\n"
                              "dynamic dt 0.01 steps 2\nstage off steps 2 remove prop\nfix at 3 2 free\n"
                              "load at 0 2 1e5 0\nend\n"
                              "output svg\n"), 0);
    char *text = read_all("out/model/strike/movie.svg");
    ck_assert_ptr_nonnull(strstr(text, "<path fill=\"url(#held)\""));
    ck_assert_ptr_null(strstr(text, "stroke-linecap=\"round\""));
    int supported[5] = { 0 }, loaded[5] = { 0 }, n = 0;
    for (const char *s = text; (s = strstr(s, "<path fill=\"#ffffff\"")) && n < 5; s++) {
        const char *loads = strstr(s, "marker-end=\"url(#head0)\"");
        supported[n] = *path_of(s) == 'M';
        loaded[n++] = loads && strncmp(strchr(loads, '\n'), "\n<path", 6) == 0;
    }
    for (int k = 0; k < 5; k++)
        ck_assert(supported[k] == (k < 3) && loaded[k] == (k > 2));
    free(text);
}
END_TEST

/* The stone has moved over where its neighbour was: the outlines of the start lie below it. */
START_TEST(a_map_of_blocks_hides_where_they_were_and_says_that_stresses_are_means)
{
    ck_assert_int_eq(run_text("means", "material r E 1e9 nu 0 density 2500\nblock a r 0 0 1 0 1 1 0 1\n"
                              "block b r 1.1 0 2 0 2 1 1.1 1\nvelocity a 20 0\nvelocity b 20 0\n"
                              "grid c r 9 0 11 1 2 1\ndynamic dt 0.01 steps 2\noutput svg\n"), 0);
    char *text = read_all("out/model/means/mises.svg");
    const char *was = strstr(text, "stroke=\"#666666\"");
    ck_assert(was && strstr(was, "stroke-width=\"0.6\"") && strstr(text, ">stress of a block of one element: its mean<"));
    free(text);
}
END_TEST

Suite *pictures_suite(void)
{
    Suite *s = suite_create("pictures");
    TCase *t = new_case(s, "pictures");

    tcase_set_timeout(t, 120);
    tcase_add_unchecked_fixture(t, make_pictures, forget_pictures);
    tcase_add_test(t, pictures_are_well_formed_and_all_is_inside_and_no_texts_touch);
    tcase_add_loop_test(t, the_numbers_of_axes_do_not_touch, 0, 5);
    tcase_add_loop_test(t, no_element_is_turned_over_by_magnified_displacements, 0, 2);
    tcase_add_loop_test(t, a_picture_says_its_title_and_the_time_that_it_shows, 0, 8);
    tcase_add_test(t, a_film_magnifies_displacements_if_it_is_asked_to);
    tcase_add_loop_test(t, a_film_has_the_colours_of_its_field_and_one_large_value_does_not_dim_them, 0, 2);
    tcase_add_loop_test(t, a_bar_has_an_arrow_at_each_end_beyond_which_there_are_values, 0, 3);
    tcase_add_test(t, crosses_have_the_directions_and_the_sizes_of_principal_stresses);
    tcase_add_test(t, crosses_do_not_lie_on_each_other);
    tcase_add_loop_test(t, an_arrow_is_as_wide_as_its_force_and_lies_on_both_sides_of_its_corner, 0, 2);
    tcase_add_test(t, the_line_of_thrust_goes_through_the_points_where_forces_act);
    tcase_add_test(t, the_history_has_all_curves_and_the_band_in_which_a_monitor_is_to_end);
    tcase_add_test(t, a_field_that_is_one_level_has_one_colour_and_large_forces_are_short);
    tcase_add_loop_test(t, each_field_is_drawn_under_its_name_with_its_unit_and_range, 0, 16);
    tcase_add_test(t, a_field_of_elements_is_their_mean_at_a_node);
    tcase_add_test(t, fixed_blocks_are_hatched_and_supports_and_loads_are_drawn);
    tcase_add_loop_test(t, water_is_drawn_as_it_presses, 0, 2);
    tcase_add_test(t, water_is_drawn_as_deep_as_a_body_floats);
    tcase_add_loop_test(t, a_block_that_is_gone_does_not_move_far_and_rounding_is_not_enlarged, 0, 2);
    tcase_add_test(t, a_film_of_stages_shows_what_is_fixed_in_each);
    tcase_add_test(t, a_map_of_blocks_hides_where_they_were_and_says_that_stresses_are_means);
    tcase_add_loop_test(t, blocks_that_touch_have_other_tints, 0, 6);
    return s;
}
