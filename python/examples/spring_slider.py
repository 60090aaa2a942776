"""A spring-slider (Jenkins element) in NumPy, as a measure of time: harmonics of the force and their Jacobian."""

import time
import timeit

import numpy as np


def basis(harmonics, samples):
    """1, cos t, sin t, ..., cos Ht, sin Ht at uniformly spaced instants: (samples, 2H+1)."""
    t = 2 * np.pi * np.arange(samples) / samples
    columns = [f(k * t) for k in range(1, harmonics + 1) for f in (np.cos, np.sin)]
    return np.column_stack([np.ones(samples), *columns])


def harmonic_force(stiffness, slip_force, displacement, samples):
    """Coefficients (2H+1) of the force [N], and jacobian[i, j] = d force_i / d displacement_j [N/m], in the second period."""
    size = len(displacement)
    rows = basis(size // 2, samples)
    u = rows @ displacement
    force, slope = np.empty(samples), np.empty((samples, size))
    f, df, last, dlast = 0.0, np.zeros(size), 0.0, np.zeros(size)
    for i in [*range(samples), *range(samples)]:
        f += stiffness * (u[i] - last)
        df = df + stiffness * (rows[i] - dlast)
        if abs(f) > slip_force:
            f, df = slip_force * np.sign(f), np.zeros(size)
        last, dlast = u[i], rows[i]
        force[i], slope[i] = f, df
    weights = rows.T * (2 / samples)
    weights[0] /= 2
    return weights @ force, weights @ slope


def microseconds(call, calls):
    """Processor time of a call: the shortest mean of 25 series of some calls."""
    call()
    return 1e6 * min(timeit.repeat(call, timer=time.process_time, number=calls, repeat=25)) / calls
