"""Contacts under a constant normal force."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ._core import (
    Array,
    Field,
    Parameter,
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
from ._memory import State, Workspace


class Tractions(NamedTuple):
    """Pressure and shear traction [Pa] along the width."""

    pressure: Values
    shear: Values


class Slip(NamedTuple):
    """Relative slip [m] and frictional damage parameter [N/m] along the width."""

    slip: Values
    damage: Values


class MonotonicDisplacement(NamedTuple):
    """Displacement [m], compliance [m/N] and stick half-width [m]."""

    displacement: Values
    compliance: Values
    stick_half_width: Values


class MonotonicForce(NamedTuple):
    """Force [N], stiffness [N/m] and stick half-width [m]."""

    force: Values
    stiffness: Values
    stick_half_width: Values


class Step(NamedTuple):
    """Force [N], tangent stiffness [N/m], energy dissipated in each step [J], and the new state."""

    force: Values
    stiffness: Values
    dissipated: Values
    state: State


class HysteresisLoop(NamedTuple):
    """Displacement [m] and force [N] of a closed loop."""

    displacement: Array
    force: Array


class ComplexStiffness(NamedTuple):
    """K' and K'' [N/m] and their derivatives with respect to the amplitude [N/m^2]."""

    k_real: Values
    k_imag: Values
    dk_real: Values
    dk_imag: Values


class HarmonicForce(NamedTuple):
    """Coefficients of the force [N], jacobian[..., i, j] = d force_i / d displacement_j [N/m] (None if not requested), energy
    dissipated per period [J].
    """

    force: Array
    jacobian: Values
    dissipated: Values


class Sensitivity(NamedTuple):
    """Force [N] and its derivatives, sensitivity[..., p] with respect to parameter p, in [N] over the unit of the parameter."""

    force: Values
    sensitivity: Array


class Jenkins(NamedTuple):
    """Stiffness [N/m] and slip force [N] of a Jenkins element."""

    stiffness: float
    slip_force: float


class Iwan(NamedTuple):
    """Stiffness[n] [N/m] and slip force[n] [N] of parallel Jenkins elements; error of the force over mu N."""

    stiffness: Array
    slip_force: Array
    force_error: float


class Contact(Struct):
    """A contact under a constant normal force: a flat with rounded edges, or a cylinder if the flat has no width.

    Lengths in m, forces in N (totals), Young's modulus in Pa; any other consistent set of units will do. `young_modulus` and
    `poisson_ratio` are one number for both bodies or a pair. `displacement_reference` is `CENTRE_POINT`, as in the paper, or
    `RIGID_STRIP`, corrected to three-dimensional contact mechanics. An elliptical contact is made by `Contact.elliptic`.
    """

    _type = "mslip_contact"

    composite_modulus = Field[float]("E*, Eq. 2 [Pa].")
    half_width = Field[float]("Half-width b of the contact under its normal force [m]; elliptical: semi_axis_x.")
    slip_force = Field[float]("mu N [N].")
    slip_displacement = Field[float]("Displacement at the onset of gross slip on the monotonic curve [m].")
    initial_stiffness = Field[float]("Tangent stiffness at zero displacement [N/m].")
    slip_energy = Field[float]("Energy dissipated per cycle at incipient gross slip [J].")

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
        self._c = ffi.new("mslip_contact *")
        check(lib.mslip_contact_init(p, self._c))

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
    ) -> Contact:
        """An elliptical Hertz contact, of these semi-axes [m] along and across the tangential force; a sphere if they are equal."""
        p = elliptic_parameters(semi_axis_x, semi_axis_y, normal_force, friction_coefficient, young_modulus, poisson_ratio)
        contact = cls.__new__(cls)
        contact._c = ffi.new("mslip_contact *")
        check(lib.mslip_contact_init_elliptic(p, contact._c))
        return contact

    def __repr__(self) -> str:
        return f"<Contact: slip_force {self.slip_force:.6g}, slip_displacement {self.slip_displacement:.6g}>"

    def tractions(self, load: float | State, x: ArrayLike) -> Tractions:
        """Pressure and shear traction [Pa] at `x` [m] along the width; 0 outside the contact.

        `load` is a monotonically increased force [N], |force| <= mu N, or the state after any load history.
        """
        x = doubles(x, "x")
        pressure, shear = out = like(x, 2)
        outputs = pointer(pressure), pointer(shear)
        if isinstance(load, State):
            length = len(load.array)
            check(lib.mslip_masing_tractions(self._c, length, pointer(load.array), x.size, pointer(x), *outputs))
        else:
            check(lib.mslip_tractions(self._c, load, x.size, pointer(x), *outputs))
        return Tractions(*values(out))

    def slip(self, force: float, x: ArrayLike) -> Slip:
        """Relative slip [m] and damage parameter mu p |s| [N/m] at `x` [m] under a monotonically increased force [N]."""
        x = doubles(x, "x")
        slip, damage = out = like(x, 2)
        check(lib.mslip_slip(self._c, force, x.size, pointer(x), pointer(slip), pointer(damage)))
        return Slip(*values(out))

    def monotonic_displacement(self, force: ArrayLike) -> MonotonicDisplacement:
        """Monotonic curve at forces [N], |force| <= mu N: displacement, compliance, stick half-width, of the shape of `force`."""
        force = doubles(force, "force")
        out = like(force, 3)
        check(lib.mslip_monotonic_displacement(self._c, force.size, pointer(force), *map(pointer, out)))
        return MonotonicDisplacement(*values(out))

    def monotonic_force(self, displacement: ArrayLike) -> MonotonicForce:
        """Monotonic curve at displacements [m]: force, stiffness, stick half-width, each of the shape of `displacement`."""
        displacement = doubles(displacement, "displacement")
        out = like(displacement, 3)
        check(lib.mslip_monotonic_force(self._c, displacement.size, pointer(displacement), *map(pointer, out)))
        return MonotonicForce(*values(out))

    def monotonic_sensitivity(self, displacement: ArrayLike) -> Sensitivity:
        """Force [N] of the monotonic curve at displacements [m], and its derivatives with respect to the parameters at fixed
        displacements: sensitivity[..., p], p a `Parameter`. The modulus stands for both Young's moduli in a fixed ratio.
        """
        displacement = doubles(displacement, "displacement")
        force, sensitivity = np.empty(displacement.shape), np.empty((*displacement.shape, len(Parameter)))
        arrays = map(pointer, (displacement, force, sensitivity))
        check(lib.mslip_monotonic_sensitivity(self._c, displacement.size, *arrays))
        return Sensitivity(force[()], sensitivity)

    def update(self, state: State, displacement: ArrayLike, out: State | None = None) -> Step:
        """Advances a load history to a displacement [m], or through n displacements: the force [N], tangent stiffness [N/m] and
        dissipated energy [J] of each step, and the new state.

        `state` is left as it is. `out`, if given, receives the new state; it may be `state` itself.
        """
        displacement = doubles(displacement, "displacement")
        new = state.copy() if out is None else out
        if len(new.array) != len(state.array):
            raise ValueError(f"out must have {len(state.array)} doubles as the state, not {len(new.array)}")
        arrays = like(displacement, 3)
        head = self._c, len(state.array), pointer(state.array)
        tail = pointer(new.array), *map(pointer, arrays)
        if displacement.ndim == 0:
            check(lib.mslip_masing_update(*head, float(displacement), *tail))
        elif displacement.ndim == 1:
            check(lib.mslip_masing_path(*head, len(displacement), pointer(displacement), *tail))
        else:
            raise ValueError(f"displacement must be a number or have one dimension, not {displacement.ndim}")
        force, stiffness, dissipated = values(arrays)
        return Step(force, stiffness, dissipated, new)

    def hysteresis_loop(self, amplitude: float, n: int = 200) -> HysteresisLoop:
        """Displacement[n] [m] and force[n] [N] at n uniformly spaced instants of one period of amplitude cos(t), from t = 0."""
        displacement, force = np.empty(n), np.empty(n)
        check(lib.mslip_hysteresis_loop(self._c, amplitude, n, pointer(displacement), pointer(force)))
        return HysteresisLoop(displacement, force)

    def dissipated_energy(self, force_amplitude: ArrayLike) -> Values:
        """Energy [J] dissipated per cycle between +- `force_amplitude` [N], 0 to mu N; of the same shape."""
        force_amplitude = doubles(force_amplitude, "force_amplitude")
        energy = np.empty(force_amplitude.shape)
        check(lib.mslip_dissipated_energy(self._c, energy.size, pointer(force_amplitude), pointer(energy)))
        return energy[()]

    def complex_stiffness(self, amplitude: ArrayLike, table: StiffnessTable | None = None) -> ComplexStiffness:
        """Complex stiffness K' + iK'' [N/m] at displacement amplitudes >= 0 [m], and its derivatives with respect to the amplitude.

        With a `StiffnessTable` of the contact's shape a few polynomials for each amplitude, with errors of 1e-13 of |K|.
        """
        amplitude = doubles(amplitude, "amplitude")
        out = like(amplitude, 4)
        arguments = amplitude.size, pointer(amplitude), *map(pointer, out)
        if table is None:
            check(lib.mslip_complex_stiffness(self._c, *arguments))
        else:
            check(lib.mslip_complex_stiffness_tabulated(self._c, pointer(table.array), *arguments))
        return ComplexStiffness(*values(out))

    def harmonic_force(self, workspace: Workspace, displacement: ArrayLike, jacobian: bool = True) -> HarmonicForce:
        """Harmonics of the force in steady state, by the rule of the workspace (alternating frequency/time).

        `displacement` [m] and force [N] are coefficients [c0, cos1, sin1, ..., cosH, sinH]; jacobian[i, j] [N/m] is
        d force_i / d displacement_j, (2H+1, 2H+1), None if not requested. The contact is unloaded at displacement 0.
        """
        size = 2 * workspace.harmonics + 1
        displacement = doubles(displacement, "displacement", (size,))
        force, dissipated = np.empty(size), np.empty(())
        matrix = np.empty((size, size)) if jacobian else None
        arguments = pointer(displacement), pointer(force), pointer(matrix), pointer(dissipated)
        with workspace.lock:
            check(lib.mslip_harmonic_force(self._c, workspace._pointer, *arguments))
        return HarmonicForce(force, None if matrix is None else transposed(matrix), dissipated[()])

    def harmonic_sensitivity(self, workspace: Workspace, displacement: ArrayLike) -> Sensitivity:
        """Coefficients (2H+1) of the harmonic force [N], and their derivatives with respect to the parameters at fixed coefficients
        of the displacement [m]: sensitivity[i, p], p a `Parameter`.
        """
        size = 2 * workspace.harmonics + 1
        displacement = doubles(displacement, "displacement", (size,))
        force, sensitivity = np.empty(size), np.empty((len(Parameter), size))
        arrays = map(pointer, (displacement, force, sensitivity))
        with workspace.lock:
            check(lib.mslip_harmonic_sensitivity(self._c, workspace._pointer, *arrays))
        return Sensitivity(force, transposed(sensitivity))

    def jenkins_equivalent(self, amplitude: float) -> Jenkins:
        """The Jenkins element (spring and slider) with the same K' and K'' at a displacement amplitude [m]."""
        out = ffi.new("double[2]")
        check(lib.mslip_jenkins_equivalent(self._c, amplitude, out, out + 1))
        return Jenkins(out[0], out[1])

    def iwan_equivalent(self, n: int) -> Iwan:
        """n parallel Jenkins elements that approximate the monotonic curve with the smallest maximum error."""
        stiffness, slip_force, error = np.empty(n), np.empty(n), ffi.new("double *")
        check(lib.mslip_iwan_equivalent(self._c, n, pointer(stiffness), pointer(slip_force), error))
        return Iwan(stiffness, slip_force, error[0])


class StiffnessTable:
    """Table of the complex stiffness of all contacts of a shape: those that differ in friction coefficient or scale share it.

    2L/b, a/b and Poisson's ratios are the shape of a line contact; that of all elliptic contacts is the same. A table is pickled
    as its contact, and made again.
    """

    def __init__(self, contact: Contact) -> None:
        self._contact = contact
        self.array = np.zeros(lib.mslip_stiffness_table_length())
        check(lib.mslip_stiffness_table_init(contact._c, len(self.array), pointer(self.array)))

    def __reduce__(self) -> tuple[Any, ...]:
        return StiffnessTable, (self._contact,)


class ContactArray:
    """Contacts for calls with many items at once, contiguous in memory.

    Item i of a call uses contact `index[i]`, or contact i without `index`. Items with active[i] = 0 are skipped: their outputs
    are 0, their states unchanged.
    """

    def __init__(self, contacts: Iterable[Contact]) -> None:
        contacts = list(contacts)
        self._c = ffi.new("mslip_contact[]", len(contacts))
        for i, contact in enumerate(contacts):
            self._c[i] = contact._c[0]

    def __len__(self) -> int:
        return len(self._c)

    def __getitem__(self, i: int) -> Contact:
        contact = Contact.__new__(Contact)
        contact._c = ffi.new("mslip_contact *", self._c[range(len(self))[i]])
        return contact

    def __iter__(self) -> Iterator[Contact]:
        return (self[i] for i in range(len(self)))

    def __reduce__(self) -> tuple[Any, ...]:
        return ContactArray, (list(self),)

    def _head(self, n: int, index: ArrayLike | None, active: ArrayLike | None) -> tuple[Any, ...]:
        if index is None and n > len(self):
            raise ValueError(f"{n} items need an index: there are {len(self)} contacts")
        chosen = pointer(flags(index, "index", n, "iu")), pointer(flags(active, "active", n, "biu"))
        return n, len(self), self._c, *chosen

    def states(self, n: int | None = None, reversals: int = 32) -> Array:
        """Unloaded states of n items (as many as contacts by default), one per row; `State(reversals)` is one of them."""
        return np.tile(State(reversals).array, (len(self) if n is None else n, 1))

    def complex_stiffness(
        self, amplitude: ArrayLike, *, index: ArrayLike | None = None, active: ArrayLike | None = None
    ) -> ComplexStiffness:
        """Complex stiffness [N/m] and its derivatives of n items at amplitude[n] [m]."""
        amplitude = doubles(amplitude, "amplitude", (None,))
        out = [np.zeros(len(amplitude)) for _ in range(4)]
        head = self._head(len(amplitude), index, active)
        check(lib.mslip_batch_complex_stiffness(*head, pointer(amplitude), *map(pointer, out)))
        return ComplexStiffness(*out)

    def update(
        self,
        states: Array,
        displacement: ArrayLike,
        *,
        index: ArrayLike | None = None,
        active: ArrayLike | None = None,
        out: Array | None = None,
    ) -> tuple[Array, Array, Array, Array]:
        """One step of n items from states[n, length] to displacement[n] [m]: force[n] [N], stiffness[n] [N/m],
        dissipated[n] [J], and the new states.

        `states` are left as they are. `out`, if given, receives the new states; it may be `states` itself.
        """
        displacement = doubles(displacement, "displacement", (None,))
        n = len(displacement)
        old, new = state_rows(states, out, n)
        results = [np.zeros(n) for _ in range(3)]
        head = self._head(n, index, active)
        tail = pointer(new), *map(pointer, results)
        check(lib.mslip_batch_masing_update(*head, old.shape[1], pointer(old), pointer(displacement), *tail))
        return results[0], results[1], results[2], new

    def harmonic_force(
        self,
        workspace: Workspace,
        displacement: ArrayLike,
        *,
        jacobian: bool = True,
        index: ArrayLike | None = None,
        active: ArrayLike | None = None,
    ) -> HarmonicForce:
        """`Contact.harmonic_force` of n items: displacement and force (n, 2H+1), jacobian (n, 2H+1, 2H+1), dissipated (n)."""
        size = 2 * workspace.harmonics + 1
        displacement = doubles(displacement, "displacement", (None, size))
        n = len(displacement)
        force, dissipated = np.zeros((n, size)), np.zeros(n)
        matrices = np.zeros((n, size, size)) if jacobian else None
        head = self._head(n, index, active)
        arguments = map(pointer, (displacement, force, matrices, dissipated))
        with workspace.lock:
            check(lib.mslip_batch_harmonic_force(*head, workspace._pointer, *arguments))
        return HarmonicForce(force, None if matrices is None else transposed(matrices), dissipated)


def state_rows(states: Array, out: Array | None, n: int) -> tuple[Array, Array]:
    """The old and the new states of a batch."""
    old = doubles(states, "states", (n, None))
    if out is None:
        return old, old.copy()
    if out.dtype != np.float64 or out.shape != old.shape or not out.flags.carray:
        raise ValueError(f"out must be a contiguous, writable array of float64 of shape {old.shape}")
    return old, out
