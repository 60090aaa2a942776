"""Identification of the law from measured friction loops."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from types import SimpleNamespace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ._core import REFERENCES, Shape, choice, doubles, ffi, instance, items, lib

SHAPES = ("flat_half_width", "edge_radius", "fixed")
# The shapes of what a loop has; the fit rejects other keys.
_LIST: list[Shape] = [(None,)]
COLUMNS = {"displacement": _LIST, "force": _LIST, "time": _LIST, "normal_force": [(), *_LIST]}


class FitError(ValueError):
    """The data are no loops of friction, or do not suit the contact; the text names the measurement."""


def fit(
    loops: Iterable[tuple[ArrayLike, ArrayLike] | Mapping[str, Any]],
    contact: Mapping[str, Any],
    *,
    fixed: Mapping[str, float] | None = None,
    shape: str = "flat_half_width",
) -> Any:
    """Fits the friction coefficient, series compliance, contact compliance and shape to measured loops.

    Each loop is a pair displacement[n] [m], force[n] [N] with at least one cycle, or a mapping with the keys `displacement`,
    `force` and optionally `name`, `normal_force` (a number or n of them [N]) and `time`[n] [s]. `contact` has the
    parameters of `Contact` or `Contact.elliptic` by name; those that are fitted are start values. Samples with a value that is
    NaN or infinite are left out, at most 5 % of them, and messages count the samples before that.

    `fixed` gives values to `friction_coefficient`, `series_compliance` [m/N], `contact_compliance` (a factor on the displacements
    of the law) or `parallel_stiffness` [N/m], which are fitted otherwise. `shape` is the fitted parameter of the shape:
    "flat_half_width", "edge_radius" or "fixed".

    Returns a report: `friction_coefficient`, `series_compliance`, `series_stiffening` (of several loads: the share of the series
    stiffness that grows in proportion to the load), `contact_compliance`, `parallel_stiffness` (of a spring in parallel, seen only
    in a long plateau of gross slip), `total_compliance` and `shape` with `value`, `lower`, `upper` (95 % confidence) and `status`;
    `explanation`, with `explained`, whether the law explains the loops, and the `causes` if
    it does not; `law` and `spring_slider.misfit` with the misfits; the sentences `verdict` and `warnings`; `profile`,
    `contact_toml`, and the fitted `loops`. Raises `FitError`.
    """
    options = _numbers({} if fixed is None else _mapping(fixed, "fixed"), "fixed")
    if "shape" in options:
        raise FitError("shape is an argument of its own, not a key of fixed")
    options["shape"] = SHAPES[choice(shape, "shape", SHAPES)]
    problem = {"contact": _contact(contact), "loops": _loops(loops), "options": options}
    text = json.dumps(problem, allow_nan=False)
    answer = ffi.new("char **")
    status = lib.microslip_python_fit(text.encode(), answer)
    try:
        text = ffi.string(answer[0]).decode()
    finally:
        lib.microslip_python_free(answer[0])
    if status:
        raise FitError(text)
    return json.loads(text, object_hook=_namespace)


def _finite(values: Any, name: str, *shapes: Shape) -> Any:
    """A number, or a list of numbers."""
    array = doubles(values, name, *shapes)
    if not np.isfinite(array).all():
        raise FitError(f"{name} must be finite")
    return array.tolist()


def _samples(values: Any, name: str, *shapes: Shape) -> Any:
    """A list of numbers, of which those that are not finite are missing, or a finite number."""
    array = doubles(values, name, *shapes)
    if not array.ndim:
        return _finite(array, name, ())
    numbers = array.astype(object)
    numbers[~np.isfinite(array)] = None
    return numbers.tolist()


def _mapping(given: Any, name: str) -> dict[Any, Any]:
    if not isinstance(given, Mapping):
        raise TypeError(f"{name} must be a mapping, not {type(given).__name__}")
    return dict(given)


def _numbers(given: dict[Any, Any], name: str) -> dict[str, Any]:
    """Numbers by their keys, which the fit checks."""
    return {str(key): _finite(value, f"{key} of {name}", ()) for key, value in given.items()}


def _contact(contact: Mapping[str, Any]) -> dict[str, Any]:
    """The keys and values of a parameter file."""
    given = _mapping(contact, "contact")
    keys: dict[str, Any] = {}
    name = "displacement_reference"
    if name in given:
        keys[name] = REFERENCES[choice(given.pop(name), name, REFERENCES)]
    names = [name for name in ("young_modulus", "poisson_ratio") if name in given]
    pairs = {name: np.broadcast_to(_finite(given.pop(name), f"{name} of contact", (), (2,)), 2) for name in names}
    keys["material"] = [{name: float(values[body]) for name, values in pairs.items()} for body in (0, 1)]
    return keys | _numbers(given, "contact")


def _loops(loops: Iterable[Any]) -> list[dict[str, Any]]:
    return [_loop(loop, f"loops[{i}]") for i, loop in enumerate(items(loops, object, "loops"))]


def _loop(loop: Any, name: str) -> dict[str, Any]:
    if not isinstance(loop, Mapping):
        try:
            displacement, force = loop
        except (TypeError, ValueError):
            raise ValueError(f"{name} must be a pair of displacement and force, or a mapping") from None
        loop = {"displacement": displacement, "force": force}
    keys = {}
    for key, value in loop.items():
        if key == "name":
            keys[key] = instance(value, str, f"name of {name}").encode(errors="replace").decode()
        else:
            keys[str(key)] = _samples(value, f"{key} of {name}", *COLUMNS.get(key, ()))
    return keys


def _namespace(values: dict[str, Any]) -> SimpleNamespace:
    """An object of the report; its lists of numbers are arrays."""
    numbers = {key: doubles(v, key) for key, v in values.items() if isinstance(v, list) and v and isinstance(v[0], float)}
    return SimpleNamespace(**{**values, **numbers})
