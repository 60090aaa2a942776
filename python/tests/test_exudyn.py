"""The contact in Exudyn against Newmark's method with a state that is accepted after each step."""

from __future__ import annotations

import exudyn_microslip as example
import microslip
import numpy as np
from two_masses import CONTACT

STEPS = 3000


def newmark(contact):
    state, u, v, a, h = microslip.State(), 0.0, 0.0, 0.0, example.STEP
    history = []
    for step in range(1, STEPS + 1):
        history.append(u)
        trial = u
        for _ in range(60):
            result = contact.update(state, trial)
            acceleration = (trial - u - h * v) * 4 / h**2 - a
            velocity = v + h / 2 * (a + acceleration)
            residual = example.MASS * acceleration + example.DAMPING * velocity + example.STIFFNESS * trial
            residual += result.force - example.load(step * h)
            change = residual / (example.MASS * 4 / h**2 + example.DAMPING * 2 / h + example.STIFFNESS + result.stiffness)
            trial -= change
            if abs(change) < 1e-17:
                break
        state, u, v, a = contact.update(state, trial).state, trial, velocity, acceleration
    return np.array(history)


def test_displacements_are_those_of_newmark():
    contact = microslip.Contact(**CONTACT)
    expected = newmark(contact)
    # In gross slip the state matters; the iterations end at 1e-10 of the residual.
    assert abs(expected).max() > contact.slip_displacement
    assert abs(example.displacements(contact, STEPS)[:STEPS] - expected).max() < 1e-8 * abs(expected).max()
