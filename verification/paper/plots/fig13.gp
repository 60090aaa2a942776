# Fig. 13: complex stiffness for several a/b.
last = 6; label = 'L/b = 10'
load 'plots/complex_stiffness.gp'
