# %% [markdown]
# # Pictures of the law
# Hysteresis loops, complex stiffness and the forced response of one mass for a flat contact with rounded edges, and loops under a
# normal force that varies. The cells run in an editor that knows `# %%`, or all at once: `python pictures.py DIRECTORY`.

# %%
import sys
from pathlib import Path

import matplotlib.pyplot as plt
import microslip
import numpy as np

DIRECTORY = Path(sys.argv[1]) if len(sys.argv) > 1 else Path()
PARAMETERS = {
    "flat_half_width": 0.05e-3,  # m
    "edge_radius": 50e-3,  # m
    "length": 20e-3,  # m
    "normal_force": 800,  # N
    "friction_coefficient": 0.5,
    "young_modulus": 2e11,  # Pa
    "poisson_ratio": 0.3,
    "displacement_reference": "rigid_strip",
}
contact = microslip.Contact(**PARAMETERS)
slip = contact.slip_displacement

# %% [markdown]
# ## Hysteresis loops
# From small amplitudes, where the loop is almost a line, to gross slip. Dotted: the initial loading curve.

# %%
figure, axes = plt.subplots(layout="constrained")
for amplitude in [0.4, 0.7, 1.0, 1.3]:
    loop = contact.hysteresis_loop(amplitude * slip, 400)
    axes.plot(*(1e6 * np.append(loop.displacement, loop.displacement[0]), np.append(loop.force, loop.force[0])))
displacement = np.linspace(0, 1.3 * slip, 200)
axes.plot(1e6 * displacement, contact.monotonic_force(displacement).force, "k:", linewidth=1)
axes.set(xlabel="displacement (µm)", ylabel="force (N)")
figure.savefig(DIRECTORY / "loops.png")

# %% [markdown]
# ## Complex stiffness
# K' falls with the amplitude, and the loss factor K''/K' rises. The Jenkins element with the same initial stiffness and slip force
# has no loss before its slip.

# %%
amplitude = np.geomspace(0.01, 10, 300) * slip
stiffness = contact.complex_stiffness(amplitude)
onset = contact.slip_force / contact.initial_stiffness
angle = np.arccos(np.clip(1 - 2 * onset / np.maximum(amplitude, onset), -1, 1))
jenkins_real = contact.initial_stiffness / np.pi * (angle - 0.5 * np.sin(2 * angle))
jenkins_imag = 4 * contact.slip_force / (np.pi * amplitude) * np.maximum(1 - onset / amplitude, 0)

figure, (left, right) = plt.subplots(1, 2, figsize=(9, 4), layout="constrained")
left.semilogx(1e6 * amplitude, 1e-6 * stiffness.k_real, label="microslip")
left.semilogx(1e6 * amplitude, 1e-6 * jenkins_real, "--", label="Jenkins element")
left.set(xlabel="amplitude (µm)", ylabel="K' (N/µm)")
left.legend()
right.loglog(1e6 * amplitude, stiffness.k_imag / stiffness.k_real)
right.loglog(1e6 * amplitude, jenkins_imag / jenkins_real, "--")
right.set(xlabel="amplitude (µm)", ylim=(1e-5, None), ylabel="loss factor K''/K'")
figure.savefig(DIRECTORY / "stiffness.png")

# %% [markdown]
# ## Forced response
# One mass on a spring and the contact, one harmonic: |K + K' - m w^2 + i (c w + K'')| a = F has, for each amplitude a, at most two
# solutions w^2. The spring is as stiff as the contact, the damping ratio without it 0.1 %.

# %%
mass, spring = 0.5, contact.initial_stiffness
damping = 2 * 1e-3 * np.sqrt(spring * mass)
amplitude = np.geomspace(0.02, 20, 4000) * slip
stiffness = contact.complex_stiffness(amplitude)
total = spring + stiffness.k_real

figure, axes = plt.subplots(layout="constrained")
for share in [0.05, 0.2, 0.4, 0.6]:
    # m^2 x^2 - (2 m (K + K') - c^2) x + (K + K')^2 + K''^2 - (F/a)^2 = 0, x = w^2; c w K'' is small and left out.
    b = total / mass - damping**2 / (2 * mass**2)
    rest = (total**2 + stiffness.k_imag**2 - (share * contact.slip_force / amplitude) ** 2) / mass**2
    root = np.sqrt(np.where(b**2 - rest > 0, b**2 - rest, np.nan))
    frequency = np.sqrt(np.maximum(np.concatenate([b - root, (b + root)[::-1]]), 0)) / (2 * np.pi)
    relative = np.concatenate([amplitude, amplitude[::-1]]) * spring / (share * contact.slip_force)
    known = ~np.isnan(frequency)
    axes.semilogy(1e-3 * frequency[known], relative[known], label=f"{share}")
axes.set(xlim=(4, 9), ylim=(0.5, None), xlabel="frequency (kHz)", ylabel="amplitude of the spring force / F")
axes.legend(title="F / slip force")
figure.savefig(DIRECTORY / "response.png")

# %% [markdown]
# ## Varying normal force
# The normal force swings around 400 N by half of it, in phase with the displacement or a quarter of a period ahead.

# %%
element = microslip.Element(**PARAMETERS, normal_input=microslip.INPUT_NORMAL_FORCE)
time = 2 * np.pi * np.arange(3 * 200) / 200
figure, axes = plt.subplots(layout="constrained")
for phase, label in [(None, "constant"), (0, "in phase"), (np.pi / 2, "a quarter of a period ahead")]:
    swing = 0 if phase is None else 0.5 * np.cos(time + phase)
    path = np.column_stack([0.8 * slip * np.cos(time), 400 * (1 + swing) * np.ones_like(time)])
    step = element.update(microslip.ElementState(), path)
    axes.plot(1e6 * path[-201:, 0], step.force[-201:, 0], label=label)
axes.set(xlabel="displacement (µm)", ylabel="force (N)")
axes.legend(title="normal force")
figure.savefig(DIRECTORY / "varying.png")
