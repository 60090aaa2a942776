"""A sphere of alumina rebounds obliquely from glass (Kharaz, Gorham and Salman 2001): microslip under a load that rises and falls.

Prints the angle of impact, the tangential velocity of the centre after the impact over that before, and the measured one:

    2.0275° 0.774, measured 0.794
    3.9282° 0.751, measured 0.745
    9.6304° 0.643, measured 0.673
    20.0845° 0.593, measured 0.596
"""

import microslip
import numpy as np

RADIUS, MASS, SPEED, STEPS = 2.5e-3, 4000 * 4 / 3 * np.pi * 2.5e-3**3, 3.85, 2000  # m, kg, m/s
BODIES = {"young_modulus": (380e9, 70e9), "poisson_ratio": (0.23, 0.25), "friction_coefficient": 0.092}
E_STAR = 1 / ((1 - 0.23**2) / 380e9 + (1 - 0.25**2) / 70e9)


def restitution(angle):
    """Tangential velocity of the centre after the impact over that before, for an angle from the normal [rad]."""
    normal, tangential = SPEED * np.cos(angle), SPEED * np.sin(angle)
    largest = (15 * MASS * normal**2 / (16 * E_STAR * np.sqrt(RADIUS))) ** 0.4  # approach: all energy in Hertz' spring
    contact = np.sqrt(RADIUS * largest)
    load = 4 / 3 * E_STAR * contact * largest
    element = microslip.Element.elliptic(semi_axis_x=contact, semi_axis_y=contact, normal_force=load, **BODIES)
    state = microslip.ElementState(directions=1, pieces=2 * STEPS)
    dt = 3 * largest / normal / STEPS  # an impact takes 2.94 w/v
    velocity, surface, approach_rate, u, w = tangential, tangential, normal, 0.0, 0.0
    while w >= 0:
        u, w = u + dt * surface, w + dt * approach_rate
        tangential_force, normal_force = element.update(state, [u, w], out=state).force
        velocity -= dt * tangential_force / MASS
        surface -= 3.5 * dt * tangential_force / MASS  # with the rotation of a solid sphere
        approach_rate -= dt * normal_force / MASS
    return velocity / tangential


if __name__ == "__main__":
    for degrees, measured in [(2.0275, 0.794), (3.9282, 0.745), (9.6304, 0.673), (20.0845, 0.596)]:
        print(f"{degrees}° {restitution(np.radians(degrees)):.3f}, measured {measured}")
