#!/usr/bin/env python3
# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""Section through the bar at three times, the last with the experiment: plot.py [folder], after the run."""

import os
import sys

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "..", "tools"))

from picture import cut, read_series, row, usual_distance

folder = sys.argv[1] if len(sys.argv) > 1 else "."
EXPERIMENT = np.array([(6.75, 0.0), (5.05, 5.08), (3.8, 16.2)])   # half width (mm) at a height; README.md

first, middle = read_series(os.path.join(folder, "bar.pvd"))[:2]
last = read_series(os.path.join(folder, "final.vtp"))[0]
diameter = 1.5 * usual_distance(first.x)

# the layer next to the plane y = 0, in the first snapshot; points stand for what the cubes around them have become
y = first.x[:, 1]
near = abs(y - y[np.argmin(abs(y))]) < 0.1 * usual_distance(first.x)
series = []
for snapshot in (first, middle, last):
    snapshot.fields["near"] = near
    series.append(cut(snapshot, "near").show_in("mm", "us"))

figure, grid = plt.subplots(1, 3, figsize=(9.5, 5.4), layout="constrained", sharex=True, sharey=True)
disks = row(grid, series, "eplastic", diameter, limits=(0.0, 1.6), deformed=True, box=((-8.2, -0.6), (8.2, 26.2)))
for axes in grid:
    axes.axhline(0.0, color="black", lw=2)
for side in (-1, 1):
    grid[2].plot(side * EXPERIMENT[:, 0], EXPERIMENT[:, 1], "rs", ms=7, mfc="none", mew=2,
                 label="experiment" if side > 0 else None)
grid[2].legend(loc="upper center")
figure.colorbar(disks, ax=grid, label="equivalent plastic strain", shrink=0.8, pad=0.01)
figure.suptitle("Copper bar, 190 m/s, on a lattice that belongs to the undeformed bar")
figure.savefig(os.path.join(folder, "taylor-bar-total.png"), dpi=80)
