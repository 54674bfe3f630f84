# kept.awk - compares a table with what was kept of it: texts are the same, and numbers to a millionth
# of the largest in their column. Compilers differ by some 1e-9 of it.
BEGIN { FS = "," }
function is_number(x) { return x ~ /^-?[0-9.]+(e[-+]?[0-9]+)?$/ }
function size(x) { return x < 0 ? -x : x }
FNR == NR {
    kept[FNR] = $0
    lines = FNR
    for (k = 1; k <= NF; k++)
        if (is_number($k) && size($k) > most[NF, k])
            most[NF, k] = size($k)
    next
}
{
    same = split(kept[FNR], was, ",") == NF
    for (k = 1; k <= NF; k++)
        if (was[k] "" != $k "")
            same = same && is_number(was[k]) && is_number($k) && size(was[k] - $k) <= 1e-6 * most[NF, k]
    if (!same) {
        print name ": " $0 "\n    expected " kept[FNR]
        bad = 1
    }
}
END {
    if (FNR != lines)
        print name ": " FNR " lines, expected " lines
    exit bad || FNR != lines
}
