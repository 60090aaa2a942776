# The figures in results/: results of CalculiX.
set datafile separator ','
set datafile columnheaders
set encoding utf8
set border lw 1.0 lc rgb '#444444'
set grid lc rgb '#d8d8d8' lw 0.6 dt 1
set style line 2 lc rgb '#D55E00' lw 1.2 pt 7 ps 0.5
set style line 3 lc rgb '#222222' lw 1.4 dt (4,3)
set key top left reverse Left samplen 2
set samples 200
figure = "set terminal svg size 1060, high dynamic background rgb 'white' font 'Helvetica,14'; \
  set output sprintf('| python3 ../../tools/svg.py > results/%s.svg', name); \
  set multiplot layout 1, 2 margins 0.075, 0.985, 0.14, 0.9 spacing 0.09"

name = 'lifting'
high = 460
set xlabel 'normal force (N)'
set ylabel 'tangential force (N)'
set xrange [-10:*]
@figure
do for [job in 'results/lifting build/jobs/lifting_dynamic'] {
  set title job eq 'results/lifting' ? 'loads, slip, lift and return' : 'four periods of 300 Hz across, 200 Hz sideways'
  plot job.'.csv' every (job eq 'results/lifting' ? 1 : 2) using 7:6 with linespoints ls 2 title 'CalculiX', \
       x < 0 ? NaN : 0.5*x with lines ls 3 title '±μN', x < 0 ? NaN : -0.5*x with lines ls 3 notitle
}
unset multiplot

name = 'orbit'
high = 540
set size ratio -1
@figure
set title 'two turns of the load'
set xlabel 'displacement v along the blade (µm)'
set ylabel 'displacement u across the blade (µm)'
plot [-3.5:0.5] [-2:2] 'results/orbit.csv' using (1e3*$6):(1e3*$5) with linespoints ls 2 title 'CalculiX'
set title 'tangential over normal force'
set xlabel 'T_y/N along the blade'
set ylabel 'T_x/N across the blade'
plot [-0.6:0.6] [-0.6:0.6] 'results/orbit.csv' using ($9/$10):($8/$10) with linespoints ls 2 title 'CalculiX', \
     [t=0:2*pi] '+' using (0.5*cos(t)):(0.5*sin(t)) with lines ls 3 title 'μ'
unset multiplot
