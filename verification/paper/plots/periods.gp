# Energy and mean force of a vibration across a mean displacement, over the periods before the one that counts.
load 'plots/style.gp'
name = 'periods'; wide = 1000; high = 420
set xlabel 'periods before the one that counts'
set logscale x
set xrange [1:48]
set xtics (1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48)
set key top right samplen 3.5

@set_terminal
set multiplot layout 1, 2
set title '(a) energy'; set ylabel 'energy / energy of the steady state'; set yrange [0.9:2.1]
plot for [i = 2:4] file(name.'_a') using 1:i with linespoints ls (i-1) pt 7 ps 0.5 title columnheader(i)
set title '(b) mean force along x'; set ylabel 'mean of T_x / μN'; set yrange [0.5:0.9]
plot for [i = 2:4] file(name.'_b') using 1:i with linespoints ls (i-1) pt 7 ps 0.5 notitle
unset multiplot
