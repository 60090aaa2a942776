# Harmonic force with its Jacobian: motions of one, five and nine harmonics up to 0.95 of gross slip, a/b = 0.9; the error
# against infinitely many samples. Lines go from 16 to 1024 samples, sliders have 128.
load 'plots/style.gp'
name = 'harmonic'
wide = 1280
high = 560
shape = 0.9
amplitude = 0.95

set xlabel 'error of the first harmonic, relative'
set xrange [1e-17:1]
set xtics 1e-16, 1e4, 1
set yrange [30:1e8]

of(method) = rows('harmonic', shape, amplitude, harmonics, 1, method)

do for [extension in 'svg png'] {
  @set_terminal
  set multiplot layout 1, 3 margins 0.07, 0.985, 0.26, 0.925 spacing 0.05, 0
  do for [panel = 1:3] {
    harmonics = 4*panel - 3
    set title sprintf('%d harmonic%s', harmonics, harmonics == 1 ? '' : 's')
    if (panel == 1) { set ylabel 'time of force and Jacobian (ns)' } else { unset ylabel }
    if (panel == 1) { set key at screen 0.53, screen 0.13 center top maxrows 2 Left reverse samplen 2 font ',12.5' } \
    else { unset key }
    plot of('microslip') using 1:2 with linespoints ls 1 title 'microslip', \
         of('microslip event-driven') using 1:2 with linespoints ls 2 title 'microslip, event-driven', \
         of('sliders') using 1:2 with linespoints ls 6 title 'sliders, 4 to 4096', \
         of('sliders by reversals') using 1:2 with linespoints ls 7 title 'sliders by reversals', \
         of('Jenkins') using 1:2 with linespoints ls 8 title 'spring-slider', \
         of('Jenkins by reversals') using 1:2 with linespoints ls 9 title 'spring-slider by reversals'
  }
  unset multiplot
  unset output
}
