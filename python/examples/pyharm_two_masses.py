"""The forced response of two masses with pyHarm, compared with that of the Fortran example."""

from pathlib import Path

import microslip
import numpy as np
from microslip.pyharm import Microslip
from pyHarm.Maestro import Maestro
from two_masses import CONTACT, DAMPING, MASS, STIFFNESS

# Units of pyHarm's unknowns: a displacement [m] and an angular frequency [rad/s].
LENGTH, ANGULAR_FREQUENCY = 1e-6, 1e3


def two_masses(contact, frequencies, forcing=15.0, ndofs=1):
    """Input of pyHarm: the two masses, `contact` as the connector at the second one, a force [N] at the first, 5 harmonics, and
    the response from the first to the second of two frequencies [Hz]. With ndofs = 2 they move in two directions."""
    matrices = {name: np.kron(matrix, np.eye(ndofs)) for name, matrix in zip("MCK", (MASS, DAMPING, STIFFNESS))}
    return {
        "plugin": [Microslip],
        "system": {"type": "Base", "nh": 5, "nti": 128, "adim": {"status": True, "lc": LENGTH, "wc": ANGULAR_FREQUENCY}},
        "substructures": {"masses": {"ndofs": ndofs, "matrix": matrices}},
        "connectors": {
            "contact": {"connect": {"masses": [1]}, **contact},
            "force": {"type": "CosinusForcing", "connect": {"masses": [0]}, "dirs": [0], "amp": forcing},
        },
        "analysis": {
            "response": {
                "study": "frf",
                "solver": "NewtonRaphson",
                # In N, and in the units above: some hundred roundings of the elastic forces and of the unknowns.
                "solver_options": {"tol_residual": 1e-11, "tol_delta_x": 1e-12, "max_iter": 20},
                "puls_inf": 2 * np.pi * frequencies[0],
                "puls_sup": 2 * np.pi * frequencies[1],
                "ds0": 0.1,
                "ds_max": 0.1,
                "ds_min": 1e-4,
                "verbose": False,
            }
        },
    }


def response(maestro):
    """Frequencies [Hz] of the continuation, and coefficients (frequency, degree of freedom, 2H+1) of the displacements [m]."""
    if not maestro.nls["response"].SolList:
        maestro.operate()
    points = np.array([solution.x for solution in maestro.nls["response"].SolList if solution.flag_accepted])
    coefficients = LENGTH * points[:, :-1].reshape(len(points), 2 * maestro.system.nh + 1, -1).swapaxes(1, 2)
    return points[:, -1] * ANGULAR_FREQUENCY / (2 * np.pi), coefficients


def response_at(maestro, frequencies):
    """Coefficients (frequency, degree of freedom, 2H+1) of the displacements [m] at given frequencies [Hz] of the response."""
    near, coefficients = response(maestro)
    study, found = maestro.nls["response"], []
    for frequency in frequencies:
        i = min(max(int(np.searchsorted(near, frequency)), 1), len(near) - 1)
        share = (frequency - near[i - 1]) / (near[i] - near[i - 1])
        start = (1 - share) * coefficients[i - 1] + share * coefficients[i]
        study.analysis_options["puls_start"] = 2 * np.pi * frequency / ANGULAR_FREQUENCY
        study.initialise(start.T.ravel() / LENGTH)
        solution = study.SolList.pop()
        if not solution.flag_accepted:
            raise RuntimeError(f"no solution at {frequency} Hz")
        found.append(LENGTH * solution.x[:-1].reshape(start.T.shape).T)
    return np.array(found)


def deviation(table):
    """The largest difference from the table of the Fortran example, over the largest coefficient of the same mass and frequency."""
    rows = np.loadtxt(table, delimiter=",", skiprows=1).reshape(-1, 2, 13)
    frequencies, expected = rows[:, 0, 0], rows[:, :, 2:]
    contact = {"type": "microslip", "dirs": [0], "law": microslip.Contact(**CONTACT)}
    found = response_at(Maestro(two_masses(contact, [300.0, 900.0])), frequencies)
    return (abs(found - expected).max(axis=2) / abs(expected).max(axis=2)).max()


if __name__ == "__main__":
    table = Path(__file__).resolve().parents[2] / "fortran_examples" / "expected" / "two_dof.csv"
    print(f"deviation from the Fortran example: {deviation(table):.1e}")
