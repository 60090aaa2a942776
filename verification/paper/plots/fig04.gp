# Fig. 4: shear traction for several forces.
wide = 720; high = 480
set xlabel place
set ylabel 'shear traction  b q / μP'
set xrange [-1.05:1.05]
set yrange [0:1.05]
set key top center maxrows 3
set label 1 'a/b = 0.5' at 0, 0.72 center

@set_terminal
plot for [i = 2:5] file(name) using 1:i with lines ls 7-i title columnheader(i), \
     '' using 1:6 with lines ls 1 title 'Q/μP = 1: q = μp'
