"""Two masses, one contact to the ground: fortran_examples/cases/two_dof.nml."""

import numpy as np

CONTACT = {
    "flat_half_width": 0.2e-3,
    "edge_radius": 5e-3,
    "length": 10e-3,
    "normal_force": 150.0,
    "friction_coefficient": 0.4,
    "young_modulus": 114e9,
    "poisson_ratio": 0.32,
    "displacement_reference": "rigid_strip",
}
MASS = np.diag([1.0, 0.5])
DAMPING = np.array([[30.0, -10.0], [-10.0, 10.0]])
STIFFNESS = np.array([[2.5e7, -2e7], [-2e7, 2.1e7]])
