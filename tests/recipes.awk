# recipes.awk - does what doc/recipes.md says, in out/recipes:
#     awk -v PROGRAMS=/.../out/build -f tests/recipes.awk doc/recipes.md
#
# In a block "shell-session" a line "$ COMMAND", which goes on in lines "> ", is run; what it prints follows. A
# number in it may differ by 2 %, for another version of Gmsh makes another mesh. The block is skipped if
# the command of the line "<!-- needs COMMAND -->" before it fails.

function fail(why)
{
    print FILENAME ":" FNR ": " why > "/dev/stderr"
    failed = 1
}

function in_folder(command)
{
    return "cd out/recipes && PATH=\"$PATH:" PROGRAMS "\" && " command
}

function is_like(got, expected,    g, e, k, n)
{
    n = split(expected, e)
    if (split(got, g) != n)
        return 0
    for (k = 1; k <= n; k++)
        if (g[k] != e[k] && !(e[k] ~ /^-?[0-9.]+(e[-+]?[0-9]+)?$/ &&
                              (g[k] - e[k])^2 <= (0.02*e[k])^2))
            return 0
    return 1
}

# Runs the command that has been read, and compares what it prints with the lines below it.
function run(    k)
{
    if (command != "") {
        print command
        if (system("{ " in_folder(command) "; } > out/recipes/printed 2> out/recipes/said"))
            fail("failed: see out/recipes/said")
        for (k = 1; (getline line < "out/recipes/printed") > 0; k++)
            if (k > lines || !is_like(line, expected[k]))
                fail("it prints \"" line "\"")
        close("out/recipes/printed")
        if (k <= lines)
            fail("it does not print \"" expected[k] "\"")
    }
    command = ""
    lines = 0
}

/^<!-- needs / {
    skip = system("{ " substr($0, 12, length($0) - 15) "; } > out/recipes/said 2>&1")
    if (skip)
        print "skipped, for it needs: " substr($0, 12, length($0) - 15)
    next
}
/^```shell-session/ { inside = !skip; next }
/^```/ { run(); inside = 0; next }
inside && /^\$ / { run(); command = substr($0, 3); next }
inside && /^> / { command = command "\n" substr($0, 3); next }
inside { expected[++lines] = $0 }

END { exit failed }
