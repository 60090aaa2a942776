# The example contact with layers of 0, 0.3, 1 and 3 times its compliance, constant (solid) or rough with N_c = N/20 (broken).
wide = 1100; high = 400
shares = '0 0.3 1 3'
data(name, i, load) = file(sprintf('%s_%s_%s', name, word(shares, i), load))

@set_terminal
set multiplot layout 1, 3
set key left top samplen 1.5
set xlabel 'displacement [µm]'
set ylabel 'force [N]'
plot for [i = 1:4] data('loop', i, '0') using (1e6*$2):3 with lines ls i dt 1 lw 0.5 + 0.25*i*i title word('none 0.3 1 3', i), \
     for [i = 2:4] data('loop', i, '0.05') using (1e6*$2):3 with lines ls i lw 0.5 + 0.25*i*i dt (4,4) notitle
set logscale x
set xlabel 'amplitude [µm]'
set ylabel "K' [N/µm]"
plot for [i = 1:4] data('stiffness', i, '0') using (1e6*$1):(1e-6*$2) with lines ls i dt 1 lw 0.5 + 0.25*i*i notitle, \
     for [i = 2:4] data('stiffness', i, '0.05') using (1e6*$1):(1e-6*$2) with lines ls i lw 0.5 + 0.25*i*i dt (4,4) notitle
set logscale y
set yrange [0.01:]
set ylabel 'energy per cycle [µJ]'
plot for [i = 1:4] data('stiffness', i, '0') using (1e6*$1):(1e6*$6) with lines ls i dt 1 lw 0.5 + 0.25*i*i notitle, \
     for [i = 2:4] data('stiffness', i, '0.05') using (1e6*$1):(1e6*$6) with lines ls i lw 0.5 + 0.25*i*i dt (4,4) notitle
