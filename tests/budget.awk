# budget.awk - how large the project is in lines of code, and how large it may be:
#     awk -f tests/budget.awk README.md FILE ...
#
# Lines are counted as cloc counts those of C, JavaScript, HTML, CSS, awk and the shell: a blank line
# and a line that holds a comment alone are none. A comment of C that begins in a string counts as
# one, if it has an end, and the lines that a comment joins are one. The words of the documents are
# counted, too. The sums must keep to their bounds, and the README must have the table that is made here.

# The last part of each sum, and the bound of the sum.
function set_bounds()
{
    parts = split("top base beyond cases program page tests doc", part, " ")
    name["top"] = "`bbm.h`, `bbm.c`, `contact.c`, `solver.c`"
    bound["top"] = 1350
    bound["base"] = 2800
    bound["beyond"] = 5300
    bound["program"] = 6800
    bound["tests"] = 16000
    bound["page"] = 1055
    says["base"] = " with the four files"
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

function check_readme(table,    line, text)
{
    while ((getline line < ARGV[1]) > 0)
        text = text line "\n"
    if (!index(text, table))
        fail(ARGV[1] ", Size, should have this table:\n" table)
}

BEGIN {
    set_bounds()
    for (k = 2; k < ARGC; k++) {
        folder = ARGV[k] ~ /\// ? substr(ARGV[k], 1, index(ARGV[k], "/") - 1) : "top"
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
    table = table "| words in `doc/*.md` | " words + 0 " | 33000 |\n"
    if (words > 33000)
        fail("doc/*.md: " words " words, at most 33000")
    check_readme(table)
    exit failed
}
