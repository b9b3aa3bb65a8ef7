# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
"""Velocity over place (rows.txt) and energies over time (energy.txt): handshake.png"""

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

A, ZONE, DT = 1.549603, (60.0, 72.0), 0.005
frames = []
with open("rows.txt") as file:
    for row in file:
        if row.startswith("ITEM: TIMESTEP"):
            number = int(next(file))
        elif row.startswith("ITEM: NUMBER"):
            count = int(next(file))
        elif row.startswith("ITEM: ATOMS"):
            frames.append((number, np.array([next(file).split() for _ in range(count)], float)))

figure, axes = plt.subplots(1, 2, figsize=(11, 4.6), width_ratios=(1.6, 1))
scale = 0.9 / np.ptp(frames[0][1][:, 2])
axes[0].axvspan(*ZONE, color="0.9", lw=0)
for k, (number, rows) in enumerate(frames):
    for kind, color, name in ((1, "tab:blue", "atoms"), (2, "tab:orange", "material points")):
        mine = rows[(rows[:, 0] == kind) & (rows[:, 3] > 0)]    # without atoms that just follow
        axes[0].plot(mine[:, 1] / A, k - scale * mine[:, 2], ".", ms=2.5 if kind == 1 else 3.5, color=color,
                     label=None if k else name, rasterized=True, zorder=3 - kind / 2)
    axes[0].text(149, k - 0.12, "t = %g" % (number * DT), ha="right", fontsize=8)
axes[0].text(np.mean(ZONE), -1.2, "zone", ha="center", va="center", fontsize=8)
axes[0].set(xlabel="x / lattice constant", ylabel="velocity, shifted with time", yticks=[], xlim=(0, 150),
            ylim=(len(frames) - 0.4, -1.7))
axes[0].legend(loc="upper right", fontsize=8, markerscale=3, framealpha=1)

step, time, atoms, points, total, reflected = np.loadtxt("energy.txt").T
full = total[0]
axes[1].plot(time, atoms / full, color="tab:blue", label="atoms")
axes[1].plot(time, points / full, color="tab:orange", label="material points")
axes[1].plot(time, total / full, "k", lw=1, label="all")
axes[1].set(xlabel="time", ylabel="energy / energy of the pulse", ylim=(-0.03, 1.12), xlim=(0, time[-1]))
axes[1].legend(loc="center left", fontsize=8)
axes[1].text(time[-1], 0.05, "reflected %.2f %%" % (100 * reflected[-1] / full), ha="right", fontsize=9)
figure.tight_layout()
figure.savefig("handshake.png", dpi=110)
