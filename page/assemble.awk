# assemble.awk - page/page.html with what it names, as one file:
#     awk -f page/assemble.awk page/page.html out/bbm.wasm MODEL ...
#
# @include FILE ... stands for the text of files without their comments. @files stands for all
# others, packed by gzip, in base64, so that nothing in them is markup; their names are those
# behind the last slash.

$1 == "@include" {
    for (k = 2; k <= NF; k++)
        while ((("sed '/^\\/\\*.*\\*\\/$/d; /^\\/\\*/,/\\*\\/$/d' " $k) | getline line) > 0)
            print line
    next
}

$1 == "@files" {
    for (k = 2; k < ARGC; k++) {
        name = ARGV[k]
        sub(/.*\//, "", name)
        ("gzip -9n < " ARGV[k] " | base64 | tr -d '\\n'") | getline line
        print "<script type=\"text/plain\" data-file=\"" name "\">" line "</script>"
        ARGV[k] = ""
    }
    next
}

{ print }
