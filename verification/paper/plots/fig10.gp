# Fig. 10: stiffness over the normal load for several a/R, and with Eq. 1 as it is printed.
wide = 720; high = 520
set xlabel 'normal load  P / (E^* R)'
set ylabel 'tangential stiffness  K / (E^* L)'
set xrange [0:0.01]
set yrange [0.05:0.45]
set key bottom right
set label 1 'L/R = 10' at graph 0.03, 0.95

@set_terminal
plot for [i = 5:2:-1] file(name) using 1:i with lines ls i-1 title columnheader(i), \
     for [i = 6:9] '' using 1:i with lines ls 11 title (i == 6 ? 'each with Eq. 1 as printed' : '')
