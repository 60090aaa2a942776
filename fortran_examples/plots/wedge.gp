# The wedge damper. Left: response per unit of excitation, element against the law of constant normal force. Middle: damping ratio
# of friction at the peak. Right: tangential over normal force at one side in the peak.
load 'plots/style.gp'
name = 'wedge'
wide = 1240
high = 470

# Numbers of the excitations on the left; all but the second on the right. A colour is an excitation, dashes are the constant load.
shown = '2 5 8 11'
array colours[4] = ['#440154', '#31688e', '#35b779', '#c9b400']
stats 'results/wedge_peaks.csv' using (column('load')) nooutput
array excitation[STATS_records]
stats 'results/wedge_peaks.csv' using (excitation[int(column('load'))] = column('excitation_factor')) nooutput

at_load(n) = (int(column('load')) == n ? micro(column('peak_m')) / column('excitation_factor') : NaN)
lifted(dummy) = (column('side_1_open_fraction') > 0 ? 100 * column('friction_damping_ratio') : NaN)
side(n) = (strcol('contact') eq 'side_1' && int(column('load')) == n ? column('force_N') : NaN)

@set_terminal
set multiplot layout 1, 3
set title 'response'
set logscale y
set xrange [300:500]
set yrange [5:3000]
set xlabel 'frequency (Hz)'
set ylabel 'amplitude over the excitation (µm/N)'
set key top right Left reverse samplen 2 font ',12.5'
plot for [i=1:4] 'results/wedge_response.csv' using 'frequency_hz':(at_load(int(word(shown, i)))) with lines lw 2.4 lc rgb colours[i] \
       title sprintf('%g N', excitation[int(word(shown, i))]), \
     for [i=1:4] 'results/wedge_constant_response.csv' using 'frequency_hz':(at_load(int(word(shown, i)))) with lines lw 1.4 dt (6,4) \
       lc rgb colours[i] notitle, \
     NaN with lines lw 1.4 dt (6,4) lc rgb '#222222' title 'constant load'
set title 'damping by friction in the peak'
set logscale x
set xrange [0.007:5]
set yrange [0.03:20]
set xlabel 'excitation (N)'
set ylabel 'equivalent damping ratio (%)'
set key bottom center
plot 'results/wedge_peaks.csv' using 'excitation_factor':(100 * column('friction_damping_ratio')) with linespoints \
       lw 2.4 pt 7 ps 0.8 lc rgb '#222222' title 'element', \
     'results/wedge_constant_peaks.csv' using 'excitation_factor':(100 * column('friction_damping_ratio')) with linespoints \
       lw 1.4 dt (6,4) pt 8 lc rgb '#222222' title 'constant load', \
     'results/wedge_peaks.csv' using 'excitation_factor':(lifted(0)) with points pt 6 ps 2 lw 2 lc rgb '#D55E00' title 'lifts off'
unset logscale
set title 'side 1 in the peak'
set xrange [-2:*]
set yrange [*:*]
set xlabel 'normal force (N)'
set ylabel 'tangential force (N)'
unset key
plot for [i in '4 3 1'] 'results/wedge_loops.csv' using 'normal_force_N':(side(int(word(shown, int(i))))) with lines lw 2.4 \
       lc rgb colours[int(i)] notitle, \
     'results/wedge_constant_loops.csv' using (14.142):(side(int(word(shown, 3)))) with lines lw 1.4 dt (6,4) \
       lc rgb colours[3] notitle
unset multiplot
