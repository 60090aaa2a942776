"""States and workspaces: the arrays of doubles in which the C interface keeps load histories and tables."""

from __future__ import annotations

import threading
from typing import Any

import numpy as np

from ._core import Array, PlainData, check, ffi, lib, pointer


class _History(PlainData):
    """An array of doubles with the load history of a contact or an element."""

    array: Array

    def copy(self) -> Any:
        """An independent state with the same load history."""
        new = type(self).__new__(type(self))
        new.__dict__.update(self.__dict__, array=self.array.copy())
        return new

    def __bytes__(self) -> bytes:
        return self.array.tobytes()

    def __repr__(self) -> str:
        return f"<{type(self).__name__} of {len(self.array)} doubles>"


def _from_bytes(data: bytes) -> Array:
    return np.frombuffer(data, dtype=np.float64).copy()


class State(_History):
    """Load history of a contact under a constant normal force: unloaded at first.

    A state holds `reversals` nested reversals of the displacement exactly; those in excess are merged, with the error bound
    `force_error`. `array` are its doubles.
    """

    def __init__(self, reversals: int = 32) -> None:
        self.array = np.zeros(lib.mslip_state_length(reversals))
        check(lib.mslip_state_init(len(self.array), pointer(self.array)))

    @classmethod
    def from_bytes(cls, data: bytes) -> State:
        """The state of these bytes, validated in full; raises `Error` if it is invalid."""
        state = cls.__new__(cls)
        state.array = _from_bytes(data)
        check(lib.mslip_state_check(len(state.array), pointer(state.array)))
        return state

    @property
    def force_error(self) -> float:
        """Bound on the error [N] of the force due to merged reversals: 0 if none was merged since the last gross slip."""
        error = ffi.new("double *")
        check(lib.mslip_state_error(len(self.array), pointer(self.array), error))
        return float(error[0])


class ElementState(_History):
    """Load history of an element with 1 or 2 tangential `directions`: open at first, at zero displacement.

    With one direction it holds `pieces` pieces of the memory diagram exactly; those in excess are merged, with the error bound
    `force_error`. With two directions its length is fixed. `array` are its doubles.
    """

    def __init__(self, directions: int = 1, pieces: int = 32) -> None:
        self.directions = directions
        self.array = np.zeros(lib.mslip_element_state_length(directions, pieces))
        check(lib.mslip_element_state_init(directions, len(self.array), pointer(self.array)))

    def __reduce__(self) -> tuple[Any, ...]:
        return ElementState.from_bytes, (bytes(self), self.directions)

    @classmethod
    def from_bytes(cls, data: bytes, directions: int = 1) -> ElementState:
        """The state of these bytes, validated in full; raises `Error` if it is invalid."""
        state = cls.__new__(cls)
        state.directions, state.array = directions, _from_bytes(data)
        check(lib.mslip_element_state_check(directions, len(state.array), pointer(state.array)))
        return state

    @property
    def force_error(self) -> float:
        """Bound on the error [N] of the tangential force due to merged pieces: 0 if none was merged since gross slip."""
        error = ffi.new("double *")
        check(lib.mslip_element_state_error(self.directions, len(self.array), pointer(self.array), error))
        return float(error[0])


class _Workspace:
    """Tables and scratch memory of harmonic forces. Calls with one workspace wait for each other: use one per thread."""

    def __init__(self, length: int) -> None:
        self.array = np.zeros(length)
        self._pointer = pointer(self.array)
        self.lock = threading.Lock()

    def __repr__(self) -> str:
        return f"{type(self).__name__}{self.__reduce__()[1]}"


class Workspace(_Workspace):
    """Tables and scratch memory for harmonic forces of contacts, with `harmonics` H >= 1 and `samples` > 2H per period.

    `rule` is `UNIFORM_SAMPLING`, with an error that decreases as samples^-2, or `EVENT_DRIVEN`, Gauss-Legendre nodes between
    reversals, loop closures and the onset of gross slip: 16 (H+1) samples have an error below 1e-6 of mu N. Calls with one
    workspace wait for each other: use one per thread.
    """

    def __init__(self, harmonics: int, samples: int, rule: int = 0) -> None:
        super().__init__(lib.mslip_harmonic_workspace_length(harmonics, samples, rule))
        check(lib.mslip_harmonic_workspace_init(harmonics, samples, rule, len(self.array), self._pointer))
        sizes = ffi.new("size_t[2]")
        flag = ffi.new("int32_t *")
        check(lib.mslip_harmonic_workspace_size(self._pointer, sizes, sizes + 1, flag))
        self.harmonics, self.samples, self.rule = int(sizes[0]), int(sizes[1]), int(flag[0])

    def __reduce__(self) -> tuple[Any, ...]:
        return Workspace, (self.harmonics, self.samples, self.rule)


class ElementWorkspace(_Workspace):
    """Tables and scratch memory for harmonic forces of elements with 1 or 2 tangential `directions`.

    `harmonics` is H >= 1, `samples` > 2H per period, `rule` `UNIFORM_SAMPLING`. Calls with one workspace wait for each other:
    use one per thread.
    """

    def __init__(self, directions: int, harmonics: int, samples: int, rule: int = 0) -> None:
        super().__init__(lib.mslip_element_workspace_length(directions, harmonics, samples, rule))
        check(lib.mslip_element_workspace_init(directions, harmonics, samples, rule, len(self.array), self._pointer))
        sizes = ffi.new("size_t[2]")
        flags = ffi.new("int32_t[2]")
        check(lib.mslip_element_workspace_size(self._pointer, flags, sizes, sizes + 1, flags + 1))
        self.directions, self.rule = int(flags[0]), int(flags[1])
        self.harmonics, self.samples = int(sizes[0]), int(sizes[1])

    def __reduce__(self) -> tuple[Any, ...]:
        return ElementWorkspace, (self.directions, self.harmonics, self.samples, self.rule)
