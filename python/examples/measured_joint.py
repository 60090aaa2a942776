"""A measured bolted joint, the Brake-Reuss beam: which laws follow the frequency and damping of two modes over the amplitude?

Cenedese and others (Mechanical Systems and Signal Processing 166 (2022) 108401) measured the decay of both modes after a blow of a
hammer, here down to 1/40 of the largest amplitude, and mode 1 in steady sweeps at eight amplitudes; all at the driven point. With a
contact of complex stiffness k(u) a mode has

    omega^2 (1 + 2i zeta) = W (1 + 2i zeta_0) + s (k(u/u_0) - k(0)),  s >= 0,

linear in W, zeta_0 and s for every slip scale u_0. One contact has the best u_0 of a grid. A spread has all of them at once, and
its squared error is convex in the factors s, so no other spread on the grid is better. Any law of Masing's is a spread of
spring-sliders.

In microslip the ratio R of 2 (zeta - zeta_0) to -d ln omega^2 / d ln u is between 4/(3 pi) = 0.42 and 2/pi = 0.64. Here zeta_0 is
the smallest damping ratio that was measured.

Prints the table of docs/validation.md: root mean square errors of the frequency [Hz] and of the damping ratio [1e-5]; then the
sweeps. `measured_joint.py FILE` also writes the curves of the figure.
"""

import pathlib
import sys

import microslip
import numpy as np
from scipy.optimize import nnls

DATA = pathlib.Path(__file__).parents[2] / "tests" / "golden"
CYLINDER = {"flat_half_width": 0, "edge_radius": 10e-3, "length": 0.1, "normal_force": 800, "friction_coefficient": 0.4}
CYLINDER |= {"young_modulus": 114e9, "poisson_ratio": 0.32, "displacement_reference": "rigid_strip"}
CONTACT, ELEMENT = microslip.Contact(**CYLINDER), microslip.Element(**CYLINDER)
SLIP, STIFFNESS = CONTACT.slip_displacement, CONTACT.initial_stiffness
VARIATIONS = *((v, 0) for v in (0.1, 0.3, 1, 2, 5, 10)), *((0, v) for v in (0.1, 0.3, 1, 10))  # linear, square
WORKSPACE = microslip.ElementWorkspace(directions=1, harmonics=2, samples=256)


def law(a):
    """Change of the complex stiffness over the initial one, at amplitudes over the slip displacement."""
    k = CONTACT.complex_stiffness(a * SLIP)
    return (k.k_real + 1j * k.k_imag) / STIFFNESS - 1


def slider(a):
    """`law` of a spring-slider."""
    a = np.maximum(a, 1)
    angle = np.arccos(1 - 2 / a)
    return (angle - np.sin(2 * angle) / 2) / np.pi + 4j / np.pi * (a - 1) / a**2 - 1


def varying(linear, square):
    """`law` of an element with the approach w (1 + linear a cos t + square (a cos t)^2) under a cos t: it may open."""

    def one(a):
        mean, twice = 1 + square * a * a / 2, square * a * a / 2
        approach = ELEMENT.approach * np.array([mean, linear * a, 0, twice, 0])
        force = ELEMENT.harmonic_force(WORKSPACE, [[0, a * SLIP, 0, 0, 0], approach], jacobian=False).force[0]
        return (force[1] - 1j * force[2]) / (a * SLIP * STIFFNESS) - 1

    return np.vectorize(one, otypes=[complex])


def fit(changes, data):
    """The best sum of changes[i] at the rows, times factors >= 0: squared error, frequencies, damping ratios.

    Frequency and damping both count in units of the standard deviation of what was measured.
    """
    _, frequency, damping = data
    measured = frequency**2 * (1 + 2j * damping)

    def units(z):
        return np.hstack([z.real / measured.real.std(), z.imag / measured.imag.std()])

    basis = np.array([measured**0, 1j * measured**0, *changes])
    columns = np.array([units(one) for one in basis]).T
    size = np.maximum(np.linalg.norm(columns, axis=0), 1e-9)
    factors, error = nnls(columns / size, units(measured), maxiter=10**5)
    found = factors / size @ basis
    return error, np.sqrt(found.real), found.imag / found.real / 2


def one_contact(changes, data):
    """`fit` with the best one of the changes."""
    return min((fit([change], data) for change in changes), key=lambda found: found[0])


def read(name):
    return np.genfromtxt(DATA / name, delimiter=",", names=True, skip_header=2, dtype=None, encoding="utf8")


def ring_down(mode):
    rows = read("brb_hammer_decay.csv")
    rows = rows[(rows["mode"] == mode) & (rows["sensor"] == "acc3")]
    rows = rows[rows["displacement_amplitude_um"] > rows["displacement_amplitude_um"].max() / 40]
    return np.array([rows[name] for name in ("displacement_amplitude_um", "frequency_Hz", "damping_ratio")])


def sweep(rows):
    """Amplitude [um], frequency and damping: at a constant amplitude F/x = m (omega_0^2 - omega^2 + 2i zeta omega_0 omega)."""
    omega = 2 * np.pi * rows["frequency_Hz"]
    displacement = rows["acceleration_m_s2"] / omega**2  # the accelerometer points against the force
    stiffness = rows["force_N"] / displacement * np.exp(-1j * rows["phase_rad"])
    (mass, static), *_ = np.linalg.lstsq(np.array([-(omega**2), omega**0]).T, stiffness.real, rcond=None)
    omega_0 = np.sqrt(static / mass)
    return 1e6 * displacement.mean(), omega_0 / 2 / np.pi, stiffness.imag @ omega / (omega @ omega) / (2 * mass * omega_0)


def ratio(amplitude, frequency, damping, zeta_0):
    """R: the integral of 2 (zeta - zeta_0) over ln u, over the fall of ln omega^2."""
    loss = (damping[1:] + damping[:-1] - 2 * zeta_0) @ np.diff(np.log(amplitude))
    return loss / (2 * np.log(frequency[0] / frequency[-1]))


if __name__ == "__main__":
    rows = read("brb_sweeps.csv")
    sweeps = np.array([sweep(rows[(rows["control"] == "response") & (rows["level"] == level)]) for level in range(7, -1, -1)]).T
    named = {"mode 2": ring_down(2), "mode 1": ring_down(1), "mode 1, sweeps": sweeps}
    table, curves = {"R, upper and lower half": []}, []
    for number, data in enumerate(named.values()):
        half = len(data[0]) // 2
        ratios = [ratio(*data[:, part], data[2].min()) for part in (slice(half + 1), slice(half, None))]
        table["R, upper and lower half"].append("{:.2f}, {:.2f}".format(*ratios))
        amplitudes = data[0] / np.geomspace(data[0].min() / 2, 300 * data[0].max(), 500)[:, None]
        changes = np.vstack([varying(*variation)(amplitudes) for variation in VARIATIONS])
        found = {
            "constant": fit([], data),
            "spring-slider": one_contact(slider(amplitudes), data),
            "law": one_contact(law(amplitudes), data),
            "law, load varies": one_contact(changes, data),
            "spread, constant loads": fit(slider(amplitudes), data),
            "spread, loads vary": fit(changes, data),
        }
        for label, (_, *fitted) in found.items():
            error = np.sqrt(np.mean((np.array(fitted) - data[1:]) ** 2, axis=1))
            table.setdefault(label, []).append(f"{error[0]:.4f}, {1e5 * error[1]:.1f}")
        drawn = [found[label][1:] for label in ("spring-slider", "law", "spread, constant loads")]
        curves.append(np.vstack([np.full(len(data[0]), number), data, *drawn]).T)
    print("| |", " | ".join(f"{name}: {len(data[0])} amplitudes" for name, data in named.items()), "|\n|---|---:|---:|---:|")
    for label, cells in table.items():
        print("|", label, "|", " | ".join(cells), "|")
    print("\nSweeps:", "; ".join(f"{a:.0f} µm {f:.2f} Hz {100 * z:.2f} %" for a, f, z in sweeps.T) + ".")
    names = "data,amplitude,frequency,damping,f_slider,zeta_slider,f_law,zeta_law,f_spread,zeta_spread"
    for file in sys.argv[1:]:
        np.savetxt(file, np.vstack(curves), "%.7g", ",", header=names, comments="")
