# claims.sh - numbers of paper.md, 08-experiments.md and beyond.md that no experiment prints, by models of beam.awk and
# plate.awk and by tables of the experiments:
#     BBM=./bbm sh doc/claims.sh table1|table2|table3|table4|table5|fig10|fig13|stress|mesh|plate|held|lines|arc|areas|iterations|blocks|levels|squares
set -e
mkdir -p out/claims

# A beam of $1 x $2 cells, alpha $3, $4 rounds of multipliers; what more beam.awk takes.
beam()
{
    awk -v nx=$1 -v ny=$2 -v alpha=$3 -v augment=$4 $5 -f doc/beam.awk
}

run()
{
    cat > out/claims/claim.model
    $BBM -q out/claims/claim.model -o out/claims
}

# The tables of paper.md, from the logs of the experiments.
table1()
{
    grep -h '^| dt' out/exp3.log
    echo '|---|---|---|---|---|---|---|---|'
    awk '/^[|] dt/ { getline; getline; print $0 (NF < 17 ? " - | - |" : "") }' out/exp1.log out/exp2.log out/exp3.log
}

# The rows of the first table behind a line of a log that begins so.
rows()
{
    awk -v begins="$2" 'index($0, begins) == 1 { inside = 1 } inside && /^[|]/ { print; seen = 1 } seen && !/^[|]/ { exit }' out/$1.log
}

table2() { rows exp1 '| DDA'; }
fig10() { rows exp1 '| x [m]' | grep -E '^[|] ?(x|-|6|24|48)'; }
table3() { rows exp1 'Table 3, a' | cut -d'|' -f1-4,6-7,9; }
fig13() { rows exp1 'Fig. 13, a' | cut -d'|' -f1-6,8-; }
table4() { rows exp2 'Table 4, b5' | cut -d'|' -f1-3,5-6,8-; }
table5() { rows exp2 'Table 5, b5' | cut -d'|' -f1-4,7,9-; }

# The von Mises stress at (24,6), 1000 Pa, for cells of three sizes.
stress()
{
    for n in 2 4 8; do
        for a in 10 1000; do
            beam $((4 * n)) $n $a 0 | run
            awk -F, '$3 == 24 && $4 == 6 { print $10 / 10 - 100 }' out/claims/nodes.csv
        done | xargs printf "$n cells high: alpha 10 %+.1f %%, alpha 1000 %+.1f %%\n"
    done
}

# Errors on unstructured meshes against converged finite elements: $1 cases/$1.model, $2 variant of fem.csv, $3
# alpha, the others what is asked.
unstructured()
{
    $BBM -q cases/$1.model -d alpha=$3 -o out/claims
    awk -F, -v name=$1 -v variant=$2 -v a=$3 -v asked="$4" '
    FNR == NR { if ($2 == variant) fem[$3 "(" $4 "," $5 ")"] = $6; next }
    FNR == 1 { for (k = 1; k <= NF; k++) column[$k] = k; next }
    {
        for (k = split(asked, q, " "); k > 0; k--)
            if (q[k] ~ "[(]" $column["x"] "," $column["y"] "[)]")
                is[q[k]] = $column[substr(q[k], 1, index(q[k], "(") - 1)]
    }
    END {
        printf "%s, alpha %4d:", name, a
        for (k = 1; k in q; k++)
            printf " %s %+.*f %%", q[k], a < 1000 ? 1 : 2, 100 * (is[q[k]] / fem[q[k]] - 1)
        print ""
    }' cases/fem.csv out/claims/nodes.csv
}

mesh()
{
    unstructured beam a 1000 "v(24,0) v(48,6) mises(12,6) mises(24,6)"
    for a in 10 100 1000; do
        unstructured plate b5 $a "v(0,1) u(5,0)"
    done
}

# What converged finite elements of plates of other sizes have more than (72), at the corners of the quarter.
plate()
{
    awk -F, '
    function more(x, y,    q, t)
    {
        q = 1 / (x * x + y * y)
        t = atan2(y, x)
        return 100 * ($6 / 1e6 / (1 - q * (1.5 * cos(2 * t) + cos(4 * t)) + 1.5 * q * q * cos(4 * t)) - 1)
    }
    $2 !~ /^[0-9]+x[0-9]+$/ { next }
    { split($2, size, "x"); b = size[1] / 2; h = size[2] / 2 }
    $4 == 0 && $5 == 1 { hole = more(0, 1); n++ }
    $4 == b && $5 == 0 { end = more(b, 0); n++ }
    $4 == b && $5 == h { corner = more(b, h); n++ }
    $4 == 0 && $5 == h { side = more(0, h); n++ }
    n == 4 {
        printf "%d m x %d m: hole %+.1f %%, end %+.1f %%, corner %+.1f %%, side %+.1f %%\n", 2 * b, 2 * h, hole, end, corner, side
        n = 0
    }' cases/fem.csv
}

# Displacements across the lines of symmetry.
held()
{
    for n in 0 2; do
        { awk -v b=5 -v nx=32 -v ny=24 -v tri=1 -f doc/plate.awk; echo "bond alpha 1000 augment $n"; } | run
        tail -1 out/claims/history.csv | awk -F, -v n=$n '{
            printf "%d rounds:", n
            split($4 " " $5 " " $8 " " $9, x, " ")
            for (k = 1; k <= 4; k++)
                printf " %s", x[k]^2 < 1e-24 ? "below_1e-12" : sprintf("%.1e", x[k])
            print ""
        }'
    done
}

# Figs. 15 to 19: plate b5 against six-node triangles, in shares of the largest value on the line.
lines()
{
    for f in "15 x u" "16 y v" "17 x sxx" "18 y sxx" "19 angle sxx"; do
        set -- $f
        awk -F, -v f=$1 -v line=b5.$2 -v q=$3 '
        FNR == NR && $2 == line && $3 == q { fem[sprintf("%.6f %.6f", $4, $5)] = $7; if ($7 ^ 2 > most ^ 2) most = $7 }
        FNR != NR && $1 == "b5." q && $6 == "theory" && (k = sprintf("%.6f %.6f", $2, $3)) in fem {
            if (($4 - fem[k]) ^ 2 > d ^ 2) d = $4 - fem[k]
        }
        END { printf "fig%s: %.1f %%\n", f, 100 * sqrt((d / most) ^ 2) }' cases/fem.csv out/exp2/results.csv
    done
}

# Stresses on the hole, plate k5, against (72).
arc()
{
    for f in fig19:sxx fig19hoop:stt; do
        awk -F, -v f=${f%:*} -v q=k5.${f#*:} '
        $1 == q && $6 == "theory" && ($2^2 + $3^2 - 1)^2 < 1e-12 && ($4 - $5)^2 > d * d {
            d = $4 - $5; at = atan2($3, $2) * 180 / atan2(0, -1); s = $5
        }
        END { printf "%s: %+.2f MPa at %.0f degrees, theory %.2f\n", f, d / 1e6, at, s / 1e6 }' out/exp2/results.csv
    done
}

# The way of the tip that is the springs', for alpha 10, 100, 1000, on columns that grow.
areas()
{
    for r in 1 10 100 1000; do
        for x in "10 0" "100 0" "1000 0" "1000 2"; do
            beam 24 6 $x "-v ratio=$r" | sed '/^monitor/s/24/48/' | run
            tail -1 out/claims/history.csv
        done | awk -F, -v r=$r '{ v[NR] = $4 } END {
            printf "ratio %4d:", r
            for (k = 1; k <= 3; k++)
                printf " %.*f %%", k - 1, 100 * (v[k] / v[4] - 1)
            print ""
        }'
    done
}

# SSOR-PCG; digits that rounding decides are left out.
iterations()
{
    for a in 10 1000 100000; do
        beam 32 8 $a 0 | sed 's/^pcg.*/pcg coarse off/' | run
        tail -1 out/claims/summary.csv | awk -F, -v a=$a '{
            printf "alpha %6d: %2.0f hundred iterations, residual 1e%d\n", a, $4 / 100, log($5) / log(10) - 1
        }'
    done
}

# Triangles bonded, and as blocks in contact.
blocks()
{
    for kn in 0 1e9; do
        beam 8 2 1000 0 "-v kn=$kn" | run
        tail -1 out/claims/summary.csv | awk -F, -v v=$(tail -1 out/claims/history.csv | cut -d, -f4) '{
            printf "%d contacts: v(24,0) %.2f mm, %d solution%s\n", $6, 1000 * v, $3, ($3 > 1 ? "s" : "")
        }'
    done
}

# The paper's solver beside two levels, on triangles; digits that rounding decides are left out.
levels()
{
    for n in 4 8; do
        for a in 10 1000; do
            for c in off on; do
                { beam $((4 * n)) $n $a 0 | sed '/^pcg/d'; echo "pcg coarse $c"; } | run
                tail -1 out/claims/summary.csv
            done | awk -F, -v u=$((96 * n * n)) -v a=$a '{ x[NR] = $4 } END {
                printf "%4d unknowns, alpha %4d: SSOR about %4d iterations, two levels %s\n", u, a,
                    sprintf("%.1g", x[1]), (x[2] > 15 ? x[2] : "15 or fewer")
            }'
        done
    done
}

# Two levels on n x n/4 squares.
squares()
{
    for n in 32 64; do
        for a in 10 1000; do
            beam $n $((n / 4)) $a 0 "-v quads=1" | sed '/^pcg/d' | run
            tail -1 out/claims/summary.csv | awk -F, -v n=$n -v a=$a '{
                print "n =", n ", alpha =", a ": about", 5 * int($4 / 5 + 0.5), "iterations"
            }'
        done
    done
}

$1
