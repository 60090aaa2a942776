"""What contacts and elements have in common, one of them or many: parameters, steps and harmonic forces."""

from __future__ import annotations

import warnings
from collections.abc import Iterable, Iterator, Mapping
from math import prod
from types import MappingProxyType
from typing import Any, ClassVar, Generic, NamedTuple, TypeVar

import numpy as np
from numpy.typing import ArrayLike

from ._core import (
    NORMAL_INPUTS,
    REFERENCES,
    Array,
    Value,
    Values,
    binary,
    boolean,
    call_batch,
    check,
    choice,
    doubles,
    ffi,
    flags,
    instance,
    integer,
    items,
    lib,
    number,
    pair,
    pointer,
    transposed,
    writable,
)
from ._memory import _History, _Workspace


class Tractions(NamedTuple):
    """Pressure and shear traction [Pa] along the width."""

    pressure: Values
    shear: Values


class HarmonicForce(NamedTuple):
    """Coefficients of the force [N], jacobian[..., i, j] = d force_i / d displacement_j [N/m] (None if not requested), energy
    dissipated per period [J] (of an element the work of the tangential force, at least 0), and drift: an estimate of the
    largest difference of the tangential force from the steady state, over mu times the largest normal force; 0 but for elements of
    two directions.
    """

    force: Array
    jacobian: Values
    dissipated: Values
    drift: Values


class PlausibilityWarning(UserWarning):
    """Parameters are valid but implausible: another unit, an exchanged pair, or a contact for which the model is inaccurate."""


def c_parameters(kind: str, given: Mapping[str, Any]) -> tuple[Any, dict[str, Any]]:
    """Parameters in C, and their checked values by name, from arguments that have the names of the fields."""
    parameters = ffi.new(f"{kind} *")
    getattr(lib, f"{kind}_default")(parameters)
    fields, layer = ([name for name, _ in ffi.typeof(one).fields] for one in (kind, "mslip_layer"))
    checked: dict[str, Any] = {}
    for name in [name for name in given if name in fields]:
        value = given[name]
        if name == "displacement_reference":
            checked[name] = choice(value, name, REFERENCES)
        else:
            checked[name] = number(value, name)
        setattr(parameters, name, checked[name])
    bodies = {name: tuple(pair(given[name], name)) for name in ("young_modulus", "poisson_ratio")}
    parameters.material = list(zip(*bodies.values()))
    for name in layer:
        checked[name] = number(given[name], name)
        setattr(parameters.layer, name, checked[name])
    return parameters, checked | bodies


class _Components(Value):
    @property
    def _components(self) -> tuple[int, ...]:
        """The shape of a displacement and of a force."""
        directions = getattr(self, "directions", 0)
        return (directions + 1,) if directions else ()


class _Law(_Components):
    """A contact or an element: initialised once, then only read.

    `_step`, `_path` and `_harmonic` are names of the functions of a step, of many steps and of the harmonic force, for one item and
    for many.
    """

    _type: ClassVar[str]
    _state: ClassVar[type[_History]]
    _workspace: ClassVar[type[_Workspace]]
    _step: ClassVar[str]
    _path: ClassVar[str]
    _harmonic: ClassVar[str]
    _c: Any
    _parameters: dict[str, Any]

    @property
    def _values(self) -> Any:
        return self._c

    @property
    def parameters(self) -> Mapping[str, Any]:
        """The arguments by name; each is an attribute too. Empty after `from_bytes`: the bytes do not contain them."""
        return MappingProxyType(self._parameters)

    def __getattr__(self, name: str) -> Any:
        try:
            return self.__dict__["_parameters"][name]
        except KeyError:
            raise AttributeError(f"{type(self).__name__} has no attribute {name!r}") from None

    def __repr__(self) -> str:
        if not self._parameters:
            return f"<{type(self).__name__} of {ffi.sizeof(self._type)} bytes>"
        words = {"displacement_reference": REFERENCES, "normal_input": (None,) * 16 + NORMAL_INPUTS}
        shown = {name: words[name][value] if name in words else value for name, value in self._parameters.items()}
        maker = type(self).__name__ + (".elliptic" if "semi_axis_x" in shown else "")
        return f"{maker}({', '.join(f'{name}={value!r}' for name, value in shown.items())})"

    @classmethod
    def _new(cls, parameters: dict[str, Any] | None = None) -> Any:
        new = cls.__new__(cls)
        new._c, new._parameters = ffi.new(f"{cls._type} *"), {} if parameters is None else parameters
        return new

    def _initialise(self, shape: str, given: dict[str, Any], *more: int) -> Any:
        """Of the `shape` "" or "_elliptic", with `given` arguments that have the names of the fields of the parameters."""
        kind = f"mslip{shape}_parameters"
        parameters, checked = c_parameters(kind, given)
        for i in range(2**31 - 1):
            text = getattr(lib, f"{kind}_warning")(parameters, i)
            if text == ffi.NULL:
                break
            warnings.warn(ffi.string(text).decode(), PlausibilityWarning, stacklevel=3)
        self._c = ffi.new(f"{self._type} *")
        check(getattr(lib, f"{self._type}_init{shape}")(parameters, *more, self._c))
        self._parameters = checked | dict(zip(("directions", "normal_input"), more))
        return self

    def __bytes__(self) -> bytes:
        """The memory as it may be stored in a file or sent in a message; read it by `from_bytes`."""
        return bytes(ffi.buffer(self._c))

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self)._read, (bytes(self), self._parameters)

    @classmethod
    def from_bytes(cls, data: bytes) -> Any:
        """The object of these bytes, validated in full; raises `Error` if it is invalid."""
        return cls._read(data, {})

    @classmethod
    def _read(cls, data: bytes, parameters: dict[str, Any]) -> Any:
        new, data = cls._new(parameters), binary(data, "data")
        if len(data) != ffi.sizeof(cls._type):
            raise ValueError(f"data of a {cls.__name__} must be {ffi.sizeof(cls._type)} bytes, not {len(data)}")
        ffi.memmove(new._c, data, len(data))
        check(getattr(lib, f"{cls._type}_check")(new._c))
        return new

    def _update(self, state: Any, displacement: ArrayLike, out: Any) -> tuple[Values, Values, Values, Any]:
        """Force, tangent in the order of C, energy and new state of a step or a path."""
        shape = self._components
        old = instance(state, self._state, "state")._doubles()
        displacement = doubles(displacement, "displacement", shape, (None, *shape))
        target = None if out is None else writable(instance(out, self._state, "out").array, "out", old, "state")
        # The library writes the used part only: the rest is that of the old state, so that equal steps make equal doubles.
        new = old.copy()
        steps = displacement.shape[: displacement.ndim - len(shape)]
        outputs = [np.empty(steps + shape), np.empty(steps + shape + shape), np.empty(steps)]
        head, tail = (self._c, old.size, pointer(old)), map(pointer, (new, *outputs))
        if steps:
            check(getattr(lib, f"mslip_{self._path}")(*head, *steps, pointer(displacement), *tail))
        else:
            check(getattr(lib, f"mslip_{self._step}")(*head, pointer(displacement) if shape else float(displacement), *tail))
        if target is None:
            out = state._with(new)
        else:
            target[:] = new
        force, tangent, dissipated = outputs
        return force[()], tangent[()], dissipated[()], out

    def _harmonic_force(self, workspace: Any, displacement: ArrayLike, jacobian: bool) -> HarmonicForce:
        shape = instance(workspace, self._workspace, "workspace")._shape
        displacement = doubles(displacement, "displacement", shape)
        return _harmonic_force(self._harmonic, [self._c], workspace, displacement, jacobian)


L = TypeVar("L", bound=_Law)


def _harmonic_force(name: str, head: list[Any], workspace: Any, displacement: Array, jacobian: bool) -> HarmonicForce:
    """The harmonic force of one displacement, or of one for each item."""
    shape = workspace._shape
    number_of_items = displacement.shape[: displacement.ndim - len(shape)]
    size = prod(shape)
    # Those of items that are skipped remain 0.
    force, dissipated, drift = np.zeros(displacement.shape), np.zeros(number_of_items), np.zeros(number_of_items)
    matrix = np.zeros((*number_of_items, size, size)) if boolean(jacobian, "jacobian") else None
    outputs = (force, matrix, dissipated, drift) if "element" in name else (force, matrix, dissipated)
    arguments = map(pointer, (displacement, *outputs))
    with workspace._lock:
        if number_of_items:
            call_batch(name, *number_of_items, *head, workspace._memory, *arguments)
        else:
            check(getattr(lib, f"mslip_{name}")(*head, workspace._memory, *arguments))
    return HarmonicForce(force, None if matrix is None else transposed(matrix), dissipated[()], drift[()])


class _LawArray(_Components, Generic[L]):
    """Items of one type, `_item`, for calls with many at once, contiguous in memory."""

    _item: type[L]

    def __init__(self, laws: Iterable[L], name: str) -> None:
        chosen = items(laws, self._item, name)
        self._c = ffi.new(f"{self._item._type}[]", len(chosen))
        for i, law in enumerate(chosen):
            self._c[i] = law._c[0]
        self._parameters = [law._parameters for law in chosen]

    def __len__(self) -> int:
        return len(self._c)

    def __getitem__(self, i: int) -> L:
        place = range(len(self))[integer(i, "i", -(2**31))]
        law = self._item._new(self._parameters[place])
        law._c[0] = self._c[place]
        return law

    def __iter__(self) -> Iterator[L]:
        return (self[i] for i in range(len(self)))

    def __repr__(self) -> str:
        return f"<{type(self).__name__} of {len(self)} {self._item.__name__.lower()}s>"

    def _key(self) -> Any:
        return bytes(ffi.buffer(self._c))

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (list(self),)

    def _head(self, n: int, index: ArrayLike | None, active: ArrayLike | None) -> list[Any]:
        if index is None and n > len(self):
            raise ValueError(f"{n} items need an index: there are {len(self)} {self._item.__name__.lower()}s")
        chosen = flags(index, "index", n, "iu", "integers"), flags(active, "active", n, "biu", "booleans or integers")
        return [len(self), self._c, *map(pointer, chosen)]

    def _states(self, n: int | None, state: _History) -> Array:
        return np.tile(state.array, (len(self) if n is None else integer(n, "n"), 1))

    def update(
        self,
        states: ArrayLike,
        displacement: ArrayLike,
        *,
        index: ArrayLike | None = None,
        active: ArrayLike | None = None,
        out: Array | None = None,
    ) -> tuple[Array, Array, Array, Array]:
        """One step of n items from states[n, length] to displacement[n], of elements displacement[n, m]: force of that shape [N],
        stiffness[n] or tangent[n, m, m] [N/m], dissipated[n] [J], and the new states.

        `states` are left as they are. `out`, if given, receives the new states; it may be `states` itself.
        """
        shape = self._components
        displacement = doubles(displacement, "displacement", (None, *shape))
        n = len(displacement)
        old = doubles(states, "states", (n, None))
        new = old.copy() if out is None else writable(out, "out", old, "states")
        for name, other in (("states", old), ("displacement", displacement)):
            if out is not None and new is not other and np.may_share_memory(new, other):
                raise ValueError(f"out must not overlap {name}")
        force, tangent, dissipated = np.zeros((n, *shape)), np.zeros((n, *shape, *shape)), np.zeros(n)
        arrays = map(pointer, (old, displacement, new, force, tangent, dissipated))
        call_batch(self._item._step, n, *self._head(n, index, active), old.shape[1], *arrays)
        return force, transposed(tangent) if shape else tangent, dissipated, new

    def harmonic_force(
        self,
        workspace: Any,
        displacement: ArrayLike,
        *,
        jacobian: bool = True,
        index: ArrayLike | None = None,
        active: ArrayLike | None = None,
    ) -> HarmonicForce:
        """The harmonic forces of n items: displacement and force (n, 2H+1), of elements (n, m, 2H+1), jacobian (n, size, size) for
        `size` coefficients of an item, dissipated and drift (n).
        """
        shape = instance(workspace, self._item._workspace, "workspace")._shape
        displacement = doubles(displacement, "displacement", (None, *shape))
        head = self._head(len(displacement), index, active)
        return _harmonic_force(self._item._harmonic, head, workspace, displacement, jacobian)
