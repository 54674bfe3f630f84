# assemble.awk - page/page.html with what it names, as one file:
#     awk -f page/assemble.awk page/page.html out/bbm.wasm MODEL ...
#
# @include FILE stands for the text of a file. @files stands for all others, in base64, so that
# nothing in them is markup; their names are those behind the last slash.

BEGIN {
    for (k = 2; k < ARGC; k++) {
        file[++files] = ARGV[k]
        delete ARGV[k]
    }
}

$1 == "@include" {
    while ((getline line < $2) > 0)
        print line
    next
}

$1 == "@files" {
    for (k = 1; k <= files; k++) {
        name = file[k]
        sub(/.*\//, "", name)
        printf "<script type=\"text/plain\" data-file=\"%s\">", name
        command = "base64 < " file[k] " | tr -d '\\n'"
        command | getline line
        close(command)
        print line "</script>"
    }
    next
}

{ print }
