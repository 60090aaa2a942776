# Tractions under an oscillating force: at a reversal and after it, up to the opposite force.
wide = 860; high = 520
set xlabel place
set ylabel 'shear traction  b q / μP'
set xrange [-1.05:1.05]
set yrange [-0.9:0.9]
set key outside right center width -2
set label 1 'a/b = 0.5' at graph 0.06, 0.95

@set_terminal
plot file(name) using 1:2 with lines ls 11 title '±μp', '' using 1:(-$2) with lines ls 11 notitle, \
     for [i = 3:7] '' using 1:i with lines ls i-2 title columnheader(i)
