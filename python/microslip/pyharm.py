"""The law as an element of pyHarm (pyHarm-os 1.2), which is its extension "microslip".

    pyHarm.extension.load("microslip")
    Maestro({"connectors": {"contact": {"type": "microslip", "law": microslip.Contact(...), ...}}, ...})

An entry of `connectors` has, beside pyHarm's `connect` (first node against the second one, or against the ground) and
`coordinatesystem`:

- `law`: a `microslip.Contact`, or a `microslip.Element` with `INPUT_APPROACH`;
- `dirs`: the tangential direction of a contact; one or two tangential directions and then the normal one of an element. The
  normal direction points into the second node: a positive relative displacement is an approach;
- `interference` (elements): approach of the undeformed structure [m]; a gap is negative.

Conventions. Coefficients are those of the library, [c0, cos1, sin1, ...], and the samples those of the system, `nti` from t = 0.
pyHarm's own Jenkins element starts unloaded at displacement 0, as the library does: so a mean displacement loads the contact.
"""

from __future__ import annotations

from typing import Any

import microslip
import numpy as np
from pyHarm.DynamicOperator import get_array_nh
from pyHarm.Elements.NodeToNodeElements.NodeToNodeElement import NodeToNodeElement


def register() -> list[type]:
    """The elements of the extension."""
    return [Microslip]


class Microslip(NodeToNodeElement):
    """A contact or a friction contact element between two nodes."""

    factory_keyword = "microslip"

    def __post_init__(self) -> None:
        self.law = self.data["law"]
        self.known = b""
        harmonics, *_ = get_array_nh(self.nh)
        highest = int(harmonics.max())
        # The places of pyHarm's coefficients among all from 0 to the highest harmonic.
        places = np.concatenate([[2 * k - 1, 2 * k] if k else [0] for k in harmonics])
        size = 2 * highest + 1
        self.shape: tuple[int, ...] = (size,)
        self.workspace: Any
        if isinstance(self.law, microslip.Element):
            if self.law.normal_input != microslip.INPUT_APPROACH:
                raise ValueError(f"{self.name}: the normal input of the element must be INPUT_APPROACH")
            self.shape = (self.law.directions + 1, size)
            self.workspace = microslip.ElementWorkspace(self.law.directions, highest, self.nti)
        else:
            self.workspace = microslip.Workspace(highest, self.nti)
        self.rest = np.zeros(np.prod(self.shape))
        self.rest[-size] = self.data.get("interference", 0.0)
        self.components = len(self.rest) // size
        self.places = np.concatenate([places + size * i for i in range(self.components)])

    def __flag_update__(self) -> None:
        self.flag_nonlinear = True
        self.flag_AFT = True

    def generateIndices(self, expl_dofs: Any) -> None:
        super().generateIndices(expl_dofs)
        if len(self.Pdir) != self.components:
            raise ValueError(f"{self.name}: {self.components} dirs are required, not {len(self.Pdir)}")
        # The coefficients of the relative displacement from the unknowns of both nodes.
        self.relative = np.zeros((len(self.rest), len(self.indices)))
        self.relative[self.places] = np.vstack([direction @ (self.Pslave - self.Pmaster) for direction in self.Pdir])
        self.motion, self.by_frequency = self.relative, np.zeros(len(self.indices))

    def adim(self, lc: float, wc: float) -> None:
        self.motion = lc * self.relative
        self.flag_adim = True

    def evaluate(self, xg: Any) -> None:
        """Force and Jacobian; the residual and the Jacobian of one point are one evaluation."""
        x = xg[self.indices]
        if self.known != (known := x.tobytes()):
            found = self.law.harmonic_force(self.workspace, (self.rest + self.motion @ x).reshape(self.shape))
            self.R = found.force.ravel() @ self.relative
            self.J = self.relative.T @ found.jacobian @ self.motion
            self.known = known

    def evalResidual(self, xg: Any, om: float) -> Any:
        self.evaluate(xg)
        return self.R

    def evalJacobian(self, xg: Any, om: float) -> Any:
        self.evaluate(xg)
        self.dJdom = self.by_frequency
        return self.J, self.dJdom
