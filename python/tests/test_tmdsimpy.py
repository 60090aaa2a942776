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
    """M x'' + D x' + K x + B f(B^T x) = F cos(omega t): the correction by Newton's method, in tmdsimpy's order of coefficients."""
    force = MicroslipForce([[0, 1]], [[0], [1]], contact)
    rates = np.zeros((11, 11))
    for k in range(1, 6):
        rates[2 * k - 1, 2 * k], rates[2 * k, 2 * k - 1] = k, -k
    table = np.loadtxt(REPOSITORY / "fortran_examples" / "expected" / "two_dof.csv", delimiter=",", skiprows=1)
    for masses in table.reshape(-1, 2, 13):
        D = 2 * np.pi * masses[0, 0] * rates
        E = np.kron(np.eye(11), STIFFNESS) + np.kron(D, DAMPING) + np.kron(D @ D, MASS)
        U = masses[:, 2:].T.ravel()
        F, dFdU, _ = force.aft(U, 1.0, np.arange(6), 128)
        residual = E @ U + F
        residual[2] -= 15.0
        correction = abs(np.linalg.solve(E + dFdU, residual)).reshape(11, 2).max(axis=0)
        assert (correction <= 1e-11 * abs(masses[:, 2:]).max(axis=1)).all()
