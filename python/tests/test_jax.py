"""Functions of JAX: their derivatives against differences of the library's forces, and a harmonic balance."""

from __future__ import annotations

import jax
import jax.numpy as jnp
import microslip
import numpy as np
import pytest
from jax_microslip import NAMES, contact, harmonic_force
from jax_two_masses import CONTACT, amplitudes, responses
from numpy.testing import assert_allclose
from tables import REPOSITORY, differences

SLIP = microslip.Contact(**CONTACT).slip_displacement
LAYER = 0.3 / microslip.Contact(**CONTACT).initial_stiffness
random = np.random.default_rng(5)
# Of central differences with steps of 1e-6, over the largest change of the force with the whole argument: rounding errors of
# forces, some 1e-15 of them, over the step. Errors of the second power of the step are smaller, corners within a step not met.
DIFFERENCE = 1e-8


@pytest.mark.parametrize("directions", [0, 1, 2])
def test_harmonic_force_has_exact_derivatives(directions):
    if directions:
        law, workspace = microslip.Element(**CONTACT, directions=directions), microslip.ElementWorkspace(directions, 2, 32)
        x = 0.5 * SLIP * random.standard_normal((3, directions + 1, 5))
        x[:, -1, 0] += law.approach
    else:
        law, workspace = microslip.Contact(**CONTACT), microslip.Workspace(2, 32)
        x = SLIP * random.standard_normal((3, 5))
    force = harmonic_force(law, workspace)
    many = jax.jit(jax.vmap(force))(x)
    forward, reverse = jax.vmap(jax.jacfwd(force))(x), jax.vmap(jax.jacrev(force))(x)
    for i in range(3):
        assert (many[i] == law.harmonic_force(workspace, x[i]).force).all()
        expected = differences(lambda at: law.harmonic_force(workspace, at).force, x[i], 1e-6 * SLIP)
        assert_allclose(forward[i], expected, rtol=0, atol=DIFFERENCE * abs(expected).max())
        # The same products in another order: rounding errors of the sums.
        assert_allclose(reverse[i], forward[i], rtol=0, atol=1e-14 * abs(forward).max())


def test_parameters_have_exact_derivatives():
    workspace = microslip.Workspace(3, 64)
    force = harmonic_force(CONTACT, workspace)
    made = microslip.Contact(**CONTACT)
    values = {name: CONTACT.get(name, made.composite_modulus) for name in NAMES} | {"layer_compliance": LAYER}
    u = SLIP * np.array([0.3, 1.2, -0.4, 0, 0.2, 0.1, 0.3])
    forward, reverse = jax.jacfwd(force, 1)(u, values), jax.jacrev(force, 1)(u, values)
    for name, value in values.items():

        def at(changed, name=name):
            return contact(CONTACT, values | {name: float(changed)}).harmonic_force(workspace, u).force

        expected = differences(at, np.array(value), 1e-6 * value)
        assert_allclose(forward[name], expected, rtol=0, atol=DIFFERENCE * made.slip_force / value, err_msg=name)
        assert_allclose(reverse[name], forward[name], rtol=0, atol=1e-14 * abs(expected).max(), err_msg=name)
    # Contacts of two friction coefficients in one call.
    mu = jnp.array([0.3, 0.4, 0.3])
    found = jax.vmap(lambda m: force(u, {"friction_coefficient": m}))(mu)
    for one, m in zip(found, mu.tolist()):
        assert (one == contact(CONTACT, {"friction_coefficient": m}).harmonic_force(workspace, u).force).all()


def test_errors():
    force = harmonic_force(CONTACT, microslip.Workspace(1, 8))
    with pytest.raises(ValueError, match="names of parameters are"):
        force(np.zeros(3), {"mu": 0.3})
    with pytest.raises(ValueError, match="cannot be changed"):
        harmonic_force(microslip.Contact(**CONTACT), microslip.Workspace(1, 8))(np.zeros(3), {"friction_coefficient": 0.3})
    with pytest.raises(ValueError, match="Pure callbacks do not support JVP"):
        jax.hessian(lambda u: force(u)[1])(np.ones(3))
    with pytest.raises(jax.errors.JaxRuntimeError, match="BAD_DISPLACEMENT"):
        force(np.full(3, np.nan)).block_until_ready()
    jax.config.update("jax_enable_x64", False)
    try:
        with pytest.raises(ValueError, match="float64 is needed"):
            force(np.zeros(3))
    finally:
        jax.config.update("jax_enable_x64", True)


def test_response_of_two_masses_is_that_of_the_fortran_example():
    rows = np.loadtxt(REPOSITORY / "fortran_examples" / "expected" / "two_dof.csv", delimiter=",", skiprows=1).reshape(-1, 2, 13)
    found, expected = responses(2 * np.pi * rows[:, 0, 0], {}), rows[:, :, 2:]
    # The Fortran example stops at a residual of 1e-12 of the displacement.
    assert (abs(found - expected).max(axis=2) <= 1e-11 * abs(expected).max(axis=2)).all()


def test_response_has_exact_derivatives_by_parameters():
    frequencies = np.linspace(600, 900, 16)

    def sum_of_squares(logarithms):
        changed = {"friction_coefficient": jnp.exp(logarithms[0]), "layer_compliance": jnp.exp(logarithms[1])}
        return (1e6 * amplitudes(frequencies, changed) ** 2).sum()

    at = np.log([0.35, LAYER])
    expected = differences(sum_of_squares, at, 1e-5)
    # Second power of the step times third derivatives, some hundred at resonance; rounding errors of 1e-13 over it.
    assert_allclose(jax.grad(sum_of_squares)(at), expected, rtol=1e-7)
