# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
"""The flow at the end and its profiles beside those of U. Ghia, K.N. Ghia, C.T. Shin (points.txt, upright.txt, level.txt): cavity.png;
prints the largest differences"""

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

# J. Comput. Phys. 48 (1982) 387, tables I and II, Re = 400
Y = np.array([0.0547, 0.0625, 0.0703, 0.1016, 0.1719, 0.2813, 0.4531, 0.5, 0.6172, 0.7344, 0.8516, 0.9531])
U = np.array([-0.08186, -0.09266, -0.10338, -0.14612, -0.24299, -0.32726, -0.17119, -0.11477, 0.02135, 0.16256, 0.29093, 0.55892])
X = np.array([0.0625, 0.0703, 0.0781, 0.0938, 0.1563, 0.2266, 0.2344, 0.5, 0.8047, 0.8594, 0.9453])
V = np.array([0.18360, 0.19713, 0.20920, 0.22965, 0.28124, 0.30203, 0.30174, 0.05186, -0.38598, -0.44993, -0.22847])


def profile(name):
    """Places and velocities of the last time."""
    rows = [line.split() for line in open(name) if not line.startswith("#")]
    blocks = [k for k, row in enumerate(rows) if len(row) == 3]
    return np.array(rows[blocks[-1] + 1:], dtype=float)[:, [1, 3]].T


figure, axes = plt.subplots(1, 3, figsize=(10.5, 3.6), layout="constrained")
_, x, y, vx, vy = np.loadtxt(open("points.txt").read().split("ITEM: ATOMS id x y vx vy\n")[-1].split("\n")).T
speed = np.hypot(vx, vy)
dots = axes[0].scatter(x, y, s=9, lw=0, c=speed, cmap="viridis", vmax=0.6)
edges = np.linspace(0.0, 1.0, 25)
count, mean_vx, mean_vy = (np.histogram2d(y, x, bins=(edges, edges), weights=w)[0] for w in (None, vx, vy))
middle = 0.5 * (edges[1:] + edges[:-1])
axes[0].streamplot(middle, middle, mean_vx / count, mean_vy / count, color="black", linewidth=0.6, arrowsize=0.7, density=1.2)
axes[0].set(xlim=(0, 1), ylim=(0, 1), xticks=(0, 1), yticks=(0, 1), aspect="equal", xlabel="x", ylabel="y")
figure.colorbar(dots, ax=axes[0], label="speed", shrink=0.8)
for axis, name, at, reference, label in ((axes[1], "upright.txt", Y, U, ("y", "velocity along x at x = 0.5")),
                                         (axes[2], "level.txt", X, V, ("x", "velocity along y at y = 0.5"))):
    place, velocity = profile(name)
    axis.plot(place, velocity, lw=1.2, label="points")
    axis.plot(at, reference, "o", ms=4, mfc="none", label="Ghia and others")
    axis.set(xlim=(0, 1), xlabel=label[0], ylabel=label[1])
    axis.legend(frameon=False, fontsize=8)
    print("%s: largest difference %.3f" % (label[1], np.abs(np.interp(at, place, velocity) - reference).max()))
figure.savefig("cavity.png", dpi=100)
