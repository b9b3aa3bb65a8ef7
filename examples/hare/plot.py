# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
"""The hare on its way down, on the floor, and up again, and the speed of its center: hare.png"""

import glob
import os

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
G = 9.81

time, center, up, top, kinetic, elastic = np.loadtxt("curve.txt").T[1:]
bounce = up.argmax()
flight = time > time[bounce] + 0.01
slope = np.polyfit(time[flight], up[flight], 1)[0]
print("bounces with %.3f of its speed; falls with %.4f m/s^2 in the air (%.2f)" % (-up.max() / up[0], -slope, G))

files = sorted(glob.glob("hare.*[0-9].png"))
figure, axes = plt.subplots(1, 5, figsize=(13, 3.6), constrained_layout=True, width_ratios=[1, 1, 1, 1, 1.7])
for one, k in zip(axes, (0, 1, 2, 4)):
    one.imshow(plt.imread(files[min(k, len(files) - 1)]))
    one.axis("off")
axes[4].plot(1e3 * time, up, "k", label="of the center")
axes[4].plot(1e3 * time, up[bounce] - G * (time - time[bounce]), "C1--", lw=1, label="free flight")
axes[4].set(xlabel="time (ms)", ylabel="speed (m/s)")
axes[4].legend(fontsize=8)
figure.savefig(os.path.join(HERE, "hare.png"), dpi=80)
