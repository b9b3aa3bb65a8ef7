# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
"""The disk at four times, and the way of its centre (points.*.txt, trace.txt): soft-disk.png"""

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

figure, axes = plt.subplots(1, 5, figsize=(12.5, 2.75))
t, x, y = np.loadtxt("trace.txt", usecols=(1, 2, 3)).T
for axis, step in zip(axes, (0, 400, 600, 800)):
    points = np.loadtxt("points.%d.txt" % step, skiprows=9)
    solid = points[:, 1] == 2
    speed = np.hypot(points[:, 4], points[:, 5])
    axis.scatter(points[~solid, 2], points[~solid, 3], c=speed[~solid], s=1.2, lw=0, cmap="Blues", vmin=-0.1, vmax=0.8)
    axis.scatter(points[solid, 2], points[solid, 3], c="firebrick", s=1.8, lw=0)
    axis.set_title("t = %.1f" % t[step // 10], fontsize=9)    # every tenth step
axes[4].plot(x, y, "k-", lw=1)
axes[4].plot(x[0], y[0], "ko", ms=3)
axes[4].set_title("centre of the disk", fontsize=9)
for axis in axes:
    axis.set(xlim=(0, 1), ylim=(0, 1), aspect="equal", xticks=[], yticks=[])
figure.tight_layout()
figure.savefig("soft-disk.png", dpi=90)
