# Time against error of the harmonic force, one panel per number of harmonics. `from`: bench.csv; `to`: directory.
set datafile separator ','
set encoding utf8

# Colours that colour-blind readers distinguish (Okabe and Ito); markers and dashes differ too.
set style line 1 lc rgb '#0072B2' lw 2.4 dt 1     pt 7  ps 1.0
set style line 2 lc rgb '#0072B2' lw 2.4 dt (6,3) pt 6  ps 1.0
set style line 4 lc rgb '#555555' lw 1.6 dt 1     pt 11 ps 1.0
set style line 5 lc rgb '#000000' lw 1.6 dt (2,3) pt 2  ps 1.0

set border lw 1.0 lc rgb '#444444'
set grid lc rgb '#d8d8d8' lw 0.6 dt 1
set logscale xy
set format '10^{%T}'
set xrange [1e-17:10]
set xtics 1e-16, 1e4, 1
set mxtics 1
set key at screen 0.53, screen 0.11 center top maxrows 2 Left reverse samplen 2 font ',12.5'

# Error, and median time in ns, of one method; errors of 0 are drawn at 1e-17.
rows(harmonics, method) = sprintf( \
  "< awk -F, -v OFS=, '$1 == \"harmonic\" && $2 == 0.9 && $3 == 0.95 && $4 == %d && $6 == \"%s\" { \
  print ($7 > 1e-17 ? $7 : 1e-17), $8 }' %s", harmonics, method, from)

set terminal svg size 1280, 540 dynamic background rgb 'white' font 'Helvetica,14'
set output sprintf('| python3 ../../tools/svg.py > %s/harmonic.svg', to)
set xlabel 'error of the first harmonic, relative'
set ylabel 'time of force and Jacobian (ns)'
set yrange [100:1e8]
set multiplot layout 1, 3 margins 0.07, 0.985, 0.24, 0.925 spacing 0.065, 0
do for [panel = 1:3] {
  h = 4*panel - 3
  of(method) = rows(h, method)
  set title sprintf('%d harmonic%s', h, h == 1 ? '' : 's')
  plot of('microslip')              with linespoints ls 1 title panel == 1 ? 'microslip, 16 to 1024 samples' : '', \
       of('microslip event-driven') with linespoints ls 2 title panel == 1 ? 'microslip, event-driven' : '', \
       of('sliders')                with linespoints ls 4 title panel == 1 ? '4 to 4096 sliders, 128 samples' : '', \
       of('spring-slider') with linespoints ls 5 title panel == 1 ? 'one spring-slider, 16 to 1024 samples' : ''
}
unset multiplot
