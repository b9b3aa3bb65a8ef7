# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
"""Motion of the surface with layers (half-space.layers.txt), and, if they are there, with dashpots, walls, and in a large body
(large/half-space.none.txt), and the velocities at half of the time (half-space.layers.dump): half-space.png"""

import os

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

CS, APART = 200.0, 12.0    # speed of shear waves, distance of the two receivers


def rayleigh(nu):
    """speed of surface waves over that of shear waves"""
    k = (1 - 2 * nu) / (2 - 2 * nu)
    roots = np.roots([1.0, -8.0, 24.0 - 16.0 * k, -16.0 * (1.0 - k)])
    return np.sqrt(min(r.real for r in roots if abs(r.imag) < 1e-12 and 0 < r.real < 1))


def curve(name):
    _, t, near, there, along, _ = np.loadtxt(name).T
    return t, near, there, along


def arrival(t, y):
    """time of the lowest place, between the steps"""
    k = np.argmin(y)
    a, b, c = y[k - 1:k + 2]
    return t[k] + 0.5 * (a - c) / (a - 2 * b + c) * (t[k + 1] - t[k])


t, near, there, _ = curve("half-space.layers.txt")
speed = APART / (arrival(t, there) - arrival(t, near))
print("surface wave: %.1f m/s, Rayleigh %.1f m/s" % (speed, rayleigh(0.25) * CS))
large = curve("large/half-space.none.txt") if os.path.exists("large/half-space.none.txt") else None
figure = plt.figure(figsize=(9, 6.5))
top = figure.add_subplot(2, 1, 1)
if large:
    top.plot(large[0], large[2], color="0.75", lw=4, label="ground of 300 m")
for far, style in (("none", ":"), ("dashpots", "--"), ("layers", "k-")):
    name = "half-space.%s.txt" % far
    if not os.path.exists(name):
        continue
    t, near, there, _ = curve(name)
    if large:
        off = np.interp(t, large[0], large[2]) - there
        print("%s: largest difference %.4f of the largest motion" % (far, abs(off).max() / abs(large[2]).max()))
    top.plot(t, there, style, label={"none": "walls", "dashpots": "dashpots", "layers": "matched layers"}[far])
top.set(xlabel="time (s)", ylabel="height of the surface 24 m away (mm)", xlim=(0, 0.5))
top.legend(fontsize=8)
bottom = figure.add_subplot(2, 1, 2)
with open("half-space.layers.dump") as file:
    n = int(file.readlines()[3])
x, y, v = np.loadtxt("half-space.layers.dump", skiprows=9, usecols=(1, 2, 3), max_rows=n).T
most = np.quantile(abs(v), 0.99)
dots = bottom.scatter(x, y, c=1000 * v, s=1.5, vmin=-1000 * most, vmax=1000 * most, cmap="RdBu_r")
bottom.plot([-30, -30, 30, 30], [0, -30, -30, 0], "k:", lw=1)
bottom.set(aspect="equal", xlabel="x (m)", ylabel="y (m)")
figure.colorbar(dots, ax=bottom, label="velocity along y (mm/s)")
figure.tight_layout()
figure.savefig("half-space.png", dpi=100)
