# rocking.awk - a block 1 m wide and h high, turned by the share of its slope a = atan(1/h) about
# its lower left corner, for Exercise 6.9.
#     awk -v h=5 -v share=0.5 -f doc/exercises/rocking.awk > out/rocking.model
function corner(id, x, y)
{
    printf "node %d %.12f %.12f\n", id, x * cos(t) - y * sin(t), x * sin(t) + y * cos(t)
}

BEGIN {
    t = share * atan2(1, h)
    print "title A block rocks\nmaterial rigid E 1e14 nu 0.25 density 2500"
    print "material rock E 1e12 nu 0 density 2500\nfixblock plate\ngravity 0 -9.81"
    print "contact kn 1e11 ks 4e10 friction 60\ndynamic dt 0.001 steps 2500\nmonitor right node 6"
    print "node 1 -2 -0.5\nnode 2 3 -0.5\nnode 3 3 0\nnode 4 -2 0\nelement 1 plate rigid 1 2 3 4"
    corner(5, 0, 0)
    corner(6, 1, 0)
    corner(7, 1, h)
    corner(8, 0, h)
    print "element 2 block rock 5 6 7 8"
}
