"""States and workspaces: the arrays of doubles in which the C interface keeps load histories and the tables of harmonic forces."""

from __future__ import annotations

import os
import threading
import weakref
from types import SimpleNamespace
from typing import Any

import numpy as np

from ._core import RULES, Array, Constant, Field, Value, binary, check, choice, doubles, ffi, integer, lib, pointer


class _History(Value):
    """A load history in an array of doubles; `_head` are the arguments of all calls before it."""

    _calls: str
    _head: tuple[int, ...]
    _array: Array
    from_bytes: Any
    __hash__ = None  # type: ignore[assignment] # it changes

    def __init__(self, head: tuple[int, ...], capacity: int) -> None:
        self._head = head
        self._array = np.zeros(getattr(lib, f"{self._calls}_length")(*head, capacity))
        self._call("init")

    def _call(self, name: str, *more: Any) -> None:
        check(getattr(lib, f"{self._calls}_{name}")(*self._head, *self._arguments(), *more))

    def _doubles(self) -> Array:
        """The array as the library reads it, whatever was done to its form."""
        return doubles(self._array, "array")

    def _arguments(self) -> tuple[int, Any]:
        array = self._doubles()
        return array.size, pointer(array)

    def _with(self, array: Array) -> Any:
        new = type(self).__new__(type(self))
        new._head, new._array = self._head, array
        return new

    @property
    def array(self) -> Array:
        """The doubles."""
        return self._array

    @property
    def force_error(self) -> float:
        """Bound on the error [N] of the force due to merged reversals or pieces: 0 if none was merged since gross slip."""
        error = ffi.new("double *")
        self._call("error", error)
        return float(error[0])

    def copy(self) -> Any:
        """An independent state with the same load history."""
        return self._with(self._array.copy())

    def _key(self) -> Any:
        return self._head, bytes(self)

    def __bytes__(self) -> bytes:
        """The memory as it may be stored in a file or sent in a message; read it by `from_bytes`."""
        return self._array.tobytes()

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self).from_bytes, (bytes(self), *self._head)

    @classmethod
    def _read(cls, data: bytes, *head: int) -> Any:
        data = binary(data, "data")
        if len(data) % 8:
            raise ValueError(f"data of a {cls.__name__} must be a number of doubles, not {len(data)} bytes")
        state = cls.__new__(cls)
        state._head, state._array = head, np.frombuffer(data, dtype=np.float64).copy()
        state._call("check")
        return state

    def __repr__(self) -> str:
        return f"<{type(self).__name__} of {self._array.size} doubles>"


class State(_History):
    """Load history of a contact under a constant normal force: unloaded at first.

    A state holds `reversals` nested reversals of the displacement exactly; those in excess are merged, with the error bound
    `force_error`. `array` are its doubles. Equal states have equal doubles.
    """

    _calls = "mslip_state"

    def __init__(self, reversals: int = 32) -> None:
        super().__init__((), integer(reversals, "reversals"))

    @classmethod
    def from_bytes(cls, data: bytes) -> State:
        """The state of these bytes, validated in full; raises `Error` if it is invalid."""
        return cls._read(data)


class ElementState(_History):
    """Load history of an element with 1 or 2 tangential `directions`: open at first, at zero displacement.

    With one direction it holds `pieces` pieces of the memory diagram exactly; those in excess are merged, with the error bound
    `force_error`. With two directions its length is fixed. `array` are its doubles. Equal states have equal doubles.
    """

    _calls = "mslip_element_state"

    def __init__(self, directions: int = 1, pieces: int = 32) -> None:
        super().__init__((integer(directions, "directions"),), integer(pieces, "pieces"))

    @property
    def directions(self) -> int:
        """Number of tangential directions, 1 or 2."""
        return self._head[0]

    @classmethod
    def from_bytes(cls, data: bytes, directions: int = 1) -> ElementState:
        """The state of these bytes, validated in full; raises `Error` if it is invalid."""
        return cls._read(data, integer(directions, "directions"))


# By identity: equal workspaces are different memory.
_workspaces: weakref.WeakValueDictionary[int, _Workspace] = weakref.WeakValueDictionary()


def _unlock() -> None:
    """A thread that computes during a fork does not exist in the child."""
    for workspace in _workspaces.values():
        workspace._lock = threading.Lock()


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_unlock)


class _Workspace(Value):
    """Tables and scratch memory; `_values` are the fields, `_shape` is that of the coefficients."""

    _calls: str
    _shape: tuple[int, ...]
    harmonics = Field[int]("Number of harmonics H >= 1.")
    samples = Field[int]("Number of samples > 2H per period.")
    rule = Field[int]("UNIFORM_SAMPLING or EVENT_DRIVEN.")

    def __init__(self, **given: Any) -> None:
        arguments = {name: choice(value, name, RULES) if name == "rule" else integer(value, name) for name, value in given.items()}
        length = getattr(lib, f"{self._calls}_length")(*(arguments[name] for name in arguments if name != "periods"))
        self._memory = ffi.new("double[]", length)
        check(getattr(lib, f"{self._calls}_init")(*arguments.values(), length, self._memory))
        out = [ffi.new("int32_t *" if name in ("directions", "rule") else "size_t *") for name in given]
        check(getattr(lib, f"{self._calls}_size")(self._memory, *out))
        self._values = SimpleNamespace(**{name: int(value[0]) for name, value in zip(given, out)})
        self._shape = (2 * self.harmonics + 1,)
        self._lock = threading.Lock()
        _workspaces[id(self)] = self

    def _key(self) -> Any:
        return tuple(vars(self._values).values())

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), self._key()

    def __repr__(self) -> str:
        shown = {**vars(self._values), "rule": RULES[self.rule]}
        return f"{type(self).__name__}({', '.join(f'{name}={value!r}' for name, value in shown.items())})"


class Workspace(_Workspace):
    """Tables and scratch memory for harmonic forces of contacts, with `harmonics` H >= 1 and `samples` > 2H per period.

    `rule` is `UNIFORM_SAMPLING`, with an error that decreases as samples^-2, or `EVENT_DRIVEN`, Gauss-Legendre nodes between
    reversals, loop closures and the onset of gross slip: 16 (H+1) samples have an error below 2e-6 of mu N. Calls with one
    workspace wait for each other: use one per thread.
    """

    _calls = "mslip_harmonic_workspace"

    def __init__(self, harmonics: int, samples: int, rule: Constant = 0) -> None:
        super().__init__(harmonics=harmonics, samples=samples, rule=rule)


class ElementWorkspace(_Workspace):
    """Tables and scratch memory for harmonic forces of elements with 1 or 2 tangential `directions`.

    `harmonics` is H >= 1, `samples` > 2H per period, `rule` `UNIFORM_SAMPLING`. `periods`, at most 65536, are applied before
    the returned one; 0 is the default, 4 with two directions and 1 with one, where more change nothing. Calls with one workspace
    wait for each other: use one per thread.
    """

    _calls = "mslip_element_workspace"
    directions = Field[int]("Number of tangential directions, 1 or 2.")
    periods = Field[int]("Number of periods before the returned one.")

    def __init__(self, directions: int, harmonics: int, samples: int, rule: Constant = 0, periods: int = 0) -> None:
        super().__init__(directions=directions, harmonics=harmonics, samples=samples, rule=rule, periods=periods)
        self._shape = (self.directions + 1, *self._shape)
