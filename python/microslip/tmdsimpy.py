"""The law as a nonlinear force of tmdsimpy (github.com/tmd-lab/tmdsimpy).

    from microslip.tmdsimpy import MicroslipForce
    vibration_system.add_nl_force(MicroslipForce(Q, T, microslip.Contact(...)))

`Q` (local, N) gives the local displacements of the N degrees of freedom, `T` (N, local) the forces of the local ones. A
`microslip.Contact` has one local displacement, so each row of `Q` is a contact; a `microslip.Element` with `INPUT_APPROACH` has one
or two tangential ones and then the approach, so two or three rows are an element. `interference` is the approach [m] of the
undeformed structure.

Conventions. tmdsimpy orders harmonic coefficients by the harmonic, then by the degree of freedom: all c0, all cos1, all sin1, ...;
samples are `Nt` from t = 0; a positive force resists a positive displacement. Its hysteretic forces start unloaded at the mean
displacement, the library at displacement 0: with `unloaded_at_mean` (default) the tangential mean is left out, so that it has no
force, as for tmdsimpy's Jenkins element. The approach keeps its mean.
"""

from __future__ import annotations

from typing import Any

import microslip
import numpy as np

try:
    from tmdsimpy.nlforces.nonlinear_force import HystereticForce
except ImportError:  # the interface below is complete without the base class
    HystereticForce = object


class MicroslipForce(HystereticForce):
    """Contacts or elements of one law as a hysteretic force."""

    def __init__(
        self,
        Q: Any,
        T: Any,
        law: Any,
        interference: float = 0.0,
        unloaded_at_mean: bool = True,
    ) -> None:
        self.Q, self.T, self.law = np.asarray(Q, dtype=float), np.asarray(T, dtype=float), law
        if self.T.shape != self.Q.shape[::-1]:
            raise ValueError(f"T must have the shape {self.Q.shape[::-1]}, not {self.T.shape}")
        self.unloaded_at_mean = unloaded_at_mean
        self.is_element = isinstance(law, microslip.Element)
        if self.is_element and law.normal_input != microslip.INPUT_APPROACH:
            raise ValueError("the normal input of the element must be INPUT_APPROACH")
        self.components = law.directions + 1 if self.is_element else 1
        self.items, rest = divmod(self.Q.shape[0], self.components)
        if rest:
            raise ValueError(f"Q must have {self.components} rows for each element")
        self.array = microslip.ElementArray([law]) if self.is_element else microslip.ContactArray([law])
        self.index = np.zeros(self.items, dtype=np.int32)
        self.rest = np.zeros((self.items, self.components))
        if self.is_element:
            self.rest[:, -1] = interference
        self.workspaces: dict[tuple[int, int], Any] = {}
        self.init_history()

    def nl_force_type(self) -> int:
        return 1  # hysteretic

    def aft(
        self, U: Any, w: float, h: Any, Nt: int = 128, tol: float = 1e-7, calc_grad: bool = True, **others: Any
    ) -> tuple[Any, ...]:
        """Coefficients (N Nhc) of the forces, their derivatives (N Nhc, N Nhc), and those with respect to the frequency, 0."""
        h = np.asarray(h)
        highest = int(h.max())
        places = np.concatenate([[2 * k - 1, 2 * k] if k else [0] for k in h])
        n = self.Q.shape[1]  # degrees of freedom
        u = np.zeros((self.items, self.components, 2 * highest + 1))
        u[:, :, places] = (self.Q @ np.reshape(U, (-1, n)).T).reshape(self.items, self.components, -1)
        u[:, :, 0] += self.rest
        tangential = slice(None, -1) if self.is_element else slice(None)
        if self.unloaded_at_mean:
            u[:, tangential, 0] = 0
        if (highest, Nt) not in self.workspaces:
            self.workspaces[highest, Nt] = (
                microslip.ElementWorkspace(self.components - 1, highest, Nt)
                if self.is_element
                else microslip.Workspace(highest, Nt)
            )
        found = self.array.harmonic_force(
            self.workspaces[highest, Nt], u if self.is_element else u[:, 0], jacobian=calc_grad, index=self.index
        )
        force = found.force.reshape(u.shape)[:, :, places].reshape(self.Q.shape[0], -1)
        F = (self.T @ force).T.ravel()
        if not calc_grad:
            return (F,)
        shape = self.items, self.components, 2 * highest + 1
        jacobian = found.jacobian.reshape(*shape, *shape[1:]).copy()
        if self.unloaded_at_mean:
            jacobian[..., tangential, 0] = 0
        jacobian = jacobian[:, :, places][..., places]
        T = self.T.reshape(n, self.items, self.components)
        Q = self.Q.reshape(self.items, self.components, n)
        dFdU = np.einsum("xia,iakbl,iby->kxly", T, jacobian, Q).reshape(F.size, F.size)
        return F, dFdU, np.zeros(F.size)

    def init_history(self) -> None:
        """Unloaded contacts; open elements."""
        self.states = self.array.states(self.items)

    def force(self, X: Any, update_hist: bool = False) -> tuple[Any, Any]:
        """Forces (N) and derivatives (N, N) at displacements X (N) after the load history, which goes on from here if requested."""
        u = (self.Q @ X).reshape(self.items, self.components) + self.rest
        found = self.array.update(self.states, u if self.is_element else u[:, 0], index=self.index)
        force, slope = found[0].ravel(), found[1].reshape(self.items, self.components, self.components)
        if update_hist:
            self.states = found[3]
        T = self.T.reshape(self.Q.shape[1], self.items, self.components)
        Q = self.Q.reshape(self.items, self.components, self.Q.shape[1])
        return self.T @ force, np.einsum("xia,iab,iby->xy", T, slope, Q)
