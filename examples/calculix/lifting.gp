# Tangential over normal force of the element with a normal direction; results of CalculiX.
set datafile separator ','
set datafile columnheaders
set encoding utf8
set border lw 1.0 lc rgb '#444444'
set grid lc rgb '#d8d8d8' lw 0.6 dt 1
set style line 1 lc rgb '#D55E00' lw 1.2 pt 7 ps 0.5
set style line 2 lc rgb '#222222' lw 1.4 dt (4,3)

wide = 1060
high = 460
set xlabel 'normal force (N)' offset 0, 0.3
set ylabel 'tangential force (N)' offset 0.8, 0
set key top left reverse Left samplen 2
set xrange [-10:*]

set terminal svg size wide, high dynamic background rgb 'white' font 'Helvetica,14'
set output '| python3 ../../tools/svg.py > results/lifting.svg'
set multiplot layout 1, 2 margins 0.075, 0.985, 0.14, 0.9 spacing 0.09
do for [name in 'lifting lifting_dynamic'] {
  set title name eq 'lifting' ? 'loads, slip, lift and return' : 'four periods of 300 Hz across, 200 Hz sideways'
  plot sprintf('%s/%s.csv', name eq 'lifting' ? 'results' : 'build/jobs', name) every (name eq 'lifting' ? 1 : 2) using 7:6 with linespoints ls 1 title 'CalculiX', \
       x < 0 ? NaN : 0.5*x with lines ls 2 title '±μN', x < 0 ? NaN : -0.5*x with lines ls 2 notitle
}
unset multiplot
