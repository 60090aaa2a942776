# The cylinder: seven straight paths, and loads that swing, by the law (lines) and by boundary elements (points).
load 'plots/style.gp'
wide = 920; high = 470
set xlabel 'tangential force  T / μN_0'
set ylabel '(displacement - T/K_0) over that of gross slip'

@set_terminal
set multiplot layout 1,2
set title 'steps in T, in N, and in both'
set key top left
set xrange [-0.25:1.05]
set yrange [-0.01:0.04]
plot file('contact_code_steps_law') using 1:2 with lines ls 1 lw 1.6 title 'law', \
     file('contact_code_steps') using 1:2 with points pt 6 ps 0.7 lc rgb '#D55E00' title 'boundary elements'
unset ylabel
set title 'N = N_0 (1 + 0.4 sin(ωt + φ)),  T = 0.4 μN_0 sin ωt'
set key top left samplen 4
set xrange [-0.44:0.44]
set yrange [-0.04:0.07]
name = 'contact_code_phases'
plot file(name.'_law') using 1:2 with lines ls 11 title 'N = N_0', '' using 3:4 with lines ls 3 lw 1.6 title 'φ = 0', \
     '' using 5:6 with lines ls 1 lw 1.6 title 'φ = 90°', '' using 7:8 with lines ls 4 lw 1.6 title 'φ = 180°', \
     file(name) using 1:2 with points pt 6 ps 0.5 lc rgb '#777777' notitle, \
     '' using 3:4 with points pt 6 ps 0.6 lc rgb '#0072B2' notitle, \
     '' using 5:6 with points pt 6 ps 0.6 lc rgb '#D55E00' notitle, \
     '' using 7:8 with points pt 6 ps 0.6 lc rgb '#009E73' notitle
