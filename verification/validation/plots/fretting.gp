# Energy per cycle of a sliding cylinder against the smallest load over the largest: bands of the friction coefficient and measurements.
load 'plots/style.gp'
wide = 720; high = 470

@set_terminal
set xlabel 'smallest over largest normal force'
set ylabel 'energy per cycle / J'
set key top left samplen 3
set xrange [0:1.05]
set yrange [0:2]
plot file('fretting') using 1:6:7 with filledcurves fc rgb '#dddddd' title 'rigid, 4 μNδ', \
     '' using 1:2:3 with filledcurves fc rgb '#56B4E9' fs transparent solid 0.55 title 'law in series with the rig, μ from 0.60 to 0.65', \
     '' using 1:4 with lines ls 12 title 'law alone, μ = 0.60 and 0.65', '' using 1:5 with lines ls 12 notitle, \
     file('fretting_measured') using 1:2 with points pt 7 ps 0.9 lc rgb '#D55E00' title 'measured, 3 Hz', \
     '' using 1:3 with points pt 9 ps 1.0 lc rgb '#000000' title '1 Hz', \
     '' using 1:4 with points pt 5 ps 0.8 lc rgb '#009E73' title '0.11 Hz'
