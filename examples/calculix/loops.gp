# Results of CalculiX, and the curves of the library that `compare` writes into build/jobs.
set datafile separator ','
set datafile columnheaders
set encoding utf8
set border lw 1.0 lc rgb '#444444'
set grid lc rgb '#d8d8d8' lw 0.6 dt 1
set style line 1 lc rgb '#0072B2' lw 1.6
set style line 2 lc rgb '#D55E00' pt 7 ps 0.45

wide = 1060
high = 460
set xlabel 'displacement of the contact (µm)' offset 0, 0.3
set ylabel 'force of the contact (N)' offset 0.8, 0
set key top left reverse Left samplen 2
set offsets graph 0.04, graph 0.04, graph 0.12, graph 0.06

set terminal svg size wide, high dynamic background rgb 'white' font 'Helvetica,14'
set output '| python3 ../../tools/svg.py > results/loops.svg'
set multiplot layout 1, 2 margins 0.075, 0.985, 0.14, 0.92 spacing 0.09
set title 'loads back and forth'
plot 'build/jobs/static_curve.csv' using (1e3*$1):2 with lines ls 1 title 'microslip', \
     'results/static.csv' using (1e3*$3):4 with points ls 2 ps 0.8 title 'CalculiX'
set title 'five periods of 380 Hz from rest, every fourth increment'
plot 'build/jobs/dynamic_curve.csv' using (1e3*$1):2 with lines ls 1 title 'microslip', \
     'build/jobs/dynamic.csv' using (1e3*$3):4 every 4 with points ls 2 ps 0.4 title 'CalculiX'
unset multiplot
