# pulse.awk - a half-sine of 0.5 s or a Ricker pulse of 2 Hz, 4 m/s^2: awk -v shape=sine -f pulse.awk > pulse.csv
BEGIN {
    pi = atan2(0, -1)
    for (k = 0; k <= 200; k++) {
        t = k/200
        q = (2*pi*(t - 0.5))^2
        print t "," 4*(shape == "sine" ? (t < 0.5)*sin(2*pi*t) : (1 - 2*q)*exp(-q))
    }
}
