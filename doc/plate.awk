# plate.awk - a quarter of a plate with a hole of radius 1 m, Experiment II, for paper.md:
# b metres long from the centre on and h (or b) wide, nx rings and ny rays (even) of quadrilaterals,
# or with tri=1 of two triangles for each.
#     awk -v b=5 -v nx=24 -v ny=16 -f doc/plate.awk > out/plate.model
BEGIN {
    h = h ? h : b
    far = b > h ? b : h
    corner = atan2(h, b)
    print "title plate of", 2 * b, "m\nmaterial stiff E 2900e9 nu 0.3 density 1 thickness 0.2"
    print "fix box 0 0 0", h, "x\nfix box 0 0", b, "0 y\ntraction box", b, 0, b, h, "1e6 0"
    print "monitor side at 1 0\nmonitor top at 0 1\nmonitor end at", b, "0\nmonitor edge at 0", h "\nstatic"
    for (j = 0; j <= ny; j++)
        for (i = 0; i <= nx; i++) {
            t = 2 * j / ny * corner
            if (2 * j > ny)
                t = corner + (2 * j / ny - 1) * (atan2(1, 0) - corner)
            c = j == ny ? 0 : cos(t)
            s = sin(t)
            edge = b * s > h * c ? h / s : b / c
            f = 1 + (far^(i / nx) - 1) / (far - 1) * (edge - 1)
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
