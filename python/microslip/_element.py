"""Elements: contacts under a normal force that varies, with separation."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ._constants import Status
from ._core import (
    NORMAL_INPUTS,
    Array,
    Constant,
    Error,
    Field,
    Pair,
    Values,
    check,
    choice,
    doubles,
    elementwise,
    instance,
    integer,
    lib,
    pointer,
    transposed,
)
from ._law import HarmonicForce, Tractions, _Law, _LawArray
from ._memory import ElementState, ElementWorkspace


class ElementStep(NamedTuple):
    """Force [..., m] [N], tangent[..., i, j] = d force_i / d displacement_j [N/m], dissipated energy [J], and the new state."""

    force: Array
    tangent: Array
    dissipated: Values
    state: ElementState


class NormalForce(NamedTuple):
    """Normal force [N], normal stiffness [N/m] and half-width [m]."""

    normal_force: Values
    stiffness: Values
    half_width: Values


class StaticDisplacement(NamedTuple):
    """Displacement [m] and compliance [m/N] at a constant normal force."""

    displacement: Values
    compliance: Values


class NormalApproach(NamedTuple):
    """Approach [m], compliance [m/N] and half-width [m]."""

    approach: Values
    compliance: Values
    half_width: Values


class Element(_Law):
    """A friction contact element: the law of a flat with rounded edges, or of a cylinder, under a varying normal force.

    With `directions` = 1 a displacement is [u, w] and a force [T, N]; with 2 they are [u, v, w] and [Tx, Ty, N]. The normal
    component w is the approach [m], open if w <= 0, with `normal_input` = `INPUT_APPROACH`, or the normal force [N] with
    `INPUT_NORMAL_FORCE`. `normal_force` > 0 is the largest force [N] for which the element is tabulated. The other
    parameters are those of `Contact`. The element of an elliptical contact is made by `Element.elliptic`.
    """

    _type = "mslip_element"
    _state, _workspace = ElementState, ElementWorkspace
    _step, _path, _harmonic = "element_update", "element_path", "element_harmonic_force"

    composite_modulus = Field[float]("E*, Eq. 2 [Pa].")
    friction_coefficient = Field[float]("Coulomb's friction coefficient.")
    normal_force = Field[float]("The largest normal force that the tables cover [N]; larger ones are exact, but slower.")
    half_width = Field[float]("Half-width of the contact under that force [m]; elliptical: the semi-axis x.")
    approach = Field[float]("Normal approach under that force [m].")
    normal_stiffness = Field[float]("dN/d(approach) under that force [N/m].")
    tangential_stiffness = Field[float]("dT/d(displacement) of a fully stuck contact under that force, x direction [N/m].")
    directions = Field[int]("Number of tangential directions, 1 or 2.")
    normal_input = Field[int]("INPUT_APPROACH or INPUT_NORMAL_FORCE.")

    def __init__(
        self,
        *,
        flat_half_width: float,
        edge_radius: float,
        length: float,
        normal_force: float,
        friction_coefficient: float,
        young_modulus: Pair,
        poisson_ratio: Pair,
        displacement_reference: Constant,
        normal_compliance: float = 0.0,
        tangential_compliance: float = 0.0,
        stiffening_load: float = 0.0,
        reference_load: float = 0.0,
        directions: int = 1,
        normal_input: Constant = 16,
    ) -> None:
        more = integer(directions, "directions"), choice(normal_input, "normal_input", NORMAL_INPUTS, 16)
        self._initialise("", locals(), *more)

    @classmethod
    def elliptic(
        cls,
        *,
        semi_axis_x: float,
        semi_axis_y: float,
        normal_force: float,
        friction_coefficient: float,
        young_modulus: Pair,
        poisson_ratio: Pair,
        normal_compliance: float = 0.0,
        tangential_compliance: float = 0.0,
        stiffening_load: float = 0.0,
        reference_load: float = 0.0,
        directions: int = 1,
        normal_input: Constant = 16,
    ) -> Element:
        """The element of an elliptical Hertz contact that has these semi-axes [m] under `normal_force` [N]."""
        more = integer(directions, "directions"), choice(normal_input, "normal_input", NORMAL_INPUTS, 16)
        return cls._new()._initialise("_elliptic", locals(), *more)

    def normal_force_at(self, approach: ArrayLike) -> NormalForce:
        """The normal law at approaches [m]: force [N], stiffness [N/m], half-width [m]; 0 where the contact is open."""
        return elementwise(NormalForce, lib.mslip_normal_force, (self._c,), approach, "approach")

    def approach_at(self, normal_force: ArrayLike) -> NormalApproach:
        """The inverse normal law at normal forces >= 0 [N]: approach [m], compliance [m/N], half-width [m]."""
        return elementwise(NormalApproach, lib.mslip_normal_approach, (self._c,), normal_force, "normal_force")

    def displacement_at(self, force: ArrayLike, normal_force: ArrayLike, direction: int = 0) -> StaticDisplacement:
        """The monotonic curve at constant normal forces [N]: the displacement [m] that carries each force [N], at most mu N, in
        the direction x (0) or y (1), and the compliance [m/N]. `force` and `normal_force` are broadcast.
        """
        given = doubles(force, "force"), doubles(normal_force, "normal_force")
        try:
            shape = np.broadcast_shapes(*(one.shape for one in given))
        except ValueError:
            raise ValueError(f"force of shape {given[0].shape} and normal_force of {given[1].shape} do not broadcast") from None
        both = [np.broadcast_to(one, shape).copy() for one in given]
        out = [np.empty(shape), np.empty(shape)]
        head = self._c, integer(direction, "direction"), out[0].size
        check(lib.mslip_element_displacement(*head, *map(pointer, (*both, *out))))
        return StaticDisplacement(*(one[()] for one in out))

    def update(self, state: ElementState, displacement: ArrayLike, out: ElementState | None = None) -> ElementStep:
        """Advances a load history to displacement[m], or through displacement[n, m]: force [N], tangent [N/m] and dissipated
        energy [J] of each step, and the new state; m is directions + 1.

        `state` is left as it is. `out`, if given, receives the new state; it may be `state` itself.
        """
        force, tangent, dissipated, new = self._update(state, displacement, out)
        return ElementStep(force, transposed(tangent), dissipated[()], new)

    def tractions(self, state: ElementState, x: ArrayLike) -> Tractions:
        """Pressure and shear traction [Pa] at `x` [m] along the width after a load history, for one tangential direction."""
        head = self._c, *instance(state, ElementState, "state")._arguments()
        return elementwise(Tractions, lib.mslip_element_tractions, head, x, "x")

    def harmonic_force(self, workspace: ElementWorkspace, displacement: ArrayLike, jacobian: bool = True) -> HarmonicForce:
        """Harmonics of the forces in steady state (alternating frequency/time).

        Displacement and force have the shape (m, 2H+1), a row [c0, cos1, sin1, ...] for each component. jacobian[i, j] is
        d force.ravel()[i] / d displacement.ravel()[j], (m(2H+1), m(2H+1)), None if not requested. The element is pressed by the
        largest normal force of the period without a tangential displacement, then displaced. It advances through the periods of the
        workspace and one more, which is returned. With two directions a vibration across a mean tangential force reduces that force
        over many periods: `drift` estimates how far the returned period is from the steady state, over mu times the largest N.
        """
        return self._harmonic_force(workspace, displacement, jacobian)


class ElementArray(_LawArray[Element]):
    """Elements of one number of tangential directions for calls with many items at once, contiguous in memory.

    Item i of a call uses element `index[i]`, or element i without `index`. Items with active[i] = 0 are skipped: their outputs
    are 0, their states unchanged.
    """

    _item = Element

    def __init__(self, elements: Iterable[Element]) -> None:
        super().__init__(elements, "elements")
        if len({self._c[i].directions for i in range(len(self))}) > 1:
            raise Error(Status.BAD_DIRECTIONS)

    @property
    def directions(self) -> int:
        """Number of tangential directions, 1 or 2."""
        return int(self._c[0].directions) if len(self) else 1

    def states(self, n: int | None = None, pieces: int = 32) -> Array:
        """States of n open items (as many as elements by default), one per row."""
        return self._states(n, ElementState(self.directions, pieces))
