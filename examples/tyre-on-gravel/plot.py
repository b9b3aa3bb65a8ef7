#!/usr/bin/env python3
# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""The wheel on its way, and its speed and height: plot.py [folder], after the run."""

import os
import sys

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

R = 0.3
folder = sys.argv[1] if len(sys.argv) > 1 else "."
step, time, speed, omega, height = np.loadtxt(os.path.join(folder, "trace.txt")).T

figure = plt.figure(figsize=(10, 7.4), layout="constrained")
grid = figure.add_gridspec(2, 2, height_ratios=(2.6, 1))
axes = figure.add_subplot(grid[0, :])
axes.imshow(plt.imread(os.path.join(folder, "tyre.02000.png"))[60:-20, 20:-20])
axes.axis("off")
left = figure.add_subplot(grid[1, 0])
left.plot(time, omega * R, color="tab:orange", label="tread")
left.plot(time, speed, color="tab:blue", label="axle")
left.set(xlabel="time (s)", ylabel="speed (m/s)", xlim=(0, time[-1]), ylim=(0, None))
left.legend(loc="lower right")
right = figure.add_subplot(grid[1, 1])
right.plot(time, 1e3 * height, color="tab:green")
right.set(xlabel="time (s)", ylabel="height of the axle less R (mm)", xlim=(0, time[-1]))
figure.savefig("tyre-on-gravel.png", dpi=100)
