# plate.awk - a quarter of a plate with a hole of radius 1 m, Experiment II, for doc/paper.md: half
# as wide as b metres, nx rings and ny rays (even) of quadrilaterals, or with tri=1 of two triangles
# for each.
#     awk -v b=5 -v nx=24 -v ny=16 -f doc/plate.awk > out/plate.model
BEGIN {
    quarter = atan2(1, 0)
    print "title plate of", 2 * b, "m\nmaterial stiff E 2900e9 nu 0.3 density 1 thickness 0.2"
    print "fix box 0 0 0", b, "x\nfix box 0 0", b, "0 y\ntraction box", b, 0, b, b, "1e6 0"
    print "monitor side at 1 0\nmonitor top at 0 1\nmonitor end at", b, "0\nmonitor edge at 0", b "\nstatic"
    for (j = 0; j <= ny; j++)
        for (i = 0; i <= nx; i++) {
            c = j == ny ? 0 : cos(quarter * j / ny)
            s = sin(quarter * j / ny)
            r = b^(i / nx)
            far = (r - 1) / (b - 1)
            f = 1 + far * (b / (c > s ? c : s) - 1)
            printf "node %d %.15g %.15g\n", j * (nx + 1) + i + 1, f * c, f * s
        }
    for (j = 0; j < ny; j++)
        for (i = 0; i < nx; i++) {
            a = j * (nx + 1) + i + 1
            e = 2 * (j * nx + i) + 1
            if (tri) {
                print "element", e, "plate stiff", a, a + 1, a + nx + 2
                print "element", e + 1, "plate stiff", a, a + nx + 2, a + nx + 1
            } else
                print "element", e, "plate stiff", a, a + 1, a + nx + 2, a + nx + 1
        }
}
