# Hysteresis loops over one period of the resonance peak. Below, minus the displacement of a contact that sticks everywhere,
# force / initial stiffness: the slip part, which is zero for a spring-slider before gross slip.
load 'plots/style.gp'

# From wide to narrow: loops that coincide remain visible.
set style line 11 lc rgb '#0072B2' lw 5.0 dt 1
set style line 12 lc rgb '#D55E00' lw 2.0 dt 1
set style line 13 lc rgb '#222222' lw 1.4 dt (4,3)
name = 'loops'
wide = 1060
high = 820

# Panels: contact, number of the load.
contacts = 'damper damper damper root_1'
numbers  = '7 10 10 1'

stats 'results/cylinder_peaks.csv' using (column('load')) nooutput
array normal_force[STATS_records]
stats 'results/cylinder_peaks.csv' using (normal_force[int(column('load'))] = column('damper_normal_force_N')) nooutput
loops(law) = sprintf('results/%s_loops.csv', law)
in_panel(value) = (strcol('contact') eq contact && int(column('load')) == number ? value : NaN)
across(dummy) = in_panel(panel < 3 ? 1e6 * column('displacement_m') : 1e9 * column('slip_part_m'))

set ylabel 'tangential force (N)'
set offsets graph 0.06, graph 0.06, graph 0.08, graph 0.08

do for [extension in 'svg png'] {
  @set_terminal
  set multiplot layout 2, 2
  do for [panel=1:4] {
    contact = word(contacts, panel)
    number = int(word(numbers, panel))
    set title sprintf('%sdamper at %g N', contact eq 'damper' ? '' : 'flank of the root, ', normal_force[number])
    if (panel < 3) { set xlabel 'relative displacement (µm)' } \
    else { set xlabel 'slip part of the displacement (nm)' }
    if (panel == 2) { set key top left Left reverse samplen 3 spacing 1.15 } else { unset key }
    plot loops('cylinder') using (across(0)):'force_N' with lines ls 11 title 'microslip, cylinder', \
         loops('flat') using (across(0)):'force_N' with lines ls 12 title 'microslip, flat', \
         loops('spring_slider') using (across(0)):'force_N' with lines ls 13 title 'spring-slider'
  }
  unset multiplot
  unset output
}
