"""What harmonic force and Jacobian of a contact cost in pyHarm: its own friction elements, and microslip through the adapter.

Prints medians of the processor time in microseconds over rounds in which the elements take turns, for 1, 5 and 9 harmonics and 128
samples; in brackets what `Contact.harmonic_force` takes of it. Then the seconds of a whole response of the two masses with
one contact, and with twenty that share its load and stiffness. Set OPENBLAS_NUM_THREADS=1: the matrices are small."""

import contextlib
import io
import time
from statistics import median

import microslip
import numpy as np
from microslip.pyharm import Microslip
from pyHarm.Maestro import Maestro
from pyharm_two_masses import two_masses
from two_masses import CONTACT, DAMPING, MASS, STIFFNESS

CALLS = 20
law = microslip.Contact(**CONTACT)


def elements(share=1.0):
    """Contacts that carry a share of the load and have the same slip displacement."""
    shares = {name: share * CONTACT[name] for name in ("normal_force", "young_modulus")}
    part = microslip.Contact(**CONTACT | shares)
    slider = {"mu": part.friction_coefficient, "N0": part.normal_force}
    return {
        "Jenkins": {"type": "Jenkins", "dirs": [0], "k": part.initial_stiffness, **slider},
        "Penalty3D": {"type": "Penalty3D", "dirs": [2, 0, 1], "g": 0.0, "k_n": 1e8, "k_t": part.initial_stiffness, **slider},
        "microslip": {"type": "microslip", "dirs": [0], "law": part},
    }


ELEMENTS = elements()


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


def response(name, number):
    """Processor time of a response with a number of contacts at the second mass."""
    contact = elements(1 / number)[name]
    data = two_masses(contact, [300.0, 900.0], ndofs=len(contact["dirs"]))
    data["connectors"] |= {f"contact {i}": data["connectors"]["contact"] for i in range(1, number)}
    with contextlib.redirect_stdout(io.StringIO()):
        maestro = Maestro(data)
        start = time.process_time()
        maestro.operate()
    return time.process_time() - start


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
    print("| contacts | Jenkins | microslip |")
    for number in (1, 20):
        cells = [median(response(name, number) for _ in range(min(rounds, 5))) for name in ("Jenkins", "microslip")]
        print(f"| {number} | " + " | ".join(f"{cell:.2f}" for cell in cells) + " |")


if __name__ == "__main__":
    main()
