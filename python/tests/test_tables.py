"""The reference tables of elements through Python, with layers and without, and some rows of those of contacts, which C reads.

Tolerances of the normal law and of histories under a varying load are the promised errors.
"""

from __future__ import annotations

import microslip
import numpy as np
import pytest
from numpy.testing import assert_allclose
from tables import column, flat, groups, rows

CLOSE = 1e-12

CONTACTS = [microslip.Contact(**flat(row, normal_force=row["N"], friction_coefficient=row["mu"])) for row in rows("contacts")]


@pytest.mark.parametrize(
    ("name", "columns", "call", "outputs"),
    [
        (
            "monotonic",
            ["contact"],
            lambda c, g: c.monotonic_displacement(column(g, "T")),
            ["displacement", "compliance", "stick_half_width"],
        ),
        ("monotonic_inverse", ["contact"], lambda c, g: c.monotonic_force(column(g, "displacement")), ["force"]),
        (
            "complex_stiffness",
            ["contact"],
            lambda c, g: c.complex_stiffness(column(g, "amplitude")),
            ["k_real", "k_imag", "dk_real", "dk_imag"],
        ),
        ("tractions", ["contact", "T"], lambda c, g: c.tractions(g[0]["T"], column(g, "x")), ["pressure", "shear"]),
        ("slip", ["contact", "T"], lambda c, g: c.slip(g[0]["T"], column(g, "x")), ["slip", "damage"]),
    ],
)
def test_outputs_are_in_their_places(name, columns, call, outputs):
    group = groups(name, *columns)[1]
    found = call(CONTACTS[int(group[0]["contact"])], group)
    for output in outputs:
        expected = column(group, "T" if output == "force" else output)
        known = np.isfinite(expected)
        assert known.any()
        assert_allclose(getattr(found, output)[known], expected[known], rtol=1e-6, atol=1e-6 * abs(expected[known]).max())


@pytest.mark.parametrize("group", groups("histories", "history")[:3])
def test_histories(group):
    contact = CONTACTS[int(group[0]["contact"])]
    start = microslip.State(64)
    path = contact.update(start, column(group, "displacement"))
    assert_allclose(path.force, column(group, "T"), rtol=0, atol=CLOSE * contact.slip_force)
    # Step by step, new states and in place, bit for bit.
    functional, in_place = start, start.copy()
    for i, displacement in enumerate(column(group, "displacement")):
        step = contact.update(functional, displacement)
        assert step.state is not functional
        functional = step.state
        same = contact.update(in_place, displacement, out=in_place)
        assert same.state is in_place
        assert step[:3] == same[:3] == (path.force[i], path.stiffness[i], path.dissipated[i])
    assert (functional.array == path.state.array).all()
    assert (in_place.array == path.state.array).all()
    assert functional.force_error == 0
    assert (start.array == microslip.State(64).array).all()


LAYER = {"c_n": "normal_compliance", "c_t": "tangential_compliance", "N_c": "stiffening_load", "N_layer": "reference_load"}


def element_of(row, largest, by_force):
    """For loads up to this one, or for smaller ones if that is too large for the length, or for N_c."""
    common = {name: row[key] for key, name in LAYER.items() if key in row}
    common |= {"friction_coefficient": row.get("mu", 0.5), "normal_input": "normal_force" if by_force else "approach"}
    largest = min(largest, 999 * row.get("N_c", np.inf))
    if np.isnan(row["a"]):
        # The semi-axes are those under N_ref.
        semi_axes = {f"semi_axis_{x}": np.cbrt(largest / row["N_ref"]) * row[f"semi_{x}"] for x in "xy"}
        material = {"young_modulus": (row["E1"], row["E2"]), "poisson_ratio": (row["nu1"], row["nu2"])}
        return microslip.Element.elliptic(**semi_axes, **material, normal_force=largest, **common)
    while True:
        try:
            return microslip.Element(**flat(row, normal_force=largest), **common)
        except microslip.Error as error:
            if error.status != microslip.Status.LENGTH_TOO_SHORT:
                raise
            largest /= 4


@pytest.mark.parametrize("group", groups("normal_law", "contact") + groups("layer_normal_law", "contact"))
@pytest.mark.parametrize("by_force", [False, True])
@pytest.mark.filterwarnings("ignore::microslip.PlausibilityWarning")
def test_normal_law(group, by_force):
    for row, factor in ((row, factor) for row in group for factor in (1, 1e6, 1e-3)):
        # With a layer the singularities are closer to the pieces of the tables.
        slope = 1e-12 if "c_n" in row else 1e-13
        element = element_of(row, factor * row["N"], by_force)
        at_force, at_approach = element.approach_at(row["N"]), element.normal_force_at(row["u_n"])
        assert at_force.approach == pytest.approx(row["u_n"], rel=1e-14)
        assert at_approach.normal_force == pytest.approx(row["N"], rel=1e-14)
        assert at_force.compliance == pytest.approx(1 / row["dN_dun"], rel=slope)
        assert at_approach.stiffness == pytest.approx(row["dN_dun"], rel=slope)
        assert at_force.half_width == pytest.approx(row["size"], rel=1e-14)
        assert at_approach.half_width == pytest.approx(row["size"], rel=1e-14)


@pytest.mark.parametrize("group", groups("varying_load", "history") + groups("layer_varying_load", "history"))
@pytest.mark.parametrize("factor", [1, 1e6, 1e-3, 0])
@pytest.mark.filterwarnings("ignore::microslip.PlausibilityWarning")
def test_varying_load(group, factor):
    """With the tables of a multiple of the largest load; for 0, with the other normal input, which is rounded."""
    by_force = (group[0]["control"] == "N") != (factor == 0)
    load, u = column(group, "N"), column(group, "delta")
    if factor == 0 and load.min() <= 0:
        return
    largest = load.max()
    element, scale = (element_of(group[0], (one or 1) * largest, by_force) for one in (factor, 1))
    displacement = np.column_stack([u, load if by_force else column(group, "u_n")])
    path = element.update(microslip.ElementState(1, 64), displacement)
    mu, rounded = element.friction_coefficient, factor == 0
    tolerance, of_energy = (1e-13 if rounded else 1e-14), (1e-12 if rounded or "c_n" in group[0] else 1e-13)
    assert_allclose(path.force[:, 0], column(group, "T"), rtol=0, atol=tolerance * mu * largest)
    assert_allclose(path.force[:, 1], load, rtol=0, atol=tolerance * largest)
    assert_allclose(path.dissipated, column(group, "dissipated"), rtol=0, atol=of_energy * mu * largest * abs(u).max())
    assert (path.dissipated >= 0).all()
    assert (abs(path.force[:, 0]) <= mu * path.force[:, 1] * (1 + 1e-15)).all()
    # Row and column: dT/dw is above the diagonal, dN/du = 0 below it. At corners the tangents of the table are NaN.
    by_input = column(group, "dN_dun") if by_force else 1
    for found, name, size in [
        (path.tangent[:, 0, 0], "dT_ddelta", scale.tangential_stiffness),
        (path.tangent[:, 0, 1] * by_input, "dT_dun", mu * scale.normal_stiffness),
        (path.tangent[:, 1, 1] * by_input, "dN_dun", scale.normal_stiffness),
    ]:
        known = ~np.isnan(column(group, name))
        assert_allclose(found[known], column(group, name)[known], rtol=0, atol=1e-11 * size)
    assert (path.tangent[:, 1, 0] == 0).all()
    state = microslip.ElementState(1, 64)
    for i, step in enumerate(displacement):
        force, tangent, dissipated, state = element.update(state, step)
        assert (force == path.force[i]).all()
        assert (tangent == path.tangent[i]).all()
        assert dissipated == path.dissipated[i]
    assert (state.array == path.state.array).all()
