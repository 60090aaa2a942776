# Response around the resonance for some normal forces of the damper, one panel for each law.
load 'plots/style.gp'
name = 'response'
wide = 1180
high = 520

# Dark to light, also in grey; every second load of the cases.
array colours[7] = ['#440154', '#443983', '#31688e', '#21918c', '#35b779', '#7fbf3f', '#c9b400']
set style line 11 lc rgb colours[1] dt 1 lw 2.6
set style line 12 lc rgb colours[2] dt (8,3) lw 1.8
set style line 13 lc rgb colours[3] dt (2,2) lw 2.2
set style line 14 lc rgb colours[4] dt 1 lw 1.6
set style line 15 lc rgb colours[5] dt (8,3,2,3) lw 1.8
set style line 16 lc rgb colours[6] dt (4,2) lw 1.8
set style line 17 lc rgb colours[7] dt 1 lw 2.2

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
do for [extension in 'svg png'] {
  @set_terminal
  set multiplot layout 1, 3 margins 0.075, 0.865, 0.13, 0.90 spacing 0.012, 0
  set ylabel 'amplitude of the blade tip (µm)'
  unset key
  do for [p=1:3] {
    law = word('cylinder flat spring_slider', p)
    array titles[3] = ['microslip, cylinder', 'microslip, flat with rounded edges', 'spring-slider']
    set title titles[p] font ',15'
    if (p > 1) { unset ylabel; set format y '' } else { set format y '%g' }
    if (p == 3) {
      set key at graph 1.04, 0.97 left top Left reverse samplen 2.2 spacing 1.3
      set key title "normal force of\nthe damper (N)" left font ',13'
    }
    plot for [i=1:7] responses(law) using 'frequency_hz':(at_load(2*i - 1)) with lines ls 10+i \
      title sprintf('%g', normal_force[2*i - 1])
  }
  unset multiplot
  unset output
}
