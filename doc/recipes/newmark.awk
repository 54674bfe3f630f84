# newmark.awk - u of Newmark's block under a record TIME,A, in steps of 1e-5 s: awk -F, -f newmark.awk pulse.csv
# Its slip s downhill has s'' = C (A - g tan(phi - a)), C = cos(phi - a)/cos(phi), while s' > 0.
function slip(from, to, A, B,    t, h)
{
    h = 1e-5
    for (t = h/2; t < to - from; t += h) {
        v += h*C*(A + (B - A)*t/(to - from) - yield)
        if (v < 0)
            v = 0
        s += h*v
    }
}
BEGIN {
    a = 10*atan2(0, -1)/180
    phi = 2*a
    C = cos(phi - a)/cos(phi)
    yield = 9.81*sin(phi - a)/cos(phi - a)
}
NR > 1 { slip(time, $1, A, $2) }
{ time = $1; A = $2 }
END {
    slip(time, time + 5, 0, 0)
    print -s*cos(a)
}
