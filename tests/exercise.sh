#!/bin/sh
# exercise.sh - the exercises in the chapters of doc/: copies of the sources, and their tests.
#
#   exercise.sh begin N      makes the copy of exercise N in out/exercise/N, unless it is there, and
#                            runs its tests; a copy of a model is run once it has a line `expect`.
#                            With DRAW=exp1 in the environment a green copy runs that experiment
#   exercise.sh hint N STEP  prints a hint, the first or the second
#   exercise.sh list         all exercises, and which are done
#   exercise.sh prove        all exercises: red as they begin and with each wrong answer of
#                            tests/wrong-answers.txt, green with the source as it is, or with the
#                            right answer of that file: the groups of tests have run before, in
#                            `make check-library`. What is red says what was expected, not in C
#
# An exercise is a section "### Exercise N ..." of a chapter. The table below says what is done: the
# kind, the file, the function that is taken out, the tests: a group of those of `make quick`, or
# `program`, a program that tests itself, or what a model is asked for, and how closely: to predict,
# a line `expect`, or to measure, a line `# answer NUMBER`. An error that is to be found is a row of doc/teacher.md: the
# exercise, the file, a piece of a line, and what stands in its place. The hints are in doc/hints.md.
#
# `make exercise` gives O, where the objects are; COMPILE, FAILING, LINK, LIBS, parts of commands;
# TESTED, ALONE, COMMON, the objects for tests, programs and experiments; MAKE.
set -eu
unset CK_RUN_SUITE CK_INCLUDE_TAGS CK_EXCLUDE_TAGS
CHAPTERS=$(ls doc/0*.md)
CUT=tests/exercise.awk

# The fields of the first row of the tables in the input that fits the condition $1, a line each.
row()
{
    awk -F ' *[|] *' "/^[|]/ && $1"' { for (k = 2; k < NF; k++) { gsub(/`/, "", $k); print $k }; exit }'
}

# The lines of files below the heading that begins with $1, up to the next heading.
section()
{
    heading=$1
    shift
    awk -v h="$heading " '/^#/ { inside = index($0 " ", h) == 1; next } inside' "$@"
}

# Reads exercise $1.
read_page()
{
    page=$(grep -l "^### Exercise $1 " $CHAPTERS || :)
    [ -f "$page" ] || { echo "there is no exercise $1: make exercises lists them"; exit 2; }
    { read -r kind; read -r file; read -r name; read -r tests; } << END
$(section "### Exercise $1" "$page" | row '++rows == 3')
END
}

# Writes the copy with which exercise $1 begins to $2.
write_copy()
{
    case $kind in
    'fill in' | extend)
        NAME=$name awk -f $CUT "$file" > "$2" ;;
    'find the error')
        { read -r _; read -r _; IFS= read -r from; IFS= read -r to; } << END
$(row "\$2 == \"$1\"" < doc/teacher.md)
END
        FROM=$from TO=$to awk -f $CUT "$file" > "$2" ;;
    *)                                  # what a model says of its answer goes
        sed '/^#/d; /^expect/d' "$file" > "$2" ;;
    esac
}

# Makes $2/tests with the source $1, a copy of $file or that itself.
build()
{
    if [ "$tests" = program ]; then
        $COMPILE -I. -c -o "$2/copy.o" "$1"
        $LINK -o "$2/tests" "$2/copy.o" $ALONE $LIBS
    else
        others=$(for o in $TESTED; do [ "$o" = "$O/failing/${file%.c}.o" ] || echo "$o"; done)
        $COMPILE $FAILING -I. -I"$(dirname "$file")" -c -o "$2/copy.o" "$1"
        $LINK -o "$2/tests" "$2/copy.o" $others $LIBS
    fi
}

# What the copy $1 computes, in the folder $2: doc/exercises/own.c, and the experiment $DRAW.
show_own()
{
    [ "$tests" != program ] && [ -f "$O/${file%.c}.o" ] || return 0
    others=$(for o in $ALONE; do [ "$o" = "$O/${file%.c}.o" ] || echo "$o"; done)
    $COMPILE -I. -I"$(dirname "$file")" -c -o "$2/copy.o" "$1"
    $LINK -o "$2/own" "$2/copy.o" "$O/doc/exercises/own.o" $others -lm
    "$2/own"
    [ "${DRAW-}" ] || return 0
    $MAKE "$O/paper/$DRAW" > "$2/said"
    $LINK -o "$2/$DRAW" "$2/copy.o" "$O/cases/$DRAW.o" "$O/cases/paper.o" $COMMON $others -lm
    mkdir -p "$2/cases" && cp cases/fem.csv "$2/cases"
    (cd "$2" && "./$DRAW" > "$DRAW.log")
    echo "Figures drawn with your code: $2/out/$DRAW"
}

# Whether the copy $2 of exercise $1 answers what is asked for, as closely as that, and as
# tests/wrong-answers.txt has it right. A wide expectation is met by anything: no answer.
answers()
{
    awk -v n="$1" -v asked="$tests" '
    function size(x) { return x < 0 ? -x : x }
    function width(w, value, percent) { return percent ~ /%/ ? w / 100 * size(value) : w }
    BEGIN { parts = split(asked, of, " "); what = of[1] (of[2] == "within" ? "" : " " of[2]) }
    FNR == NR && $1 == n && $2 == "right" && match($0, "(expect|answer)[^>]*$") {
        split(substr($0, RSTART), r, " ")
        right[++rights] = r[1] == "answer" ? r[2] : r[4]
    }
    FNR == NR { next }
    $1 == "expect" && $2 " " $3 == what { value = $4; mine = $6; unit = $7 }
    $1 == "#" && $2 == what { value = $3; mine = 0 }
    value != "" {
        for (k = 1; k <= rights; k++) {
            most = width(of[parts - (of[parts] == "%")], right[k], of[parts])
            wide = width(mine, right[k], unit) > 1.001 * most
            enough = enough || (!wide && size(value - right[k]) <= most)
        }
        value = ""
    }
    END { exit !enough }' tests/wrong-answers.txt "$2"
}

is_a_model() { [ "$kind" = predict ] || [ "$kind" = measure ]; }

begin()
{
    read_page "$1"
    here=out/exercise/$1
    copy=$here/$(basename "$file")
    mkdir -p "$here"
    if is_a_model; then $MAKE bbm; else $MAKE "$O/quick" "$O/doc/exercises/own.o" $ALONE; fi
    [ -f "$copy" ] || { write_copy "$1" "$copy.new"; mv "$copy.new" "$copy"; }
    echo "The task: $page, Exercise $1"
    echo "The copy: $copy"
    if is_a_model; then
        line="expect ${tests%% within*} VALUE within${tests#*within}"
        [ "$kind" = predict ] || line="# answer NUMBER, good to${tests#*within}"
        grep -q '^expect \|^# answer ' "$copy" || { echo "Your answer: a line \`$line\` in the copy."; return; }
        answers "$1" "$copy" || { echo "Red: not the value, or not a line \`$line\`. make hint N=$1 helps."; exit 1; }
        [ "$kind" = measure ] || ./bbm "$copy" -o "$here/result" || \
            { echo "Red: the model does otherwise. make hint N=$1 helps."; exit 1; }
    else
        build "$copy" "$here"
        CK_RUN_CASE=$tests "$here/tests" || { echo "Red: not yet right. make hint N=$1 helps."; exit 1; }
        show_own "$copy" "$here"
    fi
    echo "Green: done. $(section "## $1" doc/hints.md | grep '^Next:')"
    : > "$here/done"
}

hint()
{
    read_page "$1"
    section "## $1" doc/hints.md | sed -n "s/^$2[.] //p"
    [ "$2" = 2 ] || echo "A second hint: make hint N=$1 STEP=2"
}

numbers() { sed -n 's/^### Exercise \([0-9.]*\) .*/\1/p' $CHAPTERS; }

list()
{
    for number in $(numbers); do
        read_page "$number"
        done=' '
        [ -f "out/exercise/$number/done" ] && done=x
        printf '[%s] %-5s %-15s %s\n' "$done" "$number" "$kind" \
            "$(sed -n "s/^### Exercise $number //p" "$page")"
    done
}

complain() { echo "$page: $1"; cat "$here/said"; exit 1; }

prove_one()
{
    read_page "$1"
    [ "$(section "## $1" doc/hints.md | grep -c '^1[.] \|^2[.] \|^Next: ')" = 3 ] || \
        { echo "doc/hints.md: exercise $1 has two hints and a line Next"; exit 1; }
    grep -q "\*\*$1\*\*" doc/teacher.md || { echo "doc/teacher.md has no answer **$1**"; exit 1; }
    here=$O/exercise/$1
    copy=$here/$(basename "$file")
    mkdir -p "$here"
    write_copy "$1" "$copy"
    if is_a_model; then prove_model "$1"; return; fi
    build "$copy" "$here" > "$here/said" 2>&1 || complain "its copy cannot be built"
    ! CK_RUN_CASE=$tests "$here/tests" > "$here/said" 2>&1 || complain "green as it begins"
    grep -q 'Failures: [1-9]\|Errors: [1-9]\|^wrong: ' "$here/said" || complain "no test is red"
    speaks
    [ "$kind" = 'find the error' ] || prove_wrong "$1"
    [ "$tests" = program ] || return 0
    build "$file" "$here"
    "$here/tests" > "$here/said" 2>&1 || complain "red with $file itself"
}

# No red test shows the student a piece of source, or an entry without its number.
speaks()
{
    ! grep "Assertion '\|: [A-Za-z]*\[[a-z]\] = " "$here/said" || complain "a red test prints its source"
}

# A wrong answer to a model is red, another quantity or a wide one, too; the right one is green.
prove_model()
{
    [ "$(grep -c "^$1 [ea]" tests/wrong-answers.txt)" -ge 2 ] || { echo "exercise $1: fewer than two wrong answers"; exit 1; }
    grep "^$1 [ear]" tests/wrong-answers.txt | while IFS= read -r answer; do
        answer=${answer#"$1 "} edit=
        case $answer in right*) edit=${answer#right} edit=${edit%=> *} answer=${answer##*=> } ;; esac
        write_copy "$1" "$copy.new"
        { sed "$edit" "$copy.new"; echo "$answer" | sed 's/^answer/# answer/'; } > "$copy"
        if [ -z "$edit" ]; then
            ! answers "$1" "$copy" || { echo "exercise $1 takes $answer"; exit 1; }
        else
            answers "$1" "$copy" || { echo "exercise $1 refuses $answer"; exit 1; }
            [ "$kind" = measure ] || "$O/bbm" -q "$copy" -o "$here/result" > "$here/said" 2>&1 || complain "red with $answer"
        fi
    done
}

# Each wrong answer of exercise $1 is red.
prove_wrong()
{
    count=0
    grep "^$1 " tests/wrong-answers.txt > "$here/wrong"
    while IFS= read -r answer; do
        answer=${answer#"$1 "}
        FROM=${answer%" => "*} TO=${answer#*" => "} awk -f $CUT "$file" > "$copy"
        build "$copy" "$here" > "$here/said" 2>&1 || complain "the wrong answer $answer cannot be built"
        ! CK_RUN_CASE=$tests "$here/tests" > "$here/said" 2>&1 || complain "green with the wrong answer $answer"
        count=$((count + 1))
    done < "$here/wrong"
    [ $count -ge 2 ] || complain "fewer than two wrong answers in tests/wrong-answers.txt"
}

# What is not there, or there twice, is no exercise.
prove_cut()
{
    for function in no_such_function bbm_add_pair; do
        ! NAME=$function awk -f $CUT bbm.c > /dev/null 2>&1 || { echo "$CUT found $function"; exit 1; }
    done
    ! FROM='return' TO='' awk -f $CUT bbm.c > /dev/null 2>&1 || { echo "$CUT took the first of many"; exit 1; }
    file=bbm.c tests=none here=$O/exercise/own
    mkdir -p "$here"
    NAME=bbm_bonding_submatrices awk -f $CUT bbm.c > "$here/bbm.c"
    ! grep -q 'K_jj += k' "$here/bbm.c" || { echo "the copy tells its answer"; exit 1; }
    ! show_own "$here/bbm.c" "$here" | grep 'moves by 0.0044 m' || { echo "another code is shown"; exit 1; }
    DRAW=exp2 show_own bbm.c "$here" > "$here/own.said"
    grep -q 'moves by 0.0044 m' "$here/own.said" || { cat "$here/own.said"; exit 1; }
    [ -f "$here/out/exp2/fig15.svg" ] || { echo "the copy has not drawn Fig. 15"; exit 1; }
}

prove()
{
    prove_cut
    grep -q '^100%: Checks: ' "$O/library.said" || { echo "the tests are red with the sources"; exit 1; }
    count=0
    for number in $(numbers); do
        (prove_one "$number")
        count=$((count + 1))
    done
    echo "$count exercises: red as they begin and with wrong answers, green with the sources"
}

"$@"
