"""The adapter of tmdsimpy: shapes and order of its interface, gradients by differences, and a forced response."""

from __future__ import annotations

import microslip
import numpy as np
import pytest
from microslip.tmdsimpy import MicroslipForce
from numpy.testing import assert_allclose
from tables import REPOSITORY, differences
from two_masses import CONTACT, DAMPING, MASS, STIFFNESS

contact = microslip.Contact(**CONTACT)
elements = [microslip.Element(**CONTACT, directions=directions) for directions in (1, 2)]
SLIP = contact.slip_displacement
random = np.random.default_rng(2)


def force_of(law, **others):
    """Two contacts or elements on five degrees of freedom."""
    local = 2 * (1 if law is contact else law.directions + 1)
    return MicroslipForce(random.standard_normal((local, 5)), random.standard_normal((5, local)), law, **others)


@pytest.mark.parametrize("law", [contact, *elements])
@pytest.mark.parametrize("h", [[0, 1, 2, 3], [1, 3], [0, 2]])
@pytest.mark.parametrize("unloaded_at_mean", [True, False])
def test_aft_has_the_published_shapes_and_derivatives(law, h, unloaded_at_mean):
    approach = 0.0 if law is contact else law.approach
    force = force_of(law, interference=approach, unloaded_at_mean=unloaded_at_mean)
    h = np.array(h)
    n = 5 * (2 * len(h) - (0 in h))
    U = 0.3 * SLIP * random.standard_normal(n)
    F, dFdU, dFdw = force.aft(U, 100.0, h, 64)
    assert F.shape == dFdw.shape == (n,)
    assert dFdU.shape == (n, n)
    assert (dFdw == 0).all()
    assert (force.aft(U, 100.0, h, 64, calc_grad=False)[0] == F).all()
    expected = differences(lambda U: force.aft(U, 1, h, 64)[0], U, 1e-6 * SLIP)
    assert_allclose(dFdU, expected, rtol=0, atol=1e-4 * abs(dFdU).max())
    assert force.nl_force_type() == 1


def test_mean_displacement():
    U = SLIP * np.array([0.5, 0.2, 0.1])
    h = np.array([0, 1])
    unloaded, loaded = (MicroslipForce(np.eye(1), np.eye(1), contact, unloaded_at_mean=flag) for flag in (True, False))
    # As a slider that starts at the mean displacement: neither it nor the mean force depends on it.
    assert_allclose(unloaded.aft(U, 1, h)[0], unloaded.aft(U * [0, 1, 1], 1, h)[0], rtol=0)
    assert abs(unloaded.aft(U, 1, h)[0][0]) < 0.1 * contact.slip_force
    # As the library, which starts at displacement 0.
    expected = contact.harmonic_force(microslip.Workspace(1, 128), U)
    assert (loaded.aft(U, 1, h)[0] == expected.force).all()
    assert (loaded.aft(U, 1, h)[1] == expected.jacobian).all()
    assert loaded.aft(U, 1, h)[0][0] > 0.4 * contact.initial_stiffness * U[0]


@pytest.mark.parametrize("law", [contact, *elements])
def test_force_of_a_static_analysis(law):
    force = force_of(law, interference=0.0 if law is contact else law.approach)
    X = 0.3 * SLIP * random.standard_normal(5)
    force.force(X, update_hist=True)
    at = X + 0.2 * SLIP * random.standard_normal(5)
    F, dFdX = force.force(at)
    assert F.shape == (5,)
    assert dFdX.shape == (5, 5)
    expected = differences(lambda X: force.force(X)[0], at, 1e-6 * SLIP)
    assert_allclose(dFdX, expected, rtol=0, atol=1e-4 * abs(dFdX).max())
    assert (force.force(at)[0] == F).all()
    force.force(at, update_hist=True)
    force.init_history()
    assert_allclose(force.force(0 * X)[0][:1] if law is contact else 0, 0, atol=1e-12)


def test_forced_response_is_that_of_the_fortran_example():
    """Two masses: M x'' + D x' + K x + B f(B^T x) = F cos(omega t), in tmdsimpy's order of coefficients."""
    h = np.arange(6)
    force = MicroslipForce([[0, 1]], [[0], [1]], contact)
    table = np.loadtxt(REPOSITORY / "fortran_examples" / "expected" / "two_dof.csv", delimiter=",", skiprows=1)
    for masses in table.reshape(-1, 2, 13):
        omega = 2 * np.pi * masses[0, 0]
        E = np.zeros((22, 22))
        E[:2, :2] = STIFFNESS
        for k in h[1:]:
            c, s = slice(4 * k - 2, 4 * k), slice(4 * k, 4 * k + 2)
            E[c, c] = E[s, s] = STIFFNESS - (k * omega) ** 2 * MASS
            E[c, s], E[s, c] = k * omega * DAMPING, -k * omega * DAMPING
        load = np.zeros(22)
        load[2] = 15.0
        expected = masses[:, 2:].T.ravel()
        # Newton's method from a point nearby.
        U = expected * (1 + 1e-3 * random.standard_normal(22))
        for _ in range(30):
            F, dFdU, _ = force.aft(U, omega, h, 128)
            U = U - np.linalg.solve(E + dFdU, E @ U + F - load)
        found, expected = U.reshape(11, 2), expected.reshape(11, 2)
        assert (abs(found - expected).max(axis=0) <= 1e-11 * abs(expected).max(axis=0)).all()
