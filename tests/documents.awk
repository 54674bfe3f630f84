# documents.awk - the commands of the documents, and what they print; the files to which they lead,
# and the names of the library in them:
#     awk -v O=out/build -f tests/documents.awk doc/*.md
#
# In a block of the kind "console" a line "$ COMMAND" is run by the shell in the project's top folder
# (it goes on in the next line after a backslash); the lines below it are what it prints, letter for
# letter. "..." stands for any number of lines. Programs are taken from the folder O. What stands in a
# block of the kind "c FILE" is in that file, letter for letter.
# A comment "<!-- $ COMMAND -->" does the same for the table in the lines below it.

function fail(why)
{
    print FILENAME ":" FNR ": " why > "/dev/stderr"
    failed = 1
}

# Each [text](path), seen from the folder of the document.
function follow_links(line,    path, folder)
{
    folder = FILENAME
    sub(/[^\/]*$/, "", folder)
    while (match(line, /\]\([^)#:]+/)) {
        path = folder substr(line, RSTART + 2, RLENGTH - 2)
        line = substr(line, RSTART + RLENGTH)
        if (path !~ /https?$/ && system("test -e '" path "'") != 0)
            fail(path " is not there")
    }
}

# Each `bbm_name` is a word of the sources, and so is each name of four words, as those of tests.
function check_names(line,    name)
{
    while (match(line, /`(bbm_[a-z_0-9]+|[A-Za-z]+_[A-Za-z0-9]+_[A-Za-z0-9]+_[A-Za-z0-9_]+)`/)) {
        name = substr(line, RSTART + 1, RLENGTH - 2)
        line = substr(line, RSTART + RLENGTH)
        if (!(name in known))
            fail("the sources have no " name)
    }
}

function run(command)
{
    gsub(/\.\/bbm/, O "/bbm", command)
    gsub(/out\/build/, O, command)
    lines = 0
    at = 1
    skip = 0
    said = "out/said"
    system("(" command ") > " said " 2>&1")
    while ((getline printed[lines + 1] < said) > 0)
        lines++
    close(said)
    commands++
}

function compare(line)
{
    for (; at <= lines; at++)
        if (printed[at] == line || !skip)
            break
    if (at > lines || printed[at] != line)
        fail("the command prints \"" (at > lines ? "" : printed[at]) "\" in place of \"" line "\"")
    at++
    skip = 0
}

function finish()
{
    if (running && !skip && at <= lines)
        fail("the command goes on: \"" printed[at] "\"")
    running = 0
}

BEGIN {
    words = "cat *.h *.c */*.h */*.c | grep -oE '[A-Za-z]+_[A-Za-z0-9_]+' | sort -u"
    while ((words | getline word) > 0)
        known[word] = 1
}

# A block "c FILE" is a piece of that file, letter for letter.
/^```c / { source = $2; piece = ""; next }
source != "" && /^```$/ {
    text = ""
    while ((getline line < source) > 0)
        text = text line "\n"
    close(source)
    if (piece == "" || !index(text, piece))
        fail("this is not a piece of " source)
    source = ""
    next
}
source != "" { piece = piece $0 "\n"; next }

FNR == 1 && inside { fail("a block without end in the file before"); inside = 0 }
/^```console$/ { inside = 1; next }
inside && /^```$/ { finish(); inside = 0; next }
inside && /^\$ / {
    finish()
    command = substr($0, 3)
    while (command ~ /\\$/ && (getline line) > 0)
        command = substr(command, 1, length(command) - 1) line
    running = 1
    run(command)
    next
}
/^<!-- \$ .* -->$/ { table = 1; run(substr($0, 8, length($0) - 11)); running = 1; next }
table && !/^[|]/ { finish(); table = 0 }
table { compare($0); next }
inside && /^\.\.\.$/ { skip = 1; next }
inside { compare($0); next }
{ follow_links($0); check_names($0) }

END {
    print commands + 0, "commands of the documents print what stands there"
    exit failed || commands < 10
}
