# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
"""Pressure over place and time (xt.txt) and velocity of the rear surface (trace.txt): spall.png"""

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

step, us, rear = np.loadtxt("trace.txt").T
frames = []
with open("xt.txt") as file:
    for row in file:
        if row.startswith("ITEM: TIMESTEP"):
            number = int(next(file))
        elif row.startswith("ITEM: NUMBER"):
            count = int(next(file))
        elif row.startswith("ITEM: ATOMS"):
            frames.append((number, np.array([next(file).split() for _ in range(count)], float)))

figure, axes = plt.subplots(1, 2, figsize=(10, 3.8))
for number, rows in frames:
    time = np.full(len(rows), np.interp(number, step, us))
    picture = axes[0].scatter(1e3 * rows[:, 1], time, c=1e-9 * rows[:, 2], s=10, marker="s", cmap="RdBu_r",
                              vmin=-3.3, vmax=3.3, linewidths=0)
figure.colorbar(picture, ax=axes[0], label="pressure (GPa)")
axes[0].set(xlabel="x (mm)", ylabel="time (us)")

c0, s, rho, speed, pspall = 5350.0, 1.34, 2703.0, 400.0, 1.2e9
arrival = 4e-3 / (c0 + s * speed / 2) * 1e6
axes[1].plot(us, rear, lw=1)
axes[1].axvline(arrival, color="k", lw=0.8, ls=":")
axes[1].axhline(speed, color="k", lw=0.8, ls=":")
axes[1].axhline(speed - 2 * pspall / (rho * c0), color="k", lw=0.8, ls="--")
axes[1].set(xlabel="time (us)", ylabel="velocity of the rear surface (m/s)", ylim=(-10, 450))
figure.tight_layout()
figure.savefig("spall.png", dpi=100)
