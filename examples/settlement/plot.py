# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
"""Pressure of the water below the fill, and settlement with time beside Terzaghi's, from clay.txt and the log: settlement.png"""

import glob

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

H, M, k, q, built = 4.0, 2.0e6, 1.0e-9, 40.0, 30.0    # as in the input; kPa, days
rate = k / 9810.0 / (1.0 / M + 0.5 / 2.2e9) * 86400.0 / H**2    # time factor of a day


def ramp(of_time, t):
    """Mean over loads that came from the day 0 to built, less those to come."""
    s = (np.arange(200) + 0.5) / 200.0 * built
    return np.array([np.mean(np.where(s < now, of_time(np.maximum(now - s, 0.0)), 0.0)) for now in t])


modes = (2.0 * np.arange(400) + 1.0)[:, None] * np.pi / 2.0


def degree(t):
    return 1.0 - np.sum(2.0 / modes**2 * np.exp(-modes**2 * rate * t), axis=0)


def pressure(t):
    return np.sum(2.0 / modes * np.sin(modes) * np.exp(-modes**2 * rate * t), axis=0)


rows = []
for line in open(sorted(glob.glob("log.*"))[-1]):
    words = line.split()
    if len(words) == 8 and words[0].isdigit() and "." not in words[0] and words[1] != "by":
        rows.append([float(word) for word in words])
rows = np.array(sorted({row[0]: row for row in rows}.values()))
rows, end = rows[rows[:, 1] < 2000.0], rows[-1]

figure, (ground, curve) = plt.subplots(1, 2, figsize=(12, 3.6), gridspec_kw={"width_ratios": [1.7, 1]})
x, y, p = np.loadtxt("clay.txt", skiprows=9).T
dots = ground.scatter(x, y, c=p / 1000.0, s=5, cmap="Blues", vmin=0, vmax=40)
ground.plot([0, 10, 10], [4.1, 4.1, 4.1], "tab:brown", lw=8, solid_capstyle="butt")
ground.text(5, 4.5, "fill", ha="center", color="tab:brown")
ground.set(aspect="equal", xlim=(0, 24), ylim=(0, 5.2), xlabel="x (m)", ylabel="y (m)")
figure.colorbar(dots, ax=ground, label="pressure of the water, day 30 (kPa)", shrink=0.6)

t = rows[:, 1]
fine = np.linspace(0.0, t[-1], 300)
curve.plot(fine, ramp(degree, fine), "k-", lw=1, label="Terzaghi: settlement")
curve.plot(fine, ramp(pressure, fine), "k--", lw=1, label="pressure at the rock")
curve.plot(t, rows[:, 2] / end[2], "o", ms=3, color="tab:brown", label="settlement, over that of the end")
curve.plot(t, rows[:, 4] / q, "o", ms=3, color="tab:blue", label="pressure over the load")
curve.set(xlabel="days", ylim=(0, 1.05))
curve.legend(loc="center right", fontsize=8)
figure.tight_layout()
figure.savefig("settlement.png", dpi=90)

S, P = ramp(degree, t), ramp(pressure, t)
for days in (30.0, 130.0, 330.0, 530.0, 1130.0):
    i = np.argmin(abs(t - days))
    print("day %5.0f: settlement %.4f of the end, Terzaghi %.4f; pressure at the rock %.4f of the load, Terzaghi %.4f"
          % (t[i], rows[i, 2] / end[2], S[i], rows[i, 4] / q, P[i]))
print("end: %.2f mm, of a layer that cannot widen %.2f mm" % (end[2], 1000.0 * q * 1000.0 * H / M))
