# size.awk - how large the project is in lines of code, and how large it may be:
#     awk -f tests/size.awk FILE ...                       fails where a sum is above its bound
#     awk -v README=README.md -f tests/size.awk FILE ...   prints the README with the table of today
#
# Lines are counted as cloc counts those of C, JavaScript, HTML, CSS, awk and the shell: a blank line
# and a line that holds a comment alone are none. A comment of C that begins in a string counts as
# one, if it has an end, and the lines that a comment joins are one. The words of the documents are
# counted, too.

# The last part of each sum, and the bound of the sum.
function set_bounds()
{
    parts = split("paper base beyond cases program page tests doc", part, " ")
    name["paper"] = "the paper: `bbm.h`, `bbm.c`, `contact.c`, `solver.c`, `base/step.c`"
    name["base"] = "the rest of `base/`"
    bound["paper"] = 1100
    bound["base"] = 2950
    bound["beyond"] = 6580
    bound["program"] = 7275
    bound["page"] = 1650
    words_bound = 30000
    says["base"] = " with the paper"
    says["beyond"] = " with both: the library"
    says["program"] = " with `cases/`"
    begins["cases"] = begins["page"] = begins["tests"] = begins["doc"] = 1
}

function count_script(file,    line, n)
{
    while ((getline line < file) > 0)
        n += line ~ /^#!/ || line !~ /^[ \t]*(#|$)/
    close(file)
    return n + 0
}

# code: what is left of the lines that comments join; open: lines since a comment began.
function count_c(file,    line, code, inside, open, n)
{
    while ((getline line < file) > 0) {
        open += line ~ /[^ \t]/
        while (match(line, inside ? "[*]/" : "/[*]")) {
            if (!inside) {
                code = code substr(line, 1, RSTART - 1)
                open = 1
            }
            line = substr(line, RSTART + 2)
            inside = !inside
        }
        if (!inside) {
            n += (code line) ~ /[^ \t]/
            code = ""
        }
    }
    close(file)
    return n + (inside ? open : 0)
}

function fail(why)
{
    print why > "/dev/stderr"
    failed = 1
}

# The README with the table in the place of its own.
function print_readme(table,    line, inside)
{
    while ((getline line < README) > 0) {
        if (line ~ /^\| part \|/) {
            printf "%s", table
            inside = 1
        }
        inside = inside && line ~ /^\|/
        if (!inside)
            print line
    }
}

BEGIN {
    set_bounds()
    for (k = 1; k < ARGC; k++) {
        folder = ARGV[k] ~ /\// && ARGV[k] != "base/step.c" ? substr(ARGV[k], 1, index(ARGV[k], "/") - 1) : "paper"
        lines[folder] += ARGV[k] ~ /\.(awk|sh)$/ ? count_script(ARGV[k]) : count_c(ARGV[k])
    }
    table = "| part | lines | at most |\n|---|---|---|\n"
    for (k = 1; k <= parts; k++) {
        p = part[k]
        sum = lines[p] + (p in begins ? 0 : sum)
        title = p in name ? name[p] : "`" p "/`"
        most = p in bound ? bound[p] says[p] : ""
        table = table "| " title " | " lines[p] + 0 " | " most " |\n"
        if (p in bound && sum > bound[p])
            fail(title says[p] ": " sum " lines of code, at most " bound[p])
    }
    "cat doc/*.md | wc -w" | getline words
    table = table "| words in `doc/*.md` | " words + 0 " | " words_bound " |\n"
    if (words > words_bound)
        fail("doc/*.md: " words " words, at most " words_bound)
    if (README)
        print_readme(table)
    exit failed && !README
}
