# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
"""Plastic strain and motion of the ground with Prandtl's slip lines, and the load, from ground.txt and the log: footing.png"""

import glob

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

figure, (ground, load) = plt.subplots(1, 2, figsize=(11, 3.8), gridspec_kw={"width_ratios": [1.7, 1]})
x, y, u, v, strain = np.loadtxt("ground.txt", skiprows=9).T
dots = ground.scatter(x, y, c=100.0 * strain, s=5, cmap="Reds", vmin=0, vmax=4)
some = (np.hypot(u, v) > 0.002) & (np.arange(len(x)) % 3 == 0)
ground.quiver(x[some], y[some], u[some], v[some], color="tab:blue", angles="xy", scale_units="xy", scale=0.15, width=0.002)

# wedge below the footing, fan around its edge, wedge that is pushed up
angle = np.linspace(-0.75 * np.pi, -0.25 * np.pi, 50)
ground.plot([0.0, 1.0, 2.0], [-1.0, 0.0, -1.0], "k--", lw=1)
ground.plot(1.0 + np.sqrt(2.0) * np.cos(angle), np.sqrt(2.0) * np.sin(angle), "k--", lw=1)
ground.plot([2.0, 3.0], [-1.0, 0.0], "k--", lw=1, label="slip lines of Prandtl")
ground.plot([0.0, 1.0], [0.02, 0.02], "k", lw=4)
ground.set(aspect="equal", xlim=(-0.05, 4.0), ylim=(-2.2, 0.2), xlabel="x (m)", ylabel="y (m)")
ground.legend(loc="lower right")
figure.colorbar(dots, ax=ground, label="plastic strain (%)", shrink=0.8)

rows = []
for line in open(sorted(glob.glob("log.*"))[-1]):
    words = line.split()
    if len(words) == 3 and words[0].isdigit():
        rows.append([float(word) for word in words])
rows = np.array(rows)
load.plot(1000.0 * rows[:, 1], rows[:, 2], "o-", ms=3, label="run")
load.axhline(2.0 + np.pi, color="k", ls="--", label=r"Prandtl, $2 + \pi$")
load.set(xlabel="settlement (mm)", ylabel="mean pressure over c", ylim=(0.0, 6.0))
load.legend(loc="lower right")
figure.tight_layout()
figure.savefig("footing.png", dpi=100)
