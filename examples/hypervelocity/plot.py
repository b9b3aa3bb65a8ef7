# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
"""The debris at four times (frames.txt) and the pressure in the rod (trace.txt): hypervelocity.png"""

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

frames = []
with open("frames.txt") as file:
    for row in file:
        if row.startswith("ITEM: TIME\n"):
            time = 1e6 * float(next(file))
        elif row.startswith("ITEM: NUMBER"):
            count = int(next(file))
        elif row.startswith("ITEM: ATOMS"):
            frames.append((time, np.array([next(file).split() for _ in range(count)], float)))

figure = plt.figure(figsize=(10, 5.2))
places = [[0.0, 0.53, 0.22, 0.46], [0.0, 0.02, 0.22, 0.46], [0.2, 0.02, 0.46, 0.97]]
for place, wanted in zip(places, (0.0, 0.7, 4.0)):
    time, rows = min(frames, key=lambda frame: abs(frame[0] - wanted))
    x, y, speed = 1e3 * rows[:, 0], 1e3 * rows[:, 1], 1e-3 * rows[:, 2]
    axis = figure.add_axes(place)
    large = wanted > 1.0
    picture = axis.scatter(x, y, c=speed, s=1.0, linewidths=0, cmap="turbo", vmin=0, vmax=7.5)
    axis.set(aspect="equal", xlim=(-11, 33) if large else (-6, 8), ylim=(-21, 21) if large else (-9, 9))
    axis.text(0.03, 0.95, "%.1f us" % time, transform=axis.transAxes, va="top")
    axis.axis("off")
figure.colorbar(picture, cax=figure.add_axes([0.73, 0.60, 0.24, 0.03]), orientation="horizontal",
                label="speed (km/s)")

rho, c0, s, up = 2703.0, 5350.0, 1.34, 3500.0
_, us, gpa, _ = np.loadtxt("trace.txt").T
axis = figure.add_axes([0.73, 0.12, 0.24, 0.36])
axis.axhline(1e-9 * rho * (c0 + s * up) * up, color="k", lw=0.8, ls="--")
axis.text(0.38, 97, "Hugoniot", ha="right", va="bottom", fontsize=9)
axis.plot(us, gpa, color="#c0392b")
axis.set(xlabel="time (us)", ylabel="pressure in the rod (GPa)", xlim=(0, 0.4), ylim=(0, 115))
figure.savefig("hypervelocity.png", dpi=100)
