# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
"""Velocity between the plates at the end of the run (profile.txt): poiseuille.png"""

import sys

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

figure, axes = plt.subplots(1, 2, figsize=(8, 3.2))
line = np.linspace(0, 1, 400)
for name in sys.argv[1:] or ["profile.txt"]:
    y, vx, shear = np.loadtxt(name, skiprows=9, usecols=(1, 2, 3)).T
    axes[0].plot(vx, y, ".", ms=3, label=name)
    axes[1].plot(shear, y, ".", ms=3)
mu, force, tauy = 1.0, 8.0, 1.0
axes[0].plot(0.5 * force / mu * line * (1 - line), line, "k-", lw=0.8, label="Newtonian, exact")
z = np.maximum(np.abs(line - 0.5), tauy / force)
bingham = 0.5 * force / mu * (0.25 - z ** 2) - tauy / mu * (0.5 - z)
axes[0].plot(bingham, line, "k--", lw=0.8, label="Bingham, exact")
axes[1].plot(force * (0.5 - line), line, "k-", lw=0.8)
axes[0].set(xlabel="velocity", ylabel="y")
axes[1].set(xlabel="shear stress")
axes[0].legend(fontsize=7)
figure.tight_layout()
figure.savefig("poiseuille.png", dpi=100)
