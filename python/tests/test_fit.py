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


def test_known_parameters_are_recovered():
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
    strip = microslip.fit(loops(), start | {"displacement_reference": microslip.RIGID_STRIP})
    assert strip.shape.value != report.shape.value
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
        ("missing parameters: length", {"contact": without("length")}),
        ("missing parameters: young_modulus", {"contact": without("young_modulus")}),
        ("unknown field `bogus`", {"contact": TRUTH | {"bogus": 1}}),
        ("unknown field `stiffness`", {"fixed": {"stiffness": 1.0}}),
        ("unknown field `normalforce`", {"loops": [{"displacement": LOOP[0], "force": LOOP[1], "normalforce": 3.0}]}),
        ("parameters of two shapes", {"contact": TRUTH | {"semi_axis_x": 1e-3, "semi_axis_y": 1e-3}}),
        ("friction_coefficient must be finite and >= 0", {"contact": TRUTH | {"friction_coefficient": -1}}),
        ("length must be finite and > 0", {"contact": TRUTH | {"length": 0}}),
        ("each poisson_ratio", {"contact": TRUTH | {"poisson_ratio": (0.3, 0.6)}}),
        ("normal force", {"contact": TRUTH | {"normal_force": 0}}),
        ("in another unit", {"fixed": {"contact_compliance": 1e300}}),
        ("in another unit", {"fixed": {"series_compliance": 1.0}}),
        ("friction coefficient", {"fixed": {"friction_coefficient": 0}}),
        *[
            ("displacement_reference must be 'centre_point'", {"contact": TRUTH | {"displacement_reference": wrong}})
            for wrong in (-1, -2, 2, True, 1.0, "strip", None)
        ],
        ("length of contact must be real numbers", {"contact": TRUTH | {"length": "20"}}),
        ("length of contact must be finite", {"contact": TRUTH | {"length": np.inf}}),
        ("young_modulus of contact must be", {"contact": TRUTH | {"young_modulus": (1, 2, 3)}}),
        ("friction_coefficient of fixed must be", {"fixed": {"friction_coefficient": None}}),
        ("160 of 160 samples have no number, the first one is 1;", {"loops": [(LOOP[0], np.full(160, np.nan))]}),
        (
            "normal_force of loops.0. must be finite",
            {"loops": [{"displacement": LOOP[0], "force": LOOP[1], "normal_force": np.nan}]},
        ),
        ("force of loops.1. must be real numbers", {"loops": [LOOP, ([0.0, 1.0], ["a", "b"])]}),
        ("force of loops.0. must not be masked", {"loops": [(LOOP[0], np.ma.array(LOOP[1]))]}),
        ("loops.0. must be a pair", {"loops": [(*LOOP, LOOP[1])]}),
        ("loops.0. must be a pair", {"loops": LOOP[0]}),
        ("displacement of loops.0. must be an array", {"loops": [(LOOP[0].reshape(2, -1), LOOP[1])]}),
        ("shape must be 'flat_half_width'", {"shape": "radius"}),
        ("shape is an argument", {"fixed": {"shape": 0}}),
    ],
)
def test_errors_name_the_argument(message, arguments):
    with pytest.raises((ValueError, TypeError), match=message):
        microslip.fit(**{"loops": [LOOP], "contact": TRUTH} | arguments)


def test_missing_samples_are_left_out_and_counted():
    displacement, force, normal_force = *(column.copy() for column in LOOP), np.full(LOOP[0].size, TRUTH["normal_force"])
    displacement[2], force[5] = np.nan, np.inf
    loop = {"displacement": displacement, "force": force, "normal_force": normal_force}
    assert "2 samples are left out: they have no number" in microslip.fit([loop], TRUTH).warnings[0]
    normal_force[9] = 0
    with pytest.raises(microslip.FitError, match="normal force of sample 10 is not positive"):
        microslip.fit([loop], TRUTH)


def test_constants_are_given_by_number_or_word():
    one, other = (
        microslip.fit([LOOP], TRUTH | {"displacement_reference": reference}) for reference in (microslip.RIGID_STRIP, "rigid_strip")
    )
    assert one.contact_toml == other.contact_toml
    assert "rigid_strip" in one.contact_toml
    with_surrogate = {"displacement": LOOP[0], "force": LOOP[1], "name": "a\0\ud800b"}
    assert microslip.fit([with_surrogate], TRUTH).loops[0].name.startswith("a")


def test_measured_loops_of_three_loads_to_a_contact(tmp_path):
    """Measured loops, fit, parameter file: without an edit, to the true contact. Its layer is stiffer under a larger load."""
    random = np.random.default_rng(7)
    layer = {"tangential_compliance": 0.3 / contact.initial_stiffness, "stiffening_load": 200.0, "reference_load": 800.0}
    t = 2 * np.pi * np.arange(160) / 80
    measured = []
    for amplitude, load in [(0.7, 200.0), (2.0, 400.0), (1.2, 800.0)]:
        law = microslip.Contact(**TRUTH | layer | {"normal_force": load})
        displacement = amplitude * law.slip_displacement * np.cos(t)
        force = law.update(microslip.State(), displacement).force + 5e-4 * law.slip_force * random.standard_normal(160)
        measured.append({"displacement": displacement, "force": force, "normal_force": load})
    file = tmp_path / "fitted.toml"
    report = microslip.fit(measured, TRUTH | {"friction_coefficient": 0.3, "flat_half_width": 0.05e-3})
    file.write_text(report.contact_toml)
    assert report.series_stiffening.status == "determined"
    # From partial to gross slip, under another load too. Noise of 5e-4 in some hundred samples.
    for load in (300.0, 800.0):
        truth = microslip.Contact(**TRUTH | layer | {"normal_force": load})
        fitted = microslip.Contact(**microslip.read_parameters(file) | {"normal_force": load})
        u = np.linspace(0, 1.5 * truth.slip_displacement, 50)
        np.testing.assert_allclose(
            fitted.monotonic_force(u).force, truth.monotonic_force(u).force, rtol=0, atol=1e-3 * truth.slip_force
        )


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
