#!/usr/bin/env python3
# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""Water at four times, front and height over time, both with the experiment: plot.py [folder], after the run."""

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
A, G = 0.05715, 9.81    # width of the column (m)
curve = read_table(os.path.join(folder, "trace.txt"))

# Martin and Moyce (1952), tables 2 and 6; tau = T/sqrt(2)
front = np.array([(0.41, 1.11), (0.84, 1.22), (1.19, 1.44), (1.43, 1.67), (1.63, 1.89), (1.83, 2.11),
                  (1.98, 2.33), (2.20, 2.56), (2.32, 2.78), (2.51, 3.00), (2.65, 3.22), (2.83, 3.44),
                  (2.98, 3.67), (3.11, 3.89), (3.33, 4.11)])
height = np.array([(0.56, 0.94), (0.77, 0.89), (0.93, 0.83), (1.08, 0.78), (1.28, 0.72),
                   (1.46, 0.67), (1.66, 0.61), (1.84, 0.56), (2.00, 0.50)])

series = read_series(os.path.join(folder, "dam.pvd"), (0.03, 0.06, 0.115, 0.17))
figure = plt.figure(figsize=(10, 8.0), layout="constrained")
grid = figure.add_gridspec(3, 2, height_ratios=(1, 1, 1.9))
line = [figure.add_subplot(grid[k]) for k in ((0, 0), (0, 1), (1, 0), (1, 1))]
for snapshot in series:
    snapshot.show_in("mm", "ms")
disks = row(line, series, "pressure", 1.9 * usual_distance(series[0].x), "xy", limits=(0.0, 1000.0),
            box=((0, 0), (300, 118)))
for axes, snapshot in zip(line, series):
    T = snapshot.time * np.sqrt(2 * G / A)
    axes.set_title("T = %.2f, t = %.0f ms" % (T, 1e3 * snapshot.time))
    axes.set_ylabel("y (mm)" if axes in line[::2] else "")
    axes.set_xlabel("x (mm)" if axes in line[2:] else "")
    if front[0, 0] < T < front[-1, 0]:
        axes.plot(1e3 * A * np.interp(T, *front.T), 3, "r^", ms=9, label="front in the experiment")
    tau = T / np.sqrt(2)
    if height[0, 0] < tau < height[-1, 0]:
        axes.plot(3, 2e3 * A * np.interp(tau, *height.T), "r<", ms=9, label="height in the experiment")
line[1].legend(loc="upper right")
figure.colorbar(disks, ax=line, label="pressure (Pa)", pad=0.01, extend="max")

axes = figure.add_subplot(grid[2, :])
axes.plot(curve["v_T"], curve["v_Z"], "C0", label="front Z, material points")
axes.plot(*front.T, "C0o", ms=5, label="front, experiment")
axes.plot(curve["v_T"], curve["v_H"], "C3", label="height H, material points")
axes.plot(height[:, 0] * np.sqrt(2), height[:, 1], "C3s", ms=5, label="height, experiment")
axes.set(xlabel="T = t sqrt(2g/a)", ylabel="front / a,  height / 2a", xlim=(0, 3.4), ylim=(0, 4.8))
axes.legend(loc="upper left")
figure.suptitle("Collapse of a column of water (Martin and Moyce 1952)")
figure.savefig(os.path.join(folder, "dam-break.png"), dpi=80)
