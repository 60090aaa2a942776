# Harmonic balance against Newmark's method: one period at the damper, and differences against the number of harmonics.
load 'plots/style.gp'
name = 'newmark'
wide = 1060
high = 820

set style line 21 lc rgb '#b0b0b0' lw 6.0 dt 1       # time integration: broad, below the others
set style line 22 lc rgb '#CC79A7' lw 1.8 dt (8,4)   # 1 harmonic
set style line 23 lc rgb '#0072B2' lw 1.8 dt 1       # 5 harmonics
set style line 24 lc rgb '#222222' lw 1.6 dt (2,3)   # 25 harmonics
set style line 31 lc rgb '#009E73' lw 1.8 dt 1     pt 7 ps 0.9
set style line 32 lc rgb '#D55E00' lw 1.8 dt (8,4) pt 5 ps 0.9
set style line 33 lc rgb '#222222' lw 1.6 dt (2,3) pt 9 ps 1.0

# The two groups &time_integration of cylinder.nml; above, the middle one of their three frequencies.
differences = 'results/cylinder_comparison.csv'
array normal_force[2] = [250, 7]
array frequency[6] = [464.0, 464.6, 465.6, 420, 425, 430]

same(a, b) = abs(a - b) < 1e-6 * abs(b)
# The balance of the case itself, with 128 samples, is not shown.
wave(harmonics) = (column('harmonics') == harmonics && column('points') != 128 && same(column('frequency_hz'), f) \
  ? micro(column('contact_displacement_m')) : NaN)
names = 'Newmark "1 harmonic" "5 harmonics" "25 harmonics"'
# All have the same phases.
array newmark[257]
sample(dummy) = int(128*column('phase_rad')/pi + 1.5)
row(f) = (same(column('frequency_hz'), f) && column('samples') != 128 ? column('response_difference') : NaN)

@set_terminal
set multiplot layout 2, 2
do for [c=1:2] {
  f = frequency[3*(c-1) + 2]
  unset logscale
  set title sprintf('damper at %g N, %g Hz', normal_force[c], f)
  set xlabel 'phase of the excitation (degrees)'
  set format '%g'
  set xrange [0:360]
  set xtics 0, 90, 360
  set yrange [*:*]
  set offsets 0, 0, graph 0.35, graph 0.05
  set key top left Left reverse samplen 2 maxrows 2 font ',13'
  # The curves under 250 N would coincide: their differences are drawn.
  if (c == 1) {
    set ylabel 'displacement less that of Newmark (nm)'
    stats 'results/cylinder_waveforms.csv' using (wave(0) == wave(0) ? newmark[sample(0)] = wave(0) : NaN) nooutput
    plot for [i=2:4] 'results/cylinder_waveforms.csv' \
      using (57.29578*column('phase_rad')):(1e3*(wave(word('0 1 5 25', i) + 0) - newmark[sample(0)])) \
      with lines ls 20+i title word(names, i)
  } else {
    set ylabel 'displacement at the damper (µm)'
    plot for [i=1:4] 'results/cylinder_waveforms.csv' \
      using (57.29578*column('phase_rad')):(wave(word('0 1 5 25', i) + 0)) with lines ls 20+i title word(names, i)
  }
}
set offsets 0, 0, 0, 0
set logscale y
set format y '10^{%T}'
set xlabel 'harmonics of the balance'
set ylabel 'largest difference of the tip, relative'
set xrange [0:26]
set xtics (1, 3, 5, 9, 15, 25)
do for [c=1:2] {
  set title sprintf('damper at %g N', normal_force[c])
  set yrange [3e-5:10]
  set key top right Left reverse samplen 3 maxrows 3 font ',13'
  plot for [i=1:3] differences using 'harmonics':(row(frequency[3*(c-1) + i])) \
    with linespoints ls 30+i title sprintf('%g Hz', frequency[3*(c-1) + i])
}
unset multiplot
