# Fig. 7: loops of growing amplitude, (a) up to incipient gross slip and (b) beyond.
wide = 1000; high = 520
set xlabel displacement
set yrange [-1.15:1.15]
set key bmargin center maxrows 2

@set_terminal
set multiplot layout 1, 2
do for [panel in 'a b'] {
  set title sprintf('(%s)  a/b = 0.1, L/b = 10', panel)
  if (panel eq 'a') { set ylabel force; set xrange [-5:5] } else { unset ylabel; set xrange [-9:9] }
  plot for [i = 3:1:-1] file(name.panel) using 2*i+1:2*i+2 with lines ls (panel eq 'a' ? i : i+2) lw 1.8 \
         title sprintf('δ_0 = %s δ_s', word(panel eq 'a' ? '0.4 0.7 1' : '1 1.5 2', i)), \
       '' using 1:2 with lines ls 12 title 'initial loading'
}
unset multiplot
