# Imaginary (a) and real part (b) of the complex stiffness; `name`, the last column and a label are given.
wide = 1000; high = 470
set xlabel amplitude
set xrange [0:12]

@set_terminal
set multiplot layout 1, 2
do for [panel in 'a b'] {
  set title sprintf('(%s)  %s', panel, label)
  if (panel eq 'a') { set ylabel "imaginary part  K'' / (E^* L)"; set key bottom right } \
  else { set ylabel "real part  K' / (E^* L)"; set key top right }
  plot for [i = 2:last] file(name.panel) using 1:i with lines ls i-1 title columnheader(i)
}
unset multiplot
