# Resonance peak against the normal force of the damper, and the ratio of the laws.
load 'plots/style.gp'
name = 'optimum'
wide = 1120
high = 480

set logscale x
set format '%g'
set xlabel 'normal force of the damper (N)'
set xrange [0.2:5000]
peaks(law) = sprintf('results/%s_peaks.csv', law)

# Peaks of the spring-slider by the number of the load, for the right panel; before any range is set.
stats peaks('spring_slider') using (column('load')) nooutput
array slider_peak[STATS_records]
stats peaks('spring_slider') using (slider_peak[int(column('load'))] = column('peak_m')) nooutput
relative(dummy) = column('peak_m') / slider_peak[int(column('load'))]

@set_terminal
set multiplot layout 1, 2
set logscale y
set yrange [1:2000]
set ylabel 'resonance peak at the blade tip (µm)'
unset key
plot peaks('cylinder') using 'damper_normal_force_N':(micro(column('peak_m'))) with linespoints ls 1, \
     peaks('flat') using 'damper_normal_force_N':(micro(column('peak_m'))) with linespoints ls 2, \
     peaks('spring_slider') using 'damper_normal_force_N':(micro(column('peak_m'))) with linespoints ls 3
unset logscale y
set yrange [0.5:1.1]
set ylabel 'peak relative to that of the spring-slider'
set key bottom left Left reverse spacing 1.2 samplen 2.5 font ',12.5'
plot peaks('cylinder') using 'damper_normal_force_N':(relative(0)) with linespoints ls 1 \
       title 'microslip, cylinder', \
     peaks('flat') using 'damper_normal_force_N':(relative(0)) with linespoints ls 2 \
       title 'microslip, flat with rounded edges', \
     peaks('spring_slider') using 'damper_normal_force_N':(relative(0)) with linespoints ls 3 \
       title 'spring-slider, initial stiffness of the cylinder'
unset multiplot
