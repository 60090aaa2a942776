"""Wear in blocks: the energy per cycle wears a flat into a cylinder, which changes its microslip and so the next block.

Archard's law: worn volume = COEFFICIENT times dissipated energy. A cylinder of radius R cut by a flat of half-width a has lost the
volume 2 L a^3/(3 R). The amplitude of the force is prescribed. Prints cycles, half-widths a and b [um], loss per cycle [uJ]:

    0: 0.0, 231.2, 42.3
    20000000: 161.8, 350.8, 23.7
    40000000: 187.6, 372.1, 21.8
    60000000: 206.3, 387.7, 20.6
    80000000: 221.3, 400.3, 19.6
    100000000: 234.0, 411.0, 18.9
"""

import microslip
import numpy as np

RADIUS, LENGTH, FORCE = 10e-3, 3e-3, 200.0  # m, m, N: below mu N = 320 N
COEFFICIENT, BLOCK = 1e-15, 2e7  # m^3/J (measure it), cycles


def worn(flat):
    """The contact after wear to a flat of this half-width [m]."""
    return microslip.Contact(
        flat_half_width=flat,
        edge_radius=RADIUS,
        length=LENGTH,
        normal_force=800,
        friction_coefficient=0.4,
        young_modulus=114e9,
        poisson_ratio=0.32,
        displacement_reference="rigid_strip",
    )


if __name__ == "__main__":
    volume = 0.0
    for block in range(6):
        flat = np.cbrt(1.5 * RADIUS * volume / LENGTH)
        contact = worn(flat)
        loss = contact.dissipated_energy(FORCE)
        print(f"{block * BLOCK:.0f}: {1e6 * flat:.1f}, {1e6 * contact.half_width:.1f}, {1e6 * loss:.1f}")
        volume += COEFFICIENT * loss * BLOCK
