# Complex stiffness: two contacts, up to 0.95 of the displacement of gross slip.
load 'plots/style.gp'
name = 'stiffness'
wide = 1120
high = 540
amplitude = 0.95

set xlabel 'largest error of stiffness and derivatives, relative'
set yrange [1:1e9]

case(shape) = sprintf('a/b = %g%s', shape, shape == 0 ? ' (cylinder)' : '')
of(method) = rows('stiffness', shape, amplitude, 0, 0, method)

do for [extension in 'svg png'] {
  @set_terminal
  set multiplot layout 1, 2 margins 0.075, 0.985, 0.26, 0.925 spacing 0.075, 0
  do for [panel = 1:2] {
    shape = panel == 1 ? 0 : 0.9
    set title case(shape)
    if (panel == 1) { set ylabel 'time of one amplitude (ns)' } else { unset ylabel }
    if (panel == 1) { set key at screen 0.53, screen 0.13 center top maxrows 2 Left reverse samplen 2 font ',12.5' } \
    else { unset key }
    plot of('microslip') using 1:2:3:4 with yerrorbars ls 1 title 'microslip', \
         of('closed form by Gauss-Legendre') using 1:2 with linespoints ls 3 title 'closed form, plain C', \
         of('Eq. 10 by Gauss-Legendre') using 1:2 with linespoints ls 4 title 'Eq. 10 by Gauss-Legendre', \
         of('Eq. 10 by adaptive Gauss-Kronrod') using 1:2 with linespoints ls 5 title 'Eq. 10 by adaptive Gauss-Kronrod', \
         of('sliders') using 1:2 with linespoints ls 6 title 'parallel sliders, 4 to 4096', \
         of('Jenkins') using 1:2:3:4 with yerrorbars ls 8 title 'one spring-slider'
  }
  unset multiplot
  unset output
}
