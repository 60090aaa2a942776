"""Identification through Python: known parameters are recovered, errors are exceptions."""

from __future__ import annotations

import microslip
import numpy as np
import pytest
from tables import FLAT, REPOSITORY

TRUTH = FLAT | {"flat_half_width": 0.1e-3, "edge_radius": 20e-3, "young_modulus": 2e11}
contact = microslip.Contact(**TRUTH)
SERIES = 0.2 / contact.initial_stiffness


def loops():
    """Two cycles each of two amplitudes, one with gross slip; rig and bodies in series with the contact; noise of 5e-4."""
    random = np.random.default_rng(4)
    for amplitude in [0.8, 2.0]:
        t = 2 * np.pi * np.arange(160) / 80
        of_contact = amplitude * contact.slip_displacement * np.cos(t)
        force = contact.update(microslip.State(), of_contact).force
        displacement = of_contact + SERIES * force
        yield displacement, force + 5e-4 * contact.slip_force * random.standard_normal(160)


def test_known_parameters_are_recovered(tmp_path):
    start = TRUTH | {"friction_coefficient": 0.3, "flat_half_width": 0.05e-3}
    report = microslip.fit(loops(), start)
    share = TRUTH["flat_half_width"] / contact.half_width
    for estimate, value in [
        (report.friction_coefficient, 0.5),
        (report.series_compliance, SERIES),
        (report.contact_compliance, 1.0),
        (report.shape, share),
    ]:
        # The intervals have 95 % confidence, and the sequence of random numbers is fixed.
        assert estimate.lower <= value <= (np.inf if estimate.upper is None else estimate.upper)
    assert report.friction_coefficient.status == "determined"
    assert report.friction_coefficient.value == pytest.approx(0.5, rel=1e-3)
    assert report.law.force_rms < 1e-3 * contact.slip_force
    assert report.spring_slider.misfit.force_rms > report.law.force_rms
    assert all(isinstance(loop.force, np.ndarray) for loop in report.loops)
    # Parameter file, contact: without an edit.
    (tmp_path / "fitted.toml").write_text(report.contact_toml)
    fitted = microslip.Contact(**microslip.read_parameters(tmp_path / "fitted.toml"))
    assert fitted.slip_force == pytest.approx(contact.slip_force, rel=1e-3)
    fixed = microslip.fit(loops(), start, fixed={"series_compliance": SERIES}, shape="fixed")
    assert (fixed.series_compliance.value, fixed.series_compliance.status) == (SERIES, "fixed")


def test_named_loops_and_ellipses():
    displacement, force = next(loops())
    ellipse = {"semi_axis_x": 1e-3, "semi_axis_y": 1e-3, "normal_force": 800, "friction_coefficient": 0.5}
    one = {"name": "first", "displacement": displacement, "force": force, "normal_force": 800.0}
    report = microslip.fit([one], ellipse | {"young_modulus": (2e11, 1e11), "poisson_ratio": 0.3})
    assert report.shape is None
    assert report.loops[0].name.startswith("first")


LOOP = next(loops())


def without(name):
    return {key: value for key, value in TRUTH.items() if key != name}


@pytest.mark.parametrize(
    ("message", "arguments"),
    [
        ("no measured loops", {"loops": []}),
        ("missing parameters: young_modulus", {"contact": without("young_modulus")}),
        ("unknown field `bogus`", {"contact": TRUTH | {"bogus": 1}}),
        ("friction_coefficient must be finite and >= 0", {"contact": TRUTH | {"friction_coefficient": -1}}),
        ("in another unit", {"fixed": {"contact_compliance": 1e300}}),
        ("displacement_reference must be 'centre_point'", {"contact": TRUTH | {"displacement_reference": "strip"}}),
        ("length of contact must be real numbers", {"contact": TRUTH | {"length": "20"}}),
        ("young_modulus of contact must be", {"contact": TRUTH | {"young_modulus": (1, 2, 3)}}),
        ("friction_coefficient of fixed must be", {"fixed": {"friction_coefficient": None}}),
        ("160 of 160 samples have no number, the first one is 1;", {"loops": [(LOOP[0], np.full(160, np.nan))]}),
        ("force of loops.1. must be real numbers", {"loops": [LOOP, ([0.0, 1.0], ["a", "b"])]}),
        ("loops.0. must be a pair", {"loops": [(*LOOP, LOOP[1])]}),
        ("displacement of loops.0. must be an array", {"loops": [(LOOP[0].reshape(2, -1), LOOP[1])]}),
        ("shape must be 'flat_half_width'", {"shape": "radius"}),
    ],
)
def test_errors_name_the_argument(message, arguments):
    with pytest.raises((ValueError, TypeError), match=message):
        microslip.fit(**{"loops": [LOOP], "contact": TRUTH} | arguments)


def test_constants_are_given_by_number_or_word():
    one, other = (
        microslip.fit([LOOP], TRUTH | {"displacement_reference": reference}) for reference in (microslip.RIGID_STRIP, "rigid_strip")
    )
    assert one.contact_toml == other.contact_toml
    assert "rigid_strip" in one.contact_toml
    with_surrogate = {"displacement": LOOP[0], "force": LOOP[1], "name": "a\0\ud800b"}
    assert microslip.fit([with_surrogate], TRUTH).loops[0].name.startswith("a")


def test_parameter_files_of_the_command_line(tmp_path):
    file = REPOSITORY / "cli" / "example.toml"
    damper = {"flat_half_width": 0, "edge_radius": 10e-3, "length": 3e-3, "normal_force": 800, "friction_coefficient": 0.4}
    titanium = {"young_modulus": 114e9, "poisson_ratio": 0.32, "displacement_reference": "rigid_strip"}
    assert microslip.Contact(**microslip.read_parameters(file)) == microslip.Contact(**damper | titanium)
    text = "units = 'mm'\nspring = 1\nedge_radius = 3\ntangential_compliance = 2e-6\n[[material]]\nyoung_modulus = 2e5\n"
    (tmp_path / "mm.toml").write_text(text)
    # Products by powers of ten.
    expected = {"edge_radius": 3e-3, "tangential_compliance": 2e-9, "young_modulus": 2e11, "spring": 1}
    assert microslip.read_parameters(tmp_path / "mm.toml") == pytest.approx(expected, rel=1e-15)
    (tmp_path / "inch.toml").write_text("units = 'inch'\n")
    with pytest.raises(ValueError, match="units must be 'si' or 'mm', not 'inch'"):
        microslip.read_parameters(tmp_path / "inch.toml")
