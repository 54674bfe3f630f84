# beam.awk - the beam of Experiment I for 08-experiments.md and beyond.md: nx x ny cells, each cut
# into four triangles by its diagonals, or whole with quads=1. With kn=1e9 each triangle is a block, held to
# the next ones by unbroken joints: the sub-block DDA. With ratio=100 the columns grow towards the
# tip, each by the same factor, until the last is 100 times as large as the first.
#     awk -v nx=8 -v ny=2 -v alpha=100 -v augment=0 -f doc/beam.awk > out/beam.model
function at(i,    q)
{
    q = ratio > 1 ? exp(log(ratio) / (nx - 1)) : 1
    return 48 * (q > 1 ? (q^i - 1) / (q^nx - 1) : i / nx)
}

BEGIN {
    print "title", nx * ny * 4, "triangles\nmaterial soft E 30e6 nu 0.3 density 1\nstatic"
    print "bond alpha", alpha, "augment", augment "\npcg tolerance 1e-11"
    for (j = 0; j <= ny; j++)
        for (i = 0; i <= nx; i++)
            print "node", j * (nx + 1) + i + 1, at(i), 12 * j / ny - 6
    for (j = 0; j < ny; j++)
        for (i = 0; i < nx; i++) {
            a = j * (nx + 1) + i + 1
            split(a " " a + 1 " " a + nx + 2 " " a + nx + 1, corner, " ")
            if (quads) {
                print "element", j * nx + i + 1, "beam soft", corner[1], corner[2], corner[3], corner[4]
                continue
            }
            c = (nx + 1) * (ny + 1) + j * nx + i + 1
            print "node", c, (at(i) + at(i + 1)) / 2, 12 * (j + 0.5) / ny - 6
            for (k = 1; k <= 4; k++) {
                e = 4 * (j * nx + i) + k
                print "element", e, (kn ? "b" e : "beam"), "soft", corner[k], corner[k % 4 + 1], c
            }
        }
    if (kn)
        print "contact kn", kn, "ks", kn, "friction 45 cohesion 1e9 tension 1e9"
    print "fix box 0 -6 0 6\nload box 48 -6 48 6 0 -1000\nmonitor middle at 24 0"
}
