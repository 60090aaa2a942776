# Energy of a cycle under a swinging normal force over that under the constant one: cylinder, and a flat for comparison.
wide = 1000; high = 460
set xlabel 'phase φ of the normal force  [°]'
set xrange [0:180]
set xtics 45
set key top right samplen 3.5

@set_terminal
set multiplot layout 1, 2
do for [panel in 'a c'] {
  other = panel eq 'a' ? 'b' : 'd'
  if (panel eq 'a') { set title '(a) microslip:  T = 0.4 μN_0 sin ωt'; set ylabel 'energy / energy at N = N_0'; set yrange [0:6.5] } \
  else { set title '(b) gross slip:  δ = 2 δ_s sin ωt'; unset ylabel; set yrange [0.3:1.2]; set key bottom left }
  plot for [i = 2:5] file(name.'_'.other) using 1:i with lines ls 11 title (i == 2 ? 'a/b = 0.9' : ''), \
       for [i = 2:5] file(name.'_'.panel) using 1:i with lines ls (panel eq 'c' && i > 3 ? i : i-1) title columnheader(i)
}
unset multiplot
