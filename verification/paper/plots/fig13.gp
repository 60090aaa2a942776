# Fig. 13: complex stiffness for several a/b.
load 'plots/style.gp'
name = 'fig13'; last = 6; label = 'L/b = 10'
load 'plots/complex_stiffness.gp'
