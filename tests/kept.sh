#!/bin/sh
# kept.sh - models that nobody has looked at, and what came of them: the exit status, what was said, in
# how many solutions, and where the elements are. That it stays as it was says nothing of right or
# wrong; but each change has a reason, and who has seen it writes the tables anew.
#
# sh tests/kept.sh BBM          compares; prints what differs, and ends with status 1
# sh tests/kept.sh BBM write    writes tests/kept/*.csv anew
rm -rf out/kept
mkdir -p out/kept
for model in tests/kept/*.model; do
    name=$(basename "$model" .model)
    now=out/kept/$name.csv
    "$1" -q -o "out/kept/$name" "$model" > "$now" 2>&1
    echo "status,$?" >> "$now"
    awk -F, 'FNR == 1 { file++ } file == 1 { n += $3; next } FNR == 2 { print "solutions," n }
    { for (k = 3; k <= NF; k++) $k = FNR > 1 ? sprintf("%.8g", $k) : $k; print }' OFS=, \
    "out/kept/$name/summary.csv" "out/kept/$name/elements.csv" >> "$now" 2> /dev/null
    if [ "$2" ]; then
        cp "$now" "tests/kept/$name.csv"
    else
        awk -v name="$model" -f tests/kept.awk "tests/kept/$name.csv" "$now" || different=1
    fi
done
exit ${different:-0}
