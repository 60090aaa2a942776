"""The law in a system of Exudyn (https://pypi.org/project/exudyn).

    contacts = microslip.exudyn.Contacts(mbs)
    contacts.add([ground, mass], microslip.Contact(...))

A contact is a CoordinateSpringDamper between two coordinate markers: its displacement is the second coordinate less the first one.

Exudyn evaluates a force in each iteration of Newton's method and for numerical derivatives, and does not report to it which
displacement was accepted. So the force is a trial step from the accepted state, and before each step of the time integration this
state is advanced to the displacement at which the last step ended. Differences for the numerical derivatives must be small against
the slip displacement: set `newton.numericalDifferentiation.relativeEpsilon` of the time integration to 1e-9 or so.
"""

from __future__ import annotations

from typing import Any

import exudyn
import microslip
from exudyn.itemInterface import CoordinateSpringDamper


class Contacts:
    """The contacts of a system. They take its function before each step; `before_step(mbs, t)` of the user is called by it."""

    def __init__(self, mbs: Any, before_step: Any = None) -> None:
        self.mbs, self.before_step = mbs, before_step
        self.contacts: dict[Any, tuple[microslip.Contact, microslip.State]] = {}
        mbs.SetPreStepUserFunction(self.accept)

    def accept(self, mbs: Any, t: float) -> bool:
        """Accept the last step. Call the function that was to be called before each step; without one, the simulation goes on."""
        for number, (contact, state) in self.contacts.items():
            displacement = float(mbs.GetObjectOutput(number, exudyn.OutputVariableType.Displacement))
            self.contacts[number] = contact, contact.update(state, displacement).state
        return bool(self.before_step(mbs, t)) if self.before_step else True

    def add(self, markers: list[Any], contact: microslip.Contact, stiffness: float = 0.0, damping: float = 0.0) -> Any:
        """Add a contact between two markers, with a spring and a damper beside it. Return the number of the object."""

        def force(mbs: Any, t: float, item: int, u: float, v: float, k: float, d: float, offset: float) -> float:
            return float(contact.update(self.contacts[number][1], u).force) + k * u + d * v

        connector = CoordinateSpringDamper(
            markerNumbers=markers, stiffness=stiffness, damping=damping, springForceUserFunction=force
        )
        number = self.mbs.AddObject(connector)
        self.contacts[number] = contact, microslip.State()
        return number
