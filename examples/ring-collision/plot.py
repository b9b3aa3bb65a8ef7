# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
"""The rings at several times (frames.txt), colored by von Mises stress: ring-collision.png"""

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

frames = []
with open("frames.txt") as file:
    for row in file:
        if row.startswith("ITEM: NUMBER"):
            count = int(next(file))
        elif row.startswith("ITEM: ATOMS"):
            frames.append(np.array([next(file).split() for _ in range(count)], float))

shown = [0, 1, 2, 3]
figure, axes = plt.subplots(2, 2, figsize=(9, 4.9))
for k, axis in zip(shown, axes.flat):
    x, y, stress = frames[k].T
    picture = axis.scatter(1e3 * x, 1e3 * y, c=1e-6 * stress, s=2.6, linewidths=0, cmap="turbo", vmin=0, vmax=18)
    axis.set(aspect="equal", xlim=(0, 200), ylim=(3, 117))
    axis.text(0, 102, "%d ms" % k)
    axis.axis("off")
figure.subplots_adjust(0.02, 0.01, 0.9, 0.99, 0.03, 0.03)
figure.colorbar(picture, cax=figure.add_axes([0.92, 0.15, 0.015, 0.7]), label="von Mises stress (MPa)")
figure.savefig("ring-collision.png", dpi=100)
