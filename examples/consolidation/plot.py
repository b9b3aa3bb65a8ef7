# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
"""Pressures along the column (column.*.txt) and settlement (log.lammps) with Terzaghi's series: consolidation.png"""

import re

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

q, M, n_by_Kf = 1.0e4, 1.0e7 * 0.7 / (1.3 * 0.4), 0.4 / 2.2e8
p0 = q / (1 + M * n_by_Kf)
N = (2 * np.arange(500) + 1) * np.pi / 2


def pressure(depth, T):
    return (2 / N * np.sin(np.outer(depth, N)) * np.exp(-N**2 * T)).sum(axis=1)


def degree(T):
    return 1 - (2 / N**2 * np.exp(-np.outer(T, N**2))).sum(axis=1)


figure, axes = plt.subplots(1, 2, figsize=(8.5, 3.6))
depth = np.linspace(0, 1, 200)
for k, T in enumerate((0.05, 0.2, 0.5, 1.0)):
    y, p = np.loadtxt("column.%d.txt" % (k + 1), skiprows=9).T
    error = p / p0 - pressure(1 - y, T)
    print("T = %g: largest difference of the pressure %.4f of the initial one" % (T, abs(error).max()))
    axes[0].plot(pressure(depth, T), 1 - depth, "k-", lw=1)
    axes[0].plot(p / p0, y, "o", ms=3, label="T = %g" % T)
axes[0].set(xlabel="pressure / initial pressure", ylabel="height (m)")
axes[0].legend()

rows = [line.split() for line in open("log.lammps") if re.match(r"^ *\d+ +\S+ +\S+ +\S+ +\S+ +\S+ *$", line)]
T, s = np.array([[float(word) for word in row] for row in rows]).T[2:4]
whole, first = q / M, q / M * (1 - p0 / q)
series = first + (whole - first) * degree(np.maximum(T, 0))
print("settlement at T = %.3g: %.4f mm, series %.4f mm" % (T[-1], 1e3 * s[-1], 1e3 * series[-1]))
axes[1].plot(T[T > 0], 1e3 * series[T > 0], "k-", lw=1, label="Terzaghi")
axes[1].plot(T, 1e3 * s, "o", ms=3, label="points")
axes[1].set(xlabel="time factor T", ylabel="settlement (mm)")
axes[1].legend()
figure.tight_layout()
figure.savefig("consolidation.png", dpi=100)
