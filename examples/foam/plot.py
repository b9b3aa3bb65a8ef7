# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
"""The foam at three heights, colored by the plastic strain, and the stress on both plates: foam.png"""

import glob
import os

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

SHARE, YIELD = 0.208, 100.0    # of the metal in the volume; MPa
# upper bound of the stress of an isotropic porous metal that cannot give way to the side: P. Ponte Castaneda, J. Mech. Phys.
# Solids 39 (1991) 45
BOUND = SHARE * YIELD * ((4 / 9) / (1 + 2 * (1 - SHARE) / 3) + 1 / (2.25 * (1 - SHARE))) ** 0.5
# bending of struts: L. J. Gibson, M. F. Ashby, Cellular Solids (1997)
BENDING = 0.3 * SHARE ** 1.5 * YIELD

HERE = os.path.dirname(os.path.abspath(__file__))

strain, above, below = np.loadtxt("curve.txt").T[1:]
plateau = (strain > 0.05) & (strain < 0.25)
print("bound %.1f, bending %.1f MPa" % (BOUND, BENDING))
print("stress from 5 to 25 %%: %.2f MPa above, %.2f MPa below; at 50 %%: %.1f MPa"
      % (above[plateau].mean(), below[plateau].mean(), np.interp(0.5, strain, above)))

files = sorted(glob.glob("foam.*[0-9].png"))
figure, axes = plt.subplots(1, 4, figsize=(13, 3.6), constrained_layout=True, width_ratios=[1, 1, 1, 1.3])
for one, name in zip(axes, (files[0], files[len(files) // 2], files[-1])):
    one.imshow(plt.imread(name))
    one.axis("off")
axes[3].plot(100 * strain, above, "k", label="plate above")
axes[3].plot(100 * strain, below, "C1--", lw=1, label="plate below")
axes[3].axhline(BOUND, color="gray", lw=0.8, label="upper bound at first (%.1f MPa)" % BOUND)
axes[3].axhline(BENDING, color="gray", lw=0.8, ls=":", label="slender struts that bend (%.1f MPa)" % BENDING)
axes[3].set(xlim=(0, 55), ylim=(0, 50), xlabel="strain (%)", ylabel="stress (MPa)")
axes[3].legend(fontsize=8)
figure.savefig(os.path.join(HERE, "foam.png"), dpi=80)
