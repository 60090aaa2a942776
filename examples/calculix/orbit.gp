# The element that slides in two directions: orbits of displacement and force; results of CalculiX.
set datafile separator ','
set datafile columnheaders
set encoding utf8
set border lw 1.0 lc rgb '#444444'
set grid lc rgb '#d8d8d8' lw 0.6 dt 1
set style line 1 lc rgb '#D55E00' lw 1.2 pt 7 ps 0.5
set style line 2 lc rgb '#222222' lw 1.4 dt (4,3)

wide = 1060
high = 540
set size ratio -1
set key top left reverse Left samplen 2
set samples 200

set terminal svg size wide, high dynamic background rgb 'white' font 'Helvetica,14'
set output '| python3 ../../tools/svg.py > results/orbit.svg'
set multiplot layout 1, 2 margins 0.075, 0.985, 0.13, 0.92 spacing 0.09
set title 'two turns of the load'
set xlabel 'displacement v along the blade (µm)' offset 0, 0.3
set ylabel 'displacement u across the blade (µm)' offset 0.8, 0
plot [-3.5:0.5] [-2:2] 'results/orbit.csv' using (1e3*$6):(1e3*$5) with linespoints ls 1 title 'CalculiX'
set title 'tangential over normal force'
set xlabel 'T_y/N along the blade' offset 0, 0.3
set ylabel 'T_x/N across the blade' offset 0.8, 0
plot [-0.6:0.6] [-0.6:0.6] 'results/orbit.csv' using ($9/$10):($8/$10) with linespoints ls 1 title 'CalculiX', \
     [t=0:2*pi] '+' using (0.5*cos(t)):(0.5*sin(t)) with lines ls 2 title 'μ'
unset multiplot
