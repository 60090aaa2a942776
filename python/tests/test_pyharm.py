"""The element of pyHarm: a forced response, forces on an inclined face, and the conventions of pyHarm."""

from __future__ import annotations

import logging

import microslip
import numpy as np
import pyharm_costs
import pytest
from numpy.testing import assert_allclose
from pyHarm import extension
from pyHarm.Maestro import Maestro
from pyharm_two_masses import LENGTH, deviation, two_masses
from tables import REPOSITORY, differences
from two_masses import CONTACT

pytestmark = [
    pytest.mark.filterwarnings("ignore::numba.NumbaPerformanceWarning"),
    pytest.mark.filterwarnings("ignore::DeprecationWarning"),
]
logging.disable(logging.CRITICAL)

contact = microslip.Contact(**CONTACT)
SLIP = contact.slip_displacement


def test_response_of_two_masses_is_that_of_the_fortran_example():
    # The Fortran example stops at a residual of 1e-12 of the displacement.
    assert deviation(REPOSITORY / "fortran_examples" / "expected" / "two_dof.csv") < 1e-11


def test_the_costs_of_the_benchmarks_are_measured(capsys):
    pyharm_costs.main(rounds=1)
    rows = [line.split() for line in capsys.readouterr().out.splitlines() if line.startswith("|")]
    assert [row[1] for row in rows] == ["harmonics", "1", "5", "9", "contacts", "1", "20"]
    assert all(int(row[7]) < int(row[3]) < 1e6 for row in rows[1:4])  # microslip, Jenkins
    assert all(float(row[5]) < float(row[3]) < 1e3 for row in rows[5:])


def connector(idata):
    """The contact alone, in pyHarm's units."""
    return next(e for e in Maestro(idata).system.LE if e.name == "contact")


@pytest.mark.parametrize("directions", [0, 1, 2])
def test_force_and_jacobian(directions):
    """Of a contact, and of elements on a face whose normal is the last direction."""
    components, random = directions + 1, np.random.default_rng(1)
    law = microslip.Element(**CONTACT, directions=directions) if directions else contact
    face = np.linalg.qr(random.standard_normal((components, components)))[0] if directions else np.eye(1)
    data = {"type": "microslip", "dirs": list(range(components)), "law": law}
    data |= {"interference": law.approach, "coordinatesystem": "face"} if directions else {}
    element = connector(two_masses(data, [300.0, 900.0], ndofs=components) | {"coordinates": {"face": face.tolist()}})
    x = 0.3 * SLIP / LENGTH * random.standard_normal(22 * components)
    displacement = LENGTH * face @ x.reshape(11, 2, components)[:, 1].T
    displacement[-1, 0] += law.approach if directions else 0
    space = microslip.ElementWorkspace(directions, 5, 128) if directions else microslip.Workspace(5, 128)
    force = law.harmonic_force(space, displacement if directions else displacement[0]).force
    assert_allclose(element.evalResidual(x, 1.0).reshape(11, components), np.reshape(force, (components, 11)).T @ face, rtol=1e-9)
    jacobian, by_frequency = element.evalJacobian(x, 1.0)
    assert (by_frequency == 0).all()
    expected = differences(lambda x: element.evalResidual(x, 1.0), x, 1e-6 * SLIP / LENGTH)[:, element.indices]
    # Differences of second order with steps of 1e-6.
    assert_allclose(jacobian, expected, rtol=0, atol=1e-4 * abs(jacobian).max())


def test_harmonics_may_be_chosen():
    idata = two_masses({"type": "microslip", "dirs": [0], "law": contact}, [300.0, 900.0])
    full = connector(idata)
    idata["system"]["nh"] = [1, 3, 5]
    odd = connector(idata)
    x = SLIP / LENGTH * np.random.default_rng(3).standard_normal(12)
    places = np.array([2 * i + m for k in (1, 3, 5) for i in (2 * k - 1, 2 * k) for m in (0, 1)])
    embedded = np.zeros(22)
    embedded[places] = x
    of_second = places[1::2] // 2
    assert (odd.evalResidual(x, 1.0) == full.evalResidual(embedded, 1.0)[of_second]).all()
    assert (odd.evalJacobian(x, 1.0)[0] == full.evalJacobian(embedded, 1.0)[0][np.ix_(of_second, of_second)]).all()


@pytest.mark.parametrize("amplitude", [0.02, 200])
def test_extension_is_pyharms_slider_in_the_limits_of_stick_and_slip(amplitude):
    extension.load("microslip")
    laws = [
        {"type": "microslip", "law": contact},
        {"type": "Jenkins", "mu": contact.friction_coefficient, "N0": contact.normal_force, "k": contact.initial_stiffness},
    ]
    forces = []
    for law in laws:
        idata = two_masses({"dirs": [0], **law}, [300.0, 900.0])
        del idata["plugin"]
        element = connector(idata)
        x = np.zeros(22)
        x[3] = amplitude * SLIP / LENGTH  # cosine of the second mass
        forces.append(element.evalResidual(x, 1.0)[1:3])
    # Microslip at a fiftieth of gross slip changes the force by 1.3e-4, the way to gross slip at 200 times by 8e-5.
    assert_allclose(forces[0], forces[1], rtol=0, atol=3e-4 * abs(forces[1]).max())
