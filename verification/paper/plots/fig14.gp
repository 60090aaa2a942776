# Fig. 14: complex stiffness for several L/b.
last = 5; label = 'a/b = 0.1'
load 'plots/complex_stiffness.gp'
