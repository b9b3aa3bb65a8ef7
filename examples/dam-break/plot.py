#!/usr/bin/env python3
# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""Water at three times, front and height over time with the experiment: plot.py [folder], after the run."""

import os
import sys

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

folder = sys.argv[1] if len(sys.argv) > 1 else "."
step, T, Z, H = np.loadtxt(os.path.join(folder, "trace.txt")).T

# Martin and Moyce (1952), tables 2 and 6; tau = T/sqrt(2)
front = np.array([(0.41, 1.11), (0.84, 1.22), (1.19, 1.44), (1.43, 1.67), (1.63, 1.89), (1.83, 2.11),
                  (1.98, 2.33), (2.20, 2.56), (2.32, 2.78), (2.51, 3.00), (2.65, 3.22), (2.83, 3.44),
                  (2.98, 3.67), (3.11, 3.89), (3.33, 4.11)])
height = np.array([(0.56, 0.94), (0.77, 0.89), (0.93, 0.83), (1.08, 0.78), (1.28, 0.72),
                   (1.46, 0.67), (1.66, 0.61), (1.84, 0.56), (2.00, 0.50)])

STEPS = (0, 800, 2400)
pictures = [plt.imread(os.path.join(folder, "dam.%05d.png" % at)) for at in STEPS]
drawn = np.any([picture[:, :, :3].min(axis=2) < 0.9 for picture in pictures], axis=0)
rows, columns = np.flatnonzero(drawn.any(axis=1)), np.flatnonzero(drawn.any(axis=0))
part = (slice(rows[0], rows[-1] + 2), slice(columns[0], columns[-1] + 2))

figure = plt.figure(figsize=(10, 4.4), layout="constrained")
grid = figure.add_gridspec(3, 2, width_ratios=(1, 1.2))
for k, (at, picture) in enumerate(zip(STEPS, pictures)):
    axes = figure.add_subplot(grid[k, 0])
    axes.imshow(picture[part])
    axes.set(xticks=[], yticks=[])
    axes.spines[["top", "right"]].set_visible(False)
    axes.text(0.97, 0.8, "T = %.2f" % np.interp(at, step, T), transform=axes.transAxes, ha="right")
curve = figure.add_subplot(grid[:, 1])
curve.plot(T, Z, "C0", label="front Z, material points")
curve.plot(*front.T, "C0o", ms=4, label="experiment")
curve.plot(T, H, "C3", label="height H, material points")
curve.plot(height[:, 0] * np.sqrt(2), height[:, 1], "C3s", ms=4, label="experiment")
curve.set_xlabel("T = t sqrt(2g/a)")
curve.set_xlim(0, 3.4)
curve.set_ylim(0, 4.8)
curve.legend(loc="upper left")
figure.savefig(os.path.join(folder, "dam-break.png"), dpi=90)
