#!/usr/bin/env python3
# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""Pictures of water and plate, and the path of the end of the plate: plot.py [folder], after the run."""

import glob
import os
import sys

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

# Idelsohn et al. 2008, some points of their curve
TIME = (0.10, 0.14, 0.16, 0.18, 0.20, 0.22, 0.25, 0.28, 0.32, 0.36, 0.40)
PARTICLE_FEM = (-0.3, 2.4, 9.3, 24.3, 36.4, 44.5, 48.3, 45.7, 39.0, 30.9, 23.9)

folder = sys.argv[1] if len(sys.argv) > 1 else "."
t, ux, uy = np.loadtxt(os.path.join(folder, "plate.txt")).T
for time, theirs in zip(TIME, PARTICLE_FEM):
    print("t = %.2f s: u_x = %.1f (%.1f) mm" % (time, np.interp(time, t, ux), theirs))
print("largest u_x = %.1f mm at t = %.3f s" % (ux.max(), t[ux.argmax()]))

files = sorted(glob.glob(os.path.join(folder, "plate.*.dump")))
figure = plt.figure(figsize=(10, 7), layout="constrained")
grid = figure.add_gridspec(2, 3, height_ratios=(1, 1.1))
for k, wanted in enumerate((0.15, 0.25, 0.35)):
    place = min(len(files) - 1, round(wanted / 0.05))
    data = np.loadtxt(files[place], skiprows=9)
    water, plate = data[data[:, 1] == 1], data[data[:, 1] == 2]
    axes = figure.add_subplot(grid[0, k])
    shades = axes.scatter(1000 * water[:, 2], 1000 * water[:, 3], c=water[:, 4] / 1000, s=1.2, cmap="viridis",
                          vmin=0, vmax=2, linewidths=0)
    axes.scatter(1000 * plate[:, 2], 1000 * plate[:, 3], c="C3", s=1.5, linewidths=0)
    axes.set_title("t = %.2f s" % (0.05 * place), fontsize=10)
    axes.set_aspect("equal")
    axes.set_xlim(0, 584)
    axes.set_ylim(0, 420)
    axes.set_xticks([])
    axes.set_yticks([])
figure.colorbar(shades, ax=figure.axes[:3], location="right", label="pressure (kPa)", shrink=0.8)

axes = figure.add_subplot(grid[1, :])
axes.axhline(0, color="0.8", lw=1)
axes.plot(t, ux, "C0", label="material points")
axes.plot(TIME, PARTICLE_FEM, "ko", ms=5, label="particle finite elements, Idelsohn et al. 2008")
axes.set_xlabel("time (s)")
axes.set_ylabel("$u_x$ of the end of the plate (mm)")
axes.set_xlim(0, 0.41)
axes.legend(loc="upper left")
figure.savefig(os.path.join(folder, "elastic-plate.png"), dpi=90)
