"""Contacts in Exudyn: a mass on a spring and a contact by Newmark's method, also against Exudyn's own spring with friction."""

from __future__ import annotations

import exudyn
import microslip
import numpy as np
import pytest
from exudyn.itemInterface import (
    CoordinateSpringDamperExt,
    LoadCoordinate,
    MarkerNodeCoordinate,
    Mass1D,
    Node1D,
    NodeGenericData,
    NodePointGround,
)
from microslip.exudyn import Contacts
from two_masses import CONTACT

STEPS, STEP = 3000, 1e-5  # s
MASS, STIFFNESS, DAMPING = 0.5, 2e7, 200.0  # kg, N/m, N s/m
contact = microslip.Contact(**CONTACT)


def load(t, amplitude):
    """At 1500 Hz, after a ramp of 10 ms."""
    return amplitude * np.sin(2 * np.pi * 1500 * t) * min(1, t / 0.01)


def displacements(amplitude, with_slider=False):
    """The displacement at the start of each step [m], with the contact or Exudyn's spring-slider of its stiffness and force."""
    mbs, accepted = exudyn.SystemContainer().AddSystem(), []
    node = mbs.AddNode(Node1D(referenceCoordinates=[0], initialCoordinates=[0.0], initialVelocities=[0.0]))
    mbs.AddObject(Mass1D(mass=MASS, nodeNumber=node))
    ground = mbs.AddNode(NodePointGround())
    markers = [mbs.AddMarker(MarkerNodeCoordinate(nodeNumber=number, coordinate=0)) for number in (ground, node)]

    def before_step(mbs, t):
        accepted.append(float(np.squeeze(mbs.GetNodeOutput(node, exudyn.OutputVariableType.Coordinates))))
        return True

    if with_slider:
        data = mbs.AddNode(NodeGenericData(initialCoordinates=[0, 0, 0], numberOfDataCoordinates=3))
        friction = {"dynamicFrictionForce": contact.slip_force, "stickingStiffness": contact.initial_stiffness, "nodeNumber": data}
        mbs.AddObject(CoordinateSpringDamperExt(markerNumbers=markers, stiffness=STIFFNESS, damping=DAMPING, **friction))
        mbs.SetPreStepUserFunction(before_step)
    else:
        Contacts(mbs, before_step).add(markers, contact, STIFFNESS, DAMPING)
    mbs.AddLoad(LoadCoordinate(markerNumber=markers[1], loadUserFunction=lambda mbs, t, _: load(t, amplitude)))
    mbs.Assemble()
    settings = exudyn.SimulationSettings()
    integration = settings.timeIntegration
    integration.numberOfSteps, integration.endTime, integration.verboseMode = STEPS, STEPS * STEP, 0
    integration.newton.useModifiedNewton = False
    integration.newton.relativeTolerance, integration.newton.absoluteTolerance = 1e-10, 1e-12
    integration.newton.numericalDifferentiation.relativeEpsilon = 1e-9
    integration.generalizedAlpha.useNewmark, integration.generalizedAlpha.spectralRadius = True, 1
    settings.solution.file.write = False
    mbs.SolveDynamic(settings)
    return np.array(accepted[:STEPS])


def newmark(amplitude):
    """The same by a state that is accepted after each step."""
    state, u, v, a, h = microslip.State(), 0.0, 0.0, 0.0, STEP
    history = []
    for step in range(1, STEPS + 1):
        history.append(u)
        trial = u
        for _ in range(60):
            result = contact.update(state, trial)
            acceleration = (trial - u - h * v) * 4 / h**2 - a
            velocity = v + h / 2 * (a + acceleration)
            residual = MASS * acceleration + DAMPING * velocity + STIFFNESS * trial + result.force - load(step * h, amplitude)
            change = residual / (MASS * 4 / h**2 + DAMPING * 2 / h + STIFFNESS + result.stiffness)
            trial -= change
            if abs(change) < 1e-17:
                break
        state, u, v, a = contact.update(state, trial).state, trial, velocity, acceleration
    return np.array(history)


def test_displacements_are_those_of_newmark():
    expected = newmark(600.0)
    # In gross slip the state matters; the iterations end at 1e-10 of the residual.
    assert abs(expected).max() > contact.slip_displacement
    assert abs(displacements(600.0) - expected).max() < 1e-8 * abs(expected).max()


@pytest.mark.parametrize("amplitude", [1.0, 1e5])
def test_contact_is_exudyns_slider_in_the_limits_of_stick_and_slip(amplitude):
    expected = displacements(amplitude, with_slider=True)
    # Microslip at a fiftieth of gross slip, and the way to gross slip at 15,000 times, change the displacement by 2e-4.
    assert abs(displacements(amplitude) - expected).max() < 4e-4 * abs(expected).max()
