"""Reader of the reference tables in tests/golden: inputs are exact doubles, outputs have 25 digits. A contact for other tests."""

from __future__ import annotations

import csv
from itertools import groupby
from pathlib import Path
from typing import Any

import numpy as np

REPOSITORY = Path(__file__).resolve().parents[2]
HEADER = (REPOSITORY / "include" / "microslip.h").read_text()

# A flat of different bodies.
FLAT = {
    "flat_half_width": 0.5e-3,
    "edge_radius": 3e-3,
    "length": 20e-3,
    "normal_force": 800.0,
    "friction_coefficient": 0.5,
    "young_modulus": (2e11, 1.1e11),
    "poisson_ratio": 0.3,
    "displacement_reference": "centre_point",
}
MATERIAL = {name: FLAT[name] for name in ("normal_force", "friction_coefficient", "young_modulus", "poisson_ratio")}
ELLIPSE = {"semi_axis_x": 1e-3, "semi_axis_y": 2e-3, **MATERIAL}


def rows(name: str) -> list[dict[str, Any]]:
    """The rows of a reference table by the names of its columns; cells that are numbers as such."""

    def cell(text: str) -> Any:
        try:
            return float(text)
        except ValueError:
            return text.strip()

    with open(REPOSITORY / "tests" / "golden" / f"{name}.csv", newline="") as file:
        return [{key.strip(): cell(value) for key, value in row.items()} for row in csv.DictReader(file)]


def groups(name: str, *columns: str) -> list[list[dict[str, Any]]]:
    """Successive rows that are equal in some columns."""
    return [list(group) for _, group in groupby(rows(name), key=lambda row: [row[column] for column in columns])]


def column(group: list[dict[str, Any]], name: str) -> np.ndarray:
    """A column as numbers: NaN for a cell of text."""
    return np.array([row[name] if isinstance(row[name], float) else np.nan for row in group])


def flat(row: dict[str, Any], **others: float) -> dict[str, Any]:
    """Parameters of the flat with rounded edges in a row."""
    parameters = {"flat_half_width": row["a"], "edge_radius": row["R"], "length": row["L"], "displacement_reference": 0}
    if "E1" in row:
        parameters |= {"young_modulus": (row["E1"], row["E2"]), "poisson_ratio": (row["nu1"], row["nu2"])}
    else:
        parameters |= {"young_modulus": row["E"], "poisson_ratio": row["nu"]}
    return parameters | others


def differences(function: Any, x: np.ndarray, step: Any) -> np.ndarray:
    """Central differences: their error is of the second power of the step, and of the rounding error over the step."""
    steps = np.broadcast_to(step, x.shape).ravel()
    moves = [np.reshape(one, x.shape) for one in np.diag(steps)]
    change = [(function(x + d) - function(x - d)) / (2 * h) for d, h in zip(moves, steps)]
    return np.moveaxis(change, 0, -1).reshape(*np.shape(change[0]), *x.shape)
