"""What all calls of the C interface have in common: status codes, arrays, plain data."""

from __future__ import annotations

from enum import IntEnum
from typing import Any, Generic, TypeVar, cast, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._native import ffi, lib

Array = NDArray[np.float64]
Values = Any  # float64 of the shape of an argument; a NumPy scalar if that is one number, as of NumPy's own functions


class Status(IntEnum):
    """The status codes of the C interface: ``MSLIP_BAD_LENGTH`` is ``Status.BAD_LENGTH``."""

    # <generated: statuses>
    NULL_POINTER = 1
    BAD_FLAT_HALF_WIDTH = 2
    BAD_EDGE_RADIUS = 3
    BAD_LENGTH = 4
    BAD_NORMAL_FORCE = 5
    BAD_FRICTION_COEFFICIENT = 6
    BAD_YOUNG_MODULUS = 7
    BAD_POISSON_RATIO = 8
    BAD_DISPLACEMENT_REFERENCE = 9
    BAD_SEMI_AXIS_X = 10
    BAD_SEMI_AXIS_Y = 11
    LENGTH_TOO_SHORT = 12
    OUT_OF_RANGE = 13
    BAD_CONTACT = 20
    BAD_STATE = 21
    BAD_WORKSPACE = 22
    STATE_TOO_SHORT = 23
    BAD_ELEMENT = 24
    WORKSPACE_TOO_SHORT = 25
    BAD_TABLE = 26
    TABLE_TOO_SHORT = 27
    BAD_FORCE = 30
    FORCE_EXCEEDS_SLIP = 31
    BAD_DISPLACEMENT = 32
    BAD_POSITION = 33
    BAD_AMPLITUDE = 34
    BAD_FORCE_AMPLITUDE = 35
    BAD_HARMONICS = 36
    BAD_SAMPLES = 37
    BAD_COUNT = 38
    BAD_RULE = 39
    NOT_AVAILABLE = 40
    BAD_INDEX = 41
    BAD_DIRECTIONS = 42
    BAD_NORMAL_INPUT = 43
    BAD_ARRAY_SIZE = 90
    BAD_ALIGNMENT = 91
    # </generated>


class Parameter(IntEnum):
    """Columns of a sensitivity: the derivative with respect to this parameter."""

    # <generated: parameters>
    NORMAL_FORCE = 0
    FRICTION_COEFFICIENT = 1
    FLAT_HALF_WIDTH = 2
    EDGE_RADIUS = 3
    LENGTH = 4
    COMPOSITE_MODULUS = 5
    # </generated>


class Error(ValueError):
    """A call that the library rejected. The text is the message of the status code; no state has changed."""

    def __init__(self, status: int) -> None:
        super().__init__(status)
        self.status = Status(status)

    def __str__(self) -> str:
        return f"{status_text(self.status)} ({self.status.name})"


def status_text(status: int) -> str:
    """Message of a status code."""
    text: bytes = ffi.string(lib.mslip_status_text(status))
    return text.decode()


def check(status: int) -> None:
    if status:
        raise Error(status)


def doubles(values: ArrayLike, name: str, shape: tuple[int | None, ...] | None = None) -> Array:
    """`values` as a contiguous array of float64: itself if it is one, otherwise a converted copy.

    `shape`, if given, is the required one; None stands for any length.
    """
    array = np.asarray(values)
    if array.dtype != np.float64 or not (array.flags.c_contiguous and array.flags.aligned):
        if array.dtype.kind not in "fiu":
            raise TypeError(f"{name} must be real numbers, not {array.dtype}")
        array = np.require(array, np.float64, ("C", "A"))
    if shape is not None and not (array.ndim == len(shape) and all(n in (None, m) for m, n in zip(array.shape, shape))):
        required = ", ".join("n" if n is None else str(n) for n in shape)
        raise ValueError(f"{name} must have the shape ({required}), not {array.shape}")
    return array


def flags(values: ArrayLike | None, name: str, n: int, kinds: str) -> NDArray[np.int32] | None:
    """`values` as n int32, or None."""
    if values is None:
        return None
    array = np.asarray(values)
    if array.dtype.kind not in kinds:
        raise TypeError(f"{name} must be of type {' or '.join(kinds)}, not {array.dtype}")
    if array.shape != (n,):
        raise ValueError(f"{name} must have the shape ({n},), not {array.shape}")
    if array.size and not -(2**31) <= int(array.min()) <= int(array.max()) < 2**31:
        raise Error(Status.BAD_INDEX)
    return np.require(array, np.int32, ("C", "A"))


_DOUBLES = ffi.typeof("double[]")
_FLAGS = ffi.typeof("int32_t[]")


def pointer(array: NDArray[Any] | None) -> Any:
    """The memory of an array, without a copy; NULL for None."""
    if array is None:
        return ffi.NULL
    return ffi.from_buffer(_DOUBLES if array.dtype == np.float64 else _FLAGS, array)


def like(array: Array, count: int) -> list[Array]:
    """Uninitialised outputs of the shape of an input."""
    return [np.empty(array.shape) for _ in range(count)]


def values(arrays: list[Array]) -> list[Values]:
    """NumPy scalars instead of arrays without a dimension."""
    return [array[()] for array in arrays]


def transposed(buffer: Array) -> Array:
    """The matrices [..., i, j] of buffers in column-major order, as views."""
    return buffer.swapaxes(-1, -2)


class PlainData:
    """Memory of the C interface that is pickled, and validated in full when it is read."""

    def __bytes__(self) -> bytes:
        """The memory as it may be stored in a file or sent in a message; read it by `from_bytes`."""
        raise NotImplementedError

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self).from_bytes, (bytes(self),)

    @classmethod
    def from_bytes(cls, data: bytes) -> Any:
        raise NotImplementedError


class Struct(PlainData):
    """A contact or an element: initialised once, then only read."""

    _type: str
    _c: Any

    def __bytes__(self) -> bytes:
        return bytes(ffi.buffer(self._c))

    @classmethod
    def from_bytes(cls, data: bytes) -> Any:
        """The object of these bytes, validated in full; raises `Error` if it is invalid."""
        new = cls.__new__(cls)
        new._c = ffi.new(f"{cls._type} *")
        if len(data) != ffi.sizeof(cls._type):
            raise ValueError(f"a {cls.__name__} has {ffi.sizeof(cls._type)} bytes, not {len(data)}")
        ffi.memmove(new._c, data, len(data))
        check(getattr(lib, f"{cls._type}_check")(new._c))
        return new


T = TypeVar("T")


class Field(Generic[T]):
    """A field of a struct, to be read."""

    def __init__(self, doc: str) -> None:
        self.__doc__ = doc

    def __set_name__(self, owner: type, name: str) -> None:
        self._name = name

    @overload
    def __get__(self, instance: None, owner: type) -> Field[T]: ...
    @overload
    def __get__(self, instance: Struct, owner: type) -> T: ...
    def __get__(self, instance: Struct | None, owner: type) -> Field[T] | T:
        return self if instance is None else cast(T, getattr(instance._c, self._name))

    def __set__(self, instance: Struct, value: object) -> None:
        raise AttributeError(f"{self._name} can only be read")


def pair(value: float | tuple[float, float]) -> list[float]:
    """A property of the material of both bodies, from one number or two."""
    return [float(v) for v in np.broadcast_to(np.asarray(value, dtype=np.float64), 2)]


def flat_parameters(
    flat_half_width: float,
    edge_radius: float,
    length: float,
    normal_force: float,
    friction_coefficient: float,
    young_modulus: float | tuple[float, float],
    poisson_ratio: float | tuple[float, float],
    displacement_reference: int,
) -> Any:
    p = ffi.new("mslip_parameters *")
    lib.mslip_parameters_default(p)
    p.flat_half_width, p.edge_radius, p.length = flat_half_width, edge_radius, length
    p.normal_force, p.friction_coefficient = normal_force, friction_coefficient
    p.displacement_reference = displacement_reference
    p.material = list(zip(pair(young_modulus), pair(poisson_ratio)))
    return p


def elliptic_parameters(
    semi_axis_x: float,
    semi_axis_y: float,
    normal_force: float,
    friction_coefficient: float,
    young_modulus: float | tuple[float, float],
    poisson_ratio: float | tuple[float, float],
) -> Any:
    p = ffi.new("mslip_elliptic_parameters *")
    lib.mslip_elliptic_parameters_default(p)
    p.semi_axis_x, p.semi_axis_y = semi_axis_x, semi_axis_y
    p.normal_force, p.friction_coefficient = normal_force, friction_coefficient
    p.material = list(zip(pair(young_modulus), pair(poisson_ratio)))
    return p
