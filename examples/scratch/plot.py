#!/usr/bin/env python3
# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""The scratch, heights of its surface, and forces over the way of the cone: plot.py [folder], after runs with mu = 0, 0.1, 0.3
of which that with 0.1 is the last."""

import glob
import os
import sys

import matplotlib
matplotlib.use("Agg")
import matplotlib.image
import matplotlib.pyplot as plt
import numpy as np

DEPTH, H = 0.2, 0.1    # of in.scratch (mm)
folder = sys.argv[1] if len(sys.argv) > 1 else "."
picture = matplotlib.image.imread(sorted(glob.glob(os.path.join(folder, "scratch.*.png")))[-1])

# heights: volumes of points over columns, of which each gives its parts to the four nearest ones
with open(os.path.join(folder, "points.txt")) as file:
    rows = file.read().splitlines()
start = next(k for k, row in enumerate(rows) if row.startswith("ITEM: ATOMS"))
_, x, y, mass = np.array([row.split() for row in rows[start + 1:]], float).T
x, y, volume = 1e3 * x, 1e3 * y, 1e9 * mass / 7830.0
nx, ny = (int(round(1e3 * end / H)) for end in (float(rows[start - k].split()[1]) for k in (3, 2)))
height = np.zeros((nx + 2, ny + 2))
i, j = np.floor(x / H - 0.5).astype(int), np.floor(y / H - 0.5).astype(int)
u, v = x / H - 0.5 - i, y / H - 0.5 - j
for a, b, part in ((0, 0, (1 - u) * (1 - v)), (1, 0, u * (1 - v)), (0, 1, (1 - u) * v), (1, 1, u * v)):
    np.add.at(height, (i + 1 + a, j + 1 + b), part * volume / H**2)
height[1], height[-2] = height[1] + height[0], height[-2] + height[-1]
height[:, 1], height[:, -2] = height[:, 1] + height[:, 0], height[:, -2] + height[:, -1]
height = height[1:-1, 1:-1]
height -= np.median(height[:, -1])

figure = plt.figure(figsize=(9, 7.2), layout="constrained")
grid = figure.add_gridspec(2, 2, height_ratios=(1.1, 1), width_ratios=(1.25, 1))
view = figure.add_subplot(grid[0, :])
dark = np.argwhere(picture[:, :, :3].min(axis=2) < 0.99)
(top, left), (bottom, right) = dark.min(axis=0), dark.max(axis=0)
view.imshow(picture[top:bottom + 1, left:right + 1])
view.set_axis_off()
view.set_title("one half of the block: equivalent plastic strain, 0 (blue) to 2 (red)", fontsize=10)

above = figure.add_subplot(grid[1, 0])
both = np.concatenate([height[:, ::-1], height], axis=1) / DEPTH
image = above.imshow(both.T, extent=(0, nx * H, -ny * H, ny * H), cmap="RdBu_r", vmin=-1, vmax=1, origin="lower",
                     interpolation="bilinear")
figure.colorbar(image, ax=above, label="height / depth", shrink=0.8)
above.set(xlabel="x (mm)", ylabel="y (mm)")

curve = figure.add_subplot(grid[1, 1])
for mu, color in (("0", "tab:blue"), ("0.1", "tab:green"), ("0.3", "tab:red")):
    path = os.path.join(folder, "forces.%s.txt" % mu)
    if os.path.exists(path):
        way, normal, tangential = np.loadtxt(path, usecols=(1, 2, 3)).T
        curve.plot(way, 1e-3 * normal, color=color, label="friction %s" % mu)
        curve.plot(way, 1e-3 * tangential, "--", color=color)
curve.plot([], [], "k--", label="tangential")
curve.plot([], [], "k-", label="normal")
curve.set(xlabel="way of the cone / depth", ylabel="force (kN)", xlim=(0, None), ylim=(0, 4.2))
curve.legend(loc="upper left", fontsize=8, ncol=2)
figure.savefig(os.path.join(folder, "scratch.png"), dpi=100)
