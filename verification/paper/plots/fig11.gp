# Fig. 11: initial loading of cylinder and elliptical contact.
wide = 720; high = 480
set xlabel displacement
set ylabel force
set xrange [0:5.6]
set yrange [0:1.15]
set key bottom right
set label 1 'L/b = 10' at graph 0.03, 0.95

@set_terminal
plot file(name) using 1:4 with lines ls 12 title 'common tangent', \
     '' using 1:2 with lines ls 1 title 'cylinder, length L', \
     '' using 1:3 with lines ls 2 title 'ellipse, semi-axes b and L/2'
