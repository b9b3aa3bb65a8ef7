# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
"""Pressure on the walls along the strip, and the force against the motion, from pushed.txt, pulled.txt and the log: press-fit.png"""

import glob

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

H, L, MU, RATIO = 0.01, 0.05, 0.2, 0.3 / 0.7
P = 210e9 / (1.0 - 0.3 ** 2) * 5e-4

figure, (pressure, force) = plt.subplots(1, 2, figsize=(11, 3.8))
for name, sign, color in (("pushed", 1.0, "tab:red"), ("pulled", -1.0, "tab:blue")):
    x, y, _, s = np.loadtxt(name + ".txt", skiprows=9).T
    columns = np.unique(x.round(5))
    means = [-s[np.abs(x - column) < 1e-4].mean() for column in columns]
    pressure.plot(1000.0 * columns, np.array(means) / 1e6, ".", color=color, label=name)
    pressure.plot(1000.0 * columns, P / 1e6 * np.exp(sign * 2.0 * MU * RATIO * (L - columns) / H), "k--", lw=1)
pressure.plot([], [], "k--", lw=1, label="theory")
pressure.axhline(P / 1e6, color="0.7", lw=1, label="no friction")
pressure.set(xlabel="x (mm), from the end that is moved", ylabel="mean pressure across the slot (MPa)", ylim=(0.0, None))
pressure.legend()

rows = []
for line in open(sorted(glob.glob("log.*"))[-1]):
    words = line.split()
    if len(words) == 5 and words[0].isdigit():
        rows.append([float(word) for word in words])
rows = np.array(rows)
k = 2.0 * MU * RATIO * L / H
force.plot(1e6 * rows[:, 1], rows[:, 2], "o-", ms=3, label="run")
for value in (np.expm1(k) / k, np.expm1(-k) / k):
    force.axhline(value, color="k", ls="--", lw=1, label="theory" if value > 0 else None)
force.axhline(1.0, color="0.7", lw=1, label="no friction")
force.set(xlabel="motion of the end (microns)", ylabel=r"force over $2 \mu p_0 L$")
force.legend(loc="lower right")
figure.tight_layout()
figure.savefig("press-fit.png", dpi=100)
