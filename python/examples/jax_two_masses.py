"""Two masses on a contact in JAX: forced response by Newton's method, and a fit of the friction to measured amplitudes.

The masses are those of `two_masses`: M x'' + D x' + K x + B f(B^T x) = F cos(omega t).
"""

import sys

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


def fit(frequencies, measured, start):
    """Positive parameters of the contact with which the response has the measured amplitudes, by the Gauss-Newton method from
    `start`, a dictionary: its logarithms are the unknowns.
    """
    names = list(start)

    def misfit(logarithms):
        return amplitudes(frequencies, dict(zip(names, jnp.exp(logarithms)))) / measured - 1

    @jax.jit
    def gauss_newton_step(unknowns):
        return jnp.linalg.lstsq(jax.jacfwd(misfit)(unknowns), -misfit(unknowns))[0]

    unknowns = jnp.log(jnp.array([start[name] for name in names]))
    for _ in range(30):
        step = gauss_newton_step(unknowns)
        unknowns += step * jnp.minimum(1, 0.5 / abs(step).max())
        if abs(step).max() < 1e-10:
            break
    return dict(zip(names, np.exp(unknowns).tolist()))


def example():
    """Parameters of a response, and those that are fitted to its amplitudes."""
    compliance = 1 / microslip.Contact(**CONTACT).initial_stiffness
    truth = {"friction_coefficient": 0.4, "layer_compliance": 0.3 * compliance}
    start = {"friction_coefficient": 0.3, "layer_compliance": 0.1 * compliance}
    frequencies = np.linspace(600, 900, 16)
    return truth, fit(frequencies, amplitudes(frequencies, truth), start)


def main():
    truth, found = example()
    for name in truth:
        print(f"{name}: {truth[name]:.6g}, fitted {found[name]:.6g}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
