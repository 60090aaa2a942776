# The cylinder in two directions: forces and energy along two orbits, by the law (lines), boundary elements (points) and two elements
# at right angles (dashed).
load '../paper/plots/style.gp'
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
plot for [i = 0:1] file(name) using 9*i+7:9*i+8 with lines ls 12 notitle, \
     for [i = 0:1] '' using 9*i+1:9*i+2 with lines ls 1+2*i lw 1.6 dt 1 notitle, \
     for [i = 0:1] '' using 9*i+4:9*i+5 with points pt 6 ps 0.7 lc rgb '#D55E00' notitle
set size noratio
set xlabel 'step'
set ylabel 'dissipated energy / μN δ_{slip}'
set key top left samplen 3
set xrange [0:30]
set yrange [0:*]
plot file(name) using 0:3 with lines ls 1 lw 1.6 title 'circle 0.9: law', \
     '' using 0:12 with lines ls 3 lw 1.6 dt 1 title 'circle 0.4, N from 0.04 to 1: law', \
     for [i = 0:1] '' using 0:9*i+6 with points pt 6 ps 0.7 lc rgb '#D55E00' title (i ? '' : 'boundary elements'), \
     for [i = 0:1] '' using 0:9*i+9 with lines ls 12 title (i ? '' : 'two elements at right angles')
