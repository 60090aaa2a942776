# How many harmonics: one period at the damper, differences from Newmark's method, and the harmonics of the friction force beside
# the modes of the blades with sticking contacts (vertical lines). Cases of &time_integration in cylinder.nml.
load 'plots/style.gp'
name = 'newmark'
wide = 1240
high = 430

same(a, b) = abs(a - b) < 1e-6 * abs(b)
best(value) = (same(column('load_factor'), 7) ? value : NaN)
wave(harmonics) = (column('harmonics') == harmonics ? best(micro(column('displacement_m'))) : NaN)
difference(force) = (same(column('load_factor'), force) ? column('response_difference') : NaN)
# A mode in which the damper moves.
mode(dummy) = (column('participation') > 0.12 && column('order') < 37 ? best(column('order')) : NaN)

@set_terminal
set multiplot layout 1, 3
set title 'damper at 7 N, 420 Hz'
set xlabel 'phase of the excitation (degrees)'
set ylabel 'displacement at the damper (µm)'
set xrange [0:360]
set xtics 90
set offsets 0, 0, graph 0.35, graph 0.05
set key top left Left reverse samplen 2 maxrows 2
plot 'results/cylinder_waveforms.csv' using (57.29578*column('phase_rad')):(wave(0)) \
       with lines lw 6 lc rgb '#b0b0b0' title 'Newmark', \
     '' using (57.29578*column('phase_rad')):(wave(5)) with lines lw 1.8 lc rgb '#0072B2' title '5 harmonics', \
     '' using (57.29578*column('phase_rad')):(wave(15)) with lines lw 1.8 dt (8,4) lc rgb '#D55E00' title '15', \
     '' using (57.29578*column('phase_rad')):(wave(35)) with lines lw 1.6 dt (2,3) lc rgb '#222222' title '35'
set offsets 0, 0, 0, 0
set logscale y
set format y '10^{%T}'
set xrange [0:37]
set xtics 5
set xlabel 'harmonics H of the balance'
set ylabel 'largest difference of the tip, relative'
set title 'balance against time integration'
set yrange [1e-5:1]
set key bottom left maxrows 3
plot 'results/cylinder_modes.csv' using (mode(0)):(1) with impulses lw 5 lc rgb '#e0e0e0' notitle, \
     'results/cylinder_comparison.csv' using 'harmonics':(difference(7)) with linespoints ls 1 title '7 N, 420 Hz', \
     '' using 'harmonics':(difference(250)) with linespoints ls 3 title '250 N, 464.6 Hz'
set title 'friction force, 7 N, 420 Hz'
set xlabel 'harmonic, or natural frequency / 420 Hz'
set ylabel 'amplitude over that of harmonic 1'
unset key
odd(dummy) = (int(column('harmonic')) % 2 == 1 ? best(column('contact_force')) : NaN)
plot 'results/cylinder_modes.csv' using (mode(0)):(1) with impulses lw 5 lc rgb '#e0e0e0', \
     'results/cylinder_spectrum.csv' using 'harmonic':(odd(0)) with linespoints ls 1
unset multiplot
