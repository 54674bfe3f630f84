# plate-stress.awk - sxx of a plate by plate.awk against (72) at the corners of the quarter, in
# percent. At the hole sxx is extended to the edge from the two elements below it.
#     awk -F, -v b=5 -v h=5 -v nx=60 -v ny=48 -f doc/plate-stress.awk out/p/elements.csv out/p/nodes.csv
function theory(x, y,    q, t)
{
    q = 1 / (x * x + y * y)
    t = atan2(y, x)
    return 1 - q * (1.5 * cos(2 * t) + cos(4 * t)) + 1.5 * q * q * cos(4 * t)
}

function near(x, y) { return ($3 - x)^2 + ($4 - y)^2 < 1e-9 }

function error(stress, x, y) { return 100 * (stress / 1e6 / theory(x, y) - 1) }

FNR == 1 { files++; next }
files == 1 && $1 == 2 * (ny - 1) * nx + 1 { y0 = $4; s0 = $8 }
files == 1 && $1 == 2 * (ny - 1) * nx + 3 { y1 = $4; s1 = $8 }
files == 2 && near(b, 0) { end = error($7, b, 0) }
files == 2 && near(b, h) { corner = error($7, b, h) }
files == 2 && near(0, h) { side = error($7, 0, h) }

END {
    hole = error(s0 - (s1 - s0) * (y0 - 1) / (y1 - y0), 0, 1)
    printf "%2d m x %2d m: hole %+.1f %%, end %+.1f %%, corner %+.1f %%, side %+.1f %%\n", 2 * b, 2 * h, hole, end, corner, side
}
