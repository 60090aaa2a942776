# Oblique impacts; without partial slip is Hertz' and Mindlin's tangent: measured tangential restitution of a sphere, and finite elements of the surface velocity, against three laws.
wide = 920; high = 440

@set_terminal
set multiplot layout 1, 2
set title 'measured: alumina on glass'
set xlabel 'angle of impact from the normal [°]'
set ylabel 'tangential velocity after / before'
set xrange [0:45]
set yrange [0.3:1]
set key bottom right samplen 2 font ',12'
plot file('rebound') using 1:2 with lines ls 1 title 'law', '' using 1:3 with lines ls 2 title 'without partial slip', \
     '' using 1:4 with lines ls 3 title 'spring-slider', \
     file('rebound_mfix') with points pt 7 ps 0.9 lc rgb '#009E73' title 'measured, 3 digitisations', \
     file('rebound_lethe') with points pt 5 ps 0.8 lc rgb '#009E73' notitle, \
     file('rebound_kratos') with points pt 9 ps 1.0 lc rgb '#009E73' notitle
set title 'finite elements: steel on a rigid plane'
set xlabel 'surface velocity before / μv_n'
set ylabel 'surface velocity after / μv_n'
set xrange [0:10]
set yrange [-2:6]
set key top left font ',12'
name = 'rebound_finite_elements'
plot file(name) using 1:3 with lines ls 1 title 'law', '' using 1:4 with lines ls 2 title 'without partial slip', \
     '' using 1:5 with lines ls 3 title 'spring-slider', '' using 1:2 with points pt 7 ps 0.9 lc rgb '#009E73' title 'finite elements'
