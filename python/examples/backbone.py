"""Backbone curve: resonance of a mass on a spring and a damper over the excitation, by continuation at phase resonance.

The force is a quarter of a period ahead of the first harmonic of the displacement. Newton's method takes the exact Jacobian. Second
derivatives, as for the frequency at which the amplitude is largest, are differences of that Jacobian: it is smooth between corners,
where the state of the contact at a sample changes; take the event-driven rule, and a step far above rounding (1e-4 here).
Prints excitation [N], frequency [Hz], amplitude [um], and the slope and curvature of the contact's cosine force [N/um, N/um2]:

    0.3 N: 165.63 Hz, 0.404 um, 87.5, -3.9
    1.0 N: 164.93 Hz, 0.871 um, 85.6, -4.3
    3.0 N: 163.73 Hz, 1.607 um, 82.3, -5.0
    10.0 N: 161.29 Hz, 2.871 um, 74.7, -7.5
"""

import microslip
import numpy as np

MASS, STIFFNESS, DAMPING, HARMONICS = 100.0, 2e7, 400.0, 3  # kg, N/m, Ns/m
PARAMETERS = {"flat_half_width": 0, "edge_radius": 10e-3, "length": 3e-3, "normal_force": 800, "friction_coefficient": 0.4}
BODIES = {"young_modulus": 114e9, "poisson_ratio": 0.32, "displacement_reference": "rigid_strip"}
CONTACT = microslip.Contact(**PARAMETERS, **BODIES)
WORKSPACE = microslip.Workspace(HARMONICS, 64, microslip.EVENT_DRIVEN)
SCALE = CONTACT.slip_displacement


def linear(omega):
    """Dynamic stiffness of mass, spring and dashpot on [mean, cos, sin, ...], and its derivative by omega."""
    k = np.repeat(np.arange(HARMONICS + 1), 2)[1:]  # of each coefficient
    turn = np.diag(k[1:] * (np.arange(len(k) - 1) % 2 == 1), 1)  # from sine to cosine
    dashpot = DAMPING * (turn - turn.T)
    return np.diag(STIFFNESS - MASS * (k * omega) ** 2) + omega * dashpot, np.diag(-2 * MASS * k**2 * omega) + dashpot


def resonance(excitation, u, omega):
    """Displacement and frequency at which -excitation sin(omega t) drives a displacement whose first harmonic is a cosine."""
    load = np.zeros(len(u))
    load[2] = -excitation
    for _ in range(50):
        found, (matrix, slope) = CONTACT.harmonic_force(WORKSPACE, u), linear(omega)
        residual = np.append(matrix @ u + found.force - load, 0) / SCALE / STIFFNESS
        columns = np.block([[matrix + found.jacobian, (slope @ u)[:, None] / SCALE * omega], [np.eye(len(u))[2], 0]])
        step = np.linalg.solve(columns / STIFFNESS, -residual)
        u, omega = u + SCALE * step[:-1], omega * (1 + step[-1])
        if abs(step).max() < 1e-10:
            return u, omega
    raise RuntimeError("no convergence")


if __name__ == "__main__":
    u = SCALE * np.array([0, 0.1, 0, 0, 0, 0, 0])
    omega = np.sqrt((STIFFNESS + CONTACT.initial_stiffness) / MASS)
    for excitation in [0.3, 1.0, 3.0, 10.0]:
        u, omega = resonance(excitation, u, omega)
        h = 1e-4 * SCALE * np.eye(len(u))[1]
        slopes = [CONTACT.harmonic_force(WORKSPACE, u + step).jacobian[1, 1] for step in (-h, 0 * h, h)]
        curvature = (slopes[2] - slopes[0]) / (2 * h[1])
        print(f"{excitation} N: {omega / 2 / np.pi:.2f} Hz, {1e6 * u[1]:.3f} um, {1e-6 * slopes[1]:.1f}, {1e-12 * curvature:.1f}")
