# documents.awk - the commands of the documents, and what they print:
#     awk -v O=out/build -f tests/documents.awk doc/*.md
#
# In a block of the kind "console" a line "$ COMMAND" is run by the shell in the project's top folder
# (it goes on in the next line after a backslash); the lines below it are what it prints, letter for
# letter. "..." stands for any number of lines. Programs are taken from the folder O.

function fail(why)
{
    print FILENAME ":" FNR ": " why > "/dev/stderr"
    failed = 1
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
inside && /^\.\.\.$/ { skip = 1; next }
inside { compare($0) }

END {
    print commands + 0, "commands of the documents print what stands there"
    exit failed || commands < 10
}
