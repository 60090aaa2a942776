# Equations as printed, and corrected.
load 'plots/style.gp'
name = 'printed'; wide = 1000; high = 800

@set_terminal
set multiplot layout 2, 2
set title 'Eq. 1, 19, 24: load of a contact'
set xlabel 'a / b'
set ylabel '4 P R / (b^2 E^*)'
set xrange [0:1]; set yrange [0:3.5]
set key top right
set label 1 'π: Hertz' at 0.06, 3.2
set object 1 circle at 0, pi size 0.015 fs empty border lc rgb 'black' lw 1.6
plot file('printed_load') using 1:'corrected' with lines ls 1 title 'corrected', \
     '' using 1:'as printed' with lines ls 2 title 'as printed'
unset label
unset object
set title 'Eq. 17: pressure, a/b = 0.5'
set xlabel place
set ylabel 'b p / P'
set xrange [-1.05:1.05]; set yrange [0:1.1]
set key top center
plot file('printed_tractions') using 1:'Eq. 17 corrected' with lines ls 1 title 'corrected', \
     '' using 1:'Eq. 17 as printed' with lines ls 2 title 'as printed'
set title 'Eq. 22: relieved traction, a/c = 0.5'
set xlabel 'x / c'
set ylabel 'c q^* / (μP - Q)'
set yrange [-4:2]
set key bottom left
plot file('printed_tractions') using 1:'Eq. 22 corrected' with lines ls 1 title 'corrected', \
     '' using 1:'Eq. 22 as printed' with lines ls 2 title 'as printed'
set title 'Eq. 15: slip, a/b = 0.5, Q/μP = 0.8'
set xlabel place
set ylabel 'slip  s π E^* / (2 μP)'
set xrange [0:1]; set yrange [*:*]
set key top left
plot file('printed_slip') using 1:'upper limit b' with lines ls 1 title 'upper limit b', \
     '' using 1:'upper limit a' with lines ls 2 title 'upper limit a, as printed'
unset multiplot
