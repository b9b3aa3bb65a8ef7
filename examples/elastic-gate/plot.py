#!/usr/bin/env python3
# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""Pictures of water and gate, and the path of the end of the gate: plot.py [folder], after the run."""

import glob
import os
import sys

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

TIME = (0.04, 0.08, 0.12, 0.16, 0.20, 0.24, 0.28, 0.32, 0.36)
EXPERIMENT_X = (12.5, 34.0, 44.0, 46.4, 44.2, 43.0, 41.2, 40.0, 37.4)
EXPERIMENT_Y = (1.1, 10.0, 15.1, 17.1, 16.0, 13.9, 12.8, 12.0, 10.9)

folder = sys.argv[1] if len(sys.argv) > 1 else "."
t, ux, uy = np.loadtxt(os.path.join(folder, "gate.txt")).T
x, y = np.interp(TIME, t, ux), np.interp(TIME, t, uy)
for row in zip(TIME, x, EXPERIMENT_X, y, EXPERIMENT_Y):
    print("t = %.2f s: u_x = %.1f (%.1f) mm, u_y = %.1f (%.1f) mm" % row)
early = np.array(TIME) <= 0.16
print("largest u_x = %.1f mm at t = %.3f s; rms of u_x to t = 0.16 s: %.1f mm" %
      (ux.max(), t[ux.argmax()], np.sqrt(np.mean((x - EXPERIMENT_X)[early] ** 2))))

files = sorted(glob.glob(os.path.join(folder, "gate.*.dump")))
figure = plt.figure(figsize=(10, 6.6), layout="constrained")
grid = figure.add_gridspec(2, 6, height_ratios=(1, 1.15))
for k, wanted in enumerate((0.04, 0.12, 0.28)):
    place = min(len(files) - 1, round(wanted / 0.04))
    data = np.loadtxt(files[place], skiprows=9)
    water, gate = data[data[:, 1] == 1], data[data[:, 1] == 2]
    axes = figure.add_subplot(grid[0, 2 * k:2 * k + 2])
    shades = axes.scatter(1000 * water[:, 2], 1000 * water[:, 3], c=water[:, 4] / 1000, s=2.2,
                          cmap="viridis", vmin=0, vmax=1.2, linewidths=0)
    axes.scatter(1000 * gate[:, 2], 1000 * gate[:, 3], c="C3", s=3, linewidths=0)
    axes.fill([100, 105, 105, 100], [79, 79, 160, 160], color="0.4")
    axes.set_title("t = %.2f s" % (0.04 * place), fontsize=10)
    axes.set_aspect("equal")
    axes.set_xlim(0, 220)
    axes.set_ylim(0, 145)
    axes.set_xticks([])
    axes.set_yticks([])
figure.colorbar(shades, ax=figure.axes[:3], location="right", label="pressure (kPa)", shrink=0.9)

for k, (mine, theirs, name) in enumerate(((ux, EXPERIMENT_X, "u_x"), (uy, EXPERIMENT_Y, "u_y"))):
    axes = figure.add_subplot(grid[1, 3 * k:3 * k + 3])
    axes.plot(t, mine, "C0", label="material points")
    axes.plot(TIME, theirs, "ko", ms=5, label="experiment")
    axes.set_xlabel("time (s)")
    axes.set_ylabel("$%s$ of the end of the gate (mm)" % name)
    axes.set_ylim(bottom=0)
    axes.set_xlim(0, 0.37)
    axes.legend(loc="lower right")
figure.savefig(os.path.join(folder, "elastic-gate.png"), dpi=90)
