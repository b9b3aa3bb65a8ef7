#!/usr/bin/env python3
# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""Pictures of ring and block, and the ringing: plot.py [folder], after the run."""

import glob
import os
import sys

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

folder = sys.argv[1] if len(sys.argv) > 1 else "."
lines = open("ring.msh").read().split("$Elements\n")[1].split("\n")
quads = np.array([line.split()[-4:] for line in lines[1:1 + int(lines[0])]], dtype=int) - 1

figure = plt.figure(figsize=(10, 6.4), layout="constrained")
grid = figure.add_gridspec(2, 3, height_ratios=(1.5, 1))
files = sorted(glob.glob(os.path.join(folder, "ring.*.dump")))
for k, (step, what) in enumerate(((1, "impact"), (3, "on the block"), (11, "after the rebound"))):
    data = np.loadtxt(files[step], skiprows=9)
    ring, block = data[data[:, 1] == 1], data[data[:, 1] == 2]
    axes = figure.add_subplot(grid[0, k])
    x, y, s = 1000 * ring[:, 2], 1000 * ring[:, 3], ring[:, 4] / 1e6
    triangles = np.vstack((quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]))
    shades = axes.tripcolor(x, y, triangles, s, shading="gouraud", cmap="turbo", vmin=0, vmax=900)
    outline = np.dstack((x[quads], y[quads]))
    axes.add_collection(matplotlib.collections.PolyCollection(outline, facecolors="none",
                                                              edgecolors="k", linewidths=0.15))
    lead = axes.scatter(1000 * block[:, 2], 1000 * block[:, 3], c=block[:, 4] / 1e6, s=1.3,
                        cmap="YlGnBu", vmin=0, vmax=30, linewidths=0)
    axes.set_title("step %d: %s" % (500 * step, what), fontsize=10)
    axes.set_aspect("equal")
    axes.set_xlim(-125, 125)
    axes.set_ylim(0, 255)
    axes.set_xticks([])
    axes.set_yticks([])
figure.colorbar(shades, ax=figure.axes[:3], location="right", label="ring: von Mises stress (MPa)",
                shrink=0.8)
figure.colorbar(lead, ax=figure.axes[:3], location="right", label="lead: von Mises stress (MPa)",
                shrink=0.8)

t, oval, v = np.loadtxt(os.path.join(folder, "ring.txt")).T
t *= 1000
free = t > 0.8
crossings = [t[i] - oval[i] * (t[i + 1] - t[i]) / (oval[i + 1] - oval[i])
             for i in range(len(t) - 1) if free[i] and oval[i] < 0 <= oval[i + 1]]
period = np.diff(crossings).mean()
print("period of the ringing: %.4f ms" % period)
curve = figure.add_subplot(grid[1, :])
curve.plot(t, oval, "C3", label="half of width minus height (mm)")
curve.plot(t, v / 10, "C0", label="velocity of the ring (10 m/s)")
curve.axhline(0, color="k", lw=0.5)
curve.set_xlabel("time (ms);  period of the free ring: %.3f ms, thin-ring theory 0.700 ms" % period)
curve.set_xlim(0, t[-1])
curve.set_ylim(-4.5, 8.5)
curve.legend(loc="upper right", ncols=2)
figure.savefig(os.path.join(folder, "ring-on-block.png"), dpi=90)
