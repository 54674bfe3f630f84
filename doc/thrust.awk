# thrust.awk - the line of thrust of a semicircular arch of n voussoirs, R = 1, for rho g = 1:
#     awk -v n=15 -f doc/thrust.awk
# prints the least t/R, and the least friction of thicker arches. doc/beyond-scenes.md.

# W and W x of joint k <= n/2, counted from the right springing. A voussoir is a trapezium; of an odd
# number one lies across the crown.
function weigh(t, k,    ri, ro, b, A, d, i)
{
    ri = 1 - t/2; ro = 1 + t/2; b = pi/n
    A = (ro*ro - ri*ri)/2*sin(b)
    d = (ro*ro + ro*ri + ri*ri)/(ro + ri)
    W = n % 2*A/2
    Wx = W*d/3*sin(b/2)
    for (i = k; i < int(n/2); i++) {
        W += A
        Wx += A*2/3*cos(b/2)*d*cos((i + 0.5)*b)
    }
}

# Where the thrust H crosses all joints, H h has so much room: it is concave in H.
function room(t, H,    k, low, high, along, a, b)
{
    low = -1e9; high = 1e9
    for (k = 0; k <= int(n/2); k++) {
        weigh(t, k)
        along = H*sin(k*pi/n) + W*cos(k*pi/n)
        a = (1 - t/2)*along - Wx; b = (1 + t/2)*along - Wx
        low = a > low ? a : low; high = b < high ? b : high
    }
    return high - low
}

function roomiest(t,    low, high, a, b)
{
    for (high = 10*t; high - low > 1e-10; ) {
        a = low + (high - low)/3; b = high - (high - low)/3
        if (room(t, a) < room(t, b)) low = a; else high = b
    }
    return low
}

function least_friction(t,    low, high, mid, k, need, most)
{
    for (high = roomiest(t); high - low > 1e-10; ) {
        mid = (low + high)/2
        if (room(t, mid) < 0) low = mid; else high = mid
    }
    for (k = 0; k <= int(n/2); k++) {
        weigh(t, k)
        need = (high*cos(k*pi/n) - W*sin(k*pi/n))/(high*sin(k*pi/n) + W*cos(k*pi/n))
        need = need < 0 ? -need : need; most = need > most ? need : most
    }
    return atan2(most, 1)*180/pi
}

BEGIN {
    pi = atan2(0, -1)
    for (high = 0.2 + (low = 0.05); high - low > 1e-8; ) {
        mid = (low + high)/2
        if (room(mid, roomiest(mid)) < 0) low = mid; else high = mid
    }
    printf "least t/R: %.4f\n", high
    for (k = split("0.107 0.11 0.13 0.15", t, " "); k > 0 && n == 15; k--)
        printf "least friction [degrees], t/R = %s: %.4f\n", t[5 - k], least_friction(t[5 - k])
}
