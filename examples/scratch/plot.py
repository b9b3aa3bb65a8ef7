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

DEPTH = 0.15    # of in.scratch (mm)
folder = sys.argv[1] if len(sys.argv) > 1 else "."
picture = matplotlib.image.imread(sorted(glob.glob(os.path.join(folder, "scratch.*.png")))[-1])

# columns at several times: coordinates of the middle, number of points (8 for each cell)
with open(os.path.join(folder, "heights.txt")) as file:
    rows = [row.split() for row in file if not row.startswith("#")]
last = max(k for k, row in enumerate(rows) if len(row) == 3)    # heading of the last of them
columns = np.array(rows[last + 1:], float)
x, y = 1e3 * columns[:, 1], 1e3 * columns[:, 2]
nx, ny = len(np.unique(x)), len(np.unique(y))
h = x.max() / (nx - 0.5)
height = (columns[:, 3] * h / 8.0).reshape(nx, ny)
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
image = above.imshow(both.T, extent=(0, nx * h, -ny * h, ny * h), cmap="RdBu_r", vmin=-1, vmax=1, origin="lower",
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
curve.set(xlabel="way of the cone / depth", ylabel="force (kN)", xlim=(0, None), ylim=(0, 3.2))
curve.legend(loc="upper left", fontsize=8, ncol=2)
figure.savefig(os.path.join(folder, "scratch.png"), dpi=100)
