# exercise.awk - the copy of a source with which an exercise begins; from the environment
#   NAME      the function whose body and comment are taken out, or
#   FROM, TO  a piece of one line, and what stands there in its place.
# Fails, with the reason, unless that is in the source exactly once.
#
# A function begins in the first column with its type, and its body stands between two lines that
# are "{" and "}": the style of all sources here. The comment above it, which may hold the answer,
# goes with the body.

# An empty body. What the function would set or return is NaN, not whatever number lies there.
function empty(rest,    word)
{
    print "{"
    print "    /* Exercise: write the body of " name ". */"
    while (match(rest, /double [A-Za-z]+\[[0-9]\]\[[0-9]\]|bbm_spring \*[a-z]/)) {
        split(substr(rest, RSTART, RLENGTH), word, /[] *[]+/)
        print "    memset(" word[2] ", 0xFF, sizeof" \
              (word[3] ? "(double[" word[3] "][" word[4] "])" : " *" word[2]) ");    /* NaN */"
        rest = substr(rest, RSTART + RLENGTH)
    }
    if (head ~ /^(static )?double /)
        print "    return NAN;"
    else if (head !~ /^(static )?void /)
        print "    return 0;"
    print "}"
}

# Prints the comment and the head that were held back.
function flush()
{
    printf "%s%s", comment, head
    comment = head = ""
}

BEGIN {
    name = ENVIRON["NAME"]; from = ENVIRON["FROM"]; to = ENVIRON["TO"]
    if (name != "")
        print "#include <string.h>"
}

name != "" && inside { inside = $0 != "}"; next }
name != "" && /^\/[*]/ { flush(); open = 1 }
open { comment = comment $0 "\n"; open = !/[*]\/$/; next }
name != "" && head != "" && $0 == "{" {
    found++
    inside = 1
    printf "%s", head
    empty(head)
    comment = head = ""
    next
}
name != "" && /^[a-z]/ && index($0, name "(") && substr($0, index($0, name "(") - 1, 1) ~ /[ *]/ {
    head = $0 "\n"
    next
}
head != "" && !/[;}]$/ && !/^$/ { head = head $0 "\n"; next }
{ flush() }

name == "" && (at = index($0, from)) {
    found++
    rest = substr($0, at + length(from))
    if (index(rest, from))
        found++
    $0 = substr($0, 1, at - 1) to rest
}

{ print }

END {
    flush()
    if (found == 1)
        exit 0
    print FILENAME ": " name from ": found " found + 0 " times, expected 1" > "/dev/stderr"
    exit 1
}
