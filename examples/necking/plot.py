#!/usr/bin/env python3
# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""Picture of the bar and curve of the tension test: plot.py [folder], after the run."""

import glob
import os
import sys

import matplotlib
matplotlib.use("Agg")
import matplotlib.image
import matplotlib.pyplot as plt
import numpy as np

folder = sys.argv[1] if len(sys.argv) > 1 else "."
strain, grip, middle = np.loadtxt(os.path.join(folder, "curve.txt"), usecols=(1, 2, 3)).T
picture = matplotlib.image.imread(sorted(glob.glob(os.path.join(folder, "bar.*.png")))[-1])

figure, (bar, curve) = plt.subplots(2, 1, figsize=(7, 6.2), height_ratios=(1, 2.6),
                                    layout="constrained")
dark = np.argwhere(picture[:, :, :3].min(axis=2) < 0.99)
(top, left), (bottom, right) = dark.min(axis=0), dark.max(axis=0)
bar.imshow(picture[top:bottom + 1, left:right + 1])
bar.set_axis_off()
bar.set_title("one eighth of the bar: equivalent plastic strain, 0 (blue) to 1 (red)", fontsize=10)

curve.plot(strain, grip, "C0", label="MPM, force on the grip")
curve.plot(strain, middle, "C0:", label="MPM, force in the middle")
curve.plot([0, 0.16], [570.3, 570.3], "k--", lw=0.8, label="Considere: 570 MPa, at 0.102")
curve.plot(0.1023, 570.3, "k+", ms=12)
curve.plot([0.0987, 0.1404, 0.1600], [571.6, 539.9, 500.9], "C3s", mfc="none",
           label="finite elements, square bar")
curve.plot([0.102, 0.1415, 0.1610, 0.1807, 0.2005, 0.2203],
           [570.0, 567.1, 559.7, 543.0, 515.6, 476.2], "C2o", mfc="none",
           label="finite elements, round bar")
curve.set_xlabel("engineering strain")
curve.set_ylabel("force / initial section (MPa)")
curve.set_xlim(0, 0.23)
curve.set_ylim(0, 650)
curve.legend(loc="lower left")
figure.savefig(os.path.join(folder, "necking.png"), dpi=100)
