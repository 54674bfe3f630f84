#!/bin/sh
# check.sh - the documents against the sources and the programs in the folder $O:   make check-documents
set -eu
fail() { echo "$1"; exit 1; }

rm -rf "$O/drawn" && mkdir "$O/drawn" && "$O/figures" "$O/drawn"
diff -r "$O/drawn" doc/figures || fail "doc/figures is not what the program draws: make figures"
for f in doc/paper/*.svg; do
    cmp -s "$f" out/exp1/"${f##*/}" || cmp -s "$f" out/exp2/"${f##*/}" || fail "copy out/exp*/${f##*/} to $f"
done
for f in $(sed -n 's/.*monospace[^>]*>\([a-z_]*\)<.*/\1/p' doc/figures/flow.svg); do
    grep -q "[ *]$f(" base/step.c || fail "doc/figures/flow.svg names $f, which base/step.c does not have"
done

# The plan of the house: every name in it is one of the sources, every file is there, none is missing.
names=$(grep -ohE '[a-z0-9]+(_[a-z0-9]+)+' doc/house.svg)
[ "$(echo "$names" | wc -l)" -gt 30 ] || fail "doc/house.svg has no names"
for w in $names; do
    grep -qw "$w" ./*.[ch] base/*.[ch] beyond/*.[ch] || [ -f "base/$w.c" ] || fail "doc/house.svg names $w"
done
for f in $(grep -owE '[a-z0-9_]+[.]c' doc/house.svg); do
    [ -f "$f" ] || [ -f "base/$f" ] || [ -f "beyond/$f" ] || fail "doc/house.svg names $f"
done
for f in ./*.c base/*.c beyond/*.c; do
    grep -qw "${f##*/}" doc/house.svg || fail "doc/house.svg lacks $f"
done

awk -f tests/equations.awk doc/paper.md tests/beyond.md *.c */*.c
sed -n '/no error/!s/.*\[BBM_[A-Z_]*\] = "\([^"]*\)".*/\1/p' base/cut.c | while read -r text; do
    grep -qF -- "- **$text**" doc/failures.md || fail "doc/failures.md has no \"$text\""
done
awk -v O="$O" -f tests/documents.awk README.md doc/*.md
