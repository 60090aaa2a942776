"""Two neighbouring titanium blades as finite elements, reduced to the degrees of freedom of contacts and excitation.

    blade_model.py [DIRECTORY]      writes the matrices of the two blades, into the program's own directory by default

Each blade is a Timoshenko beam that bends in the circumferential direction. Its foot sits in a dovetail slot: the flanks, pressed
together by the centrifugal force, carry the deflection w in their normal direction (a stiff spring) and part of the rocking of the
foot (a spring: the pressure moves along the flanks). The rest of the rocking is carried by friction: a rotation theta of the foot
slides the two flanks, a lever r away from the axis of the blade, by +r theta and -r theta. By symmetry both flanks have the same
loop, so one coordinate, r theta, serves both. The platform is a rigid mass 30 mm above the foot.

The damper is pressed against the undersides of the two platforms and seated in the second one, so that it slides on the first. At
the damper an underside moves by w - e theta, with e the distance from the axis of the platform to its underside.
"""

import sys
from pathlib import Path

import numpy as np
from scipy.io import mmwrite
from scipy.linalg import eigh
from scipy.sparse import csc_array

E, NU, DENSITY = 114e9, 0.32, 4430.0  # Ti-6Al-4V: Pa, -, kg/m3
LENGTH, WIDTH, THICKNESS = 0.120, 0.040, 0.006  # m
ELEMENTS, PLATFORM = 24, 12  # the deflection of node 6, 30 mm above the foot; followed by the rotation
FOOT, ROCKING = 5e8, 2e4  # flanks in their normal direction, N/m; rocking not carried by friction, N m/rad
LEVER, UNDERSIDE = 0.008, 0.003  # r, e, m
PLATFORM_MASS, PLATFORM_INERTIA = 0.012, 4e-7  # kg, kg m2
DAMPING_RATIO = 1e-3  # of all modes
MISTUNING = 0.005  # of the stiffness of the second blade
BOUNDARY = [1, PLATFORM, 2 * ELEMENTS]  # root, platform, tip
MODES = 8  # of each blade, with its boundary fixed


def beam_element(modulus, l):
    """Stiffness and mass for deflection and rotation at both nodes. The interpolation satisfies the static equations exactly (Friedman
    and Kosmatka, Computers and Structures 47, 1993), so that thin beams do not lock."""
    area = WIDTH * THICKNESS
    inertia = area * THICKNESS**2 / 12
    f = 12 * modulus * inertia / (5 / 6 * modulus / (2 * (1 + NU)) * area * l**2)
    a, b = (4 + f) * l**2, (2 - f) * l**2
    stiffness = np.array([[12, 6 * l, -12, 6 * l], [6 * l, a, -6 * l, b], [-12, -6 * l, 12, -6 * l], [6 * l, b, -6 * l, a]])
    mass = np.zeros((4, 4))
    for node, weight in zip(*np.polynomial.legendre.leggauss(4)):  # of polynomials of degree 6
        x = 0.5 * (1 + node)
        deflection = np.array([1 - 3 * x**2 + 2 * x**3 + f * (1 - x), l * (x - 2 * x**2 + x**3 + f / 2 * (x - x**2)),
                               3 * x**2 - 2 * x**3 + f * x, l * (-(x**2) + x**3 + f / 2 * (x**2 - x))]) / (1 + f)
        rotation = np.array([6 / l * (x**2 - x), 1 - 4 * x + 3 * x**2 + f * (1 - x), 6 / l * (x - x**2),
                             3 * x**2 - 2 * x + f * x]) / (1 + f)
        mass += weight / 2 * l * DENSITY * (area * np.outer(deflection, deflection) + inertia * np.outer(rotation, rotation))
    return stiffness * modulus * inertia / (l**3 * (1 + f)), mass


def blade(modulus):
    """Reduced mass and stiffness of a blade."""
    n = 2 * (ELEMENTS + 1)
    stiffness, mass = np.zeros((n, n)), np.zeros((n, n))
    element = beam_element(modulus, LENGTH / ELEMENTS)
    for d in range(0, n - 2, 2):
        stiffness[d:d + 4, d:d + 4] += element[0]
        mass[d:d + 4, d:d + 4] += element[1]
    stiffness[[0, 1], [0, 1]] += FOOT, ROCKING
    mass[[PLATFORM, PLATFORM + 1], [PLATFORM, PLATFORM + 1]] += PLATFORM_MASS, PLATFORM_INERTIA
    change = np.eye(n)  # to the sliding of the flanks and the deflection of the underside
    change[1, 1] = 1 / LEVER
    change[PLATFORM, PLATFORM + 1] = UNDERSIDE
    stiffness, mass = change.T @ stiffness @ change, change.T @ mass @ change

    # The boundary stays physical, with modes of the fixed boundary (Craig and Bampton, AIAA Journal 6, 1968). Their sign is chosen.
    inner = np.setdiff1d(np.arange(n), BOUNDARY)
    modes = eigh(stiffness[np.ix_(inner, inner)], mass[np.ix_(inner, inner)])[1][:, :MODES]
    basis = np.zeros((n, len(BOUNDARY) + MODES))
    basis[BOUNDARY, range(len(BOUNDARY))] = 1
    basis[inner, :len(BOUNDARY)] = -np.linalg.solve(stiffness[np.ix_(inner, inner)], stiffness[np.ix_(inner, BOUNDARY)])
    basis[inner, len(BOUNDARY):] = modes * np.sign(modes.sum(0))
    return basis.T @ mass @ basis, basis.T @ stiffness @ basis


def model():
    """Mass, damping and stiffness of both blades."""
    size = len(BOUNDARY) + MODES
    matrices = mass, damping, stiffness = np.zeros((3, 2 * size, 2 * size))
    for i in range(2):
        own = slice(i * size, (i + 1) * size)
        mass[own, own], stiffness[own, own] = blade(E * (1 + i * MISTUNING))
        # The same damping ratio in all modes with open contacts.
        squares, modes = eigh(stiffness[own, own], mass[own, own])
        modes = mass[own, own] @ modes
        damping[own, own] = 2 * DAMPING_RATIO * modes * np.sqrt(squares) @ modes.T
    return [0.5 * (matrix + matrix.T) for matrix in matrices]


if __name__ == "__main__":
    files = Path(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).parent)
    texts = ["mass, kg", "damping, N s/m", "stiffness with open contacts, N/m"]
    for kind, text, matrix in zip(["mass", "damping", "stiffness"], texts, model()):
        scale = np.sqrt(np.diag(matrix))
        matrix[abs(matrix) <= 1e-10 * np.outer(scale, scale)] = 0  # rounding errors of zeros
        comment = f" two blades: {text}\n of each blade root, platform, tip, {MODES} modes"
        mmwrite(files / f"blades_{kind}.mtx", csc_array(np.tril(matrix)), comment, precision=17, symmetry="symmetric")
