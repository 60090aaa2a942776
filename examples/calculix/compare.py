"""compare.py RESULTS [JOBS]: the results of CalculiX against the library and, if the directory of its jobs is given, against a
solution of the same equations by other means.

RESULTS has element.inp, the tables of the static jobs, and frequency.csv, the square of the lowest angular frequency. JOBS has the
tables of the dynamic jobs, matrices.sti, .mas and .dof and the loads over time.
"""

import sys
from pathlib import Path

import microslip
import numpy as np

# CalculiX prints seven digits. Its forces and corrections are converged to 1e-9 and its loads have 12 digits, which may add up to
# as much again in the structural solution.
ROUNDING, STRUCTURAL = 5e-7, 1e-6
LIFTING = 1e-5  # impacts amplify the differences

results, jobs = Path(sys.argv[1]), Path(sys.argv[2]) if len(sys.argv) > 2 else None
counts = {True: 0, False: 0}


def check(name, difference, allowed, largest):
    passed = bool(difference <= allowed and largest > 0)
    counts[passed] += 1
    print(f"{name:55}{difference / largest:9.1e} of {largest:8.1e}, allowed {allowed / largest:8.1e}{'' if passed else '  FAILED'}")


def table(path):
    """The rows of a file that begin with a number."""
    lines = path.read_text().splitlines()
    return np.array([line.split(",") for line in lines if line[:1] in tuple("+-.0123456789")], dtype=float)


def table_of(job):
    """The table of a job in the results or with the jobs."""
    return table((results if job in elements else jobs) / f"{job}.csv")


def parameters():
    """The parameters in element.inp, after the line of the keyword."""
    numbers = (results / "element.inp").read_text().split("\n", 1)[1].replace(",", " ").split()
    names = ["flat_half_width", "edge_radius", "length", "normal_force", "friction_coefficient"]
    values = [float(number) for number in numbers[:9]]
    bodies = {"young_modulus": tuple(values[5:9:2]), "poisson_ratio": tuple(values[6:9:2])}
    return dict(zip(names, values)) | bodies | {"displacement_reference": "centre_point"}


def columns(job, m):
    """Time, tip, displacement, force and dissipated energy of a job of the element with m components."""
    return np.split(table_of(job), [1, m + 1, 2 * m + 1, 3 * m + 1], axis=1)


def compare_element(job, element):
    """The element along the displacements that CalculiX printed, a step for each increment."""
    m = element.directions + 1
    _, _, displacement, force, dissipated = columns(job, m)
    found = element.update(microslip.ElementState(element.directions, 64), displacement)
    tangential, normal, energy = found.force[:, :-1], found.force[:, -1], np.cumsum(found.dissipated)
    mu, stiffness = element.friction_coefficient, element.normal_stiffness
    largest = np.linalg.norm(displacement[:, :-1], axis=1).max()
    error_u, error_w = ROUNDING * largest, ROUNDING * abs(displacement[:, -1]).max()
    slip = mu * normal.max()
    error_t = 2 * element.tangential_stiffness * error_u + 2 * mu * stiffness * error_w + ROUNDING * slip
    allowed = stiffness * error_w + ROUNDING * normal.max()
    check(f"{job}: normal force along the path", abs(normal - force[:, -1]).max(), allowed, normal.max())
    check(f"{job}: force along the path", np.linalg.norm(tangential - force[:, :-1], axis=1).max(), error_t, slip)
    allowed = 20 * (slip * error_u + error_t * largest) + ROUNDING * energy[-1]
    check(f"{job}: energy along the path", abs(energy - dissipated[:, 0]).max(), allowed, energy[-1])


def read_matrix(name, n):
    """A symmetric matrix of which one triangle is stored, a line for each entry."""
    i, j, values = np.loadtxt(jobs / name).T
    matrix = np.zeros((n, n))
    matrix[i.astype(int) - 1, j.astype(int) - 1] = matrix[j.astype(int) - 1, i.astype(int) - 1] = values
    return matrix


def equilibrium(element, free, compliance, state):
    """Equilibrium u = free - compliance*force of element and structure by Newton's method; a step that does not reduce the residual
    is halved. Displacement, force and the new state."""
    u, step, last = free, np.zeros(len(free)), np.inf
    for _ in range(200):
        try:
            found = element.update(state, u + step)
            residual = free - u - step - compliance @ found.force
        except microslip.Error:
            residual = np.inf
        if not np.linalg.norm(residual) < last:
            if np.linalg.norm(step) <= 4 * np.spacing(np.linalg.norm(u)):
                found = element.update(state, u)
                return u, found.force, found.state
            step = step / 2
            continue
        u, last = u + step, np.linalg.norm(residual)
        step = np.linalg.solve(np.eye(len(u)) + compliance @ found.tangent, residual)
    raise SystemExit("compare: no equilibrium")


def compare_structure(job, element, stiffness, mass, equations):
    """The blade with the element, static or by the trapezoidal rule with `rate` = 2/step: (K + rate^2 M) u = load - contact force +
    M (inertia). Forces at the tip in y and z, or x, y and z; the element slides in y, or y and x, and closes in -z.
    """
    m, n = element.directions + 1, len(mass)
    loads, (time, *expected, _) = table(jobs / f"{job}_load.csv"), columns(job, m)
    rate = 2 / loads[1, 0] if "dynamic" in job else 0
    tip, side = [equations.index(f"113.{axis}") for axis in range(4 - m, 4)], np.zeros((n, m))
    for j, (axis, sign) in enumerate([(2, 1), *[(1, 1)] * (m - 2), (3, -1)]):
        side[equations.index(f"103.{axis}"), j] = sign
    inverse = np.linalg.inv(stiffness + rate**2 * mass)
    compliance = side.T @ inverse @ side
    state, own = microslip.ElementState(element.directions, 64), []
    u = velocity = acceleration = np.zeros(n)
    for t in time[:, 0]:
        inertia = rate**2 * u + 2 * rate * velocity + acceleration
        right = mass @ inertia
        right[tip] += [np.interp(t, loads[:, 0], load) for load in loads.T[1:]]
        displacement, force, state = equilibrium(element, side.T @ (inverse @ right), compliance, state)
        u = inverse @ (right - side @ force)
        own.append([u[tip], displacement, force])
        before, acceleration = acceleration, rate**2 * u - inertia
        if rate:
            velocity = velocity + (before + acceleration) / rate
    for name, one, other in zip(["tip", "displacement", "force"], np.swapaxes(own, 0, 1), expected):
        for i, largest in enumerate(abs(one).max(axis=0)):
            difference = abs(one - other)[:, i].max()
            check(f"{job}: structural solution, {name} {i + 1}", difference, LIFTING * largest, largest)


elements = {job: microslip.Element(**parameters(), directions=directions) for directions, job in enumerate(["lifting", "orbit"], 1)}
kinds = ["", "_dynamic"] if jobs else [""]
for job, element in elements.items():
    for kind in kinds:
        compare_element(job + kind, element)
if jobs:
    compare_element("rejected", elements["lifting"])
    equations = [line.strip() for line in (jobs / "matrices.dof").read_text().splitlines()]
    stiffness, mass = (read_matrix(f"matrices.{end}", len(equations)) for end in ("sti", "mas"))
    for job, element in elements.items():
        for kind in kinds:
            compare_structure(job + kind, element, stiffness, mass, equations)
    for axis, sticking in [(2, elements["lifting"].tangential_stiffness), (3, elements["lifting"].normal_stiffness)]:
        rubbing = equations.index(f"103.{axis}")
        stiffness[rubbing, rubbing] += sticking
    # M x = K x/omega^2: the mass matrix is singular, because the incompatible modes have no mass.
    lowest = 1 / np.linalg.eigvals(np.linalg.solve(stiffness, mass)).real.max()
    check("frequency: lowest, squared", abs(lowest - table(results / "frequency.csv")[0, 0]), STRUCTURAL * lowest, lowest)
print(f"{counts[True]} passed, {counts[False]} failed")
sys.exit(counts[False] > 0)
