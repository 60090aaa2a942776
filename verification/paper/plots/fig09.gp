# Fig. 9: loops up to incipient gross slip for several L/b.
wide = 720; high = 520
set xlabel displacement
set ylabel force
set xrange [-6:6]
set yrange [-1.1:1.1]
set key bottom right
set label 1 'a/b = 0.1' at graph 0.03, 0.94

@set_terminal
plot for [i = 1:4] file(name) using 2*i-1:2*i with lines ls i title columnheader(2*i)
