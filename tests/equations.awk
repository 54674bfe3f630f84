# equations.awk - the tables "Eq., subject, function, test" of doc/paper.md and tests/beyond.md against the sources: each
# equation of the paper has one row, and stands as "(35)" in a formula before it; a function of the row
# cites it; each function of the row is defined in the file behind it, right under a comment that cites
# an equation of the row; each test of the row is there:
#     awk -f tests/equations.awk doc/paper.md tests/beyond.md SOURCES
#
# Each number stands as such, "(35)", in the comment of a function, so that a search finds the place. A
# citation is "Eq. (n)", and all that goes on behind it: "Eq. (18)-(23)", "Eq. (53), (60)-(62)",
# "Eq. (57) and (61)", "Eq. (58a-f)".

# The numbers that a text cites, as " 4 5 18 ".
function cited(text,    list, first, last)
{
    list = " "
    while (match(text, /Eq[.] \([0-9]+[-a-z]*\)/)) {
        text = substr(text, RSTART + 4)
        while (match(text, /^(, | and )?\([0-9]+[-a-z]*\)(-\([0-9]+[-a-z]*\))?/)) {
            first = last = substr(text, 1, RLENGTH)
            text = substr(text, RLENGTH + 1)
            sub(/^[^(]*\(/, "", first)
            sub(/.*\(/, "", last)
            for (first += 0; first <= last + 0; first++)
                list = list first " "
        }
    }
    return list
}

function fail(why)
{
    print "doc/paper.md: " why > "/dev/stderr"
    failed = 1
}

# A function of a row and its file: notes what its comment cites of the row.
function check_function(row, name, file,    n, number, found)
{
    if (!((file, name) in comment))
        fail(row ": " file " does not define " name)
    n = split(cited(row), number, " ")
    for (; n > 0; n--)
        if (index(cited(comment[file, name]), " " number[n] " ")) {
            found = 1
            noted[number[n]] += index(comment[file, name], "(" number[n] ")")
        }
    if (cited(row) != " " && !found)
        fail(row ": the comment of " name " in " file " cites none of it")
}

# "`f`, `g` (bbm.c), `h` (contact.c)": the names since the last file are in the next one.
function check_functions(row, column,    names, name, file, k, all)
{
    while (match(column, /`[^`]*`|\([a-z0-9\/_.]+\)/)) {
        file = substr(column, RSTART + 1, RLENGTH - 2)
        if (substr(column, RSTART, 1) == "`")
            name[++names] = file
        else
            for (; names > 0; names--) {
                check_function(row, name[names], file)
                all++
            }
        column = substr(column, RSTART + RLENGTH)
    }
    if (names > 0 || !all)
        fail(row ": functions and the file behind them are expected")
}

function check_tests(row, column,    all)
{
    for (; match(column, /`[^`]*`/); all++) {
        if (!(substr(column, RSTART + 1, RLENGTH - 2) in test))
            fail(row ": there is no test " substr(column, RSTART, RLENGTH))
        column = substr(column, RSTART + RLENGTH)
    }
    if (!all)
        fail(row ": no test")
}

BEGIN {
    if (cited("see (3); Eq. (4): k, Eq. (18)-(20), (22) and (58a-f)  ->  (30), Eq. (5).") != " 4 18 19 20 22 58 5 ")
        fail("citations are not read as they are meant")
}

# A table of equations begins with its head; a block of formulas has its numbers, "(20a)", in it.
FILENAME ~ /[.]md$/ {
    table = /^[|] Eq[.]/ || table && /^[|]/
    if (table && /^[|] / && !/^[|] Eq[.]/)
        line[++lines] = $0
    formula = /^```math/ || formula && !/^```/
    for (text = $0; formula && match(text, /\\ \([0-9]+/); text = substr(text, RSTART + RLENGTH))
        typeset[substr(text, RSTART + 3, RLENGTH - 3)] = 1
    next
}

# A comment counts for what follows in the next line.
/^\/[*]/ { text = ""; inside = 1 }
inside { text = text " " $0; inside = !/[*]\/$/; gsub(/ +[*]? +/, " ", text); below = FNR + 1; next }
/^START_TEST\(/ { sub(/^START_TEST\(/, ""); sub(/\).*/, ""); test[$0] = 1; next }
/^[a-z].*\(/ { head = $0; above = FNR == below ? text : "" }
head != "" && /;/ { head = "" }
head != "" && /{/ {
    sub(/\(.*/, "", head)
    sub(/.*[ *]/, "", head)
    comment[FILENAME, head] = above
    head = ""
}

END {
    for (k = 1; k <= lines; k++) {
        split(line[k], column, "|")
        row = "Eq." column[2]
        check_functions(row, column[4])
        check_tests(row, column[5])
        split(cited(row), number, " ")
        for (n in number)
            rows[number[n]]++
    }
    for (n = 1; n <= 72; n++)
        if (rows[n] != 1 || !noted[n])
            fail("Eq. (" n ") has " rows[n] + 0 " rows; it is " (noted[n] ? "" : "not ") "cited")
    for (n = 1; n <= 72; n++)
        if (!typeset[n])
            fail("no formula has the number (" n ")")
    exit failed
}
