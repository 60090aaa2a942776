# Why: the damper of `microslip example` and spring-sliders. Loop and loss factor, and the response of two blades at a damper load of 800 N.
wide = 1200; high = 420
load '../../target/figures/why.gp' # slip_force, slip_displacement, initial_stiffness, and tuned_... at gross slip
set samples 600

# Complex stiffness of a spring k in series with a slider s at an amplitude x: loss factor K''/K'.
part(k, s, x) = s / (k*x)
loss(k, s, x) = k*x <= s ? 1e-9 : \
  4*part(k, s, x)*(1 - part(k, s, x)) / (acos(1 - 2*part(k, s, x)) - 2*(1 - 2*part(k, s, x))*sqrt(part(k, s, x)*(1 - part(k, s, x))))

@set_terminal
set multiplot layout 1, 3
set title 'loop at 0.8 of gross slip'
set xlabel 'displacement [µm]'
set ylabel 'force [N]'
set key top left samplen 2.5
plot file('why_loop') using (1e6*$2):3 with lines ls 1 title 'microslip', \
     file('why_loop') every ::::100 using (1e6*$2):(initial_stiffness*$2) with lines ls 2 title 'spring-slider' # one way: dashes
set title 'loss factor'
set logscale xy
set xlabel 'amplitude / amplitude at gross slip'
set ylabel "K'' / K'"
set xrange [0.05:5]
set yrange [0.001:100]
set key top left
plot file('why_stiffness') using ($1/slip_displacement):($3/$2) with lines ls 1 title 'microslip', \
     loss(initial_stiffness, slip_force, x*slip_displacement) with lines ls 2 title 'spring-slider', \
     loss(tuned_stiffness, tuned_force, x*slip_displacement) with lines ls 3 title 'tuned at gross slip'
unset logscale
set title 'two blades with this damper'
set xlabel 'frequency [Hz]'
set ylabel 'tip amplitude [µm]'
set xrange [464:474]
set yrange [0:300]
set key top left
response(law) = sprintf('../../fortran_examples/results/%s_response.csv', law)
at_load(dummy) = int(column('load')) == 11 ? 1e6*column('peak_m') : NaN
plot response('cylinder') using 'frequency_hz':(at_load(0)) with lines ls 1 title 'microslip', \
     response('spring_slider') using 'frequency_hz':(at_load(0)) with lines ls 2 title 'spring-slider'
