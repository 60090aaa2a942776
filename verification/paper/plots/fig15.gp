# Fig. 15: energy of a cycle over the force, linear (a) and logarithmic (b).
wide = 1000; high = 500
set xlabel force

@set_terminal
set multiplot layout 1, 2
do for [panel in 'a b'] {
  set title sprintf('(%s)', panel)
  set ylabel energy
  if (panel eq 'a') { set key top left; set xrange [0:1.05]; set yrange [0:1.1] } \
  else {
    set logscale xy; set xrange [0.01:1.3]; set yrange [1e-9:10]; set format y '10^{%T}'
    unset key
    set label 1 'slope 3' at 0.03, 3e-4 right
    set label 2 'lines as in (a)' at graph 0.95, 0.06 right
  }
  cube(x) = panel eq 'a' || x > 0.1 ? NaN : 3*x**3
  plot for [i = 2:6] file(name.panel) using 1:i with lines ls i-1 title columnheader(i), \
       '< printf "x,y\n1,1\n"' using 1:2 with points pt 6 ps 1.6 lw 1.6 lc rgb 'black' title 'Eq. 16', \
       cube(x) with lines ls 12 notitle
  unset format
  unset label
}
unset logscale
unset multiplot
