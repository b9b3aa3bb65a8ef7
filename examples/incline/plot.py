#!/usr/bin/env python3
# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""The bodies at three times, and their ways with those of rigid bodies: plot.py [folder], after the run."""

import os
import sys

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "..", "tools"))

from picture import read_series, read_table, row, usual_distance

folder = sys.argv[1] if len(sys.argv) > 1 else "."
series = read_series(os.path.join(folder, "incline.pvd"))
series = [series[k] for k in (1, len(series) // 2, -1)]
for snapshot in series:
    snapshot.fields["kPa"] = snapshot.fields["vonmises"] / 1e3
curve = read_table(os.path.join(folder, "ways.txt"))

figure = plt.figure(figsize=(10, 6.4), layout="constrained")
grid = figure.add_gridspec(3, 2, width_ratios=(1.35, 1))
line = [figure.add_subplot(grid[k, 0]) for k in range(3)]
disks = row(line, series, "kPa", 1.4 * usual_distance(series[0].x), "xy", limits=(0.0, 30.0), box=((0.0, 0.0), (5.0, 1.65)))
for axes in line:
    axes.set_ylabel("y (m)")
    axes.label_outer()
    axes.annotate("", (4.9, 1.05), (4.9 - 0.3, 1.05 + 0.3 * np.sqrt(3)), arrowprops={"arrowstyle": "->"})
    axes.text(4.5, 1.15, "g", ha="right")
figure.colorbar(disks, ax=line, label="von Mises stress (kPa)", pad=0.01, extend="max", location="bottom", aspect=40, shrink=0.8)

axes = figure.add_subplot(grid[:, 1])
for name, rigid, label, color in (("v_disk", "v_rolls", "disk, rolls", "C0"), ("v_block", "v_slides", "block, slides", "C3")):
    axes.plot(curve["v_t"], curve[name], color, lw=2, label=label)
    axes.plot(curve["v_t"], curve[rigid], "k--" if rigid == "v_rolls" else "k:", label="the same, rigid")
axes.set(xlabel="time (s)", ylabel="way along the plane (m)", xlim=(0, None), ylim=(0, None))
axes.legend(loc="upper left")
figure.suptitle("A disk and a block on a plane of 30 degrees")
figure.savefig(os.path.join(folder, "incline.png"), dpi=85)
