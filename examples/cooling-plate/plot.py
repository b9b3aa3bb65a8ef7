# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
"""Temperature in the plate and along its cooled side at the end of the run (plate.txt): cooling-plate.png"""

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

x, y, T = np.loadtxt("plate.txt", skiprows=9, usecols=(1, 2, 3)).T
columns, rows = np.unique(x.round(6)), np.unique(y.round(6))
field = np.empty((len(rows), len(columns)))
field[np.searchsorted(rows, y.round(6)), np.searchsorted(columns, x.round(6))] = T

figure, axes = plt.subplots(1, 2, figsize=(8, 3.6), width_ratios=(1, 1.6))
lines = axes[0].contourf(columns, rows, field, np.arange(0, 101, 5), cmap="inferno")
axes[0].set(xlabel="x (m)", ylabel="y (m)", aspect="equal", title="temperature (C)")
figure.colorbar(lines, ax=axes[0])
axes[1].plot(rows, 1.5 * field[:, -1] - 0.5 * field[:, -2], "-", label="right side")
axes[1].plot(rows, field[:, 0], "--", label="left side")
axes[1].plot([0.2], [18.254], "ko", ms=5, label="reference")
axes[1].set(xlabel="y (m)", ylabel="temperature (C)")
axes[1].legend()
figure.tight_layout()
figure.savefig("cooling-plate.png", dpi=100)
