#!/usr/bin/env python3
# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""Shape of the bar after the impact, measured and drawn: plot.py [folder], after the run."""

import os
import sys

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

folder = sys.argv[1] if len(sys.argv) > 1 else "."
with open(os.path.join(folder, "final.dump")) as file:
    lines = file.read().split("\n")
start = next(k for k, line in enumerate(lines) if line.startswith("ITEM: ATOMS"))
rows = np.array([[float(word) for word in line.split()] for line in lines[start + 1:] if line])
r, z, strain, volume = 1e3 * rows[:, 1], 1e3 * rows[:, 2], rows[:, 3], 1e9 * rows[:, 5]
F = rows[:, 6:15].reshape(-1, 3, 3)

# a point was a square in the plane; half of its edge from the area of now
area = volume / (2 * np.pi * r)
half = 0.5 * np.sqrt(area / (F[:, 0, 0] * F[:, 1, 1] - F[:, 0, 1] * F[:, 1, 0]))
length = np.max(z + half * np.hypot(F[:, 1, 0], F[:, 1, 1]))
diameter = 2 * np.max(r + half * np.hypot(F[:, 0, 0], F[:, 0, 1]))
window = np.clip(1 - np.abs(z - 0.2 * 25.4) / 0.4, 0, None) / 0.4
width = np.sqrt(4 / np.pi * np.sum(volume * window))
print("length %.2f mm, diameter %.2f mm, width at 0.2 of the initial length %.2f mm, "
      "largest plastic strain %.2f" % (length, diameter, width, strain.max()))

figure, axes = plt.subplots(figsize=(5.4, 5.6), layout="constrained")
axes.plot([-3.8, 3.8, 3.8, -3.8, -3.8], [0, 0, 25.4, 25.4, 0], "0.75", lw=0.8, label="before")
order = np.argsort(strain)
for side in (-1, 1):
    dots = axes.scatter(side * r[order], z[order], c=strain[order], s=8, cmap="turbo", vmin=0,
                        vmax=1.6, linewidths=0)
axes.plot([-6.74, 6.74], [0.1, 0.1], "k|", ms=10, mew=1.5, label="finite elements")
axes.plot([-5.08, 5.08], [5.08, 5.08], "k|", ms=10, mew=1.5)
axes.plot(0, 16.27, "k_", ms=14, mew=1.5)
axes.axhline(0, color="0.4", lw=2)
axes.set_aspect("equal")
axes.set_xlim(-8.5, 8.5)
axes.set_ylim(-0.6, 26.2)
axes.set_xlabel("r (mm)")
axes.set_ylabel("z (mm)")
axes.legend(loc="upper right", fontsize=8, frameon=False)
figure.colorbar(dots, shrink=0.7, label="equivalent plastic strain")
figure.savefig(os.path.join(folder, "taylor-bar-axisymmetric.png"), dpi=110)
