# Shrouds that slide in both directions of their faces. Above: responses with friction in both directions, and in one. Below: orbits
# of the contact at a resonance, by harmonic balance and by time integration.
load 'plots/style.gp'
name = 'interlock'
wide = 1120
high = 960

array colours[5] = ['#440154', '#3b528b', '#21918c', '#5ec962', '#c9b400']
stats 'results/interlock_peaks.csv' using (column('load')) nooutput
loads = STATS_records
array excitation[loads]
stats 'results/interlock_peaks.csv' using (excitation[int(column('load'))] = column('excitation_factor')) nooutput

amplitude(n) = (int(column('load')) == n ? micro(column('peak_m')) / column('excitation_factor') : NaN)
# The first group &time_integration: its most harmonics, and time integration.
stats 'results/interlock_waveforms.csv' using (column('harmonics')) nooutput
most = STATS_max
stats 'results/interlock_waveforms.csv' using (column('frequency_hz')) every ::0::0 nooutput
resonance = STATS_min
shown(harmonics, value) = (column('harmonics') == harmonics && abs(column('frequency_hz') - resonance) < 0.01 ? value : NaN)

do for [extension in 'svg png'] {
  @set_terminal
  set multiplot
  set lmargin at screen 0.075; set rmargin at screen 0.475
  set tmargin at screen 0.96; set bmargin at screen 0.56
  set logscale y
  set xrange [180:620]
  set yrange [0.8:2000]
  set xlabel 'frequency (Hz)'
  set ylabel 'amplitude of the blade over the excitation (µm/N)'
  set title 'friction in both directions'
  set key top right Left reverse samplen 2 title 'excitation' font ',12.5'
  plot for [i=1:loads] 'results/interlock_response.csv' using 'frequency_hz':(amplitude(i)) with lines lw 2 lc rgb colours[i] \
    title sprintf('%g N', excitation[i])
  set lmargin at screen 0.515; set rmargin at screen 0.915
  set title 'friction in one; radially stuck, or dashed: free'
  unset ylabel
  set format y ''
  unset key
  plot for [i=1:loads] 'results/interlock_spring_response.csv' using 'frequency_hz':(amplitude(i)) with lines lw 2 lc rgb colours[i], \
       for [i=1:loads] 'results/interlock_free_response.csv' using 'frequency_hz':(amplitude(i)) with lines lw 1.4 dt (6,4) \
         lc rgb colours[i]
  unset logscale
  set format y '%g'
  set tmargin at screen 0.46; set bmargin at screen 0.07
  set size ratio -1
  set autoscale
  set lmargin at screen 0.075; set rmargin at screen 0.475
  set title sprintf('orbit of the contact, %g Hz, 1 N', resonance)
  set xlabel 'displacement along the face (µm)'
  set ylabel 'radial displacement (µm)'
  set key bottom right Left reverse samplen 2
  plot 'results/interlock_waveforms.csv' \
         using (shown(0, micro(column('contact_displacement_m')))):(micro(column('contact_displacement_y_m'))) \
         with lines lw 6 lc rgb '#b0b0b0' title 'time integration', \
       '' using (shown(most, micro(column('contact_displacement_m')))):(micro(column('contact_displacement_y_m'))) \
         with lines ls 1 title sprintf('%g harmonics', most)
  set lmargin at screen 0.565; set rmargin at screen 0.965
  set title 'its force'
  set xlabel 'force along the face (N)'
  set ylabel 'radial force (N)'
  unset key
  plot 'results/interlock_waveforms.csv' using (shown(0, column('contact_force_N'))):(column('contact_force_y_N')) \
         with lines lw 6 lc rgb '#b0b0b0', \
       '' using (shown(most, column('contact_force_N'))):(column('contact_force_y_N')) with lines ls 1
  unset multiplot
  set size noratio
  unset output
}
