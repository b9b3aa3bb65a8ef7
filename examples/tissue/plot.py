# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
"""The pad after the last step (last.txt), and the pressure along it in the first one with that of a thin pad (first.txt): tissue.png"""

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

T, S, G, NU, STRAIN = 0.02, 5.0, 1.0e4, 0.49, 0.001
K = 2.0 * G * (1.0 + NU) / (3.0 * (1.0 - 2.0 * NU))

figure, (pad, pressure) = plt.subplots(1, 2, figsize=(11, 3.4), gridspec_kw={"width_ratios": [1.6, 1]})
x, y, u = np.loadtxt("last.txt", skiprows=9).T
dots = pad.scatter(1e3 * x, 1e3 * y, c=1e3 * u, s=6, cmap="YlOrRd")
pad.axhline(0.0, color="k", lw=3)
pad.axhline(0.9e3 * T, color="k", lw=3)
pad.set(aspect="equal", xlabel="x (mm)", ylabel="y (mm)", xlim=(0, 112), ylim=(-1, 21))
figure.colorbar(dots, ax=pad, label="motion outward (mm)", shrink=0.5)

x, y, p = np.loadtxt("first.txt", skiprows=9).T
column = np.round(x / (T / 16) - 0.5).astype(int)    # points of a column: single ones scatter
mean = np.bincount(column, p) / np.bincount(column)
place = np.bincount(column, x) / np.bincount(column)
a = np.sqrt(12.0 * G / K) / T
b = S * T
pressure.plot(1e3 * place, mean, "o", ms=3, label="run, mean over the height")
line = np.linspace(0, b, 200)
pressure.plot(1e3 * line, K * STRAIN * (1 - np.cosh(a * line) / np.cosh(a * b)), "k--", label="thin pad")
pressure.set(xlabel="x (mm)", ylabel="pressure at 0.1 % (Pa)", ylim=(0, None))
pressure.legend()
figure.tight_layout()
figure.savefig("tissue.png", dpi=100)
