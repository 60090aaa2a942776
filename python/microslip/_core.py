"""The arguments and values of all calls: one check for each kind of argument, which names it in messages, and errors."""

from __future__ import annotations

import operator
import reprlib
from typing import Any, Generic, TypeVar, Union, cast, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._constants import Status
from ._native import ffi, lib

Array = NDArray[np.float64]
Pair = Union[float, tuple[float, float]]  # a property of the material: of both bodies, or of each
Constant = Union[int, str]  # a constant of the C interface, by its number or its word
Shape = tuple[Union[int, None], ...]
Values = Any  # float64 of the shape of an argument; a NumPy scalar if that is one number, as of NumPy's own functions


# Constants by their words, in the order of the numbers.
REFERENCES = ("centre_point", "rigid_strip")
RULES = ("uniform_sampling", "event_driven")
NORMAL_INPUTS = ("approach", "normal_force")


class Error(ValueError):
    """A call that the library rejected. The text is the message of the status code; no state has changed. `item` is the first
    item at fault of a call for many items, None if the error is not the error of an item.
    """

    def __init__(self, status: int, item: int | None = None) -> None:
        super().__init__(status, item)
        self.status, self.item = Status(status), item

    def __str__(self) -> str:
        of_item = "" if self.item is None else f"item {self.item}: "
        return f"{of_item}{status_text(self.status)} ({self.status.name})"


def status_text(status: int) -> str:
    """Message of a status code."""
    text: bytes = ffi.string(lib.mslip_status_text(integer(status, "status")))
    return text.decode()


def check(status: int) -> None:
    if status:
        raise Error(status)


def call_batch(name: str, n: int, *arguments: Any) -> None:
    """Calls the function for n items."""
    failed_item = ffi.new("size_t *")
    status = getattr(lib, f"mslip_batch_{name}")(n, *arguments, failed_item)
    if status:
        raise Error(status, failed_item[0] if failed_item[0] < n else None)


T = TypeVar("T")


def instance(value: object, kind: type[T], name: str) -> T:
    """`value`, which must be of this type."""
    if not isinstance(value, kind):
        raise TypeError(f"{name} must be of type {kind.__name__}, not {type(value).__name__}")
    return value


def items(values: Any, kind: type[T], name: str) -> list[T]:
    """The items of an iterable, which must be of this type."""
    try:
        values = list(values)
    except TypeError:
        raise TypeError(f"{name} must be an iterable, not {type(values).__name__}") from None
    return [instance(value, kind, f"{name}[{i}]") for i, value in enumerate(values)]


def boolean(value: Any, name: str) -> bool:
    if not isinstance(value, (bool, np.bool_)):
        raise TypeError(f"{name} must be True or False, not {reprlib.repr(value)}")
    return bool(value)


def integer(value: Any, name: str, low: int = 0, high: int = 2**31 - 1) -> int:
    """An integer, of NumPy too, in a range that all counts and indices of the C interface hold."""
    try:
        if isinstance(value, (bool, np.bool_)):
            raise TypeError
        number = operator.index(value)
    except TypeError:
        raise TypeError(f"{name} must be an integer, not {type(value).__name__}") from None
    if not low <= number <= high:
        raise ValueError(f"{name} must be between {low} and {high}, not {number}")
    return number


def choice(value: Any, name: str, words: tuple[str, ...], first: int = 0) -> int:
    """The number of a constant that is given by its number or its word; the numbers count from `first`."""
    if isinstance(value, str) and value in words:
        return first + words.index(value)
    try:
        return integer(value, name, first, first + len(words) - 1)
    except (TypeError, ValueError) as reason:
        options = " or ".join(f"{word!r} ({i})" for i, word in enumerate(words, first))
        kind = ValueError if isinstance(value, str) else type(reason)
        raise kind(f"{name} must be {options}, not {reprlib.repr(value)}") from None


def _masked(values: Any) -> bool:
    if not isinstance(values, (list, tuple)):
        return isinstance(values, np.ma.MaskedArray)
    kinds = set(map(type, values))
    return any(issubclass(kind, (np.ma.MaskedArray, list, tuple)) for kind in kinds) and any(map(_masked, values))


def _array(values: Any, name: str, kinds: str, allowed: str) -> NDArray[Any]:
    """`values` as an array of one of these kinds of number."""
    if type(values) is not np.ndarray:
        if _masked(values):
            raise TypeError(f"{name} must not be masked: leave the masked values out, or fill them")
        try:
            array = np.asarray(values)
        except (TypeError, ValueError, OverflowError) as reason:
            raise ValueError(f"{name} must be {allowed}: {reason}") from None
    else:
        array = values
    if array.dtype.kind not in kinds and array.shape != (0,):
        raise TypeError(f"{name} must be {allowed}, not {array.dtype if array.ndim else type(values).__name__}")
    return array


def _described(shape: Shape) -> str:
    return "an array of shape " + str(tuple("n" if n is None else n for n in shape)).replace("'", "") if shape else "a number"


def doubles(values: ArrayLike, name: str, *shapes: Shape) -> Array:
    """`values` as a contiguous array of float64: itself if it is one, otherwise a converted copy.

    It must have one of the `shapes`, if any are given; None stands for any length.
    """
    array = _array(values, name, "fiu", "real numbers")
    if array.dtype != np.float64 or not (array.flags.c_contiguous and array.flags.aligned):
        with np.errstate(all="ignore"):  # too large a number is infinite
            array = np.require(array, np.float64, ("C", "A"))
    if shapes and array.shape not in shapes:
        if not any(len(s) == array.ndim and all(n in (None, m) for n, m in zip(s, array.shape)) for s in shapes):
            raise ValueError(f"{name} must be {' or '.join(map(_described, shapes))}, not {_described(array.shape)}")
    return array


def number(value: Any, name: str) -> float:
    return float(value) if type(value) is float else float(doubles(value, name, ()))


def pair(value: Any, name: str) -> list[float]:
    """A property of the material of both bodies, from one number or two."""
    values = doubles(value, name, (), (2,)).tolist()
    return values if isinstance(values, list) else [values, values]


def flags(values: ArrayLike | None, name: str, n: int, kinds: str, allowed: str) -> NDArray[np.int32] | None:
    """`values` as n int32, or None."""
    if values is None:
        return None
    array = _array(values, name, kinds, allowed)
    if array.shape != (n,):
        raise ValueError(f"{name} must be {_described((n,))}, not {_described(array.shape)}")
    if array.size and not -(2**31) <= int(array.min()) <= int(array.max()) < 2**31:
        raise Error(Status.BAD_INDEX)
    return np.require(array, np.int32, ("C", "A"))


def writable(array: Any, name: str, model: Array, of: str) -> Array:
    """An output that the caller provides, with the shape of an input."""
    instance(array, np.ndarray, name)
    if array.dtype != np.float64 or array.shape != model.shape or not array.flags.carray:
        read_only = "" if array.flags.writeable else ", which is read-only"
        raise ValueError(f"{name} must be a contiguous, writable array of float64 of shape {model.shape} as {of}{read_only}")
    return cast(Array, array)


def binary(data: Any, name: str) -> bytes:
    if not isinstance(data, (bytes, bytearray, memoryview)):
        raise TypeError(f"{name} must be bytes, not {type(data).__name__}")
    return bytes(data)


_DOUBLES = ffi.typeof("double[]")
_FLAGS = ffi.typeof("int32_t[]")


def pointer(array: NDArray[Any] | None) -> Any:
    """The memory of an array, without a copy; NULL for None."""
    if array is None:
        return ffi.NULL
    return ffi.from_buffer(_DOUBLES if array.dtype == np.float64 else _FLAGS, array)


R = TypeVar("R", bound=tuple[Any, ...])


def elementwise(result: type[R], call: Any, head: tuple[Any, ...], values: ArrayLike, name: str) -> R:
    """The outputs of a function of many numbers, each of their shape; a NumPy scalar if they are one number."""
    array = doubles(values, name)
    out = [np.empty(array.shape) for _ in result._fields]  # type: ignore[attr-defined]
    check(call(*head, array.size, *map(pointer, (array, *out))))
    return result(*(one[()] for one in out))


def transposed(buffer: Array) -> Array:
    """The matrices [..., i, j] of buffers in column-major order, as views."""
    return buffer.swapaxes(-1, -2)


class Value:
    """An object that equals those of its type with the same key: by default the memory that is stored in files or sent."""

    def _key(self) -> Any:
        return bytes(self)  # type: ignore[call-overload]

    def __setattr__(self, name: str, value: object) -> None:
        if not name.startswith("_"):
            raise AttributeError(f"{name} of a {type(self).__name__} can only be read: make another one")
        super().__setattr__(name, value)

    def __eq__(self, other: object) -> bool:
        return self._key() == other._key() if type(other) is type(self) else NotImplemented

    def __hash__(self) -> int:
        return hash((type(self), self._key()))


class Field(Generic[T]):
    """A value that can only be read: a field of `_values`."""

    def __init__(self, doc: str) -> None:
        self.__doc__ = doc

    def __set_name__(self, owner: type, name: str) -> None:
        self._name = name

    @overload
    def __get__(self, instance: None, owner: type) -> Field[T]: ...
    @overload
    def __get__(self, instance: Any, owner: type) -> T: ...
    def __get__(self, instance: Any, owner: type) -> Field[T] | T:
        return self if instance is None else cast(T, getattr(instance._values, self._name))
