"""The element of pyHarm: forced responses, a varying normal force, and the conventions of pyHarm."""

from __future__ import annotations

import logging

import microslip
import numpy as np
import pyharm_costs
import pytest
from numpy.testing import assert_allclose
from pyHarm import extension
from pyHarm.Maestro import Maestro
from pyharm_two_masses import LENGTH, deviation, response_at, two_masses
from tables import REPOSITORY, differences
from two_masses import CONTACT, DAMPING, MASS, STIFFNESS

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


def connector(law, **others):
    """The contact alone, of nodes with two or three directions, in pyHarm's units."""
    dirs = [0] if law is contact else list(range(law.directions + 1))
    data = {"type": "microslip", "dirs": dirs, "law": law, **others}
    system = Maestro(two_masses(data, [300.0, 900.0], ndofs=max(len(dirs), 1))).system
    return next(e for e in system.LE if e.name == "contact"), system.ndofs


@pytest.mark.parametrize("directions", [0, 1, 2])
def test_jacobian_is_the_derivative_of_the_residual(directions):
    law = microslip.Element(**CONTACT, directions=directions) if directions else contact
    element, unknowns = connector(law, **({"interference": law.approach} if directions else {}))
    x = 0.3 * SLIP / LENGTH * np.random.default_rng(1).standard_normal(unknowns)
    jacobian, by_frequency = element.evalJacobian(x, 1.0)
    assert (by_frequency == 0).all()
    expected = differences(lambda x: element.evalResidual(x, 1.0), x, 1e-6 * SLIP / LENGTH)[:, element.indices]
    # Differences of second order with steps of 1e-6.
    assert_allclose(jacobian, expected, rtol=0, atol=1e-4 * abs(jacobian).max())


def test_element_with_a_varying_normal_force():
    """Masses that move in a plane, the second one pressed against an inclined face by 150 N: undeformed in equilibrium."""
    element = microslip.Element(**CONTACT)
    angle = np.radians(70)
    inclined = {"coordinates": {"face": [[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]]}}
    data = {"type": "microslip", "dirs": [0, 1], "law": element, "interference": element.approach, "coordinatesystem": "face"}
    idata = two_masses(data, [600.0, 760.0], forcing=8.0, ndofs=2) | inclined
    for direction, component in enumerate(inclined["coordinates"]["face"][1]):
        preload = {
            "type": "GOForcing",
            "connect": {"masses": [1]},
            "dirs": [direction],
            "dto": 0,
            "ho": 0,
            "amp": 150.0 * component,
        }
        idata["connectors"][f"preload {direction}"] = preload
    maestro = Maestro(idata)
    frequencies = np.array([620.0, 700.0, 750.0])
    found = response_at(maestro, frequencies)
    workspace = microslip.ElementWorkspace(1, 5, 128)
    face = np.array(inclined["coordinates"]["face"])
    for frequency, x in zip(frequencies, found):
        # The equations of motion with the element called directly; rows: mass 1 x, y, mass 2 x, y.
        displacement = face @ x[2:]
        displacement[1, 0] += element.approach
        law = element.harmonic_force(workspace, displacement)
        residual = np.kron(STIFFNESS, np.eye(2)) @ x
        residual[2:] += face.T @ law.force
        residual[2:, 0] -= 150.0 * face[1]
        residual[0, 1] -= 8.0
        for k in range(1, 6):
            omega = 2 * np.pi * frequency * k
            c, s = x[:, 2 * k - 1], x[:, 2 * k]
            mass, damping = np.kron(MASS, np.eye(2)), np.kron(DAMPING, np.eye(2))
            residual[:, 2 * k - 1] += -(omega**2) * mass @ c + omega * damping @ s
            residual[:, 2 * k] += -(omega**2) * mass @ s - omega * damping @ c
        assert abs(residual).max() < 1e-9  # N, of forces of some 100 N with rounding errors
        # The normal force varies.
        assert np.hypot(*law.force[1, 1:3]) > 0.01 * law.force[1, 0]


def test_harmonics_may_be_chosen():
    full, unknowns = connector(contact)
    idata = two_masses({"type": "microslip", "dirs": [0], "law": contact}, [300.0, 900.0])
    idata["system"]["nh"] = [1, 3, 5]
    odd = next(e for e in Maestro(idata).system.LE if e.name == "contact")
    x = SLIP / LENGTH * np.random.default_rng(3).standard_normal(12)
    places = np.array([2 * i + m for k in (1, 3, 5) for i in (2 * k - 1, 2 * k) for m in (0, 1)])
    embedded = np.zeros(unknowns)
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
        element = next(e for e in Maestro(idata).system.LE if e.name == "contact")
        x = np.zeros(22)
        x[3] = amplitude * SLIP / LENGTH  # cosine of the second mass
        forces.append(element.evalResidual(x, 1.0)[1:3])
    # Microslip at a fiftieth of gross slip changes the force by 1.3e-4, the way to gross slip at 200 times by 8e-5.
    assert_allclose(forces[0], forces[1], rtol=0, atol=3e-4 * abs(forces[1]).max())
