"""Parameter files of the command line."""

from __future__ import annotations

import os
import sys
from pathlib import Path
from typing import Any

import numpy as np

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

# Factors from millimetres, newtons and megapascals.
_LENGTHS = ("flat_half_width", "edge_radius", "length", "semi_axis_x", "semi_axis_y")
_COMPLIANCES = ("normal_compliance", "tangential_compliance")
_FROM_MM = {"young_modulus": 1e6, **dict.fromkeys(_LENGTHS + _COMPLIANCES, 1e-3)}


def read_parameters(path: str | os.PathLike[str]) -> dict[str, Any]:
    """The arguments of `Contact`, or of `Contact.elliptic`, in a parameter file of the command line, such as `microslip fit
    --fitted fitted.toml` writes: `Contact(**read_parameters("fitted.toml"))`. In SI units, also of a file in millimetres.
    """
    if not isinstance(path, (str, os.PathLike)):
        raise TypeError(f"path must be a string or a path, not {type(path).__name__}")
    given = tomllib.loads(Path(path).read_text(encoding="utf-8"))
    bodies, units = given.pop("material", []), given.pop("units", "si")
    if units not in ("si", "mm"):
        raise ValueError(f"{path}: units must be 'si' or 'mm', not {units!r}")
    for name in ("young_modulus", "poisson_ratio"):
        values = [body[name] for body in bodies if name in body]
        if values:
            given[name] = values[0] if len(values) == 1 else values
    factors = _FROM_MM if units == "mm" else {}
    return {name: np.multiply(value, factors[name]).tolist() if name in factors else value for name, value in given.items()}
