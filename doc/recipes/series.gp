set datafile separator ","
set terminal svg; set output "series.svg"
set xlabel "t [s]"; set ylabel "u [m]"; set key left bottom
plot for [p in "10 15 20 25"] "phi".p."/history.csv" using "t":"corner_u" with lines title "phi = ".p
stats "phi20/history.csv" using "corner_u" nooutput; set print "-"; print STATS_min
