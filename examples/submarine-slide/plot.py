#!/usr/bin/env python3
# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""Gravel and water at four times, and the surface of the water at three places: plot.py [folder], after the run."""

import os
import sys

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.colors import ListedColormap

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "..", "tools"))

from picture import cut, draw, read_series, read_table

BLUES = ListedColormap(plt.get_cmap("Blues")(np.linspace(0.25, 1.0, 256)))    # water at rest is not white


def most_amplitude(v, h=0.3, s=0.12, m=89.5, alpha=45.0, rho=1000.0, g=9.81):
    """Of the wave of a slide with speed v, thickness s, and mass m per width on a slope of alpha degrees, in water of
    depth h (V. Heller and W. H. Hager, 2010) [m]."""
    P = v / (g * h)**0.5 * (s / h)**0.5 * (m / (rho * h**2))**0.25 * np.cos(np.radians(6.0 / 7.0 * alpha))**0.5
    return 4.0 / 9.0 * P**0.8 * h


folder = sys.argv[1] if len(sys.argv) > 1 else "."
series = read_series(os.path.join(folder, "slide.pvd"), (0.0, 0.48, 0.70, 1.17))
curve = read_table(os.path.join(folder, "wave.txt"))

figure = plt.figure(figsize=(10, 8.6), layout="constrained")
grid = figure.add_gridspec(4, 2, width_ratios=(2.2, 1))
for k, snapshot in enumerate(series):
    axes = figure.add_subplot(grid[k, 0])
    water, gravel = cut(snapshot, "type == 2"), cut(snapshot, "type == 1")
    speed = np.hypot(water.fields["velocity_x"], water.fields["velocity_y"])
    disks = draw(axes, water, speed, 0.02, "xy", cmap=BLUES, limits=(0, 1.2))
    draw(axes, gravel, np.full(len(gravel.x), 0.4), 0.02, "xy", cmap="copper", limits=(0, 1))
    axes.fill([0, 1, 0], [0, 0, 1], color="0.85", zorder=0)
    axes.set(xlim=(0, 3.2), ylim=(0, 0.85), aspect="equal", title="%.2f s" % snapshot.time, ylabel="y (m)")
axes.set_xlabel("x (m)")
figure.colorbar(disks, ax=figure.axes, label="speed of the water (m/s)", shrink=0.5, location="bottom", pad=0.01)

axes = figure.add_subplot(grid[:2, 1])
time = curve["v_t"]
for name, x in (("v_near", 1.6), ("v_mid", 1.85), ("v_far", 2.35)):
    axes.plot(time, 1e3 * curve[name], label="x = %.2f m" % x)
axes.axhline(1e3 * most_amplitude(max(curve["v_speed"])), color="k", ls="--", lw=1, label="Heller and Hager, most")
axes.set(xlabel="time (s)", ylabel="surface of the water (mm)", xlim=(0, time[-1]), ylim=(-40, 180))
axes.legend(loc="upper left")
axes = figure.add_subplot(grid[2:, 1])
axes.plot(time, curve["v_speed"], "C5")
axes.set(xlabel="time (s)", ylabel="speed of the gravel along the slope (m/s)", xlim=(0, time[-1]))
figure.suptitle("Gravel slides into a lake")
figure.savefig(os.path.join(folder, "submarine-slide.png"), dpi=85)
