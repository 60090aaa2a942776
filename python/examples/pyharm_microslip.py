"""The law as an element of pyHarm (pyHarm-os 1.2), with the forced response of two masses.

    from pyharm_microslip import Microslip
    Maestro({"plugin": [Microslip], "connectors": {"contact": {"type": "microslip", "law": microslip.Contact(...), ...}}, ...})

An entry of `connectors` has, beside pyHarm's `connect` (first node against the second one, or against the ground) and
`coordinatesystem`:

- `law`: a `microslip.Contact`, or a `microslip.Element` with `INPUT_APPROACH`;
- `dirs`: the tangential direction of a contact; one or two tangential directions and then the normal one of an element. The
  normal direction points into the second node: a positive relative displacement is an approach;
- `interference` (elements): approach of the undeformed structure [m]; a gap is negative.

Conventions. Coefficients are those of the library, [c0, cos1, sin1, ...], and the samples those of the system, `nti` from t = 0.
pyHarm's own Jenkins element starts unloaded at displacement 0, as the library does: so a mean displacement loads the contact.
"""

import sys
from itertools import cycle
from pathlib import Path

import microslip
import numpy as np
from pyHarm.DynamicOperator import get_array_nh
from pyHarm.Elements.NodeToNodeElements.NodeToNodeElement import NodeToNodeElement
from pyHarm.Maestro import Maestro


class Microslip(NodeToNodeElement):
    """A contact or a friction contact element between two nodes."""

    factory_keyword = "microslip"

    def __post_init__(self):
        self.law = self.data["law"]
        self.length = 1.0
        self.evaluated = None
        harmonics, *_ = get_array_nh(self.nh)
        highest = int(harmonics.max())
        # The places of pyHarm's coefficients among all from 0 to the highest harmonic.
        places = np.concatenate([[2 * k - 1, 2 * k] if k else [0] for k in harmonics])
        if isinstance(self.law, microslip.Element):
            if self.law.normal_input != microslip.INPUT_APPROACH:
                raise ValueError(f"{self.name}: the normal input of the element must be INPUT_APPROACH")
            self.components = self.law.directions + 1
            self.workspace = microslip.ElementWorkspace(self.law.directions, highest, self.nti)
        else:
            self.components = 1
            self.workspace = microslip.Workspace(highest, self.nti)
        size = 2 * highest + 1
        self.places = np.concatenate([places + size * i for i in range(self.components)])
        self.rest = np.zeros((self.components, size))
        if isinstance(self.law, microslip.Element):
            self.rest[-1, 0] = self.data.get("interference", 0.0)

    def __flag_update__(self):
        self.flag_nonlinear = True
        self.flag_AFT = True

    def generateIndices(self, expl_dofs):
        super().generateIndices(expl_dofs)
        if len(self.Pdir) != self.components:
            raise ValueError(f"{self.name}: {self.components} dirs are required, not {len(self.Pdir)}")
        relative = self.Pslave - self.Pmaster
        self.local = np.vstack([direction @ relative for direction in self.Pdir])

    def adim(self, lc, wc):
        self.length = lc
        self.flag_adim = True

    def evaluate(self, xg):
        """Force and Jacobian; the residual and the Jacobian of one point are one evaluation."""
        x = xg[self.indices]
        if self.evaluated is None or not np.array_equal(self.evaluated[0], x):
            displacement = self.rest.copy()
            displacement.ravel()[self.places] += self.length * (self.local @ x)
            shape = displacement.shape if self.components > 1 else -1
            found = self.law.harmonic_force(self.workspace, displacement.reshape(shape))
            force = found.force.ravel()[self.places]
            jacobian = self.length * found.jacobian[np.ix_(self.places, self.places)]
            self.evaluated = x, self.local.T @ force, self.local.T @ jacobian @ self.local
        return self.evaluated

    def evalResidual(self, xg, om):
        self.R = self.evaluate(xg)[1]
        return self.R

    def evalJacobian(self, xg, om):
        self.J = self.evaluate(xg)[2]
        self.dJdom = np.zeros(len(self.indices))
        return self.J, self.dJdom


# Two masses, one contact to the ground: fortran_examples/cases/two_dof.nml.
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


def main():
    from spring_slider import harmonic_force, microseconds

    law = microslip.Contact(**CONTACT)
    table = Path(__file__).resolve().parents[2] / "fortran_examples" / "expected" / "two_dof.csv"
    print(f"deviation from the Fortran example: {deviation(table):.1e}")

    stiffness, slip_force, slip = law.initial_stiffness, law.slip_force, law.slip_displacement
    contacts = {
        "microslip": {"type": "microslip", "dirs": [0], "law": law},
        "pyHarm's Jenkins element": {"type": "Jenkins", "dirs": [0], "mu": 0.4, "N0": 150.0, "k": stiffness},
    }
    random = np.random.default_rng(1)
    for name, contact in contacts.items():
        system = Maestro(two_masses(contact, [300.0, 900.0])).system
        element = next(e for e in system.LE if e.name == "contact")
        points = cycle(slip / LENGTH * random.standard_normal((50, system.ndofs)))

        def residual_and_jacobian(element=element, points=points):
            x = next(points)
            element.evalResidual(x, 1.0)
            element.evalJacobian(x, 1.0)

        print(f"{name}: {microseconds(residual_and_jacobian, 20):.0f} µs for a residual and a Jacobian")
    displacement = slip * random.standard_normal(11)
    print(f"spring-slider in NumPy: {microseconds(lambda: harmonic_force(stiffness, slip_force, displacement, 128), 3):.0f} µs")
    return 0


if __name__ == "__main__":
    sys.exit(main())
