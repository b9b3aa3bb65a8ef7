# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
"""Profiles at the end of the run (profile.txt) and the exact solution: shock-tube.png"""

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

GAMMA, TIME = 1.4, 0.2


def exact(s):
    """Density, velocity, pressure at (x - 0.5)/t = s: rarefaction on the left, shock on the right."""
    g, c_left = GAMMA, np.sqrt(GAMMA)
    low, high = 0.1, 1.0
    for _ in range(100):    # pressure between the waves, where both give the same velocity
        p = 0.5 * (low + high)
        left = 2 * c_left / (g - 1) * (1 - p ** ((g - 1) / (2 * g)))
        right = (p - 0.1) * np.sqrt(2 / 0.125 / ((g + 1) * p + (g - 1) * 0.1))
        low, high = (p, high) if left > right else (low, p)
    u, rho_left, k = right, p ** (1 / g), (g - 1) / (g + 1)
    rho_right = 0.125 * (p / 0.1 + k) / (k * p / 0.1 + 1)
    shock = rho_right * u / (rho_right - 0.125)
    tail = u - np.sqrt(g * p / rho_left)
    c = 2 / (g + 1) * (c_left - 0.5 * (g - 1) * s)    # in the rarefaction
    fan = [c ** 2 / g, s + c, 0]
    fan[0] = (c / c_left) ** (2 / (g - 1))
    fan[2] = (c / c_left) ** (2 * g / (g - 1))
    where = [s < -c_left, s < tail, s < u, s < shock]
    return [np.select(where, states, last) for states, last in (
        ([1.0, fan[0], rho_left, rho_right], 0.125), ([0.0, fan[1], u, u], 0.0),
        ([1.0, fan[2], p, p], 0.1))]


x, vx, pressure, density = np.loadtxt("profile.txt", skiprows=9, usecols=(1, 2, 3, 4)).T
line = np.linspace(0, 1, 2000)
figure, axes = plt.subplots(1, 3, figsize=(10, 3))
for axis, name, points, curve in zip(axes, ("density", "velocity", "pressure"),
                                     (density, vx, pressure), exact((line - 0.5) / TIME)):
    axis.plot(x, points, ".", ms=2, label="points")
    axis.plot(line, curve, "k-", lw=0.8, label="exact")
    axis.set(xlabel="x", title=name)
axes[0].legend()
figure.tight_layout()
figure.savefig("shock-tube.png", dpi=100)
