"""A thousand contacts with random friction and normal force: the interval of the resonance of a mass with such a damper.

Friction is uniform between 0.3 and 0.5, the load normal with 800 +- 80 N. All contacts are solved at once: a batch of complex
stiffnesses at their present amplitudes, which are those of a resonance, F = (damping + K''/omega) omega u. Prints median and the
interval of 95 % of amplitude [um] and frequency [Hz]:

    amplitude: 2.071, 1.772 to 2.366
    frequency: 162.805, 160.364 to 164.956
"""

import microslip
import numpy as np

MASS, STIFFNESS, DAMPING, EXCITATION, CONTACTS = 100.0, 2e7, 400.0, 5.0, 1000  # kg, N/m, Ns/m, N


def contacts(random):
    """Contacts of random friction and load."""
    return microslip.ContactArray(
        microslip.Contact(
            flat_half_width=0,
            edge_radius=10e-3,
            length=3e-3,
            normal_force=random.normal(800, 80),
            friction_coefficient=random.uniform(0.3, 0.5),
            young_modulus=114e9,
            poisson_ratio=0.32,
            displacement_reference="rigid_strip",
        )
        for _ in range(CONTACTS)
    )


def resonances(array):
    """Amplitudes [m] and angular frequencies [rad/s] at resonance, by bisection for all contacts at once."""
    low, high = np.full(len(array), 1e-9), np.full(len(array), 1e-3)
    for _ in range(60):
        amplitude = np.sqrt(low * high)
        k = array.complex_stiffness(amplitude)
        omega = np.sqrt((STIFFNESS + k.k_real) / MASS)
        too_large = (DAMPING * omega + k.k_imag) * amplitude > EXCITATION
        low, high = np.where(too_large, low, amplitude), np.where(too_large, amplitude, high)
    return amplitude, omega


if __name__ == "__main__":
    amplitude, omega = resonances(contacts(np.random.default_rng(1)))
    for name, values in [("amplitude", 1e6 * amplitude), ("frequency", omega / 2 / np.pi)]:
        low, middle, high = np.quantile(values, [0.025, 0.5, 0.975])
        print(f"{name}: {middle:.3f}, {low:.3f} to {high:.3f}")
