# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
"""Temperature of the interface with that of half-spaces, power of friction, and profiles of temperature and velocity
(face.txt, rows.*.txt): friction-weld.png"""

import glob

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

t, T, exact, power, pressure = np.loadtxt("face.txt", usecols=(1, 2, 3, 4, 5)).T

figure, axes = plt.subplots(1, 3, figsize=(12, 3.8))
axes[0].plot(1e6 * t, T, label="interface")
axes[0].plot(1e6 * t, exact, "k--", lw=1, label="half-spaces that slide on")
axes[0].axhline(1793, color="gray", lw=0.8, ls=":")
axes[0].text(0.2, 1805, "melting", color="gray", fontsize=8)
axes[0].set(xlabel="t (us)", ylabel="temperature (K)", ylim=(250, 2000))
axes[0].legend(loc="lower right")
few = np.ones(40) / 40
axes[1].plot(1e6 * np.convolve(t, few, "valid"), 1e-9 * np.convolve(power, few, "valid"), label="friction")
axes[1].axhline(10.8, color="k", lw=1, ls="--", label="mu p v")
axes[1].set(xlabel="t (us)", ylabel="power per area (GW/m2)", ylim=(0, 12.5))
axes[1].legend(loc="lower left")
files = {int(name.split(".")[1]): name for name in glob.glob("rows.*.txt")}
for step in sorted(files)[2::2]:
    y, v, temperature = np.loadtxt(files[step], skiprows=9, usecols=(1, 2, 3)).T
    levels = np.unique(y.round(8))
    mean = [temperature[np.abs(y - level) < 2e-7].mean() for level in levels]
    axes[2].plot(1e6 * levels, mean, label="%.1f us" % (1e6 * np.interp(step, np.arange(1, len(t) + 1) * 100, t)))
axes[2].set(xlabel="y (um)", ylabel="temperature (K)", xlim=(-45, 45))
axes[2].legend()
figure.tight_layout()
figure.savefig("friction-weld.png", dpi=100)
