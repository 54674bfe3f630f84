# arch.awk - a semicircular arch of 15 voussoirs, mean radius 10 m, thickness t, for Exercise 20.
#     awk -v t=1.1 -v phi=30 -f doc/exercises/arch.awk > out/arch.model
function block(name, material, x1, y1, x2, y2, x3, y3, x4, y4)
{
    printf "node %d %.12f %.12f\nnode %d %.12f %.12f\n", nodes + 1, x1, y1, nodes + 2, x2, y2
    printf "node %d %.12f %.12f\nnode %d %.12f %.12f\n", nodes + 3, x3, y3, nodes + 4, x4, y4
    print "element", ++blocks, name, material, nodes + 1, nodes + 2, nodes + 3, nodes + 4
    nodes += 4
}

BEGIN {
    i = 10 - t / 2
    o = 10 + t / 2
    print "title An arch of 15 voussoirs\nmaterial rigid E 1e14 nu 0.25 density 2500"
    print "material rock E 1e10 nu 0.2 density 2500\nfixblock left\nfixblock right"
    print "gravity 0 -9.81\ncontact kn 1e10 ks 4e9 friction", phi
    print "dynamic dt 0.01 steps 400 settle 100\nmonitor crown node 38"
    block("right", "rigid", i - 1, -1, o + 1, -1, o + 1, 0, i - 1, 0)
    block("left", "rigid", -o - 1, -1, 1 - i, -1, 1 - i, 0, -o - 1, 0)
    for (k = 0; k < 15; k++) {
        a = atan2(0, -1) * k / 15
        b = atan2(0, -1) * (k + 1) / 15
        block("v" k, "rock", i * cos(a), i * sin(a), o * cos(a), o * sin(a),
              o * cos(b), o * sin(b), i * cos(b), i * sin(b))
    }
}
