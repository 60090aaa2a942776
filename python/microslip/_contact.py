"""Contacts under a constant normal force."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ._constants import Parameter
from ._core import (
    Array,
    Constant,
    Field,
    Pair,
    Values,
    call_batch,
    check,
    doubles,
    elementwise,
    ffi,
    instance,
    integer,
    lib,
    number,
    pointer,
    transposed,
)
from ._law import HarmonicForce, Tractions, _Law, _LawArray
from ._memory import State, Workspace


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


class Contact(_Law):
    """A contact under a constant normal force: a flat with rounded edges, or a cylinder if the flat has no width.

    Lengths in m, forces in N (totals), Young's modulus in Pa; any other consistent set of units will do. `young_modulus` and
    `poisson_ratio` are one number for both bodies or a pair. `displacement_reference` is `RIGID_STRIP`, corrected to
    three-dimensional contact mechanics, for the contact of a machine, or `CENTRE_POINT`, as in the paper; the words "rigid_strip"
    and "centre_point" will do too. An elliptical contact is made by `Contact.elliptic`. Contacts do not change, and are equal if
    their results are. `parameters` are the arguments, each an attribute too. Implausible ones give a `PlausibilityWarning`, which
    supposes m and Pa, or mm and MPa.

    `normal_compliance` and `tangential_compliance` [m/N] are those of a layer in series with the contact under `reference_load`
    [N],
    at which they were measured (0: `normal_force`). Its stiffness grows in proportion to N + `stiffening_load` [N]; 0: it is
    constant.
    """

    _type = "mslip_contact"
    _state, _workspace = State, Workspace
    _step, _path, _harmonic = "masing_update", "masing_path", "harmonic_force"

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
        young_modulus: Pair,
        poisson_ratio: Pair,
        displacement_reference: Constant,
        normal_compliance: float = 0.0,
        tangential_compliance: float = 0.0,
        stiffening_load: float = 0.0,
        reference_load: float = 0.0,
    ) -> None:
        self._initialise("", locals())

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
    ) -> Contact:
        """An elliptical Hertz contact, of these semi-axes [m] along and across the tangential force; a sphere if they are equal."""
        return cls._new()._initialise("_elliptic", locals())

    def tractions(self, load: float | State, x: ArrayLike) -> Tractions:
        """Pressure and shear traction [Pa] at `x` [m] along the width; 0 outside the contact.

        `load` is a monotonically increased force [N], |force| <= mu N, or the state after any load history.
        """
        if isinstance(load, State):
            return elementwise(Tractions, lib.mslip_masing_tractions, (self._c, *load._arguments()), x, "x")
        return elementwise(Tractions, lib.mslip_tractions, (self._c, number(load, "load")), x, "x")

    def slip(self, force: float, x: ArrayLike) -> Slip:
        """Relative slip [m] and damage parameter mu p |s| [N/m] at `x` [m] under a monotonically increased force [N]."""
        return elementwise(Slip, lib.mslip_slip, (self._c, number(force, "force")), x, "x")

    def monotonic_displacement(self, force: ArrayLike) -> MonotonicDisplacement:
        """Monotonic curve at forces [N], |force| <= mu N: displacement, compliance, stick half-width, of the shape of `force`."""
        return elementwise(MonotonicDisplacement, lib.mslip_monotonic_displacement, (self._c,), force, "force")

    def monotonic_force(self, displacement: ArrayLike) -> MonotonicForce:
        """Monotonic curve at displacements [m]: force, stiffness, stick half-width, each of the shape of `displacement`."""
        return elementwise(MonotonicForce, lib.mslip_monotonic_force, (self._c,), displacement, "displacement")

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
        return Step(*self._update(state, displacement, out))

    def hysteresis_loop(self, amplitude: float, n: int = 200) -> HysteresisLoop:
        """Displacement[n] [m] and force[n] [N] at n uniformly spaced instants of one period of amplitude cos(t), from t = 0."""
        displacement, force = np.empty(integer(n, "n")), np.empty(n)
        check(lib.mslip_hysteresis_loop(self._c, number(amplitude, "amplitude"), n, pointer(displacement), pointer(force)))
        return HysteresisLoop(displacement, force)

    def dissipated_energy(self, force_amplitude: ArrayLike) -> Values:
        """Energy [J] dissipated per cycle between +- `force_amplitude` [N], 0 to mu N; of the same shape."""
        force_amplitude = doubles(force_amplitude, "force_amplitude")
        energy = np.empty(force_amplitude.shape)
        check(lib.mslip_dissipated_energy(self._c, energy.size, pointer(force_amplitude), pointer(energy)))
        return energy[()]

    def complex_stiffness(self, amplitude: ArrayLike) -> ComplexStiffness:
        """Complex stiffness K' + iK'' [N/m] at amplitudes >= 0 of the displacement [m], and its derivatives by these."""
        return elementwise(ComplexStiffness, lib.mslip_complex_stiffness, (self._c,), amplitude, "amplitude")

    def harmonic_force(self, workspace: Workspace, displacement: ArrayLike, jacobian: bool = True) -> HarmonicForce:
        """Harmonics of the force in steady state, by the rule of the workspace (alternating frequency/time).

        `displacement` [m] and force [N] are coefficients [c0, cos1, sin1, ..., cosH, sinH]; jacobian[i, j] [N/m] is
        d force_i / d displacement_j, (2H+1, 2H+1), None if not requested. The contact is unloaded at displacement 0.
        """
        return self._harmonic_force(workspace, displacement, jacobian)

    def harmonic_sensitivity(self, workspace: Workspace, displacement: ArrayLike) -> Sensitivity:
        """Coefficients (2H+1) of the harmonic force [N], and their derivatives with respect to the parameters at fixed coefficients
        of the displacement [m]: sensitivity[i, p], p a `Parameter`.
        """
        shape = instance(workspace, Workspace, "workspace")._shape
        displacement = doubles(displacement, "displacement", shape)
        force, sensitivity = np.empty(shape), np.empty((len(Parameter), *shape))
        arrays = map(pointer, (displacement, force, sensitivity))
        with workspace._lock:
            check(lib.mslip_harmonic_sensitivity(self._c, workspace._memory, *arrays))
        return Sensitivity(force, transposed(sensitivity))

    def jenkins_equivalent(self, amplitude: float) -> Jenkins:
        """The Jenkins element (spring and slider) with the same K' and K'' at a displacement amplitude [m]."""
        out = ffi.new("double[2]")
        check(lib.mslip_jenkins_equivalent(self._c, number(amplitude, "amplitude"), out, out + 1))
        return Jenkins(out[0], out[1])

    def iwan_equivalent(self, n: int) -> Iwan:
        """n parallel Jenkins elements that approximate the monotonic curve with the smallest maximum error."""
        stiffness, slip_force, error = np.empty(integer(n, "n")), np.empty(n), ffi.new("double *")
        check(lib.mslip_iwan_equivalent(self._c, n, pointer(stiffness), pointer(slip_force), error))
        return Iwan(stiffness, slip_force, error[0])


class ContactArray(_LawArray[Contact]):
    """Contacts for calls with many items at once, contiguous in memory.

    Item i of a call uses contact `index[i]`, or contact i without `index`. Items with active[i] = 0 are skipped: their outputs
    are 0, their states unchanged.
    """

    _item = Contact

    def __init__(self, contacts: Iterable[Contact]) -> None:
        super().__init__(contacts, "contacts")

    def states(self, n: int | None = None, reversals: int = 32) -> Array:
        """Unloaded states of n items (as many as contacts by default), one per row; `State(reversals)` is one of them."""
        return self._states(n, State(reversals))

    def complex_stiffness(
        self, amplitude: ArrayLike, *, index: ArrayLike | None = None, active: ArrayLike | None = None
    ) -> ComplexStiffness:
        """Complex stiffness [N/m] and its derivatives of n items at amplitude[n] [m]."""
        amplitude = doubles(amplitude, "amplitude", (None,))
        out = [np.zeros(len(amplitude)) for _ in range(4)]
        n = len(amplitude)
        call_batch("complex_stiffness", n, *self._head(n, index, active), pointer(amplitude), *map(pointer, out))
        return ComplexStiffness(*out)
