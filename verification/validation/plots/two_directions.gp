# The cylinder in two directions: forces and energy along two orbits (colours), by the law (lines), boundary elements (points) and
# two elements at right angles (dots).
load 'plots/style.gp'
wide = 920; high = 470
name = 'two_directions'

@set_terminal
set multiplot layout 1,2
set xlabel 'T_x / μN'
set ylabel 'T_y / μN'
set key off
set xrange [-1.35:1.35]
set yrange [-1.35:1.35]
set size ratio -1
colour(i) = i ? 0x0072B2 : 0x000000
plot for [i = 0:1] file(name) using 9*i+7:9*i+8 with lines lw 1.8 dt (2,3) lc rgb colour(i) notitle, \
     for [i = 0:1] '' using 9*i+1:9*i+2 with lines lw 1.6 lc rgb colour(i) notitle, \
     for [i = 0:1] '' using 9*i+4:9*i+5 with points pt 6 ps 0.7 lc rgb colour(i) notitle
set size noratio
set xlabel 'step'
set ylabel 'dissipated energy / μN δ_{slip}'
set key top left samplen 3
set xrange [0:30]
set yrange [0:1.1]
plot for [i = 0:1] file(name) using 0:9*i+3 with lines lw 1.6 lc rgb colour(i) notitle, \
     for [i = 0:1] '' using 0:9*i+6 with points pt 6 ps 0.7 lc rgb colour(i) notitle, \
     for [i = 0:1] '' using 0:9*i+9 with lines lw 1.8 dt (2,3) lc rgb colour(i) notitle, \
     NaN with lines lw 6 lc rgb colour(0) title 'circle 0.9', \
     NaN with lines lw 6 lc rgb colour(1) title 'circle 0.4, N from 0.04 to 1', \
     NaN with lines lw 1.6 lc rgb '#777777' title 'law', \
     NaN with points pt 6 ps 0.7 lc rgb '#777777' title 'boundary elements', \
     NaN with lines lw 1.8 dt (2,3) lc rgb '#777777' title 'two elements at right angles'
