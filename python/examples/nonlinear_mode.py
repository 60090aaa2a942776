"""Nonlinear modes: frequency and damping of two masses with a damper's contact between them, over the amplitude at the contact.

The contact is its complex stiffness K' + iK'' at that amplitude, exact for the first harmonic; of the eigenvalues of the structure
with it, omega^2 (1 + i eta), half of eta is the damping ratio. Prints amplitude over that of gross slip, frequency [Hz], damping
ratio [%] of the second mode:

    0.01: 278.93, 0.016
    0.1: 277.97, 0.164
    0.5: 273.13, 1.004
    0.9: 266.44, 2.559
    1.5: 225.99, 18.410
    3.0: 163.96, 31.876
    10.0: 115.44, 24.802
"""

import microslip
import numpy as np

MASS = np.diag([100.0, 50.0])  # kg
STIFFNESS = np.array([[2e7, -5e6], [-5e6, 2e7]])  # N/m
BETWEEN = np.array([[1.0, -1.0]])  # relative displacement
PARAMETERS = {"flat_half_width": 0, "edge_radius": 10e-3, "length": 3e-3, "normal_force": 800, "friction_coefficient": 0.4}
BODIES = {"young_modulus": 114e9, "poisson_ratio": 0.32, "displacement_reference": "rigid_strip"}
CONTACT = microslip.Contact(**PARAMETERS, **BODIES)


def modes(amplitude):
    """Angular frequencies [rad/s] and damping ratios of both modes at an amplitude of the contact [m]."""
    k = CONTACT.complex_stiffness(amplitude)
    total = STIFFNESS + BETWEEN.T @ BETWEEN * (k.k_real + 1j * k.k_imag)
    values = np.linalg.eigvals(np.linalg.solve(MASS, total))
    values = values[np.argsort(values.real)]
    return np.sqrt(values.real), values.imag / values.real / 2


if __name__ == "__main__":
    for relative in [0.01, 0.1, 0.5, 0.9, 1.5, 3.0, 10.0]:
        omega, damping = modes(relative * CONTACT.slip_displacement)
        print(f"{relative}: {omega[1] / 2 / np.pi:.2f}, {100 * damping[1]:.3f}")
