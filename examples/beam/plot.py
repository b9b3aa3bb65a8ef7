#!/usr/bin/env python3
# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""Beam at three times and the way of its tip: plot.py [folder], after the run."""

import os
import sys

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

folder = sys.argv[1] if len(sys.argv) > 1 else "."
t, tip = np.loadtxt(os.path.join(folder, "trace.txt"), usecols=(1, 2)).T

STEPS = (500, 1500, 3500)
pictures = [plt.imread(os.path.join(folder, "beam.%05d.png" % step)) for step in STEPS]
drawn = np.any([picture[:, :, :3].min(axis=2) < 0.9 for picture in pictures], axis=0)
rows, columns = np.flatnonzero(drawn.any(axis=1)), np.flatnonzero(drawn.any(axis=0))
part = (slice(rows[0], rows[-1] + 2), slice(columns[0], columns[-1] + 2))

figure = plt.figure(figsize=(9, 6.0), layout="constrained")
grid = figure.add_gridspec(2, 3, height_ratios=(1.15, 1))
for k, (step, picture) in enumerate(zip(STEPS, pictures)):
    axes = figure.add_subplot(grid[0, k])
    axes.imshow(picture[part])
    axes.set_axis_off()
    axes.set_title("%.2f s" % (0.0007 * step), fontsize=10)
curve = figure.add_subplot(grid[1, :])
curve.plot(t, tip, "C0", label="material points")
curve.plot([1.048, 2.63], [-3.303, 0.04], "C3o", label="finite elements: lowest and highest point")
curve.axhline(0, color="k", lw=0.5)
curve.set_xlabel("time (s)")
curve.set_ylabel("displacement of the lower corner (m)")
curve.set_xlim(0, t[-1])
curve.legend(loc="lower right")
figure.savefig(os.path.join(folder, "beam.png"), dpi=90)
