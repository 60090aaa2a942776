# Harmonic balance of the element against Newmark's method: the normal force at side 1 of the damper that lifts off, the differences
# against the number of harmonics.
load 'plots/style.gp'
name = 'steady_states'
wide = 1120
high = 470

set style line 21 lc rgb '#b0b0b0' lw 6.0 dt 1       # time integration: broad, below the others
set style line 22 lc rgb '#CC79A7' lw 1.8 dt (8,4)   # 5 harmonics
set style line 23 lc rgb '#0072B2' lw 1.8 dt 1       # 15 harmonics
set style line 31 lc rgb '#009E73' lw 1.8 dt 1     pt 7 ps 0.9
set style line 32 lc rgb '#D55E00' lw 1.8 dt (8,4) pt 5 ps 0.9
set style line 33 lc rgb '#222222' lw 1.6 dt (2,3) pt 9 ps 1.0

wave(harmonics) = (column('harmonics') == harmonics && column('excitation_factor') > 2 ? column('contact_normal_force_N') : NaN)
# The balance of the case itself and those with fewer samples are not shown.
difference(factor) = (column('samples') == 1024 && abs(column('excitation_factor') - factor) < 0.01 ? column('response_difference') : NaN)

do for [extension in 'svg png'] {
  @set_terminal
  set multiplot layout 1, 2
  set title 'wedge damper that lifts off: 3 N, 334 Hz'
  set xlabel 'phase of the excitation (degrees)'
  set ylabel 'normal force of side 1 (N)'
  set xrange [0:360]
  set xtics 0, 90, 360
  set yrange [-3:*]
  set key top left Left reverse samplen 2
  plot for [i=1:3] 'results/wedge_waveforms.csv' using (57.29578*column('phase_rad')):(wave(word('0 5 15', i) + 0)) \
    with lines ls 20+i title word('Newmark "5 harmonics" "15 harmonics"', i)
  set title 'difference of the response, relative'
  set logscale y
  set format y '10^{%T}'
  set xlabel 'harmonics of the balance'
  unset ylabel
  set xrange [0:26]
  set xtics (1, 3, 5, 9, 15, 25)
  set yrange [1e-3:1]
  set key top right
  plot 'results/wedge_comparison.csv' using 'harmonics':(difference(1.4)) with linespoints ls 31 title 'wedge, slip, 1.4 N', \
       'results/wedge_comparison.csv' using 'harmonics':(difference(3.0)) with linespoints ls 32 title 'wedge, lift-off, 3 N', \
       'results/shroud_comparison.csv' using 'harmonics':(difference(10.0)) with linespoints ls 33 title 'shroud, opening, 10 N'
  unset logscale
  set format '%g'
  unset multiplot
  unset output
}
