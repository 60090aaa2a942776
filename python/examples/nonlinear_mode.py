"""Nonlinear modes: frequency and damping of a beam with a friction face, over its amplitude.

A steel beam of 0.4 m is clamped at one end. From 40 to 80 mm beyond the clamp it lies on a face, whose pressure falls to a third
along the beam, and rubs across its length. The first bending mode is a periodic motion that a negative damping, proportional to
the mass, keeps up (extended periodic motion: Krack, Computers and Structures 154 (2015) 59-71). Newton's method with the exact
Jacobian finds three harmonics, frequency and damping at a given amplitude of the tip.

Prints the amplitude [um], frequency [Hz] and damping ratio [%], then both with the complex stiffness of each strip at its own
amplitude, which leaves out the higher harmonics and what these change:

    1: 140.377, 0.001, 140.377, 0.001
    10: 140.351, 0.009, 140.351, 0.009
    30: 140.283, 0.033, 140.284, 0.033
    50: 140.182, 0.082, 140.183, 0.081
    70: 139.488, 0.609, 139.541, 0.571
    100: 138.174, 1.206, 138.312, 1.146
    200: 134.218, 2.318, 134.424, 2.432
    500: 126.827, 4.575, 127.262, 5.099
"""

import microslip
import numpy as np

LENGTH, WIDTH, MODULUS, DENSITY = 0.4, 0.02, 2.1e11, 7850.0  # m, Pa, kg/m^3; a square section
ELEMENTS, STRIPS, HARMONICS, SAMPLES = 10, 10, 3, 128
FACE = {"flat_half_width": 0, "edge_radius": 0.1, "length": 0.04, "friction_coefficient": 0.3}
FACE |= {"young_modulus": MODULUS, "poisson_ratio": 0.3, "displacement_reference": "rigid_strip"}
AREA = np.full((STRIPS, 1), 0.04 * 2e-3 / STRIPS)  # m^2
PRESSURE = 37.5e6 * np.linspace(1.5, 0.5, STRIPS)[:, None]  # Pa


def beam():
    """Mass and stiffness of the free degrees of freedom, and the displacements of the strips by them."""
    h = LENGTH / ELEMENTS
    places, weights = np.polynomial.legendre.leggauss(4)
    mass, stiffness = np.zeros((2, 2 * ELEMENTS + 2, 2 * ELEMENTS + 2))

    def deflection(s):
        """Of an element at the part s of it, by the deflections and rotations of both ends."""
        return np.array([1 - 3 * s**2 + 2 * s**3, h * (s - 2 * s**2 + s**3), 3 * s**2 - 2 * s**3, h * (s**3 - s**2)])

    for e in range(ELEMENTS):
        at = np.s_[2 * e : 2 * e + 4, 2 * e : 2 * e + 4]
        for s, weight in zip((1 + places) / 2, weights / 2 * h):
            curvature = np.array([12 * s - 6, h * (6 * s - 4), 6 - 12 * s, h * (6 * s - 2)]) / h**2
            mass[at] += DENSITY * WIDTH**2 * weight * np.outer(deflection(s), deflection(s))
            stiffness[at] += MODULUS * WIDTH**4 / 12 * weight * np.outer(curvature, curvature)
    strips = np.zeros((STRIPS, 2 * ELEMENTS + 2))
    strips[:, 2:6] = [deflection((i + 0.5) / STRIPS) for i in range(STRIPS)]
    return mass[2:, 2:], stiffness[2:, 2:], strips[:, 2:]


MASS, STIFFNESS, ON_FACE = beam()
TIP = len(MASS) - 2
CONTACTS = microslip.ContactArray(microslip.Contact(**part) for part in microslip.face_parts(FACE, AREA, PRESSURE).parts)
WORKSPACE = microslip.Workspace(HARMONICS, SAMPLES)
# The derivative by the phase: cos k becomes -k sin k, sin k becomes k cos k.
PHASE = np.zeros((2 * HARMONICS + 1, 2 * HARMONICS + 1))
for k in range(1, HARMONICS + 1):
    PHASE[2 * k - 1, 2 * k], PHASE[2 * k, 2 * k - 1] = k, -k


def residual(motion, omega, damping, amplitude):
    """M x'' - 2 damping omega M x' + K x + f of each coefficient, cos 1 and sin 1 of the tip, and the derivatives of all."""
    contacts = CONTACTS.harmonic_force(WORKSPACE, ON_FACE @ motion.T)
    inertia = omega**2 * (PHASE @ PHASE - 2 * damping * PHASE)
    by_inertia = np.kron(inertia, MASS) + np.kron(np.eye(len(PHASE)), STIFFNESS)
    by_contacts = np.einsum("sij,sa,sb->iajb", contacts.jacobian, ON_FACE, ON_FACE).reshape(by_inertia.shape)
    forces = by_inertia @ motion.ravel() + (contacts.force.T @ ON_FACE).ravel()
    jacobian = np.zeros((len(forces) + 2, len(forces) + 2))
    jacobian[:-2, :-2] = by_inertia + by_contacts
    jacobian[:-2, -2] = 2 / omega * (inertia @ motion @ MASS).ravel()
    jacobian[:-2, -1] = -2 * omega**2 * (PHASE @ motion @ MASS).ravel()
    for row, coefficient in ((-2, 1), (-1, 2)):
        jacobian[row, coefficient * len(MASS) + TIP] = 1
    return np.hstack([forces, motion[1, TIP] - amplitude, motion[2, TIP]]), jacobian


def by_complex_stiffness(amplitude):
    """Angular frequency, damping ratio and motion of one harmonic."""
    motion = np.zeros(len(MASS))
    for _ in range(100):
        k = [contact.complex_stiffness(abs(u)) for contact, u in zip(CONTACTS, ON_FACE @ motion)]
        total = STIFFNESS + ON_FACE.T @ (np.array([one.k_real + 1j * one.k_imag for one in k])[:, None] * ON_FACE)
        values, vectors = np.linalg.eig(np.linalg.solve(MASS, total))
        first = values.real.argmin()
        motion = amplitude * vectors[:, first] / vectors[TIP, first]
    value = values[first]
    return np.sqrt(value.real), value.imag / value.real / 2, motion


if __name__ == "__main__":
    for amplitude in np.array([1, 10, 30, 50, 70, 100, 200, 500]) * 1e-6:
        omega, damping, motion = by_complex_stiffness(amplitude)
        unknowns = np.zeros(len(PHASE) * len(MASS) + 2)
        unknowns[len(MASS) : 3 * len(MASS)] = np.hstack([motion.real, -motion.imag])
        unknowns[-2:] = omega, damping
        for _ in range(20):
            value, jacobian = residual(unknowns[:-2].reshape(len(PHASE), -1), *unknowns[-2:], amplitude)
            if abs(value).max() < 1e-9:
                break
            unknowns -= np.linalg.solve(jacobian, value)
        values = [unknowns[-2] / 2 / np.pi, 100 * unknowns[-1], omega / 2 / np.pi, 100 * damping]
        print(f"{1e6 * amplitude:.0f}: " + ", ".join(f"{value:.3f}" for value in values))
