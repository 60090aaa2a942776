"""Two masses on a contact in JAX: forced response by Newton's method, with its derivatives.

The masses are those of `two_masses`: M x'' + D x' + K x + B f(B^T x) = F cos(omega t).
"""

import jax
import jax.numpy as jnp
import microslip
import numpy as np
from jax_microslip import harmonic_force
from two_masses import CONTACT, DAMPING, MASS, STIFFNESS

jax.config.update("jax_enable_x64", True)

HARMONICS, FORCE = 5, 15.0

contact_force = harmonic_force(CONTACT, microslip.Workspace(HARMONICS, 128))
stuck = STIFFNESS + np.diag([0, microslip.Contact(**CONTACT).initial_stiffness])


def linear(omega, stiffness, x):
    """Elastic, inertia and damping forces of coefficients (2, 2H+1) less the excitation."""
    k = omega * jnp.arange(1, HARMONICS + 1)
    cos, sin = x[:, 1::2], x[:, 2::2]
    forces = stiffness @ x
    forces = forces.at[:, 1::2].add(-MASS @ cos * k**2 + DAMPING @ sin * k)
    forces = forces.at[:, 2::2].add(-MASS @ sin * k**2 - DAMPING @ cos * k)
    return forces.at[0, 1].add(-FORCE)


def response(omega, changed):
    """Coefficients (2, 2H+1) [m] of the response at an angular frequency, by which and by parameters it has derivatives."""

    def residual(x):
        return linear(omega, STIFFNESS, x).at[1].add(contact_force(x[1], changed))

    def newton_step(f, x):
        jacobian = jax.jacfwd(f)(x).reshape(x.size, x.size)
        return -jnp.linalg.solve(jacobian, f(x).ravel()).reshape(x.shape)

    def newton(f, x):
        def unfinished(state):
            x, step, n = state
            return (step > 1e-13 * abs(x).max()) & (n < 50)

        def advance(state):
            x, _, n = state
            # The step or the part of it with the smallest residual.
            tried = x + 0.5 ** jnp.arange(8.0)[:, None, None] * newton_step(f, x)
            best = tried[jnp.argmin((jax.vmap(f)(tried) ** 2).sum((1, 2)))]
            return best, abs(best - x).max(), n + 1

        return jax.lax.while_loop(unfinished, advance, (x, jnp.inf, 0))[0]

    def tangent_solve(f, y):
        return newton_step(lambda x: f(x) - y, jnp.zeros_like(y))

    start = newton_step(lambda x: linear(omega, stuck, x), jnp.zeros((2, 2 * HARMONICS + 1)))
    return jax.lax.custom_root(residual, start, newton, tangent_solve)


responses = jax.jit(jax.vmap(response, in_axes=(0, None)))


def amplitudes(frequencies, changed):
    """Amplitudes [m] of the first mass at frequencies [Hz]."""
    x = responses(2 * np.pi * frequencies, changed)
    return jnp.hypot(x[:, 0, 1], x[:, 0, 2])
