# Fig. 14: complex stiffness for several L/b.
load 'plots/style.gp'
name = 'fig14'; last = 5; label = 'a/b = 0.1'
load 'plots/complex_stiffness.gp'
