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

# some points of the curves of Idelsohn et al. 2008 and of Walhorn et al. 2005
TIME = (0.10, 0.14, 0.16, 0.18, 0.20, 0.22, 0.25, 0.28, 0.32, 0.36, 0.40, 0.45, 0.50, 0.55, 0.60, 0.62, 0.64, 0.66,
        0.69, 0.72, 0.76, 0.80, 0.83, 0.86, 0.89)
PARTICLE_FEM = (-0.3, 2.4, 9.3, 24.3, 36.4, 44.5, 48.3, 45.7, 39.0, 30.9, 23.9, 18.5, 17.1, 17.8, 16.0, 9.9, -1.1, -7.3,
                -10.3, -7.7, 1.0, 11.6, 13.2, 2.4, -10.6)
SPACE_TIME = ((0.160, 0.170, 0.180, 0.190, 0.201, 0.213, 0.230, 0.246, 0.269, 0.294, 0.316, 0.339, 0.364, 0.399, 0.438,
               0.479, 0.524, 0.565, 0.601, 0.633, 0.656, 0.672, 0.688, 0.705, 0.723, 0.737, 0.755, 0.772, 0.788, 0.818,
               0.842),
              (0.8, 5.6, 14.1, 22.8, 30.9, 37.1, 41.4, 41.4, 38.4, 32.5, 27.2, 22.1, 17.1, 12.9, 9.1, 5.7, 3.0, 6.6,
               14.0, 18.1, 15.4, 10.0, 2.4, -4.9, -10.4, -11.3, -8.2, -1.7, 5.7, 12.4, 7.6))

folder = sys.argv[1] if len(sys.argv) > 1 else "."
t, ux, uy = np.loadtxt(os.path.join(folder, "plate.txt")).T
for time, theirs in zip(TIME, PARTICLE_FEM):
    print("t = %.2f s: u_x = %.1f (%.1f) mm" % (time, np.interp(time, t, ux), theirs))
print("largest u_x = %.1f mm at t = %.3f s" % (ux.max(), t[ux.argmax()]))

files = sorted(glob.glob(os.path.join(folder, "plate.*.dump")))
figure = plt.figure(figsize=(10, 9), layout="constrained")
grid = figure.add_gridspec(3, 3, height_ratios=(1, 1, 1.3))
for k, wanted in enumerate((0.15, 0.25, 0.35, 0.55, 0.65, 0.75)):
    place = min(len(files) - 1, round(wanted / 0.05))
    data = np.loadtxt(files[place], skiprows=9)
    water, plate = data[data[:, 1] == 1], data[data[:, 1] == 2]
    axes = figure.add_subplot(grid[k // 3, k % 3])
    shades = axes.scatter(1000 * water[:, 2], 1000 * water[:, 3], c=water[:, 4] / 1000, s=1.2, cmap="viridis",
                          vmin=0, vmax=2, linewidths=0)
    axes.scatter(1000 * plate[:, 2], 1000 * plate[:, 3], c="C3", s=1.5, linewidths=0)
    axes.set_title("t = %.2f s" % (0.05 * place), fontsize=10)
    axes.set_aspect("equal")
    axes.set_xlim(0, 584)
    axes.set_ylim(0, 420)
    axes.set_xticks([])
    axes.set_yticks([])
figure.colorbar(shades, ax=figure.axes[:6], location="right", label="pressure (kPa)", shrink=0.6)

axes = figure.add_subplot(grid[2, :])
axes.axhline(0, color="0.8", lw=1)
axes.plot(t, ux, "C0", label="material points")
axes.plot(TIME, PARTICLE_FEM, "ko", ms=5, label="particle finite elements, Idelsohn et al. 2008")
axes.plot(*SPACE_TIME, "s", color="0.6", mfc="none", ms=4, label="space-time finite elements, Walhorn et al. 2005")
axes.set_xlabel("time (s)")
axes.set_ylabel("$u_x$ of the end of the plate (mm)")
axes.set_xlim(0, 0.91)
axes.legend(loc="upper right")
figure.savefig(os.path.join(folder, "elastic-plate.png"), dpi=90)
