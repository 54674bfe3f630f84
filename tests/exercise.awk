# exercise.awk - the copy of a source with which an exercise begins; from the environment
#   NAME      the function whose body is taken out, or
#   FROM, TO  a piece of one line, and what stands there in its place.
# Fails, with the reason, unless that is in the source exactly once.
#
# A function begins in the first column with its type, and its body stands between two lines that
# are "{" and "}": the style of all sources here. The comment above it, which may hold the answer, goes
# with the body.

# An empty body; where something is returned, 0.
function empty(head)
{
    print "{"
    print "    /* Exercise: write the body of " ENVIRON["NAME"] ". */"
    if (head !~ /^(static )?void /)
        print "    return 0;"
    print "}"
}

BEGIN { name = ENVIRON["NAME"]; from = ENVIRON["FROM"]; to = ENVIRON["TO"] }

name != "" && inside { inside = $0 != "}"; next }
name != "" && head != "" && $0 == "{" {
    found++
    inside = 1
    print held
    empty(head)
    head = held = comment = ""
    next
}
name != "" && (/^\/\*/ || in_comment) && head == "" {
    comment = comment $0 "\n"
    in_comment = !/\*\/$/
    next
}
name != "" && /^[a-z]/ && index($0, name "(") && substr($0, index($0, name "(") - 1, 1) ~ /[ *]/ {
    head = $0
}
head != "" { held = held (held == "" ? "" : "\n") $0 }
/[;}]$/ || /^$/ {
    if (held != "")
        printf "%s%s\n", comment, held
    else
        printf "%s", comment
    skip = held != ""
    head = held = comment = ""
    if (skip)
        next
}
head != "" { next }
{ printf "%s", comment; comment = "" }

name == "" && (at = index($0, from)) {
    found++
    rest = substr($0, at + length(from))
    if (index(rest, from))
        found++
    $0 = substr($0, 1, at - 1) to rest
}

{ print }

END {
    if (found == 1)
        exit 0
    print FILENAME ": " (name != "" ? name : from) ": found " found + 0 " times, expected 1" > "/dev/stderr"
    exit 1
}
