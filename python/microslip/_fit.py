"""Identification of the law from measured friction loops."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from types import SimpleNamespace
from typing import Any

from numpy.typing import ArrayLike

from ._core import doubles, ffi, lib, pair

REFERENCES = ("centre_point", "rigid_strip")


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
    parameters of `Contact` or `Contact.elliptic` by name; those that are fitted are start values.

    `fixed` gives values to `friction_coefficient`, `series_compliance` [m/N] or `contact_compliance` (a factor on the displacements
    of the law), which are fitted otherwise. `shape` is the fitted parameter of the shape: "flat_half_width", "edge_radius" or
    "fixed".

    Returns a report: `friction_coefficient`, `series_compliance`, `contact_compliance`, `total_compliance` and `shape` with
    `value`, `lower`, `upper` (95 % confidence) and `status`; `explanation`, with `explained`, whether the law explains the loops,
    and the `causes` if it does not; `law` and `spring_slider.misfit` with the misfits; the sentences `verdict` and `warnings`;
    `profile`, `contact_toml`, and the fitted `loops`. Raises `FitError`.
    """
    given = dict(contact)
    reference = REFERENCES[given.pop("displacement_reference", 0)]
    materials = zip(pair(given.pop("young_modulus")), pair(given.pop("poisson_ratio")))
    problem = {
        "contact": {
            **{name: float(value) for name, value in given.items()},
            "material": [{"young_modulus": modulus, "poisson_ratio": ratio} for modulus, ratio in materials],
            "displacement_reference": reference,
        },
        "loops": [_loop(loop) for loop in loops],
        "options": {"shape": shape, **{name: float(value) for name, value in (fixed or {}).items()}},
    }
    try:
        text = json.dumps(problem, allow_nan=False)
    except ValueError:
        raise FitError("all numbers must be finite") from None
    answer = ffi.new("char **")
    status = lib.microslip_python_fit(text.encode(), answer)
    try:
        text = ffi.string(answer[0]).decode()
    finally:
        lib.microslip_python_free(answer[0])
    if status:
        raise FitError(text)
    return json.loads(text, object_hook=_namespace)


def _loop(loop: tuple[ArrayLike, ArrayLike] | Mapping[str, Any]) -> dict[str, Any]:
    named = dict(loop) if isinstance(loop, Mapping) else dict(zip(("displacement", "force"), loop))
    return {key: value if isinstance(value, str) else doubles(value, key).tolist() for key, value in named.items()}


def _namespace(values: dict[str, Any]) -> SimpleNamespace:
    """An object of the report; its lists of numbers are arrays."""
    numbers = {key: doubles(v, key) for key, v in values.items() if isinstance(v, list) and v and isinstance(v[0], float)}
    return SimpleNamespace(**{**values, **numbers})
