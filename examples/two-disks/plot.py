#!/usr/bin/env python3
# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""The disks before, in, and after the collision, and their energies: plot.py [folder], after the run."""

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
series = read_series(os.path.join(folder, "disks.pvd"), (1.0, 2.0, 2.5, 3.5))
curve = read_table(os.path.join(folder, "energy.txt"))
time = curve["v_t"]

# energies of another code with the same lattice, at times; README.md
OTHER = {"kinetic": [(1.95, 0.119), (3.5, 2.269)], "stored": [(3.5, 0.328)]}
TOUCH = (0.6 * np.sqrt(2) - 0.4) / (0.2 * np.sqrt(2))    # gap over closing speed

figure = plt.figure(figsize=(10, 6.2), layout="constrained")
grid = figure.add_gridspec(2, 4, height_ratios=(1.0, 1.25))
line = [figure.add_subplot(grid[0, k]) for k in range(4)]
disks = row(line, series, "vonmises", 1.3 * usual_distance(series[0].x), "xy", limits=(0.0, 200.0), deformed=True,
            box=((0.0, 0.0), (1.0, 1.0)))
figure.colorbar(disks, ax=line, label="von Mises stress (Pa)", pad=0.01, extend="max")

axes = figure.add_subplot(grid[1, :])
for name, key, color in (("kinetic", "c_e[1]", "C0"), ("stored", "c_e[2]", "C1"), ("both", "c_e", "black")):
    axes.plot(time, curve[key], color, label=name)
    if name in OTHER:
        axes.plot(*np.transpose(OTHER[name]), "o", color=color, mfc="none", ms=7, label=name + ", another code")
axes.axvline(TOUCH, color="gray", ls=":", label="disks would touch")
axes.set(xlim=(0, time[-1] + 0.05), ylim=(0, None), xlabel="time (s)", ylabel="energy (J per m of depth)")
axes.legend(loc="center left")
figure.suptitle("Two elastic disks collide")
figure.savefig(os.path.join(folder, "two-disks.png"), dpi=85)
