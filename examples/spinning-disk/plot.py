# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
"""The disks at the end (final.txt) and their angular momentum (trace.txt): spinning-disk.png"""

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.colors import ListedColormap

NAMES = ["PIC", "XPIC, 5 terms", "FLIP 0.99", "FMPM, 5 terms", "FLIP", "APIC", "FLIP, total frame"]
COLORS = ["#c0392b", "#e08e0b", "#8e44ad", "#d35d8c", "#2471a3", "#111111", "#1e8449"]

x, y, paint = np.loadtxt("final.txt", skiprows=9).T
trace = np.loadtxt("trace.txt")

figure, (disks, curves) = plt.subplots(2, 1, figsize=(10, 4.2), height_ratios=[1.0, 1.4])
disks.scatter(x, y, c=paint, s=2.6, marker="o", linewidths=0, cmap=ListedColormap(["#f1c40f", "#1a3a6b"]))
disks.set(aspect="equal", xlim=(-0.3, 3.9), ylim=(-0.33, 0.33))
disks.axis("off")
for k, (name, color) in enumerate(zip(NAMES, COLORS)):
    disks.text(0.6 * k, 0.29, name, ha="center", color=color)
    curves.plot(trace[:, 1], trace[:, 2 + k], color=color, lw=2, label=name, ls="--" if k == 6 else "-")
curves.set(xlabel="turns of a rigid disk", ylabel="angular momentum / start", ylim=(-0.05, 1.08),
           xlim=(0, trace[-1, 1]))
curves.grid(alpha=0.3)
figure.tight_layout()
figure.savefig("spinning-disk.png", dpi=100)
