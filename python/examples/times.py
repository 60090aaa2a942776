"""Processor time of calls, beside a spring-slider in NumPy: 5 harmonics, 128 samples, a random motion with gross slip."""

import microslip
import numpy as np
from spring_slider import harmonic_force, microseconds

PARAMETERS = {
    "flat_half_width": 0.05e-3,
    "edge_radius": 50e-3,
    "length": 20e-3,
    "normal_force": 800.0,
    "friction_coefficient": 0.5,
    "young_modulus": 2e11,
    "poisson_ratio": 0.3,
    "displacement_reference": "rigid_strip",
}
contact, element = microslip.Contact(**PARAMETERS), microslip.Element(**PARAMETERS)
slip = contact.slip_displacement
random = np.random.default_rng(1)
displacement = slip * random.standard_normal(11)
workspace, element_workspace = microslip.Workspace(5, 128), microslip.ElementWorkspace(1, 5, 128)
both = np.zeros((2, 11))
both[0], both[1, 0] = displacement, element.approach
state, history = microslip.State(), slip * random.uniform(-1, 1, 100_000)
many, items = microslip.ContactArray([contact]), 1000
displacements, index = np.tile(displacement, (items, 1)), np.zeros(items, dtype=int)

for name, time in [
    ("harmonic force and Jacobian", microseconds(lambda: contact.harmonic_force(workspace, displacement), 100)),
    ("the same, each of 1000 items", microseconds(lambda: many.harmonic_force(workspace, displacements, index=index), 1) / items),
    ("the same of an element", microseconds(lambda: element.harmonic_force(element_workspace, both), 20)),
    ("step in place", microseconds(lambda: contact.update(state, 0.1 * slip, out=state), 100)),
    ("step, each of 100,000", microseconds(lambda: contact.update(state, history), 1) / len(history)),
    (
        "spring-slider in NumPy, harmonic force and Jacobian",
        microseconds(lambda: harmonic_force(contact.initial_stiffness, contact.slip_force, displacement, 128), 3),
    ),
]:
    print(f"{name}: {time:.3g} µs")
