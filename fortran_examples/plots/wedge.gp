# The wedge damper. Left: response per unit of excitation, element against the law of constant normal force. Middle: damping ratio
# of friction at the peak. Right: tangential over normal force at one side in the peak.
load 'plots/style.gp'
name = 'wedge'
wide = 1240
high = 470

array colours[4] = ['#440154', '#31688e', '#35b779', '#c9b400']
# Numbers of the excitations: for the left panel and for the right one.
shown = '2 5 8 10'
loops = '2 9 11'
stats 'results/wedge_peaks.csv' using (column('load')) nooutput
array excitation[STATS_records]
stats 'results/wedge_peaks.csv' using (excitation[int(column('load'))] = column('excitation_factor')) nooutput

at_load(n) = (int(column('load')) == n ? micro(column('peak_m')) / column('excitation_factor') : NaN)
lifted(dummy) = (column('side_1_open_fraction') > 0 ? 100 * column('friction_damping_ratio') : NaN)
side(n) = (strcol('contact') eq 'side_1' && int(column('load')) == n ? column('force_N') : NaN)

do for [extension in 'svg png'] {
  @set_terminal
  set multiplot layout 1, 3 margins 0.06, 0.985, 0.135, 0.9 spacing 0.065, 0
  set title 'response'
  set logscale y
  set xrange [300:500]
  set yrange [5:3000]
  set xlabel 'frequency (Hz)'
  set ylabel 'amplitude of the tip over the excitation (µm/N)' offset 1, 0
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
  plot 'results/wedge_peaks.csv' using 'excitation_factor':(100 * column('friction_damping_ratio')) with linespoints ls 1 title 'element', \
       'results/wedge_constant_peaks.csv' using 'excitation_factor':(100 * column('friction_damping_ratio')) with linespoints ls 3 \
         title 'constant load', \
       'results/wedge_peaks.csv' using 'excitation_factor':(lifted(0)) with points pt 6 ps 2 lw 2 lc rgb '#D55E00' title 'lifts off'
  unset logscale
  set title 'side 1 in the peak'
  set xrange [-2:*]
  set yrange [*:*]
  set xlabel 'normal force (N)'
  set ylabel 'tangential force (N)' offset 1, 0
  set key bottom left
  plot for [i=1:3] 'results/wedge_loops.csv' using 'normal_force_N':(side(int(word(loops, i)))) with lines lw 2.2 lc rgb colours[i] \
         title sprintf('%g N', excitation[int(word(loops, i))]), \
       'results/wedge_constant_loops.csv' using (14.142):(side(9)) with lines ls 3 lw 2.2 title 'constant load'
  unset multiplot
  unset output
}
