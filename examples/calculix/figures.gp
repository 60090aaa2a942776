# The figures in results/: results of CalculiX, and the curves of the library that `compare.py` writes into build/jobs.
set datafile separator ','
set datafile columnheaders
set encoding utf8
set border lw 1.0 lc rgb '#444444'
set grid lc rgb '#d8d8d8' lw 0.6 dt 1
set style line 1 lc rgb '#0072B2' lw 1.6
set style line 2 lc rgb '#D55E00' lw 1.2 pt 7 ps 0.5
set style line 3 lc rgb '#222222' lw 1.4 dt (4,3)
set key top left reverse Left samplen 2
set samples 200
figure = "set terminal svg size 1060, high dynamic background rgb 'white' font 'Helvetica,14'; \
  set output sprintf('| python3 ../../tools/svg.py > results/%s.svg', name); \
  set multiplot layout 1, 2 margins 0.075, 0.985, 0.14, 0.9 spacing 0.09"

name = 'loops'
high = 460
set xlabel 'displacement of the contact (µm)' offset 0, 0.3
set ylabel 'force of the contact (N)' offset 0.8, 0
set offsets graph 0.04, graph 0.04, graph 0.12, graph 0.06
@figure
set title 'loads back and forth'
plot 'build/jobs/static_curve.csv' using (1e3*$1):2 with lines ls 1 title 'microslip', \
     'results/static.csv' using (1e3*$3):4 with points ls 2 ps 0.8 title 'CalculiX'
set title 'five periods of 380 Hz from rest, every fourth increment'
plot 'build/jobs/dynamic_curve.csv' using (1e3*$1):2 with lines ls 1 title 'microslip', \
     'build/jobs/dynamic.csv' using (1e3*$3):4 every 4 with points ls 2 ps 0.4 title 'CalculiX'
unset multiplot
set offsets

name = 'lifting'
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
