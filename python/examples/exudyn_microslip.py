"""A mass on a friction contact in Exudyn, by Newmark's method.

[Exudyn](https://pypi.org/project/exudyn/) evaluates the force in each iteration of Newton's method and for numerical derivatives,
and does not report to it which displacement was accepted. So the force is a trial step from the accepted state, and the function
before each step advances that state to the displacement to which the last step converged.
"""

from __future__ import annotations

import exudyn
import microslip
import numpy as np
from exudyn.itemInterface import (
    CoordinateSpringDamper,
    LoadCoordinate,
    MarkerNodeCoordinate,
    Mass1D,
    Node1D,
    NodePointGround,
)
from two_masses import CONTACT

MASS = 0.5  # kg
STIFFNESS = 2e7  # N/m, beside the contact
DAMPING = 200.0  # N s/m
STEP = 1e-5  # s


def load(t: float) -> float:
    """600 N at 1500 Hz, after a ramp of 10 ms."""
    return 600 * np.sin(2 * np.pi * 1500 * t) * min(1, t / 0.01)


def displacements(contact: microslip.Contact, steps: int) -> np.ndarray:
    """The displacement at the start of each step [m]."""
    mbs = exudyn.SystemContainer().AddSystem()
    state, accepted = microslip.State(), []
    node = mbs.AddNode(Node1D(referenceCoordinates=[0], initialCoordinates=[0.0], initialVelocities=[0.0]))
    mbs.AddObject(Mass1D(mass=MASS, nodeNumber=node))
    ground = mbs.AddNode(NodePointGround())
    markers = [mbs.AddMarker(MarkerNodeCoordinate(nodeNumber=number, coordinate=0)) for number in (ground, node)]

    def force(mbs, t, item, u, v, stiffness, damping, offset):
        return contact.update(state, u).force + stiffness * u + damping * v

    def before_step(mbs, t):
        nonlocal state
        accepted.append(float(np.squeeze(mbs.GetNodeOutput(node, exudyn.OutputVariableType.Coordinates))))
        state = contact.update(state, accepted[-1]).state
        return True

    mbs.AddObject(
        CoordinateSpringDamper(markerNumbers=markers, stiffness=STIFFNESS, damping=DAMPING, springForceUserFunction=force)
    )
    mbs.AddLoad(LoadCoordinate(markerNumber=markers[1], loadUserFunction=lambda mbs, t, amplitude: load(t)))
    mbs.SetPreStepUserFunction(before_step)
    mbs.Assemble()
    settings = exudyn.SimulationSettings()
    integration = settings.timeIntegration
    integration.numberOfSteps, integration.endTime, integration.verboseMode = steps, steps * STEP, 0
    integration.newton.useModifiedNewton = False
    integration.newton.relativeTolerance, integration.newton.absoluteTolerance = 1e-10, 1e-12
    # A difference over 1e-9 m is small against the displacement of gross slip, some micrometres.
    integration.newton.numericalDifferentiation.relativeEpsilon = 1e-9
    integration.generalizedAlpha.useNewmark, integration.generalizedAlpha.spectralRadius = True, 1
    settings.solution.file.write = False
    mbs.SolveDynamic(settings)
    return np.array(accepted)


if __name__ == "__main__":
    print(f"largest displacement: {1e6 * abs(displacements(microslip.Contact(**CONTACT), 3000)).max():.3f} um")
