"""What harmonic force and Jacobian of a contact cost in pyHarm: its own friction elements, and microslip through the adapter.

Prints medians of the processor time in microseconds over rounds in which the elements take turns, for 1, 5 and 9 harmonics and 128
samples; in brackets what `Contact.harmonic_force` takes of it. Set OPENBLAS_NUM_THREADS=1: the matrices are small."""

import contextlib
import io
import time
from statistics import median

import microslip
import numpy as np
from microslip.pyharm import Microslip
from pyHarm.Maestro import Maestro
from two_masses import CONTACT, DAMPING, MASS, STIFFNESS

CALLS = 20
law = microslip.Contact(**CONTACT)
slider = {"mu": law.friction_coefficient, "N0": law.normal_force}
ELEMENTS = {
    "Jenkins": {"type": "Jenkins", "dirs": [0], "k": law.initial_stiffness, **slider},
    "Penalty3D": {"type": "Penalty3D", "dirs": [2, 0, 1], "g": 0.0, "k_n": 1e8, "k_t": law.initial_stiffness, **slider},
    "microslip": {"type": "microslip", "dirs": [0], "law": law},
}


def element(contact, harmonics):
    """The contact at the second of two masses, and the number of unknowns of the system."""
    ndofs = len(contact["dirs"])
    masses = {name: np.kron(matrix, np.eye(ndofs)) for name, matrix in zip("MCK", (MASS, DAMPING, STIFFNESS))}
    with contextlib.redirect_stdout(io.StringIO()):
        system = Maestro(
            {
                "plugin": [Microslip],
                "system": {"type": "Base", "nh": harmonics, "nti": 128},
                "substructures": {"masses": {"ndofs": ndofs, "matrix": masses}},
                "connectors": {"contact": {"connect": {"masses": [1]}, **contact}},
                "analysis": {},
            }
        ).system
    return next(e for e in system.LE if e.name == "contact"), 2 * ndofs * (2 * harmonics + 1)


def seconds(evaluate, motions):
    """Processor time of one call, mean over `motions`."""
    start = time.process_time()
    for motion in motions:
        evaluate(motion)
    return (time.process_time() - start) / len(motions)


def main(rounds=41):
    random = np.random.default_rng(1)
    print("| harmonics | " + " | ".join(ELEMENTS) + " |")
    for harmonics in (1, 5, 9):
        tasks = {}
        for name, contact in ELEMENTS.items():
            found, unknowns = element(contact, harmonics)
            motions = law.slip_displacement * random.standard_normal((CALLS, unknowns)) / np.sqrt(harmonics)

            def evaluate(motion, found=found):
                found.evalResidual(motion, 1.0)
                found.evalJacobian(motion, 1.0)

            tasks[name] = evaluate, motions
            seconds(*tasks[name])  # compiles those of pyHarm
        workspace = microslip.Workspace(harmonics, 128)
        motions = law.slip_displacement * random.standard_normal((CALLS, 2 * harmonics + 1)) / np.sqrt(harmonics)
        tasks["library"] = (lambda motion, workspace=workspace: law.harmonic_force(workspace, motion)), motions
        times = [[seconds(*task) for task in tasks.values()] for _ in range(rounds)]
        *cells, alone = (1e6 * median(column) for column in zip(*times))
        print(f"| {harmonics} | " + " | ".join(f"{cell:.0f}" for cell in cells) + f" ({alone:.0f}) |")


if __name__ == "__main__":
    main()
