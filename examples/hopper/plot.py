#!/usr/bin/env python3
# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""Pictures of the hopper over opening and discharge: plot.py [folder], after the run."""

import glob
import os
import sys

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

folder = sys.argv[1] if len(sys.argv) > 1 else "."
pictures = sorted(glob.glob(os.path.join(folder, "hopper.*.png")))
step, time, opening, out = np.loadtxt(os.path.join(folder, "trace.txt")).T

figure = plt.figure(figsize=(10, 6.6), layout="constrained")
grid = figure.add_gridspec(2, 4, height_ratios=(2.1, 1))
for k, number in enumerate((0, 5, 9, 20)):
    axes = figure.add_subplot(grid[0, k])
    picture = plt.imread(pictures[number])
    axes.imshow(picture[60:-50, 50:-50])
    axes.set_title("%.2f s" % np.interp(int(pictures[number].split(".")[-2]), step, time), fontsize=10)
    axes.axis("off")

left = figure.add_subplot(grid[1, :])
left.plot(time, opening, color="tab:blue")
left.set_xlabel("time (s)")
left.set_ylabel("opening (mm)", color="tab:blue")
left.axvline(0.25, color="k", ls=":", lw=1)
left.text(0.255, 118, "gate opens")
left.set_xlim(0, time[-1])
right = left.twinx()
right.plot(time, out, color="tab:orange")
right.set_ylabel("grains that have left", color="tab:orange")
right.set_ylim(0, None)
figure.savefig("hopper.png", dpi=100)
