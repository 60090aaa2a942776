# Fig. 3: pressure for several a/b.
wide = 720; high = 480
set xlabel place
set ylabel 'pressure  b p / P'
set xrange [-1.05:1.05]
set yrange [0:1.6]
set key top center maxrows 3 width -3

@set_terminal
plot file(name) using 1:2 with lines ls 1 title 'a/b = 0 (Hertz)', \
     for [i = 3:7] '' using 1:i with lines ls i-1 title columnheader(i)
