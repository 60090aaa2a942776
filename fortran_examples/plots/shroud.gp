# Shrouds that open. Left: element. Right: the law of constant normal force with a linear normal spring.
load 'plots/style.gp'
name = 'shroud'
wide = 1120
high = 480

array colours[6] = ['#440154', '#443983', '#31688e', '#21918c', '#35b779', '#c9b400']
stats 'results/shroud_peaks.csv' using (column('load')) nooutput
array excitation[STATS_records]
stats 'results/shroud_peaks.csv' using (excitation[int(column('load'))] = column('excitation_factor')) nooutput

set logscale y
set xrange [240:430]
set yrange [3:100]
set xlabel 'frequency (Hz)'
amplitude(n) = (int(column('load')) == n ? micro(column('peak_m')) / column('excitation_factor') : NaN)
closed(n) = (column('shroud_open_fraction') > 0 ? NaN : amplitude(n))
open(n) = (column('shroud_open_fraction') > 0 ? amplitude(n) : NaN)

do for [extension in 'svg png'] {
  @set_terminal
  set multiplot layout 1, 2 margins 0.075, 0.9, 0.13, 0.9 spacing 0.03, 0
  set ylabel 'amplitude of the blade over the excitation (µm/N)'
  set title 'element: thick where the shrouds open in each period'
  unset key
  plot for [i=1:6] 'results/shroud_response.csv' using 'frequency_hz':(amplitude(i)) with lines lw 1.4 lc rgb colours[i], \
       for [i=1:6] 'results/shroud_response.csv' using 'frequency_hz':(open(i)) with lines lw 3.2 lc rgb colours[i]
  set title 'constant normal force'
  unset ylabel
  set format y ''
  set key at graph 1.04, 0.97 left top Left reverse samplen 2 spacing 1.3 title "excitation\n(N)" left font ',13'
  plot for [i=1:6] 'results/shroud_constant_response.csv' using 'frequency_hz':(amplitude(i)) with lines lw 1.6 lc rgb colours[i] \
    title sprintf('%g', excitation[i])
  unset multiplot
  set format y '%g'
  unset output
}
