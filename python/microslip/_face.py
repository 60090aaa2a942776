"""Faces with an uneven pressure, divided into parts."""

from __future__ import annotations

from collections.abc import Mapping
from inspect import signature
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ._contact import Contact
from ._core import Array, check, doubles, ffi, lib, pointer
from ._law import c_parameters


class FaceParts(NamedTuple):
    """Arguments of `Contact` or `Element` for each part, and weight[i, j] of pair j in part i."""

    parts: list[dict[str, Any]]
    weight: Array


def face_parts(parameters: Mapping[str, Any], area: ArrayLike, pressure: ArrayLike) -> FaceParts:
    """Divides a face along its length into parts, each with a normal force of its own, whose forces add up to that of the face.

    `parameters` are the arguments of `Contact` for the whole face. Their `normal_force` is not read, and may be missing: it is the
    sum of pressures times areas. A part is a row of pairs of opposite nodes in the direction of motion: `area[i, j]` [m^2] and
    `pressure[i, j]` [Pa] of pair j of part i; an area of 0 fills up a shorter row. The displacements of a part are the sums of
    those of its pairs times `weight`, and a pair carries its weight times the forces of the part. A part without load is open: its
    `normal_force` is 0, and it does not count in the length. For an `Element` set `normal_force`, the largest in its motion.
    """
    given = signature(Contact).bind(**{"normal_force": 0.0, **parameters})
    given.apply_defaults()
    whole, checked = c_parameters("mslip_parameters", given.arguments)
    areas = doubles(area, "area", (None, None))
    pressures = doubles(pressure, "pressure", areas.shape)
    parts, weight = ffi.new("mslip_parameters[]", len(areas)), np.empty(areas.shape)
    check(lib.mslip_face_parts(whole, *areas.shape, pointer(areas), pointer(pressures), parts, pointer(weight)))
    layer = [name for name, _ in ffi.typeof("mslip_layer").fields]

    def arguments(part: Any) -> dict[str, Any]:
        changed = {name: getattr(part, name) for name in ("length", "normal_force")}
        moduli = tuple(body.young_modulus for body in part.material)
        return checked | changed | {name: getattr(part.layer, name) for name in layer} | {"young_modulus": moduli}

    return FaceParts([arguments(part) for part in parts], weight)
