# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
"""Column at some times (frames.txt), front and height over time (trace.txt): sand-column.png"""

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

A, L = 2.0, 0.1    # aspect ratio and width

frames = []
with open("frames.txt") as file:
    for row in file:
        if row.startswith("ITEM: TIMESTEP"):
            number = int(next(file))
        elif row.startswith("ITEM: NUMBER"):
            count = int(next(file))
        elif row.startswith("ITEM: ATOMS"):
            frames.append((number, np.array([next(file).split() for _ in range(count)], float)))
step, T, X, H = np.loadtxt("trace.txt").T

figure = plt.figure(figsize=(12, 3.6))
grid = figure.add_gridspec(2, 3, width_ratios=[1, 1, 0.8], hspace=0.05, wspace=0.12)
for k, wanted in enumerate([0.0, 0.7, 1.4, 2.9]):
    number, rows = min(frames, key=lambda f: abs(np.interp(f[0], step, T) - wanted))
    axis = figure.add_subplot(grid[k // 2, k % 2])
    axis.scatter(rows[:, 1] / L, rows[:, 2] / L, c=rows[:, 3], s=3, marker="s", cmap="copper",
                 vmin=-0.5, vmax=1.2, linewidths=0)
    axis.set(xlim=(0, 4.2), ylim=(0, 2.1), aspect="equal", yticks=[0, 1, 2])
    axis.text(2.8, 1.7, "T = %.1f" % np.interp(number, step, T))
    if k < 2:
        axis.set_xticklabels([])
    else:
        axis.set_xlabel("x / L")

axis = figure.add_subplot(grid[:, 2])
axis.plot(T, X, label="run-out / L")
axis.plot(T, H, label="height / L")
axis.axhline(1.2 * A, color="C0", lw=0.8, ls=":", label="experiments, at the end")
axis.axhline(0.65 * A**0.4, color="C1", lw=0.8, ls=":")
axis.set(xlabel="time / time of free fall", ylim=(0, 3.9))
axis.legend(loc="upper right", fontsize=8)
figure.savefig("sand-column.png", dpi=90, bbox_inches="tight")
