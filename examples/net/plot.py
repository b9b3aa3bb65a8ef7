#!/usr/bin/env python3
# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.

"""The net at three times (net.*.png), and the force on its frame (log.lammps, or the reference log): net.png"""

import glob
import os

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

log = "log.lammps" if os.path.exists("log.lammps") else glob.glob("log.*.1")[0]
rows = []
with open(log, encoding="ascii") as file:
    for line in file:
        words = line.split()
        if len(words) == 7 and words[0].isdigit():
            rows.append([float(word) for word in words])
time, push, mean, needed = np.array(rows).T[1:5]
figure, axes = plt.subplots(1, 4, figsize=(13, 3.4), gridspec_kw={"width_ratios": (1, 1, 1, 1.1)})
for axis, step in zip(axes, (1000, 3000, 20000)):
    axis.imshow(plt.imread("net.%06d.png" % step)[150:600, 60:740])
    axis.set_title("%.2f s" % (9e-5 * step), fontsize=10)
    axis.axis("off")
axes[3].plot(time, push, "-", color="teal", label="on the frame")
axes[3].plot(time[1:], mean[1:], "-", color="k", label="its mean so far")
axes[3].plot(time[1:], needed[1:], "o", color="k", mfc="none", ms=4, label="by momentum")
axes[3].set(xlabel="time (s)", ylabel="force (kN)")
axes[3].legend(fontsize=8)
figure.tight_layout()
figure.savefig("net.png", dpi=90)
