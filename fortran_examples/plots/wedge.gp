# The wedge damper: responses per unit of excitation, damping by friction, and tangential over normal force at one side.
load 'plots/style.gp'
name = 'wedge'
wide = 1240
high = 430

# Numbers of the excitations shown.
shown = '2 5 8 11'
array colours[4] = ['#440154', '#31688e', '#35b779', '#c9b400']
stats 'results/wedge_peaks.csv' using (column('load')) nooutput
array excitation[STATS_records]
stats 'results/wedge_peaks.csv' using (excitation[int(column('load'))] = column('excitation_factor')) nooutput
at_load(n) = (int(column('load')) == n ? micro(column('peak_m')) / column('excitation_factor') : NaN)
lifted(dummy) = (column('side_1_open_fraction') > 0 ? 100 * column('friction_damping_ratio') : NaN)
steady(factor) = (column('harmonics') == 0 && column('excitation_factor') == factor ? column('force_N') : NaN)

@set_terminal
set multiplot layout 1, 3
set title 'response'
set logscale y
set xrange [300:500]
set yrange [5:3000]
set xlabel 'frequency (Hz)'
set ylabel 'amplitude over the excitation (µm/N)'
set key top right Left reverse samplen 2
plot for [i=1:4] 'results/wedge_response.csv' using 'frequency_hz':(at_load(int(word(shown, i)))) with lines lw 2.4 lc rgb colours[i] \
  title sprintf('%g N', excitation[int(word(shown, i))])
set title 'damping by friction in the peak'
set logscale x
set xrange [0.007:5]
set yrange [0.03:20]
set xlabel 'excitation (N)'
set ylabel 'equivalent damping ratio (%)'
set key bottom center
plot 'results/wedge_peaks.csv' using 'excitation_factor':(100 * column('friction_damping_ratio')) with linespoints ls 1 notitle, \
     'results/wedge_peaks.csv' using 'excitation_factor':(lifted(0)) with points pt 6 ps 2 lw 2 lc rgb '#D55E00' title 'lifts off'
unset logscale
set title 'side 1 by time integration'
set xrange [-2:*]
set yrange [*:*]
set xlabel 'normal force (N)'
set ylabel 'tangential force (N)'
set key top left
plot for [i=1:2] 'results/wedge_waveforms.csv' using 'normal_force_N':(steady(word('1.4 3', i) + 0)) with lines lw 2.4 \
  lc rgb colours[5 - 2*i] title word('1.4 3', i).' N'
unset multiplot
