# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
"""The strip at three times (frames.txt), points drawn as what has become of their squares: rubber-band.png"""

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import PolyCollection

frames = []
with open("frames.txt") as file:
    for row in file:
        if row.startswith("ITEM: NUMBER"):
            count = int(next(file))
        elif row.startswith("ITEM: ATOMS"):
            frames.append(np.array([next(file).split() for _ in range(count)], float))

length = [rows[:, 0].max() for rows in frames]
longest = int(np.argmax(length))
released = next(k for k in range(longest, len(frames)) if length[k] < 0.87 * length[longest])
start = frames[0]
half = 0.5 * np.sort(np.unique(np.round(np.diff(np.unique(np.round(start[:, 0], 9))), 9)))[0] * 1.04
corners = half * np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])

figure, axes = plt.subplots(3, 1, figsize=(9, 5.4), height_ratios=[1.0, 0.75, 1.0])
for axis, k, text in zip(axes, (0, longest, released), ("at rest", "pulled", "let go")):
    rows = frames[k]
    F = rows[:, 3:7].reshape(-1, 2, 2)
    shapes = rows[:, None, :2] + np.einsum("pij,cj->pci", F, corners)
    patches = PolyCollection(shapes, array=1e-6 * rows[:, 2], cmap="turbo", linewidths=0)
    patches.set_clim(0, 12)
    axis.add_collection(patches)
    height = 0.4 if k == longest else 0.62
    axis.set(aspect="equal", xlim=(-0.05, 8.9), ylim=(-height, height))
    axis.text(8.9, 0.8 * height, text, ha="right", va="top")
    axis.axis("off")
figure.subplots_adjust(0.01, 0.14, 0.99, 0.99, 0, 0.02)
figure.colorbar(patches, cax=figure.add_axes([0.3, 0.09, 0.4, 0.025]), orientation="horizontal",
                label="von Mises stress (MPa)")
figure.savefig("rubber-band.png", dpi=100)
