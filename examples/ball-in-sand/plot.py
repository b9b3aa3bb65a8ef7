#!/usr/bin/env python3
# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""The bed under the ball and depths over time: plot.py [folder], after runs with fall = 0.3 and 0.05."""

import os
import sys

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.colors import ListedColormap
import numpy as np

D, density, bed, mu = 25.4, 7800.0, 1500.0, np.tan(np.radians(24.0))
folder = sys.argv[1] if len(sys.argv) > 1 else "."


def frames(path):
    with open(path) as file:
        for row in file:
            if row.startswith("ITEM: NUMBER"):
                count = int(next(file))
            elif row.startswith("ITEM: ATOMS"):
                yield np.array([next(file).split() for _ in range(count)], float)


def uehara(fall):
    factor = 0.14 / mu * (density / bed)**0.5 * (1e-3 * D)**(2.0 / 3.0)
    depth = 0.0
    for _ in range(50):
        depth = factor * (fall + depth)**(1.0 / 3.0)
    return 1e3 * depth


figure = plt.figure(figsize=(10, 6.6), layout="constrained")
grid = figure.add_gridspec(2, 3, height_ratios=(1.25, 1))
steps, t, depth, _ = np.loadtxt(os.path.join(folder, "trace.0.3.txt")).T
beds = list(frames(os.path.join(folder, "slice.0.3.txt")))
for k, number in enumerate((1, 2, 5)):
    axes = figure.add_subplot(grid[0, k])
    rows = beds[number]
    for side in (-1, 1):
        axes.scatter(side * 1e3 * rows[:, 1], 1e3 * rows[:, 2], c=rows[:, 3], s=11, marker="o", linewidths=0,
                     cmap=ListedColormap(["peru", "khaki"]))
    bottom = -np.interp(250 * number, steps, depth)
    axes.add_patch(plt.Circle((0, bottom + 0.5 * D), 0.5 * D, fc="slategray", ec="k", lw=0.8, zorder=3))
    axes.add_patch(plt.Circle((-0.13 * D, bottom + 0.66 * D), 0.1 * D, fc="white", alpha=0.7, zorder=4))
    axes.set_title("%.0f ms" % (1e3 * np.interp(250 * number, steps, t)), fontsize=10)
    axes.set(xlim=(-60, 60), ylim=(-85, 35), xticks=[], yticks=[], aspect="equal")

curve = figure.add_subplot(grid[1, :])
for fall, color in ((0.3, "tab:red"), (0.05, "tab:blue")):
    _, t, depth, _ = np.loadtxt(os.path.join(folder, "trace.%g.txt" % fall)).T
    curve.plot(1e3 * t, depth, color=color, label="fall of %g m" % fall)
    curve.axhline(uehara(fall), color=color, ls="--", lw=1)
    print("fall %g m: depth %.1f mm, formula %.1f mm" % (fall, depth[-1], uehara(fall)))
curve.plot([], [], "k--", lw=1, label="formula (Uehara et al.)")
curve.set(xlabel="time (ms)", ylabel="depth (mm)", xlim=(0, 80), ylim=(0, 60))
curve.legend(loc="lower right")
figure.savefig("ball-in-sand.png", dpi=100)
