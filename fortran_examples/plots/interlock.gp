# Shrouds that slide in both directions of their faces. Above: responses with friction in both directions, and in one. Below: orbits
# of the contact, by harmonic balance and by time integration.
load 'plots/style.gp'
name = 'interlock'
wide = 1120
high = 900

array colours[4] = ['#440154', '#31688e', '#35b779', '#c9b400']
stats 'results/interlock_peaks.csv' using (column('load')) nooutput
loads = STATS_records
array excitation[loads]
stats 'results/interlock_peaks.csv' using (excitation[int(column('load'))] = column('excitation_factor')) nooutput
amplitude(n) = (int(column('load')) == n ? micro(column('peak_m')) / column('excitation_factor') : NaN)

stats 'results/interlock_waveforms.csv' using (column('harmonics')) nooutput
most = STATS_max
stats 'results/interlock_waveforms.csv' using (column('frequency_hz')) nooutput
frequency = STATS_max
stats 'results/interlock_waveforms.csv' using (column('excitation_factor')) nooutput
force = STATS_max
# Without the mean of time integration.
shown(harmonics, value) = (column('harmonics') == harmonics ? value : NaN)
stats 'results/interlock_waveforms.csv' using (shown(0, micro(column('contact_displacement_m')))) nooutput
mean_x = STATS_mean
stats 'results/interlock_waveforms.csv' using (shown(0, micro(column('contact_displacement_y_m')))) nooutput
mean_y = STATS_mean
x(dummy) = micro(column('contact_displacement_m')) - mean_x
y(dummy) = micro(column('contact_displacement_y_m')) - mean_y

@set_terminal
set multiplot layout 2, 2
set size noratio
set logscale y
set xrange [200:480]
set yrange [0.5:1000]
set xtics 50
set ytics auto
set xlabel 'frequency (Hz)'
set ylabel 'amplitude over the excitation (µm/N)'
set title 'friction in both directions'
set key top right Left reverse samplen 2 title 'excitation' font ',12.5'
plot for [i=1:loads] 'results/interlock_response.csv' using 'frequency_hz':(amplitude(i)) with lines lw 2 lc rgb colours[i] \
  title sprintf('%g N', excitation[i])
set title 'friction in one direction'
unset ylabel
set key top right notitle
plot for [i=1:loads] 'results/interlock_spring_response.csv' using 'frequency_hz':(amplitude(i)) with lines lw 2 \
       lc rgb colours[i] notitle, \
     for [i=1:loads] 'results/interlock_free_response.csv' using 'frequency_hz':(amplitude(i)) with lines lw 1.4 dt (6,4) \
       lc rgb colours[i] notitle, \
     NaN with lines lw 2 lc rgb '#222222' title 'radially stuck', \
     NaN with lines lw 1.4 dt (6,4) lc rgb '#222222' title 'radially free'
unset logscale
set autoscale
set xtics auto
set size ratio -1
set title sprintf('displacement of the contact, %g Hz, %g N', frequency, force)
set xlabel 'along the face (µm)'
set ylabel 'radial (µm)'
set xrange [-9:9]
set yrange [-9:9]
set key top left Left reverse samplen 2
plot 'results/interlock_waveforms.csv' \
       using (shown(0, x(0))):(y(0)) \
       with lines lw 6 lc rgb '#b0b0b0' title 'time integration', \
     '' using (shown(most, x(0))):(y(0)) \
       with lines lw 1.6 lc rgb '#222222' title sprintf('%g harmonics', most)
set title 'force'
set xlabel 'along the face (N)'
set ylabel 'radial (N)'
set xrange [-7:7]
set yrange [-7:7]
unset key
plot 'results/interlock_waveforms.csv' using (shown(0, column('contact_force_N'))):(column('contact_force_y_N')) \
       with lines lw 6 lc rgb '#b0b0b0', \
     '' using (shown(most, column('contact_force_N'))):(column('contact_force_y_N')) with lines lw 1.6 lc rgb '#222222'
unset multiplot
