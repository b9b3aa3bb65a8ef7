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
from picture import draw, read_series

folder = sys.argv[1] if len(sys.argv) > 1 else "."
EXPERIMENT = np.array([(6.75, 0.0), (5.05, 5.08), (3.8, 16.2)])   # half width at a height; README.md

series = read_series(os.path.join(folder, "bar.pvd"))
first, middle = series[0], series[1]
last = read_series(os.path.join(folder, "final.dump"))[0]
last.fields["eplastic"] = last.fields["c_p[1]"]

# the layer next to the plane y = 0, in the first snapshot
layer = first.fields["id"][abs(first.x[:, 1]) < 1.5 * abs(first.x[:, 1]).min()]
spacing = np.diff(np.unique(first.x[:, 2].round(9)))[0]

figure, grid = plt.subplots(1, 3, figsize=(9.5, 5.2), layout="constrained", sharex=True, sharey=True)
for axes, snapshot, title in zip(grid, (first, middle, last),
                                 ("at the impact, 190 m/s", "after %.0f $\\mu$s" % (1e6 * middle.time), "after 80 $\\mu$s")):
    chosen = np.isin(snapshot.fields["id"], layer)
    snapshot.x = 1e3 * snapshot.x[chosen]
    disks = draw(axes, snapshot, snapshot.fields["eplastic"][chosen], 1.45e3 * spacing, limits=(0.0, 1.5))
    axes.axhline(0.0, color="black", lw=2)
    axes.set(xlim=(-8.2, 8.2), ylim=(-0.6, 26.2), xlabel="x (mm)", title=title)
grid[0].set_ylabel("z (mm)")
for side in (-1, 1):
    grid[2].plot(side * EXPERIMENT[:, 0], EXPERIMENT[:, 1], "rs", ms=7, mfc="none", mew=2,
                 label="experiment" if side > 0 else None)
grid[2].legend(loc="upper center")
figure.colorbar(disks, ax=grid, label="equivalent plastic strain", shrink=0.8, pad=0.01)
figure.savefig(os.path.join(folder, "taylor-bar.png"), dpi=80)
