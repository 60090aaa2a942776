"""Elements: contacts under a normal force that varies, with separation."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ._contact import HarmonicForce, Tractions, state_rows
from ._core import (
    Array,
    Error,
    Field,
    Status,
    Struct,
    Values,
    check,
    doubles,
    elliptic_parameters,
    ffi,
    flags,
    flat_parameters,
    lib,
    like,
    pointer,
    transposed,
    values,
)
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


class NormalApproach(NamedTuple):
    """Approach [m], compliance [m/N] and half-width [m]."""

    approach: Values
    compliance: Values
    half_width: Values


class Element(Struct):
    """A friction contact element: the law of a flat with rounded edges, or of a cylinder, under a varying normal force.

    With `directions` = 1 a displacement is [u, w] and a force [T, N]; with 2 they are [u, v, w] and [Tx, Ty, N]. The normal
    component w is the approach [m], open if w <= 0, with `normal_input` = `APPROACH`, or the normal force [N] with
    `NORMAL_FORCE`. `normal_force` > 0 is the largest force [N] for which the element is tabulated. The other parameters are those
    of `Contact`. The element of an elliptical contact is made by `Element.elliptic`.
    """

    _type = "mslip_element"

    composite_modulus = Field[float]("E*, Eq. 2 [Pa].")
    friction_coefficient = Field[float]("Coulomb's friction coefficient.")
    normal_force = Field[float]("The largest normal force that the tables cover [N]; larger ones are exact, but slower.")
    half_width = Field[float]("Half-width of the contact under that force [m]; elliptical: the semi-axis x.")
    approach = Field[float]("Normal approach under that force [m].")
    normal_stiffness = Field[float]("dN/d(approach) under that force [N/m].")
    tangential_stiffness = Field[float]("dT/d(displacement) of a fully stuck contact under that force, x direction [N/m].")
    directions = Field[int]("Number of tangential directions, 1 or 2.")
    normal_input = Field[int]("APPROACH or NORMAL_FORCE.")

    def __init__(
        self,
        *,
        flat_half_width: float,
        edge_radius: float,
        length: float,
        normal_force: float,
        friction_coefficient: float,
        young_modulus: float | tuple[float, float],
        poisson_ratio: float | tuple[float, float],
        displacement_reference: int = 0,
        directions: int = 1,
        normal_input: int = 0,
    ) -> None:
        p = flat_parameters(
            flat_half_width,
            edge_radius,
            length,
            normal_force,
            friction_coefficient,
            young_modulus,
            poisson_ratio,
            displacement_reference,
        )
        self._c = ffi.new("mslip_element *")
        check(lib.mslip_element_init(p, directions, normal_input, self._c))

    @classmethod
    def elliptic(
        cls,
        *,
        semi_axis_x: float,
        semi_axis_y: float,
        normal_force: float,
        friction_coefficient: float,
        young_modulus: float | tuple[float, float],
        poisson_ratio: float | tuple[float, float],
        directions: int = 1,
        normal_input: int = 0,
    ) -> Element:
        """The element of an elliptical Hertz contact that has these semi-axes [m] under `normal_force` [N]."""
        p = elliptic_parameters(semi_axis_x, semi_axis_y, normal_force, friction_coefficient, young_modulus, poisson_ratio)
        element = cls.__new__(cls)
        element._c = ffi.new("mslip_element *")
        check(lib.mslip_element_init_elliptic(p, directions, normal_input, element._c))
        return element

    def __repr__(self) -> str:
        return f"<Element: directions {self.directions}, normal_force {self.normal_force:.6g}>"

    def normal_force_at(self, approach: ArrayLike) -> NormalForce:
        """The normal law at approaches [m]: force [N], stiffness [N/m], half-width [m]; 0 where the contact is open."""
        approach = doubles(approach, "approach")
        out = like(approach, 3)
        check(lib.mslip_normal_force(self._c, approach.size, pointer(approach), *map(pointer, out)))
        return NormalForce(*values(out))

    def approach_at(self, normal_force: ArrayLike) -> NormalApproach:
        """The inverse normal law at normal forces >= 0 [N]: approach [m], compliance [m/N], half-width [m]."""
        normal_force = doubles(normal_force, "normal_force")
        out = like(normal_force, 3)
        check(lib.mslip_normal_approach(self._c, normal_force.size, pointer(normal_force), *map(pointer, out)))
        return NormalApproach(*values(out))

    def update(self, state: ElementState, displacement: ArrayLike, out: ElementState | None = None) -> ElementStep:
        """Advances a load history to displacement[m], or through displacement[n, m]: force [N], tangent [N/m] and dissipated
        energy [J] of each step, and the new state; m is directions + 1.

        `state` is left as it is. `out`, if given, receives the new state; it may be `state` itself.
        """
        m = self.directions + 1
        displacement = doubles(displacement, "displacement")
        if displacement.ndim not in (1, 2) or displacement.shape[-1] != m:
            raise ValueError(f"displacement must have the shape ({m},) or (n, {m}), not {displacement.shape}")
        new = state.copy() if out is None else out
        if len(new.array) != len(state.array):
            raise ValueError(f"out must have {len(state.array)} doubles as the state, not {len(new.array)}")
        steps = displacement.shape[:-1]
        force, tangent, dissipated = np.empty((*steps, m)), np.empty((*steps, m, m)), np.empty(steps)
        head = self._c, len(state.array), pointer(state.array)
        tail = map(pointer, (displacement, new.array, force, tangent, dissipated))
        if displacement.ndim == 1:
            check(lib.mslip_element_update(*head, *tail))
        else:
            check(lib.mslip_element_path(*head, *steps, *tail))
        return ElementStep(force, transposed(tangent), dissipated[()], new)

    def tractions(self, state: ElementState, x: ArrayLike) -> Tractions:
        """Pressure and shear traction [Pa] at `x` [m] along the width after a load history, for one tangential direction."""
        x = doubles(x, "x")
        out = like(x, 2)
        head = self._c, len(state.array), pointer(state.array)
        check(lib.mslip_element_tractions(*head, x.size, pointer(x), *map(pointer, out)))
        return Tractions(*values(out))

    def harmonic_force(self, workspace: ElementWorkspace, displacement: ArrayLike, jacobian: bool = True) -> HarmonicForce:
        """Harmonics of the forces in steady state (alternating frequency/time).

        Displacement and force have the shape (m, 2H+1), a row [c0, cos1, sin1, ...] for each component. jacobian[i, j] is
        d force.ravel()[i] / d displacement.ravel()[j], (m(2H+1), m(2H+1)), None if not requested. The element is pressed by the
        largest normal force of the period without a tangential displacement, then displaced.
        """
        shape = workspace.directions + 1, 2 * workspace.harmonics + 1
        displacement = doubles(displacement, "displacement", shape)
        force, dissipated = np.empty(shape), np.empty(())
        matrix = np.empty((force.size, force.size)) if jacobian else None
        arguments = pointer(displacement), pointer(force), pointer(matrix), pointer(dissipated)
        with workspace.lock:
            check(lib.mslip_element_harmonic_force(self._c, workspace._pointer, *arguments))
        return HarmonicForce(force, None if matrix is None else transposed(matrix), dissipated[()])


class ElementArray:
    """Elements of one number of tangential directions for calls with many items at once, contiguous in memory.

    Item i of a call uses element `index[i]`, or element i without `index`. Items with active[i] = 0 are skipped: their outputs
    are 0, their states unchanged.
    """

    def __init__(self, elements: Iterable[Element]) -> None:
        elements = list(elements)
        self.directions = elements[0].directions if elements else 1
        if any(element.directions != self.directions for element in elements):
            raise Error(Status.BAD_DIRECTIONS)
        self._c = ffi.new("mslip_element[]", len(elements))
        for i, element in enumerate(elements):
            self._c[i] = element._c[0]

    def __len__(self) -> int:
        return len(self._c)

    def __getitem__(self, i: int) -> Element:
        element = Element.__new__(Element)
        element._c = ffi.new("mslip_element *", self._c[range(len(self))[i]])
        return element

    def __iter__(self) -> Iterator[Element]:
        return (self[i] for i in range(len(self)))

    def __reduce__(self) -> tuple[Any, ...]:
        return ElementArray, (list(self),)

    def _head(self, n: int, index: ArrayLike | None, active: ArrayLike | None) -> tuple[Any, ...]:
        if index is None and n > len(self):
            raise ValueError(f"{n} items need an index: there are {len(self)} elements")
        chosen = pointer(flags(index, "index", n, "iu")), pointer(flags(active, "active", n, "biu"))
        return n, len(self), self._c, *chosen

    def states(self, n: int | None = None, pieces: int = 32) -> Array:
        """States of n open items (as many as elements by default), one per row."""
        return np.tile(ElementState(self.directions, pieces).array, (len(self) if n is None else n, 1))

    def update(
        self,
        states: Array,
        displacement: ArrayLike,
        *,
        index: ArrayLike | None = None,
        active: ArrayLike | None = None,
        out: Array | None = None,
    ) -> tuple[Array, Array, Array, Array]:
        """One step of n items from states[n, length] to displacement[n, m]: force[n, m] [N], tangent[n, m, m] [N/m],
        dissipated[n] [J], and the new states.

        `states` are left as they are. `out`, if given, receives the new states; it may be `states` itself.
        """
        m = self.directions + 1
        displacement = doubles(displacement, "displacement", (None, m))
        n = len(displacement)
        old, new = state_rows(states, out, n)
        force, tangent, dissipated = np.zeros((n, m)), np.zeros((n, m, m)), np.zeros(n)
        head = self._head(n, index, active)
        arrays = map(pointer, (old, displacement, new, force, tangent, dissipated))
        check(lib.mslip_batch_element_update(*head, old.shape[1], *arrays))
        return force, transposed(tangent), dissipated, new

    def harmonic_force(
        self,
        workspace: ElementWorkspace,
        displacement: ArrayLike,
        *,
        jacobian: bool = True,
        index: ArrayLike | None = None,
        active: ArrayLike | None = None,
    ) -> HarmonicForce:
        """`Element.harmonic_force` of n items: displacement, force (n, m, 2H+1), jacobian (n, m(2H+1), m(2H+1)), dissipated (n)."""
        shape = workspace.directions + 1, 2 * workspace.harmonics + 1
        displacement = doubles(displacement, "displacement", (None, *shape))
        n, size = len(displacement), shape[0] * shape[1]
        force, dissipated = np.zeros((n, *shape)), np.zeros(n)
        matrices = np.zeros((n, size, size)) if jacobian else None
        head = self._head(n, index, active)
        arguments = map(pointer, (displacement, force, matrices, dissipated))
        with workspace.lock:
            check(lib.mslip_batch_element_harmonic_force(*head, workspace._pointer, *arguments))
        return HarmonicForce(force, None if matrices is None else transposed(matrices), dissipated)
