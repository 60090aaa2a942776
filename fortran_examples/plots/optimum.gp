# Resonance peak against the normal force of the damper, the ratio of the laws, and some of the responses.
load 'plots/style.gp'
name = 'optimum'
wide = 1240
high = 430

peaks(law) = sprintf('results/%s_peaks.csv', law)
# Peaks of the spring-slider by the number of the load; before any range is set.
stats peaks('spring_slider') using (column('load')) nooutput
array slider_peak[STATS_records]
stats peaks('spring_slider') using (slider_peak[int(column('load'))] = column('peak_m')) nooutput
relative(dummy) = column('peak_m') / slider_peak[int(column('load'))]
force = 'load_factor'
at_load(n) = (int(column('load')) == n ? micro(column('peak_m')) : NaN)

@set_terminal
set multiplot layout 1, 3
set logscale y
set format '%g'
set xlabel 'frequency (Hz)'
set xrange [310:500]
set xtics 340, 40
set yrange [0.2:1000]
set ylabel 'amplitude of the blade tip (µm)'
set title '0.3, 1.6, 4, 15, 150, 800, 3000 N; dashed: spring-slider'
unset key
plot for [i=1:13:2] 'results/cylinder_response.csv' using 'frequency_hz':(at_load(i)) with lines ls 1, \
     for [i=1:13:2] 'results/spring_slider_response.csv' using 'frequency_hz':(at_load(i)) with lines ls 3
set title 'resonance peak; triangles: spring-slider'
set xtics auto
set logscale x
set xlabel 'normal force of the damper (N)'
set xrange [0.2:5000]
plot for [i=1:2] peaks(word('cylinder spring_slider', i)) using force:(micro(column('peak_m'))) with linespoints ls 2*i - 1
unset logscale y
set title 'microslip over spring-slider'
set ylabel 'ratio of the peaks'
set yrange [0.5:1.1]
plot peaks('cylinder') using force:(relative(0)) with linespoints ls 1
unset multiplot
