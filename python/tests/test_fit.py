"""Identification through Python: known parameters are recovered, errors are exceptions."""

from __future__ import annotations

import microslip
import numpy as np
import pytest

TRUTH = {
    "flat_half_width": 0.1e-3,
    "edge_radius": 20e-3,
    "length": 20e-3,
    "normal_force": 800.0,
    "friction_coefficient": 0.5,
    "young_modulus": 2e11,
    "poisson_ratio": 0.3,
}
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


def test_errors():
    with pytest.raises(microslip.FitError, match="no measured loops"):
        microslip.fit([], TRUTH)
    with pytest.raises(microslip.FitError, match="unknown field"):
        microslip.fit(loops(), TRUTH, fixed={"stiffness": 1.0})
    with pytest.raises(microslip.FitError, match="finite"):
        microslip.fit([([0.0, np.nan], [0.0, 1.0])], TRUTH)
    with pytest.raises(TypeError, match="force must be real numbers"):
        microslip.fit([([0.0, 1.0], ["a", "b"])], TRUTH)
