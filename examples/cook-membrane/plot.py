#!/usr/bin/env python3
# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""Picture of Cook's membrane without and with the cure for locking: plot.py FOLDER FOLDER"""

import glob
import os
import sys

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

figure, panels = plt.subplots(1, 2, figsize=(7, 4.2), layout="constrained")
for panel, folder, title in zip(panels, sys.argv[1:], ["locking none", "locking fbar"]):
    picture = plt.imread(sorted(glob.glob(os.path.join(folder, "cook-membrane.*.png")))[-1])
    dark = np.argwhere(picture[:, :, :3].min(axis=2) < 0.95)
    (top, left), (bottom, right) = dark.min(axis=0), dark.max(axis=0)
    panel.imshow(picture[top:bottom + 1, left:right + 1])
    panel.set_axis_off()
    panel.set_title(title, fontsize=11)
figure.supxlabel("pressure, -20 N/mm$^2$ (blue) to 20 N/mm$^2$ (red)", fontsize=10)
figure.savefig("cook-membrane.png", dpi=80)
