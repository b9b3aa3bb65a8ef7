#!/usr/bin/env python3
# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""Four pictures of the flow, and what the barrier bears: plot.py [folder], after the run."""

import os
import sys

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

folder = sys.argv[1] if len(sys.argv) > 1 else "."
step, time, tip, push, front = np.loadtxt(os.path.join(folder, "trace.txt")).T

figure = plt.figure(figsize=(10, 8.6), layout="constrained")
grid = figure.add_gridspec(3, 2, height_ratios=(1.4, 1.4, 1))
for k, number in enumerate((0, 1200, 2100, 3300)):
    axes = figure.add_subplot(grid[k // 2, k % 2])
    axes.imshow(plt.imread(os.path.join(folder, "debris.%05d.png" % number))[10:-105])
    axes.set_title("%.2f s" % np.interp(number, step, time), fontsize=10)
    axes.axis("off")
left = figure.add_subplot(grid[2, :])
left.plot(time, 1e3 * tip, color="tab:blue")
left.set_xlabel("time (s)")
left.set_ylabel("deflection of the barrier (mm)", color="tab:blue")
left.set_xlim(0, time[-1])
right = left.twinx()
right.plot(time, push, color="tab:red")
right.set_ylabel("force on its foot (kN)", color="tab:red")
figure.savefig("boulders-in-debris.png", dpi=100)
