# Fig. 8: loops of two shapes with equal amplitudes, in microslip and in gross slip.
wide = 720; high = 520
set xlabel displacement
set ylabel force
set xrange [-5.6:5.6]
set yrange [-1.15:1.15]
set key bottom right
set label 1 'L/b = 10' at graph 0.03, 0.94

@set_terminal
plot file(name) using 5:6 with lines ls 1 lw 1.4 title 'a/b = 0.1, gross slip', \
     '' using 7:8 with lines ls 2 lw 1.4 title 'a/b = 0.9, gross slip', \
     '' using 1:2 with lines ls 1 lw 2.8 title 'a/b = 0.1, microslip', \
     '' using 3:4 with lines ls 2 lw 2.8 title 'a/b = 0.9, microslip'
