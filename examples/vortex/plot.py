#!/usr/bin/env python3
# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""The ring when it is turned most and at the end, its error, and its angle with the exact one: plot.py [folder],
after the run."""

import os
import sys

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "..", "tools"))

from picture import read_series, row, usual_distance

folder = sys.argv[1] if len(sys.argv) > 1 else "."
ANGLE = 0.1    # G of the input
series = read_series(os.path.join(folder, "vortex.pvd"), (0.25, 0.5, 1.0))
diameter = 1.25 * usual_distance(series[0].x)


def exact(R, time):
    """Angle by which the material at a radius has turned."""
    return 0.5 * ANGLE * (1 - np.cos(2 * np.pi * time)) * (1 - 32 * (R - 1)**2 + 256 * (R - 1)**4)


for snapshot in series:
    X, Y = snapshot.fields["v_X"], snapshot.fields["v_Y"]
    x, y = snapshot.x[:, 0], snapshot.x[:, 1]
    snapshot.fields["R"] = np.hypot(X, Y)
    snapshot.fields["turned"] = np.angle((x + 1j * y) * (X - 1j * Y))
    snapshot.fields["sector"] = np.floor(6 * np.arctan2(Y, X) / np.pi) % 2
    snapshot.fields["error"] = 1e3 * np.hypot(x - snapshot.fields["v_ex"], y - snapshot.fields["v_ey"])

figure, grid = plt.subplots(1, 3, figsize=(11, 3.9), layout="constrained")
turned, end = series[1], series[2]
row(grid[:1], [turned], "sector", diameter, "xy", "Blues", (-0.6, 1.6), deformed=True, box=((-1.4, -1.4), (1.4, 1.4)))
R = np.linspace(0.75, 1.25, 50)
for k in range(12):
    line = R * np.exp(1j * (k * np.pi / 6 + exact(R, 0.5)))
    grid[0].plot(line.real, line.imag, "r", lw=1, label="exact" if k == 0 else None)
grid[0].legend(loc="center")
disks = row(grid[1:2], [turned], "error", diameter, "xy", "magma_r", deformed=True, box=((-1.4, -1.4), (1.4, 1.4)))
figure.colorbar(disks, ax=grid[1], label="error of the position (mm)", shrink=0.75, pad=0.01)
for snapshot, color in zip(series, ("C0", "C3", "C2")):
    grid[2].plot(snapshot.fields["R"], snapshot.fields["turned"], color + ".", ms=2.5)
    grid[2].plot(R, exact(R, snapshot.time), color, lw=1)
    grid[2].text(1.0, exact(1.0, snapshot.time) + 0.013, snapshot.when(), color=color, ha="center", va="bottom")
grid[2].set(xlabel="radius at the start (m)", ylabel="turned by (radians)", title="points; lines: exact")
grid[2].set(ylim=(-0.03, 0.13), box_aspect=1.0)
figure.suptitle("A ring that body forces swirl to and fro")
figure.savefig(os.path.join(folder, "vortex.png"), dpi=85)
