# Calls between the files of the library go down: beyond, build, step, open_close, contact, detect, cut, solve, solver,
# order, bbm. Reads what `nm -A` says of the object files.
BEGIN {
    files = split("bbm order solver solve cut detect contact open_close step build", order)
    for (k = 1; k <= files; k++)
        rank[order[k]] = k
}

{
    split($0, part, ".o:")
    n = split(part[1], path, "/")
    file = path[n]
    room = path[n - 1]
    symbol = $NF
    sub(/^_/, "", symbol)
    if (symbol !~ /^bbm_/)
        next
    above = room == "beyond"
    if ($(NF - 1) == "T" || $(NF - 1) == "D" || $(NF - 1) == "R")
        home[symbol] = above ? "beyond/" file : file
    else if ($(NF - 1) == "U") {
        calls++
        from[calls] = above ? "beyond/" file : file
        to[calls] = symbol
    }
}

function rank_of(file) { return file in rank ? rank[file] : files + 1 }

END {
    for (c = 1; c <= calls; c++) {
        if (rank_of(home[to[c]]) <= rank_of(from[c]))
            continue
        print from[c] ".c calls " to[c] " of " home[to[c]] ".c, which lies above it"
        bad = 1
    }
    if (calls < 100)
        print "only " calls " calls found", bad = 1
    if (!bad)
        print calls " calls between the files of the library: all go down"
    exit bad
}
