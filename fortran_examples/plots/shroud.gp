# Shrouds that open. Left: element. Right: the law of constant normal force with a linear normal spring.
load 'plots/style.gp'
name = 'shroud'
wide = 1120
high = 480

# Without the smallest excitation, whose response is that of the next one within 0.3 %.
array colours[6] = ['', '#440154', '#31688e', '#21918c', '#35b779', '#c9b400']
stats 'results/shroud_peaks.csv' using (column('load')) nooutput
array excitation[STATS_records]
stats 'results/shroud_peaks.csv' using (excitation[int(column('load'))] = column('excitation_factor')) nooutput

set logscale y
set xrange [240:430]
set yrange [3:300]
set xlabel 'frequency (Hz)'
amplitude(n) = (int(column('load')) == n ? micro(column('peak_m')) / column('excitation_factor') : NaN)
open(n) = (column('shroud_open_fraction') > 0 ? amplitude(n) : NaN)

@set_terminal
set multiplot layout 1, 2
set ylabel 'amplitude over the excitation (µm/N)'
set title 'element; thick if open in a part of the period'
set key top right Left reverse samplen 2 title 'excitation (N)' font ',13' maxrows 3
plot for [i=2:6] 'results/shroud_response.csv' using 'frequency_hz':(amplitude(i)) with lines lw 1.4 lc rgb colours[i] \
       title (i > 2 ? '' : sprintf('%g, ', excitation[1])).sprintf('%g', excitation[i]), \
     for [i=2:6] 'results/shroud_response.csv' using 'frequency_hz':(open(i)) with lines lw 3.2 lc rgb colours[i] notitle
set title 'constant normal force'
unset ylabel
unset key
plot for [i=2:6] 'results/shroud_constant_response.csv' using 'frequency_hz':(amplitude(i)) with lines lw 1.4 lc rgb colours[i]
unset multiplot
