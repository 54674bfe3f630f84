# answers.sh - numbers of the answers to the exercises, by their models:
#     BBM=./bbm sh doc/answers.sh NAME
# NAME: patch, bar, area, slope, start, hand, passes, drop, iterations, stiff, soft, locking, rub;
# of the lab: columns, crown, balance, swing, wave, missing.
set -e
HERE=out/answers
mkdir -p $HERE

# Runs the model of standard input, or of the file $1 with what follows it; prints its last row.
run()
{
    if [ $# = 0 ]; then cat > $HERE/one.model; set -- $HERE/one.model; fi
    $BBM -q "$@" -o $HERE > $HERE/said 2>&1 || :      # what a model expects may not be met
    tail -1 $HERE/history.csv
}

# 3.4: the largest error of sxx.
patch()
{
    for bond in "100 augment 0" "1000 augment 0" "10000 augment 0" "100 augment 2"; do
        sed "s/^bond.*/bond alpha $bond/" doc/patch.model > $HERE/patch.model
        run $HERE/patch.model > $HERE/row
        awk -F, -v b="$bond" 'NR > 1 { d = $8 < 1000 ? 1000 - $8 : $8 - 1000
            if (d > most) most = d }
            END { printf "alpha %s: %.2g Pa\n", b, most }' $HERE/elements.csv
    done
}

# 4.6: the share of the springs, for alpha = 10, 100, 1000.
bar()
{
    for n in 1 2 4; do
        for alpha in 10 100 1000; do
            run doc/exercises/bar.model -d nx=$((4 * n)) -d ny=$n -d alpha=$alpha
        done | awk -F, -v n=$n '
            { printf "%s%+.3f %%", (NR > 1 ? "  " : 4 * n "x" n ":  "), 100 * ($3 / 1.6e-3 - 1) }
            END { print "" }'
    done
}

# 5.5: the growth of the area, by the first and the last node, which lie on a diagonal.
area()
{
    sed 's/^rotation exact/rotation linear/' cases/models/turning.model > $HERE/turning.model
    for steps in 50 100 200; do
        dt=$(awk "BEGIN { print 2 / $steps }")
        run $HERE/turning.model -d dt=$dt -d steps=$steps > $HERE/row
        awk -F, -v dt=$dt 'NR == 2 { x = $3 + $5; y = $4 + $6 }
            END { l2 = ($3 + $5 - x)^2 + ($4 + $6 - y)^2; printf "dt %g: %.4f\n", dt, l2 / 2 - 1 }' $HERE/nodes.csv
    done
}

INCLINE=cases/models/incline.model

# 6.1: where the corner ends.
slope()
{
    for phi in 0 20 29; do
        run $INCLINE -d phi=$phi | awk -F, -v p=$phi '{ printf "%2d: u %.4f, v %.4f\n", p, $3, $4 }'
    done
}

# 6.1: what it moves along the slope if it stays.
start()
{
    for phi in 31 40; do
        for dt in "0.01 steps 100" "0.001 steps 1000" "0.01 steps 100 settle 100"; do
            sed "s/dt 0.01 steps 100/dt $dt/" $INCLINE > $HERE/start.model
            run $HERE/start.model -d phi=$phi | awk -F, -v p=$phi -v d="$dt" \
                '{ printf "%d, dt %s: %.0f um\n", p, d, -1e6 * (sqrt(3) / 2 * $3 + $4 / 2) }'
        done
    done
}

# The first step, with a block too stiff to bend.
first() { sed 's/E 1e10/E 1e14/; s/steps 100/steps 1/' $INCLINE > $HERE/first.model; }

# One step by hand: the way of the lower corner along the slope and into it.
hand()
{
    first
    run $HERE/first.model | awk -F, '{ c = sqrt(3) / 2; s = -($3 * c + $4 / 2); w = $3 / 2 - $4 * c
        printf "along %.3e m, down %.3e m: N = %.0f N\n", s, w, 1e9 * w }'
}

# 6.6: the solutions of the first step, and where the corner ends.
passes()
{
    first
    for phi in 28 31 40; do
        u=$(run $HERE/first.model -d phi=$phi | cut -d, -f3)
        tail -1 $HERE/summary.csv | awk -F, -v p=$phi -v u=$u '{ printf "%d: %d solutions, u %.3e m\n", p, $3, u }'
    done
}

# 6.7: the fastest rise over the fastest fall.
drop()
{
    for dt in 0.002 0.001 0.0005 0.0002 0.0001; do
        run cases/models/drop.model -d dt=$dt > $HERE/row
        awk -F, -v dt=$dt 'NR > 2 { V = ($4 - v) / ($2 - t); if (V < a) a = V; if (V > b) b = V }
            { v = $4; t = $2 }
            END { W = dt * sqrt(2e9 / 2500); c = (4 - W * W) / (2 * sqrt(4 + 2 * W * W))
                  F = exp(-log(1 + W * W / 2) * atan2(0, -1) / (2 * atan2(sqrt(1 - c * c), c)))
                  printf "dt %.4f: rebound/impact %.3f, formula %.3f\n", dt, -b / a, F }' $HERE/history.csv
    done
}

# 7.2: iterations on three meshes, alpha = 1 and 100.
iterations()
{
    sed 's/^pcg.*/pcg tolerance 1e-10 coarse off/' doc/beam.model > $HERE/solver.model
    for n in 4 8 16; do
        for alpha in 1 100; do
            run $HERE/solver.model -d nx=$((4 * n)) -d ny=$n -d alpha=$alpha -d augment=0 > $HERE/row
            tail -1 $HERE/summary.csv | cut -d, -f4
        done
    done | awk '{ n = 2 ^ int((NR + 3) / 2); i[NR] = $1 }
        NR % 2 == 0 { printf "%d x %d: alpha x 100 costs %.1f times the iterations\n", 4 * n, n, $1 / i[NR - 1] }
        END { printf "64 x 16 after 16 x 4: %.1f times the iterations\n", i[5] / i[1] }'
}

# 8.1: errors of the beam on four meshes, and their order; with "$@" in place of stiff springs.
beam()
{
    for n in 2 4 8 16; do
        run doc/beam.model -d nx=$((4 * n)) -d ny=$n "$@"
    done | awk -F, '{ e = $4 / -2.8449e-3 - 1; printf "error %+.2f %%", 100 * e
        print (e < 0 && last < 0 ? sprintf("  order %.2f", log(last / e) / log(2)) : ""); last = e }'
}

stiff() { beam; }
soft() { beam -d alpha=100 -d augment=0 | sed 's/  order.*//'; }

# 8.4: where P ends, with friction.
rub()
{
    for phi in 3 6; do
        sed "s/friction 0 /friction $phi /; s/slider friction 0/slider friction $phi/" cases/models/exp3.model > $HERE/rub.model
        run $HERE/rub.model | awk -F, -v p=$phi '{ printf "friction %d: u %.4f m\n", p, $3 }'
    done
}

# 8.2: the tip.
locking()
{
    for at in vertices moment; do
        sed "s/^static /bond at $at\nstatic /" cases/models/exp1.model > $HERE/beam.model
        run $HERE/beam.model | awk -F, -v a=$at '{ printf "%-9s tip %.4f mm\n", a, 1000 * $10 }'
    done
}

# Lab: whether a run meets what it expects.
ends()
{
    $BBM -q "$@" -o $HERE > $HERE/said 2>&1 && status=0 || status=$?
    case $status in 0) echo stands ;; 3) echo falls ;; *) echo "exit status $status" ;; esac
}

# Lab: the slope on both sides of its limit, for fewer columns.
columns()
{
    while read -r n low high; do
        echo "$n columns: $low degrees $(ends cases/models/slope.model -d columns=$n -d phi=$low)," \
            "$high $(ends cases/models/slope.model -d columns=$n -d phi=$high)"
    done << END
16 38.11 38.15
13 38.11 38.15
10 37.65 37.67
END
}

# Lab: a load on both upper corners of the keystone, on both sides of what the arch bears.
crown()
{
    sed 's/^gravity.*/&\nlet F 0\nlet b $(180*floor(n\/2)\/n)\nlet ra $(R + t\/2)\n\
load at $(ra*cos(b)) $(ra*sin(b)) 0 $(-F*500)\nload at $(-ra*cos(b)) $(ra*sin(b)) 0 $(-F*500)/' \
        cases/models/arch.model > $HERE/crown.model
    while read -r t low high; do
        echo "t $t m: with $low kN it $(ends $HERE/crown.model -d steps=200 -d t=$t -d F=$low)," \
            "with $high kN it $(ends $HERE/crown.model -d steps=200 -d t=$t -d F=$high)"
    done << END
1.2 44 47
1.5 214 220
END
}

# Lab: the block let go at a distance from upright.
balance()
{
    sed 's/^let steps.*/let steps 3000\nlet d 0.5/; s/^expect.*/expect top u 1 within 1.1/
s/^monitor.*/monitor top at $(-d) $(sqrt(25 - d*d)) of block/
s/^block block.*/let x $(sqrt(25 - d*d)\/5)\nblock block stiff 0 0 $x $(d\/5) $(x - d) $(5*x + d\/5) $(-d) $(5*x)/' \
        cases/models/rocking.model > $HERE/balance.model
    for d in 0.97 0.99; do
        echo "let go at $d m: $(ends $HERE/balance.model -d d=$d)"
    done
}

# Lab: when the block is upright, and how far its top goes on.
swing()
{
    for g in 9.81 1.62; do
        sed "s/-9.81/-$g/" cases/models/rocking.model > $HERE/swing.model
        run $HERE/swing.model -d steps=4000 > $HERE/row
        awk -F, -v g=$g 'NR > 1 && $3 >= 0.4927 && !t { t = $2 } NR > 1 && $3 > u { u = $3 }
            END { printf "g %.2f: upright after %.2f s, then %.2f m further\n", g, t, u - 0.4927 }' $HERE/history.csv
    done
}

# Lab: how much sooner the last domino has moved by 0.5 m with twice the spin. The hits make the number
# depend on the last digits, by some 0.1 s.
wave()
{
    for n in 6 12; do
        for spin in -1.6 -3.2; do
            run cases/models/dominoes.model -d spin=$spin -d n=$n -d steps=$((1500 + 280 * n)) > $HERE/row
            awk -F, 'NR > 1 && $5 ^ 2 + $6 ^ 2 >= 0.25 { print $2; exit }' $HERE/history.csv
        done | awk -v n=$n '{ t[NR] = $1 }
            END { d = t[1] - t[2]
                  print n " dominoes: sooner by " (d > 0.5 && d < 1 ? "between 0.5 and 1 s" : d " s") }'
    done
}

# Lab: a domino in whose way one or two are missing.
missing()
{
    for apart in 1 1.5; do
        $BBM cases/models/dominoes.model -d n=3 -d apart=$apart -o $HERE 2>&1 |
            sed -n "s/.*last.*: \(.*\)/apart $apart m: last \1/p"
    done
}

$1
