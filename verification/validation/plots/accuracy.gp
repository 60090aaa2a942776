# The worst error in each region of verification/accuracy.csv over its condition number, and the errors that are promised.
wide = 1000; high = 470

@set_terminal
set multiplot layout 1,2
set datafile separator comma
table = '../accuracy.csv'
set logscale xy
set format xy '10^{%T}'
set key top left samplen 2
set xlabel 'condition number κ'
set ylabel 'error / ε'
set xrange [1e-2:1e12]
set yrange [1e-2:1e15]
error(name) = strcol(1) eq name && column(8) > 0 ? column(8) * 2.0**52 : NaN
condition = '(column(9) < 1e-2 ? 1e-2 : column(9))'
set title '(a) constant normal force'
plot 5 * (1 + x) with lines ls 1 title '5 (1 + κ)', 10 * (1 + x) with lines ls 2 title '10 (1 + κ)', \
     table using @condition:(error('displacement')) with points pt 7 ps 0.6 lc rgb '#0072B2' title 'displacement (k = 10)', \
     '' using @condition:(error('compliance')) with points pt 9 ps 0.6 lc rgb '#D55E00' title 'compliance (5)', \
     '' using @condition:(error('force')) with points pt 5 ps 0.5 lc rgb '#009E73' title 'force (8)', \
     '' using @condition:(error('stiffness')) with points pt 13 ps 0.7 lc rgb '#CC79A7' title 'stiffness (10)'
set title '(b) varying normal force'
plot 32 * (1 + x) with lines ls 1 title '32 (1 + κ)', 1024 * (1 + x) with lines ls 2 title '1024 (1 + κ)', \
     table using @condition:(error('element_normal_force')) with points pt 9 ps 0.6 lc rgb '#D55E00' title 'normal force (k = 12)', \
     '' using @condition:(error('element_force')) with points pt 7 ps 0.6 lc rgb '#0072B2' title 'force (32)', \
     '' using @condition:(error('element_stiffness')) with points pt 13 ps 0.7 lc rgb '#CC79A7' title 'stiffness (1024)'
unset multiplot
