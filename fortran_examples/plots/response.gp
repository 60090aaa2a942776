# Response around the resonance for some normal forces of the damper, one panel for each law.
load 'plots/style.gp'
name = 'response'
wide = 1180
high = 520

# Dark to light, also in grey; every second load of the cases. From wide to narrow: curves that coincide remain visible.
array colours[7] = ['#440154', '#443983', '#31688e', '#21918c', '#35b779', '#7fbf3f', '#c9b400']
width(i) = 5.2 - 0.6*i

# The normal forces, for the key; before any range is set, which would exclude some.
stats 'results/cylinder_peaks.csv' using 'damper_normal_force_N' nooutput
loads = STATS_records
array normal_force[loads]
stats 'results/cylinder_peaks.csv' using (normal_force[int(column('load'))] = column('damper_normal_force_N')) nooutput

set logscale y
set format y '%g'
set xrange [310:500]
set yrange [0.2:1000]
set xtics 320, 40
set xlabel 'frequency (Hz)'
responses(law) = sprintf('results/%s_response.csv', law)

at_load(n) = (int(column('load')) == n ? micro(column('peak_m')) : NaN)
@set_terminal
set multiplot layout 1, 3
set ylabel 'amplitude of the blade tip (µm)'
set key top center Left reverse samplen 2 title 'normal force (N)' font ',13'
do for [p=1:3] {
  law = word('cylinder flat spring_slider', p)
  array titles[3] = ['microslip, cylinder', 'microslip, flat with rounded edges', 'spring-slider']
  set title titles[p] font ',15'
  if (p > 1) { unset ylabel; unset key }
  plot for [i=1:7] responses(law) using 'frequency_hz':(at_load(2*i - 1)) with lines lw width(i) lc rgb colours[i] \
    title sprintf('%g', normal_force[2*i - 1])
}
unset multiplot
